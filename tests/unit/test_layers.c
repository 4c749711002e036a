/* test_layers.c -- layers beside the picture: known planes, exact sums, ranked numbers against the oracle's rays, shadow against
 * the colours it explains; the picture is the same with and without them.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "fail_alloc.h"
#include "support/oracle.h"
#include "support/random_scene.h"
#include <math.h>
#include <string.h>

#define WIDTH 48
#define HEIGHT 36
#define PIXELS (WIDTH * HEIGHT)
#define RANKS 32
#define LIGHTS 16

/* Every layer of one picture. */
typedef struct all_layers {
    float rgb[3 * PIXELS], depth[PIXELS], normal[3 * PIXELS], uv[2 * PIXELS], coverage[PIXELS], shadow[LIGHTS * PIXELS];
    unsigned id[3][RANKS * PIXELS];
    float share[3][RANKS * PIXELS];
    gno_layers layers;
} all_layers;

static all_layers first, second;

static void point_layers(all_layers *a)
{
    gno_ranks *ranks[3];
    ranks[0] = &a->layers.polygons;
    ranks[1] = &a->layers.objects;
    ranks[2] = &a->layers.materials;
    a->layers = gno_layers_default();
    a->layers.depth = a->depth;
    a->layers.normal = a->normal;
    a->layers.uv = a->uv;
    a->layers.coverage = a->coverage;
    a->layers.shadow = a->shadow;
    for (int i = 0; i < 3; i++) {
        ranks[i]->count = RANKS;
        ranks[i]->id = a->id[i];
        ranks[i]->coverage = a->share[i];
    }
}

static void render(gno_scene *scene, int base, int lines, int threads, all_layers *a)
{
    gno_render_def def = gno_render_def_default();
    point_layers(a);
    def.base_lines = base;
    def.lines = lines;
    def.threads = threads;
    def.layers = &a->layers;
    assert_int_equal(gno_render(scene, &def, a->rgb, NULL), GNO_OK);
}

static gno_context *new_context(void)
{
    gno_context *context = NULL;
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    return context;
}

/* ---- known planes --------------------------------------------------------------------------------------------------- */

static const double corners[4][3] = {{-40, -40, 0}, {40, -40, 0}, {40, 40, 20}, {-40, 40, 20}};
static const double corner_uv[4][2] = {{0, 0}, {4, 0}, {4, 5}, {0, 5}};
static const int four[4] = {0, 1, 2, 3};

/* One slanted plane that fills the picture: z = (y + 40) / 4, u = (x + 40) / 20, v = (y + 40) / 16. */
static gno_scene *plane_scene(gno_context *context, gno_camera_type type)
{
    gno_scene *scene = NULL;
    gno_mesh_def mesh = gno_mesh_def_default();
    gno_image_def image = gno_image_def_default();
    gno_camera camera = gno_camera_default();
    static const unsigned rings[2] = {0, 4};
    image.width = WIDTH;
    image.height = HEIGHT;
    camera.type = type;
    camera.eye[0] = 1;
    camera.eye[1] = 2;
    camera.eye[2] = 30;
    camera.target[0] = camera.target[1] = camera.target[2] = 0;
    camera.up[0] = camera.up[2] = 0;
    camera.up[1] = 1;
    camera.height = 12;
    mesh.vertex_count = mesh.texcoord_count = mesh.corner_count = 4;
    mesh.positions = corners[0];
    mesh.texcoords = corner_uv[0];
    mesh.polygon_count = mesh.ring_count = 1;
    mesh.ring_start = rings;
    mesh.corner_vertex = mesh.corner_texcoord = four;
    assert_int_equal(gno_scene_create(context, &scene), GNO_OK);
    assert_int_equal(gno_scene_add_mesh(scene, &mesh, NULL), GNO_OK);
    assert_int_equal(gno_scene_set_image(scene, &image), GNO_OK);
    assert_int_equal(gno_scene_set_camera(scene, &camera), GNO_OK);
    return scene;
}

static void unit(double v[3])
{
    double l = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int k = 0; k < 3; k++)
        v[k] /= l;
}

static void cross(const double a[3], const double b[3], double c[3])
{
    for (int k = 0; k < 3; k++)
        c[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static void check_plane_pixel(const gno_camera *camera, int x, int y)
{
    double f[3], r[3], u[3], from[3], way[3], s, z, p[3];
    double scale = camera->type == GNO_CAMERA_ORTHOGRAPHIC ? camera->height / HEIGHT : 2 * tan(camera->fov * acos(-1) / 360) / HEIGHT;
    double across = (x + 0.5 - 0.5 * WIDTH) * scale, up = (0.5 * HEIGHT - y - 0.5) * scale;
    int i = y * WIDTH + x, flat = camera->type == GNO_CAMERA_ORTHOGRAPHIC;
    for (int k = 0; k < 3; k++)
        f[k] = camera->target[k] - camera->eye[k];
    unit(f);
    cross(f, camera->up, r);
    unit(r);
    cross(r, f, u);
    for (int k = 0; k < 3; k++) {
        from[k] = camera->eye[k] + (flat ? across * r[k] + up * u[k] : 0);
        way[k] = f[k] + (flat ? 0 : across * r[k] + up * u[k]);
    }
    /* from + s way on 4 z = y + 40; s is the distance along f in both cases. */
    s = (from[1] + 40 - 4 * from[2]) / (4 * way[2] - way[1]);
    for (int k = 0; k < 3; k++)
        p[k] = from[k] + s * way[k];
    z = sqrt(17);
    assert_true(fabs((double)first.depth[i] - s) < 1e-5 * s);
    assert_true(fabs((double)first.uv[2 * i] - (p[0] + 40) / 20) < 1e-5 && fabs((double)first.uv[2 * i + 1] - (p[1] + 40) / 16) < 1e-5);
    assert_true((double)first.normal[3 * i] == 0 && fabs((double)first.normal[3 * i + 1] + 1 / z) < 1e-6 &&
                fabs((double)first.normal[3 * i + 2] - 4 / z) < 1e-6);
    assert_true(first.coverage[i] == 1 && first.id[0][i * RANKS] == 0 && first.share[0][i * RANKS] == 1 &&
                first.id[0][i * RANKS + 1] == GNO_BACKGROUND && first.share[0][i * RANKS + 1] == 0);
}

static void test_plane(void **state)
{
    (void)state;
    for (int type = 0; type < 2; type++) {
        gno_context *context = new_context();
        gno_scene *scene = plane_scene(context, (gno_camera_type)type);
        gno_camera camera = gno_scene_camera(scene);
        render(scene, 2, 18, 1, &first);
        for (int y = 0; y < HEIGHT; y++)
            for (int x = 0; x < WIDTH; x++)
                check_plane_pixel(&camera, x, y);
        gno_scene_destroy(scene);
        gno_context_destroy(context);
    }
}

static void test_nothing(void **state)
{
    gno_context *context = new_context();
    gno_scene *scene = NULL;
    gno_image_def image = gno_image_def_default();
    gno_light light = gno_light_default();
    (void)state;
    image.width = WIDTH;
    image.height = HEIGHT;
    assert_int_equal(gno_scene_create(context, &scene), GNO_OK);
    assert_int_equal(gno_scene_set_image(scene, &image), GNO_OK);
    assert_int_equal(gno_scene_add_light(scene, "a", &light, NULL), GNO_OK);
    render(scene, 2, 18, 1, &first);
    for (int i = 0; i < PIXELS; i++) {
        assert_true(isinf(first.depth[i]) && first.coverage[i] == 0 && first.shadow[i] == 1);
        assert_true(first.normal[3 * i] == 0 && first.uv[2 * i] == 0);
        assert_true(first.id[1][i * RANKS] == GNO_BACKGROUND && first.share[1][i * RANKS] == 1 && first.share[1][i * RANKS + 1] == 0);
    }
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

/* ---- sums ----------------------------------------------------------------------------------------------------------- */

/* Shares in order, each number once, together 1; the background's share is what coverage leaves. */
static void check_sums(const char *name, int i)
{
    int exact = strcmp(name, "glass") && strcmp(name, "panes") && strcmp(name, "soft") && strcmp(name, "marked"); /* shares of what is seen through others are rounded */
    double slack = exact ? 1.2e-7 : 1e-6;
    for (int set = 0; set < 3; set++) {
        const unsigned *id = first.id[set] + i * RANKS;
        const float *share = first.share[set] + i * RANKS;
        double sum = 0, background = 0;
        for (int k = 0; k < RANKS; k++) {
            sum += (double)share[k];
            background += id[k] == GNO_BACKGROUND ? (double)share[k] : 0;
            if (k > 0 && (share[k] > share[k - 1] || (share[k] == share[k - 1] && share[k] > 0 && id[k] < id[k - 1])))
                fail_msg("%s: pixel %d, set %d: pair %d is out of order", name, i, set, k);
            for (int l = 0; l < k; l++)
                if (id[l] == id[k] && share[k] > 0)
                    fail_msg("%s: pixel %d, set %d: number %u twice", name, i, set, id[k]);
        }
        if (share[RANKS - 1] == 0 && fabs(sum - 1) > RANKS * 0.5 * slack)
            fail_msg("%s: pixel %d, set %d: the shares add up to 1 %+g", name, i, set, sum - 1);
        if (fabs(background + (double)first.coverage[i] - 1) > slack)
            fail_msg("%s: pixel %d, set %d: background %.9g, coverage %.9g", name, i, set, background, (double)first.coverage[i]);
    }
}

static void test_sums(void **state)
{
    (void)state;
    for (int kind = 0; kind < SCENE_KINDS; kind++)
        for (unsigned seed = 1; seed <= 3; seed++) {
            gno_context *context = new_context();
            gno_scene *scene = random_scene(context, (scene_kind)kind, seed, WIDTH, HEIGHT);
            assert_non_null(scene);
            assert_true(gno_scene_count(scene).lights <= LIGHTS);
            render(scene, 2, 18, 2, &first);
            for (int i = 0; i < PIXELS; i++)
                check_sums(scene_kind_name((scene_kind)kind), i);
            gno_scene_destroy(scene);
            gno_context_destroy(context);
        }
}

/* ---- numbers against rays ------------------------------------------------------------------------------------------- */

#define RAYS 12
#define RAYS_AGAIN 60

static double share_of(const unsigned *id, const float *share, unsigned number)
{
    double sum = 0;
    for (int k = 0; k < RANKS; k++)
        sum += id[k] == number ? (double)share[k] : 0;
    return sum;
}

/* The largest difference of a share in pixel (x,y) from what n x n rays count. */
static double count_rays(const oracle *o, int x, int y, int n)
{
    const unsigned *id = first.id[0] + (y * WIDTH + x) * RANKS;
    const float *share = first.share[0] + (y * WIDTH + x) * RANKS;
    unsigned seen[RANKS * 2];
    double count[RANKS * 2], worst = 0;
    int numbers = 0;
    for (int k = 0; k < RANKS; k++)
        if (share[k] > 0) {
            seen[numbers] = id[k];
            count[numbers++] = 0;
        }
    for (int j = 0; j < n * n; j++) {
        long polygon = oracle_look(o, x + (j % n + 0.5) / n, y + (j / n + 0.5) / n).polygon;
        int k = 0;
        while (k < numbers && seen[k] != (polygon < 0 ? GNO_BACKGROUND : (unsigned)polygon))
            k++;
        if (k == numbers && numbers < RANKS * 2) {
            seen[numbers] = polygon < 0 ? GNO_BACKGROUND : (unsigned)polygon;
            count[numbers++] = 0;
        }
        count[k] += 1.0 / (n * n);
    }
    for (int k = 0; k < numbers; k++)
        worst = fmax(worst, fabs(count[k] - share_of(id, share, seen[k])));
    return worst;
}

/* A grid of 12 x 12 rays places an edge to some 1/24 pixel, our 18 lines to 1/36 where it is level. */
static void test_numbers(void **state)
{
    static const scene_kind kinds[] = {SCENE_SOUP, SCENE_BOXES, SCENE_HOLES, SCENE_STARS, SCENE_AROUND, SCENE_SOLIDS};
    (void)state;
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
        gno_context *context = new_context();
        gno_scene *scene = random_scene(context, kinds[k], 7, WIDTH, HEIGHT);
        oracle *o = oracle_create(scene);
        double mean = 0;
        assert_non_null(o);
        render(scene, 2, 18, 2, &first);
        for (int i = 0; i < PIXELS; i += 3) {
            double d = count_rays(o, i % WIDTH, i / WIDTH, RAYS);
            if (d > 0.06)
                d = count_rays(o, i % WIDTH, i / WIDTH, RAYS_AGAIN);
            if (d > 0.06)
                fail_msg("%s: pixel %d,%d: a share is off by %g", scene_kind_name(kinds[k]), i % WIDTH, i / WIDTH, d);
            mean += d * 3 / PIXELS;
        }
        if (mean > 0.006)
            fail_msg("%s: shares are off by %g in the mean", scene_kind_name(kinds[k]), mean);
        oracle_destroy(o);
        gno_scene_destroy(scene);
        gno_context_destroy(context);
    }
}

/* ---- depth and normals against rays ---------------------------------------------------------------------------------- */

/* The polygon that covers most of the pixel; 0 when there is none, or another covers as much. */
static int leader(int i, unsigned *polygon)
{
    const unsigned *id = first.id[0] + i * RANKS;
    const float *share = first.share[0] + i * RANKS;
    int k = id[0] == GNO_BACKGROUND, next = k + 1 + (id[k + 1] == GNO_BACKGROUND && share[k + 1] > 0);
    *polygon = id[k];
    return share[k] > 0 && share[k] > share[next];
}

static void check_normal(gno_scene *scene, const gno_camera *camera, int i, unsigned polygon)
{
    const double n[3] = {(double)first.normal[3 * i], (double)first.normal[3 * i + 1], (double)first.normal[3 * i + 2]};
    double towards = 0;
    gno_polygon p;
    assert_int_equal(gno_scene_polygon(scene, polygon, &p), GNO_OK);
    for (unsigned c = p.ring_start[0]; c + 1 < p.ring_start[1]; c++) {
        const double *a = p.positions + 3 * p.corner_vertex[c], *b = p.positions + 3 * p.corner_vertex[c + 1];
        if (fabs(n[0] * (b[0] - a[0]) + n[1] * (b[1] - a[1]) + n[2] * (b[2] - a[2])) > 1e-5)
            fail_msg("pixel %d: the normal is not that of polygon %u", i, polygon);
    }
    for (int k = 0; k < 3; k++)
        towards += n[k] * (camera->eye[k] - p.positions[3 * p.corner_vertex[p.ring_start[0]] + k]);
    assert_true(towards > 0);
}

static void test_depth_and_normal(void **state)
{
    gno_context *context = new_context();
    gno_scene *scene = random_scene(context, SCENE_BOXES, 3, WIDTH, HEIGHT);
    gno_camera camera = gno_scene_camera(scene);
    oracle *o = oracle_create(scene);
    double f[3];
    int whole = 0, mixed = 0;
    (void)state;
    for (int k = 0; k < 3; k++)
        f[k] = camera.target[k] - camera.eye[k];
    unit(f);
    render(scene, 2, 18, 1, &first);
    for (int i = 0; i < PIXELS; i++) {
        oracle_sample s = oracle_look(o, i % WIDTH + 0.5, i / WIDTH + 0.5);
        unsigned polygon;
        double depth = 0;
        if (!leader(i, &polygon))
            continue;
        check_normal(scene, &camera, i, polygon);
        mixed += first.share[0][i * RANKS] < 1;
        if (first.share[0][i * RANKS] < 1)
            continue;
        whole++;
        for (int k = 0; k < 3; k++)
            depth += (s.point[k] - camera.eye[k]) * f[k];
        assert_true(fabs((double)first.depth[i] - depth) < 1e-5 * depth);
        assert_int_equal(polygon, (unsigned)s.polygon);
    }
    assert_true(whole > PIXELS / 3 && mixed > 100);
    oracle_destroy(o);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

/* ---- shadow ----------------------------------------------------------------------------------------------------------- */

/* White matt boxes under directional lights: a pixel of one polygon has the sum of share times cosine times intensity. */
static void test_shadow(void **state)
{
    static const double a[3] = {-1, -1, 0}, b[3] = {1, 0.5, 1.5}, low[3] = {-9, -9, -1}, high[3] = {9, 9, 0};
    static const double ways[3][3] = {{1, 0.4, -1}, {-0.3, 1, -0.8}, {0.2, 0.1, -1}};
    gno_context *context = new_context();
    gno_scene *scene = NULL;
    gno_image_def image = gno_image_def_default();
    int partial = 0;
    (void)state;
    image.width = WIDTH;
    image.height = HEIGHT;
    assert_int_equal(gno_scene_create(context, &scene), GNO_OK);
    assert_int_equal(gno_scene_set_image(scene, &image), GNO_OK);
    assert_true(add_box(scene, a, b, 0, 0) && add_box(scene, low, high, 0, 0));
    for (int j = 0; j < 3; j++) {
        gno_light light = gno_light_default();
        light.type = GNO_LIGHT_DIRECTIONAL;
        memcpy(light.direction, ways[j], sizeof light.direction);
        for (int k = 0; k < 3; k++)
            light.intensity[k] = j == k;
        assert_int_equal(gno_scene_add_light(scene, "sun", &light, NULL), GNO_OK);
    }
    render(scene, 6, 6, 1, &first);
    for (int i = 0; i < PIXELS; i++)
        for (int j = 0; j < 3 && first.share[0][i * RANKS] == 1; j++) {
            double l = sqrt(ways[j][0] * ways[j][0] + ways[j][1] * ways[j][1] + ways[j][2] * ways[j][2]), cosine = 0;
            float share = first.shadow[j * PIXELS + i];
            for (int k = 0; k < 3; k++)
                cosine -= (double)first.normal[3 * i + k] * ways[j][k] / l;
            partial += share > 0 && share < 1;
            if (fabs((double)first.rgb[3 * i + j] - 0.8 * (double)share * fmax(cosine, 0)) > 2e-6)
                fail_msg("pixel %d, light %d: %g of it arrives, colour %g, cosine %g", i, j, (double)share, (double)first.rgb[3 * i + j],
                         cosine);
        }
    assert_true(partial > 20);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

/* ---- the picture, threads, failures ----------------------------------------------------------------------------------- */

static void test_same(void **state)
{
    static float plain[3 * PIXELS];
    (void)state;
    for (int kind = 0; kind < SCENE_KINDS; kind++) {
        gno_context *context = new_context();
        gno_scene *scene = random_scene(context, (scene_kind)kind, 5, WIDTH, HEIGHT);
        memset(&first, 0, sizeof first);
        memset(&second, 0, sizeof second);
        assert_int_equal(gno_render(scene, NULL, plain, NULL), GNO_OK);
        render(scene, 2, 18, 1, &first);
        render(scene, 2, 18, 3, &second);
        assert_memory_equal(plain, first.rgb, sizeof plain);
        first.layers = second.layers;
        assert_memory_equal(&first, &second, sizeof first);
        gno_scene_destroy(scene);
        gno_context_destroy(context);
    }
}

static void test_arguments(void **state)
{
    gno_context *context = new_context();
    gno_scene *scene = plane_scene(context, GNO_CAMERA_PERSPECTIVE);
    gno_render_def def = gno_render_def_default();
    (void)state;
    point_layers(&first);
    def.layers = &first.layers;
    first.layers.objects.count = 0;
    assert_int_equal(gno_render(scene, &def, first.rgb, NULL), GNO_ERROR_ARGUMENT);
    assert_non_null(strstr(gno_context_message(context), "objects.count"));
    point_layers(&first);
    first.layers.materials.coverage = NULL;
    assert_int_equal(gno_render(scene, &def, first.rgb, NULL), GNO_ERROR_ARGUMENT);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

static void test_every_allocation_fails(void **state)
{
    (void)state;
    for (size_t at = 1, done = 0; !done; at++) {
        fail_alloc alloc = {0};
        gno_context_def context_def = fail_alloc_def(&alloc);
        gno_render_def def = gno_render_def_default();
        gno_context *context;
        gno_scene *scene;
        gno_status status;
        gno_light light = gno_light_default();
        assert_int_equal(gno_context_create(&context_def, &context), GNO_OK);
        scene = plane_scene(context, GNO_CAMERA_PERSPECTIVE);
        assert_int_equal(gno_scene_add_light(scene, NULL, &light, NULL), GNO_OK);
        point_layers(&first);
        def.layers = &first.layers;
        def.threads = 1;
        alloc.fail_at = alloc.calls + at;
        status = gno_render(scene, &def, first.rgb, NULL);
        done = status == GNO_OK;
        assert_true(done || status == GNO_ERROR_MEMORY);
        gno_scene_destroy(scene);
        gno_context_destroy(context);
        assert_int_equal(alloc.held, 0);
        assert_false(alloc.wrong_size);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_plane),   cmocka_unit_test(test_nothing),          cmocka_unit_test(test_sums),
        cmocka_unit_test(test_numbers), cmocka_unit_test(test_depth_and_normal), cmocka_unit_test(test_shadow),
        cmocka_unit_test(test_same),    cmocka_unit_test(test_arguments),        cmocka_unit_test(test_every_allocation_fails)};
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
