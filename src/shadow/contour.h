/* contour.h -- everything that casts shadows from one lamp: single casters, and the far sides of halved solids as sheets with a
 * contour.
 *
 * Place in the data flow: prepared polygons -> trees of casters (tree.h), contour edges -> columns (column.h).
 * Of a closed solid that eye and lamp are outside of, the far sides alone are casters (tree.h). They hang together in sheets: a
 * point is in the shadow when any far side lies between it and the lamp, and how many do changes only across the sheets' boundary,
 * the contour (silhouette) edges as the lamp sees them, or where a far side passes through the receiver. A receiver
 * that no contour edge crosses and no far side pierces is wholly lit or wholly dark, however many casters are above it.
 * Invariants: the directed boundary edges of every polygon in `far` cancel but for those in `contour`; all of these run so that
 * their polygon is to the left on the light's plane (u right, v up).
 */
#ifndef GNOI_SHADOW_CONTOUR_H
#define GNOI_SHADOW_CONTOUR_H

#include "scene/boundary.h"
#include "shadow/located.h"
#include "shadow/tree.h"

typedef struct gnoi_casters {
    gnoi_tree single; /* every other caster */
    gnoi_tree far;    /* far sides of halved solids */
    gnoi_tree rim;    /* the contour edges */
    gnoi_boundary contour;
    gnoi_located *located; /* every vertex on the light's plane; NULL: not kept */
    size_t located_count;
} gnoi_casters;

/* halved: see tree.h. keep: so is what serves receivers too, the vertices' places. */
gno_status gnoi_casters_build(const gno_scene *scene, const gnoi_lamp *lamp, const unsigned char *halved, int keep, gnoi_casters *casters);
void gnoi_casters_free(gno_context *context, gnoi_casters *casters);

#endif
