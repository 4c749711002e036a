/* shapes.h -- shapes for tests and benchmarks of the clipper: random and nasty families, made from a seed alone. */
#ifndef SUPPORT_SHAPES_H
#define SUPPORT_SHAPES_H

#include <gnomon/gnomon_clip.h>
#include <stdint.h>

/* Growing arrays behind a gno_shape; all zero is an empty one. Allocation failures end the program. */
typedef struct shape_buffer {
    size_t *polygon_start, *ring_start;
    double *points;
    size_t polygons, rings, count;
    size_t polygon_room, ring_room, point_room;
} shape_buffer;

void shape_clear(shape_buffer *b);
void shape_free(shape_buffer *b);
void shape_begin_polygon(shape_buffer *b);
void shape_begin_ring(shape_buffer *b);
void shape_point(shape_buffer *b, double x, double y);
gno_shape shape_view(const shape_buffer *b);

/* xorshift64*: the same numbers everywhere */
typedef struct shape_random {
    uint64_t state;
} shape_random;

double shape_uniform(shape_random *r, double low, double high);
int shape_integer(shape_random *r, int low, int high); /* both included */

enum {
    SHAPES_STARS, SHAPES_CONVEX, SHAPES_COMBS, SHAPES_SPIRALS, SHAPES_NESTED, SHAPES_HILBERT, SHAPES_SELF, SHAPES_GRID,
    SHAPES_SLIVERS, SHAPES_LATTICE, SHAPES_TANGLE, SHAPES_FAN, SHAPES_ON_EDGE, SHAPES_ZIGZAG, SHAPES_BOXES, SHAPES_FAMILIES
};
extern const char *const shapes_name[SHAPES_FAMILIES];

/* A pair of shapes of one family; `size` scales the number of points (1: tens to a hundred). */
void shapes_make(int family, uint64_t seed, int size, shape_buffer *subject, shape_buffer *clip);

/* Convex hexagons as the shadows of `count` boxes on the ground, with the density of a town, inside [0,side]^2 but for the
 * outermost; returns side. */
double shapes_shadows(size_t count, uint64_t seed, shape_buffer *to);

#endif
