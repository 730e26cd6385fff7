"""Drawing trees: level of detail, order, and the maps of their shade."""

from collections.abc import Callable, Iterator, Mapping, Sequence

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Point
from ...engine.gl.shaders import Texts, set_used_uniforms
from ...engine.gl.stream import release_all
from ..around.outlook import Outlook
from ..frame.block import FrameBlock
from ..frame.feature import Part, WindTextures
from ..space.grown import Grown
from ..wind.blow import mean_wind
from ..wind.mean import MeanWind
from .batch import Batch, one_of_each
from .call import Calls, DrawCall, Pass, draw
from .choice import Choice
from .kind import GpuKind
from .look import Look
from .motion import PERIOD
from .programs import HARD, SOFT, STAND, Programs
from .segments import Segment, Segments
from .shade import ShadeMap
from .shown import Shown
from .standing import Standing
from .stream import ALONE, CAST, LEAVES, GpuModel, Uniforms
from .twig import LEAF_PIXELS
from .wild import MOST_VIEWERS

EVERY_LEAF = -2.0, -1.0
"""Uniform in place of `LEAF_PIXELS` where all twigs are drawn leaf by leaf."""


class TreePart(Part):
    """Draws trees; a scene without kinds of trees costs nothing."""

    leaves_from: float | None = None
    """Height of their own pictures from which all trees are drawn leaf by leaf, for a reference, and lower ones as
    pictures [pixels]; None lets the size of leaves decide."""

    detail_eyes: Sequence[Point] = ()
    """Eyes that `leaves_from` is measured from: the nearest counts [m]. Without any, the viewer's does."""

    held = False
    """Whether level of detail stays as for the last eye where this was False."""

    hidden = False
    """Whether trees are left out, for a picture of what is behind them; their shade stays."""

    def __init__(
        self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int], standing: Callable[[], Standing],
        shading: Callable[[], Standing], *, live: bool,
    ) -> None:  # fmt: skip
        self._ctx, self._block, self._units, self._standing, self._shading = ctx, block, units, standing, shading
        self.stay = live
        """Whether trees stay chosen while a viewer hardly moves, as in a game; else a picture does not depend on those
        before it."""
        self._kinds: list[GpuKind] = []
        self._models: list[tuple[GpuKind, GpuModel]] = []
        self._declared: object = None
        self._programs: Programs | None = None
        self._shade: ShadeMap | None = None
        self._outlook: Outlook | None = None
        self._uniforms: Uniforms = {}
        self._leaves_from_chosen: float | None = None
        self._rehearsing = False
        self._inputs: object = None
        self._choices: dict[str, tuple[Standing, Choice]] = {}
        """The trees of a frame to choose from, by viewer."""
        self._batches: Sequence[Batch] = []
        """Batches of trees that are drawn."""
        self._filled: Sequence[Segment] = []
        """Segments of the vertex buffers that hold them, in the same order."""
        self._shown: Shown | None = None
        """The choice that they come from."""
        self._woods = 0
        """Its count `woods` when wood was last chosen."""
        self._calls: Calls | None = None
        self._soft_left: list[DrawCall] = []
        """Draw calls of soft edges that this frame has still to make."""
        self._segments: Segments | None = None
        self._air: WindTextures | None = None
        self._wind: MeanWind | None = None
        self._detail_eye: Doubles = np.zeros(3)
        """Eye that level of detail was chosen for [m]."""

    def settle(self, grown: Grown, record: NDArray[np.void], /) -> None:
        """Grow the scene's kinds of trees where they have changed."""
        scene = grown.scene
        self._wind = mean_wind(scene.wind)
        declared = tuple(scene.trees.values()), scene.seed
        if declared == self._declared:
            return
        release_all(*self._kinds, self._segments)
        self._declared = declared
        self._segments, self._kinds = None, []
        if scene.trees:
            self._segments = segments = Segments(self._ctx)
            self._kinds = [
                GpuKind(self._ctx, self._units, segments, kind, seed=scene.seed + number)
                for number, kind in enumerate(scene.trees.values())
            ]
        self._models = [(kind, model) for kind in self._kinds for model in kind.models]
        self._choices.clear()
        self._forget()
        if self._kinds and self._shade is None:
            self._shade = ShadeMap(self._ctx)

    def texts(self) -> Iterator[Texts]:
        """Return the sources of programs that are not compiled yet."""
        return self._present_programs().texts(in_rows=self._standing().in_rows) if self._kinds else iter(())

    def making(self) -> Iterator[None]:
        """Compile these programs, one at a time."""
        return self._present_programs().making(in_rows=self._standing().in_rows) if self._kinds else iter(())

    def rehearse(self, record: NDArray[np.void], /) -> None:
        """Draw a tree of each model in every way in the next frame."""
        self._rehearsing = True

    def _forget(self) -> None:
        self._inputs, self._batches, self._shown, self._calls = None, [], None, None
        release_all(self._programs)
        self._programs = None
        if self._shade is not None:
            self._shade.lose()

    def defines(self) -> Mapping[str, str | int]:
        """Define `TREES` for all programs if there are any kinds."""
        return {"TREES": 1} if self._kinds else {}

    def send(self, outlook: Outlook, record: NDArray[np.void], /) -> None:
        """Write the placement of the shade maps, and their sway, into the frame's record."""
        self._outlook = outlook
        if self._shade is not None and self._kinds:
            self._shade.follow(outlook.viewer.eye, self._shading(), record)
            self._shade.sway(self._standing(), self._wind, record, time=outlook.viewer.time)

    def use(self) -> None:
        """Bind the shade maps."""
        if self._shade is not None and self._kinds:
            self._shade.use()

    def prepare(self) -> int:
        """Choose each tree's level of detail, and draw shade maps that are due; return the number of draw calls."""
        if not self._kinds or self._outlook is None:
            return 0
        programs = self._present_programs()
        for kind in self._kinds:
            if kind.card is None:
                kind.bake(programs)
        viewer = self._outlook.viewer
        patch = float(self._block.record["patch_side"][0])
        self._uniforms = {
            "leaf_pixels": LEAF_PIXELS if self.leaves_from is None else EVERY_LEAF,
            "moment": (viewer.time % PERIOD,),
            "hung_from": tuple(viewer.eye),
            "middle": tuple(((viewer.centre + 0.5) * patch).tolist()),
        }
        assert self._shade is not None
        calls = self._shade.prepare(self._kinds, programs, self._shading(), self._uniforms)
        self._leaves_from_chosen = self.leaves_from
        self._choose(self._standing(), self._outlook)
        if self._rehearsing:
            self._rehearsing, self._inputs = False, None
            self._rehearse(programs)
        return calls

    def _rehearse(self, programs: Programs) -> None:
        """Let each stream draw a tree."""
        self._fill(one_of_each(len(self._models), ALONE))
        assert self._segments is not None
        self._segments.upload()
        for _, model in self._models:
            programs.array(CAST, model.bare)
            model.rehearse()

    def _present_programs(self) -> Programs:
        """Return the programs for the scene as it is now; they are compiled when first needed."""
        if self._programs is not None and self._programs.defines != self._block.defines:
            self._forget()
        if self._programs is None:
            self._programs = Programs(self._ctx, self._block, self._units)
            self._calls = Calls(self._models, self._programs)
        return self._programs

    def _choose(self, standing: Standing, outlook: Outlook) -> None:
        """Choose and send what is drawn of each tree, unless its inputs are unchanged."""
        record, viewer = self._block.record[0], outlook.viewer
        view = record["clip"].tobytes(), float(record["half_screen"][1]), viewer.eye, viewer.sides.tobytes()
        inputs = standing, *view, viewer.centre.tobytes(), self.leaves_from, self.detail_eyes, self.held
        if self._inputs == inputs:
            return
        self._inputs = inputs
        shown = self._choice(standing, viewer.name).choose(self._look(outlook))
        if shown is not self._shown:
            self._fill(shown.batches)
            self._shown, self._woods = shown, 0
        assert self._segments is not None
        self._segments.overwrite(self._changed(shown))
        self._segments.upload()
        self._show_wood(shown, viewer.sides, anew=shown.woods != self._woods)
        self._woods = shown.woods

    def _changed(self, shown: Shown) -> Iterator[tuple[Segment, int, NDArray[np.void]]]:
        """Yield the trees in the picture that are not distant, and where in their streams they are to be written."""
        for segment, rows, place in zip(self._filled, shown.rows, shown.places, strict=False):
            if place is None:
                segment.count = len(rows)
            yield segment, place or 0, rows

    def choose_anew(self) -> None:
        """Choose trees in the next frame as if it were the first."""
        self._choices.clear()
        self._inputs = None

    def _choice(self, standing: Standing, viewer: str) -> Choice:
        """Return the trees to choose from for a viewer."""
        known = self._choices.pop(viewer, None)
        if known is None or known[0] is not standing:
            models = [model.model for _, model in self._models]
            known = standing, Choice(standing, models, [kind.declared.variety for kind, _ in self._models])
        self._choices = dict([*self._choices.items(), (viewer, known)][-MOST_VIEWERS:])
        return known[1]

    def _look(self, outlook: Outlook) -> Look:
        """Return the viewpoint that trees are chosen for."""
        record, eye = self._block.record[0], np.array(outlook.viewer.eye)
        if not self.held:
            self._detail_eye = eye
        clip = record["clip"].reshape(4, 4).T.astype(np.float64)
        focal = float(record["half_screen"][1] * np.linalg.norm(clip[1, :3]))
        detail_eyes = self.detail_eyes or ((self._detail_eye,) if self.held else ())
        patch, centre = float(record["patch_side"]), outlook.viewer.centre
        reach = self._reach(outlook)
        sides, leaves_from = outlook.viewer.sides, self.leaves_from
        return Look(eye, sides, clip, focal, reach, patch, centre, detail_eyes, leaves_from, self.stay, self.held)

    def _fill(self, batches: Sequence[Batch]) -> None:
        """Write instances to be uploaded, and say where they stand."""
        assert self._segments is not None
        assert self._calls is not None
        self._batches, self._shown = batches, None
        self._filled = [self._models[batch.model][1].streams[batch.name] for batch in batches]
        self._segments.write(self._filled, [batch.parts for batch in batches])
        for batch in batches:
            if batch.name == LEAVES:
                model = self._models[batch.model][1]
                model.twigs_of_leaves = 1 if self.leaves_from is None else len(model.model.twigs)
        self._calls.choose(batches)

    def _show_wood(self, shown: Shown, sides: Doubles, *, anew: bool) -> None:
        """Choose what is drawn of wood next to the eye, and if `anew` of all; `sides` are planes of the frustum."""
        for number in shown.wood:
            batch = shown.batches[number]
            model = self._models[batch.model][1]
            if anew or model.wood_class[batch.name] == 0:
                model.show_wood(batch.name, batch.pixel_radius, batch.foliage, shown.rows[number], sides)

    def _reach(self, outlook: Outlook) -> float:
        """Return the distance up to which grass is drawn from far to near [m]."""
        *standing, _ = outlook.lens.reach_in(outlook.lens.reach)
        return (max(standing, default=-1.0) + 1.0) * float(self._block.record["patch_side"][0])

    def take_wind(self, air: WindTextures, /) -> int:
        """Run `stand.vert` for each tree and `hang.vert` for each twig; return the number of draw calls."""
        programs, calls, self._air = self._programs, 0, air
        if not self._kinds or programs is None or self._calls is None:
            return 0
        air.texture.use(self._units["tree_air"])
        air.far.use(self._units["tree_mean"])
        assert self._segments is not None
        instances, stood = self._segments.instances, self._segments.stood
        if self._batches:
            array = programs.feedback(STAND, instances)
            set_used_uniforms(array.program, self._uniforms)
            array.transform(stood.buffer, moderngl.POINTS, vertices=instances.count)
            calls = 1 + self._calls.hang(self._uniforms)
        return calls

    def draw_solid(self) -> int:
        """Draw the opaque pass; return the number of draw calls."""
        if self._kinds and self._air is not None and (self._leaves_from_chosen, self.leaves_from) != (None, None):
            self.prepare()
            self.take_wind(self._air)
        self.begin_soft()
        return draw(self._pass_calls(HARD), self._uniforms)

    def cast(self, light: tuple[float, float, float], /) -> int:
        """Draw into the depth of a shadow map; return the number of draw calls."""
        return draw(self._pass_calls(HARD, casts=True), self._uniforms)

    def begin_soft(self) -> None:
        """Begin the pass of soft edges."""
        self._soft_left = self._pass_calls(SOFT)

    def draw_soft(self, beyond: float = 0.0) -> int:
        """Draw soft edges at a distance of `beyond` or farther [m]; return the number of draw calls."""
        calls = self._soft_left
        if not calls:
            return 0
        target = self._ctx.fbo
        written, target.depth_mask = target.depth_mask, False
        ends = next((number for number, call in enumerate(calls) if call.far < beyond), len(calls))
        self._soft_left = calls[ends:]
        drawn = draw(calls[:ends], self._uniforms)
        target.depth_mask = written
        return drawn

    def soft_distance(self) -> float | None:
        """Return the distance of the farthest tree of the next soft edges, or None [m]."""
        return self._soft_left[0].far if self._soft_left else None

    def _pass_calls(self, edges: str, *, casts: bool = False) -> list[DrawCall]:
        """Return the draw calls of the pass with these edges."""
        if self._calls is None or self.hidden:
            return []
        calls = self._calls.of_pass(Pass(edges, casts, self.leaves_from is not None, self._standing().in_rows))
        return [call for call in calls if call.state.instances.count]

    def release(self) -> None:
        """Release all GL objects."""
        self._forget()
        release_all(*self._kinds, self._shade, self._segments)
