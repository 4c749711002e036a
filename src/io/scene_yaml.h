/* scene_yaml.h -- the scene file's reader, one file a section.
 *
 * Place: tree of the file with its settings -> sections -> gno_scene_add_..., gno_scene_set_...
 *
 *   scene_yaml.c    whole file: order of sections, version, image, ambient
 *   scene_camera.c  camera            scene_material.c  materials; scene_texture.c: their texture and bump,
 *                                     scene_procedural.c where these are patterns
 *   scene_light.c   lights            scene_object.c    objects: reading, names, details' priorities
 *                                     scene_shape.c     one object's polygons: mesh file, polygon, sphere;
 *                                     scene_terrain.c: terrain
 *                                     scene_transform.c transform lists
 *   scene_load.c    gno_scene_load; scene_mesh.c: a mesh file as a scene
 * Everything is read and checked before the first mesh file is opened.
 */
#ifndef GNOI_IO_SCENE_YAML_H
#define GNOI_IO_SCENE_YAML_H

#include "io/texture_file.h"
#include "io/yaml_value.h"

/* Names sorted for searching; value is an index in whatever was named. */
typedef struct gnoi_name {
    const char *name;
    int value;
} gnoi_name;

typedef struct gnoi_names {
    gnoi_name *items; /* sorted by name, then value */
    size_t count, capacity;
} gnoi_names;

/* What a scene asked for that this version does not draw. */
enum { GNOI_UNDRAWN_REFLECTION = 1, GNOI_UNDRAWN_IOR = 2 };

typedef struct gnoi_scene_reader {
    gno_context *context;
    const gnoi_yaml *yaml;
    const char *path; /* of the scene file: mesh paths are relative to it */
    gno_scene *scene;
    gnoi_names materials;
    gnoi_textures textures; /* pictures read for them */
    unsigned undrawn;
} gnoi_scene_reader;

/* One entry of `objects`, checked. */
typedef struct gnoi_object_entry {
    const gnoi_yaml_node *node;
    const gnoi_yaml_node *polygon, *holes, *uv, *sphere, *terrain, *mesh_node; /* one kind of object is not NULL */
    const gnoi_yaml_node *detail_node;                          /* of detail_of, or NULL */
    const char *mesh, *name, *material_name, *detail_of;
    int material; /* scene index, -1: none named */
    int shading;  /* a gno_shading, or -1: as the material says */
    int average_normals;
    int weighting;
    double crease;
    double transform[12];
    int priority;
    int parent; /* index of the object that this one is a detail of, or -1 */
    int find_details;
    size_t first_object, object_count, first_polygon; /* what the entry added to the scene */
} gnoi_object_entry;

/* ---- sections: target structures keep what the section does not give -------------------------------------------------- */

gno_status gnoi_read_image(const gnoi_yaml *yaml, const gnoi_yaml_node *node, gno_image_def *image);
gno_status gnoi_read_ambient(const gnoi_yaml *yaml, const gnoi_yaml_node *node, double ambient[3]);
gno_status gnoi_read_camera(const gnoi_yaml *yaml, const gnoi_yaml_node *node, gno_camera *camera);
/* The camera's `path`, if its section has one; the scene has the camera already. */
gno_status gnoi_read_camera_path(const gnoi_yaml *yaml, const gnoi_yaml_node *camera_node, gno_scene *scene);
gno_status gnoi_read_lights(gnoi_scene_reader *reader, const gnoi_yaml_node *node);
gno_status gnoi_read_materials(gnoi_scene_reader *reader, const gnoi_yaml_node *node);

/* scene_procedural.c: `texture` and `bump` with a key `procedural`. */
gno_status gnoi_read_procedural(gnoi_scene_reader *reader, const gnoi_yaml_node *node, gno_texture *texture);
gno_status gnoi_read_procedural_bump(gnoi_scene_reader *reader, const gnoi_yaml_node *node, gno_bump *bump);
gno_status gnoi_read_objects(gnoi_scene_reader *reader, const gnoi_yaml_node *node);
gno_status gnoi_read_transform(const gnoi_yaml *yaml, const gnoi_yaml_node *node, double transform[12]);

/* `texture` and `bump` over what the structures hold; a bump lies as the texture does where it does not say otherwise. */
gno_status gnoi_read_texture(gnoi_scene_reader *reader, const gnoi_yaml_node *node, gno_texture *texture);
gno_status gnoi_read_bump(gnoi_scene_reader *reader, const gnoi_yaml_node *node, const gno_texture *texture, gno_bump *bump);
gno_status gnoi_read_pair(const gnoi_yaml *yaml, const gnoi_yaml_node *node, double pair[2]);
gno_status gnoi_read_scale(const gnoi_yaml *yaml, const gnoi_yaml_node *node, double scale[2]);

/* Adds the polygons of one object, its priority settled. */
gno_status gnoi_add_shape(gnoi_scene_reader *reader, const gnoi_object_entry *entry);

/* scene_terrain.c: reads the mapping `terrain` and adds it; look: all else that the object says. */
gno_status gnoi_add_terrain(gnoi_scene_reader *reader, const gnoi_yaml_node *node, const gno_mesh_def *look);

/* One warning about all that is not drawn yet, if there is anything. */
void gnoi_warn_undrawn(const gnoi_scene_reader *reader);

extern const char *const gnoi_shading_names[]; /* by gno_shading, NULL at the end */

/* ---- helpers ------------------------------------------------------------------------------------------------------------ */

/* After a call of the engine or of the mesh reader for `node`: puts the place in front of their message. */
gno_status gnoi_wrap(const gnoi_yaml *yaml, const gnoi_yaml_node *node, gno_status status);

/* Room for count names; then fill items, set count and sort. Freed by gnoi_scene_names_free. */
gno_status gnoi_names_create(gno_context *context, size_t count, gnoi_names *names);
void gnoi_scene_names_free(gno_context *context, gnoi_names *names);
void gnoi_names_sort(gnoi_names *names);
/* The first of that name, or NULL. */
const gnoi_name *gnoi_names_find(const gnoi_names *names, const char *name);
/* Fails with: there is no <what> "name", did you mean "nearest"? */
gno_status gnoi_names_fail(const gnoi_yaml *yaml, const gnoi_yaml_node *node, const gnoi_names *names, const char *what,
                           const char *name);

/* ---- whole files -------------------------------------------------------------------------------------------------------- */

/* Fill an empty scene; the caller destroys it when they fail. */
gno_status gnoi_scene_read_yaml(gno_scene *scene, gnoi_yaml *yaml, const char *path);
gno_status gnoi_scene_read_mesh(gno_context *context, const gnoi_yaml *yaml, const char *path, gno_scene **scene);

#endif
