/* scene_yaml.c -- a whole scene file, section by section. Place: see scene_yaml.h; docs/scene-format.md is its user's view. */
#include "io/scene_yaml.h"

#include <string.h>

enum { GNOMON, IMAGE, CAMERA, AMBIENT, LIGHTS, MATERIALS, OBJECTS, FIELDS };

static const gnoi_field fields[FIELDS] = {
    [GNOMON] = {.key = "gnomon", .kind = GNOI_FIELD_NODE},   [IMAGE] = {.key = "image", .kind = GNOI_FIELD_NODE},
    [CAMERA] = {.key = "camera", .kind = GNOI_FIELD_NODE},   [AMBIENT] = {.key = "ambient", .kind = GNOI_FIELD_NODE},
    [LIGHTS] = {.key = "lights", .kind = GNOI_FIELD_NODE},   [MATERIALS] = {.key = "materials", .kind = GNOI_FIELD_NODE},
    [OBJECTS] = {.key = "objects", .kind = GNOI_FIELD_NODE},
};

gno_status gnoi_read_image(const gnoi_yaml *yaml, const gnoi_yaml_node *node, gno_image_def *image)
{
    static const gnoi_field image_fields[] = {
        {.key = "width", .kind = GNOI_FIELD_INTEGER, .offset = offsetof(gno_image_def, width), .low = 1,
         .high = GNO_MAX_IMAGE_SIDE},
        {.key = "height", .kind = GNOI_FIELD_INTEGER, .offset = offsetof(gno_image_def, height), .low = 1,
         .high = GNO_MAX_IMAGE_SIDE},
        {.key = "background", .kind = GNOI_FIELD_COLOUR, .offset = offsetof(gno_image_def, background)},
    };
    const gnoi_yaml_node *seen[3];
    return gnoi_read_fields(yaml, node, image_fields, 3, image, seen);
}

gno_status gnoi_read_ambient(const gnoi_yaml *yaml, const gnoi_yaml_node *node, double ambient[3])
{
    static const gnoi_field field = {.key = "ambient", .kind = GNOI_FIELD_COLOUR};
    return gnoi_read_field(yaml, node, &field, ambient);
}

static gno_status check_version(const gnoi_yaml *yaml, const gnoi_yaml_node *root, const gnoi_yaml_node *node)
{
    double version;
    char shown[GNOI_YAML_SHOWN];
    if (!node) return gnoi_yaml_fail_missing(yaml, root, "gnomon", "is missing, every scene file has the line gnomon: 1");
    gno_status status = gnoi_read_number(yaml, node, &version);
    if (status != GNO_OK || version == 1) return status;
    return gnoi_yaml_fail(yaml, node, GNO_ERROR_INPUT, "format version %s is not known, this program reads version 1",
                          gnoi_yaml_show(node->text, shown));
}

/* What needs no names: picture, ambient light, camera. */
static gno_status read_view(gnoi_scene_reader *reader, const gnoi_yaml_node *const *seen)
{
    gno_status status = GNO_OK;
    gno_image_def image = gno_scene_image(reader->scene);
    gno_camera camera = gno_scene_camera(reader->scene);
    double ambient[3];
    gno_scene_ambient(reader->scene, ambient);
    if (seen[IMAGE] && (status = gnoi_read_image(reader->yaml, seen[IMAGE], &image)) == GNO_OK) {
        status = gnoi_wrap(reader->yaml, seen[IMAGE], gno_scene_set_image(reader->scene, &image));
    }
    if (status != GNO_OK) return status;
    if (seen[CAMERA] && (status = gnoi_read_camera(reader->yaml, seen[CAMERA], &camera)) == GNO_OK) {
        status = gnoi_wrap(reader->yaml, seen[CAMERA], gno_scene_set_camera(reader->scene, &camera));
        if (status == GNO_OK) status = gnoi_read_camera_path(reader->yaml, seen[CAMERA], reader->scene);
    }
    if (status != GNO_OK) return status;
    if (seen[AMBIENT] && (status = gnoi_read_ambient(reader->yaml, seen[AMBIENT], ambient)) == GNO_OK) {
        status = gnoi_wrap(reader->yaml, seen[AMBIENT], gno_scene_set_ambient(reader->scene, ambient));
    }
    return status;
}

gno_status gnoi_scene_read_yaml(gno_scene *scene, gnoi_yaml *yaml, const char *path)
{
    const gnoi_yaml_node *seen[FIELDS], *root = gnoi_yaml_root(yaml);
    gnoi_scene_reader reader;
    memset(&reader, 0, sizeof reader);
    reader.context = gno_scene_context(scene);
    reader.yaml = yaml;
    reader.path = path;
    reader.scene = scene;
    if (gnoi_yaml_is_null(root)) return gnoi_yaml_fail(yaml, root, GNO_ERROR_INPUT, "the file is empty");
    if (root->kind != GNOI_YAML_MAPPING) return gnoi_yaml_fail(yaml, root, GNO_ERROR_INPUT, "not a scene file, it has no keys");
    /* The version first: keys that this program does not know may be right in another version. */
    gno_status status = check_version(yaml, root, gnoi_yaml_find(root, "gnomon"));
    if (status == GNO_OK) status = gnoi_read_fields(yaml, root, fields, FIELDS, NULL, seen);
    if (status == GNO_OK) status = read_view(&reader, seen);
    if (status == GNO_OK) status = gnoi_read_lights(&reader, seen[LIGHTS]);
    if (status == GNO_OK) status = gnoi_read_materials(&reader, seen[MATERIALS]);
    if (status == GNO_OK) status = gnoi_read_objects(&reader, seen[OBJECTS]);
    if (status == GNO_OK) gnoi_warn_undrawn(&reader);
    reader.textures.scene = scene;
    gnoi_textures_free(&reader.textures);
    gnoi_scene_names_free(reader.context, &reader.materials);
    return status;
}
