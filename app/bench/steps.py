"""A walk: the frames in which changes of representation are most visible, and the patches during their changes.

Every frame is drawn twice: as it is, and held, that is with every patch and tree shown as in the frame before. The two
differ by nothing but the frame's changes of representation, those of orientation and sub-level included.
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
from .stroll import REST, Leg, Moment, advance_to, moments, raise_gusts
from .truth import Truth
from .verdict import Step, Verdict, judge

Watch = Callable[..., Iterator[Step]]
"""Passes the steps of a walk on, an iterator, given their number as `total`; it may show progress."""

WORST = 6
"""Number of worst frames in the result."""

SWITCHING = 0.25
"""Time walked of a leg where patches switch at once, which happens at its border [s]."""

SETTLING = 90
"""Number of frames before each leg in which the governor adapts."""

CHANGING = ("tile", "cull", "lod", "transition", "see", "plant")
"""Systems that decide what is shown, and how."""

DECIDING = CHANGING[:4]
"""Systems that choose representations and advance their changes."""


@dataclass(slots=True, eq=False)
class Record:
    """Measurements of a walk, or of one leg."""

    worst: list[Verdict] = field(default_factory=list)
    """Verdicts on the frames with the most visible changes, the worst first."""

    judged: int = 0
    """Number of frames compared with the reference; in all others changes are less visible than in those of `worst`."""

    changing: list[int] = field(default_factory=list)
    """Number of patches in transition, by frame."""

    stills: list[tuple[Picture, Picture]] = field(default_factory=list)
    """Middle frame of each leg, and its reference; empty unless transitions are complete."""

    changes: list[Change] = field(default_factory=list)
    """Changes of representation or sub-level, as patches looked in them; empty unless transitions are complete."""


def walked(
    studio: Studio,
    walk: list[Leg],
    transitions: Transitions,
    /,
    *,
    watch: Watch,
    hold: float | None = None,
    only: int | None = None,
    kept: int = WORST,
) -> Record:
    """Walk through the studio's scene with these transitions, and return the measurements.

    `watch` gets the steps and their number. With `hold`, the governor holds this frame time [s]. With `only`, just the
    leg of this index is drawn; the legs before are followed without drawing, so that `merged` records of single legs
    equal the record of the walk. `kept` is the number of worst frames in the record.
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
            judges = {leg.name: _Judge(studio, prairie, truth, kept) for leg in walk}
            for step in watch(_steps(studio, prairie, drawn), total=sum(len(leg) - 1 for leg in drawn)):
                judges[step.moment.leg.name].judge(step)
    finally:
        prairie.release()
    return merged((each.record for each in judges.values()), kept=kept)


def merged(records: Iterable[Record], /, *, kept: int = WORST) -> Record:
    """Return the record of a walk from the records of its legs, in their order, with the `kept` worst frames."""
    whole = Record()
    for each in records:
        whole.worst.extend(each.worst)
        whole.judged += each.judged
        whole.changing.extend(each.changing)
        whole.stills.extend(each.stills)
        whole.changes.extend(each.changes)
    whole.worst.sort(key=lambda verdict: -verdict.ratio)
    del whole.worst[kept:]
    return whole


def frames_of(leg: Leg, transitions: Transitions, /) -> int:
    """Return the number of frames of a leg that are judged with these transitions."""
    seconds = SWITCHING if leg.by_border and not transitions.gradual else stroll.SECONDS
    return round(seconds * stroll.RATE)


class _Judge:
    """Judges the frames of a leg, in their order."""

    def __init__(self, studio: Studio, prairie: Prairie, truth: Truth, kept: int) -> None:
        self._studio, self._prairie, self._truth, self._kept = studio, prairie, truth, kept
        self.record = Record()
        self._samples: list[Sample] = []
        whole = prairie.site.transitions == SEAMLESS
        self._due = sampled_frames() if whole else []
        self._still = round(stroll.SECONDS * stroll.RATE) // 2 if whole else 0

    def judge(self, step: Step) -> None:
        """Judge a frame, and add it to the record."""
        record, truth = self.record, self._truth
        record.changing.append(step.changing)
        least = max(1.0, record.worst[-1].ratio) if len(record.worst) == self._kept else 0.0
        verdict = judge(step, truth, unless_below=least)
        if verdict is not None:
            record.judged += 1
            record.worst.append(verdict)
            record.worst.sort(key=lambda each: -each.ratio)
            del record.worst[self._kept :]
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
        let_trees_stay(prairie)
        _settle(studio, prairie, leg[0])
        _draw(studio, prairie, leg[0], time=leg[0].time - REST / 2)
        earlier, before = leg[0], _draw(studio, prairie, leg[0])
        for moment in leg[1:]:
            with held(prairie):
                without = _draw(studio, prairie, moment)
            now = _draw(studio, prairie, moment)
            yield Step(earlier, moment, before, now, without, prairie.statistics.transitions)
            earlier, before = moment, now


def _follow(studio: Studio, prairie: Prairie, frames: Iterable[list[Moment]]) -> None:
    """Take the prairie through legs as `_steps` does, without drawing."""
    for leg in frames:
        begin = replace(leg[0], time=leg[0].time - REST / 2)
        for moment in (begin, *leg):
            advance_to(prairie, moment.time)
            prairie.follow(*studio.matrices(moment.camera))


def _settle(studio: Studio, prairie: Prairie, moment: Moment) -> None:
    """Let the governor adapt before frames are judged, where it holds a frame time."""
    if prairie.governor.hold is not None:
        for part in np.linspace(1.0, 0.5, SETTLING):
            _draw(studio, prairie, moment, time=moment.time - REST * part)


def _draw(studio: Studio, prairie: Prairie, moment: Moment, *, time: float | None = None) -> Picture:
    advance_to(prairie, moment.time if time is None else time)
    studio.begin()
    prairie.draw(*studio.matrices(moment.camera))
    return studio.read()


def let_trees_stay(prairie: Prairie, /) -> None:
    """Choose trees anew, and let them stay chosen from then on as in a game: what a leg shows begins with it."""
    if prairie.painter is not None:
        trees = prairie.painter.part(TreePart)
        trees.stay = True
        trees.choose_anew()


@contextmanager
def held(prairie: Prairie, *, systems: tuple[str, ...] = CHANGING) -> Iterator[None]:
    """Show all patches and trees meanwhile as in the frame before, from the current viewpoint and in the current wind.

    A frame drawn inside is the next frame without its changes of representation. It leaves no trace: the next frame
    drawn outside follows the one before. `systems` are disabled meanwhile.
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
