/* test_span_split.c -- gno_span_split, the four rules of the shadow pass, with numbers worked by hand and against a twin.
 *
 * The twin works on integers: it walks the unit intervals between x0 and x1 one by one and multiplies what lies over each.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>
#include <gnomon/gnomon.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST 64
#define LEN(a) (sizeof(a) / sizeof *(a))

static gno_shadow_interval shadow(double x0, double x1, double t)
{
    gno_shadow_interval s;
    s.x0 = x0;
    s.x1 = x1;
    s.transmission[0] = s.transmission[1] = s.transmission[2] = t;
    return s;
}

typedef struct expected {
    double x0, x1, light;
} expected;

/* Splits, and checks every part and that nothing is written past the 2 count + 1 parts that the contract asks for. */
static void check(double x0, double x1, gno_shadow_interval *shadows, size_t count, const expected *want, size_t want_count)
{
    gno_span_part parts[2 * MOST + 2];
    memset(parts, 0x5a, sizeof parts);
    gno_span_part guard = parts[2 * count + 1];
    size_t n = gno_span_split(x0, x1, shadows, count, parts);
    assert_int_equal(n, want_count);
    assert_memory_equal(&parts[2 * count + 1], &guard, sizeof guard);
    for (size_t i = 0; i < n; i++) {
        assert_true(parts[i].x0 == want[i].x0);
        assert_true(parts[i].x1 == want[i].x1);
        for (int c = 0; c < 3; c++) assert_true(parts[i].light[c] == want[i].light);
    }
    for (size_t i = 1; i < count; i++) assert_true(shadows[i - 1].x0 <= shadows[i].x0);
}

/* Rule 1: no shadow polygon. */
static void test_none(void **state)
{
    (void)state;
    const expected want[] = {{2, 10, 1}};
    check(2, 10, NULL, 0, want, 1);
}

/* Rule 2: shadow polygons, but none meets the span. */
static void test_miss(void **state)
{
    (void)state;
    const expected want[] = {{2, 10, 1}};
    gno_shadow_interval left[] = {shadow(-5, 1, 0)};
    gno_shadow_interval right[] = {shadow(11, 20, 0)};
    gno_shadow_interval both[] = {shadow(-5, 1, 0), shadow(11, 20, 0)};
    check(2, 10, left, 1, want, 1);
    check(2, 10, right, 1, want, 1);
    check(2, 10, both, 2, want, 1);
}

/* Half-open intervals: one that ends where the span begins, or begins where it ends, does not meet it. */
static void test_touch_from_outside(void **state)
{
    (void)state;
    const expected want[] = {{2, 10, 1}};
    gno_shadow_interval both[] = {shadow(0, 2, 0), shadow(10, 12, 0)};
    check(2, 10, both, 2, want, 1);
}

/* Rule 3: wholly covered, by one or by several together. */
static void test_cover(void **state)
{
    (void)state;
    const expected want[] = {{2, 10, 0}};
    gno_shadow_interval exactly[] = {shadow(2, 10, 0)};
    gno_shadow_interval beyond[] = {shadow(-1, 11, 0)};
    gno_shadow_interval together[] = {shadow(1, 6, 0), shadow(5, 12, 0)};
    gno_shadow_interval twice[] = {shadow(2, 10, 0), shadow(2, 10, 0)};
    check(2, 10, exactly, 1, want, 1);
    check(2, 10, beyond, 1, want, 1);
    check(2, 10, together, 2, want, 1);
    check(2, 10, twice, 2, want, 1);
}

/* Rule 4: partly covered at the left, the right, in the middle. */
static void test_partly(void **state)
{
    (void)state;
    gno_shadow_interval left[] = {shadow(0, 5, 0)};
    const expected want_left[] = {{2, 5, 0}, {5, 10, 1}};
    check(2, 10, left, 1, want_left, 2);
    gno_shadow_interval left_flush[] = {shadow(2, 5, 0)};
    check(2, 10, left_flush, 1, want_left, 2);
    gno_shadow_interval right[] = {shadow(7, 30, 0)};
    const expected want_right[] = {{2, 7, 1}, {7, 10, 0}};
    check(2, 10, right, 1, want_right, 2);
    gno_shadow_interval right_flush[] = {shadow(7, 10, 0)};
    check(2, 10, right_flush, 1, want_right, 2);
    gno_shadow_interval middle[] = {shadow(4, 7, 0)};
    const expected want_middle[] = {{2, 4, 1}, {4, 7, 0}, {7, 10, 1}};
    check(2, 10, middle, 1, want_middle, 3);
}

static void test_several_overlapping(void **state)
{
    (void)state;
    gno_shadow_interval s[] = {shadow(1, 3, 0), shadow(4, 6, 0), shadow(5, 7, 0), shadow(5.5, 5.75, 0), shadow(9, 12, 0)};
    const expected want[] = {{0, 1, 1}, {1, 3, 0}, {3, 4, 1}, {4, 7, 0}, {7, 9, 1}, {9, 10, 0}};
    check(0, 10, s, LEN(s), want, LEN(want));
}

/* One caster ends where the next begins: no light between, and one part, not two. */
static void test_touching_casters(void **state)
{
    (void)state;
    double seam = 0.1 + 0.2; /* an end that is no round number in binary */
    gno_shadow_interval s[] = {shadow(0.1, seam, 0), shadow(seam, 0.7, 0)};
    const expected want[] = {{0, 0.1, 1}, {0.1, 0.7, 0}, {0.7, 1, 1}};
    check(0, 1, s, 2, want, 3);
    gno_shadow_interval chain[] = {shadow(0, 1, 0), shadow(1, 2, 0), shadow(2, 3, 0), shadow(3, 4, 0)};
    const expected dark[] = {{0, 4, 0}};
    check(0, 4, chain, 4, dark, 1);
}

/* The same with glass: light does not jump to 1 at the seam. */
static void test_touching_glass(void **state)
{
    (void)state;
    gno_shadow_interval alike[] = {shadow(1, 2, 0.5), shadow(2, 3, 0.5)};
    const expected one[] = {{0, 1, 1}, {1, 3, 0.5}, {3, 4, 1}};
    check(0, 4, alike, 2, one, 3);
    gno_shadow_interval unlike[] = {shadow(1, 2, 0.5), shadow(2, 3, 0.25)};
    const expected two[] = {{0, 1, 1}, {1, 2, 0.5}, {2, 3, 0.25}, {3, 4, 1}};
    check(0, 4, unlike, 2, two, 4);
}

/* 0.8 and 0.5 pass 0.4, but only where both lie. */
static void test_glass_multiplies(void **state)
{
    (void)state;
    gno_shadow_interval s[] = {shadow(1, 6, 0.8), shadow(4, 9, 0.5)};
    const expected want[] = {{0, 1, 1}, {1, 4, 0.8}, {4, 6, 0.8 * 0.5}, {6, 9, 0.5}, {9, 10, 1}};
    check(0, 10, s, 2, want, 5);
    gno_shadow_interval inner[] = {shadow(0, 10, 0.5), shadow(3, 5, 0.5), shadow(4, 5, 0.5)};
    const expected nested[] = {{0, 3, 0.5}, {3, 4, 0.25}, {4, 5, 0.125}, {5, 10, 0.5}};
    check(0, 10, inner, 3, nested, 4);
}

/* A product must come back exactly after an opaque caster (a division by 0 would not) and after many factors (rounding). */
static void test_opaque_over_glass(void **state)
{
    (void)state;
    gno_shadow_interval s[] = {shadow(0, 10, 0.3), shadow(2, 4, 0), shadow(6, 7, 0.7)};
    const expected want[] = {{0, 2, 0.3}, {2, 4, 0}, {4, 6, 0.3}, {6, 7, 0.3 * 0.7}, {7, 10, 0.3}};
    check(0, 10, s, 3, want, 5);
}

/* Clear glass and glass over an opaque caster change nothing: parts that are alike are one part. */
static void test_alike_parts_merge(void **state)
{
    (void)state;
    gno_shadow_interval clear[] = {shadow(2, 4, 1)};
    const expected lit[] = {{0, 10, 1}};
    check(0, 10, clear, 1, lit, 1);
    gno_shadow_interval under[] = {shadow(0, 10, 0), shadow(2, 4, 0.5)};
    const expected dark[] = {{0, 10, 0}};
    check(0, 10, under, 2, dark, 1);
    gno_shadow_interval steps[] = {shadow(0, 4, 0.5), shadow(0, 4, 0.5), shadow(4, 10, 0.25)};
    const expected same[] = {{0, 10, 0.25}};
    check(0, 10, steps, 3, same, 1);
}

/* Parts differ when a single channel does, and channels do not mix. */
static void test_channels(void **state)
{
    (void)state;
    gno_span_part parts[7];
    gno_shadow_interval s[3] = {{1, 4, {1, 0.5, 0}}, {3, 6, {0.25, 1, 1}}, {4, 5, {1, 1, 0.5}}};
    assert_int_equal(gno_span_split(0, 8, s, 3, parts), 6);
    const gno_span_part want[] = {{0, 1, {1, 1, 1}},    {1, 3, {1, 0.5, 0}},     {3, 4, {0.25, 0.5, 0}},
                                  {4, 5, {0.25, 1, 0.5}}, {5, 6, {0.25, 1, 1}}, {6, 8, {1, 1, 1}}};
    for (size_t i = 0; i < 6; i++) {
        assert_true(parts[i].x0 == want[i].x0 && parts[i].x1 == want[i].x1);
        for (int c = 0; c < 3; c++) assert_true(parts[i].light[c] == want[i].light[c]);
    }
}

static void test_zero_length(void **state)
{
    (void)state;
    const expected lit[] = {{0, 10, 1}};
    gno_shadow_interval nothing[] = {shadow(3, 3, 0), shadow(5, 4, 0), shadow(0, 0, 0), shadow(10, 10, 0)};
    check(0, 10, nothing, 4, lit, 1);
    gno_shadow_interval beside[] = {shadow(3, 3, 0), shadow(3, 6, 0), shadow(6, 6, 0.5)};
    const expected want[] = {{0, 3, 1}, {3, 6, 0}, {6, 10, 1}};
    check(0, 10, beside, 3, want, 3);
    gno_shadow_interval turned[] = {shadow(9, 1, 0), shadow(2, 3, 0)}; /* x1 < x0 counts for nothing, wherever it lies */
    const expected one[] = {{0, 2, 1}, {2, 3, 0}, {3, 10, 1}};
    check(0, 10, turned, 2, one, 3);
}

static void test_empty_span(void **state)
{
    (void)state;
    gno_shadow_interval s[] = {shadow(0, 10, 0)};
    gno_span_part parts[3];
    assert_int_equal(gno_span_split(5, 5, s, 1, parts), 0);
    assert_int_equal(gno_span_split(6, 5, s, 1, parts), 0);
    assert_int_equal(gno_span_split(5, 5, NULL, 0, parts), 0);
}

/* The smallest span and part there can be. */
static void test_neighbouring_doubles(void **state)
{
    (void)state;
    double a = 1, b = nextafter(a, 2), c = nextafter(b, 2), d = nextafter(c, 2);
    gno_shadow_interval s[] = {shadow(b, c, 0)};
    const expected want[] = {{a, b, 1}, {b, c, 0}, {c, d, 1}};
    check(a, d, s, 1, want, 3);
    gno_shadow_interval whole[] = {shadow(a, b, 0)};
    const expected dark[] = {{a, b, 0}};
    check(a, b, whole, 1, dark, 1);
}

static void test_unbounded_casters(void **state)
{
    (void)state;
    gno_shadow_interval s[] = {shadow(6, INFINITY, 0), shadow(-INFINITY, 4, 0)};
    const expected want[] = {{2, 4, 0}, {4, 6, 1}, {6, 10, 0}};
    check(2, 10, s, 2, want, 3);
}

static void test_unsorted(void **state)
{
    (void)state;
    gno_shadow_interval s[] = {shadow(8, 9, 0), shadow(1, 2, 0), shadow(6, 7, 0), shadow(3, 5, 0), shadow(0, 1, 0), shadow(2, 2.5, 0)};
    const expected want[] = {{0, 2.5, 0}, {2.5, 3, 1}, {3, 5, 0}, {5, 6, 1}, {6, 7, 0}, {7, 8, 1}, {8, 9, 0}, {9, 10, 1}};
    check(0, 10, s, LEN(s), want, LEN(want));
}

/* Recursion to the end: every caster cuts twice, so that all 2 count + 1 parts are used. */
static void test_many(void **state)
{
    (void)state;
    gno_shadow_interval s[MOST];
    expected want[2 * MOST + 1];
    for (size_t i = 0; i < MOST; i++) {
        double x = 3.0 * (double)i;
        s[(i * 37) % MOST] = shadow(x + 1, x + 2, 0); /* 37 and 64 have no common factor: a shuffle */
        want[2 * i] = (expected){i ? x - 1 : 0, x + 1, 1};
        want[2 * i + 1] = (expected){x + 1, x + 2, 0};
    }
    want[2 * MOST] = (expected){3.0 * MOST - 1, 3.0 * MOST, 1};
    check(0, 3.0 * MOST, s, MOST, want, 2 * MOST + 1);
}

/* Casters nested like onion skins: light falls and rises by one factor at every end. */
static void test_nested(void **state)
{
    (void)state;
    enum { SKINS = 20 };
    gno_shadow_interval s[SKINS];
    expected want[2 * SKINS + 1];
    for (int i = 0; i < SKINS; i++) s[i] = shadow(i + 1, 2 * SKINS - i, 0.5);
    for (int i = 0; i <= 2 * SKINS; i++) {
        int over = i <= SKINS ? i : 2 * SKINS - i;
        want[i] = (expected){i, i + 1, ldexp(1, -over)};
    }
    check(0, 2 * SKINS + 1, s, SKINS, want, 2 * SKINS + 1);
}

/* ---- the twin ----------------------------------------------------------------------------------------------------- */

static uint32_t random_bits(uint64_t *seed)
{
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(*seed >> 33);
}

/* Over [x,x+1), by trying every caster. */
static void light_over(int x, const gno_shadow_interval *s, size_t count, double light[3])
{
    light[0] = light[1] = light[2] = 1;
    for (size_t i = 0; i < count; i++) {
        if (!(s[i].x0 <= x && x + 1 <= s[i].x1)) continue;
        for (int c = 0; c < 3; c++) light[c] *= s[i].transmission[c];
    }
}

static void twin_case(uint64_t *seed)
{
    /* powers of two multiply exactly in any order, so the comparison can be for equality */
    static const double shares[] = {0, 0, 0, 0.5, 0.25, 1};
    gno_shadow_interval s[12], sorted[12];
    gno_span_part parts[26];
    size_t count = random_bits(seed) % 13;
    int glass = random_bits(seed) % 3 != 0, range = random_bits(seed) % 2 ? 8 : 24;
    int x0 = (int)(random_bits(seed) % 8) + 4, x1 = x0 + (int)(random_bits(seed) % (unsigned)range);
    for (size_t i = 0; i < count; i++) {
        s[i].x0 = (int)(random_bits(seed) % (unsigned)(range + 8));
        s[i].x1 = s[i].x0 + (int)(random_bits(seed) % 9) - 1;
        for (int c = 0; c < 3; c++) s[i].transmission[c] = glass ? shares[random_bits(seed) % 6] : 0;
        if (random_bits(seed) % 2) s[i].transmission[1] = s[i].transmission[2] = s[i].transmission[0];
    }
    memcpy(sorted, s, sizeof s);
    size_t n = gno_span_split(x0, x1, sorted, count, parts);
    if (x1 <= x0) {
        assert_int_equal(n, 0);
        return;
    }
    assert_true(n >= 1 && n <= 2 * count + 1);
    assert_true(parts[0].x0 == x0 && parts[n - 1].x1 == x1);
    for (size_t i = 0; i < n; i++) {
        assert_true(parts[i].x0 < parts[i].x1);
        if (i) {
            assert_true(parts[i].x0 == parts[i - 1].x1);
            assert_memory_not_equal(parts[i].light, parts[i - 1].light, sizeof parts[i].light);
        }
        for (int x = (int)parts[i].x0; x < (int)parts[i].x1; x++) {
            double want[3];
            light_over(x, s, count, want);
            for (int c = 0; c < 3; c++) assert_true(parts[i].light[c] == want[c]);
        }
    }
}

static void test_twin(void **state)
{
    (void)state;
    uint64_t seed = 20240611;
    for (int i = 0; i < 20000; i++) twin_case(&seed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_none),
        cmocka_unit_test(test_miss),
        cmocka_unit_test(test_touch_from_outside),
        cmocka_unit_test(test_cover),
        cmocka_unit_test(test_partly),
        cmocka_unit_test(test_several_overlapping),
        cmocka_unit_test(test_touching_casters),
        cmocka_unit_test(test_touching_glass),
        cmocka_unit_test(test_glass_multiplies),
        cmocka_unit_test(test_opaque_over_glass),
        cmocka_unit_test(test_alike_parts_merge),
        cmocka_unit_test(test_channels),
        cmocka_unit_test(test_zero_length),
        cmocka_unit_test(test_empty_span),
        cmocka_unit_test(test_neighbouring_doubles),
        cmocka_unit_test(test_unbounded_casters),
        cmocka_unit_test(test_unsorted),
        cmocka_unit_test(test_many),
        cmocka_unit_test(test_nested),
        cmocka_unit_test(test_twin),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
