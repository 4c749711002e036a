/* test_filter.c -- the texture filter against a brute-force integral: 64 x 64 samples a pixel, each a plain look at the element
 * under it.
 *
 * Pixels come from random planes under a perspective view: enlarged, reduced, and so slanted that w changes manifold within a pixel.
 * Where a pixel holds so many elements that 4096 samples would not resolve them, more are taken.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include "project/filter.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ONE_STEP (1.0 / 255)

static uint32_t random_state;

static double random_unit(void)
{
    random_state = random_state * 1664525u + 1013904223u;
    return (random_state >> 8) / 16777216.0;
}

static double random_between(double a, double b) { return a + (b - a) * random_unit(); }

/* ---- pictures ------------------------------------------------------------------------------------------------------------ */

typedef enum picture_kind { CHECKER, CHECKER_OF_3, STRIPES, PHOTOGRAPH, LEAVES } picture_kind;

/* A checkerboard, stripes, or something with detail of every size as photographs have it; with alpha: leaves. */
static float picture_at(picture_kind kind, int x, int y, int k)
{
    double v = 0;
    switch (kind) {
    case CHECKER: return (float)((x + y) & 1);
    case CHECKER_OF_3: return (float)((x / 3 + y / 3) & 1);
    case STRIPES: return (float)(x & 1);
    case LEAVES:
        if (k == 3) return (float)(((x * 7) ^ (y * 5)) % 11 < 6);
        return (float)(0.2 + 0.1 * k);
    default:
        for (int octave = 0; octave < 6; octave++)
            v += sin(x * 0.13 * (1 << octave) + k + 1.7 * sin(y * 0.11 * (1 << octave) + octave)) / (1 << octave);
        return (float)(0.5 + 0.25 * v);
    }
}

/* Its values, 4 each, to *values. `bytes`: given as bytes, which are those values then. */
static gnoi_image make_picture(gno_context *context, picture_kind kind, int bytes, int width, int height, float **values)
{
    size_t count = (size_t)width * (size_t)height * 4;
    gnoi_image image;
    gno_pixels pixels;
    float *v = malloc(count * sizeof *v);
    unsigned char *b = malloc(count);
    assert_non_null(v);
    assert_non_null(b);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            for (int k = 0; k < 4; k++)
                v[4 * (y * width + x) + k] = k == 3 && kind != LEAVES ? 1 : picture_at(kind, x, y, k);
    for (size_t i = 0; i < count && bytes; i++) {
        b[i] = (unsigned char)(255 * v[i] + 0.5f);
        v[i] = (float)b[i] / 255;
    }
    memset(&pixels, 0, sizeof pixels);
    pixels.width = width;
    pixels.height = height;
    pixels.channels = 4;
    pixels.linear = bytes ? NULL : v;
    pixels.bytes = bytes ? b : NULL;
    assert_int_equal(gnoi_image_make(context, &pixels, &image), GNO_OK);
    free(b);
    *values = v;
    return image;
}

/* ---- the slow twin ------------------------------------------------------------------------------------------------------- */

static int wrapped(int i, int n, gno_wrap wrap)
{
    int m = ((i % n) + n) % n;
    if (wrap == GNO_WRAP_REPEAT) return m;
    if (wrap == GNO_WRAP_MIRROR) return ((i - m) / n) % 2 ? n - 1 - m : m;
    if (wrap == GNO_WRAP_CLAMP) return i < 0 ? 0 : i >= n ? n - 1 : i;
    return i < 0 || i >= n ? -1 : i;
}

static void brute_force(const float *values, int width, int height, gno_wrap wrap, const gnoi_pattern *p, double x, double y, int side,
                        double mean[4])
{
    double count = 0;
    mean[0] = mean[1] = mean[2] = mean[3] = 0;
    for (int j = 0; j < side; j++)
        for (int i = 0; i < side; i++) {
            double px = x - 0.5 + (i + 0.5) / side, py = y - 0.5 + (j + 0.5) / side, w = gnoi_plane_at(&p->w, px, py);
            int column, row;
            if (!(w > 0)) continue;
            column = wrapped((int)floor(gnoi_plane_at(&p->s, px, py) / w * width), width, wrap);
            row = wrapped((int)floor(gnoi_plane_at(&p->t, px, py) / w * height), height, wrap);
            count++;
            for (int k = 0; k < 4; k++) {
                const float *v = values + 4 * ((height - 1 - row) * width + column);
                mean[k] += column < 0 || row < 0 ? 1 : k < 3 ? v[k] * v[3] : v[3];
            }
        }
    for (int k = 0; k < 4; k++) mean[k] /= count;
}

/* ---- random pixels ------------------------------------------------------------------------------------------------------- */

/* A pixel about (0,0) that sees, at its middle, `size` elements along the shorter axis and `slant` times as many along the longer;
 * w changes by the share `bend` from its middle to its border. */
static gnoi_pattern random_pattern(int width, int height, double size, double slant, double bend)
{
    double turn = random_between(0, 6.3), spin = random_between(0, 6.3), a = cos(turn), b = sin(turn), c = cos(spin), d = sin(spin);
    double s0 = random_between(-2, 3), t0 = random_between(-2, 3), long_side = size * slant;
    double sx = (a * long_side * c - b * size * d) / width, sy = (a * long_side * d + b * size * c) / width;
    double tx = (b * long_side * c + a * size * d) / height, ty = (b * long_side * d - a * size * c) / height;
    double wx = -2 * bend * c, wy = -2 * bend * d; /* w falls along the long axis */
    gnoi_pattern p;
    p.w.fx = wx, p.w.fy = wy, p.w.f0 = 1;
    p.s.fx = sx + s0 * wx, p.s.fy = sy + s0 * wy, p.s.f0 = s0;
    p.t.fx = tx + t0 * wx, p.t.fy = ty + t0 * wy, p.t.f0 = t0;
    return p;
}

#define MOST_ROUNDS 60

/* The largest error; and a pixel asked for among others has to be the same, bit for bit, as asked for alone. */
static double worst(picture_kind kind, int bytes, int width, int height, gno_wrap wrap, double size, double slant, double bend, int rounds, int side)
{
    gno_context *context = NULL;
    gno_texture how = gno_texture_default(GNO_MAP_UV);
    const double middle = 0;
    double largest = 0;
    float *values, fast[MOST_ROUNDS][4];
    gnoi_pattern patterns[MOST_ROUNDS];
    gnoi_image image;
    gnoi_looks looks;
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    image = make_picture(context, kind, bytes, width, height, &values);
    how.wrap = wrap;
    looks.count = 0;
    for (int i = 0; i < rounds; i++) {
        patterns[i] = random_pattern(width, height, size * random_between(0.5, 2), slant * random_between(0.7, 1.4), bend * random_unit());
        gnoi_looks_ask(&looks, &image, &how, &patterns[i], 0, 0, 1, &middle, &middle, &fast[i]);
    }
    gnoi_looks_answer(&looks);
    for (int i = 0; i < rounds; i++) {
        double slow[4];
        float alone[4];
        gnoi_filter_pixel(&image, &how, &patterns[i], 0, 0, 0, 0, alone);
        assert_memory_equal(alone, fast[i], sizeof alone);
        brute_force(values, width, height, wrap, &patterns[i], 0, 0, side, slow);
        for (int k = 0; k < 4; k++)
            largest = fmax(largest, fabs((double)fast[i][k] - slow[k]));
    }
    gnoi_image_free(context, &image);
    free(values);
    gno_context_destroy(context);
    return largest;
}

/* ---- tests ----------------------------------------------------------------------------------------------------------------- */

typedef struct extent {
    double size, slant, bend;
    int rounds, side;
} extent;

static void check_all(const extent *extents, size_t count, gno_wrap wrap)
{
    static const char *const names[] = {"checker", "checker of 3", "stripes", "photograph", "leaves"};
    random_state = 7;
    for (int kind = CHECKER; kind <= LEAVES; kind++)
        for (size_t i = 0; i < 2 * count; i++) {
            const extent *e = &extents[i / 2];
            int bytes = (int)(i % 2);
            double off = worst((picture_kind)kind, bytes, 64, 42, wrap, e->size, e->slant, e->bend, e->rounds, e->side);
            if (off > ONE_STEP)
                fail_msg("%s%s, %g elements, slant %g: off by %g/255", names[kind], bytes ? " of bytes" : "", e->size, e->slant, 255 * off);
        }
}

static void test_enlarged(void **state)
{
    static const extent extents[] = {{0.05, 1, 0, 60, 64}, {0.2, 1, 0.2, 60, 64}, {0.8, 1, 0.2, 60, 128}};
    (void)state;
    for (int wrap = GNO_WRAP_REPEAT; wrap <= GNO_WRAP_NONE; wrap++)
        check_all(extents, 3, (gno_wrap)wrap);
}

static void test_reduced(void **state)
{
    static const extent extents[] = {{3, 1, 0.1, 12, 256}, {12, 1, 0.1, 4, 512}, {50, 1, 0.1, 2, 512}};
    (void)state;
    for (int wrap = GNO_WRAP_REPEAT; wrap <= GNO_WRAP_NONE; wrap++)
        check_all(extents, 3, (gno_wrap)wrap);
}

static void test_slanted(void **state)
{
    static const extent extents[] = {{0.05, 10, 0.4, 20, 128}, {0.2, 20, 0.45, 10, 512}, {1, 20, 0.45, 4, 512}, {4, 20, 0.45, 4, 512}};
    (void)state;
    for (int wrap = GNO_WRAP_REPEAT; wrap <= GNO_WRAP_NONE; wrap++)
        check_all(extents, 4, (gno_wrap)wrap);
}

/* Patterns without any width: all of the pixel lies on a line of the picture, or on a point. */
static void test_flat(void **state)
{
    static const double places[] = {0, 0.25, 1.0 / 3, 0.5, 0.999999, 1, 1.7};
    gno_context *context = NULL;
    gno_texture how = gno_texture_default(GNO_MAP_UV);
    float *values;
    gnoi_image image;
    (void)state;
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    image = make_picture(context, PHOTOGRAPH, 0, 32, 24, &values);
    for (int i = 0; i < 4 * 7 * 7; i++) {
        double s = places[i % 7], t = places[i / 7 % 7], length = i / 49 == 0 ? 0 : i / 49 == 1 ? 1e-9 : 0.4, slow[4];
        gnoi_pattern p = {{length / 32, 0, s}, {0, 0, t}, {0, 0, 1}};
        float fast[4];
        if (i / 49 == 3) { /* the other way */
            p.s.fx = 0;
            p.t.fy = length / 24;
        }
        gnoi_filter_pixel(&image, &how, &p, 0, 0, 0, 0, fast);
        brute_force(values, 32, 24, GNO_WRAP_REPEAT, &p, 0, 0, 128, slow);
        for (int k = 0; k < 4; k++)
            if (!(fabs((double)fast[k] - slow[k]) <= ONE_STEP))
                fail_msg("%g long at %g, %g: %g is not %g", length, s, t, (double)fast[k], slow[k]);
    }
    gnoi_image_free(context, &image);
    free(values);
    gno_context_destroy(context);
}

/* Pixels that see many columns, or rows, of elements and next to nothing across. */
static void test_long(void **state)
{
    gno_context *context = NULL;
    gno_texture how = gno_texture_default(GNO_MAP_UV);
    float *values;
    gnoi_image image;
    (void)state;
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    image = make_picture(context, PHOTOGRAPH, 1, 192, 160, &values);
    for (int i = 0; i < 20; i++) {
        double length = 45 + 5 * (i / 2), s = 0.37 + 0.01 * i, t = 0.553, slow[4];
        gnoi_pattern p = {{length / 192, 0, s}, {0, 0.04 / 160, t}, {0, 0, 1}};
        float fast[4];
        if (i % 2 != 0) {
            p.s.fx = 0.04 / 192, p.s.fy = 0;
            p.t.fx = 0, p.t.fy = length / 160;
        }
        gnoi_filter_pixel(&image, &how, &p, 0, 0, 0, 0, fast);
        brute_force(values, 192, 160, GNO_WRAP_REPEAT, &p, 0, 0, 1000, slow);
        for (int k = 0; k < 4; k++)
            if (!(fabs((double)fast[k] - slow[k]) <= ONE_STEP))
                fail_msg("%g long: %g is not %g", length, (double)fast[k], slow[k]);
    }
    gnoi_image_free(context, &image);
    free(values);
    gno_context_destroy(context);
}

/* Diagonal pixels in which w changes more than threefold, so that they are halved before they are cut by cells. */
static void test_halved(void **state)
{
    static const struct { double length, width, turn, bend, fall; } pixels[] = {
        {228.0, 9.94, 0.870, 0.820, 5.73}, {213.6, 8.78, 0.801, 0.772, 3.95}, {250.4, 15.16, 0.826, 0.808, 0.89},
    };
    gno_context *context = NULL;
    gno_texture how = gno_texture_default(GNO_MAP_UV);
    (void)state;
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    for (int i = 0; i < 6; i++) {
        double length = pixels[i / 2].length, width = pixels[i / 2].width, c = cos(pixels[i / 2].turn), d = sin(pixels[i / 2].turn);
        double wx = pixels[i / 2].bend * cos(pixels[i / 2].fall), wy = pixels[i / 2].bend * sin(pixels[i / 2].fall), slow[4];
        gnoi_pattern p = {{(length * c) / 64 + 0.3 * wx, -width * d / 64 + 0.3 * wy, 0.3},
                          {length * d / 42 + 0.6 * wx, width * c / 42 + 0.6 * wy, 0.6},
                          {wx, wy, 1}};
        float fast[4], *values;
        gnoi_image image = make_picture(context, i % 2 == 0 ? CHECKER : PHOTOGRAPH, 1, 64, 42, &values);
        gnoi_filter_pixel(&image, &how, &p, 0, 0, 0, 0, fast);
        brute_force(values, 64, 42, GNO_WRAP_REPEAT, &p, 0, 0, 1500, slow);
        for (int k = 0; k < 4; k++)
            if (!(fabs((double)fast[k] - slow[k]) <= ONE_STEP))
                fail_msg("pixel %d, channel %d: %g is not %g", i / 2, k, (double)fast[k], slow[k]);
        gnoi_image_free(context, &image);
        free(values);
    }
    gno_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_enlarged),
        cmocka_unit_test(test_reduced),
        cmocka_unit_test(test_slanted),
        cmocka_unit_test(test_flat),
        cmocka_unit_test(test_long),
        cmocka_unit_test(test_halved),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
