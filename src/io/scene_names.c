/* scene_names.c -- named things of a scene file, sorted for searching; messages about names that are not there.
 * Place: under scene_material.c and scene_object.c.
 */
#include "io/scene_yaml.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

gno_status gnoi_names_create(gno_context *context, size_t count, gnoi_names *names)
{
    names->count = 0;
    names->capacity = count ? count : 1;
    names->items = gno_context_realloc(context, NULL, 0, names->capacity * sizeof *names->items);
    if (names->items) return GNO_OK;
    names->capacity = 0;
    return gno_context_fail(context, GNO_ERROR_MEMORY, "out of memory while reading a scene file");
}

void gnoi_scene_names_free(gno_context *context, gnoi_names *names)
{
    if (names->items) gno_context_realloc(context, names->items, names->capacity * sizeof *names->items, 0);
    memset(names, 0, sizeof *names);
}

static int by_name(const void *a, const void *b)
{
    const gnoi_name *x = a, *y = b;
    int order = strcmp(x->name, y->name);
    return order != 0 ? order : (x->value > y->value) - (x->value < y->value);
}

void gnoi_names_sort(gnoi_names *names)
{
    if (names->count > 1) qsort(names->items, names->count, sizeof *names->items, by_name);
}

const gnoi_name *gnoi_names_find(const gnoi_names *names, const char *name)
{
    size_t low = 0, high = names->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (strcmp(names->items[middle].name, name) < 0) low = middle + 1;
        else high = middle;
    }
    return low < names->count && !strcmp(names->items[low].name, name) ? &names->items[low] : NULL;
}

gno_status gnoi_names_fail(const gnoi_yaml *yaml, const gnoi_yaml_node *node, const gnoi_names *names, const char *what,
                           const char *name)
{
    char shown[GNOI_YAML_SHOWN], near[GNOI_YAML_SHOWN];
    gnoi_nearest nearest = gnoi_nearest_start(name);
    for (size_t i = 0; i < names->count; i++) gnoi_nearest_try(&nearest, names->items[i].name);
    gnoi_yaml_show(name, shown);
    if (!nearest.best) return gnoi_yaml_fail(yaml, node, GNO_ERROR_INPUT, "there is no %s \"%s\"", what, shown);
    return gnoi_yaml_fail(yaml, node, GNO_ERROR_INPUT, "there is no %s \"%s\", did you mean \"%s\"?", what, shown,
                          gnoi_yaml_show(nearest.best, near));
}

gno_status gnoi_wrap(const gnoi_yaml *yaml, const gnoi_yaml_node *node, gno_status status)
{
    char message[1024];
    if (status == GNO_OK || status == GNO_ERROR_MEMORY || status == GNO_ERROR_CANCELLED) return status;
    if (status == GNO_ERROR_ARGUMENT) status = GNO_ERROR_INPUT; /* the file's fault, not the caller's */
    snprintf(message, sizeof message, "%s", gno_context_message(gnoi_yaml_context(yaml)));
    return gnoi_yaml_fail(yaml, node, status, "%s", message);
}
