#!/usr/bin/env python3
"""Flat plates, judged by code that shares nothing with the program.

Every sheet among the samples is modelled and unfolded by the binary; the DXF is read with ezdxf. Checked are: the file passes
ezdxf's audit; layers; no two outlines' edges cross (so no part of a plate lies on another); the plates' area is that of the
sheet's triangles; every edge of an outline has the length of a line of the sheet; bend lines lie within plates.

    .venv/bin/python tests/unfold/verify.py        (TOILE: the binary, by default target/release/toile)
"""

import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

import ezdxf

ROOT = pathlib.Path(__file__).resolve().parents[2]
TOILE = os.environ.get("TOILE", str(ROOT / "target/release/toile"))


def run(*words):
    done = subprocess.run([TOILE, *map(str, words)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"toile {' '.join(map(str, words))}: {done.stderr}")
    return done.stdout


def obj_area(path):
    nodes, area = [], 0.0
    for line in path.read_text().splitlines():
        word, *rest = line.split() or [""]
        if word == "v":
            nodes.append([float(x) for x in rest[:3]])
        elif word == "f":
            a, b, c = (nodes[int(x.split("/")[0]) - 1] for x in rest[:3])
            u, v = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]
            cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
            area += math.sqrt(sum(x * x for x in cross)) / 2
    return area


def cross(a, b, p):
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])


def crossings(outlines, near):
    """Pairs of edges that cross inside both."""
    edges = [(o[i], o[(i + 1) % len(o)]) for o in outlines for i in range(len(o))]
    edges.sort(key=lambda e: min(e[0][0], e[1][0]))
    count = 0
    for k, (a, b) in enumerate(edges):
        right = max(a[0], b[0])
        for c, d in edges[k + 1 :]:
            if min(c[0], d[0]) > right:
                break
            # Distances from lines, so that touching edges do not count.
            ab, cd = math.dist(a, b), math.dist(c, d)
            p, q, r, s = cross(a, b, c) / ab, cross(a, b, d) / ab, cross(c, d, a) / cd, cross(c, d, b) / cd
            if min(abs(p), abs(q), abs(r), abs(s)) > near and p * q < 0 and r * s < 0:
                count += 1
    return count


def inside(p, outlines):
    odd = False
    for o in outlines:
        for i, a in enumerate(o):
            b = o[(i + 1) % len(o)]
            if (a[1] > p[1]) != (b[1] > p[1]) and p[0] < a[0] + (b[0] - a[0]) * (p[1] - a[1]) / (b[1] - a[1]):
                odd = not odd
    return odd


def check(name, sheet, obj, work, sharp):
    path = work / f"{name}.dxf"
    words = ["unfold", sheet, "-o", path, "--json"] + ([] if sharp else ["--thickness", "1.5", "--relief", "round"])
    report = json.loads(run(*words))
    document = ezdxf.readfile(path)
    audit = document.audit()
    faults = [f"audit: {e.message}" for e in audit.errors]
    space = document.modelspace()
    outlines = [[tuple(v.dxf.location)[:2] for v in p.vertices] for p in space.query("POLYLINE")]
    size = max(max(abs(x) for p in o for x in p) for o in outlines)
    layers = {e.dxf.layer for e in space}
    if not layers <= {"CUT", "BEND", "WELD", "TEXT"} or {p.dxf.layer for p in space.query("POLYLINE")} != {"CUT"}:
        faults.append(f"layers {layers}")
    if (n := crossings(outlines, 2e-6 * size)) > 0:
        faults.append(f"{n} edges cross")
    bends = [(tuple(b.dxf.start)[:2], tuple(b.dxf.end)[:2]) for b in space.query('LINE[layer=="BEND"]')]
    if len(bends) != report["bends"]:
        faults.append(f"{len(bends)} bend lines, {report['bends']} reported")
    for a, b in bends:
        if not inside(((a[0] + b[0]) / 2, (a[1] + b[1]) / 2), outlines):
            faults.append(f"bend at {a} {b} is outside")
    area = sum(sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(o, o[1:] + o[:1])) for o in outlines) / 2
    if sharp:
        wanted = obj_area(obj)
        if abs(area - wanted) > 1e-9 * wanted:
            faults.append(f"area {area}, not {wanted}")
        if report["length_error"] > 1e-9:
            faults.append(f"lengths off by {report['length_error']}")
    kind = "sharp" if sharp else "1.5 mm"
    print(f"{name:22} {kind:7} {report['facets']:4} facets {len(report['plates']):3} plates {len(bends):4} bends: "
          + ("good" if not faults else "; ".join(faults)))
    return not faults


def main():
    good = True
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        sheets = []
        for script in sorted((ROOT / "samples/sheets").glob("*.json")):
            obj = work / f"{script.stem}.obj"
            run("model", script, "-o", obj)
            sheets.append((script.stem, script, obj))
        shared = ROOT.parent / "shared/sheets"
        sheets += [(p.stem, p, p) for p in sorted(shared.glob("*-coarse.obj"))]
        sheets += [(p.stem, p, p) for p in sorted(shared.glob("box-partition-meshed.obj"))]
        for name, sheet, obj in sheets:
            good &= check(name, sheet, obj, work, True)
            if name in ("bracket", "mount", "box-partition", "corner", "open-box-coarse", "l-shape-coarse"):
                good &= check(name, sheet, obj, work, False)
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
