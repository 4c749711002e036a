/* test_texture.c -- textures and bumps through gno_render: planar and uv maps in perspective against one ray a sample, holes for the
 * eye and for shadows, the maps of cylinder and sphere, bumps against the formula, pictures read back from files, every allocation
 * failing once.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include "fail_alloc.h"
#include "project/pattern.h"
#include <gnomon/gnomon_io.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define SIZE 24
#define PI 3.14159265358979323846

typedef struct bed {
    gno_context *context;
    gno_scene *scene;
    float rgb[SIZE * SIZE * 3];
} bed;

static void start(bed *b)
{
    gno_image_def image = gno_image_def_default();
    double white[3] = {1, 1, 1};
    assert_int_equal(gno_context_create(NULL, &b->context), GNO_OK);
    assert_int_equal(gno_scene_create(b->context, &b->scene), GNO_OK);
    image.width = image.height = SIZE;
    assert_int_equal(gno_scene_set_image(b->scene, &image), GNO_OK);
    assert_int_equal(gno_scene_set_ambient(b->scene, white), GNO_OK);
}

static void end(bed *b)
{
    gno_scene_destroy(b->scene);
    gno_context_destroy(b->context);
}

static void render(bed *b)
{
    gno_render_def def = gno_render_def_default();
    def.threads = 1;
    if (gno_render(b->scene, &def, b->rgb, NULL) != GNO_OK) fail_msg("%s", gno_context_message(b->context));
}

static void look(bed *b, gno_camera_type type, double x, double y, double z, double tx, double ty, double tz, double extent)
{
    gno_camera c = gno_camera_default();
    c.type = type;
    c.eye[0] = x, c.eye[1] = y, c.eye[2] = z;
    c.target[0] = tx, c.target[1] = ty, c.target[2] = tz;
    c.up[0] = 0, c.up[1] = 1, c.up[2] = 0;
    c.fov = c.height = extent;
    assert_int_equal(gno_scene_set_camera(b->scene, &c), GNO_OK);
}

static void near_to(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance)) fail_msg("%.9g is not %.9g", a, b);
}

static const float *pixel(const bed *b, int x, int y) { return b->rgb + 3 * (y * SIZE + x); }

static int add_pixels(gno_scene *scene, int width, int height, int channels, const float *values)
{
    gno_pixels pixels;
    int index = -1;
    memset(&pixels, 0, sizeof pixels);
    pixels.width = width;
    pixels.height = height;
    pixels.channels = channels;
    pixels.linear = values;
    assert_int_equal(gno_scene_add_image(scene, &pixels, &index), GNO_OK);
    return index;
}

static gno_material white(void)
{
    gno_material m = gno_material_default();
    for (int k = 0; k < 3; k++)
        m.ambient[k] = m.diffuse[k] = 1;
    return m;
}

/* A parallelogram with texture coordinates 0 to `top`, drawn as two triangles or as one polygon. */
static void add_quad(bed *b, const double p[4][3], double top, int split, const gno_material *material)
{
    static const int two[6] = {0, 1, 2, 0, 2, 3}, one[4] = {0, 1, 2, 3};
    static const unsigned ring[2] = {0, 4};
    const double uv[4][2] = {{0, 0}, {top, 0}, {top, top}, {0, top}};
    gno_mesh_def mesh = gno_mesh_def_default();
    assert_int_equal(gno_scene_add_material(b->scene, material, &mesh.material), GNO_OK);
    mesh.vertex_count = mesh.texcoord_count = 4;
    mesh.positions = p[0];
    mesh.texcoords = uv[0];
    mesh.polygon_count = mesh.ring_count = split ? 2 : 1;
    mesh.ring_start = split ? NULL : ring;
    mesh.corner_count = split ? 6 : 4;
    mesh.corner_vertex = mesh.corner_texcoord = split ? two : one;
    assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, NULL), GNO_OK);
}

/* ---- maps in perspective ---------------------------------------------------------------------------------------------------- */

#define CELLS 8

static float pattern_value(int column, int row) { return (float)((column * 5 + row * 3) % 7) / 6; }

/* What the eye at (0,0,h) over the plane z = 0 sees on 64 x 64 rays a pixel; the pattern repeats every `unit`. */
static double brute(const gno_camera *c, int px, int py, double unit)
{
    double f[3], r[3], u[3], length = 0, sum = 0, t = tan(c->fov * PI / 360) * 2 / SIZE;
    for (int k = 0; k < 3; k++) f[k] = c->target[k] - c->eye[k];
    for (int k = 0; k < 3; k++) length += f[k] * f[k];
    for (int k = 0; k < 3; k++) f[k] /= sqrt(length);
    for (int k = 0; k < 3; k++) r[k] = f[(k + 1) % 3] * c->up[(k + 2) % 3] - f[(k + 2) % 3] * c->up[(k + 1) % 3];
    length = sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
    for (int k = 0; k < 3; k++) r[k] /= length;
    for (int k = 0; k < 3; k++) u[k] = r[(k + 1) % 3] * f[(k + 2) % 3] - r[(k + 2) % 3] * f[(k + 1) % 3];
    for (int i = 0; i < 4096; i++) {
        double x = (px + (i % 64 + 0.5) / 64 - SIZE / 2) * t, y = -(py + (i / 64 + 0.5) / 64 - SIZE / 2) * t, d[3], k;
        for (int n = 0; n < 3; n++) d[n] = f[n] + x * r[n] + y * u[n];
        k = -c->eye[2] / d[2];
        sum += (double)pattern_value((int)floor((c->eye[0] + k * d[0]) / unit * CELLS) & (CELLS - 1),
                                     (int)floor((c->eye[1] + k * d[1]) / unit * CELLS) & (CELLS - 1));
    }
    return sum / 4096;
}

static void check_plane(int mapped, int split, double eye_z)
{
    static const double corners[4][3] = {{-64, -64, 0}, {64, -64, 0}, {64, 64, 0}, {-64, 64, 0}};
    float values[CELLS * CELLS];
    gno_material m = white();
    gno_camera camera;
    bed b;
    start(&b);
    for (int row = 0; row < CELLS; row++)
        for (int column = 0; column < CELLS; column++)
            values[(CELLS - 1 - row) * CELLS + column] = pattern_value(column, row);
    m.texture = gno_texture_default(mapped ? GNO_MAP_UV : GNO_MAP_PLANAR);
    m.texture.kind = GNO_TEXTURE_IMAGE;
    m.texture.image = add_pixels(b.scene, CELLS, CELLS, 1, values);
    m.texture.scale[0] = m.texture.scale[1] = 2; /* the quad's texture coordinates are its places over 64, plus 1 */
    if (mapped) m.texture.scale[0] = m.texture.scale[1] = 2.0 / 64;
    add_quad(&b, corners, 2, split, &m);
    look(&b, GNO_CAMERA_PERSPECTIVE, 0.3, -8, eye_z, 0.1, 0, 0, 20);
    camera = gno_scene_camera(b.scene);
    render(&b);
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++)
            near_to((double)pixel(&b, x, y)[1], brute(&camera, x, y, 2), 1.0 / 255);
    end(&b);
}

static void test_plane_in_perspective(void **state)
{
    (void)state;
    check_plane(0, 0, 6);
    check_plane(0, 0, 3);
    check_plane(1, 0, 6);
    check_plane(1, 1, 6);
    check_plane(1, 1, 3);
}

/* ---- holes -------------------------------------------------------------------------------------------------------------------- */

static const double small[4][3] = {{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}};

static gno_material holed(gno_scene *scene)
{
    /* Left half solid green, right half a quarter of it. */
    static const float values[8] = {0, 1, 0, 1, 0, 1, 0, 0.25f};
    gno_material m = white();
    m.texture.kind = GNO_TEXTURE_IMAGE;
    m.texture.image = add_pixels(scene, 2, 1, 4, values);
    return m;
}

static void test_holes_for_the_eye(void **state)
{
    gno_image_def image = gno_image_def_default();
    gno_material m;
    bed b;
    (void)state;
    start(&b);
    image.width = image.height = SIZE;
    image.background[0] = 1;
    assert_int_equal(gno_scene_set_image(b.scene, &image), GNO_OK);
    m = holed(b.scene);
    add_quad(&b, small, 1, 0, &m);
    look(&b, GNO_CAMERA_ORTHOGRAPHIC, 0, 0, 5, 0, 0, 0, 4);
    render(&b);
    near_to((double)pixel(&b, 9, 12)[0], 0, 1e-6);
    near_to((double)pixel(&b, 9, 12)[1], 1, 1e-6);
    near_to((double)pixel(&b, 15, 12)[0], 0.75, 1e-6);
    near_to((double)pixel(&b, 15, 12)[1], 0.25, 1e-6);
    near_to((double)pixel(&b, 21, 12)[0], 1, 1e-6);
    end(&b);
}

/* A lamp 2 above the ground and (lx,ly) beside the centre, or light from there: rays through the caster at height 1. */
static void check_shadow(int directional, int on_axis, double lx, double ly)
{
    static const double ground[4][3] = {{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}};
    gno_material m, floor = white();
    gno_light light = gno_light_default();
    double none[3] = {0, 0, 0};
    bed b;
    start(&b);
    assert_int_equal(gno_scene_set_ambient(b.scene, none), GNO_OK);
    m = holed(b.scene);
    if (on_axis) { /* by a planar map instead of texture coordinates */
        m.texture.map = GNO_MAP_PLANAR;
        m.texture.origin[0] = m.texture.origin[1] = -1;
        m.texture.scale[0] = m.texture.scale[1] = 2;
    }
    add_quad(&b, small, 1, !on_axis, &m);
    add_quad(&b, ground, 1, 0, &floor);
    light.type = directional ? GNO_LIGHT_DIRECTIONAL : GNO_LIGHT_POINT;
    light.position[0] = lx;
    light.position[1] = ly;
    light.position[2] = 2;
    light.direction[0] = -lx / 2;
    light.direction[1] = -ly / 2;
    light.direction[2] = -1;
    assert_int_equal(gno_scene_add_light(b.scene, NULL, &light, NULL), GNO_OK);
    look(&b, GNO_CAMERA_PERSPECTIVE, 0, -5, 13, 0, 0, 0, 30);
    render(&b);
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++) {
            /* The ground point of the pixel's middle; those that the caster hides, or edges cross, are passed over. */
            double l = sqrt(194.0), t = tan(15 * PI / 180) * 2 / SIZE, d[3], k, p[2], q[2], reach = directional ? 1 : 2, lit;
            double sx = (x + 0.5 - SIZE / 2) * t, sy = -(y + 0.5 - SIZE / 2) * t;
            d[0] = sx, d[1] = (5 + sy * 13) / l, d[2] = (-13 + sy * 5) / l;
            k = -13 / d[2];
            p[0] = k * d[0], p[1] = -5 + k * d[1];
            q[0] = (p[0] + (directional ? lx / 2 : lx)) / reach;
            q[1] = (p[1] + (directional ? ly / 2 : ly)) / reach; /* of the caster's plane, on the ray to the lamp */
            if (fabs(p[0]) > 8.5 || fabs(p[1]) > 8.5 || fabs(q[0]) < 0.3 / reach || fabs(fabs(q[0]) - 1) < 0.4 / reach ||
                fabs(fabs(q[1]) - 1) < 0.6 / reach)
                continue;
            double kc = -12 / d[2], cx = kc * d[0], cy = -5 + kc * d[1];
            if (fabs(cx) < 1.3 && fabs(cy) < 1.5) continue;
            lit = fabs(q[0]) < 1 && fabs(q[1]) < 1 ? (q[0] < 0 ? 0 : 0.75) : 1;
            if (directional) p[0] = p[1] = 0;
            lit *= 2 / sqrt(4 + (p[0] - lx) * (p[0] - lx) + (p[1] - ly) * (p[1] - ly));
            near_to((double)pixel(&b, x, y)[1], lit, 2e-2);
        }
    end(&b);
}

static void test_holes_in_shadows(void **state)
{
    (void)state;
    for (int on_axis = 0; on_axis < 2; on_axis++)
        for (int directional = 0; directional < 2; directional++) {
            check_shadow(directional, on_axis, 0, 0);
            check_shadow(directional, on_axis, 1.5, -0.75);
            check_shadow(directional, on_axis, -3, 2);
        }
}

/* ---- round maps --------------------------------------------------------------------------------------------------------------- */

/* The pattern's place of a point on a plane through it, seen from before it. */
static void place_of(const gno_texture *t, vec3 p, vec3 n, double st[2])
{
    static const double identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    gnoi_place place = gnoi_place_make(t, identity);
    vec3 eye = v3_mad(p, n, 3);
    gno_camera c = gno_camera_default();
    gno_image_def image = gno_image_def_default();
    gnoi_view view;
    gnoi_screen_plane nearness;
    gnoi_pattern pattern;
    double normal[3] = {n.x, n.y, n.z}, d = -v3_dot(n, p);
    c.eye[0] = eye.x, c.eye[1] = eye.y, c.eye[2] = eye.z;
    c.target[0] = p.x, c.target[1] = p.y, c.target[2] = p.z;
    c.up[0] = 0.3, c.up[1] = 0.5, c.up[2] = 0.9;
    image.width = image.height = 1000;
    view = gnoi_view_make(&c, &image, 1);
    nearness = gnoi_view_nearness(&view, normal, d, gnoi_view_side(&view, normal, d));
    pattern = gnoi_pattern_round(&place, &view, &nearness, 500, 500);
    st[0] = gnoi_plane_at(&pattern.s, 500, 500) / gnoi_plane_at(&pattern.w, 500, 500);
    st[1] = gnoi_plane_at(&pattern.t, 500, 500) / gnoi_plane_at(&pattern.w, 500, 500);
}

/* The chapter's patch of a sphere, theta = pi/2 X, phi = pi/2 - pi/4 Y about the y axis, theta from z towards x. */
static void test_sphere_patch(void **state)
{
    gno_texture t = gno_texture_default(GNO_MAP_SPHERICAL);
    (void)state;
    t.u[0] = 0, t.u[2] = 1;
    t.v[1] = 1, t.v[2] = 0;
    t.corners[0][0] = 0, t.corners[0][1] = 90;
    t.corners[1][0] = 90, t.corners[1][1] = 45;
    for (double x = 0.1; x < 1; x += 0.2)
        for (double y = 0.1; y < 1; y += 0.2) {
            double theta = PI / 2 * x, phi = PI / 2 - PI / 4 * y, st[2];
            vec3 p = v3(sin(theta) * sin(phi), cos(phi), cos(theta) * sin(phi));
            place_of(&t, p, p, st);
            near_to(st[0], x, 1e-5);
            near_to(st[1], y, 1e-5);
        }
}

static void test_cylinder(void **state)
{
    gno_texture t = gno_texture_default(GNO_MAP_CYLINDRICAL);
    (void)state;
    t.origin[0] = 1;
    t.v[2] = 2; /* one pattern is two high */
    for (double turn = 10; turn < 360; turn += 50) {
        double a = turn * PI / 180, st[2];
        vec3 n = v3(cos(a), sin(a), 0);
        place_of(&t, v3_add(v3(1, 0, 0.5), n), n, st);
        near_to(st[0] - floor(st[0]), turn / 360, 1e-5);
        near_to(st[1], 0.25, 1e-5);
    }
}

/* ---- bumps -------------------------------------------------------------------------------------------------------------------- */

/* A ramp of heights turns the normal by the chapter's formula, whatever the size of the surface. */
static void check_ramp(double size)
{
    float values[64];
    double p[4][3], n[3], qx[3] = {0, 0, 0}, qy[3] = {0, 0, 0}, none[3] = {0, 0, 0}, length;
    gno_material m = white();
    gno_light light = gno_light_default();
    bed b;
    start(&b);
    for (int i = 0; i < 64; i++)
        values[i] = (float)(i % 8) / 8;
    for (int i = 0; i < 12; i++) p[i / 3][i % 3] = small[i / 3][i % 3] * size;
    assert_int_equal(gno_scene_set_ambient(b.scene, none), GNO_OK);
    m.bump.kind = GNO_BUMP_HEIGHT;
    m.bump.texture.kind = GNO_TEXTURE_IMAGE;
    m.bump.texture.image = add_pixels(b.scene, 8, 8, 1, values);
    m.bump.amount = 0.4;
    add_quad(&b, (const double(*)[3])p, 1, 0, &m);
    light.type = GNO_LIGHT_DIRECTIONAL;
    light.direction[0] = 0, light.direction[1] = 0, light.direction[2] = -1;
    assert_int_equal(gno_scene_add_light(b.scene, NULL, &light, NULL), GNO_OK);
    look(&b, GNO_CAMERA_ORTHOGRAPHIC, 0, 0, 5 * size, 0, 0, 0, 2 * size);
    render(&b);
    qx[0] = qy[1] = 2 * size;
    gno_bump_normal(qx, qy, 0.4 * 2 * size * 1, 0, n); /* the ramp rises by 1 a pattern, the pattern is 2 size wide */
    length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    near_to((double)pixel(&b, SIZE / 2, SIZE / 2)[0], n[2] / length, 1e-5);
    end(&b);
}

static void test_height_ramp(void **state)
{
    (void)state;
    check_ramp(1);
    check_ramp(1000);
}

static void test_normal_map(void **state)
{
    static const float values[3] = {0.9f, 0.3f, 0.8f}; /* 0.8, -0.4, 0.6 */
    double none[3] = {0, 0, 0}, length = sqrt(0.64 + 0.16 + 0.36);
    gno_material m = white();
    gno_light light = gno_light_default();
    bed b;
    (void)state;
    for (int axis = 0; axis < 3; axis++) {
        start(&b);
        assert_int_equal(gno_scene_set_ambient(b.scene, none), GNO_OK);
        m.bump.kind = GNO_BUMP_NORMAL;
        m.bump.texture.kind = GNO_TEXTURE_IMAGE;
        m.bump.texture.image = add_pixels(b.scene, 1, 1, 3, values);
        add_quad(&b, small, 1, 1, &m);
        light.type = GNO_LIGHT_DIRECTIONAL;
        light.direction[0] = axis == 0 ? -1 : 0, light.direction[1] = axis == 1 ? 1 : 0, light.direction[2] = axis == 2 ? -1 : -1e-6;
        assert_int_equal(gno_scene_add_light(b.scene, NULL, &light, NULL), GNO_OK);
        look(&b, GNO_CAMERA_ORTHOGRAPHIC, 0, 0, 5, 0, 0, 0, 2);
        render(&b);
        near_to((double)pixel(&b, 7, 9)[0], (axis == 0 ? 0.8 : axis == 1 ? 0.4 : 0.6) / length, 1e-5);
        end(&b);
    }
}

/* ---- values that are refused ------------------------------------------------------------------------------------------------------ */

static void test_bad_values(void **state)
{
    static const float value[4] = {1, 1, 1, 1}, broken[1] = {NAN};
    static const unsigned char byte[1] = {3};
    gno_pixels p;
    gno_material m;
    bed b;
    (void)state;
    start(&b);
    memset(&p, 0, sizeof p);
    p.width = p.height = p.channels = 1;
    assert_int_equal(gno_scene_add_image(b.scene, &p, NULL), GNO_ERROR_ARGUMENT);
    p.linear = value, p.bytes = byte;
    assert_int_equal(gno_scene_add_image(b.scene, &p, NULL), GNO_ERROR_ARGUMENT);
    p.bytes = NULL, p.channels = 5;
    assert_int_equal(gno_scene_add_image(b.scene, &p, NULL), GNO_ERROR_ARGUMENT);
    p.channels = 1, p.width = GNO_MAX_IMAGE_SIDE + 1;
    assert_int_equal(gno_scene_add_image(b.scene, &p, NULL), GNO_ERROR_LIMIT);
    p.width = 1, p.linear = broken;
    assert_int_equal(gno_scene_add_image(b.scene, &p, NULL), GNO_ERROR_ARGUMENT);
    m = white();
    m.texture.kind = GNO_TEXTURE_IMAGE;
    assert_int_equal(gno_scene_add_material(b.scene, &m, NULL), GNO_ERROR_ARGUMENT);
    assert_string_equal(gno_context_message(b.context), "texture: image 0 of 0");
    m.texture.image = add_pixels(b.scene, 1, 1, 1, value);
    assert_int_equal(gno_scene_add_material(b.scene, &m, NULL), GNO_OK);
    m.texture.scale[1] = 0;
    assert_int_equal(gno_scene_add_material(b.scene, &m, NULL), GNO_ERROR_ARGUMENT);
    m = white();
    m.bump.kind = GNO_BUMP_HEIGHT;
    m.bump.amount = NAN;
    assert_int_equal(gno_scene_add_material(b.scene, &m, NULL), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_scene_count(b.scene).images, 1);
    end(&b);
}

/* ---- files ---------------------------------------------------------------------------------------------------------------------- */

static int warnings;

static void count_warnings(void *user, gno_log_level level, const char *text)
{
    (void)user;
    (void)text;
    warnings += level == GNO_LOG_WARNING;
}

/* A picture written as `name` and drawn on a square gives its own colours back; one that is missing gives the plain colour. */
static void check_file(const char *folder, const char *name, double tolerance)
{
    static const char scene_text[] =
        "gnomon: 1\nimage: {width: 24, height: 24}\ncamera: {type: orthographic, eye: [0,0,5], target: [0,0,0], up: [0,1,0], height: 2}\n"
        "ambient: 1\nmaterials: {m: {ambient: 1, texture: {image: %s}}}\n"
        "objects: [{polygon: [[-1,-1,0],[1,-1,0],[1,1,0],[-1,1,0]], uv: [[0,0],[1,0],[1,1],[0,1]], material: m}]\n";
    float rgb[4 * 4 * 3];
    char path[300];
    gno_context_def def = gno_context_def_default();
    bed b;
    def.log = count_warnings;
    assert_int_equal(gno_context_create(&def, &b.context), GNO_OK);
    for (int i = 0; i < 48; i++) rgb[i] = (float)(i * 7 % 48) / 48;
    if (tolerance < 1) {
        snprintf(path, sizeof path, "%s/%s", folder, name);
        assert_int_equal(gno_picture_write(b.context, path, NULL, 4, 4, rgb), GNO_OK);
    }
    snprintf(path, sizeof path, "%s/scene.yaml", folder);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, scene_text, name);
    fclose(file);
    if (gno_scene_load(b.context, path, NULL, 0, &b.scene) != GNO_OK) fail_msg("%s", gno_context_message(b.context));
    render(&b);
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++)
            for (int k = 0; k < 3; k++)
                near_to((double)pixel(&b, x, y)[k], tolerance < 1 ? (double)rgb[3 * (y / 6 * 4 + x / 6) + k] : 1, tolerance < 1 ? tolerance : 1e-6);
    end(&b);
}

static void test_files(void **state)
{
    char folder[] = "/tmp/gnomon_texture_XXXXXX", path[300];
    static const char *const names[] = {"t.png", "t.exr", "scene.yaml"};
    (void)state;
    assert_non_null(mkdtemp(folder));
    warnings = 0;
    check_file(folder, "t.png", 0.006);
    check_file(folder, "t.exr", 0.0005);
    assert_int_equal(warnings, 0);
    check_file(folder, "missing.png", 2);
    check_file(folder, "scene.yaml", 2);
    assert_int_equal(warnings, 2);
    for (int i = 0; i < 3; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        unlink(path);
    }
    rmdir(folder);
}

/* ---- memory ------------------------------------------------------------------------------------------------------------------------ */

static gno_status fill(gno_scene *scene)
{
    static const float values[16] = {0, 1, 0, 1, 0, 1, 0, 0.25f, 1, 1, 0, 0, 0.5f, 0, 1, 1};
    static const double ground[4][3] = {{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}}, uv[4][2] = {{0, 0}, {2, 0}, {2, 2}, {0, 2}};
    static const unsigned ring[2] = {0, 4};
    static const int corner[4] = {0, 1, 2, 3};
    gno_light light = gno_light_default();
    gno_pixels pixels;
    gno_image_def image = gno_image_def_default();
    gno_status status;
    memset(&pixels, 0, sizeof pixels);
    pixels.width = pixels.height = 2;
    pixels.channels = 4;
    pixels.linear = values;
    image.width = image.height = SIZE;
    status = gno_scene_set_image(scene, &image);
    light.position[2] = 4;
    if (status == GNO_OK) status = gno_scene_add_image(scene, &pixels, NULL);
    if (status == GNO_OK) status = gno_scene_add_light(scene, NULL, &light, NULL);
    for (int i = 0; i < 2 && status == GNO_OK; i++) {
        gno_mesh_def mesh = gno_mesh_def_default();
        gno_material m = white();
        m.texture.kind = i ? GNO_TEXTURE_IMAGE : GNO_TEXTURE_NONE;
        m.bump.kind = GNO_BUMP_HEIGHT;
        m.bump.texture.kind = GNO_TEXTURE_IMAGE;
        m.bump.amount = 0.05;
        status = gno_scene_add_material(scene, &m, &mesh.material);
        mesh.vertex_count = mesh.texcoord_count = mesh.corner_count = 4;
        mesh.positions = i ? small[0] : ground[0];
        mesh.texcoords = uv[0];
        mesh.polygon_count = mesh.ring_count = 1;
        mesh.ring_start = ring;
        mesh.corner_vertex = mesh.corner_texcoord = corner;
        if (status == GNO_OK) status = gno_scene_add_mesh(scene, &mesh, NULL);
    }
    return status;
}

static void test_every_allocation_fails(void **state)
{
    static float rgb[SIZE * SIZE * 3];
    (void)state;
    for (size_t at = 0, calls = 1; at <= calls; at++) {
        fail_alloc alloc = {0};
        gno_context_def def = fail_alloc_def(&alloc);
        gno_render_def how = gno_render_def_default();
        gno_context *context;
        gno_scene *scene;
        gno_status status;
        size_t before;
        how.threads = 1;
        assert_int_equal(gno_context_create(&def, &context), GNO_OK);
        assert_int_equal(gno_scene_create(context, &scene), GNO_OK);
        before = alloc.calls;
        alloc.fail_at = at ? before + at : 0;
        status = fill(scene);
        if (status == GNO_OK) status = gno_render(scene, &how, rgb, NULL);
        assert_int_equal(status, at ? GNO_ERROR_MEMORY : GNO_OK);
        if (at == 0) calls = alloc.calls - before;
        gno_scene_destroy(scene);
        gno_context_destroy(context);
        assert_int_equal(alloc.held, 0);
        assert_false(alloc.wrong_size);
    }
}

/* ---- refinement ---------------------------------------------------------------------------------------------------------------- */

/* A texture is filtered already: its changes from row to row call for no finer lines, in no row of any tile. */
static void test_no_finer_lines(void **state)
{
    enum { WIDE = 100 };
    static const double corners[4][3] = {{-64, -64, 0}, {64, -64, 0}, {64, 64, 0}, {-64, 64, 0}};
    static float rgb[WIDE * WIDE * 3];
    const float values[4] = {0, 1, 1, 0};
    gno_image_def image = gno_image_def_default();
    gno_light light = gno_light_default();
    gno_material m = white();
    gno_stats stats;
    bed b;
    (void)state;
    start(&b);
    image.width = image.height = WIDE;
    assert_int_equal(gno_scene_set_image(b.scene, &image), GNO_OK);
    light.type = GNO_LIGHT_DIRECTIONAL;
    light.direction[2] = -1;
    assert_int_equal(gno_scene_add_light(b.scene, NULL, &light, NULL), GNO_OK);
    m.texture = gno_texture_default(GNO_MAP_UV);
    m.texture.kind = GNO_TEXTURE_IMAGE;
    m.texture.image = add_pixels(b.scene, 2, 2, 1, values);
    add_quad(&b, corners, 32, 0, &m);
    look(&b, GNO_CAMERA_ORTHOGRAPHIC, 0, 0, 20, 0, 0, 0, 50);
    assert_int_equal(gno_render(b.scene, NULL, rgb, &stats), GNO_OK);
    near_to(stats.refined_pixels, 0, 0);
    assert_true(rgb[3 * (WIDE + 1)] != rgb[3 * (5 * WIDE + 1)]);
    end(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_plane_in_perspective), cmocka_unit_test(test_holes_for_the_eye), cmocka_unit_test(test_holes_in_shadows),
        cmocka_unit_test(test_sphere_patch),         cmocka_unit_test(test_cylinder),          cmocka_unit_test(test_height_ramp),
        cmocka_unit_test(test_normal_map),           cmocka_unit_test(test_bad_values),        cmocka_unit_test(test_files),
        cmocka_unit_test(test_every_allocation_fails), cmocka_unit_test(test_no_finer_lines),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
