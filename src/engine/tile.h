/* tile.h -- one tile of a scan-line picture: from polygons to pixels.
 *
 * Place in the data flow, each step a file of its own:
 *   bins -> tile_scan.c, tile_slot.c: polygons of the tile, nearest first, as segments into the visible lists of the tile's lines
 *        -> tile_stack.c: surfaces that let light through, over and between them (scan/stack.h)
 *        -> tile_light.c: a column of each lamp's shadow matrix for every surface seen
 *        -> tile_rows.c: visible pieces of a pixel row -> coverage by surface and pixel, split by shadow polygons
 *        -> tile_shade.c, tile_run.c, tile_speck.c: one sample for each pixel and surface -> lighting -> the tile's picture
 *        -> tile_layers.c: what covers how much of each pixel -> layers beside the picture, where they are asked for
 *        -> tile.c: which pixels vary and get more lines; the tile's part of the picture
 * Invariants: a tile depends on nothing but the frame, so that any thread may make it; each line adds a coverage of exactly
 * one pixel to each pixel it crosses.
 */
#ifndef GNOI_ENGINE_TILE_H
#define GNOI_ENGINE_TILE_H

#include "base/sort.h"
#include "engine/specks.h"
#include "scan/lanes.h"
#include "scan/stack.h"
#include "shade/batch.h"
#include "shade/interp.h"
#include "shade/relief.h"
#include "shadow/cache.h"
#include "shadow/column.h"

/* A material in single precision, `ambient` times the scene's ambient light. */
typedef struct gnoi_tone {
    float ambient[3], diffuse[3], specular[3], shininess;
    float glint;      /* the error of a highlight by the variance of the normal's angle: 2 n, times the largest specular factor */
    float glint_edge; /* R.S from which on a highlight counts */
    int textured, bumped, has_holes;
    int one_place; /* the bump lies where the texture does */
    float mean[3]; /* of the texture, where it is a picture; else -1 */
} gnoi_tone;

/* What all tiles of one picture share; read only while tiles are made. */
typedef struct gnoi_frame_job {
    const gno_scene *scene;
    gno_render_def def;
    gnoi_view view;
    gnoi_bins bins;
    gnoi_tone *tones; /* one for each material */
    int tinted; /* some surface lets light through, or some lamp's shadows weaken: what is lit has a colour of its own on each line */
    const gnoi_lamp *lamps;
    const gnoi_casters *casters; /* one for each lamp */
    int lamp_count;
    int textured; /* some material is */
    float *rgb;
    int first_row; /* of the picture, that rgb begins with */
    const gno_layers *layers; /* NULL: none */
    uint32_t *lamp_light; /* with layers: the scene's light that a lamp is of */
} gnoi_frame_job;

/* Rows of the tile, with one row of apron above and below (the one line next to the tile is made there, to judge its border by). */
#define GNOI_TILE_ROWS (GNOI_TILE_H + 2)
#define GNOI_TILE_PIXELS (GNOI_TILE_ROWS * GNOI_TILE_W)
#define GNOI_TILE_SPANS 6 /* 2^5 rows are no more than all, 2^6 are */

/* The farthest right that a position on a line is kept apart. */
#define GNOI_TILE_MOST ((GNOI_TILE_W + 1.0) * GNOI_X_ONE)

/* A polygon of the tile's bin: bounds in pixels from the tile's corner, greatest nearness, its slot or GNOI_NONE. */
typedef struct gnoi_item {
    float x0, x1, y0, y1, z1;
    uint32_t slot, poly;
    unsigned char plain;       /* a triangle that needs no cutting */
    unsigned char thin;        /* nearly level and flatter than the base lines are apart: they may miss it over many pixels */
    unsigned char see_through; /* not opaque: drawn after all that is */
} gnoi_item;

/* Lines that begin and end together, by ascending height. */
typedef struct gnoi_strip {
    uint32_t first, count;
    float xa, xb, y; /* where they begin and end, and the height of the first, in pixels from the tile's corner */
    float per_row;   /* lines a pixel row, evenly spaced */
    uint32_t absent; /* how many of a row are not there: those that were made before */
    uint32_t pixels; /* bit x: they pass pixel x */
} gnoi_strip;

/* A texture with holes is asked for on every line of a pixel; what it was is kept here, by polygon and pixel. */
#define GNOI_TEXELS 512 /* a power of two */
typedef struct gnoi_texel {
    uint32_t poly, pixel; /* GNOI_NONE: none */
    float rgba[4];
} gnoi_texel;

/* A surface seen in the tile. */
typedef struct gnoi_slot {
    gnoi_receiver receiver;
    uint32_t first_column; /* lamp_count columns in tile.columns, GNOI_NONE until lit */
    gnoi_interp interp;
    uint32_t first_intensity; /* constant, gouraud: intensities in tile.intensities, GNOI_NONE until needed */
    uint32_t intensity_triangle; /* gouraud: of the interpolation, whose corners they are */
    uint32_t mapping;         /* textured, bumped: the first of two in tile.mappings, of texture and bump; GNOI_NONE until needed */
} gnoi_slot;

/* Cells taken at once by vector code, which may read so many from any cell on. */
#define GNOI_CELLS_STEP 8
#define GNOI_CELLS (GNOI_TILE_W + GNOI_CELLS_STEP)

/* What the shading of a small surface asks for. */
typedef struct gnoi_facet {
    double plane[4][3]; /* nearness, then x, y, z of the normal, any length: fx, fy, f0 of each */
    double g[3];        /* the plane's normal on the viewer's side, unit */
    float bend;         /* the most that a highlight bends in a whole pixel of it, as in gnoi_may_glint */
    uint32_t material;
} gnoi_facet;

/* Coverage of one surface, or of its lit part, along a pixel row: sums over pieces of length, and of length times the
 * offset of its middle from the pixel's centre. Lengths in pixels. */
typedef struct gnoi_cells {
    float length[GNOI_CELLS], mx[GNOI_CELLS], my[GNOI_CELLS];
    float by_line[GNOI_BASE_LINES][GNOI_CELLS]; /* length on each base line; not kept for finer lines */
} gnoi_cells;

/* What a surface covers of one pixel, on the base lines or on the finer ones: as gnoi_cells. */
typedef struct gnoi_fragment {
    uint32_t pixel, slot;
    float length, mx, my;
} gnoi_fragment;

/* Storage of tile_layers.c; empty when no layers are asked for. */
typedef struct gnoi_fragments {
    size_t count, capacity;
    gnoi_fragment *list;
    size_t order_capacity, scratch_capacity;
    gnoi_keyed *order, *scratch;
    float (*light)[GNOI_TILE_PIXELS]; /* one for each light of the scene: lines times the share of its rays that arrives */
    uint32_t sole[GNOI_TILE_PIXELS];  /* what alone is seen there on the base lines, as a hash of what the layers tell apart */
    float sole_length[GNOI_TILE_PIXELS];
    int alone;                        /* lines are being made for the layers alone: no colour is wanted */
} gnoi_fragments;

/* Colours by base line of a pixel row. */
typedef struct gnoi_tinted_lines {
    float rgb[GNOI_BASE_LINES][3][GNOI_TILE_W];
} gnoi_tinted_lines;

/* What reaches the eye of one surface along a pixel row, through the surfaces before it: sums over pieces of length times tint. */
typedef struct gnoi_veil {
    float sum[3][GNOI_TILE_W];
    float hides[GNOI_TILE_W]; /* length times the share of light that it keeps from behind */
    gnoi_tinted_lines by_line;
} gnoi_veil;

typedef struct gnoi_tile {
    const gnoi_frame_job *job;
    int x0, y0, width, height; /* pixels */
    gnoi_rect rect;            /* the same with half a row above and below */
    int failed;                /* sticky: memory ran out, or the call is to stop */
    size_t steps;              /* a count of lines split, for asking now and then whether to stop */
    gnoi_lines lines;
    uint32_t row_line[GNOI_TILE_ROWS + 1]; /* lines of each row (apron included), by first */
    uint32_t rows_mask[GNOI_TILE_SPANS][GNOI_TILE_ROWS]; /* [k][row], bit x: some line of the 2^k rows from that row on passes pixel x */
    uint16_t strip_at[GNOI_TILE_PIXELS];   /* by row and pixel, where some line passes it: its strip */
    int strip_count, row_strip[GNOI_TILE_ROWS], row_strip_end[GNOI_TILE_ROWS]; /* strips that hold lines of each row */
    gnoi_strip strips[GNOI_TILE_PIXELS];
    size_t line_y_capacity, bar_capacity;
    double *line_y;                        /* beside the lines once polygons are drawn, and some zeros: their heights */
    float *bar;                            /* beside the lines: what is farther is hidden on all of it; -infinity while it has gaps */
    size_t covered;                        /* on the lines before this one nothing can be seen any more of the polygons to come */
    gnoi_keyed *order, *order_scratch;     /* the bin's polygons nearest first */
    size_t order_capacity, order_scratch_capacity;
    gnoi_item *items;                      /* beside the order */
    size_t item_capacity, made[2];         /* those before made[0] are made, and of what is not opaque those before made[1] */
    gnoi_lanes lanes, single;              /* triangles at hand; in lane 0, another polygon */
    size_t opaque_count;                   /* items at the head of the order that are opaque */
    gnoi_stacks stacks;
    int veiled;                            /* some piece on the lines has a tint */
    int was_veiled;                        /* on some lines of the tile */
    int tinted;                            /* colours are kept by line, not lengths: veiled, or judging where the job is tinted */
    gnoi_veil veil;                        /* of the surface at hand */
    gnoi_veil bare;                        /* how much less than all reaches the eye where no opaque surface is seen */
    gnoi_tinted_lines *lit_veil;           /* beside lit_colour, one for each lamp, NULL until a tile is tinted */
    int lit_lamp;                          /* of the sample at hand */
    size_t slot_count, slot_capacity;
    gnoi_slot *slots;                      /* beside lines.depths, same numbering */
    size_t brief_capacity, facet_capacity, arrive_capacity;
    gnoi_brief *briefs;                    /* beside the slots */
    gnoi_facet *facets;                    /* beside the slots, of those that are speckled */
    unsigned char *arrives;                /* lamp_count beside each facet: 1 where the lamp's light does */
    gnoi_specks specks;                    /* of the row at hand */
    gnoi_outline outline;
    size_t edge_capacity;
    gnoi_edge *edges;                      /* of the polygon at hand */
    size_t edge_count;
    size_t crossing_capacity;
    double *crossings;
    size_t touched_capacity;
    uint32_t *touched;                     /* slots seen in the row, or on the lines, at hand */
    size_t column_count, column_capacity;
    gnoi_column *columns;
    gnoi_columns store;
    size_t part_capacity;
    gno_span_part *parts;
    gnoi_cells cells;
    gnoi_cells *lit;                       /* one for each lamp */
    float (*lit_colour)[3][GNOI_TILE_W];   /* one for each lamp: length times light that came through */
    float row_cover[GNOI_TILE_W], row_by_line[GNOI_BASE_LINES][GNOI_TILE_W];
    int judging;                           /* base lines are being made for refinement: colours are kept by line */
    gnoi_batch batch;
    float pixel_share[GNOI_TILE_W];        /* of each pixel of the row that a line stands for, among those being made */
    size_t intensity_count, intensity_capacity;
    double (*intensities)[3];
    size_t mapping_count, mapping_capacity;
    gnoi_mapping *mappings;
    gnoi_texel *texels;                    /* GNOI_TEXELS, once something has holes */
    float texel[4];                        /* of the pixel and surface sampled last, where it is textured */
    gnoi_looks looks;                      /* texels asked for */
    size_t texel_count;
    float asked[GNOI_BATCH + 1][4];       /* of the batch's samples, valid once the looks are answered; sample i has texel_of[i], or none */
    uint16_t texel_of[GNOI_BATCH];
    float judged[3][GNOI_BATCH];           /* beside the batch, in textured pictures: the texture's mean, or -1, and then the colour with it */
    float acc[3][GNOI_TILE_PIXELS];        /* sums over lines */
    float weight[GNOI_TILE_PIXELS];        /* lines that cover the pixel */
    float line_acc[GNOI_BASE_LINES][3][GNOI_TILE_PIXELS]; /* the pixel's colour on each base line */
    unsigned char thin[GNOI_TILE_PIXELS];  /* something thin passes: to be refined whatever the base lines saw */
    float cover_by_line[GNOI_BASE_LINES][GNOI_BATCH]; /* beside the batch */
    float share_by_line[GNOI_BASE_LINES][3][GNOI_BATCH]; /* in its place where the tile is tinted: of the sample's colour */
    double spans, shaded, refined;
    gnoi_fragments fragments;
} gnoi_tile;

/* Makes a tile worker ready; returns 0 when memory fails. Free in any case. */
int gnoi_tile_init(gnoi_tile *tile, const gnoi_frame_job *job);
void gnoi_tile_free(gnoi_tile *tile);

/* Makes tile number `index` and writes it to job->rgb. Returns 0 when memory fails. */
int gnoi_tile_render(gnoi_tile *tile, size_t index);

/* tile.c: empties the tile for number `index`; its sums of colours over the weights to job->rgb. */
void gnoi_tile_start(gnoi_tile *tile, size_t index);
void gnoi_tile_write(const gnoi_tile *tile);

/* The tile's polygons on its base lines, their columns found, nothing shaded: for who wants spans instead of pixels. Returns 0 when
 * memory fails. */
int gnoi_tile_lay(gnoi_tile *tile, size_t index);

/* tile_rows.c: finds where the column's shadow polygons meet pieces that lie between xa and xb of a sample line: in
 * store.intervals, with room for their parts in tile->parts. Returns 0 when memory fails. */
int gnoi_tile_intervals(gnoi_tile *tile, const gnoi_slot *slot, gnoi_column *column, int lamp, double y, int32_t xa, int32_t xb);

/* Lit parts shorter than this, in pixels, are where rounding parts a receiver's end from its caster's edge: not light but
 * a leak. Spans end on multiples of half of it. */
#define GNOI_LEAK_LENGTH (2.0f / GNOI_X_ONE)

/* tile_scan.c: prepares the order of the bin's polygons; draws them into the lines. */
void gnoi_tile_sort(gnoi_tile *tile, const gnoi_keyed *bin, size_t count);
void gnoi_tile_draw(gnoi_tile *tile, size_t count);

/* tile_slot.c: makes room for slots (0 when memory fails); makes one for a polygon in a lane, of which a part was cut away or not. It is
 * GNOI_NONE when the polygon is seen from its undrawn side or edge on. */
int gnoi_tile_reserve_slots(gnoi_tile *tile, size_t more);
uint32_t gnoi_tile_new_slot(gnoi_tile *tile, const gnoi_lanes *lanes, unsigned lane, uint32_t index, int cut);

/* tile_thin.c: whether a polygon of this width and height in the picture is nearly level and flatter than the base lines are apart; marks
 * the pixels along nearly level edges as having something thin; those of a box (picture coordinates) less than a row high,
 * whose edges may be exactly level and so are not kept. */
int gnoi_tile_is_thin(const gnoi_tile *tile, const gnoi_poly *poly, double width, double height);
void gnoi_tile_mark_thin(gnoi_tile *tile, const gnoi_edge *edges, size_t count);
void gnoi_tile_mark_level(gnoi_tile *tile, double x0, double y0, double x1, double y1);

/* tile_texture.c: the texture of the slot's material in a pixel of the tile (apron included), seen at (x,y), to tile->texel; and a
 * unit normal turned by its bump. */
void gnoi_tile_set_texel(gnoi_tile *tile, gnoi_slot *slot, int row, int column, double x, double y);
void gnoi_tile_ask_texel(gnoi_tile *tile, gnoi_slot *slot, int row, int column, double x, double y);
void gnoi_tile_ask_texels(gnoi_tile *tile, gnoi_slot *slot, int row, int first, int count, const double *x, const double *y); /* a picture, no holes */
vec3 gnoi_tile_bumped(gnoi_tile *tile, gnoi_slot *slot, int row, int column, double x, double y, vec3 n);
/* tile_texture.c: turns the unit normals (n[k][i]: component k of normal i) of neighbouring samples at (x[i],y[i]), GNOI_RELIEF_RUN places, `count` of which
 * are samples; 0, and nothing is done, where they have to be turned one by one. */
int gnoi_tile_bump_run(gnoi_tile *tile, gnoi_slot *slot, int count, const double *x, const double *y, double (*n)[GNOI_RELIEF_RUN]);

/* tile_shade.c: what sample i of the batch is lit by: the normal at picture point (x,y), with bumps; texel number `texel` of those
 * asked for, if one is shown in the row. */
void gnoi_tile_set_normal(gnoi_tile *tile, int i, gnoi_slot *slot, int row, int column, double x, double y);
void gnoi_tile_note_texel(gnoi_tile *tile, int i, const gnoi_tone *tone, int row, size_t texel);

/* Whether texels of the surface are wanted in a row: the rows around the tile are made to be judged by, which means do. */
static inline int gnoi_tile_shows_texel(const gnoi_tile *tile, const gnoi_tone *tone, int row)
{
    return tone->textured && ((row > 0 && row <= tile->height) || tone->mean[0] < 0 || tile->tinted);
}
void gnoi_tile_forget_texels(gnoi_tile *tile);

/* tile_stack.c: what a surface that is not opaque does to what lies behind it. */
gnoi_pass gnoi_tile_pass(void *tile, uint32_t slot, int32_t x0, int32_t x1, double y);

/* tile_stack.c, for tile_rows.c where the tile is veiled: what reaches the eye of a chain of pieces in the row, between two
 * pixels, into tile->veil; what is seen of the background; memory for the lamps' parts (0 when it fails). */
void gnoi_tile_veil(gnoi_tile *tile, int row, uint32_t chain, int first, int last);
void gnoi_tile_veiled_background(gnoi_tile *tile, int row);
void gnoi_tile_uncover(gnoi_tile *tile, int first, int last); /* takes back the coverage by the slot at hand: it hides nothing */
int gnoi_tile_veil_ready(gnoi_tile *tile);

/* tile_stack.c, for tile_rows.c where the tile is tinted: light that came through to [x0,x1) of a piece, on a base line or another (-1). */
void gnoi_tile_add_tinted_light(gnoi_tile *tile, int lamp, const gnoi_piece *piece, float x0, float x1, const double light[3], int line);

/* tile_soft.c: splits one piece where the lamp's shadows weaken with distance; dy, line as in tile_rows.c. */
void gnoi_tile_split_soft(gnoi_tile *tile, int lamp, const gnoi_slot *slot, const gnoi_piece *piece, float dy, int line);
void gnoi_tinted_lines_clear(gnoi_tinted_lines *lines, int first, int last);

/* tile_stack.c, for tile_shade.c where the tile is tinted: sample i of the batch, or a sample with the colour rgb, as the surfaces
 * before it leave it (lit: a part that tile->lit_lamp alone reaches); a colour into the picture, by lines. */
void gnoi_tile_tint_sample(gnoi_tile *tile, int i, int column, const gnoi_cells *cells, int lit);
void gnoi_tile_add_tinted(gnoi_tile *tile, int row, int column, const gnoi_cells *cells, int lit, float rgb[3]);
void gnoi_tile_add_shares(gnoi_tile *tile, uint32_t pixel, const float rgb[3], const float *share, size_t stride);

/* tile_light.c: finds the columns of the surfaces seen on the tile's lines. */
void gnoi_tile_light(gnoi_tile *tile);

/* tile_rows.c: makes samples of every visible piece of row `row` (apron included). */
void gnoi_tile_row(gnoi_tile *tile, int row);

/* tile_rows.c: adds light times length to the pixels of [x0,x1), in pixels from the tile's left side. */
void gnoi_tile_add_light(float colour[3][GNOI_TILE_W], float x0, float x1, const double light[3]);

/* tile_rows.c: adds a part [a,b) of a piece that a lamp reaches with this much light, in pixels from the tile's left side. */
void gnoi_tile_add_lit(gnoi_tile *tile, int lamp, const gnoi_piece *piece, float a, float b, const double light[3], float dy, int line);

/* tile_rows.c: which of its row's base lines a line is; the one line of the apron above is the last, of the apron below the first. */
int gnoi_tile_base_line(const gnoi_tile *tile, int row, uint32_t line);

/* tile_rows.c: the samples of one pixel of a surface, whose coverage is in tile->cells and, for lamps whose column is to be split,
 * in tile->lit and tile->lit_colour. Of `columns`, one for each lamp, only the state is read. */
void gnoi_tile_sample_pixel(gnoi_tile *tile, gnoi_slot *slot, const gnoi_column *columns, int row, int pixel);

/* 1 when a lamp that has to be split reaches all of the surface in a pixel unhindered; all: what the eye would get of light 1. */
int gnoi_tile_reaches_all(const gnoi_tile *tile, int lamp, int pixel, float cover, const float all[3]);

/* tile_run.c: the samples of all pixels from `first` to `last` that the surface covers, as gnoi_tile_sample_pixel makes them; 0 when the
 * surface is not one for that, and nothing is done. */
int gnoi_tile_sample_run(gnoi_tile *tile, gnoi_slot *slot, const gnoi_column *columns, int row, int first, int last);

/* tile_speck.c: facets of those among new slots, whose columns are known, that are small and ask for nothing else; returns 0 when memory fails.
 * Samples of all specks of a row, which are done with then. */
int gnoi_tile_set_facets(gnoi_tile *tile, const uint32_t *slots, size_t count);
void gnoi_tile_sample_specks(gnoi_tile *tile, int row);

/* tile_shade.c: one sample of a slot: the part of pixel `column` of `row` that `cells` hold, at its middle. The caller has
 * set batch.weight[lamp][batch.count] to the coverage (in lines) that each lamp reaches. tint NULL: the surface with its ambient
 * term, seen through tile->veil if the tile is veiled; else the part that one lamp alone reaches (tile->lit_lamp), with this factor
 * on the light. Flushed when the batch is full. */
void gnoi_tile_sample(gnoi_tile *tile, gnoi_slot *slot, int row, int column, const gnoi_cells *cells, const float *tint);
void gnoi_tile_flush(gnoi_tile *tile);

/* tile_shade.c: before the samples of a slot in a pixel. Colours add up in the order of the samples, whenever the batch is flushed: what is
 * in it of this pixel goes first where the slot's samples pass it by. */
void gnoi_tile_keep_order(gnoi_tile *tile, const gnoi_slot *slot, int row, int column);

/* tile_glint.c: sample i of the batch, which is of phong shading and lies at (x,y) of the picture: the points it is to be lit in, all of one
 * weight, to `at`; returns their number, a square, or 1 (and `at` is left alone) where its middle will do. */
#define GNOI_GLINT_POINTS 16 /* at most */
#define GNOI_GLINT_ERROR 0.003f /* smaller ones are left, in units of the picture */
int gnoi_tile_glint(const gnoi_tile *tile, const gnoi_slot *slot, int i, int row, int column, double x, double y, double (*at)[2]);

/* Whether a highlight may bend enough for that in a sample of this share of a pixel: a bound, by which most samples are passed over. A box varies by
 * a twelfth of its side squared along either axis, and its sides squared are taken to be as its area. */
static inline int gnoi_bend_shows(float bend, float share) { return bend * share * share > 12 * GNOI_GLINT_ERROR; }

static inline int gnoi_may_glint(const gnoi_slot *slot, const gnoi_tone *tone, float share)
{
    return gnoi_bend_shows(slot->interp.turn * tone->glint, share);
}

/* tile_layers.c: keeps what tile.cells and tile.lit hold of a pixel of `slot` in `row`; writes the tile's part of the layers from
 * all that was kept. init returns 0 when memory fails; free in any case. */
int gnoi_tile_layers_init(gnoi_tile *tile);
void gnoi_tile_layers_free(gnoi_tile *tile);
void gnoi_tile_layers_start(gnoi_tile *tile);

/* Whether pixel i, unless it has all lines, needs them for its layers. */
int gnoi_tile_layers_need(const gnoi_tile *tile, int i);
void gnoi_tile_layers_keep(gnoi_tile *tile, uint32_t slot, const gnoi_column *columns, int row, int pixel);
void gnoi_tile_layers_write(gnoi_tile *tile);

#endif
