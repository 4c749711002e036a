/* test_plain_map.c -- a texture by texture coordinates on polygons that have none: gnomon.h promises the planar map along the two axes
 * that the normal lies farthest from, in the mesh's own space. Held against a box whose faces are given just those planar maps.
 * Place: tests of src/project, src/shade and src/shadow through the public interface.
 *
 * The picture has holes, so that what the eye sees of it, what shows through it, and the shadow it throws on the floor are all compared.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <gnomon/gnomon.h>
#include <math.h>
#include <string.h>

enum { SIZE = 40, VALUES = 3 * SIZE * SIZE };

static const double cube[24] = {0, 0, 0, 2, 0, 0, 2, 3, 0, 0, 3, 0, 0, 0, 1, 2, 0, 1, 2, 3, 1, 0, 3, 1};
/* Faces by the axis of their normal: x, x, y, y, z, z. */
static const int faces[24] = {0, 4, 7, 3, 1, 2, 6, 5, 0, 1, 5, 4, 3, 7, 6, 2, 0, 3, 2, 1, 4, 5, 6, 7};
static const unsigned rings[7] = {0, 4, 8, 12, 16, 20, 24};
/* Turned about two axes, stretched, moved: the mesh's axes are none of the scene's. */
static const double transform[12] = {1.2, -0.8, 0.1, -1, 0.8, 1, 0.3, 0.5, -0.2, -0.1, 1.4, 1.5};

static gno_status add_materials(gno_scene *scene, int plain, int index[3])
{
    static const float cells[16] = {0.9f, 0.1f, 0.1f, 1, 0.1f, 0.8f, 0.2f, 0, 0.2f, 0.2f, 1, 0.5f, 0.7f, 0.7f, 0.1f, 1};
    gno_material material = gno_material_default();
    gno_pixels pixels;
    gno_status status;
    memset(&pixels, 0, sizeof pixels);
    pixels.width = pixels.height = 2;
    pixels.channels = 4;
    pixels.linear = cells;
    for (int k = 0; k < 3; k++)
        material.ambient[k] = material.diffuse[k] = 1;
    material.texture = gno_texture_default(plain ? GNO_MAP_UV : GNO_MAP_PLANAR);
    material.texture.kind = GNO_TEXTURE_IMAGE;
    material.texture.scale[0] = 0.6;
    material.texture.scale[1] = 0.8;
    status = gno_scene_add_image(scene, &pixels, &material.texture.image);
    for (int axis = 0; axis < 3 && !status; axis++) {
        if (!plain) {
            memset(material.texture.u, 0, sizeof material.texture.u);
            memset(material.texture.v, 0, sizeof material.texture.v);
            material.texture.u[axis == 0 ? 1 : 0] = 1;
            material.texture.v[axis == 2 ? 1 : 2] = 1;
        }
        status = gno_scene_add_material(scene, &material, &index[axis]);
    }
    return status;
}

static gno_status add_box_and_floor(gno_scene *scene, const int index[3])
{
    static const double floor_at[12] = {-9, -9, 0, 9, -9, 0, 9, 9, 0, -9, 9, 0};
    static const int square[4] = {0, 1, 2, 3};
    const int of_face[6] = {index[0], index[0], index[1], index[1], index[2], index[2]};
    gno_mesh_def mesh = gno_mesh_def_default();
    gno_status status;
    mesh.vertex_count = 8;
    mesh.positions = cube;
    mesh.polygon_count = mesh.ring_count = 6;
    mesh.ring_start = rings;
    mesh.corner_count = 24;
    mesh.corner_vertex = faces;
    mesh.polygon_material = of_face;
    memcpy(mesh.transform, transform, sizeof transform);
    status = gno_scene_add_mesh(scene, &mesh, NULL);
    mesh = gno_mesh_def_default();
    mesh.vertex_count = mesh.corner_count = 4;
    mesh.positions = floor_at;
    mesh.polygon_count = mesh.ring_count = 1;
    mesh.ring_start = rings;
    mesh.corner_vertex = square;
    return status ? status : gno_scene_add_mesh(scene, &mesh, NULL);
}

static void draw(int plain, gno_camera_type type, int directional, float *rgb)
{
    const double ambient[3] = {0.3, 0.3, 0.3};
    gno_image_def image = gno_image_def_default();
    gno_camera camera = gno_camera_default();
    gno_light light = gno_light_default();
    gno_context *context;
    gno_scene *scene;
    int index[3];
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    assert_int_equal(gno_scene_create(context, &scene), GNO_OK);
    image.width = image.height = SIZE;
    image.background[2] = 0.5;
    camera.type = type;
    camera.eye[0] = 6;
    camera.eye[1] = -9;
    camera.eye[2] = 8;
    camera.target[0] = camera.target[1] = 0.5;
    camera.target[2] = 1;
    camera.up[0] = camera.up[1] = 0;
    camera.up[2] = 1;
    camera.height = 9;
    light.type = directional ? GNO_LIGHT_DIRECTIONAL : GNO_LIGHT_POINT;
    light.position[0] = -4;
    light.position[1] = 3;
    light.position[2] = 9;
    light.direction[0] = 0.5;
    light.direction[1] = -0.3;
    light.direction[2] = -1;
    assert_int_equal(add_materials(scene, plain, index), GNO_OK);
    assert_int_equal(add_box_and_floor(scene, index), GNO_OK);
    assert_int_equal(gno_scene_set_image(scene, &image), GNO_OK);
    assert_int_equal(gno_scene_set_camera(scene, &camera), GNO_OK);
    assert_int_equal(gno_scene_set_ambient(scene, ambient), GNO_OK);
    assert_int_equal(gno_scene_add_light(scene, NULL, &light, NULL), GNO_OK);
    assert_int_equal(gno_render(scene, NULL, rgb, NULL), GNO_OK);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

static void test_same_as_planar(void **state)
{
    static float by_default[VALUES], by_hand[VALUES];
    (void)state;
    for (int type = 0; type < 2; type++)
        for (int directional = 0; directional < 2; directional++) {
            size_t colours = 0;
            draw(1, (gno_camera_type)type, directional, by_default);
            draw(0, (gno_camera_type)type, directional, by_hand);
            for (int i = 0; i < VALUES; i++) {
                if (!(fabsf(by_default[i] - by_hand[i]) <= 1e-5f))
                    fail_msg("value %d: %g is not %g", i, (double)by_default[i], (double)by_hand[i]);
                colours += i >= 3 && by_hand[i] != by_hand[i - 3];
            }
            assert_true(colours > VALUES / 8); /* the pattern is there to be seen */
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_same_as_planar)};
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
