/* solids.c -- see solids.h. */
#include "support/solids.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

uint32_t solid_random(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

double solid_uniform(uint32_t *seed, double a, double b)
{
    return a + (b - a) * (double)solid_random(seed) / 16777216.0;
}

static void add_polygon(solid *s, const int *v, int n)
{
    for (int i = 0; i < n; i++)
        s->corner[s->corners++] = v[i];
    s->ring[++s->polygons] = (unsigned)s->corners;
}

static int add_vertex(solid *s, double x, double y, double z)
{
    s->p[s->vertices][0] = x;
    s->p[s->vertices][1] = y;
    s->p[s->vertices][2] = z;
    return (int)s->vertices++;
}

/* A prism over a ring of n points, counter-clockwise, from z = 0 to 1; lids as n-gons; open: without the lower one. */
static void make_prism(solid *s, int n, double (*ring)[2], int open)
{
    int top[64], bottom[64];
    for (int i = 0; i < n; i++) {
        bottom[n - 1 - i] = add_vertex(s, ring[i][0], ring[i][1], 0);
        top[i] = add_vertex(s, ring[i][0], ring[i][1], 1);
    }
    add_polygon(s, top, n);
    if (!open)
        add_polygon(s, bottom, n);
    for (int i = 0; i < n; i++) {
        int j = (i + 1) % n, side[4] = {2 * i, 2 * j, 2 * j + 1, 2 * i + 1};
        add_polygon(s, side, 4);
    }
}

static void make_star(solid *s, int tips, double inner, int open)
{
    double ring[64][2];
    for (int i = 0; i < 2 * tips; i++) {
        double r = i & 1 ? inner : 1, a = PI * i / tips + 0.1;
        ring[i][0] = r * cos(a);
        ring[i][1] = r * sin(a);
    }
    make_prism(s, 2 * tips, ring, open);
}

/* A torus of triangles, standing on z = 0, bumpy so that its contour is ragged. */
static void make_torus(solid *s, int m, int n, double thick, double bump, uint32_t *seed)
{
    for (int i = 0; i < m; i++)
        for (int j = 0; j < n; j++) {
            double a = 2 * PI * i / m, b = 2 * PI * j / n, r = thick * (1 + bump * solid_uniform(seed, -1, 1));
            add_vertex(s, (1 - thick + r * cos(b)) * cos(a), (1 - thick + r * cos(b)) * sin(a), thick + r * sin(b));
        }
    for (int i = 0; i < m; i++)
        for (int j = 0; j < n; j++) {
            int a = i * n + j, b = (i + 1) % m * n + j, c = (i + 1) % m * n + (j + 1) % n, d = i * n + (j + 1) % n;
            int t0[3] = {a, b, c}, t1[3] = {a, c, d};
            add_polygon(s, t0, 3);
            add_polygon(s, t1, 3);
        }
}

/* Folds the surface here and there: some of its triangles then face inwards, some pass through others. */
static void crumple(solid *s, uint32_t *seed)
{
    for (size_t i = 0; i < s->vertices; i++)
        for (int k = 0; k < 3 && i % 5 == 0; k++)
            s->p[i][k] += solid_uniform(seed, -0.12, 0.12);
}

void solid_make(solid *s, uint32_t *seed, int open_allowed)
{
    double square[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    memset(s, 0, offsetof(solid, p));
    s->ring[0] = 0;
    switch (solid_random(seed) % 7) {
    case 0:
    case 1: make_prism(s, 4, square, open_allowed && (solid_random(seed) & 1)); break;
    case 2:
    case 3: make_star(s, 3 + (int)(solid_random(seed) % 4), solid_uniform(seed, 0.3, 0.7), open_allowed && (solid_random(seed) & 1)); break;
    case 4: make_torus(s, 12, 8, 0.35, 0, seed); break;
    case 5: make_torus(s, 30, 16, 0.3, 0.3, seed); break;
    default:
        make_torus(s, 30, 16, 0.3, 0.1, seed);
        if (open_allowed)
            crumple(s, seed);
    }
}

gno_mesh_def solid_mesh(const solid *s)
{
    gno_mesh_def mesh = gno_mesh_def_default();
    mesh.vertex_count = s->vertices;
    mesh.positions = &s->p[0][0];
    mesh.polygon_count = mesh.ring_count = s->polygons;
    mesh.ring_start = s->ring;
    mesh.corner_count = s->corners;
    mesh.corner_vertex = s->corner;
    return mesh;
}
