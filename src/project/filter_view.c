/* filter_view.c -- see filter_view.h. */
#include "project/filter_view.h"
#include "base/vector.h"
#include "project/filter_lanes.h"
#include <math.h>

#define INLINE static inline __attribute__((always_inline))
#define ABOVE_ALL 1073741824.0 /* GNOI_FAR_ELEMENTS, yet less than half of int's range */
#define STEP 16 /* pixels of a whole vector */

/* Pixels as they lie on their pictures: places in patterns, 0 where they are not plain, and extents in
 * elements. */
typedef struct squares {
    double s[GNOI_VIEWS], t[GNOI_VIEWS], sx[GNOI_VIEWS], sy[GNOI_VIEWS], tx[GNOI_VIEWS], ty[GNOI_VIEWS], wx[GNOI_VIEWS], wy[GNOI_VIEWS];
    double plain[GNOI_VIEWS];  /* 1 or 0 */
} squares;

/* Up to 1e-7 more than the floor: either is as good here. Without comparison, which not every machine has for this in vectors. */
INLINE double floor_near(double v)
{
    return (double)(int)(v + ABOVE_ALL) - ABOVE_ALL;
}

/* A place, given in patterns, in elements of the first one, or of the first two; of which there are `elements` in each. */
INLINE double home(double v, double period, double elements)
{
    double share = period > 1.5 ? 0.5 : period;
    return (v - period * floor_near(v * share)) * elements;
}

VECTOR_CLONES static void find_squares(const gnoi_views *restrict a, int count, squares *restrict q)
{
    for (int i = 0; i < count; i++) {
        double k = 1 / a->w[i], s = a->s[i] * k, t = a->t[i] * k, across = k * a->width[i], up = k * a->height[i];
        q->s[i] = s;
        q->t[i] = t;
        q->sx[i] = (a->sx[i] - s * a->wx[i]) * across;
        q->sy[i] = (a->sy[i] - s * a->wy[i]) * across;
        q->tx[i] = (a->tx[i] - t * a->wx[i]) * up;
        q->ty[i] = (a->ty[i] - t * a->wy[i]) * up;
        q->wx[i] = a->wx[i] * k;
        q->wy[i] = a->wy[i] * k;
    }
    for (int i = 0; i < count; i++) {
        double wide = fabs(q->sx[i]) + fabs(q->sy[i]), high = fabs(q->tx[i]) + fabs(q->ty[i]), length = wide * wide + high * high;
        double turn = fabs(q->sx[i] * q->ty[i] - q->sy[i] * q->tx[i]), bend = fabs(q->wx[i]) + fabs(q->wy[i]);
        double plain = a->period[i] >= 0 ? 1 : 0;
        plain = a->w[i] > 0 ? plain : 0;
        plain = (wide + 1) * (high + 1) <= GNOI_FEW_CELLS ? plain : 0;
        plain = wide <= GNOI_MOST_COLUMNS ? plain : 0;
        plain = turn > GNOI_LEAST_TURN * length ? plain : 0;
        plain = length > GNOI_LEAST_LENGTH * GNOI_LEAST_LENGTH ? plain : 0;
        plain = bend < 2.1 * GNOI_MOST_BEND ? plain : 0;
        plain = fabs(q->s[i]) * a->width[i] < GNOI_FAR_ELEMENTS ? plain : 0;
        plain = fabs(q->t[i]) * a->height[i] < GNOI_FAR_ELEMENTS ? plain : 0;
        q->plain[i] = plain;
    }
    for (int i = 0; i < count; i++) {
        q->s[i] = q->plain[i] > 0 ? q->s[i] : 0;
        q->t[i] = q->plain[i] > 0 ? q->t[i] : 0;
    }
}

VECTOR_CLONES static void find_looks(const gnoi_views *restrict a, int count, const squares *restrict q, gnoi_look_lanes *restrict l, int first)
{
    float plain[GNOI_VIEWS];
    for (int i = 0; i < count; i++) {
        int j = first + i;
        double s = home(q->s[i], a->period[i], a->width[i]), t = home(q->t[i], a->period[i], a->height[i]);
        double column = floor_near(s + 0.5), row = floor_near(t + 0.5);
        l->column[j] = (int)column;
        l->row[j] = (int)row;
        l->s[j] = (float)(s - column);
        l->t[j] = (float)(t - row);
        l->wx[j] = (float)q->wx[i];
        l->wy[j] = (float)q->wy[i];
    }
    for (int i = 0; i < count; i++) {
        int j = first + i;
        l->sx[j] = (float)q->sx[i];
        l->sy[j] = (float)q->sy[i];
        l->tx[j] = (float)q->tx[i];
        l->ty[j] = (float)q->ty[i];
    }
    for (int i = 0; i < count; i++)
        plain[i] = (float)q->plain[i];
    for (int i = 0; i < count; i++) {
        int j = first + i;
        float kind = (float)gnoi_look_kind(l->s[j], l->t[j], fabsf(l->sx[j]) + fabsf(l->sy[j]), fabsf(l->tx[j]) + fabsf(l->ty[j]), fabsf(l->wx[j]) + fabsf(l->wy[j]));
        l->kind[j] = (int)(plain[i] * (kind + 1.0f)) - 1;
    }
}

/* Whole vectors have to be numbers. */
static void pad(gnoi_views *a, int count)
{
    for (int i = count; i % STEP != 0; i++) {
        a->s[i] = a->t[i] = 0;
        a->sx[i] = a->ty[i] = a->w[i] = a->width[i] = a->height[i] = 1;
        a->sy[i] = a->tx[i] = a->wx[i] = a->wy[i] = a->period[i] = 0;
    }
}

INLINE void set_some(gnoi_views *restrict v, int first, int count, const gnoi_pattern *restrict pattern, double x, double y, const gnoi_view_extent *restrict extent)
{
    const gnoi_pattern p = *pattern;
    const gnoi_view_extent e = *extent;
    for (int i = 0; i < count; i++) {
        v->s[first + i] = gnoi_plane_at(&p.s, x + i, y);
        v->t[first + i] = gnoi_plane_at(&p.t, x + i, y);
        v->w[first + i] = gnoi_plane_at(&p.w, x + i, y);
        v->sx[first + i] = p.s.fx;
        v->sy[first + i] = p.s.fy;
        v->tx[first + i] = p.t.fx;
        v->ty[first + i] = p.t.fy;
        v->wx[first + i] = p.w.fx;
        v->wy[first + i] = p.w.fy;
        v->width[first + i] = e.width;
        v->height[first + i] = e.height;
        v->period[first + i] = e.period;
    }
}

VECTOR_CLONES static void set_run(gnoi_views *restrict v, int first, const gnoi_pattern *restrict pattern, double x, double y,
                                  const gnoi_view_extent *restrict extent)
{
    set_some(v, first, GNOI_VIEW_RUN, pattern, x, y, extent);
}

void gnoi_views_set(gnoi_views *v, int first, int count, const gnoi_pattern *pattern, double x, double y, const gnoi_view_extent *extent)
{
    if (count == 1)
        set_some(v, first, 1, pattern, x, y, extent);
    else
        set_run(v, first, pattern, x, y, extent);
}

void gnoi_views_take(gnoi_views *views, int count, gnoi_look_lanes *looks, int first)
{
    int whole = (count + STEP - 1) / STEP * STEP;
    squares q;
    pad(views, count);
    find_squares(views, whole, &q);
    find_looks(views, whole, &q, looks, first);
}
