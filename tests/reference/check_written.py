#!/usr/bin/env python3
"""Reads the files that `TOILE_WRITE_FILES=DIR cargo test -p mesh_kernel --test all files::reference` writes with trimesh and
pymeshlab, and compares corners with the OBJ among them as trimesh reads it.

    python tests/reference/check_written.py DIR
"""

import pathlib
import sys

import numpy as np
import pymeshlab
import trimesh


def corners_of(mesh):
    return np.asarray(mesh.vertices)[np.asarray(mesh.faces)]


def by_trimesh(path):
    loaded = trimesh.load(path, process=False)
    if isinstance(loaded, trimesh.Scene):
        return np.vstack([corners_of(g) for g in loaded.dump() if isinstance(g, trimesh.Trimesh)])
    return corners_of(loaded)


def by_pymeshlab(path):
    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(str(path))
    all_corners = []
    for mesh in meshes:
        matrix = mesh.vertex_matrix()
        place = mesh.transform_matrix()
        matrix = matrix @ place[:3, :3].T + place[:3, 3]
        all_corners.append(matrix[mesh.face_matrix()])
    return np.vstack(all_corners)


def in_order(corners):
    """Faces by their centre: readers may order the groups of a file anew."""
    centre = np.round(corners.mean(1), 3)
    return corners[np.lexsort(centre.T)]


def main():
    folder = pathlib.Path(sys.argv[1])
    want = in_order(by_trimesh(folder / "mesh.obj"))
    bad = 0
    for path in sorted(folder.iterdir()):
        for reader in (by_trimesh, by_pymeshlab):
            try:
                got = in_order(reader(path) * (1000.0 if path.suffix == ".glb" else 1.0))
                same = got.shape == want.shape and np.abs(got - want).max() < 1e-4
            except Exception as error:  # a reader that lacks the format says so here
                same, got = False, repr(error)
            bad += not same
            print(f"{path.name:20} {reader.__name__:14} {'same' if same else f'DIFFERS {got if isinstance(got, str) else got.shape}'}")
    sys.exit(bad > 0)


main()
