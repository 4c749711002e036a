/* weld.h -- which vertices lie at one place.
 *
 * Place in the data flow: scene positions -> here -> number.c (prepared vertices), problems.c.
 */
#ifndef GNOI_SCENE_WELD_H
#define GNOI_SCENE_WELD_H

#include "base/context.h"

/* same[v] becomes the first vertex at the place of vertex v, v itself where it is the first; 0 and -0 are one place.
 * Errors: MEMORY, CANCELLED, with a message. */
gno_status gnoi_weld(gno_context *context, int threads, size_t count, const double (*positions)[3], uint32_t *same);

#endif
