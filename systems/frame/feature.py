"""Features: things in a prairie beside its grass, and their hooks into painting, reloading and the frame block."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import ClassVar, Protocol, TypeVar

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Point
from ...engine.gl.shaders import Texts
from ...engine.world import World
from ..around.outlook import Outlook
from ..space.grown import Grown
from ..wind.quarantine import Quarantine
from .block import FrameBlock


@dataclass(frozen=True, slots=True, eq=False)
class Start:
    """Inputs that features are made from."""

    world: World
    grown: Grown
    quarantine: Quarantine
    live: bool
    """Whether frames are watched as they are drawn, as in a game and not in a film."""


class WindTextures(Protocol):
    """The wind around a viewer: textures of the messages to each patch, which wraps round, and of those beyond.

    The last row of the latter begins with the mean message.
    """

    texture: moderngl.Texture
    far: moderngl.Texture


class Part:
    """A feature's buffers, textures and programs in one GL context, and their drawing.

    A frame calls the methods in this order.
    """

    def make_ready(self, grown: Grown, /) -> None:
        """Allocate all that a game may come to need in GL, so that no frame has to; `Prairie.prepare` calls it."""

    def rehearse(self, record: NDArray[np.void], /) -> None:
        """Make every draw call in the next frame, even of absent things: drivers finish programs at the first draw."""

    def settle(self, grown: Grown, record: NDArray[np.void], /) -> None:
        """Apply changes since the last frame, and write them into the frame block's record (1,)."""

    def defines(self) -> Mapping[str, str | int]:
        """Return defines for the programs of representations; when these change, the programs are compiled anew."""
        return {}

    def send(self, outlook: Outlook, record: NDArray[np.void], /) -> None:
        """Upload the data of a viewer's frame."""

    def use(self) -> None:
        """Bind the textures that programs read throughout the frame."""

    def texts(self) -> Iterator[Texts]:
        """Yield the sources of programs that no frame has drawn with yet."""
        return iter(())

    def making(self) -> Iterator[None]:
        """Compile these programs, one at a step, before a frame waits for them."""
        return iter(())

    def take_wind(self, wind: "WindTextures", /) -> int:
        """Take over the wind at the patches around the viewer; return the number of draw calls."""
        return 0

    def prepare(self) -> int:
        """Draw the textures of this frame, into framebuffers of its own; return the number of draw calls."""
        return 0

    def cast(self, light: tuple[float, float, float], /) -> int:
        """Draw the shadow casters of a light at (x, y, z) [m] into a shadow map; return the number of draw calls."""
        return 0

    def draw_solid(self) -> int:
        """Draw what is opaque and writes depth; return the number of draw calls."""
        return 0

    def prepare_behind(self) -> int:
        """Draw the textures that `draw_behind` reads, into framebuffers of its own; return the number of draw calls."""
        return 0

    def draw_behind(self) -> int:
        """Draw the background behind everything opaque; return the number of draw calls."""
        return 0

    def draw_soft(self, beyond: float = 0.0) -> int:
        """Blend over ground and sky, before blades and strips; return the number of draw calls.

        Things nearer than `beyond` along the ground [m] are left for later calls.
        """
        return 0

    def soft_distance(self) -> float | None:
        """Return the distance of the farthest thing that `draw_soft` has left [m], or None if it has left nothing."""
        return None

    def release(self) -> None:
        """Release everything in the context."""


class TexturePart(Part):
    """A part that is one texture, which all programs read in a unit of its own."""

    def __init__(self, unit: int) -> None:
        self.texture: moderngl.Texture
        self._unit = unit

    def use(self) -> None:
        """Bind the texture."""
        self.texture.use(self._unit)

    def release(self) -> None:
        """Release the texture."""
        self.texture.release()


class Feature:
    """A thing in a prairie beside its grass. `FEATURES` lists them; methods that one does not override do nothing."""

    samplers: ClassVar[tuple[str, ...]] = ()
    """Names of its samplers that are bound throughout a frame."""

    pass_samplers: ClassVar[tuple[str, ...]] = ()
    """Names of its samplers that only passes over receivers read."""

    own: ClassVar[tuple[str, ...]] = ()
    """Names of its samplers that it binds itself whenever it draws."""

    def __init__(self, start: Start, /) -> None:
        """Begin on a new prairie."""

    def settle(self, grown: Grown, before: Grown, /, *, time: float) -> None:
        """Take over a site that has changed or been replaced, at `time` [s]; `before` is the old one."""

    def step(self, viewer: str, eye: Point, /, *, time: float) -> None:
        """Advance to a viewer's next frame, with its eye at (x, y, z) [m], at a time [s]."""

    def look(self, outlook: Outlook, /) -> None:
        """Note records for other systems in this frame."""

    def release(self) -> None:
        """Clean up when the prairie is released."""

    def part(self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int], /) -> Part:
        """Return the feature's part in a GL context."""
        return Part()


Sort = TypeVar("Sort", Part, Feature)


def overriding(sort: type[Sort], name: str, things: Iterable[Sort], /) -> list[Sort]:
    """Return the parts or features that override a method of `sort`: most leave most of them as they are."""
    return [each for each in things if getattr(type(each), name) is not getattr(sort, name)]
