/* filter_cut.c -- see filter_cut.h.
 *
 * A part of the pixel's square is a convex polygon in picture coordinates relative to the pixel's centre. A line S = c of
 * the pattern cuts it where s - c w = 0, which is linear there; so no point is ever projected.
 * Cells of the tree, coarsest first: blocks of 2^k x 2^k whole patterns (levels above the picture's last, all with the picture's
 * mean), then the levels of the picture, down to its elements. Every cell is an interval in S and one in T, and halving both
 * halves neither element nor pattern.
 */
#include "project/filter_cut.h"
#include <math.h>

#define CORNERS 12       /* of a part: the square's four and one for each cut by two cells' sides, a horizon and rounding */
#define TOLERANCE 0.002  /* aim for the error of a pixel's mean */
#define MOST_DEVIATION 0.0025 /* of it where the pixel is so thin that all of its n parts are cut ones: deviation / sqrt(n) */
#define MOST_LEAN 0.004 /* stretch times deviation of a whole cell: elements weigh by 1/w^3, so it is off by 3 / sqrt(12) of that, and stripes all one way */
#define START_CELLS 3    /* at most so many cells side by side when a pixel is begun */
#define STRETCH 3.0      /* within a part w changes by at most this factor before it is halved */
#define MAX_HALVINGS 6
#define FAR_PATTERNS 1e9 /* patterns away from the first that can still be told apart */

typedef struct point {
    double x, y;
} point;

typedef struct part {
    int count;
    point p[CORNERS];
} part;

typedef struct filter {
    const gnoi_image *image;
    gno_wrap wrap;
    gnoi_screen_plane s, t, w; /* s and t in elements, over the pixel */
    int top;                   /* the picture's last level */
    double sum[4], area;
    double least, most;        /* of w in the part of the pixel at hand; where that was cut off from another, it is one of them */
} filter;

/* A cell along one axis: interval `index` of 2^level elements of copy `copy` of the pattern; above the last level an interval of
 * 2^(level - top) copies, `copy` being its number. */
typedef struct cell {
    double copy;
    int index;
} cell;

static double at(const gnoi_screen_plane *f, point p) { return f->fx * p.x + f->fy * p.y + f->f0; }

static double area_of(const part *a)
{
    double sum = 0;
    for (int i = 1; i + 1 < a->count; i++)
        sum += (a->p[i].x - a->p[0].x) * (a->p[i + 1].y - a->p[0].y) - (a->p[i].y - a->p[0].y) * (a->p[i + 1].x - a->p[0].x);
    return 0.5 * fabs(sum);
}

/* Cuts a part by the line f = 0 in two. Either result may be empty. */
static void cut(const part *a, const gnoi_screen_plane *f, part *below, part *above)
{
    double side[CORNERS];
    int low = 0, high = 0;
    for (int i = 0; i < a->count; i++) {
        side[i] = at(f, a->p[i]);
        low += side[i] <= 0;
        high += side[i] >= 0;
    }
    below->count = above->count = 0;
    if (low == a->count) {
        *below = *a;
        return;
    }
    if (high == a->count || a->count + 2 > CORNERS) {
        *above = *a;
        return;
    }
    for (int i = 0; i < a->count; i++) {
        int j = i + 1 < a->count ? i + 1 : 0;
        if (side[i] <= 0)
            below->p[below->count++] = a->p[i];
        if (side[i] >= 0)
            above->p[above->count++] = a->p[i];
        if ((side[i] < 0 && side[j] > 0) || (side[i] > 0 && side[j] < 0)) {
            double k = side[i] / (side[i] - side[j]);
            point c = {a->p[i].x + k * (a->p[j].x - a->p[i].x), a->p[i].y + k * (a->p[j].y - a->p[i].y)};
            below->p[below->count++] = c;
            above->p[above->count++] = c;
        }
    }
}

/* Cuts by the pattern line S (or T) = c. */
static void cut_at(const filter *f, const gnoi_screen_plane *axis, double c, const part *a, part *below, part *above)
{
    gnoi_screen_plane line = {axis->fx - c * f->w.fx, axis->fy - c * f->w.fy, axis->f0 - c * f->w.f0};
    cut(a, &line, below, above);
}

static void add(filter *f, const float value[4], double area)
{
    for (int k = 0; k < 4; k++)
        f->sum[k] += area * (double)value[k];
    f->area += area;
}

static void add_mean(filter *f, double area)
{
    float value[4];
    gnoi_image_value(f->image, f->top, 0, 0, value);
    add(f, value, area);
}

/* ---- cells -------------------------------------------------------------------------------------------------------------- */

static int is_mirrored(const filter *f, double copy)
{
    return f->wrap == GNO_WRAP_MIRROR && fmod(copy, 2) != 0;
}

/* Where a cell of `level` is halved, in elements; its lower half is child[0]. Returns 0 where it has only child[0]. */
static int halve(const filter *f, int level, int elements, cell c, double *where, cell child[2])
{
    double begin;
    int middle;
    if (level > f->top) {
        child[0].copy = 2 * c.copy;
        child[1].copy = 2 * c.copy + 1;
        child[0].index = child[1].index = 0;
        *where = child[1].copy * ldexp((double)elements, level - f->top - 1);
        return 1;
    }
    child[0].copy = child[1].copy = c.copy;
    child[0].index = 2 * c.index;
    child[1].index = 2 * c.index + 1;
    middle = child[1].index << (level - 1);
    if (middle >= elements)
        return 0;
    begin = c.copy * elements;
    *where = begin + middle;
    if (is_mirrored(f, c.copy)) {
        *where = begin + elements - middle;
        child[0].index = 2 * c.index + 1;
        child[1].index = 2 * c.index;
    }
    return 1;
}

/* The upper end of a cell, in elements. */
static double end_of(const filter *f, int level, int elements, cell c)
{
    int end;
    if (level > f->top)
        return (c.copy + 1) * ldexp((double)elements, level - f->top);
    if (is_mirrored(f, c.copy))
        return c.copy * elements + elements - (c.index << level);
    end = (c.index + 1) << level;
    return c.copy * elements + (end < elements ? end : elements);
}

/* The cell of `level` that holds element coordinate v. */
static cell cell_at(const filter *f, int level, int elements, double v)
{
    cell c = {0, 0};
    int element;
    if (level > f->top) {
        c.copy = floor(v / ldexp((double)elements, level - f->top));
        return c;
    }
    c.copy = floor(v / elements);
    element = (int)(v - c.copy * elements);
    element = element < 0 ? 0 : element >= elements ? elements - 1 : element;
    if (is_mirrored(f, c.copy))
        element = elements - 1 - element;
    c.index = element >> level;
    return c;
}

/* ---- the tree ------------------------------------------------------------------------------------------------------------ */

/* 1 when the part lies inside the pixel's square, or inside what is left of that when it has been halved, so that it is its whole cell. */
static int is_whole(const filter *f, const part *a)
{
    for (int i = 0; i < a->count; i++) {
        double w = at(&f->w, a->p[i]);
        if (fabs(a->p[i].x) > 0.5 - 1e-12 || fabs(a->p[i].y) > 0.5 - 1e-12 || w <= f->least || w >= f->most)
            return 0;
    }
    return 1;
}

/* By how much w changes over the part, relative to its largest. */
static double stretch_of(const filter *f, const part *a)
{
    double least = HUGE_VAL, most = -HUGE_VAL;
    for (int i = 0; i < a->count; i++) {
        double w = at(&f->w, a->p[i]);
        least = w < least ? w : least;
        most = w > most ? w : most;
    }
    return (most - least) / most;
}

static int is_enough(const filter *f, const part *a, double area, float variance)
{
    int few = area * (double)variance <= MOST_DEVIATION * MOST_DEVIATION;
    double stretch;
    if (few && gnoi_filter_is_small(area, TOLERANCE, variance))
        return 1;
    if (!is_whole(f, a))
        return 0;
    stretch = stretch_of(f, a);
    return stretch * stretch * (double)variance <= MOST_LEAN * MOST_LEAN && gnoi_filter_is_small(area * 3 * stretch, TOLERANCE, variance);
}

static void value_at(const filter *f, int level, cell s, cell t, float value[4])
{
    if (level > f->top)
        gnoi_image_value(f->image, f->top, 0, 0, value);
    else
        gnoi_image_value(f->image, level, s.index, t.index, value);
}

static float variance_at(const filter *f, int level, cell s, cell t)
{
    const gnoi_image_level *l = &f->image->level[level < f->top ? level : f->top];
    if (!l->variance)
        return 0;
    return level > f->top ? l->variance[0] : l->variance[(size_t)t.index * (size_t)l->width + (size_t)s.index];
}

static void descend(filter *f, int level, cell s, cell t, const part *a)
{
    double area = area_of(a), where;
    part half[2], quarter[2];
    cell across[2], up[2];
    if (a->count < 3)
        return;
    if (level == 0 || is_enough(f, a, area, variance_at(f, level, s, t))) {
        float value[4];
        value_at(f, level, s, t, value);
        add(f, value, area);
        return;
    }
    half[1].count = 0;
    if (halve(f, level, f->image->width, s, &where, across))
        cut_at(f, &f->s, where, a, &half[0], &half[1]);
    else
        half[0] = *a;
    for (int i = 0; i < 2; i++) {
        if (half[i].count < 3)
            continue;
        quarter[1].count = 0;
        if (halve(f, level, f->image->height, t, &where, up))
            cut_at(f, &f->t, where, &half[i], &quarter[0], &quarter[1]);
        else
            quarter[0] = half[i];
        for (int j = 0; j < 2; j++)
            if (quarter[j].count >= 3)
                descend(f, level - 1, across[i], up[j], &quarter[j]);
    }
}

/* ---- a part of the pixel ------------------------------------------------------------------------------------------------- */

typedef struct range {
    double low, high;
} range;

static range range_of(const filter *f, const gnoi_screen_plane *axis, const part *a)
{
    range r = {HUGE_VAL, -HUGE_VAL};
    for (int i = 0; i < a->count; i++) {
        double v = at(axis, a->p[i]) / at(&f->w, a->p[i]);
        r.low = v < r.low ? v : r.low;
        r.high = v > r.high ? v : r.high;
    }
    return r;
}

/* The level at which both ranges meet at most START_CELLS cells. */
static int start_level(const filter *f, range s, range t)
{
    double widest = s.high - s.low > t.high - t.low ? s.high - s.low : t.high - t.low;
    int level = 0;
    double cell_side = 1;
    for (; level < f->top && widest > cell_side * (START_CELLS - 1); level++)
        cell_side *= 2;
    if (level < f->top)
        return level;
    cell_side = f->image->width < f->image->height ? f->image->width : f->image->height;
    for (; widest > cell_side * (START_CELLS - 1) && level < f->top + 60; level++)
        cell_side *= 2;
    return level;
}

static void integrate_row(filter *f, int level, cell s, range t, part row)
{
    int elements = f->image->height;
    cell c = cell_at(f, level, elements, t.low);
    while (row.count >= 3) {
        part inside, rest;
        double end = end_of(f, level, elements, c);
        if (end >= t.high) {
            descend(f, level, s, c, &row);
            return;
        }
        cut_at(f, &f->t, end, &row, &inside, &rest);
        descend(f, level, s, c, &inside);
        row = rest;
        c = cell_at(f, level, elements, end + 0.5);
    }
}

/* The part, all within the pattern as it repeats. */
static void integrate_pattern(filter *f, const part *a)
{
    range s = range_of(f, &f->s, a), t = range_of(f, &f->t, a);
    int level, elements = f->image->width;
    part rest = *a;
    cell c;
    if (!(fabs(s.low) + fabs(s.high) < FAR_PATTERNS * f->image->width) ||
        !(fabs(t.low) + fabs(t.high) < FAR_PATTERNS * f->image->height)) {
        add_mean(f, area_of(a));
        return;
    }
    level = start_level(f, s, t);
    c = cell_at(f, level, elements, s.low);
    while (rest.count >= 3) {
        part column, more;
        double end = end_of(f, level, elements, c);
        if (end >= s.high) {
            integrate_row(f, level, c, t, rest);
            return;
        }
        cut_at(f, &f->s, end, &rest, &column, &more);
        integrate_row(f, level, c, t, column);
        rest = more;
        c = cell_at(f, level, elements, end + 0.5);
    }
}

/* Beside a pattern that is clamped: the elements of one column, or row, go on and on. */
static void integrate_border(filter *f, const part *a, int along_t, int border)
{
    int elements = along_t ? f->image->height : f->image->width;
    const gnoi_screen_plane *axis = along_t ? &f->t : &f->s;
    range r = range_of(f, axis, a);
    part rest = *a;
    int from = r.low > 0 ? (int)(r.low < elements ? r.low : elements - 1) : 0, step = 1;
    double wide = (r.high < elements ? r.high : elements) - from;
    while (wide > 256.0 * step)
        step *= 2;
    for (int i = from; rest.count >= 3; i += step) {
        part inside, more = {0, {{0, 0}}};
        float value[4];
        int middle = i + step / 2 < elements ? i + step / 2 : elements - 1;
        if (i + step < elements)
            cut_at(f, axis, i + step, &rest, &inside, &more);
        else
            inside = rest;
        gnoi_image_value(f->image, 0, along_t ? border : middle, along_t ? middle : border, value);
        if (inside.count >= 3)
            add(f, value, area_of(&inside));
        rest = more;
    }
}

/* A pattern that does not repeat: what lies on it, and what lies beside it. */
static void integrate_once(filter *f, const part *a)
{
    static const float plain[4] = {1, 1, 1, 1};
    part side[4], rest, inside;
    int w = f->image->width, h = f->image->height;
    cut_at(f, &f->s, 0, a, &side[0], &rest);
    cut_at(f, &f->s, w, &rest, &inside, &side[1]);
    cut_at(f, &f->t, 0, &inside, &side[2], &rest);
    cut_at(f, &f->t, h, &rest, &inside, &side[3]);
    if (inside.count >= 3)
        integrate_pattern(f, &inside);
    for (int i = 0; i < 4; i++) {
        if (side[i].count < 3)
            continue;
        if (f->wrap == GNO_WRAP_NONE)
            add(f, plain, area_of(&side[i]));
        else
            integrate_border(f, &side[i], i < 2, i == 0 || i == 2 ? 0 : (i == 1 ? w : h) - 1);
    }
}

/* Halves the part across the direction in which w changes until it changes little. What still reaches the horizon after that
 * sees so much of a pattern that repeats that it sees its mean, and of others nothing. */
static void integrate(filter *f, const part *a, int halvings)
{
    double least = HUGE_VAL, most = -HUGE_VAL, low, high;
    gnoi_screen_plane across = {f->w.fx, f->w.fy, 0};
    part half[2];
    if (a->count < 3)
        return;
    for (int i = 0; i < a->count; i++) {
        double w = at(&f->w, a->p[i]);
        least = w < least ? w : least;
        most = w > most ? w : most;
    }
    if (least > 0 && most <= STRETCH * least) {
        f->least = least * (1 + 1e-9);
        f->most = most * (1 - 1e-9);
        if (f->wrap == GNO_WRAP_CLAMP || f->wrap == GNO_WRAP_NONE)
            integrate_once(f, a);
        else
            integrate_pattern(f, a);
        return;
    }
    if (!(most > 0))
        return;
    if (halvings == MAX_HALVINGS) {
        if (f->wrap == GNO_WRAP_REPEAT || f->wrap == GNO_WRAP_MIRROR)
            add_mean(f, area_of(a) * (least > 0 ? 1 : most / (most - least)));
        return;
    }
    low = (least > 0 ? least : 0) - f->w.f0;
    high = most - f->w.f0;
    across.f0 = -0.5 * (low + high);
    cut(a, &across, &half[0], &half[1]);
    integrate(f, &half[1], halvings + 1);
    integrate(f, &half[0], halvings + 1);
}

int gnoi_filter_cut(const gnoi_image *image, gno_wrap wrap, const gnoi_screen_plane *s, const gnoi_screen_plane *t,
                    const gnoi_screen_plane *w, float mean[4])
{
    static const part square = {4, {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}};
    filter f = {image, wrap, *s, *t, *w, image->level_count - 1, {0, 0, 0, 0}, 0, 0, 0};
    integrate(&f, &square, 0);
    for (int k = 0; k < 4; k++)
        mean[k] = f.area > 0 ? (float)(f.sum[k] / f.area) : 1;
    return f.area > 0;
}
