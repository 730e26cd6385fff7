"""The pictures of a tree from all around, which stand for it far off (Forsyth, Impostors: Adding Clutter, 2001)."""

from math import radians

COLUMNS, ROWS = 12, 3
"""Pictures all around, and from how many elevations."""

FIRST_ROW, EACH_ROW = radians(4.0), radians(38.0)
"""Elevation of the lowest ones, and how much higher each row is [rad]."""

SIDE = 128
"""Pixels of a picture across and up."""

FINER = 2
"""Each is the mean of so many by so many pixels."""

TILE_EDGE = 0.5 / SIDE
"""What of a picture is its neighbours' at its edge."""

FINER_BY = -0.6
"""Level at which one is shown, from that of its pixels: it is read between texels, which blurs it."""

THICKEST = 0.6
"""Radius of a stem that a picture's texel of 255 stands for [m]."""

GLSL = {
    "COLUMNS": COLUMNS, "ROWS": ROWS, "FIRST_ROW": FIRST_ROW, "EACH_ROW": EACH_ROW, "TILE_EDGE": TILE_EDGE,
    "SIDE": SIDE, "FINER_BY": FINER_BY, "THICKEST": THICKEST,
}  # fmt: skip
