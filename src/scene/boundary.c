/* boundary.c -- see boundary.h.
 *
 * Most edges cancel, and so do all edges around most vertices. Every directed edge belongs to the lower of its two vertices: it adds a
 * pseudo-random number of the higher vertex there, or takes it away, by its direction. Where the sum is zero all edges of the vertex cancel
 * (by chance only once in 2^64 where they do not). The few edges of other vertices are listed, sorted by their vertices, and cancelled
 * against their reverses one by one. Who knows where a boundary may run spares the sums.
 */
#include "scene/boundary.h"
#include "base/sort.h"

#include <string.h>

#define FEW 16 /* of less than this share of all polygons all edges are listed without sums */

/* A directed edge of the lower vertex. */
typedef struct half_edge {
    uint32_t low, other; /* the higher vertex */
    uint32_t poly;
    uint32_t up;         /* 1: runs from the lower vertex to the higher */
} half_edge;

typedef struct finding {
    gno_context *context;
    const gnoi_prepared *prep;
    const unsigned char *taken;
    size_t count;
    uint64_t *sums; /* of vertices; NULL: not made */
    const unsigned char *may_bound; /* of vertices; NULL: any may */
    size_t half_count, half_capacity;
    half_edge *halves;
} finding;

static uint64_t number_of(uint32_t vertex)
{
    uint64_t x = ((uint64_t)vertex + 1) * 0x9e3779b97f4a7c15u;
    x = (x ^ x >> 32) * 0x94d049bb133111ebu;
    return x ^ x >> 29;
}

static const uint32_t *corners_of(const finding *f, size_t i, uint32_t *count)
{
    const gnoi_poly *cap = &f->prep->polys[i];
    if (i < f->prep->poly_count)
        return gnoi_corners_of(f->prep, i, count);
    *count = cap->corner_count;
    return f->prep->corner_vertex + cap->corner;
}

/* Adds the edges of polygon i to the sums. */
static void add_edges(const finding *f, size_t i)
{
    uint32_t count, from;
    const uint32_t *corner = corners_of(f, i, &count);
    uint64_t h = number_of(from = corner[count - 1]);
    for (uint32_t k = 0; k < count; k++) {
        uint32_t to = corner[k];
        uint64_t g = number_of(to);
        f->sums[from < to ? from : to] += from < to ? g : from > to ? 0 - h : 0;
        from = to;
        h = g;
    }
}

static int is_inner(const finding *f, uint32_t low, uint32_t other)
{
    if (f->may_bound)
        return !f->may_bound[low] || !f->may_bound[other];
    return f->sums && f->sums[low] == 0;
}

/* 1 when no edge of the polygon can lie on the boundary: most have no two corners that may. */
static int is_far_inside(const finding *f, const uint32_t *corner, uint32_t count)
{
    unsigned some = 0;
    if (!f->may_bound)
        return 0;
    for (uint32_t k = 0; k < count; k++)
        some += f->may_bound[corner[k]];
    return some < 2;
}

/* Lists those edges of polygon i that are not known to cancel; 0 without memory. */
static int list_edges(finding *f, size_t i)
{
    uint32_t count;
    const uint32_t *corner = corners_of(f, i, &count);
    if (is_far_inside(f, corner, count))
        return 1;
    for (uint32_t k = 0; k < count; k++) {
        uint32_t v = corner[k], w = corner[k + 1 < count ? k + 1 : 0], low = v < w ? v : w;
        half_edge *h;
        if (v == w || is_inner(f, low, v < w ? w : v))
            continue;
        if (!gnoi_reserve(f->context, (void **)&f->halves, &f->half_capacity, f->half_count + 1, sizeof *f->halves))
            return 0;
        h = &f->halves[f->half_count++];
        h->low = low;
        h->other = v < w ? w : v;
        h->poly = (uint32_t)i;
        h->up = v < w;
    }
    return 1;
}

/* The first taken polygon from i on; f->count: none. */
static size_t next_taken(const finding *f, size_t i)
{
    const unsigned char *found;
    if (i >= f->count || f->taken[i] == 1)
        return i;
    found = memchr(f->taken + i, 1, f->count - i);
    return found ? (size_t)(found - f->taken) : f->count;
}

static int list_halves(finding *f)
{
    size_t some = 0;
    for (size_t i = 0; i < f->count && !f->may_bound; i++)
        some += f->taken[i] == 1;
    if (some > f->count / FEW) {
        f->sums = gnoi_calloc(f->context, f->prep->vertex_count, sizeof *f->sums);
        if (!f->sums)
            return 0;
    }
    for (size_t i = next_taken(f, 0); i < f->count && f->sums; i = next_taken(f, i + 1))
        add_edges(f, i);
    if (gnoi_stopped(f->context))
        return 0;
    for (size_t i = next_taken(f, 0); i < f->count; i = next_taken(f, i + 1))
        if (!list_edges(f, i))
            return 0;
    return !gnoi_stopped(f->context);
}

/* Halves by lower, then higher vertex, in the order of polygons; NULL without memory. The order is of half_count numbers and scratch. */
static gnoi_keyed *sort_halves(const finding *f)
{
    gnoi_keyed *order = gnoi_malloc(f->context, 2 * f->half_count, sizeof *order);
    for (size_t i = 0; order && i < f->half_count; i++) {
        order[i].key = f->halves[i].other;
        order[i].value = (uint32_t)i;
    }
    if (!order)
        return NULL;
    gnoi_sort(order, order + f->half_count, f->half_count);
    for (size_t i = 0; i < f->half_count; i++)
        order[i].key = f->halves[order[i].value].low;
    gnoi_sort(order, order + f->half_count, f->half_count);
    return order;
}

/* Keeps what a run of halves between the same two vertices leaves over. */
static int keep_rest(const finding *f, const gnoi_keyed *run, size_t count, gnoi_boundary *c)
{
    size_t up = 0, rest;
    uint32_t way;
    for (size_t i = 0; i < count; i++)
        up += f->halves[run[i].value].up;
    way = 2 * up > count;
    rest = way ? 2 * up - count : count - 2 * up;
    if (!gnoi_reserve(f->context, (void **)&c->edges, &c->capacity, c->count + rest, sizeof *c->edges))
        return 0;
    for (size_t i = 0; i < count && rest > 0; i++) {
        const half_edge *h = &f->halves[run[i].value];
        if (h->up == way) {
            gnoi_boundary_edge *e = &c->edges[c->count++];
            e->from = way ? h->low : h->other;
            e->to = way ? h->other : h->low;
            e->poly = h->poly;
            rest--;
        }
    }
    return 1;
}

static int cancel(const finding *f, const gnoi_keyed *order, gnoi_boundary *c)
{
    size_t run;
    for (size_t i = 0; i < f->half_count; i += run) {
        const half_edge *h = &f->halves[order[i].value];
        for (run = 1; i + run < f->half_count; run++) {
            const half_edge *next = &f->halves[order[i + run].value];
            if (next->low != h->low || next->other != h->other)
                break;
        }
        if (!keep_rest(f, order + i, run, c) || gnoi_stopped_at(f->context, i))
            return 0;
    }
    return 1;
}

int gnoi_boundary_find(gno_context *context, const gnoi_prepared *prep, const unsigned char *taken, size_t count,
                       const unsigned char *may_bound, gnoi_boundary *boundary)
{
    finding f = {context, prep, taken, count, NULL, may_bound, 0, 0, NULL};
    gnoi_keyed *order = NULL;
    int good = list_halves(&f);
    gnoi_free(context, f.sums, prep->vertex_count, sizeof *f.sums);
    if (good)
        order = sort_halves(&f);
    good = order && cancel(&f, order, boundary);
    gnoi_free(context, order, 2 * f.half_count, sizeof *order);
    gnoi_free(context, f.halves, f.half_capacity, sizeof *f.halves);
    return good;
}

void gnoi_boundary_free(gno_context *context, gnoi_boundary *boundary)
{
    gnoi_free(context, boundary->edges, boundary->capacity, sizeof *boundary->edges);
    boundary->edges = NULL;
    boundary->count = boundary->capacity = 0;
}
