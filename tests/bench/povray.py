"""povray.py -- a view of the ray-traced peer as a scene for POV-Ray, and its time. Rough: one sample a pixel, flat or smooth triangles, the
same lights and view; finish as near as POV-Ray comes. Place: under bench.py."""
import json, os, re, subprocess, time

MOST_TRIANGLES = 300000  # its parser takes minutes for more


def vector(v):
    return "<" + ",".join(f"{x:.7g}" for x in v) + ">"


def read_obj(path):
    """Positions, and fans of triangles by material; no normals: all are flat."""
    points, parts, current, library = [], {}, "", None
    with open(path, errors="replace") as f:
        for line in f:
            words = line.split()
            if not words:
                continue
            if words[0] == "v":
                points.append([float(x) for x in words[1:4]])
            elif words[0] == "usemtl":
                current = words[1]
            elif words[0] == "mtllib":
                library = words[1]
            elif words[0] == "f":
                corners = [int(w.split("/")[0]) for w in words[1:]]
                corners = [c - 1 if c > 0 else len(points) + c for c in corners]
                fan = parts.setdefault(current, [])
                fan.extend((corners[0], corners[k], corners[k + 1]) for k in range(1, len(corners) - 1))
    return points, parts, library


def read_colours(path):
    colours, current = {}, None
    if path and os.path.exists(path):
        with open(path, errors="replace") as f:
            for line in f:
                words = line.split()
                if words[:1] == ["newmtl"]:
                    current = words[1]
                elif words[:1] == ["Kd"] and current:
                    colours[current] = [float(x) for x in words[1:4]]
    return colours


def write_scene(view, folder, size, path):
    """0 when the scene is too large for it."""
    points, parts, library = read_obj(os.path.join(folder, view["obj"]))
    if sum(len(p) for p in parts.values()) > MOST_TRIANGLES:
        return 0
    colours = read_colours(os.path.join(folder, library) if library else None)
    with open(path, "w") as f:
        # Right-handed, as the view is: POV-Ray's own axes are not.
        f.write(f"#version 3.7;\nglobal_settings {{ assumed_gamma 1 }}\nbackground {{ rgb {vector(view['background'])} }}\n")
        f.write(f"camera {{ perspective location {vector(view['eye'])} sky {vector(view['up'])} right -x*{size[0] / size[1]:.6f} up y "
                f"angle degrees(2*atan(tan(radians({view['vfov_deg']}/2))*{size[0] / size[1]:.6f})) look_at {vector(view['target'])} }}\n")
        for light in view["lights"]:
            if light["type"].startswith("dir"):
                place = [1e5 * x for x in light["to_light"]]
                f.write(f"light_source {{ {vector(place)} rgb {vector(light['color'])} parallel point_at 0 }}\n")
            else:
                f.write(f"light_source {{ {vector(light['pos'])} rgb {vector(light['color'])} }}\n")
        for name, triangles in parts.items():
            used = sorted({c for t in triangles for c in t})
            place = {c: i for i, c in enumerate(used)}
            f.write(f"mesh2 {{ vertex_vectors {{ {len(used)},{','.join(vector(points[c]) for c in used)} }}\n face_indices {{ {len(triangles)},")
            f.write(",".join(vector([place[c] for c in t]) for t in triangles))
            f.write(f" }}\n pigment {{ rgb {vector(colours.get(name, [0.7, 0.7, 0.7]))} }} finish {{ ambient 0 diffuse 1 emission {vector(view['ambient'])} }} }}\n")
    return 1


def seconds(povray, view_path, size, threads, out):
    """Whole process, least of two; None where it is not measured."""
    with open(view_path) as f:
        view = json.load(f)
    scene, picture = os.path.join(out, "povray.pov"), os.path.join(out, "povray.png")
    if not write_scene(view, os.path.dirname(view_path), size, scene):
        return None
    best = None
    for _ in range(2):
        begun = time.perf_counter()
        done = subprocess.run([povray, f"+I{scene}", f"+O{picture}", f"+W{size[0]}", f"+H{size[1]}", "-A", "-D", f"+WT{threads}", "-GA"],
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        if done.returncode != 0:
            print("SKIP POV-Ray:", (re.findall(r".*[Ee]rror.*", done.stderr) or ["it failed"])[0])
            return None
        took = time.perf_counter() - begun
        best = took if best is None or took < best else best
    return best
