"""Layers of the overlay, which shows how a prairie works."""

from typing import Literal, get_args

Layer = Literal["masks", "arrows", "levels", "weights", "map"]
"""Masks of winds; messages of receivers; patches' representations; progress of their transitions; a map from above."""

LAYERS: tuple[Layer, ...] = get_args(Layer)


def parse_layers(text: str, /) -> frozenset[Layer]:
    """Parse layers written as `masks,arrows` or `all`; raise ValueError with a sentence about an unknown one."""
    words = [word.strip().lower() for word in text.split(",")]
    unknown = [word for word in words if word not in {*LAYERS, "all"}]
    if unknown:
        raise ValueError(f"{unknown[0]!r} is no part of the overlay; there are {', '.join(LAYERS)}, and all")
    return frozenset(part for part in LAYERS if part in words or "all" in words)
