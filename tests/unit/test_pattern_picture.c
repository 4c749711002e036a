/* test_pattern_picture.c -- procedural patterns in whole pictures: the checkered plane to the horizon against brute force, patterns
 * that move with their object. Place: tests of src/engine with src/shade, through the public interface.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <gnomon/gnomon.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 72, HEIGHT = 48 };

typedef struct bed {
    gno_context *context;
    gno_scene *scene;
} bed;

static int set_up(void **state)
{
    const gno_image_def image = {WIDTH, HEIGHT, {0, 0, 0}};
    const double white[3] = {1, 1, 1};
    bed *b = calloc(1, sizeof *b);
    *state = b;
    return !b || gno_context_create(NULL, &b->context) != GNO_OK || gno_scene_create(b->context, &b->scene) != GNO_OK ||
           gno_scene_set_image(b->scene, &image) != GNO_OK || gno_scene_set_ambient(b->scene, white) != GNO_OK;
}

static int tear_down(void **state)
{
    bed *b = *state;
    gno_scene_destroy(b->scene);
    gno_context_destroy(b->context);
    free(b);
    return 0;
}

static gno_material patterned(gno_pattern pattern)
{
    gno_material m = gno_material_default();
    for (int k = 0; k < 3; k++)
        m.ambient[k] = 1;
    m.texture.kind = GNO_TEXTURE_PROCEDURAL;
    m.texture.procedural = gno_procedural_default(pattern);
    return m;
}

/* A square of 2 x `half` in z = 0, moved by a transform (rows of 3 x 4). */
static void add_square(bed *b, const gno_material *m, double half, const double *transform)
{
    const double positions[12] = {-half, -half, 0, half, -half, 0, half, half, 0, -half, half, 0};
    static const int corners[4] = {0, 1, 2, 3};
    static const unsigned rings[2] = {0, 4};
    gno_mesh_def mesh = gno_mesh_def_default();
    assert_int_equal(gno_scene_add_material(b->scene, m, &mesh.material), GNO_OK);
    mesh.vertex_count = mesh.corner_count = 4;
    mesh.positions = positions;
    mesh.polygon_count = mesh.ring_count = 1;
    mesh.ring_start = rings;
    mesh.corner_vertex = corners;
    if (transform)
        memcpy(mesh.transform, transform, sizeof mesh.transform);
    assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, NULL), GNO_OK);
}

static void render(bed *b, float *rgb)
{
    assert_int_equal(gno_render(b->scene, NULL, rgb, NULL), GNO_OK);
}

/* Parity of the cell that the ray through (x,y) of the picture meets on z = 0, in cells of `unit` turned by `turn`; -1 beyond `reach`
 * or above the horizon. The camera stands at (0,0,eye), looks along y and `fall` down. */
typedef struct floor_view {
    double eye, fall, fov, unit, turn, reach;
} floor_view;

static int cell_at(const floor_view *v, double x, double y)
{
    double s = 2 * tan(0.5 * v->fov * 0.017453292519943295) / HEIGHT, length = hypot(1, v->fall);
    double right = (x - 0.5 * WIDTH) * s, up = (0.5 * HEIGHT - y) * s; /* forward (0, 1, -fall)/length, up (0, fall, 1)/length */
    double dy = (1 + up * v->fall) / length, dz = (-v->fall + up) / length, t, px, py, u, w;
    if (!(dz < 0))
        return -1;
    t = v->eye / -dz;
    px = t * right;
    py = t * dy;
    u = (px * cos(v->turn) + py * sin(v->turn)) / v->unit;
    w = (-px * sin(v->turn) + py * cos(v->turn)) / v->unit;
    if (fabs(u) > v->reach || fabs(w) > v->reach)
        return -1;
    return ((long)floor(u) + (long)floor(w)) & 1;
}

/* Every pixel that lies on the floor as a whole agrees with 65,536 rays within 1/255: 256 x 256, each row moved a little, for thousands of
 * cells meet in the last rows. */
static void test_floor_to_the_horizon(void **state)
{
    bed *b = *state;
    static const floor_view views[2] = {{1.6, 0.15, 40, 1, 0.37, 1500}, {2.5, 0.4, 60, 0.7, 0, 1500}};
    float *rgb = malloc(3 * WIDTH * HEIGHT * sizeof *rgb);
    assert_non_null(rgb);
    for (int i = 0; i < 2; i++) {
        const floor_view *v = &views[i];
        double c = v->unit * cos(v->turn), s = v->unit * sin(v->turn), worst = 0;
        double transform[12] = {c, -s, 0, 0, s, c, 0, 0, 0, 0, v->unit, 0};
        gno_material m = patterned(GNO_PATTERN_CHECKER);
        gno_camera camera = gno_camera_default();
        int compared = 0;
        for (int k = 0; k < 3; k++) {
            m.texture.procedural.light[k] = 0;
            m.texture.procedural.dark[k] = 1;
            camera.eye[k] = k == 2 ? v->eye : 0;
            camera.target[k] = k == 0 ? 0 : k == 1 ? 1 : v->eye - v->fall;
        }
        camera.fov = v->fov;
        assert_int_equal(gno_scene_set_camera(b->scene, &camera), GNO_OK);
        if (i > 0) {
            tear_down(state);
            assert_int_equal(set_up(state), 0);
            b = *state;
            assert_int_equal(gno_scene_set_camera(b->scene, &camera), GNO_OK);
        }
        add_square(b, &m, v->reach, transform);
        render(b, rgb);
        for (int y = 0; y < HEIGHT; y += 3)
            for (int x = y % 11; x < WIDTH; x += 11) {
                int whole = 1, odd = 0;
                for (int j = 0; j < 65536 && whole; j++) {
                    double g = j * 0.61803398874989485;
                    int cell = cell_at(v, x + (j + 0.5) / 65536, y + g - floor(g));
                    whole = cell >= 0;
                    odd += cell > 0;
                }
                if (whole) {
                    worst = fmax(worst, fabs((double)rgb[3 * (y * WIDTH + x)] - odd / 65536.0));
                    compared++;
                }
            }
        assert_true(compared > 40);
        if (worst > 1.0 / 255)
            fail_msg("view %d: %g", i, worst);
    }
    free(rgb);
}

/* An object, its light and its camera moved, turned and made 3 times as large together: the same picture of pattern and bumps. */
static void test_pattern_sticks_to_its_object(void **state)
{
    static const double turned[12] = {0, -3, 0, 10, 3, 0, 0, -20, 0, 0, 3, 5}; /* a quarter turn about z */
    float *first = malloc(3 * WIDTH * HEIGHT * sizeof *first), *second = malloc(3 * WIDTH * HEIGHT * sizeof *second);
    (void)state;
    assert_non_null(first);
    assert_non_null(second);
    for (int pattern = GNO_PATTERN_WOOD; pattern <= GNO_PATTERN_CLOUD; pattern++) {
        gno_material m = patterned((gno_pattern)pattern);
        gno_camera camera = gno_camera_default();
        gno_light lamp = gno_light_default();
        double difference = 0, variation = 0;
        void *fresh = NULL;
        bed *b;
        assert_int_equal(set_up(&fresh), 0);
        b = fresh;
        camera.target[2] = 0;
        m.texture.procedural.origin[2] = 0.11;
        m.bump.kind = GNO_BUMP_HEIGHT;
        m.bump.amount = 0.1;
        m.bump.texture.kind = GNO_TEXTURE_PROCEDURAL;
        m.bump.texture.procedural = m.texture.procedural;
        gno_scene_set_camera(b->scene, &camera);
        add_square(b, &m, 2, NULL);
        lamp.position[0] = 1;
        lamp.position[1] = -2;
        lamp.position[2] = 3;
        assert_int_equal(gno_scene_add_light(b->scene, NULL, &lamp, NULL), GNO_OK);
        render(b, first);
        tear_down(&fresh);
        assert_int_equal(set_up(&fresh), 0);
        b = fresh;
        camera.eye[0] = 10 - 3 * -6;
        camera.eye[1] = -20 + 3 * 3;
        camera.eye[2] = 5 + 3 * 2;
        camera.target[0] = 10;
        camera.target[1] = -20;
        camera.target[2] = 5;
        gno_scene_set_camera(b->scene, &camera);
        add_square(b, &m, 2, turned);
        lamp.position[0] = 10 - 3 * -2;
        lamp.position[1] = -20 + 3 * 1;
        lamp.position[2] = 5 + 3 * 3;
        assert_int_equal(gno_scene_add_light(b->scene, NULL, &lamp, NULL), GNO_OK);
        render(b, second);
        tear_down(&fresh);
        for (int i = 0; i < 3 * WIDTH * HEIGHT; i++) {
            difference = fmax(difference, fabs((double)(first[i] - second[i])));
            variation = fmax(variation, fabs((double)(first[i] - first[3 * (HEIGHT / 2 * WIDTH + WIDTH / 2)])));
        }
        assert_true(variation > 0.1);
        if (difference > 1e-3)
            fail_msg("pattern %d: %g", pattern, difference);
    }
    free(first);
    free(second);
}

/* Straight veins as a bump: the height a (1 + sin t)/2, t = 2 pi r x, has the slope a pi r cos t along x, and N = (-slope, 0, 1). Light falls
 * straight down on the plane, kd 1: the picture is 1/|N|. One pixel a point. */
static void test_bump_by_hand(void **state)
{
    bed *b = *state;
    gno_material m = gno_material_default();
    gno_light sun = gno_light_default();
    gno_camera camera = gno_camera_default();
    const gno_image_def one = {1, 1, {0, 0, 0}};
    memset(m.ambient, 0, sizeof m.ambient);
    for (int k = 0; k < 3; k++)
        m.diffuse[k] = 1;
    m.bump.kind = GNO_BUMP_HEIGHT;
    m.bump.amount = 0.2;
    m.bump.texture.kind = GNO_TEXTURE_PROCEDURAL;
    m.bump.texture.procedural = gno_procedural_default(GNO_PATTERN_MARBLE);
    m.bump.texture.procedural.distortion = 0;
    m.bump.texture.procedural.sharpness = 1;
    m.bump.texture.procedural.rings = 1.5;
    sun.type = GNO_LIGHT_DIRECTIONAL;
    sun.direction[2] = -1;
    add_square(b, &m, 4, NULL);
    assert_int_equal(gno_scene_add_light(b->scene, NULL, &sun, NULL), GNO_OK);
    assert_int_equal(gno_scene_set_image(b->scene, &one), GNO_OK);
    camera.fov = 0.01;
    for (int i = 0; i < 10; i++) {
        double x = 0.13 * i - 0.5, slope = 0.2 * 3.141592653589793 * 1.5 * cos(6.283185307179586 * 1.5 * x);
        float rgb[3];
        camera.target[0] = x;
        camera.target[1] = 0.3;
        camera.target[2] = 0;
        assert_int_equal(gno_scene_set_camera(b->scene, &camera), GNO_OK);
        render(b, rgb);
        if (!(fabs((double)rgb[0] - 1 / sqrt(1 + slope * slope)) < 1e-4))
            fail_msg("at %g: %g, slope %g", x, (double)rgb[0], slope);
    }
}

static void test_bad_pattern_is_refused(void **state)
{
    bed *b = *state;
    gno_material m = patterned(GNO_PATTERN_WOOD);
    m.texture.procedural.rings = -1;
    assert_int_equal(gno_scene_add_material(b->scene, &m, NULL), GNO_ERROR_ARGUMENT);
    assert_string_equal(gno_context_message(b->context), "texture: procedural.rings is out of range");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_floor_to_the_horizon, set_up, tear_down),
        cmocka_unit_test(test_pattern_sticks_to_its_object),
        cmocka_unit_test_setup_teardown(test_bump_by_hand, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_bad_pattern_is_refused, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
