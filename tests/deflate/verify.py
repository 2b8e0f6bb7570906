"""Judges mid-surfaces with another party's oracles; see README.md."""

import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TOILE = str(ROOT / "target/release/toile")
# Parts of plane walls must meet these; others are printed.
COVERAGE, RELATIVE, HAUSDORFF = 1.0, 1e-6, 1e-6


def toile(*words):
    done = subprocess.run([TOILE, *map(str, words)], capture_output=True, text=True, timeout=300)
    if done.returncode:
        raise RuntimeError(f"toile {' '.join(map(str, words))}: {done.stderr.strip()[:400]}")
    return done.stdout


def parts(folder, work):
    import oracles

    missed = []
    for solid in sorted(p for p in folder.iterdir() if p.suffix in (".obj", ".stl")):
        truth = json.loads((folder / (re.sub("-(coarse|fine)$", "", solid.stem) + ".json")).read_text())
        sheet = work / (solid.name.replace(".", "-") + ".obj")
        report = json.loads(toile("deflate", solid, "-o", sheet, "--json", "-q"))
        r = oracles.judge_truth(str(solid), str(sheet), None, truth)
        plane = "curved" if solid.stem.startswith(("cover", "hemi", "mouse", "rounded", "tube", "panel")) else "plane"
        fine = r["crack_length"] == r["gap_length"] == 0 and r["topology"]["components"] == 1
        stepped = solid.stem.startswith("stepped-flush")
        exact = r["coverage"] >= COVERAGE and (stepped or abs(r["area_error"]) <= RELATIVE)
        if plane == "plane" and not (fine and exact and (stepped or not r["topology_diff"])):
            missed.append(solid.name)
        print(
            f"{solid.name:26} {plane:6} coverage {r['coverage']:.4f}  thickness mean {r['thickness_mean']:.1e} p99 {r['thickness_p99']:.1e}"
            f"  area {r['area_error']:+.1e}  cracks {r['crack_length']:.2g} gaps {r['gap_length']:.2g}  crossing {r['self_intersections']}"
            f"  topology {r['topology_diff'] or 'as it should be'}  {report['seconds']:.2f} s",
            flush=True,
        )
    return missed


def round_trip(folder, work):
    import checks
    import oracles

    missed = []
    for sheet in sorted(folder.glob("*.obj")):
        nodes = checks.load(str(sheet))[0]
        size = float((nodes.max(0) - nodes.min(0)).max())
        for percent in (1, 3, 8):
            t = size * percent / 100
            solid, back = work / "solid.obj", work / "back.obj"
            toile("thicken", sheet, "--thickness", t, "-o", solid, "-q")
            toile("deflate", solid, "-o", back, "-q")
            r = oracles.compare_sheets(str(sheet), str(back), t)
            curved = sheet.stem.startswith(("hemi", "saddle"))
            if not curved and not (r["topology_ok"] and r["hausdorff"] <= HAUSDORFF):
                missed.append(f"{sheet.name} {percent} %")
            print(
                f"{sheet.name:28} {percent} %  Hausdorff {r['hausdorff']:.1e} t  area {r['area_ratio'] - 1:+.1e}"
                f"  topology {r['topology_diff'] or 'equal'}",
                flush=True,
            )
    return missed


def shell_tip(fea, inp, clamp, load, force):
    """Tip displacement of a written shell model, with supports and loads put at its end as they are."""
    import numpy as np

    nodes, elements, kind = [], [], None
    for line in Path(inp).read_text().splitlines():
        if line.startswith("*"):
            kind = line.split(",")[0]
        elif kind == "*NODE":
            nodes.append([float(x) for x in line.split(",")[1:]])
        elif kind == "*ELEMENT":
            elements.append([int(x) - 1 for x in line.split(",")[1:]])
    nodes = np.array(nodes)
    sides = {m: (p, q) for a, b, c, ab, bc, ca in elements for m, p, q in ((ab, a, b), (bc, b, c), (ca, c, a))}
    loaded = [(p, q, m) for m, (p, q) in sides.items() if load(nodes[p]) and load(nodes[q])]
    lengths = [float(np.linalg.norm(nodes[p] - nodes[q])) for p, q, _ in loaded]
    share = {}
    for ends, length in zip(loaded, lengths):
        for node, part in zip(ends, (1 / 6, 1 / 6, 4 / 6)):
            share[node] = share.get(node, 0) + part * length / sum(lengths)
    loads = {node: part * np.asarray(force, float) for node, part in share.items()}
    deck = [Path(inp).read_text().rstrip(), "*NSET, NSET=NCLAMP"]
    deck += [f"{k + 1}," for k, p in enumerate(nodes) if clamp(p)] + ["*NSET, NSET=NLOAD"] + [f"{k + 1}," for k in loads]
    deck += ["*BOUNDARY", "NCLAMP,1,6", "*STEP", "*STATIC", "*CLOAD"]
    deck += [f"{k + 1},{d + 1},{f[d]:.12g}" for k, f in loads.items() for d in range(3) if f[d]]
    deck += ["*NODE PRINT, NSET=NLOAD", "U", "*END STEP", ""]
    with tempfile.TemporaryDirectory() as folder:
        return fea._compliance(fea._run("\n".join(deck), folder), loads, force)


def shells(work):
    import fea
    import gmsh
    import numpy as np
    import sheets

    cases, t, h = fea.cases(), 2.0, 1.0
    channel = sheets.Builder()
    for side in ((0, 40, 0, -20), (0, 0, 20, -20), (0, 0, 20, 20)):
        channel.plane((0, side[3], 0), (100, 0, 0), side[:3], 20, 6)
    boxes = [(0, -21, -h, 100, 42, t), (0, -21, -h, 100, t, 21), (0, 19, -h, 100, t, 21)]
    end, root = (lambda p: p[0] > 100 - 1e-4), (lambda p: p[0] < 1e-4)
    cases["channel"] = dict(sheet=channel.sheet("channel", t), boxes=boxes, clamp=root, load=end, force=(0, 0, -10.0))
    missed = []
    for name, case in cases.items():
        gmsh.initialize(interruptible=False)
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("Mesh.Binary", 1)
        solids = [(3, gmsh.model.occ.addBox(*map(float, b))) for b in case["boxes"]]
        if len(solids) > 1:
            gmsh.model.occ.fuse(solids[:1], solids[1:])
        gmsh.model.occ.synchronize()
        gmsh.option.setNumber("Mesh.MeshSizeMax", 8)
        gmsh.model.mesh.generate(2)
        skin, inp = work / f"{name}.stl", work / f"{name}.inp"
        gmsh.write(str(skin))
        gmsh.finalize()
        toile("deflate", skin, "-o", work / f"{name}.obj", "--inp", inp, "--edge-length", 3.5, "-q")
        # Single precision: a place counts as well if it would a hair farther out.
        hair = (np.zeros(3), np.array([2e-5, 0, 0]), np.array([-2e-5, 0, 2e-5]))
        near = lambda where: lambda p: any(where(p + d) for d in hair)
        ours = shell_tip(fea, inp, near(case["clamp"]), near(case["load"]), case["force"])
        s = case["sheet"]
        exact = fea.shell_tip(s.V, s.F, s.t, case["clamp"], case["load"], case["force"], max_edge=3.6)["tip"]
        solid = fea.solid_tip(fea.boxes_mesh(case["boxes"], 2.0), case["clamp"], case["load"], case["force"])["tip"]
        if abs(ours / exact - 1) > 1e-3 or abs(ours / solid - 1) > 1.5e-2:
            missed.append(name)
        print(
            f"{name:8} {ours:.6g} mm; exact mid-surface {exact:.6g} ({ours / exact - 1:+.3%}); solid {solid:.6g} ({ours / solid - 1:+.3%})",
            flush=True,
        )
    return missed


def main():
    what, checks, *folders = sys.argv[1:]
    sys.path.insert(0, checks)
    with tempfile.TemporaryDirectory() as work:
        work = Path(work)
        run = {"parts": parts, "round-trip": round_trip}.get(what)
        missed = run(Path(folders[0]), work) if run else shells(work)
    if missed:
        print("missed:", ", ".join(missed))
    return bool(missed)


if __name__ == "__main__":
    sys.exit(main())
