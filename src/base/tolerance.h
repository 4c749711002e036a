/* tolerance.h -- every tolerance of the engine, by name, with unit and reason. Place: base; knows nothing. */
#ifndef GNOI_BASE_TOLERANCE_H
#define GNOI_BASE_TOLERANCE_H

/* Share of a polygon's reach (its farthest corner's distance from the scene's middle, along an axis): what is nearer than this to
 * its plane lies on it. Model files carry 6 to 7 significant digits, so faces meant to be coplanar differ by some 1e-7, and the
 * plane of a small face, drawn out over a large one, by ten times that. */
#define GNOI_COPLANAR 4e-6

/* Rounding of a coordinate, as a share of it: what a plane is off by far from the origin, beside GNOI_COPLANAR. */
#define GNOI_COORDINATE_NOISE 1e-14

/* A polygon whose corners leave its plane by more than this share of its own extent is not planar (split into triangles);
 * never stricter than GNOI_COPLANAR of the scene. */
#define GNOI_PLANAR 1e-4

/* A polygon whose area is less than this share of its perimeter squared has no area: below it a normal computed in
 * double precision carries no information. */
#define GNOI_DEGENERATE 1e-12

/* Sine of the angle below which two directions count as parallel: a frame built from them would keep 7 digits at most. */
#define GNOI_PARALLEL 1e-9

/* Added to the cosine of an angle held against the crease angle, so that faces of a cube meet at 90 degrees, not at a
 * rounding error more. */
#define GNOI_CREASE 1e-9

/* A sum of normals shorter than this share of its terms' lengths has cancelled: its direction is rounding error. */
#define GNOI_CANCELLED 1e-9

#endif
