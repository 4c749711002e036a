/* rings.c -- linked half-edges become rings, rings become polygons.
 *
 * Place: eighth pass (clipper.h). In: kept edges with their links. Out: rings of vertices, each with its polygon.
 *
 * A *walk* follows the links until it is back: the border of one face on one side. It may come through a vertex more than once,
 * where the face touches itself; there it is cut, so that every ring visits a vertex once. Of the rings of a walk around the outside of
 * a face one runs counter-clockwise, the outer one, and the others are holes that touch it or each other. A face is connected, so holes
 * that touch never cut it in two.
 *
 * Walks are taken by their least edge: the lowest that starts in their leftmost vertex. When the inside lies above it, the walk goes
 * around the outside of its face and starts a polygon. When it lies below, all the walk are holes in the face that the kept edge under that
 * vertex bounds from below (`under`), and that edge belongs to a walk already taken. The same test tells a ring's turn.
 */
#include "clip/clipper.h"

static uint32_t origin_of(const gnoi_edge *e)
{
    return e->flags & GNOI_EDGE_UP ? e->a : e->b;
}

static int add_vertex(gno_clipper *c, size_t first, uint32_t v)
{
    size_t n = c->ring_vertex_count;
    if (!GNOI_CLIP_RESERVE(c, ring_vertex, ring_vertex_capacity, n + 1))
        return 0;
    /* A point on the line between its neighbours is no corner. */
    while (n >= first + 2 && gnoi_site_turn(c->vertices[c->ring_vertex[n - 2]], c->vertices[c->ring_vertex[n - 1]], c->vertices[v]) == 0)
        n--;
    c->ring_vertex[n] = v;
    c->ring_vertex_count = n + 1;
    return 1;
}

/* The half-edges path[0..count) close a ring. It starts in its leftmost vertex, which is always a corner. */
static int add_ring(gno_clipper *c, const uint32_t *path, size_t count, uint32_t polygon)
{
    size_t least = 0, first = c->ring_vertex_count;
    gnoi_ring *ring;
    if (!GNOI_CLIP_RESERVE(c, rings, ring_capacity, c->ring_count + 1))
        return 0;
    for (size_t i = 1; i < count; i++)
        least = path[i] < path[least] ? i : least;
    ring = &c->rings[c->ring_count];
    ring->outer = (c->edges[path[least]].flags & GNOI_EDGE_UP) != 0;
    ring->polygon = polygon;
    ring->first = first;
    if (!ring->outer) /* the least edge comes into the leftmost vertex */
        least = least + 1 < count ? least + 1 : 0;
    for (size_t i = 0; i < count; i++)
        if (!add_vertex(c, first, origin_of(&c->edges[path[least + i < count ? least + i : least + i - count]])))
            return 0;
    if (!add_vertex(c, first, c->ring_vertex[first]))
        return 0;
    ring->end = --c->ring_vertex_count;
    c->ring_count++;
    return 1;
}

/* Forgets path[first..count) and hands it over as a ring. */
static int cut_ring(gno_clipper *c, size_t first, size_t count, uint32_t polygon)
{
    for (size_t i = first; i < count; i++)
        c->on_path[origin_of(&c->edges[c->around[i]])] = GNOI_CLIP_NONE;
    return add_ring(c, c->around + first, count - first, polygon);
}

static int walk_from(gno_clipper *c, uint32_t start)
{
    size_t count = 0;
    uint32_t polygon = c->edges[start].flags & GNOI_EDGE_UP ? (uint32_t)c->result_polygons++ : c->edges[c->edges[start].under].polygon;
    uint32_t i = start;
    do {
        gnoi_edge *e = &c->edges[i];
        uint32_t v = origin_of(e);
        if (gnoi_clip_stopped(c, 1))
            return 0;
        if (c->on_path[v] != GNOI_CLIP_NONE) {
            size_t first = c->on_path[v];
            if (!cut_ring(c, first, count, polygon))
                return 0;
            count = first;
        }
        c->on_path[v] = (uint32_t)count;
        c->around[count++] = i;
        e->polygon = polygon;
        e->flags |= GNOI_EDGE_TRACED;
        i = e->next;
    } while (i != start);
    return cut_ring(c, 0, count, polygon);
}

gno_status gnoi_clip_rings(gno_clipper *c)
{
    c->ring_count = c->ring_vertex_count = c->result_polygons = 0;
    if (!GNOI_CLIP_RESERVE(c, around, around_capacity, c->edge_count) ||
        !GNOI_CLIP_RESERVE(c, on_path, on_path_capacity, c->vertex_count))
        return GNO_ERROR_MEMORY;
    for (size_t i = 0; i < c->vertex_count; i++)
        c->on_path[i] = GNOI_CLIP_NONE;
    for (size_t i = 0; i < c->edge_count; i++)
        if ((c->edges[i].flags & (GNOI_EDGE_KEPT | GNOI_EDGE_TRACED)) == GNOI_EDGE_KEPT && !walk_from(c, (uint32_t)i))
            return GNO_ERROR_MEMORY;
    return GNO_OK;
}
