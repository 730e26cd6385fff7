"""The table of organs as defines of shaders, for scenes with plants other than grass."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ...grow.organs import AT_TIPS, BLADE, DYED, GIVES, KNOTS, LEAVES, LIGULES, ORGANS, TEETH, TONES, WIDTHS
from ...grow.record import Growth
from .pool import ORGAN


def organ_defines(record: np.dtype[np.void], /) -> Mapping[str, str | int]:
    """Return the defines of shaders that draw `record`: the table of organs for `ORGAN`, nothing for `BLADE`."""
    if record != ORGAN:
        return {}
    return {
        "ORGANS": len(ORGANS),
        "KNOTS": KNOTS,
        "BLADE_ITSELF": BLADE,
        "AT_TIPS": _bit_set(AT_TIPS),
        "LEAVES": _bit_set(LEAVES),
        "TONES": _array("vec2", [f"vec2({_listed(row)})" for row in TONES]),
        "DYED": _array("vec2", [f"vec2({_listed(row)})" for row in DYED]),
        "GIVES": _array("float", [_listed(GIVES)]),
        "WIDTHS": _array("float", [_listed(WIDTHS.reshape(-1))]),
        "TEETH": _array("float", [_listed(TEETH)]),
        "LIGULES": _array("float", [_listed(LIGULES)]),
    }


def any_with(counts: NDArray[np.int64], growths: Sequence[Growth], /) -> bool:
    """Return whether any kind has an organ whose count, of `TEETH` or `LIGULES`, is above 0."""
    return any(counts[model.blades.organ].any() for growth in growths for model in growth.models)


def _bit_set(organs: Sequence[int]) -> int:
    return sum(1 << organ for organ in organs)


def _array(kind: str, values: list[str]) -> str:
    return f"{kind}[]({', '.join(values)})"


def _listed(values: NDArray[np.float64]) -> str:
    return ", ".join(f"{value:.6f}" for value in values.tolist())
