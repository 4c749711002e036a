/* test_scene.c -- context, parallel loops and the scene's storage: accounts, limits, messages, and that failing changes nothing. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/parallel.h"
#include "fail_alloc.h"
#include "scene/scene.h"

#include <math.h>
#include <stdatomic.h>
#include <string.h>

/* A unit square and a triangle over five vertices, in two rings. */
static const double square_positions[15] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, 0};
static const int square_corners[7] = {0, 1, 2, 3, 1, 4, 2};
static const unsigned square_rings[3] = {0, 4, 7};

static gno_mesh_def square_mesh(void)
{
    gno_mesh_def mesh = gno_mesh_def_default();
    mesh.name = "wall";
    mesh.vertex_count = 5;
    mesh.positions = square_positions;
    mesh.polygon_count = 2;
    mesh.ring_count = 2;
    mesh.ring_start = square_rings;
    mesh.corner_count = 7;
    mesh.corner_vertex = square_corners;
    return mesh;
}

typedef struct bed {
    fail_alloc alloc;
    gno_context *context;
    gno_scene *scene;
} bed;

static int set_up(void **state)
{
    bed *b = calloc(1, sizeof *b);
    gno_context_def def;
    if (!b) {
        return 1;
    }
    def = fail_alloc_def(&b->alloc);
    *state = b;
    return gno_context_create(&def, &b->context) != GNO_OK || gno_scene_create(b->context, &b->scene) != GNO_OK;
}

static int tear_down(void **state)
{
    bed *b = *state;
    int bad;
    gno_scene_destroy(b->scene);
    gno_context_destroy(b->context);
    bad = b->alloc.held != 0 || b->alloc.wrong_size;
    free(b);
    return bad;
}

/* ---- context ----------------------------------------------------------------------------------------------------- */

static void test_texts(void **state)
{
    int status;
    (void)state;
    assert_string_equal(gno_version(), "0.1.0");
    assert_string_equal(gno_status_text(GNO_OK), "ok");
    for (status = GNO_OK; status <= GNO_ERROR_CANCELLED; status++) {
        assert_true(strlen(gno_status_text((gno_status)status)) > 0);
    }
    assert_string_equal(gno_status_text((gno_status)99), "unknown status");
    assert_string_equal(gno_context_message(NULL), "");
    gno_context_destroy(NULL);
    gno_scene_destroy(NULL);
}

static void test_context_create(void **state)
{
    fail_alloc alloc = {0, 0, 1, 0};
    gno_context_def def = fail_alloc_def(&alloc);
    gno_context *context = (gno_context *)&alloc;
    (void)state;
    assert_int_equal(gno_context_create(&def, &context), GNO_ERROR_MEMORY);
    assert_null(context);
    assert_int_equal(gno_context_create(NULL, NULL), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    assert_string_equal(gno_context_message(context), "");
    gno_context_destroy(context);
}

static void test_account(void **state)
{
    bed *b = *state;
    size_t peak, before = gno_context_memory(b->context, &peak);
    int *block = gnoi_malloc(b->context, 100, sizeof *block), *grown;
    assert_int_equal(before + 400, b->alloc.held);
    assert_true(peak >= before);
    assert_int_equal(gno_context_memory(b->context, NULL), before + 400);
    block[99] = 7;
    grown = gnoi_realloc(b->context, block, 100, 200, sizeof *grown);
    assert_int_equal(grown[99], 7);
    assert_int_equal(gno_context_memory(b->context, NULL), before + 800);
    assert_null(gnoi_realloc(b->context, grown, 200, SIZE_MAX / 2, sizeof *grown)); /* overflow: the block stays */
    assert_int_equal(grown[99], 7);
    gnoi_free(b->context, grown, 200, sizeof *grown);
    assert_int_equal(gno_context_memory(b->context, &peak), before);
    assert_true(peak >= before + 800);
    block = gnoi_calloc(b->context, 0, sizeof *block); /* no elements: still a block, of one */
    assert_non_null(block);
    assert_int_equal(*block, 0);
    gnoi_free(b->context, block, 0, sizeof *block);
    assert_int_equal(gno_context_memory(b->context, NULL), b->alloc.held);
}

static void test_reserve(void **state)
{
    bed *b = *state;
    void *array = NULL;
    size_t capacity = 0;
    assert_int_equal(gnoi_reserve(b->context, &array, &capacity, 1, 8), 1);
    assert_int_equal(capacity, 16);
    assert_int_equal(gnoi_reserve(b->context, &array, &capacity, 33, 8), 1);
    assert_int_equal(capacity, 64);
    assert_int_equal(gnoi_reserve(b->context, &array, &capacity, SIZE_MAX / 4, 8), 0);
    assert_int_equal(capacity, 64);
    gnoi_free(b->context, array, capacity, 8);
}

static void test_messages(void **state)
{
    bed *b = *state;
    char longest[3000];
    assert_int_equal(gnoi_fail(b->context, GNO_ERROR_LIMIT, "%d of %d", 3, 2), GNO_ERROR_LIMIT);
    assert_string_equal(gno_context_message(b->context), "3 of 2");
    gnoi_fail(b->context, GNO_ERROR_INPUT, "file: %s", gno_context_message(b->context)); /* the message within itself */
    assert_string_equal(gno_context_message(b->context), "file: 3 of 2");
    memset(longest, 'x', sizeof longest - 1);
    longest[sizeof longest - 1] = '\0';
    assert_int_equal(gno_context_fail(b->context, GNO_ERROR_FILE, longest), GNO_ERROR_FILE);
    assert_int_equal(strlen(gno_context_message(b->context)), 1023);
    gno_context_fail(b->context, GNO_ERROR_FILE, "100%s"); /* not a format */
    assert_string_equal(gno_context_message(b->context), "100%s");
}

static void keep_level(void *user, gno_log_level level, const char *text)
{
    int *seen = user;
    *seen = (int)level * 100 + (int)strlen(text);
}

static void test_log(void **state)
{
    gno_context_def def = gno_context_def_default();
    gno_context *context;
    int seen = 0;
    (void)state;
    def.log = keep_level;
    def.log_user = &seen;
    assert_int_equal(gno_context_create(&def, &context), GNO_OK);
    gnoi_warn(context, "%s", "four");
    assert_int_equal(seen, 104);
    gno_context_log(context, GNO_LOG_INFO, "hello");
    assert_int_equal(seen, 5);
    gno_context_destroy(context);
}

/* ---- parallel loops ---------------------------------------------------------------------------------------------- */

#define PIECES 1000

typedef struct counting {
    atomic_int seen[PIECES];
    atomic_int bad_worker;
    int threads;
    size_t fail_at;
} counting;

static gno_status count_piece(void *user, int worker, size_t piece)
{
    counting *c = user;
    atomic_fetch_add(&c->seen[piece], 1);
    if (worker < 0 || worker >= c->threads) {
        atomic_store(&c->bad_worker, 1);
    }
    return piece == c->fail_at ? GNO_ERROR_LIMIT : GNO_OK;
}

static void test_parallel_covers(void **state)
{
    bed *b = *state;
    static counting c;
    static const int threads[4] = {1, 2, 7, GNO_MAX_THREADS};
    int i, k;
    for (i = 0; i < 4; i++) {
        memset(&c, 0, sizeof c);
        c.threads = threads[i];
        c.fail_at = PIECES;
        assert_int_equal(gnoi_parallel(b->context, threads[i], PIECES, "test", count_piece, &c), GNO_OK);
        for (k = 0; k < PIECES; k++) {
            assert_int_equal(atomic_load(&c.seen[k]), 1);
        }
        assert_int_equal(atomic_load(&c.bad_worker), 0);
    }
    assert_int_equal(gnoi_parallel(b->context, 4, 0, "test", count_piece, &c), GNO_OK);
}

static void test_parallel_fails(void **state)
{
    bed *b = *state;
    static counting c;
    int threads, k;
    for (threads = 1; threads <= 4; threads++) {
        memset(&c, 0, sizeof c);
        c.threads = threads;
        c.fail_at = 10;
        assert_int_equal(gnoi_parallel(b->context, threads, PIECES, "stage", count_piece, &c), GNO_ERROR_LIMIT);
        assert_string_equal(gno_context_message(b->context), "stage: limit exceeded");
        for (k = 0; k < PIECES; k++) {
            assert_true(atomic_load(&c.seen[k]) <= 1);
        }
        assert_int_equal(atomic_load(&c.seen[10]), 1);
    }
    assert_int_equal(gnoi_thread_count(3), 3);
    assert_int_equal(gnoi_thread_count(100000), GNO_MAX_THREADS);
    assert_true(gnoi_thread_count(0) >= 1);
}

static int stop_now(void *user, const char *stage, double fraction)
{
    int *calls = user;
    assert_string_equal(stage, "slow");
    assert_true(fraction >= 0 && fraction <= 1);
    return ++*calls == 2;
}

static gno_status slow_piece(void *user, int worker, size_t piece)
{
    double end = gnoi_now() + 0.005;
    (void)user;
    (void)worker;
    (void)piece;
    while (gnoi_now() < end) {
    }
    return GNO_OK;
}

static void test_parallel_cancels(void **state)
{
    gno_context_def def = gno_context_def_default();
    gno_context *context;
    int calls = 0;
    (void)state;
    def.progress = stop_now;
    def.progress_user = &calls;
    assert_int_equal(gno_context_create(&def, &context), GNO_OK);
    assert_int_equal(gnoi_parallel(context, 2, 100000, "slow", slow_piece, NULL), GNO_ERROR_CANCELLED);
    assert_int_equal(calls, 2);
    assert_string_equal(gno_context_message(context), "slow: cancelled");
    gno_context_destroy(context);
}

/* ---- meshes ------------------------------------------------------------------------------------------------------ */

static void test_add_and_read_back(void **state)
{
    bed *b = *state;
    gno_mesh_def mesh = square_mesh();
    gno_scene_counts counts;
    gno_polygon polygon;
    size_t first = 99;
    double lower[3], upper[3];
    assert_int_equal(gno_scene_bounds(b->scene, lower, upper), 0);
    assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, &first), GNO_OK);
    assert_int_equal(first, 0);
    mesh.transform[3] = 10;
    mesh.priority = -3;
    mesh.shading = GNO_SHADING_PHONG;
    assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, &first), GNO_OK);
    assert_int_equal(first, 2);
    counts = gno_scene_count(b->scene);
    assert_int_equal(counts.vertices, 10);
    assert_int_equal(counts.polygons, 4);
    assert_int_equal(counts.rings, 4);
    assert_int_equal(counts.corners, 14);
    assert_int_equal(counts.objects, 2);
    assert_int_equal(counts.materials, 1);
    assert_int_equal(gno_scene_polygon(b->scene, 3, &polygon), GNO_OK);
    assert_int_equal(polygon.ring_count, 1);
    assert_int_equal(polygon.ring_start[1] - polygon.ring_start[0], 3);
    assert_int_equal(polygon.corner_vertex[polygon.ring_start[0] + 1], 9);
    assert_int_equal(polygon.corner_normal[polygon.ring_start[0]], -1);
    assert_true(polygon.positions[27] == 12);
    assert_int_equal(polygon.shading, GNO_SHADING_PHONG);
    assert_int_equal(polygon.priority, -3);
    assert_int_equal(polygon.object, 1);
    assert_int_equal(gno_scene_polygon(b->scene, 4, &polygon), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_scene_bounds(b->scene, lower, upper), 1);
    assert_true(lower[0] == 0 && upper[0] == 12 && upper[1] == 1 && upper[2] == 0);
}

static void test_many_meshes(void **state)
{
    bed *b = *state;
    gno_mesh_def mesh = square_mesh();
    unsigned i;
    for (i = 0; i < 300; i++) {
        mesh.transform[3] = i;
        assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, NULL), GNO_OK);
    }
    for (i = 0; i < 600; i++) {
        gno_polygon p;
        assert_int_equal(gno_scene_polygon(b->scene, i, &p), GNO_OK);
        assert_int_equal(p.ring_start[0], i / 2 * 7 + i % 2 * 4);
        assert_true(p.positions[3 * p.corner_vertex[p.ring_start[0]]] == i / 2 + i % 2);
        assert_int_equal(p.object, i / 2);
    }
}

static void test_normals_turn_inversely(void **state)
{
    bed *b = *state;
    gno_mesh_def mesh = square_mesh();
    static const double normals[9] = {1, 1, 0, NAN, 0, 0, 0, 0, 2};
    static const int corner_normal[7] = {0, 0, 0, -1, 1, 1, 2};
    gno_polygon p;
    mesh.normal_count = 3;
    mesh.normals = normals;
    mesh.corner_normal = corner_normal;
    mesh.transform[0] = -2; /* a mirror, and twice as long in x */
    assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, NULL), GNO_OK);
    assert_int_equal(gno_scene_polygon(b->scene, 0, &p), GNO_OK);
    assert_true(p.normals[0] < 0 && p.normals[1] == -2 * p.normals[0] && p.normals[2] == 0);
    assert_true(p.normals[3] == 0 && p.normals[4] == 0 && p.normals[5] == 0); /* not finite: none */
    assert_true(p.normals[8] > 0);
    assert_int_equal(p.corner_normal[3], -1);
    assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, NULL), GNO_OK);
    assert_int_equal(gno_scene_polygon(b->scene, 2, &p), GNO_OK);
    assert_int_equal(p.corner_normal[7], 3);
    assert_int_equal(p.corner_normal[10], -1);
}

/* One bad mesh: refused with the status and message, and nothing of it in the scene. */
static void refuse(bed *b, const gno_mesh_def *mesh, gno_status status, const char *message)
{
    gno_scene_counts before = gno_scene_count(b->scene), after;
    unsigned last_ring = b->scene->ring_start[b->scene->ring_count];
    size_t first = 77;
    assert_int_equal(gno_scene_add_mesh(b->scene, mesh, &first), status);
    assert_string_equal(gno_context_message(b->context), message);
    after = gno_scene_count(b->scene);
    assert_memory_equal(&before, &after, sizeof before);
    assert_int_equal(b->scene->ring_start[b->scene->ring_count], last_ring);
    assert_int_equal(first, 77);
}

static void test_bad_indices(void **state)
{
    bed *b = *state;
    gno_mesh_def mesh = square_mesh();
    int corners[7] = {0, 1, 2, 3, 1, 12, 2}, normals[7] = {-1, -1, -1, -1, -1, -1, 0}, materials[2] = {0, 1};
    assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, NULL), GNO_OK);
    mesh.corner_vertex = corners;
    refuse(b, &mesh, GNO_ERROR_ARGUMENT, "mesh 'wall': corner 5 names vertex 12 of 5");
    corners[5] = -1;
    mesh.name = NULL;
    refuse(b, &mesh, GNO_ERROR_ARGUMENT, "mesh 1: corner 5 names vertex -1 of 5");
    mesh = square_mesh();
    mesh.corner_normal = normals;
    refuse(b, &mesh, GNO_ERROR_ARGUMENT, "mesh 'wall': corner 6 names normal 0 of 0");
    normals[6] = -2;
    refuse(b, &mesh, GNO_ERROR_ARGUMENT, "mesh 'wall': corner 6 names normal -2 of 0");
    mesh = square_mesh();
    mesh.polygon_material = materials;
    refuse(b, &mesh, GNO_ERROR_ARGUMENT, "mesh 'wall': polygon 1 names material 1 of 1");
    mesh = square_mesh();
    mesh.material = 2;
    refuse(b, &mesh, GNO_ERROR_ARGUMENT, "mesh 'wall': material 2 is out of range");
}

static void test_bad_offsets(void **state)
{
    bed *b = *state;
    gno_mesh_def mesh = square_mesh();
    unsigned rings[3] = {0, 4, 8}, polygons[3] = {0, 0, 2};
    mesh.ring_start = rings;
    refuse(b, &mesh, GNO_ERROR_ARGUMENT, "mesh 'wall': ring_start runs from 0 to 8, not from 0 to 7");
    rings[1] = 9;
    rings[2] = 7;
    refuse(b, &mesh, GNO_ERROR_ARGUMENT, "mesh 'wall': ring_start decreases from 9 to 7 at 2");
    mesh = square_mesh();
    mesh.ring_start = NULL;
    refuse(b, &mesh, GNO_ERROR_ARGUMENT, "mesh 'wall': 7 corners for 2 triangles (no ring_start)");
    mesh = square_mesh();
    mesh.polygon_start = polygons;
    refuse(b, &mesh, GNO_ERROR_ARGUMENT, "mesh 'wall': polygon 0 has no ring");
    mesh = square_mesh();
    mesh.polygon_count = 1;
    refuse(b, &mesh, GNO_ERROR_ARGUMENT, "mesh 'wall': 2 rings for 1 polygons, and no polygon_start");
}

static void test_bad_numbers(void **state)
{
    bed *b = *state;
    gno_mesh_def mesh = square_mesh();
    double positions[15];
    memcpy(positions, square_positions, sizeof positions);
    mesh.positions = positions;
    positions[7] = 2e15;
    refuse(b, &mesh, GNO_ERROR_ARGUMENT, "mesh 'wall': vertex 2 (1, 2e+15, 0) is not finite or beyond 1e+15");
    positions[7] = 1e15;
    mesh.transform[5] = 2; /* good before the transform, not after it */
    refuse(b, &mesh, GNO_ERROR_ARGUMENT, "mesh 'wall': vertex 2 (1, 2e+15, 0) is not finite or beyond 1e+15");
    mesh.transform[5] = NAN;
    refuse(b, &mesh, GNO_ERROR_ARGUMENT, "mesh 'wall': transform nan is out of range");
    mesh = square_mesh();
    mesh.crease = 181;
    refuse(b, &mesh, GNO_ERROR_ARGUMENT, "mesh 'wall': crease 181 is out of range");
    mesh = square_mesh();
    mesh.priority = 40000;
    refuse(b, &mesh, GNO_ERROR_ARGUMENT, "mesh 'wall': priority 40000 is out of range");
    mesh = square_mesh();
    mesh.positions = NULL;
    refuse(b, &mesh, GNO_ERROR_ARGUMENT, "mesh 'wall': positions is NULL but its count is not 0");
    mesh = square_mesh();
    mesh.texcoord_count = 1;
    mesh.texcoords = (const double[2]){0, INFINITY};
    refuse(b, &mesh, GNO_ERROR_ARGUMENT, "mesh 'wall': texture coordinate 0 is not finite");
}

static void test_limits(void **state)
{
    bed *b = *state;
    gno_mesh_def mesh = square_mesh();
    assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, NULL), GNO_OK);
    mesh.vertex_count = GNO_MAX_POLYGONS - 4;
    refuse(b, &mesh, GNO_ERROR_LIMIT,
           "mesh 'wall': 268435452 vertices, with 5 in the scene, exceed the limit of 268435456");
    mesh.vertex_count = SIZE_MAX;
    assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, NULL), GNO_ERROR_LIMIT);
    mesh = square_mesh();
    mesh.corner_count = GNO_MAX_CORNERS;
    assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, NULL), GNO_ERROR_LIMIT);
    mesh = square_mesh();
    mesh.polygon_count = mesh.ring_count = (size_t)GNO_MAX_POLYGONS + 1;
    assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, NULL), GNO_ERROR_LIMIT);
    assert_int_equal(gno_scene_add_mesh(NULL, &mesh, NULL), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_scene_add_mesh(b->scene, NULL, NULL), GNO_ERROR_ARGUMENT);
}

static void test_empty_mesh(void **state)
{
    bed *b = *state;
    gno_mesh_def mesh = gno_mesh_def_default();
    assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, NULL), GNO_OK);
    assert_int_equal(gno_scene_count(b->scene).objects, 1);
    assert_int_equal(gno_scene_prepare(b->scene, 1, NULL), GNO_OK);
}

/* ---- materials, lights, camera ----------------------------------------------------------------------------------- */

static void test_materials(void **state)
{
    bed *b = *state;
    gno_material m = gno_material_default(), back;
    int index = -1;
    m.diffuse[1] = 2;
    assert_int_equal(gno_scene_add_material(b->scene, &m, &index), GNO_OK);
    assert_int_equal(index, 1);
    assert_int_equal(gno_scene_material(b->scene, 1, &back), GNO_OK);
    assert_true(back.diffuse[1] == 2);
    assert_int_equal(gno_scene_material(b->scene, 2, &back), GNO_ERROR_ARGUMENT);
    m.transmission[2] = 1.5;
    assert_int_equal(gno_scene_add_material(b->scene, &m, &index), GNO_ERROR_ARGUMENT);
    assert_string_equal(gno_context_message(b->context), "material: transmission 1.5 is not in [0, 1]");
    m = gno_material_default();
    m.shininess = NAN;
    assert_int_equal(gno_scene_add_material(b->scene, &m, &index), GNO_ERROR_ARGUMENT);
    m = gno_material_default();
    m.ambient[0] = INFINITY;
    assert_int_equal(gno_scene_add_material(b->scene, &m, &index), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_scene_count(b->scene).materials, 2);
}

static void test_names(void **state)
{
    bed *b = *state;
    gno_material m = gno_material_default();
    int index;
    assert_string_equal(gno_scene_material_name(b->scene, 0), "");
    assert_int_equal(gno_scene_add_material(b->scene, &m, &index), GNO_OK);
    assert_int_equal(gno_scene_set_material_name(b->scene, 1, "brick"), GNO_OK);
    assert_string_equal(gno_scene_material_name(b->scene, 0), "");
    assert_string_equal(gno_scene_material_name(b->scene, 1), "brick");
    assert_int_equal(gno_scene_add_material(b->scene, &m, &index), GNO_OK);
    assert_string_equal(gno_scene_material_name(b->scene, 2), "");
    assert_int_equal(gno_scene_set_material_name(b->scene, 1, "red brick"), GNO_OK);
    assert_int_equal(gno_scene_set_material_name(b->scene, 2, ""), GNO_OK);
    assert_string_equal(gno_scene_material_name(b->scene, 1), "red brick");
    assert_int_equal(gno_scene_set_material_name(b->scene, 1, NULL), GNO_OK);
    assert_string_equal(gno_scene_material_name(b->scene, 1), "");
    assert_int_equal(gno_scene_set_material_name(b->scene, 3, "none"), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_scene_set_material_name(b->scene, -1, "none"), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_scene_set_material_name(NULL, 0, "none"), GNO_ERROR_ARGUMENT);
    assert_string_equal(gno_scene_material_name(b->scene, 3), "");
    assert_string_equal(gno_scene_object_name(b->scene, 0), "");
    assert_string_equal(gno_scene_object_name(b->scene, -1), "");
}

static void test_lights(void **state)
{
    bed *b = *state;
    gno_light l = gno_light_default(), back;
    const char *name;
    int i;
    assert_int_equal(gno_scene_add_light(b->scene, "lamp", &l, &i), GNO_OK);
    assert_int_equal(gno_scene_light(b->scene, i, &back, &name), GNO_OK);
    assert_string_equal(name, "lamp");
    l.type = GNO_LIGHT_SPOT;
    assert_int_equal(gno_scene_add_light(b->scene, NULL, &l, &i), GNO_ERROR_ARGUMENT); /* no direction */
    l.direction[2] = -1;
    l.angle = 180;
    assert_int_equal(gno_scene_add_light(b->scene, NULL, &l, &i), GNO_ERROR_ARGUMENT);
    l = gno_light_default();
    l.type = GNO_LIGHT_AREA;
    l.samples = 64; /* 4096 points, and one there is */
    assert_int_equal(gno_scene_add_light(b->scene, NULL, &l, &i), GNO_ERROR_LIMIT);
    l.samples = 63;
    assert_int_equal(gno_scene_add_light(b->scene, NULL, &l, &i), GNO_OK);
    l.samples = 2147483647;
    assert_int_equal(gno_scene_add_light(b->scene, NULL, &l, &i), GNO_ERROR_LIMIT);
    l.samples = 0;
    assert_int_equal(gno_scene_add_light(b->scene, NULL, &l, &i), GNO_ERROR_ARGUMENT);
    l = gno_light_default();
    for (i = 0; i < 126; i++) { /* 1 + 63^2 are there */
        assert_int_equal(gno_scene_add_light(b->scene, NULL, &l, NULL), GNO_OK);
    }
    assert_int_equal(gno_scene_add_light(b->scene, NULL, &l, NULL), GNO_ERROR_LIMIT);
    assert_int_equal(gno_scene_light(b->scene, 128, NULL, NULL), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_scene_light(b->scene, 127, NULL, &name), GNO_OK);
    assert_string_equal(name, "");
}

static void test_camera_and_image(void **state)
{
    bed *b = *state;
    gno_camera c = gno_camera_default();
    gno_image_def image = gno_image_def_default();
    double ambient[3] = {0.1, 0.2, 0.3};
    assert_int_equal(gno_scene_set_camera(b->scene, &c), GNO_OK);
    c.up[2] = 0;
    assert_int_equal(gno_scene_set_camera(b->scene, &c), GNO_ERROR_ARGUMENT);
    c = gno_camera_default();
    c.eye[0] = c.eye[1] = 0;
    assert_int_equal(gno_scene_set_camera(b->scene, &c), GNO_ERROR_ARGUMENT);
    assert_string_equal(gno_context_message(b->context), "camera: up is parallel to the direction of view");
    c = gno_camera_default();
    memcpy(c.target, c.eye, sizeof c.eye);
    assert_int_equal(gno_scene_set_camera(b->scene, &c), GNO_ERROR_ARGUMENT);
    c = gno_camera_default();
    c.fov = 0;
    assert_int_equal(gno_scene_set_camera(b->scene, &c), GNO_ERROR_ARGUMENT);
    c.type = GNO_CAMERA_ORTHOGRAPHIC;
    assert_int_equal(gno_scene_set_camera(b->scene, &c), GNO_OK);
    assert_int_equal(gno_scene_camera(b->scene).type, GNO_CAMERA_ORTHOGRAPHIC);
    image.width = 0;
    assert_int_equal(gno_scene_set_image(b->scene, &image), GNO_ERROR_ARGUMENT);
    image.width = GNO_MAX_IMAGE_SIDE + 1;
    assert_int_equal(gno_scene_set_image(b->scene, &image), GNO_ERROR_LIMIT);
    assert_int_equal(gno_scene_image(b->scene).width, 1280);
    assert_int_equal(gno_scene_set_ambient(b->scene, ambient), GNO_OK);
    ambient[1] = -1;
    assert_int_equal(gno_scene_set_ambient(b->scene, ambient), GNO_ERROR_ARGUMENT);
    gno_scene_ambient(b->scene, ambient);
    assert_true(ambient[1] == 0.2);
}

/* ---- memory ------------------------------------------------------------------------------------------------------ */

/* A context, a scene with two meshes and a light; the status of the first call that fails. */
static gno_status build(fail_alloc *alloc)
{
    gno_context_def def = fail_alloc_def(alloc);
    gno_mesh_def mesh = square_mesh();
    gno_light light = gno_light_default();
    gno_context *context;
    gno_scene *scene = NULL;
    gno_scene_counts counts;
    gno_status status = gno_context_create(&def, &context);
    if (status != GNO_OK) {
        return status;
    }
    status = gno_scene_create(context, &scene);
    if (status == GNO_OK) {
        status = gno_scene_add_mesh(scene, &mesh, NULL);
    }
    if (status == GNO_OK) {
        status = gno_scene_add_mesh(scene, &mesh, NULL);
        counts = gno_scene_count(scene);
        assert_int_equal(counts.polygons, status == GNO_OK ? 4 : 2);
    }
    if (status == GNO_OK) {
        status = gno_scene_add_light(scene, "lamp", &light, NULL);
    }
    assert_int_equal(gno_context_memory(context, NULL), alloc->held);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
    return status;
}

static void test_every_allocation_fails(void **state)
{
    size_t fail_at = 0;
    gno_status status;
    (void)state;
    do {
        fail_alloc alloc = {0, 0, ++fail_at, 0};
        status = build(&alloc);
        assert_true(status == GNO_OK || status == GNO_ERROR_MEMORY);
        assert_int_equal(alloc.held, 0);
        assert_int_equal(alloc.wrong_size, 0);
    } while (status != GNO_OK);
    assert_true(fail_at > 20);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_texts),
        cmocka_unit_test(test_context_create),
        cmocka_unit_test_setup_teardown(test_account, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_reserve, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_messages, set_up, tear_down),
        cmocka_unit_test(test_log),
        cmocka_unit_test_setup_teardown(test_parallel_covers, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_parallel_fails, set_up, tear_down),
        cmocka_unit_test(test_parallel_cancels),
        cmocka_unit_test_setup_teardown(test_add_and_read_back, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_many_meshes, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_normals_turn_inversely, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_bad_indices, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_bad_offsets, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_bad_numbers, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_limits, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_empty_mesh, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_materials, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_names, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_lights, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_camera_and_image, set_up, tear_down),
        cmocka_unit_test(test_every_allocation_fails),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
