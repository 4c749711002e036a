/* test_mesh_files.c -- PLY, STL, OFF, Collada and glTF through assimp: polygons, transforms, materials, camera, lights. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#include "mesh_test.h"
#include <math.h>

/* ---- STL ---------------------------------------------------------------------------------------------------- */

/* A unit tetrahedron's corners and triangles. */
static const float tetra_points[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
static const int tetra_faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

static void check_tetra(const bed *b)
{
    gno_scene_counts n = gno_scene_count(b->scene);
    assert_int_equal(n.polygons, 4);
    assert_int_equal(n.corners, 12);
    assert_int_equal(n.vertices, 4); /* equal corners have become one vertex */
    assert_int_equal(n.normals, 0);  /* those of the triangles are no vertex normals */
    assert_int_equal(n.materials, 1);
    for (size_t f = 0; f < 4; f++) {
        gno_polygon p = polygon_at(b, f);
        for (unsigned i = 0; i < 3; i++) {
            const float *q = tetra_points[tetra_faces[f][i]];
            check_vector(corner_at(&p, i), (double)q[0], (double)q[1], (double)q[2], 0);
        }
    }
}

static void test_ascii_stl(void **state)
{
    bed *b = *state;
    char text[2048];
    size_t used = (size_t)sprintf(text, "solid tetra\n");
    for (int f = 0; f < 4; f++) {
        used += (size_t)sprintf(text + used, " facet normal 0 0 1\n  outer loop\n");
        for (int i = 0; i < 3; i++) {
            const float *q = tetra_points[tetra_faces[f][i]];
            used += (size_t)sprintf(text + used, "   vertex %g %g %g\n", (double)q[0], (double)q[1], (double)q[2]);
        }
        used += (size_t)sprintf(text + used, "  endloop\n endfacet\n");
    }
    sprintf(text + used, "endsolid tetra\n");
    write_text(b, "a.stl", text);
    load_good(b, "a.stl", NULL);
    check_tetra(b);
}

static void test_binary_stl(void **state)
{
    bed *b = *state;
    unsigned char bytes[84 + 4 * 50] = {0};
    uint32_t count = 4;
    memcpy(bytes + 80, &count, 4); /* little endian, as the machines this runs on */
    for (size_t f = 0; f < 4; f++)
        for (size_t i = 0; i < 3; i++)
            memcpy(bytes + 84 + 50 * f + 12 + 12 * i, tetra_points[tetra_faces[f][i]], 12);
    write_bytes(b, "a.STL", bytes, sizeof bytes);
    load_good(b, "a.STL", NULL);
    check_tetra(b);
    write_bytes(b, "a.STL", bytes, 40);
    assert_int_equal(load_file(b, "a.STL", NULL), GNO_ERROR_INPUT);
    assert_ptr_equal(strstr(gno_context_message(b->context), path_of(b, "a.STL: ")), gno_context_message(b->context));
}

/* ---- PLY and OFF -------------------------------------------------------------------------------------------- */

static void test_ply(void **state)
{
    bed *b = *state;
    write_text(b, "a.ply", "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
                           "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 3\n"
                           "property list uchar int vertex_indices\nend_header\n"
                           "0 0 0 1 2 3\n1 0 0 1 2 3\n1.5 1 0 1 2 3\n0.5 2 0 1 2 3\n-0.5 1 0 1 2 3\n7 7 7 0 0 0\n"
                           "5 0 1 2 3 4\n4 0 1 2 4\n3 4 2 0\n");
    load_good(b, "a.ply", NULL);
    gno_scene_counts n = gno_scene_count(b->scene);
    assert_int_equal(n.vertices, 6);
    assert_int_equal(n.polygons, 3);
    assert_int_equal(n.corners, 12);
    gno_polygon p = polygon_at(b, 0);
    assert_int_equal(corner_count(&p), 5);
    check_vector(corner_at(&p, 3), 0.5, 2, 0, 0);
    p = polygon_at(b, 2);
    assert_int_equal(p.material, 0); /* the file says nothing of materials: not assimp's, but the default one */
    assert_int_equal(p.corner_vertex[p.ring_start[0]], 4);
}

static void test_ply_with_normals(void **state)
{
    bed *b = *state;
    write_text(b, "a.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                           "property float nx\nproperty float ny\nproperty float nz\nelement face 2\n"
                           "property list uchar int vertex_indices\nend_header\n"
                           "0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 1 1\n1 1 0 0 0 0\n3 0 1 2\n3 1 3 2\n");
    load_good(b, "a.ply", NULL);
    gno_polygon p = polygon_at(b, 1);
    unsigned c = p.ring_start[0];
    assert_int_equal(p.corner_normal[c], 1);
    assert_int_equal(p.corner_normal[c + 1], -1); /* a zero normal is none */
    check_vector(p.normals + 3 * (size_t)p.corner_normal[c + 2], 0, 1, 1, 0);
}

static void test_off(void **state)
{
    bed *b = *state;
    gnoi_mesh_options options = gnoi_mesh_options_default();
    write_text(b, "a.off", "OFF\n5 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n4 0 1 2 3\n3 0 1 4\n");
    options.name = "given";
    options.shading = GNO_SHADING_GOURAUD;
    options.priority = 2;
    load_good(b, "a.off", &options);
    gno_polygon p = polygon_at(b, 0);
    assert_int_equal(corner_count(&p), 4);
    assert_int_equal(p.shading, GNO_SHADING_GOURAUD);
    assert_int_equal(p.priority, 2);
}

/* ---- glTF --------------------------------------------------------------------------------------------------- */

/* One triangle (0,0,0) (1,0,0) (0,1,0) with normals (0,0,1), twice: moved by (10,0,0) and doubled, and turned a quarter
 * about x. A camera at (0,0,5), a point light at (0,4,0), a spot light at (0,0,8), a sun. */
static const char gltf[] =
    "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"KHR_lights_punctual\"],"
    "\"scene\":0,\"scenes\":[{\"nodes\":[0,1,2,3,4,5]}],\n"
    "\"nodes\":[{\"mesh\":0,\"translation\":[10,0,0],\"scale\":[2,2,2]},"
    "{\"mesh\":0,\"rotation\":[0.70710678,0,0,0.70710678]},{\"camera\":0,\"translation\":[0,0,5]},"
    "{\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}},\"translation\":[0,4,0],\"name\":\"bulb\"},"
    "{\"extensions\":{\"KHR_lights_punctual\":{\"light\":1}},\"translation\":[0,0,8],\"name\":\"spot\"},"
    "{\"extensions\":{\"KHR_lights_punctual\":{\"light\":2}},\"rotation\":[-0.70710678,0,0,0.70710678],\"name\":\"sun\"}],\n"
    "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":0.7,\"aspectRatio\":1.5,\"znear\":0.1}}],\n"
    "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"point\",\"intensity\":100,\"color\":[1,0.5,0.25]},"
    "{\"type\":\"spot\",\"intensity\":50,\"spot\":{\"innerConeAngle\":0.2,\"outerConeAngle\":0.5}},"
    "{\"type\":\"directional\",\"intensity\":0.5}]}},\n"
    "\"materials\":[{\"name\":\"paint\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.25,0.5,0.75,0.5],\"metallicFactor\":0,"
    "\"roughnessFactor\":0.5},\"alphaMode\":\"%s\"}],\n"
    "\"meshes\":[{\"name\":\"flag\",\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1},\"material\":0},"
    "{\"attributes\":{\"POSITION\":0},\"mode\":1}]}],\n"
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,0]},"
    "{\"bufferView\":0,\"byteOffset\":36,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],\n"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":72}],\"buffers\":[{\"byteLength\":72,"
    "\"uri\":\"data:application/octet-stream;base64,"
    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/\"}]}\n";

static void write_gltf(bed *b, const char *alpha_mode)
{
    char text[sizeof gltf + 16];
    snprintf(text, sizeof text, gltf, alpha_mode);
    write_text(b, "a.gltf", text);
}

static void test_gltf_meshes(void **state)
{
    bed *b = *state;
    gnoi_mesh_options options = gnoi_mesh_options_default();
    options.transform[11] = 100; /* up */
    write_gltf(b, "BLEND");
    load_good(b, "a.gltf", &options);
    assert_int_equal(gno_scene_count(b->scene).polygons, 2); /* the lines are left out */
    assert_int_equal(gno_scene_count(b->scene).objects, 2);
    assert_int_equal(gno_scene_count(b->scene).lights, 0); /* not asked for */
    assert_int_equal(b->result.has_camera, 0);
    assert_int_equal(b->result.polygon_count, 2);
    gno_polygon p = polygon_at(b, 0);
    check_vector(corner_at(&p, 0), 10, 0, 100, 0);
    check_vector(corner_at(&p, 1), 12, 0, 100, 0);
    check_vector(corner_at(&p, 2), 10, 2, 100, 0);
    p = polygon_at(b, 1);
    check_vector(corner_at(&p, 2), 0, 0, 101, 1e-6);
    const double *n = p.normals + 3 * (size_t)p.corner_normal[p.ring_start[0]];
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    check_near(n[1] / length, -1, 1e-6);
}

static void test_gltf_materials(void **state)
{
    bed *b = *state;
    write_gltf(b, "BLEND");
    load_good(b, "a.gltf", NULL);
    gno_material m = material_of(b, 0);
    check_vector(m.diffuse, 0.25, 0.5, 0.75, 0);
    check_vector(m.ambient, 0.25, 0.5, 0.75, 0);
    check_vector(m.specular, 0.125, 0.125, 0.125, 1e-7); /* 0.5 (1 - 0.5)^2 */
    check_near(m.shininess, 30, 1e-5);                   /* 2/0.5^4 - 2 */
    check_vector(m.transmission, 0.5, 0.5, 0.5, 0);
    assert_int_equal(m.two_sided, 1);
    write_gltf(b, "OPAQUE");
    load_good(b, "a.gltf", NULL);
    m = material_of(b, 0);
    check_vector(m.transmission, 0, 0, 0, 0);
}

static void test_gltf_camera_and_lights(void **state)
{
    bed *b = *state;
    gnoi_mesh_options options = gnoi_mesh_options_default();
    options.take_camera = options.take_lights = 1;
    write_gltf(b, "OPAQUE");
    load_good(b, "a.gltf", &options);
    assert_int_equal(b->result.has_camera, 1);
    assert_int_equal(b->result.light_count, 3);
    gno_camera camera = gno_scene_camera(b->scene);
    check_vector(camera.eye, 0, 0, 5, 0);
    check_near(camera.target[0], 0, 1e-6);
    check_near(camera.target[1], 0, 1e-6);
    assert_true(camera.target[2] < 4);
    check_vector(camera.up, 0, 1, 0, 1e-6);
    check_near(camera.fov, 0.7 * 57.29577951308232, 1e-4);

    gno_light bulb, spot, sun;
    const char *name;
    assert_int_equal(gno_scene_light(b->scene, 0, &bulb, &name), GNO_OK);
    assert_string_equal(name, "bulb");
    assert_int_equal(bulb.type, GNO_LIGHT_POINT);
    assert_int_equal(bulb.falloff, GNO_FALLOFF_INVERSE_SQUARE);
    check_vector(bulb.position, 0, 4, 0, 0);
    assert_int_equal(gno_scene_light(b->scene, 1, &spot, &name), GNO_OK);
    assert_int_equal(spot.type, GNO_LIGHT_SPOT);
    check_vector(spot.direction, 0, 0, -1, 1e-6);
    check_near(spot.angle, 57.29577951308232, 1e-4); /* twice 0.5 */
    assert_int_equal(gno_scene_light(b->scene, 2, &sun, &name), GNO_OK);
    assert_int_equal(sun.type, GNO_LIGHT_DIRECTIONAL);
    assert_int_equal(sun.falloff, GNO_FALLOFF_NONE);
    check_vector(sun.direction, 0, -1, 0, 1e-6);

    /* one factor for all; bounds 0..12, 0..2, 0..1: the bulb is the brightest at (6,1,0.5), 100 / 45.25, the sun gives 0.5 */
    double factor = 45.25 / 100;
    check_vector(bulb.intensity, 100 * factor, 50 * factor, 25 * factor, 1e-5);
    check_vector(spot.intensity, 50 * factor, 50 * factor, 50 * factor, 1e-5);
    check_vector(sun.intensity, 0.5 * factor, 0.5 * factor, 0.5 * factor, 1e-6);
}

/* The transform of the options moves camera and lights too. */
static void test_gltf_view_transformed(void **state)
{
    bed *b = *state;
    gnoi_mesh_options options = gnoi_mesh_options_default();
    static const double y_up_to_z_up[12] = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0};
    memcpy(options.transform, y_up_to_z_up, sizeof y_up_to_z_up);
    options.take_camera = options.take_lights = 1;
    write_gltf(b, "OPAQUE");
    load_good(b, "a.gltf", &options);
    gno_camera camera = gno_scene_camera(b->scene);
    gno_light bulb;
    check_vector(camera.eye, 0, -5, 0, 0);
    check_vector(camera.up, 0, 0, 1, 1e-6);
    assert_int_equal(gno_scene_light(b->scene, 0, &bulb, NULL), GNO_OK);
    check_vector(bulb.position, 0, 0, 4, 0);
}

/* ---- others ------------------------------------------------------------------------------------------------- */

/* Collada gives every corner a vertex of its own, with a classical material. */
static void test_collada(void **state)
{
    bed *b = *state;
    write_text(b, "a.dae",
               "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">"
               "<asset><up_axis>Y_UP</up_axis></asset>"
               "<library_effects><effect id=\"e\"><profile_COMMON><technique sid=\"t\"><phong><diffuse><color>0.2 0.4 0.6 1</color>"
               "</diffuse><specular><color>0.5 0.5 0.5 1</color></specular><shininess><float>12</float></shininess></phong>"
               "</technique></profile_COMMON></effect></library_effects>"
               "<library_materials><material id=\"m\"><instance_effect url=\"#e\"/></material></library_materials>"
               "<library_geometries><geometry id=\"g\"><mesh><source id=\"p\"><float_array id=\"pa\" count=\"12\">"
               "0 0 0 1 0 0 1 1 0 0 1 0</float_array><technique_common><accessor source=\"#pa\" count=\"4\" stride=\"3\">"
               "<param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/></accessor>"
               "</technique_common></source><vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices>"
               "<polylist count=\"2\" material=\"s\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><vcount>4 3</vcount>"
               "<p>0 1 2 3 0 1 2</p></polylist></mesh></geometry></library_geometries>"
               "<library_visual_scenes><visual_scene id=\"vs\"><node id=\"n\"><instance_geometry url=\"#g\"><bind_material>"
               "<technique_common><instance_material symbol=\"s\" target=\"#m\"/></technique_common></bind_material>"
               "</instance_geometry></node></visual_scene></library_visual_scenes>"
               "<scene><instance_visual_scene url=\"#vs\"/></scene></COLLADA>");
    load_good(b, "a.dae", NULL);
    gno_scene_counts n = gno_scene_count(b->scene);
    assert_int_equal(n.polygons, 2);
    assert_int_equal(n.corners, 7);
    assert_int_equal(n.vertices, 4);
    gno_material m = material_of(b, 0);
    check_vector(m.diffuse, 0.2, 0.4, 0.6, 1e-7);
    check_vector(m.ambient, 0.2, 0.4, 0.6, 1e-7);
    check_vector(m.specular, 0.5, 0.5, 0.5, 1e-7);
    check_near(m.shininess, 12, 1e-5);
}

static void test_error_messages(void **state)
{
    bed *b = *state;
    load_bad(b, "none.ply", GNO_ERROR_FILE, "none.ply: cannot open: No such file or directory");
    load_bad(b, "none", GNO_ERROR_FILE, "none: not a mesh format by its extension (.obj .ply .stl .gltf .glb and others)");
    load_bad(b, "a.nope", GNO_ERROR_FILE, "a.nope: not a mesh format by its extension (.obj .ply .stl .gltf .glb and others)");
    write_text(b, "a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
                           "end_header\n0 0 0\n");
    assert_int_equal(load_file(b, "a.ply", NULL), GNO_ERROR_INPUT);
    assert_ptr_equal(strstr(gno_context_message(b->context), path_of(b, "a.ply: ")), gno_context_message(b->context));
    static const char *const bad[][2] = {
        {"", "a.ply: the header's end_header is missing"},
        {"plx\n", "a.ply:1: not a PLY file: \"ply\" is expected"},
        {"ply\nformat ascii 1.0\nelement vertex 3\n", "a.ply: the header's end_header is missing"},
        {"ply\nformat ascii 1.0\nelement vertex 1e9\n", "a.ply:3: element: 1000000000 of them do not fit a file of 40 bytes"},
        {"ply\nformat ascii 1.0\r\nelement vertex\n", "a.ply:3: element: a name and a count are expected"},
        {"ply\nformat ascii 1.0\n\nend_heade\n", "a.ply:4: no line of a PLY header"}};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        write_text(b, "a.ply", bad[i][0]);
        load_bad(b, "a.ply", GNO_ERROR_INPUT, bad[i][1]);
    }
    write_text(b, "a.gltf", "{\"asset\":{\"version\":\"2.0\"},");
    assert_int_equal(load_file(b, "a.gltf", NULL), GNO_ERROR_INPUT);
    assert_ptr_equal(strstr(gno_context_message(b->context), path_of(b, "a.gltf: ")), gno_context_message(b->context));
}

/* assimp's own memory is not the context's; ours is. */
static void test_every_allocation_fails(void **state)
{
    bed *b = *state;
    write_gltf(b, "BLEND");
    assert_true(fail_every_allocation(path_of(b, "a.gltf")) > 10);
    write_text(b, "a.off", "OFF\n5 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n4 0 1 2 3\n3 0 1 4\n");
    assert_true(fail_every_allocation(path_of(b, "a.off")) > 5);
}

/* ---- real files --------------------------------------------------------------------------------------------- */

static void test_real_files(void **state)
{
    static const struct {
        const char *name;
        size_t polygons, vertices; /* vertices 0: joined here, the table counts otherwise */
        int lights, camera;
    } files[] = {{"scenes/bunny/bun_zipper.ply", 69451, 35947, 0, 0},
                 {"scenes/dragon/dragon_vrip_res3.ply", 47794, 22998, 0, 0},
                 {"scenes/misc/cycloidal.ply", 43368, 21384, 0, 0},
                 {"scenes/misc/featuretype.STL", 3476, 0, 0, 0},
                 {"scenes/misc/two_objects_ascii.stl", 24, 16, 0, 0},
                 {"scenes/gltf_Duck/Duck.gltf", 4212, 2399, 0, 1},
                 {"scenes/gltf_LightsPunctualLamp/LightsPunctualLamp.gltf", 6000, 4555, 5, 0}};
    bed *b = *state;
    gnoi_mesh_options options = gnoi_mesh_options_default();
    options.take_camera = options.take_lights = 1;
    if (!data_file(files[0].name)) {
        printf("SKIP test_real_files: no %s under GNOMON_DATA or ../shared/data\n", files[0].name);
        skip();
    }
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        end_scene(b);
        start_scene(b);
        const char *path = data_file(files[i].name);
        assert_non_null(path);
        if (gnoi_mesh_load(b->scene, path, &options, &b->result) != GNO_OK) fail_msg("%s", gno_context_message(b->context));
        assert_int_equal(gno_scene_count(b->scene).polygons, files[i].polygons);
        if (files[i].vertices) assert_int_equal(gno_scene_count(b->scene).vertices, files[i].vertices);
        assert_int_equal(b->result.light_count, files[i].lights);
        assert_int_equal(b->result.has_camera, files[i].camera);
    }
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_ascii_stl),
        TEST(test_binary_stl),
        TEST(test_ply),
        TEST(test_ply_with_normals),
        TEST(test_off),
        TEST(test_gltf_meshes),
        TEST(test_gltf_materials),
        TEST(test_gltf_camera_and_lights),
        TEST(test_gltf_view_transformed),
        TEST(test_collada),
        TEST(test_error_messages),
        TEST(test_every_allocation_fails),
        TEST(test_real_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
