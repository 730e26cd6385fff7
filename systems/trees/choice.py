"""Which trees a picture has, and what is shown of each: those of all models are chosen in one go."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Floats
from ..space.frustum import beyond
from .bark import RUNS
from .card import BACKS, CARDS, FAR, FIRST_OF, LEAVES, SHARES, SHELL_OF, STREAMS, TOO_FEW, WOODS
from .leafy import leaf_by_leaf, leafy
from .model import MARGIN, Model
from .shells import farthest_of, shells_of
from .standing import BAREST, PLACED, WIDEST, Standing, columns_of, come_near, shown, shows
from .twig import LEAF_PIXELS
from .wood import AWAY, SWAYS, THINNEST, nearest_ahead

TOGETHER = 32
"""Trees, one after another, that are looked for as one before each is: those of a forest stand side by side."""

NEAREST = 0.1
"""How far off a tree's middle counts as at least [m]."""

ANY_HEIGHT = 1e6
"""Height in the picture at which a tree is drawn with all that it has [pixels]."""

Numbers = NDArray[np.intp]


class Look(NamedTuple):
    """From where trees are seen, and how."""

    eye: Doubles
    """[m]."""

    sides: Doubles
    """Those of the picture, as `Viewer` has them."""

    clip: Doubles
    """From places to the picture, (4, 4)."""

    focal: float
    """How high something is in it that is as high as it is far off [pixels]."""

    reach: float
    """How far off grass stands that is drawn from far to near [m]."""

    seen_at: Sequence[Doubles | tuple[float, float, float]] = ()
    """From where they count as seen for what is shown of each: from the nearest of these; without any, from the eye."""

    leaves_from: float | None = None
    """Height of their own pictures from which on all are drawn leaf by leaf, if any is, and lower ones as they are far
    off [pixels]."""


class Lot(NamedTuple):
    """Trees of a model that are drawn together, in a stream, or twigs of them."""

    model: int
    """Its number, of all models of all kinds."""

    name: str
    """Of the stream."""

    first: int
    """The first of them, of all that are chosen."""

    amount: int
    nearest: float
    """How far off the middle of the nearest one's crown is, and of all in the mean [m]."""

    mean: float
    far: float
    """How far off the farthest is, along the ground, as `farthest_of` has it [m]."""

    wide: float
    """The least radius of a stem of the model that is a pixel wide, where a tree is nearest [m]."""

    foliage: float
    """How many of its leaves one has at least."""

    keep: float
    """The greatest share of its twigs that is drawn of one, and the greatest there is to be seen of one's leaves."""

    leaves: float


def lone(model: int, name: str, first: int, /) -> Lot:
    """Return a tree of a model that is in a stream by itself, to be drawn somewhere; it is so many-th of all."""
    return Lot(model, name, first, 1, 0.0, 0.0, farthest_of(SHELL_OF[name], 1.0), 1.0, 1.0, 1.0, 1.0)


class Chosen(NamedTuple):
    """What is drawn of trees."""

    lots: list[Lot]
    told: list[NDArray[np.void]]
    """What shaders are told of each lot, records of `SHOWN`, or of single leaves, of `LEAFY`."""

    placed: NDArray[np.void]
    """Where all stand, lot after lot, records of `PLACED`."""


class _Seen(NamedTuple):
    """The trees in a picture, model after model and the nearest first."""

    number: Numbers
    model: Numbers
    told: NDArray[np.void]
    """Records of `SHOWN`."""

    along: Doubles
    """How far off each is along the ground [m]."""

    wide: Doubles
    """The radius of a stem of its model that is a pixel wide, where it is nearest [m]."""


class Choice:
    """All trees of a frame, to be chosen among; `variety` is how far those of each model differ in brightness."""

    def __init__(self, standing: Standing, models: Sequence[Model], variety: Sequence[float]) -> None:
        rows, self._model = standing.by_model()
        self._models = models
        numbers = np.array([_numbers(*each) for each in zip(models, variety, strict=True)])[self._model].T
        height, middle, half, radius, hertz, self._leaf, differs = numbers
        self._height, self._ring = rows["height"].copy(), rows["ring"].copy()
        self._pictured = 2.0 * half / height / np.maximum(rows["foliage"], BAREST)
        """How high the pictures of each one's model are, of its height, and as much more as it has fewer leaves."""
        self._scale = self._height.astype(np.float64) / height
        self._middle: Doubles = rows["root"].astype(np.float64)
        self._middle[:, 1] += self._scale * middle
        self._told = shown(rows, height.astype(np.float32), differs.astype(np.float32))
        self._told["columns"] = columns_of(rows, self._scale * radius)
        self._placed = _placed(self._told, middle.astype(np.float32), hertz.astype(np.float32))
        self._crown = self._placed["root"].copy()
        """The middle of each one's crown [m], shape (n, 3)."""
        self._crown[:, 1] += self._placed["crown_at"]
        self._ball = np.stack([np.hypot(half, radius), radius], axis=1)
        """How far each reaches from its middle, and aside, of its scale [m], shape (n, 2)."""
        beside, sways = np.where(self._ring > 1, WIDEST, 0.0), (1.0 + SWAYS) * self._scale
        self._high, self._aside = (beside + sways * MARGIN * each for each in (middle, radius))
        """How far that is up and down, and aside, with all that it stands for [m], shape (n,)."""
        self._balls = _balls(self._middle, np.hypot(self._high, self._aside))

    def in_picture(self, sides: Doubles, /) -> Numbers:
        """Return the numbers of those that are within the sides of a picture."""
        middle, radius = self._balls
        some = np.flatnonzero(np.repeat(beyond(middle, sides) <= radius, TOGETHER)[: len(self._model)])
        inside = self._middle.take(some, axis=0) @ sides[:, :3].T + sides[:, 3]
        reach = np.outer(self._high[some], np.abs(sides[:, 1])) + np.outer(
            self._aside[some], np.hypot(*sides[:, :3:2].T)
        )
        return np.asarray(some[(inside >= -reach).all(axis=1)])

    def of(self, look: Look, /) -> Chosen:
        """Return what is drawn of those in a picture."""
        number = self.in_picture(look.sides)
        off = np.linalg.norm(self._middle.take(number, axis=0) - look.eye, axis=1)
        order = np.argsort(off)
        order = order[_in_order(self._model[number[order]])]
        number, off = number[order], off[order]
        seen = self._seen(look, number, off)
        tree, twig = self._leaves(look, seen, off)
        stream, who = _dealt(seen, shells_of(seen.along, look.reach), tree)
        to = self._crown.take(number, axis=0) - look.eye
        lots = _lots(stream, who, seen, np.linalg.norm(to, axis=1))
        # Of records, `take` is thirty times as fast as indices in brackets.
        rows, twigs = seen.told.take(who), leaf_by_leaf(seen.told.take(tree), twig)
        return Chosen(lots, _parted(lots, rows, twigs), self._placed.take(number[who]))

    def _seen(self, look: Look, number: Numbers, off: Doubles) -> _Seen:
        """Return what is to be seen of trees that are so far off, shape (n,) [m]."""
        middle, scale, ring = self._middle.take(number, axis=0), self._scale[number], self._ring[number]
        if look.seen_at:
            off = np.min([np.linalg.norm(middle - eye, axis=1) for eye in look.seen_at], axis=0)
        pixels = look.focal * self._height[number] / np.maximum(off, NEAREST)
        pictured = self._pictured[number]
        if look.leaves_from is not None:
            pixels = np.where(pixels * pictured <= look.leaves_from, 0.0, ANY_HEIGHT)
        pixels[ring > 1] = 0.0
        told, along = self._told.take(number), np.hypot(middle[:, 0] - look.eye[0], middle[:, 2] - look.eye[2])
        come_near(told, pixels, pixels * pictured)
        told["shows"] = shows(ring, along)
        reach = (1.0 + SWAYS) * scale[:, None] * self._ball.take(number, axis=0)
        ahead = nearest_ahead(look.clip, middle, look.eye, reach)
        wide = THINNEST * np.maximum(ahead, AWAY) / (look.focal * scale)
        return _Seen(number, self._model[number], told, along, wide)

    def _leaves(self, look: Look, seen: _Seen, off: Doubles) -> tuple[Numbers, Numbers]:
        """Return which twigs are drawn leaf by leaf: whose they are of trees in a picture, and their own numbers."""
        if look.leaves_from is not None:
            near = np.flatnonzero(seen.told["gone"] < 1.0)
            return near, np.zeros(len(near), np.intp)
        scale = self._scale[seen.number]
        large = look.focal * scale * self._leaf[seen.number] / LEAF_PIXELS[0]
        trees = np.flatnonzero(large > off - scale * self._ball[seen.number, 0]).tolist()
        model = self._models
        twigs = [leafy(model[seen.model[n]], seen.told[n], look.eye, look.sides, large[n]) for n in trees]
        none = np.zeros(0, np.intp)
        return np.repeat(np.array(trees, np.intp), [*map(len, twigs)]), np.concatenate([none, *twigs])


def _numbers(model: Model, variety: float) -> tuple[float, ...]:
    return (
        model.height, model.middle, model.half, model.radius, model.hertz, model.habit.leaf.length, variety,
    )  # fmt: skip


def _in_order(number: Numbers) -> Numbers:
    """Return what brings models or streams in the order of their numbers; what is of the same one stays in order."""
    return np.argsort(number.astype(np.int16), kind="stable")  # such small numbers are put in order much faster


def _placed(told: NDArray[np.void], middle: Floats, hertz: Floats) -> NDArray[np.void]:
    """Return where trees stand, records of `SHOWN`, whose models' middles are so high [m] and swing so fast [Hz]."""
    placed = np.zeros(len(told), PLACED)
    placed["root"], placed["crown_at"] = told["root"], told["scale"] * middle
    placed["phase"], placed["hertz"] = told["phase"], hertz / np.sqrt(told["scale"])
    return placed


def _balls(middle: Doubles, reach: Doubles) -> tuple[Doubles, Doubles]:
    """Return balls about so many balls together each: their middles (n, 3) and radii (n,) [m]."""
    if not len(middle):
        return middle, reach
    first = np.arange(0, len(middle), TOGETHER)
    low = np.minimum.reduceat(middle - reach[:, None], first)
    high = np.maximum.reduceat(middle + reach[:, None], first)
    return 0.5 * (low + high), 0.5 * np.linalg.norm(high - low, axis=1)


def _dealt(seen: _Seen, shell: Numbers, tree: Numbers) -> tuple[Numbers, Numbers]:
    """Return the trees of each stream, by their numbers, those of one stream after another, and of which they are.

    Streams are numbered through all models; `tree` is whose twigs are drawn leaf by leaf.
    """
    near, far = (np.flatnonzero(each) for each in (seen.told["gone"] < 1.0, seen.told["gone"] > 0.0))
    back = far[::-1]
    who = np.concatenate([tree, near, near, far, back])
    within = [
        np.zeros(len(tree), np.intp), _cards(seen, near, shell), _woods(seen, near, shell), np.zeros(len(far), np.intp),
        shell[back],
    ]  # fmt: skip
    first = [FIRST_OF[names] for names in (LEAVES, CARDS[0], WOODS[0], FAR, BACKS[0])]
    own = np.concatenate([number + each for number, each in zip(first, within, strict=True)])
    stream = seen.model[who] * len(STREAMS) + own
    order = _in_order(stream)
    return stream[order], who[order]


def _cards(seen: _Seen, near: Numbers, shell: Numbers) -> Numbers:
    """Return in which of `CARDS` trees near by are: beyond the grass by how many twigs they draw, if many are alike."""
    model, shell = seen.model[near], shell[near]
    drawn = seen.told["keep"][near] * (1.0 - seen.told["gone"][near])
    group = (drawn[:, None] < SHARES).sum(axis=1)
    beyond_grass, fewest = shell == 0, group == len(SHARES)
    few = np.bincount(model[beyond_grass & fewest], minlength=int(model.max(initial=0)) + 1) < TOO_FEW
    group = np.where(few[model] & fewest, len(SHARES) - 1, group)
    return np.where(beyond_grass, group, len(SHARES) + shell)


def _woods(seen: _Seen, near: Numbers, shell: Numbers) -> Numbers:
    """Return in which of `WOODS` they are: beyond the grass by how thick stems are that are wider than a pixel."""
    return np.where(shell[near] == 0, np.searchsorted(RUNS, seen.wide[near]), len(RUNS) + shell[near])


def _lots(stream: Numbers, who: Numbers, seen: _Seen, off: Doubles) -> list[Lot]:
    """Return the lots of streams that follow one another; `off` is how far off the crown of each tree is [m]."""
    first = np.flatnonzero(np.diff(stream, prepend=-1))
    told, count = seen.told, np.diff(first, append=len(stream))
    drawn, foliage = told["keep"] * (1.0 - told["gone"]), told["foliage"]
    low, high, total = np.minimum.reduceat, np.maximum.reduceat, np.add.reduceat
    columns = (
        *divmod(stream[first], len(STREAMS)), first, count, low(off[who], first), total(off[who], first) / count,
        high(seen.along[who], first), low(seen.wide[who], first), low(foliage[who], first),
        high(drawn[who], first), high((drawn * foliage)[who], first),
    )  # fmt: skip
    return [
        Lot(model, STREAMS[own], at, amount, nearest, mean, farthest_of(SHELL_OF[STREAMS[own]], far), *most)
        for model, own, at, amount, nearest, mean, far, *most in zip(*(each.tolist() for each in columns), strict=True)
    ]


def _parted(lots: list[Lot], rows: NDArray[np.void], twigs: NDArray[np.void]) -> list[NDArray[np.void]]:
    """Return the rows of each lot: of all of them, or of single leaves of all that are `twigs`."""
    ends = np.cumsum([lot.amount if lot.name == LEAVES else 0 for lot in lots]).tolist()
    return [
        twigs[end - lot.amount : end] if lot.name == LEAVES else rows[lot.first : lot.first + lot.amount]
        for lot, end in zip(lots, ends, strict=True)
    ]
