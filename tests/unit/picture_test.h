/* picture_test.h -- a folder for pictures, and readers of them that owe nothing to the writers. For inclusion after cmocka.h. */
#ifndef PICTURE_TEST_H
#define PICTURE_TEST_H

#include <dirent.h>
#include <gnomon/gnomon_io.h>
#include <math.h>
#include <OpenEXR/openexr.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Every test works in this folder, which is empty at its start. */
static char folder[] = "/tmp/gnomon-picture-XXXXXX";

static inline const char *in_folder(const char *name)
{
    static char path[4][600];
    static int turn;
    turn = (turn + 1) % 4;
    snprintf(path[turn], sizeof path[turn], "%s/%s", folder, name);
    return path[turn];
}

static inline int files_in_folder(void)
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

static inline int empty_folder(void **state)
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

static inline gno_context *new_context(void)
{
    gno_context *context = NULL;
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    return context;
}

static inline gno_status write_picture(gno_context *context, const char *path, gno_pixel_depth depth, int width, int height, const float *rgb)
{
    gno_picture_def def = gno_picture_def_default();
    def.depth = depth;
    return gno_picture_write(context, path, &def, width, height, rgb);
}

static inline void expect_message(const gno_context *context, const char *part)
{
    if (strstr(gno_context_message(context), part) == NULL) {
        fail_msg("message \"%s\" does not hold \"%s\"", gno_context_message(context), part);
    }
}

/* ---- readers, independent of the writers ------------------------------------------------------------------------- */

static inline unsigned *read_png(const char *path, int depth, int width, int height)
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

static inline float *read_exr(const char *path, exr_pixel_type_t type, int width, int height)
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

static inline float *read_pfm(const char *path, int width, int height)
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
static inline unsigned srgb_level(double linear, int top)
{
    const double x = !(linear > 0.0) ? 0.0 : linear > 1.0 ? 1.0 : linear;
    const double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055;
    return (unsigned)floor(encoded * top + 0.5);
}

static inline double linear_of(double encoded)
{
    return encoded <= 0.04045 ? encoded / 12.92 : pow((encoded + 0.055) / 1.055, 2.4);
}

/* Values that make a wrong row order, channel order or stride visible. */
static inline float *gradient(int width, int height)
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

#endif
