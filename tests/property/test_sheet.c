/* test_sheet.c -- shadows of closed solids and of such as stand open on a plane, found by the contours of their far sides, against the same solids of a
 * material that lets a billionth of the light through: such solids are not halved, and every polygon casts for itself. And lines of one pixel
 * row, where much is carried from line to line, against the same lines each in a row of its own. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <gnomon/gnomon.h>
#include <math.h>
#include "support/solids.h"

#define WIDTH 96
#define HEIGHT 72
#define PI 3.14159265358979323846

/* ---- scenes -------------------------------------------------------------------------------------------------------- */

static void place(gno_mesh_def *mesh, int how, uint32_t *seed)
{
    double a = solid_uniform(seed, 0, 2 * PI), sx = solid_uniform(seed, 0.3, 1.2), sy = solid_uniform(seed, 0.3, 1.2), sz = solid_uniform(seed, 0.3, 2), tilt = 0;
    double x = solid_uniform(seed, -3, 3), y = solid_uniform(seed, -3, 3), z = 0;
    if (how == 1) /* through the ground */
        z = -solid_uniform(seed, 0, 1);
    if (how == 2) { /* in the air, tilted */
        z = solid_uniform(seed, 1, 3);
        tilt = solid_uniform(seed, -1, 1);
    }
    if (how == 3) /* mirrored, so that it is wound inwards */
        sx = -sx;
    mesh->transform[0] = sx * cos(a);
    mesh->transform[1] = -sy * sin(a);
    mesh->transform[4] = sx * sin(a);
    mesh->transform[5] = sy * cos(a);
    mesh->transform[8] = sx * tilt;
    mesh->transform[9] = sy * tilt;
    mesh->transform[10] = sz;
    mesh->transform[3] = x;
    mesh->transform[7] = y;
    mesh->transform[11] = z;
}

static void add_ground(gno_scene *scene)
{
    static const double p[12] = {-8, -8, 0, 8, -8, 0, 8, 8, 0, -8, 8, 0};
    static const unsigned ring[2] = {0, 4};
    static const int corners[4] = {0, 1, 2, 3};
    gno_mesh_def mesh = gno_mesh_def_default();
    mesh.vertex_count = mesh.corner_count = 4;
    mesh.positions = p;
    mesh.polygon_count = mesh.ring_count = 1;
    mesh.ring_start = ring;
    mesh.corner_vertex = corners;
    assert_int_equal(gno_scene_add_mesh(scene, &mesh, NULL), GNO_OK);
}

static void add_lights(gno_scene *scene, uint32_t *seed, int kinds)
{
    gno_light light = gno_light_default();
    light.type = kinds == 1 ? GNO_LIGHT_DIRECTIONAL : (gno_light_type)(solid_random(seed) % 3);
    light.position[0] = solid_uniform(seed, -6, 6);
    light.position[1] = solid_uniform(seed, -6, 6);
    light.position[2] = solid_uniform(seed, 5, 9);
    light.direction[0] = light.type == GNO_LIGHT_SPOT ? -light.position[0] : solid_uniform(seed, -1, 1);
    light.direction[1] = light.type == GNO_LIGHT_SPOT ? -light.position[1] : solid_uniform(seed, -1, 1);
    light.direction[2] = light.type == GNO_LIGHT_SPOT ? -light.position[2] : -1;
    light.angle = 50;
    assert_int_equal(gno_scene_add_light(scene, NULL, &light, NULL), GNO_OK);
}

/* kinds: of light; 1: suns alone, under which a flat surface is lit alike everywhere. */
static gno_scene *make_scene(gno_context *context, uint32_t seed, double transmission, int kinds, int scale)
{
    static solid s;
    gno_material material = gno_material_default();
    gno_camera camera = gno_camera_default();
    gno_image_def image = gno_image_def_default();
    gno_scene *scene;
    int number, index;
    assert_int_equal(gno_scene_create(context, &scene), GNO_OK);
    for (int k = 0; k < 3; k++)
        material.transmission[k] = transmission;
    assert_int_equal(gno_scene_add_material(scene, &material, &index), GNO_OK);
    add_ground(scene);
    number = 1 + (int)(solid_random(&seed) % 8);
    for (int i = 0; i < number; i++) {
        gno_mesh_def mesh;
        solid_make(&s, &seed, 1);
        mesh = solid_mesh(&s);
        mesh.material = index;
        place(&mesh, (int)(solid_random(&seed) % 4), &seed);
        assert_int_equal(gno_scene_add_mesh(scene, &mesh, NULL), GNO_OK);
    }
    add_lights(scene, &seed, kinds);
    add_lights(scene, &seed, kinds);
    camera.eye[0] = solid_uniform(&seed, -5, 5);
    camera.eye[1] = -9;
    camera.eye[2] = solid_uniform(&seed, 4, 8);
    if (solid_random(&seed) % 3 == 0) {
        camera.type = GNO_CAMERA_ORTHOGRAPHIC;
        camera.height = 9;
        camera.eye[2] = 14;
        camera.eye[1] = -14;
    }
    assert_int_equal(gno_scene_set_camera(scene, &camera), GNO_OK);
    image.width = WIDTH * scale;
    image.height = HEIGHT * scale;
    assert_int_equal(gno_scene_set_image(scene, &image), GNO_OK);
    return scene;
}

/* Number of pixels that differ by more than the place at which a lit part is shaded makes (its middle; what lets a billionth through
 * counts as lit). */
static int compare(const float *a, const float *b)
{
    int n = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        float d = 0;
        for (int k = 0; k < 3; k++)
            d = fmaxf(d, fabsf(a[3 * i + k] - b[3 * i + k]));
        n += d > 2e-2f;
    }
    return n;
}

static int differences(uint32_t seed)
{
    static float sheets[WIDTH * HEIGHT * 3], apart[WIDTH * HEIGHT * 3];
    gno_render_def how = gno_render_def_default();
    how.lines = how.base_lines = 3;
    how.threads = 1;
    for (int as_sheets = 0; as_sheets < 2; as_sheets++) {
        gno_context *context;
        gno_scene *scene;
        assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
        scene = make_scene(context, seed, as_sheets ? 0 : 1e-9, 3, 1);
        assert_int_equal(gno_render(scene, &how, as_sheets ? sheets : apart, NULL), GNO_OK);
        gno_scene_destroy(scene);
        gno_context_destroy(context);
    }
    return compare(sheets, apart);
}

static void test_sheets_agree(void **state)
{
    int wrong = 0;
    (void)state;
    for (uint32_t seed = 1; seed <= 60; seed++) {
        int n = differences(seed * 7919u);
        if (n)
            print_message("seed %u: %d pixels differ\n", seed, n);
        wrong += n;
    }
    assert_int_equal(wrong, 0);
}

#define LINES 9

static void draw(uint32_t seed, int scale, float *rgb)
{
    gno_render_def how = gno_render_def_default();
    gno_context *context;
    gno_scene *scene;
    how.lines = how.base_lines = LINES / scale;
    how.threads = 1;
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    scene = make_scene(context, seed, 0, 1, scale);
    assert_int_equal(gno_render(scene, &how, rgb, NULL), GNO_OK);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

/* Largest difference of a picture with LINES lines a row to one as many times as large with one line a row, averaged. */
static double difference_of_rows(uint32_t seed)
{
    static float rows[WIDTH * HEIGHT * 3], lines[WIDTH * HEIGHT * LINES * LINES * 3];
    double most = 0;
    draw(seed, 1, rows);
    draw(seed, LINES, lines);
    for (int i = 0; i < WIDTH * HEIGHT * 3; i++) {
        const int k = i % 3, x = i / 3 % WIDTH, y = i / 3 / WIDTH;
        double sum = 0;
        for (int j = 0; j < LINES * LINES; j++)
            sum += (double)lines[3 * ((LINES * y + j / LINES) * (LINES * WIDTH) + LINES * x + j % LINES) + k];
        most = fmax(most, fabs(sum / (LINES * LINES) - (double)rows[i]));
    }
    return most;
}

static void test_lines_of_a_row(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 12; seed++)
        assert_true(difference_of_rows(seed * 104729u) < 5e-5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_sheets_agree), cmocka_unit_test(test_lines_of_a_row)};
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
