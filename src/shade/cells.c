/* cells.c -- see cells.h.
 *
 * Each family of parallel planes cuts a polygon of the pixel into strips, each strip is cut by the next family, and so on.
 * Invariants: polygons are convex; strips of one polygon have its area together; work is bounded: what is left when it is used up,
 * or too small to be seen, counts with the pattern's mean.
 */
#include "shade/cells.h"
#include "shade/noise.h"

#include <math.h>
#include <stddef.h>

/* A square, cut by the horizon, cut by two planes of each of three families: at most 4 + 1 + 6 corners. */
#define MOST_CORNERS 12
#define MOST_STRIPS 4096   /* of one pixel */
#define SMALL 5e-4         /* share of a pixel below which a polygon of many strips is taken for its mean */
#define MANY 8
#define LEAST_DIVISOR 1e-9 /* of the footprint, relative to 1 at the pixel's centre */
#define BIAS 1e-6          /* cells: a face that lies in a lattice plane is in the cells above it, not in a mixture by rounding */

typedef struct poly {
    int count;
    double x[MOST_CORNERS], y[MOST_CORNERS];
} poly;

/* A linear function over the pixel. */
typedef struct line {
    double a, b, c;
} line;

typedef struct cutting {
    line coordinate[3], divisor; /* coordinate k of the point is coordinate[k] / divisor */
    int strips;                  /* left to be made */
} cutting;

static double line_at(const line *l, double x, double y)
{
    return l->a * x + l->b * y + l->c;
}

static double area_of(const poly *p)
{
    double sum = 0;
    for (int i = 2; i < p->count; i++)
        sum += (p->x[i - 1] - p->x[0]) * (p->y[i] - p->y[0]) - (p->x[i] - p->x[0]) * (p->y[i - 1] - p->y[0]);
    return 0.5 * fabs(sum);
}

static void add_corner(poly *p, double x, double y)
{
    if (p->count < MOST_CORNERS) {
        p->x[p->count] = x;
        p->y[p->count++] = y;
    }
}

/* The part of p where l >= 0 to `above`, the rest to `below` (either may be NULL, neither may be p). */
static void cut(const poly *p, const line *l, poly *below, poly *above)
{
    poly unused;
    double d, next;
    below = below ? below : &unused;
    above = above ? above : &unused;
    below->count = above->count = 0;
    d = p->count ? line_at(l, p->x[0], p->y[0]) : 0;
    for (int i = 0; i < p->count; i++, d = next) {
        int j = i + 1 < p->count ? i + 1 : 0;
        next = line_at(l, p->x[j], p->y[j]);
        add_corner(d >= 0 ? above : below, p->x[i], p->y[i]);
        if ((d >= 0) != (next >= 0)) {
            double t = d / (d - next), x = p->x[i] + t * (p->x[j] - p->x[i]), y = p->y[i] + t * (p->y[j] - p->y[i]);
            add_corner(above, x, y);
            add_corner(below, x, y);
        }
    }
}

/* The pixel square, without what lies beyond the surface's horizon. */
static cutting start(const gno_footprint *f, poly *pixel)
{
    static const poly square = {4, {-0.5, 0.5, 0.5, -0.5}, {-0.5, -0.5, 0.5, 0.5}};
    cutting c;
    line horizon;
    for (int k = 0; k < 3; k++) {
        c.coordinate[k].a = f->dx[k];
        c.coordinate[k].b = f->dy[k];
        c.coordinate[k].c = f->point[k];
    }
    c.divisor.a = f->wx;
    c.divisor.b = f->wy;
    c.divisor.c = 1;
    c.strips = MOST_STRIPS;
    horizon = c.divisor;
    horizon.c -= LEAST_DIVISOR;
    cut(&square, &horizon, NULL, pixel);
    return c;
}

/* Least and greatest value of a coordinate over p; *nearest: its value where the divisor is greatest. */
static void range_of(const cutting *c, int axis, const poly *p, double *low, double *high, double *nearest)
{
    double most = 0;
    *low = HUGE_VAL;
    *high = -HUGE_VAL;
    *nearest = 0;
    for (int i = 0; i < p->count; i++) {
        double w = line_at(&c->divisor, p->x[i], p->y[i]), t = line_at(&c->coordinate[axis], p->x[i], p->y[i]) / w;
        *low = t < *low ? t : *low;
        *high = t > *high ? t : *high;
        if (w > most) {
            most = w;
            *nearest = t;
        }
    }
}

/* Where the coordinate is `at`: positive above it. */
static line border(const cutting *c, int axis, double at)
{
    line l;
    l.a = c->coordinate[axis].a - at * c->divisor.a;
    l.b = c->coordinate[axis].b - at * c->divisor.b;
    l.c = c->coordinate[axis].c - at * c->divisor.c;
    return l;
}

/* Strips of a polygon between the planes of one family, taken off one by one from the near end, where they are large. */
typedef struct strips {
    int axis, upwards;
    double period, offset, next; /* planes at offset + period times whole numbers */
    double left;                 /* strips still to come */
    poly rest;
} strips;

static strips strips_of(const cutting *c, int axis, double period, double offset, const poly *p)
{
    strips s;
    double low, high, near;
    range_of(c, axis, p, &low, &high, &near);
    s.axis = axis;
    s.period = period;
    s.offset = offset - BIAS * period;
    s.upwards = !(near - low > high - near);
    low = floor((low - s.offset) / period);
    high = floor((high - s.offset) / period);
    s.next = s.upwards ? low : high;
    s.left = high - low + 1;
    s.rest = *p;
    return s;
}

/* The next strip and its number; 0 when there is none, or when the rest is not worth or not allowed to be cut. */
static int next_strip(cutting *c, strips *s, poly *strip, double *number)
{
    line l;
    poly rest;
    if (!(s->left >= 1) || s->rest.count < 3 || c->strips-- <= 0 || (s->left > MANY && area_of(&s->rest) < SMALL))
        return 0;
    *number = s->next;
    if (s->left < 2) {
        *strip = s->rest;
        s->rest.count = 0;
        s->left = 0;
        return 1;
    }
    l = border(c, s->axis, s->offset + s->period * (s->upwards ? s->next + 1 : s->next));
    rest = s->rest;
    if (s->upwards)
        cut(&rest, &l, strip, &s->rest);
    else
        cut(&rest, &l, &s->rest, strip);
    s->next += s->upwards ? 1 : -1;
    s->left--;
    return 1;
}

static int is_odd(double whole)
{
    return fmod(whole, 2) != 0;
}

/* ---- checker -------------------------------------------------------------------------------------------------------- */

/* Area of p in odd cells; `axes` are the families still to cut by, `odd` the parity so far. */
static double odd_area(cutting *c, const int *axes, int count, const poly *p, int odd)
{
    double sum = 0, number;
    strips s;
    poly strip;
    if (count == 0)
        return odd ? area_of(p) : 0;
    s = strips_of(c, axes[0], 1, 0, p);
    while (next_strip(c, &s, &strip, &number)) {
        if (strip.count >= 3)
            sum += odd_area(c, axes + 1, count - 1, &strip, odd ^ is_odd(number));
    }
    return sum + 0.5 * area_of(&s.rest);
}

double gnoi_checker_share(const gno_footprint *footprint)
{
    poly pixel;
    cutting c = start(footprint, &pixel);
    int axes[3] = {0, 1, 2};
    double count[3], whole = area_of(&pixel);
    if (!(whole > 0))
        return 0.5;
    for (int k = 0; k < 3; k++)
        count[k] = strips_of(&c, k, 1, 0, &pixel).left;
    for (int i = 1; i < 3; i++) { /* the fewest strips first: the least work */
        for (int j = i; j > 0 && count[axes[j]] < count[axes[j - 1]]; j--) {
            int swap = axes[j];
            axes[j] = axes[j - 1];
            axes[j - 1] = swap;
        }
    }
    return odd_area(&c, axes, 3, &pixel, 0) / whole;
}

/* ---- bricks ---------------------------------------------------------------------------------------------------------- */

typedef struct brick_sum {
    double area, tint;
} brick_sum;

/* The parts of a strip, one period wide, that are not joint: half a joint off at either end. */
static void without_joints(const cutting *c, int axis, double from, double period, double mortar, const poly *strip, poly *inner)
{
    poly upper;
    line low = border(c, axis, from + mortar / 2), high = border(c, axis, from + period - mortar / 2);
    cut(strip, &low, NULL, &upper);
    cut(&upper, &high, inner, NULL);
}

static brick_sum course_sum(cutting *c, const gnoi_bricks *b, double course, const poly *p)
{
    brick_sum sum = {0, 0};
    double offset = is_odd(course) ? b->length / 2 : 0, number, mean = (b->length - b->mortar) / b->length, rest;
    strips s = strips_of(c, b->along, b->length, offset, p);
    poly strip, inner;
    while (next_strip(c, &s, &strip, &number)) {
        double area;
        without_joints(c, b->along, s.offset + number * b->length, b->length, b->mortar, &strip, &inner);
        area = area_of(&inner);
        sum.area += area;
        sum.tint += area * gnoi_hash_unit((int64_t)fmod(number, 1e15), (int64_t)fmod(course, 1e15), 0, b->seed);
    }
    rest = mean * area_of(&s.rest);
    sum.area += rest;
    sum.tint += 0.5 * rest;
    return sum;
}

double gnoi_brick_share(const gnoi_bricks *b, const gno_footprint *footprint, double *tint)
{
    poly pixel, strip, inner;
    cutting c = start(footprint, &pixel);
    double whole = area_of(&pixel), number, mean = (b->length - b->mortar) / b->length * (b->height - b->mortar) / b->height, rest;
    brick_sum sum = {0, 0};
    strips s;
    if (!(whole > 0)) {
        *tint = 0.5 * mean;
        return mean;
    }
    s = strips_of(&c, b->up, b->height, 0, &pixel);
    while (next_strip(&c, &s, &strip, &number)) {
        brick_sum course;
        without_joints(&c, b->up, s.offset + number * b->height, b->height, b->mortar, &strip, &inner);
        course = course_sum(&c, b, number, &inner);
        sum.area += course.area;
        sum.tint += course.tint;
    }
    rest = mean * area_of(&s.rest);
    *tint = (sum.tint + 0.5 * rest) / whole;
    return (sum.area + rest) / whole;
}
