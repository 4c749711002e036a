/* scene_transform.c -- `transform` of an object: a list of steps, applied in order, as one 3x4 matrix. Place: see scene_yaml.h. */
#include "io/scene_yaml.h"

#include <math.h>
#include <string.h>

enum { SCALE, ROTATE, ANGLE, TRANSLATE, FIELDS };

typedef struct step {
    double rotate[3], angle, translate[3];
} step;

static const gnoi_field fields[FIELDS] = {
    [SCALE] = {.key = "scale", .kind = GNOI_FIELD_NODE},
    [ROTATE] = {.key = "rotate", .kind = GNOI_FIELD_DIRECTION, .offset = offsetof(step, rotate)},
    [ANGLE] = {.key = "angle", .kind = GNOI_FIELD_NUMBER, .offset = offsetof(step, angle)},
    [TRANSLATE] = {.key = "translate", .kind = GNOI_FIELD_POINT, .offset = offsetof(step, translate)},
};

/* One number, or three in a list; none of them zero. */
static gno_status read_scale(const gnoi_yaml *yaml, const gnoi_yaml_node *node, double scale[3])
{
    gno_status status;
    const gnoi_yaml_node *component = node;
    if (node->kind == GNOI_YAML_SEQUENCE) {
        status = gnoi_read_point(yaml, node, scale);
        component = node->first;
    } else {
        status = gnoi_read_number(yaml, node, &scale[0]);
        scale[1] = scale[2] = scale[0];
    }
    if (status != GNO_OK) return status;
    for (int i = 0; i < 3; i++) {
        if (fabs(scale[i]) < GNOI_ZERO_DIRECTION) {
            return gnoi_yaml_fail(yaml, component, GNO_ERROR_INPUT, "a scale of 0 leaves nothing");
        }
        if (component != node) component = component->next;
    }
    return GNO_OK;
}

/* Cosine and sine of degrees, exact at quarter turns, so that a turned box keeps its exact coordinates. */
static void turn(double degrees, double *cosine, double *sine)
{
    static const double quarter[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    double reduced = fmod(degrees, 360);
    if (reduced < 0) reduced += 360;
    if (fmod(reduced, 90) == 0) {
        int n = (int)(reduced / 90) % 4;
        *cosine = quarter[n][0];
        *sine = quarter[n][1];
        return;
    }
    double radians = reduced * (3.14159265358979323846 / 180);
    *cosine = cos(radians);
    *sine = sin(radians);
}

/* The rotation about an axis by the right-hand rule (Rodrigues): R = c 1 + (1-c) a a' + s [a]x. */
static void rotation(const double axis[3], double degrees, double m[12])
{
    double c, s, a[3], size = fmax(fabs(axis[0]), fmax(fabs(axis[1]), fabs(axis[2]))), length = 0;
    turn(degrees, &c, &s);
    for (int i = 0; i < 3; i++) length += axis[i] / size * (axis[i] / size);
    for (int i = 0; i < 3; i++) a[i] = axis[i] / size / sqrt(length);
    const double cross[3][3] = {{0, -a[2], a[1]}, {a[2], 0, -a[0]}, {-a[1], a[0], 0}};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) m[4 * i + j] = (i == j ? c : 0) + (1 - c) * a[i] * a[j] + s * cross[i][j];
        m[4 * i + 3] = 0;
    }
}

/* total = next * total: what came before is applied first. */
static void then(double total[12], const double next[12])
{
    double product[12];
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 4; j++) {
            product[4 * i + j] = next[4 * i] * total[j] + next[4 * i + 1] * total[4 + j] + next[4 * i + 2] * total[8 + j] +
                                 (j == 3 ? next[4 * i + 3] : 0);
        }
    }
    memcpy(total, product, sizeof product);
}

static void identity(double m[12])
{
    for (int i = 0; i < 12; i++) m[i] = i % 5 == 0;
}

static gno_status read_step(const gnoi_yaml *yaml, const gnoi_yaml_node *node, double total[12])
{
    const gnoi_yaml_node *seen[FIELDS];
    step entry;
    double m[12], scale[3];
    memset(&entry, 0, sizeof entry);
    gno_status status = gnoi_read_fields(yaml, node, fields, FIELDS, &entry, seen);
    if (status != GNO_OK) return status;
    if (seen[ROTATE] && !seen[ANGLE]) return gnoi_yaml_fail_missing(yaml, node, "angle", "is missing, rotate needs it");
    if (seen[ANGLE] && !seen[ROTATE]) return gnoi_yaml_fail_missing(yaml, node, "rotate", "is missing, angle needs it");
    if (!!seen[SCALE] + !!seen[ROTATE] + !!seen[TRANSLATE] != 1) {
        return gnoi_yaml_fail(yaml, node, GNO_ERROR_INPUT, "must be one of scale, rotate with angle, translate");
    }
    identity(m);
    if (seen[ROTATE]) rotation(entry.rotate, entry.angle, m);
    if (seen[SCALE]) {
        if ((status = read_scale(yaml, seen[SCALE], scale)) != GNO_OK) return status;
        for (int i = 0; i < 3; i++) m[5 * i] = scale[i];
    }
    for (int i = 0; i < 3 && seen[TRANSLATE]; i++) m[4 * i + 3] = entry.translate[i];
    then(total, m);
    for (int i = 0; i < 12; i++) {
        if (!isfinite(total[i])) return gnoi_yaml_fail(yaml, node, GNO_ERROR_INPUT, "makes numbers that are not finite");
    }
    return GNO_OK;
}

gno_status gnoi_read_transform(const gnoi_yaml *yaml, const gnoi_yaml_node *node, double transform[12])
{
    identity(transform);
    gno_status status = gnoi_need_list(yaml, node);
    for (const gnoi_yaml_node *child = node->first; child && status == GNO_OK; child = child->next) {
        status = read_step(yaml, child, transform);
    }
    return status;
}
