/* sieve.c -- see sieve.h.
 *
 *   casters -> the receiver's planes: all below it, or outside of an edge? a corner above it and within all edges?
 *           -> the casters' planes: the receiver all before it, or outside of an edge? or apart by no plane at all?
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

static void set_plane(gnoi_sieve *s, int i, vec3 n, double at_origin)
{
    s->nx[i] = (float)n.x;
    s->ny[i] = (float)n.y;
    s->nz[i] = (float)n.z;
    s->c[i] = (float)at_origin;
}

static float larger(float a, float b) { return a > b ? a : b; }

void gnoi_sieve_set(gnoi_sieve *s, const gnoi_shaded *r, vec3 origin)
{
    s->corner_count = r->facet.count;
    s->convex = r->convex;
    s->tolerance = (float)r->tolerance;
    s->extent = 0;
    set_plane(s, 0, r->height.a, v3_dot(r->height.a, origin) + r->height.b);
    for (int i = 0; i < r->facet.count; i++) {
        vec3 q = v3_sub(r->facet.corner[i], origin);
        set_plane(s, 1 + i, r->edge[i], -v3_dot(r->edge[i], q));
        s->x[i] = (float)q.x;
        s->y[i] = (float)q.y;
        s->z[i] = (float)q.z;
        s->extent = larger(s->extent, larger(fabsf(s->x[i]), larger(fabsf(s->y[i]), fabsf(s->z[i]))));
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

/* Points or directions. */
typedef struct eight3 {
    eight x, y, z;
} eight3;

INLINE void load(const float *from, eight3 *to)
{
    memcpy(&to->x, from, sizeof to->x);
    memcpy(&to->y, from + GNOI_PACKET, sizeof to->y);
    memcpy(&to->z, from + 2 * GNOI_PACKET, sizeof to->z);
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

/* ---- the receiver's planes ------------------------------------------------------------------------------------------ */

typedef struct first {
    unsigned alive;       /* not ruled out */
    unsigned within;      /* a corner surely above the plane and within all edges */
    unsigned overlapping; /* surely apart by no plane of the receiver */
    unsigned above;       /* all of it surely above the receiver's plane */
} first;

/* count: of corners; a constant where this is called, so that the loops unroll. */
INLINE first first_test(const gnoi_sieve *r, const gnoi_packet *p, const gnoi_sieve_place *at, unsigned mask, int count)
{
    const float slack = PLANE_BOUND * at->reach, high = r->tolerance + 2 * slack, low = r->tolerance - slack;
    const float outside = low < slack ? low : slack; /* an edge is reached over by less than the tolerance */
    const flags none = {0};
    flags inner[GNOI_PACKET_CORNERS], alive = ~none, overlapping = ~none, above = none, within = none;
    first v = {0, 0, 0, 0};
    for (int i = 0; i < count; i++)
        inner[i] = ~none;
    for (int e = 0; e <= r->corner_count; e++) {
        const float nx = r->nx[e], ny = r->ny[e], nz = r->nz[e];
        const float c = r->c[e] - (nx * at->shift[0] + ny * at->shift[1] + nz * at->shift[2]);
        const float touching = (e == 0 ? low : outside) - c, deep = (e == 0 ? high : 2 * slack) - c;
        flags some = none, some_deep = none, all_deep = ~none;
        for (int i = 0; i < count; i++) {
            eight3 q;
            eight d;
            flags in;
            load(p->corner + 3 * GNOI_PACKET * i, &q);
            d = nx * q.x + ny * q.y + nz * q.z;
            in = d > deep;
            some |= d > touching;
            some_deep |= in;
            all_deep &= in;
            inner[i] &= in;
        }
        alive &= some;
        v.alive = bits_of(&alive) & mask;
        if (!v.alive)
            return v;
        overlapping &= some_deep;
        above = e == 0 ? all_deep : above;
    }
    for (int i = 0; i < count; i++)
        within |= inner[i];
    v.within = bits_of(&within);
    v.overlapping = bits_of(&overlapping);
    v.above = bits_of(&above);
    return v;
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

/* n.p for the receiver's corner j. */
INLINE void product_at(const eight3 *n, const gnoi_sieve *r, const gnoi_sieve_place *at, int j, eight *out)
{
    const float x = r->x[j] + at->shift[0], y = r->y[j] + at->shift[1], z = r->z[j] + at->shift[2];
    *out = n->x * x + n->y * y + n->z * z;
}

/* Planes of the casters themselves; facing: all bits of the sign where the light is behind the winding's normal. */
INLINE void facing_test(const gnoi_sieve *r, const gnoi_packet *p, const gnoi_sieve_place *at, flags *facing, second *s)
{
    const float e2 = p->extent * p->extent, unsure = FACING_BOUND * e2 * at->light_reach, bound = NORMAL_BOUND * e2 * at->reach;
    const flags none = {0}, sign = none + INT32_MIN;
    eight3 a, b, c, e, f, n, way;
    eight side, size, level, deep, shallow;
    load(p->corner, &a);
    load(p->corner + 3 * GNOI_PACKET, &b);
    load(p->corner + 6 * GNOI_PACKET, &c);
    minus(&b, &a, &e);
    minus(&c, &a, &f);
    cross(&e, &f, &n);
    way_to_light(at, &a, &way);
    dot(&n, &way, &side);
    *facing = (flags)side & sign;
    s->certain = (side > unsure) | (side < -unsure);
    size_of(&n, &size);
    dot(&n, &a, &level);
    level = (eight)((flags)level ^ *facing);
    deep = level - (r->tolerance * size + bound);
    shallow = level - (0.57f * r->tolerance * size - bound);
    s->behind = none;
    s->all_behind = s->apart = ~none;
    for (int j = 0; j < r->corner_count; j++) {
        eight t;
        flags below;
        product_at(&n, r, at, j, &t);
        t = (eight)((flags)t ^ *facing);
        below = t < deep;
        s->behind |= below;
        s->all_behind &= below;
        s->apart &= t > shallow;
    }
    s->overlapping = ~none;
    s->uncovered = none;
}

INLINE void edge_test(const gnoi_sieve *r, const gnoi_packet *p, const gnoi_sieve_place *at, const flags *facing, int i, int next, second *s)
{
    const float bound = EDGE_BOUND * at->light_reach * p->extent * at->reach;
    const flags none = {0};
    eight3 a, b, e, n, way;
    eight size, level, outside, low, high;
    flags no_edge, all_out = ~none, some_in = none;
    load(p->corner + 3 * GNOI_PACKET * i, &a);
    load(p->corner + 3 * GNOI_PACKET * next, &b);
    minus(&b, &a, &e);
    no_edge = (a.x == b.x) & (a.y == b.y) & (a.z == b.z);
    way_to_light(at, &a, &way);
    cross(&way, &e, &n);
    n.x = (eight)((flags)n.x ^ *facing);
    n.y = (eight)((flags)n.y ^ *facing);
    n.z = (eight)((flags)n.z ^ *facing);
    dot(&n, &a, &level);
    size_of(&n, &size);
    outside = level + (0.57f * r->tolerance * size - bound);
    low = level - bound;
    high = level + bound;
    for (int j = 0; j < r->corner_count; j++) {
        eight t;
        product_at(&n, r, at, j, &t);
        all_out &= (t <= outside) & (t <= high);
        some_in |= t > high;
        s->uncovered |= t < low;
    }
    s->apart |= all_out & ~no_edge;
    s->overlapping &= some_in | no_edge;
}

/* ---- both --------------------------------------------------------------------------------------------------------- */

INLINE gnoi_verdicts test_all(const gnoi_sieve *r, const gnoi_packet *p, const gnoi_sieve_place *at, unsigned mask, int count)
{
    first one = first_test(r, p, at, mask, count);
    gnoi_verdicts v;
    flags facing, apart, sure;
    second two;
    v.maybe = one.alive;
    v.sure = one.alive & one.within & (r->convex ? p->exact : 0u);
    if (v.maybe == v.sure)
        return v;
    facing_test(r, p, at, &facing, &two);
    for (int i = 0; i < count; i++)
        edge_test(r, p, at, &facing, i, i + 1 < count ? i + 1 : 0, &two);
    apart = two.apart & two.certain;
    sure = two.certain & two.overlapping & two.behind & two.uncovered;
    v.maybe &= v.sure | ~bits_of(&apart);
    if (r->convex)
        v.sure |= v.maybe & p->exact & one.overlapping & bits_of(&sure) & (one.above | bits_of(&two.all_behind));
    return v;
}

VECTOR_CLONES static gnoi_verdicts test(const gnoi_sieve *r, const gnoi_packet *p, const gnoi_sieve_place *at, unsigned mask)
{
    switch (p->corner_count) {
    case 3: return test_all(r, p, at, mask, 3);
    case 4: return test_all(r, p, at, mask, 4);
    default: return test_all(r, p, at, mask, (int)p->corner_count);
    }
}

/* Apart from the one above, whose versions would be seen from outside of the library. */
gnoi_verdicts gnoi_sieve_test(const gnoi_sieve *r, const gnoi_packet *p, const gnoi_sieve_place *at, unsigned mask) { return test(r, p, at, mask); }

#else /* nothing is ruled out, nothing settled */

gnoi_verdicts gnoi_sieve_test(const gnoi_sieve *r, const gnoi_packet *p, const gnoi_sieve_place *at, unsigned mask)
{
    gnoi_verdicts v;
    (void)r;
    (void)p;
    (void)at;
    v.maybe = mask;
    v.sure = 0;
    return v;
}

#endif
