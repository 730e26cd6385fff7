"""A program that makes a village, a crater and a field without files, or loads them: `test_sown.py` runs it twice.

Its arguments: the path of the state, the path of the picture, and `make` or `load`.
"""

import sys
from pathlib import Path

import numpy as np

from tallgrass import Footprint, Pose, Prairie, Road
from tallgrass.testing import headless_context, looking, stage

HOUSE = Footprint(corners=((-4.0, -3.0), (4.0, -3.0), (4.0, 3.0), (-4.0, 3.0)))


def scene() -> dict[str, object]:
    """Return rolling ground, grass, and a field that is painted by an array."""
    field = np.zeros((40, 40), np.float32)
    field[4:14, 6:20] = 1.0
    rolling = np.add.outer(np.sin(np.arange(81.0) / 9.0), np.cos(np.arange(81.0) / 7.0))
    return {
        "tallgrass": 2,
        "terrain": {"heights": rolling, "cell": 1.0},
        "grass": {"green": {"height": [0.3, 0.5]}, "wheat": {"height": [0.7, 0.9], "place": {"map": field}}},
        "wind": [{"kind": "breeze", "strength": 0.4}],
        "quality": "low",
    }


def make(prairie: Prairie) -> None:
    """Build the village, the crater and a well."""
    for x, z, yaw in ((-12.0, 10.0, 0.2), (3.0, 14.0, -0.4), (14.0, 8.0, 0.1)):
        prairie.clear(HOUSE, pose=Pose(x, z, yaw))
    prairie.clear(Road(((-35.0, 18.0), (-4.0, 19.0), (10.0, 16.0), (36.0, 22.0)), 2.5), soft=0.6)
    prairie.sow("wheat", Footprint(radius=5.0), 0.6, soft=2.0, pose=Pose(20.0, -8.0))
    prairie.cut(Footprint(radius=1.0, length=12.0), 0.06, pose=Pose(-2.0, 4.0, 1.2))
    crater = -1.5 * np.outer(np.hanning(13), np.hanning(13))
    prairie.set_heights((6.0, 20.0), np.full((3, 3), np.nan))
    prairie.set_heights((-12.0, -8.0), prairie.site.ground.terrain.heights[32:45, 28:41] + crater)


def main() -> None:
    """Make the village and save it, or load it; then draw it."""
    state, picture, how = sys.argv[1:]
    with headless_context() as ctx, stage(ctx) as drawn:
        prairie = Prairie.load(scene(), ctx=ctx, live=False)
        if how == "make":
            make(prairie)
            prairie.advance(3.25)
            Path(state).write_bytes(prairie.state())
        else:
            prairie.restore(Path(state).read_bytes())
        np.save(picture, drawn.shot(prairie, looking(0.0, 9.0, 36.0, pitch=-18)).astype(np.uint8))
        prairie.release()


if __name__ == "__main__":
    main()
