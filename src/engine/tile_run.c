/* tile_run.c -- samples of a surface in neighbouring pixels, set up side by side by vector code: see tile.h.
 *
 * The numbers are those of gnoi_tile_sample, bit by bit, which serves all that is rarer: procedural textures and those with holes, tints,
 * intensities taken once, highlights that bend within a pixel; and, among other pixels, those of which a lamp reaches a part.
 */
#include "base/vector.h"
#include "engine/tile.h"

#define INLINE static inline __attribute__((always_inline))

/* Pixels taken at once, in loops of fixed length: what lies beyond the samples at hand counts for nothing. */
#define STEP GNOI_CELLS_STEP

_Static_assert(STEP == GNOI_RELIEF_RUN, "bumps are taken as many at a time");

/* Fewer are done sooner one by one. */
#define LEAST_RUN 3

/* What the samples of a slot in a row have in common. */
typedef struct common {
    double x0, y0; /* in the picture: the centre of the tile's first pixel, the row's middle */
    const gnoi_view *view;
    const gnoi_screen_plane *nearness, *normal; /* normal: three, or NULL for the plane's own everywhere */
    vec3 g;                                     /* the plane's own, on the viewer's side */
    const gnoi_tone *tone;
} common;

/* Where in the picture samples lie. */
typedef struct places {
    double x[STEP], y[STEP];
} places;

INLINE void set_places(places *restrict p, const gnoi_cells *restrict cells, int first, const common *restrict c)
{
    for (int i = 0; i < STEP; i++) {
        float length = cells->length[first + i];
        p->x[i] = c->x0 + (first + i) + (double)(cells->mx[first + i] / length);
        p->y[i] = c->y0 + (double)(cells->my[first + i] / length);
    }
}

INLINE void set_points(gnoi_batch *restrict b, int at, const places *restrict p, const common *restrict c, int orthographic)
{
    const gnoi_screen_plane nearness = *c->nearness;
    const gnoi_view *restrict view = c->view;
    for (int i = 0; i < STEP; i++) {
        vec3 q = gnoi_view_offset(view, orthographic, p->x[i], p->y[i], gnoi_plane_at(&nearness, p->x[i], p->y[i]));
        b->px[at + i] = (float)q.x;
        b->py[at + i] = (float)q.y;
        b->pz[at + i] = (float)q.z;
    }
}

INLINE void set_normals(gnoi_batch *restrict b, int at, const places *restrict p, const gnoi_screen_plane *restrict normal, vec3 g)
{
    const gnoi_screen_plane f[3] = {normal[0], normal[1], normal[2]};
    for (int i = 0; i < STEP; i++) {
        vec3 n = v3(gnoi_plane_at(&f[0], p->x[i], p->y[i]), gnoi_plane_at(&f[1], p->x[i], p->y[i]), gnoi_plane_at(&f[2], p->x[i], p->y[i]));
        n = gnoi_interp_facing(n, g);
        b->nx[at + i] = (float)n.x;
        b->ny[at + i] = (float)n.y;
        b->nz[at + i] = (float)n.z;
    }
}

INLINE void fill(float *restrict to, float value)
{
    for (int i = 0; i < STEP; i++)
        to[i] = value;
}

INLINE void set_surface(gnoi_batch *restrict b, int at, const gnoi_cells *restrict cells, int first, const common *restrict c)
{
    const gnoi_tone *tone = c->tone;
    fill(b->gx + at, (float)c->g.x);
    fill(b->gy + at, (float)c->g.y);
    fill(b->gz + at, (float)c->g.z);
    for (int k = 0; k < 3; k++) {
        fill(b->kd[k] + at, tone->diffuse[k]);
        fill(b->ks[k] + at, tone->specular[k]);
        for (int i = 0; i < STEP; i++)
            b->rgb[k][at + i] = cells->length[first + i] * tone->ambient[k];
    }
    fill(b->shininess + at, tone->shininess);
    for (int i = 0; i < STEP; i++)
        b->coverage[at + i] = cells->length[first + i];
}

INLINE void set_samples(gnoi_batch *restrict b, int at, const gnoi_cells *restrict cells, int first, const common *restrict c, int orthographic,
                        places *restrict p)
{
    set_places(p, cells, first, c);
    set_points(b, at, p, c, orthographic);
    if (c->normal) {
        set_normals(b, at, p, c->normal, c->g);
    } else {
        fill(b->nx + at, (float)c->g.x);
        fill(b->ny + at, (float)c->g.y);
        fill(b->nz + at, (float)c->g.z);
    }
    set_surface(b, at, cells, first, c);
}

VECTOR_CLONES static void set_near(gnoi_batch *restrict b, int at, const gnoi_cells *restrict cells, int first, const common *restrict c,
                                   places *restrict p)
{
    set_samples(b, at, cells, first, c, 0, p);
}

VECTOR_CLONES static void set_far(gnoi_batch *restrict b, int at, const gnoi_cells *restrict cells, int first, const common *restrict c,
                                   places *restrict p)
{
    set_samples(b, at, cells, first, c, 1, p);
}

/* What arrives of the lamps, which pixels the samples are of, and their coverage by line. */
static void set_rest(gnoi_tile *tile, const gnoi_column *columns, int row, int first, int count, int at)
{
    gnoi_batch *b = &tile->batch;
    const float *length = tile->cells.length + first;
    for (int j = 0; j < tile->job->lamp_count; j++) {
        float lit = columns[j].state == GNOI_COLUMN_LIT ? 1 : 0, *weight = b->weight + (size_t)j * GNOI_BATCH + at;
        for (int i = 0; i < STEP; i++)
            weight[i] = lit * length[i];
        for (int i = 0; i < count && columns[j].state == GNOI_COLUMN_SPLIT; i++)
            weight[i] = tile->lit[j].length[first + i] > 0 ? length[i] : 0;
    }
    for (int i = 0; i < STEP; i++)
        b->tag[at + i] = (uint32_t)(row * GNOI_TILE_W + first + i);
    for (int l = 0; l < tile->job->def.base_lines && tile->judging; l++)
        for (int i = 0; i < STEP; i++)
            tile->cover_by_line[l][at + i] = tile->cells.by_line[l][first + i];
}

/* The normals at samples, unit, before their bumps; as in gnoi_tile_set_normal. */
VECTOR_CLONES static void find_unit_normals(const places *restrict p, const gnoi_screen_plane *restrict normal, const vec3 *restrict facing,
                                            double (*restrict n)[STEP])
{
    const gnoi_screen_plane f[3] = {normal[0], normal[1], normal[2]};
    const vec3 g = *facing;
    for (int i = 0; i < STEP; i++) {
        vec3 m = v3(gnoi_plane_at(&f[0], p->x[i], p->y[i]), gnoi_plane_at(&f[1], p->x[i], p->y[i]), gnoi_plane_at(&f[2], p->x[i], p->y[i]));
        double length, k;
        m = gnoi_interp_facing(m, g);
        length = v3_length(m);
        k = length > 0 ? 1 / length : 1;
        n[0][i] = m.x * k;
        n[1][i] = m.y * k;
        n[2][i] = m.z * k;
    }
}

static void set_bumps(gnoi_tile *tile, gnoi_slot *slot, const common *c, int row, int first, int count, const places *p, int at)
{
    gnoi_batch *b = &tile->batch;
    double n[3][STEP];
    if (c->normal)
        find_unit_normals(p, c->normal, &c->g, n);
    for (int i = 0; i < STEP && !c->normal; i++) {
        n[0][i] = c->g.x;
        n[1][i] = c->g.y;
        n[2][i] = c->g.z;
    }
    if (!gnoi_tile_bump_run(tile, slot, count, p->x, p->y, n)) {
        for (int i = 0; i < count; i++)
            gnoi_tile_set_normal(tile, at + i, slot, row, first + i, p->x[i], p->y[i]);
        return;
    }
    for (int i = 0; i < count; i++) {
        b->nx[at + i] = (float)n[0][i];
        b->ny[at + i] = (float)n[1][i];
        b->nz[at + i] = (float)n[2][i];
    }
}

/* Textures and bumps. */
static void set_details(gnoi_tile *tile, gnoi_slot *slot, const common *c, int row, int first, int count, const places *p, int at)
{
    for (int i = 0; i < count && tile->job->textured; i++)
        gnoi_tile_note_texel(tile, at + i, c->tone, row, tile->texel_count + (size_t)i);
    if (gnoi_tile_shows_texel(tile, c->tone, row))
        gnoi_tile_ask_texels(tile, slot, row, first, count, p->x, p->y);
    if (c->tone->bumped)
        set_bumps(tile, slot, c, row, first, count, p, at);
}

/* Whether the surface is one for this file. */
static int is_plain(const gnoi_tile *tile, const gnoi_slot *slot)
{
    const gnoi_poly *poly = slot->receiver.poly;
    const gnoi_tone *tone = &tile->job->tones[poly->material];
    int plain = (poly->shading == GNO_SHADING_FLAT || poly->shading == GNO_SHADING_PHONG) && !tile->tinted && !tile->veiled;
    if (tone->textured)
        plain &= tile->job->scene->materials[poly->material].texture.kind == GNO_TEXTURE_IMAGE && !tone->has_holes;
    return plain;
}

/* Whether every lamp reaches all or nothing of what is seen of the surface in a pixel. */
static int is_whole(const gnoi_tile *tile, const gnoi_column *columns, int pixel)
{
    float cover = tile->cells.length[pixel];
    const float all[3] = {cover, cover, cover};
    int whole = cover > 0;
    for (int j = 0; j < tile->job->lamp_count && whole; j++)
        if (columns[j].state == GNOI_COLUMN_SPLIT && tile->lit[j].length[pixel] > 0)
            whole = gnoi_tile_reaches_all(tile, j, pixel, cover, all);
    return whole;
}

/* Makes the slot's interpolation valid from one pixel to another; 0 when no one triangle of the polygon holds both samples. */
static int seek(gnoi_tile *tile, gnoi_slot *slot, const common *c, int first, int last)
{
    const gnoi_cells *cells = &tile->cells;
    gnoi_interp *interp = &slot->interp;
    for (int end = 0, p = first; end < 2; end++, p = last) {
        double x = c->x0 + p + (double)(cells->mx[p] / cells->length[p]), y = c->y0 + (double)(cells->my[p] / cells->length[p]);
        if (end == 0)
            gnoi_interp_seek(interp, tile->job->scene, &tile->job->view, slot->receiver.poly, x, y);
        if (interp->triangle_count == 1)
            return 1;
        if (gnoi_interp_depth(interp, x, y) < 0)
            return 0;
    }
    return 1;
}

/* Pixels that are whole; 0 when they are better taken one by one. */
static int sample_whole(gnoi_tile *tile, gnoi_slot *slot, const gnoi_column *columns, const common *c, int row, int first, int last)
{
    const gnoi_frame_job *job = tile->job;
    gnoi_batch *b = &tile->batch;
    if (last - first + 1 < LEAST_RUN || (c->normal && (!seek(tile, slot, c, first, last) || gnoi_may_glint(slot, c->tone, 1))))
        return 0;
    for (int p = first; p <= last; p += STEP) {
        int count = last - p + 1 < STEP ? last - p + 1 : STEP;
        places at;
        if (b->count > GNOI_BATCH - STEP)
            gnoi_tile_flush(tile);
        if (job->view.orthographic)
            set_far(b, b->count, &tile->cells, p, c, &at);
        else
            set_near(b, b->count, &tile->cells, p, c, &at);
        set_rest(tile, columns, row, p, count, b->count);
        if (job->textured || c->tone->bumped)
            set_details(tile, slot, c, row, p, count, &at, b->count);
        b->count += count;
    }
    if (b->count > GNOI_BATCH - GNOI_GLINT_POINTS)
        gnoi_tile_flush(tile);
    return 1;
}

int gnoi_tile_sample_run(gnoi_tile *tile, gnoi_slot *slot, const gnoi_column *columns, int row, int first, int last)
{
    const gnoi_poly *poly = slot->receiver.poly;
    common c;
    if (last - first + 1 < LEAST_RUN || !is_plain(tile, slot))
        return 0;
    c.x0 = tile->x0 + 0.5;
    c.y0 = tile->y0 + row - 0.5;
    c.view = &tile->job->view;
    c.nearness = &slot->receiver.nearness;
    c.normal = poly->shading == GNO_SHADING_PHONG ? slot->interp.normal : NULL;
    c.g = v3_scale(v3_from(poly->n), slot->receiver.side < 0 ? -1 : 1);
    c.tone = &tile->job->tones[poly->material];
    while (first <= last && !tile->failed) {
        int end = first;
        while (end <= last && is_whole(tile, columns, end))
            end++;
        if (end > first && sample_whole(tile, slot, columns, &c, row, first, end - 1))
            first = end;
        for (end += end <= last; first < end && !tile->failed; first++)
            if (tile->cells.length[first] > 0)
                gnoi_tile_sample_pixel(tile, slot, columns, row, first);
    }
    return 1;
}
