"""The map from above."""

from collections.abc import Callable
from math import atan2, pi
from typing import Any

import numpy as np
import pytest

from tallgrass.components.wind import WindSource
from tallgrass.systems.around.outlook import Outlook
from tallgrass.systems.overlay.chart import CULLED, Sheet, chart, sheet_for
from tallgrass.systems.overlay.masks import Masked, masked
from tallgrass.systems.overlay.paint import ring_shades
from tallgrass.systems.site import Site
from tallgrass.systems.wind.blow import blowing
from tallgrass.systems.wind.quarantine import Quarantine
from tallgrass.systems.wind.whirlwind import Whirlwind

Laid = Callable[..., Site]
Look = Callable[..., Outlook]


@pytest.fixture
def site(laid: Laid) -> Site:
    return laid()


@pytest.fixture
def outlook(site: Site, look: Look) -> Outlook:
    return look(site, 1.0, 1.0, yaw=0.7)


@pytest.fixture
def sheet(outlook: Outlook, site: Site) -> Sheet:
    return sheet_for(outlook, site, left=100.0, bottom=50.0, side=200.0)


def storm() -> list[Masked]:
    quarantine = Quarantine()
    winds = [Whirlwind(position=[3.0, -4.0], radius=4.0), Whirlwind(position=[18.0, 0.0], radius=5.0)]
    acting = blowing([WindSource(wind, "w") for wind in winds], quarantine, time=1.0, seed=1)
    return masked(acting, quarantine, time=1.0, around=(0.0, 0.0), far=60.0)


@pytest.mark.parametrize("cone", [(0.0, 0.5), (2.0, 0.9), (-2.5, 0.1), (0.0, pi)])
def test_n8_the_map_stays_within_its_rectangle(
    outlook: Outlook, site: Site, sheet: Sheet, cone: tuple[float, float]
) -> None:
    outlook.viewer.cone = cone
    marks = chart(outlook, site, storm(), sheet)
    for places in (marks.shapes["place"], marks.lines["a"], marks.lines["b"]):
        assert places[:, 0].min() >= 100.0 - 1e-2
        assert places[:, 0].max() <= 300.0 + 1e-2
        assert places[:, 1].min() >= 50.0 - 1e-2
        assert places[:, 1].max() <= 250.0 + 1e-2


def test_n8_the_map_has_ahead_at_its_top_and_right_at_its_right(sheet: Sheet) -> None:
    places = sheet.place(np.array([[1.0, 1.0], [6.0, 1.0], [1.0, -4.0]], np.float32))
    np.testing.assert_allclose(places[0], [200.0, 150.0, 0.0], atol=1e-3)
    assert places[1, 0] > 200.0
    assert places[1, 1] == pytest.approx(150.0)
    assert places[2, 1] > 150.0


def test_n8_patches_have_their_representations_colour_and_culled_ones_are_dim(
    outlook: Outlook, site: Site, sheet: Sheet
) -> None:
    marks, patches, patch = chart(outlook, site, [], sheet), outlook.patches, np.float32(site.ground.patch)
    triangles = marks.shapes.reshape(-1, 3)
    for visible in (True, False):
        row = np.flatnonzero(patches.alive & (patches.visible == visible) & (patches.distance == 2))[0]
        middle = sheet.place((patches.cell[row] + np.array([0.6, 0.3], np.float32)) * patch)
        over = [one for one in triangles if holds(one["place"][:, :2], middle[:2])]
        color = over[1]["color"][0]
        np.testing.assert_allclose(color[:3], ring_shades(site.representations[0].color, 2)[1], atol=1e-6)
        assert color[3] == pytest.approx(0.9 if visible else CULLED)


def holds(corners: Any, place: Any) -> bool:
    """Return whether a triangle contains a place."""
    a, b, c = corners.astype(float)
    sides = [(q - p)[0] * (place - p)[1] - (q - p)[1] * (place - p)[0] for p, q in ((a, b), (b, c), (c, a))]
    return bool(min(sides) >= 0.0 or max(sides) <= 0.0)


def test_n8_the_view_cone_starts_at_the_viewer_and_ends_at_the_border(
    outlook: Outlook, site: Site, sheet: Sheet
) -> None:
    outlook.viewer.cone = (0.7, 0.4)
    centre = np.array([200.0, 150.0, 0.0])
    sides = [line for line in chart(outlook, site, [], sheet).lines if np.allclose(line["a"], centre)]
    assert len(sides) == 2
    for line, azimuth in zip(sides, (0.3, 1.1), strict=True):
        run = line["b"] - centre
        assert atan2(run[0], run[1]) == pytest.approx(azimuth, abs=1e-5)
        assert np.abs(run).max() == pytest.approx(100.0, abs=1e-2)
    outlook.viewer.cone = (0.0, pi)
    assert not [line for line in chart(outlook, site, [], sheet).lines if np.allclose(line["a"], centre)]


def test_n8_masks_are_outlined_on_the_map(outlook: Outlook, site: Site, sheet: Sheet) -> None:
    whirlwinds = storm()
    marks = chart(outlook, site, whirlwinds, sheet)
    ends = marks.lines["a"][np.isclose(marks.lines["color"][:, :3], whirlwinds[0].color).all(axis=1)]
    middle = sheet.place(np.array([3.0, -4.0], np.float32))
    away = np.hypot(*(ends - middle)[:, :2].T)
    near = away < 5.0 / sheet.reach * 100.0
    assert near.sum() > 40
    assert away[near] == pytest.approx(4.0 / sheet.reach * 100.0, rel=0.03)
