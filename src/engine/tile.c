/* tile.c -- one tile: base lines everywhere, more lines where the picture varies: see tile.h. */
#include "base/vector.h"
#include "engine/tile.h"
#include <math.h>
#include <string.h>

int gnoi_tile_init(gnoi_tile *tile, const gnoi_frame_job *job)
{
    gno_context *context = job->scene->context;
    size_t lamps = (size_t)job->lamp_count;
    memset(tile, 0, sizeof *tile);
    tile->job = job;
    tile->lines.context = tile->stacks.context = tile->store.context = tile->outline.context = context;
    tile->lit = gnoi_calloc(context, lamps, sizeof *tile->lit);
    tile->lit_colour = gnoi_calloc(context, lamps, sizeof *tile->lit_colour);
    tile->batch.weight = gnoi_calloc(context, lamps * GNOI_BATCH, sizeof *tile->batch.weight);
    tile->batch.lamp_count = job->lamp_count;
    tile->batch.smooth_terminator = job->def.terminator == GNO_TERMINATOR_SMOOTH;
    tile->batch.view_start = job->bins.nearest_depth;
    return tile->lit && tile->lit_colour && tile->batch.weight && gnoi_tile_layers_init(tile);
}

void gnoi_tile_free(gnoi_tile *tile)
{
    gno_context *context = tile->lines.context;
    size_t lamps;
    if (!tile->job)
        return;
    lamps = (size_t)tile->job->lamp_count;
    gnoi_lines_free(&tile->lines);
    gnoi_stacks_free(&tile->stacks);
    gnoi_columns_free(&tile->store);
    gnoi_outline_free(&tile->outline);
    gnoi_free(context, tile->order, tile->order_capacity, sizeof *tile->order);
    gnoi_free(context, tile->order_scratch, tile->order_scratch_capacity, sizeof *tile->order_scratch);
    gnoi_free(context, tile->items, tile->item_capacity, sizeof *tile->items);
    gnoi_free(context, tile->slots, tile->slot_capacity, sizeof *tile->slots);
    gnoi_free(context, tile->briefs, tile->brief_capacity, sizeof *tile->briefs);
    gnoi_free(context, tile->facets, tile->facet_capacity, sizeof *tile->facets);
    gnoi_free(context, tile->arrives, tile->arrive_capacity, sizeof *tile->arrives);
    gnoi_free(context, tile->edges, tile->edge_capacity, sizeof *tile->edges);
    gnoi_free(context, tile->line_y, tile->line_y_capacity, sizeof *tile->line_y);
    gnoi_free(context, tile->bar, tile->bar_capacity, sizeof *tile->bar);
    gnoi_free(context, tile->crossings, tile->crossing_capacity, sizeof *tile->crossings);
    gnoi_free(context, tile->touched, tile->touched_capacity, sizeof *tile->touched);
    gnoi_free(context, tile->columns, tile->column_capacity, sizeof *tile->columns);
    gnoi_free(context, tile->parts, tile->part_capacity, sizeof *tile->parts);
    gnoi_free(context, tile->intensities, tile->intensity_capacity, sizeof *tile->intensities);
    gnoi_tile_layers_free(tile);
    gnoi_free(context, tile->texels, GNOI_TEXELS, sizeof *tile->texels);
    gnoi_free(context, tile->mappings, tile->mapping_capacity, sizeof *tile->mappings);
    gnoi_free(context, tile->lit, lamps, sizeof *tile->lit);
    gnoi_free(context, tile->lit_colour, lamps, sizeof *tile->lit_colour);
    gnoi_free(context, tile->lit_veil, lamps, sizeof *tile->lit_veil);
    gnoi_free(context, tile->batch.weight, lamps * GNOI_BATCH, sizeof *tile->batch.weight);
}

void gnoi_tile_start(gnoi_tile *tile, size_t index)
{
    const gnoi_frame_job *job = tile->job;
    int tx = (int)(index % (size_t)job->bins.tiles_x), ty = (int)(index / (size_t)job->bins.tiles_x);
    tile->x0 = tx * GNOI_TILE_W;
    tile->y0 = ty * GNOI_TILE_H;
    tile->width = job->view.width - tile->x0 < GNOI_TILE_W ? job->view.width - tile->x0 : GNOI_TILE_W;
    tile->height = job->view.height - tile->y0 < GNOI_TILE_H ? job->view.height - tile->y0 : GNOI_TILE_H;
    tile->rect = gnoi_tile_rect(&job->view, tx, ty);
    tile->slot_count = tile->column_count = tile->intensity_count = tile->mapping_count = 0;
    gnoi_tile_forget_texels(tile);
    gnoi_columns_reset(&tile->store);
    tile->specks.first = 1;
    tile->specks.count = 0;
    memset(tile->acc, 0, sizeof tile->acc);
    memset(tile->weight, 0, sizeof tile->weight);
    for (int i = 0; i < job->def.base_lines && i < GNOI_BASE_LINES; i++)
        memset(tile->line_acc[i], 0, sizeof tile->line_acc[i]);
    memset(tile->thin, 0, sizeof tile->thin);
    tile->was_veiled = 0;
    if (job->layers)
        gnoi_tile_layers_start(tile);
}

/* The strip of the lines from `first` on, all between pixels xa and xb. */
static void add_strip(gnoi_tile *tile, uint32_t first, int xa, int xb, int per_row, int absent)
{
    gnoi_strip *s = &tile->strips[tile->strip_count++];
    s->first = first;
    s->count = (uint32_t)tile->lines.line_count - first;
    s->xa = (float)xa;
    s->xb = (float)xb;
    s->y = (float)(tile->lines.lines[first].y - tile->y0);
    s->per_row = (float)per_row;
    s->absent = (uint32_t)absent;
}

/* Lines y = (i + 1/2) / base in every row; the rows of the apron have only the one next to the tile. */
static void add_base_lines(gnoi_tile *tile)
{
    int base = tile->job->def.base_lines, rows = tile->height + 2, refine = tile->job->def.lines > base;
    gnoi_lines_reset(&tile->lines);
    for (int row = 0; row < rows; row++) {
        int apron = row == 0 || row == rows - 1;
        tile->row_line[row] = (uint32_t)tile->lines.line_count;
        tile->row_strip[row] = 0;
        tile->row_strip_end[row] = 1;
        if (apron && !refine)
            continue;
        for (int i = 0; i < base; i++)
            if (!apron || (row == 0 ? i == base - 1 : i == 0))
                gnoi_lines_add(&tile->lines, tile->y0 + row - 1 + (i + 0.5) / base, 0, tile->width * GNOI_X_ONE);
    }
    tile->row_line[rows] = (uint32_t)tile->lines.line_count;
    tile->strip_count = 0;
    if (!tile->lines.failed)
        add_strip(tile, 0, 0, tile->width, base, 0);
}

/* The largest bend, from three lines to the next, of one channel's values a, b, c of three lines. */
VECTOR_CLONES static void add_bends(const float *restrict a, const float *restrict b, const float *restrict c, float *restrict largest)
{
    for (int x = 0; x < GNOI_TILE_W; x++) {
        float bend = fabsf(a[x] - 2 * b[x] + c[x]);
        largest[x] = bend > largest[x] ? bend : largest[x];
    }
}

/* How many lines a pixel has, and how many it is to have, an odd multiple; `to` is 0 for no more. */
typedef struct need {
    int from, to;
} need;

/* Up to so many times the bend that calls for more lines, the middle number of them is enough. */
#define MIDDLE_BEND 3

/* A number of lines between the base lines and all, of which either is an odd multiple; or all where there is none. */
static int middle_lines(const gno_render_def *def)
{
    int factor = def->lines / def->base_lines;
    for (int d = 3; d < factor; d += 2)
        if (factor % d == 0)
            return def->base_lines * d;
    return def->lines;
}

/* Marks the pixels of a row whose colour bends from line to line by more than the def allows: where it changes evenly the lines'
 * mean is right already. The lines next to the pixel's own, above and below, take part. Returns how many. */
static int mark_row(const gnoi_tile *tile, int row, need needs[GNOI_TILE_W])
{
    int n = tile->job->def.base_lines, i = row * GNOI_TILE_W, middle = middle_lines(&tile->job->def);
    int count = 0;
    float limit = (float)tile->job->def.refine_above, largest[GNOI_TILE_W] = {0};
    for (int k = 0; k < 3; k++) {
        const float *a = &tile->line_acc[n - 1][k][i - GNOI_TILE_W], *b = &tile->line_acc[0][k][i];
        for (int l = 1; l <= n; l++) {
            const float *c = l < n ? &tile->line_acc[l][k][i] : &tile->line_acc[0][k][i + GNOI_TILE_W];
            add_bends(a, b, c, largest);
            a = b;
            b = c;
        }
    }
    for (int x = 0; x < tile->width; x++) {
        needs[x].from = n;
        needs[x].to = tile->thin[i + x] || largest[x] > MIDDLE_BEND * limit ? tile->job->def.lines : largest[x] > limit ? middle : 0;
        count += needs[x].to > 0;
    }
    return count;
}

/* Where more than this share of a tile bends, it is full of things as small as the lines are apart, and those that lie between two base
 * lines are many: then all its pixels get all lines. */
#define CROWDED 0.4

static void mark_bends(const gnoi_tile *tile, need needs[][GNOI_TILE_W])
{
    int count = 0;
    for (int row = 1; row <= tile->height; row++)
        count += mark_row(tile, row, needs[row]);
    if (count <= CROWDED * tile->width * tile->height)
        return;
    for (int row = 1; row <= tile->height; row++)
        for (int x = 0; x < tile->width; x++)
            needs[row][x].to = tile->job->def.lines;
}

static void mark_for_layers(const gnoi_tile *tile, need needs[][GNOI_TILE_W])
{
    for (int row = 1; row <= tile->height; row++)
        for (int x = 0; x < tile->width; x++) {
            needs[row][x].from = (int)tile->weight[row * GNOI_TILE_W + x];
            needs[row][x].to = gnoi_tile_layers_need(tile, row * GNOI_TILE_W + x) ? tile->job->def.lines : 0;
        }
}

/* Marks which pixels need more lines, in rows 1 to the tile's height. */
typedef void (*mark_needs)(const gnoi_tile *tile, need needs[][GNOI_TILE_W]);

/* Neighbouring pixels that get the same lines. */
typedef struct run {
    int first, last;
    need need;
} run;

/* Runs of pixels of a row that need more lines; returns how many. */
static int find_runs(const gnoi_tile *tile, const need needs[GNOI_TILE_W], run runs[GNOI_TILE_W])
{
    int n = 0;
    for (int x = 0; x < tile->width; x++) {
        if (!needs[x].to)
            continue;
        if (n == 0 || x - runs[n - 1].last > 1 || runs[n - 1].need.from != needs[x].from) {
            runs[n].first = x;
            runs[n++].need = needs[x];
        }
        runs[n - 1].last = x;
        runs[n - 1].need.to = needs[x].to > runs[n - 1].need.to ? needs[x].to : runs[n - 1].need.to;
    }
    return n;
}

/* The lines between those there are over the row's runs, run after run. */
static void add_fine_lines(gnoi_tile *tile, int row, const run *runs, int run_count)
{
    for (int k = 0; k < run_count && !tile->lines.failed; k++) {
        uint32_t first = (uint32_t)tile->lines.line_count;
        int count = runs[k].need.to, factor = count / runs[k].need.from;
        for (int i = 0; i < count; i++)
            if (i % factor != factor / 2)
                gnoi_lines_add(&tile->lines, tile->y0 + row - 1 + (i + 0.5) / count, runs[k].first * GNOI_X_ONE, (runs[k].last + 1) * GNOI_X_ONE);
        if (!tile->lines.failed)
            add_strip(tile, first, runs[k].first, runs[k].last + 1, count, runs[k].need.from);
        if (!tile->fragments.alone)
            tile->refined += runs[k].last - runs[k].first + 1;
    }
}

/* Adds lines where they are needed; returns 0 when they are nowhere. */
static int plan_refinement(gnoi_tile *tile, mark_needs mark)
{
    need needs[GNOI_TILE_H + 1][GNOI_TILE_W];
    mark(tile, needs);
    gnoi_lines_reset(&tile->lines);
    tile->strip_count = 0;
    for (int row = 0; row < tile->height + 2; row++) {
        run runs[GNOI_TILE_W];
        tile->row_line[row] = (uint32_t)tile->lines.line_count;
        tile->row_strip[row] = tile->strip_count;
        if (row > 0 && row <= tile->height)
            add_fine_lines(tile, row, runs, find_runs(tile, needs[row], runs));
        tile->row_strip_end[row] = tile->strip_count;
    }
    tile->row_line[tile->height + 2] = (uint32_t)tile->lines.line_count;
    return tile->lines.line_count > 0;
}

VECTOR_CLONES static void divide(const float *restrict sum, const float *restrict weight, float *restrict mean)
{
    for (int x = 0; x < GNOI_TILE_W; x++)
        mean[x] = sum[x] / weight[x];
}

void gnoi_tile_write(const gnoi_tile *tile)
{
    const gnoi_frame_job *job = tile->job;
    float weight[GNOI_TILE_W], mean[3][GNOI_TILE_W];
    for (int x = 0; x < GNOI_TILE_W; x++)
        weight[x] = 1; /* beyond the tile's width nothing is weighed */
    for (int y = 0; y < tile->height; y++) {
        float *out = job->rgb + 3 * ((size_t)(tile->y0 + y - job->first_row) * (size_t)job->view.width + (size_t)tile->x0);
        const int i = (y + 1) * GNOI_TILE_W;
        memcpy(weight, tile->weight + i, (size_t)tile->width * sizeof *weight);
        for (int k = 0; k < 3; k++)
            divide(tile->acc[k] + i, weight, mean[k]);
        for (int x = 0; x < tile->width; x++)
            for (int k = 0; k < 3; k++)
                *out++ = mean[k][x];
    }
}

static void make_rows(gnoi_tile *tile)
{
    if (!tile->failed)
        gnoi_tile_light(tile);
    for (int row = 0; row < tile->height + 2 && !tile->failed; row++)
        gnoi_tile_row(tile, row);
    gnoi_tile_flush(tile);
}

/* Where the colour called for no more lines, or not for all, the layers still may; the picture, which is written already, stays as it is. */
static void make_layers(gnoi_tile *tile, size_t count)
{
    tile->fragments.alone = 1;
    if (tile->job->def.lines > tile->job->def.base_lines && plan_refinement(tile, mark_for_layers)) {
        gnoi_tile_draw(tile, count);
        make_rows(tile);
    }
    tile->fragments.alone = 0;
    if (!tile->failed)
        gnoi_tile_layers_write(tile);
}

int gnoi_tile_lay(gnoi_tile *tile, size_t index)
{
    const gnoi_frame_job *job = tile->job;
    const gnoi_keyed *items = job->bins.items + job->bins.start[index];
    size_t count = job->bins.start[index + 1] - job->bins.start[index];
    gnoi_tile_start(tile, index);
    gnoi_tile_sort(tile, items, count);
    if (tile->failed)
        return 0;
    add_base_lines(tile);
    gnoi_tile_draw(tile, count);
    if (!tile->failed)
        gnoi_tile_light(tile);
    return !tile->failed && !tile->lines.failed;
}

int gnoi_tile_render(gnoi_tile *tile, size_t index)
{
    const gnoi_frame_job *job = tile->job;
    const gnoi_keyed *items = job->bins.items + job->bins.start[index];
    size_t count = job->bins.start[index + 1] - job->bins.start[index];
    gnoi_tile_start(tile, index);
    gnoi_tile_sort(tile, items, count);
    if (tile->failed)
        return 0;
    tile->judging = job->def.lines > job->def.base_lines;
    add_base_lines(tile);
    gnoi_tile_draw(tile, count);
    make_rows(tile);
    tile->judging = 0;
    if (job->def.lines > job->def.base_lines && !tile->failed && plan_refinement(tile, mark_bends)) {
        gnoi_tile_draw(tile, count);
        make_rows(tile);
    }
    gnoi_tile_write(tile);
    if (job->layers && !tile->failed)
        make_layers(tile, count);
    return !tile->failed && !tile->lines.failed;
}
