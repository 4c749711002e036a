/* energyplus.c -- lit fractions of a real building beside EnergyPlus's own and beside dense sampling.
 *
 * usage: energyplus NAME SURFACES SUN SAMPLED SH     (files of ../shared/data/energyplus/NAME, unpacked; see energyplus.sh)
 *
 * The building is one scene with one sun for each position. Walls have their windows and doors as holes; what casts in the data set
 * is opaque, a window as its wall is; everything else lets all light through. Compared are the fractions of all sun-exposed surfaces
 * that face the sun. Exit status 1: a difference to the sampled table beyond BOUND, or a certificate beyond PROOF.
 */
#include <gnomon/gnomon_pieces.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The sampler takes 500 scan lines a surface and gives six digits; where an edge runs along the lines it may err by a line's share. */
#define BOUND 1e-3
#define PROOF 1e-9
#define LONGEST 200000
#define MOST 1200

typedef struct surface {
    char name[128], base[128];
    int casts, exposed, corners, column[2]; /* columns of its fraction in the sampled and the SH table */
    double corner[64][3];
    long polygon;
} surface;

static surface surfaces[MOST];
static int surface_count;
static char line[LONGEST];

static void stop(const char *what)
{
    fprintf(stderr, "energyplus: %s\n", what);
    exit(2);
}

/* The text after "key": on the line, or NULL. */
static const char *after(const char *text, const char *key)
{
    char quoted[64];
    const char *at;
    snprintf(quoted, sizeof quoted, "\"%s\":", key);
    at = strstr(text, quoted);
    return at ? at + strlen(quoted) : NULL;
}

static void copy_string(const char *at, char to[128])
{
    int n = 0;
    to[0] = '\0';
    if (!at || *at != '"')
        return;
    for (at++; *at && *at != '"' && n < 127; at++)
        to[n++] = *at;
    to[n] = '\0';
}

/* One surface a line. */
static void read_surfaces(const char *path)
{
    FILE *f = fopen(path, "r");
    if (!f)
        stop("no surfaces");
    while (fgets(line, sizeof line, f)) {
        surface *s = &surfaces[surface_count];
        const char *at = after(line, "vertices");
        if (!at)
            continue;
        if (surface_count == MOST)
            stop("too many surfaces");
        copy_string(after(line, "name"), s->name);
        copy_string(after(line, "base"), s->base);
        s->casts = strncmp(after(line, "casts"), "\"all\"", 5) == 0;
        s->exposed = strncmp(after(line, "sun_exposed"), "true", 4) == 0;
        for (at++; *at == '[' || *at == ',';) {
            double *c = s->corner[s->corners];
            at += *at == ',';
            if (s->corners == 64 || sscanf(at, "[%lf,%lf,%lf]", &c[0], &c[1], &c[2]) != 3)
                stop("a surface that is not understood");
            s->corners++;
            at = strchr(at, ']') + 1;
        }
        surface_count++;
    }
    fclose(f);
}

static int find(const char *name)
{
    for (int i = 0; i < surface_count; i++)
        if (strcmp(surfaces[i].name, name) == 0)
            return i;
    return -1;
}

/* Adds surface i with its subsurfaces as holes. */
static void add_surface(gno_scene *scene, int i, int opaque, int clear)
{
    static double positions[MOST][3];
    static int corners[MOST];
    unsigned rings[66], polygons[2] = {0, 0};
    surface *s = &surfaces[i];
    int base = find(s->base), count = 0;
    size_t first;
    gno_mesh_def mesh = gno_mesh_def_default();
    rings[0] = 0;
    for (int k = -1; k < surface_count; k++) {
        const surface *ring = k < 0 ? s : &surfaces[k];
        if (k >= 0 && strcmp(ring->base, s->name) != 0)
            continue;
        if (polygons[1] == 64 || count + ring->corners > MOST)
            stop("too many windows");
        for (int c = 0; c < ring->corners; c++, count++) {
            memcpy(positions[count], ring->corner[c], sizeof positions[0]);
            corners[count] = count;
        }
        rings[++polygons[1]] = (unsigned)count;
    }
    mesh.name = s->name;
    mesh.vertex_count = mesh.corner_count = (size_t)count;
    mesh.positions = positions[0];
    mesh.corner_vertex = corners;
    mesh.polygon_count = 1;
    mesh.polygon_start = polygons;
    mesh.ring_count = polygons[1];
    mesh.ring_start = rings;
    mesh.material = s->casts || (base >= 0 && surfaces[base].casts) ? opaque : clear;
    if (gno_scene_add_mesh(scene, &mesh, &first))
        stop(gno_context_message(gno_scene_context(scene)));
    s->polygon = (long)first;
}

/* Splits a CSV line in place; returns the number of fields. */
static int fields(char *text, char *field[MOST])
{
    int n = 0;
    for (char *at = strtok(text, ",\r\n"); at && n < MOST; at = strtok(NULL, ",\r\n"))
        field[n++] = at;
    return n;
}

static FILE *open_table(const char *path, int table)
{
    char *field[MOST];
    FILE *f = fopen(path, "r");
    int n;
    if (!f || !fgets(line, sizeof line, f))
        stop("no table");
    n = fields(line, field);
    for (int i = 0; i < surface_count; i++)
        surfaces[i].column[table] = -1;
    for (int k = 1; k < n; k++) {
        int i = find(field[k]);
        if (i >= 0)
            surfaces[i].column[table] = k;
    }
    return f;
}

typedef struct tally {
    double worst, sum;
    long count, over4, over3;
} tally;

static void count_difference(tally *t, double d)
{
    d = fabs(d);
    t->worst = d > t->worst ? d : t->worst;
    t->sum += d;
    t->count++;
    t->over4 += d > 1e-4;
    t->over3 += d > 1e-3;
}

static void print_tally(const char *name, const char *what, const tally *t)
{
    printf("%-17s %-22s %6ld %9.2g %9.2g %8ld %8ld\n", name, what, t->count, t->worst, t->sum / (double)(t->count ? t->count : 1), t->over4,
           t->over3);
}

int main(int argc, char **argv)
{
    static double row_of[2][MOST];
    gno_context *context;
    gno_scene *scene;
    gno_material material = gno_material_default();
    gno_lit_row *rows;
    tally sampled = {0}, sh = {0}, between = {0};
    double area_residual = 0, flux_residual = 0;
    FILE *sun, *table[2];
    char *field[MOST];
    int opaque, clear, suns = 0;
    if (argc != 6)
        stop("usage: energyplus NAME SURFACES SUN SAMPLED SH");
    read_surfaces(argv[2]);
    if (gno_context_create(NULL, &context) || gno_scene_create(context, &scene) || gno_scene_add_material(scene, &material, &opaque))
        stop("out of memory");
    for (int k = 0; k < 3; k++)
        material.transmission[k] = 1;
    if (gno_scene_add_material(scene, &material, &clear))
        stop("out of memory");
    for (int i = 0; i < surface_count; i++)
        add_surface(scene, i, opaque, clear);
    sun = fopen(argv[3], "r");
    if (!sun || !fgets(line, sizeof line, sun))
        stop("no sun");
    while (fgets(line, sizeof line, sun)) {
        gno_light light = gno_light_default();
        int n = fields(line, field);
        light.type = GNO_LIGHT_DIRECTIONAL;
        for (int k = 0; k < 3; k++)
            light.direction[k] = -atof(field[n - 3 + k]);
        if (gno_scene_add_light(scene, NULL, &light, NULL))
            stop(gno_context_message(context));
        suns++;
    }
    fclose(sun);
    table[0] = open_table(argv[4], 0);
    table[1] = open_table(argv[5], 1);
    rows = malloc(gno_scene_count(scene).polygons * sizeof *rows);
    for (int k = 0; k < suns && rows; k++) {
        gno_lit_summary sum;
        if (gno_lit_pieces(scene, (size_t)k, NULL, NULL, rows, &sum))
            stop(gno_context_message(context));
        area_residual = fmax(area_residual, sum.area_residual);
        flux_residual = fmax(flux_residual, sum.flux_residual);
        for (int t = 0; t < 2; t++) {
            if (!fgets(line, sizeof line, table[t]))
                stop("a table too short");
            for (int n = fields(line, field); n-- > 0;)
                row_of[t][n] = atof(field[n]);
        }
        for (int i = 0; i < surface_count; i++) {
            const surface *s = &surfaces[i];
            const gno_lit_row *row = &rows[s->polygon];
            double a, b;
            if (!s->exposed || row->side != 1 || s->column[0] < 0 || s->column[1] < 0)
                continue;
            a = row_of[0][s->column[0]];
            b = row_of[1][s->column[1]];
            count_difference(&sampled, row->fraction - a);
            count_difference(&sh, row->fraction - b);
            count_difference(&between, b - a);
            if (fabs(row->fraction - a) > 1e-4 || fabs(row->fraction - b) > 1e-3)
                printf("  sun %3d %-44s gnomon %.6f sampled %.6f EnergyPlus %.6f\n", k, s->name, row->fraction, a, b);
        }
    }
    print_tally(argv[1], "gnomon - sampled", &sampled);
    print_tally(argv[1], "gnomon - EnergyPlus", &sh);
    print_tally(argv[1], "EnergyPlus - sampled", &between);
    printf("%-17s certificates over %d suns: area %.2g, flux %.2g\n", argv[1], suns, area_residual, flux_residual);
    fclose(table[0]);
    fclose(table[1]);
    free(rows);
    gno_scene_destroy(scene);
    gno_context_destroy(context);
    return sampled.worst > BOUND || area_residual > PROOF || flux_residual > PROOF;
}
