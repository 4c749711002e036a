/* atomic_file.c -- an output file that appears whole or not at all; see atomic_file.h for its place and promises. */
#define _XOPEN_SOURCE 700 /* realpath */

#include "io/atomic_file.h"
#include "io/send.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#ifndef PATH_MAX
#define PATH_MAX 4096
#endif

enum { TEMPORARY_TRIES = 1000, TEMPORARY_NAME = 64, SENT_AT_ONCE = 1 << 20 /* bytes */ };

static gno_status fail(gno_context *context, const char *path, const char *what, int error)
{
    char reason[128] = "";
    char text[1024];
    if (error != 0 && strerror_r(error, reason, sizeof reason) != 0) {
        snprintf(reason, sizeof reason, "error %d", error);
    }
    const char *name = strcmp(path, "-") == 0 ? "standard output" : path;
    /* A very long path loses its beginning, not the reason. */
    const size_t length = strlen(name), room = 700;
    snprintf(text, sizeof text, "%s%s: %s%s%s", length > room ? "..." : "", length > room ? name + length - room : name, what,
             error != 0 ? ": " : "", reason);
    return gno_context_fail(context, GNO_ERROR_FILE, text);
}

static void release(gnoi_file *file)
{
    if (file->target != NULL) {
        gno_context_realloc(file->context, file->target, file->target_size, 0);
    }
    if (file->temporary != NULL) {
        gno_context_realloc(file->context, file->temporary, file->temporary_size, 0);
    }
    file->target = NULL;
    file->temporary = NULL;
}

/* Creates the temporary file beside the target. The name does not grow with the target's, which may be as long as the file
 * system allows. O_EXCL with our own numbers instead of mkstemp, because then the kernel applies the umask; asking for the
 * umask would mean setting it for a moment, for all threads of the program. */
static int create_beside(gnoi_file *file, mode_t mode)
{
    const char *slash = strrchr(file->target, '/');
    const size_t folder = slash != NULL ? (size_t)(slash - file->target) + 1 : 0;
    file->temporary_size = folder + TEMPORARY_NAME;
    file->temporary = gno_context_realloc(file->context, NULL, 0, file->temporary_size);
    if (file->temporary == NULL) {
        return ENOMEM;
    }
    memcpy(file->temporary, file->target, folder);
    for (int n = 0; n < TEMPORARY_TRIES; n++) {
        snprintf(file->temporary + folder, TEMPORARY_NAME, ".gnomon-%ld-%d.tmp", (long)getpid(), n);
        file->descriptor = open(file->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
        if (file->descriptor >= 0) {
            return 0;
        }
        if (errno != EEXIST) {
            return errno;
        }
    }
    return EEXIST;
}

static gno_status open_regular(gnoi_file *file, const struct stat *old)
{
    char resolved[PATH_MAX];
    /* A link to a picture stays a link: the file it points to is the one replaced. */
    const char *target = old != NULL && realpath(file->path, resolved) != NULL ? resolved : file->path;
    file->target_size = strlen(target) + 1;
    file->target = gno_context_realloc(file->context, NULL, 0, file->target_size);
    if (file->target == NULL) {
        return gno_context_fail(file->context, GNO_ERROR_MEMORY, "out of memory for a file name");
    }
    memcpy(file->target, target, file->target_size);
    /* Renaming would replace even a write-protected file; that is not what protecting it meant. */
    int error = old != NULL && access(target, W_OK) != 0 ? errno : create_beside(file, old != NULL ? old->st_mode & 0777 : 0666);
    if (error == 0 && old != NULL && fchmod(file->descriptor, old->st_mode & 0777) != 0) {
        error = errno;
        unlink(file->temporary);
    }
    if (error == 0) {
        return GNO_OK;
    }
    if (file->descriptor >= 0) {
        close(file->descriptor);
        file->descriptor = -1;
    }
    release(file);
    if (error == ENOMEM) {
        return gno_context_fail(file->context, GNO_ERROR_MEMORY, "out of memory for a file name");
    }
    return fail(file->context, file->path, "cannot be written", error);
}

/* A temporary file without a name: it is gone with the process, whatever ends it. */
static int open_nameless(void)
{
    const char *folder = getenv("TMPDIR");
    char name[PATH_MAX];
    if (folder == NULL || folder[0] == '\0') {
        folder = "/tmp";
    }
    if ((size_t)snprintf(name, sizeof name, "%s/gnomon-XXXXXX", folder) >= sizeof name) {
        errno = ENAMETOOLONG;
        return -1;
    }
    const int descriptor = mkstemp(name);
    if (descriptor >= 0) {
        unlink(name);
    }
    return descriptor;
}

/* Standard output, a pipe or a device; these cannot be renamed into place, and a device must not be. */
static gno_status open_stream(gnoi_file *file, int descriptor, int seekable)
{
    file->descriptor = descriptor;
    if (!seekable) {
        return GNO_OK;
    }
    file->drain = descriptor;
    file->descriptor = open_nameless();
    if (file->descriptor >= 0) {
        return GNO_OK;
    }
    const int error = errno;
    if (descriptor != STDOUT_FILENO) {
        close(descriptor);
    }
    return fail(file->context, file->path, "no temporary file for it can be made", error);
}

gno_status gnoi_file_open(gno_context *context, const char *path, int seekable, gnoi_file *file)
{
    memset(file, 0, sizeof *file);
    file->context = context;
    file->path = path;
    file->descriptor = -1;
    file->drain = -1;
    if (strcmp(path, "-") == 0) {
        return open_stream(file, STDOUT_FILENO, seekable);
    }
    if (path[0] == '\0') {
        return fail(context, "output", "the file name is empty", 0);
    }
    struct stat old;
    if (stat(path, &old) != 0) {
        return open_regular(file, NULL);
    }
    if (S_ISREG(old.st_mode)) {
        return open_regular(file, &old);
    }
    if (S_ISDIR(old.st_mode)) {
        return fail(context, path, "cannot be written", EISDIR);
    }
    const int descriptor = open(path, O_WRONLY | O_CLOEXEC);
    if (descriptor < 0) {
        return fail(context, path, "cannot be written", errno);
    }
    return open_stream(file, descriptor, seekable);
}

static int write_all(int descriptor, const char *data, size_t size)
{
    while (size > 0) {
        const ssize_t done = write(descriptor, data, size < (size_t)1 << 30 ? size : (size_t)1 << 30);
        if (done < 0 && errno != EINTR) {
            return errno;
        }
        if (done == 0) {
            return EIO; /* a device that takes nothing and does not say why */
        }
        if (done > 0) {
            data += done;
            size -= (size_t)done;
        }
    }
    return 0;
}

/* What was written goes to the disk while more is made, so that fsync waits for the rest alone. */
static void count_written(gnoi_file *file, size_t size)
{
    file->unsent += size;
    if (file->temporary != NULL && file->unsent >= SENT_AT_ONCE) {
        gnoi_send(file->descriptor, file->sent, file->unsent);
        file->sent += file->unsent;
        file->unsent = 0;
    }
}

int gnoi_file_write(gnoi_file *file, const void *data, size_t size)
{
    if (file->error == 0) {
        file->error = write_all(file->descriptor, data, size);
        count_written(file, size);
    }
    return file->error == 0;
}

/* One call for up to GNOI_FILE_ROWS rows; returns the number of bytes written, -1 with errno. */
static ssize_t write_some_rows(int descriptor, const char *first, ptrdiff_t step, size_t size, int count)
{
    struct iovec rows[GNOI_FILE_ROWS];
    ssize_t done;
    for (int k = 0; k < count; k++) {
        rows[k].iov_base = (char *)first + k * step; /* only read */
        rows[k].iov_len = size;
    }
    do {
        done = writev(descriptor, rows, count);
    } while (done < 0 && errno == EINTR);
    return done;
}

int gnoi_file_write_rows(gnoi_file *file, const void *first, ptrdiff_t step, size_t size, int count)
{
    const char *row = first;
    while (count > 0 && file->error == 0) {
        const ssize_t done = write_some_rows(file->descriptor, row, step, size, count < GNOI_FILE_ROWS ? count : GNOI_FILE_ROWS);
        if (done < 0) {
            file->error = errno;
            break;
        }
        const int whole = (int)((size_t)done / size);
        const size_t part = (size_t)done % size;
        count_written(file, (size_t)done);
        row += whole * step;
        count -= whole;
        if (count > 0 && (part > 0 || done == 0)) { /* the disk or the pipe is full: the rest of the row tells */
            gnoi_file_write(file, row + part, size - part);
            row += step;
            count--;
        }
    }
    return file->error == 0;
}

int gnoi_file_go_on(gnoi_file *file, double fraction)
{
    if (file->error == 0 && gno_context_progress(file->context, "write", fraction) != GNO_OK) {
        file->error = ECANCELED;
    }
    return file->error == 0;
}

int gnoi_file_write_at(gnoi_file *file, const void *data, size_t size, uint64_t offset)
{
    const char *bytes = data;
    while (file->error == 0 && size > 0) {
        const ssize_t done = pwrite(file->descriptor, bytes, size < (size_t)1 << 30 ? size : (size_t)1 << 30, (off_t)offset);
        if (done < 0 && errno != EINTR) {
            file->error = errno;
        } else if (done == 0) {
            file->error = EIO;
        } else if (done > 0) {
            bytes += done;
            offset += (uint64_t)done;
            size -= (size_t)done;
        }
    }
    return file->error == 0;
}

/* Copies the gathered bytes to the stream they are for. */
static int drain(gnoi_file *file)
{
    const int from = file->descriptor, to = file->drain;
    char block[65536];
    if (lseek(from, 0, SEEK_SET) != 0) {
        return errno;
    }
    for (;;) {
        if (!gnoi_file_go_on(file, 1)) {
            return file->error;
        }
        const ssize_t size = read(from, block, sizeof block);
        if (size == 0) {
            return 0;
        }
        if (size < 0 && errno != EINTR) {
            return errno;
        }
        const int error = size > 0 ? write_all(to, block, (size_t)size) : 0;
        if (error != 0) {
            return error;
        }
    }
}

/* Closes without touching a standard output that belongs to the program. Network file systems report late errors here. */
static int close_own(int descriptor)
{
    return descriptor >= 0 && descriptor != STDOUT_FILENO && close(descriptor) != 0 ? errno : 0;
}

gno_status gnoi_file_commit(gnoi_file *file)
{
    if (file->error == 0 && file->drain >= 0) {
        file->error = drain(file);
    }
    /* The name must not reach the disk before the bytes do, or a power cut leaves an empty file under it. Some file systems
     * have no fsync; that is no reason to fail. */
    if (file->error == 0 && file->temporary != NULL && fsync(file->descriptor) != 0 && errno != EINVAL) {
        file->error = errno;
    }
    const int first = close_own(file->descriptor);
    const int second = close_own(file->drain);
    file->descriptor = file->drain = -1;
    if (file->error == 0) {
        file->error = first != 0 ? first : second;
    }
    if (file->error == 0 && file->temporary != NULL && rename(file->temporary, file->target) != 0) {
        file->error = errno;
    }
    if (file->error != 0 && file->temporary != NULL) {
        unlink(file->temporary);
    }
    release(file);
    if (file->error == ECANCELED) {
        return gno_context_fail(file->context, GNO_ERROR_CANCELLED, "write: cancelled");
    }
    return file->error == 0 ? GNO_OK : fail(file->context, file->path, "writing failed", file->error);
}

void gnoi_file_discard(gnoi_file *file)
{
    close_own(file->descriptor);
    close_own(file->drain);
    file->descriptor = file->drain = -1;
    if (file->temporary != NULL) {
        unlink(file->temporary);
    }
    release(file);
}
