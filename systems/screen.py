"""The targets of a prairie's drawing: a painter in each GL context, and groups in pyglet's batches."""

import logging
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING
from warnings import warn

import moderngl
import numpy as np

from ..engine.gl.guest import guest, host_context, saved_state, sync_framebuffer
from ..engine.gl.homes import Homes
from ..engine.gl.host import State
from ..engine.gl.outputs import has_depth
from .frame.feature import Feature
from .painter import Painter
from .site import Site
from .winds import Winds

if TYPE_CHECKING:
    from pyglet.graphics import Batch, Group

    from ..engine.gl.batch import DrawingGroup

log = logging.getLogger("tallgrass")

_dropped: list[Callable[[], None]] = []
"""Functions that release prairies which a game has dropped. Python drops things amid anything, on any thread."""


class Screen:
    """The host's framebuffers, in a given context or else in the current one."""

    def __init__(
        self,
        ctx: moderngl.Context | None,
        features: Sequence[Feature],
        winds: Winds,
        *,
        linear: bool,
    ) -> None:
        self.ctx, self.linear = ctx, linear
        self._features, self._winds = features, winds
        self.painter: Painter | None = None
        """Painter of the context that was drawn in last; None before the first draw."""
        self._painters: Homes[Painter] = Homes()
        self._has_warned = False
        """Whether a framebuffer without depth has been reported."""
        self._groups: list[DrawingGroup] = []

    @contextmanager
    def opened(self, site: Site) -> Iterator[Painter | None]:
        """Give the painter of a site in the host's context, and restore the host's GL state at the end.

        It is None if the viewport has no pixels. Raises RuntimeError if the host has no window or its OpenGL is too
        old.
        """
        with self._entered() as painter:
            if painter is not None:
                painter.settle(site)
            yield painter

    def preparing(self, site: Callable[[], Site], look: Callable[[], None]) -> Iterator[tuple[int, int]]:
        """Make everything in the current context that may be needed; yield the numbers of steps done and in total.

        `look` uploads a frame to rehearse, and is called if no viewer has looked yet. Between steps the host has its
        own GL state. Without pixels in the viewport there are no steps at first, and later ones wait for them. Raises
        RuntimeError as `opened` does, and if another context has become current.
        """
        with self._entered() as painter:
            if painter is None:
                return
            steps, count = painter.preparing(site, look), painter.steps(site())
        done = 0
        yield done, count
        while done < count:
            with self._entered() as here:
                if here not in (painter, None):
                    raise RuntimeError("a prairie is prepared in one GL context: make that current before each step")
                if here is not None:
                    with guest(painter.ctx):
                        over = next(steps, "over") == "over"
                    done = count if over else min(done + 1, count - 1)
            yield done, count

    def stage(self, site: Site) -> bool:
        """Upload a piece of another site into the host's context; return whether all of it is there."""
        with self._entered() as painter:
            if painter is None:
                return False
            with guest(painter.ctx):
                return painter.stage(site)

    @contextmanager
    def _entered(self) -> Iterator[Painter | None]:
        """Give the painter of the host's context, which may have settled on another site."""
        self._painters.check()
        with np.errstate(under="ignore"), saved_state(self.ctx) as state:
            if 0 in state.viewport[2:]:
                yield None
                return
            self._warn_without_depth(state)
            while _dropped:
                _dropped.pop()()
            self.painter = self._painters.here(state.gl, self._made)
            sync_framebuffer(self.painter.ctx)
            yield self.painter

    def _warn_without_depth(self, state: State) -> None:
        """Warn once of a framebuffer without depth, whose picture is wrong."""
        if self._has_warned or has_depth(state.gl, state.framebuffer):
            return
        self._has_warned = True
        log.warning(
            "a prairie is drawn into a framebuffer without depth, so what is far off lies over what is near: give it a "
            "depth buffer, or ask for one when the window is made"
        )

    def _made(self) -> Painter:
        """Return a new painter in the current context."""
        ctx = host_context(self.ctx)
        sync_framebuffer(ctx)
        return Painter(ctx, self._features, self._winds, linear=self.linear)

    def current(self) -> Painter:
        """Return the painter of the context that is being drawn in."""
        assert self.painter is not None
        return self.painter

    def group(self, draw: Callable[[], None], batch: "Batch", order: int, parent: "Group | None") -> "DrawingGroup":
        """Return a new group of a batch, which calls `draw` in its turn."""
        from ..engine.gl.batch import DrawingGroup  # noqa: PLC0415 - it loads pyglet, which needs a display

        made = DrawingGroup(draw, batch, order=order, parent=parent)
        self._groups.append(made)
        return made

    def release_later(self, release: Callable[[], None], path: Path | None) -> None:
        """Warn that a prairie was dropped without `release` if it has GL objects, and release it at the next draw."""
        if self.painter is not None and not sys.is_finalizing():
            _dropped.append(release)
            which = "" if path is None else f" of {path.name}"
            advice = "call its release() when you are done with it"
            warn(f"a prairie{which} was dropped and not released: {advice}", ResourceWarning, stacklevel=3)

    def release(self) -> None:
        """Remove the groups from their batches, and release the painters in every context."""
        for group in self._groups:
            group.delete()
        self._groups.clear()
        self._painters.release()
        self.painter = None
