/* test_prepare_normals.c -- vertex normals of prepared polygons: creases, weights, seams, crowded points, normals from files. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#include "prepare_test.h"

static vec3 normal_at(const gnoi_prepared *p, size_t corner)
{
    const float *n = p->normals[p->corner_normal[corner]];
    return v3((double)n[0], (double)n[1], (double)n[2]);
}

static void test_cube_creases(void **state)
{
    static const double creases[4] = {40, 89.9, 90, 180};
    bed *b = *state;
    int k, weighting;
    size_t i, c;
    for (weighting = 0; weighting < 3; weighting++) {
        for (k = 0; k < 4; k++) {
            gno_mesh_def mesh = cube(creases[k], (gno_weighting)weighting);
            const gnoi_prepared *p;
            gno_scene_destroy(b->scene);
            assert_int_equal(gno_scene_create(b->context, &b->scene), GNO_OK);
            assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, NULL), GNO_OK);
            p = prepare(b, 0, 0);
            check_invariants(b->scene);
            assert_int_equal(p->normal_count, k < 2 ? 24 : 8);
            assert_int_equal(p->triangle_count, 12);
            for (i = 0; i < 6; i++) {
                for (c = 4 * i; c < 4 * i + 4; c++) {
                    const double *x = p->positions[p->corner_vertex[c]];
                    vec3 diagonal = v3_unit(v3(x[0] - 0.5, x[1] - 0.5, x[2] - 0.5));
                    vec3 expected = k < 2 ? v3_from(p->polys[i].n) : diagonal;
                    assert_near(v3_length(v3_sub(normal_at(p, c), expected)), 0, 1e-6);
                }
            }
        }
    }
}

static void test_sphere(void **state)
{
    bed *b = *state;
    int k;
    for (k = 0; k < 6; k++) {
        gno_mesh_def mesh = sphere_mesh(24, 48);
        const gnoi_prepared *p;
        size_t c;
        mesh.weighting = (gno_weighting)(k % 3);
        mesh.crease = k < 3 ? 180 : 40;
        gno_scene_destroy(b->scene);
        assert_int_equal(gno_scene_create(b->context, &b->scene), GNO_OK);
        assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, NULL), GNO_OK);
        p = prepare(b, 2 * 48, 0); /* one triangle of each quad at the poles has no area */
        check_invariants(b->scene);
        assert_int_equal(p->normal_count, 23 * 48 + 2);
        for (c = 0; c < p->corner_count; c++) {
            vec3 x = v3_from(p->positions[p->corner_vertex[c]]);
            assert_true(v3_dot(normal_at(p, c), x) > 0.995);
        }
    }
}

/* A roof of two squares at 60 degrees, one three times as long: the ridge leans to the longer by area only. */
static void test_weighting(void **state)
{
    double h = sqrt(0.75);
    double positions[18] = {0, 0, 0, 0, 1, 0, 0.5, 0, 0, 0.5, 1, 0, -1.5, 0, 0, -1.5, 1, 0};
    static const int corners[8] = {0, 2, 3, 1, 0, 1, 5, 4};
    static const unsigned rings[3] = {0, 4, 8};
    gno_mesh_def mesh = gno_mesh_def_default();
    bed *b = *state;
    int k;
    positions[8] = positions[11] = -h;
    positions[14] = positions[17] = -3 * h;
    mesh.vertex_count = 6;
    mesh.positions = positions;
    mesh.polygon_count = mesh.ring_count = 2;
    mesh.ring_start = rings;
    mesh.corner_count = 8;
    mesh.corner_vertex = corners;
    mesh.shading = GNO_SHADING_PHONG;
    for (k = 0; k < 3; k++) {
        const gnoi_prepared *p;
        vec3 n, expected;
        mesh.weighting = (gno_weighting)k;
        assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, NULL), GNO_OK);
        p = prepare(b, 0, 0);
        n = normal_at(p, (size_t)k * 8);
        expected = v3_from(p->polys[2 * k].n);
        expected = v3_unit(v3_mad(expected, v3_from(p->polys[2 * k + 1].n), k == GNO_WEIGHTING_AREA ? 3 : 1));
        assert_near(v3_length(v3_sub(n, expected)), 0, 1e-6);
    }
}

static void test_file_normals(void **state)
{
    static const double normals[12] = {0, 0, 2, 0, 0, 0, 1e-200, 0, 0, 1e200, 1e200, 0};
    static const int corner_normal[24] = {0, 1, 2, 3, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};
    gno_mesh_def mesh = cube(180, GNO_WEIGHTING_AREA);
    bed *b = *state;
    const gnoi_prepared *p;
    double third = 1 / sqrt(3);
    mesh.normal_count = 4;
    mesh.normals = normals;
    mesh.corner_normal = corner_normal;
    assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, NULL), GNO_OK);
    p = prepare(b, 0, 0);
    check_invariants(b->scene);
    assert_near(v3_length(v3_sub(normal_at(p, 0), v3(0, 0, 1))), 0, 1e-6);
    assert_near(v3_length(v3_sub(normal_at(p, 1), v3(0, 0, -1))), 0, 1e-6); /* zero in the file: the plane's own */
    assert_near(v3_length(v3_sub(normal_at(p, 2), v3(1, 0, 0))), 0, 1e-6);
    assert_near(v3_length(v3_sub(normal_at(p, 3), v3(sqrt(0.5), sqrt(0.5), 0))), 0, 1e-6);
    assert_near(v3_length(v3_sub(normal_at(p, 4), v3(-third, -third, third))), 0, 1e-6); /* none in the file: averaged */
    mesh.average_normals = 1;
    assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, NULL), GNO_OK);
    p = prepare(b, 0, 0);
    check_invariants(b->scene);
    assert_near(v3_length(v3_sub(normal_at(p, 0), v3(0, 0, 1))), 0, 1e-6);
    assert_near(v3_length(v3_sub(normal_at(p, 24), v3(-third, -third, -third))), 0, 1e-6);
}

/* A cone of more sides than are averaged one by one: still smooth around its tip, its base still apart, and done in time. */
static void test_crowded_point(void **state)
{
    enum { SIDES = 100000 };
    bed *b = *state;
    double(*positions)[3] = malloc((SIDES + 2) * sizeof *positions);
    int(*corners)[3] = malloc(2 * SIDES * sizeof *corners);
    gno_mesh_def mesh = gno_mesh_def_default();
    const gnoi_prepared *p;
    int i;
    assert_true(positions && corners);
    for (i = 0; i < SIDES; i++) {
        double angle = 2 * PI * i / SIDES;
        positions[i][0] = cos(angle);
        positions[i][1] = sin(angle);
        positions[i][2] = 0;
        corners[i][0] = i;
        corners[i][1] = (i + 1) % SIDES;
        corners[i][2] = SIDES; /* the side: to the tip */
        corners[SIDES + i][0] = (i + 1) % SIDES;
        corners[SIDES + i][1] = i;
        corners[SIDES + i][2] = SIDES + 1; /* the base: to its middle */
    }
    memset(positions[SIDES], 0, 2 * sizeof *positions);
    positions[SIDES][2] = 1;
    mesh.vertex_count = SIDES + 2;
    mesh.positions = (const double *)positions;
    mesh.polygon_count = mesh.ring_count = 2 * SIDES;
    mesh.corner_count = 6 * SIDES;
    mesh.corner_vertex = (const int *)corners;
    mesh.shading = GNO_SHADING_PHONG;
    mesh.crease = 40;
    assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, NULL), GNO_OK);
    p = prepare(b, 0, 0);
    check_invariants(b->scene);
    for (i = 0; i < 2 * SIDES; i++) {
        vec3 own = v3_from(p->polys[i].n);
        size_t corner = p->polys[i].corner;
        if (p->polys[i].source < SIDES) {
            assert_true(v3_dot(normal_at(p, corner), own) > 0.9999);
            assert_true(v3_dot(normal_at(p, corner + 2), own) > 0.97);
        } else {
            assert_true(normal_at(p, corner + 2).z == -1);
        }
    }
    free(positions);
    free(corners);
}

/* The two sides of one square: sums cancel, each side keeps its own normal. */
static void test_cancelled_sums(void **state)
{
    static const double square[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    static const int corners[8] = {0, 1, 2, 3, 3, 2, 1, 0};
    static const unsigned rings[3] = {0, 4, 8};
    gno_mesh_def mesh = gno_mesh_def_default();
    bed *b = *state;
    int k;
    mesh.vertex_count = 4;
    mesh.positions = square;
    mesh.polygon_count = mesh.ring_count = 2;
    mesh.ring_start = rings;
    mesh.corner_count = 8;
    mesh.corner_vertex = corners;
    mesh.shading = GNO_SHADING_PHONG;
    for (k = 0; k < 2; k++) {
        const gnoi_prepared *p;
        mesh.crease = k ? 179.999999999 : 180;
        assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, NULL), GNO_OK);
        p = prepare(b, 0, 0);
        check_invariants(b->scene);
        assert_true(normal_at(p, (size_t)k * 8).z == 1 && normal_at(p, (size_t)k * 8 + 7).z == -1);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_cube_creases, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_sphere, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_weighting, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_file_normals, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_crowded_point, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_cancelled_sums, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
