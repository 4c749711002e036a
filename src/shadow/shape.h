/* shape.h -- a growing list of plane polygons, as the clipper takes them.
 *
 * Place in the data flow: outlines and shadow polygons on a receiver's plane -> gnoi_shape -> gno_clip -> gnoi_shape -> pieces.
 * Invariants: offsets begin at 0 and count rings and points of this list alone; ring_start has ring_count+1, polygon_start
 * polygon_count+1 elements in use once something was added.
 */
#ifndef GNOI_SHADOW_SHAPE_H
#define GNOI_SHADOW_SHAPE_H

#include "base/context.h"
#include <gnomon/gnomon_clip.h>

typedef struct gnoi_shape {
    gno_context *context;
    size_t polygon_count, polygon_capacity;
    size_t *polygon_start;
    size_t ring_count, ring_capacity;
    size_t *ring_start;
    size_t point_count, point_capacity; /* capacity in doubles */
    double *points;
} gnoi_shape;

void gnoi_shape_clear(gnoi_shape *shape); /* keeps the memory */
void gnoi_shape_free(gnoi_shape *shape);

/* Room for `count` more points, to be filled from the address returned and closed by gnoi_shape_end_ring; NULL when memory fails. */
double *gnoi_shape_ring(gnoi_shape *shape, size_t count);

/* Closes a ring of `count` points; then, with the first of its rings, a polygon. Both return 0 when memory fails. */
int gnoi_shape_end_ring(gnoi_shape *shape, size_t count);
int gnoi_shape_end_polygon(gnoi_shape *shape, size_t first_ring);

/* Takes back every ring and point from the given counts on. */
void gnoi_shape_cut(gnoi_shape *shape, size_t polygons, size_t rings, size_t points);

/* Appends polygons first .. first+count-1 of another shape. Returns 0 when memory fails. */
int gnoi_shape_append(gnoi_shape *shape, const gno_shape *from, size_t first, size_t count);

gno_shape gnoi_shape_view(const gnoi_shape *shape);

/* Area and first moments (area times centroid) of one polygon of a valid shape, holes taken away. */
typedef struct gnoi_moment {
    double area, x, y;
} gnoi_moment;

gnoi_moment gnoi_shape_moment(const gno_shape *shape, size_t polygon);

/* Bounds x0, y0, x1, y1 of one polygon. */
void gnoi_shape_box(const gno_shape *shape, size_t polygon, double box[4]);

#endif
