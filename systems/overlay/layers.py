"""Overlays: what can be laid over a prairie to show how it works."""

from typing import Literal, get_args

Layer = Literal["masks", "arrows", "levels", "weights", "map"]
"""Where winds act; what receivers feel; which representation a patch has; how far it is changing; all from above."""

LAYERS: tuple[Layer, ...] = get_args(Layer)


def parse_layers(text: str, /) -> frozenset[Layer]:
    """Return the parts written as `masks,arrows` or `all`; raises ValueError with a sentence about what is none."""
    words = [word.strip().lower() for word in text.split(",")]
    unknown = [word for word in words if word not in {*LAYERS, "all"}]
    if unknown:
        raise ValueError(f"{unknown[0]!r} is no part of the overlay; there are {', '.join(LAYERS)}, and all")
    return frozenset(part for part in LAYERS if part in words or "all" in words)
