/* edges.c -- pieces at one place become one edge that knows what changes across it.
 *
 * Place: sixth pass (clipper.h). In: sorted pieces with their windings. Out: edges, in the same order. Where several rings run
 * along one another their windings add up, and an edge across which nothing changes is left out: that is the whole rule for
 * shared edges, overlaps, spikes and polygons clipped by themselves.
 */
#include "clip/clipper.h"

/* Gains of the operand's depth across a piece, upwards. */
static int32_t gain(const gno_clipper *c, const gnoi_piece *p, const gnoi_polygon *polygon)
{
    if (c->operand_polygons[polygon->operand] == 1)
        return 1; /* parity of a single polygon */
    return polygon->winding == GNOI_POLYGON_PARITY ? p->sign : p->sign * polygon->winding;
}

static int changes(const gno_clipper *c, const gnoi_depth *d)
{
    int32_t mask0 = c->operand_polygons[0] == 1 ? 1 : -1, mask1 = c->operand_polygons[1] == 1 ? 1 : -1;
    return (d->of[0] & mask0) != 0 || (d->of[1] & mask1) != 0;
}

gno_status gnoi_clip_edges(gno_clipper *c)
{
    if (!GNOI_CLIP_RESERVE(c, edges, edge_capacity, c->piece_count + 1))
        return GNO_ERROR_MEMORY;
    c->edge_count = 0;
    for (size_t i = 0, j; i < c->piece_count; i = j) {
        const gnoi_piece *p = &c->sorted[i];
        gnoi_edge *e = &c->edges[c->edge_count];
        gnoi_depth sum = {{0, 0}};
        if (gnoi_clip_stopped(c, 1))
            return GNO_ERROR_MEMORY;
        for (j = i; j < c->piece_count && c->sorted[j].a == p->a && c->sorted[j].b == p->b; j++) {
            const gnoi_polygon *polygon = &c->polygons[c->sorted[j].polygon];
            sum.of[polygon->operand] += gain(c, &c->sorted[j], polygon);
        }
        if (!changes(c, &sum))
            continue;
        e->a = p->a;
        e->b = p->b;
        e->change = sum;
        e->flags = 0;
        c->edge_count++;
    }
    return GNO_OK;
}
