"""The child process that measures what frames cost on the CPU alone, and prints it as a line of JSON.

Run as `python -m tallgrass.app.bench.noop`. It tells null unless the driver draws nothing, as Mesa's does with
GALLIUM_NOOP=1.
"""

import json
from argparse import ArgumentParser

from ..studio.offscreen import standalone_context
from ..studio.studio import Studio
from ..studio.take import Take, parse_size
from ..studio.timing import spread
from .machine import yardstick_ms
from .still import FRAMES, Still
from .walk import paces

Told = dict[str, object]


def draws_nothing() -> bool:
    """Return whether the driver only takes commands."""
    ctx = standalone_context()
    try:
        return str(ctx.info["GL_RENDERER"]).startswith("NOOP")
    finally:
        ctx.release()


def still_frames(take: Take) -> Told:
    """Return what the frames of `bench frame` take here, the systems in them, and the yardstick [ms]."""
    times: list[float] = []
    systems: dict[str, list[float]] = {}
    with Studio(take) as studio:
        still = Still(studio)
        for _ in range(FRAMES):
            times.append(still.step())
            for name, milliseconds in studio.prairie.statistics.systems_ms.items():
                systems.setdefault(name, []).append(milliseconds)
    return {
        "cpu_ms": spread(times, 50, 95),
        "cpu_by_system_ms": {name: spread(each, 50)["p50"] for name, each in systems.items()},
        "yardstick_ms": yardstick_ms(),
    }


def walked_frames(take: Take) -> Told:
    """Return what the frames of `bench walk` take here [ms]."""
    with Studio(take) as studio:
        return {"cpu_ms": spread([pace.frame_ms for pace in paces(studio)], 50, 95, 99)}


def main() -> None:
    """Measure what the command line says."""
    parser = ArgumentParser()
    parser.add_argument("scene")
    parser.add_argument("--size", type=parse_size, required=True)
    parser.add_argument("--preset")
    parser.add_argument("--walk", action="store_true")
    told = parser.parse_args()
    take = Take(told.scene, told.size, preset=told.preset)
    measure = walked_frames if told.walk else still_frames
    print(json.dumps(measure(take) if draws_nothing() else None))


if __name__ == "__main__":
    main()
