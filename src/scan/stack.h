/* stack.h -- surfaces that let light through, laid over the opaque pieces of sample lines.
 *
 * Place in the data flow: opaque pieces of a line (lines.h) + segments of surfaces that are not opaque, in any order -> the parts
 * of those segments that lie before the opaque pieces -> one ordered stack for each part of the line -> pieces that overlap, each
 * with its tint: the share of its colour that reaches the eye.
 * What the eye gets along a ray is I = w1 I1 + t1 (w2 I2 + t2 (...)), surfaces from front to back, w a surface's own weight and
 * t what it lets through (the kt It of the global model, textbook chapter section 8.3, without refraction).
 * Rules: order as between opaque pieces (lines.h), cut where two surfaces cross. Invariants: the tints of the pieces over a point
 * of the line are those of its stack; where nothing lies before an opaque piece its tint is 1; nothing behind a tint of 0 is kept.
 */
#ifndef GNOI_SCAN_STACK_H
#define GNOI_SCAN_STACK_H

#include "base/sort.h"
#include "scan/lines.h"

/* What a surface does at a place: weight of its own colour, and what it lets through. `varies`: only near this place, so that
 * it has to be asked for in every pixel. */
typedef struct gnoi_pass {
    float own, through[3];
    int varies;
} gnoi_pass;

/* Asks for what the surface of a slot does over [x0,x1), a part of one pixel if it varies. An empty range asks whether it does,
 * and for what it does if not. */
typedef gnoi_pass (*gnoi_pass_fn)(void *user, uint32_t slot, int32_t x0, int32_t x1, double y);

/* What the eye gets of a piece: the share of its colour, and the share of all light that it keeps from behind (mean of the channels). */
typedef struct gnoi_tint {
    float rgb[3], hides;
} gnoi_tint;

/* A segment on a line; while the line is resolved, with the piece begun on it. */
typedef struct gnoi_segment {
    int32_t x0, x1;
    uint32_t slot, next; /* next: on the line, 0 ends it */
    gnoi_pass pass;
    int32_t from; /* the piece begun: where, and its tint */
    gnoi_tint tint;
} gnoi_segment;

/* No opaque piece is left over [x0,x1), by a gap or because what lies before hides it all: `tint` of the background is seen. */
typedef struct gnoi_bare {
    int32_t x0, x1;
    gnoi_tint tint;
} gnoi_bare;

typedef struct gnoi_stacks {
    gno_context *context;
    int failed; /* sticky: memory ran out */
    size_t segment_count, segment_capacity; /* segment 0 is none */
    gnoi_segment *segments;
    size_t head_capacity;
    uint32_t *heads;                        /* one for each line: its first segment */
    size_t order_capacity, active_capacity;
    gnoi_keyed *order;                      /* segments of the line at hand, by beginning; and scratch */
    uint32_t *active;                       /* those that lie over the part at hand, front to back */
    size_t tint_capacity;
    gnoi_tint *tints;                       /* one for each piece of the lines */
    size_t bare_count, bare_capacity;
    gnoi_bare *bares;
    size_t start_capacity;
    uint32_t *bare_start;                   /* line_count+1 offsets into bares */
} gnoi_stacks;

/* Makes ready for the lines' segments. */
void gnoi_stacks_reset(gnoi_stacks *stacks, const gnoi_lines *lines);
void gnoi_stacks_free(gnoi_stacks *stacks);

/* Adds the parts of [x0,x1) of `slot` that lie before the line's opaque pieces, which must be complete. */
void gnoi_stacks_insert(gnoi_stacks *stacks, const gnoi_lines *lines, uint32_t line, uint32_t slot, int32_t x0, int32_t x1);

/* Puts the stacks of all lines into their lists of pieces, which overlap from then on and take no more insertions. */
void gnoi_stacks_resolve(gnoi_stacks *stacks, gnoi_lines *lines, gnoi_pass_fn pass, void *user);

#endif
