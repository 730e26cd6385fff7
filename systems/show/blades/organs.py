"""What shaders are told of organs, where a scene has plants other than grass."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ...grow.organs import AT_TIPS, BLADE, DYED, GIVES, KNOTS, LEAVES, LIGULES, ORGANS, TEETH, TONES, WIDTHS
from ...grow.record import Growth
from .pool import ORGAN


def organ_defines(record: np.dtype[np.void], /) -> Mapping[str, str | int]:
    """Return what shaders need to draw records of `ORGAN`: the table of organs; nothing for those of `BLADE`."""
    if record != ORGAN:
        return {}
    return {
        "ORGANS": len(ORGANS),
        "KNOTS": KNOTS,
        "BLADE_ITSELF": BLADE,
        "AT_TIPS": _bits(AT_TIPS),
        "LEAVES": _bits(LEAVES),
        "TONES": _literal("vec2", [f"vec2({_listed(row)})" for row in TONES]),
        "DYED": _literal("vec2", [f"vec2({_listed(row)})" for row in DYED]),
        "GIVES": _literal("float", [_listed(GIVES)]),
        "WIDTHS": _literal("float", [_listed(WIDTHS.reshape(-1))]),
        "TEETH": _literal("float", [_listed(TEETH)]),
        "LIGULES": _literal("float", [_listed(LIGULES)]),
    }


def any_teeth(growths: Sequence[Growth], /) -> bool:
    """Return whether any kind has organs with teeth along their sides, or slits between narrow petals."""
    return any((TEETH + LIGULES)[model.blades.organ].any() for growth in growths for model in growth.models)


def _bits(organs: Sequence[int]) -> int:
    return sum(1 << organ for organ in organs)


def _literal(kind: str, values: list[str]) -> str:
    return f"{kind}[]({', '.join(values)})"


def _listed(values: NDArray[np.float64]) -> str:
    return ", ".join(f"{value:.6f}" for value in values.tolist())
