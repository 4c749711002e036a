/* sieve.h -- eight pairs of a caster and a receiver at a time, in single precision: which casters surely shade, which surely do not.
 *
 * Place in the data flow: packets that a walk has found (packet.h) -> this -> what stays open goes to overlap.h, one by one.
 * The planes of overlap.h, tested with bounds that outweigh the rounding of single precision, in the frame of the casters' packet.
 * Invariant: gnoi_overlap_test would say of a sure one GNOI_OVERLAP_PART; one that is ruled out throws no shadow, or one that reaches over an
 * edge by less than the receiver's tolerance. All machines give the same verdicts.
 */
#ifndef GNOI_SHADOW_SIEVE_H
#define GNOI_SHADOW_SIEVE_H

#include "shadow/overlap.h"
#include "shadow/packet.h"

#define GNOI_SIEVE_PLANES (1 + GNOI_FACET_CORNERS)

/* Up to eight receivers side by side, relative to an origin near them: the plane of each, the planes through the light and its edges (n.p + c,
 * positive above and inside), and its corners. One with fewer corners than others has its last edge and corner several times. */
typedef struct gnoi_sieve {
    int corner_count;      /* the most; as many edges */
    unsigned char convex;  /* bit k: the corners are the receiver's, not a rectangle's around it */
    float extent;          /* largest component of all corners */
    float tolerance[GNOI_EIGHT];
    float plane[GNOI_SIEVE_PLANES][4][GNOI_EIGHT]; /* nx, ny, nz, c */
    float corner[GNOI_FACET_CORNERS][3][GNOI_EIGHT];
} gnoi_sieve;

void gnoi_sieve_clear(gnoi_sieve *sieve);

/* Once for each receiver. */
void gnoi_sieve_add(gnoi_sieve *sieve, unsigned k, const gnoi_shaded *receiver, vec3 origin);

/* How receivers and light lie to a packet of casters. */
typedef struct gnoi_sieve_place {
    float shift[3]; /* from the packet's origin to the receivers' */
    float light[3]; /* the light relative to the packet's origin, or the way to it */
    float at_point; /* 1: the light is at a point, 0: directional */
    float light_reach; /* bounds the components of the way from a caster's corner to the light */
    float reach;    /* bounds all coordinates of casters and receivers */
} gnoi_sieve_place;

void gnoi_sieve_place_set(gnoi_sieve_place *place, const gnoi_packet *packet, const gnoi_lamp *lamp, vec3 origin, float extent);

/* Boxes first: bit 8 caster + receiver is set where the caster's box meets the receiver's and does not begin behind it. */
uint64_t gnoi_sieve_meet(const gnoi_eight *casters, const gnoi_eight *receivers);

typedef struct gnoi_verdicts {
    unsigned maybe, sure; /* sure: part of maybe */
} gnoi_verdicts;

/* pairs: byte k is pair k, eight times the number of its caster and that of its receiver within theirs. Bits of the verdicts are pairs; only
 * those of `mask` are asked about. */
gnoi_verdicts gnoi_sieve_test(const gnoi_sieve *receivers, const gnoi_packet *packet, const gnoi_sieve_place *place, uint64_t pairs, unsigned mask);

#endif
