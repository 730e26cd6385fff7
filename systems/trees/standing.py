"""Trees as they stand in a frame, and what of each is drawn."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Floats
from ...engine.random import hash3, stream, unit
from .far import LINES
from .model import MODELS

STANDING = np.dtype(
    [
        ("root", "3f4"), ("height", "f4"), ("yaw", "f4"), ("foliage", "f4"), ("kind", "i4"),
        ("model", "i4"), ("phase", "f4"), ("tint", "f4"), ("ring", "i4"),
    ]
)  # fmt: skip
"""A tree: where it stands [m], height [m], heading [rad], how many of its leaves it has, number of its kind; which of
the kind's models it is; what sets it apart from others in the wind, 0 to 1, and in brightness, -1 to 1; 0, or in which
ring about the viewer it is shown, where it stands for four times as many from each to the next."""

WHOLE_TO = 512.0
"""How far off all trees of a large forest are shown [m]: there one is 15 to 30 pixels high. Each ring goes twice as far
as the one before."""

RING_FADES = 0.1
"""Over which part of the way to its end a ring fades out, and the next one in."""

WIDEST = 80.0
"""How broad the row of trees is at most that one in a ring farther off stands for [m]: ground is uneven."""

COLUMN = 1.2
"""Distance from tree to tree in it, of a crown's radius."""

SHOWN = np.dtype(
    [
        ("root", "3f4"), ("scale", "f4"), ("turn", "2f4"), ("phase", "f4"), ("tint", "f4"),
        ("keep", "f4"), ("gone", "f4"), ("foliage", "f4"), ("columns", "f4"), ("shows", "f4"),
    ]
)  # fmt: skip
"""What shaders are told of a tree, as `tree.glsl` has it."""

LEAFY = np.dtype([*SHOWN.descr, ("first", "f4")])
"""Of a twig that is drawn leaf by leaf, that of its tree, and the twig's number."""

PLACED = np.dtype([("root", "3f4"), ("crown_at", "f4"), ("phase", "f4"), ("hertz", "f4")])
"""Where a tree stands, and how high above that the middle of its crown is [m]; what sets it apart in the wind, and how
fast its trunk swings [Hz]: what `stand.vert` asks of it."""

TOLD = np.dtype([("blown", "4f4"), ("misty", "4f4"), ("stands_in", "4f4"), ("lawn_sends", "3f4")])
"""What they make out of it once a tree: `stand.vert` writes it."""

HUNG = np.dtype([("hung_at", "4f4"), ("hung_axes", "4u4"), ("hung_light", "4u4")])
"""And once a twig on its card: `hang.vert` writes it."""

HUNG_LEAVES = np.dtype([*HUNG.descr, ("hung_haze", "2u4")])
"""And once a twig leaf by leaf."""

WHOLE, FEWER_BY = 620.0, 1.4
"""Height from which on all twigs of a tree are drawn [pixels], and the power of lower ones' height by which fewer are.

Those that are left stand for several, so that they hide as much (Cook and others, Stochastic Simplification of
Aggregate Detail, 2007)."""

FEWEST = 0.08
"""Share of them that is drawn at least."""

BEGINS = float(LINES)
"""Height of its picture below which a tree begins to be drawn as it is far off: no texel of that is larger than a pixel
[pixels]."""

GONE = 0.75 * BEGINS
"""That at which it is all drawn so: the change takes a third of the way there [pixels]."""


BAREST = 1.0 / 3.0
"""Share of its leaves at which a tree is drawn as it is near by down to a third of such heights, and with three times
as large a part of its twigs: pictures show no limbs that leaves hide. Barer ones are no further."""


@dataclass(frozen=True, slots=True, eq=False)
class Standing:
    """All trees of a frame; another frame has another object only where any is another."""

    rows: NDArray[np.void]
    """Records of `STANDING`, shape (n,)."""

    _sorted: list[NDArray[np.void]] = field(default_factory=list, init=False)
    _models: list[NDArray[np.intp]] = field(default_factory=list, init=False)
    _usual: list[float] = field(default_factory=list, init=False)
    _rings: list[int] = field(default_factory=list, init=False)

    @property
    def usual(self) -> tuple[float, float]:
        """The median of their heights, and of the heights that they stand at [m]; 0 where there are none."""
        if not self._usual:
            both = self.rows["height"], self.rows["root"][:, 1]
            self._usual.extend(float(np.median(each)) if len(each) else 0.0 for each in both)
        high, low = self._usual
        return high, low

    @property
    def in_rows(self) -> bool:
        """Whether some stand for rows of trees."""
        if not self._rings:
            self._rings.append(int(self.rows["ring"].max(initial=0)))
        return self._rings[0] > 1

    def by_model(self) -> tuple[NDArray[np.void], NDArray[np.intp]]:
        """Return all of them, model after model, and the number of each one's model, of all models of all kinds."""
        if not self._sorted:
            number = (self.rows["kind"] * MODELS + self.rows["model"]).astype(np.intp)
            order = np.argsort(number, kind="stable")
            self._sorted.append(self.rows.take(order))
            self._models.append(number[order])
        return self._sorted[0], self._models[0]

    def of(self, model: int, /) -> NDArray[np.void]:
        """Return those of a model, by its number of all, records of `STANDING`."""
        rows, number = self.by_model()
        first, end = np.searchsorted(number, (model, model + 1))
        return rows[first:end]


def tell_apart(rows: NDArray[np.void], /) -> None:
    """Write what each tree has of its own, by where it stands."""
    x, z = (np.ascontiguousarray(rows["root"][:, axis]).view(np.int32) for axis in (0, 2))
    own = hash3(42, x, z)
    rows["model"] = np.minimum(unit(stream(own, 1)) * MODELS, MODELS - 1)
    rows["phase"], rows["tint"] = unit(stream(own, 2)), 2.0 * unit(stream(own, 3)) - 1.0


def shown(rows: NDArray[np.void], height: Floats | np.float32, variety: Floats | np.float32, /) -> NDArray[np.void]:
    """Return what shaders are told of trees far off, records of `SHOWN`.

    Their models' own heights are so much [m]; `variety` is how far they differ in brightness, both of shape (n,) or ().
    """
    told = np.zeros(len(rows), SHOWN)
    told["root"], told["scale"] = rows["root"], rows["height"] / height
    told["turn"] = np.stack([np.cos(rows["yaw"]), np.sin(rows["yaw"])], axis=1)
    told["phase"], told["foliage"] = rows["phase"], rows["foliage"]
    told["tint"] = 1.0 + variety * rows["tint"]
    told["keep"], told["gone"] = FEWEST, 1.0
    told["columns"] = told["shows"] = 1.0
    return told


def come_near(told: NDArray[np.void], pixels: Doubles, pictured: Doubles, /) -> None:
    """Write how much is drawn of trees, records of `SHOWN`, that stand so high in a picture, shape (n,) [pixels].

    `pictured` is how high their own pictures are there.
    """
    leafy = np.maximum(told["foliage"], BAREST)
    told["keep"] = np.clip((pixels / WHOLE) ** FEWER_BY / leafy, FEWEST, 1.0)
    told["gone"] = np.clip((BEGINS - pictured) / (BEGINS - GONE), 0.0, 1.0)


def shows(ring: NDArray[np.integer], off: Doubles, /) -> Doubles:
    """Return how much trees of rings (n,) are shown so far off along the ground [m], (n,), in [0, 1]."""
    end = WHOLE_TO * 2.0 ** (ring - 1.0)
    out = np.clip((end - off) / (RING_FADES * end), 0.0, 1.0)
    into = np.clip((off - 0.5 * end) / (RING_FADES * 0.5 * end) + 1.0, 0.0, 1.0)
    return np.where(ring > 0, out, 1.0) * np.where(ring > 1, into, 1.0)


def columns_of(rows: NDArray[np.void], radius: Doubles, /) -> Doubles:
    """Return how many trees stand side by side in what each shows, (n,), whose crowns have such a radius [m]."""
    most = 4.0 ** np.maximum(rows["ring"] - 1.0, 0.0)
    return np.asarray(np.maximum(np.minimum(np.floor(WIDEST / (COLUMN * radius)), most), 1.0))
