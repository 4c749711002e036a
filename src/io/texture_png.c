/* texture_png.c -- PNG pictures for textures, through libpng's simplified interface. Place: see texture_file.h.
 *
 * 8 bits stay bytes; 16 bits become linear floats. A palette, grey or transparent colour becomes RGB or RGB with alpha.
 */
#include "io/texture_file.h"

#include <png.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

static gno_status fail(png_image *png, const char *path, char reason[GNOI_TEXTURE_REASON])
{
    snprintf(reason, GNOI_TEXTURE_REASON, "cannot read %.250s: %.100s", path, png->message);
    png_image_free(png);
    return strstr(png->message, "memory") ? GNO_ERROR_MEMORY : GNO_ERROR_INPUT;
}

/* libpng multiplies linear values by their alpha; here they are wanted without. */
static void to_floats(const uint16_t *values, gnoi_raster *r)
{
    size_t count = (size_t)r->width * (size_t)r->height;
    for (size_t i = 0; i < count; i++) {
        double alpha = r->channels == 4 ? values[4 * i + 3] / 65535.0 : 1;
        for (int k = 0; k < r->channels; k++) {
            size_t at = i * (size_t)r->channels + (size_t)k;
            double v = values[at] / 65535.0;
            r->linear[at] = (float)(k == 3 ? alpha : alpha > 0 ? v / alpha : 0);
        }
    }
}

static gno_status read_deep(png_image *png, gnoi_raster *r, const char *path, int is_colour, char reason[GNOI_TEXTURE_REASON])
{
    gno_status status = gnoi_raster_allocate(r, 1, reason);
    size_t size = (size_t)r->width * (size_t)r->height * (size_t)r->channels * sizeof(uint16_t);
    uint16_t *values = status == GNO_OK ? gno_context_realloc(r->context, NULL, 0, size) : NULL;
    if (!values) {
        png_image_free(png);
        return status == GNO_OK ? GNO_ERROR_MEMORY : status;
    }
    png->format = r->channels == 4 ? PNG_FORMAT_LINEAR_RGB_ALPHA : PNG_FORMAT_LINEAR_RGB;
    if (is_colour) png->flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
    if (png_image_finish_read(png, NULL, values, 0, NULL)) to_floats(values, r);
    else status = fail(png, path, reason);
    gno_context_realloc(r->context, values, size, 0);
    return status;
}

gno_status gnoi_raster_png(gnoi_raster *r, const char *path, const void *data, size_t size, int is_colour,
                           char reason[GNOI_TEXTURE_REASON])
{
    png_image png;
    memset(&png, 0, sizeof png);
    png.version = PNG_IMAGE_VERSION;
    int begun = data ? png_image_begin_read_from_memory(&png, data, size) : png_image_begin_read_from_file(&png, path);
    if (!begun) return fail(&png, path, reason);
    r->width = png.width > GNO_MAX_IMAGE_SIDE ? GNO_MAX_IMAGE_SIDE + 1 : (int)png.width;
    r->height = png.height > GNO_MAX_IMAGE_SIDE ? GNO_MAX_IMAGE_SIDE + 1 : (int)png.height;
    r->channels = png.format & PNG_FORMAT_FLAG_ALPHA ? 4 : 3;
    if (png.format & PNG_FORMAT_FLAG_LINEAR) return read_deep(&png, r, path, is_colour, reason);
    gno_status status = gnoi_raster_allocate(r, 0, reason);
    if (status != GNO_OK) {
        png_image_free(&png);
        return status;
    }
    png.format = r->channels == 4 ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
    return png_image_finish_read(&png, NULL, r->bytes, 0, NULL) ? GNO_OK : fail(&png, path, reason);
}
