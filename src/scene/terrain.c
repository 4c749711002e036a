/* terrain.c -- fractal ground: a polygon subdivided again and again, with random displacements.
 *
 * Place in the data flow: gno_terrain -> here -> gno_scene_add_mesh.
 *   polygon -> one quadrilateral a corner, of the corner, the middles of its two sides and the polygon's centre -> each of these into
 *   four, and so on; centres and middles move along the polygon's normal by random heights that shrink from level to level
 * Whether an edge is divided, and where its middle comes to lie, depends on its two ends alone: faces on both sides agree without
 * knowing of each other. A face all of whose edges are divided is divided; one with some is closed by a fan about its centre that takes
 * up whatever its edges became. So there are no cracks where levels differ, nor along an edge that two terrains share.
 * Invariants: each middle is one vertex, made once; equal definitions give equal bits.
 * Source: textbook section 8.5 (fractal surfaces); Fournier, Fussell and Carpenter, "Computer rendering of stochastic models", 1982.
 */
#include "base/vec.h"
#include "scene/scene.h"

#include <string.h>

#define MOST_LEVELS 14
#define MOST_TERRAIN_CORNERS 65536
#define MOST_TRIANGLES 33554432 /* 2^25: 12 levels of a square, some 3 GB while it grows; more is a slip of the pen */
#define STEP 65536              /* triangles from one look at the progress callback to the next */

typedef struct edge_entry {
    uint32_t a, b, middle; /* a < b; middle GNOI_NONE: a free place */
} edge_entry;

typedef struct growing {
    gno_context *context;
    const gno_terrain *def;
    const double *transform;
    vec3 up, along, across;  /* unit normal, and two axes of the polygon's plane */
    vec3 origin;
    double low[2], span[2];  /* of the corners along the two axes, for texture coordinates */
    double swing[MOST_LEVELS + 1]; /* largest displacement at a level */
    size_t vertex_count, position_capacity, key_capacity, texcoord_capacity;
    double (*positions)[3];
    uint64_t *keys;          /* what a vertex's randomness comes from: hashed from the corners' positions and the seed */
    double (*texcoords)[2];
    size_t corner_count, corner_capacity;
    int *corners;            /* of triangles */
    size_t edge_count, edge_capacity; /* a power of two */
    edge_entry *edges;
    double expected;         /* triangles, if all were divided */
    gno_status failed;       /* sticky; its message is set where it is CANCELLED */
} growing;

gno_terrain gno_terrain_default(void)
{
    gno_terrain terrain;
    memset(&terrain, 0, sizeof terrain);
    terrain.height = 1;
    terrain.roughness = 0.5;
    terrain.levels = 6;
    terrain.least_levels = 2;
    return terrain;
}

/* ---- randomness -------------------------------------------------------------------------------------------------- */

/* MurmurHash3's finalizer (Appleby). */
static uint64_t stir(uint64_t h)
{
    h ^= h >> 33;
    h *= 0xff51afd7ed558ccdu;
    h ^= h >> 33;
    h *= 0xc4ceb9fe1a85ec53u;
    return h ^ (h >> 33);
}

static uint64_t key_of_corner(vec3 p, unsigned seed)
{
    double xyz[3] = {p.x + 0.0, p.y + 0.0, p.z + 0.0}; /* -0 is 0 */
    uint64_t bits[3], h = stir((uint64_t)seed + 0x9e3779b97f4a7c15u);
    int k;
    memcpy(bits, xyz, sizeof bits);
    for (k = 0; k < 3; k++) {
        h = stir(h ^ bits[k]) + 0x9e3779b97f4a7c15u;
    }
    return h;
}

/* The same whichever comes first. */
static uint64_t key_of_pair(uint64_t a, uint64_t b)
{
    return stir(stir(a < b ? a : b) + (a < b ? b : a));
}

/* In [-1, 1]. */
static double swing_of(uint64_t key)
{
    return (double)(stir(key) >> 11) / 4503599627370495.5 - 1;
}

/* ---- vertices ---------------------------------------------------------------------------------------------------- */

static vec3 position_of(const growing *g, uint32_t vertex)
{
    return v3_from(g->positions[vertex]);
}

static void fail(growing *g, gno_status status)
{
    g->failed = g->failed != GNO_OK ? g->failed : status;
}

/* Grows the array also after an earlier failure: whoever calls takes the place it then has. */
static void reserve(growing *g, void **array, size_t *capacity, size_t need, size_t size)
{
    if (!gnoi_reserve(g->context, array, capacity, need, size)) {
        fail(g, GNO_ERROR_MEMORY);
    }
}

/* Returns 0, which is a vertex, when it fails: indices stay valid. */
static uint32_t add_vertex(growing *g, vec3 p, uint64_t key)
{
    size_t i = g->vertex_count;
    vec3 from = v3_sub(p, g->origin);
    void *positions = g->positions, *keys = g->keys, *texcoords = g->texcoords;
    if (i >= MOST_TRIANGLES) {
        fail(g, GNO_ERROR_LIMIT);
        return 0;
    }
    reserve(g, &positions, &g->position_capacity, i + 1, sizeof *g->positions);
    reserve(g, &keys, &g->key_capacity, i + 1, sizeof *g->keys);
    reserve(g, &texcoords, &g->texcoord_capacity, i + 1, sizeof *g->texcoords);
    g->positions = positions;
    g->keys = keys;
    g->texcoords = texcoords;
    if (g->failed != GNO_OK) {
        return 0;
    }
    g->positions[i][0] = p.x;
    g->positions[i][1] = p.y;
    g->positions[i][2] = p.z;
    g->keys[i] = key;
    g->texcoords[i][0] = (v3_dot(from, g->along) - g->low[0]) / g->span[0];
    g->texcoords[i][1] = (v3_dot(from, g->across) - g->low[1]) / g->span[1];
    g->vertex_count++;
    return (uint32_t)i;
}

static vec3 transformed(const double t[12], vec3 p)
{
    return v3(t[0] * p.x + t[1] * p.y + t[2] * p.z + t[3], t[4] * p.x + t[5] * p.y + t[6] * p.z + t[7],
              t[8] * p.x + t[9] * p.y + t[10] * p.z + t[11]);
}

/* ---- edges ------------------------------------------------------------------------------------------------------- */

/* The place of edge (a,b) in the table, a < b: its own, or a free one. */
static edge_entry *seek(edge_entry *edges, size_t capacity, uint32_t a, uint32_t b)
{
    size_t i = (size_t)stir(((uint64_t)a << 32) | b) & (capacity - 1);
    while (edges[i].middle != GNOI_NONE && (edges[i].a != a || edges[i].b != b)) {
        i = (i + 1) & (capacity - 1);
    }
    return &edges[i];
}

/* At most half of the table is in use, so that seeking ends. */
static int make_edge_room(growing *g)
{
    size_t capacity = g->edge_capacity ? 2 * g->edge_capacity : 64, i;
    edge_entry *fresh;
    if (2 * (g->edge_count + 1) <= g->edge_capacity) {
        return 1;
    }
    fresh = gnoi_malloc(g->context, capacity, sizeof *fresh);
    if (!fresh) {
        fail(g, GNO_ERROR_MEMORY);
        return 0;
    }
    memset(fresh, 0xff, capacity * sizeof *fresh); /* GNOI_NONE */
    for (i = 0; i < g->edge_capacity; i++) {
        if (g->edges[i].middle != GNOI_NONE) {
            *seek(fresh, capacity, g->edges[i].a, g->edges[i].b) = g->edges[i];
        }
    }
    gnoi_free(g->context, g->edges, g->edge_capacity, sizeof *g->edges);
    g->edges = fresh;
    g->edge_capacity = capacity;
    return 1;
}

/* By the edge alone: its ends and its level, which is that of the faces on both sides. */
static int is_divided(const growing *g, vec3 a, vec3 b, int level)
{
    vec3 p, q, middle;
    if (level >= g->def->levels) {
        return 0;
    }
    if (level < g->def->least_levels || !(g->def->detail > 0)) {
        return 1;
    }
    p = transformed(g->transform, a);
    q = transformed(g->transform, b);
    middle = v3_scale(v3_add(p, q), 0.5);
    return v3_length(v3_sub(p, q)) > g->def->detail * v3_length(v3_sub(middle, v3_from(g->def->viewer)));
}

/* The vertex in the middle of an edge of this level, GNOI_NONE where it is not divided. */
static uint32_t middle_of(growing *g, uint32_t a, uint32_t b, int level)
{
    uint32_t low = a < b ? a : b, high = a < b ? b : a;
    vec3 p = position_of(g, low), q = position_of(g, high), middle;
    edge_entry *e;
    uint64_t key;
    if (g->failed != GNO_OK || !is_divided(g, p, q, level) || !make_edge_room(g)) {
        return GNOI_NONE;
    }
    e = seek(g->edges, g->edge_capacity, low, high);
    if (e->middle == GNOI_NONE) {
        key = key_of_pair(g->keys[low], g->keys[high]);
        middle = v3_mad(v3_scale(v3_add(p, q), 0.5), g->up, g->swing[level] * swing_of(key));
        e->a = low;
        e->b = high;
        e->middle = add_vertex(g, middle, key);
        g->edge_count++;
    }
    return e->middle;
}

/* ---- faces ------------------------------------------------------------------------------------------------------- */

static void add_triangle(growing *g, uint32_t a, uint32_t b, uint32_t c)
{
    void *array = g->corners;
    size_t i = g->corner_count;
    reserve(g, &array, &g->corner_capacity, i + 3, sizeof *g->corners);
    g->corners = array;
    if (g->failed != GNO_OK) {
        return;
    }
    g->corners[i] = (int)a;
    g->corners[i + 1] = (int)b;
    g->corners[i + 2] = (int)c;
    g->corner_count += 3;
    if (g->corner_count / 3 > MOST_TRIANGLES) {
        fail(g, GNO_ERROR_LIMIT);
    } else if (g->corner_count / 3 % STEP == 0) {
        fail(g, gnoi_progress(g->context, "terrain", (double)(g->corner_count / 3) / g->expected));
    }
}

/* Triangles between a centre and whatever an edge became. */
static void add_fan(growing *g, uint32_t centre, uint32_t a, uint32_t b, int level)
{
    uint32_t middle = middle_of(g, a, b, level);
    if (middle == GNOI_NONE) {
        add_triangle(g, centre, a, b);
        return;
    }
    add_fan(g, centre, a, middle, level + 1);
    add_fan(g, centre, middle, b, level + 1);
}

static uint32_t add_centre(growing *g, const uint32_t *corners, size_t count, int level)
{
    vec3 sum = v3(0, 0, 0);
    uint64_t key = 0;
    size_t i;
    for (i = 0; i < count; i++) {
        sum = v3_add(sum, position_of(g, corners[i]));
        key += stir(g->keys[corners[i]] ^ 0x5851f42d4c957f2du); /* in any order */
    }
    return add_vertex(g, v3_mad(v3_scale(sum, 1.0 / (double)count), g->up, g->swing[level] * swing_of(key)), key);
}

static void add_face(growing *g, const uint32_t corners[4], int level)
{
    uint32_t middles[4], centre, part[4];
    int i, divided = 0;
    for (i = 0; i < 4; i++) {
        middles[i] = middle_of(g, corners[i], corners[(i + 1) % 4], level);
        divided += middles[i] != GNOI_NONE;
    }
    if (g->failed != GNO_OK) {
        return;
    }
    if (divided == 0) {
        add_triangle(g, corners[0], corners[1], corners[2]);
        add_triangle(g, corners[0], corners[2], corners[3]);
        return;
    }
    centre = add_centre(g, corners, 4, level);
    for (i = 0; i < 4; i++) {
        if (divided == 4) {
            part[0] = corners[i];
            part[1] = middles[i];
            part[2] = centre;
            part[3] = middles[(i + 3) % 4];
            add_face(g, part, level + 1);
        } else {
            add_fan(g, centre, corners[i], corners[(i + 1) % 4], level);
        }
    }
}

/* The polygon itself, of any number of corners; these are the first vertices. */
static void add_polygon(growing *g, uint32_t *corners, uint32_t *middles, size_t count)
{
    size_t i;
    size_t divided = 0;
    uint32_t centre, part[4];
    for (i = 0; i < count; i++) {
        vec3 p = v3_from(g->def->corners + 3 * i);
        corners[i] = add_vertex(g, p, key_of_corner(p, g->def->seed));
    }
    for (i = 0; i < count && g->failed == GNO_OK; i++) {
        middles[i] = middle_of(g, corners[i], corners[(i + 1) % count], 0);
        divided += middles[i] != GNOI_NONE;
    }
    if (g->failed != GNO_OK) {
        return;
    }
    centre = add_centre(g, corners, count, 0);
    for (i = 0; i < count && g->failed == GNO_OK; i++) {
        if (divided == count) {
            part[0] = corners[i];
            part[1] = middles[i];
            part[2] = centre;
            part[3] = middles[(i + count - 1) % count];
            add_face(g, part, 1);
        } else {
            add_fan(g, centre, corners[i], corners[(i + 1) % count], 0);
        }
    }
}

/* ---- definition -------------------------------------------------------------------------------------------------- */

static int all_in(const double *values, size_t count, double most)
{
    size_t i;
    for (i = 0; i < count; i++) {
        if (!(fabs(values[i]) <= most)) {
            return 0;
        }
    }
    return 1;
}

/* Triangles if all is divided everywhere. */
static double most_triangles(const gno_terrain *t)
{
    double most = 2.0 * (double)t->corner_count;
    int level;
    for (level = 1; level < t->levels; level++) {
        most *= 4;
    }
    return most;
}

static gno_status check(gno_context *context, const gno_terrain *t)
{
    const char *wrong = NULL;
    if (t->corner_count < 3 || t->corner_count > MOST_TERRAIN_CORNERS || !t->corners) {
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "terrain: %zu corners are not 3 to %d", t->corner_count, MOST_TERRAIN_CORNERS);
    }
    if (!all_in(t->corners, 3 * t->corner_count, GNO_MAX_COORDINATE)) {
        wrong = "corners";
    } else if (!all_in(&t->height, 1, GNO_MAX_COORDINATE) || t->height < 0) {
        wrong = "height";
    } else if (!(t->roughness > 0 && t->roughness <= 1)) {
        wrong = "roughness";
    } else if (t->levels < 0 || t->levels > MOST_LEVELS) {
        wrong = "levels";
    } else if (t->least_levels < 0 || t->least_levels > MOST_LEVELS) {
        wrong = "least_levels";
    } else if (!all_in(&t->detail, 1, GNO_MAX_COORDINATE) || t->detail < 0) {
        wrong = "detail";
    } else if (!all_in(t->viewer, 3, GNO_MAX_COORDINATE)) {
        wrong = "viewer";
    }
    if (wrong) {
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "terrain: %s is out of range", wrong);
    }
    if (!(t->detail > 0) && most_triangles(t) > MOST_TRIANGLES) {
        return gnoi_fail(context, GNO_ERROR_LIMIT, "terrain: %d levels of %zu corners make more than %d triangles", t->levels,
                         t->corner_count, MOST_TRIANGLES);
    }
    return GNO_OK;
}

/* The frame of the polygon's plane, by its area vector (Newell), and the levels' displacements. */
static gno_status start(growing *g)
{
    const gno_terrain *t = g->def;
    vec3 normal = v3(0, 0, 0), before = v3(0, 0, 0), longest = v3(0, 0, 0), first = v3_from(t->corners);
    double high[2] = {0, 0};
    size_t i;
    int k;
    for (i = 1; i < t->corner_count; i++) {
        vec3 p = v3_sub(v3_from(t->corners + 3 * i), first);
        normal = v3_add(normal, v3_cross(before, p));
        before = p;
        longest = v3_length(p) > v3_length(longest) ? p : longest;
    }
    if (!(v3_length(normal) > 1e-12 * v3_dot(longest, longest))) {
        return gnoi_fail(g->context, GNO_ERROR_ARGUMENT, "terrain: the corners have no area");
    }
    g->up = v3_unit(normal);
    g->origin = first;
    g->along = v3_sub(v3_from(t->corners + 3), first);
    g->along = v3_length(g->along) > 0 ? g->along : longest;
    g->along = v3_unit(v3_mad(g->along, g->up, -v3_dot(g->along, g->up)));
    g->across = v3_cross(g->up, g->along);
    for (i = 0; i < t->corner_count; i++) {
        vec3 p = v3_sub(v3_from(t->corners + 3 * i), first);
        double at[2] = {v3_dot(p, g->along), v3_dot(p, g->across)};
        for (k = 0; k < 2; k++) {
            g->low[k] = i == 0 || at[k] < g->low[k] ? at[k] : g->low[k];
            high[k] = i == 0 || at[k] > high[k] ? at[k] : high[k];
        }
    }
    for (k = 0; k < 2; k++) {
        g->span[k] = high[k] > g->low[k] ? high[k] - g->low[k] : 1;
    }
    g->expected = most_triangles(t);
    g->swing[0] = t->height;
    for (k = 0; k < MOST_LEVELS; k++) {
        g->swing[k + 1] = g->swing[k] * t->roughness;
    }
    return GNO_OK;
}

/* ---- the whole --------------------------------------------------------------------------------------------------- */

static gno_status grow(growing *g)
{
    size_t count = g->def->corner_count;
    uint32_t *corners = gnoi_calloc(g->context, 2 * count, sizeof *corners);
    if (!corners) {
        return gnoi_fail(g->context, GNO_ERROR_MEMORY, "terrain: out of memory");
    }
    add_polygon(g, corners, corners + count, count);
    gnoi_free(g->context, corners, 2 * count, sizeof *corners);
    if (g->failed == GNO_ERROR_LIMIT) {
        return gnoi_fail(g->context, g->failed, "terrain: more than %d triangles", MOST_TRIANGLES);
    }
    return g->failed == GNO_ERROR_MEMORY ? gnoi_fail(g->context, g->failed, "terrain: out of memory") : g->failed;
}

gno_status gno_scene_add_terrain(gno_scene *scene, const gno_terrain *terrain, const gno_mesh_def *look, size_t *first_polygon)
{
    gno_context *context = gno_scene_context(scene);
    gno_mesh_def mesh = look ? *look : gno_mesh_def_default();
    growing g;
    gno_status status;
    if (!scene || !terrain) {
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "gno_scene_add_terrain: scene or terrain is NULL");
    }
    memset(&g, 0, sizeof g);
    g.context = context;
    g.def = terrain;
    g.transform = mesh.transform;
    g.expected = 1;
    status = check(context, terrain);
    if (status == GNO_OK) {
        status = start(&g);
    }
    if (status == GNO_OK) {
        status = grow(&g);
    }
    if (status == GNO_OK) {
        mesh.vertex_count = mesh.texcoord_count = g.vertex_count;
        mesh.positions = g.positions[0];
        mesh.normal_count = 0;
        mesh.normals = NULL;
        mesh.texcoords = g.texcoords[0];
        mesh.polygon_count = mesh.ring_count = g.corner_count / 3;
        mesh.polygon_start = mesh.ring_start = NULL;
        mesh.corner_count = g.corner_count;
        mesh.corner_vertex = mesh.corner_texcoord = g.corners;
        mesh.corner_normal = mesh.polygon_material = NULL;
        status = gno_scene_add_mesh(scene, &mesh, first_polygon);
    }
    gnoi_free(context, g.positions, g.position_capacity, sizeof *g.positions);
    gnoi_free(context, g.keys, g.key_capacity, sizeof *g.keys);
    gnoi_free(context, g.texcoords, g.texcoord_capacity, sizeof *g.texcoords);
    gnoi_free(context, g.corners, g.corner_capacity, sizeof *g.corners);
    gnoi_free(context, g.edges, g.edge_capacity, sizeof *g.edges);
    return status;
}
