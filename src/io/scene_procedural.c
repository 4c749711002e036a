/* scene_procedural.c -- `procedural` textures and bumps of the section `materials`. Place: see scene_yaml.h.
 *
 * The pattern's name is read first: it decides the defaults and which keys have a meaning.
 */
#include "io/scene_yaml.h"

#include <stddef.h>
#include <string.h>

static const char *const pattern_names[] = {"wood", "marble", "checker", "brick", "noise", "cloud", NULL}; /* by gno_pattern */
static const char *const weight_names[] = {"smooth", "linear", NULL};                                    /* by gno_noise_weight */

typedef struct procedural_entry {
    gno_procedural p;
    int pattern, seed, interpolation;
    double amount;
} procedural_entry;

/* Sets of patterns that a key has a meaning for. */
enum {
    WOOD = 1 << GNO_PATTERN_WOOD,
    MARBLE = 1 << GNO_PATTERN_MARBLE,
    CHECKER = 1 << GNO_PATTERN_CHECKER,
    BRICK = 1 << GNO_PATTERN_BRICK,
    NOISE = 1 << GNO_PATTERN_NOISE,
    CLOUD = 1 << GNO_PATTERN_CLOUD,
    NOISY = WOOD | MARBLE | NOISE | CLOUD,
    ALL = NOISY | CHECKER | BRICK
};

#define AT(member) .offset = offsetof(procedural_entry, member)

enum {
    PROCEDURAL, LIGHT, DARK, ORIGIN, AXIS, V, ACROSS, U, SCALE, SEED, RINGS, VEINS, DISTORTION, GRAIN, SHARPNESS, BRICK_SIZE, MORTAR,
    MORTAR_COLOUR, COVER, OCTAVES, GAIN, LACUNARITY, INTERPOLATION, FIELDS, AMOUNT = FIELDS, BUMP_FIELDS
};

static const struct {
    gnoi_field field;
    int patterns;
} keys[BUMP_FIELDS] = {
    [PROCEDURAL] = {{.key = "procedural", .kind = GNOI_FIELD_CHOICE, AT(pattern), .choices = pattern_names}, ALL},
    [LIGHT] = {{.key = "light", .kind = GNOI_FIELD_COLOUR, AT(p.light)}, ALL},
    [DARK] = {{.key = "dark", .kind = GNOI_FIELD_COLOUR, AT(p.dark)}, ALL},
    [ORIGIN] = {{.key = "origin", .kind = GNOI_FIELD_POINT, AT(p.origin)}, ALL},
    [AXIS] = {{.key = "axis", .kind = GNOI_FIELD_DIRECTION, AT(p.axis)}, ALL},
    [V] = {{.key = "v", .kind = GNOI_FIELD_DIRECTION, AT(p.axis)}, ALL},
    [ACROSS] = {{.key = "across", .kind = GNOI_FIELD_DIRECTION, AT(p.across)}, ALL},
    [U] = {{.key = "u", .kind = GNOI_FIELD_DIRECTION, AT(p.across)}, ALL},
    [SCALE] = {{.key = "scale", .kind = GNOI_FIELD_NODE}, ALL},
    [SEED] = {{.key = "seed", .kind = GNOI_FIELD_INTEGER, AT(seed), .high = 2147483647}, ALL},
    [RINGS] = {{.key = "rings", .kind = GNOI_FIELD_ABOVE_0, AT(p.rings)}, WOOD | MARBLE},
    [VEINS] = {{.key = "veins", .kind = GNOI_FIELD_ABOVE_0, AT(p.rings)}, MARBLE},
    [DISTORTION] = {{.key = "distortion", .kind = GNOI_FIELD_FROM_0, AT(p.distortion)}, WOOD | MARBLE},
    [GRAIN] = {{.key = "grain", .kind = GNOI_FIELD_BETWEEN, AT(p.grain), .high = 1}, WOOD},
    [SHARPNESS] = {{.key = "sharpness", .kind = GNOI_FIELD_INTEGER, AT(p.sharpness), .low = 1, .high = 8}, WOOD | MARBLE},
    [BRICK_SIZE] = {{.key = "brick", .kind = GNOI_FIELD_POINT, AT(p.brick)}, BRICK},
    [MORTAR] = {{.key = "mortar", .kind = GNOI_FIELD_FROM_0, AT(p.mortar)}, BRICK},
    [MORTAR_COLOUR] = {{.key = "mortar_colour", .kind = GNOI_FIELD_COLOUR, AT(p.mortar_colour)}, BRICK},
    [COVER] = {{.key = "cover", .kind = GNOI_FIELD_BETWEEN, AT(p.cover), .high = 1}, CLOUD},
    [OCTAVES] = {{.key = "octaves", .kind = GNOI_FIELD_INTEGER, AT(p.fractal.octaves), .low = 1, .high = 16}, NOISY},
    [GAIN] = {{.key = "gain", .kind = GNOI_FIELD_BETWEEN, AT(p.fractal.gain), .low = 1e-3, .high = 1}, NOISY},
    [LACUNARITY] = {{.key = "lacunarity", .kind = GNOI_FIELD_BETWEEN, AT(p.fractal.lacunarity), .low = 1.01, .high = 16}, NOISY},
    [INTERPOLATION] = {{.key = "interpolation", .kind = GNOI_FIELD_CHOICE, AT(interpolation), .choices = weight_names}, NOISY},
    [AMOUNT] = {{.key = "amount", .kind = GNOI_FIELD_NUMBER, AT(amount)}, ALL},
};

/* One number above 0 for all three axes, or three. */
static gno_status read_scale(const gnoi_yaml *yaml, const gnoi_yaml_node *node, double scale[3])
{
    static const gnoi_field above_0 = {.key = "scale", .kind = GNOI_FIELD_ABOVE_0};
    const gnoi_yaml_node *number = node;
    int i = 0;
    if (node->kind == GNOI_YAML_SEQUENCE) {
        if (node->count != 3) {
            return gnoi_yaml_fail(yaml, node, GNO_ERROR_INPUT, "must be one number or 3, has %lu", (unsigned long)node->count);
        }
        number = node->first;
    }
    for (; i < 3; i++) {
        gno_status status = gnoi_read_field(yaml, number, &above_0, &scale[i]);
        if (status != GNO_OK) return status;
        number = number == node ? node : number->next;
    }
    return GNO_OK;
}

static gno_status check_meanings(const gnoi_yaml *yaml, const gnoi_yaml_node *const *seen, int pattern)
{
    for (int i = 0; i < FIELDS; i++) {
        if (seen[i] && !(keys[i].patterns >> pattern & 1)) {
            return gnoi_yaml_fail(yaml, seen[i], GNO_ERROR_INPUT, "has no meaning for %s", pattern_names[pattern]);
        }
    }
    if (seen[RINGS] && seen[VEINS]) return gnoi_yaml_fail(yaml, seen[VEINS], GNO_ERROR_INPUT, "is another name of rings, give one of the two");
    if (seen[AXIS] && seen[V]) return gnoi_yaml_fail(yaml, seen[V], GNO_ERROR_INPUT, "is another name of axis, give one of the two");
    if (seen[ACROSS] && seen[U]) return gnoi_yaml_fail(yaml, seen[U], GNO_ERROR_INPUT, "is another name of across, give one of the two");
    return GNO_OK;
}

static gno_status refuse_mapping(const gnoi_yaml *yaml, const gnoi_yaml_node *node)
{
    static const char *const names[] = {"map", "corners", "wrap", "filter", "kind"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        const gnoi_yaml_node *found = gnoi_yaml_find(node, names[i]);
        if (found) return gnoi_yaml_fail(yaml, found, GNO_ERROR_INPUT, "has no meaning for a procedural texture");
    }
    return GNO_OK;
}

/* Another x where the frame's z lies nearest to it. */
static void choose_across(procedural_entry *entry)
{
    const double *z = entry->p.axis;
    double least = z[1] < 0 ? -z[1] : z[1], x = z[0] < 0 ? -z[0] : z[0], other = z[2] < 0 ? -z[2] : z[2];
    if (x > least && x > other) {
        entry->p.across[0] = 0;
        entry->p.across[1] = 1;
    }
}

static gno_status check_values(const gnoi_yaml *yaml, const gnoi_yaml_node *node, const gno_procedural *p)
{
    const char *wrong = NULL;
    if (gno_procedural_is_valid(p, &wrong)) return GNO_OK;
    if (!strcmp(wrong, "across")) return gnoi_yaml_fail(yaml, node, GNO_ERROR_INPUT, "axis and across are parallel");
    if (!strcmp(wrong, "brick")) return gnoi_yaml_fail(yaml, node, GNO_ERROR_INPUT, "a side of brick is not above 0");
    if (!strcmp(wrong, "mortar")) return gnoi_yaml_fail(yaml, node, GNO_ERROR_INPUT, "mortar is as wide as a brick");
    return gnoi_yaml_fail(yaml, node, GNO_ERROR_INPUT, "%s is out of range", wrong);
}

/* Reads the first `count` keys. */
static gno_status read_entry(const gnoi_yaml *yaml, const gnoi_yaml_node *node, int count, procedural_entry *entry)
{
    gnoi_field fields[BUMP_FIELDS];
    const gnoi_yaml_node *seen[BUMP_FIELDS], *name = gnoi_yaml_find(node, "procedural");
    gno_status status = refuse_mapping(yaml, node);
    memset(entry, 0, sizeof *entry);
    entry->amount = 1;
    for (int i = 0; i < count; i++) fields[i] = keys[i].field;
    if (status == GNO_OK && name) status = gnoi_read_field(yaml, name, &fields[PROCEDURAL], entry);
    if (status != GNO_OK) return status;
    entry->p = gno_procedural_default((gno_pattern)entry->pattern);
    status = gnoi_read_fields(yaml, node, fields, (size_t)count, entry, seen);
    if (status == GNO_OK) status = check_meanings(yaml, seen, entry->pattern);
    if (status == GNO_OK && seen[SCALE]) status = read_scale(yaml, seen[SCALE], entry->p.scale);
    if (status != GNO_OK) return status;
    if (!seen[ACROSS] && !seen[U]) choose_across(entry);
    entry->p.fractal.seed = (unsigned)entry->seed;
    entry->p.fractal.weight = (gno_noise_weight)entry->interpolation;
    return check_values(yaml, node, &entry->p);
}

gno_status gnoi_read_procedural(gnoi_scene_reader *reader, const gnoi_yaml_node *node, gno_texture *texture)
{
    procedural_entry entry;
    gno_status status = read_entry(reader->yaml, node, FIELDS, &entry);
    if (status != GNO_OK) return status;
    texture->kind = GNO_TEXTURE_PROCEDURAL;
    texture->procedural = entry.p;
    return GNO_OK;
}

gno_status gnoi_read_procedural_bump(gnoi_scene_reader *reader, const gnoi_yaml_node *node, gno_bump *bump)
{
    procedural_entry entry;
    gno_status status = read_entry(reader->yaml, node, BUMP_FIELDS, &entry);
    if (status != GNO_OK) return status;
    bump->kind = GNO_BUMP_HEIGHT;
    bump->amount = entry.amount;
    bump->texture.kind = GNO_TEXTURE_PROCEDURAL;
    bump->texture.procedural = entry.p;
    return GNO_OK;
}
