"""Blowing: primitives send their messages to the receivers (paper, sections 3.2 and 3.3)."""

from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache, partial
from itertools import chain, groupby, repeat
from math import radians
from operator import itemgetter
from types import NoneType
from zlib import crc32

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats
from ...components.pose import HERE, Pose
from ...components.wind import Extent, Grass, Mixing, WindPrimitive, WindSource
from ...engine.random import hash3
from .flutter import flutter
from .mean import TOWARDS, MeanWind
from .quarantine import Quarantine, QuarantinedError
from .shape import smooth

BESIDE = 1e-3
"""How far outside an extent a mask is still asked for, so that rounding cuts nothing off [m]."""

Rows = NDArray[np.intp]


@dataclass(frozen=True, slots=True, eq=False)
class Blowing:
    """A wind, or one part of it, at one instant."""

    source: WindSource
    primitive: WindPrimitive
    pose: Pose
    extent: Extent | None
    seed: int

    strength: float
    """How far it has set in, in (0, 1]."""


@dataclass(frozen=True, slots=True, eq=False)
class ReceiverArrays:
    """Receivers, and the patches that masks are discretised over (paper, section 3.3)."""

    place: Floats
    """Ground positions (x, z) [m], shape (n, 2)."""

    grass: Grass
    """How the grass at each answers."""

    patch: Rows
    """The patch that each belongs to, shape (n,)."""

    middle: Floats
    """Middles of the patches (x, z) [m], shape (m, 2)."""

    radius: float
    """How far a patch's receivers may be from its middle [m]."""

    still: int = 0
    """How many of them, the last ones, are without the small oscillations."""


def places_alone(place: Floats, grass: Grass, /) -> ReceiverArrays:
    """Return receivers at any places, each a patch by itself."""
    return ReceiverArrays(place, grass, np.arange(len(place)), place, 0.0)


def blowing(
    sources: Iterable[WindSource],
    quarantine: Quarantine,
    /,
    *,
    time: float,
    seed: int,
    poses: Iterable[Pose | None] = (),
    winds: Iterable[WindPrimitive | None] = (),
) -> list[Blowing]:
    """Return the winds that act at `time` [s], the strongest claim first.

    Higher priority goes first; of equal ones that which began later; then by kind, by what they declare, by name and by
    pose. So the order in which winds were made never counts. `poses` says where each source is; None, or none for it,
    leaves that to the wind. A source may be there more than once, at other poses. `winds` has the primitive of each
    source with the course of its phases, where that is another than the source's own.
    """
    given = zip(sources, chain(poses, repeat(None)), chain(winds, repeat(None)), strict=False)
    found = [wind for source, pose, own in given for wind in _parts(source, quarantine, time, seed, pose, own)]
    tied = (list(winds) for _, winds in groupby(sorted(found, key=_claim, reverse=True), key=_claim))
    return [wind for winds in tied for wind in (winds if len(winds) == 1 else _untied(winds, quarantine))]


def hear(
    winds: list[Blowing],
    heard: ReceiverArrays,
    quarantine: Quarantine,
    /,
    *,
    time: float,
    seed: int,
    mixing: Mixing = "priority",
    to: float = 0.0,
) -> Floats:
    """Return the message that each receiver ends up with, shape (n, 2).

    By `priority`, the first wind in `winds` whose mask holds a receiver cancels the others (paper, section 3.3). By
    `weight`, a wind covers those of lower priority as far as its mask, its weight and its setting in say, and winds of
    one priority are averaged. Where no mask reaches, grass is at rest. The small oscillations are carried to the yaw
    `to` [rad], whichever winds act.
    """
    left_out = -1
    while left_out < quarantine.count:  # what a wind sent before it failed is no message
        left_out = quarantine.count
        sums = _heard(winds, heard, quarantine, time, mixing)
    return _bounded(_fluttered(sums, heard, time, seed, to))


def mean_index(sources: Iterable[WindSource], quarantine: Quarantine, /, *, time: float) -> float:
    """Return the posture index that winds bring grass to everywhere at `time` [s], in the mean: the largest of any."""
    blown = [0.0]
    for source in sources:
        if isinstance(source.primitive, MeanWind):
            with suppress(QuarantinedError):
                blown.append(quarantine.ask(source, "its strength", partial(_mean_strength, source.primitive, time)))
    return min(max(blown), 1.0)


def _mean_strength(wind: MeanWind, time: float) -> float:
    return float(wind.strength) * _set_in(wind, wind.stop, time) if is_on(wind, time) else 0.0


def mean_wind(winds: Iterable[WindPrimitive], /) -> MeanWind | None:
    """Return a scene's mean wind, which clouds and the small oscillations go with.

    Of those that blow everywhere it is the one that claims least.
    """
    found = [wind for wind in winds if isinstance(wind, MeanWind)]
    return min(found, key=lambda wind: (claim(wind), wind.direction), default=None)


def mean_yaw(winds: Iterable[WindPrimitive], /) -> float:
    """Return where a scene's mean wind blows to [rad]."""
    found = mean_wind(winds)
    return radians(found.direction if found else TOWARDS)


def _heard(winds: list[Blowing], heard: ReceiverArrays, quarantine: Quarantine, time: float, mixing: Mixing) -> "_Sums":
    sums = _Sums(np.zeros((len(heard.place), 2), np.float32), *np.zeros((2, len(heard.place)), np.float32))
    sums.left[:] = 1.0
    groups: Iterable[list[Blowing]] = ([wind] for wind in winds)
    if mixing == "weight":
        winds = [wind for wind in winds if wind.primitive.weight > 0.0]
        groups = (list(group) for _, group in groupby(winds, key=lambda wind: wind.primitive.priority))
    for group in groups:
        sent = [one for wind in group if (one := send(wind, heard, sums.left, quarantine, time, mixing))]
        _cover(sums, sent)
    return sums


@dataclass(frozen=True, slots=True, eq=False)
class _Sums:
    message: Floats
    swing: Floats

    left: Floats
    """How much of each receiver no wind has claimed yet, shape (n,)."""


@dataclass(frozen=True, slots=True, eq=False)
class Sent:
    """What one wind sends."""

    rows: Rows | slice
    """The receivers that it reaches."""

    weight: Floats
    """How much of each it claims, its weight and how far it has set in included, shape (n,)."""

    message: Floats
    """Its messages, in the world's frame, shape (n, 2)."""

    swing: float
    """Largest index of the small oscillations in it."""


def _parts(
    source: WindSource,
    quarantine: Quarantine,
    time: float,
    seed: int,
    placed: Pose | None,
    on_course: WindPrimitive | None,
) -> Iterator[Blowing]:
    wind = on_course or source.primitive
    own = _own_seed(seed, source.name)
    try:
        if not quarantine.ask(source, "its timeline", partial(is_on, wind, time)):
            return
        parts = quarantine.ask(source, "parts", partial(wind.parts, time=time, seed=own))
        if type(parts) is not tuple:  # these questions are asked of each wind in each frame
            quarantine.must_be(source, "parts", parts, Sequence)
        for part in parts:
            if part is not wind:
                quarantine.must_be(source, "parts", part, WindPrimitive)
            pose = placed or quarantine.ask(source, "pose", partial(part.pose, time=time))
            extent = quarantine.ask(source, "extent", partial(part.extent, time=time))
            quarantine.must_be(source, "pose", pose, Pose)
            quarantine.must_be(source, "extent", extent, Extent, NoneType)
            quarantine.must_stand(source, part, pose, extent)
            strength = _set_in(part, wind.stop, time)
            if strength > 0.0:
                yield Blowing(source, part, pose, extent, own, strength)
    except QuarantinedError:
        return


@lru_cache(maxsize=1024)
def _own_seed(seed: int, name: str) -> int:
    return int(hash3(seed, crc32(name.encode()), 0))


def is_on(wind: WindPrimitive, time: float, /) -> bool:
    """Return whether a wind has begun at `time` [s] and not ended."""
    return wind.start <= time and (wind.stop is None or time < wind.stop)


def _set_in(wind: WindPrimitive, stop: float | None, time: float) -> float:
    begun = (time - wind.start) / wind.ease if wind.ease and wind.start else 1.0
    to_go = (stop - time) / wind.ease if wind.ease and stop is not None else 1.0
    part = min(begun, to_go)
    return 1.0 if part >= 1.0 else float(smooth(np.array([part], np.float32))[0])


def claim(wind: WindPrimitive, /) -> tuple[int, float, str]:
    """Return what winds are ordered by at a place: the largest comes first."""
    return wind.priority, wind.start, wind.kind


def _claim(wind: Blowing) -> tuple[int, float, str]:
    return claim(wind.primitive)


def _untied(winds: list[Blowing], quarantine: Quarantine) -> list[Blowing]:
    told: list[tuple[tuple[str | float, ...], Blowing]] = []
    for wind in winds:
        with suppress(QuarantinedError):
            values = quarantine.ask(wind.source, "model_dump_json", wind.primitive.model_dump_json)
            told.append(((values, wind.source.name, wind.pose.x, wind.pose.z, wind.pose.yaw), wind))
    return [wind for _, wind in sorted(told, key=itemgetter(0))]


def send(
    wind: Blowing, heard: ReceiverArrays, left: Floats, quarantine: Quarantine, time: float, mixing: Mixing
) -> Sent | None:
    """Return what a wind sends to the receivers that it reaches and that are still to be had; None is nothing.

    `left` (n,) is how much of each no wind has claimed yet. A wind that fails sends nothing.
    """
    rows, own = _within(wind, heard, left)
    source, primitive = wind.source, wind.primitive
    own = own.view()
    own.flags.writeable = False  # it may be everybody's
    try:
        if not len(own):
            return None
        weight = quarantine.ask_for(source, "mask", partial(primitive.mask, own, time=time), shape=(len(own),))
        reached = np.flatnonzero(weight > 0.0)
        if len(reached) < len(own):
            rows = reached if isinstance(rows, slice) else rows[reached]
            own, weight = own[reached], weight[reached]
        if not len(own):
            return None
        grass = heard.grass if isinstance(rows, slice) else heard.grass.at(rows)
        act = partial(primitive.action, own, time=time, seed=wind.seed, grass=grass)
        message = quarantine.ask_for(source, "action", act, shape=own.shape)
    except QuarantinedError:
        return None
    weight = np.ones_like(weight) if mixing == "priority" else np.minimum(weight, 1.0) * np.float32(primitive.weight)
    return Sent(rows, weight * np.float32(wind.strength), wind.pose.outside(message), primitive.swing)


def _within(wind: Blowing, heard: ReceiverArrays, left: Floats) -> tuple[Rows | slice, Floats]:
    """Return the receivers in a wind's extent that others have not claimed wholly, and their places in its frame.

    For a wind without an extent these are all receivers, unless most of them are claimed: to pick out some costs more
    than to ask all.
    """
    unclaimed = left > 0.0
    if wind.extent is None:
        rows = np.flatnonzero(unclaimed)
        if 2 * len(rows) > len(left):
            return slice(None), _seen_from(wind, heard.place)
        return rows, _seen_from(wind, heard.place[rows])
    met = _holds(wind.extent, wind.pose.inside(heard.middle), heard.radius)
    rows = np.flatnonzero(met[heard.patch] & unclaimed) if met.any() else np.zeros(0, np.intp)
    own = _seen_from(wind, heard.place.take(rows, axis=0))
    held = np.flatnonzero(_holds(wind.extent, own, 0.0))
    return rows[held], own.take(held, axis=0)


def _seen_from(wind: Blowing, place: Floats) -> Floats:
    return wind.pose.inside(place) if wind.pose != HERE else place


def _holds(box: Extent, place: Floats, radius: float) -> NDArray[np.bool_]:
    """Return whether an extent comes within `radius` [m] of places in the same frame, but for rounding, shape (n,)."""
    x, z, far = place[:, 0], place[:, 1], radius + BESIDE
    held = (x > box.left - far) & (x < box.right + far) & (z > box.ahead - far) & (z < box.behind + far)
    return np.asarray(held)


def _cover(sums: _Sums, sent: list[Sent]) -> None:
    """Lay the messages of winds of one claim over what is left of the receivers."""
    if len(sent) == 1:
        _lay(sums, sent[0].rows, sent[0].weight, sent[0].message, np.float32(sent[0].swing))
    elif sent:
        total, kept = np.zeros_like(sums.left), np.ones_like(sums.left)
        message, swing = np.zeros_like(sums.message), np.zeros_like(sums.swing)
        for one in sent:
            total[one.rows] += one.weight
            kept[one.rows] *= 1.0 - one.weight
            message[one.rows] += one.weight[:, None] * one.message
            swing[one.rows] += one.weight * np.float32(one.swing)
        rows = np.flatnonzero(total)
        share = total[rows]
        _lay(sums, rows, 1.0 - kept[rows], message[rows] / share[:, None], swing[rows] / share)


def _lay(sums: _Sums, rows: Rows | slice, weight: Floats, message: Floats, swing: Floats | np.float32) -> None:
    if isinstance(rows, slice) and len(weight) and weight.min() == sums.left.min() == 1.0:  # all of all, as a breeze's
        sums.message[:], sums.swing[:], sums.left[:] = message, swing, 0.0
        return
    share = sums.left[rows] * weight
    sums.message[rows] += share[:, None] * message
    sums.swing[rows] += share * swing
    sums.left[rows] -= share


def _fluttered(sums: _Sums, heard: ReceiverArrays, time: float, seed: int, to: float) -> Floats:
    moving = len(heard.place) - heard.still
    swing = sums.swing[:moving]
    rows = np.flatnonzero(swing)
    chosen = slice(moving) if len(rows) == moving else rows
    if len(rows):
        sums.message[chosen] += swing[chosen, None] * flutter(heard.place[chosen], time=time, seed=seed, to=to)
    return sums.message


def _bounded(message: Floats) -> Floats:
    """Return messages whose index is at most 1."""
    index = np.sqrt(message[:, 0] * message[:, 0] + message[:, 1] * message[:, 1])
    message /= np.maximum(index, np.float32(1.0))[:, None]
    return message
