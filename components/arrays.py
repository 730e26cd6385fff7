"""The types of arrays that the whole house speaks of, by what they hold."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float32]
"""What the graphics card takes, and all that is the same there: the usual array."""

Doubles = NDArray[np.float64]
"""What single precision would spoil: times, sums, and what is grown once."""

Ints = NDArray[np.int32]
"""Numbers and cells, as the graphics card takes them."""

Rows = NDArray[np.int64]
"""Rows of the patch table, and entities."""

Levels = NDArray[np.int8]
"""Representations and sub-levels, by number."""

Mask = NDArray[np.bool_]
"""For each row, whether it is meant."""

Bytes = NDArray[np.uint8]
"""Bytes, and pictures in display colours."""
