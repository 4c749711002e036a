#!/usr/bin/env python3
"""Writes the computed files of this folder: sundial.yaml, house.yaml, town_*.obj, and the small models that the scenes use.

The results are kept beside it, so nothing else needs Python. Run it here: python3 make_models.py
"""
import math
import random


def number(x, digits=4):
    text = f"{x:.{digits}f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def point(p, digits=4):
    return "[" + ", ".join(number(x, digits) for x in p) + "]"


def ring(points, digits=4):
    return "[" + ", ".join(point(p, digits) for p in points) + "]"


class Obj:
    """Faces by material, with or without normals."""

    def __init__(self, what, mtl=None, digits=4):
        self.what, self.mtl, self.digits = what, mtl, digits
        self.vertices, self.normals, self.faces = {}, {}, []

    def vertex(self, p):
        return self.vertices.setdefault(" ".join(number(x, self.digits) for x in p), len(self.vertices) + 1)

    def normal(self, n):
        return self.normals.setdefault(" ".join(number(x, 4) for x in n), len(self.normals) + 1)

    def face(self, points, material=None, normals=None):
        corners = [str(self.vertex(p)) for p in points]
        if normals:
            corners = [f"{c}//{self.normal(n)}" for c, n in zip(corners, normals)]
        self.faces.append((material, " ".join(corners)))

    def box(self, low, high, material=None, turn=0, about=(0, 0)):
        """Turned by `turn` radians about the vertical through `about`; wound outwards."""
        c, s = math.cos(turn), math.sin(turn)

        def at(i):
            x, y, z = (high[k] if i >> k & 1 else low[k] for k in range(3))
            x, y = x - about[0], y - about[1]
            return (about[0] + c * x - s * y, about[1] + s * x + c * y, z)

        for f in ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)):
            self.face([at(i) for i in f], material)

    def write(self, path):
        with open(path, "w") as out:
            out.write(f"# {self.what}\n# written by make_models.py\n")
            if self.mtl:
                out.write(f"mtllib {self.mtl}\n")
            out.writelines(f"v {v}\n" for v in self.vertices)
            out.writelines(f"vn {n}\n" for n in self.normals)
            last = None
            for material, corners in sorted(self.faces, key=lambda f: f[0] or ""):
                if material != last:
                    out.write(f"usemtl {material}\n")
                    last = material
                out.write(f"f {corners}\n")


# ---- sundial -----------------------------------------------------------------------------------------------------------

LATITUDE, DAY, HOUR = 48.2, 121, 15.0  # Vienna, 1 May (the 121st day), three in the afternoon by the sun


def sun_direction():
    """The way sunlight travels; x east, y north, z up."""
    phi, hour = math.radians(LATITUDE), math.radians(15 * (HOUR - 12))
    declination = -math.radians(23.44) * math.cos(math.radians(360 / 365 * (DAY + 10)))
    east = -math.cos(declination) * math.sin(hour)
    north = math.sin(declination) * math.cos(phi) - math.cos(declination) * math.cos(hour) * math.sin(phi)
    up = math.sin(declination) * math.sin(phi) + math.cos(declination) * math.cos(hour) * math.cos(phi)
    return math.degrees(declination), (-east, -north, -up)


def hour_angle(hour):
    """Where the shadow of the style lies at that hour: degrees from north towards east."""
    h = math.radians(15 * (hour - 12))
    return math.degrees(math.atan2(math.sin(math.radians(LATITUDE)) * math.sin(h), math.cos(h)))


def polar(r, degrees, z=0.0):
    a = math.radians(degrees)
    return (r * math.sin(a), r * math.cos(a), z)


def circle(r, z=0.0, n=96, turn=0.0):
    return [polar(r, turn - 360 * i / n, z) for i in range(n)]


def ray(degrees, r1, r2, width):
    """A strip along the direction, its middle line on it."""
    a = math.radians(degrees)
    along, across = (math.sin(a), math.cos(a)), (math.cos(a), -math.sin(a))
    return [(along[0] * r + across[0] * w, along[1] * r + across[1] * w, 0)
            for r, w in ((r1, -width / 2), (r1, width / 2), (r2, width / 2), (r2, -width / 2))]


STROKES = {"I": [((0, 0), (0, 1))], "V": [((-0.3, 1), (0, 0)), ((0.3, 1), (0, 0))],
           "X": [((-0.3, 1), (0.3, 0)), ((0.3, 1), (-0.3, 0))]}
WIDTHS = {"I": 0.3, "V": 0.78, "X": 0.8}
NUMERALS = ["XII", "I", "II", "III", "IIII", "V", "VI", "VII", "VIII", "IX", "X", "XI"]


def numeral(text, degrees, radius, size):
    """Strokes of a Roman numeral that stands on the circle, its foot to the middle."""
    a = math.radians(degrees)
    along, across = (math.sin(a), math.cos(a)), (math.cos(a), -math.sin(a))
    pen, at, strokes = 0.1 * size, -sum(WIDTHS[c] for c in text) / 2, []
    for letter in text:
        middle = at + WIDTHS[letter] / 2
        for (x0, y0), (x1, y1) in STROKES[letter]:
            corners = []
            for x, y, side in ((x0, y0, -1), (x0, y0, 1), (x1, y1, 1), (x1, y1, -1)):
                u, v = (middle + x) * size + side * pen / 2, radius + y * size
                corners.append((across[0] * u + along[0] * v, across[1] * u + along[1] * v, 0))
            strokes.append(corners)
        at += WIDTHS[letter]
    return strokes


SUNDIAL = """\
# A horizontal sundial for {latitude} degrees north on the 1st of May, at three o'clock in the afternoon by the sun.
# Written by make_models.py; x points east, y north, z up, the dial lies in z = 0 with the foot of the style at the origin.
#
# The style, the upper edge of the bronze triangle, is parallel to the earth's axis: it rises to the north at the angle of
# the latitude, phi = {latitude}. So the sun turns about it by 15 degrees an hour, and its shadow falls on the same line at the
# same hour on every day of the year:
#     tan(angle of the hour's line, from north) = sin(phi) tan(15 degrees (hour - 12)),
# which for three o'clock is atan(sin {latitude} * tan 45) = {line3} degrees to the east.
#
# The sun stands at the declination -23.44 cos(360/365 (121 + 10)) = {declination} degrees on the 121st day. With H = 45 degrees it is at
#     east  = -cos(decl) sin(H)
#     north =  sin(decl) cos(phi) - cos(decl) cos(H) sin(phi)
#     up    =  sin(decl) sin(phi) + cos(decl) cos(H) cos(phi),
# and its light travels the opposite way. tests/unit/test_scenes.c holds the scene to it: the shadow tells the right time.
gnomon: 1
image:   {{width: 1280, height: 720, background: [0.30, 0.46, 0.72]}}
camera:  {{eye: [1.12, -1.78, 1.12], target: [-0.01, 0.13, 0.06], up: [0, 0, 1], fov: 38}}
ambient: [0.30, 0.33, 0.40]
lights:
  - {{name: sun, type: directional, direction: {direction}, intensity: [1.0, 0.94, 0.82]}}
materials:
  lawn:   {{ambient: [0.10, 0.20, 0.05], diffuse: [0.13, 0.25, 0.06]}}
  hedge:  {{ambient: [0.05, 0.13, 0.04], diffuse: [0.06, 0.16, 0.05]}}
  bush:   {{ambient: [0.07, 0.16, 0.05], diffuse: [0.09, 0.20, 0.06], shading: phong}}
  gravel: {{ambient: [0.50, 0.46, 0.38], diffuse: [0.50, 0.46, 0.38]}}
  stone:  {{ambient: [0.56, 0.53, 0.48], diffuse: [0.56, 0.53, 0.48]}}
  dial:   {{ambient: [0.80, 0.76, 0.66], diffuse: [0.80, 0.76, 0.66]}}
  ink:    {{ambient: [0.07, 0.07, 0.10], diffuse: [0.07, 0.07, 0.10]}}
  gold:   {{ambient: [0.55, 0.36, 0.10], diffuse: [0.55, 0.36, 0.10]}}
  bronze: {{ambient: [0.34, 0.20, 0.08], diffuse: [0.38, 0.22, 0.09], specular: 0.25, shininess: 12}}
objects:
"""


def sundial():
    declination, direction = sun_direction()
    out = [SUNDIAL.format(latitude=LATITUDE, declination=number(declination, 3), line3=number(hour_angle(15), 3),
                          direction=point(direction, 9))]

    def add(points, material, name=None, more=""):
        label = f"name: {name}, " if name else ""
        out.append(f"  - {{{label}polygon: {ring(points, 5)}, material: {material}{more}}}\n")

    out.append("  # the garden: a lawn, a round of gravel on it, the pillar\n")
    add([(-40, -40, -1.1), (40, -40, -1.1), (40, 40, -1.1), (-40, 40, -1.1)], "lawn", "lawn")
    add(circle(2.1, -1.1, 64), "gravel", "gravel", ", detail_of: lawn")
    add([(-0.7, 2, -1.1), (0.7, 2, -1.1), (0.7, 40, -1.1), (-0.7, 40, -1.1)], "gravel", None, ", detail_of: lawn")
    for side in (-1, 1):  # a hedge with a gap for the path, and clipped bushes
        for a, b, y0, y1, top in ((0.9, 20, 5.2, 5.8, -0.15), (0.75, 1.35, 5.2, 5.8, -0.02)):
            x0, x1 = sorted((side * a, side * b))
            low, high = (x0, y0, -1.1), (x1, y1, top)
            for f in ((0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5), (4, 5, 7, 6)):
                add([tuple(high[k] if i >> k & 1 else low[k] for k in range(3)) for i in f], "hedge")
        out.append(f"  - {{sphere: {{center: {point((side * 1.05, 5.5, 0.28))}, radius: 0.36}}, material: bush}}\n")
        out.append(f"  - {{sphere: {{center: {point((side * 2.6, 3.6, -0.72))}, radius: 0.5}}, material: bush}}\n")

    def prism(r0, z0, r1, z1, n, material, turn):
        low, high = circle(r0, z0, n, turn), circle(r1, z1, n, turn)
        for i in range(n):
            j = (i + 1) % n
            add([low[j], low[i], high[i], high[j]], material)

    turn = 22.5
    prism(0.62, -1.1, 0.62, -0.98, 8, "stone", turn)
    add(circle(0.62, -0.98, 8, turn), "stone")
    prism(0.42, -0.98, 0.30, -0.3, 8, "stone", turn)
    prism(0.30, -0.3, 0.55, -0.09, 8, "stone", turn)
    add(circle(0.55, -0.09, 8, turn), "stone")
    out.append("  # the dial's plate: rim, underside, face\n")
    prism(0.86, -0.06, 0.86, 0, 96, "stone", 0)
    add(circle(0.86, -0.06), "stone")
    add(circle(0.86), "dial", "dial")
    out.append("  # rings, hour lines and numerals: details on the face\n")
    for outer, inner in ((0.83, 0.815), (0.64, 0.634)):
        add(circle(outer), "ink", None, f", holes: [{ring(circle(inner), 5)}], detail_of: dial")
    for half in range(10, 39):
        hour = half / 2
        angle = hour_angle(hour)
        if half % 2:
            add(ray(angle, 0.58, 0.634, 0.006), "ink", None, ", detail_of: dial")
            continue
        wide = 0.012 if hour % 3 == 0 else 0.008
        add(ray(angle, 0.12, 0.634, wide), "ink", f"hour{int(hour)}", ", detail_of: dial")
        for stroke in numeral(NUMERALS[int(hour) % 12], angle, 0.672, 0.105):
            add(stroke, "ink", None, ", detail_of: dial")
    out.append("  # a compass star on the southern half\n")
    for i in range(8):
        tip, side = (0.2, 0.055) if i % 2 == 0 else (0.12, 0.05)
        middle = (0, -0.37)
        a = 45 * i
        for s in (-1, 1):
            corners = [polar(0, 0), polar(tip, a), polar(side, a + 22.5 * s)]
            add([(x + middle[0], y + middle[1], 0) for x, y, _ in corners], "gold" if s > 0 else "ink", None, ", detail_of: dial")
    out.append("  # the gnomon: its long edge is the style\n")
    phi = math.radians(LATITUDE)
    length = 0.74
    tip = (0, length * math.cos(phi), length * math.sin(phi))
    back = tip[1] * 1.0
    shape = [(0, 0, 0), (0, back - 0.02, 0), (0, back - 0.02, 0.05), (0, back - 0.10, 0.12), (0, back - 0.12, 0.24),
             (0, back - 0.06, 0.38), tip]
    hole = [(0, 0.29 + 0.062 * math.cos(2 * math.pi * i / 24), 0.125 + 0.062 * math.sin(2 * math.pi * i / 24)) for i in range(24)]
    add(shape, "bronze", "gnomon", f", holes: [{ring(hole, 5)}]")
    with open("sundial.yaml", "w") as file:
        file.writelines(out)


# ---- house -------------------------------------------------------------------------------------------------------------

HOUSE = """\
# A house in section: its front wall is taken away and the cut walls are red. The sun stands behind it on the left and comes in
# through the windows: holes of the wall polygons, with their reveals, bars and the round one in the gable.
# Written by make_models.py; x to the right, y away from the viewer, z up, metres.
gnomon: 1
image:   {width: 1280, height: 720, background: [0.42, 0.58, 0.80]}
camera:  {eye: [9.2, -14.2, 5.3], target: [4.15, 2.5, 2.95], up: [0, 0, 1], fov: 32}
ambient: [0.34, 0.37, 0.44]
lights:
  - {name: sun, type: directional, direction: [0.80, -0.24, -0.50], intensity: [1.15, 1.0, 0.74]}
materials:
  lawn:    {ambient: [0.16, 0.27, 0.07], diffuse: [0.17, 0.30, 0.08]}
  path:    {ambient: [0.50, 0.46, 0.38], diffuse: [0.50, 0.46, 0.38]}
  render:  {ambient: [0.82, 0.77, 0.66], diffuse: [0.82, 0.77, 0.66]}
  plaster: {ambient: [0.84, 0.82, 0.78], diffuse: [0.84, 0.82, 0.78]}
  cut:     {ambient: [0.62, 0.10, 0.07], diffuse: [0.50, 0.08, 0.06]}
  boards:  {ambient: [0.52, 0.31, 0.14], diffuse: [0.56, 0.34, 0.16]}
  beam:    {ambient: [0.34, 0.20, 0.09], diffuse: [0.36, 0.21, 0.10]}
  tiles:   {ambient: [0.55, 0.19, 0.11], diffuse: [0.60, 0.21, 0.12]}
  white:   {ambient: [0.90, 0.90, 0.88], diffuse: [0.90, 0.90, 0.88]}
  blue:    {ambient: [0.13, 0.24, 0.45], diffuse: [0.13, 0.24, 0.45]}
  cloth:   {ambient: [0.70, 0.22, 0.16], diffuse: [0.70, 0.22, 0.16]}
objects:
"""


class Scene:
    """Lines of a scene file's objects."""

    def __init__(self):
        self.lines = []

    def note(self, text):
        self.lines.append(f"  # {text}\n")

    def polygon(self, points, material, holes=(), more=""):
        cut = f", holes: [{', '.join(ring(h) for h in holes)}]" if holes else ""
        self.lines.append(f"  - {{polygon: {ring(points)}{cut}, material: {material}{more}}}\n")

    def box(self, low, high, material, front=None):
        for f, m in (((0, 2, 3, 1), material), ((4, 5, 7, 6), material), ((0, 1, 5, 4), front or material),
                     ((2, 6, 7, 3), material), ((0, 4, 6, 2), material), ((1, 3, 7, 5), material)):
            self.polygon([tuple(high[k] if i >> k & 1 else low[k] for k in range(3)) for i in f], m)

    def bar(self, a, b, size, material):
        """A square bar from a to b that lies in a plane of constant x."""
        length = math.hypot(b[1] - a[1], b[2] - a[2])
        v = ((b[2] - a[2]) / length * size / 2, -(b[1] - a[1]) / length * size / 2)
        ends = [[(p[0] + sx * size / 2, p[1] + sv * v[0], p[2] + sv * v[1]) for sx, sv in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
                for p in (a, b)]
        for i in range(4):
            j = (i + 1) % 4
            self.polygon([ends[0][i], ends[0][j], ends[1][j], ends[1][i]], material)

    def wall(self, place, outline, holes, outer, inner, thickness, reveal="white"):
        """A wall with holes: place(u, v, d) puts the point u along, v up, d deep into the wall in space."""
        for depth, material in ((0, outer), (thickness, inner)):
            self.polygon([place(u, v, depth) for u, v in outline], material,
                         [[place(u, v, depth) for u, v in h] for h in holes])
        for h in holes:
            for (u0, v0), (u1, v1) in zip(h, h[1:] + h[:1]):
                self.polygon([place(u0, v0, 0), place(u1, v1, 0), place(u1, v1, thickness), place(u0, v0, thickness)], reveal)


def rectangle(u0, v0, u1, v1):
    return [(u0, v0), (u1, v0), (u1, v1), (u0, v1)]


def disc(u, v, r, n=24):
    return [(u + r * math.cos(2 * math.pi * i / n), v + r * math.sin(2 * math.pi * i / n)) for i in range(n)]


def house():
    s = Scene()
    wide, deep, eaves, ridge, t, floor = 8.0, 6.0, 3.1, 6.5, 0.3, 0.15
    s.note("outside: lawn, path, fence, trees")
    s.lines.append("  - {name: lawn, polygon: [[-60, -40, 0], [80, -40, 0], [80, 90, 0], [-60, 90, 0]], material: lawn}\n")
    s.polygon([(6.2, -40, 0), (7.4, -40, 0), (7.4, -0.4, 0), (6.2, -0.4, 0)], "path", more=", detail_of: lawn")
    s.polygon([(-0.5, -0.4, 0), (8.5, -0.4, 0), (8.5, 6.5, 0), (-0.5, 6.5, 0)], "path", more=", detail_of: lawn")
    for i in range(26):
        x, y = -7.2 + 0.26 * i, 1.2
        s.polygon([(x, y, 0.1), (x + 0.16, y, 0.1), (x + 0.16, y, 0.95), (x + 0.08, y, 1.08), (x, y, 0.95)], "white")
    for z in (0.3, 0.75):
        s.box((-7.3, y + 0.01, z), (-0.6, y + 0.05, z + 0.09), "white")
    for x, y, size, turn in ((-4.6, 6.0, 1.0, 20), (12.6, 9.5, 1.25, 100), (17.5, 4.0, 0.95, 250), (-9, 15, 1.3, 310),
                             (4, 21, 1.2, 45), (21, 19, 1.5, 70)):
        s.lines.append(f"  - {{mesh: tree.obj, transform: [{{scale: {size}}}, {{rotate: [0, 0, 1], angle: {turn}}}, "
                       f"{{translate: [{x}, {y}, 0]}}]}}\n")

    s.note("floor and walls")
    s.box((0, 0, 0), (wide, deep, floor), "boards", "cut")
    windows = [rectangle(1.0, 1.0, 2.3, 2.4), rectangle(3.5, 1.0, 4.8, 2.4)]
    s.wall(lambda u, v, d: (d, u, v), rectangle(0, floor, deep - t, eaves), windows, "render", "plaster", t)
    s.wall(lambda u, v, d: (wide - d, u, v), rectangle(0, floor, deep - t, eaves), [rectangle(2.0, 1.0, 3.6, 2.4)], "render",
           "plaster", t)
    gable = [(0, floor), (wide, floor), (wide, eaves), (wide / 2, ridge - 0.05), (0, eaves)]
    back = [rectangle(1.4, 1.0, 2.9, 2.4), rectangle(5.9, floor + 0.02, 6.9, 2.3), disc(wide / 2, 4.7, 0.55)]
    s.wall(lambda u, v, d: (u, deep - d, v), gable, back, "render", "plaster", t)
    for x in (0, wide - t):
        s.polygon([(x, 0, floor), (x + t, 0, floor), (x + t, 0, eaves), (x, 0, eaves)], "cut")
    s.note("bars of the windows")
    for u0, v0, u1, v1 in ((1.0, 1.0, 2.3, 2.4), (3.5, 1.0, 4.8, 2.4)):
        s.box((0.12, (u0 + u1) / 2 - 0.03, v0), (0.18, (u0 + u1) / 2 + 0.03, v1), "white")
        s.box((0.12, u0, 1.9), (0.18, u1, 1.96), "white")
    s.box((2.12, deep - 0.18, 1.0), (2.18, deep - 0.12, 2.4), "white")
    s.box((1.4, deep - 0.18, 1.9), (2.9, deep - 0.12, 1.96), "white")
    s.box((wide / 2 - 0.025, deep - 0.18, 4.16), (wide / 2 + 0.025, deep - 0.12, 5.24), "white")
    s.box((wide / 2 - 0.54, deep - 0.18, 4.675), (wide / 2 + 0.54, deep - 0.12, 4.725), "white")
    s.box((wide - 0.18, 2.77, 1.0), (wide - 0.12, 2.83, 2.4), "white")

    s.note("a wall between the rooms, its doorway cut into the outline")
    door = [(0.4, floor), (2.2, floor), (2.2, 2.25), (3.2, 2.25), (3.2, floor), (deep - t, floor), (deep - t, 2.75), (0.4, 2.75)]
    for x in (5.1, 5.22):
        s.polygon([(x, u, v) for u, v in door], "plaster")
    s.polygon([(5.1, 0.4, floor), (5.22, 0.4, floor), (5.22, 0.4, 2.75), (5.1, 0.4, 2.75)], "plaster")
    for (u0, v0), (u1, v1) in zip(door[1:4], door[2:5]):
        s.polygon([(5.1, u0, v0), (5.22, u0, v0), (5.22, u1, v1), (5.1, u1, v1)], "white")

    s.note("the upper floor, with a hole for the ladder")
    stair = rectangle(6.3, 1.2, 7.2, 2.6)
    low, high = 2.75, 2.95
    frame = rectangle(t, 0, wide - t, deep - t)
    for z, material in ((low, "plaster"), (high, "boards")):
        s.polygon([(u, v, z) for u, v in frame], material, [[(u, v, z) for u, v in stair]])
    for (u0, v0), (u1, v1) in zip(stair, stair[1:] + stair[:1]):
        s.polygon([(u0, v0, low), (u1, v1, low), (u1, v1, high), (u0, v0, high)], "beam")
    s.polygon([(t, 0, low), (wide - t, 0, low), (wide - t, 0, high), (t, 0, high)], "cut")
    for x in (6.45, 7.05):
        s.bar((x, 3.6, floor), (x, 1.9, high + 0.9), 0.07, "beam")
    for i in range(1, 10):
        f = i / 11
        s.box((6.45, 3.6 - 1.7 * f - 0.02, floor + 3.7 * f - 0.02), (7.05, 3.6 - 1.7 * f + 0.02, floor + 3.7 * f + 0.02), "beam")

    s.note("roof: two slabs, rafters under them")
    slope = (ridge - eaves) / (wide / 2)
    over = 0.55
    for side in (-1, 1):
        def at(u, up, y):
            """u from the ridge outwards, up from the underside"""
            return (wide / 2 + side * u, y, ridge - slope * u + up)
        u1 = wide / 2 + over
        y0, y1 = 0.0, deep + 0.35
        s.polygon([at(0, 0.2, y0), at(u1, 0.2, y0), at(u1, 0.2, y1), at(0, 0.2, y1)], "tiles")
        s.polygon([at(0, 0, y0), at(u1, 0, y0), at(u1, 0, y1), at(0, 0, y1)], "boards")
        s.polygon([at(u1, 0, y0), at(u1, 0.2, y0), at(u1, 0.2, y1), at(u1, 0, y1)], "beam")
        for y, material in ((y0, "cut"), (y1, "beam")):
            s.polygon([at(0, 0, y), at(u1, 0, y), at(u1, 0.2, y), at(0, 0.2, y)], material)
        for i in range(6):
            y = 0.5 + 0.95 * i
            for shift in (0, 0.1):
                s.polygon([at(0, -0.14, y + shift), at(3.75, -0.14, y + shift), at(3.75, 0, y + shift), at(0, 0, y + shift)], "beam")
            s.polygon([at(0, -0.14, y), at(3.75, -0.14, y), at(3.75, -0.14, y + 0.1), at(0, -0.14, y + 0.1)], "beam")
    s.note("a chimney; its lower end stands in the roof and is cut where the two cross")
    s.box((5.5, 3.8, 4.6), (6.1, 4.5, 7.2), "tiles")

    s.note("furniture")
    s.box((2.4, 2.2, 0.86), (4.3, 3.3, 0.92), "beam")
    for x in (2.5, 4.12):
        for y in (2.3, 3.12):
            s.box((x, y, floor), (x + 0.08, y + 0.08, 0.86), "beam")
    s.box((2.4, 3.55, 0.54), (4.3, 3.9, 0.6), "boards")
    for x in (2.6, 4.0):
        s.box((x, 3.6, floor), (x + 0.1, 3.85, 0.54), "boards")
    s.box((3.2, 2.6, 0.92), (3.45, 2.85, 1.17), "cloth")
    s.box((1.2, 3.6, 3.2), (3.2, 5.2, 3.42), "white")
    s.box((1.2, 3.6, 2.95), (3.2, 5.2, 3.2), "beam")
    s.box((1.9, 3.58, 3.42), (3.22, 5.22, 3.47), "blue")
    s.box((1.28, 3.75, 3.42), (1.68, 5.05, 3.55), "white")
    s.box((5.35, 4.6, floor), (7.0, 5.65, 0.6), "blue")
    s.box((5.35, 5.4, 0.6), (7.0, 5.65, 1.15), "blue")
    with open("house.yaml", "w") as file:
        file.write(HOUSE)
        file.writelines(s.lines)


# ---- small models --------------------------------------------------------------------------------------------------------


def icosphere():
    """Twelve points of an icosahedron and the midpoints of its edges, on the unit sphere; 80 triangles."""
    g = (1 + math.sqrt(5)) / 2
    points = [p for a in (-1, 1) for b in (-g, g) for p in ((0, a, b), (a, b, 0), (b, 0, a))]

    def unit(p):
        length = math.sqrt(sum(x * x for x in p))
        return tuple(x / length for x in p)

    def distance(p, q):
        return sum((x - y) ** 2 for x, y in zip(p, q))

    faces = []
    for i in range(12):
        for j in range(i + 1, 12):
            for k in range(j + 1, 12):
                a, b, c = points[i], points[j], points[k]
                if max(distance(a, b), distance(b, c), distance(a, c)) < 4.1:
                    normal = [(b[(m + 1) % 3] - a[(m + 1) % 3]) * (c[(m + 2) % 3] - a[(m + 2) % 3])
                              - (b[(m + 2) % 3] - a[(m + 2) % 3]) * (c[(m + 1) % 3] - a[(m + 1) % 3]) for m in range(3)]
                    faces.append((a, b, c) if sum(n * x for n, x in zip(normal, a)) > 0 else (a, c, b))
    fine = []
    for a, b, c in faces:
        ab, bc, ca = (tuple((x + y) / 2 for x, y in zip(*e)) for e in ((a, b), (b, c), (c, a)))
        fine += [tuple(unit(p) for p in t) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
    return fine


def tree():
    chance = random.Random(5)
    obj = Obj("a tree 4 units high: a trunk and three bushy crowns", "tree.mtl", 3)
    low = [(0.16 * math.cos(k * math.pi / 4), 0.16 * math.sin(k * math.pi / 4), 0) for k in range(8)]
    high = [(0.5 * x, 0.5 * y, 2.2) for x, y, _ in low]
    for i in range(8):
        j = (i + 1) % 8
        obj.face([low[i], low[j], high[j], high[i]], "trunk")
    for (x, y, z), r in (((0, 0, 2.6), 1.15), ((0.55, 0.3, 1.95), 0.75), ((-0.5, 0.25, 1.9), 0.7)):
        push = {}
        for face in icosphere():
            corners = []
            for p in face:
                key = tuple(round(c, 6) for c in p)
                f = push.setdefault(key, r * chance.uniform(0.88, 1.12))
                corners.append((x + f * p[0], y + f * p[1], z + f * p[2] * 1.1))
            obj.face(corners, "leaves")
    obj.write("tree.obj")
    with open("tree.mtl", "w") as file:
        file.write("newmtl trunk\nKa 0.20 0.12 0.06\nKd 0.22 0.13 0.07\n\n"
                   "newmtl leaves\nKa 0.10 0.22 0.05\nKd 0.13 0.30 0.06\n")


def cube():
    obj = Obj("the unit cube, wound outwards")
    obj.box((0, 0, 0), (1, 1, 1))
    obj.write("cube.obj")


def chair():
    obj = Obj("a chair 0.9 high, its seat 0.42 wide, feet around (0,0,0), back at y = 0.2")
    for x in (-0.2, 0.16):
        obj.box((x, -0.2, 0), (x + 0.04, -0.16, 0.44))
        obj.box((x, 0.16, 0), (x + 0.04, 0.2, 0.92))
    obj.box((-0.21, -0.21, 0.44), (0.21, 0.21, 0.48))
    for z in (0.6, 0.72, 0.84):
        obj.box((-0.16, 0.17, z), (0.16, 0.19, z + 0.07))
    obj.write("chair.obj")


def revolve(obj, profile, normals, turns):
    """Turns the points (r, z) about z; quadrilaterals between two circles are planar."""
    def around(p, i):
        a = 2 * math.pi * i / turns
        return (p[0] * math.cos(a), p[0] * math.sin(a), p[1])

    for (p, q), (m, n) in zip(zip(profile, profile[1:]), zip(normals, normals[1:])):
        for i in range(turns):
            corners = [(p, m, i), (p, m, i + 1), (q, n, i + 1), (q, n, i)]
            if p[0] == 0:
                corners.pop(0)
            elif q[0] == 0:
                corners.pop(2)
            obj.face([around(c[0], c[2] % turns) for c in corners], None, [around(c[1], c[2] % turns) for c in corners])


def curve_normals(profile):
    """Normals to the right of the curve's direction, by central differences."""
    result = []
    for i in range(len(profile)):
        a, b = profile[max(i - 1, 0)], profile[min(i + 1, len(profile) - 1)]
        dr, dz = b[0] - a[0], b[1] - a[1]
        length = math.hypot(dr, dz)
        result.append((dz / length, -dr / length))
    return result


def vase():
    """A closed curve of a turned vase: up the outside, over the lip, down the inside."""
    def outside(t):
        return 0.30 + 0.30 * math.sin(math.pi * (0.12 + 1.02 * t)) ** 2 - 0.13 * t + 0.16 * max(0, t - 0.8) ** 1.5 * 12

    steps = 26
    out = [(outside(i / steps), 1.5 * i / steps) for i in range(steps + 1)]
    top = out[-1]
    lip = [(top[0] - 0.025 + 0.025 * math.cos(a), top[1] + 0.025 * math.sin(a)) for a in (0.25 * math.pi * k for k in range(1, 4))]
    inner = [(r - 0.05, z) for r, z in reversed(out[steps // 2:])]
    profile = out + lip + inner
    obj = Obj("a vase 1.5 high, with exact normals", digits=6)
    revolve(obj, profile, curve_normals(profile), 40)
    obj.write("vase.obj")


def torus():
    sections, turns, major, minor = 20, 48, 0.6, 0.2
    angles = [2 * math.pi * i / sections for i in range(sections + 1)]
    profile = [(major + minor * math.cos(a), minor * math.sin(a)) for a in angles]
    profile[-1] = profile[0]
    obj = Obj("a torus, radii 0.6 and 0.2, lying at z = 0, with exact normals", digits=6)
    revolve(obj, profile, [(math.cos(a), math.sin(a)) for a in angles], turns)
    obj.write("torus.obj")


def shade():
    obj = Obj("a lamp shade: a cone's frustum open at both ends, radii 0.28 and 0.12, 0.24 high", digits=6)
    revolve(obj, [(0.28, 0), (0.12, 0.24)], [(0.832, 0.5547)] * 2, 32)
    obj.write("shade.obj")


# ---- town ----------------------------------------------------------------------------------------------------------------


class Town:
    def __init__(self):
        self.chance = random.Random(1848)
        self.plans = []  # corners and axes of ground plans that are taken
        self.walls = Obj("walls, roofs, trees and ground of a small town", "town.mtl", 5)
        self.details = Obj("windows, doors, streets: they lie on the polygons of town.obj and come before them by priority",
                           "town.mtl", 5)

    def house(self, x, y, wide, deep, height, rise, turn, wall, roof, along=True, windows=True):
        """Centre, size, height of the eaves, rise of the roof; the front looks to -y before it is turned."""
        c, s = math.cos(turn), math.sin(turn)

        def at(u, v, z):
            return (x + c * u - s * v, y + s * u + c * v, z)

        a, b, h = wide / 2, deep / 2, height
        over = 0.35
        f = self.walls.face
        if along:  # ridge along the street
            ridge = [(-a, 0), (a, 0)]
            f([at(-a, -b, 0), at(a, -b, 0), at(a, -b, h), at(-a, -b, h)], wall)
            f([at(a, b, 0), at(-a, b, 0), at(-a, b, h), at(a, b, h)], wall)
            f([at(a, -b, 0), at(a, b, 0), at(a, b, h), at(a, 0, h + rise), at(a, -b, h)], wall)
            f([at(-a, b, 0), at(-a, -b, 0), at(-a, -b, h), at(-a, 0, h + rise), at(-a, b, h)], wall)
            drop = rise * over / b
            for sign in (-1, 1):
                f([at(-a - over, sign * (b + over), h - drop), at(a + over, sign * (b + over), h - drop),
                   at(a + over, 0, h + rise), at(-a - over, 0, h + rise)], roof)
        else:  # gable to the street
            f([at(-a, -b, 0), at(a, -b, 0), at(a, -b, h), at(0, -b, h + rise), at(-a, -b, h)], wall)
            f([at(a, b, 0), at(-a, b, 0), at(-a, b, h), at(0, b, h + rise), at(a, b, h)], wall)
            f([at(a, -b, 0), at(a, b, 0), at(a, b, h), at(a, -b, h)], wall)
            f([at(-a, b, 0), at(-a, -b, 0), at(-a, -b, h), at(-a, b, h)], wall)
            drop = rise * over / a
            for sign in (-1, 1):
                f([at(sign * (a + over), -b - over, h - drop), at(sign * (a + over), b + over, h - drop),
                   at(0, b + over, h + rise), at(0, -b - over, h + rise)], roof)
        cx = self.chance.uniform(-0.5, 0.5) * a
        self.walls.box((x + cx - 0.4, y - 0.4, h), (x + cx + 0.4, y + 0.4, h + rise + 0.9), "brick", turn, (x, y))
        if windows:
            self.windows(at, a, b, h, rise, along)

    def windows(self, at, a, b, h, rise, along):
        d = self.details.face

        def pane(place, u, z, w, t, material):
            d([place(u - w / 2, z), place(u + w / 2, z), place(u + w / 2, z + t), place(u - w / 2, z + t)], material)

        floors = max(1, int((h - 0.4) / 2.6))
        columns = max(2, int(2 * a / 2.4))
        for side in (-1, 1):
            for floor in range(floors):
                for i in range(columns):
                    u = -a + 2 * a * (i + 0.5) / columns
                    if side < 0 and floor == 0 and i == columns // 2:
                        pane(lambda p, z: at(p, -b, z), u, 0, 1.1, 2.1, "door")
                        continue
                    lit = self.chance.random() < 0.12
                    pane(lambda p, z: at(p, side * b, z), u, 0.9 + 2.6 * floor, 0.95, 1.3, "lit" if lit else "pane")
        if not along and rise > 2.2:
            pane(lambda p, z: at(p, -b, z), 0, h + 0.3, 0.9, 1.1, "pane")
        if along and rise > 2.2:
            for side in (-1, 1):
                pane(lambda p, z: at(side * a, p, z), 0, h + 0.2, 0.9, 1.1, "pane")
        for side in (-1, 1):
            for floor in range(floors):
                pane(lambda p, z: at(side * a, p, z), 0.4 * b * (-1) ** floor, 0.9 + 2.6 * floor, 0.95, 1.3, "pane")

    def tree(self, x, y, size):
        """A cone of eight sides on a trunk."""
        ring_at = [(x + 0.45 * size * math.cos(k * math.pi / 4), y + 0.45 * size * math.sin(k * math.pi / 4), 0.3 * size) for k in range(8)]
        self.walls.box((x - 0.2, y - 0.2, 0), (x + 0.2, y + 0.2, 0.3 * size), "trunk")
        for i in range(8):
            self.walls.face([ring_at[i], ring_at[(i + 1) % 8], (x, y, 1.6 * size)], "leaves")
        self.walls.face(ring_at[::-1], "leaves")

    def free(self, x, y, wide, deep, turn):
        """True where the ground plan meets none before it; then it is kept."""
        c, s = math.cos(turn), math.sin(turn)
        plan = [(x + c * u - s * v, y + s * u + c * v) for u in (-wide / 2, wide / 2) for v in (-deep / 2, deep / 2)]
        axes = [(c, s), (-s, c)]
        for other, other_axes in self.plans:
            apart = False
            for ax, ay in axes + other_axes:
                p = [ax * u + ay * v for u, v in plan]
                q = [ax * u + ay * v for u, v in other]
                apart = apart or max(p) < min(q) or max(q) < min(p)
            if not apart:
                return False
        self.plans.append((plan, axes))
        return True

    def row(self, x0, y0, x1, y1, side):
        """Houses along a street from one end to the other, on its left (1) or right (-1), wall to wall with gaps."""
        ch = self.chance
        length = math.hypot(x1 - x0, y1 - y0)
        ux, uy = (x1 - x0) / length, (y1 - y0) / length
        at = 1.0
        while True:
            wide = ch.uniform(6.5, 11)
            if at + wide > length:
                return
            deep = ch.uniform(8, 10)
            off = side * (3.4 + deep / 2 + ch.uniform(0, 0.8))
            x, y = x0 + ux * (at + wide / 2) - uy * off, y0 + uy * (at + wide / 2) + ux * off
            turn = math.atan2(uy, ux) + (0 if side > 0 else math.pi)
            if not self.free(x, y, wide, deep, turn):
                at += 1.0
                continue
            along = ch.random() < 0.6
            self.house(x, y, wide, deep, ch.choice((3.2, 5.8, 5.8, 6.4, 8.4)), ch.uniform(2.4, 4.2), turn,
                       ch.choice(("cream", "rose", "ochre", "sage", "white", "sky")), ch.choice(("red", "red", "brown", "slate")), along)
            at += wide + ch.choice((0.05, 0.05, 1.4, 3.0))

    def street(self, *points, width=5.6):
        for (x0, y0), (x1, y1) in zip(points, points[1:]):
            length = math.hypot(x1 - x0, y1 - y0)
            nx, ny = -(y1 - y0) / length * width / 2, (x1 - x0) / length * width / 2
            self.details.face([(x0 - nx, y0 - ny, 0), (x1 - nx, y1 - ny, 0), (x1 + nx, y1 + ny, 0), (x0 + nx, y0 + ny, 0)], "street")

    def church(self, x, y):
        self.house(x, y, 11, 24, 9, 7.5, math.pi, "white", "slate", False, False)
        w = self.walls
        tx, ty, r, h = x, y - 14.2, 3.1, 21
        w.box((tx - r, ty - r, 0), (tx + r, ty + r, h), "white")
        base = [(tx - r - 0.3, ty - r - 0.3, h), (tx + r + 0.3, ty - r - 0.3, h), (tx + r + 0.3, ty + r + 0.3, h), (tx - r - 0.3, ty + r + 0.3, h)]
        w.face(base[::-1], "slate")
        for i in range(4):
            w.face([base[i], base[(i + 1) % 4], (tx, ty, h + 13)], "slate")
        d = self.details.face
        for side in (-1, 1):
            for k in range(4):  # tall windows of the nave
                v = y - 8 + 5 * k
                px = x + side * 5.5
                d([(px, v - 0.7, 2.2), (px, v + 0.7, 2.2), (px, v + 0.7, 5.6), (px, v, 6.8), (px, v - 0.7, 5.6)], "pane")
        for nx, ny in ((0, -1), (0, 1), (1, 0), (-1, 0)):  # bells and clocks
            def on(u, z):
                return (tx + nx * r - ny * u, ty + ny * r + nx * u, z)
            d([on(-0.8, 15.6), on(0.8, 15.6), on(0.8, 17.8), on(0, 18.8), on(-0.8, 17.8)], "pane")
            d([on(1.25 * math.cos(k * math.pi / 12), 12.6 + 1.25 * math.sin(k * math.pi / 12)) for k in range(24)], "clock")
        d([(tx - 1.1, ty - r, 0), (tx + 1.1, ty - r, 0), (tx + 1.1, ty - r, 2.8), (tx, ty - r, 4.0), (tx - 1.1, ty - r, 2.8)], "door")

    def build(self):
        ch = self.chance
        self.walls.face([(-600, -600, 0), (600, -600, 0), (600, 600, 0), (-600, 600, 0)], "grass")
        square = [(-19, -15, 0), (19, -15, 0), (19, 15, 0), (-19, 15, 0)]
        self.details.face(square, "paving")
        ways = [((-19, 0), (-46, -4), (-86, 2)), ((19, 0), (48, 5), (90, -2)), ((0, -15), (3, -45), (-2, -88)),
                ((-14, 15), (-20, 46), (-14, 88)), ((15, 15), (36, 44), (64, 78))]
        self.free(0, 0, 38, 30, 0)  # the square, the church, the beds of the streets stay free
        self.free(3, 29, 14, 34, 0)
        for way in ways:
            for (x0, y0), (x1, y1) in zip(way, way[1:]):
                self.free((x0 + x1) / 2, (y0 + y1) / 2, math.hypot(x1 - x0, y1 - y0), 5.6, math.atan2(y1 - y0, x1 - x0))
        for way in ways:
            for (x0, y0), (x1, y1) in zip(way, way[1:]):
                self.street((x0, y0), (x1, y1))
                self.row(x0, y0, x1, y1, 1)
                self.row(x0, y0, x1, y1, -1)
        for way in ways:  # on into the country
            (x0, y0), (x1, y1) = way[-2:]
            self.street((x1, y1), (x1 + 9 * (x1 - x0), y1 + 9 * (y1 - y0)), width=4)
        self.church(3.0, 31)
        for x, y in ((-14, -11), (-14, 11), (14, -11), (14, 11)):
            self.tree(x, y, 4)
        placed = 0
        while placed < 90:
            x, y = ch.uniform(-130, 130), ch.uniform(-130, 130)
            if math.hypot(x, y) > 62 and all(self.away(x, y, w) > 14 for w in ways):
                self.tree(x, y, ch.uniform(3.2, 6.5))
                placed += 1
        fields = [((-120, -70), (-70, -62), (-74, -30), (-122, -36)), ((60, -100), (118, -96), (120, -52), (64, -44)),
                  ((-140, 60), (-80, 48), (-66, 110), (-130, 120)), ((90, 24), (150, 20), (150, 66), (96, 58)),
                  ((-70, -120), (-24, -118), (-26, -74), (-66, -70))]
        for i, corners in enumerate(fields):
            self.details.face([(x, y, 0) for x, y in corners], "wheat" if i % 2 == 0 else "earth")

    @staticmethod
    def away(x, y, way):
        best = 1e9
        for (x0, y0), (x1, y1) in zip(way, way[1:]):
            dx, dy = x1 - x0, y1 - y0
            t = max(0, min(1, ((x - x0) * dx + (y - y0) * dy) / (dx * dx + dy * dy)))
            best = min(best, math.hypot(x - x0 - t * dx, y - y0 - t * dy))
        return best


COLOURS = {"grass": (0.20, 0.28, 0.09), "street": (0.36, 0.33, 0.30), "paving": (0.50, 0.46, 0.40), "wheat": (0.58, 0.46, 0.16),
           "earth": (0.33, 0.22, 0.13), "cream": (0.80, 0.72, 0.54), "rose": (0.74, 0.50, 0.42), "ochre": (0.74, 0.55, 0.26),
           "sage": (0.52, 0.58, 0.42), "white": (0.82, 0.80, 0.76), "sky": (0.50, 0.58, 0.66), "red": (0.55, 0.17, 0.09),
           "brown": (0.38, 0.19, 0.11), "slate": (0.20, 0.22, 0.26), "brick": (0.45, 0.18, 0.12), "trunk": (0.20, 0.13, 0.08),
           "leaves": (0.09, 0.22, 0.07), "pane": (0.10, 0.12, 0.16), "door": (0.24, 0.12, 0.06), "clock": (0.88, 0.80, 0.55)}


def town():
    t = Town()
    t.build()
    t.walls.write("town.obj")
    t.details.write("town_details.obj")
    with open("town.mtl", "w") as file:
        for name, colour in COLOURS.items():
            triple = " ".join(number(c, 3) for c in colour)
            file.write(f"newmtl {name}\nKa {triple}\nKd {triple}\n\n")
        file.write("newmtl lit\nKa 3.6 2.3 0.9\nKd 0.4 0.3 0.15\n")


if __name__ == "__main__":
    sundial()
    house()
    tree()
    cube()
    chair()
    vase()
    torus()
    shade()
    town()
