/* clip3.h -- cutting a ring in homogeneous picture coordinates by a half-space (Sutherland and Hodgman 1974).
 *
 * Place in the data flow: polygons that reach behind the near plane or far out of the picture, and casters that reach
 * behind their receiver or beyond their light, are cut here before they are divided by w.
 * Invariant: the point where an edge is cut depends on the edge alone, not on its direction, so that two polygons
 * sharing an edge are cut at the very same point and stay without crack or overlap.
 */
#ifndef GNOI_PROJECT_CLIP3_H
#define GNOI_PROJECT_CLIP3_H

#include <stddef.h>

/* A homogeneous point with the values of up to two more linear forms carried along. */
typedef struct gnoi_hpoint {
    double x, y, w;
    double side; /* the value by which gnoi_clip_ring cuts: kept where side >= 0 */
} gnoi_hpoint;

/* Cuts in[0..count) to the part with side >= 0; out needs room for 2 count points (each pass over a non-convex ring may add
 * as many points as it crosses) and must not be `in`. Returns the number of points. The result is right under even-odd
 * filling: parts of a non-convex ring stay joined by edges that run along the cut there and back. */
size_t gnoi_clip_ring(const gnoi_hpoint *in, size_t count, gnoi_hpoint *out);

#endif
