/* yaml_setting.c -- one `--set KEY=VALUE`: finds or makes the place that the key names, and parses the value into it.
 *
 * Place: after the file is parsed, before anything is interpreted, so that a setting is checked exactly like the file.
 * Keys: names joined by dots, indices in brackets from 0: camera.eye, lights[0].intensity, objects[2].polygon[0][1].
 */
#include "io/yaml_store.h"

#include <stdio.h>
#include <string.h>

static gno_status fail_key(gnoi_yaml *tree, const char *key, const char *format, const char *detail)
{
    char message[512], shown[GNOI_YAML_SHOWN], what[256];
    snprintf(what, sizeof what, format, detail);
    snprintf(message, sizeof message, "--set %s: %s", gnoi_yaml_show(key, shown), what);
    return gno_context_fail(gnoi_yaml_context(tree), GNO_ERROR_INPUT, message);
}

/* Makes the node one that the setting brought: messages about it and what is below name the setting. */
static void mark(gnoi_yaml_node *node)
{
    node->set = 1;
    node->line = 0;
}

static gno_status step_name(gnoi_yaml *tree, const char *key, const char **rest, gnoi_yaml_node **node)
{
    char shown[GNOI_YAML_SHOWN];
    size_t length = strcspn(*rest, ".[");
    if (length == 0) return fail_key(tree, key, "%s", "is not a key like camera.eye or lights[0].intensity");
    const char *name = gnoi_yaml_copy_text(tree, *rest, length);
    if (!name) return gnoi_yaml_no_memory(tree);
    *rest += length;
    if (gnoi_yaml_is_null(*node)) {
        (*node)->kind = GNOI_YAML_MAPPING;
        (*node)->text = NULL;
        (*node)->plain = 0;
    }
    if ((*node)->kind != GNOI_YAML_MAPPING) {
        return fail_key(tree, key, "the place of \"%s\" is not one that has keys", gnoi_yaml_show(name, shown));
    }
    gnoi_yaml_node *child = gnoi_yaml_find(*node, name);
    if (!child) {
        gno_status status = GNO_OK;
        child = gnoi_yaml_add(tree, *node, &status);
        if (!child) return status;
        child->key = name;
        child->kind = GNOI_YAML_SCALAR; /* nothing, until a value or a key below it comes */
        child->plain = 1;
        child->text = "";
        mark(child);
    }
    *node = child;
    return GNO_OK;
}

static gno_status step_index(gnoi_yaml *tree, const char *key, const char **rest, gnoi_yaml_node **node)
{
    char count[64];
    size_t digits = strspn(*rest + 1, "0123456789");
    if (digits == 0 || digits > 9 || (*rest)[1 + digits] != ']') {
        return fail_key(tree, key, "%s", "an index is a number in brackets, as in lights[0]");
    }
    unsigned long index = 0;
    for (size_t i = 1; i <= digits; i++) index = 10 * index + (unsigned long)((*rest)[i] - '0');
    *rest += digits + 2;
    if ((*node)->kind != GNOI_YAML_SEQUENCE) return fail_key(tree, key, "%s", "there is no list at the place of the index");
    if (index >= (*node)->count) {
        snprintf(count, sizeof count, "%lu %s", (unsigned long)(*node)->count, (*node)->count == 1 ? "entry" : "entries");
        return fail_key(tree, key, "the list has %s, counted from 0", count);
    }
    gnoi_yaml_node *child = (*node)->first;
    while (index-- > 0) child = child->next;
    *node = child;
    return GNO_OK;
}

/* The last step's place, made where it is missing. */
static gno_status find_place(gnoi_yaml *tree, const char *key, gnoi_yaml_node **node)
{
    const char *rest = key;
    *node = gnoi_yaml_root(tree);
    for (size_t depth = 0; depth == 0 || *rest; depth++) {
        if (depth >= GNOI_YAML_MAX_DEPTH) return fail_key(tree, key, "%s", "is nested too deeply");
        int is_index = *rest == '[';
        if (depth > 0 && *rest == '.') rest++;
        else if (depth > 0 && !is_index) return fail_key(tree, key, "%s", "after an index comes a dot or another index");
        gno_status status = is_index ? step_index(tree, key, &rest, node) : step_name(tree, key, &rest, node);
        if (status != GNO_OK) return status;
    }
    return GNO_OK;
}

gno_status gnoi_yaml_set(gnoi_yaml *tree, const char *key, const char *value)
{
    gnoi_yaml_node *node = NULL;
    if (!key || !value) return gno_context_fail(gnoi_yaml_context(tree), GNO_ERROR_ARGUMENT, "a setting without key or value");
    gno_status status = find_place(tree, key, &node);
    if (status != GNO_OK) return status;
    mark(node);
    return gnoi_yaml_parse_into(tree, node, value, strlen(value));
}
