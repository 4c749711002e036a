/* test_scene_faults.c -- scene files damaged at random, and loading with every allocation made to fail once.
 * Place: tests of src/io. SCENE_MUTATIONS sets the number of damaged files (default 4000).
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <gnomon/gnomon_io.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char folder[] = "/tmp/gnomon-test-XXXXXX";

static const char scene_text[] =
    "gnomon: 1\n"
    "image:   {width: 64, height: 48, background: [0.02, 0.03, 0.05]}\n"
    "camera:  {type: perspective, eye: [3, -6, 2], target: [0, 0, 1], up: [0, 0, 1], fov: 40}\n"
    "ambient: [0.25, 0.25, 0.25]\n"
    "lights:\n"
    "  - &lamp {name: lamp, type: point, position: [2, -3, 5], intensity: [0.8, 0.8, 0.8], falloff: linear, k: 1.0, distance: light}\n"
    "  - {name: sun, type: directional, direction: [-0.4, 0.3, -1], intensity: [0.6, 0.55, 0.5]}\n"
    "  - {type: spot, position: [1, 2, 3], direction: [0, 0, -1], angle: 30, softness: 1}\n"
    "  - {type: area, position: [1, 2, 3], edge1: [1, 0, 0], edge2: [0, 2, 0], samples: 2}\n"
    "materials:\n"
    "  brick: &brick {ambient: [0.6,0.2,0.15], diffuse: [0.6,0.2,0.15], specular: 0.1, shininess: 20, shading: flat,\n"
    "          two_sided: true, transmission: 0, reflection: 0, ior: 1.0,\n"
    "          texture: {image: textures/brick.png, map: planar, origin: [0,0,0], u: [1,0,0], v: [0,0,1], scale: [2,2]},\n"
    "          bump: {image: textures/brick_height.png, amount: 0.05}}\n"
    "  oak:   {diffuse: [1,1,1], texture: {procedural: wood, light: [0.7,0.5,0.3], dark: [0.4,0.25,0.1], rings: 12, seed: 1}}\n"
    "  other: *brick\n"
    "objects:\n"
    "  - {mesh: tri.obj, material: brick, shading: phong, crease: 40,\n"
    "     transform: [{scale: 2}, {rotate: [1,0,0], angle: 90}, {translate: [0,0,0.5]}]}\n"
    "  - name: wall\n"
    "    polygon: [[0,0,0],[4,0,0],[4,0,3],[0,0,3]]\n"
    "    holes: [[[1,0,1],[1,0,2],[2,0,2],[2,0,1]]]\n"
    "    material: brick\n"
    "  - {name: sign, polygon: [[1,0,2.2],[2,0,2.2],[2,0,2.6],[1,0,2.6]], detail_of: wall, priority: 1, material: oak}\n"
    "  - {sphere: {center: [0,0,1], radius: 0.5}, material: oak}\n";

static void put(const char *name, const char *text, size_t size)
{
    FILE *file = fopen(name, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(text, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static int set_up(void **state)
{
    (void)state;
    static const char triangle[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    if (!mkdtemp(folder) || chdir(folder) != 0) return -1;
    put("tri.obj", triangle, sizeof triangle - 1);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    remove("scene.yaml");
    remove("tri.obj");
    return chdir("/") == 0 && rmdir(folder) == 0 ? 0 : -1;
}

/* ---- damage ------------------------------------------------------------------------------------------------------------------- */

static unsigned next_random(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (unsigned)(*state >> 33);
}

/* One change: a byte set, a stretch cut out, doubled, or replaced by something that means much to YAML. */
static size_t damage(char *text, size_t size, size_t room, uint64_t *random)
{
    static const char *const pieces[] = {"{", "}", "[", "]", ":", ",", "\n", "- ", "*lamp", "&a ", "\"", "'", "#", "|", ">", "%", "!",
                                         "~", ".nan", "-1", "1e999", "0", "\t", "? ", "---\n", "<<", "\\", "\xff", "99999999999"};
    size_t at = next_random(random) % size, length = 1 + next_random(random) % 20;
    if (length > size - at) length = size - at;
    const char *piece = pieces[next_random(random) % (sizeof pieces / sizeof *pieces)];
    size_t piece_size = strlen(piece);
    switch (next_random(random) % 5) {
    case 0: text[at] = (char)next_random(random); return size;
    case 1: memmove(text + at, text + at + length, size - at - length); return size - length;
    case 2:
        if (size + length > room) return size;
        memmove(text + at + length, text + at, size - at);
        return size + length;
    default:
        if (size + piece_size > room) return size;
        memmove(text + at + piece_size, text + at, size - at);
        memcpy(text + at, piece, piece_size);
        return size + piece_size;
    }
}

static void test_damaged_files(void **state)
{
    (void)state;
    enum { ROOM = sizeof scene_text + 400 };
    const char *setting = getenv("SCENE_MUTATIONS");
    long rounds = setting ? strtol(setting, NULL, 10) : 4000, loaded = 0;
    uint64_t random = 20;
    gno_context *context = NULL;
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    size_t empty = gno_context_memory(context, NULL);
    for (long round = 0; round < rounds; round++) {
        char text[ROOM];
        size_t size = sizeof scene_text - 1;
        gno_scene *scene = NULL;
        memcpy(text, scene_text, size);
        for (unsigned changes = 1 + next_random(&random) % 4; changes > 0 && size > 0; changes--) {
            size = damage(text, size, ROOM, &random);
        }
        put("scene.yaml", text, size);
        gno_status status = gno_scene_load(context, "scene.yaml", NULL, 0, &scene);
        assert_true((status == GNO_OK) == (scene != NULL));
        if (status != GNO_OK && strncmp(gno_context_message(context), "scene.yaml:", 11)) {
            fail_msg("%s", gno_context_message(context));
        }
        loaded += status == GNO_OK;
        gno_scene_destroy(scene);
        assert_int_equal(gno_context_memory(context, NULL), empty);
    }
    assert_true(loaded < rounds || rounds == 0);
    gno_context_destroy(context);
}

/* ---- allocations that fail ------------------------------------------------------------------------------------------------------- */

typedef struct counter {
    long calls, fail_at, blocks;
} counter;

static void *counting(void *user, void *block, size_t old_size, size_t new_size)
{
    counter *count = user;
    (void)old_size;
    if (new_size == 0) {
        count->blocks -= block != NULL;
        free(block);
        return NULL;
    }
    if (++count->calls == count->fail_at) return NULL;
    void *result = realloc(block, new_size);
    assert_non_null(result);
    count->blocks += block == NULL;
    return result;
}

/* True when the load got through. */
static int load_failing_at(const char *path, long fail_at, const gno_setting *settings, size_t setting_count)
{
    counter count = {0, fail_at, 0};
    gno_context *context = NULL;
    gno_scene *scene = NULL;
    gno_context_def def = gno_context_def_default();
    def.alloc = counting;
    def.alloc_user = &count;
    if (gno_context_create(&def, &context) != GNO_OK) {
        assert_int_equal(count.blocks, 0);
        return 0;
    }
    gno_status status = gno_scene_load(context, path, settings, setting_count, &scene);
    int failed = count.calls >= fail_at;
    if (failed) {
        assert_int_equal(status, GNO_ERROR_MEMORY);
        assert_null(scene);
        assert_true(*gno_context_message(context));
    } else {
        assert_int_equal(status, GNO_OK);
    }
    gno_scene_destroy(scene);
    gno_context_destroy(context);
    assert_int_equal(count.blocks, 0);
    return !failed;
}

static void test_failing_memory(void **state)
{
    (void)state;
    static const gno_setting settings[] = {{"camera.eye", "[1, 2, 3]"}, {"lights[0].intensity", "2"}};
    long fail_at = 1;
    put("scene.yaml", scene_text, sizeof scene_text - 1);
    while (!load_failing_at("scene.yaml", fail_at, settings, 2)) fail_at++;
    assert_true(fail_at > 20);
    for (fail_at = 1; !load_failing_at("tri.obj", fail_at, settings, 1); fail_at++) {
    }
    assert_true(fail_at > 10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_damaged_files),
        cmocka_unit_test(test_failing_memory),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down) != 0;
}
