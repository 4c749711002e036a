/* tile_scan.c -- polygons of a tile into the visible lists of its sample lines: see tile.h.
 *
 * Polygons come nearest first; one whose lines are all covered by nearer surfaces costs a look at its bounds and no more.
 */
#include "base/tolerance.h"
#include "engine/tile.h"
#include <string.h>

/* Rounding of single precision bounds, relative. */
#define FLOAT_SLACK 1e-6f

/* Rounding of a position in the picture relative to the tile in single precision, in pixels, generously: where items reach
 * far out of the picture they are not judged by it closely anyway. */
#define BOUND_SLACK 0.02f

static uint32_t descending_key(float z)
{
    union { float f; uint32_t i; } u = {z};
    return u.i & 0x80000000u ? u.i : ~u.i & 0x7fffffffu;
}

/* Added to the key of what is not opaque, so that it comes after all that is. */
#define SEE_THROUGH (1u << 22)

/* Items are in order but for the bits that their keys leave away; after so many it is looked whether the rest can be seen at all. */
#define ORDER_SLACK 5e-4f
#define COVER_STEP 16

/* A polygon counts as thin from this width on, in pixels, and while it rises by less than this share of it. */
#define THIN_WIDTH 6.0
#define THIN_SLOPE 0.5

static int is_thin(const gnoi_tile *tile, const gnoi_poly *poly, double width, double height)
{
    const gnoi_prepared *prep = &tile->job->scene->prepared;
    const uint32_t *vertex = prep->corner_vertex;
    uint32_t end = prep->ring_corner[poly->ring + 1];
    const gnoi_vertex *a = &tile->job->bins.vertices[vertex[poly->corner]];
    double area = 0;
    if (width < THIN_WIDTH || height > THIN_SLOPE * width + 1)
        return 0;
    for (uint32_t i = poly->corner + 1; i + 1 < end; i++) {
        const gnoi_vertex *b = &tile->job->bins.vertices[vertex[i]], *c = &tile->job->bins.vertices[vertex[i + 1]];
        area += 0.5 * ((b->x - a->x) * (c->y - a->y) - (b->y - a->y) * (c->x - a->x));
    }
    return fabs(area) * tile->job->def.base_lines < width;
}

/* The pixel number v lies in, cut off towards 0, from -1 to most: coordinates may be beyond any integer. */
static int pixel_at(double v, int most) { return v > -1 ? v < most ? (int)v : most : -1; }

void gnoi_tile_mark_thin(gnoi_tile *tile, const gnoi_edge *edges, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const gnoi_edge *e = &edges[i];
        double x1 = e->x + (e->y1 - e->y) * e->slope, left = (e->x < x1 ? e->x : x1) - tile->x0, right = (e->x < x1 ? x1 : e->x) - tile->x0;
        int first, last;
        if (right - left < THIN_WIDTH || fabs(e->slope) * THIN_SLOPE < 1)
            continue;
        first = left > 0 ? pixel_at(left, tile->width) : 0;
        last = right < tile->width ? pixel_at(right, tile->width) : tile->width - 1;
        for (int x = first; x <= last; x++) {
            double at = tile->x0 + x + 0.5, y = e->y + (at - e->x) / e->slope - tile->y0 + 1;
            y = y < e->y - tile->y0 + 1 ? e->y - tile->y0 + 1 : y > e->y1 - tile->y0 + 1 ? e->y1 - tile->y0 + 1 : y;
            if (y >= 1 && y < tile->height + 1)
                tile->thin[(int)y * GNOI_TILE_W + x] = 1;
        }
    }
}

void gnoi_tile_mark_level(gnoi_tile *tile, double x0, double y0, double x1, double y1)
{
    int first = x0 > tile->x0 ? pixel_at(x0 - tile->x0, tile->width) : 0;
    int last = x1 < tile->x0 + tile->width ? pixel_at(x1 - tile->x0, tile->width) : tile->width - 1;
    double top = y0 - tile->y0 + 1, bottom = y1 - tile->y0 + 1;
    if (y1 - y0 >= 1)
        return;
    for (int row = top > 1 ? pixel_at(top, tile->height + 1) : 1; row <= tile->height && row <= bottom; row++)
        for (int x = first; x <= last; x++)
            tile->thin[row * GNOI_TILE_W + x] = 1;
}

/* Bounds of a plane's nearness over the tile. */
static void plane_bounds(const gnoi_tile *tile, const gnoi_screen_plane *plane, float *low, float *high)
{
    double x0 = tile->x0, x1 = x0 + tile->width, y0 = tile->y0 - 0.5, y1 = y0 + tile->height + 1;
    double zx0 = plane->fx * x0, zx1 = plane->fx * x1, zy0 = plane->fy * y0, zy1 = plane->fy * y1;
    *low = (float)((zx0 < zx1 ? zx0 : zx1) + (zy0 < zy1 ? zy0 : zy1) + plane->f0);
    *high = (float)((zx0 > zx1 ? zx0 : zx1) + (zy0 > zy1 ? zy0 : zy1) + plane->f0);
}

static void set_tolerance(const gnoi_frame_job *job, double tolerance, double side, gnoi_depth *depth)
{
    depth->tolerance_z = job->view.orthographic ? 0 : tolerance / fabs(side);
    depth->tolerance_0 = job->view.orthographic ? tolerance / fabs(side) : 0;
}

/* `nearest`, widened by the tolerance, is before all of the surface. */
static void set_before(gnoi_depth *depth, float nearest)
{
    depth->nearest = nearest + FLOAT_SLACK * fabsf(nearest);
    depth->surely_before = depth->nearest + (float)(depth->tolerance_z * fabs((double)depth->nearest) + depth->tolerance_0);
    depth->surely_before += FLOAT_SLACK * fabsf(depth->surely_before);
}

static void set_behind(gnoi_depth *depth, float farthest)
{
    depth->farthest = farthest - FLOAT_SLACK * fabsf(farthest);
    depth->surely_behind = depth->farthest - (float)(depth->tolerance_z * fabs((double)depth->farthest) + depth->tolerance_0);
    depth->surely_behind -= FLOAT_SLACK * fabsf(depth->surely_behind);
}

/* Bounds of the surface's nearness in the tile: those of its corners, and those of its plane over the tile. */
static void set_depth_bounds(const gnoi_tile *tile, const gnoi_screen_plane *plane, gnoi_depth *depth)
{
    float low, high;
    plane_bounds(tile, plane, &low, &high);
    set_before(depth, tile->outline.z1 < high ? tile->outline.z1 : high);
    set_behind(depth, tile->outline.z0 > low ? tile->outline.z0 : low);
}

static double tolerance_of(const gnoi_frame_job *job, const gnoi_poly *poly)
{
    return gnoi_plane_tolerance(&job->scene->prepared, (const double(*)[3])job->scene->prepared.positions, poly);
}

/* What is before all that is seen in the tile of a polygon far larger: a ground near the viewer must not come first in the tiles
 * of what stands on it far away. */
static float nearest_in_tile(const gnoi_tile *tile, const gnoi_poly *poly)
{
    const gnoi_frame_job *job = tile->job;
    double side = gnoi_view_side(&job->view, poly->n, poly->d);
    gnoi_screen_plane plane;
    gnoi_depth depth;
    float low, high;
    if (side == 0)
        return HUGE_VALF;
    plane = gnoi_view_nearness(&job->view, poly->n, poly->d, side);
    plane_bounds(tile, &plane, &low, &high);
    set_tolerance(job, tolerance_of(job, poly), side, &depth);
    set_before(&depth, high);
    return depth.surely_before == depth.surely_before ? depth.surely_before : HUGE_VALF;
}

/* Bounds of a polygon in the picture; the whole tile for one that must be cut first. */
static gnoi_item item_of(const gnoi_tile *tile, const gnoi_poly *poly)
{
    const uint32_t *vertex = tile->job->scene->prepared.corner_vertex + poly->corner;
    double reach = gnoi_outline_reach(&tile->job->view), x0 = HUGE_VAL, x1 = -HUGE_VAL, y0 = HUGE_VAL, y1 = -HUGE_VAL;
    gnoi_item item;
    item.z1 = -HUGE_VALF;
    item.slot = GNOI_NONE;
    item.thin = 0;
    item.see_through = !poly->opaque;
    for (uint32_t i = 0; i < poly->corner_count; i++) {
        const gnoi_vertex *v = &tile->job->bins.vertices[vertex[i]];
        x0 = v->x < x0 ? v->x : x0;
        x1 = v->x > x1 ? v->x : x1;
        y0 = v->y < y0 ? v->y : y0;
        y1 = v->y > y1 ? v->y : y1;
        item.z1 = v->z > item.z1 ? v->z : item.z1;
    }
    item.plain = x0 >= -reach && x1 <= reach && y0 >= -reach && y1 <= reach;
    if (!item.plain) {
        item.x0 = item.y0 = -HUGE_VALF;
        item.x1 = item.y1 = HUGE_VALF;
        item.z1 = nearest_in_tile(tile, poly);
        return item;
    }
    if (x1 - x0 > GNOI_TILE_W || y1 - y0 > GNOI_TILE_H) {
        float z = nearest_in_tile(tile, poly);
        item.z1 = z < item.z1 ? z : item.z1;
    }
    item.plain = poly->corner_count == 3;
    item.thin = (unsigned char)(tile->job->def.lines > tile->job->def.base_lines && is_thin(tile, poly, x1 - x0, y1 - y0));
    item.x0 = (float)(x0 - tile->x0) - BOUND_SLACK;
    item.x1 = (float)(x1 - tile->x0) + BOUND_SLACK;
    item.y0 = (float)(y0 - tile->y0) - BOUND_SLACK;
    item.y1 = (float)(y1 - tile->y0) + BOUND_SLACK;
    return item;
}

void gnoi_tile_sort(gnoi_tile *tile, const uint32_t *items, size_t count)
{
    gno_context *context = tile->lines.context;
    if (!gnoi_reserve(context, (void **)&tile->edges, &tile->edge_capacity, 3, sizeof *tile->edges) ||
        !gnoi_reserve(context, (void **)&tile->crossings, &tile->crossing_capacity, 3, sizeof *tile->crossings) ||
        !gnoi_reserve(context, (void **)&tile->order, &tile->order_capacity, count, sizeof *tile->order) ||
        !gnoi_reserve(context, (void **)&tile->order_scratch, &tile->order_scratch_capacity, count, sizeof *tile->order_scratch) ||
        !gnoi_reserve(context, (void **)&tile->items, &tile->item_capacity, count, sizeof *tile->items)) {
        tile->failed = 1;
        return;
    }
    tile->opaque_count = count;
    for (size_t i = 0; i < count; i++) {
        tile->items[i] = item_of(tile, &tile->job->scene->prepared.polys[items[i]]);
        tile->order[i].key = descending_key(tile->items[i].z1) >> 10;
        tile->order[i].value = (uint32_t)i;
        if (tile->items[i].see_through) {
            tile->order[i].key |= SEE_THROUGH;
            tile->opaque_count--;
        }
    }
    gnoi_sort(tile->order, tile->order_scratch, count);
}

static double clamp(double v, double lo, double hi) { return v < lo ? lo : v > hi ? hi : v; }

/* A slot for the polygon of the outline at hand; GNOI_NONE when it is seen from its undrawn side or edge on. */
static uint32_t new_slot(gnoi_tile *tile, uint32_t index)
{
    const gnoi_frame_job *job = tile->job;
    const gnoi_poly *poly = &job->scene->prepared.polys[index];
    const gnoi_outline *o = &tile->outline;
    double side = gnoi_view_side(&job->view, poly->n, poly->d), x1 = tile->x0 + tile->width, y1 = tile->y0 + tile->height + 0.5;
    gno_context *context = tile->lines.context;
    gnoi_lines *lines = &tile->lines;
    gnoi_receiver *r;
    gnoi_depth *depth;
    gnoi_slot *slot;
    if (side == 0 || (side < 0 && !poly->two_sided))
        return GNOI_NONE;
    if (!gnoi_reserve(context, (void **)&tile->slots, &tile->slot_capacity, tile->slot_count + 1, sizeof *tile->slots) ||
        !gnoi_reserve(context, (void **)&lines->depths, &lines->depth_capacity, tile->slot_count + 1, sizeof *lines->depths)) {
        tile->failed = 1;
        return GNOI_NONE;
    }
    slot = &tile->slots[tile->slot_count];
    depth = &lines->depths[tile->slot_count];
    slot->first_column = slot->first_intensity = slot->mapping = GNOI_NONE;
    slot->intensity_triangle = GNOI_NONE;
    slot->chain = 0;
    slot->interp.ready = 0;
    r = &slot->receiver;
    r->poly = poly;
    r->index = index;
    r->side = side;
    r->nearness = gnoi_view_nearness(&job->view, poly->n, poly->d, side);
    r->tolerance = tolerance_of(job, poly);
    r->x0 = clamp(o->x0, tile->x0, x1);
    r->x1 = clamp(o->x1, tile->x0, x1);
    r->y0 = clamp(o->y0, tile->y0 - 0.5, y1);
    r->y1 = clamp(o->y1, tile->y0 - 0.5, y1);
    r->first_row = (int)floor(r->y0);
    r->rows = (int)floor(r->y1) - r->first_row + 1;
    r->whole = !o->cut && r->x0 == o->x0 && r->x1 == o->x1 && r->y0 == o->y0 && r->y1 == o->y1;
    depth->fx = r->nearness.fx / GNOI_X_ONE;
    depth->fy = r->nearness.fy;
    depth->f0 = r->nearness.f0 + r->nearness.fx * tile->x0;
    set_tolerance(job, r->tolerance, side, depth);
    depth->index = poly->source;
    depth->priority = poly->priority;
    set_depth_bounds(tile, &r->nearness, depth);
    return (uint32_t)tile->slot_count++;
}

static int set_edges(gnoi_tile *tile)
{
    const gnoi_outline *o = &tile->outline;
    uint32_t first = 0;
    tile->edge_count = 0;
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

static double least(double a, double b, double c) { return a < b ? (a < c ? a : c) : (b < c ? b : c); }
static double most(double a, double b, double c) { return a > b ? (a > c ? a : c) : (b > c ? b : c); }

/* Outline and edges of a triangle that needs no cutting, without the detour over rings. */
static void set_triangle(gnoi_tile *tile, const gnoi_poly *poly)
{
    const uint32_t *corner = tile->job->scene->prepared.corner_vertex + poly->corner;
    const gnoi_vertex *a = &tile->job->bins.vertices[corner[0]], *b = &tile->job->bins.vertices[corner[1]],
                      *c = &tile->job->bins.vertices[corner[2]];
    gnoi_outline *o = &tile->outline;
    size_t n = 0;
    o->x0 = least(a->x, b->x, c->x);
    o->x1 = most(a->x, b->x, c->x);
    o->y0 = least(a->y, b->y, c->y);
    o->y1 = most(a->y, b->y, c->y);
    o->z0 = (float)least((double)a->z, (double)b->z, (double)c->z);
    o->z1 = (float)most((double)a->z, (double)b->z, (double)c->z);
    o->cut = 0;
    n += (size_t)gnoi_edge_set(&tile->edges[n], a->x, a->y, b->x, b->y);
    n += (size_t)gnoi_edge_set(&tile->edges[n], b->x, b->y, c->x, c->y);
    n += (size_t)gnoi_edge_set(&tile->edges[n], c->x, c->y, a->x, a->y);
    tile->edge_count = n;
}

/* Outline and edges of any polygon; no edges when nothing of it can be seen or memory fails. */
static void set_polygon(gnoi_tile *tile, const gnoi_poly *poly)
{
    if (!gnoi_outline_set(&tile->outline, tile->job->scene, &tile->job->view, tile->job->bins.vertices, poly) ||
        (tile->outline.count >= 3 && !set_edges(tile)))
        tile->failed = 1;
}

/* Truncation instead of floor: what is added makes the number positive. */
static int32_t line_position(const gnoi_tile *tile, double x)
{
    double t = (x - tile->x0) * GNOI_X_ONE;
    t = clamp(t, -(double)GNOI_X_ONE, (double)(GNOI_TILE_W + 1) * GNOI_X_ONE);
    return (int32_t)(t + (GNOI_X_ONE + 0.5)) - GNOI_X_ONE;
}

static inline void draw_line(gnoi_tile *tile, uint32_t line, uint32_t slot, int see_through)
{
    double y = tile->lines.lines[line].y, *x = tile->crossings;
    unsigned n = gnoi_edges_cross(tile->edges, (unsigned)tile->edge_count, y, x);
    for (unsigned i = 0; i + 1 < n; i += 2) {
        int32_t x0 = line_position(tile, x[i]), x1 = line_position(tile, x[i + 1]);
        if (x0 < x1 && see_through)
            gnoi_stacks_insert(&tile->stacks, &tile->lines, line, slot, x0, x1);
        else if (x0 < x1)
            gnoi_lines_insert(&tile->lines, line, slot, x0, x1);
    }
}

/* ---- which lines a polygon may show on ------------------------------------------------------------------------------ */

static void set_bar(gnoi_tile *tile, uint32_t line)
{
    const gnoi_line *l = &tile->lines.lines[line];
    tile->open[line].bar = l->uncovered > 0 ? -HUGE_VALF : l->farthest;
}

static uint32_t pixel_mask(float x0, float x1)
{
    unsigned first = x0 > 0 ? (unsigned)x0 : 0, last = x1 < GNOI_TILE_W - 1 ? (unsigned)x1 : GNOI_TILE_W - 1;
    return (0xffffffffu >> (31 - last)) & (0xffffffffu << first);
}

static int open_lines(gnoi_tile *tile)
{
    if (!gnoi_reserve(tile->lines.context, (void **)&tile->open, &tile->open_capacity, tile->lines.line_count, sizeof *tile->open))
        return 0;
    for (int row = 0; row < tile->height + 2; row++) {
        tile->row_mask[row] = 0;
        for (uint32_t i = tile->row_line[row]; i < tile->row_line[row + 1]; i++) {
            const gnoi_line *l = &tile->lines.lines[i];
            gnoi_open *o = &tile->open[i];
            o->y = (float)(l->y - tile->y0);
            o->xa = (float)l->xa / GNOI_X_ONE;
            o->xb = (float)l->xb / GNOI_X_ONE;
            tile->row_mask[row] |= pixel_mask(o->xa, o->xb - 1);
            set_bar(tile, i);
        }
    }
    return 1;
}

/* 1 when a line may cross the item and show a surface no nearer than `nearest`. */
static inline int is_open(const gnoi_open *line, const gnoi_item *item, float nearest)
{
    return line->y >= item->y0 && line->xa < item->x1 && line->xb > item->x0 && !(line->bar > nearest) && line->y < item->y1;
}

/* Lines of the tile that the item may cross, in order of height: [*first,*end). */
static void line_range(const gnoi_tile *tile, const gnoi_item *item, uint32_t *first, uint32_t *end)
{
    int rows = tile->height + 2;
    float y0 = item->y0 + 1, y1 = item->y1 + 1;
    int r0 = y0 > 0 ? y0 < (float)rows ? (int)y0 : rows : 0, r1 = y1 > 0 ? y1 < (float)(rows - 1) ? (int)y1 : rows - 1 : 0;
    uint32_t mask = item->x1 > 0 && item->x0 < GNOI_TILE_W ? pixel_mask(item->x0, item->x1) : 0, seen = 0;
    *first = *end = 0;
    if (y1 < 0 || r1 < r0)
        return;
    for (int row = r0; row <= r1; row++)
        seen |= tile->row_mask[row];
    if (!(seen & mask))
        return;
    *first = tile->row_line[r0];
    *end = tile->row_line[r1 + 1];
    while (*end > *first && !(tile->open[*end - 1].y < item->y1))
        --*end;
}

/* Whether nothing at nearness z or farther can be seen in the tile any more. */
static int is_covered(const gnoi_tile *tile, float z)
{
    for (size_t i = 0; i < tile->lines.line_count; i++)
        if (!(tile->open[i].bar > z))
            return 0;
    return 1;
}

static void set_outline(gnoi_tile *tile, const gnoi_item *item, const gnoi_poly *poly)
{
    tile->edge_count = 0;
    if (item->plain)
        set_triangle(tile, poly);
    else
        set_polygon(tile, poly);
}

/* Marks where a thin polygon passes that the lines around it do not show to be hidden. */
static void judge_thin(gnoi_tile *tile, const gnoi_item *item, const gnoi_poly *poly)
{
    gnoi_item around = *item;
    uint32_t line, end;
    around.y0 -= 1;
    around.y1 += 1;
    for (line_range(tile, &around, &line, &end); line < end; line++)
        if (is_open(&tile->open[line], &around, item->z1)) {
            set_outline(tile, item, poly);
            gnoi_tile_mark_thin(tile, tile->edges, tile->edge_count);
            gnoi_tile_mark_level(tile, tile->outline.x0, tile->outline.y0, tile->outline.x1, tile->outline.y1);
            return;
        }
}

static void draw_item(gnoi_tile *tile, gnoi_item *item, uint32_t index)
{
    const gnoi_poly *poly = &tile->job->scene->prepared.polys[index];
    uint32_t line, end;
    float bound = item->z1 + FLOAT_SLACK * fabsf(item->z1);
    if (!(item->x1 > 0) || !(item->x0 < (float)tile->width))
        return;
    if (item->thin && tile->judging)
        judge_thin(tile, item, poly);
    for (line_range(tile, item, &line, &end); line < end && !is_open(&tile->open[line], item, bound); line++)
        ;
    if (line == end)
        return;
    set_outline(tile, item, poly);
    if (tile->edge_count == 0)
        return;
    if (item->slot == GNOI_NONE)
        item->slot = new_slot(tile, index);
    if (item->slot == GNOI_NONE)
        return;
    bound = tile->lines.depths[item->slot].surely_before;
    for (; line < end && !item->see_through; line++)
        if (is_open(&tile->open[line], item, bound)) {
            draw_line(tile, line, item->slot, 0);
            set_bar(tile, line);
        }
    for (; line < end; line++)
        if (is_open(&tile->open[line], item, bound))
            draw_line(tile, line, item->slot, 1);
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

void gnoi_tile_draw(gnoi_tile *tile, const uint32_t *items, size_t count)
{
    size_t i = 0, end = tile->opaque_count;
    tile->veiled = 0;
    tile->failed |= !open_lines(tile);
    for (;;) {
        for (; i < end && !tile->failed; i++) {
            uint32_t item = tile->order[i].value;
            float z = tile->items[item].z1;
            if (i % COVER_STEP == 0 && is_covered(tile, z + ORDER_SLACK * fabsf(z)))
                break;
            draw_item(tile, &tile->items[item], items[item]);
            tile->failed |= i % 64 == 63 && gnoi_stopped(tile->lines.context);
        }
        i = end;
        tile->failed |= tile->lines.failed;
        if (end == count)
            break;
        end = count;
        gnoi_stacks_reset(&tile->stacks, &tile->lines);
        tile->failed |= tile->stacks.failed;
    }
    if (count > tile->opaque_count)
        finish_stacks(tile);
    tile->tinted = tile->veiled || (tile->job->tinted && tile->judging);
    tile->failed |= tile->lines.failed;
}
