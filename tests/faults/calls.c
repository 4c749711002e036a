/* calls.c -- see calls.h. */
#include "faults/calls.h"

#include <gnomon/gnomon_clip.h>
#include <gnomon/gnomon_io.h>
#include <gnomon/gnomon_path.h>
#include <gnomon/gnomon_problems.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <support/random_scene.h>

/* ---- the stage -------------------------------------------------------------------------------------------------------------- */

/* Details, glass, lights; a picture on some of it; blobs with and without averaged normals; a plate that is not planar. */
int make_scene(stage *s)
{
    static const double bent[12] = {-1, -1, 2, 1, -1, 2.1, 1, 1, 2, -1, 1, 2.2};
    static const double far_away[3] = {0, 0, 3};
    unsigned char bytes[SIDE * SIDE * 3];
    gno_pixels pixels = {SIDE, SIDE, 3, NULL, bytes, 1};
    gno_material painted = gno_material_default();
    int material, image;
    for (size_t i = 0; i < sizeof bytes; i++) {
        bytes[i] = (unsigned char)(i * 37);
    }
    s->scene = random_scene(s->context, SCENE_MARKED, 2, WIDE, HIGH);
    if (s->scene == NULL || gno_scene_add_image(s->scene, &pixels, &image) != GNO_OK) {
        return 0;
    }
    painted.texture.kind = GNO_TEXTURE_IMAGE;
    painted.texture.image = image;
    painted.texture.map = GNO_MAP_PLANAR;
    return gno_scene_add_material(s->scene, &painted, &material) == GNO_OK && add_polygon(s->scene, (const double(*)[3])bent, 4, material, 0) &&
           add_blob(s->scene, 1, 0.5, 0.1, far_away, material, GNO_SHADING_PHONG);
}

static const char *const names[] = {"fault.png", "fault.exr", "fault.pfm", "fault.mtx", "fault.csv", "fault.obj", "fault.mtl", "fault.geojson",
                                    "fault.svg", "fault.pdf", "fault.yaml", "texture.png", "mesh.obj", "mesh.mtl", "texture.exr", "in.mtx"};

static void put(const char *name, const char *text)
{
    FILE *file = fopen(name, "wb");
    if (file == NULL || fputs(text, file) < 0 || fclose(file) != 0) {
        exit(3);
    }
}

void write_inputs(void)
{
    static const float grey[4 * 4 * 3];
    gno_context *context;
    put("mesh.mtl", "newmtl red\nKd 1 0 0\nmap_Kd texture.png\n");
    put("mesh.obj", "mtllib mesh.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.2\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\n"
                    "f 1/1/1 2/2/1 3/3/1\nf 1/1/1 3/3/1 4/1/1\nf 1 2 3 4\n");
    put("fault.yaml", "gnomon: 1\nimage: {width: 16, height: 12}\n"
                      "camera: {type: perspective, eye: [3, -6, 2], target: [0, 0, 1], up: [0, 0, 1], fov: 40,\n"
                      "         path: {keys: [{frame: 0, eye: [3, -6, 2]}, {frame: 4, eye: [4, -6, 2]}]}}\n"
                      "lights:\n  - {name: sun, type: directional, direction: [-0.4, 0.3, -1]}\n"
                      "  - {type: area, position: [1, 2, 3], edge1: [1, 0, 0], edge2: [0, 2, 0], samples: 2}\n"
                      "materials:\n  tiles: {texture: {image: texture.exr, map: planar}, bump: {image: texture.png, amount: 0.1}}\n"
                      "  oak: {texture: {procedural: wood, light: [1, 1, 0], dark: [0, 0, 0], rings: 3, seed: 1}}\n"
                      "objects:\n  - {mesh: mesh.obj, transform: [{scale: 2}, {translate: [0, 0, 1]}]}\n"
                      "  - {name: wall, polygon: [[0,0,0],[4,0,0],[4,0,3],[0,0,3]], holes: [[[1,0,1],[1,0,2],[2,0,2],[2,0,1]]], material: tiles}\n"
                      "  - {name: sign, polygon: [[1,0,2.2],[2,0,2.2],[2,0,2.6],[1,0,2.6]], detail_of: wall, material: oak}\n"
                      "  - {sphere: {center: [0,0,1], radius: 0.5}, material: oak}\n"
                      "  - {terrain: {corners: [[0,0,0],[1,0,0],[1,1,0],[0,1,0]], levels: 2}}\n");
    put("in.mtx", "%%MatrixMarket matrix coordinate pattern general\n3 3 2\n1 2\n3 3\n");
    if (gno_context_create(NULL, &context) != GNO_OK || gno_picture_write(context, "texture.png", NULL, 4, 4, grey) != GNO_OK ||
        gno_picture_write(context, "texture.exr", NULL, 4, 4, grey) != GNO_OK) {
        exit(3);
    }
    gno_context_destroy(context);
}

void remove_files(void)
{
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        remove(names[i]);
    }
}

/* ---- calls ---------------------------------------------------------------------------------------------------------------------- */

static gno_status scene_create(stage *s)
{
    gno_scene *scene;
    gno_status status = gno_scene_create(s->context, &scene);
    gno_scene_destroy(scene);
    return status;
}

static gno_status add_image(stage *s)
{
    static const unsigned char bytes[SIDE * SIDE * 4];
    gno_pixels pixels = {SIDE, SIDE, 4, NULL, bytes, 1};
    return gno_scene_add_image(s->scene, &pixels, NULL);
}

static gno_status add_material(stage *s)
{
    gno_material m = gno_material_default();
    gno_status status = GNO_OK;
    for (int i = 0; i < 20 && !status; i++) {
        status = gno_scene_add_material(s->scene, &m, NULL);
    }
    return status ? status : gno_scene_set_material_name(s->scene, 1, "a long name for a material of the scene");
}

static gno_status add_light(stage *s)
{
    gno_light light = gno_light_default();
    gno_status status = GNO_OK;
    for (int i = 0; i < 20 && !status; i++) {
        status = gno_scene_add_light(s->scene, "lamp", &light, NULL);
    }
    return status;
}

static gno_status add_mesh(stage *s)
{
    static const double p[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const int corner[3] = {0, 1, 2};
    gno_mesh_def mesh = gno_mesh_def_default();
    gno_status status = GNO_OK;
    mesh.name = "a triangle";
    mesh.vertex_count = mesh.corner_count = 3;
    mesh.positions = p;
    mesh.polygon_count = mesh.ring_count = 1;
    mesh.corner_vertex = corner;
    for (int i = 0; i < 20 && !status; i++) {
        status = gno_scene_add_mesh(s->scene, &mesh, NULL);
    }
    return status;
}

static gno_status add_terrain(stage *s)
{
    static const double square[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    gno_terrain terrain = gno_terrain_default();
    terrain.corner_count = 4;
    terrain.corners = square;
    terrain.levels = 3;
    return gno_scene_add_terrain(s->scene, &terrain, NULL, NULL);
}

static gno_status set_path(stage *s)
{
    gno_camera_path path = gno_camera_path_default();
    gno_camera_key keys[2];
    memset(keys, 0, sizeof keys);
    for (int i = 0; i < 2; i++) {
        gno_camera camera = gno_camera_default();
        keys[i].frame = 10 * i;
        memcpy(keys[i].eye, camera.eye, sizeof camera.eye);
        memcpy(keys[i].target, camera.target, sizeof camera.target);
        memcpy(keys[i].up, camera.up, sizeof camera.up);
        keys[i].fov = 40 + i;
        keys[i].height = 1;
    }
    path.type = GNO_PATH_KEYS;
    path.frames = 11;
    path.key_count = 2;
    path.keys = keys;
    return gno_scene_set_camera_path(s->scene, &path);
}

static gno_status find_details(stage *s)
{
    gno_status status = gno_scene_find_details(s->scene, 1);
    return status ? status : gno_scene_prepare(s->scene, 1, NULL);
}

static gno_status prepare(stage *s) { return gno_scene_prepare(s->scene, 1, NULL); }
static gno_status problems(stage *s) { return gno_scene_find_problems(s->scene, 1, NULL, NULL, NULL); }

static gno_render_def how(gno_engine engine)
{
    gno_render_def def = gno_render_def_default();
    def.threads = 1;
    def.lines = 6;
    def.engine = engine;
    return def;
}

static gno_status render(stage *s)
{
    gno_render_def def = how(GNO_ENGINE_SCANLINE);
    return gno_render(s->scene, &def, s->rgb, NULL);
}

static gno_status paint(stage *s)
{
    gno_render_def def = how(GNO_ENGINE_WEILER_ATHERTON);
    return gno_render(s->scene, &def, s->rgb, NULL);
}

static gno_status render_layers(stage *s)
{
    static float depth[WIDE * HIGH], normal[3 * WIDE * HIGH], coverage[WIDE * HIGH], share[4 * WIDE * HIGH];
    static unsigned id[4 * WIDE * HIGH];
    gno_render_def def = how(GNO_ENGINE_SCANLINE);
    gno_layers layers = gno_layers_default();
    layers.depth = depth;
    layers.normal = normal;
    layers.coverage = coverage;
    layers.polygons.count = 4;
    layers.polygons.id = id;
    layers.polygons.coverage = share;
    def.layers = &layers;
    return gno_render(s->scene, &def, s->rgb, NULL);
}

static int take_row(void *user, int y, const float *rgb)
{
    (void)user;
    (void)y;
    (void)rgb;
    return 0;
}

static gno_status rows(stage *s)
{
    gno_render_def def = how(GNO_ENGINE_SCANLINE);
    return gno_render_rows(s->scene, &def, take_row, NULL, NULL);
}

static gno_status painted_rows(stage *s)
{
    gno_render_def def = how(GNO_ENGINE_WEILER_ATHERTON);
    return gno_render_rows(s->scene, &def, take_row, NULL, NULL);
}

static int take_spans(void *user, const gno_span_line *line)
{
    (void)user;
    (void)line;
    return 0;
}

static gno_status spans(stage *s)
{
    gno_render_def def = how(GNO_ENGINE_SCANLINE);
    return gno_render_spans(s->scene, &def, take_spans, NULL, NULL);
}

static gno_status matrix(stage *s)
{
    gno_matrix_def def = gno_matrix_def_default();
    gno_matrix *m;
    gno_status status;
    def.threads = 1;
    status = gno_matrix_build(s->scene, 0, &def, &m);
    gno_matrix_destroy(m);
    return status;
}

static gno_status matrix_on_demand(stage *s)
{
    gno_matrix_def def = gno_matrix_def_default();
    gno_matrix_column column;
    gno_matrix_info info;
    gno_matrix *m;
    gno_status status;
    def.threads = 1;
    def.on_demand = 1;
    status = gno_matrix_build(s->scene, 0, &def, &m);
    for (size_t i = 0; !status && i < gno_matrix_size(m); i++) {
        status = gno_matrix_get_column(m, i, &column);
    }
    if (!status) {
        status = gno_matrix_get_info(m, &info);
    }
    gno_matrix_destroy(m);
    return status;
}

static gno_status matrix_columns(stage *s)
{
    static const size_t start[4] = {0, 1, 1, 3};
    static const unsigned casters[3] = {2, 0, 1};
    gno_matrix *m;
    gno_status status = gno_matrix_from_columns(s->context, 3, start, casters, &m);
    gno_matrix_destroy(m);
    return status;
}

static gno_status check(stage *s)
{
    gno_matrix_check_result result;
    return gno_matrix_check(s->scene, 0, s->matrix, &result);
}

static gno_status lit(stage *s)
{
    gno_lit_def def = gno_lit_def_default();
    gno_pieces *pieces;
    gno_status status;
    def.threads = 1;
    status = gno_lit_pieces(s->scene, 0, &def, &pieces, s->rows, NULL);
    gno_pieces_destroy(pieces);
    return status;
}

static gno_status visible(stage *s)
{
    gno_visible_def def = gno_visible_def_default();
    gno_pieces *pieces;
    gno_status status;
    def.threads = 1;
    status = gno_visible_pieces(s->scene, &def, &pieces, NULL);
    gno_pieces_destroy(pieces);
    return status;
}

static gno_status visible_of_kept(stage *s)
{
    const gno_pieces *kept[64] = {NULL};
    gno_visible_def def = gno_visible_def_default();
    gno_pieces *pieces;
    gno_status status;
    def.threads = 1;
    def.lit = kept;
    kept[0] = s->pieces;
    status = gno_visible_pieces(s->scene, &def, &pieces, NULL);
    gno_pieces_destroy(pieces);
    return status;
}

static gno_status colours(stage *s)
{
    gno_pieces *pieces = NULL;
    gno_visible_def def = gno_visible_def_default();
    double *rgb;
    gno_status status;
    def.threads = 1;
    status = gno_visible_pieces(s->scene, &def, &pieces, NULL);
    rgb = malloc((3 * gno_pieces_count(pieces) + 1) * sizeof *rgb);
    if (!status && rgb != NULL) {
        status = gno_pieces_colours(s->scene, pieces, 1, rgb);
    }
    free(rgb);
    gno_pieces_destroy(pieces);
    return status;
}

static gno_status dimension(stage *s)
{
    static const double points[15] = {0, 0, 0, 1, 1, 1, 2, 1, 0, 3, 2, 1, 0.5, 3, 3};
    double found;
    return gno_fractal_dimension(s->context, 5, points, 2, 1, 3, &found);
}

static gno_status clip(stage *s)
{
    static const size_t ring[3] = {0, 5, 9};
    static const double points[18] = {0, 0, 4, 3, 0, 3, 4, 0, 2, 5, 1, 1, 3, 1, 3, 2, 1, 2};
    const gno_shape star = {1, NULL, 1, ring, points}, two = {2, NULL, 2, ring, points};
    gno_clipper *clipper;
    gno_shape result;
    gno_status status = gno_clipper_create(s->context, &clipper);
    for (int op = 0; op < 4 && !status; op++) {
        status = gno_clip(clipper, (gno_clip_op)op, &two, &star, &result);
    }
    gno_clipper_destroy(clipper);
    return status;
}

static gno_status load(stage *s, const char *name)
{
    gno_scene *scene;
    gno_status status = gno_scene_load(s->context, name, NULL, 0, &scene);
    gno_scene_destroy(scene);
    return status;
}

static gno_status load_yaml(stage *s) { return load(s, "fault.yaml"); }
static gno_status load_mesh(stage *s) { return load(s, "mesh.obj"); }

static gno_status load_matrix(stage *s)
{
    gno_matrix *m;
    gno_status status = gno_matrix_load(s->context, "in.mtx", &m);
    gno_matrix_destroy(m);
    return status;
}

static gno_status picture(stage *s, const char *name) { return gno_picture_write(s->context, name, NULL, WIDE, HIGH, s->rgb); }
static gno_status picture_png(stage *s) { return picture(s, "fault.png"); }
static gno_status picture_exr(stage *s) { return picture(s, "fault.exr"); }
static gno_status picture_pfm(stage *s) { return picture(s, "fault.pfm"); }

static gno_status picture_layers(stage *s)
{
    static float depth[WIDE * HIGH], share[2 * WIDE * HIGH];
    static unsigned id[2 * WIDE * HIGH];
    gno_layers layers = gno_layers_default();
    layers.depth = depth;
    layers.materials.count = 2;
    layers.materials.id = id;
    layers.materials.coverage = share;
    return gno_picture_write_layers(s->scene, "fault.exr", NULL, s->rgb, &layers);
}

static gno_status matrix_mtx(stage *s) { return gno_matrix_save(s->matrix, "fault.mtx", NULL); }
static gno_status matrix_csv(stage *s) { return gno_matrix_save(s->matrix, "fault.csv", NULL); }
static gno_status matrix_png(stage *s) { return gno_matrix_save(s->matrix, "fault.png", NULL); }

static gno_lit_result result_of(stage *s)
{
    gno_lit_result r = {0, NULL, NULL};
    r.rows = s->rows;
    r.pieces = s->pieces;
    return r;
}

static gno_status lit_table(stage *s)
{
    gno_lit_result r = result_of(s);
    return gno_lit_table_write(s->scene, "fault.csv", &r, 1);
}

static gno_status pieces_obj(stage *s)
{
    gno_lit_result r = result_of(s);
    return gno_pieces_write(s->scene, "fault.obj", &r, 1);
}

static gno_status pieces_geojson(stage *s)
{
    gno_lit_result r = result_of(s);
    return gno_pieces_write(s->scene, "fault.geojson", &r, 1);
}

static gno_status vector_to(stage *s, const char *name)
{
    gno_vector_def def = gno_vector_def_default();
    def.threads = 1;
    def.edges = GNO_EDGES_ALL;
    return gno_vector_write(s->scene, name, &def);
}

static gno_status vector_svg(stage *s) { return vector_to(s, "fault.svg"); }
static gno_status vector_pdf(stage *s) { return vector_to(s, "fault.pdf"); }

const call calls[] = {
    {"gno_scene_create", scene_create, NEEDS_SCENE},
    {"gno_scene_add_image", add_image, NEEDS_SCENE},
    {"gno_scene_add_material and its name", add_material, NEEDS_SCENE},
    {"gno_scene_add_light", add_light, NEEDS_SCENE},
    {"gno_scene_add_mesh", add_mesh, NEEDS_SCENE},
    {"gno_scene_add_terrain", add_terrain, NEEDS_SCENE},
    {"gno_scene_set_camera_path", set_path, NEEDS_SCENE},
    {"gno_scene_prepare", prepare, NEEDS_SCENE},
    {"gno_scene_find_details", find_details, NEEDS_SCENE},
    {"gno_scene_find_problems", problems, NEEDS_SCENE},
    {"gno_render", render, NEEDS_SCENE},
    {"gno_render, Weiler-Atherton", paint, NEEDS_SCENE},
    {"gno_render with layers", render_layers, NEEDS_SCENE},
    {"gno_render_rows", rows, NEEDS_SCENE},
    {"gno_render_rows, Weiler-Atherton", painted_rows, NEEDS_SCENE},
    {"gno_render_spans", spans, NEEDS_SCENE},
    {"gno_matrix_build", matrix, NEEDS_SCENE},
    {"gno_matrix_build on demand, its columns and info", matrix_on_demand, NEEDS_SCENE},
    {"gno_matrix_from_columns", matrix_columns, NEEDS_SCENE},
    {"gno_matrix_check", check, NEEDS_MATRIX},
    {"gno_lit_pieces", lit, NEEDS_SCENE},
    {"gno_visible_pieces", visible, NEEDS_SCENE},
    {"gno_visible_pieces of kept lit pieces", visible_of_kept, NEEDS_PIECES},
    {"gno_pieces_colours", colours, NEEDS_SCENE},
    {"gno_fractal_dimension", dimension, NEEDS_SCENE},
    {"gno_clip", clip, NEEDS_SCENE},
    {"gno_scene_load of YAML with meshes and textures", load_yaml, NEEDS_SCENE},
    {"gno_scene_load of OBJ and MTL", load_mesh, NEEDS_SCENE},
    {"gno_matrix_load", load_matrix, NEEDS_SCENE},
    {"gno_picture_write, PNG", picture_png, NEEDS_SCENE},
    {"gno_picture_write, EXR", picture_exr, NEEDS_SCENE},
    {"gno_picture_write, PFM", picture_pfm, NEEDS_SCENE},
    {"gno_picture_write_layers", picture_layers, NEEDS_SCENE},
    {"gno_matrix_save, MTX", matrix_mtx, NEEDS_MATRIX},
    {"gno_matrix_save, CSV", matrix_csv, NEEDS_MATRIX},
    {"gno_matrix_save, PNG", matrix_png, NEEDS_MATRIX},
    {"gno_lit_table_write", lit_table, NEEDS_PIECES},
    {"gno_pieces_write, OBJ", pieces_obj, NEEDS_PIECES},
    {"gno_pieces_write, GeoJSON", pieces_geojson, NEEDS_PIECES},
    {"gno_vector_write, SVG", vector_svg, NEEDS_SCENE},
    {"gno_vector_write, PDF", vector_pdf, NEEDS_SCENE},
};

const size_t call_count = sizeof calls / sizeof calls[0];
