/* batch.h -- the simple lighting model (8.1.7) on many points at once.
 *
 * Place in the data flow: pieces of spans, one sample for each pixel and surface -> gnoi_batch -> colours.
 * Samples of many surfaces are gathered in arrays, one array a component, so that the compiler turns the loops over them
 * into vector code; the results are the same with any vector width (no fused operations, no library functions).
 * Points are kept relative to the eye, in single precision: the error is 1e-7 of the distance wherever the scene lies.
 */
#ifndef GNOI_SHADE_BATCH_H
#define GNOI_SHADE_BATCH_H

#include "project/view.h"
#include "scene/scene.h"
#include "shadow/frame.h"

#define GNOI_BATCH 256

typedef struct gnoi_batch {
    int count;
    int lamp_count;
    int smooth_terminator;
    float view_start;  /* orthographic: depth of the nearest object, from which the viewer's distance is counted */
    float *weight;     /* lamp_count x GNOI_BATCH: what arrives of each lamp, times the sample's coverage */
    float coverage[GNOI_BATCH];           /* weight of the ambient term */
    float px[GNOI_BATCH], py[GNOI_BATCH], pz[GNOI_BATCH]; /* point - eye */
    float nx[GNOI_BATCH], ny[GNOI_BATCH], nz[GNOI_BATCH]; /* normal on the viewer's side, any length */
    float gx[GNOI_BATCH], gy[GNOI_BATCH], gz[GNOI_BATCH]; /* plane normal on the viewer's side, unit; read for a smooth terminator */
    float kd[3][GNOI_BATCH], ks[3][GNOI_BATCH], shininess[GNOI_BATCH];
    float rgb[3][GNOI_BATCH];             /* ambient term on entry, with the diffuse terms on return: what a texture is a factor of */
    float gloss[3][GNOI_BATCH];           /* the specular terms, on return */
    uint32_t tag[GNOI_BATCH];             /* the caller's */
    float sx[GNOI_BATCH], sy[GNOI_BATCH], sz[GNOI_BATCH], distance[GNOI_BATCH]; /* scratch: to the viewer */
} gnoi_batch;

/* Adds every lamp's diffuse terms, weighted, to rgb, and sums up the specular ones. Normals become unit on the way. */
void gnoi_batch_shade(gnoi_batch *batch, const gnoi_view *view, const gnoi_lamp *lamps);

/* Diffuse and specular sums of one point for one lamp without weight, in double precision, for intensities taken at
 * vertices and centroids: adds f Il (kd N.L + ks (R.S)^n) to rgb. n: unit, on the viewer's side. */
void gnoi_shade_point(const gnoi_view *view, const gnoi_lamp *lamp, const gno_material *material, double view_start, vec3 point,
                      vec3 n, double rgb[3]);

#endif
