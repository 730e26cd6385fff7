"""Viewports and scissors by index, of which OpenGL has 16 from 4.1 on; whoever sets one as ever sets them all."""

from collections.abc import Iterable
from ctypes import Array, addressof, c_float, c_int
from functools import lru_cache
from typing import TypeVar

from .functions import NUMBERS, Functions

Value = TypeVar("Value")

BYTES = 16
"""What a box takes."""


class Viewports:
    """Those that are unlike the first at one moment, which `restore` brings back after the first. There are `count`."""

    def __init__(self, gl: Functions, count: int) -> None:
        self._gl = gl
        self._boxes: dict[int, list[float]] = {}
        self._cuts: dict[int, list[int]] = {}
        self._cutting: dict[int, int] = {}
        if count > 1:
            self._ask(count)

    def _ask(self, count: int) -> None:
        """Ask for all: nothing tells whether a host has used any, so it has to be cheap."""
        gl, viewport, scissor, test = self._gl, NUMBERS["VIEWPORT"], NUMBERS["SCISSOR_BOX"], NUMBERS["SCISSOR_TEST"]
        boxes, cuts, box, cut = _room(count)
        for index in range(count):
            gl.glGetFloati_v(viewport, index, box)
            gl.glGetIntegeri_v(scissor, index, cut)
            box, cut = box + BYTES, cut + BYTES
        self._boxes, self._cuts = _unlike(_by_four(boxes)), _unlike(_by_four(cuts))
        self._cutting = _unlike([gl.glIsEnabledi(test, index) for index in range(count)])

    def restore(self) -> None:
        """Bring them back."""
        gl, switch = self._gl, NUMBERS["SCISSOR_TEST"]
        for index, box in self._boxes.items():
            gl.glViewportIndexedf(index, *box)
        for index, cut in self._cuts.items():
            gl.glScissorIndexed(index, *cut)
        for index, is_cutting in self._cutting.items():
            (gl.glEnablei if is_cutting else gl.glDisablei)(switch, index)


@lru_cache(maxsize=4)
def _room(count: int) -> tuple[Array[c_float], Array[c_int], int, int]:
    """Return where boxes and cuts are asked for, and the addresses: ctypes takes numbers faster than arrays."""
    boxes, cuts = (c_float * (4 * count))(), (c_int * (4 * count))()
    return boxes, cuts, addressof(boxes), addressof(cuts)


def _by_four(array: Iterable[Value]) -> list[list[Value]]:
    return [list(four) for four in zip(*[iter(array)] * 4, strict=True)]


def _unlike(values: list[Value]) -> dict[int, Value]:
    """Return those that are not what the first is."""
    first = values[0]
    return {} if values.count(first) == len(values) else {k: each for k, each in enumerate(values) if each != first}
