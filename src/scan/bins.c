/* bins.c -- see bins.h. Two passes over the polygons in fixed chunks: count by tile, then fill. */
#include "scan/bins.h"
#include "base/pages.h"
#include "base/parallel.h"
#include "scan/ranges.h"
#include <string.h>

#define CHUNK 8192
#define VERTEX_CHUNK 32768

typedef struct job {
    const gno_scene *scene;
    const gnoi_view *view;
    gnoi_bins *bins;
    gnoi_tile_grid grid;
    size_t chunk_count, tile_count;
    gnoi_tile_range *ranges;
    uint32_t *counts; /* chunk_count x tile_count: how many, then where the chunk's next item goes */
    gnoi_outline *outlines; /* one for each worker */
} job;

static float reach_of(const gnoi_prepared *prep, const double *p)
{
    double reach = 0;
    for (int k = 0; k < 3; k++) {
        double r = fabs(p[k] - 0.5 * (prep->lower[k] + prep->upper[k]));
        reach = r > reach ? r : reach;
    }
    return (float)reach;
}

static gno_status project_chunk(void *user, int worker, size_t piece)
{
    job *j = user;
    const gnoi_view *view = j->view;
    size_t end = (piece + 1) * VERTEX_CHUNK < j->bins->vertex_count ? (piece + 1) * VERTEX_CHUNK : j->bins->vertex_count;
    (void)worker;
    gnoi_pages_ready(j->bins->vertices + piece * VERTEX_CHUNK, (end - piece * VERTEX_CHUNK) * sizeof *j->bins->vertices);
    for (size_t i = piece * VERTEX_CHUNK; i < end; i++) {
        vec3 p = v3_from(j->scene->prepared.positions[i]);
        gnoi_vertex *v = &j->bins->vertices[i];
        double depth = gnoi_form_at(&view->depth, p), k = view->orthographic ? 1 : 1 / depth;
        v->reach = reach_of(&j->scene->prepared, j->scene->prepared.positions[i]);
        if (!(depth > view->near_depth)) {
            v->x = HUGE_VAL;
            v->y = 0;
            v->z = 0;
            continue;
        }
        v->x = gnoi_form_at(&view->x, p) * k;
        v->y = gnoi_form_at(&view->y, p) * k;
        v->z = (float)(view->orthographic ? -depth : k);
    }
    return GNO_OK;
}

uint32_t gnoi_nearness_key(float nearness, int opaque)
{
    union { float f; uint32_t i; } u = {nearness};
    uint32_t descending = u.i & 0x80000000u ? u.i : ~u.i & 0x7fffffffu;
    return descending >> 10 | (opaque ? 0 : GNOI_KEY_SEE_THROUGH);
}

float gnoi_key_nearness(uint32_t key)
{
    union { float f; uint32_t i; } u;
    u.i = (key & (GNOI_KEY_SEE_THROUGH - 1)) << 10;
    if (!(u.i & 0x80000000u))
        u.i = ~u.i & 0x7fffffffu;
    return u.f == u.f ? u.f : HUGE_VALF;
}

gnoi_rect gnoi_tile_rect(const gnoi_view *view, int x, int y)
{
    gnoi_rect r = {x * GNOI_TILE_W, y * GNOI_TILE_H - 0.5, (x + 1) * GNOI_TILE_W, (y + 1) * GNOI_TILE_H};
    r.x1 = r.x1 < view->width ? r.x1 : view->width;
    r.y1 = (r.y1 < view->height ? r.y1 : view->height) + 0.5;
    return r;
}

/* The range of a polygon that is no triangle near the picture. Returns 0 when memory fails. */
static int bound_outline(const job *j, size_t i, gnoi_outline *outline, gnoi_tile_range *range)
{
    gnoi_rect box;
    if (!gnoi_outline_set(outline, j->scene, j->view, j->bins->vertices, &j->scene->prepared.polys[i]))
        return 0;
    box.x0 = outline->count < 3 ? HUGE_VAL : outline->x0;
    box.x1 = outline->x1;
    box.y0 = outline->y0;
    box.y1 = outline->y1;
    *range = gnoi_tile_range_of(&j->grid, &box, outline->cut ? HUGE_VALF : outline->z1);
    range->key |= outline->cut ? GNOI_LARGE : 0;
    return 1;
}

/* Whether records need not be looked at: all polygons of the chunk are opaque triangles. */
static int is_plain(const gnoi_prepared *prep, size_t i)
{
    return prep->chunk_corner[i / GNOI_CHUNK] != GNOI_NONE && prep->chunk_opaque[i / GNOI_CHUNK];
}

/* The ranges of the `count` polygons from i on. Returns 0 when memory fails. */
static int bound_polygons(const job *j, size_t i, unsigned count, gnoi_outline *outline, gnoi_tile_range range[GNOI_LANES])
{
    const gnoi_prepared *prep = &j->scene->prepared;
    const int plain = is_plain(prep, i);
    uint32_t index[GNOI_LANES] = {0};
    gnoi_lanes lanes;
    unsigned within;
    for (unsigned k = 0; k < count; k++)
        index[k] = (uint32_t)(i + k);
    gnoi_lanes_load(&lanes, prep, j->bins, index, count);
    gnoi_lanes_bound(&lanes);
    within = gnoi_tile_ranges(&j->grid, &lanes, range);
    for (unsigned k = 0; k < count; k++) {
        int near = within >> k & 1 && (plain || prep->polys[i + k].corner_count == 3);
        if (!near && !bound_outline(j, i + k, outline, &range[k]))
            return 0;
        if (!plain && !prep->polys[i + k].opaque)
            range[k].key |= GNOI_KEY_SEE_THROUGH;
    }
    return 1;
}

static gno_status count_chunk(void *user, int worker, size_t piece)
{
    job *j = user;
    const size_t polys = j->scene->prepared.poly_count, width = (size_t)j->bins->tiles_x;
    size_t end = (piece + 1) * CHUNK < polys ? (piece + 1) * CHUNK : polys;
    uint32_t *counts = j->counts + piece * j->tile_count;
    gnoi_pages_ready(j->ranges + piece * CHUNK, (end - piece * CHUNK) * sizeof *j->ranges);
    for (size_t i = piece * CHUNK; i < end; i += GNOI_LANES) {
        const unsigned count = end - i < GNOI_LANES ? (unsigned)(end - i) : GNOI_LANES;
        gnoi_tile_range range[GNOI_LANES];
        if (!bound_polygons(j, i, count, &j->outlines[worker], range))
            return GNO_ERROR_MEMORY;
        memcpy(j->ranges + i, range, count * sizeof *range);
        for (unsigned k = 0; k < count; k++)
            for (size_t y = range[k].y0; y <= range[k].y1 && range[k].x0 <= range[k].x1; y++)
                for (size_t x = range[k].x0; x <= range[k].x1; x++)
                    counts[y * width + x]++;
    }
    return GNO_OK;
}

float gnoi_nearest_over(const gno_scene *scene, const gnoi_view *view, const gnoi_poly *poly, const gnoi_rect *rect)
{
    const gnoi_prepared *prep = &scene->prepared;
    double side = gnoi_view_side(view, poly->n, poly->d), tolerance, high;
    gnoi_screen_plane p;
    float z;
    if (side == 0)
        return HUGE_VALF;
    p = gnoi_view_nearness(view, poly->n, poly->d, side);
    tolerance = gnoi_plane_tolerance(prep, (const double(*)[3])prep->positions, poly) / fabs(side);
    high = fmax(p.fx * rect->x0, p.fx * rect->x1) + fmax(p.fy * rect->y0, p.fy * rect->y1) + p.f0;
    high += view->orthographic ? tolerance : tolerance * fabs(high);
    z = (float)high + 2 * GNOI_FLOAT_SLACK * fabsf((float)high);
    return z == z ? z : HUGE_VALF;
}

/* The key of polygon i in tile (x, y). */
static uint32_t key_in_tile(const job *j, size_t i, uint32_t key, int x, int y)
{
    const gnoi_poly *poly = &j->scene->prepared.polys[i];
    gnoi_rect rect = gnoi_tile_rect(j->view, x, y);
    uint32_t here;
    if (!(key & GNOI_LARGE))
        return key;
    here = gnoi_nearness_key(gnoi_nearest_over(j->scene, j->view, poly, &rect), poly->opaque);
    key &= ~GNOI_LARGE;
    return here > key ? here : key;
}

static gno_status fill_chunk(void *user, int worker, size_t piece)
{
    job *j = user;
    size_t count = j->scene->prepared.poly_count;
    size_t end = (piece + 1) * CHUNK < count ? (piece + 1) * CHUNK : count;
    uint32_t *next = j->counts + piece * j->tile_count;
    (void)worker;
    for (size_t i = piece * CHUNK; i < end; i++) {
        gnoi_tile_range r = j->ranges[i];
        for (int y = r.y0; y <= r.y1 && r.x0 <= r.x1; y++)
            for (int x = r.x0; x <= r.x1; x++) {
                gnoi_keyed *item = &j->bins->items[next[(size_t)y * (size_t)j->bins->tiles_x + (size_t)x]++];
                item->key = key_in_tile(j, i, r.key, x, y);
                item->value = (uint32_t)i;
            }
    }
    return GNO_OK;
}

/* Counts become places: tiles in order, within a tile the chunks in order. Returns 0 when they pass 32 bits. */
static int place_items(job *j)
{
    uint64_t sum = 0;
    for (size_t t = 0; t < j->tile_count; t++) {
        j->bins->start[t] = (uint32_t)sum;
        for (size_t c = 0; c < j->chunk_count; c++) {
            uint32_t n = j->counts[c * j->tile_count + t];
            j->counts[c * j->tile_count + t] = (uint32_t)sum;
            sum += n;
            if (sum > 0xffffffffu)
                return 0;
        }
    }
    j->bins->start[j->tile_count] = (uint32_t)sum;
    j->bins->item_count = (size_t)sum;
    return 1;
}

static float nearest_depth(const gnoi_bins *bins)
{
    float z = -HUGE_VALF;
    for (size_t i = 0; i < bins->vertex_count; i++)
        if (bins->vertices[i].x < HUGE_VAL && bins->vertices[i].z > z)
            z = bins->vertices[i].z;
    return z > -HUGE_VALF ? -z : 0;
}

static gno_status run(job *j, int threads)
{
    gno_context *context = j->scene->context;
    gnoi_bins *b = j->bins;
    gno_status status;
    status = gnoi_parallel(context, threads, (b->vertex_count + VERTEX_CHUNK - 1) / VERTEX_CHUNK, "project", project_chunk, j);
    if (!status)
        status = gnoi_parallel(context, threads, j->chunk_count, "project", count_chunk, j);
    if (status)
        return status;
    if (!place_items(j))
        return gnoi_fail(context, GNO_ERROR_LIMIT, "too many polygons in too many tiles of the picture");
    b->items = gnoi_malloc(context, b->item_count, sizeof *b->items);
    if (!b->items)
        return GNO_ERROR_MEMORY;
    if (j->view->orthographic)
        b->nearest_depth = nearest_depth(b);
    return gnoi_parallel(context, threads, j->chunk_count, "project", fill_chunk, j);
}

gno_status gnoi_bins_build(const gno_scene *scene, const gnoi_view *view, int lines, int threads, gnoi_bins *bins)
{
    gno_context *context = scene->context;
    const size_t polys = scene->prepared.poly_count;
    gno_status status = GNO_ERROR_MEMORY;
    job j;
    memset(&j, 0, sizeof j);
    memset(bins, 0, sizeof *bins);
    j.scene = scene;
    j.view = view;
    j.bins = bins;
    bins->tiles_x = (view->width + GNOI_TILE_W - 1) / GNOI_TILE_W;
    bins->tiles_y = (view->height + GNOI_TILE_H - 1) / GNOI_TILE_H;
    bins->vertex_count = scene->prepared.vertex_count;
    for (int k = 0; k < 3; k++)
        bins->middle = fmax(bins->middle, fabs(0.5 * (scene->prepared.lower[k] + scene->prepared.upper[k])));
    j.grid.width = view->width;
    j.grid.height = view->height;
    j.grid.tiles_x = bins->tiles_x;
    j.grid.tiles_y = bins->tiles_y;
    j.grid.lines = lines;
    j.grid.reach = gnoi_outline_reach(view);
    j.tile_count = (size_t)bins->tiles_x * (size_t)bins->tiles_y;
    j.chunk_count = (polys + CHUNK - 1) / CHUNK;
    threads = gnoi_thread_count(threads);
    bins->vertices = gnoi_malloc(context, bins->vertex_count, sizeof *bins->vertices);
    bins->start = gnoi_malloc(context, j.tile_count + 1, sizeof *bins->start);
    j.ranges = gnoi_malloc(context, polys, sizeof *j.ranges);
    j.counts = gnoi_calloc(context, j.chunk_count * j.tile_count, sizeof *j.counts);
    j.outlines = gnoi_calloc(context, (size_t)threads, sizeof *j.outlines);
    if (bins->vertices && bins->start && j.ranges && j.counts && j.outlines) {
        for (int i = 0; i < threads; i++)
            j.outlines[i].context = context;
        status = run(&j, threads);
        for (int i = 0; i < threads; i++)
            gnoi_outline_free(&j.outlines[i]);
    }
    gnoi_free(context, j.ranges, polys, sizeof *j.ranges);
    gnoi_free(context, j.counts, j.chunk_count * j.tile_count, sizeof *j.counts);
    gnoi_free(context, j.outlines, (size_t)threads, sizeof *j.outlines);
    if (status)
        gnoi_bins_free(context, bins);
    return status;
}

void gnoi_bins_free(gno_context *context, gnoi_bins *bins)
{
    size_t tiles = (size_t)bins->tiles_x * (size_t)bins->tiles_y;
    gnoi_free(context, bins->vertices, bins->vertex_count, sizeof *bins->vertices);
    gnoi_free(context, bins->start, tiles + 1, sizeof *bins->start);
    gnoi_free(context, bins->items, bins->item_count, sizeof *bins->items);
    memset(bins, 0, sizeof *bins);
}
