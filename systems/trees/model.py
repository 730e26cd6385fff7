"""Models of a kind of tree: what is grown once, as shaders are given it."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles
from ...engine.declared.tree import HabitName
from .crown import leaf_area, shading
from .grow import Stems, Tree, grown
from .habit import HABITS, Habit
from .motion import limb_hertz, trunk_hertz
from .twig import TWIG

MODELS = 2
"""Trees that are grown of a kind: each stands for many, turned and scaled."""

WOOD = np.dtype([("stem", "4f4"), ("side", "3f4"), ("own", "4f4"), ("pivot", "3f4"), ("shading", "4f4")])
"""A vertex of bark, as `wood.vert` reads it."""

SENT = np.dtype(
    {
        "names": list(WOOD.names or ()),
        "formats": ["4f4", "3u1", "4f2", "3f2", "4f2"],
        "offsets": [0, 16, 20, 28, 36],
        "itemsize": 44,
    }
)
"""The same as it is sent, in fewer bytes."""

SIDE_ONE = 127.5
"""What `side` is times and plus as it is sent."""

MARGIN = 1.04
"""Half the side of a tree's pictures, of how far its twigs reach: leaves go beyond those."""

ALIKE = 1.3
"""How many times as thick another stem may be that counts as thick as one."""

SIDES = 12, 6, 3
"""Flat sides of a stem of each level."""


@dataclass(frozen=True, slots=True, eq=False)
class Model:
    """A tree that has grown, as shaders are given it."""

    habit: Habit
    height: float
    """[m]."""

    twigs: NDArray[np.void]
    """Records of `TWIG`, in an order of which any first ones stand for all, shape (n,)."""

    vertices: NDArray[np.void]
    """Records of `WOOD`, shape (n,)."""

    triangles: NDArray[np.uint32]
    """Shape (n, 3), the thickest first."""

    radii: Doubles
    """From the last of them to the first: the least radius of any up to it, the greatest from it on, (2, n) [m]."""

    middle: float
    """Height of the middle of its pictures from all around [m]."""

    half: float
    """Half the side of those [m]."""

    radius: float
    """How far its crown reaches from the trunk [m]."""

    hertz: float
    """How fast its trunk swings [Hz]."""

    leaf_area: float
    """Of all its leaves, one side [m²]."""


@lru_cache(maxsize=32)
def models_of(name: HabitName, seed: int, /) -> tuple[Model, ...]:
    """Return the models of a habit that grow from a seed."""
    habit = HABITS[name]
    low, high = habit.height
    return tuple(_model(habit, low + (high - low) * (n + 0.5) / MODELS, seed=seed + n) for n in range(MODELS))


def _model(habit: Habit, height: float, *, seed: int) -> Model:
    tree = grown(habit, height, seed=seed)
    area = leaf_area(tree.twigs, habit.leaf, habit.twigs.length)
    twigs = _twig_records(tree, area, seed)
    vertices, triangles, radii = _wood(tree, area, seed)
    ends = tree.twigs.foot + tree.twigs.length[:, None] * tree.twigs.along
    radius = float(np.hypot(ends[:, 0], ends[:, 2]).max())
    top = float(ends[:, 1].max())
    return Model(
        habit, height, twigs, vertices, triangles, radii, 0.5 * top, MARGIN * max(0.5 * top, radius), radius,
        trunk_hertz(height, habit.slender * height), float(area.sum()),
    )  # fmt: skip


def _limbs(tree: Tree, seed: int) -> tuple[Doubles, Doubles]:
    """Return each limb's foot (n, 3), and what sets it apart and its frequency (n, 2)."""
    limbs = tree.levels[1]
    own = np.random.default_rng((seed, 43)).uniform(0.0, 1.0, len(limbs.at))
    numbers = np.stack([own, [limb_hertz(each) for each in limbs.length]], axis=1)
    foot, numbers = (each.astype(np.float16).astype(np.float64) for each in (limbs.spine[:, 0], numbers))
    return foot, numbers  # as vertices have them


def _twig_records(tree: Tree, area: Doubles, seed: int) -> NDArray[np.void]:
    twigs, (pivot, limb) = tree.twigs, _limbs(tree, seed)
    records = np.zeros(len(twigs.foot), TWIG)
    for name in ("foot", "length", "along", "face"):
        records[name] = getattr(twigs, name)
    records["pivot"] = pivot[twigs.limb]
    records["limb"], records["hertz"] = limb[twigs.limb].T
    records["shading"] = shading(tree, area, twigs.foot + 0.5 * twigs.length[:, None] * twigs.along.astype(np.float64))
    return records


def _wood(tree: Tree, area: Doubles, seed: int) -> tuple[NDArray[np.void], NDArray[np.uint32], Doubles]:
    """Return the bark of all stems, its triangles, the thickest first, and between which radii they are."""
    pivot, limb = _limbs(tree, seed)
    every = np.concatenate([stems.spine.reshape(-1, 3) for stems in tree.levels])
    shades = np.split(shading(tree, area, every), np.cumsum([stems.spine[..., 0].size for stems in tree.levels])[:-1])
    owners = None, np.arange(len(limb)), tree.limb_of
    parts, faces, first = [], [], 0
    for stems, sides, shade, owner in zip(tree.levels, SIDES, shades, owners, strict=True):
        vertices = _tubes(stems, sides)
        vertices["shading"] = shade.reshape(*stems.spine.shape[:2], 1, 4)
        if owner is None:
            vertices["pivot"] = vertices["stem"][..., :3]
        else:
            vertices["pivot"], vertices["own"][..., 2:] = pivot[owner][:, None, None], limb[owner][:, None, None]
        parts.append(vertices.reshape(-1))
        faces.append(_faces(*vertices.shape).reshape(-1, 3) + first)
        first += vertices.size
    bark, triangles = np.concatenate(parts), np.concatenate(faces).astype(np.uint32)
    around = bark["stem"][:, 3].astype(np.float64)[triangles]
    radii = np.stack([around.min(axis=1), around.max(axis=1)], axis=1)
    about = np.round(np.log(radii.sum(axis=1)) / np.log(ALIKE))  # of one stem stay together: they share vertices
    order = np.argsort(-about, kind="stable")
    least, most = np.minimum.accumulate(radii[order, 0])[::-1], np.maximum.accumulate(radii[order[::-1], 1])
    return bark, triangles[order], np.stack([least, most])


def _tubes(stems: Stems, sides: int) -> NDArray[np.void]:
    """Return the vertices around stems, (n, points, sides + 1): the last of a ring is the first again."""
    spine = stems.spine
    along = np.gradient(spine, axis=1)
    along /= np.linalg.norm(along, axis=-1, keepdims=True)
    whole = spine[:, -1:] - spine[:, :1] + 1e-6
    aside = np.cross(
        whole, np.where(np.abs(whole[..., 1:2]) < np.abs(whole[..., :1]), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0))
    )
    aside = aside - along * (aside * along).sum(axis=-1, keepdims=True)
    aside /= np.linalg.norm(aside, axis=-1, keepdims=True)
    other = np.cross(along, aside)
    angle = np.arange(sides + 1) * (2.0 * np.pi / sides)
    vertices = np.zeros((*spine.shape[:2], sides + 1), WOOD)
    vertices["stem"][..., :3], vertices["stem"][..., 3] = spine[:, :, None], stems.radius[..., None]
    vertices["side"] = aside[:, :, None] * np.cos(angle)[:, None] + other[:, :, None] * np.sin(angle)[:, None]
    run = np.concatenate([np.zeros((len(spine), 1)), np.linalg.norm(np.diff(spine, axis=1), axis=-1)], 1).cumsum(axis=1)
    vertices["own"][..., 0] = angle * stems.radius[:, :1, None]
    vertices["own"][..., 1] = run[..., None]
    return vertices


def _faces(stems: int, points: int, around: int) -> NDArray[np.intp]:
    """Return the triangles of tubes, by the numbers of their vertices, (stems, n, 3)."""
    number = np.arange(stems * points * around).reshape(stems, points, around)
    a, b, c, d = number[:, :-1, :-1], number[:, :-1, 1:], number[:, 1:, :-1], number[:, 1:, 1:]
    return np.stack([a, c, b, b, c, d], axis=-1).reshape(stems, -1, 3)


def sent(vertices: NDArray[np.void], /) -> NDArray[np.void]:
    """Return vertices of bark as records of `SENT`."""
    told = np.zeros(len(vertices), SENT)
    for name in ("stem", "own", "pivot", "shading"):
        told[name] = vertices[name]
    told["side"] = np.round(SIDE_ONE + SIDE_ONE * vertices["side"].clip(-1.0, 1.0))
    return told
