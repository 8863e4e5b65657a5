"""Defects of surface meshes, as scans have them: those that can be repaired with certainty are, others are named."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import trimesh
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from rocking.extension import Array, Flags, Index

FLAT = 0.01
"""Distance of the edges of a hole from its plane times its area, over the volume, up to which it is filled [-]."""

SHEET = 1e-6  # volume of an open part over that of the largest part below which it encloses nothing [-]


class RepairedMesh(NamedTuple):
    """A mesh, what was repaired, and what cannot be, as ends of a sentence about it."""

    mesh: trimesh.Trimesh
    remarks: list[str]
    defect: str


def repaired(mesh: trimesh.Trimesh) -> RepairedMesh:
    """A mesh with its faces outwards and its flat holes filled, or its defect.

    Faces that are there twice and sheets that enclose nothing are left out; faces are turned as their neighbours are,
    and bodies outwards. A hole is filled by the cone over its edges from their mean: exact if it is flat, and refused
    if its edges lie so far from one plane that the volume is uncertain by more than `FLAT`.
    """
    if mesh.is_watertight and mesh.is_winding_consistent and mesh.volume > 0.0 and mesh.body_count == 1:
        return RepairedMesh(mesh, [], "")
    vertices, given = np.asarray(mesh.vertices), np.asarray(mesh.faces)
    faces = _single(given)
    oriented = _turned(faces)
    if oriented is None:
        return RepairedMesh(mesh, [], "has inconsistent normals, which no turning of its faces makes consistent")
    turned = np.where(oriented[:, None], faces[:, ::-1], faces)
    edges = _edges(turned)
    if (edges.shared[edges.shared > 2] % 2).any():
        return RepairedMesh(mesh, [], "has edges with three faces, or another odd number of them")
    holes = _holes(vertices, turned, edges)
    points = np.concatenate([vertices, holes.centre])
    closed = np.concatenate([turned, holes.cones])
    body = _bodies(_edges(closed))
    outwards, volume = _outwards(points, closed, body)
    is_open = np.zeros(len(volume), dtype=bool)
    is_open[body[len(turned) :]] = True
    sheet = is_open & (volume <= SHEET * volume.max(initial=0.0))
    kept = ~sheet[body]
    filled = np.unique(holes.of_cone[kept[len(turned) :]])
    total = float(volume[~sheet].sum())
    if not total > 0.0:
        return RepairedMesh(mesh, [], "encloses no volume")
    if holes.uncertain[filled].sum() > FLAT * total:
        text = f"has {len(holes.cones)} open edges around {len(holes.centre)} holes that are not flat: fill them first"
        return RepairedMesh(mesh, [], text)
    changed = (oriented ^ outwards[: len(turned)])[kept[: len(turned)]]
    left_out = len(given) - len(changed)
    remarks = []
    if left_out:
        remarks.append(f"has faces that are there twice or enclose nothing: {left_out} of {len(given)} were left out")
    if len(filled):
        size = int(kept[len(turned) :].sum())
        remarks.append(f"is not closed: its flat holes, {len(filled)} with {size} open edges, were filled")
    if changed.all():
        remarks.append("has a negative volume: its faces, which pointed inwards, were turned")
    elif changed.any():
        remarks.append(f"has inconsistent normals: {int(changed.sum())} of {len(changed)} faces were turned")
    solid = ~sheet & (volume > 0.0)  # cavities have negative volumes
    low, high = _boxes(points[closed], body)
    groups = _groups(low[solid], high[solid])
    if groups > 1:
        remarks.append(f"has {groups} separate solids, which are treated as one body")
    final = np.where(outwards[:, None], closed[:, ::-1], closed)[kept]
    found = trimesh.Trimesh(points, final, process=False)
    found.remove_unreferenced_vertices()
    return RepairedMesh(found, remarks, "")


class _Edges(NamedTuple):
    """Sides of faces, arrays (faces, 3): their edge, whether they lead to its later vertex, how many sides it has."""

    edge: Index
    forward: Flags
    shared: Index


def _sides(faces: Index) -> Index:
    """Both vertices of each side of each face, array (faces, 3, 2)."""
    return np.stack([faces, np.roll(faces, -1, axis=1)], axis=2)


def _edges(faces: Index) -> _Edges:
    sides = _sides(faces)
    low, high = np.sort(sides.reshape(-1, 2), axis=1).T
    key = low * (int(faces.max(initial=0)) + 1) + high  # one number sorts ten times as fast as two
    _, edge, shared = np.unique(key, return_inverse=True, return_counts=True)
    edge = edge.reshape(-1, 3)
    return _Edges(edge, sides[..., 0] < sides[..., 1], shared[edge])


def _parts(count: int, first: Index, second: Index) -> Index:
    """The number of the connected part of each of `count` things, some pairs of which are connected."""
    graph = coo_matrix((np.ones(len(first), dtype=bool), (first, second)), shape=(count, count))
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.intp)


def _bodies(edges: _Edges) -> Index:
    """The number of the body of each face: faces that share edges."""
    size = len(edges.edge)
    part = _parts(size + 3 * size, np.repeat(np.arange(size), 3), size + edges.edge.ravel())[:size]
    return np.asarray(np.unique(part, return_inverse=True)[1], dtype=np.intp)


def _single(faces: Index) -> Index:
    """The faces of three vertices, each once, without those that stand on an edge that others close.

    Of two that look opposite ways, as between two bodies, neither is kept.
    """
    ordered = np.sort(faces, axis=1)
    count = int(faces.max(initial=0)) + 1
    _, pair = np.unique(ordered[:, 0] * count + ordered[:, 1], return_inverse=True)
    _, first, same = np.unique(pair * count + ordered[:, 2], return_index=True, return_inverse=True)
    signs = np.where((faces < np.roll(faces, -1, axis=1)).sum(axis=1) == 2, 1, -1)
    first = first[np.bincount(same, signs) != 0]
    kept = faces[np.sort(first)]
    kept = kept[(np.diff(np.sort(kept, axis=1), axis=1) > 0).all(axis=1)]
    while True:
        shared = _edges(kept).shared
        standing = (shared == 1).any(axis=1) & (shared > 2).any(axis=1)
        if not standing.any():
            return np.asarray(kept)
        kept = kept[~standing]


def _turned(faces: Index) -> Flags | None:
    """Which faces to turn so that neighbours go together, as few as possible in each body; None if that is impossible.

    Each face is in a graph as it is and turned, and neighbours are connected as they go together. A face that is
    connected with its turned self contradicts itself.
    """
    edges, size = _edges(faces), len(faces)
    order = np.argsort(edges.edge.ravel(), kind="stable")
    paired = order[edges.shared.ravel()[order] == 2].reshape(-1, 2)
    same = np.equal(*edges.forward.ravel()[paired].T)  # one of both has to be turned
    one, two = paired.T // 3
    part = _parts(2 * size, np.concatenate([one, one + size]), np.concatenate([two + size * same, two + size * ~same]))
    plain, other = part[:size], part[size:]
    if (plain == other).any():
        return None
    votes = np.bincount(part[:size], minlength=2 * size)
    return np.asarray((votes[other] > votes[plain]) | ((votes[other] == votes[plain]) & (other < plain)))


class _Holes(NamedTuple):
    """Holes: their mean vertices and uncertain volumes; the faces of their cones, and the hole of each of these."""

    centre: Array
    uncertain: Array
    cones: Index
    of_cone: Index


def _holes(vertices: Array, faces: Index, edges: _Edges) -> _Holes:
    """The holes of a mesh, and the cones that fill them."""
    sides = _sides(faces)[edges.shared == 1]
    rim, place = np.unique(sides, return_inverse=True)
    place = place.reshape(-1, 2)
    hole = _parts(len(rim), place[:, 0], place[:, 1])
    count = int(hole.max(initial=-1)) + 1
    sums = np.stack([np.bincount(hole, vertices[rim, axis], count) for axis in range(3)], axis=1)
    centre = sums / np.bincount(hole, minlength=count)[:, None]
    of_cone = hole[place[:, 0]]
    around = vertices[sides] - centre[of_cone][:, None]  # (open edges, 2, 3)
    areas = 0.5 * np.cross(around[:, 0], around[:, 1])
    area = np.stack([np.bincount(of_cone, areas[:, axis], count) for axis in range(3)], axis=1)
    size = np.linalg.norm(area, axis=1)
    normal = area / np.maximum(size, np.finfo(float).tiny)[:, None]
    distance = np.zeros(count)
    np.maximum.at(distance, of_cone, np.abs(np.einsum("ij,ij->i", around[:, 0], normal[of_cone])))
    cones = np.column_stack([sides[:, 1], sides[:, 0], len(vertices) + of_cone])
    return _Holes(centre, distance * size, cones, of_cone)


def _boxes(corners: Array, body: Index) -> tuple[Array, Array]:
    """Lowest and highest coordinates of each body, arrays (bodies, 3), from the corners of all faces."""
    low, high = np.full((body.max() + 1, 3), np.inf), np.full((body.max() + 1, 3), -np.inf)
    np.minimum.at(low, body, corners.min(axis=1))
    np.maximum.at(high, body, corners.max(axis=1))
    return low, high


def _groups(low: Array, high: Array) -> int:
    """The number of groups of boxes, arrays (boxes, 3), that planes across one axis separate."""
    order = np.argsort(low, axis=0)
    reach = np.maximum.accumulate(np.take_along_axis(high, order, 0))
    return 1 + int((np.take_along_axis(low, order, 0)[1:] > reach[:-1]).sum(axis=0).max(initial=0))


def _outwards(vertices: Array, faces: Index, body: Index) -> tuple[Flags, Array]:
    """Which faces to turn, of bodies of negative volume unless they lie within another as cavities do; all volumes."""
    corners = vertices[faces]
    volumes = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6.0
    volume = np.bincount(body, volumes)
    low, high = _boxes(corners, body)
    wrong = np.zeros(len(volume), dtype=bool)
    for k in np.flatnonzero(volume < 0.0):
        within = (low <= low[k]).all(axis=1) & (high >= high[k]).all(axis=1) & (np.abs(volume) > -volume[k])
        wrong[k] = not within.any()
    return wrong[body], np.where(wrong, -volume, volume)
