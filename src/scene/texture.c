/* texture.c -- textures, bumps and their pictures on the way into a scene.
 *
 * Place in the data flow: gno_scene_add_image, gno_scene_add_material -> here -> gno_scene.
 */
#include "base/tolerance.h"
#include "base/vec.h"
#include "scene/scene.h"
#include "scene/validate.h"

#include <limits.h>
#include <string.h>

static void fill(double *to, size_t count, double value)
{
    for (size_t i = 0; i < count; i++)
        to[i] = value;
}

gno_texture gno_texture_default(gno_texture_map map)
{
    gno_texture t;
    memset(&t, 0, sizeof t);
    t.kind = GNO_TEXTURE_NONE;
    t.map = map;
    t.u[0] = 1;
    t.v[map == GNO_MAP_CYLINDRICAL || map == GNO_MAP_SPHERICAL ? 2 : 1] = 1;
    fill(t.scale, 2, 1);
    t.wrap = GNO_WRAP_REPEAT;
    t.filter = GNO_FILTER_BOX;
    t.procedural = gno_procedural_default(GNO_PATTERN_WOOD);
    return t;
}

/* ---- checks ----------------------------------------------------------------------------------------------------------- */

static gno_status check_numbers(gno_context *context, const char *what, const char *key, const double *values, int count)
{
    for (int i = 0; i < count; i++)
        if (!(fabs(values[i]) <= GNO_MAX_COORDINATE))
            return gnoi_fail(context, GNO_ERROR_ARGUMENT, "%s: %s %g is not finite or beyond %g", what, key, values[i],
                             GNO_MAX_COORDINATE);
    return GNO_OK;
}

static gno_status check_place(gno_context *context, const char *what, const gno_texture *t)
{
    vec3 u = v3_unit(v3_from(t->u)), v = v3_unit(v3_from(t->v));
    const double(*c)[2] = t->corners;
    int given = c[0][0] != 0 || c[0][1] != 0 || c[1][0] != 0 || c[1][1] != 0;
    gno_status status = check_numbers(context, what, "origin", t->origin, 3);
    if (status == GNO_OK)
        status = check_numbers(context, what, "u", t->u, 3);
    if (status == GNO_OK)
        status = check_numbers(context, what, "v", t->v, 3);
    if (status == GNO_OK)
        status = check_numbers(context, what, "corners", c[0], 4);
    if (status == GNO_OK)
        status = check_numbers(context, what, "scale", t->scale, 2);
    if (status == GNO_OK && !(v3_length(v3_cross(u, v)) > GNOI_PARALLEL))
        status = gnoi_fail(context, GNO_ERROR_ARGUMENT, "%s: u and v have no length or are parallel", what);
    if (status == GNO_OK && given && (c[0][0] == c[1][0] || c[0][1] == c[1][1]))
        status = gnoi_fail(context, GNO_ERROR_ARGUMENT, "%s: corners span no area", what);
    if (status == GNO_OK && (t->scale[0] == 0 || t->scale[1] == 0))
        status = gnoi_fail(context, GNO_ERROR_ARGUMENT, "%s: 0 is no scale", what);
    return status;
}

static gno_status check_texture(const gno_scene *scene, const char *what, const gno_texture *t)
{
    gno_context *context = scene->context;
    const struct {
        const char *key;
        int value, most;
    } choices[] = {{"kind", (int)t->kind, GNO_TEXTURE_PROCEDURAL}, {"map", (int)t->map, GNO_MAP_SPHERICAL},
                   {"wrap", (int)t->wrap, GNO_WRAP_NONE}, {"filter", (int)t->filter, GNO_FILTER_LINEAR}};
    for (size_t i = 0; i < sizeof choices / sizeof choices[0]; i++)
        if (choices[i].value < 0 || choices[i].value > choices[i].most)
            return gnoi_fail(context, GNO_ERROR_ARGUMENT, "%s: %s %d is not in [0, %d]", what, choices[i].key, choices[i].value,
                             choices[i].most);
    if (t->kind == GNO_TEXTURE_NONE)
        return GNO_OK;
    if (t->kind == GNO_TEXTURE_PROCEDURAL) {
        const char *field;
        return gno_procedural_is_valid(&t->procedural, &field)
                   ? GNO_OK
                   : gnoi_fail(context, GNO_ERROR_ARGUMENT, "%s: procedural.%s is out of range", what, field);
    }
    if (t->kind == GNO_TEXTURE_IMAGE && (t->image < 0 || (size_t)t->image >= scene->image_count))
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "%s: image %d of %zu", what, t->image, scene->image_count);
    return check_place(context, what, t);
}

gno_status gnoi_check_surface(const gno_scene *scene, const gno_material *material)
{
    const gno_bump *bump = &material->bump;
    gno_status status = check_texture(scene, "texture", &material->texture);
    if (status != GNO_OK)
        return status;
    if ((int)bump->kind < 0 || (int)bump->kind > GNO_BUMP_NORMAL)
        return gnoi_fail(scene->context, GNO_ERROR_ARGUMENT, "bump: kind %d is not in [0, %d]", (int)bump->kind, GNO_BUMP_NORMAL);
    if (bump->kind == GNO_BUMP_NONE)
        return GNO_OK;
    status = check_texture(scene, "bump", &bump->texture);
    return status == GNO_OK ? check_numbers(scene->context, "bump", "amount", &bump->amount, 1) : status;
}

/* ---- pictures --------------------------------------------------------------------------------------------------------- */

static gno_status check_pixels(gno_context *context, const gno_pixels *pixels)
{
    size_t count;
    if (pixels->width < 1 || pixels->height < 1)
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "image: %d x %d pixels is empty", pixels->width, pixels->height);
    if (pixels->width > GNO_MAX_IMAGE_SIDE || pixels->height > GNO_MAX_IMAGE_SIDE)
        return gnoi_fail(context, GNO_ERROR_LIMIT, "image: %d x %d pixels exceeds %d a side", pixels->width, pixels->height,
                         GNO_MAX_IMAGE_SIDE);
    if (pixels->channels < 1 || pixels->channels > 4)
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "image: %d channels is not in [1, 4]", pixels->channels);
    if (!pixels->linear == !pixels->bytes)
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "image: exactly one of linear and bytes must be given");
    count = (size_t)pixels->width * (size_t)pixels->height * (size_t)pixels->channels;
    for (size_t i = 0; pixels->linear && i < count; i++)
        if (!isfinite(pixels->linear[i]))
            return gnoi_fail(context, GNO_ERROR_ARGUMENT, "image: value %zu is not finite", i);
    return GNO_OK;
}

gno_status gno_scene_add_image(gno_scene *scene, const gno_pixels *pixels, int *index)
{
    gno_context *context = gno_scene_context(scene);
    gno_status status;
    void *array;
    if (!scene || !pixels)
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "gno_scene_add_image: scene or pixels is NULL");
    status = check_pixels(context, pixels);
    if (status != GNO_OK)
        return status;
    if (scene->image_count >= INT_MAX)
        return gnoi_fail(context, GNO_ERROR_LIMIT, "image: too many images");
    array = scene->images;
    if (!gnoi_reserve(context, &array, &scene->image_capacity, scene->image_count + 1, sizeof *scene->images))
        return gnoi_fail(context, GNO_ERROR_MEMORY, "image: out of memory");
    scene->images = array;
    status = gnoi_image_make(context, pixels, &scene->images[scene->image_count]);
    if (status != GNO_OK)
        return gnoi_fail(context, status, "image: out of memory for %d x %d pixels", pixels->width, pixels->height);
    if (index)
        *index = (int)scene->image_count;
    scene->image_count++;
    return GNO_OK;
}
