"""Blowing: winds send their messages to receivers, by priority or by weight (paper, sections 3.2 and 3.3)."""

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

from ...components.arrays import Floats, Indices
from ...components.pose import HERE, Pose
from ...components.wind import Extent, Grass, Mixing, WindPrimitive, WindSource
from ...engine.random import hash3
from .flutter import flutter
from .mean import TOWARDS, MeanWind
from .quarantine import Quarantine, QuarantinedError
from .shape import smooth

MARGIN = 1e-3
"""Margin around an extent within which the mask still counts, so that rounding cuts nothing off [m]."""

MOST_PARTS = 1000
"""Largest number of winds of which a wind consists: each of them takes time and memory in every frame."""


@dataclass(frozen=True, slots=True, eq=False)
class Blowing:
    """A wind, or one part of it, at one instant."""

    source: WindSource
    primitive: WindPrimitive
    pose: Pose
    extent: Extent | None
    seed: int

    strength: float
    """Factor of its setting in and dying down, in (0, 1]."""


@dataclass(frozen=True, slots=True, eq=False)
class ReceiverArrays:
    """Receivers, and the patches that masks are discretised over (paper, section 3.3)."""

    place: Floats
    """Ground positions (x, z) [m], shape (n, 2)."""

    grass: Grass
    """Responses of the grass at the receivers."""

    patch: Indices
    """Index of each receiver's patch, shape (n,)."""

    middle: Floats
    """Middles of the patches (x, z) [m], shape (m, 2)."""

    radius: float
    """Largest distance of a receiver from its patch's middle [m]."""

    still: int = 0
    """Number of receivers, the last ones, without the small oscillations."""


def lone_receivers(place: Floats, grass: Grass, /) -> ReceiverArrays:
    """Return receivers at ground positions (n, 2) [m], each a patch of its own."""
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

    Higher priority goes first; of equal ones the wind that began later; then kind, declared values, name and pose
    decide. So the order in which winds were made never counts. `poses` overrides the pose of each source, if not None;
    a source may be given more than once, at other poses. `winds` overrides the primitive of each source, if not None,
    by one that carries the course of its phases.
    """
    placed = zip(sources, chain(poses, repeat(None)), chain(winds, repeat(None)), strict=False)
    parts = [part for source, pose, wind in placed for part in _parts(source, quarantine, time, seed, pose, wind)]
    tied = (list(winds) for _, winds in groupby(sorted(parts, key=_claim, reverse=True), key=_claim))
    return [wind for winds in tied for wind in (winds if len(winds) == 1 else _untied(winds, quarantine))]


def hear(
    winds: list[Blowing],
    receivers: ReceiverArrays,
    quarantine: Quarantine,
    /,
    *,
    time: float,
    seed: int,
    mixing: Mixing = "priority",
    yaw: float = 0.0,
) -> Floats:
    """Return the resulting message at each receiver, shape (n, 2).

    With `priority`, the first wind in `winds` whose mask is above 0 at a receiver cancels the others (paper, section
    3.3). With `weight`, a wind covers those of lower priority by its mask times its weight times its `strength`, and
    winds of equal priority are averaged. Where no mask reaches, grass is at rest. The small oscillations drift towards
    `yaw` [rad], whichever winds act.
    """
    left_out = -1
    while left_out < quarantine.count:  # messages of a wind that failed later are no messages: begin again without it
        left_out = quarantine.count
        sums = _summed(winds, receivers, quarantine, time, mixing)
    return _bounded(_fluttered(sums, receivers, time, seed, yaw))


def mean_index(sources: Iterable[WindSource], quarantine: Quarantine, /, *, time: float) -> float:
    """Return the mean posture index of grass everywhere at `time` [s]: the largest of the mean winds' strengths."""
    strengths = [0.0]
    for source in sources:
        if isinstance(source.primitive, MeanWind):
            with suppress(QuarantinedError):
                strengths.append(
                    quarantine.ask(source, "its strength", partial(_mean_strength, source.primitive, time))
                )
    return min(max(strengths), 1.0)


def _mean_strength(wind: MeanWind, time: float) -> float:
    return float(wind.strength) * _envelope(wind, wind.stop, time) if is_on(wind, time) else 0.0


def mean_wind(winds: Iterable[WindPrimitive], /) -> MeanWind | None:
    """Return a scene's mean wind, which carries clouds and the small oscillations: the one with the least claim."""
    found = [wind for wind in winds if isinstance(wind, MeanWind)]
    return min(found, key=lambda wind: (claim(wind), wind.direction), default=None)


def mean_yaw(winds: Iterable[WindPrimitive], /) -> float:
    """Return the yaw that a scene's mean wind blows to [rad]."""
    found = mean_wind(winds)
    return radians(found.direction if found else TOWARDS)


def _summed(
    winds: list[Blowing], receivers: ReceiverArrays, quarantine: Quarantine, time: float, mixing: Mixing
) -> "_Sums":
    """Sum up the messages and swings of winds, the strongest claim first."""
    count = len(receivers.place)
    sums = _Sums(np.zeros((count, 2), np.float32), np.zeros(count, np.float32), np.ones(count, np.float32))
    groups: Iterable[list[Blowing]] = ([wind] for wind in winds)
    if mixing == "weight":
        winds = [wind for wind in winds if wind.primitive.weight > 0.0]
        groups = (list(group) for _, group in groupby(winds, key=lambda wind: wind.primitive.priority))
    for group in groups:
        sent = [send(wind, receivers, sums.unclaimed, quarantine, time, mixing) for wind in group]
        _cover(sums, list(filter(None, sent)))
    return sums


@dataclass(frozen=True, slots=True, eq=False)
class _Sums:
    """Weighted sums over the winds so far, at each receiver."""

    message: Floats
    """Messages, shape (n, 2)."""

    swing: Floats
    """Swings, shape (n,)."""

    unclaimed: Floats
    """Part of each receiver that no wind has claimed yet, shape (n,)."""


@dataclass(frozen=True, slots=True, eq=False)
class Sent:
    """Messages of one wind."""

    rows: Indices | slice
    """Receivers that it reaches."""

    weight: Floats
    """Part of each receiver that it claims: its mask, weight and strength multiplied, shape (n,)."""

    message: Floats
    """Messages in the world's frame, shape (n, 2)."""

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
    """Yield the parts of a source's wind that act at `time` [s]; none where one of its answers fails."""
    wind = on_course or source.primitive
    wind_seed = _wind_seed(seed, source.name)
    try:
        if not quarantine.ask(source, "its timeline", partial(is_on, wind, time)):
            return
        parts = quarantine.ask(source, "parts", partial(wind.parts, time=time, seed=wind_seed))
        if type(parts) is not tuple:  # the quicker check, as this runs for each wind in each frame
            quarantine.must_be(source, "parts", parts, Sequence)
        if len(parts) > MOST_PARTS:
            raise quarantine.leave_out(source, f"parts returned {len(parts)} winds, {MOST_PARTS} at most are due")
        for part in parts:
            if part is not wind:
                quarantine.must_be(source, "parts", part, WindPrimitive)
            pose = placed or quarantine.ask(source, "pose", partial(part.pose, time=time))
            extent = quarantine.ask(source, "extent", partial(part.extent, time=time))
            quarantine.must_be(source, "pose", pose, Pose)
            quarantine.must_be(source, "extent", extent, Extent, NoneType)
            quarantine.must_stand(source, part, pose, extent)
            strength = _envelope(part, wind.stop, time)
            if strength > 0.0:
                yield Blowing(source, part, pose, extent, wind_seed, strength)
    except QuarantinedError:
        return


@lru_cache(maxsize=1024)
def _wind_seed(seed: int, name: str) -> int:
    """Return the seed of the wind of this name in a scene with a `seed`."""
    return int(hash3(seed, crc32(name.encode()), 0))


def is_on(wind: WindPrimitive, time: float, /) -> bool:
    """Return whether a wind has begun at `time` [s] and not ended."""
    return wind.start <= time and (wind.stop is None or time < wind.stop)


def _envelope(wind: WindPrimitive, stop: float | None, time: float) -> float:
    """Return the factor by which a wind sets in over `ease` after its start and dies down before `stop` [s]."""
    begun = (time - wind.start) / wind.ease if wind.ease and wind.start else 1.0
    to_go = (stop - time) / wind.ease if wind.ease and stop is not None else 1.0
    fraction = min(begun, to_go)
    return 1.0 if fraction >= 1.0 else float(smooth(np.array([fraction], np.float32))[0])


def claim(wind: WindPrimitive, /) -> tuple[int, float, str]:
    """Return the sort key of winds that meet at a place: the largest comes first."""
    return wind.priority, wind.start, wind.kind


def _claim(wind: Blowing) -> tuple[int, float, str]:
    return claim(wind.primitive)


def _untied(winds: list[Blowing], quarantine: Quarantine) -> list[Blowing]:
    """Order winds of equal claim by their declared values, name and pose."""
    keyed: list[tuple[tuple[str | float, ...], Blowing]] = []
    for wind in winds:
        with suppress(QuarantinedError):
            values = quarantine.ask(wind.source, "model_dump_json", wind.primitive.model_dump_json)
            keyed.append(((values, wind.source.name, wind.pose.x, wind.pose.z, wind.pose.yaw), wind))
    return [wind for _, wind in sorted(keyed, key=itemgetter(0))]


def send(
    wind: Blowing, receivers: ReceiverArrays, unclaimed: Floats, quarantine: Quarantine, time: float, mixing: Mixing
) -> Sent | None:
    """Return a wind's messages to the receivers that it reaches and others have not claimed; None where there are none.

    `unclaimed` (n,) is the fraction of each receiver that no wind has claimed yet. A wind that fails sends nothing.
    """
    rows, place = _within(wind, receivers, unclaimed)
    source, primitive = wind.source, wind.primitive
    place = place.view()
    place.flags.writeable = False  # it may be shared with other winds
    try:
        if not len(place):
            return None
        weight = quarantine.ask_for(source, "mask", partial(primitive.mask, place, time=time), shape=(len(place),))
        reached = np.flatnonzero(weight > 0.0)
        if len(reached) < len(place):
            rows = reached if isinstance(rows, slice) else rows[reached]
            place, weight = place[reached], weight[reached]
        if not len(place):
            return None
        grass = receivers.grass if isinstance(rows, slice) else receivers.grass.at(rows)
        act = partial(primitive.action, place, time=time, seed=wind.seed, grass=grass)
        message = quarantine.ask_for(source, "action", act, shape=place.shape)
    except QuarantinedError:
        return None
    weight = np.ones_like(weight) if mixing == "priority" else np.minimum(weight, 1.0) * np.float32(primitive.weight)
    return Sent(rows, weight * np.float32(wind.strength), wind.pose.outside(message), primitive.swing)


def _within(wind: Blowing, receivers: ReceiverArrays, unclaimed: Floats) -> tuple[Indices | slice, Floats]:
    """Return the receivers in a wind's extent that are not wholly claimed, and their places in the wind's frame.

    For a wind without an extent these are all receivers, unless at least half of them are claimed: picking some out
    costs more than asking for all.
    """
    is_free = unclaimed > 0.0
    if wind.extent is None:
        rows = np.flatnonzero(is_free)
        if 2 * len(rows) > len(unclaimed):
            return slice(None), _in_frame(wind, receivers.place)
        return rows, _in_frame(wind, receivers.place[rows])
    met = _in_extent(wind.extent, wind.pose.inside(receivers.middle), receivers.radius)
    rows = np.flatnonzero(met[receivers.patch] & is_free) if met.any() else np.zeros(0, np.intp)
    place = _in_frame(wind, receivers.place.take(rows, axis=0))
    held = np.flatnonzero(_in_extent(wind.extent, place, 0.0))
    return rows[held], place.take(held, axis=0)


def _in_frame(wind: Blowing, place: Floats) -> Floats:
    """Transform places to a wind's frame."""
    return wind.pose.inside(place) if wind.pose != HERE else place


def _in_extent(extent: Extent, place: Floats, radius: float) -> NDArray[np.bool_]:
    """Return which places in its frame are within `radius` [m] of an extent, with a margin for rounding, shape (n,)."""
    x, z, far = place[:, 0], place[:, 1], radius + MARGIN
    held = (x > extent.left - far) & (x < extent.right + far) & (z > extent.ahead - far) & (z < extent.behind + far)
    return np.asarray(held)


def _cover(sums: _Sums, sent: list[Sent]) -> None:
    """Lay the messages of winds with equal claims over the unclaimed parts of receivers, averaged by weight."""
    if len(sent) == 1:
        _lay(sums, sent[0].rows, sent[0].weight, sent[0].message, np.float32(sent[0].swing))
    elif sent:
        total, kept = np.zeros_like(sums.unclaimed), np.ones_like(sums.unclaimed)
        message, swing = np.zeros_like(sums.message), np.zeros_like(sums.swing)
        for one in sent:
            total[one.rows] += one.weight
            kept[one.rows] *= 1.0 - one.weight
            message[one.rows] += one.weight[:, None] * one.message
            swing[one.rows] += one.weight * np.float32(one.swing)
        rows = np.flatnonzero(total)
        weight = total[rows]
        _lay(sums, rows, 1.0 - kept[rows], message[rows] / weight[:, None], swing[rows] / weight)


def _lay(sums: _Sums, rows: Indices | slice, weight: Floats, message: Floats, swing: Floats | np.float32) -> None:
    """Lay messages with these weights over the unclaimed parts of receivers."""
    is_all = isinstance(rows, slice) and len(weight) and weight.min() == sums.unclaimed.min() == 1.0
    if is_all:  # as of a breeze alone
        sums.message[:], sums.swing[:], sums.unclaimed[:] = message, swing, 0.0
        return
    share = sums.unclaimed[rows] * weight
    sums.message[rows] += share[:, None] * message
    sums.swing[rows] += share * swing
    sums.unclaimed[rows] -= share


def _fluttered(sums: _Sums, receivers: ReceiverArrays, time: float, seed: int, yaw: float) -> Floats:
    """Return the summed messages with the small oscillations added, scaled by the summed swing."""
    moving = len(receivers.place) - receivers.still
    swing = sums.swing[:moving]
    rows = np.flatnonzero(swing)
    chosen = slice(moving) if len(rows) == moving else rows
    if len(rows):
        sums.message[chosen] += swing[chosen, None] * flutter(receivers.place[chosen], time=time, seed=seed, yaw=yaw)
    return sums.message


def _bounded(message: Floats) -> Floats:
    """Return messages with their lengths clamped to 1."""
    index = np.sqrt(message[:, 0] * message[:, 0] + message[:, 1] * message[:, 1])
    message /= np.maximum(index, np.float32(1.0))[:, None]
    return message
