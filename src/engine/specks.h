/* specks.h -- what small surfaces cover of the pixels of a row: one speck for each surface and pixel.
 *
 * Place in the data flow: visible pieces of a row, line after line (tile_rows.c) -> specks -> samples (tile_speck.c). A small surface lies in one
 * or two pixels of a row and has a piece or two there; a row of cells for each of them (gnoi_cells) would cost more than it holds.
 * Invariants: each slot's specks of the row at hand are linked from its brief; numbers below `first` are of rows done with.
 */
#ifndef GNOI_ENGINE_SPECKS_H
#define GNOI_ENGINE_SPECKS_H

#include "scan/lines.h"

#define GNOI_SPECKS 512 /* at once; more of a row make it two */
#define GNOI_SPECK_STEP 16 /* taken at once by vector code */
#define GNOI_BASE_LINES 4  /* at most, where refinement is to judge by them */

/* What is asked of a slot piece by piece, apart from all else so that many lie near at hand. */
typedef struct gnoi_brief {
    uint32_t chain;         /* first visible piece in the row at hand, 0: none */
    uint32_t speck;         /* the latest, 0: none */
    unsigned char lit;      /* its columns are known */
    unsigned char speckled; /* it is small, and has a facet */
} gnoi_brief;

typedef struct gnoi_specks {
    uint32_t first, count;
    int lines; /* base lines kept apart, those being made: 0 while others are */
    uint32_t slot[GNOI_SPECKS + GNOI_SPECK_STEP], next[GNOI_SPECKS];
    int32_t pixel[GNOI_SPECKS + GNOI_SPECK_STEP];
    float length[GNOI_SPECKS + GNOI_SPECK_STEP], mx[GNOI_SPECKS + GNOI_SPECK_STEP], my[GNOI_SPECKS + GNOI_SPECK_STEP]; /* as in gnoi_cells */
    float by_line[GNOI_BASE_LINES][GNOI_SPECKS + GNOI_SPECK_STEP];
} gnoi_specks;

/* The speck of a slot in a pixel, new where there is none; there is room for one. */
static inline uint32_t gnoi_specks_seek(gnoi_specks *s, gnoi_brief *brief, uint32_t slot, int32_t pixel)
{
    uint32_t i;
    for (uint32_t id = brief->speck; id >= s->first; id = s->next[i]) {
        i = id - s->first;
        if (s->pixel[i] == pixel)
            return i;
    }
    i = s->count++;
    s->slot[i] = slot;
    s->pixel[i] = pixel;
    s->next[i] = brief->speck;
    s->length[i] = s->mx[i] = s->my[i] = 0;
    for (int l = 0; l < s->lines; l++)
        s->by_line[l][i] = 0;
    brief->speck = s->first + i;
    return i;
}

/* Adds what a piece covers of one pixel, from a to b in line units from the pixel's left side; dy from the row's middle; line: the base
 * line, -1 another. */
static inline void gnoi_speck_add(gnoi_specks *s, uint32_t i, int32_t a, int32_t b, float dy, int line)
{
    float fa = (float)a / GNOI_X_ONE, fb = (float)b / GNOI_X_ONE, length = fb - fa;
    s->length[i] += length;
    s->mx[i] += length * (0.5f * (fa + fb) - 0.5f);
    s->my[i] += length * dy;
    if (line >= 0)
        s->by_line[line][i] += length;
}

/* Forgets all specks, which are done with; so many there were. */
static inline void gnoi_specks_clear(gnoi_specks *s, uint32_t count)
{
    s->first += count;
    s->count = 0;
}

#endif
