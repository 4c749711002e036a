/* assimp_view.c -- the file's camera and lights.
 *
 * Place: under assimp_mesh.c, after the meshes are in the scene; see assimp_file.h.
 *
 * Camera: the first one. assimp gives the horizontal angle h and the aspect (0: the file has none; assimp took 1 for glTF,
 * for the others we take the picture's); ours is the vertical angle, 2 atan(tan(h/2)/aspect), in pictures of any shape.
 * Two faults of assimp's glTF reader before version 5.3 are undone: h is the vertical angle times the aspect (issue 4435),
 * and the camera's position, always the node's origin, is given as the node's translation once more (issue 5054).
 *
 * Lights: brightness in files is physical (glTF: candela for point and spot lights, which fall off with the square of
 * the distance, lux for directional ones) and would need an exposure. Instead all intensities are multiplied by one factor, so
 * that the light that is brightest at the centre of the scene's bounds gives 1 there in its strongest channel. A light
 * nearer to the centre than half the bounds' half diagonal is taken to be that far, or a bulb in the middle would leave
 * all else dark. Lights of other formats without a fall-off by the square of the distance keep their intensities.
 */
#include "assimp_file.h"
#include <assimp/version.h>
#include <math.h>
#include <string.h>

static const double degrees = 57.295779513082320877;

static void transform_point(const gnoi_affine *t, const struct aiVector3D *p, double w, double out[3])
{
    for (int i = 0; i < 3; i++) {
        const double *row = t->m + 4 * i;
        out[i] = row[0] * (double)p->x + row[1] * (double)p->y + row[2] * (double)p->z + w * row[3];
    }
}

static double distance(const double a[3], const double b[3])
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

/* Scales v to a length; 0 when it has none. */
static int set_length(double v[3], double length)
{
    double largest = fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
    if (!isfinite(largest) || largest == 0) return 0;
    for (int i = 0; i < 3; i++) v[i] /= largest;
    double old = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++) v[i] *= length / old;
    return 1;
}

/* Looks for the node that places a camera or light, known by its name. Depth was checked with the meshes. */
static int find_node(const struct aiNode *node, const gnoi_affine *outer, const struct aiString *name, gnoi_affine *found)
{
    gnoi_affine transform = gnoi_assimp_compose(outer, &node->mTransformation);
    if (strcmp(node->mName.data, name->data) == 0) {
        *found = transform;
        return 1;
    }
    for (unsigned i = 0; i < node->mNumChildren; i++)
        if (find_node(node->mChildren[i], &transform, name, found)) return 1;
    return 0;
}

static gnoi_affine place(const gnoi_assimp *a, const struct aiString *name)
{
    gnoi_affine outer, found;
    memcpy(outer.m, a->options->transform, sizeof outer.m);
    return a->file->mRootNode && find_node(a->file->mRootNode, &outer, name, &found) ? found : outer;
}

/* The middle of the scene's bounds and half their diagonal. */
static double scene_centre(const gno_scene *scene, double centre[3])
{
    double lower[3], upper[3];
    gno_scene_bounds(scene, lower, upper);
    for (int i = 0; i < 3; i++) centre[i] = 0.5 * (lower[i] + upper[i]);
    return distance(centre, upper);
}

/* ---- camera ------------------------------------------------------------------------------------------------- */

static double camera_aspect(const gnoi_assimp *a, const struct aiCamera *from)
{
    if (from->mAspect > 0) return (double)from->mAspect;
    if (a->is_gltf) return 1;
    gno_image_def image = gno_scene_image(a->scene);
    return (double)image.width / image.height;
}

/* The vertical angle in degrees. */
static double camera_angle(const gnoi_assimp *a, const struct aiCamera *from)
{
    double horizontal = (double)from->mHorizontalFOV, aspect = camera_aspect(a, from);
    int is_old = aiGetVersionMajor() < 5 || (aiGetVersionMajor() == 5 && aiGetVersionMinor() < 3);
    if (a->is_gltf && is_old) return horizontal / aspect * degrees;
    return 2 * atan(tan(0.5 * horizontal) / aspect) * degrees;
}

static int convert_camera(const gnoi_assimp *a, const struct aiCamera *from, gno_camera *to)
{
    gnoi_affine t = place(a, &from->mName);
    double centre[3], view[3];
    scene_centre(a->scene, centre);
    const struct aiVector3D origin = {0, 0, 0};
    transform_point(&t, a->is_gltf ? &origin : &from->mPosition, 1, to->eye);
    transform_point(&t, &from->mLookAt, 0, view);
    transform_point(&t, &from->mUp, 0, to->up);
    /* the target is as far as the scene's middle: a step of 1 could vanish beside large coordinates */
    double reach = distance(to->eye, centre);
    if (!set_length(view, reach > 0 ? reach : 1) || !set_length(to->up, 1)) return 0;
    for (int i = 0; i < 3; i++) to->target[i] = to->eye[i] + view[i];
    to->type = from->mOrthographicWidth > 0 ? GNO_CAMERA_ORTHOGRAPHIC : GNO_CAMERA_PERSPECTIVE;
    if (to->type == GNO_CAMERA_ORTHOGRAPHIC) { /* the camera's own unit: as long as its up vector has become */
        struct aiVector3D unit = {0, 1, 0};
        double up[3], zero[3] = {0, 0, 0};
        transform_point(&t, &unit, 0, up);
        to->height = 2 * (double)from->mOrthographicWidth / camera_aspect(a, from) * distance(up, zero);
    } else {
        to->fov = camera_angle(a, from);
    }
    return 1;
}

gno_status gnoi_assimp_camera(gnoi_assimp *a)
{
    if (a->file->mNumCameras == 0) return GNO_OK;
    gno_camera camera = gno_camera_default();
    if (convert_camera(a, a->file->mCameras[0], &camera) && gno_scene_set_camera(a->scene, &camera) == GNO_OK)
        a->result->has_camera = 1;
    else
        gnoi_mesh_warn(a->context, a->path, 0, "camera \"%s\" has no usable view: it is left out",
                       a->file->mCameras[0]->mName.data);
    return GNO_OK;
}

/* ---- lights ------------------------------------------------------------------------------------------------- */

/* The file's attenuation is 1/(c + l d + q d^2), of which we keep the highest power of d; returns the factor that leaves
 * for the intensity. */
static double convert_falloff(const struct aiLight *from, gno_light *to)
{
    double c = (double)from->mAttenuationConstant, l = (double)from->mAttenuationLinear, q = (double)from->mAttenuationQuadratic;
    to->falloff = GNO_FALLOFF_NONE;
    if (to->type == GNO_LIGHT_DIRECTIONAL) return 1;
    if (q > 0) {
        to->falloff = GNO_FALLOFF_INVERSE_SQUARE;
        to->falloff_k = 0;
        return 1 / q;
    }
    if (l > 0 && c > 0) { /* l alone is what assimp's importers leave where the file says nothing */
        to->falloff = GNO_FALLOFF_LINEAR;
        to->falloff_k = c / l;
        to->distance_from_viewer = 0;
        return 1 / l;
    }
    return c > 0 ? 1 / c : 1;
}

static int convert_type(const gnoi_assimp *a, const struct aiLight *from, gno_light *to)
{
    double cone = (double)from->mAngleOuterCone * degrees * (a->is_gltf ? 2 : 1);
    switch (from->mType) {
    case aiLightSource_POINT: to->type = GNO_LIGHT_POINT; return 1;
    case aiLightSource_DIRECTIONAL: to->type = GNO_LIGHT_DIRECTIONAL; return 1;
    case aiLightSource_SPOT:
        to->type = GNO_LIGHT_SPOT;
        to->angle = cone < 179.9 ? cone : 179.9;
        return cone > 0;
    default: return 0;
    }
}

/* 0 for a kind of light that gnomon does not have, or values without sense. */
static int convert_light(const gnoi_assimp *a, const struct aiLight *from, gno_light *to)
{
    gnoi_affine t = place(a, &from->mName);
    *to = gno_light_default();
    if (!convert_type(a, from, to)) return 0;
    transform_point(&t, &from->mPosition, 1, to->position);
    transform_point(&t, &from->mDirection, 0, to->direction);
    if (to->type != GNO_LIGHT_POINT && !set_length(to->direction, 1)) return 0;
    double factor = convert_falloff(from, to);
    to->intensity[0] = (double)from->mColorDiffuse.r * factor;
    to->intensity[1] = (double)from->mColorDiffuse.g * factor;
    to->intensity[2] = (double)from->mColorDiffuse.b * factor;
    for (int i = 0; i < 3; i++)
        if (!isfinite(to->intensity[i]) || to->intensity[i] < 0 || !isfinite(to->position[i])) return 0;
    return 1;
}

/* How bright the light's strongest channel is at the centre; the cone of a spot light is not asked. */
static double brightness_at(const gno_light *light, const double centre[3], double half_diagonal)
{
    double strongest = fmax(light->intensity[0], fmax(light->intensity[1], light->intensity[2]));
    double d = fmax(distance(light->position, centre), 0.5 * half_diagonal);
    if (light->falloff == GNO_FALLOFF_INVERSE_SQUARE && d > 0) return strongest / (d * d);
    if (light->falloff == GNO_FALLOFF_LINEAR) return strongest / (d + light->falloff_k);
    return strongest;
}

/* The factor for all intensities; 1 where they are no physical ones. */
static double common_factor(const gnoi_assimp *a)
{
    double centre[3], brightest = 0;
    double half_diagonal = scene_centre(a->scene, centre);
    int physical = a->is_gltf;
    for (unsigned i = 0; i < a->file->mNumLights; i++) {
        gno_light light;
        if (!convert_light(a, a->file->mLights[i], &light)) continue;
        brightest = fmax(brightest, brightness_at(&light, centre, half_diagonal));
        physical |= light.falloff == GNO_FALLOFF_INVERSE_SQUARE;
    }
    double factor = 1 / brightest;
    return physical && brightest > 0 && isfinite(factor) ? factor : 1;
}

gno_status gnoi_assimp_lights(gnoi_assimp *a)
{
    double factor = common_factor(a);
    int left_out = 0;
    for (unsigned i = 0; i < a->file->mNumLights; i++) {
        const struct aiLight *from = a->file->mLights[i];
        gno_light light;
        if (!convert_light(a, from, &light)) {
            left_out++;
            continue;
        }
        for (int c = 0; c < 3; c++) light.intensity[c] *= factor;
        gno_status status = gno_scene_add_light(a->scene, from->mName.data, &light, NULL);
        if (status != GNO_OK) return gnoi_mesh_blame(a->scene, a->path, status);
        a->result->light_count++;
    }
    if (left_out > 0)
        gnoi_mesh_warn(a->context, a->path, 0,
                       "%d lights are left out: not point, directional or spot, or without direction", left_out);
    return GNO_OK;
}
