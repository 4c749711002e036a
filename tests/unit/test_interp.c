/* test_interp.c -- normals interpolated over triangles in the picture: against areas on the triangle itself, and side by side as one by one.
 * Place: tests of src/shade.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "scene/prepare.h"
#include "shade/interp_lanes.h"

#include <math.h>
#include <string.h>

enum { TRIANGLES = 37 };

static double next(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) / 16777216.0;
}

/* Triangles with corners of their own, each with a normal of its own, in front of the default camera's place. */
static gno_scene *random_triangles(gno_context *context, uint32_t *r)
{
    static double positions[9 * TRIANGLES], normals[9 * TRIANGLES];
    static int corners[3 * TRIANGLES];
    gno_mesh_def mesh = gno_mesh_def_default();
    gno_scene *scene;
    assert_int_equal(gno_scene_create(context, &scene), GNO_OK);
    for (int i = 0; i < 9 * TRIANGLES; i++) {
        positions[i] = 4 * next(r) - 2;
        normals[i] = next(r) - 0.5;
        corners[i / 3] = i / 3;
    }
    mesh.vertex_count = mesh.normal_count = 3 * TRIANGLES;
    mesh.positions = positions;
    mesh.normals = normals;
    mesh.polygon_count = mesh.ring_count = TRIANGLES;
    mesh.corner_count = 3 * TRIANGLES;
    mesh.corner_vertex = mesh.corner_normal = corners;
    mesh.shading = GNO_SHADING_PHONG;
    assert_int_equal(gno_scene_add_mesh(scene, &mesh, NULL), GNO_OK);
    assert_int_equal(gno_scene_prepare(scene, 1, NULL), GNO_OK);
    assert_int_equal(scene->prepared.poly_count, TRIANGLES);
    return scene;
}

static gnoi_view random_view(uint32_t *r)
{
    gno_camera camera = gno_camera_default();
    gno_image_def image = gno_image_def_default();
    for (int k = 0; k < 3; k++) {
        camera.eye[k] = k == 1 ? -9 : 2 * next(r) - 1;
        camera.target[k] = 0;
    }
    camera.type = next(r) < 0.5 ? GNO_CAMERA_ORTHOGRAPHIC : GNO_CAMERA_PERSPECTIVE;
    image.width = 200;
    image.height = 160;
    return gnoi_view_make(&camera, &image, 10);
}

static double area(vec3 a, vec3 b, vec3 c) { return v3_length(v3_cross(v3_sub(b, a), v3_sub(c, a))); }

static void check_triangle(const gno_scene *scene, const gnoi_view *view, const gnoi_poly *poly, uint32_t *r)
{
    const gnoi_prepared *prep = &scene->prepared;
    double s = next(r), t = next(r) * (1 - s), u = 1 - s - t, w, x, y;
    vec3 p[3], n = v3(0, 0, 0), found, point;
    gnoi_interp interp;
    for (uint32_t i = 0; i < 3; i++)
        p[i] = v3_from(prep->positions[prep->corner_vertex[poly->corner + i]]);
    if (area(p[0], p[1], p[2]) < 0.05)
        return;
    point = v3_add(v3_add(v3_scale(p[0], u), v3_scale(p[1], s)), v3_scale(p[2], t));
    for (uint32_t i = 0; i < 3; i++) {
        const float *of = prep->normals[prep->corner_normal[poly->corner + i]];
        n = v3_mad(n, v3((double)of[0], (double)of[1], (double)of[2]), i == 0 ? u : i == 1 ? s : t);
    }
    w = gnoi_form_at(&view->w, point);
    x = gnoi_form_at(&view->x, point) / w;
    y = gnoi_form_at(&view->y, point) / w;
    interp.ready = 0;
    gnoi_interp_seek(&interp, scene, view, poly, x, y);
    assert_true(gnoi_interp_depth(&interp, x, y) > -1e-9);
    found = v3(gnoi_plane_at(&interp.normal[0], x, y), gnoi_plane_at(&interp.normal[1], x, y), gnoi_plane_at(&interp.normal[2], x, y));
    if (v3_length(n) > 0.1)
        assert_true(v3_length(v3_sub(v3_unit(found), v3_unit(n))) < 1e-6);
}

static void check_lanes(const gno_scene *scene, const gnoi_view *view, const gnoi_poly *polys, unsigned count)
{
    gnoi_interp_lanes lanes;
    memset(&lanes, 0, sizeof lanes);
    for (unsigned i = 0; i < count; i++)
        gnoi_interp_lanes_load(&lanes, i, &scene->prepared, polys[i].corner);
    gnoi_interp_lanes_set(&lanes, view);
    for (unsigned i = 0; i < count; i++) {
        gnoi_interp interp;
        interp.ready = 0;
        gnoi_interp_seek(&interp, scene, view, &polys[i], 0, 0);
        for (int k = 0; k < 3; k++) {
            assert_true(lanes.plane[k][0][i] == interp.normal[k].fx);
            assert_true(lanes.plane[k][1][i] == interp.normal[k].fy);
            assert_true(lanes.plane[k][2][i] == interp.normal[k].f0);
        }
        assert_true((float)lanes.turn[i] == interp.turn);
    }
}

static void test_normals(void **state)
{
    uint32_t r = 12345;
    gno_context *context;
    (void)state;
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    for (int round = 0; round < 40; round++) {
        gno_scene *scene = random_triangles(context, &r);
        const gnoi_view view = random_view(&r);
        const gnoi_poly *polys = scene->prepared.polys;
        for (unsigned i = 0; i < TRIANGLES; i++)
            check_triangle(scene, &view, &polys[i], &r);
        for (unsigned i = 0; i < TRIANGLES; i += GNOI_INTERP_LANES)
            check_lanes(scene, &view, polys + i, TRIANGLES - i < GNOI_INTERP_LANES ? TRIANGLES - i : GNOI_INTERP_LANES);
        gno_scene_destroy(scene);
    }
    gno_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_normals)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
