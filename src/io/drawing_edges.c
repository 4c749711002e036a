/* drawing_edges.c -- edges as lines, where they are visible: see drawing.h.
 *
 * Place in the data flow: the scene's polygons -> table of their edges, by ends -> outlines of visible pieces that run along an
 * edge of their polygon -> strokes. What hides an edge cuts the piece, so that the outline of a piece follows the edge just as far as
 * it is visible. A stroke is drawn once: an edge between two polygons in sight belongs to the lower number.
 * Two polygons share an edge when its ends are equal coordinate by coordinate.
 */
#include "io/drawing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* How far, in pixels, an outline may lie from the edge that it follows. */
#define NEAR 1e-3

/* Beyond its ends, as a share of the edge's length, an outline still follows it. */
#define PAST_END 1e-6

#define PI 3.14159265358979323846

/* An edge of a polygon: its ends in order, and which way the polygon runs along it. */
typedef struct edge {
    double a[3], b[3];
    double line[3]; /* through its ends in the picture: line[0] x + line[1] y + line[2] is the distance from it in pixels */
    size_t polygon;
    int forwards;
    gno_vector_edges kind; /* NONE: to be drawn with none, or by another polygon */
} edge;

/* What is known of a polygon. */
typedef struct facet {
    double normal[3];
    int seen;          /* has visible pieces, from this side: +1, -1; 0: none */
    size_t first_edge; /* into `of_polygon` */
} facet;

typedef struct edge_table {
    gnoi_drawing *drawing;
    gnoi_mesh_array edges;  /* edge, by ends */
    facet *facets;          /* one for each polygon, and one more */
    size_t facet_count;
    size_t *of_polygon;     /* edges by polygon */
    size_t of_polygon_count;
} edge_table;

/* ---- the table ---------------------------------------------------------------------------------------------------------- */

static int compare_points(const double *a, const double *b)
{
    for (int k = 0; k < 3; k++) {
        if (a[k] != b[k]) {
            return a[k] < b[k] ? -1 : 1;
        }
    }
    return 0;
}

static int compare_ends(const edge *e, const edge *f)
{
    const int order = compare_points(e->a, f->a);
    return order != 0 ? order : compare_points(e->b, f->b);
}

static int by_ends(const void *x, const void *y)
{
    const edge *e = x, *f = y;
    const int order = compare_ends(e, f);
    return order != 0 ? order : (e->polygon > f->polygon) - (e->polygon < f->polygon);
}

static void add_cross(double sum[3], const double *p, const double *q, const double *origin)
{
    double a[3], b[3];
    for (int k = 0; k < 3; k++) {
        a[k] = p[k] - origin[k];
        b[k] = q[k] - origin[k];
    }
    sum[0] += a[1] * b[2] - a[2] * b[1];
    sum[1] += a[2] * b[0] - a[0] * b[2];
    sum[2] += a[0] * b[1] - a[1] * b[0];
}

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Adds a polygon's edges and sets its normal (Newell) by the outer ring. */
static int add_polygon(edge_table *t, size_t number)
{
    gno_polygon p;
    facet *f = &t->facets[number];
    gno_scene_polygon(t->drawing->scene, number, &p);
    for (size_t r = 0; r < p.ring_count; r++) {
        const unsigned first = p.ring_start[r], count = p.ring_start[r + 1] - first;
        for (unsigned i = 0; i < count; i++) {
            const double *from = p.positions + 3 * p.corner_vertex[first + i];
            const double *to = p.positions + 3 * p.corner_vertex[first + (i + 1) % count];
            const int forwards = compare_points(from, to) < 0;
            edge e;
            memcpy(e.a, forwards ? from : to, sizeof e.a);
            memcpy(e.b, forwards ? to : from, sizeof e.b);
            e.polygon = number;
            e.forwards = forwards;
            e.kind = GNO_EDGES_NONE;
            if (r == 0) {
                add_cross(f->normal, from, to, p.positions + 3 * p.corner_vertex[first]);
            }
            if (compare_points(from, to) == 0) {
                continue;
            }
            if (!gnoi_mesh_array_room(t->drawing->context, &t->edges, 1, sizeof e)) {
                return 0;
            }
            ((edge *)t->edges.data)[t->edges.count++] = e;
        }
    }
    const double length = sqrt(dot(f->normal, f->normal));
    for (int k = 0; k < 3 && length > 0; k++) {
        f->normal[k] /= length;
    }
    return 1;
}

/* Whether the polygons of two entries for one edge lie on the same side of it as the eye sees them: one hides the other there. */
static int folds(const edge_table *t, const edge *e, const edge *f)
{
    /* The side seen of a polygon out of sight is known from its plane alone. */
    const int same_way = e->forwards == f->forwards, same_side = t->facets[e->polygon].seen == t->facets[f->polygon].seen;
    return same_way == same_side;
}

static int meets_flat(const edge_table *t, const edge *e, const edge *f)
{
    const double sign = e->forwards == f->forwards ? -1 : 1;
    const double c = sign * dot(t->facets[e->polygon].normal, t->facets[f->polygon].normal);
    return c >= cos(t->drawing->def->crease * PI / 180);
}

/* Settles what kind each of the entries of one edge is, and which of them draws it. */
static void settle(const edge_table *t, edge *e, size_t count)
{
    gno_vector_edges kind = GNO_EDGES_VISIBLE;
    if (count == 1 || (count == 2 && folds(t, &e[0], &e[1]))) {
        for (size_t i = 0; i < count; i++) {
            e[i].kind = GNO_EDGES_SILHOUETTE;
        }
        return;
    }
    if (count == 2 && meets_flat(t, &e[0], &e[1])) {
        kind = GNO_EDGES_ALL;
    }
    e[0].kind = kind;
    for (size_t i = 1; i < count && count > 2; i++) {
        e[i].kind = kind;
    }
}

/* Which side of each polygon the eye sees: that of its pieces, or by its plane. */
static gno_status see_sides(edge_table *t)
{
    const gno_camera camera = gno_scene_camera(t->drawing->scene);
    for (size_t i = 0; i < t->facet_count; i++) {
        gno_polygon p;
        double to_eye[3];
        const gno_status status = gno_scene_polygon(t->drawing->scene, i, &p);
        if (status != GNO_OK) {
            return status;
        }
        for (int k = 0; k < 3; k++) {
            to_eye[k] = camera.type == GNO_CAMERA_ORTHOGRAPHIC ? camera.eye[k] - camera.target[k]
                                                               : camera.eye[k] - p.positions[3 * p.corner_vertex[p.ring_start[0]] + k];
        }
        t->facets[i].seen = dot(to_eye, t->facets[i].normal) < 0 ? -1 : 1;
    }
    return GNO_OK;
}

static int list_by_polygon(edge_table *t)
{
    const edge *edges = t->edges.data;
    t->of_polygon_count = t->edges.count + 1;
    t->of_polygon = gno_context_realloc(t->drawing->context, NULL, 0, t->of_polygon_count * sizeof *t->of_polygon);
    if (t->of_polygon == NULL) {
        return 0;
    }
    for (size_t i = 0; i < t->edges.count; i++) {
        t->facets[edges[i].polygon].first_edge++;
    }
    for (size_t i = 0, sum = 0; i <= t->facet_count; i++) {
        sum += t->facets[i].first_edge;
        t->facets[i].first_edge = sum;
    }
    for (size_t i = t->edges.count; i-- > 0;) {
        t->of_polygon[--t->facets[edges[i].polygon].first_edge] = i;
    }
    return 1;
}

static void set_line(double l[3], const double *p, const double *q)
{
    l[0] = p[1] * q[2] - p[2] * q[1];
    l[1] = p[2] * q[0] - p[0] * q[2];
    l[2] = p[0] * q[1] - p[1] * q[0];
    const double length = sqrt(l[0] * l[0] + l[1] * l[1]);
    for (int k = 0; k < 3 && length > 0; k++) {
        l[k] /= length;
    }
}

/* The lines of all edges in the picture, a few hundred at a time: a projection looks at the whole camera first. */
static gno_status find_lines(edge_table *t)
{
    enum { AT_ONCE = 256 };
    double ends[AT_ONCE][6], picture[AT_ONCE][6];
    gno_status status = GNO_OK;
    for (size_t first = 0, n; first < t->edges.count && status == GNO_OK; first += n) {
        edge *e = (edge *)t->edges.data + first;
        for (n = 0; n < AT_ONCE && first + n < t->edges.count; n++) {
            memcpy(ends[n], e[n].a, sizeof e[n].a);
            memcpy(ends[n] + 3, e[n].b, sizeof e[n].b);
        }
        status = gno_project_points(t->drawing->scene, 2 * n, ends[0], picture[0]);
        for (size_t i = 0; i < n && status == GNO_OK; i++) {
            set_line(e[i].line, picture[i], picture[i] + 3);
        }
    }
    return status;
}

static gno_status fill_table(edge_table *t)
{
    for (size_t i = 0; i < t->facet_count; i++) {
        if (!add_polygon(t, i)) {
            return gnoi_drawing_no_memory(t->drawing);
        }
    }
    const gno_status status = see_sides(t);
    if (status != GNO_OK) {
        return status;
    }
    edge *edges = t->edges.data;
    if (t->edges.count > 1) {
        qsort(edges, t->edges.count, sizeof *edges, by_ends);
    }
    for (size_t i = 0, n; i < t->edges.count; i += n) {
        for (n = 1; i + n < t->edges.count && compare_ends(&edges[i], &edges[i + n]) == 0; n++) {
        }
        settle(t, edges + i, n);
    }
    return list_by_polygon(t) ? find_lines(t) : gnoi_drawing_no_memory(t->drawing);
}

/* ---- outlines ------------------------------------------------------------------------------------------------------------ */

/* Whether a scene point lies between the ends of an edge, along it. */
static int between(const edge *e, const double *point)
{
    double along = 0, whole = 0;
    for (int k = 0; k < 3; k++) {
        along += (point[k] - e->a[k]) * (e->b[k] - e->a[k]);
        whole += (e->b[k] - e->a[k]) * (e->b[k] - e->a[k]);
    }
    return along >= -PAST_END * whole && along <= (1 + PAST_END) * whole;
}

/* A ring at hand: what kind of edge each of its sides follows. */
typedef struct outline {
    gnoi_mesh_array kinds;  /* gno_vector_edges */
    gnoi_mesh_array places; /* double, homogeneous picture coordinates, 3 a point */
    gnoi_mesh_array dots;   /* gnoi_dot */
} outline;

static gno_status sort_sides(edge_table *t, outline *o, size_t polygon, const double *points, size_t count)
{
    gno_vector_edges *kinds = o->kinds.data;
    double *picture = o->places.data;
    const gno_status status = gno_project_points(t->drawing->scene, count, points, picture);
    for (size_t i = 0; i < count; i++) {
        kinds[i] = GNO_EDGES_ALL;
    }
    for (size_t k = t->facets[polygon].first_edge; k < t->facets[polygon + 1].first_edge && status == GNO_OK; k++) {
        const edge *e = (const edge *)t->edges.data + t->of_polygon[k];
        const double *l = e->line;
        for (size_t i = 0; i < count; i++) {
            const size_t j = (i + 1) % count;
            const double *p = picture + 3 * i, *q = picture + 3 * j;
            if (fabs(l[0] * p[0] + l[1] * p[1] + l[2] * p[2]) <= NEAR * p[2] && fabs(l[0] * q[0] + l[1] * q[1] + l[2] * q[2]) <= NEAR * q[2] &&
                between(e, points + 3 * i) && between(e, points + 3 * j)) {
                kinds[i] = e->kind;
            }
        }
    }
    return status;
}

static int add_stroke(gnoi_drawing *d, size_t polygon, gno_vector_edges kind, const gnoi_dot *dots, size_t count, size_t first, size_t sides)
{
    const int closed = sides == count;
    const size_t dot_count = closed ? count : sides + 1;
    const gnoi_stroke stroke = {polygon, kind, d->stroke_dots.count, dot_count, closed};
    if (!gnoi_mesh_array_room(d->context, &d->strokes, 1, sizeof stroke) ||
        !gnoi_mesh_array_room(d->context, &d->stroke_dots, dot_count, sizeof *dots)) {
        return 0;
    }
    for (size_t i = 0; i < dot_count; i++) {
        ((gnoi_dot *)d->stroke_dots.data)[d->stroke_dots.count++] = dots[(first + i) % count];
    }
    ((gnoi_stroke *)d->strokes.data)[d->strokes.count++] = stroke;
    return 1;
}

/* Sides of the picture's frame are nobody's edge. */
static int on_frame(const gnoi_drawing *d, gnoi_dot a, gnoi_dot b)
{
    const int64_t w = d->width * d->unit, h = d->height * d->unit;
    return (a.x == b.x && (a.x <= 0 || a.x >= w)) || (a.y == b.y && (a.y <= 0 || a.y >= h));
}

/* Strokes along a ring: sides of one kind that follow each other become one. */
static int stroke_ring(gnoi_drawing *d, const outline *o, size_t polygon, size_t count)
{
    gno_vector_edges *kinds = o->kinds.data;
    const gnoi_dot *dots = gnoi_dots(&o->dots);
    size_t first = 0;
    for (size_t i = 0; i < count; i++) {
        if (kinds[i] > d->def->edges || on_frame(d, dots[i], dots[(i + 1) % count])) {
            kinds[i] = GNO_EDGES_NONE;
        }
    }
    while (first < count && kinds[first] == kinds[(first + count - 1) % count]) {
        first++;
    }
    if (first == count) {
        return kinds[0] == GNO_EDGES_NONE || add_stroke(d, polygon, kinds[0], dots, count, 0, count);
    }
    for (size_t i = 0, n; i < count; i += n) {
        const gno_vector_edges kind = kinds[(first + i) % count];
        for (n = 1; i + n < count && kinds[(first + i + n) % count] == kind; n++) {
        }
        if (kind != GNO_EDGES_NONE && !add_stroke(d, polygon, kind, dots, count, first + i, n)) {
            return 0;
        }
    }
    return 1;
}

static gno_status follow_piece(edge_table *t, outline *o, const gno_piece *piece)
{
    gnoi_drawing *d = t->drawing;
    for (size_t r = 0; r < piece->ring_count; r++) {
        const double *points = piece->points + 3 * piece->ring_start[r];
        const size_t count = piece->ring_start[r + 1] - piece->ring_start[r];
        o->kinds.count = o->places.count = o->dots.count = 0;
        if (!gnoi_mesh_array_room(d->context, &o->kinds, count, sizeof(gno_vector_edges)) ||
            !gnoi_mesh_array_room(d->context, &o->places, 3 * count, sizeof(double)) ||
            !gnoi_mesh_array_room(d->context, &o->dots, count, sizeof(gnoi_dot))) {
            return gnoi_drawing_no_memory(d);
        }
        gno_status status = gnoi_drawing_dots(d, count, points, o->dots.data);
        if (status == GNO_OK) {
            status = sort_sides(t, o, piece->polygon, points, count);
        }
        if (status == GNO_OK && !stroke_ring(d, o, piece->polygon, count)) {
            status = gnoi_drawing_no_memory(d);
        }
        if (status != GNO_OK) {
            return status;
        }
    }
    return GNO_OK;
}

static gno_status follow_pieces(edge_table *t)
{
    gno_context *context = t->drawing->context;
    outline o;
    gno_status status = GNO_OK;
    memset(&o, 0, sizeof o);
    for (size_t i = 0; i < gno_pieces_count(t->drawing->pieces) && status == GNO_OK; i++) {
        gno_piece piece;
        gno_pieces_get(t->drawing->pieces, i, &piece);
        status = follow_piece(t, &o, &piece);
    }
    gnoi_mesh_array_free(context, &o.kinds, sizeof(gno_vector_edges));
    gnoi_mesh_array_free(context, &o.places, sizeof(double));
    gnoi_mesh_array_free(context, &o.dots, sizeof(gnoi_dot));
    return status;
}

gno_status gnoi_drawing_edges(gnoi_drawing *d)
{
    edge_table t;
    if (d->def->edges == GNO_EDGES_NONE) {
        return GNO_OK;
    }
    memset(&t, 0, sizeof t);
    t.drawing = d;
    t.facet_count = gno_scene_count(d->scene).polygons;
    const size_t bytes = (t.facet_count + 1) * sizeof *t.facets;
    t.facets = gno_context_realloc(d->context, NULL, 0, bytes);
    if (t.facets == NULL) {
        return gnoi_drawing_no_memory(d);
    }
    memset(t.facets, 0, bytes);
    gno_status status = fill_table(&t);
    if (status == GNO_OK) {
        status = follow_pieces(&t);
    }
    gnoi_mesh_array_free(d->context, &t.edges, sizeof(edge));
    gno_context_realloc(d->context, t.of_polygon, t.of_polygon_count * sizeof *t.of_polygon, 0);
    gno_context_realloc(d->context, t.facets, bytes, 0);
    return status;
}
