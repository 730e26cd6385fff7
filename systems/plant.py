"""Planting: what is shown is stood on the ground, and its receivers become entities."""

from collections.abc import Iterable
from dataclasses import dataclass

from ..engine.world import World
from .around.outlook import Outlook
from .show.representation import Representation


@dataclass(slots=True)
class Plant:
    """The system `plant`: patches that are shown for the first time, or in another way, are planted."""

    outlooks: Iterable[Outlook]
    representations: tuple[Representation, ...]
    world: World

    def run(self) -> None:
        """Plant for every viewer that looks."""
        for outlook in self.outlooks:
            for representation in self.representations:
                representation.plant(outlook)
            for kept in outlook.kept.values():
                kept.enlist(self.world, outlook.patches)
