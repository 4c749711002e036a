/* clip.c -- gno_clip: the passes of clipper.h in their order. The first file of this folder to read after it. */
#include "clip/clip.h"
#include "clip/clipper.h"

#include <stdio.h>

static const gno_shape empty_shape;

gno_status gno_clipper_create(gno_context *context, gno_clipper **clipper)
{
    gno_clipper *fresh;
    if (clipper)
        *clipper = NULL;
    if (!context || !clipper)
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "gno_clipper_create: NULL");
    fresh = gnoi_calloc(context, 1, sizeof *fresh);
    if (!fresh)
        return gnoi_fail(context, GNO_ERROR_MEMORY, "gno_clipper_create: out of memory");
    fresh->context = context;
    fresh->bits = GNOI_CLIP_BITS;
    *clipper = fresh;
    return GNO_OK;
}

#define FREE(array, capacity) gnoi_free(c->context, c->array, c->capacity, sizeof *c->array)

void gno_clipper_destroy(gno_clipper *c)
{
    if (!c)
        return;
    FREE(points, point_capacity);
    FREE(segments, segment_capacity);
    FREE(polygons, polygon_capacity);
    FREE(ordered, ordered_capacity);
    FREE(cell_list, cell_capacity);
    FREE(boxes, box_capacity);
    FREE(members, member_capacity);
    FREE(splits, split_capacity);
    FREE(keys, key_capacity);
    FREE(key_scratch, key_scratch_capacity);
    FREE(vertex_of, vertex_of_capacity);
    FREE(vertices, vertex_capacity);
    FREE(bucket, bucket_capacity);
    FREE(chain, chain_capacity);
    FREE(pieces, piece_capacity);
    FREE(sorted, sorted_capacity);
    FREE(edges, edge_capacity);
    FREE(blocks, block_capacity);
    FREE(row, row_capacity);
    FREE(ending, ending_capacity);
    FREE(around, around_capacity);
    FREE(on_path, on_path_capacity);
    FREE(ring_vertex, ring_vertex_capacity);
    FREE(rings, ring_capacity);
    FREE(result_polygon_start, result_polygon_capacity);
    FREE(result_ring_start, result_ring_capacity);
    gnoi_free(c->context, c->result_points, c->result_point_capacity, 2 * sizeof(double));
    gnoi_free(c->context, c, 1, sizeof *c);
}

static gno_status run(gno_clipper *c, gno_clip_op op, const gno_shape *subject, const gno_shape *clip, gno_shape *result)
{
    gno_status status;
    c->complaint[0] = '\0';
    status = gnoi_clip_import(c, subject, clip);
    if (status != GNO_OK || c->segment_count == 0)
        return status;
    if (gnoi_clip_stopped(c, c->segment_count))
        return GNO_ERROR_MEMORY;
    if ((status = gnoi_clip_meet(c)) != GNO_OK || (status = gnoi_clip_vertices(c)) != GNO_OK ||
        (status = gnoi_clip_pieces(c)) != GNO_OK || (status = gnoi_clip_winding(c)) != GNO_OK ||
        (status = gnoi_clip_edges(c)) != GNO_OK || (status = gnoi_clip_sweep(c, op)) != GNO_OK ||
        (status = gnoi_clip_rings(c)) != GNO_OK)
        return status;
    return gnoi_clip_result(c, result);
}

gno_status gnoi_clip_refuse(gno_clipper *c, gno_status status, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    if (vsnprintf(c->complaint, sizeof c->complaint, format, arguments) < 0)
        c->complaint[0] = '\0';
    va_end(arguments);
    return status;
}

gno_status gnoi_clip(gno_clipper *clipper, gno_clip_op op, const gno_shape *subject, const gno_shape *clip, gno_shape *result)
{
    gno_shape made = empty_shape;
    gno_status status = run(clipper, clip ? op : GNO_CLIP_UNION, subject, clip, &made);
    *result = status == GNO_OK ? made : empty_shape;
    return status;
}

gno_status gno_clip(gno_clipper *clipper, gno_clip_op op, const gno_shape *subject, const gno_shape *clip, gno_shape *result)
{
    gno_status status;
    if (!clipper || !subject || !result || op < GNO_CLIP_UNION || op > GNO_CLIP_XOR) {
        if (result)
            *result = empty_shape;
        return gnoi_fail(clipper ? clipper->context : NULL, GNO_ERROR_ARGUMENT, "gno_clip: NULL or unknown operation");
    }
    gnoi_begin(clipper->context, "clipping");
    status = gnoi_clip(clipper, op, subject, clip, result);
    if (status == GNO_OK)
        return status;
    return gnoi_fail(clipper->context, status, "clipping: %s", status == GNO_ERROR_MEMORY ? "out of memory" : clipper->complaint);
}
