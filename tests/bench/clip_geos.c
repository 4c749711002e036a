/* clip_geos.c -- the clipper beside GEOS: areas and validity of random and nasty shapes. Built by clip.sh with libgeos-dev.
 * Where areas differ by more than 1e-9 of the extent squared, the slow twin (support/slabs.h) is asked: GEOS snaps points together when its
 * first attempt fails, and is then off itself. "refused": GEOS made no result.
 * usage: clip_geos CASES [FIRST_SEED [FAMILY [SIZE]]]      Prints a line per family; exit status 1 when anything disagrees.
 */
#include "support/shapes.h"
#include "support/slabs.h"

#include <geos_c.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void quiet(const char *format, ...)
{
    (void)format;
}

static GEOSCoordSequence *sequence(const gno_shape *s, size_t ring)
{
    size_t first = s->ring_start[ring], n = s->ring_start[ring + 1] - first;
    GEOSCoordSequence *q = GEOSCoordSeq_create((unsigned)n + 1, 2);
    for (size_t i = 0; i <= n; i++) {
        size_t k = first + i % n;
        GEOSCoordSeq_setXY(q, (unsigned)i, s->points[2 * k], s->points[2 * k + 1]);
    }
    return q;
}

/* Replaces *sum by what lies in one of it and part only; destroys part. NULL when GEOS gives up. */
static void toggle(GEOSGeometry **sum, GEOSGeometry *part)
{
    GEOSGeometry *next = *sum && part ? GEOSSymDifference(*sum, part) : NULL;
    if (*sum)
        GEOSGeom_destroy(*sum);
    if (part)
        GEOSGeom_destroy(part);
    *sum = next;
}

static void toggle_triangle(GEOSGeometry **sum, const double *a, const double *b, const double *c)
{
    const double *corner[4] = {a, b, c, a};
    GEOSCoordSequence *q = GEOSCoordSeq_create(4, 2);
    GEOSGeometry *triangle;
    for (unsigned i = 0; i < 4; i++)
        GEOSCoordSeq_setXY(q, i, corner[i][0], corner[i][1]);
    triangle = GEOSGeom_createPolygon(GEOSGeom_createLinearRing(q), NULL, 0);
    if (GEOSisValid(triangle) == 1)
        toggle(sum, triangle);
    else
        GEOSGeom_destroy(triangle);
}

/* GEOS's even-odd inside of a polygon: the exclusive or of its rings. A ring that crosses itself is repaired by GEOS; as that does not
 * keep to the even-odd rule where edges run along one another, a ring that may do so is made of the triangles from its first point. */
static GEOSGeometry *even_odd(const gno_shape *s, size_t polygon, int overlaps)
{
    GEOSGeometry *sum = GEOSGeom_createEmptyPolygon();
    for (size_t r = s->polygon_start[polygon]; r < s->polygon_start[polygon + 1]; r++) {
        size_t first = s->ring_start[r], n = s->ring_start[r + 1] - first;
        GEOSGeometry *ring;
        if (n < 3)
            continue;
        ring = GEOSGeom_createPolygon(GEOSGeom_createLinearRing(sequence(s, r)), NULL, 0);
        if (GEOSisValid(ring) == 1) {
            toggle(&sum, ring);
            continue;
        }
        if (!overlaps) {
            GEOSGeometry *valid = GEOSMakeValid(ring);
            GEOSGeom_destroy(ring);
            toggle(&sum, valid);
            continue;
        }
        GEOSGeom_destroy(ring);
        for (size_t i = 1; i + 1 < n; i++)
            toggle_triangle(&sum, s->points + 2 * first, s->points + 2 * (first + i), s->points + 2 * (first + i + 1));
    }
    return sum;
}

/* *whole becomes 0 when GEOS gave up on a part. */
static GEOSGeometry *to_geos(const gno_shape *s, int overlaps, int *whole)
{
    GEOSGeometry **parts = malloc((s->polygon_count + 1) * sizeof *parts), *all, *result;
    for (size_t p = 0; p < s->polygon_count; p++)
        if (!(parts[p] = even_odd(s, p, overlaps)))
            parts[p] = GEOSGeom_createEmptyPolygon(), *whole = 0;
    all = GEOSGeom_createCollection(GEOS_GEOMETRYCOLLECTION, parts, (unsigned)s->polygon_count);
    result = GEOSUnaryUnion(all);
    GEOSGeom_destroy(all);
    free(parts);
    return result;
}

/* A result as it is, for GEOS to judge. */
static GEOSGeometry *as_is(const gno_shape *s)
{
    GEOSGeometry **polygons = malloc((s->polygon_count + 1) * sizeof *polygons), *all;
    for (size_t p = 0; p < s->polygon_count; p++) {
        size_t first = s->polygon_start[p], n = s->polygon_start[p + 1] - first;
        GEOSGeometry **holes = malloc((n + 1) * sizeof *holes), *shell = GEOSGeom_createLinearRing(sequence(s, first));
        for (size_t h = 1; h < n; h++)
            holes[h - 1] = GEOSGeom_createLinearRing(sequence(s, first + h));
        polygons[p] = GEOSGeom_createPolygon(shell, holes, (unsigned)(n - 1));
        free(holes);
    }
    all = GEOSGeom_createCollection(GEOS_MULTIPOLYGON, polygons, (unsigned)s->polygon_count);
    free(polygons);
    return all;
}

static double signed_area(const gno_shape *s, size_t ring)
{
    double sum = 0;
    for (size_t i = s->ring_start[ring]; i < s->ring_start[ring + 1]; i++) {
        size_t j = i + 1 < s->ring_start[ring + 1] ? i + 1 : s->ring_start[ring], o = s->ring_start[ring];
        const double *p = s->points;
        sum += (p[2 * i] - p[2 * o]) * (p[2 * j + 1] - p[2 * o + 1]) - (p[2 * j] - p[2 * o]) * (p[2 * i + 1] - p[2 * o + 1]);
    }
    return sum / 2;
}

static int turned_right(const gno_shape *s)
{
    for (size_t p = 0; p < s->polygon_count; p++)
        for (size_t r = s->polygon_start[p]; r < s->polygon_start[p + 1]; r++)
            if ((signed_area(s, r) < 0) != (r > s->polygon_start[p]) && fabs(signed_area(s, r)) > 1e-12)
                return 0;
    return 1;
}

static double extent_of(const shape_buffer *a, const shape_buffer *b)
{
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    for (int k = 0; k < 2; k++)
        for (size_t i = 0; i < 2 * (k ? b : a)->count; i++) {
            double v = (k ? b : a)->points[i];
            low[i % 2] = fmin(low[i % 2], v);
            high[i % 2] = fmax(high[i % 2], v);
        }
    return fmax(high[0] - low[0], high[1] - low[1]);
}

typedef struct tally {
    long cases, wrong, invalid, failed, turned, refused, geos_off;
    double worst;
} tally;

static void compare(gno_clipper *clipper, gno_context *context, int family, unsigned long seed, int op, const shape_buffer *a,
                    const shape_buffer *b, const GEOSGeometry *ga, const GEOSGeometry *gb, tally *t)
{
    gno_shape va = shape_view(a), vb = shape_view(b), result;
    GEOSGeometry *want, *ours;
    double area, extent = extent_of(a, b), error;
    t->cases++;
    if (gno_clip(clipper, (gno_clip_op)op, &va, &vb, &result) != GNO_OK) {
        printf("%s seed %lu op %d: %s\n", shapes_name[family], seed, op, gno_context_message(context));
        t->failed++;
        return;
    }
    want = op == 0 ? GEOSUnion(ga, gb) : op == 1 ? GEOSIntersection(ga, gb) : op == 2 ? GEOSDifference(ga, gb) : GEOSSymDifference(ga, gb);
    if (!want || GEOSArea(want, &area) != 1) {
        t->refused++;
        if (want)
            GEOSGeom_destroy(want);
        return;
    }
    GEOSGeom_destroy(want);
    error = fabs(area - gno_shape_area(&result)) / (extent * extent);
    if (!(error <= 1e-9)) { /* who is right? */
        double twin = fabs(slab_area((gno_clip_op)op, &va, &vb) - gno_shape_area(&result)) / (extent * extent);
        t->geos_off += twin <= 1e-9;
        error = twin;
    }
    if (error > t->worst)
        t->worst = error;
    if (!(error <= 1e-9)) {
        printf("%s seed %lu op %d: area %.17g, GEOS %.17g\n", shapes_name[family], seed, op, gno_shape_area(&result), area);
        t->wrong++;
    }
    ours = as_is(&result);
    if (GEOSisValid(ours) != 1) {
        char *why = GEOSisValidReason(ours);
        printf("%s seed %lu op %d: invalid: %s\n", shapes_name[family], seed, op, why);
        GEOSFree(why);
        t->invalid++;
    }
    GEOSGeom_destroy(ours);
    if (!turned_right(&result)) {
        printf("%s seed %lu op %d: a ring runs the wrong way\n", shapes_name[family], seed, op);
        t->turned++;
    }
}

int main(int argc, char **argv)
{
    long cases = argc > 1 ? atol(argv[1]) : 1000;
    unsigned long first = argc > 2 ? strtoul(argv[2], NULL, 10) : 1;
    int only = -1, size = argc > 4 ? atoi(argv[4]) : 1, bad = 0;
    shape_buffer a = {0}, b = {0};
    gno_context *context;
    gno_clipper *clipper;
    for (int f = 0; argc > 3 && f < SHAPES_FAMILIES; f++)
        if (strcmp(argv[3], shapes_name[f]) == 0)
            only = f;
    initGEOS(quiet, quiet);
    if (gno_context_create(NULL, &context) != GNO_OK || gno_clipper_create(context, &clipper) != GNO_OK)
        return 1;
    printf("%-10s %8s %8s %8s %8s %8s %8s   worst area error / extent^2\n", "family", "cases", "area", "invalid", "failed", "refused",
           "GEOS off");
    for (int f = 0; f < SHAPES_FAMILIES; f++) {
        tally t = {0};
        if (only >= 0 && f != only)
            continue;
        for (unsigned long seed = first; t.cases < cases; seed++) {
            gno_shape va, vb;
            GEOSGeometry *ga, *gb;
            int whole = 1, overlaps = f == SHAPES_LATTICE || f == SHAPES_ON_EDGE;
            shapes_make(f, seed, size, &a, &b);
            va = shape_view(&a);
            vb = shape_view(&b);
            ga = to_geos(&va, overlaps, &whole);
            gb = to_geos(&vb, overlaps, &whole);
            for (int op = 0; op < 4; op++)
                if (whole && ga && gb)
                    compare(clipper, context, f, seed, op, &a, &b, ga, gb, &t);
                else
                    t.refused++, t.cases++;
            if (ga)
                GEOSGeom_destroy(ga);
            if (gb)
                GEOSGeom_destroy(gb);
        }
        printf("%-10s %8ld %8ld %8ld %8ld %8ld %8ld   %.1e\n", shapes_name[f], t.cases, t.wrong, t.invalid + t.turned, t.failed,
               t.refused, t.geos_off, t.worst);
        bad |= t.wrong || t.invalid || t.turned || t.failed;
    }
    gno_clipper_destroy(clipper);
    gno_context_destroy(context);
    shape_free(&a);
    shape_free(&b);
    finishGEOS();
    return bad;
}
