"""The heads of plants: petals round a point, florets along a stem, rays of an umbel, and plumes."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles
from ...engine.declared.plant import SIZES, Head, HeadForm
from .layout import Layout, has_few_petals
from .organs import BLOTCHED, BUD, CAPSULE, DISC, EYE, FLORETS, PETAL, RAY, STAMENS, STRAP, TUFT, TWIN
from .rows import GOLDEN, Rows, Stems, stand_organs

Whorl = tuple[float, float]

DISC_OF_FEW: tuple[Whorl, ...] = ((0.8, 1.0),)
DISC_OF_MANY: tuple[Whorl, ...] = ((0.97, 1.0), (0.8, 0.88), (0.5, 0.62))
BELL: tuple[Whorl, ...] = ((0.42, 1.0),)
ROUND_A_DISC: tuple[Whorl, ...] = ((0.97, 1.0), (0.9, 0.94))
"""Whorls of petals from the outermost on: posture index of the petals, and their length relative to the longest."""

_REACH = 0.8
"""Horizontal reach of a petal of posture index 1, relative to its length."""

_OVERLAP, _OVERLAP_OF_MANY = 1.7, 1.35
"""Width of all petals of a whorl, relative to the circle half-way along them; many petals leave gaps."""

_WIDEST = 1.25
"""Largest width of a petal, relative to its length."""

_OPENS, _OPENS_OF_MANY = (0.45, 1.04), (0.8, 0.97)
"""Posture index of petals, relative to their whorl's, in an opening flower and in one about to drop them. Heads of
many petals open in a morning and are flat for days."""

_YOUNG = 0.85
"""Length of petals that have just opened, relative to full-grown ones."""

_TILTS = 0.4
"""Largest posture index at which heads lean aside, each in its own direction."""

_NODS = 0.5, 0.9
"""Least and largest posture index of the buds of flowers with few petals, which nod as those of poppies."""

_SEEDS = 0.45
"""Fraction of the closed heads that have dropped their petals and set seed; the others are buds."""

_DROPS, _DROPPED = 0.8, 0.4
"""Fraction of its time after which a flower with few petals sheds them; fraction of the petals gone then."""

_STUB = 0.12
"""Length of the stub of a shed petal, relative to the petal."""

_EYE = 0.36
"""Width of a head's eye, relative to the head's."""

_DOME = 0.9, 1.3
"""Posture index of a disc's florets, and their width relative to one that closes the circle."""

_BELOW_DISC = 0.32
"""Depth of petals' feet below their disc, relative to their length: they rise before they lie, and would hide it."""

_STAMENS = 0.6, 0.7
"""Posture index of stamens about a capsule; their width relative to one that closes the circle half-way along."""

_CAPSULE = 0.3, 0.2
"""Length and width of a capsule, relative to the longest petal's length."""

_UMBEL_OPENS = 0.6
"""Reach of the rays of an opening umbel, relative to those of an old one."""

_SPIKE = 0.165
"""Area of a spike's florets, relative to the square of its length."""

_TOP_LEANS = 1.25
"""Lean of a stem's top, relative to that of the whole stem: it bends towards its tip."""


def grow_heads(
    head: Head, layout: Layout, stems: Stems, random: np.random.Generator, /, *, arched: int
) -> tuple[Rows, ...]:
    """Return the heads of stems: `layout.petals` rows and `layout.middles` for each, open or closed.

    `arched` is the posture variant that arches over.
    """
    low, high = head.size or SIZES[head.form]
    size = random.uniform(low, high, len(stems.plant))
    if head.eye is not None:
        return _eyed(head, layout, stems, size, random, arched)
    if head.form in _FORMS:
        return (_FORMS[head.form](head, layout, stems, size, random),)
    return _cup(head, layout, stems, size, random)


@dataclass(frozen=True, slots=True)
class _Ages:
    """Ages of heads, shape (m, 1) each: buds, flowers and seed stand side by side."""

    shut: NDArray[np.bool_]
    """Whether the head is closed."""

    seeds: NDArray[np.bool_]
    """Whether the head is closed because it has set seed."""

    open_part: Doubles
    """Fraction of its time that an open head has been open."""


def _ages(head: Head, count: int, random: np.random.Generator, /) -> _Ages:
    """Return random ages of `count` heads."""
    shut = random.random((count, 1)) >= head.open
    return _Ages(shut, shut & (random.random((count, 1)) < _SEEDS), random.random((count, 1)))


def _random_tilt(count: int, random: np.random.Generator, /, *, nods: NDArray[np.bool_] | None = None) -> Doubles:
    """Return random leans of heads, shape (m, 2); those of the mask `nods` (m, 1) hang down."""
    tilt, azimuth = random.uniform(0.0, _TILTS, count), random.uniform(-np.pi, np.pi, count)
    if nods is not None:
        tilt = np.where(nods[:, 0], random.uniform(*_NODS, count), tilt)
    return np.asarray(tilt[:, None] * np.stack([np.cos(azimuth), np.sin(azimuth)], axis=1))


@dataclass(frozen=True, slots=True)
class _Cup:
    """The petals of discs and bells, and the measures that place their middles."""

    petals: Rows
    ages: _Ages
    longest: Doubles
    """Length of the longest petal of each head [m], shape (m, 1)."""

    first_azimuth: Doubles
    """Azimuth of the first petal of each head [rad], shape (m, 1)."""

    tilt: Doubles
    """Lean of each head, shape (m, 2)."""


def _cup(head: Head, layout: Layout, stems: Stems, size: Doubles, random: np.random.Generator, /) -> tuple[Rows, Rows]:
    """Return discs and bells: whorls of petals round a middle, slightly tilted; buds are closed and green."""
    few = has_few_petals(head.form, layout.petals)
    whorls = BELL if head.form == "bell" else DISC_OF_FEW if few else DISC_OF_MANY
    cup = _grow_cup(head, layout, stems, size, random, whorls=whorls, petal=PETAL if few else STRAP)
    middle = stand_organs(
        stems, np.where(cup.ages.shut, BUD, EYE if few else STRAP), part=1.0, height=0.36 * cup.longest,
        width=0.22 * cup.longest, toward=cup.first_azimuth, spread=0.05, tilt=cup.tilt,
    )  # fmt: skip
    return cup.petals, middle


def _eyed(
    head: Head, layout: Layout, stems: Stems, size: Doubles, random: np.random.Generator, arched: int, /
) -> tuple[Rows, ...]:
    """Return discs and bells with an eye: few petals stand about stamens and a capsule, many lie about a disc.

    The eye comes last: where blades are drawn in order, without depth, it covers its petals.
    """
    few = has_few_petals(head.form, layout.petals)
    whorls = BELL if head.form == "bell" else DISC_OF_FEW if few else ROUND_A_DISC
    below = 0.0 if few else _BELOW_DISC
    cup = _grow_cup(
        head, layout, stems, size, random, whorls=whorls, petal=BLOTCHED if few else TWIN, below=below
    )  # fmt: skip
    if few:
        return cup.petals, *_stamens(cup, layout.middles, stems, size)
    return cup.petals, _disc(cup, layout.middles, stems, size, arched)


def _disc(cup: _Cup, count: int, stems: Stems, size: Doubles, arched: int, /) -> Rows:
    """Return domes of florets; closed heads have green, shorter ones, and a capsule in place of the first."""
    spread, wide = _DOME
    length = np.repeat(_EYE * size[:, None] / (2.0 * _REACH * spread), count, axis=1)
    shut = np.broadcast_to(cup.ages.shut, length.shape)
    organ = np.where(shut, np.where(np.arange(count) == 0, CAPSULE, BUD), DISC)
    return stand_organs(
        stems, organ, part=1.0, height=np.where(shut, 0.6, 1.0) * length,
        width=np.where(shut, 0.3, 2.0 * wide * _REACH * spread * np.tan(np.pi / count)) * length,
        toward=cup.first_azimuth + 2.0 * np.pi / count * np.arange(count), spread=np.where(shut, 0.05, spread),
        tilt=cup.tilt, variant=np.where(shut, 0, arched),
    )  # fmt: skip


def _stamens(cup: _Cup, count: int, stems: Stems, size: Doubles, /) -> tuple[Rows, Rows]:
    """Return stamens, and capsules among them; buds hide them."""
    (spread, wide), count = _STAMENS, count - 1
    length = np.repeat(_EYE * size[:, None] / (2.0 * _REACH * spread), count, axis=1)
    stamens = stand_organs(
        stems, np.where(cup.ages.shut, BUD, STAMENS), part=1.0, height=np.where(cup.ages.shut, 0.6, 1.0) * length,
        width=np.where(cup.ages.shut, 0.2, wide * np.pi * spread / count) * length,
        toward=cup.first_azimuth + 2.0 * np.pi / count * np.arange(count), spread=np.where(cup.ages.shut, 0.05, spread),
        tilt=cup.tilt,
    )  # fmt: skip
    high, across = _CAPSULE
    capsule = stand_organs(
        stems, CAPSULE, part=1.0, height=high * cup.longest, width=across * cup.longest, toward=cup.first_azimuth,
        spread=0.05, tilt=cup.tilt,
    )  # fmt: skip
    return stamens, capsule


def _grow_cup(
    head: Head, layout: Layout, stems: Stems, size: Doubles, random: np.random.Generator, /, *,
    whorls: tuple[Whorl, ...], petal: int, below: float = 0.0,
) -> _Cup:  # fmt: skip
    """Return heads of whorls; petals begin `below` the tips of their stems, relative to the longest petal."""
    count, few = layout.petals, len(whorls) == 1
    ages = _ages(head, len(size), random)
    whorl, in_whorl, azimuth = _spread_over(count, whorls)
    spread, length = np.array(whorls)[whorl].T
    longest = (size / (2.0 * _REACH * max(spread)))[:, None]
    long = _petals(longest * length, ages, random, drops=few)
    wide = np.minimum((_OVERLAP if few else _OVERLAP_OF_MANY) * np.pi * spread * long / in_whorl, _WIDEST * long)
    toward = random.uniform(-np.pi, np.pi, (len(size), 1)) + azimuth
    opens = np.interp(np.sqrt(ages.open_part), (0.0, 1.0), _OPENS if few else _OPENS_OF_MANY)
    opens = opens * random.uniform(0.85, 1.1, toward.shape)
    tilt = _random_tilt(len(size), random, nods=ages.shut & ~ages.seeds if few else None)
    bud = longest * np.where(ages.seeds, 0.5, random.uniform(0.5, 0.74, ages.shut.shape))
    part = 1.0 - below * longest / stems.height[:, None] if below else 1.0
    petals = stand_organs(
        stems, np.where(ages.shut, BUD, petal), part=part, height=np.where(ages.shut, bud, long),
        width=np.where(ages.shut, 0.34 * longest, wide), toward=toward + random.normal(0.0, 0.15, toward.shape),
        spread=np.where(ages.shut, 0.12, spread * opens), tilt=tilt,
    )  # fmt: skip
    return _Cup(petals, ages, longest, toward[:, :1], tilt)


def _spread_over(count: int, whorls: tuple[Whorl, ...], /) -> tuple[NDArray[np.intp], NDArray[np.intp], Doubles]:
    """Return the whorl of each of `count` petals, the number of petals in that whorl, and its azimuth [rad], (count,).

    Longer circles get more petals, so that all are about as wide.
    """
    circle = np.array(whorls).prod(axis=1)
    ends = np.rint(count * circle.cumsum() / circle.sum()).astype(np.intp)
    sizes = np.diff(ends, prepend=0)
    whorl = np.repeat(np.arange(len(whorls)), sizes)
    in_whorl = sizes[whorl]
    return whorl, in_whorl, 2.0 * np.pi * (np.arange(count) - (ends - sizes)[whorl] + 0.5 * whorl) / in_whorl


def _petals(longest: Doubles, ages: _Ages, random: np.random.Generator, /, *, drops: bool) -> Doubles:
    """Return the lengths of open heads' petals, (m, petals): they grow while they open, and old ones are shed."""
    length = longest * np.interp(ages.open_part, (0.0, 0.5), (_YOUNG, 1.0)) * random.uniform(0.86, 1.08, longest.shape)
    gone = drops & (ages.open_part > _DROPS) & (random.random(longest.shape) < _DROPPED)
    return np.asarray(np.where(gone, _STUB * length, length))


def _spike(head: Head, layout: Layout, stems: Stems, size: Doubles, random: np.random.Generator, /) -> Rows:
    """Return florets along the tops of stems, smaller to the tip, where they are still in bud.

    They lean as the top of their stem, and cover it all round: the fewer they are, the longer.
    """
    up, toward = _along(layout, stems, random)
    longest = 0.1 + 1.4 / layout.petals
    length = longest * size[:, None] * (1.0 - 0.45 * up) * random.uniform(0.85, 1.15, up.shape)
    wide = _SPIKE / (longest * layout.petals) * size[:, None] * (1.0 - 0.4 * up) * random.uniform(0.8, 1.2, up.shape)
    shut = up > head.open + random.uniform(-0.15, 0.15, (len(size), 1))
    return stand_organs(
        stems, np.where(shut, BUD, FLORETS), part=_part(stems, size, up), height=np.where(shut, 0.7 * length, length),
        width=np.where(shut, 0.6, 1.0) * wide, toward=toward, tilt=_TOP_LEANS * stems.rest,
        spread=np.where(shut, 0.12, 0.28 - 0.12 * up) * random.uniform(0.6, 1.3, up.shape),
    )  # fmt: skip


def _plume(head: Head, layout: Layout, stems: Stems, size: Doubles, random: np.random.Generator, /) -> Rows:
    """Return tufts along the tops of stems, which hang over to the side to which the stem leans."""
    up, _ = _along(layout, stems, random)
    shut = random.random((len(size), 1)) >= head.open
    lean = np.arctan2(stems.rest[:, 1], stems.rest[:, 0])[:, None]
    length = size[:, None] * (0.62 - 0.3 * up) * random.uniform(0.8, 1.15, up.shape)
    return stand_organs(
        stems, TUFT, part=_part(stems, size, up), height=length, width=np.where(shut, 0.05, 0.08) * length,
        toward=lean + random.normal(0.0, 0.9, up.shape),
        spread=np.where(shut, 0.15, random.uniform(0.3, 0.8, up.shape)),
    )  # fmt: skip


def _umbel(head: Head, layout: Layout, stems: Stems, size: Doubles, random: np.random.Generator, /) -> Rows:
    """Return rays from the tops of stems, spread as evenly as the seeds of a sunflower; young umbels are domes.

    They are bundled in bud, and as a nest when they set seed.
    """
    count, ages = layout.petals, _ages(head, len(size), random)
    out = np.sqrt((np.arange(count) + 0.5) / count)
    ray = (size / (2.0 * _REACH))[:, None] * random.uniform(0.85, 1.1, (len(size), count))
    toward = random.uniform(-np.pi, np.pi, (len(size), 1)) + GOLDEN * np.arange(count)
    toward += random.normal(0.0, 0.1, toward.shape)
    opens = np.interp(np.sqrt(ages.open_part), (0.0, 1.0), (_UMBEL_OPENS, 1.0))
    nests = np.where(ages.seeds, 0.85, 0.5)
    return stand_organs(
        stems, np.where(ages.shut, BUD, RAY), part=1.0, height=np.where(ages.shut, nests, 1.0) * ray,
        width=np.where(ages.shut, 0.12, 1.15 / np.sqrt(count)) * ray, toward=toward,
        spread=np.where(ages.shut, np.where(ages.seeds, 0.4, 0.2), 0.98 * opens) * out,
        tilt=_random_tilt(len(size), random),
    )  # fmt: skip


_FORMS: Mapping[HeadForm, Callable[[Head, Layout, Stems, Doubles, np.random.Generator], Rows]] = {
    "spike": _spike,
    "umbel": _umbel,
    "plume": _plume,
}


def _along(layout: Layout, stems: Stems, random: np.random.Generator, /) -> tuple[Doubles, Doubles]:
    """Return the places of florets along a head, from 0 to 1, and their azimuths [rad], shape (m, petals) each."""
    count = len(stems.plant), layout.petals
    up = (np.arange(layout.petals) + random.uniform(0.1, 0.9, count)) / layout.petals
    return up, random.uniform(-np.pi, np.pi, (count[0], 1)) + GOLDEN * np.arange(layout.petals)


def _part(stems: Stems, size: Doubles, up: Doubles, /) -> Doubles:
    """Return the places along stems of points at places `up` (m, petals) along heads of lengths `size` (m,)."""
    return np.asarray(np.maximum(1.0 - (size / stems.height)[:, None] * (1.0 - up), 0.0))
