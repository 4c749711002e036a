/* holes.h -- what comes through a caster whose texture has holes.
 *
 * Place in the data flow: shadow polygon of a caster with holes -> its texture's alpha where the rays from a pixel of the receiver to
 * the light meet it -> transmission of the shadow's interval in that pixel. From receiver to caster through the light is a projection
 * like that of the eye, so the pixel's square is carried to the caster's pattern exactly and filtered as a texture is.
 */
#ifndef GNOI_SHADOW_HOLES_H
#define GNOI_SHADOW_HOLES_H

#include "shadow/column.h"

/* What the caster (a prepared polygon) passes of the lamp's light to picture point (x,y) of the receiver, filtered over its pixel. */
void gnoi_holes_through(const gno_scene *scene, const gnoi_view *view, const gnoi_lamp *lamp, const gnoi_receiver *receiver, uint32_t caster,
                        double x, double y, double through[3]);

#endif
