/* test_soft_shadows.c -- shadows that weaken with the distance of their caster, and area lights as sets of points. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "down_view.h"

/* A sun straight from above: the shadow of what lies at height z has the distance z. */
static void add_sun(bench *b, double softness)
{
    gno_light sun = gno_light_default();
    sun.type = GNO_LIGHT_DIRECTIONAL;
    sun.direction[2] = -1;
    sun.softness = softness;
    assert_int_equal(gno_scene_add_light(b->scene, NULL, &sun, NULL), GNO_OK);
}

/* A white floor without ambient light, seen through casters that are seen by nobody: the eye looks from below them. */
static void set_up_floor(bench *b)
{
    const double none[3] = {0, 0, 0};
    gno_camera camera;
    set_up(b, 0);
    camera = gno_scene_camera(b->scene);
    camera.eye[2] = 0.5;
    assert_int_equal(gno_scene_set_camera(b->scene, &camera), GNO_OK);
    assert_int_equal(gno_scene_set_ambient(b->scene, none), GNO_OK);
    rectangle(b, -4, 4, -4, 4, 0, 0, material(b, 0, 1, 0), 0);
}

static double left(double transmission, double d, double softness) { return 1 - (1 - transmission) / (1 + d / softness); }

static void test_weakens_with_distance(void **state)
{
    bench b;
    (void)state;
    set_up_floor(&b);
    add_sun(&b, 2);
    rectangle(&b, -3, -1, -3, 3, 1, 0, 0, 0);
    rectangle(&b, 1, 3, -3, 3, 6, 0, 0, 0);
    draw(&b);
    expect(&b, -2, 0, left(0, 1, 2), 1e-5);
    expect(&b, 2, 0, left(0, 6, 2), 1e-5);
    expect(&b, 0, 0, 1, 1e-6);
    tear_down(&b);
}

static void test_overlaps_multiply(void **state)
{
    bench b;
    (void)state;
    set_up_floor(&b);
    add_sun(&b, 1.5);
    rectangle(&b, -3, 1, -3, 1, 1, 0, 0, 0);
    rectangle(&b, -1, 3, -1, 3, 2, 0, material(&b, 0, 0, 0.4), 0);
    rectangle(&b, 0, 3, 0, 3, 4, 0, 0, 0);
    draw(&b);
    expect(&b, -2, -2, left(0, 1, 1.5), 1e-5);
    expect(&b, -0.5, -0.5, left(0, 1, 1.5) * left(0.4, 2, 1.5), 1e-5);
    expect(&b, 0.5, 0.5, left(0, 1, 1.5) * left(0.4, 2, 1.5) * left(0, 4, 1.5), 1e-5);
    tear_down(&b);
}

/* The distance changes along the shadow: taken at the middle of each pixel. */
static void test_slanted_caster(void **state)
{
    bench b;
    (void)state;
    set_up_floor(&b);
    add_sun(&b, 1);
    rectangle(&b, -3, 3, -3, 3, 4, 1, 0, 0);
    draw(&b);
    for (double x = -2.75; x < 2.75; x += 0.25)
        expect(&b, x, 0, left(0, 4 + x + 0.125, 1), 1e-4);
    tear_down(&b);
}

/* A box counts with both its lids: nothing of a closed body is left out where shadows weaken. */
static void test_both_sides_of_a_body(void **state)
{
    static const double p[24] = {-2, -2, 1, 2, -2, 1, 2, 2, 1, -2, 2, 1, -2, -2, 3, 2, -2, 3, 2, 2, 3, -2, 2, 3};
    static const int corners[24] = {3, 2, 1, 0, 4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
    static const unsigned rings[7] = {0, 4, 8, 12, 16, 20, 24};
    gno_mesh_def mesh = gno_mesh_def_default();
    bench b;
    (void)state;
    set_up_floor(&b);
    add_sun(&b, 2);
    mesh.vertex_count = 8;
    mesh.positions = p;
    mesh.polygon_count = mesh.ring_count = 6;
    mesh.ring_start = rings;
    mesh.corner_count = 24;
    mesh.corner_vertex = corners;
    assert_int_equal(gno_scene_add_mesh(b.scene, &mesh, NULL), GNO_OK);
    draw(&b);
    expect(&b, 0, 0, left(0, 1, 2) * left(0, 3, 2), 1e-5);
    expect(&b, 3, 0, 1, 1e-6);
    tear_down(&b);
}

static void test_along_the_ray(void **state)
{
    gno_light lamp = gno_light_default();
    bench b;
    (void)state;
    set_up_floor(&b);
    lamp.position[2] = 4;
    lamp.softness = 1;
    assert_int_equal(gno_scene_add_light(b.scene, NULL, &lamp, NULL), GNO_OK);
    rectangle(&b, -1, 1, -1, 1, 3, 0, 0, 0); /* shadow on [-4,4]: a quarter of the ray lies above it */
    draw(&b);
    for (double x = -3; x <= 3; x += 1.5) {
        double px = x + 0.125, ray = sqrt(px * px + 0.125 * 0.125 + 16);
        expect(&b, x, 0, left(0, 0.75 * ray, 1) * 4 / ray, 2e-4);
    }
    tear_down(&b);
}

static void test_rejected(void **state)
{
    gno_light light = gno_light_default();
    bench b;
    (void)state;
    set_up(&b, 0);
    light.softness = -1;
    assert_int_equal(gno_scene_add_light(b.scene, NULL, &light, NULL), GNO_ERROR_ARGUMENT);
    light.softness = NAN;
    assert_int_equal(gno_scene_add_light(b.scene, NULL, &light, NULL), GNO_ERROR_ARGUMENT);
    tear_down(&b);
}

/* A table under a lamp of 3 x 3 points, or one of these points alone. */
static void draw_table(bench *b, const gno_light *light)
{
    gno_render_def how = gno_render_def_default();
    how.lines = how.base_lines = 8;
    set_up_floor(b);
    assert_int_equal(gno_scene_add_light(b->scene, NULL, light, NULL), GNO_OK);
    rectangle(b, -1.3, 1.1, -0.9, 1.2, 1, 0.1, 0, 0);
    rectangle(b, -3.1, -0.7, -2.2, 2.4, 1.7, 0, material(b, 0, 0, 0.35), 0);
    assert_int_equal(gno_render(b->scene, &how, b->rgb, NULL), GNO_OK);
}

static void check_sum(double softness)
{
    static double sum[SIDE * SIDE * 3];
    gno_light light = gno_light_default(), point;
    double worst = 0;
    bench b;
    for (size_t i = 0; i < SIDE * SIDE * 3; i++)
        sum[i] = 0;
    light.type = GNO_LIGHT_AREA;
    light.position[0] = -1;
    light.position[2] = 4;
    light.edge1[0] = 1.6;
    light.edge2[1] = 1.1;
    light.samples = 3;
    light.softness = softness;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            point = light;
            point.type = GNO_LIGHT_POINT;
            point.position[0] += 1.6 * (i + 0.5) / 3;
            point.position[1] += 1.1 * (j + 0.5) / 3;
            for (int k = 0; k < 3; k++)
                point.intensity[k] /= 9;
            draw_table(&b, &point);
            for (size_t k = 0; k < SIDE * SIDE * 3; k++)
                sum[k] += (double)b.rgb[k];
            tear_down(&b);
        }
    draw_table(&b, &light);
    for (size_t k = 0; k < SIDE * SIDE * 3; k++)
        worst = fmax(worst, fabs(sum[k] - (double)b.rgb[k]));
    tear_down(&b);
    assert_true(worst < 2e-6);
}

static void test_area_light_is_the_sum_of_its_points(void **state)
{
    (void)state;
    check_sum(0);
    check_sum(0.8);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_weakens_with_distance),
        cmocka_unit_test(test_overlaps_multiply),
        cmocka_unit_test(test_slanted_caster),
        cmocka_unit_test(test_both_sides_of_a_body),
        cmocka_unit_test(test_along_the_ray),
        cmocka_unit_test(test_rejected),
        cmocka_unit_test(test_area_light_is_the_sum_of_its_points),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
