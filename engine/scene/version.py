"""The versions of the scene format, and the steps from one to the next."""

from collections.abc import Callable, Mapping
from typing import Any

from ..declared.scene import FORMAT

Values = dict[str, Any]
Steps = Mapping[int, Callable[[Values], Values]]

STEPS: Steps = {}
"""Turns the values of a scene of one version into those of the next, by the version it starts from."""

FIRST = f"a scene begins with 'tallgrass: {FORMAT}', the version of the scene format"


def upgrade(values: Values, version: int, /, *, steps: Steps = STEPS, to: int = FORMAT) -> Values:
    """Return the values as version `to` writes them. Raises ValueError for a version that nobody knows."""
    if version > to:
        raise ValueError(f"this scene is of format {version}, this release reads up to {to}; update tallgrass")
    for step in range(version, to):
        if step not in steps:
            raise ValueError(f"there is no scene format {version}; write 'tallgrass: {to}'")
        values = steps[step](values) | {"tallgrass": step + 1}
    return values
