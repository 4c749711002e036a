/* parts.h -- which part of a region of a receiver the light of a centre reaches, and how much of the light.
 *
 * Place in the data flow: region on a canvas + cover.h's casters -> clipper -> gnoi_parts -> pieces, areas. The parts are the region
 * inside a spot's cone, minus the union of what hides wholly, split by each transparent caster.
 */
#ifndef GNOI_SHADOW_PARTS_H
#define GNOI_SHADOW_PARTS_H

#include "shadow/cover.h"

/* Polygons, each with the share of the light that arrives there. */
typedef struct gnoi_parts {
    gnoi_shape shape;
    size_t passed_capacity;
    double *passed; /* 3 per polygon */
} gnoi_parts;

/* One worker's tools. */
typedef struct gnoi_parter {
    gno_context *context;
    gno_clipper *clipper;
    gnoi_cover cover;
    gnoi_shape outline; /* of the receiver in hand */
    gnoi_shape work[2];
    gnoi_parts parts, other;
} gnoi_parter;

gno_status gnoi_parter_make(const gno_scene *scene, gnoi_parter *p);
void gnoi_parter_free(gnoi_parter *p);

/* Clips and puts the result into `out` (cleared first; must not be an operand). */
gno_status gnoi_parter_clip(gnoi_parter *p, gno_clip_op op, const gno_shape *subject, const gno_shape *clip, gnoi_shape *out);

/* Fills p->parts with the parts of `region` that are reached; p->cover answered GNOI_COVER_PART about it. */
gno_status gnoi_parter_reach(gnoi_parter *p, const gnoi_canvas *canvas, const gno_shape *region);

/* Turns the casters found into their union, which pays where many regions are asked about after one another. */
gno_status gnoi_parter_unite(gnoi_parter *p);

/* Fills `out` (not one of p's) with the part of `region` that the parts leave: outside the cone or within what hides wholly, and, for
 * veiled not 0, within what lets light through. Found by intersection, where gnoi_parter_reach takes differences. */
gno_status gnoi_parter_shadow(gnoi_parter *p, const gno_shape *region, int veiled, gnoi_shape *out);

/* Area under even-odd filling of a shape that may be anything. */
gno_status gnoi_parter_area(gnoi_parter *p, const gno_shape *shape, double *area);

void gnoi_parts_clear(gnoi_parts *parts);
void gnoi_parts_free(gnoi_parts *parts);

/* Appends one polygon of a shape; 0 when memory fails. */
int gnoi_parts_add(gnoi_parts *parts, const gno_shape *from, size_t polygon, const double passed[3]);

static inline int gnoi_undiminished(const double passed[3]) { return passed[0] >= 1 && passed[1] >= 1 && passed[2] >= 1; }

#endif
