/* noise.c -- lattice noise and fractal sums of it.
 *
 * Place in the data flow: a point of the pattern's frame -> here -> a number in [0,1] for procedural.c and for callers.
 * Invariants: values lie in [0,1]; only integers and the four operations of IEEE arithmetic (with floor) are used, so the bits are
 * the same on every machine; octave 0 of a sum is the noise itself.
 * Source: textbook section 8.5 (lattice of random values, Hermite weight); Perlin, "An image synthesizer", 1985 for sums of
 * octaves; Norton, Rockwood and Skolmoski, "Clamping", 1982 for fading them. The hash ends in MurmurHash3's finalizer (Appleby).
 */
#include "shade/noise.h"

#include <math.h>
#include <stddef.h>

#define BIGGEST 1e15     /* beyond, cells are no wider than the spacing of doubles allows to interpolate in */
#define MOST_OCTAVES 16
#define FADE_TO 3.5      /* cells a sample at which an octave has gone; see left_of */

double gnoi_hash_unit(int64_t i, int64_t j, int64_t k, unsigned seed)
{
    uint64_t h = (uint64_t)i * 0x9e3779b97f4a7c15u + (uint64_t)j * 0xc2b2ae3d27d4eb4fu + (uint64_t)k * 0x165667b19e3779f9u +
                 ((uint64_t)seed + 1) * 0xd6e8feb86659fd93u;
    h ^= h >> 33;
    h *= 0xff51afd7ed558ccdu;
    h ^= h >> 33;
    h *= 0xc4ceb9fe1a85ec53u;
    h ^= h >> 33;
    return (double)(h >> 11) / 9007199254740991.0; /* 2^53 - 1 */
}

typedef struct axis {
    int64_t cell;
    double w, slope; /* share of the upper lattice value, and its derivative */
} axis;

static axis axis_at(double x, gno_noise_weight weight)
{
    axis a;
    double floor_x, t;
    if (!(fabs(x) < BIGGEST))
        x = 0;
    floor_x = floor(x);
    t = x - floor_x;
    a.cell = (int64_t)floor_x;
    a.w = weight == GNO_NOISE_LINEAR ? t : t * t * (3 - 2 * t);
    a.slope = weight == GNO_NOISE_LINEAR ? 1 : 6 * t * (1 - t);
    return a;
}

static double mix(double a, double b, double w)
{
    return a + (b - a) * w;
}

static double within_unit(double x)
{
    return x < 0 ? 0 : x > 1 ? 1 : x;
}

double gno_noise_gradient(const double point[3], unsigned seed, gno_noise_weight weight, double gradient[3])
{
    axis x = axis_at(point[0], weight), y = axis_at(point[1], weight), z = axis_at(point[2], weight);
    double row[2][2], row_dx[2][2], plane[2], plane_dx[2], plane_dy[2];
    for (int k = 0; k < 2; k++) {
        for (int j = 0; j < 2; j++) {
            double a = gnoi_hash_unit(x.cell, y.cell + j, z.cell + k, seed);
            double b = gnoi_hash_unit(x.cell + 1, y.cell + j, z.cell + k, seed);
            row[k][j] = mix(a, b, x.w);
            row_dx[k][j] = (b - a) * x.slope;
        }
        plane[k] = mix(row[k][0], row[k][1], y.w);
        plane_dx[k] = mix(row_dx[k][0], row_dx[k][1], y.w);
        plane_dy[k] = (row[k][1] - row[k][0]) * y.slope;
    }
    gradient[0] = mix(plane_dx[0], plane_dx[1], z.w);
    gradient[1] = mix(plane_dy[0], plane_dy[1], z.w);
    gradient[2] = (plane[1] - plane[0]) * z.slope;
    return within_unit(mix(plane[0], plane[1], z.w));
}

double gno_noise(const double point[3], unsigned seed, gno_noise_weight weight)
{
    double gradient[3];
    return gno_noise_gradient(point, seed, weight, gradient);
}

/* The share of an octave that is left when a sample stands for so many of its cells. The share that comes nearest to the mean over
 * a square of that side (covariance over variance, measured) is 0.94, 0.78, 0.55, 0.38, 0.19 for 0.5, 1, 1.6, 2.1, 3.1 cells; this
 * is 0.94, 0.80, 0.56, 0.35, 0.04, and ends. */
static double left_of(double cells)
{
    double t = within_unit(cells / FADE_TO);
    return 1 - t * t * (3 - 2 * t);
}

/* Variance of the noise over space: 1/12 of the lattice values times the mean of w^2 + (1-w)^2 along each axis, which is 26/35
 * for smooth weights and 2/3 for plain ones. */
static double variance_of(gno_noise_weight weight)
{
    double mean = weight == GNO_NOISE_LINEAR ? 2.0 / 3 : 26.0 / 35;
    return mean * mean * mean / 12;
}

double gnoi_fractal_noise(const gno_fractal *fractal, const double point[3], double width, double gradient[3], double *lost)
{
    /* Octaves are moved against each other, lest their lattice points meet. */
    static const double shift[3] = {0.6180339887, 0.4142135624, 0.7320508076};
    int octaves = fractal->octaves < 1 ? 1 : fractal->octaves > MOST_OCTAVES ? MOST_OCTAVES : fractal->octaves;
    double total = 0, sum = 0, slope[3] = {0, 0, 0}, faded = 0, amplitude = 1, frequency = 1;
    for (int i = 0; i < octaves; i++) {
        double left = left_of(width * frequency), g[3] = {0, 0, 0}, value = 0.5, p[3];
        if (left > 0) {
            for (int k = 0; k < 3; k++)
                p[k] = point[k] * frequency + i * shift[k];
            value = gno_noise_gradient(p, fractal->seed + (unsigned)i * 0x9e3779b9u, fractal->weight, g);
        }
        sum += amplitude * (0.5 + left * (value - 0.5));
        for (int k = 0; k < 3; k++)
            slope[k] += amplitude * left * frequency * g[k];
        faded += amplitude * amplitude * (1 - left * left);
        total += amplitude;
        amplitude *= fractal->gain;
        frequency *= fractal->lacunarity;
    }
    for (int k = 0; k < 3 && gradient; k++)
        gradient[k] = slope[k] / total;
    if (lost)
        *lost = faded * variance_of(fractal->weight) / (total * total);
    return within_unit(sum / total);
}

double gno_fractal_noise(const gno_fractal *fractal, const double point[3], double width, double gradient[3])
{
    return gnoi_fractal_noise(fractal, point, width, gradient, NULL);
}

double gnoi_cos_turns(double turns)
{
    double a = fabs(turns - floor(turns + 0.5)), x = 6.283185307179586 * (0.25 - a), x2 = x * x; /* cos 2 pi a = sin x, |x| <= pi/2 */
    double s = 1 - x2 / 210 * (1 - x2 / 272);
    s = 1 - x2 / 156 * s;
    s = 1 - x2 / 110 * s;
    s = 1 - x2 / 72 * s;
    s = 1 - x2 / 42 * s;
    s = 1 - x2 / 20 * s;
    s = 1 - x2 / 6 * s;
    return x * s;
}
