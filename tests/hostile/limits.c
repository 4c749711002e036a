/* limits.c -- counts near the limits of integers, sizes of coordinates, lights by the thousand, pictures too large to hold. */
#include "hostile/cases.h"

#include <gnomon/gnomon_clip.h>
#include <gnomon/gnomon_matrix.h>
#include <gnomon/gnomon_path.h>
#include <gnomon/gnomon_pieces.h>
#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- counts ------------------------------------------------------------------------------------------------------------- */

typedef struct tally {
    hostile_stage s;
    int calls, wrong;
    const char *last;
} tally;

/* The call was refused, with a message. */
static void refused(tally *t, const char *call, gno_status status)
{
    const char *message = gno_context_message(t->s.context);
    t->calls++;
    if (status == GNO_OK || status == GNO_ERROR_CANCELLED || message[0] == '\0') {
        t->wrong++;
        t->last = call;
    }
}

static void try_meshes(tally *t)
{
    static const double p[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    static const int corner[3] = {0, 1, 2}, far[3] = {0, 1, INT_MAX}, below[3] = {0, 1, INT_MIN};
    static const unsigned whole[2] = {0, 3}, beyond[2] = {0, UINT_MAX};
    static const size_t counts[] = {SIZE_MAX, SIZE_MAX / 2, SIZE_MAX / 8 + 1, SIZE_MAX / 24 + 1, (size_t)1 << 32, (size_t)UINT_MAX,
                                    (size_t)INT_MAX + 1, (size_t)GNO_MAX_POLYGONS + 1};
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++) {
        for (int which = 0; which < (counts[i] > GNO_MAX_CORNERS ? 6 : 4); which++) { /* normals by the billion may be there */
            gno_mesh_def mesh = gno_mesh_def_default();
            mesh.vertex_count = which == 0 ? counts[i] : 3;
            mesh.positions = p;
            mesh.polygon_count = mesh.ring_count = which == 1 ? counts[i] : 1;
            mesh.ring_count = which == 2 ? counts[i] : mesh.ring_count;
            mesh.corner_count = which == 3 ? counts[i] : 3;
            mesh.normal_count = which == 4 ? counts[i] : 0;
            mesh.normals = which == 4 ? p : NULL;
            mesh.texcoord_count = which == 5 ? counts[i] : 0;
            mesh.texcoords = which == 5 ? p : NULL;
            mesh.ring_start = which == 1 || which == 2 ? NULL : whole;
            mesh.corner_vertex = corner;
            refused(t, "gno_scene_add_mesh", gno_scene_add_mesh(t->s.scene, &mesh, NULL));
        }
    }
    for (int which = 0; which < 5; which++) {
        gno_mesh_def mesh = gno_mesh_def_default();
        mesh.vertex_count = mesh.corner_count = 3;
        mesh.positions = p;
        mesh.polygon_count = mesh.ring_count = 1;
        mesh.ring_start = which == 0 ? beyond : whole;
        mesh.corner_vertex = which == 1 ? far : which == 2 ? below : corner;
        mesh.material = which == 3 ? INT_MAX : 0;
        mesh.detail_of = which == 4 ? INT_MAX : -1;
        refused(t, "gno_scene_add_mesh, an index", gno_scene_add_mesh(t->s.scene, &mesh, NULL));
    }
}

static void try_shapes(tally *t)
{
    static const double points[6] = {0, 0, 1, 0, 0, 1};
    static const size_t start[2] = {0, 3}, falling[2] = {3, 0}, wild[2] = {0, SIZE_MAX};
    gno_clipper *clipper;
    gno_shape result;
    if (gno_clipper_create(t->s.context, &clipper)) {
        t->wrong++;
        return;
    }
    for (int which = 0; which < 5; which++) {
        gno_shape shape = {1, NULL, 1, start, points};
        shape.polygon_count = which == 0 ? SIZE_MAX : 1;
        shape.ring_count = which == 1 ? SIZE_MAX : 1;
        shape.ring_start = which == 2 ? falling : start;
        shape.polygon_start = which == 3 ? falling : which == 4 ? wild : NULL;
        refused(t, "gno_clip", gno_clip(clipper, GNO_CLIP_UNION, &shape, NULL, &result));
    }
    gno_clipper_destroy(clipper);
}

static void try_settings(tally *t)
{
    static const int numbers[] = {INT_MAX, INT_MIN, -1, 1 << 30};
    static const unsigned char byte[4] = {0};
    gno_context *context = t->s.context;
    gno_scene *scene = t->s.scene;
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        gno_image_def image = gno_image_def_default();
        gno_light light = gno_light_default();
        gno_render_def render = gno_render_def_default();
        gno_matrix_def matrix = gno_matrix_def_default();
        gno_lit_def lit = gno_lit_def_default();
        gno_visible_def visible = gno_visible_def_default();
        gno_terrain terrain = gno_terrain_default();
        gno_pixels pixels = {1, 1, 3, NULL, byte, 1};
        gno_matrix *m;
        gno_pieces *pieces;
        float rgb[3];
        image.width = numbers[i];
        refused(t, "gno_scene_set_image", gno_scene_set_image(scene, &image));
        light.type = GNO_LIGHT_AREA;
        light.edge1[0] = light.edge2[1] = 1;
        light.samples = numbers[i];
        refused(t, "gno_scene_add_light", gno_scene_add_light(scene, NULL, &light, NULL));
        render.threads = numbers[i];
        refused(t, "gno_render, threads", gno_render(scene, &render, rgb, NULL));
        render.threads = 1;
        render.lines = numbers[i];
        refused(t, "gno_render, lines", gno_render(scene, &render, rgb, NULL));
        matrix.threads = numbers[i];
        refused(t, "gno_matrix_build, threads", gno_matrix_build(scene, 0, &matrix, &m));
        refused(t, "gno_matrix_build, light", gno_matrix_build(scene, numbers[i], NULL, &m));
        lit.threads = numbers[i];
        refused(t, "gno_lit_pieces, threads", gno_lit_pieces(scene, 0, &lit, NULL, NULL, NULL));
        refused(t, "gno_lit_pieces, light", gno_lit_pieces(scene, (size_t)numbers[i], NULL, NULL, NULL, NULL));
        visible.threads = numbers[i];
        refused(t, "gno_visible_pieces, threads", gno_visible_pieces(scene, &visible, &pieces, NULL));
        terrain.corner_count = (size_t)numbers[i];
        refused(t, "gno_scene_add_terrain, corners", gno_scene_add_terrain(scene, &terrain, NULL, NULL));
        pixels.width = numbers[i];
        refused(t, "gno_scene_add_image, width", gno_scene_add_image(scene, &pixels, NULL));
        pixels.width = 1;
        pixels.channels = numbers[i];
        refused(t, "gno_scene_add_image, channels", gno_scene_add_image(scene, &pixels, NULL));
        refused(t, "gno_scene_set_detail_of", gno_scene_set_detail_of(scene, (size_t)numbers[i], numbers[i]));
    }
    {
        static const size_t start[2] = {0, 0};
        static const unsigned caster[1] = {0};
        double dimension;
        gno_matrix *m;
        refused(t, "gno_matrix_from_columns", gno_matrix_from_columns(context, SIZE_MAX, start, caster, &m));
        refused(t, "gno_matrix_from_columns", gno_matrix_from_columns(context, (size_t)GNO_MAX_POLYGONS + 1, start, caster, &m));
        refused(t, "gno_fractal_dimension", gno_fractal_dimension(context, SIZE_MAX, NULL, 2, 1, 3, &dimension));
    }
}

int hostile_counts(size_t size, char *outcome, size_t room)
{
    tally t = {hostile_stage_make(), 0, 0, ""};
    (void)size;
    try_meshes(&t);
    try_shapes(&t);
    try_settings(&t);
    snprintf(outcome, room, "%d calls refused with a message, %d not%s%s", t.calls - t.wrong, t.wrong, t.wrong ? ": " : "", t.last);
    hostile_stage_drop(&t.s);
    return t.wrong == 0;
}

/* ---- large and small scenes ------------------------------------------------------------------------------------------------ */

#define WIDE 64
#define HIGH 48
#define BLOCKS 12

/* Blocks and roofs on a ground, under a lamp, a sun and a spot: everything in one scale. */
static gno_status build(hostile_stage *s, double scale)
{
    unsigned long long state = 11;
    double p[BLOCKS + 1][4][3];
    gno_camera camera = gno_camera_default();
    gno_light light = gno_light_default();
    gno_status status;
    for (int i = 0; i <= BLOCKS; i++) {
        double x = i ? 4 * hostile_random(&state) - 2 : 0, y = i ? 4 * hostile_random(&state) - 2 : 0, z = i ? hostile_random(&state) : 0;
        double w = i ? 0.6 : 5, slant = i ? hostile_random(&state) - 0.5 : 0;
        for (int k = 0; k < 4; k++) {
            double dx = k == 1 || k == 2 ? w : -w;
            p[i][k][0] = scale * (x + dx);
            p[i][k][1] = scale * (y + (k > 1 ? w : -w));
            p[i][k][2] = scale * (z + slant * dx);
        }
    }
    for (int k = 0; k < 3; k++) {
        camera.eye[k] *= scale;
        camera.target[k] *= scale;
    }
    status = gno_scene_set_camera(s->scene, &camera);
    if (!status)
        status = hostile_add(s, &p[0][0][0], BLOCKS + 1, 4, 0, -1);
    for (int i = 0; i < 2 && !status; i++) {
        light.type = i ? GNO_LIGHT_SPOT : GNO_LIGHT_POINT;
        light.position[0] = (i ? -2 : 1.3) * scale;
        light.position[1] = -1.7 * scale;
        light.position[2] = 4.1 * scale;
        light.direction[0] = 0.5;
        light.direction[1] = 0.4;
        light.direction[2] = -1;
        status = gno_scene_add_light(s->scene, NULL, &light, NULL);
    }
    return status;
}

typedef struct measured {
    float rgb[2][WIDE * HIGH * 3];
    double fraction[3][BLOCKS + 1];
    size_t ones[3];
} measured;

static gno_status measure(double scale, measured *m, hostile_stage *s)
{
    static const gno_engine engines[2] = {GNO_ENGINE_SCANLINE, GNO_ENGINE_WEILER_ATHERTON};
    gno_status status = build(s, scale);
    for (int e = 0; e < 2 && !status; e++) {
        gno_render_def def = gno_render_def_default();
        def.engine = engines[e];
        status = gno_render(s->scene, &def, m->rgb[e], NULL);
    }
    for (int i = 0; i < 3 && !status; i++) {
        gno_lit_row rows[BLOCKS + 1];
        gno_matrix_info info;
        gno_matrix *matrix = NULL;
        status = gno_lit_pieces(s->scene, (size_t)i, NULL, NULL, rows, NULL);
        for (int k = 0; k <= BLOCKS && !status; k++)
            m->fraction[i][k] = rows[k].fraction;
        if (!status)
            status = gno_matrix_build(s->scene, i, NULL, &matrix);
        if (!status)
            status = gno_matrix_get_info(matrix, &info);
        m->ones[i] = status ? 0 : info.ones;
        gno_matrix_destroy(matrix);
    }
    return status;
}

int hostile_scales(size_t size, char *outcome, size_t room)
{
    static const double scales[] = {1, 1e12, 1e-12, 1e6, 1e-6, 1e14, 3e-7};
    static measured m[2];
    double worst = 0, lit = 0;
    int ones = 0;
    (void)size;
    for (size_t i = 0; i < sizeof scales / sizeof scales[0]; i++) {
        hostile_stage s = hostile_stage_make();
        gno_status status = measure(scales[i], &m[i > 0], &s);
        if (status)
            return hostile_say(&s, status, 0, outcome, room);
        for (size_t k = 0; k < 2 * WIDE * HIGH * 3; k++)
            worst = fmax(worst, fabs((double)(&m[0].rgb[0][0])[k] - (double)(&m[i > 0].rgb[0][0])[k]));
        for (size_t k = 0; k < 3 * (BLOCKS + 1); k++)
            lit = fmax(lit, fabs((&m[0].fraction[0][0])[k] - (&m[i > 0].fraction[0][0])[k]));
        ones += memcmp(m[0].ones, m[i > 0].ones, sizeof m[0].ones) != 0;
        hostile_stage_drop(&s);
    }
    snprintf(outcome, room, "pictures differ by %.1e at most, lit fractions by %.1e, %d shadow matrices", worst, lit, ones);
    return worst < 1e-5 && lit < 1e-9 && ones == 0;
}

/* ---- lights ------------------------------------------------------------------------------------------------------------------ */

int hostile_lights(size_t n, char *outcome, size_t room)
{
    hostile_stage s = hostile_stage_make();
    gno_status status = build(&s, 1);
    size_t taken = 0;
    int good;
    for (; taken < n && !status; taken += !status) {
        gno_light light = gno_light_default();
        light.position[0] = 4.0 * (double)(taken % 100) / 100 - 2;
        light.position[1] = 4.0 * (double)(taken / 100) / 100 - 2;
        light.position[2] = 5;
        light.intensity[0] = light.intensity[1] = light.intensity[2] = 1.0 / (double)n;
        status = gno_scene_add_light(s.scene, NULL, &light, NULL);
    }
    good = status ? hostile_say(&s, status, status == GNO_ERROR_LIMIT && taken > 4000, outcome, room)
                  : hostile_draw(&s, GNO_ENGINE_SCANLINE, outcome, room);
    hostile_stage_drop(&s);
    return good;
}

/* ---- pictures ---------------------------------------------------------------------------------------------------------------- */

static int count_rows(void *user, int y, const float *rgb)
{
    int *rows = user;
    (void)y;
    *rows += rgb[0] >= 0;
    return *rows == 100;
}

int hostile_picture(size_t side, char *outcome, size_t room)
{
    hostile_stage s = hostile_stage_make();
    gno_image_def image = gno_scene_image(s.scene);
    gno_status status = build(&s, 1);
    int rows = 0, good;
    image.width = image.height = (int)side;
    if (!status)
        status = gno_scene_set_image(s.scene, &image);
    if (!status)
        status = gno_render_rows(s.scene, NULL, count_rows, &rows, NULL);
    good = rows == 100 && status == GNO_ERROR_CANCELLED;
    snprintf(outcome, room, "%d rows; %s", rows, gno_context_message(s.context));
    hostile_stage_drop(&s);
    return good;
}

int hostile_picture_refused(size_t side, char *outcome, size_t room)
{
    hostile_stage s = hostile_stage_make();
    gno_image_def image = gno_scene_image(s.scene);
    int good;
    image.width = image.height = (int)side;
    good = hostile_say(&s, gno_scene_set_image(s.scene, &image), 1, outcome, room) && strstr(outcome, "65536") != NULL;
    hostile_stage_drop(&s);
    return good;
}
