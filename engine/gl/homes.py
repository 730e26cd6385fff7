"""What lives in GL, once for each context that it is drawn in: windows come, go and stand side by side."""

from collections.abc import Callable
from typing import Any, Generic, TypeVar

import moderngl

from .host import current, is_lost, pyglet_context
from .stream import Releasable

Thing = TypeVar("Thing", bound=Releasable)


class Homes(Generic[Thing]):
    """One thing for each GL context, made when it is first asked for there.

    Vertex arrays belong to one context: what is drawn in two windows is made twice, and again after a window was
    closed and another opened.
    """

    def __init__(self) -> None:
        self._homes: list[tuple[moderngl.Context, Any | None, Thing]] = []

    def __len__(self) -> int:
        return len(self._homes)

    def here(self, ctx: moderngl.Context, make: Callable[[moderngl.Context], Thing]) -> Thing:
        """Return the thing of the context that is current, which `ctx` draws in; `make` makes it if there is none.

        Raises RuntimeError where the window that `ctx` drew in is closed and no other is there.
        """
        place = self.check(ctx)
        for known, where, thing in self._homes:
            if known is ctx and where is place:
                return thing
        self._let_go(lost=True)
        thing = make(ctx)
        self._homes.append((ctx, place, thing))
        return thing

    def check(self, ctx: moderngl.Context) -> Any | None:
        """Return the pyglet context that `ctx` draws in, None beside pyglet.

        Raises RuntimeError where the window that `ctx` drew in is closed and no other is there.
        """
        place = None if ctx.screen is None else pyglet_context()
        if place is None and any(known is ctx and is_lost(where) for known, where, _ in self._homes):
            raise RuntimeError("there is no window any more: create another one before the prairie is drawn again")
        return place

    def release(self) -> None:
        """Give everything back, each in its own context."""
        self._let_go(lost=False)

    def _let_go(self, *, lost: bool) -> None:
        going = [home for home in self._homes if is_lost(home[1]) or not lost]
        self._homes = [home for home in self._homes if home not in going]
        for _, where, thing in going:
            with current(where) as deletable:
                if deletable:
                    thing.release()
