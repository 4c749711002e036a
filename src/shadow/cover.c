/* cover.c -- see cover.h. */
#include "shadow/cover.h"
#include "shadow/hidden.h"

#include <float.h>
#include <string.h>

/* The part of a caster within this share of the light's height from the light is cut away: it would throw its shadow
 * further than coordinates reach. */
#define LIGHT_GAP 1e-9

/* Casters are cut to the region grown by this share of its size on each side. */
#define MARGIN 0.5

/* Overlaps thinner than this share of the region's size are rounding. */
#define THIN 1e-13

/* Edges shorter than this share of the region's size, as cuts leave them, have no direction that parts anything. */
#define SHORT 1e-6

/* Corners of regions and shadows for which the tests of convex polygons are worth their time. */
#define FEW 16

/* A caster at the region's border may be ruled out in single precision only when it is farther off than this share of an edge. */
#define PROBE_SLACK 1e-5

int gnoi_cover_make(const gno_scene *scene, gnoi_cover *cover)
{
    memset(cover, 0, sizeof *cover);
    cover->context = cover->casters.context = cover->veils.context = cover->cone.context = scene->context;
    cover->marks = gnoi_calloc(scene->context, scene->prepared.poly_count, sizeof *cover->marks);
    cover->mark_count = scene->prepared.poly_count;
    cover->vertex_marks = gnoi_calloc(scene->context, scene->prepared.vertex_count, sizeof *cover->vertex_marks);
    cover->vertex_count = scene->prepared.vertex_count;
    return cover->marks && cover->vertex_marks;
}

static void list_free(gno_context *context, gnoi_list *list)
{
    gnoi_free(context, list->items, list->capacity, sizeof *list->items);
}

void gnoi_cover_free(gnoi_cover *cover)
{
    if (!cover->context)
        return;
    gnoi_shape_free(&cover->casters);
    gnoi_shape_free(&cover->veils);
    gnoi_shape_free(&cover->cone);
    list_free(cover->context, &cover->veil_index);
    list_free(cover->context, &cover->partners);
    list_free(cover->context, &cover->found);
    gnoi_free(cover->context, cover->convex, cover->convex_capacity, sizeof *cover->convex);
    gnoi_free(cover->context, cover->marks, cover->mark_count, sizeof *cover->marks);
    gnoi_free(cover->context, cover->vertex_marks, cover->vertex_count, sizeof *cover->vertex_marks);
    gnoi_free(cover->context, cover->points, cover->point_capacity, sizeof *cover->points);
}

static int list_add(gno_context *context, gnoi_list *list, uint32_t item)
{
    if (!gnoi_reserve(context, (void **)&list->items, &list->capacity, list->count + 1, sizeof *list->items))
        return 0;
    list->items[list->count++] = item;
    return 1;
}

/* ---- the receiver's outline --------------------------------------------------------------------------------------- */

/* Two halves of cover->points; a cut reads one and writes the other. */
typedef struct ring_points {
    gnoi_hpoint *now, *next;
    size_t count;
} ring_points;

/* A cut turns n points into at most 3n/2, so the most cuts that a ring meets, seven, into at most 17.1 n. */
static int ring_room(gnoi_cover *cover, size_t corners, ring_points *r)
{
    size_t room = 20 * corners + 64;
    if (!gnoi_reserve(cover->context, (void **)&cover->points, &cover->point_capacity, 2 * room, sizeof *cover->points))
        return 0;
    r->now = cover->points;
    r->next = cover->points + cover->point_capacity / 2;
    r->count = 0;
    return 1;
}

static void cut_ring(ring_points *r)
{
    gnoi_hpoint *other = r->next;
    r->count = gnoi_clip_ring(r->now, r->count, other);
    r->next = r->now;
    r->now = other;
}

/* Loads a ring's positions, with w as z. */
static void load_positions(const gno_scene *scene, uint32_t first, uint32_t end, ring_points *r)
{
    r->count = end - first;
    for (uint32_t i = first; i < end; i++) {
        vec3 p = gnoi_corner_at(scene, i);
        gnoi_hpoint *a = &r->now[i - first];
        a->x = p.x;
        a->y = p.y;
        a->w = p.z;
        a->side = 0;
    }
}

static vec3 position_of(const gnoi_hpoint *a) { return v3(a->x, a->y, a->w); }

/* Cuts positions to form >= 0; *cut tells whether anything went. */
static void cut_positions(const gnoi_form *form, ring_points *r, int *cut)
{
    int below = 0;
    for (size_t i = 0; i < r->count; i++) {
        r->now[i].side = gnoi_form_at(form, position_of(&r->now[i]));
        below |= r->now[i].side < 0;
    }
    if (below)
        cut_ring(r);
    *cut |= below;
}

static void cut_to_frame(const gnoi_view *view, ring_points *r, int *cut)
{
    gnoi_form f = view->depth;
    f.b -= view->near_depth;
    cut_positions(&f, r, cut);
    cut_positions(&view->x, r, cut);
    cut_positions(&view->y, r, cut);
    f.a = v3_sub(v3_scale(view->w.a, view->width), view->x.a);
    f.b = view->w.b * view->width - view->x.b;
    cut_positions(&f, r, cut);
    f.a = v3_sub(v3_scale(view->w.a, view->height), view->y.a);
    f.b = view->w.b * view->height - view->y.b;
    cut_positions(&f, r, cut);
}

static void project_ring(const gnoi_canvas *canvas, ring_points *r)
{
    for (size_t i = 0; i < r->count; i++)
        r->now[i] = gnoi_canvas_project(canvas, position_of(&r->now[i]));
}

/* Appends the ring, divided, without repeated points; rings of fewer than three are left out. */
static int add_ring(const ring_points *r, gnoi_shape *shape)
{
    double *to = gnoi_shape_ring(shape, r->count);
    size_t n = 0;
    if (!to)
        return 0;
    for (size_t i = 0; i < r->count; i++) {
        double x = r->now[i].x / r->now[i].w, y = r->now[i].y / r->now[i].w;
        if (n > 0 && to[2 * n - 2] == x && to[2 * n - 1] == y)
            continue;
        to[2 * n] = x;
        to[2 * n + 1] = y;
        n++;
    }
    while (n > 1 && to[0] == to[2 * n - 2] && to[1] == to[2 * n - 1])
        n--;
    return n < 3 || gnoi_shape_end_ring(shape, n);
}

int gnoi_canvas_outline(const gnoi_canvas *canvas, gnoi_cover *cover, gnoi_shape *outline, int *whole)
{
    const gno_scene *scene = canvas->centre->scene;
    const gnoi_prepared *prep = &scene->prepared;
    const gnoi_poly *poly = &prep->polys[canvas->index];
    size_t first_ring = outline->ring_count;
    int cut = 0;
    ring_points r;
    for (uint32_t k = 0; k < poly->ring_count; k++) {
        const uint32_t *corner = &prep->ring_corner[poly->ring + k];
        if (!ring_room(cover, corner[1] - corner[0], &r))
            return 0;
        load_positions(scene, corner[0], corner[1], &r);
        if (canvas->centre->view)
            cut_to_frame(canvas->centre->view, &r, &cut);
        project_ring(canvas, &r);
        if (!add_ring(&r, outline))
            return 0;
        if (k == 0 && outline->ring_count == first_ring)
            break;
    }
    *whole = !cut;
    return outline->ring_count == first_ring || gnoi_shape_end_polygon(outline, first_ring);
}

/* ---- the region asked about ------------------------------------------------------------------------------------------ */

typedef gnoi_point2 point2;

typedef struct region {
    double box[4];   /* of all its polygons */
    double reach[4]; /* to which casters are cut */
    double size, slack; /* overlaps thinner than slack are none */
    int count;       /* corners of a convex polygon that holds the region */
    point2 corner[FEW];
} region;

/* convex: the region is one convex ring. */
static void set_region(const gno_shape *shape, int convex, double slack, region *r)
{
    size_t corners = convex ? shape->ring_start[1] - shape->ring_start[0] : 0;
    double box[4];
    for (size_t p = 0; p < shape->polygon_count; p++) {
        gnoi_shape_box(shape, p, box);
        for (int k = 0; k < 2; k++) {
            r->box[k] = p == 0 || box[k] < r->box[k] ? box[k] : r->box[k];
            r->box[k + 2] = p == 0 || box[k + 2] > r->box[k + 2] ? box[k + 2] : r->box[k + 2];
        }
    }
    r->size = fmax(r->box[2] - r->box[0], r->box[3] - r->box[1]);
    r->slack = fmax(slack, THIN * r->size);
    for (int k = 0; k < 4; k++)
        r->reach[k] = r->box[k] + (k < 2 ? -MARGIN : MARGIN) * r->size;
    r->count = corners > 0 && corners <= FEW ? (int)corners : 4;
    for (int i = 0; i < r->count; i++) {
        if (corners > 0 && corners <= FEW) {
            const double *p = shape->points + 2 * (shape->ring_start[0] + (size_t)i);
            r->corner[i].x = p[0];
            r->corner[i].y = p[1];
        } else {
            r->corner[i].x = r->box[i == 1 || i == 2 ? 2 : 0];
            r->corner[i].y = r->box[i >= 2 ? 3 : 1];
        }
    }
}

/* How points lie to a convex ring: all inside or on it, all outside one of its edges or on it, or otherwise. */
typedef enum relation { ALL_INSIDE, ALL_OUTSIDE, MIXED } relation;

static relation relate(const point2 *ring, int count, const point2 *points, int point_count, double slack_length, double shortest)
{
    relation r = ALL_INSIDE;
    double turn = 0;
    for (int i = 1; i + 1 < count; i++)
        turn += (ring[i].x - ring[0].x) * (ring[i + 1].y - ring[0].y) - (ring[i].y - ring[0].y) * (ring[i + 1].x - ring[0].x);
    for (int i = 0; i < count; i++) {
        point2 a = ring[i], b = ring[i + 1 < count ? i + 1 : 0];
        double ex = turn < 0 ? a.x - b.x : b.x - a.x, ey = turn < 0 ? a.y - b.y : b.y - a.y;
        double slack = slack_length * (fabs(ex) + fabs(ey));
        int out = 0;
        for (int k = 0; k < point_count; k++) {
            double s = ex * (points[k].y - a.y) - ey * (points[k].x - a.x);
            out += s <= slack;
            if (s < -slack)
                r = MIXED;
        }
        if (out == point_count && fabs(ex) + fabs(ey) > shortest)
            return ALL_OUTSIDE;
    }
    return r;
}

/* ---- one caster -------------------------------------------------------------------------------------------------------- */

/* Both relations of a region and the shadow's convex ring. */
static relation relate_ring(const ring_points *r, const region *to)
{
    point2 ring[FEW];
    if (r->count < 3 || r->count > FEW)
        return MIXED;
    for (size_t i = 0; i < r->count; i++) {
        ring[i].x = r->now[i].x / r->now[i].w;
        ring[i].y = r->now[i].y / r->now[i].w;
    }
    if (relate(to->corner, to->count, ring, (int)r->count, to->slack, SHORT * to->size) == ALL_OUTSIDE)
        return ALL_OUTSIDE;
    return relate(ring, (int)r->count, to->corner, to->count, to->slack, SHORT * to->size);
}

/* The values by which a ring is cut: the region's reach on four sides, and away from the centre's own height. */
enum { SIDE_GAP = 4 };

static double reach_side(const gnoi_hpoint *a, const region *to, int side)
{
    switch (side) {
    case 0: return a->x - to->reach[0] * a->w;
    case 1: return a->y - to->reach[1] * a->w;
    case 2: return to->reach[2] * a->w - a->x;
    case 3: return to->reach[3] * a->w - a->y;
    default: return a->w - LIGHT_GAP;
    }
}

static void cut_side(ring_points *r, const region *to, int side)
{
    int below = 0;
    for (size_t i = 0; i < r->count; i++) {
        r->now[i].side = reach_side(&r->now[i], to, side);
        below |= r->now[i].side < 0;
    }
    if (below)
        cut_ring(r);
}

static void cut_to_reach(ring_points *r, const region *to)
{
    for (int side = 0; side < SIDE_GAP; side++)
        cut_side(r, to, side);
}

/* 1 when the divided ring lies outside the region's box. */
static int beside(const ring_points *r, const region *to)
{
    double x0 = HUGE_VAL, y0 = HUGE_VAL, x1 = -HUGE_VAL, y1 = -HUGE_VAL;
    for (size_t i = 0; i < r->count; i++) {
        double x = r->now[i].x / r->now[i].w, y = r->now[i].y / r->now[i].w;
        x0 = x < x0 ? x : x0;
        x1 = x > x1 ? x : x1;
        y0 = y < y0 ? y : y0;
        y1 = y > y1 ? y : y1;
    }
    return !(x1 > to->box[0] && x0 < to->box[2] && y1 > to->box[1] && y0 < to->box[3]);
}

/* Projects positions and sets S as side; *above, *below: some corner is. over: the caster lies on the receiver, before it. `vertex`:
 * the corners' vertices, NULL where the ring was cut before. */
static void project_caster(const gnoi_canvas *canvas, const gnoi_cover *cover, uint32_t index, int over, const uint32_t *vertex, ring_points *r,
                           int *above, int *below)
{
    const gnoi_centre *centre = canvas->centre;
    double height = centre->stands[index].height, slack = centre->noise * (1 / canvas->height + 1 / height);
    int up = 0, down = 0; /* of the corners that the receiver does not have */
    for (size_t i = 0; i < r->count; i++) {
        vec3 p = position_of(&r->now[i]);
        gnoi_hpoint a = gnoi_canvas_project(canvas, p);
        a.side = over ? 1 : a.side - gnoi_height_over(centre, index, p) / height;
        if (fabs(a.side) <= slack)
            a.side = 0;
        if (!vertex || cover->vertex_marks[vertex[i]] != cover->mark) {
            up |= a.side > 0;
            down |= a.side < 0;
        }
        r->now[i] = a;
    }
    for (size_t i = 0; i < r->count; i++) {
        if (!over && vertex && !(up && down) && cover->vertex_marks[vertex[i]] == cover->mark)
            r->now[i].side = 0;
        *above |= r->now[i].side > 0;
        *below |= r->now[i].side < 0;
    }
}

typedef enum cast { CAST_NOTHING, CAST_PART, CAST_ALL, CAST_NO_MEMORY } cast;

/* Adds the shadow of one ring of a caster; CAST_ALL: it covers the region (known of rings of convex polygons only). */
static cast cast_ring(const gnoi_canvas *canvas, gnoi_cover *cover, const region *to, uint32_t index, int over, const uint32_t *corner,
                      gnoi_shape *shape)
{
    const gnoi_centre *centre = canvas->centre;
    int above = 0, below = 0, cut = 0;
    relation how;
    ring_points r;
    if (!ring_room(cover, corner[1] - corner[0], &r))
        return CAST_NO_MEMORY;
    load_positions(centre->scene, corner[0], corner[1], &r);
    if (centre->has_start)
        cut_positions(&centre->start, &r, &cut);
    project_caster(canvas, cover, index, over, cut ? NULL : centre->scene->prepared.corner_vertex + corner[0], &r, &above, &below);
    if (!above)
        return CAST_NOTHING;
    if (below)
        cut_ring(&r);
    if (!centre->lamp.directional)
        cut_side(&r, to, SIDE_GAP);
    if (r.count < 3 || beside(&r, to))
        return CAST_NOTHING;
    cut_to_reach(&r, to);
    how = centre->stands[index].convex ? relate_ring(&r, to) : MIXED;
    if (how == ALL_OUTSIDE)
        return CAST_NOTHING;
    if (how == ALL_INSIDE)
        return CAST_ALL;
    return add_ring(&r, shape) ? CAST_PART : CAST_NO_MEMORY;
}

/* Adds the shadow of a whole caster. */
static cast cast_polygon(const gnoi_canvas *canvas, gnoi_cover *cover, const region *to, uint32_t index, int over, gnoi_shape *shape)
{
    const gnoi_prepared *prep = &canvas->centre->scene->prepared;
    const gnoi_poly *poly = &prep->polys[index];
    size_t ring = shape->ring_count;
    for (uint32_t k = 0; k < poly->ring_count; k++) {
        cast c = cast_ring(canvas, cover, to, index, over, &prep->ring_corner[poly->ring + k], shape);
        if (c == CAST_NO_MEMORY || (c == CAST_ALL && canvas->centre->stands[index].hides == 1))
            return c;
        if (c == CAST_ALL) {
            /* A veil over the whole region, as a box around it. */
            double *p = gnoi_shape_ring(shape, 4);
            if (!p)
                return CAST_NO_MEMORY;
            for (int i = 0; i < 4; i++) {
                p[2 * i] = to->reach[i == 1 || i == 2 ? 2 : 0];
                p[2 * i + 1] = to->reach[i >= 2 ? 3 : 1];
            }
            if (!gnoi_shape_end_ring(shape, 4))
                return CAST_NO_MEMORY;
        }
        if (k == 0 && shape->ring_count == ring)
            return CAST_NOTHING;
    }
    return gnoi_shape_end_polygon(shape, ring) ? CAST_PART : CAST_NO_MEMORY;
}

/* Every corner at or below the receiver's plane: most candidates of a large receiver's neighbours end here. */
static int below_plane(const gnoi_canvas *canvas, const gnoi_poly *poly)
{
    for (uint32_t i = 0; i < poly->corner_count; i++)
        if (v3_dot(canvas->n, v3_sub(gnoi_corner_at(canvas->centre->scene, poly->corner + i), canvas->origin)) > 0)
            return 0;
    return 1;
}

static cast try_candidate(const gnoi_canvas *canvas, gnoi_cover *cover, const region *to, uint32_t index)
{
    const gnoi_centre *centre = canvas->centre;
    const gno_scene *scene = centre->scene;
    const gnoi_poly *poly = &scene->prepared.polys[index];
    int hides = centre->stands[index].hides, over = 0;
    cast c;
    if (index == canvas->index || !hides)
        return CAST_NOTHING;
    if (gnoi_coplanar(centre, index, canvas->index)) {
        if (!gnoi_in_front(scene, index, canvas->index))
            return CAST_NOTHING;
        if (!centre->view)
            return list_add(cover->context, &cover->partners, index) ? CAST_NOTHING : CAST_NO_MEMORY;
        over = 1;
    } else if (poly->corner_count == 3 && below_plane(canvas, poly))
        return CAST_NOTHING;
    c = cast_polygon(canvas, cover, to, index, over, hides == 1 ? &cover->casters : &cover->veils);
    if (c == CAST_PART && hides == 1) {
        size_t n = cover->casters.polygon_count;
        if (!gnoi_reserve(cover->context, (void **)&cover->convex, &cover->convex_capacity, n, sizeof *cover->convex))
            return CAST_NO_MEMORY;
        cover->convex[n - 1] = centre->stands[index].convex;
    }
    if (c == CAST_PART && hides == 2 && !list_add(cover->context, &cover->veil_index, index))
        return CAST_NO_MEMORY;
    return c;
}

/* ---- candidates ---------------------------------------------------------------------------------------------------- */

/* The region on the light's plane: its edges, and its plane as nearness over (u,v), from three points that span it. */
static int set_probe(const gnoi_lpoint *p, int count, gnoi_probe *probe)
{
    double area = 0, best = 0, reach = 0;
    int k = 1;
    for (int i = 1; i + 1 < count; i++) {
        double part = (p[i].u - p[0].u) * (p[i + 1].v - p[0].v) - (p[i].v - p[0].v) * (p[i + 1].u - p[0].u);
        area += part;
        if (fabs(part) > best) {
            best = fabs(part);
            k = i;
        }
    }
    if (!(best > 0) || count > GNOI_PROBE_EDGES)
        return 0;
    for (int i = 0; i < count; i++) {
        const gnoi_lpoint *a = &p[i], *b = &p[i + 1 < count ? i + 1 : 0];
        double s = area < 0 ? -1 : 1, du = (b->u - a->u) * s, dv = (b->v - a->v) * s;
        probe->a[i] = -dv;
        probe->b[i] = du;
        probe->c[i] = dv * a->u - du * a->v;
        probe->slack[i] = -PROBE_SLACK * (du * du + dv * dv);
        reach = fmax(reach, fabs(a->q - p[0].q));
    }
    probe->edge_count = count;
    const gnoi_lpoint *a = &p[0], *b = &p[k], *c = &p[k + 1];
    best = (b->u - a->u) * (c->v - a->v) - (b->v - a->v) * (c->u - a->u);
    probe->qa = ((b->q - a->q) * (c->v - a->v) - (b->v - a->v) * (c->q - a->q)) / best;
    probe->qb = ((b->u - a->u) * (c->q - a->q) - (b->q - a->q) * (c->u - a->u)) / best;
    probe->qc = a->q - probe->qa * a->u - probe->qb * a->v - PROBE_SLACK * (reach + fabs(a->q));
    return 1;
}

static int find_candidates(const gnoi_canvas *canvas, gnoi_cover *cover, const region *to)
{
    const gnoi_tree *tree = &canvas->centre->tree;
    vec3 hull[FEW];
    gnoi_lpoint located[GNOI_FRAME_POINTS];
    gnoi_lbox boxes[6];
    gnoi_probe probe;
    int count = to->count <= GNOI_FRAME_POINTS ? to->count : 4, n, probed = 0;
    cover->found.count = 0;
    for (int i = 0; i < count; i++)
        hull[i] = to->count <= GNOI_FRAME_POINTS
                      ? gnoi_canvas_point(canvas, to->corner[i].x, to->corner[i].y)
                      : gnoi_canvas_point(canvas, to->box[i == 1 || i == 2 ? 2 : 0], to->box[i >= 2 ? 3 : 1]);
    if (gnoi_frame_locate(&tree->frame, hull, count, located)) {
        n = 1;
        gnoi_frame_box(&tree->frame, located, count, &boxes[0]);
        probed = set_probe(located, count, &probe);
    } else
        n = gnoi_frame_boxes(&tree->frame, hull, count, boxes);
    if (n == 0) {
        gnoi_lbox all = {-FLT_MAX, FLT_MAX, -FLT_MAX, FLT_MAX, -FLT_MAX, FLT_MAX};
        boxes[n++] = all;
    }
    for (int i = 0; i < n; i++)
        if (!gnoi_tree_query(cover->context, tree, &boxes[i], probed ? &probe : NULL, &cover->found))
            return 0;
    return 1;
}

/* ---- a spot's cone ----------------------------------------------------------------------------------------------- */

#define PI 3.14159265358979323846

/* The pyramid has the cone's own cross-section area. */
vec3 gnoi_cone_edge(const gnoi_lamp *lamp, int i)
{
    vec3 u, v;
    double turn = 2 * PI / GNOI_CONE_SIDES, c = lamp->cos_half_angle;
    double radius = sqrt(1 - c * c) / c * sqrt(turn / sin(turn));
    gnoi_plane_axes(lamp->axis, &u, &v);
    return v3_add(lamp->axis, v3_scale(v3_add(v3_scale(u, cos(turn * i)), v3_scale(v, sin(turn * i))), radius));
}

static gnoi_cover_state cover_cone(const gnoi_canvas *canvas, gnoi_cover *cover, const region *to)
{
    const gnoi_lamp *lamp = &canvas->centre->lamp;
    ring_points r;
    point2 cone[GNOI_CONE_SIDES + 8];
    relation how = MIXED;
    if (!ring_room(cover, GNOI_CONE_SIDES, &r))
        return GNOI_COVER_NO_MEMORY;
    r.count = GNOI_CONE_SIDES;
    for (int i = 0; i < GNOI_CONE_SIDES; i++)
        r.now[i] = gnoi_canvas_project(canvas, v3_mad(lamp->position, gnoi_cone_edge(lamp, i), canvas->height));
    cut_side(&r, to, SIDE_GAP);
    cut_to_reach(&r, to);
    if (r.count < 3 || beside(&r, to))
        return GNOI_COVER_ALL;
    if (r.count <= GNOI_CONE_SIDES + 8) {
        for (size_t i = 0; i < r.count; i++) {
            cone[i].x = r.now[i].x / r.now[i].w;
            cone[i].y = r.now[i].y / r.now[i].w;
        }
        how = relate(cone, (int)r.count, to->corner, to->count, to->slack, SHORT * to->size);
    }
    if (how != MIXED)
        return how == ALL_INSIDE ? GNOI_COVER_NONE : GNOI_COVER_ALL;
    return add_ring(&r, &cover->cone) && gnoi_shape_end_polygon(&cover->cone, 0) ? GNOI_COVER_PART : GNOI_COVER_NO_MEMORY;
}

/* ---- all casters --------------------------------------------------------------------------------------------------- */

static void mark_receiver(gnoi_cover *cover, const gnoi_canvas *canvas)
{
    const gnoi_prepared *prep = &canvas->centre->scene->prepared;
    const gnoi_poly *poly = &prep->polys[canvas->index];
    cover->mark++;
    for (uint32_t i = 0; i < poly->corner_count; i++)
        cover->vertex_marks[prep->corner_vertex[poly->corner + i]] = cover->mark;
}

gnoi_cover_state gnoi_cover_ask(gnoi_cover *cover, const gnoi_canvas *canvas, const gno_shape *shape, int convex)
{
    region to = {{0, 0, 0, 0}, {0, 0, 0, 0}, 0, 0, 0, {{0, 0}}};
    gnoi_cover_state state;
    gnoi_shape_clear(&cover->casters);
    gnoi_shape_clear(&cover->veils);
    gnoi_shape_clear(&cover->cone);
    cover->veil_index.count = cover->partners.count = 0;
    set_region(shape, convex, cover->slack, &to);
    state = canvas->centre->lamp.spot ? cover_cone(canvas, cover, &to) : GNOI_COVER_NONE;
    if (state == GNOI_COVER_ALL || state == GNOI_COVER_NO_MEMORY)
        return state;
    if (!find_candidates(canvas, cover, &to))
        return GNOI_COVER_NO_MEMORY;
    mark_receiver(cover, canvas);
    for (size_t i = 0; i < cover->found.count; i++) {
        uint32_t index = cover->found.items[i];
        cast c;
        if (cover->marks[index] == cover->mark)
            continue;
        cover->marks[index] = cover->mark;
        c = try_candidate(canvas, cover, &to, index);
        if (c == CAST_ALL)
            return GNOI_COVER_ALL;
        if (c == CAST_NO_MEMORY || gnoi_stopped_at(cover->context, i))
            return GNOI_COVER_NO_MEMORY;
    }
    if (convex && cover->casters.polygon_count > 1 && gnoi_wholly_hidden(to.corner, to.count, &cover->casters, cover->convex))
        return GNOI_COVER_ALL;
    return cover->casters.polygon_count + cover->veils.polygon_count > 0 ? GNOI_COVER_PART : state;
}
