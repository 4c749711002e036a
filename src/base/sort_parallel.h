/* sort_parallel.h -- the sort of sort.h for many pairs, on several threads. Place: base. */
#ifndef GNOI_BASE_SORT_PARALLEL_H
#define GNOI_BASE_SORT_PARALLEL_H

#include "base/context.h"
#include "base/sort.h"

/* Sorts pairs[0..count) by key, equal keys in their given order, whatever the number of threads; keys are below 2^bits, and scratch
 * holds as many pairs. Returns where the result is, pairs or scratch; NULL when memory fails or the context is told to stop, with a
 * message that names the stage. */
gnoi_keyed *gnoi_sort_parallel(gno_context *context, int threads, const char *stage, gnoi_keyed *pairs, gnoi_keyed *scratch,
                               size_t count, unsigned bits);

#endif
