/* scene.c -- what a scene holds besides geometry, and reading a scene back.
 *
 * Place in the data flow: callers and file readers -> gno_scene_* -> gno_scene -> gnoi_scene_prepare -> passes.
 * Meshes come in through mesh.c; values are checked by validate.c.
 * Invariants: those of scene.h; a call that fails leaves the scene as it was.
 */
#include "scene/scene.h"
#include "scene/validate.h"

#include <float.h>
#include <string.h>

#define MAX_MATERIALS 65536 /* gnoi_poly holds a material in 16 bits */

/* ---- defaults -------------------------------------------------------------------------------------------------- */

static void fill(double triple[3], double x, double y, double z)
{
    triple[0] = x;
    triple[1] = y;
    triple[2] = z;
}

gno_material gno_material_default(void)
{
    gno_material material;
    memset(&material, 0, sizeof material);
    fill(material.ambient, 0.8, 0.8, 0.8);
    fill(material.diffuse, 0.8, 0.8, 0.8);
    material.shininess = 1;
    material.shading = GNO_SHADING_FLAT;
    material.two_sided = 1;
    material.texture = gno_texture_default(GNO_MAP_UV);
    material.bump.kind = GNO_BUMP_NONE;
    material.bump.texture = gno_texture_default(GNO_MAP_UV);
    material.bump.amount = 1;
    return material;
}

gno_light gno_light_default(void)
{
    gno_light light;
    memset(&light, 0, sizeof light);
    light.type = GNO_LIGHT_POINT;
    light.angle = 45;
    fill(light.intensity, 1, 1, 1);
    light.falloff = GNO_FALLOFF_NONE;
    light.falloff_k = 1;
    light.distance_from_viewer = 1;
    light.samples = 4;
    light.softness = 0;
    return light;
}

gno_camera gno_camera_default(void)
{
    gno_camera camera;
    memset(&camera, 0, sizeof camera);
    camera.type = GNO_CAMERA_PERSPECTIVE;
    fill(camera.eye, 3, -6, 2);
    fill(camera.target, 0, 0, 1);
    fill(camera.up, 0, 0, 1);
    camera.fov = 40;
    camera.height = 1;
    return camera;
}

gno_image_def gno_image_def_default(void)
{
    gno_image_def image;
    memset(&image, 0, sizeof image);
    image.width = 1280;
    image.height = 720;
    return image;
}

/* ---- life ------------------------------------------------------------------------------------------------------ */

gno_status gno_scene_create(gno_context *context, gno_scene **scene)
{
    gno_material material = gno_material_default();
    gno_scene *fresh;
    if (scene) {
        *scene = NULL;
    }
    if (!context || !scene) {
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "gno_scene_create: context or scene is NULL");
    }
    fresh = gnoi_calloc(context, 1, sizeof *fresh);
    if (!fresh) {
        return gnoi_fail(context, GNO_ERROR_MEMORY, "scene: out of memory");
    }
    fresh->context = context;
    fresh->camera = gno_camera_default();
    fresh->image = gno_image_def_default();
    /* The offset arrays hold one element more than there are polygons and rings, from the beginning. */
    fresh->polygon_start = gnoi_calloc(context, 1, sizeof *fresh->polygon_start);
    fresh->ring_start = gnoi_calloc(context, 1, sizeof *fresh->ring_start);
    if (!fresh->polygon_start || !fresh->ring_start || gno_scene_add_material(fresh, &material, NULL) != GNO_OK) {
        gno_scene_destroy(fresh);
        return gnoi_fail(context, GNO_ERROR_MEMORY, "scene: out of memory");
    }
    *scene = fresh;
    return GNO_OK;
}

static void free_arrays(gno_context *context, gno_scene *scene)
{
    gnoi_free(context, scene->positions, scene->vertex_capacity, sizeof *scene->positions);
    gnoi_free(context, scene->normals, scene->normal_capacity, sizeof *scene->normals);
    gnoi_free(context, scene->texcoords, scene->texcoord_capacity, sizeof *scene->texcoords);
    gnoi_free(context, scene->polygon_start, scene->polygon_capacity + 1, sizeof *scene->polygon_start);
    gnoi_free(context, scene->polygon_material, scene->polygon_capacity, sizeof *scene->polygon_material);
    gnoi_free(context, scene->polygon_object, scene->polygon_capacity, sizeof *scene->polygon_object);
    gnoi_free(context, scene->ring_start, scene->ring_capacity + 1, sizeof *scene->ring_start);
    gnoi_free(context, scene->corner_vertex, scene->corner_capacity, sizeof *scene->corner_vertex);
    gnoi_free(context, scene->corner_normal, scene->corner_capacity, sizeof *scene->corner_normal);
    gnoi_free(context, scene->corner_texcoord, scene->corner_capacity, sizeof *scene->corner_texcoord);
    gnoi_free(context, scene->objects, scene->object_capacity, sizeof *scene->objects);
    gnoi_free(context, scene->materials, scene->material_capacity, sizeof *scene->materials);
    gnoi_free(context, scene->images, scene->image_capacity, sizeof *scene->images);
    gnoi_free(context, scene->lights, scene->light_capacity, sizeof *scene->lights);
}

void gno_scene_destroy(gno_scene *scene)
{
    gno_context *context;
    size_t i;
    if (!scene) {
        return;
    }
    context = scene->context;
    gnoi_scene_drop_path(scene);
    gnoi_scene_changed(scene);
    for (i = 0; i < scene->object_count; i++) {
        gnoi_free(context, scene->objects[i].name, scene->objects[i].name_size, 1);
    }
    for (i = 0; i < scene->light_count; i++) {
        gnoi_free(context, scene->lights[i].name, scene->lights[i].name_size, 1);
    }
    gnoi_scene_free_names(scene);
    for (i = 0; i < scene->image_count; i++) {
        gnoi_image_free(context, &scene->images[i]);
    }
    free_arrays(context, scene);
    gnoi_free(context, scene, 1, sizeof *scene);
}

gno_context *gno_scene_context(const gno_scene *scene)
{
    return scene ? scene->context : NULL;
}

void gnoi_scene_changed(gno_scene *scene)
{
    if (scene->shadows && scene->free_shadows) {
        scene->free_shadows(scene->context, scene->shadows);
    }
    scene->shadows = NULL;
    scene->changes++;
    gnoi_prepared_free(scene->context, &scene->prepared);
}

/* ---- materials and lights -------------------------------------------------------------------------------------- */

gno_status gno_scene_add_material(gno_scene *scene, const gno_material *material, int *index)
{
    gno_context *context = gno_scene_context(scene);
    gno_status status;
    void *array;
    if (!scene || !material) {
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "gno_scene_add_material: scene or material is NULL");
    }
    status = gnoi_check_material(context, material);
    if (status == GNO_OK) {
        status = gnoi_check_surface(scene, material);
    }
    if (status != GNO_OK) {
        return status;
    }
    if (scene->material_count >= MAX_MATERIALS) {
        return gnoi_fail(context, GNO_ERROR_LIMIT, "material: more than %d materials", MAX_MATERIALS);
    }
    array = scene->materials;
    if (!gnoi_reserve(context, &array, &scene->material_capacity, scene->material_count + 1, sizeof *scene->materials)) {
        return gnoi_fail(context, GNO_ERROR_MEMORY, "material: out of memory");
    }
    scene->materials = array;
    if (material->bump.kind == GNO_BUMP_HEIGHT && material->bump.texture.kind == GNO_TEXTURE_IMAGE &&
        gnoi_image_make_heights(context, &scene->images[material->bump.texture.image]) != GNO_OK) {
        return gnoi_fail(context, GNO_ERROR_MEMORY, "material: out of memory");
    }
    if (index) {
        *index = (int)scene->material_count;
    }
    scene->materials[scene->material_count++] = *material;
    gnoi_scene_changed(scene);
    return GNO_OK;
}

static size_t light_points(const gno_scene *scene)
{
    size_t points = 0, i;
    for (i = 0; i < scene->light_count; i++) {
        points += gnoi_light_points(&scene->lights[i].light);
    }
    return points;
}

gno_status gno_scene_add_light(gno_scene *scene, const char *name, const gno_light *light, int *index)
{
    gno_context *context = gno_scene_context(scene);
    gnoi_named_light named;
    gno_status status;
    void *array;
    if (!scene || !light) {
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "gno_scene_add_light: scene or light is NULL");
    }
    status = gnoi_check_light(context, light);
    if (status != GNO_OK) {
        return status;
    }
    if ((light->type == GNO_LIGHT_AREA && light->samples > GNO_MAX_LIGHTS) ||
        gnoi_light_points(light) + light_points(scene) > GNO_MAX_LIGHTS) {
        return gnoi_fail(context, GNO_ERROR_LIMIT, "light: more than %d lights after splitting area lights", GNO_MAX_LIGHTS);
    }
    array = scene->lights;
    if (!gnoi_reserve(context, &array, &scene->light_capacity, scene->light_count + 1, sizeof *scene->lights)) {
        return gnoi_fail(context, GNO_ERROR_MEMORY, "light: out of memory");
    }
    scene->lights = array;
    named.light = *light;
    named.name_size = strlen(name ? name : "") + 1;
    named.name = gnoi_malloc(context, named.name_size, 1);
    if (!named.name) {
        return gnoi_fail(context, GNO_ERROR_MEMORY, "light: out of memory");
    }
    memcpy(named.name, name ? name : "", named.name_size);
    if (index) {
        *index = (int)scene->light_count;
    }
    scene->lights[scene->light_count++] = named;
    gnoi_scene_changed(scene);
    return GNO_OK;
}

gno_status gno_scene_material(const gno_scene *scene, int index, gno_material *material)
{
    gno_context *context = gno_scene_context(scene);
    if (!scene || !material) {
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "gno_scene_material: scene or material is NULL");
    }
    if (index < 0 || (size_t)index >= scene->material_count) {
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "material %d of %zu", index, scene->material_count);
    }
    *material = scene->materials[index];
    return GNO_OK;
}

gno_status gno_scene_light(const gno_scene *scene, int index, gno_light *light, const char **name)
{
    gno_context *context = gno_scene_context(scene);
    if (name) {
        *name = NULL;
    }
    if (!scene) {
        return GNO_ERROR_ARGUMENT;
    }
    if (index < 0 || (size_t)index >= scene->light_count) {
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "light %d of %zu", index, scene->light_count);
    }
    if (light) {
        *light = scene->lights[index].light;
    }
    if (name) {
        *name = scene->lights[index].name;
    }
    return GNO_OK;
}

/* ---- camera, picture, ambient light ---------------------------------------------------------------------------- */

gno_status gno_scene_set_camera(gno_scene *scene, const gno_camera *camera)
{
    gno_context *context = gno_scene_context(scene);
    gno_status status;
    if (!scene || !camera) {
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "gno_scene_set_camera: scene or camera is NULL");
    }
    status = gnoi_check_camera(context, camera);
    if (status == GNO_OK) {
        scene->camera = *camera;
    }
    return status;
}

gno_camera gno_scene_camera(const gno_scene *scene)
{
    return scene ? scene->camera : gno_camera_default();
}

gno_status gno_scene_set_image(gno_scene *scene, const gno_image_def *image)
{
    gno_context *context = gno_scene_context(scene);
    gno_status status;
    if (!scene || !image) {
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "gno_scene_set_image: scene or image is NULL");
    }
    status = gnoi_check_image(context, image);
    if (status == GNO_OK) {
        scene->image = *image;
    }
    return status;
}

gno_image_def gno_scene_image(const gno_scene *scene)
{
    return scene ? scene->image : gno_image_def_default();
}

gno_status gno_scene_set_ambient(gno_scene *scene, const double ambient[3])
{
    gno_context *context = gno_scene_context(scene);
    gno_status status;
    if (!scene || !ambient) {
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "gno_scene_set_ambient: scene or ambient is NULL");
    }
    status = gnoi_check_colour(context, "scene", "ambient", ambient, DBL_MAX);
    if (status == GNO_OK) {
        fill(scene->ambient, ambient[0], ambient[1], ambient[2]);
    }
    return status;
}

void gno_scene_ambient(const gno_scene *scene, double ambient[3])
{
    if (ambient) {
        fill(ambient, scene ? scene->ambient[0] : 0, scene ? scene->ambient[1] : 0, scene ? scene->ambient[2] : 0);
    }
}

/* ---- reading back ---------------------------------------------------------------------------------------------- */

gno_scene_counts gno_scene_count(const gno_scene *scene)
{
    gno_scene_counts counts;
    memset(&counts, 0, sizeof counts);
    if (scene) {
        counts.vertices = scene->vertex_count;
        counts.polygons = scene->polygon_count;
        counts.rings = scene->ring_count;
        counts.corners = scene->corner_count;
        counts.normals = scene->normal_count;
        counts.texcoords = scene->texcoord_count;
        counts.materials = scene->material_count;
        counts.lights = scene->light_count;
        counts.objects = scene->object_count;
        counts.images = scene->image_count;
    }
    return counts;
}

int gno_scene_bounds(const gno_scene *scene, double lower[3], double upper[3])
{
    size_t corner;
    int i;
    fill(lower, 0, 0, 0);
    fill(upper, 0, 0, 0);
    if (!scene || scene->corner_count == 0) {
        return 0;
    }
    for (i = 0; i < 3; i++) {
        lower[i] = upper[i] = scene->positions[scene->corner_vertex[0]][i];
    }
    for (corner = 1; corner < scene->corner_count; corner++) {
        const double *p = scene->positions[scene->corner_vertex[corner]];
        for (i = 0; i < 3; i++) {
            lower[i] = p[i] < lower[i] ? p[i] : lower[i];
            upper[i] = p[i] > upper[i] ? p[i] : upper[i];
        }
    }
    return 1;
}

gno_status gno_scene_polygon(const gno_scene *scene, size_t index, gno_polygon *polygon)
{
    gno_context *context = gno_scene_context(scene);
    const gnoi_object *object;
    unsigned ring;
    if (!scene || !polygon) {
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "gno_scene_polygon: scene or polygon is NULL");
    }
    if (index >= scene->polygon_count) {
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "polygon %zu of %zu", index, scene->polygon_count);
    }
    ring = scene->polygon_start[index];
    object = &scene->objects[scene->polygon_object[index]];
    polygon->ring_count = scene->polygon_start[index + 1] - ring;
    polygon->ring_start = scene->ring_start + ring;
    polygon->corner_vertex = scene->corner_vertex;
    polygon->corner_normal = scene->corner_normal;
    polygon->corner_texcoord = scene->corner_texcoord;
    polygon->positions = (const double *)scene->positions;
    polygon->normals = (const double *)scene->normals;
    polygon->texcoords = (const double *)scene->texcoords;
    polygon->material = scene->polygon_material[index];
    polygon->object = scene->polygon_object[index];
    polygon->shading = object->shading >= 0 ? object->shading : (int)scene->materials[polygon->material].shading;
    polygon->priority = object->priority;
    polygon->detail_of = object->detail_of;
    return GNO_OK;
}
