/* flux.c -- see flux.h. */
#include "shadow/flux.h"

#include <math.h>

/* Casters lying wholly within one of so many large convex ones are left out of the union, which they do not change. */
#define LARGE 8
#define LARGE_CORNERS 64 /* of their outlines at most: every point is tried against every side */

#define FACES 6

/* (u axis, v axis, depth) of a cube face: faces 0..5 look along +x, -x, +y, -y, +z, -z. */
static vec3 to_face(vec3 q, int face)
{
    double s = face & 1 ? -1 : 1;
    switch (face >> 1) {
    case 0: return v3(s * q.y, q.z, s * q.x);
    case 1: return v3(s * q.z, q.x, s * q.y);
    default: return v3(s * q.x, q.y, s * q.z);
    }
}

static double pyramid_side(const gnoi_hpoint *q, int side)
{
    switch (side) {
    case 0: return q->w - q->x;
    case 1: return q->w + q->x;
    case 2: return q->w - q->y;
    default: return q->w + q->y;
    }
}

/* Cuts the ring at `from` (w: depth) to the face's pyramid, between the two buffers; returns where the rest lies and its number. */
static gnoi_hpoint *cut_to_face(gnoi_hpoint *from, gnoi_hpoint *other, size_t *count)
{
    for (int side = 0; side < 4 && *count > 0; side++) {
        gnoi_hpoint *swap = from;
        int below = 0;
        for (size_t i = 0; i < *count; i++) {
            from[i].side = pyramid_side(&from[i], side);
            below |= from[i].side < 0;
        }
        if (!below)
            continue;
        *count = gnoi_clip_ring(from, *count, other);
        from = other;
        other = swap;
    }
    return from;
}

static double ring_area(const gnoi_hpoint *p, size_t count)
{
    double area = 0, x0, y0;
    if (count < 3 || !(p[0].w > 0))
        return 0;
    x0 = p[0].x / p[0].w;
    y0 = p[0].y / p[0].w;
    for (size_t i = 1; i + 1 < count; i++)
        area += 0.5 * ((p[i].x / p[i].w - x0) * (p[i + 1].y / p[i + 1].w - y0) - (p[i].y / p[i].w - y0) * (p[i + 1].x / p[i + 1].w - x0));
    return area;
}

/* Two buffers for a ring of `count` points, each large enough for four cuts. */
static int buffers(gnoi_cover *scratch, size_t count, gnoi_hpoint **a, gnoi_hpoint **b)
{
    size_t room = 6 * count + 64;
    if (!gnoi_reserve(scratch->context, (void **)&scratch->points, &scratch->point_capacity, 2 * room, sizeof **a))
        return 0;
    *a = scratch->points;
    *b = scratch->points + scratch->point_capacity / 2;
    return 1;
}

static gnoi_hpoint face_point(const gnoi_lamp *lamp, vec3 p, int face)
{
    vec3 q = to_face(v3_sub(p, lamp->position), face);
    gnoi_hpoint a;
    a.x = q.x;
    a.y = q.y;
    a.w = q.z;
    a.side = 0;
    return a;
}

int gnoi_flux_of(const gnoi_canvas *canvas, const gno_shape *shape, size_t first, size_t count, gnoi_cover *scratch, double *flux)
{
    const gnoi_lamp *lamp = &canvas->centre->lamp;
    *flux = 0;
    for (size_t k = first; k < first + count; k++) {
        if (lamp->directional) {
            *flux += gnoi_shape_moment(shape, k).area * canvas->height;
            continue;
        }
        for (size_t r = shape->polygon_start[k]; r < shape->polygon_start[k + 1]; r++) {
            const double *p = shape->points + 2 * shape->ring_start[r];
            size_t n = shape->ring_start[r + 1] - shape->ring_start[r];
            double area = 0;
            for (int face = 0; face < FACES; face++) {
                gnoi_hpoint *a, *b;
                size_t left = n;
                if (!buffers(scratch, n, &a, &b))
                    return 0;
                for (size_t i = 0; i < n; i++)
                    a[i] = face_point(lamp, gnoi_canvas_point(canvas, p[2 * i], p[2 * i + 1]), face);
                a = cut_to_face(a, b, &left);
                area += fabs(ring_area(a, left));
            }
            *flux += r > shape->polygon_start[k] ? -area : area;
        }
    }
    return 1;
}

/* ---- the union of all casters ---------------------------------------------------------------------------------------- */

/* Appends the outline of a caster on one face (a light at infinity: on its plane). */
static int add_outline(const gnoi_centre *centre, uint32_t index, int face, gnoi_cover *scratch, gnoi_shape *out)
{
    const gnoi_prepared *prep = &centre->scene->prepared;
    const gnoi_frame *frame = &centre->tree.frame;
    const gnoi_poly *poly = &prep->polys[index];
    size_t first_ring = out->ring_count;
    for (uint32_t k = 0; k < poly->ring_count; k++) {
        uint32_t first = prep->ring_corner[poly->ring + k];
        size_t n = prep->ring_corner[poly->ring + k + 1] - first;
        gnoi_hpoint *a, *b;
        double *to;
        if (!buffers(scratch, n, &a, &b))
            return 0;
        for (size_t i = 0; i < n; i++) {
            vec3 p = gnoi_corner_at(centre->scene, first + (uint32_t)i);
            if (centre->lamp.directional) {
                vec3 q = v3_sub(p, frame->origin);
                a[i].x = v3_dot(q, frame->axis[0]);
                a[i].y = v3_dot(q, frame->axis[1]);
                a[i].w = 1;
            } else
                a[i] = face_point(&centre->lamp, p, face);
        }
        if (!centre->lamp.directional)
            a = cut_to_face(a, b, &n);
        if (n < 3) {
            if (k == 0)
                return 1;
            continue;
        }
        to = gnoi_shape_ring(out, n);
        if (!to)
            return 0;
        for (size_t i = 0; i < n; i++) {
            to[2 * i] = a[i].w > 0 ? a[i].x / a[i].w : 0;
            to[2 * i + 1] = a[i].w > 0 ? a[i].y / a[i].w : 0;
        }
        if (!gnoi_shape_end_ring(out, n))
            return 0;
    }
    return gnoi_shape_end_polygon(out, first_ring);
}

/* The largest convex outlines, to leave out what lies within them. */
typedef struct large {
    int count;
    size_t polygon[LARGE];
    double area[LARGE];
} large;

static void add_large(large *l, const gno_shape *shape, size_t polygon)
{
    double area = gnoi_shape_moment(shape, polygon).area;
    size_t r = shape->polygon_start[polygon];
    int k = l->count < LARGE ? l->count : LARGE;
    if (shape->ring_start[r + 1] - shape->ring_start[r] > LARGE_CORNERS || (k == LARGE && area <= l->area[LARGE - 1]))
        return;
    l->count += k < LARGE;
    for (k = k < LARGE ? k : LARGE - 1; k > 0 && l->area[k - 1] < area; k--) {
        l->area[k] = l->area[k - 1];
        l->polygon[k] = l->polygon[k - 1];
    }
    l->area[k] = area;
    l->polygon[k] = polygon;
}

/* 1 when every point of polygon k's outer ring lies inside or on the convex ring of polygon j. */
static int within(const gno_shape *shape, size_t k, size_t j)
{
    size_t r = shape->polygon_start[j], first = shape->ring_start[r], n = shape->ring_start[r + 1] - first;
    size_t ring = shape->polygon_start[k];
    const double *c = shape->points + 2 * first;
    double turn = 0;
    for (size_t i = 1; i + 1 < n; i++)
        turn += (c[2 * i] - c[0]) * (c[2 * i + 3] - c[1]) - (c[2 * i + 1] - c[1]) * (c[2 * i + 2] - c[0]);
    for (size_t m = shape->ring_start[ring]; m < shape->ring_start[ring + 1]; m++)
        for (size_t i = 0; i < n; i++) {
            const double *a = c + 2 * i, *b = c + 2 * (i + 1 < n ? i + 1 : 0), *p = shape->points + 2 * m;
            double s = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
            if (turn < 0 ? s > 0 : s < 0)
                return 0;
        }
    return 1;
}

/* Copies the casters' outlines without those within a large one. */
static int thin_out(const gno_shape *all, const large *l, gnoi_shape *out)
{
    for (size_t k = 0; k < all->polygon_count; k++) {
        int inside = 0;
        if (gnoi_stopped_at(out->context, k))
            return 0;
        for (int i = 0; i < l->count && !inside; i++)
            inside = l->polygon[i] != k && within(all, k, l->polygon[i]) && !(k < l->polygon[i] && within(all, l->polygon[i], k));
        if (!inside && !gnoi_shape_append(out, all, k, 1))
            return 0;
    }
    return 1;
}

/* The spot's pyramid on one face. */
static int add_cone(const gnoi_centre *centre, int face, gnoi_cover *scratch, gnoi_shape *out)
{
    gnoi_hpoint *a, *b;
    size_t n = GNOI_CONE_SIDES;
    double *to;
    if (!buffers(scratch, n, &a, &b))
        return 0;
    for (int i = 0; i < GNOI_CONE_SIDES; i++)
        a[i] = face_point(&centre->lamp, v3_add(centre->lamp.position, gnoi_cone_edge(&centre->lamp, i)), face);
    a = cut_to_face(a, b, &n);
    if (n < 3)
        return 1;
    to = gnoi_shape_ring(out, n);
    if (!to)
        return 0;
    for (size_t i = 0; i < n; i++) {
        to[2 * i] = a[i].x / a[i].w;
        to[2 * i + 1] = a[i].y / a[i].w;
    }
    return gnoi_shape_end_ring(out, n) && gnoi_shape_end_polygon(out, 0);
}

static gno_status face_union(const gnoi_centre *centre, gnoi_parter *p, int face, double *area)
{
    const gnoi_prepared *prep = &centre->scene->prepared;
    large l = {0, {0}, {0}};
    gno_shape all, cone;
    gno_status status = GNO_OK;
    gnoi_shape_clear(&p->work[0]);
    gnoi_shape_clear(&p->work[1]);
    gnoi_shape_clear(&p->cover.cone);
    *area = 0;
    for (size_t i = 0; i < prep->poly_count; i++) {
        size_t k = p->work[0].polygon_count;
        if (!centre->stands[i].hides)
            continue;
        if (gnoi_stopped_at(p->context, i) || !add_outline(centre, (uint32_t)i, face, &p->cover, &p->work[0]))
            return GNO_ERROR_MEMORY;
        all = gnoi_shape_view(&p->work[0]);
        if (p->work[0].polygon_count > k && centre->stands[i].convex)
            add_large(&l, &all, k);
    }
    all = gnoi_shape_view(&p->work[0]);
    if (!thin_out(&all, &l, &p->work[1]))
        return GNO_ERROR_MEMORY;
    all = gnoi_shape_view(&p->work[1]);
    if (!centre->lamp.spot)
        return gnoi_parter_area(p, &all, area);
    if (!add_cone(centre, face, &p->cover, &p->cover.cone))
        return GNO_ERROR_MEMORY;
    cone = gnoi_shape_view(&p->cover.cone);
    if (cone.polygon_count > 0)
        status = gnoi_parter_clip(p, GNO_CLIP_INTERSECTION, &all, &cone, &p->work[0]);
    else
        gnoi_shape_clear(&p->work[0]);
    all = gnoi_shape_view(&p->work[0]);
    *area = status ? 0 : gno_shape_area(&all);
    return status;
}

gno_status gnoi_flux_union(const gnoi_centre *centre, gnoi_parter *p, double *flux)
{
    gno_status status = GNO_OK;
    *flux = 0;
    for (int face = 0; face < (centre->lamp.directional ? 1 : FACES) && !status; face++) {
        double area;
        status = face_union(centre, p, face, &area);
        *flux += area;
    }
    return status;
}
