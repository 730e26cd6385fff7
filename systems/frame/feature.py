"""Features: what a prairie has beside its grass, and all that painters, reloads and the frame block ask of it."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import ClassVar, Protocol, Self, TypeVar

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...engine.gl.shaders import Texts
from ...engine.world import World
from ..around.outlook import Outlook
from ..space.grown import Grown
from ..wind.quarantine import Quarantine
from .block import FrameBlock

Eye = tuple[float, float, float]


@dataclass(frozen=True, slots=True, eq=False)
class Start:
    """What there is when features are made."""

    world: World
    grown: Grown
    quarantine: Quarantine
    live: bool
    """Whether somebody watches while pictures are drawn."""


class Heard(Protocol):
    """What patches around a viewer have heard of the wind, as textures: of each, wrapping round, and their mean."""

    texture: moderngl.Texture
    mean: moderngl.Texture


class Part:
    """What one GL context holds of a feature, and the drawing of it; a frame calls its methods in this order."""

    def make_ready(self, grown: Grown, /) -> None:
        """Make all that a game may come to need in GL, so that no frame does: it is asked where a game prepares."""

    def rehearse(self, record: NDArray[np.void], /) -> None:
        """Pretend until the next frame that there is whatever it draws otherwise for: drivers work when they draw."""

    def settle(self, grown: Grown, record: NDArray[np.void], /) -> None:
        """Take over what is other than before, and write it into the frame's record (1,)."""

    def defines(self) -> Mapping[str, str | int]:
        """Return what the programs of representations are told: where it changes, they are made anew."""
        return {}

    def send(self, outlook: Outlook, record: NDArray[np.void], /) -> None:
        """Send what a viewer is shown in this frame."""

    def use(self) -> None:
        """Bind what programs read throughout the frame."""

    def texts(self) -> Iterator[Texts]:
        """Return what the programs are made of that no frame has drawn with yet."""
        return iter(())

    def making(self) -> Iterator[None]:
        """Make them, one at a time, before somebody waits for them."""
        return iter(())

    def breathe(self, air: "Heard", /) -> int:
        """Take up what the patches around the viewer have heard of the wind; return the number of draw calls."""
        del air
        return 0

    def prepare(self) -> int:
        """Draw what is read in this frame, into framebuffers of its own; return the number of draw calls."""
        return 0

    def cast(self, light: tuple[float, float, float], /) -> int:
        """Write the depth of what stops light from a place [m] into a shadow map; return the number of draw calls."""
        del light
        return 0

    def draw_solid(self) -> int:
        """Draw what is opaque and writes depth; return the number of draw calls."""
        return 0

    def look_up(self) -> int:
        """Draw what is drawn behind all from, into framebuffers of its own; return the number of draw calls."""
        return 0

    def draw_behind(self) -> int:
        """Draw behind all that is opaque; return the number of draw calls."""
        return 0

    def draw_soft(self, beyond: float = 0.0) -> int:
        """Blend over ground and sky, before the grass that stands; return the number of draw calls.

        What has more of it left to draw than what lies `beyond` a distance along the ground [m] is asked again.
        """
        del beyond
        return 0

    def soft_left(self) -> float | None:
        """Return how far off what is behind the next thing begins that `draw_soft` has left to draw [m], or None."""
        return None

    def release(self) -> None:
        """Give everything back to the context."""


class TexturePart(Part):
    """A part that is one texture, which all programs read in a unit of its own."""

    def __init__(self, unit: int) -> None:
        self.texture: moderngl.Texture
        self._unit = unit

    def use(self) -> None:
        """Bind it."""
        self.texture.use(self._unit)

    def release(self) -> None:
        """Give the texture back."""
        self.texture.release()


class Feature:
    """One thing that a prairie has. `FEATURES` lists them; what one leaves open has an answer here."""

    samplers: ClassVar[tuple[str, ...]] = ()
    """The names of its samplers that are bound throughout a frame."""

    asked: ClassVar[tuple[str, ...]] = ()
    """The names of those that only passes over receivers read."""

    own: ClassVar[tuple[str, ...]] = ()
    """The names of those that it binds itself whenever it draws."""

    @classmethod
    def begin(cls, start: Start, /) -> Self:
        """Return it for a prairie."""
        del start
        return cls()

    def settle(self, grown: Grown, before: Grown, /, *, time: float) -> None:
        """Go on at a time [s] with a scene read again; `before` is what the scene was."""

    def step(self, viewer: str, eye: Eye, /, *, time: float) -> None:
        """Come to the next frame that is drawn for a viewer whose eye is at (x, y, z) [m], at a time [s]."""

    def look(self, outlook: Outlook, /) -> None:
        """Note what other systems are to know of it in this frame."""

    def release(self) -> None:
        """Leave nothing behind where the prairie is released."""

    def part(self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int], /) -> Part:
        """Return what a GL context holds of it."""
        del ctx, block, units
        return Part()


Sort = TypeVar("Sort", Part, Feature)


def doing(sort: type[Sort], name: str, things: Iterable[Sort], /) -> list[Sort]:
    """Return those of parts or features that have a method of their own: in a frame, most leave most of them open."""
    return [each for each in things if getattr(type(each), name) is not getattr(sort, name)]
