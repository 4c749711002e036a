/* procedural.c -- procedural patterns as they are described: defaults, and what is in range.
 *
 * Place in the data flow: callers and file readers -> here -> a material's texture. shade/procedural.c computes them.
 */
#include "base/vec.h"
#include <gnomon/gnomon_math.h>
#include <stddef.h>
#include <string.h>

#define MOST_SHARPNESS 8

/* ---- defaults ---------------------------------------------------------------------------------------------------------- */

gno_fractal gno_fractal_default(void)
{
    gno_fractal fractal;
    fractal.octaves = 5;
    fractal.gain = 0.5;
    fractal.lacunarity = 2;
    fractal.seed = 0;
    fractal.weight = GNO_NOISE_SMOOTH;
    return fractal;
}

static void set3(double triple[3], double x, double y, double z)
{
    triple[0] = x;
    triple[1] = y;
    triple[2] = z;
}

static void set_look(gno_procedural *p)
{
    switch (p->pattern) {
    case GNO_PATTERN_WOOD:
        set3(p->light, 0.62, 0.38, 0.18);
        set3(p->dark, 0.30, 0.14, 0.05);
        p->rings = 8;
        p->distortion = 0.8;
        p->grain = 0.25;
        break;
    case GNO_PATTERN_MARBLE:
        set3(p->light, 0.85, 0.84, 0.80);
        set3(p->dark, 0.12, 0.13, 0.16);
        p->rings = 2;
        p->distortion = 1.4;
        p->sharpness = 5;
        break;
    case GNO_PATTERN_BRICK:
        set3(p->light, 0.52, 0.17, 0.10);
        set3(p->dark, 0.30, 0.09, 0.06);
        break;
    case GNO_PATTERN_CLOUD:
        set3(p->light, 0.9, 0.9, 0.9);
        set3(p->dark, 0.12, 0.25, 0.55);
        break;
    default:
        set3(p->light, 0.9, 0.9, 0.9);
        set3(p->dark, 0.1, 0.1, 0.1);
        break;
    }
}

gno_procedural gno_procedural_default(gno_pattern pattern)
{
    gno_procedural p;
    memset(&p, 0, sizeof p);
    p.pattern = pattern;
    set3(p.axis, 0, 0, 1);
    set3(p.across, 1, 0, 0);
    set3(p.scale, 1, 1, 1);
    p.rings = 1;
    p.sharpness = 1;
    set3(p.brick, 1, 0.5, 0.3);
    p.mortar = 0.04;
    set3(p.mortar_colour, 0.55, 0.53, 0.5);
    p.cover = 0.5;
    p.fractal = gno_fractal_default();
    set_look(&p);
    return p;
}

/* ---- checks ------------------------------------------------------------------------------------------------------------ */

static int all_in(const double *values, int count, double low, double high)
{
    for (int i = 0; i < count; i++) {
        if (!(values[i] >= low && values[i] <= high))
            return 0;
    }
    return 1;
}

/* Two directions that span a plane. */
static int is_frame(const gno_procedural *p)
{
    vec3 z = v3_unit(v3_from(p->axis)), x = v3_unit(v3_from(p->across));
    return v3_length(v3_cross(z, x)) > 1e-9;
}

int gno_procedural_is_valid(const gno_procedural *p, const char **field)
{
    static const double big = 1e15, least = 1e-12;
    const char *wrong = NULL;
    if ((unsigned)p->pattern > GNO_PATTERN_CLOUD)
        wrong = "pattern";
    else if (!all_in(p->light, 3, 0, big))
        wrong = "light";
    else if (!all_in(p->dark, 3, 0, big))
        wrong = "dark";
    else if (!all_in(p->mortar_colour, 3, 0, big))
        wrong = "mortar_colour";
    else if (!all_in(p->origin, 3, -big, big))
        wrong = "origin";
    else if (!all_in(p->axis, 3, -big, big))
        wrong = "axis";
    else if (!all_in(p->across, 3, -big, big) || !is_frame(p))
        wrong = "across";
    else if (!all_in(p->scale, 3, least, big))
        wrong = "scale";
    else if (!all_in(&p->rings, 1, least, big))
        wrong = "rings";
    else if (!all_in(&p->distortion, 1, 0, big))
        wrong = "distortion";
    else if (!all_in(&p->grain, 1, 0, 1))
        wrong = "grain";
    else if (p->sharpness < 1 || p->sharpness > MOST_SHARPNESS)
        wrong = "sharpness";
    else if (!all_in(p->brick, 3, least, big))
        wrong = "brick";
    else if (!(p->mortar >= 0 && p->mortar < p->brick[0] && p->mortar < p->brick[1] && p->mortar < p->brick[2]))
        wrong = "mortar";
    else if (!all_in(&p->cover, 1, 0, 1))
        wrong = "cover";
    else if (p->fractal.octaves < 1 || p->fractal.octaves > 16)
        wrong = "fractal.octaves";
    else if (!(p->fractal.gain > 0 && p->fractal.gain <= 1))
        wrong = "fractal.gain";
    else if (!(p->fractal.lacunarity > 1 && p->fractal.lacunarity <= 16))
        wrong = "fractal.lacunarity";
    else if ((unsigned)p->fractal.weight > GNO_NOISE_LINEAR)
        wrong = "fractal.weight";
    if (field && wrong)
        *field = wrong;
    return !wrong;
}
