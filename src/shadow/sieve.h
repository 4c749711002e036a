/* sieve.h -- eight casters at a time against one receiver, in single precision: which surely shade it, which surely do not.
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

/* A receiver relative to an origin near it: its plane and the planes through the light and its edges (n.p + c, positive above and inside),
 * and its corners. */
typedef struct gnoi_sieve {
    int corner_count; /* as many edges */
    int convex;       /* the corners are the receiver's, not a rectangle's around it */
    float tolerance, extent; /* extent: largest component of a corner */
    float nx[GNOI_SIEVE_PLANES], ny[GNOI_SIEVE_PLANES], nz[GNOI_SIEVE_PLANES], c[GNOI_SIEVE_PLANES];
    float x[GNOI_FACET_CORNERS], y[GNOI_FACET_CORNERS], z[GNOI_FACET_CORNERS];
} gnoi_sieve;

void gnoi_sieve_set(gnoi_sieve *sieve, const gnoi_shaded *receiver, vec3 origin);

/* How receivers and light lie to a packet of casters. */
typedef struct gnoi_sieve_place {
    float shift[3]; /* from the packet's origin to the receivers' */
    float light[3]; /* the light relative to the packet's origin, or the way to it */
    float at_point; /* 1: the light is at a point, 0: directional */
    float light_reach; /* bounds the components of the way from a caster's corner to the light */
    float reach;    /* bounds all coordinates of casters and receivers */
} gnoi_sieve_place;

/* extent: the greatest of the receivers'. */
void gnoi_sieve_place_set(gnoi_sieve_place *place, const gnoi_packet *packet, const gnoi_lamp *lamp, vec3 origin, float extent);

typedef struct gnoi_verdicts {
    unsigned maybe, sure; /* sure: part of maybe */
} gnoi_verdicts;

/* Only the casters of `mask` are asked about. */
gnoi_verdicts gnoi_sieve_test(const gnoi_sieve *receiver, const gnoi_packet *packet, const gnoi_sieve_place *place, unsigned mask);

#endif
