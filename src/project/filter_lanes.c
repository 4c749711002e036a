/* filter_lanes.c -- see filter_lanes.h. */
#include "project/filter_lanes.h"
#include "base/vector.h"
#include <math.h>

#define INLINE static inline __attribute__((always_inline))
#define LEVEL_EDGE 1e-12f /* edges of less height leave no area */
#define FAR 1e10f

INLINE float lesser(float a, float b) { return a < b ? a : b; }
INLINE float greater(float a, float b) { return a > b ? a : b; }
INLINE float within(float v, float low, float high) { return lesser(greater(v, low), high); }

INLINE float floor_of(float v)
{
    float whole = (float)(int)v;
    return whole - (float)(v < whole);
}

INLINE float least(gnoi_lane_values v[4], int i) { return lesser(lesser(v[0][i], v[1][i]), lesser(v[2][i], v[3][i])); }
INLINE float largest(gnoi_lane_values v[4], int i) { return greater(greater(v[0][i], v[1][i]), greater(v[2][i], v[3][i])); }

VECTOR_CLONES void gnoi_lanes_start(gnoi_lanes *l)
{
    static const float across[4] = {-0.5f, 0.5f, 0.5f, -0.5f}, down[4] = {-0.5f, -0.5f, 0.5f, 0.5f};
    for (int c = 0; c < 4; c++)
        for (int i = 0; i < GNOI_LANES; i++) {
            float k = 1.0f / (1.0f + l->wx[i] * across[c] + l->wy[i] * down[c]);
            l->x[c][i] = l->s[i] + (l->sx[i] * across[c] + l->sy[i] * down[c]) * k;
            l->y[c][i] = l->t[i] + (l->tx[i] * across[c] + l->ty[i] * down[c]) * k;
        }
    for (int i = 0; i < GNOI_LANES; i++) {
        l->low_x[i] = least(l->x, i);
        l->high_x[i] = largest(l->x, i);
        l->first_row[i] = floor_of(least(l->y, i));
        l->rows[i] = (int)(floor_of(largest(l->y, i)) - l->first_row[i]) + 1;
    }
    for (int c = 0; c < 4; c++)
        for (int i = 0; i < GNOI_LANES; i++) {
            float dx = l->x[(c + 1) & 3][i] - l->x[c][i], dy = l->y[(c + 1) & 3][i] - l->y[c][i], level = (float)(fabsf(dy) < LEVEL_EDGE);
            l->slope[c][i] = (1.0f - level) * dx / (dy + level);
        }
    /* Areas in the picture go with w^3, which is linear enough over so little. */
    l->uneven = 0;
    for (int i = 0; i < GNOI_LANES; i++) {
        float bend = fabsf(l->wx[i]) + fabsf(l->wy[i]), uneven = (float)(bend > GNOI_EVEN_BEND);
        float k = 3.0f * uneven / (l->sx[i] * l->ty[i] - l->sy[i] * l->tx[i]);
        l->gain_x[i] = k * (l->wx[i] * l->ty[i] - l->wy[i] * l->tx[i]);
        l->gain_y[i] = k * (l->wy[i] * l->sx[i] - l->wx[i] * l->sy[i]);
    }
    for (int i = 0; i < GNOI_LANES; i++)
        l->uneven |= l->gain_x[i] != 0 || l->gain_y[i] != 0;
}

/* What a row leaves of the edges: x of the left and of the right end, the height, signed, and the inverse of the distance of the ends in x;
 * y of the left end, of the middle, and what y changes by from right to left, from t. */
typedef struct stretches {
    gnoi_lane_values left[4], right[4], height[4], inverse[4], left_y[4], middle_y[4], rise[4];
    gnoi_lane_values low, high; /* least and largest x */
} stretches;

INLINE void cut_edges(const gnoi_lanes *restrict l, int row, stretches *restrict s)
{
    for (int i = 0; i < GNOI_LANES; i++) {
        s->low[i] = FAR;
        s->high[i] = -FAR;
    }
    for (int c = 0; c < 4; c++)
        for (int i = 0; i < GNOI_LANES; i++) {
            float top = l->first_row[i] + (float)row, x = l->x[c][i], y = l->y[c][i], a, b, off, turned;
            float ya = within(y, top, top + 1.0f), yb = within(l->y[(c + 1) & 3][i], top, top + 1.0f);
            a = within(x + (ya - y) * l->slope[c][i], l->low_x[i], l->high_x[i]);
            b = within(x + (yb - y) * l->slope[c][i], l->low_x[i], l->high_x[i]);
            s->left[c][i] = lesser(a, b);
            s->right[c][i] = greater(a, b);
            s->height[c][i] = yb - ya;
            s->inverse[c][i] = 1.0f / (fabsf(a - b) + 1e-30f);
            turned = (float)(a > b);
            s->left_y[c][i] = (1.0f - turned) * ya + turned * yb - l->t[i];
            s->middle_y[c][i] = 0.5f * (ya + yb) - l->t[i];
            s->rise[c][i] = (1.0f - 2.0f * turned) * (ya - yb);
            off = 2.0f * FAR * (float)(ya == yb);
            s->low[i] = lesser(s->low[i], s->left[c][i] + off);
            s->high[i] = greater(s->high[i], s->right[c][i] - off);
        }
}

INLINE int set_columns(const stretches *restrict s, gnoi_lane_row *restrict out)
{
    int most = 0;
    for (int i = 0; i < GNOI_LANES; i++) {
        float some = (float)(s->low[i] <= s->high[i]);
        out->first[i] = floor_of(some * s->low[i]);
        out->columns[i] = ((int)(floor_of(some * s->high[i]) - out->first[i]) + 1) * (int)some;
    }
    for (int i = 0; i < GNOI_LANES; i++)
        most = out->columns[i] > most ? out->columns[i] : most;
    if (most > GNOI_LANE_COLUMNS) {
        most = GNOI_LANE_COLUMNS;
        for (int i = 0; i < GNOI_LANES; i++)
            out->columns[i] = out->columns[i] < most ? out->columns[i] : most;
    }
    return most;
}

/* Along a stretch u = max(line - x, 0) runs from `near` to `near` + d at its left end, the second part of it over the share f of the stretch.
 * Left of the line, the area is the sum of heights times the mean of u; uneven, of u (1 + gain at the line) - gain_x u^2 / 2. */
INLINE void sum_cells(const gnoi_lanes *restrict l, const stretches *restrict s, int columns, int uneven, gnoi_lane_row *restrict out)
{
    gnoi_lane_values before;
    for (int i = 0; i < GNOI_LANES; i++)
        before[i] = 0;
    for (int c = 0; c < columns; c++)
        for (int i = 0; i < GNOI_LANES; i++) {
            float line = out->first[i] + (float)(c + 1), sum = 0, gain = 1.0f + l->gain_x[i] * (line - l->s[i]);
            for (int e = 0; e < 4; e++) {
                float near = greater(line - s->right[e][i], 0.0f), d = greater(line - s->left[e][i], 0.0f) - near, f = d * s->inverse[e][i];
                float mean = near + 0.5f * d * f;
                if (uneven) {
                    float square = near * (near + d) + d * d * f * (1.0f / 3.0f);
                    float by_y = near * s->middle_y[e][i] + f * d * (0.5f * s->left_y[e][i] - f * s->rise[e][i] * (1.0f / 6.0f));
                    mean = mean * gain + by_y * l->gain_y[i] - 0.5f * square * l->gain_x[i];
                }
                sum += s->height[e][i] * mean;
            }
            out->area[c][i] = sum - before[i];
            before[i] = sum;
        }
}

VECTOR_CLONES void gnoi_lanes_row(const gnoi_lanes *restrict l, int row, gnoi_lane_row *restrict out)
{
    stretches s;
    int columns;
    cut_edges(l, row, &s);
    columns = set_columns(&s, out);
    if (l->uneven)
        sum_cells(l, &s, columns, 1, out);
    else
        sum_cells(l, &s, columns, 0, out);
}
