"""Indexed viewports and scissors, of which OpenGL 4.1 and newer have 16. A call without an index sets all of them."""

from collections.abc import Iterable
from ctypes import Array, addressof, c_float, c_int
from functools import lru_cache
from typing import TypeVar

from .functions import ENUMS, Functions

Value = TypeVar("Value")

Box = tuple[int, int, int, int]
"""Part of a framebuffer: first column, first row from the bottom, columns, rows."""

BYTES = 16
"""Size of a box: four numbers."""


class Viewports:
    """Snapshot of the `count` viewports and scissors that differ from the first, which `restore` brings back."""

    def __init__(self, gl: Functions, count: int) -> None:
        self._gl = gl
        self._viewports: dict[int, list[float]] = {}
        self._scissors: dict[int, list[int]] = {}
        self._tests: dict[int, int] = {}
        if count > 1:
            self._query(count)

    def _query(self, count: int) -> None:
        """Read all of them, fast: nothing tells whether a host uses any."""
        gl, viewport, scissor, test = self._gl, ENUMS["VIEWPORT"], ENUMS["SCISSOR_BOX"], ENUMS["SCISSOR_TEST"]
        viewports, scissors, viewport_at, scissor_at = _results(count)
        for index in range(count):
            gl.glGetFloati_v(viewport, index, viewport_at)
            gl.glGetIntegeri_v(scissor, index, scissor_at)
            viewport_at, scissor_at = viewport_at + BYTES, scissor_at + BYTES
        self._viewports, self._scissors = _unlike_first(_by_four(viewports)), _unlike_first(_by_four(scissors))
        self._tests = _unlike_first([gl.glIsEnabledi(test, index) for index in range(count)])

    def restore(self) -> None:
        """Restore them; call it after the first ones are restored."""
        gl, switch = self._gl, ENUMS["SCISSOR_TEST"]
        for index, viewport in self._viewports.items():
            gl.glViewportIndexedf(index, *viewport)
        for index, scissor in self._scissors.items():
            gl.glScissorIndexed(index, *scissor)
        for index, is_on in self._tests.items():
            (gl.glEnablei if is_on else gl.glDisablei)(switch, index)


@lru_cache(maxsize=4)
def _results(count: int) -> tuple[Array[c_float], Array[c_int], int, int]:
    """Return arrays for `count` viewports and scissors, and their addresses: ctypes passes integers faster."""
    viewports, scissors = (c_float * (4 * count))(), (c_int * (4 * count))()
    return viewports, scissors, addressof(viewports), addressof(scissors)


def _by_four(array: Iterable[Value]) -> list[list[Value]]:
    return [list(four) for four in zip(*[iter(array)] * 4, strict=True)]


def _unlike_first(values: list[Value]) -> dict[int, Value]:
    """Return the values that differ from the first, by index."""
    first = values[0]
    return {} if values.count(first) == len(values) else {k: each for k, each in enumerate(values) if each != first}
