"""The kinds of plant that there are: how the blades of each are laid out in a patch."""

from typing import Protocol

from ...engine.declared.grass import GrassKind, Plant
from .blades import grow_blades
from .record import Blades


class Sow(Protocol):
    """How a kind of plant becomes the blades of a patch model, from a seed alone."""

    def __call__(self, kind: GrassKind, /, *, count: int, patch: float, variants: int, seed: int) -> Blades:
        """Return `count` blades of a patch whose side is `patch` [m]; each takes its shapes from one of `variants`."""


PLANTS: dict[Plant, Sow] = {"grass": grow_blades}
"""By the name that scenes call it."""
