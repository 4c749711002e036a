/* cryptomatte.c -- see cryptomatte.h. */
#include "io/cryptomatte.h"

#include "io/text_file.h"

#include <stdio.h>
#include <string.h>

static uint32_t rotate(uint32_t x, int bits)
{
    return x << bits | x >> (32 - bits);
}

static uint32_t mix_block(uint32_t k)
{
    return rotate(k * 0xcc9e2d51u, 15) * 0x1b873593u;
}

/* MurmurHash3_x86_32 (Appleby, public domain), seed 0; blocks are read byte by byte, lowest first, on any machine. */
static uint32_t murmur3(const unsigned char *data, size_t length)
{
    uint32_t hash = 0, tail = 0;
    size_t i = 0;
    for (; i + 4 <= length; i += 4) {
        const uint32_t k = (uint32_t)data[i] | (uint32_t)data[i + 1] << 8 | (uint32_t)data[i + 2] << 16 | (uint32_t)data[i + 3] << 24;
        hash = rotate(hash ^ mix_block(k), 13) * 5 + 0xe6546b64u;
    }
    for (size_t k = 0; i + k < length; k++) {
        tail |= (uint32_t)data[i + k] << (8 * k);
    }
    hash ^= mix_block(tail) ^ (uint32_t)length;
    hash = (hash ^ hash >> 16) * 0x85ebca6bu;
    hash = (hash ^ hash >> 13) * 0xc2b2ae35u;
    return hash ^ hash >> 16;
}

uint32_t gnoi_crypto_id(const char *name)
{
    const uint32_t hash = murmur3((const unsigned char *)name, strlen(name)), exponent = hash >> 23 & 255;
    /* Denormals, infinities and NaN would not survive every reader. */
    return exponent == 0 || exponent == 255 ? hash ^ 1u << 23 : hash;
}

float gnoi_crypto_float(uint32_t id)
{
    float value;
    memcpy(&value, &id, sizeof value);
    return value;
}

static void append(gnoi_manifest *m, const char *text, size_t length)
{
    if (m->failed || m->capacity - m->length <= length) {
        size_t wanted = m->capacity * 2 > m->length + length + 1 ? m->capacity * 2 : m->length + length + 256;
        char *fresh = m->failed ? NULL : gno_context_realloc(m->context, m->text, m->capacity, wanted);
        if (fresh == NULL) {
            m->failed = 1;
            return;
        }
        m->text = fresh;
        m->capacity = wanted;
    }
    memcpy(m->text + m->length, text, length);
    m->length += length;
}

static void append_string(gnoi_manifest *m, const char *text)
{
    char escaped[GNOI_JSON_LONGEST];
    append(m, "\"", 1);
    for (; *text != '\0'; text++) {
        append(m, escaped, gnoi_json_byte(*text, escaped));
    }
    append(m, "\"", 1);
}

void gnoi_manifest_begin(gnoi_manifest *manifest, gno_context *context)
{
    memset(manifest, 0, sizeof *manifest);
    manifest->context = context;
    append(manifest, "{", 1);
}

void gnoi_manifest_add(gnoi_manifest *manifest, const char *name, uint32_t id)
{
    char hex[16];
    if (manifest->length > 1) {
        append(manifest, ",", 1);
    }
    append_string(manifest, name);
    snprintf(hex, sizeof hex, ":\"%08lx\"", (unsigned long)id);
    append(manifest, hex, strlen(hex));
}

int gnoi_manifest_end(gnoi_manifest *manifest)
{
    append(manifest, "}", 2); /* with the zero */
    return !manifest->failed;
}

void gnoi_manifest_free(gnoi_manifest *manifest)
{
    if (manifest->text != NULL) {
        gno_context_realloc(manifest->context, manifest->text, manifest->capacity, 0);
    }
    manifest->text = NULL;
}
