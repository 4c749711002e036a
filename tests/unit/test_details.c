/* test_details.c -- polygons that lie on others: in front of them whatever rounding says, lit like them, casting no shadow of their
 * own; those marked by the caller, and those found in the plane of larger ones. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "down_view.h"
#include <string.h>

static void mark(bench *b, size_t object, int polygon)
{
    assert_int_equal(gno_scene_set_detail_of(b->scene, object, polygon), GNO_OK);
}

/* ---- marked --------------------------------------------------------------------------------------------------------- */

/* A wall seen aslant; a detail whose corners are off its plane, within the limit, both ways; one on it that comes first. */
static void test_in_front_and_nested(void **state)
{
    bench b;
    (void)state;
    set_up(&b, 0);
    rectangle(&b, -1, 1, -1, 1, 0, 0.5, material(&b, 0.3, 0, 0), 0);         /* object 0: on the detail */
    rectangle(&b, -3, 3, -3, 3, 0, 0.5, material(&b, 0.1, 0, 0), 0);         /* 1: the wall */
    rectangle(&b, -2, 2, -2, 2, -3e-4, 0.50005, material(&b, 0.2, 0, 0), 0); /* 2: the detail, behind it by its corners */
    rectangle(&b, 2, 2.5, -2, 2, 2e-4, 0.5, material(&b, 0.7, 0, 0), 0);     /* 3: not marked, before it */
    mark(&b, 0, 2);
    mark(&b, 2, 1);
    draw(&b);
    expect(&b, 0, 0, 0.3, 1e-6);
    expect(&b, 1.5, 1.5, 0.2, 1e-6);
    expect(&b, -2, -2, 0.2, 1e-6);
    expect(&b, -2.5, 0, 0.1, 1e-6);
    expect(&b, 2, 0, 0.7, 1e-6);
    tear_down(&b);
}

static void test_given_with_the_mesh(void **state)
{
    const double p[12] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
    const unsigned ring[2] = {0, 4};
    const int corners[4] = {0, 1, 2, 3};
    gno_mesh_def mesh = gno_mesh_def_default();
    gno_polygon read;
    bench b;
    (void)state;
    set_up(&b, 0);
    rectangle(&b, -3, 3, -3, 3, 0, 0, material(&b, 0.1, 0, 0), 4);
    mesh.vertex_count = mesh.corner_count = 4;
    mesh.positions = p;
    mesh.polygon_count = mesh.ring_count = 1;
    mesh.ring_start = ring;
    mesh.corner_vertex = corners;
    mesh.material = material(&b, 0.5, 0, 0);
    mesh.detail_of = 1;
    assert_int_equal(gno_scene_add_mesh(b.scene, &mesh, NULL), GNO_ERROR_ARGUMENT); /* no such polygon */
    mesh.detail_of = 0;
    mesh.transform[11] = 0.01;
    assert_int_equal(gno_scene_add_mesh(b.scene, &mesh, NULL), GNO_ERROR_ARGUMENT); /* off the plane */
    assert_non_null(strstr(gno_context_message(b.context), "off the plane"));
    assert_int_equal(gno_scene_count(b.scene).objects, 1);
    mesh.transform[11] = 0;
    assert_int_equal(gno_scene_add_mesh(b.scene, &mesh, NULL), GNO_OK);
    assert_int_equal(gno_scene_polygon(b.scene, 1, &read), GNO_OK);
    assert_int_equal(read.detail_of, 0);
    draw(&b);
    expect(&b, 0, 0, 0.5, 1e-6);
    tear_down(&b);
}

static void test_wrong_marks(void **state)
{
    bench b;
    (void)state;
    set_up(&b, 0);
    for (int i = 0; i < 3; i++)
        rectangle(&b, -3 + i, 3, -3, 3, 0, 0, 0, 0);
    rectangle(&b, -1, 1, -1, 1, 0.5, 0, 0, 0);
    assert_int_equal(gno_scene_set_detail_of(b.scene, 4, 0), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_scene_set_detail_of(b.scene, 0, 4), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_scene_set_detail_of(b.scene, 0, 0), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_scene_set_detail_of(b.scene, 3, 0), GNO_ERROR_ARGUMENT);
    mark(&b, 1, 0);
    mark(&b, 2, 1);
    assert_int_equal(gno_scene_set_detail_of(b.scene, 0, 2), GNO_ERROR_ARGUMENT);
    assert_non_null(strstr(gno_context_message(b.context), "a detail of itself"));
    mark(&b, 1, -1);
    mark(&b, 0, 2);
    draw(&b);
    tear_down(&b);
}

/* By visible pieces instead of lines: the other engine has to agree. */
static void draw_pieces(bench *b)
{
    gno_render_def how = gno_render_def_default();
    how.engine = GNO_ENGINE_WEILER_ATHERTON;
    assert_int_equal(gno_render(b->scene, &how, b->rgb, NULL), GNO_OK);
}

/* A pane with an opaque sign on it, and the sign reaching beyond the pane: the floor has the pane's shadow alone; the sign has that
 * of a bar above it, as the pane has. */
static void test_shadows(void **state)
{
    gno_light sun = gno_light_default();
    gno_camera camera;
    const double none[3] = {0, 0, 0};
    bench b;
    (void)state;
    set_up(&b, 0);
    assert_int_equal(gno_scene_set_ambient(b.scene, none), GNO_OK);
    sun.type = GNO_LIGHT_DIRECTIONAL;
    sun.direction[2] = -1;
    assert_int_equal(gno_scene_add_light(b.scene, NULL, &sun, NULL), GNO_OK);
    rectangle(&b, -4, 4, -4, 4, 0, 0, material(&b, 0, 1, 0), 0);
    rectangle(&b, -2, 2, -2, 2, 2, 0, material(&b, 0, 0.1, 0.6), 0);
    rectangle(&b, -1, 3, -1, 1, 2, 0, material(&b, 0, 0.5, 0), 0);
    rectangle(&b, -4, 4, 0, 0.5, 3, 0, material(&b, 0, 0, 0), 0);
    mark(&b, 2, 1);
    camera = gno_scene_camera(b.scene);
    camera.eye[2] = 2.5;
    assert_int_equal(gno_scene_set_camera(b.scene, &camera), GNO_OK);
    for (int pieces = 0; pieces < 2; pieces++) { /* from above the sign, below the bar */
        if (pieces)
            draw_pieces(&b);
        else
            draw(&b);
        expect(&b, 0, -0.75, 0.5, 1e-5);
        expect(&b, 2.5, -0.75, 0.5, 1e-5);
        expect(&b, 0, 0.25, 0, 1e-5);
        expect(&b, -1.5, 1.5, 0.1 + 0.6 * 0.6, 1e-5);
    }
    camera.eye[2] = 1;
    assert_int_equal(gno_scene_set_camera(b.scene, &camera), GNO_OK);
    for (int pieces = 0; pieces < 2; pieces++) { /* the floor */
        if (pieces)
            draw_pieces(&b);
        else
            draw(&b);
        expect(&b, 0, -0.75, 0.6, 1e-5);
        expect(&b, -1.5, 1.5, 0.6, 1e-5);
        expect(&b, 2.5, -0.75, 1, 1e-5);
        expect(&b, 0, 0.25, 0, 1e-5);
    }
    tear_down(&b);
}

/* ---- found ------------------------------------------------------------------------------------------------------------ */

static size_t found(bench *b, int find)
{
    gno_scene_problems problems;
    assert_int_equal(gno_scene_find_details(b->scene, find), GNO_OK);
    assert_int_equal(gno_scene_prepare(b->scene, 1, &problems), GNO_OK);
    return problems.details;
}

static void test_found_and_nested(void **state)
{
    bench b;
    (void)state;
    set_up(&b, 0);
    rectangle(&b, -3, 3, -3, 3, 0, 0.3, material(&b, 0.1, 0, 0), 0);
    rectangle(&b, -3, 2, -2, 2, 0, 0.3, material(&b, 0.2, 0, 0), 0); /* shares the wall's edge */
    rectangle(&b, -1, 1, -1, 1, 0, 0.3, material(&b, 0.3, 0, 0), 0);
    rectangle(&b, 2.5, 3.5, -1, 1, 0, 0.3, material(&b, 0.4, 0, 0), 0); /* sticks out */
    assert_int_equal(found(&b, 0), 0);
    draw(&b);
    expect(&b, 0, 0, 0.1, 1e-6);
    assert_int_equal(found(&b, 1), 2);
    draw(&b);
    expect(&b, 0, 0, 0.3, 1e-6);
    expect(&b, -2.5, 0, 0.2, 1e-6);
    expect(&b, 0, 2.5, 0.1, 1e-6);
    expect(&b, 2.5, 0, 0.1, 1e-6);
    expect(&b, 3, 0, 0.4, 1e-6);
    tear_down(&b);
}

/* A polygon given by its outline in the plane z = 0 and any number of corners; a hole behind it. */
static void outline(bench *b, const double (*xy)[2], unsigned corners, unsigned hole, int reverse, double z)
{
    double p[16][3];
    int order[16];
    unsigned rings[3] = {0, corners, corners + hole}, polygon[2] = {0, hole ? 2 : 1};
    gno_mesh_def mesh = gno_mesh_def_default();
    for (unsigned i = 0; i < corners + hole; i++) {
        p[i][0] = xy[i][0];
        p[i][1] = xy[i][1];
        p[i][2] = z;
        order[i] = (int)(reverse ? corners - 1 - i : i);
    }
    mesh.vertex_count = mesh.corner_count = corners + hole;
    mesh.positions = p[0];
    mesh.polygon_count = 1;
    mesh.polygon_start = polygon;
    mesh.ring_count = polygon[1];
    mesh.ring_start = rings;
    mesh.corner_vertex = order;
    assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, NULL), GNO_OK);
}

static void test_not_found(void **state)
{
    static const double notched[8][2] = {{-3, -3}, {3, -3}, {3, 3}, {1, 3}, {1, 0}, {-1, 0}, {-1, 3}, {-3, 3}};
    static const double framed[8][2] = {{-3, -3}, {3, -3}, {3, 3}, {-3, 3}, {-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    static const double across[4][2] = {{-2, 1}, {2, 1}, {2, 2}, {-2, 2}}, over_hole[4][2] = {{-2, -2}, {2, -2}, {2, 2}, {-2, 2}};
    static const double bridge[4][2] = {{-1, 1}, {1, 1}, {1, 2}, {-1, 2}}, fits[4][2] = {{-2, -2}, {2, -2}, {2, -1}, {-2, -1}};
    const struct {
        const double (*wall)[2];
        unsigned corners, hole;
        const double (*on)[2];
        int reverse;
        double z;
        size_t expected;
    } cases[] = {
        {notched, 8, 0, fits, 0, 0, 1},    {notched, 8, 0, fits, 1, 0, 0},   /* turned away */
        {notched, 8, 0, fits, 0, 1e-3, 0},                                   /* before the plane */
        {notched, 8, 0, across, 0, 0, 0},  {notched, 8, 0, bridge, 0, 0, 0}, /* over the notch, from border to border */
        {framed, 4, 4, fits, 0, 0, 1},     {framed, 4, 4, over_hole, 0, 0, 0},
        {over_hole, 4, 0, over_hole, 0, 0, 0},                               /* the same twice */
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        bench b;
        size_t count;
        set_up(&b, 0);
        outline(&b, cases[i].wall, cases[i].corners, cases[i].hole, 0, 0);
        outline(&b, cases[i].on, 4, 0, cases[i].reverse, cases[i].z);
        count = found(&b, 1);
        if (count != cases[i].expected)
            print_message("case %zu\n", i);
        assert_int_equal(count, cases[i].expected);
        tear_down(&b);
    }
}

/* Random rectangles of all sizes in a few planes, on quarters of a unit so that many share borders: as many have a larger one around
 * them as are found. */
static void test_found_as_by_all_pairs(void **state)
{
    enum { COUNT = 300 };
    static double r[COUNT][5];
    uint32_t seed = 7;
    (void)state;
    for (int round = 0; round < 3; round++) {
        bench b;
        size_t expected = 0;
        set_up(&b, 0);
        for (int i = 0; i < COUNT; i++) {
            double size = i % 10 ? 4 : 30;
            for (int k = 0; k < 5; k++) {
                seed = seed * 1664525u + 1013904223u;
                r[i][k] = floor((double)(seed >> 8) / 16777216.0 * (k == 4 ? 3 : k & 1 ? 4 * size : 160)) / 4;
            }
            r[i][1] += r[i][0] + 0.25;
            r[i][3] += r[i][2] + 0.25;
            rectangle(&b, r[i][0], r[i][1], r[i][2], r[i][3], floor(4 * r[i][4]), 0, 0, 0);
        }
        for (int i = 0; i < COUNT; i++) {
            int held = 0;
            for (int j = 0; j < COUNT; j++)
                held |= r[i][4] == r[j][4] && r[j][0] <= r[i][0] && r[j][1] >= r[i][1] && r[j][2] <= r[i][2] && r[j][3] >= r[i][3] &&
                        (r[j][1] - r[j][0]) * (r[j][3] - r[j][2]) > (r[i][1] - r[i][0]) * (r[i][3] - r[i][2]);
            expected += (size_t)held;
        }
        assert_true(expected > COUNT / 5 && expected < COUNT);
        assert_int_equal(found(&b, 1), expected);
        tear_down(&b);
    }
}

/* A box with windows on its walls is as closed as without them: the same shadow, and nobody sees into it. */
static void test_details_leave_a_body_closed(void **state)
{
    static float bare[SIDE * SIDE * 3];
    gno_light lamp = gno_light_default();
    bench b;
    (void)state;
    for (int windows = 0; windows < 2; windows++) {
        static const double p[24] = {-2, -2, 1, 2, -2, 1, 2, 2, 1, -2, 2, 1, -2, -2, 3, 2, -2, 3, 2, 2, 3, -2, 2, 3};
        static const int corners[24] = {3, 2, 1, 0, 4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
        static const unsigned rings[7] = {0, 4, 8, 12, 16, 20, 24};
        gno_mesh_def mesh = gno_mesh_def_default();
        set_up(&b, 0);
        lamp.position[0] = 1;
        lamp.position[2] = 8;
        assert_int_equal(gno_scene_add_light(b.scene, NULL, &lamp, NULL), GNO_OK);
        mesh.vertex_count = 8;
        mesh.positions = p;
        mesh.polygon_count = mesh.ring_count = 6;
        mesh.ring_start = rings;
        mesh.corner_count = 24;
        mesh.corner_vertex = corners;
        assert_int_equal(gno_scene_add_mesh(b.scene, &mesh, NULL), GNO_OK);
        rectangle(&b, -9, 9, -9, 9, 0, 0, 0, 0);
        if (windows) { /* share corners with the lid, and look like it */
            rectangle(&b, -2, 2, -2, 0, 3, 0, 0, 0);
            rectangle(&b, -1, 1, -2, -1, 3, 0, 0, 0);
        }
        assert_int_equal(found(&b, 1), windows ? 2 : 0);
        draw(&b);
        if (windows)
            assert_memory_equal(b.rgb, bare, sizeof bare);
        memcpy(bare, b.rgb, sizeof bare);
        tear_down(&b);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_in_front_and_nested),
        cmocka_unit_test(test_given_with_the_mesh),
        cmocka_unit_test(test_wrong_marks),
        cmocka_unit_test(test_shadows),
        cmocka_unit_test(test_found_and_nested),
        cmocka_unit_test(test_not_found),
        cmocka_unit_test(test_found_as_by_all_pairs),
        cmocka_unit_test(test_details_leave_a_body_closed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
