"""The heads of plants: petals round a point, florets along a stem, rays, and plumes."""

from collections.abc import Callable, Mapping
from dataclasses import fields

import numpy as np

from ...components.arrays import Doubles
from ...engine.declared.plant import SIZES, Head, HeadForm
from .layout import Layout
from .organs import BUD, EYE, FLORETS, PETAL, RAY, TUFT
from .rows import GOLDEN, Rows, Stems, stood

Whorl = tuple[float, float]

DISC_OF_FEW: tuple[Whorl, ...] = ((0.8, 1.0),)
DISC_OF_MANY: tuple[Whorl, ...] = ((0.97, 1.0), (0.8, 0.88), (0.5, 0.62))
BELL: tuple[Whorl, ...] = ((0.42, 1.0),)
"""Whorls of petals from the outermost: the posture index at which petals stand, and their length, of the longest."""

MANY = 9
"""Petals from which on a disc has several whorls, as a dandelion."""

_REACH = 0.8
"""How far a petal of posture index 1 reaches out from its root, as a part of its length."""

_OVERLAP = 1.6
_WIDEST = 1.15
"""Largest width of a petal, as a part of its length."""

_SPIKE = 0.165
"""Area of a spike's florets, of the square of its length."""

_TOP_LEANS = 1.25
"""How much more the top of a stem leans than all of it: it bends towards its tip."""


def grow_heads(head: Head, layout: Layout, stems: Stems, random: np.random.Generator, /) -> Rows:
    """Return the heads of stems: `layout.petals` rows and `layout.middles` for each, whether open or in bud."""
    low, high = head.size or SIZES[head.form]
    size = random.uniform(low, high, len(stems.plant))
    return _FORMS[head.form](head, layout, stems, size, random)


def _cup(head: Head, layout: Layout, stems: Stems, size: Doubles, random: np.random.Generator, /) -> Rows:
    """Return discs and bells: whorls of petals round a middle, a little askew; in bud they are closed and green."""
    count = layout.petals
    whorls = BELL if head.form == "bell" else DISC_OF_MANY if count >= MANY else DISC_OF_FEW
    own = np.arange(count) % len(whorls)
    spread, length = np.array(whorls)[own].T
    beside = np.bincount(own)[own]
    shut = random.random((len(size), 1)) >= head.open
    longest = (size / (2.0 * _REACH * max(spread)))[:, None]
    petal = longest * length * random.uniform(0.88, 1.08, (len(size), count))
    wide = np.minimum(_OVERLAP * 2.0 * np.pi * 0.5 * spread * petal / beside, _WIDEST * petal)
    turned = random.uniform(-np.pi, np.pi, (len(size), 1)) + 2.0 * np.pi * np.arange(count) / count
    tilt, twist = random.uniform(0.0, 0.3, len(size)), random.uniform(-np.pi, np.pi, len(size))
    askew = tilt[:, None] * np.stack([np.cos(twist), np.sin(twist)], axis=1)
    petals = stood(
        stems, np.where(shut, BUD, PETAL), part=1.0, height=np.where(shut, 0.62 * longest, petal),
        width=np.where(shut, 0.34 * longest, wide), toward=turned + random.normal(0.0, 0.1, turned.shape),
        spread=np.where(shut, 0.12, spread * random.uniform(0.85, 1.1, turned.shape)), tilt=askew,
    )  # fmt: skip
    middle = stood(
        stems, np.where(shut, BUD, PETAL if len(whorls) > 1 else EYE), part=1.0, height=0.36 * longest,
        width=0.22 * longest, toward=turned[:, :1], spread=0.05, tilt=askew,
    )  # fmt: skip
    return _both(petals, middle)


def _spike(head: Head, layout: Layout, stems: Stems, size: Doubles, random: np.random.Generator, /) -> Rows:
    """Return florets along the tops of stems, smaller to the tip, where they are still in bud.

    They lean as the top of their stem does, and cover it all round, however few they are: the fewer, the longer.
    """
    up, toward = _along(layout, stems, random)
    longest = 0.1 + 1.4 / layout.petals
    length = longest * size[:, None] * (1.0 - 0.45 * up) * random.uniform(0.85, 1.15, up.shape)
    wide = _SPIKE / (longest * layout.petals) * size[:, None] * (1.0 - 0.4 * up) * random.uniform(0.8, 1.2, up.shape)
    shut = up > head.open + random.uniform(-0.15, 0.15, (len(size), 1))
    return stood(
        stems, np.where(shut, BUD, FLORETS), part=_part(stems, size, up), height=np.where(shut, 0.7 * length, length),
        width=np.where(shut, 0.6, 1.0) * wide, toward=toward, tilt=_TOP_LEANS * stems.rest,
        spread=np.where(shut, 0.12, 0.28 - 0.12 * up) * random.uniform(0.6, 1.3, up.shape),
    )  # fmt: skip


def _plume(head: Head, layout: Layout, stems: Stems, size: Doubles, random: np.random.Generator, /) -> Rows:
    """Return tufts along the tops of stems, that hang over to the side to which the stem leans."""
    up, _ = _along(layout, stems, random)
    shut = random.random((len(size), 1)) >= head.open
    lean = np.arctan2(stems.rest[:, 1], stems.rest[:, 0])[:, None]
    length = size[:, None] * (0.62 - 0.3 * up) * random.uniform(0.8, 1.15, up.shape)
    return stood(
        stems, TUFT, part=_part(stems, size, up), height=length, width=np.where(shut, 0.05, 0.08) * length,
        toward=lean + random.normal(0.0, 0.9, up.shape),
        spread=np.where(shut, 0.15, random.uniform(0.3, 0.8, up.shape)),
    )  # fmt: skip


def _umbel(head: Head, layout: Layout, stems: Stems, size: Doubles, random: np.random.Generator, /) -> Rows:
    """Return rays from the tops of stems, spread as evenly as seeds of a sunflower; in bud they stand together."""
    count = layout.petals
    shut = random.random((len(size), 1)) >= head.open
    out = np.sqrt((np.arange(count) + 0.5) / count)
    ray = (size / (2.0 * _REACH))[:, None] * random.uniform(0.92, 1.06, (len(size), count))
    toward = random.uniform(-np.pi, np.pi, (len(size), 1)) + GOLDEN * np.arange(count)
    return stood(
        stems, np.where(shut, BUD, RAY), part=1.0, height=np.where(shut, 0.5, 1.0) * ray,
        width=np.where(shut, 0.12, 1.15 / np.sqrt(count)) * ray, toward=toward,
        spread=np.where(shut, 0.2, 0.98) * out,
    )  # fmt: skip


_FORMS: Mapping[HeadForm, Callable[[Head, Layout, Stems, Doubles, np.random.Generator], Rows]] = {
    "disc": _cup,
    "bell": _cup,
    "spike": _spike,
    "umbel": _umbel,
    "plume": _plume,
}


def _along(layout: Layout, stems: Stems, random: np.random.Generator, /) -> tuple[Doubles, Doubles]:
    """Return where florets are on the way up a head, from 0 to 1, and the azimuth of each, shape (m, petals)."""
    count = len(stems.plant), layout.petals
    up = (np.arange(layout.petals) + random.uniform(0.1, 0.9, count)) / layout.petals
    return up, random.uniform(-np.pi, np.pi, (count[0], 1)) + GOLDEN * np.arange(layout.petals)


def _part(stems: Stems, size: Doubles, up: Doubles, /) -> Doubles:
    """Return the place along its stem of what is `up` (m, petals) of the way along a head of length `size` (m,)."""
    return np.asarray(np.maximum(1.0 - (size / stems.height)[:, None] * (1.0 - up), 0.0))


def _both(petals: Rows, middle: Rows, /) -> Rows:
    """Return the rows of both, one after another."""
    names = [field.name for field in fields(Rows)]
    return Rows(**{name: np.concatenate([getattr(petals, name), getattr(middle, name)]) for name in names})
