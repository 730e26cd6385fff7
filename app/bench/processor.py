"""The cost of frames on the CPU alone: measured in a process whose driver draws nothing, as Mesa's can."""

from collections.abc import Callable

from ..studio.errors import MachineError
from ..studio.offscreen import standalone_context
from ..studio.take import Take
from .apart import apart
from .sent import Result

NOOP = {"GALLIUM_NOOP": "1"}
"""Environment by which Mesa accepts every command and draws nothing; other drivers ignore it."""


def on_processor(measure: Callable[[Take], Result], take: Take, /) -> Result | None:
    """Return what a module's function measures of a take, or None where the driver always draws or that fails."""
    try:
        return apart(_unless_drawn, measure, take, environment=NOOP)
    except MachineError:
        return None


def _unless_drawn(measure: Callable[[Take], Result], take: Take) -> Result | None:
    return measure(take) if draws_nothing() else None


def draws_nothing() -> bool:
    """Return whether the driver only accepts commands."""
    ctx = standalone_context()
    try:
        return str(ctx.info["GL_RENDERER"]).startswith("NOOP")
    finally:
        ctx.release()
