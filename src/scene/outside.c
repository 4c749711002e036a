/* outside.c -- whether a point is outside of a closed part of a scene.
 *
 * Place in the data flow: solid.c says which parts are closed -> here -> the shadow passes, which leave half the casters of a closed part away
 * while eye and lamp are outside of it.
 * The winding number of a closed part at a point is the sum of signed crossings along any path from far away
 * (Jacobson, Kavan and Sorkine-Hornung, "Robust inside-outside segmentation", 2013, section 2).
 */
#include "scene/prepare.h"

/* Signed crossing of the half line from `point` along the z axis with a polygon, in a frame turned so that the line meets no
 * edge of axis-aligned models: +1, -1, 0, or 2 where an edge comes too near to tell. */
static int crossing(const gnoi_prepared *prep, const gnoi_poly *poly, vec3 point, vec3 u, vec3 v, vec3 along)
{
    uint32_t n = poly->corner_count;
    vec3 at = v3_sub(v3_from(prep->positions[prep->corner_vertex[poly->corner + n - 1]]), point);
    double x0 = v3_dot(at, u), y0 = v3_dot(at, v), facing = v3_dot(v3_from(poly->n), along);
    int inside = 0;
    for (uint32_t i = 0; i < n; i++) {
        vec3 q = v3_sub(v3_from(prep->positions[prep->corner_vertex[poly->corner + i]]), point);
        double x1 = v3_dot(q, u), y1 = v3_dot(q, v);
        if ((y0 > 0) != (y1 > 0)) {
            double cross = x0 * y1 - x1 * y0;
            if (fabs(cross) <= 1e-9 * (fabs(x0 * y1) + fabs(x1 * y0)))
                return 2;
            inside ^= (cross > 0) == (y1 > y0);
        }
        x0 = x1;
        y0 = y1;
    }
    if (!inside)
        return 0;
    at = v3_sub(v3_from(prep->positions[prep->corner_vertex[poly->corner]]), point);
    if (v3_dot(v3_from(poly->n), at) * facing < 0)
        return 0; /* behind the point */
    return facing > 0 ? 1 : -1;
}

int gnoi_solid_outside(const gno_scene *scene, size_t solid, vec3 point)
{
    const gnoi_prepared *prep = &scene->prepared;
    const gnoi_solid *s = &prep->solids[solid];
    vec3 along = v3_unit(v3(0.2718, 0.3141, 0.9102)), u = v3_unit(v3_cross(along, v3(0.577, -0.214, 0.33))), v = v3_cross(along, u);
    int sum = 0;
    if (s->cap != GNOI_NONE && !gnoi_cap_inside(scene, solid, point))
        return 0;
    if (point.x < s->lower[0] || point.y < s->lower[1] || point.z < s->lower[2] || point.x > s->upper[0] || point.y > s->upper[1] ||
        point.z > s->upper[2])
        return 1;
    for (size_t i = 0; i < prep->poly_count + prep->cap_count; i++) {
        const gnoi_poly *poly = &prep->polys[i];
        int c = 0;
        if (!poly->detail && gnoi_solid_of(prep, poly) == solid)
            c = crossing(prep, poly, point, u, v, along);
        if (c == 2)
            return 0;
        sum += c;
        if (gnoi_stopped_at(scene->context, i))
            return 0;
    }
    return sum == 0;
}
