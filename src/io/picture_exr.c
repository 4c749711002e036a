/* picture_exr.c -- OpenEXR, linear R, G, B as half or float, scan lines in ZIP blocks.
 *
 * Place: encoder under picture.c, through OpenEXRCore (the C part of OpenEXR). OpenEXRCore seeks back at the end to write
 * its table of blocks, and its exr_finish reports success even for an unfinished file; therefore writing goes through our own
 * callback, whose errors stay in the file.
 */
#include "io/picture.h"

#include <OpenEXR/openexr.h>
#include <stdio.h>
#include <string.h>

/* Values beyond half's range would become infinite, which spreads to whole neighbourhoods in every later filter. */
#define HALF_LARGEST 65504.0

typedef struct encoder {
    const gnoi_picture *picture;
    gnoi_file *file;
    exr_context_t exr;
    exr_encode_pipeline_t pipeline;
    int part;
    float *block; /* the rows of one chunk, interleaved, after exposure */
    char message[200];
} encoder;

static int64_t on_write(exr_const_context_t exr, void *user, const void *data, uint64_t size, uint64_t offset, exr_stream_error_func_ptr_t error)
{
    encoder *e = user;
    (void)exr;
    (void)error;
    return gnoi_file_write_at(e->file, data, (size_t)size, offset) ? (int64_t)size : -1;
}

/* The context is NULL when it could not even be made; OpenEXRCore's return code then has to do for a message. */
static void on_error(exr_const_context_t exr, exr_result_t code, const char *text)
{
    void *user = NULL;
    (void)code;
    if (exr != NULL && exr_get_user_data(exr, &user) == EXR_ERR_SUCCESS && user != NULL) {
        encoder *e = user;
        if (e->message[0] == '\0') {
            strncpy(e->message, text, sizeof e->message - 1);
        }
    }
}

static void fill_block(encoder *e, int first, int rows)
{
    const float *source = gnoi_picture_row(e->picture, first);
    const size_t values = (size_t)rows * (size_t)e->picture->width * 3;
    const double exposure = e->picture->exposure;
    if (e->picture->depth == 32) {
        for (size_t i = 0; i < values; i++) {
            e->block[i] = (float)(source[i] * exposure);
        }
        return;
    }
    for (size_t i = 0; i < values; i++) {
        const double value = source[i] * exposure;
        e->block[i] = (float)(value > HALF_LARGEST ? HALF_LARGEST : value < -HALF_LARGEST ? -HALF_LARGEST : value);
    }
}

/* Channels come sorted by name, so the offset into the triple follows from the name. */
static void point_channels(encoder *e)
{
    for (int c = 0; c < e->pipeline.channel_count; c++) {
        exr_coding_channel_info_t *channel = &e->pipeline.channels[c];
        const int offset = channel->channel_name[0] == 'R' ? 0 : channel->channel_name[0] == 'G' ? 1 : 2;
        channel->encode_from_ptr = (const uint8_t *)(e->block + offset);
        channel->user_pixel_stride = 3 * (int)sizeof(float);
        channel->user_line_stride = e->picture->width * 3 * (int)sizeof(float);
        channel->user_bytes_per_element = sizeof(float);
        channel->user_data_type = EXR_PIXEL_FLOAT;
    }
}

static exr_result_t start(encoder *e)
{
    static const char *const names[] = {"R", "G", "B"};
    const exr_pixel_type_t type = e->picture->depth == 32 ? EXR_PIXEL_FLOAT : EXR_PIXEL_HALF;
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.user_data = e;
    init.error_handler_fn = on_error;
    init.write_fn = on_write;
    init.zip_level = 4; /* what later versions of OpenEXR do by default: half the time of level 6, 10 % more bytes */
    exr_result_t result = exr_start_write(&e->exr, e->file->path, EXR_WRITE_FILE_DIRECTLY, &init);
    if (result == EXR_ERR_SUCCESS) {
        result = exr_add_part(e->exr, "rgb", EXR_STORAGE_SCANLINE, &e->part);
    }
    if (result == EXR_ERR_SUCCESS) {
        result = exr_initialize_required_attr_simple(e->exr, e->part, e->picture->width, e->picture->height, EXR_COMPRESSION_ZIP);
    }
    for (int c = 0; c < 3 && result == EXR_ERR_SUCCESS; c++) {
        result = exr_add_channel(e->exr, e->part, names[c], type, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    }
    return result == EXR_ERR_SUCCESS ? exr_write_header(e->exr) : result;
}

static exr_result_t write_blocks(encoder *e, int rows)
{
    exr_result_t result = EXR_ERR_SUCCESS;
    const int height = e->picture->height;
    for (int y = 0; y < height && result == EXR_ERR_SUCCESS; y += rows) {
        exr_chunk_info_t chunk;
        result = exr_write_scanline_chunk_info(e->exr, e->part, y, &chunk);
        if (result == EXR_ERR_SUCCESS) {
            result = y == 0 ? exr_encoding_initialize(e->exr, e->part, &chunk, &e->pipeline)
                            : exr_encoding_update(e->exr, e->part, &chunk, &e->pipeline);
        }
        if (result == EXR_ERR_SUCCESS) {
            fill_block(e, y, rows < height - y ? rows : height - y);
            point_channels(e);
            result = y == 0 ? exr_encoding_choose_default_routines(e->exr, e->part, &e->pipeline) : EXR_ERR_SUCCESS;
        }
        if (result == EXR_ERR_SUCCESS) {
            result = exr_encoding_run(e->exr, e->part, &e->pipeline);
        }
    }
    return result;
}

gno_status gnoi_picture_exr(const gnoi_picture *picture, gnoi_file *file)
{
    encoder e;
    memset(&e, 0, sizeof e);
    e.picture = picture;
    e.file = file;
    int32_t rows = 0;
    size_t bytes = 0;
    exr_result_t result = start(&e);
    if (result == EXR_ERR_SUCCESS) {
        result = exr_get_scanlines_per_chunk(e.exr, e.part, &rows);
    }
    if (result == EXR_ERR_SUCCESS) {
        bytes = (size_t)rows * (size_t)picture->width * 3 * sizeof(float);
        e.block = gno_context_realloc(file->context, NULL, 0, bytes);
        result = e.block != NULL ? write_blocks(&e, rows) : EXR_ERR_OUT_OF_MEMORY;
    }
    exr_encoding_destroy(e.exr, &e.pipeline);
    const exr_result_t finished = exr_finish(&e.exr);
    if (e.block != NULL) {
        gno_context_realloc(file->context, e.block, bytes, 0);
    }
    if (result == EXR_ERR_SUCCESS) {
        result = finished;
    }
    if (result == EXR_ERR_SUCCESS || file->error != 0) {
        return GNO_OK;
    }
    char text[300];
    snprintf(text, sizeof text, "EXR: %s", e.message[0] != '\0' ? e.message : exr_get_error_code_as_string(result));
    return gno_context_fail(file->context, result == EXR_ERR_OUT_OF_MEMORY ? GNO_ERROR_MEMORY : GNO_ERROR_FILE, text);
}
