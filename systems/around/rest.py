"""Rest: a system that would change nothing is left out, as long as it finds everything as it was."""

from dataclasses import dataclass, field


@dataclass(slots=True, eq=False)
class Rest:
    """What a system found when it last ran for a viewer, and left just as it was."""

    system: object = None
    seen: object = None
    """What it read beside the patch table."""

    table: bytearray = field(default_factory=bytearray)
    """What may change of the patch table as it found it, where it left it so; otherwise nothing."""

    made: object = None
    """What it made of that, if it makes something anew in each frame."""
