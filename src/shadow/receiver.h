/* receiver.h -- one polygon under one centre: its outline, its true area, and what the clipper makes of it.
 *
 * Place in the data flow: prepared polygon + centre -> gnoi_receiver (outline in p->outline, areas) -> cover, parts -> lit.c, visible.c.
 */
#ifndef GNOI_SHADOW_RECEIVER_H
#define GNOI_SHADOW_RECEIVER_H

#include "shadow/parts.h"

typedef struct gnoi_receiver_view {
    gnoi_canvas canvas;
    gno_shape outline; /* view of the parter's outline: one polygon, or none where the eye's frame leaves nothing */
    int whole;         /* nothing was cut away by the frame */
    int convex;        /* the outline is one convex ring */
    double true_area;  /* of the polygon, whatever the centre */
    gnoi_moment seen;  /* of the outline as the centre sees it, on the plane; the same but for bad planarity, where it is whole */
    double scale;      /* true area over seen area: areas on the plane are multiplied by it */
} gnoi_receiver_view;

/* True area of a prepared polygon. */
gno_status gnoi_true_area(gnoi_parter *p, const gnoi_centre *centre, uint32_t index, double *area);

/* The polygon must have a side that faces the centre. */
gno_status gnoi_receiver_make(gnoi_parter *p, const gnoi_centre *centre, uint32_t index, gnoi_receiver_view *r);

#endif
