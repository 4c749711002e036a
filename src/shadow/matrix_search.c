/* matrix_search.c -- columns of the shadow matrix, a packet of eight receivers at a time.
 *
 *   packet of receivers -> own shadow?  -> box around the rest -> packets that may stand before it
 *                                                                 -> for each receiver: eight casters at a time
 *                                                                    -> surely / maybe -> overlap.h
 *
 * Receivers of a packet lie together and share one walk through the tree. What a walk finds is ruled out eight polygons at once, in
 * single precision relative to the packet, with slacks that outweigh its rounding; only what remains is tested one by one.
 */
#include "shadow/matrix.h"
#include "base/sort.h"
#include "base/tolerance.h"
#include "base/vector.h"
#include "shadow/lamp.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

/* Rounding of a distance computed in single precision from coordinates relative to a packet, as a share of its extent: three
 * products and sums of numbers each rounded to 2^-24, with a margin of two. */
#define PACKET_SLACK 1e-6f

/* ---- search ------------------------------------------------------------------------------------------------------- */

gno_status gnoi_search_make(const gno_scene *scene, const gnoi_lamp *lamp, int threads, gnoi_search *search)
{
    const gnoi_prepared *prep = &scene->prepared;
    gno_status status;
    memset(search, 0, sizeof *search);
    search->scene = scene;
    search->lamp = *lamp;
    search->outside = gnoi_calloc(scene->context, prep->solid_count, 1);
    if (!search->outside)
        return GNO_ERROR_MEMORY;
    for (size_t i = 0; i < prep->solid_count; i++)
        if (prep->solids[i].closed)
            search->outside[i] = (unsigned char)gnoi_lamp_outside(scene, i, lamp);
    status = gnoi_facets_build(scene, &search->facets);
    if (!status)
        status = gnoi_packets_build(scene, lamp, threads, &search->packets);
    if (status)
        gnoi_search_free(search);
    return status;
}

void gnoi_search_free(gnoi_search *search)
{
    gno_context *context = search->scene->context;
    gnoi_packets_free(context, &search->packets);
    gnoi_facets_free(context, &search->facets);
    gnoi_free(context, search->outside, search->scene->prepared.solid_count, 1);
    search->outside = NULL;
}

void gnoi_findings_free(gnoi_findings *f)
{
    gnoi_free(f->context, f->columns, f->column_capacity, sizeof *f->columns);
    gnoi_free(f->context, f->casters, f->caster_capacity, sizeof *f->casters);
    gnoi_free(f->context, f->list.items, f->list.capacity, sizeof *f->list.items);
    f->columns = NULL;
    f->casters = NULL;
    f->list.items = NULL;
    f->column_count = f->column_capacity = f->caster_count = f->caster_capacity = f->list.count = f->list.capacity = 0;
}

static int add_caster(gnoi_findings *f, uint32_t source)
{
    if (f->caster_count == f->caster_capacity &&
        !gnoi_reserve(f->context, (void **)&f->casters, &f->caster_capacity, f->caster_count + 1, sizeof *f->casters))
        return 0;
    f->casters[f->caster_count++] = source;
    return 1;
}

/* Ends the column that began at `first` in the list of casters. */
static int add_column(gnoi_findings *f, uint32_t poly, size_t first, gno_shade shade)
{
    if (!gnoi_reserve(f->context, (void **)&f->columns, &f->column_capacity, f->column_count + 1, sizeof *f->columns))
        return 0;
    f->columns[f->column_count].poly = poly;
    f->columns[f->column_count].count = (uint32_t)(f->caster_count - first);
    f->columns[f->column_count++].shade = shade;
    return 1;
}

/* ---- own shadow --------------------------------------------------------------------------------------------------- */

enum { OWN = 1, SEARCH = 2 };

/* Whether the polygon's diagonal is a one, and whether casters are to be looked for: see gnomon_matrix.h. */
static int judge_own_shadow(const gnoi_search *search, const gnoi_poly *poly)
{
    const gnoi_prepared *prep = &search->scene->prepared;
    double side = gnoi_lamp_side(&search->lamp, poly->n, poly->d), far = 1;
    uint32_t solid = gnoi_solid_of(prep, poly);
    if (!search->lamp.directional)
        far = v3_length(v3_sub(search->lamp.position, v3_from(prep->positions[prep->corner_vertex[poly->corner]])));
    if (fabs(side) <= GNOI_PARALLEL * far)
        return OWN;
    if (search->outside[solid])
        return (side > 0) == (prep->solids[solid].outwards != 0) ? SEARCH : OWN;
    return side > 0 ? SEARCH : poly->two_sided ? OWN | SEARCH : OWN;
}

/* ---- eight casters at a time --------------------------------------------------------------------------------------- */

typedef struct verdicts {
    unsigned maybe, sure;
} verdicts;

/* Distances of one of the four points of all eight polygons from a plane: a linear form relative to the packet. */
static void distances(const gnoi_packet *p, int corner, const float n[3], float c, float out[GNOI_PACKET])
{
    for (int k = 0; k < GNOI_PACKET; k++)
        out[k] = n[0] * p->x[corner][k] + n[1] * p->y[corner][k] + n[2] * p->z[corner][k] + c;
}

static float plane_at_origin(const gnoi_packet *p, vec3 normal, double constant, float n[3])
{
    n[0] = (float)normal.x;
    n[1] = (float)normal.y;
    n[2] = (float)normal.z;
    return (float)(v3_dot(normal, v3_from(p->origin)) + constant);
}

static int none_left(const int32_t alive[GNOI_PACKET])
{
    int32_t some = 0;
    for (int k = 0; k < GNOI_PACKET; k++)
        some |= alive[k];
    return !some;
}

/* maybe: not all points lie outside one edge's plane, and one lies above the receiver's plane. sure: one of a polygon's own corners lies
 * above it and within all edges: the light's path to the point below is blocked there. Only the entries of `mask` are asked about. */
VECTOR_CLONES static verdicts test_packet(const gnoi_packet *p, const gnoi_shaded *r, unsigned mask)
{
    float slack = PACKET_SLACK * p->extent, n[3], c, d[GNOI_PACKET];
    float low = (float)r->tolerance - slack, high = (float)r->tolerance + 2 * slack;
    int32_t inside[GNOI_PACKET_CORNERS][GNOI_PACKET], alive[GNOI_PACKET], wanted[GNOI_PACKET];
    verdicts v = {0, 0};
    c = plane_at_origin(p, r->height.a, r->height.b, n);
    for (int k = 0; k < GNOI_PACKET; k++) {
        wanted[k] = (int32_t)(mask >> k & 1);
        alive[k] = 0;
    }
    for (int i = 0; i < GNOI_PACKET_CORNERS; i++) {
        distances(p, i, n, c, d);
        for (int k = 0; k < GNOI_PACKET; k++) {
            alive[k] |= d[k] > low;
            inside[i][k] = d[k] > high;
        }
    }
    for (int k = 0; k < GNOI_PACKET; k++)
        alive[k] &= wanted[k];
    for (int e = 0; e < r->edge_count; e++) {
        int32_t some_in[GNOI_PACKET] = {0};
        if (none_left(alive))
            return v;
        c = plane_at_origin(p, r->edge[e], -v3_dot(r->edge[e], r->facet.corner[e]), n);
        for (int i = 0; i < GNOI_PACKET_CORNERS; i++) {
            distances(p, i, n, c, d);
            for (int k = 0; k < GNOI_PACKET; k++) {
                some_in[k] |= d[k] > slack;
                inside[i][k] &= d[k] > 2 * slack;
            }
        }
        for (int k = 0; k < GNOI_PACKET; k++)
            alive[k] &= some_in[k];
    }
    for (int k = 0; k < GNOI_PACKET; k++) {
        v.maybe |= (unsigned)(alive[k] != 0) << k;
        v.sure |= (unsigned)((inside[0][k] | inside[1][k] | inside[2][k] | inside[3][k]) != 0) << k;
    }
    v.sure &= r->convex ? p->exact : 0u;
    return v;
}

/* ---- columns ------------------------------------------------------------------------------------------------------ */

/* Looks through the packets on the list for casters of one receiver. Returns 0 when memory fails or the call shall stop. */
static int search_list(const gnoi_search *search, const gnoi_shaded *r, uint32_t poly, const gnoi_lbox *box, gnoi_findings *f, gno_shade *shade)
{
    const gnoi_prepared *prep = &search->scene->prepared;
    for (size_t i = 0; i < f->list.count; i++) {
        const gnoi_packet *packet = &search->packets.packets[f->list.items[i]];
        unsigned mask = gnoi_eight_meet(&search->packets.nodes[f->list.items[i]], box) & packet->casts;
        verdicts v;
        if (gnoi_stopped_at(f->context, i))
            return 0;
        if (!mask)
            continue;
        v = test_packet(packet, r, mask);
        for (mask = v.maybe; mask; mask &= mask - 1) {
            unsigned k = gnoi_lowest_bit(mask);
            uint32_t other = packet->poly[k];
            const gnoi_poly *caster = &prep->polys[other];
            gnoi_overlap how;
            if (other == poly)
                continue;
            how = v.sure >> k & 1 ? GNOI_OVERLAP_PART : gnoi_overlap_test(r, caster);
            if (how == GNOI_OVERLAP_NONE)
                continue;
            if (!add_caster(f, caster->source))
                return 0;
            if (how == GNOI_OVERLAP_ALL && caster->opaque)
                *shade = GNO_SHADE_COVERED;
            else if (*shade == GNO_SHADE_NONE)
                *shade = GNO_SHADE_PART;
        }
    }
    return 1;
}

static int search_receiver(const gnoi_search *search, uint32_t index, int own, const gnoi_lbox *box, gnoi_findings *f)
{
    const gnoi_poly *poly = &search->scene->prepared.polys[index];
    gno_shade shade = GNO_SHADE_NONE;
    size_t first = f->caster_count;
    gnoi_shaded r;
    if (own & SEARCH) {
        gnoi_shaded_set(&r, search->scene, &search->lamp, &search->facets, poly);
        if (!search_list(search, &r, index, box, f, &shade))
            return 0;
    }
    if (own & OWN) {
        shade = own & SEARCH ? shade : GNO_SHADE_OWN;
        if (!add_caster(f, poly->source))
            return 0;
    }
    return add_column(f, index, first, shade);
}

static gnoi_lbox box_at(const gnoi_eight *boxes, unsigned k)
{
    gnoi_lbox box;
    box.u0 = boxes->u0[k];
    box.u1 = boxes->u1[k];
    box.v0 = boxes->v0[k];
    box.v1 = boxes->v1[k];
    box.z0 = boxes->z0[k];
    box.z1 = boxes->z1[k];
    return box;
}

static void add_box(gnoi_lbox *all, const gnoi_lbox *box)
{
    all->u0 = box->u0 < all->u0 ? box->u0 : all->u0;
    all->u1 = box->u1 > all->u1 ? box->u1 : all->u1;
    all->v0 = box->v0 < all->v0 ? box->v0 : all->v0;
    all->v1 = box->v1 > all->v1 ? box->v1 : all->v1;
    all->z0 = box->z0 < all->z0 ? box->z0 : all->z0;
    all->z1 = box->z1 > all->z1 ? box->z1 : all->z1;
}

int gnoi_search_packet(const gnoi_search *search, size_t index, gnoi_findings *f)
{
    const gnoi_packet *packet = &search->packets.packets[index];
    gnoi_lbox all = {FLT_MAX, -FLT_MAX, FLT_MAX, -FLT_MAX, FLT_MAX, -FLT_MAX}, box[GNOI_PACKET];
    int own[GNOI_PACKET], some = 0;
    for (unsigned k = 0; k < GNOI_PACKET; k++) {
        own[k] = packet->poly[k] == GNOI_NONE ? 0 : judge_own_shadow(search, &search->scene->prepared.polys[packet->poly[k]]);
        if (!(own[k] & SEARCH))
            continue;
        box[k] = box_at(&search->packets.nodes[index], k);
        add_box(&all, &box[k]);
        some = 1;
    }
    f->list.count = 0;
    if (some && !gnoi_packets_find(f->context, &search->packets, &all, &f->list))
        return 0;
    for (unsigned k = 0; k < GNOI_PACKET; k++)
        if (own[k] && !search_receiver(search, packet->poly[k], own[k], &box[k], f))
            return 0;
    return 1;
}

int gnoi_search_poly(const gnoi_search *search, uint32_t index, gnoi_findings *f)
{
    const gnoi_poly *poly = &search->scene->prepared.polys[index];
    int own = judge_own_shadow(search, poly), exact, n;
    vec3 points[GNOI_PACKET_CORNERS];
    gnoi_lbox boxes[6];
    n = gnoi_poly_points(search->scene, poly, points, &exact);
    n = gnoi_frame_boxes(&search->packets.frame, points, n, boxes);
    n = n > 0 ? n : gnoi_frame_everywhere(boxes);
    for (int i = 0; i < n; i++) {
        f->list.count = 0;
        if ((own & SEARCH && !gnoi_packets_find(f->context, &search->packets, &boxes[i], &f->list)) ||
            !search_receiver(search, index, own, &boxes[i], f))
            return 0;
    }
    return 1;
}

/* ---- putting columns together ---------------------------------------------------------------------------------------- */

static int compare_numbers(const void *a, const void *b)
{
    uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

#define SHORT_COLUMN 24
#define LONG_COLUMN 4096

/* By digits; returns 0 when there is no memory for it. */
static int sort_long_column(gno_context *context, uint32_t *casters, size_t count)
{
    gnoi_keyed *pairs = gnoi_malloc(context, 2 * count, sizeof *pairs);
    if (!pairs)
        return 0;
    for (size_t i = 0; i < count; i++)
        pairs[i].key = pairs[i].value = casters[i];
    gnoi_sort(pairs, pairs + count, count);
    for (size_t i = 0; i < count; i++)
        casters[i] = pairs[i].key;
    gnoi_free(context, pairs, 2 * count, sizeof *pairs);
    return 1;
}

size_t gnoi_sort_casters(gno_context *context, uint32_t *casters, size_t count)
{
    size_t n = 0;
    if (count <= SHORT_COLUMN) {
        for (size_t i = 1; i < count; i++) {
            uint32_t c = casters[i];
            size_t j = i;
            for (; j > 0 && casters[j - 1] > c; j--)
                casters[j] = casters[j - 1];
            casters[j] = c;
        }
    } else if (count < LONG_COLUMN || !sort_long_column(context, casters, count)) {
        qsort(casters, count, sizeof *casters, compare_numbers);
    }
    for (size_t i = 0; i < count; i++)
        if (n == 0 || casters[i] != casters[n - 1])
            casters[n++] = casters[i];
    return n;
}

gno_shade gnoi_shade_join(gno_shade a, gno_shade b, int same)
{
    if (a == b)
        return a;
    if (same && (a == GNO_SHADE_COVERED || b == GNO_SHADE_COVERED))
        return GNO_SHADE_COVERED;
    if (same && a == GNO_SHADE_OWN)
        return b == GNO_SHADE_NONE ? a : b;
    return same && b == GNO_SHADE_OWN ? a : GNO_SHADE_PART;
}
