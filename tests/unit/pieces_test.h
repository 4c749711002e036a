/* pieces_test.h -- small scenes for the tests of lit and visible pieces. For inclusion after cmocka.h. */
#ifndef PIECES_TEST_H
#define PIECES_TEST_H

#include "support/random_scene.h"
#include <gnomon/gnomon_pieces.h>
#include <math.h>

typedef struct stage {
    gno_context *context;
    gno_scene *scene;
} stage;

static inline stage stage_make(const gno_context_def *def)
{
    stage s;
    assert_int_equal(gno_context_create(def, &s.context), GNO_OK);
    assert_int_equal(gno_scene_create(s.context, &s.scene), GNO_OK);
    return s;
}

static inline void stage_drop(stage *s)
{
    gno_scene_destroy(s->scene);
    gno_context_destroy(s->context);
}

/* The parallelogram a, a+u, a+u+v, a+v. */
static inline void add_plate(stage *s, double ax, double ay, double az, double ux, double uy, double uz, double vx, double vy, double vz,
                             int material)
{
    const double c[4][3] = {{ax, ay, az}, {ax + ux, ay + uy, az + uz}, {ax + ux + vx, ay + uy + vy, az + uz + vz}, {ax + vx, ay + vy, az + vz}};
    assert_true(add_polygon(s->scene, c, 4, material, 0));
}

static inline void add_sun(stage *s, double to_x, double to_y, double to_z)
{
    gno_light light = gno_light_default();
    light.type = GNO_LIGHT_DIRECTIONAL;
    light.direction[0] = -to_x;
    light.direction[1] = -to_y;
    light.direction[2] = -to_z;
    assert_int_equal(gno_scene_add_light(s->scene, "sun", &light, NULL), GNO_OK);
}

static inline void add_lamp(stage *s, double x, double y, double z)
{
    gno_light light = gno_light_default();
    light.position[0] = x;
    light.position[1] = y;
    light.position[2] = z;
    assert_int_equal(gno_scene_add_light(s->scene, "lamp", &light, NULL), GNO_OK);
}

/* |a - b| <= share * |b|; a NaN fails. */
static inline void assert_near(double a, double b, double share)
{
    if (!(fabs(a - b) <= share * fabs(b))) {
        print_error("%.17g is not %.17g within %g\n", a, b, share);
        fail();
    }
}

enum { MOST_ROWS = 64 };

/* Lights the scene by its light `light`; the certificate must hold to 1e-9. */
static inline gno_lit_summary light_up(stage *s, size_t light, gno_lit_row rows[MOST_ROWS])
{
    gno_lit_summary sum;
    assert_true(gno_scene_count(s->scene).polygons <= MOST_ROWS);
    assert_int_equal(gno_lit_pieces(s->scene, light, NULL, NULL, rows, &sum), GNO_OK);
    assert_true(sum.area_residual <= 1e-9);
    assert_true(sum.flux_residual <= 1e-9);
    return sum;
}

#endif
