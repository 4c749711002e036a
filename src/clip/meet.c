/* meet.c -- where segments meet: the hot pixels of snap rounding and the segments that bend at them.
 *
 * Place: second pass (clipper.h), called for each cell by cells.c. In: the segments of a cell. Out: splits, and a point for each crossing.
 *
 * A *pixel* is the square of side 1 around a grid point, left and lower border included. A pixel is *hot* when it holds an end of a
 * segment or a point where two segments cross. Every segment bends at the grid points of the hot pixels it passes
 * through, in the order it passes them; pixels are passed or not, decided exactly. This is snap rounding (Hobby 1999;
 * Guibas and Marimont 1998), and their theorem is what the later passes rest on: bent segments meet in their bends alone,
 * or run along one another from bend to bend; no segment has been carried across a bend of another. One round is
 * enough: hot pixels come from the segments as given, not from the bent ones. Overlaps, touching ends and vertices on
 * edges are no special cases: an end on a segment is an end in a pixel that the segment passes.
 *
 * Nor can a bent segment run through a hot pixel's grid point without bending there. A bent edge from u to v is everywhere as far, along
 * both axes, from the straight one as a mean of the distances at its ends, so by less than half a pixel or by exactly half where the segment
 * leaves u's pixel and enters v's through the same side; but it cannot enter through the side by which it leaves.
 */
#include "clip/clipper.h"

#include <math.h>

#define CROWD 100  /* segments in a cell that are put in order across the longest */
#define ROUNDING 4 /* pixels: half of one, and more than the error of a place along a direction */

/* ---- exact tests ----------------------------------------------------------------------------------------------- */

static int in_cell(const gnoi_cell *cell, gnoi_site p)
{
    return p.x >= cell->low[0] && p.x < cell->high[0] && p.y >= cell->low[1] && p.y < cell->high[1];
}

static int in_box(const gnoi_box *box, gnoi_site p)
{
    return (p.x >= box->x0) & (p.x <= box->x1) & (p.y >= box->y0) & (p.y <= box->y1); /* one branch, not four */
}

static gnoi_wide side(const gnoi_segment *s, gnoi_site p)
{
    return gnoi_wide_cross(s->b.x - s->a.x, s->b.y - s->a.y, p.x - s->a.x, p.y - s->a.y);
}

/* Whether the line through s passes the pixel of a point whose side is f. Over the pixel the side changes by half of |dx| + |dy|
 * either way; where it just reaches 0 the line touches a corner, and only the lower left one belongs to the pixel. The same holds for the
 * segment if the point is in its box: grid points leave nothing open there. */
static int line_passes(const gnoi_segment *s, gnoi_wide f)
{
    int64_t dx = s->b.x - s->a.x, dy = s->b.y - s->a.y, reach = dx + (dy < 0 ? -dy : dy), value;
    return gnoi_wide_small(f, &value) && ((2 * value < reach && -2 * value < reach) || 2 * value == dx - dy);
}

/* Whether a point whose side of s is f is so far off the line through s that a segment from it to another such point on the same side
 * stays clear of the pixels of s's ends. Corners count as near, whichever pixel they belong to. */
static int far_off(const gnoi_segment *s, gnoi_wide f)
{
    int64_t dx = s->b.x - s->a.x, dy = s->b.y - s->a.y, reach = dx + (dy < 0 ? -dy : dy), value;
    return !gnoi_wide_small(f, &value) || 2 * value > reach || -2 * value > reach;
}

/* Where a point lies along the cell's direction; in a crowded cell within a unit or two. */
static int64_t along(const gno_clipper *c, gnoi_site p)
{
    return c->across[1] == 0 ? p.x : (int64_t)(c->across[0] * (double)p.x + c->across[1] * (double)p.y);
}

/* ---- recording ------------------------------------------------------------------------------------------------- */

static int add_split(gno_clipper *c, const gnoi_box *box, uint32_t point)
{
    if (c->split_count >= GNOI_CLIP_MOST)
        return gnoi_clip_too_many(c, "crossings") == GNO_OK;
    if (!GNOI_CLIP_RESERVE(c, splits, split_capacity, c->split_count + box->count))
        return 0;
    for (uint32_t i = 0; i < box->count; i++) {
        c->splits[c->split_count].segment = c->members[box->first + i];
        c->splits[c->split_count++].point = point;
    }
    return 1;
}

static int add_point(gno_clipper *c, gnoi_site p)
{
    if (c->point_count >= GNOI_CLIP_MOST)
        return gnoi_clip_too_many(c, "crossings") == GNO_OK;
    if (!GNOI_CLIP_RESERVE(c, points, point_capacity, c->point_count + 1))
        return 0;
    c->points[c->point_count++] = p;
    return 1;
}

/* The pixel of the proper crossing of s and t; s_to_t is the side of t that s starts on. */
static gnoi_site crossing(const gnoi_segment *s, const gnoi_segment *t, gnoi_wide s_to_t)
{
    int64_t dx = s->b.x - s->a.x, dy = s->b.y - s->a.y;
    gnoi_wide den = gnoi_wide_cross(dx, dy, t->b.x - t->a.x, t->b.y - t->a.y), num = s_to_t;
    double ratio;
    gnoi_site p;
    if (gnoi_wide_sign(den) < 0)
        den = gnoi_wide_negate(den);
    if (gnoi_wide_sign(num) < 0)
        num = gnoi_wide_negate(num);
    ratio = gnoi_wide_double(num) / gnoi_wide_double(den);
    p.x = s->a.x + gnoi_wide_share(dx, num, den, ratio);
    p.y = s->a.y + gnoi_wide_share(dy, num, den, ratio);
    return p;
}

/* Whether a crossing's pixel has been hot already, as far as can be told at once; many segments may cross in one. */
static int seen_before(gno_clipper *c, gnoi_site p)
{
    gnoi_site *seen = &c->seen[((uint64_t)p.x * 31 + (uint64_t)p.y * 17) % GNOI_CLIP_SEEN];
    int same = gnoi_site_equal(*seen, p);
    *seen = p;
    return same;
}

/* A new hot pixel bends every segment of the cell that passes it. */
static int add_crossing(gno_clipper *c, const gnoi_cell *cell, gnoi_site p)
{
    uint32_t point = (uint32_t)c->point_count;
    const gnoi_box *b = c->boxes, *end = b + c->box_count;
    int64_t reach;
    if (!in_cell(cell, p) || seen_before(c, p))
        return 1;
    if (!add_point(c, p))
        return 0;
    reach = along(c, p) + c->cell_slack;
    for (; b < end && b->low <= reach; b++) {
        const gnoi_segment *s = &c->segments[b->segment];
        if (in_box(b, p) && line_passes(s, side(s, p)) && !add_split(c, b, point))
            return 0;
    }
    return !gnoi_clip_stopped(c, (size_t)(b - c->boxes));
}

/* ---- one pair -------------------------------------------------------------------------------------------------- */

/* An end of t as a hot pixel on s; f is the side of s that it lies on. */
static int end_on(gno_clipper *c, const gnoi_cell *cell, const gnoi_box *box, gnoi_site p, uint32_t point, gnoi_wide f)
{
    const gnoi_segment *s = &c->segments[box->segment];
    if (!in_box(box, p) || !in_cell(cell, p) || !line_passes(s, f) || gnoi_site_equal(p, s->a) || gnoi_site_equal(p, s->b))
        return 1;
    return add_split(c, box, point);
}

/* t's starting point on s; each point of a ring starts one segment, so none is forgotten and none met twice. Of several segments at one
 * place some may start at either end. */
static int start_on(gno_clipper *c, const gnoi_cell *cell, const gnoi_box *box, const gnoi_box *t_box, gnoi_wide at_a, gnoi_wide at_b)
{
    const gnoi_segment *t = &c->segments[t_box->segment];
    if ((t->sign > 0 || t_box->count > 1) && !end_on(c, cell, box, t->a, t->pa, at_a))
        return 0;
    return (t->sign > 0 && t_box->count == 1) || end_on(c, cell, box, t->b, t->pb, at_b);
}

/* Neighbours in a ring, the commonest pair: whether they have nothing in common but their common end, and no other hot pixel either. */
static int only_share_an_end(const gnoi_segment *s, const gnoi_segment *t)
{
    int s_ends = s->pb == t->pa || s->pb == t->pb, t_ends = t->pb == s->pa || t->pb == s->pb;
    if (!s_ends && !(s->pa == t->pa || s->pa == t->pb))
        return 0;
    return far_off(s, side(s, t_ends ? t->a : t->b)) && far_off(t, side(t, s_ends ? s->a : s->b));
}

static int meet_pair(gno_clipper *c, const gnoi_cell *cell, const gnoi_box *s_box, const gnoi_box *t_box)
{
    const gnoi_segment *s = &c->segments[s_box->segment], *t = &c->segments[t_box->segment];
    gnoi_wide ta, tb, sa, sb;
    int side_a, side_b;
    if (only_share_an_end(s, t))
        return 1;
    ta = side(s, t->a);
    tb = side(s, t->b);
    side_a = gnoi_wide_sign(ta);
    side_b = gnoi_wide_sign(tb);
    if (side_a * side_b > 0 && far_off(s, ta) && far_off(s, tb))
        return 1;
    sa = side(t, s->a);
    sb = side(t, s->b);
    if (!start_on(c, cell, s_box, t_box, ta, tb) || !start_on(c, cell, t_box, s_box, sa, sb))
        return 0;
    if (side_a * side_b >= 0 || gnoi_wide_sign(sa) * gnoi_wide_sign(sb) >= 0)
        return 1;
    return add_crossing(c, cell, crossing(s, t, sa));
}

/* ---- all pairs -------------------------------------------------------------------------------------------------------- */

static void set_box(const gno_clipper *c, gnoi_box *box, uint32_t segment, uint32_t first)
{
    const gnoi_segment *s = &c->segments[segment];
    box->x0 = box->low = s->a.x;
    box->x1 = box->high = s->b.x;
    box->y0 = s->a.y < s->b.y ? s->a.y : s->b.y;
    box->y1 = s->a.y < s->b.y ? s->b.y : s->a.y;
    box->segment = segment;
    box->first = first;
    box->count = 1;
}

static int box_before(const gno_clipper *c, const gnoi_box *p, const gnoi_box *q)
{
    const gnoi_segment *s = &c->segments[p->segment], *t = &c->segments[q->segment];
    if (p->low != q->low)
        return p->low < q->low;
    if (!gnoi_site_equal(s->a, t->a))
        return gnoi_site_less(s->a, t->a);
    return gnoi_site_equal(s->b, t->b) ? p->segment < q->segment : gnoi_site_less(s->b, t->b);
}

static void sift_box(const gno_clipper *c, gnoi_box *heap, size_t at, size_t count)
{
    gnoi_box moved = heap[at];
    for (size_t child; (child = 2 * at + 1) < count; at = child) {
        if (child + 1 < count && box_before(c, &heap[child], &heap[child + 1]))
            child++;
        if (!box_before(c, &moved, &heap[child]))
            break;
        heap[at] = heap[child];
    }
    heap[at] = moved;
}

/* A cell that no lattice could thin out: segments there run side by side, or on one another, or through one place. Boxes get their
 * extent across the longest one, in that order only near ones are compared; segments at one place share a box. */
static int order_crowd(gno_clipper *c)
{
    gnoi_box *boxes = c->boxes;
    size_t n = c->box_count, kept = 0;
    double longest = 0;
    for (size_t i = 0; i < n; i++) {
        const gnoi_segment *s = &c->segments[boxes[i].segment];
        double dx = (double)(s->b.x - s->a.x), dy = (double)(s->b.y - s->a.y), length = sqrt(dx * dx + dy * dy);
        if (length > longest) {
            longest = length;
            c->across[0] = -dy / length;
            c->across[1] = dx / length;
        }
    }
    for (size_t i = 0; i < n; i++) {
        const gnoi_segment *s = &c->segments[boxes[i].segment];
        int64_t a = along(c, s->a), b = along(c, s->b);
        boxes[i].low = (a < b ? a : b) - ROUNDING;
        boxes[i].high = (a < b ? b : a) + ROUNDING;
    }
    for (size_t i = n / 2; i-- > 0;) {
        sift_box(c, boxes, i, n);
        if (gnoi_clip_stopped_at(c, i))
            return 0;
    }
    for (size_t end = n; end-- > 1;) {
        gnoi_box largest = boxes[0];
        if (gnoi_clip_stopped_at(c, end))
            return 0;
        boxes[0] = boxes[end];
        boxes[end] = largest;
        sift_box(c, boxes, 0, end);
    }
    for (size_t i = 0; i < n; i++) {
        const gnoi_segment *s = &c->segments[boxes[i].segment], *last = kept > 0 ? &c->segments[boxes[kept - 1].segment] : NULL;
        c->members[i] = boxes[i].segment;
        if (last && gnoi_site_equal(s->a, last->a) && gnoi_site_equal(s->b, last->b)) {
            boxes[kept - 1].count++;
        } else {
            boxes[kept] = boxes[i];
            boxes[kept++].first = (uint32_t)i;
        }
    }
    c->box_count = kept;
    c->cell_slack = 0;
    return 1;
}

int gnoi_clip_meet_in_cell(gno_clipper *c, const gnoi_cell *cell, const uint32_t *list, size_t count)
{
    static const gnoi_site nowhere = {-1, -1};
    if (!GNOI_CLIP_RESERVE(c, boxes, box_capacity, count) || !GNOI_CLIP_RESERVE(c, members, member_capacity, count))
        return 0;
    for (size_t i = 0; i < GNOI_CLIP_SEEN; i++)
        c->seen[i] = nowhere;
    c->box_count = count;
    c->cell_slack = c->slack;
    c->across[0] = 1;
    c->across[1] = 0;
    for (size_t i = 0; i < count; i++) {
        set_box(c, &c->boxes[i], list[i], (uint32_t)i);
        c->members[i] = list[i];
    }
    if (count > CROWD && !order_crowd(c))
        return 0;
    for (const gnoi_box *s = c->boxes, *end = s + c->box_count; s < end; s++) {
        int64_t reach = s->high + c->cell_slack;
        const gnoi_box *t = s + 1;
        for (; t < end && t->low <= reach; t++) {
            if (((t->y0 <= s->y1) & (s->y0 <= t->y1) & (t->x0 <= s->x1) & (s->x0 <= t->x1)) && !meet_pair(c, cell, s, t))
                return 0;
        }
        if (gnoi_clip_stopped(c, (size_t)(t - s)))
            return 0;
    }
    return 1;
}
