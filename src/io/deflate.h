/* deflate.h -- bytes to a zlib stream, fast: Huffman codes and runs of one byte, nothing else.
 *
 * Place: under the PNG encoder. What a row of a rendered picture differs by from the row above has few repetitions but runs, so a
 * search for them is time lost; with runs alone the sizes are those of zlib's Z_RLE at a fifth of the time.
 * Every block has codes of its own. Source: RFC 1950, RFC 1951.
 */
#ifndef GNOI_IO_DEFLATE_H
#define GNOI_IO_DEFLATE_H

#include <gnomon/gnomon.h>
#include <stdint.h>

#define GNOI_DEFLATE_TOKENS 515 /* bytes, the end of a block, and run lengths 3 .. 258 as 256 + length */

typedef struct gnoi_deflate {
    gno_context *context;
    size_t most;         /* bytes of a block at most */
    unsigned char *out;  /* where gnoi_deflate_block leaves its output */
    uint16_t *tokens;
    uint64_t bits;       /* less than 8, of the byte begun */
    int bit_count;
    int is_begun;
    uint32_t adler;      /* checksum of all so far */
} gnoi_deflate;

/* Returns 0 when memory fails. gnoi_deflate_destroy is due in any case. */
int gnoi_deflate_create(gno_context *context, size_t most, gnoi_deflate *deflate);
void gnoi_deflate_destroy(gnoi_deflate *deflate);

/* Compresses 1 .. most bytes; returns how many bytes of the stream are in deflate->out now, to be written before the next call. The last
 * block ends the stream. */
size_t gnoi_deflate_block(gnoi_deflate *deflate, const unsigned char *data, size_t size, int is_last);

#endif
