/* sort.h -- stable radix sort of (key, value) pairs. Place: base; knows nothing. */
#ifndef GNOI_BASE_SORT_H
#define GNOI_BASE_SORT_H

#include <stddef.h>
#include <stdint.h>

typedef struct gnoi_keyed {
    uint32_t key, value;
} gnoi_keyed;

/* Sorts pairs[0..count) by key, equal keys in their given order; scratch holds as many. The result is in `pairs`. */
void gnoi_sort(gnoi_keyed *pairs, gnoi_keyed *scratch, size_t count);

#endif
