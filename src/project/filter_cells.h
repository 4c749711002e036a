/* filter_cells.h -- the usual pixel of the texture filter: few cells of one level, w almost constant.
 *
 * Place: under filter.c, which cuts the square where this does not apply. The cells are weighed by their exact areas under the
 * quadrilateral of the pixel's corners (coverage.h).
 */
#ifndef GNOI_PROJECT_FILTER_CELLS_H
#define GNOI_PROJECT_FILTER_CELLS_H

#include "project/pattern.h"
#include "scene/image.h"
#include <math.h>

/* Whether a part may stand for its elements by its cell's mean. n cells like it would fill the pixel. Along an edge of the pixel
 * some sqrt(n) cells are cut, with errors of either sign and a fourth of the spread on the average; in a whole cell only
 * perspective weighs one element more than another. Solved for the area that keeps the sum within the tolerance. */
static inline double gnoi_filter_most_area(double tolerance, float spread)
{
    double share = tolerance / (double)spread;
    return share * sqrt(share) * 2.0; /* between the exponents 4/3 (random) and 2 (edge along the elements) */
}

/* The mean over the pixel; s and t in elements and w are relative to its middle. 0 where the square has to be cut instead. */
int gnoi_filter_cells(const gnoi_image *image, const gno_texture *how, const gnoi_screen_plane *s, const gnoi_screen_plane *t,
                      const gnoi_screen_plane *w, float mean[4]);

#endif
