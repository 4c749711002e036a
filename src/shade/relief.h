/* relief.h -- a surface's normal turned by its material's bump.
 *
 * Place in the data flow: interpolated normal of a sample -> here -> lighting. The surface itself, its edges and shadows stay.
 * With heights N' = N - grad h, the gradient of the height over the surface; where N = Q_x x Q_y is the surface's own this is 8.6.7,
 * and it does not ask which way the pattern runs. Heights rise towards the viewer.
 */
#ifndef GNOI_SHADE_RELIEF_H
#define GNOI_SHADE_RELIEF_H

#include "shade/texture.h"

/* n: unit, on the viewer's side; (x,y) the pixel's centre, (xs,ys) the sample. mapping: that of the bump's texture. The result is not
 * of unit length. */
vec3 gnoi_relief_normal(const gnoi_sight *sight, const gno_bump *bump, gnoi_mapping *mapping, double x, double y, double xs, double ys, vec3 n);

#define GNOI_RELIEF_RUN 8

/* The same for heights of a picture at `count` samples at once, n[k][i] being component k of normal i; the pattern is that of all of them.
 * Beyond `count` the arrays hold numbers too. Returns 0 with n as it was where some sample has to be looked at alone. */
int gnoi_relief_run(const gnoi_sight *sight, const gno_bump *bump, const gnoi_pattern *pattern, int count, const double *xs, const double *ys,
                    double (*n)[GNOI_RELIEF_RUN]);

#endif
