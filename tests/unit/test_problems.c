/* test_problems.c -- what gno_scene_find_problems names: bodies spoilt on purpose, random polygons against a slow twin that looks at
 * all pairs, failing memory and stopping. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "fail_alloc.h"
#include <gnomon/gnomon_problems.h>
#include <string.h>

#include "support/solids.h"

enum { MOST = 4096 };

typedef struct findings {
    size_t count, stop_at;
    gno_problem all[MOST];
    size_t counts[GNO_PROBLEM_KINDS];
} findings;

static int keep(void *user, const gno_problem *problem)
{
    findings *f = user;
    assert_true(f->count < MOST);
    assert_true(f->count == 0 || f->all[f->count - 1].kind <= problem->kind);
    f->all[f->count++] = *problem;
    return f->count == f->stop_at;
}

static findings *find(gno_scene *scene)
{
    static findings f;
    memset(&f, 0, sizeof f);
    assert_int_equal(gno_scene_find_problems(scene, 1, keep, &f, f.counts), GNO_OK);
    return &f;
}

static void expect_counts(const findings *f, size_t degenerate, size_t non_planar, size_t duplicate, size_t flipped, size_t open, size_t crowded)
{
    const size_t wanted[GNO_PROBLEM_KINDS] = {degenerate, non_planar, duplicate, flipped, open, crowded};
    size_t sum = 0;
    for (int k = 0; k < GNO_PROBLEM_KINDS; k++) {
        if (f->counts[k] != wanted[k]) {
            fail_msg("kind %d: %zu, not %zu", k, f->counts[k], wanted[k]);
        }
        sum += f->counts[k];
    }
    assert_int_equal(sum, f->count);
}

/* Faces of a box of quadrilaterals, wound outwards; a face may have a vertex of its own, 8 to 11. */
static const double box_points[12][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1},   {1, 0, 1},
                                         {1, 1, 1}, {0, 1, 1}, {1, 1, -0.0}, {0.5, 0.5, 0}, {0, -1, 0}, {1, -1, 0}};
static const int box_faces[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};

static gno_scene *quads(gno_context *context, const int (*faces)[4], size_t count)
{
    gno_scene *scene;
    gno_mesh_def mesh = gno_mesh_def_default();
    unsigned ring[33];
    for (unsigned i = 0; i <= count; i++) {
        ring[i] = 4 * i;
    }
    mesh.vertex_count = 12;
    mesh.positions = box_points[0];
    mesh.polygon_count = mesh.ring_count = count;
    mesh.ring_start = ring;
    mesh.corner_count = 4 * count;
    mesh.corner_vertex = faces[0];
    assert_int_equal(gno_scene_create(context, &scene), GNO_OK);
    assert_int_equal(gno_scene_add_mesh(scene, &mesh, NULL), GNO_OK);
    return scene;
}

static gno_context *new_context(void)
{
    gno_context *context;
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    return context;
}

static void test_spoilt_boxes(void **state)
{
    gno_context *context = new_context();
    int faces[9][4];
    const findings *f;
    (void)state;
    memcpy(faces, box_faces, sizeof box_faces);

    gno_scene *good = quads(context, (const int(*)[4])faces, 6);
    expect_counts(find(good), 0, 0, 0, 0, 0, 0);
    gno_scene *open = quads(context, (const int(*)[4])faces, 5);
    f = find(open);
    expect_counts(f, 0, 0, 0, 0, 4, 0);
    assert_false(f->all[0].border);
    assert_int_equal(f->all[0].polygon, 0); /* edge 0-3, the lowest; its lower polygon passes it from 0 to 3 */
    assert_int_equal(f->all[0].vertex[0], 0);
    assert_int_equal(f->all[0].vertex[1], 3);

    const int turned[4] = {5, 6, 2, 1};
    memcpy(faces[3], turned, sizeof turned);
    gno_scene *flipped = quads(context, (const int(*)[4])faces, 6);
    f = find(flipped);
    expect_counts(f, 0, 0, 0, 1, 0, 0);
    assert_int_equal(f->all[0].polygon, 3);
    memcpy(faces[3], box_faces[3], sizeof turned);

    const int again[4] = {7, 4, 5, 6}, mirrored[4] = {5, 4, 7, 6}; /* face 1 from another corner, and from behind */
    memcpy(faces[6], again, sizeof again);
    memcpy(faces[7], mirrored, sizeof mirrored);
    gno_scene *twice = quads(context, (const int(*)[4])faces, 8);
    f = find(twice);
    expect_counts(f, 0, 0, 2, 0, 0, 0);
    assert_int_equal(f->all[0].polygon, 6);
    assert_int_equal(f->all[0].other, 1);
    assert_int_equal(f->all[1].polygon, 7);
    assert_int_equal(f->all[1].other, 1);

    const int fin[4] = {0, 1, 11, 10}, needle[4] = {0, 9, 8, 9}, bent[4] = {0, 1, 2, 7};
    memcpy(faces[6], fin, sizeof fin);
    memcpy(faces[7], needle, sizeof needle); /* forth and back: no area, and its edges cancel */
    memcpy(faces[8], bent, sizeof bent);
    gno_scene *odd = quads(context, (const int(*)[4])faces, 7);
    f = find(odd);
    expect_counts(f, 0, 0, 0, 0, 3, 1);
    assert_int_equal(f->all[3].polygon, 0);
    assert_int_equal(f->all[3].other, 2);
    gno_scene *thin = quads(context, (const int(*)[4])faces, 8);
    expect_counts(find(thin), 1, 0, 0, 0, 3, 1);
    gno_scene *warped = quads(context, (const int(*)[4])faces + 8, 1);
    expect_counts(find(warped), 0, 1, 0, 0, 4, 0);

    gno_scene *const all[] = {good, open, flipped, twice, odd, thin, warped};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        gno_scene_destroy(all[i]);
    }
    gno_context_destroy(context);
}

/* Vertex 8 lies where vertex 2 does, but for the sign of a zero: seams between vertices of their own are no gaps. */
static void test_seams(void **state)
{
    gno_context *context = new_context();
    int faces[6][4];
    (void)state;
    memcpy(faces, box_faces, sizeof faces);
    faces[0][2] = 8;
    gno_scene *scene = quads(context, (const int(*)[4])faces, 6);
    expect_counts(find(scene), 0, 0, 0, 0, 0, 0);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

/* A window is marked as lying on the wall: its edges are no gaps. */
static void test_details_are_no_gaps(void **state)
{
    const double window[12] = {0.2, 0, 0.2, 0.4, 0, 0.2, 0.4, 0, 0.4, 0.2, 0, 0.4};
    const unsigned ring[2] = {0, 4};
    const int corners[4] = {0, 1, 2, 3};
    gno_context *context = new_context();
    gno_mesh_def mesh = gno_mesh_def_default();
    gno_scene *scene = quads(context, box_faces, 6);
    (void)state;
    mesh.vertex_count = mesh.corner_count = 4;
    mesh.positions = window;
    mesh.polygon_count = mesh.ring_count = 1;
    mesh.ring_start = ring;
    mesh.corner_vertex = corners;
    mesh.detail_of = 2;
    assert_int_equal(gno_scene_add_mesh(scene, &mesh, NULL), GNO_OK);
    expect_counts(find(scene), 0, 0, 0, 0, 0, 0);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}


/* Two quadrilaterals that hang together, wound as given, folded or not, far from the origin or not: only a flat pair's edges are borders. */
static void test_borders(void **state)
{
    static const int pair[2][4] = {{0, 1, 2, 3}, {1, 0, 4, 5}}, apart[2][4] = {{0, 1, 2, 3}, {1, 4, 5, 0}};
    (void)state;
    for (int way = 0; way < 16; way++) {
        const double shift = way & 1 ? 1e6 : 0, lift = way & 2 ? 0.3 : 0, tilt = way & 4 ? 0.7 : 0;
        const double p[6][3] = {{shift, 0, tilt * shift},       {shift + 1, 0, tilt * (shift + 1)},
                                {shift + 1, 1, tilt * (shift + 1)}, {shift, 1, tilt * shift},
                                {shift, -1, tilt * shift + lift}, {shift + 1, -1, tilt * (shift + 1) + lift}};
        static const unsigned ring[3] = {0, 4, 8};
        gno_context *context = new_context();
        gno_mesh_def mesh = gno_mesh_def_default();
        gno_scene *scene;
        mesh.vertex_count = 6;
        mesh.positions = p[0];
        mesh.polygon_count = mesh.ring_count = 2;
        mesh.ring_start = ring;
        mesh.corner_count = 8;
        mesh.corner_vertex = way & 8 ? apart[0] : pair[0];
        assert_int_equal(gno_scene_create(context, &scene), GNO_OK);
        assert_int_equal(gno_scene_add_mesh(scene, &mesh, NULL), GNO_OK);
        const findings *f = find(scene);
        assert_int_equal(f->counts[GNO_PROBLEM_OPEN_EDGE], 6);
        for (size_t i = 0; i < f->count; i++) {
            assert_int_equal(f->all[i].border, f->all[i].kind == GNO_PROBLEM_OPEN_EDGE && (lift == 0 || shift > 0));
        }
        gno_scene_destroy(scene);
        gno_context_destroy(context);
    }
}

/* A strip of triangles closed with a twist: no winding suits all. */
static void test_moebius(void **state)
{
    enum { N = 9 };
    /* Places on a moment curve, where no four points are in a plane. */
    double p[N][3];
    int corner[N][3];
    gno_context *context = new_context();
    gno_mesh_def mesh = gno_mesh_def_default();
    gno_scene *scene;
    (void)state;
    for (int i = 0; i < N; i++) {
        const double t = i;
        p[i][0] = t;
        p[i][1] = t * t;
        p[i][2] = t * t * t;
        for (int k = 0; k < 3; k++) {
            corner[i][k] = (i + k) % N;
        }
        if (i % 2) {
            corner[i][1] = (i + 2) % N;
            corner[i][2] = (i + 1) % N;
        }
    }
    mesh.vertex_count = N;
    mesh.positions = p[0];
    mesh.polygon_count = mesh.ring_count = N;
    mesh.corner_count = 3 * N;
    mesh.corner_vertex = corner[0];
    assert_int_equal(gno_scene_create(context, &scene), GNO_OK);
    assert_int_equal(gno_scene_add_mesh(scene, &mesh, NULL), GNO_OK);
    const findings *f = find(scene);
    assert_true(f->counts[GNO_PROBLEM_FLIPPED] > 0);
    assert_int_equal(f->counts[GNO_PROBLEM_OPEN_EDGE], N);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

/* ---- random polygons against a slow twin --------------------------------------------------------------------------------- */

typedef struct soup {
    size_t count;
    int corner[24][3];
} soup;

/* How often a polygon passes the edge from v to w. */
static int passes(const soup *s, size_t p, int v, int w)
{
    int n = 0;
    for (int k = 0; k < 3; k++) {
        n += s->corner[p][k] == v && s->corner[p][(k + 1) % 3] == w;
    }
    return n;
}

static int repeats(const soup *s, size_t p)
{
    for (size_t q = 0; q < p; q++) {
        int same = 1;
        for (int k = 0; k < 3; k++) {
            int v = s->corner[p][k], w = s->corner[p][(k + 1) % 3];
            same &= passes(s, q, v, w) + passes(s, q, w, v) > 0;
        }
        if (same) {
            return 1;
        }
    }
    return 0;
}

/* The fewest polygons to turn until no edge of two disagrees, by trying all sets of what hangs together; -1: none does. */
static int fewest_turns(const soup *s, const int *taken, int vertices)
{
    size_t part[24], sizes = 0;
    int total = 0, seen[24] = {0};
    for (size_t first = 0; first < s->count; first++) {
        int best = -1;
        if (!taken[first] || seen[first]) {
            continue;
        }
        sizes = 1;
        part[0] = first;
        seen[first] = 1;
        int turn[24] = {0}, good = 1;
        for (size_t i = 0; i < sizes; i++) {
            for (int v = 0; v < vertices; v++) {
                for (int w = 0; w < vertices; w++) {
                    size_t other = SIZE_MAX;
                    int uses = 0, along = 0;
                    for (size_t q = 0; q < s->count && v != w; q++) {
                        int f = taken[q] ? passes(s, q, v, w) : 0, b = taken[q] ? passes(s, q, w, v) : 0;
                        uses += f + b;
                        along += f;
                        other = f + b && q != part[i] ? q : other;
                    }
                    if (uses != 2 || other == SIZE_MAX || !passes(s, part[i], v, w)) {
                        continue;
                    }
                    int differ = turn[part[i]] ^ (along == 2);
                    if (!seen[other]) {
                        seen[other] = 1;
                        turn[other] = differ;
                        part[sizes++] = other;
                    }
                    good &= turn[other] == differ;
                }
            }
        }
        best = 0;
        for (size_t i = 0; i < sizes; i++) {
            best += turn[part[i]];
        }
        best = best < (int)sizes - best ? best : (int)sizes - best;
        if (!good) {
            return -1;
        }
        total += best;
    }
    return total;
}

static void test_against_slow_twin(void **state)
{
    uint32_t seed = 11;
    int flips = 0;
    gno_context *context = new_context();
    (void)state;
    for (int trial = 0; trial < 4000; trial++) {
        const int vertices = 4 + (int)(solid_random(&seed) % 6u);
        size_t open = 0, crowded = 0, duplicate = 0;
        double p[10][3];
        int taken[24];
        soup s;
        s.count = 1 + solid_random(&seed) % 12;
        for (int v = 0; v < vertices; v++) {
            p[v][0] = v;
            p[v][1] = v * v;
            p[v][2] = v * v * v;
        }
        for (size_t i = 0; i < s.count; i++) {
            int *c = s.corner[i];
            do {
                for (int k = 0; k < 3; k++) {
                    c[k] = (int)(solid_random(&seed) % (unsigned)vertices);
                }
            } while (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]);
            taken[i] = !repeats(&s, i);
            duplicate += !taken[i];
        }
        for (int v = 0; v < vertices; v++) {
            for (int w = v + 1; w < vertices; w++) {
                int f = 0, b = 0;
                for (size_t i = 0; i < s.count; i++) {
                    f += taken[i] ? passes(&s, i, v, w) : 0;
                    b += taken[i] ? passes(&s, i, w, v) : 0;
                }
                open += f + b == 1;
                crowded += f + b > 2 && f != b;
            }
        }
        gno_mesh_def mesh = gno_mesh_def_default();
        gno_scene *scene;
        mesh.vertex_count = (size_t)vertices;
        mesh.positions = p[0];
        mesh.polygon_count = mesh.ring_count = s.count;
        mesh.corner_count = 3 * s.count;
        mesh.corner_vertex = s.corner[0];
        assert_int_equal(gno_scene_create(context, &scene), GNO_OK);
        assert_int_equal(gno_scene_add_mesh(scene, &mesh, NULL), GNO_OK);
        const findings *f = find(scene);
        const int turns = fewest_turns(&s, taken, vertices);
        if (turns >= 0) {
            expect_counts(f, 0, 0, duplicate, (size_t)turns, open, crowded);
            flips += turns;
        } else {
            assert_true(f->counts[GNO_PROBLEM_FLIPPED] > 0);
            assert_int_equal(f->counts[GNO_PROBLEM_OPEN_EDGE], open);
        }
        gno_scene_destroy(scene);
    }
    assert_true(flips > 100);
    gno_context_destroy(context);
}

/* ---- what goes wrong ------------------------------------------------------------------------------------------------------- */

static void test_failures(void **state)
{
    size_t counts[GNO_PROBLEM_KINDS] = {7, 7, 7, 7, 7, 7};
    (void)state;
    assert_int_equal(gno_scene_find_problems(NULL, 1, NULL, NULL, counts), GNO_ERROR_ARGUMENT);
    for (size_t at = 1;; at++) {
        fail_alloc memory = {0, 0, 0, 0};
        gno_context_def def = fail_alloc_def(&memory);
        gno_context *context;
        assert_int_equal(gno_context_create(&def, &context), GNO_OK);
        gno_scene *scene = quads(context, box_faces, 5);
        memory.fail_at = memory.calls + at;
        gno_status status = gno_scene_find_problems(scene, 1, NULL, NULL, counts);
        memory.fail_at = 0;
        if (status != GNO_OK) {
            assert_int_equal(status, GNO_ERROR_MEMORY);
            assert_int_equal(counts[0], 7);
            expect_counts(find(scene), 0, 0, 0, 0, 4, 0);
        }
        gno_scene_destroy(scene);
        gno_context_destroy(context);
        assert_int_equal(memory.held, 0);
        assert_false(memory.wrong_size);
        if (status == GNO_OK) {
            assert_true(at > 13);
            break;
        }
    }
    gno_context *context = new_context();
    gno_scene *scene = quads(context, box_faces, 5), *empty;
    findings stopped;
    memset(&stopped, 0, sizeof stopped);
    stopped.stop_at = 2;
    assert_int_equal(gno_scene_find_problems(scene, 1, keep, &stopped, counts), GNO_ERROR_CANCELLED);
    assert_int_equal(stopped.count, 2);
    assert_int_equal(gno_scene_find_problems(scene, -1, NULL, NULL, NULL), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_scene_find_problems(scene, 1, NULL, NULL, NULL), GNO_OK);
    assert_int_equal(gno_scene_create(context, &empty), GNO_OK);
    expect_counts(find(empty), 0, 0, 0, 0, 0, 0);
    gno_scene_destroy(empty);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_spoilt_boxes),      cmocka_unit_test(test_seams),    cmocka_unit_test(test_details_are_no_gaps),
        cmocka_unit_test(test_borders),
        cmocka_unit_test(test_moebius),           cmocka_unit_test(test_failures), cmocka_unit_test(test_against_slow_twin),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
