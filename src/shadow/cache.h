/* cache.h -- the lamps of a scene and their casters, kept from view to view.
 *
 * Place in the data flow: scene lights -> lamps -> casters for each (contour.h). Shadows do not depend on the viewer: what is built here
 * serves every later view of the same scene, unless its eye enters a closed solid, and is dropped by gnoi_scene_changed.
 */
#ifndef GNOI_SHADOW_CACHE_H
#define GNOI_SHADOW_CACHE_H

#include "project/view.h"
#include "shadow/contour.h"

struct gnoi_shadow_cache {
    size_t lamp_count;
    gnoi_lamp *lamps;
    gnoi_casters *casters; /* one for each lamp */
    size_t solid_count;    /* 0: nothing is halved */
    unsigned char *halved; /* lamp_count x solid_count: closed solids with the lamp outside, whose near sides are left away */
};

/* Fills scene->shadows if need be; the scene must be prepared. What is there serves while the eye stays outside the closed
 * solids that were halved; else it is built anew without them. */
gno_status gnoi_shadow_cache_build(gno_scene *scene, const gnoi_view *view, int threads);

#endif
