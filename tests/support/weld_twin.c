/* weld_twin.c -- see weld_twin.h. */
#include "support/weld_twin.h"

#include <stdlib.h>
#include <string.h>

static int compare_positions(const double p[3], const double q[3])
{
    for (int k = 0; k < 3; k++)
        if (p[k] != q[k])
            return p[k] < q[k] ? -1 : 1;
    return 0;
}

typedef struct numbered {
    double position[3];
    uint32_t number;
} numbered;

static int by_position_then_number(const void *a, const void *b)
{
    const numbered *v = a, *w = b;
    int c = compare_positions(v->position, w->position);
    return c ? c : v->number < w->number ? -1 : v->number > w->number;
}

uint32_t *weld_twin(const double (*positions)[3], size_t count)
{
    numbered *order = calloc(count + 1, sizeof *order);
    uint32_t *first = calloc(count + 1, sizeof *first);
    if (order && first) {
        for (size_t i = 0; i < count; i++) {
            memcpy(order[i].position, positions[i], sizeof order[i].position);
            order[i].number = (uint32_t)i;
        }
        qsort(order, count, sizeof *order, by_position_then_number);
        for (size_t i = 0; i < count; i++) {
            int again = i > 0 && compare_positions(order[i].position, order[i - 1].position) == 0;
            first[order[i].number] = again ? first[order[i - 1].number] : order[i].number;
        }
    }
    if (!order) {
        free(first);
        first = NULL;
    }
    free(order);
    return first;
}
