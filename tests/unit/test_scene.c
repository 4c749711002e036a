/* test_scene.c -- the scene's storage: what goes in comes back, limits, messages, and that failing changes nothing. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#include "scene_bed.h"

#include <math.h>
#include <string.h>

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
