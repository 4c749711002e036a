/* test_terminator.c -- the smooth terminator, rendered, against its formula (docs/algorithm.md, section 15; Chiang, Li and Burley 2019).
 * Place: tests of src/shade and src/engine through the public interface.
 *
 * One square facing up whose corners all have the same normal, tilted towards the light or away from it, seen in one pixel.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <gnomon/gnomon.h>
#include <math.h>

#define DEGREE 0.017453292519943295
#define DIFFUSE 0.4

/* What the pixel shows of the square under a light `angle` degrees from the vertical, the normal tilted `tilt` degrees towards it. */
static double shown(double angle, double tilt, int near, gno_shading shading, gno_terminator terminator, gno_engine engine)
{
    static const double positions[12] = {-2, -2, 0, 2, -2, 0, 2, 2, 0, -2, 2, 0};
    static const int corners[4] = {0, 1, 2, 3}, same[4] = {0, 0, 0, 0};
    static const unsigned rings[2] = {0, 4};
    const double normal[3] = {sin(tilt * DEGREE), 0, cos(tilt * DEGREE)}, towards[3] = {sin(angle * DEGREE), 0, cos(angle * DEGREE)};
    const gno_image_def image = {1, 1, {0, 0, 0}};
    gno_mesh_def mesh = gno_mesh_def_default();
    gno_material material = gno_material_default();
    gno_light light = gno_light_default();
    gno_camera camera = gno_camera_default();
    gno_render_def def = gno_render_def_default();
    gno_context *context;
    gno_scene *scene;
    float rgb[3];
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    assert_int_equal(gno_scene_create(context, &scene), GNO_OK);
    for (int k = 0; k < 3; k++) {
        material.diffuse[k] = DIFFUSE;
        material.specular[k] = 0;
        light.direction[k] = -towards[k];
        light.position[k] = 10 * towards[k];
        camera.eye[k] = k == 2 ? 8 : 1;
        camera.target[k] = 0;
        camera.up[k] = k == 1;
    }
    camera.fov = 0.01;
    light.type = near ? GNO_LIGHT_POINT : GNO_LIGHT_DIRECTIONAL;
    assert_int_equal(gno_scene_add_material(scene, &material, &mesh.material), GNO_OK);
    mesh.vertex_count = mesh.corner_count = 4;
    mesh.positions = positions;
    mesh.normal_count = 1;
    mesh.normals = normal;
    mesh.polygon_count = mesh.ring_count = 1;
    mesh.ring_start = rings;
    mesh.corner_vertex = corners;
    mesh.corner_normal = same;
    mesh.shading = (int)shading;
    def.terminator = terminator;
    def.engine = engine;
    assert_int_equal(gno_scene_add_mesh(scene, &mesh, NULL), GNO_OK);
    assert_int_equal(gno_scene_add_light(scene, NULL, &light, NULL), GNO_OK);
    assert_int_equal(gno_scene_set_camera(scene, &camera), GNO_OK);
    assert_int_equal(gno_scene_set_image(scene, &image), GNO_OK);
    assert_int_equal(gno_render(scene, &def, rgb, NULL), GNO_OK);
    assert_true(rgb[0] == rgb[1] && rgb[1] == rgb[2]);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
    return (double)rgb[0];
}

static void near_to(double a, double b, double angle, double tilt)
{
    if (!(fabs(a - b) <= 1e-5)) fail_msg("light at %g, normal at %g: %.9g is not %.9g", angle, tilt, a, b);
}

static void test_formula(void **state)
{
    static const double angles[4] = {10, 45, 70, 85}, tilts[6] = {-40, -15, 0, 12, 30, 60};
    (void)state;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 6; j++)
            for (int near = 0; near < 2; near++)
                for (int engine = 0; engine < 2; engine++) {
                    double a = angles[i], t = tilts[j], nl = cos((a - t) * DEGREE), g, lit = nl > 0 ? DIFFUSE * nl : 0;
                    g = nl > 0 ? cos(a * DEGREE) / (nl * cos(t * DEGREE)) : 0;
                    g = g > 1 ? 1 : g;
                    near_to(shown(a, t, near, GNO_SHADING_PHONG, GNO_TERMINATOR_EXACT, (gno_engine)engine), lit, a, t);
                    near_to(shown(a, t, near, GNO_SHADING_PHONG, GNO_TERMINATOR_SMOOTH, (gno_engine)engine), lit * g * (1 + g - g * g), a, t);
                }
}

/* Flat polygons have their own normal: the factor is 1. */
static void test_flat(void **state)
{
    (void)state;
    for (int engine = 0; engine < 2; engine++)
        near_to(shown(60, 40, 0, GNO_SHADING_FLAT, GNO_TERMINATOR_SMOOTH, (gno_engine)engine), DIFFUSE * 0.5, 60, 40);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_formula), cmocka_unit_test(test_flat)};
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
