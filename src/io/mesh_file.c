/* mesh_file.c -- one door for all mesh files: picks the reader by extension, and hands meshes to the scene.
 *
 * Place: called by scene_yaml.c (object entries) and scene_load.c (a mesh file as a scene); calls obj.c or assimp_mesh.c.
 */
#include "file_name.h"
#include "mesh_util.h"
#include <string.h>

gnoi_mesh_options gnoi_mesh_options_default(void)
{
    gno_mesh_def def = gno_mesh_def_default();
    gnoi_mesh_options options;
    memset(&options, 0, sizeof options);
    options.material = -1;
    options.shading = -1;
    options.average_normals = def.average_normals;
    options.crease = def.crease;
    options.weighting = def.weighting;
    memcpy(options.transform, def.transform, sizeof options.transform);
    options.priority = def.priority;
    return options;
}

gno_mesh_def gnoi_mesh_def_for(const gnoi_mesh_options *options)
{
    gno_mesh_def def = gno_mesh_def_default();
    def.name = options->name;
    if (options->material >= 0) def.material = options->material;
    def.shading = options->shading;
    def.average_normals = options->average_normals;
    def.crease = options->crease;
    def.weighting = options->weighting;
    memcpy(def.transform, options->transform, sizeof def.transform);
    def.priority = options->priority;
    def.find_details = options->find_details;
    return def;
}

gno_status gnoi_mesh_blame(gno_scene *scene, const char *path, gno_status status)
{
    gno_context *context = gno_scene_context(scene);
    char text[512];
    const char *message = gno_context_message(context);
    size_t length = strlen(message);
    if (length >= sizeof text) length = sizeof text - 1;
    memcpy(text, message, length); /* the message is about to be overwritten */
    text[length] = '\0';
    if (status == GNO_ERROR_ARGUMENT) status = GNO_ERROR_INPUT;
    return gnoi_mesh_fail(context, status, path, 0, "%s", text);
}

gno_status gnoi_mesh_add(gno_scene *scene, const char *path, const gno_mesh_def *def, gnoi_mesh_result *result)
{
    size_t first = 0;
    gno_status status = gno_scene_add_mesh(scene, def, &first);
    if (status != GNO_OK) return gnoi_mesh_blame(scene, path, status);
    if (result->polygon_count == 0) result->first_polygon = first;
    result->polygon_count += def->polygon_count;
    return GNO_OK;
}

gno_status gnoi_mesh_load(gno_scene *scene, const char *path, const gnoi_mesh_options *options, gnoi_mesh_result *result)
{
    gnoi_mesh_options defaults = gnoi_mesh_options_default();
    gnoi_mesh_result ignored;
    if (!options) options = &defaults;
    if (!result) result = &ignored;
    memset(result, 0, sizeof *result);
    gno_status status = gnoi_has_extension(path, ".obj") ? gnoi_obj_load(scene, path, options, result)
                                     : gnoi_assimp_load(scene, path, options, result);
    if (status != GNO_OK) return status;
    if (result->polygon_count == 0)
        return gnoi_mesh_fail(gno_scene_context(scene), GNO_ERROR_INPUT, path, 0, "holds no polygons");
    return GNO_OK;
}
