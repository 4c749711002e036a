/* srgb.h -- linear light to sRGB whole numbers, exactly rounded.
 *
 * Place: the PNG encoder's only arithmetic. Instead of computing the curve for every value, the encoder keeps the linear
 * values at which the rounded result changes (level k begins at the inverse curve of (k - 1/2) / top) and finds the level
 * with one table look-up and at most one comparison; so the result is the rounded curve itself, not an approximation.
 */
#ifndef GNOI_IO_SRGB_H
#define GNOI_IO_SRGB_H

#include <gnomon/gnomon.h>
#include <stdint.h>

typedef struct gnoi_srgb {
    gno_context *context;
    double *begin;   /* begin[k]: the least linear value of level k+1; begin[top]: never */
    uint16_t *start; /* level at the lower end of each of the equal buckets that [0,1] is cut into */
    int top;         /* 255 or 65535 */
    int buckets;     /* so many that no bucket holds two beginnings */
} gnoi_srgb;

/* depth 8 or 16. Returns 0 when memory fails. */
int gnoi_srgb_create(gno_context *context, int depth, gnoi_srgb *srgb);
void gnoi_srgb_destroy(gnoi_srgb *srgb);

/* Values below 0 and NaN give 0, values above 1 give top. */
static inline unsigned gnoi_srgb_level(const gnoi_srgb *srgb, double linear)
{
    if (!(linear > 0.0)) {
        return 0;
    }
    if (linear >= 1.0) {
        return (unsigned)srgb->top;
    }
    const unsigned level = srgb->start[(int)(linear * srgb->buckets)];
    return level + (linear >= srgb->begin[level]);
}

#endif
