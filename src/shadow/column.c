/* column.c -- finding the casters of receivers: see column.h. */
#include "shadow/pair.h"
#include <stdlib.h>

/* A candidate is ruled out by an edge of the region when it stays outside of it by this share of the edge's length, far more than the
 * rounding of single precision. What comes nearer is tested exactly: a sliver left lit would be a leak. */
#define PROBE_SLACK -1e-6

/* So many receivers wait for each other, while the box around them is no larger than so many times the newest one's. */
#define REQUESTS 64
#define REQUEST_SPREAD 16.0f

/* Columns of so many casters or contour edges are sorted into rows. */
#define LONG_COLUMN 8

/* ---- region on the light's plane --------------------------------------------------------------------------------- */

/* Corners of the region on the receiver's plane; 0 when the plane's horizon passes through the region. */
static int region_corners(const gnoi_view *view, const gnoi_receiver *r, vec3 corners[4])
{
    double x[4], y[4], z[4], zmax = 0;
    for (int i = 0; i < 4; i++) {
        x[i] = i == 1 || i == 2 ? r->x1 : r->x0;
        y[i] = i >= 2 ? r->y1 : r->y0;
        z[i] = gnoi_plane_at(&r->nearness, x[i], y[i]);
        zmax = fabs(z[i]) > zmax ? fabs(z[i]) : zmax;
    }
    for (int i = 0; i < 4; i++) {
        if (!view->orthographic && !(z[i] > 1e-6 * zmax))
            return 0;
        corners[i] = gnoi_view_point(view, x[i], y[i], z[i]);
    }
    return 1;
}

static float min_f(float a, float b) { return a < b ? a : b; }
static float max_f(float a, float b) { return a > b ? a : b; }

/* Both boxes hold the receiver's region, so their common part does. */
static void box_intersect(gnoi_lbox *a, const gnoi_lbox *b)
{
    a->u0 = max_f(a->u0, b->u0);
    a->u1 = min_f(a->u1, b->u1);
    a->v0 = max_f(a->v0, b->v0);
    a->v1 = min_f(a->v1, b->v1);
    a->z1 = min_f(a->z1, b->z1);
}

/* The convex region's edges on the light's plane. */
static void set_probe_edges(gnoi_probe *probe, const gnoi_lpoint *p, int count)
{
    double area = 0;
    for (int i = 1; i + 1 < count; i++)
        area += (p[i].u - p[0].u) * (p[i + 1].v - p[0].v) - (p[i].v - p[0].v) * (p[i + 1].u - p[0].u);
    for (int i = 0; i < count; i++) {
        const gnoi_lpoint *a = &p[i], *b = &p[i + 1 < count ? i + 1 : 0];
        double s = area < 0 ? -1 : 1, du = (b->u - a->u) * s, dv = (b->v - a->v) * s;
        probe->a[i] = -dv;
        probe->b[i] = du;
        probe->c[i] = dv * a->u - du * a->v;
        probe->slack[i] = PROBE_SLACK * (du * du + dv * dv);
    }
    probe->edge_count = count;
}

/* The receiver's plane as nearness to the light over (u,v): from three of the points, when they span it. */
static int set_probe_plane(gnoi_probe *probe, const gnoi_pair *p, const gnoi_lpoint *l, int count)
{
    double lift = 0.5 * p->tolerance / p->lamp_height, best = 0;
    int k = 1;
    const gnoi_lpoint *a = &l[0], *b, *c;
    for (int i = 1; i + 1 < count; i++) {
        double area = fabs((l[i].u - a->u) * (l[i + 1].v - a->v) - (l[i].v - a->v) * (l[i + 1].u - a->u));
        if (area > best) {
            best = area;
            k = i;
        }
    }
    if (!(best > 0))
        return 0;
    b = &l[k];
    c = &l[k + 1];
    best = (b->u - a->u) * (c->v - a->v) - (b->v - a->v) * (c->u - a->u);
    probe->qa = ((b->q - a->q) * (c->v - a->v) - (b->v - a->v) * (c->q - a->q)) / best;
    probe->qb = ((b->u - a->u) * (c->q - a->q) - (b->q - a->q) * (c->u - a->u)) / best;
    probe->qc = a->q - probe->qa * a->u - probe->qb * a->v;
    /* Height t over the plane lifts nearness by t q / H (point lamp) or t / cosine. */
    probe->lift = p->lamp->directional ? lift : lift * a->q;
    probe->qc += probe->lift;
    return 1;
}

/* The point of the receiver's plane in the middle of a box on the light's plane. */
static vec3 point_below(const gnoi_pair *p, const gnoi_frame *frame, const gnoi_lbox *box)
{
    vec3 from, along;
    gnoi_frame_ray(frame, 0.5 * ((double)box->u0 + (double)box->u1), 0.5 * ((double)box->v0 + (double)box->v1), &from, &along);
    return v3_mad(from, along, -gnoi_form_at(&p->h, from) / v3_dot(p->h.a, along));
}

static vec3 mean_of(const vec3 *points, int count)
{
    vec3 sum = v3(0, 0, 0);
    for (int i = 0; i < count; i++)
        sum = v3_add(sum, points[i]);
    return v3_scale(sum, 1.0 / count);
}

/* Boxes of the region on the light's plane; *probed tells whether probe and centre may be used (one face only). */
static int region_boxes(const gnoi_pair *p, const gnoi_view *view, const gnoi_frame *frame, gnoi_lbox boxes[6], gnoi_probe *probe,
                        int *probed, vec3 *centre)
{
    const gnoi_receiver *r = p->receiver;
    vec3 hull[GNOI_FRAME_POINTS], corners[4];
    gnoi_lpoint located[GNOI_FRAME_POINTS];
    int hull_count = gnoi_poly_hull(p->scene, r->poly, hull), n;
    *probed = 0;
    if (r->whole) {
        if (!gnoi_frame_locate(frame, hull, hull_count, located))
            return gnoi_frame_boxes(frame, hull, hull_count, boxes);
        gnoi_frame_box(frame, located, hull_count, &boxes[0]);
        probe->edge_count = 0;
        if (p->triangle)
            set_probe_edges(probe, located, 3);
        *probed = set_probe_plane(probe, p, located, hull_count);
        *centre = mean_of(hull, 3);
        return 1;
    }
    if (!region_corners(view, r, corners))
        return gnoi_frame_boxes(frame, hull, hull_count, boxes);
    if (!gnoi_frame_locate(frame, corners, 4, located))
        return frame->faces == 6 ? gnoi_frame_boxes(frame, corners, 4, boxes) : gnoi_frame_boxes(frame, hull, hull_count, boxes);
    n = frame->faces == 1 ? gnoi_frame_boxes(frame, hull, hull_count, boxes) : 0;
    gnoi_lbox part;
    gnoi_frame_box(frame, located, 4, &part);
    set_probe_edges(probe, located, 4);
    *probed = set_probe_plane(probe, p, located, 4);
    if (n == 1)
        box_intersect(&boxes[0], &part);
    else
        boxes[0] = part;
    *centre = point_below(p, frame, &boxes[0]);
    return 1;
}

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
static void drop_repeats(gnoi_list *list)
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
    gnoi_pair p;
    gnoi_column *column;
    gnoi_lbox box;
    gnoi_probe probe;
    vec3 centre; /* a point of the region, on the receiver's plane */
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

static int settle(const gnoi_pair *p, gnoi_columns *columns, gnoi_column *column, int all)
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
    column->state = column->caster_count || column->sheet || p->lamp->spot ? GNOI_COLUMN_SPLIT : GNOI_COLUMN_LIT;
    return (column->caster_count < LONG_COLUMN ||
            sort_into_rows(p->receiver, columns, caster_rows, column->caster, column->caster_count, &column->rows)) &&
           (column->rim_count < LONG_COLUMN ||
            sort_into_rows(p->receiver, columns, rim_rows, column->rim, column->rim_count, &column->rim_rows));
}

/* One by one: single casters and far sides alike. */
static int settle_apart(const gnoi_pair *p, const gnoi_view *view, const gnoi_casters *casters, const gnoi_lbox *boxes, int count,
                        gnoi_columns *columns, gnoi_column *column)
{
    int all = 0;
    columns->found.count = 0;
    for (int i = 0; i < count; i++)
        if (!gnoi_tree_query(columns->context, &casters->single, NULL, &boxes[i], NULL, &columns->found) ||
            !gnoi_tree_query(columns->context, &casters->far, NULL, &boxes[i], NULL, &columns->found))
            return 0;
    if (count > 1)
        drop_repeats(&columns->found);
    return try_found(p, view, columns, &all) && settle(p, columns, column, all);
}

static int settle_request(const struct gnoi_request *r, const gnoi_view *view, const gnoi_casters *casters, gnoi_columns *columns)
{
    gno_context *context = columns->context;
    gnoi_sheet_state sheet;
    int all;
    r->column->caster = (uint32_t)columns->caster_count;
    r->column->rim = (uint32_t)columns->rim_count;
    sheet = gnoi_sheet_try(&r->p, casters, &r->box, &r->probe, r->centre, columns, r->column);
    all = sheet == GNOI_SHEET_ALL;
    columns->found.count = 0;
    if (sheet == GNOI_SHEET_NO_MEMORY ||
        (sheet == GNOI_SHEET_PIERCED &&
         !gnoi_tree_query(context, &casters->far, &columns->far_front, &r->box, &r->probe, &columns->found)) ||
        (!all && !gnoi_tree_query(context, &casters->single, &columns->single_front, &r->box, &r->probe, &columns->found)))
        return 0;
    return try_found(&r->p, view, columns, &all) && settle(&r->p, columns, r->column, all);
}

int gnoi_columns_finish(const gnoi_view *view, const gnoi_casters *casters, gnoi_columns *columns)
{
    if (columns->request_count == 0)
        return 1;
    if (!gnoi_tree_gather(columns->context, &casters->single, &columns->request_box, &columns->single_front) ||
        !gnoi_tree_gather(columns->context, &casters->far, &columns->request_box, &columns->far_front))
        return 0;
    columns->rim_gathered = 0;
    for (size_t i = 0; i < columns->request_count; i++)
        if (!settle_request(&columns->requests[i], view, casters, columns))
            return 0;
    columns->request_count = 0;
    return 1;
}

static float box_side(const gnoi_lbox *b) { return max_f(b->u1 - b->u0, b->v1 - b->v0); }

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

/* Lets a receiver wait with its neighbours, after sending off those that it is no neighbour of. */
static int wait_with_others(const gnoi_pair *p, const gnoi_view *view, const gnoi_casters *casters, const gnoi_lbox *box,
                            const gnoi_probe *probe, vec3 centre, gnoi_columns *columns, gnoi_column *column)
{
    struct gnoi_request *r;
    gnoi_lbox all = columns->request_count ? box_union(&columns->request_box, box) : *box;
    if (columns->request_count == REQUESTS || (columns->request_count && box_side(&all) > REQUEST_SPREAD * box_side(box))) {
        if (!gnoi_columns_finish(view, casters, columns))
            return 0;
        all = *box;
    }
    if (!gnoi_reserve(columns->context, (void **)&columns->requests, &columns->request_capacity, REQUESTS, sizeof *columns->requests))
        return 0;
    r = &columns->requests[columns->request_count++];
    r->p = *p;
    r->column = column;
    r->box = *box;
    r->probe = *probe;
    r->centre = centre;
    columns->request_box = all;
    return 1;
}

int gnoi_columns_ask(const gno_scene *scene, const gnoi_view *view, const gnoi_lamp *lamp, const gnoi_casters *casters,
                     const gnoi_receiver *receiver, gnoi_columns *columns, gnoi_column *column)
{
    gnoi_pair p;
    gnoi_lbox boxes[6];
    gnoi_probe probe;
    vec3 centre;
    int n, probed;
    columns->asked++;
    column->caster = (uint32_t)columns->caster_count;
    column->rim = (uint32_t)columns->rim_count;
    column->caster_count = column->rim_count = 0;
    column->sheet = 0;
    column->rows = column->rim_rows = GNOI_NONE;
    column->known = 0;
    column->state = GNOI_COLUMN_DARK;
    if (!gnoi_pair_make(&p, scene, view, lamp, receiver))
        return 1;
    n = region_boxes(&p, view, &casters->single.frame, boxes, &probe, &probed, &centre);
    if (n == 1 && probed)
        return wait_with_others(&p, view, casters, &boxes[0], &probe, centre, columns, column);
    return settle_apart(&p, view, casters, boxes, n, columns, column);
}

void gnoi_columns_reset(gnoi_columns *columns)
{
    columns->rows.count = 0;
    columns->request_count = 0;
    columns->caster_count = 0;
    columns->edge_count = 0;
    columns->rim_count = 0;
}

void gnoi_columns_free(gnoi_columns *columns)
{
    gnoi_free(columns->context, columns->casters, columns->caster_capacity, sizeof *columns->casters);
    gnoi_free(columns->context, columns->edges, columns->edge_capacity, sizeof *columns->edges);
    gnoi_free(columns->context, columns->found.items, columns->found.capacity, sizeof *columns->found.items);
    gnoi_free(columns->context, columns->requests, columns->request_capacity, sizeof *columns->requests);
    gnoi_free(columns->context, columns->single_front.nodes.items, columns->single_front.nodes.capacity,
              sizeof *columns->single_front.nodes.items);
    gnoi_free(columns->context, columns->far_front.nodes.items, columns->far_front.nodes.capacity, sizeof *columns->far_front.nodes.items);
    gnoi_free(columns->context, columns->rim_front.nodes.items, columns->rim_front.nodes.capacity, sizeof *columns->rim_front.nodes.items);
    gnoi_free(columns->context, columns->rims, columns->rim_capacity, sizeof *columns->rims);
    gnoi_free(columns->context, columns->steps, columns->step_capacity, sizeof *columns->steps);
    gnoi_free(columns->context, columns->rows.items, columns->rows.capacity, sizeof *columns->rows.items);
    gnoi_free(columns->context, columns->points, columns->point_capacity, sizeof *columns->points);
    gnoi_free(columns->context, columns->intervals, columns->interval_capacity, sizeof *columns->intervals);
    gnoi_free(columns->context, columns->sources, columns->source_capacity, sizeof *columns->sources);
    gnoi_free(columns->context, columns->crossings, columns->crossing_capacity, sizeof *columns->crossings);
}
