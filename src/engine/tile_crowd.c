/* tile_crowd.c -- see tile_crowd.h. */
#include "engine/tile_crowd.h"

#include <stdlib.h>

#define FEW 64 /* crossings that are sorted by insertion */

static int by_upper_end(const void *a, const void *b)
{
    const gnoi_edge *e = a, *f = b;
    return (e->y > f->y) - (e->y < f->y);
}

static int by_number(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void begin_sweep(gnoi_crowd *c, double y)
{
    qsort(c->edges, c->count, sizeof *c->edges, by_upper_end);
    c->done = c->next = 0;
    c->y = y;
}

gnoi_crowd gnoi_crowd_make(gnoi_edge *edges, size_t count, double y0, double y1)
{
    gnoi_crowd c = {NULL, 0, 0, 0, 0};
    c.edges = edges;
    for (size_t i = 0; i < count; i++)
        if (edges[i].y <= y1 && edges[i].y1 > y0)
            edges[c.count++] = edges[i];
    begin_sweep(&c, y0);
    return c;
}

unsigned gnoi_crowd_cross(gnoi_crowd *c, double y, double *x)
{
    size_t n;
    if (y < c->y)
        begin_sweep(c, y);
    c->y = y;
    while (c->next < c->count && !(y < c->edges[c->next].y))
        c->next++;
    for (size_t i = c->done; i < c->next; i++)
        if (!(y < c->edges[i].y1)) {
            const gnoi_edge ended = c->edges[i];
            c->edges[i] = c->edges[c->done];
            c->edges[c->done++] = ended;
        }
    n = c->next - c->done;
    if (n <= FEW)
        return gnoi_edges_cross(c->edges + c->done, (unsigned)n, y, x);
    for (size_t i = 0; i < n; i++) {
        const gnoi_edge *e = &c->edges[c->done + i];
        x[i] = e->x + (y - e->y) * e->slope;
    }
    qsort(x, n, sizeof *x, by_number);
    return (unsigned)n;
}
