/* test_oracle.c -- pictures of random scenes, judged pixel by pixel against the slow twin.
 *
 * The engine draws 16 sample lines a pixel row with exact ends; the oracle sends 8 x 8 rays a pixel, one at random in each
 * cell. What may differ, and by how much:
 * - the engine may take the light once for a surface in a pixel, in the middle of what is seen of it, where the oracle averages:
 *   it has to lie between the oracle's average and the oracle's colours in the middles. With one intensity a polygon
 *   these are one number. The middle may be that of what is in one state of shadow or of all that is seen, which need not be seen
 *   itself: half of the polygon left and half right of something else. That is asked for only where the first is not enough.
 * - a pixel with all rays, its neighbours' too, on one polygon in one state of shadow has no edge: nothing else may differ.
 * - a pixel with edges has the oracle's noise (a stratified share errs by some 0.025 of the contrast, one in a thousand
 *   by 0.1) and the engine's: an edge along the row is placed to half a line, 1/32 of the contrast, and several add up.
 * - whatever goes beyond is looked at again with 40 x 40 rays, which may show edges that the first look missed, and has to
 *   be right then within a narrower bound; where still no edge is seen, 300 x 300 rays look for slivers.
 * - over the picture the differences are what noise of that size makes of the contrasts in its pixels.
 *
 * GNOMON_ORACLE_SEED=n: begin at that seed; GNOMON_ORACLE_COUNT=n: so many seeds a kind; GNOMON_ORACLE_TEST=test_soft: that test
 * alone, or those that a pattern with * names; GNOMON_ORACLE_DUMP=dir: write both pictures of a failing scene there as PFM.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>
#include <gnomon/gnomon.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/compare.h"
#include "support/oracle.h"
#include "support/random_scene.h"

#define WIDTH 64
#define HEIGHT 48
#define PIXELS (WIDTH * HEIGHT)
#define RAYS 8
#define RAYS_AGAIN 40
#define RAYS_SLIVER 300
#define SHOWN 6 /* failing pixels printed for one scene */

#define INTERIOR_CONSTANT 1e-5
#define INTERIOR 1e-3
#define INTERIOR_RANGE 0.02
#define EDGE 2e-3
#define EDGE_CONTRAST 0.2
#define EDGE_CONTRAST_AGAIN 0.1
#define RMS 1e-3
#define RMS_CONTRAST 0.025
#define FAR_OUTSIDE 0.05 /* from here on a pixel's light is looked into */

static unsigned setting(const char *name, unsigned fallback)
{
    const char *text = getenv(name);
    return text && *text ? (unsigned)strtoul(text, NULL, 10) : fallback;
}

/* ---- judging ------------------------------------------------------------------------------------------------------ */

typedef struct judge {
    const oracle *o;
    oracle_pixel *seen;
    float *engine;
    int constant; /* one intensity a polygon */
    int failed;
    const char *name;
    unsigned seed;
} judge;

/* The 3 x 3 pixels around: do they show one polygon in one state, and between what values do they lie? */
static int surroundings(const judge *j, int x, int y, double contrast[3])
{
    const oracle_pixel *own = &j->seen[y * WIDTH + x];
    double low[3], high[3];
    int alike = 1;
    memcpy(low, own->lower, sizeof low);
    memcpy(high, own->upper, sizeof high);
    for (int v = y > 0 ? y - 1 : 0; v <= y + 1 && v < HEIGHT; v++)
        for (int u = x > 0 ? x - 1 : 0; u <= x + 1 && u < WIDTH; u++) {
            const oracle_pixel *p = &j->seen[v * WIDTH + u];
            if (!p->uniform || p->polygon != own->polygon || p->state != own->state) alike = 0;
            for (int k = 0; k < 3; k++) {
                low[k] = fmin(low[k], p->lower[k]);
                high[k] = fmax(high[k], p->upper[k]);
            }
        }
    for (int k = 0; k < 3; k++) contrast[k] = high[k] - low[k];
    return alike;
}

static void widen(double contrast[3], const oracle_pixel *p)
{
    for (int k = 0; k < 3; k++) contrast[k] = fmax(contrast[k], p->upper[k] - p->lower[k]);
}

/* What lies between the two colours that the rays give for a pixel, their average and the one by middles. */
static void between(const oracle_pixel *p, double least[3], double most[3])
{
    for (int k = 0; k < 3; k++) {
        least[k] = fmin(p->centred[k], p->rgb[k]);
        most[k] = fmax(p->centred[k], p->rgb[k]);
    }
}

/* The same with the third colour, each surface lit once in the middle of all that is seen of it. */
static void between_all(const judge *j, int x, int y, const oracle_pixel *p, int rays, unsigned seed, double least[3], double most[3])
{
    double once[3];
    oracle_light_once(j->o, x, y, rays, seed, once);
    between(p, least, most);
    for (int k = 0; k < 3; k++) {
        least[k] = fmin(least[k], once[k]);
        most[k] = fmax(most[k], once[k]);
    }
}

/* Does the engine's pixel lie between the rays' colours, within the slack of a pixel with or without edges? NaN does not. */
static int lies_between(const judge *j, int x, int y, const oracle_pixel *p, int interior, const double contrast[3], double share,
                        const double least[3], const double most[3])
{
    for (int k = 0; k < 3; k++) {
        double e = (double)j->engine[3 * (y * WIDTH + x) + k];
        double slack = EDGE + share * contrast[k];
        if (interior) slack = j->constant ? INTERIOR_CONSTANT : INTERIOR + INTERIOR_RANGE * (p->upper[k] - p->lower[k]);
        if (!(e >= least[k] - slack && e <= most[k] + slack)) return 0;
    }
    return 1;
}

static int agrees(const judge *j, int x, int y, const oracle_pixel *p, int interior, const double contrast[3], double share)
{
    double least[3], most[3];
    between(p, least, most);
    return lies_between(j, x, y, p, interior, contrast, share, least, most);
}

static void judge_pixel(judge *j, int x, int y)
{
    const oracle_pixel *p = &j->seen[y * WIDTH + x];
    double contrast[3];
    int interior = surroundings(j, x, y, contrast);
    if (agrees(j, x, y, p, interior, contrast, EDGE_CONTRAST)) return;
    oracle_pixel again = oracle_look_pixel(j->o, x, y, RAYS_AGAIN, 77);
    if (interior && again.uniform) {
        if (agrees(j, x, y, &again, 1, contrast, 0)) return;
        again = oracle_look_pixel(j->o, x, y, RAYS_SLIVER, 78);
    }
    interior = interior && again.uniform;
    widen(contrast, &again);
    if (agrees(j, x, y, &again, interior, contrast, EDGE_CONTRAST_AGAIN)) return;
    double least[3], most[3];
    between_all(j, x, y, &again, RAYS_AGAIN, 77, least, most);
    if (lies_between(j, x, y, &again, interior, contrast, EDGE_CONTRAST_AGAIN, least, most)) return;
    const float *e = j->engine + 3 * (y * WIDTH + x);
    if (j->failed++ < SHOWN)
        print_message("%s seed %u pixel (%d,%d), %s, polygon %ld: engine %.5f %.5f %.5f, oracle %.5f %.5f %.5f (contrast %.3f)\n", j->name,
                      j->seed, x, y, interior ? "no edge" : "edge", again.polygon, (double)e[0], (double)e[1], (double)e[2], again.rgb[0],
                      again.rgb[1], again.rgb[2], fmax(contrast[0], fmax(contrast[1], contrast[2])));
}

/* How far the engine's value lies outside; NaN is passed on. */
static double outside(double e, double least, double most) { return e < least ? least - e : e > most ? e - most : e - e; }

/* The RMS of what the engine lies outside of the oracle's colours, and the bound that the contrasts within the pixels give for it. */
static double whole_picture(const judge *j, double *bound)
{
    double contrasts = 0, sum = 0;
    for (int i = 0; i < PIXELS; i++) {
        const oracle_pixel *p = &j->seen[i];
        const float *e = j->engine + 3 * i;
        double least[3], most[3], farthest = 0;
        between(p, least, most);
        for (int k = 0; k < 3; k++) farthest = fmax(farthest, outside((double)e[k], least[k], most[k]));
        if (farthest > FAR_OUTSIDE) between_all(j, i % WIDTH, i / WIDTH, p, RAYS, 1, least, most);
        for (int k = 0; k < 3; k++) {
            double off = outside((double)e[k], least[k], most[k]), contrast = p->upper[k] - p->lower[k];
            sum += off * off;
            contrasts += contrast * contrast;
        }
    }
    *bound = RMS + RMS_CONTRAST * sqrt(contrasts / (3 * PIXELS));
    return sqrt(sum / (3 * PIXELS));
}

static void dump(const judge *j)
{
    const char *dir = getenv("GNOMON_ORACLE_DUMP");
    char path[512];
    static float mean[3 * PIXELS];
    if (!dir || !*dir) return;
    for (size_t i = 0; i < PIXELS; i++)
        for (size_t k = 0; k < 3; k++) mean[3 * i + k] = (float)j->seen[i].rgb[k];
    snprintf(path, sizeof path, "%s/%s-%u-engine.pfm", dir, j->name, j->seed);
    picture_write_pfm(path, WIDTH, HEIGHT, j->engine);
    snprintf(path, sizeof path, "%s/%s-%u-oracle.pfm", dir, j->name, j->seed);
    picture_write_pfm(path, WIDTH, HEIGHT, mean);
}

/* Draws with the engine, looks with the oracle; returns the number of things wrong. */
static int judge_scene(gno_scene *scene, const char *name, unsigned seed, const gno_render_def *def, int every_pixel)
{
    judge j = {NULL, NULL, NULL, 0, 0, name, seed};
    gno_material first;
    oracle *o = oracle_create(scene);
    j.seen = malloc(PIXELS * sizeof *j.seen);
    j.engine = malloc(PIXELS * 3 * sizeof *j.engine);
    assert_true(o && j.seen && j.engine);
    assert_int_equal(gno_scene_material(scene, 1, &first), GNO_OK);
    j.o = o;
    j.constant = first.shading == GNO_SHADING_CONSTANT && strcmp(name, "blob") != 0 && strcmp(name, "glass") != 0 && strncmp(name, "panes", 5) != 0 && strncmp(name, "soft", 4) != 0 && strncmp(name, "marked", 6) != 0;
    for (size_t i = 0; i < PIXELS * 3; i++) j.engine[i] = NAN; /* every pixel has to be written */
    assert_int_equal(gno_render(scene, def, j.engine, NULL), GNO_OK);
    oracle_picture(o, RAYS, 1, j.seen);
    for (int y = 0; y < HEIGHT && every_pixel; y++)
        for (int x = 0; x < WIDTH; x++) judge_pixel(&j, x, y);
    double bound, rms = whole_picture(&j, &bound);
    if (j.failed || !(rms <= bound)) {
        print_message("%s seed %u: %d pixels wrong, RMS %.5f, expected below %.5f\n", name, seed, j.failed, rms, bound);
        j.failed++;
        dump(&j);
    }
    oracle_destroy(o);
    free(j.seen);
    free(j.engine);
    return j.failed;
}

static gno_render_def sixteen_lines(void)
{
    gno_render_def d = gno_render_def_default();
    d.lines = d.base_lines = 16;
    d.threads = 1;
    return d;
}

/* Where a scene is put: how large, how far from the origin, its coordinates rounded as in a file. */
typedef struct place {
    const char *name;
    double scale, offset[3], grid;
} place;

static const place here = {"", 1, {0, 0, 0}, 0};

static int judge_seed(scene_kind kind, unsigned seed, const place *where, const gno_render_def *d, int every_pixel)
{
    char name[64];
    gno_context *context = NULL;
    assert_int_equal(gno_context_create(NULL, &context), GNO_OK);
    gno_scene *scene = random_scene(context, kind, seed, WIDTH, HEIGHT);
    assert_non_null(scene);
    if (where != &here) {
        gno_scene *moved = move_scene(scene, where->scale, where->offset, where->grid);
        gno_scene_destroy(scene);
        scene = moved;
        assert_non_null(scene);
    }
    snprintf(name, sizeof name, "%s%s", scene_kind_name(kind), where->name);
    int failed = judge_scene(scene, name, seed, d, every_pixel);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
    return failed;
}

static void judge_kind_at(scene_kind kind, unsigned seeds, const place *where)
{
    gno_render_def d = sixteen_lines();
    unsigned first = setting("GNOMON_ORACLE_SEED", 1), count = setting("GNOMON_ORACLE_COUNT", seeds);
    int failed = 0;
    for (unsigned seed = first; seed < first + count; seed++) failed += judge_seed(kind, seed, where, &d, 1);
    assert_int_equal(failed, 0);
}

static void judge_kind(scene_kind kind, unsigned seeds) { judge_kind_at(kind, seeds, &here); }

static void test_soup(void **state) { (void)state; judge_kind(SCENE_SOUP, 6); }
static void test_boxes(void **state) { (void)state; judge_kind(SCENE_BOXES, 6); }
static void test_holes(void **state) { (void)state; judge_kind(SCENE_HOLES, 8); }
static void test_stars(void **state) { (void)state; judge_kind(SCENE_STARS, 6); }
static void test_details(void **state) { (void)state; judge_kind(SCENE_DETAILS, 8); }
static void test_room(void **state) { (void)state; judge_kind(SCENE_ROOM, 6); }
static void test_glass(void **state) { (void)state; judge_kind(SCENE_GLASS, 8); }
static void test_panes(void **state) { (void)state; judge_kind(SCENE_PANES, 8); }
static void test_soft(void **state) { (void)state; judge_kind(SCENE_SOFT, 8); }
static void test_marked(void **state) { (void)state; judge_kind(SCENE_MARKED, 8); }
static void test_around(void **state) { (void)state; judge_kind(SCENE_AROUND, 6); }
static void test_blob(void **state) { (void)state; judge_kind(SCENE_BLOB, 3); }
static void test_lattice(void **state) { (void)state; judge_kind(SCENE_LATTICE, 8); }
static void test_solids(void **state) { (void)state; judge_kind(SCENE_SOLIDS, 8); }
static void test_torch(void **state) { (void)state; judge_kind(SCENE_TORCH, 4); }

static const place rounded = {"-rounded", 1, {0, 0, 0}, 1e-6};

/* Highlights narrower than a pixel: half of the surface in another state of shadow; its middle hidden by a detail. */
static void test_narrow_highlights(void **state)
{
    (void)state;
    gno_render_def d = sixteen_lines();
    assert_int_equal(judge_seed(SCENE_SOFT, 34, &here, &d, 1), 0);
    assert_int_equal(judge_seed(SCENE_MARKED, 21, &rounded, &d, 1), 0);
}

/* Patches on a wall stay on it when a file's six decimals round every corner off the common plane. */
static void test_rounded_details(void **state)
{
    (void)state;
    judge_kind_at(SCENE_DETAILS, 4, &rounded);
    judge_kind_at(SCENE_MARKED, 2, &rounded);
}

/* Nothing depends on the unit or the place, up to the tolerances, which follow the largest coordinate. */
static void test_places(void **state)
{
    (void)state;
    static const place places[] = {{"-far", 1, {1000, -700, 300}, 0}, {"-small", 1e-4, {0, 0, 0}, 0}, {"-large", 1e5, {2e5, 1e5, -1e5}, 0}};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        judge_kind_at(SCENE_BOXES, 1, &places[i]);
        judge_kind_at(SCENE_SOUP, 1, &places[i]);
        judge_kind_at(SCENE_GLASS, 1, &places[i]);
    }
}

/* The default settings refine only where they see contrast: no bound for a pixel, but one for the picture. */
static void test_default_settings(void **state)
{
    (void)state;
    gno_render_def d = gno_render_def_default();
    int failed = 0;
    for (int kind = 0; kind < SCENE_BLOB; kind++) failed += judge_seed((scene_kind)kind, 1000, &here, &d, 0);
    failed += judge_seed(SCENE_PANES, 1000, &here, &d, 0) + judge_seed(SCENE_SOFT, 1000, &here, &d, 0);
    assert_int_equal(failed, 0);
}

/* ---- nothing leaks -------------------------------------------------------------------------------------------------- */

typedef struct sealed {
    gno_context *context;
    gno_scene *scene;
    gno_image_def image;
    int dull, ground; /* materials */
} sealed;

/* A scene with ambient light 0.5 on everything, a background that would show, and a white material 1, a green one 2. */
static sealed sealed_scene(int width, int height, const double eye[3], const double target[3], double fov)
{
    sealed s;
    const double ambient[3] = {0.5, 0.5, 0.5};
    gno_material m = gno_material_default();
    gno_camera c = gno_camera_default();
    assert_int_equal(gno_context_create(NULL, &s.context), GNO_OK);
    assert_int_equal(gno_scene_create(s.context, &s.scene), GNO_OK);
    s.image = gno_image_def_default();
    s.image.width = width;
    s.image.height = height;
    s.image.background[0] = s.image.background[2] = 1000;
    assert_int_equal(gno_scene_set_image(s.scene, &s.image), GNO_OK);
    assert_int_equal(gno_scene_set_ambient(s.scene, ambient), GNO_OK);
    for (int k = 0; k < 3; k++) {
        m.ambient[k] = m.diffuse[k] = 1;
        c.eye[k] = eye[k];
        c.target[k] = target[k];
    }
    c.fov = fov;
    assert_int_equal(gno_scene_set_camera(s.scene, &c), GNO_OK);
    assert_int_equal(gno_scene_add_material(s.scene, &m, &s.dull), GNO_OK);
    m.ambient[0] = m.ambient[2] = 0;
    assert_int_equal(gno_scene_add_material(s.scene, &m, &s.ground), GNO_OK);
    return s;
}

static void add_lamp(sealed *s, gno_light_type type, double x, double y, double z)
{
    gno_light l = gno_light_default();
    l.type = type;
    double *at = type == GNO_LIGHT_DIRECTIONAL ? l.direction : l.position;
    at[0] = x;
    at[1] = y;
    at[2] = z;
    l.intensity[0] = l.intensity[1] = l.intensity[2] = 100;
    assert_int_equal(gno_scene_add_light(s->scene, NULL, &l, NULL), GNO_OK);
}

/* Every pixel must be exactly the ambient light of the given channels: no background shines through, no light gets in. */
static void expect_sealed(sealed *s, double red, double green, double blue)
{
    size_t pixels = (size_t)s->image.width * (size_t)s->image.height, wrong = 0;
    float *rgb = malloc(pixels * 3 * sizeof *rgb);
    const double want[3] = {red, green, blue};
    gno_render_def d = gno_render_def_default();
    assert_non_null(rgb);
    assert_int_equal(gno_render(s->scene, &d, rgb, NULL), GNO_OK);
    for (size_t i = 0; i < pixels; i++) {
        int bad = 0;
        for (size_t k = 0; k < 3; k++)
            if (!(fabs((double)rgb[3 * i + k] - want[k]) < 1e-5)) bad = 1;
        if (bad && wrong++ < SHOWN)
            print_message("pixel (%d,%d): %g %g %g\n", (int)(i % (size_t)s->image.width), (int)(i / (size_t)s->image.width),
                          (double)rgb[3 * i], (double)rgb[3 * i + 1], (double)rgb[3 * i + 2]);
    }
    free(rgb);
    gno_scene_destroy(s->scene);
    gno_context_destroy(s->context);
    assert_int_equal(wrong, 0);
}

/* Inside a box at odd places: every edge and corner is in some picture, and strong lamps stand outside. */
static void test_box_is_closed(void **state)
{
    (void)state;
    const double a[3] = {-1.1, -0.9, -0.7}, b[3] = {1.3, 1.07, 0.83};
    uint64_t random = 5;
    for (int i = 0; i < 12; i++) {
        double eye[3], target[3];
        for (int k = 0; k < 3; k++) {
            eye[k] = (random_unit(&random) - 0.5) * 1.2;
            target[k] = eye[k] + random_unit(&random) - 0.5;
        }
        sealed s = sealed_scene(160, 120, eye, target, 100);
        assert_true(add_box(s.scene, a, b, i % 2, s.dull));
        add_lamp(&s, GNO_LIGHT_POINT, 3, 2.5, 2);
        add_lamp(&s, GNO_LIGHT_DIRECTIONAL, 0.7, 0.7, -0.7);
        expect_sealed(&s, 0.5, 0.5, 0.5);
    }
}

/* Inside a closed mesh of 5,120 triangles. */
static void test_mesh_is_closed(void **state)
{
    (void)state;
    const double centre[3] = {0.3, -0.2, 0.1};
    for (int i = 0; i < 4; i++) {
        const double target[3] = {cos(i * 1.7), sin(i * 1.7), 0.6 * i - 0.9};
        sealed s = sealed_scene(200, 150, centre, target, 110);
        assert_true(add_blob(s.scene, 4, 1.5, 0.3, centre, s.dull, GNO_SHADING_FLAT));
        add_lamp(&s, GNO_LIGHT_POINT, 4, 3, 3);
        add_lamp(&s, GNO_LIGHT_DIRECTIONAL, -1, 0.3, -0.8);
        expect_sealed(&s, 0.5, 0.5, 0.5);
    }
}

/* A lamp in a closed mesh lights nothing outside it, through no edge and no vertex. */
static void test_mesh_holds_light(void **state)
{
    (void)state;
    const double centre[3] = {0, 0, 3}, eye[3] = {0, -0.5, 1.3}, target[3] = {0.1, 0.1, 0};
    const double floor[4][3] = {{-40, -40, 0}, {40, -40, 0}, {40, 40, 0}, {-40, 40, 0}};
    sealed s = sealed_scene(320, 240, eye, target, 70);
    assert_true(add_polygon(s.scene, floor, 4, s.ground, 0));
    assert_true(add_blob(s.scene, 4, 1.2, 0.25, centre, s.dull, GNO_SHADING_FLAT));
    add_lamp(&s, GNO_LIGHT_POINT, 0.1, 0.05, 3.07);
    expect_sealed(&s, 0, 0.5, 0);
}

/* A room whose walls are drawn from within only, like a doll's house: the eye looks in from outside, the sun does not. */
static void test_dolls_house_is_dark(void **state)
{
    (void)state;
    const double a[3] = {-1, -1, 0}, b[3] = {1, 1, 1.2}, eye[3] = {2.5, -3, 2.5}, target[3] = {0, 0, 0.4}, centre[3] = {0.2, 0.1, 0.5};
    sealed s = sealed_scene(160, 120, eye, target, 40);
    gno_material m;
    int inner = 0;
    s.image.background[0] = s.image.background[1] = s.image.background[2] = 0.5;
    assert_int_equal(gno_scene_set_image(s.scene, &s.image), GNO_OK);
    assert_int_equal(gno_scene_material(s.scene, s.dull, &m), GNO_OK);
    m.two_sided = 0;
    assert_int_equal(gno_scene_add_material(s.scene, &m, &inner), GNO_OK);
    assert_true(add_box(s.scene, a, b, 1, inner));
    assert_true(add_blob(s.scene, 1, 0.3, 0, centre, s.dull, GNO_SHADING_FLAT));
    add_lamp(&s, GNO_LIGHT_DIRECTIONAL, -0.5, 0.6, -0.8);
    add_lamp(&s, GNO_LIGHT_POINT, 3, -2, 4);
    expect_sealed(&s, 0.5, 0.5, 0.5);
}

/* Two boxes wall on wall under the sun, seen from within: no light along the shared wall. */
static void test_party_wall_is_tight(void **state)
{
    (void)state;
    const double a[3] = {-1, -1, 0}, b[3] = {0, 1, 1}, c[3] = {0, -1, 0}, d[3] = {1, 1, 0.8};
    const double eye[3] = {-0.8, 0.1, 0.4}, target[3] = {0, 0, 0.3};
    sealed s = sealed_scene(320, 240, eye, target, 100);
    assert_true(add_box(s.scene, a, b, 0, s.dull) && add_box(s.scene, c, d, 0, s.dull));
    add_lamp(&s, GNO_LIGHT_DIRECTIONAL, -1, 0.2, -0.9);
    add_lamp(&s, GNO_LIGHT_DIRECTIONAL, 0, 0, -1);
    expect_sealed(&s, 0.5, 0.5, 0.5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_soup),
        cmocka_unit_test(test_boxes),
        cmocka_unit_test(test_holes),
        cmocka_unit_test(test_stars),
        cmocka_unit_test(test_details),
        cmocka_unit_test(test_room),
        cmocka_unit_test(test_glass),
        cmocka_unit_test(test_panes),
        cmocka_unit_test(test_soft),
        cmocka_unit_test(test_marked),
        cmocka_unit_test(test_around),
        cmocka_unit_test(test_blob),
        cmocka_unit_test(test_lattice),
        cmocka_unit_test(test_solids),
        cmocka_unit_test(test_torch),
        cmocka_unit_test(test_rounded_details),
        cmocka_unit_test(test_narrow_highlights),
        cmocka_unit_test(test_places),
        cmocka_unit_test(test_default_settings),
        cmocka_unit_test(test_box_is_closed),
        cmocka_unit_test(test_mesh_is_closed),
        cmocka_unit_test(test_mesh_holds_light),
        cmocka_unit_test(test_dolls_house_is_dark),
        cmocka_unit_test(test_party_wall_is_tight),
    };
    const char *chosen = getenv("GNOMON_ORACLE_TEST");
    if (chosen && *chosen) cmocka_set_test_filter(chosen);
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
