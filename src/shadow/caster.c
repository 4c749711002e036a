/* caster.c -- does a candidate darken a receiver, and with what shadow polygon: see pair.h and column.h. */
#include "shadow/pair.h"
#include "base/tolerance.h"

/* The part of a caster within this share of the light's height from the light is cut away: it would throw its shadow
 * further than coordinates reach. */
#define LIGHT_GAP 1e-9

/* In pixels: a shadow polygon that overlaps its receiver by less is taken to touch it. */
#define OUTSIDE_SLACK 1e-7

static gnoi_form shadow_form(const gnoi_pair *p, const gnoi_form *f)
{
    gnoi_form r;
    double at_lamp = p->lamp->directional ? v3_dot(f->a, p->lamp->to_light) : gnoi_form_at(f, p->lamp->position);
    r.a = v3_sub(v3_scale(f->a, p->lamp_height), v3_scale(p->h.a, at_lamp));
    r.b = f->b * p->lamp_height - p->h.b * at_lamp;
    return r;
}

int gnoi_pair_make(gnoi_pair *p, const gno_scene *scene, const gnoi_view *view, const gnoi_lamp *lamp, const gnoi_receiver *receiver)
{
    const gnoi_poly *poly = receiver->poly;
    double side = gnoi_lamp_side(lamp, poly->n, poly->d), sign = side < 0 ? -1 : 1;
    if (!(side * receiver->side > 0))
        return 0;
    p->scene = scene;
    p->receiver = receiver;
    p->lamp = lamp;
    p->h.a = v3_scale(v3_from(poly->n), sign);
    p->h.b = poly->d * sign;
    p->lamp_height = side * sign;
    p->tolerance = receiver->tolerance;
    p->x = shadow_form(p, &view->x);
    p->y = shadow_form(p, &view->y);
    p->w = shadow_form(p, &view->w);
    p->w_min = view->orthographic ? -1 : view->near_depth * p->lamp_height;
    p->triangle = poly->corner_count == 3;
    for (uint32_t k = 0; k < 3 && p->triangle; k++)
        p->corner[k] = gnoi_corner_position(scene, poly->corner + k);
    return 1;
}

/* ---- exact tests and shadow polygons ------------------------------------------------------------------------------ */

/* 1 when some corner of the caster rises above the receiver's plane. */
static int rises(const gnoi_pair *p, const gnoi_poly *caster, int *cut_below, int *cut_above)
{
    int above = 0;
    double top = p->lamp_height * (1 - LIGHT_GAP);
    *cut_below = *cut_above = 0;
    for (uint32_t i = 0; i < caster->corner_count; i++) {
        double h = gnoi_form_at(&p->h, gnoi_corner_position(p->scene, caster->corner + i));
        above |= h > p->tolerance;
        *cut_below |= h < -p->tolerance;
        *cut_above |= !p->lamp->directional && h > top;
    }
    return above;
}

/* 1 when the receiver lies on the caster's plane: the two are coplanar where it matters, though the small one's plane, drawn out
 * from corners that a file rounded, may leave the large one's far corners. */
static int carries(const gnoi_pair *p, const gnoi_poly *caster)
{
    const gnoi_poly *poly = p->receiver->poly;
    for (uint32_t i = 0; i < poly->corner_count; i++)
        if (fabs(v3_dot(v3_from(caster->n), gnoi_corner_position(p->scene, poly->corner + i)) + caster->d) > p->tolerance)
            return 0;
    return 1;
}

/* 1 when the plane through the light and an edge of triangle a, a on its positive side, has triangle b on its other side. */
static int parted_by_edge(const gnoi_pair *p, const vec3 a[3], const vec3 b[3])
{
    for (int k = 0; k < 3; k++) {
        vec3 from = a[k], to = a[k < 2 ? k + 1 : 0], third = a[k > 0 ? k - 1 : 2];
        vec3 n = v3_cross(v3_sub(to, from), p->lamp->directional ? p->lamp->to_light : v3_sub(p->lamp->position, from));
        double sign = v3_dot(n, v3_sub(third, from)) < 0 ? -1 : 1;
        double slack = 1e-3 * p->tolerance * sqrt(v3_dot(n, n));
        if (sign * v3_dot(n, v3_sub(b[0], from)) <= slack && sign * v3_dot(n, v3_sub(b[1], from)) <= slack &&
            sign * v3_dot(n, v3_sub(b[2], from)) <= slack)
            return 1;
    }
    return 0;
}

/* By separating axes. */
int gnoi_pair_separated(const gnoi_pair *p, const gnoi_poly *caster)
{
    vec3 c[3];
    if (!p->triangle || caster->corner_count != 3)
        return 0;
    for (uint32_t i = 0; i < 3; i++)
        c[i] = gnoi_corner_position(p->scene, caster->corner + i);
    return parted_by_edge(p, p->corner, c) || parted_by_edge(p, c, p->corner);
}

static vec3 scene_point(const gnoi_hpoint *p) { return v3(p->x, p->y, p->w); }

/* Two halves of columns->points; a cut reads one and writes the other. */
typedef struct ring_points {
    gnoi_hpoint *now, *next;
    size_t count;
} ring_points;

static void cut_ring(ring_points *r)
{
    gnoi_hpoint *swap = r->now;
    r->count = gnoi_clip_ring(r->now, r->count, r->next);
    r->now = r->next;
    r->next = swap;
}

/* One ring of the caster cut to the part that can throw a shadow, as homogeneous picture points of that shadow. */
static void shadow_ring(const gnoi_pair *p, uint32_t first, uint32_t count, int cut_below, int cut_above, ring_points *r)
{
    double top = p->lamp_height * (1 - LIGHT_GAP);
    int behind = 0;
    r->count = count;
    for (uint32_t i = 0; i < count; i++) {
        vec3 q = gnoi_corner_position(p->scene, first + i);
        double h = gnoi_form_at(&p->h, q);
        gnoi_hpoint *a = &r->now[i];
        a->x = q.x;
        a->y = q.y;
        a->w = q.z;
        a->side = fabs(h) <= p->tolerance ? 0 : h;
    }
    if (cut_below)
        cut_ring(r);
    if (cut_above) {
        for (size_t i = 0; i < r->count; i++)
            r->now[i].side = top - gnoi_form_at(&p->h, scene_point(&r->now[i]));
        cut_ring(r);
    }
    for (size_t i = 0; i < r->count; i++) {
        gnoi_hpoint *a = &r->now[i];
        vec3 q = scene_point(a);
        a->x = gnoi_form_at(&p->x, q);
        a->y = gnoi_form_at(&p->y, q);
        a->w = gnoi_form_at(&p->w, q);
        a->side = a->w - p->w_min;
        behind |= !(a->side > 0);
    }
    if (behind)
        cut_ring(r);
}

static int edges_reserve(gnoi_columns *columns, size_t more)
{
    return gnoi_reserve(columns->context, (void **)&columns->edges, &columns->edge_capacity, columns->edge_count + more,
                        sizeof *columns->edges);
}

typedef struct extent {
    double x0, y0, x1, y1;
} extent;

static void extent_add(extent *e, double x, double y)
{
    e->x0 = x < e->x0 ? x : e->x0;
    e->x1 = x > e->x1 ? x : e->x1;
    e->y0 = y < e->y0 ? y : e->y0;
    e->y1 = y > e->y1 ? y : e->y1;
}

static int add_ring_edges(ring_points *r, extent *e, gnoi_columns *columns)
{
    if (!edges_reserve(columns, r->count))
        return 0;
    for (size_t i = 0; i < r->count; i++) {
        gnoi_hpoint *a = &r->now[i];
        a->x /= a->w;
        a->y /= a->w;
        extent_add(e, a->x, a->y);
    }
    for (size_t i = 0; i < r->count; i++) {
        const gnoi_hpoint *a = &r->now[i], *b = &r->now[i + 1 < r->count ? i + 1 : 0];
        columns->edge_count += (size_t)gnoi_edge_set(&columns->edges[columns->edge_count], a->x, a->y, b->x, b->y);
    }
    return 1;
}

static double ring_area(const ring_points *r)
{
    double area = 0;
    for (size_t i = 1; i + 1 < r->count; i++) {
        const gnoi_hpoint *a = &r->now[0], *b = &r->now[i], *c = &r->now[i + 1];
        area += 0.5 * ((b->x - a->x) * (c->y - a->y) - (b->y - a->y) * (c->x - a->x));
    }
    return fabs(area);
}

typedef struct point2 {
    double x, y;
} point2;

/* +1, -1 for a convex ring by its turn, 0 for one that is not convex. */
static int convex_turn(const point2 *ring, size_t count)
{
    int positive = 0, negative = 0;
    for (size_t i = 0; i < count; i++) {
        point2 a = ring[i], b = ring[(i + 1) % count], c = ring[(i + 2) % count];
        double turn = (b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x);
        positive |= turn > 0;
        negative |= turn < 0;
    }
    return positive - negative;
}

/* How the points lie to a convex ring: all inside or on it, all outside one of its edges (or reaching over it by no more than
 * rounding), or otherwise. */
typedef enum relation { ALL_INSIDE, ALL_OUTSIDE, MIXED } relation;

static relation relate(const point2 *ring, size_t count, int turn, const point2 *points, size_t point_count)
{
    relation r = ALL_INSIDE;
    for (size_t i = 0; i < count; i++) {
        point2 a = ring[i], b = ring[i + 1 < count ? i + 1 : 0];
        double ex = turn * (b.x - a.x), ey = turn * (b.y - a.y), slack = OUTSIDE_SLACK * (fabs(ex) + fabs(ey));
        size_t out = 0;
        for (size_t k = 0; k < point_count; k++) {
            double s = ex * (points[k].y - a.y) - ey * (points[k].x - a.x);
            out += s <= slack;
            if (s < 0)
                r = MIXED;
        }
        if (out == point_count)
            return ALL_OUTSIDE;
    }
    return r;
}

/* The receiver's region as picture points: its own corners when it lies wholly inside. */
static size_t region_points(const gnoi_pair *p, const gnoi_view *view, point2 points[4])
{
    const gnoi_receiver *r = p->receiver;
    if (r->whole && p->triangle) {
        for (int i = 0; i < 3; i++) {
            double w = gnoi_form_at(&view->w, p->corner[i]);
            points[i].x = gnoi_form_at(&view->x, p->corner[i]) / w;
            points[i].y = gnoi_form_at(&view->y, p->corner[i]) / w;
        }
        return 3;
    }
    for (int i = 0; i < 4; i++) {
        points[i].x = i == 1 || i == 2 ? r->x1 : r->x0;
        points[i].y = i >= 2 ? r->y1 : r->y0;
    }
    return 4;
}

/* How a convex shadow polygon lies to the receiver's region. */
static relation relate_shadow(const gnoi_hpoint *ring, size_t count, const point2 *region, size_t region_count)
{
    point2 shadow[GNOI_FRAME_POINTS];
    int turn;
    if (count < 3 || count > GNOI_FRAME_POINTS)
        return MIXED;
    for (size_t i = 0; i < count; i++) {
        shadow[i].x = ring[i].x;
        shadow[i].y = ring[i].y;
    }
    turn = convex_turn(region, region_count);
    if (turn && relate(region, region_count, turn, shadow, count) == ALL_OUTSIDE)
        return ALL_OUTSIDE;
    turn = convex_turn(shadow, count);
    return turn ? relate(shadow, count, turn, region, region_count) : MIXED;
}

/* A float surely below v. */
static float lowered(double v) { return (float)v - 1e-2f - 1e-6f * fabsf((float)v); }

gnoi_found gnoi_pair_try(const gnoi_pair *p, const gnoi_view *view, uint32_t index, gnoi_columns *columns)
{
    const gnoi_prepared *prep = &p->scene->prepared;
    const gnoi_poly *caster = &prep->polys[index];
    const gnoi_receiver *region = p->receiver;
    int cut_below, cut_above;
    extent e = {HUGE_VAL, HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    size_t first_edge = columns->edge_count, room = 4 * (size_t)caster->corner_count + 16;
    ring_points r = {NULL, NULL, 0};
    gnoi_caster *c;
    if (!rises(p, caster, &cut_below, &cut_above) || gnoi_pair_separated(p, caster) ||
        carries(p, caster))
        return GNOI_FOUND_NOTHING;
    if (!gnoi_reserve(columns->context, (void **)&columns->points, &columns->point_capacity, 2 * room, sizeof *columns->points) ||
        !gnoi_reserve(columns->context, (void **)&columns->casters, &columns->caster_capacity, columns->caster_count + 1,
                      sizeof *columns->casters))
        return GNOI_FOUND_NO_MEMORY;
    r.now = columns->points;
    r.next = columns->points + columns->point_capacity / 2;
    for (uint32_t k = 0; k < caster->ring_count; k++) {
        const uint32_t *corner = &prep->ring_corner[caster->ring + k];
        shadow_ring(p, corner[0], corner[1] - corner[0], cut_below, cut_above, &r);
        if (!add_ring_edges(&r, &e, columns))
            return GNOI_FOUND_NO_MEMORY;
    }
    if (!(e.x1 > region->x0 && e.x0 < region->x1 && e.y1 > region->y0 && e.y0 < region->y1)) {
        columns->edge_count = first_edge;
        return GNOI_FOUND_NOTHING;
    }
    if (caster->ring_count == 1) {
        point2 points[4];
        relation how = relate_shadow(r.now, r.count, points, region_points(p, view, points));
        if (how == ALL_OUTSIDE || (how == ALL_INSIDE && caster->opaque && !(p->lamp->softness > 0))) {
            columns->edge_count = first_edge;
            return how == ALL_OUTSIDE ? GNOI_FOUND_NOTHING : GNOI_FOUND_ALL;
        }
    }
    c = &columns->casters[columns->caster_count++];
    c->x0 = lowered(e.x0);
    c->x1 = -lowered(-e.x1);
    c->y0 = lowered(e.y0);
    c->y1 = -lowered(-e.y1);
    c->edge = (uint32_t)first_edge;
    c->edge_count = (uint32_t)(columns->edge_count - first_edge);
    c->poly = index;
    c->material = caster->material;
    c->area = caster->ring_count == 1 ? (float)ring_area(&r) : 0;
    return GNOI_FOUND_PART;
}
