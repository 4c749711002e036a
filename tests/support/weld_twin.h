/* weld_twin.h -- which vertices lie at one place, by sorting them all. Place: tests. */
#ifndef TESTS_SUPPORT_WELD_TWIN_H
#define TESTS_SUPPORT_WELD_TWIN_H

#include <stddef.h>
#include <stdint.h>

/* An array whose element v is the first vertex at v's place; NULL without memory. The caller frees it. */
uint32_t *weld_twin(const double (*positions)[3], size_t count);

#endif
