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

/* White polygons of so many corners each, with a highlight. */
static void add_polygons(gno_scene *scene, gno_shading shading, const double *positions, size_t vertex_count, const int *corners, size_t count, size_t each)
{
    unsigned *rings = malloc((count + 1) * sizeof *rings);
    gno_mesh_def mesh = gno_mesh_def_default();
    gno_material m = gno_material_default();
    assert_non_null(rings);
    for (size_t i = 0; i <= count; i++)
        rings[i] = (unsigned)(each * i);
    for (int k = 0; k < 3; k++) {
        m.diffuse[k] = 0.6;
        m.specular[k] = 0.3;
    }
    m.shininess = 20;
    m.shading = shading;
    assert_int_equal(gno_scene_add_material(scene, &m, &mesh.material), GNO_OK);
    mesh.vertex_count = vertex_count;
    mesh.positions = positions;
    mesh.polygon_count = mesh.ring_count = count;
    mesh.corner_count = each * count;
    mesh.ring_start = rings;
    mesh.corner_vertex = corners;
    assert_int_equal(gno_scene_add_mesh(scene, &mesh, NULL), GNO_OK);
    free(rings);
}

/* A square about the origin, turned a little, in n x n cells of two triangles each. */
static void add_square(gno_scene *scene, double half, int n, gno_shading shading)
{
    const size_t across = (size_t)n + 1, cells = (size_t)n * (size_t)n;
    double *p = malloc(3 * across * across * sizeof *p);
    int *corners = malloc(6 * cells * sizeof *corners), *next = corners;
    assert_true(p && corners);
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
    add_polygons(scene, shading, p, across * across, corners, 2 * cells, 3);
    free(p);
    free(corners);
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

/* A bar in every pixel, seven tenths wide and three tenths high: in one of `every` it meets a base line (at a quarter of the pixel),
 * in the others it lies between the two. */
static void add_bars(gno_scene *scene, int every)
{
    static double p[4 * WIDTH * HEIGHT][3];
    static int corners[4 * WIDTH * HEIGHT];
    for (int i = 0; i < 4 * WIDTH * HEIGHT; i++) {
        const int x = i / 4 % WIDTH, y = i / 4 / WIDTH, right = i % 4 == 1 || i % 4 == 2, up = i % 4 >= 2;
        p[i][0] = x - WIDTH / 2 + (right ? 0.85 : 0.15);
        p[i][1] = y - HEIGHT / 2 + ((x + y) % every == 0 ? 0.1 : 0.35) + (up ? 0.3 : 0);
        p[i][2] = 0;
        corners[i] = i;
    }
    add_polygons(scene, GNO_SHADING_FLAT, &p[0][0], 4 * WIDTH * HEIGHT, corners, WIDTH * HEIGHT, 4);
}

/* Pixels that got more lines, and the largest difference to the picture with all lines everywhere. */
static float of_bars(int every, double *refined)
{
    static float rgb[2][VALUES];
    gno_context *context;
    gno_scene *scene = empty(&context, 0.5);
    gno_render_def how = gno_render_def_default();
    gno_stats stats;
    float most = 0;
    add_bars(scene, every);
    assert_int_equal(gno_render(scene, &how, rgb[0], &stats), GNO_OK);
    how.base_lines = how.lines;
    assert_int_equal(gno_render(scene, &how, rgb[1], NULL), GNO_OK);
    destroy(scene, context);
    for (size_t i = 0; i < VALUES; i++) {
        float d = rgb[0][i] > rgb[1][i] ? rgb[0][i] - rgb[1][i] : rgb[1][i] - rgb[0][i];
        most = d > most ? d : most;
    }
    *refined = (double)stats.refined_pixels;
    return most;
}

/* Where many pixels call for more lines their neighbours get them too. */
static void test_crowded_tiles(void **state)
{
    double refined;
    (void)state;
    assert_true(of_bars(4, &refined) < 1e-5f);
    assert_true(refined == (double)WIDTH * HEIGHT);
    assert_true(of_bars(40, &refined) > 0.02f);
    assert_true(refined < 0.3 * WIDTH * HEIGHT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_even_surfaces),
        cmocka_unit_test(test_small_triangles),
        cmocka_unit_test(test_middle_lines),
        cmocka_unit_test(test_crowded_tiles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
