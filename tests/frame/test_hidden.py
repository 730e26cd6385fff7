"""Hidden parts of strips and blades are not drawn, unless the grass before them is gone (G5)."""

from collections.abc import Callable
from dataclasses import replace

import esper
import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass import Patch
from tallgrass.engine.camera import Camera
from tallgrass.systems import painter
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.show.blades.painter import HIDING
from tallgrass.testing import Stage

Load = Callable[..., Prairie]

SCENE = """\
tallgrass: 2
terrain: { size: [30, 80], noise: flat }
grass: { turf: { height: [0.5, 0.7], width: 0.03, blades: 700 } }
quality:
  models: 2
  blade_rings: [{ to: 1, segments: 2 }]
  strip_rings: [{ to: 12, strips: 3, texel: 0.02 }]
  carpet_to: 16
  carpet: 64
"""
CAMERA = Camera((0.0, 1.1, 20.0), 0.0, -0.1, np.radians(30.0))

HILL = SCENE.replace("[30, 80], noise: flat", "[60, 60], noise: hills, seed: 6, feature: 40, scale: 6").replace(
    "width: 0.03, blades: 700", "width: 0.04, blades: 500, clumping: 0.95"
)

IN_GRASS = Camera((0.0, 0.12, 20.0), 0.0, 0.05, np.radians(30.0))


def drawn(stage: Stage, prairie: Prairie, camera: Camera = CAMERA) -> tuple[NDArray[np.float64], int]:
    """Return the picture, and the number of samples drawn."""
    stage.shot(prairie, camera)
    query = stage.ctx.query(samples=True)
    with query:
        picture = stage.shot(prairie, camera)
    return picture, query.samples


@pytest.fixture(scope="module")
def room(ctx: moderngl.Context) -> Stage:
    return Stage(ctx, (240, 120))


@pytest.mark.parametrize("lod", ["strips", "blades"])
def test_g5_what_leaves_hide_costs_nothing_and_nobody_misses_it(
    room: Stage, load: Load, monkeypatch: pytest.MonkeyPatch, lod: str
) -> None:
    prairie = load(SCENE, lod=lod)
    seen, few = drawn(room, prairie)
    monkeypatch.setattr(painter, "_is_open", lambda *_: True)
    due, all_ = drawn(room, prairie)
    assert few < 0.9 * all_
    assert np.abs(seen - due).mean() < 0.5
    assert np.quantile(np.abs(seen - due), 0.999) < 14.0


@pytest.mark.parametrize("lod", ["strips", "blades"])
def test_g5_an_eye_among_stems_sees_no_sky_in_place_of_grass_that_others_hide(
    room: Stage, load: Load, monkeypatch: pytest.MonkeyPatch, lod: str
) -> None:
    prairie = load(SCENE, lod=lod)
    seen, _ = drawn(room, prairie, IN_GRASS)
    monkeypatch.setattr(painter, "_is_open", lambda *_: True)
    due, _ = drawn(room, prairie, IN_GRASS)
    np.testing.assert_array_equal(seen, due)


@pytest.mark.parametrize("lod", ["strips", "blades"])
def test_g5_no_sky_shows_in_the_gaps_between_tufts_on_a_hilltop(
    room: Stage, load: Load, monkeypatch: pytest.MonkeyPatch, lod: str
) -> None:
    prairie = load(HILL, lod=lod)
    places = np.stack(np.meshgrid(*[np.linspace(-25.0, 25.0, 41, dtype=np.float32)] * 2), -1).reshape(-1, 2)
    heights = prairie.height_at(places)
    low, top = places[heights.argmin()], places[heights.argmax()]
    aim = Camera((float(low[0]), float(heights.min()) + 1.1, float(low[1])), 0.0, 0.14, np.radians(25.0))
    uphill = replace(aim, yaw=float(np.arctan2(top[0] - low[0], low[1] - top[1])))
    seen, _ = drawn(room, prairie, uphill)
    monkeypatch.setattr(painter, "_is_open", lambda *_: True)
    due, _ = drawn(room, prairie, uphill)
    assert (seen - due).max() < 30.0


def test_where_blades_are_few_nobody_asks_what_hides_them(
    room: Stage, load: Load, monkeypatch: pytest.MonkeyPatch
) -> None:
    prairie = load(SCENE.replace("  models: 2", f"  models: 2\n  blades: {HIDING - 1}"), lod="blades")
    drawn_of_all = drawn(room, prairie)[1]
    monkeypatch.setattr(painter, "_is_open", lambda *_: True)
    assert drawn(room, prairie)[1] == drawn_of_all


def test_n3_strips_stand_whole_as_soon_as_a_patch_is_cleared(
    room: Stage, load: Load, monkeypatch: pytest.MonkeyPatch
) -> None:
    prairie = load(SCENE, lod="strips")
    before = drawn(room, prairie)[1]
    cleared = next(each for _, each in esper.get_component(Patch) if each.cell == (0, 0))
    cleared.grows = False
    bare = drawn(room, prairie)[1]
    with monkeypatch.context() as patched:
        patched.setattr(painter, "_is_open", lambda *_: True)
        assert drawn(room, prairie)[1] == bare
    cleared.grows = True
    assert drawn(room, prairie)[1] == before < bare
