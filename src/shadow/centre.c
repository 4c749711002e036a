/* centre.c -- see centre.h. */
#include "shadow/centre.h"
#include "base/tolerance.h"

#include <string.h>

/* Sine of the angle between a plane and the direction to the centre below which the plane is edge-on. */
#define EDGE_ON GNOI_PARALLEL

/* A part is convex when no corner rises over the plane of one of its sides by more than this share of the part's size. */
#define CONVEX_SHARE 1e-10

/* Sides beyond which a part is not tried for convexity, whose test takes sides x corners. */
#define CONVEX_SIDES 64

/* Turns smaller than this share of the edges' product are none. */
#define STRAIGHT 1e-12

gnoi_lamp gnoi_lamp_of_view(const gnoi_view *view)
{
    gnoi_lamp lamp;
    memset(&lamp, 0, sizeof lamp);
    lamp.directional = view->orthographic;
    lamp.position = view->eye;
    lamp.axis = view->forward;
    lamp.to_light = v3_scale(view->forward, -1);
    return lamp;
}

/* ---- single polygons ---------------------------------------------------------------------------------------------- */

/* All turns to the left, and once around only: the edges' direction along one axis of the plane changes sign twice. */
static int is_convex(const gno_scene *scene, const gnoi_poly *poly)
{
    vec3 n = v3_from(poly->n), first = gnoi_corner_at(scene, poly->corner), axis = v3(0, 0, 0);
    uint32_t count = poly->corner_count;
    int changes = 0, sign = 0, first_sign = 0;
    if (poly->ring_count != 1)
        return 0;
    for (uint32_t i = 0; i < count; i++) {
        vec3 a = gnoi_corner_at(scene, poly->corner + i), b = gnoi_corner_at(scene, poly->corner + (i + 1) % count);
        vec3 c = gnoi_corner_at(scene, poly->corner + (i + 2) % count), ab = v3_sub(b, a), bc = v3_sub(c, b);
        double along;
        if (v3_dot(v3_cross(ab, bc), n) < -STRAIGHT * sqrt(v3_dot(ab, ab) * v3_dot(bc, bc)))
            return 0;
        if (v3_dot(axis, axis) == 0)
            axis = v3_sub(b, first);
        along = v3_dot(ab, axis);
        if (along != 0) {
            int now = along > 0 ? 1 : -1;
            changes += sign != 0 && now != sign;
            first_sign = first_sign ? first_sign : now;
            sign = now;
        }
    }
    return changes + (sign != first_sign) <= 2;
}

static void set_stand(const gnoi_centre *centre, const gnoi_poly *poly, int see_through, gnoi_stand *s)
{
    const gno_scene *scene = centre->scene;
    const double *t = scene->materials[poly->material].transmission;
    vec3 n = v3_from(poly->n), first = gnoi_corner_at(scene, poly->corner);
    double lift = v3_dot(n, first) + poly->d, height, farthest = 1;
    if (centre->lamp.directional)
        height = v3_dot(n, centre->lamp.to_light);
    else {
        height = v3_dot(n, v3_sub(centre->lamp.position, first)) + lift;
        farthest = 0;
        for (uint32_t i = 0; i < poly->corner_count; i++) {
            double r = v3_length(v3_sub(gnoi_corner_at(scene, poly->corner + i), centre->lamp.position));
            farthest = r > farthest ? r : farthest;
        }
    }
    s->side = (signed char)(fabs(height) <= EDGE_ON * farthest ? 0 : height > 0 ? 1 : -1);
    s->height = (double)s->side * height;
    s->lift = (double)s->side * lift;
    s->tolerance = gnoi_plane_tolerance(&scene->prepared, (const double(*)[3])scene->prepared.positions, poly);
    s->convex = (unsigned char)is_convex(scene, poly);
    s->hides = (unsigned char)(s->side == 0 || poly->detail ? 0 : poly->opaque ? 1 : t[0] >= 1 && t[1] >= 1 && t[2] >= 1 ? 0 : 2);
    s->hidden = 0;
    s->absent = (unsigned char)(centre->view && s->side < 0 && !poly->two_sided);
    if (centre->view && s->side != 0)
        s->hides = !s->absent && (poly->opaque || !see_through);
}

/* ---- closed convex parts ------------------------------------------------------------------------------------------ */

static int rises_over(const gno_scene *scene, const gnoi_poly *plane, const gnoi_poly *poly, double turn, double slack)
{
    for (uint32_t i = 0; i < poly->corner_count; i++)
        if (turn * (v3_dot(v3_from(plane->n), gnoi_corner_at(scene, poly->corner + i)) + plane->d) > slack)
            return 1;
    return 0;
}

static int part_is_convex(const gno_scene *scene, const uint32_t *list, uint32_t count, const gnoi_solid *solid)
{
    double turn = solid->outwards ? 1 : -1, slack = 0;
    for (int k = 0; k < 3; k++)
        slack += CONVEX_SHARE * (solid->upper[k] - solid->lower[k]);
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t j = 0; j < count; j++)
            if (i != j && rises_over(scene, &scene->prepared.polys[list[i]], &scene->prepared.polys[list[j]], turn, slack))
                return 0;
    return 1;
}

/* An eye at infinity begins at a plane, which must not cut the part. */
static int begins_before(const gnoi_centre *centre, const gnoi_solid *s)
{
    for (int i = 0; i < 8 && centre->has_start; i++) {
        vec3 p = v3(i & 1 ? s->upper[0] : s->lower[0], i & 2 ? s->upper[1] : s->lower[1], i & 4 ? s->upper[2] : s->lower[2]);
        if (!(gnoi_form_at(&centre->start, p) > 0))
            return 0;
    }
    return 1;
}

/* The sides of a closed convex part turned away from a centre outside hide nothing that is not hidden, and are hidden. */
static void settle_part(gnoi_centre *centre, const uint32_t *list, uint32_t count, const gnoi_solid *solid)
{
    int facing = 0, turn = solid->outwards ? 1 : -1;
    for (uint32_t i = 0; i < count; i++)
        facing |= centre->stands[list[i]].side * turn > 0;
    facing &= begins_before(centre, solid);
    for (uint32_t i = 0; i < count && facing; i++) {
        gnoi_stand *s = &centre->stands[list[i]];
        if (s->side * turn < 0) {
            s->hides = 0;
            s->hidden = 1;
        }
    }
}

static int settle_parts(gnoi_centre *centre)
{
    const gno_scene *scene = centre->scene;
    const gnoi_prepared *prep = &scene->prepared;
    size_t count = prep->poly_count, parts = prep->solid_count;
    uint32_t *start = gnoi_calloc(scene->context, parts + 1, sizeof *start);
    uint32_t *list = gnoi_malloc(scene->context, count, sizeof *list);
    int done = start && list;
    for (size_t i = 0; i < count && done; i++)
        start[gnoi_solid_of(prep, &prep->polys[i])]++;
    for (size_t k = 1; k < parts && done; k++)
        start[k] += start[k - 1];
    for (size_t i = count; i-- > 0 && done;)
        list[--start[gnoi_solid_of(prep, &prep->polys[i])]] = (uint32_t)i;
    if (done && parts > 0)
        start[parts] = (uint32_t)count;
    for (size_t k = 0; k < parts && done; k++) {
        uint32_t sides = start[k + 1] - start[k];
        if (prep->solids[k].closed && sides >= 4 && sides <= CONVEX_SIDES &&
            part_is_convex(scene, list + start[k], sides, &prep->solids[k]))
            settle_part(centre, list + start[k], sides, &prep->solids[k]);
    }
    gnoi_free(scene->context, start, parts + 1, sizeof *start);
    gnoi_free(scene->context, list, count, sizeof *list);
    return done;
}

/* ---- the centre --------------------------------------------------------------------------------------------------- */

gno_status gnoi_centre_make(const gno_scene *scene, const gnoi_lamp *lamp, const gnoi_view *view, int see_through, gnoi_centre *centre)
{
    const gnoi_prepared *prep = &scene->prepared;
    gno_status status;
    memset(centre, 0, sizeof *centre);
    centre->scene = scene;
    centre->lamp = *lamp;
    centre->view = view;
    if (view && view->orthographic) {
        centre->has_start = 1;
        centre->start = view->depth;
    }
    for (int k = 0; k < 3; k++) {
        double lo = fabs(prep->lower[k]), hi = fabs(prep->upper[k]);
        centre->noise = fmax(centre->noise, GNOI_COORDINATE_NOISE * fmax(lo, hi));
    }
    centre->stands = gnoi_calloc(scene->context, prep->poly_count, sizeof *centre->stands);
    if (!centre->stands)
        return GNO_ERROR_MEMORY;
    for (size_t i = 0; i < prep->poly_count; i++)
        set_stand(centre, &prep->polys[i], see_through, &centre->stands[i]);
    status = settle_parts(centre) ? gnoi_tree_build_part(scene, lamp, view ? GNOI_TREE_SEEN : GNOI_TREE_ALL, &centre->tree) : GNO_ERROR_MEMORY;
    if (status)
        gnoi_centre_free(centre);
    return status;
}

void gnoi_centre_free(gnoi_centre *centre)
{
    if (!centre->scene)
        return;
    gnoi_tree_free(centre->scene->context, &centre->tree);
    gnoi_free(centre->scene->context, centre->stands, centre->scene->prepared.poly_count, sizeof *centre->stands);
    memset(centre, 0, sizeof *centre);
}

/* ---- pairs -------------------------------------------------------------------------------------------------------- */

static int lies_on(const gnoi_centre *centre, uint32_t a, uint32_t b, double tolerance)
{
    const gnoi_poly *poly = &centre->scene->prepared.polys[a], *on = &centre->scene->prepared.polys[b];
    for (uint32_t i = 0; i < poly->corner_count; i++)
        if (fabs(v3_dot(v3_from(on->n), gnoi_corner_at(centre->scene, poly->corner + i)) + on->d) > tolerance)
            return 0;
    return 1;
}

int gnoi_coplanar(const gnoi_centre *centre, uint32_t a, uint32_t b)
{
    double ta = centre->stands[a].tolerance, tb = centre->stands[b].tolerance, tolerance = ta < tb ? ta : tb;
    return lies_on(centre, a, b, tolerance) || lies_on(centre, b, a, tolerance);
}

int gnoi_in_front(const gno_scene *scene, uint32_t a, uint32_t b)
{
    const gnoi_poly *p = &scene->prepared.polys[a], *q = &scene->prepared.polys[b];
    if (p->priority != q->priority)
        return p->priority > q->priority;
    return p->source != q->source ? p->source < q->source : a < b;
}
