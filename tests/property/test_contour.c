/* test_contour.c -- what a light's trees are made of. Boxes of polygons from their vertices' places, against those of their corners; contours of closed solids as a light sees them, against the boundary of all their far sides; with seams that only polygons
 * without area close, every vertex of a contour still has as many edges in as out. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "scene/scene.h"
#include "shadow/contour.h"
#include "shadow/lamp.h"
#include "shadow/located.h"
#include "support/solids.h"
#include <float.h>
#include <stdlib.h>
#include <string.h>

#define SEEDS 60

/* Cuts the first edge of every `step`th triangle in its middle; a triangle without area closes the seam to the neighbour. */
static void cut_edges(solid *s, size_t step)
{
    static solid old;
    old = *s;
    s->polygons = s->corners = 0;
    for (size_t i = 0; i < old.polygons; i++) {
        const int *v = old.corner + old.ring[i];
        int cut = step > 0 && i % step == 0 && old.ring[i + 1] - old.ring[i] == 3, m = (int)s->vertices;
        int parts[3][3] = {{v[0], m, v[2]}, {m, v[1], v[2]}, {v[0], v[1], m}};
        if (cut)
            for (int k = 0; k < 3; k++)
                s->p[m][k] = 0.5 * (s->p[v[0]][k] + s->p[v[1]][k]);
        s->vertices += (size_t)cut;
        for (int part = 0; part < (cut ? 3 : 1); part++) {
            size_t count = cut ? 3 : old.ring[i + 1] - old.ring[i];
            memcpy(s->corner + s->corners, cut ? parts[part] : v, count * sizeof *v);
            s->corners += count;
            s->ring[++s->polygons] = (unsigned)s->corners;
        }
    }
}

static gno_scene *make_scene(gno_context *context, uint32_t *seed, size_t step)
{
    static solid s;
    gno_mesh_def mesh;
    gno_light light = gno_light_default();
    gno_scene *scene;
    assert_int_equal(gno_scene_create(context, &scene), GNO_OK);
    solid_make(&s, seed, 0);
    cut_edges(&s, step);
    mesh = solid_mesh(&s);
    assert_int_equal(gno_scene_add_mesh(scene, &mesh, NULL), GNO_OK);
    light.type = solid_random(seed) % 2 ? GNO_LIGHT_POINT : GNO_LIGHT_DIRECTIONAL;
    for (int k = 0; k < 3; k++) {
        light.position[k] = solid_uniform(seed, 2, 4);
        light.direction[k] = solid_uniform(seed, -1, 1);
    }
    assert_int_equal(gno_scene_add_light(scene, NULL, &light, NULL), GNO_OK);
    assert_int_equal(gno_scene_prepare(scene, 1, NULL), GNO_OK);
    return scene;
}

static void check_balance(const gno_scene *scene, const gnoi_boundary *contour)
{
    int *balance = calloc(scene->prepared.vertex_count, sizeof *balance);
    assert_non_null(balance);
    for (size_t i = 0; i < contour->count; i++) {
        balance[contour->edges[i].from]++;
        balance[contour->edges[i].to]--;
    }
    for (size_t v = 0; v < scene->prepared.vertex_count; v++)
        assert_int_equal(balance[v], 0);
    free(balance);
}

static void check_contour(const gno_scene *scene, const gnoi_casters *casters, int whole)
{
    const gnoi_prepared *prep = &scene->prepared;
    const size_t count = prep->poly_count + prep->cap_count;
    unsigned char *is_far = calloc(count, 1);
    gnoi_boundary expected = {0, 0, NULL};
    assert_non_null(is_far);
    for (size_t i = 0; i < casters->far.entry_count; i++)
        is_far[casters->far.caster[i]] = 1;
    assert_int_equal(gnoi_boundary_find(scene->context, prep, is_far, count, NULL, &expected), 1);
    check_balance(scene, &casters->contour);
    assert_true(casters->contour.count <= expected.count);
    if (whole) {
        assert_int_equal(casters->contour.count, expected.count);
        for (size_t i = 0; i < expected.count; i++) {
            const gnoi_boundary_edge *e = &casters->contour.edges[i], *x = &expected.edges[i];
            assert_int_equal(e->poly, x->poly);
            assert_true((e->from == x->from && e->to == x->to) || (e->from == x->to && e->to == x->from));
        }
    }
    gnoi_boundary_free(scene->context, &expected);
    free(is_far);
}

static void contours_are_boundaries_of_far_sides(void **state)
{
    size_t edges = 0, joints = 0;
    (void)state;
    for (uint32_t i = 0; i < SEEDS; i++) {
        uint32_t seed = i;
        const size_t step = i % 3 == 0 ? 0 : 1 + i % 7;
        gno_context *context;
        gno_scene *scene;
        gnoi_lamp lamp;
        gnoi_casters casters;
        unsigned char halved[1] = {1};
        assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
        scene = make_scene(context, &seed, step);
        assert_int_equal(scene->prepared.solid_count, 1);
        assert_true(scene->prepared.solids[0].closed);
        gnoi_lamps_fill(scene, &lamp);
        assert_int_equal(gnoi_casters_build(scene, &lamp, halved, 0, &casters), GNO_OK);
        check_contour(scene, &casters, scene->prepared.problems.degenerate == 0);
        edges += casters.contour.count;
        joints += scene->prepared.joint_count;
        gnoi_casters_free(context, &casters);
        gno_scene_destroy(scene);
        gno_context_destroy(context);
    }
    assert_true(edges > 100 && joints > 100);
}

/* ---- boxes -------------------------------------------------------------------------------------------------------------- */

static int near_to(float a, float b) { return fabsf(a - b) <= 4 * FLT_EPSILON * fmaxf(fabsf(a), fabsf(b)); }

/* Returns how many have one box. */
static size_t check_boxes(const gno_scene *scene, const gnoi_frame *frame)
{
    const gnoi_prepared *prep = &scene->prepared;
    gnoi_located *located = gnoi_locate_vertices(scene, frame);
    size_t together = 0;
    assert_non_null(located);
    for (size_t i = 0; i < prep->poly_count; i++) {
        gnoi_lbox box, boxes[6];
        vec3 points[GNOI_FRAME_POINTS];
        uint32_t count;
        const uint32_t *vertex = gnoi_corners_of(prep, i, &count);
        if (count > GNOI_FRAME_POINTS || !gnoi_located_box(frame, located, vertex, count, &box))
            continue;
        for (uint32_t k = 0; k < count; k++)
            points[k] = v3_from(prep->positions[vertex[k]]);
        assert_int_equal(gnoi_frame_boxes(frame, points, (int)count, boxes), 1);
        assert_true(near_to(box.u0, boxes[0].u0) && near_to(box.u1, boxes[0].u1) && near_to(box.v0, boxes[0].v0) &&
                    near_to(box.v1, boxes[0].v1) && near_to(box.z0, boxes[0].z0) && near_to(box.z1, boxes[0].z1));
        together++;
    }
    gnoi_free(scene->context, located, prep->vertex_count, sizeof *located);
    return together;
}

static void boxes_are_those_of_corners(void **state)
{
    static const double lower[3] = {-4, -4, -4}, upper[3] = {4, 4, 4}; /* a larger scene: lamps among the solids have six faces */
    size_t one = 0, six = 0;
    (void)state;
    for (uint32_t i = 0; i < SEEDS; i++) {
        uint32_t seed = i;
        gno_context *context;
        gno_scene *scene;
        gnoi_lamp lamp;
        gnoi_frame frame;
        assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
        scene = make_scene(context, &seed, 0);
        gnoi_lamps_fill(scene, &lamp);
        frame = gnoi_frame_make(&lamp, scene->prepared.lower, scene->prepared.upper);
        one += check_boxes(scene, &frame);
        frame = gnoi_frame_make(&lamp, lower, upper);
        six += frame.faces == 6 ? check_boxes(scene, &frame) : 0;
        gno_scene_destroy(scene);
        gno_context_destroy(context);
    }
    assert_true(one > 1000 && six > 1000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes_are_those_of_corners),
        cmocka_unit_test(contours_are_boundaries_of_far_sides),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
