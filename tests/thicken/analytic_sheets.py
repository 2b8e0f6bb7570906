"""Sheets whose solids have a volume that can be written down. Lengths in millimetres, d = half the thickness.

Per millimetre of width, legs measured along the middle: a plate of length a is 2 d a; where two legs meet at a right angle the mitre
adds nothing to the sum of the legs, and the arc takes (1 - pi/4) d^2 from it; three legs at 0, 90, 180 degrees have
2 d^2 less than their sum, four at right angles 4 d^2, three at 120 degrees sqrt(3) d^2. A convex corner of three walls loses
(1 - pi/6) d^3 to the ball's octant.
"""

import math

import numpy as np

from sheet_files import Patchwork

ARC = 1 - math.pi / 4
BALL = 1 - math.pi / 6


def fold(cells, t):
    d, floor, wall, width = t / 2, 90.0, 60.0, 50.0
    work = Patchwork().plate((0, 0, 0), (floor, 0, 0), (0, width, 0), cells).plate((0, 0, 0), (0, 0, wall), (0, width, 0), cells)
    mitred = width * 2 * d * (floor + wall)
    return work.sheet("fold", t, mitred=mitred, rounded=mitred - width * ARC * d * d)


def _star(name, directions, loss, cells, t):
    d, leg, width = t / 2, 48.0, 50.0
    work = Patchwork()
    for x, z in directions:
        work.plate((0, 0, 0), (leg * x, 0, leg * z), (0, width, 0), cells)
    volume = width * (2 * d * leg * len(directions) - loss * d * d)
    return work.sheet(name, t, mitred=volume, rounded=volume)


def tee(cells, t):
    return _star("tee", [(1, 0), (-1, 0), (0, 1)], 2.0, cells, t)


def cross(cells, t):
    return _star("cross", [(1, 0), (-1, 0), (0, 1), (0, -1)], 4.0, cells, t)


def wye(cells, t):
    angles = [k * 2 * math.pi / 3 for k in range(3)]
    return _star("wye", [(math.cos(a), math.sin(a)) for a in angles], math.sqrt(3), cells, t)


def _box(name, partition, cells, t):
    d, (w, b, h) = t / 2, (90.0, 60.0, 36.0)
    work = Patchwork()
    ends = [0, w / 2, w] if partition else [0, w]
    for x, end in zip(ends, ends[1:]):
        along = (end - x, 0, 0)
        work.plate((x, 0, 0), along, (0, b, 0), cells)
        work.plate((x, 0, 0), along, (0, 0, h), cells)
        work.plate((x, b, 0), along, (0, 0, h), cells)
    for x in ends:
        work.plate((x, 0, 0), (0, b, 0), (0, 0, h), cells)
    outer, inner = (w + t) * (b + t) * (h + d), (w - t) * (b - t) * (h - d)
    mitred = outer - inner + (t * (b - t) * (h - d) if partition else 0)
    edges = 4 * h + 2 * w + 2 * b
    return work.sheet(name, t, mitred=mitred, rounded=mitred - ARC * d * d * edges - 4 * BALL * d**3)


def open_box(cells, t):
    return _box("open-box", False, cells, t)


def parted_box(cells, t):
    return _box("parted-box", True, cells, t)


def dome(cells, t):
    """The upper four faces of an octahedron, blown up: half a ball's skin."""
    d, radius = t / 2, 45.0
    work = Patchwork()
    corners = [np.eye(3)[0], np.eye(3)[1], -np.eye(3)[0], -np.eye(3)[1]]
    for k in range(4):
        east, west, top = corners[k], corners[(k + 1) % 4], np.eye(3)[2]
        number = {}
        nodes = []
        for i in range(cells + 1):
            for j in range(cells + 1 - i):
                p = (cells - i - j) * east + i * west + j * top
                number[i, j] = len(nodes)
                nodes.append(radius * p / np.linalg.norm(p))
        faces = []
        for i in range(cells):
            for j in range(cells - i):
                faces.append((number[i, j], number[i + 1, j], number[i, j + 1]))
                if i + j + 1 < cells:
                    faces.append((number[i + 1, j], number[i + 1, j + 1], number[i, j + 1]))
        work.triangles(nodes, faces)
    work.patches = [0] * len(work.faces)
    volume = 2 * math.pi / 3 * ((radius + d) ** 3 - (radius - d) ** 3)
    # The flat triangles lie inside the ball by half their squared edge over the radius: the area is smaller.
    return work.sheet("dome", t, mitred=volume, rounded=volume, tolerance=2.5 / cells**2)


def finned_saddle(cells, t):
    """z = c (x^2 - y^2) and a fin that stands on its middle line; no closed form, but smooth everywhere."""
    c, half, height = 0.004, 45.0, 36.0
    z = lambda x, y: c * (x * x - y * y)
    work = Patchwork()
    for side in (1, -1):
        def skin(u, v, side=side):
            x, y = half * (2 * u - 1), side * half * v
            return x, y, z(x, y)
        work.grid(skin, 2 * cells, cells)

    def fin(u, v):
        x = half * (2 * u - 1)
        return x, 0.0, z(x, 0) + v * (height - z(x, 0))
    work.grid(fin, 2 * cells, cells)
    return work.sheet("finned-saddle", t)


ALL = [fold, tee, cross, wye, open_box, parted_box, dome, finned_saddle]
