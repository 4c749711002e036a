/* interp.c -- see interp.h. */
#include "shade/interp.h"

static vec3 homogeneous(const gno_scene *scene, const gnoi_view *view, uint32_t corner)
{
    vec3 p = v3_from(scene->prepared.positions[scene->prepared.corner_vertex[corner]]);
    return v3(gnoi_form_at(&view->x, p), gnoi_form_at(&view->y, p), gnoi_form_at(&view->w, p));
}

static void set_weights(gnoi_interp *interp, const gno_scene *scene, const gnoi_view *view)
{
    vec3 v[3];
    for (int i = 0; i < 3; i++)
        v[i] = homogeneous(scene, view, interp->corner[i]);
    interp->scale = gnoi_interp_weigh(v, interp->weight);
}

static void set_normals(gnoi_interp *interp, const gno_scene *scene)
{
    const gnoi_prepared *prep = &scene->prepared;
    double turn = 0;
    interp->turn = 0;
    if (!prep->corner_normal || prep->corner_normal[interp->corner[0]] == GNOI_NONE)
        return;
    for (int k = 0; k < 3; k++) {
        gnoi_screen_plane sum = {0, 0, 0};
        for (int i = 0; i < 3; i++) {
            double n = (double)prep->normals[prep->corner_normal[interp->corner[i]]][k];
            sum.fx += interp->weight[i].fx * n;
            sum.fy += interp->weight[i].fy * n;
            sum.f0 += interp->weight[i].f0 * n;
        }
        interp->normal[k] = sum;
        turn += sum.fx * sum.fx + sum.fy * sum.fy;
    }
    interp->turn = (float)(turn / (interp->scale * interp->scale));
}

static void set_triangle(gnoi_interp *interp, const gno_scene *scene, const gnoi_view *view, const gnoi_poly *poly, uint32_t triangle)
{
    for (uint32_t i = 0; i < 3; i++)
        interp->corner[i] = interp->triangle_count == 1 ? poly->corner + i
                                                        : scene->prepared.triangles[poly->triangle + triangle][i];
    interp->triangle = triangle;
    set_weights(interp, scene, view);
}

double gnoi_interp_depth(const gnoi_interp *interp, double x, double y)
{
    double w[3], sum, low;
    for (int i = 0; i < 3; i++)
        w[i] = gnoi_plane_at(&interp->weight[i], x, y);
    sum = fabs(w[0]) + fabs(w[1]) + fabs(w[2]);
    low = w[0] < w[1] ? w[0] : w[1];
    low = low < w[2] ? low : w[2];
    return sum > 0 ? low / sum : -1;
}

void gnoi_interp_seek(gnoi_interp *interp, const gno_scene *scene, const gnoi_view *view, const gnoi_poly *poly, double x, double y)
{
    double best = -2;
    uint32_t found = 0;
    if (interp->ready && (interp->triangle_count == 1 || gnoi_interp_depth(interp, x, y) >= 0))
        return;
    interp->triangle_count = poly->corner_count == 3 || poly->triangle == GNOI_NONE
                                 ? 1 : poly->corner_count + 2u * (poly->ring_count - 1u) - 2u;
    for (uint32_t t = 0; t < interp->triangle_count && best < 0; t++) {
        double depth;
        set_triangle(interp, scene, view, poly, t);
        depth = gnoi_interp_depth(interp, x, y);
        if (depth > best) {
            best = depth;
            found = t;
        }
    }
    if (interp->triangle != found)
        set_triangle(interp, scene, view, poly, found);
    set_normals(interp, scene);
    interp->ready = 1;
}
