/* cells.h -- areas of a pixel by the cells of a lattice that its surface cuts.
 *
 * Place in the data flow: footprint in the pattern's frame -> here -> how much of the pixel is of which colour (procedural.c).
 * The pixel square is cut along the lines where the surface meets the planes between cells. A projective footprint keeps lines
 * straight, so the pieces are polygons and their areas exact: the pattern's elements weighted by the share of each that the
 * pixel shows, in the picture (Catmull 1974; Blinn and Newell 1976), no sampling.
 */
#ifndef GNOI_SHADE_CELLS_H
#define GNOI_SHADE_CELLS_H

#include <gnomon/gnomon_math.h>

/* Share of the pixel in unit cubes whose coordinates' sum is odd. */
double gnoi_checker_share(const gno_footprint *footprint);

/* A wall of bricks in two coordinates of the footprint: `along` the courses and `up` across them. */
typedef struct gnoi_bricks {
    int along, up;         /* 0 to 2 */
    double length, height; /* joint included */
    double mortar;
    unsigned seed;
} gnoi_bricks;

/* Share of the pixel on bricks; *tint: the sum over them of share times the brick's own random number in [0,1]. */
double gnoi_brick_share(const gnoi_bricks *bricks, const gno_footprint *footprint, double *tint);

#endif
