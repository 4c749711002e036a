/* mesh_util.c -- shared parts of the mesh readers: messages, arrays, blocks of lines, names.
 *
 * Place: under obj.c, mtl.c and assimp_*.c. All memory comes from the scene's context.
 */
#include "mesh_util.h"
#include <errno.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>
#include <sys/stat.h>

enum { message_size = 1024, first_block = 256 * 1024, first_elements = 16 };

/* ---- messages ----------------------------------------------------------------------------------------------- */

static void format_message(char *text, size_t size, const char *path, size_t line, const char *format, va_list list)
{
    int used = line > 0 ? snprintf(text, size, "%s:%zu: ", path, line) : snprintf(text, size, "%s: ", path);
    if (used < 0 || (size_t)used >= size) return; /* a path that fills the message: it alone must do */
    vsnprintf(text + used, size - (size_t)used, format, list);
}

gno_status gnoi_mesh_fail(gno_context *context, gno_status status, const char *path, size_t line, const char *format, ...)
{
    char text[message_size];
    va_list list;
    va_start(list, format);
    format_message(text, sizeof text, path, line, format, list);
    va_end(list);
    return gno_context_fail(context, status, text);
}

void gnoi_mesh_warn(gno_context *context, const char *path, size_t line, const char *format, ...)
{
    char text[message_size];
    va_list list;
    va_start(list, format);
    format_message(text, sizeof text, path, line, format, list);
    va_end(list);
    gno_context_log(context, GNO_LOG_WARNING, text);
}

gno_status gnoi_mesh_no_memory(gno_context *context, const char *path)
{
    return gnoi_mesh_fail(context, GNO_ERROR_MEMORY, path, 0, "out of memory while reading");
}

/* ---- arrays ------------------------------------------------------------------------------------------------- */

int gnoi_mesh_array_room(gno_context *context, gnoi_mesh_array *array, size_t more, size_t size)
{
    if (more <= array->capacity - array->count) return 1;
    size_t limit = SIZE_MAX / 2 / size;
    if (array->count > limit || more > limit - array->count) return 0;
    size_t need = array->count + more;
    size_t capacity = array->capacity < first_elements ? first_elements : array->capacity;
    while (capacity < need) capacity *= 2;
    void *data = gno_context_realloc(context, array->data, array->capacity * size, capacity * size);
    if (!data) return 0;
    array->data = data;
    array->capacity = capacity;
    return 1;
}

void gnoi_mesh_array_free(gno_context *context, gnoi_mesh_array *array, size_t size)
{
    if (array->data) gno_context_realloc(context, array->data, array->capacity * size, 0);
    array->data = NULL;
    array->count = array->capacity = 0;
}

/* ---- blocks of lines ---------------------------------------------------------------------------------------- */

gno_status gnoi_blocks_open(gnoi_blocks *blocks, gno_context *context, const char *path)
{
    memset(blocks, 0, sizeof *blocks);
    blocks->context = context;
    blocks->path = path;
    blocks->data = gno_context_realloc(context, NULL, 0, first_block);
    if (!blocks->data) return gnoi_mesh_no_memory(context, path);
    blocks->capacity = first_block;
    blocks->file = fopen(path, "rb");
    if (!blocks->file) return gnoi_mesh_fail(context, GNO_ERROR_FILE, path, 0, "cannot open: %s", strerror(errno));
    struct stat found;
    if (fstat(fileno(blocks->file), &found) == 0 && S_ISREG(found.st_mode)) blocks->size = (double)found.st_size;
    return GNO_OK;
}

void gnoi_blocks_close(gnoi_blocks *blocks)
{
    if (blocks->file) fclose(blocks->file);
    if (blocks->data) gno_context_realloc(blocks->context, blocks->data, blocks->capacity, 0);
    blocks->file = NULL;
    blocks->data = NULL;
}

/* Offset after the last newline that ends a statement; 0 when there is none. */
static size_t last_statement_end(const char *data, size_t size)
{
    for (size_t i = size; i > 0; i--) {
        if (data[i - 1] != '\n') continue;
        size_t before = i - 1;
        if (before > 0 && data[before - 1] == '\r') before--;
        if (before == 0 || data[before - 1] != '\\') return i;
    }
    return 0;
}

static int grow_block(gnoi_blocks *blocks)
{
    if (blocks->capacity > SIZE_MAX / 4) return 0;
    char *data = gno_context_realloc(blocks->context, blocks->data, blocks->capacity, blocks->capacity * 2);
    if (!data) return 0;
    blocks->data = data;
    blocks->capacity *= 2;
    return 1;
}

static void skip_byte_order_mark(gnoi_blocks *blocks)
{
    if (blocks->begun) return;
    blocks->begun = 1;
    if (blocks->end >= 3 && memcmp(blocks->data, "\xEF\xBB\xBF", 3) == 0) memset(blocks->data, ' ', 3);
}

/* The last block: what is left, with the two closing newlines that two bytes of the buffer were kept for. */
static void hand_out_rest(gnoi_blocks *blocks, const char **first, const char **last)
{
    blocks->ended = 1;
    if (blocks->end == 0) return;
    blocks->data[blocks->end] = '\n';
    blocks->data[blocks->end + 1] = '\n';
    *first = blocks->data;
    *last = blocks->data + blocks->end + 2;
    blocks->end = 0;
}

gno_status gnoi_blocks_next(gnoi_blocks *blocks, const char **first, const char **last)
{
    *first = *last = NULL;
    double fraction = blocks->taken < blocks->size ? blocks->taken / blocks->size : 0;
    if (gno_context_progress(blocks->context, "load", fraction) != GNO_OK) return GNO_ERROR_CANCELLED;
    if (blocks->ended) return GNO_OK;
    memmove(blocks->data, blocks->data + blocks->start, blocks->end - blocks->start);
    blocks->end -= blocks->start;
    blocks->start = 0;
    for (;;) {
        size_t room = blocks->capacity - 2 - blocks->end;
        size_t got = fread(blocks->data + blocks->end, 1, room, blocks->file);
        blocks->end += got;
        blocks->taken += (double)got;
        if (ferror(blocks->file))
            return gnoi_mesh_fail(blocks->context, GNO_ERROR_FILE, blocks->path, 0, "cannot read: %s", strerror(errno));
        skip_byte_order_mark(blocks);
        if (got < room) {
            hand_out_rest(blocks, first, last);
            return GNO_OK;
        }
        size_t cut = last_statement_end(blocks->data, blocks->end);
        if (cut > 0) {
            blocks->start = cut;
            *first = blocks->data;
            *last = blocks->data + cut;
            return GNO_OK;
        }
        if (!grow_block(blocks)) return gnoi_mesh_no_memory(blocks->context, blocks->path);
    }
}

/* ---- names -------------------------------------------------------------------------------------------------- */

typedef struct gnoi_name {
    size_t offset, length;
    uint32_t hash;
} gnoi_name;

static uint32_t hash_name(const char *name, size_t length) /* FNV-1a */
{
    uint32_t hash = 2166136261u;
    for (size_t i = 0; i < length; i++) hash = (hash ^ (unsigned char)name[i]) * 16777619u;
    return hash;
}

/* The slot that holds the name, or the free one where it belongs. */
static int *find_slot(const gnoi_names *names, const char *name, size_t length, uint32_t hash)
{
    const gnoi_name *entries = names->entries.data;
    int *slots = names->slots.data;
    size_t mask = names->slots.count - 1;
    for (size_t i = hash & mask;; i = (i + 1) & mask) {
        if (slots[i] < 0) return slots + i;
        const gnoi_name *entry = entries + slots[i];
        if (entry->hash == hash && entry->length == length &&
            memcmp((const char *)names->text.data + entry->offset, name, length) == 0)
            return slots + i;
    }
}

/* Doubles the hash table before it is more than half full. */
static int room_for_slot(gno_context *context, gnoi_names *names)
{
    if (names->slots.count / 2 > names->entries.count) return 1;
    size_t count = names->slots.count ? names->slots.count : first_elements;
    if (!gnoi_mesh_array_room(context, &names->slots, count, sizeof(int))) return 0;
    names->slots.count += count; /* a power of two: 16, 32, 64 ... */
    int *slots = names->slots.data;
    const gnoi_name *entries = names->entries.data;
    size_t mask = names->slots.count - 1;
    for (size_t i = 0; i < names->slots.count; i++) slots[i] = -1;
    for (size_t e = 0; e < names->entries.count; e++) {
        size_t i = entries[e].hash & mask;
        while (slots[i] >= 0) i = (i + 1) & mask;
        slots[i] = (int)e;
    }
    return 1;
}

int gnoi_names_number(gno_context *context, gnoi_names *names, const char *name, size_t length)
{
    if (!room_for_slot(context, names)) return -1;
    uint32_t hash = hash_name(name, length);
    int *slot = find_slot(names, name, length, hash);
    if (*slot >= 0) return *slot;
    if (names->entries.count >= GNO_MAX_POLYGONS) return -1;
    if (!gnoi_mesh_array_room(context, &names->text, length + 1, 1)) return -1;
    if (!gnoi_mesh_array_room(context, &names->entries, 1, sizeof(gnoi_name))) return -1;
    char *text = (char *)names->text.data + names->text.count;
    memcpy(text, name, length);
    text[length] = '\0';
    gnoi_name *entry = (gnoi_name *)names->entries.data + names->entries.count;
    entry->offset = names->text.count;
    entry->length = length;
    entry->hash = hash;
    names->text.count += length + 1;
    *slot = (int)names->entries.count++;
    return *slot;
}

const char *gnoi_names_text(const gnoi_names *names, int number)
{
    const gnoi_name *entries = names->entries.data;
    return (const char *)names->text.data + entries[number].offset;
}

void gnoi_names_free(gno_context *context, gnoi_names *names)
{
    gnoi_mesh_array_free(context, &names->text, 1);
    gnoi_mesh_array_free(context, &names->entries, sizeof(gnoi_name));
    gnoi_mesh_array_free(context, &names->slots, sizeof(int));
}
