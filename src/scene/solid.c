/* solid.c -- the connected parts of a scene, which are closed, and whether a point is outside of one.
 *
 * Place in the data flow: last step of gnoi_scene_prepare; the shadow passes leave half the casters of a closed part away.
 * A part is closed when the directed edges of its polygons cancel. No table of edges is needed to see it: every edge from
 * a lower to a higher vertex number adds a pseudo-random number of the pair, every edge the other way takes it away; two
 * independent sums of 64 bits are zero if the edges cancel, and by chance only once in 2^128 if they do not.
 * The winding number of a closed part at a point is the sum of signed crossings along any path from far away
 * (Jacobson, Kavan and Sorkine-Hornung, "Robust inside-outside segmentation", 2013, section 2).
 */
#include "scene/prepare.h"

#include <string.h>

typedef struct balance {
    uint64_t sum[2];
    double volume; /* six times */
    int open;
} balance;

static uint64_t scramble(uint64_t x)
{
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return x ^ x >> 31;
}

static void add_edge(balance *b, uint32_t from, uint32_t to)
{
    uint64_t pair, h;
    if (from == to)
        return;
    pair = from < to ? (uint64_t)from << 32 | to : (uint64_t)to << 32 | from;
    h = scramble(pair + 0x9e3779b97f4a7c15u);
    b->sum[0] += from < to ? h : 0 - h;
    h = h * 0xd6e8feb86659fd93u ^ pair; /* a second number of the same pair */
    b->sum[1] += from < to ? h : 0 - h;
}

/* The vertex that stands for the part a vertex belongs to; paths are halved on the way (Tarjan and van Leeuwen 1984). */
static uint32_t root_of(uint32_t *parent, uint32_t v)
{
    while (parent[v] != v) {
        parent[v] = parent[parent[v]];
        v = parent[v];
    }
    return v;
}

static void join(uint32_t *parent, uint32_t v, uint32_t w)
{
    v = root_of(parent, v);
    w = root_of(parent, w);
    if (v < w)
        parent[w] = v;
    else
        parent[v] = w;
}

/* Joins the vertices of every prepared polygon, then numbers the parts; prepared.vertex_solid serves as the forest. Like the
 * passes below, 0 when stopped. */
static int find_parts(gno_context *context, gnoi_prepared *prep)
{
    uint32_t *parent = prep->vertex_solid, count = 0;
    for (uint32_t v = 0; v < prep->vertex_count; v++)
        parent[v] = v;
    for (size_t i = 0; i < prep->poly_count; i++) {
        const uint32_t *corner = prep->corner_vertex + prep->polys[i].corner;
        for (uint32_t k = 1; k < prep->polys[i].corner_count; k++)
            if (parent[corner[k]] != parent[corner[0]])
                join(parent, corner[k], corner[0]);
        if (gnoi_stopped_at(context, i))
            return 0;
    }
    for (uint32_t v = 0; v < prep->vertex_count; v++)
        parent[v] = root_of(parent, v);
    /* A root is the lowest vertex of its part: its number stands before any other vertex asks for it. */
    for (uint32_t v = 0; v < prep->vertex_count; v++)
        parent[v] = parent[v] == v ? count++ : parent[parent[v]];
    prep->solid_count = count;
    return !gnoi_stopped(context);
}

/* Edges of the source polygons, also of those without area, which close seams; not of details, which add nothing to a body. */
static int add_source_edges(const gno_scene *scene, const uint32_t *vertex_number, const unsigned char *is_detail, balance *balances)
{
    const uint32_t *vertex_solid = scene->prepared.vertex_solid;
    for (size_t p = 0; p < scene->polygon_count; p++) {
        unsigned ring = scene->polygon_start[p], from = scene->ring_start[ring], to = scene->ring_start[ring + 1];
        for (unsigned i = from; i < to && !is_detail[p]; i++) {
            uint32_t v = vertex_number[scene->corner_vertex[i]], w = vertex_number[scene->corner_vertex[i + 1 < to ? i + 1 : from]];
            if (v == GNOI_NONE)
                continue;
            balances[vertex_solid[v]].open |= w == GNOI_NONE || vertex_solid[w] != vertex_solid[v] || scene->polygon_start[p + 1] != ring + 1;
            if (w != GNOI_NONE)
                add_edge(&balances[vertex_solid[v]], v, w);
        }
        if (gnoi_stopped_at(scene->context, p))
            return 0;
    }
    return 1;
}

static void grow_bounds(gnoi_solid *s, const double p[3])
{
    for (int k = 0; k < 3; k++) {
        s->lower[k] = p[k] < s->lower[k] ? p[k] : s->lower[k];
        s->upper[k] = p[k] > s->upper[k] ? p[k] : s->upper[k];
    }
}

/* Bounds, signed volume (of pyramids over the polygons' planes) and opacity. */
static int add_prepared(const gno_scene *scene, balance *balances)
{
    const gnoi_prepared *prep = &scene->prepared;
    for (size_t i = 0; i < prep->poly_count; i++) {
        const gnoi_poly *poly = &prep->polys[i];
        uint32_t solid = gnoi_solid_of(prep, poly);
        vec3 first = v3_from(prep->positions[prep->corner_vertex[poly->corner]]), sum = v3(0, 0, 0), before = v3(0, 0, 0);
        if (poly->detail)
            continue;
        balances[solid].open |= !poly->opaque || !poly->two_sided;
        grow_bounds(&prep->solids[solid], prep->positions[prep->corner_vertex[poly->corner]]);
        for (uint32_t k = 1; k < poly->corner_count; k++) {
            const double *p = prep->positions[prep->corner_vertex[poly->corner + k]];
            vec3 q = v3_sub(v3_from(p), first);
            grow_bounds(&prep->solids[solid], p);
            sum = v3_add(sum, v3_cross(before, q));
            before = q;
        }
        balances[solid].volume += v3_dot(sum, v3_sub(first, v3_from(prep->lower)));
        if (gnoi_stopped_at(scene->context, i))
            return 0;
    }
    return 1;
}

/* Only parts that are not closed as they are. */
static gno_status cap_open(gno_scene *scene, const balance *balances)
{
    const gnoi_prepared *prep = &scene->prepared;
    unsigned char *may_close = gnoi_calloc(scene->context, prep->solid_count, 1);
    gno_status status;
    if (!may_close)
        return GNO_ERROR_MEMORY;
    for (size_t i = 0; i < prep->solid_count; i++)
        may_close[i] = !balances[i].open && !prep->solids[i].closed;
    status = gnoi_cap_solids(scene, may_close);
    gnoi_free(scene->context, may_close, prep->solid_count, 1);
    return status;
}

gno_status gnoi_find_solids(gno_scene *scene, const uint32_t *vertex_number)
{
    gno_context *context = scene->context;
    gnoi_prepared *prep = &scene->prepared;
    unsigned char *is_detail; /* of source polygons */
    balance *balances;
    gno_status status = GNO_ERROR_MEMORY;
    prep->vertex_solid = gnoi_malloc(context, prep->vertex_capacity, sizeof *prep->vertex_solid);
    if (!prep->vertex_solid)
        return GNO_ERROR_MEMORY;
    if (!find_parts(context, prep))
        return GNO_ERROR_MEMORY;
    balances = gnoi_calloc(context, prep->solid_count, sizeof *balances);
    is_detail = gnoi_calloc(context, scene->polygon_count, 1);
    prep->solids = gnoi_calloc(context, prep->solid_count, sizeof *prep->solids);
    if (balances && is_detail && prep->solids) {
        for (size_t i = 0; i < prep->poly_count; i++)
            is_detail[prep->polys[i].source] = (unsigned char)prep->polys[i].detail;
        for (size_t i = 0; i < prep->solid_count; i++)
            for (int k = 0; k < 3; k++) {
                prep->solids[i].lower[k] = HUGE_VAL;
                prep->solids[i].upper[k] = -HUGE_VAL;
            }
        int good = add_source_edges(scene, vertex_number, is_detail, balances) && add_prepared(scene, balances);
        for (size_t i = 0; i < prep->solid_count; i++) {
            balances[i].open |= !(prep->solids[i].lower[0] <= prep->solids[i].upper[0]); /* details alone */
            prep->solids[i].closed = !balances[i].open && balances[i].sum[0] == 0 && balances[i].sum[1] == 0;
            prep->solids[i].cap = GNOI_NONE;
            prep->solids[i].outwards = balances[i].volume > 0;
        }
        if (good)
            status = cap_open(scene, balances);
    }
    gnoi_free(context, balances, prep->solid_count, sizeof *balances);
    gnoi_free(context, is_detail, scene->polygon_count, 1);
    return status;
}

/* Signed crossing of the half line from `point` along the z axis with a polygon, in a frame turned so that the line meets no
 * edge of axis-aligned models: +1, -1, 0, or 2 where an edge comes too near to tell. */
static int crossing(const gnoi_prepared *prep, const gnoi_poly *poly, vec3 point, vec3 u, vec3 v, vec3 along)
{
    uint32_t n = poly->corner_count;
    vec3 at = v3_sub(v3_from(prep->positions[prep->corner_vertex[poly->corner + n - 1]]), point);
    double x0 = v3_dot(at, u), y0 = v3_dot(at, v), facing = v3_dot(v3_from(poly->n), along);
    int inside = 0;
    for (uint32_t i = 0; i < n; i++) {
        vec3 q = v3_sub(v3_from(prep->positions[prep->corner_vertex[poly->corner + i]]), point);
        double x1 = v3_dot(q, u), y1 = v3_dot(q, v);
        if ((y0 > 0) != (y1 > 0)) {
            double cross = x0 * y1 - x1 * y0;
            if (fabs(cross) <= 1e-9 * (fabs(x0 * y1) + fabs(x1 * y0)))
                return 2;
            inside ^= (cross > 0) == (y1 > y0);
        }
        x0 = x1;
        y0 = y1;
    }
    if (!inside)
        return 0;
    at = v3_sub(v3_from(prep->positions[prep->corner_vertex[poly->corner]]), point);
    if (v3_dot(v3_from(poly->n), at) * facing < 0)
        return 0; /* behind the point */
    return facing > 0 ? 1 : -1;
}

int gnoi_solid_outside(const gno_scene *scene, size_t solid, vec3 point)
{
    const gnoi_prepared *prep = &scene->prepared;
    const gnoi_solid *s = &prep->solids[solid];
    vec3 along = v3_unit(v3(0.2718, 0.3141, 0.9102)), u = v3_unit(v3_cross(along, v3(0.577, -0.214, 0.33))), v = v3_cross(along, u);
    int sum = 0;
    if (s->cap != GNOI_NONE && !gnoi_cap_inside(scene, solid, point))
        return 0;
    if (point.x < s->lower[0] || point.y < s->lower[1] || point.z < s->lower[2] || point.x > s->upper[0] || point.y > s->upper[1] ||
        point.z > s->upper[2])
        return 1;
    for (size_t i = 0; i < prep->poly_count + prep->cap_count; i++) {
        const gnoi_poly *poly = &prep->polys[i];
        int c = 0;
        if (!poly->detail && gnoi_solid_of(prep, poly) == solid)
            c = crossing(prep, poly, point, u, v, along);
        if (c == 2)
            return 0;
        sum += c;
        if (gnoi_stopped_at(scene->context, i))
            return 0;
    }
    return sum == 0;
}
