/* order.c -- the polygons that are left, in the order in which they lie in space.
 *
 * Place in the data flow: measure.c, split.c -> here -> emit.c, which stores them in this order. Files list polygons in any order; every
 * later pass visits neighbours together and would miss the cache on each of them.
 * Polygons are sorted by the Morton number of their first corner (Morton 1966), equal ones as the caller lists them. `source` still
 * names a polygon as the caller knows it.
 *   numbers, counted by their leading bits -> buckets by these -> each bucket by the other bits, which it is small enough for to stay in
 *   the cache
 */
#include "base/parallel.h"
#include "base/sort.h"
#include "base/vector.h"
#include "scene/prepare.h"

#include <string.h>

#define MORTON_BITS 7
#define CELLS (1 << MORTON_BITS)
#define SAMPLES 4096      /* vertices, about, by which the size of the cells is found */
#define SPREAD 3          /* standard deviations that they cover */
#define FEW_POLYGONS 1024 /* below, everything fits the cache as it is */
#define PIECE 16384       /* vertices or polygons */
#define LOW_BITS 10       /* of a Morton number; the others tell the bucket */
#define LOW (1u << LOW_BITS)
#define BUCKETS (1u << (3 * MORTON_BITS - LOW_BITS))
#define BUCKETS_AT_ONCE 32
#define SHORT_LIST 32     /* items for which counting is too much */

typedef struct ordering {
    gnoi_preparing *w;
    double lower[3], scale; /* of the cells */
    uint32_t *place;   /* Morton number of each scene vertex; NULL: all items are equal */
    size_t pieces;     /* of polygons */
    size_t *first;     /* of each piece: where its items begin; and one more */
    gnoi_keyed *items, *sorted;
    uint32_t (*start)[BUCKETS]; /* of each piece: how many items of each bucket; then where the next one goes */
    size_t *bucket;    /* where each begins, and one more */
} ordering;

static inline uint32_t cell(double t)
{
    t = t > 0 ? t : 0;
    return (uint32_t)(int32_t)(t < CELLS - 1 ? t : CELLS - 1);
}

static inline uint32_t spread(uint32_t x)
{
    x = (x | x << 16) & 0x030000ffu;
    x = (x | x << 8) & 0x0300f00fu;
    x = (x | x << 4) & 0x030c30c3u;
    return (x | x << 2) & 0x09249249u;
}

/* Cells are cubes: a flat scene cut as finely in height would come in layers. */
VECTOR_CLONES static void set_places(const ordering *o, const double (*restrict positions)[3], size_t count, uint32_t *restrict place)
{
    const double scale = o->scale, x = o->lower[0], y = o->lower[1], z = o->lower[2];
    for (size_t v = 0; v < count; v++)
        place[v] = spread(cell(scale * (positions[v][0] - x))) | spread(cell(scale * (positions[v][1] - y))) << 1 |
                   spread(cell(scale * (positions[v][2] - z))) << 2;
}

static gno_status place_piece(void *user, int worker, size_t piece)
{
    const ordering *o = user;
    const gno_scene *scene = o->w->scene;
    size_t end = (piece + 1) * PIECE < scene->vertex_count ? (piece + 1) * PIECE : scene->vertex_count;
    (void)worker;
    set_places(o, (const double(*)[3])scene->positions + piece * PIECE, end - piece * PIECE, o->place + piece * PIECE);
    return GNO_OK;
}

/* ---- items -------------------------------------------------------------------------------------------------------- */

/* The first split triangle of a polygon from `source` on. */
static size_t first_split(const gnoi_splits *splits, size_t source)
{
    size_t low = 0, high = splits->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (splits->source[middle] < source)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Items of one place are in order as they are listed. */
static inline void add_item(const ordering *o, uint32_t *counts, size_t *at, size_t item, size_t corner)
{
    uint32_t key;
    if (!o->place) {
        o->w->order[(*at)++] = (uint32_t)item;
        return;
    }
    key = o->place[o->w->scene->corner_vertex[corner]];
    o->items[*at].key = key;
    o->items[(*at)++].value = (uint32_t)item;
    counts[key >> LOW_BITS]++;
}

static size_t piece_end(const gno_scene *scene, size_t piece)
{
    return (piece + 1) * PIECE < scene->polygon_count ? (piece + 1) * PIECE : scene->polygon_count;
}

static gno_status list_piece(void *user, int worker, size_t piece)
{
    const ordering *o = user;
    const gnoi_preparing *w = o->w;
    const gno_scene *scene = w->scene;
    const gnoi_splits *splits = &w->splits;
    size_t at = o->first[piece], t = first_split(splits, piece * PIECE);
    uint32_t *counts = o->place ? o->start[piece] : NULL;
    (void)worker;
    if (counts)
        memset(counts, 0, sizeof o->start[piece]);
    for (size_t p = piece * PIECE, end = piece_end(scene, piece); p < end; p++) {
        if (gnoi_kind_of(w, p) == GNOI_KEPT)
            add_item(o, counts, &at, p, scene->ring_start[scene->polygon_start[p]]);
        for (; t < splits->count && splits->source[t] == p; t++)
            if (splits->has_area[t])
                add_item(o, counts, &at, scene->polygon_count + t, splits->corner[t][0]);
    }
    return GNO_OK;
}

/* Finds where the items of each piece begin; returns how many there are. */
static size_t count_items(const ordering *o)
{
    const gnoi_preparing *w = o->w;
    size_t sum = 0, t = 0;
    for (size_t k = 0; k < o->pieces; k++) {
        size_t kept = 0, end = piece_end(w->scene, k);
        o->first[k] = sum;
        for (size_t p = k * PIECE; p < end; p++)
            kept += gnoi_kind_of(w, p) == GNOI_KEPT;
        sum += kept;
        for (; t < w->splits.count && w->splits.source[t] < end; t++)
            sum += w->splits.has_area[t];
    }
    o->first[o->pieces] = sum;
    return sum;
}

/* ---- sorting ------------------------------------------------------------------------------------------------------- */

static void set_starts(const ordering *o)
{
    uint32_t sum = 0;
    for (size_t b = 0; b < BUCKETS; b++) {
        o->bucket[b] = sum;
        for (size_t k = 0; k < o->pieces; k++) {
            uint32_t n = o->start[k][b];
            o->start[k][b] = sum;
            sum += n;
        }
    }
    o->bucket[BUCKETS] = sum;
}

static gno_status scatter_piece(void *user, int worker, size_t piece)
{
    const ordering *o = user;
    uint32_t *start = o->start[piece];
    (void)worker;
    for (size_t i = o->first[piece]; i < o->first[piece + 1]; i++)
        o->sorted[start[o->items[i].key >> LOW_BITS]++] = o->items[i];
    return GNO_OK;
}

/* scratch: room for as many. */
static void sort_bucket(gnoi_keyed *items, gnoi_keyed *scratch, size_t count, uint32_t *order)
{
    uint32_t next[LOW], sum = 0;
    if (count < SHORT_LIST) {
        gnoi_sort(items, scratch, count);
        for (size_t i = 0; i < count; i++)
            order[i] = items[i].value;
        return;
    }
    memset(next, 0, sizeof next);
    for (size_t i = 0; i < count; i++)
        next[items[i].key & (LOW - 1)]++;
    for (size_t d = 0; d < LOW; d++) {
        uint32_t n = next[d];
        next[d] = sum;
        sum += n;
    }
    for (size_t i = 0; i < count; i++)
        order[next[items[i].key & (LOW - 1)]++] = items[i].value;
}

static gno_status sort_piece(void *user, int worker, size_t piece)
{
    const ordering *o = user;
    (void)worker;
    for (size_t b = piece * BUCKETS_AT_ONCE; b < (piece + 1) * BUCKETS_AT_ONCE; b++) {
        const size_t first = o->bucket[b];
        sort_bucket(o->sorted + first, o->items + first, o->bucket[b + 1] - first, o->w->order + first);
    }
    return GNO_OK;
}

/* ---- the whole ------------------------------------------------------------------------------------------------------ */

/* The cells cover most of the vertices: what lies farther out, as the corners of a wide ground under a small model, counts to those
 * at the border. */
static void set_cells(ordering *o)
{
    const gno_scene *scene = o->w->scene;
    const gnoi_prepared *prep = o->w->out;
    const size_t step = 1 + scene->vertex_count / SAMPLES, count = (scene->vertex_count + step - 1) / step;
    double extent = 0;
    for (int k = 0; k < 3; k++) {
        const double middle = 0.5 * (prep->lower[k] + prep->upper[k]);
        double sum = 0, squares = 0, mean, reach, upper;
        for (size_t v = 0; v < scene->vertex_count; v += step) {
            double x = scene->positions[v][k] - middle;
            sum += x;
            squares += x * x;
        }
        mean = sum / (double)count;
        reach = SPREAD * sqrt(fmax(squares / (double)count - mean * mean, 0));
        o->lower[k] = fmax(prep->lower[k], middle + mean - reach);
        upper = fmin(prep->upper[k], middle + mean + reach);
        extent = upper - o->lower[k] > extent ? upper - o->lower[k] : extent;
    }
    o->scale = extent > 0 ? CELLS / extent : 0;
}

static gno_status fill_places(ordering *o)
{
    gno_context *context = o->w->scene->context;
    size_t vertices = o->w->scene->vertex_count;
    set_cells(o);
    o->place = gnoi_malloc(context, vertices, sizeof *o->place);
    if (!o->place)
        return GNO_ERROR_MEMORY;
    return gnoi_parallel(context, o->w->threads, (vertices + PIECE - 1) / PIECE, "prepare", place_piece, o);
}

/* Lists the items, sorts them and keeps their numbers. */
static gno_status sort_items(ordering *o)
{
    gnoi_preparing *w = o->w;
    gno_context *context = w->scene->context;
    gno_status status = gnoi_parallel(context, w->threads, o->pieces, "prepare", list_piece, o);
    if (status || !o->place)
        return status;
    set_starts(o);
    status = gnoi_parallel(context, w->threads, o->pieces, "prepare", scatter_piece, o);
    return status ? status : gnoi_parallel(context, w->threads, BUCKETS / BUCKETS_AT_ONCE, "prepare", sort_piece, o);
}

/* What sorting needs, unless the polygons are so few that they stay as they are. */
static gno_status prepare_sorting(ordering *o)
{
    gno_context *context = o->w->scene->context;
    const size_t count = o->w->item_count;
    if (count < FEW_POLYGONS)
        return GNO_OK;
    o->items = gnoi_malloc(context, count, sizeof *o->items);
    o->sorted = gnoi_malloc(context, count, sizeof *o->sorted);
    o->start = gnoi_malloc(context, o->pieces, sizeof *o->start);
    o->bucket = gnoi_malloc(context, BUCKETS + 1, sizeof *o->bucket);
    return o->items && o->sorted && o->start && o->bucket ? fill_places(o) : GNO_ERROR_MEMORY;
}

gno_status gnoi_order_items(gnoi_preparing *w)
{
    gno_context *context = w->scene->context;
    ordering o = {0};
    gno_status status = GNO_ERROR_MEMORY;
    o.w = w;
    o.pieces = (w->scene->polygon_count + PIECE - 1) / PIECE;
    o.first = gnoi_malloc(context, o.pieces + 1, sizeof *o.first);
    w->item_count = o.first ? count_items(&o) : 0;
    w->order = gnoi_malloc(context, w->item_count, sizeof *w->order);
    if (o.first && w->order)
        status = prepare_sorting(&o);
    if (status == GNO_OK)
        status = sort_items(&o);
    gnoi_free(context, o.place, w->scene->vertex_count, sizeof *o.place);
    gnoi_free(context, o.items, w->item_count, sizeof *o.items);
    gnoi_free(context, o.sorted, w->item_count, sizeof *o.sorted);
    gnoi_free(context, o.start, o.pieces, sizeof *o.start);
    gnoi_free(context, o.bucket, BUCKETS + 1, sizeof *o.bucket);
    gnoi_free(context, o.first, o.pieces + 1, sizeof *o.first);
    return status;
}
