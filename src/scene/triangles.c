/* triangles.c -- see triangles.h.
 *
 * Corners are copied side by side, which one vector instruction then takes eight of; arithmetic and its order are those of
 * gnoi_set_triangle. Volumes add up in lanes, the same on every machine.
 */
#include "scene/triangles.h"
#include "base/vector.h"

#define BLOCK 64 /* triangles at a time */
#define LANES 8

typedef struct block {
    double corner[3][3][BLOCK]; /* x, y, z of the first, second and third corners */
    double n[3][BLOCK], d[BLOCK];
    double volume[BLOCK];
} block;

static void copy_corners(const gnoi_prepared *prep, const uint32_t *vertex, size_t count, block *b)
{
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) {
            const double *p = prep->positions[vertex[3 * i + (size_t)k]];
            b->corner[k][0][i] = p[0];
            b->corner[k][1][i] = p[1];
            b->corner[k][2][i] = p[2];
        }
}

/* Planes and six times the volumes of all places of a block. */
VECTOR_CLONES static void set_planes(block *b, const double base[3])
{
    const double x = base[0], y = base[1], z = base[2];
    for (int i = 0; i < BLOCK; i++) {
        double ax = b->corner[0][0][i], ay = b->corner[0][1][i], az = b->corner[0][2][i];
        double bx = b->corner[1][0][i], by = b->corner[1][1][i], bz = b->corner[1][2][i];
        double cx = b->corner[2][0][i], cy = b->corner[2][1][i], cz = b->corner[2][2][i];
        double ux = bx - ax, uy = by - ay, uz = bz - az, vx = cx - ax, vy = cy - ay, vz = cz - az;
        double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
        double k = 1 / sqrt(nx * nx + ny * ny + nz * nz), third = 1.0 / 3;
        b->volume[i] = nx * (ax - x) + ny * (ay - y) + nz * (az - z);
        nx *= k;
        ny *= k;
        nz *= k;
        b->n[0][i] = nx;
        b->n[1][i] = ny;
        b->n[2][i] = nz;
        b->d[i] = -(nx * ((ax + (bx + cx)) * third) + ny * ((ay + (by + cy)) * third) + nz * ((az + (bz + cz)) * third));
    }
}

VECTOR_CLONES static uint64_t sum_edges(const uint32_t *vertex, size_t count)
{
    uint64_t sum = 0;
    for (size_t i = 0; i < count; i++) {
        uint32_t a = vertex[3 * i], b = vertex[3 * i + 1], c = vertex[3 * i + 2];
        sum += gnoi_edge_number(a, b) + gnoi_edge_number(b, c) + gnoi_edge_number(c, a);
    }
    return sum;
}

static void store_planes(const block *b, gnoi_poly *polys, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        polys[i].n[0] = b->n[0][i];
        polys[i].n[1] = b->n[1][i];
        polys[i].n[2] = b->n[2][i];
        polys[i].d = b->d[i];
    }
}

static double sum_volumes(const block *b, size_t count)
{
    double lane[LANES] = {0}, sum = 0;
    size_t i = 0;
    for (; i + LANES <= count; i += LANES)
        for (size_t k = 0; k < LANES; k++)
            lane[k] += b->volume[i + k];
    for (; i < count; i++)
        sum += b->volume[i];
    for (int k = 0; k < LANES; k++)
        sum += lane[k];
    return sum;
}

void gnoi_set_triangles(gnoi_prepared *prep, size_t first, size_t count, gnoi_triangle_sums *sums)
{
    block b = {0}; /* places without a triangle are computed too */
    const uint32_t *vertex = prep->corner_vertex + prep->polys[first].corner;
    for (size_t i = 0, n; i < count; i += n, vertex += 3 * n) {
        n = count - i < BLOCK ? count - i : BLOCK;
        copy_corners(prep, vertex, n, &b);
        set_planes(&b, prep->lower);
        store_planes(&b, prep->polys + first + i, n);
        sums->edges += sum_edges(vertex, n);
        sums->volume += sum_volumes(&b, n);
    }
}
