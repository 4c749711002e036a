/* bump.c -- normals of a surface raised by a function of its point, without raising it.
 *
 * Place in the data flow: derivatives of surface and height, in the object's space -> here -> normal for the lighting model.
 * Everything is taken in the object's space, before its transform: a scaled object carries its bumps along, so that their look does
 * not depend on its size (the chapter's warning: N grows with the square of the scale, the disturbance with the scale alone).
 * Source: Blinn, "Simulation of wrinkled surfaces", 1978; textbook equations 8.6.1 to 8.6.7.
 */
#include "base/vec.h"
#include <gnomon/gnomon_math.h>
#include <stddef.h>

#define LEAST_STEP 1e-6 /* of the pattern's unit: differences over less drown in rounding */

static void store(vec3 v, double out[3])
{
    out[0] = v.x;
    out[1] = v.y;
    out[2] = v.z;
}

void gno_bump_normal(const double qx[3], const double qy[3], double px, double py, double bumped[3])
{
    vec3 x = v3_from(qx), y = v3_from(qy), n = v3_cross(x, y), unit = v3_unit(n);
    n = v3_mad(n, v3_cross(x, unit), py);
    n = v3_mad(n, v3_cross(unit, y), px);
    store(n, bumped);
}

/* The footprint a step aside: the linear numerators of a moved point. */
static gno_footprint moved(const gno_footprint *f, vec3 step)
{
    gno_footprint m = *f;
    m.point[0] += step.x;
    m.point[1] += step.y;
    m.point[2] += step.z;
    m.dx[0] += step.x * f->wx, m.dx[1] += step.y * f->wx, m.dx[2] += step.z * f->wx;
    m.dy[0] += step.x * f->wy, m.dy[1] += step.y * f->wy, m.dy[2] += step.z * f->wy;
    return m;
}

/* Two unit vectors that with n are a right-handed frame. */
static void tangents(vec3 n, vec3 *x, vec3 *y)
{
    vec3 other = fabs(n.x) <= fabs(n.y) && fabs(n.x) <= fabs(n.z) ? v3(1, 0, 0) : fabs(n.y) <= fabs(n.z) ? v3(0, 1, 0) : v3(0, 0, 1);
    *x = v3_unit(v3_cross(other, n));
    *y = v3_cross(n, *x);
}

void gno_bump_procedural(const gno_procedural *procedural, double amount, const gno_footprint *f, const double normal[3], double bumped[3])
{
    vec3 n = v3_from(normal), p = v3_from(f->point), dx = v3_mad(v3_from(f->dx), p, -f->wx), dy = v3_mad(v3_from(f->dy), p, -f->wy), x, y;
    double lx = v3_length(dx), ly = v3_length(dy), step = 0.25 * (lx < ly ? lx : ly), slope[2], qx[3], qy[3];
    double unit = procedural->scale[0], least;
    unit = procedural->scale[1] < unit ? procedural->scale[1] : unit;
    unit = procedural->scale[2] < unit ? procedural->scale[2] : unit;
    least = LEAST_STEP * unit;
    step = step > least ? step : least;
    tangents(n, &x, &y);
    for (int k = 0; k < 2; k++) {
        vec3 t = v3_scale(k ? y : x, step);
        gno_footprint ahead = moved(f, t), behind = moved(f, v3_scale(t, -1));
        slope[k] = amount * unit * (gno_procedural_value(procedural, &ahead) - gno_procedural_value(procedural, &behind)) / (2 * step);
    }
    store(x, qx);
    store(y, qy);
    gno_bump_normal(qx, qy, slope[0], slope[1], bumped);
    store(v3_unit(v3_from(bumped)), bumped);
}

/* ---- tables ------------------------------------------------------------------------------------------------------------ */

static int wrapped(int i, int count, int clamp)
{
    if (clamp)
        return i < 0 ? 0 : i >= count ? count - 1 : i;
    i %= count;
    return i < 0 ? i + count : i;
}

static double value_at(const gno_height_table *t, int i, int j)
{
    return (double)t->values[(size_t)wrapped(j, t->height, t->clamp) * (size_t)t->width + (size_t)wrapped(i, t->width, t->clamp)];
}

/* x, y: in values, value (i,j) at (i,j). */
static double bilinear(const gno_height_table *t, double x, double y)
{
    double fx = floor(x), fy = floor(y), wx = x - fx, wy = y - fy, low, high;
    int i = (int)fx, j = (int)fy;
    low = value_at(t, i, j) * (1 - wx) + value_at(t, i + 1, j) * wx;
    high = value_at(t, i, j + 1) * (1 - wx) + value_at(t, i + 1, j + 1) * wx;
    return low * (1 - wy) + high * wy;
}

/* Where a coordinate lies in the table, brought near it so that it fits an int. */
static double place(double u, int count, int clamp)
{
    if (!(fabs(u) < 1e15))
        u = 0;
    if (!clamp)
        u -= floor(u);
    u = u * count - 0.5;
    return u < -2 ? -2 : u > count + 1.0 ? count + 1.0 : u;
}

double gno_height_at(const gno_height_table *table, double u, double v, double *du, double *dv)
{
    double x = place(u, table->width, table->clamp), y = place(v, table->height, table->clamp);
    if (du)
        *du = (bilinear(table, x + 0.5, y) - bilinear(table, x - 0.5, y)) * table->width;
    if (dv)
        *dv = (bilinear(table, x, y + 0.5) - bilinear(table, x, y - 0.5)) * table->height;
    return bilinear(table, x, y);
}
