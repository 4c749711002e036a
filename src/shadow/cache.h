/* cache.h -- the lamps of a scene and their caster trees, kept from view to view.
 *
 * Place in the data flow: scene lights -> lamps -> one tree for each (tree.h). Shadows do not depend on the viewer: what is built here
 * serves every later view of the same scene and is dropped by gnoi_scene_changed.
 */
#ifndef GNOI_SHADOW_CACHE_H
#define GNOI_SHADOW_CACHE_H

#include "shadow/tree.h"

struct gnoi_shadow_cache {
    size_t lamp_count;
    gnoi_lamp *lamps;
    gnoi_tree *trees; /* one for each lamp */
};

/* Fills scene->shadows if need be; the scene must be prepared. */
gno_status gnoi_shadow_cache_build(gno_scene *scene, int threads);

#endif
