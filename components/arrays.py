"""Types of arrays in the whole package, by their contents."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float32]
"""The usual array, in the graphics card's precision."""

Doubles = NDArray[np.float64]
"""Values that need double precision: times, sums, and what is grown once."""

Ints = NDArray[np.int32]
"""Indices and cells, as the graphics card takes them."""

Indices = NDArray[np.intp]
"""Indices of rows, as numpy takes them."""

Rows = NDArray[np.int64]
"""Rows of the patch table, and entities."""

Levels = NDArray[np.int8]
"""Numbers of representations and sub-levels."""

Mask = NDArray[np.bool_]
"""Boolean selection of rows."""

Bytes = NDArray[np.uint8]
"""Bytes, and pictures in display colours."""

Place = tuple[float, float]
"""Place on the ground, (x, z) [m]."""

Point = tuple[float, float, float]
"""Point in the world, (x, y, z) [m]."""
