/* status.c -- the edges over the sweep line, from below: see clipper.h.
 *
 * Edges meet in vertices alone, so at a vertex the order of those that pass is never in doubt, and the ones that end there follow
 * one another.
 */
#include "clip/clipper.h"

#include <string.h>

size_t gnoi_status_find(const gno_clipper *c, uint32_t v)
{
    gnoi_site p = c->vertices[v];
    size_t low = 0, high = c->status_count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        const gnoi_edge *e = &c->edges[c->status[middle]];
        if (gnoi_site_turn(c->vertices[e->a], c->vertices[e->b], p) > 0)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

size_t gnoi_status_ending(const gno_clipper *c, size_t at, uint32_t v)
{
    size_t end = at;
    while (end < c->status_count && c->edges[c->status[end]].b == v)
        end++;
    return end - at;
}

int gnoi_status_replace(gno_clipper *c, size_t at, size_t drop, uint32_t first, size_t add)
{
    if (!GNOI_CLIP_RESERVE(c, status, status_capacity, c->status_count + add))
        return 0;
    if (drop != add)
        memmove(c->status + at + add, c->status + at + drop, (c->status_count - at - drop) * sizeof *c->status);
    for (size_t i = 0; i < add; i++)
        c->status[at + i] = first + (uint32_t)i;
    c->status_count = c->status_count - drop + add;
    return 1;
}
