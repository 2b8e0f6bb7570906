"""Sheets as arrays, how they are put together, and mesh files in and out."""

from dataclasses import dataclass

import numpy as np


@dataclass
class Sheet:
    """Triangles of a sheet, each in a patch, and what is known of the solid that becomes of it."""

    name: str
    nodes: np.ndarray
    faces: np.ndarray
    patches: np.ndarray
    thickness: float
    # Volumes of the ideal solids with mitred and with round corners; None where no closed form is known.
    mitred: float | None = None
    rounded: float | None = None
    # How far the tessellated sheet's volume may be from the closed form, relative.
    tolerance: float = 1e-9

    @property
    def size(self):
        return float(np.ptp(self.nodes, axis=0).max())


class Patchwork:
    """Patches that share the nodes which lie at the same place."""

    def __init__(self):
        self.nodes, self.faces, self.patches = [], [], []
        self.known = {}
        self.count = 0

    def node(self, place):
        # Nine digits of a hundred millimetres: what two formulae put at one place is one node.
        key = tuple(int(x) for x in np.rint(np.asarray(place, float) * 1e7))
        if key not in self.known:
            self.known[key] = len(self.nodes)
            self.nodes.append(np.asarray(place, float))
        return self.known[key]

    def grid(self, place, across, along):
        """A patch of across x along cells over place(u, v), u and v from 0 to 1; diagonals take turns."""
        number = [[self.node(place(i / across, j / along)) for j in range(along + 1)] for i in range(across + 1)]
        for i in range(across):
            for j in range(along):
                a, b = number[i][j], number[i + 1][j]
                d, c = number[i][j + 1], number[i + 1][j + 1]
                for face in [(a, b, c), (a, c, d)] if (i + j) % 2 else [(a, b, d), (b, c, d)]:
                    if len(set(face)) == 3:
                        self.faces.append(face)
                        self.patches.append(self.count)
        self.count += 1
        return self

    def plate(self, corner, across, along, cells):
        """A parallelogram."""
        corner, across, along = (np.asarray(v, float) for v in (corner, across, along))
        cells = np.broadcast_to(cells, 2)
        return self.grid(lambda u, v: corner + u * across + v * along, int(cells[0]), int(cells[1]))

    def triangles(self, nodes, faces):
        number = [self.node(p) for p in nodes]
        self.faces += [tuple(number[v] for v in face) for face in faces]
        self.patches += [self.count] * len(faces)
        self.count += 1
        return self

    def sheet(self, name, thickness, **known):
        return Sheet(name, np.array(self.nodes), np.array(self.faces, np.int64), np.array(self.patches), thickness, **known)


def placed(sheet, rotation, shift):
    """The same sheet elsewhere."""
    moved = sheet.nodes @ np.asarray(rotation).T + np.asarray(shift)
    return Sheet(sheet.name, moved, sheet.faces, sheet.patches, sheet.thickness, sheet.mitred, sheet.rounded, sheet.tolerance)


def write_obj(path, sheet):
    order = np.argsort(sheet.patches, kind="stable")
    with open(path, "w") as file:
        for p in sheet.nodes:
            file.write("v %.17g %.17g %.17g\n" % tuple(p))
        patch = None
        for f in order:
            if sheet.patches[f] != patch:
                patch = sheet.patches[f]
                file.write(f"g patch_{patch + 1}\n")
            file.write("f %d %d %d\n" % tuple(sheet.faces[f] + 1))


def read_obj(path):
    """Nodes, triangles, groups of the triangles."""
    nodes, faces, groups, group = [], [], [], ""
    with open(path) as file:
        for line in file:
            words = line.split()
            if not words:
                continue
            if words[0] == "v":
                nodes.append([float(x) for x in words[1:4]])
            elif words[0] == "g":
                group = " ".join(words[1:])
            elif words[0] == "f":
                corners = [int(word.split("/")[0]) for word in words[1:]]
                corners = [c - 1 if c > 0 else c + len(nodes) for c in corners]
                for k in range(1, len(corners) - 1):
                    faces.append((corners[0], corners[k], corners[k + 1]))
                    groups.append(group)
    return np.array(nodes).reshape(-1, 3), np.array(faces, np.int64).reshape(-1, 3), np.array(groups)


def read_binary_stl(path):
    """Nodes and triangles; corners with exactly the same numbers are one node."""
    data = np.fromfile(path, np.uint8)
    count = int(data[80:84].view("<u4")[0])
    facets = data[84:].reshape(count, 50)
    corners = np.ascontiguousarray(facets[:, 12:48]).view("<f4").reshape(-1, 3).astype(float) + 0.0
    nodes, number = np.unique(corners, axis=0, return_inverse=True)
    return nodes, number.reshape(-1, 3).astype(np.int64)


def read_solid(path):
    path = str(path)
    return read_binary_stl(path) if path.endswith(".stl") else read_obj(path)[:2]
