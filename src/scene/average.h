/* average.h -- averaged vertex normals. Place in the data flow: normals.c, for corners that the file gives none. */
#ifndef GNOI_SCENE_AVERAGE_H
#define GNOI_SCENE_AVERAGE_H

#include "scene/prepare.h"

/* Gives each corner of a smooth polygon that has none (GNOI_NONE; there is one) a normal, appended to prepared.normals: the weighted sum of the planes
 * of its object's smooth polygons around its vertex, or its own plane's where that sum cancels. Errors: MEMORY, CANCELLED, LIMIT. */
gno_status gnoi_average_normals(gnoi_preparing *w);

#endif
