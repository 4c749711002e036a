/* scene_object.c -- the section `objects`. Place: see scene_yaml.h.
 *
 *   every entry read and checked -> names looked up, details' priorities added up -> scene_shape.c for each, in the file's order
 */
#include "io/scene_yaml.h"

#include <string.h>

static const char *const normals_names[] = {"file", "average", NULL};
static const char *const details_names[] = {"none", "coplanar", NULL};
static const char *const weighting_names[] = {"area", "angle", "equal", NULL}; /* by gno_weighting */

enum {
    MESH, POLYGON, SPHERE, TERRAIN, NAME, MATERIAL, SHADING, CREASE, NORMALS, WEIGHTING, TRANSFORM, HOLES, UV, DETAIL_OF, PRIORITY,
    DETAILS,
    FIELDS
};

/* The engine keeps a polygon's priority in 16 bits. */
enum { MOST_PRIORITY = 32767, LEAST_PRIORITY = -32768 };

#define AT(member) .offset = offsetof(gnoi_object_entry, member)

static const gnoi_field fields[FIELDS] = {
    [MESH] = {.key = "mesh", .kind = GNOI_FIELD_TEXT, AT(mesh)},
    [POLYGON] = {.key = "polygon", .kind = GNOI_FIELD_NODE},
    [SPHERE] = {.key = "sphere", .kind = GNOI_FIELD_NODE},
    [TERRAIN] = {.key = "terrain", .kind = GNOI_FIELD_NODE},
    [NAME] = {.key = "name", .kind = GNOI_FIELD_TEXT, AT(name)},
    [MATERIAL] = {.key = "material", .kind = GNOI_FIELD_TEXT, AT(material_name)},
    [SHADING] = {.key = "shading", .kind = GNOI_FIELD_CHOICE, AT(shading), .choices = gnoi_shading_names},
    [CREASE] = {.key = "crease", .kind = GNOI_FIELD_BETWEEN, AT(crease), .high = 180},
    [NORMALS] = {.key = "normals", .kind = GNOI_FIELD_CHOICE, AT(average_normals), .choices = normals_names},
    [WEIGHTING] = {.key = "weighting", .kind = GNOI_FIELD_CHOICE, AT(weighting), .choices = weighting_names},
    [TRANSFORM] = {.key = "transform", .kind = GNOI_FIELD_NODE},
    [HOLES] = {.key = "holes", .kind = GNOI_FIELD_NODE},
    [UV] = {.key = "uv", .kind = GNOI_FIELD_NODE},
    [DETAIL_OF] = {.key = "detail_of", .kind = GNOI_FIELD_TEXT, AT(detail_of)},
    [DETAILS] = {.key = "details", .kind = GNOI_FIELD_CHOICE, AT(find_details), .choices = details_names},
    [PRIORITY] = {.key = "priority", .kind = GNOI_FIELD_INTEGER, AT(priority), .low = LEAST_PRIORITY, .high = MOST_PRIORITY},
};

/* ---- one entry ---------------------------------------------------------------------------------------------------------- */

/* Exactly one of mesh, polygon, sphere, terrain; keys that belong to another kind are refused. */
static gno_status check_kind(const gnoi_yaml *yaml, const gnoi_yaml_node *node, const gnoi_yaml_node *const *seen)
{
    static const char *const articles[] = {"a mesh", "a polygon", "a sphere", "a terrain"};
    static const int mesh_only[] = {CREASE, NORMALS, WEIGHTING, DETAILS};
    int kind = -1;
    for (int i = MESH; i <= TERRAIN; i++) {
        if (!seen[i]) continue;
        if (kind >= 0) {
            return gnoi_yaml_fail(yaml, seen[i], GNO_ERROR_INPUT, "stands beside %s, an object is only one of the two",
                                  fields[kind].key);
        }
        kind = i;
    }
    if (kind < 0) return gnoi_yaml_fail(yaml, node, GNO_ERROR_INPUT, "needs one of mesh, polygon, sphere, terrain");
    if (seen[HOLES] && kind != POLYGON) {
        return gnoi_yaml_fail(yaml, seen[HOLES], GNO_ERROR_INPUT, "has no meaning for %s", articles[kind]);
    }
    if (seen[UV] && kind != POLYGON) return gnoi_yaml_fail(yaml, seen[UV], GNO_ERROR_INPUT, "has no meaning for %s", articles[kind]);
    for (int i = 0; i < 4 && kind != MESH; i++) {
        const gnoi_yaml_node *given = seen[mesh_only[i]];
        int averaged = kind == TERRAIN && mesh_only[i] != NORMALS && mesh_only[i] != DETAILS; /* its normals always are */
        if (given && !averaged) return gnoi_yaml_fail(yaml, given, GNO_ERROR_INPUT, "has no meaning for %s", articles[kind]);
    }
    return GNO_OK;
}

static gno_status find_material(gnoi_scene_reader *reader, const gnoi_yaml_node *node, gnoi_object_entry *entry)
{
    if (!node) return GNO_OK;
    const gnoi_name *found = gnoi_names_find(&reader->materials, entry->material_name);
    if (!found) return gnoi_names_fail(reader->yaml, node, &reader->materials, "material", entry->material_name);
    entry->material = found->value;
    return GNO_OK;
}

static gno_status read_entry(gnoi_scene_reader *reader, const gnoi_yaml_node *node, gnoi_object_entry *entry)
{
    static const double identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    const gnoi_yaml_node *seen[FIELDS];
    memset(entry, 0, sizeof *entry);
    memcpy(entry->transform, identity, sizeof identity);
    entry->material = entry->shading = entry->parent = -1;
    entry->crease = 180;
    gno_status status = gnoi_read_fields(reader->yaml, node, fields, FIELDS, entry, seen);
    if (status == GNO_OK) status = check_kind(reader->yaml, node, seen);
    if (status == GNO_OK) status = find_material(reader, seen[MATERIAL], entry);
    if (status == GNO_OK && seen[TRANSFORM]) status = gnoi_read_transform(reader->yaml, seen[TRANSFORM], entry->transform);
    entry->node = node;
    entry->mesh_node = seen[MESH];
    entry->polygon = seen[POLYGON];
    entry->holes = seen[HOLES];
    entry->uv = seen[UV];
    entry->sphere = seen[SPHERE];
    entry->terrain = seen[TERRAIN];
    entry->detail_node = seen[DETAIL_OF];
    return status;
}

/* ---- details ------------------------------------------------------------------------------------------------------------ */

static gno_status find_parent(gnoi_scene_reader *reader, const gnoi_names *names, gnoi_object_entry *entries, size_t index)
{
    gnoi_object_entry *entry = &entries[index];
    char shown[GNOI_YAML_SHOWN];
    const gnoi_name *found = gnoi_names_find(names, entry->detail_of);
    if (!found) return gnoi_names_fail(reader->yaml, entry->detail_node, names, "object", entry->detail_of);
    gnoi_yaml_show(entry->detail_of, shown);
    if (found + 1 < names->items + names->count && !strcmp(found[1].name, found->name)) {
        return gnoi_yaml_fail(reader->yaml, entry->detail_node, GNO_ERROR_INPUT,
                              "\"%s\" is the name of objects[%d] and objects[%d]", shown, found->value, found[1].value);
    }
    if (!entries[found->value].polygon) {
        return gnoi_yaml_fail(reader->yaml, entry->detail_node, GNO_ERROR_INPUT, "\"%s\" is not a polygon", shown);
    }
    entry->parent = found->value;
    return GNO_OK;
}

static gno_status find_parents(gnoi_scene_reader *reader, gnoi_object_entry *entries, size_t count)
{
    gnoi_names names;
    gno_status status = gnoi_names_create(reader->context, count, &names);
    if (status != GNO_OK) return status;
    for (size_t i = 0; i < count; i++) {
        if (!entries[i].name) continue;
        names.items[names.count].name = entries[i].name;
        names.items[names.count++].value = (int)i;
    }
    gnoi_names_sort(&names);
    for (size_t i = 0; i < count && status == GNO_OK; i++) {
        if (entries[i].detail_of) status = find_parent(reader, &names, entries, i);
    }
    gnoi_scene_names_free(reader->context, &names);
    return status;
}

/* Goes up from a detail to the first object whose priority is settled, reversing the links on the way, then down again:
 * a chain of any length without recursion and without memory. `way` marks entries on the present way. */
enum { OPEN, ON_THE_WAY, SETTLED };

static gno_status settle(gnoi_scene_reader *reader, gnoi_object_entry *entries, unsigned char *state, int start)
{
    int at = start, below = -1;
    while (state[at] == OPEN && entries[at].parent >= 0) {
        int above = entries[at].parent;
        state[at] = ON_THE_WAY;
        entries[at].parent = below;
        below = at;
        at = above;
    }
    if (state[at] == ON_THE_WAY) {
        return gnoi_yaml_fail(reader->yaml, entries[at].detail_node, GNO_ERROR_INPUT, "makes the object a detail of itself");
    }
    state[at] = SETTLED;
    while (below >= 0) {
        gnoi_object_entry *entry = &entries[below];
        int next = entry->parent, own = entry->priority > 1 ? entry->priority : 1;
        if (entries[at].priority > MOST_PRIORITY - own) {
            return gnoi_yaml_fail(reader->yaml, entry->node, GNO_ERROR_LIMIT, "its priority and its parents' add up to more than %d",
                                  MOST_PRIORITY);
        }
        entry->priority = entries[at].priority + own;
        entry->parent = at;
        state[below] = SETTLED;
        at = below;
        below = next;
    }
    return GNO_OK;
}

static gno_status settle_all(gnoi_scene_reader *reader, gnoi_object_entry *entries, size_t count)
{
    size_t size = count ? count : 1;
    unsigned char *state = gno_context_realloc(reader->context, NULL, 0, size);
    if (!state) return gno_context_fail(reader->context, GNO_ERROR_MEMORY, "out of memory while reading a scene file");
    memset(state, OPEN, size);
    gno_status status = GNO_OK;
    for (size_t i = 0; i < count && status == GNO_OK; i++) status = settle(reader, entries, state, (int)i);
    gno_context_realloc(reader->context, state, size, 0);
    return status;
}

/* Adds an entry's polygons and notes where in the scene they are. */
static gno_status add_entry(gnoi_scene_reader *reader, gnoi_object_entry *entry)
{
    gno_scene_counts before = gno_scene_count(reader->scene);
    gno_status status = gnoi_add_shape(reader, entry);
    entry->first_object = before.objects;
    entry->first_polygon = before.polygons;
    entry->object_count = gno_scene_count(reader->scene).objects - before.objects;
    return status;
}

/* Tells the scene what lies on what; a parent is one polygon. */
static gno_status link_detail(gnoi_scene_reader *reader, const gnoi_object_entry *entries, const gnoi_object_entry *entry)
{
    gno_status status = GNO_OK;
    for (size_t i = 0; i < entry->object_count && entry->parent >= 0 && status == GNO_OK; i++) {
        status = gno_scene_set_detail_of(reader->scene, entry->first_object + i, (int)entries[entry->parent].first_polygon);
    }
    return gnoi_wrap(reader->yaml, entry->detail_node, status);
}

/* ---- all entries -------------------------------------------------------------------------------------------------------- */

static gno_status read_entries(gnoi_scene_reader *reader, const gnoi_yaml_node *node, gnoi_object_entry *entries)
{
    gno_status status = GNO_OK;
    size_t count = 0;
    for (const gnoi_yaml_node *child = node->first; child && status == GNO_OK; child = child->next) {
        status = read_entry(reader, child, &entries[count++]);
    }
    if (status == GNO_OK) status = find_parents(reader, entries, count);
    if (status == GNO_OK) status = settle_all(reader, entries, count);
    for (size_t i = 0; i < count && status == GNO_OK; i++) status = add_entry(reader, &entries[i]);
    for (size_t i = 0; i < count && status == GNO_OK; i++) status = link_detail(reader, entries, &entries[i]);
    return status;
}

gno_status gnoi_read_objects(gnoi_scene_reader *reader, const gnoi_yaml_node *node)
{
    if (!node || gnoi_yaml_is_null(node)) return GNO_OK;
    gno_status status = gnoi_need_list(reader->yaml, node);
    if (status != GNO_OK || node->count == 0) return status;
    size_t size = node->count * sizeof(gnoi_object_entry);
    gnoi_object_entry *entries = gno_context_realloc(reader->context, NULL, 0, size);
    if (!entries) return gno_context_fail(reader->context, GNO_ERROR_MEMORY, "out of memory while reading a scene file");
    status = read_entries(reader, node, entries);
    gno_context_realloc(reader->context, entries, size, 0);
    return status;
}
