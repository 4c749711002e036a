/* pieces_obj.c -- pieces as a Wavefront OBJ file: see lit_files.h. One object for each polygon and light, n-gons as they are. */
#include "io/lit_files.h"

#include <math.h>
#include <string.h>

void gnoi_obj_begin(gnoi_text *text)
{
    gnoi_text_put(text, "# lit pieces, one object a polygon and light\n");
}

/* A name of the file ends at white space. */
static void put_word(gnoi_text *text, const char *word)
{
    for (; word != NULL && *word != '\0'; word++) {
        gnoi_text_char(text, (unsigned char)*word <= ' ' ? '_' : *word);
    }
}

static void put_object(gnoi_text *text, const gnoi_named_piece *named)
{
    gnoi_text_put(text, "o polygon_");
    gnoi_text_integer(text, (long long)named->piece.polygon);
    gnoi_text_char(text, '_');
    put_word(text, named->object);
    gnoi_text_char(text, '_');
    put_word(text, named->light);
    if (named->sample > 0) {
        gnoi_text_char(text, '_');
        gnoi_text_integer(text, named->sample);
    }
    gnoi_text_char(text, '\n');
}

static void put_vertex(gnoi_text *text, const double p[3])
{
    gnoi_text_char(text, 'v');
    for (int k = 0; k < 3; k++) {
        gnoi_text_char(text, ' ');
        gnoi_text_exact(text, p[k]);
    }
    gnoi_text_char(text, '\n');
}

static void put_face(gnoi_text *text, gnoi_obj_state *state, size_t count)
{
    gnoi_text_char(text, 'f');
    for (size_t i = 0; i < count; i++) {
        gnoi_text_char(text, ' ');
        gnoi_text_integer(text, ++state->vertices);
    }
    gnoi_text_char(text, '\n');
}

/* The piece's plane: points in space are origin + x u + y v. */
typedef struct plane {
    gnoi_text *text;
    gnoi_obj_state *state;
    double origin[3], u[3], v[3];
} plane;

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static void normalise(double a[3])
{
    const double length = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    for (int k = 0; k < 3 && length > 0; k++) {
        a[k] /= length;
    }
}

static void find_plane(const gno_piece *piece, plane *p)
{
    const double *first = piece->points + 3 * piece->ring_start[0];
    double n[3] = {0, 0, 0}, axis[3] = {0, 0, 0};
    int least = 0;
    for (size_t i = piece->ring_start[0] + 1; i + 1 < piece->ring_start[1]; i++) {
        double a[3], b[3], c[3];
        for (int k = 0; k < 3; k++) {
            a[k] = piece->points[3 * i + (size_t)k] - first[k];
            b[k] = piece->points[3 * i + 3 + (size_t)k] - first[k];
        }
        cross(a, b, c);
        for (int k = 0; k < 3; k++) {
            n[k] += c[k];
        }
    }
    normalise(n);
    for (int k = 1; k < 3; k++) {
        least = fabs(n[k]) < fabs(n[least]) ? k : least;
    }
    axis[least] = 1;
    cross(n, axis, p->v);
    normalise(p->v);
    cross(p->v, n, p->u);
    memcpy(p->origin, first, sizeof p->origin);
}

static void put_flat(void *user, const double *points, size_t count)
{
    plane *p = user;
    for (size_t i = 0; i < count; i++) {
        double q[3];
        for (int k = 0; k < 3; k++) {
            q[k] = p->origin[k] + points[2 * i] * p->u[k] + points[2 * i + 1] * p->v[k];
        }
        put_vertex(p->text, q);
    }
    put_face(p->text, p->state, count);
}

/* Turns the piece into plane coordinates and hands on what has no holes. */
static gno_status put_holed(gnoi_text *text, const gno_piece *piece, gnoi_obj_state *state)
{
    const size_t first = piece->ring_start[0], count = piece->ring_start[piece->ring_count] - first;
    const size_t point_bytes = 2 * count * sizeof(double), ring_bytes = (piece->ring_count + 1) * sizeof(size_t);
    const size_t polygon_start[2] = {0, piece->ring_count};
    double *points = gno_context_realloc(state->context, NULL, 0, point_bytes);
    size_t *rings = gno_context_realloc(state->context, NULL, 0, ring_bytes);
    gno_status status = GNO_ERROR_MEMORY;
    plane p;
    if (points != NULL && rings != NULL) {
        gno_shape shape;
        p.text = text;
        p.state = state;
        find_plane(piece, &p);
        for (size_t i = 0; i < count; i++) {
            points[2 * i] = points[2 * i + 1] = 0;
            for (size_t k = 0; k < 3; k++) {
                const double q = piece->points[3 * (first + i) + k] - p.origin[k];
                points[2 * i] += q * p.u[k];
                points[2 * i + 1] += q * p.v[k];
            }
        }
        for (size_t r = 0; r <= piece->ring_count; r++) {
            rings[r] = piece->ring_start[r] - first;
        }
        shape.polygon_count = 1;
        shape.polygon_start = polygon_start;
        shape.ring_count = piece->ring_count;
        shape.ring_start = rings;
        shape.points = points;
        status = gnoi_without_holes(state->context, state->clipper, &shape, put_flat, &p);
    }
    if (points != NULL) {
        gno_context_realloc(state->context, points, point_bytes, 0);
    }
    if (rings != NULL) {
        gno_context_realloc(state->context, rings, ring_bytes, 0);
    }
    return status == GNO_ERROR_MEMORY ? gno_context_fail(state->context, status, "out of memory for the pieces") : status;
}

gno_status gnoi_obj_put(gnoi_text *text, const gnoi_named_piece *named, int first, void *user)
{
    gnoi_obj_state *state = user;
    const gno_piece *piece = &named->piece;
    const size_t light = piece->light_count > 0 ? piece->lights[0] : 0;
    if (first || piece->polygon != state->polygon || light != state->light) {
        put_object(text, named);
    }
    state->polygon = piece->polygon;
    state->light = light;
    if (piece->ring_count > 1) {
        return put_holed(text, piece, state);
    }
    for (size_t i = piece->ring_start[0]; i < piece->ring_start[1]; i++) {
        put_vertex(text, piece->points + 3 * i);
    }
    put_face(text, state, piece->ring_start[1] - piece->ring_start[0]);
    return GNO_OK;
}
