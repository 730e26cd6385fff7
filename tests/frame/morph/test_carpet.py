"""The carpet stays in place while it rises where strips give way, and while one walks (X4)."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import moderngl
import numpy as np
import pytest

from tallgrass.engine.camera import Camera
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.show.carpet import painter
from tallgrass.testing import Stage

SCENE = """\
tallgrass: 2
terrain: { size: [60, 60], noise: flat }
grass: { turf: { height: [0.3, 0.5], width: 0.02, blades: 400 } }
quality:
  models: 2
  blade_rings: [{ to: 1, segments: 2 }]
  strip_rings: [{ to: 2, strips: 2, texel: 0.05 }]
  carpet_to: 16
  carpet: 64
"""
LOW = Camera((0.0, 1.5, 20.0), 0.0, -0.1, np.radians(20.0))


def test_x4_grass_and_litter_stay_where_they_are_while_the_carpet_rises(
    ctx: moderngl.Context, load: Callable[..., Prairie], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its cover grows from two to four fifths: at this angle it rises by three rows of pixels."""
    stage, seen = Stage(ctx, (240, 120)), []
    for share in (102, 204):
        lying = partial(np.full, fill_value=share, dtype=np.uint8)
        monkeypatch.setattr(painter, "_shares", lambda patches, _, lying=lying: lying(len(patches.alive)))
        picture = stage.shot(load(SCENE, lod="carpet"), LOW)[70:].mean(axis=2)
        seen.append((picture - picture.mean(axis=1, keepdims=True)).ravel())
    assert np.corrcoef(*seen)[0, 1] > 0.7


@pytest.mark.parametrize("coarse", ["false", "true"])
def test_x4_a_far_carpet_does_not_twinkle_when_the_eye_moves(
    ctx: moderngl.Context, load: Callable[..., Prairie], coarse: str
) -> None:
    """Raised by a tenth of a pixel, a picture changes by about a tenth of the differences between its pixels."""
    stage, prairie = Stage(ctx, (240, 120)), load(SCENE + f"  coarse: {coarse}\n", lod="carpet")
    aim = Camera((0.0, 2.0, 28.0), 0.0, -0.06, np.radians(5.0))
    before, after = (
        stage.shot(prairie, replace(aim, pitch=aim.pitch + by * aim.view / 120)).mean(axis=2) for by in (0.0, 0.1)
    )
    uneven = (before - before.mean(axis=1, keepdims=True)).std()
    assert uneven > 3.0
    assert np.abs(after - before).mean() < 0.2 * uneven
