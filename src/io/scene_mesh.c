/* scene_mesh.c -- a mesh file that stands alone as a scene: default view, light and ground.
 *
 * Place: gno_scene_load -> here -> gnoi_mesh_load -> bounds -> camera, sun, ground.
 *
 *  - up: the format's convention (STL z, the others y), but z for a mesh that is flat along z: its extent in z is its smallest and less
 *    than half of the other two, as in plans of cities and grounds. The setting `up` overrides.
 *  - view: from the front, 35 degrees to the right and 30 above, 30 degrees of field; the eye stands exactly so far away that
 *    the mesh fills the frame but for a margin. A camera in the file comes first.
 *  - light: a sun from behind the viewer's left shoulder; a weak light at the eye, whose shadows nobody sees, because many
 *    files have materials without ambient reflection, black in every shadow; ambient light. A file's own lights come first.
 *  - ground: a light grey square under the lowest point, unless the file has both camera and lights.
 *  - shading: phong where the file has normals and for triangle meshes too large to be meant as facets, otherwise flat.
 */
#include "io/file_name.h"
#include "io/mesh_file.h"
#include "io/scene_yaml.h"

#include <math.h>
#include <string.h>

#define AZIMUTH 35.0
#define ELEVATION 30.0
#define FIELD 30.0
#define MARGIN 0.1     /* of half the frame, on each side */
#define GROUND 10.0    /* half the ground's side, in radii: reaches past the frame's upper corners */
#define GROUND_GAP 5e-4 /* of the largest extent: over the engine's tolerance for coplanar, under what is seen */
#define FACETS 2000    /* triangle meshes up to this size are shown as they are */
#define CREASE 40.0

static const double default_ambient[3] = {0.17, 0.18, 0.2};
static const double sun_intensity[3] = {0.72, 0.69, 0.63};
static const double fill_intensity[3] = {0.2, 0.21, 0.23};
static const double sky[3] = {0.55, 0.68, 0.85};
static const double ground_grey = 0.62;

static const char *const axes[] = {"x", "y", "z", NULL};

static const char *const details_names[] = {"none", "coplanar", NULL};

enum { IMAGE, CAMERA, AMBIENT, LIGHTS, SHADING, CREASE_KEY, UP, DETAILS, FIELDS };

typedef struct mesh_view {
    int shading; /* -1: choose */
    double crease;
    int up; /* axis, -1: choose */
    int find_details;
} mesh_view;

static const gnoi_field fields[FIELDS] = {
    [IMAGE] = {.key = "image", .kind = GNOI_FIELD_NODE},
    [CAMERA] = {.key = "camera", .kind = GNOI_FIELD_NODE},
    [AMBIENT] = {.key = "ambient", .kind = GNOI_FIELD_NODE},
    [LIGHTS] = {.key = "lights", .kind = GNOI_FIELD_NODE},
    [SHADING] = {.key = "shading", .kind = GNOI_FIELD_CHOICE, .offset = offsetof(mesh_view, shading),
                 .choices = gnoi_shading_names},
    [CREASE_KEY] = {.key = "crease", .kind = GNOI_FIELD_BETWEEN, .offset = offsetof(mesh_view, crease), .high = 180},
    [UP] = {.key = "up", .kind = GNOI_FIELD_CHOICE, .offset = offsetof(mesh_view, up), .choices = axes},
    [DETAILS] = {.key = "details", .kind = GNOI_FIELD_CHOICE, .offset = offsetof(mesh_view, find_details), .choices = details_names},
};

/* What the view is built from: unit vectors of the scene, and where the mesh lies. */
typedef struct frame {
    double up[3], right[3], front[3]; /* the scene's: up, and front towards a viewer who stands before it */
    double lower[3], upper[3], centre[3];
    double size;   /* largest extent, 1 for a point */
    double radius; /* half the diagonal, in proportion */
} frame;

/* ---- the mesh ----------------------------------------------------------------------------------------------------------- */

static gno_status load_as(gno_context *context, const char *path, const mesh_view *view, int shading, int take_lights,
                          gno_scene **scene, gnoi_mesh_result *result)
{
    gnoi_mesh_options options = gnoi_mesh_options_default();
    gno_status status = gno_scene_create(context, scene);
    if (status != GNO_OK) return status;
    options.shading = shading;
    options.crease = view->crease;
    options.find_details = view->find_details;
    options.take_camera = 1;
    options.take_lights = take_lights;
    status = gnoi_mesh_load(*scene, path, &options, result);
    if (status != GNO_OK) {
        gno_scene_destroy(*scene);
        *scene = NULL;
    }
    return status;
}

/* Facets that are meant to be seen: few of them, or corners in any number, and no normals that would say otherwise. */
static int is_faceted(const gno_scene *scene)
{
    gno_scene_counts counts = gno_scene_count(scene);
    return counts.normals == 0 && (counts.polygons <= FACETS || counts.corners != 3 * counts.polygons);
}

/* Whether a mesh is faceted is known when it is read; then it is read again with the other shading. */
static gno_status load_mesh(gno_context *context, const char *path, const mesh_view *view, int take_lights, gno_scene **scene,
                            gnoi_mesh_result *result)
{
    int shading = view->shading >= 0 ? view->shading : GNO_SHADING_PHONG;
    gno_status status = load_as(context, path, view, shading, take_lights, scene, result);
    if (status != GNO_OK || view->shading >= 0 || !is_faceted(*scene)) return status;
    gno_scene_destroy(*scene);
    *scene = NULL;
    return load_as(context, path, view, GNO_SHADING_FLAT, take_lights, scene, result);
}

/* ---- the frame ---------------------------------------------------------------------------------------------------------- */

static int choose_up(const char *path, const double extent[3])
{
    if (gnoi_has_extension(path, ".stl")) return 2;
    return extent[2] < 0.55 * extent[0] && extent[2] < 0.55 * extent[1] ? 2 : 1;
}

static void make_frame(const gno_scene *scene, const char *path, int up, frame *f)
{
    double extent[3], square = 0;
    memset(f, 0, sizeof *f);
    gno_scene_bounds(scene, f->lower, f->upper);
    for (int i = 0; i < 3; i++) {
        extent[i] = f->upper[i] - f->lower[i];
        f->centre[i] = f->lower[i] + extent[i] / 2;
        f->size = fmax(f->size, extent[i]);
    }
    if (!(f->size > 0)) f->size = 1;
    for (int i = 0; i < 3; i++) square += extent[i] / f->size * (extent[i] / f->size);
    f->radius = f->size * fmax(0.5 * sqrt(square), 0.01);
    if (up < 0) up = choose_up(path, extent);
    /* right x up = front: (x, y, z), (x, z, -y), (y, x, -z) */
    f->up[up] = 1;
    f->right[up == 0 ? 1 : 0] = 1;
    f->front[up == 1 ? 2 : up == 2 ? 1 : 2] = up == 1 ? 1 : -1;
}

static void combine(double out[3], double a, const double u[3], double b, const double v[3], double c, const double w[3])
{
    for (int i = 0; i < 3; i++) out[i] = a * u[i] + b * v[i] + c * w[i];
}

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* ---- the view ----------------------------------------------------------------------------------------------------------- */

/* An eye at `along` its axis and `across` beside it sees a point (p across, q towards the eye) within the tangent t when
 * |p - across| <= t (along - q), that is, across + t along >= p + t q and t along - across >= -p + t q. `most` and `least`
 * are the largest right sides over all points; both are met at along = (most + least) / 2t, across = (most - least) / 2. */
typedef struct reach {
    double t, most, least;
} reach;

static void reach_out(reach *r, double p, double q)
{
    r->most = fmax(r->most, p + r->t * q);
    r->least = fmax(r->least, -p + r->t * q);
}

static reach reach_start(double t)
{
    reach r = {t, -HUGE_VAL, -HUGE_VAL};
    return r;
}

/* All corners of all polygons, seen along the frame's axes. */
static gno_status reach_mesh(const gno_scene *scene, const frame *f, const double view[3], const double side[3], const double top[3],
                             reach *wide, reach *high)
{
    size_t count = gno_scene_count(scene).polygons;
    gno_polygon p;
    for (size_t i = 0; i < count && gno_scene_polygon(scene, i, &p) == GNO_OK; i++) {
        for (unsigned c = p.ring_start[0]; c < p.ring_start[p.ring_count]; c++) {
            const double *at = p.positions + 3 * (size_t)p.corner_vertex[c];
            double corner[3] = {at[0] - f->centre[0], at[1] - f->centre[1], at[2] - f->centre[2]};
            double q = dot(corner, view);
            reach_out(wide, dot(corner, side), q);
            reach_out(high, dot(corner, top), q);
        }
        if (i % 4096 == 4095 && gno_context_progress(gno_scene_context(scene), "frame the mesh", (double)i / (double)count) != GNO_OK) {
            return GNO_ERROR_CANCELLED;
        }
    }
    return GNO_OK;
}

static gno_status place_camera(const gno_scene *scene, const frame *f, const gno_image_def *image, gno_camera *camera)
{
    const double radians = 3.14159265358979323846 / 180;
    double a = AZIMUTH * radians, e = ELEVATION * radians, t = tan(FIELD * radians / 2) * (1 - MARGIN);
    double view[3], side[3], top[3];
    combine(view, sin(a) * cos(e), f->right, sin(e), f->up, cos(a) * cos(e), f->front); /* from the mesh to the eye */
    combine(side, cos(a), f->right, 0, f->up, -sin(a), f->front);
    combine(top, -sin(a) * sin(e), f->right, cos(e), f->up, -cos(a) * sin(e), f->front);
    reach wide = reach_start(t * image->width / image->height), high = reach_start(t);
    gno_status status = reach_mesh(scene, f, view, side, top, &wide, &high);
    double across = (wide.most - wide.least) / 2, above = (high.most - high.least) / 2;
    double along = fmax(fmax((wide.most + wide.least) / (2 * wide.t), (high.most + high.least) / (2 * t)), 1e-3 * f->size);
    *camera = gno_camera_default();
    camera->fov = FIELD;
    camera->height = 2 * f->radius;
    for (int i = 0; i < 3; i++) {
        camera->target[i] = f->centre[i] + across * side[i] + above * top[i];
        camera->eye[i] = camera->target[i] + along * view[i];
        camera->up[i] = f->up[i];
    }
    return status;
}

static gno_status add_lights(gno_scene *scene, const frame *f, const gno_camera *camera)
{
    gno_light sun = gno_light_default(), fill = gno_light_default();
    double view[3], side[3], level = 0;
    for (int i = 0; i < 3; i++) view[i] = camera->target[i] - camera->eye[i];
    fill.type = camera->type == GNO_CAMERA_ORTHOGRAPHIC ? GNO_LIGHT_DIRECTIONAL : GNO_LIGHT_POINT;
    memcpy(fill.position, camera->eye, sizeof fill.position);
    memcpy(fill.direction, view, sizeof fill.direction);
    memcpy(fill.intensity, fill_intensity, sizeof fill.intensity);
    double rise = dot(view, f->up);
    for (int i = 0; i < 3; i++) view[i] -= rise * f->up[i];
    level = sqrt(dot(view, view));
    for (int i = 0; i < 3; i++) view[i] = level > 0 ? view[i] / level : -f->front[i];
    for (int i = 0; i < 3; i++) side[i] = view[(i + 1) % 3] * f->up[(i + 2) % 3] - view[(i + 2) % 3] * f->up[(i + 1) % 3];
    sun.type = GNO_LIGHT_DIRECTIONAL;
    combine(sun.direction, 0.45, view, 0.75, side, -0.95, f->up);
    memcpy(sun.intensity, sun_intensity, sizeof sun.intensity);
    gno_status status = gno_scene_add_light(scene, "sun", &sun, NULL);
    return status == GNO_OK ? gno_scene_add_light(scene, "eye", &fill, NULL) : status;
}

static gno_status add_ground(gno_scene *scene, const frame *f)
{
    static const unsigned ring_start[2] = {0, 4};
    static const int corners[4] = {0, 1, 2, 3};
    static const double side[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    double positions[4][3], half = GROUND * f->radius;
    gno_material grey = gno_material_default();
    gno_mesh_def def = gno_mesh_def_default();
    for (int i = 0; i < 3; i++) grey.ambient[i] = grey.diffuse[i] = ground_grey;
    gno_status status = gno_scene_add_material(scene, &grey, &def.material);
    if (status != GNO_OK) return status;
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) {
            double level = f->lower[k] - GROUND_GAP * f->size;
            positions[i][k] = f->up[k] > 0 ? level : f->centre[k] + half * (side[i][0] * f->right[k] + side[i][1] * f->front[k]);
        }
    }
    def.name = "ground";
    def.vertex_count = def.corner_count = 4;
    def.positions = positions[0];
    def.polygon_count = def.ring_count = 1;
    def.ring_start = ring_start;
    def.corner_vertex = corners;
    return gno_scene_add_mesh(scene, &def, NULL);
}

/* ---- all together --------------------------------------------------------------------------------------------------------- */

/* What the settings say comes last, over the file's own and the default view. */
static gno_status set_view(gno_scene *scene, const gnoi_yaml *yaml, const gnoi_yaml_node *const *seen, const frame *f,
                           int has_camera)
{
    gno_status status = GNO_OK;
    gno_image_def image = gno_image_def_default();
    double ambient[3];
    memcpy(image.background, sky, sizeof sky);
    memcpy(ambient, default_ambient, sizeof ambient);
    if (seen[IMAGE]) status = gnoi_read_image(yaml, seen[IMAGE], &image);
    if (status == GNO_OK && seen[AMBIENT]) status = gnoi_read_ambient(yaml, seen[AMBIENT], ambient);
    if (status != GNO_OK) return status;
    gno_camera camera = gno_scene_camera(scene);
    if (!has_camera) status = place_camera(scene, f, &image, &camera);
    if (status == GNO_OK && seen[CAMERA]) status = gnoi_read_camera(yaml, seen[CAMERA], &camera);
    if (status == GNO_OK) status = gno_scene_set_camera(scene, &camera);
    if (status == GNO_OK && seen[CAMERA]) status = gnoi_read_camera_path(yaml, seen[CAMERA], scene);
    if (status == GNO_OK) status = gno_scene_set_image(scene, &image);
    if (status == GNO_OK) status = gno_scene_set_ambient(scene, ambient);
    return status;
}

static gno_status dress(gno_scene *scene, const gnoi_yaml *yaml, const gnoi_yaml_node *const *seen, const char *path, int up,
                        const gnoi_mesh_result *result)
{
    frame f;
    make_frame(scene, path, up, &f);
    gno_status status = set_view(scene, yaml, seen, &f, result->has_camera);
    gno_camera camera = gno_scene_camera(scene);
    if (status == GNO_OK && seen[LIGHTS]) {
        gnoi_scene_reader reader;
        memset(&reader, 0, sizeof reader);
        reader.context = gno_scene_context(scene);
        reader.yaml = yaml;
        reader.path = path;
        reader.scene = scene;
        status = gnoi_read_lights(&reader, seen[LIGHTS]);
        if (status == GNO_OK) gnoi_warn_undrawn(&reader);
    } else if (status == GNO_OK && result->light_count == 0) {
        status = add_lights(scene, &f, &camera);
    }
    if (status == GNO_OK && !(result->has_camera && result->light_count > 0)) status = add_ground(scene, &f);
    return status;
}

gno_status gnoi_scene_read_mesh(gno_context *context, const gnoi_yaml *yaml, const char *path, gno_scene **scene)
{
    const gnoi_yaml_node *seen[FIELDS];
    mesh_view view = {-1, CREASE, -1, 0};
    gnoi_mesh_result result;
    gno_status status = gnoi_read_fields(yaml, gnoi_yaml_root(yaml), fields, FIELDS, &view, seen);
    if (status == GNO_OK) status = load_mesh(context, path, &view, !seen[LIGHTS], scene, &result);
    if (status == GNO_OK) status = dress(*scene, yaml, seen, path, view.up, &result);
    if (status != GNO_OK) {
        gno_scene_destroy(*scene);
        *scene = NULL;
    }
    return status;
}
