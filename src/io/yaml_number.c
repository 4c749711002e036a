/* yaml_number.c -- numbers as YAML 1.2's core schema writes them, in every locale. Place: under yaml_value.c.
 *
 * Short decimals, the common case, are exact: up to 15 digits fit a double, so do the powers of ten up to 22, and one
 * multiplication or division of two exact numbers rounds correctly (Clinger 1990). The rest goes to strtod, which wants the
 * locale's decimal point.
 */
#include "io/yaml_value.h"

#include <locale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Longer ones are cut: what follows some hundred digits cannot matter more than in the last bit. */
enum { MAX_NUMBER = 1024 };

typedef struct decimal {
    const char *whole, *fraction; /* digits */
    size_t whole_length, fraction_length;
    int exponent;
    int negative;
} decimal;

static size_t digits(const char *text) { return strspn(text, "0123456789"); }

/* [-+]? ( \. [0-9]+ | [0-9]+ ( \. [0-9]* )? ) ( [eE] [-+]? [0-9]+ )? */
static int split(const char *t, decimal *d)
{
    memset(d, 0, sizeof *d);
    if (*t == '-' || *t == '+') d->negative = *t++ == '-';
    d->whole = t;
    t += d->whole_length = digits(t);
    if (*t == '.') t++;
    d->fraction = t;
    t += d->fraction_length = digits(t); /* none without a point: `whole` took them all */
    if (d->whole_length + d->fraction_length == 0) return 0;
    if (*t == 'e' || *t == 'E') {
        t++;
        int minus = *t == '-';
        if (*t == '-' || *t == '+') t++;
        if (digits(t) == 0) return 0;
        for (; *t >= '0' && *t <= '9'; t++) {
            if (d->exponent < 10000) d->exponent = 10 * d->exponent + (*t - '0');
        }
        if (minus) d->exponent = -d->exponent;
    }
    return *t == 0;
}

static int exact(const decimal *d, double *number)
{
    static const double power[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                   1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    if (d->whole_length + d->fraction_length > 15) return 0;
    int scale = d->exponent - (int)d->fraction_length;
    if (scale < -22 || scale > 22) return 0;
    double value = 0;
    for (size_t i = 0; i < d->whole_length; i++) value = value * 10 + (d->whole[i] - '0');
    for (size_t i = 0; i < d->fraction_length; i++) value = value * 10 + (d->fraction[i] - '0');
    *number = scale < 0 ? value / power[-scale] : value * power[scale];
    return 1;
}

static double by_strtod(const decimal *d)
{
    char text[MAX_NUMBER + 32];
    const char *point = localeconv()->decimal_point;
    size_t whole = d->whole_length, fraction = d->fraction_length, point_length = strlen(point), n = 0;
    int exponent = d->exponent;
    if (point_length > 8) return NAN;
    if (whole > MAX_NUMBER / 2) { /* dropped whole digits count in the exponent */
        exponent += (int)(whole - MAX_NUMBER / 2 < 100000 ? whole - MAX_NUMBER / 2 : 100000);
        whole = MAX_NUMBER / 2;
        fraction = 0;
    }
    if (fraction > MAX_NUMBER / 2 - 16) fraction = MAX_NUMBER / 2 - 16;
    memcpy(text, d->whole, whole);
    n = whole;
    if (fraction > 0) {
        memcpy(text + n, point, point_length);
        n += point_length;
        memcpy(text + n, d->fraction, fraction);
        n += fraction;
    }
    text[n++] = 'e';
    if (exponent < 0) text[n++] = '-';
    unsigned size = (unsigned)(exponent < 0 ? -exponent : exponent);
    for (unsigned unit = 100000; unit > 0; unit /= 10) text[n++] = (char)('0' + size / unit % 10);
    text[n] = 0;
    return strtod(text, NULL);
}

/* 0x1f and 0o17, without sign as the core schema has them. */
static int by_base(const char *t, double *number)
{
    int base = t[0] == '0' && t[1] == 'x' ? 16 : t[0] == '0' && t[1] == 'o' ? 8 : 0;
    const char *allowed = base == 16 ? "0123456789abcdefABCDEF" : "01234567";
    if (base == 0 || !t[2] || t[2 + strspn(t + 2, allowed)]) return 0;
    *number = 0;
    for (t += 2; *t; t++) {
        int digit = *t <= '9' ? *t - '0' : (*t | 32) - 'a' + 10;
        *number = *number * base + digit;
    }
    return 1;
}

static int special(const char *t, double *number)
{
    if (!strcmp(t, ".nan") || !strcmp(t, ".NaN") || !strcmp(t, ".NAN")) {
        *number = NAN;
        return 1;
    }
    int negative = *t == '-';
    if (*t == '-' || *t == '+') t++;
    if (strcmp(t, ".inf") && strcmp(t, ".Inf") && strcmp(t, ".INF")) return 0;
    *number = negative ? -HUGE_VAL : HUGE_VAL;
    return 1;
}

int gnoi_yaml_parse_number(const char *text, double *number)
{
    decimal d;
    if (!split(text, &d)) return by_base(text, number) || special(text, number);
    if (!exact(&d, number)) *number = by_strtod(&d);
    if (d.negative) *number = -*number;
    return 1;
}
