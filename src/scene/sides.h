/* sides.h -- the normals at one vertex: one for each side of the creases there.
 *
 * Place in the data flow: average.c, which lists the polygons around a vertex -> here -> normals of the open corners there.
 */
#ifndef GNOI_SCENE_SIDES_H
#define GNOI_SCENE_SIDES_H

#include "base/context.h"
#include "base/vec.h"

/* A polygon's corner at the vertex: where its normal's number is or goes (GNOI_NONE: open), its plane, and what it adds to a sum. */
typedef struct gnoi_around_entry {
    uint32_t *normal;
    vec3 n;
    double weight;
} gnoi_around_entry;

typedef struct gnoi_around {
    size_t count, capacity;
    gnoi_around_entry *entries;
} gnoi_around;

/* Growing; zeros at first. */
typedef struct gnoi_normals {
    size_t count, capacity;
    float (*n)[3];
} gnoi_normals;

/* Gives every open corner a normal, as number | mark. crease: degrees. Corners of equal sums share one. Errors: MEMORY, CANCELLED. */
gno_status gnoi_settle_sides(gno_context *context, const gnoi_around *around, double crease, uint32_t mark, gnoi_normals *normals);

#endif
