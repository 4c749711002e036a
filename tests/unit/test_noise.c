/* test_noise.c -- lattice noise: range, continuity, mean and distribution; fractal sums and their fading. Place: tests of src/shade. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "shade/noise.h"

#include <math.h>

/* A sequence of numbers in [0,1) that has nothing to do with the hash under test. */
static double next(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) / 16777216.0;
}

static void random_point(uint32_t *state, double size, double p[3])
{
    for (int k = 0; k < 3; k++)
        p[k] = size * (next(state) - 0.5);
}

static double noise3(double x, double y, double z, unsigned seed, gno_noise_weight weight)
{
    double p[3] = {x, y, z};
    return gno_noise(p, seed, weight);
}

static void assert_near(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance))
        fail_msg("%.17g is not within %g of %.17g", a, tolerance, b);
}

/* ---- one noise ------------------------------------------------------------------------------------------------------- */

static void test_range(void **state)
{
    uint32_t r = 1;
    (void)state;
    for (int i = 0; i < 300000; i++) {
        double p[3], size = i % 3 == 0 ? 4 : i % 3 == 1 ? 1e6 : 1e15, v, s;
        random_point(&r, size, p);
        v = gno_noise(p, (unsigned)i, (gno_noise_weight)(i & 1));
        s = gno_fractal_noise(&(gno_fractal){1 + i % 9, 0.6, 2, (unsigned)i, (gno_noise_weight)(i & 1)}, p, 0, NULL);
        assert_true(v >= 0 && v <= 1);
        assert_true(s >= 0 && s <= 1);
    }
}

static void test_strange_coordinates(void **state)
{
    static const double strange[] = {NAN, INFINITY, -INFINITY, 1e300, -1e15, 0x1p52 + 0.5};
    (void)state;
    for (size_t i = 0; i < sizeof strange / sizeof *strange; i++) {
        double v = noise3(strange[i], 0.5, strange[i], 3, GNO_NOISE_SMOOTH);
        assert_true(v >= 0 && v <= 1);
    }
    assert_true(noise3(NAN, 0.25, 0.5, 3, GNO_NOISE_SMOOTH) == noise3(0, 0.25, 0.5, 3, GNO_NOISE_SMOOTH));
}

/* Bits that must come out on every machine: values worked from the hash by an independent program (Python, exact integers). */
static void test_known_values(void **state)
{
    (void)state;
    assert_true(noise3(0, 0, 0, 0, GNO_NOISE_SMOOTH) == 0x1.ca29fa774a223p-1);
    assert_true(noise3(3, -2, 7, 0, GNO_NOISE_LINEAR) == 0x1.99cc698d5d837p-2);
    assert_true(noise3(-5, 11, -13, 42, GNO_NOISE_SMOOTH) == 0x1.d29d2d689d0b5p-2);
}

/* At lattice points both weights give the lattice value; half way along an edge both give the mean of its ends. */
static void test_interpolates(void **state)
{
    (void)state;
    for (int i = -3; i < 3; i++) {
        double a = noise3(i, 2, -1, 9, GNO_NOISE_LINEAR), b = noise3(i + 1, 2, -1, 9, GNO_NOISE_LINEAR);
        assert_true(a == noise3(i, 2, -1, 9, GNO_NOISE_SMOOTH));
        assert_near(noise3(i + 0.5, 2, -1, 9, GNO_NOISE_LINEAR), 0.5 * (a + b), 1e-15);
        assert_near(noise3(i + 0.5, 2, -1, 9, GNO_NOISE_SMOOTH), 0.5 * (a + b), 1e-15);
        assert_near(noise3(i + 0.25, 2, -1, 9, GNO_NOISE_LINEAR), 0.75 * a + 0.25 * b, 1e-15);
        /* W(1/4) = 3/16 - 2/64 = 5/32 */
        assert_near(noise3(i + 0.25, 2, -1, 9, GNO_NOISE_SMOOTH), 27.0 / 32 * a + 5.0 / 32 * b, 1e-15);
    }
}

/* The value never jumps: no slope is steeper than 1.5 (smooth) or 1 (linear) along an axis. */
static void test_continuous(void **state)
{
    uint32_t r = 5;
    double h = 1e-6;
    (void)state;
    for (int i = 0; i < 100000; i++) {
        double p[3], q[3], steepest = i & 1 ? 1 : 1.5;
        random_point(&r, 10, p);
        if (i % 4 < 2)
            p[i % 3] = floor(p[i % 3]) - h / 2; /* across a face of a cell */
        for (int k = 0; k < 3; k++)
            q[k] = p[k] + (k == i % 3 ? h : 0);
        assert_near(gno_noise(p, 1, (gno_noise_weight)(i & 1)), gno_noise(q, 1, (gno_noise_weight)(i & 1)), steepest * h * 1.01);
    }
}

static void test_gradient(void **state)
{
    uint32_t r = 7;
    double h = 1e-6;
    (void)state;
    for (int i = 0; i < 20000; i++) {
        double p[3], g[3], v;
        gno_noise_weight weight = (gno_noise_weight)(i & 1);
        random_point(&r, 6, p);
        for (int k = 0; k < 3; k++)
            p[k] += fabs(p[k] - floor(p[k] + 0.5)) < 1e-4 ? 1e-3 : 0; /* plain weights have no slope at the faces */
        v = gno_noise_gradient(p, 2, weight, g);
        assert_true(v == gno_noise(p, 2, weight));
        for (int k = 0; k < 3; k++) {
            double a[3] = {p[0], p[1], p[2]}, b[3] = {p[0], p[1], p[2]};
            a[k] -= h;
            b[k] += h;
            assert_near(g[k], (gno_noise(b, 2, weight) - gno_noise(a, 2, weight)) / (2 * h), 1e-8);
        }
    }
}

/* Smooth weights: the slope on both sides of a cell's face is the same; across it, zero. Plain ones: it jumps. */
static void test_slope_is_continuous(void **state)
{
    uint32_t r = 11;
    double largest_jump = 0, e = 1e-7;
    (void)state;
    for (int i = 0; i < 20000; i++) {
        double p[3], q[3], gp[3], gq[3];
        int axis = i % 3;
        random_point(&r, 10, p);
        p[axis] = floor(p[axis]);
        for (int k = 0; k < 3; k++)
            q[k] = p[k];
        p[axis] -= e;
        q[axis] += e;
        gno_noise_gradient(p, 4, GNO_NOISE_SMOOTH, gp);
        gno_noise_gradient(q, 4, GNO_NOISE_SMOOTH, gq);
        for (int k = 0; k < 3; k++)
            assert_near(gp[k], gq[k], 20 * e);
        assert_near(gp[axis], 0, 10 * e);
        gno_noise_gradient(p, 4, GNO_NOISE_LINEAR, gp);
        gno_noise_gradient(q, 4, GNO_NOISE_LINEAR, gq);
        largest_jump = fmax(largest_jump, fabs(gp[axis] - gq[axis]));
    }
    assert_true(largest_jump > 0.5);
}

/* Lattice values are uniform: chi-square of 64 classes over 64^3 values; neighbours along the axes do not know of each other. */
static void test_lattice_is_uniform(void **state)
{
    (void)state;
    for (unsigned seed = 0; seed < 4; seed++) {
        double classes[64] = {0}, chi = 0, product[3] = {0, 0, 0}, seeds = 0, sum = 0;
        int n = 64 * 64 * 64;
        for (int i = 0; i < n; i++) {
            int x = i % 64 - 32, y = i / 64 % 64 - 32, z = i / 4096 - 32;
            double v = gnoi_hash_unit(x, y, z, seed);
            int c = (int)(v * 64);
            classes[c < 64 ? c : 63]++;
            sum += v;
            product[0] += (v - 0.5) * (gnoi_hash_unit(x + 1, y, z, seed) - 0.5);
            product[1] += (v - 0.5) * (gnoi_hash_unit(x, y + 1, z, seed) - 0.5);
            product[2] += (v - 0.5) * (gnoi_hash_unit(x, y, z + 1, seed) - 0.5);
            seeds += (v - 0.5) * (gnoi_hash_unit(x, y, z, seed + 1) - 0.5);
        }
        for (int i = 0; i < 64; i++)
            chi += (classes[i] - n / 64.0) * (classes[i] - n / 64.0) / (n / 64.0);
        assert_true(chi < 63 + 4.5 * sqrt(126)); /* mean 63, standard deviation sqrt(126) */
        assert_near(sum / n, 0.5, 4.5 * sqrt(1.0 / 12 / n));
        for (int k = 0; k < 3; k++)
            assert_near(product[k] * 12 / n, 0, 4.5 / sqrt(n));
        assert_near(seeds * 12 / n, 0, 4.5 / sqrt(n));
    }
}

/* Mean 1/2; variance 1/12 times the mean of w^2 + (1-w)^2 for each axis: 26/35 smooth, 2/3 plain; symmetrical about the mean. */
static void test_mean_and_variance(void **state)
{
    static const double per_axis[2] = {26.0 / 35, 2.0 / 3};
    (void)state;
    for (int weight = 0; weight < 2; weight++) {
        uint32_t r = 13;
        double sum = 0, squares = 0, cubes = 0, variance = pow(per_axis[weight], 3) / 12;
        int n = 400000;
        for (int i = 0; i < n; i++) {
            double p[3], v;
            random_point(&r, 3000, p);
            v = gno_noise(p, 6, (gno_noise_weight)weight) - 0.5;
            sum += v;
            squares += v * v;
            cubes += v * v * v;
        }
        assert_near(sum / n, 0, 4.5 * sqrt(variance / n));
        assert_near(squares / n, variance, 0.01 * variance);
        assert_near(cubes / n / pow(variance, 1.5), 0, 0.02);
    }
}

/* ---- sums ------------------------------------------------------------------------------------------------------------ */

static void test_one_octave_is_the_noise(void **state)
{
    gno_fractal f = gno_fractal_default();
    double p[3] = {1.3, -2.7, 0.4}, g[3], h[3];
    (void)state;
    f.octaves = 1;
    f.seed = 8;
    assert_true(gno_fractal_noise(&f, p, 0, g) == gno_noise_gradient(p, 8, GNO_NOISE_SMOOTH, h));
    for (int k = 0; k < 3; k++)
        assert_true(g[k] == h[k]);
}

static void test_sum_gradient(void **state)
{
    gno_fractal f = gno_fractal_default();
    uint32_t r = 17;
    double h = 1e-6;
    (void)state;
    for (int i = 0; i < 3000; i++) {
        double p[3], g[3], width = i % 3 * 0.07;
        random_point(&r, 6, p);
        gno_fractal_noise(&f, p, width, g);
        for (int k = 0; k < 3; k++) {
            double a[3] = {p[0], p[1], p[2]}, b[3] = {p[0], p[1], p[2]};
            a[k] -= h;
            b[k] += h;
            assert_near(g[k], (gno_fractal_noise(&f, b, width, NULL) - gno_fractal_noise(&f, a, width, NULL)) / (2 * h), 1e-4);
        }
    }
}

/* What has faded is what is missing from the variance; a sample of many of the coarsest cells has nothing but the mean. */
static void test_fading(void **state)
{
    static const double widths[] = {0, 0.05, 0.2, 0.5};
    gno_fractal f = gno_fractal_default();
    double whole = 0, p[3] = {0.3, 0.4, 0.5};
    (void)state;
    for (size_t w = 0; w < sizeof widths / sizeof *widths; w++) {
        uint32_t r = 19;
        double sum = 0, squares = 0, lost = 0;
        int n = 60000;
        for (int i = 0; i < n; i++) {
            double q[3], v;
            random_point(&r, 3000, q);
            v = gnoi_fractal_noise(&f, q, widths[w], NULL, &lost) - 0.5;
            sum += v;
            squares += v * v;
        }
        assert_near(sum / n, 0, 0.003);
        if (w == 0)
            whole = squares / n;
        assert_near(squares / n + lost, whole, 0.03 * whole);
    }
    assert_true(gno_fractal_noise(&f, p, 3.5, NULL) == 0.5);
}

/* One filtered value a pixel against the mean of 1024 samples over it: never much worse than an unfiltered value, far better where the
 * pixel is wider than the cells, and never worse than the plain mean would be. */
static void test_sums_do_not_alias(void **state)
{
    static const double widths[] = {0.1, 0.4, 1, 2, 4, 8};
    gno_fractal f = gno_fractal_default();
    (void)state;
    f.octaves = 8;
    for (size_t w = 0; w < sizeof widths / sizeof *widths; w++) {
        double filtered = 0, plain = 0, nothing = 0, width = widths[w];
        int n = 200;
        for (int i = 0; i < n; i++) {
            double at[3] = {i * width * 1.37, 0.37 + i, 0.11}, mean = 0;
            for (int j = 0; j < 1024; j++) {
                double q[3] = {at[0] + width * ((j % 32 + 0.5) / 32 - 0.5), at[1] + width * ((j / 32 + 0.5) / 32 - 0.5), at[2]};
                mean += gno_fractal_noise(&f, q, 0, NULL) / 1024;
            }
            filtered += pow(gno_fractal_noise(&f, at, width, NULL) - mean, 2);
            plain += pow(gno_fractal_noise(&f, at, 0, NULL) - mean, 2);
            nothing += pow(0.5 - mean, 2);
        }
        assert_true(filtered < 1.01 * plain && filtered < 1.01 * nothing);
        assert_true(width < 2 || filtered < 0.5 * plain);
    }
}

static void test_cosine(void **state)
{
    uint32_t r = 23;
    (void)state;
    for (int i = 0; i < 10000; i++) {
        double t = 20 * (next(&r) - 0.5);
        assert_near(gnoi_cos_turns(t), cos(6.283185307179586 * t), 1e-11);
    }
    assert_near(gnoi_cos_turns(0), 1, 1e-11);
    assert_near(gnoi_cos_turns(0.5), -1, 1e-11);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_range),
        cmocka_unit_test(test_strange_coordinates),
        cmocka_unit_test(test_known_values),
        cmocka_unit_test(test_interpolates),
        cmocka_unit_test(test_continuous),
        cmocka_unit_test(test_gradient),
        cmocka_unit_test(test_slope_is_continuous),
        cmocka_unit_test(test_lattice_is_uniform),
        cmocka_unit_test(test_mean_and_variance),
        cmocka_unit_test(test_one_octave_is_the_noise),
        cmocka_unit_test(test_sum_gradient),
        cmocka_unit_test(test_fading),
        cmocka_unit_test(test_sums_do_not_alias),
        cmocka_unit_test(test_cosine),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
