"""What lives in GL, once for each context that it is drawn in: windows come, go and stand side by side."""

from collections.abc import Callable
from ctypes import c_int
from itertools import count
from typing import Any, Generic, Protocol, TypeVar

import moderngl

from .current import current_handle
from .functions import NUMBERS, Functions
from .host import current, has_windows, is_hidden, is_lost, pyglet_context
from .stream import Releasable


class Homed(Releasable, Protocol):
    """What lives in a GL context, and draws with one of moderngl's."""

    ctx: moderngl.Context


Thing = TypeVar("Thing", bound=Homed)

MOST_LEFT = 4
"""Contexts whose things wait to be given back, as they were not current when they should have been."""

_tokens = count(0x7A11_0001)
_left: list["Home[Any]"] = []


class Home(Generic[Thing]):
    """A thing in the context that is current, and a mark in that context by which it is known again.

    GL does not say which context is current, and one that is made later may have the address of one that is gone. But
    vertex arrays are shared with no other context: the mark is one of these, with a number that nobody else would
    write there.
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
        """Return whether its context is the one that is current."""
        gl, found = self._gl, (c_int * 1)()
        if not current_handle() or not gl.glIsVertexArray(*self._mark):
            return False
        bound = gl.number("VERTEX_ARRAY_BINDING")
        gl.glBindVertexArray(*self._mark)
        gl.glGetVertexAttribiv(0, NUMBERS["VERTEX_ATTRIB_ARRAY_DIVISOR"], found)
        gl.glBindVertexArray(bound)
        return found[0] == self._token

    def is_lost(self) -> bool:
        """Return whether its context is known to be gone: its window is closed, or another one has its address."""
        if self.place is not None:
            return is_lost(self.place)
        return bool(self.handle) and current_handle() == self.handle and not self.is_here()

    def release(self) -> bool:
        """Give the thing back in its own context; return whether that could be made current, or need not."""
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
        self.thing.release()
        if self.is_here():
            self._gl.glDeleteVertexArrays(1, self._mark)


class Homes(Generic[Thing]):
    """One thing for each GL context, made when it is first asked for there.

    Vertex arrays belong to one context: what is drawn in two windows is made twice, and again after a window was
    closed and another opened.
    """

    def __init__(self) -> None:
        self._homes: list[Home[Thing]] = []

    def __len__(self) -> int:
        return len(self._homes)

    def here(self, gl: Functions, make: Callable[[], Thing]) -> Thing:
        """Return the thing of the context that is current, which `gl` draws in; `make` makes it if there is none."""
        _left[:] = [home for home in _left if not home.release()]
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
        """Raise RuntimeError where the pyglet window that something was drawn in is closed, and no other is there."""
        context = pyglet_context()
        is_nowhere = not has_windows() and (context is None or is_hidden(context))
        if is_nowhere and any(is_lost(home.place) for home in self._homes):
            raise RuntimeError("there is no window any more: create another one before the prairie is drawn again")

    def release(self) -> None:
        """Give everything back, each in its own context.

        Beside pyglet nobody can make another context current than the one that is. What is in others is given back
        when something is next drawn there.
        """
        _left.extend([home for home in self._homes if not home.release()])
        self._homes.clear()
        last = list(dict.fromkeys(home.handle for home in reversed(_left)))[:MOST_LEFT]
        _left[:] = [home for home in _left if home.handle in last]
