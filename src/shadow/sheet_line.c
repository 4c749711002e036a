/* sheet_line.c -- how many far sides lie over each place of a sample line: see column.h, sheet.c.
 *
 * On a line the number of far sides overhead changes by one at each contour edge. It is known at one point of the receiver and carried from there
 * to the next line asked for: one up or down for each edge on the way; counted anew where an edge comes too near to tell. Between two
 * lines that the same edges cross in the same order, while no other begins or ends between them, it changes nowhere.
 */
#include "shadow/pair.h"

static void sort_steps(gnoi_step *s, size_t count)
{
    static const size_t gaps[] = {3280, 1093, 364, 121, 40, 13, 4, 1};
    for (size_t g = count < 5 ? 7 : 0; g < sizeof gaps / sizeof *gaps; g++)
        for (size_t i = gaps[g]; i < count; i++) {
            gnoi_step v = s[i];
            size_t k = i;
            for (; k >= gaps[g] && s[k - gaps[g]].x > v.x; k -= gaps[g])
                s[k] = s[k - gaps[g]];
            s[k] = v;
        }
}

/* Where line y crosses the edges, and how far up and down none of them begins or ends. */
static void cross_rims(const gnoi_columns *columns, const gnoi_row_list *list, double y, gnoi_crossed *c)
{
    double top = -HUGE_VAL, bottom = HUGE_VAL;
    size_t n = 0;
    for (uint32_t i = 0; i < list->count; i++) {
        const gnoi_rim *r = &columns->rims[gnoi_row_list_item(list, i)];
        const gnoi_edge *e = &r->edge;
        gnoi_step *step = &c->steps[n];
        const int below_begin = y >= e->y, below_end = y >= e->y1;
        const double above = below_end ? e->y1 : below_begin ? e->y : top, below = !below_begin ? e->y : !below_end ? e->y1 : bottom;
        top = above > top ? above : top;
        bottom = below < bottom ? below : bottom;
        if (!below_begin || below_end)
            continue;
        step->edge_x = e->x;
        step->edge_y = e->y;
        step->slope = e->slope;
        step->x = e->x + (y - e->y) * e->slope;
        step->step = r->step;
        n++;
    }
    sort_steps(c->steps, n);
    c->count = n;
    c->top = top;
    c->bottom = bottom;
}

/* The same for a line that the same edges cross; 0 where they do in another order. */
static int cross_again(gnoi_crossed *c, double y)
{
    double last = -HUGE_VAL;
    int ascend = 1;
    for (size_t i = 0; i < c->count; i++) {
        gnoi_step *s = &c->steps[i];
        s->x = s->edge_x + (y - s->edge_y) * s->slope;
        ascend &= s->x >= last;
        last = s->x;
    }
    if (!ascend)
        sort_steps(c->steps, c->count);
    return ascend;
}

/* The middle of the widest piece between crossings: the place to count at that rounding cannot put on the wrong side of one. */
static double widest_middle(const gnoi_crossed *c, double xa, double xb)
{
    double from = xa, widest = -1, middle = xa;
    for (size_t i = 0; i <= c->count; i++) {
        double to = i < c->count && c->steps[i].x < xb ? c->steps[i].x : xb;
        if (to - from > widest) {
            widest = to - from;
            middle = 0.5 * (from + to);
        }
        from = to > from ? to : from;
    }
    return middle;
}

/* ---- from one point to another -------------------------------------------------------------------------------------- */

/* In pixels: what passes no nearer passes on a certain side. */
#define CLEAR 1e-4

/* In pixels: more than the rounding of an edge's ends in single precision, wherever in a picture. */
#define BESIDE 0.0625

/* Contour edges that a path over several rows is held against; with more of them it is cheaper to count anew. */
#define MANY_RIMS 32

/* A straight path from p to q, and a box around it. */
typedef struct path {
    double px, py, qx, qy, dx, dy, clear;
    double x0, x1, y0, y1;
} path;

static path path_between(double px, double py, double qx, double qy)
{
    path w = {px, py, qx, qy, qx - px, qy - py, 0, 0, 0, 0, 0};
    w.clear = CLEAR * (fabs(w.dx) + fabs(w.dy));
    w.x0 = (px < qx ? px : qx) - BESIDE;
    w.x1 = (px < qx ? qx : px) + BESIDE;
    w.y0 = (py < qy ? py : qy) - CLEAR;
    w.y1 = (py < qy ? qy : py) + CLEAR;
    return w;
}

/* How many more far sides are over the path's end than over its beginning, as the contour edge between them has it; *sure is cleared where the
 * edge comes too near to tell. */
static inline int rim_change(const gnoi_rim *r, const path *w, int *sure)
{
    const gnoi_edge *e = &r->edge;
    int level = e->y == e->y1;
    double ax, bx, ex, ey, along, a, b, p, q;
    if (e->y > w->y1 || e->y1 < w->y0 || (double)r->x0 > w->x1 || (double)r->x1 < w->x0)
        return 0;
    ax = level ? (double)r->x0 : e->x;
    bx = level ? (double)r->x1 : e->x + (e->y1 - e->y) * e->slope;
    a = w->dx * (e->y - w->py) - w->dy * (ax - w->px);
    b = w->dx * (e->y1 - w->py) - w->dy * (bx - w->px);
    if ((a > w->clear && b > w->clear) || (a < -w->clear && b < -w->clear))
        return 0;
    ex = bx - ax;
    ey = e->y1 - e->y;
    along = CLEAR * (fabs(ex) + ey);
    p = ex * (w->py - e->y) - ey * (w->px - ax);
    q = ex * (w->qy - e->y) - ey * (w->qx - ax);
    if ((p > along && q > along) || (p < -along && q < -along))
        return 0;
    *sure &= !level && fabs(a) > w->clear && fabs(b) > w->clear && fabs(p) > along && fabs(q) > along;
    return q < 0 ? r->step : -r->step;
}

/* Carries what the column knows at one point straight to (x,y); 0 when that cannot be. Both are in the region, which is convex. */
static int carry(const gnoi_receiver *r, const gnoi_columns *columns, double x, double y, gnoi_column *column)
{
    const int row = gnoi_region_row(r, y), then = gnoi_region_row(r, column->at_y);
    const int near = row - then <= 1 && then - row <= 1;
    const path way = path_between(column->at_x, column->at_y, x, y);
    gnoi_row_list list = gnoi_row_list_of(columns, r, near ? column->rim_rows : GNOI_NONE, column->rim, column->rim_count, row);
    int sure = 1, change = 0;
    if (!near && column->rim_count > MANY_RIMS)
        return 0;
    for (uint32_t i = 0; i < list.count && sure; i++)
        change += rim_change(&columns->rims[gnoi_row_list_item(&list, i)], &way, &sure);
    if (list.items && then != row) {
        list = gnoi_row_list_of(columns, r, column->rim_rows, column->rim, column->rim_count, then);
        for (uint32_t i = 0; i < list.count && sure; i++) {
            const gnoi_rim *rim = &columns->rims[list.items[i]];
            if (gnoi_region_row(r, rim->edge.y) > row || gnoi_region_row(r, rim->edge.y1) < row) /* else it was in the other row's list */
                change += rim_change(rim, &way, &sure);
        }
    }
    column->count += change;
    return sure && column->count >= 0;
}

/* The number of far sides over the point of the receiver that is seen at (x,y). */
static int count_at(const gno_scene *scene, const gnoi_view *view, const gnoi_lamp *lamp, const gnoi_casters *casters,
                    const gnoi_receiver *r, double x, double y)
{
    gnoi_pair p;
    if (!gnoi_pair_make(&p, scene, view, lamp, r))
        return 0;
    return gnoi_sheet_count(&p, casters, gnoi_view_point(view, x, y, gnoi_plane_at(&r->nearness, x, y)));
}

/* Counts the far sides to the left of all crossings, by a point between xa and xb. */
static void count_left(const gno_scene *scene, const gnoi_view *view, const gnoi_lamp *lamp, const gnoi_casters *casters,
                       const gnoi_receiver *receiver, gnoi_column *column, double y, double xa, double xb, gnoi_columns *columns)
{
    gnoi_crossed *c = &columns->crossed;
    const double x = widest_middle(c, xa, xb);
    if (!column->known || !carry(receiver, columns, x, y, column))
        column->count = count_at(scene, view, lamp, casters, receiver, x, y);
    column->known = 1;
    column->at_x = x;
    column->at_y = y;
    c->left = column->count;
    for (size_t i = 0; i < c->count && c->steps[i].x <= x; i++)
        c->left -= c->steps[i].step;
}

/* ---- lines ---------------------------------------------------------------------------------------------------------- */

static int add_intervals(const gnoi_crossed *now, double xa, double xb, gnoi_columns *columns)
{
    double begin = -HUGE_VAL;
    int count = now->left;
    for (size_t i = 0; i <= now->count; i++) {
        double end = i < now->count ? now->steps[i].x : HUGE_VAL;
        if (count > 0 && begin < end && begin < xb && end > xa && !gnoi_interval_add(columns, begin, end, NULL))
            return 0;
        begin = end;
        if (i < now->count)
            count += now->steps[i].step;
    }
    return 1;
}

int gnoi_column_cross(const gno_scene *scene, const gnoi_view *view, const gnoi_lamp *lamp, const gnoi_casters *casters,
                      const gnoi_receiver *receiver, gnoi_column *column, double y, double xa, double xb, gnoi_columns *columns)
{
    const int row = gnoi_region_row(receiver, y);
    gnoi_crossed *c = &columns->crossed;
    int same = c->rim == column->rim && c->rim_count == column->rim_count && c->rim_count > 0 && c->row == row && y >= c->top && y < c->bottom;
    if (same) {
        same = cross_again(c, y);
    } else {
        const gnoi_row_list list = gnoi_row_list_of(columns, receiver, column->rim_rows, column->rim, column->rim_count, row);
        c->rim_count = 0;
        if (column->rim_count > c->capacity &&
            !gnoi_reserve(columns->context, (void **)&c->steps, &c->capacity, column->rim_count, sizeof *c->steps))
            return 0;
        cross_rims(columns, &list, y, c);
        c->rim = column->rim;
        c->rim_count = column->rim_count;
        c->row = row;
    }
    if (!same)
        count_left(scene, view, lamp, casters, receiver, column, y, xa, xb, columns);
    return 1;
}

int gnoi_sheet_intervals(const gno_scene *scene, const gnoi_view *view, const gnoi_lamp *lamp, const gnoi_casters *casters,
                         const gnoi_receiver *receiver, gnoi_column *column, double y, double xa, double xb, gnoi_columns *columns)
{
    return gnoi_column_cross(scene, view, lamp, casters, receiver, column, y, xa, xb, columns) &&
           add_intervals(&columns->crossed, xa, xb, columns);
}
