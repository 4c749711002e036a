/* test_stack.c -- surfaces that let light through: what they pass to the eye and in shadows, worked by hand. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "down_view.h"

static void test_shares_multiply(void **state)
{
    bench b;
    (void)state;
    for (int swap = 0; swap < 2; swap++) {
        set_up(&b, 1);
        rectangle(&b, -3, 1, -3, 1, swap ? 1 : 2, 0, material(&b, 0, 0, 0.8), 0);
        rectangle(&b, -1, 3, -1, 3, swap ? 2 : 1, 0, material(&b, 0, 0, 0.5), 0);
        draw(&b);
        expect(&b, 0, 0, 0.4, 1e-6);
        expect(&b, -2, -2, 0.8, 1e-6);
        expect(&b, 2, 2, 0.5, 1e-6);
        expect(&b, -3.5, 3, 1, 0);
        tear_down(&b);
    }
}

static void test_own_light_is_not_weakened(void **state)
{
    bench b;
    (void)state;
    set_up(&b, 0.5);
    rectangle(&b, -3, 3, -3, 3, 0, 0, material(&b, 0.7, 0, 0), 0);   /* an opaque ground */
    rectangle(&b, -2, 2, -2, 2, 1, 0, material(&b, 0.2, 0, 0.5), 0);
    rectangle(&b, -1, 4, -1, 4, 2, 0, material(&b, 0.1, 0, 0.25), 0);
    draw(&b);
    expect(&b, -3, 0, 0.7, 1e-6);
    expect(&b, -2, 0, 0.2 + 0.5 * 0.7, 1e-6);
    expect(&b, 0, 0, 0.1 + 0.25 * (0.2 + 0.5 * 0.7), 1e-6);
    expect(&b, 3.5, 3.5, 0.1 + 0.25 * 0.5, 1e-6);
    tear_down(&b);
}

static void test_many_layers(void **state)
{
    bench b;
    double want = 1;
    int glass;
    (void)state;
    set_up(&b, 1);
    glass = material(&b, 0.01, 0, 0.95);
    for (int i = 0; i < 70; i++) {
        rectangle(&b, -3, 3, -3, 3, 0.1 * ((i * 37) % 70), 0, glass, 0);
        want = 0.01 + 0.95 * want;
    }
    draw(&b);
    expect(&b, 0, 0, want, 1e-5);
    tear_down(&b);
}

/* Two panes through each other along the line x = 0: each is in front on one side of it. */
static void test_crossing_panes(void **state)
{
    bench b;
    (void)state;
    set_up(&b, 1);
    rectangle(&b, -3, 3, -3, 3, 0, 0.5, material(&b, 0.3, 0, 0.5), 0);
    rectangle(&b, -3, 3, -3, 3, 0, -0.5, material(&b, 0.1, 0, 0.25), 0);
    draw(&b);
    expect(&b, 0, 0, 0.3 + 0.5 * (0.1 + 0.25), 1e-6);
    expect(&b, -0.25, 0, 0.1 + 0.25 * (0.3 + 0.5), 1e-6);
    expect(&b, -2, 1, 0.1 + 0.25 * (0.3 + 0.5), 1e-6);
    tear_down(&b);
}

/* A pane through an opaque wall is seen where it is in front, and through it the wall. */
static void test_pane_through_wall(void **state)
{
    bench b;
    (void)state;
    set_up(&b, 1);
    rectangle(&b, -3, 3, -3, 3, 0, 0.5, material(&b, 0.3, 0, 0), 0);
    rectangle(&b, -3, 3, -3, 3, 0, -0.5, material(&b, 0.1, 0, 0.25), 0);
    draw(&b);
    expect(&b, 0, 0, 0.3, 1e-6);
    expect(&b, -0.25, 0, 0.1 + 0.25 * 0.3, 1e-6);
    tear_down(&b);
}

static void test_coplanar_panes(void **state)
{
    bench b;
    (void)state;
    set_up(&b, 1);
    rectangle(&b, -3, 1, -3, 3, 0, 0, material(&b, 0.3, 0, 0.5), 0);
    rectangle(&b, -1, 3, 0, 3, 0, 0, material(&b, 0.1, 0, 0.25), 0);  /* the lower index is in front */
    rectangle(&b, -1, 3, -3, 0, 0, 0, material(&b, 0.1, 0, 0.25), 1); /* the higher priority is */
    rectangle(&b, -4, 4, 2, 2.5, 0, 0, material(&b, 0.6, 0, 0), -1);  /* opaque, behind both */
    draw(&b);
    expect(&b, 0, 1, 0.3 + 0.5 * (0.1 + 0.25), 1e-6);
    expect(&b, 0, -1, 0.1 + 0.25 * (0.3 + 0.5), 1e-6);
    expect(&b, 0, 2, 0.3 + 0.5 * (0.1 + 0.25 * 0.6), 1e-6);
    expect(&b, 2, 2, 0.1 + 0.25 * 0.6, 1e-6);
    tear_down(&b);
}

/* The sun through two panes: shadows multiply as what the eye sees does; the floor is also a receiver behind glass, and a pane one
 * beneath the other. */
static void test_shadows_multiply(void **state)
{
    bench b;
    gno_light sun = gno_light_default();
    const double none[3] = {0, 0, 0};
    (void)state;
    set_up(&b, 0);
    assert_int_equal(gno_scene_set_ambient(b.scene, none), GNO_OK);
    sun.type = GNO_LIGHT_DIRECTIONAL;
    sun.direction[0] = 1; /* falls to the right by as much as it goes down */
    sun.direction[2] = -1;
    for (int k = 0; k < 3; k++)
        sun.intensity[k] = sqrt(2.0);
    assert_int_equal(gno_scene_add_light(b.scene, NULL, &sun, NULL), GNO_OK);
    rectangle(&b, -4, 4, -4, 4, 0, 0, material(&b, 0, 1, 0), 0);
    rectangle(&b, -4, -2, -2, 2, 4, 0, material(&b, 0, 0, 0.8), 0);  /* shadow on [0,2] */
    rectangle(&b, -2, 0, -2, 4, 3, 0, material(&b, 0, 0.1, 0.5), 0); /* on [1,3] */
    draw(&b);
    expect(&b, 0.5, 0, 0.8, 1e-5);
    expect(&b, 1.5, 0, 0.4, 1e-5);
    expect(&b, 2.5, 0, 0.5, 1e-5);
    expect(&b, 3.5, 0, 1, 1e-5);
    expect(&b, -3, 0, 0.8, 1e-5);                                    /* the lit floor through a pane */
    expect(&b, -2, 0, 0.1 * 0.8 + 0.5, 1e-5);                        /* the lower pane in the upper's shadow, the floor lit */
    expect(&b, -1.25, 0, 0.1 * 0.8 + 0.5, 1e-5);
    expect(&b, -1, 0, 0.1 + 0.5, 1e-5);
    expect(&b, -1, 3, 0.1 + 0.5, 1e-5);
    tear_down(&b);
}

/* Edges of panes are as fine by the default lines as by all lines everywhere. */
static void test_refined(void **state)
{
    static float fine[SIDE * SIDE * 3];
    gno_render_def all = gno_render_def_default();
    double worst = 0;
    bench b;
    (void)state;
    all.base_lines = all.lines;
    set_up(&b, 1);
    rectangle(&b, -3, 3, -2.9, 2.03, 0, 0, material(&b, 0.2, 0, 0), 0);
    for (int i = 0; i < 3; i++) {
        gno_camera c = gno_scene_camera(b.scene);
        rectangle(&b, -2 + i, 1 + i, -2.1 + i, 0.33 + i, 1 + i, 0.1, material(&b, 0.05 * i, 0, 0.5 + 0.1 * i), 0);
        c.up[0] = 0.15 * (i + 1);
        assert_int_equal(gno_scene_set_camera(b.scene, &c), GNO_OK);
        draw(&b);
        assert_int_equal(gno_render(b.scene, &all, fine, NULL), GNO_OK);
        for (size_t k = 0; k < SIDE * SIDE * 3; k++)
            worst = fmax(worst, fabs((double)(b.rgb[k] - fine[k])));
    }
    assert_true(worst < 0.015);
    tear_down(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shares_multiply),
        cmocka_unit_test(test_own_light_is_not_weakened),
        cmocka_unit_test(test_many_layers),
        cmocka_unit_test(test_crossing_panes),
        cmocka_unit_test(test_pane_through_wall),
        cmocka_unit_test(test_coplanar_panes),
        cmocka_unit_test(test_shadows_multiply),
        cmocka_unit_test(test_refined),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
