/* tile_shade.c -- samples of surfaces into colours, colours into the tile's picture: see tile.h.
 *
 * Flat and phong surfaces are lit in batches (shade/batch.h); constant and gouraud ones carry intensities taken once at the
 * centroid or at the corners, interpolated for each lamp, so that the shadow still cuts them exactly.
 * A texture is taken once for each pixel of a surface, filtered over the whole pixel, and is a factor on all of the pixel's samples.
 */
#include "engine/tile.h"
#include "base/vector.h"
#include <string.h>

static int is_precomputed(const gnoi_slot *slot)
{
    uint32_t s = slot->receiver.poly->shading;
    return s == GNO_SHADING_CONSTANT || s == GNO_SHADING_GOURAUD;
}

/* What a pixel is judged by: a texture changes from row to row, but is filtered already; that calls for no finer lines. */
static inline float judged_texel(float mean, float texel)
{
    float some = (float)(mean >= 0);
    return some * mean + (1 - some) * texel;
}

/* ---- into the picture --------------------------------------------------------------------------------------------- */

/* `judged`: the colour by which pixels are judged, rgb itself unless the surface is textured. share: of each base line, the lines
 * `stride` apart. */
static inline void add_colour(gnoi_tile *tile, uint32_t pixel, const float rgb[3], const float judged[3], int lines, const float *share,
                              size_t stride)
{
    for (int k = 0; k < 3; k++)
        tile->acc[k][pixel] += rgb[k];
    for (int i = 0; i < lines; i++)
        for (int k = 0; k < 3; k++)
            tile->line_acc[i][k][pixel] += share[(size_t)i * stride] * judged[k];
}

static int judged_lines(const gnoi_tile *tile) { return tile->judging ? tile->job->def.base_lines : 0; }

/* Lengths on one line to shares of all. */
VECTOR_CLONES static void divide(float *restrict length, const float *restrict all, int count)
{
    for (int i = 0; i < count; i++)
        length[i] /= all[i];
}

/* The batch's colours into the picture. */
static void add_batch(gnoi_tile *tile)
{
    const gnoi_batch *b = &tile->batch;
    const float(*from)[GNOI_BATCH] = tile->job->textured ? (const float(*)[GNOI_BATCH])tile->judged : b->rgb;
    const int lines = judged_lines(tile);
    for (int i = 0; i < lines; i++)
        divide(tile->cover_by_line[i], b->coverage, b->count);
    for (int i = 0; i < b->count; i++) {
        float rgb[3] = {b->rgb[0][i], b->rgb[1][i], b->rgb[2][i]}, judged[3] = {from[0][i], from[1][i], from[2][i]};
        add_colour(tile, b->tag[i], rgb, judged, lines, &tile->cover_by_line[0][i], GNOI_BATCH);
    }
}

static void add_tinted_batch(gnoi_tile *tile)
{
    const gnoi_batch *b = &tile->batch;
    for (int i = 0; i < b->count; i++) {
        float rgb[3] = {b->rgb[0][i], b->rgb[1][i], b->rgb[2][i]};
        gnoi_tile_add_shares(tile, b->tag[i], rgb, &tile->share_by_line[0][0][i], GNOI_BATCH);
    }
}

#define NO_TEXEL UINT16_MAX

typedef float texel_values[3][GNOI_BATCH];

VECTOR_CLONES static void add_gloss(gnoi_batch *restrict b)
{
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < b->count; i++)
            b->rgb[k][i] += b->gloss[k][i];
}

VECTOR_CLONES static void multiply(gnoi_batch *restrict b, texel_values *restrict texels, float (*restrict judged)[GNOI_BATCH])
{
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < b->count; i++) {
            float matte = b->rgb[k][i], texel = (*texels)[k][i];
            b->rgb[k][i] = matte * texel + b->gloss[k][i];
            judged[k][i] = matte * judged_texel(judged[k][i], texel) + b->gloss[k][i];
        }
}

/* Factors of the samples' textures. The last texel stays: a lamp's own part of the same pixel may come in the next batch. */
static void apply_texels(gnoi_tile *tile)
{
    static const float plain[3] = {1, 1, 1};
    texel_values texels;
    gnoi_looks_answer(&tile->looks);
    for (int i = 0; i < tile->batch.count; i++) {
        const float *texel = tile->texel_of[i] == NO_TEXEL ? plain : tile->asked[tile->texel_of[i]];
        for (int k = 0; k < 3; k++)
            texels[k][i] = texel[k];
    }
    multiply(&tile->batch, &texels, tile->judged);
    if (tile->texel_count > 0)
        memcpy(tile->asked[0], tile->asked[tile->texel_count - 1], sizeof tile->asked[0]);
    tile->texel_count = tile->texel_count > 0;
}

void gnoi_tile_flush(gnoi_tile *tile)
{
    gnoi_batch *b = &tile->batch;
    gnoi_batch_shade(b, &tile->job->view, tile->job->lamps);
    if (tile->job->textured)
        apply_texels(tile);
    else
        add_gloss(b);
    if (tile->tinted)
        add_tinted_batch(tile);
    else
        add_batch(tile);
    tile->shaded += b->count;
    b->count = 0;
}

void gnoi_tile_keep_order(gnoi_tile *tile, const gnoi_slot *slot, int row, int column)
{
    uint32_t pixel = (uint32_t)(row * GNOI_TILE_W + column);
    int pending = 0;
    for (int i = 0; i < tile->batch.count && is_precomputed(slot); i++)
        pending |= tile->batch.tag[i] == pixel;
    if (pending)
        gnoi_tile_flush(tile);
}

/* ---- intensities taken once ---------------------------------------------------------------------------------------- */

/* The mean of the outer ring's area. */
static vec3 centroid(const gno_scene *scene, const gnoi_poly *poly)
{
    const gnoi_prepared *prep = &scene->prepared;
    uint32_t first = prep->ring_corner[poly->ring], end = prep->ring_corner[poly->ring + 1];
    vec3 origin = v3_from(prep->positions[prep->corner_vertex[first]]), sum = v3(0, 0, 0), n = v3_from(poly->n);
    double area = 0;
    for (uint32_t i = first + 1; i + 1 < end; i++) {
        vec3 a = v3_sub(v3_from(prep->positions[prep->corner_vertex[i]]), origin);
        vec3 b = v3_sub(v3_from(prep->positions[prep->corner_vertex[i + 1]]), origin);
        double t = v3_dot(v3_cross(a, b), n);
        sum = v3_mad(sum, v3_add(a, b), t / 3);
        area += t;
    }
    return v3_mad(origin, sum, 1 / area);
}

static vec3 viewer_normal(const gnoi_slot *slot)
{
    return v3_scale(v3_from(slot->receiver.poly->n), slot->receiver.side < 0 ? -1 : 1);
}

/* Intensities of a lamp: the diffuse one, which a texture acts on, and the specular one. */
enum { INTENSITY_PARTS = 2 };

static void set_intensity(const gnoi_frame_job *job, const gnoi_slot *slot, vec3 point, vec3 n, double (*rgb)[3])
{
    gno_material part[INTENSITY_PARTS];
    part[0] = part[1] = job->scene->materials[slot->receiver.poly->material];
    memset(part[0].specular, 0, sizeof part[0].specular);
    memset(part[1].diffuse, 0, sizeof part[1].diffuse);
    for (int j = 0; j < job->lamp_count; j++)
        for (int i = 0; i < INTENSITY_PARTS; i++, rgb++) {
            (*rgb)[0] = (*rgb)[1] = (*rgb)[2] = 0;
            gnoi_shade_point(&job->view, &job->lamps[j], &part[i], (double)job->bins.nearest_depth, point, n, *rgb);
        }
}

/* The interpolated normal of a corner, turned to the viewer's side of the plane. */
static vec3 corner_normal(const gnoi_frame_job *job, const gnoi_slot *slot, uint32_t corner)
{
    const gnoi_prepared *prep = &job->scene->prepared;
    const float *f = prep->normals[prep->corner_normal[corner]];
    vec3 g = viewer_normal(slot), n = v3((double)f[0], (double)f[1], (double)f[2]);
    return v3_dot(n, g) < 0 ? v3_scale(n, -1) : n;
}

/* Makes the slot's intensities valid for picture point (x,y); the corners' weights there go to w (constant: one corner). */
static double (*seek_intensities(gnoi_tile *tile, gnoi_slot *slot, double x, double y, double w[3]))[3]
{
    const gnoi_frame_job *job = tile->job;
    const gnoi_poly *poly = slot->receiver.poly;
    size_t count = (size_t)job->lamp_count * INTENSITY_PARTS;
    int gouraud = poly->shading == GNO_SHADING_GOURAUD;
    if (slot->first_intensity == GNOI_NONE) {
        if (!gnoi_reserve(tile->lines.context, (void **)&tile->intensities, &tile->intensity_capacity,
                          tile->intensity_count + 3 * count + 1, sizeof *tile->intensities)) {
            tile->failed = 1;
            return NULL;
        }
        slot->first_intensity = (uint32_t)tile->intensity_count;
        tile->intensity_count += 3 * count;
        if (!gouraud)
            set_intensity(job, slot, centroid(job->scene, poly), viewer_normal(slot), &tile->intensities[slot->first_intensity]);
    }
    w[0] = 1;
    w[1] = w[2] = 0;
    if (gouraud) {
        double sum;
        gnoi_interp_seek(&slot->interp, job->scene, &job->view, poly, x, y);
        for (size_t i = 0; i < 3 && slot->intensity_triangle != slot->interp.triangle; i++) {
            uint32_t corner = slot->interp.corner[i];
            vec3 p = v3_from(job->scene->prepared.positions[job->scene->prepared.corner_vertex[corner]]);
            set_intensity(job, slot, p, corner_normal(job, slot, corner), &tile->intensities[slot->first_intensity + i * count]);
        }
        slot->intensity_triangle = slot->interp.triangle;
        for (int i = 0; i < 3; i++) {
            w[i] = gnoi_plane_at(&slot->interp.weight[i], x, y);
            w[i] = w[i] > 0 ? w[i] : 0;
        }
        sum = w[0] + w[1] + w[2];
        for (int i = 0; i < 3; i++)
            w[i] = sum > 0 ? w[i] / sum : 1.0 / 3;
    }
    return &tile->intensities[slot->first_intensity];
}

static void sample_precomputed(gnoi_tile *tile, gnoi_slot *slot, int row, int column, double x, double y, const gnoi_cells *cells,
                               const float *tint, const float *texel)
{
    const gnoi_frame_job *job = tile->job;
    const gnoi_tone *tone = &job->tones[slot->receiver.poly->material];
    size_t lamps = (size_t)job->lamp_count, corners = slot->receiver.poly->shading == GNO_SHADING_GOURAUD ? 3 : 1;
    double w[3], (*intensity)[3] = seek_intensities(tile, slot, x, y, w);
    float rgb[3], judged[3], gloss[3] = {0, 0, 0}, share[GNOI_BASE_LINES], coverage = cells->length[column];
    int lines = judged_lines(tile);
    if (!intensity)
        return;
    for (int k = 0; k < 3; k++)
        rgb[k] = tint ? 0 : coverage * tone->ambient[k];
    for (size_t j = 0; j < lamps; j++) {
        float lamp_weight = tile->batch.weight[j * GNOI_BATCH + (size_t)tile->batch.count];
        for (size_t i = 0; i < corners && lamp_weight > 0; i++) {
            const double(*part)[3] = (const double(*)[3])&intensity[(i * lamps + j) * INTENSITY_PARTS];
            for (int k = 0; k < 3; k++) {
                float weight = lamp_weight * (tint ? tint[k] : 1);
                rgb[k] += weight * (float)(w[i] * part[0][k]);
                gloss[k] += weight * (float)(w[i] * part[1][k]);
            }
        }
    }
    for (int k = 0; k < 3; k++) {
        judged[k] = rgb[k] * judged_texel(tone->mean[k], texel[k]) + gloss[k];
        rgb[k] = rgb[k] * texel[k] + gloss[k];
    }
    tile->shaded++;
    if (tile->tinted) {
        gnoi_tile_add_tinted(tile, row, column, cells, tint != NULL, rgb);
        return;
    }
    for (int i = 0; i < lines; i++)
        share[i] = cells->by_line[i][column] / coverage;
    add_colour(tile, (uint32_t)(row * GNOI_TILE_W + column), rgb, judged, lines, share, 1);
}

/* ---- samples for the batch ----------------------------------------------------------------------------------------- */

static void set_point(gnoi_batch *b, int i, const gnoi_view *view, const gnoi_screen_plane *nearness, double x, double y)
{
    vec3 p = gnoi_view_offset(view, view->orthographic, x, y, gnoi_plane_at(nearness, x, y));
    b->px[i] = (float)p.x;
    b->py[i] = (float)p.y;
    b->pz[i] = (float)p.z;
}

void gnoi_tile_set_normal(gnoi_tile *tile, int i, gnoi_slot *slot, int row, int column, double x, double y)
{
    const gnoi_frame_job *job = tile->job;
    gnoi_batch *b = &tile->batch;
    vec3 g = viewer_normal(slot), n = g;
    if (slot->receiver.poly->shading == GNO_SHADING_PHONG) {
        const gnoi_screen_plane *f = slot->interp.normal;
        gnoi_interp_seek(&slot->interp, job->scene, &job->view, slot->receiver.poly, x, y);
        n = gnoi_interp_facing(v3(gnoi_plane_at(&f[0], x, y), gnoi_plane_at(&f[1], x, y), gnoi_plane_at(&f[2], x, y)), g);
    }
    if (job->tones[slot->receiver.poly->material].bumped)
        n = gnoi_tile_bumped(tile, slot, row, column, x, y, slot->receiver.poly->shading == GNO_SHADING_PHONG ? v3_unit(n) : n);
    b->nx[i] = (float)n.x;
    b->ny[i] = (float)n.y;
    b->nz[i] = (float)n.z;
    b->gx[i] = (float)g.x;
    b->gy[i] = (float)g.y;
    b->gz[i] = (float)g.z;
}

static void set_material(gnoi_batch *b, int i, const gnoi_tone *m, float coverage, const float *tint)
{
    for (int k = 0; k < 3; k++) {
        float t = tint ? tint[k] : 1;
        b->kd[k][i] = t * m->diffuse[k];
        b->ks[k][i] = t * m->specular[k];
        b->rgb[k][i] = tint ? 0 : coverage * m->ambient[k];
    }
    b->shininess[i] = m->shininess;
}

void gnoi_tile_note_texel(gnoi_tile *tile, int i, const gnoi_tone *tone, int row, size_t texel)
{
    tile->texel_of[i] = gnoi_tile_shows_texel(tile, tone, row) ? (uint16_t)texel : NO_TEXEL;
    for (int k = 0; k < 3; k++)
        tile->judged[k][i] = tone->mean[k];
}

/* ---- one sample in several points ------------------------------------------------------------------------------------ */

/* Sample `to` as sample `from`, but for its place. */
static void copy_sample(gnoi_tile *tile, int to, int from)
{
    gnoi_batch *b = &tile->batch;
    for (int k = 0; k < 3; k++) {
        b->kd[k][to] = b->kd[k][from];
        b->ks[k][to] = b->ks[k][from];
        b->rgb[k][to] = b->rgb[k][from];
        tile->judged[k][to] = tile->judged[k][from];
        for (int l = 0; l < GNOI_BASE_LINES; l++)
            tile->share_by_line[l][k][to] = tile->share_by_line[l][k][from];
    }
    for (int l = 0; l < GNOI_BASE_LINES; l++)
        tile->cover_by_line[l][to] = tile->cover_by_line[l][from];
    for (int j = 0; j < tile->job->lamp_count; j++)
        b->weight[(size_t)j * GNOI_BATCH + (size_t)to] = b->weight[(size_t)j * GNOI_BATCH + (size_t)from];
    b->shininess[to] = b->shininess[from];
    b->coverage[to] = b->coverage[from];
    b->tag[to] = b->tag[from];
    tile->texel_of[to] = tile->texel_of[from];
}

/* Lights the last sample of the batch in `count` points, each for an equal part of it. */
static void spread_sample(gnoi_tile *tile, gnoi_slot *slot, int row, int column, double (*at)[2], int count)
{
    const gnoi_frame_job *job = tile->job;
    gnoi_batch *b = &tile->batch;
    int first = b->count;
    float part = 1 / (float)count;
    for (int k = 0; k < 3; k++)
        b->rgb[k][first] *= part;
    for (int j = 0; j < job->lamp_count; j++)
        b->weight[(size_t)j * GNOI_BATCH + (size_t)first] *= part;
    for (int i = 0; i < count; i++) {
        if (i > 0)
            copy_sample(tile, first + i, first);
        set_point(b, first + i, &job->view, &slot->receiver.nearness, at[i][0], at[i][1]);
        gnoi_tile_set_normal(tile, first + i, slot, row, column, at[i][0], at[i][1]);
    }
    b->count += count - 1;
}

void gnoi_tile_sample(gnoi_tile *tile, gnoi_slot *slot, int row, int column, const gnoi_cells *cells, const float *tint)
{
    const gnoi_frame_job *job = tile->job;
    gnoi_batch *b = &tile->batch;
    float coverage = cells->length[column];
    double x = tile->x0 + column + 0.5 + (double)(cells->mx[column] / coverage);
    double y = tile->y0 + row - 0.5 + (double)(cells->my[column] / coverage);
    const gnoi_tone *tone = &job->tones[slot->receiver.poly->material];
    int i = b->count, shows = gnoi_tile_shows_texel(tile, tone, row);
    if (is_precomputed(slot)) {
        static const float plain[3] = {1, 1, 1};
        if (shows && !tint)
            gnoi_tile_set_texel(tile, slot, row, column, x, y);
        sample_precomputed(tile, slot, row, column, x, y, cells, tint, shows ? tile->texel : plain);
        return;
    }
    if (shows && !tint)
        gnoi_tile_ask_texel(tile, slot, row, column, x, y);
    set_point(b, i, &job->view, &slot->receiver.nearness, x, y);
    gnoi_tile_set_normal(tile, i, slot, row, column, x, y);
    set_material(b, i, tone, coverage, tint);
    if (job->textured)
        gnoi_tile_note_texel(tile, i, tone, row, tile->texel_count - 1);
    if (tile->tinted)
        gnoi_tile_tint_sample(tile, i, column, cells, tint != NULL);
    b->coverage[i] = coverage;
    for (int l = 0; l < job->def.base_lines && tile->judging; l++)
        tile->cover_by_line[l][i] = cells->by_line[l][column];
    b->tag[i] = (uint32_t)(row * GNOI_TILE_W + column);
    if (slot->receiver.poly->shading == GNO_SHADING_PHONG && gnoi_may_glint(slot, tone, coverage * tile->pixel_share[column])) {
        double at[GNOI_GLINT_POINTS][2];
        int points = gnoi_tile_glint(tile, slot, i, row, column, x, y, at);
        if (points > 1)
            spread_sample(tile, slot, row, column, at, points);
    }
    if (++b->count > GNOI_BATCH - GNOI_GLINT_POINTS)
        gnoi_tile_flush(tile);
}
