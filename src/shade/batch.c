/* batch.c -- see batch.h. */
#include "shade/batch.h"
#include "base/vector.h"
#include <string.h>

#define INLINE static inline __attribute__((always_inline))

/* log2 of a positive normal float: m in [sqrt 1/2, sqrt 2) by the series of atanh, error below 2e-9 + rounding. */
INLINE float log2_of(float x)
{
    union { float f; int32_t i; } u = {x};
    int32_t shifted = u.i - 0x3f3504f3;
    int32_t e = shifted >> 23;
    float m, s, q;
    u.i = (shifted & 0x007fffff) + 0x3f3504f3;
    m = u.f;
    s = (m - 1.0f) / (m + 1.0f);
    q = s * s;
    return (float)e + s * (2.88539008f + q * (0.961796694f + q * (0.577078016f + q * (0.412198583f + q * 0.320598898f))));
}

/* 2^y for y in [-126, 1]. */
INLINE float exp2_of(float y)
{
    float whole = (float)(int32_t)y, f;
    union { float f; int32_t i; } u;
    f = y - whole;
    u.i = ((int32_t)whole + 127) << 23;
    return u.f * (1.0f + f * (0.693147181f + f * (0.240226507f + f * (0.0555041087f + f * (0.00961812911f +
           f * (0.00133335581f + f * (0.000154035304f + f * 0.0000152527338f)))))));
}

/* 1 where a > b, else 0: selections are written as products, for the compiler turns no branch into vector code in all clones. */
INLINE float above(float a, float b) { return (float)(a > b); }

INLINE float power(float x, float n)
{
    float some = above(x, 1e-30f), large, y;
    y = n * log2_of(some * x + (1.0f - some));
    large = above(y, -120.0f);
    y = large * y - (1.0f - large) * 120.0f;
    return some * exp2_of(y);
}

/* Unit normals, unit directions to the viewer and the viewer's distance. */
VECTOR_CLONES static void prepare(gnoi_batch *b, int count, int orthographic, float fx, float fy, float fz)
{
    for (int i = 0; i < count; i++) {
        float k = 1.0f / sqrtf(b->nx[i] * b->nx[i] + b->ny[i] * b->ny[i] + b->nz[i] * b->nz[i] + 1e-30f);
        b->nx[i] *= k;
        b->ny[i] *= k;
        b->nz[i] *= k;
    }
    if (orthographic) {
        for (int i = 0; i < count; i++) {
            b->sx[i] = -fx;
            b->sy[i] = -fy;
            b->sz[i] = -fz;
            b->distance[i] = b->px[i] * fx + b->py[i] * fy + b->pz[i] * fz - b->view_start;
        }
        return;
    }
    for (int i = 0; i < count; i++) {
        float d = sqrtf(b->px[i] * b->px[i] + b->py[i] * b->py[i] + b->pz[i] * b->pz[i]);
        float k = -1.0f / (d + 1e-30f);
        b->sx[i] = b->px[i] * k;
        b->sy[i] = b->py[i] * k;
        b->sz[i] = b->pz[i] * k;
        b->distance[i] = d;
    }
}

typedef struct lamp_values {
    float x, y, z; /* position relative to the eye, or unit direction to the light */
    float r, g, b;
    float k;
} lamp_values;

/* One lamp on all samples. The flags are constants at each call, so that each combination becomes a loop of its own. */
INLINE void add_lamp(gnoi_batch *restrict b, int count, const float *restrict weight, lamp_values v, int directional, gno_falloff falloff,
                     int from_viewer, int smooth)
{
    for (int i = 0; i < count; i++) {
        float lx = v.x, ly = v.y, lz = v.z, f = 1.0f, d = 0.0f, nl, ns, ls, rs, facing, w, diffuse, spec;
        if (!directional) {
            float q;
            lx -= b->px[i];
            ly -= b->py[i];
            lz -= b->pz[i];
            d = sqrtf(lx * lx + ly * ly + lz * lz);
            q = 1.0f / (d + 1e-30f);
            lx *= q;
            ly *= q;
            lz *= q;
        }
        if (falloff == GNO_FALLOFF_LINEAR)
            f = 1.0f / ((from_viewer ? b->distance[i] : d) + v.k);
        else if (falloff == GNO_FALLOFF_INVERSE_SQUARE)
            f = 1.0f / (d * d + 1e-30f);
        nl = b->nx[i] * lx + b->ny[i] * ly + b->nz[i] * lz;
        ns = b->nx[i] * b->sx[i] + b->ny[i] * b->sy[i] + b->nz[i] * b->sz[i];
        ls = lx * b->sx[i] + ly * b->sy[i] + lz * b->sz[i];
        rs = 2.0f * nl * ns - ls;
        facing = above(nl, 0.0f);
        w = weight[i] * f * facing;
        if (smooth) {
            float gl = b->gx[i] * lx + b->gy[i] * ly + b->gz[i] * lz;
            float gn = b->gx[i] * b->nx[i] + b->gy[i] * b->ny[i] + b->gz[i] * b->nz[i];
            float product = nl * gn, some = above(product, 1e-6f), g = gl / (some * product + (1.0f - some) * 1e-6f), over;
            over = above(g, 1.0f);
            g = over + (1.0f - over) * g;
            g *= above(g, 0.0f);
            w *= g * (1.0f + g - g * g);
        }
        diffuse = w * nl;
        spec = w * power(rs, b->shininess[i]);
        b->rgb[0][i] += diffuse * v.r * b->kd[0][i];
        b->rgb[1][i] += diffuse * v.g * b->kd[1][i];
        b->rgb[2][i] += diffuse * v.b * b->kd[2][i];
        b->gloss[0][i] += spec * v.r * b->ks[0][i];
        b->gloss[1][i] += spec * v.g * b->ks[1][i];
        b->gloss[2][i] += spec * v.b * b->ks[2][i];
    }
}

VECTOR_CLONES static void add_point_lamp(gnoi_batch *restrict b, int count, const float *restrict weight, lamp_values v)
{
    add_lamp(b, count, weight, v, 0, GNO_FALLOFF_NONE, 0, 0);
}

VECTOR_CLONES static void add_far_lamp(gnoi_batch *restrict b, int count, const float *restrict weight, lamp_values v)
{
    add_lamp(b, count, weight, v, 1, GNO_FALLOFF_NONE, 0, 0);
}

/* Every other combination of falloff and terminator: rarer, so decided inside the loop. */
VECTOR_CLONES static void add_any_lamp(gnoi_batch *restrict b, int count, const float *restrict weight, lamp_values v, int directional, int falloff,
                                       int from_viewer, int smooth)
{
    add_lamp(b, count, weight, v, directional, (gno_falloff)falloff, from_viewer, smooth);
}

/* A lamp at infinity has no distance of its own: only a falloff from the viewer acts on it. */
static gno_falloff effective_falloff(const gnoi_lamp *lamp)
{
    if (lamp->directional && !(lamp->falloff == GNO_FALLOFF_LINEAR && lamp->distance_from_viewer))
        return GNO_FALLOFF_NONE;
    return lamp->falloff;
}

void gnoi_batch_shade(gnoi_batch *b, const gnoi_view *view, const gnoi_lamp *lamps)
{
    int count = (b->count + 15) & ~15; /* whole vectors; the tail repeats the last sample's storage harmlessly */
    for (int i = b->count; i < count; i++) {
        b->px[i] = b->py[i] = b->pz[i] = b->nx[i] = b->ny[i] = b->nz[i] = b->gx[i] = b->gy[i] = b->gz[i] = 1;
        b->shininess[i] = 1;
        for (int k = 0; k < 3; k++)
            b->kd[k][i] = b->ks[k][i] = b->rgb[k][i] = 0;
    }
    for (int k = 0; k < 3; k++)
        memset(b->gloss[k], 0, (size_t)count * sizeof *b->gloss[k]);
    prepare(b, count, view->orthographic, (float)view->forward.x, (float)view->forward.y, (float)view->forward.z);
    for (int j = 0; j < b->lamp_count; j++) {
        const gnoi_lamp *lamp = &lamps[j];
        float *weight = b->weight + (size_t)j * GNOI_BATCH;
        gno_falloff falloff = effective_falloff(lamp);
        vec3 l = lamp->directional ? lamp->to_light : v3_sub(lamp->position, view->eye);
        lamp_values v;
        int used = 0;
        for (int i = 0; i < b->count && !used; i++)
            used = weight[i] != 0;
        if (!used)
            continue;
        for (int i = b->count; i < count; i++)
            weight[i] = 0;
        v.x = (float)l.x;
        v.y = (float)l.y;
        v.z = (float)l.z;
        v.r = (float)lamp->intensity[0];
        v.g = (float)lamp->intensity[1];
        v.b = (float)lamp->intensity[2];
        v.k = (float)lamp->falloff_k;
        if (falloff != GNO_FALLOFF_NONE || b->smooth_terminator)
            add_any_lamp(b, count, weight, v, lamp->directional, (int)falloff, lamp->distance_from_viewer, b->smooth_terminator);
        else if (lamp->directional)
            add_far_lamp(b, count, weight, v);
        else
            add_point_lamp(b, count, weight, v);
    }
}

void gnoi_shade_point(const gnoi_view *view, const gnoi_lamp *lamp, const gno_material *material, double view_start, vec3 point,
                      vec3 n, double rgb[3])
{
    vec3 to_light = lamp->directional ? lamp->to_light : v3_sub(lamp->position, point);
    vec3 to_eye = view->orthographic ? v3_scale(view->forward, -1) : v3_sub(view->eye, point);
    double d = v3_length(to_light), f = 1, nl, rs, spec;
    double from_viewer = view->orthographic ? gnoi_form_at(&view->depth, point) - view_start : v3_length(to_eye);
    vec3 l = v3_unit(to_light), s = v3_unit(to_eye);
    gno_falloff falloff = effective_falloff(lamp);
    if (falloff == GNO_FALLOFF_LINEAR)
        f = 1 / ((lamp->distance_from_viewer ? from_viewer : d) + lamp->falloff_k);
    else if (falloff == GNO_FALLOFF_INVERSE_SQUARE)
        f = 1 / (d * d + 1e-30);
    nl = v3_dot(n, l);
    if (!(nl > 0))
        return;
    rs = 2 * nl * v3_dot(n, s) - v3_dot(l, s);
    spec = rs > 0 ? (double)power((float)rs, (float)material->shininess) : 0;
    for (int k = 0; k < 3; k++)
        rgb[k] += f * lamp->intensity[k] * (material->diffuse[k] * nl + material->specular[k] * spec);
}
