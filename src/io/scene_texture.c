/* scene_texture.c -- `texture` and `bump` of a material. Place: see scene_yaml.h.
 *
 * A picture that is missing is a warning, and the material keeps its plain colour; everything else that is wrong is an error.
 */
#include "io/scene_yaml.h"

#include <stdio.h>
#include <string.h>

static const char *const maps[] = {"uv", "planar", "cylindrical", "spherical", NULL};       /* by gno_texture_map */
static const char *const wraps[] = {"repeat", "clamp", "mirror", "none", NULL};              /* by gno_wrap */
static const char *const filters[] = {"box", "linear", NULL};                                /* by gno_texture_filter */
static const char *const kinds[] = {"height", "normal", NULL};

typedef struct texture_entry {
    const char *image;
    gno_texture texture;
    int map, wrap, filter, kind;
    double amount;
} texture_entry;

#define AT(member) offsetof(texture_entry, texture) + offsetof(gno_texture, member)

enum { IMAGE, MAP, ORIGIN, U, V, CORNERS, SCALE, WRAP, FILTER, TEXTURE_FIELDS, AMOUNT = TEXTURE_FIELDS, KIND, BUMP_FIELDS };

static const gnoi_field fields[BUMP_FIELDS] = {
    [IMAGE] = {.key = "image", .kind = GNOI_FIELD_TEXT, .offset = offsetof(texture_entry, image)},
    [MAP] = {.key = "map", .kind = GNOI_FIELD_CHOICE, .offset = offsetof(texture_entry, map), .choices = maps},
    [ORIGIN] = {.key = "origin", .kind = GNOI_FIELD_POINT, .offset = AT(origin)},
    [U] = {.key = "u", .kind = GNOI_FIELD_DIRECTION, .offset = AT(u)},
    [V] = {.key = "v", .kind = GNOI_FIELD_DIRECTION, .offset = AT(v)},
    [CORNERS] = {.key = "corners", .kind = GNOI_FIELD_NODE},
    [SCALE] = {.key = "scale", .kind = GNOI_FIELD_NODE},
    [WRAP] = {.key = "wrap", .kind = GNOI_FIELD_CHOICE, .offset = offsetof(texture_entry, wrap), .choices = wraps},
    [FILTER] = {.key = "filter", .kind = GNOI_FIELD_CHOICE, .offset = offsetof(texture_entry, filter), .choices = filters},
    [AMOUNT] = {.key = "amount", .kind = GNOI_FIELD_NUMBER, .offset = offsetof(texture_entry, amount)},
    [KIND] = {.key = "kind", .kind = GNOI_FIELD_CHOICE, .offset = offsetof(texture_entry, kind), .choices = kinds},
};

gno_status gnoi_read_pair(const gnoi_yaml *yaml, const gnoi_yaml_node *node, double pair[2])
{
    gno_status status = gnoi_need_list(yaml, node);
    if (status == GNO_OK && node->count != 2) {
        return gnoi_yaml_fail(yaml, node, GNO_ERROR_INPUT, "must have 2 numbers, has %lu", (unsigned long)node->count);
    }
    for (const gnoi_yaml_node *n = status == GNO_OK ? node->first : NULL; n && status == GNO_OK; n = n->next) {
        status = gnoi_read_number(yaml, n, pair++);
    }
    return status;
}

/* One number or two, none of them zero. */
gno_status gnoi_read_scale(const gnoi_yaml *yaml, const gnoi_yaml_node *node, double scale[2])
{
    int is_list = node->kind == GNOI_YAML_SEQUENCE;
    gno_status status = is_list ? gnoi_read_pair(yaml, node, scale) : gnoi_read_number(yaml, node, &scale[0]);
    if (status != GNO_OK) return status;
    if (!is_list) scale[1] = scale[0];
    for (int i = 0; i < 2; i++) {
        const gnoi_yaml_node *number = !is_list ? node : i == 0 ? node->first : node->first->next;
        if (scale[i] == 0) return gnoi_yaml_fail(yaml, number, GNO_ERROR_INPUT, "0 is no scale");
    }
    return GNO_OK;
}

/* [[s0, t0], [s1, t1]] */
static gno_status read_corners(const gnoi_yaml *yaml, const gnoi_yaml_node *node, double corners[2][2])
{
    gno_status status = gnoi_need_list(yaml, node);
    if (status == GNO_OK && node->count != 2) {
        return gnoi_yaml_fail(yaml, node, GNO_ERROR_INPUT, "must have 2 corners, has %lu", (unsigned long)node->count);
    }
    for (int i = 0; i < 2 && status == GNO_OK; i++) {
        status = gnoi_read_pair(yaml, i == 0 ? node->first : node->first->next, corners[i]);
    }
    if (status == GNO_OK && (corners[0][0] == corners[1][0] || corners[0][1] == corners[1][1])) {
        return gnoi_yaml_fail(yaml, node, GNO_ERROR_INPUT, "the corners span no area");
    }
    return status;
}

/* Where the pattern lies: the map's own axes where none are given; `planar` where origin or axes are given and no map. */
static gno_status read_place(const gnoi_yaml *yaml, const gnoi_yaml_node *const *seen, texture_entry *entry)
{
    gno_texture read = entry->texture;
    int map = !seen[MAP] && entry->map == GNO_MAP_UV && (seen[ORIGIN] || seen[U] || seen[V]) ? GNO_MAP_PLANAR : entry->map;
    if (map == GNO_MAP_UV) {
        for (int i = ORIGIN; i <= V; i++) {
            if (seen[i]) return gnoi_yaml_fail(yaml, seen[i], GNO_ERROR_INPUT, "has no meaning for map: uv");
        }
    }
    if (seen[MAP]) {
        gno_texture own = gno_texture_default((gno_texture_map)map);
        if (!seen[U]) memcpy(read.u, own.u, sizeof own.u);
        if (!seen[V]) memcpy(read.v, own.v, sizeof own.v);
        if (!seen[ORIGIN]) memcpy(read.origin, own.origin, sizeof own.origin);
        memcpy(read.corners, own.corners, sizeof own.corners);
    }
    read.map = (gno_texture_map)map;
    read.wrap = (gno_wrap)entry->wrap;
    read.filter = (gno_texture_filter)entry->filter;
    entry->texture = read;
    if (seen[CORNERS]) {
        gno_status status = read_corners(yaml, seen[CORNERS], entry->texture.corners);
        if (status != GNO_OK) return status;
    }
    return seen[SCALE] ? gnoi_read_scale(yaml, seen[SCALE], entry->texture.scale) : GNO_OK;
}

/* The picture into entry->texture; kind stays none where there is no picture. */
static gno_status read_picture(gnoi_scene_reader *reader, const gnoi_yaml_node *node, int is_colour, texture_entry *entry)
{
    char reason[GNOI_TEXTURE_REASON], text[GNOI_TEXTURE_REASON + 40];
    gnoi_texture_request request;
    memset(&request, 0, sizeof request);
    request.beside = reader->path;
    request.name = entry->image;
    request.is_colour = is_colour;
    reader->textures.scene = reader->scene;
    gno_status status = gnoi_textures_get(&reader->textures, &request, &entry->texture.image, reason);
    if (status != GNO_OK) return status;
    entry->texture.kind = entry->texture.image >= 0 ? GNO_TEXTURE_IMAGE : GNO_TEXTURE_NONE;
    if (entry->texture.image < 0) entry->texture.image = 0;
    if (reason[0]) {
        snprintf(text, sizeof text, "%s: drawn without it", reason);
        gnoi_yaml_warn(reader->yaml, node, text);
    }
    return GNO_OK;
}

/* Keys that only a procedural pattern has, beside `image`. */
static gno_status refuse_procedural(const gnoi_yaml *yaml, const gnoi_yaml_node *node)
{
    static const char *const keys[] = {"light", "dark", "rings", "seed"};
    const gnoi_yaml_node *found = gnoi_yaml_find(node, "procedural");
    if (found) return gnoi_yaml_fail(yaml, found, GNO_ERROR_INPUT, "stands beside image, only one of the two can be had");
    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++) {
        found = gnoi_yaml_find(node, keys[i]);
        if (found) return gnoi_yaml_fail(yaml, found, GNO_ERROR_INPUT, "has no meaning for an image");
    }
    return GNO_OK;
}

static texture_entry start(const gno_texture *from)
{
    texture_entry entry;
    memset(&entry, 0, sizeof entry);
    entry.texture = *from;
    entry.map = (int)from->map;
    entry.wrap = (int)from->wrap;
    entry.filter = (int)from->filter;
    entry.amount = 1;
    return entry;
}

gno_status gnoi_read_texture(gnoi_scene_reader *reader, const gnoi_yaml_node *node, gno_texture *texture)
{
    const gnoi_yaml_node *seen[TEXTURE_FIELDS];
    texture_entry entry = start(texture);
    gno_status status = gnoi_need_mapping(reader->yaml, node);
    if (status == GNO_OK && gnoi_yaml_find(node, "image")) status = refuse_procedural(reader->yaml, node);
    else if (status == GNO_OK && gnoi_yaml_find(node, "procedural")) return gnoi_read_procedural(reader, node, texture);
    if (status == GNO_OK) status = gnoi_read_fields(reader->yaml, node, fields, TEXTURE_FIELDS, &entry, seen);
    if (status == GNO_OK && !seen[IMAGE]) return gnoi_yaml_fail(reader->yaml, node, GNO_ERROR_INPUT, "needs image or procedural");
    if (status == GNO_OK) status = read_place(reader->yaml, seen, &entry);
    if (status == GNO_OK) status = read_picture(reader, seen[IMAGE], 1, &entry);
    if (status == GNO_OK) *texture = entry.texture;
    return status;
}

gno_status gnoi_read_bump(gnoi_scene_reader *reader, const gnoi_yaml_node *node, const gno_texture *texture, gno_bump *bump)
{
    const gnoi_yaml_node *seen[BUMP_FIELDS];
    texture_entry entry = start(texture);
    gno_status status = gnoi_need_mapping(reader->yaml, node);
    if (status == GNO_OK && gnoi_yaml_find(node, "procedural") && !gnoi_yaml_find(node, "image")) {
        return gnoi_read_procedural_bump(reader, node, bump);
    }
    if (status == GNO_OK) status = gnoi_read_fields(reader->yaml, node, fields, BUMP_FIELDS, &entry, seen);
    if (status == GNO_OK && !seen[IMAGE]) return gnoi_yaml_fail_missing(reader->yaml, node, "image", "is missing");
    if (status == GNO_OK) status = read_place(reader->yaml, seen, &entry);
    if (status == GNO_OK) status = read_picture(reader, seen[IMAGE], 0, &entry);
    if (status != GNO_OK) return status;
    bump->texture = entry.texture;
    bump->amount = entry.amount;
    bump->kind = entry.texture.kind == GNO_TEXTURE_NONE ? GNO_BUMP_NONE : entry.kind == 0 ? GNO_BUMP_HEIGHT : GNO_BUMP_NORMAL;
    return GNO_OK;
}
