"""The canopy's height, and bodies above it (R4)."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from tallgrass.components.pose import Pose
from tallgrass.components.wind import WindSource
from tallgrass.engine.terrain.record import Density, Terrain
from tallgrass.engine.terrain.sample import height_at
from tallgrass.engine.world import World
from tallgrass.systems.bodies.fly import flying
from tallgrass.systems.grow.bend import spine
from tallgrass.systems.site import Site
from tallgrass.systems.space.canopy import LODGED, lodged
from tallgrass.systems.wind.blast import Blast
from tallgrass.systems.wind.quarantine import Quarantine

Laid = Callable[..., Site]

FLAT = Terrain(np.full((81, 81), 3.0, np.float32), 1.0)


def test_the_canopy_is_lower_where_all_grass_lies() -> None:
    assert lodged(0.0) == 1.0
    assert lodged(1.0) == pytest.approx(1.0 - LODGED)


def grown(laid: Laid, tall: float, short: float, terrain: Terrain = FLAT) -> Site:
    """Return a site where two kinds grow with these densities everywhere."""
    site = laid(terrain=terrain)
    maps = np.stack([np.full((4, 4), each, np.float32) for each in (tall, short)])
    return replace(site, ground=replace(site.ground, density=Density(maps, terrain.size)))


def test_the_canopy_of_a_kind_is_what_nearly_all_its_blades_reach_and_hardly_any_exceeds(laid: Laid) -> None:
    site = laid()
    for canopy, growth in zip(site.canopy, site.growths, strict=True):
        length = np.concatenate([model.blades.height for model in growth.models])
        assert 0.05 <= (length > canopy).mean() <= 0.15
        tips = np.concatenate(
            [spine(model.blades, growth.postures, (0.0, 0.0), points=9)[:, -1, 1] for model in growth.models]
        )
        assert (tips <= canopy).mean() > 0.85


def test_the_top_of_the_grass_is_the_tallest_kinds_and_falls_to_the_ground_where_it_thins_out(laid: Laid) -> None:
    place = np.array([[0.0, 0.0], [7.0, -12.0]], np.float32)
    tall, short = laid().canopy
    assert tall > short
    for density, over in (((1.0, 1.0), tall), ((0.0, 1.0), short), ((0.5, 0.0), 0.5 * tall), ((0.0, 0.0), 0.0)):
        np.testing.assert_allclose(grown(laid, *density).top_at(place), 3.0 + over, rtol=1e-5)


def test_the_top_follows_the_ground(laid: Laid, hills: Terrain) -> None:
    place = np.random.default_rng(1).uniform(-30.0, 30.0, (50, 2)).astype(np.float32)
    site = grown(laid, 1.0, 0.0, hills)
    np.testing.assert_allclose(site.top_at(place) - height_at(hills, place), site.canopy[0], atol=1e-5)


@pytest.mark.parametrize("height", [2.0, 5.0])
def test_r4_what_hovers_over_a_wind_keeps_its_height_above_the_grass_and_not_above_the_ground(
    laid: Laid, world: World, height: float
) -> None:
    world.create(WindSource(Blast(body="saucer", height=height), "saucer"), Pose(1.0, 2.0))
    for tall, short in ((1.0, 0.0), (0.0, 1.0)):
        site = grown(laid, tall, short)
        (body,) = flying(world, site.top_at, Quarantine(), time=0.0)
        over = site.canopy[0] if tall else site.canopy[1]
        assert body.place == pytest.approx((1.0, 3.0 + over + height, 2.0), rel=1e-5)
