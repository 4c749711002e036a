/* gnomon_math.h -- the surface mathematics of gnomon as pure functions: mirror and refracted directions, noise, procedural
 * patterns, bumps.
 *
 * No call here needs a context or a scene, allocates, fails or keeps state; all may be called from any thread. Needs libm alone.
 * Compiles as C89 to C17 and C++98 to C++17. gnomon.h includes it.
 * Equation numbers are those of the textbook chapter that docs/bibliography.md names.
 */
#ifndef GNOMON_GNOMON_MATH_H
#define GNOMON_GNOMON_MATH_H

#ifdef __cplusplus
extern "C" {
#endif

#ifndef GNO_API
#if defined(__GNUC__) && __GNUC__ >= 4
#define GNO_API __attribute__((visibility("default")))
#else
#define GNO_API
#endif
#endif

/* ---- mirror and refracted directions ---------------------------------------------------------------------------- */

/* The direction in which light travelling along `incoming` leaves a mirror of unit normal `normal` (either side of it). Both
 * are unit vectors; so is the result. The four derivations of the chapter give the same vector; the renderer uses the last.
 * `reflected` may be one of the arguments. */

/* Phong's: in a frame whose z axis points to the light (8.1.15, 8.1.16), turned back. */
GNO_API void gno_reflect_light_axis(const double incoming[3], const double normal[3], double reflected[3]);

/* In a frame whose z axis is the normal (8.1.17), turned back. */
GNO_API void gno_reflect_normal_axis(const double incoming[3], const double normal[3], double reflected[3]);

/* The linear system of equal cross products (8.1.18) and equal dot products (8.1.19), solved. */
GNO_API void gno_reflect_linear_system(const double incoming[3], const double normal[3], double reflected[3]);

/* R = L - 2 (L.N) N (8.1.24). */
GNO_API void gno_reflect(const double incoming[3], const double normal[3], double reflected[3]);

/* The direction in which light goes on behind a surface, eta = eta1/eta2 being the index of refraction where it comes from over
 * that where it goes to, > 0 (8.1.25 to 8.1.31): T = eta L + (eta c - sqrt(1 - eta^2 (1 - c^2))) N with c = -L.N. The normal
 * may point to either side; all vectors are unit. Returns 1; 0 on total internal reflection, `refracted` being zero then. */
GNO_API int gno_refract(const double incoming[3], const double normal[3], double eta, double refracted[3]);

/* H = log G / log A: the dimension of a set that holds `growth` G times as much when magnified A times, both > 0, A not 1.
 * gno_fractal_dimension in gnomon.h measures a set of points. */
GNO_API double gno_similarity_dimension(double growth, double magnification);

/* ---- noise --------------------------------------------------------------------------------------------------------- */

/* Weight of a lattice value at distance t along an axis: 1 - W(t), W(t) = 3t^2 - 2t^3, whose slope vanishes at both ends; or
 * the plain 1 - t, continuous in value only. */
typedef enum gno_noise_weight { GNO_NOISE_SMOOTH = 0, GNO_NOISE_LINEAR = 1 } gno_noise_weight;

/* Lattice noise R(x,y,z) in [0,1]: independent values, uniform in [0,1], at the points of integer coordinates, interpolated over
 * the cells. Continuous, with smooth weights its first derivative too. Integers and IEEE arithmetic alone: the same bits on
 * every machine. Coordinates of 1e15 and beyond, and those that are not numbers, count as 0. */
GNO_API double gno_noise(const double point[3], unsigned seed, gno_noise_weight weight);

/* The same value, and its analytic gradient. */
GNO_API double gno_noise_gradient(const double point[3], unsigned seed, gno_noise_weight weight, double gradient[3]);

/* A sum of noises, each octave finer by `lacunarity` and weaker by `gain` than the one before, divided by the sum of weights. */
typedef struct gno_fractal {
    int octaves;       /* 1 to 16 (others are taken as the nearest); default 5 */
    double gain;       /* in (0,1]; default 0.5 */
    double lacunarity; /* > 1; default 2 */
    unsigned seed;     /* each octave makes one of its own of it; default 0 */
    gno_noise_weight weight;
} gno_fractal;

GNO_API gno_fractal gno_fractal_default(void);

/* The sum at a point, in [0,1]. `width`: the extent that one sample stands for (0: none). Octaves fade to their mean, 1/2, as it
 * passes their cells, about as much as the mean over that extent would, and are gone at 3.5 cells; so sums sampled that far apart
 * do not alias. gradient (may be NULL): its derivatives, the width held. */
GNO_API double gno_fractal_noise(const gno_fractal *fractal, const double point[3], double width, double gradient[3]);

/* ---- what one pixel sees of a surface ------------------------------------------------------------------------------- */

/* The point seen at (x,y) of the pixel square [-1/2,1/2]^2 is (point + x dx + y dy) / (1 + x wx + y wy): exact for a plane in
 * perspective. Zero dx, dy, wx, wy: the point alone. Parts of the square where the divisor is not positive are left out. */
typedef struct gno_footprint {
    double point[3];
    double dx[3], dy[3];
    double wx, wy;
} gno_footprint;

/* ---- procedural patterns -------------------------------------------------------------------------------------------- */

typedef enum gno_pattern {
    GNO_PATTERN_WOOD = 0,    /* rings about the z axis of the pattern's frame */
    GNO_PATTERN_MARBLE = 1,  /* veins across its x axis, folded by noise */
    GNO_PATTERN_CHECKER = 2, /* unit cubes in two colours */
    GNO_PATTERN_BRICK = 3,   /* bricks in mortar, courses along z, each second one moved by half a brick */
    GNO_PATTERN_NOISE = 4,   /* a fractal sum of noise, one lattice point a unit at the coarsest */
    GNO_PATTERN_CLOUD = 5    /* the same made steeper, so that clear patches lie between dense ones */
} gno_pattern;

/* A colour for every point of space, C(X,Y,Z). The frame: z along `axis`, x along the part of `across` at a right angle to it, y
 * completing a right-handed frame; lengths along x, y, z divided by scale. Everything below is in that frame. A value f in [0,1] of
 * the point mixes the two colours: light + (dark - light) f. */
typedef struct gno_procedural {
    gno_pattern pattern;
    double light[3];      /* C1; checker: cubes whose coordinates' sum is even; brick: the lightest bricks; cloud: the clouds */
    double dark[3];       /* C2; wood: late wood; marble: the veins; brick: the darkest bricks; cloud: the sky */
    double origin[3];
    double axis[3];       /* need not be unit, not zero; default z */
    double across[3];     /* not along axis; default x */
    double scale[3];      /* size of the pattern's unit along x, y, z; > 0; default 1 */
    double rings;         /* wood: rings, marble: veins in a unit; > 0 */
    double distortion;    /* wood: by how many rings, marble: by how many veins noise moves them, >= 0 */
    double grain;         /* wood: share of fine fibres along the axis, in [0,1] */
    int sharpness;        /* wood, marble: f = ((1 + sin t)/2)^sharpness, 1 to 8: dark lines get narrower */
    double brick[3];      /* length, depth and height of a brick, a joint included; > 0. Faces that look along x or y show length and
                             height, faces that look along z length and depth */
    double mortar;        /* width of the joints, >= 0 and below each of brick */
    double mortar_colour[3];
    double cover;         /* cloud: 0 a clear sky to 1 an overcast one; half of it is covered at 0.5 */
    gno_fractal fractal;  /* of the noise in all of them */
} gno_procedural;

/* The pattern with colours and sizes that look like it: wood 8 rings a unit, bricks of 1 x 0.5 x 0.3. */
GNO_API gno_procedural gno_procedural_default(gno_pattern pattern);

/* Whether every field is in its range; else *field (may be NULL) is the first wrong one's name, constant text. */
GNO_API int gno_procedural_is_valid(const gno_procedural *procedural, const char **field);

/* Mean colour of the pattern over a pixel, in the space of the pattern's origin and axes. Checker and brick are integrated over the
 * pixel's area, each element weighted by the share of the pixel that it fills; the others are band-limited: what is finer than
 * the pixel has faded to its mean. The pattern must be valid. A face in a plane of whole coordinates belongs to the cells above it. */
GNO_API void gno_procedural_colour(const gno_procedural *procedural, const gno_footprint *footprint, double rgb[3]);

/* The same of the value f in [0,1] instead of the colours; brick: 0 in the mortar, 1 on the bricks. For bumps. */
GNO_API double gno_procedural_value(const gno_procedural *procedural, const gno_footprint *footprint);

/* ---- bumps ---------------------------------------------------------------------------------------------------------- */

/* N' = N + P_y (Q_x x N/|N|) + P_x (N/|N| x Q_y) with N = Q_x x Q_y (8.6.7): the normal, of any length, of a surface Q(X,Y)
 * raised by P along its normal. qx, qy: derivatives of the surface's point; px, py: those of P, in the same unit. bumped may be
 * one of the arguments. Where Q_x x Q_y is zero the result is zero. */
GNO_API void gno_bump_normal(const double qx[3], const double qy[3], double px, double py, double bumped[3]);

/* The unit normal of a surface raised by `amount` times the pattern's value, by finite differences over half a pixel. amount is in
 * the pattern's unit, the least of its scale: a pattern or an object twice as large has bumps twice as high, which look alike.
 * normal: unit; footprint: as above, in the same space. The result is on the side of `normal`. */
GNO_API void gno_bump_procedural(const gno_procedural *procedural, double amount, const gno_footprint *footprint,
                                 const double normal[3], double bumped[3]);

/* Heights in a table of width x height values, row by row, value (i,j) standing at ((i + 0.5)/width, (j + 0.5)/height). */
typedef struct gno_height_table {
    int width, height; /* > 0 */
    const float *values;
    int clamp; /* 0: the table repeats; 1: its border goes on */
} gno_height_table;

/* The height at (u,v), bilinear between the values, and its derivatives along u and v (may be NULL) by finite differences one
 * value apart. */
GNO_API double gno_height_at(const gno_height_table *table, double u, double v, double *du, double *dv);

#ifdef __cplusplus
}
#endif

#endif
