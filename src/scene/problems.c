/* problems.c -- what is wrong with the polygons of a scene: see gnomon_problems.h.
 *
 * Place in the data flow: gno_scene -> measure.c (what each polygon is) -> vertices at one place as one -> sums of edges (duplicates)
 * -> edges sorted by their ends -> runs of equal edges: open, crowded, or a tie between two polygons (flipped, flat parts) -> the caller's callback.
 * Invariants: nothing of the scene changes but what preparing it sets; every loop is linear but for the sorting of edges by digits.
 * Sources: sums of pseudo-random numbers as in solid.c; ties by union-find that keeps the parity to the root (Tarjan and van Leeuwen 1984).
 */
#include "base/sort.h"
#include "base/tolerance.h"
#include "scene/prepare.h"
#include "scene/weld.h"

#include <gnomon/gnomon_problems.h>
#include <string.h>

typedef struct edge {
    uint32_t low, high;    /* places of its ends */
    uint32_t polygon;
    uint32_t corner : 31;  /* that it leaves */
    uint32_t backward : 1; /* from high to low */
} edge;

typedef struct edge_sum {
    uint64_t sum[2];
    uint32_t count;
} edge_sum;

enum { LIES_ON_ANOTHER = 1, FLIPPED = 2, DUPLICATE = 4, LEFT_OVER = 8 };

typedef struct search {
    gno_scene *scene;
    gno_context *context;
    gno_problem_fn found;
    void *user;
    size_t counts[GNO_PROBLEM_KINDS];
    unsigned char *kinds, *marks;
    uint32_t *place;   /* of each vertex: the first vertex at its position */
    edge_sum *sums;
    uint32_t *parent, *group_flips, *group_size; /* of each polygon; the latter two at roots */
    unsigned char *parity;                        /* 1: wound against its parent */
    unsigned char *flat;                          /* at roots: the group lies in one plane */
    vec3 *area;                                   /* at roots: sum of the polygons' vector areas, each wound as the root */
    size_t edge_count;
    edge *edges;
    gnoi_keyed *keys, *scratch; /* of edges or polygons, whichever are more */
    size_t key_room;
} search;

static uint32_t root_of(const search *s, uint32_t p, unsigned *parity);

static int is_flat(const search *s, uint32_t p)
{
    unsigned parity;
    return s->flat[root_of(s, p, &parity)];
}

static int report(search *s, gno_problem_kind kind, size_t polygon, long other, int from, int to)
{
    gno_problem problem;
    s->counts[kind]++;
    problem.kind = kind;
    problem.polygon = polygon;
    problem.other = other;
    problem.vertex[0] = from;
    problem.vertex[1] = to;
    problem.border = kind == GNO_PROBLEM_OPEN_EDGE && is_flat(s, (uint32_t)polygon);
    return !s->found || s->found(s->user, &problem) == 0;
}

static uint64_t scramble(uint64_t x)
{
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return x ^ x >> 31;
}

/* ---- polygons that are wrong by themselves ---------------------------------------------------------------------------- */

static int report_kind(search *s, gnoi_kind kind, gno_problem_kind as)
{
    for (size_t p = 0; p < s->scene->polygon_count; p++) {
        if (((s->kinds[p] & GNOI_KIND_MASK) == kind && !report(s, as, p, -1, -1, -1)) || gnoi_stopped_at(s->context, p)) {
            return 0;
        }
    }
    return 1;
}

/* Details that were marked are known by their meshes, those that were found by the prepared polygons. */
static void mark_details(search *s)
{
    const gno_scene *scene = s->scene;
    for (size_t p = 0; p < scene->polygon_count; p++) {
        s->marks[p] = scene->objects[scene->polygon_object[p]].detail_of >= 0 ? LIES_ON_ANOTHER : 0;
    }
    for (size_t i = 0; i < scene->prepared.poly_count; i++) {
        if (scene->prepared.polys[i].detail) {
            s->marks[scene->prepared.polys[i].source] = LIES_ON_ANOTHER;
        }
    }
}

/* ---- edges ----------------------------------------------------------------------------------------------------------- */

/* Writes the edges of a polygon that have two ends; returns how many. */
static size_t edges_of(const search *s, size_t p, edge *edges)
{
    const gno_scene *scene = s->scene;
    size_t count = 0;
    for (unsigned ring = scene->polygon_start[p]; ring < scene->polygon_start[p + 1]; ring++) {
        unsigned from = scene->ring_start[ring], to = scene->ring_start[ring + 1];
        for (unsigned i = from; i < to; i++) {
            uint32_t v = s->place[scene->corner_vertex[i]], w = s->place[scene->corner_vertex[i + 1 < to ? i + 1 : from]];
            if (v != w) {
                edge *e = &edges[count++];
                e->low = v < w ? v : w;
                e->high = v < w ? w : v;
                e->polygon = (uint32_t)p;
                e->corner = i & 0x7fffffffu;
                e->backward = v > w;
            }
        }
    }
    return count;
}

/* The same set of edges gives the same sums, whatever the order and the winding; another one by chance once in 2^128. */
static edge_sum sum_of(const edge *edges, size_t count)
{
    edge_sum sum = {{0, 0}, (uint32_t)count};
    for (size_t i = 0; i < count; i++) {
        uint64_t pair = (uint64_t)edges[i].low << 32 | edges[i].high, h = scramble(pair + 0x9e3779b97f4a7c15u);
        sum.sum[0] += h;
        sum.sum[1] += scramble(h ^ pair * 0xd6e8feb86659fd93u);
    }
    return sum;
}

static int same_sum(const edge_sum *a, const edge_sum *b)
{
    return a->sum[0] == b->sum[0] && a->sum[1] == b->sum[1] && a->count == b->count;
}

/* Polygons of equal sums stand together once sorted, the first of them in front; marks the others and leaves the first's number in
 * `parent`. Polygons whose sums only share the digits sorted by are rare, so looking back over them costs nothing. */
static int find_duplicates(search *s)
{
    size_t count = 0, first = 0;
    for (size_t p = 0; p < s->scene->polygon_count; p++) {
        if (s->kinds[p] != GNOI_EMPTY) {
            s->keys[count].key = (uint32_t)s->sums[p].sum[0];
            s->keys[count++].value = (uint32_t)p;
        }
    }
    if (!gnoi_sort_asking(s->context, s->keys, s->scratch, count)) {
        return 0;
    }
    for (size_t i = 0; i < count; i++) {
        uint32_t p = s->keys[i].value;
        first = s->keys[i].key != s->keys[first].key ? i : first;
        for (size_t k = first; k < i; k++) {
            uint32_t q = s->keys[k].value;
            if (same_sum(&s->sums[p], &s->sums[q])) {
                s->marks[p] |= DUPLICATE | LIES_ON_ANOTHER;
                s->parent[p] = q;
                break;
            }
        }
        if (gnoi_stopped_at(s->context, i)) {
            return 0;
        }
    }
    for (size_t p = 0; p < s->scene->polygon_count; p++) {
        if ((s->marks[p] & DUPLICATE) && !report(s, GNO_PROBLEM_DUPLICATE, p, (long)s->parent[p], -1, -1)) {
            return 0;
        }
    }
    return 1;
}

/* Sums of all polygons, for which s->edges is scratch. */
static int sum_all(search *s)
{
    for (size_t p = 0; p < s->scene->polygon_count; p++) {
        s->sums[p] = sum_of(s->edges, edges_of(s, p, s->edges));
        if (gnoi_stopped_at(s->context, p)) {
            return 0;
        }
    }
    return 1;
}

/* By low, then high end: two stable passes. Leaves the order in s->keys. */
static int sort_edges(search *s)
{
    s->edge_count = 0;
    for (size_t p = 0; p < s->scene->polygon_count; p++) {
        if (!(s->marks[p] & LIES_ON_ANOTHER)) {
            s->edge_count += edges_of(s, p, s->edges + s->edge_count);
        }
        if (gnoi_stopped_at(s->context, p)) {
            return 0;
        }
    }
    for (size_t i = 0; i < s->edge_count; i++) {
        s->keys[i].key = s->edges[i].high;
        s->keys[i].value = (uint32_t)i;
    }
    if (!gnoi_sort_asking(s->context, s->keys, s->scratch, s->edge_count)) {
        return 0;
    }
    for (size_t i = 0; i < s->edge_count; i++) {
        s->keys[i].key = s->edges[s->keys[i].value].low;
    }
    return gnoi_sort_asking(s->context, s->keys, s->scratch, s->edge_count) && !gnoi_stopped(s->context);
}

static const edge *sorted(const search *s, size_t i)
{
    return &s->edges[s->keys[i].value];
}

/* One past the edges that have the ends of the i-th. */
static size_t end_of_run(const search *s, size_t i)
{
    size_t end = i + 1;
    while (end < s->edge_count && sorted(s, end)->low == sorted(s, i)->low && sorted(s, end)->high == sorted(s, i)->high) {
        end++;
    }
    return end;
}

/* ---- winding --------------------------------------------------------------------------------------------------------- */

/* Root of a polygon's group; *parity becomes the polygon's against the root. Paths are halved on the way. */
static uint32_t root_of(const search *s, uint32_t p, unsigned *parity)
{
    *parity = 0;
    while (s->parent[p] != p) {
        uint32_t up = s->parent[p];
        s->parity[p] ^= s->parity[up];
        s->parent[p] = s->parent[up];
        *parity ^= s->parity[p];
        p = s->parent[p];
    }
    return p;
}

/* The lower number stays root, so that a root is the first polygon of its group. */
static void tie(search *s, const edge *a, const edge *b)
{
    unsigned pa, pb;
    uint32_t ra = root_of(s, a->polygon, &pa), rb = root_of(s, b->polygon, &pb);
    unsigned differ = pa ^ pb ^ (a->backward == b->backward);
    if (ra < rb) {
        s->parent[rb] = ra;
        s->parity[rb] = (unsigned char)differ;
    } else if (rb < ra) {
        s->parent[ra] = rb;
        s->parity[ra] = (unsigned char)differ;
    }
}

static int tie_all(search *s)
{
    for (size_t p = 0; p < s->scene->polygon_count; p++) {
        s->parent[p] = (uint32_t)p;
    }
    for (size_t i = 0, end, step = 0; i < s->edge_count; i = end) {
        end = end_of_run(s, i);
        if (end - i == 2 && sorted(s, i)->polygon != sorted(s, i + 1)->polygon) {
            tie(s, sorted(s, i), sorted(s, i + 1));
        }
        if (gnoi_stopped_at(s->context, step++)) {
            return 0;
        }
    }
    return 1;
}

/* Marks the fewer of each group, then, where no winding suits all, one polygon of each edge left over. */
static int find_flipped(search *s)
{
    unsigned parity;
    for (size_t p = 0; p < s->scene->polygon_count; p++) {
        uint32_t root = root_of(s, (uint32_t)p, &parity);
        s->group_size[root]++;
        s->group_flips[root] += parity;
        if (gnoi_stopped_at(s->context, p)) {
            return 0;
        }
    }
    for (size_t p = 0; p < s->scene->polygon_count; p++) {
        uint32_t root = root_of(s, (uint32_t)p, &parity);
        unsigned turned = s->group_flips[root] > s->group_size[root] - s->group_flips[root];
        s->marks[p] |= parity != turned ? FLIPPED : 0;
    }
    for (size_t i = 0, end, step = 0; i < s->edge_count; i = end) {
        end = end_of_run(s, i);
        if (gnoi_stopped_at(s->context, step++)) {
            return 0;
        }
        const edge *a = sorted(s, i), *b = sorted(s, end - 1);
        if (end - i == 2 && a->polygon != b->polygon) {
            unsigned differ = a->backward == b->backward, turned = ((s->marks[a->polygon] ^ s->marks[b->polygon]) & FLIPPED) != 0;
            uint32_t later = a->polygon > b->polygon ? a->polygon : b->polygon;
            s->marks[later] |= differ != turned ? LEFT_OVER : 0;
        }
    }
    for (size_t p = 0; p < s->scene->polygon_count; p++) {
        if ((s->marks[p] & (FLIPPED | LEFT_OVER)) && !report(s, GNO_PROBLEM_FLIPPED, p, -1, -1, -1)) {
            return 0;
        }
    }
    return !gnoi_stopped(s->context);
}

/* ---- flat parts --------------------------------------------------------------------------------------------------------- */

static vec3 corner_at(const gno_scene *scene, unsigned corner)
{
    return v3_from(scene->positions[scene->corner_vertex[corner]]);
}

/* Vector area of a polygon's outer ring. */
static vec3 area_of(const gno_scene *scene, size_t p)
{
    unsigned ring = scene->polygon_start[p], first = scene->ring_start[ring], end = scene->ring_start[ring + 1];
    vec3 sum = v3(0, 0, 0);
    for (unsigned i = first + 1; i + 1 < end; i++) {
        vec3 origin = corner_at(scene, first);
        sum = v3_add(sum, v3_scale(v3_cross(v3_sub(corner_at(scene, i), origin), v3_sub(corner_at(scene, i + 1), origin)), 0.5));
    }
    return sum;
}

/* A group is flat when no corner leaves the plane across its area by more than what still counts as coplanar in the scene. */
static int find_flat(search *s)
{
    const gno_scene *scene = s->scene;
    unsigned parity;
    for (size_t p = 0; p < scene->polygon_count; p++) {
        uint32_t root = root_of(s, (uint32_t)p, &parity);
        s->area[root] = v3_add(s->area[root], v3_scale(area_of(scene, p), parity ? -1 : 1));
        s->flat[root] = 1;
        if (gnoi_stopped_at(s->context, p)) {
            return 0;
        }
    }
    for (size_t p = 0; p < scene->polygon_count; p++) {
        uint32_t root = root_of(s, (uint32_t)p, &parity);
        vec3 n = v3_unit(s->area[root]), origin = corner_at(scene, scene->ring_start[scene->polygon_start[root]]);
        for (unsigned i = scene->ring_start[scene->polygon_start[p]]; i < scene->ring_start[scene->polygon_start[p + 1]]; i++) {
            s->flat[root] &= fabs(v3_dot(n, v3_sub(corner_at(scene, i), origin))) <= GNOI_COPLANAR * scene->prepared.scale;
        }
        if (gnoi_stopped_at(s->context, p)) {
            return 0;
        }
    }
    return 1;
}

/* ---- gaps and crowds --------------------------------------------------------------------------------------------------- */

static int report_edge(search *s, gno_problem_kind kind, size_t i, long other)
{
    const gno_scene *scene = s->scene;
    const edge *e = sorted(s, i);
    unsigned ring = scene->polygon_start[e->polygon], end = scene->polygon_start[e->polygon + 1], from = e->corner, to;
    while (ring + 1 < end) { /* the ring the corner is of is among [ring, end) */
        unsigned middle = ring + (end - ring) / 2;
        if (scene->ring_start[middle] <= from) {
            ring = middle;
        } else {
            end = middle;
        }
    }
    to = from + 1 < scene->ring_start[ring + 1] ? from + 1 : scene->ring_start[ring];
    return report(s, kind, e->polygon, other, scene->corner_vertex[from], scene->corner_vertex[to]);
}

static int report_edges(search *s, gno_problem_kind kind)
{
    for (size_t i = 0, end, step = 0; i < s->edge_count; i = end) {
        size_t backward = 0, k;
        int good = 1;
        end = end_of_run(s, i);
        for (k = i; k < end; k++) {
            backward += sorted(s, k)->backward;
        }
        if (kind == GNO_PROBLEM_OPEN_EDGE && end - i == 1) {
            good = report_edge(s, kind, i, -1);
        } else if (kind == GNO_PROBLEM_CROWDED_EDGE && end - i > 2 && 2 * backward != end - i) {
            good = report_edge(s, kind, i, (long)sorted(s, i + 1)->polygon);
        }
        if (!good || gnoi_stopped_at(s->context, step++)) {
            return 0;
        }
    }
    return 1;
}

/* ---- the whole --------------------------------------------------------------------------------------------------------- */

static int allocate(search *s)
{
    const gno_scene *scene = s->scene;
    gno_context *context = s->context;
    s->key_room = scene->corner_count > scene->polygon_count ? scene->corner_count : scene->polygon_count;
    s->kinds = gnoi_malloc(context, scene->polygon_count, 1);
    s->marks = gnoi_calloc(context, scene->polygon_count, 1);
    s->parity = gnoi_calloc(context, scene->polygon_count, 1);
    s->flat = gnoi_calloc(context, scene->polygon_count, 1);
    s->area = gnoi_calloc(context, scene->polygon_count, sizeof *s->area);
    s->parent = gnoi_malloc(context, scene->polygon_count, sizeof *s->parent);
    s->group_size = gnoi_calloc(context, scene->polygon_count, sizeof *s->group_size);
    s->group_flips = gnoi_calloc(context, scene->polygon_count, sizeof *s->group_flips);
    s->sums = gnoi_malloc(context, scene->polygon_count, sizeof *s->sums);
    s->place = gnoi_malloc(context, scene->vertex_count, sizeof *s->place);
    s->edges = gnoi_malloc(context, scene->corner_count, sizeof *s->edges);
    s->keys = gnoi_malloc(context, s->key_room, sizeof *s->keys);
    s->scratch = gnoi_malloc(context, s->key_room, sizeof *s->scratch);
    return s->kinds && s->marks && s->parity && s->flat && s->area && s->parent && s->group_size && s->group_flips && s->sums && s->place &&
           s->edges && s->keys && s->scratch;
}

static void release(search *s)
{
    const gno_scene *scene = s->scene;
    gno_context *context = s->context;
    gnoi_free(context, s->kinds, scene->polygon_count, 1);
    gnoi_free(context, s->marks, scene->polygon_count, 1);
    gnoi_free(context, s->parity, scene->polygon_count, 1);
    gnoi_free(context, s->flat, scene->polygon_count, 1);
    gnoi_free(context, s->area, scene->polygon_count, sizeof *s->area);
    gnoi_free(context, s->parent, scene->polygon_count, sizeof *s->parent);
    gnoi_free(context, s->group_size, scene->polygon_count, sizeof *s->group_size);
    gnoi_free(context, s->group_flips, scene->polygon_count, sizeof *s->group_flips);
    gnoi_free(context, s->sums, scene->polygon_count, sizeof *s->sums);
    gnoi_free(context, s->place, scene->vertex_count, sizeof *s->place);
    gnoi_free(context, s->edges, scene->corner_count, sizeof *s->edges);
    gnoi_free(context, s->keys, s->key_room, sizeof *s->keys);
    gnoi_free(context, s->scratch, s->key_room, sizeof *s->scratch);
}

static int find_all(search *s)
{
    mark_details(s);
    return report_kind(s, GNOI_EMPTY, GNO_PROBLEM_DEGENERATE) && report_kind(s, GNOI_SPLIT, GNO_PROBLEM_NON_PLANAR) &&
           sum_all(s) && find_duplicates(s) && sort_edges(s) && tie_all(s) && find_flipped(s) && find_flat(s) &&
           report_edges(s, GNO_PROBLEM_OPEN_EDGE) && report_edges(s, GNO_PROBLEM_CROWDED_EDGE);
}

gno_status gno_scene_find_problems(gno_scene *scene, int threads, gno_problem_fn found, void *user, size_t counts[GNO_PROBLEM_KINDS])
{
    search s;
    gnoi_measures measures;
    gno_status status = gno_scene_prepare(scene, threads, NULL);
    if (status != GNO_OK) {
        return status;
    }
    memset(&s, 0, sizeof s);
    s.scene = scene;
    s.context = scene->context;
    s.found = found;
    s.user = user;
    if (!allocate(&s)) {
        status = gnoi_fail(s.context, GNO_ERROR_MEMORY, "gno_scene_find_problems: out of memory");
    } else {
        status = gnoi_measure_scene(scene, threads, s.kinds, NULL, &measures);
        if (status == GNO_OK)
            status = gnoi_weld(s.context, threads, scene->vertex_count, (const double(*)[3])scene->positions, s.place);
        if (status == GNO_OK && !find_all(&s)) {
            status = gnoi_fail(s.context, GNO_ERROR_CANCELLED, "gno_scene_find_problems: stopped by the caller");
        }
    }
    release(&s);
    if (status == GNO_OK && counts) {
        memcpy(counts, s.counts, sizeof s.counts);
    }
    return status;
}
