/* test_lit_star.c -- lit areas with a star drawn in one stroke: it turns one way only, but twice around, and its middle is empty. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include "pieces_test.h"

#define PI 3.14159265358979323846
#define CLOSE 1e-12

/* Five corners at distance 1 from (0,0,z), each joined to the next but one. */
static void add_star(stage *s, double z)
{
    double corner[5][3];
    for (int i = 0; i < 5; i++) {
        corner[i][0] = cos(0.8 * PI * i + 0.1);
        corner[i][1] = sin(0.8 * PI * i + 0.1);
        corner[i][2] = z;
    }
    assert_true(add_polygon(s->scene, (const double(*)[3])corner, 5, 0, 0));
}

/* The edges meet at this distance from the middle. */
static double inner(void) { return cos(0.4 * PI) / cos(0.2 * PI); }

/* The outline's triangles from the middle, less the pentagon in it. */
static double points_area(void) { return 5 * inner() * sin(0.2 * PI) - 2.5 * inner() * inner() * sin(0.4 * PI); }

static void test_star_is_lit(void **state)
{
    gno_lit_row rows[MOST_ROWS];
    stage s = stage_make(NULL);
    (void)state;
    add_star(&s, 0);
    add_sun(&s, 0.1, 0.2, 1);
    light_up(&s, 0, rows);
    assert_near(rows[0].area, points_area(), CLOSE);
    assert_near(rows[0].lit_area, points_area(), CLOSE);
    stage_drop(&s);
}

/* Its shadow on a floor, on a plate in its middle, and on one half in its middle, from lamps at both kinds of distance. */
static void test_star_shades(void **state)
{
    (void)state;
    for (int lamp = 0; lamp < 2; lamp++) {
        gno_lit_row rows[MOST_ROWS];
        stage s = stage_make(NULL);
        const double scale = lamp ? 2 : 1, half = 0.2 * scale;
        add_star(&s, 1);
        add_plate(&s, -9, -9, 0, 18, 0, 0, 0, 18, 0, 0);
        add_plate(&s, -half, -half, 0, 2 * half, 0, 0, 0, 2 * half, 0, 0);
        if (lamp)
            add_lamp(&s, 0, 0, 2);
        else
            add_sun(&s, 0, 0, 1);
        light_up(&s, 0, rows);
        assert_near(rows[0].lit_area, points_area(), CLOSE);
        assert_near(18 * 18 - rows[1].lit_area, scale * scale * points_area(), 1e-10);
        assert_near(rows[2].fraction, 1, CLOSE);
        stage_drop(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_star_is_lit), cmocka_unit_test(test_star_shades)};
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
