/* test_vertex_normals.c -- averaged normals against the textbook's formulas: planes' coefficients (8.1.9), cross products of
 * neighbouring edges (8.1.10), by area, angle and equally, and averaged apart beyond the crease. Place: tests of src/scene.
 *
 * The model is a fan of triangles about one point at random heights; sums are made here straight from its corners.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "scene/scene.h"

#include <math.h>
#include <string.h>

enum { MOST = 12 };

typedef struct fan {
    int count;
    double positions[3 * (MOST + 1)]; /* the point, then those around it */
    int corners[3 * MOST];
} fan;

static double next(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) / 16777216.0;
}

static fan random_fan(uint32_t *r, double steep)
{
    fan f;
    f.count = 3 + (int)(next(r) * (MOST - 3));
    for (int k = 0; k < 3; k++)
        f.positions[k] = 10 * next(r);
    for (int i = 0; i < f.count; i++) {
        double turn = 6.283185307179586 * (i + 0.6 * next(r)) / f.count, far = 0.2 + 3 * next(r), *p = f.positions + 3 * (i + 1);
        p[0] = f.positions[0] + far * cos(turn);
        p[1] = f.positions[1] + far * sin(turn);
        p[2] = f.positions[2] + steep * (next(r) - 0.5) * far;
        f.corners[3 * i] = 0;
        f.corners[3 * i + 1] = i + 1;
        f.corners[3 * i + 2] = (i + 1) % f.count + 1;
    }
    return f;
}

static vec3 spoke(const fan *f, int i)
{
    return v3_sub(v3_from(f->positions + 3 * (i % f->count + 1)), v3_from(f->positions));
}

/* The prepared normals at the fan's middle, one for each triangle. */
static void middle_normals(const fan *f, gno_weighting weighting, double crease, vec3 *normals)
{
    gno_context *context;
    gno_scene *scene;
    gno_mesh_def mesh = gno_mesh_def_default();
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    assert_int_equal(gno_scene_create(context, &scene), GNO_OK);
    mesh.vertex_count = (size_t)f->count + 1;
    mesh.positions = f->positions;
    mesh.polygon_count = mesh.ring_count = (size_t)f->count;
    mesh.corner_count = 3 * mesh.polygon_count;
    mesh.corner_vertex = f->corners;
    mesh.shading = GNO_SHADING_PHONG;
    mesh.weighting = weighting;
    mesh.crease = crease;
    assert_int_equal(gno_scene_add_mesh(scene, &mesh, NULL), GNO_OK);
    assert_int_equal(gno_scene_prepare(scene, 1, NULL), GNO_OK);
    assert_int_equal(scene->prepared.poly_count, f->count);
    for (size_t i = 0; i < scene->prepared.poly_count; i++) {
        const gnoi_poly *poly = &scene->prepared.polys[i];
        for (uint32_t c = poly->corner; c < poly->corner + 3; c++) {
            const double *p = scene->prepared.positions[scene->prepared.corner_vertex[c]];
            const float *n = scene->prepared.normals[scene->prepared.corner_normal[c]];
            if (!memcmp(p, f->positions, 3 * sizeof *p))
                normals[poly->source] = v3((double)n[0], (double)n[1], (double)n[2]);
        }
    }
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

static void assert_same(vec3 a, vec3 b)
{
    if (!(v3_length(v3_sub(a, b)) < 1e-6))
        fail_msg("(%g %g %g) is not (%g %g %g)", a.x, a.y, a.z, b.x, b.y, b.z);
}

/* Sum over triangles of their unit normals by weight; those beyond the crease from triangle `own` left out. */
static vec3 expected_normal(const fan *f, gno_weighting weighting, double crease, int own)
{
    vec3 sum = v3(0, 0, 0), mine = v3_unit(v3_cross(spoke(f, own), spoke(f, own + 1)));
    for (int i = 0; i < f->count; i++) {
        vec3 a = spoke(f, i), b = spoke(f, i + 1), cross = v3_cross(a, b), n = v3_unit(cross);
        double weight = weighting == GNO_WEIGHTING_AREA ? 0.5 * v3_length(cross)
                        : weighting == GNO_WEIGHTING_ANGLE ? acos(v3_dot(a, b) / v3_length(a) / v3_length(b)) : 1;
        double angle = acos(fmin(1, v3_dot(mine, n))) / 0.017453292519943295;
        if (crease >= 180 || angle <= crease)
            sum = v3_mad(sum, n, weight);
    }
    return v3_unit(sum);
}

static void test_three_weightings(void **state)
{
    uint32_t r = 1;
    (void)state;
    for (int i = 0; i < 300; i++) {
        fan f = random_fan(&r, 2);
        vec3 normals[MOST];
        for (int w = 0; w < 3; w++) {
            middle_normals(&f, (gno_weighting)w, 180, normals);
            for (int k = 0; k < f.count; k++)
                assert_same(normals[k], expected_normal(&f, (gno_weighting)w, 180, 0));
        }
    }
}

/* (8.1.10): the sum of the cross products of neighbouring edges, as they are, is the average by area of triangles. */
static void test_cross_products(void **state)
{
    uint32_t r = 2;
    (void)state;
    for (int i = 0; i < 300; i++) {
        fan f = random_fan(&r, 2);
        vec3 normals[MOST], sum = v3(0, 0, 0);
        for (int k = 0; k < f.count; k++)
            sum = v3_add(sum, v3_cross(spoke(&f, k), spoke(&f, k + 1)));
        middle_normals(&f, GNO_WEIGHTING_AREA, 180, normals);
        assert_same(normals[0], v3_unit(sum));
    }
}

/* (8.1.9): the sum of the planes' coefficients A, B, C, each plane's made unit, is the equal average. By hand: a corner of a cube. */
static void test_planes(void **state)
{
    fan f = {3, {0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3}, {0, 1, 2, 0, 2, 3, 0, 3, 1}};
    vec3 normals[MOST];
    double third = 0.57735026918962576;
    (void)state;
    middle_normals(&f, GNO_WEIGHTING_EQUAL, 180, normals);
    assert_same(normals[0], v3(third, third, third));
    middle_normals(&f, GNO_WEIGHTING_ANGLE, 180, normals); /* three right angles */
    assert_same(normals[0], v3(third, third, third));
    middle_normals(&f, GNO_WEIGHTING_AREA, 180, normals); /* areas 1, 3, 1.5 along z, x, y */
    assert_same(normals[0], v3_unit(v3(3, 1.5, 1)));
    middle_normals(&f, GNO_WEIGHTING_AREA, 89, normals); /* edges of 90 degrees stay sharp */
    assert_same(normals[0], v3(0, 0, 1));
    assert_same(normals[1], v3(1, 0, 0));
    assert_same(normals[2], v3(0, 1, 0));
    middle_normals(&f, GNO_WEIGHTING_AREA, 90, normals);
    assert_same(normals[1], v3_unit(v3(3, 1.5, 1)));
}

/* A triangle cut in two changes nothing by area or angle, whereas each piece counts as one in the equal average. */
static void test_cut_triangle(void **state)
{
    uint32_t r = 3;
    int moved = 0;
    (void)state;
    for (int i = 0; i < 100; i++) {
        fan f = random_fan(&r, 1.5), cut;
        vec3 before[MOST], after[MOST];
        int n = f.count;
        if (n == MOST)
            continue;
        cut = f;
        cut.count = n + 1;
        for (int k = 0; k < 3; k++) { /* the last triangle's far side, cut at its middle */
            cut.positions[3 * (n + 1) + k] = 0.5 * (f.positions[3 * n + k] + f.positions[3 + k]);
        }
        cut.corners[3 * (n - 1) + 2] = n + 1;
        cut.corners[3 * n] = 0;
        cut.corners[3 * n + 1] = n + 1;
        cut.corners[3 * n + 2] = 1;
        for (int w = 0; w < 3; w++) {
            middle_normals(&f, (gno_weighting)w, 180, before);
            middle_normals(&cut, (gno_weighting)w, 180, after);
            if (w != GNO_WEIGHTING_EQUAL)
                assert_same(before[0], after[0]);
            else
                moved += v3_length(v3_sub(before[0], after[0])) > 1e-3;
        }
    }
    assert_true(moved > 50);
}

/* Selective averaging: each triangle averages those within the crease of itself. */
static void test_crease(void **state)
{
    uint32_t r = 4;
    int apart = 0;
    (void)state;
    for (int i = 0; i < 300; i++) {
        fan f = random_fan(&r, 3);
        vec3 normals[MOST];
        double crease = 10 + 80 * next(&r);
        for (int w = 0; w < 3; w++) {
            middle_normals(&f, (gno_weighting)w, crease, normals);
            for (int k = 0; k < f.count; k++) {
                assert_same(normals[k], expected_normal(&f, (gno_weighting)w, crease, k));
                apart += v3_length(v3_sub(normals[k], normals[0])) > 1e-3;
            }
        }
    }
    assert_true(apart > 1000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_three_weightings),
        cmocka_unit_test(test_cross_products),
        cmocka_unit_test(test_planes),
        cmocka_unit_test(test_cut_triangle),
        cmocka_unit_test(test_crease),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
