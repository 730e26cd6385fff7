"""What shaders are told of each twig of a model, and how they find it."""

import numpy as np

from ...engine.gl.emit import emitted, record_lookup

TWIG = np.dtype(
    [
        ("foot", "3f4"), ("span", "f4"),  # [m]
        ("along", "3f4"), ("limb", "f4"),  # what sets its limb apart from others, 0 to 1
        ("face", "3f4"), ("hertz", "f4"),  # frequency of its limb
        ("pivot", "3f4"), ("orders", "f4"),  # foot of its limb [m]; which twig has this one's number in other orders
        ("shading", "4f4"),  # how many leaves light meets on its way, by direction and in the mean
    ]
)  # fmt: skip

ORDERS = 4096
"""More than a tree has twigs: their order along x plus so many times that along z is a number that a float holds."""

ROW = 64
"""Records in a row of their texture."""

RANKS = 12.0
"""How steeply a twig dwindles by its rank before it is left out: 1 would be over all ranks."""

LEAST_KEPT = 0.04
"""Share of twigs that is drawn at least."""

LEAF_PIXELS = 14.0, 22.0
"""Length of a leaf from which on twigs begin to be drawn leaf by leaf, and from which all are [pixels]."""

BEHIND = 0.5
"""How far behind them leaves must have nothing for their soft edges to be drawn, of their twig's length: what is
nearer is of their colour. And so far behind leaves are thin stems among them."""

SHOOTS_OFF, SHOOTS_LONG = 0.85, 0.62
"""Angle of side shoots from their twig [rad]; length of the longest, of the twig's."""

HANGING_OFF = 0.3
"""That angle of twigs that hang side by side, where a card stands for several of those without side shoots [rad]."""

PICTURES, FINER_EACH = 3, 1.6
"""Pictures of a twig's card, and how many times as small leaves are on each as on the one before."""

TWIGS_EACH = FINER_EACH**2
"""How many times as many twigs each stands for: leaves are as far apart, of how large they are. Were they any closer
together, cards of a tree near by would be seen as plates."""

GLSL = record_lookup("Twig", TWIG, "tree_twigs", ROW) + emitted(
    {
        "ORDERS": ORDERS, "RANKS": RANKS, "LEAST_KEPT": LEAST_KEPT,
        "SHOOTS_LONG": SHOOTS_LONG, "PICTURES": PICTURES, "TWIGS_EACH": TWIGS_EACH,
    }
)  # fmt: skip
