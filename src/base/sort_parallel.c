/* sort_parallel.c -- least significant digit radix sort in pieces: every piece counts its digits, a sum over digits and pieces tells
 * each piece where its pairs of each digit go, and all pieces scatter at once. The places are those of the sort in one piece.
 */
#include "base/sort_parallel.h"
#include "base/parallel.h"

#include <string.h>

#define PIECE 65536 /* pairs: below two pieces the sort of one thread serves */
#define DIGIT_BITS 11
#define DIGITS (1u << DIGIT_BITS)

typedef struct sorting {
    gnoi_keyed *from, *to;
    size_t count, pieces;
    unsigned shift;
    uint32_t (*digit)[DIGITS]; /* of each piece: how many pairs; then where the next one goes */
} sorting;

static unsigned digit_of(const sorting *s, uint32_t key) { return key >> s->shift & (DIGITS - 1); }

static size_t piece_end(const sorting *s, size_t piece) { return (piece + 1) * PIECE < s->count ? (piece + 1) * PIECE : s->count; }

static gno_status count_digits(void *user, int worker, size_t piece)
{
    const sorting *s = user;
    uint32_t *digit = s->digit[piece];
    (void)worker;
    memset(digit, 0, sizeof s->digit[piece]);
    for (size_t i = piece * PIECE, end = piece_end(s, piece); i < end; i++)
        digit[digit_of(s, s->from[i].key)]++;
    return GNO_OK;
}

static gno_status scatter(void *user, int worker, size_t piece)
{
    const sorting *s = user;
    uint32_t *digit = s->digit[piece];
    (void)worker;
    for (size_t i = piece * PIECE, end = piece_end(s, piece); i < end; i++)
        s->to[digit[digit_of(s, s->from[i].key)]++] = s->from[i];
    return GNO_OK;
}

/* Counts become places; 0 when all keys share the digit and nothing need be moved. */
static int set_places(const sorting *s)
{
    uint32_t sum = 0;
    for (unsigned d = 0; d < DIGITS; d++) {
        uint32_t before = sum;
        for (size_t k = 0; k < s->pieces; k++) {
            uint32_t n = s->digit[k][d];
            s->digit[k][d] = sum;
            sum += n;
        }
        if (sum - before == s->count)
            return 0;
    }
    return 1;
}

gnoi_keyed *gnoi_sort_parallel(gno_context *context, int threads, const char *stage, gnoi_keyed *pairs, gnoi_keyed *scratch,
                               size_t count, unsigned bits)
{
    sorting s = {pairs, scratch, count, (count + PIECE - 1) / PIECE, 0, NULL};
    gno_status status = GNO_OK;
    if (count < 2 * PIECE || count > UINT32_MAX) {
        gnoi_sort(pairs, scratch, count);
        return pairs;
    }
    s.digit = gnoi_malloc(context, s.pieces, sizeof *s.digit);
    if (!s.digit)
        status = gnoi_fail(context, GNO_ERROR_MEMORY, "%s: out of memory", stage);
    for (; s.shift < bits && !status; s.shift += DIGIT_BITS) {
        status = gnoi_parallel(context, threads, s.pieces, stage, count_digits, &s);
        if (!status && set_places(&s)) {
            gnoi_keyed *swap = s.from;
            status = gnoi_parallel(context, threads, s.pieces, stage, scatter, &s);
            s.from = s.to;
            s.to = swap;
        }
    }
    gnoi_free(context, s.digit, s.pieces, sizeof *s.digit);
    return status ? NULL : s.from;
}
