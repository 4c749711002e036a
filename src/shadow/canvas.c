/* canvas.c -- see canvas.h. */
#include "shadow/canvas.h"

void gnoi_plane_axes(vec3 n, vec3 *u, vec3 *v)
{
    double x = fabs(n.x), y = fabs(n.y), z = fabs(n.z);
    *v = v3_unit(v3_cross(n, x <= y && x <= z ? v3(1, 0, 0) : y <= z ? v3(0, 1, 0) : v3(0, 0, 1)));
    *u = v3_cross(*v, n);
}

gnoi_canvas gnoi_canvas_make(const gnoi_centre *centre, uint32_t index)
{
    const gnoi_poly *poly = &centre->scene->prepared.polys[index];
    const gnoi_stand *s = &centre->stands[index];
    vec3 first = gnoi_corner_at(centre->scene, poly->corner), to;
    gnoi_canvas c;
    c.centre = centre;
    c.index = index;
    c.n = v3_scale(v3_from(poly->n), s->side < 0 ? -1 : 1);
    c.origin = v3_mad(first, c.n, -s->lift);
    gnoi_plane_axes(c.n, &c.u, &c.v);
    c.height = s->height;
    to = centre->lamp.directional ? centre->lamp.to_light : v3_sub(centre->lamp.position, c.origin);
    c.along_u = v3_dot(c.u, to) / s->height;
    c.along_v = v3_dot(c.v, to) / s->height;
    return c;
}

gnoi_hpoint gnoi_canvas_project(const gnoi_canvas *c, vec3 p)
{
    gnoi_hpoint r;
    vec3 q = v3_sub(p, c->origin);
    double h = v3_dot(c->n, q);
    r.side = h / c->height;
    r.x = v3_dot(c->u, q) - c->along_u * h;
    r.y = v3_dot(c->v, q) - c->along_v * h;
    r.w = c->centre->lamp.directional ? 1 : 1 - r.side;
    return r;
}

double gnoi_canvas_bend(const gnoi_canvas *canvas)
{
    const gno_scene *scene = canvas->centre->scene;
    const gnoi_poly *poly = &scene->prepared.polys[canvas->index];
    double bend = 0;
    for (uint32_t i = 0; i < poly->corner_count; i++)
        bend = fmax(bend, fabs(v3_dot(canvas->n, v3_sub(gnoi_corner_at(scene, poly->corner + i), canvas->origin))));
    return bend;
}
