/* town.c -- writes a town of houses with pitched roofs as OBJ, MTL and scene file, for measuring growth.
 *
 * usage: town POLYGONS LIGHTS FOLDER      writes FOLDER/town.obj, town.mtl, town.yaml, and town.json, the same view for the ray-traced peer
 *
 * The town fills the same square whatever its number of polygons, and the camera sees all of it: more polygons are more
 * and smaller houses, not a larger picture. A house has six polygons: two side walls, two gabled walls of five corners, two
 * halves of a roof. They stand on one ground polygon in a grid with streets, each a little off, turned, and of its own size.
 * Lights: the first is a sun, the others are point lights on a ring above the town.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
#define HALF 50.0     /* half the side of the town */
#define GROUND 400.0  /* half the side of the ground */
#define WALLS 4
#define ROOFS 3

static unsigned long long seed = 88172645463325252u;

static double between(double a, double b)
{
    seed ^= seed << 13;
    seed ^= seed >> 7;
    seed ^= seed << 17;
    return a + (b - a) * (double)(seed >> 11) / 9007199254740992.0;
}

static FILE *create(const char *folder, const char *name)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *f = fopen(path, "w");
    if (!f) {
        fprintf(stderr, "town: cannot write %s\n", path);
        exit(1);
    }
    return f;
}

static void finish(FILE *f)
{
    if (ferror(f) | fclose(f)) {
        fprintf(stderr, "town: a file could not be written whole\n");
        exit(1);
    }
}

static void write_materials(FILE *f)
{
    static const double walls[WALLS][3] = {{0.82, 0.74, 0.58}, {0.72, 0.62, 0.52}, {0.8, 0.78, 0.74}, {0.62, 0.5, 0.42}};
    static const double roofs[ROOFS][3] = {{0.55, 0.22, 0.15}, {0.42, 0.2, 0.16}, {0.3, 0.3, 0.34}};
    fprintf(f, "newmtl ground\nKa 0.42 0.46 0.34\nKd 0.42 0.46 0.34\n");
    for (int i = 0; i < WALLS + ROOFS; i++) {
        const double *c = i < WALLS ? walls[i] : roofs[i - WALLS];
        fprintf(f, "newmtl m%d\nKa %g %g %g\nKd %g %g %g\n", i, c[0], c[1], c[2], c[0], c[1], c[2]);
    }
}

/* Ten corners: four at the foot, four at the eaves, two ends of the ridge. */
static void write_house(FILE *f, double x, double y, double cell)
{
    double angle = between(-0.1, 0.1) + (between(0, 1) < 0.5 ? 0 : PI / 2), c = cos(angle), s = sin(angle);
    double a = between(0.22, 0.34) * cell, b = between(0.22, 0.34) * cell, eaves = between(0.3, 0.9) * cell;
    double ridge = eaves + between(0.15, 0.35) * cell;
    for (int i = 0; i < 10; i++) {
        double u = i < 8 ? (i % 4 == 1 || i % 4 == 2 ? a : -a) : i == 8 ? -a : a;
        double v = i < 8 ? (i % 4 >= 2 ? b : -b) : 0;
        fprintf(f, "v %.7g %.7g %.7g\n", x + c * u - s * v, y + s * u + c * v, i < 4 ? 0 : i < 8 ? eaves : ridge);
    }
    fprintf(f, "usemtl m%d\n", (int)between(0, WALLS));
    fprintf(f, "f -10 -9 -5 -6\nf -8 -7 -3 -4\nf -9 -8 -4 -1 -5\nf -7 -10 -6 -2 -3\n");
    fprintf(f, "usemtl m%d\n", WALLS + (int)between(0, ROOFS));
    fprintf(f, "f -6 -5 -1 -2\nf -4 -3 -2 -1\n");
}

static void write_town(FILE *f, long polygons)
{
    long houses = (polygons - 1 + 5) / 6, side = (long)ceil(sqrt((double)houses));
    double cell = 2 * HALF / (double)side;
    fprintf(f, "mtllib town.mtl\nusemtl ground\n");
    fprintf(f, "v %g %g 0\nv %g %g 0\nv %g %g 0\nv %g %g 0\nf 1 2 3 4\n", -GROUND, -GROUND, GROUND, -GROUND, GROUND, GROUND, -GROUND, GROUND);
    for (long i = 0; i < houses; i++) {
        double x = -HALF + ((double)(i % side) + 0.5 + between(-0.1, 0.1)) * cell;
        double y = -HALF + ((double)(i / side) + 0.5 + between(-0.1, 0.1)) * cell;
        write_house(f, x, y, cell);
    }
}

/* The lights: the first a sun by its direction, the others by their places. */
static int light_at(int i, int lights, double at[3], double colour[3])
{
    double share = 1.0 / lights, turn = 2 * PI * i / lights + 0.7;
    static const double sun[3] = {0.5, 0.35, -0.6}, sun_colour[3] = {1, 0.95, 0.85}, lamp_colour[3] = {0.9, 0.9, 1};
    for (int k = 0; k < 3; k++) {
        at[k] = i == 0 ? sun[k] : k == 0 ? 70 * cos(turn) : k == 1 ? 70 * sin(turn) : 45.0 + 10 * (i % 3);
        colour[k] = share * (i == 0 ? sun_colour[k] : lamp_colour[k]);
    }
    return i == 0;
}

static void write_scene(FILE *f, int lights)
{
    fprintf(f, "gnomon: 1\nimage: {width: 1920, height: 1080, background: [0.55, 0.66, 0.82]}\n");
    fprintf(f, "camera: {eye: [14, -112, 78], target: [-1, -7, 0], up: [0, 0, 1], fov: 35}\nambient: [0.3, 0.3, 0.34]\nlights:\n");
    for (int i = 0; i < lights; i++) {
        double at[3], c[3];
        int sun = light_at(i, lights, at, c);
        fprintf(f, "  - {type: %s, %s: [%g, %g, %g], intensity: [%g, %g, %g]}\n", sun ? "directional" : "point", sun ? "direction" : "position",
                at[0], at[1], at[2], c[0], c[1], c[2]);
    }
    fprintf(f, "objects:\n  - {mesh: town.obj}\n");
}

static void write_peer_scene(FILE *f, int lights)
{
    fprintf(f, "{\"obj\": \"town.obj\", \"smooth\": 0, \"eye\": [14, -112, 78], \"target\": [-1, -7, 0], \"up\": [0, 0, 1], \"vfov_deg\": 35,\n");
    fprintf(f, " \"width\": 1920, \"height\": 1080, \"background\": [0.55, 0.66, 0.82], \"ambient\": [0.3, 0.3, 0.34],\n \"lights\": [");
    for (int i = 0; i < lights; i++) {
        double at[3], c[3], s = light_at(i, lights, at, c) ? -1 : 1;
        fprintf(f, "%s\n  {\"type\": \"%s\", \"%s\": [%g, %g, %g], \"color\": [%g, %g, %g]}", i > 0 ? "," : "", s < 0 ? "directional" : "point",
                s < 0 ? "to_light" : "pos", s * at[0], s * at[1], s * at[2], c[0], c[1], c[2]);
    }
    fprintf(f, "]}\n");
}

int main(int argc, char **argv)
{
    long polygons = argc == 4 ? strtol(argv[1], NULL, 10) : 0, lights = argc == 4 ? strtol(argv[2], NULL, 10) : 0;
    if (polygons < 7 || lights < 1 || lights > 4096) {
        fprintf(stderr, "usage: town POLYGONS LIGHTS FOLDER      at least 7 polygons and one light\n");
        return 2;
    }
    FILE *f = create(argv[3], "town.mtl");
    write_materials(f);
    finish(f);
    f = create(argv[3], "town.obj");
    write_town(f, polygons);
    finish(f);
    f = create(argv[3], "town.yaml");
    write_scene(f, (int)lights);
    finish(f);
    f = create(argv[3], "town.json");
    write_peer_scene(f, (int)lights);
    finish(f);
    return 0;
}
