/* srgb.c -- tables for srgb.h. */
#include "io/srgb.h"

#include <math.h>
#include <string.h>

/* Levels lie closest where the curve is straight: 1 / (12.92 * top). A power of two makes linear * buckets exact. */
enum { BUCKETS_8 = 4096, BUCKETS_16 = 1048576 };

static double linear_of(double encoded)
{
    return encoded <= 0.04045 ? encoded / 12.92 : pow((encoded + 0.055) / 1.055, 2.4);
}

int gnoi_srgb_create(gno_context *context, int depth, gnoi_srgb *srgb)
{
    memset(srgb, 0, sizeof *srgb);
    srgb->context = context;
    srgb->top = depth == 16 ? 65535 : 255;
    srgb->buckets = depth == 16 ? BUCKETS_16 : BUCKETS_8;
    srgb->begin = gno_context_realloc(context, NULL, 0, ((size_t)srgb->top + 1) * sizeof *srgb->begin);
    srgb->start = gno_context_realloc(context, NULL, 0, (size_t)srgb->buckets * sizeof *srgb->start);
    if (srgb->begin == NULL || srgb->start == NULL) {
        gnoi_srgb_destroy(srgb);
        return 0;
    }
    int bucket = 0;
    for (int level = 0; level < srgb->top; level++) {
        srgb->begin[level] = linear_of((level + 0.5) / srgb->top);
        for (; bucket < srgb->buckets && bucket < srgb->begin[level] * srgb->buckets; bucket++) {
            srgb->start[bucket] = (uint16_t)level;
        }
    }
    srgb->begin[srgb->top] = HUGE_VAL;
    for (; bucket < srgb->buckets; bucket++) {
        srgb->start[bucket] = (uint16_t)srgb->top;
    }
    return 1;
}

void gnoi_srgb_destroy(gnoi_srgb *srgb)
{
    if (srgb->begin != NULL) {
        gno_context_realloc(srgb->context, srgb->begin, ((size_t)srgb->top + 1) * sizeof *srgb->begin, 0);
    }
    if (srgb->start != NULL) {
        gno_context_realloc(srgb->context, srgb->start, (size_t)srgb->buckets * sizeof *srgb->start, 0);
    }
    srgb->begin = NULL;
    srgb->start = NULL;
}
