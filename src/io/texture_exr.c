/* texture_exr.c -- OpenEXR pictures for textures, through OpenEXRCore. Place: see texture_file.h.
 *
 * The first part's channels R, G, B and A, or Y alone for grey, of half, float or whole numbers, in scan lines or tiles (of these the
 * finest level). OpenEXR keeps colours multiplied by alpha; here they are wanted without.
 */
#include "io/texture_file.h"

#include <OpenEXR/openexr.h>
#include <stdio.h>
#include <string.h>

typedef struct decoder {
    gnoi_raster *raster;
    exr_context_t exr;
    exr_decode_pipeline_t pipeline;
    int begun;        /* the pipeline is */
    int left, top;    /* of the data window */
    int is_grey;
    float *unwanted;  /* a line for the channels that no one asks for: OpenEXRCore 3.1 writes through their null pointers */
    size_t unwanted_width;
    char message[200];
} decoder;

static void on_error(exr_const_context_t exr, exr_result_t code, const char *text)
{
    void *user = NULL;
    (void)code;
    if (exr != NULL && exr_get_user_data(exr, &user) == EXR_ERR_SUCCESS && user != NULL) {
        decoder *d = user;
        if (d->message[0] == '\0') strncpy(d->message, text, sizeof d->message - 1);
    }
}

/* The raster's channel that a file's channel goes to, -1: none. */
static int place_of(const decoder *d, const char *name)
{
    static const char names[] = "RGBA";
    const char *found = name[0] && !name[1] ? strchr(names, name[0]) : NULL;
    if (d->is_grey) return strcmp(name, "Y") == 0 ? 0 : strcmp(name, "A") == 0 ? d->raster->channels - 1 : -1;
    return found && found - names < d->raster->channels ? (int)(found - names) : -1;
}

static exr_result_t find_channels(decoder *d)
{
    const exr_attr_chlist_t *list = NULL;
    int has_colour = 0, has_grey = 0, has_alpha = 0;
    exr_result_t result = exr_get_channels(d->exr, 0, &list);
    if (result != EXR_ERR_SUCCESS) return result;
    for (int i = 0; i < list->num_channels; i++) {
        const char *name = list->entries[i].name.str;
        has_colour |= strcmp(name, "R") == 0 || strcmp(name, "G") == 0 || strcmp(name, "B") == 0;
        has_grey |= strcmp(name, "Y") == 0;
        has_alpha |= strcmp(name, "A") == 0;
    }
    if (!has_colour && !has_grey) {
        snprintf(d->message, sizeof d->message, "no channels R, G, B or Y");
        return EXR_ERR_INVALID_ARGUMENT;
    }
    d->is_grey = !has_colour;
    d->raster->channels = (has_colour ? 3 : 1) + has_alpha;
    return EXR_ERR_SUCCESS;
}

/* Room for a line of a channel that is not wanted; NULL without memory. */
static float *unwanted_line(decoder *d, size_t width)
{
    if (width > d->unwanted_width) {
        float *grown = gno_context_realloc(d->raster->context, d->unwanted, d->unwanted_width * sizeof *grown, width * sizeof *grown);
        if (!grown) return NULL;
        d->unwanted = grown;
        d->unwanted_width = width;
    }
    return d->unwanted;
}

/* Where a channel goes: into the raster from (x,y) on, or every line into the same one. 0 without memory. */
static int set_target(decoder *d, exr_coding_channel_info_t *c, int x, int y)
{
    gnoi_raster *r = d->raster;
    int place = place_of(d, c->channel_name), wanted = place >= 0;
    float *to = wanted ? r->linear + ((size_t)y * (size_t)r->width + (size_t)x) * (size_t)r->channels + place
                       : unwanted_line(d, (size_t)c->width);
    c->decode_to_ptr = (uint8_t *)(void *)to;
    c->user_pixel_stride = (int32_t)((size_t)(wanted ? r->channels : 1) * sizeof(float));
    c->user_line_stride = wanted ? (int32_t)((size_t)r->channels * sizeof(float) * (size_t)r->width) : 0;
    c->user_bytes_per_element = sizeof(float);
    c->user_data_type = EXR_PIXEL_FLOAT;
    return to != NULL;
}

/* Decodes the chunk at hand; (x,y) is its first pixel in the raster. */
static exr_result_t decode_chunk(decoder *d, const exr_chunk_info_t *chunk, int x, int y)
{
    exr_result_t result = d->begun ? exr_decoding_update(d->exr, 0, chunk, &d->pipeline)
                                   : exr_decoding_initialize(d->exr, 0, chunk, &d->pipeline);
    int first = !d->begun;
    if (result != EXR_ERR_SUCCESS) return result;
    d->begun = 1;
    for (int i = 0; i < d->pipeline.channel_count; i++) {
        exr_coding_channel_info_t *c = &d->pipeline.channels[i];
        c->decode_to_ptr = NULL;
        if (c->x_samples != 1 || c->y_samples != 1) return EXR_ERR_FEATURE_NOT_IMPLEMENTED;
        if (c->height > 0 && c->width > 0 && !set_target(d, c, x, y)) return EXR_ERR_OUT_OF_MEMORY;
    }
    if (first) result = exr_decoding_choose_default_routines(d->exr, 0, &d->pipeline);
    return result == EXR_ERR_SUCCESS ? exr_decoding_run(d->exr, 0, &d->pipeline) : result;
}

static exr_result_t decode_lines(decoder *d)
{
    int32_t rows = 0;
    exr_result_t result = exr_get_scanlines_per_chunk(d->exr, 0, &rows);
    for (int y = 0; y < d->raster->height && result == EXR_ERR_SUCCESS; y += rows) {
        exr_chunk_info_t chunk;
        result = exr_read_scanline_chunk_info(d->exr, 0, d->top + y, &chunk);
        if (result == EXR_ERR_SUCCESS) result = decode_chunk(d, &chunk, 0, y);
    }
    return result;
}

static exr_result_t decode_tiles(decoder *d)
{
    int32_t width = 0, height = 0;
    exr_result_t result = exr_get_tile_sizes(d->exr, 0, 0, 0, &width, &height);
    if (result == EXR_ERR_SUCCESS && (width < 1 || height < 1)) result = EXR_ERR_INVALID_ATTR;
    for (int ty = 0; result == EXR_ERR_SUCCESS && ty * height < d->raster->height; ty++)
        for (int tx = 0; result == EXR_ERR_SUCCESS && tx * width < d->raster->width; tx++) {
            exr_chunk_info_t chunk;
            result = exr_read_tile_chunk_info(d->exr, 0, tx, ty, 0, 0, &chunk);
            if (result == EXR_ERR_SUCCESS) result = decode_chunk(d, &chunk, tx * width, ty * height);
        }
    return result;
}

static void divide_by_alpha(gnoi_raster *r)
{
    size_t count = (size_t)r->width * (size_t)r->height;
    for (size_t i = 0; i < count && r->channels % 2 == 0; i++) {
        float *v = r->linear + i * (size_t)r->channels, alpha = v[r->channels - 1];
        for (int k = 0; k + 1 < r->channels; k++) v[k] = alpha > 0 ? v[k] / alpha : 0;
    }
}

static gno_status read_part(decoder *d, exr_result_t *result, char reason[GNOI_TEXTURE_REASON])
{
    exr_attr_box2i_t window;
    exr_storage_t storage;
    gnoi_raster *r = d->raster;
    *result = exr_get_data_window(d->exr, 0, &window);
    if (*result == EXR_ERR_SUCCESS) *result = exr_get_storage(d->exr, 0, &storage);
    if (*result == EXR_ERR_SUCCESS) *result = find_channels(d);
    if (*result != EXR_ERR_SUCCESS) return GNO_OK;
    if (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED) {
        snprintf(reason, GNOI_TEXTURE_REASON, "deep EXR pictures are not read");
        return GNO_ERROR_INPUT;
    }
    int64_t width = (int64_t)window.max.x - window.min.x + 1, height = (int64_t)window.max.y - window.min.y + 1;
    r->width = width > 0 && width <= GNO_MAX_IMAGE_SIDE ? (int)width : -1;
    r->height = height > 0 && height <= GNO_MAX_IMAGE_SIDE ? (int)height : -1;
    d->left = window.min.x;
    d->top = window.min.y;
    gno_status status = gnoi_raster_allocate(r, 1, reason);
    if (status != GNO_OK) return status;
    memset(r->linear, 0, (size_t)r->width * (size_t)r->height * (size_t)r->channels * sizeof *r->linear);
    *result = storage == EXR_STORAGE_TILED ? decode_tiles(d) : decode_lines(d);
    divide_by_alpha(r);
    return GNO_OK;
}

gno_status gnoi_raster_exr(gnoi_raster *r, const char *path, char reason[GNOI_TEXTURE_REASON])
{
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    decoder d;
    gno_status status = GNO_OK;
    memset(&d, 0, sizeof d);
    d.raster = r;
    setup.error_handler_fn = on_error;
    setup.user_data = &d;
    exr_result_t result = exr_start_read(&d.exr, path, &setup);
    if (result == EXR_ERR_SUCCESS) status = read_part(&d, &result, reason);
    exr_decoding_destroy(d.exr, &d.pipeline);
    exr_finish(&d.exr);
    if (d.unwanted) gno_context_realloc(r->context, d.unwanted, d.unwanted_width * sizeof *d.unwanted, 0);
    if (status == GNO_OK && result == EXR_ERR_OUT_OF_MEMORY) status = GNO_ERROR_MEMORY;
    if (status == GNO_OK && result != EXR_ERR_SUCCESS) {
        snprintf(reason, GNOI_TEXTURE_REASON, "cannot read %.200s: %.150s", path,
                 d.message[0] ? d.message : exr_get_default_error_message(result));
        status = GNO_ERROR_INPUT;
    }
    return status;
}
