/* packet_points.c -- polygons as a few points whose hull holds them: see packet.h. */
#include "shadow/packet.h"
#include "shadow/tree.h"

/* Around once: the first edge's direction is passed upwards once only. */
int gnoi_poly_is_convex(const gno_scene *scene, const gnoi_poly *poly)
{
    vec3 n = v3_from(poly->n), first;
    uint32_t count = poly->corner_count;
    int was_up = 0, rises = 0;
    if (count == 3)
        return 1;
    if (poly->ring_count != 1 || count > GNOI_FACET_CORNERS)
        return 0;
    first = v3_cross(n, v3_sub(gnoi_corner_at(scene, poly->corner + 1), gnoi_corner_at(scene, poly->corner)));
    for (uint32_t i = 0; i < count; i++) {
        vec3 a = gnoi_corner_at(scene, poly->corner + i), b = gnoi_corner_at(scene, poly->corner + (i + 1) % count);
        vec3 c = gnoi_corner_at(scene, poly->corner + (i + 2) % count), e = v3_sub(c, b);
        int up = v3_dot(e, first) > 0;
        if (!(v3_dot(v3_cross(v3_sub(b, a), e), n) > 0))
            return 0;
        rises += up && !was_up && i + 1 < count; /* the last is the first edge again */
        was_up = up;
    }
    return rises <= 1;
}

/* The rectangle around the corners along the first edge that is no point. */
static void bounding_rectangle(const gnoi_prepared *prep, const gnoi_poly *poly, vec3 points[4])
{
    uint32_t first = poly->corner, end = prep->ring_corner[poly->ring + 1];
    vec3 n = v3_from(poly->n), origin = v3_from(prep->positions[prep->corner_vertex[first]]), e1;
    e1 = v3_unit(v3_cross(n, fabs(n.x) < 0.6 ? v3(1, 0, 0) : v3(0, 1, 0)));
    for (uint32_t i = first + 1; i < end; i++) {
        vec3 edge = v3_sub(v3_from(prep->positions[prep->corner_vertex[i]]), origin);
        vec3 flat = v3_mad(edge, n, -v3_dot(edge, n));
        if (v3_dot(flat, flat) > 0) {
            e1 = v3_unit(flat);
            break;
        }
    }
    gnoi_poly_rectangle(prep, poly, e1, points);
}

int gnoi_poly_points_again(const gno_scene *scene, const gnoi_poly *poly, int exact, vec3 points[GNOI_PACKET_CORNERS])
{
    if (exact) {
        for (uint32_t i = 0; i < poly->corner_count; i++)
            points[i] = gnoi_corner_at(scene, poly->corner + i);
        return (int)poly->corner_count;
    }
    bounding_rectangle(&scene->prepared, poly, points);
    return 4;
}

int gnoi_poly_points(const gno_scene *scene, const gnoi_poly *poly, vec3 points[GNOI_PACKET_CORNERS], int *exact)
{
    *exact = poly->corner_count <= GNOI_PACKET_CORNERS && gnoi_poly_is_convex(scene, poly);
    return gnoi_poly_points_again(scene, poly, *exact, points);
}
