#!/usr/bin/env python3
"""Reference values for the mesh queries, computed by libigl on analytic meshes that this script makes itself.

    python tests/reference/make_queries.py        (needs numpy and libigl)

writes data/bumpy-sphere.obj, data/holed-torus.obj and data/queries.json:
winding numbers, distances and exact geodesic distances (MMP) between nodes. Millimetres.
"""

import json
import pathlib

import igl
import numpy as np

DATA = pathlib.Path(__file__).parent / "data"


def grid(around, across, place):
    """A closed grid of quads cut in two, faces outward."""
    u, v = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    positions = place(u.ravel() / around * 2 * np.pi, v.ravel() / across * 2 * np.pi)
    at = lambda i, j: (i % around) * across + j % across
    a, b, c, d = at(u, v), at(u, v + 1), at(u + 1, v), at(u + 1, v + 1)
    faces = np.stack([np.stack([a, b, c], -1), np.stack([c, b, d], -1)], 2).reshape(-1, 3)
    return positions, faces


def torus(around, across):
    def place(u, v):
        tube = 100 + 12 * np.sin(4 * u) * np.cos(3 * v)
        ring = 300 + tube * np.cos(v)
        return np.stack([ring * np.cos(u), tube * np.sin(v), ring * np.sin(u)], -1)

    return grid(around, across, place)


def bumpy_sphere(levels):
    """An octahedron split and blown up, with bumps."""
    positions = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
    positions = [np.array(p, float) for p in positions]
    faces = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    for _ in range(levels):
        middles, split = {}, []

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in middles:
                m = positions[a] + positions[b]
                positions.append(m / np.linalg.norm(m))
                middles[key] = len(positions) - 1
            return middles[key]

        for a, b, c in faces:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            split += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        faces = split
    p = np.array(positions)
    bumps = 1 + 0.08 * np.sin(5 * p[:, 0]) * np.cos(4 * p[:, 1]) + 0.05 * np.sin(6 * p[:, 2])
    return 100 * p * bumps[:, None], np.array(faces)


def write_obj(name, positions, faces):
    lines = [f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in positions]
    lines += [f"f {a} {b} {c}" for a, b, c in faces + 1]
    (DATA / f"{name}.obj").write_text("\n".join(lines) + "\n")


def main():
    DATA.mkdir(exist_ok=True)
    rng = np.random.default_rng(1)
    sphere = bumpy_sphere(3)
    positions, faces = torus(48, 24)
    middle = positions[faces].mean(1)
    # Three holes of different size.
    keep = (middle[:, 0] < 330) & ~((middle[:, 2] > 290) & (middle[:, 1] > 0)) & (np.arange(len(faces)) % 211 != 7)
    ring = (positions, faces[keep])
    out = {}
    for name, (positions, faces) in {"bumpy-sphere": sphere, "holed-torus": ring}.items():
        positions = np.round(positions, 6)
        write_obj(name, positions, faces)
        lo, hi = positions.min(0) - 50, positions.max(0) + 50
        points = np.round(rng.uniform(lo, hi, (150, 3)), 3)
        near = positions[faces].mean(1)[rng.integers(0, len(faces), 150)]
        points = np.vstack([points, np.round(near + rng.normal(0, 8, near.shape), 3)])
        faces64 = faces.astype(np.int64)
        squared, _, _ = igl.point_mesh_squared_distance(points, positions, faces64)
        winding = igl.winding_number(positions, faces64, points)
        record = {
            "points": points.tolist(),
            "distance": np.sqrt(squared).tolist(),
            "winding": winding.tolist(),
            "area": float(igl.doublearea(positions, faces64).sum() / 2),
        }
        if name == "bumpy-sphere":
            source = 0
            targets = rng.integers(1, len(positions), 60)
            exact = igl.exact_geodesic(
                positions, faces64, np.array([source]), np.array([], np.int64), targets.astype(np.int64), np.array([], np.int64)
            )
            record["geodesic"] = {"source": source, "targets": targets.tolist(), "length": np.asarray(exact).tolist()}
        out[name] = record
    (DATA / "queries.json").write_text(json.dumps(out))


main()
