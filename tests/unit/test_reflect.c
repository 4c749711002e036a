/* test_reflect.c -- mirror directions four ways, refraction, bumped normals. Place: tests of src/shade. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <gnomon/gnomon_math.h>

#include <math.h>
#include <string.h>

typedef void (*reflect_fn)(const double incoming[3], const double normal[3], double reflected[3]);

static const reflect_fn ways[4] = {gno_reflect_light_axis, gno_reflect_normal_axis, gno_reflect_linear_system, gno_reflect};

static void assert_near(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance))
        fail_msg("%.17g is not within %g of %.17g", a, tolerance, b);
}

static void assert_vector(const double a[3], double x, double y, double z, double tolerance)
{
    assert_near(a[0], x, tolerance);
    assert_near(a[1], y, tolerance);
    assert_near(a[2], z, tolerance);
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static double next(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) / 16777216.0;
}

static void random_unit(uint32_t *state, double v[3])
{
    double length;
    do {
        for (int k = 0; k < 3; k++)
            v[k] = 2 * next(state) - 1;
        length = sqrt(dot(v, v));
    } while (length > 1 || length < 0.1);
    for (int k = 0; k < 3; k++)
        v[k] /= length;
}

/* ---- reflection ------------------------------------------------------------------------------------------------------ */

static void test_reflect_by_hand(void **state)
{
    static const struct { double l[3], n[3], r[3]; } cases[] = {
        {{0, 0, -1}, {0, 0, 1}, {0, 0, 1}},           /* straight down on a floor: straight back */
        {{0.6, 0, -0.8}, {0, 0, 1}, {0.6, 0, 0.8}},   /* 3-4-5 */
        {{0.6, 0, -0.8}, {0, 0, -1}, {0.6, 0, 0.8}},  /* the normal's side does not matter */
        {{1, 0, 0}, {-0.70710678118654752, 0.70710678118654752, 0}, {0, 1, 0}}, /* a mirror at 45 degrees */
        {{0, 1, 0}, {0, 0, 1}, {0, 1, 0}},            /* grazing: goes on */
        /* light along z, normal (2,3,6)/7: 8.1.15, 8.1.16 give 2 n_x n_z = 24/49, 36/49, 2 (6/7)^2 - 1 = 23/49 */
        {{0, 0, -1}, {2.0 / 7, 3.0 / 7, 6.0 / 7}, {24.0 / 49, 36.0 / 49, 23.0 / 49}},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        for (int w = 0; w < 4; w++) {
            double r[3];
            ways[w](cases[i].l, cases[i].n, r);
            assert_vector(r, cases[i].r[0], cases[i].r[1], cases[i].r[2], 1e-15);
        }
    }
}

static void test_four_ways_agree(void **state)
{
    uint32_t s = 1;
    (void)state;
    for (int i = 0; i < 100000; i++) {
        double l[3], n[3], r[4][3], ln[3], nr[3], to_light[3];
        random_unit(&s, l);
        random_unit(&s, n);
        for (int w = 0; w < 4; w++)
            ways[w](l, n, r[w]);
        for (int w = 0; w < 3; w++)
            assert_vector(r[w], r[3][0], r[3][1], r[3][2], 1e-13);
        /* The law itself: unit, equal angles, one plane. */
        for (int k = 0; k < 3; k++)
            to_light[k] = -l[k];
        assert_near(dot(r[3], r[3]), 1, 1e-14);
        assert_near(dot(to_light, n), dot(n, r[3]), 1e-14);
        cross(to_light, n, ln);
        cross(n, r[3], nr);
        assert_vector(ln, nr[0], nr[1], nr[2], 1e-14);
    }
}

static void test_result_may_be_an_argument(void **state)
{
    (void)state;
    for (int w = 0; w < 4; w++) {
        double l[3] = {0.6, 0, -0.8}, n[3] = {0, 0, 1};
        ways[w](l, n, l);
        assert_vector(l, 0.6, 0, 0.8, 1e-15);
    }
}

/* ---- refraction ------------------------------------------------------------------------------------------------------ */

static void test_refract_by_hand(void **state)
{
    double down[3] = {0, 0, -1}, n[3] = {0, 0, 1}, slanted[3] = {0.6, 0, -0.8}, other[3] = {0, 0, -1}, t[3];
    (void)state;
    assert_int_equal(gno_refract(down, n, 1 / 1.5, t), 1); /* head on: straight through */
    assert_vector(t, 0, 0, -1, 1e-15);
    assert_int_equal(gno_refract(slanted, n, 1, t), 1); /* no boundary */
    assert_vector(t, 0.6, 0, -0.8, 1e-15);
    assert_int_equal(gno_refract(slanted, n, 0.8, t), 1); /* sine 0.6 becomes 0.48 */
    assert_vector(t, 0.48, 0, -sqrt(1 - 0.48 * 0.48), 1e-15);
    assert_int_equal(gno_refract(slanted, other, 0.8, t), 1); /* the normal's side does not matter */
    assert_vector(t, 0.48, 0, -sqrt(1 - 0.48 * 0.48), 1e-15);
    assert_int_equal(gno_refract(slanted, n, 1.6, t), 1); /* sine 0.96, cosine 0.28 */
    assert_vector(t, 0.96, 0, -0.28, 1e-12);
    assert_int_equal(gno_refract(slanted, n, 1.7, t), 0); /* sine 1.02: total reflection */
    assert_vector(t, 0, 0, 0, 0);
}

static void test_refract_obeys_snell(void **state)
{
    uint32_t s = 3;
    int total = 0;
    (void)state;
    for (int i = 0; i < 100000; i++) {
        double l[3], n[3], t[3], back[3], ln[3], tn[3], eta = 0.4 + 2 * next(&s), sine;
        random_unit(&s, l);
        random_unit(&s, n);
        cross(l, n, ln);
        sine = sqrt(dot(ln, ln));
        if (fabs(eta * sine - 1) < 1e-6)
            continue;
        if (!gno_refract(l, n, eta, t)) {
            assert_true(eta * sine > 1);
            total++;
            continue;
        }
        assert_true(eta * sine < 1);
        assert_near(dot(t, t), 1, 1e-12);
        cross(t, n, tn);
        assert_vector(tn, eta * ln[0], eta * ln[1], eta * ln[2], 1e-12); /* one plane, sines as the indices */
        assert_true(dot(t, n) * dot(l, n) >= 0);                         /* goes on to the other side */
        for (int k = 0; k < 3; k++)
            t[k] = -t[k];
        assert_int_equal(gno_refract(t, n, 1 / eta, back), 1); /* the way back */
        assert_vector(back, -l[0], -l[1], -l[2], 1e-6);
    }
    assert_true(total > 1000);
}

static void test_similarity(void **state)
{
    (void)state;
    assert_near(gno_similarity_dimension(2, 2), 1, 1e-15);               /* a segment, doubled */
    assert_near(gno_similarity_dimension(4, 2), 2, 1e-15);               /* a square */
    assert_near(gno_similarity_dimension(4, 3), 1.2618595071429148, 1e-15); /* four pieces for every three: the chapter's 1.26 */
}

/* ---- bumps ----------------------------------------------------------------------------------------------------------- */

static void test_bump_by_hand(void **state)
{
    double qx[3] = {1, 0, 0}, qy[3] = {0, 1, 0}, n[3];
    (void)state;
    gno_bump_normal(qx, qy, 0, 0, n);
    assert_vector(n, 0, 0, 1, 0);
    gno_bump_normal(qx, qy, 0.5, 0, n); /* rises along x: the normal leans back */
    assert_vector(n, -0.5, 0, 1, 0);
    gno_bump_normal(qx, qy, 0, -0.25, n);
    assert_vector(n, 0, 0.25, 1, 0);
    qx[0] = 2; /* Q_x = 2: N = (0,0,2); a height of slope P_x = 1 for each X rises 1 in 2 */
    gno_bump_normal(qx, qy, 1, 0, n);
    assert_vector(n, -1, 0, 2, 0);
    qx[0] = 0;
    gno_bump_normal(qx, qy, 1, 1, n); /* no surface */
    assert_vector(n, 0, 0, 0, 0);
}

/* The formula is the normal of the raised surface but for terms with P itself: on a plane, where N does not turn, exactly. */
static void test_bump_is_the_raised_plane(void **state)
{
    uint32_t s = 5;
    (void)state;
    for (int i = 0; i < 1000; i++) {
        double qx[3], qy[3], n[3], unit[3], ax[3], ay[3], raised[3], px = 2 * next(&s) - 1, py = 2 * next(&s) - 1, length;
        random_unit(&s, qx);
        random_unit(&s, qy);
        cross(qx, qy, unit);
        length = sqrt(dot(unit, unit));
        for (int k = 0; k < 3; k++) {
            unit[k] /= length;
            ax[k] = qx[k] + px * unit[k];
            ay[k] = qy[k] + py * unit[k];
        }
        cross(ax, ay, raised);
        gno_bump_normal(qx, qy, px, py, n);
        assert_vector(n, raised[0], raised[1], raised[2], 1e-12);
    }
}

/* An object twice as large, its bumps with it, has the same normals. */
static void test_bump_follows_the_object(void **state)
{
    uint32_t s = 7;
    (void)state;
    for (int i = 0; i < 1000; i++) {
        double qx[3], qy[3], a[3], b[3], scale = 0.01 + 100 * next(&s), px = next(&s), py = next(&s);
        random_unit(&s, qx);
        random_unit(&s, qy);
        gno_bump_normal(qx, qy, px, py, a);
        for (int k = 0; k < 3; k++) {
            qx[k] *= scale;
            qy[k] *= scale;
        }
        gno_bump_normal(qx, qy, scale * px, scale * py, b);
        assert_vector(b, scale * scale * a[0], scale * scale * a[1], scale * scale * a[2], 1e-12 * scale * scale);
    }
}

/* Bumps from noise whose gradient is known: N' = N - amount (grad f - (grad f.N) N). */
static void test_bump_procedural(void **state)
{
    gno_procedural noise = gno_procedural_default(GNO_PATTERN_NOISE);
    uint32_t s = 9;
    (void)state;
    for (int i = 0; i < 500; i++) {
        gno_footprint f;
        double n[3], g[3], b[3], expected[3], length;
        memset(&f, 0, sizeof f);
        random_unit(&s, n);
        for (int k = 0; k < 3; k++)
            f.point[k] = 10 * next(&s);
        gno_fractal_noise(&noise.fractal, f.point, 0, g);
        for (int k = 0; k < 3; k++)
            expected[k] = n[k] - 0.3 * (g[k] - dot(g, n) * n[k]);
        length = sqrt(dot(expected, expected));
        gno_bump_procedural(&noise, 0.3, &f, n, b);
        assert_vector(b, expected[0] / length, expected[1] / length, expected[2] / length, 1e-4);
    }
}

/* Point, pixel and pattern seven times as large: the same normal. */
static void test_bump_of_any_size(void **state)
{
    (void)state;
    for (int pattern = GNO_PATTERN_WOOD; pattern <= GNO_PATTERN_CLOUD; pattern++) {
        uint32_t s = 11;
        for (int i = 0; i < 50; i++) {
            gno_procedural small = gno_procedural_default((gno_pattern)pattern), large = small;
            gno_footprint f;
            double n[3], a[3], b[3];
            memset(&f, 0, sizeof f);
            random_unit(&s, n);
            for (int k = 0; k < 3; k++) {
                f.point[k] = 10 * next(&s);
                f.dx[k] = 0.02 * next(&s);
                f.dy[k] = 0.02 * next(&s);
                large.scale[k] = 7;
            }
            gno_bump_procedural(&small, 0.1, &f, n, a);
            for (int k = 0; k < 3; k++) {
                f.point[k] *= 7;
                f.dx[k] *= 7;
                f.dy[k] *= 7;
            }
            gno_bump_procedural(&large, 0.1, &f, n, b);
            assert_vector(b, a[0], a[1], a[2], 1e-6);
        }
    }
}

static void test_height_table(void **state)
{
    static const float values[6] = {0, 1, 2, 3, 4, 5}; /* 3 wide, 2 high */
    gno_height_table table = {3, 2, values, 1};
    double du, dv;
    (void)state;
    assert_near(gno_height_at(&table, 0.5 / 3, 0.25, NULL, NULL), 0, 1e-15);
    assert_near(gno_height_at(&table, 2.5 / 3, 0.75, NULL, NULL), 5, 1e-15);
    assert_near(gno_height_at(&table, 0.5, 0.5, &du, &dv), 2.5, 1e-15);
    assert_near(du, 3, 1e-12); /* one value a third of the table */
    assert_near(dv, 6, 1e-12);
    assert_near(gno_height_at(&table, -7, 0.25, &du, NULL), 0, 0); /* the border goes on */
    assert_near(du, 0, 0);
    table.clamp = 0;
    assert_near(gno_height_at(&table, 1.5 / 3 + 4, 0.25 - 3, NULL, NULL), 1, 1e-12); /* repeats */
    assert_near(gno_height_at(&table, 0, 0.25, NULL, NULL), 1, 1e-12); /* between the last and the first */
    assert_true(isfinite(gno_height_at(&table, INFINITY, NAN, &du, &dv)));
    table.clamp = 1;
    assert_true(isfinite(gno_height_at(&table, 1e300, -1e300, &du, &dv)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_reflect_by_hand),
        cmocka_unit_test(test_four_ways_agree),
        cmocka_unit_test(test_result_may_be_an_argument),
        cmocka_unit_test(test_refract_by_hand),
        cmocka_unit_test(test_refract_obeys_snell),
        cmocka_unit_test(test_similarity),
        cmocka_unit_test(test_bump_by_hand),
        cmocka_unit_test(test_bump_is_the_raised_plane),
        cmocka_unit_test(test_bump_follows_the_object),
        cmocka_unit_test(test_bump_procedural),
        cmocka_unit_test(test_bump_of_any_size),
        cmocka_unit_test(test_height_table),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
