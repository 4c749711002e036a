/* tile_stack.c -- surfaces that are not opaque in a tile: what they do to light from behind, and the coverage of all that is seen
 * through them: see tile.h, scan/stack.h.
 *
 * A surface's own light is not weakened by its transmission: I = own + kt I_behind, the global model's kt It without refraction.
 */
#include "engine/tile.h"
#include <string.h>

/* Where a texture has holes only the solid share is there: it alone keeps light back, and shows its colour. */
static void open_holes(gnoi_tile *tile, gnoi_slot *slot, int32_t x0, int32_t x1, double y, gnoi_pass *pass)
{
    int row = (int)floor(y - tile->y0 + 1);
    gnoi_tile_set_texel(tile, slot, row, x0 / GNOI_X_ONE, tile->x0 + 0.5 * ((double)x0 + x1) / GNOI_X_ONE, y);
    pass->own = tile->texel[3];
    for (int k = 0; k < 3; k++)
        pass->through[k] = 1 - pass->own * (1 - pass->through[k]);
}

gnoi_pass gnoi_tile_pass(void *user, uint32_t slot, int32_t x0, int32_t x1, double y)
{
    gnoi_tile *tile = user;
    uint32_t material = tile->slots[slot].receiver.poly->material;
    const double *t = tile->job->scene->materials[material].transmission;
    gnoi_pass pass = {1, {(float)t[0], (float)t[1], (float)t[2]}, 0};
    pass.varies = tile->job->tones[material].has_holes;
    if (pass.varies && x0 < x1)
        open_holes(tile, &tile->slots[slot], x0, x1, y, &pass);
    return pass;
}

int gnoi_tile_veil_ready(gnoi_tile *tile)
{
    if (!tile->lit_veil)
        tile->lit_veil = gnoi_calloc(tile->lines.context, (size_t)tile->job->lamp_count, sizeof *tile->lit_veil);
    return tile->lit_veil != NULL;
}

static void clear(float colour[3][GNOI_TILE_W], int first, int last)
{
    for (int k = 0; k < 3; k++)
        memset(colour[k] + first, 0, (size_t)(last - first + 1) * sizeof(float));
}

void gnoi_tinted_lines_clear(gnoi_tinted_lines *lines, int first, int last)
{
    for (int i = 0; i < GNOI_BASE_LINES; i++)
        clear(lines->rgb[i], first, last);
}

static void veil_clear(const gnoi_tile *tile, gnoi_veil *veil, int first, int last)
{
    clear(veil->sum, first, last);
    if (tile->judging)
        gnoi_tinted_lines_clear(&veil->by_line, first, last);
}

/* Adds what a piece hides, pixel by pixel. */
static void hides_add(float *hides, int32_t x0, int32_t x1, float share)
{
    while (x0 < x1) {
        int32_t end = (x0 | (GNOI_X_ONE - 1)) + 1;
        end = end < x1 ? end : x1;
        hides[x0 / GNOI_X_ONE] += (float)(end - x0) / GNOI_X_ONE * share;
        x0 = end;
    }
}

static void veil_add(gnoi_tile *tile, gnoi_veil *veil, int row, uint32_t line, int32_t x0, int32_t x1, const double light[3])
{
    float a = (float)x0 / GNOI_X_ONE, b = (float)x1 / GNOI_X_ONE;
    gnoi_tile_add_light(veil->sum, a, b, light);
    if (tile->judging)
        gnoi_tile_add_light(veil->by_line.rgb[gnoi_tile_base_line(tile, row, line)], a, b, light);
}

void gnoi_tile_veil(gnoi_tile *tile, int row, uint32_t chain, int first, int last)
{
    veil_clear(tile, &tile->veil, first, last);
    memset(tile->veil.hides + first, 0, (size_t)(last - first + 1) * sizeof(float));
    for (uint32_t p = chain; p; p = tile->lines.pieces[p].chain) {
        const gnoi_piece *piece = &tile->lines.pieces[p];
        const gnoi_tint *tint = &tile->stacks.tints[p];
        double light[3] = {(double)tint->rgb[0], (double)tint->rgb[1], (double)tint->rgb[2]};
        veil_add(tile, &tile->veil, row, piece->line, piece->x0, piece->x1, light);
        hides_add(tile->veil.hides, piece->x0, piece->x1, tint->hides);
    }
}

void gnoi_tile_add_tinted_light(gnoi_tile *tile, int lamp, const gnoi_piece *piece, float x0, float x1, const double light[3], int line)
{
    static const float clear_tint[3] = {1, 1, 1};
    const float *tint = tile->veiled ? tile->stacks.tints[piece - tile->lines.pieces].rgb : clear_tint;
    double tinted[3] = {light[0] * (double)tint[0], light[1] * (double)tint[1], light[2] * (double)tint[2]};
    gnoi_tile_add_light(tile->lit_colour[lamp], x0, x1, tinted);
    if (line >= 0)
        gnoi_tile_add_light(tile->lit_veil[lamp].rgb[line], x0, x1, tinted);
}

void gnoi_tile_uncover(gnoi_tile *tile, int first, int last)
{
    for (int p = first; p <= last; p++) {
        tile->row_cover[p] -= tile->cells.length[p];
        for (int i = 0; i < tile->job->def.base_lines && tile->judging; i++)
            tile->row_by_line[i][p] -= tile->cells.by_line[i][p];
    }
}

/* Into tile->bare: where no opaque surface is seen in the row, one less the tint of what is. */
static void find_bare(gnoi_tile *tile, int row)
{
    veil_clear(tile, &tile->bare, 0, GNOI_TILE_W - 1);
    for (uint32_t line = tile->row_line[row]; line < tile->row_line[row + 1]; line++)
        for (uint32_t i = tile->stacks.bare_start[line]; i < tile->stacks.bare_start[line + 1]; i++) {
            const gnoi_bare *b = &tile->stacks.bares[i];
            double less[3] = {1 - (double)b->tint.rgb[0], 1 - (double)b->tint.rgb[1], 1 - (double)b->tint.rgb[2]};
            veil_add(tile, &tile->bare, row, line, b->x0, b->x1, less);
        }
}

/* Lengths are sums of multiples of 2^-16, hence exact: where surfaces leave nothing free the background has no share at all. */
void gnoi_tile_veiled_background(gnoi_tile *tile, int row)
{
    const double *background = tile->job->scene->image.background;
    float due[GNOI_TILE_W] = {0};
    find_bare(tile, row);
    for (uint32_t line = tile->row_line[row]; line < tile->row_line[row + 1]; line++) {
        const gnoi_line *l = &tile->lines.lines[line];
        for (int p = l->xa / GNOI_X_ONE; p < l->xb / GNOI_X_ONE; p++)
            due[p] += 1;
        for (int p = l->xa / GNOI_X_ONE, i = gnoi_tile_base_line(tile, row, line); p < l->xb / GNOI_X_ONE && tile->judging; p++)
            for (int k = 0; k < 3; k++) {
                float seen = 1 - tile->row_by_line[i][p] - tile->bare.by_line.rgb[i][k][p];
                tile->line_acc[i][k][row * GNOI_TILE_W + p] += seen * (float)background[k];
            }
    }
    for (int p = 0; p < tile->width; p++) {
        int index = row * GNOI_TILE_W + p;
        tile->weight[index] += due[p];
        for (int k = 0; k < 3; k++)
            tile->acc[k][index] += (due[p] - tile->row_cover[p] - tile->bare.sum[k][p]) * (float)background[k];
    }
}

/* ---- samples --------------------------------------------------------------------------------------------------------- */

void gnoi_tile_add_shares(gnoi_tile *tile, uint32_t pixel, const float rgb[3], const float *share, size_t stride)
{
    int lines = tile->judging ? tile->job->def.base_lines : 0;
    for (int k = 0; k < 3; k++)
        tile->acc[k][pixel] += rgb[k];
    for (int i = 0; i < lines; i++)
        for (int k = 0; k < 3; k++)
            tile->line_acc[i][k][pixel] += share[(size_t)(3 * i + k) * stride] * rgb[k];
}

/* What the surfaces before it do to a sample's colour (1 for the part that a lamp alone reaches: its factor holds it already), and the share
 * of the colour that each base line and channel has: share[(3 line + channel) stride]. */
static void set_tint(const gnoi_tile *tile, int column, const gnoi_cells *cells, int lit, float tint[3], float *share, size_t stride)
{
    const gnoi_tinted_lines *by_line = lit ? &tile->lit_veil[tile->lit_lamp] : tile->veiled ? &tile->veil.by_line : NULL;
    int lines = tile->judging ? tile->job->def.base_lines : 0;
    float length = cells->length[column];
    for (int k = 0; k < 3; k++) {
        float sum = 0;
        tint[k] = lit || !tile->veiled ? 1 : tile->veil.sum[k][column] / length;
        for (int i = 0; i < lines && by_line; i++)
            sum += by_line->rgb[i][k][column];
        for (int i = 0; i < lines; i++)
            share[(size_t)(3 * i + k) * stride] = sum > 0 ? by_line->rgb[i][k][column] / sum : cells->by_line[i][column] / length;
    }
}

void gnoi_tile_tint_sample(gnoi_tile *tile, int i, int column, const gnoi_cells *cells, int lit)
{
    gnoi_batch *b = &tile->batch;
    float veil[3];
    set_tint(tile, column, cells, lit, veil, &tile->share_by_line[0][0][i], GNOI_BATCH);
    for (int k = 0; k < 3; k++) {
        b->kd[k][i] *= veil[k];
        b->ks[k][i] *= veil[k];
        b->rgb[k][i] *= veil[k];
    }
}

void gnoi_tile_add_tinted(gnoi_tile *tile, int row, int column, const gnoi_cells *cells, int lit, float rgb[3])
{
    float veil[3], share[GNOI_BASE_LINES][3];
    set_tint(tile, column, cells, lit, veil, share[0], 1);
    for (int k = 0; k < 3; k++)
        rgb[k] *= veil[k];
    gnoi_tile_add_shares(tile, (uint32_t)(row * GNOI_TILE_W + column), rgb, share[0], 1);
}
