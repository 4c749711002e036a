/* pieces_geojson.c -- pieces as GeoJSON (RFC 7946), in the scene's own coordinates: see lit_files.h. */
#include "io/lit_files.h"

#include <stdio.h>

static void put_string(gnoi_text *text, const char *string)
{
    char escaped[GNOI_JSON_LONGEST];
    gnoi_text_char(text, '"');
    for (const char *c = string != NULL ? string : ""; *c != '\0'; c++) {
        gnoi_text_bytes(text, escaped, gnoi_json_byte(*c, escaped));
    }
    gnoi_text_char(text, '"');
}

static void put_point(gnoi_text *text, const double *p)
{
    gnoi_text_char(text, '[');
    for (int k = 0; k < 3; k++) {
        if (k > 0) {
            gnoi_text_char(text, ',');
        }
        gnoi_text_exact(text, p[k]);
    }
    gnoi_text_char(text, ']');
}

static void put_ring(gnoi_text *text, const gno_piece *piece, size_t ring)
{
    const size_t first = piece->ring_start[ring], end = piece->ring_start[ring + 1];
    gnoi_text_char(text, '[');
    for (size_t i = first; i <= end; i++) {
        if (i > first) {
            gnoi_text_char(text, ',');
        }
        put_point(text, piece->points + 3 * (i < end ? i : first)); /* the first point again at the end, as the format wants it */
    }
    gnoi_text_char(text, ']');
}

void gnoi_geojson_begin(gnoi_text *text)
{
    gnoi_text_put(text, "{\"type\":\"FeatureCollection\",\"features\":[");
}

gno_status gnoi_geojson_put(gnoi_text *text, const gnoi_named_piece *named, int first, void *state)
{
    const gno_piece *piece = &named->piece;
    (void)state;
    gnoi_text_put(text, first ? "\n" : ",\n");
    gnoi_text_put(text, "{\"type\":\"Feature\",\"properties\":{\"polygon\":");
    gnoi_text_integer(text, (long long)piece->polygon);
    gnoi_text_put(text, ",\"object\":");
    put_string(text, named->object);
    gnoi_text_put(text, ",\"light\":");
    put_string(text, named->light);
    gnoi_text_put(text, ",\"sample\":");
    gnoi_text_integer(text, named->sample);
    gnoi_text_put(text, ",\"side\":");
    gnoi_text_integer(text, piece->side);
    gnoi_text_put(text, ",\"area\":");
    gnoi_text_exact(text, piece->area);
    gnoi_text_put(text, ",\"passed\":");
    put_point(text, piece->passed);
    gnoi_text_put(text, "},\"geometry\":{\"type\":\"Polygon\",\"coordinates\":[");
    for (size_t r = 0; r < piece->ring_count; r++) {
        if (r > 0) {
            gnoi_text_char(text, ',');
        }
        put_ring(text, piece, r);
    }
    gnoi_text_put(text, "]}}");
    return GNO_OK;
}

void gnoi_geojson_end(gnoi_text *text)
{
    gnoi_text_put(text, "\n]}\n");
}
