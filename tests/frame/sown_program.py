"""A program that sows and clears before its eye on 10 km of terrain: what `test_sown.py` runs without a rasteriser.

It prints one line of JSON: processor times of frames [s] in which it sows, and of the frames next to them; and those of
1,000 strokes, 16 of them before each frame.
"""

import json
import sys
from time import process_time

import numpy as np

from tallgrass import Footprint, Pose, Prairie
from tallgrass.testing import headless_context, looking, stage

SQUARE = Footprint(corners=((-10.0, -10.0), (10.0, -10.0), (10.0, 10.0), (-10.0, 10.0)))
"""20 by 20 m."""

WARM, TIMES = 40, 40


def main() -> None:
    """Sow and clear in some frames and wait in others; the driver draws nothing."""
    scene = {
        "tallgrass": 2,
        "terrain": {"size": [10_000, 10_000], "cell": 10.0},
        "grass": {"green": {"height": [0.3, 0.5]}, "wheat": {"height": [0.7, 0.9]}},
        "wind": [{"kind": "breeze", "strength": 0.4}],
        "quality": "high",
    }
    times: dict[str, list[float]] = {"strokes": [], "rests": [], "thousand": []}
    random = np.random.default_rng(0)
    with headless_context() as ctx, stage(ctx) as drawn:
        prairie = Prairie.load(scene, ctx=ctx, live=False)
        drawn.begin()
        walked = 0.0

        def frame() -> None:
            nonlocal walked
            walked += 1.5 / 60.0
            prairie.advance(1.0 / 60.0)
            prairie.draw(*drawn.matrices(looking(walked, 2.0, 0.0, pitch=-5)))

        frame()
        prairie.prepare()

        for number in range(-WARM, 3 * TIMES):
            start = process_time()
            if number % 3 == 0:
                pose = Pose(*random.uniform((-10.0, -60.0), (10.0, -20.0)).tolist())
                if number % 2 == 0:
                    prairie.clear(SQUARE, pose=pose)
                else:
                    prairie.sow("wheat", SQUARE, 1.0, pose=pose)
            frame()
            if number >= 0:
                times["strokes" if number % 3 == 0 else "rests"].append(process_time() - start)
        start = process_time()
        for number in range(1000):
            pose = Pose(*random.uniform((-30.0, -60.0), (30.0, 0.0)).tolist())
            prairie.clear(Footprint(radius=0.5), pose=pose)
            if number % 16 == 15:
                frame()
        times["thousand"].append(process_time() - start)
        prairie.release()
    json.dump(times, sys.stdout)


if __name__ == "__main__":
    main()
