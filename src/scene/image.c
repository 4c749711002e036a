/* image.c -- see image.h. */
#include "scene/image.h"
#include <math.h>
#include <string.h>

/* The sRGB curve (IEC 61966-2-1), from 8 bits to linear. */
static float decode_srgb(int byte)
{
    double v = byte / 255.0;
    return (float)(v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4));
}

void gnoi_image_free(gno_context *context, gnoi_image *image)
{
    gnoi_free(context, image->bytes, (size_t)image->width * (size_t)image->height, sizeof *image->bytes);
    gnoi_free(context, image->decode, 256, sizeof *image->decode);
    for (int l = 0; l < image->level_count; l++) {
        gnoi_image_level *level = &image->level[l];
        size_t cells = (size_t)level->width * (size_t)level->height;
        gnoi_free(context, level->mean, cells, sizeof *level->mean);
        gnoi_free(context, level->variance, cells, sizeof *level->variance);
        gnoi_free(context, level->height_of, cells, sizeof *level->height_of);
    }
    memset(image, 0, sizeof *image);
}

static int allocate(gno_context *context, const gno_pixels *pixels, gnoi_image *image)
{
    int width = pixels->width, height = pixels->height, good = 1;
    image->width = width;
    image->height = height;
    if (pixels->bytes) {
        image->bytes = gnoi_malloc(context, (size_t)width * (size_t)height, sizeof *image->bytes);
        image->decode = gnoi_malloc(context, 256, sizeof *image->decode);
        good = image->bytes && image->decode;
    }
    for (int l = 0; good; l++, width = (width + 1) / 2, height = (height + 1) / 2) {
        gnoi_image_level *level = &image->level[l];
        size_t cells = (size_t)width * (size_t)height;
        level->width = width;
        level->height = height;
        image->level_count = l + 1;
        if (l > 0 || !pixels->bytes)
            good = (level->mean = gnoi_malloc(context, cells, sizeof *level->mean)) != NULL;
        if (l > 0)
            good = good && (level->variance = gnoi_malloc(context, cells, sizeof *level->variance)) != NULL;
        if (width == 1 && height == 1)
            break;
    }
    return good;
}

/* Where red, green, blue and alpha stand among the channels of a pixel; alpha -1: nowhere. */
static void find_channels(int channels, int place[4])
{
    place[0] = 0;
    place[1] = channels >= 3 ? 1 : 0;
    place[2] = channels >= 3 ? 2 : 0;
    place[3] = channels % 2 == 0 ? channels - 1 : -1;
}

static void copy_bytes(const gno_pixels *pixels, gnoi_image *image)
{
    int place[4];
    find_channels(pixels->channels, place);
    for (int y = 0; y < image->height; y++) {
        const unsigned char *in = pixels->bytes + (size_t)(image->height - 1 - y) * (size_t)image->width * (size_t)pixels->channels;
        unsigned char(*out)[4] = image->bytes + (size_t)y * (size_t)image->width;
        for (int x = 0; x < image->width; x++, in += pixels->channels) {
            for (int k = 0; k < 4; k++)
                out[x][k] = place[k] < 0 ? 255 : in[place[k]];
            image->has_alpha |= out[x][3] < 255;
        }
    }
    for (int i = 0; i < 256; i++)
        image->decode[i] = pixels->encoded ? decode_srgb(i) : (float)i / 255.0f;
}

static void copy_floats(const gno_pixels *pixels, gnoi_image *image)
{
    int place[4];
    find_channels(pixels->channels, place);
    for (int y = 0; y < image->height; y++) {
        const float *in = pixels->linear + (size_t)(image->height - 1 - y) * (size_t)image->width * (size_t)pixels->channels;
        float(*out)[4] = image->level[0].mean + (size_t)y * (size_t)image->width;
        for (int x = 0; x < image->width; x++, in += pixels->channels) {
            float alpha = place[3] < 0 ? 1 : in[place[3]];
            alpha = alpha < 0 ? 0 : alpha > 1 ? 1 : alpha;
            image->has_alpha |= alpha < 1;
            for (int k = 0; k < 3; k++)
                out[x][k] = in[place[k]] * alpha;
            out[x][3] = alpha;
        }
    }
}

/* Elements of the picture along one side of cell i of a level. */
static int side(int elements, int level, int i)
{
    int from = i << level, to = from + (1 << level);
    return (to < elements ? to : elements) - from;
}

static inline float larger(float a, float b) { return a > b ? a : b; }

/* A cell's mean over its up to four children, weighted by their sizes, and its variance. */
static void make_cell(const gnoi_image *image, int l, int x, int y)
{
    const gnoi_image_level *level = &image->level[l], *below = &image->level[l - 1];
    size_t at = (size_t)y * (size_t)level->width + (size_t)x;
    int columns = 2 * x + 1 < below->width ? 2 : 1, rows = 2 * y + 1 < below->height ? 2 : 1;
    float value[4][4], variance[4], weight[4], total = 0, inner = 0, outer[4] = {0, 0, 0, 0};
    for (int c = 0; c < 4; c++) {
        int i = 2 * x + c % 2, j = 2 * y + c / 2, is_there = c % 2 < columns && c / 2 < rows;
        i = is_there ? i : 2 * x;
        j = is_there ? j : 2 * y;
        gnoi_image_value(image, l - 1, i, j, value[c]);
        variance[c] = below->variance ? below->variance[(size_t)j * (size_t)below->width + (size_t)i] : 0;
        weight[c] = is_there ? (float)side(image->width, l - 1, i) * (float)side(image->height, l - 1, j) : 0;
        total += weight[c];
    }
    for (int k = 0; k < 4; k++)
        level->mean[at][k] = (weight[0] * value[0][k] + weight[1] * value[1][k] + weight[2] * value[2][k] + weight[3] * value[3][k]) / total;
    for (int c = 0; c < 4; c++) {
        inner += weight[c] * variance[c];
        for (int k = 0; k < 4; k++) {
            float off = value[c][k] - level->mean[at][k];
            outer[k] += weight[c] * off * off;
        }
    }
    level->variance[at] = (inner + larger(larger(outer[0], outer[1]), larger(outer[2], outer[3]))) / total;
}


/* The same for one with four children of one size. */
static inline void make_whole_cell(float value[4][4], const float variance[4], float mean[4], float *own)
{
    float outer[4], inner;
    for (int k = 0; k < 4; k++)
        mean[k] = (value[0][k] + value[1][k] + value[2][k] + value[3][k]) * 0.25f;
    for (int k = 0; k < 4; k++) {
        float a = value[0][k] - mean[k], b = value[1][k] - mean[k], c = value[2][k] - mean[k], d = value[3][k] - mean[k];
        outer[k] = (a * a + b * b) + (c * c + d * d);
    }
    inner = (variance[0] + variance[1]) + (variance[2] + variance[3]);
    *own = (inner + larger(larger(outer[0], outer[1]), larger(outer[2], outer[3]))) * 0.25f;
}

/* The first cells of row y of level l: as many of them as have four children of one size, whose number is returned. */
static int make_whole_cells(const gnoi_image *image, int l, int y)
{
    const gnoi_image_level *level = &image->level[l], *below = &image->level[l - 1];
    size_t wide = (size_t)below->width, to = (size_t)y * (size_t)level->width, from = 2 * (size_t)y * wide;
    int count = (y + 1) << l <= image->height ? image->width >> l : 0;
    for (int x = 0; x < count; x++, to++, from += 2) {
        float value[4][4], variance[4] = {0, 0, 0, 0};
        gnoi_image_value(image, l - 1, 2 * x, 2 * y, value[0]);
        gnoi_image_value(image, l - 1, 2 * x + 1, 2 * y, value[1]);
        gnoi_image_value(image, l - 1, 2 * x, 2 * y + 1, value[2]);
        gnoi_image_value(image, l - 1, 2 * x + 1, 2 * y + 1, value[3]);
        if (below->variance) {
            variance[0] = below->variance[from];
            variance[1] = below->variance[from + 1];
            variance[2] = below->variance[from + wide];
            variance[3] = below->variance[from + wide + 1];
        }
        make_whole_cell(value, variance, level->mean[to], &level->variance[to]);
    }
    return count;
}

gno_status gnoi_image_make(gno_context *context, const gno_pixels *pixels, gnoi_image *image)
{
    memset(image, 0, sizeof *image);
    if (!allocate(context, pixels, image)) {
        gnoi_image_free(context, image);
        return GNO_ERROR_MEMORY;
    }
    if (pixels->bytes)
        copy_bytes(pixels, image);
    else
        copy_floats(pixels, image);
    image->is_solid = image->bytes && !image->has_alpha;
    for (int l = 1; l < image->level_count; l++)
        for (int y = 0; y < image->level[l].height; y++)
            for (int x = make_whole_cells(image, l, y); x < image->level[l].width; x++)
                make_cell(image, l, x, y);
    return GNO_OK;
}

gno_status gnoi_image_make_heights(gno_context *context, gnoi_image *image)
{
    float *heights[GNOI_IMAGE_LEVELS];
    int count = 0;
    if (image->level[0].height_of)
        return GNO_OK;
    for (; count < image->level_count; count++) {
        const gnoi_image_level *level = &image->level[count];
        heights[count] = gnoi_malloc(context, (size_t)level->width * (size_t)level->height, sizeof *heights[count]);
        if (!heights[count])
            break;
    }
    for (int l = 0; l < count && count < image->level_count; l++)
        gnoi_free(context, heights[l], (size_t)image->level[l].width * (size_t)image->level[l].height, sizeof *heights[l]);
    if (count < image->level_count)
        return GNO_ERROR_MEMORY;
    for (int l = 0; l < count; l++) {
        gnoi_image_level *level = &image->level[l];
        level->height_of = heights[l];
        for (int y = 0; y < level->height; y++)
            for (int x = 0; x < level->width; x++) {
                float v[4];
                gnoi_image_value(image, l, x, y, v);
                level->height_of[(size_t)y * (size_t)level->width + (size_t)x] = (v[0] + v[1] + v[2]) / 3;
            }
    }
    return GNO_OK;
}
