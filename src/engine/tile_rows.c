/* tile_rows.c -- visible pieces of one pixel row into coverage by surface and pixel, split by shadow polygons: see tile.h.
 *
 * The pieces of a surface on all lines of the row are taken together; each lamp's column says whether they are lit, dark,
 * or to be split (gno_span_split). A pixel then gives one sample of the surface, weighted by its coverage, and one more
 * for each lamp that reaches only a part of it, taken in the middle of that part.
 */
#include "base/vector.h"
#include "engine/tile.h"
#include <string.h>

/* Lengths by line are asked for while base lines are judged. */
static void cells_clear(const gnoi_tile *tile, gnoi_cells *cells, int first, int last)
{
    const int lines = tile->judging ? tile->job->def.base_lines : 0;
    size_t size = (size_t)(last - first + 1) * sizeof(float);
    memset(cells->length + first, 0, size);
    memset(cells->mx + first, 0, size);
    memset(cells->my + first, 0, size);
    for (int i = 0; i < lines; i++)
        memset(cells->by_line[i] + first, 0, size);
}

/* Adds [a,b) within one pixel; a, b in pixels from its left side, dy from the row's middle; line: the base line, -1 another. */
static inline void cells_add_part(gnoi_cells *cells, int pixel, float a, float b, float dy, int line)
{
    float length = b - a;
    cells->length[pixel] += length;
    cells->mx[pixel] += length * (0.5f * (a + b) - 0.5f);
    cells->my[pixel] += length * dy;
    if (line >= 0)
        cells->by_line[line][pixel] += length;
}

static void cells_add_parts(gnoi_cells *cells, float x0, float x1, float dy, int line)
{
    const int p0 = (int)x0, p1 = (int)x1;
    cells_add_part(cells, p0, x0 - (float)p0, 1, dy, line);
    for (int p = p0 + 1; p < p1; p++) {
        cells->length[p] += 1;
        cells->my[p] += dy;
    }
    for (int p = p0 + 1; p < p1 && line >= 0; p++)
        cells->by_line[line][p] += 1;
    if (x1 > (float)p1)
        cells_add_part(cells, p1, 0, x1 - (float)p1, dy, line);
}

/* Adds [x0,x1), in pixels from the tile's left side. */
static inline void cells_add(gnoi_cells *cells, float x0, float x1, float dy, int line)
{
    const int p = (int)x0;
    if (p == (int)x1)
        cells_add_part(cells, p, x0 - (float)p, x1 - (float)p, dy, line);
    else
        cells_add_parts(cells, x0, x1, dy, line);
}

/* The light that came through on [x0,x1), by pixel. */
static inline void add_light(float colour[3][GNOI_TILE_W], float x0, float x1, const double light[3])
{
    const int p0 = (int)x0, p1 = (int)x1;
    if (p0 == p1 && p0 < GNOI_TILE_W) {
        for (int k = 0; k < 3; k++)
            colour[k][p0] += (x1 - x0) * (float)light[k];
        return;
    }
    for (int p = p0; p <= p1 && p < GNOI_TILE_W; p++) {
        float a = x0 > (float)p ? x0 : (float)p, b = x1 < (float)(p + 1) ? x1 : (float)(p + 1);
        for (int k = 0; k < 3; k++)
            colour[k][p] += (b - a) * (float)light[k];
    }
}

void gnoi_tile_add_light(float colour[3][GNOI_TILE_W], float x0, float x1, const double light[3]) { add_light(colour, x0, x1, light); }

int gnoi_tile_base_line(const gnoi_tile *tile, int row, uint32_t line)
{
    return row == 0 ? tile->job->def.base_lines - 1 : (int)(line - tile->row_line[row]);
}

/* The base line that a line is while they are made, else -1. */
static int base_line_of(const gnoi_tile *tile, int row, uint32_t line)
{
    return tile->judging ? gnoi_tile_base_line(tile, row, line) : -1;
}

/* How far below the row's middle a line runs, in pixels. */
static float line_offset(const gnoi_tile *tile, int row, uint32_t line)
{
    return (float)(tile->line_y[line] - (tile->y0 + row - 0.5));
}

static inline void add_lit(gnoi_tile *tile, int lamp, const gnoi_piece *piece, float a, float b, const double light[3], float dy, int line)
{
    cells_add(&tile->lit[lamp], a, b, dy, line);
    if (tile->tinted)
        gnoi_tile_add_tinted_light(tile, lamp, piece, a, b, light, line);
    else
        add_light(tile->lit_colour[lamp], a, b, light);
}

void gnoi_tile_add_lit(gnoi_tile *tile, int lamp, const gnoi_piece *piece, float a, float b, const double light[3], float dy, int line)
{
    add_lit(tile, lamp, piece, a, b, light, dy, line);
}

/* How a lamp's shadows split pieces. */
typedef enum way {
    BY_INTERVALS,
    BY_SHEET, /* at contour edges alone */
    SOFTLY    /* its shadows weaken with distance */
} way;

/* Splits one piece by the intervals of its line and adds what is lit. */
static void split_piece(gnoi_tile *tile, int lamp, const gnoi_piece *piece, float dy, int line)
{
    double x0 = tile->x0 + (double)piece->x0 / GNOI_X_ONE, x1 = tile->x0 + (double)piece->x1 / GNOI_X_ONE;
    size_t n = gno_span_split(x0, x1, tile->store.intervals, tile->store.interval_count, tile->parts);
    for (size_t i = 0; i < n; i++) {
        const gno_span_part *part = &tile->parts[i];
        float a = (float)(part->x0 - tile->x0), b = (float)(part->x1 - tile->x0);
        if (b - a < GNOI_LEAK_LENGTH || (!(part->light[0] > 0) && !(part->light[1] > 0) && !(part->light[2] > 0)))
            continue;
        add_lit(tile, lamp, piece, a, b, part->light, dy, line);
    }
}

static inline void add_unshaded(gnoi_tile *tile, int lamp, const gnoi_piece *piece, double x0, double x1, float dy, int line)
{
    static const double all[3] = {1, 1, 1};
    float a = (float)(x0 - tile->x0), b = (float)(x1 - tile->x0);
    if (!(b - a < GNOI_LEAK_LENGTH))
        add_lit(tile, lamp, piece, a, b, all, dy, line);
}

/* The same where contour edges alone begin and end shadows: the parts are those of gno_span_split. */
static void split_by_sheet(gnoi_tile *tile, int lamp, const gnoi_piece *piece, float dy, int line)
{
    const gnoi_crossed *c = &tile->store.crossed;
    double x = tile->x0 + (double)piece->x0 / GNOI_X_ONE, x1 = tile->x0 + (double)piece->x1 / GNOI_X_ONE, begin = -HUGE_VAL;
    int count = c->left;
    for (size_t i = 0; i <= c->count && begin < x1; i++) {
        double end = i < c->count ? c->steps[i].x : HUGE_VAL;
        if (count > 0 && begin < end && end > x) {
            if (begin > x)
                add_unshaded(tile, lamp, piece, x, begin, dy, line);
            x = end;
        }
        begin = end;
        count += i < c->count ? c->steps[i].step : 0;
    }
    if (x < x1)
        add_unshaded(tile, lamp, piece, x, x1, dy, line);
}

int gnoi_tile_intervals(gnoi_tile *tile, const gnoi_slot *slot, gnoi_column *column, int lamp, double y, int32_t xa, int32_t xb)
{
    const gnoi_frame_job *job = tile->job;
    return gnoi_column_intervals(job->scene, &job->view, &job->lamps[lamp], &job->casters[lamp], &slot->receiver, column, y,
                                 tile->x0 + (double)xa / GNOI_X_ONE, tile->x0 + (double)xb / GNOI_X_ONE, &tile->store) &&
           gnoi_reserve(tile->lines.context, (void **)&tile->parts, &tile->part_capacity, 2 * tile->store.interval_count + 1,
                        sizeof *tile->parts);
}

static int cross(gnoi_tile *tile, const gnoi_slot *slot, gnoi_column *column, int lamp, double y, int32_t xa, int32_t xb)
{
    const gnoi_frame_job *job = tile->job;
    return gnoi_column_cross(job->scene, &job->view, &job->lamps[lamp], &job->casters[lamp], &slot->receiver, column, y,
                             tile->x0 + (double)xa / GNOI_X_ONE, tile->x0 + (double)xb / GNOI_X_ONE, &tile->store);
}

/* Splits all pieces of a slot in a row under one lamp. Pieces at one height follow each other and share their intervals. how: a constant at
 * each call. */
static inline void split_row(gnoi_tile *tile, int row, const gnoi_slot *slot, uint32_t chain, gnoi_column *column, int lamp, way how)
{
    const gnoi_piece *pieces = tile->lines.pieces;
    uint32_t p = chain;
    while (p) {
        const double y = tile->line_y[pieces[p].line];
        int32_t xa = pieces[p].x0, xb = pieces[p].x1;
        uint32_t end = p;
        for (; end && tile->line_y[pieces[end].line] == y; end = pieces[end].chain) {
            xa = pieces[end].x0 < xa ? pieces[end].x0 : xa;
            xb = pieces[end].x1 > xb ? pieces[end].x1 : xb;
        }
        if (!(how == BY_SHEET ? cross(tile, slot, column, lamp, y, xa, xb) : gnoi_tile_intervals(tile, slot, column, lamp, y, xa, xb)) ||
            gnoi_stopped_at(tile->lines.context, tile->steps++)) {
            tile->failed = 1;
            return;
        }
        for (; p != end; p = pieces[p].chain) {
            float dy = line_offset(tile, row, pieces[p].line);
            int line = base_line_of(tile, row, pieces[p].line);
            if (how == SOFTLY)
                gnoi_tile_split_soft(tile, lamp, slot, &pieces[p], dy, line);
            else if (how == BY_SHEET)
                split_by_sheet(tile, lamp, &pieces[p], dy, line);
            else
                split_piece(tile, lamp, &pieces[p], dy, line);
        }
    }
}

static void split_pieces(gnoi_tile *tile, int row, const gnoi_slot *slot, uint32_t chain, gnoi_column *column, int lamp)
{
    const gnoi_lamp *l = &tile->job->lamps[lamp];
    if (l->softness > 0)
        split_row(tile, row, slot, chain, column, lamp, SOFTLY);
    else if (gnoi_column_is_sheet(l, column))
        split_row(tile, row, slot, chain, column, lamp, BY_SHEET);
    else
        split_row(tile, row, slot, chain, column, lamp, BY_INTERVALS);
}

static void clear_lamp(gnoi_tile *tile, int lamp, int first, int last)
{
    cells_clear(tile, &tile->lit[lamp], first, last);
    for (int k = 0; k < 3; k++)
        memset(tile->lit_colour[lamp][k] + first, 0, (size_t)(last - first + 1) * sizeof(float));
    if (tile->tinted && tile->judging)
        gnoi_tinted_lines_clear(&tile->lit_veil[lamp], first, last);
}

int gnoi_tile_reaches_all(const gnoi_tile *tile, int lamp, int pixel, float cover, const float all[3])
{
    int whole = tile->lit[lamp].length[pixel] > cover * 0.999999f;
    for (int k = 0; k < 3; k++)
        whole &= tile->lit_colour[lamp][k][pixel] > all[k] * 0.999999f;
    return whole;
}

/* The sample of the part of a surface that a lamp alone reaches in a pixel. */
static void sample_lit(gnoi_tile *tile, gnoi_slot *slot, int row, int pixel, int lamp)
{
    const gnoi_cells *lit = &tile->lit[lamp];
    float length = lit->length[pixel], tint[3], *weight = tile->batch.weight + tile->batch.count;
    for (int k = 0; k < 3; k++)
        tint[k] = tile->lit_colour[lamp][k][pixel] / length;
    for (int k = 0; k < tile->job->lamp_count; k++)
        weight[(size_t)k * GNOI_BATCH] = 0;
    weight[(size_t)lamp * GNOI_BATCH] = length;
    tile->lit_lamp = lamp;
    gnoi_tile_sample(tile, slot, row, pixel, lit, tint);
}

void gnoi_tile_sample_pixel(gnoi_tile *tile, gnoi_slot *slot, const gnoi_column *columns, int row, int pixel)
{
    int lamps = tile->job->lamp_count;
    float cover = tile->cells.length[pixel], *weight, all[3] = {cover, cover, cover};
    unsigned parts = 0;
    gnoi_tile_keep_order(tile, slot, row, pixel);
    weight = tile->batch.weight + tile->batch.count;
    for (int k = 0; k < 3 && tile->veiled; k++)
        all[k] = tile->veil.sum[k][pixel];
    for (int j = 0; j < lamps; j++) {
        float w = columns[j].state == GNOI_COLUMN_LIT ? cover : 0;
        if (columns[j].state == GNOI_COLUMN_SPLIT) {
            int whole = gnoi_tile_reaches_all(tile, j, pixel, cover, all);
            w = whole ? cover : 0;
            parts += !whole && tile->lit[j].length[pixel] > 0;
        }
        weight[(size_t)j * GNOI_BATCH] = w;
    }
    gnoi_tile_sample(tile, slot, row, pixel, &tile->cells, NULL);
    for (int j = 0; j < lamps && parts; j++)
        if (columns[j].state == GNOI_COLUMN_SPLIT && tile->lit[j].length[pixel] > 0 && !gnoi_tile_reaches_all(tile, j, pixel, cover, all)) {
            sample_lit(tile, slot, row, pixel, j);
            parts--;
        }
}

static void sample_pixels(gnoi_tile *tile, gnoi_slot *slot, const gnoi_column *columns, int row, int first, int last)
{
    for (int pixel = first; pixel <= last && tile->job->layers; pixel++)
        if (tile->cells.length[pixel] > 0)
            gnoi_tile_layers_keep(tile, (uint32_t)(slot - tile->slots), columns, row, pixel);
    if (tile->fragments.alone || tile->failed || gnoi_tile_sample_run(tile, slot, columns, row, first, last))
        return;
    for (int pixel = first; pixel <= last && !tile->failed; pixel++)
        if (tile->cells.length[pixel] > 0)
            gnoi_tile_sample_pixel(tile, slot, columns, row, pixel);
}

/* What the slot at hand covers, for the background behind what is not opaque. */
static void add_row_cover(gnoi_tile *tile, int first, int last)
{
    for (int pixel = first; pixel <= last; pixel++)
        tile->row_cover[pixel] += tile->cells.length[pixel];
    for (int i = 0; i < tile->job->def.base_lines && tile->judging; i++)
        for (int pixel = first; pixel <= last; pixel++)
            tile->row_by_line[i][pixel] += tile->cells.by_line[i][pixel];
}

static void row_of_slot(gnoi_tile *tile, int row, gnoi_slot *slot, uint32_t chain)
{
    const gnoi_piece *pieces = tile->lines.pieces;
    int lamps = tile->job->lamp_count, first = GNOI_TILE_W - 1, last = 0;
    const gnoi_column *columns;
    for (uint32_t p = chain; p; p = pieces[p].chain) {
        int a = pieces[p].x0 / GNOI_X_ONE, b = (pieces[p].x1 - 1) / GNOI_X_ONE;
        first = a < first ? a : first;
        last = b > last ? b : last;
    }
    columns = &tile->columns[slot->first_column];
    cells_clear(tile, &tile->cells, first, last);
    for (int j = 0; j < lamps; j++)
        if (columns[j].state == GNOI_COLUMN_SPLIT)
            clear_lamp(tile, j, first, last);
    for (uint32_t p = chain; p; p = pieces[p].chain)
        cells_add(&tile->cells, (float)pieces[p].x0 / GNOI_X_ONE, (float)pieces[p].x1 / GNOI_X_ONE, line_offset(tile, row, pieces[p].line),
                  base_line_of(tile, row, pieces[p].line));
    if (tile->veiled)
        gnoi_tile_veil(tile, row, chain, first, last);
    for (int j = 0; j < lamps && !tile->failed; j++)
        if (columns[j].state == GNOI_COLUMN_SPLIT)
            split_pieces(tile, row, slot, chain, &tile->columns[slot->first_column + (uint32_t)j], j);
    if (tile->veiled)
        add_row_cover(tile, first, last);
    if (!tile->failed)
        sample_pixels(tile, slot, columns, row, first, last);
    if (tile->veiled && !slot->receiver.poly->opaque)
        gnoi_tile_uncover(tile, first, last);
}

/* A piece of a small surface to the specks of its pixels. */
static void speckle(gnoi_tile *tile, int row, const gnoi_piece *piece, float dy, int line)
{
    gnoi_specks *s = &tile->specks;
    gnoi_brief *brief = &tile->briefs[piece->slot];
    for (int32_t x = piece->x0; x < piece->x1;) {
        int32_t left = x & ~(GNOI_X_ONE - 1), end = left + GNOI_X_ONE < piece->x1 ? left + GNOI_X_ONE : piece->x1;
        if (s->count == GNOI_SPECKS)
            gnoi_tile_sample_specks(tile, row);
        gnoi_speck_add(s, gnoi_specks_seek(s, brief, piece->slot, x / GNOI_X_ONE), x - left, end - left, dy, line);
        x = end;
    }
}

/* The pieces of a line to specks, those of larger surfaces into chains. */
static size_t part_line(gnoi_tile *tile, int row, uint32_t line, size_t count)
{
    const float dy = line_offset(tile, row, line);
    const int base = base_line_of(tile, row, line), may_speckle = !tile->veiled && !tile->tinted && !tile->job->textured;
    size_t spans = 0;
    for (uint32_t p = tile->lines.lines[line].first; p; p = tile->lines.pieces[p].next) {
        gnoi_piece *piece = &tile->lines.pieces[p];
        gnoi_brief *brief = &tile->briefs[piece->slot];
        spans++;
        if (brief->speckled && may_speckle) {
            speckle(tile, row, piece, dy, base);
            continue;
        }
        if (brief->chain == 0)
            tile->touched[count++] = piece->slot;
        piece->chain = brief->chain;
        brief->chain = p;
    }
    tile->spans += (double)spans;
    return count;
}

/* Parts the row's pieces into specks and chains by slot; returns how many chains. Lines at one height follow each other, whatever strips they
 * are of: they meet the same shadows. */
static size_t part_pieces(gnoi_tile *tile, int row)
{
    const gnoi_strip *strips = tile->strips + tile->row_strip[row];
    const int count = tile->row_strip_end[row] - tile->row_strip[row];
    uint32_t line = tile->row_line[row], next[GNOI_TILE_W];
    size_t chains = 0;
    if (count == 1) {
        for (; line < tile->row_line[row + 1]; line++)
            chains = part_line(tile, row, line, chains);
        return chains;
    }
    for (int s = 0; s < count; s++)
        next[s] = strips[s].first;
    for (double y = -HUGE_VAL, higher; y < HUGE_VAL; y = higher) {
        higher = HUGE_VAL;
        for (int s = 0; s < count; s++) {
            const uint32_t end = strips[s].first + strips[s].count;
            if (next[s] < end && tile->lines.lines[next[s]].y == y)
                chains = part_line(tile, row, next[s]++, chains);
            if (next[s] < end && tile->lines.lines[next[s]].y < higher)
                higher = tile->lines.lines[next[s]].y;
        }
    }
    return chains;
}

/* ---- background ------------------------------------------------------------------------------------------------------- */

VECTOR_CLONES static void add_times(float *restrict to, const float *restrict share, int count, float value)
{
    for (int p = 0; p < count; p++)
        to[p] += share[p] * value;
}

/* How much of each pixel a line leaves free: exact, for lengths are multiples of 2^-16. */
static void find_gaps(const gnoi_tile *tile, const gnoi_line *line, float *gaps)
{
    uint32_t next = line->first;
    int32_t x = line->xa;
    while (x < line->xb) {
        const gnoi_piece *piece = next ? &tile->lines.pieces[next] : NULL;
        int32_t to = piece ? piece->x0 : line->xb;
        while (x < to) {
            int32_t end = (x | (GNOI_X_ONE - 1)) + 1 < to ? (x | (GNOI_X_ONE - 1)) + 1 : to;
            gaps[x / GNOI_X_ONE] += (float)(end - x) / GNOI_X_ONE;
            x = end;
        }
        x = piece ? piece->x1 : line->xb;
        next = piece ? piece->next : 0;
    }
}

/* Counts the row's lines over each pixel. */
static void add_weights(gnoi_tile *tile, int row)
{
    const uint32_t row_first = tile->row_line[row], row_end = tile->row_line[row + 1];
    float *weight = &tile->weight[row * GNOI_TILE_W];
    for (int s = tile->row_strip[row]; s < tile->row_strip_end[row]; s++) {
        const gnoi_strip *strip = &tile->strips[s];
        const uint32_t first = strip->first > row_first ? strip->first : row_first;
        const uint32_t end = strip->first + strip->count < row_end ? strip->first + strip->count : row_end;
        for (int p = (int)strip->xa; p < (int)strip->xb; p++)
            weight[p] += (float)(end - first);
    }
}

/* What the row's lines leave free shows the background. */
static void add_background(gnoi_tile *tile, int row)
{
    const double *background = tile->job->scene->image.background;
    float rest[GNOI_TILE_W] = {0};
    const int index = row * GNOI_TILE_W;
    int open = 0;
    if (tile->veiled) {
        gnoi_tile_veiled_background(tile, row);
        return;
    }
    add_weights(tile, row);
    for (uint32_t line = tile->row_line[row]; line < tile->row_line[row + 1]; line++) {
        const gnoi_line *l = &tile->lines.lines[line];
        const int first = l->xa / GNOI_X_ONE, end = l->xb / GNOI_X_ONE;
        float gaps[GNOI_TILE_W];
        if (l->uncovered == 0)
            continue;
        open = 1;
        memset(gaps, 0, sizeof gaps);
        find_gaps(tile, l, gaps);
        for (int p = first; p < end; p++)
            rest[p] += gaps[p];
        for (int k = 0; k < 3 && tile->judging; k++)
            add_times(tile->line_acc[gnoi_tile_base_line(tile, row, line)][k] + index + first, gaps + first, end - first, (float)background[k]);
    }
    for (int k = 0; k < 3 && open; k++)
        add_times(&tile->acc[k][index], rest, tile->width, (float)background[k]);
}

/* What of a pixel each of the lines being made stands for. */
static void set_shares(gnoi_tile *tile, int row)
{
    for (int x = 0; x < GNOI_TILE_W; x++)
        tile->pixel_share[x] = 1 / (float)tile->job->def.base_lines;
    for (int s = tile->row_strip[row]; s < tile->row_strip_end[row]; s++) {
        const gnoi_strip *strip = &tile->strips[s];
        for (int x = (int)strip->xa; x < (int)strip->xb && strip->absent > 0; x++)
            tile->pixel_share[x] = 1 / (float)strip->count;
    }
}

void gnoi_tile_row(gnoi_tile *tile, int row)
{
    size_t count;
    if (tile->row_line[row] == tile->row_line[row + 1])
        return;
    if (!gnoi_reserve(tile->lines.context, (void **)&tile->touched, &tile->touched_capacity, tile->slot_count, sizeof *tile->touched) ||
        (tile->tinted && !gnoi_tile_veil_ready(tile))) {
        tile->failed = 1;
        return;
    }
    set_shares(tile, row);
    tile->specks.lines = tile->judging ? tile->job->def.base_lines : 0;
    count = part_pieces(tile, row);
    if (tile->veiled) {
        memset(tile->row_cover, 0, sizeof tile->row_cover);
        memset(tile->row_by_line, 0, sizeof tile->row_by_line);
    }
    for (size_t i = 0; i < count; i++) {
        gnoi_brief *brief = &tile->briefs[tile->touched[i]];
        if (!tile->failed)
            row_of_slot(tile, row, &tile->slots[tile->touched[i]], brief->chain);
        tile->failed |= i % 64 == 63 && gnoi_stopped(tile->lines.context);
        brief->chain = 0;
    }
    if (tile->specks.count > 0)
        gnoi_tile_sample_specks(tile, row);
    add_background(tile, row);
}
