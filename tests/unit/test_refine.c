/* test_refine.c -- which pixels get more lines, and how many; a surface in triangles smaller than a pixel looks as in one piece. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <gnomon/gnomon.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH 64
#define HEIGHT 40
#define VALUES ((size_t)WIDTH * HEIGHT * 3)

/* Seen from above, one unit to a pixel; nothing in it. */
static gno_scene *empty(gno_context **context, double ambient)
{
    const double rgb[3] = {ambient, ambient, ambient};
    gno_camera camera = gno_camera_default();
    gno_image_def image = gno_image_def_default();
    gno_scene *scene;
    assert_int_equal(gno_context_create(NULL, context), GNO_OK);
    assert_int_equal(gno_scene_create(*context, &scene), GNO_OK);
    camera.type = GNO_CAMERA_ORTHOGRAPHIC;
    camera.eye[0] = camera.eye[1] = camera.target[0] = camera.target[1] = camera.target[2] = 0;
    camera.eye[2] = 100;
    camera.up[0] = camera.up[2] = 0;
    camera.up[1] = 1;
    camera.height = HEIGHT;
    image.width = WIDTH;
    image.height = HEIGHT;
    assert_int_equal(gno_scene_set_camera(scene, &camera), GNO_OK);
    assert_int_equal(gno_scene_set_image(scene, &image), GNO_OK);
    assert_int_equal(gno_scene_set_ambient(scene, rgb), GNO_OK);
    return scene;
}

static void destroy(gno_scene *scene, gno_context *context)
{
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

/* A square about the origin, turned a little, in n x n cells of two triangles each; white, with a highlight. */
static void add_square(gno_scene *scene, double half, int n, gno_shading shading)
{
    const size_t across = (size_t)n + 1, cells = (size_t)n * (size_t)n;
    double *p = malloc(3 * across * across * sizeof *p);
    int *corners = malloc(6 * cells * sizeof *corners), *next = corners;
    unsigned *rings = malloc((2 * cells + 1) * sizeof *rings);
    gno_mesh_def mesh = gno_mesh_def_default();
    gno_material m = gno_material_default();
    assert_true(p && corners && rings);
    for (size_t i = 0; i < across * across; i++) {
        double x = half * (2.0 * (double)(i % across) / n - 1), y = half * (2.0 * (double)(i / across) / n - 1);
        p[3 * i] = x - 0.2 * y;
        p[3 * i + 1] = y + 0.2 * x;
        p[3 * i + 2] = 0;
    }
    for (int i = 0; i < n * n; i++) {
        const int a = i / n * (n + 1) + i % n, square[6] = {a, a + 1, a + n + 2, a, a + n + 2, a + n + 1};
        memcpy(next, square, sizeof square);
        next += 6;
    }
    for (size_t i = 0; i <= 2 * cells; i++)
        rings[i] = (unsigned)(3 * i);
    for (int k = 0; k < 3; k++) {
        m.diffuse[k] = 0.6;
        m.specular[k] = 0.3;
    }
    m.shininess = 20;
    m.shading = shading;
    assert_int_equal(gno_scene_add_material(scene, &m, &mesh.material), GNO_OK);
    mesh.vertex_count = across * across;
    mesh.positions = p;
    mesh.polygon_count = mesh.ring_count = 2 * cells;
    mesh.corner_count = 6 * cells;
    mesh.ring_start = rings;
    mesh.corner_vertex = corners;
    assert_int_equal(gno_scene_add_mesh(scene, &mesh, NULL), GNO_OK);
    free(p);
    free(corners);
    free(rings);
}

static void add_lights(gno_scene *scene)
{
    gno_light light = gno_light_default();
    light.type = GNO_LIGHT_DIRECTIONAL;
    light.direction[0] = 0.3;
    light.direction[1] = 0.1;
    light.direction[2] = -1;
    assert_int_equal(gno_scene_add_light(scene, NULL, &light, NULL), GNO_OK);
    light.type = GNO_LIGHT_POINT;
    light.position[0] = 20;
    light.position[1] = -30;
    light.position[2] = 60;
    assert_int_equal(gno_scene_add_light(scene, NULL, &light, NULL), GNO_OK);
}

static void test_even_surfaces(void **state)
{
    static const gno_shading shadings[] = {GNO_SHADING_FLAT, GNO_SHADING_CONSTANT, GNO_SHADING_GOURAUD, GNO_SHADING_PHONG};
    static float rgb[VALUES];
    (void)state;
    for (size_t i = 0; i < sizeof shadings / sizeof *shadings; i++) {
        gno_context *context;
        gno_scene *scene = empty(&context, 0.8);
        gno_stats stats;
        add_square(scene, 100, 1, shadings[i]);
        assert_int_equal(gno_render(scene, NULL, rgb, &stats), GNO_OK);
        assert_true(stats.refined_pixels == 0);
        destroy(scene, context);
    }
}

/* How far the picture of a square in small triangles is from that of two large ones. */
static float difference(gno_shading shading, double half, const gno_render_def *how)
{
    static float rgb[2][VALUES];
    float most = 0;
    for (int k = 0; k < 2; k++) {
        gno_context *context;
        gno_scene *scene = empty(&context, 0.2);
        add_square(scene, half, k ? 130 : 1, shading);
        add_lights(scene);
        assert_int_equal(gno_render(scene, how, rgb[k], NULL), GNO_OK);
        destroy(scene, context);
    }
    for (size_t i = 0; i < VALUES; i++) {
        float d = rgb[0][i] > rgb[1][i] ? rgb[0][i] - rgb[1][i] : rgb[1][i] - rgb[0][i];
        most = d > most ? d : most;
    }
    assert_true(rgb[0][3 * (HEIGHT / 2 * WIDTH + WIDTH / 2)] > 0.3f);
    return most;
}

static void test_small_triangles(void **state)
{
    gno_render_def how = gno_render_def_default();
    (void)state;
    assert_true(difference(GNO_SHADING_FLAT, 16, &how) < 2e-4f);
    assert_true(difference(GNO_SHADING_PHONG, 16, &how) < 2e-4f);
    how.lines = how.base_lines = 3;
    assert_true(difference(GNO_SHADING_FLAT, 16, &how) < 2e-4f);
    assert_true(difference(GNO_SHADING_PHONG, 40, &how) < 2e-4f);
}

/* Whether the default lines make of a square's border what 2:`lines` make of it. */
static int same_as(double ambient, int lines)
{
    static float rgb[2][VALUES];
    gno_context *context;
    gno_scene *scene = empty(&context, ambient);
    gno_render_def how = gno_render_def_default();
    gno_stats stats;
    add_square(scene, 12, 1, GNO_SHADING_FLAT);
    assert_int_equal(gno_render(scene, &how, rgb[0], &stats), GNO_OK);
    assert_true(stats.refined_pixels > 0);
    how.lines = lines;
    assert_int_equal(gno_render(scene, &how, rgb[1], NULL), GNO_OK);
    destroy(scene, context);
    return memcmp(rgb[0], rgb[1], sizeof rgb[0]) == 0;
}

static void test_middle_lines(void **state)
{
    const gno_render_def how = gno_render_def_default();
    (void)state;
    assert_int_equal(how.lines, 18);
    assert_true(same_as(2.0 * how.refine_above, 6));
    assert_false(same_as(2.0 * how.refine_above, 10));
    assert_false(same_as(40.0 * how.refine_above, 6));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_even_surfaces),
        cmocka_unit_test(test_small_triangles),
        cmocka_unit_test(test_middle_lines),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
