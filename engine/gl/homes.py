"""GL objects held once per GL context: windows come and go, and may be open side by side."""

from collections.abc import Callable
from ctypes import c_int
from itertools import count
from typing import Any, Generic, Protocol, TypeVar

import moderngl

from .current import current_handle
from .functions import ENUMS, Functions
from .host import current, has_windows, is_hidden, is_lost, pyglet_context
from .stream import Releasable


class Homed(Releasable, Protocol):
    """A holder of GL objects in one GL context, which it uses through a moderngl context."""

    ctx: moderngl.Context


Thing = TypeVar("Thing", bound=Homed)

MOST_PENDING = 4
"""Greatest number of contexts whose objects wait to be deleted, because the context was not current at release."""

_tokens = count(0x7A11_0001)
_pending: list["Home[Any]"] = []


class Home(Generic[Thing]):
    """A thing in the current context, and a mark in that context by which the context is recognised.

    GL does not tell which context is current, and a later context may have the address of one that is gone. But vertex
    arrays are never shared between contexts: the mark is a vertex array with an unusual divisor, the token.
    """

    def __init__(self, gl: Functions, thing: Thing) -> None:
        self._gl, self.thing = gl, thing
        self.place = None if thing.ctx.screen is None else pyglet_context()
        self.handle, self._token = current_handle(), next(_tokens)
        self._mark, bound = (c_int * 1)(), gl.number("VERTEX_ARRAY_BINDING")
        gl.glGenVertexArrays(1, self._mark)
        gl.glBindVertexArray(*self._mark)
        gl.glVertexAttribDivisor(0, self._token)
        gl.glBindVertexArray(bound)

    def is_here(self) -> bool:
        """Return whether the thing's context is current."""
        gl, found = self._gl, (c_int * 1)()
        if not current_handle() or not gl.glIsVertexArray(*self._mark):
            return False
        bound = gl.number("VERTEX_ARRAY_BINDING")
        gl.glBindVertexArray(*self._mark)
        gl.glGetVertexAttribiv(0, ENUMS["VERTEX_ATTRIB_ARRAY_DIVISOR"], found)
        gl.glBindVertexArray(bound)
        return found[0] == self._token

    def is_lost(self) -> bool:
        """Return whether the thing's context is known to be gone: its window is closed, or its address is reused."""
        if self.place is not None:
            return is_lost(self.place)
        return bool(self.handle) and current_handle() == self.handle and not self.is_here()

    def release(self) -> bool:
        """Release the thing in its own context; return False where that context cannot be made current."""
        if self.place is None:
            if self.is_here():
                self._release()
                return True
            return self.is_lost()
        with current(self.place) as deletable:
            if deletable:
                self._release()
        return True

    def _release(self) -> None:
        """Release the thing; Mesa drops the general binding of uniform buffers with a block's own buffer."""
        gl = self._gl
        bound = gl.number("UNIFORM_BUFFER_BINDING")
        self.thing.release()
        gl.glBindBuffer(ENUMS["UNIFORM_BUFFER"], gl.living("Buffer", bound))
        if self.is_here():
            self._gl.glDeleteVertexArrays(1, self._mark)


class Homes(Generic[Thing]):
    """One thing for each GL context, made at its first use there.

    Vertex arrays belong to one context, so that each window needs a thing of its own, and so does a new window after
    the old one was closed.
    """

    def __init__(self) -> None:
        self._homes: list[Home[Thing]] = []

    def __len__(self) -> int:
        return len(self._homes)

    def here(self, gl: Functions, make: Callable[[], Thing]) -> Thing:
        """Return the thing of the current context, whose functions are `gl`; `make` makes it if there is none."""
        _pending[:] = [home for home in _pending if not home.release()]
        for home in self._homes:
            if home.is_here():
                return home.thing
        lost = [home for home in self._homes if home.is_lost()]
        self._homes = [home for home in self._homes if home not in lost]
        for home in lost:
            home.release()
        self._homes.append(Home(gl, make()))
        return self._homes[-1].thing

    def check(self) -> None:
        """Raise RuntimeError where a pyglet window that was drawn in is closed, and no other is open."""
        context = pyglet_context()
        is_nowhere = not has_windows() and (context is None or is_hidden(context))
        if is_nowhere and any(is_lost(home.place) for home in self._homes):
            raise RuntimeError("there is no window any more: create another one before the prairie is drawn again")

    def release(self) -> None:
        """Release all things, each in its own context.

        Only pyglet's contexts can be made current here. Things in other contexts that are not current are released when
        something is next drawn there.
        """
        _pending.extend([home for home in self._homes if not home.release()])
        self._homes.clear()
        last = list(dict.fromkeys(home.handle for home in reversed(_pending)))[:MOST_PENDING]
        _pending[:] = [home for home in _pending if home.handle in last]
