"""A tree that has grown, as one GL context holds it, and the streams of those that are drawn as it is."""

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...engine.gl.records import Records
from ...engine.gl.stream import Stream, attributes, release_all
from .model import Model
from .standing import SHOWN, TOLD
from .twig import ROW, TWIG

NEAR, FAR, LEAVES, WOOD, THICK = "near", "far", "leaves", "wood", "thick"

FEWER = 0.5
"""Share of its twigs that a tree's pictures show, as much larger: in so few pixels, more would look the same."""

SMALL = 0.35
"""Share of twigs below which a tree's thin branches are left out: they are less than half a pixel thick."""

GROUPS = 3
"""Draws that the cards of a model's trees take: each for those of which about as many twigs are drawn."""


class ModelOnCard:
    """One tree that has grown, and the streams of those that are drawn as it is."""

    def __init__(self, ctx: moderngl.Context, model: Model) -> None:
        self.model = model
        self.twigs = Records(ctx, TWIG, ROW, rows=-(-len(model.twigs) // ROW))
        self.twigs.write(model.twigs)
        self.vertices = ctx.buffer(model.vertices)
        self.triangles = ctx.buffer(np.ascontiguousarray(model.triangles))
        self.bare = Stream(ctx, SHOWN)
        self._alone = np.zeros(1, SHOWN)
        self._alone["keep"] = FEWER
        self._alone["scale"] = self._alone["foliage"] = self._alone["tint"] = 1.0
        self._alone["turn"] = 1.0, 0.0
        self.bare.write(self._alone)
        self.streams = {
            name: Stream(ctx, SHOWN) for name in (WOOD, THICK, LEAVES, FAR, *(f"{NEAR}{n}" for n in range(GROUPS)))
        }
        self.told = {id(each): Stream(ctx, TOLD) for each in self.streams.values()}
        """What is made out of the trees of each stream once a tree, by the stream's id."""
        self.most = dict.fromkeys(self.streams, 0)
        """Twigs that any tree of a stream draws."""
        self.far: moderngl.TextureArray | None = None

    @property
    def bark(self) -> tuple[moderngl.Buffer, str, list[str]]:
        """The vertices of its wood, as a vertex array takes them."""
        return (self.vertices, *attributes(self.model.vertices.dtype))

    def write(self, near: NDArray[np.void], leafy: NDArray[np.bool_], far: NDArray[np.void]) -> None:
        """Send the trees that are drawn near by, which of those leaf by leaf too, and those far off."""
        small = near["keep"] < SMALL
        self.streams[WOOD].write(near[~small])
        self.streams[THICK].write(near[small])
        self.streams[FAR].write(far)
        self._write(LEAVES, near[leafy])
        drawn = near["keep"] * (1.0 - near["gone"])
        group = np.minimum(((1.0 - drawn) * GROUPS).astype(np.intp), GROUPS - 1)
        for number in range(GROUPS):
            self._write(f"{NEAR}{number}", near[group == number])

    def _write(self, name: str, rows: NDArray[np.void]) -> None:
        self.streams[name].write(rows)
        share = float((rows["keep"] * (1.0 - rows["gone"]) * rows["foliage"]).max(initial=0.0))
        self.most[name] = min(int(len(self.model.twigs) * (share + 0.05)) + 1, len(self.model.twigs))

    def rehearse(self) -> None:
        """Have a tree to draw in every way that there is."""
        for name, stream in self.streams.items():
            if not stream.count:
                stream.write(self._alone)
                self.most[name] = 1

    def release(self) -> None:
        """Give everything back."""
        release_all(self.twigs, self.vertices, self.triangles, self.bare, *self.streams.values(), *self.told.values())
        if self.far is not None:
            self.far.release()
