/* oracle_pixel.c -- pixels of the oracle: see oracle.h. */
#include "support/oracle.h"

#include <math.h>
#include <string.h>

/* A number in [0,1) from a counter and a seed. */
static double scatter(unsigned a, unsigned b)
{
    unsigned x = a * 2654435761u ^ (b + 0x9e3779b9u) * 2246822519u;
    x = (x ^ x >> 16) * 0x7feb352du;
    x = (x ^ x >> 15) * 0x846ca68bu;
    return (x ^ x >> 16) / 4294967296.0;
}

/* To the ray's place in its cell of the pixel. */
static void move_in_pixel(const oracle *o, int px, int py, int n, int ray, unsigned seed, double *x, double *y)
{
    unsigned place = (unsigned)py * (unsigned)oracle_image(o).width + (unsigned)px, number = 2 * (place * (unsigned)(n * n) + (unsigned)ray);
    *x += (ray % n + scatter(number, seed)) / n;
    *y += (ray / n + scatter(number + 1, seed)) / n;
}

/* The rays of a pixel that see one face in one state. */
typedef struct share_of_pixel {
    long polygon;
    unsigned long state;
    int count;
    double x, y, rgb[3]; /* sums */
} share_of_pixel;

#define SHARES 24 /* of one pixel; rays beyond go to the last */

static void count_ray(share_of_pixel *shares, int *count, const oracle_sample *s, double x, double y)
{
    int i = 0;
    while (i < *count && (shares[i].polygon != s->polygon || shares[i].state != s->state)) i++;
    if (i == SHARES) i--;
    if (i == *count) {
        memset(&shares[i], 0, sizeof shares[i]);
        shares[i].polygon = s->polygon;
        shares[i].state = s->state;
        ++*count;
    }
    shares[i].count++;
    shares[i].x += x;
    shares[i].y += y;
    for (int k = 0; k < 3; k++) shares[i].rgb[k] += s->rgb[k];
}

static void add_centred(const oracle *o, const share_of_pixel *share, double rays, double rgb[3])
{
    oracle_sample middle = oracle_look(o, share->x / share->count, share->y / share->count);
    int same = middle.polygon == share->polygon && middle.state == share->state; /* a crescent's middle lies outside it */
    for (int k = 0; k < 3; k++) rgb[k] += (same ? share->count * middle.rgb[k] : share->rgb[k]) / rays;
}

oracle_pixel oracle_look_pixel(const oracle *o, int px, int py, int n, unsigned seed)
{
    oracle_pixel r;
    share_of_pixel shares[SHARES];
    int count = 0;
    memset(&r, 0, sizeof r);
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++) {
            double x = px, y = py;
            move_in_pixel(o, px, py, n, j * n + i, seed, &x, &y);
            oracle_sample s = oracle_look(o, x, y);
            int first = i == 0 && j == 0;
            count_ray(shares, &count, &s, x, y);
            for (int k = 0; k < 3; k++) {
                r.rgb[k] += s.rgb[k] / (n * n);
                r.lower[k] = first ? s.rgb[k] : fmin(r.lower[k], s.rgb[k]);
                r.upper[k] = first ? s.rgb[k] : fmax(r.upper[k], s.rgb[k]);
            }
        }
    for (int i = 0; i < count; i++) add_centred(o, &shares[i], n * n, r.centred);
    r.polygon = shares[0].polygon;
    r.state = shares[0].state;
    r.uniform = count == 1;
    return r;
}

void oracle_picture(const oracle *o, int n, unsigned seed, oracle_pixel *pixels)
{
    for (int y = 0; y < oracle_image(o).height; y++)
        for (int x = 0; x < oracle_image(o).width; x++) *pixels++ = oracle_look_pixel(o, x, y, n, seed);
}

void oracle_light_once(const oracle *o, int px, int py, int n, unsigned seed, double rgb[3])
{
    oracle_surfaces surfaces = {0, 0, {{0, 0, 0, 0}}};
    rgb[0] = rgb[1] = rgb[2] = 0;
    for (surfaces.counted = 0; surfaces.counted < 2; surfaces.counted++)
        for (int i = 0; i < n * n; i++) {
            double x = px, y = py;
            move_in_pixel(o, px, py, n, i, seed, &x, &y);
            oracle_sample s = oracle_look_again(o, x, y, &surfaces);
            for (int k = 0; k < 3; k++) rgb[k] += surfaces.counted ? s.rgb[k] / (n * n) : 0;
        }
}
