/* bands.h -- a picture made band after band, for callers that take it as it comes.
 *
 * Place in the data flow: scanline.c sets a frame up and makes its tiles; who calls it says what to make of a tile, and takes each
 * band of whole tile rows when it is done: rows.c the rows of the picture, spans.c the spans of its sample lines.
 */
#ifndef GNOI_ENGINE_BANDS_H
#define GNOI_ENGINE_BANDS_H

#include "engine/tile.h"

typedef struct gnoi_bands {
    void *user;
    float *rgb; /* for all tiles; NULL when they are made into something else */
    /* Makes tile `index`, on any thread; 0 when memory fails. */
    int (*make)(void *user, gnoi_tile *tile, size_t index);
    /* Takes tile rows [first, first + count), on the caller's thread. NULL: the picture is one band, which nobody waits for. */
    gno_status (*hand_out)(void *user, gnoi_frame_job *frame, int first, int count);
} gnoi_bands;

/* Tile rows of a band: enough tiles to keep the threads busy, for the end of a band is waited for. */
int gnoi_band_rows(int tiles_x, int threads);

/* gno_render, with the tiles made and taken by `bands`. */
gno_status gnoi_render(gno_scene *scene, const gno_render_def *def, const gnoi_bands *bands, gno_stats *stats);

#endif
