/* test_prepare.c -- preparing a scene: planes, skipped and split polygons, threads, failing memory. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#include "prepare_test.h"

/* ---- planes ------------------------------------------------------------------------------------------------------ */

static void test_concave_plane(void **state)
{
    /* An arrow whose first corner is the reflex one: a cross product there points down. */
    static const double arrow[12] = {1, 0, 5, 0, 2, 5, 0, -2, 5, 4, 0, 5};
    static const unsigned sizes[2] = {4, 0};
    double back[12];
    const gnoi_prepared *p;
    int i;
    for (i = 0; i < 4; i++) {
        memcpy(back + 3 * i, arrow + 3 * (3 - i), 3 * sizeof *back);
    }
    add_polygon(*state, arrow, sizes, 0);
    add_polygon(*state, back, sizes, 0);
    p = prepare(*state, 0, 0);
    check_invariants(((bed *)*state)->scene);
    assert_true(p->polys[0].n[2] == 1 && p->polys[0].d == -5);
    assert_true(p->polys[1].n[2] == -1 && p->polys[1].d == 5);
    assert_null(p->corner_normal);
    assert_null(p->normals);
    assert_int_equal(p->triangle_count, 0);
    assert_true(p->upper[0] == 4 && p->lower[2] == 5 && p->scale == 5);
}

static void test_far_from_origin(void **state)
{
    static const double far_square[12] = {1e9, 1e9, 1e9, 1e9 + 1, 1e9, 1e9, 1e9 + 1, 1e9 + 1, 1e9, 1e9, 1e9 + 1, 1e9};
    static const unsigned sizes[2] = {4, 0};
    const gnoi_prepared *p;
    add_polygon(*state, far_square, sizes, 0);
    p = prepare(*state, 0, 0);
    assert_true(p->polys[0].n[0] == 0 && p->polys[0].n[1] == 0 && p->polys[0].n[2] == 1 && p->polys[0].d == -1e9);
}

static void test_attributes(void **state)
{
    static const double triangle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const unsigned sizes[2] = {3, 0};
    bed *b = *state;
    gno_material m = gno_material_default();
    const gnoi_prepared *p;
    m.transmission[1] = 0.5;
    m.two_sided = 0;
    m.shading = GNO_SHADING_CONSTANT;
    assert_int_equal(gno_scene_add_material(b->scene, &m, NULL), GNO_OK);
    add_polygon(b, triangle, sizes, -1);
    add_polygon(b, triangle, sizes, GNO_SHADING_PHONG);
    b->scene->polygon_material[1] = 1;
    b->scene->objects[1].priority = -7;
    p = prepare(b, 0, 0);
    assert_int_equal(p->polys[0].opaque, 1);
    assert_int_equal(p->polys[0].two_sided, 1);
    assert_int_equal(p->polys[0].shading, GNO_SHADING_FLAT);
    assert_int_equal(p->polys[1].opaque, 0);
    assert_int_equal(p->polys[1].two_sided, 0);
    assert_int_equal(p->polys[1].material, 1);
    assert_int_equal(p->polys[1].shading, GNO_SHADING_PHONG);
    assert_int_equal(p->polys[1].priority, -7);
    check_invariants(b->scene);
}

/* ---- polygons that are skipped or split --------------------------------------------------------------------------- */

static void test_degenerate(void **state)
{
    static const double line[9] = {0, 0, 0, 1, 1, 1, 2, 2, 2};
    static const double point[12] = {3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3};
    static const double bow_tie[12] = {0, 0, 0, 1, 1, 0, 1, 0, 0, 0, 1, 0};
    static const double good[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const unsigned two[2] = {2, 0}, three[2] = {3, 0}, four[2] = {4, 0};
    bed *b = *state;
    const gnoi_prepared *p;
    add_polygon(b, line, three, 0);
    add_polygon(b, good, three, 0);
    add_polygon(b, good, two, 0);
    add_polygon(b, point, four, GNO_SHADING_PHONG); /* smooth, but not there: no normals are made */
    add_polygon(b, bow_tie, four, 0);
    add_polygon(b, good, three, 0);
    p = prepare(b, 4, 0);
    check_invariants(b->scene);
    assert_int_equal(p->poly_count, 2);
    assert_int_equal(p->polys[0].source, 1);
    assert_int_equal(p->polys[1].source, 5);
    assert_int_equal(p->corner_count, 6);
    assert_null(p->corner_normal);
    assert_true(p->upper[0] == 1 && p->upper[2] == 0); /* bounds are those of what is left */
    assert_int_equal(b->warnings, 1);
    assert_string_equal(b->warning, "4 of 6 polygons have no area and are skipped");
    prepare(b, 4, 0);
    assert_int_equal(b->warnings, 1); /* prepared already */
}

static void test_short_rings(void **state)
{
    /* A square; a hole of two corners, dropped; a hole of four, one of them repeated, kept. */
    static const double rings[30] = {0, 0, 0, 4, 0, 0, 4, 4, 0, 0, 4, 0, 1, 1, 0, 2, 1, 0,
                                     2, 2, 0, 2, 2, 0, 3, 2, 0, 3, 3, 0};
    static const unsigned sizes[4] = {4, 2, 4, 0};
    const gnoi_prepared *p;
    bed *b = *state;
    add_polygon(b, rings, sizes, GNO_SHADING_GOURAUD);
    p = prepare(b, 0, 0);
    check_invariants(b->scene);
    assert_int_equal(p->polys[0].ring_count, 2);
    assert_int_equal(p->polys[0].corner_count, 8);
    assert_memory_equal(p->positions[p->corner_vertex[4]], rings + 18, 3 * sizeof *rings);
    assert_int_equal(p->triangle_count, 8);
    assert_int_equal(b->warnings, 0);
}

static void test_non_planar(void **state)
{
    static const double saddle[12] = {0, 0, 0, 1, 0, 0.5, 1, 1, 0, 0, 1, 0.5};
    static const double flat[12] = {0, 0, 0, 1, 0, 1e-9, 1, 1, 0, 0, 1, 0};
    static const double lid[24] = {0, 0, 0, 4, 0, 0.3, 4, 4, 0, 0, 4, 0, 1, 1, 0, 1, 2, 0, 2, 2, 0, 2, 1, 0};
    static const unsigned four[2] = {4, 0}, holed[3] = {4, 4, 0};
    bed *b = *state;
    const gnoi_prepared *p;
    size_t i;
    add_polygon(b, saddle, four, GNO_SHADING_PHONG);
    add_polygon(b, flat, four, 0);
    add_polygon(b, lid, holed, 0);
    p = prepare(b, 0, 2);
    check_invariants(b->scene);
    assert_int_equal(p->poly_count, 2 + 1 + 8);
    for (i = 0; i < p->poly_count; i++) {
        assert_int_equal(p->polys[i].source, i < 2 ? 0 : i == 2 ? 1 : 2);
        assert_int_equal(p->polys[i].corner_count, i == 2 ? 4 : 3);
        assert_true(p->polys[i].n[2] > 0); /* triangles follow the outer ring */
    }
    assert_int_equal(b->warnings, 1);
    assert_string_equal(b->warning, "2 of 3 polygons are not planar and are split into triangles");
}

/* Small polygons that are bent by their own measure but not by the scene's. */
static void test_planar_by_scale(void **state)
{
    static const double bent[12] = {0, 0, 0, 1, 0, 0.01, 1, 1, 0, 0, 1, 0.01};
    static const double large[9] = {0, 0, 0, 1e6, 0, 0, 0, 1e6, 0};
    static const unsigned three[2] = {3, 0}, four[2] = {4, 0};
    bed *b = *state;
    add_polygon(b, bent, four, 0);
    prepare(b, 0, 1);
    add_polygon(b, large, three, 0); /* a change: all is prepared anew */
    assert_int_equal(b->scene->prepared.valid, 0);
    prepare(b, 0, 0);
}

/* ---- threads and memory ------------------------------------------------------------------------------------------ */

/* Flat, smooth, bent, empty and holed polygons together. */
static gno_status fill(gno_scene *scene)
{
    static const double saddle[12] = {0, 0, 0, 1, 0, 0.5, 1, 1, 0, 0, 1, 0.5};
    static const int saddle_corners[4] = {0, 1, 2, 3};
    static const unsigned saddle_rings[2] = {0, 4};
    gno_mesh_def mesh = cube(40, GNO_WEIGHTING_ANGLE);
    gno_status status = gno_scene_add_mesh(scene, &mesh, NULL);
    if (status == GNO_OK) {
        mesh = sphere_mesh(8, 40); /* of 40 corners around, so that fans at the poles need memory */
        status = gno_scene_add_mesh(scene, &mesh, NULL);
    }
    if (status == GNO_OK) {
        mesh = gno_mesh_def_default();
        mesh.vertex_count = mesh.corner_count = 4;
        mesh.positions = saddle;
        mesh.polygon_count = mesh.ring_count = 1;
        mesh.ring_start = saddle_rings;
        mesh.corner_vertex = saddle_corners;
        status = gno_scene_add_mesh(scene, &mesh, NULL);
    }
    return status;
}

static gno_status add_large_star(gno_scene *scene, int bent)
{
    static double positions[3 * 100];
    static int corners[100];
    static const unsigned rings[2] = {0, 100};
    gno_mesh_def mesh = gno_mesh_def_default();
    uint64_t seed = 7;
    int i;
    star(positions, 100, 0, 0, 1, 2, 1, &seed);
    for (i = 0; i < 100; i++) {
        corners[i] = i;
        positions[3 * i + 2] = bent ? random_unit(&seed) : 0;
    }
    mesh.vertex_count = mesh.corner_count = 100;
    mesh.positions = positions;
    mesh.polygon_count = mesh.ring_count = 1;
    mesh.ring_start = rings;
    mesh.corner_vertex = corners;
    mesh.shading = GNO_SHADING_PHONG;
    return gno_scene_add_mesh(scene, &mesh, NULL);
}

static gno_status build(fail_alloc *alloc)
{
    gno_context_def def = fail_alloc_def(alloc);
    gno_context *context;
    gno_scene *scene = NULL;
    gno_status status = gno_context_create(&def, &context);
    if (status != GNO_OK) {
        return status;
    }
    status = gno_scene_create(context, &scene);
    if (status == GNO_OK) {
        status = fill(scene);
    }
    if (status == GNO_OK) {
        status = add_large_star(scene, 0);
    }
    if (status == GNO_OK) {
        status = add_large_star(scene, 1);
    }
    if (status == GNO_OK) {
        status = gno_scene_prepare(scene, 1, NULL);
        assert_int_equal(scene->prepared.valid, status == GNO_OK);
        assert_true(status == GNO_OK || strstr(gno_context_message(context), "out of memory"));
    }
    if (status == GNO_OK) {
        check_invariants(scene);
    }
    assert_int_equal(gno_context_memory(context, NULL), alloc->held);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
    return status;
}

/* A failure to shrink at the end is none: the last fail_at may succeed early, so the loop runs to the true end. */
static void test_every_allocation_fails(void **state)
{
    size_t fail_at = 0;
    fail_alloc whole = {0, 0, 0, 0};
    (void)state;
    assert_int_equal(build(&whole), GNO_OK);
    while (fail_at < whole.calls) {
        fail_alloc alloc = {0, 0, ++fail_at, 0};
        gno_status status = build(&alloc);
        assert_true(status == GNO_ERROR_MEMORY || (status == GNO_OK && fail_at == whole.calls));
        assert_int_equal(alloc.held, 0);
        assert_int_equal(alloc.wrong_size, 0);
    }
    assert_true(whole.calls > 60);
}

static void test_threads_agree(void **state)
{
    bed *b = *state;
    gno_scene *other;
    const gnoi_prepared *p = &b->scene->prepared, *q;
    size_t k;
    int i;
    assert_int_equal(gno_scene_create(b->context, &other), GNO_OK);
    q = &other->prepared;
    for (i = 0; i < 12; i++) { /* more than one piece of work */
        assert_int_equal(fill(b->scene), GNO_OK);
        assert_int_equal(fill(other), GNO_OK);
        assert_int_equal(add_large_star(b->scene, i % 2), GNO_OK);
        assert_int_equal(add_large_star(other, i % 2), GNO_OK);
    }
    assert_int_equal(gno_scene_prepare(b->scene, 1, NULL), GNO_OK);
    assert_int_equal(gno_scene_prepare(other, 5, NULL), GNO_OK);
    check_invariants(b->scene);
    assert_int_equal(p->poly_count, q->poly_count);
    assert_int_equal(p->normal_count, q->normal_count);
    assert_int_equal(p->triangle_count, q->triangle_count);
    for (k = 0; k < p->poly_count; k++) {
        assert_memory_equal(p->polys[k].n, q->polys[k].n, 4 * sizeof(double)); /* d follows n */
        assert_int_equal(p->polys[k].corner, q->polys[k].corner);
        assert_int_equal(p->polys[k].triangle, q->polys[k].triangle);
        assert_int_equal(p->polys[k].source, q->polys[k].source);
    }
    assert_memory_equal(p->normals, q->normals, p->normal_count * sizeof *p->normals);
    assert_memory_equal(p->triangles, q->triangles, p->triangle_count * sizeof *p->triangles);
    assert_memory_equal(p->corner_normal, q->corner_normal, p->corner_count * sizeof *p->corner_normal);
    gno_scene_destroy(other);
}

static void test_arguments(void **state)
{
    bed *b = *state;
    assert_int_equal(gno_scene_prepare(NULL, 1, NULL), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_scene_prepare(b->scene, -1, NULL), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_scene_prepare(b->scene, GNO_MAX_THREADS + 1, NULL), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_scene_prepare(b->scene, 0, NULL), GNO_OK);
    assert_true(b->scene->prepared.scale == 1 && b->scene->prepared.poly_count == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_concave_plane, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_far_from_origin, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_attributes, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_degenerate, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_short_rings, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_non_planar, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_planar_by_scale, set_up, tear_down),
        cmocka_unit_test(test_every_allocation_fails),
        cmocka_unit_test_setup_teardown(test_threads_agree, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_arguments, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
