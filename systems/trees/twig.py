"""The texture of a model's twigs, and its lookup in GLSL."""

import numpy as np

from ...engine.gl.emit import emitted, record_lookup
from .habit import Habit

TWIG = np.dtype(
    [
        ("foot", "3f4"), ("span", "f4"),  # [m]
        ("along", "3f4"), ("grouped", "f4"),  # the twig at this place of the blocks
        ("face", "3f4"), ("limb", "f4"),  # random number of its limb, 0 to 1
        ("pivot", "3f4"), ("hertz", "f4"),  # foot of its limb [m], and its frequency
        ("shading", "4f4"),  # optical depth outwards, linear in direction
    ]
)  # fmt: skip
"""A twig. After a model's twigs come its limbs, whose `limb`, `pivot` and `hertz` alone are read, for their wood."""

BLOCK = 64
"""Twigs that are drawn together on their cards, as many as a wave of a graphics card has lanes."""

ROW = 64
"""Records in a row of their texture."""

RANKS = 12.0
"""Steepness of a twig's shrinking by rank before it is left out: 1 would spread it over all ranks."""

LEAST_KEPT = 0.04
"""Least share of twigs that is drawn."""

LEAF_PIXELS = 14.0, 22.0
"""Length of a leaf from which on twigs begin to be drawn leaf by leaf, and from which on all are [pixels]."""

BEHIND = 0.5
"""Depth behind the soft edges of leaves that must be clear for them to be drawn, in twig lengths: what is nearer
has their colour. Thin stems among leaves lie as far behind."""

SHOOTS_OFF, SHOOTS_LONG = 0.85, 0.62
"""Angle of side shoots from their twig [rad]; length of the longest, relative to the twig's."""

HANGING_OFF = 0.3
"""Angle between twigs that hang side by side, where a card shows several without side shoots [rad]."""

PICTURES, FINER_EACH = 3, 1.6
"""Number of a twig's pictures, and ratio of leaf sizes from each to the next."""

TWIGS_EACH = FINER_EACH**2
"""Number of twigs that a picture stands for, relative to the one before: the distance between leaves is in proportion
to their size. If leaves were denser, a near tree's cards would look like plates."""

LEAF_TONES = 0.25, 0.75
"""Least tone of a leaf, and its range."""

MEAN_TONE = LEAF_TONES[0] + 0.5 * LEAF_TONES[1]
"""Mean tone of leaves."""

ASIDE, TURNED, BACK, ON = 0.95, 0.25, 0.3, 1.2
"""Reach of leaves from their twig, in leaf lengths: aside, by the sine of their angle plus `TURNED`, as that varies;
back from its foot; on from its tip."""

SHOOTS_ASIDE, HANGING_ASIDE = 0.7, 0.35
"""Reach of side shoots aside, and of shoots that hang side by side, relative to the longest one's length."""

GLSL = record_lookup("Twig", TWIG, "tree_twigs", ROW) + emitted(
    {
        "RANKS": RANKS, "LEAST_KEPT": LEAST_KEPT,
        "LEAF_TONES": LEAF_TONES, "SHOOTS_LONG": SHOOTS_LONG, "PICTURES": PICTURES, "TWIGS_EACH": TWIGS_EACH,
    }
)  # fmt: skip


def card_reach(habit: Habit, /) -> tuple[float, float, float]:
    """Return how far a twig's card reaches to either side, and from where to where along it [usual length of a twig].

    Its foot is at 0.
    """
    leaf, length = habit.leaf, habit.twigs.length
    wide = ASIDE * leaf.length * (np.sin(leaf.angle) + TURNED)
    wide += SHOOTS_LONG * length * (SHOOTS_ASIDE if leaf.shoots > 1 else HANGING_ASIDE)
    return float(wide / length), -BACK * leaf.length / length, 1.0 + ON * leaf.length / length
