/* mesh_file.h -- mesh files in: OBJ+MTL by our own reader, PLY, STL, glTF and the rest through assimp.
 *
 * Place: between a path and gno_scene_add_mesh. scene_yaml.c calls it for an object entry of a scene file, scene_load.c for
 * a mesh file that stands alone as a scene. Needs public headers only.
 *
 *   path -- .obj --> obj.c (+ obj_parse.c numbers, mtl.c materials) --\
 *        -- rest --> assimp_mesh.c (+ assimp_view.c: camera, lights) ---+--> scene: materials, one or more meshes
 */
#ifndef GNOI_IO_MESH_FILE_H
#define GNOI_IO_MESH_FILE_H

#include <gnomon/gnomon.h>

/* How a scene file's object entry wants the mesh. */
typedef struct gnoi_mesh_options {
    int material;        /* >= 0: this scene material for all polygons; -1 (default): the file's own */
    int shading;         /* a gno_shading for all polygons, or -1 (default): as the materials say (the file's are flat) */
    int average_normals; /* as in gno_mesh_def, and so are the next four */
    double crease;
    gno_weighting weighting;
    double transform[12]; /* also applied to the file's camera and lights */
    int priority;
    int find_details;
    const char *name; /* NULL: the file's own object name where it has one */
    int take_camera;  /* 1: the file's first camera, where it has one, becomes the scene's; default 0 */
    int take_lights;  /* 1: the file's lights are added to the scene; default 0 */
} gnoi_mesh_options;

typedef struct gnoi_mesh_result {
    size_t first_polygon, polygon_count; /* the polygons added are consecutive */
    int has_camera;                      /* 1: the scene's camera was set from the file */
    int light_count;                     /* lights added */
} gnoi_mesh_result;

gnoi_mesh_options gnoi_mesh_options_default(void);

/* Reads a mesh file into the scene. options and result may be NULL. On failure the scene may hold some of the file's
 * materials, meshes and lights: the caller destroys it.
 * Errors: FILE (cannot be opened or read, or of no known format), INPUT ("path:line: what" or "path: what"), MEMORY, LIMIT. */
gno_status gnoi_mesh_load(gno_scene *scene, const char *path, const gnoi_mesh_options *options, gnoi_mesh_result *result);

#endif
