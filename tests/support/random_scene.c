/* random_scene.c -- see random_scene.h.
 *
 * All scenes lie within some 4 units of the origin, z up. Values are drawn in a fixed order, one draw a statement, so that a
 * seed means the same scene with every compiler.
 */
#include "support/random_scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

typedef struct maker {
    gno_scene *scene;
    uint64_t state;
    int ok;        /* falls to 0 at the first call that fails */
    int materials; /* indices 1 .. materials were made at random */
} maker;

double random_unit(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    uint64_t x = *state;
    x = (x ^ x >> 31) * 0x9e3779b97f4a7c15u;
    return (double)((x ^ x >> 32) >> 11) / 9007199254740992.0;
}

static double between(maker *m, double a, double b) { return a + (b - a) * random_unit(&m->state); }
static int pick(maker *m, int count) { return (int)(random_unit(&m->state) * count); }

static void somewhere(maker *m, double size, double out[3])
{
    for (int k = 0; k < 3; k++) out[k] = between(m, -size, size);
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static void make_unit(double a[3])
{
    double l = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    for (int k = 0; k < 3; k++) a[k] /= l;
}

/* Two random unit vectors at right angles: the axes of a plane. */
static void random_plane(maker *m, double u[3], double v[3])
{
    double w[3];
    do somewhere(m, 1, u);
    while (u[0] * u[0] + u[1] * u[1] + u[2] * u[2] < 0.1);
    make_unit(u);
    do {
        somewhere(m, 1, w);
        cross(u, w, v);
    } while (v[0] * v[0] + v[1] * v[1] + v[2] * v[2] < 0.1);
    make_unit(v);
}

/* ---- geometry ----------------------------------------------------------------------------------------------------- */

const char *scene_kind_name(scene_kind kind)
{
    static const char *const names[SCENE_KINDS] = {"soup", "boxes", "holes", "stars", "details", "room", "glass", "around", "lattice", "torch", "solids", "blob", "panes", "soft", "marked"};
    return names[kind];
}

/* One polygon of several rings, in corner order. */
static int add_rings(gno_scene *scene, const double (*corners)[3], const unsigned *ring_start, unsigned rings, int material, int priority)
{
    int order[256];
    unsigned polygon_start[2] = {0, 0};
    gno_mesh_def d = gno_mesh_def_default();
    polygon_start[1] = rings;
    d.vertex_count = d.corner_count = ring_start[rings];
    if (d.vertex_count > 256) return 0;
    for (int i = 0; i < (int)d.vertex_count; i++) order[i] = i;
    d.positions = corners[0];
    d.polygon_count = 1;
    d.polygon_start = polygon_start;
    d.ring_count = rings;
    d.ring_start = ring_start;
    d.corner_vertex = order;
    d.material = material;
    d.priority = priority;
    return gno_scene_add_mesh(scene, &d, NULL) == GNO_OK;
}

int add_polygon(gno_scene *scene, const double (*corners)[3], size_t count, int material, int priority)
{
    unsigned ring_start[2] = {0, 0};
    ring_start[1] = (unsigned)count;
    return add_rings(scene, corners, ring_start, 1, material, priority);
}

int add_box(gno_scene *scene, const double a[3], const double b[3], int inside, int material)
{
    static const int sides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    double corners[8][3];
    int order[24];
    unsigned ring_start[7];
    gno_mesh_def d = gno_mesh_def_default();
    for (int i = 0; i < 8; i++)
        for (int k = 0; k < 3; k++) corners[i][k] = i >> k & 1 ? b[k] : a[k];
    for (int i = 0; i < 24; i++) order[i] = sides[i / 4][inside ? 3 - i % 4 : i % 4];
    for (unsigned i = 0; i < 7; i++) ring_start[i] = 4 * i;
    d.vertex_count = 8;
    d.positions = corners[0];
    d.polygon_count = d.ring_count = 6;
    d.ring_start = ring_start;
    d.corner_count = 24;
    d.corner_vertex = order;
    d.material = material;
    return gno_scene_add_mesh(scene, &d, NULL) == GNO_OK;
}

/* The midpoint of an edge of the sphere, made once: looked up among those made so far in this round. */
static int midpoint(double (*points)[3], int *count, int (*edges)[3], int *edge_count, int a, int b)
{
    int low = a < b ? a : b, high = a < b ? b : a;
    for (int i = *edge_count - 1; i >= 0; i--)
        if (edges[i][0] == low && edges[i][1] == high) return edges[i][2];
    int n = (*count)++;
    for (int k = 0; k < 3; k++) points[n][k] = points[low][k] + points[high][k];
    make_unit(points[n]);
    edges[*edge_count][0] = low;
    edges[*edge_count][1] = high;
    edges[(*edge_count)++][2] = n;
    return n;
}

/* A unit icosahedron divided `level` times; arrays hold 10 * 4^level + 2 points and 20 * 4^level triangles. */
static void sphere(int level, double (*points)[3], int (*triangles)[3], int (*edges)[3])
{
    static const double t = 1.6180339887498949;
    const double start[12][3] = {{-1, t, 0}, {1, t, 0}, {-1, -t, 0}, {1, -t, 0}, {0, -1, t}, {0, 1, t},
                                 {0, -1, -t}, {0, 1, -t}, {t, 0, -1}, {t, 0, 1}, {-t, 0, -1}, {-t, 0, 1}};
    static const int faces[20][3] = {{0, 11, 5}, {0, 5, 1}, {0, 1, 7}, {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                                     {11, 10, 2}, {10, 7, 6}, {7, 1, 8}, {3, 9, 4}, {3, 4, 2}, {3, 2, 6}, {3, 6, 8},
                                     {3, 8, 9}, {4, 9, 5}, {2, 4, 11}, {6, 2, 10}, {8, 6, 7}, {9, 8, 1}};
    int count = 12, triangle_count = 20;
    memcpy(points, start, sizeof start);
    memcpy(triangles, faces, sizeof faces);
    for (int i = 0; i < 12; i++) make_unit(points[i]);
    for (int round = 0; round < level; round++) {
        int edge_count = 0, old = triangle_count;
        for (int i = 0; i < old; i++) {
            int c[3], mid[3];
            memcpy(c, triangles[i], sizeof c);
            for (int k = 0; k < 3; k++) mid[k] = midpoint(points, &count, edges, &edge_count, c[k], c[(k + 1) % 3]);
            for (int k = 0; k < 3; k++) {
                int *corner = triangles[triangle_count + k];
                corner[0] = c[k];
                corner[1] = mid[k];
                corner[2] = mid[(k + 2) % 3];
            }
            memcpy(triangles[i], mid, sizeof mid);
            triangle_count += 3;
        }
    }
}

int add_blob(gno_scene *scene, int level, double radius, double waves, const double centre[3], int material, int shading)
{
    size_t triangle_count = (size_t)20 << 2 * level, point_count = triangle_count / 2 + 2;
    double(*points)[3] = malloc(point_count * sizeof *points), (*normals)[3] = calloc(point_count, sizeof *normals);
    int(*triangles)[3] = malloc(triangle_count * sizeof *triangles), (*edges)[3] = malloc(triangle_count * 3 / 2 * sizeof *edges);
    int ok = 0;
    if (!points || !normals || !triangles || !edges) goto end;
    sphere(level, points, triangles, edges);
    for (size_t i = 0; i < point_count; i++) {
        const double *p = points[i];
        double r = radius * (1 + waves * sin(3 * p[0] + 1) * sin(4 * p[1]) * cos(3 * p[2] - 0.5));
        for (int k = 0; k < 3; k++) points[i][k] = centre[k] + r * points[i][k];
    }
    for (size_t i = 0; i < triangle_count; i++) {
        double e[3], g[3], n[3];
        const int *t = triangles[i];
        for (int k = 0; k < 3; k++) {
            e[k] = points[t[1]][k] - points[t[0]][k];
            g[k] = points[t[2]][k] - points[t[0]][k];
        }
        cross(e, g, n);
        for (int c = 0; c < 3; c++)
            for (int k = 0; k < 3; k++) normals[t[c]][k] += n[k];
    }
    gno_mesh_def d = gno_mesh_def_default();
    d.vertex_count = d.normal_count = point_count;
    d.positions = points[0];
    d.normals = normals[0];
    d.polygon_count = d.ring_count = triangle_count;
    d.corner_count = 3 * triangle_count;
    d.corner_vertex = d.corner_normal = triangles[0];
    d.material = material;
    d.shading = shading;
    ok = gno_scene_add_mesh(scene, &d, NULL) == GNO_OK;
end:
    free(points);
    free(normals);
    free(triangles);
    free(edges);
    return ok;
}

/* A closed curve around `centre` in the plane of u and v, with radii between `least` and `most`; the winding is random. */
static unsigned star(maker *m, const double centre[3], const double u[3], const double v[3], double least, double most, unsigned count,
                     double (*out)[3])
{
    double turn = between(m, 0, 2 * PI), way = pick(m, 2) ? 1 : -1;
    for (unsigned i = 0; i < count; i++) {
        double angle = turn + way * 2 * PI * (i + 0.6 * between(m, 0, 1)) / count, r = between(m, least, most);
        for (int k = 0; k < 3; k++) out[i][k] = centre[k] + r * (cos(angle) * u[k] + sin(angle) * v[k]);
    }
    return count;
}

static int any_material(maker *m) { return 1 + pick(m, m->materials); }

static void keep(maker *m, int ok)
{
    if (!ok) m->ok = 0;
}

static void floor_at(maker *m, double z, double size)
{
    double c[4][3] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    for (int i = 0; i < 4; i++) {
        c[i][0] *= size;
        c[i][1] *= size;
        c[i][2] = z;
    }
    keep(m, add_polygon(m->scene, (const double(*)[3])c, 4, any_material(m), 0));
}

static void soup(maker *m, int count, double spread, double size)
{
    for (int i = 0; i < count; i++) {
        double c[3][3], centre[3];
        somewhere(m, spread, centre);
        for (int j = 0; j < 3; j++) {
            somewhere(m, size, c[j]);
            for (int k = 0; k < 3; k++) c[j][k] += centre[k];
        }
        keep(m, add_polygon(m->scene, (const double(*)[3])c, 3, any_material(m), 0));
    }
}

static void boxes(maker *m, int count, double spread, double floor)
{
    for (int i = 0; i < count; i++) {
        double a[3], b[3];
        somewhere(m, spread, a);
        a[2] = floor;
        for (int k = 0; k < 3; k++) b[k] = a[k] + between(m, 0.3, 1.3);
        keep(m, add_box(m->scene, a, b, 0, any_material(m)));
        if (pick(m, 2)) continue;
        a[0] = b[0]; /* a neighbour, wall on wall */
        b[0] = a[0] + between(m, 0.3, 1);
        b[2] = floor + between(m, 0.3, 1.3);
        keep(m, add_box(m->scene, a, b, 0, any_material(m)));
    }
}

static void windows(maker *m)
{
    floor_at(m, -1.5, 4);
    for (int wall = 0; wall < 3; wall++) {
        double u[3], v[3] = {0, 0, 1}, centre[3], angle = between(m, 0, PI), c[64][3];
        unsigned ring_start[6] = {0}, rings = 0;
        u[0] = cos(angle);
        u[1] = sin(angle);
        u[2] = 0;
        somewhere(m, 1.2, centre);
        centre[2] = 0;
        ring_start[++rings] = star(m, centre, u, v, 1.4, 1.9, 9 + (unsigned)pick(m, 6), c);
        for (int hole = 0; hole < 4; hole++) {
            double at[3], x = hole % 2 ? 0.45 : -0.45, y = hole / 2 ? 0.45 : -0.45;
            unsigned start = ring_start[rings];
            if (pick(m, 4) == 0) continue;
            for (int k = 0; k < 3; k++) at[k] = centre[k] + x * u[k] + y * v[k];
            ring_start[rings + 1] = start + star(m, at, u, v, 0.15, 0.4, 3 + (unsigned)pick(m, 5), c + start);
            rings++;
        }
        keep(m, add_rings(m->scene, (const double(*)[3])c, ring_start, rings, any_material(m), 0));
    }
}

static void stars(maker *m)
{
    floor_at(m, -2, 4);
    for (int i = 0; i < 12; i++) {
        double u[3], v[3], centre[3], c[12][3];
        random_plane(m, u, v);
        somewhere(m, 1.5, centre);
        unsigned count = star(m, centre, u, v, 0.2, 1.2, 5 + (unsigned)pick(m, 8), c);
        keep(m, add_polygon(m->scene, (const double(*)[3])c, count, any_material(m), 0));
    }
}

/* A tilted wall with patches on its plane, and a few things before it. */
static void details(maker *m)
{
    double u[3], v[3], centre[3] = {0, 0, 0}, at[3], c[12][3];
    random_plane(m, u, v);
    unsigned count = star(m, centre, u, v, 2.2, 2.8, 7, c);
    keep(m, add_polygon(m->scene, (const double(*)[3])c, count, any_material(m), 0));
    for (int i = 0; i < 14; i++) {
        double x = between(m, -1.6, 1.6), y = between(m, -1.6, 1.6);
        int priority = pick(m, 4) - 1;
        for (int k = 0; k < 3; k++) at[k] = x * u[k] + y * v[k];
        count = star(m, at, u, v, 0.3, 0.9, 3 + (unsigned)pick(m, 5), c);
        keep(m, add_polygon(m->scene, (const double(*)[3])c, count, any_material(m), priority));
    }
    soup(m, 6, 1.5, 0.6);
}

static void glass(maker *m)
{
    floor_at(m, -1.5, 4);
    for (int i = 0; i < 7; i++) {
        double u[3] = {1, 0, 0}, v[3] = {0, 1, 0}, centre[3], c[8][3];
        somewhere(m, 1.2, centre);
        if (pick(m, 3) == 0) random_plane(m, u, v);
        gno_material g = gno_material_default();
        double all = between(m, 0, 1);
        int grey = pick(m, 2), index = 0;
        for (int k = 0; k < 3; k++) {
            double own = between(m, 0, 1);
            g.transmission[k] = grey ? all : own;
            g.ambient[k] = between(m, 0.2, 0.9);
        }
        keep(m, gno_scene_add_material(m->scene, &g, &index) == GNO_OK);
        unsigned count = star(m, centre, u, v, 0.5, 1.3, 4 + (unsigned)pick(m, 4), c);
        keep(m, add_polygon(m->scene, (const double(*)[3])c, count, index, 0));
    }
    soup(m, 4, 1.5, 0.6);
}

/* A material that lets a random share through in each channel; sometimes one-sided, smooth by chance of the caller's. */
static int pane_material(maker *m)
{
    gno_material g = gno_material_default();
    double all = between(m, 0.2, 1);
    int grey = pick(m, 2), index = 0;
    for (int k = 0; k < 3; k++) {
        double own = between(m, 0, 1);
        g.transmission[k] = grey ? all : own;
        g.ambient[k] = between(m, 0, 0.6);
        g.diffuse[k] = between(m, 0, 0.6);
    }
    g.two_sided = pick(m, 5) != 0;
    g.shading = pick(m, 2) ? GNO_SHADING_CONSTANT : GNO_SHADING_FLAT;
    keep(m, gno_scene_add_material(m->scene, &g, &index) == GNO_OK);
    return index;
}

static void panes(maker *m)
{
    double u[3], v[3], at[3], c[12][3];
    floor_at(m, -1.5, 4);
    random_plane(m, u, v);
    for (int i = 0; i < 6; i++) { /* on one plane, with and without priorities */
        double x = between(m, -1, 1), y = between(m, -1, 1);
        int priority = pick(m, 3) - 1, pane = pick(m, 4) != 0;
        for (int k = 0; k < 3; k++) at[k] = x * u[k] + y * v[k];
        unsigned count = star(m, at, u, v, 0.5, 1.2, 3 + (unsigned)pick(m, 5), c);
        int material = pane ? pane_material(m) : any_material(m);
        keep(m, add_polygon(m->scene, (const double(*)[3])c, count, material, priority));
    }
    for (int i = 0; i < 10; i++) {
        somewhere(m, 1, at);
        random_plane(m, u, v);
        unsigned count = star(m, at, u, v, 0.6, 1.4, 3 + (unsigned)pick(m, 5), c);
        keep(m, add_polygon(m->scene, (const double(*)[3])c, count, pane_material(m), 0));
    }
    soup(m, 5, 1.2, 0.9);
}

static void marked(maker *m)
{
    double u[3], v[3], centre[3] = {0, 0, 0}, at[3], c[12][3];
    int wall_of_glass = pick(m, 3) == 0;
    random_plane(m, u, v);
    unsigned count = star(m, centre, u, v, 2.2, 2.8, 7, c);
    int material = wall_of_glass ? pane_material(m) : any_material(m);
    keep(m, add_polygon(m->scene, (const double(*)[3])c, count, material, 0));
    for (int i = 0; i < 10; i++) {
        double x = between(m, -1.6, 1.6), y = between(m, -1.6, 1.6);
        int priority = pick(m, 3), on = pick(m, 2) ? 0 : pick(m, i + 1), pane = pick(m, 4) == 0;
        for (int k = 0; k < 3; k++) at[k] = x * u[k] + y * v[k];
        count = star(m, at, u, v, 0.3, 0.9, 3 + (unsigned)pick(m, 5), c);
        material = pane ? pane_material(m) : any_material(m);
        keep(m, add_polygon(m->scene, (const double(*)[3])c, count, material, priority));
        keep(m, gno_scene_set_detail_of(m->scene, (size_t)i + 1, on) == GNO_OK);
    }
    soup(m, 6, 1.5, 0.6);
}

/* Rectangles and triangles with corners on whole numbers, mostly along the axes; equal planes and shared edges abound. */
static void lattice(maker *m)
{
    for (int i = 0; i < 26; i++) {
        double c[4][3], at[3], step[2][3] = {{0, 0, 0}, {0, 0, 0}};
        int axis = pick(m, 3), corners = 3 + pick(m, 2), slanted = pick(m, 4) == 0, priority = pick(m, 3);
        for (int k = 0; k < 3; k++) at[k] = pick(m, 5) - 2;
        for (int k = 0; k < 2; k++) step[k][(axis + 1 + k) % 3] = 1 + pick(m, 2);
        if (slanted) step[0][axis] = step[0][(axis + 1) % 3];
        for (int j = 0; j < corners; j++)
            for (int k = 0; k < 3; k++) c[j][k] = at[k] + (j == 1 || j == 2 ? step[0][k] : 0) + (j >= 2 ? step[1][k] : 0);
        keep(m, add_polygon(m->scene, (const double(*)[3])c, (size_t)corners, any_material(m), priority));
    }
}

/* Boxes and small blobs in the midst of each other; one that is wound inwards and drawn from one side only lets the eye in. */
static void solids(maker *m)
{
    floor_at(m, -1.5, 4);
    for (int i = 0; i < 6; i++) {
        double a[3], b[3];
        int inwards = pick(m, 2), round = pick(m, 3) == 0, material = any_material(m);
        somewhere(m, 1.3, a);
        for (int k = 0; k < 3; k++) b[k] = a[k] + between(m, 0.5, 1.8);
        keep(m, round ? add_blob(m->scene, 0, 0.8, 0.1, a, material, GNO_SHADING_FLAT) : add_box(m->scene, a, b, inwards, material));
    }
    soup(m, 2, 1, 0.8);
}

static void blob(maker *m)
{
    double centre[3] = {0, 0, 0};
    int shading = pick(m, 2) ? GNO_SHADING_GOURAUD : GNO_SHADING_PHONG;
    floor_at(m, -1.6, 4);
    double waves = between(m, 0, 0.3);
    keep(m, add_blob(m->scene, 2, 1.4, waves, centre, any_material(m), shading));
    soup(m, 2, 1.8, 0.6);
}

/* ---- materials, lights, camera ----------------------------------------------------------------------------------- */

static void add_materials(maker *m, scene_kind kind)
{
    int constant = pick(m, 2);
    m->materials = 6;
    for (int i = 0; i < m->materials; i++) {
        gno_material t = gno_material_default();
        int shiny = pick(m, 3) == 0;
        for (int k = 0; k < 3; k++) {
            t.ambient[k] = between(m, 0.1, 1);
            t.diffuse[k] = between(m, 0.1, 1);
            t.specular[k] = shiny ? between(m, 0.1, 0.6) : 0;
        }
        t.shininess = between(m, 1, 12);
        t.shading = constant ? GNO_SHADING_CONSTANT : GNO_SHADING_FLAT;
        int one_sided = pick(m, 4) == 0;
        one_sided |= kind == SCENE_SOLIDS && i % 2;
        if (kind == SCENE_SOUP || kind == SCENE_STARS || kind == SCENE_SOLIDS || kind == SCENE_BLOB) t.two_sided = !one_sided;
        keep(m, gno_scene_add_material(m->scene, &t, NULL) == GNO_OK);
    }
}

static void add_light(maker *m, scene_kind kind, double share)
{
    gno_light l = gno_light_default();
    double outside = kind == SCENE_ROOM || kind == SCENE_AROUND ? 0 : 1, size = outside > 0 ? 1.5 : 1.2;
    int dice = pick(m, 10);
    l.type = dice < 5 ? GNO_LIGHT_POINT : dice < 7 ? GNO_LIGHT_DIRECTIONAL : dice < 9 ? GNO_LIGHT_SPOT : GNO_LIGHT_AREA;
    if (kind == SCENE_ROOM && l.type == GNO_LIGHT_DIRECTIONAL) l.type = GNO_LIGHT_POINT;
    somewhere(m, size, l.position);
    if (pick(m, 3)) l.position[2] = l.position[2] * 0.2 + 3.5 * outside; /* from above, or in the midst of things */
    /* a lamp on the floor makes a spot of light smaller than a pixel, which no bound of the tests is meant for */
    if (outside > 0) l.position[2] = fmax(l.position[2], kind == SCENE_BOXES ? -0.1 : -1.1);
    for (int k = 0; k < 3 && kind == SCENE_LATTICE; k++) l.position[k] = floor(2 * l.position[k]) + 0.5; /* on slanted planes at most */
    somewhere(m, 1, l.direction);
    l.direction[2] = -1.2;
    somewhere(m, 0.4, l.edge1);
    somewhere(m, 0.4, l.edge2);
    l.samples = 2;
    l.angle = between(m, 40, 120);
    for (int k = 0; k < 3; k++) l.intensity[k] = share * between(m, 0.5, 1);
    dice = pick(m, 8);
    l.distance_from_viewer = pick(m, 2);
    l.falloff_k = between(m, 1, 3);
    if (dice == 0 || dice == 1) {
        l.falloff = GNO_FALLOFF_LINEAR;
        for (int k = 0; k < 3; k++) l.intensity[k] *= 6;
    }
    if (kind == SCENE_TORCH) {
        l.type = GNO_LIGHT_POINT;
        memcpy(l.position, gno_scene_camera(m->scene).eye, sizeof l.position);
    }
    if (dice == 2 && l.position[2] > 2) { /* far from everything, or it would burn a hole into the picture */
        l.falloff = GNO_FALLOFF_INVERSE_SQUARE;
        for (int k = 0; k < 3; k++) l.intensity[k] *= 10;
    }
    if (kind == SCENE_SOFT || (kind == SCENE_MARKED && pick(m, 4) == 0) || (kind == SCENE_PANES && pick(m, 2))) l.softness = between(m, 0.2, 3);
    keep(m, gno_scene_add_light(m->scene, NULL, &l, NULL) == GNO_OK);
}

static void add_camera(maker *m, scene_kind kind)
{
    gno_camera c = gno_camera_default();
    double around = between(m, 0, 2 * PI), up = between(m, 0.15, 1.2), far = between(m, 6, 8);
    c.eye[0] = far * cos(around) * cos(up);
    c.eye[1] = far * sin(around) * cos(up);
    c.eye[2] = far * sin(up);
    somewhere(m, 0.4, c.target);
    c.fov = between(m, 25, 40);
    c.height = between(m, 3, 5);
    if (pick(m, 3) == 0) c.type = GNO_CAMERA_ORTHOGRAPHIC;
    if (kind == SCENE_TORCH) c.type = GNO_CAMERA_PERSPECTIVE;
    if (kind == SCENE_ROOM || kind == SCENE_AROUND || (kind == SCENE_SOLIDS && pick(m, 4) == 0)) {
        c.type = GNO_CAMERA_PERSPECTIVE;
        c.fov = between(m, 50, 110);
        somewhere(m, 1, c.eye);
        c.eye[2] = between(m, -0.3, 0.9);
        do somewhere(m, 1, c.target);
        while (hypot(c.target[0] - c.eye[0], c.target[1] - c.eye[1]) < 0.4);
    }
    if (pick(m, 4) == 0) somewhere(m, 0.5, c.up); /* a tilted camera */
    c.up[2] = 1;
    if (kind == SCENE_LATTICE && pick(m, 2)) { /* straight along an axis, 6 or 8 pixels a unit */
        int axis = pick(m, 3);
        c.type = GNO_CAMERA_ORTHOGRAPHIC;
        c.height = pick(m, 2) ? 6 : 8;
        for (int k = 0; k < 3; k++) {
            c.target[k] = 0;
            c.eye[k] = k == axis ? 9 : 0;
            c.up[k] = k == (axis + 1) % 3;
        }
    }
    keep(m, gno_scene_set_camera(m->scene, &c) == GNO_OK);
}

gno_scene *random_scene(gno_context *context, scene_kind kind, unsigned seed, int width, int height)
{
    maker m = {NULL, (uint64_t)seed * 0x9e3779b97f4a7c15u + (uint64_t)kind, 1, 0};
    const double a[3] = {-2, -2, -1.5}, b[3] = {2, 2, 1.5};
    gno_image_def image = gno_image_def_default();
    double ambient[3] = {0.3, 0.25, 0.35};
    if (gno_scene_create(context, &m.scene) != GNO_OK) return NULL;
    for (int i = 0; i < 3; i++) random_unit(&m.state);
    image.width = width;
    image.height = height;
    for (int k = 0; k < 3; k++) image.background[k] = between(&m, 0, 0.5);
    keep(&m, gno_scene_set_image(m.scene, &image) == GNO_OK);
    keep(&m, gno_scene_set_ambient(m.scene, ambient) == GNO_OK);
    add_materials(&m, kind);
    add_camera(&m, kind);
    int lights = kind == SCENE_TORCH ? 1 : 1 + pick(&m, 3);
    for (int i = 0; i < lights; i++) add_light(&m, kind, i ? 0.5 : 0.8);
    switch (kind) {
    case SCENE_SOUP: soup(&m, 25, 1.2, 1.4); break;
    case SCENE_BOXES: floor_at(&m, -0.5, 4); boxes(&m, 5, 1.6, -0.5); break;
    case SCENE_HOLES: windows(&m); break;
    case SCENE_STARS: stars(&m); break;
    case SCENE_DETAILS: details(&m); break;
    case SCENE_ROOM: keep(&m, add_box(m.scene, a, b, 1, any_material(&m))); boxes(&m, 4, 1, -1.5); break;
    case SCENE_GLASS: glass(&m); break;
    case SCENE_LATTICE: lattice(&m); break;
    case SCENE_SOLIDS: solids(&m); break;
    case SCENE_TORCH: floor_at(&m, -1.5, 4); soup(&m, 12, 1.2, 1.2); boxes(&m, 2, 1.5, -1.5); break;
    case SCENE_PANES: panes(&m); break;
    case SCENE_SOFT: floor_at(&m, -0.5, 4); boxes(&m, 3, 1.6, -0.5); soup(&m, 5, 1.2, 0.9); glass(&m); break;
    case SCENE_MARKED: marked(&m); break;
    case SCENE_AROUND: soup(&m, 30, 1.5, 1.8); break;
    default: blob(&m); break;
    }
    if (m.ok) return m.scene;
    gno_scene_destroy(m.scene);
    return NULL;
}
