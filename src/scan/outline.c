/* outline.c -- a polygon's rings in the picture: see bins.h. */
#include "scan/bins.h"

/* Rings stay within this many picture sizes around the picture, so that coordinates keep their precision. */
#define GUARD 8.0

static int reserve_points(gnoi_outline *o, size_t need)
{
    return gnoi_reserve(o->context, (void **)&o->points, &o->capacity, need, sizeof *o->points);
}

static int start_ring(gnoi_outline *o)
{
    return gnoi_reserve(o->context, (void **)&o->ring_end, &o->ring_capacity, o->ring_count + 1, sizeof *o->ring_end);
}

static void add_point(gnoi_outline *o, double x, double y, float z)
{
    gnoi_hpoint *p = &o->points[o->count++];
    p->x = x;
    p->y = y;
    p->w = 1;
    o->x0 = x < o->x0 ? x : o->x0;
    o->x1 = x > o->x1 ? x : o->x1;
    o->y0 = y < o->y0 ? y : o->y0;
    o->y1 = y > o->y1 ? y : o->y1;
    o->z0 = z < o->z0 ? z : o->z0;
    o->z1 = z > o->z1 ? z : o->z1;
}

/* Signed value of cutting plane k at a homogeneous point: the near plane, then the four guard planes. */
static double guard_side(const gnoi_view *view, int k, const gnoi_hpoint *p)
{
    double gx = GUARD * view->width, gy = GUARD * view->height;
    switch (k) {
    case 0: return p->x + gx * p->w;
    case 1: return (view->width + gx) * p->w - p->x;
    case 2: return p->y + gy * p->w;
    default: return (view->height + gy) * p->w - p->y;
    }
}

/* Cuts one ring by the near plane in scene space (x, y, w hold a scene point then), then by the guard planes in homogeneous
 * picture coordinates. Returns the number of points at *result. */
static size_t cut_ring(const gno_scene *scene, const gnoi_view *view, uint32_t first, uint32_t end, gnoi_hpoint *a, gnoi_hpoint *b,
                       gnoi_hpoint **result)
{
    size_t n = end - first;
    gnoi_hpoint *swap;
    for (size_t i = 0; i < n; i++) {
        vec3 p = v3_from(scene->prepared.positions[scene->prepared.corner_vertex[first + i]]);
        a[i].x = p.x;
        a[i].y = p.y;
        a[i].w = p.z;
        a[i].side = gnoi_form_at(&view->depth, p) - view->near_depth;
    }
    n = gnoi_clip_ring(a, n, b);
    for (size_t i = 0; i < n; i++) {
        vec3 p = v3(b[i].x, b[i].y, b[i].w);
        b[i].x = gnoi_form_at(&view->x, p);
        b[i].y = gnoi_form_at(&view->y, p);
        b[i].w = gnoi_form_at(&view->w, p);
    }
    for (int k = 0; k < 4; k++) {
        swap = a;
        a = b;
        b = swap;
        for (size_t i = 0; i < n; i++)
            a[i].side = guard_side(view, k, &a[i]);
        n = gnoi_clip_ring(a, n, b);
    }
    *result = b;
    return n;
}

static int add_cut_ring(gnoi_outline *o, const gno_scene *scene, const gnoi_view *view, const gnoi_screen_plane *nearness, uint32_t first,
                        uint32_t end)
{
    size_t room = 33 * (size_t)(end - first) + 1, n; /* five cuts, each at most doubling */
    gnoi_hpoint *ring;
    if (!gnoi_reserve(o->context, (void **)&o->scratch, &o->scratch_capacity, 2 * room, sizeof *o->scratch))
        return 0;
    n = cut_ring(scene, view, first, end, o->scratch, o->scratch + room, &ring);
    if (!reserve_points(o, o->count + n))
        return 0;
    for (size_t i = 0; i < n; i++) {
        double x = ring[i].x / ring[i].w, y = ring[i].y / ring[i].w;
        add_point(o, x, y, (float)gnoi_plane_at(nearness, x, y));
    }
    return 1;
}

static int set_cut(gnoi_outline *o, const gno_scene *scene, const gnoi_view *view, const gnoi_poly *poly)
{
    double side = gnoi_view_side(view, poly->n, poly->d);
    gnoi_screen_plane nearness;
    o->count = o->ring_count = 0;
    o->x0 = o->y0 = HUGE_VAL;
    o->x1 = o->y1 = -HUGE_VAL;
    o->z0 = HUGE_VALF;
    o->z1 = -HUGE_VALF;
    o->cut = 1;
    if (side == 0)
        return 1;
    nearness = gnoi_view_nearness(view, poly->n, poly->d, side);
    for (uint32_t r = poly->ring; r < poly->ring + poly->ring_count; r++) {
        if (!start_ring(o) ||
            !add_cut_ring(o, scene, view, &nearness, scene->prepared.ring_corner[r], scene->prepared.ring_corner[r + 1]))
            return 0;
        o->ring_end[o->ring_count++] = (uint32_t)o->count;
    }
    return 1;
}

double gnoi_outline_reach(const gnoi_view *view)
{
    return GUARD * (view->width < view->height ? view->width : view->height);
}

int gnoi_outline_set(gnoi_outline *o, const gno_scene *scene, const gnoi_view *view, const gnoi_vertex *vertices,
                     const gnoi_poly *poly)
{
    const gnoi_prepared *prep = &scene->prepared;
    double reach = gnoi_outline_reach(view);
    o->count = o->ring_count = 0;
    o->x0 = o->y0 = HUGE_VAL;
    o->x1 = o->y1 = -HUGE_VAL;
    o->z0 = HUGE_VALF;
    o->z1 = -HUGE_VALF;
    o->cut = 0;
    if (!reserve_points(o, poly->corner_count))
        return 0;
    for (uint32_t r = poly->ring; r < poly->ring + poly->ring_count; r++) {
        if (!start_ring(o))
            return 0;
        for (uint32_t i = prep->ring_corner[r]; i < prep->ring_corner[r + 1]; i++) {
            const gnoi_vertex *v = &vertices[prep->corner_vertex[i]];
            add_point(o, v->x, v->y, v->z);
        }
        o->ring_end[o->ring_count++] = (uint32_t)o->count;
    }
    if (o->x0 >= -reach && o->x1 <= reach && o->y0 >= -reach && o->y1 <= reach)
        return 1;
    return set_cut(o, scene, view, poly);
}

void gnoi_outline_free(gnoi_outline *o)
{
    gnoi_free(o->context, o->points, o->capacity, sizeof *o->points);
    gnoi_free(o->context, o->ring_end, o->ring_capacity, sizeof *o->ring_end);
    gnoi_free(o->context, o->scratch, o->scratch_capacity, sizeof *o->scratch);
}
