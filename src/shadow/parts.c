/* parts.c -- see parts.h. */
#include "shadow/parts.h"

#include "clip/clip.h"

#include <string.h>

static const double full[3] = {1, 1, 1};

gno_status gnoi_parter_make(const gno_scene *scene, gnoi_parter *p)
{
    gno_context *context = scene->context;
    memset(p, 0, sizeof *p);
    p->context = p->outline.context = p->work[0].context = p->work[1].context = context;
    p->parts.shape.context = p->other.shape.context = context;
    return gnoi_cover_make(scene, &p->cover) ? gno_clipper_create(context, &p->clipper) : GNO_ERROR_MEMORY;
}

void gnoi_parter_free(gnoi_parter *p)
{
    if (!p->context)
        return;
    gno_clipper_destroy(p->clipper);
    gnoi_cover_free(&p->cover);
    gnoi_shape_free(&p->outline);
    gnoi_shape_free(&p->work[0]);
    gnoi_shape_free(&p->work[1]);
    gnoi_parts_free(&p->parts);
    gnoi_parts_free(&p->other);
}

void gnoi_parts_clear(gnoi_parts *parts) { gnoi_shape_clear(&parts->shape); }

void gnoi_parts_free(gnoi_parts *parts)
{
    gnoi_free(parts->shape.context, parts->passed, parts->passed_capacity, sizeof *parts->passed);
    gnoi_shape_free(&parts->shape);
}

int gnoi_parts_add(gnoi_parts *parts, const gno_shape *from, size_t polygon, const double passed[3])
{
    size_t k = parts->shape.polygon_count;
    if (!gnoi_reserve(parts->shape.context, (void **)&parts->passed, &parts->passed_capacity, 3 * (k + 1), sizeof *parts->passed) ||
        !gnoi_shape_append(&parts->shape, from, polygon, 1))
        return 0;
    memcpy(parts->passed + 3 * k, passed, 3 * sizeof *passed);
    return 1;
}

gno_status gnoi_parter_clip(gnoi_parter *p, gno_clip_op op, const gno_shape *subject, const gno_shape *clip, gnoi_shape *out)
{
    gno_shape result;
    gno_status status = gnoi_clip(p->clipper, op, subject, clip, &result);
    gnoi_shape_clear(out);
    if (status)
        return status;
    return gnoi_shape_append(out, &result, 0, result.polygon_count) ? GNO_OK : GNO_ERROR_MEMORY;
}

/* ---- what is reached ------------------------------------------------------------------------------------------------ */

static int apart(const double a[4], const double b[4]) { return a[2] <= b[0] || b[2] <= a[0] || a[3] <= b[1] || b[3] <= a[1]; }

/* Adds op(part, veil) to p->other. */
static gno_status add_clipped(gnoi_parter *p, gno_clip_op op, const gno_shape *part, const gno_shape *veil, const double passed[3])
{
    gno_shape result;
    gno_status status = gnoi_clip(p->clipper, op, part, veil, &result);
    for (size_t i = 0; i < result.polygon_count && !status; i++)
        if (!gnoi_parts_add(&p->other, &result, i, passed))
            status = GNO_ERROR_MEMORY;
    return status;
}

/* Polygon k of a shape as a shape of its own; start: room for its one offset pair. */
static gno_shape single(const gno_shape *from, size_t k, size_t start[2])
{
    gno_shape one = *from;
    size_t first = from->polygon_start[k];
    start[0] = 0;
    start[1] = from->polygon_start[k + 1] - first;
    one.polygon_count = 1;
    one.polygon_start = start;
    one.ring_count = start[1];
    one.ring_start = from->ring_start + first;
    return one;
}

/* Splits every part at veil k. */
static gno_status split_by_veil(gnoi_parter *p, const gnoi_canvas *canvas, size_t k)
{
    const gno_scene *scene = canvas->centre->scene;
    const double *t = scene->materials[scene->prepared.polys[p->cover.veil_index.items[k]].material].transmission;
    gno_shape veils = gnoi_shape_view(&p->cover.veils), parts = gnoi_shape_view(&p->parts.shape);
    size_t veil_start[2], part_start[2];
    gno_shape veil = single(&veils, k, veil_start);
    double veil_box[4], box[4];
    gno_status status = GNO_OK;
    gnoi_parts swap;
    gnoi_shape_box(&veils, k, veil_box);
    gnoi_parts_clear(&p->other);
    for (size_t i = 0; i < parts.polygon_count && !status; i++) {
        const double *passed = p->parts.passed + 3 * i;
        double less[3] = {passed[0] * t[0], passed[1] * t[1], passed[2] * t[2]};
        gno_shape part = single(&parts, i, part_start);
        gnoi_shape_box(&parts, i, box);
        if (apart(box, veil_box)) {
            status = gnoi_parts_add(&p->other, &parts, i, passed) ? GNO_OK : GNO_ERROR_MEMORY;
            continue;
        }
        status = add_clipped(p, GNO_CLIP_DIFFERENCE, &part, &veil, passed);
        if (!status)
            status = add_clipped(p, GNO_CLIP_INTERSECTION, &part, &veil, less);
    }
    swap = p->parts;
    p->parts = p->other;
    p->other = swap;
    return status;
}

gno_status gnoi_parter_reach(gnoi_parter *p, const gnoi_canvas *canvas, const gno_shape *region)
{
    gno_shape cone = gnoi_shape_view(&p->cover.cone), casters = gnoi_shape_view(&p->cover.casters), now = *region;
    gno_status status = GNO_OK;
    gnoi_parts_clear(&p->parts);
    if (cone.polygon_count > 0) {
        status = gnoi_parter_clip(p, GNO_CLIP_INTERSECTION, &now, &cone, &p->work[0]);
        now = gnoi_shape_view(&p->work[0]);
    }
    if (!status && (casters.polygon_count > 0 || cone.polygon_count == 0)) {
        status = gnoi_parter_clip(p, GNO_CLIP_DIFFERENCE, &now, &casters, &p->work[1]);
        now = gnoi_shape_view(&p->work[1]);
    }
    for (size_t i = 0; i < now.polygon_count && !status; i++)
        status = gnoi_parts_add(&p->parts, &now, i, full) ? GNO_OK : GNO_ERROR_MEMORY;
    for (size_t k = 0; k < p->cover.veils.polygon_count && !status; k++)
        status = gnoi_stopped(p->context) ? GNO_ERROR_MEMORY : split_by_veil(p, canvas, k);
    return status;
}

/* Appends op(subject, clip) to out. */
static gno_status append_clipped(gnoi_parter *p, gno_clip_op op, const gno_shape *subject, const gno_shape *clip, gnoi_shape *out)
{
    gno_shape result;
    gno_status status = gnoi_clip(p->clipper, op, subject, clip, &result);
    if (status)
        return status;
    return gnoi_shape_append(out, &result, 0, result.polygon_count) ? GNO_OK : GNO_ERROR_MEMORY;
}

gno_status gnoi_parter_unite(gnoi_parter *p)
{
    gno_shape casters = gnoi_shape_view(&p->cover.casters);
    gnoi_shape swap;
    gno_status status = gnoi_parter_clip(p, GNO_CLIP_UNION, &casters, NULL, &p->work[0]);
    swap = p->cover.casters;
    p->cover.casters = p->work[0];
    p->work[0] = swap;
    return status;
}

gno_status gnoi_parter_shadow(gnoi_parter *p, const gno_shape *region, int veiled, gnoi_shape *out)
{
    gno_shape cone = gnoi_shape_view(&p->cover.cone), veils = gnoi_shape_view(&p->cover.veils), casters, now = *region;
    size_t polygons = p->cover.casters.polygon_count, rings = p->cover.casters.ring_count, points = p->cover.casters.point_count;
    gno_status status = GNO_OK;
    gnoi_shape_clear(out);
    if (cone.polygon_count > 0) {
        status = append_clipped(p, GNO_CLIP_DIFFERENCE, region, &cone, out);
        if (!status)
            status = gnoi_parter_clip(p, GNO_CLIP_INTERSECTION, region, &cone, &p->work[0]);
        now = gnoi_shape_view(&p->work[0]);
    }
    if (!status && veiled && !gnoi_shape_append(&p->cover.casters, &veils, 0, veils.polygon_count))
        status = GNO_ERROR_MEMORY;
    casters = gnoi_shape_view(&p->cover.casters);
    if (!status && casters.polygon_count > 0)
        status = append_clipped(p, GNO_CLIP_INTERSECTION, &now, &casters, out);
    gnoi_shape_cut(&p->cover.casters, polygons, rings, points);
    return status;
}

gno_status gnoi_parter_area(gnoi_parter *p, const gno_shape *shape, double *area)
{
    gno_shape result;
    gno_status status = gnoi_clip(p->clipper, GNO_CLIP_UNION, shape, NULL, &result);
    *area = status ? 0 : gno_shape_area(&result);
    return status;
}
