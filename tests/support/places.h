/* places.h -- which places of a program have been tried already: a place is the nearest ten calls that led there. For tests that let each
 * allocation fail and would try the same few places thousands of times.
 */
#ifndef SUPPORT_PLACES_H
#define SUPPORT_PLACES_H

#include <stddef.h>
#include <stdint.h>

enum { PLACES_MOST = 1 << 15 };

/* All zero: none. */
typedef struct places {
    size_t count;
    struct {
        uint64_t place;
        unsigned tried;
    } slot[PLACES_MOST];
} places;

/* The place of the caller, the same number in every run of a program. 0 where stacks cannot be read. */
uint64_t place_here(void);

/* Counts a visit and returns how many there were before; 0 for place 0, and for new places when the table is full. */
unsigned places_visit(places *p, uint64_t place);

#endif
