/* clip_suites.c -- public suites of polygon operations through the clipper. Built by clip_suites.sh with libgeos-dev.
 * usage: clip_suites FILE...        FILE.xml: GEOS/JTS tests (tests/xmltester); FILE.txt: Clipper2's Tests/Polygons.txt.
 *
 * XML: every case of two areas in floating precision is run through the four operations; areas have to agree with GEOS's own result
 * to 1e-9 of the extent squared, and with the one written in the file where it is an area. TXT: every case is run by the even-odd rule,
 * whatever its own is; areas have to agree with the slow twin (support/slabs.h) and, for even-odd cases, with the file's
 * area, which is that of corners at whole numbers, to a fiftieth. All results have to be valid for GEOS. Prints what disagrees; exit status 1 then.
 */
#include "support/shapes.h"
#include "support/slabs.h"

#include <ctype.h>
#include <geos_c.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TOLERANCE 1e-9
#define TWIN_POINTS 700 /* the slow twin is asked up to here */

typedef struct tally {
    long cases, operations, wrong, invalid, failed, skipped, unlike_file;
} tally;

static void quiet(const char *format, ...)
{
    (void)format;
}

static char *read_whole(const char *path)
{
    FILE *f = fopen(path, "rb");
    char *text;
    long size;
    if (!f || fseek(f, 0, SEEK_END) != 0 || (size = ftell(f)) < 0 || fseek(f, 0, SEEK_SET) != 0) {
        fprintf(stderr, "%s: cannot be read\n", path);
        exit(2);
    }
    text = malloc((size_t)size + 1);
    if (!text || fread(text, 1, (size_t)size, f) != (size_t)size)
        exit(2);
    text[size] = '\0';
    fclose(f);
    return text;
}

/* ---- GEOS to shapes and back ---------------------------------------------------------------------------------------- */

static void add_ring(shape_buffer *to, const GEOSGeometry *ring)
{
    const GEOSCoordSequence *q = GEOSGeom_getCoordSeq(ring);
    unsigned n = 0;
    GEOSCoordSeq_getSize(q, &n);
    shape_begin_ring(to);
    for (unsigned i = 0; i + 1 < n; i++) {
        double x, y;
        GEOSCoordSeq_getXY(q, i, &x, &y);
        shape_point(to, x, y);
    }
}

/* 0 when there is anything but areas. */
static int add_areas(shape_buffer *to, const GEOSGeometry *g)
{
    int type = GEOSGeomTypeId(g), good = 1;
    if (type == GEOS_POLYGON) {
        if (GEOSisEmpty(g))
            return 1;
        shape_begin_polygon(to);
        add_ring(to, GEOSGetExteriorRing(g));
        for (int i = 0; i < GEOSGetNumInteriorRings(g); i++)
            add_ring(to, GEOSGetInteriorRingN(g, i));
        return 1;
    }
    if (type != GEOS_MULTIPOLYGON && type != GEOS_GEOMETRYCOLLECTION)
        return 0;
    for (int i = 0; i < GEOSGetNumGeometries(g); i++)
        good &= add_areas(to, GEOSGetGeometryN(g, i));
    return good;
}

static int all_finite(const shape_buffer *b)
{
    for (size_t i = 0; i < 2 * b->count; i++)
        if (!isfinite(b->points[i]))
            return 0;
    return 1;
}

static int areas_only(const GEOSGeometry *g)
{
    shape_buffer unused = {0};
    int only;
    shape_clear(&unused);
    only = add_areas(&unused, g);
    shape_free(&unused);
    return only;
}

static GEOSGeometry *ring_of(const gno_shape *s, size_t r)
{
    size_t first = s->ring_start[r], n = s->ring_start[r + 1] - first;
    GEOSCoordSequence *q = GEOSCoordSeq_create((unsigned)n + 1, 2);
    for (size_t i = 0; i <= n; i++)
        GEOSCoordSeq_setXY(q, (unsigned)i, s->points[2 * (first + i % n)], s->points[2 * (first + i % n) + 1]);
    return GEOSGeom_createLinearRing(q);
}

static int is_valid(const gno_shape *s)
{
    GEOSGeometry **polygons = malloc((s->polygon_count + 1) * sizeof *polygons), *all;
    int valid;
    for (size_t p = 0; p < s->polygon_count; p++) {
        size_t first = s->polygon_start[p], n = s->polygon_start[p + 1] - first;
        GEOSGeometry **holes = malloc(n * sizeof *holes);
        for (size_t h = 1; h < n; h++)
            holes[h - 1] = ring_of(s, first + h);
        polygons[p] = GEOSGeom_createPolygon(ring_of(s, first), holes, (unsigned)(n - 1));
        free(holes);
    }
    all = GEOSGeom_createCollection(GEOS_MULTIPOLYGON, polygons, (unsigned)s->polygon_count);
    valid = GEOSisValid(all) == 1;
    GEOSGeom_destroy(all);
    free(polygons);
    return valid;
}

/* NULL when GEOS gives up. */
static GEOSGeometry *operate(int op, const GEOSGeometry *a, const GEOSGeometry *b)
{
    return op == 0 ? GEOSUnion(a, b) : op == 1 ? GEOSIntersection(a, b) : op == 2 ? GEOSDifference(a, b) : GEOSSymDifference(a, b);
}

/* ---- XML ----------------------------------------------------------------------------------------------------------------- */

/* The text between <tag ...> and </tag> at or after *from; moves *from behind it. NULL when there is none before `end`. */
static char *element(const char **from, const char *end, const char *tag, char *attributes, size_t room)
{
    char open[32], close[32], *text;
    const char *a, *b, *c;
    snprintf(open, sizeof open, "<%s", tag);
    snprintf(close, sizeof close, "</%s>", tag);
    for (a = strstr(*from, open); a && a < end && isalnum((unsigned char)a[strlen(open)]); a = strstr(a + 1, open))
        ;
    if (!a || a >= end || !(b = strchr(a, '>')) || !(c = strstr(b, close)) || c > end)
        return NULL;
    if (attributes)
        snprintf(attributes, room, "%.*s", (int)(b - a), a);
    text = malloc((size_t)(c - b));
    memcpy(text, b + 1, (size_t)(c - b - 1));
    text[c - b - 1] = '\0';
    *from = c + strlen(close);
    return text;
}

static GEOSGeometry *parse(const char *text)
{
    while (isspace((unsigned char)*text))
        text++;
    if (isxdigit((unsigned char)text[0]) && isxdigit((unsigned char)text[1]) && isdigit((unsigned char)text[0])) {
        GEOSWKBReader *reader = GEOSWKBReader_create();
        size_t n = 0;
        GEOSGeometry *g;
        while (isxdigit((unsigned char)text[n]))
            n++;
        g = GEOSWKBReader_readHEX(reader, (const unsigned char *)text, n);
        GEOSWKBReader_destroy(reader);
        return g;
    }
    {
        GEOSWKTReader *reader = GEOSWKTReader_create();
        GEOSGeometry *g = GEOSWKTReader_read(reader, text);
        GEOSWKTReader_destroy(reader);
        return g;
    }
}

/* GEOS's areas of the case as written in the file: -1 where there is none. */
static void file_areas(const char *text, const char *end, double area[4])
{
    char attributes[256], *wkt;
    for (int op = 0; op < 4; op++)
        area[op] = -1;
    while ((wkt = element(&text, end, "op", attributes, sizeof attributes)) != NULL) {
        int op = strstr(attributes, "\"union") ? 0 : strstr(attributes, "\"intersection\"") ? 1 : strstr(attributes, "\"difference\"") ? 2
                 : strstr(attributes, "\"symdifference\"") ? 3 : -1;
        GEOSGeometry *g = op >= 0 && !strstr(attributes, "arg1=\"B\"") ? parse(wkt) : NULL;
        if (g) {
            GEOSArea(g, &area[op]);
            GEOSGeom_destroy(g);
        }
        free(wkt);
    }
}

static void run_pair(gno_clipper *clipper, const char *name, GEOSGeometry *a, GEOSGeometry *b, const double *written, tally *t)
{
    shape_buffer sa = {0}, sb = {0};
    gno_shape va, vb, result;
    shape_clear(&sa);
    shape_clear(&sb);
    if (!add_areas(&sa, a) || !add_areas(&sb, b)) {
        t->skipped++;
    } else {
        double extent;
        int good = GEOSisValid(a) == 1 && GEOSisValid(b) == 1;
        va = shape_view(&sa);
        vb = shape_view(&sb);
        extent = slab_extent(&va, &vb);
        t->cases++;
        for (int op = 0; op < 4; op++) {
            GEOSGeometry *want = good ? operate(op, a, b) : NULL;
            double area = -1, ours;
            t->operations++;
            if (gno_clip(clipper, (gno_clip_op)op, &va, &vb, &result) != GNO_OK) {
                int finite = all_finite(&sa) && all_finite(&sb); /* some cases are about coordinates that are not */
                printf("%s op %d: %s\n", name, op, finite ? "failed" : "refused: not finite");
                t->failed += finite;
                if (want)
                    GEOSGeom_destroy(want);
                continue;
            }
            ours = gno_shape_area(&result);
            if (want)
                GEOSArea(want, &area);
            else if (sa.count + sb.count <= TWIN_POINTS)
                area = slab_area((gno_clip_op)op, &va, &vb);
            if (area >= 0 && !(fabs(area - ours) <= TOLERANCE * extent * extent)) {
                printf("%s op %d: area %.17g, wanted %.17g (%s)\n", name, op, ours, area, good ? "GEOS" : "twin");
                t->wrong++;
            }
            if (good && written && written[op] >= 0 && !(fabs(written[op] - ours) <= TOLERANCE * extent * extent)) {
                printf("%s op %d: area %.17g, in the file %.17g\n", name, op, ours, written[op]);
                t->unlike_file++;
            }
            if (!is_valid(&result)) {
                printf("%s op %d: invalid\n", name, op);
                t->invalid++;
            }
            if (want)
                GEOSGeom_destroy(want);
        }
    }
    shape_free(&sa);
    shape_free(&sb);
}

static void run_xml(gno_clipper *clipper, const char *path, tally *t)
{
    char *text = read_whole(path), *body;
    const char *at = text, *head = strstr(text, "<precisionModel");
    int fixed = head && (!strncasecmp(head, "<precisionModel type=\"FIXED", 27) || (strstr(head, "scale=") && strstr(head, "scale=") < strchr(head, '>')));
    for (int n = 1; (body = element(&at, text + strlen(text), "case", NULL, 0)) != NULL; n++) {
        const char *in_a = body, *in_b = body, *end = body + strlen(body);
        char *ta = element(&in_a, end, "a", NULL, 0), *tb = element(&in_b, end, "b", NULL, 0), name[512];
        GEOSGeometry *a = ta ? parse(ta) : NULL, *b = tb ? parse(tb) : NULL;
        double written[4];
        snprintf(name, sizeof name, "%s case %d", path, n);
        file_areas(body, end, written);
        if (a && !tb)
            b = GEOSGeom_createEmptyPolygon();
        if (a && GEOSGeomTypeId(a) == GEOS_GEOMETRYCOLLECTION && areas_only(a)) { /* whose parts may overlap */
            GEOSGeometry *joined = GEOSUnaryUnion(a);
            if (joined) {
                GEOSGeom_destroy(a);
                a = joined;
            }
        }
        if (a && b)
            run_pair(clipper, name, a, b, fixed ? NULL : written, t);
        else
            t->skipped++;
        if (a)
            GEOSGeom_destroy(a);
        if (b)
            GEOSGeom_destroy(b);
        free(ta);
        free(tb);
        free(body);
    }
    free(text);
}

/* ---- Clipper2's text ---------------------------------------------------------------------------------------------------- */

typedef struct text_case {
    char name[64];
    int op, even_odd;
    double area;
    shape_buffer shape[2];
} text_case;

static void run_text_case(gno_clipper *clipper, text_case *c, tally *t)
{
    gno_shape a = shape_view(&c->shape[0]), b = shape_view(&c->shape[1]), result;
    double extent, ours, area;
    if (c->op < 0)
        return;
    extent = slab_extent(&a, &b);
    t->cases++;
    t->operations++;
    if (gno_clip(clipper, (gno_clip_op)c->op, &a, &b, &result) != GNO_OK) {
        t->failed++;
        return;
    }
    ours = gno_shape_area(&result);
    if (c->shape[0].count + c->shape[1].count <= TWIN_POINTS) {
        area = slab_area((gno_clip_op)c->op, &a, &b);
        if (!(fabs(area - ours) <= TOLERANCE * extent * extent)) {
            printf("%s: area %.17g, wanted %.17g\n", c->name, ours, area);
            t->wrong++;
        }
    }
    if (c->even_odd && c->area > 0 && !(fabs(ours - c->area) <= 0.02 * c->area + 2)) {
        printf("%s: area %.17g, in the file %.17g\n", c->name, ours, c->area);
        t->unlike_file++;
    }
    if (!is_valid(&result)) {
        printf("%s: invalid\n", c->name);
        t->invalid++;
    }
}

static void start_text_case(text_case *c, const char *line)
{
    snprintf(c->name, sizeof c->name, "%.40s", line);
    c->name[strcspn(c->name, "\r\n")] = '\0';
    c->op = -1;
    c->even_odd = 0;
    c->area = 0;
    for (int k = 0; k < 2; k++) {
        shape_clear(&c->shape[k]);
        shape_begin_polygon(&c->shape[k]);
    }
}

static void read_ring(shape_buffer *to, char *line)
{
    char *end;
    shape_begin_ring(to);
    for (;;) {
        double x = strtod(line, &end), y;
        if (end == line)
            return;
        line = end + strspn(end, ", ");
        y = strtod(line, &end);
        if (end == line)
            return;
        line = end + strspn(end, ", ");
        shape_point(to, x, y);
    }
}

static void run_text(gno_clipper *clipper, const char *path, tally *t)
{
    char *text = read_whole(path), *line = text, *next;
    text_case c;
    int into = -1;
    memset(&c, 0, sizeof c);
    start_text_case(&c, "");
    for (; line; line = next) {
        next = strchr(line, '\n');
        if (next)
            *next++ = '\0';
        if (!strncmp(line, "CAPTION", 7)) {
            run_text_case(clipper, &c, t);
            start_text_case(&c, line);
            into = -1;
        } else if (!strncmp(line, "CLIPTYPE", 8)) {
            c.op = strstr(line, "UNION") ? 0 : strstr(line, "INTERSECTION") ? 1 : strstr(line, "DIFFERENCE") ? 2 : strstr(line, "XOR") ? 3 : -1;
        } else if (!strncmp(line, "FILLRULE", 8)) {
            c.even_odd = strstr(line, "EVENODD") != NULL;
        } else if (!strncmp(line, "SOL_AREA", 8)) {
            c.area = strtod(line + 9, NULL);
        } else if (!strncmp(line, "SUBJECTS", 8)) {
            into = strstr(line, "OPEN") ? -1 : 0;
        } else if (!strncmp(line, "CLIPS", 5)) {
            into = 1;
        } else if (into >= 0 && (isdigit((unsigned char)*line) || *line == '-')) {
            read_ring(&c.shape[into], line);
        }
    }
    run_text_case(clipper, &c, t);
    shape_free(&c.shape[0]);
    shape_free(&c.shape[1]);
    free(text);
}

int main(int argc, char **argv)
{
    gno_context *context;
    gno_clipper *clipper;
    tally t = {0};
    initGEOS(quiet, quiet);
    if (gno_context_create(NULL, &context) != GNO_OK || gno_clipper_create(context, &clipper) != GNO_OK)
        return 1;
    for (int i = 1; i < argc; i++) {
        size_t n = strlen(argv[i]);
        if (n > 4 && !strcmp(argv[i] + n - 4, ".xml"))
            run_xml(clipper, argv[i], &t);
        else
            run_text(clipper, argv[i], &t);
    }
    printf("%ld cases, %ld operations: %ld areas wrong, %ld invalid, %ld failed; %ld unlike the file; %ld cases without two areas\n", t.cases,
           t.operations, t.wrong, t.invalid, t.failed, t.unlike_file, t.skipped);
    gno_clipper_destroy(clipper);
    gno_context_destroy(context);
    finishGEOS();
    return t.wrong || t.invalid || t.failed;
}
