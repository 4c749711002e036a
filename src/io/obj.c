/* obj.c -- Wavefront OBJ, polygons only, in double precision.
 *
 * Place: under mesh_file.c.
 *
 *   file -- gnoi_blocks: whole lines --> statements (here) -- numbers: obj_parse.c --> growing arrays --> one gno_mesh_def
 *                                        usemtl, mtllib --> mtl.c ------------------> material of each polygon
 *
 * Read: v vt vn f usemtl mtllib o. Skipped: colours and w after v, w of vt, g, s, l, p and curved surfaces. Polygons stay
 * as they are, whatever their number of corners. Indices may be negative, and may point to vertices further down, so
 * positive ones are judged at the end of the file: the reader keeps the largest of each kind and its line.
 */
#include "file_name.h"
#include "mtl.h"
#include "obj_parse.h"
#include <limits.h>
#include <math.h>
#include <string.h>

typedef enum kind { kind_vertex, kind_texcoord, kind_normal, kind_count } kind;

static const char *const kind_names[kind_count] = {"vertex", "texture coordinate", "normal"};
static const char *const kind_plurals[kind_count] = {"vertices", "texture coordinates", "normals"};
static const size_t kind_sizes[kind_count] = {3 * sizeof(double), 2 * sizeof(double), 3 * sizeof(double)};

typedef struct reader {
    gno_context *context;
    const char *path;
    size_t line;
    gno_status status;
    int use_materials;
    gnoi_mesh_array points[kind_count];  /* doubles in threes, twos, threes */
    gnoi_mesh_array corners[kind_count]; /* int, 0-based, -1 none; texcoords and normals stay empty until one is used */
    gnoi_mesh_array rings;               /* unsigned offsets into corners; empty while all polygons are triangles */
    gnoi_mesh_array materials;           /* int per polygon, numbers of gnoi_mtl; empty until usemtl */
    size_t polygon_count, skipped_count;
    size_t largest_index[kind_count], largest_line[kind_count]; /* of positive indices beyond what was there yet */
    int material; /* current number of gnoi_mtl, -1 none */
    gnoi_mtl mtl;
    gnoi_mesh_array name; /* char: of the file's only `o`; object_count says how many there are */
    size_t object_count;
} reader;

/* All statement readers return where they stopped, or NULL with status set. */
static const char *stop(reader *r, gno_status status)
{
    r->status = status;
    return NULL;
}

static const char *stop_memory(reader *r)
{
    return stop(r, gnoi_mesh_no_memory(r->context, r->path));
}

static const char *stop_limit(reader *r, const char *what, long limit)
{
    return stop(r, gnoi_mesh_fail(r->context, GNO_ERROR_LIMIT, r->path, r->line, "more than %ld %s", limit, what));
}

static inline const char *skip_blank(reader *r, const char *p)
{
    if (*p == ' ') p++;
    return (unsigned char)*p > ' ' && *p != '\\' ? p : gnoi_parse_blank(p, &r->line);
}

/* Room for one more element, and the element; NULL when memory fails. */
static inline void *push(reader *r, gnoi_mesh_array *array, size_t size)
{
    if (array->count == array->capacity && !gnoi_mesh_array_room(r->context, array, 1, size)) return NULL;
    return (char *)array->data + array->count++ * size;
}

/* ---- v, vt, vn ---------------------------------------------------------------------------------------------- */

static const char *stop_number(reader *r, const char *key, const char *p, int found)
{
    if (gnoi_parse_at_end(p))
        return stop(r, gnoi_mesh_fail(r->context, GNO_ERROR_INPUT, r->path, r->line,
                                      "%s: %d number%s, more are needed", key, found, found == 1 ? "" : "s"));
    const char *end = gnoi_parse_word(p);
    int length = end - p > 40 ? 40 : (int)(end - p);
    return stop(r, gnoi_mesh_fail(r->context, GNO_ERROR_INPUT, r->path, r->line, "%s: \"%.*s\" is not a finite number", key,
                                  length, p));
}

/* Reads `wanted` numbers, of which the first `needed` must be there; the rest are zero. */
static const char *read_numbers(reader *r, const char *p, const char *key, int needed, int wanted, double *values)
{
    for (int i = 0; i < wanted; i++) {
        p = skip_blank(r, p);
        if (i >= needed && gnoi_parse_at_end(p)) {
            values[i] = 0;
            continue;
        }
        const char *end = gnoi_parse_number(p, &values[i]);
        if (end == p || !gnoi_parse_ends_word(*end) || !isfinite(values[i])) return stop_number(r, key, p, i);
        p = end;
    }
    return p;
}

static const char *read_point(reader *r, const char *p, kind k)
{
    static const char *const keys[kind_count] = {"v", "vt", "vn"};
    if (r->points[k].count >= GNO_MAX_POLYGONS) return stop_limit(r, kind_plurals[k], GNO_MAX_POLYGONS);
    double *values = push(r, &r->points[k], kind_sizes[k]);
    if (!values) return stop_memory(r);
    return k == kind_texcoord ? read_numbers(r, p, keys[k], 1, 2, values) : read_numbers(r, p, keys[k], 3, 3, values);
}

/* ---- f ------------------------------------------------------------------------------------------------------ */

static const char *stop_corner(reader *r, const char *p)
{
    const char *end = gnoi_parse_word(p);
    int length = end - p > 40 ? 40 : (int)(end - p);
    return stop(r, gnoi_mesh_fail(r->context, GNO_ERROR_INPUT, r->path, r->line, "f: \"%.*s\" is not a polygon corner", length,
                                  p));
}

static const char *stop_index(reader *r, kind k, const char *sign, size_t value)
{
    if (value == 0)
        return stop(r, gnoi_mesh_fail(r->context, GNO_ERROR_INPUT, r->path, r->line, "f: %s 0: indices count from 1",
                                      kind_names[k]));
    return stop(r, gnoi_mesh_fail(r->context, GNO_ERROR_INPUT, r->path, r->line, "f: %s %s%zu does not exist, there are %zu",
                                  kind_names[k], sign, value, r->points[k].count));
}

/* Reads an index of kind k at p, made 0-based. corner: the start of its word, for messages. */
static inline const char *read_index(reader *r, const char *p, const char *corner, kind k, int *index)
{
    int negative = *p == '-';
    p += negative;
    const char *first = p;
    size_t value = 0;
    unsigned digit;
    for (; (digit = (unsigned)(*p - '0')) <= 9; p++) value = value * 10 + digit;
    if (p == first || p - first > 10) return stop_corner(r, corner);
    size_t count = r->points[k].count;
    if (value == 0 || (negative && value > count) || value > INT_MAX) return stop_index(r, k, negative ? "-" : "", value);
    *index = (int)(negative ? count - value : value - 1);
    if (!negative && value > count && value > r->largest_index[k]) {
        r->largest_index[k] = value;
        r->largest_line[k] = r->line;
    }
    return p;
}

/* Appends the corner's index of kind k (texcoord or normal, -1: none) beside the vertex that was just appended. The
 * array starts with the first corner that has one, filled up for those before. */
static int push_optional(reader *r, kind k, int index)
{
    gnoi_mesh_array *array = &r->corners[k];
    if (array->count == 0) {
        if (index < 0) return 1;
        size_t before = r->corners[kind_vertex].count - 1;
        if (!gnoi_mesh_array_room(r->context, array, before + 1, sizeof(int))) return 0;
        if (before) memset(array->data, 0xff, before * sizeof(int)); /* -1 */
        array->count = before;
    }
    int *corner = push(r, array, sizeof(int));
    if (!corner) return 0;
    *corner = index;
    return 1;
}

/* v, v/t, v//n or v/t/n; "v/" and "v//" too. */
static inline const char *read_corner(reader *r, const char *p)
{
    const char *word = p;
    int index[kind_count] = {-1, -1, -1};
    p = read_index(r, p, word, kind_vertex, &index[kind_vertex]);
    if (p && *p == '/') {
        p++;
        if (*p != '/' && !gnoi_parse_ends_word(*p)) p = read_index(r, p, word, kind_texcoord, &index[kind_texcoord]);
        if (p && *p == '/') {
            p++;
            if (!gnoi_parse_ends_word(*p)) p = read_index(r, p, word, kind_normal, &index[kind_normal]);
        }
    }
    if (!p) return NULL;
    if (!gnoi_parse_ends_word(*p)) return stop_corner(r, word);
    int *corner = push(r, &r->corners[kind_vertex], sizeof(int));
    if (!corner) return stop_memory(r);
    *corner = index[kind_vertex];
    if (!push_optional(r, kind_texcoord, index[kind_texcoord])) return stop_memory(r);
    if (!push_optional(r, kind_normal, index[kind_normal])) return stop_memory(r);
    return p;
}

/* The first polygon that is no triangle: offsets of the triangles before it. */
static int start_rings(reader *r)
{
    size_t count = r->polygon_count + 1;
    if (!gnoi_mesh_array_room(r->context, &r->rings, count, sizeof(unsigned))) return 0;
    unsigned *rings = r->rings.data;
    for (size_t i = 0; i < count; i++) rings[i] = (unsigned)(3 * i);
    r->rings.count = count;
    return 1;
}

static int start_materials(reader *r)
{
    if (!gnoi_mesh_array_room(r->context, &r->materials, r->polygon_count + 1, sizeof(int))) return 0;
    if (r->polygon_count) memset(r->materials.data, 0xff, r->polygon_count * sizeof(int)); /* -1 */
    r->materials.count = r->polygon_count;
    return 1;
}

/* Makes a polygon of the corners from `first` on. */
static int end_polygon(reader *r, size_t first)
{
    size_t count = r->corners[kind_vertex].count - first;
    if (count != 3 && r->rings.count == 0 && !start_rings(r)) return 0;
    if (r->rings.count > 0) {
        unsigned *ring = push(r, &r->rings, sizeof(unsigned));
        if (!ring) return 0;
        *ring = (unsigned)(first + count);
    }
    if (r->materials.count == 0 && r->material >= 0 && !start_materials(r)) return 0;
    if (r->materials.capacity > 0) {
        int *material = push(r, &r->materials, sizeof(int));
        if (!material) return 0;
        *material = r->material;
    }
    r->polygon_count++;
    return 1;
}

static const char *read_face(reader *r, const char *p)
{
    size_t first = r->corners[kind_vertex].count;
    for (;;) {
        p = skip_blank(r, p);
        if (gnoi_parse_at_end(p)) break;
        p = read_corner(r, p);
        if (!p) return NULL;
    }
    size_t end = r->corners[kind_vertex].count;
    if (end - first < 3) {
        for (int k = 0; k < kind_count; k++)
            if (r->corners[k].count > first) r->corners[k].count = first;
        r->skipped_count++;
        return p;
    }
    if (end > GNO_MAX_CORNERS) return stop_limit(r, "polygon corners", GNO_MAX_CORNERS);
    if (r->polygon_count >= GNO_MAX_POLYGONS) return stop_limit(r, "polygons", GNO_MAX_POLYGONS);
    return end_polygon(r, first) ? p : stop_memory(r);
}

/* ---- names -------------------------------------------------------------------------------------------------- */

static const char *use_material(reader *r, const char *p)
{
    p = gnoi_parse_blank(p, &r->line);
    const char *end = gnoi_parse_text_end(p);
    r->material = -1;
    if (!r->use_materials || end == p) return end;
    r->material = gnoi_mtl_number(&r->mtl, p, (size_t)(end - p), r->line);
    return r->material < 0 ? stop_memory(r) : end;
}

static const char *read_libraries(reader *r, const char *p)
{
    p = gnoi_parse_blank(p, &r->line);
    const char *end = gnoi_parse_text_end(p);
    if (!r->use_materials || end == p) return end;
    gno_status status = gnoi_mtl_read_libraries(&r->mtl, r->path, r->line, p, (size_t)(end - p));
    return status == GNO_OK ? end : stop(r, status);
}

static const char *read_object_name(reader *r, const char *p)
{
    p = gnoi_parse_blank(p, &r->line);
    const char *end = gnoi_parse_text_end(p);
    if (r->object_count++ > 0) return end;
    size_t length = (size_t)(end - p);
    if (!gnoi_mesh_array_room(r->context, &r->name, length + 1, 1)) return stop_memory(r);
    char *name = r->name.data;
    memcpy(name, p, length);
    name[length] = '\0';
    return end;
}

/* ---- the file ----------------------------------------------------------------------------------------------- */

static int starts_with_word(const char *p, const char *word, size_t length)
{
    return strncmp(p, word, length) == 0 && gnoi_parse_ends_word(p[length]);
}

/* p is at the first word of a statement; what the reader leaves unread of it is skipped by the caller. */
static const char *read_statement(reader *r, const char *p)
{
    switch (*p) {
    case 'v':
        if (gnoi_parse_ends_word(p[1])) return read_point(r, p + 1, kind_vertex);
        if (p[1] == 'n' && gnoi_parse_ends_word(p[2])) return read_point(r, p + 2, kind_normal);
        if (p[1] == 't' && gnoi_parse_ends_word(p[2])) return read_point(r, p + 2, kind_texcoord);
        return p;
    case 'f': return gnoi_parse_ends_word(p[1]) ? read_face(r, p + 1) : p;
    case 'u': return starts_with_word(p, "usemtl", 6) ? use_material(r, p + 6) : p;
    case 'm': return starts_with_word(p, "mtllib", 6) ? read_libraries(r, p + 6) : p;
    case 'o': return gnoi_parse_ends_word(p[1]) ? read_object_name(r, p + 1) : p;
    default: return p;
    }
}

static gno_status read_block(reader *r, const char *p, const char *last)
{
    while (p < last) {
        r->line++;
        if ((unsigned char)*p <= ' ' || *p == '\\') p = gnoi_parse_blank(p, &r->line);
        if (*p != '\n') {
            p = read_statement(r, p);
            if (!p) return r->status;
            if (*p != '\n') p = gnoi_parse_statement_end(p, &r->line); /* a comment, or words that are not read */
        }
        p++;
    }
    return GNO_OK;
}

static gno_status read_file(reader *r)
{
    gnoi_blocks blocks;
    gno_status status = gnoi_blocks_open(&blocks, r->context, r->path);
    while (status == GNO_OK) {
        const char *first, *last;
        status = gnoi_blocks_next(&blocks, &first, &last);
        if (status != GNO_OK || !first) break;
        status = read_block(r, first, last);
    }
    gnoi_blocks_close(&blocks);
    return status;
}

/* Positive indices against what the whole file holds. */
static gno_status check_indices(reader *r)
{
    for (int k = 0; k < kind_count; k++) {
        if (r->largest_index[k] <= r->points[k].count) continue;
        r->line = r->largest_line[k];
        stop_index(r, (kind)k, "", r->largest_index[k]);
        return r->status;
    }
    return GNO_OK;
}

static gno_status add_mesh(reader *r, gno_scene *scene, const gnoi_mesh_options *options, gnoi_mesh_result *result)
{
    gno_status status = gnoi_mtl_to_scene(&r->mtl, scene, r->path, r->materials.data, r->materials.count);
    if (status != GNO_OK) return status;
    gno_mesh_def def = gnoi_mesh_def_for(options);
    if (!def.name) def.name = r->object_count == 1 ? r->name.data : gnoi_base_name(r->path);
    def.vertex_count = r->points[kind_vertex].count;
    def.positions = r->points[kind_vertex].data;
    def.normal_count = r->points[kind_normal].count;
    def.normals = r->points[kind_normal].data;
    def.texcoord_count = r->points[kind_texcoord].count;
    def.texcoords = r->points[kind_texcoord].data;
    def.polygon_count = def.ring_count = r->polygon_count;
    def.ring_start = r->rings.data;
    def.corner_count = r->corners[kind_vertex].count;
    def.corner_vertex = r->corners[kind_vertex].data;
    def.corner_texcoord = r->corners[kind_texcoord].count ? r->corners[kind_texcoord].data : NULL;
    def.corner_normal = r->corners[kind_normal].count ? r->corners[kind_normal].data : NULL;
    def.polygon_material = r->materials.count ? r->materials.data : NULL;
    return gnoi_mesh_add(scene, r->path, &def, result);
}

static void free_reader(reader *r)
{
    for (int k = 0; k < kind_count; k++) {
        gnoi_mesh_array_free(r->context, &r->points[k], kind_sizes[k]);
        gnoi_mesh_array_free(r->context, &r->corners[k], sizeof(int));
    }
    gnoi_mesh_array_free(r->context, &r->rings, sizeof(unsigned));
    gnoi_mesh_array_free(r->context, &r->materials, sizeof(int));
    gnoi_mesh_array_free(r->context, &r->name, 1);
    gnoi_mtl_free(&r->mtl);
}

gno_status gnoi_obj_load(gno_scene *scene, const char *path, const gnoi_mesh_options *options, gnoi_mesh_result *result)
{
    reader r;
    memset(&r, 0, sizeof r);
    r.context = r.mtl.context = gno_scene_context(scene);
    r.path = path;
    r.material = -1;
    r.use_materials = options->material < 0;
    gno_status status = read_file(&r);
    if (status == GNO_OK) status = check_indices(&r);
    if (status == GNO_OK && r.skipped_count > 0)
        gnoi_mesh_warn(r.context, path, 0, "%zu faces with less than 3 corners are skipped", r.skipped_count);
    if (status == GNO_OK && r.polygon_count > 0) status = add_mesh(&r, scene, options, result);
    free_reader(&r);
    return status;
}
