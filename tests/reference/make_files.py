#!/usr/bin/env python3
"""Mesh files as pymeshlab and trimesh write them, of a small torus that this script makes itself.

    python tests/reference/make_files.py          (needs numpy, pymeshlab and trimesh)

writes data/files/* and data/files.json: for each file the corners of all faces, sorted, as the library itself reads
them back.
"""

import json
import pathlib

import numpy as np
import pymeshlab
import trimesh

DATA = pathlib.Path(__file__).parent / "data"


def torus(around, across):
    u, v = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    a, b = u.ravel() / around * 2 * np.pi, v.ravel() / across * 2 * np.pi
    ring = 3 + np.cos(b)
    positions = np.stack([ring * np.cos(a), np.sin(b), ring * np.sin(a)], -1)
    at = lambda i, j: (i % around) * across + j % across
    w, x, y, z = at(u, v), at(u, v + 1), at(u + 1, v), at(u + 1, v + 1)
    return positions, np.stack([np.stack([w, x, y], -1), np.stack([y, x, z], -1)], 2).reshape(-1, 3)


def main():
    folder = DATA / "files"
    folder.mkdir(parents=True, exist_ok=True)
    positions, faces = torus(8, 5)
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(positions, faces.astype(np.int32)))
    meshes.save_current_mesh(str(folder / "pymeshlab.obj"))
    meshes.save_current_mesh(str(folder / "pymeshlab-binary.ply"), binary=True)
    meshes.save_current_mesh(str(folder / "pymeshlab-ascii.ply"), binary=False)
    meshes.save_current_mesh(str(folder / "pymeshlab-binary.stl"), binary=True)
    meshes.save_current_mesh(str(folder / "pymeshlab-ascii.stl"), binary=False)
    meshes.save_current_mesh(str(folder / "pymeshlab.off"))
    mesh = trimesh.Trimesh(positions, faces, process=False)
    for name, kind in [("trimesh.glb", "glb"), ("trimesh.obj", "obj"), ("trimesh.off", "off"), ("trimesh.stl", "stl")]:
        exported = mesh.export(file_type=kind)
        (folder / name).write_bytes(exported.encode() if isinstance(exported, str) else exported)
    (folder / "trimesh-binary.ply").write_bytes(mesh.export(file_type="ply", encoding="binary"))
    (folder / "trimesh-ascii.ply").write_bytes(mesh.export(file_type="ply", encoding="ascii"))
    out = {}
    for path in sorted(folder.iterdir()):
        if path.name.startswith("trimesh"):
            read = trimesh.load(path, process=False, force="mesh")
            corners = np.asarray(read.vertices)[np.asarray(read.faces)]
        else:
            meshes.load_new_mesh(str(path))
            current = meshes.current_mesh()
            corners = current.vertex_matrix()[current.face_matrix()]
        out[path.name] = {"corners": corners.reshape(-1, 9).tolist()}
    (DATA / "files.json").write_text(json.dumps(out))


main()
