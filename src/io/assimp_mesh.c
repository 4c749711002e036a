/* assimp_mesh.c -- PLY, STL, glTF and whatever else assimp reads: nodes and meshes.
 *
 * Place: under mesh_file.c; see assimp_file.h for the data flow. assimp is asked for no processing at all: polygons come
 * as its importers give them (n-gons kept where the format has them), nothing is split, joined or triangulated. Each mesh of each
 * node becomes one gno_mesh_def with the node's transform.
 *
 * Corners share a position, as averaged normals need, where the file says so by indices. Formats without indices (STL) give
 * every corner a vertex of its own: such meshes are joined here, by exactly equal coordinates. assimp's own joining has
 * a tolerance, which eats small triangles.
 */
#include "assimp_file.h"
#include "file_name.h"
#include <assimp/cimport.h>
#include <assimp/config.h>
#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

enum { deepest_node = 1000 }; /* nesting; the walk is recursive */

/* The arrays behind one gno_mesh_def. */
typedef struct mesh_arrays {
    size_t vertex_count, corner_count, polygon_count, distinct_count;
    int all_triangles, has_normals, has_texcoords;
    double *positions, *normals, *texcoords;
    int *corner_source; /* the file's vertex of each corner: its normal and texture coordinates too */
    int *corner_vertex; /* the same, or, joined, the first vertex at the same place */
    int *corner_normal; /* the same, or -1 where the normal is none */
    unsigned *ring_start;
    int *same_place;    /* vertex -> number of its position */
} mesh_arrays;

/* ---- joining vertices --------------------------------------------------------------------------------------- */

static uint32_t hash_position(const double p[3])
{
    uint64_t hash = 0x9e3779b97f4a7c15u;
    for (int i = 0; i < 3; i++) {
        uint64_t bits;
        memcpy(&bits, &p[i], sizeof bits);
        hash = (hash ^ bits) * 0xff51afd7ed558ccdu;
        hash ^= hash >> 32;
    }
    return (uint32_t)hash;
}

/* Numbers the distinct positions in order of first appearance, moves them to the front of `positions`, and fills
 * same_place. Positions are free of negative zeros. */
static int join_positions(gno_context *context, mesh_arrays *m)
{
    size_t size = 16;
    while (size < 2 * m->vertex_count) size *= 2;
    int *slots = gno_context_realloc(context, NULL, 0, size * sizeof *slots);
    if (!slots) return 0;
    for (size_t i = 0; i < size; i++) slots[i] = -1;
    size_t distinct = 0;
    for (size_t v = 0; v < m->vertex_count; v++) {
        const double *p = m->positions + 3 * v;
        size_t slot = hash_position(p) & (size - 1);
        while (slots[slot] >= 0 && memcmp(m->positions + 3 * (size_t)slots[slot], p, 3 * sizeof *p) != 0)
            slot = (slot + 1) & (size - 1);
        if (slots[slot] < 0) {
            slots[slot] = (int)distinct;
            memmove(m->positions + 3 * distinct++, p, 3 * sizeof *p); /* distinct <= v: p is not needed after this */
        }
        m->same_place[v] = slots[slot];
    }
    m->distinct_count = distinct;
    gno_context_realloc(context, slots, size * sizeof *slots, 0);
    return 1;
}

/* ---- one mesh ----------------------------------------------------------------------------------------------- */

static void count_polygons(const gnoi_assimp *a, const struct aiMesh *mesh, mesh_arrays *m)
{
    memset(m, 0, sizeof *m);
    m->all_triangles = 1;
    for (unsigned f = 0; f < mesh->mNumFaces; f++) {
        unsigned count = mesh->mFaces[f].mNumIndices;
        if (count < 3) continue; /* points and lines */
        m->polygon_count++;
        m->corner_count += count;
        if (count != 3) m->all_triangles = 0;
    }
    m->vertex_count = m->distinct_count = mesh->mNumVertices;
    m->has_normals = mesh->mNormals != NULL && !a->is_stl;
    m->has_texcoords = mesh->mTextureCoords[0] != NULL;
}

static void *get(gno_context *context, size_t count, size_t size)
{
    return gno_context_realloc(context, NULL, 0, (count + 1) * size); /* one more: a size of 0 would free */
}

static void give_back(gno_context *context, void *block, size_t count, size_t size)
{
    if (block) gno_context_realloc(context, block, (count + 1) * size, 0);
}

static int get_arrays(gno_context *context, mesh_arrays *m)
{
    m->positions = get(context, 3 * m->vertex_count, sizeof *m->positions);
    m->normals = m->has_normals ? get(context, 3 * m->vertex_count, sizeof *m->normals) : NULL;
    m->texcoords = m->has_texcoords ? get(context, 2 * m->vertex_count, sizeof *m->texcoords) : NULL;
    m->corner_source = get(context, m->corner_count, sizeof *m->corner_source);
    m->corner_vertex = get(context, m->corner_count, sizeof *m->corner_vertex);
    m->corner_normal = m->has_normals ? get(context, m->corner_count, sizeof *m->corner_normal) : NULL;
    m->ring_start = m->all_triangles ? NULL : get(context, m->polygon_count + 1, sizeof *m->ring_start);
    m->same_place = get(context, m->vertex_count, sizeof *m->same_place);
    return m->positions && (m->normals || !m->has_normals) && (m->texcoords || !m->has_texcoords) && m->corner_source &&
           m->corner_vertex && (m->corner_normal || !m->has_normals) && (m->ring_start || m->all_triangles) && m->same_place;
}

static void free_arrays(gno_context *context, mesh_arrays *m)
{
    give_back(context, m->positions, 3 * m->vertex_count, sizeof *m->positions);
    give_back(context, m->normals, 3 * m->vertex_count, sizeof *m->normals);
    give_back(context, m->texcoords, 2 * m->vertex_count, sizeof *m->texcoords);
    give_back(context, m->corner_source, m->corner_count, sizeof *m->corner_source);
    give_back(context, m->corner_vertex, m->corner_count, sizeof *m->corner_vertex);
    give_back(context, m->corner_normal, m->corner_count, sizeof *m->corner_normal);
    give_back(context, m->ring_start, m->polygon_count + 1, sizeof *m->ring_start);
    give_back(context, m->same_place, m->vertex_count, sizeof *m->same_place);
}

static void copy_vertices(const struct aiMesh *mesh, mesh_arrays *m)
{
    for (size_t v = 0; v < m->vertex_count; v++) {
        const struct aiVector3D *p = &mesh->mVertices[v];
        m->positions[3 * v] = (double)p->x + 0.0; /* + 0: no negative zeros */
        m->positions[3 * v + 1] = (double)p->y + 0.0;
        m->positions[3 * v + 2] = (double)p->z + 0.0;
        m->same_place[v] = (int)v;
        if (m->has_texcoords) {
            const struct aiVector3D *t = &mesh->mTextureCoords[0][v];
            m->texcoords[2 * v] = isfinite(t->x) ? (double)t->x : 0;
            m->texcoords[2 * v + 1] = isfinite(t->y) ? (double)t->y : 0;
        }
        if (m->has_normals) {
            const struct aiVector3D *n = &mesh->mNormals[v];
            double length = fabs((double)n->x) + fabs((double)n->y) + fabs((double)n->z);
            int good = isfinite(length) && length > 0; /* else all zero: corners do not refer to it */
            m->normals[3 * v] = good ? (double)n->x : 0;
            m->normals[3 * v + 1] = good ? (double)n->y : 0;
            m->normals[3 * v + 2] = good ? (double)n->z : 0;
        }
    }
}

/* 0 when a face's index is out of range. */
static int copy_corners(const struct aiMesh *mesh, mesh_arrays *m)
{
    size_t corner = 0, polygon = 0;
    for (unsigned f = 0; f < mesh->mNumFaces; f++) {
        const struct aiFace *face = &mesh->mFaces[f];
        if (face->mNumIndices < 3) continue;
        if (m->ring_start) m->ring_start[polygon++] = (unsigned)corner;
        for (unsigned i = 0; i < face->mNumIndices; i++, corner++) {
            unsigned v = face->mIndices[i];
            if (v >= m->vertex_count) return 0;
            m->corner_source[corner] = (int)v;
            if (!m->corner_normal) continue;
            const double *n = m->normals + 3 * (size_t)v;
            m->corner_normal[corner] = n[0] != 0 || n[1] != 0 || n[2] != 0 ? (int)v : -1;
        }
    }
    if (m->ring_start) m->ring_start[polygon] = (unsigned)corner;
    return 1;
}

static gno_status fill_arrays(gnoi_assimp *a, const struct aiMesh *mesh, mesh_arrays *m)
{
    if (!get_arrays(a->context, m)) return gnoi_mesh_no_memory(a->context, a->path);
    copy_vertices(mesh, m);
    if (!copy_corners(mesh, m))
        return gnoi_mesh_fail(a->context, GNO_ERROR_INPUT, a->path, 0,
                              "mesh \"%s\": a polygon names a vertex that does not exist", mesh->mName.data);
    int has_no_indices = m->vertex_count == m->corner_count;
    if ((has_no_indices || a->options->average_normals) && !join_positions(a->context, m))
        return gnoi_mesh_no_memory(a->context, a->path);
    for (size_t c = 0; c < m->corner_count; c++) m->corner_vertex[c] = m->same_place[m->corner_source[c]];
    return GNO_OK;
}

static gno_mesh_def make_def(const gnoi_assimp *a, const struct aiMesh *mesh, const gnoi_affine *transform, const mesh_arrays *m)
{
    gno_mesh_def def = gnoi_mesh_def_for(a->options);
    if (!def.name) def.name = mesh->mName.length > 0 ? mesh->mName.data : gnoi_base_name(a->path);
    memcpy(def.transform, transform->m, sizeof def.transform);
    def.vertex_count = m->distinct_count;
    def.positions = m->positions;
    def.normal_count = m->has_normals ? m->vertex_count : 0;
    def.normals = m->normals;
    def.texcoord_count = m->has_texcoords ? m->vertex_count : 0;
    def.texcoords = m->texcoords;
    def.polygon_count = def.ring_count = m->polygon_count;
    def.ring_start = m->ring_start;
    def.corner_count = m->corner_count;
    def.corner_vertex = m->corner_vertex;
    def.corner_normal = m->corner_normal;
    def.corner_texcoord = m->has_texcoords ? m->corner_source : NULL;
    return def;
}

static gno_status add_mesh(gnoi_assimp *a, const struct aiMesh *mesh, const gnoi_affine *transform)
{
    mesh_arrays m;
    count_polygons(a, mesh, &m);
    if (m.polygon_count == 0) return GNO_OK;
    if (m.vertex_count > GNO_MAX_POLYGONS || m.corner_count > GNO_MAX_CORNERS)
        return gnoi_mesh_fail(a->context, GNO_ERROR_LIMIT, a->path, 0, "mesh \"%s\": too many vertices", mesh->mName.data);
    gno_status status = fill_arrays(a, mesh, &m);
    if (status == GNO_OK) {
        gno_mesh_def def = make_def(a, mesh, transform, &m);
        if (a->options->material < 0) def.material = gnoi_assimp_material(a, mesh->mMaterialIndex, &status);
        if (status == GNO_OK) status = gnoi_mesh_add(a->scene, a->path, &def, a->result);
    }
    free_arrays(a->context, &m);
    return status;
}

/* ---- nodes -------------------------------------------------------------------------------------------------- */

gnoi_affine gnoi_assimp_compose(const gnoi_affine *outer, const struct aiMatrix4x4 *t)
{
    const double inner[12] = {(double)t->a1, (double)t->a2, (double)t->a3, (double)t->a4, (double)t->b1, (double)t->b2,
                              (double)t->b3, (double)t->b4, (double)t->c1, (double)t->c2, (double)t->c3, (double)t->c4};
    gnoi_affine result;
    for (int row = 0; row < 3; row++) {
        const double *o = outer->m + 4 * row;
        for (int column = 0; column < 4; column++)
            result.m[4 * row + column] =
                o[0] * inner[column] + o[1] * inner[4 + column] + o[2] * inner[8 + column] + (column == 3 ? o[3] : 0);
    }
    return result;
}

static gno_status add_node(gnoi_assimp *a, const struct aiNode *node, const gnoi_affine *outer, int depth)
{
    if (depth > deepest_node)
        return gnoi_mesh_fail(a->context, GNO_ERROR_LIMIT, a->path, 0, "nodes are nested more than %d deep", deepest_node);
    gnoi_affine transform = gnoi_assimp_compose(outer, &node->mTransformation);
    for (unsigned i = 0; i < node->mNumMeshes; i++) {
        if (node->mMeshes[i] >= a->file->mNumMeshes) continue;
        gno_status status = add_mesh(a, a->file->mMeshes[node->mMeshes[i]], &transform);
        if (status != GNO_OK) return status;
    }
    for (unsigned i = 0; i < node->mNumChildren; i++) {
        gno_status status = add_node(a, node->mChildren[i], &transform, depth + 1);
        if (status != GNO_OK) return status;
    }
    return GNO_OK;
}

/* ---- the file ----------------------------------------------------------------------------------------------- */

static gno_status check_file(const gnoi_assimp *a)
{
    const char *extension = gnoi_extension(a->path);
    if (!extension[0] || !aiIsExtensionSupported(extension))
        return gnoi_mesh_fail(a->context, GNO_ERROR_FILE, a->path, 0,
                              "not a mesh format by its extension (.obj .ply .stl .gltf .glb and others)");
    FILE *file = fopen(a->path, "rb");
    if (!file) return gnoi_mesh_fail(a->context, GNO_ERROR_FILE, a->path, 0, "cannot open: %s", strerror(errno));
    fclose(file);
    return gnoi_has_extension(a->path, ".ply") ? gnoi_ply_check(a->context, a->path) : GNO_OK;
}

/* NULL after a failure; the text is then aiGetErrorString's. */
static const struct aiScene *import(const char *path)
{
    struct aiPropertyStore *properties = aiCreatePropertyStore();
    if (!properties) return NULL;
    aiSetImportPropertyInteger(properties, AI_CONFIG_IMPORT_NO_SKELETON_MESHES, 1);
    aiSetImportPropertyInteger(properties, AI_CONFIG_IMPORT_FBX_READ_ANIMATIONS, 0);
    const struct aiScene *file = aiImportFileExWithProperties(path, 0, NULL, properties);
    aiReleasePropertyStore(properties);
    return file;
}

static gno_status add_file(gnoi_assimp *a)
{
    size_t count = a->file->mNumMaterials;
    a->textures.scene = a->scene;
    a->material_index = get(a->context, count, sizeof *a->material_index);
    if (!a->material_index) return gnoi_mesh_no_memory(a->context, a->path);
    for (size_t i = 0; i < count; i++) a->material_index[i] = -1;
    gnoi_affine transform;
    memcpy(transform.m, a->options->transform, sizeof transform.m);
    gno_status status = a->file->mRootNode ? add_node(a, a->file->mRootNode, &transform, 0) : GNO_OK;
    if (status == GNO_OK && a->options->take_camera) status = gnoi_assimp_camera(a);
    if (status == GNO_OK && a->options->take_lights) status = gnoi_assimp_lights(a);
    give_back(a->context, a->material_index, count, sizeof *a->material_index);
    gnoi_textures_free(&a->textures);
    return status;
}

gno_status gnoi_assimp_load(gno_scene *scene, const char *path, const gnoi_mesh_options *options, gnoi_mesh_result *result)
{
    gnoi_assimp a;
    memset(&a, 0, sizeof a);
    a.scene = scene;
    a.context = gno_scene_context(scene);
    a.path = path;
    a.options = options;
    a.result = result;
    a.is_gltf = gnoi_has_extension(path, ".gltf") || gnoi_has_extension(path, ".glb");
    a.is_stl = gnoi_has_extension(path, ".stl");
    a.is_geometry = a.is_stl || gnoi_has_extension(path, ".ply") || gnoi_has_extension(path, ".off");
    gno_status status = check_file(&a);
    if (status != GNO_OK) return status;
    a.file = import(path);
    if (!a.file) return gnoi_mesh_fail(a.context, GNO_ERROR_INPUT, path, 0, "%s", aiGetErrorString());
    status = add_file(&a);
    aiReleaseImport(a.file);
    return status;
}
