"""Pictures from cameras that nobody tuned for, each beside the reference (G3, G4, G5).

The scenes stand in `tests/cameras`. `tallgrass bench picture tests/cameras` prints the same figures of larger pictures,
finer references, and rivals. `today.toml` has the shortfall of each camera. None may get worse. Where one gets
better, `TALLGRASS_RECORD=1` in the environment, in one process (`-n 0`), writes the file again. The goals are the
constants here.
"""

import os
import tomllib
from collections.abc import Iterator
from pathlib import Path

import moderngl
import pytest

from tallgrass import testing
from tallgrass.app.bench.contrast import contrast
from tallgrass.app.bench.flip import MOMENT, flip
from tallgrass.app.bench.picture import bands
from tallgrass.engine.camera import camera_at
from tallgrass.engine.gl.rasteriser import draws_in_software
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.reference import draw_truth, patch_distances
from tallgrass.testing import Stage

pytest.importorskip("flip_evaluator")

CAMERAS = Path(__file__).parents[1] / "cameras"
TODAY = CAMERAS / "today.toml"
SIZE, SAMPLES = (160, 180), 4
"""Size of pictures [pixels], narrow, as blades of references take long; and samples across a pixel."""

GOAL = {"luminance": 0.05, "hue": 3.0, "contrast": 0.8, "flip": 0.0}
"""Largest errors of the worst band's luminance and hue [degrees], least contrast, and FLIP."""

LOW_CONTRAST = 0.7
"""Least contrast at preset low."""

ROOM = {"luminance": 0.003, "hue": 0.2, "contrast": 0.01, "flip": 0.001}
CARDS_ROOM = {"luminance": 0.006, "hue": 0.4, "contrast": 0.02, "flip": 0.003}
"""Tolerances for other rasterisers and cards than that of the recorded figures."""

QUICK = {"bare", "dusk", "saucer", "telephoto", "thin"}
"""Cameras whose grass grows in a moment, and that together show most artefacts."""

Figures = dict[str, float]


@pytest.fixture(scope="module")
def stage(ctx: moderngl.Context) -> Iterator[Stage]:
    """A stage as large as the pictures."""
    with testing.stage(ctx, SIZE) as made:
        yield made


@pytest.fixture(scope="module")
def today() -> Iterator[dict[str, Figures]]:
    """Recorded figures by camera; with TALLGRASS_RECORD=1 those of this run replace them in the file."""
    told: dict[str, Figures] = tomllib.loads(TODAY.read_text("utf-8"))
    yield told
    if os.environ.get("TALLGRASS_RECORD") == "1":
        lines = [f"[{name}]\n" + "".join(f"{key} = {value}\n" for key, value in told[name].items()) for name in told]
        TODAY.write_text("\n".join(lines), "utf-8")


def measured(stage: Stage, prairie: Prairie) -> Figures:
    """Return the figures of the picture from a scene's own camera against the reference."""
    prairie.advance(MOMENT)
    view, projection = stage.matrices(camera_at(prairie.scene.camera, None, prairie.height_at))
    stage.begin()
    prairie.draw(view, projection)
    seen = stage.read().astype("uint8")
    truth = draw_truth(prairie, view, projection, SIZE, samples=SAMPLES)
    distance = patch_distances(prairie, view, projection, SIZE)
    rows = bands(seen, truth.picture, distance, prairie.site.quality)
    kept = contrast(seen, truth, distance >= 0)
    return {
        "luminance": round(max(abs(float(str(row["luminance_ratio"])) - 1.0) for row in rows), 4),
        "hue": max(float(str(row["hue_degrees"])) for row in rows),
        "contrast": 1.0 if kept is None else round(kept, 4),
        "flip": round(flip(seen, truth.picture), 5),
    }


def test_there_are_more_than_twenty_cameras_in_three_presets() -> None:
    told = [path.read_text("utf-8") for path in CAMERAS.glob("*.yaml")]
    assert len(told) > 20
    for preset in ("low", "medium", "high"):
        assert any(f"quality: {preset}\n" in text for text in told)


@pytest.mark.parametrize(
    "camera",
    [
        pytest.param(name, marks=() if name in QUICK else pytest.mark.slow)
        for name in sorted(path.stem for path in CAMERAS.glob("*.yaml"))
    ],
)
def test_g5_a_picture_is_as_true_as_it_was(
    ctx: moderngl.Context, stage: Stage, today: dict[str, Figures], camera: str
) -> None:
    prairie = Prairie.load(CAMERAS / f"{camera}.yaml", ctx=ctx, live=False)
    low = prairie.scene.quality == "low"
    try:
        figures = measured(stage, prairie)
    finally:
        prairie.release()
    if os.environ.get("TALLGRASS_RECORD") == "1":
        today[camera] = figures
        return
    goal = GOAL | {"contrast": LOW_CONTRAST if low else GOAL["contrast"]}
    room = ROOM if draws_in_software(ctx) else CARDS_ROOM
    for name in ("luminance", "hue", "flip"):
        assert figures[name] <= max(goal[name], today[camera][name]) + room[name], name
    assert figures["contrast"] >= min(goal["contrast"], today[camera]["contrast"]) - room["contrast"]
