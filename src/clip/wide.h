/* wide.h -- products of grid coordinates without rounding: 128-bit integers, the compiler's own or two halves.
 *
 * Place: clip; knows nothing. Grid coordinates have at most 52 bits and a sign, so a cross product of two differences has at most 107
 * and fits. GNOI_WIDE_HALVES forces the portable form (the tests hold both against each other).
 */
#ifndef GNOI_CLIP_WIDE_H
#define GNOI_CLIP_WIDE_H

#include <stdint.h>

#if defined(__SIZEOF_INT128__) && !defined(GNOI_WIDE_HALVES)

__extension__ typedef __int128 gnoi_wide;
__extension__ typedef unsigned __int128 gnoi_uwide;

/* ax by - ay bx */
static inline gnoi_wide gnoi_wide_cross(int64_t ax, int64_t ay, int64_t bx, int64_t by)
{
    return (gnoi_wide)ax * by - (gnoi_wide)ay * bx;
}

static inline int gnoi_wide_sign(gnoi_wide a)
{
    return (a > 0) - (a < 0);
}

static inline gnoi_wide gnoi_wide_negate(gnoi_wide a)
{
    return -a;
}

/* 1 if |a| < 2^62, and then *value is a. */
static inline int gnoi_wide_small(gnoi_wide a, int64_t *value)
{
    *value = (int64_t)(uint64_t)(gnoi_uwide)a;
    return a > -((gnoi_wide)1 << 62) && a < (gnoi_wide)1 << 62;
}

/* a within two units of 2^-53 of itself; |a| < 2^116. Two signed halves convert without a branch that no processor can foresee. */
static inline double gnoi_wide_double(gnoi_wide a)
{
    int64_t small;
    if (gnoi_wide_small(a, &small))
        return (double)small;
    return (double)(int64_t)(a >> 64) * 18446744073709551616.0 + (double)(int64_t)((uint64_t)(gnoi_uwide)a >> 1) * 2.0;
}

/* a m - b n, which must fit; the products need not. */
static inline gnoi_wide gnoi_wide_combine(gnoi_wide a, int64_t m, gnoi_wide b, int64_t n)
{
    return (gnoi_wide)((gnoi_uwide)a * (gnoi_uwide)(gnoi_wide)m - (gnoi_uwide)b * (gnoi_uwide)(gnoi_wide)n);
}

#else

/* hi 2^64 + lo, two's complement */
typedef struct gnoi_wide {
    uint64_t hi, lo;
} gnoi_wide;

/* Product modulo 2^128 of two unsigned numbers of 64 bits, by halves. */
static inline gnoi_wide gnoi_halves_product(uint64_t a, uint64_t b)
{
    uint64_t a0 = a & 0xffffffffu, a1 = a >> 32, b0 = b & 0xffffffffu, b1 = b >> 32;
    uint64_t low = a0 * b0, mid = a1 * b0 + (low >> 32), mid2 = a0 * b1 + (mid & 0xffffffffu);
    gnoi_wide p;
    p.hi = a1 * b1 + (mid >> 32) + (mid2 >> 32);
    p.lo = mid2 << 32 | (low & 0xffffffffu);
    return p;
}

static inline gnoi_wide gnoi_halves_minus(gnoi_wide a, gnoi_wide b)
{
    gnoi_wide d;
    d.lo = a.lo - b.lo;
    d.hi = a.hi - b.hi - (a.lo < b.lo);
    return d;
}

static inline gnoi_wide gnoi_halves_signed(int64_t a, int64_t b)
{
    gnoi_wide p = gnoi_halves_product((uint64_t)a, (uint64_t)b);
    p.hi -= (a < 0 ? (uint64_t)b : 0) + (b < 0 ? (uint64_t)a : 0);
    return p;
}

static inline gnoi_wide gnoi_wide_cross(int64_t ax, int64_t ay, int64_t bx, int64_t by)
{
    return gnoi_halves_minus(gnoi_halves_signed(ax, by), gnoi_halves_signed(ay, bx));
}

static inline int gnoi_wide_sign(gnoi_wide a)
{
    return a.hi >> 63 ? -1 : (a.hi | a.lo) != 0;
}

static inline gnoi_wide gnoi_wide_negate(gnoi_wide a)
{
    gnoi_wide zero = {0, 0};
    return gnoi_halves_minus(zero, a);
}

static inline int gnoi_wide_small(gnoi_wide a, int64_t *value)
{
    *value = (int64_t)a.lo;
    return (a.hi == 0 && a.lo < (uint64_t)1 << 62) || (a.hi == UINT64_MAX && a.lo > UINT64_MAX - (((uint64_t)1 << 62) - 1));
}

static inline double gnoi_wide_double(gnoi_wide a)
{
    gnoi_wide m = a.hi >> 63 ? gnoi_wide_negate(a) : a;
    double value = (double)m.hi * 18446744073709551616.0 + (double)m.lo;
    return a.hi >> 63 ? -value : value;
}

static inline gnoi_wide gnoi_halves_scaled(gnoi_wide a, int64_t m)
{
    gnoi_wide p = gnoi_halves_product(a.lo, (uint64_t)m);
    p.hi += a.hi * (uint64_t)m - (m < 0 ? a.lo : 0);
    return p;
}

static inline gnoi_wide gnoi_wide_combine(gnoi_wide a, int64_t m, gnoi_wide b, int64_t n)
{
    return gnoi_halves_minus(gnoi_halves_scaled(a, m), gnoi_halves_scaled(b, n));
}

#endif

/* Sign of the turn from a to b: +1 counter-clockwise, 0 along one line, -1 clockwise. */
static inline int gnoi_wide_turn(int64_t ax, int64_t ay, int64_t bx, int64_t by)
{
    return gnoi_wide_sign(gnoi_wide_cross(ax, ay, bx, by));
}

/* gnoi_wide_share where doubles do not decide: a quotient in doubles is a few units off at most, and the remainder, taken modulo
 * 2^128, puts it right. */
static inline int64_t gnoi_wide_share_exact(int64_t length, gnoi_wide num, gnoi_wide den, double ratio)
{
    int64_t size = length < 0 ? -length : length, q = (int64_t)((double)size * ratio);
    gnoi_wide rest = gnoi_wide_combine(num, size, den, q);
    int half;
    while (gnoi_wide_sign(rest) < 0) {
        q--;
        rest = gnoi_wide_combine(rest, 1, den, -1);
    }
    while (gnoi_wide_sign(gnoi_wide_combine(rest, 1, den, 1)) >= 0) {
        q++;
        rest = gnoi_wide_combine(rest, 1, den, 1);
    }
    half = gnoi_wide_sign(gnoi_wide_combine(rest, 2, den, 1));
    return length < 0 ? -(q + (half > 0)) : q + (half >= 0);
}

/* The integer nearest to length * num / den, halves upwards (towards +infinity), exactly. 0 < num < den, both below 2^107;
 * |length| < 2^53; ratio is the quotient of num and den as doubles: with the roundings of both, of the division and of the product here it
 * is off by less than seven units of 2^-53, so that most products lie safely on one side of a half. */
static inline int64_t gnoi_wide_share(int64_t length, gnoi_wide num, gnoi_wide den, double ratio)
{
    double size = (double)(length < 0 ? -length : length) * ratio, error = size * (8.0 / 9007199254740992.0);
    int64_t q = (int64_t)size;
    double past = size - (double)q; /* exact */
    if (past + error < 0.5)
        return length < 0 ? -q : q;
    if (past - error > 0.5)
        return length < 0 ? -q - 1 : q + 1;
    return gnoi_wide_share_exact(length, num, den, ratio);
}

#endif
