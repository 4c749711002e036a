/* lit_table.c -- gno_lit_table_write: lit areas as CSV.
 *
 * Place: rows of gno_lit_pieces -> here -> text_file -> disk. RFC 4180, with line feeds; numbers as %.15g.
 */
#include "io/lit_files.h"

#include <gnomon/gnomon_io.h>
#include <string.h>

/* Quoted where it has to be; quotes doubled. */
static void put_field(gnoi_text *text, const char *field)
{
    if (field == NULL) {
        return;
    }
    if (strpbrk(field, ",\"\r\n") == NULL) {
        gnoi_text_put(text, field);
        return;
    }
    gnoi_text_char(text, '"');
    for (; *field != '\0'; field++) {
        if (*field == '"') {
            gnoi_text_char(text, '"');
        }
        gnoi_text_char(text, *field);
    }
    gnoi_text_char(text, '"');
}

static void put_row(gnoi_text *text, size_t polygon, const char *object, const char *light, long long sample, const gno_lit_row *row)
{
    const double values[] = {row->area, row->lit_area, row->fraction, row->dimmed_area, row->centroid[0], row->centroid[1], row->centroid[2]};
    gnoi_text_integer(text, (long long)polygon);
    gnoi_text_char(text, ',');
    put_field(text, object);
    gnoi_text_char(text, ',');
    put_field(text, light);
    gnoi_text_char(text, ',');
    gnoi_text_integer(text, sample);
    gnoi_text_char(text, ',');
    gnoi_text_integer(text, row->side);
    for (size_t i = 0; i < sizeof values / sizeof values[0]; i++) {
        gnoi_text_char(text, ',');
        if (i < 4 || row->lit_area > 0) { /* no centroid of nothing */
            gnoi_text_number(text, values[i]);
        }
    }
    gnoi_text_char(text, '\n');
}

gno_status gnoi_light_name(const gno_scene *scene, size_t expanded, const char **name, long long *sample)
{
    gno_light light;
    int source, before;
    gno_status status = gno_expanded_light(scene, expanded, &light, &source);
    for (*sample = 0; status == GNO_OK && expanded > 0; (*sample)++) {
        status = gno_expanded_light(scene, --expanded, &light, &before);
        if (before != source) {
            break;
        }
    }
    return status == GNO_OK ? gno_scene_light(scene, source, &light, name) : status;
}

gno_status gno_lit_table_write(const gno_scene *scene, const char *path, const gno_lit_result *results, size_t count)
{
    gnoi_text *text;
    gno_status status;
    const size_t polygons = scene != NULL ? gno_scene_count(scene).polygons : 0;
    if (scene == NULL || path == NULL || (results == NULL && count > 0)) {
        return GNO_ERROR_ARGUMENT;
    }
    status = gnoi_text_open(gno_scene_context(scene), path, &text);
    if (status != GNO_OK) {
        return status;
    }
    gnoi_text_put(text, "polygon,object,light,sample,side,area,lit_area,lit_fraction,dimmed_area,centroid_x,centroid_y,centroid_z\n");
    for (size_t i = 0; i < count && status == GNO_OK; i++) {
        const char *light = NULL;
        long long sample = 0;
        status = gnoi_light_name(scene, results[i].light, &light, &sample);
        for (size_t p = 0; p < polygons && status == GNO_OK; p++) {
            gno_polygon polygon;
            status = gno_scene_polygon(scene, p, &polygon);
            if (status == GNO_OK) {
                put_row(text, p, gno_scene_object_name(scene, polygon.object), light, sample, &results[i].rows[p]);
            }
        }
    }
    return gnoi_text_close(text, status);
}
