/* atomic_file.h -- an output file that appears whole or not at all.
 *
 * Place: the last step of every writer: picture -> encoder -> here -> disk. A regular file is written under a temporary
 * name in the target's own folder (a rename works only within one file system) and renamed over the target when it is
 * complete and on the disk. Standard output ("-"), pipes and devices take the bytes as they come; for an encoder that
 * has to seek, those bytes are gathered in a nameless temporary file first.
 *
 * Errors are sticky: after the first one writing does nothing, and gnoi_file_commit tells of it.
 */
#ifndef GNOI_IO_ATOMIC_FILE_H
#define GNOI_IO_ATOMIC_FILE_H

#include <gnomon/gnomon.h>
#include <stddef.h>
#include <stdint.h>

typedef struct gnoi_file {
    gno_context *context;
    const char *path; /* as the caller gave it, for messages */
    char *target;     /* what to rename to: the path with symbolic links followed; NULL when there is nothing to rename */
    char *temporary;  /* name while being written */
    size_t target_size, temporary_size;
    int descriptor; /* where writing goes */
    int drain;      /* where a gathered file goes at the end, or -1 */
    int error;      /* the first errno, 0: none */
    uint64_t sent, unsent; /* bytes appended: on their way to the disk; behind these */
} gnoi_file;

/* Opens path for writing; seekable says that gnoi_file_write_at will be used. On failure nothing stays open or behind.
 * Errors: MEMORY, FILE. */
gno_status gnoi_file_open(gno_context *context, const char *path, int seekable, gnoi_file *file);

/* Appends; returns 0 after an error. */
int gnoi_file_write(gnoi_file *file, const void *data, size_t size);

/* Appends `count` rows of `size` bytes (not 0), each `step` bytes behind the one before in memory; up to GNOI_FILE_ROWS go in one call of the
 * system. Returns 0 after an error. */
#define GNOI_FILE_ROWS 64
int gnoi_file_write_rows(gnoi_file *file, const void *first, ptrdiff_t step, size_t size, int count);

/* Says how much of the file is made, and asks whether to go on: for encoders, at every row or block. Returns 0 after an error and
 * when the progress callback says stop; gnoi_file_commit then removes the file and returns CANCELLED. */
int gnoi_file_go_on(gnoi_file *file, double fraction);

/* Writes at an offset from the start; only for a file opened as seekable. */
int gnoi_file_write_at(gnoi_file *file, const void *data, size_t size, uint64_t offset);

/* Makes the file appear under its name, or removes it when anything failed. Either way the file is closed. Errors: FILE,
 * CANCELLED. */
gno_status gnoi_file_commit(gnoi_file *file);

/* Closes and removes what was written; accepts a file that is already closed. */
void gnoi_file_discard(gnoi_file *file);

#endif
