/* tile_speck.c -- samples of small surfaces: facets, which hold all that their shading asks for, and specks into samples side by side by
 * vector code. See tile.h, specks.h.
 *
 * The numbers are those of gnoi_tile_sample but for the order in which a speck was summed.
 */
#include "base/vector.h"
#include "engine/tile.h"
#include "shade/interp_lanes.h"
#include <string.h>

#define INLINE static inline __attribute__((always_inline))
#define STEP GNOI_SPECK_STEP

/* A surface is small up to this width, in pixels. */
#define SMALL_WIDTH 8.0

/* ---- facets ------------------------------------------------------------------------------------------------------------- */

static void set_plane(double *to, const gnoi_screen_plane *p)
{
    to[0] = p->fx;
    to[1] = p->fy;
    to[2] = p->f0;
}

/* The facet of a flat triangle; of one of phong shading all but its normals. */
static void set_facet(const gnoi_receiver *r, gnoi_facet *facet)
{
    vec3 g = v3_scale(v3_from(r->poly->n), r->side < 0 ? -1 : 1);
    facet->g[0] = g.x;
    facet->g[1] = g.y;
    facet->g[2] = g.z;
    facet->material = r->poly->material;
    facet->bend = 0;
    set_plane(facet->plane[0], &r->nearness);
    for (int k = 0; k < 3; k++) {
        const gnoi_screen_plane flat = {0, 0, facet->g[k]};
        set_plane(facet->plane[k + 1], &flat);
    }
}

/* Facets of phong shading whose normals are to be set together. */
typedef struct curved {
    unsigned count;
    gnoi_facet *facets[GNOI_INTERP_LANES];
    gnoi_interp_lanes lanes;
} curved;

static void bend_facets(const gnoi_tile *tile, curved *c)
{
    if (c->count == 0)
        return;
    gnoi_interp_lanes_set(&c->lanes, &tile->job->view);
    for (unsigned i = 0; i < c->count; i++) {
        gnoi_facet *facet = c->facets[i];
        for (int k = 0; k < 9; k++)
            facet->plane[1 + k / 3][k % 3] = c->lanes.plane[k / 3][k % 3][i];
        facet->bend = (float)c->lanes.turn[i] * tile->job->tones[facet->material].glint;
    }
    c->count = 0;
}

static void take_curved(const gnoi_tile *tile, const gnoi_poly *poly, gnoi_facet *facet, curved *c)
{
    gnoi_interp_lanes_load(&c->lanes, c->count, &tile->job->scene->prepared, poly->corner);
    c->facets[c->count++] = facet;
    if (c->count == GNOI_INTERP_LANES)
        bend_facets(tile, c);
}

/* Whether a slot is small and asks for nothing but its plane, normals, material and whole light or none of each lamp. */
static int is_small(const gnoi_tile *tile, const gnoi_slot *slot)
{
    const gnoi_receiver *r = &slot->receiver;
    const gnoi_column *columns = &tile->columns[slot->first_column];
    const gnoi_tone *tone = &tile->job->tones[r->poly->material];
    int small = r->x1 - r->x0 <= SMALL_WIDTH && r->poly->corner_count == 3 && !tone->bumped && !tone->textured &&
                (r->poly->shading == GNO_SHADING_FLAT || r->poly->shading == GNO_SHADING_PHONG);
    for (int j = 0; j < tile->job->lamp_count; j++)
        small &= columns[j].state != GNOI_COLUMN_SPLIT;
    return small;
}

int gnoi_tile_set_facets(gnoi_tile *tile, const uint32_t *slots, size_t count)
{
    gno_context *context = tile->lines.context;
    size_t lamps = (size_t)tile->job->lamp_count;
    curved c;
    if (!gnoi_reserve(context, (void **)&tile->facets, &tile->facet_capacity, tile->slot_count, sizeof *tile->facets) ||
        !gnoi_reserve(context, (void **)&tile->arrives, &tile->arrive_capacity, tile->slot_count * lamps, sizeof *tile->arrives))
        return 0;
    memset(&c, 0, sizeof c);
    for (size_t i = 0; i < count; i++) {
        const gnoi_slot *slot = &tile->slots[slots[i]];
        const gnoi_column *columns = &tile->columns[slot->first_column];
        if (!is_small(tile, slot))
            continue;
        tile->briefs[slots[i]].speckled = 1;
        set_facet(&slot->receiver, &tile->facets[slots[i]]);
        if (slot->receiver.poly->shading == GNO_SHADING_PHONG)
            take_curved(tile, slot->receiver.poly, &tile->facets[slots[i]], &c);
        for (size_t j = 0; j < lamps; j++)
            tile->arrives[slots[i] * lamps + j] = columns[j].state == GNOI_COLUMN_LIT;
    }
    bend_facets(tile, &c);
    return 1;
}

/* ---- samples ------------------------------------------------------------------------------------------------------------ */

/* Facets side by side. */
typedef struct facets {
    double plane[4][3][STEP]; /* nearness, normal; fx, fy, f0 */
    double g[3][STEP];
} facets;

static void load(facets *restrict to, const gnoi_facet *from, const uint32_t *slots)
{
    for (int i = 0; i < STEP; i++) {
        const gnoi_facet *f = &from[slots[i]];
        for (int p = 0; p < 4; p++)
            for (int k = 0; k < 3; k++)
                to->plane[p][k][i] = f->plane[p][k];
        for (int k = 0; k < 3; k++)
            to->g[k][i] = f->g[k];
    }
}

/* Where the samples lie: the middle of each speck. */
typedef struct places {
    double x[STEP], y[STEP];
} places;

INLINE void set_places(places *restrict p, const gnoi_specks *restrict s, uint32_t from, double x0, double y0)
{
    for (uint32_t i = 0; i < STEP; i++) {
        float length = s->length[from + i];
        p->x[i] = x0 + s->pixel[from + i] + (double)(s->mx[from + i] / length);
        p->y[i] = y0 + (double)(s->my[from + i] / length);
    }
}

INLINE double at(const double plane[3][STEP], const places *p, int i) { return plane[0][i] * p->x[i] + plane[1][i] * p->y[i] + plane[2][i]; }

INLINE void set_points(gnoi_batch *restrict b, int to, const places *restrict p, const facets *restrict f, const gnoi_view *restrict view,
                       int orthographic)
{
    for (int i = 0; i < STEP; i++) {
        vec3 q = gnoi_view_offset(view, orthographic, p->x[i], p->y[i], at(f->plane[0], p, i));
        b->px[to + i] = (float)q.x;
        b->py[to + i] = (float)q.y;
        b->pz[to + i] = (float)q.z;
    }
}

INLINE void set_normals(gnoi_batch *restrict b, int to, const places *restrict p, const facets *restrict f)
{
    for (int i = 0; i < STEP; i++) {
        vec3 n = v3(at(f->plane[1], p, i), at(f->plane[2], p, i), at(f->plane[3], p, i)), g = v3(f->g[0][i], f->g[1][i], f->g[2][i]);
        n = gnoi_interp_facing(n, g);
        b->nx[to + i] = (float)n.x;
        b->ny[to + i] = (float)n.y;
        b->nz[to + i] = (float)n.z;
        b->gx[to + i] = (float)g.x;
        b->gy[to + i] = (float)g.y;
        b->gz[to + i] = (float)g.z;
    }
}

INLINE void set_samples(gnoi_batch *restrict b, int to, const gnoi_specks *restrict s, uint32_t from, double x0, double y0,
                        const facets *restrict f, const gnoi_view *restrict view, int orthographic)
{
    places p;
    set_places(&p, s, from, x0, y0);
    set_points(b, to, &p, f, view, orthographic);
    set_normals(b, to, &p, f);
}

VECTOR_CLONES static void set_near(gnoi_batch *restrict b, int to, const gnoi_specks *restrict s, uint32_t from, double x0, double y0,
                                   const facets *restrict f, const gnoi_view *restrict view)
{
    set_samples(b, to, s, from, x0, y0, f, view, 0);
}

VECTOR_CLONES static void set_far(gnoi_batch *restrict b, int to, const gnoi_specks *restrict s, uint32_t from, double x0, double y0,
                                  const facets *restrict f, const gnoi_view *restrict view)
{
    set_samples(b, to, s, from, x0, y0, f, view, 1);
}

static void set_material(gnoi_tile *tile, int to, uint32_t from, int count)
{
    gnoi_batch *b = &tile->batch;
    const gnoi_specks *s = &tile->specks;
    for (int i = 0; i < count; i++) {
        const gnoi_tone *tone = &tile->job->tones[tile->facets[s->slot[from + (uint32_t)i]].material];
        for (int k = 0; k < 3; k++) {
            b->kd[k][to + i] = tone->diffuse[k];
            b->ks[k][to + i] = tone->specular[k];
            b->rgb[k][to + i] = s->length[from + (uint32_t)i] * tone->ambient[k];
        }
        b->shininess[to + i] = tone->shininess;
    }
}

static void set_light(gnoi_tile *tile, int to, uint32_t from, int count)
{
    const gnoi_specks *s = &tile->specks;
    size_t lamps = (size_t)tile->job->lamp_count;
    for (size_t j = 0; j < lamps; j++)
        for (int i = 0; i < count; i++) {
            uint32_t k = from + (uint32_t)i;
            tile->batch.weight[j * GNOI_BATCH + (size_t)(to + i)] = tile->arrives[s->slot[k] * lamps + j] ? s->length[k] : 0;
        }
}

static void set_coverage(gnoi_tile *tile, int row, int to, uint32_t from, int count)
{
    const gnoi_specks *s = &tile->specks;
    for (int i = 0; i < count; i++) {
        tile->batch.coverage[to + i] = s->length[from + (uint32_t)i];
        tile->batch.tag[to + i] = (uint32_t)(row * GNOI_TILE_W + s->pixel[from + (uint32_t)i]);
    }
    for (int l = 0; l < tile->job->def.base_lines && tile->judging; l++)
        for (int i = 0; i < count; i++)
            tile->cover_by_line[l][to + i] = s->by_line[l][from + (uint32_t)i];
}

/* One speck as a cell, for what knows of those alone. Returns its pixel. */
static int set_cell(gnoi_tile *tile, uint32_t i)
{
    const gnoi_specks *s = &tile->specks;
    int pixel = s->pixel[i];
    tile->cells.length[pixel] = s->length[i];
    tile->cells.mx[pixel] = s->mx[i];
    tile->cells.my[pixel] = s->my[i];
    for (int l = 0; l < s->lines; l++)
        tile->cells.by_line[l][pixel] = s->by_line[l][i];
    return pixel;
}

/* What the specks cover, for the layers. */
static void keep(gnoi_tile *tile, int row)
{
    const gnoi_specks *s = &tile->specks;
    for (uint32_t i = 0; i < s->count && !tile->failed; i++)
        gnoi_tile_layers_keep(tile, s->slot[i], &tile->columns[tile->slots[s->slot[i]].first_column], row, set_cell(tile, i));
}

/* Samples those alone in which a highlight may bend, and takes them away. */
static void sample_bending(gnoi_tile *tile, int row)
{
    gnoi_specks *s = &tile->specks;
    uint32_t n = 0;
    for (uint32_t i = 0; i < s->count; i++) {
        if (gnoi_bend_shows(tile->facets[s->slot[i]].bend, s->length[i] * tile->pixel_share[s->pixel[i]])) {
            set_light(tile, tile->batch.count, i, 1);
            gnoi_tile_sample(tile, &tile->slots[s->slot[i]], row, set_cell(tile, i), &tile->cells, NULL);
            continue;
        }
        s->slot[n] = s->slot[i];
        s->pixel[n] = s->pixel[i];
        s->length[n] = s->length[i];
        s->mx[n] = s->mx[i];
        s->my[n] = s->my[i];
        for (int l = 0; l < s->lines; l++)
            s->by_line[l][n] = s->by_line[l][i];
        n++;
    }
    s->count = n;
}

static void sample(gnoi_tile *tile, int row)
{
    const gnoi_view *view = &tile->job->view;
    gnoi_specks *s = &tile->specks;
    gnoi_batch *b = &tile->batch;
    double x0 = tile->x0 + 0.5, y0 = tile->y0 + row - 0.5;
    facets f;
    sample_bending(tile, row);
    for (uint32_t i = s->count; i < s->count + STEP && s->count > 0; i++) {
        s->slot[i] = s->slot[s->count - 1];
        s->pixel[i] = 0;
        s->length[i] = 1;
        s->mx[i] = s->my[i] = 0;
    }
    for (uint32_t from = 0; from < s->count; from += STEP) {
        int count = s->count - from < STEP ? (int)(s->count - from) : STEP;
        if (b->count > GNOI_BATCH - STEP)
            gnoi_tile_flush(tile);
        load(&f, tile->facets, s->slot + from);
        if (view->orthographic)
            set_far(b, b->count, s, from, x0, y0, &f, view);
        else
            set_near(b, b->count, s, from, x0, y0, &f, view);
        set_material(tile, b->count, from, count);
        set_light(tile, b->count, from, count);
        set_coverage(tile, row, b->count, from, count);
        b->count += count;
    }
    if (b->count > GNOI_BATCH - GNOI_GLINT_POINTS)
        gnoi_tile_flush(tile);
}

void gnoi_tile_sample_specks(gnoi_tile *tile, int row)
{
    uint32_t count = tile->specks.count;
    if (tile->job->layers)
        keep(tile, row);
    if (!tile->fragments.alone)
        sample(tile, row);
    tile->failed |= gnoi_stopped_at(tile->lines.context, tile->steps++);
    gnoi_specks_clear(&tile->specks, count);
}
