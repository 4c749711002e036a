/* piles.c -- many polygons in one place: in one plane, through one pixel, over one another, through one another. */
#include "hostile/cases.h"

#include <gnomon/gnomon_matrix.h>
#include <gnomon/gnomon_pieces.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Triangles of about half the picture's size in the plane z = 0. */
static double *soup(size_t n)
{
    unsigned long long state = 7;
    double *p = malloc(9 * n * sizeof *p);
    for (size_t i = 0; p && i < 3 * n; i++) {
        p[3 * i] = 2 * hostile_random(&state) - 1;
        p[3 * i + 1] = 2 * hostile_random(&state) - 1;
        p[3 * i + 2] = 0;
    }
    return p;
}

/* Squares of equal size over one another, from z = 0 upwards, small: side 2 size. */
static double *pile(size_t n, double size, double tilt)
{
    double *p = malloc(12 * n * sizeof *p);
    for (size_t i = 0; p && i < n; i++) {
        double z = (double)i / (double)n, a = tilt * 3.141592653589793 * z;
        for (int k = 0; k < 4; k++) {
            double x = k == 0 || k == 3 ? -size : size, y = k < 2 ? -size : size;
            p[12 * i + 3 * (size_t)k] = x * cos(a);
            p[12 * i + 3 * (size_t)k + 1] = y;
            p[12 * i + 3 * (size_t)k + 2] = tilt > 0 ? x * sin(a) : z;
        }
    }
    return p;
}

static int glass(hostile_stage *s)
{
    gno_material m = gno_material_default();
    int index = 0;
    m.transmission[0] = m.transmission[1] = m.transmission[2] = 0.999;
    return gno_scene_add_material(s->scene, &m, &index) == GNO_OK ? index : 0;
}

static int draw(double *p, size_t n, size_t corners, int see_through, gno_engine engine, char *outcome, size_t room)
{
    hostile_stage s = hostile_stage_make();
    gno_status status = p ? hostile_add(&s, p, n, corners, see_through ? glass(&s) : 0, -1) : GNO_ERROR_MEMORY;
    int good = status ? hostile_say(&s, status, 0, outcome, room) : hostile_draw(&s, engine, outcome, room);
    free(p);
    hostile_stage_drop(&s);
    return good;
}

static int light(double *p, size_t n, size_t corners, int certify, char *outcome, size_t room)
{
    hostile_stage s = hostile_stage_make();
    gno_lit_def def = gno_lit_def_default();
    gno_lit_summary sum;
    gno_status status = p ? hostile_add(&s, p, n, corners, 0, -1) : GNO_ERROR_MEMORY;
    int good;
    def.certify = certify;
    if (!status)
        status = gno_lit_pieces(s.scene, 0, &def, NULL, NULL, &sum);
    good = status ? hostile_say(&s, status, 0, outcome, room) : sum.area > 0 && sum.area_residual < 1e-6 && sum.flux_residual < 1e-6;
    if (!status)
        snprintf(outcome, room, "area %.4g, lit %.4g, residuals %.1e and %.1e", sum.area, sum.lit_area, sum.area_residual, sum.flux_residual);
    free(p);
    hostile_stage_drop(&s);
    return good;
}

static int see(double *p, size_t n, size_t corners, char *outcome, size_t room)
{
    hostile_stage s = hostile_stage_make();
    gno_pieces *pieces = NULL;
    gno_status status = p ? hostile_add(&s, p, n, corners, 0, -1) : GNO_ERROR_MEMORY;
    int good;
    if (!status)
        status = gno_visible_pieces(s.scene, NULL, &pieces, NULL);
    good = status ? hostile_say(&s, status, 0, outcome, room) : gno_pieces_count(pieces) > 0;
    if (!status)
        snprintf(outcome, room, "%zu pieces", gno_pieces_count(pieces));
    gno_pieces_destroy(pieces);
    free(p);
    hostile_stage_drop(&s);
    return good;
}

int hostile_soup_drawn(size_t n, char *outcome, size_t room) { return draw(soup(n), n, 3, 0, GNO_ENGINE_SCANLINE, outcome, room); }
int hostile_soup_lit(size_t n, char *outcome, size_t room) { return light(soup(n), n, 3, 1, outcome, room); }
int hostile_soup_rows(size_t n, char *outcome, size_t room) { return light(soup(n), n, 3, 0, outcome, room); }
int hostile_soup_pieces(size_t n, char *outcome, size_t room) { return see(soup(n), n, 3, outcome, room); }

#define PIXEL 0.02 /* half of one, more or less */

int hostile_pile_drawn(size_t n, char *outcome, size_t room) { return draw(pile(n, PIXEL, 0), n, 4, 0, GNO_ENGINE_SCANLINE, outcome, room); }

int hostile_pile_painted(size_t n, char *outcome, size_t room)
{
    return draw(pile(n, PIXEL, 0), n, 4, 0, GNO_ENGINE_WEILER_ATHERTON, outcome, room);
}

int hostile_pile_glass(size_t n, char *outcome, size_t room) { return draw(pile(n, PIXEL, 0), n, 4, 1, GNO_ENGINE_SCANLINE, outcome, room); }
int hostile_pile_lit(size_t n, char *outcome, size_t room) { return light(pile(n, PIXEL, 0), n, 4, 1, outcome, room); }
int hostile_pile_crossing(size_t n, char *outcome, size_t room) { return draw(pile(n, PIXEL, 1), n, 4, 0, GNO_ENGINE_SCANLINE, outcome, room); }

int hostile_pile_matrix(size_t n, char *outcome, size_t room)
{
    hostile_stage s = hostile_stage_make();
    gno_matrix_info info;
    gno_matrix *m = NULL;
    double *p = pile(n, 0.5, 0);
    gno_status status = p ? hostile_add(&s, p, n, 4, 0, -1) : GNO_ERROR_MEMORY;
    if (!status)
        status = gno_matrix_build(s.scene, 0, NULL, &m);
    if (!status)
        status = gno_matrix_get_info(m, &info);
    if (status)
        hostile_say(&s, status, 0, outcome, room);
    else
        snprintf(outcome, room, "%zu ones", info.ones);
    gno_matrix_destroy(m);
    free(p);
    hostile_stage_drop(&s);
    return !status && info.ones > n;
}
