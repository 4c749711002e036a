/* mesh_util.h -- what the mesh readers share: messages with path and line, growing arrays, whole-line blocks of a text
 * file, a table of names, and the way from a filled gno_mesh_def into the scene.
 *
 * Place: under obj.c, mtl.c and assimp_*.c; knows the public header and mesh_file.h.
 */
#ifndef GNOI_IO_MESH_UTIL_H
#define GNOI_IO_MESH_UTIL_H

#include "mesh_file.h"
#include <stdio.h>

#if defined(__GNUC__)
#define GNOI_MESH_PRINTF(text, first) __attribute__((format(printf, text, first)))
#else
#define GNOI_MESH_PRINTF(text, first)
#endif

/* Sets "path:line: text" (line 0: "path: text") as the context's message and returns status. */
gno_status gnoi_mesh_fail(gno_context *context, gno_status status, const char *path, size_t line, const char *format, ...)
    GNOI_MESH_PRINTF(5, 6);
void gnoi_mesh_warn(gno_context *context, const char *path, size_t line, const char *format, ...) GNOI_MESH_PRINTF(4, 5);
gno_status gnoi_mesh_no_memory(gno_context *context, const char *path);

/* ---- arrays: zero is an empty one; `size` is that of an element, the same in every call ---- */

typedef struct gnoi_mesh_array {
    void *data;
    size_t count, capacity;
} gnoi_mesh_array;

/* Makes room for `more` elements after count; 0 when memory fails (array unchanged then). */
int gnoi_mesh_array_room(gno_context *context, gnoi_mesh_array *array, size_t more, size_t size);
void gnoi_mesh_array_free(gno_context *context, gnoi_mesh_array *array, size_t size);

/* ---- text files in blocks of whole lines ---- */

/* A block starts at the start of a line and ends after a newline; no statement continued by a backslash is cut. Every
 * block may be read up to its last newline without other checks; the file's last block has two, so that a backslash at
 * the very end cannot lead beyond. A byte order mark is skipped. */
typedef struct gnoi_blocks {
    gno_context *context;
    const char *path;
    FILE *file;
    char *data;
    size_t capacity, start, end; /* bytes [start,end) of data are read but not handed out */
    int ended, begun;
    double size, taken; /* bytes of the file (0: not known), and read so far */
} gnoi_blocks;

gno_status gnoi_blocks_open(gnoi_blocks *blocks, gno_context *context, const char *path);
gno_status gnoi_blocks_next(gnoi_blocks *blocks, const char **first, const char **last); /* *first NULL: no more */
void gnoi_blocks_close(gnoi_blocks *blocks); /* also right after a failed open */

/* ---- names to numbers 0, 1, 2 ... in order of first mention; zero is an empty table ---- */

typedef struct gnoi_names {
    gnoi_mesh_array text;    /* char: names, each with its NUL */
    gnoi_mesh_array entries; /* gnoi_name */
    gnoi_mesh_array slots;   /* int: hash table of entry numbers, -1 free; power of two, at most half full */
} gnoi_names;

/* The number of a name, new or known; -1 when memory fails. */
int gnoi_names_number(gno_context *context, gnoi_names *names, const char *name, size_t length);
const char *gnoi_names_text(const gnoi_names *names, int number);
void gnoi_names_free(gno_context *context, gnoi_names *names);

/* ---- into the scene ---- */

/* A mesh_def with the options filled in. */
gno_mesh_def gnoi_mesh_def_for(const gnoi_mesh_options *options);

/* Adds the mesh and counts it in result; messages of the scene get the path in front. */
gno_status gnoi_mesh_add(gno_scene *scene, const char *path, const gno_mesh_def *def, gnoi_mesh_result *result);

/* A failure that the scene has reported, with the path put in front of its message: the file is to blame. */
gno_status gnoi_mesh_blame(gno_scene *scene, const char *path, gno_status status);

/* The readers; options and result are given, path exists or not. */
gno_status gnoi_obj_load(gno_scene *scene, const char *path, const gnoi_mesh_options *options, gnoi_mesh_result *result);
gno_status gnoi_assimp_load(gno_scene *scene, const char *path, const gnoi_mesh_options *options, gnoi_mesh_result *result);

/* Looks at the header of a PLY file, for faults that assimp does not survive. */
gno_status gnoi_ply_check(gno_context *context, const char *path);

#endif
