"""Where the carpet's mesh changes its height, no gap shows below it (F4)."""

from pathlib import Path

import moderngl
import numpy as np
from PIL import Image

from tallgrass import Prairie
from tallgrass.testing import Stage, looking, private_world

SCENE = """\
tallgrass: 2
terrain: { size: [80, 80] }
grass:
  turf: { height: [0.1, 0.2], root: "#406020", tip: "#80a040", blades: 300, place: { map: turf.png } }
  reed: { height: [1.4, 1.6], root: "#406020", tip: "#80a040", blades: 300, place: { map: reed.png } }
quality:
  models: 1
  blade_rings: [{ to: 1, segments: 2 }]
  strip_rings: [{ to: 3, strips: 2, texel: 0.03 }]
  carpet_to: 40
"""


def test_no_ground_shows_where_tiles_in_which_grass_ends_begin_behind_lower_grass(
    ctx: moderngl.Context, tmp_path: Path
) -> None:
    reed = np.zeros((80, 80), np.uint8)
    reed[:6] = 255  # far off, behind the turf
    Image.fromarray(reed).save(tmp_path / "reed.png")
    Image.fromarray(255 - reed).save(tmp_path / "turf.png")
    (tmp_path / "ends.yaml").write_text(SCENE, "utf-8")
    stage = Stage(ctx, (240, 135))
    with private_world():
        prairie = Prairie.load(tmp_path / "ends.yaml", ctx=ctx)
        stage.begin()
        prairie.draw(*stage.matrices(looking(0.0, 3.0, 12.0, pitch=-4.0, view=14.0)))
        seen = stage.read()
        prairie.release()
    around = seen[45:75, :, 1]  # its green, about where reeds begin
    assert around.mean() > 95.0
    assert (around < 75.0).mean() < 0.002
