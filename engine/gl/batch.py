"""Something of ours among what a pyglet batch draws. It imports pyglet: import it only where a game has a batch."""

from collections.abc import Callable

import moderngl
from pyglet.graphics import Batch, Group, get_default_shader


class DrawingGroup(Group):
    """A group of a pyglet batch that calls `draw` in its turn, once for each time that the batch is drawn.

    Groups of a lower `order` are drawn before it, those of a higher one after it, and what is in the group itself or
    in groups inside it right after it. `visible` hides all of that, as of any group. `delete` takes it out again.
    """

    def __init__(self, draw: Callable[[], None], batch: Batch, *, order: int = 0, parent: Group | None = None) -> None:
        super().__init__(order, parent)
        self._draw: Callable[[], None] | None = draw
        self._program = get_default_shader()
        # A batch leaves out groups in which there is nothing: this is a triangle of no size.
        self._nothing = self._program.vertex_list(3, moderngl.TRIANGLES, batch, self, position=("f", (0.0,) * 9))

    def __eq__(self, other: object) -> bool:
        return self is other

    def __hash__(self) -> int:
        return id(self)

    def set_state(self) -> None:
        """Draw; the batch calls this."""
        if self._draw is not None:
            self._draw()
        self._program.use()

    def unset_state(self) -> None:
        """End the drawing of what is in the group; the batch calls this."""
        self._program.stop()

    def delete(self) -> None:
        """Take this out of the batch; what else is in the group stays there. A second time does nothing."""
        if self._draw is not None:
            self._draw = None
            self._nothing.delete()
            for batch in self.batches:
                batch.invalidate()
