/* contour.c -- see contour.h. The far sides' directed edges are put into a bucket for each vertex (the lower of their two) and
 * cancelled against their reverses there; what is left is the contour. */
#include "shadow/contour.h"
#include <string.h>

/* Half an edge in the bucket of its lower vertex. */
typedef struct half_edge {
    uint32_t other; /* the higher vertex */
    uint32_t poly;
    uint32_t up;    /* 1: runs from the lower vertex to the higher */
} half_edge;

typedef struct buckets {
    gno_context *context;
    size_t vertex_count, half_count;
    uint32_t *start; /* vertex_count + 1 */
    half_edge *halves;
} buckets;

static void buckets_free(buckets *b)
{
    gnoi_free(b->context, b->start, b->vertex_count + 2, sizeof *b->start);
    gnoi_free(b->context, b->halves, b->half_count, sizeof *b->halves);
}

/* Counts every directed edge of the polygon, or puts it into its bucket. */
static void visit_edges(const gnoi_prepared *prep, uint32_t index, buckets *b, int fill)
{
    const gnoi_poly *poly = &prep->polys[index];
    const uint32_t *corner = prep->corner_vertex + poly->corner;
    int outwards = prep->solids[gnoi_solid_of(prep, poly)].outwards;
    for (uint32_t k = 0; k < poly->corner_count; k++) {
        uint32_t v = corner[k], w = corner[k + 1 < poly->corner_count ? k + 1 : 0], low = v < w ? v : w;
        half_edge *h;
        if (v == w)
            continue;
        if (!fill) {
            b->start[low + 2]++;
            b->half_count++;
            continue;
        }
        h = &b->halves[b->start[low + 1]++];
        h->other = v < w ? w : v;
        h->poly = index;
        h->up = (uint32_t)((v < w) == (outwards != 0));
    }
}

/* Polygons are visited in their own order, which is that of neighbours in space. */
static int fill_buckets(const gnoi_prepared *prep, const unsigned char *is_far, buckets *b)
{
    b->vertex_count = prep->vertex_count;
    b->start = gnoi_calloc(b->context, b->vertex_count + 2, sizeof *b->start);
    if (!b->start)
        return 0;
    for (uint32_t i = 0; i < prep->poly_count; i++)
        if (is_far[i])
            visit_edges(prep, i, b, 0);
    for (size_t v = 2; v < b->vertex_count + 2; v++)
        b->start[v] += b->start[v - 1];
    b->halves = gnoi_malloc(b->context, b->half_count, sizeof *b->halves);
    if (!b->halves)
        return 0;
    for (uint32_t i = 0; i < prep->poly_count; i++)
        if (is_far[i])
            visit_edges(prep, i, b, 1);
    return 1;
}

/* By the higher vertex. Buckets hold a handful, but for the tips of large fans: Shell's gaps keep those from growing quadratic. */
static void sort_halves(half_edge *h, size_t count)
{
    static const size_t gaps[] = {29524, 9841, 3280, 1093, 364, 121, 40, 13, 4, 1};
    for (size_t g = count < 5 ? sizeof gaps / sizeof *gaps - 1 : 0; g < sizeof gaps / sizeof *gaps; g++)
        for (size_t i = gaps[g]; i < count; i++) {
            half_edge v = h[i];
            size_t k = i;
            for (; k >= gaps[g] && h[k - gaps[g]].other > v.other; k -= gaps[g])
                h[k] = h[k - gaps[g]];
            h[k] = v;
        }
}

/* What a run of halves between the same two vertices leaves over goes to the contour. */
static int keep_rest(gnoi_casters *c, gno_context *context, uint32_t low, const half_edge *h, size_t count)
{
    size_t up = 0, rest;
    uint32_t way;
    for (size_t i = 0; i < count; i++)
        up += h[i].up;
    way = 2 * up > count;
    rest = way ? 2 * up - count : count - 2 * up;
    if (!gnoi_reserve(context, (void **)&c->edges, &c->edge_capacity, c->edge_count + rest, sizeof *c->edges))
        return 0;
    for (size_t i = 0; i < count && rest > 0; i++)
        if (h[i].up == way) {
            gnoi_contour_edge *e = &c->edges[c->edge_count++];
            e->from = way ? low : h[i].other;
            e->to = way ? h[i].other : low;
            e->poly = h[i].poly;
            rest--;
        }
    return 1;
}

static int cancel(gnoi_casters *c, const buckets *b)
{
    for (uint32_t v = 0; v < b->vertex_count; v++) {
        half_edge *h = b->halves + b->start[v];
        size_t count = b->start[v + 1] - b->start[v], run;
        sort_halves(h, count);
        for (size_t i = 0; i < count; i += run) {
            for (run = 1; i + run < count && h[i + run].other == h[i].other; run++)
                ;
            if (!keep_rest(c, b->context, v, h + i, run))
                return 0;
        }
    }
    return 1;
}

static int collect_edges(const gno_scene *scene, const gnoi_casters *c, gnoi_boxes *boxes)
{
    for (size_t i = 0; i < c->edge_count; i++) {
        vec3 ends[2] = {v3_from(scene->prepared.positions[c->edges[i].from]), v3_from(scene->prepared.positions[c->edges[i].to])};
        gnoi_lbox box[6];
        int n = gnoi_frame_boxes(&c->rim.frame, ends, 2, box);
        if (!gnoi_boxes_reserve(boxes, 6))
            return 0;
        for (int k = 0; k < n; k++) {
            boxes->box[boxes->count] = box[k];
            boxes->number[boxes->count++] = (uint32_t)i;
        }
    }
    return 1;
}

static gno_status build_rim(const gno_scene *scene, gnoi_casters *c)
{
    gnoi_boxes boxes = {0};
    gno_status status = GNO_ERROR_MEMORY;
    boxes.context = scene->context;
    c->rim.frame = c->far.frame;
    if (collect_edges(scene, c, &boxes))
        status = gnoi_tree_pack(scene->context, &boxes, NULL, &c->rim);
    gnoi_boxes_free(&boxes);
    return status;
}

static gno_status build_contour(const gno_scene *scene, gnoi_casters *c)
{
    const size_t count = scene->prepared.poly_count;
    unsigned char *is_far = gnoi_calloc(scene->context, count, 1);
    buckets b = {0};
    int good;
    b.context = scene->context;
    for (size_t i = 0; is_far && i < c->far.entry_count; i++)
        is_far[c->far.caster[i]] = 1;
    good = is_far && fill_buckets(&scene->prepared, is_far, &b) && cancel(c, &b);
    gnoi_free(scene->context, is_far, count, 1);
    buckets_free(&b);
    return good ? build_rim(scene, c) : GNO_ERROR_MEMORY;
}

gno_status gnoi_casters_build(const gno_scene *scene, const gnoi_lamp *lamp, const unsigned char *halved, gnoi_casters *c)
{
    gno_status status;
    memset(c, 0, sizeof *c);
    status = gnoi_tree_build_part(scene, lamp, halved, GNOI_TREE_SINGLE, &c->single);
    if (!status && halved)
        status = gnoi_tree_build_part(scene, lamp, halved, GNOI_TREE_FAR, &c->far);
    if (!status && c->far.entry_count)
        status = build_contour(scene, c);
    if (status)
        gnoi_casters_free(scene->context, c);
    return status;
}

void gnoi_casters_free(gno_context *context, gnoi_casters *c)
{
    gnoi_tree_free(context, &c->single);
    gnoi_tree_free(context, &c->far);
    gnoi_tree_free(context, &c->rim);
    gnoi_free(context, c->edges, c->edge_capacity, sizeof *c->edges);
    c->edges = NULL;
    c->edge_count = c->edge_capacity = 0;
}
