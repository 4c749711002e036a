/* fuzz.h -- what the fuzz targets share. Place: tests; each fuzz_*.c is one target, driver.c runs it where libFuzzer does not. */
#ifndef TESTS_FUZZ_FUZZ_H
#define TESTS_FUZZ_FUZZ_H

#include <gnomon/gnomon.h>
#include <stddef.h>
#include <stdint.h>

/* The entry point that libFuzzer and driver.c call. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Ends the process as a finding when `good` is 0. */
void fuzz_expect(int good, const char *what);

/* A context of at most 256 MB whose long calls are cancelled after four seconds of the processor: a busy machine is no finding. */
gno_context *fuzz_context(void);

/* Writes the bytes as file `name` into a folder of the process's own; the path is valid until the next call. */
const char *fuzz_file(const char *name, const uint8_t *data, size_t size);

/* Bytes taken one after the other; zeros when there are no more. */
typedef struct fuzz_bytes {
    const uint8_t *data;
    size_t size;
} fuzz_bytes;

unsigned fuzz_byte(fuzz_bytes *bytes);

#endif
