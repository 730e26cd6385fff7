"""Pictures of a tree from all around, which stand for it far off (Forsyth, Impostors: Adding Clutter, 2001)."""

from math import log2, radians

COLUMNS, ROWS = 12, 3
"""Number of azimuths and of elevations of pictures."""

FIRST_ROW, EACH_ROW = radians(4.0), radians(38.0)
"""Elevation of the lowest pictures, and step from row to row [rad]."""

LINES = 256
"""Height of a picture [texels]: as many as pixels where it begins to show. A broad tree's is as high as it is broad,
from above."""

COARSER = 2
"""Texel size of optical depths, relative to the pictures': depths change from twig to twig."""

FINER = 2
"""Supersampling: each texel is the mean of so many by so many pixels."""

LEVELS = 5
"""Number of mip levels: coarser ones would mix neighbours."""

TILE_EDGE = 0.5
"""Half a texel of the level that is read: within it of an edge, a neighbour's would be interpolated [texels]."""

LEVEL_BIAS = -0.5 * log2(3.0)
"""Bias of the mip level, so that a picture is as blurred as by the mean over a pixel.

Across, that mean has a variance of 1/12 of a pixel's square. A texel is a mean over itself, with 1/12 of a texel's
square, and linear interpolation adds 1/6."""

CAST_LEVEL_BIAS = 0.5 * log2(2.0)
"""Bias of the mip level in shade maps.

They are interpolated, with twice the variance of a texel's mean. As light falls off exponentially with optical depth,
the mean of the depths is already as broad as that."""

THICKEST = 0.6
"""Radius of a stem that a texel value of 255 stands for [m]."""

GLSL = {
    "COLUMNS": COLUMNS, "ROWS": ROWS, "FIRST_ROW": FIRST_ROW, "EACH_ROW": EACH_ROW,
    "TILE_EDGE": TILE_EDGE, "LEVELS": LEVELS, "COARSER": COARSER, "THICKEST": THICKEST,
    "LEVEL_BIAS": LEVEL_BIAS, "CAST_LEVEL_BIAS": CAST_LEVEL_BIAS,
}  # fmt: skip
