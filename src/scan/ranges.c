/* ranges.c -- see ranges.h. Places are cut off to whole numbers, not rounded down: all are made positive, or set right by one comparison. */
#include "scan/ranges.h"
#include "base/vector.h"

#define INLINE static inline __attribute__((always_inline))

/* Tiles reach a little over their borders, and half a row over those above and below. */
#define ACROSS 1e-3
#define DOWN 0.5

INLINE double between(double v, double low, double high)
{
    double t = v > low ? v : low;
    return t < high ? t : high;
}

/* The number of the first sample line at or below y. */
INLINE int32_t line_at(double y, double lines)
{
    double t = between(y * lines - 0.5, -1e9, 1e9);
    int32_t whole = (int32_t)t;
    return whole + (t > (double)whole);
}

INLINE int is_in_sight(double x0, double x1, double y0, double y1, double width, double height, double lines)
{
    return (x1 > 0) & (x0 < width) & (y1 > -DOWN) & (y0 < height + DOWN) & (line_at(y0, lines) < line_at(y1, lines));
}

gnoi_tile_range gnoi_tile_range_of(const gnoi_tile_grid *g, const gnoi_rect *box, float nearest)
{
    gnoi_tile_range none = {1, 1, 0, 0, 0}, r;
    if (!is_in_sight(box->x0, box->x1, box->y0, box->y1, g->width, g->height, g->lines))
        return none;
    r.x0 = (uint16_t)between((box->x0 - ACROSS) / GNOI_TILE_W, 0, g->tiles_x - 1);
    r.x1 = (uint16_t)between((box->x1 + ACROSS) / GNOI_TILE_W, 0, g->tiles_x - 1);
    r.y0 = (uint16_t)between((box->y0 - DOWN) / GNOI_TILE_H, 0, g->tiles_y - 1);
    r.y1 = (uint16_t)between((box->y1 + DOWN) / GNOI_TILE_H, 0, g->tiles_y - 1);
    r.key = gnoi_nearness_key(nearest, 1) | (gnoi_is_large(box->x1 - box->x0, box->y1 - box->y0) ? GNOI_LARGE : 0);
    return r;
}

/* Sixteen ranges, a field at a time. */
typedef struct fields {
    int32_t x0[GNOI_LANES], x1[GNOI_LANES], y0[GNOI_LANES], y1[GNOI_LANES], seen[GNOI_LANES], large[GNOI_LANES], within[GNOI_LANES];
} fields;

VECTOR_CLONES static void find_fields(const gnoi_tile_grid *g, const gnoi_lanes *restrict l, fields *restrict f)
{
    const double width = g->width, height = g->height, lines = g->lines, reach = g->reach, most_x = g->tiles_x - 1, most_y = g->tiles_y - 1;
    for (int i = 0; i < GNOI_LANES; i++) {
        const double x0 = l->x0[i], x1 = l->x1[i], y0 = l->y0[i], y1 = l->y1[i];
        f->seen[i] = is_in_sight(x0, x1, y0, y1, width, height, lines);
        f->within[i] = (x0 >= -reach) & (x1 <= reach) & (y0 >= -reach) & (y1 <= reach);
        f->large[i] = !((x1 - x0 <= GNOI_TILE_W) & (y1 - y0 <= GNOI_TILE_H));
    }
    for (int i = 0; i < GNOI_LANES; i++) {
        f->x0[i] = (int32_t)between((l->x0[i] - ACROSS) / GNOI_TILE_W, 0, most_x);
        f->x1[i] = (int32_t)between((l->x1[i] + ACROSS) / GNOI_TILE_W, 0, most_x);
        f->y0[i] = (int32_t)between((l->y0[i] - DOWN) / GNOI_TILE_H, 0, most_y);
        f->y1[i] = (int32_t)between((l->y1[i] + DOWN) / GNOI_TILE_H, 0, most_y);
    }
}

unsigned gnoi_tile_ranges(const gnoi_tile_grid *g, const gnoi_lanes *lanes, gnoi_tile_range range[GNOI_LANES])
{
    unsigned within = 0;
    fields f;
    find_fields(g, lanes, &f);
    for (int i = 0; i < GNOI_LANES; i++) {
        gnoi_tile_range none = {1, 1, 0, 0, 0}, *r = &range[i];
        within |= (unsigned)f.within[i] << i;
        *r = none;
        if (!f.seen[i])
            continue;
        r->x0 = (uint16_t)f.x0[i];
        r->x1 = (uint16_t)f.x1[i];
        r->y0 = (uint16_t)f.y0[i];
        r->y1 = (uint16_t)f.y1[i];
        r->key = gnoi_nearness_key(lanes->z1[i], 1) | (f.large[i] ? GNOI_LARGE : 0);
    }
    return within;
}
