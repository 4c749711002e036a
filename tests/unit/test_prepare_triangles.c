/* test_prepare_triangles.c -- triangulation of prepared polygons.
 *
 * Triangulations are judged by area: in the plane, triangles of the polygon's own turn whose areas add up to the polygon's
 * and of which none is turned the other way cover it once.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#include "prepare_test.h"

static double ring_area(const double *p, unsigned count)
{
    double area = 0;
    unsigned i;
    for (i = 0; i < count; i++) {
        const double *q = p + 3 * ((i + 1) % count);
        area += p[3 * i] * q[1] - p[3 * i + 1] * q[0];
    }
    return area / 2;
}

/* Triangulates rings in the plane z = 0; returns the sum of areas, and of the areas of triangles turned the wrong way. */
static double triangulated_area(gno_context *context, const double *positions, const unsigned *sizes, double *wrong)
{
    static uint32_t corner_vertex[MOST], rings[MOST], triangles[2 * MOST][3];
    const double normal[3] = {0, 0, 1};
    uint32_t count = 0, i, ring_count, expected;
    double area = 0;
    for (ring_count = 0; sizes[ring_count] > 0; ring_count++) {
        rings[ring_count] = count;
        count += sizes[ring_count];
    }
    rings[ring_count] = count;
    for (i = 0; i < count; i++) {
        corner_vertex[i] = i;
    }
    expected = count + 2 * (ring_count - 1) - 2;
    memset(triangles, 0xff, sizeof triangles);
    assert_int_equal(gnoi_triangulate(context, (const double(*)[3])positions, corner_vertex, rings, ring_count, normal, triangles),
                     GNO_OK);
    assert_int_equal(triangles[expected][0], GNOI_NONE); /* no more than promised */
    *wrong = 0;
    for (i = 0; i < expected; i++) {
        double corners[9], a;
        int k;
        for (k = 0; k < 3; k++) {
            assert_true(triangles[i][k] < count);
            memcpy(corners + 3 * k, positions + 3 * triangles[i][k], 3 * sizeof *corners);
        }
        a = ring_area(corners, 3);
        area += a;
        *wrong += a < 0 ? -a : 0;
    }
    return area;
}

static void check_simple(gno_context *context, const double *positions, const unsigned *sizes)
{
    double area = 0, wrong, found;
    unsigned i, from = 0;
    for (i = 0; sizes[i] > 0; i++) {
        double a = fabs(ring_area(positions + 3 * from, sizes[i]));
        area += i == 0 ? a : -a;
        from += sizes[i];
    }
    found = triangulated_area(context, positions, sizes, &wrong);
    assert_near(found, area, 1e-9 * (1 + area));
    assert_near(wrong, 0, 1e-9 * (1 + area));
}

static void test_stars_with_holes(void **state)
{
    static double positions[3 * MOST];
    uint64_t seed = 12345;
    bed *b = *state;
    int round;
    for (round = 0; round < 2000; round++) {
        unsigned sizes[18], holes = (unsigned)(random_bits(&seed) % 17), i, at;
        at = sizes[0] = 5 + (unsigned)(random_bits(&seed) % 60);
        star(positions, at, 0, 0, 10, 20, 1, &seed); /* with five corners the edges stay beyond 10 cos 65 > 4 */
        for (i = 1; i <= holes; i++) {               /* on a grid of 4 x 4 cells within 2.8 of the middle */
            double x = -1.5 + (i - 1) % 4, y = -1.5 + (i - 1) / 4;
            sizes[i] = 3 + (unsigned)(random_bits(&seed) % 12);
            star(positions + 3 * at, sizes[i], x, y, 0.05, 0.45, random_bits(&seed) % 2 ? 1 : -1, &seed);
            at += sizes[i];
        }
        sizes[i] = 0;
        check_simple(b->context, positions, sizes);
    }
}

static void test_grid_shapes(void **state)
{
    /* Straight corners, holes in one row of equal heights, holes that touch each other and the outer ring. */
    static const double straight[24] = {0, 0, 0, 1, 0, 0, 2, 0, 0, 2, 1, 0, 2, 2, 0, 1, 2, 0, 0, 2, 0, 0, 1, 0};
    static const double row[48] = {0, 0, 0, 9, 0, 0, 9, 3, 0, 0, 3, 0, 1, 1, 0, 2, 1, 0, 2, 2, 0, 1, 2, 0,
                                   3, 1, 0, 4, 1, 0, 4, 2, 0, 3, 2, 0, 5, 1, 0, 6, 1, 0, 6, 2, 0, 5, 2, 0};
    static const double touching[36] = {0, 0, 0, 9, 0, 0, 9, 9, 0, 0, 9, 0, 1, 1, 0, 2, 1, 0,
                                        2, 2, 0, 1, 2, 0, 2, 2, 0, 3, 2, 0, 3, 3, 0, 2, 3, 0};
    static const double at_corner[21] = {0, 0, 0, 9, 0, 0, 9, 9, 0, 0, 9, 0, 0, 0, 0, 2, 1, 0, 1, 2, 0};
    static const double on_edge[21] = {0, 0, 0, 9, 0, 0, 9, 9, 0, 0, 9, 0, 0, 4, 0, 2, 3, 0, 2, 5, 0};
    static const unsigned eight[2] = {8, 0}, rows[5] = {4, 4, 4, 4, 0}, two[4] = {4, 4, 4, 0}, corner[3] = {4, 3, 0};
    bed *b = *state;
    check_simple(b->context, straight, eight);
    check_simple(b->context, row, rows);
    check_simple(b->context, touching, two);
    check_simple(b->context, at_corner, corner);
    check_simple(b->context, on_edge, corner);
}

/* A comb of many teeth and a spiral: long chains of reflex corners. */
static void test_comb_and_spiral(void **state)
{
    static double positions[3 * MOST];
    unsigned sizes[2] = {2002, 0}, i;
    bed *b = *state;
    for (i = 0; i < 2000; i++) {
        positions[3 * i] = 2000 - (double)i;
        positions[3 * i + 1] = i % 2 ? 10 : 1;
        positions[3 * i + 2] = 0;
    }
    memcpy(positions + 6000, (const double[6]){1, 0, 0, 2000, 0, 0}, 6 * sizeof *positions);
    check_simple(b->context, positions, sizes);
    sizes[0] = 3000;
    for (i = 0; i < 3000; i++) {
        unsigned k = i < 1500 ? i : 2999 - i;
        double angle = 0.05 * k, radius = (i < 1500 ? 2.0 : 1.0) + angle;
        positions[3 * i] = radius * cos(angle);
        positions[3 * i + 1] = radius * sin(angle);
    }
    check_simple(b->context, positions, sizes);
}

/* Rings that cross themselves, double back and repeat: no promise but the count, the range, and an end in good time. */
static void test_broken_rings(void **state)
{
    static double positions[3 * MOST];
    uint64_t seed = 99;
    bed *b = *state;
    double wrong;
    int round;
    for (round = 0; round < 500; round++) {
        unsigned sizes[5], rings = 1 + (unsigned)(random_bits(&seed) % 4), i, count = 0;
        for (i = 0; i < rings; i++) {
            sizes[i] = 3 + (unsigned)(random_bits(&seed) % 40);
            count += sizes[i];
        }
        sizes[rings] = 0;
        for (i = 0; i < 3 * count; i++) { /* few places, so that corners coincide */
            positions[i] = i % 3 == 2 ? 0 : (double)(random_bits(&seed) % 6);
        }
        triangulated_area(b->context, positions, sizes, &wrong);
    }
    for (round = 0; round < 2; round++) {
        unsigned sizes[2] = {10000, 0}, i;
        for (i = 0; i < 30000; i++) {
            positions[i] = i % 3 == 2 ? 0 : round == 0 ? random_unit(&seed) : (double)(random_bits(&seed) % 4);
        }
        triangulated_area(b->context, positions, sizes, &wrong);
    }
}

/* The same square seen along each axis from both sides: triangles turn as the polygon does. */
static void test_axes(void **state)
{
    static const double plane[10] = {0, 0, 3, 0, 3, 3, 1, 2, 0, 3}; /* five corners, one reflex */
    bed *b = *state;
    int axis, side, i;
    for (axis = 0; axis < 3; axis++) {
        for (side = 0; side < 2; side++) {
            double positions[15] = {0}, area = 0;
            uint32_t vertex[5] = {0, 1, 2, 3, 4}, rings[2] = {0, 5}, t[3][3];
            double normal[3] = {0, 0, 0};
            vec3 n;
            normal[axis] = side ? -1 : 1;
            n = v3_from(normal);
            for (i = 0; i < 5; i++) {
                int from = side ? 4 - i : i;
                positions[3 * i + (axis + 1) % 3] = plane[2 * from];
                positions[3 * i + (axis + 2) % 3] = plane[2 * from + 1];
            }
            assert_int_equal(gnoi_triangulate(b->context, (const double(*)[3])positions, vertex, rings, 1, normal, t), GNO_OK);
            for (i = 0; i < 3; i++) {
                vec3 p = v3_from(positions + 3 * t[i][0]), q = v3_from(positions + 3 * t[i][1]);
                vec3 r = v3_from(positions + 3 * t[i][2]);
                double a = v3_dot(n, v3_cross(v3_sub(q, p), v3_sub(r, p))) / 2;
                assert_true(a > 0);
                area += a;
            }
            assert_near(area, 7.5, 1e-12);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_stars_with_holes, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_grid_shapes, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_comb_and_spiral, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_broken_rings, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_axes, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
