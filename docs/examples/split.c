/* split.c -- one span of a picture line cut by three shadow polygons, without any picture. */
#include <gnomon/gnomon.h>
#include <stdio.h>

int main(void)
{
    /* Two opaque casters that overlap, and a green glass: where each meets the line, and what it lets through. */
    gno_shadow_interval shadows[3] = {
        {7, 12, {0.2, 0.9, 0.2}},
        {2, 4, {0, 0, 0}},
        {3, 5, {0, 0, 0}}};
    gno_span_part parts[2 * 3 + 1];
    size_t count = gno_span_split(0, 10, shadows, 3, parts), i;
    for (i = 0; i < count; i++)
        printf("[%g, %g) light %g %g %g\n", parts[i].x0, parts[i].x1, parts[i].light[0], parts[i].light[1], parts[i].light[2]);
    return 0;
}
