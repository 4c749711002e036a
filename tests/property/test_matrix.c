/* test_matrix.c -- the shadow matrix against rays, on random scenes of every kind and lights of every kind: a caster that is found between
 * a light and a point of a receiver must be a one (a zero is certain), and few ones cast no shadow at all.
 *
 * The twin shares nothing with the engine: random points of each polygon, a ray to the light from each, every polygon tried.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>
#include <gnomon/gnomon_matrix.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/random_scene.h"

#define SEEDS 3
#define POINTS 12 /* of each receiver */
#define MOST_CORNERS 64

typedef struct flat {
    double n[3], d, size;
    int axis_u, axis_v; /* the plane coordinates that are kept */
    gno_polygon polygon;
} flat;

static const double *corner(const flat *f, unsigned i) { return f->polygon.positions + 3 * f->polygon.corner_vertex[i]; }

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* Newell's normal; 0 for a polygon without area. */
static int measure(const gno_scene *scene, size_t index, flat *f)
{
    double length, n[3] = {0, 0, 0};
    assert_int_equal(gno_scene_polygon(scene, index, &f->polygon), GNO_OK);
    unsigned from = f->polygon.ring_start[0], to = f->polygon.ring_start[1];
    f->size = 0;
    for (unsigned i = from; i < to; i++) {
        const double *a = corner(f, i), *b = corner(f, i + 1 < to ? i + 1 : from);
        for (int k = 0; k < 3; k++) {
            n[k] += (a[(k + 1) % 3] - b[(k + 1) % 3]) * (a[(k + 2) % 3] + b[(k + 2) % 3]);
            f->size = fmax(f->size, fabs(a[k] - corner(f, from)[k]));
        }
    }
    length = sqrt(dot(n, n));
    if (!(length > 1e-9)) return 0;
    for (int k = 0; k < 3; k++) f->n[k] = n[k] / length;
    f->d = -dot(f->n, corner(f, from));
    int drop = fabs(n[0]) > fabs(n[1]) && fabs(n[0]) > fabs(n[2]) ? 0 : fabs(n[1]) > fabs(n[2]) ? 1 : 2;
    f->axis_u = (drop + 1) % 3;
    f->axis_v = (drop + 2) % 3;
    return 1;
}

/* Even-odd inside, and by more than `margin` from every edge. */
static int well_inside(const flat *f, const double p[3], double margin)
{
    int inside = 0;
    for (size_t r = 0; r < f->polygon.ring_count; r++) {
        unsigned from = f->polygon.ring_start[r], to = f->polygon.ring_start[r + 1];
        for (unsigned i = from; i < to; i++) {
            const double *a = corner(f, i), *b = corner(f, i + 1 < to ? i + 1 : from);
            double au = a[f->axis_u] - p[f->axis_u], av = a[f->axis_v] - p[f->axis_v];
            double bu = b[f->axis_u] - p[f->axis_u], bv = b[f->axis_v] - p[f->axis_v];
            double eu = bu - au, ev = bv - av, along = -(au * eu + av * ev) / (eu * eu + ev * ev);
            double t = along < 0 ? 0 : along > 1 ? 1 : along;
            if (hypot(au + t * eu, av + t * ev) < margin) return 0;
            inside ^= (av > 0) != (bv > 0) && (au * bv - bu * av > 0) == (bv > av);
        }
    }
    return inside;
}

/* A random point well inside, found by trying the rectangle around it. */
static int random_point(const flat *f, uint64_t *state, double p[3])
{
    const double *first = corner(f, f->polygon.ring_start[0]);
    double lo[3] = {first[0], first[1], first[2]}, hi[3] = {first[0], first[1], first[2]};
    int drop = 3 - f->axis_u - f->axis_v;
    for (unsigned i = f->polygon.ring_start[0]; i < f->polygon.ring_start[1]; i++)
        for (int k = 0; k < 3; k++) {
            lo[k] = fmin(lo[k], corner(f, i)[k]);
            hi[k] = fmax(hi[k], corner(f, i)[k]);
        }
    for (int tries = 0; tries < 40; tries++) {
        p[f->axis_u] = lo[f->axis_u] + (hi[f->axis_u] - lo[f->axis_u]) * random_unit(state);
        p[f->axis_v] = lo[f->axis_v] + (hi[f->axis_v] - lo[f->axis_v]) * random_unit(state);
        p[drop] = -(f->d + f->n[f->axis_u] * p[f->axis_u] + f->n[f->axis_v] * p[f->axis_v]) / f->n[drop];
        if (well_inside(f, p, 1e-4 * f->size)) return 1;
    }
    return 0;
}

/* Does the caster stand between p and the light, clear by `margin` (a share of its size) of its edges and, by ten times as much, of the
 * receiver's plane? */
static int blocks(const flat *caster, const flat *receiver, const double p[3], const gno_light *light, double margin)
{
    double to[3], q[3], slope, t, side;
    for (int k = 0; k < 3; k++) to[k] = light->type == GNO_LIGHT_DIRECTIONAL ? -light->direction[k] : light->position[k] - p[k];
    slope = dot(caster->n, to);
    if (fabs(slope) < 1e-6) return 0;
    t = -(dot(caster->n, p) + caster->d) / slope;
    if (!(t > 0.1 * margin) || (light->type != GNO_LIGHT_DIRECTIONAL && t > 1 - 0.1 * margin)) return 0;
    for (int k = 0; k < 3; k++) q[k] = p[k] + t * to[k];
    side = dot(receiver->n, to) < 0 ? -1 : 1;
    return side * (dot(receiver->n, q) + receiver->d) > 10 * margin && well_inside(caster, q, margin * caster->size);
}

/* Between the normal and the light; 0 where the polygon is edge-on. */
static double cosine(const flat *f, const double p[3], const gno_light *light)
{
    double to[3];
    for (int k = 0; k < 3; k++) to[k] = light->type == GNO_LIGHT_DIRECTIONAL ? -light->direction[k] : light->position[k] - p[k];
    return dot(f->n, to) / sqrt(dot(to, to));
}

static int is_two_sided(const gno_scene *scene, const flat *f)
{
    gno_material material;
    assert_int_equal(gno_scene_material(scene, f->polygon.material, &material), GNO_OK);
    return material.two_sided;
}

typedef struct score {
    size_t found, ones, judged, false_ones;
    size_t dark, dark_but_lit; /* points of two-sided polygons whose column is own shadow alone; those that nothing stands before */
} score;

static int is_one(const gno_matrix_column *c, size_t caster)
{
    for (size_t i = 0; i < c->count; i++)
        if (c->casters[i] == caster) return 1;
    return 0;
}

/* Where the column of a two-sided polygon is own shadow alone, the side that the light meets is within a closed solid: something stands
 * before every point of it. */
static void check_receiver(const flat *flats, const int *good, size_t count, size_t r, const gno_light *light, gno_matrix *m, uint64_t *state,
                           score *s, const gno_scene *scene, const char *name)
{
    gno_matrix_column c;
    assert_int_equal(gno_matrix_get_column(m, r, &c), GNO_OK);
    for (int i = 0; i < POINTS; i++) {
        double p[3], slope;
        int before = 0;
        if (!random_point(&flats[r], state, p)) return;
        for (size_t k = 0; k < count; k++) {
            gno_material material;
            if (k == r || !good[k] || flats[k].polygon.detail_of >= 0) continue; /* details cast nothing */
            before |= blocks(&flats[k], &flats[r], p, light, 1e-9);
            if (!blocks(&flats[k], &flats[r], p, light, 1e-4)) continue;
            assert_int_equal(gno_scene_material(scene, flats[k].polygon.material, &material), GNO_OK);
            if (material.transmission[0] >= 1 && material.transmission[1] >= 1 && material.transmission[2] >= 1) continue;
            if (c.shade == GNO_SHADE_OWN) continue;
            s->found++;
            if (!is_one(&c, k)) fail_msg("%s: polygon %lu shades %lu at (%g %g %g), and the matrix has a zero", name, (unsigned long)k, (unsigned long)r, p[0], p[1], p[2]);
        }
        slope = cosine(&flats[r], p, light);
        if (c.shade != GNO_SHADE_OWN || fabs(slope) < 1e-3 || !is_two_sided(scene, &flats[r])) continue;
        s->dark++;
        s->dark_but_lit += !before;
    }
}

static void check_light(gno_scene *scene, int index, uint64_t *state, score *s, const char *name)
{
    size_t count = gno_scene_count(scene).polygons;
    flat *flats = malloc(count * sizeof *flats);
    int *good = malloc(count * sizeof *good);
    gno_matrix_check_result result;
    gno_matrix_info info;
    gno_matrix *m;
    gno_light light;
    assert_true(flats && good);
    for (size_t i = 0; i < count; i++) good[i] = measure(scene, i, &flats[i]);
    assert_int_equal(gno_scene_light(scene, index, &light, NULL), GNO_OK);
    assert_int_equal(gno_matrix_build(scene, index, NULL, &m), GNO_OK);
    for (size_t r = 0; r < count && light.type != GNO_LIGHT_AREA; r++)
        if (good[r]) check_receiver(flats, good, count, r, &light, m, state, s, scene, name);
    assert_int_equal(gno_matrix_get_info(m, &info), GNO_OK);
    assert_int_equal(info.size, info.own + info.covered + info.part + info.none + info.no_area);
    assert_int_equal(gno_matrix_check(scene, index, m, &result), GNO_OK);
    s->ones += info.ones;
    s->judged += result.judged;
    s->false_ones += result.false_ones;
    gno_matrix_destroy(m);
    free(flats);
    free(good);
}

/* A sun from the side, a lamp among the polygons, one far off: beside the scene's own lights. */
static void add_lights(gno_scene *scene, uint64_t *state)
{
    gno_light light = gno_light_default();
    for (int k = 0; k < 3; k++) light.direction[k] = random_unit(state) - 0.5;
    light.type = GNO_LIGHT_DIRECTIONAL;
    assert_int_equal(gno_scene_add_light(scene, "side", &light, NULL), GNO_OK);
    light.type = GNO_LIGHT_POINT;
    for (int k = 0; k < 3; k++) light.position[k] = 4 * random_unit(state) - 2;
    assert_int_equal(gno_scene_add_light(scene, "among", &light, NULL), GNO_OK);
    for (int k = 0; k < 3; k++) light.position[k] = 40 * random_unit(state) + 10;
    assert_int_equal(gno_scene_add_light(scene, "far", &light, NULL), GNO_OK);
}

static void test_random_scenes(void **state)
{
    (void)state;
    score s = {0, 0, 0, 0, 0, 0};
    for (int kind = 0; kind < SCENE_KINDS; kind++)
        for (unsigned seed = 0; seed < SEEDS; seed++) {
            gno_context *context;
            uint64_t random = 1000u * (unsigned)kind + seed + 1;
            assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
            gno_scene *scene = random_scene(context, (scene_kind)kind, 900 + seed, 64, 64);
            assert_non_null(scene);
            if (gno_scene_count(scene).polygons <= 700) {
                add_lights(scene, &random);
                for (int i = 0; i < (int)gno_scene_count(scene).lights; i++) check_light(scene, i, &random, &s, scene_kind_name((scene_kind)kind));
            }
            gno_scene_destroy(scene);
            gno_context_destroy(context);
        }
    print_message("%lu shadows found by rays, %lu points in own shadow, %lu of them lit; %lu ones, %lu judged, %lu cast no shadow\n", (unsigned long)s.found, (unsigned long)s.dark,
                  (unsigned long)s.dark_but_lit,
                  (unsigned long)s.ones, (unsigned long)s.judged, (unsigned long)s.false_ones);
    assert_true(s.found > 2000);
    assert_true(s.judged > 2000);
    assert_true(s.dark > 2000);
    assert_true((double)s.dark_but_lit < 0.0005 * (double)s.dark);
    assert_true((double)s.false_ones < 0.01 * (double)s.judged);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_random_scenes)};
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
