/* region.h -- the part of a receiver that is asked about, as the light sees it: for src/shadow alone.
 *
 * Place in the data flow: receiver (column.h) -> points of its region on the light's plane -> box by which candidates are gathered
 * (gather.h) -> probe that rules them out (leaf.h).
 */
#ifndef GNOI_SHADOW_REGION_H
#define GNOI_SHADOW_REGION_H

#include "shadow/pair.h"

typedef struct gnoi_region {
    int count;                              /* of its corners on the light's plane, all on one face */
    gnoi_lpoint corner[GNOI_FRAME_POINTS];  /* the polygon's hull where it is whole, else those of the picture region */
    gnoi_lbox box;
} gnoi_region;

/* 0 when the region has no corners on one face of the frame: then there are *box_count boxes of it instead. */
int gnoi_region_make(const gno_scene *scene, const gnoi_view *view, const gnoi_frame *frame, const gnoi_receiver *receiver,
                     gnoi_region *region, gnoi_lbox boxes[6], int *box_count);

/* The region's edges and plane; 0 when its corners do not span the plane. */
int gnoi_region_probe(const gnoi_pair *p, const gnoi_region *region, gnoi_probe *probe);

/* A point of the receiver's plane: within a receiver that lies whole in its region, else below the middle of the box. */
vec3 gnoi_region_centre(const gnoi_pair *p, const gnoi_frame *frame, const gnoi_region *region);

#endif
