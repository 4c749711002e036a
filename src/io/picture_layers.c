/* picture_layers.c -- gno_picture_write_layers: a scene's layers as named channels and entries of an EXR file.
 *
 * Place: gno_layers + names of the scene's lights and objects -> channels, Cryptomatte ids and manifests -> picture.c. A set of
 * ranked pairs is written as the Cryptomatte specification says: channels SETnn.R .G .B .A hold id and coverage of ranks 2 nn and
 * 2 nn + 1 (B and A are missing after an odd last rank), and the head tells what made the ids and which names they are of.
 */
#include "io/cryptomatte.h"
#include "io/picture.h"

#include <gnomon/gnomon_io.h>
#include <stdio.h>
#include <string.h>

enum { SETS = 3, NOTES_OF_SET = 4, NAME = 200 };

typedef struct set {
    const char *name;
    const gno_ranks *ranks;
    size_t count;        /* of numbers: polygons, objects, materials */
    float *ids;          /* by number */
    unsigned char *seen; /* by number: in the picture */
    gnoi_manifest manifest;
} set;

typedef struct writer {
    const gno_scene *scene;
    gno_context *context;
    const gno_layers *layers;
    int width, height;
    size_t lights;
    set sets[SETS];
    size_t channel_count, channel_capacity, note_count;
    gnoi_channel *channels;
    gnoi_note notes[SETS * NOTES_OF_SET];
} writer;

/* ---- names --------------------------------------------------------------------------------------------------------- */

/* What a channel may be called: a dot would make another layer of it. */
static void legal_name(char *out, size_t size, const char *name)
{
    size_t n = 0;
    for (; *name != '\0' && n + 1 < size; name++) {
        const unsigned char c = (unsigned char)*name;
        const int letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c >= 128;
        out[n++] = letter || c == '-' ? (char)c : '_';
    }
    out[n] = '\0';
}

static int is_taken(const writer *w, const char *name)
{
    for (size_t i = 0; i < w->channel_count; i++) {
        if (strcmp(w->channels[i].name, name) == 0) {
            return 1;
        }
    }
    return 0;
}

static void light_channel(const writer *w, size_t light, char *out, size_t size)
{
    const char *name = NULL;
    char legal[NAME];
    gno_scene_light(w->scene, (int)light, NULL, &name);
    legal_name(legal, sizeof legal, name != NULL ? name : "");
    if (legal[0] == '\0') {
        snprintf(legal, sizeof legal, "light%zu", light);
    }
    snprintf(out, size, "shadow.%s", legal);
    for (size_t n = light; is_taken(w, out) && n < light + GNO_MAX_LIGHTS; n++) {
        snprintf(out, size, "shadow.%s_%zu", legal, n);
    }
}

/* The name that stands for a number in its set: its own, or else the number. What shares a name shares a matte. */
static const char *number_name(const writer *w, const set *s, size_t number, char *text, size_t size)
{
    const char *name = "";
    if (s->ranks == &w->layers->objects) {
        name = gno_scene_object_name(w->scene, (int)number);
    } else if (s->ranks == &w->layers->materials) {
        name = gno_scene_material_name(w->scene, (int)number);
    }
    if (name[0] != '\0') {
        return name;
    }
    snprintf(text, size, "%zu", number);
    return text;
}

/* ---- channels ------------------------------------------------------------------------------------------------------ */

/* Room for all has been made. */
static gnoi_channel *add_channel(writer *w, const char *name, const void *values, size_t step)
{
    gnoi_channel *c = &w->channels[w->channel_count++];
    memset(c, 0, sizeof *c);
    snprintf(c->name, sizeof c->name, "%s", name);
    c->values = values;
    c->step = step;
    return c;
}

static void add_vector(writer *w, const char *layer, const char *letters, const float *values)
{
    const size_t n = strlen(letters);
    char name[64];
    for (size_t i = 0; i < n && values != NULL; i++) {
        snprintf(name, sizeof name, "%s.%c", layer, letters[i]);
        add_channel(w, name, values + i, n);
    }
}

static void add_shadows(writer *w)
{
    const size_t plane = (size_t)w->width * (size_t)w->height;
    char name[sizeof w->channels->name];
    for (size_t i = 0; i < w->lights && w->layers->shadow != NULL; i++) {
        light_channel(w, i, name, sizeof name);
        add_channel(w, name, w->layers->shadow + i * plane, 1);
    }
}

static void add_ranks(writer *w, const set *s)
{
    static const char letters[] = "RGBA";
    const size_t count = (size_t)s->ranks->count;
    char name[64];
    for (size_t rank = 0; rank < count; rank++) {
        snprintf(name, sizeof name, "%s%02zu.%c", s->name, rank / 2, letters[rank % 2 * 2]);
        add_channel(w, name, s->ranks->id + rank, count)->table = s->ids;
        snprintf(name, sizeof name, "%s%02zu.%c", s->name, rank / 2, letters[rank % 2 * 2 + 1]);
        add_channel(w, name, s->ranks->coverage + rank, count);
    }
}

static void add_note(writer *w, const char *key, const char *what, const char *text)
{
    gnoi_note *note = &w->notes[w->note_count++];
    snprintf(note->name, sizeof note->name, "cryptomatte/%s/%s", key, what);
    note->text = text;
}

static void add_notes(writer *w, const set *s)
{
    char key[16];
    snprintf(key, sizeof key, "%08lx", (unsigned long)gnoi_crypto_id(s->name));
    key[7] = '\0';
    add_note(w, key, "name", s->name);
    add_note(w, key, "hash", "MurmurHash3_32");
    add_note(w, key, "conversion", "uint32_to_float32");
    add_note(w, key, "manifest", s->manifest.text);
}

/* ---- sets of ranked pairs ------------------------------------------------------------------------------------------ */

/* Marks the numbers in the picture; 0 when one is out of range. */
static int mark_seen(const writer *w, set *s)
{
    const size_t values = (size_t)w->width * (size_t)w->height * (size_t)s->ranks->count;
    for (size_t i = 0; i < values; i++) {
        const unsigned id = s->ranks->id[i];
        if (id != GNO_BACKGROUND && id >= s->count) {
            return 0;
        }
        if (id != GNO_BACKGROUND) {
            s->seen[id] = 1;
        }
    }
    return 1;
}

static gno_status make_set(writer *w, set *s)
{
    char text[32];
    gnoi_manifest_begin(&s->manifest, w->context);
    s->ids = gno_context_realloc(w->context, NULL, 0, (s->count + 1) * sizeof *s->ids);
    s->seen = gno_context_realloc(w->context, NULL, 0, s->count + 1);
    if (s->ids == NULL || s->seen == NULL) {
        return GNO_ERROR_MEMORY;
    }
    memset(s->seen, 0, s->count + 1);
    if (!mark_seen(w, s)) {
        return gno_context_fail(w->context, GNO_ERROR_ARGUMENT, "gno_picture_write_layers: the layers are not of this scene");
    }
    for (size_t i = 0; i < s->count; i++) {
        if (s->seen[i]) {
            const char *name = number_name(w, s, i, text, sizeof text);
            const uint32_t id = gnoi_crypto_id(name);
            s->ids[i] = gnoi_crypto_float(id);
            gnoi_manifest_add(&s->manifest, name, id);
        }
    }
    return gnoi_manifest_end(&s->manifest) ? GNO_OK : GNO_ERROR_MEMORY;
}

static void free_set(writer *w, set *s)
{
    if (s->ids != NULL) {
        gno_context_realloc(w->context, s->ids, (s->count + 1) * sizeof *s->ids, 0);
    }
    if (s->seen != NULL) {
        gno_context_realloc(w->context, s->seen, s->count + 1, 0);
    }
    gnoi_manifest_free(&s->manifest);
}

static void list_sets(writer *w)
{
    const gno_scene_counts counts = gno_scene_count(w->scene);
    w->lights = counts.lights;
    w->sets[0].name = "CryptoPolygon";
    w->sets[0].ranks = &w->layers->polygons;
    w->sets[0].count = counts.polygons;
    w->sets[1].name = "CryptoObject";
    w->sets[1].ranks = &w->layers->objects;
    w->sets[1].count = counts.objects;
    w->sets[2].name = "CryptoMaterial";
    w->sets[2].ranks = &w->layers->materials;
    w->sets[2].count = counts.materials;
}

/* ---- the file ------------------------------------------------------------------------------------------------------ */

static gno_status fill(writer *w)
{
    const gno_layers *l = w->layers;
    gno_status status = GNO_OK;
    w->channel_capacity = 8 + w->lights;
    for (int i = 0; i < SETS; i++) {
        w->channel_capacity += w->sets[i].ranks->id != NULL ? 2 * (size_t)w->sets[i].ranks->count : 0;
    }
    w->channels = gno_context_realloc(w->context, NULL, 0, w->channel_capacity * sizeof *w->channels);
    if (w->channels == NULL) {
        return GNO_ERROR_MEMORY;
    }
    add_vector(w, "depth", "Z", l->depth);
    add_vector(w, "normal", "XYZ", l->normal);
    add_vector(w, "uv", "UV", l->uv);
    add_vector(w, "coverage", "A", l->coverage);
    add_shadows(w);
    if (l->polygons.id != NULL) {
        add_channel(w, "polygon.id", l->polygons.id, (size_t)l->polygons.count)->is_number = 1;
    }
    for (int i = 0; i < SETS && status == GNO_OK; i++) {
        if (w->sets[i].ranks->id != NULL) {
            status = make_set(w, &w->sets[i]);
            if (status == GNO_OK) {
                add_ranks(w, &w->sets[i]);
                add_notes(w, &w->sets[i]);
            }
        }
    }
    return status;
}

gno_status gno_picture_write_layers(const gno_scene *scene, const char *path, const gno_picture_def *def, const float *rgb,
                                    const gno_layers *layers)
{
    gno_context *context = gno_scene_context(scene);
    const gno_image_def image = gno_scene_image(scene);
    gnoi_picture picture;
    writer w;
    if (context == NULL) {
        return GNO_ERROR_ARGUMENT;
    }
    if (path == NULL || rgb == NULL || layers == NULL) {
        return gno_context_fail(context, GNO_ERROR_ARGUMENT, "gno_picture_write_layers: path, rgb and layers must be given");
    }
    memset(&w, 0, sizeof w);
    w.scene = scene;
    w.context = context;
    w.layers = layers;
    w.width = image.width;
    w.height = image.height;
    list_sets(&w);
    gno_status status = fill(&w);
    if (status == GNO_ERROR_MEMORY) {
        gno_context_fail(context, status, "out of memory for writing layers");
    }
    if (status == GNO_OK) {
        memset(&picture, 0, sizeof picture);
        picture.rgb = rgb;
        picture.width = image.width;
        picture.height = image.height;
        picture.channels = w.channels;
        picture.channel_count = w.channel_count;
        picture.notes = w.notes;
        picture.note_count = w.note_count;
        status = gnoi_picture_write(context, path, def, &picture);
    }
    for (int i = 0; i < SETS; i++) {
        free_set(&w, &w.sets[i]);
    }
    if (w.channels != NULL) {
        gno_context_realloc(context, w.channels, w.channel_capacity * sizeof *w.channels, 0);
    }
    return status;
}
