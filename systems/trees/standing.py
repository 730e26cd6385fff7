"""Trees as they stand in a frame, and the level of detail of each."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Floats, Mask
from ...engine.random import hash3, stream, unit
from .far import LINES
from .model import MODELS

STANDING = np.dtype(
    [
        ("root", "3f4"), ("height", "f4"), ("yaw", "f4"), ("foliage", "f4"), ("kind", "i4"),
        ("model", "i4"), ("phase", "f4"), ("tint", "f4"), ("ring", "i4"),
    ]
)  # fmt: skip
"""A tree: place [m], height [m], heading [rad], share of its leaves, index of its kind; index of its model in the kind;
random numbers for its phase in the wind, 0 to 1, and its brightness, -1 to 1; its ring about the viewer, or 0. A tree
of a ring stands for four times as many as one of the ring before."""

DENSE_TO = 512.0
"""Distance up to which all trees of a large forest are shown [m]: there one is 15 to 30 pixels high. Each ring reaches
twice as far as the one before."""

RING_FADES = 0.1
"""Part of a ring's reach over which it cross-fades into the next one."""

WIDEST_ROW = 80.0
"""Greatest breadth of the row of trees that a tree of a farther ring stands for [m]: ground is uneven."""

ROW_SPACING = 1.2
"""Distance between trees in such a row [crown radii]."""

INSTANCE = np.dtype(
    [
        ("root", "3f4"), ("scale", "f4"), ("turn", "2f4"), ("phase", "f4"), ("tint", "f4"),
        ("twig_share", "f4"), ("far_fade", "f4"), ("foliage", "f4"), ("columns", "f4"), ("opacity", "f4"),
        ("first", "f4"), ("crown_at", "f4"), ("hertz", "f4"),
    ]
)  # fmt: skip
"""Instance attributes of a tree, a block of its twigs or one of them; `tree.glsl`, `hang.vert` and `stand.vert`
describe each."""

WORDS = INSTANCE.itemsize // 8
"""Numbers of 64 bits in a record of `INSTANCE`: as such, numpy copies it a hundred times as fast."""

STOOD = np.dtype(
    [("wind_response", "4f4"), ("haze_in_front", "4f4"), ("grass_about", "4f4"), ("light_from_grass", "3f4")]
)
"""Output of `stand.vert`, once a tree."""

HUNG = np.dtype([("hung_place", "4u4"), ("hung_look", "4u4")])
"""Output of `hang.vert`, once a twig on its card."""

HUNG_LEAVES = np.dtype([("hung_at", "4f4"), ("hung_axes", "4u4"), ("hung_light", "4u4"), ("hung_haze", "2u4")])
"""Output of `hang.vert`, once a twig drawn leaf by leaf."""

TWIG_POWER = 1.4
"""Power of the height of a tree's picture that its share of twigs follows, below `FADES_BELOW`.

Those left stand for several, so that they hide as much (Cook and others, Stochastic Simplification of Aggregate Detail,
2007). Larger trees have all their twigs, as their pictures do: fewer and larger ones would reach beyond the crown and
leave gaps in it."""

FEWEST_TWIGS = 0.08
"""Least share of its twigs that is drawn of a tree."""

FADES_BELOW = float(LINES)
"""Height of a tree's picture below which it begins to fade in [pixels]: no texel of it is larger than a pixel."""

PICTURE_BELOW = 0.75 * FADES_BELOW
"""Height of its picture below which a tree is drawn as that alone [pixels]."""


BAREST = 1.0 / 3.0
"""Share of its leaves down to which a tree keeps its twigs longer than a full one, and draws more of them: at a third,
down to a third of the height, and three times as large a share. Pictures show no limbs that leaves hide. Barer trees
are treated as this one."""


@dataclass(frozen=True, eq=False)
class Standing:
    """All trees of a frame; the same object from frame to frame while no tree changes."""

    rows: NDArray[np.void]
    """Records of `STANDING`, shape (n,)."""

    @cached_property
    def medians(self) -> tuple[float, float]:
        """Median of the trees' heights, and of the elevations of their feet [m]; 0 where there are none."""
        both = self.rows["height"], self.rows["root"][:, 1]
        high, low = (float(np.median(each)) if len(each) else 0.0 for each in both)
        return high, low

    @cached_property
    def in_rows(self) -> bool:
        """Whether any tree stands for a row of trees."""
        return bool(self.rows["ring"].max(initial=0) > 1)

    @cached_property
    def by_model(self) -> tuple[NDArray[np.void], NDArray[np.intp]]:
        """The trees sorted by model, and the model of each, as an index into those of all kinds."""
        number = (self.rows["kind"] * MODELS + self.rows["model"]).astype(np.intp)
        order = np.argsort(number, kind="stable")
        return self.rows.take(order), number[order]

    def of_model(self, model: int, /) -> NDArray[np.void]:
        """Return the trees of a model, an index into those of all kinds, as records of `STANDING`."""
        rows, number = self.by_model
        first, end = np.searchsorted(number, (model, model + 1))
        return rows[first:end]


def individualise(rows: NDArray[np.void], /) -> None:
    """Write each tree's random numbers and its model, hashed from its place."""
    x, z = (np.ascontiguousarray(rows["root"][:, axis]).view(np.int32) for axis in (0, 2))
    hashed = hash3(42, x, z)
    rows["model"] = np.minimum(unit(stream(hashed, 1)) * MODELS, MODELS - 1)
    rows["phase"], rows["tint"] = unit(stream(hashed, 2)), 2.0 * unit(stream(hashed, 3)) - 1.0


def far_instances(
    rows: NDArray[np.void], height: Floats | np.float32, variety: Floats | np.float32, /
) -> NDArray[np.void]:
    """Return trees as records of `INSTANCE`, drawn as pictures alone.

    `height` is that of their models [m], and `variety` the spread of their brightness, each of shape (n,) or ().
    """
    instances = np.zeros(len(rows), INSTANCE)
    instances["root"], instances["scale"] = rows["root"], rows["height"] / height
    instances["turn"] = np.stack([np.cos(rows["yaw"]), np.sin(rows["yaw"])], axis=1)
    instances["phase"], instances["foliage"] = rows["phase"], rows["foliage"]
    instances["tint"] = 1.0 + variety * rows["tint"]
    instances["twig_share"], instances["far_fade"] = FEWEST_TWIGS, 1.0
    instances["columns"] = instances["opacity"] = 1.0
    return instances


def set_detail(instances: NDArray[np.void], pictured: Doubles, /) -> None:
    """Write the share of twigs and the fade to the picture into records of `INSTANCE`.

    `pictured` is the height of each tree's own picture, shape (n,) [pixels].
    """
    foliage = np.maximum(instances["foliage"], BAREST)
    instances["twig_share"] = np.clip((pictured / FADES_BELOW) ** TWIG_POWER / foliage, FEWEST_TWIGS, 1.0)
    instances["far_fade"] = np.clip((FADES_BELOW - pictured) / (FADES_BELOW - PICTURE_BELOW), 0.0, 1.0)


def has_twigs(pictured: Doubles, /) -> Mask:
    """Return which trees are drawn twig by twig, by the height of their own pictures (n,) [pixels]."""
    return np.asarray(pictured > PICTURE_BELOW)


def has_picture(pictured: Doubles, /) -> Mask:
    """Return which trees are drawn as pictures, by the height of these (n,) [pixels]."""
    return np.asarray(pictured < FADES_BELOW)


def alone_from(pictured: float, /) -> float:
    """Return the distance from which on a tree is a picture alone [m]; `pictured` is its height at 1 m [pixels]."""
    return pictured / PICTURE_BELOW


def ring_opacity(ring: NDArray[np.integer], distance: Doubles, /) -> Doubles:
    """Return the opacity of trees of rings (n,) at distances (n,) along the ground [m], in [0, 1]."""
    end = DENSE_TO * 2.0 ** (ring - 1.0)
    out = np.clip((end - distance) / (RING_FADES * end), 0.0, 1.0)
    into = np.clip((distance - 0.5 * end) / (RING_FADES * 0.5 * end) + 1.0, 0.0, 1.0)
    return np.where(ring > 0, out, 1.0) * np.where(ring > 1, into, 1.0)


def columns_of(rows: NDArray[np.void], radius: Doubles, /) -> Doubles:
    """Return the number of trees in the row that each stands for, (n,); `radius` is that of their crowns [m]."""
    most = 4.0 ** np.maximum(rows["ring"] - 1.0, 0.0)
    return np.asarray(np.maximum(np.minimum(np.floor(WIDEST_ROW / (ROW_SPACING * radius)), most), 1.0))
