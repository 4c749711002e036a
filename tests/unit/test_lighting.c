/* test_lighting.c -- every term of the lighting model and every shading, rendered, against values worked by hand. Place: tests of
 * src/shade and src/engine through the public interface.
 *
 * The picture is one pixel of a hundredth of a degree, so that what it shows is the target point.
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

#define DEGREE 0.017453292519943295

typedef struct bed {
    gno_context *context;
    gno_scene *scene;
} bed;

static int set_up(void **state)
{
    bed *b = calloc(1, sizeof *b);
    const gno_image_def image = {1, 1, {0, 0, 0}};
    *state = b;
    return !b || gno_context_create(NULL, &b->context) != GNO_OK || gno_scene_create(b->context, &b->scene) != GNO_OK ||
           gno_scene_set_image(b->scene, &image) != GNO_OK;
}

static int tear_down(void **state)
{
    bed *b = *state;
    gno_scene_destroy(b->scene);
    gno_context_destroy(b->context);
    free(b);
    return 0;
}

/* Starts again with an empty scene. */
static void clear(bed *b)
{
    const gno_image_def image = {1, 1, {0, 0, 0}};
    gno_scene_destroy(b->scene);
    assert_int_equal(gno_scene_create(b->context, &b->scene), GNO_OK);
    assert_int_equal(gno_scene_set_image(b->scene, &image), GNO_OK);
}

static void set3(double v[3], double x, double y, double z)
{
    v[0] = x;
    v[1] = y;
    v[2] = z;
}

static void look(bed *b, double ex, double ey, double ez, double tx, double ty, double tz)
{
    gno_camera camera = gno_camera_default();
    set3(camera.eye, ex, ey, ez);
    set3(camera.target, tx, ty, tz);
    set3(camera.up, 0.1, 1, 0.2);
    camera.fov = 0.01;
    assert_int_equal(gno_scene_set_camera(b->scene, &camera), GNO_OK);
}

/* Seen along a direction, the target in the middle. */
static void look_parallel(bed *b, double ex, double ey, double ez, double tx, double ty, double tz)
{
    gno_camera camera;
    look(b, ex, ey, ez, tx, ty, tz);
    camera = gno_scene_camera(b->scene);
    camera.type = GNO_CAMERA_ORTHOGRAPHIC;
    camera.height = 1e-4;
    assert_int_equal(gno_scene_set_camera(b->scene, &camera), GNO_OK);
}

/* The matt grey one: ka 0.5, kd 0.4, no highlight. */
static gno_material matt(void)
{
    gno_material m = gno_material_default();
    set3(m.ambient, 0.5, 0.5, 0.5);
    set3(m.diffuse, 0.4, 0.4, 0.4);
    return m;
}

static int add_material(bed *b, const gno_material *m)
{
    int index = -1;
    assert_int_equal(gno_scene_add_material(b->scene, m, &index), GNO_OK);
    return index;
}

/* The square -2..2 at height z, facing up. */
static void add_square_at(bed *b, double z, const gno_material *m)
{
    const double positions[12] = {-2, -2, z, 2, -2, z, 2, 2, z, -2, 2, z};
    static const int corners[4] = {0, 1, 2, 3};
    static const unsigned rings[2] = {0, 4};
    gno_mesh_def mesh = gno_mesh_def_default();
    mesh.vertex_count = mesh.corner_count = 4;
    mesh.positions = positions;
    mesh.polygon_count = mesh.ring_count = 1;
    mesh.ring_start = rings;
    mesh.corner_vertex = corners;
    mesh.material = add_material(b, m);
    assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, NULL), GNO_OK);
}

static void add_square(bed *b, const gno_material *m)
{
    add_square_at(b, 0, m);
}

static gno_light point_light(double x, double y, double z)
{
    gno_light l = gno_light_default();
    set3(l.position, x, y, z);
    return l;
}

/* Light that arrives at `angle` degrees from the vertical, from the side of -x. */
static gno_light far_light(double angle)
{
    gno_light l = gno_light_default();
    l.type = GNO_LIGHT_DIRECTIONAL;
    set3(l.direction, sin(angle * DEGREE), 0, -cos(angle * DEGREE));
    return l;
}

static void add_light(bed *b, const gno_light *l)
{
    assert_int_equal(gno_scene_add_light(b->scene, NULL, l, NULL), GNO_OK);
}

static void assert_near(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance))
        fail_msg("%.9g is not within %g of %.9g", a, tolerance, b);
}

static void assert_pixel(bed *b, double red, double green, double blue)
{
    float rgb[3];
    double expected[3] = {red, green, blue};
    assert_int_equal(gno_render(b->scene, NULL, rgb, NULL), GNO_OK);
    for (int k = 0; k < 3; k++)
        assert_near((double)rgb[k], expected[k], 2e-6 + 5e-6 * fabs(expected[k]));
}

static void assert_grey(bed *b, double grey)
{
    assert_pixel(b, grey, grey, grey);
}

/* ---- terms --------------------------------------------------------------------------------------------------------- */

/* Ia ka, channel by channel. */
static void test_ambient(void **state)
{
    bed *b = *state;
    gno_material m = matt();
    const double ambient[3] = {0.2, 0.4, 2};
    set3(m.ambient, 0.5, 0.25, 0.1);
    add_square(b, &m);
    assert_int_equal(gno_scene_set_ambient(b->scene, ambient), GNO_OK);
    look(b, 1, 2, 3, 0, 0, 0);
    assert_pixel(b, 0.1, 0.1, 0.2);
}

/* Il kd cos: 60 degrees give a half; 90 and more nothing. The place of the viewer does not matter. */
static void test_diffuse(void **state)
{
    bed *b = *state;
    static const double angles[4] = {0, 60, 90, 120}, cosines[4] = {1, 0.5, 0, 0};
    for (int i = 0; i < 4; i++) {
        gno_material m = matt();
        gno_light l = far_light(angles[i]);
        clear(b);
        set3(m.diffuse, 0.4, 0.8, 0.1);
        set3(l.intensity, 0.5, 1, 3);
        add_square(b, &m);
        add_light(b, &l);
        look(b, 1, 2, 3, 0, 0, 0);
        assert_pixel(b, 0.2 * cosines[i], 0.8 * cosines[i], 0.3 * cosines[i]);
        look(b, -4, 1, 0.5, 0, 0, 0);
        assert_pixel(b, 0.2 * cosines[i], 0.8 * cosines[i], 0.3 * cosines[i]);
    }
}

/* Il ks cos^n of the angle between mirror direction and viewer: light from 30 degrees, viewer at 30 + `off` on the other side. */
static void test_specular(void **state)
{
    bed *b = *state;
    static const double off[4] = {0, 10, -25, 50}, shininess[4] = {1, 7, 50, 300};
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) {
            gno_material m = matt();
            gno_light l = far_light(30);
            double a = (30 + off[i]) * DEGREE, expected = pow(cos(off[i] * DEGREE), shininess[j]);
            clear(b);
            set3(m.diffuse, 0, 0, 0);
            set3(m.specular, 0.5, 0.25, 1);
            m.shininess = shininess[j];
            set3(l.intensity, 1, 2, 0.1);
            add_square(b, &m);
            add_light(b, &l);
            look(b, 9 * sin(a), 0, 9 * cos(a), 0, 0, 0);
            assert_pixel(b, 0.5 * expected, 0.5 * expected, 0.1 * expected);
        }
}

/* No highlight where the mirror direction points away from the viewer, nor where the light is below the surface. */
static void test_specular_ends(void **state)
{
    bed *b = *state;
    gno_material m = matt();
    gno_light l = far_light(80), under = far_light(100);
    set3(m.diffuse, 0, 0, 0);
    set3(m.specular, 1, 1, 1);
    m.shininess = 0.5;
    add_square(b, &m);
    add_light(b, &l);
    add_light(b, &under);
    look(b, -9 * sin(60 * DEGREE), 0, 9 * cos(60 * DEGREE), 0, 0, 0); /* 140 degrees from the mirror direction */
    assert_grey(b, 0);
}

/* Ambient, diffuse and specular terms of two lights, one of them near, all at once:
 * 0.2 x 0.5 + 1 (0.4 x 0.5 + 0.3 cos(20)^10) + 2 (0.4 x 0.8 + 0.3 (R.S)^10). */
static void test_sum(void **state)
{
    bed *b = *state;
    gno_material m = matt();
    gno_light l = far_light(60), near = point_light(0, 3, 4); /* N.L = 0.8 */
    const double ambient[3] = {0.2, 0.2, 0.2};
    double a = 40 * DEGREE, first, second, rs;
    set3(m.specular, 0.3, 0.3, 0.3);
    m.shininess = 10;
    set3(near.intensity, 2, 2, 2);
    add_square(b, &m);
    add_light(b, &l);
    add_light(b, &near);
    gno_scene_set_ambient(b->scene, ambient);
    look(b, 9 * sin(a), 0, 9 * cos(a), 0, 0, 0);
    first = 0.4 * 0.5 + 0.3 * pow(cos(20 * DEGREE), 10);
    rs = 0.8 * cos(a); /* R = (0, -0.6, 0.8), S = (sin a, 0, cos a) */
    second = 0.4 * 0.8 + 0.3 * pow(rs, 10);
    assert_grey(b, 0.1 + first + 2 * second);
}

/* The texture is a factor on ambient and diffuse terms, not on the specular one: of one colour, 0.5 0.25 1. */
static void test_texture_term(void **state)
{
    bed *b = *state;
    gno_material m = matt();
    gno_light l = far_light(60);
    const double ambient[3] = {0.2, 0.2, 0.2};
    set3(m.specular, 0.3, 0.3, 0.3);
    m.texture.kind = GNO_TEXTURE_PROCEDURAL;
    m.texture.procedural = gno_procedural_default(GNO_PATTERN_CHECKER);
    set3(m.texture.procedural.light, 0.5, 0.25, 1);
    set3(m.texture.procedural.dark, 0.5, 0.25, 1);
    add_square(b, &m);
    add_light(b, &l);
    gno_scene_set_ambient(b->scene, ambient);
    look(b, 9 * sin(60 * DEGREE), 0, 9 * cos(60 * DEGREE), 0, 0, 0);
    assert_pixel(b, 0.5 * 0.3 + 0.3, 0.25 * 0.3 + 0.3, 0.3 + 0.3);
}

/* ---- falloffs ------------------------------------------------------------------------------------------------------ */

/* A lamp 5 away, N.L = 0.8, a viewer 10 away, K = 2: factors 1, 1/12, 1/7, 1/25 on 0.4 x 0.8. */
static void test_falloffs(void **state)
{
    bed *b = *state;
    static const struct { gno_falloff falloff; int from_viewer; double factor; } cases[4] = {
        {GNO_FALLOFF_NONE, 1, 1}, {GNO_FALLOFF_LINEAR, 1, 1.0 / 12}, {GNO_FALLOFF_LINEAR, 0, 1.0 / 7}, {GNO_FALLOFF_INVERSE_SQUARE, 0, 1.0 / 25}};
    for (int i = 0; i < 4; i++) {
        static const gno_shading shadings[3] = {GNO_SHADING_FLAT, GNO_SHADING_CONSTANT, GNO_SHADING_PHONG};
        for (int j = 0; j < 3; j++) {
            gno_material m = matt();
            gno_light l = point_light(3, 0, 4);
            clear(b);
            m.shading = shadings[j];
            l.falloff = cases[i].falloff;
            l.falloff_k = 2;
            l.distance_from_viewer = cases[i].from_viewer;
            add_square(b, &m);
            add_light(b, &l);
            look(b, 0, 6, 8, 0, 0, 0);
            assert_grey(b, 0.32 * cases[i].factor);
        }
    }
}

/* Light from infinity fades with the viewer's distance too; an orthographic view counts from the object nearest to it. */
static void test_falloff_from_the_viewer(void **state)
{
    bed *b = *state;
    gno_material m = matt();
    gno_light l = far_light(0);
    l.falloff = GNO_FALLOFF_LINEAR;
    l.falloff_k = 1;
    add_square(b, &m);
    add_light(b, &l);
    look(b, 0, 0, 7, 0, 0, 0);
    assert_grey(b, 0.4 / 8);
    look_parallel(b, 0, 0, 7, 0, 0, 0); /* the square is the nearest object itself */
    assert_grey(b, 0.4);
    {
        static const double positions[9] = {30, 30, 3, 31, 30, 3, 30, 31, 3};
        static const int corners[3] = {0, 1, 2};
        gno_mesh_def mesh = gno_mesh_def_default();
        mesh.vertex_count = mesh.corner_count = 3;
        mesh.positions = positions;
        mesh.polygon_count = mesh.ring_count = 1;
        mesh.corner_vertex = corners;
        assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, NULL), GNO_OK);
    }
    {   /* a wider picture sees a triangle 3 nearer */
        gno_camera camera = gno_scene_camera(b->scene);
        const gno_image_def image = {401, 401, {0, 0, 0}};
        float *rgb = malloc(sizeof(float) * 3 * 401 * 401);
        camera.height = 100;
        assert_non_null(rgb);
        assert_int_equal(gno_scene_set_camera(b->scene, &camera), GNO_OK);
        assert_int_equal(gno_scene_set_image(b->scene, &image), GNO_OK);
        assert_int_equal(gno_render(b->scene, NULL, rgb, NULL), GNO_OK);
        assert_near((double)rgb[3 * (200 * 401 + 200)], 0.4 / 4, 1e-5);
        free(rgb);
    }
}

/* ---- kinds of light ------------------------------------------------------------------------------------------------ */

/* A cone of 40 degrees about its axis, from 5 above: its edge is hard. */
static void test_spot(void **state)
{
    bed *b = *state;
    static const double off[4] = {0, 19, 21, 80};
    gno_material m = matt();
    for (int i = 0; i < 4; i++) {
        gno_light l = point_light(0, 0, 5);
        clear(b);
        l.type = GNO_LIGHT_SPOT;
        l.angle = 40;
        set3(l.direction, sin(off[i] * DEGREE), 0, -cos(off[i] * DEGREE));
        add_square(b, &m);
        add_light(b, &l);
        look(b, 1, 1, 4, 0, 0, 0);
        assert_grey(b, i < 2 ? 0.4 : 0);
    }
}

/* Two by two points in the middles of the quarters of a square 4 wide at height 5, a quarter of the light each. */
static void test_area(void **state)
{
    bed *b = *state;
    gno_material m = matt();
    gno_light l = point_light(-1, -3, 5);
    double sum = 0, single = 0;
    l.type = GNO_LIGHT_AREA;
    set3(l.edge1, 4, 0, 0);
    set3(l.edge2, 0, 4, 0);
    l.samples = 2;
    add_square(b, &m);
    add_light(b, &l);
    look(b, 1, 1, 4, 0.5, 0.25, 0);
    for (int i = 0; i < 4; i++) {
        double x = (i & 1 ? 2 : 0) - 0.5, y = (i >> 1 ? 0 : -2) - 0.25;
        sum += 0.25 * 0.4 * 5 / sqrt(x * x + y * y + 25);
    }
    assert_grey(b, sum);
    for (int i = 0; i < 4; i++) { /* each point alone, added up */
        float rgb[3];
        gno_light p = point_light(i & 1 ? 2 : 0, i >> 1 ? 0 : -2, 5);
        set3(p.intensity, 0.25, 0.25, 0.25);
        clear(b);
        add_square(b, &m);
        add_light(b, &p);
        look(b, 1, 1, 4, 0.5, 0.25, 0);
        assert_int_equal(gno_render(b->scene, NULL, rgb, NULL), GNO_OK);
        single += (double)rgb[0];
    }
    assert_near(single, sum, 1e-6);
}

/* ---- what stops light ---------------------------------------------------------------------------------------------- */

/* A caster between: the ambient term alone; one that passes a share: that share of the light. */
static void test_shadow(void **state)
{
    bed *b = *state;
    const double ambient[3] = {0.2, 0.2, 0.2};
    for (int i = 0; i < 2; i++) {
        gno_material m = matt(), glass = matt();
        gno_light l = far_light(0);
        clear(b);
        set3(glass.transmission, 0.5 * i, 0.25 * i, i);
        add_square(b, &m);
        add_square_at(b, 3, &glass);
        add_light(b, &l);
        gno_scene_set_ambient(b->scene, ambient);
        look(b, 5, 0, 1, 0, 0, 0); /* from below the caster */
        assert_pixel(b, 0.1 + 0.2 * i, 0.1 + 0.1 * i, 0.1 + 0.4 * i);
    }
}

/* Viewer and light on opposite sides: its own shadow. On the same side, below: lit as from above. One-sided: not there from below. */
static void test_sides(void **state)
{
    bed *b = *state;
    gno_material m = matt();
    gno_light l = far_light(60), below = far_light(120);
    const double ambient[3] = {0.2, 0.2, 0.2};
    add_square(b, &m);
    add_light(b, &l);
    gno_scene_set_ambient(b->scene, ambient);
    look(b, 1, 1, -4, 0, 0, 0);
    assert_grey(b, 0.1);
    add_light(b, &below);
    assert_grey(b, 0.1 + 0.2);
    clear(b);
    m.two_sided = 0;
    add_square(b, &m);
    gno_scene_set_ambient(b->scene, ambient);
    look(b, 1, 1, -4, 0, 0, 0);
    assert_grey(b, 0);
    look(b, 1, 1, 4, 0, 0, 0);
    assert_grey(b, 0.1);
}

/* ---- shadings ------------------------------------------------------------------------------------------------------ */

/* Near a lamp `flat` takes the light at the point, `constant` at the centroid, wherever one looks. */
static void test_flat_and_constant(void **state)
{
    bed *b = *state;
    static const double where[3][2] = {{0, 0}, {1.5, 0}, {-1, 1.9}};
    for (int i = 0; i < 3; i++) {
        gno_material m = matt();
        gno_light l = point_light(0, 0, 2);
        double d = sqrt(where[i][0] * where[i][0] + where[i][1] * where[i][1] + 4);
        clear(b);
        add_square(b, &m);
        add_light(b, &l);
        look(b, 1, 1, 6, where[i][0], where[i][1], 0);
        assert_grey(b, 0.4 * 2 / d);
        clear(b);
        m.shading = GNO_SHADING_CONSTANT;
        add_square(b, &m);
        add_light(b, &l);
        look(b, 1, 1, 6, where[i][0], where[i][1], 0);
        assert_grey(b, 0.4);
    }
}

/* The triangle (0,0,0), (4,0,0), (0,4,z) with a normal of its own at each corner. */
static const double corner_normals[9] = {0, 0, 1, 0.6, 0, 0.8, 0, -0.28, 0.96};

static void add_triangle(bed *b, const gno_material *m, double z)
{
    const double positions[9] = {0, 0, 0, 4, 0, 0, 0, 4, z};
    static const int corners[3] = {0, 1, 2};
    gno_mesh_def mesh = gno_mesh_def_default();
    mesh.vertex_count = mesh.corner_count = mesh.normal_count = 3;
    mesh.positions = positions;
    mesh.normals = corner_normals;
    mesh.polygon_count = mesh.ring_count = 1;
    mesh.corner_vertex = mesh.corner_normal = corners;
    mesh.material = add_material(b, m);
    assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, NULL), GNO_OK);
}

/* Weights of the corners, and where they put a point. */
static const double weights[4][3] = {{1.0 / 3, 1.0 / 3, 1.0 / 3}, {0.25, 0.5, 0.25}, {0.1, 0.2, 0.7}, {0.98, 0.01, 0.01}};

/* Intensities at the corners, interpolated over the surface: whatever the perspective. The corners' diffuse terms for light straight
 * down are 0.4 times 1, 0.8, 0.96; with highlights (viewer above, far off: S = z) R.S = 2 nz^2 - 1 = 1, 0.28, 0.8432. */
static void test_gouraud(void **state)
{
    bed *b = *state;
    for (int i = 0; i < 4; i++)
        for (int slanted = 0; slanted < 2; slanted++) {
            gno_material m = matt();
            gno_light l = far_light(0);
            const double *w = weights[i];
            double z = slanted ? 3 : 0, expected = 0.4 * (w[0] + 0.8 * w[1] + 0.96 * w[2]);
            clear(b);
            m.shading = GNO_SHADING_GOURAUD;
            add_triangle(b, &m, z);
            add_light(b, &l);
            look(b, 7, -5, 4, 4 * w[1], 4 * w[2], z * w[2]);
            assert_grey(b, expected);
        }
}

static void test_gouraud_highlight(void **state)
{
    bed *b = *state;
    gno_material m = matt();
    gno_light l = far_light(0);
    const double *w = weights[2];
    set3(m.specular, 0.5, 0.5, 0.5);
    m.shininess = 3;
    m.shading = GNO_SHADING_GOURAUD;
    add_triangle(b, &m, 0);
    add_light(b, &l);
    look_parallel(b, 4 * w[1], 4 * w[2], 9, 4 * w[1], 4 * w[2], 0);
    assert_grey(b, 0.4 * (w[0] + 0.8 * w[1] + 0.96 * w[2]) +
                       0.5 * (w[0] + pow(0.28, 3) * w[1] + pow(0.8432, 3) * w[2]));
}

/* Normals interpolated over the surface, made unit, then the model. */
static void test_phong(void **state)
{
    bed *b = *state;
    for (int i = 0; i < 4; i++)
        for (int slanted = 0; slanted < 2; slanted++) {
            gno_material m = matt();
            gno_light l = far_light(0);
            const double *w = weights[i];
            double z = slanted ? 3 : 0, n[3], length = 0, rs, eye[3] = {7, -5, 4}, s[3], far = 0;
            clear(b);
            m.shading = GNO_SHADING_PHONG;
            set3(m.specular, 0.5, 0.5, 0.5);
            m.shininess = 4;
            add_triangle(b, &m, z);
            add_light(b, &l);
            look(b, eye[0], eye[1], eye[2], 4 * w[1], 4 * w[2], z * w[2]);
            set3(s, eye[0] - 4 * w[1], eye[1] - 4 * w[2], eye[2] - z * w[2]);
            for (int k = 0; k < 3; k++) {
                n[k] = w[0] * corner_normals[k] + w[1] * corner_normals[3 + k] + w[2] * corner_normals[6 + k];
                length += n[k] * n[k];
                far += s[k] * s[k];
            }
            for (int k = 0; k < 3; k++) {
                n[k] /= sqrt(length);
                s[k] /= sqrt(far);
            }
            /* R = 2 (N.L) N - L with L = (0,0,1) */
            rs = 2 * n[2] * (n[0] * s[0] + n[1] * s[1] + n[2] * s[2]) - s[2];
            assert_grey(b, 0.4 * n[2] + (rs > 0 ? 0.5 * pow(rs, 4) : 0));
        }
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)
    const struct CMUnitTest tests[] = {
        TEST(test_ambient),  TEST(test_diffuse),  TEST(test_specular),  TEST(test_specular_ends), TEST(test_sum),
        TEST(test_texture_term), TEST(test_falloffs), TEST(test_falloff_from_the_viewer), TEST(test_spot), TEST(test_area),
        TEST(test_shadow),   TEST(test_sides),    TEST(test_flat_and_constant), TEST(test_gouraud), TEST(test_gouraud_highlight),
        TEST(test_phong),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
