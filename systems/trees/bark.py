"""The bark of a tree: tubes around its stems, and ribbons that face the eye in place of thin ones."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles
from .crown import shading
from .grow import Stems, Tree

BARK = np.dtype([("stem", "4f4"), ("side", "4f4"), ("own", "4f4"), ("pivot", "3f4"), ("shading", "4f4")])
"""A vertex of bark, as `wood.vert` reads it."""

SENT = np.dtype(
    {
        "names": list(BARK.names or ()),
        "formats": ["4u2", "4u1", "4f2", "3f2", "4u1"],
        "offsets": [0, 8, 12, 20, 28],
        "itemsize": 32,
    }
)
"""The same as it is sent, in fewer bytes: a card waits for them."""

SIDE_ONE = 127.5
"""What `side` is times and plus as it is sent."""

STEM_ONE = 65535.0
"""What a part of the range of `stem` is times as it is sent: 0.3 mm on a tree of 20 m."""

GLSL = {"STEM_ONE": STEM_ONE}

LEAST_RANGE = 1e-6
"""Of a range, as something is divided by it."""

SIDES = 12, 6, 3
"""Flat sides of a stem of each level."""

OUT_MOST = 0.3
"""How much farther out a stem's corners may be at most than it would be if it were round, of its radius."""

RUNS = 0.003, 0.006, 0.011, 0.017, 0.027
"""Radius of a stem that is a pixel wide, of the model [m]: trees between two have their wood drawn together."""

ROUND = 6.0
"""Width from which on a stem is a tube, and shows that it forks [pixels]."""

STRAIGHT = 0.017
"""Radius of a stem a pixel wide from which on ribbons have fewer points, of the model: bends are a few pixels [m]."""

ALIKE = 1.3
"""How many times as thick another stem may be that counts as thick as one."""

FLARE, FLARE_HIGH = 0.55, 2.2
"""How much thicker a trunk is where it comes out of the ground, of its radius; height at which a third of that is left,
of the same."""

BUTTRESSES, BUTTRESS = 5, 0.6
"""Roots that it goes over into, and how far they stand out, of how much thicker it is there."""

FOOT_RINGS = -1.2, 0.0, 0.8, 1.8, 3.2
"""Heights of rings around its foot, of its radius: on a slope, part of it is under the ground."""

WHOLE_BEND = 1.5
"""How far around a thin stem its bark is seen, of its width: half a turn, over the breadth."""


class Ranges(NamedTuple):
    """Between which values vertices are sent as whole numbers."""

    stem_least: tuple[float, ...]
    """Least values of stems [m]."""

    stem_range: tuple[float, ...]
    """How much more the greatest are [m]."""

    most_shading: tuple[float, float]
    """How many leaves light meets at most: to any side, and in all."""


class Wood(NamedTuple):
    """What is drawn of a tree's bark at some distances."""

    triangles: NDArray[np.uint32]
    """Shape (n, 3), the thickest first."""

    radii: Doubles
    """From the last of them to the first, the greatest radius from it on, (n,) [m]."""


class _Part(NamedTuple):
    """Triangles that are drawn together or not at all."""

    triangles: NDArray[np.intp]
    """Shape (stems, n, 3)."""

    thickest: Doubles
    """Radius of each stem where it is thickest, shape (stems,) [m]."""

    ribbon: bool | None
    """Whether these stand for thin stems alone, or with False for thick ones; None for both."""

    straight: NDArray[np.intp]
    """The same with every other point left out, or all but the ends of a short stem."""


def bark_of(
    tree: Tree, area: Doubles, pivot: Doubles, limb: Doubles, /
) -> tuple[NDArray[np.void], tuple[Wood, ...]]:  # fmt: skip
    """Return the bark of all stems, records of `BARK`, and what of it is drawn, for each of `RUNS` and farther off.

    `area` is each twig's leaf area [m²]; of each limb, `pivot` is its foot (n, 3) [m], and `limb` is what sets it apart
    and its frequency (n, 2).
    """
    owners = None, np.arange(len(limb)), tree.limb_of
    levels = _with_foot(tree.levels[0]), *tree.levels[1:]
    every = np.concatenate([stems.spine.reshape(-1, 3) for stems in levels])
    shades = np.split(shading(tree, area, every), np.cumsum([stems.spine[..., 0].size for stems in levels])[:-1])
    bark: list[NDArray[np.void]] = []
    parts: list[_Part] = []
    for stems, sides, shade, owner in zip(levels, SIDES, shades, owners, strict=True):
        made = [_flared(_tubes(stems, sides))] if owner is None else [_tubes(stems, sides), _ribbons(stems)]
        for ribbon, vertices in enumerate(made):
            vertices["shading"] = shade.reshape(*stems.spine.shape[:2], 1, 4)
            if owner is None:
                vertices["pivot"] = vertices["stem"][..., :3]
            else:
                vertices["pivot"], vertices["own"][..., 2:] = pivot[owner][:, None, None], limb[owner][:, None, None]
            first = sum(len(each) for each in bark)
            fine, straight = (
                _faces(*vertices.shape, each=each) + first for each in (1, max(vertices.shape[1] // 4, 3))
            )
            parts.append(_Part(fine, stems.radius[:, 0], None if owner is None else bool(ribbon), straight))
            bark.append(vertices.reshape(-1))
    whole = np.concatenate(bark)
    radius = whole["stem"][:, 3].astype(np.float64)
    return whole, tuple(_wood(parts, radius, finest) for finest in (0.0, *RUNS))


def _wood(parts: list[_Part], radius: Doubles, pixel: float) -> Wood:
    """Return what is drawn where a stem of a radius [m] is a pixel wide or less; `radius` is of each vertex."""
    chosen = []
    for part in parts:
        thin = part.thickest < ROUND * pixel
        triangles = part.straight if part.ribbon and pixel >= STRAIGHT else part.triangles
        kept = triangles if part.ribbon is None else triangles[thin == part.ribbon]
        chosen.append(kept.reshape(-1, 3))
    triangles = np.concatenate(chosen).astype(np.uint32)
    around = radius[triangles]
    most = around.max(axis=1)
    # Those of one stem stay together: they share vertices.
    about = np.round(np.log(around.min(axis=1) + most) / np.log(ALIKE))
    order = np.argsort(-about, kind="stable")
    return Wood(np.asarray(triangles[order], np.uint32), np.maximum.accumulate(most[order[::-1]]))


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
    """Return a trunk's vertices (1, points, around) with its foot as broad as it goes over into its roots."""
    stem, angle = vertices["stem"], np.linspace(0.0, 2.0 * np.pi, vertices.shape[2])
    base = float(stem[0, 0, 0, 3])
    flare = FLARE * np.exp(-np.maximum(stem[..., 1], 0.0) / (FLARE_HIGH * base))
    stem[..., 3] *= 1.0 + flare * (1.0 + BUTTRESS * np.cos(BUTTRESSES * angle))
    return vertices


def _along(spine: Doubles) -> Doubles:
    """Return which way stems go at each of their points, unit vectors."""
    along = np.gradient(spine, axis=1)
    return np.asarray(along / np.linalg.norm(along, axis=-1, keepdims=True))


def _tubes(stems: Stems, sides: int) -> NDArray[np.void]:
    """Return the vertices around stems, (n, points, sides + 1): the last of a ring is the first again."""
    spine = stems.spine
    along = _along(spine)
    whole = spine[:, -1:] - spine[:, :1] + 1e-6
    aside = np.cross(
        whole, np.where(np.abs(whole[..., 1:2]) < np.abs(whole[..., :1]), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0))
    )
    aside = aside - along * (aside * along).sum(axis=-1, keepdims=True)
    aside /= np.linalg.norm(aside, axis=-1, keepdims=True)
    other = np.cross(along, aside)
    angle = np.arange(sides + 1) * (2.0 * np.pi / sides)
    vertices = _on(stems, sides + 1)
    vertices["side"][..., :3] = aside[:, :, None] * np.cos(angle)[:, None] + other[:, :, None] * np.sin(angle)[:, None]
    vertices["side"][..., 3] = min(1.0 / np.cos(np.pi / sides) - 1.0, OUT_MOST)
    vertices["own"][..., 0] = angle * stems.radius[:, :1, None]
    return vertices


def _ribbons(stems: Stems) -> NDArray[np.void]:
    """Return the edges of stems, (n, points, 2): `side` says which way they go, and which edge it is."""
    vertices, edge = _on(stems, 2), np.array([-1.0, 1.0])
    vertices["side"][..., :3], vertices["side"][..., 3] = _along(stems.spine)[:, :, None], edge
    vertices["own"][..., 0] = WHOLE_BEND * edge * stems.radius[:, :1, None]
    return vertices


def _on(stems: Stems, around: int) -> NDArray[np.void]:
    """Return vertices of stems, (n, points, around), each with where it is on its stem."""
    spine = stems.spine
    vertices = np.zeros((*spine.shape[:2], around), BARK)
    vertices["stem"][..., :3], vertices["stem"][..., 3] = spine[:, :, None], stems.radius[..., None]
    run = np.concatenate([np.zeros((len(spine), 1)), np.linalg.norm(np.diff(spine, axis=1), axis=-1)], 1).cumsum(axis=1)
    vertices["own"][..., 1] = run[..., None]
    return vertices


def _faces(stems: int, points: int, around: int, *, each: int = 1) -> NDArray[np.intp]:
    """Return the triangles between rows of vertices, by the numbers of these, (stems, n, 3): of each row, or fewer."""
    number = np.arange(stems * points * around).reshape(stems, points, around)
    if each > 1:
        number = number[:, np.unique([*range(0, points, each), points - 1])]
    a, b, c, d = number[:, :-1, :-1], number[:, :-1, 1:], number[:, 1:, :-1], number[:, 1:, 1:]
    return np.stack([a, c, b, b, c, d], axis=-1).reshape(stems, -1, 3)


def ranges_of(vertices: NDArray[np.void], /) -> Ranges:
    """Return the ranges of vertices of bark."""
    stem, shading = vertices["stem"].astype(np.float64), np.abs(vertices["shading"].astype(np.float64))
    least = np.append(stem[:, :3].min(axis=0), 0.0)
    to_side, in_all = shading[:, :3].max(), shading[:, 3].max()
    return Ranges(
        tuple(least.tolist()), tuple((stem.max(axis=0) - least).tolist()),
        (max(float(to_side), LEAST_RANGE), max(float(in_all), LEAST_RANGE)),
    )  # fmt: skip


def sent(vertices: NDArray[np.void], ranges: Ranges, /) -> NDArray[np.void]:
    """Return vertices of bark as records of `SENT`."""
    told, (side, whole) = np.zeros(len(vertices), SENT), ranges.most_shading
    for name in ("own", "pivot"):
        told[name] = vertices[name]
    part = (vertices["stem"] - np.array(ranges.stem_least)) / np.maximum(ranges.stem_range, LEAST_RANGE)
    told["stem"] = np.round(STEM_ONE * part)
    told["side"] = np.round(SIDE_ONE + SIDE_ONE * vertices["side"].clip(-1.0, 1.0))
    shading = vertices["shading"] / (side, side, side, whole)
    told["shading"] = np.round(2.0 * SIDE_ONE * np.append(0.5 + 0.5 * shading[:, :3], shading[:, 3:], axis=1))
    return told
