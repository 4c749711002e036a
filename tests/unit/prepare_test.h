/* prepare_test.h -- scenes to prepare, and what every prepared scene promises. For inclusion after cmocka.h. */
#ifndef PREPARE_TEST_H
#define PREPARE_TEST_H

#include "fail_alloc.h"
#include "scene/prepare.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define PI 3.14159265358979323846
#define MOST 12000 /* corners of a test polygon */

typedef struct bed {
    gno_context *context;
    gno_scene *scene;
    int warnings;
    char warning[1024];
} bed;

static inline void keep_warning(void *user, gno_log_level level, const char *text)
{
    bed *b = user;
    (void)level;
    b->warnings++;
    snprintf(b->warning, sizeof b->warning, "%s", text);
}

static inline int set_up(void **state)
{
    bed *b = calloc(1, sizeof *b);
    gno_context_def def = gno_context_def_default();
    if (!b) {
        return 1;
    }
    def.log = keep_warning;
    def.log_user = b;
    *state = b;
    return gno_context_create(&def, &b->context) != GNO_OK || gno_scene_create(b->context, &b->scene) != GNO_OK;
}

static inline int tear_down(void **state)
{
    bed *b = *state;
    gno_scene_destroy(b->scene);
    if (gno_context_memory(b->context, NULL) > 4096) { /* what is left is the context itself */
        return 1;
    }
    gno_context_destroy(b->context);
    free(b);
    return 0;
}

static inline uint64_t random_bits(uint64_t *seed)
{
    *seed ^= *seed << 13;
    *seed ^= *seed >> 7;
    *seed ^= *seed << 17;
    return *seed;
}

static inline double random_unit(uint64_t *seed)
{
    return (double)(random_bits(seed) >> 11) / 9007199254740992.0;
}

/* ---- scenes to prepare ------------------------------------------------------------------------------------------- */

/* Adds one polygon of the rings given by sizes (0 ends them), its corners in order. */
static inline void add_polygon(bed *b, const double *positions, const unsigned *sizes, int shading)
{
    static int corners[MOST];
    static unsigned rings[MOST], polygons[2];
    gno_mesh_def mesh = gno_mesh_def_default();
    unsigned i, count = 0;
    for (i = 0; sizes[i] > 0; i++) {
        rings[i] = count;
        count += sizes[i];
    }
    rings[i] = count;
    polygons[0] = 0;
    polygons[1] = i;
    mesh.ring_count = i;
    for (i = 0; i < count; i++) {
        corners[i] = (int)i;
    }
    mesh.vertex_count = mesh.corner_count = count;
    mesh.positions = positions;
    mesh.polygon_count = 1;
    mesh.polygon_start = polygons;
    mesh.ring_start = rings;
    mesh.corner_vertex = corners;
    mesh.shading = shading;
    assert_int_equal(gno_scene_add_mesh(b->scene, &mesh, NULL), GNO_OK);
}

static inline const gnoi_prepared *prepare(bed *b, size_t degenerate, size_t non_planar)
{
    gno_scene_problems problems = {99, 99, 99};
    assert_int_equal(gno_scene_prepare(b->scene, 1, &problems), GNO_OK);
    assert_int_equal(problems.degenerate, degenerate);
    assert_int_equal(problems.non_planar, non_planar);
    return &b->scene->prepared;
}

static inline void assert_near(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance)) {
        fail_msg("%.17g is not within %g of %.17g", a, tolerance, b);
    }
}

/* What every prepared scene promises. */
static inline void check_invariants(const gno_scene *scene)
{
    const gnoi_prepared *p = &scene->prepared;
    size_t i, k;
    assert_true(sizeof(gnoi_poly) == 64);
    assert_int_equal(p->ring_corner[p->ring_count], p->corner_count);
    for (i = 0; i < p->poly_count; i++) {
        const gnoi_poly *poly = &p->polys[i];
        assert_near(v3_length(v3_from(poly->n)), 1, 1e-12);
        assert_true(poly->ring + poly->ring_count <= p->ring_count);
        assert_int_equal(poly->corner, p->ring_corner[poly->ring]);
        assert_int_equal(poly->corner_count, p->ring_corner[poly->ring + poly->ring_count] - poly->corner);
        assert_true(poly->source < scene->polygon_count);
        assert_int_equal(poly->triangle == GNOI_NONE, !(gnoi_is_smooth(poly) && poly->corner_count > 3));
        for (k = poly->corner; k < (size_t)poly->corner + poly->corner_count; k++) {
            assert_true(p->corner_vertex[k] < p->vertex_count);
            if (p->corner_normal && gnoi_is_smooth(poly)) {
                const float *n = p->normals[p->corner_normal[k]];
                assert_true(p->corner_normal[k] < p->normal_count);
                assert_near(sqrt((double)n[0] * n[0] + (double)n[1] * n[1] + (double)n[2] * n[2]), 1, 1e-6);
            } else if (p->corner_normal) {
                assert_int_equal(p->corner_normal[k], GNOI_NONE);
            }
        }
    }
}

/* ---- shapes ------------------------------------------------------------------------------------------------------ */

/* A ring that turns once around (x,y), radii in [least,most]; counter-clockwise or not. */
static inline void star(double *out, unsigned count, double x, double y, double least, double most, int turn, uint64_t *seed)
{
    unsigned i;
    for (i = 0; i < count; i++) {
        double angle = turn * 2 * PI * (i + 0.8 * random_unit(seed)) / count;
        double radius = least + (most - least) * random_unit(seed);
        out[3 * i] = x + radius * cos(angle);
        out[3 * i + 1] = y + radius * sin(angle);
        out[3 * i + 2] = 0;
    }
}

static const double cube_positions[24] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1};
static const int cube_corners[24] = {0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
static const unsigned cube_rings[7] = {0, 4, 8, 12, 16, 20, 24};

static inline gno_mesh_def cube(double crease, gno_weighting weighting)
{
    gno_mesh_def mesh = gno_mesh_def_default();
    mesh.vertex_count = 8;
    mesh.positions = cube_positions;
    mesh.polygon_count = mesh.ring_count = 6;
    mesh.ring_start = cube_rings;
    mesh.corner_count = 24;
    mesh.corner_vertex = cube_corners;
    mesh.shading = GNO_SHADING_PHONG;
    mesh.crease = crease;
    mesh.weighting = weighting;
    return mesh;
}

/* Writes a sphere of triangles without an index: every triangle has vertices of its own, to be welded by position. */
static inline size_t sphere(double (*positions)[3], int rows, int columns)
{
    size_t count = 0;
    int i, k, c;
    for (i = 0; i < rows; i++) {
        for (k = 0; k < columns; k++) {
            const int at[6][2] = {{i, k}, {i + 1, k}, {i + 1, k + 1}, {i, k}, {i + 1, k + 1}, {i, k + 1}};
            for (c = 0; c < 6; c++) {
                double polar = PI * at[c][0] / rows, around = 2 * PI * (at[c][1] % columns) / columns;
                double ring = at[c][0] == 0 || at[c][0] == rows ? 0 : sin(polar);
                positions[count][0] = ring * cos(around);
                positions[count][1] = ring * sin(around);
                positions[count][2] = cos(polar);
                count++;
            }
        }
    }
    return count;
}

static inline gno_mesh_def sphere_mesh(int rows, int columns)
{
    static double positions[24 * 48 * 6][3];
    static int corners[24 * 48 * 6];
    gno_mesh_def mesh = gno_mesh_def_default();
    size_t i;
    mesh.vertex_count = mesh.corner_count = sphere(positions, rows, columns);
    for (i = 0; i < mesh.corner_count; i++) {
        corners[i] = (int)i;
    }
    mesh.positions = (const double *)positions;
    mesh.polygon_count = mesh.ring_count = mesh.corner_count / 3;
    mesh.corner_vertex = corners;
    mesh.shading = GNO_SHADING_GOURAUD;
    return mesh;
}

#endif
