/* clipper.h -- the clipper's memory and the passes over it.
 *
 * Data flow of one call, each arrow one file of this folder:
 *
 *   shapes --grid--> points, segments --cells, meet--> splits --pieces--> edges --sweep--> linked half-edges --rings--> result
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

/* A rectangle of pixels, low <= x < high. */
typedef struct gnoi_cell {
    int64_t low[2], high[2];
    int depth; /* lattices it lies in */
} gnoi_cell;

/* Segments at one place, in the cell that is being done. */
typedef struct gnoi_box {
    int64_t x0, x1, y0, y1; /* ends included */
    int64_t low, high;      /* along the cell's own direction (meet.c), rounded outwards */
    uint32_t segment;       /* the first of them */
    uint32_t first, count;  /* all, in c->members */
} gnoi_box;

#define GNOI_CLIP_SEEN 64


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
    uint32_t block;    /* of the status, while the edge is in it */
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

/* A few edges of the status, from below. */
#define GNOI_CLIP_BLOCK 30
typedef struct gnoi_block {
    uint32_t place; /* in the row of blocks */
    uint32_t count;
    uint32_t edge[GNOI_CLIP_BLOCK];
} gnoi_block;

typedef struct gnoi_place {
    uint32_t block, index;
} gnoi_place;

/* What the sweep meets at a vertex. */
typedef struct gnoi_status {
    gnoi_place at;  /* of the first edge that ends there, or of what starts there */
    uint32_t below; /* edge just below, or NONE */
    size_t count;   /* edges that end there: ending[0..count) */
} gnoi_status;

struct gno_clipper {
    gno_context *context;
    int bits; /* GNOI_CLIP_BITS; tests take fewer, so that pixels are large */

    char complaint[120]; /* of the call in hand about an argument or a limit, for the message; or "" */
    size_t steps;        /* since the last question whether to stop; goes on from call to call */

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

    gnoi_segment *ordered; /* cells: the other array while segments are put in order */
    size_t ordered_capacity;
    uint32_t *cell_list; /* stack of lists of segments */
    size_t cell_capacity;
    gnoi_box *boxes; /* of the present cell's segments, `low` rising but for `slack` */
    size_t box_count, box_capacity;
    int64_t slack;          /* how far apart along x segments may be and yet stand in any order */
    int64_t cell_slack;     /* the same for the boxes */
    double across[2];       /* the cell's direction */
    uint32_t *members;      /* segments of the boxes */
    size_t member_capacity;
    gnoi_site seen[GNOI_CLIP_SEEN]; /* crossings met last in the cell, by hash */
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

    gnoi_block *blocks; /* status: edges over the sweep line */
    size_t block_count, block_capacity;
    uint32_t free_block; /* first of those not in use, linked by `place` */
    uint32_t *row;       /* blocks from below */
    size_t row_count, row_capacity;
    uint32_t *ending; /* edges that end in the present vertex, from below */
    size_t ending_capacity;
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

/* The passes, in order. Each returns GNO_OK, MEMORY (also when the call shall stop: context.h), or LIMIT with the clipper's complaint.
 * None touches the context's message: worker threads clip too. */

/* grid.c: checks both shapes, chooses the grid, rounds. clip may be NULL. Also ARGUMENT. */
gno_status gnoi_clip_import(gno_clipper *c, const gno_shape *subject, const gno_shape *clip);

/* cells.c: finds all hot pixels and the segments that pass through each. Puts the segments in another order. */
gno_status gnoi_clip_meet(gno_clipper *c);

/* meet.c: the same for the pixels of one cell; `list` are all segments that pass one of them, in order. 0: out of memory, LIMIT or stop. */
int gnoi_clip_meet_in_cell(gno_clipper *c, const gnoi_cell *cell, const uint32_t *list, size_t count);

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

/* Empties the status; 0: out of memory, as below. */
int gnoi_status_clear(gno_clipper *c);

/* Looks around vertex v: `ending` is an edge that ends there, NONE if none does. Fills *met and c->ending. */
int gnoi_status_meet(gno_clipper *c, uint32_t v, uint32_t ending, gnoi_status *met);

/* Puts the edges first .. first+add-1 in the place of those that ended. */
int gnoi_status_replace(gno_clipper *c, const gnoi_status *met, uint32_t first, size_t add);

/* Formats the complaint and returns status. */
gno_status gnoi_clip_refuse(gno_clipper *c, gno_status status, const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 3, 4)))
#endif
    ;

static inline gno_status gnoi_clip_too_many(gno_clipper *c, const char *what)
{
    return gnoi_clip_refuse(c, GNO_ERROR_LIMIT, "more than 2^31 %s", what);
}

/* Counts steps of some nanoseconds each, and asks now and then whether to stop. */
#define GNOI_CLIP_STEPS 65536
static inline int gnoi_clip_stopped(gno_clipper *c, size_t steps)
{
    c->steps += steps;
    if (c->steps < GNOI_CLIP_STEPS)
        return 0;
    c->steps = 0;
    return gnoi_stopped(c->context);
}

/* The same in a loop of small steps. */
static inline int gnoi_clip_stopped_at(gno_clipper *c, size_t step)
{
    return step % 512 == 511 && gnoi_clip_stopped(c, 512);
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
