/* mesh_check.h -- a mesh on its way into the scene, and what is looked at before any of it is copied.
 *
 * Place: under gno_scene_add_mesh (mesh.c). Counts, arrays and options are judged here, the arrays' contents while they are copied.
 */
#ifndef GNOI_SCENE_MESH_CHECK_H
#define GNOI_SCENE_MESH_CHECK_H

#include "scene/scene.h"

#define GNOI_LABEL_SIZE 96

typedef struct gnoi_adding {
    gno_scene *scene;
    gno_context *context;
    const gno_mesh_def *mesh;
    size_t normal_count, texcoord_count; /* 0 where the array is NULL */
    char label[GNOI_LABEL_SIZE];              /* "mesh 'wall'" or "mesh 3", for messages */
} gnoi_adding;

/* Sets the label by the mesh's name, or its number. */
void gnoi_label_mesh(gnoi_adding *a);

/* Errors: ARGUMENT, LIMIT. */
gno_status gnoi_check_mesh(const gnoi_adding *a);

#endif
