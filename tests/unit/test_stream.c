/* test_stream.c -- pictures handed out row by row and span by span: the same as the whole picture and its layers, in order, for
 * any number of threads; stopping, and every allocation failing once.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "fail_alloc.h"
#include "support/random_scene.h"
#include <math.h>
#include <string.h>

#define WIDTH 61
#define HEIGHT 75
#define PIXELS (WIDTH * HEIGHT)
#define LIGHTS 16
#define RANKS 8

static gno_context *new_context(void)
{
    gno_context *context = NULL;
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    return context;
}

/* ---- rows --------------------------------------------------------------------------------------------------------------- */

typedef struct rows {
    int next, stop_at;
    float rgb[3 * PIXELS];
} rows;

static int take_row(void *user, int y, const float *rgb)
{
    rows *r = user;
    assert_int_equal(y, r->next);
    r->next++;
    memcpy(r->rgb + 3 * (size_t)y * WIDTH, rgb, 3 * WIDTH * sizeof *rgb);
    return r->next == r->stop_at;
}

static void test_rows(void **state)
{
    static float whole[3 * PIXELS];
    static rows r;
    (void)state;
    for (int kind = 0; kind < SCENE_KINDS; kind++) {
        gno_context *context = new_context();
        gno_scene *scene = random_scene(context, (scene_kind)kind, 2, WIDTH, HEIGHT);
        gno_render_def def = gno_render_def_default();
        assert_int_equal(gno_render(scene, NULL, whole, NULL), GNO_OK);
        for (def.threads = 1; def.threads <= 3; def.threads += 2) {
            memset(&r, 0, sizeof r);
            assert_int_equal(gno_render_rows(scene, &def, take_row, &r, NULL), GNO_OK);
            assert_int_equal(r.next, HEIGHT);
            assert_memory_equal(whole, r.rgb, sizeof whole);
        }
        gno_scene_destroy(scene);
        gno_context_destroy(context);
    }
}

static int count_row(void *user, int y, const float *rgb)
{
    *(double *)user += (double)rgb[0];
    return y < 0;
}

/* A tall picture needs no more memory than a few of its rows. */
static void test_rows_memory(void **state)
{
    gno_context *context = new_context();
    gno_scene *scene = random_scene(context, SCENE_BOXES, 2, 1500, 1500);
    size_t before = gno_context_memory(scene ? context : NULL, NULL), peak;
    double sum = 0;
    gno_render_def def = gno_render_def_default();
    (void)state;
    def.threads = 1;
    assert_int_equal(gno_render_rows(scene, &def, count_row, &sum, NULL), GNO_OK);
    gno_context_memory(context, &peak);
    assert_true(peak - before < 1500u * 1500u * 3u * sizeof(float) / 4);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

static int stop_row(void *user, int y, const float *rgb)
{
    (void)rgb;
    return y == *(int *)user;
}

static int stop_spans(void *user, const gno_span_line *line)
{
    return line->row == *(int *)user;
}

static void test_stop(void **state)
{
    gno_context *context = new_context();
    gno_scene *scene = random_scene(context, SCENE_ROOM, 2, WIDTH, HEIGHT);
    int at = 40;
    (void)state;
    assert_int_equal(gno_render_rows(scene, NULL, stop_row, &at, NULL), GNO_ERROR_CANCELLED);
    assert_non_null(strstr(gno_context_message(context), "asked to stop"));
    assert_int_equal(gno_render_spans(scene, NULL, stop_spans, &at, NULL), GNO_ERROR_CANCELLED);
    at = HEIGHT;
    assert_int_equal(gno_render_rows(scene, NULL, stop_row, &at, NULL), GNO_OK);
    assert_int_equal(gno_render_spans(scene, NULL, stop_spans, &at, NULL), GNO_OK);
    assert_int_equal(gno_render_rows(NULL, NULL, stop_row, &at, NULL), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_render_spans(scene, NULL, NULL, &at, NULL), GNO_ERROR_ARGUMENT);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

/* ---- spans -------------------------------------------------------------------------------------------------------------- */

typedef struct sums {
    int base, row, line, exact; /* exact: spans do not overlap */
    uint64_t hash;
    double cover[PIXELS], lit[LIGHTS][PIXELS], of_first[PIXELS]; /* lengths, in pixels; of_first: of the polygon in rank 0 */
    const unsigned *first;
} sums;

static void mix(uint64_t *hash, const void *data, size_t size)
{
    const unsigned char *bytes = data;
    for (size_t i = 0; i < size; i++)
        *hash = (*hash ^ bytes[i]) * 1099511628211u;
}

static void add_length(double *row, double x0, double x1, double weight)
{
    for (int x = (int)x0; x < WIDTH && x < x1; x++)
        row[x] += weight * (fmin(x1, x + 1) - fmax(x0, x));
}

static void check_parts(const gno_span *span, int light)
{
    size_t first = span->part_start[light], end = span->part_start[light + 1];
    assert_true(end > first && span->parts[first].x0 == span->x0 && span->parts[end - 1].x1 == span->x1);
    for (size_t k = first; k < end; k++) {
        assert_true(span->parts[k].x0 < span->parts[k].x1);
        if (k > first) {
            assert_true(span->parts[k].x0 == span->parts[k - 1].x1);
            assert_memory_not_equal(span->parts[k].light, span->parts[k - 1].light, sizeof span->parts[k].light);
        }
    }
}

static int take_spans(void *user, const gno_span_line *line)
{
    sums *s = user;
    double *row = s->cover + (size_t)line->row * WIDTH, before = 0;
    assert_true(line->row == s->row && line->line == s->line && line->light_count <= LIGHTS);
    assert_true(line->y == line->row + (line->line + 0.5) / s->base);
    s->line = (s->line + 1) % s->base;
    s->row += s->line == 0;
    for (size_t i = 0; i < line->span_count; i++) {
        const gno_span *span = &line->spans[i];
        assert_true(span->x0 < span->x1 && span->x0 >= 0 && span->x1 <= WIDTH && span->depth0 > 0 && span->depth1 > 0);
        assert_true(i == 0 || span->x0 >= line->spans[i - 1].x0);
        assert_true(!s->exact || span->x0 >= before);
        before = span->x1;
        add_length(row, span->x0, span->x1, 1);
        for (int x = (int)span->x0; x < WIDTH && x < span->x1 && s->first; x++)
            if (s->first[((size_t)line->row * WIDTH + (size_t)x) * RANKS] == span->polygon)
                s->of_first[(size_t)line->row * WIDTH + (size_t)x] += fmin(span->x1, x + 1) - fmax(span->x0, x);
        mix(&s->hash, &span->polygon, sizeof span->polygon);
        mix(&s->hash, &span->x0, 4 * sizeof span->x0);
        for (int j = 0; j < line->light_count; j++) {
            check_parts(span, j);
            for (size_t k = span->part_start[j]; k < span->part_start[j + 1]; k++) {
                const gno_span_part *part = &span->parts[k];
                mix(&s->hash, part, sizeof *part);
                add_length(s->lit[j] + (size_t)line->row * WIDTH, part->x0, part->x1, (part->light[0] + part->light[1] + part->light[2]) / 3);
            }
        }
    }
    return 0;
}

static void run_spans(gno_scene *scene, int base, int threads, sums *s)
{
    gno_render_def def = gno_render_def_default();
    def.base_lines = base;
    def.lines = 18;
    def.threads = threads;
    assert_int_equal(gno_render_spans(scene, &def, take_spans, s, NULL), GNO_OK);
    assert_true(s->row == HEIGHT && s->line == 0);
}

/* Spans of kinds without see-through surfaces add up to the layers of a picture of as many lines. */
static void test_spans_and_layers(void **state)
{
    static const scene_kind kinds[] = {SCENE_SOUP, SCENE_BOXES, SCENE_HOLES, SCENE_STARS, SCENE_ROOM, SCENE_AROUND, SCENE_LATTICE, SCENE_SOLIDS};
    static float rgb[3 * PIXELS], coverage[PIXELS], shadow[LIGHTS * PIXELS], share[RANKS * PIXELS];
    static unsigned id[RANKS * PIXELS];
    static sums s;
    (void)state;
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
        gno_context *context = new_context();
        gno_scene *scene = random_scene(context, kinds[k], 4, WIDTH, HEIGHT);
        gno_render_def def = gno_render_def_default();
        gno_layers layers = gno_layers_default();
        int base = 3;
        size_t lights = gno_scene_count(scene).lights;
        layers.coverage = coverage;
        layers.shadow = shadow;
        layers.polygons.count = RANKS;
        layers.polygons.id = id;
        layers.polygons.coverage = share;
        def.lines = def.base_lines = base;
        def.layers = &layers;
        assert_int_equal(gno_render(scene, &def, rgb, NULL), GNO_OK);
        memset(&s, 0, sizeof s);
        s.base = base;
        s.exact = 1;
        s.first = id;
        run_spans(scene, base, 2, &s);
        for (size_t i = 0; i < PIXELS; i++) {
            if (fabs(s.cover[i] / base - (double)coverage[i]) > 1e-5)
                fail_msg("%s: pixel %zu: spans cover %g, the layer %g", scene_kind_name(kinds[k]), i, s.cover[i] / base, (double)coverage[i]);
            if (id[i * RANKS] != GNO_BACKGROUND && fabs(s.of_first[i] / base - (double)share[i * RANKS]) > 1e-5)
                fail_msg("%s: pixel %zu: polygon %u by spans %g, by rank %g", scene_kind_name(kinds[k]), i, id[i * RANKS],
                         s.of_first[i] / base, (double)share[i * RANKS]);
            for (size_t j = 0; j < lights; j++) {
                gno_light light;
                assert_int_equal(gno_scene_light(scene, (int)j, &light, NULL), GNO_OK);
                if (light.type == GNO_LIGHT_AREA)
                    break;
                if (s.cover[i] > 0 && fabs(s.lit[j][i] / s.cover[i] - (double)shadow[j * PIXELS + i]) > 2e-4)
                    fail_msg("%s: pixel %zu, light %zu: %g by spans, %g by layer", scene_kind_name(kinds[k]), i, j, s.lit[j][i] / s.cover[i],
                             (double)shadow[j * PIXELS + i]);
            }
        }
        gno_scene_destroy(scene);
        gno_context_destroy(context);
    }
}

static void test_spans_threads(void **state)
{
    static sums s;
    (void)state;
    for (int kind = 0; kind < SCENE_KINDS; kind++) {
        gno_context *context = new_context();
        gno_scene *scene = random_scene(context, (scene_kind)kind, 6, WIDTH, HEIGHT);
        uint64_t hash = 0;
        for (int threads = 1; threads <= 4; threads += 3) {
            memset(&s, 0, sizeof s);
            s.base = 2;
            run_spans(scene, 2, threads, &s);
            assert_true(threads == 1 || s.hash == hash);
            hash = s.hash;
        }
        gno_scene_destroy(scene);
        gno_context_destroy(context);
    }
}

/* ---- one plane: one span a line --------------------------------------------------------------------------------------------- */

static int take_plane(void *user, const gno_span_line *line)
{
    int *lines = user;
    const gno_span *span = line->spans;
    assert_int_equal(line->span_count, 1);
    assert_true(span->x0 == 0 && span->x1 == WIDTH && span->polygon == 0 && span->tint[0] == 1);
    assert_true(fabs(span->depth0 - 5) < 1e-9 && fabs(span->depth1 - 5) < 1e-9);
    assert_int_equal(span->back, 0);
    ++*lines;
    return 0;
}

static void test_plane(void **state)
{
    static const double wide[4][3] = {{-90, -90, 0}, {90, -90, 0}, {90, 90, 0}, {-90, 90, 0}};
    gno_context *context = new_context();
    gno_scene *scene = NULL;
    gno_camera camera = gno_camera_default();
    gno_image_def image = gno_image_def_default();
    int lines = 0;
    (void)state;
    assert_int_equal(gno_scene_create(context, &scene), GNO_OK);
    camera.eye[0] = camera.eye[1] = 0;
    camera.eye[2] = 5;
    camera.target[2] = 0;
    camera.up[1] = 1;
    camera.up[2] = 0;
    image.width = WIDTH;
    image.height = HEIGHT;
    assert_int_equal(gno_scene_set_camera(scene, &camera), GNO_OK);
    assert_int_equal(gno_scene_set_image(scene, &image), GNO_OK);
    assert_true(add_polygon(scene, wide, 4, 0, 0));
    assert_int_equal(gno_render_spans(scene, NULL, take_plane, &lines, NULL), GNO_OK);
    assert_int_equal(lines, 2 * HEIGHT);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

/* A pane before a plane: both spans on every line, the pane first, the plane with the pane's tint. */
static int take_pane(void *user, const gno_span_line *line)
{
    (void)user;
    assert_int_equal(line->span_count, 2);
    assert_true(line->spans[0].depth0 < line->spans[1].depth0 && line->spans[0].tint[0] == 1);
    assert_true(fabs(line->spans[1].tint[0] - 0.5) < 1e-6 && line->spans[1].x1 == WIDTH);
    return 0;
}

static void test_pane(void **state)
{
    static const double far[4][3] = {{-90, 3, -90}, {90, 3, -90}, {90, 3, 90}, {-90, 3, 90}},
                        near[4][3] = {{-90, 2, -90}, {90, 2, -90}, {90, 2, 90}, {-90, 2, 90}};
    gno_context *context = new_context();
    gno_scene *scene = NULL;
    gno_material glass = gno_material_default();
    gno_image_def image = gno_image_def_default();
    int index;
    (void)state;
    image.width = WIDTH;
    image.height = HEIGHT;
    for (int k = 0; k < 3; k++)
        glass.transmission[k] = 0.5;
    assert_int_equal(gno_scene_create(context, &scene), GNO_OK);
    assert_int_equal(gno_scene_set_image(scene, &image), GNO_OK);
    assert_int_equal(gno_scene_add_material(scene, &glass, &index), GNO_OK);
    assert_true(add_polygon(scene, far, 4, 0, 0) && add_polygon(scene, near, 4, index, 0));
    assert_int_equal(gno_render_spans(scene, NULL, take_pane, NULL, NULL), GNO_OK);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
}

/* ---- failures -------------------------------------------------------------------------------------------------------------- */

static int nothing(void *user, const gno_span_line *line)
{
    (void)user;
    return line->span_count > 100000;
}

static void test_every_allocation_fails(void **state)
{
    (void)state;
    for (int mode = 0; mode < 2; mode++)
        for (size_t at = 1, done = 0; !done; at++) {
            fail_alloc alloc = {0};
            gno_context_def context_def = fail_alloc_def(&alloc);
            gno_render_def def = gno_render_def_default();
            gno_context *context;
            gno_scene *scene;
            gno_status status;
            double sum = 0;
            def.threads = 1;
            assert_int_equal(gno_context_create(&context_def, &context), GNO_OK);
            scene = random_scene(context, SCENE_GLASS, 1, WIDTH, HEIGHT);
            assert_non_null(scene);
            alloc.fail_at = alloc.calls + at;
            status = mode ? gno_render_spans(scene, &def, nothing, NULL, NULL) : gno_render_rows(scene, &def, count_row, &sum, NULL);
            done = status == GNO_OK;
            assert_true(done || (status == GNO_ERROR_MEMORY && gno_context_message(context)[0]));
            gno_scene_destroy(scene);
            gno_context_destroy(context);
            assert_int_equal(alloc.held, 0);
            assert_false(alloc.wrong_size);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_rows),  cmocka_unit_test(test_rows_memory),
                                       cmocka_unit_test(test_stop),  cmocka_unit_test(test_spans_and_layers),
                                       cmocka_unit_test(test_plane), cmocka_unit_test(test_spans_threads),
                                       cmocka_unit_test(test_pane),  cmocka_unit_test(test_every_allocation_fails)};
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
