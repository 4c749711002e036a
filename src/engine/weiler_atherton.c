/* weiler_atherton.c -- the object-space engine: visible pieces painted with exact area coverage.
 *
 * Place in the data flow: visible pieces, and beside them what single lights reach of each -> picture edges by tile (scan/piece_bins.h) -> area
 * and centre in every pixel (scan/coverage.h) -> samples as the scan-line engine takes them (tile_rows.c, tile_shade.c) -> picture.
 * A pixel gives one sample for each polygon seen in it, at the middle of what is seen, and one more for each lamp that reaches only a
 * part of that, in the middle of the part.
 * Invariants: opaque pieces do not overlap, so the order of painting has no meaning; what they leave of a pixel shows the background.
 * Pieces that are not opaque lie over others (piece_veil.h). A tile depends on nothing but the pieces, so that any thread may make it.
 */
#include "base/parallel.h"
#include "engine/job.h"
#include "engine/piece_veil.h"
#include "scan/coverage.h"
#include "scan/piece_bins.h"
#include "shadow/lamp.h"
#include <string.h>

/* Parts of a pixel smaller than this add less than any picture format can hold. */
#define LEAST_AREA 1e-7

/* Coverage of a polygon, or of its part that one lamp reaches, over a tile. */
typedef struct sums {
    gnoi_tile_values area, mx, my;
} sums;

typedef struct lamp_sums {
    sums cover;
    gnoi_tile_values light[3]; /* area times the light that came through */
} lamp_sums;

/* One piece in one tile: sums over pixels. */
typedef struct share {
    double rgb[3], area;
} share;

/* A set of pieces and where its pieces are. */
typedef struct layer {
    const gno_pieces *pieces; /* NULL: none */
    gnoi_piece_bins bins;
} layer;

typedef struct paint_job {
    const gnoi_frame_job *frame;
    layer seen;   /* what the eye sees */
    layer beside; /* what single lights reach of it where that is neither all nor nothing */
    share *shares; /* one for each of seen.bins.items, when means are wanted */
    struct painter **workers;
} paint_job;

/* Pieces of one polygon and sheet in a tile; and, among others of the same scene polygon, what single lights reach of them. */
typedef struct run {
    const uint32_t *items;
    size_t count;
    const uint32_t *beside;
    size_t beside_count;
    uint32_t poly, sheet;
} run;

typedef struct painter {
    gnoi_tile tile;
    const paint_job *job;
    gnoi_coverage coverage;
    sums total;
    gnoi_tile_values covered;      /* by all opaque polygons */
    gnoi_piece_veils veils;        /* all that is not opaque */
    gnoi_tile_values composed[3];  /* with veils: the picture so far */
    gnoi_column *columns;          /* one for each lamp; only the state is used */
    uint32_t *whole, *any, *split; /* for each lamp: pieces it reaches undimmed, pieces it reaches, its place in lamp_sums */
    size_t split_count, split_capacity;
    lamp_sums *lamp_sums;
} painter;

/* ---- life of a worker ----------------------------------------------------------------------------------------------- */

static int painter_init(painter *p, const paint_job *job)
{
    gno_context *context = job->frame->scene->context;
    size_t lamps = (size_t)job->frame->lamp_count;
    memset(p, 0, sizeof *p);
    p->job = job;
    p->columns = gnoi_calloc(context, lamps, sizeof *p->columns);
    p->whole = gnoi_calloc(context, lamps, sizeof *p->whole);
    p->any = gnoi_calloc(context, lamps, sizeof *p->any);
    p->split = gnoi_calloc(context, lamps, sizeof *p->split);
    return gnoi_tile_init(&p->tile, job->frame) && p->columns && p->whole && p->any && p->split;
}

static void painter_free(gno_context *context, painter *p)
{
    size_t lamps = (size_t)p->job->frame->lamp_count;
    gnoi_tile_free(&p->tile);
    gnoi_free(context, p->columns, lamps, sizeof *p->columns);
    gnoi_free(context, p->whole, lamps, sizeof *p->whole);
    gnoi_free(context, p->any, lamps, sizeof *p->any);
    gnoi_free(context, p->split, lamps, sizeof *p->split);
    gnoi_piece_veils_free(context, &p->veils);
    gnoi_free(context, p->lamp_sums, p->split_capacity, sizeof *p->lamp_sums);
}

/* ---- coverage of one polygon ------------------------------------------------------------------------------------------ */

static void count_lights(painter *p, const gno_pieces *pieces, uint32_t index)
{
    gno_piece piece;
    gno_pieces_get(pieces, index, &piece);
    for (size_t k = 0; k < piece.light_count; k++) {
        const double *passed = piece.passed + 3 * k;
        p->any[piece.lights[k]]++;
        p->whole[piece.lights[k]] += passed[0] >= 1 && passed[1] >= 1 && passed[2] >= 1;
    }
}

static int is_beside(const painter *p, const run *r, size_t i)
{
    const gnoi_picture_piece *shape = &p->job->beside.bins.pieces[r->beside[i]];
    return shape->poly == r->poly && shape->sheet == r->sheet;
}

/* Sets the lamps' columns for a run. */
static int sort_lamps(painter *p, const run *r)
{
    size_t lamps = (size_t)p->job->frame->lamp_count;
    p->split_count = 0;
    memset(p->whole, 0, lamps * sizeof *p->whole);
    memset(p->any, 0, lamps * sizeof *p->any);
    for (size_t i = 0; i < r->count; i++)
        count_lights(p, p->job->seen.pieces, r->items[i]);
    for (size_t j = 0; j < lamps; j++)
        p->columns[j].state = p->whole[j] == r->count ? GNOI_COLUMN_LIT : GNOI_COLUMN_UNKNOWN;
    for (size_t i = 0; i < r->beside_count; i++)
        if (is_beside(p, r, i))
            count_lights(p, p->job->beside.pieces, r->beside[i]);
    for (size_t j = 0; j < lamps; j++) {
        if (p->columns[j].state != GNOI_COLUMN_LIT)
            p->columns[j].state = p->any[j] == 0 ? GNOI_COLUMN_DARK : GNOI_COLUMN_SPLIT;
        p->split[j] = (uint32_t)p->split_count;
        p->split_count += p->columns[j].state == GNOI_COLUMN_SPLIT;
    }
    return gnoi_reserve(p->tile.lines.context, (void **)&p->lamp_sums, &p->split_capacity, p->split_count, sizeof *p->lamp_sums);
}

static void add_sums(sums *to, const gnoi_coverage *from, int first, int last)
{
    for (int y = from->first_row; y <= from->last_row; y++) {
        const gnoi_coverage_row *row = &from->rows[y];
        for (int x = first; x <= last; x++) {
            to->area[y][x] += row->area[x];
            to->mx[y][x] += row->mx[x];
            to->my[y][x] += row->my[x];
        }
    }
}

static void add_light(lamp_sums *to, const gnoi_coverage *from, int first, int last, const double passed[3])
{
    add_sums(&to->cover, from, first, last);
    for (int y = from->first_row; y <= from->last_row; y++)
        for (int k = 0; k < 3; k++)
            for (int x = first; x <= last; x++)
                to->light[k][y][x] += passed[k] * from->rows[y].area[x];
}

static int clamp_pixel(double x, int width)
{
    return x < 0 ? 0 : x > width - 1 ? width - 1 : (int)x;
}

/* Adds one piece to the sums of its polygon, where it is seen, and of the lamps that reach it. */
static void add_piece(painter *p, const layer *from, uint32_t index, int seen)
{
    const gnoi_picture_piece *shape = &from->bins.pieces[index];
    const gnoi_tile *tile = &p->tile;
    uint32_t edge, count;
    const uint32_t *listed = gnoi_piece_band(&from->bins, shape, tile->y0 / GNOI_TILE_H, &edge, &count);
    int first = clamp_pixel(shape->x0 - tile->x0, tile->width), last = clamp_pixel(shape->x1 - tile->x0, tile->width);
    gno_piece piece;
    gnoi_coverage_start(&p->coverage, tile->x0, tile->y0, tile->width, tile->height);
    for (uint32_t i = 0; i < count; i++) {
        const gnoi_piece_edge *e = &from->bins.edges[listed ? listed[i] : edge + i];
        gnoi_coverage_edge(&p->coverage, e->ax, e->ay, e->bx, e->by, 1);
    }
    gnoi_coverage_finish(&p->coverage);
    if (seen)
        add_sums(&p->total, &p->coverage, first, last);
    gno_pieces_get(from->pieces, index, &piece);
    for (size_t k = 0; k < piece.light_count; k++)
        if (p->columns[piece.lights[k]].state == GNOI_COLUMN_SPLIT)
            add_light(&p->lamp_sums[p->split[piece.lights[k]]], &p->coverage, first, last, piece.passed + 3 * k);
}

static void add_pieces(painter *p, const run *r)
{
    memset(&p->total, 0, sizeof p->total);
    if (p->split_count > 0)
        memset(p->lamp_sums, 0, p->split_count * sizeof *p->lamp_sums);
    for (size_t i = 0; i < r->count; i++)
        add_piece(p, &p->job->seen, r->items[i], 1);
    for (size_t i = 0; i < r->beside_count; i++)
        if (is_beside(p, r, i))
            add_piece(p, &p->job->beside, r->beside[i], 0);
}

/* ---- samples ---------------------------------------------------------------------------------------------------------- */

static void set_cell(gnoi_cells *cells, const sums *from, int y, int x)
{
    double area = from->area[y][x];
    cells->length[x] = area > LEAST_AREA ? (float)area : 0;
    cells->mx[x] = (float)from->mx[y][x];
    cells->my[x] = (float)from->my[y][x];
}

static void sample_pixel(painter *p, gnoi_slot *slot, int y, int x)
{
    gnoi_tile *tile = &p->tile;
    set_cell(&tile->cells, &p->total, y, x);
    for (int j = 0; j < p->job->frame->lamp_count; j++) {
        const lamp_sums *lit;
        if (p->columns[j].state != GNOI_COLUMN_SPLIT)
            continue;
        lit = &p->lamp_sums[p->split[j]];
        set_cell(&tile->lit[j], &lit->cover, y, x);
        for (int k = 0; k < 3; k++)
            tile->lit_colour[j][k][x] = lit->light[k][y][x] > 0 ? (float)lit->light[k][y][x] : 0; /* not under zero by rounding */
    }
    gnoi_tile_sample_pixel(tile, slot, p->columns, y + 1, x);
}

/* The one slot of the tile, set for a prepared polygon. */
static gnoi_slot *set_slot(painter *p, uint32_t index)
{
    gnoi_tile *tile = &p->tile;
    const gnoi_frame_job *frame = p->job->frame;
    gnoi_slot *slot;
    if (!gnoi_reserve(tile->lines.context, (void **)&tile->slots, &tile->slot_capacity, 1, sizeof *tile->slots))
        return NULL;
    slot = tile->slots;
    memset(slot, 0, sizeof *slot);
    slot->first_column = slot->first_intensity = slot->intensity_triangle = slot->mapping = GNOI_NONE;
    tile->intensity_count = tile->mapping_count = 0;
    slot->receiver.poly = &frame->scene->prepared.polys[index];
    slot->receiver.index = index;
    slot->receiver.side = gnoi_view_side(&frame->view, slot->receiver.poly->n, slot->receiver.poly->d);
    if (slot->receiver.side == 0)
        return slot;
    slot->receiver.nearness = gnoi_view_nearness(&frame->view, slot->receiver.poly->n, slot->receiver.poly->d, slot->receiver.side);
    return slot;
}

/* Paints a run. Returns 0 when memory fails. */
static int paint_run(painter *p, const run *r)
{
    gnoi_tile *tile = &p->tile;
    gnoi_slot *slot = set_slot(p, r->poly);
    if (!slot || !sort_lamps(p, r))
        return 0;
    if (slot->receiver.side == 0)
        return 1;
    add_pieces(p, r);
    for (int y = 0; y < tile->height; y++)
        for (int x = 0; x < tile->width; x++) {
            if (p->total.area[y][x] > LEAST_AREA)
                sample_pixel(p, slot, y, x);
            if (slot->receiver.poly->opaque)
                p->covered[y][x] += p->total.area[y][x];
        }
    tile->spans += (double)r->count;
    return !tile->failed;
}

/* ---- tiles ------------------------------------------------------------------------------------------------------------ */

static void add_background(painter *p)
{
    gnoi_tile *tile = &p->tile;
    const double *background = p->job->frame->scene->image.background;
    for (int y = 0; y < tile->height; y++)
        for (int x = 0; x < tile->width; x++) {
            int pixel = (y + 1) * GNOI_TILE_W + x;
            double left = 1 - p->covered[y][x], veil[3];
            tile->weight[pixel] = 1;
            if (left > LEAST_AREA) {
                gnoi_piece_veils_at(&p->veils, tile, NULL, x, y, veil);
                for (int k = 0; k < 3; k++)
                    tile->acc[k][pixel] += (float)(left * veil[k] * background[k]);
            }
        }
}

static uint32_t source_of(const painter *p, const layer *of, uint32_t item)
{
    return p->job->frame->scene->prepared.polys[of->bins.pieces[item].poly].source;
}

/* The next run of tile `index`: the first for r->items NULL. Returns 0 when there is none. */
static int next_run(const painter *p, size_t index, run *r)
{
    const layer *seen = &p->job->seen, *beside = &p->job->beside;
    const uint32_t *end = seen->bins.items + seen->bins.start[index + 1], *beside_end;
    const gnoi_picture_piece *first;
    uint32_t source;
    r->beside = r->items ? r->beside : beside->pieces ? beside->bins.items + beside->bins.start[index] : NULL;
    r->items = r->items ? r->items + r->count : seen->bins.items + seen->bins.start[index];
    r->count = r->beside_count = 0;
    if (r->items == end)
        return 0;
    first = &seen->bins.pieces[*r->items];
    r->poly = first->poly;
    r->sheet = first->sheet;
    while (r->items + r->count < end && seen->bins.pieces[r->items[r->count]].group == first->group)
        r->count++;
    if (!beside->pieces)
        return 1;
    /* Both sets are in the order of the scene's polygons. */
    source = source_of(p, seen, *r->items);
    beside_end = beside->bins.items + beside->bins.start[index + 1];
    while (r->beside < beside_end && source_of(p, beside, *r->beside) < source)
        r->beside++;
    while (r->beside + r->beside_count < beside_end && source_of(p, beside, r->beside[r->beside_count]) == source)
        r->beside_count++;
    return 1;
}

/* Coverage of all polygons of a tile that are opaque, or of all that are not, into the veils. Returns 0 when memory fails. */
static int cover_veils(painter *p, size_t index, int opaque)
{
    run r = {NULL, 0, NULL, 0, 0, 0};
    while (next_run(p, index, &r)) {
        if ((int)p->job->frame->scene->prepared.polys[r.poly].opaque != opaque)
            continue;
        if (!set_slot(p, r.poly) || !sort_lamps(p, &r))
            return 0;
        if (p->tile.slots[0].receiver.side == 0)
            continue;
        add_pieces(p, &r);
        if (opaque)
            gnoi_piece_veils_cover(&p->veils, &p->tile, &p->tile.slots[0].receiver, p->total.area);
        else if (!gnoi_piece_veils_add(&p->veils, &p->tile, 0, p->total.area))
            return 0;
    }
    return 1;
}

/* Finds what each polygon that is not opaque does to what lies behind it. */
static int find_veils(painter *p, size_t index)
{
    p->veils.count = 0;
    if (!cover_veils(p, index, 0))
        return 0;
    if (p->veils.count == 0)
        return 1;
    if (!cover_veils(p, index, 1))
        return 0;
    gnoi_piece_veils_finish(&p->veils, &p->tile);
    return 1;
}

/* Moves what was painted of one polygon into the picture, as the veils before it leave it. */
static void compose(painter *p)
{
    gnoi_tile *tile = &p->tile;
    gnoi_tile_flush(tile);
    for (int y = 0; y < tile->height; y++)
        for (int x = 0; x < tile->width; x++) {
            int pixel = (y + 1) * GNOI_TILE_W + x;
            double left[3];
            if (!(p->total.area[y][x] > LEAST_AREA))
                continue;
            gnoi_piece_veils_at(&p->veils, tile, &tile->slots[0].receiver, x, y, left);
            for (int k = 0; k < 3; k++) {
                p->composed[k][y][x] += left[k] * (double)tile->acc[k][pixel];
                tile->acc[k][pixel] = 0;
            }
        }
}

static void take_composed(painter *p)
{
    for (int k = 0; k < 3; k++)
        for (int y = 0; y < p->tile.height; y++)
            for (int x = 0; x < p->tile.width; x++)
                p->tile.acc[k][(y + 1) * GNOI_TILE_W + x] = (float)p->composed[k][y][x];
}

static int paint_tile(painter *p, size_t index)
{
    run r = {NULL, 0, NULL, 0, 0, 0};
    gnoi_tile_start(&p->tile, index);
    memset(p->covered, 0, sizeof p->covered);
    if (!find_veils(p, index))
        return 0;
    if (p->veils.count > 0)
        memset(p->composed, 0, sizeof p->composed);
    while (next_run(p, index, &r)) {
        if (!paint_run(p, &r))
            return 0;
        if (p->veils.count > 0)
            compose(p);
    }
    gnoi_tile_flush(&p->tile);
    if (p->veils.count > 0)
        take_composed(p);
    add_background(p);
    gnoi_tile_write(&p->tile);
    return 1;
}

/* Paints each run of the tile alone and keeps its sums under its first item. */
static int sum_tile(painter *p, size_t index)
{
    run r = {NULL, 0, NULL, 0, 0, 0};
    gnoi_tile *tile = &p->tile;
    gnoi_tile_start(tile, index);
    while (next_run(p, index, &r)) {
        share *s = &p->job->shares[r.items - p->job->seen.bins.items];
        memset(&p->total, 0, sizeof p->total);
        if (!paint_run(p, &r))
            return 0;
        gnoi_tile_flush(tile);
        for (int y = 0; y < tile->height; y++)
            for (int x = 0; x < tile->width; x++) {
                int pixel = (y + 1) * GNOI_TILE_W + x;
                if (!(p->total.area[y][x] > LEAST_AREA))
                    continue;
                s->area += p->total.area[y][x];
                for (int k = 0; k < 3; k++) {
                    s->rgb[k] += (double)tile->acc[k][pixel];
                    tile->acc[k][pixel] = 0;
                }
            }
    }
    return 1;
}

static gno_status work_on_tile(void *user, int worker, size_t index)
{
    paint_job *job = user;
    gno_context *context = job->frame->scene->context;
    painter **p = &job->workers[worker];
    if (!*p) {
        *p = gnoi_calloc(context, 1, sizeof **p);
        if (!*p || !painter_init(*p, job))
            return GNO_ERROR_MEMORY;
    }
    return (job->shares ? sum_tile(*p, index) : paint_tile(*p, index)) ? GNO_OK : GNO_ERROR_MEMORY;
}

/* Runs over all tiles; `shaded` and `spans` of the workers are added to stats where given. */
static gno_status work_on_tiles(paint_job *job, gno_stats *stats)
{
    gno_context *context = job->frame->scene->context;
    int threads = gnoi_thread_count(job->frame->def.threads);
    size_t tiles = (size_t)job->seen.bins.tiles_x * (size_t)job->seen.bins.tiles_y;
    gno_status status;
    job->workers = gnoi_calloc(context, (size_t)threads, sizeof *job->workers);
    if (!job->workers)
        return GNO_ERROR_MEMORY;
    status = gnoi_parallel(context, threads, tiles, job->shares ? "shade" : "paint", work_on_tile, job);
    for (int i = 0; i < threads; i++)
        if (job->workers[i]) {
            if (stats) {
                stats->spans += job->workers[i]->tile.spans;
                stats->shaded += job->workers[i]->tile.shaded;
            }
            painter_free(context, job->workers[i]);
            gnoi_free(context, job->workers[i], 1, sizeof **job->workers);
        }
    gnoi_free(context, job->workers, (size_t)threads, sizeof *job->workers);
    return status;
}

/* The set of pieces, and what it has beside, onto the picture. */
static gno_status job_make(paint_job *job, const gnoi_frame_job *frame, const gno_pieces *pieces)
{
    gno_status status;
    memset(job, 0, sizeof *job);
    job->frame = frame;
    job->seen.pieces = pieces;
    job->beside.pieces = gnoi_pieces_beside(pieces);
    status = gnoi_piece_bins_build(frame->scene, &frame->view, pieces, &job->seen.bins);
    if (!status && job->beside.pieces)
        status = gnoi_piece_bins_build(frame->scene, &frame->view, job->beside.pieces, &job->beside.bins);
    return status;
}

static void job_free(paint_job *job)
{
    gno_context *context = job->frame->scene->context;
    gnoi_piece_bins_free(context, &job->seen.bins);
    gnoi_piece_bins_free(context, &job->beside.bins);
}

gno_status gnoi_paint_visible(gno_scene *scene, gnoi_frame_job *frame, gno_stats *stats)
{
    gno_visible_def def = gno_visible_def_default();
    gno_pieces *pieces = NULL;
    paint_job job;
    gno_status status;
    def.threads = frame->def.threads;
    def.split = GNOI_SPLIT_BESIDE;
    status = gno_visible_pieces(scene, &def, &pieces, NULL);
    if (status)
        return status;
    status = job_make(&job, frame, pieces);
    if (!status)
        status = work_on_tiles(&job, stats);
    job_free(&job);
    gno_pieces_destroy(pieces);
    return status;
}

/* ---- mean colours ----------------------------------------------------------------------------------------------------- */

/* The sums over all tiles by group of pieces, then the mean of each piece. */
static gno_status add_shares(const paint_job *job, double *means)
{
    gno_context *context = job->frame->scene->context;
    const gnoi_piece_bins *bins = &job->seen.bins;
    share *totals = gnoi_calloc(context, bins->piece_count, sizeof *totals);
    if (!totals)
        return GNO_ERROR_MEMORY;
    for (size_t i = 0; i < bins->item_count; i++) {
        share *sum = &totals[bins->pieces[bins->items[i]].group];
        sum->area += job->shares[i].area;
        for (int k = 0; k < 3; k++)
            sum->rgb[k] += job->shares[i].rgb[k];
    }
    for (size_t i = 0; i < bins->piece_count; i++) {
        const share *sum = &totals[bins->pieces[i].group];
        for (size_t k = 0; k < 3; k++)
            means[3 * i + k] = sum->area > 0 ? sum->rgb[k] / sum->area : 0;
    }
    gnoi_free(context, totals, bins->piece_count, sizeof *totals);
    return GNO_OK;
}

gno_status gnoi_paint_means(gnoi_frame_job *frame, const gno_pieces *pieces, double *means)
{
    gno_context *context = frame->scene->context;
    paint_job job;
    gno_status status = job_make(&job, frame, pieces);
    if (!gnoi_shadows_have_edges(frame->scene))
        gnoi_warn(context, "shadows that weaken with distance or fall through the holes of textures are taken as whole ones");
    if (!status) {
        job.shares = gnoi_calloc(context, job.seen.bins.item_count, sizeof *job.shares);
        status = job.shares ? work_on_tiles(&job, NULL) : GNO_ERROR_MEMORY;
    }
    if (!status)
        status = add_shares(&job, means);
    gnoi_free(context, job.shares, job.seen.bins.item_count, sizeof *job.shares);
    job_free(&job);
    return status;
}
