/* column.h -- one column of a light's binary shadow matrix, asked for by a receiver or a part of it, and the shadow
 * polygons that its casters throw on the receiver, in picture coordinates.
 *
 * Place in the data flow: caster tree (tree.h) + receiver seen in a picture region -> casters by exact tests -> shadow
 * polygons -> their intervals on a sample line -> gno_span_split.
 * A shadow polygon is caster x one matrix: the projection from the light onto the receiver's plane, then the view. In
 * forms: the shadow of P has F = F(P) H - F(L) h, F any of the view's homogeneous forms x, y, w, h and H the heights of P and
 * of the light over the receiver's plane (Blinn, "Me and my (fake) shadow", 1988). The caster is cut first where it reaches
 * behind the receiver's plane, above the light, or where its shadow falls behind the eye.
 * Invariants: a caster that can darken a point of the region by more than the coplanarity tolerance is in the column
 * (a zero is certain); polygons on the receiver's plane never are.
 */
#ifndef GNOI_SHADOW_COLUMN_H
#define GNOI_SHADOW_COLUMN_H

#include "project/clip3.h"
#include "project/edge.h"
#include "project/view.h"
#include "shadow/contour.h"
#include "shadow/gather.h"

typedef enum gnoi_column_state {
    GNOI_COLUMN_UNKNOWN = 0,
    GNOI_COLUMN_LIT,   /* no shadow polygon meets the region */
    GNOI_COLUMN_DARK,  /* in its own shadow, or one opaque caster covers the region */
    GNOI_COLUMN_SPLIT  /* spans must be split */
} gnoi_column_state;

typedef struct gnoi_caster {
    float x0, y0, x1, y1; /* bounds in the picture, widened against rounding */
    uint32_t edge, edge_count;
    uint32_t poly;     /* the prepared polygon that throws it */
    uint32_t material; /* for its transmission */
    float area;        /* of the shadow polygon, 0 where it has holes */
} gnoi_caster;

/* A contour edge as it bounds the shadow on the receiver. A level one keeps its height in y and y1, and crosses no line. */
typedef struct gnoi_rim {
    gnoi_edge edge;
    float x0, x1; /* where it begins and ends in the picture */
    int step;     /* by how much more far sides cover the receiver to the right of it */
} gnoi_rim;

/* Where a line crosses a contour edge. */
typedef struct gnoi_step {
    double x;
    double edge_x, edge_y, slope; /* the edge's: x at height y is edge_x + (y - edge_y) slope */
    int step;
} gnoi_step;

/* A line's crossings with a column's contour edges, from left to right. */
typedef struct gnoi_crossed {
    uint32_t rim, rim_count; /* the column's; rim_count 0: of no column */
    int row;                 /* of the receiver's region */
    int left;                /* far sides over the receiver to the left of all crossings */
    double top, bottom;      /* the same edges cross all lines of the row from top to before bottom */
    size_t count, capacity;
    gnoi_step *steps;
} gnoi_crossed;

typedef struct gnoi_column {
    gnoi_column_state state;
    int sheet; /* far sides of halved solids are over a part of the region */
    uint32_t rim, rim_count; /* contour edges over the region, into gnoi_columns.rims */
    uint32_t caster, caster_count; /* into gnoi_columns.casters */
    uint32_t rows; /* a long column's casters by pixel row: into gnoi_columns.rows, where offsets into the same list for
                      row 0, 1, ... of the region and an end stand; GNOI_NONE for a short one */
    uint32_t rim_rows; /* the same of its contour edges */
    int known;         /* `count` far sides cover the receiver at the picture point (at_x, at_y) */
    int count;
    double at_x, at_y;
} gnoi_column;

struct gnoi_request; /* a receiver waiting for its neighbours, so that the tree is walked once for all of them */

/* What is near a group of receivers. */
typedef struct gnoi_near {
    gnoi_lbox box;
    gnoi_gathered single, far, rim;
    int rims;                      /* rim is gathered */
    int fine;                      /* all nodes are parted */
    const struct gnoi_near *whole; /* of the group that it is a part of, or NULL */
} gnoi_near;

#define GNOI_NEAR_DEPTH 16

/* Storage of all columns of one tile, and scratch; one for each worker. */
typedef struct gnoi_columns {
    gno_context *context;
    size_t caster_count, caster_capacity;
    gnoi_caster *casters;
    size_t edge_count, edge_capacity;
    gnoi_edge *edges;
    size_t rim_count, rim_capacity;
    gnoi_rim *rims;
    gnoi_crossed crossed;     /* of the line asked for last */
    gnoi_list found;                 /* candidates of the tree */
    gnoi_list rows;
    size_t point_capacity;
    gnoi_hpoint *points;             /* two halves: before and after a cut */
    size_t interval_count, interval_capacity;
    gno_shadow_interval *intervals;  /* of the line asked for last */
    size_t source_capacity;
    uint32_t *sources;               /* beside them: the polygon that throws the shadow, GNOI_NONE for the dark outside of a cone;
                                        only for a lamp whose shadows weaken with distance */
    size_t crossing_capacity;
    double *crossings;
    struct gnoi_request *requests;   /* request_capacity of them once made; request_count wait */
    size_t request_count, request_capacity;
    const gno_scene *scene;          /* of those that wait */
    const gnoi_lamp *lamp;
    gnoi_near nears[GNOI_NEAR_DEPTH + 1], *near; /* of a group and its halves, and one to spare; of the one at hand */
    double asked, ones, full;        /* statistics */
} gnoi_columns;

/* The part of a receiver that is asked about. */
typedef struct gnoi_receiver {
    const gnoi_poly *poly;
    uint32_t index;           /* of poly among the prepared polygons */
    double side;              /* gnoi_view_side of its plane */
    gnoi_screen_plane nearness;
    double tolerance;         /* distance from its plane within which things lie on it */
    double x0, y0, x1, y1;    /* picture region that holds the visible part */
    int first_row, rows;      /* pixel rows of the region */
    int whole;                /* the polygon lies wholly inside the region, before the near plane */
} gnoi_receiver;

/* Asks for the column of `receiver` for `lamp`; it is valid after gnoi_columns_finish. Receivers near each other in the picture
 * should follow one another, all of one lamp between two calls of finish; receiver and column must stay in place until then.
 * Both return 0 when memory fails. */
int gnoi_columns_ask(const gno_scene *scene, const gnoi_view *view, const gnoi_lamp *lamp, const gnoi_casters *casters,
                     const gnoi_receiver *receiver, gnoi_columns *columns, gnoi_column *column);
int gnoi_columns_finish(const gnoi_view *view, const gnoi_casters *casters, gnoi_columns *columns);

/* Collects in columns->intervals where the column's shadow polygons and, for a spot, the dark outside of its cone meet line y
 * between xa and xb (intervals may reach beyond); [xa,xb] lies in the receiver's region. What is found about the line serves the
 * next one asked for. Returns 0 when memory fails. */
int gnoi_column_intervals(const gno_scene *scene, const gnoi_view *view, const gnoi_lamp *lamp, const gnoi_casters *casters,
                          const gnoi_receiver *receiver, gnoi_column *column, double y, double xa, double xb, gnoi_columns *columns);

/* Whether nothing but far sides shades the column's receiver. Then it is enough to know where line y crosses their contour edges, which
 * gnoi_column_cross finds out, to columns->crossed; arguments as above. Returns 0 when memory fails. */
static inline int gnoi_column_is_sheet(const gnoi_lamp *lamp, const gnoi_column *column)
{
    return column->sheet && column->caster_count == 0 && !lamp->spot && !(lamp->softness > 0);
}
int gnoi_column_cross(const gno_scene *scene, const gnoi_view *view, const gnoi_lamp *lamp, const gnoi_casters *casters,
                      const gnoi_receiver *receiver, gnoi_column *column, double y, double xa, double xb, gnoi_columns *columns);

/* What a caster's shadow leaves of a lamp's light, by channel, at the receiver's point seen at (x,y), where the lamp's shadows weaken with
 * distance: 1 - s / (1 + d/D), with s what the caster keeps back and d its distance from the point along the ray. */
void gnoi_caster_light(const gno_scene *scene, const gnoi_view *view, const gnoi_lamp *lamp, const gnoi_receiver *receiver, uint32_t caster,
                       double x, double y, double light[3]);

/* Makes the store empty for the next tile; keeps its memory. */
void gnoi_columns_reset(gnoi_columns *columns);
void gnoi_columns_free(gnoi_columns *columns);

#endif
