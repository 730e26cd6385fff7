"""The frames of a walk in which changes of representation show the most, and the truth about them.

Every frame is drawn twice: as it is, and held, that is with every patch shown as in the frame before. The two differ by
that frame's changes of representation and by nothing else; changes of orientation and of sub-levels are among them.
"""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

import numpy as np

from ...systems.around.transitions import Transitions
from ...systems.lod import farthest
from ...systems.prairie import Prairie
from ...systems.reference import draw_reference
from ..studio.encode import Picture
from ..studio.progress import counted
from ..studio.studio import Studio
from ..studio.take import SAMPLES
from .flicker import prominence
from .stroll import REST, Leg, Moment, moments, raise_gusts

KEPT = 3
"""Frames of each leg that are kept."""

STILLS = 8
"""Frames kept besides, spread over the walk."""

SETTLING = 90
"""Frames before each leg in which a frame time comes to be held."""

CHANGING = ("tile", "cull", "lod", "transition", "see", "plant")
"""The systems that decide what is shown, and how."""


@dataclass(frozen=True, slots=True, eq=False)
class Step:
    """A frame of the walk, the one before it, and what it would be without its changes of representation."""

    earlier: Moment
    moment: Moment
    before: Picture
    now: Picture
    held: Picture

    changing: int
    """Patches in transition."""


@dataclass(slots=True, eq=False)
class Record:
    """What a walk has shown."""

    steps: list[Step] = field(default_factory=list)
    """The frames of each leg whose changes are the most prominent."""

    changing: list[int] = field(default_factory=list)
    """Patches in transition, by frame."""

    stills: list[tuple[Moment, Picture]] = field(default_factory=list)
    """Frames spread over the walk."""


def walked(
    studio: Studio, walk: list[Leg], transitions: Transitions, /, *, doing: str, hold: float | None = None
) -> Record:
    """Walk through the studio's scene with these transitions, and return what has been seen.

    With `hold`, frames are held to a time [s].
    """
    take, record = studio.take, Record()
    prairie = Prairie.load(
        take.scene, ctx=studio.ctx, preset=take.preset, transitions=transitions, live=False, hold=hold
    )
    raise_gusts(prairie, walk)
    frames = {leg: list(moments(prairie, leg)) for leg in walk}
    total = sum(len(each) - 1 for each in frames.values())
    apart = max(1, total // STILLS)
    kept: dict[Leg, list[tuple[float, Step]]] = {leg: [] for leg in walk}
    try:
        for number, step in enumerate(counted(_steps(studio, prairie, frames.values()), total=total, doing=doing)):
            best = kept[step.moment.leg]
            best.append((prominence(step.now, step.held, step.before), step))
            best.sort(key=lambda one: -one[0])
            del best[KEPT:]
            record.changing.append(step.changing)
            if number % apart == apart // 2:
                record.stills.append((step.moment, step.now))
    finally:
        prairie.release()
    record.steps = [step for best in kept.values() for _, step in best]
    return record


def _steps(studio: Studio, prairie: Prairie, frames: Iterable[list[Moment]]) -> Iterator[Step]:
    for leg in frames:
        _settle(studio, prairie, leg[0])
        _go(studio, prairie, leg[0], time=leg[0].time - REST / 2)
        earlier, before = leg[0], _go(studio, prairie, leg[0])
        for moment in leg[1:]:
            with held(prairie):
                without = _go(studio, prairie, moment)
            now = _go(studio, prairie, moment)
            yield Step(earlier, moment, before, now, without, prairie.statistics.transitions)
            earlier, before = moment, now


def _settle(studio: Studio, prairie: Prairie, moment: Moment) -> None:
    """Let what holds the frame time find out what frames take before any counts."""
    if prairie.governor.hold is not None:
        for part in np.linspace(1.0, 0.5, SETTLING):
            _go(studio, prairie, moment, time=moment.time - REST * part)


def _go(studio: Studio, prairie: Prairie, moment: Moment, *, time: float | None = None) -> Picture:
    prairie.advance(max(0.0, (moment.time if time is None else time) - prairie.time))
    studio.begin()
    prairie.draw(*studio.matrices(moment.camera))
    return studio.read()


@contextmanager
def held(prairie: Prairie) -> Iterator[None]:
    """Let every patch be shown as the frame before showed it, though seen from where the viewer is then, in that wind.

    What is drawn meanwhile is the next frame without its changes of representation. Afterwards it never was: the next
    frame follows the one before.
    """
    stopped = [system.name for system in prairie.systems if system.enabled and system.name in CHANGING]
    outlook = prairie.viewers["main"]
    before, eye = outlook.drawn_at, outlook.viewer.eye
    prairie.governor.resting = True
    for name in stopped:
        prairie.systems.disable(name)
    try:
        yield
    finally:
        for name in stopped:
            prairie.systems.enable(name)
        outlook.drawn_at, outlook.viewer.eye = before, eye
        prairie.governor.resting = False


@dataclass(frozen=True, slots=True, eq=False)
class Truth:
    """The reference's pictures by the instant they show."""

    near: dict[float, Picture]
    """Every blade up to where strips end; beyond it the prairie's own carpet, which does not change."""

    whole: dict[float, Picture]
    """Every blade there is, as `--reference` draws it."""


def find_truth(studio: Studio, walk: list[Leg], near: Iterable[Moment], whole: Iterable[Moment], /) -> Truth:
    """Draw the reference at some moments of the walk, up to the end of the strips and as a whole."""
    prairie, truth, size = studio.prairie, Truth({}, {}), studio.take.size
    raise_gusts(prairie, walk)
    reach = farthest(prairie.site.reach)[-1]
    fine, full = ({moment.time: moment for moment in each} for each in (near, whole))
    times = sorted(fine | full)
    for time in counted(times, total=len(times), doing="drawing every blade"):
        moment = fine.get(time) or full[time]
        _go(studio, prairie, moment)
        matrices = studio.matrices(moment.camera)
        if time in fine:
            truth.near[time] = draw_reference(prairie, *matrices, size, samples=SAMPLES, reach=reach)
        if time in full:
            truth.whole[time] = draw_reference(prairie, *matrices, size, samples=SAMPLES)
    return truth
