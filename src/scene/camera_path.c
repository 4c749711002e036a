/* camera_path.c -- cameras along a path: see gnomon_path.h.
 *
 * Place in the data flow: callers and file readers -> path of the scene -> a camera for each frame -> gno_scene_set_camera -> gno_render.
 * Invariants: the camera at a key's frame is the key, bit for bit; frame 0 of a turntable is the camera that it starts from.
 * Sources: Rodrigues' rotation formula; Catmull and Rom, "A class of local interpolating splines", 1974.
 */
#include "scene/scene.h"
#include "scene/validate.h"

#include <gnomon/gnomon_path.h>
#include <string.h>

#define PI 3.14159265358979323846

gno_camera_path gno_camera_path_default(void)
{
    gno_camera_path path;
    memset(&path, 0, sizeof path);
    path.type = GNO_PATH_TURNTABLE;
    path.frames = 60;
    path.axis[2] = 1;
    path.angle = 360;
    return path;
}

/* ---- turntable ----------------------------------------------------------------------------------------------------- */

static void store(double out[3], vec3 v)
{
    out[0] = v.x;
    out[1] = v.y;
    out[2] = v.z;
}

static vec3 turned(vec3 v, vec3 axis, double c, double s)
{
    return v3_add(v3_add(v3_scale(v, c), v3_scale(v3_cross(axis, v), s)), v3_scale(axis, v3_dot(axis, v) * (1 - c)));
}

/* Quarter turns are exact, so that a turntable of four frames has four square views. */
static void cos_sin(double degrees, double *c, double *s)
{
    double quarter = fmod(degrees, 360) / 90;
    static const double cosines[] = {1, 0, -1, 0};
    *c = cos(degrees * PI / 180);
    *s = sin(degrees * PI / 180);
    if (quarter == floor(quarter)) {
        int k = (int)quarter & 3;
        *c = cosines[k];
        *s = cosines[(k + 3) & 3];
    }
}

static gno_status turntable_at(const gno_camera_path *path, const gno_camera *start, double frame, gno_camera *camera)
{
    vec3 axis = v3_unit(v3_from(path->axis)), centre = v3_from(path->centre);
    double c, s;
    if (!(v3_length(axis) > 0.5) || !isfinite(path->angle) || !isfinite(v3_length(centre)) || path->frames < 1)
        return GNO_ERROR_ARGUMENT;
    *camera = *start;
    cos_sin(path->angle * frame / path->frames, &c, &s);
    if (c == 1 && s == 0)
        return GNO_OK;
    store(camera->eye, v3_add(centre, turned(v3_sub(v3_from(start->eye), centre), axis, c, s)));
    store(camera->target, v3_add(centre, turned(v3_sub(v3_from(start->target), centre), axis, c, s)));
    store(camera->up, turned(v3_from(start->up), axis, c, s));
    return GNO_OK;
}

/* ---- keys ---------------------------------------------------------------------------------------------------------- */

enum { VALUES = 11 }; /* numbers of a key, in the order of its fields */

static void values_of(const gno_camera_key *key, double v[VALUES])
{
    memcpy(v, key->eye, sizeof key->eye);
    memcpy(v + 3, key->target, sizeof key->target);
    memcpy(v + 6, key->up, sizeof key->up);
    v[9] = key->fov;
    v[10] = key->height;
}

static void set_camera(const double v[VALUES], gno_camera *camera)
{
    memcpy(camera->eye, v, sizeof camera->eye);
    memcpy(camera->target, v + 3, sizeof camera->target);
    memcpy(camera->up, v + 6, sizeof camera->up);
    camera->fov = v[9];
    camera->height = v[10];
}

/* The last key at or before the frame; the first when there is none. */
static size_t key_before(const gno_camera_path *path, double frame)
{
    size_t low = 0, high = path->key_count;
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        if (path->keys[middle].frame <= frame)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* Change of each value by frame at key k: the slope of the parabola through it and its neighbours; at an end that of the nearest. */
static void slopes_at(const gno_camera_path *path, size_t k, double slope[VALUES])
{
    double before[VALUES], at[VALUES], after[VALUES], h0 = 0, h1 = 0;
    values_of(&path->keys[k], at);
    if (k > 0) {
        values_of(&path->keys[k - 1], before);
        h0 = (double)path->keys[k].frame - path->keys[k - 1].frame;
    }
    if (k + 1 < path->key_count) {
        values_of(&path->keys[k + 1], after);
        h1 = (double)path->keys[k + 1].frame - path->keys[k].frame;
    }
    for (int i = 0; i < VALUES; i++) {
        double s0 = k > 0 ? (at[i] - before[i]) / h0 : 0, s1 = k + 1 < path->key_count ? (after[i] - at[i]) / h1 : 0;
        slope[i] = k == 0 ? s1 : k + 1 == path->key_count ? s0 : (s0 * h1 + s1 * h0) / (h0 + h1);
    }
}

static double clamp_between(double x, double a, double b)
{
    double lo = a < b ? a : b, hi = a < b ? b : a;
    return x < lo ? lo : x > hi ? hi : x;
}

static void between_keys(const gno_camera_path *path, size_t k, double frame, double out[VALUES])
{
    double a[VALUES], b[VALUES], sa[VALUES], sb[VALUES];
    double h = (double)path->keys[k + 1].frame - path->keys[k].frame, t = (frame - path->keys[k].frame) / h;
    values_of(&path->keys[k], a);
    values_of(&path->keys[k + 1], b);
    if (path->interpolation == GNO_INTERPOLATION_SMOOTH) {
        slopes_at(path, k, sa);
        slopes_at(path, k + 1, sb);
    }
    for (int i = 0; i < VALUES; i++) {
        double d = b[i] - a[i];
        out[i] = a[i] + t * d;
        if (path->interpolation == GNO_INTERPOLATION_SMOOTH)
            out[i] += t * (1 - t) * ((1 - t) * (sa[i] * h - d) + t * (d - sb[i] * h));
    }
    out[9] = clamp_between(out[9], a[9], b[9]);
    out[10] = clamp_between(out[10], a[10], b[10]);
}

static gno_status keys_at(const gno_camera_path *path, const gno_camera *start, double frame, gno_camera *camera)
{
    double v[VALUES];
    size_t k;
    if (path->key_count == 0 || !path->keys)
        return GNO_ERROR_ARGUMENT;
    k = key_before(path, frame);
    if (frame <= path->keys[k].frame || k + 1 == path->key_count)
        values_of(&path->keys[k], v);
    else
        between_keys(path, k, frame, v);
    for (int i = 0; i < VALUES; i++)
        if (!isfinite(v[i]))
            return GNO_ERROR_ARGUMENT;
    *camera = *start;
    set_camera(v, camera);
    return GNO_OK;
}

gno_status gno_camera_path_at(const gno_camera_path *path, const gno_camera *start, double frame, gno_camera *camera)
{
    if (!path || !start || !camera || !isfinite(frame))
        return GNO_ERROR_ARGUMENT;
    return path->type == GNO_PATH_TURNTABLE ? turntable_at(path, start, frame, camera) : keys_at(path, start, frame, camera);
}

/* ---- a scene's path ------------------------------------------------------------------------------------------------- */

static gno_status check_path(gno_context *context, const gno_camera_path *path)
{
    if ((int)path->type < 0 || path->type > GNO_PATH_KEYS || (int)path->interpolation < 0 || path->interpolation > GNO_INTERPOLATION_SMOOTH)
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "camera path: unknown type or interpolation");
    if (path->frames < 1 || path->frames > GNO_MAX_FRAMES)
        return gnoi_fail(context, GNO_ERROR_LIMIT, "camera path: %d frames are not between 1 and %d", path->frames, GNO_MAX_FRAMES);
    if (path->type != GNO_PATH_KEYS)
        return GNO_OK;
    if (path->key_count > GNO_MAX_KEYS)
        return gnoi_fail(context, GNO_ERROR_LIMIT, "camera path: more than %d keys", GNO_MAX_KEYS);
    if (path->key_count == 0 || !path->keys)
        return gnoi_fail(context, GNO_ERROR_ARGUMENT, "camera path: no keys");
    for (size_t i = 0; i < path->key_count; i++)
        if (path->keys[i].frame < 0 || (i > 0 && path->keys[i].frame <= path->keys[i - 1].frame))
            return gnoi_fail(context, GNO_ERROR_ARGUMENT, "camera path: frame %d of key %lu is negative or not after the key before",
                             path->keys[i].frame, (unsigned long)i);
    return GNO_OK;
}

static gno_status check_frames(gno_context *context, const gno_camera_path *path, const gno_camera *start)
{
    for (int frame = 0; frame < path->frames; frame++) {
        gno_camera camera;
        gno_status status = gno_camera_path_at(path, start, frame, &camera);
        if (status)
            return gnoi_fail(context, status, "camera path: frame %d: a value is not finite, or the axis has no length", frame);
        status = gnoi_check_camera(context, &camera);
        if (status) {
            char why[200];
            strncpy(why, gno_context_message(context), sizeof why - 1);
            why[sizeof why - 1] = '\0';
            return gnoi_fail(context, status, "camera path: frame %d: %s", frame, why);
        }
    }
    return GNO_OK;
}

void gnoi_scene_drop_path(gno_scene *scene)
{
    if (!scene->path)
        return;
    gnoi_free(scene->context, scene->path_keys, scene->path->key_count, sizeof *scene->path_keys);
    gnoi_free(scene->context, scene->path, 1, sizeof *scene->path);
    scene->path = NULL;
    scene->path_keys = NULL;
}

gno_status gno_scene_set_camera_path(gno_scene *scene, const gno_camera_path *path)
{
    gno_context *context = gno_scene_context(scene);
    gno_camera_path *fresh;
    gno_camera_key *keys;
    gno_status status;
    size_t count;
    if (!scene)
        return GNO_ERROR_ARGUMENT;
    if (!path) {
        gnoi_scene_drop_path(scene);
        return GNO_OK;
    }
    status = check_path(context, path);
    if (!status)
        status = check_frames(context, path, &scene->camera);
    if (status)
        return status;
    count = path->type == GNO_PATH_KEYS ? path->key_count : 0;
    fresh = gnoi_malloc(context, 1, sizeof *fresh);
    keys = gnoi_malloc(context, count, sizeof *keys);
    if (!fresh || !keys) {
        gnoi_free(context, fresh, 1, sizeof *fresh);
        gnoi_free(context, keys, count, sizeof *keys);
        return gnoi_fail(context, GNO_ERROR_MEMORY, "camera path: out of memory");
    }
    if (count > 0)
        memcpy(keys, path->keys, count * sizeof *keys);
    gnoi_scene_drop_path(scene);
    *fresh = *path;
    fresh->key_count = count;
    fresh->keys = keys;
    scene->path = fresh;
    scene->path_keys = keys;
    return GNO_OK;
}

int gno_scene_camera_path(const gno_scene *scene, gno_camera_path *path)
{
    if (!scene || !scene->path)
        return 0;
    if (path)
        *path = *scene->path;
    return 1;
}
