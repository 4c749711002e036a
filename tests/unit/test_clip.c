/* test_clip.c -- gno_clip rule by rule: every way two outlines can meet, with numbers worked by hand; bad input; failing memory. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>
#include <float.h>
#include <gnomon/gnomon_clip.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <support/shapes.h>
#include <unit/fail_alloc.h>

typedef struct fixture {
    gno_context *context;
    gno_clipper *clipper;
    shape_buffer a, b;
    gno_shape result;
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

/* Polygons as text: points "x,y" apart by blanks, "|" before a further ring, ";" before a further polygon. */
static void read_shape(shape_buffer *to, const char *text)
{
    shape_clear(to);
    if (!*text)
        return;
    shape_begin_polygon(to);
    shape_begin_ring(to);
    while (*text) {
        char *end;
        double x, y;
        if (*text == ' ' || *text == '|' || *text == ';') {
            if (*text == ';')
                shape_begin_polygon(to);
            if (*text != ' ')
                shape_begin_ring(to);
            text++;
            continue;
        }
        x = strtod(text, &end);
        y = strtod(end + 1, &end);
        text = end;
        shape_point(to, x, y);
    }
}

static int same_ring(const double *p, const double *q, size_t n)
{
    for (size_t shift = 0; shift < n; shift++) {
        size_t i = 0;
        while (i < n && p[2 * i] == q[2 * ((i + shift) % n)] && p[2 * i + 1] == q[2 * ((i + shift) % n) + 1])
            i++;
        if (i == n)
            return 1;
    }
    return 0;
}

/* The result is `want`: polygons and rings in this order, points in this order but from any start. */
static void check_result(const gno_shape *r, const char *want)
{
    shape_buffer w = {0};
    read_shape(&w, want);
    assert_int_equal(r->polygon_count, w.polygons);
    assert_int_equal(r->ring_count, w.rings);
    for (size_t p = 0; p < w.polygons; p++)
        assert_int_equal(r->polygon_start[p + 1], w.polygon_start[p + 1]);
    for (size_t k = 0; k < w.rings; k++) {
        size_t n = w.ring_start[k + 1] - w.ring_start[k];
        assert_int_equal(r->ring_start[k + 1] - r->ring_start[k], n);
        assert_true(same_ring(r->points + 2 * r->ring_start[k], w.points + 2 * w.ring_start[k], n));
    }
    shape_free(&w);
}

static void clip(fixture *f, gno_clip_op op, const char *a, const char *b)
{
    gno_shape subject, other;
    read_shape(&f->a, a);
    read_shape(&f->b, b ? b : "");
    subject = shape_view(&f->a);
    other = shape_view(&f->b);
    assert_int_equal(gno_clip(f->clipper, op, &subject, b ? &other : NULL, &f->result), GNO_OK);
}

static void check(fixture *f, gno_clip_op op, const char *a, const char *b, const char *want)
{
    clip(f, op, a, b);
    check_result(&f->result, want);
}

#define SQUARE "0,0 4,0 4,4 0,4"

static void test_crossing(void **state)
{
    const char *b = "2,2 6,2 6,6 2,6";
    check(*state, GNO_CLIP_INTERSECTION, SQUARE, b, "2,2 4,2 4,4 2,4");
    check(*state, GNO_CLIP_UNION, SQUARE, b, "0,0 4,0 4,2 6,2 6,6 2,6 2,4 0,4");
    check(*state, GNO_CLIP_DIFFERENCE, SQUARE, b, "0,0 4,0 4,2 2,2 2,4 0,4");
    check(*state, GNO_CLIP_XOR, SQUARE, b, "0,0 4,0 4,2 2,2 2,4 0,4;2,4 4,4 4,2 6,2 6,6 2,6");
}

static void test_inside(void **state)
{
    const char *b = "1,1 2,1 2,2 1,2";
    check(*state, GNO_CLIP_INTERSECTION, SQUARE, b, b);
    check(*state, GNO_CLIP_UNION, SQUARE, b, SQUARE);
    check(*state, GNO_CLIP_DIFFERENCE, SQUARE, b, SQUARE "|1,1 1,2 2,2 2,1");
    check(*state, GNO_CLIP_DIFFERENCE, b, SQUARE, "");
}

static void test_apart(void **state)
{
    const char *b = "6,0 7,0 7,1 6,1";
    check(*state, GNO_CLIP_INTERSECTION, SQUARE, b, "");
    check(*state, GNO_CLIP_UNION, SQUARE, b, SQUARE ";6,0 7,0 7,1 6,1");
    check(*state, GNO_CLIP_DIFFERENCE, SQUARE, b, SQUARE);
}

static void test_identical(void **state)
{
    const char *turned = "4,4 4,0 0,0 0,4"; /* the other way round, from another corner */
    check(*state, GNO_CLIP_INTERSECTION, SQUARE, turned, SQUARE);
    check(*state, GNO_CLIP_UNION, SQUARE, turned, SQUARE);
    check(*state, GNO_CLIP_DIFFERENCE, SQUARE, turned, "");
    check(*state, GNO_CLIP_XOR, SQUARE, turned, "");
}

/* Outsides against each other: the shared part of the edges goes, the corners on the line too. */
static void test_shared_edge(void **state)
{
    check(*state, GNO_CLIP_UNION, SQUARE, "4,0 6,0 6,4 4,4", "0,0 6,0 6,4 0,4");
    check(*state, GNO_CLIP_UNION, SQUARE, "4,1 6,1 6,3 4,3", "0,0 4,0 4,1 6,1 6,3 4,3 4,4 0,4");
    check(*state, GNO_CLIP_INTERSECTION, SQUARE, "4,1 6,1 6,3 4,3", "");
    check(*state, GNO_CLIP_DIFFERENCE, SQUARE, "4,1 6,1 6,3 4,3", SQUARE);
    check(*state, GNO_CLIP_UNION, SQUARE, "4,2 6,2 6,6 4,6", "0,0 4,0 4,2 6,2 6,6 4,6 4,4 0,4"); /* overlapping in part */
}

/* Insides on one side of a shared edge. */
static void test_edge_inside(void **state)
{
    check(*state, GNO_CLIP_DIFFERENCE, SQUARE, "0,0 2,0 2,4 0,4", "2,0 4,0 4,4 2,4");
    check(*state, GNO_CLIP_DIFFERENCE, SQUARE, "0,1 2,1 2,3 0,3", "0,0 4,0 4,4 0,4 0,3 2,3 2,1 0,1");
    check(*state, GNO_CLIP_INTERSECTION, SQUARE, "-1,0 2,0 2,9 -1,9", "0,0 2,0 2,4 0,4");
}

static void test_vertex_on_edge(void **state)
{
    const char *touching = "4,2 6,1 6,3", *within = "4,2 1,3 1,1";
    check(*state, GNO_CLIP_UNION, SQUARE, touching, SQUARE ";4,2 6,1 6,3");
    check(*state, GNO_CLIP_INTERSECTION, SQUARE, touching, "");
    check(*state, GNO_CLIP_DIFFERENCE, SQUARE, within, SQUARE "|1,1 1,3 4,2");
    check(*state, GNO_CLIP_UNION, SQUARE, within, SQUARE);
}

static void test_vertex_on_vertex(void **state)
{
    check(*state, GNO_CLIP_UNION, SQUARE, "4,4 6,4 6,6 4,6", SQUARE ";4,4 6,4 6,6 4,6");
    check(*state, GNO_CLIP_INTERSECTION, SQUARE, "4,4 6,4 6,6 4,6", "");
    check(*state, GNO_CLIP_DIFFERENCE, SQUARE, "0,0 3,1 1,3", "0,0 4,0 4,4 0,4|0,0 1,3 3,1");
    check(*state, GNO_CLIP_INTERSECTION, "0,0 2,2 4,0 4,4 0,4", "0,0 4,0 4,4 2,2 0,4", "0,0 2,2 0,4;2,2 4,0 4,4"); /* through a vertex */
}

/* The band between a square and a lozenge that touches its sides: four triangles, not one polygon that hangs together by points. */
static void test_pinched_apart(void **state)
{
    check(*state, GNO_CLIP_DIFFERENCE, SQUARE, "2,0 4,2 2,4 0,2", "0,0 2,0 0,2;0,2 2,4 0,4;2,0 4,0 4,2;2,4 4,2 4,4");
}

/* Holes that touch each other in a chain from side to side cut a polygon in two; a chain that ends does not. */
static void test_touching_holes(void **state)
{
    check(*state, GNO_CLIP_DIFFERENCE, SQUARE, "1,2 2,1 3,2 2,3;3,2 3.5,1 4,2 3.5,3", SQUARE "|1,2 2,3 3,2 2,1|3,2 3.5,3 4,2 3.5,1");
    check(*state, GNO_CLIP_DIFFERENCE, SQUARE, "0,2 1,1 2,2 1,3;2,2 3,1 4,2 3,3", "0,0 4,0 4,2 3,1 2,2 1,1 0,2;0,2 1,3 2,2 3,3 4,2 4,4 0,4");
    check(*state, GNO_CLIP_UNION, "0,0 9,0 9,9 0,9|1,1 1,4 4,4 4,1|4,4 8,4 8,8 4,8", NULL,
          "0,0 9,0 9,9 0,9|4,4 4,8 8,8 8,4|1,1 1,4 4,4 4,1");
    check(*state, GNO_CLIP_UNION, "0,0 9,0 9,9 0,9|1,1 1,4 4,4 4,1|4,1 4,4 8,4 8,1", NULL, "0,0 9,0 9,9 0,9|1,1 1,4 8,4 8,1");
    check(*state, GNO_CLIP_UNION, "0,0 9,0 9,9 0,9|0,1 0,4 4,4 4,1", NULL, "0,0 9,0 9,9 0,9 0,4 4,4 4,1 0,1"); /* along the outer ring */
}

/* An island in a hole is a polygon of its own, and its hole is its own. */
static void test_nesting(void **state)
{
    check(*state, GNO_CLIP_UNION, "0,0 9,0 9,9 0,9|1,1 8,1 8,8 1,8|2,2 7,2 7,7 2,7|3,3 6,3 6,6 3,6", NULL,
          "0,0 9,0 9,9 0,9|1,1 1,8 8,8 8,1;2,2 7,2 7,7 2,7|3,3 3,6 6,6 6,3");
    check(*state, GNO_CLIP_UNION, "0,0 9,0 9,9 0,9|1,1 8,1 8,8 1,8", "2,2 3,2 3,3 2,3", "0,0 9,0 9,9 0,9|1,1 1,8 8,8 8,1;2,2 3,2 3,3 2,3");
}

/* A polygon is the even-odd inside of its rings; the shape is the union of its polygons. */
static void test_even_odd(void **state)
{
    check(*state, GNO_CLIP_UNION, "0,0 4,4 4,0 0,4", NULL, "0,0 2,2 0,4;2,2 4,0 4,4");         /* a bow tie */
    check(*state, GNO_CLIP_UNION, "0,0 4,0 4,4 0,4|2,2 6,2 6,6 2,6", NULL, "0,0 4,0 4,2 2,2 2,4 0,4;2,4 4,4 4,2 6,2 6,6 2,6");
    check(*state, GNO_CLIP_UNION, "0,0 4,0 4,4 0,4;2,2 6,2 6,6 2,6", NULL, "0,0 4,0 4,2 6,2 6,6 2,6 2,4 0,4");
    check(*state, GNO_CLIP_UNION, "0,0 4,0 4,4 0,4 0,0 4,0 4,4 0,4", NULL, "");                   /* twice round is outside */
    check(*state, GNO_CLIP_UNION, SQUARE ";" SQUARE ";" SQUARE, NULL, SQUARE);
    check(*state, GNO_CLIP_UNION, "0,0 4,4 4,0 0,4;1,1 3,1 3,3 1,3", NULL,
          "0,0 1,1 3,1 4,0 4,4 3,3 1,3 0,4"); /* union of a polygon that crosses itself with another */
}

/* A five-pointed star drawn in one stroke has an empty middle. */
static void test_pentagram(void **state)
{
    fixture *f = *state;
    clip(f, GNO_CLIP_UNION, "0,30 20,-30 -30,10 30,10 -20,-30", NULL);
    assert_int_equal(f->result.polygon_count, 5);
    assert_int_equal(f->result.ring_start[5], 15);
}

/* Points repeated, rings of no area, spikes out and back: they count for nothing. */
static void test_nothing_there(void **state)
{
    check(*state, GNO_CLIP_UNION, "0,0 0,0 4,0 4,0 4,4 0,4 0,4 0,0", NULL, SQUARE);
    check(*state, GNO_CLIP_UNION, "0,0 4,0 4,4 0,4|1,1|2,2 3,3|1,2 2,2 3,2", NULL, SQUARE);
    check(*state, GNO_CLIP_UNION, "0,0 4,0 9,0 4,0 4,4 0,4", NULL, SQUARE);      /* out along an edge */
    check(*state, GNO_CLIP_UNION, "0,0 4,0 4,4 2,4 2,1 2,4 0,4", NULL, SQUARE);   /* in */
    check(*state, GNO_CLIP_UNION, "0,0 2,0 4,0 4,4 0,4", NULL, SQUARE);           /* a point on the way */
    check(*state, GNO_CLIP_UNION, "1,1 1,1 1,1", "2,2 3,2", "");
    check(*state, GNO_CLIP_UNION, "", "", "");
    check(*state, GNO_CLIP_UNION, "", NULL, "");
    check(*state, GNO_CLIP_INTERSECTION, SQUARE, "", "");
    check(*state, GNO_CLIP_DIFFERENCE, SQUARE, "", SQUARE);
    check(*state, GNO_CLIP_DIFFERENCE, "", SQUARE, "");
    check(*state, GNO_CLIP_XOR, SQUARE, "1,1 3,3", SQUARE);
}

/* A sheet of squares sharing all their edges melts into one outline; one left out is a hole. */
static void test_shared_grid(void **state)
{
    fixture *f = *state;
    gno_shape s;
    shape_clear(&f->a);
    for (int x = 0; x < 10; x++)
        for (int y = 0; y < 10; y++) {
            if (x == 4 && y == 5)
                continue;
            shape_begin_polygon(&f->a);
            shape_begin_ring(&f->a);
            shape_point(&f->a, x, y);
            shape_point(&f->a, x + 1, y);
            shape_point(&f->a, x + 1, y + 1);
            shape_point(&f->a, x, y + 1);
        }
    s = shape_view(&f->a);
    assert_int_equal(gno_clip(f->clipper, GNO_CLIP_UNION, &s, NULL, &f->result), GNO_OK);
    check_result(&f->result, "0,0 10,0 10,10 0,10|4,5 4,6 5,6 5,5");
}

/* 2^-30 of the extent and thinner: nothing is nudged, so thin things keep their area. */
static void test_thin(void **state)
{
    fixture *f = *state;
    double thin = ldexp(1, -40);
    shape_clear(&f->a);
    shape_begin_polygon(&f->a);
    shape_begin_ring(&f->a);
    shape_point(&f->a, 0, 0);
    shape_point(&f->a, 4, 0);
    shape_point(&f->a, 4, thin);
    shape_point(&f->a, 0, thin);
    {
        gno_shape s = shape_view(&f->a), r;
        shape_buffer other = {0};
        gno_shape o;
        read_shape(&other, "1,-1 3,-1 3,1 1,1");
        o = shape_view(&other);
        assert_int_equal(gno_clip(f->clipper, GNO_CLIP_INTERSECTION, &s, &o, &r), GNO_OK);
        assert_true(gno_shape_area(&r) == 2 * thin);
        assert_int_equal(gno_clip(f->clipper, GNO_CLIP_DIFFERENCE, &o, &s, &r), GNO_OK);
        assert_int_equal(r.polygon_count, 2);
        shape_free(&other);
    }
}

/* The same figure at every size and far from the origin. Where doubles allow it the numbers are the same too. */
static void test_sizes(void **state)
{
    fixture *f = *state;
    const double scales[] = {1e-12, 1e-300, 1e-3, 1, 1e15, 1e299}, offsets[] = {0, 1, 1e6};
    for (size_t i = 0; i < sizeof scales / sizeof *scales; i++)
        for (size_t k = 0; k < sizeof offsets / sizeof *offsets; k++) {
            gno_shape a, b, r;
            double s = scales[i], o = offsets[k] * s;
            const double square[] = {0, 0, 4, 0, 4, 4, 0, 4, 2, 2, 6, 2, 6, 6, 2, 6};
            if (o + 6 * s > 1e300)
                continue;
            shape_clear(&f->a);
            shape_clear(&f->b);
            for (size_t p = 0; p < 8; p++) {
                shape_buffer *to = p < 4 ? &f->a : &f->b;
                if (p % 4 == 0) {
                    shape_begin_polygon(to);
                    shape_begin_ring(to);
                }
                shape_point(to, o + s * square[2 * p], o + s * square[2 * p + 1]);
            }
            a = shape_view(&f->a);
            b = shape_view(&f->b);
            assert_int_equal(gno_clip(f->clipper, GNO_CLIP_INTERSECTION, &a, &b, &r), GNO_OK);
            if (s == 1e-300)
                continue; /* coarser than the grid can be: defined, and here perhaps empty */
            assert_int_equal(r.ring_count, 1);
            assert_int_equal(r.ring_start[1], 4);
            for (size_t p = 0; p < 4; p++)
                for (size_t c = 0; c < 2; c++)
                    assert_true(fabs((r.points[2 * p + c] - o) / s - 3) <= 1 + 1e-9 && fabs((r.points[2 * p + c] - o) / s - 3) >= 1 - 1e-9);
        }
}

static void test_result_as_input(void **state)
{
    fixture *f = *state;
    clip(f, GNO_CLIP_UNION, SQUARE, NULL);
    for (int i = 0; i < 3; i++) {
        gno_shape hole;
        read_shape(&f->b, i == 0 ? "1,1 2,1 2,2 1,2" : i == 1 ? "2,1 3,1 3,2 2,2" : "1,2 3,2 3,3 1,3");
        hole = shape_view(&f->b);
        assert_int_equal(gno_clip(f->clipper, GNO_CLIP_DIFFERENCE, &f->result, &hole, &f->result), GNO_OK);
    }
    check_result(&f->result, SQUARE "|1,1 1,3 3,3 3,1");
    assert_true(gno_shape_area(&f->result) == 12);
}

static void test_arrays(void **state)
{
    fixture *f = *state;
    const size_t rings[] = {0, 4, 8}, falling[] = {4, 0, 8}, beyond[] = {0, 3};
    const double points[] = {0, 0, 4, 0, 4, 4, 0, 4, 2, 2, 6, 2, 6, 6, 2, 6};
    gno_shape s = {2, NULL, 2, rings, points}, bad, r;
    gno_clipper *none;
    assert_int_equal(gno_clip(f->clipper, GNO_CLIP_UNION, &s, NULL, &r), GNO_OK);
    check_result(&r, "0,0 4,0 4,2 6,2 6,6 2,6 2,4 0,4");
    assert_int_equal(gno_clip(NULL, GNO_CLIP_UNION, &s, NULL, &r), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_clip(f->clipper, GNO_CLIP_UNION, NULL, NULL, &r), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_clip(f->clipper, GNO_CLIP_UNION, &s, NULL, NULL), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_clip(f->clipper, (gno_clip_op)7, &s, NULL, &r), GNO_ERROR_ARGUMENT);
    bad = s;
    bad.polygon_count = 1;
    assert_int_equal(gno_clip(f->clipper, GNO_CLIP_UNION, &bad, NULL, &r), GNO_ERROR_ARGUMENT);
    assert_int_equal(r.polygon_count, 0);
    bad = s;
    bad.ring_start = falling;
    assert_int_equal(gno_clip(f->clipper, GNO_CLIP_UNION, &s, &bad, &r), GNO_ERROR_ARGUMENT);
    assert_string_equal(gno_context_message(f->context), "clipping: clip: ring_start[1] is less than the one before");
    bad = s;
    bad.polygon_count = 1;
    bad.polygon_start = beyond;
    assert_int_equal(gno_clip(f->clipper, GNO_CLIP_UNION, &bad, NULL, &r), GNO_ERROR_ARGUMENT);
    bad = s;
    bad.points = NULL;
    assert_int_equal(gno_clip(f->clipper, GNO_CLIP_UNION, &bad, NULL, &r), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_clipper_create(NULL, &none), GNO_ERROR_ARGUMENT);
    assert_null(none);
    assert_true(gno_shape_area(NULL) == 0);
}

static void test_not_numbers(void **state)
{
    fixture *f = *state;
    const double bad[] = {NAN, INFINITY, -INFINITY, 1.1e300, -DBL_MAX};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        gno_shape s;
        read_shape(&f->a, SQUARE);
        f->a.points[5] = bad[i];
        s = shape_view(&f->a);
        assert_int_equal(gno_clip(f->clipper, GNO_CLIP_UNION, &s, NULL, &f->result), GNO_ERROR_ARGUMENT);
        assert_int_equal(f->result.polygon_count, 0);
    }
    assert_string_equal(gno_context_message(f->context), "clipping: subject: coordinate of point 2 is not finite or beyond 1e300");
}

/* Every allocation of a call that meets all passes fails once; the clipper works on afterwards. */
static void test_memory(void **state)
{
    fixture *f = *state;
    size_t at = 0;
    gno_status status = GNO_ERROR_MEMORY;
    for (at = 1; status == GNO_ERROR_MEMORY; at++) {
        fail_alloc a = {0};
        gno_context_def def = fail_alloc_def(&a);
        gno_context *context;
        gno_clipper *clipper = NULL;
        gno_shape s, o, r;
        assert_int_equal(gno_context_create(&def, &context), GNO_OK);
        shapes_make(SHAPES_TANGLE, 7, 6, &f->a, &f->b);
        s = shape_view(&f->a);
        o = shape_view(&f->b);
        a.fail_at = a.calls + at;
        status = gno_clipper_create(context, &clipper);
        if (status == GNO_OK) {
            status = gno_clip(clipper, GNO_CLIP_XOR, &s, &o, &r);
            if (status != GNO_OK) {
                assert_int_equal(r.polygon_count, 0);
                a.fail_at = 0;
                assert_int_equal(gno_clip(clipper, GNO_CLIP_XOR, &s, &o, &r), GNO_OK);
                assert_true(r.polygon_count > 0);
            }
        }
        assert_true(status == GNO_OK || status == GNO_ERROR_MEMORY);
        gno_clipper_destroy(clipper);
        gno_context_destroy(context);
        assert_false(a.wrong_size);
        assert_int_equal(a.held, 0);
    }
    assert_true(at > 25);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_crossing),       cmocka_unit_test(test_inside),         cmocka_unit_test(test_apart),
        cmocka_unit_test(test_identical),      cmocka_unit_test(test_shared_edge),    cmocka_unit_test(test_edge_inside),
        cmocka_unit_test(test_vertex_on_edge), cmocka_unit_test(test_vertex_on_vertex), cmocka_unit_test(test_pinched_apart),
        cmocka_unit_test(test_touching_holes), cmocka_unit_test(test_nesting),        cmocka_unit_test(test_even_odd),
        cmocka_unit_test(test_pentagram),      cmocka_unit_test(test_nothing_there),  cmocka_unit_test(test_shared_grid),
        cmocka_unit_test(test_thin),           cmocka_unit_test(test_sizes),          cmocka_unit_test(test_result_as_input),
        cmocka_unit_test(test_arrays),         cmocka_unit_test(test_not_numbers),    cmocka_unit_test(test_memory),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down) != 0;
}
