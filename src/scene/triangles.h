/* triangles.h -- planes of triangles, made many side by side, and what their edges and volumes add up to.
 *
 * Place in the data flow: emit.c, which stores records -> here -> solid.c, which tells closed parts by the sums.
 */
#ifndef GNOI_SCENE_TRIANGLES_H
#define GNOI_SCENE_TRIANGLES_H

#include "scene/scene.h"

/* What is known of a set of triangles. */
typedef struct gnoi_triangle_sums {
    uint64_t edges; /* of gnoi_edge_number */
    double volume;  /* six times that of the pyramids from prepared.lower */
} gnoi_triangle_sums;

/* Sets the planes of the records [first, first + count), triangles whose corners follow one another, as gnoi_set_triangle does, and adds to
 * the sums. */
void gnoi_set_triangles(gnoi_prepared *prep, size_t first, size_t count, gnoi_triangle_sums *sums);

static inline uint64_t gnoi_scramble(uint64_t x)
{
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return x ^ x >> 31;
}

/* A pseudo-random number of an edge between two vertices: that of the edge the other way is minus it. */
static inline uint64_t gnoi_edge_number(uint32_t from, uint32_t to)
{
    uint64_t low = from < to ? from : to, high = from < to ? to : from, h = gnoi_scramble((low << 32 | high) + 0x9e3779b97f4a7c15u);
    uint64_t sign = (uint64_t)0 - (from > to); /* minus h is ~h + 1 */
    return from == to ? 0 : (h ^ sign) - sign;
}

#endif
