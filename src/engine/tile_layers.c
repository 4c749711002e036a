/* tile_layers.c -- layers beside the picture: depth, normal, texture coordinates, coverage, shadow, ranked numbers: see tile.h.
 *
 * Place in the data flow: while rows are made, every surface leaves a fragment in every pixel it is seen in (tile_rows.c), once
 * for the base lines and once for finer ones. Pixels whose colour asks for no finer lines, but which hold an edge between things that
 * the layers tell apart, get them for the layers alone. When the tile is done its fragments are sorted by pixel and surface, and
 * each pixel is written from its own. Without layers nothing here runs, and with them the picture stays the same, bit for bit.
 * Invariants: lengths are multiples of 2^-16 and at most GNO_MAX_LINES, so that their sums are exact; all fragments of a pixel and
 * its background add up to the lines that cross it. What is seen through other surfaces counts by the share of light that it
 * hides, and sums are then rounded. Nothing depends on the order in which tiles are made.
 * Source: ranked pairs of number and coverage after Friedman and Jones, "Fully automatic ID mattes with support for motion blur and
 * transparency", 2015.
 */
#include "engine/tile.h"
#include "scene/prepare.h"
#include "scene/validate.h"
#include <string.h>

/* Nearly all of a length, as sample_pixel takes it. */
#define WHOLE 0.999999f

/* Of gnoi_fragments.sole. */
#define NOTHING 0u
#define SEVERAL 1u

#define HASH_STEP 0x9e3779b1u

int gnoi_tile_layers_init(gnoi_tile *tile)
{
    const gnoi_frame_job *job = tile->job;
    if (!job->layers || !job->layers->shadow)
        return 1;
    tile->fragments.light = gnoi_calloc(tile->lines.context, job->scene->light_count, sizeof *tile->fragments.light);
    return tile->fragments.light != NULL;
}

void gnoi_tile_layers_free(gnoi_tile *tile)
{
    gno_context *context = tile->lines.context;
    gnoi_fragments *f = &tile->fragments;
    gnoi_free(context, f->list, f->capacity, sizeof *f->list);
    gnoi_free(context, f->order, f->order_capacity, sizeof *f->order);
    gnoi_free(context, f->scratch, f->scratch_capacity, sizeof *f->scratch);
    gnoi_free(context, f->light, tile->job->scene->light_count, sizeof *f->light);
}

void gnoi_tile_layers_start(gnoi_tile *tile)
{
    tile->fragments.count = 0;
    for (int i = 0; i < GNOI_TILE_PIXELS; i++)
        tile->fragments.sole[i] = NOTHING;
    if (tile->fragments.light)
        memset(tile->fragments.light, 0, tile->job->scene->light_count * sizeof *tile->fragments.light);
}

/* ---- while rows are made ------------------------------------------------------------------------------------------- */

static uint32_t polygon_of(const gnoi_tile *tile, uint32_t slot) { return tile->slots[slot].receiver.poly->source; }

static uint32_t object_of(const gnoi_tile *tile, uint32_t slot)
{
    return (uint32_t)tile->job->scene->polygon_object[polygon_of(tile, slot)];
}

static uint32_t material_of(const gnoi_tile *tile, uint32_t slot) { return tile->slots[slot].receiver.poly->material; }

/* The length that a lamp lights of `cover`, coloured light counting by the mean of its channels. */
static float lit_length(const gnoi_tile *tile, const gnoi_column *column, int lamp, int pixel, float cover)
{
    float sum = 0;
    if (column->state != GNOI_COLUMN_SPLIT)
        return column->state == GNOI_COLUMN_LIT ? cover : 0;
    for (int k = 0; k < 3; k++)
        sum += tile->lit_colour[lamp][k][pixel];
    sum /= 3;
    if (tile->veiled) { /* of what reaches the eye */
        float all = (tile->veil.sum[0][pixel] + tile->veil.sum[1][pixel] + tile->veil.sum[2][pixel]) / 3;
        sum = all > 0 ? sum / all * cover : 0;
    }
    return sum > cover * WHOLE ? cover : sum;
}

/* A hash of what the layers asked for tell apart in what this pixel shows of a surface; SEVERAL where a light reaches a part of it. */
static uint32_t identity_of(const gnoi_tile *tile, uint32_t slot, const gnoi_column *columns, int pixel, float length)
{
    const gnoi_frame_job *job = tile->job;
    const gno_layers *layers = job->layers;
    uint32_t hash = 1;
    if (layers->polygons.id)
        hash = hash * HASH_STEP + polygon_of(tile, slot);
    if (layers->objects.id)
        hash = hash * HASH_STEP + object_of(tile, slot);
    if (layers->materials.id)
        hash = hash * HASH_STEP + material_of(tile, slot);
    for (int j = 0; j < job->lamp_count && layers->shadow; j++) {
        float lit = lit_length(tile, &columns[j], j, pixel, length);
        if (lit > 0 && lit < length)
            return SEVERAL;
        hash = hash * HASH_STEP + (lit > 0);
    }
    return hash > SEVERAL ? hash : 2;
}

static void keep_identity(gnoi_tile *tile, uint32_t at, uint32_t identity, float length)
{
    gnoi_fragments *f = &tile->fragments;
    if (f->sole[at] == NOTHING) {
        f->sole[at] = identity;
        f->sole_length[at] = 0;
    } else if (f->sole[at] != identity) {
        f->sole[at] = SEVERAL;
    }
    f->sole_length[at] += length;
}

void gnoi_tile_layers_keep(gnoi_tile *tile, uint32_t slot, const gnoi_column *columns, int row, int pixel)
{
    gnoi_fragments *f = &tile->fragments;
    gnoi_fragment *fragment;
    uint32_t at = (uint32_t)(row * GNOI_TILE_W + pixel);
    float length = tile->cells.length[pixel], share = 1;
    if (tile->veiled) {
        share = tile->veil.hides[pixel] / length;
        length = tile->veil.hides[pixel];
        if (!(length > 0))
            return;
    }
    if (tile->judging)
        keep_identity(tile, at, identity_of(tile, slot, columns, pixel, length), length);
    if (row < 1 || row > tile->height)
        return;
    if (f->count == f->capacity &&
        !gnoi_reserve(tile->lines.context, (void **)&f->list, &f->capacity, f->count + 1, sizeof *f->list)) {
        tile->failed = 1;
        return;
    }
    fragment = &f->list[f->count++];
    fragment->pixel = at;
    fragment->slot = slot;
    fragment->length = length;
    fragment->mx = tile->cells.mx[pixel] * share;
    fragment->my = tile->cells.my[pixel] * share;
    for (int j = 0; j < tile->job->lamp_count && f->light; j++)
        f->light[tile->job->lamp_light[j]][at] += lit_length(tile, &columns[j], j, pixel, length);
}

/* What alone is seen on the base lines of a pixel: one thing, the background, or SEVERAL. */
static uint32_t sole_at(const gnoi_tile *tile, int i)
{
    const gnoi_fragments *f = &tile->fragments;
    float base = (float)tile->job->def.base_lines, lines = tile->weight[i] < base ? tile->weight[i] : base;
    return f->sole[i] != NOTHING && f->sole_length[i] < lines ? SEVERAL : f->sole[i];
}

/* An edge between two rows shows on no line of its pixel. The apron has one line, next to the tile. */
int gnoi_tile_layers_need(const gnoi_tile *tile, int i)
{
    uint32_t sole = sole_at(tile, i);
    return tile->weight[i] < (float)tile->job->def.lines &&
           (sole == SEVERAL || sole_at(tile, i - GNOI_TILE_W) != sole || sole_at(tile, i + GNOI_TILE_W) != sole);
}

/* ---- one pixel ----------------------------------------------------------------------------------------------------- */

/* Joins the fragments of one surface within the sorted run order[first..end): afterwards order[first..first+n) point to fragments
 * of different surfaces. Returns n. */
static size_t join_fragments(gnoi_fragments *f, size_t first, size_t end)
{
    size_t n = 0;
    for (size_t i = first; i < end; i++) {
        const gnoi_fragment *from = &f->list[f->order[i].value];
        gnoi_fragment *to = n > 0 ? &f->list[f->order[first + n - 1].value] : NULL;
        if (to && to->slot == from->slot) {
            to->length += from->length;
            to->mx += from->mx;
            to->my += from->my;
        } else {
            f->order[first + n++] = f->order[i];
        }
    }
    return n;
}

/* Puts (id, length) in its place among the longest `count`; of equal lengths the first to come stays in front. */
static void rank(unsigned *ids, float *lengths, int count, unsigned id, float length)
{
    int i = count;
    if (!(length > lengths[count - 1]))
        return;
    for (i = count - 1; i > 0 && length > lengths[i - 1]; i--) {
        ids[i] = ids[i - 1];
        lengths[i] = lengths[i - 1];
    }
    ids[i] = id;
    lengths[i] = length;
}

/* What surfaces cover, of so many lines: shares of surfaces seen through others are rounded and may miss the whole. */
static float whole_or(const gnoi_tile *tile, float covered, float lines)
{
    return tile->was_veiled && covered > lines * WHOLE ? lines : covered;
}

typedef uint32_t (*number_fn)(const gnoi_tile *tile, uint32_t slot);

/* Writes the pairs of one pixel from the joined run order[first..first+n), which is put in the order of numbers on the way. */
static void write_ranks(gnoi_tile *tile, const gno_ranks *ranks, number_fn number, size_t first, size_t n, uint32_t pixel, size_t at)
{
    gnoi_fragments *f = &tile->fragments;
    gnoi_keyed *order = f->order + first;
    unsigned *ids = ranks->id + at * (size_t)ranks->count;
    float *shares = ranks->coverage + at * (size_t)ranks->count, lines = tile->weight[pixel], covered = 0;
    for (int i = 0; i < ranks->count; i++) {
        ids[i] = GNO_BACKGROUND;
        shares[i] = 0;
    }
    for (size_t i = 0; i < n; i++)
        order[i].key = number(tile, f->list[order[i].value].slot);
    gnoi_sort(order, f->scratch, n);
    for (size_t i = 0; i < n;) {
        uint32_t id = order[i].key;
        float length = 0;
        for (; i < n && order[i].key == id; i++)
            length += f->list[order[i].value].length;
        covered += length;
        rank(ids, shares, ranks->count, id, length);
    }
    rank(ids, shares, ranks->count, GNO_BACKGROUND, lines - whole_or(tile, covered, lines));
    for (int i = 0; i < ranks->count; i++)
        shares[i] /= lines;
}

/* Where the fragment's middle is seen: picture coordinates and nearness. */
typedef struct seen {
    double x, y, z;
} seen;

static seen middle_of(const gnoi_tile *tile, const gnoi_fragment *f)
{
    int row = (int)(f->pixel / GNOI_TILE_W), column = (int)(f->pixel % GNOI_TILE_W);
    seen s;
    s.x = tile->x0 + column + 0.5 + (double)(f->mx / f->length);
    s.y = tile->y0 + row - 0.5 + (double)(f->my / f->length);
    s.z = gnoi_plane_at(&tile->slots[f->slot].receiver.nearness, s.x, s.y);
    return s;
}

/* The fragment that stands for its pixel, and where: the longest, of equal ones the nearest. */
static const gnoi_fragment *leading_fragment(const gnoi_tile *tile, size_t first, size_t n, seen *where)
{
    const gnoi_fragment *best = NULL;
    for (size_t i = first; i < first + n; i++) {
        const gnoi_fragment *f = &tile->fragments.list[tile->fragments.order[i].value];
        seen s;
        if (best && f->length < best->length)
            continue;
        s = middle_of(tile, f);
        if (best && f->length == best->length && !(s.z > where->z))
            continue;
        best = f;
        *where = s;
    }
    return best;
}

static void write_normal(const gnoi_frame_job *job, gnoi_slot *slot, const seen *at, float *out)
{
    const gnoi_poly *poly = slot->receiver.poly;
    vec3 g = v3_scale(v3_from(poly->n), slot->receiver.side < 0 ? -1 : 1), n = g;
    if (gnoi_is_smooth(poly)) {
        const gnoi_screen_plane *p = slot->interp.normal;
        gnoi_interp_seek(&slot->interp, job->scene, &job->view, poly, at->x, at->y);
        n = v3(gnoi_plane_at(&p[0], at->x, at->y), gnoi_plane_at(&p[1], at->x, at->y), gnoi_plane_at(&p[2], at->x, at->y));
        n = v3_dot(n, n) > 0 ? v3_unit(n) : g;
        n = v3_dot(n, g) < 0 ? v3_scale(n, -1) : n;
    }
    out[0] = (float)n.x;
    out[1] = (float)n.y;
    out[2] = (float)n.z;
}

/* ---- texture coordinates ------------------------------------------------------------------------------------------- */

static vec3 corner_at(const gno_scene *scene, unsigned corner) { return v3_from(scene->positions[scene->corner_vertex[corner]]); }

/* Weights of a triangle's corners at a point of its plane with normal n; returns the least, -HUGE_VAL where it has no area. */
static double weigh(const vec3 p[3], vec3 at, vec3 n, double w[3])
{
    double sum = 0, least = HUGE_VAL;
    for (int i = 0; i < 3; i++) {
        w[i] = v3_dot(n, v3_cross(v3_sub(p[(i + 1) % 3], at), v3_sub(p[(i + 2) % 3], at)));
        sum += w[i];
    }
    for (int i = 0; i < 3; i++) {
        w[i] /= sum;
        least = w[i] < least ? w[i] : least;
    }
    return sum != 0 && least == least ? least : -HUGE_VAL;
}

/* Interpolated in the triangle of the outer ring's fan that holds the point, or lies nearest to holding it: exact for convex
 * polygons and for coordinates that are linear over the polygon. */
static void write_uv(const gnoi_frame_job *job, const gnoi_slot *slot, const seen *at, float *out)
{
    const gno_scene *scene = job->scene;
    unsigned ring = scene->polygon_start[slot->receiver.poly->source];
    unsigned first = scene->ring_start[ring], end = scene->ring_start[ring + 1];
    vec3 point = gnoi_view_point(&job->view, at->x, at->y, at->z), n = v3_from(slot->receiver.poly->n);
    double best = -HUGE_VAL;
    for (unsigned i = first + 1; i + 1 < end && best < 0; i++) {
        const unsigned corner[3] = {first, i, i + 1};
        vec3 p[3];
        double w[3], least, uv[2] = {0, 0};
        for (int k = 0; k < 3; k++)
            p[k] = corner_at(scene, corner[k]);
        least = weigh(p, point, n, w);
        if (!(least > best))
            continue;
        best = least;
        for (int k = 0; k < 3; k++) {
            int t = scene->corner_texcoord[corner[k]];
            uv[0] += t >= 0 ? w[k] * scene->texcoords[t][0] : 0;
            uv[1] += t >= 0 ? w[k] * scene->texcoords[t][1] : 0;
        }
        out[0] = (float)uv[0];
        out[1] = (float)uv[1];
    }
}

/* ---- the tile ------------------------------------------------------------------------------------------------------ */

static void write_surface(gnoi_tile *tile, size_t first, size_t n, size_t at)
{
    const gno_layers *layers = tile->job->layers;
    seen where = {0, 0, 0};
    const gnoi_fragment *f = leading_fragment(tile, first, n, &where);
    if (layers->depth)
        layers->depth[at] = !f ? HUGE_VALF : (float)(tile->job->view.orthographic ? -where.z : 1 / where.z);
    for (int k = 0; k < 3 && layers->normal; k++)
        layers->normal[3 * at + (size_t)k] = 0;
    for (int k = 0; k < 2 && layers->uv; k++)
        layers->uv[2 * at + (size_t)k] = 0;
    if (f && layers->normal)
        write_normal(tile->job, &tile->slots[f->slot], &where, layers->normal + 3 * at);
    if (f && layers->uv)
        write_uv(tile->job, &tile->slots[f->slot], &where, layers->uv + 2 * at);
}

static void write_sums(gnoi_tile *tile, size_t first, size_t n, uint32_t pixel, size_t at)
{
    const gnoi_frame_job *job = tile->job;
    const gno_layers *layers = job->layers;
    size_t plane = (size_t)job->view.width * (size_t)job->view.height;
    float covered = 0;
    for (size_t i = first; i < first + n; i++)
        covered += tile->fragments.list[tile->fragments.order[i].value].length;
    covered = whole_or(tile, covered, tile->weight[pixel]);
    if (layers->coverage)
        layers->coverage[at] = covered / tile->weight[pixel];
    for (size_t j = 0; j < job->scene->light_count && layers->shadow; j++) {
        float whole = covered * (float)gnoi_light_points(&job->scene->lights[j].light), lit = tile->fragments.light[j][pixel];
        layers->shadow[j * plane + at] = !(lit < whole * WHOLE) ? 1 : lit / whole;
    }
}

static void write_pixel(gnoi_tile *tile, size_t first, size_t end, uint32_t pixel)
{
    const gno_layers *layers = tile->job->layers;
    size_t x = (size_t)tile->x0 + pixel % GNOI_TILE_W, y = (size_t)tile->y0 + pixel / GNOI_TILE_W - 1;
    size_t at = y * (size_t)tile->job->view.width + x, n = join_fragments(&tile->fragments, first, end);
    write_surface(tile, first, n, at);
    write_sums(tile, first, n, pixel, at);
    if (layers->polygons.id)
        write_ranks(tile, &layers->polygons, polygon_of, first, n, pixel, at);
    if (layers->objects.id)
        write_ranks(tile, &layers->objects, object_of, first, n, pixel, at);
    if (layers->materials.id)
        write_ranks(tile, &layers->materials, material_of, first, n, pixel, at);
}

/* Sorts the fragments by pixel, within a pixel by surface. */
static int sort_fragments(gnoi_tile *tile)
{
    gnoi_fragments *f = &tile->fragments;
    gno_context *context = tile->lines.context;
    if (!gnoi_reserve(context, (void **)&f->order, &f->order_capacity, f->count, sizeof *f->order) ||
        !gnoi_reserve(context, (void **)&f->scratch, &f->scratch_capacity, f->count, sizeof *f->scratch))
        return 0;
    for (size_t i = 0; i < f->count; i++) {
        f->order[i].key = f->list[i].slot;
        f->order[i].value = (uint32_t)i;
    }
    gnoi_sort(f->order, f->scratch, f->count);
    for (size_t i = 0; i < f->count; i++)
        f->order[i].key = f->list[f->order[i].value].pixel;
    gnoi_sort(f->order, f->scratch, f->count);
    return 1;
}

void gnoi_tile_layers_write(gnoi_tile *tile)
{
    gnoi_fragments *f = &tile->fragments;
    size_t i = 0;
    if (!sort_fragments(tile)) {
        tile->failed = 1;
        return;
    }
    for (int row = 1; row <= tile->height; row++)
        for (int column = 0; column < tile->width; column++) {
            uint32_t pixel = (uint32_t)(row * GNOI_TILE_W + column);
            size_t first = i;
            while (i < f->count && f->list[f->order[i].value].pixel == pixel)
                i++;
            write_pixel(tile, first, i, pixel);
        }
}
