/* lines.h -- the visible pieces of sample lines: hidden surfaces removed exactly along each line.
 *
 * Place in the data flow: segments of polygons on a line, in any order (nearest first is fastest) -> sorted, disjoint visible
 * pieces -> coverage. Positions along a line are integers, 2^-16 pixel from the tile's left edge, so that pieces fit
 * together exactly and their lengths add up exactly.
 * Rules: the nearer surface is kept; where two cross inside their overlap the piece is cut there; where they lie on each
 * other (nearer to each other's plane than the tolerance over the whole overlap, and not merely meeting there) the higher priority
 * wins, then the lower polygon number.
 * Invariants of a line: pieces ascend, do not overlap, have x0 < x1 and lie in [xa,xb); `uncovered` is what they
 * leave free; no piece is farther than `farthest`. A piece stays in its line for good, though it may shrink or change hands.
 */
#ifndef GNOI_SCAN_LINES_H
#define GNOI_SCAN_LINES_H

#include "base/context.h"
#include "project/view.h"

#define GNOI_X_BITS 16
#define GNOI_X_ONE 65536

/* A line is searched from the last place looked at in the same stretch of 2^GNOI_MARK_BITS units, or in the nearest before it. */
#define GNOI_MARK_BITS GNOI_X_BITS
#define GNOI_LINE_MARKS 32

/* A surface's nearness over the tile and what decides when two lie on each other. */
typedef struct gnoi_depth {
    double fx, fy, f0;           /* nearness = fx x + fy y + f0, x in line units, y in picture rows */
    double tolerance_z, tolerance_0; /* nearness within tolerance_z * nearness + tolerance_0 is "on" the surface */
    uint32_t index;              /* the scene's polygon number */
    int32_t priority;
    float nearest, farthest;     /* bounds of nearness within the tile */
    float surely_before, surely_behind; /* what is nearer than the first is in front of it, what is farther than the second
                                           behind it: the bounds widened by the tolerance */
} gnoi_depth;

typedef struct gnoi_piece {
    int32_t x0, x1;
    uint32_t slot;  /* of gnoi_depth in the tile */
    uint32_t next;  /* along the line; 0 ends it */
    uint32_t chain; /* the engine's: next piece of the same slot in the row */
    uint32_t line;
    float surely_before, surely_behind; /* the slot's */
} gnoi_piece;

typedef struct gnoi_line {
    double y;
    int32_t xa, xb;
    int32_t uncovered;
    float farthest;
    uint32_t first; /* 0: none */
    uint32_t marked;                /* bit i: near[i] is set */
    uint32_t near[GNOI_LINE_MARKS]; /* from the last stretch of the line to the first, a piece that ended before where a search there began */
} gnoi_line;

typedef struct gnoi_lines {
    gno_context *context;
    int failed; /* sticky: memory ran out; pieces are then lost, nothing else breaks */
    size_t line_count, line_capacity;
    gnoi_line *lines;
    size_t piece_count, piece_capacity; /* piece 0 is a sink */
    gnoi_piece *pieces;
    size_t depth_count, depth_capacity;
    gnoi_depth *depths;
} gnoi_lines;

/* Empties lines and pieces (depths stay). */
void gnoi_lines_reset(gnoi_lines *lines);
void gnoi_lines_free(gnoi_lines *lines);

/* Adds an empty line covering [xa,xb) at picture row coordinate y. */
void gnoi_lines_add(gnoi_lines *lines, double y, int32_t xa, int32_t xb);

/* Inserts the segment [x0,x1) of `slot` into a line; it is cut to the line's range. Returns 1 when any of it is visible now. */
int gnoi_lines_insert(gnoi_lines *lines, uint32_t line, uint32_t slot, int32_t x0, int32_t x1);

/* Which of two surfaces is in front over [x0,x1) of a line at y: +1 a, -1 b, 0 they cross at *cut, inside, with a in front on the
 * left when *a_first. */
int gnoi_lines_compare(const gnoi_depth *a, const gnoi_depth *b, double y, int32_t x0, int32_t x1, int32_t *cut, int *a_first);

/* A piece that is in no list yet; 0 when memory fails. */
uint32_t gnoi_lines_new_piece(gnoi_lines *lines, uint32_t line, uint32_t slot, int32_t x0, int32_t x1);

#endif
