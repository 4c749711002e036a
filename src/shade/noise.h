/* noise.h -- what procedural patterns need of noise beyond the public calls of gnomon_math.h.
 *
 * Place in the data flow: integer hash -> lattice noise -> fractal sums -> procedural.c.
 */
#ifndef GNOI_SHADE_NOISE_H
#define GNOI_SHADE_NOISE_H

#include <gnomon/gnomon_math.h>
#include <stdint.h>

/* A number in [0,1], every one as likely, for three integers and a seed. */
double gnoi_hash_unit(int64_t i, int64_t j, int64_t k, unsigned seed);

/* gno_fractal_noise; *lost (may be NULL): the variance of what has faded, on the average over space. */
double gnoi_fractal_noise(const gno_fractal *fractal, const double point[3], double width, double gradient[3], double *lost);

/* cos(2 pi turns), by a polynomial: the same bits with every C library. Error below 1e-11. */
double gnoi_cos_turns(double turns);

#endif
