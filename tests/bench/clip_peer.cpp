// clip_peer.cpp -- see clip_peer.h. Debian's libpolyclipping-dev (Clipper 6), or Clipper2 with -DPEER_CLIPPER2.
#include "bench/clip_peer.h"

#include <cmath>
#include <ctime>
#ifdef PEER_CLIPPER2
#include <clipper2/clipper.h>
namespace lib = Clipper2Lib;
typedef lib::Paths64 paths_type;
typedef lib::Point64 point_type;
const char *const peer_name = "Clipper2";
#else
#include <polyclipping/clipper.hpp>
namespace lib = ClipperLib;
typedef lib::Paths paths_type;
typedef lib::IntPoint point_type;
const char *const peer_name = "Clipper 6";
#endif

static double now()
{
    timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static paths_type to_paths(const gno_shape *s, double scale)
{
    paths_type paths(s->ring_count);
    for (size_t r = 0; r < s->ring_count; r++)
        for (size_t i = s->ring_start[r]; i < s->ring_start[r + 1]; i++)
            paths[r].push_back(point_type(std::llround(s->points[2 * i] * scale), std::llround(s->points[2 * i + 1] * scale)));
    return paths;
}

#ifdef PEER_CLIPPER2
static void run(gno_clip_op op, const paths_type &a, const paths_type &b, paths_type &result)
{
    lib::Clipper64 clipper;
    clipper.AddSubject(a);
    clipper.AddClip(b);
    clipper.Execute(op == GNO_CLIP_UNION          ? lib::ClipType::Union
                    : op == GNO_CLIP_INTERSECTION ? lib::ClipType::Intersection
                                                  : lib::ClipType::Difference,
                    lib::FillRule::NonZero, result);
}
#else
static void run(gno_clip_op op, const paths_type &a, const paths_type &b, paths_type &result)
{
    lib::Clipper clipper;
    clipper.AddPaths(a, lib::ptSubject, true);
    clipper.AddPaths(b, lib::ptClip, true);
    clipper.Execute(op == GNO_CLIP_UNION ? lib::ctUnion : op == GNO_CLIP_INTERSECTION ? lib::ctIntersection : lib::ctDifference, result,
                    lib::pftNonZero, lib::pftNonZero);
}
#endif

double peer_clip(gno_clip_op op, const gno_shape *subject, const gno_shape *clip, double scale, double *seconds)
{
    paths_type a = to_paths(subject, scale), b, result;
    double area = 0, start;
    if (clip)
        b = to_paths(clip, scale);
    start = now();
    run(op, a, b, result);
    *seconds += now() - start;
    for (size_t i = 0; i < result.size(); i++)
        area += lib::Area(result[i]);
    return area / (scale * scale);
}
