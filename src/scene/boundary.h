/* boundary.h -- the boundary of a set of prepared polygons: the directed edges that no edge the other way cancels.
 *
 * Place in the data flow: prepared polygons -> holes of open solids (cap.c), contours of far sides (shadow/contour.c).
 * Invariant: edges come in the order of their lower vertices, so that neighbours in space are near each other.
 */
#ifndef GNOI_SCENE_BOUNDARY_H
#define GNOI_SCENE_BOUNDARY_H

#include "scene/scene.h"

typedef struct gnoi_boundary_edge {
    uint32_t from, to; /* prepared vertices, as the polygon's ring runs */
    uint32_t poly;     /* the prepared polygon that it bounds */
} gnoi_boundary_edge;

typedef struct gnoi_boundary {
    size_t count, capacity;
    gnoi_boundary_edge *edges;
} gnoi_boundary;

/* Appends the boundary of the polygons i < count whose taken[i] is 1. may_bound: 1 for each vertex that may lie on it, or NULL. Returns 0
 * when memory fails; free it in any case. */
int gnoi_boundary_find(gno_context *context, const gnoi_prepared *prep, const unsigned char *taken, size_t count,
                       const unsigned char *may_bound, gnoi_boundary *boundary);
void gnoi_boundary_free(gno_context *context, gnoi_boundary *boundary);

#endif
