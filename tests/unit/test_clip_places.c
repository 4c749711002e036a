/* test_clip_places.c -- where the clipper puts vertices and finds edges: no vertex but corners and crossings, edges at the borders of its
 * lattices, holes over edges that are not kept.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>
#include <clip/clipper.h>
#include <math.h>
#include <stdlib.h>
#include <support/shapes.h>
#include <support/slabs.h>

typedef struct fixture {
    gno_context *context;
    gno_clipper *clipper;
    shape_buffer a, b;
} fixture;

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    *state = f;
    return !f || gno_context_create(NULL, &f->context) != GNO_OK || gno_clipper_create(f->context, &f->clipper) != GNO_OK;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    gno_clipper_destroy(f->clipper);
    gno_context_destroy(f->context);
    shape_free(&f->a);
    shape_free(&f->b);
    free(f);
    return 0;
}

static void add_ring(shape_buffer *to, const double *points, size_t count)
{
    shape_begin_ring(to);
    for (size_t i = 0; i < count; i++)
        shape_point(to, points[2 * i], points[2 * i + 1]);
}

static void add_box(shape_buffer *to, double x0, double y0, double x1, double y1)
{
    const double points[8] = {x0, y0, x1, y0, x1, y1, x0, y1};
    shape_begin_polygon(to);
    add_ring(to, points, 4);
}

/* Two triangles apart, whose boxes overlap: an edge of one, drawn out, would cross an edge of the other in a place that is on no grid. */
static void test_edges_end(void **state)
{
    static const double first[6] = {0, 0, 10, 3, 0, 3}, second[6] = {9, 0, 14, 0, 13, 10};
    fixture *f = *state;
    for (int turn = 0; turn < 16; turn++) {
        const double c = cos(turn * 0.39), s = sin(turn * 0.39);
        double p[6], q[6];
        gno_shape a, b, result;
        for (int i = 0; i < 3; i++) {
            p[2 * i] = c * first[2 * i] - s * first[2 * i + 1];
            p[2 * i + 1] = s * first[2 * i] + c * first[2 * i + 1];
            q[2 * i] = c * second[2 * i] - s * second[2 * i + 1];
            q[2 * i + 1] = s * second[2 * i] + c * second[2 * i + 1];
        }
        shape_clear(&f->a);
        shape_clear(&f->b);
        shape_begin_polygon(&f->a);
        add_ring(&f->a, p, 3);
        shape_begin_polygon(&f->b);
        add_ring(&f->b, q, 3);
        for (int swap = 0; swap < 2; swap++) {
            a = shape_view(swap ? &f->b : &f->a);
            b = shape_view(swap ? &f->a : &f->b);
            assert_int_equal(gno_clip(f->clipper, GNO_CLIP_UNION, &a, &b, &result), GNO_OK);
            assert_int_equal(result.polygon_count, 2);
            assert_int_equal(result.ring_start[2], 6);
        }
    }
}

/* Boxes with one left side, in the last column of pixels before a border of the lattice, and others elsewhere. */
static void test_last_column(void **state)
{
    fixture *f = *state;
    for (int power = 1; power < GNOI_CLIP_BITS; power++) {
        const double side = ldexp(1, GNOI_CLIP_BITS) - 1, x = ldexp(1, power) - 1;
        gno_shape a, result;
        shape_clear(&f->a);
        for (int i = 0; i < 60; i++)
            add_box(&f->a, x, i, fmin(x + 1 + i, side), 2 * i + 7);
        for (int i = 0; i < 4; i++)
            add_box(&f->a, 0, side - i - 1, side, side - i);
        a = shape_view(&f->a);
        assert_int_equal(gno_clip(f->clipper, GNO_CLIP_UNION, &a, NULL, &result), GNO_OK);
        assert_true(fabs(gno_shape_area(&result) - slab_area(GNO_CLIP_UNION, &a, NULL)) <= 1e-9 * gno_shape_area(&result));
    }
}

/* A hole belongs to the face around it, though an edge between polygons that both are inside lies next under it. */
static void test_hole_over_lost_edges(void **state)
{
    static const double hole[8] = {3, 4, 3, 6, 6, 6, 6, 4};
    fixture *f = *state;
    gno_shape a, result;
    shape_clear(&f->a);
    add_box(&f->a, -30, -9, -20, 9); /* another one comes first */
    add_box(&f->a, 0, 0, 9, 9);
    add_ring(&f->a, hole, 4);
    add_box(&f->a, 1, 1, 8, 2); /* within the one before, its edges count for nothing */
    add_box(&f->a, 2, 2.5, 7, 3);
    a = shape_view(&f->a);
    assert_int_equal(gno_clip(f->clipper, GNO_CLIP_UNION, &a, NULL, &result), GNO_OK);
    assert_int_equal(result.polygon_count, 2);
    assert_int_equal(result.ring_count, 3);
    assert_int_equal(result.polygon_start[1], 1);
    assert_true(gno_shape_area(&result) == 81 - 6 + 180);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_edges_end),
        cmocka_unit_test(test_last_column),
        cmocka_unit_test(test_hole_over_lost_edges),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down) != 0;
}
