/* solid.c -- the connected parts of a scene, and which are closed.
 *
 * Place in the data flow: details.c -> here -> cap.c; the shadow passes leave half the casters of a closed part away (outside.c).
 * A part is closed when the directed edges of its polygons cancel. No table of edges is needed to see it: every edge from
 * a lower to a higher vertex number adds a pseudo-random number of the pair, every edge the other way takes it away; two
 * independent sums of 64 bits are zero if the edges cancel, and by chance only once in 2^128 if they do not.
 * Parts are numbered by their lowest vertices. A chunk of polygons adds what it finds of parts that begin in it where they are kept, and
 * what it finds of earlier parts to tallies of its own, which are brought together in the order of chunks.
 */
#include "base/parallel.h"
#include "scene/chunks.h"
#include "scene/prepare.h"

#include <string.h>

#define LOOK_BACK 8 /* tallies looked at for one of the same part */

/* What is known of a part, or of a chunk's share of it. */
typedef struct tally {
    uint64_t sum[2];
    double volume; /* six times */
    double lower[3], upper[3];
    uint32_t solid, first, last; /* the polygons of it lie in [first,last] */
    int open;
} tally;

typedef struct tallies {
    size_t count, capacity;
    tally *items;
} tallies;

typedef struct finding {
    gnoi_preparing *w;
    gno_context *context;
    gnoi_prepared *prep;
    uint32_t *first_solid; /* of each chunk: parts that begin in an earlier one have lower numbers */
    tally *whole;          /* of each part */
    tallies *shares;       /* of each chunk: of earlier parts */
} finding;

/* ---- parts ----------------------------------------------------------------------------------------------------------- */

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

static void join_run(void *user, size_t first, size_t end)
{
    const gnoi_prepared *prep = user;
    uint32_t *parent = prep->vertex_solid;
    for (size_t i = first; i < end; i++) {
        const uint32_t *corner = prep->corner_vertex + prep->polys[i].corner;
        for (uint32_t k = 1; k < prep->polys[i].corner_count; k++)
            if (parent[corner[k]] != parent[corner[0]])
                join(parent, corner[k], corner[0]);
    }
}

/* Joins the vertices of every prepared polygon, then numbers the parts; prepared.vertex_solid serves as the forest. */
static gno_status find_parts(const finding *f)
{
    gnoi_prepared *prep = f->prep;
    uint32_t *parent = prep->vertex_solid, count = 0;
    gno_status status;
    for (uint32_t v = 0; v < prep->vertex_count; v++)
        parent[v] = v;
    status = gnoi_over_polygons(f->context, prep, f->w->threads, join_run, prep);
    /* A vertex hangs from lower ones only: their part's number stands before it is asked for. */
    for (size_t k = 0; k < prep->chunk_count; k++) {
        f->first_solid[k] = count;
        for (uint32_t v = prep->chunk_vertex[k]; v < prep->chunk_vertex[k + 1]; v++)
            parent[v] = parent[v] == v ? count++ : parent[parent[v]];
    }
    prep->solid_count = count;
    return status;
}

/* ---- tallies ----------------------------------------------------------------------------------------------------------- */

static void clear_tally(tally *t, uint32_t solid)
{
    memset(t, 0, sizeof *t);
    t->solid = solid;
    t->first = GNOI_NONE;
    for (int k = 0; k < 3; k++) {
        t->lower[k] = HUGE_VAL;
        t->upper[k] = -HUGE_VAL;
    }
}

static void add_tally(tally *t, const tally *share)
{
    t->sum[0] += share->sum[0];
    t->sum[1] += share->sum[1];
    t->volume += share->volume;
    t->open |= share->open;
    t->first = share->first < t->first ? share->first : t->first;
    t->last = share->last > t->last ? share->last : t->last;
    for (int k = 0; k < 3; k++) {
        t->lower[k] = share->lower[k] < t->lower[k] ? share->lower[k] : t->lower[k];
        t->upper[k] = share->upper[k] > t->upper[k] ? share->upper[k] : t->upper[k];
    }
}

static uint64_t scramble(uint64_t x)
{
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return x ^ x >> 31;
}

static inline void add_edge(tally *t, uint32_t from, uint32_t to)
{
    uint64_t pair = from < to ? (uint64_t)from << 32 | to : (uint64_t)to << 32 | from, h = scramble(pair + 0x9e3779b97f4a7c15u);
    uint64_t other = h * 0xd6e8feb86659fd93u ^ pair; /* a second number of the same pair */
    uint64_t sign = from < to ? 0 : ~(uint64_t)0;    /* minus x is ~x + 1 */
    if (from == to)
        return;
    t->sum[0] += (h ^ sign) - sign;
    t->sum[1] += (other ^ sign) - sign;
}

/* Edges, bounds, signed volume (of pyramids over the polygons' planes) and opacity. A polygon with holes never closes a part. */
static void add_polygon(const gnoi_prepared *prep, uint32_t i, tally *t)
{
    const gnoi_poly *poly = &prep->polys[i];
    const uint32_t *vertex = prep->corner_vertex + poly->corner;
    const uint32_t n = poly->corner_count;
    vec3 first = v3_from(prep->positions[vertex[0]]), sum = v3(0, 0, 0), before = v3(0, 0, 0);
    t->open |= !poly->opaque || !poly->two_sided || poly->ring_count > 1;
    t->first = i < t->first ? i : t->first;
    t->last = i;
    for (uint32_t k = 0; k < n; k++) {
        const double *p = prep->positions[vertex[k]];
        vec3 q = v3_sub(v3_from(p), first);
        add_edge(t, vertex[k], vertex[k + 1 < n ? k + 1 : 0]);
        for (int axis = 0; axis < 3; axis++) {
            t->lower[axis] = p[axis] < t->lower[axis] ? p[axis] : t->lower[axis];
            t->upper[axis] = p[axis] > t->upper[axis] ? p[axis] : t->upper[axis];
        }
        sum = v3_add(sum, v3_cross(before, q));
        before = q;
    }
    t->volume += v3_dot(sum, v3_sub(first, v3_from(prep->lower)));
}

/* The chunk's tally of an earlier part: one of the last few, or a new one. NULL without memory. */
static tally *share_of(gno_context *context, tallies *shares, uint32_t solid)
{
    void *array = shares->items;
    for (size_t i = shares->count; i > 0 && i + LOOK_BACK > shares->count; i--)
        if (shares->items[i - 1].solid == solid)
            return &shares->items[i - 1];
    if (!gnoi_reserve(context, &array, &shares->capacity, shares->count + 1, sizeof *shares->items))
        return NULL;
    shares->items = array;
    clear_tally(&shares->items[shares->count], solid);
    return &shares->items[shares->count++];
}

static gno_status tally_chunk(void *user, int worker, size_t chunk)
{
    const finding *f = user;
    const gnoi_prepared *prep = f->prep;
    size_t end = (chunk + 1) * GNOI_CHUNK < prep->poly_count ? (chunk + 1) * GNOI_CHUNK : prep->poly_count;
    tallies shares = {0};
    tally *t = NULL;
    gno_status status = GNO_OK;
    (void)worker;
    for (size_t i = chunk * GNOI_CHUNK; i < end && !status; i++) {
        uint32_t solid = gnoi_solid_of(prep, &prep->polys[i]);
        if (prep->polys[i].detail)
            continue;
        if (!t || t->solid != solid)
            t = solid >= f->first_solid[chunk] ? &f->whole[solid] : share_of(f->context, &shares, solid);
        if (t)
            add_polygon(prep, (uint32_t)i, t);
        else
            status = GNO_ERROR_MEMORY;
    }
    f->shares[chunk] = shares;
    return status;
}

/* ---- polygons without area ---------------------------------------------------------------------------------------------- */

/* Polygons without area close seams. v, w: prepared vertices, GNOI_NONE where only polygons without area are. */
static void add_seam(const finding *f, uint32_t v, uint32_t w, int open)
{
    const uint32_t *vertex_solid = f->prep->vertex_solid;
    tally *t;
    if (v == GNOI_NONE)
        return;
    t = &f->whole[vertex_solid[v]];
    t->open |= open || w == GNOI_NONE || vertex_solid[w] != vertex_solid[v];
    if (w != GNOI_NONE)
        add_edge(t, v, w);
}

static gno_status add_empty(const finding *f)
{
    const gnoi_preparing *w = f->w;
    const gno_scene *scene = w->scene;
    for (size_t p = 0; p < scene->polygon_count && w->measures.empty > 0; p++) {
        unsigned ring = scene->polygon_start[p], from = scene->ring_start[ring], to = scene->ring_start[ring + 1];
        for (unsigned i = from; gnoi_kind_of(w, p) == GNOI_EMPTY && i < to; i++)
            add_seam(f, w->vertex_number[scene->corner_vertex[i]], w->vertex_number[scene->corner_vertex[i + 1 < to ? i + 1 : from]],
                     scene->polygon_start[p + 1] != ring + 1);
        if (gnoi_stopped_at(scene->context, p))
            return GNO_ERROR_CANCELLED;
    }
    for (size_t t = 0; t < w->splits.count; t++)
        for (int k = 0; k < 3 && !w->splits.has_area[t]; k++)
            add_seam(f, w->vertex_number[scene->corner_vertex[w->splits.corner[t][k]]],
                     w->vertex_number[scene->corner_vertex[w->splits.corner[t][(k + 1) % 3]]], 0);
    return GNO_OK;
}

/* ---- the whole ------------------------------------------------------------------------------------------------------------ */

/* Marks the polygons of parts that may be closed by a cap; 0 when there are none. Parts are looked for where they lie, as long as that is
 * less work than looking everywhere. */
static int take_open(const finding *f, unsigned char *taken)
{
    const gnoi_prepared *prep = f->prep;
    size_t looked = 0, any = 0;
    for (size_t k = 0; k < prep->solid_count; k++)
        if (!f->whole[k].open && !prep->solids[k].closed) {
            any = 1;
            looked += (size_t)(f->whole[k].last - f->whole[k].first) + 1;
        }
    for (size_t i = 0; looked > prep->poly_count && i < prep->poly_count; i++) {
        uint32_t k = gnoi_solid_of(prep, &prep->polys[i]);
        taken[i] = !prep->polys[i].detail && !f->whole[k].open && !prep->solids[k].closed;
    }
    for (size_t k = 0; looked <= prep->poly_count && k < prep->solid_count; k++)
        for (size_t i = f->whole[k].first; !f->whole[k].open && !prep->solids[k].closed && i <= f->whole[k].last; i++)
            taken[i] |= !prep->polys[i].detail && gnoi_solid_of(prep, &prep->polys[i]) == k;
    return any != 0;
}

static gno_status cap_open(const finding *f)
{
    unsigned char *taken = gnoi_calloc(f->context, f->prep->poly_count, 1);
    gno_status status = taken ? GNO_OK : GNO_ERROR_MEMORY;
    if (taken && take_open(f, taken))
        status = gnoi_cap_solids(f->w->scene, taken);
    gnoi_free(f->context, taken, f->prep->poly_count, 1);
    return status;
}

static void set_solids(const finding *f)
{
    for (size_t i = 0; i < f->prep->solid_count; i++) {
        tally *t = &f->whole[i];
        gnoi_solid *s = &f->prep->solids[i];
        t->open |= !(t->lower[0] <= t->upper[0]); /* details alone */
        memcpy(s->lower, t->lower, sizeof s->lower);
        memcpy(s->upper, t->upper, sizeof s->upper);
        s->closed = !t->open && t->sum[0] == 0 && t->sum[1] == 0;
        s->cap = GNOI_NONE;
        s->outwards = t->volume > 0;
    }
}

static gno_status tally_solids(const finding *f)
{
    gnoi_prepared *prep = f->prep;
    gno_status status;
    for (uint32_t i = 0; i < prep->solid_count; i++)
        clear_tally(&f->whole[i], i);
    status = gnoi_parallel(f->context, f->w->threads, prep->chunk_count, "prepare", tally_chunk, (void *)f);
    for (size_t k = 0; k < prep->chunk_count && !status; k++)
        for (size_t i = 0; i < f->shares[k].count; i++)
            add_tally(&f->whole[f->shares[k].items[i].solid], &f->shares[k].items[i]);
    if (status == GNO_OK)
        status = add_empty(f);
    if (status == GNO_OK)
        set_solids(f);
    return status;
}

static gno_status find_solids(finding *f)
{
    gnoi_prepared *prep = f->prep;
    gno_status status = GNO_ERROR_MEMORY;
    if (!prep->vertex_solid || !f->first_solid || !f->shares)
        return status;
    status = find_parts(f);
    if (status != GNO_OK)
        return status;
    f->whole = gnoi_malloc(f->context, prep->solid_count, sizeof *f->whole);
    prep->solids = gnoi_calloc(f->context, prep->solid_count, sizeof *prep->solids);
    status = f->whole && prep->solids ? tally_solids(f) : GNO_ERROR_MEMORY;
    if (status == GNO_OK)
        status = cap_open(f);
    gnoi_free(f->context, f->whole, prep->solid_count, sizeof *f->whole);
    return status;
}

gno_status gnoi_find_solids(gnoi_preparing *w)
{
    gno_context *context = w->scene->context;
    gnoi_prepared *prep = w->out;
    const size_t chunks = prep->chunk_count;
    finding f = {w, context, prep, NULL, NULL, NULL};
    gno_status status;
    prep->vertex_solid = gnoi_malloc(context, prep->vertex_capacity, sizeof *prep->vertex_solid);
    f.first_solid = gnoi_malloc(context, chunks, sizeof *f.first_solid);
    f.shares = gnoi_calloc(context, chunks, sizeof *f.shares);
    status = find_solids(&f);
    for (size_t k = 0; f.shares && k < chunks; k++)
        gnoi_free(context, f.shares[k].items, f.shares[k].capacity, sizeof *f.shares[k].items);
    gnoi_free(context, f.first_solid, chunks, sizeof *f.first_solid);
    gnoi_free(context, f.shares, chunks, sizeof *f.shares);
    return status;
}
