"""The pictures of a tree from all around, which stand for it far off (Forsyth, Impostors: Adding Clutter, 2001)."""

from math import log2, radians

COLUMNS, ROWS = 12, 3
"""Pictures all around, and from how many elevations."""

FIRST_ROW, EACH_ROW = radians(4.0), radians(38.0)
"""Elevation of the lowest ones, and how much higher each row is [rad]."""

LINES = 256
"""Texels of a picture up: as many as there are pixels where it begins to be drawn so. Of a broad tree, it is as high as
that is broad, from above."""

COARSER = 2
"""How many times as large texels are of how light has come to what a picture shows: that changes from twig to twig."""

FINER = 2
"""Each texel is the mean of so many by so many pixels."""

LEVELS = 5
"""Sizes of a picture that are kept, each half the one before: coarser ones would mix neighbours."""

TILE_EDGE = 0.5
"""What of a picture is its neighbours' at its edge [texels of the size that is read]."""

FINER_BY = -0.5 * log2(3.0)
"""Level at which one is shown, from that of its pixels: there it is as blurred as by the mean over a pixel.

Across, that has a variance of 1/12 of a pixel's square. Texels are means over themselves, and are read between: of a
texel's square, the first has 1/12 and the second 1/6."""

CAST_COARSER = 0.5 * log2(2.0)
"""How many levels more it is in the map that says what it shades.

That is read between its texels, which has twice the variance of the mean over one. As light falls off exponentially
with the leaves that it meets, what shades is a mean as broad as that already, of how much leaves cover."""

THICKEST = 0.6
"""Radius of a stem that a picture's texel of 255 stands for [m]."""

GLSL = {
    "COLUMNS": COLUMNS, "ROWS": ROWS, "FIRST_ROW": FIRST_ROW, "EACH_ROW": EACH_ROW, "TILE_EDGE": TILE_EDGE,
    "LEVELS": LEVELS, "COARSER": COARSER, "FINER_BY": FINER_BY, "CAST_COARSER": CAST_COARSER, "THICKEST": THICKEST,
}  # fmt: skip
