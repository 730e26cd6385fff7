"""How many rows a plant has: what is grown of it at a quality."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import sqrt

from ...engine.declared.grass import GrassKind
from ...engine.declared.plant import PETALS, Head, HeadForm, Plant
from ...engine.declared.quality import Quality

FULL = 500
"""Blades per patch of the quality at which plants have all their petals and leaves."""

FEWEST = 0.5
"""Part of these that is left at the coarsest."""


@dataclass(frozen=True, slots=True)
class Habit:
    """What goes without saying of a kind of plant."""

    plants: float
    """Plants on a square metre at full density."""

    branches: int
    """Stems of one plant."""

    leaves: int
    """Leaves of one stem."""

    leaf: float
    """Length of a leaf, as a part of its plant's height."""

    heads: int = 1
    """Heads that share the petals of one, as they are small."""


HABITS: Mapping[Plant, Habit] = {
    "grass": Habit(0.0, 1, 0, 0.0),
    "flower": Habit(8.0, 1, 3, 0.45),
    "forb": Habit(8.0, 1, 8, 0.4),
    "shrub": Habit(5.0, 6, 3, 0.3, 2),
}
"""By plant."""

MIDDLES: Mapping[HeadForm, int] = {"disc": 1, "bell": 1, "spike": 0, "umbel": 0, "plume": 0}
"""Rows of a head beside its petals."""

MANY = 9
"""Petals from which on a disc has several whorls, as a dandelion."""

_STAMENS, _DISC = (3, 2), (5, 3)
"""The same of one with an eye of a colour of its own: at full quality and at least, with few petals and with many."""


@dataclass(frozen=True, slots=True)
class Layout:
    """What the rows of a patch model are."""

    plants: int
    bearing: int
    """Plants that bear heads."""

    branches: int
    """Stems of each plant, all of which bear a head if it does."""

    leaves: int
    """Leaves of each stem."""

    petals: int
    """Petals of each head, 0 where there are none."""

    middles: int
    """Rows of each head beside its petals."""

    @property
    def rows(self) -> int:
        """How many rows a patch model has."""
        stems = self.plants * self.branches * (1 + self.leaves)
        return stems + self.bearing * self.branches * (self.petals + self.middles)


def layout_of(kind: GrassKind, quality: Quality, /) -> Layout:
    """Return what is grown of a kind on a patch: at a coarser quality no plant goes, but some petals and leaves do."""
    habit = HABITS[kind.plant]
    part = min(max(sqrt(quality.blades / FULL), FEWEST), 1.0)
    plants = max(round(habit.plants * quality.patch**2), 1) if kind.plants is None else kind.plants
    if kind.plant == "grass":
        plants = quality.blades if kind.blades is None else kind.blades
    leaves = habit.leaves if kind.leaves is None else kind.leaves
    layout = Layout(plants, 0, habit.branches, round(leaves * part), 0, 0)
    if kind.head is None:
        return layout
    petals = max(round((kind.head.petals or max(PETALS[kind.head.form] // habit.heads, 3)) * part), 3)
    return Layout(
        plants, max(int(plants * kind.head.share), 1), habit.branches, layout.leaves, petals,
        _middles(kind.head, petals, part),
    )  # fmt: skip


def has_few_petals(form: HeadForm, petals: int, /) -> bool:
    """Return whether petals stand as those of a poppy do, and not as a dandelion's."""
    return form == "bell" or petals < MANY


def _middles(head: Head, petals: int, part: float) -> int:
    if head.eye is None:
        return MIDDLES[head.form]
    most, least = _STAMENS if has_few_petals(head.form, petals) else _DISC
    return max(round(most * part), least)
