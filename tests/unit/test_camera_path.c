/* test_camera_path.c -- cameras along a path: a turntable turns, keys are met exactly, what lies between is smooth and within bounds; what a
 * scene keeps from frame to frame.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>
#include <gnomon/gnomon_path.h>
#include <math.h>
#include <string.h>

#include "fail_alloc.h"
#include "support/random_scene.h"

static void assert_near(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance)) fail_msg("%.17g is not %.17g", a, b);
}

static void assert_point(const double p[3], double x, double y, double z)
{
    assert_near(p[0], x, 1e-12);
    assert_near(p[1], y, 1e-12);
    assert_near(p[2], z, 1e-12);
}

static void assert_same(const gno_camera *a, const gno_camera *b)
{
    assert_int_equal(a->type, b->type);
    assert_memory_equal(a->eye, b->eye, sizeof a->eye);
    assert_memory_equal(a->target, b->target, sizeof a->target);
    assert_memory_equal(a->up, b->up, sizeof a->up);
    assert_true(a->fov == b->fov && a->height == b->height);
}

static gno_camera at(const gno_camera_path *path, const gno_camera *start, double frame)
{
    gno_camera camera;
    assert_int_equal(gno_camera_path_at(path, start, frame, &camera), GNO_OK);
    return camera;
}

static void test_turntable(void **state)
{
    (void)state;
    gno_camera_path path = gno_camera_path_default();
    gno_camera start = gno_camera_default(), c;
    path.frames = 8;
    path.centre[0] = 1;
    start.eye[0] = 3;
    start.eye[1] = 0;
    start.target[0] = 1;
    start.fov = 33;
    c = at(&path, &start, 0);
    assert_same(&c, &start);
    c = at(&path, &start, 2); /* a quarter turn, counter-clockwise from above */
    assert_true(c.eye[0] == 1 && c.eye[1] == 2 && c.eye[2] == 2);
    assert_point(c.target, 1, 0, 1);
    assert_point(c.up, 0, 0, 1);
    assert_near(c.fov, 33, 0);
    c = at(&path, &start, 1);
    assert_point(c.eye, 1 + sqrt(2), sqrt(2), 2);
    c = at(&path, &start, 8);
    assert_same(&c, &start);
    path.angle = -180;
    c = at(&path, &start, 4);
    assert_point(c.eye, 1, -2, 2);
    path.axis[2] = 0;
    path.axis[0] = 5; /* any length */
    path.angle = 90;
    c = at(&path, &start, 8); /* eye, target and up turn together */
    assert_point(c.eye, 3, -2, 0);
    assert_point(c.target, 1, -1, 0);
    assert_point(c.up, 0, -1, 0);
}

static gno_camera_path with_keys(const gno_camera_key *keys, size_t count, gno_interpolation interpolation)
{
    gno_camera_path path = gno_camera_path_default();
    path.type = GNO_PATH_KEYS;
    path.keys = keys;
    path.key_count = count;
    path.interpolation = interpolation;
    path.frames = keys[count - 1].frame + 1;
    return path;
}

static const gno_camera_key keys[] = {
    {2, {0, -8, 1}, {0, 0, 0}, {0, 0, 1}, 20, 1},
    {6, {4, -8, 3}, {1, 0, 0}, {0, 0, 1}, 60, 5},
    {16, {4, 8, 3}, {1, 0, 2}, {0, 1, 1}, 60, 5},
    {17, {0, 8, 1}, {0, 0, 2}, {0, 0, 1}, 21, 2},
};

static void test_linear(void **state)
{
    (void)state;
    gno_camera_path path = with_keys(keys, 4, GNO_INTERPOLATION_LINEAR);
    gno_camera start = gno_camera_default(), c = at(&path, &start, 4);
    start.type = GNO_CAMERA_ORTHOGRAPHIC;
    assert_point(c.eye, 2, -8, 2);
    assert_point(c.target, 0.5, 0, 0);
    assert_near(c.fov, 40, 1e-12);
    assert_near(c.height, 3, 1e-12);
    assert_int_equal(c.type, GNO_CAMERA_PERSPECTIVE);
    assert_int_equal(at(&path, &start, 4).type, GNO_CAMERA_ORTHOGRAPHIC);
    c = at(&path, &start, 7);
    assert_point(c.eye, 4, -6.4, 3);
    c = at(&path, &start, 0); /* still before the first key, and after the last */
    assert_memory_equal(c.eye, keys[0].eye, sizeof c.eye);
    c = at(&path, &start, 99);
    assert_memory_equal(c.eye, keys[3].eye, sizeof c.eye);
}

/* Keys are met bit for bit, and neither place nor speed jumps there; fov and height stay between their keys. */
static void test_smooth(void **state)
{
    (void)state;
    for (int smooth = 0; smooth < 2; smooth++) {
        gno_camera_path path = with_keys(keys, 4, smooth ? GNO_INTERPOLATION_SMOOTH : GNO_INTERPOLATION_LINEAR);
        gno_camera start = gno_camera_default();
        for (size_t k = 0; k < 4; k++) {
            gno_camera c = at(&path, &start, keys[k].frame);
            assert_memory_equal(c.eye, keys[k].eye, sizeof c.eye);
            assert_memory_equal(c.target, keys[k].target, sizeof c.target);
            assert_true(c.fov == keys[k].fov && c.height == keys[k].height);
        }
        for (double f = 2; f <= 17; f += 0.125) {
            gno_camera c = at(&path, &start, f);
            assert_true(c.fov >= 20 && c.fov <= 60 && c.height >= 1 && c.height <= 5);
        }
        for (size_t k = 1; k < 3; k++) {
            double h = 1e-6, f = keys[k].frame, jump = 0;
            gno_camera a = at(&path, &start, f - h), b = at(&path, &start, f), c = at(&path, &start, f + h);
            for (int i = 0; i < 3; i++) jump = fmax(jump, fabs((c.eye[i] - b.eye[i]) - (b.eye[i] - a.eye[i])) / h);
            assert_true(smooth ? jump < 1e-4 : jump > 0.1);
        }
    }
}

/* A straight line at constant speed stays one. */
static void test_smooth_line(void **state)
{
    (void)state;
    const gno_camera_key line[] = {
        {0, {0, -9, 0}, {0, 0, 0}, {0, 0, 1}, 40, 1}, {3, {3, -9, 0}, {3, 0, 0}, {0, 0, 1}, 40, 1}, {10, {10, -9, 0}, {10, 0, 0}, {0, 0, 1}, 40, 1}};
    gno_camera_path path = with_keys(line, 3, GNO_INTERPOLATION_SMOOTH);
    gno_camera start = gno_camera_default();
    for (int f = 0; f <= 10; f++) assert_point(at(&path, &start, f).eye, f, -9, 0);
    path.key_count = 1;
    assert_point(at(&path, &start, 5).eye, 0, -9, 0);
}

static void test_wrong_paths(void **state)
{
    (void)state;
    gno_context *context;
    gno_scene *scene;
    gno_camera camera = gno_camera_default(), untouched = camera;
    gno_camera_path path = gno_camera_path_default(), read;
    gno_camera_key two[2] = {keys[0], keys[0]};
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    assert_int_equal(gno_scene_create(context, &scene), GNO_OK);
    assert_int_equal(gno_scene_camera_path(scene, &read), 0);
    assert_int_equal(gno_scene_set_camera_path(scene, &path), GNO_OK);
    assert_int_equal(gno_scene_camera_path(scene, &read), 1);
    assert_int_equal(read.frames, 60);
    path.axis[2] = 0;
    assert_int_equal(gno_camera_path_at(&path, &camera, 1, &camera), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_scene_set_camera_path(scene, &path), GNO_ERROR_ARGUMENT);
    path.axis[2] = NAN;
    assert_int_equal(gno_camera_path_at(&path, &camera, 1, &camera), GNO_ERROR_ARGUMENT);
    path = gno_camera_path_default();
    assert_int_equal(gno_camera_path_at(&path, &camera, NAN, &camera), GNO_ERROR_ARGUMENT);
    path.angle = INFINITY;
    assert_int_equal(gno_camera_path_at(&path, &camera, 1, &camera), GNO_ERROR_ARGUMENT);
    path = gno_camera_path_default();
    path.frames = 0;
    assert_int_equal(gno_scene_set_camera_path(scene, &path), GNO_ERROR_LIMIT);
    path.frames = GNO_MAX_FRAMES + 1;
    assert_int_equal(gno_scene_set_camera_path(scene, &path), GNO_ERROR_LIMIT);
    path = with_keys(two, 2, GNO_INTERPOLATION_LINEAR);
    assert_int_equal(gno_scene_set_camera_path(scene, &path), GNO_ERROR_ARGUMENT); /* frames do not ascend */
    two[1].frame = 4;
    two[1].eye[1] = 8; /* through the target */
    path.frames = 5;
    assert_int_equal(gno_scene_set_camera_path(scene, &path), GNO_ERROR_ARGUMENT);
    assert_non_null(strstr(gno_context_message(context), "frame 3"));
    path.keys = NULL;
    assert_int_equal(gno_camera_path_at(&path, &camera, 1, &camera), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_scene_camera_path(scene, &read), 1); /* still the first */
    assert_int_equal(read.type, GNO_PATH_TURNTABLE);
    assert_same(&camera, &untouched);
    assert_int_equal(gno_scene_set_camera_path(scene, NULL), GNO_OK);
    assert_int_equal(gno_scene_camera_path(scene, NULL), 0);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

/* The scene copies keys, and gives everything back, also when memory fails. */
static void test_scene_keeps_keys(void **state)
{
    (void)state;
    for (size_t fail_at = 0; fail_at < 4; fail_at++) {
        fail_alloc account = {0, 0, 0, 0};
        gno_context_def def = fail_alloc_def(&account);
        gno_camera_key own[4];
        gno_camera_path path = with_keys(own, 4, GNO_INTERPOLATION_LINEAR), read;
        gno_context *context;
        gno_scene *scene;
        assert_int_equal(gno_context_create(&def, &context), GNO_OK);
        assert_int_equal(gno_scene_create(context, &scene), GNO_OK);
        memcpy(own, keys, sizeof own);
        path.frames = 18;
        account.calls = 0;
        account.fail_at = fail_at;
        gno_status status = gno_scene_set_camera_path(scene, &path);
        assert_true(status == (fail_at == 1 || fail_at == 2 ? GNO_ERROR_MEMORY : GNO_OK));
        memset(own, 0, sizeof own);
        assert_int_equal(gno_scene_camera_path(scene, &read), status == GNO_OK);
        if (status == GNO_OK) assert_memory_equal(read.keys, keys, sizeof keys);
        gno_scene_destroy(scene);
        gno_context_destroy(context);
        assert_int_equal(account.held, 0);
        assert_false(account.wrong_size);
    }
}

/* The second view pays nothing for shadows. */
static void test_shadows_are_kept(void **state)
{
    (void)state;
    gno_context *context;
    gno_stats first, second;
    gno_camera_path path = gno_camera_path_default();
    static float rgb[3 * 64 * 48];
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    gno_scene *scene = random_scene(context, SCENE_BOXES, 3, 64, 48);
    assert_non_null(scene);
    gno_camera start = gno_scene_camera(scene), next = at(&path, &start, 7);
    assert_int_equal(gno_render(scene, NULL, rgb, &first), GNO_OK);
    assert_int_equal(gno_scene_set_camera(scene, &next), GNO_OK);
    assert_int_equal(gno_render(scene, NULL, rgb, &second), GNO_OK);
    assert_true(first.shadows_built == first.lights && first.lights > 0);
    assert_true(second.shadows_built == 0);
    gno_light light = gno_light_default();
    assert_int_equal(gno_scene_add_light(scene, "one more", &light, NULL), GNO_OK);
    assert_int_equal(gno_render(scene, NULL, rgb, &second), GNO_OK);
    assert_true(second.shadows_built == first.lights + 1);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_turntable),   cmocka_unit_test(test_linear),           cmocka_unit_test(test_smooth),          cmocka_unit_test(test_smooth_line),
        cmocka_unit_test(test_wrong_paths), cmocka_unit_test(test_scene_keeps_keys), cmocka_unit_test(test_shadows_are_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
