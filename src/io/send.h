/* send.h -- bytes of a file on their way to the disk before anybody waits for them. Place: under atomic_file.c. */
#ifndef GNOI_IO_SEND_H
#define GNOI_IO_SEND_H

#include <stdint.h>

/* Begins to write `size` bytes from `from` on to the disk, and does not wait. A hint: where the system has none nothing is done, and errors are
 * left for fsync to tell. */
void gnoi_send(int descriptor, uint64_t from, uint64_t size);

#endif
