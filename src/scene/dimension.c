/* dimension.c -- the fractal dimension of a set of points, by counting boxes.
 *
 * Place in the data flow: a caller's points -> here -> a number. Knows nothing of scenes.
 *   points -> box of each at a level -> a hash table of points whose boxes differ -> number of boxes; levels -> slope of a line
 * Source: textbook section 8.5, H = log G / log A; counting boxes as in Mandelbrot, "The Fractal Geometry of Nature", 1982.
 */
#include "base/context.h"
#include "base/vec.h"

#include <string.h>

#define MOST_POINTS 1073741824u /* 2^30: numbers of points and places in the table fit 32 bits */
#define MOST_BOXES 4503599627370496.0 /* 2^52 along an axis: beyond, doubles do not tell them apart */
#define FREE 0xffffffffu

typedef struct counting {
    size_t count, capacity;
    const double *points;
    double low[3], extent;
    uint32_t *table; /* `capacity` places, a power of two at least twice `count`: the first point found in a box, or FREE */
} counting;

static void box_of(const counting *c, size_t point, double boxes, uint64_t box[3])
{
    for (int k = 0; k < 3; k++) {
        double at = (c->points[3 * point + (size_t)k] - c->low[k]) / c->extent * boxes;
        box[k] = at < boxes ? (uint64_t)at : (uint64_t)boxes - 1; /* the far border belongs to the last box */
    }
}

static size_t place_of(const counting *c, const uint64_t box[3])
{
    uint64_t h = box[0] * 0x9e3779b97f4a7c15u + box[1] * 0xc2b2ae3d27d4eb4fu + box[2] * 0x165667b19e3779f9u;
    h ^= h >> 32;
    h *= 0xd6e8feb86659fd93u;
    h ^= h >> 32;
    return (size_t)h & (c->capacity - 1);
}

static size_t count_boxes(const counting *c, double boxes)
{
    size_t found = 0;
    memset(c->table, 0xff, c->capacity * sizeof *c->table);
    for (size_t i = 0; i < c->count; i++) {
        uint64_t box[3], other[3];
        size_t at;
        box_of(c, i, boxes, box);
        for (at = place_of(c, box); c->table[at] != FREE; at = (at + 1) & (c->capacity - 1)) {
            box_of(c, c->table[at], boxes, other);
            if (!memcmp(box, other, sizeof box))
                break;
        }
        if (c->table[at] == FREE) {
            c->table[at] = (uint32_t)i;
            found++;
        }
    }
    return found;
}

static int measure(counting *c)
{
    double high[3] = {0, 0, 0};
    for (size_t i = 0; i < c->count; i++)
        for (int k = 0; k < 3; k++) {
            double x = c->points[3 * i + (size_t)k];
            if (!(fabs(x) <= GNO_MAX_COORDINATE))
                return 0;
            c->low[k] = i == 0 || x < c->low[k] ? x : c->low[k];
            high[k] = i == 0 || x > high[k] ? x : high[k];
        }
    for (int k = 0; k < 3; k++)
        c->extent = fmax(c->extent, high[k] - c->low[k]);
    return 1;
}

/* Slope of the straight line nearest to log(boxes) over level times log A. */
static double slope_over_levels(const counting *c, int magnification, int first, int last)
{
    double boxes = 1, sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0, n = last - first + 1, step = log(magnification);
    for (int level = 0; level <= last; level++, boxes *= magnification) {
        double x = level * step, y;
        if (level < first)
            continue;
        y = log((double)count_boxes(c, boxes));
        sum_x += x;
        sum_y += y;
        sum_xx += x * x;
        sum_xy += x * y;
    }
    return (n * sum_xy - sum_x * sum_y) / (n * sum_xx - sum_x * sum_x);
}

gno_status gno_fractal_dimension(gno_context *context, size_t count, const double *points, int magnification, int first_level,
                                 int levels, double *dimension)
{
    counting c = {count, 1, points, {0, 0, 0}, 0, NULL};
    if (!context || !points || !dimension || count == 0)
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "fractal dimension: context, points or dimension is NULL, or there is no point");
    if (count > MOST_POINTS)
        return gnoi_fail(context, GNO_ERROR_LIMIT, "fractal dimension: more than %u points", MOST_POINTS);
    if (magnification < 2 || first_level < 0 || levels <= first_level || !(levels * log2(magnification) <= log2(MOST_BOXES)))
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "fractal dimension: magnification %d, levels %d to %d are out of range",
                         magnification, first_level, levels);
    if (!measure(&c))
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "fractal dimension: a coordinate is not finite or beyond %g", GNO_MAX_COORDINATE);
    *dimension = 0;
    if (!(c.extent > 0))
        return GNO_OK;
    while (c.capacity < 2 * count)
        c.capacity *= 2;
    c.table = gnoi_malloc(context, c.capacity, sizeof *c.table);
    if (!c.table)
        return gnoi_fail(context, GNO_ERROR_MEMORY, "fractal dimension: out of memory");
    *dimension = slope_over_levels(&c, magnification, first_level, levels);
    gnoi_free(context, c.table, c.capacity, sizeof *c.table);
    return GNO_OK;
}
