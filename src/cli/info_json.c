/* info_json.c -- gnomon info as one JSON object, in the words of the scene file; see info.h. */
#include "cli/info.h"
#include "cli/json.h"

#include <stdio.h>

static void vector(const char *name, const double value[3])
{
    printf("\"%s\": ", name);
    json_vector(stdout, value);
}

static void number(const char *name, double value)
{
    printf("\"%s\": ", name);
    json_number(stdout, value);
}

static void print_view(const summary *found)
{
    const gno_image_def image = gno_scene_image(found->scene);
    const gno_camera camera = gno_scene_camera(found->scene);
    double ambient[3];
    gno_scene_ambient(found->scene, ambient);
    printf("  \"image\": {\"width\": %d, \"height\": %d, ", image.width, image.height);
    vector("background", image.background);
    printf("},\n  \"camera\": {\"type\": \"%s\", ", camera_type_name(camera.type));
    vector("eye", camera.eye);
    printf(", ");
    vector("target", camera.target);
    printf(", ");
    vector("up", camera.up);
    printf(", ");
    if (camera.type == GNO_CAMERA_PERSPECTIVE) {
        number("fov", camera.fov);
    } else {
        number("height", camera.height);
    }
    printf("},\n  ");
    vector("ambient", ambient);
    printf(",\n");
}

static void print_light(const gno_light *light, const char *name)
{
    printf("{\"name\": ");
    json_string(stdout, name != NULL ? name : "");
    printf(", \"type\": \"%s\", ", light_type_name(light->type));
    if (light->type != GNO_LIGHT_DIRECTIONAL) {
        vector("position", light->position);
        printf(", ");
    }
    if (light->type == GNO_LIGHT_DIRECTIONAL || light->type == GNO_LIGHT_SPOT) {
        vector("direction", light->direction);
        printf(", ");
    }
    if (light->type == GNO_LIGHT_SPOT) {
        number("angle", light->angle);
        printf(", ");
    }
    if (light->type == GNO_LIGHT_AREA) {
        vector("edge1", light->edge1);
        printf(", ");
        vector("edge2", light->edge2);
        printf(", \"samples\": %d, ", light->samples);
    }
    vector("intensity", light->intensity);
    printf(", \"falloff\": \"%s\", \"softness\": %.9g}", falloff_name(light->falloff), light->softness);
}

static void print_material(const gno_material *material, size_t polygons)
{
    printf("{\"polygons\": %zu, \"shading\": \"%s\", ", polygons, shading_name(material->shading));
    vector("ambient", material->ambient);
    printf(", ");
    vector("diffuse", material->diffuse);
    printf(", ");
    vector("specular", material->specular);
    printf(", ");
    number("shininess", material->shininess);
    printf(", ");
    vector("transmission", material->transmission);
    printf(", \"two_sided\": %s}", material->two_sided ? "true" : "false");
}

static const char *const kind_keys[GNO_PROBLEM_KINDS] = {"degenerate", "non_planar", "duplicate", "flipped", "open_edges", "crowded_edges"};

/* Polygons as their numbers, others with what belongs to them. */
static void print_problem(const gno_problem *problem)
{
    switch (problem->kind) {
    case GNO_PROBLEM_DUPLICATE:
        printf("{\"polygon\": %zu, \"of\": %ld}", problem->polygon, problem->other);
        break;
    case GNO_PROBLEM_OPEN_EDGE:
    case GNO_PROBLEM_CROWDED_EDGE:
        printf("{\"polygon\": %zu, \"vertices\": [%d, %d]%s}", problem->polygon, problem->vertex[0], problem->vertex[1],
               problem->border ? ", \"border\": true" : "");
        break;
    default:
        printf("%zu", problem->polygon);
    }
}

static void print_problems(const summary *found)
{
    const gno_problem *next = found->list.items;
    size_t borders = 0;
    for (size_t i = 0; i < found->list.count; i++) {
        borders += next[i].border != 0;
    }
    printf("  \"problems\": {");
    for (int kind = 0; kind < GNO_PROBLEM_KINDS; kind++) {
        printf("\"%s\": %zu, ", kind_keys[kind], found->problem_counts[kind]);
    }
    printf("\"border_edges\": %zu, \"details_found\": %zu,\n    \"ids\": {", borders, found->problems.details);
    for (int kind = 0; kind < GNO_PROBLEM_KINDS; kind++) {
        printf("%s\"%s\": [", kind > 0 ? ",\n      " : "\n      ", kind_keys[kind]);
        for (size_t i = 0; i < found->problem_counts[kind]; i++) {
            printf("%s", i > 0 ? ", " : "");
            print_problem(next++);
        }
        printf("]");
    }
    printf("},\n    \"warnings\": [");
    for (size_t i = 0; i < found->warning_count; i++) {
        printf("%s", i > 0 ? ",\n      " : "\n      ");
        json_string(stdout, found->warnings[i]);
    }
    printf("]}\n");
}

void info_json(const summary *found)
{
    const gno_scene_counts *c = &found->counts;
    printf("{\n  \"scene\": ");
    json_string(stdout, found->path);
    printf(",\n  \"counts\": {\"objects\": %zu, \"polygons\": %zu, \"holes\": %zu, \"rings\": %zu, \"corners\": %zu, \"vertices\": %zu, "
           "\"normals\": %zu, \"texcoords\": %zu, \"materials\": %zu, \"lights\": %zu},\n",
           c->objects, c->polygons, found->holes, c->rings, c->corners, c->vertices, c->normals, c->texcoords, c->materials, c->lights);
    if (found->has_bounds) {
        printf("  \"bounds\": {");
        vector("lower", found->lower);
        printf(", ");
        vector("upper", found->upper);
        printf("},\n");
    } else {
        printf("  \"bounds\": null,\n");
    }
    print_view(found);
    printf("  \"lights\": [");
    for (size_t i = 0; i < c->lights; i++) {
        gno_light light;
        const char *name = NULL;
        if (gno_scene_light(found->scene, (int)i, &light, &name) == GNO_OK) {
            printf("%s", i > 0 ? ",\n    " : "\n    ");
            print_light(&light, name);
        }
    }
    printf("],\n  \"materials\": [");
    for (size_t i = 0; i < c->materials; i++) {
        gno_material material;
        if (gno_scene_material(found->scene, (int)i, &material) == GNO_OK) {
            printf("%s", i > 0 ? ",\n    " : "\n    ");
            print_material(&material, found->material_polygons[i]);
        }
    }
    printf("],\n");
    print_problems(found);
    printf("}\n");
}
