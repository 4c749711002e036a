/* test_refusals.c -- every field of the definitions that a program hands in, out of its range: refused with a message that names it,
 * and taken again when it is put right. One table: struct, field, value, word of the message. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <gnomon/gnomon_math.h>
#include <gnomon/gnomon_matrix.h>
#include <gnomon/gnomon_path.h>
#include <gnomon/gnomon_pieces.h>
#include <math.h>
#include <string.h>

static gno_context *context;
static gno_scene *scene;

static const double corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
static const int triangle[3] = {0, 1, 2};
static const float white[3] = {1, 1, 1};
static const unsigned char black[3] = {0, 0, 0};

static gno_mesh_def good_mesh(void)
{
    gno_mesh_def mesh = gno_mesh_def_default();
    mesh.vertex_count = mesh.corner_count = 3;
    mesh.polygon_count = mesh.ring_count = 1;
    mesh.positions = corners;
    mesh.corner_vertex = triangle;
    return mesh;
}

static gno_pixels good_pixels(void)
{
    gno_pixels pixels;
    memset(&pixels, 0, sizeof pixels);
    pixels.width = pixels.height = 1;
    pixels.channels = 3;
    pixels.linear = white;
    return pixels;
}

static int set_up(void **state)
{
    gno_mesh_def mesh = good_mesh();
    gno_pixels pixels = good_pixels();
    gno_light light = gno_light_default();
    gno_image_def image = gno_image_def_default();
    (void)state;
    image.width = image.height = 2;
    return gno_context_create(NULL, &context) || gno_scene_create(context, &scene) || gno_scene_add_mesh(scene, &mesh, NULL) ||
           gno_scene_add_image(scene, &pixels, NULL) || gno_scene_add_light(scene, NULL, &light, NULL) || gno_scene_set_image(scene, &image);
}

static int tear_down(void **state)
{
    (void)state;
    gno_scene_destroy(scene);
    gno_context_destroy(context);
    return 0;
}

/* ---- who is asked ------------------------------------------------------------------------------------------------------------ */

typedef union anything {
    gno_material material;
    gno_light light;
    gno_camera camera;
    gno_image_def image;
    gno_mesh_def mesh;
    gno_pixels pixels;
    gno_camera_path path;
    gno_render_def render;
    gno_matrix_def matrix;
    gno_lit_def lit;
    gno_visible_def visible;
} anything;

static gno_status give_material(const anything *a) { return gno_scene_add_material(scene, &a->material, NULL); }
static gno_status give_light(const anything *a) { return gno_scene_add_light(scene, NULL, &a->light, NULL); }
static gno_status give_camera(const anything *a) { return gno_scene_set_camera(scene, &a->camera); }
static gno_status give_image(const anything *a) { return gno_scene_set_image(scene, &a->image); }
static gno_status give_mesh(const anything *a) { return gno_scene_add_mesh(scene, &a->mesh, NULL); }
static gno_status give_pixels(const anything *a) { return gno_scene_add_image(scene, &a->pixels, NULL); }
static gno_status give_path(const anything *a) { return gno_scene_set_camera_path(scene, &a->path); }

static gno_status give_render(const anything *a)
{
    float rgb[12];
    return gno_render(scene, &a->render, rgb, NULL);
}

static gno_status give_matrix(const anything *a)
{
    gno_matrix *matrix;
    gno_status status = gno_matrix_build(scene, 0, &a->matrix, &matrix);
    assert_true((status == GNO_OK) == (matrix != NULL));
    gno_matrix_destroy(matrix);
    return status;
}

static gno_status give_lit(const anything *a)
{
    gno_pieces *pieces;
    gno_status status = gno_lit_pieces(scene, 0, &a->lit, &pieces, NULL, NULL);
    assert_true((status == GNO_OK) == (pieces != NULL));
    gno_pieces_destroy(pieces);
    return status;
}

static gno_status give_visible(const anything *a)
{
    gno_pieces *pieces;
    gno_status status = gno_visible_pieces(scene, &a->visible, &pieces, NULL);
    assert_true((status == GNO_OK) == (pieces != NULL));
    gno_pieces_destroy(pieces);
    return status;
}

/* ---- fields --------------------------------------------------------------------------------------------------------------------- */

typedef struct field {
    size_t at;
    int is_double; /* 0: an int or an enum; -1: a pointer, which becomes NULL; -2: a size_t */
    double value;
    const char *word;
} field;

#define INT(type, name, value, word) {offsetof(type, name), 0, value, word}
#define REAL(type, name, value, word) {offsetof(type, name), 1, value, word}
#define NONE(type, name, word) {offsetof(type, name), -1, 0, word}
#define COUNT(type, name, value, word) {offsetof(type, name), -2, value, word}

static void poke(anything *a, const field *f)
{
    char *to = (char *)a + f->at;
    const int i = f->is_double ? 0 : (int)f->value;
    const size_t n = f->is_double == -2 ? (size_t)f->value : 0;
    const void *none = NULL;
    switch (f->is_double) {
    case 0: memcpy(to, &i, sizeof i); break;
    case 1: memcpy(to, &f->value, sizeof f->value); break;
    case -1: memcpy(to, &none, sizeof none); break;
    default: memcpy(to, &n, sizeof n); break;
    }
}

/* Each field alone is wrong: ARGUMENT or LIMIT with the word; then the definition as it was is good. */
static void hold(const anything *good, gno_status (*give)(const anything *), const field *fields, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        anything bad = *good;
        gno_status status;
        poke(&bad, &fields[i]);
        status = give(&bad);
        if (status != GNO_ERROR_ARGUMENT && status != GNO_ERROR_LIMIT) fail_msg("%s: status %d", fields[i].word, (int)status);
        if (!strstr(gno_context_message(context), fields[i].word)) fail_msg("%s: \"%s\"", fields[i].word, gno_context_message(context));
    }
    assert_int_equal(give(good), GNO_OK);
}

#define HOLD(good, give, fields) hold(good, give, fields, sizeof(fields) / sizeof *(fields))

static void test_material(void **state)
{
    static const field plain[] = {
        REAL(gno_material, ambient[1], -1, "ambient"),   REAL(gno_material, diffuse[0], NAN, "diffuse"),
        REAL(gno_material, specular[2], -1, "specular"), REAL(gno_material, transmission[0], 1.5, "transmission"),
        REAL(gno_material, shininess, -1, "shininess"),  INT(gno_material, shading, 9, "shading"),
        INT(gno_material, texture.kind, 9, "kind"),      INT(gno_material, texture.map, -1, "map"),
        INT(gno_material, texture.wrap, 9, "wrap"),      INT(gno_material, texture.filter, 9, "filter"),
        INT(gno_material, bump.kind, 9, "bump: kind"),
    };
    static const field image[] = {
        INT(gno_material, texture.image, 1, "image 1 of 1"),     INT(gno_material, texture.image, -1, "image -1"),
        REAL(gno_material, texture.origin[2], NAN, "origin"),    REAL(gno_material, texture.u[0], 1e300, "u "),
        REAL(gno_material, texture.v[1], INFINITY, "v "),        REAL(gno_material, texture.v[1], 0, "u and v have no length"),
        REAL(gno_material, texture.corners[1][1], NAN, "corners"), REAL(gno_material, texture.corners[1][1], 2, "corners span no area"),
        REAL(gno_material, texture.scale[1], NAN, "scale"),      REAL(gno_material, texture.scale[0], 0, "0 is no scale"),
        REAL(gno_material, bump.amount, NAN, "amount"),          INT(gno_material, bump.texture.image, 7, "bump: image 7"),
    };
    anything good;
    (void)state;
    good.material = gno_material_default();
    HOLD(&good, give_material, plain);
    good.material.texture = gno_texture_default(GNO_MAP_PLANAR);
    good.material.texture.kind = GNO_TEXTURE_IMAGE;
    good.material.bump.kind = GNO_BUMP_HEIGHT;
    good.material.bump.texture = good.material.texture;
    HOLD(&good, give_material, image);
}

static void test_procedural(void **state)
{
#define P(name) offsetof(gno_material, texture.procedural.name)
    static const field fields[] = {
        {P(pattern), 0, 9, "procedural.pattern"},          {P(pattern), 0, -1, "procedural.pattern"},
        {P(light), 1, -1, "procedural.light"},             {P(dark), 1, NAN, "procedural.dark"},
        {P(mortar_colour), 1, -1, "procedural.mortar_colour"}, {P(origin), 1, INFINITY, "procedural.origin"},
        {P(axis), 1, NAN, "procedural.axis"},              {P(across), 1, NAN, "procedural.across"},
        {P(across[0]), 1, 0, "procedural.across"},         {P(scale), 1, 0, "procedural.scale"},
        {P(rings), 1, 0, "procedural.rings"},              {P(distortion), 1, -1, "procedural.distortion"},
        {P(grain), 1, 1.5, "procedural.grain"},            {P(sharpness), 0, 0, "procedural.sharpness"},
        {P(sharpness), 0, 9, "procedural.sharpness"},      {P(brick[2]), 1, 0, "procedural.brick"},
        {P(mortar), 1, -0.1, "procedural.mortar"},         {P(mortar), 1, 99, "procedural.mortar"},
        {P(brick[0]), 1, 1e-9, "procedural.mortar"},       {P(brick[1]), 1, 1e-9, "procedural.mortar"},
        {P(cover), 1, -0.5, "procedural.cover"},           {P(fractal.octaves), 0, 0, "fractal.octaves"},
        {P(fractal.octaves), 0, 17, "fractal.octaves"},    {P(fractal.gain), 1, 0, "fractal.gain"},
        {P(fractal.gain), 1, 1.5, "fractal.gain"},         {P(fractal.lacunarity), 1, 1, "fractal.lacunarity"},
        {P(fractal.lacunarity), 1, 17, "fractal.lacunarity"}, {P(fractal.weight), 0, 9, "fractal.weight"},
    };
#undef P
    anything good;
    const char *wrong = "untouched";
    (void)state;
    good.material = gno_material_default();
    good.material.texture = gno_texture_default(GNO_MAP_UV);
    good.material.texture.kind = GNO_TEXTURE_PROCEDURAL;
    good.material.texture.procedural = gno_procedural_default(GNO_PATTERN_BRICK);
    HOLD(&good, give_material, fields);
    assert_true(gno_procedural_is_valid(&good.material.texture.procedural, &wrong));
    assert_string_equal(wrong, "untouched");
    good.material.texture.procedural.cover = 2;
    assert_false(gno_procedural_is_valid(&good.material.texture.procedural, NULL));
    assert_false(gno_procedural_is_valid(&good.material.texture.procedural, &wrong));
    assert_string_equal(wrong, "cover");
}

static void test_light(void **state)
{
    static const field fields[] = {
        INT(gno_light, type, 9, "type"),                 REAL(gno_light, position[0], NAN, "position"),
        REAL(gno_light, direction[1], 1e300, "direction"), REAL(gno_light, direction[2], 0, "direction has no length"),
        REAL(gno_light, edge1[2], NAN, "edge1"),         REAL(gno_light, intensity[1], -1, "intensity"),
        INT(gno_light, falloff, 9, "falloff"),           REAL(gno_light, falloff_k, -1, "falloff_k"),
        REAL(gno_light, softness, NAN, "softness"),      REAL(gno_light, angle, 180, "angle"),
        REAL(gno_light, angle, 0, "angle"),
    };
    static const field area[] = {INT(gno_light, samples, 0, "samples")};
    anything good;
    (void)state;
    good.light = gno_light_default();
    good.light.type = GNO_LIGHT_SPOT;
    good.light.direction[0] = good.light.direction[1] = 0;
    good.light.direction[2] = -1;
    HOLD(&good, give_light, fields);
    good.light.type = GNO_LIGHT_AREA;
    HOLD(&good, give_light, area);
}

static void test_camera_and_image(void **state)
{
    static const field perspective[] = {
        INT(gno_camera, type, 9, "type"),        REAL(gno_camera, eye[0], NAN, "eye"),  REAL(gno_camera, target[1], 1e300, "target"),
        REAL(gno_camera, up[2], INFINITY, "up"), REAL(gno_camera, up[2], 0, "up has no length"), REAL(gno_camera, fov, 0, "fov"),
        REAL(gno_camera, fov, 180, "fov"),       REAL(gno_camera, target[1], -5, "same point"),
    };
    static const field orthographic[] = {REAL(gno_camera, height, 0, "height"), REAL(gno_camera, height, 1e300, "height")};
    static const field picture[] = {
        INT(gno_image_def, width, 0, "empty"),
        INT(gno_image_def, height, -3, "empty"),
        INT(gno_image_def, height, GNO_MAX_IMAGE_SIDE + 1, "exceeds"),
        REAL(gno_image_def, background[2], NAN, "background"),
    };
    anything good;
    (void)state;
    good.camera = gno_camera_default();
    memset(good.camera.eye, 0, sizeof good.camera.eye);
    memset(good.camera.target, 0, sizeof good.camera.target);
    memset(good.camera.up, 0, sizeof good.camera.up);
    good.camera.eye[1] = -5;
    good.camera.up[2] = 1;
    HOLD(&good, give_camera, perspective);
    good.camera.type = GNO_CAMERA_ORTHOGRAPHIC;
    HOLD(&good, give_camera, orthographic);
    good.image = gno_image_def_default();
    good.image.width = good.image.height = 2;
    HOLD(&good, give_image, picture);
}

static void test_mesh_and_pixels(void **state)
{
    static const field mesh[] = {
        NONE(gno_mesh_def, positions, "positions is NULL"),      COUNT(gno_mesh_def, normal_count, 1, "normals is NULL"),
        COUNT(gno_mesh_def, texcoord_count, 1, "texcoords is NULL"), NONE(gno_mesh_def, corner_vertex, "corner_vertex is NULL"),
        COUNT(gno_mesh_def, ring_count, 2, "2 rings for 1"),     COUNT(gno_mesh_def, corner_count, 4, "4 corners for 1"),
        INT(gno_mesh_def, shading, 9, "shading"),                INT(gno_mesh_def, weighting, 9, "weighting"),
        REAL(gno_mesh_def, crease, 181, "crease"),               INT(gno_mesh_def, priority, 40000, "priority"),
        INT(gno_mesh_def, material, 99, "material"),             REAL(gno_mesh_def, transform[3], NAN, "transform"),
        INT(gno_mesh_def, detail_of, 1000000, "detail_of"),
    };
    static const field pixels[] = {
        INT(gno_pixels, width, 0, "empty"),      INT(gno_pixels, height, GNO_MAX_IMAGE_SIDE + 1, "exceeds"),
        INT(gno_pixels, channels, 5, "channels"), INT(gno_pixels, channels, 0, "channels"), NONE(gno_pixels, linear, "exactly one"),
    };
    const float nan[3] = {1, NAN, 1};
    anything good;
    (void)state;
    good.mesh = good_mesh();
    HOLD(&good, give_mesh, mesh);
    good.pixels = good_pixels();
    HOLD(&good, give_pixels, pixels);
    good.pixels.bytes = black;
    assert_int_equal(give_pixels(&good), GNO_ERROR_ARGUMENT);
    good.pixels.bytes = NULL;
    good.pixels.linear = nan;
    assert_int_equal(give_pixels(&good), GNO_ERROR_ARGUMENT);
    assert_non_null(strstr(gno_context_message(context), "value 1 is not finite"));
}

static void test_camera_path(void **state)
{
    static const gno_camera_key keys[2] = {{3, {0, -5, 0}, {0, 0, 0}, {0, 0, 1}, 40, 1}, {3, {0, -6, 0}, {0, 0, 0}, {0, 0, 1}, 40, 1}};
    static const field turntable[] = {
        INT(gno_camera_path, type, 9, "type"),        INT(gno_camera_path, interpolation, 9, "interpolation"),
        INT(gno_camera_path, frames, 0, "0 frames"),  INT(gno_camera_path, frames, GNO_MAX_FRAMES + 1, "frames"),
    };
    static const field by_keys[] = {
        COUNT(gno_camera_path, key_count, 0, "no keys"),
        NONE(gno_camera_path, keys, "no keys"),
        COUNT(gno_camera_path, key_count, GNO_MAX_KEYS + 1, "more than"),
        COUNT(gno_camera_path, key_count, 2, "frame 3 of key 1"),
    };
    gno_camera camera = gno_camera_default();
    anything good;
    (void)state;
    good.path = gno_camera_path_default();
    HOLD(&good, give_path, turntable);
    good.path.type = GNO_PATH_KEYS;
    good.path.key_count = 1;
    good.path.keys = keys;
    HOLD(&good, give_path, by_keys);
    assert_int_equal(gno_camera_path_at(&good.path, &camera, NAN, &camera), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_camera_path_at(NULL, &camera, 0, &camera), GNO_ERROR_ARGUMENT);
    good.path.key_count = 0;
    assert_int_equal(gno_camera_path_at(&good.path, &camera, 0, &camera), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_scene_set_camera_path(NULL, &good.path), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_scene_set_camera_path(scene, NULL), GNO_OK); /* none any more */
}

static void test_calls(void **state)
{
    static const field render[] = {
        INT(gno_render_def, lines, 0, "lines: 0"),       INT(gno_render_def, lines, GNO_MAX_LINES + 1, "lines"),
        INT(gno_render_def, base_lines, 0, "odd multiple"), INT(gno_render_def, lines, 7, "odd multiple"),
        INT(gno_render_def, lines, 8, "odd multiple"),   INT(gno_render_def, base_lines, 6, "can be refined"),
        REAL(gno_render_def, refine_above, -1, "refine_above"), INT(gno_render_def, engine, 7, "engine"),
        INT(gno_render_def, threads, -1, "threads"),     INT(gno_render_def, threads, GNO_MAX_THREADS + 1, "threads"),
    };
    static const field matrix[] = {
        INT(gno_matrix_def, threads, -1, "threads"), INT(gno_matrix_def, point, 1, "point 1 of a light of 1"),
        INT(gno_matrix_def, point, -2, "point -2"),  INT(gno_matrix_def, threads, GNO_MAX_THREADS + 1, "threads"),
    };
    static const field lit[] = {INT(gno_lit_def, threads, -1, "threads"), INT(gno_lit_def, threads, GNO_MAX_THREADS + 1, "threads")};
    static const field visible[] = {INT(gno_visible_def, threads, -1, "threads"), INT(gno_visible_def, threads, GNO_MAX_THREADS + 1, "threads")};
    gno_layers layers = gno_layers_default();
    anything good;
    (void)state;
    good.render = gno_render_def_default();
    HOLD(&good, give_render, render);
    good.render.engine = GNO_ENGINE_WEILER_ATHERTON;
    good.render.layers = &layers;
    assert_int_equal(give_render(&good), GNO_ERROR_ARGUMENT);
    assert_non_null(strstr(gno_context_message(context), "layers"));
    good.matrix = gno_matrix_def_default();
    HOLD(&good, give_matrix, matrix);
    good.lit = gno_lit_def_default();
    HOLD(&good, give_lit, lit);
    good.visible = gno_visible_def_default();
    HOLD(&good, give_visible, visible);
}

/* NULL where something must be: a status, and where there is a context a message that names the call. */
static void test_nothing_given(void **state)
{
    static const size_t start[2] = {0, 1}, empty[1] = {0};
    static const unsigned casters[1] = {0};
    gno_material material = gno_material_default();
    gno_light light = gno_light_default();
    gno_camera camera = gno_camera_default();
    gno_image_def image = gno_image_def_default();
    gno_pixels pixels = good_pixels();
    gno_matrix *matrix = NULL, *small;
    gno_matrix_column column;
    gno_matrix_info info;
    gno_matrix_check_result result;
    gno_matrix_cursor cursor;
    double ambient[3] = {0, 0, 0};
    float rgb[12];
    gno_scene *none = NULL;
    (void)state;
    memset(&cursor, 0, sizeof cursor);
#define MESSAGE(call, word)                                                                                                                 \
    do {                                                                                                                                    \
        assert_int_equal(call, GNO_ERROR_ARGUMENT);                                                                                         \
        assert_non_null(strstr(gno_context_message(context), word));                                                                        \
    } while (0)
    MESSAGE(gno_scene_create(context, NULL), "gno_scene_create");
    MESSAGE(gno_scene_add_material(scene, NULL, NULL), "gno_scene_add_material");
    MESSAGE(gno_scene_add_light(scene, NULL, NULL, NULL), "gno_scene_add_light");
    MESSAGE(gno_scene_material(scene, 0, NULL), "gno_scene_material");
    MESSAGE(gno_scene_set_camera(scene, NULL), "gno_scene_set_camera");
    MESSAGE(gno_scene_set_image(scene, NULL), "gno_scene_set_image");
    MESSAGE(gno_scene_set_ambient(scene, NULL), "gno_scene_set_ambient");
    MESSAGE(gno_scene_polygon(scene, 0, NULL), "gno_scene_polygon");
    MESSAGE(gno_scene_add_image(scene, NULL, NULL), "gno_scene_add_image");
    MESSAGE(gno_render(scene, NULL, NULL, NULL), "gno_render");
    MESSAGE(gno_matrix_build(scene, 0, NULL, NULL), "gno_matrix_build");
    MESSAGE(gno_matrix_build(scene, -1, NULL, &matrix), "light -1 of");
    MESSAGE(gno_matrix_build(scene, 1000, NULL, &matrix), "light 1000 of");
    MESSAGE(gno_matrix_from_columns(context, 1, NULL, casters, &matrix), "NULL");
    MESSAGE(gno_matrix_from_columns(context, 1, start, NULL, &matrix), "NULL");
    assert_int_equal(gno_matrix_from_columns(context, (size_t)GNO_MAX_POLYGONS + 1, start, casters, &matrix), GNO_ERROR_LIMIT);
    assert_int_equal(gno_matrix_from_columns(context, 0, empty, NULL, &small), GNO_OK);
    MESSAGE(gno_matrix_get_column(small, 0, &column), "column 0 of 0");
    MESSAGE(gno_matrix_get_info(small, NULL), "gno_matrix_get_info");
    MESSAGE(gno_matrix_check(scene, 0, small, &result), "gno_matrix_check");
    MESSAGE(gno_matrix_check(scene, 0, NULL, &result), "gno_matrix_check");
    MESSAGE(gno_matrix_check(scene, 1000, small, &result), "gno_matrix_check");
    gno_matrix_destroy(small);
#undef MESSAGE
    assert_int_equal(gno_scene_create(NULL, &none), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_scene_add_material(NULL, &material, NULL), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_scene_add_light(NULL, NULL, &light, NULL), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_scene_material(NULL, 0, &material), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_scene_set_camera(NULL, &camera), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_scene_set_image(NULL, &image), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_scene_set_ambient(NULL, ambient), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_scene_add_image(NULL, &pixels, NULL), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_render(NULL, NULL, rgb, NULL), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_matrix_build(NULL, 0, NULL, &matrix), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_matrix_from_columns(NULL, 1, start, casters, &matrix), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_matrix_get_column(NULL, 0, &column), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_matrix_get_info(NULL, &info), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_matrix_check(NULL, 0, NULL, &result), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_matrix_next(NULL, &cursor), 0);
    assert_null(matrix);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_material),    cmocka_unit_test(test_procedural), cmocka_unit_test(test_light), cmocka_unit_test(test_camera_and_image),
        cmocka_unit_test(test_mesh_and_pixels), cmocka_unit_test(test_camera_path), cmocka_unit_test(test_calls),
        cmocka_unit_test(test_nothing_given),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down) != 0;
}
