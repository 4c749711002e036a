/* column.c -- finding the casters of receivers: see column.h. */
#include "shadow/region.h"
#include <stdlib.h>

/* So many receivers wait for each other. */
#define REQUESTS 512

/* Columns of so many casters or contour edges are sorted into rows. */
#define LONG_COLUMN 8

/* ---- columns ------------------------------------------------------------------------------------------------------ */

static int seen_before(const gnoi_list *list, size_t i)
{
    for (size_t k = 0; k < i; k++)
        if (list->items[k] == list->items[i])
            return 1;
    return 0;
}

static int compare_numbers(const void *a, const void *b)
{
    uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

/* A receiver on several faces may be given a caster once for each. */
void gnoi_list_drop_repeats(gnoi_list *list)
{
    size_t n = 0;
    if (list->count > 16) {
        qsort(list->items, list->count, sizeof *list->items, compare_numbers);
        for (size_t i = 0; i < list->count; i++)
            if (i == 0 || list->items[i] != list->items[i - 1])
                list->items[n++] = list->items[i];
    } else {
        for (size_t i = 0; i < list->count; i++)
            if (!seen_before(list, i))
                list->items[n++] = list->items[i];
    }
    list->count = n;
}

struct gnoi_request {
    const gnoi_receiver *receiver;
    gnoi_column *column;
    gnoi_lbox box;
};

/* Rows of the receiver's region that a caster or a contour edge may cross. */
typedef void row_range(const gnoi_receiver *r, const gnoi_columns *columns, uint32_t item, int *first, int *last);

static void caster_rows(const gnoi_receiver *r, const gnoi_columns *columns, uint32_t item, int *first, int *last)
{
    *first = gnoi_region_row(r, (double)columns->casters[item].y0);
    *last = gnoi_region_row(r, (double)columns->casters[item].y1);
}

static void rim_rows(const gnoi_receiver *r, const gnoi_columns *columns, uint32_t item, int *first, int *last)
{
    *first = gnoi_region_row(r, columns->rims[item].edge.y);
    *last = gnoi_region_row(r, columns->rims[item].edge.y1);
}

/* Lists a long column's items by the rows that they may cross, so that a line looks at those of its row only. */
static int sort_into_rows(const gnoi_receiver *r, gnoi_columns *columns, row_range *range, uint32_t item, uint32_t count, uint32_t *list)
{
    size_t rows = (size_t)r->rows, need = rows + 1;
    uint32_t *start;
    int first, last;
    for (uint32_t i = item; i < item + count; i++) {
        range(r, columns, i, &first, &last);
        need += (size_t)(last - first + 1);
    }
    if (!gnoi_reserve(columns->context, (void **)&columns->rows.items, &columns->rows.capacity, columns->rows.count + need,
                      sizeof *columns->rows.items))
        return 0;
    *list = (uint32_t)columns->rows.count;
    start = columns->rows.items + *list;
    for (size_t k = 0; k <= rows; k++)
        start[k] = 0;
    for (uint32_t i = item; i < item + count; i++) {
        range(r, columns, i, &first, &last);
        for (int k = first; k <= last; k++)
            start[k]++;
    }
    for (size_t k = 1; k < rows; k++)
        start[k] += start[k - 1];
    start[rows] = start[rows - 1]; /* ends so far: filling from the back turns them into beginnings */
    for (uint32_t i = item + count; i-- > item;) {
        range(r, columns, i, &first, &last);
        for (int k = first; k <= last; k++)
            start[rows + 1 + --start[k]] = i;
    }
    columns->rows.count += need;
    return 1;
}

/* Tests all candidates in columns->found; *all when one darkens the whole region. Returns 0 when memory fails. */
static int try_found(const gnoi_pair *p, const gnoi_view *view, gnoi_columns *columns, int *all)
{
    for (size_t i = 0; i < columns->found.count && !*all; i++) {
        uint32_t c = columns->found.items[i];
        gnoi_found f = c == p->receiver->index ? GNOI_FOUND_NOTHING : gnoi_pair_try(p, view, c, columns);
        if (f == GNOI_FOUND_NO_MEMORY)
            return 0;
        *all |= f == GNOI_FOUND_ALL;
    }
    return 1;
}

static int settle(const gnoi_receiver *receiver, const gnoi_lamp *lamp, gnoi_columns *columns, gnoi_column *column, int all)
{
    if (all) {
        columns->full++;
        columns->ones++;
        columns->caster_count = column->caster;
        columns->rim_count = column->rim;
        column->rim_count = 0;
        column->sheet = 0;
        return 1;
    }
    column->caster_count = (uint32_t)(columns->caster_count - column->caster);
    columns->ones += column->caster_count + column->rim_count;
    column->state = column->caster_count || column->sheet || lamp->spot ? GNOI_COLUMN_SPLIT : GNOI_COLUMN_LIT;
    return (column->caster_count < LONG_COLUMN ||
            sort_into_rows(receiver, columns, caster_rows, column->caster, column->caster_count, &column->rows)) &&
           (column->rim_count < LONG_COLUMN ||
            sort_into_rows(receiver, columns, rim_rows, column->rim, column->rim_count, &column->rim_rows));
}

/* By the boxes of a region in parts. */
static int settle_apart(const gnoi_pair *p, const gnoi_view *view, const gnoi_casters *casters, const gnoi_lbox *boxes, int count,
                        gnoi_columns *columns, gnoi_column *column)
{
    gnoi_near *near = columns->near;
    gnoi_sheet_state sheet = gnoi_sheet_try_apart(p, casters, boxes, count, columns, column);
    int all = 0;
    columns->near = near;
    columns->found.count = 0;
    if (sheet == GNOI_SHEET_NO_MEMORY)
        return 0;
    for (int i = 0; i < count; i++)
        if (!gnoi_tree_query(columns->context, &casters->single, &boxes[i], NULL, &columns->found) ||
            (sheet == GNOI_SHEET_PIERCED && !gnoi_tree_query(columns->context, &casters->far, &boxes[i], NULL, &columns->found)))
            return 0;
    if (count > 1)
        gnoi_list_drop_repeats(&columns->found);
    return try_found(p, view, columns, &all) && settle(p->receiver, p->lamp, columns, column, all);
}

/* More nodes of single casters than these are not looked at one by one. */
#define FEW_SINGLE 2

/* Gathers for the waiting receivers in part->box what was gathered for more of them (NULL: from the trees). fine: what they
 * can be asked about one by one. */
static int gather(const gno_scene *scene, const gnoi_casters *casters, const gnoi_near *whole, gnoi_near *part, int fine)
{
    gnoi_grain grain = {fine ? -1 : gnoi_box_side(&part->box), 1}, all = {grain.side, 0};
    if (!gnoi_gather(scene->context, &casters->single, whole ? &whole->single : NULL, &part->box, all, &part->single) ||
        !gnoi_gather(scene->context, &casters->far, whole ? &whole->far : NULL, &part->box, grain, &part->far))
        return 0;
    part->rims = 0;
    part->whole = whole;
    part->fine = fine;
    if (part->single.count <= FEW_SINGLE)
        gnoi_gathered_drop_behind(scene, &part->box, &part->single);
    return 1;
}

/* What is known of how the far sides lie over every receiver of a group: nothing where it is PART. */
static int look_at_group(const struct gnoi_request *r, const gnoi_view *view, const gnoi_casters *casters, gnoi_columns *columns,
                         gnoi_sheet_state *state)
{
    gnoi_near *near = columns->near;
    gnoi_region region;
    gnoi_lbox boxes[6];
    int box_count;
    gnoi_pair p;
    *state = GNOI_SHEET_NOWHERE;
    if (near->far.count == 0)
        return 1;
    *state = GNOI_SHEET_PART;
    if (near->far.level > 0 || gnoi_frame_face(&casters->far.frame, (double)near->box.u0) != gnoi_frame_face(&casters->far.frame, (double)near->box.u1))
        return 1;
    if (!gnoi_sheet_gather_rims(casters, columns))
        return 0;
    if (near->rim.count > 0 || !gnoi_pair_make(&p, columns->scene, view, columns->lamp, r->receiver) ||
        !gnoi_region_make(columns->scene, view, &casters->far.frame, r->receiver, &region, boxes, &box_count))
        return 1;
    *state = gnoi_sheet_at(&p, casters, gnoi_region_centre(&p, &casters->far.frame, &region));
    return 1;
}

/* One receiver for itself. */
static int settle_request(const struct gnoi_request *r, const gnoi_view *view, const gnoi_casters *casters, gnoi_sheet_state sheet,
                          gnoi_columns *columns)
{
    gno_context *context = columns->context;
    gnoi_region region;
    gnoi_lbox boxes[6];
    gnoi_pair p;
    gnoi_probe probe;
    int box_count, all;
    if (!gnoi_pair_make(&p, columns->scene, view, columns->lamp, r->receiver))
        return 1;
    if (!gnoi_region_make(columns->scene, view, &casters->far.frame, r->receiver, &region, boxes, &box_count) ||
        !gnoi_region_probe(&p, &region, &probe))
        return settle_apart(&p, view, casters, &r->box, 1, columns, r->column);
    if (sheet == GNOI_SHEET_PART)
        sheet = gnoi_sheet_try(&p, casters, &region, &probe, columns, r->column);
    all = sheet == GNOI_SHEET_ALL;
    columns->found.count = 0;
    if (sheet == GNOI_SHEET_NO_MEMORY ||
        (sheet == GNOI_SHEET_PIERCED && !gnoi_tree_query(context, &casters->far, &region.box, NULL, &columns->found)) ||
        (!all && !gnoi_gathered_query(context, &columns->near->single, &region.box, &probe, &columns->found, NULL)))
        return 0;
    return try_found(&p, view, columns, &all) && settle(r->receiver, columns->lamp, columns, r->column, all);
}

static float min_f(float a, float b) { return a < b ? a : b; }
static float max_f(float a, float b) { return a > b ? a : b; }
static gnoi_lbox box_union(const gnoi_lbox *a, const gnoi_lbox *b)
{
    gnoi_lbox r;
    r.u0 = min_f(a->u0, b->u0);
    r.u1 = max_f(a->u1, b->u1);
    r.v0 = min_f(a->v0, b->v0);
    r.v1 = max_f(a->v1, b->v1);
    r.z0 = min_f(a->z0, b->z0);
    r.z1 = max_f(a->z1, b->z1);
    return r;
}

/* A group of up to so many receivers is not halved: near far sides, and where there are single casters alone, among which few groups are
 * without any. */
#define SMALL_GROUP 4
#define SMALL_SINGLE_GROUP 16

static gnoi_lbox box_of(const gnoi_columns *columns, const uint16_t *group, size_t count)
{
    gnoi_lbox box = columns->requests[group[0]].box;
    for (size_t i = 1; i < count; i++)
        box = box_union(&box, &columns->requests[group[i]].box);
    return box;
}

/* Puts those with their middle in the lower half of the longer side first; returns how many. */
static size_t halve(const gnoi_columns *columns, const gnoi_lbox *box, uint16_t *group, size_t count)
{
    int upright = box->v1 - box->v0 > box->u1 - box->u0;
    float middle = upright ? box->v0 + box->v1 : box->u0 + box->u1;
    size_t n = 0;
    for (size_t i = 0; i < count; i++) {
        const gnoi_lbox *b = &columns->requests[group[i]].box;
        if ((upright ? b->v0 + b->v1 : b->u0 + b->u1) < middle) {
            uint16_t swap = group[n];
            group[n++] = group[i];
            group[i] = swap;
        }
    }
    return n > 0 && n < count ? n : count / 2;
}

static int settle_group(const gnoi_view *view, const gnoi_casters *casters, gnoi_columns *columns, uint16_t *group, size_t count);

static int settle_halves(const gnoi_view *view, const gnoi_casters *casters, gnoi_columns *columns, uint16_t *group, size_t count)
{
    gnoi_near *near = columns->near;
    size_t first = 0, half = halve(columns, &near->box, group, count);
    int good = 1;
    for (int k = 0; k < 2 && good; k++) {
        near[1].box = box_of(columns, group + first, half);
        good = gather(columns->scene, casters, near, near + 1, 0);
        columns->near = near + 1;
        good = good && settle_group(view, casters, columns, group + first, half);
        columns->near = near;
        first = half;
        half = count - half;
    }
    return good;
}

/* Settles the requests whose numbers are in `group`; what is near them is in columns->near. */
static int settle_group(const gnoi_view *view, const gnoi_casters *casters, gnoi_columns *columns, uint16_t *group, size_t count)
{
    gnoi_near *near = columns->near;
    gnoi_sheet_state state;
    int good = look_at_group(&columns->requests[group[0]], view, casters, columns, &state);
    int alike = state == GNOI_SHEET_ALL || (state == GNOI_SHEET_NOWHERE && near->single.count == 0);
    if (good && !alike && count > (state == GNOI_SHEET_NOWHERE ? SMALL_SINGLE_GROUP : SMALL_GROUP) && near < columns->nears + GNOI_NEAR_DEPTH - 2)
        return settle_halves(view, casters, columns, group, count);
    if (good && !alike) {
        near[1].box = near->box;
        columns->near = near + 1;
        good = gather(columns->scene, casters, near, near + 1, 1) && look_at_group(&columns->requests[group[0]], view, casters, columns, &state);
        alike = state == GNOI_SHEET_ALL || (state == GNOI_SHEET_NOWHERE && columns->near->single.count == 0);
    }
    for (size_t i = 0; i < count && good; i++) {
        const struct gnoi_request *r = &columns->requests[group[i]];
        r->column->caster = (uint32_t)columns->caster_count;
        r->column->rim = (uint32_t)columns->rim_count;
        good = alike ? settle(r->receiver, columns->lamp, columns, r->column, state == GNOI_SHEET_ALL)
                     : settle_request(r, view, casters, state, columns);
    }
    columns->near = near;
    return good;
}

int gnoi_columns_finish(const gnoi_view *view, const gnoi_casters *casters, gnoi_columns *columns)
{
    uint16_t group[REQUESTS];
    size_t count = columns->request_count;
    columns->request_count = 0;
    if (count == 0)
        return 1;
    for (size_t i = 0; i < count; i++)
        group[i] = (uint16_t)i;
    columns->near = columns->nears;
    columns->near->box = box_of(columns, group, count);
    return gather(columns->scene, casters, NULL, columns->near, 0) && settle_group(view, casters, columns, group, count);
}

/* The box of the receiver's region on the light's plane; 0: it has the *box_count boxes instead. */
static int bound_receiver(const gno_scene *scene, const gnoi_view *view, const gnoi_casters *casters, const gnoi_receiver *receiver,
                          gnoi_lbox *box, gnoi_lbox boxes[6], int *box_count)
{
    const gnoi_prepared *prep = &scene->prepared;
    const gnoi_poly *poly = receiver->poly;
    gnoi_region region;
    if (casters->located && receiver->whole && poly->ring_count == 1 &&
        gnoi_located_box(&casters->single.frame, casters->located, prep->corner_vertex + poly->corner, poly->corner_count, box))
        return 1;
    if (!gnoi_region_make(scene, view, &casters->single.frame, receiver, &region, boxes, box_count))
        return 0;
    *box = region.box;
    return 1;
}

int gnoi_columns_ask(const gno_scene *scene, const gnoi_view *view, const gnoi_lamp *lamp, const gnoi_casters *casters,
                     const gnoi_receiver *receiver, gnoi_columns *columns, gnoi_column *column)
{
    struct gnoi_request *r;
    gnoi_lbox box, boxes[6];
    gnoi_pair p;
    int box_count;
    columns->asked++;
    column->caster = (uint32_t)columns->caster_count;
    column->rim = (uint32_t)columns->rim_count;
    column->caster_count = column->rim_count = 0;
    column->sheet = 0;
    column->rows = column->rim_rows = GNOI_NONE;
    column->known = 0;
    column->state = GNOI_COLUMN_DARK;
    columns->scene = scene;
    columns->lamp = lamp;
    if (!(gnoi_lamp_side(lamp, receiver->poly->n, receiver->poly->d) * receiver->side > 0))
        return 1;
    if (!bound_receiver(scene, view, casters, receiver, &box, boxes, &box_count))
        return !gnoi_pair_make(&p, scene, view, lamp, receiver) || settle_apart(&p, view, casters, boxes, box_count, columns, column);
    if (!gnoi_reserve(columns->context, (void **)&columns->requests, &columns->request_capacity, REQUESTS, sizeof *columns->requests) ||
        (columns->request_count == REQUESTS && !gnoi_columns_finish(view, casters, columns)))
        return 0;
    r = &columns->requests[columns->request_count++];
    r->receiver = receiver;
    r->column = column;
    r->box = box;
    return 1;
}

void gnoi_columns_reset(gnoi_columns *columns)
{
    columns->rows.count = 0;
    columns->request_count = 0;
    columns->caster_count = 0;
    columns->edge_count = 0;
    columns->rim_count = 0;
    columns->crossed.rim_count = 0;
}

void gnoi_columns_free(gnoi_columns *columns)
{
    gnoi_free(columns->context, columns->casters, columns->caster_capacity, sizeof *columns->casters);
    gnoi_free(columns->context, columns->edges, columns->edge_capacity, sizeof *columns->edges);
    gnoi_free(columns->context, columns->found.items, columns->found.capacity, sizeof *columns->found.items);
    gnoi_free(columns->context, columns->requests, columns->request_capacity, sizeof *columns->requests);
    for (int i = 0; i <= GNOI_NEAR_DEPTH; i++) {
        gnoi_gathered_free(columns->context, &columns->nears[i].single);
        gnoi_gathered_free(columns->context, &columns->nears[i].far);
        gnoi_gathered_free(columns->context, &columns->nears[i].rim);
    }
    gnoi_free(columns->context, columns->rims, columns->rim_capacity, sizeof *columns->rims);
    gnoi_free(columns->context, columns->crossed.steps, columns->crossed.capacity, sizeof *columns->crossed.steps);
    gnoi_free(columns->context, columns->rows.items, columns->rows.capacity, sizeof *columns->rows.items);
    gnoi_free(columns->context, columns->points, columns->point_capacity, sizeof *columns->points);
    gnoi_free(columns->context, columns->intervals, columns->interval_capacity, sizeof *columns->intervals);
    gnoi_free(columns->context, columns->sources, columns->source_capacity, sizeof *columns->sources);
    gnoi_free(columns->context, columns->crossings, columns->crossing_capacity, sizeof *columns->crossings);
}
