"""Drawing trees: what of each is shown, and in what order; and the maps of what they leave of the light."""

from collections.abc import Callable, Iterator, Mapping, Sequence

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles
from ...engine.camera import Place
from ...engine.gl.shaders import Texts, set_used_uniforms
from ...engine.gl.stream import Stream, release_all
from ..around.outlook import Outlook
from ..frame.block import FrameBlock
from ..frame.feature import Heard, Part
from ..space.grown import Grown
from ..wind.blow import mean_wind
from ..wind.mean import MeanWind
from .call import Calls, Drawn, Pass, draw
from .card import CARDS, CAST, LEAVES, ModelOnCard, Numbers
from .choice import Choice, Chosen, Look, Lot, lone
from .kind import KindOnCard
from .motion import PERIOD
from .programs import HANG, HANG_LEAVES, HARD, SOFT, STAND, Programs
from .shade import ShadeMap
from .standing import PLACED, TOLD, Standing
from .twig import LEAF_PIXELS

EVERY_LEAF = -2.0, -1.0
"""What is told in place of `LEAF_PIXELS` where all twigs are drawn leaf by leaf."""


class TreePart(Part):
    """Draws trees; in scenes that have no kind of them it makes nothing at all."""

    def __init__(
        self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int], standing: Callable[[], Standing],
        shading: Callable[[], Standing],
    ) -> None:  # fmt: skip
        self._ctx, self._block, self._units, self._standing, self._shading = ctx, block, units, standing, shading
        self._kinds: list[KindOnCard] = []
        self._models: list[tuple[KindOnCard, ModelOnCard]] = []
        self._made_of: object = None
        self._programs: Programs | None = None
        self._shade: ShadeMap | None = None
        self._outlook: Outlook | None = None
        self._numbers: Numbers = {}
        self._chosen: float | None = None
        self._rehearses = False
        self._chosen_by: object = None
        self._choice: tuple[Standing, Choice] | None = None
        """The trees of a frame, to be chosen among."""
        self._lots: list[Lot] = []
        """Those that are drawn."""
        self._calls: Calls | None = None
        self._soft_left: list[Drawn] = []
        """Which of them with soft edges this frame has still to draw."""
        self._placed: Stream | None = None
        """All trees of all streams, one stream after another; and what is made out of them."""
        self._stood: Stream | None = None
        self._air: Heard | None = None
        self._wind: MeanWind | None = None
        self.leaves_from: float | None = None
        """Height of their own pictures from which all trees are drawn leaf by leaf [pixels], as a reference has them,
        and lower ones as they are far off; None where that is for the size of their leaves to say."""
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
        self._models = [(kind, model) for kind in self._kinds for model in kind.models]
        self._lots, self._choice = [], None
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
        self._chosen_by = self._calls = None
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
            self._draw_all(programs)
        return calls

    def _draw_all(self, programs: Programs) -> None:
        """Have a tree of each model drawn in every way that there is."""
        assert self._placed is not None
        count = self._placed.count
        for number, (_, model) in enumerate(self._models):
            programs.array(CAST, model.bare)
            self._lots += [lone(number, name, count + more) for more, name in enumerate(model.rehearse())]
            count = self._lots[-1].first + 1
        self._place(np.zeros(count, PLACED))

    def _ready(self) -> Programs:
        """Return the programs, made and with all kinds baked."""
        if self._programs is not None and self._programs.made_of != self._block.defines:
            self._forget()
        if self._programs is None:
            self._programs = Programs(self._ctx, self._block, self._units)
            self._calls = Calls(self._models, self._programs)
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
        if self._choice is None or self._choice[0] is not standing:
            models = [model.model for _, model in self._models]
            self._choice = standing, Choice(standing, models, [kind.declared.variety for kind, _ in self._models])
        self._send(self._choice[1].of(self._look(outlook)))

    def _look(self, outlook: Outlook) -> Look:
        """Return from where trees are seen, and how."""
        record, eye = self._block.record[0], np.array(outlook.viewer.eye)
        if not self.held:
            self._from = eye
        clip = record["clip"].reshape(4, 4).T.astype(np.float64)
        focal = float(record["half_screen"][1] * np.linalg.norm(clip[1, :3]))
        seen_at: Sequence[Place | Doubles] = (self._from,) if self.held else ()
        if self.leaves_from is not None and self.leaves_seen_at:
            seen_at = self.leaves_seen_at
        return Look(eye, outlook.viewer.sides, clip, focal, self._reach(outlook), seen_at, self.leaves_from)

    def _send(self, chosen: Chosen) -> None:
        """Send trees to be drawn, and where they stand."""
        before, (self._lots, told, placed) = self._lots, chosen
        for number, name in {(lot.model, lot.name) for lot in before} - {(lot.model, lot.name) for lot in self._lots}:
            self._models[number][1].empty(name)
        for lot, rows in zip(self._lots, told, strict=True):
            _, model = self._models[lot.model]
            model.write(lot.name, rows)
            if lot.name in model.wood:
                model.show_wood(lot.name, lot.wide, lot.foliage)
            elif lot.name in CARDS:
                model.show_cards(lot.name, lot.keep, lot.leaves)
            elif lot.name == LEAVES:
                model.most[LEAVES] = 1 if self.leaves_from is None else len(model.model.twigs)
        self._place(placed)

    def _place(self, placed: NDArray[np.void]) -> None:
        """Send where all trees stand that are drawn."""
        assert self._placed is not None
        assert self._stood is not None
        assert self._calls is not None
        self._calls.choose(self._lots)
        self._placed.write(placed)
        self._stood.room(len(placed))

    def _reach(self, outlook: Outlook) -> float:
        """Return how far off grass stands that is drawn from far to near [m]."""
        *standing, _ = outlook.lens.reach_in(outlook.lens.reach)
        return (max(standing, default=-1.0) + 1.0) * float(self._block.record["patch_side"][0])

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
            set_used_uniforms(array.program, self._numbers)
            array.transform(self._stood.buffer, moderngl.POINTS, vertices=self._placed.count)
            calls = 1
        for lot in self._lots:
            _, model = self._models[lot.model]
            told = model.told[id(model.streams[lot.name])]
            self._ctx.copy_buffer(
                told.buffer, self._stood.buffer, lot.amount * TOLD.itemsize, read_offset=lot.first * TOLD.itemsize
            )
        return calls + sum(self._hang(lot, programs) for lot in self._lots if lot.name in CARDS or lot.name == LEAVES)

    def _hang(self, lot: Lot, programs: Programs) -> int:
        """Make out of each twig what is the same all over its card; return the number of draw calls."""
        (kind, model), name = self._models[lot.model], lot.name
        stream, hung, most = model.streams[name], model.hung[name], model.most[name]
        hung.room(lot.amount * most)
        if not hung.count:
            return 0
        array = programs.made(HANG_LEAVES if name == LEAVES else HANG, stream, model.told[id(stream)])
        kind.tell(array.program, model, self._numbers, {"whole": (most == len(model.model.twigs),)})
        array.transform(hung.buffer, moderngl.POINTS, vertices=most, instances=lot.amount)
        return 1

    def draw_solid(self) -> int:
        """Draw all that covers pixels wholly."""
        if self._kinds and self._air is not None and (self._chosen, self.leaves_from) != (None, None):
            self.prepare()
            self.breathe(self._air)
        self.begin_soft()
        return draw(self._of(HARD), self._numbers)

    def cast(self, light: tuple[float, float, float], /) -> int:
        """Write the depth of all that covers most of a texel of a shadow map."""
        del light
        return draw(self._of(HARD, casts=True), self._numbers)

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
        self._soft_left = calls[ends:]
        drawn = draw(calls[:ends], self._numbers)
        target.depth_mask = written
        return drawn

    def soft_left(self) -> float | None:
        """Return how far off the farthest tree of the next of them is."""
        return self._soft_left[0].far if self._soft_left else None

    def _of(self, edges: str, *, casts: bool = False) -> list[Drawn]:
        """Return what is drawn with such edges."""
        if self._calls is None or self.hidden:
            return []
        return self._calls.of(Pass(edges, casts, self.leaves_from is not None, self._standing().in_rows))

    def release(self) -> None:
        """Give everything back."""
        self._forget()
        release_all(*self._kinds)
        for each in (self._shade, self._placed, self._stood):
            if each is not None:
                each.release()
