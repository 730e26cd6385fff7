"""`tallgrass bench pop`: whether a change of representation can be seen while the wind blows and the viewer walks."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from ...systems.around.transitions import SEAMLESS, Transitions
from ..studio.encode import make_folder
from ..studio.errors import InputError
from ..studio.studio import Studio, about
from ..studio.take import Take
from .evidence import save
from .flicker import MARGIN, TILE
from .frame import own_preset
from .machine import machine, tell
from .picture import evaluator, flip
from .steps import Record, find_truth, walked
from .stroll import legs
from .verdict import Verdict, judge

HARD = Transitions(morph=False, fade=False, growth=False)
"""Patches switch at once."""

WHOLE = "nothing"
"""What is left out where nothing is."""

PARTS = ("morph", "fade", "growth", "hysteresis")
"""What each is worth is found by leaving it out."""

SMALLEST = TILE + 2 * MARGIN + 2
"""Least side of a picture [pixels]."""

TOLD = 6
"""Frames that are told of."""


def bench_pop(
    scene: str,
    *,
    preset: str | None,
    size: tuple[int, int],
    json: bool,
    parts: bool = False,
    output: str | None = None,
    hold: float | None = None,
) -> int:
    """Walk through a scene, compare its changes with the reference's, print the figures, and return the exit status.

    With `parts` the walk is repeated with each part of the transitions left out. Pictures of the frames that show the
    most go into the folder `output`. With `hold`, so many frames a second are held. Before anything is drawn it raises
    MachineError where pictures cannot be compared, and InputError where they would be too small or cannot be written.
    """
    evaluator()
    if min(size) < SMALLEST:
        raise InputError(f"--size: {size[0]}x{size[1]}: here each side must be at least {SMALLEST} pixels")
    if output is not None:
        make_folder(Path(output))
    take = Take(scene, size, preset=preset)
    with Studio(take) as studio:
        head = {"machine": machine(studio.ctx), "scene": scene, "preset": preset or own_preset(studio.prairie)}
        result = {**head, "size": list(size), **_measure(studio, parts=parts, output=output, hold=hold)}
    tell(result, as_json=json)
    return 0


def _measure(studio: Studio, *, parts: bool, output: str | None, hold: float | None) -> dict[str, object]:
    walk = legs(studio.prairie)
    left_out = {WHOLE: SEAMLESS, "morph, fade, growth": HARD}
    for part in PARTS if parts else ():
        left_out[part] = replace(SEAMLESS, **{part: False})
    seconds = 1.0 / hold if hold else None
    records = {
        name: walked(studio, walk, less, doing=f"without {name}", hold=seconds) for name, less in left_out.items()
    }
    whole = records[WHOLE]
    near = [each for record in records.values() for step in record.steps for each in (step.earlier, step.moment)]
    truth = find_truth(studio, walk, near, [moment for moment, _ in whole.stills])
    verdicts = {name: judge(record, truth) for name, record in records.items()}
    if output is not None:
        save(verdicts[WHOLE][:TOLD], output, about(studio.prairie, studio.take))
    result = _told(whole, verdicts, [flip(picture, truth.whole[moment.time]) for moment, picture in whole.stills])
    if parts:
        result["contributions"] = [
            {"without": name, **_figures(verdicts[name][0]), "changing": _changing(record)["mean"]}
            for name, record in records.items()
        ]
    return result


def _told(whole: Record, verdicts: dict[str, list[Verdict]], errors: list[float]) -> dict[str, object]:
    worst = verdicts[WHOLE][:TOLD]
    return {
        "frames": len(whole.changing),
        "error": {"p50": round(float(np.median(errors)), 5), "max": round(max(errors), 5)},
        "flicker": _figures(worst[0]),
        "hard_switch_ratio": _figures(verdicts["morph, fade, growth"][0])["ratio"],
        "changing": _changing(whole),
        "worst": [_row(verdict) for verdict in worst],
    }


def _figures(verdict: Verdict) -> dict[str, float]:
    return {
        "steady": round(verdict.steady, 3),
        "transition_max": round(verdict.flicker, 3),
        "ratio": round(verdict.ratio, 3),
    }


def _changing(record: Record) -> dict[str, float]:
    return {"mean": round(float(np.mean(record.changing)), 2), "max": max(record.changing)}


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
