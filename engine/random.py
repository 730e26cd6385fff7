"""Counter-based random numbers: hashes of a seed and integers, without state.

`engine/shaders/lib/random.glsl` has the same functions; both give the same bits.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

UInts = NDArray[np.uint32]

_GOLDEN = np.uint32(0x9E3779B9)
_FIRST = np.uint32(0x7FEB352D)
_SECOND = np.uint32(0x846CA68B)


def scramble(value: ArrayLike, /) -> UInts:
    """Return the hash of each 32-bit number; it is a permutation of all 32-bit numbers.

    `value` holds integers of any sign and shape; of wider ones only the low 32 bits count. Zero is not a fixed point.
    Multipliers and shifts are those of Wellons' search for integer hashes of low bias ("lowbias32").
    """
    x = _word(value)
    with np.errstate(over="ignore"):
        x = x + _GOLDEN
        x = (x ^ (x >> np.uint32(16))) * _FIRST
        x = (x ^ (x >> np.uint32(15))) * _SECOND
        return np.asarray(x ^ (x >> np.uint32(16)), np.uint32)


def hash3(seed: int, a: ArrayLike, b: ArrayLike, /) -> UInts:
    """Return the hash of a seed and each (a, b), for example a cell.

    `a` and `b` are integers of any sign that broadcast against each other; the result has their common shape.
    """
    return scramble(_word(b) ^ scramble(_word(a) ^ scramble(seed)))


def stream(hashed: ArrayLike, number: int, /) -> UInts:
    """Return further random numbers from hashes, independent for each `number`; same shape as `hashed`."""
    return scramble(_word(hashed) ^ scramble(number))


def unit(hashed: UInts, /) -> NDArray[np.float32]:
    """Return 32-bit numbers as fractions in [0, 1): multiples of 2^-24, so that float32 holds them exactly."""
    return np.asarray(hashed >> np.uint32(8), np.float32) * np.float32(2.0**-24)


def _word(value: ArrayLike) -> UInts:
    return np.asarray(value).astype(np.uint32)
