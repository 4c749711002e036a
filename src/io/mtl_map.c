/* mtl_map.c -- see mtl_map.h. */
#include "mtl_map.h"
#include "obj_parse.h"
#include <math.h>
#include <string.h>

/* How far white stands over black for -bm 1, as a share of the pattern: MTL leaves it open, and the pictures in use are mostly
 * the colours themselves, photographs of walls and floors some metres wide. */
#define HEIGHT 0.01

typedef struct option {
    const char *word;
    int least, most; /* values: numbers beyond `least` are optional */
    int is_number;
} option;

static const option options[] = {
    {"-s", 1, 3, 1},      {"-o", 1, 3, 1},     {"-t", 1, 3, 1},      {"-bm", 1, 1, 1},     {"-mm", 2, 2, 1},
    {"-boost", 1, 1, 1},  {"-texres", 1, 1, 0}, {"-clamp", 1, 1, 0}, {"-blendu", 1, 1, 0}, {"-blendv", 1, 1, 0},
    {"-cc", 1, 1, 0},     {"-imfchan", 1, 1, 0}, {"-type", 1, 1, 0},
};

static int is_word(const char *p, const char *end, const char *word)
{
    for (; p < end && *word; p++, word++) {
        char c = *p >= 'A' && *p <= 'Z' ? (char)(*p - 'A' + 'a') : *p;
        if (c != *word) return 0;
    }
    return p == end && !*word;
}

int gnoi_mtl_map_use(const char *p, const char *end)
{
    static const struct {
        const char *word;
        gnoi_mtl_use use;
    } words[] = {{"map_kd", GNOI_MTL_COLOUR}, {"map_d", GNOI_MTL_ALPHA}, {"map_bump", GNOI_MTL_BUMP}, {"bump", GNOI_MTL_BUMP},
                 {"norm", GNOI_MTL_NORMAL}};
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        if (is_word(p, end, words[i].word)) return (int)words[i].use;
    return -1;
}

static void set_option(gnoi_mtl_map *map, const option *o, const char *first, const char *first_end, const double *values, int count)
{
    for (int i = 0; i < 2 && i < count && o->word[1] == 's'; i++) map->scale[i] = values[i] != 0 ? values[i] : 1;
    for (int i = 0; i < 2 && i < count && strcmp(o->word, "-o") == 0; i++) map->offset[i] = values[i];
    if (strcmp(o->word, "-bm") == 0) map->multiplier = values[0];
    if (strcmp(o->word, "-clamp") == 0) map->clamp = is_word(first, first_end, "on");
}

/* Reads an option's values from p; returns where they end. */
static const char *read_option(gnoi_mtl_map *map, const option *o, const char *p, size_t *line)
{
    double values[3] = {0, 0, 0};
    const char *first = gnoi_parse_blank(p, line), *first_end = gnoi_parse_word(first);
    int count = 0;
    for (; count < o->most; count++) {
        const char *word = gnoi_parse_blank(p, line), *end = gnoi_parse_word(word);
        if (gnoi_parse_at_end(word)) break;
        if (o->is_number) {
            const char *number_end = gnoi_parse_number(word, &values[count]);
            int good = number_end == end && end > word && isfinite(values[count]);
            if (!good && count >= o->least) break;
            if (!good) values[count] = 0;
        }
        p = end;
    }
    set_option(map, o, first, first_end, values, count);
    return p;
}

gno_status gnoi_mtl_map_read(gno_context *context, const char *path, size_t line, const char *p, gnoi_mtl_map *map)
{
    size_t count = sizeof options / sizeof options[0], used = line;
    gnoi_mtl_map_free(context, map);
    memset(map, 0, sizeof *map);
    map->scale[0] = map->scale[1] = map->multiplier = 1;
    map->line = line;
    for (;;) {
        size_t i = 0;
        p = gnoi_parse_blank(p, &used);
        const char *end = gnoi_parse_word(p);
        while (i < count && !is_word(p, end, options[i].word)) i++;
        if (i == count) break;
        p = read_option(map, &options[i], end, &used);
    }
    const char *end = gnoi_parse_text_end(p);
    if (end == p) {
        gnoi_mesh_warn(context, path, line, "a picture's name is missing");
        return GNO_OK;
    }
    map->name_size = (size_t)(end - p) + 1;
    map->name = gno_context_realloc(context, NULL, 0, map->name_size);
    if (!map->name) return gnoi_mesh_no_memory(context, path);
    memcpy(map->name, p, map->name_size - 1);
    map->name[map->name_size - 1] = '\0';
    return GNO_OK;
}

void gnoi_mtl_map_free(gno_context *context, gnoi_mtl_map *map)
{
    if (map->name) gno_context_realloc(context, map->name, map->name_size, 0);
    map->name = NULL;
}

/* ---- into the material ---------------------------------------------------------------------------------------------------- */

/* Texture coordinate times scale plus offset is the place on the pattern. */
static void set_place(const gnoi_mtl_map *map, gno_texture *texture)
{
    for (int k = 0; k < 2; k++) {
        texture->corners[0][k] = -map->offset[k] / map->scale[k];
        texture->corners[1][k] = (1 - map->offset[k]) / map->scale[k];
    }
    texture->wrap = map->clamp ? GNO_WRAP_CLAMP : GNO_WRAP_REPEAT;
}

/* texture->kind stays none where there is no picture. */
static gno_status get_picture(gnoi_textures *textures, const char *path, const gnoi_mtl_map *map, const gnoi_mtl_map *mask, int is_colour,
                              gno_texture *texture)
{
    char reason[GNOI_TEXTURE_REASON];
    gnoi_texture_request request;
    int image;
    memset(&request, 0, sizeof request);
    request.beside = path;
    request.name = map->name;
    request.mask = mask ? mask->name : NULL;
    request.is_colour = is_colour;
    gno_status status = gnoi_textures_get(textures, &request, &image, reason);
    if (status != GNO_OK) return status;
    if (reason[0])
        gnoi_mesh_warn(gno_scene_context(textures->scene), path, map->name ? map->line : mask->line, "%s: drawn without it", reason);
    if (image < 0) return GNO_OK;
    texture->kind = GNO_TEXTURE_IMAGE;
    texture->image = image;
    set_place(map->name ? map : mask, texture);
    return GNO_OK;
}

gno_status gnoi_mtl_maps_apply(gnoi_textures *textures, const char *path, const gnoi_mtl_map maps[GNOI_MTL_USES], gno_material *material)
{
    const gnoi_mtl_map *colour = &maps[GNOI_MTL_COLOUR], *alpha = &maps[GNOI_MTL_ALPHA];
    const gnoi_mtl_map *bump = maps[GNOI_MTL_NORMAL].name ? &maps[GNOI_MTL_NORMAL] : &maps[GNOI_MTL_BUMP];
    int is_normal = bump == &maps[GNOI_MTL_NORMAL];
    gno_status status = GNO_OK;
    if (colour->name || alpha->name) {
        status = get_picture(textures, path, colour, alpha->name ? alpha : NULL, 1, &material->texture);
        if (status == GNO_OK && material->texture.kind == GNO_TEXTURE_NONE && colour->name && alpha->name)
            status = get_picture(textures, path, colour, NULL, 1, &material->texture);
    }
    if (status != GNO_OK || !bump->name) return status;
    status = get_picture(textures, path, bump, NULL, 0, &material->bump.texture);
    if (material->bump.texture.kind == GNO_TEXTURE_NONE) return status;
    material->bump.kind = is_normal ? GNO_BUMP_NORMAL : GNO_BUMP_HEIGHT;
    material->bump.amount = bump->multiplier * (is_normal ? 1 : HEIGHT);
    return status;
}
