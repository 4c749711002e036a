/* picture.c -- gno_picture_write: linear RGB to a file.
 *
 * Place: end of the data flow: image -> (checks here) -> encoder by format -> atomic_file -> disk.
 */
#include "io/picture.h"

#include "io/file_name.h"

#include <gnomon/gnomon_io.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef gno_status (*encode_fn)(const gnoi_picture *picture, gnoi_file *file);

typedef struct format {
    gno_picture_format id;
    const char *name, *extension;
    int depths[2]; /* the default first; 0: no other */
    const char *depth_text;
    int seeks;
    encode_fn encode;
} format;

static const format formats[] = {
    {GNO_FORMAT_PNG, "PNG", ".png", {8, 16}, "8 or 16", 0, gnoi_picture_png},
    {GNO_FORMAT_EXR, "EXR", ".exr", {16, 32}, "16 or 32", 1, gnoi_picture_exr},
    {GNO_FORMAT_PFM, "PFM", ".pfm", {32, 0}, "32", 0, gnoi_picture_pfm},
};

enum { FORMATS = sizeof formats / sizeof formats[0] };

gno_picture_def gno_picture_def_default(void)
{
    const gno_picture_def def = {GNO_FORMAT_AUTO, GNO_DEPTH_DEFAULT, 1.0};
    return def;
}

static const format *find_format(const char *path, gno_picture_format id)
{
    if (id == GNO_FORMAT_AUTO && strcmp(path, "-") == 0) {
        id = GNO_FORMAT_PNG;
    }
    for (int i = 0; i < FORMATS; i++) {
        if (id != GNO_FORMAT_AUTO ? formats[i].id == id : gnoi_has_extension(path, formats[i].extension)) {
            return &formats[i];
        }
    }
    return NULL;
}

static gno_status refuse(gno_context *context, const char *path, const char *what)
{
    char text[512];
    snprintf(text, sizeof text, "%.300s: %s", path, what);
    return gno_context_fail(context, GNO_ERROR_ARGUMENT, text);
}

static gno_status check(gno_context *context, const char *path, const gno_picture_def *def, const format *chosen,
                        const gnoi_picture *picture)
{
    char text[200];
    if (chosen == NULL) {
        return refuse(context, path, "the extension is not one of .png, .exr, .pfm");
    }
    if (picture->width < 1 || picture->height < 1 || picture->width > GNO_MAX_IMAGE_SIDE || picture->height > GNO_MAX_IMAGE_SIDE) {
        snprintf(text, sizeof text, "a picture of %d x %d is not between 1 x 1 and %d x %d", picture->width, picture->height,
                 GNO_MAX_IMAGE_SIDE, GNO_MAX_IMAGE_SIDE);
        return refuse(context, path, text);
    }
    if (def->depth != GNO_DEPTH_DEFAULT && (int)def->depth != chosen->depths[0] && (int)def->depth != chosen->depths[1]) {
        snprintf(text, sizeof text, "%s has no depth of %d bits, only of %s", chosen->name, (int)def->depth, chosen->depth_text);
        return refuse(context, path, text);
    }
    if (!(def->exposure >= 0.0) || isinf(def->exposure)) {
        return refuse(context, path, "the exposure must be a number, 0 or more");
    }
    if (picture->channel_count > 0 && chosen->id != GNO_FORMAT_EXR) {
        return refuse(context, path, "layers need an .exr file");
    }
    return GNO_OK;
}

gno_status gnoi_picture_write(gno_context *context, const char *path, const gno_picture_def *def, const gnoi_picture *given)
{
    const gno_picture_def used = def != NULL ? *def : gno_picture_def_default();
    const format *chosen = find_format(path, used.format);
    gnoi_picture picture = *given;
    gnoi_file file;
    gno_status status = check(context, path, &used, chosen, given);
    if (status != GNO_OK) {
        return status;
    }
    picture.depth = used.depth == GNO_DEPTH_DEFAULT ? chosen->depths[0] : (int)used.depth;
    picture.exposure = used.exposure;
    status = gnoi_file_open(context, path, chosen->seeks, &file);
    if (status != GNO_OK) {
        return status;
    }
    status = chosen->encode(&picture, &file);
    if (status != GNO_OK && file.error == 0) {
        gnoi_file_discard(&file);
        return status;
    }
    return gnoi_file_commit(&file);
}

gno_status gno_picture_write(gno_context *context, const char *path, const gno_picture_def *def, int width, int height, const float *rgb)
{
    gnoi_picture picture;
    if (context == NULL) {
        return GNO_ERROR_ARGUMENT;
    }
    if (path == NULL || rgb == NULL) {
        return gno_context_fail(context, GNO_ERROR_ARGUMENT, "gno_picture_write: path and rgb must be given");
    }
    memset(&picture, 0, sizeof picture);
    picture.rgb = rgb;
    picture.width = width;
    picture.height = height;
    return gnoi_picture_write(context, path, def, &picture);
}
