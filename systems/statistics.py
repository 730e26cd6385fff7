"""Statistics: what a frame took and held."""

from dataclasses import dataclass, field

from .around.outlook import Outlook


@dataclass(slots=True)
class Statistics:
    """What the last frame took and held."""

    systems_ms: dict[str, float] = field(default_factory=dict)
    """Time of each system [ms]."""

    draw_ms: float = 0.0
    """Time of the draw calls, without waiting for the graphics card [ms]."""

    blades_field: int = 0
    """Blades that grow on the whole terrain."""

    blades_considered: int = 0
    """Blades on the patches inside the view cone, whatever their representation."""

    blades_submitted: int = 0
    """Blades drawn as geometry."""

    receivers: int = 0
    """Receivers that heard the wind."""

    draw_calls: int = 0

    patches: dict[str, int] = field(default_factory=dict)
    """Visible patches by representation."""

    transitions: int = 0
    """Patches that were seen to change their representation, or to be changing it."""

    def count(self, outlook: Outlook, /, *, share: float) -> None:
        """Count the patches of a viewer; `share` is that of the terrain's blades which grow on one patch."""
        shown, names = outlook.patches.shown, outlook.patches.names
        self.blades_considered = round(share * self.blades_field * int(shown.sum()))
        self.patches = {
            name: int((shown & (outlook.patches.representation == level)).sum()) for level, name in enumerate(names)
        }
        self.receivers = outlook.heard
        self.transitions = outlook.changing
