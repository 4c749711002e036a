/* yaml_store.h -- what yaml_tree.c, yaml_parse.c and yaml_setting.c share and nobody else needs. Place: see yaml_tree.h. */
#ifndef GNOI_IO_YAML_STORE_H
#define GNOI_IO_YAML_STORE_H

#include "io/yaml_tree.h"

/* Memory that lives as long as the tree; NULL when it fails. */
void *gnoi_yaml_alloc(gnoi_yaml *tree, size_t size);
char *gnoi_yaml_copy_text(gnoi_yaml *tree, const char *text, size_t length);

/* Fails with GNO_ERROR_MEMORY, or with GNO_ERROR_INPUT and "FILE:LINE: what". */
gno_status gnoi_yaml_no_memory(const gnoi_yaml *tree);
gno_status gnoi_yaml_fail_at(const gnoi_yaml *tree, size_t line, const char *what);

/* A new child of parent (NULL: a loose node), last in it; NULL with *status set when memory or the limit of nodes ends. */
gnoi_yaml_node *gnoi_yaml_add(gnoi_yaml *tree, gnoi_yaml_node *parent, gno_status *status);

/* Parses a text into `target`, which keeps its place, key and line. A setting's target has its `set` mark, which all that is
 * parsed into it inherits. */
gno_status gnoi_yaml_parse_into(gnoi_yaml *tree, gnoi_yaml_node *target, const char *text, size_t size);

#endif
