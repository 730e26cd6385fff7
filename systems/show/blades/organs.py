"""What shaders are told of organs, where a scene has plants other than grass."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ...grow.organs import BLADE, GIVES, KNOTS, ORGANS, TONES, WIDTHS
from .pool import ORGAN


def organ_defines(record: np.dtype[np.void], /) -> Mapping[str, str | int]:
    """Return what shaders need to draw records of `ORGAN`: the table of organs; nothing for those of `BLADE`."""
    if record != ORGAN:
        return {}
    return {
        "ORGANS": len(ORGANS),
        "KNOTS": KNOTS,
        "BLADE_ITSELF": BLADE,
        "TONES": _literal("vec2", [f"vec2({_listed(row)})" for row in TONES]),
        "GIVES": _literal("float", [_listed(GIVES)]),
        "WIDTHS": _literal("float", [_listed(WIDTHS.reshape(-1))]),
    }


def _literal(kind: str, values: list[str]) -> str:
    return f"{kind}[]({', '.join(values)})"


def _listed(values: NDArray[np.float64]) -> str:
    return ", ".join(f"{value:.6f}" for value in values.tolist())
