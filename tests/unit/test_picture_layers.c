/* test_picture_layers.c -- layers in EXR files: names, types and values read back by OpenEXRCore; ids and manifest as the
 * Cryptomatte specification has them.
 */
#define _DEFAULT_SOURCE /* mkstemps */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "fail_alloc.h"
#include "io/cryptomatte.h"
#include "support/random_scene.h"
#include <OpenEXR/openexr.h>
#include <gnomon/gnomon_io.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define WIDTH 40
#define HEIGHT 30
#define PIXELS (WIDTH * HEIGHT)
#define RANKS 4
#define LIGHTS 3

static char path[] = "/tmp/gnomon-layers-XXXXXX.exr";

static float rgb[3 * PIXELS], depth[PIXELS], normal[3 * PIXELS], uv[2 * PIXELS], coverage[PIXELS], shadow[LIGHTS * PIXELS];
static unsigned id[3][RANKS * PIXELS];
static float share[3][RANKS * PIXELS];

static gno_layers all_layers(void)
{
    gno_layers l = gno_layers_default();
    gno_ranks *ranks[3];
    ranks[0] = &l.polygons;
    ranks[1] = &l.objects;
    ranks[2] = &l.materials;
    l.depth = depth;
    l.normal = normal;
    l.uv = uv;
    l.coverage = coverage;
    l.shadow = shadow;
    for (int i = 0; i < 3; i++) {
        ranks[i]->count = RANKS;
        ranks[i]->id = id[i];
        ranks[i]->coverage = share[i];
    }
    return l;
}

static void add_quad(gno_scene *scene, const char *name, double z, double size)
{
    const double positions[12] = {-size, -size, z, size, -size, z, size, size, z, -size, size, z};
    static const int corner[4] = {0, 1, 2, 3};
    static const unsigned rings[2] = {0, 4};
    gno_mesh_def mesh = gno_mesh_def_default();
    mesh.name = name;
    mesh.vertex_count = mesh.corner_count = 4;
    mesh.positions = positions;
    mesh.polygon_count = mesh.ring_count = 1;
    mesh.ring_start = rings;
    mesh.corner_vertex = corner;
    assert_int_equal(gno_scene_add_mesh(scene, &mesh, NULL), GNO_OK);
}

/* Three squares over each other, two of them nameless or oddly named; lights named alike, with a dot, and not at all. */
static gno_scene *make_scene(gno_context *context)
{
    static const char *const names[LIGHTS] = {"key.left", "key.left", NULL};
    gno_scene *scene = NULL;
    gno_image_def image = gno_image_def_default();
    gno_light light = gno_light_default();
    assert_int_equal(gno_scene_create(context, &scene), GNO_OK);
    image.width = WIDTH;
    image.height = HEIGHT;
    assert_int_equal(gno_scene_set_image(scene, &image), GNO_OK);
    add_quad(scene, "bunny", 0, 2);
    add_quad(scene, NULL, 0.5, 1);
    add_quad(scene, "a \"b\"\\\n", 1, 0.5);
    light.position[2] = 5;
    for (int i = 0; i < LIGHTS; i++)
        assert_int_equal(gno_scene_add_light(scene, names[i], &light, NULL), GNO_OK);
    return scene;
}

/* ---- reading back ----------------------------------------------------------------------------------------------------- */

typedef struct reader {
    exr_context_t exr;
    const exr_attr_chlist_t *list;
    float *values; /* channel by channel, all of 32 bits */
} reader;

static void quiet(exr_const_context_t exr, exr_result_t code, const char *text)
{
    (void)exr;
    (void)code;
    (void)text;
}

static void read_blocks(reader *r, int rows)
{
    for (int y = 0; y < HEIGHT; y += rows) {
        exr_chunk_info_t chunk;
        exr_decode_pipeline_t pipeline = EXR_DECODE_PIPELINE_INITIALIZER;
        assert_int_equal(exr_read_scanline_chunk_info(r->exr, 0, y, &chunk), EXR_ERR_SUCCESS);
        assert_int_equal(exr_decoding_initialize(r->exr, 0, &chunk, &pipeline), EXR_ERR_SUCCESS);
        for (int c = 0; c < pipeline.channel_count; c++) {
            exr_coding_channel_info_t *channel = &pipeline.channels[c];
            channel->decode_to_ptr = (uint8_t *)(r->values + (size_t)c * PIXELS + (size_t)y * WIDTH);
            channel->user_pixel_stride = 4;
            channel->user_line_stride = 4 * WIDTH;
            channel->user_bytes_per_element = 4;
            channel->user_data_type = channel->data_type == EXR_PIXEL_UINT ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
        }
        assert_int_equal(exr_decoding_choose_default_routines(r->exr, 0, &pipeline), EXR_ERR_SUCCESS);
        assert_int_equal(exr_decoding_run(r->exr, 0, &pipeline), EXR_ERR_SUCCESS);
        exr_decoding_destroy(r->exr, &pipeline);
    }
}

static reader open_file(void)
{
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    reader r;
    int32_t rows = 0;
    memset(&r, 0, sizeof r);
    init.error_handler_fn = quiet;
    assert_int_equal(exr_start_read(&r.exr, path, &init), EXR_ERR_SUCCESS);
    assert_int_equal(exr_get_channels(r.exr, 0, &r.list), EXR_ERR_SUCCESS);
    assert_int_equal(exr_get_scanlines_per_chunk(r.exr, 0, &rows), EXR_ERR_SUCCESS);
    r.values = calloc((size_t)r.list->num_channels * PIXELS, sizeof *r.values);
    assert_non_null(r.values);
    read_blocks(&r, rows);
    return r;
}

static void close_file(reader *r)
{
    free(r->values);
    exr_finish(&r->exr);
}

static const float *channel(const reader *r, const char *name, exr_pixel_type_t type)
{
    for (int c = 0; c < r->list->num_channels; c++)
        if (strcmp(r->list->entries[c].name.str, name) == 0) {
            assert_int_equal(r->list->entries[c].pixel_type, type);
            return r->values + (size_t)c * PIXELS;
        }
    fail_msg("no channel %s", name);
    return NULL;
}

static const char *note(const reader *r, const char *set, const char *what)
{
    char name[64];
    const char *text = NULL;
    int32_t length = 0;
    snprintf(name, sizeof name, "cryptomatte/%.7s/%s", set, what);
    assert_int_equal(exr_attr_get_string(r->exr, 0, name, &length, &text), EXR_ERR_SUCCESS);
    return text;
}

/* ---- tests ------------------------------------------------------------------------------------------------------------ */

/* The specification's own examples. */
static void test_ids(void **state)
{
    (void)state;
    assert_int_equal(gnoi_crypto_id("bunny"), 0x13851a76);
    assert_int_equal(gnoi_crypto_id("default"), 0x42c9679f);
    assert_true(gnoi_crypto_id("bunny_porcelain_mat") == 0xb24b26d4u);
}

static void write_scene(gno_context *context)
{
    gno_scene *scene = make_scene(context);
    gno_layers layers = all_layers();
    gno_render_def def = gno_render_def_default();
    def.layers = &layers;
    assert_int_equal(gno_render(scene, &def, rgb, NULL), GNO_OK);
    assert_int_equal(gno_picture_write_layers(scene, path, NULL, rgb, &layers), GNO_OK);
    gno_scene_destroy(scene);
}

static void expect_plane(const reader *r, const char *name, const float *values, size_t step)
{
    const float *found = channel(r, name, EXR_PIXEL_FLOAT);
    for (size_t i = 0; i < PIXELS; i++)
        if (memcmp(&found[i], &values[i * step], sizeof *found) != 0)
            fail_msg("%s: pixel %zu: %g instead of %g", name, i, (double)found[i], (double)values[i * step]);
}

static void test_channels(void **state)
{
    gno_context *context = NULL;
    reader r;
    const float *numbers;
    (void)state;
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    write_scene(context);
    r = open_file();
    channel(&r, "R", EXR_PIXEL_HALF);
    expect_plane(&r, "depth.Z", depth, 1);
    expect_plane(&r, "normal.X", normal, 3);
    expect_plane(&r, "normal.Z", normal + 2, 3);
    expect_plane(&r, "uv.V", uv + 1, 2);
    expect_plane(&r, "coverage.A", coverage, 1);
    expect_plane(&r, "shadow.key_left", shadow, 1);
    expect_plane(&r, "shadow.key_left_1", shadow + PIXELS, 1);
    expect_plane(&r, "shadow.light2", shadow + 2 * PIXELS, 1);
    expect_plane(&r, "CryptoObject00.G", share[1], RANKS);
    expect_plane(&r, "CryptoMaterial01.A", share[2] + 3, RANKS);
    numbers = channel(&r, "polygon.id", EXR_PIXEL_UINT);
    for (size_t i = 0; i < PIXELS; i++)
        assert_memory_equal(&numbers[i], &id[0][i * RANKS], 4);
    assert_int_equal(r.list->num_channels, 3 + 1 + 3 + 2 + 1 + LIGHTS + 1 + 3 * 2 * RANKS);
    close_file(&r);
    gno_context_destroy(context);
}

static void test_cryptomatte(void **state)
{
    static const char *const names[3] = {"bunny", "1", "a \"b\"\\\n"};
    gno_context *context = NULL;
    char set[16], part[64];
    const char *manifest;
    const float *found;
    reader r;
    (void)state;
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    write_scene(context);
    r = open_file();
    snprintf(set, sizeof set, "%08x", (unsigned)gnoi_crypto_id("CryptoObject"));
    assert_string_equal(note(&r, set, "name"), "CryptoObject");
    assert_string_equal(note(&r, set, "hash"), "MurmurHash3_32");
    assert_string_equal(note(&r, set, "conversion"), "uint32_to_float32");
    manifest = note(&r, set, "manifest");
    assert_int_equal(manifest[0], '{');
    assert_int_equal(manifest[strlen(manifest) - 1], '}');
    assert_non_null(strstr(manifest, "\"bunny\":\"13851a76\""));
    snprintf(part, sizeof part, "\"a \\\"b\\\"\\\\\\u000a\":\"%08x\"", (unsigned)gnoi_crypto_id(names[2]));
    assert_non_null(strstr(manifest, part));
    found = channel(&r, "CryptoObject00.R", EXR_PIXEL_FLOAT);
    for (size_t i = 0; i < PIXELS; i++) {
        unsigned number = id[1][i * RANKS];
        uint32_t bits;
        memcpy(&bits, &found[i], 4);
        assert_true(bits == (number == GNO_BACKGROUND ? 0 : gnoi_crypto_id(names[number])));
    }
    close_file(&r);
    gno_context_destroy(context);
}

static void test_refused(void **state)
{
    gno_context *context = NULL;
    gno_scene *scene;
    gno_layers layers = all_layers();
    (void)state;
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    scene = make_scene(context);
    assert_int_equal(gno_picture_write_layers(scene, "/tmp/a.png", NULL, rgb, &layers), GNO_ERROR_ARGUMENT);
    assert_non_null(strstr(gno_context_message(context), "layers need an .exr"));
    id[1][17] = 3; /* one more than there are objects */
    assert_int_equal(gno_picture_write_layers(scene, path, NULL, rgb, &layers), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_picture_write_layers(scene, path, NULL, rgb, NULL), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_picture_write_layers(NULL, path, NULL, rgb, &layers), GNO_ERROR_ARGUMENT);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

static void test_every_allocation_fails(void **state)
{
    (void)state;
    memset(id, 0, sizeof id);
    for (size_t at = 1, done = 0; !done; at++) {
        fail_alloc alloc = {0};
        gno_context_def def = fail_alloc_def(&alloc);
        gno_context *context = NULL;
        gno_layers layers = all_layers();
        gno_scene *scene;
        gno_status status;
        assert_int_equal(gno_context_create(&def, &context), GNO_OK);
        scene = make_scene(context);
        alloc.fail_at = alloc.calls + at;
        status = gno_picture_write_layers(scene, path, NULL, rgb, &layers);
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
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_ids), cmocka_unit_test(test_channels), cmocka_unit_test(test_cryptomatte),
                                       cmocka_unit_test(test_refused), cmocka_unit_test(test_every_allocation_fails)};
    int file = mkstemps(path, 4), failed;
    if (file < 0)
        return 1;
    close(file);
    failed = cmocka_run_group_tests(tests, NULL, NULL);
    unlink(path);
    return failed != 0;
}
