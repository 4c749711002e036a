/* gnomon_clip.h -- polygons of the plane: union, intersection, difference and exclusive or, on plain arrays.
 *
 * Part of libgnomon; usable without a scene. Compiles as C89 to C17 and C++98 to C++17. How it works and why no
 * degenerate input can upset it: docs/algorithm.md, "Clipping polygons".
 */
#ifndef GNOMON_GNOMON_CLIP_H
#define GNOMON_GNOMON_CLIP_H

#include <gnomon/gnomon.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What becomes of the two shapes; XOR is what lies in one of them but not in both. */
typedef enum gno_clip_op {
    GNO_CLIP_UNION = 0,
    GNO_CLIP_INTERSECTION,
    GNO_CLIP_DIFFERENCE, /* subject without clip */
    GNO_CLIP_XOR
} gno_clip_op;

/* Polygons of the plane in flat arrays: polygon p has rings polygon_start[p] .. polygon_start[p+1]-1, ring r has points
 * ring_start[r] .. ring_start[r+1]-1, each an x,y pair in `points`. Rings are closed by themselves (the first point is not
 * repeated, though it may be), run either way round, and may cross, touch and overlap themselves and one another. The inside
 * of a polygon is the even-odd inside of its own rings; the shape is the union of its polygons. Counts may be 0. */
typedef struct gno_shape {
    size_t polygon_count;
    const size_t *polygon_start; /* polygon_count+1 ring offsets; NULL: polygon p is ring p, polygon_count equals ring_count */
    size_t ring_count;
    const size_t *ring_start; /* ring_count+1 point offsets */
    const double *points;     /* x,y pairs */
} gno_shape;

/* The memory of the clipper, kept from call to call, so that many small calls ask for none. One thread at a time. */
typedef struct gno_clipper gno_clipper;

/* Errors: MEMORY, ARGUMENT. The clipper must be destroyed before its context. */
GNO_API gno_status gno_clipper_create(gno_context *context, gno_clipper **clipper);
GNO_API void gno_clipper_destroy(gno_clipper *clipper); /* accepts NULL */

/* Combines two shapes. clip NULL: the union of the subject's polygons, whatever `op` is; a clip without polygons is an
 * ordinary empty shape. The result is a view into the clipper, valid until its next call; it may be the subject or the clip
 * of that call. Its polygons have disjoint insides; the first ring of each is its outer one, counter-clockwise, the others are
 * holes, clockwise; rings and polygons touch one another in single points at most, no ring touches itself, no polygon falls
 * apart into pieces: valid in the sense of OGC Simple Features. No point lies exactly on the line between its neighbours. The
 * same arrays in give the same arrays out, with every compiler.
 *
 * Accuracy: all points are first rounded to a grid whose cell is a power of two, between 2^-50 and 2^-49 of the larger
 * side of the bounds of both shapes together (coarser only where doubles of the largest coordinate's size are coarser), and points
 * where edges cross are rounded to it too. From there on everything is exact; an edge moves by less than one cell.
 * Errors: MEMORY; ARGUMENT (NULL, unknown op, offsets that fall, a coordinate that is not finite or beyond 1e300);
 * LIMIT (more than 2^31 points, crossings or pieces of edges). *result is an empty shape then. */
GNO_API gno_status gno_clip(gno_clipper *clipper, gno_clip_op op, const gno_shape *subject, const gno_shape *clip,
                            gno_shape *result);

/* Area of a shape whose polygons are disjoint, each one outer ring (first) and holes inside it, either way round, such
 * as a result of gno_clip; in squared units of the points. NULL or an empty shape: 0. */
GNO_API double gno_shape_area(const gno_shape *shape);

#ifdef __cplusplus
}
#endif

#endif
