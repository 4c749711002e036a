/* boundary.c -- see boundary.h. Directed edges are put into a bucket for each vertex (the lower of their two) and cancelled against
 * their reverses there. */
#include "scene/boundary.h"

/* Half an edge in the bucket of its lower vertex. */
typedef struct half_edge {
    uint32_t other; /* the higher vertex */
    uint32_t poly;
    uint32_t up;    /* 1: runs from the lower vertex to the higher */
} half_edge;

typedef struct buckets {
    gno_context *context;
    size_t vertex_count, half_count;
    uint32_t *start; /* vertex_count + 1 */
    half_edge *halves;
} buckets;

static void buckets_free(buckets *b)
{
    gnoi_free(b->context, b->start, b->vertex_count + 2, sizeof *b->start);
    gnoi_free(b->context, b->halves, b->half_count, sizeof *b->halves);
}

/* Counts every directed edge of the polygon, or puts it into its bucket. */
static void visit_edges(const gnoi_prepared *prep, uint32_t index, buckets *b, int fill)
{
    const gnoi_poly *poly = &prep->polys[index];
    const uint32_t *corner = prep->corner_vertex + poly->corner;
    for (uint32_t k = 0; k < poly->corner_count; k++) {
        uint32_t v = corner[k], w = corner[k + 1 < poly->corner_count ? k + 1 : 0], low = v < w ? v : w;
        half_edge *h;
        if (v == w)
            continue;
        if (!fill) {
            b->start[low + 2]++;
            b->half_count++;
            continue;
        }
        h = &b->halves[b->start[low + 1]++];
        h->other = v < w ? w : v;
        h->poly = index;
        h->up = v < w;
    }
}

/* Polygons are visited in their own order, which is that of neighbours in space. */
static int fill_buckets(const gnoi_prepared *prep, const unsigned char *taken, size_t count, buckets *b)
{
    b->vertex_count = prep->vertex_count;
    b->start = gnoi_calloc(b->context, b->vertex_count + 2, sizeof *b->start);
    if (!b->start)
        return 0;
    for (uint32_t i = 0; i < count; i++)
        if (taken[i])
            visit_edges(prep, i, b, 0);
    for (size_t v = 2; v < b->vertex_count + 2; v++)
        b->start[v] += b->start[v - 1];
    if (gnoi_stopped(b->context))
        return 0;
    b->halves = gnoi_malloc(b->context, b->half_count, sizeof *b->halves);
    if (!b->halves)
        return 0;
    for (uint32_t i = 0; i < count; i++)
        if (taken[i])
            visit_edges(prep, i, b, 1);
    return !gnoi_stopped(b->context);
}

/* By the higher vertex. Buckets hold a handful, but for the tips of large fans: Shell's gaps keep those from growing quadratic. */
static void sort_halves(half_edge *h, size_t count)
{
    static const size_t gaps[] = {29524, 9841, 3280, 1093, 364, 121, 40, 13, 4, 1};
    for (size_t g = count < 5 ? sizeof gaps / sizeof *gaps - 1 : 0; g < sizeof gaps / sizeof *gaps; g++)
        for (size_t i = gaps[g]; i < count; i++) {
            half_edge v = h[i];
            size_t k = i;
            for (; k >= gaps[g] && h[k - gaps[g]].other > v.other; k -= gaps[g])
                h[k] = h[k - gaps[g]];
            h[k] = v;
        }
}

/* Keeps what a run of halves between the same two vertices leaves over. */
static int keep_rest(gnoi_boundary *c, gno_context *context, uint32_t low, const half_edge *h, size_t count)
{
    size_t up = 0, rest;
    uint32_t way;
    for (size_t i = 0; i < count; i++)
        up += h[i].up;
    way = 2 * up > count;
    rest = way ? 2 * up - count : count - 2 * up;
    if (!gnoi_reserve(context, (void **)&c->edges, &c->capacity, c->count + rest, sizeof *c->edges))
        return 0;
    for (size_t i = 0; i < count && rest > 0; i++)
        if (h[i].up == way) {
            gnoi_boundary_edge *e = &c->edges[c->count++];
            e->from = way ? low : h[i].other;
            e->to = way ? h[i].other : low;
            e->poly = h[i].poly;
            rest--;
        }
    return 1;
}

static int cancel(gnoi_boundary *c, const buckets *b)
{
    for (uint32_t v = 0; v < b->vertex_count; v++) {
        half_edge *h = b->halves + b->start[v];
        size_t count = b->start[v + 1] - b->start[v], run;
        sort_halves(h, count);
        for (size_t i = 0; i < count; i += run) {
            for (run = 1; i + run < count && h[i + run].other == h[i].other; run++)
                ;
            if (!keep_rest(c, b->context, v, h + i, run))
                return 0;
        }
        if (gnoi_stopped_at(b->context, v))
            return 0;
    }
    return 1;
}

int gnoi_boundary_find(gno_context *context, const gnoi_prepared *prep, const unsigned char *taken, size_t count, gnoi_boundary *boundary)
{
    buckets b = {0};
    int good;
    b.context = context;
    good = fill_buckets(prep, taken, count, &b) && cancel(boundary, &b);
    buckets_free(&b);
    return good;
}

void gnoi_boundary_free(gno_context *context, gnoi_boundary *boundary)
{
    gnoi_free(context, boundary->edges, boundary->capacity, sizeof *boundary->edges);
    boundary->edges = NULL;
    boundary->count = boundary->capacity = 0;
}
