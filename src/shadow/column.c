/* column.c -- finding the casters of a receiver: see column.h. */
#include "shadow/column.h"
#include "base/tolerance.h"
#include <stdlib.h>

/* The part of a caster within this share of the light's height from the light is cut away: it would throw its shadow
 * further than coordinates reach. */
#define LIGHT_GAP 1e-9

/* A candidate that reaches over an edge of the region by less than this share of the edge's length is ruled out: rounding of
 * corners that neighbours share comes to some 1e-7 of it. */
#define PROBE_SLACK 1e-6

/* In pixels: a shadow polygon that overlaps its receiver by less is taken to touch it. */
#define OUTSIDE_SLACK 1e-7

/* So many receivers wait for each other, while the box around them is no larger than so many times the newest one's. */
#define REQUESTS 64
#define REQUEST_SPREAD 16.0f

/* Columns of so many casters are sorted into rows. */
#define LONG_COLUMN 8

/* Everything about one (receiver, lamp) pair that its casters' tests share. */
typedef struct pair {
    const gno_scene *scene;
    const gnoi_receiver *receiver;
    const gnoi_lamp *lamp;
    gnoi_form h;         /* height over the receiver's plane, positive on the lit side */
    double lamp_height;  /* H; directional: the cosine */
    double tolerance;
    gnoi_form x, y, w;   /* homogeneous picture coordinates of the shadow */
    double w_min;
    int triangle;        /* the receiver has three corners */
    vec3 corner[3];
} pair;

static gnoi_form shadow_form(const pair *p, const gnoi_form *f)
{
    gnoi_form r;
    double at_lamp = p->lamp->directional ? v3_dot(f->a, p->lamp->to_light) : gnoi_form_at(f, p->lamp->position);
    r.a = v3_sub(v3_scale(f->a, p->lamp_height), v3_scale(p->h.a, at_lamp));
    r.b = f->b * p->lamp_height - p->h.b * at_lamp;
    return r;
}

static vec3 corner_position(const gno_scene *scene, uint32_t corner)
{
    return v3_from(scene->prepared.positions[scene->prepared.corner_vertex[corner]]);
}

static int pair_make(pair *p, const gno_scene *scene, const gnoi_view *view, const gnoi_lamp *lamp, const gnoi_receiver *receiver)
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
        p->corner[k] = corner_position(scene, poly->corner + k);
    return 1;
}

/* ---- region on the light's plane --------------------------------------------------------------------------------- */

/* Corners of the region on the receiver's plane; 0 when the plane's horizon passes through the region. */
static int region_corners(const gnoi_view *view, const gnoi_receiver *r, vec3 corners[4])
{
    double x[4], y[4], z[4], zmax = 0;
    for (int i = 0; i < 4; i++) {
        x[i] = i == 1 || i == 2 ? r->x1 : r->x0;
        y[i] = i >= 2 ? r->y1 : r->y0;
        z[i] = gnoi_plane_at(&r->nearness, x[i], y[i]);
        zmax = fabs(z[i]) > zmax ? fabs(z[i]) : zmax;
    }
    for (int i = 0; i < 4; i++) {
        if (!view->orthographic && !(z[i] > 1e-6 * zmax))
            return 0;
        corners[i] = gnoi_view_point(view, x[i], y[i], z[i]);
    }
    return 1;
}

static float min_f(float a, float b) { return a < b ? a : b; }
static float max_f(float a, float b) { return a > b ? a : b; }

/* Both boxes hold the receiver's region, so their common part does. */
static void box_intersect(gnoi_lbox *a, const gnoi_lbox *b)
{
    a->u0 = max_f(a->u0, b->u0);
    a->u1 = min_f(a->u1, b->u1);
    a->v0 = max_f(a->v0, b->v0);
    a->v1 = min_f(a->v1, b->v1);
    a->z1 = min_f(a->z1, b->z1);
}

/* The convex region's edges on the light's plane. */
static void set_probe_edges(gnoi_probe *probe, const gnoi_lpoint *p, int count)
{
    double area = 0;
    for (int i = 1; i + 1 < count; i++)
        area += (p[i].u - p[0].u) * (p[i + 1].v - p[0].v) - (p[i].v - p[0].v) * (p[i + 1].u - p[0].u);
    for (int i = 0; i < count; i++) {
        const gnoi_lpoint *a = &p[i], *b = &p[i + 1 < count ? i + 1 : 0];
        double s = area < 0 ? -1 : 1, du = (b->u - a->u) * s, dv = (b->v - a->v) * s;
        probe->a[i] = -dv;
        probe->b[i] = du;
        probe->c[i] = dv * a->u - du * a->v;
        probe->slack[i] = PROBE_SLACK * (du * du + dv * dv);
    }
    probe->edge_count = count;
}

/* The receiver's plane as nearness to the light over (u,v): from three of the points, when they span it. */
static int set_probe_plane(gnoi_probe *probe, const pair *p, const gnoi_lpoint *l, int count)
{
    double lift = 0.5 * p->tolerance / p->lamp_height, best = 0;
    int k = 1;
    const gnoi_lpoint *a = &l[0], *b, *c;
    for (int i = 1; i + 1 < count; i++) {
        double area = fabs((l[i].u - a->u) * (l[i + 1].v - a->v) - (l[i].v - a->v) * (l[i + 1].u - a->u));
        if (area > best) {
            best = area;
            k = i;
        }
    }
    if (!(best > 0))
        return 0;
    b = &l[k];
    c = &l[k + 1];
    best = (b->u - a->u) * (c->v - a->v) - (b->v - a->v) * (c->u - a->u);
    probe->qa = ((b->q - a->q) * (c->v - a->v) - (b->v - a->v) * (c->q - a->q)) / best;
    probe->qb = ((b->u - a->u) * (c->q - a->q) - (b->q - a->q) * (c->u - a->u)) / best;
    probe->qc = a->q - probe->qa * a->u - probe->qb * a->v;
    /* Height t over the plane lifts nearness by t q / H (point lamp) or t / cosine. */
    probe->qc += p->lamp->directional ? lift : lift * a->q;
    return 1;
}

/* Boxes of the region on the light's plane; *probed tells whether the probe may be used (one face only). */
static int region_boxes(const pair *p, const gnoi_view *view, const gnoi_frame *frame, gnoi_lbox boxes[6], gnoi_probe *probe,
                        int *probed)
{
    const gnoi_receiver *r = p->receiver;
    vec3 hull[GNOI_FRAME_POINTS], corners[4];
    gnoi_lpoint located[GNOI_FRAME_POINTS];
    int hull_count = gnoi_poly_hull(p->scene, r->poly, hull), n;
    *probed = 0;
    if (r->whole) {
        if (!gnoi_frame_locate(frame, hull, hull_count, located))
            return gnoi_frame_boxes(frame, hull, hull_count, boxes);
        gnoi_frame_box(frame, located, hull_count, &boxes[0]);
        probe->edge_count = 0;
        if (p->triangle)
            set_probe_edges(probe, located, 3);
        *probed = set_probe_plane(probe, p, located, hull_count);
        return 1;
    }
    if (!region_corners(view, r, corners))
        return gnoi_frame_boxes(frame, hull, hull_count, boxes);
    if (!gnoi_frame_locate(frame, corners, 4, located))
        return frame->faces == 6 ? gnoi_frame_boxes(frame, corners, 4, boxes) : gnoi_frame_boxes(frame, hull, hull_count, boxes);
    n = frame->faces == 1 ? gnoi_frame_boxes(frame, hull, hull_count, boxes) : 0;
    gnoi_lbox part;
    gnoi_frame_box(frame, located, 4, &part);
    set_probe_edges(probe, located, 4);
    *probed = set_probe_plane(probe, p, located, 4);
    if (n == 1)
        box_intersect(&boxes[0], &part);
    else
        boxes[0] = part;
    return 1;
}

/* ---- exact tests and shadow polygons ------------------------------------------------------------------------------ */

/* 1 when some corner of the caster rises above the receiver's plane. */
static int rises(const pair *p, const gnoi_poly *caster, int *cut_below, int *cut_above)
{
    int above = 0;
    double top = p->lamp_height * (1 - LIGHT_GAP);
    *cut_below = *cut_above = 0;
    for (uint32_t i = 0; i < caster->corner_count; i++) {
        double h = gnoi_form_at(&p->h, corner_position(p->scene, caster->corner + i));
        above |= h > p->tolerance;
        *cut_below |= h < -p->tolerance;
        *cut_above |= !p->lamp->directional && h > top;
    }
    return above;
}

/* 1 when the receiver lies on the caster's plane: the two are coplanar where it matters, though the small one's plane, drawn out
 * from corners that a file rounded, may leave the large one's far corners. */
static int carries(const pair *p, const gnoi_poly *caster)
{
    const gnoi_poly *poly = p->receiver->poly;
    for (uint32_t i = 0; i < poly->corner_count; i++)
        if (fabs(v3_dot(v3_from(caster->n), corner_position(p->scene, poly->corner + i)) + caster->d) > p->tolerance)
            return 0;
    return 1;
}

/* 1 when the plane through the light and an edge of triangle a, a on its positive side, has triangle b on its other side. */
static int parted_by_edge(const pair *p, const vec3 a[3], const vec3 b[3])
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

/* 1 when receiver and caster, both triangles, do not overlap as the light sees them (separating axes). */
static int separated(const pair *p, const gnoi_poly *caster)
{
    vec3 c[3];
    for (uint32_t i = 0; i < 3; i++)
        c[i] = corner_position(p->scene, caster->corner + i);
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
static void shadow_ring(const pair *p, uint32_t first, uint32_t count, int cut_below, int cut_above, ring_points *r)
{
    double top = p->lamp_height * (1 - LIGHT_GAP);
    int behind = 0;
    r->count = count;
    for (uint32_t i = 0; i < count; i++) {
        vec3 q = corner_position(p->scene, first + i);
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

/* Appends the edge between two picture points unless it is level, from its upper end: the same for both polygons at it. */
static void add_edge(gnoi_columns *columns, double ax, double ay, double bx, double by)
{
    gnoi_edge *e = &columns->edges[columns->edge_count];
    if (ay == by)
        return;
    if (ay > by) {
        double t = ax;
        ax = bx;
        bx = t;
        t = ay;
        ay = by;
        by = t;
    }
    e->x = ax;
    e->y = ay;
    e->y1 = by;
    e->slope = (bx - ax) / (by - ay);
    columns->edge_count++;
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
        add_edge(columns, a->x, a->y, b->x, b->y);
    }
    return 1;
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
static size_t region_points(const pair *p, const gnoi_view *view, point2 points[4])
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

typedef enum found { FOUND_NOTHING, FOUND_PART, FOUND_ALL, FOUND_NO_MEMORY } found;

/* Tests one candidate and appends its shadow polygon if it may darken the region. */
static found try_caster(const pair *p, const gnoi_view *view, uint32_t index, gnoi_columns *columns)
{
    const gnoi_prepared *prep = &p->scene->prepared;
    const gnoi_poly *caster = &prep->polys[index];
    const gnoi_receiver *region = p->receiver;
    int cut_below, cut_above;
    extent e = {HUGE_VAL, HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    size_t first_edge = columns->edge_count, room = 4 * (size_t)caster->corner_count + 16;
    ring_points r = {NULL, NULL, 0};
    gnoi_caster *c;
    if (!rises(p, caster, &cut_below, &cut_above) || (p->triangle && caster->corner_count == 3 && separated(p, caster)) || carries(p, caster))
        return FOUND_NOTHING;
    if (!gnoi_reserve(columns->context, (void **)&columns->points, &columns->point_capacity, 2 * room, sizeof *columns->points) ||
        !gnoi_reserve(columns->context, (void **)&columns->casters, &columns->caster_capacity, columns->caster_count + 1,
                      sizeof *columns->casters))
        return FOUND_NO_MEMORY;
    r.now = columns->points;
    r.next = columns->points + columns->point_capacity / 2;
    for (uint32_t k = 0; k < caster->ring_count; k++) {
        const uint32_t *corner = &prep->ring_corner[caster->ring + k];
        shadow_ring(p, corner[0], corner[1] - corner[0], cut_below, cut_above, &r);
        if (!add_ring_edges(&r, &e, columns))
            return FOUND_NO_MEMORY;
    }
    if (!(e.x1 > region->x0 && e.x0 < region->x1 && e.y1 > region->y0 && e.y0 < region->y1)) {
        columns->edge_count = first_edge;
        return FOUND_NOTHING;
    }
    if (caster->ring_count == 1) {
        point2 points[4];
        relation how = relate_shadow(r.now, r.count, points, region_points(p, view, points));
        if (how == ALL_OUTSIDE || (how == ALL_INSIDE && caster->opaque)) {
            columns->edge_count = first_edge;
            return how == ALL_OUTSIDE ? FOUND_NOTHING : FOUND_ALL;
        }
    }
    c = &columns->casters[columns->caster_count++];
    c->y0 = (float)e.y0 - 1e-2f - 1e-6f * fabsf((float)e.y0);
    c->y1 = (float)e.y1 + 1e-2f + 1e-6f * fabsf((float)e.y1);
    c->edge = (uint32_t)first_edge;
    c->edge_count = (uint32_t)(columns->edge_count - first_edge);
    c->material = caster->material;
    return FOUND_PART;
}

/* ---- spot cones --------------------------------------------------------------------------------------------------- */

static int in_cone(const gnoi_view *view, const gnoi_lamp *lamp, const gnoi_receiver *r, double x, double y)
{
    double z = gnoi_plane_at(&r->nearness, x, y);
    vec3 v;
    if (!view->orthographic && !(z > 0))
        return 0;
    v = v3_sub(gnoi_view_point(view, x, y, z), lamp->position);
    return v3_dot(v, lamp->axis) >= lamp->cos_half_angle * v3_length(v);
}

static int add_interval(gnoi_columns *columns, double x0, double x1, const double *transmission)
{
    gno_shadow_interval *s;
    if (columns->interval_count == columns->interval_capacity &&
        !gnoi_reserve(columns->context, (void **)&columns->intervals, &columns->interval_capacity, columns->interval_count + 1,
                      sizeof *columns->intervals))
        return 0;
    s = &columns->intervals[columns->interval_count++];
    s->x0 = x0;
    s->x1 = x1;
    for (int k = 0; k < 3; k++)
        s->transmission[k] = transmission ? transmission[k] : 0;
    return 1;
}

/* Roots in (xa,xb) of the quadratic through the cone's boundary: with V = (P - light) scaled to be linear in x,
 * (V.axis)^2 = cos^2 V.V. */
static int cone_roots(const gnoi_view *view, const gnoi_lamp *lamp, const gnoi_receiver *r, double y, double xa, double xb,
                      double roots[2])
{
    double za = gnoi_plane_at(&r->nearness, xa, y), zb = gnoi_plane_at(&r->nearness, xb, y), c2, a, b, c, disc, q, t[2];
    vec3 va, vb, dv;
    int n = 0;
    if (!view->orthographic && (!(za > 0) || !(zb > 0)))
        return 0;
    va = v3_sub(gnoi_view_point(view, xa, y, za), lamp->position);
    vb = v3_sub(gnoi_view_point(view, xb, y, zb), lamp->position);
    if (!view->orthographic) {
        va = v3_scale(va, za);
        vb = v3_scale(vb, zb);
    }
    dv = v3_sub(vb, va);
    c2 = lamp->cos_half_angle * lamp->cos_half_angle;
    a = v3_dot(dv, lamp->axis) * v3_dot(dv, lamp->axis) - c2 * v3_dot(dv, dv);
    b = v3_dot(va, lamp->axis) * v3_dot(dv, lamp->axis) - c2 * v3_dot(va, dv);
    c = v3_dot(va, lamp->axis) * v3_dot(va, lamp->axis) - c2 * v3_dot(va, va);
    disc = b * b - a * c;
    if (!(disc > 0))
        return 0;
    q = -(b + (b < 0 ? -sqrt(disc) : sqrt(disc)));
    t[0] = a != 0 ? q / a : -1;
    t[1] = q != 0 ? c / q : -1;
    if (t[0] > t[1]) {
        double swap = t[0];
        t[0] = t[1];
        t[1] = swap;
    }
    for (int i = 0; i < 2; i++)
        if (t[i] > 0 && t[i] < 1)
            roots[n++] = xa + t[i] * (xb - xa);
    return n;
}

static int add_cone_intervals(const gnoi_view *view, const gnoi_lamp *lamp, const gnoi_receiver *r, double y, double xa, double xb,
                              gnoi_columns *columns)
{
    double ends[4];
    int n = cone_roots(view, lamp, r, y, xa, xb, ends + 1);
    ends[0] = xa;
    ends[n + 1] = xb;
    for (int i = 0; i <= n; i++)
        if (!in_cone(view, lamp, r, 0.5 * (ends[i] + ends[i + 1]), y) && !add_interval(columns, ends[i], ends[i + 1], NULL))
            return 0;
    return 1;
}

/* ---- columns ------------------------------------------------------------------------------------------------------ */

static int seen_before(const gnoi_list *list, size_t i)
{
    for (size_t k = 0; k < i; k++)
        if (list->items[k] == list->items[i])
            return 1;
    return 0;
}

static int compare_numbers(const void *a, const void *b)
{
    uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

/* A receiver on several faces may be given a caster once for each. */
static void drop_repeats(gnoi_list *list)
{
    size_t n = 0;
    if (list->count > 16) {
        qsort(list->items, list->count, sizeof *list->items, compare_numbers);
        for (size_t i = 0; i < list->count; i++)
            if (i == 0 || list->items[i] != list->items[i - 1])
                list->items[n++] = list->items[i];
    } else {
        for (size_t i = 0; i < list->count; i++)
            if (!seen_before(list, i))
                list->items[n++] = list->items[i];
    }
    list->count = n;
}

struct gnoi_request {
    pair p;
    gnoi_column *column;
    gnoi_lbox box;
    gnoi_probe probe;
};

/* Pixel row of the receiver's region, for sorting casters; rows beyond it are its first and last. */
static int region_row(const gnoi_receiver *r, double y)
{
    double first = floor(r->y0);
    int last = (int)(floor(r->y1) - first);
    return y <= first ? 0 : y >= first + last ? last : (int)(y - first);
}

static void caster_rows(const gnoi_receiver *r, const gnoi_caster *c, int *first, int *last)
{
    *first = region_row(r, (double)c->y0);
    *last = region_row(r, (double)c->y1);
}

/* Lists a long column's casters by the rows that they may cross, so that a line looks at those of its row only. */
static int sort_into_rows(const gnoi_receiver *r, gnoi_columns *columns, gnoi_column *column)
{
    size_t rows = (size_t)region_row(r, r->y1) + 1, need = rows + 1;
    const gnoi_caster *casters = columns->casters + column->caster;
    uint32_t *start;
    int first, last;
    for (uint32_t i = 0; i < column->caster_count; i++) {
        caster_rows(r, &casters[i], &first, &last);
        need += (size_t)(last - first + 1);
    }
    if (!gnoi_reserve(columns->context, (void **)&columns->rows.items, &columns->rows.capacity, columns->rows.count + need,
                      sizeof *columns->rows.items))
        return 0;
    column->rows = (uint32_t)columns->rows.count;
    start = columns->rows.items + column->rows;
    for (size_t k = 0; k <= rows; k++)
        start[k] = 0;
    for (uint32_t i = 0; i < column->caster_count; i++) {
        caster_rows(r, &casters[i], &first, &last);
        for (int k = first; k <= last; k++)
            start[k]++;
    }
    for (size_t k = 1; k < rows; k++)
        start[k] += start[k - 1];
    start[rows] = start[rows - 1]; /* ends so far: filling from the back turns them into beginnings */
    for (uint32_t i = column->caster_count; i-- > 0;) {
        caster_rows(r, &casters[i], &first, &last);
        for (int k = first; k <= last; k++)
            start[rows + 1 + --start[k]] = column->caster + i;
    }
    columns->rows.count += need;
    return 1;
}

/* Tests all candidates in columns->found. */
static int settle(const pair *p, const gnoi_view *view, gnoi_columns *columns, gnoi_column *column)
{
    column->caster = (uint32_t)columns->caster_count;
    for (size_t i = 0; i < columns->found.count; i++) {
        uint32_t c = columns->found.items[i];
        found f = c == p->receiver->index ? FOUND_NOTHING : try_caster(p, view, c, columns);
        if (f == FOUND_NO_MEMORY)
            return 0;
        if (f == FOUND_ALL) {
            columns->full++;
            columns->ones++;
            columns->caster_count = column->caster;
            return 1;
        }
    }
    column->caster_count = (uint32_t)(columns->caster_count - column->caster);
    columns->ones += column->caster_count;
    column->state = column->caster_count || p->lamp->spot ? GNOI_COLUMN_SPLIT : GNOI_COLUMN_LIT;
    return column->caster_count < LONG_COLUMN || sort_into_rows(p->receiver, columns, column);
}

int gnoi_columns_finish(const gnoi_view *view, const gnoi_tree *tree, gnoi_columns *columns)
{
    if (columns->request_count == 0)
        return 1;
    if (!gnoi_tree_gather(columns->context, tree, &columns->request_box, &columns->front))
        return 0;
    for (size_t i = 0; i < columns->request_count; i++) {
        const struct gnoi_request *r = &columns->requests[i];
        columns->found.count = 0;
        if (!gnoi_tree_query(columns->context, tree, &columns->front, &r->box, &r->probe, &columns->found) ||
            !settle(&r->p, view, columns, r->column))
            return 0;
    }
    columns->request_count = 0;
    return 1;
}

static float box_side(const gnoi_lbox *b) { return max_f(b->u1 - b->u0, b->v1 - b->v0); }

static gnoi_lbox box_union(const gnoi_lbox *a, const gnoi_lbox *b)
{
    gnoi_lbox r;
    r.u0 = min_f(a->u0, b->u0);
    r.u1 = max_f(a->u1, b->u1);
    r.v0 = min_f(a->v0, b->v0);
    r.v1 = max_f(a->v1, b->v1);
    r.z0 = min_f(a->z0, b->z0);
    r.z1 = max_f(a->z1, b->z1);
    return r;
}

/* Lets a receiver wait with its neighbours, after sending off those that it is no neighbour of. */
static int wait_with_others(const pair *p, const gnoi_view *view, const gnoi_tree *tree, const gnoi_lbox *box, const gnoi_probe *probe,
                            gnoi_columns *columns, gnoi_column *column)
{
    struct gnoi_request *r;
    gnoi_lbox all = columns->request_count ? box_union(&columns->request_box, box) : *box;
    if (columns->request_count == REQUESTS || (columns->request_count && box_side(&all) > REQUEST_SPREAD * box_side(box))) {
        if (!gnoi_columns_finish(view, tree, columns))
            return 0;
        all = *box;
    }
    if (!gnoi_reserve(columns->context, (void **)&columns->requests, &columns->request_capacity, REQUESTS, sizeof *columns->requests))
        return 0;
    r = &columns->requests[columns->request_count++];
    r->p = *p;
    r->column = column;
    r->box = *box;
    r->probe = *probe;
    columns->request_box = all;
    return 1;
}

int gnoi_columns_ask(const gno_scene *scene, const gnoi_view *view, const gnoi_lamp *lamp, const gnoi_tree *tree,
                     const gnoi_receiver *receiver, gnoi_columns *columns, gnoi_column *column)
{
    pair p;
    gnoi_lbox boxes[6];
    gnoi_probe probe;
    int n, probed;
    columns->asked++;
    column->caster = 0;
    column->caster_count = 0;
    column->rows = GNOI_NONE;
    column->state = GNOI_COLUMN_DARK;
    if (!pair_make(&p, scene, view, lamp, receiver))
        return 1;
    n = region_boxes(&p, view, &tree->frame, boxes, &probe, &probed);
    if (n == 1 && probed)
        return wait_with_others(&p, view, tree, &boxes[0], &probe, columns, column);
    columns->found.count = 0;
    for (int i = 0; i < n; i++)
        if (!gnoi_tree_query(columns->context, tree, NULL, &boxes[i], NULL, &columns->found))
            return 0;
    if (n > 1)
        drop_repeats(&columns->found);
    return settle(&p, view, columns, column);
}

/* Where line y crosses the caster between xa and xb, in pairs (even-odd filling). */
static int caster_intervals(const gno_scene *scene, const gnoi_caster *c, double y, double xa, double xb, gnoi_columns *columns)
{
    const gnoi_edge *edges = columns->edges + c->edge;
    double *x = columns->crossings;
    const gno_material *m = &scene->materials[c->material];
    uint32_t n = 0;
    for (uint32_t i = 0; i < c->edge_count; i++) {
        if (y < edges[i].y || y >= edges[i].y1)
            continue;
        double v = gnoi_edge_at(&edges[i], y);
        uint32_t k = n++;
        for (; k > 0 && x[k - 1] > v; k--)
            x[k] = x[k - 1];
        x[k] = v;
    }
    for (uint32_t i = 0; i + 1 < n; i += 2)
        if (x[i] < x[i + 1] && x[i] < xb && x[i + 1] > xa && !add_interval(columns, x[i], x[i + 1], m->transmission))
            return 0;
    return 1;
}

int gnoi_column_intervals(const gno_scene *scene, const gnoi_view *view, const gnoi_lamp *lamp, const gnoi_receiver *receiver,
                          const gnoi_column *column, double y, double xa, double xb, gnoi_columns *columns)
{
    float fy = (float)y;
    uint32_t count = column->caster_count;
    const uint32_t *listed = NULL;
    if (column->rows != GNOI_NONE) {
        const uint32_t *start = columns->rows.items + column->rows;
        int row = region_row(receiver, y), rows = region_row(receiver, receiver->y1) + 1;
        listed = start + rows + 1 + start[row];
        count = start[row + 1] - start[row];
    }
    columns->interval_count = 0;
    for (uint32_t i = 0; i < count; i++) {
        const gnoi_caster *c = &columns->casters[listed ? listed[i] : column->caster + i];
        if (fy < c->y0 || fy > c->y1)
            continue;
        if (c->edge_count > columns->crossing_capacity &&
            !gnoi_reserve(columns->context, (void **)&columns->crossings, &columns->crossing_capacity, c->edge_count,
                          sizeof *columns->crossings))
            return 0;
        if (!caster_intervals(scene, c, y, xa, xb, columns))
            return 0;
    }
    return !lamp->spot || add_cone_intervals(view, lamp, receiver, y, xa, xb, columns);
}

void gnoi_columns_reset(gnoi_columns *columns)
{
    columns->rows.count = 0;
    columns->request_count = 0;
    columns->caster_count = 0;
    columns->edge_count = 0;
}

void gnoi_columns_free(gnoi_columns *columns)
{
    gnoi_free(columns->context, columns->casters, columns->caster_capacity, sizeof *columns->casters);
    gnoi_free(columns->context, columns->edges, columns->edge_capacity, sizeof *columns->edges);
    gnoi_free(columns->context, columns->found.items, columns->found.capacity, sizeof *columns->found.items);
    gnoi_free(columns->context, columns->requests, columns->request_capacity, sizeof *columns->requests);
    gnoi_free(columns->context, columns->front.nodes.items, columns->front.nodes.capacity, sizeof *columns->front.nodes.items);
    gnoi_free(columns->context, columns->rows.items, columns->rows.capacity, sizeof *columns->rows.items);
    gnoi_free(columns->context, columns->points, columns->point_capacity, sizeof *columns->points);
    gnoi_free(columns->context, columns->intervals, columns->interval_capacity, sizeof *columns->intervals);
    gnoi_free(columns->context, columns->crossings, columns->crossing_capacity, sizeof *columns->crossings);
}
