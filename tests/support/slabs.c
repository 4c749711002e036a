/* slabs.c -- see slabs.h. */
#include "support/slabs.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct slab_edge {
    double x0, y0, x1, y1; /* x0 < x1 */
    size_t polygon;        /* of both shapes, numbered on */
    int operand;
} slab_edge;

typedef struct slabs {
    slab_edge *edges;
    double *cuts;
    size_t edge_count, cut_count, polygons;
} slabs;

typedef struct hit {
    double y;
    size_t polygon;
    int operand;
} hit;

static void *room(size_t count, size_t size)
{
    void *block = calloc(count + 1, size);
    if (!block) {
        fprintf(stderr, "slabs: out of memory\n");
        exit(1);
    }
    return block;
}

static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static int by_y(const void *a, const void *b)
{
    double x = ((const hit *)a)->y, y = ((const hit *)b)->y;
    return (x > y) - (x < y);
}

static void add_edge(slabs *s, const double *p, const double *q, int operand)
{
    slab_edge *e = &s->edges[s->edge_count];
    s->cuts[s->cut_count++] = p[0];
    if (p[0] == q[0])
        return;
    e->x0 = p[0] < q[0] ? p[0] : q[0];
    e->y0 = p[0] < q[0] ? p[1] : q[1];
    e->x1 = p[0] < q[0] ? q[0] : p[0];
    e->y1 = p[0] < q[0] ? q[1] : p[1];
    e->polygon = s->polygons;
    e->operand = operand;
    s->edge_count++;
}

static void add_shape(slabs *s, const gno_shape *shape, int operand)
{
    for (size_t p = 0; p < shape->polygon_count; p++, s->polygons++)
        for (size_t r = shape->polygon_start ? shape->polygon_start[p] : p; r < (shape->polygon_start ? shape->polygon_start[p + 1] : p + 1);
             r++)
            for (size_t i = shape->ring_start[r]; i < shape->ring_start[r + 1]; i++) {
                size_t j = i + 1 < shape->ring_start[r + 1] ? i + 1 : shape->ring_start[r];
                add_edge(s, shape->points + 2 * i, shape->points + 2 * j, operand);
            }
}

static double at_x(const slab_edge *e, double x)
{
    double t = (x - e->x0) / (e->x1 - e->x0);
    return e->y0 + t * (e->y1 - e->y0);
}

static void add_crossings(slabs *s)
{
    for (size_t i = 0; i < s->edge_count; i++)
        for (size_t j = 0; j < i; j++) {
            const slab_edge *e = &s->edges[i], *f = &s->edges[j];
            double a = fmax(e->x0, f->x0), b = fmin(e->x1, f->x1), da, db;
            if (!(a < b))
                continue;
            da = at_x(e, a) - at_x(f, a);
            db = at_x(e, b) - at_x(f, b);
            if (da * db < 0)
                s->cuts[s->cut_count++] = a + (b - a) * (da / (da - db));
        }
}

static double length_at(const slabs *s, gno_clip_op op, double x, hit *hits, char *odd)
{
    size_t n = 0;
    long depth[2] = {0, 0};
    double length = 0, from = 0;
    int was = 0;
    memset(odd, 0, s->polygons);
    for (size_t i = 0; i < s->edge_count; i++)
        if (s->edges[i].x0 < x && x < s->edges[i].x1) {
            hits[n].y = at_x(&s->edges[i], x);
            hits[n].polygon = s->edges[i].polygon;
            hits[n++].operand = s->edges[i].operand;
        }
    qsort(hits, n, sizeof *hits, by_y);
    for (size_t i = 0; i < n; i++) {
        int a, b, is;
        char *o = &odd[hits[i].polygon];
        *o = (char)!*o;
        depth[hits[i].operand] += *o ? 1 : -1;
        a = depth[0] > 0;
        b = depth[1] > 0;
        is = op == GNO_CLIP_UNION ? a || b : op == GNO_CLIP_INTERSECTION ? a && b : op == GNO_CLIP_DIFFERENCE ? a && !b : a != b;
        if (is && !was)
            from = hits[i].y;
        if (was && !is)
            length += hits[i].y - from;
        was = is;
    }
    return length;
}

double slab_area(gno_clip_op op, const gno_shape *subject, const gno_shape *clip)
{
    size_t points = (subject->ring_count ? subject->ring_start[subject->ring_count] : 0) +
                    (clip && clip->ring_count ? clip->ring_start[clip->ring_count] : 0);
    slabs s = {0};
    hit *hits = room(points, sizeof *hits);
    char *odd;
    double area = 0;
    s.edges = room(points, sizeof *s.edges);
    s.cuts = room(points + points * points / 2, sizeof *s.cuts);
    add_shape(&s, subject, 0);
    if (clip)
        add_shape(&s, clip, 1);
    add_crossings(&s);
    odd = room(s.polygons, 1);
    qsort(s.cuts, s.cut_count, sizeof *s.cuts, by_value);
    for (size_t i = 1; i < s.cut_count; i++)
        if (s.cuts[i - 1] < s.cuts[i])
            area += (s.cuts[i] - s.cuts[i - 1]) * length_at(&s, op, 0.5 * (s.cuts[i - 1] + s.cuts[i]), hits, odd);
    free(hits);
    free(odd);
    free(s.edges);
    free(s.cuts);
    return area;
}

double slab_extent(const gno_shape *subject, const gno_shape *clip)
{
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    const gno_shape *both[2] = {subject, clip};
    for (int k = 0; k < 2 && both[k]; k++)
        for (size_t i = 0; both[k]->ring_count && i < 2 * both[k]->ring_start[both[k]->ring_count]; i++) {
            low[i % 2] = fmin(low[i % 2], both[k]->points[i]);
            high[i % 2] = fmax(high[i % 2], both[k]->points[i]);
        }
    return low[0] <= high[0] ? fmax(high[0] - low[0], high[1] - low[1]) : 0;
}
