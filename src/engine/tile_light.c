/* tile_light.c -- the columns of every surface seen in a tile, asked for lamp by lamp and in picture order, so that neighbours
 * walk the caster tree together: see tile.h.
 */
#include "engine/tile.h"

/* Side of the blocks by which surfaces are put in order, in pixels. */
#define BLOCK 8
#define FEW_CASTERS 4
#define BLOCKS (((GNOI_TILE_W + BLOCK - 1) / BLOCK) * ((GNOI_TILE_ROWS + BLOCK - 1) / BLOCK))

static int reserve(gnoi_tile *tile)
{
    gno_context *context = tile->lines.context;
    size_t lamps = (size_t)tile->job->lamp_count;
    return gnoi_reserve(context, (void **)&tile->touched, &tile->touched_capacity, 2 * tile->slot_count + 1, sizeof *tile->touched) &&
           gnoi_reserve(context, (void **)&tile->columns, &tile->column_capacity, tile->column_count + tile->slot_count * lamps + 1,
                        sizeof *tile->columns);
}

/* Lists a slot that has a visible piece if its columns are not known yet, and gives it room for columns. */
static inline size_t list_slot(gnoi_tile *tile, uint32_t slot, size_t count)
{
    if (tile->briefs[slot].lit)
        return count;
    tile->briefs[slot].lit = 1;
    tile->slots[slot].first_column = (uint32_t)tile->column_count;
    tile->column_count += (size_t)tile->job->lamp_count;
    tile->touched[count] = slot;
    return count + 1;
}

/* The slots of all pieces. Every piece is on its line, but where surfaces that let light through may have taken some out. */
static size_t list_slots(gnoi_tile *tile)
{
    const gnoi_piece *pieces = tile->lines.pieces;
    size_t count = 0;
    for (size_t p = 1; p < tile->lines.piece_count && !tile->veiled; p++)
        count = list_slot(tile, pieces[p].slot, count);
    for (size_t line = 0; line < tile->lines.line_count && tile->veiled; line++)
        for (uint32_t p = tile->lines.lines[line].first; p; p = pieces[p].next)
            count = list_slot(tile, pieces[p].slot, count);
    return count;
}

static int block_of(const gnoi_tile *tile, uint32_t slot)
{
    const gnoi_receiver *r = &tile->slots[slot].receiver;
    int x = (int)(r->x0 - tile->x0) / BLOCK, y = (int)(r->y0 - tile->y0 + 1) / BLOCK, across = GNOI_TILE_W / BLOCK;
    x = x < across ? x : across - 1;
    return y * across + (y & 1 ? across - 1 - x : x);
}

/* Puts touched[0..count) in block order, into touched[slot_count..]; returns where. */
static const uint32_t *order_by_block(gnoi_tile *tile, size_t count)
{
    uint32_t *ordered = tile->touched + tile->slot_count;
    size_t start[BLOCKS + 1] = {0};
    for (size_t i = 0; i < count; i++)
        start[block_of(tile, tile->touched[i]) + 1]++;
    for (int b = 0; b < BLOCKS; b++)
        start[b + 1] += start[b];
    for (size_t i = 0; i < count; i++)
        ordered[start[block_of(tile, tile->touched[i])]++] = tile->touched[i];
    return ordered;
}

/* Marks where thin shadow polygons of the new columns pass, as tile_scan.c does for thin polygons. In a long column they are
 * parts of one large shadow, as the triangles of a mesh throw it. */
static void mark_thin_shadows(gnoi_tile *tile, size_t first_column)
{
    for (size_t i = first_column; i < tile->column_count; i++) {
        const gnoi_column *column = &tile->columns[i];
        if (column->state != GNOI_COLUMN_SPLIT || column->caster_count > FEW_CASTERS)
            continue;
        for (uint32_t k = 0; k < column->caster_count; k++) {
            const gnoi_caster *c = &tile->store.casters[column->caster + k];
            if (!(c->area > 0) || c->area * (float)tile->job->def.base_lines >= c->x1 - c->x0)
                continue;
            gnoi_tile_mark_thin(tile, tile->store.edges + c->edge, c->edge_count);
            gnoi_tile_mark_level(tile, (double)c->x0, (double)c->y0, (double)c->x1, (double)c->y1);
        }
    }
}

#define FEW_RIMS 16

/* Whether two contour edges, both nearly level, bound a thin piece of shadow or of light between them. */
static int bound_thin(const gnoi_tile *tile, const gnoi_rim *a, const gnoi_rim *b)
{
    double from = (double)(a->x0 > b->x0 ? a->x0 : b->x0), to = (double)(a->x1 < b->x1 ? a->x1 : b->x1), middle = 0.5 * (from + to), ya, yb;
    if (a->step == b->step || !(from < to))
        return 0;
    ya = a->edge.slope != 0 ? a->edge.y + (middle - a->edge.x) / a->edge.slope : a->edge.y;
    yb = b->edge.slope != 0 ? b->edge.y + (middle - b->edge.x) / b->edge.slope : b->edge.y;
    return fabs(ya - yb) * tile->job->def.base_lines < 1;
}

static int is_level(const gnoi_rim *r) { return r->edge.y1 - r->edge.y < (double)(r->x1 - r->x0); }

static void mark_rim(gnoi_tile *tile, const gnoi_rim *r)
{
    gnoi_tile_mark_thin(tile, &r->edge, r->edge.y1 > r->edge.y);
    gnoi_tile_mark_level(tile, (double)r->x0, r->edge.y, (double)r->x1, r->edge.y1);
}

/* The same of shadows of closed solids. A level edge crosses no line, so which way it runs is not known: it is marked anyway. */
static void mark_thin_sheets(gnoi_tile *tile, size_t first_column)
{
    for (size_t i = first_column; i < tile->column_count; i++) {
        const gnoi_column *column = &tile->columns[i];
        const gnoi_rim *rims;
        if (column->state != GNOI_COLUMN_SPLIT || column->rim_count == 0 || column->rim_count > FEW_RIMS)
            continue;
        rims = tile->store.rims + column->rim;
        for (uint32_t a = 0; a < column->rim_count; a++) {
            int thin = rims[a].edge.y1 == rims[a].edge.y && rims[a].x1 - rims[a].x0 > 1;
            for (uint32_t b = 0; b < column->rim_count && is_level(&rims[a]) && !thin; b++)
                thin = is_level(&rims[b]) && bound_thin(tile, &rims[a], &rims[b]);
            if (thin)
                mark_rim(tile, &rims[a]);
        }
    }
}

void gnoi_tile_light(gnoi_tile *tile)
{
    const gnoi_frame_job *job = tile->job;
    const uint32_t *ordered;
    size_t count, first_column = tile->column_count;
    if (!reserve(tile)) {
        tile->failed = 1;
        return;
    }
    count = list_slots(tile);
    ordered = order_by_block(tile, count);
    for (int j = 0; j < job->lamp_count && !tile->failed; j++) {
        for (size_t i = 0; i < count && !tile->failed; i++) {
            gnoi_slot *slot = &tile->slots[ordered[i]];
            tile->failed |= !gnoi_columns_ask(job->scene, &job->view, &job->lamps[j], &job->casters[j], &slot->receiver, &tile->store,
                                              &tile->columns[slot->first_column + (uint32_t)j]) ||
                            (i % 32 == 31 && gnoi_stopped(tile->lines.context));
        }
        tile->failed |= !gnoi_columns_finish(&job->view, &job->casters[j], &tile->store);
    }
    tile->failed = tile->failed || !gnoi_tile_set_facets(tile, tile->touched, count);
    if (tile->judging && !tile->failed) {
        mark_thin_shadows(tile, first_column);
        mark_thin_sheets(tile, first_column);
    }
}
