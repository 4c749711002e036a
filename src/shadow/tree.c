/* tree.c -- see tree.h. */
#include "shadow/tree.h"
#include "base/fetch.h"
#include "base/pages.h"
#include <string.h>

#define AHEAD 16 /* boxes */

/* ---- order ------------------------------------------------------------------------------------------------------ */

/* Classes of size: each holds boxes 16 times smaller than the one before, by the binary exponent of the longer side. */
#define SIZE_CLASSES 8
#define CLASS_OCTAVES 4
#define MOST_BITS 8 /* of a cell's coordinate */

/* What is known of the boxes of one class. */
typedef struct size_range {
    float lo[2], hi[2], scale[2]; /* of the sums of both sides */
    uint32_t first;               /* of its cells */
    int used;
} size_range;

/* Boxes are put into cells along a Hilbert curve, those of a cell in the order in which they come: polygons that lie together. */
typedef struct ordering {
    const gnoi_boxes *boxes;
    size_range range[SIZE_CLASSES];
    unsigned bits;      /* of a cell's coordinates */
    uint32_t *cell;     /* of each box: its class, then its cell */
    size_t cell_count;
    uint32_t *place;    /* of each cell: how many boxes, then where the next one goes */
    uint32_t *order;
} ordering;

static int exponent(float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return (int)(bits >> 23 & 255);
}

/* 0 for boxes about as large as the whole. */
static unsigned size_class(const gnoi_lbox *b, int whole)
{
    int below = (whole - exponent(gnoi_box_side(b))) / CLASS_OCTAVES;
    return below < 0 ? 0 : below < SIZE_CLASSES ? (unsigned)below : SIZE_CLASSES - 1;
}

/* Place of a cell along the Hilbert curve. The table takes two bits of each coordinate at a step: entry 16 state + 4 x + y holds
 * four bits of the place and, above them, the next state (the curve's four orientations). */
static uint32_t hilbert(uint32_t x, uint32_t y, unsigned bits)
{
    static const unsigned char step[64] = {
        0, 51, 20, 5, 17, 18, 39, 6, 46, 45, 24, 9, 15, 60, 43, 10, 16, 1, 62, 31, 35, 2, 61, 44, 4, 55, 8, 59, 21, 22, 25, 26,
        42, 41, 38, 37, 11, 56, 7, 52, 28, 13, 50, 19, 47, 14, 49, 32, 58, 27, 12, 63, 57, 40, 29, 30, 54, 23, 34, 33, 53, 36, 3, 48};
    uint32_t state = 0, place = 0;
    for (int shift = (int)bits - 2; shift >= 0; shift -= 2) {
        unsigned entry = step[16 * state + 4 * (x >> shift & 3) + (y >> shift & 3)];
        place = place << 4 | (entry & 15);
        state = entry >> 4;
    }
    return place;
}

static uint32_t quantise(float x, float lo, float scale, float top)
{
    float q = (x - lo) * scale;
    return (uint32_t)(q < 0 ? 0 : q > top ? top : q);
}

static void set_classes(ordering *o)
{
    const gnoi_boxes *b = o->boxes;
    const int whole = exponent(gnoi_box_side(&b->whole));
    for (int c = 0; c < SIZE_CLASSES; c++) {
        o->range[c].lo[0] = o->range[c].lo[1] = FLT_MAX;
        o->range[c].hi[0] = o->range[c].hi[1] = -FLT_MAX;
        o->range[c].used = 0;
    }
    for (size_t i = 0; i < b->count; i++) {
        unsigned c = size_class(&b->box[i], whole);
        size_range *r = &o->range[c];
        float u = b->box[i].u0 + b->box[i].u1, v = b->box[i].v0 + b->box[i].v1;
        o->cell[i] = c;
        r->lo[0] = u < r->lo[0] ? u : r->lo[0];
        r->lo[1] = v < r->lo[1] ? v : r->lo[1];
        r->hi[0] = u > r->hi[0] ? u : r->hi[0];
        r->hi[1] = v > r->hi[1] ? v : r->hi[1];
        r->used = 1;
    }
    for (int c = 0; c < SIZE_CLASSES; c++) {
        size_range *r = &o->range[c];
        for (int k = 0; k < 2 && r->used; k++)
            r->scale[k] = r->hi[k] > r->lo[k] ? (float)((1 << o->bits) - 1) / (r->hi[k] - r->lo[k]) : 0;
        r->first = (uint32_t)o->cell_count;
        o->cell_count += r->used ? (size_t)1 << 2 * o->bits : 0;
    }
}

static void set_cells(ordering *o)
{
    const gnoi_boxes *b = o->boxes;
    const float top = (float)((1 << o->bits) - 1);
    for (size_t i = 0; i < b->count; i++) {
        const size_range *r = &o->range[o->cell[i]];
        const gnoi_lbox *x = &b->box[i];
        uint32_t u = quantise(x->u0 + x->u1, r->lo[0], r->scale[0], top), v = quantise(x->v0 + x->v1, r->lo[1], r->scale[1], top);
        o->cell[i] = r->first + hilbert(u, v, o->bits);
        o->place[o->cell[i]]++;
    }
}

static void set_order(ordering *o)
{
    uint32_t sum = 0;
    for (size_t c = 0; c < o->cell_count; c++) {
        uint32_t n = o->place[c];
        o->place[c] = sum;
        sum += n;
    }
    for (size_t i = 0; i < o->boxes->count; i++)
        o->order[o->place[o->cell[i]]++] = (uint32_t)i;
}

/* The order of the boxes, for gnoi_free; NULL without memory, or when stopped. */
static uint32_t *order_boxes(const gnoi_boxes *b)
{
    gno_context *context = b->context;
    ordering o;
    memset(&o, 0, sizeof o);
    o.boxes = b;
    for (o.bits = 2; o.bits < MOST_BITS && (size_t)1 << 2 * o.bits < b->count; o.bits += 2)
        ;
    o.order = gnoi_malloc(context, b->count, sizeof *o.order);
    o.cell = gnoi_malloc(context, b->count, sizeof *o.cell);
    if (o.cell)
        set_classes(&o);
    o.place = gnoi_calloc(context, o.cell_count, sizeof *o.place);
    if (o.order && o.cell && o.place && !gnoi_stopped(context)) {
        set_cells(&o);
        set_order(&o);
    } else {
        gnoi_free(context, o.order, b->count, sizeof *o.order);
        o.order = NULL;
    }
    gnoi_free(context, o.cell, b->count, sizeof *o.cell);
    gnoi_free(context, o.place, o.cell_count, sizeof *o.place);
    return o.order;
}

/* ---- packing ---------------------------------------------------------------------------------------------------- */

static void plan_levels(gnoi_tree *tree)
{
    size_t n = tree->entry_count;
    tree->levels = 0;
    tree->node_count = 0;
    while (n > 0) {
        n = (n + GNOI_TREE_FAN - 1) / GNOI_TREE_FAN;
        tree->level_first[tree->levels++] = tree->node_count;
        tree->node_count += n;
        if (n == 1)
            break;
    }
}

static size_t leaf_count(const gnoi_tree *tree) { return (tree->entry_count + GNOI_TREE_FAN - 1) / GNOI_TREE_FAN; }

/* Slots that no box takes: in the last node of each level. */
static void clear_ends(gnoi_tree *tree)
{
    for (int level = 0; level < tree->levels; level++)
        gnoi_eight_clear(&tree->nodes[level + 1 < tree->levels ? tree->level_first[level + 1] - 1 : tree->node_count - 1]);
}

/* 0 when stopped. */
static int fill(gno_context *context, const gno_scene *scene, gnoi_tree *tree, const gnoi_boxes *b, const uint32_t *order)
{
    gnoi_pages_ready(tree->nodes, tree->node_count * sizeof *tree->nodes);
    clear_ends(tree);
    for (size_t i = 0; i < tree->entry_count; i++) {
        if (i + AHEAD < tree->entry_count)
            FETCH(&b->box[order[i + AHEAD]]);
        tree->caster[i] = b->number[order[i]];
        gnoi_eight_set(&tree->nodes[i / GNOI_TREE_FAN], i % GNOI_TREE_FAN, &b->box[order[i]]);
    }
    for (size_t i = 0, n = tree->entry_count; tree->leaves && i < leaf_count(tree); i++) {
        size_t first = i * GNOI_TREE_FAN, count = n - first < GNOI_TREE_FAN ? n - first : GNOI_TREE_FAN;
        gnoi_leaf_set(scene, &tree->frame, tree->caster + first, count, &tree->leaves[i]);
        if (gnoi_stopped_at(context, i))
            return 0;
    }
    for (int level = 1; level < tree->levels; level++) {
        size_t below = tree->level_first[level - 1], first = tree->level_first[level];
        for (size_t i = below; i < first; i++) {
            const gnoi_lbox box = gnoi_eight_union(&tree->nodes[i]);
            gnoi_eight_set(&tree->nodes[first + (i - below) / GNOI_TREE_FAN], (i - below) % GNOI_TREE_FAN, &box);
        }
    }
    return 1;
}

gno_status gnoi_tree_pack(gno_context *context, const gnoi_boxes *b, const gno_scene *scene, gnoi_tree *tree)
{
    uint32_t *order = order_boxes(b);
    int good;
    tree->entry_count = b->count;
    plan_levels(tree);
    tree->caster = gnoi_malloc(context, b->count, sizeof *tree->caster);
    tree->nodes = gnoi_malloc(context, tree->node_count, sizeof *tree->nodes);
    tree->leaves = scene ? gnoi_malloc(context, leaf_count(tree), sizeof *tree->leaves) : NULL;
    good = order && tree->caster && tree->nodes && (tree->leaves || !scene) && fill(context, scene, tree, b, order);
    gnoi_free(context, order, b->count, sizeof *order);
    return good ? GNO_OK : GNO_ERROR_MEMORY;
}

void gnoi_tree_free(gno_context *context, gnoi_tree *tree)
{
    gnoi_free(context, tree->caster, tree->entry_count, sizeof *tree->caster);
    gnoi_free(context, tree->nodes, tree->node_count, sizeof *tree->nodes);
    gnoi_free(context, tree->leaves, tree->leaves ? leaf_count(tree) : 0, sizeof *tree->leaves);
    tree->caster = NULL;
    tree->nodes = NULL;
    tree->leaves = NULL;
    tree->entry_count = tree->node_count = 0;
    tree->levels = 0;
}

/* ---- query ------------------------------------------------------------------------------------------------------ */

static int list_room(gno_context *context, gnoi_list *list, size_t more)
{
    return list->count + more <= list->capacity ||
           gnoi_reserve(context, (void **)&list->items, &list->capacity, list->count + more, sizeof *list->items);
}

/* One query: what is looked for, and where what is found goes. */
typedef struct query {
    gno_context *context;
    const gnoi_tree *tree;
    const gnoi_lbox *box;
    const gnoi_probe *probe;
    gnoi_list *found;
} query;

static int query_node(const query *q, int level, uint32_t node)
{
    unsigned mask = gnoi_eight_meet(&q->tree->nodes[q->tree->level_first[level] + node], q->box);
    if (level == 0 && mask) {
        if (q->probe && q->tree->leaves)
            mask &= gnoi_leaf_mask(&q->tree->leaves[node], q->probe);
        if (!list_room(q->context, q->found, GNOI_TREE_FAN))
            return 0;
    }
    for (; mask; mask &= mask - 1) {
        uint32_t child = node * GNOI_TREE_FAN + gnoi_lowest_bit(mask);
        if (level == 0)
            q->found->items[q->found->count++] = q->tree->caster[child];
        else if (!query_node(q, level - 1, child))
            return 0;
    }
    return 1;
}

int gnoi_tree_query(gno_context *context, const gnoi_tree *tree, const gnoi_lbox *box, const gnoi_probe *probe, gnoi_list *found)
{
    query q = {context, tree, box, probe, found};
    return tree->levels == 0 || query_node(&q, tree->levels - 1, 0);
}
