/* flux.h -- how much of a light's rays a region takes, and the whole that all casters take together.
 *
 * Place in the data flow: lit parts -> their flux, summed; all casters -> projected, united -> the area that the sum must equal:
 * the certificate of a run. The measure: for a light at infinity the area of the projection along it, else the area of the
 * central projection onto a cube of side 2 around the light, face by face; inside the pyramid of a spot.
 */
#ifndef GNOI_SHADOW_FLUX_H
#define GNOI_SHADOW_FLUX_H

#include "shadow/parts.h"

/* Flux of polygons first .. first+count-1 of a shape on the canvas, whose rings do not cross: the outer one first, then its holes. 0 when
 * memory fails. */
int gnoi_flux_of(const gnoi_canvas *canvas, const gno_shape *shape, size_t first, size_t count, gnoi_cover *scratch, double *flux);

/* Area of the union of everything that casts, in the same measure. */
gno_status gnoi_flux_union(const gnoi_centre *centre, gnoi_parter *p, double *flux);

#endif
