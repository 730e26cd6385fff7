"""A walk: the frames in which changes of representation show the most, and what patches look like on their way.

Every frame is drawn twice: as it is, and held, that is with every patch and tree shown as in the frame before. The two
differ by that frame's changes of representation and by nothing else; changes of orientation and of sub-levels are among
them.
"""

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace

import numpy as np

from ...systems.around.transitions import SEAMLESS, Transitions
from ...systems.prairie import Prairie
from ...systems.trees.draw import TreePart
from ..studio.encode import Picture
from ..studio.studio import Studio
from . import stroll
from .drift import Change, Sample, changes, ends_of_change, sample, sampled_frames
from .stroll import REST, Leg, Moment, moments, raise_gusts
from .truth import Truth
from .verdict import Step, Verdict, judge

Watch = Callable[[Iterator[Step], int], Iterator[Step]]
"""Passes the steps of a walk on, and knows how many there are."""

TOLD = 6
"""Frames that are told of."""

AT_ONCE = 0.25
"""How much of a leg is walked where patches switch at once: they do it at its border [s]."""

SETTLING = 90
"""Frames before each leg in which a frame time comes to be held."""

CHANGING = ("tile", "cull", "lod", "transition", "see", "plant")
"""The systems that decide what is shown, and how."""

DECIDING = CHANGING[:4]
"""Those that say how far patches are on their way."""


@dataclass(slots=True, eq=False)
class Record:
    """What a walk has shown."""

    worst: list[Verdict] = field(default_factory=list)
    """The frames whose changes show the most, the worst first."""

    judged: int = 0
    """Frames that were held against the reference; in all others changes show less than in the last of the worst."""

    changing: list[int] = field(default_factory=list)
    """Patches in transition, by frame."""

    stills: list[tuple[Picture, Picture]] = field(default_factory=list)
    """The frame in the middle of each leg, and its reference, where nothing is left out of the transitions."""

    changes: list[Change] = field(default_factory=list)
    """What patches looked like on their way from one representation or sub-level to another, where nothing is."""


def walked(
    studio: Studio,
    walk: list[Leg],
    transitions: Transitions,
    /,
    *,
    watch: Watch,
    hold: float | None = None,
    only: int | None = None,
    told: int = TOLD,
) -> Record:
    """Walk through the studio's scene with these transitions, and return what has been seen.

    `watch` is told of the steps and of how many there are. With `hold`, frames are held to a time [s]. Of the leg
    `only` the frames are drawn; those before are followed, so that the records of all legs are that of the walk. `told`
    frames are kept of the worst.
    """
    take = studio.take
    prairie = Prairie.load(
        take.scene, ctx=studio.ctx, preset=take.preset, transitions=transitions, live=False, hold=hold
    )
    raise_gusts(prairie, walk)
    frames = [list(moments(prairie, leg))[: frames_of(leg, transitions) + 1] for leg in walk]
    drawn = frames if only is None else frames[only : only + 1]
    try:
        with Truth(studio, walk) as truth:
            _follow(studio, prairie, frames[: only or 0])
            seen = {leg.name: _Seen(studio, prairie, truth, told) for leg in walk}
            for step in watch(_steps(studio, prairie, drawn), sum(len(leg) - 1 for leg in drawn)):
                seen[step.moment.leg.name].see(step)
    finally:
        prairie.release()
    return merged((each.record for each in seen.values()), told=told)


def merged(records: Iterable[Record], /, *, told: int = TOLD) -> Record:
    """Return the record of a walk from those of its legs, in their order, with `told` frames of the worst."""
    whole = Record()
    for each in records:
        whole.worst.extend(each.worst)
        whole.judged += each.judged
        whole.changing.extend(each.changing)
        whole.stills.extend(each.stills)
        whole.changes.extend(each.changes)
    whole.worst.sort(key=lambda one: -one.ratio)
    del whole.worst[told:]
    return whole


def frames_of(leg: Leg, transitions: Transitions, /) -> int:
    """Return how many frames of a leg are judged with these transitions."""
    seconds = AT_ONCE if leg.by_border and not transitions.gradual else stroll.SECONDS
    return round(seconds * stroll.RATE)


class _Seen:
    """What is made of the frames of a leg, one after the other."""

    def __init__(self, studio: Studio, prairie: Prairie, truth: Truth, told: int) -> None:
        self._studio, self._prairie, self._truth, self._told = studio, prairie, truth, told
        self.record = Record()
        self._samples: list[Sample] = []
        whole = prairie.site.transitions == SEAMLESS
        self._due = sampled_frames() if whole else []
        self._still = round(stroll.SECONDS * stroll.RATE) // 2 if whole else 0

    def see(self, step: Step) -> None:
        """Judge a frame, and keep what is to be told of it."""
        record, truth = self.record, self._truth
        record.changing.append(step.changing)
        least = max(1.0, record.worst[-1].ratio) if len(record.worst) == self._told else 0.0
        verdict = judge(step, truth, unless_below=least)
        if verdict is not None:
            record.judged += 1
            record.worst.append(verdict)
            record.worst.sort(key=lambda one: -one.ratio)
            del record.worst[self._told :]
        if step.moment.number in self._due:
            self._sample(step)
        if step.moment.number == self._still:
            record.stills.append((step.now, truth.whole(step.moment)))

    def _sample(self, step: Step) -> None:
        first = step.moment.number == self._due[0]
        self._samples = [] if first else self._samples
        with held(self._prairie, systems=DECIDING):
            ends = ends_of_change(self._studio, self._prairie, step.moment.camera)
        self._samples.append(sample(self._prairie, step, self._truth.near(step.moment), ends))
        if step.moment.number == self._due[-1]:
            self.record.changes.extend(changes(self._samples))


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


def _follow(studio: Studio, prairie: Prairie, frames: Iterable[list[Moment]]) -> None:
    """Let the prairie go through legs as `_steps` does, without a picture."""
    for leg in frames:
        begin = replace(leg[0], time=leg[0].time - REST / 2)
        for moment in (begin, *leg):
            prairie.advance(max(0.0, moment.time - prairie.time))
            prairie.follow(*studio.matrices(moment.camera))


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
def held(prairie: Prairie, *, systems: tuple[str, ...] = CHANGING) -> Iterator[None]:
    """Let all patches and trees be shown as the frame before showed them, seen from where the viewer is, in that wind.

    What is drawn meanwhile is the next frame without its changes of representation. Afterwards it never was: the next
    frame follows the one before. `systems` are those that rest meanwhile, of what decides what is shown.
    """
    stopped = [system.name for system in prairie.systems if system.enabled and system.name in systems]
    outlook = prairie.viewers["main"]
    before, eye = outlook.drawn_at, outlook.viewer.eye
    trees = prairie.painter.part(TreePart) if prairie.painter is not None else None
    prairie.governor.resting = True
    if trees is not None:
        trees.held = True
    for name in stopped:
        prairie.systems.disable(name)
    try:
        yield
    finally:
        for name in stopped:
            prairie.systems.enable(name)
        outlook.drawn_at, outlook.viewer.eye = before, eye
        prairie.governor.resting = False
        if trees is not None:
            trees.held = False
