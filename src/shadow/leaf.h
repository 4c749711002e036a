/* leaf.h -- eight triangles' corners on a light's plane, and the probe of a receiver that rules most of them out without touching
 * the scene.
 *
 * Place in the data flow: candidates by their boxes (eight.h) -> leaves, tested eight at a time -> exact tests (caster.c, cover.c).
 */
#ifndef GNOI_SHADOW_LEAF_H
#define GNOI_SHADOW_LEAF_H

#include "scene/scene.h"
#include "shadow/eight.h"

/* Relative to an origin near them for the sake of precision. What is no triangle on one face has a NaN: every comparison fails,
 * nothing is ruled out. */
typedef struct gnoi_leaf {
    gnoi_lpoint origin;
    float u[3][GNOI_EIGHT], v[3][GNOI_EIGHT], q[3][GNOI_EIGHT];
} gnoi_leaf;

/* What is known of a receiver on the light's plane. A candidate is ruled out when all its corners lie outside one of the edges
 * (a u + b v + c <= slack, positive inside) or none is nearer to the light than the receiver's plane. */
#define GNOI_PROBE_EDGES 4
typedef struct gnoi_probe {
    int edge_count;
    double a[GNOI_PROBE_EDGES], b[GNOI_PROBE_EDGES], c[GNOI_PROBE_EDGES], slack[GNOI_PROBE_EDGES];
    double qa, qb, qc; /* nearness of the receiver's plane, plus half its tolerance */
    double lift;       /* that half tolerance, as nearness */
} gnoi_probe;

/* Of `count` (at most eight) prepared polygons; GNOI_NONE among them stands for none. */
void gnoi_leaf_set(const gno_scene *scene, const gnoi_frame *frame, const uint32_t *polys, size_t count, gnoi_leaf *leaf);

/* Bit k: triangle k is not ruled out. */
unsigned gnoi_leaf_mask(const gnoi_leaf *leaf, const gnoi_probe *probe);

/* Of triangle k alone. */
int gnoi_leaf_rules_out(const gnoi_leaf *leaf, unsigned k, const gnoi_probe *probe);

#endif
