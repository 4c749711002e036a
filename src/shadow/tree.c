/* tree.c -- see tree.h. */
#include "shadow/tree.h"
#include "base/fetch.h"
#include "base/pages.h"
#include <string.h>

#define AHEAD 16      /* boxes */
#define FAR_AHEAD 192 /* boxes: on another page, where the machine does not fetch them unasked */

/* ---- order ------------------------------------------------------------------------------------------------------ */

/* Classes of size: each holds boxes 16 times smaller than the one before, by the binary exponent of the longer side. */
#define SIZE_CLASSES 8
#define CLASS_OCTAVES 4
#define LEAST_BITS 4 /* of a cell's coordinate */
#define MOST_BITS 8
#define CELL_BOXES 128 /* boxes to a cell, at most as long as there are more bits */
#define SAMPLES 1024   /* boxes, about, by which the size of the cells is found */
#define SPREAD 3       /* standard deviations that they cover */

/* Boxes are put into cells along a Hilbert curve, those of a cell in the order in which they come: polygons that lie together. */
typedef struct ordering {
    const gnoi_boxes *boxes;
    float low[2], scale[2]; /* of the cells, in sums of both sides */
    unsigned bits;          /* of a cell's coordinates */
    uint32_t *cell;         /* of each box */
    size_t cell_count;      /* those of each size class follow those of the one before */
    uint32_t *place;        /* of each cell: how many boxes, then where the next one goes */
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
    q = q > 0 ? q : 0; /* a box that is everywhere has no middle */
    return (uint32_t)(int32_t)(q < top ? q : top);
}

static double middle_of(const gnoi_lbox *b, int axis) { return axis == 0 ? (double)b->u0 + (double)b->u1 : (double)b->v0 + (double)b->v1; }

/* The cells cover most of the boxes: those of the others count to the border. */
static void set_extent(ordering *o)
{
    const gnoi_boxes *b = o->boxes;
    const size_t step = 1 + b->count / SAMPLES, count = (b->count + step - 1) / step;
    for (int k = 0; k < 2; k++) {
        const double least = 2 * (double)(k == 0 ? b->whole.u0 : b->whole.v0), most = 2 * (double)(k == 0 ? b->whole.u1 : b->whole.v1);
        double sum = 0, squares = 0, mean, reach, low, high;
        for (size_t i = 0; i < b->count; i += step) {
            double x = middle_of(&b->box[i], k) - least;
            sum += x;
            squares += x * x;
        }
        mean = sum / (double)count;
        reach = SPREAD * sqrt(fmax(squares / (double)count - mean * mean, 0));
        low = fmax(least, least + mean - reach);
        high = fmin(most, least + mean + reach);
        o->low[k] = (float)low;
        o->scale[k] = high > low ? (float)((1 << o->bits) / (high - low)) : 0;
    }
}

static void set_cells(ordering *o)
{
    const gnoi_boxes *b = o->boxes;
    const int whole = exponent(gnoi_box_side(&b->whole));
    const unsigned bits = o->bits;
    const float top = (float)((1 << bits) - 1), u_low = o->low[0], v_low = o->low[1], u_scale = o->scale[0], v_scale = o->scale[1];
    for (size_t i = 0; i < b->count; i++) {
        const gnoi_lbox *x = &b->box[i];
        uint32_t u, v, cell;
        if (i + FAR_AHEAD < b->count)
            FETCH(x + FAR_AHEAD);
        u = quantise(x->u0 + x->u1, u_low, u_scale, top);
        v = quantise(x->v0 + x->v1, v_low, v_scale, top);
        cell = size_class(x, whole) << 2 * bits | hilbert(u, v, bits);
        o->cell[i] = cell;
        o->place[cell]++;
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
    for (o.bits = LEAST_BITS; o.bits < MOST_BITS && (size_t)CELL_BOXES << 2 * o.bits < b->count; o.bits += 2)
        ;
    o.cell_count = (size_t)SIZE_CLASSES << 2 * o.bits;
    o.order = gnoi_malloc(context, b->count, sizeof *o.order);
    o.cell = gnoi_malloc(context, b->count, sizeof *o.cell);
    o.place = gnoi_calloc(context, o.cell_count, sizeof *o.place);
    if (o.order && o.cell && o.place && !gnoi_stopped(context)) {
        if (b->count > 0)
            set_extent(&o);
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

typedef struct walk {
    const gnoi_tree *tree;
    const gnoi_lbox *box;
    gnoi_visit_fn visit;
    void *user;
} walk;

static int walk_node(const walk *w, int level, uint32_t node)
{
    unsigned mask = gnoi_eight_meet(&w->tree->nodes[w->tree->level_first[level] + node], w->box);
    if (level == 0)
        return mask == 0 || w->visit(w->user, node, mask);
    for (unsigned left = mask; left; left &= left - 1)
        gnoi_eight_fetch(&w->tree->nodes[w->tree->level_first[level - 1] + node * GNOI_TREE_FAN + gnoi_lowest_bit(left)]);
    for (; mask; mask &= mask - 1)
        if (!walk_node(w, level - 1, node * GNOI_TREE_FAN + gnoi_lowest_bit(mask)))
            return 0;
    return 1;
}

int gnoi_tree_walk(const gnoi_tree *tree, const gnoi_lbox *box, gnoi_visit_fn visit, void *user)
{
    const walk w = {tree, box, visit, user};
    return tree->levels == 0 || walk_node(&w, tree->levels - 1, 0);
}

/* One query: what is looked for, and where what is found goes. */
typedef struct query {
    gno_context *context;
    const gnoi_tree *tree;
    const gnoi_probe *probe;
    gnoi_list *found;
} query;

static int list_found(void *user, uint32_t node, unsigned mask)
{
    const query *q = user;
    gnoi_list *found = q->found;
    if (q->probe && q->tree->leaves)
        mask &= gnoi_leaf_mask(&q->tree->leaves[node], q->probe);
    if (found->count + GNOI_TREE_FAN > found->capacity &&
        !gnoi_reserve(q->context, (void **)&found->items, &found->capacity, found->count + GNOI_TREE_FAN, sizeof *found->items))
        return 0;
    for (; mask; mask &= mask - 1)
        found->items[found->count++] = q->tree->caster[node * GNOI_TREE_FAN + gnoi_lowest_bit(mask)];
    return 1;
}

int gnoi_tree_query(gno_context *context, const gnoi_tree *tree, const gnoi_lbox *box, const gnoi_probe *probe, gnoi_list *found)
{
    query q = {context, tree, probe, found};
    return gnoi_tree_walk(tree, box, list_found, &q);
}
