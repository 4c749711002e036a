/* overlap.h -- does one polygon keep a light from another? The exact test behind a one of the shadow matrix.
 *
 * Place in the data flow: packets rule out most pairs (matrix_search.c) -> this decides the rest. No picture and no projection: the
 * planes through the light and the receiver's edges bound all that can shade it, in scene space, so that light inside the scene needs
 * no cases. Polygons that are not convex are taken apart into triangles first, once a light.
 * Invariants: GNOI_OVERLAP_NONE is certain but for what reaches over an edge or above the receiver's plane by less than the
 * tolerances; heights within the coplanarity tolerance count as zero, so that polygons on the receiver's plane never shade it.
 */
#ifndef GNOI_SHADOW_OVERLAP_H
#define GNOI_SHADOW_OVERLAP_H

#include "project/view.h"
#include "scene/scene.h"
#include "shadow/packet.h"

/* A convex part of a polygon. */
typedef struct gnoi_facet {
    int count;
    vec3 corner[GNOI_FACET_CORNERS];
} gnoi_facet;

/* Triangles of the polygons that are not convex. */
typedef struct gnoi_facets {
    size_t poly_count;
    uint32_t *first; /* by prepared polygon: its triangles, GNOI_NONE: convex; NULL: all are convex */
    size_t triangle_count;
    uint32_t (*triangles)[3]; /* indices into corner arrays */
} gnoi_facets;

/* Errors: MEMORY; nothing is left to be freed then. */
gno_status gnoi_facets_build(const gno_scene *scene, gnoi_facets *facets);
void gnoi_facets_free(gno_context *context, gnoi_facets *facets);

/* The convex part number `index` of a polygon; 0 when it has no more. */
int gnoi_facet_get(const gnoi_facets *facets, const gno_scene *scene, const gnoi_poly *poly, size_t index, gnoi_facet *facet);

/* Everything about a receiver that its casters' tests share. */
typedef struct gnoi_shaded {
    const gno_scene *scene;
    const gnoi_lamp *lamp;
    const gnoi_facets *facets;
    const gnoi_poly *poly;
    gnoi_form height;     /* over the receiver's plane, positive on the side of the light */
    double tolerance;
    int edge_count;       /* planes through the light and the edges of `facet`, unit normals inwards */
    vec3 edge[GNOI_FACET_CORNERS];
    gnoi_facet facet;     /* of a convex receiver; else a rectangle around it */
    int convex;           /* the facet is the receiver */
    size_t piece_count;   /* triangles to try one by one when it is not */
} gnoi_shaded;

/* The light must not lie in the receiver's plane. */
void gnoi_shaded_set(gnoi_shaded *r, const gno_scene *scene, const gnoi_lamp *lamp, const gnoi_facets *facets, const gnoi_poly *poly);

typedef enum gnoi_overlap { GNOI_OVERLAP_NONE, GNOI_OVERLAP_PART, GNOI_OVERLAP_ALL } gnoi_overlap;

/* ALL: the caster alone keeps the light from the whole receiver. */
gnoi_overlap gnoi_overlap_test(const gnoi_shaded *r, const gnoi_poly *caster);

#endif
