"""Pictures of the frames in which changes of representation show the most."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from ..studio.encode import Picture, picture_writer
from .flicker import TILE
from .verdict import Verdict

AMPLIFIED = 8
"""How many times a step is shown as large as it is."""

RED = (255, 0, 0)


def save(verdicts: list[Verdict], folder: str, about: Mapping[str, str], /) -> None:
    """Write `evidence` for each verdict into a folder: `1-ahead-015.png` is the worst, frame 15 of the leg ahead."""
    for rank, verdict in enumerate(verdicts, 1):
        moment = verdict.step.moment
        name = f"{rank}-{moment.leg.name}-{moment.number:03}.png"
        picture_writer(str(Path(folder) / name))(evidence(verdict), {**about, "time": f"{moment.time:.6g}"})


def evidence(verdict: Verdict, /) -> Picture:
    """Return the frame with its tile framed, and beside it its changes of representation, (height, 2 * width, 3).

    They are shown `AMPLIFIED`.
    """
    now, held = verdict.step.now, verdict.step.held
    step = np.minimum(np.abs(now.astype(np.int16) - held) * AMPLIFIED, 255).astype(np.uint8)
    framed, (left, top) = now.copy(), verdict.corner
    framed[[top, top + TILE - 1], left : left + TILE] = RED
    framed[top : top + TILE, [left, left + TILE - 1]] = RED
    return np.concatenate([framed, step], axis=1)
