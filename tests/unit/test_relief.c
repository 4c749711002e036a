/* test_relief.c -- normals bumped several at a time against the same normals bumped one by one, bit by bit: random planes under a perspective
 * and an orthographic view, a pattern enlarged, reduced and drawn out, in and out of the picture.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include "shade/relief.h"
#include "support/random_scene.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ROUNDS 2000
#define SIDE 37

static uint64_t state = 5;

static double between(double a, double b) { return a + (b - a) * random_unit(&state); }

static gno_scene *make_scene(gno_context *context, gno_material *m)
{
    static unsigned char bytes[SIDE * SIDE * 3];
    gno_scene *scene = NULL;
    gno_pixels pixels;
    memset(&pixels, 0, sizeof pixels);
    for (size_t i = 0; i < sizeof bytes; i++) bytes[i] = (unsigned char)(256 * random_unit(&state));
    pixels.width = pixels.height = SIDE;
    pixels.channels = 3;
    pixels.bytes = bytes;
    assert_int_equal(gno_scene_create(context, &scene), GNO_OK);
    *m = gno_material_default();
    m->bump.kind = GNO_BUMP_HEIGHT;
    m->bump.texture = gno_texture_default(GNO_MAP_PLANAR);
    m->bump.texture.kind = GNO_TEXTURE_IMAGE;
    m->bump.amount = 0.3;
    assert_int_equal(gno_scene_add_image(scene, &pixels, &m->bump.texture.image), GNO_OK);
    assert_int_equal(gno_scene_add_material(scene, m, NULL), GNO_OK);
    return scene;
}

static gnoi_pattern random_pattern(double bend)
{
    double size = pow(10, between(-4, -0.5));
    gnoi_pattern p;
    p.s.fx = size * between(-1, 1), p.s.fy = size * between(-1, 1), p.s.f0 = between(-3, 3);
    p.t.fx = size * between(-1, 1), p.t.fy = size * between(-1, 1), p.t.f0 = between(-3, 3);
    p.w.fx = bend * between(-1, 1), p.w.fy = bend * between(-1, 1), p.w.f0 = 1;
    return p;
}

/* Returns whether the run was taken. */
static int compare(const gnoi_sight *sight, const gno_bump *bump, int count)
{
    gnoi_mapping mapping;
    double x[GNOI_RELIEF_RUN], y[GNOI_RELIEF_RUN], n[3][GNOI_RELIEF_RUN], x0 = between(0, 60), y0 = between(0, 40);
    vec3 own[GNOI_RELIEF_RUN];
    memset(&mapping, 0, sizeof mapping);
    mapping.ready = 1;
    mapping.place.map = GNO_MAP_PLANAR;
    mapping.pattern = random_pattern(between(0, 0.02));
    for (int i = 0; i < GNOI_RELIEF_RUN; i++) {
        x[i] = x0 + i;
        y[i] = y0 + between(-0.4, 0.4);
        own[i] = v3_unit(v3(between(-1, 1), between(-1, 1), between(-1, 1)));
        n[0][i] = own[i].x, n[1][i] = own[i].y, n[2][i] = own[i].z;
    }
    int taken = gnoi_relief_run(sight, bump, &mapping.pattern, count, x, y, n);
    for (int i = 0; i < count; i++) {
        vec3 alone = gnoi_relief_normal(sight, bump, &mapping, x[i], y[i], x[i], y[i], own[i]);
        if (!taken) alone = own[i];
        assert_true(n[0][i] == alone.x && n[1][i] == alone.y && n[2][i] == alone.z);
    }
    return taken;
}

static void compare_view(gno_camera_type type)
{
    gno_context *context = NULL;
    gno_material m;
    gno_camera camera = gno_camera_default();
    gno_image_def image = gno_image_def_default();
    int taken = 0;
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    gno_scene *scene = make_scene(context, &m);
    camera.type = type;
    image.width = 64;
    image.height = 48;
    gnoi_view view = gnoi_view_make(&camera, &image, 1);
    for (int i = 0; i < ROUNDS; i++) {
        gnoi_screen_plane nearness = {between(-0.001, 0.001), between(-0.001, 0.001), between(0.1, 1)};
        gnoi_sight sight = {scene, &view, NULL, &nearness, NULL};
        m.bump.texture.wrap = i % 2 ? GNO_WRAP_REPEAT : GNO_WRAP_CLAMP;
        taken += compare(&sight, &m.bump, 1 + i % GNOI_RELIEF_RUN);
    }
    assert_true(taken > ROUNDS / 2);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

static void test_perspective(void **unused) { (void)unused; compare_view(GNO_CAMERA_PERSPECTIVE); }
static void test_orthographic(void **unused) { (void)unused; compare_view(GNO_CAMERA_ORTHOGRAPHIC); }

/* Before the horizon of the pattern and beyond it at once: each sample is looked at alone. */
static void test_horizon(void **unused)
{
    (void)unused;
    gno_context *context = NULL;
    gno_material m;
    gno_camera camera = gno_camera_default();
    gno_image_def image = gno_image_def_default();
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    gno_scene *scene = make_scene(context, &m);
    gnoi_view view = gnoi_view_make(&camera, &image, 1);
    gnoi_screen_plane nearness = {0, 0, 1};
    gnoi_sight sight = {scene, &view, NULL, &nearness, NULL};
    gnoi_pattern p = {{0.01, 0, 0.3}, {0, 0.01, 0.2}, {-0.1, 0, 0.35}};
    double x[GNOI_RELIEF_RUN], y[GNOI_RELIEF_RUN], n[3][GNOI_RELIEF_RUN];
    for (int i = 0; i < GNOI_RELIEF_RUN; i++) {
        x[i] = i;
        y[i] = 0;
        n[0][i] = n[1][i] = 0, n[2][i] = 1;
    }
    assert_int_equal(gnoi_relief_run(&sight, &m.bump, &p, 3, x, y, n), 1);
    for (int i = 0; i < GNOI_RELIEF_RUN; i++) n[0][i] = n[1][i] = 0, n[2][i] = 1;
    assert_int_equal(gnoi_relief_run(&sight, &m.bump, &p, 5, x, y, n), 0);
    for (int i = 0; i < 5; i++) assert_true(n[0][i] == 0 && n[1][i] == 0 && n[2][i] == 1);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_perspective),
        cmocka_unit_test(test_orthographic),
        cmocka_unit_test(test_horizon),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
