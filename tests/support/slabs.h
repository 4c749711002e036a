/* slabs.h -- the slow, obvious twin of the clipper: areas by cutting the plane into slabs. */
#ifndef SUPPORT_SLABS_H
#define SUPPORT_SLABS_H

#include <gnomon/gnomon_clip.h>

/* Area of the combination of two shapes, each the union of its polygons' even-odd insides; clip may be NULL. Vertical lines through
 * every point and every crossing of two edges cut the plane into slabs; within a slab no two edges cross, so lengths along its middle
 * line times its width are its areas. Time grows with the cube of the number of edges. */
double slab_area(gno_clip_op op, const gno_shape *subject, const gno_shape *clip);

/* The larger side of the bounds of both. */
double slab_extent(const gno_shape *subject, const gno_shape *clip);

#endif
