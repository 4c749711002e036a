/* reflect.c -- mirror and refracted directions.
 *
 * Place in the data flow: incoming direction and normal -> here -> direction that goes on. Pure functions, public.
 * The chapter derives the reflection vector four times; all four are here, so that each can be held against the others. Its first
 * two work in a frame made to fit, in which they are one line; here the frame is made, and the result turned back.
 * Source: textbook equations 8.1.11 to 8.1.31.
 */
#include "base/vec.h"
#include <gnomon/gnomon_math.h>

/* An orthonormal frame whose third axis is the unit vector z. */
typedef struct frame {
    vec3 x, y, z;
} frame;

static frame frame_about(vec3 z)
{
    frame f;
    /* The coordinate axis farthest from z. */
    vec3 other = fabs(z.x) <= fabs(z.y) && fabs(z.x) <= fabs(z.z) ? v3(1, 0, 0) : fabs(z.y) <= fabs(z.z) ? v3(0, 1, 0) : v3(0, 0, 1);
    f.z = z;
    f.x = v3_unit(v3_cross(other, z));
    f.y = v3_cross(z, f.x);
    return f;
}

static vec3 into(const frame *f, vec3 v)
{
    return v3(v3_dot(v, f->x), v3_dot(v, f->y), v3_dot(v, f->z));
}

static void give_back(const frame *f, vec3 v, double out[3])
{
    vec3 r = v3_add(v3_add(v3_scale(f->x, v.x), v3_scale(f->y, v.y)), v3_scale(f->z, v.z));
    out[0] = r.x;
    out[1] = r.y;
    out[2] = r.z;
}

void gno_reflect_light_axis(const double incoming[3], const double normal[3], double reflected[3])
{
    frame f = frame_about(v3_scale(v3_from(incoming), -1));
    vec3 n = into(&f, v3_from(normal));
    give_back(&f, v3(2 * n.x * n.z, 2 * n.y * n.z, 2 * n.z * n.z - 1), reflected); /* 8.1.16, 8.1.15, and R_z before 8.1.12 */
}

void gno_reflect_normal_axis(const double incoming[3], const double normal[3], double reflected[3])
{
    frame f = frame_about(v3_from(normal));
    vec3 l = into(&f, v3_scale(v3_from(incoming), -1)); /* to the light */
    give_back(&f, v3(-l.x, -l.y, l.z), reflected);      /* 8.1.17 */
}

/* With C = L x n and s = L.n the system reads n x R = C, n.R = s. One of the first three equations follows from the others: where n_k
 * is the largest component of n, the two equations that hold n_k R_i and n_k R_j give these two by R_k, and the dot product R_k. */
void gno_reflect_linear_system(const double incoming[3], const double normal[3], double reflected[3])
{
    vec3 n = v3_from(normal), l = v3_scale(v3_from(incoming), -1), cross = v3_cross(l, n);
    double a[3] = {n.x, n.y, n.z}, c[3] = {cross.x, cross.y, cross.z}, s = v3_dot(l, n), r[3];
    int k = fabs(a[0]) >= fabs(a[1]) && fabs(a[0]) >= fabs(a[2]) ? 0 : fabs(a[1]) >= fabs(a[2]) ? 1 : 2, i = (k + 1) % 3, j = (k + 2) % 3;
    /* (n x R)_j = n_k R_i - n_i R_k = C_j;  (n x R)_i = n_j R_k - n_k R_j = C_i;  n_i R_i + n_j R_j + n_k R_k = s  */
    r[k] = (s * a[k] - a[i] * c[j] + a[j] * c[i]) / (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    r[i] = (c[j] + a[i] * r[k]) / a[k];
    r[j] = (a[j] * r[k] - c[i]) / a[k];
    reflected[0] = r[0];
    reflected[1] = r[1];
    reflected[2] = r[2];
}

void gno_reflect(const double incoming[3], const double normal[3], double reflected[3])
{
    vec3 l = v3_from(incoming), n = v3_from(normal), r = v3_mad(l, n, -2 * v3_dot(l, n));
    reflected[0] = r.x;
    reflected[1] = r.y;
    reflected[2] = r.z;
}

int gno_refract(const double incoming[3], const double normal[3], double eta, double refracted[3])
{
    vec3 l = v3_from(incoming), n = v3_from(normal), t;
    double c = -v3_dot(l, n), root;
    if (c < 0) {
        n = v3_scale(n, -1);
        c = -c;
    }
    root = 1 - eta * eta * (1 - c * c);
    t = root >= 0 ? v3_mad(v3_scale(l, eta), n, eta * c - sqrt(root)) : v3(0, 0, 0);
    refracted[0] = t.x;
    refracted[1] = t.y;
    refracted[2] = t.z;
    return root >= 0;
}

double gno_similarity_dimension(double growth, double magnification)
{
    return log(growth) / log(magnification);
}
