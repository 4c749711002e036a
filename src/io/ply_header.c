/* ply_header.c -- the header of a PLY file, looked at before assimp reads the file.
 *
 * Place: under assimp_mesh.c. assimp 5.2 never comes back from a header without its end, as a file cut short has, and
 * believes any number of elements; here such files get a message with the line.
 */
#include "mesh_util.h"
#include "obj_parse.h"
#include <string.h>

typedef struct header {
    gno_context *context;
    const char *path;
    size_t line;
    double file_size;
    int ended;
} header;

static int is_word(const char *p, const char *word)
{
    size_t length = strlen(word);
    return strncmp(p, word, length) == 0 && (p[length] == '\n' || gnoi_parse_is_blank(p[length]));
}

/* element NAME COUNT: each of them takes a byte of the file at least. */
static gno_status check_element(const header *h, const char *p)
{
    size_t line = h->line;
    const char *name = gnoi_parse_blank(p + 7, &line);
    const char *number = gnoi_parse_blank(gnoi_parse_word(name), &line);
    double count = 0;
    const char *end = gnoi_parse_number(number, &count);
    if (end == number || !gnoi_parse_ends_word(*end) || count < 0)
        return gnoi_mesh_fail(h->context, GNO_ERROR_INPUT, h->path, h->line, "element: a name and a count are expected");
    if (count > h->file_size)
        return gnoi_mesh_fail(h->context, GNO_ERROR_INPUT, h->path, h->line, "element: %.0f of them do not fit a file of %.0f bytes",
                              count, h->file_size);
    return GNO_OK;
}

static gno_status check_line(header *h, const char *p)
{
    static const char *const known[] = {"format", "comment", "obj_info", "property"};
    if (h->line == 1 && !is_word(p, "ply"))
        return gnoi_mesh_fail(h->context, GNO_ERROR_INPUT, h->path, 1, "not a PLY file: \"ply\" is expected");
    if (h->line == 1 || *p == '\n') return GNO_OK;
    if (is_word(p, "element")) return check_element(h, p);
    h->ended = is_word(p, "end_header");
    if (h->ended) return GNO_OK;
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++)
        if (is_word(p, known[i])) return GNO_OK;
    return gnoi_mesh_fail(h->context, GNO_ERROR_INPUT, h->path, h->line, "no line of a PLY header");
}

static gno_status check_lines(header *h)
{
    gnoi_blocks blocks;
    const char *p = NULL, *last = NULL;
    gno_status status = gnoi_blocks_open(&blocks, h->context, h->path);
    while (status == GNO_OK && !h->ended) {
        if (p == last) {
            status = gnoi_blocks_next(&blocks, &p, &last);
            if (status == GNO_OK && !p)
                status = gnoi_mesh_fail(h->context, GNO_ERROR_INPUT, h->path, 0, "the header's end_header is missing");
            continue;
        }
        h->line++;
        const char *text = p;
        while (gnoi_parse_is_blank(*text)) text++;
        status = check_line(h, text);
        p = gnoi_parse_line_end(text) + 1;
    }
    gnoi_blocks_close(&blocks);
    return status;
}

gno_status gnoi_ply_check(gno_context *context, const char *path)
{
    header h = {context, path, 0, 0, 0};
    FILE *file = fopen(path, "rb");
    if (file && fseek(file, 0, SEEK_END) == 0) h.file_size = (double)ftell(file);
    if (file) fclose(file);
    return check_lines(&h);
}
