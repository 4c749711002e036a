/* mesh.c -- gno_scene_add_mesh: copies a caller's arrays into the scene's.
 *
 * Place in the data flow: file readers, callers -> here -> the scene's flat arrays.
 * Order of work: check counts, make room, copy and check into the room beyond the counts, and only then raise the counts.
 * Invariant: until that last step (commit) nothing that the scene shows has changed, so failing needs no undoing.
 */
#include "scene/mesh_check.h"

#include <string.h>

#define MAX_POLYGON_RINGS 16777215u /* gnoi_poly counts rings in 24 bits */

/* The scene's growing arrays. */
enum {
    POSITIONS, NORMALS, TEXCOORDS, POLYGON_START, POLYGON_MATERIAL, POLYGON_OBJECT, RING_START,
    CORNER_VERTEX, CORNER_NORMAL, CORNER_TEXCOORD, OBJECTS, ARRAY_COUNT
};

#define MANY_CORNERS 200000

gno_mesh_def gno_mesh_def_default(void)
{
    gno_mesh_def mesh;
    memset(&mesh, 0, sizeof mesh);
    mesh.shading = -1;
    mesh.crease = 180;
    mesh.weighting = GNO_WEIGHTING_AREA;
    mesh.detail_of = -1;
    mesh.transform[0] = mesh.transform[5] = mesh.transform[10] = 1;
    return mesh;
}

static gno_status out_of_range(const gnoi_adding *a, size_t corner, const char *what, int index, size_t count)
{
    return gnoi_fail(a->context, GNO_ERROR_ARGUMENT, "%s: corner %zu names %s %d of %zu", a->label, corner, what, index, count);
}

/* ---- room ------------------------------------------------------------------------------------------------------ */

typedef struct room {
    void *old, *fresh; /* fresh == old where there is room enough */
    size_t used, held, need, size;
} room;

static void set_room(room *r, void *old, size_t used, size_t held, size_t more, size_t size)
{
    r->old = r->fresh = old;
    r->used = used;
    r->held = held;
    r->need = used + more;
    r->size = size;
}

static void set_rooms(const gnoi_adding *a, room *r)
{
    gno_scene *s = a->scene;
    const gno_mesh_def *m = a->mesh;
    size_t p = s->polygon_count, ps = s->polygon_capacity, c = s->corner_count, cs = s->corner_capacity;
    set_room(&r[POSITIONS], s->positions, s->vertex_count, s->vertex_capacity, m->vertex_count, sizeof *s->positions);
    set_room(&r[NORMALS], s->normals, s->normal_count, s->normal_capacity, a->normal_count, sizeof *s->normals);
    set_room(&r[TEXCOORDS], s->texcoords, s->texcoord_count, s->texcoord_capacity, a->texcoord_count, sizeof *s->texcoords);
    set_room(&r[POLYGON_START], s->polygon_start, p + 1, ps + 1, m->polygon_count, sizeof *s->polygon_start);
    set_room(&r[POLYGON_MATERIAL], s->polygon_material, p, ps, m->polygon_count, sizeof *s->polygon_material);
    set_room(&r[POLYGON_OBJECT], s->polygon_object, p, ps, m->polygon_count, sizeof *s->polygon_object);
    set_room(&r[RING_START], s->ring_start, s->ring_count + 1, s->ring_capacity + 1, m->ring_count, sizeof *s->ring_start);
    set_room(&r[CORNER_VERTEX], s->corner_vertex, c, cs, m->corner_count, sizeof *s->corner_vertex);
    set_room(&r[CORNER_NORMAL], s->corner_normal, c, cs, m->corner_count, sizeof *s->corner_normal);
    set_room(&r[CORNER_TEXCOORD], s->corner_texcoord, c, cs, m->corner_count, sizeof *s->corner_texcoord);
    set_room(&r[OBJECTS], s->objects, s->object_count, s->object_capacity, 1, sizeof *s->objects);
}

/* Elements to hold: what is needed at first, then half as much again, so that many small meshes cost linear time. */
static size_t grown(size_t held, size_t need)
{
    size_t half_more = held + held / 2;
    return need <= held ? held : need > half_more ? need : half_more;
}

/* Arrays that share one capacity must grow together or not at all; so all grow into new blocks before any is taken. */
static gno_status make_room(const gnoi_adding *a)
{
    gno_scene *s = a->scene;
    room r[ARRAY_COUNT];
    size_t wanted[ARRAY_COUNT];
    int i;
    set_rooms(a, r);
    for (i = 0; i < ARRAY_COUNT; i++) {
        wanted[i] = grown(r[i].held, r[i].need);
        if (i == POLYGON_START || i == RING_START) {
            wanted[i] = grown(r[i].held - 1, r[i].need - 1) + 1;
        }
        if (wanted[i] > r[i].held) {
            r[i].fresh = gnoi_malloc(a->context, wanted[i], r[i].size);
        }
        if (wanted[i] > r[i].held && !r[i].fresh) {
            while (i-- > 0) {
                if (r[i].fresh != r[i].old) {
                    gnoi_free(a->context, r[i].fresh, wanted[i], r[i].size);
                }
            }
            return gnoi_fail(a->context, GNO_ERROR_MEMORY, "%s: out of memory", a->label);
        }
    }
    for (i = 0; i < ARRAY_COUNT; i++) {
        if (r[i].fresh != r[i].old && r[i].old) {
            memcpy(r[i].fresh, r[i].old, r[i].used * r[i].size);
            gnoi_free(a->context, r[i].old, r[i].held, r[i].size);
        }
    }
    s->positions = r[POSITIONS].fresh;
    s->vertex_capacity = wanted[POSITIONS];
    s->normals = r[NORMALS].fresh;
    s->normal_capacity = wanted[NORMALS];
    s->texcoords = r[TEXCOORDS].fresh;
    s->texcoord_capacity = wanted[TEXCOORDS];
    s->polygon_start = r[POLYGON_START].fresh;
    s->polygon_material = r[POLYGON_MATERIAL].fresh;
    s->polygon_object = r[POLYGON_OBJECT].fresh;
    s->polygon_capacity = wanted[POLYGON_MATERIAL];
    s->ring_start = r[RING_START].fresh;
    s->ring_capacity = wanted[RING_START] - 1;
    s->corner_vertex = r[CORNER_VERTEX].fresh;
    s->corner_normal = r[CORNER_NORMAL].fresh;
    s->corner_texcoord = r[CORNER_TEXCOORD].fresh;
    s->corner_capacity = wanted[CORNER_VERTEX];
    s->objects = r[OBJECTS].fresh;
    s->object_capacity = wanted[OBJECTS];
    return GNO_OK;
}

/* ---- copies ---------------------------------------------------------------------------------------------------- */

static int is_identity(const double t[12])
{
    int i;
    for (i = 0; i < 12; i++) {
        if (t[i] != (i % 5 == 0 ? 1.0 : 0.0)) {
            return 0;
        }
    }
    return 1;
}

static int is_in_range(const double p[3])
{
    return (fabs(p[0]) <= GNO_MAX_COORDINATE) & (fabs(p[1]) <= GNO_MAX_COORDINATE) & (fabs(p[2]) <= GNO_MAX_COORDINATE);
}

static gno_status copy_positions(const gnoi_adding *a)
{
    const double(*in)[3] = (const double(*)[3])a->mesh->positions;
    double(*out)[3] = a->scene->positions + a->scene->vertex_count;
    const double *t = a->mesh->transform;
    size_t count = a->mesh->vertex_count, i;
    int good = 1, plain = is_identity(t);
    for (i = 0; i < count; i++) {
        double x = in[i][0], y = in[i][1], z = in[i][2];
        out[i][0] = plain ? x : t[0] * x + t[1] * y + t[2] * z + t[3];
        out[i][1] = plain ? y : t[4] * x + t[5] * y + t[6] * z + t[7];
        out[i][2] = plain ? z : t[8] * x + t[9] * y + t[10] * z + t[11];
        good &= is_in_range(out[i]);
    }
    for (i = 0; !good && i < count; i++) {
        if (!is_in_range(out[i])) {
            return gnoi_fail(a->context, GNO_ERROR_ARGUMENT, "%s: vertex %zu (%g, %g, %g) is not finite or beyond %g", a->label,
                             i, out[i][0], out[i][1], out[i][2], GNO_MAX_COORDINATE);
        }
    }
    return GNO_OK;
}

/* The inverse transpose of t's linear part but for a positive factor: the matrix of cofactors with the determinant's sign. */
static void normal_matrix(const double t[12], vec3 rows[3])
{
    vec3 r[3];
    double largest = 0;
    int i;
    for (i = 0; i < 12; i++) {
        largest = i % 4 != 3 && fabs(t[i]) > largest ? fabs(t[i]) : largest;
    }
    for (i = 0; i < 3; i++) {
        r[i] = v3(t[4 * i], t[4 * i + 1], t[4 * i + 2]);
        r[i] = largest > 0 ? v3_scale(r[i], 1 / largest) : r[i];
    }
    for (i = 0; i < 3; i++) {
        rows[i] = v3_cross(r[(i + 1) % 3], r[(i + 2) % 3]);
    }
    if (v3_dot(r[0], rows[0]) < 0) {
        for (i = 0; i < 3; i++) {
            rows[i] = v3_scale(rows[i], -1);
        }
    }
}

/* A normal that is not finite becomes zero, which prepares as "none": files in circulation carry such normals. */
static void copy_normals(const gnoi_adding *a)
{
    const double(*in)[3] = (const double(*)[3])a->mesh->normals;
    double(*out)[3] = a->scene->normals + a->scene->normal_count;
    int plain = is_identity(a->mesh->transform);
    vec3 rows[3];
    size_t i;
    normal_matrix(a->mesh->transform, rows);
    for (i = 0; i < a->normal_count; i++) {
        vec3 n = v3_from(in[i]);
        if (!plain) {
            n = v3(v3_dot(rows[0], n), v3_dot(rows[1], n), v3_dot(rows[2], n));
        }
        if (!isfinite(n.x) || !isfinite(n.y) || !isfinite(n.z)) {
            n = v3(0, 0, 0);
        }
        out[i][0] = n.x;
        out[i][1] = n.y;
        out[i][2] = n.z;
    }
}

static gno_status copy_texcoords(const gnoi_adding *a)
{
    const double(*in)[2] = (const double(*)[2])a->mesh->texcoords;
    double(*out)[2] = a->scene->texcoords + a->scene->texcoord_count;
    size_t i;
    for (i = 0; i < a->texcoord_count; i++) {
        if (!isfinite(in[i][0]) || !isfinite(in[i][1])) {
            return gnoi_fail(a->context, GNO_ERROR_ARGUMENT, "%s: texture coordinate %zu is not finite", a->label, i);
        }
        out[i][0] = in[i][0];
        out[i][1] = in[i][1];
    }
    return GNO_OK;
}

static gno_status copy_vertex_indices(const gnoi_adding *a)
{
    const int *in = a->mesh->corner_vertex;
    int *out = a->scene->corner_vertex + a->scene->corner_count;
    int base = (int)a->scene->vertex_count, count = (int)a->mesh->vertex_count, good = 1;
    size_t i, corners = a->mesh->corner_count;
    for (i = 0; i < corners; i++) {
        good &= (in[i] >= 0) & (in[i] < count);
        out[i] = (int)((unsigned)in[i] + (unsigned)base);
    }
    for (i = 0; !good && i < corners; i++) {
        if (in[i] < 0 || in[i] >= count) {
            return out_of_range(a, i, "vertex", in[i], a->mesh->vertex_count);
        }
    }
    return GNO_OK;
}

/* Indices into normals or texcoords, where -1 means none. */
static gno_status copy_optional(const gnoi_adding *a, const int *in, int *out, size_t there, size_t count, const char *what)
{
    size_t i, corners = a->mesh->corner_count;
    int good = 1;
    if (!in) {
        memset(out, 0xff, corners * sizeof *out); /* -1 in every corner */
        return GNO_OK;
    }
    for (i = 0; i < corners; i++) {
        good &= (in[i] >= -1) & (in[i] < (int)count);
        out[i] = in[i] < 0 ? -1 : (int)((unsigned)in[i] + (unsigned)there);
    }
    for (i = 0; !good && i < corners; i++) {
        if (in[i] < -1 || in[i] >= (int)count) {
            return out_of_range(a, i, what, in[i], count);
        }
    }
    return GNO_OK;
}

static gno_status copy_corners(const gnoi_adding *a)
{
    gno_scene *s = a->scene;
    const gno_mesh_def *m = a->mesh;
    gno_status status = m->corner_count > 0 ? copy_vertex_indices(a) : GNO_OK;
    if (status == GNO_OK && m->corner_count > 0) {
        status = copy_optional(a, m->corner_normal, s->corner_normal + s->corner_count, s->normal_count, a->normal_count, "normal");
    }
    if (status == GNO_OK && m->corner_count > 0) {
        status = copy_optional(a, m->corner_texcoord, s->corner_texcoord + s->corner_count, s->texcoord_count,
                               a->texcoord_count, "texture coordinate");
    }
    return status;
}

/* Copies count+1 offsets with ends as check_ends wants them, which never decrease; NULL: every `step` elements. out[0] stands. */
static gno_status copy_offsets(const gnoi_adding *a, const char *what, const unsigned *in, size_t count, unsigned step, unsigned *out)
{
    unsigned base = out[0];
    size_t i;
    for (i = 0; i < count; i++) {
        if (in && in[i + 1] < in[i]) {
            return gnoi_fail(a->context, GNO_ERROR_ARGUMENT, "%s: %s decreases from %u to %u at %zu", a->label, what, in[i],
                             in[i + 1], i + 1);
        }
        out[i + 1] = base + (in ? in[i + 1] : step * (unsigned)(i + 1));
    }
    return GNO_OK;
}

static gno_status check_ring_counts(const gnoi_adding *a)
{
    const unsigned *start = a->mesh->polygon_start;
    size_t i;
    for (i = 0; start && i < a->mesh->polygon_count; i++) {
        if (start[i + 1] == start[i]) {
            return gnoi_fail(a->context, GNO_ERROR_ARGUMENT, "%s: polygon %zu has no ring", a->label, i);
        }
        if (start[i + 1] - start[i] > MAX_POLYGON_RINGS) {
            return gnoi_fail(a->context, GNO_ERROR_LIMIT, "%s: polygon %zu has more than %u rings", a->label, i, MAX_POLYGON_RINGS);
        }
    }
    return GNO_OK;
}

static gno_status copy_polygons(const gnoi_adding *a)
{
    gno_scene *s = a->scene;
    const gno_mesh_def *m = a->mesh;
    size_t i;
    gno_status status = copy_offsets(a, "polygon_start", m->polygon_start, m->polygon_count, 1,
                                     s->polygon_start + s->polygon_count);
    if (status == GNO_OK) {
        status = copy_offsets(a, "ring_start", m->ring_start, m->ring_count, 3, s->ring_start + s->ring_count);
    }
    if (status == GNO_OK) {
        status = check_ring_counts(a);
    }
    for (i = 0; i < m->polygon_count && status == GNO_OK; i++) {
        int material = m->polygon_material ? m->polygon_material[i] : m->material;
        if (material < 0 || (size_t)material >= s->material_count) {
            return gnoi_fail(a->context, GNO_ERROR_ARGUMENT, "%s: polygon %zu names material %d of %zu", a->label, i, material,
                             s->material_count);
        }
        s->polygon_material[s->polygon_count + i] = material;
        s->polygon_object[s->polygon_count + i] = (int)s->object_count;
    }
    return status;
}

/* The inverse of an affine transform; zeros where it has none. */
static void invert(const double t[12], double inverse[12])
{
    vec3 rows[3], columns[3];
    double det;
    int i, k;
    for (i = 0; i < 3; i++) {
        rows[i] = v3(t[4 * i], t[4 * i + 1], t[4 * i + 2]);
    }
    det = v3_dot(rows[0], v3_cross(rows[1], rows[2]));
    memset(inverse, 0, 12 * sizeof *inverse);
    if (!(fabs(det) > 0) || !isfinite(1 / det)) {
        return;
    }
    for (i = 0; i < 3; i++) {
        columns[i] = v3_scale(v3_cross(rows[(i + 1) % 3], rows[(i + 2) % 3]), 1 / det);
    }
    for (i = 0; i < 3; i++) {
        for (k = 0; k < 3; k++) {
            inverse[4 * i + k] = i == 0 ? columns[k].x : i == 1 ? columns[k].y : columns[k].z;
        }
        inverse[4 * i + 3] = -(inverse[4 * i] * t[3] + inverse[4 * i + 1] * t[7] + inverse[4 * i + 2] * t[11]);
    }
}

static gno_status copy_object(const gnoi_adding *a)
{
    const gno_mesh_def *m = a->mesh;
    gnoi_object *object = &a->scene->objects[a->scene->object_count];
    memset(object, 0, sizeof *object);
    if (m->name) {
        object->name_size = strlen(m->name) + 1;
        object->name = gnoi_malloc(a->context, object->name_size, 1);
        if (!object->name) {
            return gnoi_fail(a->context, GNO_ERROR_MEMORY, "%s: out of memory", a->label);
        }
        memcpy(object->name, m->name, object->name_size);
    }
    object->first_polygon = a->scene->polygon_count;
    object->polygon_count = m->polygon_count;
    object->shading = m->shading;
    object->average_normals = m->average_normals != 0;
    object->crease = m->crease;
    object->weighting = m->weighting;
    object->priority = m->priority;
    object->detail_of = m->detail_of < 0 ? -1 : m->detail_of;
    object->find_details = m->find_details != 0;
    invert(m->transform, object->to_local);
    return GNO_OK;
}

static void commit(const gnoi_adding *a)
{
    gno_scene *s = a->scene;
    s->vertex_count += a->mesh->vertex_count;
    s->normal_count += a->normal_count;
    s->texcoord_count += a->texcoord_count;
    s->polygon_count += a->mesh->polygon_count;
    s->ring_count += a->mesh->ring_count;
    s->corner_count += a->mesh->corner_count;
    s->object_count++;
    gnoi_scene_changed(s);
}

/* Between the steps of copying a mesh that is large enough to take some milliseconds. */
static gno_status go_on(const gnoi_adding *a, int step)
{
    return a->mesh->corner_count < MANY_CORNERS ? GNO_OK : gnoi_progress(a->context, "copy mesh", step / 4.0);
}

static gno_status copy_mesh(const gnoi_adding *a)
{
    gno_status status = copy_polygons(a);
    if (status == GNO_OK) {
        status = go_on(a, 1);
    }
    if (status == GNO_OK && a->mesh->vertex_count > 0) { /* arrays of no elements may be NULL */
        status = copy_positions(a);
    }
    if (status == GNO_OK) {
        status = go_on(a, 2);
    }
    if (status == GNO_OK && a->normal_count > 0) {
        copy_normals(a);
    }
    if (status == GNO_OK && a->texcoord_count > 0) {
        status = copy_texcoords(a);
    }
    if (status == GNO_OK) {
        status = go_on(a, 3);
    }
    if (status == GNO_OK) {
        status = copy_corners(a);
    }
    if (status == GNO_OK && a->mesh->detail_of >= 0) {
        status = gnoi_check_detail(a->scene, a->label, a->scene->polygon_count, a->mesh->polygon_count, a->mesh->detail_of);
    }
    return status == GNO_OK ? copy_object(a) : status; /* last, for it owns memory that only commit makes reachable */
}

gno_status gno_scene_add_mesh(gno_scene *scene, const gno_mesh_def *mesh, size_t *first_polygon)
{
    gnoi_adding a;
    gno_status status;
    if (!scene || !mesh) {
        return gnoi_fail(gno_scene_context(scene), GNO_ERROR_ARGUMENT, "gno_scene_add_mesh: scene or mesh is NULL");
    }
    a.scene = scene;
    a.context = scene->context;
    a.mesh = mesh;
    a.normal_count = mesh->normals ? mesh->normal_count : 0;
    a.texcoord_count = mesh->texcoords ? mesh->texcoord_count : 0;
    gnoi_label_mesh(&a);
    status = gnoi_check_mesh(&a);
    if (status == GNO_OK) {
        status = make_room(&a);
    }
    if (status == GNO_OK) {
        status = copy_mesh(&a);
    }
    if (status == GNO_OK) {
        if (first_polygon) {
            *first_polygon = scene->polygon_count;
        }
        commit(&a);
    }
    return status;
}
