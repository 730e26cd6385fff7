"""Viewports and scissors by index, of which OpenGL has 16 from 4.1 on; whoever sets one as ever sets them all."""

from ctypes import c_float, c_int

from .functions import NUMBERS, Functions


class Viewports:
    """Those that are unlike the first at one moment, which `restore` brings back after the first. There are `count`."""

    def __init__(self, gl: Functions, count: int) -> None:
        self._gl = gl
        self._boxes = _unlike([self._box(index) for index in range(count)] if count > 1 else [])
        self._cuts = _unlike([self._cut(index) for index in range(count)] if count > 1 else [])
        self._cutting = _unlike([self._is_cutting(index) for index in range(count)] if count > 1 else [])

    def restore(self) -> None:
        """Bring them back."""
        gl, switch = self._gl, NUMBERS["SCISSOR_TEST"]
        for index, box in self._boxes.items():
            gl.glViewportIndexedf(index, *box)
        for index, cut in self._cuts.items():
            gl.glScissorIndexed(index, *cut)
        for index, (is_cutting,) in self._cutting.items():
            (gl.glEnablei if is_cutting else gl.glDisablei)(switch, index)

    def _box(self, index: int) -> tuple[float, ...]:
        found = (c_float * 4)()
        self._gl.glGetFloati_v(NUMBERS["VIEWPORT"], index, found)
        return tuple(found)

    def _cut(self, index: int) -> tuple[int, ...]:
        found = (c_int * 4)()
        self._gl.glGetIntegeri_v(NUMBERS["SCISSOR_BOX"], index, found)
        return tuple(found)

    def _is_cutting(self, index: int) -> tuple[int, ...]:
        return (self._gl.glIsEnabledi(NUMBERS["SCISSOR_TEST"], index),)


def _unlike(values: list[tuple[float, ...]]) -> dict[int, tuple[float, ...]]:
    """Return those that are not what the first is."""
    return {index: value for index, value in enumerate(values) if value != values[0]}
