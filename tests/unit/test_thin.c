/* test_thin.c -- bars thinner than the distance of two base lines: level and nearly level ones are drawn by the default lines
 * just as by all lines everywhere. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <gnomon/gnomon.h>
#include <string.h>

#define WIDTH 200
#define HEIGHT 100

/* One unit is one pixel. Bars of 0.15 at heights that miss the lines at a quarter and three quarters of a row. */
static gno_scene *bars(gno_context *context, double rise)
{
    static const double heights[3] = {10.05, -10.45, -20.95};
    static const double white[3] = {1, 1, 1};
    static const unsigned ring[2] = {0, 4};
    static const int corners[4] = {0, 1, 2, 3};
    gno_camera camera = gno_camera_default();
    gno_image_def image = gno_image_def_default();
    gno_scene *scene;
    assert_int_equal(gno_scene_create(context, &scene), GNO_OK);
    camera.type = GNO_CAMERA_ORTHOGRAPHIC;
    camera.eye[0] = camera.eye[2] = camera.target[0] = camera.target[2] = 0;
    camera.height = HEIGHT;
    image.width = WIDTH;
    image.height = HEIGHT;
    assert_int_equal(gno_scene_set_camera(scene, &camera), GNO_OK);
    assert_int_equal(gno_scene_set_image(scene, &image), GNO_OK);
    assert_int_equal(gno_scene_set_ambient(scene, white), GNO_OK);
    for (int i = 0; i < 3; i++) {
        const double z = heights[i], p[12] = {-80, 0, z, 80, 0, z + rise, 80, 0, z + rise + 0.15, -80, 0, z + 0.15};
        gno_mesh_def mesh = gno_mesh_def_default();
        mesh.vertex_count = mesh.corner_count = 4;
        mesh.positions = p;
        mesh.polygon_count = mesh.ring_count = 1;
        mesh.ring_start = ring;
        mesh.corner_vertex = corners;
        assert_int_equal(gno_scene_add_mesh(scene, &mesh, NULL), GNO_OK);
    }
    return scene;
}

static void check_bars(double rise)
{
    static float normal[WIDTH * HEIGHT * 3], fine[WIDTH * HEIGHT * 3];
    gno_context *context;
    gno_scene *scene;
    gno_render_def how = gno_render_def_default();
    size_t seen = 0;
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    scene = bars(context, rise);
    assert_int_equal(gno_render(scene, &how, normal, NULL), GNO_OK);
    how.base_lines = how.lines;
    assert_int_equal(gno_render(scene, &how, fine, NULL), GNO_OK);
    for (size_t i = 0; i < WIDTH * HEIGHT * 3; i++) {
        assert_true(normal[i] - fine[i] < 1e-5f && fine[i] - normal[i] < 1e-5f);
        seen += fine[i] > 0.01f;
    }
    assert_true(seen >= 3 * 3 * 150);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

static void test_level(void **state)
{
    (void)state;
    check_bars(0);
}

static void test_nearly_level(void **state)
{
    (void)state;
    check_bars(0.7);
    check_bars(-0.3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_level), cmocka_unit_test(test_nearly_level)};
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
