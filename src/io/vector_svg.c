/* vector_svg.c -- a drawing as SVG 1.1.
 *
 * Place: writer under vector.c. cairo's own SVG knows neither ids nor data attributes, so the text is made here. Layers, from below:
 *   underlay    every shape once more, by reference, with a rim of its own colour: what shows through where two anti-aliased edges
 *               meet is then a neighbour's colour and not the paper
 *   pieces      the shapes themselves, exact
 *   background  what they leave free, and so without the rims that reach out there
 *   edges       lines
 * Numbers are written from whole units, so that no locale and no rounding come in.
 */
#include "io/drawing.h"

#include <stdio.h>
#include <string.h>

enum { TEXT_BUFFER = 1 << 16, LONGEST_PIECE = 64 };

/* Text on its way to the file. */
typedef struct text {
    gnoi_file *file;
    const gnoi_drawing *drawing;
    size_t used;
    char buffer[TEXT_BUFFER];
} text;

static void flush(text *t)
{
    gnoi_file_write(t->file, t->buffer, t->used);
    t->used = 0;
}

static void put_bytes(text *t, const char *bytes, size_t length)
{
    while (length > 0) {
        const size_t room = TEXT_BUFFER - t->used, n = length < room ? length : room;
        memcpy(t->buffer + t->used, bytes, n);
        t->used += n;
        bytes += n;
        length -= n;
        if (t->used == TEXT_BUFFER) {
            flush(t);
        }
    }
}

static void put(text *t, const char *string)
{
    put_bytes(t, string, strlen(string));
}

static void put_size(text *t, size_t number)
{
    char digits[LONGEST_PIECE];
    snprintf(digits, sizeof digits, "%zu", number);
    put(t, digits);
}

/* A double with a point whatever the locale. */
static void put_real(text *t, double value)
{
    char digits[LONGEST_PIECE];
    snprintf(digits, sizeof digits, "%.12g", value);
    for (char *c = digits; *c != '\0'; c++) {
        if (strchr("0123456789+-e", *c) == NULL) {
            *c = '.';
        }
    }
    put(t, digits);
}

/* Units as pixels: all digits after the point that are not zeros at the end. Appends to `to`, returns the new end. */
static char *format_units(char *to, int64_t value, int64_t unit)
{
    uint64_t size = value < 0 ? (uint64_t)-value : (uint64_t)value, whole = size / (uint64_t)unit, rest = size % (uint64_t)unit;
    char digits[24];
    int n = 0;
    if (value < 0) {
        *to++ = '-';
    }
    do {
        digits[n++] = (char)('0' + whole % 10);
    } while ((whole /= 10) > 0);
    while (n > 0) {
        *to++ = digits[--n];
    }
    if (rest > 0) {
        *to++ = '.';
        for (uint64_t place = (uint64_t)unit / 10; rest > 0; place /= 10) {
            *to++ = (char)('0' + rest / place);
            rest %= place;
        }
    }
    return to;
}

static void put_dot(text *t, char before, gnoi_dot dot)
{
    char piece[LONGEST_PIECE], *end = piece;
    *end++ = before;
    end = format_units(end, dot.x, t->drawing->unit);
    *end++ = ' ';
    end = format_units(end, dot.y, t->drawing->unit);
    put_bytes(t, piece, (size_t)(end - piece));
}

static void put_colour(text *t, const unsigned char rgb[3])
{
    char digits[LONGEST_PIECE];
    snprintf(digits, sizeof digits, "#%02x%02x%02x", rgb[0], rgb[1], rgb[2]);
    put(t, digits);
}

/* Bytes of a well-formed UTF-8 character that XML may hold, 0 for anything else. */
static size_t character_length(const unsigned char *c)
{
    static const unsigned least[5] = {0, 0, 0x80, 0x800, 0x10000};
    const size_t length = c[0] < 0x80 ? 1 : (c[0] & 0xe0) == 0xc0 ? 2 : (c[0] & 0xf0) == 0xe0 ? 3 : (c[0] & 0xf8) == 0xf0 ? 4 : 0;
    unsigned code = length == 1 ? c[0] : length == 0 ? 0 : c[0] & (0x7fu >> length);
    for (size_t i = 1; i < length; i++) {
        if ((c[i] & 0xc0) != 0x80) {
            return 0;
        }
        code = code << 6 | (c[i] & 0x3f);
    }
    if (code < 0x20 || code < least[length] || (code >= 0xd800 && code < 0xe000) || code == 0xfffe || code == 0xffff || code > 0x10ffff) {
        return 0;
    }
    return length;
}

/* Text for people inside XML: what XML may not hold becomes the replacement character; blanks become `blank`, where it is given. */
static void put_escaped(text *t, const char *string, char blank)
{
    const unsigned char *c = (const unsigned char *)string;
    while (*c != '\0') {
        const size_t length = character_length(c);
        if (*c == '\t' || *c == '\n' || *c == '\r' || *c == ' ') {
            put(t, blank != '\0' ? "_" : " ");
            c++;
        } else if (length == 0) {
            put(t, "\xef\xbf\xbd");
            c++;
        } else {
            const char *escape = *c == '&' ? "&amp;" : *c == '<' ? "&lt;" : *c == '>' ? "&gt;" : *c == '"' ? "&quot;" : NULL;
            if (escape != NULL) {
                put(t, escape);
            } else {
                put_bytes(t, (const char *)c, length);
            }
            c += length;
        }
    }
}

/* ---- shapes -------------------------------------------------------------------------------------------------------------- */

static void put_rings(text *t, const gnoi_rings *rings, size_t first, size_t count)
{
    for (size_t r = first; r < first + count; r++) {
        const gnoi_dot *dots = gnoi_dots(&rings->dots);
        const size_t begin = gnoi_ring_begin(rings, r), end = gnoi_ring_end(rings, r);
        for (size_t i = begin; i < end; i++) {
            put_dot(t, i == begin ? 'M' : i == begin + 1 ? 'L' : ' ', dots[i]);
        }
        put(t, "Z");
    }
}

static void put_id(text *t, const gnoi_shape *shape)
{
    put(t, "p");
    put_size(t, shape->polygon);
    put(t, "-");
    put_size(t, shape->state);
}

/* The lights that reach a shape, by name; an area light of which only some points do as NAME:HOW_MANY/OF. */
static void put_lights(text *t, const gnoi_shape *shape)
{
    const gnoi_drawing *d = t->drawing;
    gno_piece piece;
    gno_pieces_get(d->pieces, shape->piece, &piece);
    for (size_t i = 0, n; i < piece.light_count; i += n) {
        const int light = d->light_of[piece.lights[i]];
        const char *name = "";
        gno_light from;
        for (n = 1; i + n < piece.light_count && d->light_of[piece.lights[i + n]] == light; n++) {
        }
        gno_scene_light(d->scene, light, &from, &name);
        put(t, i > 0 ? " " : "");
        if (name[0] != '\0') {
            put_escaped(t, name, '_');
        } else {
            put(t, "#");
            put_size(t, (size_t)light);
        }
        if (from.type == GNO_LIGHT_AREA && n < (size_t)from.samples * (size_t)from.samples) {
            put(t, ":");
            put_size(t, n);
            put(t, "/");
            put_size(t, (size_t)from.samples * (size_t)from.samples);
        }
    }
}

static void put_name(text *t, const char *attribute, const char *name)
{
    if (name[0] == '\0') {
        return;
    }
    put(t, attribute);
    put_escaped(t, name, '\0');
    put(t, "\"");
}

static void put_shape(text *t, const gnoi_shape *shape)
{
    const gnoi_drawing *d = t->drawing;
    gno_polygon polygon;
    gno_scene_polygon(d->scene, shape->polygon, &polygon);
    put(t, "<path id=\"");
    put_id(t, shape);
    put(t, "\" fill=\"");
    put_colour(t, shape->rgb);
    put(t, "\" data-polygon=\"");
    put_size(t, shape->polygon);
    put(t, "\"");
    put_name(t, " data-object=\"", gno_scene_object_name(d->scene, polygon.object));
    put_name(t, " data-material=\"", gno_scene_material_name(d->scene, polygon.material));
    put(t, " data-lights=\"");
    put_lights(t, shape);
    put(t, "\" data-area=\"");
    put_real(t, shape->area);
    put(t, "\" d=\"");
    put_rings(t, &d->rings, shape->first_ring, shape->ring_count);
    put(t, "\"/>\n");
}

/* ---- layers --------------------------------------------------------------------------------------------------------------- */

static void put_head(text *t)
{
    const gnoi_drawing *d = t->drawing;
    const char *title = d->def->title;
    put(t, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" "
           "xmlns:xlink=\"http://www.w3.org/1999/xlink\" version=\"1.1\" width=\"");
    put_size(t, (size_t)d->width);
    put(t, "\" height=\"");
    put_size(t, (size_t)d->height);
    put(t, "\" viewBox=\"0 0 ");
    put_size(t, (size_t)d->width);
    put(t, " ");
    put_size(t, (size_t)d->height);
    put(t, "\">\n");
    if (title != NULL && title[0] != '\0') {
        put(t, "<title>");
        put_escaped(t, title, '\0');
        put(t, "</title>\n");
    }
    put(t, "<metadata>gnomon ");
    put(t, gno_version());
    put(t, "</metadata>\n");
}

static void put_underlay(text *t)
{
    const gnoi_drawing *d = t->drawing;
    put(t, "<g id=\"underlay\" stroke-linejoin=\"round\" stroke-width=\"");
    put_real(t, GNOI_UNDERLAY_RIM);
    if (!d->def->background) {
        put(t, "\" clip-path=\"url(#covered)");
    }
    put(t, "\">\n");
    for (size_t i = 0; i < d->shapes.count; i++) {
        const gnoi_shape *shape = gnoi_drawing_shape(d, i);
        put(t, "<use xlink:href=\"#");
        put_id(t, shape);
        put(t, "\" stroke=\"");
        put_colour(t, shape->rgb);
        put(t, "\"/>\n");
    }
    put(t, "</g>\n");
}

/* Without a background the underlay is kept to where shapes are: the picture less what they leave free. */
static void put_clip(text *t)
{
    const gnoi_drawing *d = t->drawing;
    const gnoi_dot corner[4] = {{0, 0}, {d->width * d->unit, 0}, {d->width * d->unit, d->height * d->unit}, {0, d->height * d->unit}};
    put(t, "<clipPath id=\"covered\"><path clip-rule=\"evenodd\" d=\"");
    for (int i = 0; i < 4; i++) {
        put_dot(t, i == 0 ? 'M' : i == 1 ? 'L' : ' ', corner[i]);
    }
    put(t, "Z");
    put_rings(t, &d->around, 0, d->around.ring_end.count);
    put(t, "\"/></clipPath>\n");
}

static void put_background(text *t)
{
    const gnoi_drawing *d = t->drawing;
    put(t, "<path id=\"background\" fill-rule=\"evenodd\" fill=\"");
    put_colour(t, d->background);
    put(t, "\" d=\"");
    put_rings(t, &d->around, 0, d->around.ring_end.count);
    put(t, "\"/>\n");
}

static void put_strokes(text *t)
{
    static const char *const kinds[] = {"none", "silhouette", "edge", "outline"};
    const gnoi_drawing *d = t->drawing;
    put(t, "<g id=\"edges\" fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\" stroke=\"");
    put_colour(t, d->edge_colour);
    put(t, "\" stroke-width=\"");
    put_real(t, d->def->edge_width);
    put(t, "\">\n");
    for (size_t i = 0; i < d->strokes.count; i++) {
        const gnoi_stroke *s = gnoi_drawing_stroke(d, i);
        const gnoi_dot *dots = gnoi_dots(&d->stroke_dots) + s->first_dot;
        put(t, "<path class=\"");
        put(t, kinds[s->kind]);
        put(t, "\" data-polygon=\"");
        put_size(t, s->polygon);
        put(t, "\" d=\"");
        for (size_t k = 0; k < s->dot_count; k++) {
            put_dot(t, k == 0 ? 'M' : k == 1 ? 'L' : ' ', dots[k]);
        }
        put(t, s->closed ? "Z\"/>\n" : "\"/>\n");
    }
    put(t, "</g>\n");
}

gno_status gnoi_vector_svg(const gnoi_drawing *d, gnoi_file *file)
{
    text *t = gno_context_realloc(d->context, NULL, 0, sizeof *t);
    if (t == NULL) {
        return gnoi_drawing_no_memory(d);
    }
    t->file = file;
    t->drawing = d;
    t->used = 0;
    put_head(t);
    if (d->def->underlay && !d->def->background) {
        put_clip(t);
    }
    if (d->def->underlay) {
        put_underlay(t);
    }
    put(t, "<g id=\"pieces\" fill-rule=\"evenodd\">\n");
    for (size_t i = 0; i < d->shapes.count && file->error == 0; i++) {
        put_shape(t, gnoi_drawing_shape(d, i));
    }
    put(t, "</g>\n");
    if (d->def->background) {
        put_background(t);
    }
    if (d->def->edges != GNO_EDGES_NONE) {
        put_strokes(t);
    }
    put(t, "</svg>\n");
    flush(t);
    gno_context_realloc(d->context, t, sizeof *t, 0);
    return GNO_OK;
}
