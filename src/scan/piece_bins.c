/* piece_bins.c -- see piece_bins.h. */
#include "scan/piece_bins.h"
#include "shadow/lamp.h"
#include "shadow/piece_set.h"
#include <string.h>

/* From so many edges on a piece's edges are listed by rows of tiles. */
#define MANY_EDGES 48

typedef struct builder {
    const gno_scene *scene;
    const gnoi_view *view;
    const gno_pieces *pieces;
    gnoi_piece_bins *bins;
} builder;

/* ---- edges ------------------------------------------------------------------------------------------------------------ */

static void project(const gnoi_view *view, const double *point, double *x, double *y)
{
    vec3 p = v3_from(point);
    double k = view->orthographic ? 1 : 1 / gnoi_form_at(&view->w, p);
    *x = gnoi_form_at(&view->x, p) * k;
    *y = gnoi_form_at(&view->y, p) * k;
}

/* Outer rings run counter-clockwise as they are seen, which is backwards for gnoi_coverage_edge. */
static void project_piece(const builder *b, const gno_piece *piece, gnoi_picture_piece *out)
{
    gnoi_piece_edge *edge = b->bins->edges + out->edge;
    out->x0 = out->y0 = HUGE_VAL;
    out->x1 = out->y1 = -HUGE_VAL;
    for (size_t r = 0; r < piece->ring_count; r++) {
        size_t first = piece->ring_start[r], n = piece->ring_start[r + 1] - first;
        for (size_t i = 0; i < n; i++) {
            double x, y;
            project(b->view, piece->points + 3 * (first + i), &x, &y);
            edge[i].bx = edge[(i + n - 1) % n].ax = x;
            edge[i].by = edge[(i + n - 1) % n].ay = y;
            out->x0 = x < out->x0 ? x : out->x0;
            out->x1 = x > out->x1 ? x : out->x1;
            out->y0 = y < out->y0 ? y : out->y0;
            out->y1 = y > out->y1 ? y : out->y1;
        }
        edge += n;
    }
}

static gno_status make_edges(builder *b)
{
    gno_context *context = b->scene->context;
    gnoi_piece_bins *bins = b->bins;
    uint64_t edges = 0;
    gno_piece piece;
    bins->pieces = gnoi_malloc(context, bins->piece_count, sizeof *bins->pieces);
    if (!bins->pieces)
        return GNO_ERROR_MEMORY;
    for (size_t i = 0; i < bins->piece_count; i++) {
        gnoi_picture_piece *p = &bins->pieces[i];
        gno_pieces_get(b->pieces, i, &piece);
        p->poly = b->pieces->list.pieces[i].prepared;
        p->sheet = b->pieces->list.pieces[i].sheet;
        p->group = i == 0 ? 0 : p[-1].group + (p->poly != p[-1].poly || p->sheet != p[-1].sheet);
        p->bands = GNOI_NONE;
        p->edge = (uint32_t)edges;
        p->edge_count = (uint32_t)(piece.ring_start[piece.ring_count] - piece.ring_start[0]);
        edges += p->edge_count;
        if (edges >= GNOI_NONE)
            return gnoi_fail(context, GNO_ERROR_LIMIT, "too many visible pieces");
    }
    bins->edge_count = (size_t)edges;
    bins->edges = gnoi_malloc(context, bins->edge_count, sizeof *bins->edges);
    if (!bins->edges)
        return GNO_ERROR_MEMORY;
    for (size_t i = 0; i < bins->piece_count; i++) {
        gno_pieces_get(b->pieces, i, &piece);
        project_piece(b, &piece, &bins->pieces[i]);
    }
    return GNO_OK;
}

/* ---- by rows of tiles, by tiles --------------------------------------------------------------------------------------- */

static int tile_index(double v, int size, int tiles)
{
    double t = floor(v / size);
    return t < 0 ? 0 : t > tiles - 1 ? tiles - 1 : (int)t;
}

static void edge_bands(const gnoi_piece_bins *bins, const gnoi_piece_edge *e, int *first, int *last)
{
    *first = tile_index(e->ay < e->by ? e->ay : e->by, GNOI_TILE_H, bins->tiles_y);
    *last = tile_index(e->ay < e->by ? e->by : e->ay, GNOI_TILE_H, bins->tiles_y);
}

/* Counts, then places, the edges of one piece by rows of tiles; `start` has tiles_y + 1 elements. */
static void place_bands(gnoi_piece_bins *bins, const gnoi_picture_piece *p, uint32_t *start, uint64_t *total)
{
    int first, last;
    for (uint32_t i = 0; i < p->edge_count; i++)
        for (edge_bands(bins, &bins->edges[p->edge + i], &first, &last); first <= last; first++)
            start[first + 1]++;
    start[0] = (uint32_t)*total;
    for (int row = 1; row <= bins->tiles_y; row++) {
        *total += start[row];
        start[row] = (uint32_t)*total;
    }
}

static void fill_bands(gnoi_piece_bins *bins, const gnoi_picture_piece *p, const uint32_t *start, uint32_t *next)
{
    int first, last;
    memcpy(next, start, (size_t)bins->tiles_y * sizeof *next);
    for (uint32_t i = 0; i < p->edge_count; i++)
        for (edge_bands(bins, &bins->edges[p->edge + i], &first, &last); first <= last; first++)
            bins->band_edges[next[first]++] = p->edge + i;
}

static gno_status make_bands(gno_context *context, gnoi_piece_bins *bins)
{
    size_t rows = (size_t)bins->tiles_y + 1, many = 0;
    uint64_t total = 0;
    uint32_t *next;
    for (size_t i = 0; i < bins->piece_count; i++)
        many += bins->pieces[i].edge_count >= MANY_EDGES;
    bins->band_start_count = many * rows;
    bins->band_start = gnoi_calloc(context, bins->band_start_count, sizeof *bins->band_start);
    if (!bins->band_start)
        return GNO_ERROR_MEMORY;
    many = 0;
    for (size_t i = 0; i < bins->piece_count && total < GNOI_NONE; i++)
        if (bins->pieces[i].edge_count >= MANY_EDGES) {
            bins->pieces[i].bands = (uint32_t)(many++ * rows);
            place_bands(bins, &bins->pieces[i], bins->band_start + bins->pieces[i].bands, &total);
        }
    if (total >= GNOI_NONE || bins->band_start_count >= GNOI_NONE)
        return gnoi_fail(context, GNO_ERROR_LIMIT, "too many visible pieces");
    bins->band_edge_count = (size_t)total;
    bins->band_edges = gnoi_malloc(context, bins->band_edge_count, sizeof *bins->band_edges);
    next = gnoi_malloc(context, rows, sizeof *next);
    for (size_t i = 0; i < bins->piece_count && bins->band_edges && next; i++)
        if (bins->pieces[i].bands != GNOI_NONE)
            fill_bands(bins, &bins->pieces[i], bins->band_start + bins->pieces[i].bands, next);
    gnoi_free(context, next, rows, sizeof *next);
    return bins->band_edges && next ? GNO_OK : GNO_ERROR_MEMORY;
}

/* Tiles that a piece's box meets: x0, y0, x1, y1, both ends included; y0 > y1 when there are none. */
static void tile_range(const gnoi_piece_bins *bins, const gnoi_picture_piece *p, int range[4])
{
    range[1] = 1;
    range[3] = 0;
    if (!(p->x0 < p->x1) || !(p->y0 < p->y1) || !(p->x1 > 0) || !(p->y1 > 0) ||
        !(p->x0 < (double)bins->tiles_x * GNOI_TILE_W) || !(p->y0 < (double)bins->tiles_y * GNOI_TILE_H))
        return;
    range[0] = tile_index(p->x0, GNOI_TILE_W, bins->tiles_x);
    range[1] = tile_index(p->y0, GNOI_TILE_H, bins->tiles_y);
    range[2] = tile_index(p->x1, GNOI_TILE_W, bins->tiles_x);
    range[3] = tile_index(p->y1, GNOI_TILE_H, bins->tiles_y);
}

static gno_status make_items(gno_context *context, gnoi_piece_bins *bins)
{
    size_t tiles = (size_t)bins->tiles_x * (size_t)bins->tiles_y;
    uint64_t total = 0;
    int r[4];
    bins->start = gnoi_calloc(context, tiles + 1, sizeof *bins->start);
    if (!bins->start)
        return GNO_ERROR_MEMORY;
    for (size_t i = 0; i < bins->piece_count; i++)
        for (tile_range(bins, &bins->pieces[i], r); r[1] <= r[3]; r[1]++)
            for (int x = r[0]; x <= r[2]; x++) {
                bins->start[(size_t)r[1] * (size_t)bins->tiles_x + (size_t)x]++;
                total++;
            }
    if (total >= GNOI_NONE)
        return gnoi_fail(context, GNO_ERROR_LIMIT, "too many visible pieces in too many tiles of the picture");
    bins->item_count = (size_t)total;
    bins->items = gnoi_malloc(context, bins->item_count, sizeof *bins->items);
    if (!bins->items)
        return GNO_ERROR_MEMORY;
    for (size_t t = 1; t <= tiles; t++)
        bins->start[t] += bins->start[t - 1];
    for (size_t i = bins->piece_count; i-- > 0;)
        for (tile_range(bins, &bins->pieces[i], r); r[1] <= r[3]; r[1]++)
            for (int x = r[0]; x <= r[2]; x++)
                bins->items[--bins->start[(size_t)r[1] * (size_t)bins->tiles_x + (size_t)x]] = (uint32_t)i;
    return GNO_OK;
}

const gno_pieces *gnoi_pieces_beside(const gno_pieces *pieces) { return pieces->beside; }

int gnoi_pieces_fit(const gno_scene *scene, const gno_pieces *pieces)
{
    size_t lamps = gnoi_lamps_count(scene);
    if (pieces->polygon_count != scene->polygon_count)
        return 0;
    for (size_t i = 0; i < pieces->list.count; i++)
        if (pieces->list.pieces[i].prepared >= scene->prepared.poly_count)
            return 0;
    for (size_t i = 0; i < pieces->list.light_count; i++)
        if (pieces->list.lights[i] >= lamps)
            return 0;
    return 1;
}

gno_status gnoi_piece_bins_build(const gno_scene *scene, const gnoi_view *view, const gno_pieces *pieces, gnoi_piece_bins *bins)
{
    gno_context *context = scene->context;
    gno_status status;
    builder b;
    memset(&b, 0, sizeof b);
    memset(bins, 0, sizeof *bins);
    b.scene = scene;
    b.view = view;
    b.pieces = pieces;
    b.bins = bins;
    bins->tiles_x = (view->width + GNOI_TILE_W - 1) / GNOI_TILE_W;
    bins->tiles_y = (view->height + GNOI_TILE_H - 1) / GNOI_TILE_H;
    bins->piece_count = gno_pieces_count(pieces);
    status = make_edges(&b);
    if (!status)
        status = make_bands(context, bins);
    if (!status)
        status = make_items(context, bins);
    if (status)
        gnoi_piece_bins_free(context, bins);
    return status;
}

void gnoi_piece_bins_free(gno_context *context, gnoi_piece_bins *bins)
{
    size_t tiles = (size_t)bins->tiles_x * (size_t)bins->tiles_y;
    gnoi_free(context, bins->pieces, bins->piece_count, sizeof *bins->pieces);
    gnoi_free(context, bins->edges, bins->edge_count, sizeof *bins->edges);
    gnoi_free(context, bins->band_start, bins->band_start_count, sizeof *bins->band_start);
    gnoi_free(context, bins->band_edges, bins->band_edge_count, sizeof *bins->band_edges);
    gnoi_free(context, bins->start, tiles + 1, sizeof *bins->start);
    gnoi_free(context, bins->items, bins->item_count, sizeof *bins->items);
    memset(bins, 0, sizeof *bins);
}

const uint32_t *gnoi_piece_band(const gnoi_piece_bins *bins, const gnoi_picture_piece *piece, int tile_row, uint32_t *first,
                                uint32_t *count)
{
    const uint32_t *start;
    *first = piece->edge;
    *count = piece->edge_count;
    if (piece->bands == GNOI_NONE)
        return NULL;
    start = bins->band_start + piece->bands + tile_row;
    *count = start[1] - start[0];
    return bins->band_edges + start[0];
}
