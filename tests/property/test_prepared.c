/* test_prepared.c -- random meshes (support/random_mesh.h) prepared, against obvious twins: what becomes of each polygon, the order in
 * space, the numbering by first use, normals, connected parts and whether they are closed, boundaries; and the same bytes for any number of
 * threads. GNOMON_ROUNDS: number of meshes (default 150).
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "scene/boundary.h"
#include "scene/prepare.h"
#include "support/random_mesh.h"
#include "support/random_scene.h"
#include "support/weld_twin.h"

#include <stdlib.h>
#include <string.h>

static int rounds(void)
{
    const char *text = getenv("GNOMON_ROUNDS");
    return text && atoi(text) > 0 ? atoi(text) : 150;
}

/* ---- twins of the polygons --------------------------------------------------------------------------------------------------- */

static vec3 corner_position(const gno_scene *s, size_t corner) { return v3_from(s->positions[s->corner_vertex[corner]]); }

/* Whole coordinates: exact. */
static vec3 twin_normal(const gno_scene *s, size_t p)
{
    unsigned ring = s->polygon_start[p], from = s->ring_start[ring], to = s->ring_start[ring + 1];
    vec3 sum = v3(0, 0, 0);
    for (unsigned i = from; i < to && to - from >= 3; i++)
        sum = v3_add(sum, v3_cross(corner_position(s, i), corner_position(s, i + 1 < to ? i + 1 : from)));
    return sum;
}

static int twin_planar(const gno_scene *s, size_t p)
{
    vec3 n = twin_normal(s, p);
    unsigned first = s->ring_start[s->polygon_start[p]];
    for (unsigned ring = s->polygon_start[p]; ring < s->polygon_start[p + 1]; ring++)
        for (unsigned i = s->ring_start[ring]; i < s->ring_start[ring + 1] && s->ring_start[ring + 1] - s->ring_start[ring] >= 3; i++)
            if (v3_dot(n, v3_sub(corner_position(s, i), corner_position(s, first))) != 0)
                return 0;
    return 1;
}

static vec3 at(const gnoi_prepared *q, size_t corner) { return v3_from(q->positions[q->corner_vertex[corner]]); }
static int same_place(vec3 a, vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

/* A kept polygon has its source's corners, ring by ring; a split one's triangles have some of them. */
static void check_polygon(const gno_scene *s, const gnoi_poly *poly)
{
    const gnoi_prepared *q = &s->prepared;
    uint32_t corner = poly->corner, ring = poly->ring;
    vec3 normal = twin_normal(s, poly->source);
    assert_true(v3_dot(normal, normal) > 0);
    assert_int_equal(q->ring_corner[poly->ring], poly->corner);
    assert_int_equal(q->ring_corner[poly->ring + poly->ring_count], poly->corner + poly->corner_count);
    if (!twin_planar(s, poly->source)) {
        assert_int_equal(poly->corner_count, 3);
        return;
    }
    assert_true(v3_length(v3_sub(v3_unit(normal), v3_from(poly->n))) < 1e-12);
    assert_true(fabs(v3_dot(v3_from(poly->n), at(q, poly->corner)) + poly->d) < 1e-10);
    for (unsigned r = s->polygon_start[poly->source]; r < s->polygon_start[poly->source + 1]; r++) {
        if (s->ring_start[r + 1] - s->ring_start[r] < 3)
            continue;
        assert_int_equal(q->ring_corner[ring++], corner);
        for (unsigned i = s->ring_start[r]; i < s->ring_start[r + 1]; i++)
            assert_true(same_place(at(q, corner++), corner_position(s, i)));
    }
    assert_int_equal(corner, poly->corner + poly->corner_count);
    assert_int_equal(ring, poly->ring + poly->ring_count);
}

/* The cells lie within three standard deviations of a sample of the vertices, and within the scene's bounds; 128 along the longest side. */
typedef struct cells {
    double lower[3], extent;
} cells;

static cells twin_cells(const gno_scene *s)
{
    const gnoi_prepared *q = &s->prepared;
    const size_t step = s->vertex_count / 4096 + 1;
    cells c = {{0, 0, 0}, 0};
    for (int k = 0; k < 3; k++) {
        double middle = (q->lower[k] + q->upper[k]) / 2, sum = 0, squares = 0, count = 0, reach;
        for (size_t v = 0; v < s->vertex_count; v += step) {
            sum += s->positions[v][k] - middle;
            squares += (s->positions[v][k] - middle) * (s->positions[v][k] - middle);
            count++;
        }
        reach = 3 * sqrt(fmax(squares / count - sum / count * (sum / count), 0));
        c.lower[k] = fmax(q->lower[k], middle + sum / count - reach);
        c.extent = fmax(c.extent, fmin(q->upper[k], middle + sum / count + reach) - c.lower[k]);
    }
    return c;
}

static unsigned twin_place(const cells *c, vec3 p)
{
    const double x[3] = {p.x, p.y, p.z};
    unsigned key = 0;
    for (int bit = 6; bit >= 0; bit--)
        for (int k = 2; k >= 0; k--)
            key = 2 * key + ((unsigned)fmin(fmax(128 / c->extent * (x[k] - c->lower[k]), 0), 127) >> bit & 1u);
    return key;
}

/* Every source with area appears, in the order of space, equal places in the order of sources. */
static void check_order(const gno_scene *s)
{
    const gnoi_prepared *q = &s->prepared;
    const cells c = twin_cells(s);
    unsigned char *seen = calloc(s->polygon_count + 1, 1);
    assert_non_null(seen);
    for (size_t i = 0; i < q->poly_count; i++) {
        seen[q->polys[i].source] = 1;
        if (i > 0 && q->poly_count >= 1024) {
            unsigned before = twin_place(&c, at(q, q->polys[i - 1].corner)), own = twin_place(&c, at(q, q->polys[i].corner));
            assert_true(before < own || (before == own && q->polys[i - 1].source <= q->polys[i].source));
        } else if (i > 0) {
            assert_true(q->polys[i - 1].source <= q->polys[i].source);
        }
    }
    for (size_t p = 0; p < s->polygon_count; p++) {
        vec3 n = twin_normal(s, p);
        assert_int_equal(seen[p], v3_dot(n, n) > 0);
    }
    free(seen);
}

/* Vertices and normals are numbered by first use; chunks and seams are what they are said to be. */
static void check_numbers(const gno_scene *s)
{
    const gnoi_prepared *q = &s->prepared;
    uint32_t next = 0, *twin = weld_twin((const double(*)[3])q->positions, q->vertex_count);
    size_t seams = 0;
    assert_non_null(twin);
    for (size_t v = 0; v < q->vertex_count; v++)
        assert_int_equal(twin[v], v); /* no two at one place */
    free(twin);
    for (size_t i = 0; i < q->poly_count; i++) {
        uint32_t own = q->chunk_vertex[i / GNOI_CHUNK];
        int seam = 0;
        if (i % GNOI_CHUNK == 0)
            assert_int_equal(own, next);
        for (uint32_t k = q->polys[i].corner; k < q->polys[i].corner + q->polys[i].corner_count; k++) {
            assert_true(q->corner_vertex[k] <= next);
            next += q->corner_vertex[k] == next;
            seam |= q->corner_vertex[k] < own;
        }
        if (seam) {
            assert_true(seams < q->seam_count);
            assert_int_equal(q->seams[seams++], i);
        }
    }
    assert_int_equal(next, q->vertex_count);
    assert_int_equal(seams, q->seam_count);
    assert_int_equal(q->chunk_vertex[q->chunk_count], next);
}

/* ---- twin of the normals ------------------------------------------------------------------------------------------------------- */

static const gnoi_object *object_of(const gno_scene *s, const gnoi_poly *poly) { return &s->objects[s->polygon_object[poly->source]]; }

/* The ring of a corner. */
static void ring_of(const gnoi_prepared *q, const gnoi_poly *poly, uint32_t corner, uint32_t *from, uint32_t *count)
{
    uint32_t r = poly->ring;
    while (q->ring_corner[r + 1] <= corner)
        r++;
    *from = q->ring_corner[r];
    *count = q->ring_corner[r + 1] - *from;
}

static double twin_weight(const gno_scene *s, const gnoi_poly *poly, uint32_t corner)
{
    const gnoi_prepared *q = &s->prepared;
    uint32_t from, count, k;
    vec3 here = at(q, corner), after, before, sum = v3(0, 0, 0);
    ring_of(q, poly, corner, &from, &count);
    k = corner - from;
    if (same_place(at(q, from + (k + count - 1) % count), here))
        return 0;
    if (object_of(s, poly)->weighting == GNO_WEIGHTING_EQUAL)
        return 1;
    if (object_of(s, poly)->weighting == GNO_WEIGHTING_AREA) {
        uint32_t end = q->ring_corner[poly->ring + 1];
        for (uint32_t i = poly->corner; i < end; i++)
            sum = v3_add(sum, v3_cross(at(q, i), at(q, i + 1 < end ? i + 1 : poly->corner)));
        return v3_length(sum);
    }
    for (k = (k + 1) % count; same_place(at(q, from + k), here) && from + k != corner; k = (k + 1) % count)
        ;
    after = v3_sub(at(q, from + k), here);
    for (k = corner - from + count - 1; same_place(at(q, from + k % count), here) && from + k % count != corner; k--)
        ;
    before = v3_sub(at(q, from + k % count), here);
    sum = v3_cross(after, before);
    if (from == poly->corner && v3_dot(sum, v3_from(poly->n)) < 0)
        return 2 * acos(-1.0) - atan2(v3_length(sum), v3_dot(after, before));
    return atan2(v3_length(sum), v3_dot(after, before));
}

/* The normal that a corner must have; *sure: it is no matter of rounding. source_normal: of the corner, or -1. */
static vec3 expected_normal(const gno_scene *s, size_t i, uint32_t corner, int source_normal, int *sure)
{
    const gnoi_prepared *q = &s->prepared;
    const gnoi_object *o = object_of(s, &q->polys[i]);
    vec3 own = v3_from(q->polys[i].n), sum = v3(0, 0, 0);
    double total = 0;
    *sure = 1;
    if (source_normal >= 0 && !o->average_normals) {
        vec3 n = v3_from(s->normals[source_normal]);
        return v3_dot(n, n) > 0 ? v3_unit(n) : own;
    }
    for (size_t j = 0; j < q->poly_count; j++)
        for (uint32_t k = q->polys[j].corner; k < q->polys[j].corner + q->polys[j].corner_count; k++) {
            double cosine = v3_dot(own, v3_from(q->polys[j].n)), limit = cos(o->crease * acos(-1.0) / 180), weight;
            if (object_of(s, &q->polys[j]) != o || !gnoi_is_smooth(&q->polys[j]) || !same_place(at(q, k), at(q, corner)))
                continue;
            if (o->crease < 180 && fabs(cosine - limit) < 1e-8)
                *sure = 0;
            if (o->crease < 180 && cosine < limit)
                continue;
            weight = twin_weight(s, &q->polys[j], k);
            sum = v3_mad(sum, v3_from(q->polys[j].n), weight);
            total += weight;
        }
    if (v3_length(sum) < 1e-6 * total && v3_length(sum) > 1e-12 * total)
        *sure = 0;
    return v3_length(sum) > 1e-9 * total ? v3_unit(sum) : own;
}

/* The scene's normal of a prepared corner, found by place among its source's corners; -2 where several differ. */
static int source_normal_of(const gno_scene *s, const gnoi_poly *poly, uint32_t corner)
{
    int found = -3;
    for (unsigned i = s->ring_start[s->polygon_start[poly->source]]; i < s->ring_start[s->polygon_start[poly->source + 1]]; i++)
        if (same_place(corner_position(s, i), at(&s->prepared, corner)))
            found = found == -3 || found == s->corner_normal[i] ? s->corner_normal[i] : -2;
    return found;
}

static void check_normals(const gno_scene *s)
{
    const gnoi_prepared *q = &s->prepared;
    for (size_t i = 0; i < q->poly_count; i++)
        for (uint32_t k = q->polys[i].corner; k < q->polys[i].corner + q->polys[i].corner_count; k++) {
            int source = source_normal_of(s, &q->polys[i], k), sure;
            const float *n;
            vec3 expected;
            if (!gnoi_is_smooth(&q->polys[i])) {
                assert_true(!q->corner_normal || q->corner_normal[k] == GNOI_NONE);
                continue;
            }
            assert_true(q->corner_normal[k] < q->normal_count);
            n = q->normals[q->corner_normal[k]];
            expected = expected_normal(s, i, k, source, &sure);
            if (sure && source != -2)
                assert_true(v3_length(v3_sub(expected, v3(n[0], n[1], n[2]))) < 1e-6);
        }
}

/* ---- twin of the parts --------------------------------------------------------------------------------------------------------- */

typedef struct edge {
    uint32_t from, to;
} edge;

static int by_ends(const void *a, const void *b)
{
    const edge *x = a, *y = b;
    return x->from != y->from ? (x->from < y->from ? -1 : 1) : x->to < y->to ? -1 : x->to > y->to;
}

static size_t count_edge(const edge *edges, size_t count, edge e)
{
    size_t low = 0, high = count, n = 0;
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (by_ends(&edges[middle], &e) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    while (low + n < count && by_ends(&edges[low + n], &e) == 0)
        n++;
    return n;
}

/* Each vertex takes the lowest number around it until nothing changes. */
static uint32_t *twin_parts(const gnoi_prepared *q)
{
    uint32_t *part = calloc(q->vertex_count + 1, sizeof *part);
    int changed = 1;
    assert_non_null(part);
    for (uint32_t v = 0; v < q->vertex_count; v++)
        part[v] = v;
    while (changed) {
        changed = 0;
        for (size_t i = 0; i < q->poly_count; i++) {
            const uint32_t *c = q->corner_vertex + q->polys[i].corner;
            uint32_t low = GNOI_NONE;
            for (uint32_t k = 0; k < q->polys[i].corner_count; k++)
                low = part[c[k]] < low ? part[c[k]] : low;
            for (uint32_t k = 0; k < q->polys[i].corner_count; k++) {
                changed |= part[c[k]] != low;
                part[c[k]] = low;
            }
        }
    }
    return part;
}

/* The directed edges of prepared polygons with taken[i] (NULL: all), sorted. */
static size_t list_edges(const gnoi_prepared *q, const unsigned char *taken, edge *edges)
{
    size_t n = 0;
    for (size_t i = 0; i < q->poly_count; i++)
        for (uint32_t k = 0; (!taken || taken[i]) && k < q->polys[i].corner_count; k++) {
            const uint32_t *c = q->corner_vertex + q->polys[i].corner;
            edges[n].from = c[k];
            edges[n].to = c[(k + 1) % q->polys[i].corner_count];
            n += edges[n].from != edges[n].to;
        }
    qsort(edges, n, sizeof *edges, by_ends);
    return n;
}

/* A part without polygons of no area or split, or with holes around, is closed as it is just when its edges cancel. */
static void check_parts(const gno_scene *s)
{
    const gnoi_prepared *q = &s->prepared;
    uint32_t *part = twin_parts(q);
    edge *edges = calloc(q->corner_count + 1, sizeof *edges);
    size_t n = list_edges(q, NULL, edges), parts = 0;
    unsigned char *open = calloc(q->vertex_count + 1, 1);
    assert_true(edges && open);
    for (size_t i = 0; i < n; i++) {
        edge back = {edges[i].to, edges[i].from};
        open[part[edges[i].from]] |= count_edge(edges, n, edges[i]) != count_edge(edges, n, back);
    }
    for (uint32_t v = 0; v < q->vertex_count; v++) {
        const gnoi_solid *solid = &q->solids[q->vertex_solid[v]];
        assert_int_equal(q->vertex_solid[v], q->vertex_solid[part[v]]);
        assert_true(part[v] == v || q->vertex_solid[v] < parts);
        if (part[v] == v)
            assert_int_equal(q->vertex_solid[v], parts++);
        if (s->prepared.problems.degenerate == 0 && solid->cap == GNOI_NONE)
            assert_int_equal(solid->closed, !open[part[v]]);
        for (int k = 0; k < 3; k++)
            assert_true(q->positions[v][k] >= solid->lower[k] && q->positions[v][k] <= solid->upper[k]);
    }
    assert_int_equal(parts, q->solid_count);
    free(part);
    free(edges);
    free(open);
}

/* The boundary of a random set of polygons: what each pair of vertices has left over one way, each edge of a polygon that has it. */
static void check_boundary(const gno_scene *s, uint64_t seed)
{
    const gnoi_prepared *q = &s->prepared;
    gnoi_boundary boundary = {0, 0, NULL};
    unsigned char *taken = calloc(q->poly_count + 1, 1);
    edge *edges = calloc(q->corner_count + 1, sizeof *edges), *found;
    size_t n, expected = 0, share = 1 + (size_t)(random_unit(&seed) * 60);
    assert_true(taken && edges);
    for (size_t i = 0; i < q->poly_count; i++)
        taken[i] = (i / share + seed) % 2 != 0;
    n = list_edges(q, taken, edges);
    assert_int_equal(gnoi_boundary_find(s->context, q, taken, q->poly_count, NULL, &boundary), 1);
    found = calloc(boundary.count + 1, sizeof *found);
    assert_non_null(found);
    for (size_t i = 0; i < boundary.count; i++) {
        const gnoi_boundary_edge *e = &boundary.edges[i], *before = i > 0 ? e - 1 : e;
        const uint32_t *c = q->corner_vertex + q->polys[e->poly].corner, count = q->polys[e->poly].corner_count;
        int has = 0;
        for (uint32_t k = 0; k < count; k++)
            has |= c[k] == e->from && c[(k + 1) % count] == e->to;
        assert_true(has && taken[e->poly]);
        assert_true((before->from < before->to ? before->from : before->to) <= (e->from < e->to ? e->from : e->to));
        found[i].from = e->from;
        found[i].to = e->to;
    }
    qsort(found, boundary.count, sizeof *found, by_ends);
    for (size_t i = 0; i < n; i++) {
        edge back = {edges[i].to, edges[i].from};
        size_t there = count_edge(edges, n, edges[i]), reverse = count_edge(edges, n, back), rest = there > reverse ? there - reverse : 0;
        assert_int_equal(count_edge(found, boundary.count, edges[i]), rest);
        expected += (i == 0 || by_ends(&edges[i - 1], &edges[i]) != 0) ? rest : 0;
    }
    assert_int_equal(boundary.count, expected);
    gnoi_boundary_free(s->context, &boundary);
    free(taken);
    free(edges);
    free(found);
}

/* ---- the tests ---------------------------------------------------------------------------------------------------------------------- */

static void check_all(const gno_scene *scene, uint64_t seed)
{
    for (size_t i = 0; i < scene->prepared.poly_count; i++)
        check_polygon(scene, &scene->prepared.polys[i]);
    check_order(scene);
    check_numbers(scene);
    check_parts(scene);
    check_boundary(scene, seed);
}

static void test_small_meshes(void **state)
{
    (void)state;
    for (int round = 0; round < rounds(); round++) {
        gno_context *context;
        gno_scene *scene;
        assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
        scene = random_mesh(context, 77 + (uint64_t)round, 4 + (size_t)round % 20, 3 + round % 12, round % 2);
        assert_int_equal(gno_scene_prepare(scene, 1, NULL), GNO_OK);
        check_all(scene, (uint64_t)round);
        check_normals(scene);
        gno_scene_destroy(scene);
        gno_context_destroy(context);
    }
}

#define SAME(array, count) assert_memory_equal(p->array, q->array, (count) * sizeof *p->array)

/* Several chunks, with seams between them. */
static void test_large_meshes(void **state)
{
    (void)state;
    for (int round = 0; round < 4; round++) {
        gno_context *context;
        gno_scene *scenes[3];
        const gnoi_prepared *p, *q;
        assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
        for (int i = 0; i < 3; i++) {
            scenes[i] = random_mesh(context, 7 + (uint64_t)round, 4000, round < 2 ? 12 : 60, round % 2);
            assert_int_equal(gno_scene_prepare(scenes[i], 2 * i + 1, NULL), GNO_OK);
        }
        p = &scenes[0]->prepared;
        check_all(scenes[0], (uint64_t)round);
        assert_true(p->chunk_count > 1 && p->seam_count > 0);
        for (int i = 1; i < 3; i++) {
            q = &scenes[i]->prepared;
            assert_true(p->poly_count == q->poly_count && p->corner_count == q->corner_count && p->vertex_count == q->vertex_count &&
                        p->normal_count == q->normal_count && p->triangle_count == q->triangle_count && p->cap_count == q->cap_count);
            SAME(polys, p->poly_count + p->cap_count);
            SAME(ring_corner, p->ring_count + 1);
            SAME(corner_vertex, p->corner_count);
            SAME(positions, p->vertex_count);
            SAME(vertex_solid, p->vertex_count);
            if (p->corner_normal)
                SAME(corner_normal, p->corner_count);
            if (p->corner_normal)
                SAME(normals, p->normal_count);
            if (p->triangle_count)
                SAME(triangles, p->triangle_count);
            for (size_t k = 0; k < p->solid_count; k++)
                assert_true(p->solids[k].closed == q->solids[k].closed && p->solids[k].cap == q->solids[k].cap &&
                            p->solids[k].outwards == q->solids[k].outwards);
        }
        for (int i = 0; i < 3; i++)
            gno_scene_destroy(scenes[i]);
        gno_context_destroy(context);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_small_meshes),
        cmocka_unit_test(test_large_meshes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
