/* tree.c -- see tree.h. */
#include "shadow/tree.h"
#include "base/sort.h"
#include <string.h>

/* Classes of size, each this many times smaller than the one before. */
#define SIZE_CLASSES 8
#define CLASS_FACTOR (1.0f / 16)
#define HILBERT_BITS 14

/* ---- boxes ------------------------------------------------------------------------------------------------------ */

int gnoi_boxes_reserve(gnoi_boxes *b, size_t more)
{
    return gnoi_reserve(b->context, (void **)&b->number, &b->number_capacity, b->count + more, sizeof *b->number) &&
           gnoi_reserve(b->context, (void **)&b->box, &b->box_capacity, b->count + more, sizeof *b->box);
}

void gnoi_boxes_free(gnoi_boxes *b)
{
    gnoi_free(b->context, b->box, b->box_capacity, sizeof *b->box);
    gnoi_free(b->context, b->number, b->number_capacity, sizeof *b->number);
}

int gnoi_poly_hull(const gno_scene *scene, const gnoi_poly *poly, vec3 points[GNOI_FRAME_POINTS])
{
    const gnoi_prepared *prep = &scene->prepared;
    uint32_t first = poly->corner, end = prep->ring_corner[poly->ring + 1];
    vec3 n = v3_from(poly->n), origin, e1, e2;
    double lo[2] = {0, 0}, hi[2] = {0, 0};
    if (end - first <= GNOI_FRAME_POINTS) {
        for (uint32_t i = first; i < end; i++)
            points[i - first] = v3_from(prep->positions[prep->corner_vertex[i]]);
        return (int)(end - first);
    }
    origin = v3_from(prep->positions[prep->corner_vertex[first]]);
    e1 = v3_unit(v3_cross(n, fabs(n.x) < 0.6 ? v3(1, 0, 0) : v3(0, 1, 0)));
    e2 = v3_cross(n, e1);
    for (uint32_t i = first; i < end; i++) {
        vec3 q = v3_sub(v3_from(prep->positions[prep->corner_vertex[i]]), origin);
        double s = v3_dot(q, e1), t = v3_dot(q, e2);
        lo[0] = s < lo[0] ? s : lo[0];
        hi[0] = s > hi[0] ? s : hi[0];
        lo[1] = t < lo[1] ? t : lo[1];
        hi[1] = t > hi[1] ? t : hi[1];
    }
    points[0] = v3_mad(v3_mad(origin, e1, lo[0]), e2, lo[1]);
    points[1] = v3_mad(v3_mad(origin, e1, hi[0]), e2, lo[1]);
    points[2] = v3_mad(v3_mad(origin, e1, hi[0]), e2, hi[1]);
    points[3] = v3_mad(v3_mad(origin, e1, lo[0]), e2, hi[1]);
    return 4;
}

int gnoi_halved_side(const gno_scene *scene, const gnoi_lamp *lamp, const unsigned char *halved, const gnoi_poly *poly)
{
    uint32_t solid = gnoi_solid_of(&scene->prepared, poly);
    double side;
    if (!halved || !halved[solid])
        return 0;
    side = gnoi_lamp_side(lamp, poly->n, poly->d);
    return (scene->prepared.solids[solid].outwards ? side > 0 : side < 0) ? -1 : 1;
}

static int casts(const gno_scene *scene, const gnoi_poly *poly)
{
    const double *t = scene->materials[poly->material].transmission;
    return !poly->detail && (poly->opaque || !(t[0] >= 1 && t[1] >= 1 && t[2] >= 1));
}

/* Appends the boxes of prepared polygon i. */
static int add_boxes(const gno_scene *scene, const gnoi_frame *frame, size_t i, gnoi_boxes *b)
{
    const gnoi_poly *poly = &scene->prepared.polys[i];
    vec3 points[GNOI_FRAME_POINTS];
    size_t n;
    if (!gnoi_boxes_reserve(b, 6))
        return 0;
    n = (size_t)gnoi_frame_boxes(frame, points, gnoi_poly_hull(scene, poly, points), b->box + b->count);
    for (size_t k = 0; k < n; k++)
        b->number[b->count++] = (uint32_t)i;
    return 1;
}

static int collect_boxes(const gno_scene *scene, gnoi_tree_part part, const gnoi_frame *frame, gnoi_boxes *b)
{
    const gnoi_prepared *prep = &scene->prepared;
    for (size_t i = 0; i < prep->poly_count; i++)
        if (((part == GNOI_TREE_SEEN || casts(scene, &prep->polys[i])) && !add_boxes(scene, frame, i, b)) || gnoi_stopped_at(scene->context, i))
            return 0;
    return 1;
}

/* Single casters and far sides apart. */
static int collect_casters(const gno_scene *scene, const gnoi_lamp *lamp, const unsigned char *halved, const gnoi_frame *frame,
                           gnoi_boxes *single, gnoi_boxes *far)
{
    const gnoi_prepared *prep = &scene->prepared;
    const size_t count = prep->poly_count + (halved ? prep->cap_count : 0);
    for (size_t i = 0; i < count; i++) {
        const gnoi_poly *poly = &prep->polys[i];
        int side = gnoi_halved_side(scene, lamp, halved, poly);
        if (side < 0 || !casts(scene, poly) || (i >= prep->poly_count && side == 0))
            continue;
        if (!add_boxes(scene, frame, i, side > 0 ? far : single) || gnoi_stopped_at(scene->context, i))
            return 0;
    }
    return 1;
}

/* ---- order ------------------------------------------------------------------------------------------------------ */

static float box_size(const gnoi_lbox *b)
{
    float du = b->u1 - b->u0, dv = b->v1 - b->v0;
    return du > dv ? du : dv;
}

/* 0 for boxes about as large as the whole, one more for each CLASS_FACTOR below it. */
static unsigned size_class(float size, float whole)
{
    unsigned c = 0;
    for (float s = whole * CLASS_FACTOR; c < SIZE_CLASSES - 1 && size < s; s *= CLASS_FACTOR)
        c++;
    return c;
}

/* Place of a cell along the Hilbert curve. The table takes two bits of each coordinate at a step: entry 16 state + 4 x + y holds
 * four bits of the place and, above them, the next state (the curve's four orientations). */
static uint32_t hilbert(uint32_t x, uint32_t y)
{
    static const unsigned char step[64] = {
        0, 51, 20, 5, 17, 18, 39, 6, 46, 45, 24, 9, 15, 60, 43, 10, 16, 1, 62, 31, 35, 2, 61, 44, 4, 55, 8, 59, 21, 22, 25, 26,
        42, 41, 38, 37, 11, 56, 7, 52, 28, 13, 50, 19, 47, 14, 49, 32, 58, 27, 12, 63, 57, 40, 29, 30, 54, 23, 34, 33, 53, 36, 3, 48};
    uint32_t state = 0, place = 0;
    for (int shift = HILBERT_BITS - 2; shift >= 0; shift -= 2) {
        unsigned entry = step[16 * state + 4 * (x >> shift & 3) + (y >> shift & 3)];
        place = place << 4 | (entry & 15);
        state = entry >> 4;
    }
    return place;
}

static uint32_t quantise(float x, float lo, float scale)
{
    float q = (x - lo) * scale;
    float top = (float)((1 << HILBERT_BITS) - 1);
    return (uint32_t)(q < 0 ? 0 : q > top ? top : q);
}

/* 0 when stopped. */
static int order_boxes(const gnoi_boxes *b, gnoi_keyed *keys)
{
    float lo[SIZE_CLASSES][2], hi[SIZE_CLASSES][2], scale[SIZE_CLASSES][2];
    float whole_lo[2] = {FLT_MAX, FLT_MAX}, whole_hi[2] = {-FLT_MAX, -FLT_MAX}, whole;
    for (size_t i = 0; i < b->count; i++) {
        const gnoi_lbox *x = &b->box[i];
        whole_lo[0] = x->u0 < whole_lo[0] ? x->u0 : whole_lo[0];
        whole_lo[1] = x->v0 < whole_lo[1] ? x->v0 : whole_lo[1];
        whole_hi[0] = x->u1 > whole_hi[0] ? x->u1 : whole_hi[0];
        whole_hi[1] = x->v1 > whole_hi[1] ? x->v1 : whole_hi[1];
    }
    whole = whole_hi[0] - whole_lo[0] > whole_hi[1] - whole_lo[1] ? whole_hi[0] - whole_lo[0] : whole_hi[1] - whole_lo[1];
    for (int c = 0; c < SIZE_CLASSES; c++)
        for (int k = 0; k < 2; k++) {
            lo[c][k] = FLT_MAX;
            hi[c][k] = -FLT_MAX;
        }
    for (size_t i = 0; i < b->count; i++) {
        const gnoi_lbox *x = &b->box[i];
        unsigned c = size_class(box_size(x), whole);
        float u = x->u0 + x->u1, v = x->v0 + x->v1;
        keys[i].key = c;
        lo[c][0] = u < lo[c][0] ? u : lo[c][0];
        lo[c][1] = v < lo[c][1] ? v : lo[c][1];
        hi[c][0] = u > hi[c][0] ? u : hi[c][0];
        hi[c][1] = v > hi[c][1] ? v : hi[c][1];
    }
    for (int c = 0; c < SIZE_CLASSES; c++)
        for (int k = 0; k < 2; k++) {
            float extent = hi[c][k] - lo[c][k];
            scale[c][k] = extent > 0 ? (float)((1 << HILBERT_BITS) - 1) / extent : 0;
        }
    for (size_t i = 0; i < b->count; i++) {
        const gnoi_lbox *x = &b->box[i];
        uint32_t c = keys[i].key;
        uint32_t qu = quantise(x->u0 + x->u1, lo[c][0], scale[c][0]), qv = quantise(x->v0 + x->v1, lo[c][1], scale[c][1]);
        keys[i].key = c << (2 * HILBERT_BITS) | hilbert(qu, qv);
        keys[i].value = (uint32_t)i;
        if (gnoi_stopped_at(b->context, i))
            return 0;
    }
    return 1;
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

/* 0 when stopped. */
static int fill(gno_context *context, const gno_scene *scene, gnoi_tree *tree, const gnoi_boxes *b, const gnoi_keyed *keys)
{
    for (size_t i = 0; i < tree->node_count; i++)
        gnoi_eight_clear(&tree->nodes[i]);
    for (size_t i = 0; i < tree->entry_count; i++) {
        tree->caster[i] = b->number[keys[i].value];
        gnoi_eight_set(&tree->nodes[i / GNOI_TREE_FAN], i % GNOI_TREE_FAN, &b->box[keys[i].value]);
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
    gnoi_keyed *keys;
    int good;
    tree->entry_count = b->count;
    plan_levels(tree);
    tree->caster = gnoi_malloc(context, b->count, sizeof *tree->caster);
    tree->nodes = gnoi_malloc(context, tree->node_count, sizeof *tree->nodes);
    tree->leaves = scene ? gnoi_malloc(context, leaf_count(tree), sizeof *tree->leaves) : NULL;
    keys = gnoi_malloc(context, 2 * b->count, sizeof *keys);
    good = tree->caster && tree->nodes && (tree->leaves || !scene) && keys;
    if (good) {
        good = order_boxes(b, keys);
    }
    if (good) {
        gnoi_sort(keys, keys + b->count, b->count);
        good = !gnoi_stopped(context) && fill(context, scene, tree, b, keys);
    }
    gnoi_free(context, keys, 2 * b->count, sizeof *keys);
    return good ? GNO_OK : GNO_ERROR_MEMORY;
}

gno_status gnoi_tree_build_part(const gno_scene *scene, const gnoi_lamp *lamp, gnoi_tree_part part, gnoi_tree *tree)
{
    gnoi_boxes b = {0};
    gno_status status = GNO_ERROR_MEMORY;
    memset(tree, 0, sizeof *tree);
    b.context = scene->context;
    tree->frame = gnoi_frame_make(lamp, scene->prepared.lower, scene->prepared.upper);
    if (collect_boxes(scene, part, &tree->frame, &b))
        status = gnoi_tree_pack(scene->context, &b, scene, tree);
    gnoi_boxes_free(&b);
    if (status)
        gnoi_tree_free(scene->context, tree);
    return status;
}

gno_status gnoi_tree_build_casters(const gno_scene *scene, const gnoi_lamp *lamp, const unsigned char *halved, gnoi_tree *single,
                                   gnoi_tree *far)
{
    gnoi_boxes boxes[2] = {{0}, {0}};
    gno_status status = GNO_ERROR_MEMORY;
    memset(single, 0, sizeof *single);
    memset(far, 0, sizeof *far);
    boxes[0].context = boxes[1].context = scene->context;
    single->frame = far->frame = gnoi_frame_make(lamp, scene->prepared.lower, scene->prepared.upper);
    if (collect_casters(scene, lamp, halved, &single->frame, &boxes[0], &boxes[1]))
        status = gnoi_tree_pack(scene->context, &boxes[0], scene, single);
    gnoi_boxes_free(&boxes[0]);
    if (!status)
        status = gnoi_tree_pack(scene->context, &boxes[1], NULL, far);
    gnoi_boxes_free(&boxes[1]);
    return status;
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
