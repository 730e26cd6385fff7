"""The interfaces of a representation and of its painter."""

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
from ..around.kept import Kept
from ..around.outlook import Outlook
from ..around.patches import PatchTable
from ..around.transitions import Transitions
from ..frame.block import FrameBlock
from ..frame.feature import Part, WindTextures
from ..grow.record import NOTHING, Blades, Growth, Postures
from ..receive.received import Received
from ..space.ground import Ground
from ..space.grown import Grown
from ..wind.card import CardWinds

Color = tuple[float, float, float]


@dataclass(frozen=True, slots=True, eq=False)
class Seedling:
    """The input of `Representation.grow`: the blades of one patch model, and what all models of the kind share."""

    blades: Blades
    postures: Postures
    kind: GrassKind
    quality: Quality
    height: float
    """Height of the kind's highest tip [m]."""

    margin: float
    """Distance by which the kind's blades overhang the patch's edge [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Canvas:
    """All that a painter shares with the other painters of its GL context."""

    ctx: moderngl.Context
    block: FrameBlock
    units: Mapping[str, int]
    """The texture unit of each sampler."""

    seed: int
    """The scene's seed."""

    transitions: Transitions
    """The means by which patches change their representation."""

    air: CardWinds
    """The frame's winds."""

    received: Received
    """Messages of the wind at the receivers in the picture."""

    reach: tuple[int, ...]
    """Largest discrete distance of each representation."""

    representations: "tuple[Representation, ...]"
    """All representations, for a painter that draws the change of one into another."""


class RepresentationPainter(Part, ABC):
    """Holds a representation's textures and programs in one GL context, and draws it."""

    _came: tuple[float, ...] = ()
    """Fraction of each kind's plants that have become the next form; empty if no kind becomes another."""

    def settle(self, grown: Grown, record: NDArray[np.void], /) -> None:
        """Take over the fraction of each kind that has become its next form."""
        self._came = grown.came

    def making_for_winds(self) -> Iterator[None]:
        """Compile the programs of the receivers' pass for all orders of winds, one at a time."""
        yield from ()

    def fits(self, representation: Any, /) -> bool:
        """Return whether the programs can draw another representation's stock too."""
        raise NotImplementedError

    def staging(self, stocks: Mapping[str, Any], /) -> Iterator[None]:
        """Upload a new stock beside the one in use, a piece at a time; `stocks` are all new representations by name."""
        raise NotImplementedError

    def restock(self) -> None:
        """Replace the stock in use by the staged one."""
        raise NotImplementedError

    @abstractmethod
    def receivers(self, outlook: Outlook, /) -> list[int]:
        """Return by pool the number of receivers that hear the wind in this frame."""

    @abstractmethod
    def write(self, outlook: Outlook, first: Mapping[str, list[int]], /) -> int:
        """Upload the patches that a viewer is shown; return the number of blades drawn as geometry.

        `first` gives, by the representation's name, the number of the first receiver of each of its pools.
        """

    @abstractmethod
    def hear(self) -> int:
        """Compute the messages of the receivers; return the number of draw calls."""

    def heard(self) -> WindTextures:
        """Return the messages at the patches around the viewer; only the representation on the ground has them."""
        raise NotImplementedError

    def draw_ground(self, *, alone: bool) -> int:
        """Draw the bare ground, and with `alone` the ground under grass too; return the number of draw calls."""
        return 0

    @abstractmethod
    def draw(self, target: moderngl.Framebuffer, /) -> int:
        """Blend the representation over all coarser ones; return the number of draw calls.

        Depth test and blending are on. `target.depth_mask` is False, and must be False afterwards.
        """

    def draw_dense(self, target: moderngl.Framebuffer, /) -> int:
        """Draw the part that hides most of what is behind; return the number of draw calls."""
        return self.draw(target)

    def draw_thin(self, target: moderngl.Framebuffer, /) -> int:
        """Draw the part that `draw_dense` leaves out, over soft edges behind it; return the number of draw calls."""
        return 0

    @property
    def farthest(self) -> float:
        """Distance of the farthest patch drawn in far-to-near order, by `distance_in_order` [m]; 0 for none."""
        return 0.0

    def draw_beyond(self, distance: float, /) -> int:
        """Draw the patches at a distance or beyond it [m]; return the number of draw calls.

        Distances are those of `distance_in_order`. `draw` then leaves these patches out.
        """
        return 0

    def look_anew(self) -> int:
        """Compute again what depends on the eye's position, after it has moved; return the number of draw calls."""
        return 0

    def draw_deep(self) -> int:
        """Write depth alone where coverage is at least one half; return the number of draw calls."""
        return 0


@dataclass(frozen=True, slots=True, eq=False)
class Representation(ABC):
    """One way in which the same grass is kept and drawn (paper, section 2.1).

    `REPRESENTATIONS` lists them from the finest to the coarsest. The class grows pictures of patch models; an object
    holds the grown stock, and plants, shows and draws it. The defaults are for a representation without pictures,
    sub-levels or receivers of its own.
    """

    name: ClassVar[str]
    """Name in scenes, in games and on the command line."""

    label: ClassVar[str]
    """Name for people to read."""

    programs: ClassVar[int] = 0
    """Number of programs that the painter compiles one at a time."""

    color: ClassVar[Color]
    """Display colour in the overlay, in [0, 1]."""

    samplers: ClassVar[tuple[str, ...]] = ()
    """Names of the representation's own samplers that drawing reads."""

    pass_samplers: ClassVar[tuple[str, ...]] = ()
    """Names of its own samplers that the passes over receivers and blades read, before drawing."""

    morphs_into: ClassVar[str | None] = None
    """Name of the coarser representation that its blades morph into (paper, section 4.2)."""

    grows_out_of: ClassVar[str | None] = None
    """Name of the coarser representation that it grows out of (paper, section 4.3)."""

    record: ClassVar[type | None] = None
    """Dataclass of arrays that holds a picture, as it is kept on disk; None for a representation without pictures."""

    quality: Quality
    ground: Ground

    @staticmethod
    @abstractmethod
    def reach(quality: Quality, /) -> int:
        """Return the largest discrete distance at which a patch is to have this representation."""

    @staticmethod
    def depends(kind: GrassKind, quality: Quality, /) -> object:
        """Return the plain values that pictures depend on, apart from the blades."""
        return None

    @staticmethod
    def grow(seedling: Seedling, /) -> tuple[Any, ...]:
        """Return the pictures of a patch model, grown from its blades: objects of the class `record`."""
        return ()

    @staticmethod
    def layers(quality: Quality, /) -> int:
        """Return the number of texture layers that the pictures of a patch model take."""
        return 0

    @classmethod
    @abstractmethod
    def stocked(
        cls, growths: Sequence[Growth], quality: Quality, ground: Ground, coming: Mapping[int, Growth] = NOTHING, /
    ) -> Self:
        """Return the representation with the growths of a scene's kinds, ready to be planted on a ground.

        `coming` gives the growths that kinds are changing into, by the kinds' numbers.
        """

    def on(self, ground: Ground, /) -> Self:
        """Return the same grass on another ground."""
        return replace(self, ground=ground)

    def defines(self, grown: Grown, /) -> Mapping[str, str | int]:
        """Return the shader defines that a scene's kinds need in all programs."""
        return {}

    def prepare(self) -> None:  # noqa: B027 - optional
        """Compute ahead what takes the next painter long. It uses no GL, so another thread may call it."""

    def rings(self) -> int:
        """Return the number of rings around a viewer."""
        return 1

    def ring(self, sublevel: Levels, /) -> Levels:
        """Return the ring of each sub-level (n,), shape (n,)."""
        return sublevel

    def keep(self, patches: PatchTable, side: int, /) -> Kept:
        """Return an empty store for one viewer, with room for `side` by `side` patches."""
        return Kept()

    def margin(self) -> float:
        """Return the largest distance of a receiver outside its patch [m]."""
        return 0.0

    def sublevels(self, outlook: Outlook, rows: Rows, held: Levels, /, *, slack: int) -> Levels:
        """Return the sub-levels that patches (n,) are to have, shape (n,); `held` (n,) are their present ones.

        Hysteresis: the limit to a coarser sub-level lies `slack` patches farther out than the limit back.
        """
        return np.zeros(len(rows), np.int8)

    def unfit(self, outlook: Outlook, rows: Rows, has: Mask, /, *, slack: int) -> Mask:
        """Return whether the representation would look wrong on each patch (n,), as strips do from above.

        These patches get a coarser one. `has` (n,) says which patches have this one already: with a `slack` above 0
        they keep it a little longer.
        """
        return np.zeros(len(rows), np.bool_)

    def remaining(self, outlook: Outlook, rows: Rows, away: NDArray[np.float32], /) -> NDArray[np.float32]:
        """Return the part of the representation that shows on each patch (n,): it falls from 1 to 0 before `unfit`.

        `away` (n,) is the distance of the patch's middle from the eye [patch sides]. It is not rounded, so that the
        part does not jump from patch to patch.
        """
        return np.ones(len(rows), np.float32)

    @abstractmethod
    def show(self, outlook: Outlook, cover: NDArray[np.float32], /) -> object:
        """Return the patches that show this representation to a viewer; `cover` (rows,) is its opacity on each."""

    def plant(self, outlook: Outlook, /) -> None:  # noqa: B027 - optional
        """Plant the shown patches that are not planted yet."""

    def carry_ahead(self, before: "Representation", kept: Kept, patches: PatchTable, /) -> bool:
        """Prepare `carry`, in a frame before it; return whether that was already done."""
        return True

    def carry(self, before: "Representation", kept: Kept, patches: PatchTable, /) -> None:  # noqa: B027 - optional
        """Take over a store of the representation `before`; grass that has not been grown anew stays planted."""

    @abstractmethod
    def painter(self, canvas: Canvas, /) -> RepresentationPainter:
        """Return a painter for a GL context."""
