/* rows.c -- gno_render_rows: the picture row by row, with memory for one band of it. */
#include "base/parallel.h"
#include "engine/bands.h"

/* Tiles of a band for each thread. */
#define TILES_EACH 12

#define STOPPED "render: the receiver of rows asked to stop"

typedef struct rows {
    gno_row_fn take;
    void *user;
    float *rgb; /* one band */
} rows;

int gnoi_band_rows(int tiles_x, int threads)
{
    int count = (TILES_EACH * threads + tiles_x - 1) / tiles_x;
    return count > 1 ? count : 1;
}

static int make_pixels(void *user, gnoi_tile *tile, size_t index)
{
    (void)user;
    return gnoi_tile_render(tile, index);
}

static gno_status hand_out(void *user, gnoi_frame_job *frame, int first, int count)
{
    const rows *r = user;
    gno_context *context = frame->scene->context;
    int y = first * GNOI_TILE_H, end = y + count * GNOI_TILE_H, width = frame->view.width;
    for (end = end < frame->view.height ? end : frame->view.height; y < end; y++)
        if (r->take(r->user, y, r->rgb + 3 * (size_t)(y - frame->first_row) * (size_t)width) != 0)
            return gnoi_fail(context, GNO_ERROR_CANCELLED, STOPPED);
    return GNO_OK;
}

/* The other engines make the whole picture first. */
static gno_status render_whole(gno_scene *scene, const gno_render_def *def, gno_row_fn row, void *user, gno_stats *stats)
{
    gno_context *context = scene->context;
    size_t width = (size_t)scene->image.width, values = 3 * width * (size_t)scene->image.height;
    float *rgb = gnoi_malloc(context, values, sizeof *rgb);
    gno_status status = rgb ? gno_render(scene, def, rgb, stats) : gnoi_fail(context, GNO_ERROR_MEMORY, "out of memory for the picture");
    for (int y = 0; y < scene->image.height && !status; y++)
        if (row(user, y, rgb + 3 * (size_t)y * width) != 0)
            status = gnoi_fail(context, GNO_ERROR_CANCELLED, STOPPED);
    gnoi_free(context, rgb, values, sizeof *rgb);
    return status;
}

gno_status gno_render_rows(gno_scene *scene, const gno_render_def *def, gno_row_fn row, void *user, gno_stats *stats)
{
    int threads = gnoi_thread_count(def ? def->threads : 0), tiles_x;
    gno_context *context = gno_scene_context(scene);
    gnoi_bands bands;
    size_t values;
    gno_status status;
    rows r;
    if (!scene || !row)
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "gno_render_rows: scene or row is NULL");
    if (def && def->engine != GNO_ENGINE_SCANLINE)
        return render_whole(scene, def, row, user, stats);
    tiles_x = (scene->image.width + GNOI_TILE_W - 1) / GNOI_TILE_W;
    values = 3 * (size_t)scene->image.width * (size_t)gnoi_band_rows(tiles_x, threads) * GNOI_TILE_H;
    r.take = row;
    r.user = user;
    r.rgb = gnoi_malloc(context, values, sizeof *r.rgb);
    if (!r.rgb)
        return gnoi_fail(context, GNO_ERROR_MEMORY, "out of memory for the rows of the picture");
    bands.user = &r;
    bands.rgb = r.rgb;
    bands.make = make_pixels;
    bands.hand_out = hand_out;
    status = gnoi_render(scene, def, &bands, stats);
    gnoi_free(context, r.rgb, values, sizeof *r.rgb);
    return status;
}
