"""In one wind the soft kind lies and the stiff one stands, in every representation (W12)."""

from collections.abc import Callable, Iterator
from pathlib import Path

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from tallgrass.engine.camera import Camera
from tallgrass.engine.declared.quality import LodName
from tallgrass.systems.grow.bend import spine
from tallgrass.systems.prairie import Prairie
from tallgrass.testing import Stage as Room

Grown = Callable[[float, str, LodName], Prairie]
Aim = Callable[..., Camera]
Pictures = Callable[[str, str], NDArray[np.float64]]

SCENE = """\
tallgrass: 2
terrain: {{ size: [104, 104] }}
grass:
  reed:
    height: [0.5, 0.5]
    width: 0.02
    taper: 0.3
    lean: 0
    variety: 0
    stiffness: {stiffness}
    place: {{ map: half.png }}
light: {{ haze: 100000 }}
quality:
  blades: 350
  models: 1
  blade_rings: [{{ to: 8, segments: 8 }}]
  strip_rings: [{{ to: 10, strips: 8, columns: 4, sections: 6, texel: 0.008 }}]
  carpet_to: 24
  carpet: 64
"""
LENGTH = 0.5
"""Length of every blade [m]."""

SOFT, STIFF = 0.2, 8
NOW = 9.0

WINDS = {
    "breeze": "{ kind: breeze, strength: 0.5, gustiness: 0 }",
    "gust": "{ kind: gust, position: [-40, 0], width: 400, reach: 400, hold: 60, ragged: 0, strength: 0.5, swing: 0 }",
    "whirlwind": "{ kind: whirlwind, position: [0, -90], radius: 300, strength: 0.8, turning: 0, swing: 0 }",
    "blast": "{ kind: blast, position: [-150, 0], outline: { disc: 400 }, strength: 0.6, swing: 0 }",
}
"""Winds that tell all grass of the scene about the same: along x, and half of what lays common grass flat."""

EDGE, EYE, BACK = 20.0, 0.12, 12.0
"""Where the grass ends, from beyond which one looks at it: how high the eye is, and how far away [m]."""


@pytest.fixture(scope="module")
def room(ctx: moderngl.Context) -> Room:
    return Room(ctx, (160, 240))


@pytest.fixture(scope="module")
def prairies(ctx: moderngl.Context, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Grown]:
    """Return the function that loads one kind of a stiffness, in a wind and one representation; it is bare near by."""
    known: dict[tuple[float, str, LodName], Prairie] = {}
    folder: Path = tmp_path_factory.mktemp("half")
    Image.fromarray(np.repeat(np.arange(208)[:, None] < 144, 208, 1).astype(np.uint8) * 255).save(folder / "half.png")

    def prairie(stiffness: float, wind: str, lod: LodName) -> Prairie:
        key = stiffness, wind, lod
        if key not in known:
            winds = f"wind: [{WINDS[wind]}]\n" if wind else ""
            (folder / "scene.yaml").write_text(SCENE.format(stiffness=stiffness) + winds, "utf-8")
            known[key] = Prairie.load(folder / "scene.yaml", ctx=ctx, lod=lod, live=False)
            known[key].advance(NOW)
        return known[key]

    yield prairie
    for each in known.values():
        each.release()


def stands(room: Room, prairie: Prairie) -> float:
    """Return the height of grass at its near edge that nine tenths of the picture's columns reach [m]."""
    camera = Camera((0.0, EYE, EDGE + BACK), 0.0, 0.0, np.radians(6.0))
    picture = room.shot(prairie, camera)
    top = np.quantile(np.argmax(picture[..., 1] > picture[..., 2], axis=0), 0.9)
    return float(EYE + BACK * (1.0 - 2.0 * top / room.size[1]) * np.tan(camera.view / 2.0))


@pytest.mark.parametrize("wind", WINDS)
def test_w12_numpy_lays_a_soft_blade_lower_than_a_stiff_one(prairies: Grown, wind: str) -> None:
    place = np.array([[0.0, 0.0], [5.0, EDGE]], np.float32)
    tips = []
    for stiffness in (SOFT, STIFF):
        prairie = prairies(stiffness, wind, "blades")
        message = prairie.wind_at(place)
        np.testing.assert_allclose(np.hypot(*message.T), 0.5, atol=0.12)
        growth = prairie.site.growths[0]
        tips += [spine(growth.models[0].blades, growth.postures, told, points=9)[:, -1, 1].mean() for told in message]
    assert min(tips[2:]) - max(tips[:2]) > 0.25 * LENGTH


@pytest.mark.parametrize(
    ("wind", "lod", "apart"),
    [
        ("breeze", "blades", 0.16),
        ("gust", "strips", 0.23),
        pytest.param("blast", "strips", 0.23, marks=pytest.mark.slow),
    ],
)
def test_w12_a_picture_shows_soft_grass_lower_than_stiff_grass(
    prairies: Grown, room: Room, wind: str, lod: LodName, apart: float
) -> None:
    calm = [stands(room, prairies(stiffness, "", lod)) for stiffness in (SOFT, STIFF)]
    soft, stiff = (stands(room, prairies(stiffness, wind, lod)) for stiffness in (SOFT, STIFF))
    # Of blades that stand before one another the highest are seen, and those are of the stiffest variant.
    assert stiff - soft > apart * LENGTH
    assert calm[0] == pytest.approx(calm[1], abs=0.01)
    assert stiff == pytest.approx(calm[1], abs=0.03)


@pytest.mark.parametrize("wind", ["breeze", "whirlwind"])
def test_w12_the_carpets_light_shows_that_soft_grass_lies_and_stiff_grass_stands(
    prairies: Grown, room: Room, wind: str
) -> None:
    camera = Camera((-15.0, 2.5, 0.0), np.pi / 2.0, -0.4, np.radians(30.0))
    soft, stiff = (
        float(room.shot(prairies(stiffness, wind, "carpet"), camera).mean())
        / float(room.shot(prairies(stiffness, "", "carpet"), camera).mean())
        for stiffness in (SOFT, STIFF)
    )
    assert stiff == pytest.approx(1.0, abs=0.04)
    assert soft == pytest.approx(1.125, abs=0.02)  # as every blade does
