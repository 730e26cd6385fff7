"""Wind far off, where no patches have receivers: the carpet shows it all the same (F6, W1)."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.components.arrays import Floats
from tallgrass.components.pose import Pose
from tallgrass.components.wind import WindPrimitive
from tallgrass.engine.camera import Camera
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.reference import carpet_painter
from tallgrass.systems.show.carpet.air import FAR_LEVELS, FAR_SIDE, reach_of, seen_within
from tallgrass.systems.wind.breeze import Breeze
from tallgrass.systems.wind.gust import Gust
from tallgrass.testing import Stage

Load = Callable[..., Prairie]

WIDE = """\
tallgrass: 2
terrain: { size: [440, 440] }
grass: { turf: { height: [0.4, 0.7], width: 0.02, root: "#304018", tip: "#d8d0a0" } }
light: { azimuth: 60, elevation: 35, turbidity: 2 }
quality: low
"""
CAMERA = Camera((0.0, 25.0, 100.0), 0.0, np.radians(-12.0), np.radians(40.0))
STRENGTH, AWAY = 0.6, 130.0
"""Posture index in a gust, and its distance [m]: patches within 81 m have receivers."""


def gust_ahead() -> Gust:
    """Return a broad gust towards the eye, whose front is `AWAY` after 2 s, and 40 m deep."""
    start = CAMERA.position[2] - AWAY - 20.0
    return Gust(
        position=[0.0, start], direction=180.0, width=400.0, speed=10.0, reach=300.0, strength=STRENGTH, hold=4.0,
        ragged=0.0, soft=0.0, swing=0.0,
    )  # fmt: skip


def told_far(prairie: Prairie, level: int) -> tuple[Floats, Floats]:
    """Return the middles of a far window's texels that may be seen, (n, 2), and their messages, (n, 2)."""
    viewer, patch = prairie.viewers["main"].viewer, prairie.site.ground.patch
    assert prairie.painter is not None
    texels = np.frombuffer(carpet_painter(prairie.painter).air.far.read(), np.float32).reshape(-1, FAR_SIDE, 2)
    patches = 2.0 ** (level + 1)
    low = np.floor(viewer.centre / patches) - FAR_SIDE // 2
    x, z, width, depth = seen_within(tuple(np.array(viewer.eye[::2]) / (patch * patches) - low), reach_of(viewer.cone))
    on = np.stack(np.meshgrid(np.arange(x, x + width), np.arange(z, z + depth)), -1)
    found = texels[level * FAR_SIDE + on[..., 1], on[..., 0]]
    return ((on + 0.5 + low) * patch * patches).reshape(-1, 2).astype(np.float32), found.reshape(-1, 2)


@pytest.mark.parametrize("half", [0.0, 0.10451706097138791, 0.8, 2.9, np.pi])
def test_r1_what_is_computed_far_off_holds_all_of_the_view_cone(half: float) -> None:
    """Ends of a cone are in it, whatever rounding says of them."""
    for middle in [*np.linspace(-7.0, 7.0, 57).tolist(), 1.8325957183859378]:
        rays = np.linspace(middle - half, middle + half, 101)
        ways = np.column_stack([np.sin(rays), -np.cos(rays)])
        least, most = np.split(np.array(reach_of((middle, half))), 2)
        assert ((-least <= ways.min(axis=0)) & (ways.max(axis=0) <= most)).all()


def test_w1_windows_beyond_the_patches_are_told_the_wind_where_they_are_seen(stage: Stage, load: Load) -> None:
    prairie = load(WIDE, lod="carpet")
    for wind in (Breeze(strength=0.3, gustiness=0.8, swing=0.0), gust_ahead()):
        prairie.add(wind, pose=Pose() if isinstance(wind, Breeze) else None)
    prairie.advance(2.0)
    stage.shot(prairie, CAMERA)
    for level in range(FAR_LEVELS):
        place, told = told_far(prairie, level)
        due = prairie.wind_at(place, kind="turf")
        assert len(place) < 0.6 * FAR_SIDE**2, "only what may be seen is computed"
        if level:  # the mean of two places
            assert np.corrcoef(told.ravel(), due.ravel())[0, 1] > 0.9
        else:
            np.testing.assert_allclose(told, due, atol=1e-3)
    assert np.linalg.norm(due, axis=1).max() > 0.5


class UntwinnedBreeze(Breeze):
    """A breeze that numpy alone computes."""

    twin = None


@pytest.mark.parametrize("kind", [Breeze, UntwinnedBreeze])
def test_d5_winds_without_a_twin_blow_far_off_too(stage: Stage, load: Load, kind: type[Breeze]) -> None:
    prairie = load(WIDE, lod="carpet")
    prairie.add(kind(direction=90.0, strength=0.4, gustiness=0.0, swing=0.0), pose=Pose())
    stage.shot(prairie, CAMERA)
    _, told = told_far(prairie, 0)
    np.testing.assert_allclose(told, np.broadcast_to((0.4, 0.0), told.shape), atol=1e-3)


def changed(stage: Stage, prairie: Prairie, wind: WindPrimitive, *, time: float) -> NDArray[np.float64]:
    """Return the change of each row's brightness that a wind has made after a time [s], shape (rows,)."""
    calm = stage.shot(prairie, CAMERA).astype(np.float64)
    handle = prairie.add(wind, pose=Pose() if isinstance(wind, Breeze) else None)
    prairie.advance(time)
    blown = stage.shot(prairie, CAMERA).astype(np.float64)
    prairie.remove(handle)
    rows: NDArray[np.float64] = (blown - calm).mean(axis=(1, 2))
    return rows


@pytest.mark.parametrize("preset", ["low", "high"])
def test_f6_a_gust_far_off_changes_grass_as_much_as_the_same_wind_everywhere(
    stage: Stage, load: Load, preset: str
) -> None:
    prairie = load(WIDE, lod="carpet", preset=preset)
    everywhere = changed(stage, prairie, Breeze(direction=180.0, strength=STRENGTH, gustiness=0.0, swing=0.0), time=0.0)
    by_gust = changed(stage, prairie, gust_ahead(), time=3.0)
    slope = CAMERA.position[1] / (AWAY + 5.0)  # into the gust
    row = round(stage.size[1] * (0.5 + 0.5 * np.tan(np.arctan(slope) + CAMERA.pitch) / np.tan(0.5 * CAMERA.view)))
    rows = slice(row - 1, row + 2)
    assert np.abs(everywhere[rows]).mean() > 1.5
    assert by_gust[rows].mean() == pytest.approx(everywhere[rows].mean(), rel=0.25)
