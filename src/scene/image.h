/* image.h -- pictures for textures, with prefiltered levels.
 *
 * Place in the data flow: gno_scene_add_image -> gnoi_image, kept by the scene -> filter.h, bump.
 * A value has four channels, linear, red, green and blue multiplied by alpha, so that sums of values are sums of light.
 * A cell of level l holds the mean of 2^l x 2^l elements of the picture, of fewer at its right and lower end; the last level is one
 * cell. Rows run from the picture's bottom up, as T does.
 * Invariant: a cell's variance is at least the mean square of what the elements under it differ from its mean by, in any channel. So no part of
 * the cell, however it is cut out, is off by more than half of the root of that times the cell's area (Cauchy-Schwarz).
 */
#ifndef GNOI_SCENE_IMAGE_H
#define GNOI_SCENE_IMAGE_H

#include "base/context.h"

#define GNOI_IMAGE_LEVELS 18 /* of a picture of GNO_MAX_IMAGE_SIDE */

typedef struct gnoi_image_level {
    int width, height; /* cells */
    float (*mean)[4];  /* NULL on level 0 of a picture of bytes */
    float *variance;     /* NULL on level 0, where it is zero */
    float *height_of;  /* means of red, green and blue; NULL until gnoi_image_make_heights */
} gnoi_image_level;

typedef struct gnoi_image {
    int width, height;
    int has_alpha;          /* some element is not solid */
    int is_solid;           /* given in bytes and without alpha */
    unsigned char (*bytes)[4]; /* level 0 of a picture given in bytes; else NULL */
    float *decode;          /* 256 values of a byte, for red, green and blue */
    int level_count;
    gnoi_image_level level[GNOI_IMAGE_LEVELS];
} gnoi_image;

/* Returns MEMORY with everything freed. The pixels have been checked. */
gno_status gnoi_image_make(gno_context *context, const gno_pixels *pixels, gnoi_image *image);
/* Adds heights for bumps to every level, if they are not there yet. Returns MEMORY with the image as it was. */
gno_status gnoi_image_make_heights(gno_context *context, gnoi_image *image);
void gnoi_image_free(gno_context *context, gnoi_image *image);

/* One value; row and column in range. */
static inline void gnoi_image_value(const gnoi_image *image, int level, int column, int row, float value[4])
{
    size_t at = (size_t)row * (size_t)image->level[level].width + (size_t)column;
    if (level > 0 || !image->bytes) {
        const float *m = image->level[level].mean[at];
        value[0] = m[0];
        value[1] = m[1];
        value[2] = m[2];
        value[3] = m[3];
    } else {
        const unsigned char *b = image->bytes[at];
        float alpha = image->has_alpha ? (float)b[3] * (1.0f / 255.0f) : 1;
        value[0] = image->decode[b[0]] * alpha;
        value[1] = image->decode[b[1]] * alpha;
        value[2] = image->decode[b[2]] * alpha;
        value[3] = alpha;
    }
}

#endif
