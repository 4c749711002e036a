/* random_mesh.c -- see random_mesh.h. */
#include "support/random_mesh.h"
#include "support/random_scene.h"

#include <stdlib.h>
#include <string.h>

static void must(int good)
{
    if (!good)
        abort();
}

static int below(uint64_t *seed, int n) { return (int)(random_unit(seed) * n); }

typedef struct draft {
    size_t vertex_count, normal_count, polygon_count, ring_count, corner_count;
    double (*positions)[3], (*normals)[3];
    unsigned *polygon_start, *ring_start;
    int *corner_vertex, *corner_normal;
} draft;

static void add_corner(draft *d, int vertex, uint64_t *seed)
{
    d->corner_normal[d->corner_count] = below(seed, 3) ? below(seed, (int)d->normal_count) : -1;
    d->corner_vertex[d->corner_count++] = vertex;
}

static void end_ring(draft *d) { d->ring_start[++d->ring_count] = (unsigned)d->corner_count; }
static void end_polygon(draft *d) { d->polygon_start[++d->polygon_count] = (unsigned)d->ring_count; }

static int add_vertex(draft *d, const double p[3])
{
    memcpy(d->positions[d->vertex_count], p, sizeof d->positions[0]);
    return (int)d->vertex_count++;
}

/* The faces of a box with whole corners; some faces missing, turned or cut into triangles, seams closed by polygons without area. */
static void draft_box(draft *d, int side, int damage, uint64_t *seed)
{
    static const int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    double low[3], high[3];
    for (int k = 0; k < 3; k++) {
        low[k] = below(seed, side);
        high[k] = low[k] + 1 + below(seed, 3);
    }
    for (int f = 0; f < 6; f++) {
        int v[4], what = damage ? below(seed, 12) : 4;
        if (what == 0)
            continue;
        for (int k = 0; k < 4; k++) {
            int corner = faces[f][what == 1 ? 3 - k : k];
            double p[3] = {corner & 1 ? high[0] : low[0], corner & 2 ? high[1] : low[1], corner & 4 ? high[2] : low[2]};
            v[k] = add_vertex(d, p);
        }
        for (int k = 0; k < (what == 2 ? 3 : 4); k++)
            add_corner(d, v[k], seed);
        end_ring(d);
        end_polygon(d);
        for (int k = 0; k < 3 && what == 2; k++)
            add_corner(d, v[(2 + k) % 4], seed);
        if (what == 2)
            end_ring(d), end_polygon(d);
    }
}

/* Three to six corners anywhere: bent, crossing or without area as it happens; some with a ring too short to count. */
static void draft_scrap(draft *d, int side, uint64_t *seed)
{
    int corners = 3 + below(seed, 4) * below(seed, 2);
    for (int i = 0; i < corners; i++) {
        double p[3] = {below(seed, side), below(seed, side), below(seed, side)};
        add_corner(d, add_vertex(d, p), seed);
    }
    end_ring(d);
    for (int i = 0; corners > 3 && below(seed, 4) == 0 && i < 2; i++) {
        double p[3] = {below(seed, side), below(seed, side), 0};
        add_corner(d, add_vertex(d, p), seed);
    }
    if (d->corner_count > d->ring_start[d->ring_count])
        end_ring(d);
    end_polygon(d);
}

static draft start_draft(size_t bodies, uint64_t *seed)
{
    draft d = {0, 20, 0, 0, 0, NULL, NULL, NULL, NULL, NULL, NULL};
    size_t room = 60 * bodies + 60;
    d.positions = calloc(room, sizeof *d.positions);
    d.normals = calloc(d.normal_count, sizeof *d.normals);
    d.polygon_start = calloc(room, sizeof *d.polygon_start);
    d.ring_start = calloc(room, sizeof *d.ring_start);
    d.corner_vertex = calloc(room, sizeof *d.corner_vertex);
    d.corner_normal = calloc(room, sizeof *d.corner_normal);
    must(d.positions && d.normals && d.polygon_start && d.ring_start && d.corner_vertex && d.corner_normal);
    for (size_t i = 1; i < d.normal_count; i++) /* the first is zero */
        for (int k = 0; k < 3; k++)
            d.normals[i][k] = below(seed, 9) - 4;
    return d;
}

static void free_draft(draft *d)
{
    free(d->positions);
    free(d->normals);
    free(d->polygon_start);
    free(d->ring_start);
    free(d->corner_vertex);
    free(d->corner_normal);
}

static void add_draft(gno_scene *scene, const draft *d, uint64_t *seed)
{
    static const gno_weighting weightings[] = {GNO_WEIGHTING_AREA, GNO_WEIGHTING_ANGLE, GNO_WEIGHTING_EQUAL};
    gno_mesh_def mesh = gno_mesh_def_default();
    mesh.vertex_count = d->vertex_count;
    mesh.positions = &d->positions[0][0];
    mesh.normal_count = d->normal_count;
    mesh.normals = &d->normals[0][0];
    mesh.polygon_count = d->polygon_count;
    mesh.polygon_start = d->polygon_start;
    mesh.ring_count = d->ring_count;
    mesh.ring_start = d->ring_start;
    mesh.corner_count = d->corner_count;
    mesh.corner_vertex = d->corner_vertex;
    mesh.corner_normal = below(seed, 3) ? d->corner_normal : NULL;
    mesh.average_normals = below(seed, 4) == 0;
    mesh.shading = below(seed, 3) ? GNO_SHADING_PHONG : GNO_SHADING_FLAT;
    mesh.crease = below(seed, 2) ? 180 : 30 + below(seed, 100);
    mesh.weighting = weightings[below(seed, 3)];
    must(gno_scene_add_mesh(scene, &mesh, NULL) == GNO_OK);
}

gno_scene *random_mesh(gno_context *context, uint64_t seed, size_t bodies, int side, int kind)
{
    gno_scene *scene;
    int objects = 1 + below(&seed, 3);
    must(gno_scene_create(context, &scene) == GNO_OK);
    for (int o = 0; o < objects; o++) {
        draft d = start_draft(bodies, &seed);
        for (size_t i = 0; i < bodies; i++)
            if (kind == 1 || below(&seed, 2))
                draft_box(&d, side, below(&seed, kind == 1 ? 8 : 2) == 0, &seed);
            else
                draft_scrap(&d, side, &seed);
        add_draft(scene, &d, &seed);
        free_draft(&d);
    }
    return scene;
}
