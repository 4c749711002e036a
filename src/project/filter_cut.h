/* filter_cut.h -- the texture filter where nothing is simple: very many elements, w that changes manifold, the plane's horizon.
 *
 * Place: under filter.c. The pixel's square is cut by the coarsest cells first, and a piece is cut further while its cell's variance says
 * that this could change the result.
 */
#ifndef GNOI_PROJECT_FILTER_CUT_H
#define GNOI_PROJECT_FILTER_CUT_H

#include "project/pattern.h"
#include "scene/image.h"

/* Whether a part of this area may stand for its elements by its cell's mean. n cells like it would fill the pixel. Along an edge of the
 * pixel some sqrt(n) cells are cut, with errors of either sign and half of the deviation, the variance's root, at most; in a whole cell
 * only perspective weighs one element more than another. So area <= 2 (tolerance / (2 deviation))^(3/2) keeps the sum within the
 * tolerance: between the exponents 4/3 (random) and 2 (edge along the elements). Here both sides are to the fourth power. */
static inline int gnoi_filter_is_small(double area, double tolerance, float variance)
{
    double a = area * area, v = 4 * (double)variance, t = tolerance * tolerance;
    return a * a * (v * v * v) <= 16 * (t * t * t);
}

/* The mean over the pixel; s and t in elements and w are relative to its middle. 0 where nothing of it is before the horizon. */
int gnoi_filter_cut(const gnoi_image *image, gno_wrap wrap, const gnoi_screen_plane *s, const gnoi_screen_plane *t,
                    const gnoi_screen_plane *w, float mean[4]);

#endif
