/* sweep.c -- what lies on both sides of every edge, and which half-edge follows which around the result.
 *
 * Place: seventh pass (clipper.h). In: edges. Out: their depths, flags, `under` and `next`. A vertical line sweeps the vertices from left
 * to right. The edges over it are known from below to above, so the depth below a new edge is the depth above its neighbour.
 *
 * An edge is kept when the result's inside lies on one side of it only; of its half-edges the one is linked that has the inside
 * on its left. Around a vertex kept half-edges come in and go out by turns, inside and outside between them:
 *
 *             out            The half-edge that comes in is followed by the one that goes out just clockwise of it, so that
 *        in    |  inside     the sector between them is inside the result: links follow the border of one connected face
 *          \   |             (Weiler and Atherton 1977; on a planar subdivision, Weiler 1980). Where faces touch in a
 *    inside \  |   in        vertex they stay apart.
 *            \ | /
 *      out ----o
 */
#include "clip/clipper.h"

static int inside(const gno_clipper *c, gno_clip_op op, const gnoi_depth *d)
{
    int s = (d->of[0] & (c->operand_polygons[0] == 1 ? 1 : -1)) != 0, t = (d->of[1] & (c->operand_polygons[1] == 1 ? 1 : -1)) != 0;
    switch (op) {
    case GNO_CLIP_INTERSECTION: return s && t;
    case GNO_CLIP_DIFFERENCE: return s && !t;
    case GNO_CLIP_XOR: return s != t;
    default: return s || t;
    }
}

/* Edge `first` .. end-1 start in one vertex; `below` is the edge under them, or NONE. */
static void classify(gno_clipper *c, gno_clip_op op, size_t first, size_t end, uint32_t below)
{
    gnoi_depth depth = {{0, 0}};
    int was_inside;
    if (below != GNOI_CLIP_NONE)
        depth = c->edges[below].above;
    was_inside = inside(c, op, &depth);
    for (size_t i = first; i < end; i++) {
        gnoi_edge *e = &c->edges[i];
        int is_inside;
        depth.of[0] += e->change.of[0];
        depth.of[1] += e->change.of[1];
        is_inside = inside(c, op, &depth);
        e->above = depth;
        e->under = below == GNOI_CLIP_NONE || c->edges[below].flags & GNOI_EDGE_KEPT ? below : c->edges[below].under;
        e->flags = was_inside == is_inside ? 0u : is_inside ? (unsigned)(GNOI_EDGE_KEPT | GNOI_EDGE_UP) : (unsigned)GNOI_EDGE_KEPT;
        was_inside = is_inside;
        below = (uint32_t)i;
    }
}

/* around[0..count) are kept edges counter-clockwise around vertex v, from downwards on. */
static void link_around(gno_clipper *c, uint32_t v, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        gnoi_edge *e = &c->edges[c->around[i]];
        int comes_in = (e->b == v) == ((e->flags & GNOI_EDGE_UP) != 0);
        if (comes_in)
            e->next = c->around[i > 0 ? i - 1 : count - 1];
    }
}

static int link_vertex(gno_clipper *c, uint32_t v, size_t first, size_t end, size_t ending)
{
    size_t count = 0;
    if (!GNOI_CLIP_RESERVE(c, around, around_capacity, end - first + ending))
        return 0;
    for (size_t i = first; i < end; i++)
        if (c->edges[i].flags & GNOI_EDGE_KEPT)
            c->around[count++] = (uint32_t)i;
    for (size_t i = ending; i-- > 0;)
        if (c->edges[c->ending[i]].flags & GNOI_EDGE_KEPT)
            c->around[count++] = c->ending[i];
    link_around(c, v, count);
    return 1;
}

static int pass_vertex(gno_clipper *c, gno_clip_op op, uint32_t v, uint32_t ending, size_t first, size_t end)
{
    gnoi_status met;
    if (!gnoi_status_meet(c, v, ending, &met))
        return 0;
    classify(c, op, first, end, met.below);
    return link_vertex(c, v, first, end, met.count) && gnoi_status_replace(c, &met, (uint32_t)first, end - first);
}

gno_status gnoi_clip_sweep(gno_clipper *c, gno_clip_op op)
{
    size_t first = 0;
    uint32_t *ending = c->bucket; /* one edge that ends in each vertex; room for as many: pieces.c counted by vertices */
    for (size_t v = 0; v < c->vertex_count; v++)
        ending[v] = GNOI_CLIP_NONE;
    for (size_t i = 0; i < c->edge_count; i++)
        ending[c->edges[i].b] = (uint32_t)i;
    if (!gnoi_status_clear(c))
        return GNO_ERROR_MEMORY;
    for (size_t v = 0; v < c->vertex_count; v++) {
        size_t end = first;
        if (gnoi_clip_stopped(c, 1))
            return GNO_ERROR_MEMORY;
        while (end < c->edge_count && c->edges[end].a == v)
            end++;
        if ((end > first || ending[v] != GNOI_CLIP_NONE) && !pass_vertex(c, op, (uint32_t)v, ending[v], first, end))
            return GNO_ERROR_MEMORY;
        first = end;
    }
    return GNO_OK;
}
