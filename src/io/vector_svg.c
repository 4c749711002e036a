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
#include "io/text_file.h"

#include <stdio.h>
#include <string.h>

/* A drawing on its way to the file. */
typedef struct svg {
    gnoi_text *text;
    const gnoi_drawing *drawing;
} svg;

enum { LONGEST_DOT = 64 };

static void put(svg *to, const char *string)
{
    gnoi_text_put(to->text, string);
}

static void put_size(svg *to, size_t number)
{
    gnoi_text_size(to->text, number);
}

static void put_real(svg *to, double value)
{
    gnoi_text_short(to->text, value);
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

static void put_dot(svg *to, char before, gnoi_dot dot)
{
    char piece[LONGEST_DOT], *end = piece;
    *end++ = before;
    end = format_units(end, dot.x, to->drawing->unit);
    *end++ = ' ';
    end = format_units(end, dot.y, to->drawing->unit);
    gnoi_text_bytes(to->text, piece, (size_t)(end - piece));
}

static void put_colour(svg *to, const unsigned char rgb[3])
{
    char digits[8];
    snprintf(digits, sizeof digits, "#%02x%02x%02x", rgb[0], rgb[1], rgb[2]);
    put(to, digits);
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
static void put_escaped(svg *to, const char *string, char blank)
{
    const unsigned char *c = (const unsigned char *)string;
    while (*c != '\0') {
        const size_t length = character_length(c);
        if (*c == '\t' || *c == '\n' || *c == '\r' || *c == ' ') {
            put(to, blank != '\0' ? "_" : " ");
            c++;
        } else if (length == 0) {
            put(to, "\xef\xbf\xbd");
            c++;
        } else {
            const char *escape = *c == '&' ? "&amp;" : *c == '<' ? "&lt;" : *c == '>' ? "&gt;" : *c == '"' ? "&quot;" : NULL;
            if (escape != NULL) {
                put(to, escape);
            } else {
                gnoi_text_bytes(to->text, (const char *)c, length);
            }
            c += length;
        }
    }
}

/* ---- shapes -------------------------------------------------------------------------------------------------------------- */

static void put_rings(svg *to, const gnoi_rings *rings, size_t first, size_t count)
{
    for (size_t r = first; r < first + count; r++) {
        const gnoi_dot *dots = gnoi_dots(&rings->dots);
        const size_t begin = gnoi_ring_begin(rings, r), end = gnoi_ring_end(rings, r);
        for (size_t i = begin; i < end; i++) {
            put_dot(to, i == begin ? 'M' : i == begin + 1 ? 'L' : ' ', dots[i]);
        }
        put(to, "Z");
    }
}

static void put_id(svg *to, const gnoi_shape *shape)
{
    put(to, "p");
    put_size(to, shape->polygon);
    put(to, "-");
    put_size(to, shape->state);
}

/* The lights that reach a shape, by name; an area light of which only some points do as NAME:HOW_MANY/OF. */
static void put_lights(svg *to, const gnoi_shape *shape)
{
    const gnoi_drawing *d = to->drawing;
    gno_piece piece;
    gno_pieces_get(d->pieces, shape->piece, &piece);
    for (size_t i = 0, n; i < piece.light_count; i += n) {
        const int light = d->light_of[piece.lights[i]];
        const char *name = "";
        gno_light from;
        for (n = 1; i + n < piece.light_count && d->light_of[piece.lights[i + n]] == light; n++) {
        }
        gno_scene_light(d->scene, light, &from, &name);
        put(to, i > 0 ? " " : "");
        if (name[0] != '\0') {
            put_escaped(to, name, '_');
        } else {
            put(to, "#");
            put_size(to, (size_t)light);
        }
        if (from.type == GNO_LIGHT_AREA && n < (size_t)from.samples * (size_t)from.samples) {
            put(to, ":");
            put_size(to, n);
            put(to, "/");
            put_size(to, (size_t)from.samples * (size_t)from.samples);
        }
    }
}

static void put_name(svg *to, const char *attribute, const char *name)
{
    if (name[0] == '\0') {
        return;
    }
    put(to, attribute);
    put_escaped(to, name, '\0');
    put(to, "\"");
}

static void put_shape(svg *to, const gnoi_shape *shape)
{
    const gnoi_drawing *d = to->drawing;
    gno_polygon polygon;
    gno_scene_polygon(d->scene, shape->polygon, &polygon);
    put(to, "<path id=\"");
    put_id(to, shape);
    put(to, "\" fill=\"");
    put_colour(to, shape->rgb);
    put(to, "\" data-polygon=\"");
    put_size(to, shape->polygon);
    put(to, "\"");
    put_name(to, " data-object=\"", gno_scene_object_name(d->scene, polygon.object));
    put_name(to, " data-material=\"", gno_scene_material_name(d->scene, polygon.material));
    put(to, " data-lights=\"");
    put_lights(to, shape);
    put(to, "\" data-area=\"");
    put_real(to, shape->area);
    put(to, "\" d=\"");
    put_rings(to, &d->rings, shape->first_ring, shape->ring_count);
    put(to, "\"/>\n");
}

/* ---- layers --------------------------------------------------------------------------------------------------------------- */

static void put_head(svg *to)
{
    const gnoi_drawing *d = to->drawing;
    const char *title = d->def->title;
    put(to, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" "
           "xmlns:xlink=\"http://www.w3.org/1999/xlink\" version=\"1.1\" width=\"");
    put_size(to, (size_t)d->width);
    put(to, "\" height=\"");
    put_size(to, (size_t)d->height);
    put(to, "\" viewBox=\"0 0 ");
    put_size(to, (size_t)d->width);
    put(to, " ");
    put_size(to, (size_t)d->height);
    put(to, "\">\n");
    if (title != NULL && title[0] != '\0') {
        put(to, "<title>");
        put_escaped(to, title, '\0');
        put(to, "</title>\n");
    }
    put(to, "<metadata>gnomon ");
    put(to, gno_version());
    put(to, "</metadata>\n");
}

static void put_underlay(svg *to)
{
    const gnoi_drawing *d = to->drawing;
    put(to, "<g id=\"underlay\" stroke-linejoin=\"round\" stroke-width=\"");
    put_real(to, GNOI_UNDERLAY_RIM);
    if (!d->def->background) {
        put(to, "\" clip-path=\"url(#covered)");
    }
    put(to, "\">\n");
    for (size_t i = 0; i < d->shapes.count; i++) {
        const gnoi_shape *shape = gnoi_drawing_shape(d, i);
        put(to, "<use xlink:href=\"#");
        put_id(to, shape);
        put(to, "\" stroke=\"");
        put_colour(to, shape->rgb);
        put(to, "\"/>\n");
    }
    put(to, "</g>\n");
}

/* Without a background the underlay is kept to where shapes are: the picture less what they leave free. */
static void put_clip(svg *to)
{
    const gnoi_drawing *d = to->drawing;
    const gnoi_dot corner[4] = {{0, 0}, {d->width * d->unit, 0}, {d->width * d->unit, d->height * d->unit}, {0, d->height * d->unit}};
    put(to, "<clipPath id=\"covered\"><path clip-rule=\"evenodd\" d=\"");
    for (int i = 0; i < 4; i++) {
        put_dot(to, i == 0 ? 'M' : i == 1 ? 'L' : ' ', corner[i]);
    }
    put(to, "Z");
    put_rings(to, &d->around, 0, d->around.ring_end.count);
    put(to, "\"/></clipPath>\n");
}

static void put_background(svg *to)
{
    const gnoi_drawing *d = to->drawing;
    put(to, "<path id=\"background\" fill-rule=\"evenodd\" fill=\"");
    put_colour(to, d->background);
    put(to, "\" d=\"");
    put_rings(to, &d->around, 0, d->around.ring_end.count);
    put(to, "\"/>\n");
}

static void put_strokes(svg *to)
{
    static const char *const kinds[] = {"none", "silhouette", "edge", "outline"};
    const gnoi_drawing *d = to->drawing;
    put(to, "<g id=\"edges\" fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\" stroke=\"");
    put_colour(to, d->edge_colour);
    put(to, "\" stroke-width=\"");
    put_real(to, d->def->edge_width);
    put(to, "\">\n");
    for (size_t i = 0; i < d->strokes.count; i++) {
        const gnoi_stroke *s = gnoi_drawing_stroke(d, i);
        const gnoi_dot *dots = gnoi_dots(&d->stroke_dots) + s->first_dot;
        put(to, "<path class=\"");
        put(to, kinds[s->kind]);
        put(to, "\" data-polygon=\"");
        put_size(to, s->polygon);
        put(to, "\" d=\"");
        for (size_t k = 0; k < s->dot_count; k++) {
            put_dot(to, k == 0 ? 'M' : k == 1 ? 'L' : ' ', dots[k]);
        }
        put(to, s->closed ? "Z\"/>\n" : "\"/>\n");
    }
    put(to, "</g>\n");
}

gno_status gnoi_vector_svg(const gnoi_drawing *d, gnoi_file *file)
{
    svg whole, *to = &whole;
    whole.text = gnoi_text_begin(file);
    whole.drawing = d;
    if (whole.text == NULL) {
        return gnoi_drawing_no_memory(d);
    }
    put_head(to);
    if (d->def->underlay && !d->def->background) {
        put_clip(to);
    }
    if (d->def->underlay) {
        put_underlay(to);
    }
    put(to, "<g id=\"pieces\" fill-rule=\"evenodd\">\n");
    for (size_t i = 0; i < d->shapes.count && file->error == 0; i++) {
        put_shape(to, gnoi_drawing_shape(d, i));
    }
    put(to, "</g>\n");
    if (d->def->background) {
        put_background(to);
    }
    if (d->def->edges != GNO_EDGES_NONE) {
        put_strokes(to);
    }
    put(to, "</svg>\n");
    gnoi_text_end(to->text);
    return GNO_OK;
}
