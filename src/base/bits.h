/* bits.h -- single bits of words. Place: base; knows nothing. */
#ifndef GNOI_BASE_BITS_H
#define GNOI_BASE_BITS_H

#include <stdint.h>

/* The number of the lowest bit that is set; some bit is. */
static inline unsigned gnoi_lowest_bit_long(uint64_t mask)
{
#if defined(__GNUC__)
    return (unsigned)__builtin_ctzll(mask);
#else
    unsigned k = 0;
    while (!(mask >> k & 1))
        k++;
    return k;
#endif
}

static inline unsigned gnoi_lowest_bit(unsigned mask) { return gnoi_lowest_bit_long(mask); }

#endif
