"""The bark of a tree: tubes around its stems, and camera-facing ribbons in place of thin ones."""

from math import log
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles
from .crown import shading
from .grow import Stems, Tree

BARK = np.dtype([("stem", "4f4"), ("side", "4f4"), ("shading", "4f4"), ("surface", "2f4"), ("on_limb", "2f4")])
"""A vertex of bark; `wood.vert` describes each field."""

PACKED = np.dtype(
    {
        "names": list(BARK.names or ()),
        "formats": ["4u2", "4u1", "4u1", "2f2", "2u2"],
        "offsets": [0, 8, 12, 16, 20],
        "itemsize": 24,
    }
)
"""The same vertex in fewer bytes: vertex fetches bound the drawing of wood."""

SIDE_SCALE = 127.5
"""Scale and offset of `side` when packed."""

STEM_SCALE = 65535.0
"""Scale of `stem`, within its range, when packed: 0.3 mm a step on a tree of 20 m. Scale of the random number in
`on_limb`."""

GLSL = {"STEM_SCALE": STEM_SCALE}

LEAST_RANGE = 1e-6
"""Least range, as ranges are divisors."""

SIDES = 12, 6, 3
"""Number of flat sides of a stem of each level."""

MOST_OUTSET = 0.3
"""Greatest distance of a tube's corners beyond the round stem, relative to its radius."""

PIXEL_RADII = 0.003, 0.0042, 0.006, 0.0085, 0.012, 0.017, 0.027
"""Radii of the model's stem that is a pixel wide [m]: trees between two of them draw the same wood."""

ROUND = 6.0
"""Width from which on a stem is a tube, and shows that it forks [pixels]."""

STRAIGHT, BENT = 0.017, 2.0
"""Radius of a stem a pixel wide from which on ribbons have fewer points [m]: bends are a few pixels there. And bend
below which a ribbon has fewer points nearer by, too [pixels]."""

FLARE, FLARE_HEIGHT = 0.55, 2.2
"""Widening of a trunk at the ground, and height at which a third of that is left, both relative to its radius."""

BUTTRESSES, BUTTRESS = 5, 0.6
"""Number of buttress roots, and their height over the flare, relative to its widening."""

FOOT_RINGS = -1.2, 0.0, 0.8, 1.8, 3.2
"""Heights of rings around a trunk's foot, relative to its radius: on a slope, some are under the ground."""

FOOT_ENDS = FLARE_HEIGHT * log(FLARE * (1.0 + BUTTRESS) / 0.05)
"""Height from which on a trunk is widened by less than a twentieth, relative to its radius."""

WHOLE_BEND = 1.5
"""Length of bark across a ribbon, relative to its width: half a circumference over a diameter."""


class Ranges(NamedTuple):
    """Value ranges that vertices are packed in."""

    stem_least: tuple[float, ...]
    """Least values of `stem` [m]."""

    stem_range: tuple[float, ...]
    """Ranges of `stem` [m]."""

    most_shading: tuple[float, float]
    """Greatest absolute values of `shading`: of its directional parts, and of its mean."""


class Faces(NamedTuple):
    """Triangles of bark that a pass draws at some distance."""

    triangles: NDArray[np.uint32]
    """Shape (n, 3), stem by stem from thick to thin."""

    radii: Doubles
    """Greatest radius from each triangle on, from the last to the first, (n,) [m]."""

    @classmethod
    def of(cls, triangles: NDArray[np.integer], stem: NDArray[np.floating], /) -> Self:
        """Return the faces of triangles in this order; `stem` is that of each vertex, (n, 4)."""
        most = stem[triangles, 3].max(axis=1).astype(np.float64)
        return cls(np.asarray(triangles, np.uint32), np.maximum.accumulate(most[::-1]))


class Wood(NamedTuple):
    """Bark that is drawn at some distance."""

    whole: Faces
    """With tubes of thick stems."""

    edges: Faces
    """For soft edges, which are the same on a ribbon: all is ribbons but the trunk's foot."""


class _Part(NamedTuple):
    """Stems whose triangles are drawn stem by stem."""

    triangles: NDArray[np.intp]
    """Shape (stems, n, 3)."""

    radius_at_foot: Doubles
    """Radius of each stem at its foot, shape (stems,) [m]; infinite for a trunk, which is never thin."""

    ribbon: bool | None
    """True for ribbons, which stand for thin stems; False for tubes of thick ones; None for what is always drawn."""

    straight: NDArray[np.intp]
    """The triangles of fewer points, down to the ends of a short stem."""

    bend: Doubles
    """Greatest distance of each stem's points from the lines between these, shape (stems,) [m]."""


def bark_of(
    tree: Tree, area: Doubles, first_limb: int, limb_random: NDArray[np.floating], /
) -> tuple[NDArray[np.void], tuple[Wood, ...]]:
    """Return the bark of all stems, records of `BARK`, and the wood for each of `PIXEL_RADII` and beyond.

    `area` is each twig's leaf area [m²], `first_limb` the row of the first limb in the texture of twigs, and
    `limb_random` a random number of each limb, 0 to 1.
    """
    limb_of = None, np.arange(len(tree.levels[1].at)), tree.limb_of
    levels = _with_foot(tree.levels[0]), *tree.levels[1:]
    every = np.concatenate([stems.spine.reshape(-1, 3) for stems in levels])
    shades = np.split(shading(tree, area, every), np.cumsum([stems.spine[..., 0].size for stems in levels])[:-1])
    bark: list[NDArray[np.void]] = []
    parts: list[_Part] = []
    for stems, sides, shade, limbs in zip(levels, SIDES, shades, limb_of, strict=True):
        tubes, of_trunk = _tubes(stems, sides), limbs is None
        foot = int((stems.spine[0, :, 1] < FOOT_ENDS * stems.radius[0, 0]).sum()) if of_trunk else 0
        for ribbon, vertices in enumerate((_flared(tubes) if of_trunk else tubes, _ribbons(stems))):
            vertices["shading"] = shade.reshape(*stems.spine.shape[:2], 1, 4)
            if limbs is not None:
                vertices["on_limb"] = np.stack([first_limb + limbs, limb_random[limbs]], axis=1)[:, None, None]
            first = sum(len(each) for each in bark)
            step = max(vertices.shape[1] // 4, 3)
            fine, straight = (_faces(*vertices.shape, step=each) + first for each in (1, step))
            at_foot = np.full(len(stems.at), np.inf) if of_trunk else stems.radius[:, 0]
            below = 2 * foot * (vertices.shape[2] - 1)
            if foot and not ribbon:
                parts.append(_Part(fine[:, :below], at_foot, None, fine[:, :below], at_foot))
            parts.append(_Part(fine[:, below:], at_foot, bool(ribbon), straight, _bends(stems.spine, step)))
            bark.append(vertices.reshape(-1))
    vertices = np.concatenate(bark)
    stem = vertices["stem"].astype(np.float64)
    return vertices, tuple(_wood(parts, stem, pixel) for pixel in (0.0, *PIXEL_RADII))


def _wood(parts: list[_Part], stem: Doubles, pixel: float) -> Wood:
    """Return the wood where a stem of radius `pixel` [m] is a pixel wide; `stem` is that of each vertex, (n, 4)."""
    passes = ([_triangles(part, pixel, edges=edges) for part in parts] for edges in (False, True))
    return Wood(*(_sorted(each, stem) for each in passes))


def _sorted(found: list[tuple[NDArray[np.intp], Doubles]], stem: Doubles) -> Faces:
    """Return the triangles of parts in the order in which they are drawn.

    Those of one stem stay together, as they share vertices: a graphics card keeps the last ones that it has computed.
    """
    triangles = np.concatenate([each for each, _ in found])
    radius_at_foot = np.concatenate([each for _, each in found])
    return Faces.of(triangles[np.argsort(-radius_at_foot, kind="stable")], stem)


def _triangles(part: _Part, pixel: float, *, edges: bool) -> tuple[NDArray[np.intp], Doubles]:
    """Return a part's triangles (n, 3) where a stem of radius `pixel` [m] is a pixel wide, of `Wood.whole` or `edges`.

    Besides, return the radius of each one's stem at its foot, (n,) [m]. Edges of a tube have all its points, so that
    they lie along it.
    """
    if part.ribbon is None:
        return part.triangles.reshape(-1, 3), np.repeat(part.radius_at_foot, part.triangles.shape[1])
    thin = part.radius_at_foot < ROUND * pixel
    drawn = np.full(len(thin), part.ribbon) if edges else thin == part.ribbon
    straight = part.ribbon & thin & ((part.bend < BENT * 2.0 * pixel) | (pixel >= STRAIGHT))
    kept = (part.triangles, drawn & ~straight), (part.straight, drawn & straight)
    triangles = np.concatenate([each[rows].reshape(-1, 3) for each, rows in kept])
    return triangles, np.concatenate([np.repeat(part.radius_at_foot[rows], each.shape[1]) for each, rows in kept])


def _bends(spine: Doubles, step: int) -> Doubles:
    """Return the greatest distance of stems' points (n, points, 3) from the lines between each of `step`, (n,)."""
    points = spine.shape[1]
    kept = np.unique([*range(0, points, step), points - 1])
    part = np.arange(points)
    line = np.stack([[np.interp(part, kept, stem[kept, axis]) for axis in range(3)] for stem in spine])
    return np.asarray(np.linalg.norm(spine - line.transpose(0, 2, 1), axis=2).max(axis=1))


def _with_foot(trunk: Stems) -> Stems:
    """Return a trunk with more points about its foot."""
    spine, radius = trunk.spine[0], trunk.radius[0]
    high = np.array(FOOT_RINGS) * radius[0]
    above = spine[:, 1] > high[-1]
    foot = np.stack([np.interp(high, spine[:, 1], spine[:, axis]) for axis in range(3)], axis=1)
    foot[:, 1] = high
    thick = np.interp(high, spine[:, 1], radius)
    spine, radius = np.concatenate([foot, spine[above]]), np.concatenate([thick, radius[above]])
    return Stems(spine[None], trunk.parent, trunk.at, radius[None])


def _flared(vertices: NDArray[np.void]) -> NDArray[np.void]:
    """Widen the foot of a trunk's vertices (1, points, around) into buttress roots."""
    stem, angle = vertices["stem"], np.linspace(0.0, 2.0 * np.pi, vertices.shape[2])
    base = float(stem[0, 0, 0, 3])
    flare = FLARE * np.exp(-np.maximum(stem[..., 1], 0.0) / (FLARE_HEIGHT * base))
    stem[..., 3] *= 1.0 + flare * (1.0 + BUTTRESS * np.cos(BUTTRESSES * angle))
    return vertices


def _tangents(spine: Doubles) -> Doubles:
    """Return unit tangents of stems at their points."""
    along = np.gradient(spine, axis=1)
    return np.asarray(along / np.linalg.norm(along, axis=-1, keepdims=True))


def _tubes(stems: Stems, sides: int) -> NDArray[np.void]:
    """Return the vertices around stems, (n, points, sides + 1): the last of a ring repeats the first."""
    spine = stems.spine
    along = _tangents(spine)
    chord = spine[:, -1:] - spine[:, :1] + 1e-6
    aside = np.cross(
        chord, np.where(np.abs(chord[..., 1:2]) < np.abs(chord[..., :1]), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0))
    )
    aside = aside - along * (aside * along).sum(axis=-1, keepdims=True)
    aside /= np.linalg.norm(aside, axis=-1, keepdims=True)
    other = np.cross(along, aside)
    angle = np.arange(sides + 1) * (2.0 * np.pi / sides)
    vertices = _vertices(stems, sides + 1)
    vertices["side"][..., :3] = aside[:, :, None] * np.cos(angle)[:, None] + other[:, :, None] * np.sin(angle)[:, None]
    vertices["side"][..., 3] = min(1.0 / np.cos(np.pi / sides) - 1.0, MOST_OUTSET)
    vertices["surface"][..., 0] = angle * stems.radius[:, :1, None]
    return vertices


def _ribbons(stems: Stems) -> NDArray[np.void]:
    """Return the vertices of ribbons, (n, points, 2); `side` has the tangent, and -1 or 1 for the edge."""
    vertices, edge = _vertices(stems, 2), np.array([-1.0, 1.0])
    vertices["side"][..., :3], vertices["side"][..., 3] = _tangents(stems.spine)[:, :, None], edge
    vertices["surface"][..., 0] = WHOLE_BEND * edge * stems.radius[:, :1, None]
    return vertices


def _vertices(stems: Stems, around: int) -> NDArray[np.void]:
    """Return vertices of stems, (n, points, around), with the position along each stem."""
    spine = stems.spine
    vertices = np.zeros((*spine.shape[:2], around), BARK)
    vertices["stem"][..., :3], vertices["stem"][..., 3] = spine[:, :, None], stems.radius[..., None]
    arc_length = np.concatenate([np.zeros((len(spine), 1)), np.linalg.norm(np.diff(spine, axis=1), axis=-1)], 1).cumsum(
        axis=1
    )
    vertices["surface"][..., 1] = arc_length[..., None]
    return vertices


def _faces(stems: int, points: int, around: int, *, step: int = 1) -> NDArray[np.intp]:
    """Return the triangles between rings of vertices, as indices (stems, n, 3); `step` skips rings."""
    number = np.arange(stems * points * around).reshape(stems, points, around)
    if step > 1:
        number = number[:, np.unique([*range(0, points, step), points - 1])]
    a, b, c, d = number[:, :-1, :-1], number[:, :-1, 1:], number[:, 1:, :-1], number[:, 1:, 1:]
    return np.stack([a, c, b, b, c, d], axis=-1).reshape(stems, -1, 3)


def ranges_of(vertices: NDArray[np.void], /) -> Ranges:
    """Return the value ranges of vertices."""
    stem, shading = vertices["stem"].astype(np.float64), np.abs(vertices["shading"].astype(np.float64))
    least = np.append(stem[:, :3].min(axis=0), 0.0)
    side, mean = shading[:, :3].max(), shading[:, 3].max()
    return Ranges(
        tuple(least.tolist()), tuple((stem.max(axis=0) - least).tolist()),
        (max(float(side), LEAST_RANGE), max(float(mean), LEAST_RANGE)),
    )  # fmt: skip


def packed(vertices: NDArray[np.void], ranges: Ranges, /) -> NDArray[np.void]:
    """Return vertices as records of `PACKED`."""
    records, (side, mean) = np.zeros(len(vertices), PACKED), ranges.most_shading
    records["surface"] = vertices["surface"]
    part = (vertices["stem"] - np.array(ranges.stem_least)) / np.maximum(ranges.stem_range, LEAST_RANGE)
    records["stem"] = np.round(STEM_SCALE * part)
    records["on_limb"] = np.round((1.0, STEM_SCALE) * vertices["on_limb"])
    records["side"] = np.round(SIDE_SCALE + SIDE_SCALE * vertices["side"].clip(-1.0, 1.0))
    shading = vertices["shading"] / (side, side, side, mean)
    records["shading"] = np.round(2.0 * SIDE_SCALE * np.append(0.5 + 0.5 * shading[:, :3], shading[:, 3:], axis=1))
    return records
