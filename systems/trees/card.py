"""A tree that has grown, as one GL context holds it, and the streams of those that are drawn as it is."""

from collections.abc import Iterator, Mapping

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Mask
from ...engine.gl.records import Records
from ...engine.gl.stream import Stream, release_all
from .bark import RUNS, SENT, sent
from .lies import Lies
from .model import Model
from .outline import NOWHERE
from .shells import SHELLS, Shells
from .standing import COLUMN, HUNG, LEAFY, PLACED, SHOWN, TOLD
from .twig import RANKS, ROW, TWIG
from .wood import Parts, parts

Numbers = Mapping[str, tuple[float, ...]]
"""What programs are told, by name."""

NEAR, FAR, LEAVES, WOOD, CAST, PICTURED = "near", "far", "leaves", "wood", "cast", "pictured"
"""What is drawn of trees: twigs on their cards, pictures far off, leaf by leaf, wood; and into maps of their shade, and
twigs on their cards into those pictures."""

IN_ROWS = "in rows"
"""Pictures far off where some show rows of trees, of a large forest."""

QUAD = 6
"""Vertices of a quad, as two triangles."""

SHARES = 2 / 3, 1 / 3, 1 / 6
"""Shares of its twigs between which trees have their cards drawn together: as many of each as of any of them."""

TOO_FEW = 6
"""Trees of the smallest share for which no draw of their own pays."""

BACKS = tuple(f"back{number}" for number in range(SHELLS + 1))
"""The streams of pictures far off from far to near, as soft edges are blended: beyond the grass, and by shells of it.
That of `FAR` has all of them, from near to far."""

CARDS = tuple(f"{NEAR}{number}" for number in range(len(SHARES) + 1 + SHELLS))
WOODS = tuple(f"{WOOD}{number}" for number in range(len(RUNS) + 1 + SHELLS))
"""The streams of cards and of wood: beyond the grass by their share and by `RUNS`, and then by shells of it."""

SHELL_OF = {
    FAR: 0, LEAVES: SHELLS + 1,
    **{name: number for number, name in enumerate(BACKS)},
    **{name: max(number - len(SHARES), 0) for number, name in enumerate(CARDS)},
    **{name: max(number - len(RUNS), 0) for number, name in enumerate(WOODS)},
}  # fmt: skip
"""The shell of grass in which the trees of each stream stand: 0 beyond all of it; single leaves are before it."""

ROOM = 16
"""Trees for which a stream has room at first: there are many streams, and most have few trees."""


def drawn_of(twigs: int, share: float, /) -> int:
    """Return how many of a tree's twigs are drawn where such a share of them is to be seen."""
    dwindling = 0.5 / RANKS  # as `size_of` of twig.glsl has it
    return min(int(twigs * (share + dwindling)) + 1, twigs)


class ModelOnCard:
    """One tree that has grown, and the streams of those that are drawn as it is."""

    def __init__(self, ctx: moderngl.Context, model: Model) -> None:
        self.model = model
        self.numbers: Numbers = {
            "tall": (model.height,), "twigs": (len(model.twigs),),
            "ball": (model.middle, model.half), "slim": (model.slim,), "lines": (model.lines,),
            "lawn_shade": model.shade,
            "column": (COLUMN * model.radius,),
        }  # fmt: skip
        """What programs are told of it."""
        self.twigs = Records(ctx, TWIG, ROW, rows=-(-len(model.twigs) // ROW))
        self.twigs.write(model.twigs)
        self.vertices = ctx.buffer(sent(model.vertices))
        self.triangles = ctx.buffer(np.concatenate([each.triangles for each in model.wood]))
        self.first_of: list[int] = np.cumsum([0, *(len(each.triangles) for each in model.wood)]).tolist()
        """The first of those that are drawn of each of `RUNS`."""
        self.bare = Stream(ctx, LEAFY)
        self._alone = np.zeros(1, LEAFY)
        for name in ("keep", "columns", "shows", "scale", "foliage", "tint"):
            self._alone[name] = 1.0
        self._alone["turn"] = 1.0, 0.0
        self.bare.write(self._alone)
        self.streams = {name: Stream(ctx, SHOWN, rows=ROOM) for name in (*WOODS, FAR, *BACKS, *CARDS)}
        self.streams[LEAVES] = Stream(ctx, LEAFY)
        self.told = {id(each): Stream(ctx, TOLD, rows=ROOM) for each in self.streams.values()}
        """What is made out of the trees of each stream once a tree, by the stream's id."""
        self.placed = {name: np.zeros(0, PLACED) for name in self.streams}
        """Where the trees of each stream stand."""
        self.hung = {name: Stream(ctx, HUNG) for name in (*CARDS, LEAVES)}
        """What is made out of each twig of their trees once a twig."""
        self.most = dict.fromkeys(self.streams, 0)
        """Twigs that any tree of a stream draws."""
        self.wood = dict.fromkeys(WOODS, Parts(0, 0))
        """Triangles that the trees of a stream of wood draw."""
        self.run = dict.fromkeys(WOODS, 0)
        """Of which of `RUNS` these are."""
        self.far: moderngl.TextureArray | None = None
        """Its pictures from all around: what they show, and how light has come to that."""
        self.met: moderngl.TextureArray | None = None
        self.lies = Lies()
        """How its leaves lie."""
        self.around = self.core = NOWHERE
        """Corners about what its pictures show, and about what they cover so that it is drawn as solid."""

    def bark(self, program: moderngl.Program) -> tuple[moderngl.Buffer | str, ...]:
        """Return the vertices of its wood, as a vertex array takes them: those fields that a program has."""
        names, forms = list(SENT.names or ()), ("4f", "4f1", "4f2", "3f2 2x", "4f2")
        ends = [*(SENT.fields[name][1] for name in names), SENT.itemsize] if SENT.fields else []
        kept = [
            form if name in program else f"{end - start}x"
            for name, form, start, end in zip(names, forms, ends, ends[1:], strict=False)
        ]
        return self.vertices, " ".join(kept), *(name for name in names if name in program)

    def write(
        self, near: NDArray[np.void], wide: Doubles, leafy: NDArray[np.void], far: NDArray[np.void], shells: Shells
    ) -> None:
        """Send trees that are drawn near by, the nearest first, twigs of them that are leaf by leaf, and those far off.

        `wide` is the radius of a stem of the model that is a pixel wide, where each is nearest, shape (n,); `shells`
        are those that both stand in.
        """
        self._write_wood(near, wide, shells)
        self._send(FAR, far)
        for name, own in self._parted(BACKS, shells.far):
            self._send(name, far[own][::-1])
        self._send(LEAVES, leafy)
        self.most[LEAVES] = 1
        drawn = near["keep"] * (1.0 - near["gone"])
        group = (drawn[:, None] < SHARES).sum(axis=1)
        beyond = shells.near == 0
        if (group[beyond] == len(SHARES)).sum() < TOO_FEW:
            group = np.minimum(group, len(SHARES) - 1)
        group = np.where(beyond, group, len(SHARES) + shells.near)
        for name, own in self._parted(CARDS, group):
            self._write_cards(name, near[own])

    def _parted(self, names: tuple[str, ...], number: NDArray[np.intp]) -> Iterator[tuple[str, Mask]]:
        """Yield streams, and which trees come into each by its `number`, shape (n,), but for those that stay empty."""
        trees = np.bincount(number, minlength=len(names)).tolist()
        for own, (name, some) in enumerate(zip(names, trees, strict=True)):
            if some or self.streams[name].count:
                yield name, number == own

    def _write_wood(self, near: NDArray[np.void], wide: Doubles, shells: Shells) -> None:
        run = np.searchsorted(RUNS, wide)
        for name, own in self._parted(WOODS, np.where(shells.near == 0, run, len(RUNS) + shells.near)):
            self._send(name, near[own])
            if own.any():
                self.run[name] = finest = int(run[own].min())
                self.wood[name] = parts(self.model.wood[finest].radii, wide[own], near[own])

    def _send(self, name: str, rows: NDArray[np.void]) -> None:
        stream = self.streams[name]
        stream.write(rows)
        self.told[id(stream)].room(len(rows))
        self.placed[name] = placed = np.zeros(len(rows), PLACED)
        placed["root"], placed["crown_at"] = rows["root"], rows["scale"] * np.float32(self.model.middle)
        placed["phase"], placed["hertz"] = rows["phase"], self.model.hertz / np.sqrt(rows["scale"])

    def _write_cards(self, name: str, rows: NDArray[np.void]) -> None:
        self._send(name, rows)
        of_tree = rows["keep"] * (1.0 - rows["gone"])
        share, twigs = float((of_tree * rows["foliage"]).max(initial=0.0)), len(self.model.twigs)
        self.most[name] = twigs if of_tree.max(initial=0.0) >= SHARES[0] else drawn_of(twigs, share)

    def rehearse(self) -> None:
        """Have a tree to draw in every way that there is."""
        for name, stream in self.streams.items():
            if not stream.count:
                self._send(name, self._alone if name == LEAVES else self._alone[[*(SHOWN.names or ())]].astype(SHOWN))
                self.most[name] = 1
                self.wood[name] = Parts(1, 1)

    def release(self) -> None:
        """Give everything back."""
        release_all(self.twigs, self.vertices, self.triangles, self.bare)
        release_all(*self.streams.values(), *self.told.values(), *self.hung.values())
        release_all(*(each for each in (self.far, self.met) if each is not None))
