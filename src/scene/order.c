/* order.c -- the polygons that are left, in the order in which they lie in space.
 *
 * Place in the data flow: measure.c, split.c -> here -> emit.c, which stores them in this order. Files list polygons in any order; every
 * later pass visits neighbours together and would miss the cache on each of them.
 * Polygons are sorted by the Morton number of their first corner (Morton 1966), equal ones as the caller lists them. `source` still
 * names a polygon as the caller knows it.
 */
#include "base/parallel.h"
#include "base/sort_parallel.h"
#include "scene/prepare.h"

#include <string.h>

#define MORTON_BITS 10
#define FEW_POLYGONS 1024 /* below, everything fits the cache as it is */
#define PIECE 16384       /* vertices or polygons */

typedef struct ordering {
    gnoi_preparing *w;
    double extent;     /* the longest side of the scene's bounds */
    uint32_t *place;   /* Morton number of each scene vertex; NULL: all items are equal */
    size_t *first;     /* of each piece of polygons: where its items begin */
    gnoi_keyed *items, *sorted;
} ordering;

static uint32_t spread(uint32_t x)
{
    x = (x | x << 16) & 0x030000ffu;
    x = (x | x << 8) & 0x0300f00fu;
    x = (x | x << 4) & 0x030c30c3u;
    return (x | x << 2) & 0x09249249u;
}

/* Cells are cubes of the longest extent: a flat scene cut as finely in height would come in layers. Vertices that no item uses may lie
 * outside the bounds. */
static uint32_t place_of(const gnoi_prepared *prep, double extent, const double p[3])
{
    uint32_t key = 0;
    for (int k = 0; k < 3; k++) {
        double t = extent > 0 ? (p[k] - prep->lower[k]) / extent : 0;
        t = t > 0 ? t : 0;
        t = t < 1 ? t : 1;
        key |= spread((uint32_t)(t * ((1 << MORTON_BITS) - 1))) << k;
    }
    return key;
}

static gno_status place_piece(void *user, int worker, size_t piece)
{
    const ordering *o = user;
    const gno_scene *scene = o->w->scene;
    size_t end = (piece + 1) * PIECE < scene->vertex_count ? (piece + 1) * PIECE : scene->vertex_count;
    (void)worker;
    for (size_t v = piece * PIECE; v < end; v++)
        o->place[v] = place_of(o->w->out, o->extent, scene->positions[v]);
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

static void add_item(const ordering *o, size_t *at, size_t item, size_t corner)
{
    o->items[*at].key = o->place ? o->place[o->w->scene->corner_vertex[corner]] : 0;
    o->items[(*at)++].value = (uint32_t)item;
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
    (void)worker;
    for (size_t p = piece * PIECE, end = piece_end(scene, piece); p < end; p++) {
        if (gnoi_kind_of(w, p) == GNOI_KEPT)
            add_item(o, &at, p, scene->ring_start[scene->polygon_start[p]]);
        for (; t < splits->count && splits->source[t] == p; t++)
            if (splits->has_area[t])
                add_item(o, &at, scene->polygon_count + t, splits->corner[t][0]);
    }
    return GNO_OK;
}

/* Counts items, a number for each piece becomes where it begins; returns their sum. */
static size_t count_items(const ordering *o, size_t pieces)
{
    const gnoi_preparing *w = o->w;
    size_t sum = 0, t = 0;
    for (size_t k = 0; k < pieces; k++) {
        size_t kept = 0, end = piece_end(w->scene, k);
        o->first[k] = sum;
        for (size_t p = k * PIECE; p < end; p++)
            kept += gnoi_kind_of(w, p) == GNOI_KEPT;
        sum += kept;
        for (; t < w->splits.count && w->splits.source[t] < end; t++)
            sum += w->splits.has_area[t];
    }
    return sum;
}

/* ---- the whole ------------------------------------------------------------------------------------------------------ */

static gno_status fill_places(ordering *o)
{
    gno_context *context = o->w->scene->context;
    const gnoi_prepared *prep = o->w->out;
    size_t vertices = o->w->scene->vertex_count;
    for (int k = 0; k < 3; k++)
        o->extent = prep->upper[k] - prep->lower[k] > o->extent ? prep->upper[k] - prep->lower[k] : o->extent;
    o->place = gnoi_malloc(context, vertices, sizeof *o->place);
    if (!o->place)
        return GNO_ERROR_MEMORY;
    return gnoi_parallel(context, o->w->threads, (vertices + PIECE - 1) / PIECE, "prepare", place_piece, o);
}

static gno_status keep_piece(void *user, int worker, size_t piece)
{
    const ordering *o = user;
    size_t end = (piece + 1) * PIECE < o->w->item_count ? (piece + 1) * PIECE : o->w->item_count;
    (void)worker;
    for (size_t i = piece * PIECE; i < end; i++)
        o->w->order[i] = o->sorted[i].value;
    return GNO_OK;
}

/* Lists the items, sorts them and keeps their numbers. */
static gno_status sort_items(ordering *o, size_t pieces)
{
    gnoi_preparing *w = o->w;
    gno_context *context = w->scene->context;
    size_t count = w->item_count;
    gno_status status = gnoi_parallel(context, w->threads, pieces, "prepare", list_piece, o);
    o->sorted = o->items;
    if (status == GNO_OK && o->place) {
        o->sorted = gnoi_sort_parallel(context, w->threads, "prepare", o->items, o->items + count, count, 3 * MORTON_BITS);
        status = o->sorted ? GNO_OK : GNO_ERROR_MEMORY;
    }
    return status ? status : gnoi_parallel(context, w->threads, (count + PIECE - 1) / PIECE, "prepare", keep_piece, o);
}

gno_status gnoi_order_items(gnoi_preparing *w)
{
    gno_context *context = w->scene->context;
    size_t pieces = (w->scene->polygon_count + PIECE - 1) / PIECE;
    ordering o = {w, 0, NULL, NULL, NULL, NULL};
    gno_status status = GNO_OK;
    o.first = gnoi_malloc(context, pieces, sizeof *o.first);
    w->item_count = o.first ? count_items(&o, pieces) : 0;
    w->order = gnoi_malloc(context, w->item_count, sizeof *w->order);
    o.items = gnoi_malloc(context, 2 * w->item_count, sizeof *o.items);
    if (!o.first || !w->order || !o.items)
        status = GNO_ERROR_MEMORY;
    if (status == GNO_OK && w->item_count >= FEW_POLYGONS)
        status = fill_places(&o);
    if (status == GNO_OK)
        status = sort_items(&o, pieces);
    gnoi_free(context, o.place, w->scene->vertex_count, sizeof *o.place);
    gnoi_free(context, o.items, 2 * w->item_count, sizeof *o.items);
    gnoi_free(context, o.first, pieces, sizeof *o.first);
    return status;
}
