/* test_sieve.c -- the sieve of the shadow matrix against the test of one pair after another: every column of random scenes is found anew by
 * gnoi_overlap_test over all polygons, without boxes, packets, or single precision.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdlib.h>

#include "shadow/lamp.h"
#include "shadow/matrix.h"
#include "support/random_scene.h"

#define SEEDS 2
#define MOST_POLYGONS 400

typedef struct score {
    size_t ones, missing, surplus;
} score;

static int has(const gno_matrix_column *c, size_t caster)
{
    for (size_t i = 0; i < c->count; i++)
        if (c->casters[i] == caster) return 1;
    return 0;
}

static int casts(const gno_scene *scene, const gnoi_poly *poly)
{
    const double *t = scene->materials[poly->material].transmission;
    return !poly->detail && (poly->opaque || !(t[0] >= 1 && t[1] >= 1 && t[2] >= 1));
}

/* Whether the polygon reaches beyond the light: the test of a pair may then be cautious, where boxes are not. */
static int reaches_beyond(const gno_scene *scene, const gnoi_lamp *lamp, const gnoi_shaded *r, const gnoi_poly *caster)
{
    double top = gnoi_form_at(&r->height, lamp->position);
    for (uint32_t i = 0; i < caster->corner_count && !lamp->directional; i++)
        if (gnoi_form_at(&r->height, gnoi_corner_at(scene, caster->corner + i)) >= top) return 1;
    return 0;
}

/* Polygons that are not planar are several prepared ones and are left out. */
static void check_column(gno_scene *scene, const gnoi_lamp *lamp, const gnoi_facets *facets, const unsigned char *parts, const gnoi_poly *poly,
                         gno_matrix *m, score *s)
{
    const gnoi_prepared *prep = &scene->prepared;
    gno_matrix_column c;
    gnoi_shaded r;
    assert_int_equal(gno_matrix_get_column(m, poly->source, &c), GNO_OK);
    if (c.shade == GNO_SHADE_OWN || parts[poly->source] != 1 || gnoi_lamp_side(lamp, poly->n, poly->d) == 0) return;
    gnoi_shaded_set(&r, scene, lamp, facets, poly);
    for (size_t i = 0; i < prep->poly_count; i++) {
        const gnoi_poly *caster = &prep->polys[i];
        int real = caster != poly && casts(scene, caster) && gnoi_overlap_test(&r, caster) != GNOI_OVERLAP_NONE;
        if (caster == poly || parts[caster->source] != 1) continue;
        s->ones += (size_t)real;
        s->missing += real && !has(&c, caster->source) && !reaches_beyond(scene, lamp, &r, caster);
        s->surplus += !real && has(&c, caster->source);
    }
}

static void check_light(gno_scene *scene, int light, const unsigned char *parts, score *s)
{
    gno_matrix_def def = gno_matrix_def_default();
    gnoi_facets facets;
    gnoi_lamp lamp;
    gno_matrix *m;
    if (scene->lights[light].light.type == GNO_LIGHT_AREA) return;
    gnoi_lamps_of(&scene->lights[light].light, &lamp);
    assert_int_equal(gno_matrix_build(scene, light, &def, &m), GNO_OK);
    assert_int_equal(gnoi_facets_build(scene, &facets), GNO_OK);
    for (size_t i = 0; i < scene->prepared.poly_count; i++) check_column(scene, &lamp, &facets, parts, &scene->prepared.polys[i], m, s);
    gnoi_facets_free(scene->context, &facets);
    gno_matrix_destroy(m);
}

static void check_scene(gno_scene *scene, score *s)
{
    unsigned char *parts = calloc(scene->polygon_count + 1, 1);
    assert_non_null(parts);
    assert_int_equal(gnoi_scene_prepare(scene, 1), GNO_OK);
    for (size_t i = 0; i < scene->prepared.poly_count; i++) parts[scene->prepared.polys[i].source]++;
    for (int i = 0; i < (int)scene->light_count; i++) check_light(scene, i, parts, s);
    free(parts);
}

static void test_random_scenes(void **state)
{
    score s = {0, 0, 0};
    (void)state;
    for (int kind = 0; kind < SCENE_KINDS; kind++)
        for (unsigned seed = 0; seed < SEEDS; seed++) {
            gno_context *context;
            assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
            gno_scene *scene = random_scene(context, (scene_kind)kind, 700 + seed, 64, 64);
            assert_non_null(scene);
            if (gno_scene_count(scene).polygons <= MOST_POLYGONS) check_scene(scene, &s);
            gno_scene_destroy(scene);
            gno_context_destroy(context);
        }
    print_message("%lu ones by single pairs; %lu missing, %lu surplus in the matrix\n", (unsigned long)s.ones, (unsigned long)s.missing, (unsigned long)s.surplus);
    assert_true(s.ones > 2000);
    assert_true(s.missing == 0);
    assert_true(s.surplus == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_random_scenes)};
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
