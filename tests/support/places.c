/* places.c -- see places.h. */
#define _GNU_SOURCE
#include "support/places.h"

#ifdef __GLIBC__
#include <dlfcn.h>
#include <execinfo.h>

enum { DEEP = 10 }; /* the nearest calls: what lies behind them is the same code */

/* Programs and libraries lie elsewhere in each run: what counts is how far into them a call returns. */
uint64_t place_here(void)
{
    void *frame[DEEP];
    const int count = backtrace(frame, DEEP);
    uint64_t place = 1469598103934665603u;
    for (int i = 1; i < count; i++) {
        Dl_info info;
        const uintptr_t at = (uintptr_t)frame[i], base = dladdr(frame[i], &info) != 0 ? (uintptr_t)info.dli_fbase : at;
        place = (place ^ (at - base)) * 1099511628211u;
    }
    return place != 0 ? place : 1;
}
#else
uint64_t place_here(void) { return 0; }
#endif

unsigned places_visit(places *p, uint64_t place)
{
    size_t k = (size_t)(place % PLACES_MOST);
    if (place == 0)
        return 0;
    while (p->slot[k].tried > 0 && p->slot[k].place != place)
        k = (k + 1) % PLACES_MOST;
    if (p->slot[k].tried > 0)
        return p->slot[k].tried++;
    if (p->count + 1 < PLACES_MOST) {
        p->slot[k].place = place;
        p->slot[k].tried = 1;
        p->count++;
    }
    return 0;
}
