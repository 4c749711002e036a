/* test_faults.c -- the public calls of the engine with allocations made to fail, on scenes of every kind: a status and a message come
 * back, nothing leaks, and the same call on the same scene gives its full result afterwards.
 * Two ways to fail: one allocation alone, so that whoever takes no notice of it goes on to work with nothing; or it and all that come
 * after it. A call may do without memory that it only would have liked to have, but then its result is the whole one.
 * GNOMON_FAULTS=1: every allocation of every call on every kind of scene; =places: each place (support/places.h) where a call allocates, on
 * the first kind of scene that comes there; else a few of each, the same ones every time.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "support/places.h"
#include "support/random_scene.h"

#include <gnomon/gnomon_matrix.h>
#include <gnomon/gnomon_pieces.h>
#include <gnomon/gnomon_problems.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 24, HEIGHT = 18, PIXELS = WIDTH * HEIGHT, LIGHTS = 64, MOST_PLACES = 5000 };

/* ---- memory that fails -------------------------------------------------------------------------------------------------------- */

typedef struct faulty {
    size_t calls, fail_at; /* fail_at 0: never */
    int once;
    size_t held; /* bytes */
    uint64_t *places; /* of calls from first_place on, for MOST_PLACES of them; NULL: not asked for */
    size_t first_place;
} faulty;

static void *faulty_alloc(void *user, void *block, size_t old_size, size_t new_size)
{
    faulty *f = user;
    void *fresh;
    if (new_size == 0) {
        f->held -= block ? old_size : 0;
        free(block);
        return NULL;
    }
    f->calls++;
    if (f->places && f->calls > f->first_place && f->calls <= f->first_place + MOST_PLACES)
        f->places[f->calls - f->first_place - 1] = place_here();
    if (f->fail_at > 0 && (f->once ? f->calls == f->fail_at : f->calls >= f->fail_at)) return NULL;
    fresh = malloc(new_size); /* always a new place, so that stale pointers show */
    if (!fresh) return NULL;
    if (block) memcpy(fresh, block, old_size < new_size ? old_size : new_size);
    free(block);
    f->held += new_size - (block ? old_size : 0);
    return fresh;
}

/* ---- the calls, each with a number that tells its results apart ------------------------------------------------------------------ */

static void add(uint64_t *digest, const void *data, size_t size)
{
    const unsigned char *bytes = data;
    for (size_t i = 0; i < size; i++)
        *digest = (*digest ^ bytes[i]) * 1099511628211u;
}

static gno_status draw_by(gno_scene *scene, gno_engine engine, uint64_t *digest)
{
    static float rgb[3 * PIXELS];
    gno_render_def def = gno_render_def_default();
    gno_status status;
    def.threads = 1;
    def.engine = engine;
    status = gno_render(scene, &def, rgb, NULL);
    add(digest, rgb, sizeof rgb);
    return status;
}

static gno_status draw(gno_scene *scene, uint64_t *digest) { return draw_by(scene, GNO_ENGINE_SCANLINE, digest); }
static gno_status draw_pieces(gno_scene *scene, uint64_t *digest) { return draw_by(scene, GNO_ENGINE_WEILER_ATHERTON, digest); }

static gno_status draw_layers(gno_scene *scene, uint64_t *digest)
{
    static float rgb[3 * PIXELS], depth[PIXELS], normal[3 * PIXELS], coverage[PIXELS], shadow[LIGHTS * PIXELS], share[6 * PIXELS];
    static unsigned id[6 * PIXELS];
    gno_render_def def = gno_render_def_default();
    gno_layers layers = gno_layers_default();
    gno_status status;
    def.threads = 1;
    def.layers = &layers;
    layers.depth = depth;
    layers.normal = normal;
    layers.coverage = coverage;
    layers.shadow = gno_expanded_light_count(scene) <= LIGHTS ? shadow : NULL;
    layers.polygons.count = 6;
    layers.polygons.id = id;
    layers.polygons.coverage = share;
    status = gno_render(scene, &def, rgb, NULL);
    add(digest, rgb, sizeof rgb);
    add(digest, depth, sizeof depth);
    add(digest, id, sizeof id);
    return status;
}

typedef struct row_digest {
    uint64_t *digest;
} row_digest;

static int take_row(void *user, int y, const float *rgb)
{
    row_digest *d = user;
    add(d->digest, &y, sizeof y);
    add(d->digest, rgb, 3 * WIDTH * sizeof *rgb);
    return 0;
}

static gno_status rows_by(gno_scene *scene, gno_engine engine, uint64_t *digest)
{
    gno_render_def def = gno_render_def_default();
    row_digest user = {digest};
    def.threads = 1;
    def.engine = engine;
    return gno_render_rows(scene, &def, take_row, &user, NULL);
}

static gno_status rows(gno_scene *scene, uint64_t *digest) { return rows_by(scene, GNO_ENGINE_SCANLINE, digest); }
static gno_status rows_of_pieces(gno_scene *scene, uint64_t *digest) { return rows_by(scene, GNO_ENGINE_WEILER_ATHERTON, digest); }

static int take_spans(void *user, const gno_span_line *line)
{
    row_digest *d = user;
    add(d->digest, &line->y, sizeof line->y);
    for (size_t i = 0; i < line->span_count; i++) {
        const gno_span *s = &line->spans[i];
        add(d->digest, &s->x0, sizeof s->x0);
        for (size_t k = s->part_start[0]; k < s->part_start[line->light_count]; k++)
            add(d->digest, &s->parts[k].x1, sizeof s->parts[k].x1);
    }
    return 0;
}

static gno_status spans(gno_scene *scene, uint64_t *digest)
{
    gno_render_def def = gno_render_def_default();
    row_digest user = {digest};
    def.threads = 1;
    return gno_render_spans(scene, &def, take_spans, &user, NULL);
}

static void add_pieces(uint64_t *digest, const gno_pieces *pieces)
{
    gno_piece piece;
    for (size_t i = 0; i < gno_pieces_count(pieces); i++) {
        assert_int_equal(gno_pieces_get(pieces, i, &piece), GNO_OK);
        add(digest, &piece.area, sizeof piece.area);
        add(digest, piece.lights, piece.light_count * sizeof *piece.lights);
    }
}

static gno_status lit(gno_scene *scene, uint64_t *digest)
{
    gno_lit_def def = gno_lit_def_default();
    gno_status status = GNO_OK;
    def.threads = 1;
    for (size_t i = 0; i < gno_expanded_light_count(scene) && i < 2 && !status; i++) {
        gno_pieces *pieces = NULL;
        gno_lit_summary sum;
        status = gno_lit_pieces(scene, i, &def, &pieces, NULL, &sum);
        assert_true((status == GNO_OK) == (pieces != NULL));
        add_pieces(digest, pieces);
        gno_pieces_destroy(pieces);
    }
    return status;
}

static gno_status visible_by(gno_scene *scene, int split, int see_through, int colours, uint64_t *digest)
{
    static double rgb[3 * 20000];
    gno_visible_def def = gno_visible_def_default();
    gno_pieces *pieces = NULL;
    gno_status status;
    def.threads = 1;
    def.split = split;
    def.see_through = see_through;
    status = gno_visible_pieces(scene, &def, &pieces, NULL);
    assert_true((status == GNO_OK) == (pieces != NULL));
    add_pieces(digest, pieces);
    if (!status && colours && gno_pieces_count(pieces) <= 20000) {
        status = gno_pieces_colours(scene, pieces, 1, rgb);
        add(digest, rgb, 3 * gno_pieces_count(pieces) * sizeof *rgb);
    }
    gno_pieces_destroy(pieces);
    return status;
}

static gno_status visible(gno_scene *scene, uint64_t *digest) { return visible_by(scene, 1, 1, 0, digest); }
static gno_status visible_solid(gno_scene *scene, uint64_t *digest) { return visible_by(scene, 0, 0, 0, digest); }
static gno_status colours(gno_scene *scene, uint64_t *digest) { return visible_by(scene, 2, 1, 1, digest); }

static gno_status matrix_by(gno_scene *scene, int on_demand, uint64_t *digest)
{
    gno_matrix_def def = gno_matrix_def_default();
    gno_matrix_cursor cursor;
    gno_matrix *matrix = NULL;
    gno_matrix_info info;
    gno_status status;
    def.threads = 1;
    def.on_demand = on_demand;
    memset(&cursor, 0, sizeof cursor);
    status = gno_matrix_build(scene, 0, &def, &matrix);
    assert_true((status == GNO_OK) == (matrix != NULL));
    while (!status && gno_matrix_next(matrix, &cursor)) {
        add(digest, &cursor.receiver, sizeof cursor.receiver);
        add(digest, &cursor.caster, sizeof cursor.caster);
    }
    if (!status) status = cursor.status;
    if (!status) status = gno_matrix_get_info(matrix, &info);
    gno_matrix_destroy(matrix);
    return status;
}

static gno_status matrix(gno_scene *scene, uint64_t *digest) { return matrix_by(scene, 0, digest); }
static gno_status matrix_on_demand(gno_scene *scene, uint64_t *digest) { return matrix_by(scene, 1, digest); }

static gno_status problems(gno_scene *scene, uint64_t *digest)
{
    size_t counts[GNO_PROBLEM_KINDS];
    gno_status status;
    memset(counts, 0, sizeof counts);
    status = gno_scene_find_problems(scene, 1, NULL, NULL, counts);
    add(digest, counts, sizeof counts);
    return status;
}

typedef struct call {
    const char *name;
    gno_status (*make)(gno_scene *scene, uint64_t *digest);
} call;

static const call calls[] = {
    {"gno_render", draw},
    {"gno_render by pieces", draw_pieces},
    {"gno_render with layers", draw_layers},
    {"gno_render_rows", rows},
    {"gno_render_rows by pieces", rows_of_pieces},
    {"gno_render_spans", spans},
    {"gno_lit_pieces", lit},
    {"gno_visible_pieces", visible},
    {"gno_visible_pieces, solid", visible_solid},
    {"gno_pieces_colours", colours},
    {"gno_matrix_build", matrix},
    {"gno_matrix_build on demand", matrix_on_demand},
    {"gno_scene_find_problems", problems},
};

/* ---- one call on one scene ---------------------------------------------------------------------------------------------------------- */

typedef struct tally {
    size_t faults, refused, done_without;
} tally;

/* Lets allocation `at` of the call fail, or none and notes the places of all; returns how many the call asked for. */
static size_t make_call(const call *c, scene_kind kind, size_t at, int once, uint64_t *good, uint64_t *found, tally *sum)
{
    faulty memory = {0, 0, 0, 0, NULL, 0};
    gno_context_def def = gno_context_def_default();
    gno_context *context;
    gno_scene *scene;
    gno_status status;
    uint64_t digest = 1469598103934665603u;
    size_t before;
    def.alloc = faulty_alloc;
    def.alloc_user = &memory;
    assert_int_equal(gno_context_create(&def, &context), GNO_OK);
    scene = random_scene(context, kind, 1, WIDTH, HEIGHT);
    assert_non_null(scene);
    before = memory.calls;
    memory.first_place = before;
    memory.places = at ? NULL : found;
    memory.fail_at = at ? before + at : 0;
    memory.once = once;
    status = c->make(scene, &digest);
    if (at == 0) {
        assert_int_equal(status, GNO_OK);
        *good = digest;
    } else {
        sum->faults++;
        if (status != GNO_OK && status != GNO_ERROR_MEMORY) fail_msg("%s, %s, allocation %zu: status %d", c->name, scene_kind_name(kind), at, (int)status);
        if (status == GNO_ERROR_MEMORY) {
            sum->refused++;
            assert_true(strlen(gno_context_message(context)) > 0);
            memory.fail_at = 0;
            digest = 1469598103934665603u;
            assert_int_equal(c->make(scene, &digest), GNO_OK);
        } else {
            sum->done_without++;
        }
        if (digest != *good) fail_msg("%s, %s, allocation %zu %s: another result", c->name, scene_kind_name(kind), at, once ? "alone" : "on");
    }
    before = memory.calls - before;
    gno_scene_destroy(scene);
    gno_context_destroy(context);
    assert_int_equal(memory.held, 0);
    return before;
}

static void both_ways(const call *c, scene_kind kind, size_t at, int ways, uint64_t *good, tally *sum)
{
    make_call(c, kind, at, 1, good, NULL, sum);
    if (ways == 2)
        make_call(c, kind, at, 0, good, NULL, sum);
}

/* Each place of the call where it allocates that no scene before has shown. */
static void try_places(const call *c, places *seen, tally *sum)
{
    static uint64_t found[MOST_PLACES];
    memset(seen, 0, sizeof *seen);
    for (int kind = 0; kind < SCENE_KINDS; kind++) {
        uint64_t good = 0;
        const size_t count = make_call(c, (scene_kind)kind, 0, 0, &good, found, sum);
        assert_true(count <= MOST_PLACES);
        for (size_t k = 1; k <= count; k++)
            if (places_visit(seen, found[k - 1]) == 0)
                both_ways(c, (scene_kind)kind, k, 2, &good, sum);
    }
}

static void try_allocations(const call *c, int all, uint64_t *random, tally *sum)
{
    for (int kind = 0; kind < SCENE_KINDS; kind++) {
        uint64_t good = 0;
        const size_t count = make_call(c, (scene_kind)kind, 0, 0, &good, NULL, sum), tried = all ? count : count < 4 ? count : 4;
        for (size_t k = 1; k <= tried; k++)
            both_ways(c, (scene_kind)kind, all ? k : 1 + (size_t)(random_unit(random) * (double)count), all || k % 2 ? 2 : 1, &good, sum);
    }
}

static void test_faults(void **state)
{
    static places seen;
    const char *text = getenv("GNOMON_FAULTS");
    const int by_place = text && !strcmp(text, "places");
    tally sum = {0, 0, 0};
    uint64_t random = 7;
    (void)state;
    for (size_t i = 0; i < sizeof calls / sizeof *calls; i++) {
        if (by_place)
            try_places(&calls[i], &seen, &sum);
        else
            try_allocations(&calls[i], text && *text, &random, &sum);
        if (text && *text)
            print_message("faults: %s: %zu faults so far\n", calls[i].name, sum.faults);
    }
    print_message("faults: %zu allocations made to fail in %zu calls on %d kinds of scenes: %zu refused, %zu done without\n", sum.faults,
                  sizeof calls / sizeof *calls, (int)SCENE_KINDS, sum.refused, sum.done_without);
    assert_true(sum.refused > 0 && sum.faults == sum.refused + sum.done_without);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_faults)};
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
