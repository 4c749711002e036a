/* vec.h -- small value types of three doubles. Place: base; knows nothing. */
#ifndef GNOI_BASE_VEC_H
#define GNOI_BASE_VEC_H

#include <math.h>

typedef struct vec3 {
    double x, y, z;
} vec3;

static inline vec3 v3(double x, double y, double z) { vec3 r; r.x = x; r.y = y; r.z = z; return r; }
static inline vec3 v3_from(const double *p) { return v3(p[0], p[1], p[2]); }
static inline vec3 v3_add(vec3 a, vec3 b) { return v3(a.x + b.x, a.y + b.y, a.z + b.z); }
static inline vec3 v3_sub(vec3 a, vec3 b) { return v3(a.x - b.x, a.y - b.y, a.z - b.z); }
static inline vec3 v3_scale(vec3 a, double s) { return v3(a.x * s, a.y * s, a.z * s); }
static inline vec3 v3_mad(vec3 a, vec3 b, double s) { return v3(a.x + b.x * s, a.y + b.y * s, a.z + b.z * s); }
static inline double v3_dot(vec3 a, vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline vec3 v3_cross(vec3 a, vec3 b)
{
    return v3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
static inline double v3_length(vec3 a) { return sqrt(v3_dot(a, a)); }
/* The unit vector along a; (0,0,0) stays as it is. */
static inline vec3 v3_unit(vec3 a)
{
    double l = v3_length(a);
    return l > 0 ? v3_scale(a, 1 / l) : a;
}

#endif
