/* info_text.c -- gnomon info as a table for people; see info.h. */
#include "cli/info.h"

#include <stdio.h>

enum { LISTED = 8 }; /* of each kind of problem; the JSON form has all */

/* One name for values outside the list keeps the printers free of checks. */
static const char *pick(const char *const *names, int count, int index)
{
    return index >= 0 && index < count ? names[index] : "unknown";
}

const char *light_type_name(gno_light_type type)
{
    static const char *const names[] = {"point", "directional", "spot", "area"};
    return pick(names, 4, (int)type);
}

const char *falloff_name(gno_falloff falloff)
{
    static const char *const names[] = {"none", "linear", "inverse_square"};
    return pick(names, 3, (int)falloff);
}

const char *shading_name(gno_shading shading)
{
    static const char *const names[] = {"flat", "constant", "gouraud", "phong"};
    return pick(names, 4, (int)shading);
}

const char *camera_type_name(gno_camera_type type)
{
    static const char *const names[] = {"perspective", "orthographic"};
    return pick(names, 2, (int)type);
}

static void point(const char *name, const double value[3])
{
    printf("%s (%g, %g, %g)", name, value[0], value[1], value[2]);
}

static void colour(const char *name, const double value[3])
{
    if (value[0] == value[1] && value[1] == value[2]) {
        printf("%s %g", name, value[0]);
    } else {
        printf("%s %g %g %g", name, value[0], value[1], value[2]);
    }
}

static const char *plural(size_t count)
{
    return count == 1 ? "" : "s";
}

/* Names come from files and must not reach the terminal as commands. */
static void name_text(const char *text)
{
    for (const unsigned char *c = (const unsigned char *)text; *c != '\0'; c++) {
        putchar(*c < 0x20 || *c == 0x7F ? '?' : *c);
    }
}

static void print_view(const summary *found)
{
    const gno_image_def image = gno_scene_image(found->scene);
    const gno_camera camera = gno_scene_camera(found->scene);
    double ambient[3];
    gno_scene_ambient(found->scene, ambient);
    printf("picture    %d x %d, ", image.width, image.height);
    colour("background", image.background);
    printf("\ncamera     %s, ", camera_type_name(camera.type));
    point("eye", camera.eye);
    point(", target", camera.target);
    point(", up", camera.up);
    if (camera.type == GNO_CAMERA_PERSPECTIVE) {
        printf(", fov %g\n", camera.fov);
    } else {
        printf(", height %g\n", camera.height);
    }
    colour("ambient   ", ambient);
    putchar('\n');
}

static void print_lights(const summary *found)
{
    printf("lights     %zu\n", found->counts.lights);
    for (size_t i = 0; i < found->counts.lights; i++) {
        gno_light light;
        const char *name = NULL;
        if (gno_scene_light(found->scene, (int)i, &light, &name) != GNO_OK) {
            continue;
        }
        printf("  %-4zu ", i);
        name_text(name != NULL && name[0] != '\0' ? name : "(no name)");
        printf(": %s", light_type_name(light.type));
        if (light.type != GNO_LIGHT_DIRECTIONAL) {
            point(", position", light.position);
        }
        if (light.type == GNO_LIGHT_DIRECTIONAL || light.type == GNO_LIGHT_SPOT) {
            point(", direction", light.direction);
        }
        if (light.type == GNO_LIGHT_SPOT) {
            printf(", angle %g", light.angle);
        }
        if (light.type == GNO_LIGHT_AREA) {
            point(", edge1", light.edge1);
            point(", edge2", light.edge2);
            printf(", %d x %d points", light.samples, light.samples);
        }
        colour(", intensity", light.intensity);
        if (light.falloff != GNO_FALLOFF_NONE) {
            printf(", falloff %s", falloff_name(light.falloff));
        }
        if (light.softness > 0) {
            printf(", softness %g", light.softness);
        }
        putchar('\n');
    }
}

static void print_materials(const summary *found)
{
    printf("materials  %zu\n", found->counts.materials);
    for (size_t i = 0; i < found->counts.materials; i++) {
        gno_material material;
        if (gno_scene_material(found->scene, (int)i, &material) != GNO_OK) {
            continue;
        }
        printf("  %-4zu %zu polygon%s: %s", i, found->material_polygons[i], plural(found->material_polygons[i]), shading_name(material.shading));
        colour(", ambient", material.ambient);
        colour(", diffuse", material.diffuse);
        colour(", specular", material.specular);
        printf(", shininess %g", material.shininess);
        if (material.transmission[0] > 0.0 || material.transmission[1] > 0.0 || material.transmission[2] > 0.0) {
            colour(", transmission", material.transmission);
        }
        printf("%s\n", material.two_sided ? "" : ", one-sided");
    }
}

static size_t count_borders(const found_list *list)
{
    size_t borders = 0;
    for (size_t i = 0; i < list->count; i++) {
        borders += list->items[i].border != 0;
    }
    return borders;
}

/* Names those that may be gaps; where flat parts end there is nothing to mend. */
static void print_open_edges(const gno_problem *problems, size_t count, size_t borders)
{
    const size_t gaps = count - borders;
    size_t shown = 0;
    printf("  %zu edge%s open, of one polygon alone", count, plural(count));
    if (borders > 0 && gaps > 0) {
        printf(", %zu of them where flat parts end", borders);
    } else if (borders > 0) {
        printf(", where flat parts end");
    }
    for (size_t i = 0; i < count && shown < LISTED; i++) {
        if (!problems[i].border) {
            printf("%s%zu (%d-%d)", shown++ > 0 ? ", " : ": ", problems[i].polygon, problems[i].vertex[0], problems[i].vertex[1]);
        }
    }
    printf("%s\n", gaps > shown ? ", ..." : "");
}

/* The count of a kind, and the first of its polygons or edges. */
static void print_kind(gno_problem_kind kind, const gno_problem *problems, size_t count)
{
    static const char *const words[GNO_PROBLEM_KINDS][2] = {
        {"polygon", "without area, skipped"},
        {"polygon", "not planar, split into triangles"},
        {"polygon", "given before"},
        {"polygon", "wound against neighbours"},
        {NULL, NULL}, /* open edges have words of their own */
        {"edge", "of more than two polygons"},
    };
    const char *thing = words[kind][0];
    const size_t shown = count < LISTED ? count : LISTED;
    printf("  %zu %s%s %s: ", count, thing, plural(count), words[kind][1]);
    for (size_t i = 0; i < shown; i++) {
        const gno_problem *p = &problems[i];
        printf("%s%zu", i > 0 ? ", " : "", p->polygon);
        if (kind == GNO_PROBLEM_DUPLICATE) {
            printf(" (as %ld)", p->other);
        } else if (p->vertex[0] >= 0) {
            printf(" (%d-%d)", p->vertex[0], p->vertex[1]);
        }
    }
    printf("%s\n", count > shown ? ", ..." : "");
}

static void print_problems(const summary *found)
{
    const gno_scene_problems *p = &found->problems;
    if (p->details > 0) {
        printf("details    %zu found\n", p->details);
    }
    const size_t borders = count_borders(&found->list);
    printf(found->list.count == borders && found->warning_count == 0 ? "problems   none\n" : "problems\n");
    for (size_t i = 0; i < found->warning_count; i++) {
        printf("  ");
        name_text(found->warnings[i]);
        putchar('\n');
    }
    const gno_problem *next = found->list.items;
    for (int kind = 0; kind < GNO_PROBLEM_KINDS; kind++) {
        const size_t count = found->problem_counts[kind];
        if (count > 0 && kind == GNO_PROBLEM_OPEN_EDGE) {
            print_open_edges(next, count, borders);
        } else if (count > 0) {
            print_kind((gno_problem_kind)kind, next, count);
        }
        next += count;
    }
}

void info_text(const summary *found)
{
    const gno_scene_counts *c = &found->counts;
    printf("scene      ");
    name_text(found->path);
    printf("\ncontents   %zu object%s, %zu polygon%s with %zu hole%s, %zu corners\n", c->objects, plural(c->objects), c->polygons,
           plural(c->polygons), found->holes, plural(found->holes), c->corners);
    printf("           %zu vertices, %zu normals, %zu texture coordinates\n", c->vertices, c->normals, c->texcoords);
    if (found->has_bounds) {
        point("bounds    ", found->lower);
        point(" to", found->upper);
        putchar('\n');
    } else {
        printf("bounds     none: there is no polygon\n");
    }
    print_view(found);
    print_lights(found);
    print_materials(found);
    print_problems(found);
}
