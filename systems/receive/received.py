"""The receivers of a frame as texels on the graphics card, pool after pool; what only the CPU knows is written over."""

from collections.abc import Mapping, Sequence
from itertools import accumulate

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats
from ...engine.gl.shaders import set_uniform
from ...engine.terrain.sample import height_at, own_density_at
from ..around.outlook import Outlook
from ..around.receivers import Pool, Receiving
from ..space.ground import Ground

ROW = 1024
"""Receivers in a row of the texture."""

GLSL = {"RECEIVED_ROW": ROW}


class Received:
    """What all receivers that are seen are told, and what they stand on; made anew in every frame.

    A texel is a receiver: its message (x, z), the height of the ground [m], and how densely its kind grows there.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        self.ctx = ctx
        self._make(64)

    def _make(self, rows: int) -> None:
        self.texture = self.ctx.texture((ROW, rows), 4, dtype="f4")
        self.texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        self._target = self.ctx.framebuffer([self.texture])

    def lay(self, counts: Sequence[int]) -> list[int]:
        """Make room for pools of so many receivers, and return the number of each one's first."""
        *first, rows = accumulate((-(-count // ROW) for count in counts), initial=0)
        if rows > self.texture.height:
            self.reserve(rows * 3 // 2)
        return [row * ROW for row in first]

    def reserve(self, rows: int) -> None:
        """Make room for so many rows."""
        if rows > self.texture.height:
            self.release()
            self._make(rows)

    def ask(self, array: moderngl.VertexArray, *, first: int, count: int) -> int:
        """Ask `count` receivers from the `first` on with the program of a vertex array; return the number of draws."""
        if not count:
            return 0
        set_uniform(array.program, "pool", first // ROW, count)
        self._target.viewport = 0, first // ROW, ROW, -(-count // ROW)
        self._target.use()
        array.render(moderngl.TRIANGLES, vertices=3)
        return 1

    def write(self, first: int, texels: Floats) -> None:
        """Replace the texels (n, 4) of receivers from the `first` on."""
        at = 0
        while at < len(texels):
            x, y = (first + at) % ROW, (first + at) // ROW
            part = np.ascontiguousarray(texels[at : at + ROW - x], np.float32)
            self.texture.write(part, viewport=(x, y, len(part), 1))
            at += len(part)

    def release(self) -> None:
        """Give everything back."""
        self._target.release()
        self.texture.release()


def numbers_of(outlook: Outlook, first: Mapping[str, Sequence[int]], /) -> NDArray[np.intp]:
    """Return the numbers on the graphics card of all receivers told something, those that are still last, shape (n,).

    `first` gives the numbers of the first receivers of each representation's pools.
    """
    parts: list[tuple[bool, NDArray[np.intp]]] = []
    for name, kept in outlook.kept.items():
        for receiving, start in zip(kept.receiving, first[name], strict=True):
            slots = receiving.told[1]
            own = slots if receiving.still else np.arange(len(slots) * receiving.per_slot)
            parts.append((receiving.still, start + own))
    return np.concatenate([own for _, own in sorted(parts, key=lambda part: part[0])])


def write_messages(received: Received, outlook: Outlook, first: Mapping[str, Sequence[int]], ground: Ground, /) -> None:
    """Send what a game has written into messages of receivers that are shown, in place of what they have heard."""
    for name, kept in outlook.kept.items():
        for receiving, start in zip(kept.receiving, first[name], strict=True):
            if receiving.letters.busy and not receiving.still:
                _write(received, receiving, start, ground)


def _write(received: Received, receiving: Receiving, start: int, ground: Ground) -> None:
    for slot, message in receiving.letters.written():
        for place in np.flatnonzero(receiving.slots == slot).tolist():
            received.write(start + place * receiving.per_slot, _texels(receiving.pool, slot, message, ground))


def _texels(pool: Pool, slot: int, message: Floats, ground: Ground) -> Floats:
    """Return the texels (n, 4) of a slot's receivers with these messages (n, 2)."""
    at = np.array([slot])
    place = np.ascontiguousarray(pool.places(at).reshape(-1, 2))
    dense = own_density_at(ground.density, pool.kind(at), place)
    return np.column_stack([message, height_at(ground.terrain, place), dense]).astype(np.float32)
