/* validate.h -- checks of the values that callers put into a scene. Place: scene; used by scene.c and mesh.c.
 *
 * Each check sets the context's message and returns GNO_ERROR_ARGUMENT where a value is not finite or out of range.
 */
#ifndef GNOI_SCENE_VALIDATE_H
#define GNOI_SCENE_VALIDATE_H

#include "base/context.h"

gno_status gnoi_check_material(gno_context *context, const gno_material *material);
/* The material's texture and bump: texture.c. */
struct gno_scene;
gno_status gnoi_check_surface(const struct gno_scene *scene, const gno_material *material);
gno_status gnoi_check_light(gno_context *context, const gno_light *light);
gno_status gnoi_check_camera(gno_context *context, const gno_camera *camera);
gno_status gnoi_check_image(gno_context *context, const gno_image_def *image);

/* Three finite components in [0, most]. */
gno_status gnoi_check_colour(gno_context *context, const char *what, const char *key, const double colour[3], double most);

/* Point lights that a light stands for: samples squared for an area light, otherwise one. */
size_t gnoi_light_points(const gno_light *light);

#endif
