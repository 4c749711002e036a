/* mtl_map.h -- the pictures that an MTL material names: map_Kd, map_d, map_Bump (bump), norm.
 *
 * Place: under mtl.c; hands requests to texture_file.h and fills a material's texture and bump.
 * Options read: -s and -o (size and place: texture coordinate times s plus o), -clamp, -bm (height of a bump); the others are
 * skipped with as many values as they take.
 */
#ifndef GNOI_IO_MTL_MAP_H
#define GNOI_IO_MTL_MAP_H

#include "mesh_util.h"
#include "texture_file.h"

typedef enum gnoi_mtl_use { GNOI_MTL_COLOUR, GNOI_MTL_ALPHA, GNOI_MTL_BUMP, GNOI_MTL_NORMAL, GNOI_MTL_USES } gnoi_mtl_use;

typedef struct gnoi_mtl_map {
    char *name; /* NULL: none */
    size_t name_size, line;
    double scale[2], offset[2], multiplier;
    int clamp;
} gnoi_mtl_map;

/* The use of a keyword such as "map_Kd", in any case; -1 for others. */
int gnoi_mtl_map_use(const char *p, const char *end);

/* Reads the rest of such a line, from p on. */
gno_status gnoi_mtl_map_read(gno_context *context, const char *path, size_t line, const char *p, gnoi_mtl_map *map);
void gnoi_mtl_map_free(gno_context *context, gnoi_mtl_map *map);

/* Puts a material's maps, by use, into it; `path` is the library's. Pictures that cannot be read are warnings. */
gno_status gnoi_mtl_maps_apply(gnoi_textures *textures, const char *path, const gnoi_mtl_map maps[GNOI_MTL_USES], gno_material *material);

#endif
