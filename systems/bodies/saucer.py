"""The flying saucer's mesh: a surface of revolution about its upright axis, and a fin."""

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Floats

Triangles = NDArray[np.int32]

SEGMENTS = 40
"""Number of segments around the axis."""

RADIUS = 1.5
"""Radius of the rim [m]."""

THICK = 0.6
"""Height of the flattened ball that casts the saucer's shadow [m]."""

HULL, GLASS, JET, FIN = 0.0, 1.0, 2.0, 3.0
"""Materials of parts."""

GLSL = {"HULL": HULL, "GLASS": GLASS, "JET": JET, "FIN": FIN}

VERTEX = np.dtype([("place", "3f4"), ("normal", "3f4"), ("part", "f4")])
"""A vertex in the saucer's own axes, x right, y up, -z ahead: position [m], unit normal, material."""

EDGE = np.dtype([*VERTEX.descr, ("other", "3f4"), ("side", "3f4"), ("beyond", "3f4"), ("outside", "f4")])
"""One corner of the soft border along an edge: the vertex, the edge's other end [m], the unit normals of the two
triangles that meet there, and whether the corner lies on the edge (0) or outside (1)."""


def sections() -> list[tuple[float, Doubles]]:
    """Return the profile from the bottom of the axis to its top, in parts with smooth normals.

    A part is its material and its points (radius, height) [m], shape (n, 2); it begins where the one before ends.
    """
    turn = np.linspace(-0.5, 0.5, 5) * np.pi
    rim = np.column_stack([1.42 + 0.08 * np.cos(turn), 0.055 * np.sin(turn)])
    out = np.linspace(0.0, 1.0, 5)[1:-1]
    belly = np.column_stack([0.44 + 0.98 * out, -0.36 + 0.305 * out**1.6])
    back = np.column_stack([1.42 - 0.80 * out, 0.055 + 0.205 * out**1.5])
    over = np.linspace(0.0, 0.5, 6) * np.pi
    return [
        (JET, np.array([(0.0, -0.27), (0.2, -0.28), (0.34, -0.33)])),
        (HULL, np.array([(0.34, -0.33), (0.36, -0.36), (0.44, -0.36)])),
        (HULL, np.concatenate([[(0.44, -0.36)], belly, rim, back, [(0.62, 0.26)]])),
        (HULL, np.array([(0.62, 0.26), (0.57, 0.31)])),
        (GLASS, np.column_stack([0.57 * np.cos(over), 0.31 + 0.23 * np.sin(over)])),
    ]


def saucer() -> tuple[NDArray[np.void], Triangles]:
    """Return the saucer's vertices, records of `VERTEX`, and its triangles (n, 3), counter-clockwise from outside.

    It is 3 m across and 0.9 m high; the origin is in the middle of its rim.
    """
    pieces = [lathe(points, part=part) for part, points in sections()]
    pieces.append(_fin())
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in pieces)])
    triangles = [faces + start for (_, faces), start in zip(pieces, starts[:-1], strict=True)]
    return np.concatenate([vertices for vertices, _ in pieces]), np.concatenate(triangles).astype(np.int32)


def lathe(points: Doubles, /, *, part: float) -> tuple[NDArray[np.void], Triangles]:
    """Return the surface of revolution of a profile (n, 2) of (radius, height) [m] about y, with smooth normals.

    With the axis on the profile's left, the outside is on its right.
    """
    count = len(points)
    along = np.gradient(points, axis=0)
    along[points[:, 0] < 1e-9, 1] = 0.0
    normal = np.column_stack([along[:, 1], -along[:, 0]]) / np.linalg.norm(along, axis=1, keepdims=True)
    angle = np.arange(SEGMENTS) * (2.0 * np.pi / SEGMENTS)
    around = np.stack([np.sin(angle), -np.cos(angle)], 1)
    vertices = np.zeros((SEGMENTS, count), VERTEX)
    for name, flat in (("place", points), ("normal", normal)):
        vertices[name][..., ::2] = flat[None, :, :1] * around[:, None]
        vertices[name][..., 1] = flat[:, 1]
    vertices["part"] = part
    here = np.arange(SEGMENTS)[:, None] * count + np.arange(count - 1)
    there = (here + count) % (SEGMENTS * count)
    lower = np.stack([here, here + 1, there], -1)[:, points[:-1, 0] > 1e-9]
    upper = np.stack([here + 1, there + 1, there], -1)[:, points[1:, 0] > 1e-9]
    return vertices.reshape(-1), np.concatenate([lower.reshape(-1, 3), upper.reshape(-1, 3)])


def borders(vertices: NDArray[np.void], triangles: Triangles, /) -> tuple[NDArray[np.void], Triangles]:
    """Return quads along the edges of a closed mesh that soften its silhouette: records of `EDGE`, triangles (n, 3).

    Edges between coplanar triangles are never on the silhouette and left out.
    """
    _, welded = np.unique(np.round(vertices["place"], 5), axis=0, return_inverse=True)
    flat = face_normals(vertices, triangles)
    ends = np.stack([triangles, np.roll(triangles, -1, axis=1)], -1).reshape(-1, 2)
    owner = np.repeat(np.arange(len(triangles)), 3)
    key = np.sort(welded.reshape(-1)[ends], axis=1)
    order = np.lexsort(key.T)
    first, second = order[::2], order[1::2]
    side, beyond = flat[owner[first]], flat[owner[second]]
    bent = np.einsum("ij,ij->i", side, beyond) < 0.99999
    chosen = ends[first][bent]
    corners = np.zeros((len(chosen), 4), EDGE)
    for corner, (end, far, out) in enumerate(((0, 1, 0.0), (1, 0, 0.0), (0, 1, 1.0), (1, 0, 1.0))):
        row = corners[:, corner]
        for name in VERTEX.names or ():
            row[name] = vertices[name][chosen[:, end]]
        row["other"], row["outside"] = vertices["place"][chosen[:, far]], out
        row["side"], row["beyond"] = side[bent], beyond[bent]
    quads = np.arange(len(chosen))[:, None] * 4 + np.array([0, 1, 2, 2, 1, 3])
    return corners.reshape(-1), quads.reshape(-1, 3).astype(np.int32)


def face_normals(vertices: NDArray[np.void], triangles: Triangles, /) -> Floats:
    """Return the unit normals of triangles, shape (n, 3)."""
    a, b, c = (vertices["place"][triangles[:, corner]].astype(np.float64) for corner in range(3))
    normal: Doubles = np.cross(b - a, c - a)
    unit: Doubles = normal / np.linalg.norm(normal, axis=1, keepdims=True)
    return unit.astype(np.float32)


def _fin() -> tuple[NDArray[np.void], Triangles]:
    """Return the upright fin behind the dome: a flat prism that shows the saucer's heading."""
    outline = np.array([(0.70, 0.15), (1.36, 0.02), (1.46, 0.40), (1.28, 0.42)])  # behind the middle, up
    left, right = (np.column_stack([np.full(4, x), outline[:, 1], outline[:, 0]]) for x in (-0.035, 0.035))
    quads = [right[::-1], left]
    quads += [np.stack([left[i], left[i - 1], right[i - 1], right[i]]) for i in range(4)]
    vertices = np.zeros((len(quads), 4), VERTEX)
    vertices["place"], vertices["part"] = quads, FIN
    faces = np.arange(len(quads))[:, None] * 4 + np.array([0, 1, 2, 0, 2, 3])
    triangles = faces.reshape(-1, 3).astype(np.int32)
    flat = vertices.reshape(-1)
    flat["normal"] = np.repeat(face_normals(flat, triangles)[::2], 4, axis=0)
    return flat, triangles
