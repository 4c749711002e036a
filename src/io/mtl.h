/* mtl.h -- material libraries (MTL) of an OBJ file.
 *
 * Place: obj.c names materials as it meets them (usemtl), has libraries read (mtllib), and at its end turns the numbers
 * of the names into scene materials.
 */
#ifndef GNOI_IO_MTL_H
#define GNOI_IO_MTL_H

#include "mesh_util.h"
#include "mtl_map.h"

typedef struct gnoi_mtl {
    gno_context *context;
    gnoi_names names;        /* of materials, used or defined */
    gnoi_mesh_array entries; /* gnoi_mtl_entry, one per name */
    gnoi_names libraries;    /* read already, or found missing: not again */
    gnoi_names paths;        /* of libraries, as opened */
    gnoi_textures textures;
} gnoi_mtl;

/* The number of a material's name, first used in this line of the OBJ file; -1 when memory fails. */
int gnoi_mtl_number(gnoi_mtl *mtl, const char *name, size_t length, size_t line);

/* Reads the libraries that a mtllib line names: one name with blanks in it if such a file exists, else several. A library
 * that cannot be opened is a warning. */
gno_status gnoi_mtl_read_libraries(gnoi_mtl *mtl, const char *obj_path, size_t line, const char *names, size_t length);

/* Adds the materials that occur in numbers (-1: none) to the scene and writes their scene indices over the numbers.
 * Names without a definition get the default material, with a warning. */
gno_status gnoi_mtl_to_scene(gnoi_mtl *mtl, gno_scene *scene, const char *obj_path, int *numbers, size_t count);

void gnoi_mtl_free(gnoi_mtl *mtl);

#endif
