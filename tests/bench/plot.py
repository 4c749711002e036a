"""plot.py -- error against time as SVG: a panel for each scene, both axes logarithmic. Place: under bench.py."""
import math

WIDTH, HEIGHT, LEFT, TOP, RIGHT, BOTTOM, ACROSS = 380, 280, 62, 30, 14, 42, 2
COLOURS = {"alike": "#3b6ea5", "adaptive": "#c8812b", "gnomon": "#b3243a"}
NAMES = {"alike": "Embree, all pixels alike (1, 4, 16, 64)", "adaptive": "Embree, adaptive", "gnomon": "gnomon, default"}


def bounds(values):
    return math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)))


def label(power):
    return f"{10 ** power:g}"


def panel(out, x0, y0, name, curves):
    points = [p for c in curves.values() for p in c if p[1]]
    if not points:
        return
    (x_low, x_high), (y_low, y_high) = bounds([p[0] for p in points]), bounds([p[1] for p in points])
    x_high, y_high = max(x_high, x_low + 1), max(y_high, y_low + 1)
    w, h = WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM

    def place(p):
        return (x0 + LEFT + w * (math.log10(p[0]) - x_low) / (x_high - x_low), y0 + TOP + h * (y_high - math.log10(p[1])) / (y_high - y_low))

    out.append(f'<text x="{x0 + LEFT}" y="{y0 + 18}" font-weight="bold">{name}</text>')
    for k in range(x_low, x_high + 1):
        x = place((10.0 ** k, 1))[0]
        out.append(f'<path d="M{x:.1f} {y0 + TOP}v{h}" stroke="#ddd"/><text x="{x:.1f}" y="{y0 + TOP + h + 16}" text-anchor="middle">{label(k)}</text>')
    for k in range(y_low, y_high + 1):
        y = place((1, 10.0 ** k))[1]
        out.append(f'<path d="M{x0 + LEFT} {y:.1f}h{w}" stroke="#ddd"/><text x="{x0 + LEFT - 6}" y="{y + 4:.1f}" text-anchor="end">{label(k)}</text>')
    out.append(f'<rect x="{x0 + LEFT}" y="{y0 + TOP}" width="{w}" height="{h}" fill="none" stroke="#777"/>')
    out.append(f'<text x="{x0 + LEFT + w / 2}" y="{y0 + HEIGHT - 10}" text-anchor="middle">seconds</text>')
    out.append(f'<text transform="translate({x0 + 14} {y0 + TOP + h / 2}) rotate(-90)" text-anchor="middle">RMS error</text>')
    for kind, curve in curves.items():
        at = [place(p) for p in sorted(curve) if p[1]]
        if kind == "alike" and len(at) > 1:
            out.append(f'<polyline fill="none" stroke="{COLOURS[kind]}" stroke-width="1.5" points="{" ".join(f"{x:.1f},{y:.1f}" for x, y in at)}"/>')
        for x, y in at:
            out.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{5 if kind == "gnomon" else 3.5}" fill="{COLOURS[kind]}"/>')


def write(path, plots):
    """plots: {scene: {"gnomon" | "alike" | "adaptive": [(seconds, error), ...]}}"""
    down = (len(plots) + ACROSS - 1) // ACROSS
    width, height = ACROSS * WIDTH, down * HEIGHT + 30
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="11">',
           f'<rect width="{width}" height="{height}" fill="white"/>']
    for i, (name, curves) in enumerate(plots.items()):
        panel(out, i % ACROSS * WIDTH, i // ACROSS * HEIGHT, name, curves)
    for i, kind in enumerate(COLOURS):
        out.append(f'<circle cx="{20 + 250 * i}" cy="{height - 14}" r="4" fill="{COLOURS[kind]}"/><text x="{30 + 250 * i}" y="{height - 10}">{NAMES[kind]}</text>')
    with open(path, "w") as f:
        f.write("\n".join(out + ["</svg>"]) + "\n")
