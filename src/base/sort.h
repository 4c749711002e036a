/* sort.h -- stable radix sort of (key, value) pairs. Place: base. */
#ifndef GNOI_BASE_SORT_H
#define GNOI_BASE_SORT_H

#include "base/context.h"

typedef struct gnoi_keyed {
    uint32_t key, value;
} gnoi_keyed;

/* Sorts pairs[0..count) by key, equal keys in their given order; scratch holds as many. The result is in `pairs`. */
void gnoi_sort(gnoi_keyed *pairs, gnoi_keyed *scratch, size_t count);

/* The same for lists of millions, asking between digits; 0: stop, and the pairs are in any order. */
int gnoi_sort_asking(gno_context *context, gnoi_keyed *pairs, gnoi_keyed *scratch, size_t count);

#endif
