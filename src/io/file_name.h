/* file_name.h -- the parts of a path that readers and writers go by.
 *
 * Place: beneath every reader and writer of src/io. Looks at the text alone, never at the disk.
 */
#ifndef GNOI_IO_FILE_NAME_H
#define GNOI_IO_FILE_NAME_H

/* The part of a path after the last slash. */
const char *gnoi_base_name(const char *path);

/* ".yaml" of a path; "" where its base name has none. */
const char *gnoi_extension(const char *path);

/* Whether the extension is `lower`, ".yaml", in any case; letters beyond ASCII are compared as they are, whatever the locale. */
int gnoi_has_extension(const char *path, const char *lower);

#endif
