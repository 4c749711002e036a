/* pieces_file.c -- gno_pieces_write: pieces as geometry, by the file's extension.
 *
 * Place: sets of gno_lit_pieces -> here -> pieces_obj.c or pieces_geojson.c -> text_file -> disk.
 */
#include "io/file_name.h"
#include "io/lit_files.h"

#include <string.h>

static const gnoi_pieces_format formats[] = {
    {".obj", gnoi_obj_begin, gnoi_obj_put, NULL},
    {".geojson", gnoi_geojson_begin, gnoi_geojson_put, gnoi_geojson_end},
    {".json", gnoi_geojson_begin, gnoi_geojson_put, gnoi_geojson_end},
};

static const gnoi_pieces_format *find_format(const char *path)
{
    for (size_t i = 0; i < sizeof formats / sizeof formats[0]; i++) {
        if (gnoi_has_extension(path, formats[i].extension)) {
            return &formats[i];
        }
    }
    return NULL;
}

static gno_status put_all(gnoi_text *text, const gnoi_pieces_format *format, const gno_scene *scene, const gno_lit_result *result, int *first,
                          void *state)
{
    gnoi_named_piece named;
    gno_status status = gnoi_light_name(scene, result->light, &named.light, &named.sample);
    for (size_t i = 0; i < gno_pieces_count(result->pieces) && status == GNO_OK; i++) {
        gno_polygon polygon;
        status = gno_pieces_get(result->pieces, i, &named.piece);
        if (status == GNO_OK) {
            status = gno_scene_polygon(scene, named.piece.polygon, &polygon);
        }
        if (status == GNO_OK) {
            named.object = gno_scene_object_name(scene, polygon.object);
            status = format->put(text, &named, *first, state);
            *first = 0;
        }
    }
    return status;
}

gno_status gno_pieces_write(const gno_scene *scene, const char *path, const gno_lit_result *results, size_t count)
{
    const gnoi_pieces_format *format;
    gnoi_obj_state state;
    gnoi_text *text = NULL;
    gno_status status;
    int first = 1;
    if (scene == NULL || path == NULL || (results == NULL && count > 0)) {
        return GNO_ERROR_ARGUMENT;
    }
    memset(&state, 0, sizeof state);
    state.context = gno_scene_context(scene);
    format = find_format(path);
    if (format == NULL) {
        return gno_context_fail(state.context, GNO_ERROR_ARGUMENT, "pieces: the extension is not one of .obj, .geojson, .json");
    }
    status = gno_clipper_create(state.context, &state.clipper);
    if (status == GNO_OK) {
        status = gnoi_text_open(state.context, path, &text);
    }
    if (status != GNO_OK) {
        gno_clipper_destroy(state.clipper);
        return status;
    }
    if (format->begin != NULL) {
        format->begin(text);
    }
    for (size_t i = 0; i < count && status == GNO_OK; i++) {
        status = put_all(text, format, scene, &results[i], &first, &state);
    }
    if (format->end != NULL) {
        format->end(text);
    }
    gno_clipper_destroy(state.clipper);
    return gnoi_text_close(text, status);
}
