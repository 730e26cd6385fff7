"""Masks on the ground."""

from typing import Any

import numpy as np
import pytest

from tallgrass.components.arrays import Floats
from tallgrass.components.pose import Pose
from tallgrass.components.wind import Extent, Grass, WindPrimitive, WindSource
from tallgrass.engine.terrain.record import Terrain
from tallgrass.engine.terrain.sample import height_at
from tallgrass.systems.overlay.marks import LIFT
from tallgrass.systems.overlay.masks import Masked, mask_marks, masked
from tallgrass.systems.overlay.paint import wind_color
from tallgrass.systems.wind.blast import Blast, Shape
from tallgrass.systems.wind.blow import blowing
from tallgrass.systems.wind.breeze import Breeze
from tallgrass.systems.wind.gust import Gust
from tallgrass.systems.wind.quarantine import Quarantine
from tallgrass.systems.wind.whirlwind import Whirlwind


def seen(*winds: WindPrimitive, time: float = 2.0, far: float = 100.0) -> list[Masked]:
    sources = [WindSource(wind, f"wind[{number}]") for number, wind in enumerate(winds)]
    quarantine = Quarantine()
    acting = blowing(sources, quarantine, time=time, seed=1)
    return masked(acting, quarantine, time=time, around=(0.0, 0.0), far=far)


class Square(WindPrimitive):
    """A plugin's wind: a square of 6 m with a heading of its own."""

    kind: str = "square"

    def pose(self, *, time: float) -> Pose:
        return Pose(10.0, -5.0, np.pi / 4)

    def extent(self, *, time: float) -> Extent:
        return Extent(-3.0, 3.0, -3.0, 3.0)

    def mask(self, place: Floats, /, *, time: float) -> Floats:
        return np.ones(len(place), np.float32)

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Floats:
        return np.zeros_like(place)


class Colored(Square):
    """A plugin's wind with a colour of its own."""

    kind: str = "colored"
    color = (0.25, 0.5, 1.0)


class Broken(Square):
    kind: str = "broken"

    def mask(self, place: Floats, /, *, time: float) -> Floats:
        raise ZeroDivisionError


def test_n8_the_outline_of_a_whirlwind_is_its_circle() -> None:
    (whirlwind,) = seen(Whirlwind(position=[4.0, -7.0], radius=5.0))
    away = np.hypot(*(whirlwind.edge.reshape(-1, 2) - np.array([4.0, -7.0])).T)
    assert away == pytest.approx(5.0, abs=0.06)
    assert whirlwind.color == wind_color(Whirlwind())


def test_n8_a_gusts_outline_travels_with_it() -> None:
    gust = Gust(position=[0.0, 0.0], direction=0.0, width=20.0, speed=8.0, soft=0.0)
    for time in (1.0, 3.0):
        (mask,) = seen(gust, time=time)
        assert mask.edge[..., 1].min() == pytest.approx(-8.0 * time, abs=0.05)
        assert np.abs(mask.edge[..., 0]).max() == pytest.approx(10.0, abs=0.05)


def test_n8_a_turned_blast_is_outlined_turned() -> None:
    (mask,) = seen(Blast(position=[0.0, 0.0], yaw=90.0, outline=Shape(ellipse=[6.0, 2.0])))
    x, z = mask.edge.reshape(-1, 2).T
    assert np.abs(z).max() > 2.5 * np.abs(x).max()


def test_n8_a_strangers_mask_is_outlined_by_asking_it() -> None:
    (mask,) = seen(Square(kind="square"))
    x, z = mask.edge.reshape(-1, 2).T
    assert np.abs(x - 10.0) + np.abs(z + 5.0) == pytest.approx(3.0 * np.sqrt(2.0), abs=0.02)
    assert wind_color(Square()) == mask.color != wind_color(Square(kind="another"))


def test_n8_a_stranger_says_what_its_wind_is_shown_in() -> None:
    assert [mask.color for mask in seen(Colored())] == [(0.25, 0.5, 1.0)]


@pytest.mark.parametrize("color", ["red", "#ff0000", (255, 0, 0), (0.5, 0.5), (0.1, np.nan, 0.2), (0.5, "red", 0.5)])
def test_n8_a_colour_that_is_none_gives_way_to_the_hue_of_the_name(monkeypatch: pytest.MonkeyPatch, color: Any) -> None:
    hue = wind_color(Square(kind="colored"))
    monkeypatch.setattr(Colored, "color", color)
    assert [mask.color for mask in seen(Colored())] == [hue]


def test_n8_a_wind_without_an_end_is_named_and_not_drawn(hills: Terrain) -> None:
    (breeze,) = seen(Breeze())
    assert (breeze.kind, breeze.everywhere) == ("breeze", True)
    marks = mask_marks([breeze], hills)
    assert len(marks.shapes) == len(marks.lines) == 0


def test_n8_a_wind_that_fails_is_left_out_and_the_others_are_drawn() -> None:
    assert [mask.kind for mask in seen(Broken(kind="broken"), Whirlwind())] == ["whirlwind"]


def test_n8_the_strongest_claim_lies_on_top_and_far_winds_are_left_out() -> None:
    winds = (Blast(outline=Shape(disc=3.0)), Breeze(), Gust(position=[0.0, 0.0]))
    assert [mask.kind for mask in seen(*winds)] == ["breeze", "gust", "blast"]
    assert seen(Whirlwind(position=[300.0, 0.0])) == []


def test_n8_masks_lie_on_the_ground_and_weigh_in_their_tint(hills: Terrain) -> None:
    masks = seen(Whirlwind(position=[4.0, -7.0], radius=5.0))
    marks = mask_marks(masks, hills)
    for place in (marks.shapes["place"], marks.lines["a"], marks.lines["b"]):
        ground = height_at(hills, np.ascontiguousarray(place[:, ::2]))
        assert place[:, 1] == pytest.approx(ground + LIFT, abs=1e-4)
    opacity = marks.shapes["color"][:, 3]
    middle = np.hypot(marks.shapes["place"][:, 0] - 4.0, marks.shapes["place"][:, 2] + 7.0)
    assert opacity[middle < 1.0].min() > opacity[middle > 4.9].max()
