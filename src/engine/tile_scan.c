/* tile_scan.c -- polygons of a tile into the visible lists of its sample lines: see tile.h.
 *
 * Polygons come nearest first, GNOI_LANES at a time; one whose lines are all covered by nearer surfaces costs a look at its bounds and no
 * more. Triangles are set up side by side (scan/lanes.h), polygons of more corners and what must be cut one by one.
 */
#include "base/bits.h"
#include "base/fetch.h"
#include "base/vector.h"
#include "engine/tile.h"
#include "engine/tile_crowd.h"

#define INLINE static inline __attribute__((always_inline))

/* Rounding of a position in the picture relative to the tile in single precision, in pixels, generously: where items reach
 * far out of the picture they are not judged by it closely anyway. */
#define BOUND_SLACK 0.02f

/* The bin as the tile's order to be. What making the items reads is asked for here, in the bin's order, which is the memory's: nearest first
 * it would be met in any order. */
static void copy_bin(gnoi_tile *tile, const gnoi_keyed *bin, size_t count)
{
    const gnoi_prepared *prep = &tile->job->scene->prepared;
    const gnoi_vertex *vertices = tile->job->bins.vertices;
    for (size_t i = 0; i < count; i++) {
        const uint32_t corner = prep->chunk_corner[bin[i].value / GNOI_CHUNK];
        FETCH(&prep->polys[bin[i].value]);
        if (corner != GNOI_NONE)
            FETCH(&prep->corner_vertex[corner + 3 * (bin[i].value % GNOI_CHUNK)]);
        tile->order[i] = bin[i];
    }
    tile->opaque_count = 0;
    for (size_t i = 0; i < count; i++) {
        uint32_t corner_count;
        const uint32_t *vertex = gnoi_corners_of(prep, bin[i].value, &corner_count);
        for (int k = 0; k < 3; k++)
            FETCH(&vertices[vertex[k]]);
        tile->opaque_count += !(bin[i].key & GNOI_KEY_SEE_THROUGH);
    }
}

void gnoi_tile_sort(gnoi_tile *tile, const gnoi_keyed *bin, size_t count)
{
    gno_context *context = tile->lines.context;
    tile->made[0] = 0;
    if (!gnoi_reserve(context, (void **)&tile->order, &tile->order_capacity, count, sizeof *tile->order) ||
        !gnoi_reserve(context, (void **)&tile->order_scratch, &tile->order_scratch_capacity, count, sizeof *tile->order_scratch) ||
        !gnoi_reserve(context, (void **)&tile->items, &tile->item_capacity, count, sizeof *tile->items)) {
        tile->failed = 1;
        return;
    }
    copy_bin(tile, bin, count);
    tile->made[1] = tile->opaque_count;
    gnoi_sort(tile->order, tile->order_scratch, count);
}

/* ---- items ----------------------------------------------------------------------------------------------------------- */

/* Bounds in the picture to those of an item; 0 when the polygon must be cut first, which may then be anywhere. */
static int set_bounds(const gnoi_tile *tile, const gnoi_poly *poly, double x0, double x1, double y0, double y1, gnoi_item *item)
{
    double reach = gnoi_outline_reach(&tile->job->view);
    item->plain = x0 >= -reach && x1 <= reach && y0 >= -reach && y1 <= reach;
    if (!item->plain) {
        item->x0 = item->y0 = -HUGE_VALF;
        item->x1 = item->y1 = item->z1 = HUGE_VALF;
    } else {
        item->thin = (unsigned char)(tile->job->def.lines > tile->job->def.base_lines && gnoi_tile_is_thin(tile, poly, x1 - x0, y1 - y0));
        item->x0 = (float)(x0 - tile->x0) - BOUND_SLACK;
        item->x1 = (float)(x1 - tile->x0) + BOUND_SLACK;
        item->y0 = (float)(y0 - tile->y0) - BOUND_SLACK;
        item->y1 = (float)(y1 - tile->y0) + BOUND_SLACK;
    }
    if (gnoi_is_large(x1 - x0, y1 - y0)) {
        float z = gnoi_nearest_over(tile->job->scene, &tile->job->view, poly, &tile->rect);
        item->z1 = z < item->z1 ? z : item->z1;
    }
    return item->plain;
}

static void set_item(const gnoi_tile *tile, const gnoi_poly *poly, gnoi_item *item)
{
    const uint32_t *vertex = tile->job->scene->prepared.corner_vertex + poly->corner;
    double x0 = HUGE_VAL, x1 = -HUGE_VAL, y0 = HUGE_VAL, y1 = -HUGE_VAL;
    item->z1 = -HUGE_VALF;
    for (uint32_t i = 0; i < poly->corner_count; i++) {
        const gnoi_vertex *v = &tile->job->bins.vertices[vertex[i]];
        x0 = v->x < x0 ? v->x : x0;
        x1 = v->x > x1 ? v->x : x1;
        y0 = v->y < y0 ? v->y : y0;
        y1 = v->y > y1 ? v->y : y1;
        item->z1 = v->z > item->z1 ? v->z : item->z1;
    }
    set_bounds(tile, poly, x0, x1, y0, y1, item);
    item->plain = 0;
}

static void set_triangle_item(const gnoi_tile *tile, const gnoi_poly *poly, unsigned lane, gnoi_item *item)
{
    const gnoi_lanes *l = &tile->lanes;
    item->z1 = l->z1[lane];
    set_bounds(tile, poly, l->x0[lane], l->x1[lane], l->y0[lane], l->y1[lane], item);
}

/* Makes the items [first, first + count) of the order. */
static void make_items(gnoi_tile *tile, size_t first, size_t count)
{
    const gnoi_prepared *prep = &tile->job->scene->prepared;
    uint32_t index[GNOI_LANES];
    for (size_t i = 0; i < count; i++)
        index[i] = tile->order[first + i].value;
    gnoi_lanes_load(&tile->lanes, prep, &tile->job->bins, index, (unsigned)count);
    gnoi_lanes_bound(&tile->lanes);
    for (size_t i = 0; i < count; i++) {
        gnoi_item *item = &tile->items[first + i];
        const gnoi_poly *poly = &prep->polys[index[i]];
        item->poly = index[i];
        item->slot = GNOI_NONE;
        item->thin = 0;
        item->see_through = !poly->opaque;
        if (poly->corner_count == 3)
            set_triangle_item(tile, poly, (unsigned)i, item);
        else
            set_item(tile, poly, item);
    }
}

/* Lines [first,end) of one strip. */
typedef struct range {
    uint32_t first, end;
} range;

/* No item has more: strips do not share pixels. */
#define MOST_RANGES GNOI_TILE_PIXELS

/* Items that are drawn together, and the ranges of lines that each may show on: item i those before ranges[end[i]]. */
typedef struct handful {
    unsigned count;
    gnoi_item *items[GNOI_LANES];
    uint32_t end[GNOI_LANES], range_count;
    range ranges[2 * MOST_RANGES];
} handful;

/* ---- which lines a polygon may show on ------------------------------------------------------------------------------ */

static void set_bar(gnoi_tile *tile, uint32_t line)
{
    const gnoi_line *l = &tile->lines.lines[line];
    tile->bar[line] = l->uncovered > 0 ? -HUGE_VALF : l->farthest;
    tile->covered = line < tile->covered ? line : tile->covered;
}

/* The pixels [first,end) of a row as bits. */
static uint32_t pixel_mask(int first, int end) { return (0xffffffffu >> (32 - end)) & (0xffffffffu << first); }

static void set_masks(gnoi_tile *tile)
{
    const int rows = tile->height + 2;
    for (int row = 0; row < rows; row++) {
        uint32_t *mask = &tile->rows_mask[0][row];
        *mask = 0;
        for (int s = tile->row_strip[row]; s < tile->row_strip_end[row]; s++) {
            gnoi_strip *strip = &tile->strips[s];
            const int first = (int)strip->xa, end = (int)strip->xb;
            strip->pixels = pixel_mask(first, end);
            *mask |= strip->pixels;
            for (int x = first; x < end; x++)
                tile->strip_at[row * GNOI_TILE_W + x] = (uint16_t)s;
        }
    }
    for (int k = 1; k < GNOI_TILE_SPANS; k++)
        for (int row = 0; row + (1 << k) <= rows; row++)
            tile->rows_mask[k][row] = tile->rows_mask[k - 1][row] | tile->rows_mask[k - 1][row + (1 << (k - 1))];
}

static int open_lines(gnoi_tile *tile)
{
    size_t count = tile->lines.line_count;
    if (tile->lines.failed || /* there may be no strips then */
        !gnoi_reserve(tile->lines.context, (void **)&tile->line_y, &tile->line_y_capacity, count + GNOI_LANE_STEP, sizeof *tile->line_y) ||
        !gnoi_reserve(tile->lines.context, (void **)&tile->bar, &tile->bar_capacity, count, sizeof *tile->bar))
        return 0;
    for (size_t i = 0; i < count + GNOI_LANE_STEP; i++)
        tile->line_y[i] = i < count ? tile->lines.lines[i].y : 0;
    for (uint32_t i = 0; i < count; i++)
        set_bar(tile, i);
    set_masks(tile);
    return 1;
}

INLINE float clamped(float v, float least, float most)
{
    v = v < least ? least : v;
    return v > most ? most : v;
}

/* How many of `count` lines, numbered from 0, lie before f. */
INLINE int lines_before(float f, float count)
{
    int n;
    f = clamped(f, 0, count);
    n = (int)f;
    return n + ((float)n < f);
}

/* The strip's lines that an item from y0 to y1 may cross. */
INLINE range line_range(const gnoi_strip *s, float y0, float y1)
{
    const float count = (float)(s->count + s->absent);
    uint32_t first = (uint32_t)lines_before((y0 - s->y) * s->per_row, count), end = (uint32_t)lines_before((y1 - s->y) * s->per_row, count);
    range r = {s->first + (first > s->absent ? first - s->absent : 0), s->first + (end < s->count ? end : s->count)};
    return r;
}

/* Whether a surface no nearer than `nearest` may be seen on one of these lines. */
static inline int is_open(const gnoi_tile *tile, float nearest, range r)
{
    for (; r.first < r.end; r.first++)
        if (!(tile->bar[r.first] > nearest))
            return 1;
    return 0;
}

/* Whether nothing at nearness z or farther can be seen in the tile any more, asked with falling z. */
static int is_covered(gnoi_tile *tile, float z)
{
    size_t i = tile->covered;
    while (i < tile->lines.line_count && tile->bar[i] > z)
        i++;
    tile->covered = i;
    return i == tile->lines.line_count;
}

/* Bounds of items side by side. */
typedef struct bounds {
    float x0[GNOI_LANES], x1[GNOI_LANES], y0[GNOI_LANES], y1[GNOI_LANES];
} bounds;

static void load_bounds(bounds *b, const gnoi_item *items, size_t count)
{
    for (size_t i = 0; i < GNOI_LANES; i++) {
        const gnoi_item *item = &items[i < count ? i : 0];
        b->x0[i] = item->x0;
        b->x1[i] = item->x1;
        b->y0[i] = item->y0;
        b->y1[i] = item->y1;
    }
}

/* The lines, or the rows, that items may cross, side by side: [first,end), none where they meet no line. */
typedef struct reaches {
    int32_t first[GNOI_LANES], end[GNOI_LANES];
    uint32_t pixels[GNOI_LANES]; /* with rows: bit x, it may be in pixel x of them */
} reaches;

/* Lines of the one strip of the base lines. */
VECTOR_CLONES static void reach_lines(reaches *restrict r, const bounds *restrict b, const gnoi_strip *strip)
{
    const float y = strip->y, per_row = strip->per_row, count = (float)strip->count, xa = strip->xa, xb = strip->xb;
    for (int i = 0; i < GNOI_LANES; i++) {
        int first = lines_before((b->y0[i] - y) * per_row, count), end = lines_before((b->y1[i] - y) * per_row, count);
        r->first[i] = first;
        r->end[i] = ((b->x1[i] > xa) & (b->x0[i] < xb)) ? end : first;
    }
}

/* Rows of the tile. What lies beside it is taken to be in its outermost pixels. */
VECTOR_CLONES static void reach_rows(reaches *restrict r, const bounds *restrict b, const uint32_t *restrict rows_mask, int rows)
{
    const float most = (float)(rows - 1);
    for (int i = 0; i < GNOI_LANES; i++) {
        int first = (int)clamped(b->y0[i] + 1, 0, most), last = (int)clamped(b->y1[i] + 1, 0, most), n = last - first + 1;
        int left = (int)clamped(b->x0[i], 0, 31), right = (int)clamped(b->x1[i], 0, 31);
        int k = (n >= 2) + (n >= 4) + (n >= 8) + (n >= 16) + (n >= 32);
        uint32_t seen = rows_mask[k * GNOI_TILE_ROWS + first] | rows_mask[k * GNOI_TILE_ROWS + last + 1 - (1 << k)];
        uint32_t pixels = (0xffffffffu >> (31 - right)) & (0xffffffffu << left);
        r->first[i] = first;
        r->end[i] = seen & pixels ? last + 1 : first;
        r->pixels[i] = pixels;
    }
}

/* ---- polygons of any shape ------------------------------------------------------------------------------------------- */

static int set_edges(gnoi_tile *tile)
{
    const gnoi_outline *o = &tile->outline;
    uint32_t first = 0;
    if (!gnoi_reserve(tile->lines.context, (void **)&tile->edges, &tile->edge_capacity, o->count, sizeof *tile->edges) ||
        !gnoi_reserve(tile->lines.context, (void **)&tile->crossings, &tile->crossing_capacity, o->count, sizeof *tile->crossings))
        return 0;
    for (size_t r = 0; r < o->ring_count; r++) {
        uint32_t end = o->ring_end[r];
        for (uint32_t i = first; i < end; i++) {
            const gnoi_hpoint *a = &o->points[i], *b = &o->points[i + 1 < end ? i + 1 : first];
            tile->edge_count += (size_t)gnoi_edge_set(&tile->edges[tile->edge_count], a->x, a->y, b->x, b->y);
        }
        first = end;
    }
    return 1;
}

/* Outline and edges of any polygon; no edges when nothing of it can be seen or memory fails. */
static void set_polygon(gnoi_tile *tile, const gnoi_poly *poly)
{
    tile->edge_count = 0;
    if (!gnoi_outline_set(&tile->outline, tile->job->scene, &tile->job->view, tile->job->bins.vertices, poly) ||
        (tile->outline.count >= 3 && !set_edges(tile)))
        tile->failed = 1;
}

/* Marks where a thin polygon passes that the lines around it do not show to be hidden. */
static void judge_thin(gnoi_tile *tile, const gnoi_item *item)
{
    if (!is_open(tile, item->z1, line_range(&tile->strips[0], item->y0 - 1, item->y1 + 1)))
        return;
    set_polygon(tile, &tile->job->scene->prepared.polys[item->poly]);
    gnoi_tile_mark_thin(tile, tile->edges, tile->edge_count);
    gnoi_tile_mark_level(tile, tile->outline.x0, tile->outline.y0, tile->outline.x1, tile->outline.y1);
}

/* ---- drawing --------------------------------------------------------------------------------------------------------- */

static inline void draw_segment(gnoi_tile *tile, const gnoi_item *item, uint32_t line, int32_t x0, int32_t x1)
{
    if (item->see_through)
        gnoi_stacks_insert(&tile->stacks, &tile->lines, line, item->slot, x0, x1);
    else if (gnoi_lines_insert(&tile->lines, line, item->slot, x0, x1))
        set_bar(tile, line);
}

/* crowd: NULL for a polygon of few edges. */
static void draw_polygon_line(gnoi_tile *tile, const gnoi_item *item, uint32_t line, gnoi_crowd *crowd)
{
    double y = tile->line_y[line], *x = tile->crossings;
    unsigned n = crowd ? gnoi_crowd_cross(crowd, y, x) : gnoi_edges_cross(tile->edges, (unsigned)tile->edge_count, y, x);
    for (unsigned i = 0; i + 1 < n; i += 2) {
        int32_t x0 = gnoi_lane_position(x[i], tile->x0, GNOI_TILE_MOST), x1 = gnoi_lane_position(x[i + 1], tile->x0, GNOI_TILE_MOST);
        if (x0 < x1)
            draw_segment(tile, item, line, x0, x1);
    }
}

static uint32_t polygon_slot(gnoi_tile *tile, uint32_t index)
{
    const gnoi_frame_job *job = tile->job;
    const gnoi_poly *poly = &job->scene->prepared.polys[index];
    const gnoi_outline *o = &tile->outline;
    gnoi_lanes *l = &tile->single;
    l->x0[0] = o->x0;
    l->x1[0] = o->x1;
    l->y0[0] = o->y0;
    l->y1[0] = o->y1;
    l->z0[0] = o->z0;
    l->z1[0] = o->z1;
    gnoi_lanes_set_plane(l, 0, poly, gnoi_plane_tolerance(&job->scene->prepared, (const double(*)[3])job->scene->prepared.positions, poly));
    gnoi_lanes_see(l, &job->view, &tile->rect);
    if (!gnoi_tile_reserve_slots(tile, 1)) {
        tile->failed = 1;
        return GNOI_NONE;
    }
    return gnoi_tile_new_slot(tile, l, 0, index, o->cut);
}

static void draw_polygon(gnoi_tile *tile, gnoi_item *item, const range *ranges, uint32_t count)
{
    gnoi_crowd many, *crowd = NULL;
    float bound;
    set_polygon(tile, &tile->job->scene->prepared.polys[item->poly]);
    if (tile->edge_count == 0)
        return;
    if (item->slot == GNOI_NONE)
        item->slot = polygon_slot(tile, item->poly);
    if (item->slot == GNOI_NONE)
        return;
    bound = tile->lines.depths[item->slot].surely_before;
    if (tile->edge_count > GNOI_CROWD) {
        many = gnoi_crowd_make(tile->edges, tile->edge_count, tile->y0 - 1, tile->y0 + tile->height + 1);
        crowd = &many;
    }
    for (uint32_t r = 0; r < count; r++)
        for (uint32_t line = ranges[r].first; line < ranges[r].end; line++)
            if (!(tile->bar[line] > bound))
                draw_polygon_line(tile, item, line, crowd);
}

/* The triangle in a lane, which has a slot. */
static void draw_triangle(gnoi_tile *tile, const gnoi_item *item, unsigned lane, const range *ranges, uint32_t range_count)
{
    gnoi_lanes *l = &tile->lanes;
    float bound = tile->lines.depths[item->slot].surely_before;
    for (uint32_t r = 0; r < range_count; r++)
        for (uint32_t line = ranges[r].first, end = ranges[r].end; line < end; line += GNOI_LANE_LINES) {
            uint32_t count = end - line < GNOI_LANE_LINES ? end - line : GNOI_LANE_LINES;
            gnoi_lanes_cross(l, lane, tile->line_y + line, count, tile->x0, GNOI_TILE_MOST);
            for (uint32_t i = 0; i < count; i++)
                if (l->from[i] < l->to[i] && !(tile->bar[line + i] > bound))
                    draw_segment(tile, item, line + i, l->from[i], l->to[i]);
        }
}

/* Edges of the triangles among the items, and slots where they have none. */
static void set_up(gnoi_tile *tile, gnoi_item *const *items, unsigned count)
{
    const gnoi_frame_job *job = tile->job;
    gnoi_lanes *l = &tile->lanes;
    uint32_t index[GNOI_LANES];
    int fresh = 0;
    for (unsigned i = 0; i < count; i++) {
        index[i] = items[i]->poly;
        fresh |= items[i]->plain && items[i]->slot == GNOI_NONE;
    }
    gnoi_lanes_load(l, &job->scene->prepared, &job->bins, index, count);
    gnoi_lanes_set_edges(l);
    if (!fresh)
        return;
    for (unsigned i = 0; i < count; i++)
        if (items[i]->slot == GNOI_NONE)
            gnoi_lanes_set_plane(l, i, &job->scene->prepared.polys[index[i]], gnoi_lanes_tolerance(l, i, &job->bins));
    gnoi_lanes_bound(l);
    gnoi_lanes_see(l, &job->view, &tile->rect);
    if (!gnoi_tile_reserve_slots(tile, count)) {
        tile->failed = 1;
        return;
    }
    for (unsigned i = 0; i < count; i++)
        if (items[i]->plain && items[i]->slot == GNOI_NONE)
            items[i]->slot = gnoi_tile_new_slot(tile, l, i, index[i], 0);
}

static void draw_handful(gnoi_tile *tile, handful *h)
{
    uint32_t first = 0;
    if (h->count > 0)
        set_up(tile, h->items, h->count);
    for (unsigned i = 0; i < h->count && !tile->failed; first = h->end[i++]) {
        const range *ranges = h->ranges + first;
        const uint32_t count = h->end[i] - first;
        if (!h->items[i]->plain)
            draw_polygon(tile, h->items[i], ranges, count);
        else if (h->items[i]->slot != GNOI_NONE)
            draw_triangle(tile, h->items[i], i, ranges, count);
    }
    h->count = h->range_count = 0;
    tile->failed |= tile->lines.failed;
}

/* Puts the item, whose ranges were added, into the handful; draws the handful when it is full. */
static void take_item(gnoi_tile *tile, gnoi_item *item, handful *h)
{
    h->end[h->count] = h->range_count;
    h->items[h->count++] = item;
    if (h->count == GNOI_LANES || h->range_count > MOST_RANGES)
        draw_handful(tile, h);
}

static float nearest_of(const gnoi_item *item) { return item->z1 + GNOI_FLOAT_SLACK * fabsf(item->z1); }

/* Takes those of the items that may show on base lines. */
static void take_on_base(gnoi_tile *tile, gnoi_item *items, size_t count, handful *h)
{
    bounds b;
    reaches r;
    load_bounds(&b, items, count);
    reach_lines(&r, &b, &tile->strips[0]);
    for (size_t i = 0; i < count; i++) {
        range lines;
        if (items[i].thin && tile->judging && items[i].x1 > 0 && items[i].x0 < (float)tile->width)
            judge_thin(tile, &items[i]);
        lines.first = (uint32_t)r.first[i];
        lines.end = (uint32_t)r.end[i];
        if (is_open(tile, nearest_of(&items[i]), lines)) {
            h->ranges[h->range_count++] = lines;
            take_item(tile, &items[i], h);
        }
    }
}

/* Adds the ranges of lines that an item of these rows and pixels may show on. */
static inline void add_ranges(const gnoi_tile *tile, const gnoi_item *item, int row, int row_end, uint32_t pixels, handful *h)
{
    const float nearest = nearest_of(item);
    for (; row < row_end; row++)
        for (uint32_t left = tile->rows_mask[0][row] & pixels; left;) {
            const gnoi_strip *strip = &tile->strips[tile->strip_at[row * GNOI_TILE_W + (int)gnoi_lowest_bit(left)]];
            const range lines = line_range(strip, item->y0, item->y1);
            left &= ~strip->pixels;
            if (is_open(tile, nearest, lines))
                h->ranges[h->range_count++] = lines;
        }
}

/* The same on the strips of finer lines. */
static void take_on_strips(gnoi_tile *tile, gnoi_item *items, size_t count, handful *h)
{
    bounds b;
    reaches r;
    load_bounds(&b, items, count);
    reach_rows(&r, &b, tile->rows_mask[0], tile->height + 2);
    for (size_t i = 0; i < count; i++) {
        const uint32_t before = h->range_count;
        add_ranges(tile, &items[i], r.first[i], r.end[i], r.pixels[i], h);
        if (h->range_count > before)
            take_item(tile, &items[i], h);
    }
}

/* Puts what is not opaque over and between the complete lines. */
static void finish_stacks(gnoi_tile *tile)
{
    tile->veiled = tile->stacks.segment_count > 1;
    tile->was_veiled |= tile->veiled;
    if (tile->veiled && !tile->failed)
        gnoi_stacks_resolve(&tile->stacks, &tile->lines, gnoi_tile_pass, tile);
    tile->failed |= tile->stacks.failed;
}

/* Draws the items [first,end) of the order, of which those before *made are made already. */
static void draw_range(gnoi_tile *tile, size_t first, size_t end, size_t *made)
{
    handful h;
    h.count = h.range_count = 0;
    tile->covered = 0;
    for (size_t i = first, stop; i < end && !tile->failed; i = stop) {
        stop = end - i < GNOI_LANES ? end : i + GNOI_LANES;
        if (i >= *made) {
            make_items(tile, i, stop - i);
            *made = stop;
        }
        if (is_covered(tile, gnoi_key_nearness(tile->order[i].key)))
            break;
        if (tile->strips[0].absent == 0)
            take_on_base(tile, &tile->items[i], stop - i, &h);
        else
            take_on_strips(tile, &tile->items[i], stop - i, &h);
        tile->failed |= i / GNOI_LANES % 4 == 3 && gnoi_stopped(tile->lines.context);
    }
    if (!tile->failed)
        draw_handful(tile, &h);
}

void gnoi_tile_draw(gnoi_tile *tile, size_t count)
{
    tile->veiled = 0;
    tile->failed |= !open_lines(tile);
    draw_range(tile, 0, tile->opaque_count, &tile->made[0]);
    if (count > tile->opaque_count) {
        gnoi_stacks_reset(&tile->stacks, &tile->lines);
        tile->failed |= tile->stacks.failed;
        draw_range(tile, tile->opaque_count, count, &tile->made[1]);
        finish_stacks(tile);
    }
    tile->tinted = tile->veiled || (tile->job->tinted && tile->judging);
    tile->failed |= tile->lines.failed;
}
