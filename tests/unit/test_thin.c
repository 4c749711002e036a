/* test_thin.c -- bars thinner than the distance of two base lines: level and nearly level ones, and their shadows, are drawn by the default lines
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

/* A closed bar of 0.15 over a ground that fills the picture, seen from above; the light makes its shadow fall beside it. */
static gno_scene *shadow_bar(gno_context *context, double rise)
{
    static const double ground[12] = {-200, -200, 0, 200, -200, 0, 200, 200, 0, -200, 200, 0};
    static const unsigned ring[7] = {0, 4, 8, 12, 16, 20, 24};
    static const int square[4] = {0, 1, 2, 3};
    static const int corners[24] = {0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
    const double a = 10.05, b = 10.2, bar[24] = {-80, a, 9, 80, a + rise, 9, 80, b + rise, 9, -80, b, 9,
                                                 -80, a, 9.15, 80, a + rise, 9.15, 80, b + rise, 9.15, -80, b, 9.15};
    gno_light light = gno_light_default();
    gno_scene *scene = bars(context, 0);
    gno_camera camera = gno_scene_camera(scene);
    gno_mesh_def mesh = gno_mesh_def_default();
    const double dark[3] = {0, 0, 0};
    camera.eye[1] = 0;
    camera.eye[2] = 100;
    camera.up[1] = 1;
    camera.up[2] = 0;
    camera.target[1] = 0;
    assert_int_equal(gno_scene_set_camera(scene, &camera), GNO_OK);
    assert_int_equal(gno_scene_set_ambient(scene, dark), GNO_OK);
    light.type = GNO_LIGHT_DIRECTIONAL;
    light.direction[0] = 0;
    light.direction[1] = -1;
    light.direction[2] = -0.6;
    assert_int_equal(gno_scene_add_light(scene, NULL, &light, NULL), GNO_OK);
    mesh.vertex_count = mesh.corner_count = 4;
    mesh.positions = ground;
    mesh.polygon_count = mesh.ring_count = 1;
    mesh.ring_start = ring;
    mesh.corner_vertex = square;
    assert_int_equal(gno_scene_add_mesh(scene, &mesh, NULL), GNO_OK);
    mesh.vertex_count = 8;
    mesh.positions = bar;
    mesh.polygon_count = mesh.ring_count = 6;
    mesh.corner_count = 24;
    mesh.corner_vertex = corners;
    assert_int_equal(gno_scene_add_mesh(scene, &mesh, NULL), GNO_OK);
    return scene;
}

static void check_shadow(double rise)
{
    static float normal[WIDTH * HEIGHT * 3], fine[WIDTH * HEIGHT * 3];
    gno_context *context;
    gno_scene *scene;
    gno_render_def how = gno_render_def_default();
    size_t wrong = 0;
    float least = 1;
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    scene = shadow_bar(context, rise);
    assert_int_equal(gno_render(scene, &how, normal, NULL), GNO_OK);
    how.base_lines = how.lines;
    assert_int_equal(gno_render(scene, &how, fine, NULL), GNO_OK);
    for (size_t i = 0; i < WIDTH * HEIGHT * 3; i++) {
        wrong += !(normal[i] - fine[i] < 1e-3f && fine[i] - normal[i] < 1e-3f);
        least = fine[i] < least ? fine[i] : least;
    }
    assert_int_equal(wrong, 0);
    assert_true(least < 0.38f); /* a fifth of the pixels' light is missing where the shadow falls */
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

static void test_closed_bar_shadow(void **state)
{
    (void)state;
    check_shadow(0);
    check_shadow(0.7);
    check_shadow(-0.3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_level), cmocka_unit_test(test_nearly_level),
                                       cmocka_unit_test(test_closed_bar_shadow)};
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
