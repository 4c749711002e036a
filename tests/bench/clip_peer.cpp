// clip_peer.cpp -- see clip_peer.h. Debian's libpolyclipping-dev (Clipper 6).
#include "bench/clip_peer.h"

#include <cmath>
#include <ctime>
#include <polyclipping/clipper.hpp>

static double now()
{
    timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static ClipperLib::Paths to_paths(const gno_shape *s, double scale)
{
    ClipperLib::Paths paths(s->ring_count);
    for (size_t r = 0; r < s->ring_count; r++)
        for (size_t i = s->ring_start[r]; i < s->ring_start[r + 1]; i++)
            paths[r].push_back(ClipperLib::IntPoint(std::llround(s->points[2 * i] * scale), std::llround(s->points[2 * i + 1] * scale)));
    return paths;
}

double peer_clip(gno_clip_op op, const gno_shape *subject, const gno_shape *clip, double scale, double *seconds)
{
    ClipperLib::Paths a = to_paths(subject, scale), b, result;
    double area = 0, start;
    if (clip)
        b = to_paths(clip, scale);
    start = now();
    {
        ClipperLib::Clipper clipper;
        clipper.AddPaths(a, ClipperLib::ptSubject, true);
        if (clip)
            clipper.AddPaths(b, ClipperLib::ptClip, true);
        clipper.Execute(op == GNO_CLIP_UNION          ? ClipperLib::ctUnion
                        : op == GNO_CLIP_INTERSECTION ? ClipperLib::ctIntersection
                                                      : ClipperLib::ctDifference,
                        result, ClipperLib::pftNonZero, ClipperLib::pftNonZero);
    }
    *seconds += now() - start;
    for (size_t i = 0; i < result.size(); i++)
        area += ClipperLib::Area(result[i]);
    return area / (scale * scale);
}
