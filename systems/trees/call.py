"""Draw calls of trees: the state of each stream is kept, and the batches of a frame say which are drawn."""

from collections.abc import Sequence
from math import inf, nextafter
from typing import NamedTuple

import moderngl

from ...engine.gl.shaders import PackedUniforms, pack, pack_array, set_packed, set_used_uniforms
from ...engine.gl.stream import Stream
from .batch import Batch
from .habit import NEEDLES
from .kind import Binding, GpuKind
from .outline import Outline
from .programs import HANG, HANG_LEAVES, SAMPLED, SOFT, Programs
from .segments import Segment
from .stream import BACKS, CARDS, FAR, IN_ROWS, LEAVES, NEAR, QUAD, SMALL_CARDS, WOOD, GpuModel, Uniforms
from .twig import BLOCK
from .wood import CLOSED, OPAQUE, SOLID

SENT = object()
"""Key in a program's `extra` of the numbers that it was last drawn with: each frame has its own."""


class Pass(NamedTuple):
    """One of the passes that draw trees."""

    edges: str
    """How pixels covered in part are drawn: `HARD` or `SOFT`."""

    casts: bool = False
    """Whether it draws into a shadow map."""

    sampled: bool = False
    """Whether it draws each sample of a pixel, for a reference."""

    in_rows: bool = False
    """Whether some trees stand for rows of trees."""


class WoodPart(NamedTuple):
    """What a pass draws of the wood of a stream."""

    model: GpuModel
    name: str
    """Name of the stream."""

    soft: bool
    whole: bool
    """Whether all of it is drawn, for a shadow map or a reference."""

    def vertices(self) -> tuple[int, int]:
        """Return the first vertex and the number of vertices in this frame."""
        drawn, wood_class = self.model.wood[self.name], self.model.wood_class[self.name]
        first, end = (drawn.soft_from, drawn.soft) if self.soft else (drawn.solid_from, drawn.solid)
        if self.whole:
            first, end = 0, len(self.model.model.wood[wood_class].whole.triangles)
        return 3 * (self.model.first_triangle[2 * wood_class + self.soft] + first), 3 * (end - first)


class State(NamedTuple):
    """Draw state of a model's stream, whichever trees are in it."""

    array: moderngl.VertexArray
    instances: Stream | Segment
    """The stream's instances, or what `hang.vert` made of them."""

    wood: WoodPart | None
    """The wood that it draws, if any."""

    mode: int
    """How vertices make triangles."""

    vertices: int
    """Number of vertices of an instance, but for wood."""

    uniforms: PackedUniforms
    """Uniforms of its kind, its model and its own."""

    textures: Sequence[Binding]
    """Textures that it reads, and their units."""


class DrawCall(NamedTuple):
    """A draw call of one batch."""

    far: float
    """Distance of its farthest tree along the ground [m], and 0 in front of the grass. Soft edges come after grass
    farther off; beyond it, theirs is the mean distance."""

    order: float
    """Calls with a lower value are drawn first: distance of the nearest tree, or of pictures far off the mean distance,
    as most are hidden by those of other models; for soft edges the negative mean distance [m]."""

    state: State


States = dict[tuple[int, str], State | None]
"""States by model and stream."""


class Bound:
    """What is bound while calls are made one after another: only what differs from the state before is set."""

    def __init__(self, numbers: Uniforms) -> None:
        self._numbers, self._textures = numbers, dict[int, object]()

    def use(self, state: State) -> None:
        """Set a state's uniforms, and bind its textures."""
        program = state.array.program
        if program.extra.get(SENT) is not self._numbers:  # soft edges come in many pieces
            program.extra[SENT] = self._numbers
            set_used_uniforms(program, self._numbers)
        set_packed(state.uniforms)
        for texture, unit in state.textures:
            if self._textures.get(unit) is not texture:
                self._textures[unit] = texture
                texture.use(unit)


class Calls:
    """The draw calls of the trees in a picture."""

    def __init__(self, models: Sequence[tuple[GpuKind, GpuModel]], programs: Programs) -> None:
        self._models, self._programs = models, programs
        self._batches: Sequence[Batch] = ()
        self._states: dict[Pass, States] = {}
        self._hanging: dict[tuple[int, str], State] = {}
        self._calls: dict[Pass, list[DrawCall]] = {}

    def choose(self, batches: Sequence[Batch], /) -> None:
        """Take the batches that are drawn."""
        self._batches = batches
        self._calls.clear()

    def clear(self) -> None:
        """Forget the state of all streams."""
        self._states.clear()
        self._hanging.clear()
        self._calls.clear()

    def hang(self, numbers: Uniforms, /) -> int:
        """Run `hang.vert` for the twigs of all batches; return the number of draw calls."""
        bound, calls = Bound(numbers), 0
        for batch in self._batches:
            if batch.name not in CARDS and batch.name != LEAVES:
                continue
            model = self._models[batch.model][1]
            hung, each = model.hung[batch.name], model.twigs_of_leaves if batch.name == LEAVES else BLOCK
            instances = model.streams[batch.name].count
            hung.room(instances * each)
            if not instances:
                continue
            bound.use(state := self._hanging_state(batch.model, batch.name))
            state.array.transform(hung.buffer, moderngl.POINTS, vertices=each, instances=instances)
            calls += 1
        return calls

    def _hanging_state(self, number: int, name: str) -> State:
        """Return the state that `hang.vert` runs in for a stream of twigs."""
        if (key := (number, name)) not in self._hanging:
            kind, model = self._models[number]
            array = self._programs.feedback(HANG_LEAVES if name == LEAVES else HANG, model.streams[name])
            uniforms, textures = kind.uniforms(array.program, model), kind.textures(array.program, model)
            self._hanging[key] = State(array, model.streams[name], None, moderngl.POINTS, 0, uniforms, textures)
        return self._hanging[key]

    def of_pass(self, how: Pass, /) -> list[DrawCall]:
        """Return a pass's draw calls in order: opaque ones from near to far, soft edges from far to near."""
        if how not in self._calls:
            soft = how.edges == SOFT
            calls = [call for batch in self._batches if (call := self._call(batch, how)) is not None]
            calls.sort(key=(lambda call: (-call.far, call.order)) if soft else (lambda call: call.order))
            self._calls[how] = calls
        return self._calls[how]

    def _call(self, batch: Batch, how: Pass) -> DrawCall | None:
        """Return the draw call of a batch in a pass, or None."""
        key, soft, states = (batch.model, batch.name), how.edges == SOFT, self._states.setdefault(how, {})
        if key not in states:
            states[key] = self._state(*key, how)
        state = states[key]
        if state is None:
            return None
        order = self._order(batch) if soft else batch.mean if batch.name == FAR else batch.nearest
        far = -order if soft and batch.far == inf else batch.far
        return DrawCall(far, order, state) if state.wood is not None or state.vertices else None

    def _order(self, batch: Batch) -> float:
        """Return the order of a batch's soft edges: the farthest come first, and stems before the needles on them.

        Hardly a needle covers a pixel wholly. So needles hide stems only by being blended over them, as leaves' opaque
        pixels do by their depth.
        """
        kind, model = self._models[batch.model]
        if batch.name not in model.wood or kind.habit.leaf.form != NEEDLES:
            return -batch.mean
        cards = [each.mean for each in self._batches if each.model == batch.model and each.name in CARDS]
        return nextafter(-max([batch.mean, *cards]), -inf)

    def _state(self, number: int, name: str, how: Pass) -> State | None:
        """Return the state of a stream, or None where a pass does not draw it: far pictures have streams for each."""
        soft = how.edges == SOFT
        if (name == FAR and soft) or (name in BACKS and not soft) or (soft and how.sampled and name not in BACKS):
            return None
        kind, model = self._models[number]
        sort = LEAVES if name == LEAVES else NEAR if name in CARDS else WOOD if name in model.wood else FAR
        whole = soft or how.sampled or how.casts
        card, picture = (kind.outline, model.outline) if whole else (kind.solid_outline, model.solid_outline)
        if name in SMALL_CARDS and not (how.sampled or how.casts):
            card = kind.triangle if soft else kind.solid_triangle
        corners, outline = card if sort == NEAR else [], picture if sort == FAR else None
        of_leaves = QUAD * kind.habit.leaf.quads if sort == LEAVES else 0
        drawn_as, edges = sort, SAMPLED if how.sampled and sort != FAR else how.edges
        if sort == FAR and how.in_rows:
            drawn_as = IN_ROWS
        stream = model.hung.get(name) or model.streams[name]
        array = self._programs.array(drawn_as, stream, model, edges=edges)
        whole_tree = SOLID if how.casts else CLOSED if sort == FAR else OPAQUE
        own_uniforms = uniforms_of(
            array.program, corners, outline, kind.solid if sort == NEAR else whole_tree, casts=how.casts
        )
        uniforms = {id(each[0]): each for each in kind.uniforms(array.program, model) + own_uniforms}
        return State(
            array,
            stream,
            WoodPart(model, name, soft, how.casts or how.sampled) if sort == WOOD else None,
            moderngl.TRIANGLE_STRIP if sort in (NEAR, FAR) else moderngl.TRIANGLES,
            of_leaves + len(corners) + (0 if outline is None else 2 * len(outline.high)),
            [*uniforms.values()],
            kind.textures(array.program, model, noise=sort in (WOOD, FAR)),
        )


def draw(calls: Sequence[DrawCall], numbers: Uniforms, /) -> int:
    """Make draw calls one after another; return their number."""
    bound, drawn = Bound(numbers), 0
    for call in calls:
        state = call.state
        first, vertices = (0, state.vertices) if state.wood is None else state.wood.vertices()
        if vertices and state.instances.count:
            bound.use(state)
            state.array.render(state.mode, first=first, vertices=vertices, instances=state.instances.count)
            drawn += 1
    return drawn


def uniforms_of(
    program: moderngl.Program,
    corners: list[tuple[float, float]],
    outline: Outline | None,
    solid_from: float,
    *,
    casts: bool,
) -> PackedUniforms:
    """Return the uniforms of a stream: coverage from which on pixels are opaque, and the corners of an outline, if any.

    In a shadow map (`casts`), nothing is moved behind its place.
    """
    uniforms = pack(program, {"solid_from": (solid_from,)}) + (pack(program, {"behind": (0.0,)}) if casts else [])
    if corners:
        uniforms += pack_array(program, "corners", corners)
    if outline is not None and outline.high:  # else nothing in its pictures is so dense, and nothing is drawn
        uniforms += pack(program, {"high": outline.high}) + pack_array(program, "reaches", outline.reaches)
    return uniforms
