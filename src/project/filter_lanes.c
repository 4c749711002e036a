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

INLINE float least(gnoi_filter_lane_values v[4], int i) { return lesser(lesser(v[0][i], v[1][i]), lesser(v[2][i], v[3][i])); }
INLINE float largest(gnoi_filter_lane_values v[4], int i) { return greater(greater(v[0][i], v[1][i]), greater(v[2][i], v[3][i])); }

/* Clones are exported by whatever name they have unless they are static: hence the functions below. */
VECTOR_CLONES static void start(gnoi_filter_lanes *l)
{
    static const float across[4] = {-0.5f, 0.5f, 0.5f, -0.5f}, down[4] = {-0.5f, -0.5f, 0.5f, 0.5f};
    gnoi_filter_lane_values x[4], y[4];
    for (int c = 0; c < 4; c++)
        for (int i = 0; i < GNOI_FILTER_LANES; i++) {
            float k = 1.0f / (1.0f + l->wx[i] * across[c] + l->wy[i] * down[c]);
            x[c][i] = l->s[i] + (l->sx[i] * across[c] + l->sy[i] * down[c]) * k;
            y[c][i] = l->t[i] + (l->tx[i] * across[c] + l->ty[i] * down[c]) * k;
        }
    for (int i = 0; i < GNOI_FILTER_LANES; i++) {
        l->low_x[i] = least(x, i);
        l->high_x[i] = largest(x, i);
        l->first_row[i] = floor_of(least(y, i));
        l->rows[i] = (int)(floor_of(largest(y, i)) - l->first_row[i]) + 1;
    }
    for (int c = 0; c < 4; c++)
        for (int i = 0; i < GNOI_FILTER_LANES; i++) {
            float x0 = x[c][i], y0 = y[c][i], x1 = x[(c + 1) & 3][i], y1 = y[(c + 1) & 3][i], down_there = (float)(y0 < y1), dx, dy, level;
            l->turn[c][i] = 2.0f * down_there - 1.0f;
            l->x[c][i] = down_there * x0 + (1.0f - down_there) * x1;
            l->y[c][i] = lesser(y0, y1);
            l->end_y[c][i] = greater(y0, y1);
            dx = l->turn[c][i] * (x1 - x0);
            dy = l->end_y[c][i] - l->y[c][i];
            level = (float)(dy < LEVEL_EDGE);
            l->slope[c][i] = (1.0f - level) * dx / (dy + level);
            l->rise[c][i] = dy / (fabsf(dx) + 1e-30f);
            l->rightward[c][i] = (float)(dx > 0.0f);
        }
    /* Areas in the picture go with w^3, which is linear enough over so little. */
    l->uneven = 0;
    for (int i = 0; i < GNOI_FILTER_LANES; i++) {
        float bend = fabsf(l->wx[i]) + fabsf(l->wy[i]), uneven = (float)(bend > GNOI_EVEN_BEND);
        float k = 3.0f * uneven / (l->sx[i] * l->ty[i] - l->sy[i] * l->tx[i]);
        l->gain_x[i] = k * (l->wx[i] * l->ty[i] - l->wy[i] * l->tx[i]);
        l->gain_y[i] = k * (l->wy[i] * l->sx[i] - l->wx[i] * l->sy[i]);
    }
    for (int i = 0; i < GNOI_FILTER_LANES; i++)
        l->uneven |= l->gain_x[i] != 0 || l->gain_y[i] != 0;
}

/* What a row leaves of the edges: x of the left and of the right end, height, y of the left end and of the middle, from t. */
typedef struct stretches {
    gnoi_filter_lane_values left[4], right[4], height[4], left_y[4], middle_y[4];
    gnoi_filter_lane_values low, high; /* least and largest x */
} stretches;

INLINE void cut_edges(const gnoi_filter_lanes *restrict l, int row, int uneven, stretches *restrict s)
{
    for (int i = 0; i < GNOI_FILTER_LANES; i++) {
        s->low[i] = FAR;
        s->high[i] = -FAR;
    }
    for (int e = 0; e < 4; e++)
        for (int i = 0; i < GNOI_FILTER_LANES; i++) {
            float top = l->first_row[i] + (float)row, a, b, off;
            float from = within(l->y[e][i], top, top + 1.0f), to = within(l->end_y[e][i], top, top + 1.0f);
            a = within(l->x[e][i] + (from - l->y[e][i]) * l->slope[e][i], l->low_x[i], l->high_x[i]);
            b = within(l->x[e][i] + (to - l->y[e][i]) * l->slope[e][i], l->low_x[i], l->high_x[i]);
            s->left[e][i] = lesser(a, b);
            s->right[e][i] = greater(a, b);
            s->height[e][i] = to - from;
            if (uneven) {
                s->left_y[e][i] = l->rightward[e][i] * from + (1.0f - l->rightward[e][i]) * to - l->t[i];
                s->middle_y[e][i] = 0.5f * (from + to) - l->t[i];
            }
            off = 2.0f * FAR * (float)(from == to);
            s->low[i] = lesser(s->low[i], s->left[e][i] + off);
            s->high[i] = greater(s->high[i], s->right[e][i] - off);
        }
}

INLINE void set_columns(const stretches *restrict s, gnoi_filter_lane_row *restrict out)
{
    int most = 0;
    for (int i = 0; i < GNOI_FILTER_LANES; i++) {
        float some = (float)(s->low[i] <= s->high[i]);
        out->first[i] = floor_of(some * s->low[i]);
        out->columns[i] = ((int)(floor_of(some * s->high[i]) - out->first[i]) + 1) * (int)some;
    }
    for (int i = 0; i < GNOI_FILTER_LANES; i++)
        most = out->columns[i] > most ? out->columns[i] : most;
    if (most > GNOI_LANE_COLUMNS) {
        most = GNOI_LANE_COLUMNS;
        for (int i = 0; i < GNOI_FILTER_LANES; i++)
            out->columns[i] = out->columns[i] < most ? out->columns[i] : most;
    }
    out->most = most;
}

/* Along a stretch u = max(line - x, 0) runs from `near` at its right end to near + d at its left one, the second part of it over so much
 * of its height. Left of the line, the area is the sum of heights times the mean of u; uneven, of u (1 + gain at the line) - gain_x u^2 / 2. */
INLINE void sum_cells(const gnoi_filter_lanes *restrict l, const stretches *restrict s, int uneven, gnoi_filter_lane_row *restrict out)
{
    gnoi_filter_lane_values before;
    for (int i = 0; i < GNOI_FILTER_LANES; i++)
        before[i] = 0;
    for (int c = 0; c < out->most; c++)
        for (int i = 0; i < GNOI_FILTER_LANES; i++) {
            float line = out->first[i] + (float)(c + 1), sum = 0, gain = 1.0f + l->gain_x[i] * (line - l->s[i]);
            for (int e = 0; e < 4; e++) {
                float height = s->height[e][i], wide = greater(line - s->left[e][i], 0.0f), near = greater(line - s->right[e][i], 0.0f);
                float d = wide - near, over = lesser(wide * l->rise[e][i], height), part = height * near + 0.5f * d * over;
                if (uneven) {
                    float lean = 1.0f - 2.0f * l->rightward[e][i], square = height * near * (near + d) + d * d * over * (1.0f / 3.0f);
                    float by_y = height * near * s->middle_y[e][i] + over * d * (0.5f * s->left_y[e][i] - over * lean * (1.0f / 6.0f));
                    part = part * gain + by_y * l->gain_y[i] - 0.5f * square * l->gain_x[i];
                }
                sum += l->turn[e][i] * part;
            }
            out->area[c][i] = (sum - before[i]) * (float)(c < out->columns[i]);
            before[i] = sum;
        }
}

INLINE void cover_row(const gnoi_filter_lanes *restrict l, int row, int uneven, gnoi_filter_lane_row *restrict out)
{
    stretches s;
    cut_edges(l, row, uneven, &s);
    set_columns(&s, out);
    sum_cells(l, &s, uneven, out);
}

VECTOR_CLONES static void row_of(const gnoi_filter_lanes *restrict l, int row, gnoi_filter_lane_row *restrict out)
{
    if (l->uneven)
        cover_row(l, row, 1, out);
    else
        cover_row(l, row, 0, out);
}

void gnoi_filter_lanes_start(gnoi_filter_lanes *l)
{
    start(l);
}

void gnoi_filter_lanes_row(const gnoi_filter_lanes *restrict l, int row, gnoi_filter_lane_row *restrict out)
{
    row_of(l, row, out);
}
