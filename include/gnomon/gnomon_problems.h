/* gnomon_problems.h -- what is wrong with the polygons of a scene, one by one. Part of libgnomon.
 *
 * Nothing here keeps a scene from being drawn: a drawing takes every set of polygons. But a gap or a turned polygon in what was meant
 * to be a closed body is seldom wanted, and closed bodies are drawn faster. Compiles as C89 to C17 and C++98 to C++17.
 */
#ifndef GNOMON_GNOMON_PROBLEMS_H
#define GNOMON_GNOMON_PROBLEMS_H

#include <gnomon/gnomon.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Vertices of equal position count as one, whatever mesh they are of. Edges are those of all rings; an edge whose ends coincide is
 * none. Polygons that repeat another, and details, have no part in the edges: they lie on polygons that have. */
typedef enum gno_problem_kind {
    GNO_PROBLEM_DEGENERATE = 0, /* no area: not drawn */
    GNO_PROBLEM_NON_PLANAR = 1, /* corners off its plane: drawn as triangles */
    GNO_PROBLEM_DUPLICATE = 2,  /* the same edges as an earlier polygon, wound either way; `other` is the first of them */
    GNO_PROBLEM_FLIPPED = 3,    /* wound against its neighbours: of polygons that hang together by edges of just two, the fewer that
                                   disagree with the rest (of equally many, those that disagree with the first); where no winding
                                   suits all, as on a Moebius strip, the later polygon of an edge that is left over */
    GNO_PROBLEM_OPEN_EDGE = 4,  /* an edge of one polygon alone */
    GNO_PROBLEM_CROWDED_EDGE = 5 /* an edge of more than two polygons, passed more often one way than the other */
} gno_problem_kind;

#define GNO_PROBLEM_KINDS 6

typedef struct gno_problem {
    gno_problem_kind kind;
    size_t polygon; /* number of gno_scene_polygon */
    long other;     /* a duplicate's first, a crowded edge's second polygon; else -1 */
    int vertex[2];  /* edges: the ends, as `polygon` names and passes them; else -1 */
    int border;     /* 1: an open edge of a part (polygons that hang together by edges of just two) that lies in one plane, as a floor
                       does: it has to end somewhere, so the edge is no gap in a body; else 0 */
} gno_problem;

/* Non-zero stops with CANCELLED. It must not change the scene. */
typedef int (*gno_problem_fn)(void *user, const gno_problem *problem);

/* Finds the problems, preparing the scene if need be: counts[kind] of each, and a call of `found` for each, kind by kind, polygons
 * in order, edges in the order of their ends. found and counts may be NULL. Holds some 140 bytes a polygon and 32 a corner meanwhile.
 * Edges are balanced as in Jacobson, Kavan and Sorkine-Hornung, "Robust inside-outside segmentation using generalized winding
 * numbers" (2013). Errors: MEMORY, ARGUMENT, CANCELLED. */
GNO_API gno_status gno_scene_find_problems(gno_scene *scene, int threads, gno_problem_fn found, void *user,
                                           size_t counts[GNO_PROBLEM_KINDS]);

#ifdef __cplusplus
}
#endif

#endif
