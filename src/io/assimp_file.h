/* assimp_file.h -- one file as assimp has read it, on its way into the scene. Internal to assimp_*.c.
 *
 *   file -- assimp --> aiScene -- assimp_mesh.c: nodes, meshes -- assimp_material.c --> gno_mesh_defs, materials
 *                              -- assimp_view.c: camera, lights --------------------> the scene's
 *
 * assimp keeps coordinates as floats: a file with doubles loses the digits beyond seven. Everything after it is in doubles.
 */
#ifndef GNOI_IO_ASSIMP_FILE_H
#define GNOI_IO_ASSIMP_FILE_H

#include "mesh_util.h"
#include "texture_file.h"
#include <assimp/scene.h>

typedef struct gnoi_assimp {
    gno_scene *scene;
    gno_context *context;
    const char *path;
    const gnoi_mesh_options *options;
    gnoi_mesh_result *result;
    const struct aiScene *file;
    int is_gltf;        /* spot angles are half the cone, intensities are candela and lux */
    int is_geometry;    /* PLY, STL, OFF: materials are made up by assimp */
    int is_stl;         /* normals are those of the triangles */
    int *material_index; /* scene material of each of the file's, -1 not there yet */
    gnoi_textures textures;
} gnoi_assimp;

/* Rows of a 3x4 matrix, as gno_mesh_def has it. */
typedef struct gnoi_affine {
    double m[12];
} gnoi_affine;

/* outer after inner, a node's own transform. */
gnoi_affine gnoi_assimp_compose(const gnoi_affine *outer, const struct aiMatrix4x4 *inner);

/* The scene's index for one of the file's materials, added when first asked for; -1 after a failure (status set). */
int gnoi_assimp_material(gnoi_assimp *a, unsigned number, gno_status *status);

/* Sets the camera and adds the lights, as the options say; to be called after the meshes, as the lights' brightness
 * follows the scene's bounds. */
gno_status gnoi_assimp_camera(gnoi_assimp *a);
gno_status gnoi_assimp_lights(gnoi_assimp *a);

#endif
