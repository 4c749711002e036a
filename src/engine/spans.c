/* spans.c -- gno_render_spans: the visible spans of every sample line, split by the lights' shadow polygons.
 *
 * Place in the data flow: a tile's pieces and columns (tile.h) -> its record, kept until the band of tiles is done -> spans
 * joined across the borders of tiles, line by line -> the caller. Tiles are recorded on any thread; joining and handing out
 * run on the caller's.
 * Invariants: a record's spans are grouped by line and sorted by where they begin, front to back; the parts of a span and a
 * light leave no gap, and neighbours differ in light.
 */
#include "base/parallel.h"
#include "engine/bands.h"
#include <string.h>

/* One span of a tile; its parts begin at starts[start + lamp] of the record. */
typedef struct bit {
    uint32_t polygon, line;
    int back;
    int32_t xa, xb; /* as gnoi_piece */
    double depth0, depth1;
    float tint[3];
    size_t start;
    uint32_t next;   /* while a line is joined: the same surface in the next tile, GNOI_NONE: none */
} bit;

/* What a tile leaves. */
typedef struct record {
    size_t bit_count, bit_capacity;
    bit *bits;
    size_t line_capacity;
    uint32_t *line_start; /* lines + 1 offsets into bits */
    size_t start_count, start_capacity;
    size_t *starts;
    size_t part_count, part_capacity;
    gno_span_part *parts;
} record;

typedef struct spans {
    gno_context *context;
    gno_spans_fn take;
    void *user;
    size_t record_count;
    record *records; /* one for each tile of a band */
    size_t span_capacity;
    gno_span *spans; /* of the line at hand */
    size_t root_capacity;
    struct root { uint32_t tile, bit; } *roots; /* where each span of the line at hand begins */
    size_t start_capacity;
    size_t *starts;
    size_t part_capacity;
    gno_span_part *parts;
} spans;

/* ---- one tile, on any thread -------------------------------------------------------------------------------------- */

/* Appends a part of one span and light. Slivers, which rounding leaves where a caster touches its receiver, go to a neighbour. */
static int add_part(gno_context *context, record *r, size_t first, const gno_span_part *part)
{
    gno_span_part *last = r->part_count > first ? &r->parts[r->part_count - 1] : NULL;
    double least = (double)GNOI_LEAK_LENGTH;
    if (last && (part->x1 - part->x0 < least || memcmp(last->light, part->light, sizeof last->light) == 0)) {
        last->x1 = part->x1;
        return 1;
    }
    if (last && last->x1 - last->x0 < least) { /* the span's first */
        memcpy(last->light, part->light, sizeof last->light);
        last->x1 = part->x1;
        return 1;
    }
    if (!gnoi_reserve(context, (void **)&r->parts, &r->part_capacity, r->part_count + 1, sizeof *r->parts))
        return 0;
    r->parts[r->part_count++] = *part;
    return 1;
}

/* The parts of one piece under one lamp. */
static int add_parts(gnoi_tile *tile, record *r, const gnoi_piece *piece, int lamp)
{
    gnoi_slot *slot = &tile->slots[piece->slot];
    gnoi_column *column = &tile->columns[slot->first_column + (uint32_t)lamp];
    gno_context *context = tile->lines.context;
    double lit = column->state == GNOI_COLUMN_LIT;
    gno_span_part whole = {tile->x0 + (double)piece->x0 / GNOI_X_ONE, tile->x0 + (double)piece->x1 / GNOI_X_ONE, {0, 0, 0}};
    size_t first = r->part_count, n;
    whole.light[0] = whole.light[1] = whole.light[2] = lit;
    if (column->state != GNOI_COLUMN_SPLIT)
        return gnoi_reserve(context, (void **)&r->parts, &r->part_capacity, r->part_count + 1, sizeof *r->parts) &&
               (r->parts[r->part_count++] = whole, 1);
    if (!gnoi_tile_intervals(tile, slot, column, lamp, tile->lines.lines[piece->line].y, piece->x0, piece->x1))
        return 0;
    n = gno_span_split(whole.x0, whole.x1, tile->store.intervals, tile->store.interval_count, tile->parts);
    for (size_t i = 0; i < n; i++)
        if (!add_part(context, r, first, &tile->parts[i]))
            return 0;
    return 1;
}

static double depth_at(const gnoi_tile *tile, const gnoi_slot *slot, double x, double y)
{
    double z = gnoi_plane_at(&slot->receiver.nearness, x, y);
    return tile->job->view.orthographic ? -z : 1 / z;
}

static int add_bit(gnoi_tile *tile, record *r, uint32_t p)
{
    gno_context *context = tile->lines.context;
    const gnoi_piece *piece = &tile->lines.pieces[p];
    const gnoi_slot *slot = &tile->slots[piece->slot];
    size_t lamps = (size_t)tile->job->lamp_count;
    double y = tile->lines.lines[piece->line].y;
    bit *b;
    if (!gnoi_reserve(context, (void **)&r->bits, &r->bit_capacity, r->bit_count + 1, sizeof *r->bits) ||
        !gnoi_reserve(context, (void **)&r->starts, &r->start_capacity, r->start_count + lamps + 1, sizeof *r->starts))
        return 0;
    b = &r->bits[r->bit_count++];
    b->polygon = slot->receiver.poly->source;
    b->line = piece->line;
    b->back = slot->receiver.side < 0;
    b->xa = piece->x0;
    b->xb = piece->x1;
    b->depth0 = depth_at(tile, slot, tile->x0 + (double)piece->x0 / GNOI_X_ONE, y);
    b->depth1 = depth_at(tile, slot, tile->x0 + (double)piece->x1 / GNOI_X_ONE, y);
    for (int k = 0; k < 3; k++)
        b->tint[k] = tile->veiled ? tile->stacks.tints[p].rgb[k] : 1;
    b->start = r->start_count;
    b->next = GNOI_NONE;
    for (size_t j = 0; j < lamps; j++) {
        r->starts[r->start_count++] = r->part_count;
        if (!add_parts(tile, r, &tile->lines.pieces[p], (int)j))
            return 0;
    }
    r->starts[r->start_count++] = r->part_count;
    return 1;
}

/* By where they begin, front to back there: pieces come nearly so, see-through ones before the opaque ones of their line. */
static void sort_bits(bit *bits, size_t count)
{
    for (size_t i = 1; i < count; i++) {
        bit b = bits[i];
        size_t k = i;
        for (; k > 0 && (bits[k - 1].xa > b.xa || (bits[k - 1].xa == b.xa && bits[k - 1].depth0 > b.depth0)); k--)
            bits[k] = bits[k - 1];
        bits[k] = b;
    }
}

static int make_record(void *user, gnoi_tile *tile, size_t index)
{
    const spans *s = user;
    const gnoi_frame_job *job = tile->job;
    size_t before = (size_t)(job->first_row / GNOI_TILE_H) * (size_t)job->bins.tiles_x;
    record *r = &s->records[index - before];
    r->bit_count = r->start_count = r->part_count = 0;
    if (!gnoi_tile_lay(tile, index) ||
        !gnoi_reserve(s->context, (void **)&r->line_start, &r->line_capacity, tile->lines.line_count + 1, sizeof *r->line_start))
        return 0;
    for (size_t line = 0; line < tile->lines.line_count; line++) {
        r->line_start[line] = (uint32_t)r->bit_count;
        for (uint32_t p = tile->lines.lines[line].first; p; p = tile->lines.pieces[p].next, tile->spans++)
            if (!add_bit(tile, r, p) || gnoi_stopped_at(s->context, tile->steps++))
                return 0;
        sort_bits(r->bits + r->line_start[line], r->bit_count - r->line_start[line]);
    }
    r->line_start[tile->lines.line_count] = (uint32_t)r->bit_count;
    return 1;
}

/* ---- one line, on the caller's thread ------------------------------------------------------------------------------- */

static int same_surface(const bit *a, const bit *b)
{
    return a->polygon == b->polygon && memcmp(a->tint, b->tint, sizeof a->tint) == 0;
}

/* Links a bit that begins at its tile's left border to the one that ends there in the tile before; 0 when there is none. */
static int link_bit(record *left, size_t line, const bit *b, uint32_t index)
{
    if (b->xa != 0)
        return 0;
    for (uint32_t i = left->line_start[line + 1]; i-- > left->line_start[line];) {
        bit *a = &left->bits[i];
        if (a->xb == GNOI_TILE_W * GNOI_X_ONE && a->next == GNOI_NONE && same_surface(a, b)) {
            a->next = index;
            return 1;
        }
    }
    return 0;
}

/* Finds where the line's spans begin; -1 when memory fails. */
static long find_roots(spans *s, record *row, int tiles_x, size_t line)
{
    size_t count = 0;
    for (int t = 0; t < tiles_x; t++)
        for (uint32_t i = row[t].line_start[line]; i < row[t].line_start[line + 1]; i++) {
            if (t > 0 && link_bit(&row[t - 1], line, &row[t].bits[i], i))
                continue;
            if (!gnoi_reserve(s->context, (void **)&s->roots, &s->root_capacity, count + 1, sizeof *s->roots))
                return -1;
            s->roots[count].tile = (uint32_t)t;
            s->roots[count++].bit = i;
        }
    return (long)count;
}

/* The parts of one lamp along a chain of bits, joined where the light is the same. */
static int join_parts(spans *s, const record *row, const struct root *root, size_t lamp, size_t *count)
{
    size_t first = *count;
    uint32_t t = root->tile;
    for (uint32_t i = root->bit; i != GNOI_NONE; i = row[t++].bits[i].next) {
        const record *r = &row[t];
        for (size_t k = r->starts[r->bits[i].start + lamp]; k < r->starts[r->bits[i].start + lamp + 1]; k++) {
            if (*count > first && memcmp(s->parts[*count - 1].light, r->parts[k].light, sizeof r->parts[k].light) == 0) {
                s->parts[*count - 1].x1 = r->parts[k].x1;
                continue;
            }
            if (!gnoi_reserve(s->context, (void **)&s->parts, &s->part_capacity, *count + 1, sizeof *s->parts))
                return 0;
            s->parts[(*count)++] = r->parts[k];
        }
    }
    return 1;
}

static void set_span(gno_span *span, const record *row, const struct root *root)
{
    uint32_t t = root->tile, i = root->bit;
    const bit *b = &row[t].bits[i];
    span->polygon = b->polygon;
    span->back = b->back;
    span->x0 = (double)t * GNOI_TILE_W + (double)b->xa / GNOI_X_ONE;
    span->depth0 = b->depth0;
    for (int k = 0; k < 3; k++)
        span->tint[k] = (double)b->tint[k];
    while (b->next != GNOI_NONE)
        b = &row[++t].bits[b->next];
    span->x1 = (double)t * GNOI_TILE_W + (double)b->xb / GNOI_X_ONE;
    span->depth1 = b->depth1;
}

static int join_line(spans *s, const record *row, size_t count, size_t lamps)
{
    size_t starts = 0, parts = 0;
    if (!gnoi_reserve(s->context, (void **)&s->spans, &s->span_capacity, count, sizeof *s->spans) ||
        !gnoi_reserve(s->context, (void **)&s->starts, &s->start_capacity, count * (lamps + 1), sizeof *s->starts))
        return 0;
    for (size_t i = 0; i < count; i++) {
        set_span(&s->spans[i], row, &s->roots[i]);
        for (size_t j = 0; j < lamps; j++) {
            s->starts[starts++] = parts;
            if (!join_parts(s, row, &s->roots[i], j, &parts))
                return 0;
        }
        s->starts[starts++] = parts;
    }
    for (size_t i = 0; i < count; i++) { /* pointers last, for the arrays have moved while they grew */
        s->spans[i].part_start = s->starts + i * (lamps + 1);
        s->spans[i].parts = s->parts;
    }
    return 1;
}

static gno_status hand_out_row(spans *s, const gnoi_frame_job *frame, record *row, int tile_row)
{
    int base = frame->def.base_lines, top = tile_row * GNOI_TILE_H, rows = frame->view.height - top;
    rows = rows < GNOI_TILE_H ? rows : GNOI_TILE_H;
    for (int i = 0; i < rows * base; i++) {
        gno_span_line line;
        long count = find_roots(s, row, frame->bins.tiles_x, (size_t)i);
        if (count < 0 || !join_line(s, row, (size_t)count, (size_t)frame->lamp_count) || gnoi_stopped(s->context))
            return GNO_ERROR_MEMORY;
        line.row = top + i / base;
        line.line = i % base;
        line.y = line.row + (line.line + 0.5) / base;
        line.light_count = frame->lamp_count;
        line.span_count = (size_t)count;
        line.spans = s->spans;
        if (s->take(s->user, &line) != 0)
            return gnoi_fail(s->context, GNO_ERROR_CANCELLED, "render: the receiver of spans asked to stop");
    }
    return GNO_OK;
}

static gno_status hand_out(void *user, gnoi_frame_job *frame, int first, int count)
{
    spans *s = user;
    gno_status status = GNO_OK;
    for (int i = 0; i < count && !status; i++)
        status = hand_out_row(s, frame, s->records + (size_t)i * (size_t)frame->bins.tiles_x, first + i);
    return status;
}

/* ---- the call -------------------------------------------------------------------------------------------------------- */

static void free_spans(spans *s)
{
    for (size_t i = 0; s->records && i < s->record_count; i++) {
        record *r = &s->records[i];
        gnoi_free(s->context, r->bits, r->bit_capacity, sizeof *r->bits);
        gnoi_free(s->context, r->line_start, r->line_capacity, sizeof *r->line_start);
        gnoi_free(s->context, r->starts, r->start_capacity, sizeof *r->starts);
        gnoi_free(s->context, r->parts, r->part_capacity, sizeof *r->parts);
    }
    gnoi_free(s->context, s->records, s->record_count, sizeof *s->records);
    gnoi_free(s->context, s->spans, s->span_capacity, sizeof *s->spans);
    gnoi_free(s->context, s->roots, s->root_capacity, sizeof *s->roots);
    gnoi_free(s->context, s->starts, s->start_capacity, sizeof *s->starts);
    gnoi_free(s->context, s->parts, s->part_capacity, sizeof *s->parts);
}

gno_status gno_render_spans(gno_scene *scene, const gno_render_def *def, gno_spans_fn take, void *user, gno_stats *stats)
{
    gno_render_def used = def ? *def : gno_render_def_default();
    gno_context *context = gno_scene_context(scene);
    int threads = gnoi_thread_count(used.threads), tiles_x;
    gnoi_bands bands;
    gno_status status;
    spans s;
    if (!scene || !take)
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "gno_render_spans: scene or spans is NULL");
    used.lines = used.base_lines;
    used.layers = NULL;
    used.engine = GNO_ENGINE_SCANLINE;
    tiles_x = (scene->image.width + GNOI_TILE_W - 1) / GNOI_TILE_W;
    memset(&s, 0, sizeof s);
    s.context = context;
    s.take = take;
    s.user = user;
    s.record_count = (size_t)tiles_x * (size_t)gnoi_band_rows(tiles_x, threads);
    s.records = gnoi_calloc(context, s.record_count, sizeof *s.records);
    if (!s.records)
        return gnoi_fail(context, GNO_ERROR_MEMORY, "out of memory for the spans of the picture");
    bands.user = &s;
    bands.rgb = NULL;
    bands.make = make_record;
    bands.hand_out = hand_out;
    status = gnoi_render(scene, &used, &bands, stats);
    free_spans(&s);
    return status;
}
