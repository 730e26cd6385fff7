"""Habits: proportions of trees, after Weber and Penn."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import pi, sqrt

from ...engine.declared.tree import HabitName


@dataclass(frozen=True, slots=True)
class Shoots:
    """Stems of a level on those that bear them (Weber and Penn, 1995, their parameters of a level)."""

    each: float
    """Stems per metre of what bears them; of limbs, on the whole trunk."""

    length: float
    """Length of the longest: limbs of the tree's height, branches of the limb's length, twigs in [m]."""

    down: tuple[float, float]
    """Angle from what bears them, at its foot and at its tip [rad]."""

    lift: float
    """Upward turn of a stem at each step, downward below 0: the share of "up" added to its direction."""

    crook: float
    """Random turn at each step, as a share of its direction."""


@dataclass(frozen=True, slots=True)
class Leaf:
    """The leaves of a twig."""

    form: int
    """Outline, an index that `leaf.glsl` draws."""

    length: float
    """Length of a blade without its stalk; of a pine, of its needles [m]."""

    width: float
    """Greatest width [m]."""

    count: int
    """Number on a twig."""

    shoots: int
    """Number of shoots that bear a twig's leaves: itself and its side shoots."""

    angle: float
    """Angle from the twig [rad]."""

    area: float
    """Area of a leaf, relative to its quad's."""

    @property
    def quads(self) -> int:
        """Number of quads of a twig drawn leaf by leaf: of its leaves, and of its shoots' stems."""
        return self.count + self.shoots

    def finer(self, times: float) -> "Leaf":
        """Return leaves `times` as small, on as many more shoots, each with as many more leaves.

        A twig without side shoots hangs: it gets as many more shoots as leaves, one below the other.
        """
        shoots = round(self.shoots * times) if self.shoots > 1 else round(times * times)
        count = round(self.count * times * times / shoots) * shoots
        return replace(self, length=self.length / times, width=self.width / times, count=count, shoots=shoots)


@dataclass(frozen=True, slots=True)
class Habit:
    """How trees of a sort grow."""

    slender: float
    """Diameter of the trunk near the ground, relative to the height."""

    bare: float
    """Part of the trunk that bears no limbs."""

    crown: tuple[float, ...]
    """Lengths of limbs at equal steps from the lowest to the highest, relative to the longest."""

    straight: float
    """Straightness of the trunk: 1 is a pole."""

    whorled: int
    """Number of limbs in a whorl around the trunk; 1 places them one by one at the golden angle."""

    limbs: Shoots
    branches: Shoots
    twigs: Shoots
    leaf: Leaf
    bark: tuple[str, str]
    """Colours of young bark, on thin stems, and of old (sRGB)."""

    ripens: tuple[float, float]
    """Radius of a stem on which bark begins to age, and on which it is old [m]."""

    rough: float
    """Depth of the bark's furrows, 0 to 1; below 0 it is smooth with dark bands across, as birches have."""

    leaves: tuple[str, str]
    """Colours of leaves, dark and bright (sRGB)."""

    height: tuple[float, float]
    """Range of heights of grown trees [m]."""


GOLDEN = pi * (3.0 - sqrt(5.0))
"""Golden angle between neighbours around a stem [rad]."""

OVATE, LOBED, LANCE, NEEDLES, DELTOID = range(5)
"""Outlines of leaves."""

GLSL = {
    "PI": pi, "GOLDEN": GOLDEN,
    "OVATE": OVATE, "LOBED": LOBED, "LANCE": LANCE, "NEEDLES": NEEDLES, "DELTOID": DELTOID,
}  # fmt: skip

HABITS: Mapping[HabitName, Habit] = {
    "oak": Habit(
        slender=0.055, bare=0.14, crown=(0.75, 1.0, 1.0, 0.9, 0.72, 0.5), straight=0.55, whorled=1,
        limbs=Shoots(24.0, 0.74, (1.4, 0.5), 0.03, 0.19),
        branches=Shoots(3.6, 0.52, (0.95, 0.7), 0.04, 0.2),
        twigs=Shoots(5.2, 0.72, (0.9, 0.7), 0.03, 0.1),
        leaf=Leaf(LOBED, 0.125, 0.075, 35, 5, 0.9, 0.62), bark=("#6f6a58", "#625a4e"), ripens=(0.03, 0.14), rough=0.9,
        leaves=("#3d5623", "#84a044"), height=(11.0, 16.0),
    ),
    "birch": Habit(
        slender=0.022, bare=0.2, crown=(0.62, 0.95, 1.0, 0.86, 0.62, 0.36), straight=0.9, whorled=1,
        limbs=Shoots(38.0, 0.28, (1.0, 0.5), 0.03, 0.06),
        branches=Shoots(4.4, 0.46, (0.85, 0.7), -0.06, 0.08),
        twigs=Shoots(9.0, 0.55, (0.8, 0.6), -0.25, 0.05),
        leaf=Leaf(OVATE, 0.06, 0.05, 33, 3, 0.95, 0.64), bark=("#6d5547", "#d8d3c8"), ripens=(0.018, 0.06), rough=-1.0,
        leaves=("#4d6e28", "#9ab44e"), height=(10.0, 16.0),
    ),
    "pine": Habit(
        slender=0.026, bare=0.34, crown=(0.8, 1.0, 0.9, 0.74, 0.55, 0.34, 0.1), straight=0.93, whorled=5,
        limbs=Shoots(45.0, 0.27, (1.62, 0.7), 0.05, 0.07),
        branches=Shoots(5.2, 0.42, (0.95, 0.7), 0.04, 0.06),
        twigs=Shoots(6.0, 0.55, (0.7, 0.5), 0.1, 0.04),
        leaf=Leaf(NEEDLES, 0.11, 0.06, 48, 3, 0.6, 0.24), bark=("#936d52", "#6c6259"), ripens=(0.07, 0.15), rough=0.7,
        leaves=("#223329", "#4f6349"), height=(12.0, 18.0),
    ),
    "poplar": Habit(
        slender=0.026, bare=0.05, crown=(0.72, 1.0, 1.0, 0.92, 0.8, 0.62), straight=0.97, whorled=1,
        limbs=Shoots(62.0, 0.21, (0.56, 0.3), 0.085, 0.05),
        branches=Shoots(4.6, 0.42, (0.65, 0.5), 0.09, 0.06),
        twigs=Shoots(6.0, 0.5, (0.7, 0.55), 0.06, 0.05),
        leaf=Leaf(DELTOID, 0.068, 0.064, 24, 3, 0.9, 0.58), bark=("#86826f", "#67635a"), ripens=(0.04, 0.14), rough=0.6,
        leaves=("#3c5a22", "#85a046"), height=(15.0, 22.0),
    ),
    "willow": Habit(
        slender=0.055, bare=0.16, crown=(0.72, 0.95, 1.0, 0.96, 0.8, 0.6), straight=0.6, whorled=1,
        limbs=Shoots(20.0, 0.58, (1.05, 0.4), 0.05, 0.12),
        branches=Shoots(4.2, 0.62, (0.9, 0.7), -0.24, 0.08),
        twigs=Shoots(7.0, 0.95, (0.8, 0.5), -0.6, 0.04),
        leaf=Leaf(LANCE, 0.13, 0.028, 40, 1, 0.55, 0.6), bark=("#80794f", "#716b60"), ripens=(0.02, 0.1), rough=0.85,
        leaves=("#55703a", "#a5b478"), height=(9.0, 13.0),
    ),
    "hawthorn": Habit(
        slender=0.035, bare=0.01, crown=(1.0, 1.0, 0.98, 0.9, 0.75, 0.5), straight=0.35, whorled=1,
        limbs=Shoots(26.0, 0.82, (1.5, 0.6), 0.02, 0.16),
        branches=Shoots(7.0, 0.5, (0.95, 0.75), 0.03, 0.18),
        twigs=Shoots(11.0, 0.36, (0.9, 0.7), 0.03, 0.14),
        leaf=Leaf(LOBED, 0.055, 0.046, 30, 5, 0.9, 0.6), bark=("#665a4a", "#635c53"), ripens=(0.015, 0.06), rough=0.6,
        leaves=("#3c5a24", "#7f9c42"), height=(3.0, 4.6),
    ),
}  # fmt: skip
"""Habits by the names that scenes use. Proportions are read off grown trees that stand free; leaves are those of
*Quercus robur*, *Betula pendula*, *Pinus sylvestris*, *Populus nigra*, *Salix alba* and *Crataegus monogyna*."""
