/* cover.h -- what hides a polygon from a centre: its column of casters, projected onto its plane.
 *
 * Place in the data flow: gnoi_centre + receiver -> outline and casters' shadows in the receiver's plane coordinates -> clipper
 * -> lit (visible) parts. With h the height of a point over the receiver's plane, H that of the centre (canvas.h), a caster is nearer
 * to the centre than the receiver where
 *     S = h/H - h'/H' > 0,    h', H' the heights over the caster's own plane.
 * S is linear, constant along rays, and changes sign when caster and receiver change places. So of two polygons that
 * meet a ray exactly one hides the other, however badly planar they are: the parts that a centre sees cover each of its rays once.
 * Corners that polygons share are projected to the very same numbers, and S is 0 there by rule, so that neighbours that are not quite
 * planar do not shade each other along their common edge.
 */
#ifndef GNOI_SHADOW_COVER_H
#define GNOI_SHADOW_COVER_H

#include "shadow/canvas.h"
#include "shadow/shape.h"

typedef enum gnoi_cover_state {
    GNOI_COVER_NONE,  /* nothing hides any of it */
    GNOI_COVER_ALL,   /* wholly hidden */
    GNOI_COVER_PART,  /* cover->casters, veils and cone tell */
    GNOI_COVER_NO_MEMORY
} gnoi_cover_state;

/* What hides the receiver asked about last, and scratch; one for each worker. */
typedef struct gnoi_cover {
    gno_context *context;
    double slack;         /* overlaps thinner than this are none; 0 but where the region was found from another centre */
    gnoi_shape casters;   /* those that hide wholly */
    size_t convex_capacity;
    unsigned char *convex; /* for each caster whether its shadow is one convex ring */
    gnoi_shape veils;     /* those that let light through, one polygon each */
    gnoi_list veil_index; /* their prepared polygons */
    gnoi_shape cone;      /* of a spot, where it does not hold the whole region: one convex polygon */
    gnoi_list partners;   /* polygons lying on the receiver that may overlap it and cast, or hide it by their rank */
    gnoi_list found;
    size_t mark_count;
    uint32_t *marks, mark; /* the query that met a polygon last */
    size_t vertex_count;
    uint32_t *vertex_marks; /* the query whose receiver had the vertex last */
    size_t point_capacity;
    gnoi_hpoint *points;  /* two halves: before and after a cut */
} gnoi_cover;

int gnoi_cover_make(const gno_scene *scene, gnoi_cover *cover); /* 0 when memory fails */
void gnoi_cover_free(gnoi_cover *cover);

/* Appends the receiver's outline as its centre sees it, cut to the eye's frame where it has one. *whole: nothing was cut. Returns
 * 0 when memory fails. */
int gnoi_canvas_outline(const gnoi_canvas *canvas, gnoi_cover *cover, gnoi_shape *outline, int *whole);

/* Finds what hides the part of the receiver within `region` (not empty), polygons in plane coordinates; convex: it is one convex
 * ring. */
gnoi_cover_state gnoi_cover_ask(gnoi_cover *cover, const gnoi_canvas *canvas, const gno_shape *region, int convex);

/* Direction of edge i of the pyramid that stands for a spot's cone, out of GNOI_CONE_SIDES; as long along the axis as the axis. */
#define GNOI_CONE_SIDES 720
vec3 gnoi_cone_edge(const gnoi_lamp *lamp, int i);

#endif
