/* number.c -- prepared vertices, and normals where few are used, numbered in the order in which corners use them first.
 *
 * Place in the data flow: emit.c (corners name the scene's vertices, of each place the first one, and normals) -> here -> emit.c, normals.c.
 * The order of first use keeps together in memory what neighbouring polygons need, and gives chunks of polygons vertices of their own:
 * those first used in a chunk have numbers from chunk_vertex of it to that of the next, so that passes over chunks may write to them
 * at the same time as long as polygons that share vertices with an earlier chunk (prepared.seams) are left for later.
 * Numbering goes corner by corner; that of vertices and that of normals are independent and run side by side. Where most polygons use normals
 * of the file these keep their numbers: that saves a way through all corners, and a picture asks only for the normals of what is in sight.
 */
#include "base/fetch.h"
#include "base/pages.h"
#include "base/parallel.h"
#include "scene/prepare.h"

#include <string.h>

#define PIECE 16384 /* vertices */
#define AHEAD 16    /* vertices */

typedef struct numbering {
    gnoi_preparing *w;
    uint32_t *vertex_source; /* of prepared vertices: the scene's */
    uint32_t *normal_number; /* of scene normals, or GNOI_NONE */
} numbering;

/* Numbers the names [from,to), which may be GNOI_NONE. number: of each name, GNOI_NONE at first; source: the names in the order of
 * first use, with room for one more. No branch: whether a name is new cannot be foretold. */
static uint32_t number_names(uint32_t *names, size_t from, size_t to, uint32_t *number, uint32_t *source, uint32_t count)
{
    for (size_t i = from; i < to; i++) {
        uint32_t name = names[i], known, is_new;
        if (name == GNOI_NONE)
            continue;
        known = number[name];
        is_new = known == GNOI_NONE;
        source[count] = name;
        known = is_new ? count : known;
        number[name] = known;
        names[i] = known;
        count += is_new;
    }
    return count;
}

static size_t polygons_in(const gnoi_preparing *w, size_t chunk)
{
    return chunk + 1 < w->chunk_count ? GNOI_CHUNK : w->item_count - chunk * GNOI_CHUNK;
}

static gno_status number_vertices(numbering *n)
{
    gnoi_preparing *w = n->w;
    gnoi_prepared *out = w->out;
    uint32_t count = 0;
    memset(w->vertex_number, 0xff, w->scene->vertex_count * sizeof *w->vertex_number); /* GNOI_NONE */
    for (size_t k = 0; k < w->chunk_count; k++) {
        size_t corners = w->chunks[k + 1].corner - w->chunks[k].corner, polys = polygons_in(w, k);
        out->chunk_corner[k] = corners == 3 * polys ? (uint32_t)w->chunks[k].corner : GNOI_NONE;
        out->chunk_vertex[k] = count;
        count = number_names(out->corner_vertex, w->chunks[k].corner, w->chunks[k + 1].corner, w->vertex_number, n->vertex_source, count);
        if (gnoi_stopped(w->scene->context))
            return GNO_ERROR_CANCELLED;
    }
    out->chunk_vertex[w->chunk_count] = count;
    out->chunk_corner[w->chunk_count] = GNOI_NONE;
    out->vertex_count = count;
    return GNO_OK;
}

static gno_status number_normals(numbering *n)
{
    gnoi_preparing *w = n->w;
    gnoi_prepared *out = w->out;
    uint32_t count = 0;
    memset(n->normal_number, 0xff, w->scene->normal_count * sizeof *n->normal_number); /* GNOI_NONE */
    for (size_t k = 0; k < w->chunk_count; k++) {
        count = number_names(out->corner_normal, w->chunks[k].corner, w->chunks[k + 1].corner, n->normal_number, w->normal_source, count);
        if (gnoi_stopped(w->scene->context))
            return GNO_ERROR_CANCELLED;
    }
    out->normal_count = count;
    return GNO_OK;
}

/* 1 when normals are numbered anew. */
static int renumbers(const gnoi_preparing *w)
{
    return w->out->corner_normal && w->scene->normal_count > 0 && 2 * w->measures.using_normals < w->scene->polygon_count;
}

static gno_status number_piece(void *user, int worker, size_t piece)
{
    (void)worker;
    return piece == 0 ? number_vertices(user) : number_normals(user);
}

static gno_status copy_piece(void *user, int worker, size_t piece)
{
    const numbering *n = user;
    const gnoi_preparing *w = n->w;
    size_t end = (piece + 1) * PIECE < w->out->vertex_count ? (piece + 1) * PIECE : w->out->vertex_count;
    (void)worker;
    gnoi_pages_ready(w->out->positions + piece * PIECE, (end - piece * PIECE) * sizeof *w->out->positions);
    for (size_t v = piece * PIECE; v < end; v++) {
        if (v + AHEAD < end)
            FETCH(w->scene->positions[n->vertex_source[v + AHEAD]]);
        memcpy(w->out->positions[v], w->scene->positions[n->vertex_source[v]], sizeof w->out->positions[v]);
    }
    return GNO_OK;
}

static gno_status number_corners(numbering *n)
{
    gnoi_preparing *w = n->w;
    gnoi_prepared *out = w->out;
    gno_context *context = w->scene->context;
    const int normals = renumbers(w);
    gno_status status;
    if (!n->vertex_source || (normals && (!n->normal_number || !w->normal_source)) || !w->vertex_number || !out->chunk_vertex || !out->chunk_corner ||
        !out->chunk_opaque)
        return GNO_ERROR_MEMORY;
    status = gnoi_parallel(context, w->threads, normals ? 2 : 1, "prepare", number_piece, n);
    if (status != GNO_OK)
        return status;
    if (out->corner_normal && !normals)
        out->normal_count = w->scene->normal_count;
    out->positions = gnoi_malloc(context, out->vertex_count, sizeof *out->positions);
    out->vertex_capacity = out->vertex_count;
    if (!out->positions)
        return GNO_ERROR_MEMORY;
    return gnoi_parallel(context, w->threads, (out->vertex_count + PIECE - 1) / PIECE, "prepare", copy_piece, n);
}

gno_status gnoi_number_corners(gnoi_preparing *w)
{
    gno_context *context = w->scene->context;
    const size_t vertices = w->scene->vertex_count, normals = renumbers(w) ? w->scene->normal_count : 0;
    numbering n = {w, NULL, NULL};
    gno_status status;
    n.vertex_source = gnoi_malloc(context, vertices + 1, sizeof *n.vertex_source);
    n.normal_number = normals > 0 ? gnoi_malloc(context, normals, sizeof *n.normal_number) : NULL;
    w->vertex_number = gnoi_malloc(context, vertices, sizeof *w->vertex_number);
    w->normal_source = normals > 0 ? gnoi_malloc(context, normals + 1, sizeof *w->normal_source) : NULL;
    w->normal_source_count = normals + 1;
    w->out->chunk_vertex = gnoi_malloc(context, w->chunk_count + 1, sizeof *w->out->chunk_vertex);
    w->out->chunk_corner = gnoi_malloc(context, w->chunk_count + 1, sizeof *w->out->chunk_corner);
    w->out->chunk_opaque = gnoi_malloc(context, w->chunk_count + 1, 1);
    w->out->chunk_count = w->chunk_count;
    status = number_corners(&n);
    gnoi_free(context, n.vertex_source, vertices + 1, sizeof *n.vertex_source);
    gnoi_free(context, n.normal_number, normals, sizeof *n.normal_number);
    return status;
}
