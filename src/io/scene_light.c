/* scene_light.c -- the section `lights`. Place: see scene_yaml.h.
 *
 * A key that has no meaning for the light's type is an error: a light that is not what it looks like is hard to find.
 */
#include "io/scene_yaml.h"

#include <stdio.h>
#include <string.h>

static const char *const light_types[] = {"point", "directional", "spot", "area", NULL};
static const char *const falloffs[] = {"none", "linear", "inverse_square", NULL};
static const char *const distances[] = {"light", "viewer", NULL}; /* by gno_light.distance_from_viewer */

typedef struct light_entry {
    gno_light light;
    const char *name;
} light_entry;

enum { NAME, TYPE, POSITION, DIRECTION, EDGE1, EDGE2, ANGLE, INTENSITY, FALLOFF, K, DISTANCE, SAMPLES, SOFTNESS, FIELDS };

/* An area light of 64 x 64 points is as many lights as a scene may have. */
enum { MAX_SAMPLES = 64 };

#define AT(member) offsetof(light_entry, light) + offsetof(gno_light, member)

static const gnoi_field fields[FIELDS] = {
    [NAME] = {.key = "name", .kind = GNOI_FIELD_TEXT, .offset = offsetof(light_entry, name)},
    [TYPE] = {.key = "type", .kind = GNOI_FIELD_CHOICE, .offset = AT(type), .choices = light_types},
    [POSITION] = {.key = "position", .kind = GNOI_FIELD_POINT, .offset = AT(position)},
    [DIRECTION] = {.key = "direction", .kind = GNOI_FIELD_DIRECTION, .offset = AT(direction)},
    [EDGE1] = {.key = "edge1", .kind = GNOI_FIELD_DIRECTION, .offset = AT(edge1)},
    [EDGE2] = {.key = "edge2", .kind = GNOI_FIELD_DIRECTION, .offset = AT(edge2)},
    [ANGLE] = {.key = "angle", .kind = GNOI_FIELD_INSIDE, .offset = AT(angle), .high = 180},
    [INTENSITY] = {.key = "intensity", .kind = GNOI_FIELD_COLOUR, .offset = AT(intensity)},
    [FALLOFF] = {.key = "falloff", .kind = GNOI_FIELD_CHOICE, .offset = AT(falloff), .choices = falloffs},
    [K] = {.key = "k", .kind = GNOI_FIELD_FROM_0, .offset = AT(falloff_k)},
    [DISTANCE] = {.key = "distance", .kind = GNOI_FIELD_CHOICE, .offset = AT(distance_from_viewer), .choices = distances},
    [SAMPLES] = {.key = "samples", .kind = GNOI_FIELD_INTEGER, .offset = AT(samples), .low = 1, .high = MAX_SAMPLES},
    [SOFTNESS] = {.key = "softness", .kind = GNOI_FIELD_FROM_0, .offset = AT(softness)},
};

/* Which types have the keys that not all types have, and which of these they cannot do without. */
static const struct {
    int field, types, needed;
} uses[] = {
    {POSITION, 1 << GNO_LIGHT_POINT | 1 << GNO_LIGHT_SPOT | 1 << GNO_LIGHT_AREA, 1},
    {DIRECTION, 1 << GNO_LIGHT_DIRECTIONAL | 1 << GNO_LIGHT_SPOT, 1},
    {EDGE1, 1 << GNO_LIGHT_AREA, 1},
    {EDGE2, 1 << GNO_LIGHT_AREA, 1},
    {ANGLE, 1 << GNO_LIGHT_SPOT, 0},
    {SAMPLES, 1 << GNO_LIGHT_AREA, 0},
};

static gno_status check_uses(const gnoi_yaml *yaml, const gnoi_yaml_node *node, const gno_light *light,
                             const gnoi_yaml_node *const *seen)
{
    char what[96];
    const char *type = light_types[light->type];
    const char *article = light->type == GNO_LIGHT_AREA ? "an" : "a";
    for (size_t i = 0; i < sizeof uses / sizeof *uses; i++) {
        const gnoi_yaml_node *given = seen[uses[i].field];
        int has = uses[i].types >> light->type & 1;
        if (given && !has) {
            return gnoi_yaml_fail(yaml, given, GNO_ERROR_INPUT, "has no meaning for %s %s light", article, type);
        }
        if (!given && has && uses[i].needed) {
            snprintf(what, sizeof what, "is missing, %s %s light needs it", article, type);
            return gnoi_yaml_fail_missing(yaml, node, fields[uses[i].field].key, what);
        }
    }
    if (light->type == GNO_LIGHT_DIRECTIONAL && seen[FALLOFF] &&
        (light->falloff == GNO_FALLOFF_INVERSE_SQUARE ||
         (light->falloff == GNO_FALLOFF_LINEAR && !light->distance_from_viewer))) {
        return gnoi_yaml_fail(yaml, seen[FALLOFF], GNO_ERROR_INPUT,
                              "a directional light has no distance; only falloff: linear with distance: viewer can be had");
    }
    return GNO_OK;
}

static gno_status read_light(gnoi_scene_reader *reader, const gnoi_yaml_node *node, unsigned long index, light_entry *entry)
{
    const gnoi_yaml_node *seen[FIELDS];
    char numbered[32];
    memset(entry, 0, sizeof *entry);
    entry->light = gno_light_default();
    gno_status status = gnoi_read_fields(reader->yaml, node, fields, FIELDS, entry, seen);
    if (status == GNO_OK) status = check_uses(reader->yaml, node, &entry->light, seen);
    if (status != GNO_OK) return status;
    snprintf(numbered, sizeof numbered, "light%lu", index);
    status = gno_scene_add_light(reader->scene, entry->name ? entry->name : numbered, &entry->light, NULL);
    return gnoi_wrap(reader->yaml, node, status);
}

/* The scene keeps the names: a light added under a name that an earlier one has is found by asking it. */
static gno_status check_name(gnoi_scene_reader *reader, const gnoi_yaml_node *node, int index)
{
    const char *name = "", *other;
    char shown[GNOI_YAML_SHOWN];
    gno_status status = gno_scene_light(reader->scene, index, NULL, &name);
    for (int i = 0; i < index && status == GNO_OK; i++) {
        status = gno_scene_light(reader->scene, i, NULL, &other);
        if (status == GNO_OK && !strcmp(name, other)) {
            const gnoi_yaml_node *at = gnoi_yaml_find(node, "name");
            return gnoi_yaml_fail(reader->yaml, at ? at : node, GNO_ERROR_INPUT, "\"%s\" is already the name of lights[%d]",
                                  gnoi_yaml_show(name, shown), i);
        }
    }
    return status;
}

gno_status gnoi_read_lights(gnoi_scene_reader *reader, const gnoi_yaml_node *node)
{
    if (!node || gnoi_yaml_is_null(node)) return GNO_OK;
    gno_status status = gnoi_need_list(reader->yaml, node);
    if (status != GNO_OK) return status;
    if (node->count > GNO_MAX_LIGHTS) {
        return gnoi_yaml_fail(reader->yaml, node, GNO_ERROR_LIMIT, "has %lu lights, at most %d can be had",
                              (unsigned long)node->count, GNO_MAX_LIGHTS);
    }
    int index = 0;
    for (const gnoi_yaml_node *child = node->first; child && status == GNO_OK; child = child->next, index++) {
        light_entry entry;
        status = read_light(reader, child, (unsigned long)index, &entry);
        if (status == GNO_OK) status = check_name(reader, child, index);
    }
    return status;
}
