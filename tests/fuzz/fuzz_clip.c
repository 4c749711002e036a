/* fuzz_clip.c -- bytes as two shapes of rings on a small grid, where edges meet, overlap and coincide all the time. Judged by areas:
 * union and intersection add up to both shapes, exclusive or is union without intersection, a difference the shape without the
 * intersection; and a result combined with itself is nothing.
 *
 * Bytes: grid and scale; then for each ring a byte (low bits: points; 0x40: of the clip; 0x80: begins a polygon), then x, y each. */
#include "fuzz/fuzz.h"

#include <gnomon/gnomon_clip.h>
#include <math.h>

enum { POINTS = 400, RINGS = 64 };

typedef struct rings {
    size_t polygons, count, polygon_start[RINGS + 1], ring_start[RINGS + 1];
    double points[2 * POINTS];
} rings;

static void add_ring(rings *r, fuzz_bytes *bytes, unsigned head, unsigned mask, double scale)
{
    size_t n = r->ring_start[r->count];
    if (r->polygons == 0 || (head & 0x80)) {
        r->polygon_start[r->polygons++] = r->count;
    }
    for (unsigned i = 0; i < (head & 31u) && n < POINTS; i++, n++) {
        r->points[2 * n] = scale * (fuzz_byte(bytes) & mask);
        r->points[2 * n + 1] = scale * (fuzz_byte(bytes) & mask);
    }
    r->ring_start[++r->count] = n;
    r->polygon_start[r->polygons] = r->count;
}

static gno_shape view(const rings *r)
{
    gno_shape s = {r->polygons, r->polygon_start, r->count, r->ring_start, r->points};
    return s;
}

static double area(gno_clipper *clipper, gno_clip_op op, const gno_shape *a, const gno_shape *b)
{
    gno_shape result, twice;
    double found;
    gno_status status = gno_clip(clipper, op, a, b, &result);
    fuzz_expect(status == GNO_OK, "clipping");
    found = gno_shape_area(&result);
    fuzz_expect(found >= 0, "no negative area");
    fuzz_expect(gno_clip(clipper, GNO_CLIP_XOR, &result, &result, &twice) == GNO_OK && twice.polygon_count == 0, "nothing left");
    return found;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const unsigned masks[4] = {3, 15, 63, 255};
    static const double scales[4] = {1, 1e12, 1e-12, 0.1};
    rings shapes[2] = {{0}, {0}};
    fuzz_bytes bytes = {data, size};
    unsigned head = fuzz_byte(&bytes), mask = masks[head & 3];
    double scale = scales[head >> 2 & 3], slack = 1e-9 * (mask * scale) * (mask * scale);
    gno_context *context = fuzz_context();
    gno_clipper *clipper;
    while (bytes.size > 0) {
        head = fuzz_byte(&bytes);
        rings *r = &shapes[head >> 6 & 1];
        if (r->count < RINGS) {
            add_ring(r, &bytes, head, mask, scale);
        }
    }
    gno_shape a = view(&shapes[0]), b = view(&shapes[1]);
    fuzz_expect(gno_clipper_create(context, &clipper) == GNO_OK, "a clipper");
    double both = area(clipper, GNO_CLIP_INTERSECTION, &a, &b), any = area(clipper, GNO_CLIP_UNION, &a, &b);
    double alone = area(clipper, GNO_CLIP_UNION, &a, NULL), other = area(clipper, GNO_CLIP_UNION, &b, NULL);
    fuzz_expect(fabs(both + any - alone - other) <= slack, "union and intersection add up");
    fuzz_expect(fabs(area(clipper, GNO_CLIP_XOR, &a, &b) - any + both) <= slack, "exclusive or");
    fuzz_expect(fabs(area(clipper, GNO_CLIP_DIFFERENCE, &a, &b) - alone + both) <= slack, "difference");
    gno_clipper_destroy(clipper);
    gno_context_destroy(context);
    return 0;
}
