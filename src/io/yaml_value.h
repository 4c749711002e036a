/* yaml_value.h -- typed values out of a YAML tree, with messages.
 *
 * Place: between the tree and the readers of single sections (scene_*.c). A section is described by a table of fields; one
 * call reads a whole mapping into a structure and refuses keys that the table does not have.
 */
#ifndef GNOI_IO_YAML_VALUE_H
#define GNOI_IO_YAML_VALUE_H

#include "io/yaml_tree.h"

#include <stddef.h>

/* What a field holds, and the type that it is stored as. */
typedef enum gnoi_field_kind {
    GNOI_FIELD_NODE,      /* anything; read by the caller */
    GNOI_FIELD_TEXT,      /* const char *, lives as long as the tree; not empty */
    GNOI_FIELD_BOOL,      /* int */
    GNOI_FIELD_CHOICE,    /* int, index into the field's choices */
    GNOI_FIELD_INTEGER,   /* int in [low,high] */
    GNOI_FIELD_NUMBER,    /* double, any finite one */
    GNOI_FIELD_FROM_0,    /* double >= 0 */
    GNOI_FIELD_ABOVE_0,   /* double > 0 */
    GNOI_FIELD_BETWEEN,   /* double in [low,high] */
    GNOI_FIELD_INSIDE,    /* double in (low,high) */
    GNOI_FIELD_POINT,     /* double[3], coordinates */
    GNOI_FIELD_DIRECTION, /* double[3], not zero */
    GNOI_FIELD_COLOUR,    /* double[3] >= 0; one number stands for three */
    GNOI_FIELD_SHARE      /* double[3] in [0,1]; one number stands for three */
} gnoi_field_kind;

typedef struct gnoi_field {
    const char *key;
    gnoi_field_kind kind;
    size_t offset;              /* in the target structure */
    double low, high;           /* INTEGER, BETWEEN, INSIDE */
    const char *const *choices; /* CHOICE: NULL ends them */
} gnoi_field;

#define GNOI_MAX_FIELDS 24

/* Directions with no component beyond this are zero: their lengths are not numbers that mean anything. */
#define GNOI_ZERO_DIRECTION 1e-30

/* Reads the mapping `node` into target. seen[i] is the node of fields[i], NULL where the mapping lacks it; target keeps what it
 * held there. Unknown keys fail, with the nearest known one. */
gno_status gnoi_read_fields(const gnoi_yaml *tree, const gnoi_yaml_node *node, const gnoi_field *fields, size_t count,
                            void *target, const gnoi_yaml_node **seen);

/* One value, by the kind of its field. */
gno_status gnoi_read_field(const gnoi_yaml *tree, const gnoi_yaml_node *node, const gnoi_field *field, void *target);

gno_status gnoi_read_number(const gnoi_yaml *tree, const gnoi_yaml_node *node, double *number);
gno_status gnoi_read_point(const gnoi_yaml *tree, const gnoi_yaml_node *node, double point[3]);
gno_status gnoi_need_mapping(const gnoi_yaml *tree, const gnoi_yaml_node *node);
gno_status gnoi_need_list(const gnoi_yaml *tree, const gnoi_yaml_node *node);

/* A number by YAML 1.2's core schema whatever the locale: 1, -2.5, .5, 1e-3, 0x1f, 0o17, .inf, .nan. Correctly rounded.
 * Returns 0 where the text is no number. */
int gnoi_yaml_parse_number(const char *text, double *number);

/* A nearest-name helper: feed candidates one by one, then ask. */
typedef struct gnoi_nearest {
    const char *wanted;
    const char *best; /* NULL: nothing near enough */
    size_t distance;
} gnoi_nearest;

gnoi_nearest gnoi_nearest_start(const char *wanted);
void gnoi_nearest_try(gnoi_nearest *nearest, const char *candidate);

#endif
