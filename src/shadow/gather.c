/* gather.c -- see gather.h. */
#include "shadow/gather.h"
#include <string.h>

/* Bit k: box k ends before depth z. */
static unsigned before_mask(const gnoi_eight *boxes, float z)
{
    unsigned mask = 0;
#if defined(__SSE2__)
    for (int k = 0; k < GNOI_EIGHT; k += 4)
        mask |= (unsigned)_mm_movemask_ps(_mm_cmplt_ps(_mm_loadu_ps(boxes->z1 + k), _mm_set1_ps(z))) << k;
#else
    for (int k = 0; k < GNOI_EIGHT; k++)
        mask |= (unsigned)(boxes->z1[k] < z) << k;
#endif
    return mask;
}

static int make_room(gno_context *context, gnoi_gathered *g)
{
    return gnoi_reserve(context, (void **)&g->boxes, &g->box_capacity, g->count / GNOI_EIGHT + 2, sizeof *g->boxes) &&
           gnoi_reserve(context, (void **)&g->held, &g->held_capacity, g->count + GNOI_EIGHT, sizeof *g->held);
}

static void append(gnoi_gathered *g, const gnoi_eight *from, unsigned k, gnoi_held held)
{
    gnoi_eight *to = &g->boxes[g->count / GNOI_EIGHT];
    size_t at = g->count % GNOI_EIGHT;
    if (at == 0)
        gnoi_eight_clear(to);
    to->u0[at] = from->u0[k];
    to->u1[at] = from->u1[k];
    to->v0[at] = from->v0[k];
    to->v1[at] = from->v1[k];
    to->z0[at] = from->z0[k];
    to->z1[at] = from->z1[k];
    g->held[g->count++] = held;
}

static float side_of(const gnoi_eight *boxes, unsigned k)
{
    float du = boxes->u1[k] - boxes->u0[k], dv = boxes->v1[k] - boxes->v0[k];
    return du > dv ? du : dv;
}

/* What is yet to be parted. */
typedef struct parting {
    gno_context *context;
    const gnoi_lbox *box;
    gnoi_grain grain;
    gnoi_gathered *to;
    int top;
    gnoi_held stack[GNOI_TREE_FAN * (GNOI_TREE_LEVELS + 1)];
} parting;

static const gnoi_eight *children_of(const gnoi_tree *tree, gnoi_held h) { return &tree->nodes[tree->level_first[h.level] + h.node]; }

/* Of eight bits: pairs, then fours, then all of them added up. */
static unsigned count_bits(unsigned mask)
{
    mask -= mask >> 1 & 0x55;
    mask = (mask & 0x33) + (mask >> 2 & 0x33);
    return (mask + (mask >> 4)) & 15;
}

/* One node whose box meets the group's. early: it ends before the group. */
static void take(parting *p, const gnoi_eight *boxes, unsigned k, gnoi_held h, int early)
{
    if (early && p->grain.before) {
        append(p->to, boxes, k, h);
    } else if (h.level == 0) {
        const gnoi_eight *children = children_of(p->to->tree, h);
        unsigned mask = gnoi_eight_meet(children, p->box);
        if (!mask)
            return;
        p->to->level += count_bits(mask & ~before_mask(children, p->box->z0));
        append(p->to, boxes, k, h);
    } else if (side_of(boxes, k) > p->grain.side) {
        p->stack[p->top++] = h;
    } else {
        p->to->level += !early;
        append(p->to, boxes, k, h);
    }
}

/* Eight boxes: `held` gives what they are, or all are children of `parent`. */
static int take_eight(parting *p, const gnoi_eight *boxes, const gnoi_held *held, gnoi_held parent)
{
    unsigned mask = gnoi_eight_meet(boxes, p->box), before;
    if (!mask)
        return 1;
    if (!make_room(p->context, p->to))
        return 0;
    before = before_mask(boxes, p->box->z0);
    /* Children that will be looked at are asked for all at once: each is a wait of its own otherwise. */
    for (unsigned left = p->grain.before ? mask & ~before : mask; left; left &= left - 1) {
        const unsigned k = gnoi_lowest_bit(left);
        const gnoi_held child = {parent.node * GNOI_TREE_FAN + k, parent.level - 1}, h = held ? held[k] : child;
        if (h.level == 0 || side_of(boxes, k) > p->grain.side)
            gnoi_eight_fetch(children_of(p->to->tree, h));
    }
    for (; mask; mask &= mask - 1) {
        unsigned k = gnoi_lowest_bit(mask);
        const gnoi_held child = {parent.node * GNOI_TREE_FAN + k, parent.level - 1};
        take(p, boxes, k, held ? held[k] : child, before >> k & 1);
    }
    return 1;
}

static int part_stack(parting *p)
{
    while (p->top > 0) {
        gnoi_held h = p->stack[--p->top];
        if (!take_eight(p, children_of(p->to->tree, h), NULL, h))
            return 0;
    }
    return 1;
}

/* The node at the root has no box beside it. */
static int take_root(parting *p)
{
    const gnoi_tree *tree = p->to->tree;
    const gnoi_held root = {0, tree->levels - 1};
    gnoi_eight box;
    gnoi_lbox all;
    if (tree->levels == 0)
        return 1;
    if (!make_room(p->context, p->to))
        return 0;
    all = gnoi_eight_union(children_of(tree, root));
    gnoi_eight_clear(&box);
    gnoi_eight_set(&box, 0, &all);
    if (gnoi_eight_meet(&box, p->box))
        take(p, &box, 0, root, all.z1 < p->box->z0);
    return part_stack(p);
}

int gnoi_gather(gno_context *context, const gnoi_tree *tree, const gnoi_gathered *whole, const gnoi_lbox *box, gnoi_grain grain,
                gnoi_gathered *g)
{
    const gnoi_held none = {0, 0};
    parting p;
    p.context = context;
    p.box = box;
    p.grain = grain;
    p.to = g;
    p.top = 0;
    g->tree = tree;
    g->count = g->level = 0;
    if (!whole)
        return take_root(&p);
    for (size_t first = 0; first < whole->count; first += GNOI_EIGHT)
        if (!take_eight(&p, &whole->boxes[first / GNOI_EIGHT], whole->held + first, none) || !part_stack(&p))
            return 0;
    return 1;
}

/* Whether the polygon's plane is nowhere on the box nearer than the box's farthest depth. Nearness is linear over the box. */
static int is_behind(const gnoi_frame *frame, const gnoi_poly *poly, const gnoi_lbox *box)
{
    for (int i = 0; i < 4; i++) {
        vec3 from, along, n = v3_from(poly->n);
        double depth;
        gnoi_frame_ray(frame, (double)(i & 1 ? box->u1 : box->u0), (double)(i & 2 ? box->v1 : box->v0), &from, &along);
        depth = -(v3_dot(n, from) + poly->d) / v3_dot(n, along);
        if (!(depth >= (double)box->z1) && (frame->parallel || !(depth < 0)))
            return 0;
    }
    return 1;
}

static int all_behind(const gno_scene *scene, const gnoi_tree *tree, gnoi_held h, const gnoi_lbox *box)
{
    unsigned mask = gnoi_eight_meet(children_of(tree, h), box);
    for (; mask; mask &= mask - 1)
        if (!is_behind(&tree->frame, &scene->prepared.polys[tree->caster[h.node * GNOI_TREE_FAN + gnoi_lowest_bit(mask)]], box))
            return 0;
    return 1;
}

void gnoi_gathered_drop_behind(const gno_scene *scene, const gnoi_lbox *box, gnoi_gathered *g)
{
    const gnoi_frame *frame = &g->tree->frame;
    size_t count = g->count;
    if (gnoi_frame_face(frame, (double)box->u0) != gnoi_frame_face(frame, (double)box->u1))
        return;
    g->count = 0;
    for (size_t first = 0; first < count; first += GNOI_EIGHT) {
        const gnoi_eight from = g->boxes[first / GNOI_EIGHT]; /* a copy: what stays is written over it */
        for (size_t i = first; i < count && i < first + GNOI_EIGHT; i++) {
            gnoi_held held = g->held[i];
            if (held.level > 0 || !all_behind(scene, g->tree, held, box))
                append(g, &from, (unsigned)(i - first), held);
        }
    }
}

void gnoi_gathered_free(gno_context *context, gnoi_gathered *g)
{
    gnoi_free(context, g->boxes, g->box_capacity, sizeof *g->boxes);
    gnoi_free(context, g->held, g->held_capacity, sizeof *g->held);
    memset(g, 0, sizeof *g);
}

/* Appends what meets the box in a lowest node. */
static int query_node(gno_context *context, const gnoi_tree *tree, uint32_t node, const gnoi_lbox *box, const gnoi_probe *probe,
                      gnoi_list *found, int *before)
{
    unsigned mask = gnoi_eight_meet(&tree->nodes[node], box);
    if (mask && before) {
        unsigned early = mask & before_mask(&tree->nodes[node], box->z0);
        *before |= early != 0;
        mask &= ~early;
    }
    if (mask && probe && tree->leaves)
        mask &= gnoi_leaf_mask(&tree->leaves[node], probe);
    if (mask && !gnoi_reserve(context, (void **)&found->items, &found->capacity, found->count + GNOI_TREE_FAN, sizeof *found->items))
        return 0;
    for (; mask; mask &= mask - 1)
        found->items[found->count++] = tree->caster[node * GNOI_TREE_FAN + gnoi_lowest_bit(mask)];
    return 1;
}

int gnoi_gathered_query(gno_context *context, const gnoi_gathered *g, const gnoi_lbox *box, const gnoi_probe *probe, gnoi_list *found,
                        int *before)
{
    for (size_t first = 0; first < g->count; first += GNOI_EIGHT) {
        const gnoi_eight *boxes = &g->boxes[first / GNOI_EIGHT];
        unsigned mask = gnoi_eight_meet(boxes, box);
        if (mask && before) {
            unsigned early = mask & before_mask(boxes, box->z0);
            *before |= early != 0;
            mask &= ~early;
        }
        for (; mask; mask &= mask - 1)
            if (!query_node(context, g->tree, g->held[first + gnoi_lowest_bit(mask)].node, box, probe, found, before))
                return 0;
    }
    return 1;
}
