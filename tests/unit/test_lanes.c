/* test_lanes.c -- triangles side by side against the scalar code for polygons of any shape: the same numbers, bit by bit; which tiles
 * they touch; and the keys by which polygons of a tile are ordered.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "project/edge.h"
#include "scan/ranges.h"

#define WIDTH 24
#define MOST ((WIDTH + 1.0) * GNOI_X_ONE)

static uint64_t random_state = 88172645463325252u;

static double random_in(double low, double high)
{
    random_state ^= random_state << 13;
    random_state ^= random_state >> 7;
    random_state ^= random_state << 17;
    return low + (high - low) * (double)(random_state >> 11) * 0x1p-53;
}

/* One in two on a coarse grid, so that edges are level, upright or of no length, and corners lie on lines. */
static double coordinate(double size, int coarse)
{
    double v = random_in(-size, size);
    return coarse ? floor(v * 2 + 0.5) / 2 : v;
}

static void fill(gnoi_lanes *l, double size)
{
    memset(l, 0, sizeof *l);
    l->count = GNOI_LANES;
    for (int i = 0; i < GNOI_LANES; i++) {
        int coarse = random_in(0, 1) < 0.5;
        double x = random_in(0, WIDTH), y = random_in(0, 32);
        for (int k = 0; k < 3; k++) {
            l->x[k][i] = 96 + (coarse ? floor(x) : x) + coordinate(size, coarse);
            l->y[k][i] = (coarse ? floor(y) : y) + coordinate(size, coarse);
            l->z[k][i] = (float)random_in(0.1, 2);
        }
    }
}

/* By the edges in the order they have, as polygons of any shape are crossed. */
static int cross_scalar(const gnoi_lanes *l, int lane, double y, int32_t *from, int32_t *to)
{
    gnoi_edge edges[3];
    double x[3];
    unsigned count = 0, n;
    for (int k = 0; k < 3; k++) {
        int next = (k + 1) % 3;
        count += (unsigned)gnoi_edge_set(&edges[count], l->x[k][lane], l->y[k][lane], l->x[next][lane], l->y[next][lane]);
    }
    n = gnoi_edges_cross(edges, count, y, x);
    assert_true(n == 0 || n == 2);
    if (n == 0)
        return 0;
    *from = gnoi_lane_position(x[0], 96, MOST);
    *to = gnoi_lane_position(x[1], 96, MOST);
    return *from < *to;
}

static void crossings_are_those_of_single_edges(void **state)
{
    static const double sizes[] = {0.3, 2, 9, 400};
    gnoi_lanes *l = malloc(sizeof *l);
    int crossed = 0;
    (void)state;
    assert_non_null(l);
    for (int round = 0; round < 400; round++) {
        double y[GNOI_LANE_LINES];
        unsigned count = 1 + (unsigned)random_in(0, GNOI_LANE_LINES - 0.01);
        fill(l, sizes[round % 4]);
        gnoi_lanes_set_edges(l);
        for (unsigned i = 0; i < GNOI_LANE_LINES; i++)
            y[i] = round & 4 ? random_in(0, 32) : floor(random_in(0, 64)) / 2 + 0.25 * (double)(round & 1);
        for (int lane = 0; lane < GNOI_LANES; lane++) {
            gnoi_lanes_cross(l, (unsigned)lane, y, count, 96, MOST);
            for (unsigned i = 0; i < count; i++) {
                int32_t from, to;
                if (cross_scalar(l, lane, y[i], &from, &to)) {
                    assert_int_equal(l->from[i], from);
                    assert_int_equal(l->to[i], to);
                    crossed++;
                } else {
                    assert_true(l->from[i] >= l->to[i]);
                }
            }
        }
    }
    assert_true(crossed > 10000);
    free(l);
}

static void bounds_hold_the_corners(void **state)
{
    gnoi_lanes *l = malloc(sizeof *l);
    (void)state;
    assert_non_null(l);
    fill(l, 5);
    gnoi_lanes_bound(l);
    for (int i = 0; i < GNOI_LANES; i++) {
        int touched = 0;
        for (int k = 0; k < 3; k++) {
            assert_true(l->x0[i] <= l->x[k][i] && l->x[k][i] <= l->x1[i] && l->y0[i] <= l->y[k][i] && l->y[k][i] <= l->y1[i]);
            assert_true(l->z0[i] <= l->z[k][i] && l->z[k][i] <= l->z1[i]);
            touched |= (l->x[k][i] == l->x0[i]) | (l->x[k][i] == l->x1[i]) << 1 | (l->y[k][i] == l->y0[i]) << 2 |
                       (l->y[k][i] == l->y1[i]) << 3 | (l->z[k][i] == l->z0[i]) << 4 | (l->z[k][i] == l->z1[i]) << 5;
        }
        assert_int_equal(touched, 63);
    }
    free(l);
}

static void check_planes(int orthographic)
{
    static const gnoi_rect rect = {96, 31.5, 120, 64.5};
    gno_camera camera;
    gno_image_def image;
    gnoi_view view;
    gnoi_lanes *l = malloc(sizeof *l);
    assert_non_null(l);
    memset(&camera, 0, sizeof camera);
    memset(&image, 0, sizeof image);
    memset(l, 0, sizeof *l);
    camera.type = orthographic ? GNO_CAMERA_ORTHOGRAPHIC : GNO_CAMERA_PERSPECTIVE;
    camera.eye[0] = 3, camera.eye[1] = -4, camera.eye[2] = 2;
    camera.up[2] = 1;
    camera.fov = 40;
    camera.height = 6;
    image.width = 320;
    image.height = 240;
    view = gnoi_view_make(&camera, &image, 10);
    for (unsigned i = 0; i < GNOI_LANES; i++) {
        gnoi_poly poly;
        vec3 n = v3_unit(v3(random_in(-1, 1), random_in(-1, 1), random_in(-1, 1)));
        memset(&poly, 0, sizeof poly);
        poly.n[0] = n.x, poly.n[1] = n.y, poly.n[2] = n.z;
        poly.d = random_in(-2, 2);
        gnoi_lanes_set_plane(l, i, &poly, 1e-6);
    }
    gnoi_lanes_see(l, &view, &rect);
    for (int i = 0; i < GNOI_LANES; i++) {
        double n[3] = {l->n[0][i], l->n[1][i], l->n[2][i]}, side = gnoi_view_side(&view, n, l->d[i]);
        gnoi_screen_plane p = gnoi_view_nearness(&view, n, l->d[i], side);
        float low = HUGE_VALF, high = -HUGE_VALF;
        assert_true(l->side[i] == side && l->fx[i] == p.fx && l->fy[i] == p.fy && l->f0[i] == p.f0);
        for (int c = 0; c < 4; c++) {
            float z = (float)gnoi_plane_at(&p, c & 1 ? rect.x1 : rect.x0, c & 2 ? rect.y1 : rect.y0);
            low = z < low ? z : low;
            high = z > high ? z : high;
        }
        assert_true(l->low[i] == low && l->high[i] == high);
    }
    free(l);
}

static void planes_are_those_of_the_view(void **state)
{
    (void)state;
    check_planes(0);
    check_planes(1);
}

/* Drawing ends when nothing that comes later in order could be seen: a key must not promise more than it holds. */
static void keys_put_the_nearest_first(void **state)
{
    float before = HUGE_VALF;
    uint32_t key = gnoi_nearness_key(before, 1);
    (void)state;
    for (int i = 0; i < 4000; i++) {
        float z = i < 2000 ? (float)pow(0.98, i) : -(float)pow(1.02, i - 2000 - 1000);
        uint32_t next = gnoi_nearness_key(z, 1);
        assert_true(z < before && next >= key);
        assert_true(gnoi_key_nearness(next) >= z && gnoi_nearness_key(gnoi_key_nearness(next), 1) == next);
        assert_int_equal(gnoi_nearness_key(z, 0), next | GNOI_KEY_SEE_THROUGH);
        assert_true(gnoi_nearness_key(z, 0) > gnoi_nearness_key(-HUGE_VALF, 1));
        before = z;
        key = next;
    }
    assert_true(gnoi_key_nearness(gnoi_nearness_key(HUGE_VALF, 1)) == HUGE_VALF);
}

/* Tiles by rounding, as their borders are drawn. */
static int tile_at(double v, int size, int tiles)
{
    double t = floor(v / size);
    return (int)(t < 0 ? 0 : t > tiles - 1 ? tiles - 1 : t);
}

static void check_range(const gnoi_tile_grid *g, const gnoi_rect *b, float z, const gnoi_tile_range *r)
{
    int lines = ceil(b->y0 * g->lines - 0.5) < ceil(b->y1 * g->lines - 0.5);
    if (!lines || !(b->x1 > 0) || !(b->x0 < g->width) || !(b->y1 > -0.5) || !(b->y0 < g->height + 0.5)) {
        assert_true(r->x0 > r->x1);
        return;
    }
    assert_int_equal(r->x0, tile_at(b->x0 - 1e-3, GNOI_TILE_W, g->tiles_x));
    assert_int_equal(r->x1, tile_at(b->x1 + 1e-3, GNOI_TILE_W, g->tiles_x));
    assert_int_equal(r->y0, tile_at(b->y0 - 0.5, GNOI_TILE_H, g->tiles_y));
    assert_int_equal(r->y1, tile_at(b->y1 + 0.5, GNOI_TILE_H, g->tiles_y));
    assert_int_equal(r->key & ~GNOI_LARGE, gnoi_nearness_key(z, 1));
    assert_int_equal((r->key & GNOI_LARGE) != 0, b->x1 - b->x0 > GNOI_TILE_W || b->y1 - b->y0 > GNOI_TILE_H);
}

static void ranges_are_the_tiles_of_the_bounds(void **state)
{
    gnoi_tile_grid g = {100, 80, 5, 3, 4, 800};
    const gnoi_rect nothing = {HUGE_VAL, 0, -HUGE_VAL, 0}, all = {-HUGE_VAL, -HUGE_VAL, HUGE_VAL, HUGE_VAL};
    gnoi_tile_range r = gnoi_tile_range_of(&g, &nothing, 1);
    gnoi_lanes *l = malloc(sizeof *l);
    (void)state;
    assert_non_null(l);
    assert_true(r.x0 > r.x1);
    r = gnoi_tile_range_of(&g, &all, 1);
    assert_true(r.x0 == 0 && r.x1 == 4 && r.y0 == 0 && r.y1 == 2 && (r.key & GNOI_LARGE));
    for (int round = 0; round < 3000; round++) {
        static const double sizes[4] = {0.2, 5, 60, 1200};
        gnoi_tile_range range[GNOI_LANES];
        unsigned within;
        fill(l, sizes[round % 4]);
        for (int k = 0; k < 3; k++)
            for (int i = 0; i < GNOI_LANES; i++)
                l->x[k][i] -= 48;
        gnoi_lanes_bound(l);
        within = gnoi_tile_ranges(&g, l, range);
        for (int i = 0; i < GNOI_LANES; i++) {
            const gnoi_rect b = {l->x0[i], l->y0[i], l->x1[i], l->y1[i]};
            int far = b.x0 < -g.reach || b.x1 > g.reach || b.y0 < -g.reach || b.y1 > g.reach;
            assert_int_equal(within >> i & 1, !far);
            check_range(&g, &b, l->z1[i], &range[i]);
            r = gnoi_tile_range_of(&g, &b, l->z1[i]);
            assert_memory_equal(&r, &range[i], sizeof r);
        }
    }
    free(l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(crossings_are_those_of_single_edges),
        cmocka_unit_test(bounds_hold_the_corners),
        cmocka_unit_test(planes_are_those_of_the_view),
        cmocka_unit_test(ranges_are_the_tiles_of_the_bounds),
        cmocka_unit_test(keys_put_the_nearest_first),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
