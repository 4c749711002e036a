/* clip_speed.c -- times of the clipper beside Clipper and GEOS: a ground under box shadows, their union, tiny calls.
 * Built by clip.sh. usage: clip_speed [RUNS]          Every time is the least of RUNS alternating runs, of the operation alone.
 * Exit status 1 when a bound is missed: at most Clipper's time, at most a third of GEOS's.
 */
#include "bench/clip_peer.h"
#include "support/shapes.h"

#include <geos_c.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void quiet(const char *format, ...)
{
    (void)format;
}

static GEOSGeometry *polygon(const double *p, size_t n)
{
    GEOSCoordSequence *q = GEOSCoordSeq_create((unsigned)n + 1, 2);
    for (size_t i = 0; i <= n; i++)
        GEOSCoordSeq_setXY(q, (unsigned)i, p[2 * (i % n)], p[2 * (i % n) + 1]);
    return GEOSGeom_createPolygon(GEOSGeom_createLinearRing(q), NULL, 0);
}

static GEOSGeometry *to_geos(const gno_shape *s)
{
    GEOSGeometry **parts = malloc(s->polygon_count * sizeof *parts), *all;
    for (size_t p = 0; p < s->polygon_count; p++)
        parts[p] = polygon(s->points + 2 * s->ring_start[p], s->ring_start[p + 1] - s->ring_start[p]);
    all = GEOSGeom_createCollection(GEOS_MULTIPOLYGON, parts, (unsigned)s->polygon_count);
    free(parts);
    return all;
}

static double geos_clip(gno_clip_op op, const gno_shape *subject, const gno_shape *clip, double *seconds)
{
    GEOSGeometry *a = to_geos(subject), *b = clip ? to_geos(clip) : NULL, *joined, *result;
    double start = now(), area = 0;
    joined = GEOSUnaryUnion(b ? b : a);
    result = op == GNO_CLIP_DIFFERENCE ? GEOSDifference(a, joined) : joined;
    *seconds += now() - start;
    GEOSArea(result, &area);
    if (result != joined)
        GEOSGeom_destroy(result);
    GEOSGeom_destroy(joined);
    GEOSGeom_destroy(a);
    if (b)
        GEOSGeom_destroy(b);
    return area;
}

static double ours(gno_clipper *clipper, gno_clip_op op, const gno_shape *subject, const gno_shape *clip, double *seconds)
{
    gno_shape result;
    double start = now();
    if (gno_clip(clipper, op, subject, clip, &result) != GNO_OK)
        exit(1);
    *seconds += now() - start;
    return gno_shape_area(&result);
}

static void least(double *best, double seconds)
{
    *best = seconds < *best ? seconds : *best;
}

static int measure(gno_clipper *clipper, size_t count, gno_clip_op op, int runs)
{
    shape_buffer shadows = {0}, ground = {0};
    double side = shapes_shadows(count, 1, &shadows), best[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, area[3] = {0, 0, 0};
    gno_shape s = shape_view(&shadows), g;
    int missed;
    shape_clear(&ground);
    shape_begin_polygon(&ground);
    shape_begin_ring(&ground);
    for (int k = 0; k < 4; k++) {
        double x = k == 1 || k == 2 ? side : 0, y = k > 1 ? side : 0;
        shape_point(&ground, x - 0.1 * y, y + 0.1 * x);
    }
    g = shape_view(&ground);
    for (int i = 0; i < runs; i++) {
        double t[3] = {0, 0, 0};
        int difference = op == GNO_CLIP_DIFFERENCE;
        area[0] = ours(clipper, op, difference ? &g : &s, difference ? &s : NULL, &t[0]);
        area[1] = peer_clip(op, difference ? &g : &s, difference ? &s : NULL, 5e8 / (1.2 * side + 40), &t[1]);
        area[2] = geos_clip(op, difference ? &g : &s, difference ? &s : NULL, &t[2]);
        for (int k = 0; k < 3; k++)
            least(&best[k], t[k]);
    }
    missed = best[0] > best[1] || 3 * best[0] > best[2] || fabs(area[0] - area[2]) > 1e-9 * side * side;
    printf("%-10s %7zu %10.3f ms %10.3f ms %10.3f ms   %5.1f %5.1f   %.1e%s\n", op == GNO_CLIP_UNION ? "union" : "difference", count,
           1e3 * best[0], 1e3 * best[1], 1e3 * best[2], best[1] / best[0], best[2] / best[0], fabs(area[0] - area[2]) / (side * side),
           missed ? "  MISSED" : "");
    shape_free(&shadows);
    shape_free(&ground);
    return missed;
}

/* Small calls: pairs of quads, and a quad less three others. */
static void measure_small(gno_clipper *clipper, int casters, int runs)
{
    enum { CASES = 1000 };
    static shape_buffer a[CASES], b[CASES];
    shape_random r = {12345};
    double best = HUGE_VAL, peer = HUGE_VAL, sum = 0;
    for (int i = 0; i < CASES; i++) {
        shape_clear(&a[i]);
        shape_clear(&b[i]);
        for (int k = 0; k <= casters; k++) {
            double cx = shape_uniform(&r, -1, 1), cy = shape_uniform(&r, -1, 1), turn = shape_uniform(&r, 0, 2);
            shape_begin_polygon(k ? &b[i] : &a[i]);
            shape_begin_ring(k ? &b[i] : &a[i]);
            for (int c = 0; c < 4; c++)
                shape_point(k ? &b[i] : &a[i], cx + cos(turn + c * 1.5707963), cy + sin(turn + c * 1.5707963));
        }
    }
    for (int run = 0; run < runs; run++) {
        double t = 0, p = 0;
        for (int i = 0; i < CASES; i++) {
            gno_shape s = shape_view(&a[i]), c = shape_view(&b[i]), result;
            double start = now();
            if (gno_clip(clipper, GNO_CLIP_DIFFERENCE, &s, &c, &result) != GNO_OK)
                exit(1);
            t += now() - start;
            sum += gno_shape_area(&result) - peer_clip(GNO_CLIP_DIFFERENCE, &s, &c, 1e8, &p);
        }
        least(&best, t / CASES);
        least(&peer, p / CASES);
    }
    printf("one quad less %d: %.2f us, %s %.2f us (areas differ by %.1e)\n", casters, 1e6 * best, peer_name, 1e6 * peer, fabs(sum) / runs);
    for (int i = 0; i < CASES; i++) {
        shape_free(&a[i]);
        shape_free(&b[i]);
        a[i] = b[i] = (shape_buffer){0};
    }
}

int main(int argc, char **argv)
{
    int runs = argc > 1 ? atoi(argv[1]) : 5, missed = 0;
    gno_context *context;
    gno_clipper *clipper;
    initGEOS(quiet, quiet);
    if (gno_context_create(NULL, &context) != GNO_OK || gno_clipper_create(context, &clipper) != GNO_OK)
        return 1;
    printf("%-10s %7s %13s %13s %13s   %11s   area error\n", "", "shadows", "gnomon", peer_name, "GEOS", "times faster");
    for (size_t count = 1000; count <= 10000; count *= 10) {
        missed |= measure(clipper, count, GNO_CLIP_DIFFERENCE, runs);
        missed |= measure(clipper, count, GNO_CLIP_UNION, runs);
    }
    for (int casters = 1; casters <= 3; casters += 2)
        measure_small(clipper, casters, runs);
    gno_clipper_destroy(clipper);
    gno_context_destroy(context);
    finishGEOS();
    return missed;
}
