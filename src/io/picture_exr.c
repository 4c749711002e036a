/* picture_exr.c -- OpenEXR, linear R, G, B as half or float and any further channels in 32 bits, scan lines in ZIP blocks.
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

#define SHORT_NAME 31

typedef struct encoder {
    const gnoi_picture *picture;
    gnoi_file *file;
    exr_context_t exr;
    exr_encode_pipeline_t pipeline;
    int part;
    int rows;     /* of a chunk */
    float *block; /* the rows of one chunk: R, G, B interleaved, after exposure, then the further channels one after the other */
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

static float *channel_block(const encoder *e, size_t index)
{
    return e->block + (3 + index) * (size_t)e->rows * (size_t)e->picture->width;
}

/* The rows of one further channel; numbers without a table keep their bits. */
static void fill_channel(encoder *e, size_t index, int first, int rows)
{
    const gnoi_channel *c = &e->picture->channels[index];
    const size_t values = (size_t)rows * (size_t)e->picture->width, start = (size_t)first * (size_t)e->picture->width;
    const float *reals = c->values;
    const unsigned *numbers = c->values;
    float *out = channel_block(e, index);
    for (size_t i = 0; i < values; i++) {
        const size_t at = (start + i) * c->step;
        if (c->table != NULL) {
            out[i] = numbers[at] == GNO_BACKGROUND ? 0 : c->table[numbers[at]];
        } else if (c->is_number) {
            memcpy(&out[i], &numbers[at], sizeof out[i]);
        } else {
            out[i] = reals[at];
        }
    }
}

static void fill_block(encoder *e, int first, int rows)
{
    const float *source = gnoi_picture_row(e->picture, first);
    const size_t values = (size_t)rows * (size_t)e->picture->width * 3;
    const double exposure = e->picture->exposure;
    for (size_t i = 0; i < e->picture->channel_count; i++) {
        fill_channel(e, i, first, rows);
    }
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

static void point_channel(const encoder *e, exr_coding_channel_info_t *channel)
{
    static const char letters[] = "RGB";
    const char *letter = channel->channel_name[1] == '\0' ? strchr(letters, channel->channel_name[0]) : NULL;
    size_t step = 1, i = 0;
    const float *from;
    if (letter != NULL) {
        from = e->block + (letter - letters);
        step = 3;
    } else {
        while (strcmp(e->picture->channels[i].name, channel->channel_name) != 0) {
            i++;
        }
        from = channel_block(e, i);
    }
    channel->encode_from_ptr = (const uint8_t *)from;
    channel->user_pixel_stride = (int)(step * sizeof(float));
    channel->user_line_stride = (int)((size_t)e->picture->width * step * sizeof(float));
    channel->user_bytes_per_element = sizeof(float);
    channel->user_data_type = letter == NULL && channel->data_type == EXR_PIXEL_UINT ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
}

/* Channels come sorted by name. */
static void point_channels(encoder *e)
{
    for (int c = 0; c < e->pipeline.channel_count; c++) {
        point_channel(e, &e->pipeline.channels[c]);
    }
}

/* Names of channels and entries of the head may be longer than the 31 letters that old readers allow; then the file says so. */
static exr_result_t add_further(encoder *e)
{
    exr_result_t result = EXR_ERR_SUCCESS;
    for (size_t i = 0; i < e->picture->channel_count && result == EXR_ERR_SUCCESS; i++) {
        if (strlen(e->picture->channels[i].name) > SHORT_NAME) {
            result = exr_set_longname_support(e->exr, 1);
        }
    }
    for (size_t i = 0; i < e->picture->channel_count && result == EXR_ERR_SUCCESS; i++) {
        const gnoi_channel *c = &e->picture->channels[i];
        const exr_pixel_type_t type = c->is_number && c->table == NULL ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
        result = exr_add_channel(e->exr, e->part, c->name, type, EXR_PERCEPTUALLY_LINEAR, 1, 1);
    }
    for (size_t i = 0; i < e->picture->note_count && result == EXR_ERR_SUCCESS; i++) {
        result = exr_attr_set_string(e->exr, e->part, e->picture->notes[i].name, e->picture->notes[i].text);
    }
    return result;
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
    if (result == EXR_ERR_SUCCESS) {
        result = add_further(e);
    }
    return result == EXR_ERR_SUCCESS ? exr_write_header(e->exr) : result;
}

static exr_result_t write_blocks(encoder *e, int rows)
{
    exr_result_t result = EXR_ERR_SUCCESS;
    const int height = e->picture->height;
    for (int y = 0; y < height && result == EXR_ERR_SUCCESS && gnoi_file_go_on(e->file, (double)y / height); y += rows) {
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
        e.rows = rows;
        bytes = (size_t)rows * (size_t)picture->width * (3 + picture->channel_count) * sizeof(float);
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
