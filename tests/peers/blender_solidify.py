#!/usr/bin/env python3
"""Thickening beside Blender's Solidify modifier, in turn, CPU seconds. By hand, not in CI.

    python3.11 -m venv VENV && VENV/bin/pip install 'bpy==4.5.*' scipy libigl==2.6.1
    cargo build --release
    VENV/bin/python tests/peers/blender_solidify.py [--rounds N] [--cells N] [--judge]

Blender: mode 'complex' (NON_MANIFOLD), thickness evened, rim filled. Timed is the modifier's evaluation alone, of the
process's CPU time; of ours the whole command on one thread, files read and written, and beside it what it says it spent
between the two. The least of all rounds counts.
"""

import argparse
import json
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


def solidified(sheet):
    """Seconds and the solid's arrays."""
    mesh = bpy.data.meshes.new("sheet")
    mesh.from_pydata(sheet.nodes.tolist(), [], sheet.faces.tolist())
    thing = bpy.data.objects.new("sheet", mesh)
    bpy.context.scene.collection.objects.link(thing)
    modifier = thing.modifiers.new("solidify", "SOLIDIFY")
    modifier.solidify_mode = "NON_MANIFOLD"
    modifier.nonmanifold_thickness_mode = "EVEN"
    modifier.thickness = THICKNESS
    modifier.offset = 0.0
    modifier.use_rim = True
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


def ours(toile, path, solid):
    """CPU seconds of the command, and of what it says between reading and writing."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    words = [toile, "thicken", path, "--thickness", THICKNESS, "-o", solid, "--json", "--threads", 1]
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        raise RuntimeError(done.stderr.strip())
    steps = json.loads(done.stdout)["step_seconds"]
    inside = sum(s["seconds"] for s in steps if s["step"] != "encoding")
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, inside


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("--toile", type=Path, default=ROOT / "target/release/toile")
    words.add_argument("--rounds", type=int, default=5)
    words.add_argument("--cells", type=int, help="cells a side of every patch, instead of some 20,000 triangles")
    words.add_argument("--judge", action="store_true", help="also say what is wrong with Blender's solids")
    given = words.parse_args()
    print(f"Blender {bpy.app.version_string}, t = {THICKNESS:g} mm, least of {given.rounds} rounds, CPU seconds")
    print("{:<15}{:>10}{:>10}{:>10}{:>10}{:>8}{:>12}{:>12}".format("sheet", "triangles", "Blender", "command", "work", "ratio", "out Blender", "out ours"))
    with tempfile.TemporaryDirectory() as folder:
        for kind in analytic_sheets.ALL:
            sheet = kind(given.cells or CELLS[kind.__name__], THICKNESS)
            path, solid = Path(folder) / "sheet.obj", Path(folder) / "solid.obj"
            write_obj(path, sheet)
            times = []
            for _ in range(given.rounds):
                spent, nodes, faces = solidified(sheet)
                times.append((spent, *ours(given.toile, path, solid)))
            theirs, command, work = np.min(times, axis=0)
            out = len(read_solid(solid)[1])
            print(f"{sheet.name:<15}{len(sheet.faces):>10}{theirs:>10.3f}{command:>10.3f}{work:>10.3f}{work / theirs:>8.2f}{len(faces):>12}{out:>12}", flush=True)
            if given.judge:
                print("               Blender: " + ("; ".join(solid_checks.problems(nodes, faces)) or "sound"), flush=True)


if __name__ == "__main__":
    main()
