#!/usr/bin/env python3
"""Reads what `toile` writes with programs that know nothing of it.

    python -m pip install -r tests/readers/requirements.txt
    cargo build --release
    python tests/readers/check_outputs.py [--toile BINARY] [--body MESH]...

Regenerates every template in samples/ on a dress form (and on every --body) in a temporary folder, opens the results
with ezdxf, shapely, pypdf, trimesh and pillow, and compares them with report.json. Prints a table; exit 1 when
anything is off.
"""

import argparse
import json
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import ezdxf
import numpy as np
import pypdf
import trimesh
from PIL import Image
from scipy.spatial import cKDTree
from shapely.geometry import Polygon

import gltf_structure

ROOT = Path(__file__).resolve().parents[2]
POINTS_A_MM = 72 / 25.4
UNITS = {"m": 1000.0, "cm": 10.0, "mm": 1.0}
REPORT_KEYS = ["toile", "template", "body", "surfaces", "joints", "collision", "ease", "pieces", "seams", "warnings", "seconds"]


class Table:
    """Results of single checks."""

    def __init__(self):
        self.rows = []

    def check(self, where, what, holds, found):
        self.rows.append((bool(holds), where, what, str(found)))

    def guarded(self, where, reader, *inputs):
        """Runs one reader; what it throws is a failed check."""
        try:
            reader(self, where, *inputs)
        except Exception as error:  # noqa: BLE001: whatever a reader throws is a finding
            self.check(where, reader.__name__, False, f"{type(error).__name__}: {error}")

    def print(self):
        widths = [max(len(row[i]) for row in self.rows) for i in (1, 2)]
        for holds, where, what, found in self.rows:
            print(f"{'ok  ' if holds else 'FAIL'}  {where:<{widths[0]}}  {what:<{widths[1]}}  {found[:160]}")
        failed = sum(not row[0] for row in self.rows)
        print(f"{len(self.rows)} checks, {failed} failed")
        return failed


def read_report(table, where, folder, report):
    missing = [key for key in REPORT_KEYS if key not in report]
    table.check(where, "report.json: keys", not missing, f"missing {missing}" if missing else "all")
    written = json.loads((folder / "report.json").read_text())
    table.check(where, "report.json: as on standard output", written == report, "equal" if written == report else "other")


def block_loops(block, layer):
    """Points of the polylines of a block on a layer."""
    loops = []
    for entity in block.query(f'POLYLINE[layer=="{layer}"]'):
        loops.append(np.array([[v.dxf.location.x, v.dxf.location.y] for v in entity.vertices]))
    return loops


def read_dxf(table, where, folder, report):
    path = folder / "pattern.dxf"
    document = ezdxf.readfile(path)
    auditor = document.audit()
    table.check(where, "DXF: audit", not auditor.errors and not auditor.fixes, f"{len(auditor.errors)} errors, {len(auditor.fixes)} fixes")
    blocks = [b for b in document.blocks if not b.name.startswith(("*", "$"))]
    named = re.findall(r"^BLOCK\r?\n", path.read_text(encoding="ascii"), re.MULTILINE)
    pieces = {p["name"]: p for p in report["pieces"]}
    table.check(where, "DXF: a block a piece", len(blocks) == len(named) == len(pieces), f"{len(blocks)} of {len(pieces)}")
    inserts = document.modelspace().query("INSERT")
    table.check(where, "DXF: an insert a piece", sorted(i.dxf.name for i in inserts) == sorted(b.name for b in blocks), len(inserts))
    areas, inside, grains = [], True, 0
    for block in blocks:
        cut, sew = block_loops(block, "1"), block_loops(block, "14")
        if not cut or not sew:
            table.check(where, f"DXF: {block.name}", False, f"{len(cut)} cut lines, {len(sew)} sew lines")
            continue
        largest = max((Polygon(loop) for loop in sew), key=lambda p: p.area)
        outline = max((Polygon(loop) for loop in cut), key=lambda p: p.area)
        inside &= outline.is_valid and largest.is_valid and outline.buffer(0.05).contains(largest)
        areas.append(largest.area)
        grains += len(block.query('LINE[layer=="7"]')) == 1
    said = sorted(p["area_2d"] for p in pieces.values())
    off = np.abs(np.sort(areas) / said - 1).max() if len(areas) == len(said) else np.inf
    table.check(where, "DXF: sewn areas as reported", off < 2e-3, f"largest difference {100 * off:.3f} %")
    table.check(where, "DXF: simple outlines, cut holds sew", inside, inside)
    table.check(where, "DXF: a grain line a piece", grains == len(blocks), grains)


def read_svg(table, where, folder, report):
    root = ElementTree.parse(folder / "pattern.svg").getroot()
    sizes = [re.fullmatch(r"([\d.]+)mm", root.get(side)) for side in ("width", "height")]
    box = [float(x) for x in root.get("viewBox").split()]
    same = all(sizes) and [float(m[1]) for m in sizes] == box[2:] and box[:2] == [0, 0]
    table.check(where, "SVG: mm size is the viewBox", same, f"{root.get('width')} x {root.get('height')}")
    space = "{http://www.w3.org/2000/svg}"
    groups = [g for g in root.iter(f"{space}g") if g.get("class") == "piece"]
    table.check(where, "SVG: a group a piece", len(groups) == len(report["pieces"]), len(groups))
    places = [np.array(re.findall(r"-?[\d.]+", p.get("d")), float).reshape(-1, 2) for g in groups for p in g.iter(f"{space}path")]
    places = np.concatenate(places)
    inside = (places >= -0.01).all() and (places <= np.array(box[2:]) + 0.01).all()
    table.check(where, "SVG: everything on the page", inside, f"{places.min(axis=0)} to {places.max(axis=0)}")
    colours = {p.get("class"): p.get("stroke") for g in groups for p in g.iter(f"{space}path")}
    table.check(where, "SVG: a colour a meaning", len(set(colours.values())) == len(colours) and len(colours) >= 3, colours)


def read_pdf(table, where, folder, size):
    reader = pypdf.PdfReader(folder / "pattern.pdf", strict=True)
    sizes = {tuple(round(float(x) * float(p.get("/UserUnit", 1)) / POINTS_A_MM, 1) for x in p.mediabox.upper_right) for p in reader.pages}
    wanted = size is None or (len(sizes) == 1 and np.allclose(sorted(*sizes), sorted(size), atol=0.2))
    table.check(where, "PDF: page size [mm]", wanted, sizes)
    count = len(reader.pages)
    if size is None:
        table.check(where, "PDF: one plotter page", count == 1, count)
        return
    text = [page.extract_text() for page in reader.pages]
    numbered = all(re.search(rf"page\s*{i + 1}\s*of\s*{count}", t) for i, t in enumerate(text))
    table.check(where, "PDF: pages numbered", numbered and count > 0, f"{count} pages")
    table.check(where, "PDF: test squares", any("50 mm" in t for t in text) and any("2 inch" in t for t in text), "named")
    squares = square_sides(reader.pages)
    table.check(where, "PDF: 50 mm and 2 inch drawn true", {50.0, 50.8} <= squares, sorted(squares)[:6])


def square_sides(pages):
    """Sides in millimetres of all closed squares drawn on the pages."""
    sides = set()
    for page in pages:
        scale, stack, points = 1.0, [], []
        for operands, operator in pypdf.generic.ContentStream(page.get_contents(), page.pdf).operations:
            if operator == b"q":
                stack.append(scale)
            elif operator == b"Q":
                scale = stack.pop()
            elif operator == b"cm":
                scale *= float(operands[0])
            elif operator == b"m":
                points = [[float(x) for x in operands]]
            elif operator == b"l":
                points.append([float(x) for x in operands])
            elif operator == b"re":
                width, height = (abs(float(x)) for x in operands[2:])
                if np.isclose(width, height):
                    sides.add(round(width * scale / POINTS_A_MM, 1))
            elif operator in (b"S", b"s", b"h", b"n") and len(points) in (4, 5):
                extent = np.ptp(np.array(points), axis=0)
                if np.isclose(*extent, rtol=1e-3):
                    sides.add(round(float(extent[0]) * scale / POINTS_A_MM, 1))
    return sides


def read_obj(table, where, folder, report, body):
    path = folder / "garment.obj"
    mesh = trimesh.load(path, process=False, force="mesh", group_material=False)
    faces = sum(s["faces"] for s in report["surfaces"])
    table.check(where, "OBJ: triangles", len(mesh.faces) == faces, f"{len(mesh.faces)} of {faces}")
    groups = re.findall(r"^g (.+)$", path.read_text(), re.MULTILINE)
    names = [s["name"] for s in report["surfaces"]]
    table.check(where, "OBJ: a group a surface", [g for g in groups if g in names] == names, len(groups))
    lo, hi = mesh.bounds
    body_lo, body_hi = body.bounds
    margin = 0.25 * (body_hi - body_lo).max()
    over = (lo > body_lo - margin).all() and (hi < body_hi + margin).all()
    table.check(where, "OBJ: lies over the body", over, f"{lo.round(3)} to {hi.round(3)}")
    area = mesh.area * UNITS[report["body"]["units_guessed"]] ** 2
    said = sum(s["area"] for s in report["surfaces"])
    table.check(where, "OBJ: area as reported", abs(area / said - 1) < 1e-3, f"{area / said:.6f}")
    uv = np.asarray(mesh.visual.uv)
    table.check(where, "OBJ: texture coordinates", len(uv) == len(mesh.vertices) and np.isfinite(uv).all(), len(uv))
    # Joints: their nodes are shared, so that the sewn garment is one.
    positions = np.unique(mesh.vertices.round(7), axis=0)
    body_count = len(trimesh.graph.connected_components(trimesh.Trimesh(mesh.vertices, mesh.faces, process=True).edges, min_len=1))
    table.check(where, "OBJ: sewn into one", body_count == 1, f"{body_count} parts, {len(positions)} nodes")


def read_glb(table, where, folder, report, garment_extents_m):
    data = (folder / "garment.glb").read_bytes()
    found = gltf_structure.problems(data)
    table.check(where, "GLB: structure", not found, found or f"{len(data)} bytes")
    scene = trimesh.load(folder / "garment.glb", process=False)
    meshes = [g for g in scene.geometry.values() if isinstance(g, trimesh.Trimesh)]
    table.check(where, "GLB: a mesh a surface", len(meshes) == len(report["surfaces"]), len(meshes))
    faces = sum(len(m.faces) for m in meshes)
    said = sum(s["faces"] for s in report["surfaces"])
    table.check(where, "GLB: triangles", faces == said, f"{faces} of {said}")
    extents = np.ptp(np.concatenate([m.bounds for m in meshes]), axis=0)
    # Sorted: the body's file may be turned, GLB stands on its feet.
    same = np.allclose(np.sort(extents), np.sort(garment_extents_m), rtol=0.25, atol=0.02)
    table.check(where, "GLB: metres, y up", same and 0.2 < extents[1] < 2.5, f"{extents.round(3)} m")


def read_pictures(table, where, folder):
    for name in ("front.png", "back.png", "pattern.png"):
        with Image.open(folder / name) as picture:
            picture.load()
            colours = len(picture.convert("RGB").resize((200, 200)).getcolors(40_000))
            sound = picture.format == "PNG" and min(picture.size) >= 400 and colours > 50
            table.check(where, f"{name}: a picture of something", sound, f"{picture.size}, {colours} colours")
            table.check(where, f"{name}: no date inside", not picture.info.keys() & {"date:create", "Creation Time", "tIME"}, sorted(picture.info))


def read_pattern_json(table, where, folder, report):
    pattern = json.loads((folder / "pattern.json").read_text())
    names = [p["name"] for p in pattern["pieces"]]
    table.check(where, "pattern.json: pieces", len(names) == len(report["pieces"]), len(names))
    worst = 0.0
    for piece in pattern["pieces"]:
        for loop in piece["sew"]:
            for chain in loop["chains"]:
                points = np.array(chain["points"])
                drawn = np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
                worst = max(worst, abs(drawn - chain["length"]))
    table.check(where, "pattern.json: drawn lengths", worst < 0.5, f"largest difference {worst:.3f} mm")
    # Sewing partners as drawn, over the sides of each seam.
    sides = {}
    for piece in pattern["pieces"]:
        for loop in piece["sew"]:
            for chain in loop["chains"]:
                for use in chain["seams"]:
                    key = (use["seam"], use["side"])
                    sides[key] = sides.get(key, 0.0) + chain["length"]
    spread = {}
    for (seam, _), length in sides.items():
        lo, hi = spread.get(seam, (length, length))
        spread[seam] = (min(lo, length), max(hi, length))
    worst = max((hi - lo for lo, hi in spread.values()), default=np.inf)
    table.check(where, "pattern.json: seam partners [mm]", worst <= 0.5, f"largest mismatch {worst:.4f} over {len(spread)} seams")


def read_symmetry(table, where, folder, report):
    if not report["body"]["file"].startswith(("form", "female", "male", "child")):
        return
    mesh = trimesh.load(folder / "garment.obj", process=False, force="mesh")
    mirrored = mesh.vertices * [-1, 1, 1]
    # Nodes of a mirrored template mirror each other.
    distance = cKDTree(mesh.vertices).query(mirrored)[0].max() * UNITS[report["body"]["units_guessed"]]
    table.check(where, "OBJ: symmetric [mm]", distance < 4.0, f"{distance:.3f}")


def run(toile, *words):
    done = subprocess.run([toile, *map(str, words)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(f"toile {' '.join(map(str, words))}: exit {done.returncode}: {done.stderr.strip()}")
    return done.stdout


def check_garment(table, toile, template, body_path, folder):
    where = f"{template.stem} on {body_path.stem}"
    try:
        report = json.loads(run(toile, "regenerate", template, "--body", body_path, "--out", folder, "--json"))
    except (RuntimeError, json.JSONDecodeError) as error:
        table.check(where, "regenerate", False, error)
        return
    body = trimesh.load(body_path, process=False, force="mesh")
    garment = trimesh.load(folder / "garment.obj", process=False, force="mesh")
    scale = UNITS[report["body"]["units_guessed"]] / 1000
    table.guarded(where, read_report, folder, report)
    table.guarded(where, read_dxf, folder, report)
    table.guarded(where, read_svg, folder, report)
    table.guarded(where, read_pdf, folder, (210, 297))
    table.guarded(where, read_obj, folder, report, body)
    table.guarded(where, read_glb, folder, report, garment.extents * scale)
    table.guarded(where, read_pictures, folder)
    table.guarded(where, read_pattern_json, folder, report)
    table.guarded(where, read_symmetry, folder, report)


def check_papers_and_dialects(table, toile, template, body, folder):
    for paper, size in (("a3", (297, 420)), ("a0", (841, 1189)), ("letter", (215.9, 279.4)), ("plotter", None)):
        out = folder / paper
        run(toile, "regenerate", template, "--body", body, "--out", out, "--formats", "pdf", "--paper", paper, "--levels", 2)
        table.guarded(f"{template.stem}, {paper}", read_pdf, out, size)
    for dialect in ("astm", "aama", "gerber", "clo", "richpeace"):
        out = folder / dialect
        words = ("--formats", "dxf", "--dxf", dialect, "--levels", 3, "--json")
        report = json.loads(run(toile, "regenerate", template, "--body", body, "--out", out, *words))
        table.guarded(f"{template.stem}, {dialect}", read_dxf, out, report)


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("--toile", default=ROOT / "target/release/toile", type=Path)
    words.add_argument("--body", action="append", default=[], type=Path, help="also on this body; may be given again")
    given = words.parse_args()
    templates = [p for p in sorted((ROOT / "samples").glob("*.json")) if '"toile_template"' in p.read_text()]
    table = Table()
    table.check("samples", "templates", len(templates) >= 2, [p.stem for p in templates])
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        form = folder / "form.obj"
        run(given.toile, "form", "--bust", 97.4, "--waist", 80.3, "--hip", 104.1, "--height", 166.2, "-o", form)
        for template in templates:
            for body in [form, *given.body]:
                check_garment(table, given.toile, template, body, folder / template.stem / body.stem)
        if templates:
            check_papers_and_dialects(table, given.toile, templates[0], form, folder / "variants")
    return 1 if table.print() else 0


if __name__ == "__main__":
    sys.exit(main())
