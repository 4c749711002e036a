/* send.c -- see send.h. */
#ifdef __linux__
#define _GNU_SOURCE /* sync_file_range */
#include <fcntl.h>
#endif
#include "io/send.h"

void gnoi_send(int descriptor, uint64_t from, uint64_t size)
{
#ifdef SYNC_FILE_RANGE_WRITE
    (void)sync_file_range(descriptor, (off_t)from, (off_t)size, SYNC_FILE_RANGE_WRITE);
#else
    (void)descriptor;
    (void)from;
    (void)size;
#endif
}
