/* pages.c -- see pages.h. A page that is first touched costs some 1.5 microseconds, asked for with its neighbours some 1.1. */
#ifdef __linux__
#define _DEFAULT_SOURCE /* madvise */
#endif
#include "base/pages.h"

#include <stdint.h>
#ifdef __linux__
#include <sys/mman.h>
#endif

#define PAGE 4096      /* where pages are larger, less is asked for */
#define FEW (16 * PAGE) /* not worth a call */

void gnoi_pages_ready(void *block, size_t bytes)
{
#ifdef MADV_POPULATE_WRITE
    uintptr_t from = ((uintptr_t)block + PAGE - 1) & ~(uintptr_t)(PAGE - 1), to = ((uintptr_t)block + bytes) & ~(uintptr_t)(PAGE - 1);
    if (bytes >= FEW)
        (void)madvise((void *)from, to - from, MADV_POPULATE_WRITE); /* refused by older systems: nothing is lost */
#else
    (void)block;
    (void)bytes;
#endif
}
