/* located.h -- every vertex of a scene on a light's plane, so that corners that polygons share are projected once.
 *
 * Place in the data flow: prepared vertices, frame.h -> here -> boxes of polygons (tree_build.c).
 * Invariant: a polygon's box is the one gnoi_frame_boxes makes of its corners, but for the rounding of a depth, which the box's slack covers.
 */
#ifndef GNOI_SHADOW_LOCATED_H
#define GNOI_SHADOW_LOCATED_H

#include "scene/scene.h"
#include "shadow/frame.h"

/* A vertex: place on the light's plane, depth, and the face that it lies on; GNOI_NO_FACE: behind a one-face frame's light. */
typedef struct gnoi_located {
    float u, v, z;
    int32_t face;
} gnoi_located;

#define GNOI_NO_FACE (-1)

/* An array of prepared.vertex_count elements for gnoi_free; NULL without memory. */
gnoi_located *gnoi_locate_vertices(const gno_scene *scene, const gnoi_frame *frame);

/* The box of a ring of vertices; 0 when they do not all lie on one face. */
static inline int gnoi_located_box(const gnoi_frame *frame, const gnoi_located *located, const uint32_t *vertex, uint32_t count, gnoi_lbox *box)
{
    const gnoi_located *first = &located[vertex[0]];
    gnoi_lbox b = {first->u, first->u, first->v, first->v, first->z, first->z};
    int together = first->face != GNOI_NO_FACE;
    for (uint32_t i = 1; i < count; i++) {
        const gnoi_located *l = &located[vertex[i]];
        together &= l->face == first->face;
        b.u0 = l->u < b.u0 ? l->u : b.u0;
        b.u1 = l->u > b.u1 ? l->u : b.u1;
        b.v0 = l->v < b.v0 ? l->v : b.v0;
        b.v1 = l->v > b.v1 ? l->v : b.v1;
        b.z0 = l->z < b.z0 ? l->z : b.z0;
        b.z1 = l->z > b.z1 ? l->z : b.z1;
    }
    gnoi_box_grow(&b, frame);
    *box = b;
    return together;
}

#endif
