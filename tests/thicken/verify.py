#!/usr/bin/env python3
"""Thickens many sheets with the built binary and checks every solid with code that knows nothing of it.

    python -m pip install -r tests/readers/requirements.txt
    cargo build --release
    python tests/thicken/verify.py                       what CI runs: two minutes
    python tests/thicken/verify.py long --judge CHECKS   an hour and more; see README.md
    python tests/thicken/verify.py table --judge CHECKS  accuracy and time on the analytic sheets
    python tests/thicken/verify.py seed 17               one random sheet again

Exit 1 when any solid is not one; the sheets of those are kept in --keep, each with its call.
"""

import argparse
import importlib
import json
import resource
import subprocess
import sys
import tempfile
import time
import traceback
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

import analytic_sheets
import random_sheets
import solid_checks
from sheet_files import Sheet, read_solid, write_obj

ROOT = Path(__file__).resolve().parents[2]


@dataclass
class Case:
    """A sheet, or where it lies, and the words with which it is thickened."""

    name: str
    make: tuple  # ("analytic", kind, cells, t), ("random", seed), ("file", path, t)
    words: list = field(default_factory=list)
    format: str = "obj"


@dataclass
class Verdict:
    name: str
    problems: list
    call: str = ""
    seconds: float = 0.0
    faces: int = 0


@dataclass
class Bench:
    """What every worker needs to know."""

    toile: Path
    keep: Path
    judge: Path | None
    limit: float


def made(case):
    kind, *rest = case.make
    if kind == "analytic":
        name, cells, t = rest
        return getattr(analytic_sheets, name)(cells, t), []
    if kind == "random":
        return random_sheets.of_seed(rest[0])
    path, t = rest
    return Path(path), ["--thickness", repr(t)]


def judged(case, bench):
    """One case from the sheet to the verdict; whatever is thrown is a finding."""
    try:
        return _judged(case, bench)
    except Exception:  # noqa: BLE001: a checker that fails has not said that the solid is good
        return Verdict(case.name, [traceback.format_exc(limit=3).strip().splitlines()[-1]])


def _judged(case, bench):
    sheet, words = made(case)
    with tempfile.TemporaryDirectory() as folder:
        if isinstance(sheet, Sheet):
            path = Path(folder) / "sheet.obj"
            write_obj(path, sheet)
            words = ["--thickness", repr(sheet.thickness), *words]
        else:
            path = sheet
        solid = Path(folder) / f"solid.{case.format}"
        words = [*words, *case.words]
        call = [str(bench.toile), "thicken", str(path), *words, "-o", str(solid), "--json", "--threads", "1"]
        verdict = Verdict(case.name, [])
        start = time.monotonic()
        try:
            done = subprocess.run(call, capture_output=True, text=True, timeout=bench.limit, check=False)
        except subprocess.TimeoutExpired:
            verdict.problems.append(f"not done after {bench.limit:.0f} s")
        else:
            verdict.seconds = time.monotonic() - start
            if done.returncode != 0:
                verdict.problems.append(f"exit {done.returncode}: {' '.join(done.stderr.split())[:200]}")
            else:
                verdict.problems += found(sheet, words, solid, json.loads(done.stdout), bench, verdict)
        if verdict.problems:
            bench.keep.mkdir(parents=True, exist_ok=True)
            kept = bench.keep / f"{case.name}{path.suffix}"
            kept.write_bytes(path.read_bytes())
            verdict.call = f"toile thicken {kept} {' '.join(words)} -o solid.{case.format}"
        return verdict


def found(sheet, words, solid, report, bench, verdict):
    nodes, faces = read_solid(solid)
    verdict.faces = len(faces)
    problems = solid_checks.problems(nodes, faces)
    volume = solid_checks.volume(nodes, faces)
    if not report["closed"] or report["self_intersections"]:
        problems.append("the report says that it is not sound")
    if report["faces"] != len(faces):
        problems.append(f"the report says {report['faces']} faces, the file has {len(faces)}")
    unit = report["sheet"]["unit_mm"]
    if abs(volume * unit**3 / report["volume"] - 1) > 1e-6:
        problems.append(f"the report says a volume of {report['volume']}, the file has {volume * unit**3}")
    if isinstance(sheet, Sheet):
        ideal = sheet.mitred if "mitre" in words else sheet.rounded
        if ideal is not None:
            # STL holds 24 binary digits: so far may the two sides of a wall be off.
            single = 2**-23 * 2 * sheet.size / sheet.thickness if solid.suffix == ".stl" else 0
            tolerance = sheet.tolerance + single
            if abs(volume / ideal - 1) > tolerance:
                problems.append(f"volume {volume:.6f} instead of {ideal:.6f}")
        if volume <= 0:
            problems.append(f"volume {volume}")
    if bench.judge:
        checks = oracle(bench.judge, "checks")
        second = checks.check_solid((nodes, faces), mlab=False)
        if second["valid"] is not True:
            told = {k: v for k, v in second.items() if k in ("closed", "oriented", "edge_manifold", "vertex_manifold", "self_intersections", "degenerate", "outward_and_nested")}
            problems.append(f"judged: {told}")
    return problems


def oracle(folder, name):
    """A module from a folder of checks that others have written."""
    if str(folder) not in sys.path:
        sys.path.append(str(folder))
    return importlib.import_module(name)


def short_cases(count):
    cases = []
    for kind in analytic_sheets.ALL:
        name = kind.__name__
        for k, t in enumerate((0.5, 2.0, 5.0)):
            corners = ("round", "mitre")[k % 2]
            cases.append(analytic(name, 3 if name != "dome" else 8, t, corners, ("obj", "stl")[k % 2]))
        cases.append(analytic(name, 3 if name != "dome" else 8, 2.0, "round", "stl"))
    for name, cells in (("tee", 30), ("fold", 30), ("open_box", 16), ("dome", 24), ("finned_saddle", 16)):
        cases.append(analytic(name, cells, 2.0, "round", "obj"))
    # Cells smaller than half the thickness, where the walls of neighbours overlap.
    cases.append(analytic("tee", 96, 2.0, "mitre", "obj"))
    cases.append(analytic("parted_box", 24, 5.0, "round", "stl"))
    return cases + [seeded(seed) for seed in range(count)]


def analytic(name, cells, t, corners, form):
    return Case(f"{name}-{cells}-t{t:g}-{corners}-{form}", ("analytic", name, cells, t), ["--corners", corners], form)


def seeded(seed):
    return Case(f"random-{seed}", ("random", seed), format="stl" if seed // len(random_sheets.KINDS) % 3 == 2 else "obj")


def long_cases(given, folder):
    """Everything: random sheets, shared ones, the analytic ones of the judge, fine tees, garments on bodies."""
    cases = [seeded(seed) for seed in range(given.first_seed, given.first_seed + given.count)]
    for cells in (10, 20, 40, 80, 120, 200):
        cases += [analytic("tee", cells, 2.0, corners, "obj") for corners in ("round", "mitre")]
    both = (("round", "obj"), ("mitre", "stl"))
    for path in sorted(given.sheets.glob("*.obj")) if given.sheets else []:
        cases += filed(path, (0.5, 2.0, 5.0), both)
    if given.judge:
        sheets = oracle(given.judge, "sheets")
        for name, make in sheets.ALL.items():
            for fine in (False, True):
                made = make(fine)
                path = folder / f"{name}-{'fine' if fine else 'coarse'}.obj"
                write_obj(path, Sheet(name, made.V, made.F, made.patch, made.t))
                cases += filed(path, (0.5, 2.0, 5.0), both)
    for body in sorted(given.bodies.glob("*.obj"))[: given.body_count] if given.bodies else []:
        for template in sorted((ROOT / "samples").glob("*.json")):
            if '"toile_template"' not in template.read_text():
                continue
            out = folder / f"{template.stem}-{body.stem}"
            words = ["regenerate", template, "--body", body, "--out", out, "--formats", "obj", "--quiet"]
            subprocess.run([given.toile, *words], check=True)
            cases += filed(out / "garment.obj", (1.0, 4.0), (("round", "stl"),), out.name)
    return cases


def filed(path, thicknesses, ways, name=None):
    name = name or path.stem
    return [
        Case(f"{name}-t{t:g}-{corners}-{form}", ("file", str(path), t), ["--corners", corners], form)
        for t in thicknesses
        for corners, form in ways
    ]


def run(cases, bench, processes):
    start = time.monotonic()
    failed, faces, slowest = [], 0, Verdict("", [])
    with ProcessPoolExecutor(processes) as pool:
        for k, verdict in enumerate(pool.map(judged, cases, [bench] * len(cases))):
            faces += verdict.faces
            slowest = max(slowest, verdict, key=lambda v: v.seconds)
            if verdict.problems:
                failed.append(verdict)
                print(f"FAIL  {verdict.name}: {'; '.join(verdict.problems)}\n      {verdict.call}", flush=True)
            elif (k + 1) % 100 == 0:
                print(f"{k + 1} of {len(cases)}, {len(failed)} failed", file=sys.stderr, flush=True)
    width = max((len(v.name) for v in failed), default=0)
    if failed:
        print("\nsheets without a sound solid")
    for verdict in failed:
        print(f"  {verdict.name:<{width}}  {'; '.join(verdict.problems)[:180]}")
    print(f"{len(cases)} solids of {faces} triangles, {len(failed)} failed, {time.monotonic() - start:.0f} s; slowest {slowest.name}, {slowest.seconds:.1f} s")
    return 1 if failed else 0


def table(given):
    """Accuracy and time on the judge's analytic sheets, as it measures them."""
    checks, sheets, measure = (oracle(given.judge, name) for name in ("checks", "sheets", "measure"))
    head = ["sheet", "t", "corners", "valid", "wall mean", "wall max", "flat max", "volume", "spike", "out/in", "slivers", "seconds", "CPU s"]
    print(("{:<20}" + "{:>10}" * (len(head) - 1)).format(*head))
    bad = 0
    for name, make in sheets.ALL.items():
        for fine in (False, True):
            for t in (0.5, 2.0, 5.0):
                for corners in ("round", "mitre"):
                    sheet = make(fine, t)
                    row, valid = measured(given, sheet, corners, checks, measure)
                    bad += not valid
                    title = f"{name} {'fine' if fine else 'coarse'}"
                    print(("{:<20}" + "{:>10}" * (len(head) - 1)).format(title, f"{t:g}", corners, *row), flush=True)
    return 1 if bad else 0


def measured(given, sheet, corners, checks, measure):
    with tempfile.TemporaryDirectory() as folder:
        path, solid = Path(folder) / "sheet.obj", Path(folder) / "solid.obj"
        write_obj(path, Sheet(sheet.name, sheet.V, sheet.F, sheet.patch, sheet.t))
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        words = [given.toile, "thicken", path, "--thickness", repr(sheet.t), "--corners", corners, "-o", solid, "--json", "--threads", "1"]
        done = subprocess.run([str(w) for w in words], capture_output=True, text=True, check=False, timeout=given.limit)
        spent = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
        if done.returncode != 0:
            return [f"exit {done.returncode}"] + ["-"] * 9, False
        nodes, faces = read_solid(solid)
        seconds = json.loads(done.stdout)["seconds"]
    facts = measure.measure(sheet, nodes, faces)
    number = lambda key: "-" if facts.get(key) is None else f"{facts[key]:.1e}"
    slivers = [checks.degenerate(v, f)["slivers"] for v, f in ((sheet.V, sheet.F), (nodes, faces))]
    row = [str(facts["valid"]), number("wall_mean"), number("wall_max"), number("flat_max")]
    row += [number("vol_err_miter" if corners == "mitre" else "vol_err_round"), f"{facts['spike']:.3f}"]
    row += [f"{len(faces) / len(sheet.F):.2f}", f"{slivers[0]}/{slivers[1]}", f"{seconds:.2f}", f"{spent:.2f}"]
    return row, facts["valid"] is True


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("what", nargs="?", default="short", choices=["short", "long", "table", "seed"])
    words.add_argument("seeds", nargs="*", type=int, help="random sheets to run again")
    words.add_argument("--toile", type=Path, default=ROOT / "target/release/toile")
    words.add_argument("--keep", type=Path, default=ROOT / "target/thicken-failures", help="where sheets that failed are kept")
    words.add_argument("--judge", type=Path, help="a folder with checks.py, sheets.py and measure.py, asked as well")
    words.add_argument("--sheets", type=Path, help="a folder of sheets (long)")
    words.add_argument("--bodies", type=Path, help="a folder of bodies on which the samples are built (long)")
    words.add_argument("--body-count", type=int, default=3)
    words.add_argument("--count", type=int, help="random sheets; 60, long 1000")
    words.add_argument("--first-seed", type=int, default=0)
    words.add_argument("--processes", type=int, default=2)
    words.add_argument("--limit", type=float, default=300.0, help="seconds that one sheet may take")
    given = words.parse_args()
    bench = Bench(given.toile, given.keep, given.judge, given.limit)
    if given.what == "table":
        if not given.judge:
            words.error("table needs --judge")
        return table(given)
    if given.what == "seed":
        return run([seeded(seed) for seed in given.seeds], bench, given.processes)
    if given.what == "short":
        return run(short_cases(60 if given.count is None else given.count), bench, given.processes)
    given.count = 1000 if given.count is None else given.count
    with tempfile.TemporaryDirectory() as folder:
        return run(long_cases(given, Path(folder)), bench, given.processes)


if __name__ == "__main__":
    sys.exit(main())
