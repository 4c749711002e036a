/* rings.c -- polygons of very many corners, and of very many holes. */
#include "hostile/cases.h"

#include <gnomon/gnomon_clip.h>
#include <gnomon/gnomon_matrix.h>
#include <gnomon/gnomon_pieces.h>
#include <gnomon/gnomon_problems.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* A ring of n corners in a plane: a wave of n/16 humps around the middle; rings of other phases cross it. */
static double *wave(size_t n, double z, double phase)
{
    double *p = malloc(3 * n * sizeof *p);
    for (size_t i = 0; p && i < n; i++) {
        double a = 6.283185307179586 * (double)i / (double)n, r = 0.8 + 0.1 * sin(a * (double)(n / 16) + phase);
        p[3 * i] = r * cos(a);
        p[3 * i + 1] = r * sin(a);
        p[3 * i + 2] = z;
    }
    return p;
}

/* The ring, and a square above it whose shadow falls on a part. */
static gno_status put_ring(hostile_stage *s, size_t n, int shading)
{
    static const double roof[12] = {-0.5, -0.5, 0.5, 0.3, -0.5, 0.5, 0.3, 0.3, 0.5, -0.5, 0.3, 0.5};
    double *p = wave(n, 0, 0);
    gno_status status = p ? hostile_add(s, p, 1, n, 0, shading) : GNO_ERROR_MEMORY;
    free(p);
    return status ? status : hostile_add(s, roof, 1, 4, 0, -1);
}

static int draw(size_t n, int shading, char *outcome, size_t room)
{
    hostile_stage s = hostile_stage_make();
    gno_status status = put_ring(&s, n, shading);
    int good = status ? hostile_say(&s, status, 0, outcome, room) : hostile_draw(&s, GNO_ENGINE_SCANLINE, outcome, room);
    hostile_stage_drop(&s);
    return good;
}

int hostile_ring_drawn(size_t n, char *outcome, size_t room) { return draw(n, GNO_SHADING_FLAT, outcome, room); }
int hostile_ring_smooth(size_t n, char *outcome, size_t room) { return draw(n, GNO_SHADING_PHONG, outcome, room); }

int hostile_ring_lit(size_t n, char *outcome, size_t room)
{
    hostile_stage s = hostile_stage_make();
    gno_lit_summary sum;
    gno_status status = put_ring(&s, n, -1);
    int good;
    if (!status)
        status = gno_lit_pieces(s.scene, 0, NULL, NULL, NULL, &sum);
    good = status ? hostile_say(&s, status, 0, outcome, room) : fabs(sum.lit_area - (sum.area - 0.64)) < 1e-6;
    if (!status)
        snprintf(outcome, room, "area %.6g, lit %.6g, residuals %.1e and %.1e", sum.area, sum.lit_area, sum.area_residual, sum.flux_residual);
    hostile_stage_drop(&s);
    return good;
}

int hostile_ring_pieces(size_t n, char *outcome, size_t room)
{
    hostile_stage s = hostile_stage_make();
    gno_pieces *pieces = NULL;
    gno_status status = put_ring(&s, n, -1);
    int good;
    if (!status)
        status = gno_visible_pieces(s.scene, NULL, &pieces, NULL);
    good = status ? hostile_say(&s, status, 0, outcome, room) : gno_pieces_count(pieces) >= 3;
    if (!status)
        snprintf(outcome, room, "%zu pieces", gno_pieces_count(pieces));
    gno_pieces_destroy(pieces);
    hostile_stage_drop(&s);
    return good;
}

int hostile_ring_matrix(size_t n, char *outcome, size_t room)
{
    hostile_stage s = hostile_stage_make();
    gno_matrix_check_result check;
    gno_matrix_info info;
    gno_matrix *m = NULL;
    size_t problems[GNO_PROBLEM_KINDS] = {0};
    gno_status status = put_ring(&s, n, -1);
    int good;
    if (!status)
        status = gno_matrix_build(s.scene, 0, NULL, &m);
    if (!status)
        status = gno_matrix_get_info(m, &info);
    if (!status)
        status = gno_matrix_check(s.scene, 0, m, &check);
    if (!status)
        status = gno_scene_find_problems(s.scene, 0, NULL, NULL, problems);
    good = status ? hostile_say(&s, status, 0, outcome, room) : info.ones >= 1 && problems[GNO_PROBLEM_OPEN_EDGE] == n + 4;
    if (!status)
        snprintf(outcome, room, "%zu ones, %zu open edges", info.ones, problems[GNO_PROBLEM_OPEN_EDGE]);
    gno_matrix_destroy(m);
    hostile_stage_drop(&s);
    return good;
}

int hostile_ring_clipped(size_t n, char *outcome, size_t room)
{
    hostile_stage s = hostile_stage_make();
    gno_clipper *clipper = NULL;
    size_t start[2];
    double *p[2] = {wave(n, 0, 0), wave(n, 0, 1.7)}, area[2] = {0, 0};
    gno_shape shape[2], result;
    gno_status status = p[0] && p[1] ? gno_clipper_create(s.context, &clipper) : GNO_ERROR_MEMORY;
    int good;
    start[0] = 0;
    start[1] = n;
    for (int k = 0; k < 2 && !status; k++) {
        for (size_t i = 0; i < n; i++) {
            p[k][2 * i] = p[k][3 * i];
            p[k][2 * i + 1] = p[k][3 * i + 1];
        }
        shape[k].polygon_count = shape[k].ring_count = 1;
        shape[k].polygon_start = NULL;
        shape[k].ring_start = start;
        shape[k].points = p[k];
    }
    for (int k = 0; k < 2 && !status; k++) {
        status = gno_clip(clipper, k ? GNO_CLIP_UNION : GNO_CLIP_INTERSECTION, &shape[0], &shape[1], &result);
        area[k] = gno_shape_area(&result);
    }
    good = status ? hostile_say(&s, status, 0, outcome, room)
                  : fabs(area[0] + area[1] - gno_shape_area(&shape[0]) - gno_shape_area(&shape[1])) < 1e-8 && area[1] > area[0];
    if (!status)
        snprintf(outcome, room, "in common %.6g, together %.6g", area[0], area[1]);
    gno_clipper_destroy(clipper);
    free(p[0]);
    free(p[1]);
    hostile_stage_drop(&s);
    return good;
}

/* A plate with square holes in rows. */
int hostile_holes(size_t holes, char *outcome, size_t room)
{
    hostile_stage s = hostile_stage_make();
    size_t side = (size_t)ceil(sqrt((double)holes)), corners = 4 * (holes + 1);
    gno_mesh_def mesh = gno_mesh_def_default();
    double *p = malloc(3 * corners * sizeof *p), step = 1.8 / (double)side;
    unsigned *ring = malloc((holes + 2) * sizeof *ring), polygon[2];
    int *corner = malloc(corners * sizeof *corner), good = 0;
    gno_lit_summary sum;
    gno_status status = p && ring && corner ? GNO_OK : GNO_ERROR_MEMORY;
    for (size_t r = 0; r <= holes && !status; r++) {
        double x = r ? -0.9 + step * (double)((r - 1) % side) : -1, y = r ? -0.9 + step * (double)((r - 1) / side) : -1, w = r ? step / 2 : 2;
        for (size_t k = 0; k < 4; k++) {
            p[12 * r + 3 * k] = x + (k == 1 || k == 2 ? w : 0);
            p[12 * r + 3 * k + 1] = y + (k > 1 ? w : 0);
            p[12 * r + 3 * k + 2] = 0;
            corner[4 * r + k] = (int)(4 * r + k);
        }
        ring[r] = (unsigned)(4 * r);
    }
    polygon[0] = 0;
    polygon[1] = (unsigned)(holes + 1);
    if (!status) {
        ring[holes + 1] = (unsigned)corners;
        mesh.vertex_count = mesh.corner_count = corners;
        mesh.positions = p;
        mesh.polygon_count = 1;
        mesh.polygon_start = polygon;
        mesh.ring_count = holes + 1;
        mesh.ring_start = ring;
        mesh.corner_vertex = corner;
        mesh.shading = GNO_SHADING_FLAT;
        status = gno_scene_add_mesh(s.scene, &mesh, NULL);
    }
    if (!status)
        status = gno_lit_pieces(s.scene, 0, NULL, NULL, NULL, &sum);
    if (status)
        hostile_say(&s, status, 0, outcome, room);
    else
        good = hostile_draw(&s, GNO_ENGINE_SCANLINE, outcome, room) && fabs(sum.lit_area - 4 + (double)holes * step * step / 4) < 1e-6;
    free(p);
    free(ring);
    free(corner);
    hostile_stage_drop(&s);
    return good;
}
