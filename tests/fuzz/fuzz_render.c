/* fuzz_render.c -- bytes as a scene of triangles and quadrilaterals on a small grid, where planes coincide, polygons cross and touch and
 * lights lie in planes; drawn small by both engines. Values are finite and not negative; one thread gives the bytes of two.
 *
 * Bytes: lights and camera, 8; then four corners a polygon, a byte for material and count. */
#include "fuzz/fuzz.h"

#include <math.h>
#include <string.h>

enum { POLYGONS = 40, WIDTH = 16, HEIGHT = 12, VALUES = 3 * WIDTH * HEIGHT };

static double coordinate(fuzz_bytes *bytes)
{
    return (int)(fuzz_byte(bytes) & 15) - 7;
}

static gno_scene *make_scene(gno_context *context, fuzz_bytes *bytes)
{
    static const double grid[3] = {1, 1e6, 1e-6};
    double p[4 * POLYGONS][3], unit = grid[fuzz_byte(bytes) % 3];
    unsigned ring[POLYGONS + 1] = {0}, corners = 0;
    int corner[4 * POLYGONS], material[POLYGONS], glass = 0, lights = 1 + (int)(fuzz_byte(bytes) % 3);
    gno_mesh_def mesh = gno_mesh_def_default();
    gno_camera camera = gno_camera_default();
    gno_image_def image = gno_image_def_default();
    gno_material m = gno_material_default();
    gno_scene *scene;
    fuzz_expect(gno_scene_create(context, &scene) == GNO_OK, "a scene");
    m.transmission[0] = m.transmission[1] = 0.5;
    m.two_sided = 0;
    m.shading = GNO_SHADING_PHONG;
    fuzz_expect(gno_scene_add_material(scene, &m, &glass) == GNO_OK, "a material");
    for (int i = 0; i < lights; i++) {
        gno_light light = gno_light_default();
        light.type = (gno_light_type)(fuzz_byte(bytes) % 3);
        for (int k = 0; k < 3; k++) {
            light.position[k] = unit * coordinate(bytes);
            light.direction[k] = coordinate(bytes);
        }
        gno_scene_add_light(scene, NULL, &light, NULL);
    }
    for (int k = 0; k < 3; k++) {
        camera.eye[k] = unit * coordinate(bytes);
        camera.target[k] = 0;
    }
    gno_scene_set_camera(scene, &camera);
    image.width = WIDTH;
    image.height = HEIGHT;
    gno_scene_set_image(scene, &image);
    while (bytes->size > 0 && mesh.polygon_count < POLYGONS) {
        unsigned head = fuzz_byte(bytes);
        for (unsigned i = 0; i < 3 + (head & 1); i++, corners++) {
            for (int k = 0; k < 3; k++) {
                p[corners][k] = unit * coordinate(bytes);
            }
            corner[corners] = (int)corners;
        }
        material[mesh.polygon_count++] = head & 2 ? glass : 0;
        ring[mesh.polygon_count] = corners;
    }
    mesh.vertex_count = mesh.corner_count = corners;
    mesh.positions = p[0];
    mesh.ring_count = mesh.polygon_count;
    mesh.ring_start = ring;
    mesh.corner_vertex = corner;
    mesh.polygon_material = material;
    if (mesh.polygon_count > 0) {
        fuzz_expect(gno_scene_add_mesh(scene, &mesh, NULL) == GNO_OK, "a mesh");
    }
    return scene;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    float rgb[2][VALUES];
    fuzz_bytes bytes = {data, size};
    gno_context *context = fuzz_context();
    gno_scene *scene = make_scene(context, &bytes);
    for (int engine = 0; engine < 2; engine++) {
        gno_status status = GNO_OK;
        for (int threads = 1; threads <= 2; threads++) {
            gno_render_def def = gno_render_def_default();
            def.threads = threads;
            def.engine = (gno_engine)engine;
            def.lines = 6;
            status = status == GNO_OK ? gno_render(scene, &def, rgb[threads - 1], NULL) : status;
        }
        if (status != GNO_OK) {
            fuzz_expect(status != GNO_ERROR_CANCELLED && gno_context_message(context)[0] != '\0', "done in time, or a message");
            continue;
        }
        for (int i = 0; i < VALUES; i++) {
            fuzz_expect(isfinite(rgb[0][i]) && rgb[0][i] >= 0, "light");
        }
        fuzz_expect(memcmp(rgb[0], rgb[1], sizeof rgb[0]) == 0, "the same bytes for any number of threads");
    }
    gno_scene_destroy(scene);
    gno_context_destroy(context);
    return 0;
}
