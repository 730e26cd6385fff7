"""`tallgrass bench pop`: whether changes of representation are visible while the wind blows and the viewer walks."""

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ...systems.around.transitions import SEAMLESS, Transitions
from ..studio.encode import Picture, picture_writer
from ..studio.errors import InputError
from ..studio.progress import counted, course
from ..studio.studio import Studio, about
from ..studio.take import Take
from .crew import by_many, cores, ticked
from .drift import Change, grouped, mean_drift, mean_ghosting
from .flicker import MARGIN, TILE
from .flip import evaluator, flip
from .machine import head
from .many import Survey
from .sent import Job
from .steps import WORST, Record, frames_of, merged, walked
from .stroll import Leg, climb, legs
from .verdict import Verdict

HARD = Transitions(morph=False, fade=False, growth=False)
"""Patches switch at once."""

WHOLE = "nothing"
"""Name of the walk with complete transitions."""

PARTS = ("morph", "fade", "growth", "hysteresis")
"""Parts of the transitions whose contributions are measured, each by a walk without it."""

SMALLEST = TILE + 2 * MARGIN + 2
"""Least side of a picture, which must have room for a tile [pixels]."""

MOST_PROCESSES = 8
"""Most processes that walk at a time, one per core, each with a prairie of its own."""

JSON_KEYS = ("judged", "error", "drift", "ghosting", "over", "changing", "changes", "worst")
"""Figures of each scene in a folder that JSON has in addition to the table's."""

LIMITS = {"flicker": 1.15, "drift": 0.03, "ghosting": 0.5}
"""Visibility thresholds: of the flicker ratio, of the mean drift, and of the ghosting."""

AMPLIFIED = 8
"""Factor by which differences are amplified in pictures."""

RED = (255, 0, 0)


def pop_survey(*, parts: bool, hold: float | None, rising: bool) -> Survey:
    """Return the survey of walks through many scenes, with the options of `pop_measured`."""
    measure = partial(pop_measured, parts=parts, hold=hold, rising=rising)
    keys = JSON_KEYS + ("contributions",) * parts
    job = Job(partial(measure, crew=False))
    return Survey(measure, "walking", _cells, keys, job, folders=True, need=evaluator)


def must_be_large(size: tuple[int, int]) -> None:
    """Raise InputError for a picture that has no room for tiles; `size` is (width, height) [pixels]."""
    if min(size) < SMALLEST:
        raise InputError(f"--size: {size[0]}x{size[1]}: here each side must be at least {SMALLEST} pixels")


def pop_measured(
    take: Take,
    output: str | None = None,
    /,
    *,
    parts: bool = False,
    hold: float | None = None,
    rising: bool = False,
    crew: bool = True,
) -> dict[str, Any]:
    """Return the benchmark's figures of a walk through a scene, or if `rising` of the climb over it.

    With `parts` the walk is repeated without each part of the transitions. Pictures of the worst frames go into the
    folder `output`. `hold` is the frame rate that the governor holds [1/s]. Without a `crew` this process walks alone,
    with the same result.
    """
    with Studio(take) as studio:
        common = head(studio.ctx, studio.prairie, take)
        walk = climb(studio.prairie) if rising else legs(studio.prairie)
        return common | _measure(studio, walk, parts=parts, output=output, hold=hold, crew=crew)


def _measure(
    studio: Studio, walk: list[Leg], *, parts: bool, output: str | None, hold: float | None, crew: bool
) -> dict[str, object]:
    variants = {WHOLE: SEAMLESS, "morph, fade, growth": HARD}
    for part in PARTS if parts else ():
        variants[part] = replace(SEAMLESS, **{part: False})
    records = _walks(studio, walk, variants, hold=hold, crew=crew)
    whole = records[WHOLE]
    if output is not None:
        _save(whole.worst, output, about(studio.prairie.scene, studio.take, time=studio.prairie.time))
    result = _summary(records)
    if parts:
        result["contributions"] = [
            {"without": name, **_figures(record.worst[0]), "changing": _changing(record)["mean"]}
            for name, record in records.items()
        ]
    return result


def _walks(
    studio: Studio, walk: list[Leg], variants: Mapping[str, Transitions], *, hold: float | None, crew: bool
) -> dict[str, Record]:
    """Return the record of each variant's walk, by what it leaves out; with `hold`, one process walks alone."""
    steps = {name: sum(frames_of(leg, transitions) for leg in walk) for name, transitions in variants.items()}
    jobs = [(name, number) for name in variants for number in reversed(range(len(walk)))]
    workers = min(cores(), MOST_PROCESSES, len(jobs)) if crew and not hold else 1
    if workers > 1:
        arguments = [(studio.take, walk, variants[name], number, _kept(name)) for name, number in jobs]
        found = by_many(leg_walked, arguments, workers=workers, steps=sum(steps.values()), doing="walking")
        by_job = dict(zip(jobs, found, strict=True))
        return {name: merged(by_job[name, number] for number in range(len(walk))) for name in variants}
    records = {}
    with course("walking", steps) as way:
        for name, transitions in variants.items():
            with way.part(name):
                watch = partial(counted, doing=f"without {name}")
                frame_time = 1.0 / hold if hold else None
                records[name] = walked(studio, walk, transitions, watch=watch, hold=frame_time, kept=_kept(name))
    return records


def _kept(name: str) -> int:
    """Return the number of worst frames to keep."""
    return WORST if name == WHOLE else 1


def leg_walked(take: Take, walk: list[Leg], transitions: Transitions, number: int, kept: int, /) -> Record:
    """Walk a single leg in a process of a crew, and return its record."""
    with Studio(take) as studio:
        return walked(studio, walk, transitions, watch=lambda steps, **_: ticked(steps), only=number, kept=kept)


def _summary(records: Mapping[str, Record]) -> dict[str, object]:
    whole = records[WHOLE]
    errors = [flip(picture, reference) for picture, reference in whole.stills]
    flicker, drift, ghosting = _figures(whole.worst[0]), _drift(whole.changes), _ghosting(whole.changes)
    measured = {"flicker": flicker["ratio"], "drift": drift["mean"], "ghosting": ghosting["max"]}
    return {
        "frames": len(whole.changing),
        "judged": whole.judged,
        "error": {"p50": round(float(np.median(errors)), 5), "max": round(max(errors), 5)},
        "flicker": flicker,
        "hard_switch_ratio": _figures(records["morph, fade, growth"].worst[0])["ratio"],
        "drift": drift,
        "ghosting": ghosting,
        "over": [name for name, limit in LIMITS.items() if measured[name] > limit],
        "changing": _changing(whole),
        "changes": _changes(whole.changes),
        "worst": [_row(verdict) for verdict in whole.worst],
    }


def _drift(changes: list[Change]) -> dict[str, Any]:
    if not changes:
        return {"max": 0.0, "mean": 0.0, "where": None}
    worst = max(changes, key=lambda change: float(change.drift.max()))
    patch = int(np.argmax(worst.drift))
    where = {
        "leg": worst.leg,
        "change": worst.name,
        "distance": int(worst.distance[patch]),
        "tile": worst.corner[patch].tolist(),
        "relative": [round(float(ratio), 3) for ratio in worst.bright[:, patch]],
    }
    mean = max(map(mean_drift, _groups(changes)))
    return {"max": round(float(worst.drift[patch]), 4), "mean": round(mean, 4), "where": where}


def _by_name(changes: list[Change]) -> dict[str, list[Change]]:
    found: dict[str, list[Change]] = {}
    for change in changes:
        found.setdefault(change.name, []).append(change)
    return found


def _ghosting(changes: list[Change]) -> dict[str, Any]:
    if not changes:
        return {"max": 0.0, "where": None}
    worst = max(_groups(changes), key=mean_ghosting)
    leg = max(worst, key=lambda change: change.ghosting).leg
    return {"max": round(mean_ghosting(worst), 4), "where": {"leg": leg, "change": worst[0].name}}


def _groups(changes: list[Change]) -> list[list[Change]]:
    return [group for those in _by_name(changes).values() for group in grouped(those)]


def _changes(changes: list[Change]) -> list[dict[str, object]]:
    """Return a row for each change: the number of patches that made it, and its largest effects."""
    rows: list[dict[str, object]] = []
    for name, those in sorted(_by_name(changes).items()):
        drift = _drift(those)
        rows.append({
            "change": name,
            "patches": sum(len(change.distance) for change in those),
            "drift": drift["max"],
            "mean_drift": drift["mean"],
            "ghosting": _ghosting(those)["max"],
        })  # fmt: skip
    return rows


def _figures(verdict: Verdict) -> dict[str, float]:
    return {
        "steady": round(verdict.steady, 3),
        "transition_max": round(verdict.flicker, 3),
        "ratio": round(verdict.ratio, 3),
    }


def _changing(record: Record) -> dict[str, float]:
    return {"mean": round(float(np.mean(record.changing)), 2), "max": max(record.changing)}


def _cells(result: dict[str, Any]) -> dict[str, object]:
    """Return the table's cells for a walk through a scene."""
    return {
        "flicker": result["flicker"]["ratio"],
        "hard": result["hard_switch_ratio"],
        "drift": result["drift"]["mean"],
        "ghosting": result["ghosting"]["max"],
        "over": " ".join(result["over"]) or None,
    }


def _row(verdict: Verdict) -> dict[str, object]:
    moment = verdict.step.moment
    return {
        "leg": moment.leg.name,
        "frame": moment.number,
        "tile": list(verdict.corner),
        **_figures(verdict),
        "jump": round(verdict.jump, 3),
        "changing": verdict.step.changing,
    }


def _save(verdicts: list[Verdict], folder: str, about: Mapping[str, str], /) -> None:
    """Write `_evidence` for each verdict into a folder: `1-ahead-015.png` is the worst, frame 15 of the leg ahead."""
    for rank, verdict in enumerate(verdicts, 1):
        moment = verdict.step.moment
        name = f"{rank}-{moment.leg.name}-{moment.number:03}.png"
        picture_writer(str(Path(folder) / name))(_evidence(verdict), {**about, "time": f"{moment.time:.6g}"})


def _evidence(verdict: Verdict, /) -> Picture:
    """Return the frame with its tile outlined, beside its difference from the held frame, (height, 2 * width, 3).

    The difference is multiplied by `AMPLIFIED`.
    """
    now, held = verdict.step.now, verdict.step.held
    difference = np.minimum(np.abs(now.astype(np.int16) - held) * AMPLIFIED, 255).astype(np.uint8)
    framed, (left, top) = now.copy(), verdict.corner
    framed[[top, top + TILE - 1], left : left + TILE] = RED
    framed[top : top + TILE, [left, left + TILE - 1]] = RED
    return np.concatenate([framed, difference], axis=1)
