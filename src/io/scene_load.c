/* scene_load.c -- gno_scene_load: a scene file or a mesh file, told apart by the extension.
 *
 * Place: the file library's door for scenes.
 *
 *   path, settings --> tree of the file (of nothing, for a mesh file) with the settings --+--> scene_yaml.c (.yaml .yml)
 *                                                                                         +--> scene_mesh.c (.obj .ply ...)
 */
#include "io/file_name.h"
#include "io/scene_yaml.h"

#include <gnomon/gnomon_io.h>
#include <stdio.h>
#include <string.h>

typedef enum file_kind { FILE_UNKNOWN, FILE_SCENE, FILE_MESH } file_kind;

static file_kind kind_of(const char *path)
{
    static const char *const meshes[] = {".obj", ".ply", ".stl", ".gltf", ".glb"};
    if (gnoi_has_extension(path, ".yaml") || gnoi_has_extension(path, ".yml")) return FILE_SCENE;
    for (size_t i = 0; i < sizeof meshes / sizeof *meshes; i++) {
        if (gnoi_has_extension(path, meshes[i])) return FILE_MESH;
    }
    return FILE_UNKNOWN;
}

static gno_status fail_kind(gno_context *context, const char *path)
{
    char message[512], shown[GNOI_YAML_SHOWN];
    snprintf(message, sizeof message, "%.300s: \"%s\" is not one of .yaml, .yml, .obj, .ply, .stl, .gltf, .glb", path,
             gnoi_yaml_show(gnoi_extension(path), shown));
    return gno_context_fail(context, GNO_ERROR_INPUT, message);
}

static gno_status load_yaml(gno_context *context, gnoi_yaml *yaml, const char *path, gno_scene **scene)
{
    gno_status status = gno_scene_create(context, scene);
    if (status == GNO_OK) status = gnoi_scene_read_yaml(*scene, yaml, path);
    if (status != GNO_OK) {
        gno_scene_destroy(*scene);
        *scene = NULL;
    }
    return status;
}

gno_status gno_scene_load(gno_context *context, const char *path, const gno_setting *settings, size_t setting_count,
                          gno_scene **scene)
{
    gnoi_yaml *yaml = NULL;
    if (scene) *scene = NULL;
    if (!context) return GNO_ERROR_ARGUMENT;
    if (!path || !scene || (!settings && setting_count > 0)) {
        return gno_context_fail(context, GNO_ERROR_ARGUMENT, "gno_scene_load: path, scene or settings is NULL");
    }
    file_kind kind = kind_of(path);
    if (kind == FILE_UNKNOWN) return fail_kind(context, path);
    gno_status status = gnoi_yaml_create(context, path, &yaml);
    if (status == GNO_OK && kind == FILE_SCENE) status = gnoi_yaml_load(yaml);
    for (size_t i = 0; i < setting_count && status == GNO_OK; i++) {
        status = gnoi_yaml_set(yaml, settings[i].key, settings[i].value);
    }
    if (status == GNO_OK) {
        status = kind == FILE_SCENE ? load_yaml(context, yaml, path, scene) : gnoi_scene_read_mesh(context, yaml, path, scene);
    }
    gnoi_yaml_destroy(yaml);
    return status;
}
