"""Parameters of a model and its kind, packed into a few vectors: each uniform costs as much as a vector."""

from collections.abc import Mapping

import numpy as np

RECORD = np.dtype(
    [
        ("dark", "3f4"), ("tall", "f4"),  # pigments of leaves, dark and bright; height [m]
        ("bright", "3f4"), ("aspect", "f4"),  # height of its pictures, of their width
        ("bark", "3f4"), ("rough", "f4"),  # pigment of old bark; depth of its furrows, or below 0 bands across
        ("young_bark", "3f4"), ("column", "f4"),  # distance between trees in a row [m]
        # Radius from which on a stem's bark ages [m], and 1 over the further radius until it is old [1/m].
        # Height of the middle of its pictures, and half their height [m].
        ("ripens", "2f4"), ("picture_span", "2f4"),
        ("stem_least", "4f4"), ("stem_range", "4f4"),  # as in bark.py
        ("most_shading", "2f4"), ("twig_length", "f4"), ("leaf_length", "f4"),  # usual lengths of a twig and a leaf [m]
    ]
)  # fmt: skip
"""Parameters of a model and its kind."""

NAME = "parameters"
"""Name of the uniform array."""


def vectors(numbers: Mapping[str, tuple[float, ...]], /) -> list[tuple[float, ...]]:
    """Return the vectors of a model's parameters, given by name."""
    record = np.zeros(1, RECORD)
    for name in RECORD.names or ():
        record[name] = numbers[name] if len(numbers[name]) > 1 else numbers[name][0]
    return [tuple(each) for each in record.view(np.float32).reshape(-1, 4).tolist()]


def _declared() -> str:
    """Return GLSL that declares the vectors and names each parameter in them."""
    lines, offset = [f"uniform vec4 {NAME}[{RECORD.itemsize // 16}];\n"], 0
    for name in RECORD.names or ():
        count = RECORD[name].itemsize // 4
        vector, first = divmod(offset, 4)
        kind, part = "float" if count == 1 else f"vec{count}", "xyzw"[first : first + count]
        lines.append(f"{kind} {name} = {NAME}[{vector}].{part};\n")
        offset += count
    return "".join(lines)


GLSL = _declared()
