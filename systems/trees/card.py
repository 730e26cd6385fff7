"""A tree that has grown, as one GL context holds it, and the streams of those that are drawn as it is."""

from collections.abc import Mapping

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...engine.gl.stream import Records, Stream, release_all
from .bark import RUNS, SENT, ranges_of, sent
from .lies import Lies
from .model import Model
from .outline import NOWHERE
from .shells import SHELLS
from .standing import COLUMN, HUNG, HUNG_LEAVES, LEAFY, SHOWN, TOLD
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

STREAMS = (LEAVES, *CARDS, *WOODS, FAR, *BACKS)
"""All streams of a model: of trees that are equally far off, those of the first ones are drawn first."""

FIRST_OF = {name: number for number, name in enumerate(STREAMS)}

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
        ranges = ranges_of(model.vertices)
        self.numbers: Numbers = {
            "tall": (model.height,), "twigs": (len(model.twigs),),
            "ball": (model.middle, model.half), "slim": (model.slim,), "lines": (model.lines,),
            "lawn_shade": model.shade,
            "column": (COLUMN * model.radius,), **ranges._asdict(),
        }  # fmt: skip
        """What programs are told of it."""
        self.twigs = Records(ctx, TWIG, ROW, rows=-(-len(model.twigs) // ROW))
        self.twigs.write(model.twigs)
        self.vertices = ctx.buffer(sent(model.vertices, ranges))
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
        self.hung = {**{name: Stream(ctx, HUNG) for name in CARDS}, LEAVES: Stream(ctx, HUNG_LEAVES)}
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
        names, forms = list(SENT.names or ()), ("4u2", "4f1", "4f2", "3f2 2x", "4f1")
        ends = [*(SENT.fields[name][1] for name in names), SENT.itemsize] if SENT.fields else []
        kept = [
            form if name in program else f"{end - start}x"
            for name, form, start, end in zip(names, forms, ends, ends[1:], strict=False)
        ]
        return self.vertices, " ".join(kept), *(name for name in names if name in program)

    def write(self, name: str, rows: NDArray[np.void]) -> None:
        """Send what is in a stream: trees, or twigs of them."""
        stream = self.streams[name]
        stream.write(rows)
        self.told[id(stream)].room(len(rows))

    def empty(self, name: str) -> None:
        """Have nothing in a stream."""
        stream = self.streams[name]
        for each in (stream, self.told[id(stream)], self.hung.get(name, stream)):
            each.room(0)

    def show_wood(self, name: str, wide: float, foliage: float) -> None:
        """Draw as much wood of a stream's trees as `parts` has it."""
        self.run[name] = run = int(np.searchsorted(RUNS, wide))
        self.wood[name] = parts(self.model.wood[run].radii, wide, foliage)

    def show_cards(self, name: str, keep: float, leaves: float) -> None:
        """Draw so many twigs of a stream's trees: the greatest share of any, and of the leaves of any."""
        twigs = len(self.model.twigs)
        self.most[name] = twigs if keep >= SHARES[0] else drawn_of(twigs, leaves)

    def rehearse(self) -> list[str]:
        """Have a tree to draw in every way that there is; return the streams that have got one."""
        empty = [name for name, stream in self.streams.items() if not stream.count]
        for name in empty:
            self.write(name, self._alone if name == LEAVES else self._alone[[*(SHOWN.names or ())]].astype(SHOWN))
            self.most[name] = 1
            if name in self.wood:
                self.wood[name] = Parts(1, 1)
        return empty

    def release(self) -> None:
        """Give everything back."""
        release_all(self.twigs, self.vertices, self.triangles, self.bare)
        release_all(*self.streams.values(), *self.told.values(), *self.hung.values())
        release_all(*(each for each in (self.far, self.met) if each is not None))
