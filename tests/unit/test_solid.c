/* test_solid.c -- connected parts, which of them are closed, and whether points are outside; and that leaving away half the
 * casters of closed parts changes no picture. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "scene/scene.h"
#include <string.h>

static const double corners[24] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1};
static const int outwards[24] = {0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
static const unsigned rings[7] = {0, 4, 8, 12, 16, 20, 24};

/* A box with its own vertices for every face, so that only their places join them. */
static void add_box(gno_scene *scene, const double lower[3], const double upper[3], int faces, int inwards)
{
    double positions[24][3];
    int index[24];
    gno_mesh_def mesh = gno_mesh_def_default();
    for (int i = 0; i < 24; i++) {
        index[i] = inwards ? i / 4 * 4 + 3 - i % 4 : i;
        for (int k = 0; k < 3; k++)
            positions[i][k] = corners[3 * outwards[i] + k] != 0 ? upper[k] : lower[k];
    }
    mesh.vertex_count = 24;
    mesh.positions = &positions[0][0];
    mesh.polygon_count = mesh.ring_count = (size_t)faces;
    mesh.ring_start = rings;
    mesh.corner_count = 4 * (size_t)faces;
    mesh.corner_vertex = index;
    assert_int_equal(gno_scene_add_mesh(scene, &mesh, NULL), GNO_OK);
}

static gno_scene *empty_scene(void)
{
    gno_context *context;
    gno_scene *scene;
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    assert_int_equal(gno_scene_create(context, &scene), GNO_OK);
    return scene;
}

static void drop(gno_scene *scene)
{
    gno_context *context = gno_scene_context(scene);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

static size_t count_closed(gno_scene *scene)
{
    size_t closed = 0;
    assert_int_equal(gno_scene_prepare(scene, 1, NULL), GNO_OK);
    for (size_t i = 0; i < scene->prepared.solid_count; i++)
        closed += scene->prepared.solids[i].closed != 0;
    return closed;
}

static void test_parts(void **state)
{
    const double a0[3] = {0, 0, 0}, a1[3] = {1, 1, 1}, b0[3] = {3, 0, 0}, b1[3] = {4, 2, 5}, c0[3] = {7, 0, 0}, c1[3] = {8, 1, 1};
    gno_scene *scene = empty_scene();
    (void)state;
    add_box(scene, a0, a1, 6, 0);
    add_box(scene, b0, b1, 5, 0); /* one face is missing */
    add_box(scene, c0, c1, 6, 1);
    assert_int_equal(count_closed(scene), 3); /* by a cap in its place */
    assert_int_equal(scene->prepared.solid_count, 3);
    assert_int_equal(scene->prepared.cap_count, 1);
    for (size_t i = 0; i < 3; i++) {
        const gnoi_solid *s = &scene->prepared.solids[i];
        assert_int_equal(s->cap != GNOI_NONE, s->lower[0] == 3);
        assert_int_equal(s->outwards, s->lower[0] != 7);
    }
    drop(scene);
}

/* One face turned round: edges no longer cancel. */
static void test_turned_face(void **state)
{
    gno_scene *scene = empty_scene();
    int index[24];
    gno_mesh_def mesh = gno_mesh_def_default();
    (void)state;
    memcpy(index, outwards, sizeof index);
    index[0] = outwards[3];
    index[1] = outwards[2];
    index[2] = outwards[1];
    index[3] = outwards[0];
    mesh.vertex_count = 8;
    mesh.positions = corners;
    mesh.polygon_count = mesh.ring_count = 6;
    mesh.ring_start = rings;
    mesh.corner_count = 24;
    mesh.corner_vertex = index;
    assert_int_equal(gno_scene_add_mesh(scene, &mesh, NULL), GNO_OK);
    assert_int_equal(count_closed(scene), 0);
    drop(scene);
}

static void test_outside(void **state)
{
    const double lower[3] = {-1, -2, -3}, upper[3] = {1, 2, 3};
    (void)state;
    for (int inwards = 0; inwards < 2; inwards++) {
        gno_scene *scene = empty_scene();
        add_box(scene, lower, upper, 6, inwards);
        assert_int_equal(count_closed(scene), 1);
        assert_int_equal(gnoi_solid_outside(scene, 0, v3(0.1, 0.2, 0.3)), 0);
        assert_int_equal(gnoi_solid_outside(scene, 0, v3(0.99, -1.99, 2.99)), 0);
        assert_int_equal(gnoi_solid_outside(scene, 0, v3(1.01, 0, 0)), 1);
        drop(scene);
    }
}

/* A point in the cavity between two boxes, one inside the other and turned inwards, is outside of neither alone; in the box
 * of a U, inside the bounds, it is outside. */
static void test_bounds_are_not_all(void **state)
{
    static const double u[48] = {0, 0, 0, 3, 0, 0, 3, 3, 0, 2, 3, 0, 2, 1, 0, 1, 1, 0, 1, 3, 0, 0, 3, 0,
                                 0, 0, 1, 3, 0, 1, 3, 3, 1, 2, 3, 1, 2, 1, 1, 1, 1, 1, 1, 3, 1, 0, 3, 1};
    int index[48];
    unsigned starts[11];
    gno_mesh_def mesh = gno_mesh_def_default();
    gno_scene *scene = empty_scene();
    (void)state;
    for (int i = 0; i < 8; i++) {
        int j = (i + 1) % 8;
        index[i] = 7 - i;
        index[8 + i] = 8 + i;
        index[16 + 4 * i] = i;
        index[17 + 4 * i] = j;
        index[18 + 4 * i] = 8 + j;
        index[19 + 4 * i] = 8 + i;
    }
    for (unsigned r = 0; r <= 10; r++)
        starts[r] = r < 2 ? 8 * r : 16 + 4 * (r - 2);
    mesh.vertex_count = 16;
    mesh.positions = u;
    mesh.polygon_count = mesh.ring_count = 10;
    mesh.ring_start = starts;
    mesh.corner_count = 48;
    mesh.corner_vertex = index;
    assert_int_equal(gno_scene_add_mesh(scene, &mesh, NULL), GNO_OK);
    assert_int_equal(count_closed(scene), 1);
    assert_int_equal(gnoi_solid_outside(scene, 0, v3(1.5, 2, 0.5)), 1);
    assert_int_equal(gnoi_solid_outside(scene, 0, v3(1.5, 0.5, 0.5)), 0);
    drop(scene);
}

/* The same boxes on a ground, closed or with each one's hidden bottom face missing: the pictures agree. With the lamp or the eye
 * inside a box the near sides must stay. */
static void test_same_picture(void **state)
{
    static const double eyes[2][3] = {{6, -9, 5}, {0.5, 0.4, 0.45}}, lamps[2][3] = {{-3, -2, 7}, {2.6, 0.5, 0.5}};
    static float rgb[2][80 * 60 * 3];
    (void)state;
    for (int which = 0; which < 4; which++) {
        for (int open = 0; open < 2; open++) {
            const double ground0[3] = {-9, -9, -1}, ground1[3] = {9, 9, 0}, boxes[3][6] = {{0, 0, 0, 1, 1, 1}, {2, 0, 0, 3, 2, 2}, {-2, 1, 0, -1, 2, 3}};
            gno_scene *scene = empty_scene();
            gno_camera camera = gno_camera_default();
            gno_light light = gno_light_default();
            gno_image_def image = gno_image_def_default();
            image.width = 80;
            image.height = 60;
            memcpy(camera.eye, eyes[which & 1], sizeof camera.eye);
            memcpy(light.position, lamps[which >> 1], sizeof light.position);
            camera.target[0] = 1;
            camera.target[2] = 0.2;
            add_box(scene, ground0, ground1, 2, 0);
            for (int i = 0; i < 3; i++) {
                double lower[3] = {boxes[i][0], boxes[i][1], boxes[i][2] + 0.01}, upper[3] = {boxes[i][3], boxes[i][4], boxes[i][5]};
                add_box(scene, lower, upper, 6, i == 1);
                if (open) { /* a face of no consequence hangs on a corner and spoils the balance */
                    double tip[3] = {lower[0], lower[1], lower[2]}, near_tip[3] = {lower[0] + 1e-4, lower[1] + 1e-4, lower[2] + 1e-4};
                    add_box(scene, tip, near_tip, 1, 0);
                }
            }
            assert_int_equal(gno_scene_set_camera(scene, &camera), GNO_OK);
            assert_int_equal(gno_scene_set_image(scene, &image), GNO_OK);
            assert_int_equal(gno_scene_add_light(scene, NULL, &light, NULL), GNO_OK);
            assert_int_equal(count_closed(scene), open ? 0 : 3);
            assert_int_equal(gno_render(scene, NULL, rgb[open], NULL), GNO_OK);
            drop(scene);
        }
        for (size_t i = 0; i < sizeof rgb[0] / sizeof rgb[0][0]; i++)
            assert_true(rgb[0][i] - rgb[1][i] < 1e-3f && rgb[1][i] - rgb[0][i] < 1e-3f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_parts),     cmocka_unit_test(test_turned_face),        cmocka_unit_test(test_outside),
        cmocka_unit_test(test_bounds_are_not_all), cmocka_unit_test(test_same_picture),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
