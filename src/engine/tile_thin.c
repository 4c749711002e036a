/* tile_thin.c -- where something passes that base lines may miss over many pixels, nearly level and flatter than they are apart:
 * see tile.h.
 */
#include "engine/tile.h"

/* A polygon counts as thin from this width on, in pixels, and while it rises by less than this share of it. */
#define THIN_WIDTH 6.0
#define THIN_SLOPE 0.5

int gnoi_tile_is_thin(const gnoi_tile *tile, const gnoi_poly *poly, double width, double height)
{
    const gnoi_prepared *prep = &tile->job->scene->prepared;
    const uint32_t *vertex = prep->corner_vertex;
    uint32_t end = prep->ring_corner[poly->ring + 1];
    const gnoi_vertex *a = &tile->job->bins.vertices[vertex[poly->corner]];
    double area = 0;
    if (width < THIN_WIDTH || height > THIN_SLOPE * width + 1)
        return 0;
    for (uint32_t i = poly->corner + 1; i + 1 < end; i++) {
        const gnoi_vertex *b = &tile->job->bins.vertices[vertex[i]], *c = &tile->job->bins.vertices[vertex[i + 1]];
        area += 0.5 * ((b->x - a->x) * (c->y - a->y) - (b->y - a->y) * (c->x - a->x));
    }
    return fabs(area) * tile->job->def.base_lines < width;
}

/* The pixel number v lies in, cut off towards 0, from -1 to most: coordinates may be beyond any integer. */
static int pixel_at(double v, int most) { return v > -1 ? v < most ? (int)v : most : -1; }

void gnoi_tile_mark_thin(gnoi_tile *tile, const gnoi_edge *edges, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const gnoi_edge *e = &edges[i];
        double x1 = e->x + (e->y1 - e->y) * e->slope, left = (e->x < x1 ? e->x : x1) - tile->x0, right = (e->x < x1 ? x1 : e->x) - tile->x0;
        int first, last;
        if (right - left < THIN_WIDTH || fabs(e->slope) * THIN_SLOPE < 1)
            continue;
        first = left > 0 ? pixel_at(left, tile->width) : 0;
        last = right < tile->width ? pixel_at(right, tile->width) : tile->width - 1;
        for (int x = first; x <= last; x++) {
            double at = tile->x0 + x + 0.5, y = e->y + (at - e->x) / e->slope - tile->y0 + 1;
            y = y < e->y - tile->y0 + 1 ? e->y - tile->y0 + 1 : y > e->y1 - tile->y0 + 1 ? e->y1 - tile->y0 + 1 : y;
            if (y >= 1 && y < tile->height + 1)
                tile->thin[(int)y * GNOI_TILE_W + x] = 1;
        }
    }
}

void gnoi_tile_mark_level(gnoi_tile *tile, double x0, double y0, double x1, double y1)
{
    int first = x0 > tile->x0 ? pixel_at(x0 - tile->x0, tile->width) : 0;
    int last = x1 < tile->x0 + tile->width ? pixel_at(x1 - tile->x0, tile->width) : tile->width - 1;
    double top = y0 - tile->y0 + 1, bottom = y1 - tile->y0 + 1;
    if (y1 - y0 >= 1)
        return;
    for (int row = top > 1 ? pixel_at(top, tile->height + 1) : 1; row <= tile->height && row <= bottom; row++)
        for (int x = first; x <= last; x++)
            tile->thin[row * GNOI_TILE_W + x] = 1;
}
