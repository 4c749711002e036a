/* texture.h -- a surface's texture at a pixel: colour and opacity.
 *
 * Place in the data flow: surface seen in a pixel -> where that lies on the pattern (project/pattern.h) -> its mean over the pixel
 * (project/filter.h), or a procedural pattern's colour of the point -> factor on ambient and diffuse terms, share of the surface
 * that is there at all.
 */
#ifndef GNOI_SHADE_TEXTURE_H
#define GNOI_SHADE_TEXTURE_H

#include "project/filter.h"
#include "scene/scene.h"
#include "shade/interp.h"

/* A polygon with one of its material's textures; what is known of it is kept from pixel to pixel. */
typedef struct gnoi_mapping {
    int ready;         /* place is set; so is pattern, unless the map is round or another triangle's */
    int on_corners;    /* the polygon has texture coordinates and the texture lies on them */
    uint32_t triangle; /* whose pattern it is, for one on corners */
    gnoi_place place;
    gnoi_pattern pattern;
} gnoi_mapping;

/* A polygon in the picture, as samples need it. */
typedef struct gnoi_sight {
    const gno_scene *scene;
    const gnoi_view *view;
    const gnoi_poly *poly;
    const gnoi_screen_plane *nearness;
    gnoi_interp *interp;
} gnoi_sight;

/* What the pixel whose centre is picture point (x,y) sees of the polygon's plane, in mesh space. */
gno_footprint gnoi_sight_footprint(const gnoi_sight *sight, double x, double y);

/* Makes the mapping's pattern valid around picture point (x,y). `mapping` is zero before its first use. */
const gnoi_pattern *gnoi_mapping_seek(gnoi_mapping *mapping, const gnoi_sight *sight, const gno_texture *texture, double x, double y);

/* The texture's mean over the pixel whose centre is (x,y), seen at (xs,ys) in it: red, green and blue of what is solid, and the
 * solid share. */
void gnoi_texture_at(const gnoi_sight *sight, const gno_texture *texture, gnoi_mapping *mapping, double x, double y, double xs,
                     double ys, float rgba[4]);

/* The same for a picture without holes, by a queue: rgba is valid once that is answered. */
void gnoi_texture_ask(const gnoi_sight *sight, const gno_texture *texture, gnoi_mapping *mapping, double x, double y, double xs,
                      double ys, gnoi_looks *looks, float rgba[4]);

#endif
