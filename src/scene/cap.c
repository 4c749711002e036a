/* cap.c -- closes parts whose only opening is one loop in a plane that all of the part is on one side of: a house without a floor.
 *
 * Place in the data flow: solid.c -> here -> the shadow passes, which leave half the casters of a closed part away.
 * A cap is an invisible polygon. It casts no false shadow and hides no true one as long as eye and lamp are on its inner side
 * (gnoi_cap_inside): beyond the cap there is nothing of the part, so a path from either that leaves through the cap was inside,
 * having come in through a real polygon, and no path comes in through the cap. So the eye sees nothing of the inside, and a
 * path from the lamp that crosses the cap has met a real polygon before.
 */
#include "scene/boundary.h"
#include "scene/prepare.h"

#include <string.h>

/* The opening's corners lie on one plane, and the part on one side of it, within the first share of the part's size; it rises above
 * it by more than the second, or it is flat itself and not worth a cap. */
#define CAP_FLAT 1e-9
#define CAP_RISE 1e-3

/* The boundary of one part, and the plane that may close it. */
typedef struct opening {
    uint32_t first, count; /* of work.sorted */
    vec3 n;                /* away from the part */
    double d, size, low;   /* low: the part's least height, negative */
    int good;
} opening;

typedef struct work {
    gno_scene *scene;
    gnoi_boundary boundary;
    gnoi_boundary_edge *sorted; /* the boundary by part */
    opening *openings;          /* one for each part */
    uint32_t *next;             /* for each prepared vertex: where the boundary goes from there, or GNOI_NONE */
} work;

static vec3 position(const work *w, uint32_t vertex) { return v3_from(w->scene->prepared.positions[vertex]); }

static opening *opening_of(const work *w, const gnoi_boundary_edge *e)
{
    return &w->openings[w->scene->prepared.vertex_solid[e->from]];
}

static void sort_by_part(work *w)
{
    uint32_t sum = 0;
    for (size_t i = 0; i < w->boundary.count; i++)
        opening_of(w, &w->boundary.edges[i])->count++;
    for (size_t k = 0; k < w->scene->prepared.solid_count; k++) {
        w->openings[k].first = sum;
        sum += w->openings[k].count;
        w->openings[k].count = 0;
    }
    for (size_t i = 0; i < w->boundary.count; i++) {
        opening *o = opening_of(w, &w->boundary.edges[i]);
        w->sorted[o->first + o->count++] = w->boundary.edges[i];
    }
}

/* 1 when the part's boundary is one loop that passes each of its vertices once. */
static int is_loop(work *w, const opening *o)
{
    const gnoi_boundary_edge *edges = w->sorted + o->first;
    uint32_t v = edges[0].from, steps = 0;
    for (uint32_t i = 0; i < o->count; i++) {
        if (w->next[edges[i].from] != GNOI_NONE)
            return 0;
        w->next[edges[i].from] = edges[i].to;
    }
    do {
        v = w->next[v];
        steps++;
    } while (v != GNOI_NONE && v != edges[0].from && steps < o->count);
    return v == edges[0].from && steps == o->count && steps >= 3;
}

/* The plane of the loop. The cap runs against the part's edges; its normal is away from the part. */
static void set_plane(const work *w, opening *o)
{
    const gnoi_boundary_edge *edges = w->sorted + o->first;
    vec3 first = position(w, edges[0].from), sum = v3(0, 0, 0);
    double length, flat;
    for (uint32_t i = 0; i < o->count; i++)
        sum = v3_sub(sum, v3_cross(v3_sub(position(w, edges[i].from), first), v3_sub(position(w, edges[i].to), first)));
    length = v3_length(sum);
    o->good = length > 0;
    if (!o->good)
        return;
    o->n = v3_scale(sum, 1 / length);
    o->d = -v3_dot(o->n, first);
    flat = CAP_FLAT * o->size;
    for (uint32_t i = 0; i < o->count; i++)
        o->good &= fabs(v3_dot(o->n, position(w, edges[i].from)) + o->d) <= flat;
}

/* The most that a part within its bounds may rise over any plane of normal n. */
static double greatest_rise(const gnoi_solid *s, vec3 n)
{
    return fabs(n.x) * (s->upper[0] - s->lower[0]) + fabs(n.y) * (s->upper[1] - s->lower[1]) + fabs(n.z) * (s->upper[2] - s->lower[2]);
}

static void judge_openings(work *w)
{
    const gnoi_prepared *prep = &w->scene->prepared;
    int any = 0;
    for (size_t k = 0; k < prep->solid_count; k++) {
        opening *o = &w->openings[k];
        const gnoi_solid *s = &prep->solids[k];
        o->size = fabs(s->upper[0] - s->lower[0]) + fabs(s->upper[1] - s->lower[1]) + fabs(s->upper[2] - s->lower[2]);
        o->good = o->count > 0 && is_loop(w, o);
        if (o->good)
            set_plane(w, o);
        o->good = o->good && greatest_rise(s, o->n) > CAP_RISE * o->size;
        any |= o->good;
    }
    /* Inside out, the normal found is towards the part: then heights have the other sign, and the part is on no one side. */
    for (uint32_t v = 0; any && v < prep->vertex_count; v++) {
        opening *o = &w->openings[prep->vertex_solid[v]];
        double h = o->good ? v3_dot(o->n, position(w, v)) + o->d : 0;
        o->good &= h <= CAP_FLAT * o->size;
        o->low = h < o->low ? h : o->low;
    }
    for (size_t k = 0; k < prep->solid_count; k++)
        w->openings[k].good &= w->openings[k].low < -CAP_RISE * w->openings[k].size;
}

/* Makes room for `need` elements; what was there stays when memory fails. */
static void *grow(gno_context *context, void *array, size_t *capacity, size_t need, size_t size)
{
    void *grown = gnoi_realloc(context, array, *capacity, need, size);
    if (grown)
        *capacity = need;
    return grown ? grown : array;
}

/* Caps have no normals or texture coordinates, whose arrays stay as they are. */
static int make_room(gno_scene *scene, size_t caps, size_t corners)
{
    gno_context *context = scene->context;
    gnoi_prepared *p = &scene->prepared;
    size_t polys = p->poly_count + caps, rings = p->ring_count + caps + 1, all = p->corner_count + corners;
    p->polys = grow(context, p->polys, &p->poly_capacity, polys, sizeof *p->polys);
    p->ring_corner = grow(context, p->ring_corner, &p->ring_capacity, rings, sizeof *p->ring_corner);
    p->corner_vertex = grow(context, p->corner_vertex, &p->corner_vertex_capacity, all, sizeof *p->corner_vertex);
    return p->poly_capacity >= polys && p->ring_capacity >= rings && p->corner_vertex_capacity >= all;
}

/* Appends the cap of part k behind the polygons, rings and corners there are; their counts stay those of real polygons. */
static void append_cap(work *w, uint32_t k, size_t *ring, size_t *corner)
{
    gnoi_prepared *p = &w->scene->prepared;
    const opening *o = &w->openings[k];
    const gnoi_boundary_edge *edges = w->sorted + o->first;
    gnoi_poly *cap = &p->polys[p->poly_count + p->cap_count];
    uint32_t v = edges[0].from;
    *cap = p->polys[edges[0].poly];
    cap->n[0] = o->n.x;
    cap->n[1] = o->n.y;
    cap->n[2] = o->n.z;
    cap->d = o->d;
    cap->ring = (uint32_t)*ring;
    cap->corner = (uint32_t)*corner;
    cap->ring_count = 1;
    cap->corner_count = o->count;
    cap->triangle = GNOI_NONE;
    cap->shading = GNO_SHADING_FLAT;
    for (uint32_t i = o->count; i-- > 0; v = w->next[v])
        p->corner_vertex[*corner + i] = v;
    *corner += o->count;
    p->ring_corner[++*ring] = (uint32_t)*corner;
    p->solids[k].closed = 1;
    p->solids[k].outwards = 1;
    p->solids[k].cap = (uint32_t)(p->poly_count + p->cap_count++);
}

static int append_caps(work *w)
{
    gnoi_prepared *p = &w->scene->prepared;
    size_t caps = 0, corners = 0, ring = p->ring_count, corner = p->corner_count;
    for (size_t k = 0; k < p->solid_count; k++)
        if (w->openings[k].good) {
            caps++;
            corners += w->openings[k].count;
        }
    if (caps == 0 || p->corner_count + corners >= GNOI_NONE || p->poly_count + caps >= GNOI_NONE)
        return 1;
    if (!make_room(w->scene, caps, corners))
        return 0;
    for (uint32_t k = 0; k < p->solid_count; k++)
        if (w->openings[k].good)
            append_cap(w, k, &ring, &corner);
    return 1;
}

gno_status gnoi_cap_solids(gno_scene *scene, const unsigned char *taken)
{
    gno_context *context = scene->context;
    const gnoi_prepared *prep = &scene->prepared;
    const size_t vertices = prep->vertex_count, parts = prep->solid_count;
    int good;
    work w;
    memset(&w, 0, sizeof w);
    w.scene = scene;
    good = gnoi_boundary_find(context, prep, taken, prep->poly_count, NULL, &w.boundary);
    w.sorted = gnoi_malloc(context, w.boundary.count, sizeof *w.sorted);
    w.openings = gnoi_calloc(context, parts, sizeof *w.openings);
    w.next = gnoi_malloc(context, vertices, sizeof *w.next);
    good = good && w.sorted && w.openings && w.next;
    if (good && w.boundary.count) {
        memset(w.next, 0xff, vertices * sizeof *w.next);
        sort_by_part(&w);
        judge_openings(&w);
        good = append_caps(&w);
    }
    gnoi_free(context, w.sorted, w.boundary.count, sizeof *w.sorted);
    gnoi_free(context, w.openings, parts, sizeof *w.openings);
    gnoi_free(context, w.next, vertices, sizeof *w.next);
    gnoi_boundary_free(context, &w.boundary);
    return good ? GNO_OK : GNO_ERROR_MEMORY;
}

int gnoi_cap_inside(const gno_scene *scene, size_t solid, vec3 point)
{
    const gnoi_poly *cap = &scene->prepared.polys[scene->prepared.solids[solid].cap];
    return v3_dot(v3_from(cap->n), point) + cap->d < -CAP_FLAT * scene->prepared.scale;
}
