/* hidden.h -- is a convex region wholly covered by a few convex shadows together? Asked before the clipper is.
 *
 * Place in the data flow: cover.c's shadows -> here -> wholly hidden, or off to the clipper. Each shadow in turn is taken out of what is
 * left, convex fragment by convex fragment; where nothing remains the region is hidden. Gives up early: "no" is no answer.
 */
#ifndef GNOI_SHADOW_HIDDEN_H
#define GNOI_SHADOW_HIDDEN_H

#include "shadow/shape.h"

typedef struct gnoi_point2 {
    double x, y;
} gnoi_point2;

/* convex: for each polygon of `shadows` whether it is one convex ring; others are left out. The region is convex, either way round. */
int gnoi_wholly_hidden(const gnoi_point2 *region, int count, const gnoi_shape *shadows, const unsigned char *convex);

#endif
