"""Each term of light and shadow alone, on blades, strips and carpet, against every blade (F5, F6, F10, N12).

A term is the change between two scenes. It is measured over squares of the picture, relative to the brightness before.
The error of a representation is its mean difference from the reference's change, relative to the mean of that. The
reference is drawn by the blades' own shader, so there is also a bound for the least size of its change.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass import Shade
from tallgrass.engine.camera import Camera
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.reference import draw_truth
from tallgrass.testing import Stage

Picture = NDArray[np.float64]
Shot = Callable[["Seen"], Picture]

SCENE = """\
tallgrass: 2
seed: 39  # a thick cloud stands before the sun there, where the sky has half as many as it can hold
terrain: {{ heights: {folder}/{ground}.npy, scale: 1 }}
grass: {{ turf: {{ height: [0.4, 0.6], width: 0.035, blades: 800, variety: 0, {turf} }} }}
light: {{ azimuth: {azimuth}, elevation: {elevation}, haze: {haze}, {light} }}
quality:
  models: 1
  blade_rings: [{{ to: 1, segments: 3 }}]
  strip_rings: [{{ to: 5, strips: 4, texel: 0.015 }}]
  carpet_to: 16
  carpet: 64
wind: [{wind}]
"""
CAMERA = Camera((0.0, 8.0, 8.0), 0.0, -0.8, np.radians(30.0))
SIZE, SQUARE = (96, 64), 16
"""Size of a picture, and side of the squares by which it is compared [pixels]."""

BEFORE, BEHIND, LEFT = 0.0, 180.0, -90.0
"""Azimuths of the sun relative to the camera [degrees]."""

RIDGE_X, RIDGE_HEIGHT = -8.0, 5.0
"""Where the ridge runs along z, to the left of all that is seen, and how high it is [m]."""


@dataclass(frozen=True)
class Seen:
    """A scene, by its values of light, grass and ground."""

    azimuth: float = 90.0
    elevation: float = 40.0
    haze: float = 1e6
    light: str = ""
    turf: str = ""
    ground: str = "flat"
    shade: bool = False
    wind: str = ""


@dataclass(frozen=True)
class Term:
    """A term of the light: scenes without and with it, its least size in the reference, and the largest error."""

    without: Seen
    having: Seen
    least: float
    missed: float = 0.1


BLACK, BLUE = '"#000000"', '"#6080ff"'
AWAY = "{ kind: breeze, direction: 0, strength: 0.8, gustiness: 0, swing: 0 }"
"""A wind that bends grass evenly, away from the eye."""

NIGHT = f"zenith: {BLACK}, horizon: {BLACK}"
"""A sky that gives no light, so that the sun's alone is seen."""

TERMS = {
    "sun": Term(Seen(light="strength: 0"), Seen(), 2.0),
    "sun behind or before the eye": Term(Seen(BEHIND, 25.0), Seen(BEFORE, 25.0), 0.08),
    "sky": Term(Seen(light=NIGHT), Seen(light=f"zenith: {BLUE}, horizon: {BLUE}"), 0.12),
    "canopy's own shade": Term(Seen(elevation=65.0, light=NIGHT), Seen(elevation=20.0, light=NIGHT), 0.45, missed=0.05),
    "shadow of the terrain": Term(Seen(LEFT, 15.0), Seen(LEFT, 15.0, ground="ridge"), 0.3),
    "shadow of clouds": Term(Seen(), Seen(light="clouds: 0.5"), 0.25),
    "shadow of a body": Term(Seen(), Seen(shade=True), 0.25),
    "haze": Term(Seen(), Seen(haze=30.0), 0.9),
    "gloss": Term(Seen(BEHIND, 20.0, turf="gloss: 0"), Seen(BEHIND, 20.0, turf="gloss: 1"), 0.12, missed=0.25),
    "transmission": Term(Seen(BEFORE, 25.0, turf="translucency: 0"), Seen(BEFORE, 25.0, turf="translucency: 1.5"), 0.4),
    "bent grass": Term(Seen(), Seen(wind=AWAY), 0.2, missed=0.3),
}


@pytest.fixture(scope="module")
def stage(ctx: moderngl.Context) -> Stage:
    return Stage(ctx, SIZE)


@pytest.fixture(scope="module")
def prairies(ctx: moderngl.Context, tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, Prairie]]:
    """Prairies of one file, by the one representation that each shows."""
    folder, x = tmp_path_factory.mktemp("terms"), np.arange(61) - 30.0
    ridge = RIDGE_HEIGHT * np.exp(-((x - RIDGE_X) ** 2) / 6.0)
    for name, row in (("flat", 0.0 * x), ("ridge", ridge)):
        np.save(folder / f"{name}.npy", np.tile(row, (61, 1)).astype(np.float32))
    (folder / "scene.yaml").write_text(text_of(Seen(), folder), "utf-8")
    made = {
        lod: Prairie.load(folder / "scene.yaml", ctx=ctx, lod=lod, live=False) for lod in ("blades", "strips", "carpet")
    }
    yield made
    for prairie in made.values():
        prairie.release()


def text_of(seen: Seen, folder: Path) -> str:
    return SCENE.format(folder=folder, **vars(seen))


@contextmanager
def showing(prairie: Prairie, seen: Seen) -> Iterator[None]:
    """Make a prairie read a scene, with a ball between sun and grass if the scene has one."""
    file = prairie.loaded.file
    file.write_text(text_of(seen, file.parent), "utf-8")
    prairie.reload()
    shades = [prairie.world.create(Shade((4.8, 4.8, 2.0), 3.0))] if seen.shade else []
    yield
    for shade in shades:
        prairie.world.delete(shade)


def change(shot: Shot, term: Term) -> Picture:
    """Return the light that a term adds to each square, relative to the picture's mean, shape (rows, columns, 3)."""
    width, height = SIZE
    squares = [
        picture.reshape(height // SQUARE, SQUARE, width // SQUARE, SQUARE, 3).mean(axis=(1, 3))
        for picture in (shot(term.without), shot(term.having))
    ]
    return np.asarray((squares[1] - squares[0]) / squares[0].mean())


@pytest.mark.parametrize("name", TERMS)
def test_n12_each_term_of_the_light_is_the_same_on_all_representations(
    stage: Stage, prairies: dict[str, Prairie], name: str
) -> None:
    term = TERMS[name]

    def truth(seen: Seen) -> Picture:
        with showing(prairies["blades"], seen):
            stage.shot(prairies["blades"], CAMERA)
            return draw_truth(prairies["blades"], *stage.matrices(CAMERA), SIZE, samples=2).picture.astype(np.float64)

    def shot_of(lod: str) -> Shot:
        def shot(seen: Seen) -> Picture:
            with showing(prairies[lod], seen):
                return stage.shot(prairies[lod], CAMERA)

        return shot

    due = change(truth, term)
    size = np.abs(due).mean()
    missed = {lod: float(np.abs(change(shot_of(lod), term) - due).mean() / size) for lod in prairies}
    assert size > term.least
    assert max(missed.values()) < term.missed, missed
