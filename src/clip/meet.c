/* meet.c -- where segments meet: the hot pixels of snap rounding and the segments that bend at them.
 *
 * Place: second pass (clipper.h). In: segments. Out: splits, and a point for each crossing.
 *
 * A *pixel* is the square of side 1 around a grid point, left and lower border included. A pixel is *hot* when it holds an end of a
 * segment or a point where two segments cross. Every segment bends at the grid points of the hot pixels it passes
 * through, in the order it passes them; pixels are passed whole or not at all, decided exactly. This is snap rounding (Hobby 1999;
 * Guibas and Marimont 1998), and their theorem is what the later passes rest on: bent segments meet in their bends alone,
 * or run along one another from bend to bend; no segment has been carried across a bend of another. One round is
 * enough: hot pixels come from the segments as given, not from the bent ones. Overlaps, touching ends and vertices on
 * edges are no special cases: an end on a segment is an end in a pixel that the segment passes.
 *
 * The plane is halved again and again until a cell holds few segments; cells are borders of pixels, so that each pixel lies in one
 * cell with all the segments that pass it, and each cell is done alone.
 */
#include "clip/clipper.h"

#define FEW 12          /* segments in a cell that is not halved */
#define SAMPLES 16      /* segments that vote on where to halve */
#define ROUNDING 16.0   /* grid units: more than the error of a side test in doubles */

#define DEEPEST 160     /* halvings: more than the bits of both axes */

typedef struct cell {
    int64_t low[2], high[2]; /* pixels low <= x < high */
    int depth;
} cell;

typedef struct list {
    size_t first, count; /* in cell_list */
} list;

/* ---- exact tests ----------------------------------------------------------------------------------------------- */

static int in_cell(const cell *where, gnoi_site p)
{
    return p.x >= where->low[0] && p.x < where->high[0] && p.y >= where->low[1] && p.y < where->high[1];
}

static int64_t low_y(const gnoi_segment *s)
{
    return s->a.y < s->b.y ? s->a.y : s->b.y;
}

static int64_t high_y(const gnoi_segment *s)
{
    return s->a.y < s->b.y ? s->b.y : s->a.y;
}

static int boxes_meet(const gnoi_segment *s, const gnoi_segment *t)
{
    return s->a.x <= t->b.x && t->a.x <= s->b.x && low_y(s) <= high_y(t) && low_y(t) <= high_y(s);
}

static gnoi_wide side(const gnoi_segment *s, gnoi_site p)
{
    return gnoi_wide_cross(s->b.x - s->a.x, s->b.y - s->a.y, p.x - s->a.x, p.y - s->a.y);
}

/* Whether the line through s passes the pixel of a point whose side is f. Over the pixel the side changes by half of |dx| + |dy|
 * either way; where it just reaches 0 the line touches a corner, and only the lower left one belongs to the pixel. */
static int line_passes(const gnoi_segment *s, gnoi_wide f)
{
    int64_t dx = s->b.x - s->a.x, dy = s->b.y - s->a.y, reach = dx + (dy < 0 ? -dy : dy), value;
    return gnoi_wide_small(f, &value) && ((2 * value < reach && -2 * value < reach) || 2 * value == dx - dy);
}

/* Whether a point whose side of s is f is so far off the line through s that no line from there to a point as far off on the same side
 * has an end of s in its pixel; corners count as near, whichever pixel they belong to. */
static int far_off(const gnoi_segment *s, gnoi_wide f)
{
    int64_t dx = s->b.x - s->a.x, dy = s->b.y - s->a.y, reach = dx + (dy < 0 ? -dy : dy), value;
    return !gnoi_wide_small(f, &value) || 2 * value > reach || -2 * value > reach;
}

/* The same as line_passes for the segment: for grid points the boxes decide what the line leaves open. */
static int passes(const gnoi_segment *s, gnoi_site p, gnoi_wide f)
{
    return p.x >= s->a.x && p.x <= s->b.x && p.y >= low_y(s) && p.y <= high_y(s) && line_passes(s, f);
}

/* ---- recording ------------------------------------------------------------------------------------------------- */

static int add_split(gno_clipper *c, uint32_t segment, uint32_t point)
{
    if (c->split_count >= GNOI_CLIP_MOST || !GNOI_CLIP_RESERVE(c, splits, split_capacity, c->split_count + 1))
        return 0;
    c->splits[c->split_count].segment = segment;
    c->splits[c->split_count++].point = point;
    return 1;
}

static int add_point(gno_clipper *c, gnoi_site p)
{
    if (c->point_count >= GNOI_CLIP_MOST || !GNOI_CLIP_RESERVE(c, points, point_capacity, c->point_count + 1))
        return 0;
    c->points[c->point_count++] = p;
    return 1;
}

/* The pixel of the proper crossing of s and t; ft and fs are the sides of t's lower end to s and of s's to t. */
static gnoi_site crossing(const gnoi_segment *s, const gnoi_segment *t, gnoi_wide s_to_t)
{
    int64_t dx = s->b.x - s->a.x, dy = s->b.y - s->a.y;
    gnoi_wide den = gnoi_wide_cross(dx, dy, t->b.x - t->a.x, t->b.y - t->a.y), num = s_to_t;
    gnoi_site p;
    if (gnoi_wide_sign(den) < 0)
        den = gnoi_wide_negate(den);
    if (gnoi_wide_sign(num) < 0)
        num = gnoi_wide_negate(num);
    p.x = s->a.x + gnoi_wide_share(dx, num, den);
    p.y = s->a.y + gnoi_wide_share(dy, num, den);
    return p;
}

/* A new hot pixel bends every segment of the cell that passes it. */
static int add_crossing(gno_clipper *c, const cell *where, list segments, gnoi_site p)
{
    uint32_t point = (uint32_t)c->point_count;
    if (!in_cell(where, p))
        return 1;
    if (!add_point(c, p))
        return 0;
    for (size_t i = 0; i < segments.count; i++) {
        uint32_t id = c->cell_list[segments.first + i];
        const gnoi_segment *s = &c->segments[id];
        if (p.x < s->a.x || p.x > s->b.x || !passes(s, p, side(s, p)))
            continue;
        if (!add_split(c, id, point))
            return 0;
    }
    return 1;
}

/* ---- one pair -------------------------------------------------------------------------------------------------- */

/* t's starting point as a hot pixel on s; each point of a ring starts one segment, so none is forgotten and none met twice. */
static int start_on(gno_clipper *c, const cell *where, uint32_t s_id, const gnoi_segment *t, gnoi_wide at_a, gnoi_wide at_b)
{
    const gnoi_segment *s = &c->segments[s_id];
    gnoi_site p = t->sign > 0 ? t->a : t->b;
    if (!in_cell(where, p) || !passes(s, p, t->sign > 0 ? at_a : at_b) || gnoi_site_equal(p, s->a) || gnoi_site_equal(p, s->b))
        return 1;
    return add_split(c, s_id, t->sign > 0 ? t->pa : t->pb);
}

static int meet_pair(gno_clipper *c, const cell *where, list segments, uint32_t s_id, uint32_t t_id)
{
    const gnoi_segment *s = &c->segments[s_id], *t = &c->segments[t_id];
    gnoi_wide ta = side(s, t->a), tb = side(s, t->b), sa, sb;
    int side_a = gnoi_wide_sign(ta), side_b = gnoi_wide_sign(tb);
    if (side_a * side_b > 0 && far_off(s, ta) && far_off(s, tb))
        return 1;
    sa = side(t, s->a);
    sb = side(t, s->b);
    if (!start_on(c, where, s_id, t, ta, tb) || !start_on(c, where, t_id, s, sa, sb))
        return 0;
    if (side_a * side_b >= 0 || gnoi_wide_sign(sa) * gnoi_wide_sign(sb) >= 0)
        return 1;
    return add_crossing(c, where, segments, crossing(s, t, sa));
}

static int meet_in_cell(gno_clipper *c, const cell *where, list segments)
{
    for (size_t i = 1; i < segments.count; i++)
        for (size_t j = 0; j < i; j++) {
            uint32_t s = c->cell_list[segments.first + i], t = c->cell_list[segments.first + j];
            if (boxes_meet(&c->segments[s], &c->segments[t]) && !meet_pair(c, where, segments, s, t))
                return 0;
        }
    return 1;
}

/* ---- halving --------------------------------------------------------------------------------------------------- */

static int64_t clamp(int64_t v, int64_t low, int64_t high)
{
    return v < low ? low : v > high ? high : v;
}

/* Mean middle of some of the segments, each cut to the cell's box, and how far apart middles are, along both axes. */
static void choose_cut(const gno_clipper *c, const cell *where, list segments, int64_t cut[2], int64_t spread[2])
{
    size_t step = segments.count / SAMPLES + 1, taken = 0;
    double sum[2] = {0, 0};
    int64_t low[2] = {INT64_MAX, INT64_MAX}, high[2] = {INT64_MIN, INT64_MIN};
    for (size_t i = 0; i < segments.count; i += step, taken++) {
        const gnoi_segment *s = &c->segments[c->cell_list[segments.first + i]];
        int64_t from[2] = {s->a.x, low_y(s)}, to[2] = {s->b.x, high_y(s)};
        for (int k = 0; k < 2; k++) {
            int64_t middle = (clamp(from[k], where->low[k], where->high[k]) + clamp(to[k], where->low[k], where->high[k])) / 2;
            sum[k] += (double)middle;
            low[k] = middle < low[k] ? middle : low[k];
            high[k] = middle > high[k] ? middle : high[k];
        }
    }
    for (int k = 0; k < 2; k++) {
        cut[k] = clamp((int64_t)(sum[k] / (double)taken), where->low[k] + 1, where->high[k] - 1);
        spread[k] = high[k] - low[k];
    }
}

/* May s pass through the cell? Rounding errs towards yes. */
static int may_pass(const gnoi_segment *s, const cell *where)
{
    double dx = (double)(s->b.x - s->a.x), dy = (double)(s->b.y - s->a.y);
    double half_x = 0.5 * (double)(where->high[0] - where->low[0]), half_y = 0.5 * (double)(where->high[1] - where->low[1]);
    double x = (double)(where->low[0] - s->a.x) + half_x, y = (double)(where->low[1] - s->a.y) + half_y;
    double f = dx * y - dy * x, reach = dx * (half_y + ROUNDING) + (dy < 0 ? -dy : dy) * (half_x + ROUNDING);
    return f <= reach && -f <= reach;
}

/* Lists the segments of both halves behind the stack's end; 0: out of memory. */
static int halve(gno_clipper *c, list segments, size_t top, int axis, const cell half[2], list lists[2])
{
    int64_t cut = half[1].low[axis];
    if (!GNOI_CLIP_RESERVE(c, cell_list, cell_capacity, top + 2 * segments.count))
        return 0;
    lists[0].first = top;
    lists[1].first = top + segments.count;
    lists[0].count = lists[1].count = 0;
    for (size_t i = 0; i < segments.count; i++) {
        uint32_t id = c->cell_list[segments.first + i];
        const gnoi_segment *s = &c->segments[id];
        int64_t low = axis == 0 ? s->a.x : low_y(s), high = axis == 0 ? s->b.x : high_y(s);
        int in_low = low < cut, in_high = high >= cut;
        if (in_low && in_high) {
            in_low = may_pass(s, &half[0]);
            in_high = may_pass(s, &half[1]);
        }
        if (in_low)
            c->cell_list[lists[0].first + lists[0].count++] = id;
        if (in_high)
            c->cell_list[lists[1].first + lists[1].count++] = id;
    }
    return 1;
}

static int meet_below(gno_clipper *c, const cell *where, list segments, size_t top)
{
    int64_t cut[2], spread[2];
    if (segments.count > FEW && where->depth < DEEPEST) {
        choose_cut(c, where, segments, cut, spread);
        for (int attempt = 0, axis = spread[1] > spread[0]; attempt < 2; attempt++, axis = 1 - axis) {
            cell half[2] = {*where, *where};
            list lists[2];
            if (where->high[axis] - where->low[axis] < 2)
                continue;
            half[0].high[axis] = half[1].low[axis] = cut[axis];
            half[0].depth = half[1].depth = where->depth + 1;
            if (!halve(c, segments, top, axis, half, lists))
                return 0;
            /* Halves that together hold half as much again would not make the pairs fewer. */
            if (2 * (lists[0].count + lists[1].count) > 3 * segments.count || lists[0].count == segments.count ||
                lists[1].count == segments.count)
                continue;
            top = lists[1].first + lists[1].count;
            return meet_below(c, &half[0], lists[0], top) && meet_below(c, &half[1], lists[1], top);
        }
    }
    return meet_in_cell(c, where, segments);
}

gno_status gnoi_clip_meet(gno_clipper *c)
{
    list all = {0, c->segment_count};
    int64_t end = ((int64_t)1 << c->bits) + 2; /* rounding may reach one beyond the last pixel */
    cell where = {{0, 0}, {0, 0}, 0};
    where.high[0] = where.high[1] = end;
    c->split_count = 0;
    if (!GNOI_CLIP_RESERVE(c, cell_list, cell_capacity, c->segment_count + 1))
        return gnoi_clip_no_memory(c);
    for (size_t i = 0; i < c->segment_count; i++)
        c->cell_list[i] = (uint32_t)i;
    if (meet_below(c, &where, all, c->segment_count))
        return GNO_OK;
    if (c->point_count >= GNOI_CLIP_MOST || c->split_count >= GNOI_CLIP_MOST)
        return gnoi_clip_too_many(c, "crossings");
    return gnoi_clip_no_memory(c);
}
