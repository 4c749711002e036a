/* test_lines.c -- the visible pieces of a line, and the stacks of what lets light through before them, against twins that look at single
 * places of the line: all surfaces there, sorted by depth.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scan/stack.h"

enum { PIXELS = 6, WIDE = PIXELS * GNOI_X_ONE, MOST = 24, PLACES = 200, ROUNDS = 400 };

static const double row = 7.25;

typedef struct segment {
    uint32_t slot;
    int32_t x0, x1;
} segment;

typedef struct fixture {
    gno_context *context;
    gnoi_lines lines;
    gnoi_stacks stacks;
    uint64_t random;
    size_t count; /* surfaces, slots 0..count-1 */
    gnoi_depth depths[MOST];
    size_t segment_count;
    segment segments[MOST];
} fixture;

static double random_in(fixture *f, double low, double high)
{
    f->random ^= f->random << 13;
    f->random ^= f->random >> 7;
    f->random ^= f->random << 17;
    return low + (high - low) * (double)(f->random >> 11) * 0x1p-53;
}

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    *state = f;
    if (!f || gno_context_create(NULL, &f->context) != GNO_OK)
        return 1;
    f->lines.context = f->stacks.context = f->context;
    f->lines.depths = f->depths;
    f->random = 88172645463325252u;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    f->lines.depths = NULL;
    f->lines.depth_capacity = 0;
    gnoi_stacks_free(&f->stacks);
    gnoi_lines_free(&f->lines);
    gno_context_destroy(f->context);
    free(f);
    return 0;
}

/* An empty line, and no surface. */
static void begin(fixture *f)
{
    gnoi_lines_reset(&f->lines);
    gnoi_lines_add(&f->lines, row, 0, WIDE);
    f->count = f->segment_count = 0;
}

static double nearness(const gnoi_depth *d, double x) { return d->fx * x + d->fy * row + d->f0; }

/* A surface with a nearness at each end of the line. */
static uint32_t add_surface(fixture *f, double left, double right, double tolerance, int priority)
{
    gnoi_depth *d = &f->depths[f->count];
    memset(d, 0, sizeof *d);
    d->fx = (right - left) / WIDE;
    d->fy = 0.01;
    d->f0 = left - d->fy * row;
    d->tolerance_0 = tolerance;
    d->index = (uint32_t)f->count;
    d->priority = priority;
    d->nearest = (float)(fmax(left, right) + 1e-4);
    d->farthest = (float)(fmin(left, right) - 1e-4);
    d->surely_before = d->nearest + 2 * (float)tolerance + 1e-4f;
    d->surely_behind = d->farthest - 2 * (float)tolerance - 1e-4f;
    f->lines.depth_count = f->count + 1;
    return (uint32_t)f->count++;
}

static segment *add_segment(fixture *f, uint32_t slot, int32_t x0, int32_t x1)
{
    segment *s = &f->segments[f->segment_count++];
    s->slot = slot;
    s->x0 = x0;
    s->x1 = x1;
    return s;
}

static segment *add_random_segment(fixture *f, uint32_t slot)
{
    const int32_t a = (int32_t)random_in(f, -WIDE / 8, WIDE), b = (int32_t)random_in(f, 0, WIDE + WIDE / 8);
    return add_segment(f, slot, a < b ? a : b, a < b ? b + 1 : a + 1);
}

static void insert(fixture *f, const segment *s) { gnoi_lines_insert(&f->lines, 0, s->slot, s->x0, s->x1); }

static void check_invariants(const fixture *f)
{
    const gnoi_line *l = &f->lines.lines[0];
    int32_t end = l->xa, covered = 0;
    float farthest = HUGE_VALF;
    assert_false(f->lines.failed);
    for (uint32_t p = l->first; p; p = f->lines.pieces[p].next) {
        const gnoi_piece *piece = &f->lines.pieces[p];
        assert_true(piece->x0 >= end && piece->x0 < piece->x1 && piece->x1 <= l->xb);
        assert_true(piece->surely_before == f->depths[piece->slot].surely_before);
        assert_true(piece->surely_behind == f->depths[piece->slot].surely_behind);
        end = piece->x1;
        covered += piece->x1 - piece->x0;
        farthest = fminf(farthest, f->depths[piece->slot].farthest);
    }
    assert_int_equal(l->uncovered, l->xb - l->xa - covered);
    assert_true(l->farthest <= farthest);
}

/* The surface of the piece at x, or -1. */
static int shown(const fixture *f, int32_t x)
{
    for (uint32_t p = f->lines.lines[0].first; p; p = f->lines.pieces[p].next)
        if (f->lines.pieces[p].x0 <= x && x < f->lines.pieces[p].x1)
            return (int)f->lines.pieces[p].slot;
    return -1;
}

/* The nearest surface at x, -1 for none, -2 when two are too near each other to tell. */
static int nearest(const fixture *f, int32_t x, double apart)
{
    int best = -1;
    double gap = HUGE_VAL;
    for (size_t i = 0; i < f->segment_count; i++) {
        const segment *s = &f->segments[i];
        double by;
        if (x < s->x0 || x >= s->x1 || (int)s->slot == best)
            continue;
        if (best < 0) {
            best = (int)s->slot;
            continue;
        }
        by = nearness(&f->depths[s->slot], x) - nearness(&f->depths[best], x);
        gap = fmin(gap, fabs(by));
        best = by > 0 ? (int)s->slot : best;
    }
    return gap < apart ? -2 : best;
}

static void test_nearest_is_kept(void **state)
{
    fixture *f = *state;
    for (int round = 0; round < ROUNDS; round++) {
        const size_t count = 2 + (size_t)random_in(f, 0, MOST - 2);
        const double slope = round % 2 ? 0.5 : 4; /* they cross rarely, or often */
        size_t seen = 0;
        begin(f);
        for (size_t i = 0; i < count; i++) {
            const double at = random_in(f, 1, 5);
            add_surface(f, at, at + random_in(f, -slope, slope), 1e-12, 0);
            insert(f, add_random_segment(f, (uint32_t)i));
            check_invariants(f);
        }
        for (int k = 0; k < PLACES; k++) {
            const int32_t x = (int32_t)random_in(f, 0, WIDE);
            const int want = nearest(f, x, 1e-3);
            if (want == -2)
                continue;
            assert_int_equal(shown(f, x), want);
            seen++;
        }
        assert_true(seen > PLACES / 2);
    }
}

/* The ends of pieces, too, to the unit. */
static void test_ends(void **state)
{
    fixture *f = *state;
    const int32_t a = 1000, b = 5000, c = 7000, d = 20000;
    begin(f);
    add_surface(f, 1, 1, 1e-9, 0);
    add_surface(f, 2, 2, 1e-9, 0);
    insert(f, add_segment(f, 0, a, d));
    insert(f, add_segment(f, 1, b, c)); /* before the middle */
    check_invariants(f);
    assert_int_equal(shown(f, a - 1), -1);
    assert_int_equal(shown(f, a), 0);
    assert_int_equal(shown(f, b - 1), 0);
    assert_int_equal(shown(f, b), 1);
    assert_int_equal(shown(f, c - 1), 1);
    assert_int_equal(shown(f, c), 0);
    assert_int_equal(shown(f, d - 1), 0);
    assert_int_equal(shown(f, d), -1);
    assert_int_equal(f->lines.lines[0].uncovered, WIDE - (d - a));
}

/* Surfaces on one plane but for rounding: the higher priority everywhere, then the lower number, in whatever order they come. */
static void test_on_each_other(void **state)
{
    fixture *f = *state;
    const double tolerance = 1e-7;
    for (int round = 0; round < ROUNDS; round++) {
        const size_t count = 2 + (size_t)random_in(f, 0, 6);
        const double left = random_in(f, 1, 2), right = random_in(f, 1, 2);
        begin(f);
        for (size_t i = 0; i < count; i++) {
            add_surface(f, left + random_in(f, -0.2, 0.2) * tolerance, right + random_in(f, -0.2, 0.2) * tolerance, tolerance,
                        (int)random_in(f, 0, 3));
            add_random_segment(f, (uint32_t)i);
        }
        for (size_t i = 0; i < count; i++)
            insert(f, &f->segments[round % 2 ? i : count - 1 - i]);
        check_invariants(f);
        for (int k = 0; k < PLACES; k++) {
            const int32_t x = (int32_t)random_in(f, 0, WIDE);
            int want = -1;
            for (size_t i = 0; i < count; i++)
                if (x >= f->segments[i].x0 && x < f->segments[i].x1 && (want < 0 || f->depths[i].priority > f->depths[want].priority))
                    want = (int)i;
            assert_int_equal(shown(f, x), want);
        }
    }
}

/* The two sides of a sharp edge are as near where they meet, but do not lie on each other: priority does not count. */
static void test_sharp_edge(void **state)
{
    fixture *f = *state;
    const double tolerance = 1e-7;
    for (int front = 0; front < 2; front++) {
        begin(f);
        add_surface(f, 1, front == 0 ? 1 + 1e-3 : 1 - 1e-3, tolerance, 0);
        add_surface(f, 1, 1, tolerance, front == 0); /* the one behind has the higher priority, or the lower number */
        insert(f, add_segment(f, 0, 0, 8));
        insert(f, add_segment(f, 1, 0, 8));
        assert_int_equal(shown(f, 4), front);
    }
}

/* ---- stacks -------------------------------------------------------------------------------------------------------------- */

/* Slots below OPAQUE hide all; of the others each third lets a different part through in each pixel, and some nothing at all. */
enum { OPAQUE = 3 };

static gnoi_pass pass_at(uint32_t slot, int32_t pixel)
{
    gnoi_pass pass;
    pass.varies = slot % 3 == 0;
    for (int k = 0; k < 3; k++)
        pass.through[k] = slot % 7 == 6 ? 0 : (float)((slot * 29 + (uint32_t)k * 13 + (pass.varies ? (uint32_t)pixel * 41 : 0)) % 64) / 64;
    pass.own = (float)((slot * 11 + 5) % 32 + 1) / 32;
    return pass;
}

static gnoi_pass pass_of(void *user, uint32_t slot, int32_t x0, int32_t x1, double y)
{
    const gnoi_pass pass = pass_at(slot, x0 / GNOI_X_ONE);
    (void)user;
    assert_true(y == row);
    assert_true(!pass.varies || x1 <= (x0 / GNOI_X_ONE + 1) * GNOI_X_ONE); /* asked for within one pixel */
    return pass;
}

static void check_tint(gnoi_tint found, const double want[4])
{
    for (int k = 0; k < 3; k++)
        assert_true(fabs(found.rgb[k] - want[k]) < 1e-6);
    assert_true(fabs(found.hides - want[3]) < 1e-6);
}

/* No opaque piece at x: what is seen of the background, noted once if something lies before it. */
static void check_bare(const fixture *f, int32_t x, const double tint[4], int wanted)
{
    int found = 0;
    for (size_t b = f->stacks.bare_start[0]; b < f->stacks.bare_start[1]; b++)
        if (f->stacks.bares[b].x0 <= x && x < f->stacks.bares[b].x1) {
            check_tint(f->stacks.bares[b].tint, tint);
            found++;
        }
    assert_int_equal(found, wanted);
}

/* What is seen at x: surfaces from front to back, each with its tint, and the bare background behind them if nothing opaque is. */
static void check_place(const fixture *f, int32_t x)
{
    double light[4] = {1, 1, 1, 1}, last = HUGE_VAL;
    size_t pieces = 0, found = 0;
    int ended = 0; /* by an opaque surface */
    for (uint32_t p = f->lines.lines[0].first; p; p = f->lines.pieces[p].next)
        pieces += f->lines.pieces[p].x0 <= x && x < f->lines.pieces[p].x1;
    for (;;) {
        int next = -1;
        gnoi_pass pass;
        double want[4], hid = light[3];
        for (size_t i = 0; i < f->segment_count; i++) {
            const segment *s = &f->segments[i];
            const double z = nearness(&f->depths[s->slot], x);
            if (x >= s->x0 && x < s->x1 && z < last && (next < 0 || z > nearness(&f->depths[next], x)))
                next = (int)s->slot;
        }
        if (next < 0 || !(light[0] > 0 || light[1] > 0 || light[2] > 0))
            break;
        last = nearness(&f->depths[next], x);
        pass = pass_at((uint32_t)next, x / GNOI_X_ONE);
        for (int k = 0; k < 3; k++) {
            want[k] = next < OPAQUE ? light[k] : light[k] * pass.own;
            light[k] = next < OPAQUE ? 0 : light[k] * pass.through[k];
        }
        light[3] = (light[0] + light[1] + light[2]) / 3;
        want[3] = hid - light[3];
        found++;
        for (uint32_t p = f->lines.lines[0].first; p; p = f->lines.pieces[p].next)
            if (f->lines.pieces[p].x0 <= x && x < f->lines.pieces[p].x1 && (int)f->lines.pieces[p].slot == next) {
                check_tint(f->stacks.tints[p], want);
                pieces--;
            }
        ended = next < OPAQUE;
        if (ended)
            break;
    }
    assert_int_equal(pieces, 0); /* none twice, none hidden */
    check_bare(f, x, light, found > 0 && !ended);
}

static void test_stacks(void **state)
{
    fixture *f = *state;
    for (int round = 0; round < ROUNDS; round++) {
        const size_t count = OPAQUE + 1 + (size_t)random_in(f, 0, 7);
        begin(f);
        for (size_t i = 0; i < count; i++) {
            const double at = random_in(f, i < OPAQUE ? 0.5 : 1, i < OPAQUE ? 2 : 5);
            add_surface(f, at, at + random_in(f, -1, 1), 1e-12, 0);
            add_random_segment(f, (uint32_t)i);
        }
        for (size_t i = 0; i < OPAQUE; i++)
            insert(f, &f->segments[i]);
        gnoi_stacks_reset(&f->stacks, &f->lines);
        for (size_t i = OPAQUE; i < count; i++)
            gnoi_stacks_insert(&f->stacks, &f->lines, 0, f->segments[i].slot, f->segments[i].x0, f->segments[i].x1);
        gnoi_stacks_resolve(&f->stacks, &f->lines, pass_of, NULL);
        assert_false(f->stacks.failed);
        for (int k = 0; k < PLACES; k++) {
            const int32_t x = (int32_t)random_in(f, 0, WIDE);
            if (nearest(f, x, 1e-3) != -2)
                check_place(f, x);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_nearest_is_kept), cmocka_unit_test(test_ends),   cmocka_unit_test(test_on_each_other),
        cmocka_unit_test(test_sharp_edge),      cmocka_unit_test(test_stacks),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down) != 0;
}
