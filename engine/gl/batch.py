"""Drawing the prairie within a pyglet batch. This module imports pyglet: import it only where a game has a batch."""

from collections.abc import Callable
from typing import Any

import moderngl
import pyglet
from pyglet.graphics import Batch, Group, get_default_shader

_STATES: Any = getattr(pyglet.graphics, "State", None)
"""Base class of the states of a pyglet 3 group; None in pyglet 2, which calls the group itself."""


class DrawingGroup(Group):
    """A group of a pyglet batch that calls `draw` in its turn, once for each time that the batch is drawn.

    Groups of a lower `order` are drawn before it, those of a higher one after it, and what is in the group itself or
    in groups inside it right after it. `visible` hides all of that, as of any group. `delete` takes it out again.
    """

    def __init__(self, draw: Callable[[], None], batch: Batch, *, order: int, parent: Group | None) -> None:
        super().__init__(order, parent)
        self._draw: Callable[[], None] | None = draw
        self._program = get_default_shader()
        mode: Any = moderngl.TRIANGLES
        # A batch skips empty groups, so this one gets a triangle of zero size.
        vertices: dict[str, Any] = {"position": ("f", (0.0,) * 9)}
        if _STATES is not None:
            mode = _as_state(self, self._program, self._draw_unless_deleted)
            vertices = {"position": (0.0,) * 9, "colors": (0.0,) * 12}
        self._triangle = self._program.vertex_list(3, mode, batch, self, **vertices)

    def __eq__(self, other: object) -> bool:
        return self is other

    def __hash__(self) -> int:
        return id(self)

    def _draw_unless_deleted(self) -> None:
        if self._draw is not None:
            self._draw()

    if _STATES is None:

        def set_state(self) -> None:
            """Draw; the batch calls this."""
            self._draw_unless_deleted()
            self._program.use()

        def unset_state(self) -> None:
            """Unbind the program after the group's vertex lists; the batch calls this."""
            self._program.stop()

    def delete(self) -> None:
        """Take this out of the batch; other vertex lists of the group stay. A second call does nothing."""
        if self._draw is not None:
            self._draw = None
            self._triangle.delete()
            for batch in self.batches:
                batch.invalidate()


def _as_state(group: Any, program: Any, draw: Callable[[], None]) -> Any:
    """Make a group of pyglet 3 draw when its state is set; return pyglet 3's mode for triangles."""
    from pyglet.enums import GeometryMode  # type: ignore[import-not-found]  # noqa: PLC0415 - pyglet 2 has none

    class Turn(_STATES):  # type: ignore[misc]
        """State whose setting draws."""

        sets_state = True

        def set_state(self, _context: object) -> None:
            """Draw; the batch calls this."""
            draw()

    group.set_state(Turn())
    group.set_shader_program(program)
    return GeometryMode.TRIANGLES
