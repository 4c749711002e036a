/* test_lit.c -- lit pieces against areas worked out by hand; every option, argument and failed allocation of gno_lit_pieces. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include "fail_alloc.h"
#include "pieces_test.h"

#include <string.h>

#define CLOSE 1e-12
#define PI 3.14159265358979323846

/* A wall of 4 x 3 facing -y, under an overhang 0.5 above it that reaches 1 out and beyond both its ends: the shadow's lower edge lies at
 * 3.5 - sz/sy. The wall's foot is far from the origin. */
static void test_overhang(void **state)
{
    gno_lit_row rows[MOST_ROWS];
    stage s = stage_make(NULL);
    const double x = 1000, y = -2000;
    (void)state;
    add_plate(&s, x, y, 0, 4, 0, 0, 0, 0, 3, 0);
    add_plate(&s, x - 20, y, 3.5, 44, 0, 0, 0, -1, 0, 0);
    add_sun(&s, 0.7, -0.6, 1.1);
    light_up(&s, 0, rows);
    assert_near(rows[0].area, 12, CLOSE);
    assert_near(rows[0].lit_area, 4 * (3.5 - 1.1 / 0.6), 1e-11);
    assert_near(rows[0].fraction, (3.5 - 1.1 / 0.6) / 3, 1e-11);
    assert_near(rows[0].centroid[2], 0.5 * (3.5 - 1.1 / 0.6), 1e-11);
    assert_near(rows[0].centroid[0], x + 2, CLOSE);
    assert_int_equal(rows[0].side, 1);
    assert_near(rows[1].fraction, 1, CLOSE);
    assert_int_equal(rows[1].side, -1);
    stage_drop(&s);
}

/* A fin of depth 0.8 on the wall's left end, higher than the wall: the shadow is 0.8 sx/sy wide. Where the fin ends at the wall's
 * height, a triangle above the falling shadow line is lit as well. */
static void test_fin(void **state)
{
    gno_lit_row rows[MOST_ROWS];
    const double sx = -0.5, sy = -0.8, sz = 0.4, wide = 0.8 * sx / sy, drop = 0.8 * -sz / sy;
    (void)state;
    for (int low = 0; low < 2; low++) {
        stage s = stage_make(NULL);
        add_plate(&s, 0, 0, 0, 4, 0, 0, 0, 0, 3, 0);
        add_plate(&s, 0, 0, 0, 0, -0.8, 0, 0, 0, low ? 3 : 9, 0);
        add_sun(&s, sx, sy, sz);
        light_up(&s, 0, rows);
        assert_near(rows[0].lit_area, 12 - wide * 3 + (low ? 0.5 * wide * drop : 0), CLOSE);
        stage_drop(&s);
    }
}

/* Ten slats, 0.2 deep and 0.25 apart, before a wall: each shades 0.2 sz/sy of height, or all where they meet. */
static void test_louvre(void **state)
{
    const double heights[] = {0.3, 0.9, 1.2, 1.25, 1.3, 4};
    (void)state;
    for (size_t k = 0; k < sizeof heights / sizeof heights[0]; k++) {
        gno_lit_row rows[MOST_ROWS];
        stage s = stage_make(NULL);
        double shade = 0.2 * heights[k];
        add_plate(&s, 0, 0, 0, 4, 0, 0, 0, 0, 2, 0);
        for (int i = 0; i < 12; i++)
            add_plate(&s, -50, 0, 0.25 * (i + 1), 104, 0, 0, 0, -0.2, 0, 0);
        add_sun(&s, 0.4, -1, heights[k]);
        light_up(&s, 0, rows);
        if (shade < 0.25)
            assert_near(rows[0].lit_area, 4 * 8 * (0.25 - shade), CLOSE);
        else
            assert_true(rows[0].lit_area == 0 && rows[0].fraction == 0 && rows[0].centroid[2] == 0);
        stage_drop(&s);
    }
}

/* A cube on a plane: what it stands on and its shadow are the hull of a square and a shifted one. */
static void test_cube_on_plane(void **state)
{
    gno_lit_row rows[MOST_ROWS];
    gno_lit_summary sum;
    const double a[3] = {-1, -1, 0}, b[3] = {1, 1, 2};
    double ground;
    stage s = stage_make(NULL);
    (void)state;
    add_plate(&s, -50, -50, 0, 100, 0, 0, 0, 100, 0, 0);
    assert_true(add_box(s.scene, a, b, 0, 0));
    add_sun(&s, 0.3, -0.9, 0.7);
    sum = light_up(&s, 0, rows);
    ground = 10000 - (4 + 2 * (2 * 0.3 / 0.7) + 2 * (2 * 0.9 / 0.7));
    assert_near(rows[0].lit_area, ground, CLOSE);
    assert_near(sum.lit_area, ground + 3 * 4, CLOSE); /* three sides face the sun, three do not */
    assert_near(sum.area, 10000 + 24, CLOSE);
    assert_near(sum.flux_union, 10000 * 0.7 / sqrt(0.3 * 0.3 + 0.9 * 0.9 + 0.7 * 0.7), CLOSE);
    assert_int_equal(sum.unlit + sum.full + sum.clipped, 7);
    assert_int_equal(sum.clipped, 1);
    stage_drop(&s);
}

/* Two bars at different heights, each longer than the floor one way: their shadows cross. */
static void test_crossing_shadows(void **state)
{
    gno_lit_row rows[MOST_ROWS];
    stage s = stage_make(NULL);
    (void)state;
    add_plate(&s, 0, 0, 0, 10, 0, 0, 0, 10, 0, 0);
    add_plate(&s, -30, 4, 3, 60, 0, 0, 0, 1.5, 0, 0);
    add_plate(&s, 4, -30, 5, 0.75, 0, 0, 0, 60, 0, 0);
    add_sun(&s, 0.2, 0.3, 1);
    light_up(&s, 0, rows);
    assert_near(rows[0].lit_area, 100 - 10 * 1.5 - 10 * 0.75 + 1.5 * 0.75, CLOSE);
    assert_near(rows[1].fraction, 1 - 0.75 * 1.5 / (60 * 1.5), CLOSE); /* the higher bar shades the lower one */
    stage_drop(&s);
}

/* A lamp 10 above the floor, a plate 4 above it: the shadow is 10/6 as long. The lamp's cube measure of everything is that of
 * the floor. */
static void test_point_light(void **state)
{
    gno_lit_row rows[MOST_ROWS];
    gno_lit_summary sum;
    stage s = stage_make(NULL);
    (void)state;
    add_plate(&s, -8, -8, 0, 16, 0, 0, 0, 16, 0, 0);
    add_plate(&s, 0.3, -0.7, 4, 1.5, 0, 0, 0, 1.2, 0, 0);
    add_plate(&s, -2, -2, 11, 4, 0, 0, 0, 4, 0, 0); /* above the lamp: shades nothing */
    add_lamp(&s, 0.5, 0.25, 10);
    sum = light_up(&s, 0, rows);
    assert_near(rows[0].lit_area, 256 - 1.5 * 1.2 * (10.0 / 6) * (10.0 / 6), CLOSE);
    assert_near(rows[1].lit_area, 1.8, CLOSE);
    assert_near(rows[2].lit_area, 16, CLOSE);
    assert_true(sum.flux_union > 4);
    stage_drop(&s);
}

/* A lamp in a closed room lights all of it, and takes the whole cube: 24. A wall that reaches through the lamp's height. */
static void test_room(void **state)
{
    gno_lit_row rows[MOST_ROWS];
    gno_lit_summary sum;
    const double a[3] = {0, 0, 0}, b[3] = {6, 5, 3};
    stage s = stage_make(NULL);
    (void)state;
    assert_true(add_box(s.scene, a, b, 0, 0));
    add_lamp(&s, 2, 2, 1);
    sum = light_up(&s, 0, rows);
    assert_near(sum.lit_area, 2 * (30 + 18 + 15), CLOSE);
    assert_near(sum.flux_union, 24, CLOSE);
    assert_int_equal(sum.full, 6);
    add_plate(&s, 4, 0, 0, 0, 5, 0, 0, 0, 2, 0); /* a screen from the floor to height 2, across the room */
    sum = light_up(&s, 0, rows);
    assert_near(sum.flux_union, 24, CLOSE);
    /* On the far wall, 4 from the lamp, the screen's upper edge, 2 away and 1 up, is seen at 2 up: height 3, all is dark. */
    for (int k = 0; k < 6; k++)
        assert_true(fabs(rows[k].centroid[0] - 6) > 1e-9);
    assert_near(rows[6].lit_area, 10, CLOSE);
    stage_drop(&s);
}

/* A spot straight above a floor draws a circle; its area is exact, its edge a 720-sided polygon. */
static void test_spot(void **state)
{
    gno_lit_row rows[MOST_ROWS];
    gno_light light = gno_light_default();
    stage s = stage_make(NULL);
    double r = 5 * tan(15 * PI / 180);
    (void)state;
    add_plate(&s, -8, -8, 0, 16, 0, 0, 0, 16, 0, 0);
    add_plate(&s, -8, -8, 6, 16, 0, 0, 0, 16, 0, 0); /* behind the spot */
    light.type = GNO_LIGHT_SPOT;
    light.position[2] = 5;
    light.direction[2] = -1;
    light.angle = 30;
    assert_int_equal(gno_scene_add_light(s.scene, "spot", &light, NULL), GNO_OK);
    light_up(&s, 0, rows);
    assert_near(rows[0].lit_area, PI * r * r, CLOSE);
    assert_true(fabs(rows[0].centroid[0]) < 1e-12);
    assert_true(rows[1].lit_area == 0);
    add_plate(&s, 0, -9, 1, 9, 0, 0, 0, 18, 0, 0); /* shades the half beyond x = 0 */
    light_up(&s, 0, rows);
    assert_near(rows[0].lit_area, PI * r * r / 2, CLOSE);
    stage_drop(&s);
}

/* Sun through a window in a wall onto the floor: the hole's shape, sheared. */
static void test_hole(void **state)
{
    static const double p[8][3] = {{-9, 0, 0}, {9, 0, 0}, {9, 0, 9}, {-9, 0, 9}, {-1, 0, 1}, {1, 0, 1}, {1, 0, 2}, {-1, 0, 2}};
    static const int corners[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    static const unsigned rings[3] = {0, 4, 8}, polygons[2] = {0, 2};
    gno_lit_row rows[MOST_ROWS];
    gno_mesh_def mesh = gno_mesh_def_default();
    gno_pieces *pieces;
    gno_piece piece;
    stage s = stage_make(NULL);
    (void)state;
    add_plate(&s, -3, 0, 0, 6, 0, 0, 0, 3, 0, 0);
    mesh.vertex_count = mesh.corner_count = 8;
    mesh.positions = &p[0][0];
    mesh.polygon_count = 1;
    mesh.polygon_start = polygons;
    mesh.ring_count = 2;
    mesh.ring_start = rings;
    mesh.corner_vertex = corners;
    assert_int_equal(gno_scene_add_mesh(s.scene, &mesh, NULL), GNO_OK);
    add_sun(&s, 0.1, -1, 1);
    light_up(&s, 0, rows);
    assert_near(rows[0].lit_area, 2, CLOSE);
    assert_near(rows[0].centroid[1], 1.5, CLOSE);
    assert_near(rows[0].centroid[0], -0.15, 1e-11);
    assert_near(rows[1].area, 162 - 2, CLOSE);
    assert_int_equal(gno_lit_pieces(s.scene, 0, NULL, &pieces, NULL, NULL), GNO_OK);
    assert_int_equal(gno_pieces_count(pieces), 2);
    assert_int_equal(gno_pieces_get(pieces, 1, &piece), GNO_OK);
    assert_int_equal(piece.polygon, 1);
    assert_int_equal(piece.ring_count, 2);
    assert_near(piece.area, 160, CLOSE);
    assert_int_equal(piece.light_count, 1);
    assert_int_equal(piece.lights[0], 0);
    assert_true(piece.passed[0] == 1 && piece.passed[1] == 1 && piece.passed[2] == 1);
    gno_pieces_destroy(pieces);
    stage_drop(&s);
}

/* Behind glass the floor is dimmed, behind two panes more so; the panes' own shadow is part of the certificate. */
static void test_glass(void **state)
{
    gno_lit_row rows[MOST_ROWS];
    gno_material glass = gno_material_default();
    gno_pieces *pieces;
    double by_share[3] = {0, 0, 0};
    int index;
    stage s = stage_make(NULL);
    (void)state;
    glass.transmission[0] = 0.8;
    glass.transmission[1] = 0.5;
    assert_int_equal(gno_scene_add_material(s.scene, &glass, &index), GNO_OK);
    add_plate(&s, 0, 0, 0, 10, 0, 0, 0, 10, 0, 0);
    add_plate(&s, 1, 1, 2, 4, 0, 0, 0, 4, 0, index);
    add_plate(&s, 3, 3, 3, 4, 0, 0, 0, 4, 0, index);
    add_sun(&s, 0, 0, 1);
    light_up(&s, 0, rows);
    assert_near(rows[0].lit_area, 100 - 28, CLOSE);
    assert_near(rows[0].dimmed_area, 28, CLOSE);
    assert_int_equal(gno_lit_pieces(s.scene, 0, NULL, &pieces, NULL, NULL), GNO_OK);
    for (size_t i = 0; i < gno_pieces_count(pieces); i++) {
        gno_piece piece;
        assert_int_equal(gno_pieces_get(pieces, i, &piece), GNO_OK);
        if (piece.polygon == 0) {
            by_share[piece.passed[0] == 1 ? 0 : piece.passed[0] == 0.8 ? 1 : 2] += piece.area;
            assert_true(piece.passed[2] == (piece.passed[0] == 1 ? 1 : 0));
        }
    }
    assert_near(by_share[0], 72, CLOSE);
    assert_near(by_share[1], 24, CLOSE);
    assert_near(by_share[2], 4, CLOSE); /* 0.64 of the red light */
    gno_pieces_destroy(pieces);
    stage_drop(&s);
}

/* A window lying in the plane of an uncut wall: neither shades the other, and the light counts once. Neighbours that share an edge. */
static void test_coplanar(void **state)
{
    gno_lit_row rows[MOST_ROWS];
    gno_lit_summary sum;
    stage s = stage_make(NULL);
    (void)state;
    add_plate(&s, 0, 0, 0, 4, 0, 0, 0, 0, 3, 0);
    add_plate(&s, 1, 0, 1, 2, 0, 0, 0, 0, 1, 0);
    add_plate(&s, 4, 0, 0, 0, -4, 0, 0, 0, 3, 0); /* shades a part of both */
    add_plate(&s, 0, 0, 0, 4, 0, 0, 0, -4, 0, 0);
    add_sun(&s, 1, -2, 0.5);
    sum = light_up(&s, 0, rows);
    /* The screen's shadow reaches from x = 2 to 4 and up to z = 1 + x/2; of the window it takes x from 2 to 3. */
    assert_near(rows[0].lit_area, 12 - 5, CLOSE);
    assert_near(rows[1].lit_area, 1, CLOSE);
    assert_near(sum.flux_twice, rows[1].lit_area * 2 / sqrt(1 + 4 + 0.25), CLOSE);
    stage_drop(&s);
}

/* The back of a one-sided polygon is not lit, a two-sided one's is; an edge-on one is not; a degenerate one has a row of zeros. */
static void test_sides(void **state)
{
    static const double line[3][3] = {{0, 0, 5}, {1, 0, 5}, {2, 0, 5}};
    gno_lit_row rows[MOST_ROWS];
    gno_lit_summary sum;
    gno_material one_sided = gno_material_default();
    int index;
    stage s = stage_make(NULL);
    (void)state;
    one_sided.two_sided = 0;
    assert_int_equal(gno_scene_add_material(s.scene, &one_sided, &index), GNO_OK);
    add_plate(&s, 0, 0, 0, 10, 0, 0, 0, 10, 0, 0);
    add_plate(&s, 1, 1, 1, 0, 3, 0, 3, 0, 0, 0);
    add_plate(&s, 5, 1, 1, 0, 3, 0, 3, 0, 0, index);
    add_plate(&s, 5, 5, 1, 3, 0, 0, 0, 3, 0, index);
    add_plate(&s, 2, 2, 3, 2, 0, 0, 0, 0, 2, 0);
    assert_true(add_polygon(s.scene, line, 3, 0, 0));
    add_sun(&s, 0, 0, 3);
    sum = light_up(&s, 0, rows);
    assert_near(rows[0].lit_area, 100 - 27, CLOSE);
    assert_true(rows[1].side == -1 && rows[2].side == -1 && rows[3].side == 1 && rows[4].side == 0 && rows[5].side == 0);
    assert_near(rows[1].lit_area, 9, CLOSE);
    assert_true(rows[2].lit_area == 0 && rows[4].lit_area == 0 && rows[5].lit_area == 0 && rows[5].area == 0);
    assert_near(rows[2].area, 9, CLOSE);
    assert_near(rows[3].lit_area, 9, CLOSE);
    assert_near(rows[4].area, 4, CLOSE);
    assert_near(sum.flux_union, 100, CLOSE);
    stage_drop(&s);
}

/* A roof that reaches below the wall's own plane is cut to a shadow with a repeated corner, over the wall's upper part. */
static void test_cut_roof(void **state)
{
    gno_lit_row rows[MOST_ROWS];
    stage s = stage_make(NULL);
    (void)state;
    add_plate(&s, 5.944, 1.524, 5.791, 0, 0, -2.438, 0, 3.048, 0, 0);
    add_plate(&s, 0, 18.288, 6.096, 0, -18.288, 0, 6.096, 0, 0, 0);
    add_sun(&s, -0.356255, -0.798801, 0.95);
    light_up(&s, 0, rows);
    /* The roof's edge y = 0 falls to the wall at z = 6.096 - y 0.95 / 0.798801. */
    assert_near(rows[0].lit_area, 0.5 * (6.096 - 1.524 * 0.95 / 0.798801 - 3.353) * ((6.096 - 3.353) * 0.798801 / 0.95 - 1.524), 1e-11);
    stage_drop(&s);
}

/* A plate through the floor: only what stands above shades. */
static void test_crossing_planes(void **state)
{
    gno_lit_row rows[MOST_ROWS];
    stage s = stage_make(NULL);
    (void)state;
    add_plate(&s, -10, -10, 0, 20, 0, 0, 0, 20, 0, 0);
    add_plate(&s, 0, 0, -1, 2, 0, 0, 0, 0, 3, 0);
    add_sun(&s, 0, -1, 1);
    light_up(&s, 0, rows);
    assert_near(rows[0].lit_area, 400 - 2 * 2, CLOSE);
    assert_near(rows[1].lit_area, 4, CLOSE);
    stage_drop(&s);
}

/* An area light is its points; each has its share and place. */
static void test_expanded(void **state)
{
    gno_light light = gno_light_default(), point;
    gno_lit_row rows[MOST_ROWS];
    int source;
    stage s = stage_make(NULL);
    (void)state;
    assert_int_equal(gno_expanded_light_count(s.scene), 0);
    add_lamp(&s, 0, 0, 9);
    light.type = GNO_LIGHT_AREA;
    light.position[2] = 8;
    light.edge1[0] = 2;
    light.edge2[1] = 4;
    light.samples = 2;
    assert_int_equal(gno_scene_add_light(s.scene, "panel", &light, NULL), GNO_OK);
    add_plate(&s, -10, -10, 0, 20, 0, 0, 0, 20, 0, 0);
    add_plate(&s, 0, 0, 4, 1, 0, 0, 0, 1, 0, 0);
    assert_int_equal(gno_expanded_light_count(s.scene), 5);
    assert_int_equal(gno_expanded_light(s.scene, 3, &point, &source), GNO_OK);
    assert_int_equal(source, 1);
    assert_int_equal(point.type, GNO_LIGHT_POINT);
    assert_true(point.position[0] == 1.5 && point.position[1] == 1 && point.position[2] == 8 && point.intensity[0] == 0.25);
    assert_int_equal(gno_expanded_light(s.scene, 0, &point, NULL), GNO_OK);
    assert_true(point.position[2] == 9);
    for (size_t i = 1; i < 5; i++) {
        light_up(&s, i, rows);
        assert_near(rows[0].lit_area, 400 - 4, CLOSE);
    }
    assert_int_equal(gno_expanded_light(s.scene, 5, &point, NULL), GNO_ERROR_ARGUMENT);
    stage_drop(&s);
}

/* ---- options and failures ---------------------------------------------------------------------------------------------------- */

static void fill(stage *s)
{
    const double a[3] = {-1, -1, 0}, b[3] = {1, 1.5, 2}, c[3] = {1.5, -3, 0}, d[3] = {2, 2, 1};
    gno_material glass = gno_material_default();
    gno_light light = gno_light_default();
    int index;
    glass.transmission[0] = glass.transmission[1] = glass.transmission[2] = 0.5;
    assert_int_equal(gno_scene_add_material(s->scene, &glass, &index), GNO_OK);
    add_plate(s, -8, -8, 0, 16, 0, 0, 0, 16, 0, 0);
    add_plate(s, -8, -8, 0, 2, 0, 0, 0, 2, 0, 0);
    assert_true(add_box(s->scene, a, b, 0, 0));
    assert_true(add_box(s->scene, c, d, 0, 0));
    add_plate(s, 0, 0, 3, 1, 0, 0, 0, 1, 0, index);
    add_sun(s, 1, 0.5, 1);
    add_lamp(s, 3, 3, 4);
    light.type = GNO_LIGHT_SPOT;
    light.position[2] = 5;
    light.direction[0] = 0.2;
    light.direction[2] = -1;
    light.angle = 60;
    assert_int_equal(gno_scene_add_light(s->scene, "spot", &light, NULL), GNO_OK);
}

static void assert_same_pieces(const gno_pieces *a, const gno_pieces *b)
{
    assert_int_equal(gno_pieces_count(a), gno_pieces_count(b));
    for (size_t i = 0; i < gno_pieces_count(a); i++) {
        gno_piece p, q;
        assert_int_equal(gno_pieces_get(a, i, &p), GNO_OK);
        assert_int_equal(gno_pieces_get(b, i, &q), GNO_OK);
        assert_true(p.polygon == q.polygon && p.side == q.side && p.ring_count == q.ring_count && p.area == q.area);
        assert_int_equal(p.light_count, q.light_count);
        for (size_t r = 0; r < p.ring_count; r++) {
            size_t n = p.ring_start[r + 1] - p.ring_start[r];
            assert_int_equal(n, q.ring_start[r + 1] - q.ring_start[r]);
            assert_memory_equal(p.points + 3 * p.ring_start[r], q.points + 3 * q.ring_start[r], 3 * n * sizeof(double));
        }
        if (p.light_count > 0) {
            assert_memory_equal(p.lights, q.lights, p.light_count * sizeof *p.lights);
            assert_memory_equal(p.passed, q.passed, 3 * p.light_count * sizeof *p.passed);
        }
    }
}

/* Threads change nothing, nor does leaving the certificate out. */
static void test_options(void **state)
{
    gno_lit_def def = gno_lit_def_default();
    (void)state;
    for (size_t light = 0; light < 3; light++) {
        gno_pieces *one, *other;
        gno_lit_row rows[MOST_ROWS], again[MOST_ROWS];
        gno_lit_summary sum;
        size_t first, count, all = 0;
        stage s = stage_make(NULL);
        fill(&s);
        def.threads = 1;
        def.certify = 1;
        assert_int_equal(gno_lit_pieces(s.scene, light, &def, &one, rows, &sum), GNO_OK);
        assert_true(sum.area_residual <= 1e-12 && sum.flux_residual <= 1e-12 && sum.flux_union > 0);
        def.threads = 7;
        def.certify = 0;
        assert_int_equal(gno_lit_pieces(s.scene, light, &def, &other, again, &sum), GNO_OK);
        assert_true(sum.flux_union == 0 && sum.area_residual == 0);
        assert_memory_equal(rows, again, gno_scene_count(s.scene).polygons * sizeof *rows);
        assert_same_pieces(one, other);
        for (size_t p = 0; p < gno_scene_count(s.scene).polygons; p++) {
            double area = 0;
            assert_int_equal(gno_pieces_of(one, p, &first, &count), GNO_OK);
            assert_int_equal(first, all);
            all += count;
            for (size_t i = first; i < first + count; i++) {
                gno_piece piece;
                assert_int_equal(gno_pieces_get(one, i, &piece), GNO_OK);
                assert_int_equal(piece.polygon, p);
                area += piece.area;
            }
            assert_true(fabs(area - rows[p].lit_area - rows[p].dimmed_area) <= 1e-12 * rows[p].area);
        }
        assert_int_equal(all, gno_pieces_count(one));
        gno_scene_destroy(s.scene); /* a set outlives its scene */
        s.scene = NULL;
        assert_same_pieces(one, other);
        gno_pieces_destroy(one);
        gno_pieces_destroy(other);
        gno_context_destroy(s.context);
    }
}

static void test_arguments(void **state)
{
    gno_lit_def def = gno_lit_def_default();
    gno_pieces *pieces = (gno_pieces *)&def;
    gno_piece piece;
    gno_light light;
    size_t first, count;
    stage s = stage_make(NULL);
    (void)state;
    assert_int_equal(gno_lit_pieces(NULL, 0, NULL, &pieces, NULL, NULL), GNO_ERROR_ARGUMENT);
    assert_null(pieces);
    assert_int_equal(gno_lit_pieces(s.scene, 0, NULL, &pieces, NULL, NULL), GNO_ERROR_ARGUMENT); /* no light */
    add_sun(&s, 0, 0, 1);
    assert_int_equal(gno_lit_pieces(s.scene, 1, NULL, &pieces, NULL, NULL), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_lit_pieces(s.scene, (size_t)-1, NULL, &pieces, NULL, NULL), GNO_ERROR_ARGUMENT);
    def.threads = -1;
    assert_int_equal(gno_lit_pieces(s.scene, 0, &def, &pieces, NULL, NULL), GNO_ERROR_ARGUMENT);
    def.threads = GNO_MAX_THREADS + 1;
    assert_int_equal(gno_lit_pieces(s.scene, 0, &def, &pieces, NULL, NULL), GNO_ERROR_ARGUMENT);
    assert_true(strlen(gno_context_message(s.context)) > 0);
    assert_null(pieces);
    /* A scene without polygons has no pieces. */
    assert_int_equal(gno_lit_pieces(s.scene, 0, NULL, &pieces, NULL, NULL), GNO_OK);
    assert_int_equal(gno_pieces_count(pieces), 0);
    assert_int_equal(gno_pieces_get(pieces, 0, &piece), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_pieces_of(pieces, 0, &first, &count), GNO_ERROR_ARGUMENT);
    gno_pieces_destroy(pieces);
    gno_pieces_destroy(NULL);
    assert_int_equal(gno_pieces_count(NULL), 0);
    assert_int_equal(gno_pieces_get(NULL, 0, &piece), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_pieces_of(NULL, 0, &first, &count), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_expanded_light(NULL, 0, &light, NULL), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_expanded_light(s.scene, 0, NULL, NULL), GNO_ERROR_ARGUMENT);
    assert_int_equal(gno_expanded_light_count(NULL), 0);
    stage_drop(&s);
}

static void test_every_allocation_fails(void **state)
{
    (void)state;
    for (size_t light = 0; light < 3; light++)
        for (size_t at = 0, calls = 1; at <= calls; at++) {
            fail_alloc alloc = {0};
            gno_context_def def = fail_alloc_def(&alloc);
            gno_lit_def how = gno_lit_def_default();
            gno_pieces *pieces = NULL;
            gno_status status;
            size_t before;
            stage s = stage_make(&def);
            how.threads = 1;
            fill(&s);
            before = alloc.calls;
            alloc.fail_at = at ? before + at : 0;
            status = gno_lit_pieces(s.scene, light, &how, &pieces, NULL, NULL);
            if (at == 0) {
                assert_int_equal(status, GNO_OK);
                calls = alloc.calls - before;
                assert_true(calls > 20);
            } else {
                assert_int_equal(status, GNO_ERROR_MEMORY);
                assert_null(pieces);
                assert_true(strlen(gno_context_message(s.context)) > 0);
            }
            gno_pieces_destroy(pieces);
            stage_drop(&s);
            assert_int_equal(alloc.held, 0);
            assert_false(alloc.wrong_size);
        }
}

static int stop(void *user, const char *stage_name, double fraction)
{
    (void)stage_name;
    (void)fraction;
    return ++*(int *)user > 0;
}

/* A scene large enough to be asked: the call stops. */
static void test_cancel(void **state)
{
    gno_context_def def = gno_context_def_default();
    gno_pieces *pieces;
    int asked = 0;
    stage s;
    (void)state;
    def.progress = stop;
    def.progress_user = &asked;
    s = stage_make(&def);
    add_plate(&s, -99, -99, -2, 400, 0, 0, 0, 400, 0, 0);
    for (int i = 0; i < 60; i++)
        for (int k = 0; k < 60; k++) {
            const double a[3] = {i + 0.1 * (k % 3), k, 0}, b[3] = {i + 0.6, k + 0.5 + 0.1 * (i % 4), 1 + 0.2 * (i % 5)};
            assert_true(add_box(s.scene, a, b, 0, 0));
        }
    add_sun(&s, 1, 0.6, 0.5);
    assert_int_equal(gno_lit_pieces(s.scene, 0, NULL, &pieces, NULL, NULL), GNO_ERROR_CANCELLED);
    assert_null(pieces);
    stage_drop(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_overhang),      cmocka_unit_test(test_fin),       cmocka_unit_test(test_louvre),
        cmocka_unit_test(test_cube_on_plane), cmocka_unit_test(test_crossing_shadows), cmocka_unit_test(test_point_light),
        cmocka_unit_test(test_room),          cmocka_unit_test(test_spot),      cmocka_unit_test(test_hole),
        cmocka_unit_test(test_glass),         cmocka_unit_test(test_coplanar),  cmocka_unit_test(test_sides),
        cmocka_unit_test(test_crossing_planes), cmocka_unit_test(test_cut_roof), cmocka_unit_test(test_expanded), cmocka_unit_test(test_options),
        cmocka_unit_test(test_arguments),     cmocka_unit_test(test_every_allocation_fails), cmocka_unit_test(test_cancel),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
