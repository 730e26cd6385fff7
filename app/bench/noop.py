"""The child process that measures the cost of frames on the CPU alone, and prints it as a line of JSON.

Run as `python -m tallgrass.app.bench.noop`. It prints null unless the driver draws nothing, as Mesa's does with
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

Result = dict[str, object]


def draws_nothing() -> bool:
    """Return whether the driver only accepts commands."""
    ctx = standalone_context()
    try:
        return str(ctx.info["GL_RENDERER"]).startswith("NOOP")
    finally:
        ctx.release()


def still_frames(take: Take) -> Result:
    """Return the times of `bench frame`'s frames, of their systems, and of the yardstick [ms]."""
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


def walked_frames(take: Take) -> Result:
    """Return the times of `bench walk`'s frames [ms]."""
    with Studio(take) as studio:
        return {"cpu_ms": spread([pace.frame_ms for pace in paces(studio)], 50, 95, 99)}


def main() -> None:
    """Measure the take on the command line, and print the result."""
    parser = ArgumentParser()
    parser.add_argument("scene")
    parser.add_argument("--size", type=parse_size, required=True)
    parser.add_argument("--preset")
    parser.add_argument("--walk", action="store_true")
    options = parser.parse_args()
    take = Take(options.scene, options.size, preset=options.preset)
    measure = walked_frames if options.walk else still_frames
    print(json.dumps(measure(take) if draws_nothing() else None))


if __name__ == "__main__":
    main()
