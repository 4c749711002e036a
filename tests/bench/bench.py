"""bench.py -- gnomon beside its peers, on the same views, in one run. Started by bench.sh, which builds and installs what it needs.

Prints a Markdown report; writes report.md, bench.csv and bench.svg (error against time) into OUT. The first call on a machine also makes
the converged references that are not given, with the peer, and keeps them in OUT/reference. Environment: see bench.sh.
"""
import csv, json, math, os, shutil, statistics, subprocess, sys, time

import plot
import povray

GNOMON, PEER, COMPARE, TOWN, POVRAY = (os.environ.get(k, "") for k in ("GNOMON", "PEER", "COMPARE", "TOWN", "POVRAY"))
OUT, SHARED = os.environ["OUT"], os.environ["SHARED"]
REPEATS = int(os.environ.get("REPEATS", "3"))
WORK = os.path.join(OUT, "scenes")
FULL_HD, UHD = (1920, 1080), (3840, 2160)

# Settings of the peer: samples a pixel, or base:threshold@samples (that many where the base samples around a pixel span more).
ALIKE, ADAPTIVE = ["1", "4", "16", "64", "256"], ["1:.05@64", "1:.02@64", "4:.02@64", "4:.01@256"]
# The slowest settings are run so often at most.
SELDOM = {"16": 2, "64": 2, "256": 1, ADAPTIVE[-1]: 2}
ALL_SCENES = ["room", "bunny", "sponza", "town-1k", "town-10k", "town-100k", "town-1m", "dragon"]
TOWNS = {"town-1k": 1000, "town-10k": 10000, "town-100k": 100000, "town-1m": 1000000}
GIVEN = {"room": "cornell", "bunny": "bunny", "dragon": "dragon"}

rows, report, plots, missed = [], [], {}, []


def say(line=""):
    print(line, flush=True)
    report.append(line)


def run(arguments, **more):
    return subprocess.run(arguments, check=True, stdout=subprocess.PIPE, text=True, **more).stdout


def least_median(values):
    return min(values), statistics.median(values)


def record(scene, size, threads, tool, setting, seconds, rms=None, stages=None):
    low, middle = least_median(seconds)
    rows.append({"scene": scene, "width": size[0], "height": size[1], "threads": threads, "tool": tool, "setting": setting,
                 "least_s": f"{low:.5f}", "median_s": f"{middle:.5f}", "rms": "" if rms is None else f"{rms:.3g}",
                 **{k: f"{v:.6f}" for k, v in (stages or {}).items()}})
    return low, middle


# ---- scenes ---------------------------------------------------------------------------------------------------------

SPONZA_LIGHTS = [("directional", (0.3, -1, 0.25), (0.5, 0.48, 0.42)), ("point", (-9, 6, 0.5), (0.3, 0.3, 0.28)), ("point", (6, 4, -1), (0.25, 0.26, 0.3))]


def write_sponza(folder):
    """Without textures, which the peer has not; the same triangles, lights and view for both."""
    source = os.path.join(SHARED, "data/scenes/sponza_dabrovic")
    shutil.copy(os.path.join(source, "sponza.obj"), folder)
    with open(os.path.join(source, "sponza.mtl"), errors="replace") as old, open(os.path.join(folder, "sponza.mtl"), "w") as new:
        for line in old:
            word = line.split()[0].lower() if line.split() else ""
            if word == "kd":
                new.write("Ka" + line.strip()[2:] + "\n")
            if word not in ("ka", "d", "tr", "illum", "bump") and not word.startswith("map_"):
                new.write(line)
    eye, target, ambient, sky = (-11.5, 3.2, 0.6), (5, 4.2, -0.8), 0.25, (0.5, 0.65, 0.85)
    yaml = ["gnomon: 1", f"image: {{width: 1920, height: 1080, background: {list(sky)}}}",
            f"camera: {{eye: {list(eye)}, target: {list(target)}, up: [0, 1, 0], fov: 62}}", f"ambient: {ambient}", "lights:"]
    lights = []
    for kind, place, colour in SPONZA_LIGHTS:
        sun = kind == "directional"
        yaml.append(f"  - {{type: {kind}, {'direction' if sun else 'position'}: {list(place)}, intensity: {list(colour)}}}")
        lights.append({"type": kind, "to_light" if sun else "pos": [-x for x in place] if sun else list(place), "color": list(colour)})
    yaml += ["objects:", "  - {mesh: sponza.obj, shading: flat}"]
    view = {"obj": "sponza.obj", "smooth": 0, "eye": eye, "target": target, "up": (0, 1, 0), "vfov_deg": 62, "width": 1920, "height": 1080,
            "background": sky, "ambient": [ambient] * 3, "lights": lights}
    with open(os.path.join(folder, "sponza.yaml"), "w") as f:
        f.write("\n".join(yaml) + "\n")
    with open(os.path.join(folder, "sponza.json"), "w") as f:
        json.dump(view, f)


def make_scene(name):
    """Files of the scene; returns (yaml, json, given reference or None), or None where data are missing."""
    folder = os.path.join(WORK, name)
    os.makedirs(folder, exist_ok=True)
    data = os.path.join(SHARED, "data/reference")
    if name in TOWNS:
        if not os.path.exists(os.path.join(folder, "town.json")):
            run([TOWN, str(TOWNS[name]), "3", folder])
        return os.path.join(folder, "town.yaml"), os.path.join(folder, "town.json"), None
    if name == "sponza":
        if not os.path.exists(os.path.join(SHARED, "data/scenes/sponza_dabrovic/sponza.obj")):
            return None
        write_sponza(folder)
        return os.path.join(folder, "sponza.yaml"), os.path.join(folder, "sponza.json"), None
    base = GIVEN[name]
    if not os.path.exists(os.path.join(data, base + ".yaml")):
        return None
    for ending in ("yaml", "json", "mtl", "obj"):
        source = os.path.join(data, f"{base}.{ending}")
        if os.path.exists(source):
            shutil.copy(source, folder)
    if not os.path.exists(os.path.join(folder, base + ".obj")):
        with open(os.path.join(folder, base + ".obj"), "wb") as f:
            subprocess.run(["xz", "-dc", os.path.join(data, base + ".obj.xz")], check=True, stdout=f)
    return tuple(os.path.join(folder, f"{base}.{e}") for e in ("yaml", "json")) + (os.path.join(data, base + ".exr"),)


def reference(name, view, given):
    if given:
        return given
    path = os.path.join(OUT, "reference", name + ".pfm")
    if not os.path.exists(path) and PEER:
        os.makedirs(os.path.dirname(path), exist_ok=True)
        print(f"making the reference of {name}: 256 samples a pixel, 4096 at edges ...", file=sys.stderr, flush=True)
        run([PEER, view, "-R", "-B", "-e", "1e-7", "-m", "jitter", "-a", "256:0.01", "-s", "4096", "-o", path + ".part"])
        os.rename(path + ".part", path)
    return path if os.path.exists(path) else None


# ---- the tools ------------------------------------------------------------------------------------------------------

def gnomon_once(scene, size, threads, picture):
    """Stages and the whole process's seconds."""
    stats = os.path.join(OUT, "stats.json")
    begun = time.perf_counter()
    run([GNOMON, "render", scene, "-o", picture, "--size", f"{size[0]}x{size[1]}", "--threads", str(threads), "--quiet", "--stats", stats])
    whole = time.perf_counter() - begun
    with open(stats) as f:
        found = json.load(f)
    return dict(found["seconds"], process=whole, memory=found["peak_memory"])


def peer_once(view, size, threads, setting, picture=None):
    arguments = [PEER, view, "-t", str(threads), "-W", str(size[0]), "-H", str(size[1])]
    arguments += ["-a", setting.split("@")[0], "-s", setting.split("@")[1]] if "@" in setting else ["-s", setting]
    found = json.loads(run(arguments + (["-o", picture] if picture else [])))
    return found["build_s"] + found["trace_best_s"], found["build_s"]


def rms_of(picture, against):
    return float(run([COMPARE, picture, against]).split()[0]) if against else None


# ---- one scene ------------------------------------------------------------------------------------------------------

def at_error(curve, error):
    """Seconds at which a curve of (seconds, error), all pixels alike, comes down to the error: straight in logarithms, also beyond its end."""
    points = sorted((s, e) for s, e in curve if e and e > 0)
    if len(points) < 2 or not error:
        return None
    for (s0, e0), (s1, e1) in zip(points, points[1:]):
        if e1 <= error or (s1, e1) == points[-1]:
            if e0 == e1:
                return None
            share = (math.log(error) - math.log(e0)) / (math.log(e1) - math.log(e0))
            return s0 if share < 0 else math.exp(math.log(s0) + share * (math.log(s1) - math.log(s0)))
    return None


def best_adaptive(points, error):
    """The fastest adaptive setting that is about as good (a tenth worse is let pass), and ""; where none is, what the line through the best ones
    comes to, and "~"."""
    good = [s for s, e in points if e and error and e <= 1.1 * error]
    if good:
        return min(good), ""
    best = [(s, e) for s, e in points if e and not any(s2 < s and e2 < e for s2, e2 in points if e2)]
    return at_error(best, error), "~"


def ratio(theirs, ours, mark=""):
    return f"{mark}{theirs / ours:.1f}" if theirs and ours else "-"


def measure(name, files, size, threads, settings, against, errors):
    """Errors that are known already, as they are of another number of threads, are not measured again."""
    scene, view, _ = files
    picture = os.path.join(OUT, "gnomon.pfm")
    times, ours, theirs, builds = {}, [], {s: [] for s in settings}, []
    errors = dict(errors)
    for i in range(REPEATS):  # one after the other, so that a busy moment meets all alike
        ours.append(gnomon_once(scene, size, threads, picture))
        for s in settings if PEER else []:
            if i >= SELDOM.get(s, REPEATS):
                continue
            peer_picture = os.path.join(OUT, "peer.pfm") if against and s not in errors else None
            seconds, build = peer_once(view, size, threads, s, peer_picture)
            theirs[s].append(seconds)
            builds.append(build)
            if peer_picture:
                errors[s] = rms_of(peer_picture, against)
    rms = rms_of(picture, against) if against else None
    stages = {k: least_median([o[k] for o in ours])[0] for k in ("load", "prepare", "shadow", "project", "scan", "render", "write")}
    low, middle = record(name, size, threads, "gnomon", "default", [o["render"] for o in ours], rms, stages)
    for s in settings:
        if theirs[s]:
            times[s] = record(name, size, threads, "embree", s, theirs[s], errors.get(s))
    os.remove(picture)
    return {"stages": stages, "low": low, "median": middle, "rms": rms, "times": times, "errors": errors, "bvh": min(builds) if builds else None}


def tell(name, size, threads, m, pov):
    s = m["stages"]
    say(f"| {name} | {size[0]}x{size[1]} | {threads} | {s['prepare']:.3f} | {s['shadow']:.3f} | {s['project']:.3f} | {s['scan']:.3f} | "
        f"{m['low']:.3f} / {m['median']:.3f} | {ratio(m['times'].get('1', (None,))[0], m['low'])} | {pov or '-'} |")


# What a scene is held to at equal error, in the peer's time: all pixels alike, and its best adaptive setting.
MOST_SCENES, FEW_POLYGONS, FEW_NAMES = (10, 1), (20, 2), ("room", "town-1k", "town-10k")


def judge_speed(name, threads, m, alike, best):
    for what, theirs, least in zip(("all pixels alike", "the best adaptive setting"), (alike, best), FEW_POLYGONS if name in FEW_NAMES else MOST_SCENES):
        if theirs and theirs < least * m["low"]:
            missed.append(f"{name}, {threads} threads: {theirs / m['low']:.1f} times as fast as {what}, at least {least}")


def tell_errors(name, threads, m):
    curve = [(m["times"][s][0], m["errors"].get(s)) for s in ALIKE if s in m["times"]]
    adaptive = [(m["times"][s][0], m["errors"].get(s)) for s in ADAPTIVE if s in m["times"]]
    alike, (best, mark) = at_error(curve, m["rms"]), best_adaptive(adaptive, m["rms"])
    cells = [f"{m['errors'][s]:.5f} {m['times'][s][0]:.2f}" if s in m["errors"] else "-" for s in ALIKE + ADAPTIVE]
    bound = m["errors"].get("64")
    good = "" if bound is None or m["rms"] is None else "yes" if m["rms"] <= bound else "NO"
    if good == "NO":
        missed.append(f"{name}: error {m['rms']:.5f} above the peer's at 64 samples, {bound:.5f}")
    judge_speed(name, threads, m, alike, best)
    say(f"| {name} | {threads} | {m['rms']:.5f} {m['low']:.3f} | " + " | ".join(cells) + f" | {good} | {ratio(alike, m['low'])} | {ratio(best, m['low'], mark)} |")
    if name not in plots:
        plots[name] = {"gnomon": [(m["low"], m["rms"])], "alike": curve, "adaptive": adaptive}


def pictures(names, sizes, threads, settings, with_povray):
    results = {}
    say("\n## Pictures\n\nSeconds, least of the repeats; `render` is everything but reading and writing files, least / median. The ratio is the"
        " peer's time at one sample a pixel, BVH included, to gnomon's. POV-Ray: one sample a pixel, its own time, least.\n")
    say("| scene | size | threads | prepare | shadow | project | scan | render | peer at 1 / gnomon | POV-Ray |\n|---|---|---|---|---|---|---|---|---|---|")
    for name in names:
        files = make_scene(name)
        if not files:
            say(f"| {name} | SKIP: its data are not under {SHARED} |")
            continue
        for size in sizes:
            for t in threads:
                first = results.get((name, size, threads[0]), {"errors": {}})
                against = reference(name, files[1], files[2]) if size == FULL_HD else None
                m = measure(name, files, size, t, settings if size == FULL_HD else settings[:1], against, first["errors"])
                pov = None
                if with_povray and POVRAY and size == FULL_HD and t == threads[0]:
                    seconds = povray.seconds(POVRAY, files[1], size, t, OUT)
                    if seconds is not None:
                        record(name, size, t, "povray", "1", [seconds])
                        pov = f"{seconds:.1f}"
                tell(name, size, t, m, pov)
                results[name, size, t] = m
    say("\n## Error and time at 1920x1080\n\nSeconds of the peer with its BVH. RMS error over all pixels and channels against the converged reference, and seconds. `64`: is gnomon's error at most the"
        " peer's at 64 samples; `alike`: the peer's time at gnomon's error with all pixels alike (its curve, straight in logarithms) to gnomon's;"
        " `adaptive`: that of its fastest adaptive setting that is as good (~: none is; as far as the line through its best ones tells).\n")
    say("| scene | threads | gnomon | " + " | ".join(f"peer {s}" for s in ALIKE + ADAPTIVE) + " | 64 | alike | adaptive |\n|" + "---|" * (6 + len(ALIKE + ADAPTIVE)))
    for t in threads:
        for (name, size, of), m in results.items():
            if m["rms"] is not None and t == of:
                tell_errors(name, t, m)
    if len(threads) > 1:
        say("\n## Two threads\n\n| scene | size | one thread / two |\n|---|---|---|")
        for (name, size, t), m in results.items():
            if t == 1 and (name, size, 2) in results:
                say(f"| {name} | {size[0]}x{size[1]} | {m['low'] / results[name, size, 2]['low']:.2f} |")


# ---- the matrix, small things, second views ---------------------------------------------------------------------------

def matrix_once(scene, threads):
    stats, out = os.path.join(OUT, "stats.json"), os.path.join(OUT, "m.mtx")
    run([GNOMON, "matrix", scene, "-o", out, "--threads", str(threads), "--quiet", "--stats", stats])
    os.remove(out)
    with open(stats) as f:
        return json.load(f)


# What the matrix is held to, from so many polygons on: the time of the peer's BVH, twice; bytes a polygon at the peak; growth a doubling.
LARGE_MATRIX, MOST_BVH, MOST_BYTES, MOST_GROWTH = 100000, 2, 400, 2.3


def judge_matrix(name, threads, n, of_bvh, peak, growth):
    if n < LARGE_MATRIX:
        return
    for what, found, most in (("times the peer's BVH", of_bvh, MOST_BVH), ("bytes a polygon", peak, MOST_BYTES), ("times a doubling", growth, MOST_GROWTH)):
        if found is not None and found > most:
            missed.append(f"matrix of {name}, {threads} threads: {found:.2f} {what}, at most {most}")


def matrix(names, threads):
    say("\n## The shadow matrix of one light\n\nSeconds to build, the scene being prepared, beside the peer's BVH of the same polygons; least / median. Bytes a polygon:"
        " the matrix alone, and the most that the process held.\n")
    say("| scene | threads | polygons | ones | prepare | build | BVH | build / BVH | bytes | peak | growth |\n|---|---|---|---|---|---|---|---|---|---|---|")
    for t in threads:
        before = None
        for name in names:
            files = make_scene(name)
            if not files:
                continue
            found, bvh = [], []
            for _ in range(REPEATS):
                found.append(matrix_once(files[0], t))
                if PEER:
                    bvh.append(peer_once(files[1], (16, 9), t, "1")[1])
            builds = [f["seconds"]["build"] for f in found]
            low, middle = record(name, (0, 0), t, "gnomon matrix", "build", builds)
            if bvh:
                record(name, (0, 0), t, "embree", "bvh", bvh)
            n, one = found[0]["polygons"], found[0]
            growth = low / before[1] if before and 1.9 < n / before[0] < 2.1 else None
            before = n, low
            judge_matrix(name, t, n, low / min(bvh) if bvh else None, one["peak_memory"] / n, growth)
            say(f"| {name} | {t} | {n} | {one['counts']['ones']} | {least_median([f['seconds']['prepare'] for f in found])[0]:.3f} | {low:.3f} / {middle:.3f} | "
                + (f"{min(bvh):.3f} / {statistics.median(bvh):.3f} | {low / min(bvh):.2f}" if bvh else "- | -")
                + f" | {one['matrix_bytes'] / n:.0f} | {one['peak_memory'] / n:.0f} | " + (f"{growth:.2f} |" if growth else "- |"))


def small():
    scene = os.path.join(OUT, "small.yaml")
    faces = [[(-1, -1), (1, -1), (1, 1), (-1, 1)]]
    with open(scene, "w") as f:
        f.write("gnomon: 1\nimage: {width: 320, height: 240}\nambient: 0.2\nlights:\n  - {type: point, position: [2, -3, 5]}\n  - {type: directional, direction: [-1, 1, -2]}\nobjects:\n")
        f.write("  - {polygon: [[-6,-6,0],[6,-6,0],[6,6,0],[-6,6,0]]}\n")
        for i in range(19):
            x, y, z = (i % 5) - 2, i // 5 - 2, 0.2 + 0.1 * i
            f.write(f"  - {{polygon: [[{x},{y},{z}],[{x + 0.8},{y},{z}],[{x + 0.8},{y + 0.8},{z + 0.3}],[{x},{y + 0.8},{z + 0.3}]]}}\n")
    times = []
    for _ in range(30):
        begun = time.perf_counter()
        subprocess.run([GNOMON, "render", scene, "-o", os.path.join(OUT, "small.png"), "--quiet"], check=True)
        times.append(time.perf_counter() - begun)
    low, middle = record("small", (320, 240), 0, "gnomon", "whole process", times)
    say(f"\n## Small things\n\n20 polygons, two lights, 320x240, the whole process with reading and writing: {1000 * low:.1f} ms least, {1000 * middle:.1f} ms median of 30.")
    if low > 0.015:
        missed.append(f"20 polygons took {1000 * low:.1f} ms")


def second_view(name):
    files = make_scene(name)
    if not files:
        return
    stats = os.path.join(OUT, "stats.json")
    run([GNOMON, "render", files[0], "-o", os.path.join(OUT, "view_%d.png"), "--size", "960x540", "--set", "camera.path={frames: 3, angle: 3}", "--quiet", "--stats", stats])
    with open(stats) as f:
        frames = json.load(f)["frames"]
    say(f"\n## A second view ({name}, 960x540)\n\n| frame | prepare | shadow | shadows built | project | scan |\n|---|---|---|---|---|---|")
    for f in frames:
        s = f["seconds"]
        say(f"| {f['frame']} | {s['prepare']:.4f} | {s['shadow']:.4f} | {f['counts']['shadows_built']:.0f} | {s['project']:.4f} | {s['scan']:.4f} |")


# ---- the run ----------------------------------------------------------------------------------------------------------

def main():
    words = sys.argv[1:] or ["full"]
    known = ["full", "quick", "matrix", "small", "views"] + ALL_SCENES
    wrong = [w for w in words if w not in known]
    if wrong:
        sys.exit(f"bench: {wrong[0]} is not one of {', '.join(known)}")
    full, quick = "full" in words, "quick" in words
    for size in (125000, 250000, 500000):
        TOWNS[f"town-{size // 1000}k"] = size
    say(f"# gnomon beside its peers\n\n{run(['uname', '-srm']).strip()}, {os.cpu_count()} processors, {time.strftime('%Y-%m-%d')}, {REPEATS} repeats")
    for tool, there in (("Embree", PEER), ("POV-Ray", POVRAY)):
        if not there:
            say(f"SKIP {tool}: not there; its columns stay empty")
    names = ALL_SCENES if full else ["room", "bunny", "town-1k"] if quick else [n for n in ALL_SCENES if n in words]
    if names:
        pictures(names, [FULL_HD, UHD] if full else [FULL_HD], [1, 2] if full or quick else [1], (ALIKE + ADAPTIVE) if not quick else ["1", "4", "16", "1:.05@64"], not quick)
    if full or quick or "matrix" in words:
        matrix(["town-10k"] if quick else ["town-125k", "town-250k", "town-500k", "town-1m", "dragon"], [1, 2])
    if full or quick or "small" in words:
        small()
    if full or quick or "views" in words:
        second_view("town-1k" if quick else "town-100k")
    if missed:
        say("\nMissed: " + "; ".join(missed))
    fields = ["scene", "width", "height", "threads", "tool", "setting", "least_s", "median_s", "rms", "load", "prepare", "shadow", "project", "scan", "render", "write"]
    with open(os.path.join(OUT, "bench.csv"), "w", newline="") as f:
        writer = csv.DictWriter(f, fields)
        writer.writeheader()
        writer.writerows(rows)
    with open(os.path.join(OUT, "report.md"), "w") as f:
        f.write("\n".join(report) + "\n")
    if plots:
        plot.write(os.path.join(OUT, "bench.svg"), plots)
    print(f"\n{OUT}/report.md, bench.csv" + (" and bench.svg" if plots else ""))
    return 1 if missed else 0


sys.exit(main())
