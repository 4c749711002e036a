/* scene_material.c -- the section `materials`. Place: see scene_yaml.h.
 *
 * Mirrors and refraction are part of the format but not of this version's pictures: they are checked in
 * full, so that a scene that loads today loads tomorrow, and gnoi_warn_undrawn says once that they are left out.
 */
#include "io/scene_yaml.h"

#include <stdio.h>
#include <string.h>

const char *const gnoi_shading_names[] = {"flat", "constant", "gouraud", "phong", NULL};

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

/* ---- materials ---------------------------------------------------------------------------------------------------------- */

static void note_undrawn(gnoi_scene_reader *reader, const material_entry *entry)
{
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
    if (status == GNO_OK && seen[TEXTURE]) status = gnoi_read_texture(reader, seen[TEXTURE], &entry.material.texture);
    if (status == GNO_OK && seen[BUMP]) {
        status = gnoi_read_bump(reader, seen[BUMP], &entry.material.texture, &entry.material.bump);
    }
    if (status != GNO_OK) return status;
    note_undrawn(reader, &entry);
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
    static const char *const names[] = {"reflection", "ior"};
    char text[1400] = "", list[128] = "";
    for (int i = 0; i < 2; i++) {
        if (!(reader->undrawn >> i & 1)) continue;
        size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%s", used ? ", " : "", names[i]);
    }
    if (!*list) return;
    snprintf(text, sizeof text, "%.400s: read and checked, but not drawn by this version: %s", reader->path, list);
    gno_context_log(reader->context, GNO_LOG_WARNING, text);
}
