/* scene_path.c -- the section `camera.path`: a turntable, or keys. Place: see scene_yaml.h; after the camera that it starts from. */
#include "io/scene_yaml.h"

#include <gnomon/gnomon_path.h>
#include <string.h>

static const char *const path_types[] = {"turntable", "keys", NULL};
static const char *const interpolations[] = {"linear", "smooth", NULL};

enum { TYPE, FRAMES, AXIS, CENTER, ANGLE, INTERPOLATION, KEYS, FIELDS };

static const gnoi_field fields[FIELDS] = {
    [TYPE] = {.key = "type", .kind = GNOI_FIELD_CHOICE, .offset = offsetof(gno_camera_path, type), .choices = path_types},
    [FRAMES] = {.key = "frames", .kind = GNOI_FIELD_INTEGER, .offset = offsetof(gno_camera_path, frames), .low = 1, .high = GNO_MAX_FRAMES},
    [AXIS] = {.key = "axis", .kind = GNOI_FIELD_DIRECTION, .offset = offsetof(gno_camera_path, axis)},
    [CENTER] = {.key = "center", .kind = GNOI_FIELD_POINT, .offset = offsetof(gno_camera_path, centre)},
    [ANGLE] = {.key = "angle", .kind = GNOI_FIELD_NUMBER, .offset = offsetof(gno_camera_path, angle)},
    [INTERPOLATION] = {.key = "interpolation", .kind = GNOI_FIELD_CHOICE, .offset = offsetof(gno_camera_path, interpolation),
                       .choices = interpolations},
    [KEYS] = {.key = "keys", .kind = GNOI_FIELD_NODE},
};

enum { KEY_FRAME, KEY_EYE, KEY_TARGET, KEY_UP, KEY_FOV, KEY_HEIGHT, KEY_FIELDS };

static const gnoi_field key_fields[KEY_FIELDS] = {
    [KEY_FRAME] = {.key = "frame", .kind = GNOI_FIELD_INTEGER, .offset = offsetof(gno_camera_key, frame), .low = 0, .high = GNO_MAX_FRAMES - 1},
    [KEY_EYE] = {.key = "eye", .kind = GNOI_FIELD_POINT, .offset = offsetof(gno_camera_key, eye)},
    [KEY_TARGET] = {.key = "target", .kind = GNOI_FIELD_POINT, .offset = offsetof(gno_camera_key, target)},
    [KEY_UP] = {.key = "up", .kind = GNOI_FIELD_DIRECTION, .offset = offsetof(gno_camera_key, up)},
    [KEY_FOV] = {.key = "fov", .kind = GNOI_FIELD_INSIDE, .offset = offsetof(gno_camera_key, fov), .high = 180},
    [KEY_HEIGHT] = {.key = "height", .kind = GNOI_FIELD_ABOVE_0, .offset = offsetof(gno_camera_key, height)},
};

/* Keys of the table that the other type of path has no use for. */
static gno_status check_uses(const gnoi_yaml *yaml, const gnoi_yaml_node *const *seen, gno_path_type type)
{
    static const int turntable[] = {AXIS, CENTER, ANGLE}, keys[] = {INTERPOLATION, KEYS};
    const int *other = type == GNO_PATH_TURNTABLE ? keys : turntable;
    size_t count = type == GNO_PATH_TURNTABLE ? sizeof keys / sizeof *keys : sizeof turntable / sizeof *turntable;
    for (size_t i = 0; i < count; i++) {
        if (seen[other[i]]) return gnoi_yaml_fail(yaml, seen[other[i]], GNO_ERROR_INPUT, "has no meaning for a path of type %s", path_types[type]);
    }
    return GNO_OK;
}

/* What a key does not give is as in the key before; in the first as in the camera. */
static gno_status read_keys(const gnoi_yaml *yaml, const gnoi_yaml_node *node, const gno_camera *camera, gno_camera_key *keys)
{
    gno_camera_key key;
    gno_status status = GNO_OK;
    size_t i = 0;
    memset(&key, 0, sizeof key);
    memcpy(key.eye, camera->eye, sizeof key.eye);
    memcpy(key.target, camera->target, sizeof key.target);
    memcpy(key.up, camera->up, sizeof key.up);
    key.fov = camera->fov;
    key.height = camera->height;
    for (const gnoi_yaml_node *child = node->first; child && status == GNO_OK; child = child->next, i++) {
        const gnoi_yaml_node *seen[KEY_FIELDS];
        status = gnoi_read_fields(yaml, child, key_fields, KEY_FIELDS, &key, seen);
        if (status != GNO_OK) return status;
        if (!seen[KEY_FRAME]) return gnoi_yaml_fail_missing(yaml, child, "frame", "is missing, every key has its frame");
        if (i > 0 && key.frame <= keys[i - 1].frame) {
            return gnoi_yaml_fail(yaml, seen[KEY_FRAME], GNO_ERROR_INPUT, "%d is not after %d, the frame of the key before", key.frame,
                                  keys[i - 1].frame);
        }
        keys[i] = key;
    }
    return status;
}

static gno_status set_keys(gno_scene *scene, const gnoi_yaml *yaml, const gnoi_yaml_node *node, const gnoi_yaml_node *const *seen,
                           gno_camera_path *path)
{
    gno_context *context = gno_scene_context(scene);
    const gnoi_yaml_node *list = seen[KEYS];
    gno_camera camera = gno_scene_camera(scene);
    gno_camera_key *keys;
    gno_status status = list ? gnoi_need_list(yaml, list) : gnoi_yaml_fail_missing(yaml, node, "keys", "is missing, a path of type keys needs it");
    if (status != GNO_OK) return status;
    if (list->count == 0) return gnoi_yaml_fail(yaml, list, GNO_ERROR_INPUT, "has no key");
    if (list->count > GNO_MAX_KEYS)
        return gnoi_yaml_fail(yaml, list, GNO_ERROR_LIMIT, "has %lu keys, at most %d can be had", (unsigned long)list->count, GNO_MAX_KEYS);
    size_t bytes = (size_t)list->count * sizeof *keys;
    keys = gno_context_realloc(context, NULL, 0, bytes);
    if (!keys) return gno_context_fail(context, GNO_ERROR_MEMORY, "out of memory while reading a scene file");
    status = read_keys(yaml, list, &camera, keys);
    if (status == GNO_OK) {
        path->keys = keys;
        path->key_count = list->count;
        if (!seen[FRAMES]) path->frames = keys[list->count - 1].frame + 1;
        status = gnoi_wrap(yaml, node, gno_scene_set_camera_path(scene, path));
    }
    gno_context_realloc(context, keys, bytes, 0);
    return status;
}

gno_status gnoi_read_camera_path(const gnoi_yaml *yaml, const gnoi_yaml_node *camera_node, gno_scene *scene)
{
    const gnoi_yaml_node *node = gnoi_yaml_find(camera_node, "path"), *seen[FIELDS];
    gno_camera_path path = gno_camera_path_default();
    gno_camera camera = gno_scene_camera(scene);
    gno_status status;
    if (!node || gnoi_yaml_is_null(node)) return GNO_OK;
    memcpy(path.axis, camera.up, sizeof path.axis);
    memcpy(path.centre, camera.target, sizeof path.centre);
    status = gnoi_need_mapping(yaml, node);
    if (status != GNO_OK) return status;
    if (gnoi_yaml_find(node, "keys")) path.type = GNO_PATH_KEYS; /* unless it says otherwise */
    status = gnoi_read_fields(yaml, node, fields, FIELDS, &path, seen);
    if (status == GNO_OK) status = check_uses(yaml, seen, path.type);
    if (status != GNO_OK) return status;
    if (path.type == GNO_PATH_KEYS) return set_keys(scene, yaml, node, seen, &path);
    return gnoi_wrap(yaml, node, gno_scene_set_camera_path(scene, &path));
}
