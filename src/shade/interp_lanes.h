/* interp_lanes.h -- the interpolated normals of triangles side by side.
 *
 * Place in the data flow: corners of prepared triangles + view -> here -> normals as linear functions over the picture.
 * Invariant: the numbers are those of gnoi_interp_seek, whichever vector code is taken.
 */
#ifndef GNOI_SHADE_INTERP_LANES_H
#define GNOI_SHADE_INTERP_LANES_H

#include "shade/interp.h"

#define GNOI_INTERP_LANES 16

typedef struct gnoi_interp_lanes {
    double position[3][3][GNOI_INTERP_LANES], normal[3][3][GNOI_INTERP_LANES]; /* by corner and axis */
    double plane[3][3][GNOI_INTERP_LANES];                                     /* by axis: fx, fy, f0, as in gnoi_interp */
    double turn[GNOI_INTERP_LANES];
} gnoi_interp_lanes;

/* A prepared triangle whose corners have normals, from its first corner. */
static inline void gnoi_interp_lanes_load(gnoi_interp_lanes *lanes, unsigned lane, const gnoi_prepared *prep, uint32_t corner)
{
    for (uint32_t i = 0; i < 3; i++) {
        const double *p = prep->positions[prep->corner_vertex[corner + i]];
        const float *n = prep->normals[prep->corner_normal[corner + i]];
        for (int k = 0; k < 3; k++) {
            lanes->position[i][k][lane] = p[k];
            lanes->normal[i][k][lane] = (double)n[k];
        }
    }
}

/* Sets planes and turns of all lanes; of those that were never loaded they are of no use. */
void gnoi_interp_lanes_set(gnoi_interp_lanes *lanes, const gnoi_view *view);

#endif
