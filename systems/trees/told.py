"""What shaders are told of a model and of its kind in a few vectors: each number by itself would cost as much."""

from collections.abc import Mapping

import numpy as np

MODEL = np.dtype(
    [
        ("dark", "3f4"), ("tall", "f4"),  # pigments of leaves; height [m]
        ("bright", "3f4"), ("slim", "f4"),  # how many times as high as wide its pictures are
        ("bark", "3f4"), ("rough", "f4"),  # pigment of old bark; how deeply it is furrowed, below 0 it has bands across
        ("young_bark", "3f4"), ("column", "f4"),  # in a row of trees, from one to the next [m]
        # Radius of a stem on which bark begins to be as on old ones [m], and 1 by how much thicker those are on which
        # it is [1/m]; how high the middle of its pictures is, and half their height [m].
        ("ripens", "2f4"), ("ball", "2f4"),
    ]
)  # fmt: skip
"""What they are told of a model."""

NAME = "of_model"
"""By which name they are told that."""


def vectors(numbers: Mapping[str, tuple[float, ...]], /) -> list[tuple[float, ...]]:
    """Return the vectors that tell numbers of a model, by name."""
    record = np.zeros(1, MODEL)
    for name in MODEL.names or ():
        record[name] = numbers[name] if len(numbers[name]) > 1 else numbers[name][0]
    return [tuple(each) for each in record.view(np.float32).reshape(-1, 4).tolist()]


def _declared() -> str:
    """Return GLSL that has each of them by its name."""
    lines, at = [f"uniform vec4 {NAME}[{MODEL.itemsize // 16}];\n"], 0
    for name in MODEL.names or ():
        count = MODEL[name].itemsize // 4
        vector, first = divmod(at, 4)
        kind, part = "float" if count == 1 else f"vec{count}", "xyzw"[first : first + count]
        lines.append(f"{kind} {name} = {NAME}[{vector}].{part};\n")
        at += count
    return "".join(lines)


GLSL = _declared()
