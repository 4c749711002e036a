/* filter_lanes.c -- see filter_lanes.h. */
#include "project/filter_lanes.h"
#include "base/vector.h"
#include <math.h>

#define INLINE static inline __attribute__((always_inline))
#define LEVEL_EDGE 1e-12f /* edges of less height leave no area */
#define LEAST_WIDTH 1e-20f
#define FAR 1e10f

INLINE float within(float v, float low, float high) { return gnoi_lesser(gnoi_greater(v, low), high); }

INLINE float least(gnoi_filter_lane_values v[4], int i) { return gnoi_lesser(gnoi_lesser(v[0][i], v[1][i]), gnoi_lesser(v[2][i], v[3][i])); }
INLINE float largest(gnoi_filter_lane_values v[4], int i) { return gnoi_greater(gnoi_greater(v[0][i], v[1][i]), gnoi_greater(v[2][i], v[3][i])); }

/* Where a line between rows meets the edges: x and y; the nearer end where it does not. */
typedef struct border {
    gnoi_filter_lane_values x[4], y[4];
} border;

/* What a row leaves of the edges: x of the left and of the right end, height with the sign of the turn, y of the left end and of the
 * middle, from t. */
typedef struct stretches {
    gnoi_filter_lane_values left[4], right[4], height[4], left_y[4], middle_y[4];
    gnoi_filter_lane_values low, high; /* least and largest x */
} stretches;

INLINE void find_border(const gnoi_filter_lanes *restrict l, int row, border *restrict b)
{
    for (int e = 0; e < 4; e++)
        for (int i = 0; i < GNOI_FILTER_LANES; i++) {
            b->y[e][i] = within(l->first_row[i] + (float)row, l->y[e][i], l->end_y[e][i]);
            b->x[e][i] = within(l->x[e][i] + (b->y[e][i] - l->y[e][i]) * l->slope[e][i], l->low_x[i], l->high_x[i]);
        }
}

INLINE void cut_edges(const gnoi_filter_lanes *restrict l, const border *restrict from, const border *restrict to, int uneven,
                      stretches *restrict s)
{
    for (int i = 0; i < GNOI_FILTER_LANES; i++) {
        s->low[i] = FAR;
        s->high[i] = -FAR;
    }
    for (int e = 0; e < 4; e++)
        for (int i = 0; i < GNOI_FILTER_LANES; i++) {
            float off = 2.0f * FAR * (float)(from->y[e][i] == to->y[e][i]);
            s->left[e][i] = gnoi_lesser(from->x[e][i], to->x[e][i]);
            s->right[e][i] = gnoi_greater(from->x[e][i], to->x[e][i]);
            s->height[e][i] = l->turn[e][i] * (to->y[e][i] - from->y[e][i]);
            s->low[i] = gnoi_lesser(s->low[i], s->left[e][i] + off);
            s->high[i] = gnoi_greater(s->high[i], s->right[e][i] - off);
        }
    for (int e = 0; e < 4 && uneven; e++)
        for (int i = 0; i < GNOI_FILTER_LANES; i++) {
            s->left_y[e][i] = l->rightward[e][i] * from->y[e][i] + (1.0f - l->rightward[e][i]) * to->y[e][i] - l->t[i];
            s->middle_y[e][i] = 0.5f * (from->y[e][i] + to->y[e][i]) - l->t[i];
        }
}

/* Columns between low and high; returns those of the lane with most. */
INLINE int set_columns(const float *restrict low, const float *restrict high, float *restrict first, int *restrict columns)
{
    int most = 0;
    for (int i = 0; i < GNOI_FILTER_LANES; i++) {
        float some = (float)(low[i] <= high[i]);
        first[i] = gnoi_floor(some * low[i]);
        columns[i] = ((int)(gnoi_floor(some * high[i]) - first[i]) + 1) * (int)some;
    }
    for (int i = 0; i < GNOI_FILTER_LANES; i++)
        most = columns[i] > most ? columns[i] : most;
    if (most > GNOI_LANE_COLUMNS) {
        most = GNOI_LANE_COLUMNS;
        for (int i = 0; i < GNOI_FILTER_LANES; i++)
            columns[i] = columns[i] < most ? columns[i] : most;
    }
    return most;
}

/* The row's own columns where that spares some, those of all rows where the search costs more. */
INLINE void choose_columns(const gnoi_filter_lanes *restrict l, const stretches *restrict s, gnoi_filter_lane_row *restrict out)
{
    if (l->most > GNOI_LANE_FEW_COLUMNS) {
        out->most = set_columns(s->low, s->high, out->first, out->columns);
        return;
    }
    for (int i = 0; i < GNOI_FILTER_LANES; i++) {
        out->first[i] = l->first_column[i];
        out->columns[i] = l->columns[i];
    }
    out->most = l->most;
}

/* Along a stretch u = max(line - x, 0) runs from `near` at its right end to near + d at its left one, the second part of it over twice
 * d half_rise of its height. Left of the line, the area is the sum of heights times the mean of u. */
INLINE float even_sum(const gnoi_filter_lanes *restrict l, const stretches *restrict s, float line, int i)
{
    float sum = 0;
    for (int e = 0; e < 4; e++) {
        float near = gnoi_greater(line, s->right[e][i]) - s->right[e][i], d = within(line, s->left[e][i], s->right[e][i]) - s->left[e][i];
        sum += s->height[e][i] * near + d * (d * l->turned_rise[e][i]);
    }
    return sum;
}

/* Uneven, it is the sum of the integrals of u (1 + gain at the line) - gain_x u^2 / 2. */
INLINE float uneven_sum(const gnoi_filter_lanes *restrict l, const stretches *restrict s, float line, int i)
{
    float part = 0, by_y = 0, square = 0, rest = 0;
    for (int e = 0; e < 4; e++) {
        float near = gnoi_greater(line, s->right[e][i]) - s->right[e][i], d = within(line, s->left[e][i], s->right[e][i]) - s->left[e][i];
        float lean = (1.0f - 2.0f * l->rightward[e][i]) * (2.0f / 3.0f);
        float a = s->height[e][i] * near, b = d * (d * l->turned_rise[e][i]);
        part += a + b;
        by_y += a * s->middle_y[e][i] + b * (s->left_y[e][i] - d * l->half_rise[e][i] * lean);
        square += a * (near + d);
        rest += b * d;
    }
    square = 0.5f * square + rest * (1.0f / 3.0f);
    return part * (1.0f + l->gain_x[i] * (line - l->s[i])) + by_y * l->gain_y[i] - square * l->gain_x[i];
}

INLINE void sum_cells(gnoi_filter_lanes *restrict l, const stretches *restrict s, int uneven, gnoi_filter_lane_row *restrict out)
{
    gnoi_filter_lane_values before;
    for (int i = 0; i < GNOI_FILTER_LANES; i++)
        before[i] = 0;
    for (int c = 0; c < out->most; c++)
        for (int i = 0; i < GNOI_FILTER_LANES; i++) {
            float line = out->first[i] + (float)(c + 1), sum = uneven ? uneven_sum(l, s, line, i) : even_sum(l, s, line, i);
            out->area[c][i] = (sum - before[i]) * (float)(line - 1.0f <= s->high[i]);
            l->weight[i] += out->area[c][i];
            before[i] = sum;
        }
}

INLINE void cover_rows(gnoi_filter_lanes *restrict l, int first, int count, int uneven, gnoi_filter_lane_row *restrict out)
{
    border line[2];
    stretches s;
    find_border(l, first, &line[0]);
    for (int r = 0; r < count; r++) {
        find_border(l, first + r + 1, &line[(r + 1) & 1]);
        cut_edges(l, &line[r & 1], &line[(r + 1) & 1], uneven, &s);
        choose_columns(l, &s, &out[r]);
        sum_cells(l, &s, uneven, &out[r]);
    }
}

/* Areas in the picture go with w^3, which is linear enough over so little. */
INLINE void find_gains(gnoi_filter_lanes *restrict l)
{
    for (int i = 0; i < GNOI_FILTER_LANES; i++) {
        float bend = fabsf(l->wx[i]) + fabsf(l->wy[i]), uneven = (float)(bend > GNOI_EVEN_BEND);
        float k = 3.0f * uneven / (l->sx[i] * l->ty[i] - l->sy[i] * l->tx[i]);
        l->gain_x[i] = k * (l->wx[i] * l->ty[i] - l->wy[i] * l->tx[i]);
        l->gain_y[i] = k * (l->wy[i] * l->sx[i] - l->wx[i] * l->sy[i]);
    }
}

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
        l->first_row[i] = gnoi_floor(least(y, i));
        l->weight[i] = 0;
        l->rows[i] = (int)(gnoi_floor(largest(y, i)) - l->first_row[i]) + 1;
    }
    l->most = set_columns(l->low_x, l->high_x, l->first_column, l->columns);
    for (int c = 0; c < 4; c++)
        for (int i = 0; i < GNOI_FILTER_LANES; i++) {
            float x0 = x[c][i], y0 = y[c][i], x1 = x[(c + 1) & 3][i], y1 = y[(c + 1) & 3][i], down_there = (float)(y0 < y1);
            float dx, dy, level, wide, high, k;
            l->turn[c][i] = 2.0f * down_there - 1.0f;
            l->x[c][i] = down_there * x0 + (1.0f - down_there) * x1;
            l->y[c][i] = gnoi_lesser(y0, y1);
            l->end_y[c][i] = gnoi_greater(y0, y1);
            dx = l->turn[c][i] * (x1 - x0);
            dy = l->end_y[c][i] - l->y[c][i];
            level = (float)(dy < LEVEL_EDGE);
            wide = fabsf(dx) + LEAST_WIDTH;
            high = dy + level;
            k = 1.0f / (wide * high); /* one division for two */
            l->slope[c][i] = (1.0f - level) * dx * (wide * k);
            l->half_rise[c][i] = 0.5f * dy * (high * k);
            l->turned_rise[c][i] = l->turn[c][i] * l->half_rise[c][i];
            l->rightward[c][i] = (float)(dx > 0.0f);
        }
    l->uneven = 0;
    for (int i = 0; i < GNOI_FILTER_LANES; i++)
        l->uneven |= fabsf(l->wx[i]) + fabsf(l->wy[i]) > GNOI_EVEN_BEND;
    if (l->uneven)
        find_gains(l);
}

VECTOR_CLONES static void rows_of(gnoi_filter_lanes *restrict l, int first, int count, gnoi_filter_lane_row *restrict out)
{
    if (l->uneven)
        cover_rows(l, first, count, 1, out);
    else
        cover_rows(l, first, count, 0, out);
}

void gnoi_filter_lanes_start(gnoi_filter_lanes *l)
{
    start(l);
}

void gnoi_filter_lanes_rows(gnoi_filter_lanes *restrict l, int first, int count, gnoi_filter_lane_row *restrict out)
{
    rows_of(l, first, count, out);
}
