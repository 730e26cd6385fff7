"""What a representation of the grass is to everything that does not draw it itself."""

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Levels, Mask, Rows
from ...engine.declared.grass import GrassKind
from ...engine.declared.quality import Quality
from ...engine.gl.shaders import Texts
from ..around.kept import Kept
from ..around.outlook import Outlook
from ..around.patches import PatchTable
from ..around.transitions import Transitions
from ..frame.block import FrameBlock
from ..frame.feature import Heard, Part
from ..grow.record import NOTHING, Blades, Growth, Postures
from ..receive.received import Received
from ..space.ground import Ground
from ..space.grown import Grown
from ..wind.card import CardWinds

Color = tuple[float, float, float]


@dataclass(frozen=True, slots=True, eq=False)
class Seedling:
    """What the pictures of one patch model are grown from: its blades, and what all its kind's models share."""

    blades: Blades
    postures: Postures
    kind: GrassKind
    quality: Quality
    height: float
    """Height of the kind's highest tip [m]."""

    margin: float
    """How far the kind's blades lean over the patch's edge [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Canvas:
    """What a painter needs of the GL context that it draws in."""

    ctx: moderngl.Context
    block: FrameBlock
    units: Mapping[str, int]
    """The texture unit of each sampler."""

    seed: int
    """The scene's."""

    transitions: Transitions
    """What carries a patch from one representation to another."""

    air: CardWinds
    """The winds of the frame."""

    received: Received
    """What they tell the receivers that are seen."""

    reach: tuple[int, ...]
    """Largest discrete distance of each representation."""

    representations: "tuple[Representation, ...]"
    """All of them, for a painter that draws one on its way to another."""


class RepresentationPainter(Part, ABC):
    """Everything that one GL context holds of a representation, and the drawing of it."""

    def texts(self) -> Iterator[Texts]:
        """Return what the programs are made of that `making` would make."""
        yield from ()

    def making(self) -> Iterator[None]:
        """Make the programs that are not there yet, one at a time, as drivers take long over each."""
        yield from ()

    def making_for_winds(self) -> Iterator[None]:
        """Make the programs by which its receivers hear whatever winds will blow, one at a time."""
        yield from ()

    def fits(self, representation: Any, /) -> bool:
        """Return whether its programs draw another stock of the representation too."""
        raise NotImplementedError

    def staging(self, stocks: "Sequence[Any]", /) -> Iterator[None]:
        """Bring another stock into GL beside its own, a piece at a time; `stocks` are all representations."""
        raise NotImplementedError

    def restock(self) -> None:
        """Draw from now on what was staged."""
        raise NotImplementedError

    @abstractmethod
    def receivers(self, outlook: Outlook, /) -> list[int]:
        """Return how many of its receivers are to hear the wind, pool by pool."""

    @abstractmethod
    def write(self, outlook: Outlook, first: Mapping[str, list[int]], /) -> int:
        """Send what a viewer is shown of it; return how many blades that is as geometry.

        `first` gives the numbers of the first receivers of each representation's pools, by its name.
        """

    @abstractmethod
    def hear(self) -> int:
        """Let its receivers hear the wind; return the number of draw calls."""

    def heard(self) -> Heard:
        """Return what the patches around the viewer have heard, of the one that lies on the ground."""
        raise NotImplementedError

    def draw_ground(self, *, alone: bool) -> int:  # noqa: ARG002 - for the one that lies on the ground
        """Draw the bare ground, where it comes `alone` that of the grass too; return the number of draw calls."""
        return 0

    @abstractmethod
    def draw(self, target: moderngl.Framebuffer, /) -> int:
        """Draw what is blended over all that is coarser; return the number of draw calls.

        Depth is tested and blending is on; `target.depth_mask` is False before, and has to be so afterwards.
        """

    def draw_dense(self, target: moderngl.Framebuffer, /) -> int:
        """Draw that of it which hides most of what is behind; return the number of draw calls."""
        return self.draw(target)

    def draw_thin(self, target: moderngl.Framebuffer, /) -> int:
        """Draw the rest, over soft edges of what stands behind; return the number of draw calls."""
        del target
        return 0

    @property
    def reach(self) -> float:
        """How far off that stands which it draws from far to near, along the ground [m]; 0 where nothing does."""
        return 0.0

    def draw_beyond(self, off: float, /) -> int:
        """Draw of that what is farther off [m], which `draw` leaves out then; return the number of draw calls."""
        del off
        return 0

    def look_anew(self) -> int:
        """Make out what depends on where the eye is, which has come elsewhere since; return the draw calls."""
        return 0

    def draw_deep(self) -> int:
        """Write depth, and no colour, where what was drawn covers at least half a pixel; return the draw calls."""
        return 0


@dataclass(frozen=True, slots=True, eq=False)
class Representation(ABC):
    """One way in which the same grass is kept and drawn (paper, section 2.1).

    `REPRESENTATIONS` lists them from the finest to the coarsest. What is asked of the class grows it; an object is made
    from what was grown, and plants, shows and draws it. Everything here that is not abstract has an answer that will do
    for one without pictures, sub-levels or receivers of its own.
    """

    name: ClassVar[str]
    """What scenes, games and the command line call it."""

    label: ClassVar[str]
    """What people call it."""

    programs: ClassVar[int] = 0
    """How many programs its painter makes one at a time."""

    color: ClassVar[Color]
    """What the overlay shows it in: a display colour of [0, 1]."""

    samplers: ClassVar[tuple[str, ...]] = ()
    """The names of its own samplers that are read while drawing."""

    asked: ClassVar[tuple[str, ...]] = ()
    """The names of those that are read before, by passes over receivers and blades."""

    morphs_into: ClassVar[str | None] = None
    """The name of the coarser one on which its blades have painted places that they move to (paper, section 4.2)."""

    grows_out_of: ClassVar[str | None] = None
    """The name of the coarser one out of which it grows (paper, section 4.3)."""

    record: ClassVar[type | None] = None
    """The dataclass of arrays that its pictures are records of, as they are kept on disk."""

    quality: Quality
    ground: Ground

    @staticmethod
    @abstractmethod
    def reach(quality: Quality, /) -> int:
        """Return the largest discrete distance at which it is due."""

    @staticmethod
    def depends(kind: GrassKind, quality: Quality, /) -> object:  # noqa: ARG004 - for those with pictures
        """Return what its pictures depend on beside the blades, as plain values."""
        return None

    @staticmethod
    def grow(seedling: Seedling, /) -> tuple[Any, ...]:  # noqa: ARG004 - for those with pictures
        """Return its pictures of a patch model, grown from the blades: records of its class."""
        return ()

    @staticmethod
    def fits(pictures: tuple[Any, ...], quality: Quality, blades: int, /) -> bool:  # noqa: ARG004 - the same
        """Return whether pictures that were read again have the shapes that they are due to have."""
        return not pictures

    @staticmethod
    def layers(quality: Quality, /) -> int:  # noqa: ARG004 - the same
        """Return how many layers of a texture its pictures of one patch model take."""
        return 0

    @classmethod
    @abstractmethod
    def stocked(
        cls, growths: Sequence[Growth], quality: Quality, ground: Ground, coming: Mapping[int, Growth] = NOTHING, /
    ) -> Self:
        """Return it with all that was grown of a scene's kinds, ready to be planted on a ground.

        `coming` gives what some kinds are to become, by their numbers.
        """

    def on(self, ground: Ground, /) -> Self:
        """Return it with the same grass, on another ground."""
        return replace(self, ground=ground)

    def defines(self, grown: Grown, /) -> Mapping[str, str | int]:  # noqa: ARG002 - for those with something special
        """Return what all programs are told of what is special about a scene's kinds."""
        return {}

    def prepare(self) -> None:  # noqa: B027 - for those whose painters take long to make
        """Make what the next painter of it takes long to make, without any GL: it may be called on another thread."""

    def rings(self) -> int:
        """Return how many rings of falling fineness it has around a viewer."""
        return 1

    def ring(self, sublevel: Levels, /) -> Levels:
        """Return the ring that each sub-level (n,) is of, shape (n,)."""
        return sublevel

    def keep(self, patches: PatchTable, side: int, /) -> Kept:  # noqa: ARG002 - for those with receivers
        """Return an empty store for what one viewer is shown of it, at most `side` by `side` of its patches."""
        return Kept()

    def margin(self) -> float:
        """Return how far its receivers may stand outside of their patch [m]."""
        return 0.0

    def components(self, outlook: Outlook, rows: list[int], /) -> list[tuple[object, ...]]:  # noqa: ARG002 - for those with some
        """Return what it gives the entity of each of some patches to carry."""
        return [()] * len(rows)

    def sublevels(self, outlook: Outlook, rows: Rows, held: Levels, /, *, slack: int) -> Levels:  # noqa: ARG002
        """Return which sub-level is due on patches (n,) that have those of `held`, shape (n,).

        One is kept for `slack` patches longer on the way to a coarser one than on the way back.
        """
        return np.zeros(len(rows), np.int8)

    def unfit(self, outlook: Outlook, rows: Rows, has: Mask, /, *, slack: int) -> Mask:  # noqa: ARG002 - the same
        """Return which of these patches (n,) would give it away, as strips do from above: a coarser one is due there.

        `has` (n,) tells which patches have it already. With a `slack` above 0 these keep it a little longer.
        """
        return np.zeros(len(rows), np.bool_)

    def left(self, outlook: Outlook, rows: Rows, away: NDArray[np.float32], /) -> NDArray[np.float32]:  # noqa: ARG002 - the same
        """Return how much of it is left to be seen on patches (n,) where it comes near to being unfit, from 1 to 0.

        `away` is how far from the eye their middles are [patch sides]: what is left must not jump at a patch's border.
        """
        return np.ones(len(rows), np.float32)

    @abstractmethod
    def show(self, outlook: Outlook, cover: NDArray[np.float32], /) -> object:
        """Return what of it a viewer is shown in this frame; `cover` (rows,) says how much it shows on each patch."""

    def plant(self, outlook: Outlook, /) -> None:  # noqa: B027 - for those that stand on the ground
        """Stand what is shown on the ground, where it does not stand yet."""

    def carry_ahead(self, before: "Representation", kept: Kept, patches: PatchTable, /) -> bool:  # noqa: ARG002 - for those that take long
        """Make ready for `carry`, in a frame before it; return whether that had been done."""
        return True

    def carry(self, before: "Representation", kept: Kept, patches: PatchTable, /) -> None:  # noqa: B027 - for those whose stores know their grass
        """Let a store that was another's have this grass, where it stands as far as it has not been grown anew."""

    @abstractmethod
    def painter(self, canvas: Canvas, /) -> RepresentationPainter:
        """Return a painter of it for a GL context."""
