/* deflate.c -- see deflate.h. */
#include "io/deflate.h"

#include <string.h>

enum {
    SYMBOLS = 286,     /* bytes, end of block, classes of run lengths */
    END = 256,
    LONGEST_CODE = 15,
    SHORTEST_RUN = 3,
    LONGEST_RUN = 258,
    HEAD_BYTES = 512,  /* more than a block needs beside its tokens, head and end of the stream included */
    TOKEN_BYTES = 2,   /* no byte's code is longer, and a run takes the place of three */
    CHECK_LANES = 16,
    CHECK_STEPS = 256, /* after which sums are brought back below the modulus */
    CHECK_MODULUS = 65521
};

int gnoi_deflate_create(gno_context *context, size_t most, gnoi_deflate *d)
{
    memset(d, 0, sizeof *d);
    d->context = context;
    d->most = most;
    d->adler = 1;
    if (most > (SIZE_MAX - HEAD_BYTES) / TOKEN_BYTES - 1) return 0;
    d->out = gno_context_realloc(context, NULL, 0, TOKEN_BYTES * most + HEAD_BYTES);
    d->tokens = gno_context_realloc(context, NULL, 0, (most + 1) * sizeof *d->tokens);
    return d->out != NULL && d->tokens != NULL;
}

void gnoi_deflate_destroy(gnoi_deflate *d)
{
    if (d->out != NULL) gno_context_realloc(d->context, d->out, TOKEN_BYTES * d->most + HEAD_BYTES, 0);
    if (d->tokens != NULL) gno_context_realloc(d->context, d->tokens, (d->most + 1) * sizeof *d->tokens, 0);
    d->out = NULL;
    d->tokens = NULL;
}

/* ---- tokens --------------------------------------------------------------------------------------------------------------- */

/* How many of up to `most` bytes from p on are c. */
static size_t run_of(const unsigned char *p, size_t most, unsigned char c)
{
    size_t n = 0;
    uint64_t eight, here;
    memset(&eight, c, sizeof eight);
    for (; n + sizeof eight <= most; n += sizeof eight) {
        memcpy(&here, p + n, sizeof here);
        if (here != eight) break;
    }
    while (n < most && p[n] == c) n++;
    return n;
}

/* Eight bytes, the first one lowest. */
static inline uint64_t load(const unsigned char *p)
{
    uint64_t v = 0;
    for (int i = 0; i < 8; i++) v |= (uint64_t)p[i] << (8 * i);
    return v;
}

/* The highest bit of each byte that is zero, as are the two above it. */
static inline uint64_t three_zeros(uint64_t v)
{
    const uint64_t low = 0x7f7f7f7f7f7f7f7f, zeros = ~(((v & low) + low) | v | low);
    return zeros & zeros >> 8 & zeros >> 16;
}

static size_t add_run(const unsigned char *p, size_t left, uint16_t *token)
{
    const size_t run = run_of(p, left < LONGEST_RUN ? left : LONGEST_RUN, p[-1]);
    *token = (uint16_t)(END + run);
    return run;
}

/* Returns how many there are; the last one is the end. Six bytes at a time while none of them begins a run. */
static size_t find_tokens(const unsigned char *p, size_t size, uint16_t *tokens)
{
    size_t count = 1, i = 1;
    tokens[0] = p[0];
    while (i + 8 <= size) {
        const uint64_t next = load(p + i);
        uint64_t run = three_zeros(next ^ (next << 8 | p[i - 1]));
        size_t plain = run ? 0 : 6;
        for (; run && !(run & 0x80); run >>= 8) plain++;
        for (int k = 0; k < 6; k++) tokens[count + (size_t)k] = (uint16_t)(next >> (8 * k) & 255);
        count += plain;
        i += plain;
        if (run) i += add_run(p + i, size - i, &tokens[count++]);
    }
    while (i < size) {
        if (i + SHORTEST_RUN <= size && p[i] == p[i - 1] && p[i + 1] == p[i - 1] && p[i + 2] == p[i - 1])
            i += add_run(p + i, size - i, &tokens[count++]);
        else
            tokens[count++] = p[i++];
    }
    tokens[count++] = END;
    return count;
}

/* The symbol of a token and the bits that follow its code. */
static int symbol_of(int token, int *extra_bits, unsigned *extra)
{
    const int length = token - END - SHORTEST_RUN;
    int bits = 0;
    *extra_bits = 0;
    *extra = 0;
    if (token <= END) return token;
    if (length == LONGEST_RUN - SHORTEST_RUN) return SYMBOLS - 1;
    while (length >> bits >= 8) bits++;
    *extra_bits = bits;
    *extra = (unsigned)length & ((1u << bits) - 1);
    return END + 1 + 4 * bits + (length >> bits);
}

/* ---- codes ---------------------------------------------------------------------------------------------------------------- */

typedef struct leaf {
    uint32_t count;
    int symbol;
} leaf;

/* By rising count; symbols of one count by themselves. */
static void sort(leaf *leaves, int count)
{
    static const int gaps[] = {132, 57, 23, 10, 4, 1};
    for (size_t g = 0; g < sizeof gaps / sizeof gaps[0]; g++)
        for (int i = gaps[g]; i < count; i++) {
            const leaf l = leaves[i];
            int j = i;
            for (; j >= gaps[g] && (leaves[j - gaps[g]].count > l.count || (leaves[j - gaps[g]].count == l.count && leaves[j - gaps[g]].symbol > l.symbol));
                 j -= gaps[g])
                leaves[j] = leaves[j - gaps[g]];
            leaves[j] = l;
        }
}

/* How many codes have each length in Huffman's tree over at least two leaves by rising count: the two lightest of leaves and nodes become
 * the next node, and nodes come by rising weight themselves. */
static void count_lengths(const leaf *leaves, int count, int of_length[LONGEST_CODE + 1])
{
    uint32_t weight[SYMBOLS];
    int parent[2 * SYMBOLS], depth[SYMBOLS], next_leaf = 0, next_node = 0;
    for (int node = 0; node < count - 1; node++) {
        weight[node] = 0;
        for (int k = 0; k < 2; k++) {
            const int is_leaf = next_leaf < count && (next_node == node || leaves[next_leaf].count <= weight[next_node]);
            weight[node] += is_leaf ? leaves[next_leaf].count : weight[next_node];
            parent[is_leaf ? next_leaf++ : SYMBOLS + next_node++] = node;
        }
    }
    depth[count - 2] = 0;
    for (int node = count - 3; node >= 0; node--) depth[node] = depth[parent[SYMBOLS + node]] + 1;
    for (int i = 0; i < count; i++) {
        const int length = depth[parent[i]] + 1;
        of_length[length < LONGEST_CODE ? length : LONGEST_CODE]++;
    }
}

/* Codes cut short at the longest length take more room than there is: each step makes one longer elsewhere and frees one unit. */
static void make_room(int of_length[LONGEST_CODE + 1])
{
    uint32_t used = 0;
    for (int n = 1; n <= LONGEST_CODE; n++) used += (uint32_t)of_length[n] << (LONGEST_CODE - n);
    for (; used > 1u << LONGEST_CODE; used--) {
        int n = LONGEST_CODE - 1;
        while (of_length[n] == 0) n--;
        of_length[n]--;
        of_length[n + 1] += 2;
        of_length[LONGEST_CODE]--;
    }
}

static unsigned reversed(unsigned code, int length)
{
    unsigned r = 0;
    for (int i = 0; i < length; i++) r |= (code >> i & 1) << (length - 1 - i);
    return r;
}

/* Lengths and codes, lowest bit first, of the symbols that occur; length 0 for the others. */
static void make_codes(const uint32_t count[SYMBOLS], int length[SYMBOLS], unsigned code[SYMBOLS])
{
    leaf leaves[SYMBOLS];
    int leaf_count = 0, of_length[LONGEST_CODE + 1] = {0}, n = LONGEST_CODE;
    unsigned next[LONGEST_CODE + 2] = {0};
    for (int s = 0; s < SYMBOLS; s++) {
        length[s] = 0;
        if (count[s] > 0) {
            leaves[leaf_count].count = count[s];
            leaves[leaf_count++].symbol = s;
        }
    }
    sort(leaves, leaf_count);
    count_lengths(leaves, leaf_count, of_length);
    make_room(of_length);
    for (int k = 1; k <= LONGEST_CODE; k++) next[k + 1] = (next[k] + (unsigned)of_length[k]) << 1;
    for (int i = 0; i < leaf_count; i++) {
        while (of_length[n] == 0) n--;
        of_length[n]--;
        length[leaves[i].symbol] = n;
    }
    for (int s = 0; s < SYMBOLS; s++)
        if (length[s] > 0) code[s] = reversed(next[length[s]]++, length[s]);
}

/* ---- bits ----------------------------------------------------------------------------------------------------------------- */

typedef struct bit_writer {
    unsigned char *out;
    uint64_t bits;
    int count;
} bit_writer;

/* Whole bytes go out; less than 8 bits stay. */
static inline void flush(bit_writer *w)
{
    for (int i = 0; i < 8; i++) w->out[i] = (unsigned char)(w->bits >> (8 * i));
    w->out += w->count >> 3;
    w->bits >>= w->count & ~7;
    w->count &= 7;
}

/* At most 56 bits between two flushes. */
static inline void put(bit_writer *w, uint64_t bits, int count)
{
    w->bits |= bits << w->count;
    w->count += count;
}

/* Lengths of all symbols and of the one distance, each as itself in four bits. */
static void put_head(bit_writer *w, const int length[SYMBOLS], int is_last)
{
    static const int of_16_17_18 = 3, lengths = 19;
    put(w, (uint64_t)is_last | 2 << 1, 3);
    put(w, SYMBOLS - 257, 5);
    put(w, 0, 5);
    put(w, (uint64_t)lengths - 4, 4);
    flush(w);
    for (int i = 0; i < lengths; i++) {
        put(w, i < of_16_17_18 ? 0 : 4, 3);
        flush(w);
    }
    for (int s = 0; s <= SYMBOLS; s++) {
        put(w, reversed(s < SYMBOLS ? (unsigned)length[s] : 1, 4), 4);
        flush(w);
    }
}

/* What each token that occurs is in bits, how many in the highest byte. A run is of what is one byte back: the one distance there is, code 0. */
static void find_bits(const int length[SYMBOLS], const unsigned code[SYMBOLS], uint32_t bits[GNOI_DEFLATE_TOKENS])
{
    for (int t = 0; t < GNOI_DEFLATE_TOKENS; t++) {
        int extra_bits, s;
        unsigned extra;
        if (t > END && t < END + SHORTEST_RUN) continue;
        s = symbol_of(t, &extra_bits, &extra);
        if (length[s] > 0) bits[t] = code[s] | extra << length[s] | (uint32_t)(length[s] + extra_bits + (t > END)) << 24;
    }
}

static void put_tokens(bit_writer *w, const uint16_t *tokens, size_t count, const uint32_t bits[GNOI_DEFLATE_TOKENS])
{
    size_t i = 0;
    for (; i + 2 <= count; i += 2) {
        const uint32_t a = bits[tokens[i]], b = bits[tokens[i + 1]];
        put(w, a & 0xffffff, (int)(a >> 24));
        put(w, b & 0xffffff, (int)(b >> 24));
        flush(w);
    }
    if (i < count) put(w, bits[tokens[i]] & 0xffffff, (int)(bits[tokens[i]] >> 24));
    flush(w);
}

/* ---- checksum ------------------------------------------------------------------------------------------------------------- */

/* Adler's: the sum of all bytes and one, and the sum of all its values on the way. Bytes go to lanes in turn; `before` sums up a lane's
 * bytes once for each step that follows. */
static uint32_t check(uint32_t adler, const unsigned char *p, size_t size)
{
    uint64_t low = adler & 0xffff, high = adler >> 16;
    while (size >= CHECK_LANES) {
        uint32_t sum[CHECK_LANES] = {0}, before[CHECK_LANES] = {0};
        const size_t steps = size / CHECK_LANES < CHECK_STEPS ? size / CHECK_LANES : CHECK_STEPS;
        for (size_t k = 0; k < steps; k++, p += CHECK_LANES)
            for (int j = 0; j < CHECK_LANES; j++) {
                before[j] += sum[j];
                sum[j] += p[j];
            }
        high += steps * CHECK_LANES * low;
        for (uint32_t j = 0; j < CHECK_LANES; j++) {
            low += sum[j];
            high += CHECK_LANES * (uint64_t)before[j] + (CHECK_LANES - j) * (uint64_t)sum[j];
        }
        low %= CHECK_MODULUS;
        high %= CHECK_MODULUS;
        size -= steps * CHECK_LANES;
    }
    for (; size > 0; size--) {
        low += *p++;
        high += low;
    }
    return (uint32_t)(high % CHECK_MODULUS << 16 | low % CHECK_MODULUS);
}

/* ---- a block -------------------------------------------------------------------------------------------------------------- */

static void count_symbols(const uint16_t *tokens, size_t count, uint32_t of_symbol[SYMBOLS])
{
    uint32_t of_token[2][GNOI_DEFLATE_TOKENS];
    memset(of_token, 0, sizeof of_token);
    memset(of_symbol, 0, SYMBOLS * sizeof *of_symbol);
    for (size_t i = 0; i < count; i++) of_token[i & 1][tokens[i]]++; /* two, for equal ones in a row wait for each other */
    for (int t = 0; t < GNOI_DEFLATE_TOKENS; t++) {
        int extra_bits;
        unsigned extra;
        if (of_token[0][t] + of_token[1][t] > 0) of_symbol[symbol_of(t, &extra_bits, &extra)] += of_token[0][t] + of_token[1][t];
    }
}

/* The checksum in order of significance, from the next whole byte on. */
static void put_end(bit_writer *w, uint32_t adler)
{
    w->count = (w->count + 7) & ~7;
    flush(w);
    for (int shift = 24; shift >= 0; shift -= 8) {
        put(w, adler >> shift & 255, 8);
        flush(w);
    }
}

size_t gnoi_deflate_block(gnoi_deflate *d, const unsigned char *data, size_t size, int is_last)
{
    bit_writer w = {d->out, d->bits, d->bit_count};
    uint32_t count[SYMBOLS], bits[GNOI_DEFLATE_TOKENS];
    int length[SYMBOLS];
    unsigned code[SYMBOLS];
    const size_t tokens = find_tokens(data, size, d->tokens);
    if (!d->is_begun) {
        put(&w, 0x0178, 16); /* deflate, 32 KB of memory; fastest */
        flush(&w);
        d->is_begun = 1;
    }
    count_symbols(d->tokens, tokens, count);
    make_codes(count, length, code);
    put_head(&w, length, is_last);
    find_bits(length, code, bits);
    put_tokens(&w, d->tokens, tokens, bits);
    d->adler = check(d->adler, data, size);
    if (is_last) put_end(&w, d->adler);
    d->bits = w.bits;
    d->bit_count = w.count;
    return (size_t)(w.out - d->out);
}
