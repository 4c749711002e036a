/* test_glint.c -- highlights within one pixel against their mean over it, taken in very many points.
 * Place: tests of src/engine/tile_glint.c through the public interface.
 *
 * A square patch of n x n cells, two triangles each, is seen from above in one pixel that it fills, and lit from above. Its normals, made unit
 * at the cells' corners, are those of a dome about a place in or near the pixel.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <gnomon/gnomon.h>
#include <math.h>
#include <string.h>

#define MOST_CELLS 4
#define DIFFUSE 0.3
#define SPECULAR 0.6

typedef struct dome {
    int cells;
    double x, y;  /* its top, the pixel being [0,1)^2 */
    double bend;  /* the normal's slope by distance from the top */
    double shininess;
} dome;

static void normal_at(const dome *d, double x, double y, double n[3])
{
    double length;
    n[0] = d->bend * (x - d->x);
    n[1] = d->bend * (y - d->y);
    n[2] = 1;
    length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int k = 0; k < 3; k++)
        n[k] /= length;
}

/* What the point (x,y) shows: the formulas of the lighting model with the light and the viewer straight above. */
static double lit_at(const dome *d, double x, double y)
{
    int i = (int)(x * d->cells), j = (int)(y * d->cells);
    double u = x * d->cells - i, v = y * d->cells - j, corner[4][3], n[3], length = 0, cosine, mirror;
    for (int c = 0; c < 4; c++)
        normal_at(d, (double)(i + c % 2) / d->cells, (double)(j + c / 2) / d->cells, corner[c]);
    for (int k = 0; k < 3; k++) {
        /* Triangles 0 1 3 and 0 3 2. */
        n[k] = u > v ? corner[0][k] * (1 - u) + corner[1][k] * (u - v) + corner[3][k] * v
                     : corner[0][k] * (1 - v) + corner[3][k] * u + corner[2][k] * (v - u);
        length += n[k] * n[k];
    }
    cosine = n[2] / sqrt(length);
    mirror = 2 * cosine * cosine - 1;
    return DIFFUSE * cosine + (mirror > 0 ? SPECULAR * pow(mirror, d->shininess) : 0);
}

static double mean_of(const dome *d)
{
    enum { STEPS = 240 };
    double sum = 0;
    for (int i = 0; i < STEPS; i++)
        for (int j = 0; j < STEPS; j++)
            sum += lit_at(d, (i + 0.5) / STEPS, (j + 0.5) / STEPS);
    return sum / (STEPS * STEPS);
}

static void add_patch(gno_scene *scene, const dome *d, int material)
{
    enum { SIDE = MOST_CELLS + 1 };
    double positions[SIDE * SIDE * 3], normals[SIDE * SIDE * 3];
    int corners[6 * MOST_CELLS * MOST_CELLS], side = d->cells + 1;
    unsigned rings[2 * MOST_CELLS * MOST_CELLS + 1], count = 0;
    gno_mesh_def mesh = gno_mesh_def_default();
    for (int v = 0; v < side * side; v++) {
        positions[3 * v] = (double)(v % side) / d->cells;
        positions[3 * v + 1] = (double)(v / side) / d->cells;
        positions[3 * v + 2] = 0;
        normal_at(d, positions[3 * v], positions[3 * v + 1], normals + 3 * v);
    }
    rings[0] = 0;
    for (int c = 0; c < d->cells * d->cells; c++) {
        int a = c / d->cells * side + c % d->cells;
        const int six[6] = {a, a + 1, a + side + 1, a, a + side + 1, a + side};
        memcpy(corners + 6 * c, six, sizeof six);
        for (int t = 0; t < 2; t++, count++)
            rings[count + 1] = 3 * (count + 1);
    }
    mesh.vertex_count = mesh.normal_count = (size_t)(side * side);
    mesh.positions = positions;
    mesh.normals = normals;
    mesh.polygon_count = mesh.ring_count = count;
    mesh.corner_count = 3 * (size_t)count;
    mesh.ring_start = rings;
    mesh.corner_vertex = mesh.corner_normal = corners;
    mesh.material = material;
    mesh.shading = (int)GNO_SHADING_PHONG;
    assert_int_equal(gno_scene_add_mesh(scene, &mesh, NULL), GNO_OK);
}

static double shown(const dome *d)
{
    const gno_image_def image = {1, 1, {0, 0, 0}};
    gno_material material = gno_material_default();
    gno_light light = gno_light_default();
    gno_camera camera = gno_camera_default();
    gno_context *context;
    gno_scene *scene;
    int index;
    float rgb[3];
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    assert_int_equal(gno_scene_create(context, &scene), GNO_OK);
    for (int k = 0; k < 3; k++) {
        material.diffuse[k] = DIFFUSE;
        material.specular[k] = SPECULAR;
        light.direction[k] = k == 2 ? -1 : 0;
        camera.eye[k] = k == 2 ? 5 : 0.5;
        camera.target[k] = k == 2 ? 0 : 0.5;
        camera.up[k] = k == 1;
    }
    material.shininess = d->shininess;
    light.type = GNO_LIGHT_DIRECTIONAL;
    camera.type = GNO_CAMERA_ORTHOGRAPHIC;
    camera.height = 1;
    assert_int_equal(gno_scene_add_material(scene, &material, &index), GNO_OK);
    add_patch(scene, d, index);
    assert_int_equal(gno_scene_add_light(scene, NULL, &light, NULL), GNO_OK);
    assert_int_equal(gno_scene_set_camera(scene, &camera), GNO_OK);
    assert_int_equal(gno_scene_set_image(scene, &image), GNO_OK);
    assert_int_equal(gno_render(scene, NULL, rgb, NULL), GNO_OK);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
    return (double)rgb[0];
}

/* From highlights wider than ten pixels to one narrower than a quarter of a pixel; what one point would show is off by up to a third. */
static void test_means(void **state)
{
    static const double bends[5] = {0.03, 0.1, 0.25, 0.5, 0.8}, tops[4][2] = {{0.5, 0.5}, {0.3, 0.6}, {1.1, 0.4}, {-0.4, 1.3}};
    double worst_of_one = 0;
    (void)state;
    for (int b = 0; b < 5; b++)
        for (int t = 0; t < 4; t++)
            for (int cells = 1; cells <= MOST_CELLS; cells++) {
                const dome d = {cells, tops[t][0], tops[t][1], bends[b], 30};
                double mean = mean_of(&d), got = shown(&d), one = fabs(lit_at(&d, 0.5, 0.5) - mean);
                worst_of_one = one > worst_of_one ? one : worst_of_one;
                if (!(fabs(got - mean) < (b < 3 ? 0.012 : 0.03)))
                    fail_msg("bend %g, top (%g,%g), %d cells: %.5f is not %.5f", d.bend, d.x, d.y, cells, got, mean);
            }
    assert_true(worst_of_one > 0.3);
}

/* Where nothing bends all points of a pixel are one: the same bits as of a flat polygon. */
static void test_even(void **state)
{
    const dome even = {1, 0.5, 0.5, 0, 30}, cut = {3, 0.5, 0.5, 0, 30};
    (void)state;
    assert_true(fabs(shown(&even) - (DIFFUSE + SPECULAR)) < 1e-6);
    assert_true(fabs(shown(&cut) - (DIFFUSE + SPECULAR)) < 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_means), cmocka_unit_test(test_even)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
