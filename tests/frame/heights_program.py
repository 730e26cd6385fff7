"""A program that digs 20 by 20 m before its eye on 10 km of terrain: what `test_heights.py` runs without a rasteriser.

It prints one line of JSON: the processor times of frames [s] in which it digs, and of those next to them.
"""

import json
import sys
from time import process_time

import numpy as np

from tallgrass import Prairie
from tallgrass.testing import headless_context, looking, stage

SIDE, CELL = 4097, 2.5
HOLE = 9
"""Number of samples along a side: 20 m."""

WARM, TIMES = 40, 40
SHALLOW = 2.0
"""Depth [m] whose sides are steep enough to have rims, so that none comes or goes: the mesh would be laid out anew."""


def main() -> None:
    """Dig in some frames and wait in others; the driver draws nothing."""
    scene = {
        "tallgrass": 2,
        "terrain": {"heights": np.zeros((SIDE, SIDE), np.float32), "cell": CELL},
        "grass": {"green": {"height": [0.3, 0.5]}},
        "wind": [{"kind": "breeze", "strength": 0.4}],
        "quality": "high",
    }
    times: dict[str, list[float]] = {"digs": [], "rests": []}
    with headless_context() as ctx, stage(ctx) as drawn:
        prairie = Prairie.load(scene, ctx=ctx, live=False)
        aim = drawn.matrices(looking(0.0, 2.0, 0.0, pitch=-5))
        drawn.begin()
        for number in range(-WARM, 3 * TIMES):
            start = process_time()
            if number % 3 == 0:
                depth = SHALLOW + number % 2
                prairie.set_heights((-10.0, -30.0), np.full((HOLE, HOLE), -depth, np.float32))
            prairie.advance(1.0 / 60.0)
            prairie.draw(*aim)
            if number >= 0:
                times["digs" if number % 3 == 0 else "rests"].append(process_time() - start)
        prairie.release()
    json.dump(times, sys.stdout)


if __name__ == "__main__":
    main()
