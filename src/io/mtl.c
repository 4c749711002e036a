/* mtl.c -- material libraries (MTL) of an OBJ file.
 *
 * Place: under obj.c; hands gno_materials to the scene.
 *
 * Read as they stand: Ka, Kd, Ks (linear RGB; one number stands for three), Ns, and d or Tr as transmission 1-d or Tr,
 * the same for all channels. Without Kd the diffuse colour is 0.8, without Ka the ambient one is the diffuse one. `illum`
 * switches nothing off. Where both d and Tr are given d holds: exporters disagree about Tr. Pictures: mtl_map.h.
 */
#include "file_name.h"
#include "mtl.h"
#include "obj_parse.h"
#include <math.h>
#include <string.h>

enum { given_ambient = 1, given_diffuse = 2, given_opacity = 4 };
enum { not_in_scene = -1 };

typedef struct gnoi_mtl_entry {
    gno_material material;
    int defined;       /* 1: by a newmtl */
    int given;         /* given_... bits */
    int scene_index;
    size_t first_line; /* where the OBJ file uses it first; 0: nowhere yet */
    gnoi_mtl_map maps[GNOI_MTL_USES];
    int path; /* number of the library's path: where pictures are looked for */
} gnoi_mtl_entry;

/* One library being read. */
typedef struct reader {
    gnoi_mtl *mtl;
    const char *path;
    size_t line;
    int current; /* entry number, -1 before the first newmtl */
    int path_number;
} reader;

/* ---- the table ---------------------------------------------------------------------------------------------- */

static gnoi_mtl_entry *entry_at(const gnoi_mtl *mtl, int number)
{
    return (gnoi_mtl_entry *)mtl->entries.data + number;
}

static int number_of(gnoi_mtl *mtl, const char *name, size_t length)
{
    if (!gnoi_mesh_array_room(mtl->context, &mtl->entries, 1, sizeof(gnoi_mtl_entry))) return -1;
    int number = gnoi_names_number(mtl->context, &mtl->names, name, length);
    if (number < 0 || (size_t)number < mtl->entries.count) return number;
    gnoi_mtl_entry *entry = entry_at(mtl, number);
    memset(entry, 0, sizeof *entry);
    entry->material = gno_material_default();
    entry->scene_index = not_in_scene;
    mtl->entries.count++;
    return number;
}

int gnoi_mtl_number(gnoi_mtl *mtl, const char *name, size_t length, size_t line)
{
    int number = number_of(mtl, name, length);
    if (number >= 0 && entry_at(mtl, number)->first_line == 0) entry_at(mtl, number)->first_line = line;
    return number;
}

void gnoi_mtl_free(gnoi_mtl *mtl)
{
    gnoi_names_free(mtl->context, &mtl->names);
    gnoi_names_free(mtl->context, &mtl->libraries);
    gnoi_names_free(mtl->context, &mtl->paths);
    for (size_t i = 0; i < mtl->entries.count; i++)
        for (int use = 0; use < GNOI_MTL_USES; use++) gnoi_mtl_map_free(mtl->context, &entry_at(mtl, (int)i)->maps[use]);
    if (mtl->textures.scene) gnoi_textures_free(&mtl->textures);
    gnoi_mesh_array_free(mtl->context, &mtl->entries, sizeof(gnoi_mtl_entry));
}

/* ---- statements --------------------------------------------------------------------------------------------- */

static char lower(char c)
{
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

/* Keywords are compared without regard to case, as exporters write map_Kd, map_kd and MAP_KD. */
static int is_word(const char *p, const char *end, const char *word)
{
    for (; p < end && *word; p++, word++)
        if (lower(*p) != *word) return 0;
    return p == end && !*word;
}

static gno_status fail_number(const reader *r, const char *key, const char *p)
{
    gno_context *context = r->mtl->context;
    if (gnoi_parse_at_end(p))
        return gnoi_mesh_fail(context, GNO_ERROR_INPUT, r->path, r->line, "%s: a number is missing", key);
    const char *end = gnoi_parse_word(p);
    int length = end - p > 40 ? 40 : (int)(end - p);
    return gnoi_mesh_fail(context, GNO_ERROR_INPUT, r->path, r->line, "%s: \"%.*s\" is not a finite number", key, length, p);
}

/* Reads up to `most` numbers, at least one, into values; the number read in *count. */
static gno_status read_numbers(reader *r, const char *key, const char *p, int most, double *values, int *count)
{
    for (*count = 0; *count < most; ++*count) {
        p = gnoi_parse_blank(p, &r->line);
        if (*count > 0 && gnoi_parse_at_end(p)) return GNO_OK;
        const char *end = gnoi_parse_number(p, &values[*count]);
        if (end == p || !gnoi_parse_ends_word(*end) || !isfinite(values[*count])) return fail_number(r, key, p);
        p = end;
    }
    return GNO_OK;
}

static gno_status read_colour(reader *r, const char *key, const char *p, double colour[3], int *given)
{
    double values[3];
    int count = 0;
    p = gnoi_parse_blank(p, &r->line);
    const char *end = gnoi_parse_word(p);
    if (is_word(p, end, "spectral") || is_word(p, end, "xyz")) {
        gnoi_mesh_warn(r->mtl->context, r->path, r->line, "%s: only RGB colours are read", key);
        return GNO_OK;
    }
    gno_status status = read_numbers(r, key, p, 3, values, &count);
    if (status != GNO_OK) return status;
    if (count == 1) values[1] = values[2] = values[0];
    if (count == 2)
        return gnoi_mesh_fail(r->mtl->context, GNO_ERROR_INPUT, r->path, r->line, "%s: one or three numbers expected", key);
    for (int i = 0; i < 3; i++) {
        if (values[i] < 0)
            return gnoi_mesh_fail(r->mtl->context, GNO_ERROR_INPUT, r->path, r->line, "%s: %g is negative", key, values[i]);
        colour[i] = values[i];
    }
    *given = 1;
    return GNO_OK;
}

static gno_status read_shininess(reader *r, const char *p, gno_material *material)
{
    double value = 0;
    int count = 0;
    gno_status status = read_numbers(r, "Ns", p, 1, &value, &count);
    if (status != GNO_OK) return status;
    if (value < 0) return gnoi_mesh_fail(r->mtl->context, GNO_ERROR_INPUT, r->path, r->line, "Ns: %g is negative", value);
    material->shininess = value;
    return GNO_OK;
}

/* d (opacity) or Tr (its complement). */
static gno_status read_opacity(reader *r, const char *key, const char *p, gnoi_mtl_entry *entry)
{
    int is_opacity = key[0] == 'd';
    double value = 0;
    int count = 0;
    p = gnoi_parse_blank(p, &r->line);
    if (is_opacity && is_word(p, gnoi_parse_word(p), "-halo")) p = gnoi_parse_word(p);
    gno_status status = read_numbers(r, key, p, 1, &value, &count);
    if (status != GNO_OK) return status;
    if (value < 0 || value > 1) {
        gnoi_mesh_warn(r->mtl->context, r->path, r->line, "%s: %g is taken as %d", key, value, value > 1);
        value = value > 1;
    }
    if (is_opacity) entry->given |= given_opacity;
    else if (entry->given & given_opacity) return GNO_OK;
    for (int i = 0; i < 3; i++) entry->material.transmission[i] = is_opacity ? 1 - value : value;
    return GNO_OK;
}

static gno_status start_material(reader *r, const char *p)
{
    p = gnoi_parse_blank(p, &r->line);
    const char *end = gnoi_parse_text_end(p);
    if (end == p) return gnoi_mesh_fail(r->mtl->context, GNO_ERROR_INPUT, r->path, r->line, "newmtl: a name is missing");
    r->current = number_of(r->mtl, p, (size_t)(end - p));
    if (r->current < 0) return gnoi_mesh_no_memory(r->mtl->context, r->path);
    gnoi_mtl_entry *entry = entry_at(r->mtl, r->current);
    entry->material = gno_material_default();
    entry->given = 0;
    entry->defined = 1;
    entry->path = r->path_number;
    for (int use = 0; use < GNOI_MTL_USES; use++) gnoi_mtl_map_free(r->mtl->context, &entry->maps[use]);
    return GNO_OK;
}

static gno_status read_property(reader *r, const char *p, const char *end)
{
    static const char *const known[] = {"ka", "kd", "ks", "ns", "d", "tr"};
    static const char *const keys[] = {"Ka", "Kd", "Ks", "Ns", "d", "Tr"};
    size_t which = 0, count = sizeof known / sizeof known[0];
    while (which < count && !is_word(p, end, known[which])) which++;
    int use = which == count ? gnoi_mtl_map_use(p, end) : -1;
    if (which == count && (use < 0 || r->current < 0)) return GNO_OK;
    if (use >= 0) return gnoi_mtl_map_read(r->mtl->context, r->path, r->line, end, &entry_at(r->mtl, r->current)->maps[use]);
    if (r->current < 0)
        return gnoi_mesh_fail(r->mtl->context, GNO_ERROR_INPUT, r->path, r->line, "%s: no newmtl before it", keys[which]);
    gnoi_mtl_entry *entry = entry_at(r->mtl, r->current);
    gno_status status = GNO_OK;
    int given = 0;
    switch (which) {
    case 0:
        status = read_colour(r, keys[which], end, entry->material.ambient, &given);
        if (given) entry->given |= given_ambient;
        return status;
    case 1:
        status = read_colour(r, keys[which], end, entry->material.diffuse, &given);
        if (given) entry->given |= given_diffuse;
        return status;
    case 2: return read_colour(r, keys[which], end, entry->material.specular, &given);
    case 3: return read_shininess(r, end, &entry->material);
    default: return read_opacity(r, keys[which], end, entry);
    }
}

static gno_status read_block(reader *r, const char *p, const char *last)
{
    while (p < last) {
        r->line++;
        p = gnoi_parse_blank(p, &r->line);
        if (*p != '#' && *p != '\n') {
            const char *end = gnoi_parse_word(p);
            gno_status status = is_word(p, end, "newmtl") ? start_material(r, end) : read_property(r, p, end);
            if (status != GNO_OK) return status;
        }
        p = gnoi_parse_line_end(p) + 1;
    }
    return GNO_OK;
}

static gno_status read_library(gnoi_mtl *mtl, const char *path)
{
    reader r = {mtl, path, 0, -1, gnoi_names_number(mtl->context, &mtl->paths, path, strlen(path))};
    gnoi_blocks blocks;
    if (r.path_number < 0) return gnoi_mesh_no_memory(mtl->context, path);
    gno_status status = gnoi_blocks_open(&blocks, mtl->context, path);
    while (status == GNO_OK) {
        const char *first, *last;
        status = gnoi_blocks_next(&blocks, &first, &last);
        if (status != GNO_OK || !first) break;
        status = read_block(&r, first, last);
    }
    gnoi_blocks_close(&blocks);
    return status;
}

/* ---- libraries ---------------------------------------------------------------------------------------------- */

static int can_open(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (!file) return 0;
    int can_read = fgetc(file) != EOF || !ferror(file); /* a folder can be opened, but not read */
    fclose(file);
    return can_read;
}

/* The library's path beside the OBJ file, in `path`; 0 when memory fails. */
static int library_path(gnoi_mtl *mtl, const char *obj_path, const char *name, size_t length, gnoi_mesh_array *path)
{
    size_t folder = name[0] == '/' ? 0 : (size_t)(gnoi_base_name(obj_path) - obj_path);
    path->count = 0;
    if (!gnoi_mesh_array_room(mtl->context, path, folder + length + 1, 1)) return 0;
    char *text = path->data;
    memcpy(text, obj_path, folder);
    memcpy(text + folder, name, length);
    text[folder + length] = '\0';
    if (can_open(text)) return 1;
    for (char *c = text + folder; *c; c++) /* written on Windows? */
        if (*c == '\\') *c = '/';
    return 1;
}

/* Reads one library, once. *found: 0 when there is no such file; that is a warning if `must_exist`. */
static gno_status try_library(gnoi_mtl *mtl, const char *obj_path, size_t line, const char *name, size_t length,
                              int must_exist, int *found)
{
    gnoi_mesh_array path = {0};
    gno_status status = GNO_OK;
    *found = 0;
    if (!library_path(mtl, obj_path, name, length, &path)) return gnoi_mesh_no_memory(mtl->context, obj_path);
    const char *text = path.data;
    *found = can_open(text);
    if (*found || must_exist) {
        size_t known = mtl->libraries.entries.count;
        int number = gnoi_names_number(mtl->context, &mtl->libraries, name, length);
        if (number < 0) status = gnoi_mesh_no_memory(mtl->context, obj_path);
        else if ((size_t)number < known) *found = 1; /* read, or warned of, before */
        else if (*found) status = read_library(mtl, text);
        else gnoi_mesh_warn(mtl->context, obj_path, line, "mtllib: cannot open %s: its materials are missing", text);
    }
    gnoi_mesh_array_free(mtl->context, &path, 1);
    return status;
}

gno_status gnoi_mtl_read_libraries(gnoi_mtl *mtl, const char *obj_path, size_t line, const char *names, size_t length)
{
    const char *p = names, *end = names + length;
    const char *word = p;
    while (word < end && !gnoi_parse_is_blank(*word)) word++;
    int found = 0, is_one_word = word == end;
    gno_status status = try_library(mtl, obj_path, line, names, length, is_one_word, &found);
    if (status != GNO_OK || found || is_one_word) return status;
    while (p < end && status == GNO_OK) {
        word = p;
        while (p < end && !gnoi_parse_is_blank(*p)) p++;
        if (p > word) status = try_library(mtl, obj_path, line, word, (size_t)(p - word), 1, &found);
        while (p < end && gnoi_parse_is_blank(*p)) p++;
    }
    return status;
}

/* ---- into the scene ----------------------------------------------------------------------------------------- */

static gno_status add_to_scene(gnoi_mtl *mtl, gnoi_mtl_entry *entry, const char *name, gno_scene *scene, const char *obj_path)
{
    gno_material material = entry->material;
    if (!(entry->given & given_ambient)) memcpy(material.ambient, material.diffuse, sizeof material.ambient);
    mtl->textures.scene = scene;
    gno_status status = gnoi_mtl_maps_apply(&mtl->textures, gnoi_names_text(&mtl->paths, entry->path), entry->maps, &material);
    if (status != GNO_OK) return status;
    status = gno_scene_add_material(scene, &material, &entry->scene_index);
    if (status == GNO_OK) status = gno_scene_set_material_name(scene, entry->scene_index, name);
    return status == GNO_OK ? GNO_OK : gnoi_mesh_blame(scene, obj_path, status);
}

gno_status gnoi_mtl_to_scene(gnoi_mtl *mtl, gno_scene *scene, const char *obj_path, int *numbers, size_t count)
{
    size_t missing = 0;
    int first_missing = 0;
    for (size_t i = 0; i < count; i++) {
        if (numbers[i] < 0) {
            numbers[i] = 0; /* before any usemtl: the scene's default material */
            continue;
        }
        gnoi_mtl_entry *entry = entry_at(mtl, numbers[i]);
        if (entry->scene_index == not_in_scene && entry->defined) {
            gno_status status = add_to_scene(mtl, entry, gnoi_names_text(&mtl->names, numbers[i]), scene, obj_path);
            if (status != GNO_OK) return status;
        } else if (entry->scene_index == not_in_scene) {
            entry->scene_index = 0;
            if (missing++ == 0) first_missing = numbers[i];
        }
        numbers[i] = entry->scene_index;
    }
    if (missing == 1)
        gnoi_mesh_warn(mtl->context, obj_path, entry_at(mtl, first_missing)->first_line,
                       "material \"%s\" is not defined: the default material is used",
                       gnoi_names_text(&mtl->names, first_missing));
    if (missing > 1)
        gnoi_mesh_warn(mtl->context, obj_path, entry_at(mtl, first_missing)->first_line,
                       "%zu materials are not defined, the first is \"%s\": the default material is used", missing,
                       gnoi_names_text(&mtl->names, first_missing));
    return GNO_OK;
}
