/* scene_shape.c -- the polygons of one object: a polygon with holes, a tessellated sphere, a terrain, or a mesh file.
 * Place: scene_object.c -> here -> gno_scene_add_mesh or gnoi_mesh_load.
 */
#include "io/mesh_file.h"
#include "io/scene_yaml.h"

#include <math.h>
#include <string.h>

static gno_status no_memory(gnoi_scene_reader *reader)
{
    return gno_context_fail(reader->context, GNO_ERROR_MEMORY, "out of memory while reading a scene file");
}

static gno_mesh_def def_for(const gnoi_object_entry *entry)
{
    gno_mesh_def def = gno_mesh_def_default();
    def.name = entry->name;
    if (entry->material >= 0) def.material = entry->material;
    def.shading = entry->shading;
    memcpy(def.transform, entry->transform, sizeof def.transform);
    def.priority = entry->priority;
    return def;
}

/* ---- polygon ------------------------------------------------------------------------------------------------------------ */

/* A ring's points go to positions[first..]; with positions NULL they are only counted. */
static gno_status check_ring(const gnoi_yaml *yaml, const gnoi_yaml_node *ring, size_t *corners)
{
    gno_status status = gnoi_need_list(yaml, ring);
    if (status != GNO_OK) return status;
    if (ring->count < 3) {
        return gnoi_yaml_fail(yaml, ring, GNO_ERROR_INPUT, "must have at least 3 points, has %lu", (unsigned long)ring->count);
    }
    *corners += ring->count;
    return GNO_OK;
}

static gno_status read_ring(const gnoi_yaml *yaml, const gnoi_yaml_node *ring, double *positions)
{
    gno_status status = GNO_OK;
    for (const gnoi_yaml_node *point = ring->first; point && status == GNO_OK; point = point->next, positions += 3) {
        status = gnoi_read_point(yaml, point, positions);
    }
    return status;
}

/* Fills the arrays of a definition whose rings are `entry`'s, all corners in a row. */
static gno_status fill_polygon(const gnoi_yaml *yaml, const gnoi_object_entry *entry, double *positions, unsigned *ring_start,
                               int *corner_vertex)
{
    unsigned corner = entry->polygon->count, ring = 1;
    ring_start[0] = 0;
    ring_start[ring] = corner;
    gno_status status = read_ring(yaml, entry->polygon, positions);
    for (const gnoi_yaml_node *hole = entry->holes ? entry->holes->first : NULL; hole && status == GNO_OK; hole = hole->next) {
        status = read_ring(yaml, hole, positions + 3 * (size_t)corner);
        corner += hole->count;
        ring_start[++ring] = corner;
    }
    for (unsigned i = 0; i < corner; i++) corner_vertex[i] = (int)i;
    return status;
}

/* One pair for each corner, the polygon's and then its holes'. */
static gno_status read_uv(const gnoi_yaml *yaml, const gnoi_yaml_node *node, size_t corners, double *texcoords)
{
    gno_status status = gnoi_need_list(yaml, node);
    if (status == GNO_OK && node->count != corners) {
        return gnoi_yaml_fail(yaml, node, GNO_ERROR_INPUT, "must have %lu pairs, one for each corner, has %lu", (unsigned long)corners,
                              (unsigned long)node->count);
    }
    for (const gnoi_yaml_node *pair = status == GNO_OK ? node->first : NULL; pair && status == GNO_OK; pair = pair->next, texcoords += 2) {
        status = gnoi_read_pair(yaml, pair, texcoords);
    }
    return status;
}

static gno_status add_polygon(gnoi_scene_reader *reader, const gnoi_object_entry *entry)
{
    const gnoi_yaml *yaml = reader->yaml;
    size_t corners = 0, rings = 1;
    gno_status status = check_ring(yaml, entry->polygon, &corners);
    if (status == GNO_OK && entry->holes) {
        status = gnoi_need_list(yaml, entry->holes);
        rings += entry->holes->count;
        for (const gnoi_yaml_node *hole = entry->holes->first; hole && status == GNO_OK; hole = hole->next) {
            status = check_ring(yaml, hole, &corners);
        }
    }
    if (status != GNO_OK) return status;
    /* One block for the four arrays, the strictest alignment first; the counts are far from overflow, being nodes of a tree. */
    size_t size = corners * (5 * sizeof(double) + sizeof(int)) + (rings + 1) * sizeof(unsigned);
    double *positions = gno_context_realloc(reader->context, NULL, 0, size);
    if (!positions) return no_memory(reader);
    double *texcoords = positions + 3 * corners;
    int *corner_vertex = (int *)(void *)(positions + 5 * corners);
    unsigned *ring_start = (unsigned *)(void *)(corner_vertex + corners);
    status = fill_polygon(yaml, entry, positions, ring_start, corner_vertex);
    if (status == GNO_OK && entry->uv) status = read_uv(yaml, entry->uv, corners, texcoords);
    if (status == GNO_OK) {
        const unsigned polygon_start[2] = {0, (unsigned)rings};
        gno_mesh_def def = def_for(entry);
        def.vertex_count = def.corner_count = corners;
        def.positions = positions;
        def.polygon_count = 1;
        def.polygon_start = polygon_start;
        def.ring_count = rings;
        def.ring_start = ring_start;
        def.corner_vertex = corner_vertex;
        if (entry->uv) {
            def.texcoord_count = corners;
            def.texcoords = texcoords;
            def.corner_texcoord = corner_vertex;
        }
        status = gnoi_wrap(yaml, entry->node, gno_scene_add_mesh(reader->scene, &def, NULL));
    }
    gno_context_realloc(reader->context, positions, size, 0);
    return status;
}

/* ---- sphere ------------------------------------------------------------------------------------------------------------- */

/* Meridians and bands of latitude. The quadrilaterals between two parallels are planar: isosceles trapezoids. */
enum {
    AROUND = 64,
    BANDS = 32,
    POINTS = AROUND * (BANDS - 1) + 2,
    FACES = AROUND * BANDS,
    CORNERS = AROUND * (2 * 3 + (BANDS - 2) * 4),
    PLACES = (AROUND + 1) * (BANDS + 1) /* on the pattern: the seam's points have two */
};

typedef struct sphere_mesh {
    double positions[POINTS][3], normals[POINTS][3];
    unsigned ring_start[FACES + 1];
    int corners[CORNERS], corner_places[CORNERS];
    double places[PLACES][2];
} sphere_mesh;

typedef struct sphere_entry {
    double center[3], radius;
} sphere_entry;

static void sphere_points(sphere_mesh *mesh, const sphere_entry *sphere)
{
    const double pi = 3.14159265358979323846;
    for (int i = 0; i < POINTS; i++) {
        int band = i == 0 ? 0 : i == POINTS - 1 ? BANDS : 1 + (i - 1) / AROUND;
        double polar = pi * band / BANDS, turn = 2 * pi * ((i - 1) % AROUND) / AROUND;
        int pole = band == 0 || band == BANDS;
        mesh->normals[i][0] = pole ? 0 : sin(polar) * cos(turn);
        mesh->normals[i][1] = pole ? 0 : sin(polar) * sin(turn);
        mesh->normals[i][2] = pole ? (band == 0 ? 1 : -1) : cos(polar);
        for (int k = 0; k < 3; k++) mesh->positions[i][k] = sphere->center[k] + sphere->radius * mesh->normals[i][k];
    }
}

/* The point on the lower edge of a band (0: the north pole, BANDS: the south pole). */
static int sphere_point(int band, int turn)
{
    if (band == 0) return 0;
    return band == BANDS ? POINTS - 1 : 1 + (band - 1) * AROUND + turn % AROUND;
}

/* S from 0 at the x axis around to 1, T from 0 at the south pole to 1 at the north pole. A triangle's pole lies over its middle. */
static void sphere_places(sphere_mesh *mesh)
{
    for (int i = 0; i < PLACES; i++) {
        int band = i / (AROUND + 1), turn = i % (AROUND + 1);
        mesh->places[i][0] = (turn + (band == 0 || band == BANDS ? 0.5 : 0)) / AROUND;
        mesh->places[i][1] = 1 - (double)band / BANDS;
    }
}

static void add_corner(sphere_mesh *mesh, unsigned *corner, int band, int turn)
{
    mesh->corner_places[*corner] = band * (AROUND + 1) + turn;
    mesh->corners[(*corner)++] = sphere_point(band, turn);
}

static void sphere_faces(sphere_mesh *mesh)
{
    unsigned corner = 0, face = 0;
    for (int band = 0; band < BANDS; band++) {
        for (int turn = 0; turn < AROUND; turn++) {
            mesh->ring_start[face++] = corner;
            add_corner(mesh, &corner, band, turn);
            add_corner(mesh, &corner, band + 1, turn);
            if (band < BANDS - 1) add_corner(mesh, &corner, band + 1, turn + 1);
            if (band > 0) add_corner(mesh, &corner, band, turn + 1);
        }
    }
    mesh->ring_start[face] = corner;
}

static gno_status add_sphere(gnoi_scene_reader *reader, const gnoi_object_entry *entry)
{
    static const gnoi_field fields[] = {
        {.key = "center", .kind = GNOI_FIELD_POINT, .offset = offsetof(sphere_entry, center)},
        {.key = "radius", .kind = GNOI_FIELD_ABOVE_0, .offset = offsetof(sphere_entry, radius)},
    };
    const gnoi_yaml_node *seen[2];
    sphere_entry sphere = {{0, 0, 0}, 1};
    gno_status status = gnoi_read_fields(reader->yaml, entry->sphere, fields, 2, &sphere, seen);
    if (status != GNO_OK) return status;
    for (int i = 0; i < 2; i++) {
        if (!seen[i]) return gnoi_yaml_fail_missing(reader->yaml, entry->sphere, fields[i].key, "is missing");
    }
    sphere_mesh *mesh = gno_context_realloc(reader->context, NULL, 0, sizeof *mesh);
    if (!mesh) return no_memory(reader);
    sphere_points(mesh, &sphere);
    sphere_places(mesh);
    sphere_faces(mesh);
    gno_mesh_def def = def_for(entry);
    def.vertex_count = def.normal_count = POINTS;
    def.positions = mesh->positions[0];
    def.normals = mesh->normals[0];
    def.polygon_count = def.ring_count = FACES;
    def.ring_start = mesh->ring_start;
    def.corner_count = CORNERS;
    def.corner_vertex = def.corner_normal = mesh->corners;
    def.texcoord_count = PLACES;
    def.texcoords = mesh->places[0];
    def.corner_texcoord = mesh->corner_places;
    status = gnoi_wrap(reader->yaml, entry->node, gno_scene_add_mesh(reader->scene, &def, NULL));
    gno_context_realloc(reader->context, mesh, sizeof *mesh, 0);
    return status;
}

/* ---- mesh file ---------------------------------------------------------------------------------------------------------- */

/* The mesh's path as the program has to open it: relative to the scene file's folder. */
static char *join_path(gnoi_scene_reader *reader, const char *mesh, size_t *size)
{
    const char *slash = strrchr(reader->path, '/');
    size_t folder = slash && mesh[0] != '/' ? (size_t)(slash - reader->path) + 1 : 0, length = strlen(mesh);
    *size = folder + length + 1;
    char *path = gno_context_realloc(reader->context, NULL, 0, *size);
    if (!path) return NULL;
    memcpy(path, reader->path, folder);
    memcpy(path + folder, mesh, length + 1);
    return path;
}

static gno_status add_mesh(gnoi_scene_reader *reader, const gnoi_object_entry *entry)
{
    size_t size;
    gnoi_mesh_options options = gnoi_mesh_options_default();
    char *path = join_path(reader, entry->mesh, &size);
    if (!path) return no_memory(reader);
    options.material = entry->material;
    options.shading = entry->shading;
    options.average_normals = entry->average_normals;
    options.crease = entry->crease;
    options.weighting = (gno_weighting)entry->weighting;
    memcpy(options.transform, entry->transform, sizeof options.transform);
    options.priority = entry->priority;
    options.find_details = entry->find_details;
    options.name = entry->name;
    gno_status status = gnoi_wrap(reader->yaml, entry->mesh_node, gnoi_mesh_load(reader->scene, path, &options, NULL));
    gno_context_realloc(reader->context, path, size, 0);
    return status;
}

gno_status gnoi_add_shape(gnoi_scene_reader *reader, const gnoi_object_entry *entry)
{
    if (entry->polygon) return add_polygon(reader, entry);
    if (entry->terrain) {
        gno_mesh_def look = def_for(entry);
        look.crease = entry->crease;
        look.weighting = (gno_weighting)entry->weighting;
        return gnoi_add_terrain(reader, entry->terrain, &look);
    }
    return entry->sphere ? add_sphere(reader, entry) : add_mesh(reader, entry);
}
