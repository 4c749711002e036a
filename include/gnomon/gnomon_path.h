/* gnomon_path.h -- a camera that moves: frames of a turntable or between keys. Part of libgnomon.
 *
 * A path gives a camera for every frame; it draws nothing itself. Set each frame's camera and render: what the scene keeps for the next view
 * (prepared polygons, casters of the lights) is then paid for once. Compiles as C89 to C17 and C++98 to C++17.
 */
#ifndef GNOMON_GNOMON_PATH_H
#define GNOMON_GNOMON_PATH_H

#include <gnomon/gnomon.h>

#ifdef __cplusplus
extern "C" {
#endif

#define GNO_MAX_FRAMES 1000000
#define GNO_MAX_KEYS 65536

typedef enum gno_path_type { GNO_PATH_TURNTABLE = 0, GNO_PATH_KEYS = 1 } gno_path_type;

/* linear: straight lines at constant speed from key to key; smooth: cubic curves through the keys without a jump in speed (Catmull and Rom
 * 1974, with tangents for uneven spacing), standing still at neither end. */
typedef enum gno_interpolation { GNO_INTERPOLATION_LINEAR = 0, GNO_INTERPOLATION_SMOOTH = 1 } gno_interpolation;

/* The camera at one frame. Type is that of the scene's camera. */
typedef struct gno_camera_key {
    int frame; /* 0 or more */
    double eye[3], target[3], up[3];
    double fov;    /* perspective; stays within the range of the two keys around it */
    double height; /* orthographic; likewise */
} gno_camera_key;

/* Frames 0 .. frames-1. Before the first key and after the last the camera stands still. */
typedef struct gno_camera_path {
    gno_path_type type;
    int frames;
    double axis[3];   /* turntable: eye, target and up turn about this axis, counter-clockwise seen from its tip; default z */
    double centre[3]; /* turntable: a point of the axis */
    double angle;     /* turntable: degrees in `frames` frames; default 360, so that the frame after the last is the first */
    gno_interpolation interpolation;
    size_t key_count;
    const gno_camera_key *keys; /* frames ascend */
} gno_camera_path;

/* A turntable of 60 frames about the z axis through the origin. */
GNO_API gno_camera_path gno_camera_path_default(void);

/* The camera at a frame (which may lie between two), from the camera that the path starts from: a pure function. Errors: ARGUMENT (a value that
 * is not finite, an axis of no length, a path of keys without keys); *camera is untouched then. That eye, target and up make a view
 * is checked by gno_scene_set_camera. */
GNO_API gno_status gno_camera_path_at(const gno_camera_path *path, const gno_camera *start, double frame, gno_camera *camera);

/* Gives the scene a path (NULL: takes it away), which is copied; every frame's camera is checked. The scene's camera is where a turntable
 * starts. Errors: MEMORY, LIMIT, ARGUMENT; the scene is unchanged then. */
GNO_API gno_status gno_scene_set_camera_path(gno_scene *scene, const gno_camera_path *path);

/* The scene's path; 0 when it has none. `keys` belong to the scene and are valid until its path changes. */
GNO_API int gno_scene_camera_path(const gno_scene *scene, gno_camera_path *path);

#ifdef __cplusplus
}
#endif

#endif
