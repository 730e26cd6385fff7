"""A real elevation model in place of a bundled scene's made-up hills: one line of the scene changes."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image
from PIL.TiffImagePlugin import ImageFileDirectory_v2

from tallgrass.app.check import check
from tallgrass.engine.camera import Camera
from tallgrass.engine.scene import bundled_scenes
from tallgrass.systems.prairie import Prairie

CELL = 20.0
PIXEL_SCALE, DOUBLE = 33550, 12
QUALITY = """\
quality:
  blades: 20
  models: 1
  blade_rings: [{ to: 1, segments: 2 }]
  strip_rings: [{ to: 3, strips: 2, columns: 1, sections: 1, texel: 0.03 }]
  carpet_to: 10
  carpet: 16
"""


def surveyed() -> NDArray[np.float32]:
    """Return heights of 300 by 400 cells of 20 m: hills of 90 m, 700 m above the sea, rough to the decimetre."""
    z, x = (np.arange(count) * CELL for count in (300, 400))
    rough = np.random.default_rng(3).normal(0.0, 0.1, (300, 400))
    return (700 + 45 * np.sin(z / 260)[:, None] * np.cos(x / 190)[None, :] + rough).astype(np.float32)


def save_tiff(path: Path, values: NDArray[Any]) -> None:
    tags = ImageFileDirectory_v2()
    tags.tagtype[PIXEL_SCALE], tags[PIXEL_SCALE] = DOUBLE, (CELL, CELL, 0.0)
    Image.fromarray(values).save(path, tiffinfo=tags)


def meadow(folder: Path, old: str, new: str) -> Path:
    """Write the bundled meadow with one line changed, at a quality that is grown in a moment; return the file."""
    source = bundled_scenes()["meadow"]
    text, changed = re.subn(old, new, source.read_text("utf-8"), flags=re.MULTILINE)
    assert changed == 1
    path = folder / "mine.yaml"
    path.write_text(text.replace("quality: high\n", QUALITY), "utf-8")
    (folder / "meadow-density.png").write_bytes((source.parent / "meadow-density.png").read_bytes())
    return path


def grey(values: NDArray[np.float32]) -> NDArray[np.uint16]:
    grey_levels: NDArray[np.uint16] = np.round((values - values.min()) / np.ptp(values) * 65535).astype(np.uint16)
    return grey_levels


@pytest.mark.parametrize(
    ("new", "relief"),
    [
        ("terrain: { heights: dem.tif }", 90.0),
        pytest.param("terrain: { heights: dem.png, cell: 20, scale: 90 }", 90.0, marks=pytest.mark.slow),
    ],
)
def test_an_elevation_model_stands_in_for_the_meadows_hills(
    new: str, relief: float, tmp_path: Path, stage: Any, camera: Callable[..., Camera]
) -> None:
    save_tiff(tmp_path / "dem.tif", surveyed())
    Image.fromarray(grey(surveyed())).save(tmp_path / "dem.png")
    path = meadow(tmp_path, r"^terrain: .*$", new)
    assert check([str(path)]) == 0
    prairie = Prairie.load(path, ctx=stage.ctx)
    try:
        assert prairie.site.ground.terrain.size == pytest.approx((399 * CELL, 299 * CELL))
        assert np.ptp(prairie.site.ground.terrain.heights) == pytest.approx(relief, abs=2.0)
        above = float(prairie.height_at([(0, 0)])[0]) + 3.0
        picture = stage.shot(prairie, camera(0, above, 0, pitch=-30))
    finally:
        prairie.release()
    green, blue = picture[45:, :, 1].mean(), picture[45:, :, 2].mean()
    assert green > blue + 20.0, "the lower half shows no grass"


@pytest.mark.parametrize("name", ["dem.tif", "dem.png"])
def test_only_the_word_noise_has_to_go_and_the_size_keeps_the_middle(name: str, tmp_path: Path) -> None:
    save_tiff(tmp_path / "dem.tif", surveyed())
    Image.fromarray(grey(surveyed())).save(tmp_path / "dem.png")
    path = meadow(tmp_path, "noise: rolling", f"heights: {name}")
    assert check([str(path)]) == 0
    prairie = Prairie.load(path)
    terrain = prairie.site.ground.terrain
    prairie.release()
    assert terrain.size == pytest.approx((240.0, 240.0), abs=2.5)
    if name == "dem.tif":
        middle = surveyed()[143:157, 193:207]
        assert middle.min() - 1.0 < terrain.heights.min() < terrain.heights.max() < middle.max() + 1.0
