/* ranges.h -- which tiles the triangles of sixteen lanes touch, by vector code.
 *
 * Place in the data flow: bounds in the picture (lanes.h) -> here -> lists of the tiles (bins.c).
 * Invariant: each lane's range is the one gnoi_tile_range_of gives its bounds.
 */
#ifndef GNOI_SCAN_RANGES_H
#define GNOI_SCAN_RANGES_H

#include "scan/lanes.h"

/* The picture in tiles. */
typedef struct gnoi_tile_grid {
    int width, height, tiles_x, tiles_y;
    int lines;    /* sample lines per pixel row */
    double reach; /* gnoi_outline_reach */
} gnoi_tile_grid;

typedef struct gnoi_tile_range {
    uint16_t x0, y0, x1, y1; /* tiles, both ends included; x0 > x1: none */
    uint32_t key;            /* of what is opaque, for all tiles; or GNOI_LARGE and the least key in any */
} gnoi_tile_range;

#define GNOI_LARGE 0x80000000u

/* Of bounds anywhere. */
gnoi_tile_range gnoi_tile_range_of(const gnoi_tile_grid *grid, const gnoi_rect *box, float nearest);

/* Of each lane; bit k of what is returned: lane k lies within the reach on all sides, its range counts. */
unsigned gnoi_tile_ranges(const gnoi_tile_grid *grid, const gnoi_lanes *lanes, gnoi_tile_range range[GNOI_LANES]);

#endif
