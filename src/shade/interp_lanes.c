/* interp_lanes.c -- see interp_lanes.h. */
#include "shade/interp_lanes.h"
#include "base/vector.h"

VECTOR_CLONES static void set(gnoi_interp_lanes *restrict l, const gnoi_form fx, const gnoi_form fy, const gnoi_form fw)
{
    for (int i = 0; i < GNOI_INTERP_LANES; i++) {
        vec3 v[3];
        gnoi_screen_plane w[3];
        double scale, turn = 0;
        for (int c = 0; c < 3; c++) {
            const vec3 p = {l->position[c][0][i], l->position[c][1][i], l->position[c][2][i]};
            v[c] = v3(gnoi_form_at(&fx, p), gnoi_form_at(&fy, p), gnoi_form_at(&fw, p));
        }
        scale = gnoi_interp_weigh(v, w);
        for (int k = 0; k < 3; k++) {
            double x = 0, y = 0, z = 0;
            for (int c = 0; c < 3; c++) {
                const double n = l->normal[c][k][i];
                x += w[c].fx * n;
                y += w[c].fy * n;
                z += w[c].f0 * n;
            }
            l->plane[k][0][i] = x;
            l->plane[k][1][i] = y;
            l->plane[k][2][i] = z;
            turn += x * x + y * y;
        }
        l->turn[i] = turn / (scale * scale);
    }
}

void gnoi_interp_lanes_set(gnoi_interp_lanes *lanes, const gnoi_view *view) { set(lanes, view->x, view->y, view->w); }
