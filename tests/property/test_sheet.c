/* test_sheet.c -- shadows of closed solids and of such as stand open on a plane, found by the contours of their far sides, against the same solids of a
 * material that lets a billionth of the light through: such solids are not halved, and every polygon casts for itself. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <gnomon/gnomon.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define WIDTH 96
#define HEIGHT 72
#define PI 3.14159265358979323846

static uint32_t next_random(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

static double uniform(uint32_t *seed, double a, double b) { return a + (b - a) * (double)next_random(seed) / 16777216.0; }

/* ---- solids: positions and polygons, wound outwards ---------------------------------------------------------------- */

#define MOST 4000
typedef struct solid {
    size_t vertices, polygons, corners;
    double p[MOST][3];
    unsigned ring[MOST + 1];
    int corner[4 * MOST];
} solid;

static void add_polygon(solid *s, const int *v, int n)
{
    for (int i = 0; i < n; i++)
        s->corner[s->corners++] = v[i];
    s->ring[++s->polygons] = (unsigned)s->corners;
}

static int add_vertex(solid *s, double x, double y, double z)
{
    s->p[s->vertices][0] = x;
    s->p[s->vertices][1] = y;
    s->p[s->vertices][2] = z;
    return (int)s->vertices++;
}

/* A prism over a ring of n points, counter-clockwise, from z = 0 to 1; lids as n-gons; open: without the lower one. */
static void make_prism(solid *s, int n, double (*ring)[2], int open)
{
    int top[64], bottom[64];
    for (int i = 0; i < n; i++) {
        bottom[n - 1 - i] = add_vertex(s, ring[i][0], ring[i][1], 0);
        top[i] = add_vertex(s, ring[i][0], ring[i][1], 1);
    }
    add_polygon(s, top, n);
    if (!open)
        add_polygon(s, bottom, n);
    for (int i = 0; i < n; i++) {
        int j = (i + 1) % n, side[4] = {2 * i, 2 * j, 2 * j + 1, 2 * i + 1};
        add_polygon(s, side, 4);
    }
}

static void make_star(solid *s, int tips, double inner, int open)
{
    double ring[64][2];
    for (int i = 0; i < 2 * tips; i++) {
        double r = i & 1 ? inner : 1, a = PI * i / tips + 0.1;
        ring[i][0] = r * cos(a);
        ring[i][1] = r * sin(a);
    }
    make_prism(s, 2 * tips, ring, open);
}

/* A torus of triangles, standing on z = 0, bumpy so that its contour is ragged. */
static void make_torus(solid *s, int m, int n, double thick, double bump, uint32_t *seed)
{
    for (int i = 0; i < m; i++)
        for (int j = 0; j < n; j++) {
            double a = 2 * PI * i / m, b = 2 * PI * j / n, r = thick * (1 + bump * uniform(seed, -1, 1));
            add_vertex(s, (1 - thick + r * cos(b)) * cos(a), (1 - thick + r * cos(b)) * sin(a), thick + r * sin(b));
        }
    for (int i = 0; i < m; i++)
        for (int j = 0; j < n; j++) {
            int a = i * n + j, b = (i + 1) % m * n + j, c = (i + 1) % m * n + (j + 1) % n, d = i * n + (j + 1) % n;
            int t0[3] = {a, b, c}, t1[3] = {a, c, d};
            add_polygon(s, t0, 3);
            add_polygon(s, t1, 3);
        }
}

static void make_solid(solid *s, uint32_t *seed)
{
    double square[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    memset(s, 0, offsetof(solid, p));
    s->ring[0] = 0;
    switch (next_random(seed) % 6) {
    case 0:
    case 1: make_prism(s, 4, square, next_random(seed) & 1); break;
    case 2:
    case 3: make_star(s, 3 + (int)(next_random(seed) % 4), uniform(seed, 0.3, 0.7), next_random(seed) & 1); break;
    case 4: make_torus(s, 12, 8, 0.35, 0, seed); break;
    default: make_torus(s, 30, 16, 0.3, 0.3, seed); break;
    }
}

/* ---- scenes -------------------------------------------------------------------------------------------------------- */

static void place(gno_mesh_def *mesh, int how, uint32_t *seed)
{
    double a = uniform(seed, 0, 2 * PI), sx = uniform(seed, 0.3, 1.2), sy = uniform(seed, 0.3, 1.2), sz = uniform(seed, 0.3, 2), tilt = 0;
    double x = uniform(seed, -3, 3), y = uniform(seed, -3, 3), z = 0;
    if (how == 1) /* through the ground */
        z = -uniform(seed, 0, 1);
    if (how == 2) { /* in the air, tilted */
        z = uniform(seed, 1, 3);
        tilt = uniform(seed, -1, 1);
    }
    if (how == 3) /* mirrored, so that it is wound inwards */
        sx = -sx;
    mesh->transform[0] = sx * cos(a);
    mesh->transform[1] = -sy * sin(a);
    mesh->transform[4] = sx * sin(a);
    mesh->transform[5] = sy * cos(a);
    mesh->transform[8] = sx * tilt;
    mesh->transform[9] = sy * tilt;
    mesh->transform[10] = sz;
    mesh->transform[3] = x;
    mesh->transform[7] = y;
    mesh->transform[11] = z;
}

static void add_ground(gno_scene *scene)
{
    static const double p[12] = {-8, -8, 0, 8, -8, 0, 8, 8, 0, -8, 8, 0};
    static const unsigned ring[2] = {0, 4};
    static const int corners[4] = {0, 1, 2, 3};
    gno_mesh_def mesh = gno_mesh_def_default();
    mesh.vertex_count = mesh.corner_count = 4;
    mesh.positions = p;
    mesh.polygon_count = mesh.ring_count = 1;
    mesh.ring_start = ring;
    mesh.corner_vertex = corners;
    assert_int_equal(gno_scene_add_mesh(scene, &mesh, NULL), GNO_OK);
}

static void add_lights(gno_scene *scene, uint32_t *seed)
{
    gno_light light = gno_light_default();
    light.type = (gno_light_type)(next_random(seed) % 3);
    light.position[0] = uniform(seed, -6, 6);
    light.position[1] = uniform(seed, -6, 6);
    light.position[2] = uniform(seed, 5, 9);
    light.direction[0] = light.type == GNO_LIGHT_SPOT ? -light.position[0] : uniform(seed, -1, 1);
    light.direction[1] = light.type == GNO_LIGHT_SPOT ? -light.position[1] : uniform(seed, -1, 1);
    light.direction[2] = light.type == GNO_LIGHT_SPOT ? -light.position[2] : -1;
    light.angle = 50;
    assert_int_equal(gno_scene_add_light(scene, NULL, &light, NULL), GNO_OK);
}

static gno_scene *make_scene(gno_context *context, uint32_t seed, double transmission)
{
    static solid s;
    gno_material material = gno_material_default();
    gno_camera camera = gno_camera_default();
    gno_image_def image = gno_image_def_default();
    gno_scene *scene;
    int number, index;
    assert_int_equal(gno_scene_create(context, &scene), GNO_OK);
    for (int k = 0; k < 3; k++)
        material.transmission[k] = transmission;
    assert_int_equal(gno_scene_add_material(scene, &material, &index), GNO_OK);
    add_ground(scene);
    number = 1 + (int)(next_random(&seed) % 8);
    for (int i = 0; i < number; i++) {
        gno_mesh_def mesh = gno_mesh_def_default();
        make_solid(&s, &seed);
        mesh.vertex_count = s.vertices;
        mesh.positions = &s.p[0][0];
        mesh.polygon_count = mesh.ring_count = s.polygons;
        mesh.ring_start = s.ring;
        mesh.corner_count = s.corners;
        mesh.corner_vertex = s.corner;
        mesh.material = index;
        place(&mesh, (int)(next_random(&seed) % 4), &seed);
        assert_int_equal(gno_scene_add_mesh(scene, &mesh, NULL), GNO_OK);
    }
    add_lights(scene, &seed);
    add_lights(scene, &seed);
    camera.eye[0] = uniform(&seed, -5, 5);
    camera.eye[1] = -9;
    camera.eye[2] = uniform(&seed, 4, 8);
    if (next_random(&seed) % 3 == 0) {
        camera.type = GNO_CAMERA_ORTHOGRAPHIC;
        camera.height = 9;
        camera.eye[2] = 14;
        camera.eye[1] = -14;
    }
    assert_int_equal(gno_scene_set_camera(scene, &camera), GNO_OK);
    image.width = WIDTH;
    image.height = HEIGHT;
    assert_int_equal(gno_scene_set_image(scene, &image), GNO_OK);
    return scene;
}

/* Number of pixels that differ by more than the place at which a lit part is shaded makes (its middle; what lets a billionth through
 * counts as lit). */
static int compare(const float *a, const float *b)
{
    int n = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        float d = 0;
        for (int k = 0; k < 3; k++)
            d = fmaxf(d, fabsf(a[3 * i + k] - b[3 * i + k]));
        n += d > 5e-3f;
    }
    return n;
}

static int differences(uint32_t seed)
{
    static float sheets[WIDTH * HEIGHT * 3], apart[WIDTH * HEIGHT * 3];
    gno_render_def how = gno_render_def_default();
    how.lines = how.base_lines = 3;
    how.threads = 1;
    for (int as_sheets = 0; as_sheets < 2; as_sheets++) {
        gno_context *context;
        gno_scene *scene;
        assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
        scene = make_scene(context, seed, as_sheets ? 0 : 1e-9);
        assert_int_equal(gno_render(scene, &how, as_sheets ? sheets : apart, NULL), GNO_OK);
        gno_scene_destroy(scene);
        gno_context_destroy(context);
    }
    return compare(sheets, apart);
}

static void test_sheets_agree(void **state)
{
    int wrong = 0;
    (void)state;
    for (uint32_t seed = 1; seed <= 60; seed++) {
        int n = differences(seed * 7919u);
        if (n)
            print_message("seed %u: %d pixels differ\n", seed, n);
        wrong += n;
    }
    assert_int_equal(wrong, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_sheets_agree)};
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
