"""The texture of a frame's receivers, pool after pool. Messages that a game writes overwrite those of the wind."""

from collections.abc import Mapping, Sequence
from itertools import accumulate

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats
from ...engine.gl.shaders import set_uniform
from ...engine.gl.texture import by_texel
from ...engine.terrain.sample import height_at, own_density_at
from ..around.outlook import Outlook
from ..around.receivers import Pool, Receiving
from ..space.ground import Ground

ROW = 1024
"""Number of receivers in a row of the texture."""

GLSL = {"RECEIVED_ROW": ROW}


class Received:
    """The texture of all receivers in the picture, computed anew in every frame.

    A texel is a receiver: its message (x, z), the height of the ground [m], and the density of its kind there.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        self.ctx = ctx
        self._make(64)

    def _make(self, rows: int) -> None:
        self.texture = by_texel(self.ctx.texture((ROW, rows), 4, dtype="f4"))
        self._target = self.ctx.framebuffer([self.texture])

    def allocate(self, counts: Sequence[int]) -> list[int]:
        """Make room for pools with these counts of receivers; return the number of each pool's first receiver."""
        *first, rows = accumulate((-(-count // ROW) for count in counts), initial=0)
        if rows > self.texture.height:
            self.reserve(rows * 3 // 2)
        return [row * ROW for row in first]

    def reserve(self, rows: int) -> None:
        """Make room for `rows` rows."""
        if rows > self.texture.height:
            self.release()
            self._make(rows)

    def compute(self, array: moderngl.VertexArray, *, first: int, count: int) -> int:
        """Run a pass over `count` receivers from number `first` on; return the number of draw calls."""
        if not count:
            return 0
        set_uniform(array.program, "pool", first // ROW, count)
        self._target.viewport = 0, first // ROW, ROW, -(-count // ROW)
        self._target.use()
        array.render(moderngl.TRIANGLES, vertices=3)
        return 1

    def write(self, first: int, texels: Floats) -> None:
        """Replace the texels (n, 4) of receivers from the `first` on."""
        done = 0
        while done < len(texels):
            x, y = (first + done) % ROW, (first + done) // ROW
            part = np.ascontiguousarray(texels[done : done + ROW - x], np.float32)
            self.texture.write(part, viewport=(x, y, len(part), 1))
            done += len(part)

    def release(self) -> None:
        """Release the texture."""
        self._target.release()
        self.texture.release()


def numbers_of(outlook: Outlook, first: Mapping[str, Sequence[int]], /) -> NDArray[np.intp]:
    """Return the numbers of all receivers that winds without a twin send messages to, shape (n,).

    Those without the small oscillations come last. `first` gives, by the representation's name, the number of the first
    receiver of each of its pools.
    """
    parts: list[tuple[bool, NDArray[np.intp]]] = []
    for name, kept in outlook.kept.items():
        for receiving, start in zip(kept.receiving, first[name], strict=True):
            slots = receiving.addressed[1]
            index = slots if receiving.still else np.arange(len(slots) * receiving.per_slot)
            parts.append((receiving.still, start + index))
    return np.concatenate([numbers for _, numbers in sorted(parts, key=lambda part: part[0])])


def write_messages(received: Received, outlook: Outlook, first: Mapping[str, Sequence[int]], ground: Ground, /) -> None:
    """Upload the messages that a game has written for receivers in the picture, in place of those of the wind."""
    for name, kept in outlook.kept.items():
        for receiving, start in zip(kept.receiving, first[name], strict=True):
            if receiving.messages.busy and not receiving.still:
                _write(received, receiving, start, ground)


def _write(received: Received, receiving: Receiving, start: int, ground: Ground) -> None:
    for slot, message in receiving.messages.written():
        for index in np.flatnonzero(receiving.slots == slot).tolist():
            received.write(start + index * receiving.per_slot, _texels(receiving.pool, slot, message, ground))


def _texels(pool: Pool, slot: int, message: Floats, ground: Ground) -> Floats:
    """Return the texels (n, 4) of a slot's receivers with these messages (n, 2)."""
    slots = np.array([slot])
    place = np.ascontiguousarray(pool.places(slots).reshape(-1, 2))
    dense = own_density_at(ground.density, pool.kind(slots), place)
    return np.column_stack([message, height_at(ground.terrain, place), dense]).astype(np.float32)
