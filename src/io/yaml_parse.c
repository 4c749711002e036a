/* yaml_parse.c -- libyaml's events to a tree.
 *
 * Place: text -> libyaml -> handle() for each event -> nodes of the tree. See yaml_tree.h for what the tree promises.
 * State: `open` is the innermost collection that is being filled; a mapping takes a key, then the value that belongs to it.
 */
#include "io/yaml_store.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <yaml.h>

typedef struct anchor {
    const char *name;
    gnoi_yaml_node *node;
} anchor;

typedef struct parsing {
    gnoi_yaml *tree;
    gnoi_yaml_node *target; /* takes the document's value */
    gnoi_yaml_node *open;   /* NULL outside of the document's value */
    size_t depth;           /* of open, counted from the tree's root */
    const char *key;        /* waits for its value; NULL: a key comes next. Only while open is a mapping */
    uint32_t key_line, key_column;
    int documents;
    anchor *anchors;
    size_t anchor_count, anchor_capacity;
} parsing;

static gno_status fail_line(const parsing *p, size_t line, const char *what)
{
    if (p->target->set) return gnoi_yaml_fail(p->tree, p->target, GNO_ERROR_INPUT, "%s", what);
    return gnoi_yaml_fail_at(p->tree, line, what);
}

static gno_status fail_event(const parsing *p, const yaml_event_t *event, const char *what)
{
    return fail_line(p, event->start_mark.line + 1, what);
}

static gno_status fail_syntax(const parsing *p, const yaml_parser_t *parser)
{
    char what[512];
    if (parser->error == YAML_MEMORY_ERROR) return gnoi_yaml_no_memory(p->tree);
    const char *problem = parser->problem ? parser->problem : "it cannot be read";
    if (parser->error == YAML_READER_ERROR) {
        snprintf(what, sizeof what, "not YAML: %.200s at byte %lu", problem, (unsigned long)parser->problem_offset);
    } else if (parser->context) {
        snprintf(what, sizeof what, "not YAML: %.200s %.200s", parser->context, problem);
    } else {
        snprintf(what, sizeof what, "not YAML: %.200s", problem);
    }
    return fail_line(p, parser->problem_mark.line + 1, what);
}

/* ---- duplicate keys ----------------------------------------------------------------------------------------------------- */

static int by_key(const void *a, const void *b)
{
    const gnoi_yaml_node *x = *(gnoi_yaml_node *const *)a, *y = *(gnoi_yaml_node *const *)b;
    int order = strcmp(x->key, y->key);
    if (order != 0) return order;
    return x->line != y->line ? (x->line < y->line ? -1 : 1) : (x->column > y->column) - (x->column < y->column);
}

static gno_status fail_twice(const parsing *p, const gnoi_yaml_node *first, const gnoi_yaml_node *second)
{
    if (second->set) return gnoi_yaml_fail(p->tree, second, GNO_ERROR_INPUT, "is given twice");
    return gnoi_yaml_fail(p->tree, second, GNO_ERROR_INPUT, "is given twice, first on line %lu", (unsigned long)first->line);
}

static gno_status check_keys(const parsing *p, const gnoi_yaml_node *mapping)
{
    size_t n = mapping->count;
    if (n < 2) return GNO_OK;
    gno_context *context = gnoi_yaml_context(p->tree);
    const gnoi_yaml_node **sorted = gno_context_realloc(context, NULL, 0, n * sizeof *sorted);
    if (!sorted) return gnoi_yaml_no_memory(p->tree);
    size_t i = 0;
    for (const gnoi_yaml_node *child = mapping->first; child; child = child->next) sorted[i++] = child;
    qsort(sorted, n, sizeof *sorted, by_key);
    gno_status status = GNO_OK;
    for (i = 1; i < n && status == GNO_OK; i++) {
        if (!strcmp(sorted[i - 1]->key, sorted[i]->key)) status = fail_twice(p, sorted[i - 1], sorted[i]);
    }
    gno_context_realloc(context, sorted, n * sizeof *sorted, 0);
    return status;
}

/* ---- anchors ------------------------------------------------------------------------------------------------------------ */

static gno_status keep_anchor(parsing *p, const yaml_event_t *event, const yaml_char_t *name, gnoi_yaml_node *node)
{
    if (!name) return GNO_OK;
    if (p->anchor_count == GNOI_YAML_MAX_ANCHORS) return fail_event(p, event, "too many anchors");
    if (p->anchor_count == p->anchor_capacity) {
        size_t size = sizeof *p->anchors, more = p->anchor_capacity ? 2 * p->anchor_capacity : 16;
        anchor *grown =
            gno_context_realloc(gnoi_yaml_context(p->tree), p->anchors, p->anchor_capacity * size, more * size);
        if (!grown) return gnoi_yaml_no_memory(p->tree);
        p->anchors = grown;
        p->anchor_capacity = more;
    }
    const char *copy = gnoi_yaml_copy_text(p->tree, (const char *)name, strlen((const char *)name));
    if (!copy) return gnoi_yaml_no_memory(p->tree);
    p->anchors[p->anchor_count].name = copy;
    p->anchors[p->anchor_count++].node = node;
    return GNO_OK;
}

/* The latest anchor of that name, as YAML wants it. */
static gnoi_yaml_node *find_anchor(const parsing *p, const char *name)
{
    for (size_t i = p->anchor_count; i-- > 0;) {
        if (!strcmp(p->anchors[i].name, name)) return p->anchors[i].node;
    }
    return NULL;
}

/* Fills `to` with a copy of `from`; the recursion is no deeper than GNOI_YAML_MAX_DEPTH. */
static gno_status copy_value(parsing *p, const gnoi_yaml_node *from, gnoi_yaml_node *to, size_t depth)
{
    if (depth > GNOI_YAML_MAX_DEPTH) return gnoi_yaml_fail(p->tree, to, GNO_ERROR_LIMIT, "is nested too deeply");
    to->kind = from->kind;
    to->plain = from->plain;
    to->text = from->text;
    for (const gnoi_yaml_node *child = from->first; child; child = child->next) {
        gno_status status = GNO_OK;
        gnoi_yaml_node *copy = gnoi_yaml_add(p->tree, to, &status);
        if (!copy) return status;
        copy->key = child->key;
        copy->line = child->line;
        copy->column = child->column;
        if ((status = copy_value(p, child, copy, depth + 1)) != GNO_OK) return status;
    }
    return GNO_OK;
}

/* ---- events ------------------------------------------------------------------------------------------------------------- */

/* The node that the event's value goes to. */
static gno_status place(parsing *p, const yaml_event_t *event, gnoi_yaml_node **node)
{
    gno_status status = GNO_OK;
    uint32_t line = (uint32_t)event->start_mark.line + 1, column = (uint32_t)event->start_mark.column + 1;
    *node = p->open ? gnoi_yaml_add(p->tree, p->open, &status) : p->target;
    if (!*node) return status;
    if (p->open && p->open->kind == GNOI_YAML_MAPPING) {
        (*node)->key = p->key;
        line = p->key_line;
        column = p->key_column;
        p->key = NULL;
    }
    if (!(*node)->set) {
        (*node)->line = line;
        (*node)->column = column;
    }
    return GNO_OK;
}

static gno_status on_scalar(parsing *p, const yaml_event_t *event)
{
    const char *value = (const char *)event->data.scalar.value;
    size_t length = event->data.scalar.length;
    if (event->data.scalar.tag) return fail_event(p, event, "tags (!...) have no meaning here");
    if (memchr(value, 0, length)) return fail_event(p, event, "a text holds a NUL character");
    char *text = gnoi_yaml_copy_text(p->tree, value, length);
    if (!text) return gnoi_yaml_no_memory(p->tree);
    if (p->open && p->open->kind == GNOI_YAML_MAPPING && !p->key) {
        p->key = text;
        p->key_line = (uint32_t)event->start_mark.line + 1;
        p->key_column = (uint32_t)event->start_mark.column + 1;
        return GNO_OK;
    }
    gnoi_yaml_node *node;
    gno_status status = place(p, event, &node);
    if (status != GNO_OK) return status;
    node->kind = GNOI_YAML_SCALAR;
    node->text = text;
    node->plain = event->data.scalar.style == YAML_PLAIN_SCALAR_STYLE;
    return keep_anchor(p, event, event->data.scalar.anchor, node);
}

static gno_status on_start(parsing *p, const yaml_event_t *event, gnoi_yaml_kind kind, const yaml_char_t *anchor_name,
                           const yaml_char_t *tag)
{
    if (tag) return fail_event(p, event, "tags (!...) have no meaning here");
    if (p->open && p->open->kind == GNOI_YAML_MAPPING && !p->key) return fail_event(p, event, "a key is not a word");
    gnoi_yaml_node *node;
    gno_status status = place(p, event, &node);
    if (status != GNO_OK) return status;
    if (++p->depth > GNOI_YAML_MAX_DEPTH) return gnoi_yaml_fail(p->tree, node, GNO_ERROR_LIMIT, "is nested too deeply");
    node->kind = (uint8_t)kind;
    node->text = NULL;
    node->plain = 0;
    p->open = node;
    return keep_anchor(p, event, anchor_name, node);
}

static gno_status on_end(parsing *p)
{
    const gnoi_yaml_node *closed = p->open;
    p->open = closed == p->target ? NULL : closed->parent;
    p->depth--;
    return closed->kind == GNOI_YAML_MAPPING ? check_keys(p, closed) : GNO_OK;
}

static gno_status on_alias(parsing *p, const yaml_event_t *event)
{
    if (p->open && p->open->kind == GNOI_YAML_MAPPING && !p->key) return fail_event(p, event, "a key is not a word");
    const gnoi_yaml_node *from = find_anchor(p, (const char *)event->data.alias.anchor);
    if (!from) return fail_event(p, event, "an alias (*...) whose anchor (&...) does not come before it");
    for (const gnoi_yaml_node *n = p->open; n; n = n->parent) {
        if (n == from) return fail_event(p, event, "an alias (*...) within its own anchor (&...)");
    }
    gnoi_yaml_node *node;
    gno_status status = place(p, event, &node);
    return status != GNO_OK ? status : copy_value(p, from, node, p->depth + 1);
}

static gno_status handle(parsing *p, const yaml_event_t *event)
{
    switch (event->type) {
    case YAML_DOCUMENT_START_EVENT:
        return p->documents++ == 0 ? GNO_OK : fail_event(p, event, "a second document (---) in one file");
    case YAML_SCALAR_EVENT: return on_scalar(p, event);
    case YAML_ALIAS_EVENT: return on_alias(p, event);
    case YAML_SEQUENCE_START_EVENT:
        return on_start(p, event, GNOI_YAML_SEQUENCE, event->data.sequence_start.anchor, event->data.sequence_start.tag);
    case YAML_MAPPING_START_EVENT:
        return on_start(p, event, GNOI_YAML_MAPPING, event->data.mapping_start.anchor, event->data.mapping_start.tag);
    case YAML_SEQUENCE_END_EVENT:
    case YAML_MAPPING_END_EVENT: return on_end(p);
    default: return GNO_OK;
    }
}

static gno_status run(parsing *p, yaml_parser_t *parser)
{
    for (int more = 1; more;) {
        yaml_event_t event;
        if (!yaml_parser_parse(parser, &event)) return fail_syntax(p, parser);
        more = event.type != YAML_STREAM_END_EVENT;
        gno_status status = handle(p, &event);
        yaml_event_delete(&event);
        if (status != GNO_OK) return status;
    }
    return GNO_OK;
}

/* An empty text gives no event for a value: the target then is what an empty scalar is. */
static void make_null(gnoi_yaml_node *node)
{
    node->first = node->last = NULL;
    node->count = 0;
    node->kind = GNOI_YAML_SCALAR;
    node->plain = 1;
    node->text = "";
}

gno_status gnoi_yaml_parse_into(gnoi_yaml *tree, gnoi_yaml_node *target, const char *text, size_t size)
{
    yaml_parser_t parser;
    parsing p;
    memset(&p, 0, sizeof p);
    p.tree = tree;
    p.target = target;
    for (const gnoi_yaml_node *n = target->parent; n; n = n->parent) p.depth++;
    make_null(target);
    if (!yaml_parser_initialize(&parser)) return gnoi_yaml_no_memory(tree);
    yaml_parser_set_encoding(&parser, YAML_UTF8_ENCODING);
    yaml_parser_set_input_string(&parser, (const unsigned char *)text, size);
    gno_status status = run(&p, &parser);
    yaml_parser_delete(&parser);
    if (p.anchors) {
        gno_context_realloc(gnoi_yaml_context(tree), p.anchors, p.anchor_capacity * sizeof *p.anchors, 0);
    }
    return status;
}

gno_status gnoi_yaml_parse(gnoi_yaml *tree, const char *text, size_t size)
{
    return gnoi_yaml_parse_into(tree, gnoi_yaml_root(tree), text ? text : "", size);
}
