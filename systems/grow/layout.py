"""Layout of a patch model: numbers of plants, stems, leaves and organs of heads at a quality."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import sqrt

from ...engine.declared.grass import GrassKind
from ...engine.declared.plant import PETALS, Head, HeadForm, Plant
from ...engine.declared.quality import Quality

FULL = 500
"""Blades per patch of the quality at which plants have all their petals and leaves."""

FEWEST = 0.5
"""Fraction of these at the coarsest quality."""


@dataclass(frozen=True, slots=True)
class Habit:
    """Defaults of a sort of plant."""

    plants: float
    """Number of plants per square metre at full density."""

    branches: int
    """Number of stems of a plant."""

    leaves: int
    """Number of leaves of a stem."""

    leaf: float
    """Length of a leaf, relative to the height of its plant."""

    heads: int = 1
    """Number of heads that share the petals of one, as they are small."""


HABITS: Mapping[Plant, Habit] = {
    "grass": Habit(0.0, 1, 0, 0.0),
    "flower": Habit(8.0, 1, 3, 0.45),
    "forb": Habit(8.0, 1, 8, 0.4),
    "shrub": Habit(5.0, 6, 3, 0.3, 2),
}
"""Defaults of each sort of plant."""

MIDDLES: Mapping[HeadForm, int] = {"disc": 1, "bell": 1, "spike": 0, "umbel": 0, "plume": 0}
"""Number of organs of a head beside its petals, by its form."""

MANY = 9
"""Number of petals from which on a disc has several whorls, as a dandelion."""

_STAMENS, _DISC = (3, 2), (5, 3)
"""Number of organs of an eye of its own colour, at full quality and at least: with few petals, and with many."""


@dataclass(frozen=True, slots=True)
class Layout:
    """Numbers of plants and organs of a patch model."""

    plants: int
    bearing: int
    """Number of plants that bear heads."""

    branches: int
    """Number of stems of each plant; all of them bear a head if the plant does."""

    leaves: int
    """Number of leaves of each stem."""

    petals: int
    """Number of petals of each head, 0 without heads."""

    middles: int
    """Number of organs of each head beside its petals."""

    @property
    def rows(self) -> int:
        """Number of rows of a patch model."""
        stems = self.plants * self.branches * (1 + self.leaves)
        return stems + self.bearing * self.branches * (self.petals + self.middles)


def layout_of(kind: GrassKind, quality: Quality, /) -> Layout:
    """Return the layout of a kind at a quality.

    At a coarser quality grass has fewer blades. Other plants are as many, but have fewer petals and leaves.
    """
    habit = HABITS[kind.plant]
    fraction = min(max(sqrt(quality.blades / FULL), FEWEST), 1.0)
    plants = max(round(habit.plants * quality.patch**2), 1) if kind.plants is None else kind.plants
    if kind.plant == "grass":
        plants = quality.blades if kind.blades is None else kind.blades
    leaves = habit.leaves if kind.leaves is None else kind.leaves
    layout = Layout(plants, 0, habit.branches, round(leaves * fraction), 0, 0)
    if kind.head is None:
        return layout
    petals = max(round((kind.head.petals or max(PETALS[kind.head.form] // habit.heads, 3)) * fraction), 3)
    return Layout(
        plants, max(int(plants * kind.head.share), 1), habit.branches, layout.leaves, petals,
        _middles(kind.head, petals, fraction),
    )  # fmt: skip


def has_few_petals(form: HeadForm, petals: int, /) -> bool:
    """Return whether a head has one whorl of petals, as a poppy, and not several, as a dandelion."""
    return form == "bell" or petals < MANY


def _middles(head: Head, petals: int, fraction: float) -> int:
    """Return the number of organs of a head beside its petals."""
    if head.eye is None:
        return MIDDLES[head.form]
    most, least = _STAMENS if has_few_petals(head.form, petals) else _DISC
    return max(round(most * fraction), least)
