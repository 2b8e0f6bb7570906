"""Is it a solid? Judged from the triangles alone, by exact arithmetic where a decision hangs on it."""

from fractions import Fraction

import igl
import numpy as np
from igl.copyleft import cgal
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components


def problems(nodes, faces):
    """Everything that keeps the triangles from being the boundary of a solid; empty where nothing does."""
    if len(faces) == 0:
        return ["no triangles"]
    if not np.isfinite(nodes).all():
        return ["coordinates that are no numbers"]
    found = []

    def count(what, number):
        if number:
            found.append(f"{number} {what}")

    same = (faces == np.roll(faces, 1, axis=1)).any(axis=1)
    count("faces that name a node twice", int(same.sum()))
    flat = without_area(nodes, faces)
    count("faces without area", int((flat & ~same).sum()))
    unique = np.unique(np.sort(faces, axis=1), axis=0)
    count("faces on the same nodes", len(faces) - len(unique))
    twins = opposite_half_edges(faces)
    if twins is None:
        uses = half_edge_counts(faces)
        count("edges that are used other than once in each direction", uses)
    else:
        count("nodes with more than one fan of faces", fans(faces, twins) - len(np.unique(faces)))
        found += orientation(nodes, faces, twins)
    good = ~(same | flat)
    # Detection only; pairs that share nodes count where they have more in common than these.
    crossing = cgal.remesh_self_intersections(nodes, faces[good], True, False, False, False, len(faces) + 1)[2]
    count("pairs of faces that cross", len(np.asarray(crossing).reshape(-1, 2)))
    return found


def volume(nodes, faces):
    a, b, c = np.moveaxis(nodes[faces] - nodes.mean(axis=0), 1, 0)
    return float(np.einsum("ij,ij->i", np.cross(a, b), c).sum() / 6)


def without_area(nodes, faces):
    """Exactly none: doubts of the floating point are settled in fractions."""
    a, b, c = np.moveaxis(nodes[faces], 1, 0)
    cross = np.cross(b - a, c - a)
    scale = np.abs(nodes[faces]).max(axis=(1, 2)) + 1e-300
    doubtful = np.abs(cross).max(axis=1) < 1e-13 * scale * scale
    flat = np.zeros(len(faces), bool)
    for f in np.nonzero(doubtful)[0]:
        p, q, r = ([Fraction(float(x)) for x in nodes[v]] for v in faces[f])
        u, v = [y - x for x, y in zip(p, q)], [y - x for x, y in zip(p, r)]
        flat[f] = all(u[i] * v[j] == u[j] * v[i] for i, j in ((0, 1), (1, 2), (2, 0)))
    return flat


def half_edges(faces):
    return faces.reshape(-1), np.roll(faces, -1, axis=1).reshape(-1)


def half_edge_counts(faces):
    """Undirected edges that do not have exactly one half-edge in each direction."""
    tail, head = half_edges(faces)
    edges, number = np.unique(np.sort(np.c_[tail, head], axis=1), axis=0, return_inverse=True)
    number = number.reshape(-1)
    up = np.bincount(number[tail < head], minlength=len(edges))
    down = np.bincount(number[tail > head], minlength=len(edges))
    return int(((up != 1) | (down != 1)).sum())


def opposite_half_edges(faces):
    """For each half-edge the one that runs the other way; None where any has not exactly one."""
    tail, head = half_edges(faces)
    size = int(faces.max()) + 1
    key, back = tail * size + head, head * size + tail
    order = np.argsort(key, kind="stable")
    if (np.diff(key[order]) == 0).any():
        return None
    at = np.searchsorted(key[order], back)
    at[at == len(key)] = 0
    twins = order[at]
    return twins if (key[twins] == back).all() else None


def fans(faces, twins):
    """How often the half-edges go round: the next one at the same node is the twin of the one before."""
    n = faces.size
    before = np.arange(n).reshape(-1, 3)[:, [2, 0, 1]].reshape(-1)
    step = twins[before]
    graph = coo_matrix((np.ones(n), (np.arange(n), step)), (n, n))
    return int(connected_components(graph, directed=False)[0])


def shells(faces, twins):
    n = len(faces)
    graph = coo_matrix((np.ones(faces.size), (np.repeat(np.arange(n), 3), twins // 3)), (n, n))
    return connected_components(graph, directed=False)


def orientation(nodes, faces, twins):
    """A shell that lies in an even number of others must be wound outward, one in an odd number inward."""
    count, shell = shells(faces, twins)
    if count > 400:
        return [f"{count} shells"]
    found = []
    for s in range(count):
        own = faces[shell == s]
        positive = volume(nodes, own) > 0
        depth = 0
        if count > 1:
            depth = round(float(igl.winding_number(nodes, faces[shell != s], nodes[own[0, :1]])[0]))
        if depth not in (0, 1) or positive == (depth == 1):
            found.append(f"shell {s} of {count} is wound {'outward' if positive else 'inward'} at depth {depth}")
    return found
