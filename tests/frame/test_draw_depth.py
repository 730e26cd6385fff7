"""Shadows of grass, in a game's own shadow map: as dark as those of every blade (N12)."""

from collections.abc import Callable
from typing import Any

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.engine.camera import Camera, view_of
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.reference import EveryBlade, terrain_cells
from tallgrass.testing import LITTLE, Stage

Array = NDArray[np.float64]
Load = Callable[..., Prairie]
Aim = Callable[..., Camera]

SCENE: dict[str, Any] = {
    "tallgrass": 2,
    "terrain": {"size": [60, 60]},
    "grass": {"turf": {"height": [0.4, 0.6], "width": 0.03, "blades": 500}},
    "light": {"azimuth": 0.0, "elevation": 25.0},
    "quality": {
        "models": 1,
        "blade_rings": [{"to": 2, "segments": 3}],
        "strip_rings": [{"to": 8, "strips": 6, "texel": 0.015}],
        "carpet_to": 16,
        "carpet": 64,
    },
}
CAMERA = Camera((0.0, 1.7, 12.0), 0.0, -0.1, np.radians(60.0))
SIDE, HALF, DEEP = 512, 6.0, 40.0
"""Side of the map [pixels]; half its side, and half its depth [m]."""

WALL = 2.0
"""z of the wall that faces the sun [m]; grass stands before it, towards -z."""


@pytest.fixture(scope="module")
def stage(ctx: moderngl.Context) -> Stage:
    return Stage(ctx, (96, 64))


def from_sun(elevation: float = 25.0) -> tuple[Array, Array]:
    """Return view and projection of a shadow map from a sun over -z, aimed at the foot of the wall."""
    e = np.radians(elevation)
    view = np.eye(4)
    view[:3, :3] = (-1.0, 0.0, 0.0), (0.0, np.cos(e), np.sin(e)), (0.0, np.sin(e), -np.cos(e))
    view[:3, 3] = -view[:3, :3] @ (0.0, 0.0, WALL)
    return view, np.diag([1.0 / HALF, 1.0 / HALF, -1.0 / DEEP, 1.0])


def darkened(depth: NDArray[np.float32]) -> Array:
    """Return the shadowed fraction of the wall at each 0.1 m of height up to 0.8 m, by a map of this depth."""
    view, projection = from_sun()
    x, y = np.meshgrid(np.linspace(-2.0, 2.0, 200), np.linspace(0.0025, 0.7975, 160))
    clip = np.stack([x, y, np.full_like(x, WALL), np.ones_like(x)], axis=-1) @ (projection @ view).T
    column, row = (np.floor((0.5 + 0.5 * clip[..., axis]) * len(depth)).astype(int) for axis in (0, 1))
    shaded = depth[::-1][row, column] < 0.5 + 0.5 * clip[..., 2] - 1e-4
    return np.asarray(shaded.reshape(8, -1).mean(axis=1))


@pytest.mark.parametrize(
    "lod", ["blades", *(pytest.param(lod, marks=pytest.mark.slow) for lod in ("strips", "carpet"))]
)
def test_n12_grass_darkens_a_wall_as_much_as_every_blade_does(
    ctx: moderngl.Context, stage: Stage, prairies: dict[str, Prairie], lod: str
) -> None:
    prairie, large, small = prairies[lod], Stage(ctx, (3 * SIDE, 3 * SIDE)), Stage(ctx, (SIDE, SIDE))
    stage.shot(prairie, CAMERA)
    small.begin()
    prairie.draw_depth(*from_sun())
    found = darkened(small.depth())
    every = EveryBlade(prairie)
    large.begin()
    every.draw(view_of(*from_sun()), terrain_cells(prairie.site.ground))
    every.release()
    due = darkened(large.depth())
    assert 0.1 < due.mean() < 0.8
    assert found.sum() == pytest.approx(due.sum(), rel=0.12)


def test_shadows_of_grass_leave_pictures_and_a_games_colours_as_they_are(
    ctx: moderngl.Context, stage: Stage, load: Load, camera: Aim
) -> None:
    prairie, aim, small = load(LITTLE), camera(0.0, 2.0, 20.0, pitch=-10), Stage(ctx, (64, 64))
    small.begin()
    prairie.draw_depth(*from_sun())  # nobody has looked yet
    assert (small.depth() == 1.0).all()
    due = stage.shot(prairie, aim)
    small.begin()
    small.target.clear(1.0, 1.0, 1.0, depth=1.0)
    prairie.draw_depth(*from_sun())
    assert (small.read() == 255.0).all()
    assert (small.depth() < 1.0).any()
    assert (stage.shot(prairie, aim) == due).all()
    texture = ctx.depth_texture((64, 64))
    alone = ctx.framebuffer(depth_attachment=texture)
    alone.use()
    alone.clear(depth=1.0)
    prairie.draw_depth(*from_sun())
    assert (np.frombuffer(texture.read(), np.float32).reshape(64, 64)[::-1] == small.depth()).all()
    with pytest.raises(TypeError, match="viewer"):
        prairie.draw_depth(*from_sun(), viewer=1)  # type: ignore[arg-type]
    alone.release()
    texture.release()
