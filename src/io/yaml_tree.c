/* yaml_tree.c -- storage of the tree, messages with key paths, and reading the file.
 *
 * Place: see yaml_tree.h; yaml_parse.c fills the tree from libyaml's events, yaml_setting.c changes it.
 * Nodes and texts live in chunks that are freed together with the tree.
 */
#include "io/yaml_tree.h"
#include "io/yaml_store.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { CHUNK = 65536, ALIGN = 16, MESSAGE = 2048 };

typedef struct chunk {
    struct chunk *next;
    size_t size; /* of the whole block */
} chunk;

/* The head takes whole alignment units, so that what follows it is aligned like the block. */
#define HEAD ((sizeof(chunk) + ALIGN - 1) / ALIGN * ALIGN)

struct gnoi_yaml {
    gno_context *context;
    const char *path;
    chunk *chunks;
    size_t used, room; /* of the first chunk */
    size_t nodes;
    gnoi_yaml_node *root;
};

void *gnoi_yaml_alloc(gnoi_yaml *tree, size_t size)
{
    if (size > (size_t)-1 - HEAD - ALIGN) return NULL;
    size = (size + ALIGN - 1) / ALIGN * ALIGN;
    if (size > tree->room - tree->used) {
        size_t room = size > CHUNK / 4 ? size : CHUNK - HEAD;
        chunk *block = gno_context_realloc(tree->context, NULL, 0, HEAD + room);
        if (!block) return NULL;
        block->size = HEAD + room;
        if (room == size && tree->chunks) { /* a large text: beside the chunk in use, which stays in use */
            block->next = tree->chunks->next;
            tree->chunks->next = block;
            return (char *)block + HEAD;
        }
        block->next = tree->chunks;
        tree->chunks = block;
        tree->used = 0;
        tree->room = room;
    }
    void *memory = (char *)tree->chunks + HEAD + tree->used;
    tree->used += size;
    return memory;
}

char *gnoi_yaml_copy_text(gnoi_yaml *tree, const char *text, size_t length)
{
    char *copy = gnoi_yaml_alloc(tree, length + 1);
    if (!copy) return NULL;
    if (length > 0) memcpy(copy, text, length);
    copy[length] = 0;
    return copy;
}

gno_status gnoi_yaml_no_memory(const gnoi_yaml *tree)
{
    return gno_context_fail(tree->context, GNO_ERROR_MEMORY, "out of memory while reading a scene file");
}

gnoi_yaml_node *gnoi_yaml_add(gnoi_yaml *tree, gnoi_yaml_node *parent, gno_status *status)
{
    if (tree->nodes >= GNOI_YAML_MAX_NODES) {
        *status = gnoi_yaml_fail(tree, parent, GNO_ERROR_LIMIT, "more than %lu values, aliases counted as copies",
                                 (unsigned long)GNOI_YAML_MAX_NODES);
        return NULL;
    }
    gnoi_yaml_node *node = gnoi_yaml_alloc(tree, sizeof *node);
    if (!node) {
        *status = gnoi_yaml_no_memory(tree);
        return NULL;
    }
    memset(node, 0, sizeof *node);
    tree->nodes++;
    node->parent = parent;
    if (parent) {
        if (parent->last) parent->last->next = node;
        else parent->first = node;
        parent->last = node;
        parent->count++;
        node->line = parent->line;
        node->set = parent->set;
    }
    return node;
}

gno_status gnoi_yaml_create(gno_context *context, const char *path, gnoi_yaml **tree)
{
    *tree = NULL;
    gnoi_yaml *made = gno_context_realloc(context, NULL, 0, sizeof *made);
    if (!made) return gno_context_fail(context, GNO_ERROR_MEMORY, "out of memory while reading a scene file");
    memset(made, 0, sizeof *made);
    made->context = context;
    made->path = path;
    gno_status status = GNO_OK;
    made->root = gnoi_yaml_add(made, NULL, &status);
    if (!made->root) {
        gnoi_yaml_destroy(made);
        return status;
    }
    made->root->kind = GNOI_YAML_MAPPING;
    made->root->line = 1;
    *tree = made;
    return GNO_OK;
}

void gnoi_yaml_destroy(gnoi_yaml *tree)
{
    if (!tree) return;
    gno_context *context = tree->context;
    for (chunk *block = tree->chunks; block;) {
        chunk *next = block->next;
        gno_context_realloc(context, block, block->size, 0);
        block = next;
    }
    gno_context_realloc(context, tree, sizeof *tree, 0);
}

gno_context *gnoi_yaml_context(const gnoi_yaml *tree) { return tree->context; }
gnoi_yaml_node *gnoi_yaml_root(const gnoi_yaml *tree) { return tree->root; }

gnoi_yaml_node *gnoi_yaml_find(const gnoi_yaml_node *mapping, const char *key)
{
    for (gnoi_yaml_node *child = mapping->first; child; child = child->next) {
        if (child->key && !strcmp(child->key, key)) return child;
    }
    return NULL;
}

int gnoi_yaml_is_null(const gnoi_yaml_node *node)
{
    if (node->kind != GNOI_YAML_SCALAR || !node->plain) return 0;
    const char *t = node->text;
    return !*t || !strcmp(t, "~") || !strcmp(t, "null") || !strcmp(t, "Null") || !strcmp(t, "NULL");
}

/* ---- messages --------------------------------------------------------------------------------------------------------- */

static void append(char *buffer, size_t size, const char *text)
{
    size_t used = strlen(buffer);
    snprintf(buffer + used, size - used, "%s", text);
}

static unsigned long index_of(const gnoi_yaml_node *node)
{
    unsigned long index = 0;
    for (const gnoi_yaml_node *n = node->parent->first; n != node; n = n->next) index++;
    return index;
}

/* The node's key path, "lights[1].type"; "" for the root. */
static void append_path(char *buffer, size_t size, const gnoi_yaml_node *node)
{
    const gnoi_yaml_node *way[GNOI_YAML_MAX_DEPTH + 2];
    size_t depth = 0;
    for (; node->parent && depth < sizeof way / sizeof *way; node = node->parent) way[depth++] = node;
    for (int first = 1; depth > 0; first = 0) {
        const gnoi_yaml_node *step = way[--depth];
        char shown[GNOI_YAML_SHOWN];
        if (step->key) {
            if (!first) append(buffer, size, ".");
            append(buffer, size, *step->key ? gnoi_yaml_show(step->key, shown) : "\"\"");
        } else {
            snprintf(shown, sizeof shown, "[%lu]", index_of(step));
            append(buffer, size, shown);
        }
    }
}

/* Where the node is: "FILE:LINE: " or "--set ", then its key path. */
static void begin_message(char message[MESSAGE], const gnoi_yaml *tree, const gnoi_yaml_node *node)
{
    message[0] = 0;
    if (node->set) {
        append(message, MESSAGE, "--set ");
    } else if (tree->path) {
        snprintf(message, MESSAGE, "%.400s:%lu: ", tree->path, (unsigned long)node->line);
    }
    append_path(message, MESSAGE, node);
}

gno_status gnoi_yaml_fail(const gnoi_yaml *tree, const gnoi_yaml_node *node, gno_status status, const char *format, ...)
{
    char message[MESSAGE];
    begin_message(message, tree, node);
    if (node->parent) append(message, sizeof message, ": ");
    size_t used = strlen(message);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message + used, sizeof message - used, format, arguments);
    va_end(arguments);
    return gno_context_fail(tree->context, status, message);
}

void gnoi_yaml_warn(const gnoi_yaml *tree, const gnoi_yaml_node *node, const char *what)
{
    char message[MESSAGE];
    begin_message(message, tree, node);
    if (node->parent) append(message, sizeof message, ": ");
    append(message, sizeof message, what);
    gno_context_log(tree->context, GNO_LOG_WARNING, message);
}

gno_status gnoi_yaml_fail_missing(const gnoi_yaml *tree, const gnoi_yaml_node *mapping, const char *key, const char *what)
{
    char message[MESSAGE];
    begin_message(message, tree, mapping);
    if (mapping->parent) append(message, sizeof message, ".");
    append(message, sizeof message, key);
    append(message, sizeof message, ": ");
    append(message, sizeof message, what);
    return gno_context_fail(tree->context, GNO_ERROR_INPUT, message);
}

gno_status gnoi_yaml_fail_at(const gnoi_yaml *tree, size_t line, const char *what)
{
    char message[MESSAGE];
    snprintf(message, sizeof message, "%.400s:%lu: %s", tree->path ? tree->path : "", (unsigned long)line, what);
    return gno_context_fail(tree->context, GNO_ERROR_INPUT, message);
}

const char *gnoi_yaml_show(const char *text, char buffer[GNOI_YAML_SHOWN])
{
    size_t n = 0;
    while (text[n] && n < GNOI_YAML_SHOWN - 4) {
        unsigned char c = (unsigned char)text[n];
        buffer[n++] = (char)(c < 32 || c == 127 ? '?' : c);
    }
    if (text[n]) {
        while (n > 0 && ((unsigned char)text[n] & 0xc0) == 0x80) n--; /* do not cut a UTF-8 sequence in two */
        memcpy(buffer + n, "...", 3);
        n += 3;
    }
    buffer[n] = 0;
    return buffer;
}

/* ---- the file --------------------------------------------------------------------------------------------------------- */

static gno_status fail_file(const gnoi_yaml *tree, const char *verb, int error)
{
    char message[MESSAGE];
    snprintf(message, sizeof message, "%.400s: cannot be %s: %s", tree->path, verb, error ? strerror(error) : "unknown reason");
    return gno_context_fail(tree->context, GNO_ERROR_FILE, message);
}

/* The whole file in one block of *capacity bytes, *size of them used; the caller frees it in every case. */
static gno_status read_all(const gnoi_yaml *tree, FILE *file, char **text, size_t *capacity, size_t *size)
{
    for (;;) {
        if (*size == *capacity) {
            size_t more = *capacity ? *capacity * 2 : CHUNK;
            char *grown = gno_context_realloc(tree->context, *text, *capacity, more);
            if (!grown) return gnoi_yaml_no_memory(tree);
            *text = grown;
            *capacity = more;
        }
        errno = 0;
        size_t got = fread(*text + *size, 1, *capacity - *size, file);
        *size += got;
        if (got == 0) return ferror(file) ? fail_file(tree, "read", errno) : GNO_OK;
        if (*size > GNOI_YAML_MAX_BYTES) {
            char message[MESSAGE];
            snprintf(message, sizeof message, "%.400s: larger than %lu MiB; put large meshes into mesh files", tree->path,
                     (unsigned long)(GNOI_YAML_MAX_BYTES >> 20));
            return gno_context_fail(tree->context, GNO_ERROR_LIMIT, message);
        }
    }
}

gno_status gnoi_yaml_load(gnoi_yaml *tree)
{
    errno = 0;
    FILE *file = fopen(tree->path, "rb");
    if (!file) return fail_file(tree, "opened", errno);
    char *text = NULL;
    size_t capacity = 0, size = 0;
    gno_status status = read_all(tree, file, &text, &capacity, &size);
    fclose(file);
    if (status == GNO_OK) status = gnoi_yaml_parse(tree, text, size);
    if (text) gno_context_realloc(tree->context, text, capacity, 0);
    return status;
}
