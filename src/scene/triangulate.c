/* triangulate.c -- cuts a planar polygon with holes into triangles.
 *
 * Place in the data flow: prepare.c, for polygons that are not planar and for smooth ones of more than three corners.
 * The rings become one ring of nodes: the outer one counter-clockwise, every hole clockwise and joined to it by a bridge that is
 * walked both ways. Then ears are clipped: convex nodes whose triangle holds no other reflex node.
 * Invariants: the ring loses one node a triangle, so exactly nodes - 2 triangles come out whatever the input; a node's
 * status is looked at again only when a neighbour goes, which bounds the work by n^2 on any input; a lattice over the nodes of
 * large rings keeps it near n on all but such as are made for it. Where no ear is
 * left (rings that cross or touch themselves), the least harmful node is clipped regardless.
 * Source: ear clipping after Meisters 1975 and O'Rourke, Computational Geometry in C, 1.3; bridges to the rightmost visible
 * point after Eberly, Triangulation by Ear Clipping, 2002.
 */
#include "scene/scene.h"

#include <stdlib.h>
#include <string.h>

#define LOCAL_NODES 32 /* polygons of up to this many nodes need no memory from the context */
#define RESCANS 8      /* times that a ring without ears is searched anew before nodes are clipped regardless */

#define MOST_WORK 65536
#define MANY_NODES 512 /* from so many on a lattice finds those near an ear */
#define MOST_CELLS 1024 /* of it along an axis */

typedef struct node {
    double u, v;
    uint32_t corner;
    uint32_t previous, next;
    uint32_t reflex; /* place in the list of reflex nodes, GNOI_NONE when convex or gone */
    unsigned char ear, gone;
} node;

/* The nodes of the ring by place; made anew whenever half of them have gone. */
typedef struct lattice {
    uint32_t *start, *items;  /* nodes of cell k: items[start[k]] .. items[start[k + 1] - 1] */
    size_t start_room, item_room;
    uint32_t side, made_of;   /* cells along an axis, 0: none in use; nodes */
    double low[2], per_unit[2];
} lattice;

typedef struct clipper {
    gno_context *context;
    lattice places;
    size_t work;  /* nodes looked at since the last question whether to stop */
    int stopped;
    const double (*positions)[3];
    const uint32_t *corner_vertex;
    double origin[2];
    int axis_u, axis_v;
    node *nodes;
    uint32_t node_count;
    uint32_t *reflex; /* nodes that are not convex, in no order */
    uint32_t reflex_count;
    uint32_t (*triangles)[3];
    uint32_t triangle_count;
} clipper;

/* ---- geometry in the projection ---------------------------------------------------------------------------------- */

/* Twice the area of abc, positive counter-clockwise. */
static double area(const node *a, const node *b, const node *c)
{
    return (b->u - a->u) * (c->v - a->v) - (b->v - a->v) * (c->u - a->u);
}

static int same_place(const node *a, const node *b)
{
    return a->u == b->u && a->v == b->v;
}

/* In the closed triangle abc, which is counter-clockwise. */
static int in_triangle(const node *a, const node *b, const node *c, const node *p)
{
    return area(a, b, p) >= 0 && area(b, c, p) >= 0 && area(c, a, p) >= 0;
}

/* Whether the segment from node a towards b starts inside the ring, or along it. */
static int starts_inside(const node *nodes, const node *a, const node *b)
{
    const node *previous = &nodes[a->previous], *next = &nodes[a->next];
    if (area(previous, a, next) > 0) {
        return area(a, next, b) >= 0 && area(previous, a, b) >= 0;
    }
    return area(a, next, b) >= 0 || area(previous, a, b) >= 0;
}

/* ---- rings of nodes ---------------------------------------------------------------------------------------------- */

static node make_node(const clipper *c, uint32_t corner)
{
    const double *p = c->positions[c->corner_vertex[corner]];
    node n;
    n.u = p[c->axis_u] - c->origin[0];
    n.v = p[c->axis_v] - c->origin[1];
    n.corner = corner;
    n.previous = n.next = 0;
    n.reflex = GNOI_NONE;
    n.ear = n.gone = 0;
    return n;
}

/* Links the corners [from,to) into a ring of nodes, counter-clockwise for turn 1, clockwise for -1; returns its leftmost. */
static uint32_t make_ring(clipper *c, uint32_t from, uint32_t to, int turn)
{
    uint32_t first = c->node_count, count = to - from, left = first, i;
    double doubled = 0;
    for (i = 0; i < count; i++) {
        c->nodes[first + i] = make_node(c, from + i);
    }
    for (i = 1; i + 1 < count; i++) {
        doubled += area(&c->nodes[first], &c->nodes[first + i], &c->nodes[first + i + 1]);
    }
    for (i = 0; i < count; i++) {
        uint32_t after = first + (i + 1 < count ? i + 1 : 0), before = first + (i > 0 ? i - 1 : count - 1);
        node *n = &c->nodes[first + i];
        int forward = (doubled >= 0) == (turn > 0);
        n->next = forward ? after : before;
        n->previous = forward ? before : after;
        if (n->u < c->nodes[left].u || (n->u == c->nodes[left].u && n->v < c->nodes[left].v)) {
            left = first + i;
        }
    }
    c->node_count += count;
    return left;
}

/* Joins node a of one ring to node b of another by an edge walked both ways: two nodes more. */
static void join(clipper *c, uint32_t a, uint32_t b)
{
    uint32_t a2 = c->node_count++, b2 = c->node_count++;
    uint32_t after = c->nodes[a].next, before = c->nodes[b].previous;
    c->nodes[a2] = c->nodes[a];
    c->nodes[b2] = c->nodes[b];
    c->nodes[a].next = b;
    c->nodes[b].previous = a;
    c->nodes[before].next = b2;
    c->nodes[b2].previous = before;
    c->nodes[b2].next = a2;
    c->nodes[a2].previous = b2;
    c->nodes[a2].next = after;
    c->nodes[after].previous = a2;
}

/* ---- bridges ----------------------------------------------------------------------------------------------------- */

/* First edge of the ring that a ray from h to the left meets: the end of it that is further left, and where. GNOI_NONE
 * when there is none, which means that the hole is not inside. */
static uint32_t look_left(const clipper *c, uint32_t ring, const node *h, double *met)
{
    uint32_t i = ring, found = GNOI_NONE;
    double nearest = -HUGE_VAL;
    do {
        const node *p = &c->nodes[i], *q = &c->nodes[p->next];
        if (same_place(p, h) && starts_inside(c->nodes, p, &c->nodes[h->next])) {
            *met = p->u;
            return i; /* the hole touches the ring here */
        }
        if (p->v >= h->v && q->v <= h->v && p->v != q->v) {
            double u = p->u + (h->v - p->v) / (q->v - p->v) * (q->u - p->u);
            if (u <= h->u && u > nearest) {
                nearest = u;
                found = p->u < q->u ? i : p->next;
            }
        }
        i = p->next;
    } while (i != ring);
    *met = nearest;
    return found;
}

/* A node of the ring that h sees: the end of the edge met, unless nodes lie in the triangle between; then that of
 * them which is seen at the least angle from the ray. */
static uint32_t find_bridge(const clipper *c, uint32_t ring, const node *h)
{
    double met, best = HUGE_VAL;
    uint32_t found = look_left(c, ring, h, &met), i = ring, bridge;
    const node *end;
    node touch = *h;
    if (found == GNOI_NONE) {
        return ring;
    }
    bridge = found;
    end = &c->nodes[found];
    touch.u = met;
    if (same_place(end, h)) {
        return found;
    }
    do {
        const node *p = &c->nodes[i];
        if (p->u >= end->u && p->u < h->u &&
            (end->v < h->v ? in_triangle(&touch, end, h, p) : in_triangle(h, end, &touch, p)) && starts_inside(c->nodes, p, h)) {
            double slope = fabs(h->v - p->v) / (h->u - p->u);
            if (slope < best || (slope == best && p->u > c->nodes[bridge].u)) {
                best = slope;
                bridge = i;
            }
        }
        i = p->next;
    } while (i != ring);
    return bridge;
}

typedef struct hole {
    double u, v;
    uint32_t left; /* node */
} hole;

static int compare_holes(const void *a, const void *b)
{
    const hole *p = a, *q = b;
    if (p->u != q->u) {
        return p->u < q->u ? -1 : 1;
    }
    if (p->v != q->v) {
        return p->v < q->v ? -1 : 1;
    }
    return p->left < q->left ? -1 : 1;
}

/* Counts work; a stop ends the loops over nodes, and the triangles are then not all written. */
static void count_work(clipper *c, size_t nodes)
{
    c->work += nodes;
    if (c->work >= MOST_WORK) {
        c->work = 0;
        c->stopped |= gnoi_stopped(c->context);
    }
}

/* From the left to the right, so that the ray to the left meets the ring or a hole that is part of it already. */
static void join_holes(clipper *c, const uint32_t *ring_corner, uint32_t ring_count, uint32_t outer, hole *holes)
{
    uint32_t r;
    for (r = 1; r < ring_count; r++) {
        hole *h = &holes[r - 1];
        h->left = make_ring(c, ring_corner[r], ring_corner[r + 1], -1);
        h->u = c->nodes[h->left].u;
        h->v = c->nodes[h->left].v;
    }
    qsort(holes, ring_count - 1, sizeof *holes, compare_holes);
    for (r = 0; r + 1 < ring_count && !c->stopped; r++) {
        count_work(c, c->node_count);
        join(c, find_bridge(c, outer, &c->nodes[holes[r].left]), holes[r].left);
    }
}

/* ---- ears -------------------------------------------------------------------------------------------------------- */

static void set_reflex(clipper *c, uint32_t i, int reflex)
{
    node *n = &c->nodes[i];
    if (reflex && n->reflex == GNOI_NONE) {
        n->reflex = c->reflex_count;
        c->reflex[c->reflex_count++] = i;
    } else if (!reflex && n->reflex != GNOI_NONE) {
        uint32_t last = c->reflex[--c->reflex_count];
        c->reflex[n->reflex] = last;
        c->nodes[last].reflex = n->reflex;
        n->reflex = GNOI_NONE;
    }
}

static uint32_t cell_of(const lattice *l, int axis, double v)
{
    double t = (v - l->low[axis]) * l->per_unit[axis];
    return t > 0 ? t < l->side - 1 ? (uint32_t)t : l->side - 1 : 0;
}

/* Counts the ring's nodes in their cells, or, the second time, puts them there. */
static void fill_cells(const clipper *c, uint32_t start, int put)
{
    const lattice *l = &c->places;
    uint32_t i = start;
    do {
        const node *n = &c->nodes[i];
        uint32_t *at = &l->start[cell_of(l, 0, n->u) * l->side + cell_of(l, 1, n->v) + 1];
        if (put) {
            l->items[--*at] = i;
        } else {
            ++*at;
        }
        i = n->next;
    } while (i != start);
}

/* Puts the nodes left on the ring into a lattice of about as many cells. Returns 0 when memory fails. */
static int place_nodes(clipper *c, uint32_t start, uint32_t left)
{
    lattice *l = &c->places;
    double high[2];
    uint32_t i = start, side = (uint32_t)sqrt((double)left);
    size_t cells;
    l->side = side < MOST_CELLS ? side : MOST_CELLS;
    l->made_of = left;
    cells = (size_t)l->side * l->side;
    if (!l->start) {
        l->start_room = cells + 2;
        l->item_room = left;
        l->start = gnoi_malloc(c->context, l->start_room, sizeof *l->start);
        l->items = gnoi_malloc(c->context, l->item_room, sizeof *l->items);
    }
    if (!l->start || !l->items) {
        return 0;
    }
    l->low[0] = high[0] = c->nodes[i].u;
    l->low[1] = high[1] = c->nodes[i].v;
    do {
        const node *n = &c->nodes[i];
        l->low[0] = fmin(l->low[0], n->u);
        high[0] = fmax(high[0], n->u);
        l->low[1] = fmin(l->low[1], n->v);
        high[1] = fmax(high[1], n->v);
        i = n->next;
    } while (i != start);
    l->per_unit[0] = high[0] > l->low[0] ? l->side / (high[0] - l->low[0]) : 0;
    l->per_unit[1] = high[1] > l->low[1] ? l->side / (high[1] - l->low[1]) : 0;
    memset(l->start, 0, (cells + 2) * sizeof *l->start);
    fill_cells(c, start, 0);
    for (size_t k = 1; k < cells + 2; k++) {
        l->start[k] += l->start[k - 1];
    }
    fill_cells(c, start, 1); /* start[k + 1] is now where cell k begins */
    memmove(l->start, l->start + 1, cells * sizeof *l->start);
    l->start[cells] = left;
    return 1;
}

/* The triangle before and after a node with its bounds. */
typedef struct ear {
    const node *p, *n, *q;
    double low_u, high_u, low_v, high_v;
} ear;

/* Nodes in the places of the three corners are copies that bridges made; they lie in other sectors and do not matter. */
static int lies_in(const ear *e, const node *r)
{
    return r->u >= e->low_u && r->u <= e->high_u && r->v >= e->low_v && r->v <= e->high_v && in_triangle(e->p, e->n, e->q, r) &&
           !same_place(r, e->p) && !same_place(r, e->n) && !same_place(r, e->q);
}

static int is_ear(clipper *c, const node *n)
{
    const lattice *l = &c->places;
    const node *p = &c->nodes[n->previous], *q = &c->nodes[n->next];
    const ear e = {p, n, q, fmin(p->u, fmin(n->u, q->u)), fmax(p->u, fmax(n->u, q->u)), fmin(p->v, fmin(n->v, q->v)), fmax(p->v, fmax(n->v, q->v))};
    if (l->side > 0) {
        const uint32_t u0 = cell_of(l, 0, e.low_u), u1 = cell_of(l, 0, e.high_u), v0 = cell_of(l, 1, e.low_v), v1 = cell_of(l, 1, e.high_v);
        size_t looked = 0;
        for (uint32_t u = u0; u <= u1; u++) {
            const uint32_t from = l->start[u * l->side + v0], to = l->start[u * l->side + v1 + 1]; /* one run for all cells of the row */
            looked += 1 + to - from;
            for (uint32_t k = from; k < to; k++) {
                const node *r = &c->nodes[l->items[k]];
                if (r->reflex != GNOI_NONE && lies_in(&e, r)) {
                    return 0;
                }
            }
        }
        count_work(c, looked);
        return 1;
    }
    count_work(c, c->reflex_count);
    for (uint32_t k = 0; k < c->reflex_count; k++) {
        if (lies_in(&e, &c->nodes[c->reflex[k]])) {
            return 0;
        }
    }
    return 1;
}

static void judge(clipper *c, uint32_t i)
{
    node *n = &c->nodes[i];
    int reflex = !(area(&c->nodes[n->previous], n, &c->nodes[n->next]) > 0);
    set_reflex(c, i, reflex);
    n->ear = !reflex && !c->stopped && is_ear(c, n);
}

static void emit(clipper *c, uint32_t i)
{
    const node *n = &c->nodes[i];
    uint32_t *t = c->triangles[c->triangle_count++];
    t[0] = c->nodes[n->previous].corner;
    t[1] = n->corner;
    t[2] = c->nodes[n->next].corner;
}

/* Takes node i's triangle off the ring; returns the node after it. */
static uint32_t clip(clipper *c, uint32_t i)
{
    node *n = &c->nodes[i];
    emit(c, i);
    set_reflex(c, i, 0);
    n->gone = 1;
    c->nodes[n->previous].next = n->next;
    c->nodes[n->next].previous = n->previous;
    judge(c, n->previous);
    judge(c, n->next);
    return n->next;
}

/* Without ears: a node of no area (a spike, a straight run, a doubled corner) harms least, then a convex one, then any. */
static uint32_t least_harm(const clipper *c, uint32_t start)
{
    uint32_t i = start, convex = GNOI_NONE;
    do {
        const node *n = &c->nodes[i];
        double doubled = area(&c->nodes[n->previous], n, &c->nodes[n->next]);
        if (doubled == 0) {
            return i;
        }
        if (doubled > 0 && convex == GNOI_NONE) {
            convex = i;
        }
        i = n->next;
    } while (i != start);
    return convex == GNOI_NONE ? start : convex;
}

static void judge_all(clipper *c, uint32_t start)
{
    uint32_t i = start;
    do { /* all reflex nodes must be known before the first ear is judged */
        const node *n = &c->nodes[i];
        set_reflex(c, i, !(area(&c->nodes[n->previous], n, &c->nodes[n->next]) > 0));
        i = n->next;
    } while (i != start);
    do {
        judge(c, i);
        i = c->nodes[i].next;
    } while (i != start);
}

/* Returns 0 when memory fails. */
static int clip_all(clipper *c, uint32_t start)
{
    uint32_t left = c->node_count, i = start, looked = 0;
    int rescans = RESCANS;
    if (left >= MANY_NODES && !place_nodes(c, start, left)) {
        return 0;
    }
    judge_all(c, start);
    while (left > 3 && !c->stopped) {
        if (c->places.side > 0 && left < c->places.made_of / 2 && !place_nodes(c, i, left)) {
            return 0;
        }
        if (c->nodes[i].ear) {
            i = c->nodes[clip(c, i)].next; /* past the neighbour, so that slivers do not gather at one node */
            left--;
            looked = 0;
        } else if (looked++ < left) {
            i = c->nodes[i].next;
        } else if (rescans-- > 0) {
            judge_all(c, i);
            looked = 0;
        } else {
            rescans = 0;
            count_work(c, left);
            i = clip(c, least_harm(c, i));
            left--;
            looked = 0;
        }
    }
    emit(c, i);
    return 1;
}

/* ---- the whole --------------------------------------------------------------------------------------------------- */

/* The projection along the normal's largest component that keeps counter-clockwise as seen against the normal. */
static void choose_axes(clipper *c, const double normal[3])
{
    int drop = 2, swap;
    if (fabs(normal[0]) > fabs(normal[1]) && fabs(normal[0]) > fabs(normal[2])) {
        drop = 0;
    } else if (fabs(normal[1]) > fabs(normal[2])) {
        drop = 1;
    }
    swap = normal[drop] < 0;
    c->axis_u = (drop + 1 + swap) % 3;
    c->axis_v = (drop + 2 - swap) % 3;
}

static void set_triangle(uint32_t triangle[3], uint32_t a, uint32_t b, uint32_t c)
{
    triangle[0] = a;
    triangle[1] = b;
    triangle[2] = c;
}

static double distance_squared(const clipper *c, uint32_t corner, uint32_t other)
{
    vec3 d = v3_sub(v3_from(c->positions[c->corner_vertex[corner]]), v3_from(c->positions[c->corner_vertex[other]]));
    return v3_dot(d, d);
}

/* Four corners, the common case: the shorter diagonal of those that lie inside. */
static void cut_quad(const clipper *c, uint32_t first, uint32_t (*triangles)[3])
{
    node n[4];
    int i, cut02, cut13;
    for (i = 0; i < 4; i++) {
        n[i] = make_node(c, first + (uint32_t)i);
    }
    cut02 = area(&n[0], &n[1], &n[2]) > 0 && area(&n[0], &n[2], &n[3]) > 0;
    cut13 = area(&n[1], &n[2], &n[3]) > 0 && area(&n[1], &n[3], &n[0]) > 0;
    if (cut02 && cut13) {
        cut02 = distance_squared(c, first, first + 2) <= distance_squared(c, first + 1, first + 3);
    }
    if (cut02 || !cut13) {
        set_triangle(triangles[0], first, first + 1, first + 2);
        set_triangle(triangles[1], first, first + 2, first + 3);
    } else {
        set_triangle(triangles[0], first + 1, first + 2, first + 3);
        set_triangle(triangles[1], first + 1, first + 3, first);
    }
}

gno_status gnoi_triangulate(gno_context *context, const double (*positions)[3], const uint32_t *corner_vertex,
                            const uint32_t *ring_corner, uint32_t ring_count, const double normal[3],
                            uint32_t (*triangles)[3])
{
    uint32_t first = ring_corner[0], corners = ring_corner[ring_count] - first, outer;
    size_t count = (size_t)corners + 2 * ((size_t)ring_count - 1);
    node local_nodes[LOCAL_NODES];
    uint32_t local_reflex[LOCAL_NODES];
    hole local_holes[LOCAL_NODES];
    int local = count <= LOCAL_NODES;
    hole *holes = local_holes;
    gno_status status = GNO_OK;
    clipper c;
    c.context = context;
    memset(&c.places, 0, sizeof c.places);
    c.work = 0;
    c.stopped = 0;
    c.positions = positions;
    c.corner_vertex = corner_vertex;
    c.nodes = local ? local_nodes : gnoi_malloc(context, count, sizeof *c.nodes);
    c.reflex = local ? local_reflex : gnoi_malloc(context, count, sizeof *c.reflex);
    holes = local ? local_holes : gnoi_malloc(context, ring_count, sizeof *holes);
    c.node_count = c.reflex_count = c.triangle_count = 0;
    c.triangles = triangles;
    choose_axes(&c, normal);
    if (!c.nodes || !c.reflex || !holes) {
        status = GNO_ERROR_MEMORY;
    } else if (count == 3) {
        set_triangle(triangles[0], first, first + 1, first + 2);
    } else {
        c.origin[0] = positions[corner_vertex[first]][c.axis_u];
        c.origin[1] = positions[corner_vertex[first]][c.axis_v];
        if (count == 4) {
            cut_quad(&c, first, triangles);
        } else {
            outer = make_ring(&c, first, ring_corner[1], 1);
            join_holes(&c, ring_corner, ring_count, outer, holes);
            status = !clip_all(&c, outer) ? GNO_ERROR_MEMORY : c.stopped ? GNO_ERROR_CANCELLED : GNO_OK;
        }
    }
    if (!local) {
        gnoi_free(context, c.nodes, count, sizeof *c.nodes);
        gnoi_free(context, c.reflex, count, sizeof *c.reflex);
        gnoi_free(context, holes, ring_count, sizeof *holes);
        gnoi_free(context, c.places.start, c.places.start_room, sizeof *c.places.start);
        gnoi_free(context, c.places.items, c.places.item_room, sizeof *c.places.items);
    }
    return status;
}
