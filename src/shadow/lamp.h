/* lamp.h -- the lights of a scene as the passes see them: single points or directions.
 *
 * Place in the data flow: scene lights -> lamps, numbered in the order of the lights -> trees, columns, pieces.
 * Invariant: an area light's samples x samples lamps follow one another; any other light is one lamp.
 */
#ifndef GNOI_SHADOW_LAMP_H
#define GNOI_SHADOW_LAMP_H

#include "scene/scene.h"
#include "shadow/frame.h"

/* A value of gno_visible_def.split beyond the public ones: no light splits, what all reach is kept beside (piece_set.h). */
#define GNOI_SPLIT_BESIDE 3

size_t gnoi_lamps_count(const gno_scene *scene);

/* Of one light alone. lamps: room for gnoi_light_points. */
void gnoi_lamps_of(const gno_light *light, gnoi_lamp *lamps);

/* lamps: room for gnoi_lamps_count. */
void gnoi_lamps_fill(const gno_scene *scene, gnoi_lamp *lamps);

/* 1 when the lamp is certainly outside a closed solid, and on the inner side of its cap. */
int gnoi_lamp_outside(const gno_scene *scene, size_t solid, const gnoi_lamp *lamp);

/* Whether pieces can bound the scene's shadows: not those that weaken with distance, nor those of textures with holes. */
int gnoi_shadows_have_edges(const gno_scene *scene);

/* 1 when the expanded light is the first, or the only, point of its light. */
int gnoi_lamp_is_first(const gno_scene *scene, size_t light);

#endif
