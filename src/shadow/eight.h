/* eight.h -- eight boxes on a light's plane side by side, so that one test runs over all of them: the nodes of tree.h and packet.h.
 *
 * Place in the data flow: boxes of polygons (frame.h) -> nodes (this) -> trees.
 * Invariant: a place without a box holds an empty one, which no box meets.
 */
#ifndef GNOI_SHADOW_EIGHT_H
#define GNOI_SHADOW_EIGHT_H

#include "base/bits.h"
#include "base/fetch.h"
#include "shadow/frame.h"
#include <float.h>
#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#define GNOI_EIGHT 8

typedef struct gnoi_eight {
    float u0[GNOI_EIGHT], u1[GNOI_EIGHT], v0[GNOI_EIGHT], v1[GNOI_EIGHT];
    float z0[GNOI_EIGHT], z1[GNOI_EIGHT]; /* nearest and farthest depth from the light */
} gnoi_eight;

/* Asks for it before it is needed. */
static inline void gnoi_eight_fetch(const gnoi_eight *node)
{
    FETCH(node->u0);
    FETCH(node->v0);
    FETCH(node->z0);
}

static inline void gnoi_eight_clear(gnoi_eight *node)
{
    for (int k = 0; k < GNOI_EIGHT; k++) {
        node->u0[k] = node->v0[k] = node->z0[k] = FLT_MAX;
        node->u1[k] = node->v1[k] = node->z1[k] = -FLT_MAX;
    }
}

static inline void gnoi_eight_set(gnoi_eight *node, size_t k, const gnoi_lbox *box)
{
    node->u0[k] = box->u0;
    node->u1[k] = box->u1;
    node->v0[k] = box->v0;
    node->v1[k] = box->v1;
    node->z0[k] = box->z0;
    node->z1[k] = box->z1;
}

/* Entry k grows so that it holds the box too. */
static inline void gnoi_eight_grow(gnoi_eight *node, size_t k, const gnoi_lbox *box)
{
    node->u0[k] = box->u0 < node->u0[k] ? box->u0 : node->u0[k];
    node->u1[k] = box->u1 > node->u1[k] ? box->u1 : node->u1[k];
    node->v0[k] = box->v0 < node->v0[k] ? box->v0 : node->v0[k];
    node->v1[k] = box->v1 > node->v1[k] ? box->v1 : node->v1[k];
    node->z0[k] = box->z0 < node->z0[k] ? box->z0 : node->z0[k];
    node->z1[k] = box->z1 > node->z1[k] ? box->z1 : node->z1[k];
}

/* The box that holds all of them. */
static inline gnoi_lbox gnoi_eight_union(const gnoi_eight *node)
{
    gnoi_lbox all = {FLT_MAX, -FLT_MAX, FLT_MAX, -FLT_MAX, FLT_MAX, -FLT_MAX};
    for (int i = 0; i < GNOI_EIGHT; i++) {
        all.u0 = node->u0[i] < all.u0 ? node->u0[i] : all.u0;
        all.u1 = node->u1[i] > all.u1 ? node->u1[i] : all.u1;
        all.v0 = node->v0[i] < all.v0 ? node->v0[i] : all.v0;
        all.v1 = node->v1[i] > all.v1 ? node->v1[i] : all.v1;
        all.z0 = node->z0[i] < all.z0 ? node->z0[i] : all.z0;
        all.z1 = node->z1[i] > all.z1 ? node->z1[i] : all.z1;
    }
    return all;
}

/* Bit k: entry k's box meets `box` and does not begin behind its farthest depth. */
static inline unsigned gnoi_eight_meet(const gnoi_eight *node, const gnoi_lbox *q)
{
    unsigned mask = 0;
#if defined(__SSE2__)
    __m128 u0 = _mm_set1_ps(q->u0), u1 = _mm_set1_ps(q->u1), w0 = _mm_set1_ps(q->v0), w1 = _mm_set1_ps(q->v1);
    __m128 z1 = _mm_set1_ps(q->z1);
    for (int k = 0; k < GNOI_EIGHT; k += 4) {
        __m128 u = _mm_and_ps(_mm_cmple_ps(_mm_loadu_ps(node->u0 + k), u1), _mm_cmpge_ps(_mm_loadu_ps(node->u1 + k), u0));
        __m128 w = _mm_and_ps(_mm_cmple_ps(_mm_loadu_ps(node->v0 + k), w1), _mm_cmpge_ps(_mm_loadu_ps(node->v1 + k), w0));
        __m128 z = _mm_cmple_ps(_mm_loadu_ps(node->z0 + k), z1);
        mask |= (unsigned)_mm_movemask_ps(_mm_and_ps(_mm_and_ps(u, w), z)) << k;
    }
#else
    for (int k = 0; k < GNOI_EIGHT; k++)
        mask |= (unsigned)(node->u0[k] <= q->u1 && node->u1[k] >= q->u0 && node->v0[k] <= q->v1 && node->v1[k] >= q->v0 &&
                           node->z0[k] <= q->z1) << k;
#endif
    return mask;
}

/* Bit k: lane[k] is -1, not 0. */
static inline unsigned gnoi_eight_bits(const int32_t lane[GNOI_EIGHT])
{
    unsigned bits = 0;
#if defined(__SSE2__)
    bits = (unsigned)_mm_movemask_ps(_mm_castsi128_ps(_mm_loadu_si128((const __m128i *)(const void *)lane))) |
           (unsigned)_mm_movemask_ps(_mm_castsi128_ps(_mm_loadu_si128((const __m128i *)(const void *)(lane + 4)))) << 4;
#else
    for (int k = 0; k < GNOI_EIGHT; k++)
        bits |= (unsigned)(lane[k] & 1) << k;
#endif
    return bits;
}

#endif
