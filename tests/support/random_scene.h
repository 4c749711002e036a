/* random_scene.h -- scenes made from a seed, each kind built to provoke one sort of trouble. Place: tests. */
#ifndef TESTS_SUPPORT_RANDOM_SCENE_H
#define TESTS_SUPPORT_RANDOM_SCENE_H

#include <gnomon/gnomon.h>
#include <stdint.h>

typedef enum scene_kind {
    SCENE_SOUP,    /* triangles crossing each other every way */
    SCENE_BOXES,   /* boxes on a plane, some sharing a wall */
    SCENE_HOLES,   /* walls with windows before a light */
    SCENE_STARS,   /* concave polygons */
    SCENE_DETAILS, /* polygons lying on a tilted wall, with and without priorities */
    SCENE_ROOM,    /* a closed room with eye, lamps and boxes inside */
    SCENE_GLASS,   /* transparent casters over a floor */
    SCENE_AROUND,  /* polygons in front of, behind and across the plane of the eye */
    SCENE_LATTICE, /* everything on whole numbers: shared corners, common planes, edges through pixel corners */
    SCENE_TORCH,   /* the light stands in the eye: no shadow can be seen */
    SCENE_SOLIDS,  /* closed bodies in and through each other, wound both ways, some open to the eye from behind */
    SCENE_BLOB,    /* a closed smooth mesh on a plane, Gouraud or Phong */
    SCENE_PANES,   /* stacks of transparent polygons, lying on each other and through each other and solid things */
    SCENE_SOFT,    /* boxes, triangles and glass under lights whose shadows weaken with distance */
    SCENE_MARKED,  /* details on a wall and on each other, marked as such, some of glass, some reaching beyond it */
    SCENE_KINDS
} scene_kind;

const char *scene_kind_name(scene_kind kind);

/* The same seed makes the same scene. NULL when a call into the library fails. */
gno_scene *random_scene(gno_context *context, scene_kind kind, unsigned seed, int width, int height);

/* A copy made through the getters, magnified, moved, and its corners rounded to multiples of `grid` (0: not). Polygons keep
 * their numbers. NULL when a call fails. */
gno_scene *move_scene(gno_scene *from, double scale, const double offset[3], double grid);

/* A sphere of 20 * 4^level triangles around (0,0,0), pushed in and out by waves of the given height; adds it to the scene with
 * normals of its own. Closed, star-shaped as long as `waves` is below some 0.3. Returns 0 on failure. */
int add_blob(gno_scene *scene, int level, double radius, double waves, const double centre[3], int material, int shading);

/* Adds a box with the corners a and b as six quads (inside: wound to face inwards). Returns 0 on failure. */
int add_box(gno_scene *scene, const double a[3], const double b[3], int inside, int material);

/* Adds one polygon of `count` corners. Returns 0 on failure. */
int add_polygon(gno_scene *scene, const double (*corners)[3], size_t count, int material, int priority);

/* Uniform in [0,1), from a state that moves on. */
double random_unit(uint64_t *state);

#endif
