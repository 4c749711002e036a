/* filter.h -- the mean of a texture's picture over pixels.
 *
 * Place in the data flow: gnoi_image + gnoi_pattern over a pixel -> red, green, blue, alpha -> shading, holes.
 * The pixel's four corners bound a quadrilateral of the pattern; the pattern's elements (squares of one colour) are weighted by the
 * share of each that lies inside (Catmull 1974; Blinn and Newell 1976). Shares are areas in the picture: the lines between
 * elements are straight there too, and what perspective does to areas is taken into account.
 * Pixels are asked for one by one and answered together: the usual ones, a quadrilateral over few cells of one level in which w hardly
 * changes, share vector code (filter_lanes.h), each in a lane of its own, so that an answer does not depend on which others are
 * asked for. Larger ones are parted into such; what is too large for that, or reaches the horizon, is cut (filter_cut.h).
 */
#ifndef GNOI_PROJECT_FILTER_H
#define GNOI_PROJECT_FILTER_H

#include "project/filter_view.h"
#include "project/pattern.h"
#include "scene/image.h"

/* Of which pixel a look is. */
typedef struct gnoi_look {
    const gnoi_image *image;
    const gno_texture *how;
    float *mean; /* where its share of the pixel's mean is added */
} gnoi_look;

typedef struct gnoi_looks {
    int count;              /* pixels asked for; 0 to begin with */
    int end;                /* of looks beyond theirs; valid while some are asked for */
    gnoi_views views;       /* of the last of them */
    gnoi_view_values xs, ys; /* beside them: where the surface is seen, from the pixel's centre */
    gnoi_look_lanes lanes;  /* of the pixels; from GNOI_ASKED on of parts of those that are not plain */
    gnoi_look look[GNOI_LOOKS];
    struct {
        float share;
        int level;
    } part[GNOI_LOOKS - GNOI_ASKED];
} gnoi_looks;

/* Asks for the means over `count` neighbouring pixels, at most GNOI_VIEW_RUN: the first one's centre is (x,y), each is the square of side 1
 * around its centre; red, green, blue multiplied by alpha. Beyond the plane's horizon nothing counts. (xs[i],ys[i]): a point where
 * the surface is seen, for pixels that have nothing else. mean[i] is there after gnoi_looks_answer, and must stay in its place until
 * then, as `how` must. */
void gnoi_looks_ask(gnoi_looks *looks, const gnoi_image *image, const gno_texture *how, const gnoi_pattern *pattern, double x, double y,
                    int count, const double *xs, const double *ys, float (*mean)[4]);
void gnoi_looks_answer(gnoi_looks *looks);

/* Both for one pixel. */
void gnoi_filter_pixel(const gnoi_image *image, const gno_texture *how, const gnoi_pattern *pattern, double x, double y, double xs,
                       double ys, float mean[4]);

#endif
