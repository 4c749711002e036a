/* procedural.c -- procedural patterns: a colour for every point of space, filtered over the pixel.
 *
 * Place in the data flow: shaded point with its footprint, in the object's space -> here -> factor on diffuse and ambient light.
 *   footprint -> frame of the pattern -> checker, brick: areas (cells.c)
 *                                     -> wood, marble, noise, cloud: a few parts of the pixel where it sees the surface at a
 *                                        slant, each band-limited to its own extent
 * Band-limiting is exact for the rings' sine: its mean over a box is the sine times a sinc, and moved by a normal variable of
 * variance s^2 (noise finer than the pixel) it is the sine times exp(-(2 pi s)^2 / 2).
 * Source: textbook section 8.5 (wood); Perlin 1985 (marble); docs/algorithm.md for the filters.
 */
#include "base/vec.h"
#include "shade/cells.h"
#include "shade/noise.h"

#include <stddef.h>

#define MOST_SAMPLES 16  /* of one pixel */
#define MOST_SHARPNESS 8 /* scene/procedural.c */
#define PI 3.14159265358979323846

/* ---- frame ----------------------------------------------------------------------------------------------------------- */

static void into_frame(const gno_procedural *p, vec3 x, vec3 y, vec3 z, vec3 v, double out[3])
{
    out[0] = v3_dot(v, x) / p->scale[0];
    out[1] = v3_dot(v, y) / p->scale[1];
    out[2] = v3_dot(v, z) / p->scale[2];
}

static gno_footprint in_frame(const gno_procedural *p, const gno_footprint *f)
{
    vec3 z = v3_unit(v3_from(p->axis)), y = v3_unit(v3_cross(z, v3_from(p->across))), x = v3_cross(y, z), origin = v3_from(p->origin);
    gno_footprint out;
    into_frame(p, x, y, z, v3_sub(v3_from(f->point), origin), out.point);
    into_frame(p, x, y, z, v3_mad(v3_from(f->dx), origin, -f->wx), out.dx);
    into_frame(p, x, y, z, v3_mad(v3_from(f->dy), origin, -f->wy), out.dy);
    out.wx = f->wx;
    out.wy = f->wy;
    return out;
}

/* ---- samples of a footprint ------------------------------------------------------------------------------------------ */

/* A part of the footprint: its middle and the two sides that it spans. */
typedef struct sample {
    vec3 point, side1, side2;
    double width; /* the longer side */
} sample;

/* The pixel square cut into columns x rows equal parts, as nearly as the bound allows so that each is seen about as long as broad. */
typedef struct sampling {
    const gno_footprint *f;
    int columns, rows;
} sampling;

static int parts_of(double length, double shortest)
{
    double parts = ceil(length / shortest - 0.01);
    return !(parts > 1) ? 1 : parts < MOST_SAMPLES ? (int)parts : MOST_SAMPLES;
}

static sampling sampling_of(const gno_footprint *f)
{
    vec3 p = v3_from(f->point), dx = v3_mad(v3_from(f->dx), p, -f->wx), dy = v3_mad(v3_from(f->dy), p, -f->wy);
    double xx = v3_dot(dx, dx), yy = v3_dot(dy, dy), longest = 0.5 * (xx + yy) + sqrt(0.25 * (xx - yy) * (xx - yy) + v3_dot(dx, dy) * v3_dot(dx, dy));
    double shortest = v3_length(v3_cross(dx, dy)) / sqrt(longest); /* area over the longest extent */
    sampling k;
    k.f = f;
    k.columns = parts_of(sqrt(xx), shortest);
    k.rows = parts_of(sqrt(yy), shortest);
    while (k.columns * k.rows > MOST_SAMPLES) { /* the side with shorter parts gives way */
        if (k.rows == 1 || (k.columns > 1 && xx * k.rows * k.rows < yy * k.columns * k.columns))
            k.columns--;
        else
            k.rows--;
    }
    return k;
}

/* Part i of the footprint; 0 where the pixel does not see the surface. */
static int sample_at(const sampling *k, int i, sample *out)
{
    const gno_footprint *f = k->f;
    double x = (i % k->columns + 0.5) / k->columns - 0.5, y = (i / k->columns + 0.5) / k->rows - 0.5, w = 1 + x * f->wx + y * f->wy, l1, l2;
    if (!(w > 1e-9))
        return 0;
    out->point = v3_scale(v3_mad(v3_mad(v3_from(f->point), v3_from(f->dx), x), v3_from(f->dy), y), 1 / w);
    out->side1 = v3_scale(v3_mad(v3_from(f->dx), out->point, -f->wx), 1 / (w * k->columns));
    out->side2 = v3_scale(v3_mad(v3_from(f->dy), out->point, -f->wy), 1 / (w * k->rows));
    l1 = v3_length(out->side1);
    l2 = v3_length(out->side2);
    out->width = l1 > l2 ? l1 : l2;
    return 1;
}

/* ---- rings and veins --------------------------------------------------------------------------------------------------- */

static double sinc(double turns)
{
    double x = PI * turns;
    return fabs(x) < 1e-4 ? 1 - x * x / 6 : gnoi_cos_turns(0.5 * turns - 0.25) / x;
}

/* Nearly exp(-x) for x >= 0, as the 32nd power of a rational: it is only a weight, but the same with every C library. */
static double decay(double x)
{
    double d = 1 / (1 + x / 32 + x * x / 2048);
    d *= d;
    d *= d;
    d *= d;
    d *= d;
    return d * d;
}

/* The mean of ((1 + sin 2 pi t)/2)^n where t, in turns, runs over a box of extents a by b and is moved by a normal variable of the
 * given variance: a sum of harmonics, each with its own attenuation. */
static double ring_profile(double t, int n, double a, double b, double variance)
{
    double binomial = 1, sum, scale = 1; /* C(2n, n-k), from k = n down */
    double terms[MOST_SHARPNESS + 1] = {0};
    for (int k = n; k >= 0; k--) {
        terms[k] = binomial;
        binomial = binomial * (n + k) / (n - k + 1);
        scale *= k > 0 ? 0.25 : 1;
    }
    sum = terms[0];
    for (int k = 1; k <= n; k++)
        sum += 2 * terms[k] * gnoi_cos_turns(k * (t - 0.25)) * sinc(k * a) * sinc(k * b) * decay(2 * PI * PI * k * k * variance);
    sum *= scale;
    return sum < 0 ? 0 : sum > 1 ? 1 : sum;
}

/* Noise that moves rings or veins by up to `distortion` turns each way: value and gradient added to turns and slope; returns the
 * variance, in turns, of what was too fine for the sample. */
static double distort(const gno_procedural *p, const sample *s, const double frequency[3], double *turns, double slope[3])
{
    double q[3] = {s->point.x * frequency[0], s->point.y * frequency[1], s->point.z * frequency[2]}, gradient[3], lost, amplitude;
    double widest = frequency[0] > frequency[2] ? frequency[0] : frequency[2];
    if (!(p->distortion > 0))
        return 0;
    amplitude = 2 * p->distortion;
    *turns += amplitude * (gnoi_fractal_noise(&p->fractal, q, s->width * widest, gradient, &lost) - 0.5);
    for (int k = 0; k < 3; k++)
        slope[k] += amplitude * frequency[k] * gradient[k];
    return amplitude * amplitude * lost;
}

static double along(const double slope[3], vec3 side)
{
    return slope[0] * side.x + slope[1] * side.y + slope[2] * side.z;
}

/* Rings wobble over some ring widths, and eight times as slowly along the trunk. */
static double wood_at(const gno_procedural *p, const sample *s)
{
    double frequency[3] = {0.25 * p->rings, 0.25 * p->rings, 0.03125 * p->rings};
    double r = sqrt(s->point.x * s->point.x + s->point.y * s->point.y), turns = p->rings * r, lost, f;
    double slope[3] = {r > 0 ? p->rings * s->point.x / r : 0, r > 0 ? p->rings * s->point.y / r : 0, 0};
    lost = distort(p, s, frequency, &turns, slope);
    f = ring_profile(turns, p->sharpness, along(slope, s->side1), along(slope, s->side2), lost);
    if (p->grain > 0) {
        gno_fractal fibres = p->fractal;
        double dense = 6 * p->rings, q[3] = {s->point.x * dense, s->point.y * dense, s->point.z * dense / 24};
        fibres.octaves = 2;
        fibres.seed = p->fractal.seed + 0x5bd1e995u;
        f = f * (1 - p->grain) + p->grain * gno_fractal_noise(&fibres, q, s->width * dense, NULL);
    }
    return f;
}

static double marble_at(const gno_procedural *p, const sample *s)
{
    double frequency[3] = {p->rings, p->rings, p->rings}, turns = p->rings * s->point.x, slope[3] = {p->rings, 0, 0}, lost;
    lost = distort(p, s, frequency, &turns, slope);
    return ring_profile(turns, p->sharpness, along(slope, s->side1), along(slope, s->side2), lost);
}

/* ---- noise and clouds ------------------------------------------------------------------------------------------------- */

static double noise_at(const gno_procedural *p, const sample *s, double *lost)
{
    double q[3] = {s->point.x, s->point.y, s->point.z};
    return gnoi_fractal_noise(&p->fractal, q, s->width, NULL, lost);
}

/* 1 - density: the noise through a steep step, made less steep by what has faded, for a mean of steps is a wider one. */
static double cloud_at(const gno_procedural *p, const sample *s)
{
    double lost, n = noise_at(p, s, &lost), middle = 0.8 - 0.6 * p->cover, half = sqrt(0.01 + 5 * lost), t = (n - middle) / (2 * half) + 0.5;
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    return 1 - t * t * (3 - 2 * t);
}

static double smooth_value(const gno_procedural *p, const gno_footprint *f)
{
    sampling k = sampling_of(f);
    double sum = 0, lost;
    int seen = 0;
    for (int i = 0; i < k.columns * k.rows; i++) {
        sample s;
        if (!sample_at(&k, i, &s))
            continue;
        seen++;
        sum += p->pattern == GNO_PATTERN_WOOD     ? wood_at(p, &s)
               : p->pattern == GNO_PATTERN_MARBLE ? marble_at(p, &s)
               : p->pattern == GNO_PATTERN_CLOUD  ? cloud_at(p, &s)
                                                  : noise_at(p, &s, &lost);
    }
    return seen ? sum / seen : 0.5;
}

/* ---- bricks ------------------------------------------------------------------------------------------------------------ */

/* The two axes of the frame that a face shows its bricks in: by the axis that it looks along, which a rounding error at 45
 * degrees must not decide. */
static gnoi_bricks bricks_of(const gno_procedural *p, const gno_footprint *f)
{
    vec3 at = v3_from(f->point), n = v3_cross(v3_mad(v3_from(f->dx), at, -f->wx), v3_mad(v3_from(f->dy), at, -f->wy));
    double nx = fabs(n.x) / p->scale[0], ny = fabs(n.y) / p->scale[1], nz = fabs(n.z) / p->scale[2];
    gnoi_bricks b;
    b.along = 0;
    b.up = 2;
    b.length = p->brick[0];
    b.height = p->brick[2];
    if (nz > 1.001 * nx && nz > 1.001 * ny) {
        b.up = 1;
        b.height = p->brick[1];
    } else if (nx > 1.001 * ny) {
        b.along = 1;
    }
    b.mortar = p->mortar;
    b.seed = p->fractal.seed;
    return b;
}

/* Footprints of no finite size give no number: the middle, then. */
static double sane(double value, double most)
{
    return !(value >= 0) ? (value < 0 ? 0 : most / 2) : value < most ? value : most;
}

/* ---- the whole --------------------------------------------------------------------------------------------------------- */

double gno_procedural_value(const gno_procedural *p, const gno_footprint *footprint)
{
    gno_footprint f = in_frame(p, footprint);
    if (p->pattern == GNO_PATTERN_CHECKER)
        return sane(gnoi_checker_share(&f), 1);
    if (p->pattern == GNO_PATTERN_BRICK) {
        double tint;
        gnoi_bricks bricks = bricks_of(p, &f);
        return sane(gnoi_brick_share(&bricks, &f, &tint), 1);
    }
    return sane(smooth_value(p, &f), 1);
}

void gno_procedural_colour(const gno_procedural *p, const gno_footprint *footprint, double rgb[3])
{
    double mortar = 0, light, dark;
    if (p->pattern == GNO_PATTERN_BRICK) {
        gno_footprint f = in_frame(p, footprint);
        gnoi_bricks bricks = bricks_of(p, &f);
        double share = sane(gnoi_brick_share(&bricks, &f, &dark), 1);
        dark = sane(dark, share);
        mortar = 1 - share;
        light = share - dark;
    } else {
        dark = gno_procedural_value(p, footprint);
        light = 1 - dark;
    }
    for (int k = 0; k < 3; k++)
        rgb[k] = light * p->light[k] + dark * p->dark[k] + mortar * p->mortar_colour[k];
}
