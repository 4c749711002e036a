/* obj_parse.c -- decimal to double, correctly rounded and fast, and the words of a line.
 *
 * Place: under obj.c and mtl.c; no state, no allocation.
 *
 * A decimal number is w * 10^e with integers w and e. Three ways, each exact or rounded once to nearest even:
 *   1. w <= 2^53 and |e| <= 22: w and 10^|e| are doubles, so one multiplication or division rounds once (Clinger 1990).
 *   2. w < 2^64 and |e| <= 27: 5^|e| < 2^64, so w * 5^e fits 128 bits, and w / 5^-e has a 128 by 64 bit quotient whose
 *      remainder says on which side of a half it lies. This holds what "%.17g" writes of ordinary coordinates.
 *   3. All else: strtod on a copy "digits e exponent" without a decimal point, which no locale reads differently.
 */
#include "obj_parse.h"
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    kept_digits = 800,        /* a value halfway between two doubles has at most 767 significant digits */
    exponent_limit = 1000000, /* beyond it only the sign of the exponent matters; saturates before int overflows */
    exact_power = 22,
    wide_power = 27
};

static const double power_of_ten[exact_power + 1] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                                     1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

#ifdef __SIZEOF_INT128__
__extension__ typedef unsigned __int128 wide_uint;

static int leading_zeros(uint64_t x)
{
    return __builtin_clzll(x);
}

/* q * 2^shift rounded to nearest even, where the true value lies in [q, q+1), above q if `sticky`. q >= 2^54, and the
 * result is a normal double. */
static double round_to_double(uint64_t q, int sticky, int shift)
{
    int drop = 64 - leading_zeros(q) - 53;
    uint64_t half = (uint64_t)1 << (drop - 1);
    uint64_t rest = q & (2 * half - 1);
    uint64_t mantissa = q >> drop;
    if (rest > half || (rest == half && (sticky || (mantissa & 1)))) mantissa++;
    return ldexp((double)mantissa, shift + drop);
}

static uint64_t power_of_five(int n)
{
    uint64_t power = 1, base = 5;
    for (; n; n >>= 1, base *= base) /* the last squaring may wrap: it is not used then */
        if (n & 1) power *= base;
    return power;
}

/* w * 10^exponent for w > 0, |exponent| <= wide_power. */
static double scale_wide(uint64_t w, int exponent)
{
    uint64_t five = power_of_five(exponent < 0 ? -exponent : exponent);
    int ws = leading_zeros(w), fs = leading_zeros(five);
    w <<= ws; /* both with their top bits set: the quotient has 63 or 64 bits, the product 127 or 128 */
    five <<= fs;
    if (exponent < 0) {
        wide_uint n = (wide_uint)w << 63;
        return round_to_double((uint64_t)(n / five), n % five != 0, fs - ws - 63 + exponent);
    }
    wide_uint product = (wide_uint)w * five;
    return round_to_double((uint64_t)(product >> 64), (uint64_t)product != 0, 64 - ws - fs + exponent);
}
#endif

/* The digits of [first,last), a number's part before the exponent, without its point, and how many of them stand after
 * it; leading zeros are dropped, and digits beyond kept_digits become one non-zero digit if any of them is not zero. */
static int copy_digits(const char *first, const char *last, char *copy, int *count)
{
    int used = 0, dropped = 0, sticky = 0, after_point = 0, seen_point = 0;
    for (const char *p = first; p < last; p++) {
        if (*p == '.') {
            seen_point = 1;
            continue;
        }
        if (used < kept_digits) {
            if (used > 0 || *p != '0') copy[used++] = *p;
            if (seen_point && after_point < exponent_limit) after_point++;
        } else {
            sticky |= *p != '0';
            if (!seen_point && dropped < exponent_limit) dropped++;
        }
    }
    if (sticky) {
        copy[used++] = '1';
        dropped--; /* that digit takes the place of the first one dropped */
    }
    *count = used;
    return dropped - after_point;
}

static double slow_number(const char *first, const char *last, int exponent)
{
    char copy[kept_digits + 32];
    int used = 0;
    int scale = copy_digits(first, last, copy, &used);
    if (used == 0) return 0.0;
    snprintf(copy + used, sizeof copy - (size_t)used, "e%d", exponent + scale);
    return strtod(copy, NULL);
}

static const char *parse_exponent(const char *p, int *exponent)
{
    const char *digits = p + 1;
    int negative = *digits == '-';
    if (*digits == '-' || *digits == '+') digits++;
    if ((unsigned)(*digits - '0') > 9) return p; /* "1e" and "1em": the number ends before the e */
    int value = 0;
    for (; (unsigned)(*digits - '0') <= 9; digits++)
        if (value < exponent_limit) value = value * 10 + (*digits - '0');
    *exponent = negative ? -value : value;
    return digits;
}

static int significant_digits(const char *first, const char *last)
{
    while (first < last && (*first == '0' || *first == '.')) first++;
    ptrdiff_t count = last - first;
    if (memchr(first, '.', (size_t)count)) count--;
    return count < 1000 ? (int)count : 1000;
}

/* first..last: the digits and point; w: the digits as a number, modulo 2^64; point_digits of them after the point. */
static double assemble(const char *first, const char *last, uint64_t w, ptrdiff_t point_digits, int exponent)
{
    int trusted = last - first <= 19 || significant_digits(first, last) <= 19; /* 10^19 < 2^64 */
    if (!trusted || point_digits > 1000) return slow_number(first, last, exponent);
    if (w == 0) return 0.0;
    int scale = exponent - (int)point_digits;
    if (w <= (uint64_t)1 << 53 && scale >= -exact_power && scale <= exact_power)
        return scale < 0 ? (double)w / power_of_ten[-scale] : (double)w * power_of_ten[scale];
#ifdef __SIZEOF_INT128__
    if (scale >= -wide_power && scale <= wide_power) return scale_wide(w, scale);
#endif
    return slow_number(first, last, exponent);
}

const char *gnoi_parse_number(const char *p, double *value)
{
    const char *start = p;
    int negative = *p == '-';
    if (*p == '-' || *p == '+') p++;
    const char *first = p;
    uint64_t w = 0;
    unsigned digit;
    for (; (digit = (unsigned)(*p - '0')) <= 9; p++) w = w * 10 + digit;
    ptrdiff_t point_digits = 0;
    ptrdiff_t digits = p - first;
    if (*p == '.') {
        const char *point = ++p;
        for (; (digit = (unsigned)(*p - '0')) <= 9; p++) w = w * 10 + digit;
        point_digits = p - point;
        digits += point_digits;
    }
    if (digits == 0) return start;
    const char *last = p;
    int exponent = 0;
    if ((*p | 0x20) == 'e') p = parse_exponent(p, &exponent);
    double magnitude = assemble(first, last, w, point_digits, exponent);
    *value = negative ? -magnitude : magnitude;
    return p;
}

/* ---- words -------------------------------------------------------------------------------------------------- */

const char *gnoi_parse_blank(const char *p, size_t *line)
{
    for (;;) {
        while (gnoi_parse_is_blank(*p)) p++;
        if (*p != '\\') return p;
        const char *end = p + 1;
        if (*end == '\r') end++;
        if (*end != '\n') return p;
        p = end + 1;
        ++*line;
    }
}

const char *gnoi_parse_word(const char *p)
{
    while (*p != '\n' && !gnoi_parse_is_blank(*p)) p++;
    return p;
}

const char *gnoi_parse_line_end(const char *p)
{
    while (*p != '\n') p++;
    return p;
}

const char *gnoi_parse_text_end(const char *p)
{
    const char *end = gnoi_parse_line_end(p);
    while (end > p && gnoi_parse_is_blank(end[-1])) end--;
    return end;
}

const char *gnoi_parse_statement_end(const char *p, size_t *line)
{
    for (;; p++) {
        while (*p != '\n' && *p != '#' && *p != '\\') p++;
        if (*p != '\\') return gnoi_parse_line_end(p);
        const char *next = gnoi_parse_blank(p, line);
        if (next > p) p = next - 1; /* the next line's first character is still to be looked at */
    }
}
