/* test_render_faults.c -- gno_render with every allocation made to fail once: a status and a message come back, nothing leaks,
 * and the scene renders afterwards as if nothing had happened. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "fail_alloc.h"
#include <math.h>
#include <string.h>

#define WIDTH 40
#define HEIGHT 30

static const double tent[15] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0, 0, 0, 1.5};
static const int tent_corners[16] = {3, 2, 1, 0, 0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4};
static const unsigned tent_rings[6] = {0, 4, 7, 10, 13, 16};
static const double slab[36] = {-9, -9, -0.1, 9, -9, -0.1, 9, 9, -0.1, -9, 9, -0.1, 2, -2, 1, 4, -2, 1, 4, 2, 1, 2, 2, 1,
                                2.5, -1, 1, 3.5, -1, 1, 3.5, 1, 1, 2.5, 1, 1};
static const int slab_corners[12] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
static const unsigned slab_rings[4] = {0, 4, 8, 12}, slab_polygons[3] = {0, 1, 3};

/* A closed part, an n-gon with a hole, a ground behind the eye too; smooth and gouraud; glass over it all; lights of all kinds. */
static gno_status fill(gno_scene *scene)
{
    gno_mesh_def mesh = gno_mesh_def_default();
    gno_image_def image = gno_image_def_default();
    gno_material glass = gno_material_default();
    gno_status status;
    image.width = WIDTH;
    image.height = HEIGHT;
    status = gno_scene_set_image(scene, &image);
    mesh.vertex_count = 5;
    mesh.positions = tent;
    mesh.polygon_count = mesh.ring_count = 5;
    mesh.ring_start = tent_rings;
    mesh.corner_count = 16;
    mesh.corner_vertex = tent_corners;
    mesh.shading = GNO_SHADING_PHONG;
    if (!status) status = gno_scene_add_mesh(scene, &mesh, NULL);
    mesh = gno_mesh_def_default();
    mesh.vertex_count = mesh.corner_count = 12;
    mesh.positions = slab;
    mesh.polygon_count = 2;
    mesh.polygon_start = slab_polygons;
    mesh.ring_count = 3;
    mesh.ring_start = slab_rings;
    mesh.corner_vertex = slab_corners;
    mesh.find_details = 1;
    mesh.shading = GNO_SHADING_GOURAUD;
    if (!status) status = gno_scene_add_mesh(scene, &mesh, NULL);
    glass.transmission[0] = glass.transmission[2] = 0.5;
    if (!status) status = gno_scene_add_material(scene, &glass, &mesh.material);
    mesh.transform[11] = 0.5;
    if (!status) status = gno_scene_add_mesh(scene, &mesh, NULL);
    mesh.polygon_count = mesh.ring_count = 1; /* a detail of the ground, marked; the others are looked for */
    mesh.corner_count = 4;
    mesh.transform[11] = 0;
    mesh.transform[0] = mesh.transform[5] = 0.5;
    mesh.detail_of = 5;
    if (!status) status = gno_scene_add_mesh(scene, &mesh, NULL);
    for (int i = 0; i < 4 && !status; i++) {
        gno_light light = gno_light_default();
        light.type = (gno_light_type)i;
        light.position[0] = i == 0 ? 0.5 : 3;
        light.position[1] = -2;
        light.position[2] = 4;
        light.direction[0] = -0.4;
        light.direction[2] = -1;
        light.edge1[0] = light.edge2[1] = 0.5;
        light.samples = 2;
        status = gno_scene_add_light(scene, NULL, &light, NULL);
    }
    return status;
}

static void test_every_allocation_fails(void **state)
{
    static float good[WIDTH * HEIGHT * 3], rgb[WIDTH * HEIGHT * 3];
    (void)state;
    for (size_t at = 0, calls = 1; at <= calls; at++) {
        fail_alloc alloc = {0};
        gno_context_def def = fail_alloc_def(&alloc);
        gno_render_def how = gno_render_def_default();
        gno_context *context;
        gno_scene *scene;
        size_t before;
        gno_status status;
        how.threads = 1;
        assert_int_equal(gno_context_create(&def, &context), GNO_OK);
        assert_int_equal(gno_scene_create(context, &scene), GNO_OK);
        assert_int_equal(fill(scene), GNO_OK);
        before = alloc.calls;
        alloc.fail_at = at ? before + at : 0;
        status = gno_render(scene, &how, at ? rgb : good, NULL);
        if (at == 0) {
            assert_int_equal(status, GNO_OK);
            calls = alloc.calls - before;
            assert_true(calls > 20);
        } else {
            assert_int_equal(status, GNO_ERROR_MEMORY);
            assert_true(strlen(gno_context_message(context)) > 0);
            alloc.fail_at = 0;
            assert_int_equal(gno_render(scene, &how, rgb, NULL), GNO_OK);
            assert_memory_equal(rgb, good, sizeof good);
        }
        gno_scene_destroy(scene);
        gno_context_destroy(context);
        assert_int_equal(alloc.held, 0);
        assert_false(alloc.wrong_size);
    }
}

static int stop_at(void *user, const char *stage, double fraction)
{
    (void)stage;
    (void)fraction;
    return --*(int *)user < 0;
}

/* The first time it is asked, the callback stops a picture large enough to ask at all; the scene renders whole afterwards. */
static void test_cancel(void **state)
{
    static float rgb[40 * WIDTH * 40 * HEIGHT * 3];
    gno_image_def image = gno_image_def_default();
    fail_alloc alloc = {0};
    gno_context_def def = fail_alloc_def(&alloc);
    gno_render_def how = gno_render_def_default();
    gno_context *context;
    gno_scene *scene;
    int left = 0;
    (void)state;
    how.threads = 1;
    def.progress = stop_at;
    def.progress_user = &left;
    assert_int_equal(gno_context_create(&def, &context), GNO_OK);
    assert_int_equal(gno_scene_create(context, &scene), GNO_OK);
    assert_int_equal(fill(scene), GNO_OK);
    image.width = 40 * WIDTH;
    image.height = 40 * HEIGHT;
    assert_int_equal(gno_scene_set_image(scene, &image), GNO_OK);
    assert_int_equal(gno_render(scene, &how, rgb, NULL), GNO_ERROR_CANCELLED);
    left = 1000000;
    assert_int_equal(gno_render(scene, &how, rgb, NULL), GNO_OK);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
    assert_int_equal(alloc.held, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_every_allocation_fails), cmocka_unit_test(test_cancel)};
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
