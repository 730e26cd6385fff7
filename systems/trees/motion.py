"""How trees move in the wind: a trunk, limbs on it, and leaves on those, each with a frequency of its own."""

from math import exp, sqrt, tau

PERIOD = 1000.0
"""After which all motion begins again [s]: then frames of a long game are as exact as its first."""

TRUNK_LEANS, TRUNK_SWINGS = 0.035, 0.022
"""How far the top of a trunk is blown aside by a message of 1, of its height; and how far it swings about that."""

LIMB_LEANS, LIMB_SWINGS = 0.09, 0.05
"""The same of a limb, of its length."""

LIMB_STIFF = 1.6
"""Length at which a limb gives way half as much as a long one does [m]."""

LEAF_TURNS = 0.5
"""Angle that leaves turn to either side in a message of 1 [rad]."""

AIR_FADES = 0.38, 0.48
"""How far from the viewer what patches hear gives way to its mean, of the side of all patches around."""

TRUNK_HERTZ, LIMB_HERTZ, LEAF_HERTZ = (0.2, 0.5), (1.0, 3.0), (3.0, 10.0)
"""Between which frequencies trunks, limbs and leaves swing, with all their tones [Hz]."""

TRUNK_ACROSS, LIMB_ACROSS = 1.06, 1.13
"""How many times as fast trunks and limbs swing across the wind as along it."""

SKY_FROM = 0.5
"""Mean sine of the elevation that the sky's light comes from."""

SKY_MEETS_LESS = 0.65
"""How many leaves the light of the sky meets, of those that stand before it: much of it goes on from leaf to leaf."""

OWN_CROWN = 0.6
"""How far towards the sun a tree's own crown goes on at most, of its height: up to there, it counts by itself."""

TONES, TONES_APART = (0.92, 1.1), (1.0, 1.7)
"""Frequencies of the two tones of a swing, of its own; how many turns they go on from one that swings to another."""

CROWN_BENDS = 0.5
"""How far the middle of a crown goes aside, of a tree's top: it is at two thirds of the height of a cantilever."""


def own_hertz(ends: tuple[float, float], across: float = 1.0, /) -> tuple[float, float]:
    """Return between which frequencies a swing may be whose tones, across the wind too, are between `ends` [Hz]."""
    return ends[0] / TONES[0], ends[1] / (TONES[1] * across)


GLSL = {
    "AROUND": tau, "PERIOD": PERIOD, "TONES": TONES, "TONES_APART": TONES_APART,
    "TRUNK_LEANS": TRUNK_LEANS, "TRUNK_SWINGS": TRUNK_SWINGS,
    "LIMB_LEANS": LIMB_LEANS, "LIMB_SWINGS": LIMB_SWINGS, "LIMB_STIFF": LIMB_STIFF,
    "LEAF_TURNS": LEAF_TURNS, "LEAF_HERTZ": own_hertz(LEAF_HERTZ), "AIR_FADES": AIR_FADES,
    "TRUNK_ACROSS": TRUNK_ACROSS, "LIMB_ACROSS": LIMB_ACROSS,
    "SKY_FROM": SKY_FROM, "SKY_MEETS_LESS": SKY_MEETS_LESS, "OWN_CROWN": OWN_CROWN,
}  # fmt: skip


def trunk_hertz(height: float, diameter: float, /) -> float:
    """Return the frequency at which a tree of a height [m] and a diameter [m] swings [Hz].

    It is that of 602 trees of eight species (Moore and Maguire, Natural Sway Frequencies and Damping Ratios of Trees,
    2004) where that is low, and nears the highest of `TRUNK_HERTZ` where it is high: those stood in forests, and the
    stouter a trunk is that stands free, the heavier is its crown.
    """
    low, high = own_hertz(TRUNK_HERTZ, TRUNK_ACROSS)
    found = max(0.0948 + 3.4063 * (100.0 * diameter) / height**2, low)
    return high - (high - low) * exp((low - found) / (high - low))


def tones(hertz: float, time: float, /) -> tuple[float, float]:
    """Return where the two tones of a swing are at a time [s], in turns, as `swing` of `tree.glsl` has them."""
    first, second = (round(hertz * tone * PERIOD) / PERIOD * (time % PERIOD) % 1.0 for tone in TONES)
    return first, second


def limb_hertz(length: float, /) -> float:
    """Return that of a limb of a length [m], from 2 Hz at 2 m [Hz].

    Stems are as thick as the power 3/2 of their length, so they swing as its root has it the other way (McMahon and
    Kronauer, Tree Structures: Deducing the Principle of Mechanical Design, 1976).
    """
    low, high = own_hertz(LIMB_HERTZ, LIMB_ACROSS)
    return min(max(2.0 * sqrt(2.0 / max(length, 0.1)), low), high)
