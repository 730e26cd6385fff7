"""Drawing trees: what of each is shown, and in what order; and the maps of what they leave of the light."""

from collections.abc import Callable, Iterator, Mapping, Sequence

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles
from ...engine.camera import Place
from ...engine.gl.shaders import Texts, tell_asked, tell_due
from ...engine.gl.stream import Stream, release_all
from ..around.outlook import Outlook
from ..frame.block import FrameBlock
from ..frame.feature import Heard, Part
from ..space.grown import Grown
from ..wind.blow import mean_wind
from ..wind.mean import MeanWind
from .call import Call, bound_by, in_turn, off_of, part_of_wood, told_of_call
from .card import BACKS, CARDS, CAST, FAR, IN_ROWS, LEAVES, NEAR, QUAD, SHELL_OF, WOOD, WOODS, ModelOnCard, Numbers
from .group import Group
from .kind import KindOnCard
from .leafy import leaf_by_leaf, leafy
from .motion import PERIOD
from .programs import HANG, HANG_LEAVES, HARD, SAMPLED, SOFT, STAND, Programs
from .shade import ShadeMap
from .shells import farthest_of, shells_of
from .standing import LEAFY, PLACED, TOLD, Standing, columns_of, shown, shows
from .twig import LEAF_PIXELS
from .wood import AWAY, CLOSED, OPAQUE, SOLID, SWAYS, THINNEST, nearest_ahead

EVERY_LEAF = -2.0, -1.0
"""What is told in place of `LEAF_PIXELS` where all twigs are drawn leaf by leaf."""

NEAREST = 0.1
"""How far off a tree's middle counts as at least [m]."""

ANY_HEIGHT = 1e6
"""Height in the picture at which a tree is drawn with all that it has [pixels]."""


class TreePart(Part):
    """Draws trees; in scenes that have no kind of them it makes nothing at all."""

    def __init__(
        self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int], standing: Callable[[], Standing],
        shading: Callable[[], Standing],
    ) -> None:  # fmt: skip
        self._ctx, self._block, self._units, self._standing, self._shading = ctx, block, units, standing, shading
        self._kinds: list[KindOnCard] = []
        self._made_of: object = None
        self._programs: Programs | None = None
        self._shade: ShadeMap | None = None
        self._outlook: Outlook | None = None
        self._numbers: Numbers = {}
        self._chosen: float | None = None
        self._rehearses = False
        self._chosen_by: object = None
        self._groups: dict[tuple[int, int], Group] = {}
        self._grouped: Standing | None = None
        """The trees of each model by its kind's number and its own, and of which frame they are."""
        self._calls: dict[tuple[str, bool], list[Call]] = {}
        """What is drawn, until something else is chosen: with which edges, with all wood or not."""
        self._soft_left: list[Call] = []
        """Which of them with soft edges this frame has still to draw."""
        self._placed: Stream | None = None
        """All trees of all streams, one stream after another; and what is made out of them."""
        self._stood: Stream | None = None
        self._air: Heard | None = None
        self._wind: MeanWind | None = None
        self.leaves_from: float | None = None
        """Height from which all trees are drawn leaf by leaf [pixels], as a reference has them, and lower ones as they
        are far off; None where that is for the size of their leaves to say."""
        self.leaves_seen_at: Sequence[Place] = ()
        """From where that height is seen: it is the greatest of all these places [m]; without any, the viewer's."""
        self.held = False
        """Whether as much of each is shown as in the last frame where this was not so, wherever the viewer is."""
        self.hidden = False
        """Whether they are left out, for a picture of what is behind them; their shade stays."""
        self._from: Doubles = np.zeros(3)
        """From where what is shown of each was chosen [m]."""

    def settle(self, grown: Grown, record: NDArray[np.void], /) -> None:
        """Let other kinds of trees grow."""
        del record
        scene = grown.scene
        self._wind = mean_wind(scene.wind)
        made_of = tuple(scene.trees.values()), scene.seed
        if made_of == self._made_of:
            return
        release_all(*self._kinds)
        self._made_of = made_of
        self._kinds = [
            KindOnCard(self._ctx, self._units, kind, seed=scene.seed + number)
            for number, kind in enumerate(scene.trees.values())
        ]
        self._forget()
        if self._kinds and self._shade is None:
            self._shade = ShadeMap(self._ctx)
            self._placed, self._stood = Stream(self._ctx, PLACED), Stream(self._ctx, TOLD)

    def texts(self) -> Iterator[Texts]:
        """Return what its programs that are not there yet are made of."""
        return iter(()) if self._programs is None else self._programs.texts(in_rows=self._standing().in_rows)

    def making(self) -> Iterator[None]:
        """Make them, one at a time."""
        return iter(()) if self._programs is None else self._programs.making(in_rows=self._standing().in_rows)

    def rehearse(self, record: NDArray[np.void], /) -> None:
        """Pretend until the next frame that a tree of each model is drawn in every way that there is."""
        del record
        self._rehearses = True

    def _forget(self) -> None:
        self._chosen_by = self._grouped = None
        self._calls = {}
        if self._programs is not None:
            self._programs.release()
            self._programs = None
        if self._shade is not None:
            self._shade.lose()

    def defines(self) -> Mapping[str, str | int]:
        """Tell all programs whether there are any kinds."""
        return {"TREES": 1} if self._kinds else {}

    def send(self, outlook: Outlook, record: NDArray[np.void], /) -> None:
        """Write where the maps lie for a viewer."""
        self._outlook = outlook
        if self._shade is not None and self._kinds:
            self._shade.follow(outlook.viewer.eye, self._shading(), record)
            self._shade.sway(self._standing(), self._wind, record, time=outlook.viewer.time)

    def use(self) -> None:
        """Bind the map."""
        if self._shade is not None and self._kinds:
            self._shade.use()

    def prepare(self) -> int:
        """Choose what is drawn of each tree, and draw the maps where they are due; return the number of draw calls."""
        if not self._kinds or self._outlook is None:
            return 0
        programs = self._ready()
        viewer = self._outlook.viewer
        patch = float(self._block.record["patch_side"][0])
        self._numbers = {
            "leaf_pixels": LEAF_PIXELS if self.leaves_from is None else EVERY_LEAF,
            "moment": (viewer.time % PERIOD,),
            "middle": tuple(((viewer.centre + 0.5) * patch).tolist()),
        }
        assert self._shade is not None
        calls = self._shade.prepare(self._kinds, programs, self._shading(), self._numbers)
        self._chosen = self.leaves_from
        self._choose(self._standing(), self._outlook)
        if self._rehearses:
            self._rehearses, self._chosen_by = False, None
            for kind in self._kinds:
                for model in kind.models:
                    model.rehearse()
                    programs.array(CAST, model.bare)
            self._place()
        return calls

    def _ready(self) -> Programs:
        """Return the programs, made and with all kinds baked."""
        if self._programs is not None and self._programs.made_of != self._block.defines:
            self._forget()
        if self._programs is None:
            self._programs = Programs(self._ctx, self._block, self._units)
        for kind in self._kinds:
            if kind.card is None:
                kind.bake(self._programs)
        return self._programs

    def _choose(self, standing: Standing, outlook: Outlook) -> None:
        """Send what is drawn of each tree, unless that is what was sent last."""
        record, viewer = self._block.record[0], outlook.viewer
        seen = record["clip"].tobytes(), float(record["half_screen"][1]), viewer.eye, viewer.sides.tobytes()
        chosen_by = standing, *seen, self.leaves_from, self.leaves_seen_at, self.held
        if self._chosen_by == chosen_by:
            return
        self._chosen_by = chosen_by
        if not self.held:
            self._from = np.array(viewer.eye)
        clip = record["clip"].reshape(4, 4).T.astype(np.float64)
        focal = float(record["half_screen"][1] * np.linalg.norm(clip[1, :3]))
        for kind_number, kind in enumerate(self._kinds):
            for model_number, model in enumerate(kind.models):
                if self._grouped is not standing:
                    self._groups, self._grouped = {}, standing
                number = kind_number, model_number
                if number not in self._groups:
                    self._groups[number] = Group(standing.of(*number), model.model)
                group = self._groups[number]
                if len(group.rows) or any(stream.count for stream in model.streams.values()):
                    self._choose_of(kind, model, group, clip, focal, outlook)
        self._place()

    def _shown(self) -> list[tuple[ModelOnCard, str]]:
        """Return which streams of which models have trees."""
        return [
            (model, name)
            for kind in self._kinds for model in kind.models for name, stream in model.streams.items() if stream.count
        ]  # fmt: skip

    def _place(self) -> None:
        """Send where all trees stand that are drawn."""
        assert self._placed is not None
        assert self._stood is not None
        self._calls = {}
        parts = [model.placed[name] for model, name in self._shown()]
        self._placed.write(np.concatenate([np.zeros(0, PLACED), *parts]))
        self._stood.room(self._placed.count)

    def _choose_of(
        self,
        kind: KindOnCard,
        model: ModelOnCard,
        group: Group,
        clip: Doubles,
        focal: float,
        outlook: Outlook,
    ) -> None:
        grown, eye = model.model, np.array(outlook.viewer.eye)
        ball = np.hypot(grown.half, grown.radius)
        seen = group.seen(outlook.viewer.sides)
        off = np.linalg.norm(group.middle[seen] - eye, axis=1)
        order = np.argsort(off)
        seen, off = seen[order], off[order]
        rows, scale, middle = group.rows[seen], group.scale[seen], group.middle[seen]
        along = np.hypot(middle[:, 0] - eye[0], middle[:, 2] - eye[2])
        pixels = focal * rows["height"] / np.maximum(self._chosen_off(middle, off), NEAREST)
        if self.leaves_from is not None:
            pixels = np.where(pixels <= self.leaves_from, 0.0, ANY_HEIGHT)
        pixels[rows["ring"] > 1] = 0.0
        told = shown(rows, pixels, grown.height, kind.declared.variety)
        told["columns"] = columns_of(rows, scale * grown.radius)
        told["shows"] = shows(rows["ring"], along)
        near, far = told["gone"] < 1.0, told["gone"] > 0.0
        large = focal * scale * kind.habit.leaf.length / LEAF_PIXELS[0]
        large_leaves = large > off - scale * ball
        if self.leaves_from is not None:
            twigs = leaf_by_leaf(told[near], 0)
        else:
            twigs = np.concatenate([
                np.zeros(0, LEAFY),
                *(leafy(grown, told[number], outlook.viewer, large[number]) for number in np.flatnonzero(large_leaves)),
            ])  # fmt: skip
        ahead = nearest_ahead(clip, middle, eye, (1.0 + SWAYS) * scale[:, None] * (ball, grown.radius))
        wide = THINNEST * np.maximum(ahead, AWAY) / (focal * scale)
        model.write(told[near], wide[near], twigs, told[far], shells_of(along[near], along[far], self._reach(outlook)))
        if self.leaves_from is not None:
            model.most[LEAVES] = len(grown.twigs)

    def _reach(self, outlook: Outlook) -> float:
        """Return how far off grass stands that is drawn from far to near [m]."""
        *standing, _ = outlook.lens.reach_in(outlook.lens.reach)
        return (max(standing, default=-1.0) + 1.0) * float(self._block.record["patch_side"][0])

    def _chosen_off(self, middle: Doubles, off: Doubles) -> Doubles:
        """Return how far off trees (n, 3) count for what is shown of them, that are so far off [m], shape (n,)."""
        if self.leaves_from is not None and self.leaves_seen_at:
            return np.asarray(np.min([np.linalg.norm(middle - eye, axis=1) for eye in self.leaves_seen_at], axis=0))
        return np.asarray(np.linalg.norm(middle - self._from, axis=1)) if self.held else off

    def breathe(self, air: Heard, /) -> int:
        """Make out of each tree what is the same all over it; return the number of draw calls."""
        programs, calls, self._air = self._programs, 0, air
        if not self._kinds or programs is None:
            return 0
        air.texture.use(self._units["tree_air"])
        air.mean.use(self._units["tree_mean"])
        assert self._placed is not None
        assert self._stood is not None
        if self._placed.count:
            array = programs.made(STAND, self._placed)
            tell_asked(array.program, self._numbers)
            array.transform(self._stood.buffer, moderngl.POINTS, vertices=self._placed.count)
            calls = 1
        first = 0
        for model, name in self._shown():
            told = model.told[id(model.streams[name])]
            size = told.count * TOLD.itemsize
            self._ctx.copy_buffer(told.buffer, self._stood.buffer, size, read_offset=first)
            first += size
        for kind in self._kinds:
            for model in kind.models:
                calls += self._hang(kind, model, programs)
        return calls

    def _hang(self, kind: KindOnCard, model: ModelOnCard, programs: Programs) -> int:
        """Make out of each twig what is the same all over its card; return the number of draw calls."""
        calls = 0
        for name in (*CARDS, LEAVES):
            stream, hung, most = model.streams[name], model.hung[name], model.most[name]
            hung.room(stream.count * most)
            if hung.count:
                made = HANG_LEAVES if name == LEAVES else HANG
                array = programs.made(made, stream, model.told[id(stream)])
                kind.tell(array.program, model, self._numbers, {"whole": (most == len(model.model.twigs),)})
                array.transform(hung.buffer, moderngl.POINTS, vertices=most, instances=stream.count)
                calls += 1
        return calls

    def draw_solid(self) -> int:
        """Draw all that covers pixels wholly."""
        if self._kinds and self._air is not None and (self._chosen, self.leaves_from) != (None, None):
            self.prepare()
            self.breathe(self._air)
        self.begin_soft()
        return self._draw(self._of(HARD))

    def cast(self, light: tuple[float, float, float], /) -> int:
        """Write the depth of all that covers most of a texel of a shadow map."""
        del light
        return self._draw(self._of(HARD, all_wood=True))

    def begin_soft(self) -> None:
        """Have all soft edges of a frame left to draw."""
        self._soft_left = self._of(SOFT)

    def draw_soft(self, beyond: float = 0.0) -> int:
        """Draw their soft edges that are so far off at least."""
        calls = self._soft_left
        if not calls:
            return 0
        target = self._ctx.fbo
        written, target.depth_mask = target.depth_mask, False
        ends = next((number for number, call in enumerate(calls) if call.far < beyond), len(calls))
        for read in bound_by(self._of(SOFT)[: -len(calls)]):
            read.texture.use(read.unit)
        self._soft_left = calls[ends:]
        drawn = self._draw(calls[:ends])
        target.depth_mask = written
        return drawn

    def soft_left(self) -> float | None:
        """Return how far off the farthest tree of the next of them is."""
        return self._soft_left[0].far if self._soft_left else None

    def _of(self, edges: str, *, all_wood: bool = False) -> list[Call]:
        """Return what is drawn with such edges."""
        if not self._kinds or self._programs is None or self.hidden:
            return []
        key = edges, all_wood
        if key not in self._calls:
            self._calls[key] = self._listed(self._programs, edges, all_wood=all_wood)
        return self._calls[key]

    def _draw(self, calls: list[Call]) -> int:
        for call in calls:
            if call.begins:
                tell_asked(call.array.program, self._numbers)
            tell_due(call.due)
            for read in call.reads:
                read.texture.use(read.unit)
            call.array.render(call.form, first=call.first, vertices=call.vertices, instances=call.instances)
        return len(calls)

    def _listed(self, programs: Programs, edges: str, *, all_wood: bool) -> list[Call]:
        """Return what is drawn: what is solid from near to far, as it hides what is drawn after it; else from far."""
        calls = list[Call]()
        soft, sampled = edges == SOFT, self.leaves_from is not None
        whole = soft or sampled or all_wood
        assert self._outlook is not None
        of_far, eye = IN_ROWS if self._standing().in_rows else FAR, np.array(self._outlook.viewer.eye)
        for kind in self._kinds:
            for model in kind.models:
                outline, around = (kind.outline, model.around) if whole else (kind.core, model.core)
                for sort, name, first, vertices in (
                    (LEAVES, LEAVES, 0, QUAD * kind.habit.leaf.quads),
                    *((NEAR, name, 0, len(outline)) for name in CARDS),
                    *((WOOD, name, *part_of_wood(model, name, soft=soft, whole=all_wood or sampled)) for name in WOODS),
                    *((FAR, name, 0, 2 * len(around.high)) for name in (BACKS if soft else (FAR,))),
                ):
                    stream = model.hung.get(name, model.streams[name])
                    if stream.count and vertices > 0 and not (soft and sampled and sort != FAR):
                        drawn_as, sampling = (of_far, edges) if sort == FAR else (sort, SAMPLED if sampled else edges)
                        array = programs.array(drawn_as, stream, model, edges=sampling)
                        off, along = off_of(model.placed[name], eye)
                        turn = -float(off.mean()) if soft else float(off.min())
                        whole_tree = SOLID if all_wood else CLOSED if sort == FAR else OPAQUE
                        opaque = kind.solid if name in CARDS else whole_tree
                        corners, ends = outline if name in CARDS else [], around if sort == FAR else None
                        of_call = told_of_call(array.program, corners, ends, opaque, casts=all_wood)
                        told = kind.due(array.program, model) + of_call
                        reads = kind.reads(array.program, model, noise=sort in (WOOD, FAR))
                        form = moderngl.TRIANGLE_STRIP if name in CARDS or sort == FAR else moderngl.TRIANGLES
                        far = farthest_of(SHELL_OF[name], along)
                        calls.append(Call(turn, array, first, vertices, stream.count, form, told, reads, far))
        return in_turn(sorted(calls, key=lambda call: (-call.far if soft else 0.0, call.turn)))

    def release(self) -> None:
        """Give everything back."""
        self._forget()
        release_all(*self._kinds)
        for each in (self._shade, self._placed, self._stood):
            if each is not None:
                each.release()
