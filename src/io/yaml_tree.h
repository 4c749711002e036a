/* yaml_tree.h -- a YAML text as a tree of nodes that know where they came from.
 *
 * Place: between libyaml's events and the scene reader.
 *
 *   file text --libyaml events--> gnoi_yaml_parse --> tree --gnoi_yaml_set (settings)--> tree --> scene_yaml.c
 *
 * An alias becomes a copy of what its anchor names, so every node has one parent, one place in the tree and therefore one
 * key path for messages, and a setting changes one place only. Copies count towards the limit of nodes: a text of nested
 * aliases runs into it instead of into the machine's memory. Duplicate keys, tags, second documents and keys that are not
 * plain words are errors, so the scene reader need not think of them.
 */
#ifndef GNOI_IO_YAML_TREE_H
#define GNOI_IO_YAML_TREE_H

#include <gnomon/gnomon.h>
#include <stdint.h>

#define GNOI_YAML_MAX_BYTES ((size_t)64 << 20) /* of a file */
#define GNOI_YAML_MAX_NODES ((size_t)1 << 22)  /* in a tree, aliases counted as copies */
#define GNOI_YAML_MAX_DEPTH 64
#define GNOI_YAML_MAX_ANCHORS 1024

typedef enum gnoi_yaml_kind { GNOI_YAML_SCALAR, GNOI_YAML_SEQUENCE, GNOI_YAML_MAPPING } gnoi_yaml_kind;

typedef struct gnoi_yaml_node {
    struct gnoi_yaml_node *parent, *first, *last, *next;
    const char *key;  /* within a mapping, otherwise NULL */
    const char *text; /* of a scalar, otherwise NULL; holds no inner NUL */
    uint32_t line, column; /* from 1; of the key where there is one */
    uint32_t count;        /* of children */
    uint8_t kind;          /* a gnoi_yaml_kind */
    uint8_t plain;         /* a scalar without quotes: may be a number, a truth value or nothing */
    uint8_t set;           /* came from a setting, not from the file */
} gnoi_yaml_node;

typedef struct gnoi_yaml gnoi_yaml;

/* An empty mapping as root; `path` (NULL: none) names the file in messages and is not copied. */
gno_status gnoi_yaml_create(gno_context *context, const char *path, gnoi_yaml **tree);
void gnoi_yaml_destroy(gnoi_yaml *tree); /* NULL is accepted */
gno_context *gnoi_yaml_context(const gnoi_yaml *tree);
gnoi_yaml_node *gnoi_yaml_root(const gnoi_yaml *tree);

/* Reads the tree's file and makes it the tree. Errors: FILE, INPUT, LIMIT, MEMORY. */
gno_status gnoi_yaml_load(gnoi_yaml *tree);

/* Parses a text and makes it the tree. */
gno_status gnoi_yaml_parse(gnoi_yaml *tree, const char *text, size_t size);

/* One setting: `key` is a dotted path with indices, `value` YAML. Missing keys of mappings are made on the way. */
gno_status gnoi_yaml_set(gnoi_yaml *tree, const char *key, const char *value);

/* The value of a mapping's key, NULL if there is none. */
gnoi_yaml_node *gnoi_yaml_find(const gnoi_yaml_node *mapping, const char *key);

/* True for a missing value: an empty plain scalar, ~ or null. */
int gnoi_yaml_is_null(const gnoi_yaml_node *node);

/* Fails with "FILE:LINE: key.path[1].sub: what", or "--set key.path: what" for a node that a setting brought. */
gno_status gnoi_yaml_fail(const gnoi_yaml *tree, const gnoi_yaml_node *node, gno_status status, const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 4, 5)))
#endif
    ;

/* Logs the same as a warning. */
void gnoi_yaml_warn(const gnoi_yaml *tree, const gnoi_yaml_node *node, const char *what);

/* Fails at a key that a mapping does not have: "FILE:LINE: mapping.path.key: what". */
gno_status gnoi_yaml_fail_missing(const gnoi_yaml *tree, const gnoi_yaml_node *mapping, const char *key, const char *what);

/* A text for a message: on one line, shortened to fit. Returns buffer. */
#define GNOI_YAML_SHOWN 80
const char *gnoi_yaml_show(const char *text, char buffer[GNOI_YAML_SHOWN]);

#endif
