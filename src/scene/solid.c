/* solid.c -- the connected parts of a scene, and which are closed.
 *
 * Place in the data flow: details.c -> here -> cap.c; the shadow passes leave half the casters of a closed part away (outside.c).
 * A part is closed when the directed edges of its polygons cancel. No table of edges is needed to see it: every edge adds its number
 * (triangles.h); the sum is zero if the edges cancel, and by chance only once in 2^64 if they do not.
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
    uint64_t sum;
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
    int details;           /* some polygon may be a detail */
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
    const gnoi_preparing *w = user;
    uint32_t *parent = w->out->vertex_solid;
    for (size_t i = first; i < end; i++) {
        uint32_t count;
        const uint32_t *corner = gnoi_corners_of(w->out, i, &count);
        for (uint32_t k = 1; k < count; k++)
            if (parent[corner[k]] != parent[corner[0]])
                join(parent, corner[k], corner[0]);
    }
}

static gno_status start_chunk(void *user, int worker, size_t chunk)
{
    const gnoi_prepared *prep = user;
    (void)worker;
    for (uint32_t v = prep->chunk_vertex[chunk]; v < prep->chunk_vertex[chunk + 1]; v++)
        prep->vertex_solid[v] = v;
    return GNO_OK;
}

/* Joins the vertices of every prepared polygon, then numbers the parts; prepared.vertex_solid serves as the forest. */
static gno_status find_parts(const finding *f)
{
    gnoi_prepared *prep = f->prep;
    uint32_t *parent = prep->vertex_solid, count = 0;
    gno_status status = gnoi_parallel(f->context, f->w->threads, prep->chunk_count, "prepare", start_chunk, prep);
    if (status == GNO_OK)
        status = gnoi_over_polygons(f->context, prep, f->w->threads, join_run, f->w);
    if (status != GNO_OK)
        return status;
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
    t->sum += share->sum;
    t->volume += share->volume;
    t->open |= share->open;
    t->first = share->first < t->first ? share->first : t->first;
    t->last = share->last > t->last ? share->last : t->last;
    for (int k = 0; k < 3; k++) {
        t->lower[k] = share->lower[k] < t->lower[k] ? share->lower[k] : t->lower[k];
        t->upper[k] = share->upper[k] > t->upper[k] ? share->upper[k] : t->upper[k];
    }
}

/* Six times the volume of the pyramid from `base` over a polygon's outer ring, or over all its corners as one ring: only parts
 * without holes use it. */
static double pyramid(const gnoi_prepared *prep, const uint32_t *vertex, uint32_t count, vec3 base)
{
    vec3 first = v3_from(prep->positions[vertex[0]]), sum = v3(0, 0, 0), before = v3(0, 0, 0);
    for (uint32_t k = 1; k < count; k++) {
        vec3 q = v3_sub(v3_from(prep->positions[vertex[k]]), first);
        sum = v3_add(sum, v3_cross(before, q));
        before = q;
    }
    return v3_dot(sum, v3_sub(first, base));
}

/* Edges, signed volume and opacity of the polygons [first,end), all of one part. A polygon with holes never closes a part. */
static void tally_run(const gnoi_preparing *w, size_t first, size_t end, tally *t)
{
    const gnoi_prepared *prep = w->out;
    const vec3 base = v3_from(prep->lower);
    const gnoi_chunk *chunk = &w->chunks[first / GNOI_CHUNK];
    uint64_t sum = 0;
    double volume = 0;
    int known = chunk->summed && first % GNOI_CHUNK == 0 && (end % GNOI_CHUNK == 0 || end == prep->poly_count);
    for (size_t i = first; i < end && !known; i++) {
        uint32_t n;
        const uint32_t *vertex = gnoi_corners_of(prep, i, &n);
        for (uint32_t k = 0; k + 1 < n; k++)
            sum += gnoi_edge_number(vertex[k], vertex[k + 1]);
        sum += gnoi_edge_number(vertex[n - 1], vertex[0]);
        volume += pyramid(prep, vertex, n, base);
    }
    for (size_t i = first; i < end && !chunk->closes; i++)
        t->open |= !prep->polys[i].opaque || !prep->polys[i].two_sided || prep->polys[i].ring_count > 1;
    t->sum += known ? chunk->sums.edges : sum;
    t->volume += known ? chunk->sums.volume : volume;
    t->first = first < t->first ? (uint32_t)first : t->first;
    t->last = (uint32_t)end - 1;
}

static void bound_run(const gnoi_prepared *prep, size_t first, size_t end, tally *t)
{
    double lower[3], upper[3];
    memcpy(lower, t->lower, sizeof lower);
    memcpy(upper, t->upper, sizeof upper);
    for (size_t v = first; v < end; v++)
        for (int k = 0; k < 3; k++) {
            double x = prep->positions[v][k];
            lower[k] = x < lower[k] ? x : lower[k];
            upper[k] = x > upper[k] ? x : upper[k];
        }
    memcpy(t->lower, lower, sizeof lower);
    memcpy(t->upper, upper, sizeof upper);
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

/* Where the chunk keeps what it finds of a part. */
static tally *tally_of(const finding *f, size_t chunk, tallies *shares, uint32_t solid)
{
    return solid >= f->first_solid[chunk] ? &f->whole[solid] : share_of(f->context, shares, solid);
}

static uint32_t solid_of(const finding *f, size_t i)
{
    uint32_t count;
    return f->prep->vertex_solid[gnoi_corners_of(f->prep, i, &count)[0]];
}

static int is_detail(const finding *f, size_t i) { return f->details && f->prep->polys[i].detail; }

static gno_status tally_polygons(const finding *f, size_t chunk, tallies *shares)
{
    const gnoi_prepared *prep = f->prep;
    size_t end = (chunk + 1) * GNOI_CHUNK < prep->poly_count ? (chunk + 1) * GNOI_CHUNK : prep->poly_count;
    for (size_t i = chunk * GNOI_CHUNK, first; i < end;) {
        uint32_t solid = solid_of(f, i);
        tally *t;
        for (first = i; i < end && !is_detail(f, i) && solid_of(f, i) == solid; i++)
            ;
        if (i == first) { /* a detail */
            i++;
            continue;
        }
        t = tally_of(f, chunk, shares, solid);
        if (!t)
            return GNO_ERROR_MEMORY;
        tally_run(f->w, first, i, t);
    }
    return GNO_OK;
}

/* Bounds, of details too. */
static gno_status bound_vertices(const finding *f, size_t chunk, tallies *shares)
{
    const gnoi_prepared *prep = f->prep;
    for (size_t v = prep->chunk_vertex[chunk], end = prep->chunk_vertex[chunk + 1], first; v < end;) {
        uint32_t solid = prep->vertex_solid[v];
        tally *t = tally_of(f, chunk, shares, solid);
        for (first = v; v < end && prep->vertex_solid[v] == solid; v++)
            ;
        if (!t)
            return GNO_ERROR_MEMORY;
        bound_run(prep, first, v, t);
    }
    return GNO_OK;
}

static gno_status tally_chunk(void *user, int worker, size_t chunk)
{
    const finding *f = user;
    tallies shares = {0};
    gno_status status = tally_polygons(f, chunk, &shares);
    (void)worker;
    if (status == GNO_OK)
        status = bound_vertices(f, chunk, &shares);
    f->shares[chunk] = shares;
    return status;
}

/* ---- polygons without area ---------------------------------------------------------------------------------------------- */

/* The prepared vertex of a scene corner, GNOI_NONE where only polygons without area are. */
static uint32_t vertex_at(const finding *f, size_t corner)
{
    return f->w->vertex_number[f->w->same[f->w->scene->corner_vertex[corner]]];
}

static int add_joint(const finding *f, uint32_t vertex)
{
    gnoi_prepared *prep = f->prep;
    if (!gnoi_reserve(f->context, (void **)&prep->joints, &prep->joint_capacity, prep->joint_count + 1, sizeof *prep->joints))
        return 0;
    prep->joints[prep->joint_count++] = vertex;
    return 1;
}

/* Polygons without area close seams. The edge between two scene corners. 0 without memory. */
static int add_seam(const finding *f, size_t from, size_t to, int open)
{
    const uint32_t *vertex_solid = f->prep->vertex_solid;
    uint32_t v = vertex_at(f, from), w = vertex_at(f, to);
    tally *t;
    if (v == GNOI_NONE)
        return 1;
    t = &f->whole[vertex_solid[v]];
    t->open |= open || w == GNOI_NONE || vertex_solid[w] != vertex_solid[v];
    if (w != GNOI_NONE)
        t->sum += gnoi_edge_number(v, w);
    return add_joint(f, v);
}

static gno_status add_empty(const finding *f)
{
    const gnoi_preparing *w = f->w;
    const gno_scene *scene = w->scene;
    for (size_t p = 0, left = w->measures.empty; left > 0; p++) {
        unsigned ring, from, to;
        if (gnoi_stopped_at(scene->context, p))
            return GNO_ERROR_CANCELLED;
        if (gnoi_kind_of(w, p) != GNOI_EMPTY)
            continue;
        left--;
        ring = scene->polygon_start[p];
        from = scene->ring_start[ring];
        to = scene->ring_start[ring + 1];
        for (unsigned i = from; i < to; i++)
            if (!add_seam(f, i, i + 1 < to ? i + 1 : from, scene->polygon_start[p + 1] != ring + 1))
                return GNO_ERROR_MEMORY;
    }
    for (size_t t = 0; t < w->splits.count; t++)
        for (int k = 0; k < 3 && !w->splits.has_area[t]; k++)
            if (!add_seam(f, w->splits.corner[t][k], w->splits.corner[t][(k + 1) % 3], 0))
                return GNO_ERROR_MEMORY;
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

static float round_down(double x)
{
    float f = (float)x;
    return (double)f > x ? nextafterf(f, -HUGE_VALF) : f;
}

static float round_up(double x) { return -round_down(-x); }

static void set_solids(const finding *f)
{
    for (size_t i = 0; i < f->prep->solid_count; i++) {
        tally *t = &f->whole[i];
        gnoi_solid *s = &f->prep->solids[i];
        t->open |= t->first == GNOI_NONE; /* details alone */
        for (int k = 0; k < 3; k++) {
            s->lower[k] = round_down(t->lower[k]);
            s->upper[k] = round_up(t->upper[k]);
        }
        s->closed = !t->open && t->sum == 0;
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

static int has_details(const gno_scene *scene)
{
    size_t i = 0;
    while (i < scene->object_count && scene->objects[i].detail_of < 0 && !scene->objects[i].find_details)
        i++;
    return i < scene->object_count;
}

gno_status gnoi_find_solids(gnoi_preparing *w)
{
    gno_context *context = w->scene->context;
    gnoi_prepared *prep = w->out;
    const size_t chunks = prep->chunk_count;
    finding f = {w, context, prep, has_details(w->scene), NULL, NULL, NULL};
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
