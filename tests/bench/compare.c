/* compare.c -- the RMS difference of two pictures, each a PFM or an OpenEXR file, over all pixels and channels.
 *
 * usage: compare A B      prints "RMS MAX PIXELS", PIXELS being those that differ by more than 0.02 in a channel
 * Exit status 0: compared, 1: a file cannot be read or the sizes differ, 2: usage.
 */
#include <OpenEXR/openexr.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/compare.h"

typedef struct reader {
    exr_context_t exr;
    exr_decode_pipeline_t pipeline;
    int started; /* the pipeline is set up */
    int width, height, top;
    float *rgb;
} reader;

static exr_result_t open_picture(reader *r, const char *path)
{
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_attr_box2i_t window;
    exr_result_t code = exr_start_read(&r->exr, path, &init);
    if (code == EXR_ERR_SUCCESS) code = exr_get_data_window(r->exr, 0, &window);
    if (code != EXR_ERR_SUCCESS) return code;
    r->top = window.min.y;
    r->width = window.max.x - window.min.x + 1;
    r->height = window.max.y - window.min.y + 1;
    r->rgb = calloc((size_t)r->width * (size_t)r->height * 3, sizeof *r->rgb);
    return r->rgb ? EXR_ERR_SUCCESS : EXR_ERR_OUT_OF_MEMORY;
}

/* The rows of one chunk; the channels' places in the triple follow from their names, others are left out. */
static exr_result_t read_chunk(reader *r, int y)
{
    exr_chunk_info_t chunk;
    exr_result_t code = exr_read_scanline_chunk_info(r->exr, 0, y, &chunk);
    if (code != EXR_ERR_SUCCESS) return code;
    code = r->started ? exr_decoding_update(r->exr, 0, &chunk, &r->pipeline) : exr_decoding_initialize(r->exr, 0, &chunk, &r->pipeline);
    if (code != EXR_ERR_SUCCESS) return code;
    for (int c = 0; c < r->pipeline.channel_count; c++) {
        exr_coding_channel_info_t *channel = &r->pipeline.channels[c];
        const char *place = channel->channel_name[0] && !channel->channel_name[1] ? strchr("RGB", channel->channel_name[0]) : NULL;
        channel->decode_to_ptr = NULL;
        if (!place) continue;
        float *first = r->rgb + (size_t)(y - r->top) * (size_t)r->width * 3 + (place - "RGB");
        channel->decode_to_ptr = (uint8_t *)first;
        channel->user_pixel_stride = 3 * (int)sizeof(float);
        channel->user_line_stride = r->width * 3 * (int)sizeof(float);
        channel->user_bytes_per_element = sizeof(float);
        channel->user_data_type = EXR_PIXEL_FLOAT;
    }
    if (!r->started) code = exr_decoding_choose_default_routines(r->exr, 0, &r->pipeline);
    r->started = 1;
    return code == EXR_ERR_SUCCESS ? exr_decoding_run(r->exr, 0, &r->pipeline) : code;
}

static float *read_exr(const char *path, int *width, int *height)
{
    reader r;
    int32_t rows = 1;
    memset(&r, 0, sizeof r);
    exr_result_t code = open_picture(&r, path);
    if (code == EXR_ERR_SUCCESS) code = exr_get_scanlines_per_chunk(r.exr, 0, &rows);
    for (int y = 0; y < r.height && code == EXR_ERR_SUCCESS; y += rows) code = read_chunk(&r, r.top + y);
    if (r.started) exr_decoding_destroy(r.exr, &r.pipeline);
    exr_finish(&r.exr);
    *width = r.width;
    *height = r.height;
    if (code == EXR_ERR_SUCCESS) return r.rgb;
    free(r.rgb);
    return NULL;
}

static float *read_picture(const char *path, int *width, int *height)
{
    float *rgb = picture_read_pfm(path, width, height);
    if (!rgb) rgb = read_exr(path, width, height);
    if (!rgb) fprintf(stderr, "compare: cannot read %s\n", path);
    return rgb;
}

int main(int argc, char **argv)
{
    int w[2] = {0, 0}, h[2] = {0, 0}, status = 1;
    if (argc != 3) {
        fprintf(stderr, "usage: compare A B\n");
        return 2;
    }
    float *a = read_picture(argv[1], &w[0], &h[0]), *b = a ? read_picture(argv[2], &w[1], &h[1]) : NULL;
    if (a && b && (w[0] != w[1] || h[0] != h[1])) {
        fprintf(stderr, "compare: %s is %d x %d, %s is %d x %d\n", argv[1], w[0], h[0], argv[2], w[1], h[1]);
    } else if (a && b) {
        picture_difference d = picture_compare(a, b, (size_t)w[0] * (size_t)h[0], 0.02);
        printf("%.3g %.3g %lu\n", d.rms, d.max, (unsigned long)d.above);
        status = 0;
    }
    free(a);
    free(b);
    return status;
}
