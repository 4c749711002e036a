/* overlap.c -- see overlap.h.
 *
 * Convex parts are parted by separating planes through the light (an edge of either will do, as for convex polygons in a plane) or by
 * lying on the wrong sides of each other's planes. Where both planes cut the other part, the caster is clipped to the receiver's pyramid
 * (Sutherland and Hodgman) and its highest corner decides.
 */
#include "shadow/overlap.h"
#include "base/tolerance.h"
#include "scene/prepare.h"
#include "shadow/packet.h"

#include <string.h>

/* Share of the coplanarity tolerance by which parts may reach over each other's edges and still touch only. */
#define TOUCHING 1e-3

/* A pair of polygons with more pairs of parts is given a one unseen: it may be cautious. */
#define MOST_PAIRS 65536

/* A cut of a convex part adds one corner; twice the room in case that rounding makes it less than convex. */
#define CUT_CORNERS (4 * GNOI_FACET_CORNERS)

#define IS_CONVEX GNOI_NONE
#define IS_TANGLED (GNOI_NONE - 1) /* its triangles do not fill it: a rectangle stands in for it */

/* Triangles that add up to the area but for rounding. */
#define SAME_AREA 1e-9

/* ---- convex parts ------------------------------------------------------------------------------------------------ */

static double area_of(vec3 a, vec3 b, vec3 c, vec3 n)
{
    return 0.5 * v3_dot(v3_cross(v3_sub(b, a), v3_sub(c, a)), n);
}

/* Signed area of all rings: holes wound against the outer ring take away. */
static double polygon_area(const gno_scene *scene, const gnoi_poly *poly)
{
    const uint32_t *ring = scene->prepared.ring_corner + poly->ring;
    vec3 n = v3_from(poly->n), origin = gnoi_corner_at(scene, poly->corner);
    double area = 0;
    for (uint32_t r = 0; r < poly->ring_count; r++) {
        double part = 0;
        for (uint32_t i = ring[r]; i < ring[r + 1]; i++)
            part += area_of(origin, gnoi_corner_at(scene, i), gnoi_corner_at(scene, i + 1 < ring[r + 1] ? i + 1 : ring[r]), n);
        area += r == 0 ? fabs(part) : -fabs(part);
    }
    return area;
}

static int fills(const gno_scene *scene, const gnoi_poly *poly, uint32_t (*triangles)[3])
{
    double sum = 0, whole = polygon_area(scene, poly);
    for (size_t t = 0; t < gnoi_triangles_of(poly); t++)
        sum += fabs(area_of(gnoi_corner_at(scene, triangles[t][0]), gnoi_corner_at(scene, triangles[t][1]), gnoi_corner_at(scene, triangles[t][2]),
                            v3_from(poly->n)));
    return fabs(sum - whole) <= SAME_AREA * (sum + fabs(whole));
}

static gno_status triangulate(const gno_scene *scene, gnoi_facets *facets)
{
    const gnoi_prepared *prep = &scene->prepared;
    size_t at = 0;
    for (size_t i = 0; i < prep->poly_count; i++) {
        const gnoi_poly *poly = &prep->polys[i];
        gno_status status;
        if (facets->first[i] == IS_CONVEX)
            continue;
        status = gnoi_triangulate(scene->context, (const double(*)[3])prep->positions, prep->corner_vertex, prep->ring_corner + poly->ring,
                                  poly->ring_count, poly->n, facets->triangles + at);
        if (status)
            return status;
        facets->first[i] = fills(scene, poly, facets->triangles + at) ? (uint32_t)at : IS_TANGLED;
        at += gnoi_triangles_of(poly);
    }
    return GNO_OK;
}

gno_status gnoi_facets_build(const gno_scene *scene, gnoi_facets *facets)
{
    const gnoi_prepared *prep = &scene->prepared;
    gno_status status = GNO_ERROR_MEMORY;
    memset(facets, 0, sizeof *facets);
    for (size_t i = 0; i < prep->poly_count; i++) {
        if (gnoi_stopped_at(scene->context, i))
            return GNO_ERROR_MEMORY;
        if (!gnoi_poly_is_convex(scene, &prep->polys[i]))
            facets->triangle_count += gnoi_triangles_of(&prep->polys[i]);
    }
    if (facets->triangle_count == 0)
        return GNO_OK;
    facets->poly_count = prep->poly_count;
    facets->first = gnoi_malloc(scene->context, facets->poly_count, sizeof *facets->first);
    facets->triangles = gnoi_malloc(scene->context, facets->triangle_count, sizeof *facets->triangles);
    if (facets->first && facets->triangles) {
        for (size_t i = 0; i < prep->poly_count; i++)
            facets->first[i] = gnoi_poly_is_convex(scene, &prep->polys[i]) ? IS_CONVEX : 0;
        status = triangulate(scene, facets);
    }
    if (status)
        gnoi_facets_free(scene->context, facets);
    return status;
}

void gnoi_facets_free(gno_context *context, gnoi_facets *facets)
{
    gnoi_free(context, facets->first, facets->poly_count, sizeof *facets->first);
    gnoi_free(context, facets->triangles, facets->triangle_count, sizeof *facets->triangles);
    memset(facets, 0, sizeof *facets);
}

static uint32_t first_triangle(const gnoi_facets *facets, const gno_scene *scene, const gnoi_poly *poly)
{
    return facets->first ? facets->first[poly - scene->prepared.polys] : IS_CONVEX;
}

static void triangle_facet(const gno_scene *scene, const gnoi_facets *facets, size_t triangle, gnoi_facet *facet)
{
    facet->count = 3;
    for (int i = 0; i < 3; i++)
        facet->corner[i] = gnoi_corner_at(scene, facets->triangles[triangle][i]);
}

/* The polygon as one convex part: itself, or a rectangle around it. Returns 1 when it is itself. */
static int whole_facet(const gno_scene *scene, const gnoi_poly *poly, uint32_t triangles, gnoi_facet *facet)
{
    int exact;
    if (triangles == IS_CONVEX) {
        facet->count = (int)poly->corner_count;
        for (uint32_t i = 0; i < poly->corner_count; i++)
            facet->corner[i] = gnoi_corner_at(scene, poly->corner + i);
        return 1;
    }
    facet->count = gnoi_poly_points(scene, poly, facet->corner, &exact);
    return 0;
}

int gnoi_facet_get(const gnoi_facets *facets, const gno_scene *scene, const gnoi_poly *poly, size_t index, gnoi_facet *facet)
{
    uint32_t triangles = first_triangle(facets, scene, poly);
    if (index >= (triangles < IS_TANGLED ? gnoi_triangles_of(poly) : 1))
        return 0;
    if (triangles < IS_TANGLED)
        triangle_facet(scene, facets, triangles + index, facet);
    else
        whole_facet(scene, poly, triangles, facet);
    return 1;
}

/* ---- one receiver ------------------------------------------------------------------------------------------------- */

/* Planes through the light and the edges, positive inside: the normal times the third corner's side must be positive. `facing` is the
 * sign of the light's height over the plane that the corners are wound around. */
static void edge_planes(const gnoi_lamp *lamp, const gnoi_facet *facet, double facing, vec3 *edge)
{
    for (int i = 0; i < facet->count; i++) {
        vec3 a = facet->corner[i], b = facet->corner[i + 1 < facet->count ? i + 1 : 0];
        vec3 to_light = lamp->directional ? lamp->to_light : v3_sub(lamp->position, a);
        edge[i] = v3_unit(v3_scale(v3_cross(to_light, v3_sub(b, a)), facing));
    }
}

/* A triangle of a polygon with holes may be wound either way. */
static double facing_of(const gnoi_lamp *lamp, const gnoi_facet *facet, const gnoi_poly *poly)
{
    double side = gnoi_lamp_side(lamp, poly->n, poly->d) < 0 ? -1 : 1;
    vec3 turn = v3_cross(v3_sub(facet->corner[1], facet->corner[0]), v3_sub(facet->corner[2], facet->corner[0]));
    return v3_dot(turn, v3_from(poly->n)) < 0 ? -side : side;
}

static void set_facet(gnoi_shaded *r)
{
    r->edge_count = r->facet.count;
    edge_planes(r->lamp, &r->facet, facing_of(r->lamp, &r->facet, r->poly), r->edge);
}

void gnoi_shaded_set(gnoi_shaded *r, const gno_scene *scene, const gnoi_lamp *lamp, const gnoi_facets *facets, const gnoi_poly *poly)
{
    double sign = gnoi_lamp_side(lamp, poly->n, poly->d) < 0 ? -1 : 1;
    uint32_t triangles = first_triangle(facets, scene, poly);
    r->scene = scene;
    r->lamp = lamp;
    r->facets = facets;
    r->poly = poly;
    r->height.a = v3_scale(v3_from(poly->n), sign);
    r->height.b = poly->d * sign;
    r->tolerance = gnoi_plane_tolerance(&scene->prepared, (const double(*)[3])scene->prepared.positions, poly);
    r->convex = whole_facet(scene, poly, triangles, &r->facet);
    r->piece_count = triangles < IS_TANGLED ? gnoi_triangles_of(poly) : 1;
    set_facet(r);
}

/* ---- two convex parts --------------------------------------------------------------------------------------------- */

/* How points lie to the plane: all on or outside of it, all inside, or both. */
typedef struct sides {
    int all_out, all_in;
} sides;

static sides sides_of(vec3 normal, vec3 on, const gnoi_facet *facet, double slack)
{
    sides s = {1, 1};
    for (int i = 0; i < facet->count; i++) {
        double t = v3_dot(normal, v3_sub(facet->corner[i], on));
        s.all_out &= t <= slack;
        s.all_in &= t >= -slack;
    }
    return s;
}

/* The highest point over the receiver's plane of the caster's part within the receiver's pyramid; 0 when nothing is within. */
static double highest_within(const gnoi_shaded *r, const gnoi_facet *caster)
{
    vec3 ring[2][CUT_CORNERS];
    int n = caster->count, now = 0;
    double top = 0;
    memcpy(ring[0], caster->corner, (size_t)n * sizeof ring[0][0]);
    for (int e = 0; e < r->edge_count && n > 0; e++, now = !now) {
        const vec3 *in = ring[now];
        vec3 *out = ring[!now];
        int m = 0;
        for (int i = 0; i < n && m + 2 <= CUT_CORNERS; i++) {
            vec3 a = in[i], b = in[i + 1 < n ? i + 1 : 0];
            double sa = v3_dot(r->edge[e], v3_sub(a, r->facet.corner[e])), sb = v3_dot(r->edge[e], v3_sub(b, r->facet.corner[e]));
            if (sa >= 0)
                out[m++] = a;
            if ((sa > 0 && sb < 0) || (sa < 0 && sb > 0))
                out[m++] = v3_mad(a, v3_sub(b, a), sa / (sa - sb));
        }
        n = m;
    }
    for (int i = 0; i < n; i++) {
        double h = gnoi_form_at(&r->height, ring[now][i]);
        top = h > top ? h : top;
    }
    return top;
}

static gnoi_overlap test_facets(const gnoi_shaded *r, const gnoi_poly *poly, const gnoi_facet *caster)
{
    double slack = TOUCHING * r->tolerance, side = gnoi_lamp_side(r->lamp, poly->n, poly->d), sign = side < 0 ? -1 : 1;
    int some_above = 0, all_above = 1, some_behind = 0, all_behind = 1, none_before = 1, covers = 1;
    vec3 edge[GNOI_FACET_CORNERS];
    for (int i = 0; i < caster->count; i++) {
        double h = gnoi_form_at(&r->height, caster->corner[i]);
        some_above |= h > r->tolerance;
        all_above &= h > r->tolerance;
    }
    if (!some_above || side == 0)
        return GNOI_OVERLAP_NONE;
    for (int i = 0; i < r->facet.count; i++) {
        double h = sign * (v3_dot(v3_from(poly->n), r->facet.corner[i]) + poly->d);
        some_behind |= h < -r->tolerance;
        all_behind &= h < -r->tolerance;
        none_before &= h <= r->tolerance;
    }
    if (!some_behind)
        return GNOI_OVERLAP_NONE;
    for (int e = 0; e < r->edge_count; e++)
        if (sides_of(r->edge[e], r->facet.corner[e], caster, slack).all_out)
            return GNOI_OVERLAP_NONE;
    edge_planes(r->lamp, caster, facing_of(r->lamp, caster, poly), edge);
    for (int e = 0; e < caster->count; e++) {
        sides s = sides_of(edge[e], caster->corner[e], &r->facet, slack);
        if (s.all_out)
            return GNOI_OVERLAP_NONE;
        covers &= s.all_in;
    }
    if (covers && none_before)
        return GNOI_OVERLAP_ALL;
    return all_above || all_behind || highest_within(r, caster) > r->tolerance ? GNOI_OVERLAP_PART : GNOI_OVERLAP_NONE;
}

/* ---- two polygons ------------------------------------------------------------------------------------------------- */

/* One part of the receiver against all of the caster. */
static gnoi_overlap test_parts(const gnoi_shaded *r, const gnoi_poly *caster, uint32_t triangles)
{
    gnoi_facet part;
    gnoi_overlap how;
    if (triangles >= IS_TANGLED) {
        int exact = whole_facet(r->scene, caster, triangles, &part);
        how = test_facets(r, caster, &part);
        return how == GNOI_OVERLAP_ALL && !exact ? GNOI_OVERLAP_PART : how;
    }
    for (size_t t = 0; t < gnoi_triangles_of(caster); t++) {
        triangle_facet(r->scene, r->facets, triangles + t, &part);
        how = test_facets(r, caster, &part);
        if (how != GNOI_OVERLAP_NONE)
            return how;
    }
    return GNOI_OVERLAP_NONE;
}

gnoi_overlap gnoi_overlap_test(const gnoi_shaded *r, const gnoi_poly *caster)
{
    uint32_t triangles = first_triangle(r->facets, r->scene, caster);
    gnoi_facet hull;
    gnoi_overlap how;
    gnoi_shaded part;
    if (triangles >= IS_TANGLED && r->piece_count == 1)
        return test_parts(r, caster, triangles);
    /* First as a whole, by the hulls: most pairs end here. */
    whole_facet(r->scene, caster, triangles, &hull);
    how = test_facets(r, caster, &hull);
    if (how == GNOI_OVERLAP_NONE)
        return how;
    if ((triangles < IS_TANGLED ? gnoi_triangles_of(caster) : 1) > MOST_PAIRS / r->piece_count)
        return GNOI_OVERLAP_PART;
    if (r->piece_count == 1)
        return test_parts(r, caster, triangles);
    if (how == GNOI_OVERLAP_ALL && triangles == IS_CONVEX)
        return how;
    part = *r;
    for (size_t t = 0; t < r->piece_count; t++) {
        triangle_facet(r->scene, r->facets, first_triangle(r->facets, r->scene, r->poly) + t, &part.facet);
        set_facet(&part);
        if (test_parts(&part, caster, triangles) != GNOI_OVERLAP_NONE)
            return GNOI_OVERLAP_PART;
    }
    return GNOI_OVERLAP_NONE;
}
