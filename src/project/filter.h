/* filter.h -- the mean of a texture's picture over one pixel.
 *
 * Place in the data flow: gnoi_image + gnoi_pattern over a pixel -> red, green, blue, alpha -> shading, holes.
 * The pixel's four corners bound a quadrilateral of the pattern; the pattern's elements (squares of one colour) are weighted by the
 * share of each that lies inside (Catmull 1974; Blinn and Newell 1976). Shares are areas in the picture: the lines between
 * elements are straight there too, so the pixel's square is cut by them, and what perspective does to areas is exact.
 * Prefiltered levels bound the cost: the square is cut by the coarsest cells first, and a piece is cut further while its cell's
 * spread says that this could change the result.
 */
#ifndef GNOI_PROJECT_FILTER_H
#define GNOI_PROJECT_FILTER_H

#include "project/pattern.h"
#include "scene/image.h"

/* The mean over the pixel whose centre is (x,y), the square of side 1 around it; red, green, blue multiplied by alpha. Beyond the
 * plane's horizon nothing counts. (xs,ys): a point where the surface is seen, for pixels that have nothing else. */
void gnoi_filter_pixel(const gnoi_image *image, const gno_texture *how, const gnoi_pattern *pattern, double x, double y, double xs,
                       double ys, float mean[4]);

#endif
