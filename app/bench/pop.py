"""`tallgrass bench pop`: whether a change of representation can be seen while the wind blows and the viewer walks."""

from dataclasses import dataclass, replace

import numpy as np

from ...components.transition import SEAMLESS, Transitions
from ..errors import InputError
from ..studio import Studio
from ..take import Take
from .flicker import LEAST, MARGIN, TILE, flicker, step
from .frame import own_preset
from .machine import machine, tell
from .picture import evaluator, flip
from .steps import Record, Step, Truth, find_truth, walked
from .stroll import legs

HARD = Transitions(morph=False, fade=False, growth=False)
"""Patches switch at once."""

PARTS = ("morph", "fade", "growth", "hysteresis")
"""What each is worth is found by leaving it out."""

SMALLEST = TILE + 2 * MARGIN + 2
"""Least side of a picture [pixels]."""

TOLD = 6
"""Frames that are told of."""


@dataclass(frozen=True, slots=True, eq=False)
class Verdict:
    """The tile of a frame in which changes of representation show the most."""

    step: Step

    at: tuple[float, float]
    """Where the tile's middle is in the picture, from the top left, as parts of its width and height."""

    flicker: float
    """How far the frame's change is from the reference's [steps of 255]."""

    steady: float
    """The same for the frame held: what it would be without its changes of representation."""

    jump: float
    """How much those changed the frame [steps of 255]."""

    @property
    def ratio(self) -> float:
        """How many times the flicker is what it would be without them."""
        return self.flicker / self.steady


def bench_pop(scene: str, *, preset: str | None, size: tuple[int, int], json: bool, parts: bool = False) -> int:
    """Walk through a scene, compare its changes with the reference's, print the figures, and return the exit status.

    With `parts` the walk is repeated with each part of the transitions left out. Before anything is drawn it raises
    MachineError where pictures cannot be compared, and InputError where they would be too small.
    """
    evaluator()
    if min(size) < SMALLEST:
        raise InputError(f"--size: {size[0]}x{size[1]}: here each side must be at least {SMALLEST} pixels")
    take = Take(scene, size, preset=preset)
    with Studio(take) as studio:
        head = {"machine": machine(studio.ctx), "scene": scene, "preset": preset or own_preset(studio.prairie)}
        result = {**head, "size": list(size), **_measure(studio, parts=parts)}
    tell(result, as_json=json)
    return 0


def _measure(studio: Studio, *, parts: bool) -> dict[str, object]:
    walk = legs(studio.prairie)
    records = {
        "nothing": walked(studio, walk, SEAMLESS, doing="walking"),
        "morph, fade, growth": walked(studio, walk, HARD, doing="switching at once"),
    }
    for part in PARTS if parts else ():
        less = replace(SEAMLESS, **{part: False})
        records[part] = walked(studio, walk, less, doing=f"walking without {part}")
    whole = records["nothing"]
    near = [each for record in records.values() for step in record.steps for each in (step.earlier, step.moment)]
    truth = find_truth(studio, walk, near, [moment for moment, _ in whole.stills])
    errors = [flip(picture, truth.whole[moment.time]) for moment, picture in whole.stills]
    verdicts = {name: judge(record, truth) for name, record in records.items()}
    result = {
        "frames": len(whole.changing),
        "error": {"p50": round(float(np.median(errors)), 5), "max": round(max(errors), 5)},
        "flicker": _figures(verdicts["nothing"][0]),
        "hard_switch_ratio": round(verdicts["morph, fade, growth"][0].ratio, 3),
        "changing": _changing(whole),
        "worst": [_row(verdict) for verdict in verdicts["nothing"][:TOLD]],
    }
    if parts:
        result["contributions"] = [
            {"without": name, **_figures(verdicts[name][0]), "changing": _changing(record)["mean"]}
            for name, record in records.items()
        ]
    return result


def judge(record: Record, truth: Truth, /) -> list[Verdict]:
    """Return a verdict on every step that was kept, the worst first."""
    return sorted((_verdict(step, truth) for step in record.steps), key=lambda verdict: -verdict.ratio)


def _verdict(one: Step, truth: Truth) -> Verdict:
    true = truth.near[one.moment.time], truth.near[one.earlier.time]
    seen, steady = flicker(one.now, one.before, *true), np.maximum(flicker(one.held, one.before, *true), LEAST)
    row, column = np.unravel_index(np.argmax(seen / steady), seen.shape)
    at = (float(column) + 0.5) / seen.shape[1], (float(row) + 0.5) / seen.shape[0]
    tile = row, column
    return Verdict(one, at, float(seen[tile]), float(steady[tile]), float(step(one.now, one.held)[tile]))


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
        "at": [round(part, 2) for part in verdict.at],
        **_figures(verdict),
        "jump": round(verdict.jump, 3),
        "changing": verdict.step.changing,
    }
