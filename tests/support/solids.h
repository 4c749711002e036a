/* solids.h -- closed bodies of polygons, and such as stand open on a plane, from a seed. Place: tests. */
#ifndef TESTS_SUPPORT_SOLIDS_H
#define TESTS_SUPPORT_SOLIDS_H

#include <gnomon/gnomon.h>
#include <stdint.h>

/* Positions and polygons, wound outwards. */
#define SOLID_MOST 4000
typedef struct solid {
    size_t vertices, polygons, corners;
    double p[SOLID_MOST][3];
    unsigned ring[SOLID_MOST + 1];
    int corner[4 * SOLID_MOST];
} solid;

/* A box, a star-shaped prism with concave lids (either may lack the lid at z = 0 when open_allowed), a smooth or a bumpy torus of
 * triangles, or one crumpled through itself (when open_allowed; else as before); about one unit in radius, standing on z = 0. */
void solid_make(solid *s, uint32_t *seed, int open_allowed);

/* A mesh that reads the solid's arrays. */
gno_mesh_def solid_mesh(const solid *s);

/* 24 random bits; uniform in [a,b). */
uint32_t solid_random(uint32_t *seed);
double solid_uniform(uint32_t *seed, double a, double b);

#endif
