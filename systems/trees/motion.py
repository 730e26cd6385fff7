"""Motion of trees in the wind: trunk, limbs and leaves, each with a frequency of its own."""

from math import exp, sqrt, tau

PERIOD = 1000.0
"""Period after which all motion repeats [s]: a long game's time stays as exact as its first."""

TRUNK_LEANS, TRUNK_SWINGS = 0.035, 0.022
"""Displacement of a trunk's top by a message of 1, and amplitude of its swing about that, relative to its height."""

LIMB_LEANS, LIMB_SWINGS = 0.09, 0.05
"""Displacement of a limb's tip by a message of 1, and amplitude of its swing, relative to its length."""

LIMB_STIFF = 1.6
"""Length at which a limb bends half as much as a long one [m]."""

LEAF_TURNS = 0.5
"""Amplitude of leaves' rotation in a message of 1 [rad]."""

AIR_FADES = 0.38, 0.48
"""Distances from the viewer between which patches' messages fade to their mean, relative to the side of all patches."""

TRUNK_HERTZ, LIMB_HERTZ, LEAF_HERTZ = (0.2, 0.5), (1.0, 3.0), (3.0, 10.0)
"""Ranges of the frequencies of trunks, limbs and leaves, with all their tones [Hz]."""

TRUNK_ACROSS, LIMB_ACROSS = 1.06, 1.13
"""Frequency of trunks and limbs across the wind, relative to that along it."""

TRUNK_SIDEWAYS, LIMB_SIDEWAYS = 0.5, 0.7
"""Amplitude of trunks and limbs across the wind, relative to that along it."""

FLUTTERS = 0.4, 0.25
"""Displacement of a twig's tip out of its face and aside, relative to its length and its leaves' rotation."""

LOAD_AT_END = 3.0
"""Of a cantilever bent by a load at its end, whose line is (3 x² - x³) / 2."""

SKY_FROM = 0.5
"""Mean sine of the elevation that skylight comes from."""

SKY_MEETS_LESS = 0.65
"""Effective optical depth of leaves for skylight, relative to their own: much of it is scattered from leaf to leaf."""

OWN_CROWN = 0.6
"""Greatest reach of a tree's own crown towards the sun, relative to its height: up to there, its depth is its own."""

TONES, TONES_APART = (0.92, 1.1), (1.0, 1.7)
"""Frequencies of a swing's two tones, relative to its own; their phases, as multiples of its random number [turns]."""

CROWN_BENDS = 0.5
"""Displacement of a crown's middle, relative to the top's: it is at two thirds of the height of a cantilever."""


def own_hertz(ends: tuple[float, float], across: float = 1.0, /) -> tuple[float, float]:
    """Return the range of a swing's own frequency whose tones, also `across` the wind, stay within `ends` [Hz]."""
    return ends[0] / TONES[0], ends[1] / (TONES[1] * across)


GLSL = {
    "AROUND": tau, "PERIOD": PERIOD, "TONES": TONES, "TONES_APART": TONES_APART,
    "TRUNK_LEANS": TRUNK_LEANS, "TRUNK_SWINGS": TRUNK_SWINGS,
    "LIMB_LEANS": LIMB_LEANS, "LIMB_SWINGS": LIMB_SWINGS, "LIMB_STIFF": LIMB_STIFF,
    "LEAF_TURNS": LEAF_TURNS, "LEAF_HERTZ": own_hertz(LEAF_HERTZ), "AIR_FADES": AIR_FADES,
    "TRUNK_ACROSS": TRUNK_ACROSS, "LIMB_ACROSS": LIMB_ACROSS,
    "TRUNK_SIDEWAYS": TRUNK_SIDEWAYS, "LIMB_SIDEWAYS": LIMB_SIDEWAYS,
    "FLUTTERS": FLUTTERS, "LOAD_AT_END": LOAD_AT_END,
    "SKY_FROM": SKY_FROM, "SKY_MEETS_LESS": SKY_MEETS_LESS, "OWN_CROWN": OWN_CROWN,
}  # fmt: skip


def trunk_hertz(height: float, diameter: float, /) -> float:
    """Return the frequency at which a tree of a height [m] and a diameter [m] swings [Hz].

    It is that of 602 trees of eight species (Moore and Maguire, Natural Sway Frequencies and Damping Ratios of Trees,
    2004) where low, and nears the upper end of `TRUNK_HERTZ` where high: those trees stood in forests, and a stout
    trunk that stands free has a heavier crown.
    """
    low, high = own_hertz(TRUNK_HERTZ, TRUNK_ACROSS)
    found = max(0.0948 + 3.4063 * (100.0 * diameter) / height**2, low)
    return high - (high - low) * exp((low - found) / (high - low))


def tones(hertz: float, time: float, /) -> tuple[float, float]:
    """Return the phases of a swing's two tones at a time [s], in turns, as `swing` of `tree.glsl` computes them."""
    first, second = (round(hertz * tone * PERIOD) / PERIOD * (time % PERIOD) % 1.0 for tone in TONES)
    return first, second


def limb_hertz(length: float, /) -> float:
    """Return the frequency of a limb of a length [m]: 2 Hz at 2 m [Hz].

    The radius of a stem is proportional to the power 3/2 of its length, and so its frequency to the inverse root
    (McMahon and Kronauer, Tree Structures: Deducing the Principle of Mechanical Design, 1976).
    """
    low, high = own_hertz(LIMB_HERTZ, LIMB_ACROSS)
    return min(max(2.0 * sqrt(2.0 / max(length, 0.1)), low), high)
