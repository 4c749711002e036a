/* test_picture.c -- gno_picture_write: what is written can be read back by the formats' own libraries, sRGB is the rounded
 * curve, and a file is there whole or not at all.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>
#include <dirent.h>
#include <gnomon/gnomon_io.h>
#include <math.h>
#include <OpenEXR/openexr.h>
#include <png.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

/* Every test works in this folder, which is empty at its start. */
static char folder[] = "/tmp/gnomon-picture-XXXXXX";

static const char *in_folder(const char *name)
{
    static char path[4][600];
    static int turn;
    turn = (turn + 1) % 4;
    snprintf(path[turn], sizeof path[turn], "%s/%s", folder, name);
    return path[turn];
}

static int files_in_folder(void)
{
    int count = 0;
    DIR *directory = opendir(folder);
    assert_non_null(directory);
    for (struct dirent *entry = readdir(directory); entry != NULL; entry = readdir(directory)) {
        count += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
    }
    closedir(directory);
    return count;
}

static int empty_folder(void **state)
{
    (void)state;
    DIR *directory = opendir(folder);
    if (directory == NULL) {
        return 1;
    }
    for (struct dirent *entry = readdir(directory); entry != NULL; entry = readdir(directory)) {
        if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0) {
            remove(in_folder(entry->d_name));
        }
    }
    closedir(directory);
    return 0;
}

static gno_context *new_context(void)
{
    gno_context *context = NULL;
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    return context;
}

static gno_status write_picture(gno_context *context, const char *path, gno_pixel_depth depth, int width, int height, const float *rgb)
{
    gno_picture_def def = gno_picture_def_default();
    def.depth = depth;
    return gno_picture_write(context, path, &def, width, height, rgb);
}

static void expect_message(const gno_context *context, const char *part)
{
    if (strstr(gno_context_message(context), part) == NULL) {
        fail_msg("message \"%s\" does not hold \"%s\"", gno_context_message(context), part);
    }
}

/* ---- readers, independent of the writers ------------------------------------------------------------------------- */

static unsigned *read_png(const char *path, int depth, int width, int height)
{
    FILE *in = fopen(path, "rb");
    assert_non_null(in);
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    if (setjmp(png_jmpbuf(png)) != 0) {
        fail_msg("libpng cannot read %s", path);
    }
    png_init_io(png, in);
    png_read_png(png, info, PNG_TRANSFORM_IDENTITY, NULL);
    assert_int_equal(png_get_bit_depth(png, info), depth);
    assert_int_equal(png_get_color_type(png, info), PNG_COLOR_TYPE_RGB);
    assert_int_equal(png_get_image_width(png, info), width);
    assert_int_equal(png_get_image_height(png, info), height);
    int intent;
    assert_int_equal(png_get_sRGB(png, info, &intent), PNG_INFO_sRGB);
    unsigned *levels = malloc((size_t)width * (size_t)height * 3 * sizeof *levels);
    assert_non_null(levels);
    png_bytepp rows = png_get_rows(png, info);
    for (size_t y = 0, i = 0; y < (size_t)height; y++) {
        for (size_t x = 0; x < (size_t)width * 3; x++, i++) {
            levels[i] = depth == 8 ? rows[y][x] : (unsigned)rows[y][2 * x] << 8 | rows[y][2 * x + 1];
        }
    }
    png_destroy_read_struct(&png, &info, NULL);
    fclose(in);
    return levels;
}

static float *read_exr(const char *path, exr_pixel_type_t type, int width, int height)
{
    exr_context_t exr = NULL;
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_decode_pipeline_t pipeline;
    exr_attr_box2i_t box;
    exr_compression_t compression;
    float aspect;
    int32_t rows;
    memset(&pipeline, 0, sizeof pipeline);
    assert_int_equal(exr_start_read(&exr, path, &init), EXR_ERR_SUCCESS);
    assert_int_equal(exr_get_data_window(exr, 0, &box), EXR_ERR_SUCCESS);
    assert_int_equal(box.min.x, 0);
    assert_int_equal(box.min.y, 0);
    assert_int_equal(box.max.x, width - 1);
    assert_int_equal(box.max.y, height - 1);
    assert_int_equal(exr_get_compression(exr, 0, &compression), EXR_ERR_SUCCESS);
    assert_int_equal(compression, EXR_COMPRESSION_ZIP);
    assert_int_equal(exr_get_pixel_aspect_ratio(exr, 0, &aspect), EXR_ERR_SUCCESS);
    assert_true(aspect == 1.0f);
    assert_int_equal(exr_get_scanlines_per_chunk(exr, 0, &rows), EXR_ERR_SUCCESS);
    float *rgb = malloc((size_t)width * (size_t)height * 3 * sizeof *rgb);
    assert_non_null(rgb);
    for (int y = 0; y < height; y += rows) {
        exr_chunk_info_t chunk;
        assert_int_equal(exr_read_scanline_chunk_info(exr, 0, y, &chunk), EXR_ERR_SUCCESS);
        assert_int_equal(y == 0 ? exr_decoding_initialize(exr, 0, &chunk, &pipeline) : exr_decoding_update(exr, 0, &chunk, &pipeline),
                         EXR_ERR_SUCCESS);
        assert_int_equal(pipeline.channel_count, 3);
        for (int c = 0; c < 3; c++) {
            exr_coding_channel_info_t *channel = &pipeline.channels[c];
            assert_string_equal(channel->channel_name, c == 0 ? "B" : c == 1 ? "G" : "R");
            assert_int_equal(channel->data_type, type);
            channel->decode_to_ptr = (uint8_t *)(rgb + (size_t)y * (size_t)width * 3 + (2 - c));
            channel->user_pixel_stride = 12;
            channel->user_line_stride = 12 * width;
            channel->user_bytes_per_element = 4;
            channel->user_data_type = EXR_PIXEL_FLOAT;
        }
        if (y == 0) {
            assert_int_equal(exr_decoding_choose_default_routines(exr, 0, &pipeline), EXR_ERR_SUCCESS);
        }
        assert_int_equal(exr_decoding_run(exr, 0, &pipeline), EXR_ERR_SUCCESS);
    }
    assert_int_equal(exr_decoding_destroy(exr, &pipeline), EXR_ERR_SUCCESS);
    assert_int_equal(exr_finish(&exr), EXR_ERR_SUCCESS);
    return rgb;
}

static float *read_pfm(const char *path, int width, int height)
{
    const size_t row = (size_t)width * 3;
    int w, h;
    float scale;
    FILE *in = fopen(path, "rb");
    assert_non_null(in);
    assert_int_equal(fscanf(in, "PF\n%d %d\n%f", &w, &h, &scale), 3);
    assert_int_equal(fgetc(in), '\n');
    assert_int_equal(w, width);
    assert_int_equal(h, height);
    assert_true(scale == -1.0f || scale == 1.0f);
    float *rgb = malloc(row * (size_t)height * sizeof *rgb);
    assert_non_null(rgb);
    for (int y = height - 1; y >= 0; y--) {
        assert_int_equal(fread(rgb + (size_t)y * row, sizeof *rgb, row, in), row);
    }
    assert_int_equal(fgetc(in), EOF);
    fclose(in);
    return rgb;
}

/* The definition of IEC 61966-2-1, rounded to the nearest level. */
static unsigned srgb_level(double linear, int top)
{
    const double x = !(linear > 0.0) ? 0.0 : linear > 1.0 ? 1.0 : linear;
    const double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055;
    return (unsigned)floor(encoded * top + 0.5);
}

static double linear_of(double encoded)
{
    return encoded <= 0.04045 ? encoded / 12.92 : pow((encoded + 0.055) / 1.055, 2.4);
}

/* Values that make a wrong row order, channel order or stride visible. */
static float *gradient(int width, int height)
{
    float *rgb = malloc((size_t)width * (size_t)height * 3 * sizeof *rgb);
    assert_non_null(rgb);
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            float *pixel = rgb + ((size_t)y * (size_t)width + (size_t)x) * 3;
            pixel[0] = (float)x / (float)width;
            pixel[1] = (float)y / (float)height;
            pixel[2] = (float)((x * 7 + y * 13) % 32) / 16.0f;
        }
    }
    return rgb;
}

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

/* ---- whole or not at all --------------------------------------------------------------------------------------------- */

static const char *const every_format[] = {"a.png", "a.exr", "a.pfm"};

static void put_text(const char *path, const char *text)
{
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    fputs(text, out);
    assert_int_equal(fclose(out), 0);
}

static void expect_text(const char *path, const char *text)
{
    char read[100] = "";
    FILE *in = fopen(path, "r");
    assert_non_null(in);
    assert_non_null(fgets(read, sizeof read, in));
    fclose(in);
    assert_string_equal(read, text);
}

static void test_unwritable(void **state)
{
    (void)state;
    const float rgb[3] = {0};
    gno_context *context = new_context();
    for (int i = 0; i < 3; i++) {
        char path[64];
        snprintf(path, sizeof path, "nowhere/%s", every_format[i]);
        assert_int_equal(write_picture(context, in_folder(path), GNO_DEPTH_DEFAULT, 1, 1, rgb), GNO_ERROR_FILE);
        expect_message(context, path);
        expect_message(context, "No such file");
        assert_int_equal(mkdir(in_folder(every_format[i]), 0777), 0);
        assert_int_equal(write_picture(context, in_folder(every_format[i]), GNO_DEPTH_DEFAULT, 1, 1, rgb), GNO_ERROR_FILE);
        expect_message(context, "directory");
    }
    assert_int_equal(files_in_folder(), 3);
    gno_context_destroy(context);
}

/* A limit on file sizes stands in for a full disk: writing fails half-way. */
static void test_failure_keeps_the_old_file(void **state)
{
    (void)state;
    const int side = 300;
    gno_context *context = new_context();
    float *rgb = gradient(side, side);
    uint32_t seed = 1;
    for (size_t i = 0; i < (size_t)side * (size_t)side * 3; i++) {
        seed = seed * 1664525u + 1013904223u; /* noise cannot be compressed below the limit */
        rgb[i] = (float)(seed / 4294967296.0);
    }
    const size_t held = gno_context_memory(context, NULL);
    struct rlimit old, low;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &old), 0);
    low = old;
    low.rlim_cur = 20000;
    signal(SIGXFSZ, SIG_IGN);
    for (int i = 0; i < 3; i++) {
        put_text(in_folder(every_format[i]), "old picture");
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &low), 0);
        const gno_status status = write_picture(context, in_folder(every_format[i]), GNO_DEPTH_DEFAULT, side, side, rgb);
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &old), 0);
        assert_int_equal(status, GNO_ERROR_FILE);
        expect_message(context, every_format[i]);
        expect_message(context, "too large");
        expect_text(in_folder(every_format[i]), "old picture");
        assert_int_equal(files_in_folder(), i + 1);
        assert_int_equal(gno_context_memory(context, NULL), held);
    }
    signal(SIGXFSZ, SIG_DFL);
    free(rgb);
    gno_context_destroy(context);
}

static void test_success_replaces_the_old_file(void **state)
{
    (void)state;
    gno_context *context = new_context();
    float *rgb = gradient(5, 4);
    struct stat found;
    put_text(in_folder("a.png"), "old picture");
    assert_int_equal(chmod(in_folder("a.png"), 0640), 0);
    assert_int_equal(symlink("a.png", in_folder("link.png")), 0);
    assert_int_equal(write_picture(context, in_folder("link.png"), GNO_DEPTH_DEFAULT, 5, 4, rgb), GNO_OK);
    free(read_png(in_folder("a.png"), 8, 5, 4));
    assert_int_equal(stat(in_folder("a.png"), &found), 0);
    assert_int_equal(found.st_mode & 0777, 0640);
    assert_int_equal(lstat(in_folder("link.png"), &found), 0);
    assert_true(S_ISLNK(found.st_mode));
    assert_int_equal(files_in_folder(), 2);
    free(rgb);
    gno_context_destroy(context);
}

static void test_full_device(void **state)
{
    (void)state;
    if (access("/dev/full", W_OK) != 0) {
        skip();
    }
    gno_context *context = new_context();
    float *rgb = gradient(200, 200);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(symlink("/dev/full", in_folder(every_format[i])), 0);
        assert_int_equal(write_picture(context, in_folder(every_format[i]), GNO_DEPTH_DEFAULT, 200, 200, rgb), GNO_ERROR_FILE);
        expect_message(context, "No space");
    }
    assert_int_equal(files_in_folder(), 3);
    free(rgb);
    gno_context_destroy(context);
}

/* ---- memory ---------------------------------------------------------------------------------------------------------- */

typedef struct counter {
    int left; /* allocations that still succeed */
} counter;

static void *counted(void *user, void *block, size_t old_size, size_t new_size)
{
    counter *count = user;
    (void)old_size;
    if (new_size == 0) {
        free(block);
        return NULL;
    }
    return count->left-- > 0 ? realloc(block, new_size) : NULL;
}

static void test_every_allocation_fails_once(void **state)
{
    (void)state;
    float *rgb = gradient(40, 40);
    counter count = {1000000};
    gno_context_def def = gno_context_def_default();
    def.alloc = counted;
    def.alloc_user = &count;
    gno_context *context = NULL;
    assert_int_equal(gno_context_create(&def, &context), GNO_OK);
    const size_t held = gno_context_memory(context, NULL);
    for (int i = 0; i < 3; i++) {
        gno_status status = GNO_ERROR_MEMORY;
        for (int allowed = 0; status != GNO_OK; allowed++) {
            assert_true(allowed < 100);
            count.left = allowed;
            status = write_picture(context, in_folder(every_format[i]), GNO_DEPTH_DEFAULT, 40, 40, rgb);
            assert_true(status == GNO_OK || status == GNO_ERROR_MEMORY);
            assert_int_equal(files_in_folder(), status == GNO_OK ? i + 1 : i);
            assert_int_equal(gno_context_memory(context, NULL), held);
        }
    }
    free(rgb);
    gno_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_png, empty_folder),
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
        cmocka_unit_test_setup(test_unwritable, empty_folder),
        cmocka_unit_test_setup(test_failure_keeps_the_old_file, empty_folder),
        cmocka_unit_test_setup(test_success_replaces_the_old_file, empty_folder),
        cmocka_unit_test_setup(test_full_device, empty_folder),
        cmocka_unit_test_setup(test_every_allocation_fails_once, empty_folder),
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
