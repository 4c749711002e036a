/* sieve.c -- see sieve.h.
 *
 *   pairs -> the receiver's planes: the caster all below it, or outside of an edge? a corner above it and within all edges?
 *         -> the caster's planes: the receiver all before it, or outside of an edge? or apart by no plane at all?
 *
 * Bounds of rounding, with u = 2^-24, e = the packet's extent, r = the reach of all coordinates, w = that of the way to the light: a distance
 * from a receiver's plane is off by less than 24 u r, the product of a caster's edge, the way to the light and a corner by less than
 * 336 u w e r, and that of two edges and a corner by less than 624 u e e r. Each is the sum of the roundings of coordinates, differences
 * and products, at their worst.
 */
#include "shadow/sieve.h"
#include "base/vector.h"
#include <string.h>

#define UNIT 5.9604645e-8f
#define PLANE_BOUND (24 * UNIT)
#define EDGE_BOUND (336 * UNIT)
#define NORMAL_BOUND (624 * UNIT)
#define FACING_BOUND (312 * UNIT)

/* ---- setting up --------------------------------------------------------------------------------------------------- */

static float larger(float a, float b) { return a > b ? a : b; }

void gnoi_sieve_clear(gnoi_sieve *s)
{
    s->corner_count = 0;
    s->convex = 0;
    s->extent = 0;
    memset(s->tolerance, 0, sizeof s->tolerance);
    memset(s->plane[0], 0, sizeof s->plane[0]);
}

static void set_plane(gnoi_sieve *s, int i, unsigned k, vec3 n, double at_origin)
{
    s->plane[i][0][k] = (float)n.x;
    s->plane[i][1][k] = (float)n.y;
    s->plane[i][2][k] = (float)n.z;
    s->plane[i][3][k] = (float)at_origin;
}

/* Room for more corners: those there are get their last one once more. */
static void lengthen(gnoi_sieve *s, int corner_count)
{
    for (; s->corner_count < corner_count; s->corner_count++) {
        int i = s->corner_count;
        if (i == 0) {
            memset(s->plane[1], 0, sizeof s->plane[1]);
            memset(s->corner[0], 0, sizeof s->corner[0]);
            continue;
        }
        memcpy(s->plane[1 + i], s->plane[i], sizeof s->plane[i]);
        memcpy(s->corner[i], s->corner[i - 1], sizeof s->corner[i]);
    }
}

void gnoi_sieve_add(gnoi_sieve *s, unsigned k, const gnoi_shaded *r, vec3 origin)
{
    lengthen(s, r->facet.count);
    s->convex |= (unsigned char)((r->convex != 0) << k);
    s->tolerance[k] = (float)r->tolerance;
    set_plane(s, 0, k, r->height.a, v3_dot(r->height.a, origin) + r->height.b);
    for (int i = 0; i < s->corner_count; i++) {
        int last = i < r->facet.count ? i : r->facet.count - 1;
        vec3 q = v3_sub(r->facet.corner[last], origin);
        set_plane(s, 1 + i, k, r->edge[last], -v3_dot(r->edge[last], q));
        s->corner[i][0][k] = (float)q.x;
        s->corner[i][1][k] = (float)q.y;
        s->corner[i][2][k] = (float)q.z;
        for (int a = 0; a < 3; a++)
            s->extent = larger(s->extent, fabsf(s->corner[i][a][k]));
    }
}

void gnoi_sieve_place_set(gnoi_sieve_place *place, const gnoi_packet *packet, const gnoi_lamp *lamp, vec3 origin, float extent)
{
    vec3 from = v3_from(packet->origin), shift = v3_sub(origin, from);
    vec3 light = lamp->directional ? lamp->to_light : v3_sub(lamp->position, from);
    float away, far;
    place->shift[0] = (float)shift.x;
    place->shift[1] = (float)shift.y;
    place->shift[2] = (float)shift.z;
    place->light[0] = (float)light.x;
    place->light[1] = (float)light.y;
    place->light[2] = (float)light.z;
    place->at_point = lamp->directional ? 0 : 1;
    away = larger(fabsf(place->shift[0]), larger(fabsf(place->shift[1]), fabsf(place->shift[2])));
    far = larger(fabsf(place->light[0]), larger(fabsf(place->light[1]), fabsf(place->light[2])));
    place->reach = larger(packet->extent, away + extent);
    place->light_reach = far + place->at_point * packet->extent;
}

#if defined(__GNUC__)

/* ---- eight numbers side by side --------------------------------------------------------------------------------------- */

#define INLINE static inline __attribute__((always_inline)) /* into each version of the vectorised function */

typedef float eight __attribute__((vector_size(sizeof(float) * GNOI_PACKET)));
typedef int32_t flags __attribute__((vector_size(sizeof(int32_t) * GNOI_PACKET))); /* all bits where it holds */
typedef unsigned char bytes __attribute__((vector_size(GNOI_PACKET)));

/* Points or directions. */
typedef struct eight3 {
    eight x, y, z;
} eight3;

/* to[k] = from[which[k]]. */
INLINE void pick(const float *from, const flags *which, eight *to)
{
#if defined(__clang__)
    for (int k = 0; k < GNOI_PACKET; k++)
        (*to)[k] = from[(*which)[k]];
#else
    eight all;
    memcpy(&all, from, sizeof all);
    *to = __builtin_shuffle(all, *which);
#endif
}

INLINE void pick3(const float *from, const flags *which, eight3 *to)
{
    pick(from, which, &to->x);
    pick(from + GNOI_PACKET, which, &to->y);
    pick(from + 2 * GNOI_PACKET, which, &to->z);
}

INLINE unsigned bits_of(const flags *f)
{
    int32_t lane[GNOI_PACKET];
    memcpy(lane, f, sizeof lane);
    return gnoi_eight_bits(lane);
}

INLINE void minus(const eight3 *a, const eight3 *b, eight3 *out)
{
    out->x = a->x - b->x;
    out->y = a->y - b->y;
    out->z = a->z - b->z;
}

INLINE void cross(const eight3 *a, const eight3 *b, eight3 *out)
{
    out->x = a->y * b->z - a->z * b->y;
    out->y = a->z * b->x - a->x * b->z;
    out->z = a->x * b->y - a->y * b->x;
}

INLINE void dot(const eight3 *a, const eight3 *b, eight *out) { *out = a->x * b->x + a->y * b->y + a->z * b->z; }

/* |x| + |y| + |z|: at least the length, at most 1.74 times it. */
INLINE void size_of(const eight3 *a, eight *out)
{
    const flags keep = (flags){0} + 0x7fffffff;
    *out = (eight)((flags)a->x & keep) + (eight)((flags)a->y & keep) + (eight)((flags)a->z & keep);
}

/* ---- boxes -------------------------------------------------------------------------------------------------------- */

VECTOR_CLONES static uint64_t meet(const gnoi_eight *casters, const gnoi_eight *receivers)
{
    eight u0, u1, v0, v1, z1;
    uint64_t bits = 0;
    memcpy(&u0, receivers->u0, sizeof u0);
    memcpy(&u1, receivers->u1, sizeof u1);
    memcpy(&v0, receivers->v0, sizeof v0);
    memcpy(&v1, receivers->v1, sizeof v1);
    memcpy(&z1, receivers->z1, sizeof z1);
    for (int k = 0; k < GNOI_EIGHT; k++) {
        flags f = (u1 >= casters->u0[k]) & (u0 <= casters->u1[k]) & (v1 >= casters->v0[k]) & (v0 <= casters->v1[k]) & (z1 >= casters->z0[k]);
        bits |= (uint64_t)bits_of(&f) << 8 * k;
    }
    return bits;
}

uint64_t gnoi_sieve_meet(const gnoi_eight *casters, const gnoi_eight *receivers) { return meet(casters, receivers); }

/* Eight pairs. */
typedef struct pairs {
    const gnoi_sieve *sieve;
    const gnoi_sieve_place *at;
    float extent; /* of the casters */
    flags receiver;
    eight tolerance;
    eight3 caster[GNOI_PACKET_CORNERS];
} pairs;

/* ---- the receivers' planes ------------------------------------------------------------------------------------------ */

typedef struct first {
    flags alive;       /* not ruled out */
    flags within;      /* a corner surely above the plane and within all edges */
    flags overlapping; /* surely apart by no plane of the receiver */
    flags above;       /* all of it surely above the receiver's plane */
} first;

/* count: of the casters' corners; a constant where this is called, so that the loops unroll. Returns 0 when none of `mask` is left. */
INLINE unsigned first_test(const pairs *p, unsigned mask, int count, first *v)
{
    const float slack = PLANE_BOUND * p->at->reach, *shift = p->at->shift;
    const flags none = {0};
    const eight low = p->tolerance - slack, high = p->tolerance + 2 * slack;
    flags inner[GNOI_PACKET_CORNERS];
    unsigned left = mask;
    for (int i = 0; i < count; i++)
        inner[i] = ~none;
    v->alive = v->overlapping = ~none;
    v->above = v->within = none;
    for (int e = 0; e <= p->sieve->corner_count; e++) {
        flags some = none, some_deep = none, all_deep = ~none;
        eight3 n;
        eight c;
        pick3(p->sieve->plane[e][0], &p->receiver, &n);
        pick(p->sieve->plane[e][3], &p->receiver, &c);
        c = c - (n.x * shift[0] + n.y * shift[1] + n.z * shift[2]);
        for (int i = 0; i < count; i++) {
            eight d;
            flags in;
            dot(&n, &p->caster[i], &d);
            d += c;
            in = e == 0 ? d > high : d > 2 * slack;
            some |= e == 0 ? d > low : (d > low) | (d > slack); /* an edge is reached over by less than the tolerance */
            some_deep |= in;
            all_deep &= in;
            inner[i] &= in;
        }
        v->alive &= some;
        left = bits_of(&v->alive) & mask;
        if (!left)
            return 0;
        v->overlapping &= some_deep;
        v->above = e == 0 ? all_deep : v->above;
    }
    for (int i = 0; i < count; i++)
        v->within |= inner[i];
    return left;
}

/* ---- the casters' planes -------------------------------------------------------------------------------------------- */

typedef struct second {
    flags certain;     /* which way the caster faces */
    flags apart;       /* surely */
    flags overlapping; /* surely apart by no plane of the caster */
    flags behind, all_behind; /* some, or all, of the receiver surely is behind the caster */
    flags uncovered;   /* surely a part of the receiver is */
} second;

/* From a corner to the light. */
INLINE void way_to_light(const gnoi_sieve_place *at, const eight3 *from, eight3 *way)
{
    way->x = at->light[0] - at->at_point * from->x;
    way->y = at->light[1] - at->at_point * from->y;
    way->z = at->light[2] - at->at_point * from->z;
}

/* n.p for the receivers' corners j. */
INLINE void product_at(const eight3 *n, const pairs *p, int j, eight *out)
{
    eight3 q;
    pick3(p->sieve->corner[j][0], &p->receiver, &q);
    q.x += p->at->shift[0];
    q.y += p->at->shift[1];
    q.z += p->at->shift[2];
    dot(n, &q, out);
}

/* Planes of the casters themselves; facing: all bits of the sign where the light is behind the winding's normal. */
INLINE void facing_test(const pairs *p, flags *facing, second *s)
{
    const float e2 = p->extent * p->extent, unsure = FACING_BOUND * e2 * p->at->light_reach, bound = NORMAL_BOUND * e2 * p->at->reach;
    const flags none = {0}, sign = none + INT32_MIN;
    const eight3 *a = &p->caster[0];
    eight3 e, f, n, way;
    eight side, size, level, deep, shallow;
    minus(&p->caster[1], a, &e);
    minus(&p->caster[2], a, &f);
    cross(&e, &f, &n);
    way_to_light(p->at, a, &way);
    dot(&n, &way, &side);
    *facing = (flags)side & sign;
    s->certain = (side > unsure) | (side < -unsure);
    size_of(&n, &size);
    dot(&n, a, &level);
    level = (eight)((flags)level ^ *facing);
    deep = level - (p->tolerance * size + bound);
    shallow = level - (0.57f * p->tolerance * size - bound);
    s->behind = s->uncovered = none;
    s->all_behind = s->apart = s->overlapping = ~none;
    for (int j = 0; j < p->sieve->corner_count; j++) {
        eight t;
        flags below;
        product_at(&n, p, j, &t);
        t = (eight)((flags)t ^ *facing);
        below = t < deep;
        s->behind |= below;
        s->all_behind &= below;
        s->apart &= t > shallow;
    }
}

INLINE void edge_test(const pairs *p, const flags *facing, int i, int next, second *s)
{
    const float bound = EDGE_BOUND * p->at->light_reach * p->extent * p->at->reach;
    const flags none = {0};
    const eight3 *a = &p->caster[i], *b = &p->caster[next];
    eight3 e, n, way;
    eight size, level, outside, low, high;
    flags no_edge, all_out = ~none, some_in = none;
    minus(b, a, &e);
    no_edge = (a->x == b->x) & (a->y == b->y) & (a->z == b->z);
    way_to_light(p->at, a, &way);
    cross(&way, &e, &n);
    n.x = (eight)((flags)n.x ^ *facing);
    n.y = (eight)((flags)n.y ^ *facing);
    n.z = (eight)((flags)n.z ^ *facing);
    dot(&n, a, &level);
    size_of(&n, &size);
    outside = level + (0.57f * p->tolerance * size - bound);
    low = level - bound;
    high = level + bound;
    for (int j = 0; j < p->sieve->corner_count; j++) {
        eight t;
        product_at(&n, p, j, &t);
        all_out &= (t <= outside) & (t <= high);
        some_in |= t > high;
        s->uncovered |= t < low;
    }
    s->apart |= all_out & ~no_edge;
    s->overlapping &= some_in | no_edge;
}

/* ---- both --------------------------------------------------------------------------------------------------------- */

/* Bit k: bit which[k] of `bits`. */
INLINE void lanes_of(unsigned bits, const flags *which, flags *lanes)
{
    const flags none = {0}, one = none + 1;
    *lanes = -(((none + (int32_t)bits) >> *which) & one);
}

INLINE gnoi_verdicts test_all(const gnoi_sieve *r, const gnoi_packet *packet, const gnoi_sieve_place *at, uint64_t pair_bytes, unsigned mask, int count)
{
    gnoi_verdicts v = {0, 0};
    bytes byte;
    flags facing, apart, sure, exact, convex, number, caster;
    first one;
    second two;
    pairs p;
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    memcpy(&byte, &pair_bytes, sizeof byte);
#else
    for (int k = 0; k < GNOI_EIGHT; k++)
        byte[k] = (unsigned char)(pair_bytes >> (8 * k));
#endif
    number = __builtin_convertvector(byte, flags);
    caster = number >> 3;
    p.receiver = number & 7;
    p.sieve = r;
    p.at = at;
    p.extent = packet->extent;
    pick(r->tolerance, &p.receiver, &p.tolerance);
    for (int i = 0; i < count; i++)
        pick3(packet->corner + 3 * GNOI_PACKET * i, &caster, &p.caster[i]);
    v.maybe = first_test(&p, mask, count, &one);
    if (!v.maybe)
        return v;
    lanes_of(packet->exact, &caster, &exact);
    lanes_of(r->convex, &p.receiver, &convex);
    exact &= convex;
    sure = one.within & exact;
    v.sure = bits_of(&sure) & v.maybe;
    if (v.maybe == v.sure)
        return v;
    facing_test(&p, &facing, &two);
    for (int i = 0; i < count; i++)
        edge_test(&p, &facing, i, i + 1 < count ? i + 1 : 0, &two);
    apart = two.apart & two.certain;
    sure = two.certain & two.overlapping & two.behind & two.uncovered & exact & one.overlapping & (one.above | two.all_behind);
    v.maybe &= v.sure | ~bits_of(&apart);
    v.sure |= v.maybe & bits_of(&sure);
    return v;
}

VECTOR_CLONES static gnoi_verdicts test(const gnoi_sieve *r, const gnoi_packet *p, const gnoi_sieve_place *at, uint64_t pair_bytes, unsigned mask)
{
    switch (p->corner_count) {
    case 3: return test_all(r, p, at, pair_bytes, mask, 3);
    case 4: return test_all(r, p, at, pair_bytes, mask, 4);
    default: return test_all(r, p, at, pair_bytes, mask, (int)p->corner_count);
    }
}

/* Apart from the one above, whose versions would be seen from outside of the library. */
gnoi_verdicts gnoi_sieve_test(const gnoi_sieve *r, const gnoi_packet *p, const gnoi_sieve_place *at, uint64_t pair_bytes, unsigned mask)
{
    return test(r, p, at, pair_bytes, mask);
}

#else /* box by box; then nothing is ruled out, nothing settled */

uint64_t gnoi_sieve_meet(const gnoi_eight *casters, const gnoi_eight *receivers)
{
    uint64_t bits = 0;
    for (unsigned k = 0; k < GNOI_EIGHT; k++) {
        const float u0 = casters->u0[k], u1 = casters->u1[k], v0 = casters->v0[k], v1 = casters->v1[k], z0 = casters->z0[k];
        for (unsigned i = 0; i < GNOI_EIGHT; i++)
            if (receivers->u1[i] >= u0 && receivers->u0[i] <= u1 && receivers->v1[i] >= v0 && receivers->v0[i] <= v1 && receivers->z1[i] >= z0)
                bits |= (uint64_t)1 << (8 * k + i);
    }
    return bits;
}

gnoi_verdicts gnoi_sieve_test(const gnoi_sieve *r, const gnoi_packet *p, const gnoi_sieve_place *at, uint64_t pair_bytes, unsigned mask)
{
    gnoi_verdicts v;
    (void)r;
    (void)p;
    (void)at;
    (void)pair_bytes;
    v.maybe = mask;
    v.sure = 0;
    return v;
}

#endif
