"""Plants other than blades of grass: stems, leaves and heads, grown from where blades would stand."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...engine.declared.grass import GrassKind
from ...engine.declared.plant import Plant
from .blades import grow_blades, let_hang, wither
from .heads import grow_heads
from .layout import HABITS, Layout
from .organs import FROND, LEAF, SPRIG, STEM
from .postures import hanging_of
from .record import Blades
from .rows import GOLDEN, Rows, Stems, stand_organs, to_blades

_STEM_WIDTH = 0.006
"""Width of a stem, relative to its length."""

_WOODY = 2.0
"""Factor on the width of shrubs' stems."""

_LEAST_STEM_WIDTH = 0.003


def grow_patch(kind: GrassKind, layout: Layout, /, *, patch: float, variants: int, seed: int) -> Blades:
    """Return the rows of one patch model of a kind, `patch` metres wide, from a seed.

    Each plant grows from a blade of grass: it has the blade's root and rank, and its stem the blade's height and lean.
    The rows of a plant have the same root and rank and follow one another: of each branch the stem first, the head
    last.
    """
    stand = grow_blades(kind, count=layout.plants, patch=patch, variants=variants, seed=seed)
    leaves = stand
    if kind.plant == "grass":
        leaves = let_hang(stand, kind, patch=patch, variants=variants, seed=seed)
    if kind.withered:
        leaves = wither(leaves, kind.withered, seed=seed)
    if kind.plant == "grass" and kind.head is None:
        return leaves
    random = np.random.default_rng([seed, 0x706C616E])
    return to_blades(stand, *_parts(kind, layout, stand, leaves, variants, random))


def _parts(
    kind: GrassKind, layout: Layout, stand: Blades, leaves: Blades, variants: int, random: np.random.Generator, /
) -> list[Rows]:
    """Return the blades, stems, leaves and heads of a patch model."""
    due = np.arange(layout.plants + 1) * layout.bearing // layout.plants
    bears = np.diff(due) > 0  # of any number of first plants the same share
    if kind.plant == "grass":
        culms = _culms(kind, stand, np.flatnonzero(bears))
        parts = [_blade_rows(leaves, np.flatnonzero(~bears)), _stem_rows(kind, culms)]
    else:
        stems = _GROW_STEMS[kind.plant](kind, layout, stand, random)
        parts = [_stem_rows(kind, stems), _leaf_rows(kind, layout, stems, variants - hanging_of(variants), random)]
        culms = stems.take(np.flatnonzero(bears[stems.plant]))
    if kind.head is not None:
        arched = min(variants - hanging_of(variants), variants - 1)
        parts += grow_heads(kind.head, layout, culms, random, arched=arched)
    return parts


def _stems_of(stand: Blades, plant: NDArray[np.intp], /) -> Stems:
    """Return one stem for each of some plants (m,), with the height and the lean of its blade."""
    branch = np.zeros(len(plant), np.intp)
    return Stems(plant, branch, stand.height[plant].astype(np.float64), stand.rest[plant].astype(np.float64))


def _culms(kind: GrassKind, stand: Blades, plant: NDArray[np.intp], /) -> Stems:
    """Return the stems of grasses that bear heads (m,): they rise above the leaves and lean less."""
    stems = _stems_of(stand, plant)
    return Stems(plant, stems.branch, 0.5 * (stems.height + kind.height[1]), 0.6 * stems.rest)


def _single(_kind: GrassKind, layout: Layout, stand: Blades, _random: np.random.Generator, /) -> Stems:
    """Return one stem for each plant."""
    return _stems_of(stand, np.arange(layout.plants))


def _branched(kind: GrassKind, layout: Layout, stand: Blades, random: np.random.Generator, /) -> Stems:
    """Return the branches of shrubs: they lean outwards in all directions; those that lean farther are shorter."""
    count = layout.plants, layout.branches
    out = (np.arange(layout.branches) + random.uniform(0.2, 0.9, count)) / layout.branches
    toward = stand.facing[:, None] + GOLDEN * np.arange(layout.branches) + random.normal(0.0, 0.3, count)
    lean = kind.lean * np.sqrt(out)
    height = stand.height[:, None] * (1.0 - 0.3 * out) * random.uniform(0.85, 1.0, count)
    rest = lean[..., None] * np.stack([np.cos(toward), np.sin(toward)], axis=-1)
    plant, branch = np.indices(count).reshape(2, -1)
    return Stems(plant, branch, height.reshape(-1), rest.reshape(-1, 2))


_GROW_STEMS: Mapping[Plant, Callable[[GrassKind, Layout, Blades, np.random.Generator], Stems]] = {
    "flower": _single,
    "forb": _single,
    "shrub": _branched,
}
"""Function that grows the stems of each sort of plant."""


def _blade_rows(stand: Blades, plant: NDArray[np.intp], /) -> Rows:
    """Return the rows of plants that are single blades."""
    return Rows(
        plant=plant, branch=np.zeros(len(plant), np.intp),
        height=stand.height[plant], width=stand.width[plant], facing=stand.facing[plant],
        rest=stand.rest[plant], variant=stand.variant[plant],
        organ=np.broadcast_to(stand.organ, stand.height.shape)[plant],
        stem=np.zeros(len(plant)), part=np.ones(len(plant)), stem_rest=np.zeros((len(plant), 2)),
    )  # fmt: skip


def _stem_rows(kind: GrassKind, stems: Stems, /) -> Rows:
    """Return the rows of the stems themselves."""
    count = len(stems.plant)
    width = np.maximum(_STEM_WIDTH * stems.height, _LEAST_STEM_WIDTH) * (_WOODY if kind.plant == "shrub" else 1.0)
    return Rows(
        plant=stems.plant, branch=stems.branch, height=stems.height, width=width, facing=GOLDEN * np.arange(count),
        rest=stems.rest, variant=np.zeros(count, np.int32), organ=np.full(count, STEM, np.int32), stem=np.zeros(count),
        part=np.ones(count), stem_rest=np.zeros((count, 2)),
    )  # fmt: skip


@dataclass(frozen=True, slots=True)
class _Foliage:
    """Arrangement of leaves on a stem."""

    up_to: float
    """Fraction of the stem that bears leaves, from the ground on."""

    shrinks: float
    """Fraction by which the highest leaf is shorter than the lowest."""

    spread: tuple[float, float]
    """Least and largest posture index of leaves at rest."""


_FOLIAGE: Mapping[Plant, _Foliage] = {
    "flower": _Foliage(0.3, 0.3, (0.5, 0.95)),
    "forb": _Foliage(0.95, 0.55, (0.5, 0.85)),
    "shrub": _Foliage(0.65, 0.2, (0.15, 0.7)),
}


def _leaf_rows(kind: GrassKind, layout: Layout, stems: Stems, variants: int, random: np.random.Generator, /) -> Rows:
    """Return the leaves of stems, at golden angles round each."""
    foliage, count = _FOLIAGE[kind.plant], (len(stems.plant), layout.leaves)
    place = (np.arange(layout.leaves) + random.uniform(0.0, 0.8, count)) / max(layout.leaves, 1)
    if kind.leaf is None:
        length = HABITS[kind.plant].leaf * stems.height[:, None] * random.uniform(0.75, 1.1, count)
    else:
        short, long = kind.leaf
        length = random.uniform(short, long, count)
    toward = random.uniform(-np.pi, np.pi, (count[0], 1)) + GOLDEN * np.arange(layout.leaves)
    organ = FROND if kind.head is None else SPRIG if kind.plant == "shrub" else LEAF
    return stand_organs(
        stems, organ, part=foliage.up_to * place,
        height=length * (1.0 - foliage.shrinks * place), width=kind.width * random.uniform(0.75, 1.15, count),
        toward=toward, spread=random.uniform(*foliage.spread, count),
        variant=random.integers(0, variants, count, dtype=np.int32),
    )  # fmt: skip
