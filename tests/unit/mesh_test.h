/* mesh_test.h -- what the tests of the mesh readers share: a folder for small files, a scene to read them into, the log.
 * For inclusion after cmocka.h, in test programs only.
 */
#ifndef MESH_TEST_H
#define MESH_TEST_H

#include "io/mesh_file.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* One test's folder, context and scene. */
typedef struct bed {
    char folder[64];
    char files[64][64];
    int file_count;
    gno_context *context;
    gno_scene *scene;
    char log[4096]; /* warnings, one a line, in order */
    gnoi_mesh_result result;
} bed;

static inline void keep_log(void *user, gno_log_level level, const char *text)
{
    bed *b = user;
    size_t used = strlen(b->log);
    (void)level;
    snprintf(b->log + used, sizeof b->log - used, "%s\n", text);
}

static inline void start_scene(bed *b)
{
    gno_context_def def = gno_context_def_default();
    def.log = keep_log;
    def.log_user = b;
    b->log[0] = '\0';
    assert_int_equal(gno_context_create(&def, &b->context), GNO_OK);
    assert_int_equal(gno_scene_create(b->context, &b->scene), GNO_OK);
}

static inline void end_scene(bed *b)
{
    gno_scene_destroy(b->scene);
    gno_context_destroy(b->context);
    b->scene = NULL;
    b->context = NULL;
}

static inline int set_up(void **state)
{
    bed *b = calloc(1, sizeof *b);
    if (!b) return -1;
    strcpy(b->folder, "/tmp/gnomon-mesh-XXXXXX");
    if (!mkdtemp(b->folder)) return -1;
    start_scene(b);
    *state = b;
    return 0;
}

static inline const char *path_of(const bed *b, const char *name)
{
    static char path[160];
    snprintf(path, sizeof path, "%s/%s", b->folder, name);
    return path;
}

static inline int tear_down(void **state)
{
    bed *b = *state;
    end_scene(b);
    for (int i = 0; i < b->file_count; i++) remove(path_of(b, b->files[i]));
    int failed = rmdir(b->folder);
    free(b);
    return failed;
}

static inline void write_bytes(bed *b, const char *name, const void *bytes, size_t size)
{
    FILE *file = fopen(path_of(b, name), "wb");
    assert_non_null(file);
    if (size) assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
    for (int i = 0; i < b->file_count; i++)
        if (strcmp(b->files[i], name) == 0) return;
    assert_true(b->file_count < 64);
    snprintf(b->files[b->file_count++], sizeof b->files[0], "%s", name);
}

static inline void write_text(bed *b, const char *name, const char *text)
{
    write_bytes(b, name, text, strlen(text));
}

static inline gno_status load_file(bed *b, const char *name, const gnoi_mesh_options *options)
{
    return gnoi_mesh_load(b->scene, path_of(b, name), options, &b->result);
}

/* Reads a file that must be fine, into a fresh scene. */
static inline void load_good(bed *b, const char *name, const gnoi_mesh_options *options)
{
    end_scene(b);
    start_scene(b);
    if (load_file(b, name, options) != GNO_OK) fail_msg("%s", gno_context_message(b->context));
}

/* Reads a file that must fail, with a message that is "FOLDER/" and `message`. */
static inline void load_bad(bed *b, const char *name, gno_status status, const char *message)
{
    end_scene(b);
    start_scene(b);
    assert_int_equal(load_file(b, name, NULL), status);
    assert_string_equal(gno_context_message(b->context), path_of(b, message));
}

static inline int has_warning(const bed *b, const char *text)
{
    return strstr(b->log, text) != NULL;
}

static inline void check_near(double a, double b, double tolerance)
{
    if (!(a - b <= tolerance && b - a <= tolerance)) fail_msg("%.17g is not %.17g", a, b);
}

static inline void check_vector(const double *a, double x, double y, double z, double tolerance)
{
    check_near(a[0], x, tolerance);
    check_near(a[1], y, tolerance);
    check_near(a[2], z, tolerance);
}

static inline gno_polygon polygon_at(const bed *b, size_t index)
{
    gno_polygon polygon;
    assert_int_equal(gno_scene_polygon(b->scene, index, &polygon), GNO_OK);
    return polygon;
}

static inline unsigned corner_count(const gno_polygon *polygon)
{
    return polygon->ring_start[polygon->ring_count] - polygon->ring_start[0];
}

/* The position of a polygon's corner. */
static inline const double *corner_at(const gno_polygon *polygon, unsigned corner)
{
    return polygon->positions + 3 * (size_t)polygon->corner_vertex[polygon->ring_start[0] + corner];
}

static inline gno_material material_of(const bed *b, size_t polygon)
{
    gno_material material;
    assert_int_equal(gno_scene_material(b->scene, polygon_at(b, polygon).material, &material), GNO_OK);
    return material;
}

/* An allocator that counts what is held, and fails from one allocation on. */
typedef struct failing {
    long countdown; /* allocations until they fail */
    long blocks;
    size_t bytes;
} failing;

static inline void *failing_alloc(void *user, void *block, size_t old_size, size_t new_size)
{
    failing *f = user;
    if (new_size == 0) {
        f->blocks -= block != NULL;
        f->bytes -= old_size;
        free(block);
        return NULL;
    }
    if (f->countdown == 0) return NULL;
    f->countdown--;
    void *result = realloc(block, new_size);
    if (!result) return NULL;
    f->blocks += block == NULL;
    f->bytes += new_size - old_size;
    return result;
}

static inline gno_status load_failing(const char *path, failing *f)
{
    gno_context_def def = gno_context_def_default();
    gno_context *context = NULL;
    gno_scene *scene = NULL;
    def.alloc = failing_alloc;
    def.alloc_user = f;
    gno_status status = gno_context_create(&def, &context);
    if (status != GNO_OK) return status;
    status = gno_scene_create(context, &scene);
    if (status == GNO_OK) status = gnoi_mesh_load(scene, path, NULL, NULL);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
    return status;
}

/* Reads the file again and again, each time one allocation more succeeds, until all do; nothing may be left over. Returns
 * how many allocations there are. */
static inline long fail_every_allocation(const char *path)
{
    gno_status status = GNO_ERROR_MEMORY;
    long n = 0;
    for (; status != GNO_OK; n++) {
        failing f = {n, 0, 0};
        assert_true(n < 1000);
        status = load_failing(path, &f);
        assert_int_equal(f.blocks, 0);
        assert_int_equal(f.bytes, 0);
        if (status != GNO_OK) assert_int_equal(status, GNO_ERROR_MEMORY);
    }
    return n;
}

/* The path of a file of the project's data (GNOMON_DATA, or ../shared/data beside the repository); NULL when it is absent. */
static inline const char *data_file(const char *name)
{
    static char path[512];
    const char *root = getenv("GNOMON_DATA");
    snprintf(path, sizeof path, "%s/%s", root ? root : "../shared/data", name);
    return access(path, R_OK) == 0 ? path : NULL;
}

#endif
