/* clipper.h -- the clipper's memory and the passes over it.
 *
 * Data flow of one call, each arrow one file of this folder:
 *
 *   shapes --grid--> points, segments --meet--> splits --pieces--> edges --sweep--> linked half-edges --rings--> result
 *                                                   \--winding--/
 *
 * A *segment* is an edge of an input ring on the integer grid. A *split* says that a segment bends at a point: a hot pixel of snap
 * rounding. A *piece* is what lies between two splits; pieces at the same place become one *edge* of the planar
 * subdivision. Of an edge's two half-edges at most one, the one that has the result's inside on its left, is linked into a ring.
 * Segments, pieces and edges are stored from their lower to their higher end, by x and then y.
 */
#ifndef GNOI_CLIP_CLIPPER_H
#define GNOI_CLIP_CLIPPER_H

#include "base/context.h"
#include "base/sort.h"
#include "clip/wide.h"

#include <gnomon/gnomon_clip.h>

#define GNOI_CLIP_BITS 50 /* of a grid coordinate: leaves 27 of 128 for products and their sums */
#define GNOI_CLIP_NONE UINT32_MAX
#define GNOI_CLIP_MOST ((size_t)1 << 31) /* points, splits, pieces */

typedef struct gnoi_site {
    int64_t x, y;
} gnoi_site;

typedef struct gnoi_segment {
    gnoi_site a, b;    /* lower and higher end */
    uint32_t pa, pb;   /* their points */
    uint32_t polygon;
    int32_t sign;      /* +1: the ring runs from a to b, -1: from b to a */
} gnoi_segment;

typedef struct gnoi_split {
    uint32_t segment, point;
} gnoi_split;

/* Windings of the two operands gained when an edge is crossed upwards; where an operand is a single polygon the count of its
 * pieces, of which only the last bit matters. */
typedef struct gnoi_depth {
    int32_t of[2];
} gnoi_depth;

typedef struct gnoi_piece {
    uint32_t a, b; /* vertices */
    uint32_t polygon;
    int32_t sign;
} gnoi_piece;

enum { GNOI_EDGE_KEPT = 1, GNOI_EDGE_UP = 2, GNOI_EDGE_TRACED = 4 }; /* UP: inside above, so the half-edge a to b is linked */

typedef struct gnoi_edge {
    uint32_t a, b;     /* vertices */
    gnoi_depth change; /* from below to above */
    gnoi_depth above;
    uint32_t under;    /* kept edge that the part of the plane just below lies on, or NONE */
    uint32_t next;     /* half-edge after this one's */
    uint32_t polygon;  /* of the result */
    uint32_t flags;
} gnoi_edge;

enum { GNOI_POLYGON_CW = -1, GNOI_POLYGON_PARITY = 0, GNOI_POLYGON_CCW = 1 };

typedef struct gnoi_polygon {
    uint32_t first, end; /* segments */
    int8_t operand;      /* 0 subject, 1 clip */
    int8_t winding;      /* one convex ring this way round, or PARITY */
} gnoi_polygon;

typedef struct gnoi_ring {
    size_t first, end; /* in ring_vertex */
    uint32_t polygon;
    int outer;
} gnoi_ring;

struct gno_clipper {
    gno_context *context;
    int bits; /* GNOI_CLIP_BITS; tests take fewer, so that pixels are large */

    /* grid: a coordinate is (origin + integer) * cell */
    double cell;
    int64_t origin[2];
    uint32_t operand_polygons[2]; /* with at least one segment */

    gnoi_site *points; /* one for each segment, its ring's start; then one for each crossing */
    size_t point_count, point_capacity;
    gnoi_segment *segments;
    size_t segment_count, segment_capacity;
    gnoi_polygon *polygons;
    size_t polygon_count, polygon_capacity;

    uint32_t *cell_list; /* meet: stack of lists of segments */
    size_t cell_capacity;
    gnoi_split *splits;
    size_t split_count, split_capacity;

    gnoi_keyed *keys; /* pieces: sorting */
    size_t key_capacity;
    gnoi_keyed *key_scratch;
    size_t key_scratch_capacity;
    uint32_t *vertex_of; /* of each point */
    size_t vertex_of_capacity;
    gnoi_site *vertices; /* distinct points in order of x, then y */
    size_t vertex_count, vertex_capacity;
    uint32_t *bucket; /* counting sorts */
    size_t bucket_capacity;
    uint32_t *chain; /* vertices that segments bend at */
    size_t chain_capacity;
    gnoi_piece *pieces;
    size_t piece_count, piece_capacity;
    gnoi_piece *sorted; /* pieces by lower vertex, then slope */
    size_t sorted_capacity;
    gnoi_edge *edges;
    size_t edge_count, edge_capacity;

    uint32_t *status; /* sweep: edges over the sweep line, from below */
    size_t status_count, status_capacity;
    uint32_t *around; /* kept edges around a vertex; the path of a walk */
    size_t around_capacity;

    uint32_t *on_path; /* rings: for each vertex its place on the path, or NONE */
    size_t on_path_capacity;
    uint32_t *ring_vertex;
    size_t ring_vertex_count, ring_vertex_capacity;
    gnoi_ring *rings;
    size_t ring_count, ring_capacity;
    size_t result_polygons;

    size_t *result_polygon_start;
    size_t result_polygon_capacity;
    size_t *result_ring_start;
    size_t result_ring_capacity;
    double *result_points; /* pairs are counted */
    size_t result_point_capacity;
};

#define GNOI_CLIP_RESERVE(clipper, array, capacity, need) \
    gnoi_reserve((clipper)->context, (void **)&(clipper)->array, &(clipper)->capacity, (need), sizeof *(clipper)->array)

/* The passes, in order. Each returns GNO_OK or MEMORY or LIMIT with the context's message set. */

/* grid.c: checks both shapes, chooses the grid, rounds. clip may be NULL. Also ARGUMENT. */
gno_status gnoi_clip_import(gno_clipper *c, const gno_shape *subject, const gno_shape *clip);

/* meet.c: finds all hot pixels and the segments that pass through each. */
gno_status gnoi_clip_meet(gno_clipper *c);

/* vertices.c: tells the points apart and numbers them in sweep order. */
gno_status gnoi_clip_vertices(gno_clipper *c);

/* pieces.c: cuts segments into pieces and sorts them by lower vertex and slope. */
gno_status gnoi_clip_pieces(gno_clipper *c);

/* winding.c: gives each of the sorted pieces of polygons that are not convex the sign of its winding: +1 where the polygon's
 * inside lies above, -1 where below, 0 where the piece cancels. For operands of several polygons. */
gno_status gnoi_clip_winding(gno_clipper *c);

/* edges.c: pieces at one place become one edge; those that change nothing vanish. */
gno_status gnoi_clip_edges(gno_clipper *c);

/* sweep.c: depth above every edge, the half-edges that bound the result, their links. */
gno_status gnoi_clip_sweep(gno_clipper *c, gno_clip_op op);

/* rings.c: walks the links, cuts the walks into rings, gives holes to their polygons. */
gno_status gnoi_clip_rings(gno_clipper *c);

/* result.c: the rings as a shape in the clipper's result arrays. */
gno_status gnoi_clip_result(gno_clipper *c, gno_shape *result);

/* ---- shared by the sweeps (status.c) ------------------------------------------------------------------------------ */

/* Number of status edges that vertex v lies strictly above; the edges that end in v follow there. */
size_t gnoi_status_find(const gno_clipper *c, uint32_t v);

/* How many status edges from `at` on end in v. */
size_t gnoi_status_ending(const gno_clipper *c, size_t at, uint32_t v);

/* Puts the edges first .. first+add-1 in the place of `drop` ones. 0: out of memory. */
int gnoi_status_replace(gno_clipper *c, size_t at, size_t drop, uint32_t first, size_t add);

static inline gno_status gnoi_clip_no_memory(gno_clipper *c)
{
    return gnoi_fail(c->context, GNO_ERROR_MEMORY, "clipping: out of memory");
}

static inline gno_status gnoi_clip_too_many(gno_clipper *c, const char *what)
{
    return gnoi_fail(c->context, GNO_ERROR_LIMIT, "clipping: more than 2^31 %s", what);
}

/* Sign of the turn at a from b to p: +1 when p lies to the left of the line from a to b. */
static inline int gnoi_site_turn(gnoi_site a, gnoi_site b, gnoi_site p)
{
    return gnoi_wide_turn(b.x - a.x, b.y - a.y, p.x - a.x, p.y - a.y);
}

static inline int gnoi_site_equal(gnoi_site a, gnoi_site b)
{
    return a.x == b.x && a.y == b.y;
}

static inline int gnoi_site_less(gnoi_site a, gnoi_site b)
{
    return a.x < b.x || (a.x == b.x && a.y < b.y);
}

#endif
