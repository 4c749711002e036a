/* receiver.c -- see receiver.h. */
#include "shadow/receiver.h"

/* An outline whose area is less than so many times its length times the shift of its corners is measured by the clipper. */
#define BENT 100

/* Twice the area of a ring about n. */
static double ring_area(const gno_scene *scene, uint32_t first, uint32_t end, vec3 n)
{
    vec3 origin = gnoi_corner_at(scene, first), before = v3(0, 0, 0), sum = v3(0, 0, 0);
    for (uint32_t i = first + 1; i < end; i++) {
        vec3 q = v3_sub(gnoi_corner_at(scene, i), origin);
        sum = v3_add(sum, v3_cross(before, q));
        before = q;
    }
    return v3_dot(sum, n);
}

/* A convex polygon by its vector area; others under even-odd filling by the clipper, as their rings may cross. */
gno_status gnoi_true_area(gnoi_parter *p, const gnoi_centre *centre, uint32_t index, double *area)
{
    const gno_scene *scene = centre->scene;
    const gnoi_prepared *prep = &scene->prepared;
    const gnoi_poly *poly = &prep->polys[index];
    vec3 n = v3_from(poly->n), origin = gnoi_corner_at(scene, poly->corner), u, v;
    gno_shape view;
    if (centre->stands[index].convex) {
        *area = 0.5 * ring_area(scene, poly->corner, poly->corner + poly->corner_count, n);
        return GNO_OK;
    }
    gnoi_plane_axes(n, &u, &v);
    gnoi_shape_clear(&p->work[0]);
    for (uint32_t k = 0; k < poly->ring_count; k++) {
        uint32_t first = prep->ring_corner[poly->ring + k], count = prep->ring_corner[poly->ring + k + 1] - first;
        double *to = gnoi_shape_ring(&p->work[0], count);
        if (!to)
            return GNO_ERROR_MEMORY;
        for (uint32_t i = 0; i < count; i++) {
            vec3 q = v3_sub(gnoi_corner_at(scene, first + i), origin);
            to[2 * i] = v3_dot(u, q);
            to[2 * i + 1] = v3_dot(v, q);
        }
        if (!gnoi_shape_end_ring(&p->work[0], count))
            return GNO_ERROR_MEMORY;
    }
    if (!gnoi_shape_end_polygon(&p->work[0], 0))
        return GNO_ERROR_MEMORY;
    view = gnoi_shape_view(&p->work[0]);
    return gnoi_parter_area(p, &view, area);
}

/* 1 when a slanting ray moves corners off the plane so far that the outline seen need not be as simple as the true one. */
static int is_bent(const gnoi_receiver_view *r, double bend)
{
    const double *p = r->outline.points;
    double around = 0;
    if (bend <= r->canvas.centre->noise)
        return 0;
    for (size_t i = 0, n = r->outline.ring_start[1]; i < n; i++) {
        const double *a = p + 2 * i, *b = p + 2 * (i + 1 < n ? i + 1 : 0);
        around += hypot(b[0] - a[0], b[1] - a[1]);
    }
    return BENT * bend * hypot(r->canvas.along_u, r->canvas.along_v) * around > r->seen.area;
}

gno_status gnoi_receiver_make(gnoi_parter *p, const gnoi_centre *centre, uint32_t index, gnoi_receiver_view *r)
{
    gno_status status;
    double bend;
    r->canvas = gnoi_canvas_make(centre, index);
    gnoi_shape_clear(&p->outline);
    if (!gnoi_canvas_outline(&r->canvas, &p->cover, &p->outline, &r->whole))
        return GNO_ERROR_MEMORY;
    r->outline = gnoi_shape_view(&p->outline);
    r->convex = centre->stands[index].convex && r->outline.ring_count == 1;
    r->scale = 1;
    r->seen.area = r->seen.x = r->seen.y = 0;
    status = gnoi_true_area(p, centre, index, &r->true_area);
    if (status || r->outline.polygon_count == 0)
        return status;
    r->seen = gnoi_shape_moment(&r->outline, 0);
    bend = gnoi_canvas_bend(&r->canvas);
    if (!r->convex || is_bent(r, bend)) {
        double area = r->true_area, simple = r->seen.area;
        if (!r->whole || bend > centre->noise)
            status = gnoi_parter_area(p, &r->outline, &area);
        r->seen.area = area;
        r->seen.x *= simple > 0 ? area / simple : 0;
        r->seen.y *= simple > 0 ? area / simple : 0;
    }
    if (r->whole && r->seen.area > 0)
        r->scale = r->true_area / r->seen.area;
    return status;
}
