/* sort.c -- least significant digit radix sort: see sort.h. Short lists are sorted by insertion. */
#include "base/sort.h"
#include <string.h>

#define SHORT_LIST 48
#define DIGIT_BITS 11
#define DIGITS (1u << DIGIT_BITS)

static void insertion_sort(gnoi_keyed *pairs, size_t count)
{
    for (size_t i = 1; i < count; i++) {
        gnoi_keyed p = pairs[i];
        size_t j = i;
        for (; j > 0 && pairs[j - 1].key > p.key; j--)
            pairs[j] = pairs[j - 1];
        pairs[j] = p;
    }
}

/* One pass over a digit; returns 0 when all keys share it and nothing was moved. */
static int scatter_digit(const gnoi_keyed *from, gnoi_keyed *to, size_t count, unsigned shift, unsigned bits)
{
    size_t start[DIGITS];
    uint32_t mask = (1u << bits) - 1;
    size_t sum = 0;
    memset(start, 0, sizeof(size_t) << bits);
    for (size_t i = 0; i < count; i++)
        start[from[i].key >> shift & mask]++;
    if (start[from[0].key >> shift & mask] == count)
        return 0;
    for (size_t d = 0; d <= mask; d++) {
        size_t n = start[d];
        start[d] = sum;
        sum += n;
    }
    for (size_t i = 0; i < count; i++)
        to[start[from[i].key >> shift & mask]++] = from[i];
    return 1;
}

/* context NULL: nobody is asked. */
static int sort(gno_context *context, gnoi_keyed *pairs, gnoi_keyed *scratch, size_t count)
{
    gnoi_keyed *from = pairs, *to = scratch;
    unsigned bits = count < 4096 ? 8 : DIGIT_BITS;
    if (count < SHORT_LIST) {
        insertion_sort(pairs, count);
        return 1;
    }
    for (unsigned shift = 0; shift < 32; shift += bits) {
        if (context && gnoi_stopped(context))
            return 0;
        if (scatter_digit(from, to, count, shift, shift + bits > 32 ? 32 - shift : bits)) {
            gnoi_keyed *swap = from;
            from = to;
            to = swap;
        }
    }
    if (from != pairs)
        memcpy(pairs, from, count * sizeof *pairs);
    return 1;
}

void gnoi_sort(gnoi_keyed *pairs, gnoi_keyed *scratch, size_t count) { (void)sort(NULL, pairs, scratch, count); }

int gnoi_sort_asking(gno_context *context, gnoi_keyed *pairs, gnoi_keyed *scratch, size_t count)
{
    return sort(context, pairs, scratch, count);
}
