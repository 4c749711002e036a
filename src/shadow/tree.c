/* tree.c -- see tree.h. */
#include "shadow/tree.h"
#include "base/sort.h"
#include <float.h>
#include <string.h>
#if defined(__SSE2__)
#include <emmintrin.h>
#endif

/* Classes of size, each this many times smaller than the one before. */
#define SIZE_CLASSES 8
#define CLASS_FACTOR (1.0f / 16)
#define HILBERT_BITS 14

/* ---- boxes ------------------------------------------------------------------------------------------------------ */

typedef struct boxes {
    gno_context *context;
    size_t count, box_capacity, caster_capacity;
    gnoi_lbox *box;
    uint32_t *caster;
} boxes;

static int boxes_reserve(boxes *b, size_t need)
{
    return gnoi_reserve(b->context, (void **)&b->caster, &b->caster_capacity, need, sizeof *b->caster) &&
           gnoi_reserve(b->context, (void **)&b->box, &b->box_capacity, need, sizeof *b->box);
}

static void boxes_free(boxes *b)
{
    gnoi_free(b->context, b->box, b->box_capacity, sizeof *b->box);
    gnoi_free(b->context, b->caster, b->caster_capacity, sizeof *b->caster);
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

/* A polygon of a halved solid that the solid's other side stands in for. */
static int is_near_side(const gno_scene *scene, const gnoi_lamp *lamp, const unsigned char *halved, const gnoi_poly *poly)
{
    uint32_t solid = gnoi_solid_of(&scene->prepared, poly);
    double side = gnoi_lamp_side(lamp, poly->n, poly->d);
    return halved && halved[solid] && (scene->prepared.solids[solid].outwards ? side > 0 : side < 0);
}

static int collect_boxes(const gno_scene *scene, const gnoi_lamp *lamp, const unsigned char *halved, const gnoi_frame *frame, boxes *b)
{
    const gnoi_prepared *prep = &scene->prepared;
    for (size_t i = 0; i < prep->poly_count; i++) {
        const gnoi_poly *poly = &prep->polys[i];
        const double *t = scene->materials[poly->material].transmission;
        vec3 points[GNOI_FRAME_POINTS];
        gnoi_lbox box[6];
        int n;
        if ((!poly->opaque && t[0] >= 1 && t[1] >= 1 && t[2] >= 1) || is_near_side(scene, lamp, halved, poly))
            continue;
        n = gnoi_frame_boxes(frame, points, gnoi_poly_hull(scene, poly, points), box);
        if (!boxes_reserve(b, b->count + 6))
            return 0;
        for (int k = 0; k < n; k++) {
            b->box[b->count] = box[k];
            b->caster[b->count++] = (uint32_t)i;
        }
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

static void order_boxes(const boxes *b, gnoi_keyed *keys)
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
    }
}

/* ---- leaves ----------------------------------------------------------------------------------------------------- */

static void leaf_clear(gnoi_tree_leaf *leaf)
{
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < GNOI_TREE_FAN; k++)
            leaf->u[i][k] = leaf->v[i][k] = leaf->q[i][k] = NAN;
}

static void set_leaf(const gno_scene *scene, const gnoi_tree *tree, size_t index, gnoi_tree_leaf *leaf)
{
    const gnoi_prepared *prep = &scene->prepared;
    int placed = 0;
    leaf_clear(leaf);
    for (size_t k = 0; k < GNOI_TREE_FAN && index * GNOI_TREE_FAN + k < tree->entry_count; k++) {
        const gnoi_poly *poly = &prep->polys[tree->caster[index * GNOI_TREE_FAN + k]];
        vec3 p[3];
        gnoi_lpoint l[3];
        if (poly->corner_count != 3)
            continue;
        for (uint32_t i = 0; i < 3; i++)
            p[i] = v3_from(prep->positions[prep->corner_vertex[poly->corner + i]]);
        if (!gnoi_frame_locate(&tree->frame, p, 3, l))
            continue;
        if (!placed)
            leaf->origin = l[0];
        placed = 1;
        for (int i = 0; i < 3; i++) {
            leaf->u[i][k] = (float)(l[i].u - leaf->origin.u);
            leaf->v[i][k] = (float)(l[i].v - leaf->origin.v);
            leaf->q[i][k] = (float)(l[i].q - leaf->origin.q);
        }
    }
    if (!placed)
        leaf->origin.u = leaf->origin.v = leaf->origin.q = 0;
}

/* ---- packing ---------------------------------------------------------------------------------------------------- */

static void node_clear(gnoi_tree_node *node)
{
    for (int k = 0; k < GNOI_TREE_FAN; k++) {
        node->u0[k] = node->v0[k] = node->z0[k] = FLT_MAX;
        node->u1[k] = node->v1[k] = -FLT_MAX;
    }
}

static void node_set(gnoi_tree_node *node, size_t k, float u0, float u1, float w0, float w1, float z0)
{
    node->u0[k] = u0;
    node->u1[k] = u1;
    node->v0[k] = w0;
    node->v1[k] = w1;
    node->z0[k] = z0;
}

static void node_set_union(gnoi_tree_node *node, size_t k, const gnoi_tree_node *child)
{
    float u0 = FLT_MAX, u1 = -FLT_MAX, w0 = FLT_MAX, w1 = -FLT_MAX, z0 = FLT_MAX;
    for (int i = 0; i < GNOI_TREE_FAN; i++) {
        u0 = child->u0[i] < u0 ? child->u0[i] : u0;
        u1 = child->u1[i] > u1 ? child->u1[i] : u1;
        w0 = child->v0[i] < w0 ? child->v0[i] : w0;
        w1 = child->v1[i] > w1 ? child->v1[i] : w1;
        z0 = child->z0[i] < z0 ? child->z0[i] : z0;
    }
    node_set(node, k, u0, u1, w0, w1, z0);
}

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

static void pack(const gno_scene *scene, gnoi_tree *tree, const boxes *b, const gnoi_keyed *keys)
{
    for (size_t i = 0; i < tree->node_count; i++)
        node_clear(&tree->nodes[i]);
    for (size_t i = 0; i < tree->entry_count; i++) {
        const gnoi_lbox *x = &b->box[keys[i].value];
        tree->caster[i] = b->caster[keys[i].value];
        node_set(&tree->nodes[i / GNOI_TREE_FAN], i % GNOI_TREE_FAN, x->u0, x->u1, x->v0, x->v1, x->z0);
    }
    for (size_t i = 0; i < leaf_count(tree); i++)
        set_leaf(scene, tree, i, &tree->leaves[i]);
    for (int level = 1; level < tree->levels; level++) {
        size_t below = tree->level_first[level - 1], first = tree->level_first[level];
        for (size_t i = below; i < first; i++)
            node_set_union(&tree->nodes[first + (i - below) / GNOI_TREE_FAN], (i - below) % GNOI_TREE_FAN, &tree->nodes[i]);
    }
}

gno_status gnoi_tree_build(const gno_scene *scene, const gnoi_lamp *lamp, const unsigned char *halved, gnoi_tree *tree)
{
    gno_context *context = scene->context;
    boxes b = {0};
    gnoi_keyed *keys = NULL;
    gno_status status = GNO_ERROR_MEMORY;
    memset(tree, 0, sizeof *tree);
    b.context = context;
    tree->frame = gnoi_frame_make(lamp, scene->prepared.lower, scene->prepared.upper);
    if (!boxes_reserve(&b, scene->prepared.poly_count + 6) || !collect_boxes(scene, lamp, halved, &tree->frame, &b))
        goto done;
    tree->entry_count = b.count;
    plan_levels(tree);
    tree->caster = gnoi_malloc(context, b.count, sizeof *tree->caster);
    tree->nodes = gnoi_malloc(context, tree->node_count, sizeof *tree->nodes);
    tree->leaves = gnoi_malloc(context, leaf_count(tree), sizeof *tree->leaves);
    keys = gnoi_malloc(context, 2 * b.count, sizeof *keys);
    if (!tree->caster || !tree->nodes || !tree->leaves || !keys)
        goto done;
    order_boxes(&b, keys);
    gnoi_sort(keys, keys + b.count, b.count);
    pack(scene, tree, &b, keys);
    status = GNO_OK;
done:
    gnoi_free(context, keys, 2 * b.count, sizeof *keys);
    boxes_free(&b);
    if (status)
        gnoi_tree_free(context, tree);
    return status;
}

void gnoi_tree_free(gno_context *context, gnoi_tree *tree)
{
    gnoi_free(context, tree->caster, tree->entry_count, sizeof *tree->caster);
    gnoi_free(context, tree->nodes, tree->node_count, sizeof *tree->nodes);
    gnoi_free(context, tree->leaves, leaf_count(tree), sizeof *tree->leaves);
    tree->caster = NULL;
    tree->nodes = NULL;
    tree->leaves = NULL;
    tree->entry_count = tree->node_count = 0;
    tree->levels = 0;
}

/* ---- query ------------------------------------------------------------------------------------------------------ */

/* Bit k: child k's box meets the query's. */
static unsigned meet_mask(const gnoi_tree_node *node, const gnoi_lbox *q)
{
    unsigned mask = 0;
#if defined(__SSE2__)
    __m128 u0 = _mm_set1_ps(q->u0), u1 = _mm_set1_ps(q->u1), w0 = _mm_set1_ps(q->v0), w1 = _mm_set1_ps(q->v1);
    __m128 z1 = _mm_set1_ps(q->z1);
    for (int k = 0; k < GNOI_TREE_FAN; k += 4) {
        __m128 u = _mm_and_ps(_mm_cmple_ps(_mm_loadu_ps(node->u0 + k), u1), _mm_cmpge_ps(_mm_loadu_ps(node->u1 + k), u0));
        __m128 w = _mm_and_ps(_mm_cmple_ps(_mm_loadu_ps(node->v0 + k), w1), _mm_cmpge_ps(_mm_loadu_ps(node->v1 + k), w0));
        __m128 z = _mm_cmple_ps(_mm_loadu_ps(node->z0 + k), z1);
        mask |= (unsigned)_mm_movemask_ps(_mm_and_ps(_mm_and_ps(u, w), z)) << k;
    }
#else
    for (int k = 0; k < GNOI_TREE_FAN; k++)
        mask |= (unsigned)(node->u0[k] <= q->u1 && node->u1[k] >= q->u0 && node->v0[k] <= q->v1 && node->v1[k] >= q->v0 &&
                           node->z0[k] <= q->z1) << k;
#endif
    return mask;
}

/* Bit k: triangle k of the leaf is not ruled out by the probe. Edges first, one comparison for all eight at a time. */
static unsigned probe_mask(const gnoi_tree_leaf *leaf, const gnoi_probe *probe)
{
    int32_t out[GNOI_TREE_FAN], behind[GNOI_TREE_FAN];
    float qa = (float)probe->qa, qb = (float)probe->qb;
    float qc = (float)(probe->qc + probe->qa * leaf->origin.u + probe->qb * leaf->origin.v - leaf->origin.q);
    unsigned mask = 0;
    for (int k = 0; k < GNOI_TREE_FAN; k++) {
        behind[k] = (leaf->q[0][k] <= qa * leaf->u[0][k] + qb * leaf->v[0][k] + qc) &
                    (leaf->q[1][k] <= qa * leaf->u[1][k] + qb * leaf->v[1][k] + qc) &
                    (leaf->q[2][k] <= qa * leaf->u[2][k] + qb * leaf->v[2][k] + qc);
    }
    for (int e = 0; e < probe->edge_count; e++) {
        float a = (float)probe->a[e], b = (float)probe->b[e];
        float limit = (float)(probe->slack[e] - (probe->c[e] + probe->a[e] * leaf->origin.u + probe->b[e] * leaf->origin.v));
        for (int k = 0; k < GNOI_TREE_FAN; k++)
            out[k] = (a * leaf->u[0][k] + b * leaf->v[0][k] <= limit) & (a * leaf->u[1][k] + b * leaf->v[1][k] <= limit) &
                     (a * leaf->u[2][k] + b * leaf->v[2][k] <= limit);
        for (int k = 0; k < GNOI_TREE_FAN; k++)
            behind[k] |= out[k];
    }
    for (int k = 0; k < GNOI_TREE_FAN; k++)
        mask |= (unsigned)!behind[k] << k;
    return mask;
}

static unsigned lowest_bit(unsigned mask)
{
#if defined(__GNUC__)
    return (unsigned)__builtin_ctz(mask);
#else
    unsigned k = 0;
    while (!(mask >> k & 1))
        k++;
    return k;
#endif
}

static int list_room(gno_context *context, gnoi_list *list, size_t more)
{
    return list->count + more <= list->capacity ||
           gnoi_reserve(context, (void **)&list->items, &list->capacity, list->count + more, sizeof *list->items);
}

/* Queries that share a front start at nodes of this level: 64 entries each. */
#define FRONT_LEVEL 1

int gnoi_tree_gather(gno_context *context, const gnoi_tree *tree, const gnoi_lbox *box, gnoi_tree_front *front)
{
    struct { int level; uint32_t node; } stack[GNOI_TREE_FAN * GNOI_TREE_LEVELS];
    int top = 0;
    front->nodes.count = 0;
    front->level = tree->levels - 1 < FRONT_LEVEL ? tree->levels - 1 : FRONT_LEVEL;
    if (tree->levels == 0)
        return 1;
    stack[top].level = tree->levels - 1;
    stack[top++].node = 0;
    while (top > 0) {
        int level = stack[--top].level;
        uint32_t node = stack[top].node;
        if (level == front->level) {
            if (!list_room(context, &front->nodes, 1))
                return 0;
            front->nodes.items[front->nodes.count++] = node;
            continue;
        }
        for (unsigned mask = meet_mask(&tree->nodes[tree->level_first[level] + node], box); mask; mask &= mask - 1) {
            stack[top].level = level - 1;
            stack[top++].node = node * GNOI_TREE_FAN + lowest_bit(mask);
        }
    }
    return 1;
}

static int query_node(gno_context *context, const gnoi_tree *tree, int level, uint32_t node, const gnoi_lbox *box,
                      const gnoi_probe *probe, gnoi_list *found)
{
    unsigned mask = meet_mask(&tree->nodes[tree->level_first[level] + node], box);
    if (level == 0 && mask) {
        if (probe)
            mask &= probe_mask(&tree->leaves[node], probe);
        if (!list_room(context, found, GNOI_TREE_FAN))
            return 0;
    }
    for (; mask; mask &= mask - 1) {
        uint32_t child = node * GNOI_TREE_FAN + lowest_bit(mask);
        if (level == 0)
            found->items[found->count++] = tree->caster[child];
        else if (!query_node(context, tree, level - 1, child, box, probe, found))
            return 0;
    }
    return 1;
}

int gnoi_tree_query(gno_context *context, const gnoi_tree *tree, const gnoi_tree_front *front, const gnoi_lbox *box,
                    const gnoi_probe *probe, gnoi_list *found)
{
    if (!front)
        return tree->levels == 0 || query_node(context, tree, tree->levels - 1, 0, box, probe, found);
    for (size_t i = 0; i < front->nodes.count; i++)
        if (!query_node(context, tree, front->level, front->nodes.items[i], box, probe, found))
            return 0;
    return 1;
}
