/* test_vector.c -- drawings: SVG that a strict reader takes, shapes whose areas are those of the pieces, names that need escaping,
 * lines, PDF; the same bytes for any number of threads; every allocation made to fail once.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>
#include <gnomon/gnomon_io.h>
#include <gnomon/gnomon_pieces.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fail_alloc.h"

typedef struct bed {
    gno_context *context;
    gno_scene *scene;
    char folder[64], path[96];
} bed;

static void make_scene(gno_context *context, gno_scene **scene)
{
    static const double floor[] = {-4, -4, 0, 4, -4, 0, 4, 4, 0, -4, 4, 0};
    static const double wall[] = {-1, 0, 0, 1, 0, 0, 1, 0, 2, -1, 0, 2, -0.5, 0, 0.5, 0.5, 0, 0.5, 0.5, 0, 1.5, -0.5, 0, 1.5};
    static const double roof[] = {-1, 0, 2, 1, 0, 2, 1, 1, 2.2, -1, 1, 2.2};
    static const unsigned one[] = {0, 4}, two[] = {0, 4, 8}, start[] = {0, 2};
    static const int corners[] = {0, 1, 2, 3, 4, 5, 6, 7};
    gno_mesh_def mesh = gno_mesh_def_default();
    gno_material material = gno_material_default();
    gno_light light = gno_light_default();
    gno_image_def image = {200, 120, {0.2, 0.4, 0.8}};
    gno_camera camera = gno_camera_default();
    assert_int_equal(gno_scene_create(context, scene), GNO_OK);
    camera.target[2] = 0.8;
    assert_int_equal(gno_scene_set_camera(*scene, &camera), GNO_OK);
    assert_int_equal(gno_scene_set_image(*scene, &image), GNO_OK);
    light.type = GNO_LIGHT_DIRECTIONAL;
    light.direction[0] = 0.4;
    light.direction[1] = 0.6;
    light.direction[2] = -1;
    assert_int_equal(gno_scene_add_light(*scene, "the sun & \"moon\"", &light, NULL), GNO_OK);
    assert_int_equal(gno_scene_add_material(*scene, &material, &mesh.material), GNO_OK);
    assert_int_equal(gno_scene_set_material_name(*scene, 1, "<b>\x01\xff \xc3\xa9"), GNO_OK);
    mesh.name = "floor";
    mesh.vertex_count = mesh.corner_count = 4;
    mesh.positions = floor;
    mesh.polygon_count = mesh.ring_count = 1;
    mesh.ring_start = one;
    mesh.corner_vertex = corners;
    assert_int_equal(gno_scene_add_mesh(*scene, &mesh, NULL), GNO_OK);
    mesh.name = "wall";
    mesh.vertex_count = mesh.corner_count = 8;
    mesh.positions = wall;
    mesh.polygon_start = start;
    mesh.ring_count = 2;
    mesh.ring_start = two;
    assert_int_equal(gno_scene_add_mesh(*scene, &mesh, NULL), GNO_OK);
    mesh.name = "roof";
    mesh.vertex_count = mesh.corner_count = 4;
    mesh.positions = roof;
    mesh.polygon_start = NULL;
    mesh.ring_count = 1;
    mesh.ring_start = one;
    assert_int_equal(gno_scene_add_mesh(*scene, &mesh, NULL), GNO_OK);
}

static int set_up(void **state)
{
    bed *b = calloc(1, sizeof *b);
    assert_non_null(b);
    assert_int_equal(gno_context_create(NULL, &b->context), GNO_OK);
    make_scene(b->context, &b->scene);
    snprintf(b->folder, sizeof b->folder, "/tmp/gnomon_vector_XXXXXX");
    assert_non_null(mkdtemp(b->folder));
    snprintf(b->path, sizeof b->path, "%s/a.svg", b->folder);
    *state = b;
    return 0;
}

static int tear_down(void **state)
{
    bed *b = *state;
    unlink(b->path);
    rmdir(b->folder);
    gno_scene_destroy(b->scene);
    gno_context_destroy(b->context);
    free(b);
    return 0;
}

static char *read_all(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    char *text = malloc(1 << 20);
    assert_non_null(file);
    assert_non_null(text);
    *size = fread(text, 1, (1 << 20) - 1, file);
    text[*size] = '\0';
    fclose(file);
    return text;
}

static char *draw(bed *b, const gno_vector_def *def)
{
    size_t size;
    if (gno_vector_write(b->scene, b->path, def) != GNO_OK) fail_msg("%s", gno_context_message(b->context));
    return read_all(b->path, &size);
}

static size_t count_of(const char *text, const char *what)
{
    size_t n = 0;
    for (const char *at = strstr(text, what); at; at = strstr(at + 1, what)) n++;
    return n;
}

/* ---- a small strict reader of XML: elements nest, attributes are quoted and not repeated ------------------------------- */

static const char *read_name(const char *c, char *name)
{
    size_t n = 0;
    while ((*c >= 'a' && *c <= 'z') || (*c >= 'A' && *c <= 'Z') || (n > 0 && ((*c >= '0' && *c <= '9') || *c == '-' || *c == ':'))) {
        assert_true(n < 31);
        name[n++] = *c++;
    }
    name[n] = '\0';
    assert_true(n > 0);
    return c;
}

static void check_text(const char *from, const char *end)
{
    for (const char *c = from; c < end; c++) {
        assert_true(*c != '<');
        assert_true((unsigned char)*c >= 0x20 || *c == '\n');
        if (*c == '&') assert_true(!strncmp(c, "&amp;", 5) || !strncmp(c, "&lt;", 4) || !strncmp(c, "&gt;", 4) || !strncmp(c, "&quot;", 6));
    }
}

static void check_well_formed(const char *text)
{
    char stack[16][32], seen[16][32], name[32];
    int depth = 0, elements = 0;
    const char *c = text;
    assert_true(!strncmp(c, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n", 39));
    for (c += 39; *c;) {
        const char *next = strchr(c, '<');
        check_text(c, next ? next : c + strlen(c));
        if (!next) break;
        c = next + 1;
        if (*c == '/') {
            c = read_name(c + 1, name);
            assert_true(depth > 0);
            assert_string_equal(name, stack[--depth]);
            assert_int_equal(*c++, '>');
            continue;
        }
        int attributes = 0;
        assert_true(depth < 16 && (depth > 0 || elements == 0));
        c = read_name(c, stack[depth]);
        elements++;
        while (*c == ' ') {
            assert_true(attributes < 16);
            c = read_name(c + 1, seen[attributes]);
            for (int i = 0; i < attributes; i++) assert_string_not_equal(seen[i], seen[attributes]);
            attributes++;
            assert_true(c[0] == '=' && c[1] == '"');
            next = strchr(c + 2, '"');
            assert_non_null(next);
            check_text(c + 2, next);
            c = next + 1;
        }
        if (*c == '/') c++;
        else depth++;
        assert_int_equal(*c++, '>');
    }
    assert_int_equal(depth, 0);
}

/* ---- shapes ----------------------------------------------------------------------------------------------------------------- */

/* The even-odd area of a path of rings that do not cross, holes wound against their outer ring. */
static double path_area(const char *d)
{
    double sum = 0, ring = 0, x0 = 0, y0 = 0, x = 0, y = 0;
    while (*d != '"') {
        if (*d == 'Z') {
            ring += x * y0 - x0 * y;
            sum += ring;
            ring = 0;
            d++;
            continue;
        }
        const int first = *d == 'M';
        char *end;
        if (*d == 'M' || *d == 'L' || *d == ' ') d++;
        const double px = strtod(d, &end), py = strtod(end, &end);
        assert_true(end > d);
        d = end;
        if (first) {
            x0 = px;
            y0 = py;
        } else {
            ring += x * py - px * y;
        }
        x = px;
        y = py;
    }
    return -0.5 * sum;
}

static double attribute(const char *element, const char *name)
{
    const char *at = strstr(element, name);
    assert_non_null(at);
    return strtod(at + strlen(name), NULL);
}

/* Area in the picture of the pieces of one polygon under a number of lights, and their area in the scene. */
static double pieces_area(bed *b, size_t polygon, size_t lights, double *area)
{
    gno_pieces *pieces;
    double seen = 0;
    *area = 0;
    assert_int_equal(gno_visible_pieces(b->scene, NULL, &pieces, NULL), GNO_OK);
    for (size_t i = 0; i < gno_pieces_count(pieces); i++) {
        gno_piece p;
        gno_pieces_get(pieces, i, &p);
        if (p.polygon != polygon || p.light_count != lights) continue;
        *area += p.area;
        for (size_t r = 0; r < p.ring_count; r++) {
            const size_t first = p.ring_start[r], n = p.ring_start[r + 1] - first;
            double at[3 * 64];
            assert_true(n <= 64);
            gno_project_points(b->scene, n, p.points + 3 * first, at);
            for (size_t k = 0; k < n; k++) {
                const double *u = at + 3 * k, *v = at + 3 * ((k + 1) % n);
                seen -= 0.5 * (u[0] / u[2] * v[1] / v[2] - v[0] / v[2] * u[1] / u[2]);
            }
        }
    }
    gno_pieces_destroy(pieces);
    return seen;
}

static void test_shapes(void **state)
{
    bed *b = *state;
    char *text = draw(b, NULL);
    const char *at = strstr(text, "<g id=\"pieces\"");
    double covered = 0, whole = 200 * 120;
    int shapes = 0, lit_and_dark[3] = {0, 0, 0};
    check_well_formed(text);
    for (at = strstr(at, "<path "); at && strstr(at, "data-polygon"); at = strstr(at + 1, "<path ")) {
        const char *end = strstr(at, "/>"), *lights = strstr(at, "data-lights=\"");
        if (!lights || lights > end) break;
        const size_t polygon = (size_t)attribute(at, "data-polygon=\""), reached = lights[13] != '"';
        double area, seen = pieces_area(b, polygon, reached, &area);
        assert_true(fabs(attribute(at, "data-area=\"") - area) < 1e-9 * area);
        assert_true(fabs(path_area(strstr(at, " d=\"") + 4) - seen) < 0.01);
        covered += seen;
        lit_and_dark[polygon] |= 1 << reached;
        shapes++;
    }
    assert_int_equal(lit_and_dark[0], 3); /* the floor in and out of the wall's shadow */
    assert_int_equal(count_of(text, "data-polygon"), shapes);
    assert_int_equal(count_of(text, "<use "), shapes);
    const char *background = strstr(text, "id=\"background\"");
    assert_non_null(background);
    assert_true(fabs(fabs(path_area(strstr(background, " d=\"") + 4)) - (whole - covered)) < 0.05);
    assert_non_null(strstr(text, "data-lights=\"the_sun_&amp;_&quot;moon&quot;\""));
    assert_non_null(strstr(text, "data-material=\"&lt;b&gt;\xef\xbf\xbd\xef\xbf\xbd \xc3\xa9\""));
    assert_non_null(strstr(text, "data-object=\"wall\""));
    assert_non_null(strstr(text, "fill=\"#7caae7\"")); /* the background, encoded */
    free(text);
}

static void test_options(void **state)
{
    bed *b = *state;
    gno_vector_def def = gno_vector_def_default();
    char *text;
    def.background = 0;
    def.title = "a < b";
    def.digits = 0;
    text = draw(b, &def);
    check_well_formed(text);
    assert_null(strstr(text, "id=\"background\""));
    assert_non_null(strstr(text, "<clipPath id=\"covered\">"));
    assert_non_null(strstr(text, "<title>a &lt; b</title>"));
    const char *path = strstr(text, " d=\"") + 4;
    assert_true(strcspn(path, ".") > strcspn(path, "\""));
    free(text);
    def.underlay = 0;
    text = draw(b, &def);
    check_well_formed(text);
    assert_null(strstr(text, "<use "));
    assert_null(strstr(text, "clipPath"));
    free(text);
}

/* The wall and the roof meet in one edge, which both show; every other edge in sight belongs to one polygon alone. */
static void test_edges(void **state)
{
    bed *b = *state;
    gno_vector_def def = gno_vector_def_default();
    char *text;
    def.edges = GNO_EDGES_SILHOUETTE;
    text = draw(b, &def);
    check_well_formed(text);
    assert_true(count_of(text, "class=\"silhouette\"") >= 3);
    assert_int_equal(count_of(text, "class=\"edge\""), 0);
    free(text);
    def.edges = GNO_EDGES_VISIBLE;
    text = draw(b, &def);
    const size_t silhouettes = count_of(text, "class=\"silhouette\"");
    assert_int_equal(count_of(text, "class=\"edge\""), 1);
    assert_int_equal(count_of(text, "class=\"outline\""), 0);
    free(text);
    def.crease = 120;
    text = draw(b, &def);
    assert_int_equal(count_of(text, "class=\"edge\""), 0);
    free(text);
    def.crease = 1;
    def.edges = GNO_EDGES_ALL;
    text = draw(b, &def);
    check_well_formed(text);
    assert_int_equal(count_of(text, "class=\"silhouette\""), silhouettes);
    assert_true(count_of(text, "class=\"outline\"") > 0);
    free(text);
}

static void test_same_bytes(void **state)
{
    bed *b = *state;
    gno_vector_def def = gno_vector_def_default();
    for (int format = GNO_VECTOR_SVG; format <= GNO_VECTOR_PDF; format++) {
        size_t size[2];
        char *text[2];
        def.format = (gno_vector_format)format;
        def.edges = GNO_EDGES_ALL;
        for (int i = 0; i < 2; i++) {
            def.threads = 1 + 2 * i;
            assert_int_equal(gno_vector_write(b->scene, b->path, &def), GNO_OK);
            text[i] = read_all(b->path, &size[i]);
        }
        assert_int_equal(size[0], size[1]);
        assert_memory_equal(text[0], text[1], size[0]);
        if (format == GNO_VECTOR_PDF) assert_memory_equal(text[0], "%PDF-", 5);
        free(text[0]);
        free(text[1]);
    }
}

static void test_nothing_to_see(void **state)
{
    bed *b = *state;
    gno_scene *empty;
    size_t size;
    assert_int_equal(gno_scene_create(b->context, &empty), GNO_OK);
    assert_int_equal(gno_vector_write(empty, b->path, NULL), GNO_OK);
    char *text = read_all(b->path, &size);
    check_well_formed(text);
    assert_int_equal(count_of(text, "data-polygon"), 0);
    assert_non_null(strstr(text, "d=\"M0 0L1280 0 1280 720 0 720Z\""));
    free(text);
    gno_scene_destroy(empty);
}

static void test_wrong_arguments(void **state)
{
    bed *b = *state;
    gno_vector_def def = gno_vector_def_default();
    assert_int_equal(gno_vector_write(NULL, b->path, NULL), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_vector_write(b->scene, NULL, NULL), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_vector_write(b->scene, "-", NULL), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_vector_write(b->scene, "/tmp/a.png", NULL), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_vector_write(b->scene, "/nowhere/at/all.svg", NULL), GNO_ERROR_FILE);
    def.digits = 10;
    assert_int_equal(gno_vector_write(b->scene, b->path, &def), GNO_ERROR_ARGUMENT);
    def = gno_vector_def_default();
    def.edge_width = NAN;
    assert_int_equal(gno_vector_write(b->scene, b->path, &def), GNO_ERROR_ARGUMENT);
    def = gno_vector_def_default();
    def.exposure = -1;
    assert_int_equal(gno_vector_write(b->scene, b->path, &def), GNO_ERROR_ARGUMENT);
    def = gno_vector_def_default();
    def.crease = 181;
    assert_int_equal(gno_vector_write(b->scene, b->path, &def), GNO_ERROR_ARGUMENT);
    def = gno_vector_def_default();
    def.edges = (gno_vector_edges)4;
    assert_int_equal(gno_vector_write(b->scene, b->path, &def), GNO_ERROR_ARGUMENT);
    assert_int_not_equal(access(b->path, F_OK), 0);
}

/* Painting too, for it takes its pieces from the same place. */
static void test_every_allocation_fails(void **state)
{
    static float rgb[3 * 200 * 120];
    bed *b = *state;
    for (int painting = 0; painting < 2; painting++)
        for (size_t at = 1, more = 1; more; at++) {
            fail_alloc alloc = {0};
            gno_context_def context_def = fail_alloc_def(&alloc);
            gno_vector_def def = gno_vector_def_default();
            gno_render_def how = gno_render_def_default();
            gno_context *context;
            gno_scene *scene;
            assert_int_equal(gno_context_create(&context_def, &context), GNO_OK);
            make_scene(context, &scene);
            def.threads = how.threads = 1;
            def.edges = GNO_EDGES_ALL;
            how.engine = GNO_ENGINE_WEILER_ATHERTON;
            alloc.fail_at = alloc.calls + at;
            const gno_status status = painting ? gno_render(scene, &how, rgb, NULL) : gno_vector_write(scene, b->path, &def);
            more = alloc.calls >= alloc.fail_at;
            alloc.fail_at = 0;
            if (more) {
                assert_int_equal(status, GNO_ERROR_MEMORY);
                assert_true(strstr(gno_context_message(context), "memory") != NULL);
                assert_true(painting || access(b->path, F_OK) != 0);
            } else {
                assert_int_equal(status, GNO_OK);
            }
            gno_scene_destroy(scene);
            gno_context_destroy(context);
            assert_int_equal(alloc.held, 0);
            assert_int_equal(alloc.wrong_size, 0);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_shapes, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_options, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_edges, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_same_bytes, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_nothing_to_see, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_wrong_arguments, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_every_allocation_fails, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
