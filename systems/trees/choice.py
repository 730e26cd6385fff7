"""Choosing which trees a picture shows, and how: those of all models at once."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Indices, Ints
from ..space.cone import distance_in_order
from ..space.frustum import outside_planes
from ..space.window import cell_of
from .habit import NEEDLES
from .leafy import blocks_of_models, blocks_shown, near_twigs
from .model import MARGIN, Model
from .shells import SHELLS, farthest_of, rings_of, shells_of
from .standing import BAREST, WIDEST_ROW, Standing, columns_of, far_instances, ring_opacity, set_detail
from .stream import BACKS, CARDS, FAR, FIRST_OF, LEAVES, SHELL_OF, STREAMS, WOOD_LIMITS, WOODS
from .twig import LEAF_PIXELS
from .wood import AWAY, SWAYS, THINNEST, nearest_ahead

CLUSTER = 32
"""Trees, one after another in memory, that share a bounding sphere: trees of a forest are stored side by side."""

NEAREST = 0.1
"""Least distance of a tree's middle from the eye [m]: nearer ones count as so far."""

ANY_HEIGHT = 1e6
"""Height in the picture that stands for full detail [pixels]."""


class Look(NamedTuple):
    """The viewpoint and projection that trees are chosen for."""

    eye: Doubles
    """[m]."""

    sides: Doubles
    """Planes of the frustum, as `Viewer` has them."""

    clip: Doubles
    """Matrix from places to clip space, (4, 4)."""

    focal: float
    """Focal length [pixels]."""

    reach: float
    """Distance up to which grass is drawn from far to near [m]."""

    patch: float
    """Side of a patch of grass [m]."""

    centre: Ints
    """Cell that the viewer stands in, (2,)."""

    detail_eyes: Sequence[Doubles | tuple[float, float, float]] = ()
    """Eyes that level of detail is chosen for: the nearest one counts. Without any, `eye` does."""

    leaves_from: float | None = None
    """Height of their own pictures from which all trees are drawn leaf by leaf, and lower ones as pictures [pixels];
    None lets the size of leaves decide."""


class Batch(NamedTuple):
    """Trees of one model, or twigs or blocks of twigs of them, that one stream draws together."""

    model: int
    """Index of the model among those of all kinds."""

    name: str
    """Name of the stream."""

    first: int
    """Index of the first one in `Chosen.instances`."""

    size: int
    nearest: float
    """Distance of the nearest crown's middle [m]."""

    mean: float
    """Mean distance of the crowns' middles [m]."""

    far: float
    """Distance of the farthest tree by the order of patches, as `farthest_of` returns it [m]."""

    pixel_radius: float
    """Least radius of a stem of the model that is a pixel wide, at the nearest tree [m]."""

    foliage: float
    """Least share of its leaves that a tree has."""


class Chosen(NamedTuple):
    """What is drawn of trees."""

    batches: list[Batch]
    instances: NDArray[np.void]
    """Instance attributes of all trees, batch after batch: records of `INSTANCE`."""


def one_of_each(models: int, tree: NDArray[np.void], /) -> Chosen:
    """Return a tree for each stream of so many models, drawn anywhere; `tree` is a record of `INSTANCE`, shape (1,)."""
    streams = [(model, name) for model in range(models) for name in STREAMS]
    batches = [
        Batch(model, name, number, 1, 0.0, 0.0, farthest_of(SHELL_OF[name], 1.0), 1.0, 1.0)
        for number, (model, name) in enumerate(streams)
    ]
    return Chosen(batches, tree.repeat(len(streams)))


class _Seen(NamedTuple):
    """The trees in a picture, model after model and the nearest first."""

    number: Indices
    """Index of each among all trees."""

    model: Indices
    instances: NDArray[np.void]
    """Records of `INSTANCE`."""

    along: Doubles
    """Distance of each along the ground [m]."""

    in_order: Doubles
    """Distance by which the patch that each stands on is drawn, among the others [m]."""

    pixel_radius: Doubles
    """Radius of a stem of its model that is a pixel wide at its nearest point [m]."""


class Choice:
    """All trees of a frame, to choose from; `variety` is the spread of brightness within each model."""

    def __init__(self, standing: Standing, models: Sequence[Model], variety: Sequence[float]) -> None:
        rows, self._model = standing.by_model
        self._models = models
        self._blocks = blocks_of_models(models)
        self._needles = np.array([model.habit.leaf.form == NEEDLES for model in models], np.bool_)
        """Models with needles: hardly one covers a pixel wholly, so that most of their pictures are soft edges."""
        numbers = np.array([_model_numbers(*pair) for pair in zip(models, variety, strict=True)])[self._model].T
        height, middle, half, radius, hertz, self._leaf, spread = numbers
        self._height, self._ring = rows["height"].copy(), rows["ring"].copy()
        self._pictured = 2.0 * half / height / np.maximum(rows["foliage"], BAREST)
        """Height of each tree's pictures, relative to its own, divided by its share of leaves, at least `BAREST`."""
        self._scale = self._height.astype(np.float64) / height
        self._middle: Doubles = rows["root"].astype(np.float64)
        self._middle[:, 1] += self._scale * middle
        self._instances = far_instances(rows, height.astype(np.float32), spread.astype(np.float32))
        self._instances["columns"] = columns_of(rows, self._scale * radius)
        self._instances["crown_at"], self._instances["hertz"] = self._scale * middle, hertz / np.sqrt(self._scale)
        self._ball = np.hypot(half, radius)
        """Radius of each model's bounding sphere [m], shape (n,)."""
        self._reach = self._scale[:, None] * (np.stack([half, radius], axis=1) + SWAYS * self._ball[:, None])
        """Half the height and the radius of each tree's bounding cylinder in any wind [m], shape (n, 2)."""
        beside, sways = np.where(self._ring > 1, WIDEST_ROW, 0.0), (1.0 + SWAYS) * self._scale
        high, aside = (beside + sways * MARGIN * extent for extent in (middle, radius))
        self._extents = np.column_stack([self._middle, high, aside])
        """Middle of each tree, and its half extents up and aside with the row that it stands for [m], shape (n, 5)."""
        self._spheres = _bounding_spheres(self._middle, np.hypot(high, aside))

    def in_picture(self, sides: Doubles, /) -> Indices:
        """Return the indices of the trees within a frustum's sides."""
        middle, radius = self._spheres
        near = np.flatnonzero(np.repeat(outside_planes(middle, sides) <= radius, CLUSTER)[: len(self._model)])
        nearer = np.column_stack([sides[:, :3], np.abs(sides[:, 1]), np.hypot(*sides[:, :3:2].T)])
        inside = nearer @ self._extents.take(near, axis=0).T + sides[:, 3:]
        return np.asarray(near[inside.min(axis=0) >= 0.0])

    def choose(self, look: Look, /) -> Chosen:
        """Return what is drawn of the trees in a picture."""
        number = self.in_picture(look.sides)
        distance = _distance(self._middle.take(number, axis=0), look.eye)
        order = np.argsort(distance)
        order = order[_stable_order(self._model[number[order]])]
        number, distance = number[order], distance[order]
        seen = self._seen(look, number, distance)
        leafy, twigs = self._leafy(look, seen, distance), self._on_cards(look, seen)
        shell, ring = shells_of(seen.along, look.reach), rings_of(seen.along, look.reach)
        back = np.where(self._needles[seen.model] & (shell == 0) & (ring > 0), SHELLS + ring, shell)
        stream, tree, first = _by_stream(seen, shell, back, leafy, twigs)
        batches = _batches(stream, tree, seen, distance)
        instances = seen.instances.take(tree)  # thirty times as fast as fancy indexing on structured arrays
        instances["first"] = first
        return Chosen(batches, instances)

    def _seen(self, look: Look, number: Indices, distance: Doubles) -> _Seen:
        """Return the level of detail of trees at distances (n,) [m]."""
        middle, scale, ring = self._middle.take(number, axis=0), self._scale[number], self._ring[number]
        if look.detail_eyes:
            distance = np.min([_distance(middle, np.asarray(eye)) for eye in look.detail_eyes], axis=0)
        pixels = look.focal * self._height[number] / np.maximum(distance, NEAREST)
        pictured = self._pictured[number]
        if look.leaves_from is not None:
            pixels = np.where(pixels * pictured <= look.leaves_from, 0.0, ANY_HEIGHT)
        pixels[ring > 1] = 0.0
        instances, along = self._instances.take(number), np.hypot(*(middle - look.eye)[:, ::2].T)
        in_order = look.patch * distance_in_order(cell_of(middle[:, ::2], patch=look.patch), look.centre)
        set_detail(instances, pixels * pictured)
        instances["opacity"] = ring_opacity(ring, along)
        ahead = nearest_ahead(look.clip, middle, look.eye, self._reach.take(number, axis=0))
        pixel_radius = THINNEST * np.maximum(ahead, AWAY) / (look.focal * scale)
        return _Seen(number, self._model[number], instances, along, in_order, pixel_radius)

    def _on_cards(self, look: Look, seen: _Seen) -> tuple[Indices, Doubles]:
        """Return the blocks of twigs drawn on cards: each one's tree, as an index into `seen`, and `first`."""
        near = np.flatnonzero(seen.instances["far_fade"] < 1.0)
        tree, first = blocks_shown(self._blocks, seen.model[near], seen.instances.take(near), look.eye, look.sides)
        return near[tree], first

    def _leafy(self, look: Look, seen: _Seen, distance: Doubles) -> tuple[Indices, Doubles]:
        """Return the twigs drawn leaf by leaf: each one's tree, as an index into `seen`, and its own number."""
        if look.leaves_from is not None:
            near = np.flatnonzero(seen.instances["far_fade"] < 1.0)
            return near, np.zeros(len(near))
        scale = self._scale[seen.number]
        within = look.focal * scale * self._leaf[seen.number] / LEAF_PIXELS[0]
        trees = np.flatnonzero(within > distance - scale * self._ball[seen.number]).tolist()
        models = self._models
        twigs = [near_twigs(models[seen.model[n]], seen.instances[n], look.eye, look.sides, within[n]) for n in trees]
        return np.repeat(np.array(trees, np.intp), [*map(len, twigs)]), np.concatenate([np.zeros(0), *twigs])


def _model_numbers(model: Model, variety: float) -> tuple[float, ...]:
    return (
        model.height, model.middle, model.half, model.radius, model.hertz, model.habit.leaf.length, variety,
    )  # fmt: skip


def _distance(middle: Doubles, eye: Doubles) -> Doubles:
    """Return the distances of places (n, 3) from the eye [m]."""
    away = middle - eye
    return np.asarray(np.sqrt(np.einsum("ij,ij->i", away, away)))  # a third of the time of `norm`


def _stable_order(number: Indices) -> Indices:
    """Return the order that sorts by model or stream and keeps the order within each."""
    return np.argsort(number.astype(np.int16), kind="stable")  # 16 bits are sorted by radix, much faster


def _bounding_spheres(middle: Doubles, reach: Doubles) -> tuple[Doubles, Doubles]:
    """Return bounding spheres of clusters of `CLUSTER` trees: middles (n, 3) and radii (n,) [m]."""
    if not len(middle):
        return middle, reach
    first = np.arange(0, len(middle), CLUSTER)
    low = np.minimum.reduceat(middle - reach[:, None], first)
    high = np.maximum.reduceat(middle + reach[:, None], first)
    return 0.5 * (low + high), 0.5 * np.linalg.norm(high - low, axis=1)


def _by_stream(
    seen: _Seen, shell: Indices, back: Indices, leafy: tuple[Indices, Doubles], cards: tuple[Indices, Doubles]
) -> tuple[Indices, Indices, Doubles]:
    """Sort trees into streams; return the stream of each entry, its tree and its `first`, ordered by stream.

    Streams are numbered through all models. A tree has an entry in each stream that draws it, or one for each of its
    twigs drawn leaf by leaf, and of its blocks of twigs drawn on cards.
    """
    far_fade, (leafy_tree, twig), (card_tree, block) = seen.instances["far_fade"], leafy, cards
    near, far = np.flatnonzero(far_fade < 1.0), np.flatnonzero(far_fade > 0.0)
    tree = np.concatenate([leafy_tree, card_tree, near, far, far[::-1]])
    within = [
        np.zeros(len(twig), np.intp), shell[card_tree], _wood_stream(seen, near, shell),
        np.zeros(len(far), np.intp), back[far[::-1]],
    ]  # fmt: skip
    first = [FIRST_OF[name] for name in (LEAVES, CARDS[0], WOODS[0], FAR, BACKS[0])]
    stream_of_model = np.concatenate([number + index for number, index in zip(first, within, strict=True)])
    stream = seen.model[tree] * len(STREAMS) + stream_of_model
    order = _stable_order(stream)
    of_trees = np.zeros(len(near) + 2 * len(far))
    return stream[order], tree[order], np.concatenate([twig, block, of_trees])[order]


def _wood_stream(seen: _Seen, near: Indices, shell: Indices) -> Indices:
    """Return the index in `WOODS` of each near tree: beyond the grass by `pixel_radius`, else by shell."""
    return np.where(
        shell[near] == 0, np.searchsorted(WOOD_LIMITS, seen.pixel_radius[near]), len(WOOD_LIMITS) + shell[near]
    )


def _batches(stream: Indices, tree: Indices, seen: _Seen, distance: Doubles) -> list[Batch]:
    """Return a batch for each run of equal `stream`; `distance` is that of each tree's crown [m]."""
    first = np.flatnonzero(np.diff(stream, prepend=-1))
    count, foliage = np.diff(first, append=len(stream)), seen.instances["foliage"]
    low, high, total = np.minimum.reduceat, np.maximum.reduceat, np.add.reduceat
    new = np.diff(tree, prepend=-1) != 0  # else another block of twigs of the same tree
    new[first] = True
    columns = (
        *divmod(stream[first], len(STREAMS)), first, count, low(distance[tree], first),
        total(distance[tree] * new, first) / total(new, first, dtype=np.intp), high(seen.in_order[tree], first),
        low(seen.pixel_radius[tree], first), low(foliage[tree], first),
    )  # fmt: skip
    return [
        Batch(model, STREAMS[index], start, size, nearest, mean, farthest_of(SHELL_OF[STREAMS[index]], far), *rest)
        for model, index, start, size, nearest, mean, far, *rest in zip(*map(np.ndarray.tolist, columns), strict=True)
    ]
