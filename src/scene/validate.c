/* validate.c -- checks of materials, lights, cameras and pictures before they enter a scene.
 *
 * Place in the data flow: gno_scene_add_material, _add_light, _set_* -> here -> gno_scene.
 * Invariant kept: every number in a scene is finite and in its documented range, so that no later pass asks again.
 */
#include "scene/validate.h"
#include "base/tolerance.h"
#include "base/vec.h"

#include <float.h>

static gno_status check_range(gno_context *context, const char *what, const char *key, double value, double least, double most)
{
    if (value >= least && value <= most) { /* false for NaN */
        return GNO_OK;
    }
    if (most >= DBL_MAX) {
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "%s: %s %g must be finite and at least %g", what, key, value, least);
    }
    return gnoi_fail(context, GNO_ERROR_ARGUMENT, "%s: %s %g is not in [%g, %g]", what, key, value, least, most);
}

gno_status gnoi_check_colour(gno_context *context, const char *what, const char *key, const double colour[3], double most)
{
    gno_status status = GNO_OK;
    int i;
    for (i = 0; i < 3 && status == GNO_OK; i++) {
        status = check_range(context, what, key, colour[i], 0, most);
    }
    return status;
}

static gno_status check_vector(gno_context *context, const char *what, const char *key, const double vector[3])
{
    gno_status status = GNO_OK;
    int i;
    for (i = 0; i < 3 && status == GNO_OK; i++) {
        status = check_range(context, what, key, vector[i], -GNO_MAX_COORDINATE, GNO_MAX_COORDINATE);
    }
    return status;
}

static gno_status check_direction(gno_context *context, const char *what, const char *key, const double vector[3])
{
    if (v3_length(v3_from(vector)) > 0) {
        return GNO_OK;
    }
    return gnoi_fail(context, GNO_ERROR_ARGUMENT, "%s: %s has no length", what, key);
}

static gno_status check_choice(gno_context *context, const char *what, const char *key, int value, int most)
{
    if (value >= 0 && value <= most) {
        return GNO_OK;
    }
    return gnoi_fail(context, GNO_ERROR_ARGUMENT, "%s: %s %d is not in [0, %d]", what, key, value, most);
}

/* An angle of a cone: open at both ends of (0,180). */
static gno_status check_cone(gno_context *context, const char *what, const char *key, double angle)
{
    if (angle > 0 && angle < 180) {
        return GNO_OK;
    }
    return gnoi_fail(context, GNO_ERROR_ARGUMENT, "%s: %s %g is not between 0 and 180 degrees", what, key, angle);
}

gno_status gnoi_check_material(gno_context *context, const gno_material *material)
{
    static const char what[] = "material";
    gno_status status = gnoi_check_colour(context, what, "ambient", material->ambient, DBL_MAX);
    if (status == GNO_OK) {
        status = gnoi_check_colour(context, what, "diffuse", material->diffuse, DBL_MAX);
    }
    if (status == GNO_OK) {
        status = gnoi_check_colour(context, what, "specular", material->specular, DBL_MAX);
    }
    if (status == GNO_OK) {
        status = gnoi_check_colour(context, what, "transmission", material->transmission, 1);
    }
    if (status == GNO_OK) {
        status = check_range(context, what, "shininess", material->shininess, 0, DBL_MAX);
    }
    if (status == GNO_OK) {
        status = check_choice(context, what, "shading", (int)material->shading, GNO_SHADING_PHONG);
    }
    return status;
}

static gno_status check_light_shape(gno_context *context, const gno_light *light)
{
    static const char what[] = "light";
    gno_status status = GNO_OK;
    if (light->type == GNO_LIGHT_DIRECTIONAL || light->type == GNO_LIGHT_SPOT) {
        status = check_direction(context, what, "direction", light->direction);
    }
    if (status == GNO_OK && light->type == GNO_LIGHT_SPOT) {
        status = check_cone(context, what, "angle", light->angle);
    }
    if (status == GNO_OK && light->type == GNO_LIGHT_AREA && light->samples < 1) {
        status = gnoi_fail(context, GNO_ERROR_ARGUMENT, "%s: samples %d must be at least 1", what, light->samples);
    }
    return status;
}

gno_status gnoi_check_light(gno_context *context, const gno_light *light)
{
    static const char what[] = "light";
    const double *vectors[4];
    static const char *const keys[4] = {"position", "direction", "edge1", "edge2"};
    gno_status status = check_choice(context, what, "type", (int)light->type, GNO_LIGHT_AREA);
    int i;
    vectors[0] = light->position;
    vectors[1] = light->direction;
    vectors[2] = light->edge1;
    vectors[3] = light->edge2;
    for (i = 0; i < 4 && status == GNO_OK; i++) {
        status = check_vector(context, what, keys[i], vectors[i]);
    }
    if (status == GNO_OK) {
        status = gnoi_check_colour(context, what, "intensity", light->intensity, DBL_MAX);
    }
    if (status == GNO_OK) {
        status = check_choice(context, what, "falloff", (int)light->falloff, GNO_FALLOFF_INVERSE_SQUARE);
    }
    if (status == GNO_OK) {
        status = check_range(context, what, "falloff_k", light->falloff_k, 0, DBL_MAX);
    }
    if (status == GNO_OK) {
        status = check_range(context, what, "softness", light->softness, 0, DBL_MAX);
    }
    return status == GNO_OK ? check_light_shape(context, light) : status;
}

size_t gnoi_light_points(const gno_light *light)
{
    return light->type == GNO_LIGHT_AREA ? (size_t)light->samples * (size_t)light->samples : 1;
}

gno_status gnoi_check_camera(gno_context *context, const gno_camera *camera)
{
    static const char what[] = "camera";
    vec3 view = v3_unit(v3_sub(v3_from(camera->target), v3_from(camera->eye)));
    vec3 up = v3_unit(v3_from(camera->up));
    gno_status status = check_choice(context, what, "type", (int)camera->type, GNO_CAMERA_ORTHOGRAPHIC);
    if (status == GNO_OK) {
        status = check_vector(context, what, "eye", camera->eye);
    }
    if (status == GNO_OK) {
        status = check_vector(context, what, "target", camera->target);
    }
    if (status == GNO_OK) {
        status = check_vector(context, what, "up", camera->up);
    }
    if (status == GNO_OK) {
        status = check_direction(context, what, "up", camera->up);
    }
    if (status == GNO_OK && !(v3_length(view) > 0)) {
        status = gnoi_fail(context, GNO_ERROR_ARGUMENT, "camera: eye and target are the same point");
    }
    if (status == GNO_OK && !(v3_length(v3_cross(view, up)) > GNOI_PARALLEL)) {
        status = gnoi_fail(context, GNO_ERROR_ARGUMENT, "camera: up is parallel to the direction of view");
    }
    if (status == GNO_OK && camera->type == GNO_CAMERA_PERSPECTIVE) {
        status = check_cone(context, what, "fov", camera->fov);
    }
    if (status == GNO_OK && camera->type == GNO_CAMERA_ORTHOGRAPHIC &&
        !(camera->height > 0 && camera->height <= GNO_MAX_COORDINATE)) {
        status = gnoi_fail(context, GNO_ERROR_ARGUMENT, "camera: height %g is not above 0 and at most %g", camera->height,
                           GNO_MAX_COORDINATE);
    }
    return status;
}

gno_status gnoi_check_image(gno_context *context, const gno_image_def *image)
{
    if (image->width < 1 || image->height < 1) {
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "image: %d x %d pixels is empty", image->width, image->height);
    }
    if (image->width > GNO_MAX_IMAGE_SIDE || image->height > GNO_MAX_IMAGE_SIDE) {
        return gnoi_fail(context, GNO_ERROR_LIMIT, "image: %d x %d pixels exceeds %d a side", image->width, image->height,
                         GNO_MAX_IMAGE_SIDE);
    }
    return gnoi_check_colour(context, "image", "background", image->background, DBL_MAX);
}
