/* filter_cut.h -- the texture filter where nothing is simple: very many elements, w that changes manifold, the plane's horizon.
 *
 * Place: under filter.c. The pixel's square is cut by the coarsest cells first, and a piece is cut further while its cell's spread says
 * that this could change the result.
 */
#ifndef GNOI_PROJECT_FILTER_CUT_H
#define GNOI_PROJECT_FILTER_CUT_H

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

/* The mean over the pixel; s and t in elements and w are relative to its middle. 0 where nothing of it is before the horizon. */
int gnoi_filter_cut(const gnoi_image *image, gno_wrap wrap, const gnoi_screen_plane *s, const gnoi_screen_plane *t,
                    const gnoi_screen_plane *w, float mean[4]);

#endif
