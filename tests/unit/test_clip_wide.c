/* test_clip_wide.c -- wide.h in its portable form, against the compiler's 128-bit integers where there are any. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define GNOI_WIDE_HALVES
#include <clip/wide.h>

static uint64_t state = 88172645463325252u;

static int64_t random_bits(int bits)
{
    int64_t v;
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    v = (int64_t)(state >> (64 - bits));
    return state & 1 ? v : -v;
}

static void test_known(void **unused)
{
    int64_t small;
    (void)unused;
    assert_int_equal(gnoi_wide_turn(1, 0, 0, 1), 1);
    assert_int_equal(gnoi_wide_turn(0, 1, 1, 0), -1);
    assert_int_equal(gnoi_wide_turn(3, -6, -1, 2), 0);
    /* (2^51-1)^2 - 2^51 (2^51-2) = 1: 102 bits cancel to one */
    assert_int_equal(gnoi_wide_turn(((int64_t)1 << 51) - 1, (int64_t)1 << 51, ((int64_t)1 << 51) - 2, ((int64_t)1 << 51) - 1), 1);
    assert_true(gnoi_wide_small(gnoi_wide_cross(-5, 0, 0, 7), &small));
    assert_true(small == -35);
    assert_false(gnoi_wide_small(gnoi_wide_cross((int64_t)1 << 31, 0, 0, (int64_t)1 << 31), &small));
    assert_true(gnoi_wide_double(gnoi_wide_cross(-((int64_t)1 << 50), 0, 0, (int64_t)1 << 50)) == -1267650600228229401496703205376.0);
}

static int64_t share(int64_t length, int64_t num, int64_t den)
{
    gnoi_wide n = gnoi_wide_cross(num, 0, 0, 1), d = gnoi_wide_cross(den, 0, 0, 1);
    int64_t a = gnoi_wide_share(length, n, d, gnoi_wide_double(n) / gnoi_wide_double(d));
    assert_true(a == gnoi_wide_share_exact(length, n, d, gnoi_wide_double(n) / gnoi_wide_double(d)));
    return a;
}

/* Halves go up, towards +infinity, whichever way the length points. */
static void test_share(void **unused)
{
    (void)unused;
    assert_true(share(5, 1, 2) == 3);
    assert_true(share(-5, 1, 2) == -2);
    assert_true(share(7, 1, 3) == 2);
    assert_true(share(-7, 1, 3) == -2);
    assert_true(share(8, 1, 3) == 3);
    assert_true(share(-8, 1, 3) == -3);
    assert_true(share(0, 1, 3) == 0);
    assert_true(share(((int64_t)1 << 50) + 1, 1, 2) == ((int64_t)1 << 49) + 1);
    assert_true(share(-((int64_t)1 << 50) - 1, 1, 2) == -((int64_t)1 << 49));
    assert_true(share(((int64_t)1 << 52) - 1, ((int64_t)1 << 52) - 3, ((int64_t)1 << 52) - 2) == ((int64_t)1 << 52) - 2);
}

#ifdef __SIZEOF_INT128__
__extension__ typedef __int128 native;

static native to_native(gnoi_wide a)
{
    __extension__ unsigned __int128 u = (unsigned __int128)a.hi << 64 | a.lo;
    return (native)u;
}

static void test_native(void **unused)
{
    (void)unused;
    for (int i = 0; i < 200000; i++) {
        int bits = 1 + i % 52;
        int64_t ax = random_bits(bits), ay = random_bits(52), bx = random_bits(52), by = random_bits(bits), value;
        gnoi_wide halves = gnoi_wide_cross(ax, ay, bx, by);
        native whole = (native)ax * by - (native)ay * bx, limit = (native)1 << 62;
        assert_true(to_native(halves) == whole);
        assert_true(gnoi_wide_sign(halves) == (whole > 0) - (whole < 0));
        assert_true(to_native(gnoi_wide_negate(halves)) == -whole);
        assert_true(gnoi_wide_small(halves, &value) == (whole > -limit && whole < limit));
        if (whole > -limit && whole < limit)
            assert_true(value == (int64_t)whole);
        assert_true(to_native(gnoi_wide_combine(halves, 3, halves, -4)) == 7 * whole);
    }
}

static void test_share_native(void **unused)
{
    (void)unused;
    for (int i = 0; i < 200000; i++) {
        int64_t length = random_bits(1 + i % 26);
        gnoi_wide den = gnoi_wide_cross(random_bits(50), 0, 0, random_bits(1 + i % 50)), num;
        native d, n, twice;
        int64_t got;
        if (gnoi_wide_sign(den) < 0)
            den = gnoi_wide_negate(den);
        d = to_native(den);
        if (d < 2)
            continue;
        n = i % 3 == 0 ? d / 2 + (d % 2) : 1 + (native)(state % 1000) * (d - 1) / 1001; /* many exact halves */
        num.lo = (uint64_t)(unsigned long long)n;
        num.hi = (uint64_t)(n >> 64);
        got = gnoi_wide_share(length, num, den, gnoi_wide_double(num) / gnoi_wide_double(den));
        twice = 2 * (native)length * n; /* got - 1/2 <= length n / d < got + 1/2 */
        assert_true((2 * (native)got - 1) * d <= twice && twice < (2 * (native)got + 1) * d);
    }
}
#endif

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_known),
        cmocka_unit_test(test_share),
#ifdef __SIZEOF_INT128__
        cmocka_unit_test(test_native),
        cmocka_unit_test(test_share_native),
#endif
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
