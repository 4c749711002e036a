/* weld.c -- tells the points of an object apart by exact position.
 *
 * Place in the data flow: prepared polygons -> here -> normals.c. Files repeat a vertex along seams of texture and of normals;
 * averaging must see one point there.
 * Invariants: classes are numbered in the order of corners, so they are the same on every run; the table is never more
 * than half full, so that every search ends.
 * Source: open addressing with linear steps; the mixing constants are those of MurmurHash3's finalizer.
 */
#include "scene/weld.h"
#include "scene/prepare.h"

#include <string.h>

static uint64_t hash_position(const double p[3])
{
    uint64_t hash = 0x9e3779b97f4a7c15u, bits;
    int i;
    for (i = 0; i < 3; i++) {
        double x = p[i] + 0.0; /* the negative zero becomes the positive one */
        memcpy(&bits, &x, sizeof bits);
        hash = (hash ^ bits) * 0xff51afd7ed558ccdu;
        hash ^= hash >> 32;
    }
    return hash;
}

/* The class at a vertex's place; a new one if `make`, else GNOI_WELD_NOWHERE where there is none. */
static uint32_t find_class(gnoi_weld *w, const double (*positions)[3], uint32_t vertex, int make)
{
    const double *p = positions[vertex];
    size_t slot = (size_t)hash_position(p) & (w->table_size - 1);
    while (w->table[slot] != GNOI_NONE) {
        const double *q = positions[w->table[slot]];
        if (p[0] == q[0] && p[1] == q[1] && p[2] == q[2]) {
            return gnoi_weld_class(w, w->table[slot]);
        }
        slot = (slot + 1) & (w->table_size - 1);
    }
    if (!make) {
        return GNOI_WELD_NOWHERE;
    }
    w->table[slot] = vertex;
    return w->count++;
}

static void set_range(const gnoi_prepared *prepared, size_t first, size_t last, gnoi_weld *w)
{
    uint32_t low = GNOI_NONE, high = 0;
    size_t i, k;
    for (i = first; i < last; i++) {
        const gnoi_poly *poly = &prepared->polys[i];
        for (k = 0; gnoi_is_smooth(poly) && k < poly->corner_count; k++) {
            uint32_t v = prepared->corner_vertex[poly->corner + k];
            low = v < low ? v : low;
            high = v > high ? v : high;
        }
    }
    w->low = low;
    w->span = (size_t)(high - low) + 1;
}

/* First the places of open corners get classes, then the other corners there find them. 0 when stopped. */
static int set_classes(const gno_scene *scene, size_t first, size_t last, int make, gnoi_weld *w)
{
    const double(*positions)[3] = (const double(*)[3])scene->positions;
    const gnoi_prepared *prepared = &scene->prepared;
    size_t i, k;
    for (i = first; i < last; i++) {
        const gnoi_poly *poly = &prepared->polys[i];
        for (k = 0; gnoi_is_smooth(poly) && k < poly->corner_count; k++) {
            uint32_t v = prepared->corner_vertex[poly->corner + k];
            if ((!make || prepared->corner_normal[poly->corner + k] == GNOI_NONE) && gnoi_weld_class(w, v) == GNOI_NONE) {
                w->class_of[v - w->low] = find_class(w, positions, v, make);
            }
        }
        if (gnoi_stopped_at(scene->context, i)) {
            return 0;
        }
    }
    return 1;
}

static size_t count_open(const gnoi_prepared *prepared, size_t first, size_t last)
{
    size_t i, k, open = 0;
    for (i = first; i < last; i++) {
        const gnoi_poly *poly = &prepared->polys[i];
        for (k = 0; gnoi_is_smooth(poly) && k < poly->corner_count; k++) {
            open += prepared->corner_normal[poly->corner + k] == GNOI_NONE;
        }
    }
    return open;
}

int gnoi_weld_make(const gno_scene *scene, size_t first, size_t last, gnoi_weld *weld)
{
    size_t open;
    set_range(&scene->prepared, first, last, weld);
    weld->count = 0;
    weld->table_size = 16;
    open = count_open(&scene->prepared, first, last);
    while (weld->table_size < 2 * (open < weld->span ? open : weld->span)) {
        weld->table_size *= 2;
    }
    weld->class_of = gnoi_malloc(scene->context, weld->span, sizeof *weld->class_of);
    weld->table = gnoi_malloc(scene->context, weld->table_size, sizeof *weld->table);
    if (!weld->class_of || !weld->table) {
        return 0;
    }
    memset(weld->class_of, 0xff, weld->span * sizeof *weld->class_of); /* GNOI_NONE everywhere */
    memset(weld->table, 0xff, weld->table_size * sizeof *weld->table);
    return set_classes(scene, first, last, 1, weld) && set_classes(scene, first, last, 0, weld);
}

void gnoi_weld_free(gno_context *context, gnoi_weld *weld)
{
    gnoi_free(context, weld->class_of, weld->span, sizeof *weld->class_of);
    gnoi_free(context, weld->table, weld->table_size, sizeof *weld->table);
}
