/* view.c -- see view.h. */
#include "project/view.h"

/* The nearest visible depth as a share of the scene's size: small enough to lose nothing, large enough that picture
 * coordinates of clipped vertices stay far inside double range. */
#define NEAR_SHARE 1e-7

#define PI 3.14159265358979323846

static gnoi_form form_through(vec3 a, vec3 origin)
{
    gnoi_form f;
    f.a = a;
    f.b = -v3_dot(a, origin);
    return f;
}

static gnoi_form form_combine(gnoi_form f, double s, gnoi_form g, double t)
{
    f.a = v3_add(v3_scale(f.a, s), v3_scale(g.a, t));
    f.b = f.b * s + g.b * t;
    return f;
}

gnoi_view gnoi_view_make(const gno_camera *camera, const gno_image_def *image, double scale)
{
    gnoi_view view;
    gnoi_form right, up;
    view.orthographic = camera->type == GNO_CAMERA_ORTHOGRAPHIC;
    view.width = image->width;
    view.height = image->height;
    view.eye = v3_from(camera->eye);
    view.forward = v3_unit(v3_sub(v3_from(camera->target), view.eye));
    view.right = v3_unit(v3_cross(view.forward, v3_from(camera->up)));
    view.up = v3_cross(view.right, view.forward);
    view.depth = form_through(view.forward, view.eye);
    right = form_through(view.right, view.eye);
    up = form_through(view.up, view.eye);
    if (view.orthographic) {
        view.s = image->height / camera->height;
        view.w.a = v3(0, 0, 0);
        view.w.b = 1;
        view.near_depth = 0;
    } else {
        view.s = image->height / (2 * tan(camera->fov * PI / 360));
        view.w = view.depth;
        view.near_depth = NEAR_SHARE * scale;
    }
    view.unit = 1 / view.s;
    view.x = form_combine(right, view.s, view.w, 0.5 * image->width);
    view.y = form_combine(up, -view.s, view.w, 0.5 * image->height);
    return view;
}
