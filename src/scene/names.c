/* names.c -- names of materials and objects: nothing is drawn by them, but reports and drawings carry them.
 *
 * Place in the data flow: file readers -> gno_scene -> gno_scene_material_name, gno_scene_object_name -> drawings, tables.
 */
#include "scene/scene.h"

#include <string.h>

static gno_status reserve_names(gno_scene *scene, size_t count)
{
    gnoi_name_text *names;
    if (count <= scene->material_name_count) {
        return GNO_OK;
    }
    names = gnoi_realloc(scene->context, scene->material_names, scene->material_name_count, count, sizeof *names);
    if (!names) {
        return gnoi_fail(scene->context, GNO_ERROR_MEMORY, "scene: out of memory");
    }
    memset(names + scene->material_name_count, 0, (count - scene->material_name_count) * sizeof *names);
    scene->material_names = names;
    scene->material_name_count = count;
    return GNO_OK;
}

gno_status gno_scene_set_material_name(gno_scene *scene, int index, const char *name)
{
    size_t size = name ? strlen(name) + 1 : 0;
    gnoi_name_text text = {NULL, size};
    gno_status status;
    if (!scene) {
        return GNO_ERROR_ARGUMENT;
    }
    if (index < 0 || (size_t)index >= scene->material_count) {
        return gnoi_fail(scene->context, GNO_ERROR_ARGUMENT, "gno_scene_set_material_name: there is no material %d", index);
    }
    status = reserve_names(scene, scene->material_count);
    if (status) {
        return status;
    }
    if (size > 0) {
        text.text = gnoi_malloc(scene->context, size, 1);
        if (!text.text) {
            return gnoi_fail(scene->context, GNO_ERROR_MEMORY, "scene: out of memory");
        }
        memcpy(text.text, name, size);
    }
    gnoi_free(scene->context, scene->material_names[index].text, scene->material_names[index].size, 1);
    scene->material_names[index] = text;
    return GNO_OK;
}

const char *gno_scene_material_name(const gno_scene *scene, int index)
{
    if (!scene || index < 0 || (size_t)index >= scene->material_name_count || !scene->material_names[index].text) {
        return "";
    }
    return scene->material_names[index].text;
}

const char *gno_scene_object_name(const gno_scene *scene, int index)
{
    if (!scene || index < 0 || (size_t)index >= scene->object_count || !scene->objects[index].name) {
        return "";
    }
    return scene->objects[index].name;
}

void gnoi_scene_free_names(gno_scene *scene)
{
    for (size_t i = 0; i < scene->material_name_count; i++) {
        gnoi_free(scene->context, scene->material_names[i].text, scene->material_names[i].size, 1);
    }
    gnoi_free(scene->context, scene->material_names, scene->material_name_count, sizeof *scene->material_names);
}
