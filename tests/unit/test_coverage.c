/* test_coverage.c -- exact area coverage of polygons over pixels: closed forms, sums of abutting polygons, random stars against
 * a twin that counts points.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scan/coverage.h"

#define LEN(a) (sizeof(a) / sizeof *(a))

static uint64_t random_state = 88172645463325252u;

static double random_in(double low, double high)
{
    random_state ^= random_state << 13;
    random_state ^= random_state >> 7;
    random_state ^= random_state << 17;
    return low + (high - low) * (double)(random_state >> 11) * 0x1p-53;
}

static void add_ring(gnoi_coverage *c, const double *xy, size_t count, double sign)
{
    for (size_t i = 0; i < count; i++) {
        size_t j = (i + 1) % count;
        gnoi_coverage_edge(c, xy[2 * i], xy[2 * i + 1], xy[2 * j], xy[2 * j + 1], sign);
    }
}

static gnoi_coverage *start(int x0, int y0)
{
    gnoi_coverage *c = malloc(sizeof *c);
    assert_non_null(c);
    memset(c, 0x5a, sizeof *c);
    gnoi_coverage_start(c, x0, y0, GNOI_TILE_W, GNOI_TILE_H);
    return c;
}

static double area_at(const gnoi_coverage *c, int x, int y)
{
    return y < c->first_row || y > c->last_row ? 0 : c->rows[y].area[x];
}

static void near(double value, double wanted, double tolerance)
{
    if (!(fabs(value - wanted) <= tolerance))
        fail_msg("%.17g is not %.17g", value, wanted);
}

static void test_nothing(void **state)
{
    gnoi_coverage *c = start(0, 0);
    (void)state;
    gnoi_coverage_finish(c);
    assert_true(c->first_row > c->last_row);
    free(c);
}

/* A rectangle of x in [3.25, 5.5], y in [2.5, 4.125], in a tile with its corner at (24, 32). */
static void test_rectangle(void **state)
{
    const double xy[] = {27.25, 34.5, 29.5, 34.5, 29.5, 36.125, 27.25, 36.125};
    const double across[] = {0, 0, 0, 0.75, 1, 0.5, 0}, down[] = {0, 0, 0.5, 1, 0.125, 0};
    gnoi_coverage *c = start(24, 32);
    (void)state;
    assert_true(gnoi_ring_area2(xy, 4) == 2 * 2.25 * 1.625);
    add_ring(c, xy, 4, 1);
    gnoi_coverage_finish(c);
    for (int y = 0; y < (int)LEN(down); y++)
        for (int x = 0; x < (int)LEN(across); x++)
            near(area_at(c, x, y), across[x] * down[y], 1e-15);
    near(c->rows[2].mx[3], 0.75 * 0.5 * 0.125, 1e-15);  /* its middle lies at 0.625 of the pixel */
    near(c->rows[2].my[3], 0.75 * 0.5 * 0.25, 1e-15);
    near(c->rows[3].mx[4], 0, 1e-15);
    near(c->rows[3].my[4], 0, 1e-15);
    near(c->rows[4].my[5], 0.5 * 0.125 * -0.4375, 1e-15);
    free(c);
}

/* The triangle (0,0) (2,0) (0,1): the line y = 1 - x/2 from the upper left. */
static void test_triangle(void **state)
{
    const double xy[] = {0, 0, 2, 0, 0, 1};
    gnoi_coverage *c = start(0, 0);
    (void)state;
    add_ring(c, xy, 3, 1);
    gnoi_coverage_finish(c);
    near(area_at(c, 0, 0), 0.75, 1e-15);
    near(area_at(c, 1, 0), 0.25, 1e-15);
    near(area_at(c, 2, 0), 0, 1e-15);
    near(c->rows[0].mx[0], 1.0 / 3 - 0.375, 1e-15);      /* integral of u (1 - u/2) is 1/3 */
    near(c->rows[0].my[0], 7.0 / 24 - 0.375, 1e-15);     /* integral of (1 - u/2)^2 / 2 is 7/24 */
    near(c->rows[0].mx[1], 1.0 / 12 - 0.125, 1e-15);     /* integral of u (1 - u) / 2 is 1/12 */
    free(c);
}

/* A polygon far larger than the tile, left, right, above and below it, with a hole of one pixel. */
static void test_surrounding(void **state)
{
    const double outer[] = {-1e6, -2e6, 3e6, -1e6, 2e6, 4e6, -2e6, 1e6}, hole[] = {5, 5, 5, 6, 6, 6, 6, 5};
    gnoi_coverage *c = start(0, 0);
    (void)state;
    add_ring(c, outer, 4, 1);
    add_ring(c, hole, 4, 1);
    gnoi_coverage_finish(c);
    for (int y = 0; y < GNOI_TILE_H; y++)
        for (int x = 0; x < GNOI_TILE_W; x++)
            near(area_at(c, x, y), x == 5 && y == 5 ? 0 : 1, 1e-14);
    free(c);
}

/* A fan of triangles around a point, its rim far outside the tile: every pixel's sum is 1, and the moments cancel. */
static void test_abutting(void **state)
{
    (void)state;
    for (int trial = 0; trial < 300; trial++) {
        double sum[GNOI_TILE_H][GNOI_TILE_W] = {{0}}, mx = 0, my = 0;
        double px = random_in(-5, 30), py = random_in(-5, 35), rim[2 * 40];
        const size_t n = 8 + (size_t)random_in(0, 32);
        for (size_t i = 0; i < n; i++) {
            double a = 6.283185307179586 * ((double)i + random_in(0, 0.9)) / (double)n;
            rim[2 * i] = px + 1e3 * cos(a);
            rim[2 * i + 1] = py + 1e3 * sin(a);
        }
        for (size_t i = 0; i < n; i++) {
            size_t j = (i + 1) % n;
            const double xy[] = {px, py, rim[2 * i], rim[2 * i + 1], rim[2 * j], rim[2 * j + 1]};
            gnoi_coverage *c = start(0, 0);
            add_ring(c, xy, 3, 1);
            gnoi_coverage_finish(c);
            for (int y = c->first_row; y <= c->last_row; y++)
                for (int x = 0; x < GNOI_TILE_W; x++) {
                    sum[y][x] += c->rows[y].area[x];
                    mx += c->rows[y].mx[x];
                    my += c->rows[y].my[x];
                    assert_true(c->rows[y].area[x] > -1e-13 && c->rows[y].area[x] < 1 + 1e-13);
                }
            free(c);
        }
        for (int y = 0; y < GNOI_TILE_H; y++)
            for (int x = 0; x < GNOI_TILE_W; x++)
                near(sum[y][x], 1, 1e-12);
        near(mx, 0, 1e-10);
        near(my, 0, 1e-10);
    }
}

/* Even-odd rule at one point. */
static int inside(const double *xy, size_t count, double x, double y)
{
    int in = 0;
    for (size_t i = 0, j = count - 1; i < count; j = i++) {
        const double *a = &xy[2 * i], *b = &xy[2 * j];
        if ((a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) * (b[0] - a[0]) / (b[1] - a[1]))
            in = !in;
    }
    return in;
}

/* Random stars with a hole: area and moments of some pixels against 200 x 200 points each. */
static void test_random(void **state)
{
    enum { GRID = 200 };
    (void)state;
    for (int trial = 0; trial < 20; trial++) {
        double star[2 * 24], hole[2 * 24], cx = random_in(2, 22), cy = random_in(2, 30);
        const size_t n = 3 + (size_t)random_in(0, 21);
        gnoi_coverage *c = start(0, 0);
        for (size_t i = 0; i < n; i++) {
            double a = 6.283185307179586 * (double)i / (double)n, r = random_in(0.5, 20);
            star[2 * i] = cx + r * cos(a);
            star[2 * i + 1] = cy + r * sin(a);
            hole[2 * i] = cx + 0.5 * r * cos(a);
            hole[2 * i + 1] = cy + 0.5 * r * sin(a);
        }
        add_ring(c, star, n, 1);
        add_ring(c, hole, n, -1);
        gnoi_coverage_finish(c);
        for (int k = 0; k < 6; k++) {
            int px = (int)random_in(0, GNOI_TILE_W), py = (int)random_in(0, GNOI_TILE_H), row = py >= c->first_row && py <= c->last_row;
            double area = 0, mx = 0, my = 0;
            for (int i = 0; i < GRID * GRID; i++) {
                double u = (i % GRID + 0.5) / GRID, v = ((double)(i / GRID) + 0.5) / GRID;
                if (!inside(star, n, px + u, py + v) || inside(hole, n, px + u, py + v))
                    continue;
                area += 1;
                mx += u - 0.5;
                my += v - 0.5;
            }
            near(area_at(c, px, py), area / GRID / GRID, 2e-3);
            near(row ? c->rows[py].mx[px] : 0, mx / GRID / GRID, 1e-3);
            near(row ? c->rows[py].my[px] : 0, my / GRID / GRID, 1e-3);
        }
        free(c);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_nothing),   cmocka_unit_test(test_rectangle), cmocka_unit_test(test_triangle),
        cmocka_unit_test(test_surrounding), cmocka_unit_test(test_abutting), cmocka_unit_test(test_random),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
