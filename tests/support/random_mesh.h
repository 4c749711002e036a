/* random_mesh.h -- random meshes of boxes and scraps.
 *
 * Place: tests of preparing -> here. Coordinates are whole and from a small cube, so that vertices meet by chance, areas and planes are exact, and no
 * verdict is a matter of rounding.
 */
#ifndef SUPPORT_RANDOM_MESH_H
#define SUPPORT_RANDOM_MESH_H

#include <gnomon/gnomon.h>
#include <stdint.h>

/* A scene of one to three meshes, each of so many bodies with corners below `side` (a box may reach 3 beyond). kind 0: boxes and scraps; 1: boxes
 * alone, most of them whole. A failure aborts; the caller destroys the scene. */
gno_scene *random_mesh(gno_context *context, uint64_t seed, size_t bodies, int side, int kind);

#endif
