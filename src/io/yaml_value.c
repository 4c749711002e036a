/* yaml_value.c -- see yaml_value.h: fields of a mapping, each checked, each failure naming its key path. */
#include "io/yaml_value.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- shapes ------------------------------------------------------------------------------------------------------------- */

static const char *kind_of(const gnoi_yaml_node *node)
{
    if (gnoi_yaml_is_null(node)) return "nothing";
    return node->kind == GNOI_YAML_MAPPING ? "a mapping" : node->kind == GNOI_YAML_SEQUENCE ? "a list" : "a single value";
}

gno_status gnoi_need_mapping(const gnoi_yaml *tree, const gnoi_yaml_node *node)
{
    if (node->kind == GNOI_YAML_MAPPING) return GNO_OK;
    return gnoi_yaml_fail(tree, node, GNO_ERROR_INPUT, "must be a mapping {key: value, ...}, is %s", kind_of(node));
}

gno_status gnoi_need_list(const gnoi_yaml *tree, const gnoi_yaml_node *node)
{
    if (node->kind == GNOI_YAML_SEQUENCE) return GNO_OK;
    return gnoi_yaml_fail(tree, node, GNO_ERROR_INPUT, "must be a list, is %s", kind_of(node));
}

/* ---- one number --------------------------------------------------------------------------------------------------------- */

static gno_status fail_value(const gnoi_yaml *tree, const gnoi_yaml_node *node, const char *what)
{
    char shown[GNOI_YAML_SHOWN];
    return gnoi_yaml_fail(tree, node, GNO_ERROR_INPUT, "%s %s", gnoi_yaml_show(node->text, shown), what);
}

gno_status gnoi_read_number(const gnoi_yaml *tree, const gnoi_yaml_node *node, double *number)
{
    char shown[GNOI_YAML_SHOWN];
    double value;
    if (node->kind != GNOI_YAML_SCALAR || gnoi_yaml_is_null(node)) {
        return gnoi_yaml_fail(tree, node, GNO_ERROR_INPUT, "must be a number, is %s", kind_of(node));
    }
    if (!node->plain || !gnoi_yaml_parse_number(node->text, &value)) {
        return gnoi_yaml_fail(tree, node, GNO_ERROR_INPUT, "\"%s\" is not a number", gnoi_yaml_show(node->text, shown));
    }
    if (!isfinite(value)) return fail_value(tree, node, "is not a finite number");
    *number = value;
    return GNO_OK;
}

static gno_status check_range(const gnoi_yaml *tree, const gnoi_yaml_node *node, const gnoi_field *field, double value)
{
    char what[128];
    switch (field->kind) {
    case GNOI_FIELD_FROM_0:
    case GNOI_FIELD_COLOUR: return value >= 0 ? GNO_OK : fail_value(tree, node, "is negative");
    case GNOI_FIELD_ABOVE_0: return value > 0 ? GNO_OK : fail_value(tree, node, "is not above 0");
    case GNOI_FIELD_SHARE:
        return value >= 0 && value <= 1 ? GNO_OK : fail_value(tree, node, "is not between 0 and 1");
    case GNOI_FIELD_BETWEEN:
    case GNOI_FIELD_INTEGER:
        if (value >= field->low && value <= field->high) return GNO_OK;
        snprintf(what, sizeof what, "is not between %.15g and %.15g", field->low, field->high);
        return fail_value(tree, node, what);
    case GNOI_FIELD_INSIDE:
        if (value > field->low && value < field->high) return GNO_OK;
        snprintf(what, sizeof what, "is not above %.15g and below %.15g", field->low, field->high);
        return fail_value(tree, node, what);
    case GNOI_FIELD_POINT:
    case GNOI_FIELD_DIRECTION:
        if (fabs(value) <= GNO_MAX_COORDINATE) return GNO_OK;
        snprintf(what, sizeof what, "is beyond the largest coordinate, %g", GNO_MAX_COORDINATE);
        return fail_value(tree, node, what);
    default: return GNO_OK;
    }
}

static gno_status read_number(const gnoi_yaml *tree, const gnoi_yaml_node *node, const gnoi_field *field, double *number)
{
    gno_status status = gnoi_read_number(tree, node, number);
    return status != GNO_OK ? status : check_range(tree, node, field, *number);
}

static gno_status read_integer(const gnoi_yaml *tree, const gnoi_yaml_node *node, const gnoi_field *field, int *out)
{
    double value;
    gno_status status = gnoi_read_number(tree, node, &value);
    if (status != GNO_OK) return status;
    if (value != floor(value)) return fail_value(tree, node, "is not a whole number");
    if ((status = check_range(tree, node, field, value)) != GNO_OK) return status;
    *out = (int)value;
    return GNO_OK;
}

/* ---- three numbers ------------------------------------------------------------------------------------------------------ */

static gno_status read_three(const gnoi_yaml *tree, const gnoi_yaml_node *node, const gnoi_field *field, double out[3])
{
    int one_is_enough = field->kind == GNOI_FIELD_COLOUR || field->kind == GNOI_FIELD_SHARE;
    if (node->kind == GNOI_YAML_SCALAR && one_is_enough && !gnoi_yaml_is_null(node)) {
        gno_status status = read_number(tree, node, field, out);
        out[1] = out[2] = out[0];
        return status;
    }
    if (node->kind != GNOI_YAML_SEQUENCE) {
        return gnoi_yaml_fail(tree, node, GNO_ERROR_INPUT, "must be %s[.., .., ..], is %s",
                              one_is_enough ? "a number or three, " : "three numbers, ", kind_of(node));
    }
    if (node->count != 3) {
        return gnoi_yaml_fail(tree, node, GNO_ERROR_INPUT, "must have 3 numbers, has %lu", (unsigned long)node->count);
    }
    int i = 0;
    for (const gnoi_yaml_node *child = node->first; child; child = child->next) {
        gno_status status = read_number(tree, child, field, &out[i++]);
        if (status != GNO_OK) return status;
    }
    if (field->kind == GNOI_FIELD_DIRECTION && fabs(out[0]) < GNOI_ZERO_DIRECTION && fabs(out[1]) < GNOI_ZERO_DIRECTION &&
        fabs(out[2]) < GNOI_ZERO_DIRECTION) {
        return gnoi_yaml_fail(tree, node, GNO_ERROR_INPUT, "is a direction without length");
    }
    return GNO_OK;
}

gno_status gnoi_read_point(const gnoi_yaml *tree, const gnoi_yaml_node *node, double point[3])
{
    static const gnoi_field field = {"", GNOI_FIELD_POINT, 0, 0, 0, NULL};
    return read_three(tree, node, &field, point);
}

/* ---- words -------------------------------------------------------------------------------------------------------------- */

static gno_status read_text(const gnoi_yaml *tree, const gnoi_yaml_node *node, const char **text)
{
    if (node->kind != GNOI_YAML_SCALAR || !*node->text || gnoi_yaml_is_null(node)) {
        const char *is = node->kind == GNOI_YAML_SCALAR ? "empty" : kind_of(node);
        return gnoi_yaml_fail(tree, node, GNO_ERROR_INPUT, "must be a text, is %s", is);
    }
    *text = node->text;
    return GNO_OK;
}

static gno_status read_bool(const gnoi_yaml *tree, const gnoi_yaml_node *node, int *out)
{
    static const char *const words[] = {"false", "False", "FALSE", "true", "True", "TRUE"};
    char shown[GNOI_YAML_SHOWN];
    if (node->kind != GNOI_YAML_SCALAR) {
        return gnoi_yaml_fail(tree, node, GNO_ERROR_INPUT, "must be true or false, is %s", kind_of(node));
    }
    for (int i = 0; i < 6 && node->plain; i++) {
        if (!strcmp(node->text, words[i])) {
            *out = i >= 3;
            return GNO_OK;
        }
    }
    return gnoi_yaml_fail(tree, node, GNO_ERROR_INPUT, "\"%s\" is not one of true, false", gnoi_yaml_show(node->text, shown));
}

static void join(char *buffer, size_t size, const char *separator, const char *word)
{
    size_t used = strlen(buffer);
    snprintf(buffer + used, size - used, "%s%s", used ? separator : "", word);
}

static gno_status read_choice(const gnoi_yaml *tree, const gnoi_yaml_node *node, const char *const *choices, int *out)
{
    char list[512] = "", shown[GNOI_YAML_SHOWN];
    int scalar = node->kind == GNOI_YAML_SCALAR;
    for (int i = 0; choices[i]; i++) {
        if (scalar && !strcmp(node->text, choices[i])) {
            *out = i;
            return GNO_OK;
        }
        join(list, sizeof list, ", ", choices[i]);
    }
    if (!scalar) return gnoi_yaml_fail(tree, node, GNO_ERROR_INPUT, "must be one of %s, is %s", list, kind_of(node));
    return gnoi_yaml_fail(tree, node, GNO_ERROR_INPUT, "\"%s\" is not one of %s", gnoi_yaml_show(node->text, shown), list);
}

/* ---- fields ------------------------------------------------------------------------------------------------------------- */

gno_status gnoi_read_field(const gnoi_yaml *tree, const gnoi_yaml_node *node, const gnoi_field *field, void *target)
{
    if (field->kind == GNOI_FIELD_NODE) return GNO_OK; /* target may be NULL where all fields are such */
    void *out = (char *)target + field->offset;
    switch (field->kind) {
    case GNOI_FIELD_TEXT: return read_text(tree, node, out);
    case GNOI_FIELD_BOOL: return read_bool(tree, node, out);
    case GNOI_FIELD_CHOICE: return read_choice(tree, node, field->choices, out);
    case GNOI_FIELD_INTEGER: return read_integer(tree, node, field, out);
    case GNOI_FIELD_POINT:
    case GNOI_FIELD_DIRECTION:
    case GNOI_FIELD_COLOUR:
    case GNOI_FIELD_SHARE: return read_three(tree, node, field, out);
    default: return read_number(tree, node, field, out);
    }
}

static gno_status fail_unknown(const gnoi_yaml *tree, const gnoi_yaml_node *node, const gnoi_field *fields, size_t count)
{
    char list[512] = "";
    gnoi_nearest nearest = gnoi_nearest_start(node->key);
    for (size_t i = 0; i < count; i++) {
        gnoi_nearest_try(&nearest, fields[i].key);
        join(list, sizeof list, ", ", fields[i].key);
    }
    if (nearest.best) return gnoi_yaml_fail(tree, node, GNO_ERROR_INPUT, "unknown key, did you mean \"%s\"?", nearest.best);
    return gnoi_yaml_fail(tree, node, GNO_ERROR_INPUT, "unknown key, the known ones are %s", list);
}

gno_status gnoi_read_fields(const gnoi_yaml *tree, const gnoi_yaml_node *node, const gnoi_field *fields, size_t count,
                            void *target, const gnoi_yaml_node **seen)
{
    gno_status status = gnoi_need_mapping(tree, node);
    if (status != GNO_OK) return status;
    for (size_t i = 0; i < count; i++) seen[i] = NULL;
    for (const gnoi_yaml_node *child = node->first; child; child = child->next) {
        size_t i = 0;
        while (i < count && strcmp(child->key, fields[i].key)) i++;
        if (i == count) return fail_unknown(tree, child, fields, count);
        seen[i] = child;
        if ((status = gnoi_read_field(tree, child, &fields[i], target)) != GNO_OK) return status;
    }
    return GNO_OK;
}

/* ---- nearest name ------------------------------------------------------------------------------------------------------- */

enum { NEAREST_LENGTH = 40 };

/* Edits between two words: letters put in, left out, changed, or swapped with their neighbour. */
static size_t edits(const char *a, const char *b)
{
    size_t row[3][NEAREST_LENGTH + 1], n = strlen(a), m = strlen(b);
    if (n > NEAREST_LENGTH || m > NEAREST_LENGTH) return (size_t)-1;
    for (size_t j = 0; j <= m; j++) row[0][j] = j;
    for (size_t i = 1; i <= n; i++) {
        size_t *now = row[i % 3];
        const size_t *last = row[(i + 2) % 3], *before = row[(i + 1) % 3];
        now[0] = i;
        for (size_t j = 1; j <= m; j++) {
            size_t best = last[j - 1] + (a[i - 1] != b[j - 1]);
            if (last[j] + 1 < best) best = last[j] + 1;
            if (now[j - 1] + 1 < best) best = now[j - 1] + 1;
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] && before[j - 2] + 1 < best) {
                best = before[j - 2] + 1;
            }
            now[j] = best;
        }
    }
    return row[n % 3][m];
}

gnoi_nearest gnoi_nearest_start(const char *wanted)
{
    gnoi_nearest nearest = {wanted, NULL, 1 + (strlen(wanted) + 1) / 3}; /* farther than that is no slip of the pen */
    return nearest;
}

void gnoi_nearest_try(gnoi_nearest *nearest, const char *candidate)
{
    size_t distance = edits(nearest->wanted, candidate);
    if (distance > nearest->distance || (nearest->best && distance == nearest->distance)) return;
    nearest->best = candidate;
    nearest->distance = distance;
}
