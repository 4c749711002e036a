/* lines.c -- see lines.h. */
#include "scan/lines.h"
#include "base/bits.h"

void gnoi_lines_reset(gnoi_lines *lines)
{
    lines->line_count = 0;
    lines->piece_count = 1;
}

void gnoi_lines_free(gnoi_lines *lines)
{
    gnoi_free(lines->context, lines->lines, lines->line_capacity, sizeof *lines->lines);
    gnoi_free(lines->context, lines->pieces, lines->piece_capacity, sizeof *lines->pieces);
    gnoi_free(lines->context, lines->depths, lines->depth_capacity, sizeof *lines->depths);
}

void gnoi_lines_add(gnoi_lines *lines, double y, int32_t xa, int32_t xb)
{
    gnoi_line *l;
    if (lines->line_count == lines->line_capacity &&
        !gnoi_reserve(lines->context, (void **)&lines->lines, &lines->line_capacity, lines->line_count + 1, sizeof *lines->lines)) {
        lines->failed = 1;
        return;
    }
    l = &lines->lines[lines->line_count++];
    l->y = y;
    l->xa = xa;
    l->xb = xb;
    l->uncovered = xb - xa;
    l->farthest = HUGE_VALF;
    l->first = 0;
    l->marked = 0;
}

/* A new piece; when memory fails the sink, whose links lead nowhere. */
static uint32_t new_piece(gnoi_lines *lines)
{
    if (lines->piece_count >= lines->piece_capacity &&
        !gnoi_reserve(lines->context, (void **)&lines->pieces, &lines->piece_capacity, lines->piece_count + 1,
                      sizeof *lines->pieces)) {
        lines->failed = 1;
        return 0;
    }
    return (uint32_t)lines->piece_count++;
}

static inline void set_slot(gnoi_piece *piece, uint32_t slot, const gnoi_depth *depth)
{
    piece->slot = slot;
    piece->surely_before = depth->surely_before;
    piece->surely_behind = depth->surely_behind;
}

/* A piece that is in no list yet, over [x0,x1). */
static inline uint32_t make_piece(gnoi_lines *lines, uint32_t line, uint32_t slot, int32_t x0, int32_t x1)
{
    uint32_t p = new_piece(lines);
    gnoi_piece *piece = &lines->pieces[p];
    if (p == 0)
        return 0;
    piece->x0 = x0;
    piece->x1 = x1;
    piece->line = line;
    piece->chain = 0;
    set_slot(piece, slot, &lines->depths[slot]);
    return p;
}

uint32_t gnoi_lines_new_piece(gnoi_lines *lines, uint32_t line, uint32_t slot, int32_t x0, int32_t x1)
{
    uint32_t p = make_piece(lines, line, slot, x0, x1);
    if (p)
        lines->pieces[p].next = 0;
    return p;
}

/* Links a new piece behind `before` (0: at the line's head). Returns it, or 0 when memory fails. */
static uint32_t link_piece(gnoi_lines *lines, uint32_t line, uint32_t before, uint32_t slot, int32_t x0, int32_t x1)
{
    uint32_t p = make_piece(lines, line, slot, x0, x1), *link = before ? &lines->pieces[before].next : &lines->lines[line].first;
    if (p == 0)
        return 0;
    lines->pieces[p].next = *link;
    *link = p;
    return p;
}

/* Adds [x0,x1) of slot behind `before`, joined to it when it is the same surface ending there. Returns the piece that ends at x1. */
static inline uint32_t append_piece(gnoi_lines *lines, uint32_t line, uint32_t before, uint32_t slot, int32_t x0, int32_t x1)
{
    if (before && lines->pieces[before].slot == slot && lines->pieces[before].x1 == x0) {
        lines->pieces[before].x1 = x1;
        return before;
    }
    return link_piece(lines, line, before, slot, x0, x1);
}

/* Surfaces that part by so many tolerances within a pixel do not lie on each other, though they may be as near where they meet: the
 * two sides of a sharp edge seen along it. */
#define PARTING 16

static double parts(const gnoi_depth *a, const gnoi_depth *b)
{
    return fabs(a->fx - b->fx) * GNOI_X_ONE + fabs(a->fy - b->fy);
}

/* Which of two surfaces is in front over [x0,x1): +1 a, -1 b, 0 they cross at *cut with a in front on the left when
 * *a_first. */
static int in_front(const gnoi_depth *a, const gnoi_depth *b, double y, int32_t x0, int32_t x1, int32_t *cut, int *a_first)
{
    double za = a->fy * y + a->f0, zb = b->fy * y + b->f0;
    double za0 = za + a->fx * x0, za1 = za + a->fx * x1, d0 = za0 - (zb + b->fx * x0), d1 = za1 - (zb + b->fx * x1);
    double ta0 = a->tolerance_z * za0 + a->tolerance_0, ta1 = a->tolerance_z * za1 + a->tolerance_0;
    double tb0 = b->tolerance_z * za0 + b->tolerance_0, tb1 = b->tolerance_z * za1 + b->tolerance_0;
    double t0 = ta0 < tb0 ? ta0 : tb0, t1 = ta1 < tb1 ? ta1 : tb1;
    int s0 = d0 > t0 ? 1 : d0 < -t0 ? -1 : 0, s1 = d1 > t1 ? 1 : d1 < -t1 ? -1 : 0;
    if (s0 == 0 && s1 == 0) {
        if (d0 + d1 != 0 && parts(a, b) > PARTING * t0)
            return d0 + d1 > 0 ? 1 : -1;
        if (a->priority != b->priority)
            return a->priority > b->priority ? 1 : -1;
        return a->index < b->index ? 1 : -1;
    }
    if (s0 * s1 >= 0)
        return s0 + s1 > 0 ? 1 : -1;
    double t = d0 / (d0 - d1) * (x1 - x0);
    *cut = x0 + (int32_t)(t + 0.5);
    *a_first = s0 > 0;
    if (*cut <= x0)
        return s1;
    if (*cut >= x1)
        return s0;
    return 0;
}

int gnoi_lines_compare(const gnoi_depth *a, const gnoi_depth *b, double y, int32_t x0, int32_t x1, int32_t *cut, int *a_first)
{
    if (a->nearest < b->surely_behind)
        return -1;
    if (a->farthest > b->surely_before)
        return 1;
    return in_front(a, b, y, x0, x1, cut, a_first);
}

/* Replaces [u,v) of piece p by slot. `before` precedes p. Returns the last piece ending at or before v. No piece is taken out
 * of the line, or marks would lead astray. */
static uint32_t replace_part(gnoi_lines *lines, uint32_t line, uint32_t before, uint32_t p, uint32_t slot, int32_t u, int32_t v)
{
    gnoi_piece old = lines->pieces[p];
    if (u == old.x0 && v == old.x1) {
        set_slot(&lines->pieces[p], slot, &lines->depths[slot]);
        return p;
    }
    if (u == old.x0) {
        lines->pieces[p].x0 = v;
        return append_piece(lines, line, before, slot, u, v);
    }
    lines->pieces[p].x1 = u;
    p = link_piece(lines, line, p, slot, u, v);
    if (p && v < old.x1)
        link_piece(lines, line, p, old.slot, v, old.x1);
    return p;
}

/* A piece that ends at or before x0, as late as marks tell; 0 when they do not. */
static inline uint32_t find_mark(const gnoi_lines *lines, const gnoi_line *l, int32_t x0, unsigned at)
{
    for (uint32_t left = l->marked & (0xffffffffu << at); left; left &= left - 1) {
        uint32_t p = l->near[gnoi_lowest_bit(left)];
        if (lines->pieces[p].x1 <= x0)
            return p;
    }
    return 0;
}

/* The last piece that ends at or before x0, 0 when there is none. */
static inline uint32_t search_from(gnoi_lines *lines, gnoi_line *l, int32_t x0)
{
    const unsigned at = ~(unsigned)(x0 >> GNOI_MARK_BITS) & (GNOI_LINE_MARKS - 1);
    uint32_t before = find_mark(lines, l, x0, at), p;
    for (p = before ? lines->pieces[before].next : l->first; p && lines->pieces[p].x1 <= x0; p = lines->pieces[p].next)
        before = p;
    if (before) {
        l->near[at] = before;
        l->marked |= 1u << at;
    }
    return before;
}

/* Which of a surface and a piece is in front over [x0,x1), as gnoi_lines_compare; by their bounds in the tile alone where these tell. */
static inline int compare(const gnoi_lines *lines, const gnoi_depth *a, const gnoi_piece *b, double y, int32_t x0, int32_t x1, int32_t *cut,
                          int *a_first)
{
    if (a->nearest < b->surely_behind)
        return -1;
    if (a->farthest > b->surely_before)
        return 1;
    return in_front(a, &lines->depths[b->slot], y, x0, x1, cut, a_first);
}

int gnoi_lines_insert(gnoi_lines *lines, uint32_t line, uint32_t slot, int32_t x0, int32_t x1)
{
    gnoi_line *l = &lines->lines[line];
    const gnoi_depth *depth = &lines->depths[slot];
    uint32_t before, p;
    int visible = 0;
    x0 = x0 < l->xa ? l->xa : x0;
    x1 = x1 > l->xb ? l->xb : x1;
    if (x0 >= x1)
        return 0;
    before = search_from(lines, l, x0);
    p = before ? lines->pieces[before].next : l->first;
    while (x0 < x1 && !lines->failed) {
        int32_t v = p ? lines->pieces[p].x0 : x1, cut = 0;
        int front, new_first = 0;
        if (v > x0) {
            v = v < x1 ? v : x1;
            before = append_piece(lines, line, before, slot, x0, v);
            l->uncovered -= v - x0;
            visible = 1;
            x0 = v;
            continue;
        }
        v = lines->pieces[p].x1 < x1 ? lines->pieces[p].x1 : x1;
        front = compare(lines, depth, &lines->pieces[p], l->y, x0, v, &cut, &new_first);
        if (front >= 0) {
            int32_t from = front || new_first ? x0 : cut, to = front || !new_first ? v : cut;
            before = replace_part(lines, line, before, p, slot, from, to);
            visible = 1;
        }
        /* Step behind v: everything up to there is settled. */
        p = before ? lines->pieces[before].next : l->first;
        while (p && lines->pieces[p].x1 <= v) {
            before = p;
            p = lines->pieces[p].next;
        }
        x0 = v;
    }
    if (visible && depth->farthest < l->farthest)
        l->farthest = depth->farthest;
    return visible;
}
