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

typedef struct known_picture {
    gno_context *context;
    gnoi_image image;
    int width, height;
    float *values; /* 4 each */
} known_picture;

/* `bytes`: given as bytes, which its values are those of then. */
static known_picture open_picture(picture_kind kind, int bytes, int width, int height)
{
    size_t count = (size_t)width * (size_t)height * 4;
    gno_pixels pixels;
    known_picture p;
    unsigned char *b = malloc(count);
    p.width = width;
    p.height = height;
    p.values = malloc(count * sizeof *p.values);
    assert_non_null(p.values);
    assert_non_null(b);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            for (int k = 0; k < 4; k++)
                p.values[4 * (y * width + x) + k] = k == 3 && kind != LEAVES ? 1 : picture_at(kind, x, y, k);
    for (size_t i = 0; i < count && bytes; i++) {
        b[i] = (unsigned char)(255 * p.values[i] + 0.5f);
        p.values[i] = (float)b[i] / 255;
    }
    memset(&pixels, 0, sizeof pixels);
    pixels.width = width;
    pixels.height = height;
    pixels.channels = 4;
    pixels.linear = bytes ? NULL : p.values;
    pixels.bytes = bytes ? b : NULL;
    assert_int_equal(gno_context_create(NULL, &p.context), GNO_OK);
    assert_int_equal(gnoi_image_make(p.context, &pixels, &p.image), GNO_OK);
    free(b);
    return p;
}

static void close_picture(known_picture *p)
{
    gnoi_image_free(p->context, &p->image);
    free(p->values);
    gno_context_destroy(p->context);
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

static void brute_force(const known_picture *picture, gno_wrap wrap, const gnoi_pattern *p, int side, double mean[4])
{
    int width = picture->width, height = picture->height;
    double count = 0;
    mean[0] = mean[1] = mean[2] = mean[3] = 0;
    for (int j = 0; j < side; j++)
        for (int i = 0; i < side; i++) {
            double px = (i + 0.5) / side - 0.5, py = (j + 0.5) / side - 0.5, w = gnoi_plane_at(&p->w, px, py);
            int column, row;
            if (!(w > 0)) continue;
            column = wrapped((int)floor(gnoi_plane_at(&p->s, px, py) / w * width), width, wrap);
            row = wrapped((int)floor(gnoi_plane_at(&p->t, px, py) / w * height), height, wrap);
            count++;
            for (int k = 0; k < 4; k++) {
                const float *v = picture->values + 4 * ((height - 1 - row) * width + column);
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
static double worst(const known_picture *picture, gno_wrap wrap, double size, double slant, double bend, int rounds, int side)
{
    gno_texture how = gno_texture_default(GNO_MAP_UV);
    const double middle = 0;
    double largest = 0;
    float fast[MOST_ROUNDS][4];
    gnoi_pattern patterns[MOST_ROUNDS];
    gnoi_looks looks;
    how.wrap = wrap;
    looks.count = 0;
    for (int i = 0; i < rounds; i++) {
        patterns[i] = random_pattern(picture->width, picture->height, size * random_between(0.5, 2), slant * random_between(0.7, 1.4), bend * random_unit());
        gnoi_looks_ask(&looks, &picture->image, &how, &patterns[i], 0, 0, 1, &middle, &middle, &fast[i]);
    }
    gnoi_looks_answer(&looks);
    for (int i = 0; i < rounds; i++) {
        double slow[4];
        float alone[4];
        gnoi_filter_pixel(&picture->image, &how, &patterns[i], 0, 0, 0, 0, alone);
        assert_memory_equal(alone, fast[i], sizeof alone);
        brute_force(picture, wrap, &patterns[i], side, slow);
        for (int k = 0; k < 4; k++)
            largest = fmax(largest, fabs((double)fast[i][k] - slow[k]));
    }
    return largest;
}

/* One pixel, the picture repeating itself. */
static void check_pixel(const known_picture *picture, const gnoi_pattern *p, int side, const char *what, int number)
{
    gno_texture how = gno_texture_default(GNO_MAP_UV);
    double slow[4];
    float fast[4];
    gnoi_filter_pixel(&picture->image, &how, p, 0, 0, 0, 0, fast);
    brute_force(picture, GNO_WRAP_REPEAT, p, side, slow);
    for (int k = 0; k < 4; k++)
        if (!(fabs((double)fast[k] - slow[k]) <= ONE_STEP))
            fail_msg("%s %d, channel %d: %g is not %g", what, number, k, (double)fast[k], slow[k]);
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
            known_picture p = open_picture((picture_kind)kind, bytes, 64, 42);
            double off = worst(&p, wrap, e->size, e->slant, e->bend, e->rounds, e->side);
            close_picture(&p);
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
    known_picture picture = open_picture(PHOTOGRAPH, 0, 32, 24);
    (void)state;
    for (int i = 0; i < 4 * 7 * 7; i++) {
        double s = places[i % 7], t = places[i / 7 % 7], length = i / 49 == 0 ? 0 : i / 49 == 1 ? 1e-9 : 0.4;
        gnoi_pattern p = {{length / 32, 0, s}, {0, 0, t}, {0, 0, 1}};
        if (i / 49 == 3) { /* the other way */
            p.s.fx = 0;
            p.t.fy = length / 24;
        }
        check_pixel(&picture, &p, 128, "pixel without width", i);
    }
    close_picture(&picture);
}

/* Pixels that see many columns, or rows, of elements and next to nothing across. */
static void test_long(void **state)
{
    known_picture picture = open_picture(PHOTOGRAPH, 1, 192, 160);
    (void)state;
    for (int i = 0; i < 20; i++) {
        double length = 45 + 5 * (i / 2);
        gnoi_pattern p = {{length / 192, 0, 0.37 + 0.01 * i}, {0, 0.04 / 160, 0.553}, {0, 0, 1}};
        if (i % 2 != 0) {
            p.s.fx = 0.04 / 192;
            p.t.fy = length / 160;
        }
        check_pixel(&picture, &p, 1000, "long pixel", i);
    }
    close_picture(&picture);
}

/* A pixel `length` elements long and `width` wide, turned by `turn`, about (0.3, 0.6); w changes by `bend` from side to side along `fall`. */
static gnoi_pattern steep_pattern(double length, double width, double turn, double bend, double fall)
{
    double c = cos(turn), d = sin(turn), wx = bend * cos(fall), wy = bend * sin(fall);
    gnoi_pattern p = {{length * c / 64 + 0.3 * wx, -width * d / 64 + 0.3 * wy, 0.3}, {length * d / 42 + 0.6 * wx, width * c / 42 + 0.6 * wy, 0.6}, {wx, wy, 1}};
    return p;
}

/* Where w changes more than threefold the pixel is halved before it is cut by cells; and stripes weigh more on one side of every cell. */
static void test_steep(void **state)
{
    static const struct { double length, width, turn, bend, fall; } pixels[] = {
        {228.0, 9.94, 0.870, 0.820, 5.73}, {213.6, 8.78, 0.801, 0.772, 3.95}, {145.9, 17.41, 4.86, 0.414, 0.91}, {104.7, 25.62, 1.79, 0.500, 3.70},
    };
    static const picture_kind kinds[] = {CHECKER, STRIPES, PHOTOGRAPH};
    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        known_picture picture = open_picture(kinds[kind], 1, 64, 42);
        for (int i = 0; i < 4; i++) {
            gnoi_pattern p = steep_pattern(pixels[i].length, pixels[i].width, pixels[i].turn, pixels[i].bend, pixels[i].fall);
            check_pixel(&picture, &p, 1100, "steep pixel", 10 * kind + i);
        }
        close_picture(&picture);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_enlarged),
        cmocka_unit_test(test_reduced),
        cmocka_unit_test(test_slanted),
        cmocka_unit_test(test_flat),
        cmocka_unit_test(test_long),
        cmocka_unit_test(test_steep),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
