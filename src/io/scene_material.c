/* scene_material.c -- the section `materials`. Place: see scene_yaml.h.
 *
 * Textures, bumps, mirrors and refraction are part of the format but not of this version's pictures: they are checked in
 * full, so that a scene that loads today loads tomorrow, and gnoi_warn_undrawn says once that they are left out.
 */
#include "io/scene_yaml.h"

#include <stdio.h>
#include <string.h>

const char *const gnoi_shading_names[] = {"flat", "constant", "gouraud", "phong", NULL};

static const char *const maps[] = {"uv", "planar", "cylindrical", "spherical", NULL};

typedef struct material_entry {
    gno_material material;
    double reflection[3];
    double ior;
} material_entry;

#define AT(member) offsetof(material_entry, material) + offsetof(gno_material, member)

enum {
    AMBIENT, DIFFUSE, SPECULAR, SHININESS, TRANSMISSION, SHADING, TWO_SIDED, REFLECTION, IOR, TEXTURE, BUMP, FIELDS
};

static const gnoi_field fields[FIELDS] = {
    [AMBIENT] = {.key = "ambient", .kind = GNOI_FIELD_COLOUR, .offset = AT(ambient)},
    [DIFFUSE] = {.key = "diffuse", .kind = GNOI_FIELD_COLOUR, .offset = AT(diffuse)},
    [SPECULAR] = {.key = "specular", .kind = GNOI_FIELD_COLOUR, .offset = AT(specular)},
    [SHININESS] = {.key = "shininess", .kind = GNOI_FIELD_FROM_0, .offset = AT(shininess)},
    [TRANSMISSION] = {.key = "transmission", .kind = GNOI_FIELD_SHARE, .offset = AT(transmission)},
    [SHADING] = {.key = "shading", .kind = GNOI_FIELD_CHOICE, .offset = AT(shading), .choices = gnoi_shading_names},
    [TWO_SIDED] = {.key = "two_sided", .kind = GNOI_FIELD_BOOL, .offset = AT(two_sided)},
    [REFLECTION] = {.key = "reflection", .kind = GNOI_FIELD_SHARE, .offset = offsetof(material_entry, reflection)},
    [IOR] = {.key = "ior", .kind = GNOI_FIELD_ABOVE_0, .offset = offsetof(material_entry, ior)},
    [TEXTURE] = {.key = "texture", .kind = GNOI_FIELD_NODE},
    [BUMP] = {.key = "bump", .kind = GNOI_FIELD_NODE},
};

/* ---- texture and bump: checked only ------------------------------------------------------------------------------------- */

typedef struct texture_entry {
    const char *image;
    int map, seed;
    double origin[3], u[3], v[3], light[3], dark[3], rings;
} texture_entry;

enum { T_IMAGE, T_MAP, T_PROCEDURAL, T_LIGHT, T_DARK, T_RINGS, T_SEED, T_ORIGIN, T_U, T_V, T_SCALE, T_FIELDS };

static const gnoi_field texture_fields[T_FIELDS] = {
    [T_IMAGE] = {.key = "image", .kind = GNOI_FIELD_TEXT, .offset = offsetof(texture_entry, image)},
    [T_MAP] = {.key = "map", .kind = GNOI_FIELD_CHOICE, .offset = offsetof(texture_entry, map), .choices = maps},
    [T_PROCEDURAL] = {.key = "procedural", .kind = GNOI_FIELD_NODE},
    [T_LIGHT] = {.key = "light", .kind = GNOI_FIELD_COLOUR, .offset = offsetof(texture_entry, light)},
    [T_DARK] = {.key = "dark", .kind = GNOI_FIELD_COLOUR, .offset = offsetof(texture_entry, dark)},
    [T_RINGS] = {.key = "rings", .kind = GNOI_FIELD_ABOVE_0, .offset = offsetof(texture_entry, rings)},
    [T_SEED] = {.key = "seed", .kind = GNOI_FIELD_INTEGER, .offset = offsetof(texture_entry, seed), .high = 2147483647},
    [T_ORIGIN] = {.key = "origin", .kind = GNOI_FIELD_POINT, .offset = offsetof(texture_entry, origin)},
    [T_U] = {.key = "u", .kind = GNOI_FIELD_DIRECTION, .offset = offsetof(texture_entry, u)},
    [T_V] = {.key = "v", .kind = GNOI_FIELD_DIRECTION, .offset = offsetof(texture_entry, v)},
    [T_SCALE] = {.key = "scale", .kind = GNOI_FIELD_NODE},
};

/* One number or two, none of them zero. */
static gno_status check_texture_scale(const gnoi_yaml *yaml, const gnoi_yaml_node *node)
{
    const gnoi_yaml_node *number = node;
    if (node->kind == GNOI_YAML_SEQUENCE) {
        if (node->count != 2) {
            return gnoi_yaml_fail(yaml, node, GNO_ERROR_INPUT, "must have 2 numbers, has %lu", (unsigned long)node->count);
        }
        number = node->first;
    }
    for (; number; number = number == node ? NULL : number->next) {
        double value;
        gno_status status = gnoi_read_number(yaml, number, &value);
        if (status != GNO_OK) return status;
        if (value == 0) return gnoi_yaml_fail(yaml, number, GNO_ERROR_INPUT, "0 is no scale");
    }
    return GNO_OK;
}

static gno_status check_texture(const gnoi_yaml *yaml, const gnoi_yaml_node *node)
{
    texture_entry entry;
    const gnoi_yaml_node *seen[T_FIELDS];
    gno_status status = gnoi_read_fields(yaml, node, texture_fields, T_FIELDS, &entry, seen);
    if (status != GNO_OK) return status;
    if (!seen[T_IMAGE] && !seen[T_PROCEDURAL]) {
        return gnoi_yaml_fail(yaml, node, GNO_ERROR_INPUT, "needs image or procedural");
    }
    if (seen[T_IMAGE] && seen[T_PROCEDURAL]) {
        return gnoi_yaml_fail(yaml, seen[T_PROCEDURAL], GNO_ERROR_INPUT, "stands beside image, only one of the two can be had");
    }
    for (int i = T_LIGHT; i <= T_SEED; i++) {
        if (seen[T_IMAGE] && seen[i]) return gnoi_yaml_fail(yaml, seen[i], GNO_ERROR_INPUT, "has no meaning for an image");
    }
    return seen[T_SCALE] ? check_texture_scale(yaml, seen[T_SCALE]) : GNO_OK;
}

typedef struct bump_entry {
    const char *image;
    double amount;
} bump_entry;

static gno_status check_bump(const gnoi_yaml *yaml, const gnoi_yaml_node *node)
{
    static const gnoi_field bump_fields[] = {
        {.key = "image", .kind = GNOI_FIELD_TEXT, .offset = offsetof(bump_entry, image)},
        {.key = "amount", .kind = GNOI_FIELD_NUMBER, .offset = offsetof(bump_entry, amount)},
    };
    bump_entry entry;
    const gnoi_yaml_node *seen[2];
    gno_status status = gnoi_read_fields(yaml, node, bump_fields, 2, &entry, seen);
    if (status != GNO_OK) return status;
    return seen[0] ? GNO_OK : gnoi_yaml_fail_missing(yaml, node, "image", "is missing");
}

/* ---- materials ---------------------------------------------------------------------------------------------------------- */

static void note_undrawn(gnoi_scene_reader *reader, const material_entry *entry, const gnoi_yaml_node *const *seen)
{
    if (seen[TEXTURE] && entry->material.texture.kind == GNO_TEXTURE_NONE) reader->undrawn |= GNOI_UNDRAWN_TEXTURE;
    if (seen[BUMP]) reader->undrawn |= GNOI_UNDRAWN_BUMP;
    if (entry->reflection[0] > 0 || entry->reflection[1] > 0 || entry->reflection[2] > 0) {
        reader->undrawn |= GNOI_UNDRAWN_REFLECTION;
    }
    if (entry->ior != 1) reader->undrawn |= GNOI_UNDRAWN_IOR;
}

static gno_status read_material(gnoi_scene_reader *reader, const gnoi_yaml_node *node)
{
    const gnoi_yaml_node *seen[FIELDS];
    material_entry entry;
    int index = 0;
    memset(&entry, 0, sizeof entry);
    entry.material = gno_material_default();
    entry.ior = 1;
    gno_status status = gnoi_read_fields(reader->yaml, node, fields, FIELDS, &entry, seen);
    const gnoi_yaml_node *texture = status == GNO_OK ? seen[TEXTURE] : NULL;
    int procedural = texture && texture->kind == GNOI_YAML_MAPPING && gnoi_yaml_find(texture, "procedural") && !gnoi_yaml_find(texture, "image");
    if (procedural) status = gnoi_read_procedural(reader, texture, &entry.material.texture);
    else if (texture) status = check_texture(reader->yaml, texture);
    if (status == GNO_OK && seen[BUMP]) status = check_bump(reader->yaml, seen[BUMP]);
    if (status != GNO_OK) return status;
    note_undrawn(reader, &entry, seen);
    status = gnoi_wrap(reader->yaml, node, gno_scene_add_material(reader->scene, &entry.material, &index));
    if (status == GNO_OK) status = gno_scene_set_material_name(reader->scene, index, node->key);
    if (status != GNO_OK) return status;
    gnoi_name *name = &reader->materials.items[reader->materials.count++];
    name->name = node->key;
    name->value = index;
    return GNO_OK;
}

gno_status gnoi_read_materials(gnoi_scene_reader *reader, const gnoi_yaml_node *node)
{
    if (!node || gnoi_yaml_is_null(node)) return GNO_OK;
    gno_status status = gnoi_need_mapping(reader->yaml, node);
    if (status == GNO_OK) status = gnoi_names_create(reader->context, node->count, &reader->materials);
    for (const gnoi_yaml_node *child = node->first; child && status == GNO_OK; child = child->next) {
        status = read_material(reader, child);
    }
    gnoi_names_sort(&reader->materials);
    return status;
}

void gnoi_warn_undrawn(const gnoi_scene_reader *reader)
{
    static const char *const names[] = {"texture", "bump", "reflection", "ior"};
    char text[1400] = "", list[128] = "";
    for (int i = 0; i < 4; i++) {
        if (!(reader->undrawn >> i & 1)) continue;
        size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%s", used ? ", " : "", names[i]);
    }
    if (!*list) return;
    snprintf(text, sizeof text, "%.400s: read and checked, but not drawn by this version: %s", reader->path, list);
    gno_context_log(reader->context, GNO_LOG_WARNING, text);
}
