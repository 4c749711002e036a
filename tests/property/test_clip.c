/* test_clip.c -- the clipper against its slow twin (support/slabs.h) and against itself, on random and nasty shapes. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>
#include <clip/clipper.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <support/shapes.h>
#include <support/slabs.h>

#define SEEDS 80
#define TOLERANCE 1e-9 /* of extent squared */

typedef struct fixture {
    gno_context *context;
    gno_clipper *clipper;
    shape_buffer a, b, kept;
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
    shape_free(&f->kept);
    free(f);
    return 0;
}

static void keep(shape_buffer *to, const gno_shape *s)
{
    shape_clear(to);
    for (size_t p = 0; p < s->polygon_count; p++) {
        shape_begin_polygon(to);
        for (size_t r = s->polygon_start[p]; r < s->polygon_start[p + 1]; r++) {
            shape_begin_ring(to);
            for (size_t i = s->ring_start[r]; i < s->ring_start[r + 1]; i++)
                shape_point(to, s->points[2 * i], s->points[2 * i + 1]);
        }
    }
}

static double twice_area(const gno_shape *s, size_t ring)
{
    double sum = 0;
    size_t o = s->ring_start[ring];
    for (size_t i = o + 2; i < s->ring_start[ring + 1]; i++)
        sum += (s->points[2 * i - 2] - s->points[2 * o]) * (s->points[2 * i + 1] - s->points[2 * o + 1]) -
               (s->points[2 * i] - s->points[2 * o]) * (s->points[2 * i - 1] - s->points[2 * o + 1]);
    return sum;
}

/* Outer rings counter-clockwise, holes clockwise, three points or more; exactly, when coordinates are small integers. */
static void check_turns(const gno_shape *s, double slack)
{
    for (size_t p = 0; p < s->polygon_count; p++) {
        assert_true(s->polygon_start[p] < s->polygon_start[p + 1]);
        for (size_t r = s->polygon_start[p]; r < s->polygon_start[p + 1]; r++) {
            assert_true(s->ring_start[r + 1] - s->ring_start[r] >= 3);
            assert_true(r == s->polygon_start[p] ? twice_area(s, r) > -slack : twice_area(s, r) < slack);
        }
    }
}

static void near_area(double a, double b, double extent, int family, unsigned seed, int op)
{
    if (!(fabs(a - b) <= TOLERANCE * extent * extent))
        fail_msg("%s seed %u op %d: %.17g is not %.17g", shapes_name[family], seed, op, a, b);
}

static void check_pair(fixture *f, int family, unsigned seed)
{
    gno_shape a, b, result;
    double area[4], alone[2], extent;
    shapes_make(family, seed, 1, &f->a, &f->b);
    a = shape_view(&f->a);
    b = shape_view(&f->b);
    extent = slab_extent(&a, &b);
    for (int op = 0; op < 4; op++) {
        assert_int_equal(gno_clip(f->clipper, (gno_clip_op)op, &a, &b, &result), GNO_OK);
        area[op] = gno_shape_area(&result);
        check_turns(&result, 1e-12 * extent * extent);
        near_area(area[op], slab_area((gno_clip_op)op, &a, &b), extent, family, seed, op);
        if (op == GNO_CLIP_DIFFERENCE) { /* what is left of a lies outside b */
            assert_int_equal(gno_clip(f->clipper, GNO_CLIP_INTERSECTION, &result, &b, &result), GNO_OK);
            near_area(gno_shape_area(&result), 0, extent, family, seed, op);
        }
    }
    for (int k = 0; k < 2; k++) {
        assert_int_equal(gno_clip(f->clipper, GNO_CLIP_INTERSECTION, k ? &b : &a, NULL, &result), GNO_OK);
        alone[k] = gno_shape_area(&result);
    }
    near_area(alone[0] + alone[1], area[GNO_CLIP_UNION] + area[GNO_CLIP_INTERSECTION], extent, family, seed, 4);
    near_area(alone[0] - area[GNO_CLIP_INTERSECTION], area[GNO_CLIP_DIFFERENCE], extent, family, seed, 5);
    near_area(area[GNO_CLIP_UNION] - area[GNO_CLIP_INTERSECTION], area[GNO_CLIP_XOR], extent, family, seed, 6);
}

static void test_families(void **state)
{
    for (int family = 0; family < SHAPES_FAMILIES; family++)
        for (unsigned seed = 1; seed <= SEEDS; seed++)
            check_pair(*state, family, seed);
}

/* The union of a result is that result again, point by point but for where rings start and in which order they come. */
static void test_idempotence(void **state)
{
    fixture *f = *state;
    for (int family = 0; family < SHAPES_FAMILIES; family++)
        for (unsigned seed = 1; seed <= SEEDS; seed++) {
            gno_shape a, b, once, twice;
            shapes_make(family, seed, 1, &f->a, &f->b);
            a = shape_view(&f->a);
            b = shape_view(&f->b);
            assert_int_equal(gno_clip(f->clipper, GNO_CLIP_XOR, &a, &b, &once), GNO_OK);
            keep(&f->kept, &once);
            once = shape_view(&f->kept);
            assert_int_equal(gno_clip(f->clipper, GNO_CLIP_UNION, &once, NULL, &twice), GNO_OK);
            near_area(gno_shape_area(&twice), gno_shape_area(&once), slab_extent(&a, &b), family, seed, 0);
            assert_int_equal(gno_clip(f->clipper, GNO_CLIP_XOR, &once, &once, &twice), GNO_OK);
            assert_int_equal(twice.polygon_count, 0);
            assert_int_equal(gno_clip(f->clipper, GNO_CLIP_DIFFERENCE, &once, &once, &twice), GNO_OK);
            assert_int_equal(twice.polygon_count, 0);
        }
}

/* ---- on a grid so coarse that every edge bends ------------------------------------------------------------------------ */

typedef struct corner {
    double x, y;
} corner;

static double turn(corner a, corner b, corner c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

static int sign(double v)
{
    return (v > 0) - (v < 0);
}

static corner corner_at(const gno_shape *s, size_t ring, size_t i)
{
    size_t first = s->ring_start[ring], n = s->ring_start[ring + 1] - first;
    corner c = {s->points[2 * (first + i % n)], s->points[2 * (first + i % n) + 1]};
    return c;
}

/* Edges may touch in points; they must neither cross nor run along one another. Coordinates are small: doubles are exact. */
static void check_edges(corner a, corner b, corner c, corner d)
{
    int cs = sign(turn(a, b, c)), ds = sign(turn(a, b, d)), as = sign(turn(c, d, a)), bs = sign(turn(c, d, b));
    assert_false(cs * ds < 0 && as * bs < 0);
    if (cs == 0 && ds == 0) {
        double length = (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y);
        double tc = (c.x - a.x) * (b.x - a.x) + (c.y - a.y) * (b.y - a.y), td = (d.x - a.x) * (b.x - a.x) + (d.y - a.y) * (b.y - a.y);
        assert_true(fmax(tc, td) <= 0 || fmin(tc, td) >= length);
    }
}

static void check_ring_pair(const gno_shape *s, size_t q, size_t r)
{
    size_t n = s->ring_start[q + 1] - s->ring_start[q], m = s->ring_start[r + 1] - s->ring_start[r];
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < (q == r ? i : m); j++) {
            corner a = corner_at(s, q, i), c = corner_at(s, r, j);
            assert_false(q == r && a.x == c.x && a.y == c.y);
            check_edges(a, corner_at(s, q, i + 1), c, corner_at(s, r, j + 1));
        }
}

static void check_corners(const gno_shape *s, size_t ring)
{
    size_t n = s->ring_start[ring + 1] - s->ring_start[ring];
    for (size_t i = 0; i < n; i++)
        assert_true(turn(corner_at(s, ring, i), corner_at(s, ring, i + 1), corner_at(s, ring, i + 2)) != 0);
}

/* Everything that can be said of a result by looking at all pairs of its edges, and its area by the twin. */
static void check_result(const gno_shape *s, double extent, int family, unsigned seed)
{
    check_turns(s, 0);
    for (size_t q = 0; q < s->ring_count; q++) {
        check_corners(s, q);
        for (size_t r = 0; r <= q; r++)
            check_ring_pair(s, q, r);
    }
    near_area(slab_area(GNO_CLIP_UNION, s, NULL), gno_shape_area(s), extent, family, seed, 7);
}

static void test_coarse_grid(void **state)
{
    fixture *f = *state;
    for (int family = 0; family < SHAPES_FAMILIES; family++)
        for (unsigned seed = 1; seed <= SEEDS; seed++) {
            gno_shape a, b, result;
            shapes_make(family, seed, 1, &f->a, &f->b);
            a = shape_view(&f->a);
            b = shape_view(&f->b);
            f->clipper->bits = 3 + (int)(seed % 6);
            assert_int_equal(gno_clip(f->clipper, (gno_clip_op)(seed % 4), &a, &b, &result), GNO_OK);
            check_result(&result, slab_extent(&a, &b), family, seed);
        }
    f->clipper->bits = GNOI_CLIP_BITS;
}

/* ---- crowds: hundreds of edges on one another, side by side, through one place ---------------------------------------------- */

enum { SAME, BUNDLE, NEEDLES, CROWDS };

static void make_crowd(shape_buffer *to, int kind, int count)
{
    shape_clear(to);
    for (int i = 0; i < count; i++) {
        double h = 1e-5 * i, angle = 3.14159 * i / count;
        shape_begin_polygon(to);
        shape_begin_ring(to);
        for (int k = 0; kind == SAME && k < 6; k++)
            shape_point(to, cos((i % 2 ? k : -k) * 1.047), sin((i % 2 ? k : -k) * 1.047));
        for (int k = 0; kind == BUNDLE && k < 4; k++)
            shape_point(to, k == 1 || k == 2, (k == 1 || k == 2) + h + (k > 1 ? 1.2e-5 : 0));
        for (int k = 0; kind == NEEDLES && k < 3; k++)
            shape_point(to, (k ? -1 : 1) * cos(angle + (k > 1 ? 0.5 / count : 0)), (k ? -1 : 1) * sin(angle + (k > 1 ? 0.5 / count : 0)));
    }
}

static void test_crowds(void **state)
{
    fixture *f = *state;
    for (int kind = 0; kind < CROWDS; kind++)
        for (int fine = 0; fine < 2; fine++) {
            gno_shape a, result;
            make_crowd(&f->a, kind, kind == NEEDLES ? 70 : 150);
            a = shape_view(&f->a);
            f->clipper->bits = fine ? GNOI_CLIP_BITS : 9;
            assert_int_equal(gno_clip(f->clipper, GNO_CLIP_UNION, &a, NULL, &result), GNO_OK);
            if (fine)
                near_area(gno_shape_area(&result), slab_area(GNO_CLIP_UNION, &a, NULL), 2, kind, 0, 0);
            else
                check_result(&result, 2, kind, 0);
        }
    f->clipper->bits = GNOI_CLIP_BITS;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_families),
        cmocka_unit_test(test_idempotence),
        cmocka_unit_test(test_coarse_grid),
        cmocka_unit_test(test_crowds),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down) != 0;
}
