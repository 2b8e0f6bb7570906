#!/usr/bin/env python3
"""Thickening beside Blender's Solidify modifier, in turn, CPU seconds. By hand, not in CI.

    python3.11 -m venv VENV && VENV/bin/pip install 'bpy==4.5.*' scipy libigl==2.6.1
    cargo build --release
    VENV/bin/python tests/peers/blender_solidify.py [--rounds N] [--cells N] [--judge]

Blender: mode 'complex' (NON_MANIFOLD), thickness evened, rim filled; timed are the modifier alone, and from an OBJ file to an OBJ
file with Blender's own reader and writer. Ours is the whole command on one thread, OBJ to OBJ, start of the program
included. The least of all rounds counts.
"""

import argparse
import contextlib
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import bpy
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/thicken"))

import analytic_sheets  # noqa: E402
import solid_checks  # noqa: E402
from sheet_files import read_solid, write_obj  # noqa: E402

# Cells a side that give some 20,000 triangles.
CELLS = {"fold": 71, "tee": 58, "cross": 50, "wye": 58, "open_box": 45, "parted_box": 33, "dome": 71, "finned_saddle": 41}
THICKNESS = 2.0


def modifier_of(thing):
    modifier = thing.modifiers.new("solidify", "SOLIDIFY")
    modifier.solidify_mode = "NON_MANIFOLD"
    modifier.nonmanifold_thickness_mode = "EVEN"
    modifier.thickness = THICKNESS
    modifier.offset = 0.0
    modifier.use_rim = True


def solidified(sheet):
    """CPU seconds of the modifier, and the solid's arrays."""
    mesh = bpy.data.meshes.new("sheet")
    mesh.from_pydata(sheet.nodes.tolist(), [], sheet.faces.tolist())
    thing = bpy.data.objects.new("sheet", mesh)
    bpy.context.scene.collection.objects.link(thing)
    bpy.context.view_layer.update()
    modifier_of(thing)
    start = time.process_time()
    graph = bpy.context.evaluated_depsgraph_get()
    graph.update()
    made = thing.evaluated_get(graph).to_mesh()
    spent = time.process_time() - start
    made.calc_loop_triangles()
    nodes = np.empty(3 * len(made.vertices))
    made.vertices.foreach_get("co", nodes)
    faces = np.empty(3 * len(made.loop_triangles), np.int32)
    made.loop_triangles.foreach_get("vertices", faces)
    bpy.data.objects.remove(thing)
    bpy.data.meshes.remove(mesh)
    return spent, nodes.reshape(-1, 3), faces.reshape(-1, 3).astype(np.int64)


def from_file_to_file(path, solid):
    """CPU seconds."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    start = time.process_time()
    with quiet():
        bpy.ops.wm.obj_import(filepath=str(path))
        for thing in bpy.data.objects:
            modifier_of(thing)
        words = {"export_materials": False, "export_uv": False, "export_normals": False, "apply_modifiers": True}
        bpy.ops.wm.obj_export(filepath=str(solid), **words)
    return time.process_time() - start


@contextlib.contextmanager
def quiet():
    """Blender tells of every file that it reads or writes, past Python."""
    sys.stdout.flush()
    kept, nothing = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nothing, 1)
    try:
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)
        os.close(nothing)


def ours(toile, path, solid):
    """CPU seconds of the command."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    words = [toile, "thicken", path, "--thickness", THICKNESS, "-o", solid, "--json", "--threads", 1]
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        raise RuntimeError(done.stderr.strip())
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("--toile", type=Path, default=ROOT / "target/release/toile")
    words.add_argument("--rounds", type=int, default=5)
    words.add_argument("--cells", type=int, help="cells a side of every patch, instead of some 20,000 triangles")
    words.add_argument("--judge", action="store_true", help="also say what is wrong with Blender's solids")
    given = words.parse_args()
    print(f"Blender {bpy.app.version_string}, t = {THICKNESS:g} mm, least of {given.rounds} rounds, CPU seconds")
    head = ["sheet", "triangles", "modifier", "to file", "ours", "to file", "modifier", "out Blender", "out ours"]
    print("{:<15}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}{:>13}{:>10}".format(*head))
    with tempfile.TemporaryDirectory() as folder:
        for kind in analytic_sheets.ALL:
            sheet = kind(given.cells or CELLS[kind.__name__], THICKNESS)
            path, solid = Path(folder) / "sheet.obj", Path(folder) / "solid.obj"
            write_obj(path, sheet)
            times = []
            for _ in range(given.rounds):
                spent, nodes, faces = solidified(sheet)
                whole = from_file_to_file(path, Path(folder) / "theirs.obj")
                times.append((spent, whole, ours(given.toile, path, solid)))
            modifier, whole, own = np.min(times, axis=0)
            out = len(read_solid(solid)[1])
            ratios = f"{own / whole:>9.2f}x{own / modifier:>9.2f}x"
            print(f"{sheet.name:<15}{len(sheet.faces):>10}{modifier:>10.3f}{whole:>10.3f}{own:>10.3f}{ratios}{len(faces):>13}{out:>10}", flush=True)
            if given.judge:
                print("               Blender: " + ("; ".join(solid_checks.problems(nodes, faces)) or "sound"), flush=True)


if __name__ == "__main__":
    main()
