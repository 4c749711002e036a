/* test_watertight.c -- closed bodies, turned and moved at random, let nothing through: no colour of what lies behind or within, no
 * light through their edges, from outside and from inside. GNOMON_VIEWS: number of views of each kind (default 60). */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "support/solids.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH 64
#define HEIGHT 48
#define PI 3.14159265358979323846

static float picture[WIDTH * HEIGHT * 3];

static uint32_t views(void)
{
    const char *text = getenv("GNOMON_VIEWS");
    return text && atol(text) > 0 ? (uint32_t)atol(text) : 60;
}

/* A random turn, with a size and a place. */
static void set_transform(double m[12], double size, const double at[3], uint32_t *seed)
{
    double a = solid_uniform(seed, 0, 2 * PI), b = solid_uniform(seed, 0, 2 * PI), c = acos(solid_uniform(seed, -1, 1));
    double ca = cos(a), sa = sin(a), cb = cos(b), sb = sin(b), cc = cos(c), sc = sin(c);
    const double r[9] = {ca * cc * cb - sa * sb, -ca * cc * sb - sa * cb, ca * sc, sa * cc * cb + ca * sb, -sa * cc * sb + ca * cb,
                         sa * sc,                -sc * cb,                sc * sb, cc};
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            m[4 * i + k] = size * r[3 * i + k];
        m[4 * i + 3] = at[i];
    }
}

/* White where seen by ambient light alone; red: only its red. */
static int add_material(gno_scene *scene, int red)
{
    gno_material m = gno_material_default();
    int index;
    for (int k = 0; k < 3; k++) {
        m.ambient[k] = !red || k == 0;
        m.diffuse[k] = 1;
    }
    assert_int_equal(gno_scene_add_material(scene, &m, &index), GNO_OK);
    return index;
}

static void look(gno_scene *scene, const double eye[3], const double target[3], double fov, const double background[3])
{
    gno_camera camera = gno_camera_default();
    gno_image_def image = gno_image_def_default();
    const double ambient[3] = {1, 1, 1};
    memcpy(camera.eye, eye, sizeof camera.eye);
    memcpy(camera.target, target, sizeof camera.target);
    camera.fov = fov;
    image.width = WIDTH;
    image.height = HEIGHT;
    memcpy(image.background, background, sizeof image.background);
    assert_int_equal(gno_scene_set_camera(scene, &camera), GNO_OK);
    assert_int_equal(gno_scene_set_image(scene, &image), GNO_OK);
    assert_int_equal(gno_scene_set_ambient(scene, ambient), GNO_OK);
}

static void add_lamp(gno_scene *scene, double distance, uint32_t *seed)
{
    gno_light light = gno_light_default();
    double a = solid_uniform(seed, 0, 2 * PI), z = solid_uniform(seed, -1, 1), r = sqrt(1 - z * z);
    light.type = solid_random(seed) & 1 ? GNO_LIGHT_DIRECTIONAL : GNO_LIGHT_POINT;
    light.position[0] = distance * r * cos(a);
    light.position[1] = distance * r * sin(a);
    light.position[2] = distance * z;
    for (int k = 0; k < 3; k++)
        light.direction[k] = -light.position[k];
    assert_int_equal(gno_scene_add_light(scene, NULL, &light, NULL), GNO_OK);
}

/* Values of the picture that are not `wanted`. */
static int count_wrong(gno_scene *scene, const double wanted[3], uint32_t seed)
{
    gno_render_def how = gno_render_def_default();
    int wrong = 0;
    if (seed & 1)
        how.lines = how.base_lines = 1 + (int)(seed >> 1 & 3);
    assert_int_equal(gno_render(scene, &how, picture, NULL), GNO_OK);
    for (int i = 0; i < WIDTH * HEIGHT * 3; i++)
        wrong += !(fabs((double)picture[i] - wanted[i % 3]) < 1e-6);
    return wrong;
}

typedef int view_fn(gno_scene *scene, solid *s, uint32_t seed);

static void run(const char *what, view_fn *view)
{
    static solid s;
    gno_context *context;
    uint32_t count = views(), leaking = 0;
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    for (uint32_t i = 0; i < count; i++) {
        gno_scene *scene;
        int wrong;
        assert_int_equal(gno_scene_create(context, &scene), GNO_OK);
        wrong = view(scene, &s, 7919u * i + 13);
        if (wrong)
            print_message("%s, view %u: %d values are wrong\n", what, i, wrong);
        leaking += wrong > 0;
        gno_scene_destroy(scene);
    }
    print_message("%s: %u views, %u leaking\n", what, count, leaking);
    gno_context_destroy(context);
    assert_int_equal(leaking, 0);
}

/* Radius of the middle line of a ring's tube, 0 for a prism; its height is 1 less that, a prism's middle is at 1/2. */
static double tube_of(const solid *s) { return s->polygons > 300 ? 0.7 : s->polygons > 100 ? 0.65 : 0; }

static double middle_height(const solid *s) { return tube_of(s) > 0 ? 1 - tube_of(s) : 0.5; }

/* Moves a corner towards the middle line. */
static void shrink(double p[3], double tube)
{
    double r = sqrt(p[0] * p[0] + p[1] * p[1]), k = (tube + 0.4 * (r - tube)) / r, z = tube > 0 ? 1 - tube : 0.5;
    p[0] *= k;
    p[1] *= k;
    p[2] = z + 0.4 * (p[2] - z);
}

/* A white body before a white background, and a red one of the same shape within: no red may be seen. */
static int from_outside(gno_scene *scene, solid *s, uint32_t seed)
{
    const double white[3] = {1, 1, 1}, target[3] = {0, 0, 0.5};
    int pale = add_material(scene, 0), red = add_material(scene, 1);
    double at[3], eye[3] = {solid_uniform(&seed, -4, 4), -5, solid_uniform(&seed, -4, 4)};
    gno_mesh_def mesh;
    uint32_t same = seed;
    for (int inner = 0; inner < 2; inner++) {
        seed = same;
        solid_make(s, &seed, 0);
        for (size_t i = 0; i < s->vertices && inner; i++)
            shrink(s->p[i], tube_of(s));
        for (int k = 0; k < 3; k++)
            at[k] = solid_uniform(&seed, -1, 1);
        mesh = solid_mesh(s);
        set_transform(mesh.transform, solid_uniform(&seed, 0.3, 1.5), at, &seed);
        mesh.material = inner ? red : pale;
        assert_int_equal(gno_scene_add_mesh(scene, &mesh, NULL), GNO_OK);
    }
    look(scene, eye, target, 50, white);
    return count_wrong(scene, white, seed);
}

/* The eye within a body, lamps outside: nothing but ambient light, and no background. */
static int from_inside(gno_scene *scene, solid *s, uint32_t seed)
{
    const double white[3] = {1, 1, 1}, red[3] = {1, 0, 0};
    double at[3], m[12], eye[3], target[3], middle[3] = {0, 0, 0};
    gno_mesh_def mesh;
    solid_make(s, &seed, 0);
    for (int k = 0; k < 3; k++)
        at[k] = solid_uniform(&seed, -1, 1);
    set_transform(m, solid_uniform(&seed, 0.5, 1.5), at, &seed);
    middle[0] = tube_of(s);
    middle[2] = middle_height(s);
    for (int i = 0; i < 3; i++) {
        eye[i] = m[4 * i] * middle[0] + m[4 * i + 1] * middle[1] + m[4 * i + 2] * middle[2] + m[4 * i + 3];
        target[i] = eye[i] + solid_uniform(&seed, -1, 1);
    }
    mesh = solid_mesh(s);
    memcpy(mesh.transform, m, sizeof m);
    mesh.material = add_material(scene, 0);
    assert_int_equal(gno_scene_add_mesh(scene, &mesh, NULL), GNO_OK);
    add_lamp(scene, 9, &seed);
    add_lamp(scene, 9, &seed);
    look(scene, eye, target, 100, red);
    return count_wrong(scene, white, seed);
}

/* A lamp within a body, the eye outside: the body and the ground under it get nothing of it. */
static int holds_light(gno_scene *scene, solid *s, uint32_t seed)
{
    const double white[3] = {1, 1, 1}, target[3] = {0, 0, 0}, eye[3] = {2, -6, 3};
    static const double ground[12] = {-90, -90, -4, 90, -90, -4, 90, 90, -4, -90, 90, -4};
    static const unsigned ring[2] = {0, 4};
    static const int corners[4] = {0, 1, 2, 3};
    double middle[3] = {0, 0, 0}, at[3];
    gno_light light = gno_light_default();
    gno_mesh_def mesh = gno_mesh_def_default(), floor_mesh = mesh;
    int material = add_material(scene, 0);
    solid_make(s, &seed, 0);
    mesh = solid_mesh(s);
    for (int k = 0; k < 3; k++)
        at[k] = solid_uniform(&seed, -1, 1);
    set_transform(mesh.transform, solid_uniform(&seed, 0.5, 1.5), at, &seed);
    middle[0] = tube_of(s);
    middle[2] = middle_height(s);
    for (int i = 0; i < 3; i++)
        light.position[i] = mesh.transform[4 * i] * middle[0] + mesh.transform[4 * i + 1] * middle[1] +
                            mesh.transform[4 * i + 2] * middle[2] + mesh.transform[4 * i + 3];
    mesh.material = floor_mesh.material = material;
    floor_mesh.vertex_count = floor_mesh.corner_count = 4;
    floor_mesh.positions = ground;
    floor_mesh.polygon_count = floor_mesh.ring_count = 1;
    floor_mesh.ring_start = ring;
    floor_mesh.corner_vertex = corners;
    assert_int_equal(gno_scene_add_mesh(scene, &floor_mesh, NULL), GNO_OK);
    assert_int_equal(gno_scene_add_mesh(scene, &mesh, NULL), GNO_OK);
    assert_int_equal(gno_scene_add_light(scene, NULL, &light, NULL), GNO_OK);
    look(scene, eye, target, 60, white);
    return count_wrong(scene, white, seed);
}

static void test_from_outside(void **state)
{
    (void)state;
    run("closed from outside", from_outside);
}

static void test_from_inside(void **state)
{
    (void)state;
    run("closed from inside", from_inside);
}

static void test_holds_light(void **state)
{
    (void)state;
    run("light held inside", holds_light);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_from_outside), cmocka_unit_test(test_from_inside),
                                       cmocka_unit_test(test_holds_light)};
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
