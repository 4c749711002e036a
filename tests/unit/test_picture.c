/* test_picture.c -- gno_picture_write: what is written can be read back by the formats' own libraries, and sRGB is the rounded curve. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#include "picture_test.h"

/* ---- formats ------------------------------------------------------------------------------------------------------- */

static void check_png(gno_pixel_depth asked, int depth, int width, int height)
{
    gno_context *context = new_context();
    float *rgb = gradient(width, height);
    assert_int_equal(write_picture(context, in_folder("a.png"), asked, width, height, rgb), GNO_OK);
    unsigned *levels = read_png(in_folder("a.png"), depth, width, height);
    for (size_t i = 0; i < (size_t)width * (size_t)height * 3; i++) {
        assert_int_equal(levels[i], srgb_level(rgb[i], depth == 8 ? 255 : 65535));
    }
    free(levels);
    free(rgb);
    gno_context_destroy(context);
}

static void test_png(void **state)
{
    (void)state;
    check_png(GNO_DEPTH_DEFAULT, 8, 37, 23);
    check_png(GNO_DEPTH_8, 8, 1, 1);
    check_png(GNO_DEPTH_16, 16, 37, 23);
    check_png(GNO_DEPTH_8, 8, GNO_MAX_IMAGE_SIDE, 2);
    check_png(GNO_DEPTH_16, 16, 2, 300);
}

/* Levels of noise, which does not pack, by the linear values that stand for them. All rows from the last of `rows` on are the same. */
static void check_png_of_noise(int depth, int width, int height, int rows)
{
    const int top = depth == 8 ? 255 : 65535;
    const size_t values = (size_t)width * (size_t)height * 3;
    float *rgb = malloc(values * sizeof *rgb), *linear = malloc(((size_t)top + 1) * sizeof *linear);
    unsigned *want = malloc(values * sizeof *want);
    assert_true(rgb != NULL && linear != NULL && want != NULL);
    for (int level = 0; level <= top; level++) {
        linear[level] = (float)linear_of((double)level / top);
    }
    uint32_t seed = (uint32_t)(width * 31 + height);
    for (size_t i = 0; i < values; i++) {
        seed = seed * 1664525u + 1013904223u;
        want[i] = i < (size_t)rows * (size_t)width * 3 ? seed >> (depth == 8 ? 24 : 16) : want[i - (size_t)width * 3];
        rgb[i] = linear[want[i]];
    }
    gno_context *context = new_context();
    assert_int_equal(write_picture(context, in_folder("a.png"), (gno_pixel_depth)depth, width, height, rgb), GNO_OK);
    unsigned *levels = read_png(in_folder("a.png"), depth, width, height);
    for (size_t i = 0; i < values; i++) {
        if (levels[i] != want[i]) {
            fail_msg("%d x %d, %d bits: value %zu is %u, not %u", width, height, depth, i, levels[i], want[i]);
        }
    }
    free(levels);
    free(want);
    free(linear);
    free(rgb);
    gno_context_destroy(context);
}

/* Up to 6 MiB the picture is packed in one piece and cut into chunks; 1999 x 1049 is the first height over that. */
static void test_png_of_noise(void **state)
{
    (void)state;
    const int depths[] = {8, 16};
    for (int i = 0; i < 2; i++) {
        check_png_of_noise(depths[i], 1, 1, 1);
        check_png_of_noise(depths[i], 1, 77, 77);
        check_png_of_noise(depths[i], 301, 1, 1);
        check_png_of_noise(depths[i], 317, 211, 211);
        check_png_of_noise(depths[i], 317, 211, 5);
    }
    check_png_of_noise(8, 1999, 1048, 1048);
    check_png_of_noise(8, 1999, 1049, 1049);
    check_png_of_noise(16, 1001, 1051, 1051);
}

/* Nearest half of a finite value in half's range: 11 significant bits, no fewer than 2^-24 a step. */
static double half_of(double value)
{
    int exponent;
    frexp(value, &exponent);
    const double step = ldexp(1.0, exponent - 11 > -24 ? exponent - 11 : -24);
    return nearbyint(value / step) * step;
}

static void check_exr(gno_pixel_depth asked, int depth, int width, int height)
{
    gno_context *context = new_context();
    float *rgb = gradient(width, height);
    assert_int_equal(write_picture(context, in_folder("a.exr"), asked, width, height, rgb), GNO_OK);
    float *read = read_exr(in_folder("a.exr"), depth == 16 ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT, width, height);
    for (size_t i = 0; i < (size_t)width * (size_t)height * 3; i++) {
        assert_true(read[i] == (depth == 32 ? rgb[i] : (float)half_of(rgb[i])));
    }
    free(read);
    free(rgb);
    gno_context_destroy(context);
}

static void test_exr(void **state)
{
    (void)state;
    check_exr(GNO_DEPTH_DEFAULT, 16, 37, 23);
    check_exr(GNO_DEPTH_16, 16, 1, 1);
    check_exr(GNO_DEPTH_32, 32, 37, 48);
    check_exr(GNO_DEPTH_32, 32, GNO_MAX_IMAGE_SIDE, 17);
}

static void test_exr_values_beyond_half(void **state)
{
    (void)state;
    const float rgb[] = {1e30f, -1e30f, 70000.0f, 65504.0f, 1e-9f, 0.0f};
    const float want[] = {65504.0f, -65504.0f, 65504.0f, 65504.0f, 0.0f, 0.0f};
    gno_context *context = new_context();
    assert_int_equal(write_picture(context, in_folder("a.exr"), GNO_DEPTH_16, 2, 1, rgb), GNO_OK);
    float *read = read_exr(in_folder("a.exr"), EXR_PIXEL_HALF, 2, 1);
    for (int i = 0; i < 6; i++) {
        assert_true(read[i] == want[i]);
    }
    free(read);
    gno_context_destroy(context);
}

static void test_pfm(void **state)
{
    (void)state;
    gno_context *context = new_context();
    float *rgb = gradient(37, 23);
    assert_int_equal(write_picture(context, in_folder("a.pfm"), GNO_DEPTH_DEFAULT, 37, 23, rgb), GNO_OK);
    float *read = read_pfm(in_folder("a.pfm"), 37, 23);
    assert_memory_equal(read, rgb, 37 * 23 * 3 * sizeof *rgb);
    free(read);
    free(rgb);
    gno_context_destroy(context);
}

static void test_exposure(void **state)
{
    (void)state;
    const float rgb[] = {0.1f, 0.2f, 0.4f};
    gno_context *context = new_context();
    gno_picture_def def = gno_picture_def_default();
    assert_true(def.exposure == 1.0);
    def.exposure = 2.0;
    assert_int_equal(gno_picture_write(context, in_folder("a.png"), &def, 1, 1, rgb), GNO_OK);
    assert_int_equal(gno_picture_write(context, in_folder("a.exr"), &def, 1, 1, rgb), GNO_OK);
    assert_int_equal(gno_picture_write(context, in_folder("a.pfm"), &def, 1, 1, rgb), GNO_OK);
    unsigned *levels = read_png(in_folder("a.png"), 8, 1, 1);
    float *half = read_exr(in_folder("a.exr"), EXR_PIXEL_HALF, 1, 1);
    float *full = read_pfm(in_folder("a.pfm"), 1, 1);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(levels[i], srgb_level(2.0 * rgb[i], 255));
        assert_true(half[i] == (float)half_of(2.0 * rgb[i]));
        assert_true(full[i] == 2.0f * rgb[i]);
    }
    free(levels);
    free(half);
    free(full);
    gno_context_destroy(context);
}

static void test_format_is_chosen(void **state)
{
    (void)state;
    const float rgb[] = {0.1f, 0.2f, 0.4f};
    gno_context *context = new_context();
    gno_picture_def def = gno_picture_def_default();
    assert_int_equal(gno_picture_write(context, in_folder("A.PNG"), NULL, 1, 1, rgb), GNO_OK);
    free(read_png(in_folder("A.PNG"), 8, 1, 1));
    def.format = GNO_FORMAT_PFM;
    assert_int_equal(gno_picture_write(context, in_folder("b.png"), &def, 1, 1, rgb), GNO_OK);
    free(read_pfm(in_folder("b.png"), 1, 1));
    def.format = GNO_FORMAT_PNG;
    assert_int_equal(gno_picture_write(context, in_folder("plain"), &def, 1, 1, rgb), GNO_OK);
    free(read_png(in_folder("plain"), 8, 1, 1));
    gno_context_destroy(context);
}

/* ---- sRGB ------------------------------------------------------------------------------------------------------------ */

/* Writes the values as one picture and compares every level with the curve. */
static void check_curve(const float *values, size_t count, int depth)
{
    const int width = 3000;
    const size_t row = (size_t)width * 3;
    const int height = (int)((count + row - 1) / row);
    float *rgb = calloc((size_t)height * row, sizeof *rgb);
    assert_non_null(rgb);
    memcpy(rgb, values, count * sizeof *rgb);
    gno_context *context = new_context();
    assert_int_equal(write_picture(context, in_folder("a.png"), (gno_pixel_depth)depth, width, height, rgb), GNO_OK);
    unsigned *levels = read_png(in_folder("a.png"), depth, width, height);
    for (size_t i = 0; i < count; i++) {
        const unsigned want = srgb_level(rgb[i], depth == 8 ? 255 : 65535);
        if (levels[i] != want) {
            fail_msg("%.9g at %d bits: %u, not %u", (double)rgb[i], depth, levels[i], want);
        }
    }
    free(levels);
    free(rgb);
    gno_context_destroy(context);
}

static void check_curve_of_depth(int depth)
{
    /* Each level's beginning with the floats around it is where a table can be wrong; then anything. */
    const int top = depth == 8 ? 255 : 65535;
    const size_t room = (size_t)top * 9 + 100000;
    float *values = malloc(room * sizeof *values);
    assert_non_null(values);
    size_t count = 0;
    for (int level = 0; level < top; level++) {
        const float begin = (float)linear_of((level + 0.5) / top), middle = (float)linear_of((double)level / top);
        const float around[] = {nextafterf(nextafterf(begin, -1.0f), -1.0f), nextafterf(begin, -1.0f), begin, nextafterf(begin, 2.0f),
                                nextafterf(nextafterf(begin, 2.0f), 2.0f),   middle,                  nextafterf(middle, -1.0f),
                                nextafterf(middle, 2.0f),                    begin * 0.5f};
        memcpy(values + count, around, sizeof around);
        count += 9;
    }
    uint32_t seed = 12345;
    while (count < room) {
        seed = seed * 1664525u + 1013904223u;
        const double x = seed / 4294967296.0;
        values[count] = (float)(count % 2 == 0 ? x : x * x * x * 0.1);
        count++;
    }
    check_curve(values, count, depth);
    free(values);
}

static void test_srgb_8(void **state)
{
    (void)state;
    check_curve_of_depth(8);
}

static void test_srgb_16(void **state)
{
    (void)state;
    check_curve_of_depth(16);
}

static void test_srgb_outside(void **state)
{
    (void)state;
    const float values[] = {NAN, -NAN, INFINITY, -INFINITY, -1.0f, -0.0f, 0.0f, 1.0f, 2.0f, 1e38f, 1e-45f, 0.99999994f};
    check_curve(values, sizeof values / sizeof *values, 8);
    check_curve(values, sizeof values / sizeof *values, 16);
}

/* ---- refusals -------------------------------------------------------------------------------------------------------- */

static void test_unknown_extension(void **state)
{
    (void)state;
    const float rgb[3] = {0};
    gno_context *context = new_context();
    const char *const names[] = {"a.jpg", "png", "a.", "", "a.pngx", "a.pn", "folder.png/a"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        assert_int_equal(write_picture(context, in_folder(names[i]), GNO_DEPTH_DEFAULT, 1, 1, rgb), GNO_ERROR_ARGUMENT);
        expect_message(context, names[i]);
        expect_message(context, ".png, .exr, .pfm");
    }
    assert_int_equal(files_in_folder(), 0);
    gno_context_destroy(context);
}

static void test_arguments(void **state)
{
    (void)state;
    const float rgb[3] = {0};
    gno_context *context = new_context();
    gno_picture_def def = gno_picture_def_default();
    assert_int_equal(gno_picture_write(NULL, in_folder("a.png"), NULL, 1, 1, rgb), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_picture_write(context, NULL, NULL, 1, 1, rgb), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_picture_write(context, in_folder("a.png"), NULL, 1, 1, NULL), GNO_ERROR_ARGUMENT);
    const int sizes[][2] = {{0, 1}, {1, 0}, {-1, 1}, {GNO_MAX_IMAGE_SIDE + 1, 1}, {1, GNO_MAX_IMAGE_SIDE + 1}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        assert_int_equal(gno_picture_write(context, in_folder("a.png"), NULL, sizes[i][0], sizes[i][1], rgb), GNO_ERROR_ARGUMENT);
    }
    assert_int_equal(write_picture(context, in_folder("a.png"), GNO_DEPTH_32, 1, 1, rgb), GNO_ERROR_ARGUMENT);
    expect_message(context, "8 or 16");
    assert_int_equal(write_picture(context, in_folder("a.exr"), GNO_DEPTH_8, 1, 1, rgb), GNO_ERROR_ARGUMENT);
    assert_int_equal(write_picture(context, in_folder("a.pfm"), GNO_DEPTH_16, 1, 1, rgb), GNO_ERROR_ARGUMENT);
    const double exposures[] = {-1.0, NAN, INFINITY};
    for (int i = 0; i < 3; i++) {
        def.exposure = exposures[i];
        assert_int_equal(gno_picture_write(context, in_folder("a.png"), &def, 1, 1, rgb), GNO_ERROR_ARGUMENT);
    }
    def = gno_picture_def_default();
    def.format = (gno_picture_format)77;
    assert_int_equal(gno_picture_write(context, in_folder("a.png"), &def, 1, 1, rgb), GNO_ERROR_ARGUMENT);
    assert_int_equal(files_in_folder(), 0);
    gno_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_png, empty_folder),
        cmocka_unit_test_setup(test_png_of_noise, empty_folder),
        cmocka_unit_test_setup(test_exr, empty_folder),
        cmocka_unit_test_setup(test_exr_values_beyond_half, empty_folder),
        cmocka_unit_test_setup(test_pfm, empty_folder),
        cmocka_unit_test_setup(test_exposure, empty_folder),
        cmocka_unit_test_setup(test_format_is_chosen, empty_folder),
        cmocka_unit_test_setup(test_srgb_8, empty_folder),
        cmocka_unit_test_setup(test_srgb_16, empty_folder),
        cmocka_unit_test_setup(test_srgb_outside, empty_folder),
        cmocka_unit_test_setup(test_unknown_extension, empty_folder),
        cmocka_unit_test_setup(test_arguments, empty_folder),
    };
    if (mkdtemp(folder) == NULL) {
        perror(folder);
        return 1;
    }
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    empty_folder(NULL);
    rmdir(folder);
    return failed != 0;
}
