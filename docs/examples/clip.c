/* clip.c -- a floor with three shadows on it, two of which overlap: what is lit, as polygons. */
#include <gnomon/gnomon_clip.h>
#include <stdio.h>

static void print(const gno_shape *shape)
{
    size_t p, r, i;
    for (p = 0; p < shape->polygon_count; p++)
        for (r = shape->polygon_start[p]; r < shape->polygon_start[p + 1]; r++) {
            printf(r == shape->polygon_start[p] ? "polygon" : "   hole");
            for (i = shape->ring_start[r]; i < shape->ring_start[r + 1]; i++)
                printf(" (%g, %g)", shape->points[2 * i], shape->points[2 * i + 1]);
            printf("\n");
        }
}

int main(void)
{
    static const double floor_points[] = {0, 0, 8, 0, 8, 6, 0, 6};
    static const double shadow_points[] = {1, 1, 4, 1, 4, 4, 1, 4, 3, 2, 9, 2, 9, 3, 3, 3, 5, 4, 6, 4, 6, 5};
    static const size_t ring_start[] = {0, 4, 8, 11};
    gno_shape ground = {1, NULL, 1, NULL, NULL}, shadows = {3, NULL, 3, NULL, NULL}, lit;
    gno_context *context;
    gno_clipper *clipper;
    int failed;

    ground.ring_start = shadows.ring_start = ring_start;
    ground.points = floor_points;
    shadows.points = shadow_points;
    if (gno_context_create(NULL, &context) != GNO_OK)
        return 1;
    failed = gno_clipper_create(context, &clipper) != GNO_OK ||
             gno_clip(clipper, GNO_CLIP_DIFFERENCE, &ground, &shadows, &lit) != GNO_OK;
    if (failed) {
        fprintf(stderr, "%s\n", gno_context_message(context));
    } else {
        print(&lit);
        printf("lit: %g of %g\n", gno_shape_area(&lit), gno_shape_area(&ground));
    }
    gno_clipper_destroy(clipper);
    gno_context_destroy(context);
    return failed;
}
