/* split.c -- cutting one visible span where shadow polygons begin and end.
 *
 * Place in the data flow: visible span + its column's shadow polygons on the same line -> parts of one shadow state each.
 * The chapter cuts a span at the first shadow edge inside it and applies its four rules again to each part. Taking the
 * shadow polygons in the order in which they begin, the same recursion becomes one sweep: what lies left of the next
 * beginning or end is finished, and the rest is the next smaller span.
 * Invariants: parts leave no gap in [x0,x1); neighbours differ in light; zero-length pieces never appear.
 */
#include <gnomon/gnomon.h>

#define SHORT_LIST 24

static void insertion_sort(gno_shadow_interval *s, size_t count)
{
    for (size_t i = 1; i < count; i++) {
        gno_shadow_interval v = s[i];
        size_t j = i;
        for (; j > 0 && s[j - 1].x0 > v.x0; j--)
            s[j] = s[j - 1];
        s[j] = v;
    }
}

static void sift_down(gno_shadow_interval *s, size_t i, size_t count)
{
    gno_shadow_interval v = s[i];
    for (size_t child = 2 * i + 1; child < count; child = 2 * i + 1) {
        if (child + 1 < count && s[child + 1].x0 > s[child].x0)
            child++;
        if (!(s[child].x0 > v.x0))
            break;
        s[i] = s[child];
        i = child;
    }
    s[i] = v;
}

static void sort_by_start(gno_shadow_interval *s, size_t count)
{
    size_t sorted = 1;
    while (sorted < count && s[sorted - 1].x0 <= s[sorted].x0)
        sorted++;
    if (sorted >= count)
        return; /* as when many spans of one line meet the same shadow polygons */
    if (count <= SHORT_LIST) {
        insertion_sort(s, count);
        return;
    }
    for (size_t i = count / 2; i-- > 0;)
        sift_down(s, i, count);
    for (size_t n = count; n-- > 1;) {
        gno_shadow_interval v = s[0];
        s[0] = s[n];
        s[n] = v;
        sift_down(s, 0, n);
    }
}

static int is_opaque(const gno_shadow_interval *s)
{
    return s->transmission[0] <= 0 && s->transmission[1] <= 0 && s->transmission[2] <= 0;
}

/* Appends [x0,x1), joined to the last part when the light is the same. */
static size_t emit(gno_span_part *parts, size_t n, double x0, double x1, const double light[3])
{
    if (n > 0) {
        gno_span_part *last = &parts[n - 1];
        if (last->light[0] == light[0] && last->light[1] == light[1] && last->light[2] == light[2]) {
            last->x1 = x1;
            return n;
        }
    }
    parts[n].x0 = x0;
    parts[n].x1 = x1;
    for (int k = 0; k < 3; k++)
        parts[n].light[k] = light[k];
    return n + 1;
}

/* Light over the piece that begins at x: the product over the shadow polygons there; *end becomes the next place where one
 * begins or ends. */
static void light_at(double x, const gno_shadow_interval *s, size_t count, double light[3], double *end)
{
    light[0] = light[1] = light[2] = 1;
    for (size_t i = 0; i < count; i++) {
        if (s[i].x0 > x) {
            if (s[i].x1 > s[i].x0) {
                *end = s[i].x0 < *end ? s[i].x0 : *end;
                break;
            }
            continue;
        }
        if (!(s[i].x1 > x))
            continue;
        *end = s[i].x1 < *end ? s[i].x1 : *end;
        for (int k = 0; k < 3; k++)
            light[k] *= s[i].transmission[k];
    }
}

static size_t split_transparent(double x0, double x1, const gno_shadow_interval *s, size_t count, gno_span_part *parts)
{
    size_t n = 0;
    double x = x0;
    while (x < x1) {
        double light[3], end = x1;
        light_at(x, s, count, light, &end);
        n = emit(parts, n, x, end, light);
        x = end;
    }
    return n;
}

static size_t split_opaque(double x0, double x1, const gno_shadow_interval *s, size_t count, gno_span_part *parts)
{
    static const double lit[3] = {1, 1, 1}, dark[3] = {0, 0, 0};
    size_t n = 0;
    double x = x0;
    for (size_t i = 0; i < count && x < x1 && s[i].x0 < x1; i++) {
        double end = s[i].x1 < x1 ? s[i].x1 : x1;
        if (!(end > x) || !(s[i].x1 > s[i].x0))
            continue;
        if (s[i].x0 > x) {
            n = emit(parts, n, x, s[i].x0, lit);
            x = s[i].x0;
        }
        n = emit(parts, n, x, end, dark);
        x = end;
    }
    return x < x1 ? emit(parts, n, x, x1, lit) : n;
}

size_t gno_span_split(double x0, double x1, gno_shadow_interval *shadows, size_t count, gno_span_part *parts)
{
    size_t transparent = 0;
    if (!(x1 > x0))
        return 0;
    for (size_t i = 0; i < count; i++)
        transparent += !is_opaque(&shadows[i]);
    sort_by_start(shadows, count);
    return transparent ? split_transparent(x0, x1, shadows, count, parts) : split_opaque(x0, x1, shadows, count, parts);
}
