/* test_procedural.c -- procedural patterns by their formulas, and filtered over pixels against brute force. Place: tests of src/shade. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <gnomon/gnomon_math.h>

#include <math.h>
#include <string.h>

static void assert_near(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance))
        fail_msg("%.17g is not within %g of %.17g", a, tolerance, b);
}

static gno_footprint at_point(double x, double y, double z)
{
    gno_footprint f;
    memset(&f, 0, sizeof f);
    f.point[0] = x;
    f.point[1] = y;
    f.point[2] = z;
    return f;
}

static double value_at(const gno_procedural *p, double x, double y, double z)
{
    gno_footprint f = at_point(x, y, z);
    return gno_procedural_value(p, &f);
}

static gno_procedural black_and_white(gno_pattern pattern)
{
    gno_procedural p = gno_procedural_default(pattern);
    for (int k = 0; k < 3; k++) {
        p.light[k] = 0;
        p.dark[k] = 1;
        p.mortar_colour[k] = 0.5;
    }
    return p;
}

/* ---- a plane through a camera ------------------------------------------------------------------------------------------ */

/* A pinhole above the plane normal.P = 0, its pixel (x,y) the direction forward + (x right - y up) / focal. */
typedef struct pinhole {
    double eye[3], forward[3], right[3], up[3], focal, normal[3];
} pinhole;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Height above z = 0, looking `down` degrees below the horizon and `turn` degrees about z. */
static pinhole pinhole_above(double height, double down, double turn, double focal)
{
    double d = down * 0.017453292519943295, t = turn * 0.017453292519943295;
    pinhole p = {{0.3, -0.2, height},
                 {cos(d) * cos(t), cos(d) * sin(t), -sin(d)},
                 {sin(t), -cos(t), 0},
                 {sin(d) * cos(t), sin(d) * sin(t), cos(d)},
                 focal,
                 {0, 0, 1}};
    return p;
}

static void direction(const pinhole *p, double x, double y, double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = p->forward[k] + (x * p->right[k] - y * p->up[k]) / p->focal;
}

/* The plane's point at picture coordinates (x,y); 0 above the horizon. */
static int hit(const pinhole *p, double x, double y, double out[3])
{
    double d[3], fall;
    direction(p, x, y, d);
    fall = -dot(d, p->normal);
    if (!(fall > 0))
        return 0;
    for (int k = 0; k < 3; k++)
        out[k] = p->eye[k] + d[k] * dot(p->eye, p->normal) / fall;
    return 1;
}

/* The footprint of the pixel about (x,y): numerators eye fall + d height and divisor fall, linear in x and y, over fall at the middle. */
static int footprint_at(const pinhole *p, double x, double y, gno_footprint *f)
{
    double d[3], fall, height = dot(p->eye, p->normal), fall_x = -dot(p->right, p->normal) / p->focal, fall_y = dot(p->up, p->normal) / p->focal;
    direction(p, x, y, d);
    fall = -dot(d, p->normal);
    if (!(fall > 0))
        return 0;
    for (int k = 0; k < 3; k++) {
        f->point[k] = (p->eye[k] * fall + d[k] * height) / fall;
        f->dx[k] = (p->eye[k] * fall_x + p->right[k] / p->focal * height) / fall;
        f->dy[k] = (p->eye[k] * fall_y - p->up[k] / p->focal * height) / fall;
    }
    f->wx = fall_x / fall;
    f->wy = fall_y / fall;
    return 1;
}

typedef double (*point_fn)(const gno_procedural *p, double x, double y, double z);

/* The checkered floor, z = 0, of unit cells. */
static double checker_at(const gno_procedural *p, double x, double y, double z)
{
    (void)p;
    (void)z;
    return ((long)floor(x) + (long)floor(y)) & 1;
}

/* Bricks of 1 x 0.3 with joints of 0.04 lying on z = 0, their courses along x. */
static double brick_at(const gno_procedural *p, double x, double y, double z)
{
    double course = floor(y / 0.3), v = y - 0.3 * course, u = x - (course - 2 * floor(course / 2)) * 0.5;
    (void)p;
    (void)z;
    u -= floor(u);
    return v > 0.02 && v < 0.28 && u > 0.02 && u < 0.98;
}

/* Mean of the pattern over side^2 points of the pixel, each row of points moved by the golden ratio's share so that no line of the
 * pattern falls on many of them at once. */
static double brute_force(point_fn value, const gno_procedural *p, const pinhole *camera, double x, double y, int side)
{
    double sum = 0;
    int n = 0, count = side * side;
    for (int i = 0; i < count; i++) {
        double at[3], u = (i + 0.5) / count, v = i * 0.61803398874989485 - floor(i * 0.61803398874989485);
        if (hit(camera, x + u - 0.5, y + v - 0.5, at)) {
            sum += value(p, at[0], at[1], at[2]);
            n++;
        }
    }
    return n ? sum / n : -1;
}

typedef struct deviation {
    double worst;
    int pixels;
} deviation;

/* Pixels of a picture of 2 x 120 by 2 x 90, every step-th, those whose centre sees the plane. */
static deviation compare(point_fn value, const gno_procedural *p, const pinhole *camera, int step, int side)
{
    deviation d = {0, 0};
    for (int y = -90; y < 90; y += step) {
        for (int x = -120; x < 120; x += step + 4) {
            gno_footprint f;
            double brute;
            if (!footprint_at(camera, x + 0.5, y + 0.5, &f))
                continue;
            brute = brute_force(value, p, camera, x + 0.5, y + 0.5, side);
            d.worst = fmax(d.worst, fabs(gno_procedural_value(p, &f) - brute));
            d.pixels++;
        }
    }
    return d;
}

/* ---- checker ------------------------------------------------------------------------------------------------------------ */

static void test_checker_points(void **state)
{
    gno_procedural p = black_and_white(GNO_PATTERN_CHECKER);
    (void)state;
    assert_near(value_at(&p, 0.5, 0.5, 0.5), 0, 0);
    assert_near(value_at(&p, 1.5, 0.5, 0.5), 1, 0);
    assert_near(value_at(&p, 1.5, -0.5, 0.5), 0, 0);
    assert_near(value_at(&p, -0.5, 0.5, 0.5), 1, 0);
    assert_near(value_at(&p, -0.5, -0.5, -0.5), 1, 0);
    p.scale[0] = p.scale[1] = p.scale[2] = 2;
    p.origin[0] = 10;
    assert_near(value_at(&p, 11.5, 0.5, 0.5), 0, 0);
    assert_near(value_at(&p, 9.5, 0.5, 0.5), 1, 0);
}

/* A pixel of a quarter of a cell's width over a corner, by hand: one quarter each. And over an edge, one third to two. */
static void test_checker_areas_by_hand(void **state)
{
    gno_procedural p = black_and_white(GNO_PATTERN_CHECKER);
    gno_footprint f = at_point(3, 2, 0.5);
    (void)state;
    f.dx[0] = f.dy[1] = 0.25;
    assert_near(gno_procedural_value(&p, &f), 0.5, 1e-5);
    f.point[1] = 2.5;
    f.point[0] = 3 + 0.25 / 6; /* a third of the pixel left of x = 3, where floors add up to 2 + 2 + 0 */
    assert_near(gno_procedural_value(&p, &f), 2.0 / 3, 1e-5);
    f.dx[0] = 3; /* from 1.5 to 4.5 about 3: half of cell 1, 2, 3, half of 4; odd sums for 1 and 3 */
    f.point[0] = 3;
    assert_near(gno_procedural_value(&p, &f), 0.5, 1e-5);
    f.dy[1] = 0;
    f.dy[0] = 1e-9; /* a footprint without area in the plane */
    assert_near(gno_procedural_value(&p, &f), 0.5, 1e-5);
}

/* The checkered plane to the horizon, looked at along the cells, askew, and along their diagonals; and from high above. 65,536 points
 * a pixel, for where hundreds of cells meet in one 4,096 points are themselves wrong by more than is tested. */
static void test_checker_plane(void **state)
{
    static const double views[][4] = {{1.7, 2, 0, 200}, {1.7, 2, 23, 200}, {1.7, 1, 45, 400}, {0.2, 5, 10, 300}, {30, 60, 31, 250}};
    gno_procedural p = black_and_white(GNO_PATTERN_CHECKER);
    (void)state;
    for (size_t i = 0; i < sizeof views / sizeof *views; i++) {
        pinhole camera = pinhole_above(views[i][0], views[i][1], views[i][2], views[i][3]);
        deviation d = compare(checker_at, &p, &camera, 29, 256);
        assert_true(d.pixels > 20);
        if (d.worst > 1.0 / 255)
            fail_msg("view %u: %g", (unsigned)i, d.worst);
    }
}

/* The last rows before the horizon, where a pixel sees thousands of cells. */
static void test_checker_horizon(void **state)
{
    gno_procedural p = black_and_white(GNO_PATTERN_CHECKER);
    pinhole camera = pinhole_above(1.7, 2, 23, 200);
    double horizon = -200 * tan(2 * 0.017453292519943295); /* y of the horizon in the middle column */
    (void)state;
    for (int i = 0; i < 6; i++) {
        gno_footprint f;
        double y = horizon + 0.6 + i;
        assert_int_equal(footprint_at(&camera, 0.5, y, &f), 1);
        assert_near(gno_procedural_value(&p, &f), brute_force(checker_at, &p, &camera, 0.5, y, 1000), 1.0 / 255);
    }
}

/* A face in a lattice plane has one colour a cell, whatever rounding does to its points. */
static void test_checker_face_in_lattice_plane(void **state)
{
    gno_procedural p = black_and_white(GNO_PATTERN_CHECKER);
    (void)state;
    for (int i = -5; i < 6; i++) {
        assert_near(value_at(&p, 0.5, 0.5, 3 + i * 1e-12), 1, 0);
        assert_near(value_at(&p, 0.5, 0.5, i * 1e-12), 0, 0);
    }
}

/* ---- brick ------------------------------------------------------------------------------------------------------------- */

static void test_brick_points(void **state)
{
    gno_procedural p = black_and_white(GNO_PATTERN_BRICK); /* 1 x 0.3, joints 0.04: bricks from 0.02 to 0.98, 0.02 to 0.28 */
    (void)state;
    assert_near(value_at(&p, 0.5, 0, 0.15), 1, 0);
    assert_near(value_at(&p, 0.5, 0, 0.295), 0, 0);
    assert_near(value_at(&p, 0.5, 0, 0.305), 0, 0);
    assert_near(value_at(&p, 0.01, 0, 0.15), 0, 0);
    assert_near(value_at(&p, 0.01, 0, 0.45), 1, 0); /* the next course lies half a brick further */
    assert_near(value_at(&p, 0.51, 0, 0.45), 0, 0);
    assert_near(value_at(&p, -0.5, 0, -0.45), 1, 0);
}

/* Walls along x and along y show the same bricks; so does, lying, a floor. */
static void test_brick_faces(void **state)
{
    gno_procedural p = black_and_white(GNO_PATTERN_BRICK);
    gno_footprint wall_x = at_point(0.01, 7.77, 0.15), wall_y = at_point(7.77, 0.01, 0.15), floor_xy = at_point(0.5, 0.25, 0.3);
    (void)state;
    wall_x.dx[0] = wall_x.dy[2] = wall_y.dx[1] = wall_y.dy[2] = floor_xy.dx[0] = floor_xy.dy[1] = 1e-3;
    assert_near(gno_procedural_value(&p, &wall_x), 0, 1e-9);
    assert_near(gno_procedural_value(&p, &wall_y), 0, 1e-9);
    wall_x.point[0] = wall_y.point[1] = 0.5;
    assert_near(gno_procedural_value(&p, &wall_x), 1, 1e-9);
    assert_near(gno_procedural_value(&p, &wall_y), 1, 1e-9);
    assert_near(gno_procedural_value(&p, &floor_xy), 1, 1e-9);
}

static void test_brick_wall_filtered(void **state)
{
    gno_procedural p = black_and_white(GNO_PATTERN_BRICK);
    pinhole camera = pinhole_above(1.2, 3, 20, 200);
    deviation d;
    (void)state;
    p.brick[1] = 0.3; /* of faces that look along z */
    d = compare(brick_at, &p, &camera, 29, 256);
    assert_true(d.pixels > 20);
    assert_true(d.worst <= 1.0 / 255);
    /* Far away: the mean, brick area over all. */
    {
        gno_footprint f = at_point(0, 0, 0);
        f.dx[0] = 1000;
        f.dy[1] = 1000;
        assert_near(gno_procedural_value(&p, &f), 0.96 * 0.26 / 0.3, 1e-3);
    }
}

/* Colours: mortar, and bricks between light and dark, each its own. */
static void test_brick_colours(void **state)
{
    gno_procedural p = black_and_white(GNO_PATTERN_BRICK);
    double rgb[3], least = 1, most = 0, sum = 0;
    (void)state;
    for (int i = 0; i < 1000; i++) {
        gno_footprint f = at_point(i + 0.5, 0, 0.15);
        gno_procedural_colour(&p, &f, rgb);
        least = fmin(least, rgb[0]);
        most = fmax(most, rgb[0]);
        sum += rgb[0];
    }
    assert_true(least < 0.01 && most > 0.99);
    assert_near(sum / 1000, 0.5, 0.05);
    {
        gno_footprint f = at_point(0.5, 0, 0);
        gno_procedural_colour(&p, &f, rgb);
        assert_near(rgb[1], 0.5, 0);
    }
}

/* ---- wood and marble ---------------------------------------------------------------------------------------------------- */

/* Without noise: C1 + (C2 - C1) (1 + sin t)/2, t = 2 pi rings sqrt(x^2 + y^2). */
static void test_wood_formula(void **state)
{
    gno_procedural p = gno_procedural_default(GNO_PATTERN_WOOD);
    (void)state;
    p.distortion = p.grain = 0;
    for (int i = 0; i < 200; i++) {
        double x = 0.013 * i, y = 1 - 0.007 * i, rgb[3], f = 0.5 * (1 + sin(6.283185307179586 * p.rings * sqrt(x * x + y * y)));
        gno_footprint at = at_point(x, y, 0.1 * i);
        gno_procedural_colour(&p, &at, rgb);
        for (int k = 0; k < 3; k++)
            assert_near(rgb[k], p.light[k] + (p.dark[k] - p.light[k]) * f, 1e-9);
        p.sharpness = 1 + i % 8;
        assert_near(gno_procedural_value(&p, &at), pow(f, p.sharpness), 1e-9);
        p.sharpness = 1;
    }
}

/* Rings turn about the axis asked for, through the origin asked for. */
static void test_wood_frame(void **state)
{
    gno_procedural p = gno_procedural_default(GNO_PATTERN_WOOD);
    (void)state;
    p.distortion = p.grain = 0;
    p.axis[0] = 3;
    p.axis[2] = 0;
    p.across[0] = 0;
    p.across[1] = 2;
    p.origin[1] = 5;
    p.rings = 0.5;
    for (int i = 0; i < 20; i++)
        assert_near(value_at(&p, i, 5 + 3, 4), 0.5 * (1 + sin(3.141592653589793 * 5)), 1e-9);
    p.scale[1] = 3; /* y of the frame is z x x = x axis (1,0,0) x (0,1,0) = (0,0,1) */
    assert_near(value_at(&p, 0, 5 + 4, 9), 0.5 * (1 + sin(3.141592653589793 * 5)), 1e-9);
}

/* Sinc filters are the box's mean: with straight veins, against brute force, to rounding. */
static void test_veins_are_box_filtered(void **state)
{
    gno_procedural p = gno_procedural_default(GNO_PATTERN_MARBLE);
    (void)state;
    p.distortion = 0;
    p.rings = 1.7;
    for (int i = 0; i < 60; i++) {
        gno_footprint f = at_point(0.1 * i, 0, 0);
        double mean = 0;
        int n = 200;
        f.dx[0] = 0.02 * i;
        f.dy[0] = 0.013 * i;
        f.dy[2] = 0.015 * i;
        f.dx[2] = 0.003 * i;
        for (int j = 0; j < n * n; j++) {
            double u = (j % n + 0.5) / n - 0.5, v = (j / n + 0.5) / n - 0.5;
            mean += value_at(&p, f.point[0] + u * f.dx[0] + v * f.dy[0], 0, u * f.dx[2] + v * f.dy[2]) / n / n;
        }
        assert_near(gno_procedural_value(&p, &f), mean, 0.01);
    }
}

/* Patterns with noise, on a plane to the horizon: near the mean of many samples, as an unfiltered value is not. */
static void test_smooth_patterns_filtered(void **state)
{
    static const gno_pattern patterns[4] = {GNO_PATTERN_WOOD, GNO_PATTERN_MARBLE, GNO_PATTERN_NOISE, GNO_PATTERN_CLOUD};
    pinhole camera = pinhole_above(1.7, 4, 20, 150);
    (void)state;
    for (int i = 0; i < 4; i++) {
        gno_procedural p = black_and_white(patterns[i]);
        double filtered = 0, plain = 0;
        int n = 0;
        for (int y = -8; y < 90; y += 9) {
            for (int x = -100; x < 100; x += 27) {
                gno_footprint f;
                double brute, at[3];
                if (!footprint_at(&camera, x, y, &f))
                    continue;
                brute = brute_force(value_at, &p, &camera, x, y, 48);
                hit(&camera, x, y, at);
                filtered += pow(gno_procedural_value(&p, &f) - brute, 2);
                plain += pow(value_at(&p, at[0], at[1], at[2]) - brute, 2);
                n++;
            }
        }
        if (!(filtered < 0.3 * plain && sqrt(filtered / n) < 0.06))
            fail_msg("pattern %d: %g filtered, %g plain", i, sqrt(filtered / n), sqrt(plain / n));
    }
}

/* ---- all ------------------------------------------------------------------------------------------------------------- */

static void test_defaults_are_valid(void **state)
{
    const char *field = "";
    (void)state;
    for (int i = GNO_PATTERN_WOOD; i <= GNO_PATTERN_CLOUD; i++) {
        gno_procedural p = gno_procedural_default((gno_pattern)i), q = p;
        assert_int_equal(gno_procedural_is_valid(&p, &field), 1);
        p.scale[1] = 0;
        assert_int_equal(gno_procedural_is_valid(&p, &field), 0);
        assert_string_equal(field, "scale");
        p = q;
        p.across[0] = 0;
        p.across[2] = 5; /* along the axis */
        assert_int_equal(gno_procedural_is_valid(&p, NULL), 0);
        p = q;
        p.rings = NAN;
        assert_int_equal(gno_procedural_is_valid(&p, &field), 0);
        assert_string_equal(field, "rings");
        p = q;
        p.mortar = 0.3;
        assert_int_equal(gno_procedural_is_valid(&p, &field), 0);
        assert_string_equal(field, "mortar");
    }
}

/* Colours stay between the pattern's colours, whatever the footprint. */
static void test_strange_footprints(void **state)
{
    static const double sizes[] = {0, 1e-300, 1e-9, 1, 1e9, 1e200};
    uint32_t r = 1;
    (void)state;
    for (int i = 0; i < 20000; i++) {
        gno_procedural p = black_and_white((gno_pattern)(i % 6));
        gno_footprint f;
        double rgb[3], w[2], *numbers[4] = {f.point, f.dx, f.dy, w};
        for (int k = 0; k < 11; k++) {
            r = r * 1664525u + 1013904223u;
            numbers[k / 3][k % 3] = (r / 4294967296.0 - 0.5) * sizes[r % 6];
            if (k == 9 || k == 10)
                w[k - 9] = (r / 4294967296.0 - 0.5) * (i % 4);
        }
        f.wx = w[0];
        f.wy = w[1];
        gno_procedural_colour(&p, &f, rgb);
        assert_true(rgb[0] >= -1e-9 && rgb[0] <= 1 + 1e-9);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_checker_points),
        cmocka_unit_test(test_checker_areas_by_hand),
        cmocka_unit_test(test_checker_plane),
        cmocka_unit_test(test_checker_horizon),
        cmocka_unit_test(test_checker_face_in_lattice_plane),
        cmocka_unit_test(test_brick_points),
        cmocka_unit_test(test_brick_faces),
        cmocka_unit_test(test_brick_wall_filtered),
        cmocka_unit_test(test_brick_colours),
        cmocka_unit_test(test_wood_formula),
        cmocka_unit_test(test_wood_frame),
        cmocka_unit_test(test_veins_are_box_filtered),
        cmocka_unit_test(test_smooth_patterns_filtered),
        cmocka_unit_test(test_defaults_are_valid),
        cmocka_unit_test(test_strange_footprints),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
