/* sheet.c -- how the far sides of halved solids lie over a receiver's region: see contour.h and pair.h.
 *
 * The far sides above a receiver's plane are a sheet whose only boundary over the region are contour edges, unless one of them
 * passes through the plane there (then they are taken one by one). So where no contour edge crosses the region one point tells
 * for all of it, and on a line the number of far sides overhead changes by one at each contour edge.
 * Which far sides count is said by their corners' heights over the receiver's plane, in one way for all that ask: above it when
 * no corner is below by more than the tolerance, behind it when none is above.
 */
#include "shadow/region.h"

#include <limits.h>

typedef enum place { ABOVE, BEHIND, THROUGH } place;

static place place_of(const gnoi_pair *p, const gnoi_poly *poly, int *touching)
{
    double low = HUGE_VAL, high = -HUGE_VAL;
    *touching = 0;
    for (uint32_t i = 0; i < poly->corner_count; i++) {
        double h = gnoi_form_at(&p->h, gnoi_corner_position(p->scene, poly->corner + i));
        low = h < low ? h : low;
        high = h > high ? h : high;
        *touching += fabs(h) <= p->tolerance;
    }
    return low >= -p->tolerance ? ABOVE : high <= p->tolerance ? BEHIND : THROUGH;
}

/* ---- one point ---------------------------------------------------------------------------------------------------- */

/* The plane across the ray from the lamp to a point, on which the ray is the origin. */
typedef struct across {
    vec3 point, e1, e2;
} across;

static across across_ray(const gnoi_lamp *lamp, vec3 point)
{
    across a;
    vec3 d = lamp->directional ? lamp->to_light : v3_unit(v3_sub(lamp->position, point));
    a.point = point;
    a.e1 = v3_unit(v3_cross(d, fabs(d.x) < 0.6 ? v3(1, 0, 0) : v3(0, 1, 0)));
    a.e2 = v3_cross(d, a.e1);
    return a;
}

/* Whether the ray's line meets the polygon, by crossings of the edges to its right. An edge is judged from its lower end, so that
 * neighbours agree about the one they share. */
static int meets(const gno_scene *scene, const across *a, const gnoi_poly *poly)
{
    vec3 q = v3_sub(gnoi_corner_position(scene, poly->corner + poly->corner_count - 1), a->point);
    double x0 = v3_dot(q, a->e1), y0 = v3_dot(q, a->e2);
    int inside = 0;
    for (uint32_t i = 0; i < poly->corner_count; i++) {
        double x1, y1;
        q = v3_sub(gnoi_corner_position(scene, poly->corner + i), a->point);
        x1 = v3_dot(q, a->e1);
        y1 = v3_dot(q, a->e2);
        if ((y0 > 0) != (y1 > 0))
            inside ^= y0 < y1 ? x0 * y1 - x1 * y0 > 0 : x1 * y0 - x0 * y1 > 0;
        x0 = x1;
        y0 = y1;
    }
    return inside;
}

/* Of a polygon that the ray's line meets: whether it does so between the lamp and the receiver. */
static int is_above(const gnoi_pair *p, const gnoi_poly *poly, vec3 point)
{
    int touching;
    double at_lamp = gnoi_lamp_side(p->lamp, poly->n, poly->d), at_point = v3_dot(v3_from(poly->n), point) + poly->d;
    place at = place_of(p, poly, &touching);
    if (at == THROUGH)
        at = at_lamp * at_point < 0 ? ABOVE : BEHIND;
    return at == ABOVE && (p->lamp->directional || at_lamp * (at_lamp - at_point) > 0);
}

/* The far sides between the lamp and a point, one by one. */
typedef struct counting {
    const gnoi_pair *pair;
    const gnoi_tree *far;
    across line;
    vec3 point;
    int count, enough;
} counting;

static int count_node(void *user, uint32_t node, unsigned mask)
{
    counting *c = user;
    const gno_scene *scene = c->pair->scene;
    for (; mask && c->count < c->enough; mask &= mask - 1) {
        const gnoi_poly *poly = &scene->prepared.polys[c->far->caster[node * GNOI_TREE_FAN + gnoi_lowest_bit(mask)]];
        c->count += meets(scene, &c->line, poly) && is_above(c->pair, poly, c->point);
    }
    return c->count < c->enough;
}

/* Number of far sides between the lamp and a point of the receiver, counting no further than `enough`. */
static int count_above(const gnoi_pair *p, const gnoi_casters *casters, vec3 point, int enough)
{
    counting c = {p, &casters->far, across_ray(p->lamp, point), point, 0, enough};
    gnoi_lpoint l;
    gnoi_lbox box;
    if (!gnoi_frame_locate(&casters->far.frame, &point, 1, &l))
        return 0;
    gnoi_frame_box(&casters->far.frame, &l, 1, &box);
    gnoi_tree_walk(&casters->far, &box, count_node, &c);
    return c.count;
}

gnoi_sheet_state gnoi_sheet_at(const gnoi_pair *p, const gnoi_casters *casters, vec3 point)
{
    return count_above(p, casters, point, 1) ? GNOI_SHEET_ALL : GNOI_SHEET_NOWHERE;
}

int gnoi_sheet_count(const gnoi_pair *p, const gnoi_casters *casters, vec3 point) { return count_above(p, casters, point, INT_MAX); }

/* ---- contour edges over the region ---------------------------------------------------------------------------------- */

static double depth_of(const gnoi_frame *frame, const gnoi_lpoint *l) { return frame->parallel ? -l->q : 1 / l->q; }

static int outside_region(const gnoi_probe *probe, const gnoi_lpoint l[2])
{
    for (int e = 0; e < probe->edge_count; e++)
        if (probe->a[e] * l[0].u + probe->b[e] * l[0].v + probe->c[e] <= probe->slack[e] &&
            probe->a[e] * l[1].u + probe->b[e] * l[1].v + probe->c[e] <= probe->slack[e])
            return 1;
    return 0;
}

/* Whether a triangle lies outside of one of the region's edges. */
static int beside_region(const gnoi_frame *frame, const gnoi_probe *probe, const gno_scene *scene, const gnoi_poly *poly)
{
    vec3 q[3];
    gnoi_lpoint l[3];
    if (poly->corner_count != 3)
        return 0;
    for (uint32_t i = 0; i < 3; i++)
        q[i] = gnoi_corner_position(scene, poly->corner + i);
    if (!gnoi_frame_locate(frame, q, 3, l))
        return 0;
    for (int e = 0; e < probe->edge_count; e++) {
        int out = 1;
        for (int i = 0; i < 3; i++)
            out &= probe->a[e] * l[i].u + probe->b[e] * l[i].v + probe->c[e] <= probe->slack[e];
        if (out)
            return 1;
    }
    return 0;
}

/* Whether the far side that the edge bounds is above the receiver's plane at the edge. */
static place edge_place(const gnoi_pair *p, const gnoi_boundary_edge *e, const vec3 ends[2])
{
    int touching;
    place at = place_of(p, &p->scene->prepared.polys[e->poly], &touching);
    double h0, h1;
    if (at != THROUGH)
        return at;
    h0 = gnoi_form_at(&p->h, ends[0]);
    h1 = gnoi_form_at(&p->h, ends[1]);
    return h0 >= -p->tolerance && h1 >= -p->tolerance ? ABOVE : h0 <= p->tolerance && h1 <= p->tolerance ? BEHIND : THROUGH;
}

/* The edge's shadow on the receiver, in the picture: 1 appended, 0 not over the region, -1 when it is not to be had. */
static int add_rim(const gnoi_pair *p, const vec3 ends[2], gnoi_columns *columns)
{
    const gnoi_receiver *r = p->receiver;
    gnoi_rim *rim = &columns->rims[columns->rim_count];
    double x[2], y[2];
    for (int i = 0; i < 2; i++) {
        double w = gnoi_form_at(&p->w, ends[i]);
        if (!(w > p->w_min) || (!p->lamp->directional && gnoi_form_at(&p->h, ends[i]) > 0.999 * p->lamp_height))
            return -1;
        x[i] = gnoi_form_at(&p->x, ends[i]) / w;
        y[i] = gnoi_form_at(&p->y, ends[i]) / w;
    }
    if ((x[0] < r->x0 && x[1] < r->x0) || (x[0] > r->x1 && x[1] > r->x1) || (y[0] < r->y0 && y[1] < r->y0) ||
        (y[0] > r->y1 && y[1] > r->y1))
        return 0;
    if (!gnoi_edge_set(&rim->edge, x[0], y[0], x[1], y[1])) {
        rim->edge.x = x[0];
        rim->edge.y = rim->edge.y1 = y[0];
        rim->edge.slope = 0;
    }
    rim->x0 = (float)(x[0] < x[1] ? x[0] : x[1]);
    rim->x1 = (float)(x[0] < x[1] ? x[1] : x[0]);
    rim->step = y[1] > y[0] ? -1 : 1;
    columns->rim_count++;
    return 1;
}

int gnoi_sheet_gather_rims(const gnoi_casters *casters, gnoi_columns *columns)
{
    gnoi_near *near = columns->near;
    const gnoi_near *whole = near->whole;
    gnoi_grain grain = {near->fine ? -1 : gnoi_box_side(&near->box), 0};
    if (near->rims)
        return 1;
    while (whole && !whole->rims)
        whole = whole->whole;
    near->rims = 1;
    return gnoi_gather(columns->context, &casters->rim, whole ? &whole->rim : NULL, &near->box, grain, &near->rim);
}

static gnoi_sheet_state add_rims(const gnoi_pair *p, const gnoi_casters *casters, const gnoi_lbox *box, const gnoi_probe *probe,
                                 gnoi_columns *columns, gnoi_column *column)
{
    const gnoi_prepared *prep = &p->scene->prepared;
    const gnoi_frame *frame = &casters->rim.frame;
    int face = gnoi_frame_face(frame, 0.5 * (double)(box->u0 + box->u1)), near_edges = 0;
    columns->found.count = 0;
    if (!gnoi_sheet_gather_rims(casters, columns) ||
        !gnoi_gathered_query(columns->context, &columns->near->rim, box, NULL, &columns->found, NULL) ||
        !gnoi_reserve(columns->context, (void **)&columns->rims, &columns->rim_capacity, columns->rim_count + columns->found.count,
                      sizeof *columns->rims))
        return GNOI_SHEET_NO_MEMORY;
    for (size_t i = 0; i < columns->found.count; i++) {
        const gnoi_boundary_edge *e = &casters->contour.edges[columns->found.items[i]];
        vec3 ends[2] = {v3_from(prep->positions[e->from]), v3_from(prep->positions[e->to])};
        gnoi_lpoint l[2];
        int located = gnoi_frame_locate_on(frame, face, ends, 2, l);
        place at = ABOVE;
        if (located && outside_region(probe, l)) {
            near_edges = 1;
            continue;
        }
        if (!located || !(depth_of(frame, &l[0]) < (double)box->z0) || !(depth_of(frame, &l[1]) < (double)box->z0))
            at = edge_place(p, e, ends);
        near_edges |= at != BEHIND;
        if (at == THROUGH || (at == ABOVE && add_rim(p, ends, columns) < 0))
            return GNOI_SHEET_PIERCED;
    }
    column->rim_count = (uint32_t)(columns->rim_count - column->rim);
    /* Of a receiver in parts the middle of the box may lie outside of the region, and edges between the two. */
    column->sheet = column->rim_count || (near_edges && !p->receiver->whole);
    return column->sheet ? GNOI_SHEET_PART : GNOI_SHEET_NOWHERE;
}

/* What the far sides over a region are like. */
typedef struct outlook {
    int overhead, standing, hanging;
} outlook;

/* Looks at the far sides about as deep as the receiver in one box of the region. A far side of another solid that lies on the receiver
 * counts as above: it stands on it, and hides it. PIERCED when one passes through the receiver, or when one of its own solid lies on
 * it, as the receiver itself where the solid is inside out. */
static gnoi_sheet_state look_up(const gnoi_pair *p, const gnoi_frame *frame, const gnoi_lbox *box, const gnoi_probe *probe,
                                gnoi_columns *columns, outlook *look)
{
    const gnoi_prepared *prep = &p->scene->prepared;
    const uint32_t solid = gnoi_solid_of(prep, p->receiver->poly);
    columns->found.count = 0;
    if (!gnoi_gathered_query(columns->context, &columns->near->far, box, NULL, &columns->found, &look->overhead))
        return GNOI_SHEET_NO_MEMORY;
    for (size_t i = 0; i < columns->found.count; i++) {
        const gnoi_poly *poly = &prep->polys[columns->found.items[i]];
        int touching;
        place at = place_of(p, poly, &touching);
        if ((at == BEHIND && !touching) || gnoi_pair_separated(p, poly) || beside_region(frame, probe, p->scene, poly))
            continue;
        if (at == THROUGH || (touching == (int)poly->corner_count && gnoi_solid_of(prep, poly) == solid))
            return GNOI_SHEET_PIERCED;
        look->overhead |= at == ABOVE;
        look->standing |= at == ABOVE && touching > 1;
        look->hanging |= at == BEHIND && touching > 1;
    }
    return GNOI_SHEET_PART;
}

/* PIERCED when what stands on the receiver may go on below; PART when any is overhead. */
static gnoi_sheet_state judge(const outlook *look)
{
    if (look->standing && look->hanging)
        return GNOI_SHEET_PIERCED;
    return look->overhead ? GNOI_SHEET_PART : GNOI_SHEET_NOWHERE;
}

static void forget_rims(gnoi_columns *columns, gnoi_column *column)
{
    columns->rim_count = column->rim;
    column->rim_count = 0;
    column->sheet = 0;
}

gnoi_sheet_state gnoi_sheet_try(const gnoi_pair *p, const gnoi_casters *casters, const gnoi_region *region, const gnoi_probe *probe,
                                gnoi_columns *columns, gnoi_column *column)
{
    outlook look = {0, 0, 0};
    gnoi_sheet_state state = look_up(p, &casters->far.frame, &region->box, probe, columns, &look);
    if (state == GNOI_SHEET_PART)
        state = judge(&look);
    if (state != GNOI_SHEET_PART)
        return state;
    state = add_rims(p, casters, &region->box, probe, columns, column);
    if (state == GNOI_SHEET_PIERCED)
        forget_rims(columns, column);
    return state == GNOI_SHEET_NOWHERE ? gnoi_sheet_at(p, casters, gnoi_region_centre(p, &casters->far.frame, region)) : state;
}

/* All contour edges in the boxes of a region in parts. */
static gnoi_sheet_state add_rims_apart(const gnoi_pair *p, const gnoi_casters *casters, const gnoi_lbox *boxes, int count,
                                       gnoi_columns *columns, gnoi_column *column)
{
    const gnoi_prepared *prep = &p->scene->prepared;
    columns->found.count = 0;
    for (int i = 0; i < count; i++)
        if (!gnoi_tree_query(columns->context, &casters->rim, &boxes[i], NULL, &columns->found))
            return GNOI_SHEET_NO_MEMORY;
    gnoi_list_drop_repeats(&columns->found);
    if (!gnoi_reserve(columns->context, (void **)&columns->rims, &columns->rim_capacity, columns->rim_count + columns->found.count,
                      sizeof *columns->rims))
        return GNOI_SHEET_NO_MEMORY;
    for (size_t i = 0; i < columns->found.count; i++) {
        const gnoi_boundary_edge *e = &casters->contour.edges[columns->found.items[i]];
        vec3 ends[2] = {v3_from(prep->positions[e->from]), v3_from(prep->positions[e->to])};
        place at = edge_place(p, e, ends);
        if (at == THROUGH || (at == ABOVE && add_rim(p, ends, columns) < 0))
            return GNOI_SHEET_PIERCED;
    }
    column->rim_count = (uint32_t)(columns->rim_count - column->rim);
    column->sheet = 1;
    return GNOI_SHEET_PART;
}

gnoi_sheet_state gnoi_sheet_try_apart(const gnoi_pair *p, const gnoi_casters *casters, const gnoi_lbox *boxes, int count,
                                      gnoi_columns *columns, gnoi_column *column)
{
    const gnoi_grain grain = {-1, 1};
    gnoi_near *near = columns->near = &columns->nears[GNOI_NEAR_DEPTH];
    outlook look = {0, 0, 0};
    gnoi_probe none;
    gnoi_sheet_state state = GNOI_SHEET_PART;
    none.edge_count = 0;
    for (int i = 0; i < count && state == GNOI_SHEET_PART; i++)
        state = gnoi_gather(columns->context, &casters->far, NULL, &boxes[i], grain, &near->far)
                    ? look_up(p, &casters->far.frame, &boxes[i], &none, columns, &look)
                    : GNOI_SHEET_NO_MEMORY;
    if (state == GNOI_SHEET_PART)
        state = judge(&look);
    if (state == GNOI_SHEET_PART)
        state = add_rims_apart(p, casters, boxes, count, columns, column);
    if (state == GNOI_SHEET_PIERCED)
        forget_rims(columns, column);
    return state;
}
