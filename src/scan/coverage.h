/* coverage.h -- exact area and centre of polygons in the pixels of one tile.
 *
 * Place in the data flow: rings of visible pieces in picture coordinates -> area of each pixel that they cover, and its
 * first moments -> samples (engine/weiler_atherton.c).
 * By Green's theorem each edge adds by itself: to the pixels it crosses the integral of what lies to its right in them,
 * to the pixels farther right in the same rows its height. (The idea is that of font rasterisers, as in FreeType's
 * ftgrays.c, here in double precision and with first moments beside the area.)
 *
 *         row r   |      /|       |       |      in the edge's own pixel: the part right of it
 *                 |     / |#######|#######|      every pixel after it: the whole height
 *                 |    /##|#######|#######|
 *
 * Invariants: an edge is taken from its upper end whichever way it runs, so that the two polygons at it add opposite
 * numbers and their sum is that of their union; nothing is sampled.
 */
#ifndef GNOI_SCAN_COVERAGE_H
#define GNOI_SCAN_COVERAGE_H

#include "scan/bins.h"

/* Values of a pixel row. `step` and `step_y` are what begins at a pixel and holds for all that follow; column 0 takes what lies
 * left of the tile. */
typedef struct gnoi_coverage_row {
    double area[GNOI_TILE_W], mx[GNOI_TILE_W], my[GNOI_TILE_W];
    double step[GNOI_TILE_W + 1], step_y[GNOI_TILE_W + 1];
} gnoi_coverage_row;

/* first_row..last_row: the rows that hold anything; first_row > last_row: none do. */
typedef struct gnoi_coverage {
    double x0, y0;     /* the tile's corner in the picture */
    int width, height; /* pixels */
    int first_row, last_row;
    gnoi_coverage_row rows[GNOI_TILE_H];
} gnoi_coverage;

/* Makes an empty coverage of a tile; one that was finished or never used needs no other clearing: rows are cleared when first
 * touched. */
void gnoi_coverage_start(gnoi_coverage *coverage, int x0, int y0, int width, int height);

/* Adds the edge from a to b (picture coordinates), `sign` (+1 or -1) times: summed over a ring that runs clockwise as seen in the
 * picture (y down) sign +1 gives its area, positive. Edges may lie anywhere. */
void gnoi_coverage_edge(gnoi_coverage *coverage, double ax, double ay, double bx, double by, double sign);

/* Turns sums into values: area in [0,1] per pixel, mx, my the integrals over that area of the offset from the pixel's centre.
 * No edge may be added after it. */
void gnoi_coverage_finish(gnoi_coverage *coverage);

/* Twice the signed area of a ring in the picture, positive when it runs clockwise as seen (y down); xy: pairs. */
double gnoi_ring_area2(const double *xy, size_t count);

#endif
