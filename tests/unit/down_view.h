/* down_view.h -- a small scene seen straight from above, for tests that work pixels by hand. For inclusion after cmocka.h, in test
 * programs only.
 */
#ifndef DOWN_VIEW_H
#define DOWN_VIEW_H

#include <gnomon/gnomon.h>
#include <math.h>

#define SIDE 32

/* Looks down the z axis on [-4,4] x [-4,4], four pixels a unit; x to the right, y up. */
typedef struct bench {
    gno_context *context;
    gno_scene *scene;
    float rgb[SIDE * SIDE * 3];
} bench;

static inline void set_up(bench *b, double background)
{
    gno_camera camera = gno_camera_default();
    gno_image_def image = gno_image_def_default();
    const double white[3] = {1, 1, 1};
    assert_int_equal(gno_context_create(NULL, &b->context), GNO_OK);
    assert_int_equal(gno_scene_create(b->context, &b->scene), GNO_OK);
    camera.type = GNO_CAMERA_ORTHOGRAPHIC;
    for (int k = 0; k < 3; k++) {
        camera.eye[k] = k == 2 ? 10 : 0;
        camera.target[k] = 0;
        camera.up[k] = k == 1;
        image.background[k] = background;
    }
    camera.height = 8;
    image.width = image.height = SIDE;
    assert_int_equal(gno_scene_set_camera(b->scene, &camera), GNO_OK);
    assert_int_equal(gno_scene_set_image(b->scene, &image), GNO_OK);
    assert_int_equal(gno_scene_set_ambient(b->scene, white), GNO_OK);
}

static inline void tear_down(bench *b)
{
    gno_scene_destroy(b->scene);
    gno_context_destroy(b->context);
}

/* A material of given ambient colour (diffuse: the share of light it sends back) and transmission, all channels alike. */
static inline int material(bench *b, double ambient, double diffuse, double transmission)
{
    gno_material m = gno_material_default();
    int index = 0;
    for (int k = 0; k < 3; k++) {
        m.ambient[k] = ambient;
        m.diffuse[k] = diffuse;
        m.transmission[k] = transmission;
    }
    assert_int_equal(gno_scene_add_material(b->scene, &m, &index), GNO_OK);
    return index;
}

/* The rectangle [x0,x1] x [y0,y1] at height z + slope x. */
static inline void rectangle(bench *b, double x0, double x1, double y0, double y1, double z, double slope, int of, int priority)
{
    const double p[12] = {x0, y0, z + slope * x0, x1, y0, z + slope * x1, x1, y1, z + slope * x1, x0, y1, z + slope * x0};
    const unsigned ring[2] = {0, 4};
    const int corners[4] = {0, 1, 2, 3};
    gno_mesh_def mesh = gno_mesh_def_default();
    mesh.vertex_count = mesh.corner_count = 4;
    mesh.positions = p;
    mesh.polygon_count = mesh.ring_count = 1;
    mesh.ring_start = ring;
    mesh.corner_vertex = corners;
    mesh.material = of;
    mesh.priority = priority;
    assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, NULL), GNO_OK);
}

static inline void draw(bench *b) { assert_int_equal(gno_render(b->scene, NULL, b->rgb, NULL), GNO_OK); }

/* The pixel whose lower left corner is (x,y); x, y multiples of a quarter. */
static inline void expect(const bench *b, double x, double y, double value, double tolerance)
{
    int column = (int)((x + 4) * 4), row = SIDE - 1 - (int)((y + 4) * 4);
    for (int k = 0; k < 3; k++) {
        double seen = (double)b->rgb[3 * (row * SIDE + column) + k];
        if (!(fabs(seen - value) <= tolerance)) {
            print_message("at (%g,%g): %.7f instead of %.7f\n", x, y, seen, value);
            fail();
        }
    }
}

#endif
