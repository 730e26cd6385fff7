"""Choosing which trees a picture shows, and how: those of all models at once."""

from collections.abc import Sequence
from math import exp
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Indices
from ..space.cone import distance_in_order
from ..space.window import cell_of
from .batch import Batch, joined
from .bounds import Balls, matrices_of, outside_picture
from .distant import Distant
from .habit import NEEDLES
from .leafy import balls_shown, blocks_in_sight, blocks_of_models, blocks_shown, blocks_within, near_twigs
from .look import Look, Slack
from .model import MARGIN, Model
from .shells import SHELLS, farthest_of, rings_of, shells_of
from .shown import Shown
from .standing import (
    BAREST,
    WIDEST_ROW,
    Standing,
    columns_of,
    far_instances,
    has_picture,
    has_twigs,
    ring_opacity,
    set_detail,
)
from .stream import BACKS, CARDS, FAR, FIRST_OF, LEAVES, SHELL_OF, STREAMS, WOOD_LIMITS, WOODS
from .twig import LEAF_PIXELS
from .wood import AWAY, SWAYS, THINNEST, nearest_ahead

NEAREST = 0.1
"""Least distance of a tree's middle from the eye [m]: nearer ones count as so far."""

ANY_HEIGHT = 1e6
"""Height in the picture that stands for full detail [pixels]."""

SLACK = Slack(moves=0.25, shifts=0.16, turns=0.02, zooms=0.001)
"""Changes within which trees stay chosen, but for their level of detail: about ten frames of a walk."""

Twigs = tuple[Indices, Doubles]
"""Twigs, or blocks of them: each one's tree, as an index into those seen, and `first` of its instance."""


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

    larger: Doubles
    """Greatest height of each one's picture within the slack [pixels]."""

    smaller: Doubles
    """Least height of each one's picture within the slack [pixels]."""


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
        self.extents = np.column_stack([self._middle, high, aside])
        """Middle of each tree, and its half extents up and aside with the row that it stands for [m], shape (n, 5)."""
        pictured = np.where(self._ring > 1, 0.0, self._height * self._pictured)
        self.shown: Shown | None = None
        """What was chosen last."""
        self._distant = Distant(self._model, self.extents, self._instances, self._ring, pictured, self._needles)

    def choose(self, look: Look, /) -> Shown:
        """Return what is drawn of the trees in a picture.

        It is the same object while it serves other pictures, with other trees of it and another level of detail.
        """
        shown = self.shown
        if shown is not None and look.held and shown.look.live:
            self._set_detail(look, shown.trees, shown.number)
            shown.show(look, held=True)
            return shown
        if shown is not None and _serves(shown.look, look):
            self._set_detail(look, shown.trees, shown.number)
        else:
            self._distant.follow(look)
            self.shown = shown = self._nearer(look)
        shown.show(look)
        return shown

    def _nearer(self, look: Look) -> Shown:
        """Return what is drawn of all trees, those anew that are not distant."""
        number, slack = self._distant.others, _slack_of(look)
        extents = self.extents.take(number, axis=0)
        distance = _distance(extents[:, :3], look.eye)
        inside = outside_picture(extents, look.sides) <= slack.beside(distance + extents[:, 3] + extents[:, 4])
        number, distance = number[inside], distance[inside]
        order = np.argsort(distance)
        order = order[_stable_order(self._model[number[order]])]
        seen = self._seen(look, number[order])
        leafy, cards, balls = self._twigs(look, seen)
        shell, ring = shells_of(seen.along, look.reach), rings_of(seen.along, look.reach)
        back = np.where(self._needles[seen.model] & (shell == 0) & (ring > 0), SHELLS + ring, shell)
        stream, entry, tree, first = _by_stream(seen, shell, back, leafy, cards)
        card = entry - len(leafy[0])
        blocks = np.flatnonzero((card >= 0) & (card < len(cards[0])))
        instances = seen.instances.take(tree)  # thirty times as fast as fancy indexing on structured arrays
        instances["first"] = first
        near_batches, ends = _batches(stream, tree, instances, seen, distance[order])
        batches = {(batch.model, batch.name): batch for batch in near_batches}
        for beyond in self._distant.pictures:
            near = batches.get(key := (beyond.model, beyond.name))
            batches[key] = beyond if near is None else joined(near, beyond)
        return Shown(
            look, [*batches.values()], seen.instances, seen.number, self.extents.take(seen.number, axis=0),
            seen.pixel_radius, tree, instances, blocks, balls.take(card.take(blocks)), ends,
        )  # fmt: skip

    def _set_detail(self, look: Look, instances: NDArray[np.void], number: Indices) -> Doubles:
        """Write trees' level of detail into records of `INSTANCE`; return the height of their pictures [pixels]."""
        middle, ring = self._middle.take(number, axis=0), self._ring[number]
        eyes = look.detail_eyes or (look.eye,)
        distance = np.min([_distance(middle, np.asarray(eye)) for eye in eyes], axis=0)
        pictured = look.focal * self._height[number] * self._pictured[number] / np.maximum(distance, NEAREST)
        if look.leaves_from is not None:
            pictured = np.where(pictured <= look.leaves_from, 0.0, ANY_HEIGHT)
        pictured[ring > 1] = 0.0
        set_detail(instances, pictured)
        instances["opacity"] = ring_opacity(ring, np.hypot(*(middle - look.eye)[:, ::2].T))
        return np.asarray(pictured)

    def _seen(self, look: Look, number: Indices) -> _Seen:
        """Return how trees are seen from about a viewpoint."""
        middle, scale, slack = self._middle.take(number, axis=0), self._scale[number], _slack_of(look)
        instances, distance = self._instances.take(number), _distance(middle, look.eye)
        pictured = self._set_detail(look, instances, number)
        larger = pictured * exp(slack.zooms) * distance / np.maximum(distance - slack.moves, NEAREST)
        smaller = pictured * exp(-slack.zooms) * distance / (distance + slack.moves)
        along = np.hypot(*(middle - look.eye)[:, ::2].T)
        in_order = look.patch * distance_in_order(cell_of(middle[:, ::2], patch=look.patch), look.centre)
        ahead = nearest_ahead(look.clip, middle, look.eye, self._reach.take(number, axis=0)) - slack.moves
        pixel_radius = THINNEST * np.maximum(ahead, AWAY) / (look.focal * scale)
        return _Seen(number, self._model[number], instances, along, in_order, pixel_radius, larger, smaller)

    def _twigs(self, look: Look, seen: _Seen) -> tuple[Twigs, Twigs, Balls]:
        """Return the twigs drawn leaf by leaf, the blocks of twigs drawn on cards, and the bounds of these."""
        near = np.flatnonzero(has_twigs(seen.larger))
        model, number, slack = seen.model[near], seen.number[near], _slack_of(look)
        instances = seen.instances.take(near)
        matrix = matrices_of(instances)
        set_detail(instances, seen.larger[near])
        share = instances["twig_share"] * (1.0 - instances["far_fade"]) * instances["foliage"]
        sight = blocks_in_sight(self._blocks, model, matrix, look, slack)
        tree, first = blocks_shown(self._blocks, model, share, sight)
        on_cards, balls = (near[tree], first), balls_shown(self._blocks, model[tree], matrix[tree], first)
        if look.leaves_from is not None:
            return (near, np.zeros(len(near))), on_cards, balls
        within = look.focal * self._scale[number] * self._leaf[number] / LEAF_PIXELS[0] + slack.moves
        blocks = blocks_within(sight, within)
        leafy = np.flatnonzero(blocks.any(axis=1))
        twigs = [
            near_twigs(self._models[model[n]], np.flatnonzero(blocks[n]), share[n], matrix[n], look, slack, within[n])
            for n in leafy.tolist()
        ]
        return (near[leafy].repeat([*map(len, twigs)]), np.concatenate([np.zeros(0), *twigs])), on_cards, balls


def _serves(before: Look, now: Look) -> bool:
    """Return whether what was chosen for a viewpoint serves another."""
    return (before.patch, *before.centre) == (now.patch, *now.centre) and SLACK.used(before, now) <= 1.0


def _slack_of(look: Look) -> Slack:
    """Return the slack that trees are chosen with: none where they do not stay chosen."""
    return SLACK if look.is_usual else Slack(0.0, 0.0, 0.0, 0.0)


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


def _by_stream(
    seen: _Seen, shell: Indices, back: Indices, leafy: Twigs, cards: Twigs
) -> tuple[Indices, Indices, Indices, Doubles]:
    """Sort trees into streams; return the stream of each entry, its number, its tree and its `first`, by stream.

    Streams are numbered through all models. A tree has an entry in each stream that draws it, or one for each of its
    twigs drawn leaf by leaf, and of its blocks of twigs drawn on cards. Entries are numbered with these first.
    """
    (leafy_tree, twig), (card_tree, block) = leafy, cards
    near, far = np.flatnonzero(has_twigs(seen.larger)), np.flatnonzero(has_picture(seen.smaller))
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
    return stream[order], order, tree[order], np.concatenate([twig, block, of_trees])[order]


def _wood_stream(seen: _Seen, near: Indices, shell: Indices) -> Indices:
    """Return the index in `WOODS` of each near tree: beyond the grass by `pixel_radius`, else by shell."""
    return np.where(
        shell[near] == 0, np.searchsorted(WOOD_LIMITS, seen.pixel_radius[near]), len(WOOD_LIMITS) + shell[near]
    )


def _batches(
    stream: Indices, tree: Indices, instances: NDArray[np.void], seen: _Seen, distance: Doubles
) -> tuple[list[Batch], Indices]:  # fmt: skip
    """Return a batch for each run of equal `stream`, and its end; `distance` is that of each tree's crown [m]."""
    begin = np.flatnonzero(np.append(True, stream[1:] != stream[:-1])[: len(stream)])
    low, high, total = np.minimum.reduceat, np.maximum.reduceat, np.add.reduceat
    new = np.append(True, tree[1:] != tree[:-1])[: len(tree)]  # else another block of twigs of the same tree
    new[begin] = True
    ends = np.append(begin, len(stream))[1:]
    columns = (
        *divmod(stream[begin], len(STREAMS)), begin, ends, low(distance[tree], begin),
        total(distance[tree] * new, begin) / total(new, begin, dtype=np.intp), high(seen.in_order[tree], begin),
        low(seen.pixel_radius[tree], begin), low(instances["foliage"], begin),
    )  # fmt: skip
    batches = [
        Batch(model, name, (instances[start:end],), nearest, mean, farthest_of(SHELL_OF[name], far), *rest)
        for model, index, start, end, nearest, mean, far, *rest in zip(*map(np.ndarray.tolist, columns), strict=True)
        for name in (STREAMS[index],)
    ]
    return batches, ends
