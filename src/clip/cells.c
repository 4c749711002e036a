/* cells.c -- the plane in cells of few segments each, for meet.c.
 *
 * Place: second pass (clipper.h). Segments are put in order from left to right, then into the cells of a lattice chosen by their number
 * and lengths; cells that stay crowded get a lattice of their own. A cell holds whole pixels, and all the segments that pass
 * one of them: so it can be done alone. A segment listed too often costs time, one listed too seldom would be wrong; where
 * doubles round, they round towards too often.
 */
#include "clip/clipper.h"

#include <math.h>

#define CROWD 32         /* segments in a cell that gets no lattice */
#define PER_CELL 5       /* segments for which a lattice has a cell */
#define MOST_CELLS 1024  /* of a lattice along an axis */
#define REPEATS 1.5      /* how often a segment may be listed beyond its first cell, in the mean */
#define MOST_PAIRS 1.25  /* pairs in the cells of a lattice, for each pair there was */
#define DEEPEST 40       /* lattices in one another */
#define MARGIN 2.0       /* pixels: half of one, and more than the error of a height in doubles */

typedef struct lattice {
    int64_t low[2], high[2]; /* of the boxes of all segments, within the cell */
    int shift;               /* cells are squares of 2^shift pixels */
    int size[2];             /* columns and rows */
} lattice;

/* A list's links: entry i is a segment and the next entry. */
typedef struct entries {
    size_t head, first; /* cell heads, then entries, in cell_list */
} entries;

static int64_t smaller(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

static int64_t larger(int64_t a, int64_t b)
{
    return a > b ? a : b;
}

/* ---- order from left to right ------------------------------------------------------------------------------------ */

static int order_segments(gno_clipper *c)
{
    size_t n = c->segment_count, swap;
    gnoi_segment *from = c->segments;
    int shift = c->bits > 31 ? c->bits - 31 : 0;
    if (!GNOI_CLIP_RESERVE(c, keys, key_capacity, n) || !GNOI_CLIP_RESERVE(c, key_scratch, key_scratch_capacity, n) ||
        !GNOI_CLIP_RESERVE(c, ordered, ordered_capacity, n))
        return 0;
    c->slack = ((int64_t)1 << shift) - 1;
    for (size_t i = 0; i < n; i++) {
        if (gnoi_clip_stopped_at(c, i))
            return 0;
        c->keys[i].key = (uint32_t)(from[i].a.x >> shift);
        c->keys[i].value = (uint32_t)i;
    }
    if (!gnoi_sort_asking(c->context, c->keys, c->key_scratch, n))
        return 0;
    for (size_t i = 0; i < n; i++) {
        if (gnoi_clip_stopped_at(c, i))
            return 0;
        c->ordered[i] = from[c->keys[i].value];
    }
    c->segments = c->ordered;
    c->ordered = from;
    swap = c->segment_capacity;
    c->segment_capacity = c->ordered_capacity;
    c->ordered_capacity = swap;
    return 1;
}

/* ---- the lattice ---------------------------------------------------------------------------------------------------- */

static void segment_box(const gnoi_segment *s, const gnoi_cell *cell, int64_t low[2], int64_t high[2])
{
    low[0] = larger(s->a.x, cell->low[0]);
    high[0] = smaller(s->b.x, cell->high[0] - 1);
    low[1] = larger(smaller(s->a.y, s->b.y), cell->low[1]);
    high[1] = smaller(larger(s->a.y, s->b.y), cell->high[1] - 1);
}

/* As many cells as segments are, fewer when these are long. 0: one cell would do. */
static int choose_lattice(const gno_clipper *c, const gnoi_cell *cell, const uint32_t *list, size_t count, lattice *l)
{
    double sum = 0, extent[2], side;
    l->low[0] = l->low[1] = INT64_MAX;
    l->high[0] = l->high[1] = INT64_MIN;
    for (size_t i = 0; i < count; i++) {
        int64_t low[2], high[2];
        segment_box(&c->segments[list[i]], cell, low, high);
        for (int k = 0; k < 2; k++) {
            sum += (double)(high[k] - low[k]);
            l->low[k] = smaller(l->low[k], low[k]);
            l->high[k] = larger(l->high[k], high[k]);
        }
    }
    for (int k = 0; k < 2; k++)
        extent[k] = (double)(l->high[k] - l->low[k] + 1);
    side = fmax(sqrt(extent[0] * extent[1] * PER_CELL / (double)count), sum / (REPEATS * (double)count));
    side = fmax(side, fmax(extent[0], extent[1]) / MOST_CELLS);
    l->shift = side > 1 ? ilogb(side) : 0;
    while (l->shift > 0 && extent[0] <= ldexp(1, l->shift) && extent[1] <= ldexp(1, l->shift))
        l->shift--;
    for (int k = 0; k < 2; k++)
        l->size[k] = (int)((l->high[k] - l->low[k]) >> l->shift) + 1;
    return l->size[0] > 1 || l->size[1] > 1;
}

/* The column (axis 0) or row that a coordinate lies in, the outer ones reaching on. */
static int place_in(const lattice *l, int axis, int64_t v)
{
    int64_t place = (v - l->low[axis]) >> l->shift;
    return v <= l->low[axis] ? 0 : place < l->size[axis] ? (int)place : l->size[axis] - 1;
}

/* First coordinate of a column or row. */
static int64_t border(const lattice *l, int axis, int place)
{
    return l->low[axis] + ((int64_t)place << l->shift);
}

/* ---- listing ---------------------------------------------------------------------------------------------------------- */

static int add_entry(gno_clipper *c, const entries *e, size_t *count, int cell, uint32_t segment)
{
    size_t at = e->first + 2 * *count;
    if (at + 2 >= GNOI_CLIP_NONE)
        return gnoi_clip_too_many(c, "segments in cells") == GNO_OK;
    if (!GNOI_CLIP_RESERVE(c, cell_list, cell_capacity, at + 2))
        return 0;
    c->cell_list[at] = segment;
    c->cell_list[at + 1] = c->cell_list[e->head + (size_t)cell];
    c->cell_list[e->head + (size_t)cell] = (uint32_t)at;
    ++*count;
    return !gnoi_clip_stopped_at(c, *count);
}

/* Rows of s between two columns' borders: from the heights there, with a margin. */
static void rows_in_column(const lattice *l, const gnoi_segment *s, double slope, int column, int rows[2])
{
    double x0 = (double)(border(l, 0, column) - s->a.x) - 1, x1 = (double)(border(l, 0, column + 1) - s->a.x);
    double end = (double)(s->b.x - s->a.x), y0 = (double)s->a.y + slope * fmin(fmax(x0, 0), end);
    double y1 = (double)s->a.y + slope * fmin(fmax(x1, 0), end);
    int low = place_in(l, 1, (int64_t)(fmin(y0, y1) - MARGIN)), high = place_in(l, 1, (int64_t)(fmax(y0, y1) + MARGIN));
    rows[0] = low > rows[0] ? low : rows[0];
    rows[1] = high < rows[1] ? high : rows[1];
}

static int list_segment(gno_clipper *c, const gnoi_cell *cell, const lattice *l, const entries *e, size_t *count, uint32_t id)
{
    const gnoi_segment *s = &c->segments[id];
    int64_t low[2], high[2];
    int from[2], to[2];
    double slope = 0;
    segment_box(s, cell, low, high);
    for (int k = 0; k < 2; k++) {
        from[k] = place_in(l, k, low[k]);
        to[k] = place_in(l, k, high[k]);
    }
    if (from[0] < to[0] && from[1] < to[1])
        slope = (double)(s->b.y - s->a.y) / (double)(s->b.x - s->a.x);
    for (int column = from[0]; column <= to[0]; column++) {
        int rows[2] = {from[1], to[1]};
        if (slope != 0)
            rows_in_column(l, s, slope, column, rows);
        for (int row = rows[0]; row <= rows[1]; row++)
            if (!add_entry(c, e, count, column * l->size[1] + row, id))
                return 0;
    }
    return 1;
}

/* ---- cell by cell ------------------------------------------------------------------------------------------------------ */

static int meet_in(gno_clipper *c, const gnoi_cell *cell, size_t first, size_t count);

/* Unlinks a cell's list behind `top`, and does the cell. */
static int meet_in_child(gno_clipper *c, const lattice *l, const gnoi_cell *cell, uint32_t head, const int place[2], size_t top)
{
    gnoi_cell child;
    size_t count = 0;
    for (int k = 0; k < 2; k++) {
        child.low[k] = place[k] == 0 ? cell->low[k] : border(l, k, place[k]);
        child.high[k] = place[k] + 1 == l->size[k] ? cell->high[k] : border(l, k, place[k] + 1);
    }
    child.depth = cell->depth + 1;
    for (uint32_t i = head; i != GNOI_CLIP_NONE; i = c->cell_list[i + 1], count++) {
        if (!GNOI_CLIP_RESERVE(c, cell_list, cell_capacity, top + count + 1))
            return 0;
        c->cell_list[top + count] = c->cell_list[i];
    }
    return meet_in(c, &child, top, count);
}

/* Whether the cells have not many more pairs of segments than the whole. Where segments run together no lattice parts them, it only
 * repeats their pairs. */
static int pays(const gno_clipper *c, const entries *e, size_t cells, size_t count)
{
    double pairs = 0;
    for (size_t i = 0; i < cells; i++) {
        double n = 0;
        for (uint32_t at = c->cell_list[e->head + i]; at != GNOI_CLIP_NONE; at = c->cell_list[at + 1])
            n++;
        pairs += n * n;
    }
    return pairs <= MOST_PAIRS * (double)count * (double)count;
}

static int meet_in_lattice(gno_clipper *c, const gnoi_cell *cell, const lattice *l, size_t first, size_t count)
{
    size_t cells = (size_t)l->size[0] * (size_t)l->size[1], listed = 0, top;
    entries e;
    e.head = first + count;
    e.first = e.head + cells;
    if (!GNOI_CLIP_RESERVE(c, cell_list, cell_capacity, e.first))
        return 0;
    for (size_t i = 0; i < cells; i++)
        c->cell_list[e.head + i] = GNOI_CLIP_NONE;
    for (size_t i = count; i-- > 0;) /* links turn the order round */
        if (!list_segment(c, cell, l, &e, &listed, c->cell_list[first + i]))
            return 0;
    if (!pays(c, &e, cells, count))
        return gnoi_clip_meet_in_cell(c, cell, c->cell_list + first, count);
    top = e.first + 2 * listed;
    for (size_t i = 0; i < cells; i++) {
        if (gnoi_clip_stopped_at(c, i))
            return 0;
        const int place[2] = {(int)(i / (size_t)l->size[1]), (int)(i % (size_t)l->size[1])};
        uint32_t head = c->cell_list[e.head + i];
        if (head != GNOI_CLIP_NONE && !meet_in_child(c, l, cell, head, place, top))
            return 0;
    }
    return 1;
}

static int meet_in(gno_clipper *c, const gnoi_cell *cell, size_t first, size_t count)
{
    lattice l;
    if (count > CROWD && cell->depth < DEEPEST && choose_lattice(c, cell, c->cell_list + first, count, &l))
        return meet_in_lattice(c, cell, &l, first, count);
    return gnoi_clip_meet_in_cell(c, cell, c->cell_list + first, count);
}

gno_status gnoi_clip_meet(gno_clipper *c)
{
    int64_t end = ((int64_t)1 << c->bits) + 2; /* rounding may reach one beyond the last pixel */
    gnoi_cell whole = {{0, 0}, {0, 0}, 0};
    whole.high[0] = whole.high[1] = end;
    c->split_count = 0;
    if (!order_segments(c) || !GNOI_CLIP_RESERVE(c, cell_list, cell_capacity, c->segment_count))
        return GNO_ERROR_MEMORY;
    for (size_t i = 0; i < c->segment_count; i++)
        c->cell_list[i] = (uint32_t)i;
    if (meet_in(c, &whole, 0, c->segment_count))
        return GNO_OK;
    return c->complaint[0] ? GNO_ERROR_LIMIT : GNO_ERROR_MEMORY;
}
