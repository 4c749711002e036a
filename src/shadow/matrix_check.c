/* matrix_check.c -- which ones of a shadow matrix cast no shadow at all.
 *
 * Place in the data flow: a finished matrix -> every one of it again, by areas instead of separating planes: the caster is cut at the
 * receiver's plane and just below the light, thrown on the plane along the light's rays, and cut with the receiver there; what is left
 * has an area or none. Polygons that are not convex come as triangles. Only the shape of the caster's parts is shared with overlap.c.
 */
#include "scene/validate.h"
#include "shadow/lamp.h"
#include "shadow/matrix.h"
#include "scene/prepare.h"

#include <string.h>

#define LIGHT_GAP 1e-9    /* share of the light's height that is cut off below it */
#define NO_AREA 1e-9      /* share of the receiver's area */
#define MOST_CORNERS (2 * GNOI_FACET_CORNERS + 4)

typedef struct point2 {
    double x, y;
} point2;

typedef struct ring2 {
    int count;
    point2 p[2 * MOST_CORNERS];
} ring2;

/* The receiver's plane as a coordinate system, and the lamp. */
typedef struct ground {
    const gnoi_lamp *lamp;
    vec3 n, origin, e1, e2;
    double d, lamp_height;
} ground;

static ground ground_make(const gno_scene *scene, const gnoi_lamp *lamp, const gnoi_poly *poly)
{
    double side = gnoi_lamp_side(lamp, poly->n, poly->d), sign = side < 0 ? -1 : 1;
    ground g;
    g.lamp = lamp;
    g.n = v3_scale(v3_from(poly->n), sign);
    g.d = poly->d * sign;
    g.lamp_height = side * sign;
    g.origin = v3_from(scene->prepared.positions[scene->prepared.corner_vertex[poly->corner]]);
    g.e1 = v3_unit(v3_cross(g.n, fabs(g.n.x) < 0.6 ? v3(1, 0, 0) : v3(0, 1, 0)));
    g.e2 = v3_cross(g.n, g.e1);
    return g;
}

static point2 flatten(const ground *g, vec3 p)
{
    point2 q;
    p = v3_sub(p, g->origin);
    q.x = v3_dot(p, g->e1);
    q.y = v3_dot(p, g->e2);
    return q;
}

static double height(const ground *g, vec3 p) { return v3_dot(g->n, p) + g->d; }

static point2 throw_on(const ground *g, vec3 p)
{
    double h = height(g, p);
    if (g->lamp->directional)
        return flatten(g, v3_mad(p, g->lamp->to_light, -h / g->lamp_height));
    return flatten(g, v3_mad(p, v3_sub(p, g->lamp->position), h / (g->lamp_height - h)));
}

/* Keeps what lies above (sign 1) or below (-1) the level. */
static int cut_level(const ground *g, const vec3 *in, int count, double level, double sign, vec3 *out)
{
    int n = 0;
    for (int i = 0; i < count; i++) {
        vec3 a = in[i], b = in[i + 1 < count ? i + 1 : 0];
        double sa = sign * (height(g, a) - level), sb = sign * (height(g, b) - level);
        if (sa >= 0)
            out[n++] = a;
        if ((sa > 0 && sb < 0) || (sa < 0 && sb > 0))
            out[n++] = v3_mad(a, v3_sub(b, a), sa / (sa - sb));
    }
    return n;
}

static double turn(point2 a, point2 b, point2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

static double area_of(const ring2 *r)
{
    double area = 0;
    for (int i = 1; i + 1 < r->count; i++)
        area += 0.5 * turn(r->p[0], r->p[i], r->p[i + 1]);
    return area;
}

static void cut_edge(const ring2 *in, point2 from, point2 to, double sign, ring2 *out)
{
    out->count = 0;
    for (int i = 0; i < in->count && out->count + 2 <= 2 * MOST_CORNERS; i++) {
        point2 a = in->p[i], b = in->p[i + 1 < in->count ? i + 1 : 0];
        double sa = sign * turn(from, to, a), sb = sign * turn(from, to, b);
        if (sa >= 0)
            out->p[out->count++] = a;
        if ((sa > 0 && sb < 0) || (sa < 0 && sb > 0)) {
            double t = sa / (sa - sb);
            out->p[out->count].x = a.x + t * (b.x - a.x);
            out->p[out->count++].y = a.y + t * (b.y - a.y);
        }
    }
}

/* Area of the shadow that one convex part throws on another. */
static double shadow_area(const ground *g, const gnoi_facet *receiver, const gnoi_facet *caster)
{
    vec3 above[2 * MOST_CORNERS], below[2 * MOST_CORNERS];
    ring2 region, ring[2];
    int now = 0, n = cut_level(g, caster->corner, caster->count, 0, 1, above);
    double sign;
    memcpy(below, above, (size_t)n * sizeof *above);
    if (!g->lamp->directional)
        n = cut_level(g, above, n, g->lamp_height * (1 - LIGHT_GAP), -1, below);
    ring[0].count = n;
    for (int i = 0; i < n; i++)
        ring[0].p[i] = throw_on(g, below[i]);
    region.count = receiver->count;
    for (int i = 0; i < receiver->count; i++)
        region.p[i] = flatten(g, receiver->corner[i]);
    sign = area_of(&region) < 0 ? -1 : 1;
    for (int i = 0; i < region.count && ring[now].count > 0; i++, now = !now)
        cut_edge(&ring[now], region.p[i], region.p[i + 1 < region.count ? i + 1 : 0], sign, &ring[!now]);
    return fabs(area_of(&ring[now]));
}

/* ---- one column ---------------------------------------------------------------------------------------------------- */

/* Who judges: the lamps of the light, and the receiver at hand. */
typedef struct judge {
    const gno_scene *scene;
    gnoi_facets facets;
    size_t lamp_count;
    gnoi_lamp *lamps;
    ground *grounds; /* the receiver before each lamp */
    const gnoi_poly *receiver;
    double area;     /* of the receiver */
} judge;

static void set_receiver(judge *j, const gnoi_poly *receiver)
{
    gnoi_facet part;
    j->receiver = receiver;
    j->area = 0;
    for (size_t i = 0; i < j->lamp_count; i++)
        j->grounds[i] = ground_make(j->scene, &j->lamps[i], receiver);
    for (size_t i = 0; gnoi_facet_get(&j->facets, j->scene, receiver, i, &part); i++) {
        ring2 flat;
        flat.count = part.count;
        for (int k = 0; k < part.count; k++)
            flat.p[k] = flatten(&j->grounds[0], part.corner[k]);
        j->area += fabs(area_of(&flat));
    }
}

/* The sum over all parts of both, cut short when it is more than enough. */
static int casts_shadow(const judge *j, const ground *g, const gnoi_poly *caster)
{
    gnoi_facet a, b;
    double area = 0;
    for (size_t i = 0; gnoi_facet_get(&j->facets, j->scene, j->receiver, i, &a); i++)
        for (size_t k = 0; gnoi_facet_get(&j->facets, j->scene, caster, k, &b); k++) {
            area += shadow_area(g, &a, &b);
            if (area > NO_AREA * j->area)
                return 1;
        }
    return 0;
}

/* Polygons that are not planar, and so are several prepared ones, are passed by. start, polys: of gnoi_polys_by_source. */
static gno_status judge_column(judge *j, const uint32_t *start, const uint32_t *polys, const gno_matrix_column *column,
                               gno_matrix_check_result *result)
{
    const gnoi_prepared *prep = &j->scene->prepared;
    size_t r = column->receiver;
    if (column->count == 0 || start[r + 1] - start[r] != 1)
        return GNO_OK;
    set_receiver(j, &prep->polys[polys[start[r]]]);
    for (size_t i = 0; i < column->count; i++) {
        uint32_t c = column->casters[i];
        int real = 0;
        if (c == r || start[c + 1] - start[c] != 1)
            continue;
        for (size_t k = 0; k < j->lamp_count && !real; k++)
            real = casts_shadow(j, &j->grounds[k], &prep->polys[polys[start[c]]]);
        result->judged++;
        result->false_ones += !real;
        if (gnoi_stopped(j->scene->context))
            return GNO_ERROR_MEMORY;
    }
    return GNO_OK;
}

/* ---- all ---------------------------------------------------------------------------------------------------------- */

static gno_status judge_all(judge *j, gno_matrix *matrix, gno_matrix_check_result *result)
{
    const gno_scene *scene = j->scene;
    uint32_t *start = NULL, *polys = NULL;
    gno_status status = gnoi_polys_by_source(scene, &start, &polys) ? GNO_OK : GNO_ERROR_MEMORY;
    for (size_t s = 0; s < matrix->size && !status; s++) {
        gno_matrix_column column;
        gnoi_set_fraction(scene->context, (double)s / (double)matrix->size);
        status = gno_matrix_get_column(matrix, s, &column);
        if (!status)
            status = judge_column(j, start, polys, &column, result);
    }
    gnoi_free(scene->context, start, scene->polygon_count + 1, sizeof *start);
    gnoi_free(scene->context, polys, scene->prepared.poly_count, sizeof *polys);
    return status;
}

static gno_status check_light(gno_scene *scene, const gno_light *light, gno_matrix *matrix, gno_matrix_check_result *result)
{
    judge j;
    gno_status status;
    memset(&j, 0, sizeof j);
    j.scene = scene;
    j.lamp_count = gnoi_light_points(light);
    j.lamps = gnoi_malloc(scene->context, j.lamp_count, sizeof *j.lamps);
    j.grounds = gnoi_malloc(scene->context, j.lamp_count, sizeof *j.grounds);
    status = j.lamps && j.grounds ? gnoi_facets_build(scene, &j.facets) : GNO_ERROR_MEMORY;
    if (!status) {
        gnoi_lamps_of(light, j.lamps);
        status = judge_all(&j, matrix, result);
        gnoi_facets_free(scene->context, &j.facets);
    }
    gnoi_free(scene->context, j.lamps, j.lamp_count, sizeof *j.lamps);
    gnoi_free(scene->context, j.grounds, j.lamp_count, sizeof *j.grounds);
    return status;
}

gno_status gno_matrix_check(gno_scene *scene, int light, gno_matrix *matrix, gno_matrix_check_result *result)
{
    gno_status status;
    if (!scene)
        return GNO_ERROR_ARGUMENT;
    if (!matrix || !result)
        return gnoi_fail(scene->context, GNO_ERROR_ARGUMENT, "gno_matrix_check: matrix or result is NULL");
    if (light < 0 || (size_t)light >= scene->light_count || matrix->size != scene->polygon_count)
        return gnoi_fail(scene->context, GNO_ERROR_ARGUMENT, "gno_matrix_check: the matrix is not that of light %d of the scene", light);
    result->judged = result->false_ones = 0;
    gnoi_begin(scene->context, "checking");
    status = gnoi_scene_prepare(scene, 1);
    if (!status)
        status = gnoi_progress(scene->context, "checking", 0);
    if (!status)
        status = check_light(scene, &scene->lights[light].light, matrix, result);
    return status == GNO_ERROR_MEMORY ? gnoi_fail(scene->context, status, "out of memory for checking the shadow matrix") : status;
}
