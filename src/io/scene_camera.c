/* scene_camera.c -- the section `camera`. Place: see scene_yaml.h; also for settings of a mesh file's default view. */
#include "io/scene_yaml.h"

#include <math.h>

/* Points nearer than this share of their coordinates are one, and directions whose sine is below the other are parallel (the
 * engine's own limit is a little below): the picture's axes would be made of rounding errors. */
#define SAME_POINT 1e-12
#define PARALLEL 3e-9

static const char *const camera_types[] = {"perspective", "orthographic", NULL};

enum { TYPE, EYE, TARGET, UP, FOV, HEIGHT, PATH, FIELDS };

static const gnoi_field fields[FIELDS] = {
    [TYPE] = {.key = "type", .kind = GNOI_FIELD_CHOICE, .offset = offsetof(gno_camera, type), .choices = camera_types},
    [EYE] = {.key = "eye", .kind = GNOI_FIELD_POINT, .offset = offsetof(gno_camera, eye)},
    [TARGET] = {.key = "target", .kind = GNOI_FIELD_POINT, .offset = offsetof(gno_camera, target)},
    [UP] = {.key = "up", .kind = GNOI_FIELD_DIRECTION, .offset = offsetof(gno_camera, up)},
    [FOV] = {.key = "fov", .kind = GNOI_FIELD_INSIDE, .offset = offsetof(gno_camera, fov), .high = 180},
    [HEIGHT] = {.key = "height", .kind = GNOI_FIELD_ABOVE_0, .offset = offsetof(gno_camera, height)},
    [PATH] = {.key = "path", .kind = GNOI_FIELD_NODE}, /* scene_path.c */
};

static double largest(const double v[3]) { return fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2]))); }

/* v scaled so that its largest component is 1: products of such vectors neither overflow nor vanish. */
static void level(const double v[3], double out[3])
{
    double size = largest(v);
    for (int i = 0; i < 3; i++) out[i] = v[i] / size;
}

static int are_parallel(const double a[3], const double b[3])
{
    double p[3], q[3];
    level(a, p);
    level(b, q);
    double cross[3] = {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
    return largest(cross) <= PARALLEL;
}

gno_status gnoi_read_camera(const gnoi_yaml *yaml, const gnoi_yaml_node *node, gno_camera *camera)
{
    const gnoi_yaml_node *seen[FIELDS];
    double view[3];
    gno_status status = gnoi_read_fields(yaml, node, fields, FIELDS, camera, seen);
    if (status != GNO_OK) return status;
    for (int i = 0; i < 3; i++) view[i] = camera->target[i] - camera->eye[i];
    if (!(largest(view) > SAME_POINT * fmax(largest(camera->eye), largest(camera->target)))) {
        const gnoi_yaml_node *at = seen[EYE] && seen[EYE]->set ? seen[EYE] : seen[TARGET] ? seen[TARGET] : seen[EYE];
        if (!at) at = node;
        return gnoi_yaml_fail(yaml, at, GNO_ERROR_INPUT, "eye and target are the same point");
    }
    if (are_parallel(view, camera->up)) {
        if (seen[UP]) return gnoi_yaml_fail(yaml, seen[UP], GNO_ERROR_INPUT, "is parallel to the view direction");
        return gnoi_yaml_fail(yaml, node, GNO_ERROR_INPUT, "up, [%g, %g, %g] unless given, is parallel to the view direction",
                              camera->up[0], camera->up[1], camera->up[2]);
    }
    return GNO_OK;
}
