/* canvas.h -- a receiver's plane as a centre sees it, with coordinates of its own.
 *
 * Place in the data flow: gnoi_centre + receiver -> gnoi_canvas -> cover.h, receiver.h. Plane coordinates are right-handed as the centre
 * sees the plane, orthonormal, with the origin at the receiver's first corner, so that areas are true and digits are not lost far from the
 * scene's origin.
 *
 * Every point is projected along the centre's ray through it: with a, b, h its coordinates along and its height over the
 * plane, H the height of the centre and A, B its coordinates, (a H - A h, b H - B h, H - h) are homogeneous plane coordinates
 * (column.h has the same formula with picture forms).
 */
#ifndef GNOI_SHADOW_CANVAS_H
#define GNOI_SHADOW_CANVAS_H

#include "project/clip3.h"
#include "shadow/centre.h"

typedef struct gnoi_canvas {
    const gnoi_centre *centre;
    uint32_t index;      /* of the receiver among the prepared polygons */
    vec3 origin, u, v, n; /* n towards the centre */
    double height;       /* H; a centre at infinity: the cosine */
    double along_u, along_v; /* A, B over H */
} gnoi_canvas;

/* Two unit vectors along a plane, right-handed with its unit normal. */
void gnoi_plane_axes(vec3 n, vec3 *u, vec3 *v);

gnoi_canvas gnoi_canvas_make(const gnoi_centre *centre, uint32_t index);

static inline vec3 gnoi_canvas_point(const gnoi_canvas *canvas, double x, double y)
{
    return v3_mad(v3_mad(canvas->origin, canvas->u, x), canvas->v, y);
}

/* p projected along the centre's ray, homogeneous; side is S without the caster's share, h/H. */
gnoi_hpoint gnoi_canvas_project(const gnoi_canvas *canvas, vec3 p);

/* How far off the plane the receiver's corners lie, at the most. */
double gnoi_canvas_bend(const gnoi_canvas *canvas);

#endif
