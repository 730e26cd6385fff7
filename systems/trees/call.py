"""Draw calls of trees: what each is told and reads is remembered, and which there are follows from what is chosen."""

from collections.abc import Sequence
from typing import NamedTuple

import moderngl

from ...engine.gl.shaders import PackedUniforms, pack, pack_array, set_packed, set_used_uniforms
from .card import BACKS, CARDS, FAR, IN_ROWS, LEAVES, NEAR, QUAD, WOOD, ModelOnCard, Numbers
from .choice import Lot
from .kind import KindOnCard, Read
from .outline import Around
from .programs import SAMPLED, SOFT, Programs
from .wood import CLOSED, OPAQUE, SOLID


class Pass(NamedTuple):
    """How trees are drawn."""

    edges: str
    """Which way pixels are drawn that are covered in part."""

    casts: bool = False
    """Whether into a shadow map."""

    sampled: bool = False
    """Whether as a reference has them."""

    in_rows: bool = False
    """Whether some stand for rows of trees."""


class Call(NamedTuple):
    """How trees of a stream are drawn, whichever they are."""

    array: moderngl.VertexArray
    form: int
    """How vertices make triangles."""

    vertices: int
    """So many are drawn of each; of wood, that is another number every time."""

    due: PackedUniforms
    """What its program is told of its kind, its model and of itself."""

    reads: Sequence[Read]
    """What it reads."""


class Drawn(NamedTuple):
    """One draw call of a lot of trees."""

    far: float
    """How far off the farthest of its trees is, along the ground, where they stand among the grass [m]; infinite beyond
    it, and 0 before it. Soft edges come after grass farther off."""

    turn: float
    """Those of which it is less are drawn before it: how far off its nearest tree is [m], or of soft edges, how much
    nearer than the eye its trees are in the mean."""

    call: Call
    first: int
    vertices: int
    instances: int


class Calls:
    """The draw calls of the trees that are drawn."""

    def __init__(self, models: Sequence[tuple[KindOnCard, ModelOnCard]], programs: Programs) -> None:
        self._models, self._programs = models, programs
        self._lots: Sequence[Lot] = ()
        self._made: dict[Pass, dict[tuple[int, str], Call]] = {}
        self._listed: dict[Pass, list[Drawn]] = {}

    def choose(self, lots: Sequence[Lot], /) -> None:
        """Let other trees be drawn."""
        self._lots = lots
        self._listed.clear()

    def clear(self) -> None:
        """Forget how all are drawn."""
        self._made.clear()
        self._listed.clear()

    def of(self, how: Pass, /) -> list[Drawn]:
        """Return the draw calls of a pass: solid ones from near to far, as they hide what is behind; else from far."""
        if how not in self._listed:
            soft = how.edges == SOFT
            drawn = [one for lot in self._lots if (one := self._drawn(lot, how)) is not None]
            drawn.sort(key=(lambda one: (-one.far, one.turn)) if soft else (lambda one: one.turn))
            self._listed[how] = drawn
        return self._listed[how]

    def _drawn(self, lot: Lot, how: Pass) -> Drawn | None:
        """Return how a pass draws a lot, if it does: of what is far off, soft edges have streams of their own."""
        name, soft = lot.name, how.edges == SOFT
        if (name == FAR and soft) or (name in BACKS and not soft) or (soft and how.sampled and name not in BACKS):
            return None
        made = self._made.setdefault(how, {})
        call = made.get((lot.model, name))
        if call is None:
            call = made[lot.model, name] = self._call(lot.model, name, how)
        _, model = self._models[lot.model]
        first, vertices, instances = 0, call.vertices, model.hung.get(name, model.streams[name]).count
        if name in model.wood:
            first, vertices = part_of_wood(model, name, soft=soft, whole=how.casts or how.sampled)
        turn = -lot.mean if soft else lot.nearest
        return Drawn(lot.far, turn, call, first, vertices, instances) if vertices and instances else None

    def _call(self, number: int, name: str, how: Pass) -> Call:
        kind, model = self._models[number]
        sort = LEAVES if name == LEAVES else NEAR if name in CARDS else WOOD if name in model.wood else FAR
        whole = how.edges == SOFT or how.sampled or how.casts
        outline, around = (kind.outline, model.around) if whole else (kind.core, model.core)
        corners, ends = outline if sort == NEAR else [], around if sort == FAR else None
        of_leaves = QUAD * kind.habit.leaf.quads if sort == LEAVES else 0
        drawn_as, edges = sort, SAMPLED if how.sampled and sort != FAR else how.edges
        if sort == FAR and how.in_rows:
            drawn_as = IN_ROWS
        stream = model.hung.get(name, model.streams[name])
        array = self._programs.array(drawn_as, stream, model, edges=edges)
        whole_tree = SOLID if how.casts else CLOSED if sort == FAR else OPAQUE
        own = told_of_call(array.program, corners, ends, kind.solid if sort == NEAR else whole_tree, casts=how.casts)
        told = {id(each[0]): each for each in kind.due(array.program, model) + own}
        return Call(
            array,
            moderngl.TRIANGLE_STRIP if sort in (NEAR, FAR) else moderngl.TRIANGLES,
            of_leaves + len(corners) + (0 if ends is None else 2 * len(ends.high)),
            [*told.values()],
            kind.reads(array.program, model, noise=sort in (WOOD, FAR)),
        )


def draw(calls: Sequence[Drawn], numbers: Numbers, /) -> int:
    """Draw one after another: each is told and binds only what is not so by those before it; return how many."""
    bound, programs = dict[int, object](), set[int]()
    for one in calls:
        call = one.call
        program = call.array.program
        if program.glo not in programs:
            programs.add(program.glo)
            set_used_uniforms(program, numbers)
        set_packed(call.due)
        for read in call.reads:
            if bound.get(read.unit) is not read.texture:
                bound[read.unit] = read.texture
                read.texture.use(read.unit)
        call.array.render(call.form, first=one.first, vertices=one.vertices, instances=one.instances)
    return len(calls)


def told_of_call(
    program: moderngl.Program,
    corners: list[tuple[float, float]],
    around: Around | None,
    solid_from: float,
    *,
    casts: bool,
) -> PackedUniforms:
    """Return what a program is told of a call: how much of a pixel is opaque, and the corners of an outline, if any.

    What `casts` a shadow is nowhere but where it is.
    """
    told = pack(program, {"solid_from": (solid_from,)}) + (pack(program, {"behind": (0.0,)}) if casts else [])
    if corners:
        told += pack_array(program, "corners", corners)
    if around is not None and around.high:  # else its pictures show nothing so opaque, and nothing is drawn
        told += pack(program, {"high": around.high}) + pack_array(program, "reaches", around.reaches)
    return told


def part_of_wood(model: ModelOnCard, name: str, *, soft: bool, whole: bool) -> tuple[int, int]:
    """Return from which vertex on, and how many, are drawn of the wood of a stream's trees."""
    drawn, run = model.wood[name], model.run[name]
    end = len(model.model.wood[run].triangles) if whole else drawn.soft if soft else drawn.solid
    return 3 * model.first_of[run], 3 * end
