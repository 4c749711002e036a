/* cryptomatte.h -- names as numbers that travel in float channels, and the manifest that tells them.
 *
 * Place: under picture_layers.c. Source: Friedman and Jones, Cryptomatte Specification 1.1.0 (Psyop): an id is the MurmurHash3
 * (x86, 32 bits, seed 0) of a name's bytes, its exponent kept off 0 and 255, taken as a float bit by bit.
 */
#ifndef GNOI_IO_CRYPTOMATTE_H
#define GNOI_IO_CRYPTOMATTE_H

#include <gnomon/gnomon.h>
#include <stdint.h>

/* The id of a name, as the bits of its float. */
uint32_t gnoi_crypto_id(const char *name);
float gnoi_crypto_float(uint32_t id);

/* A manifest being written: {"name":"id", ...}. */
typedef struct gnoi_manifest {
    gno_context *context;
    char *text;
    size_t length, capacity;
    int failed; /* sticky: memory ran out */
} gnoi_manifest;

void gnoi_manifest_begin(gnoi_manifest *manifest, gno_context *context);
void gnoi_manifest_add(gnoi_manifest *manifest, const char *name, uint32_t id);

/* Ends the text; returns 0 when memory failed. Free in any case. */
int gnoi_manifest_end(gnoi_manifest *manifest);
void gnoi_manifest_free(gnoi_manifest *manifest);

#endif
