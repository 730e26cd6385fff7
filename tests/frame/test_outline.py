"""A crest against the sky while strips and carpet give way to one another (X5, G4)."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.engine.camera import Camera, view_of
from tallgrass.systems.around.appearance import Appearance, appearance
from tallgrass.systems.prairie import Prairie
from tallgrass.testing import Stage as Room

Doubles = NDArray[np.float64]
Load = Callable[..., Prairie]
Aim = Callable[..., Camera]

RIDGE = """\
tallgrass: 2
terrain: { heights: ridge.npy, cell: 1.0, scale: 1.0 }
grass:
  bunch: { height: [0.45, 0.85], width: 0.018, lean: 0.35, blades: 400, root: "#4a5f2b", tip: "#bcc26c" }
quality:
  models: 2
  blade_rings: [{ to: 2, segments: 3 }]
  strip_rings: [{ to: 7, strips: 4, texel: 0.012 }, { to: 20, strips: 2, columns: 1, sections: 1, texel: 0.016 }]
  carpet_to: 24
  carpet: 64
"""
AWAY = 50.0
"""Where strips give way to the carpet [m]."""

WAY = np.linspace(0.0, 1.0, 11)


@pytest.fixture(scope="module")
def room(ctx: moderngl.Context) -> Any:
    """The middle of a picture of 1280 by 720: as many pixels to the metre."""
    made = Room(ctx, (320, 180))
    yield made
    made.release()


@pytest.fixture(scope="module")
def story(room: Room, ctx: moderngl.Context, tmp_path_factory: pytest.TempPathFactory) -> list[Doubles]:
    """A crest some 50 m away, on the way from carpet to strips, and the bare ground of it."""
    folder: Path = tmp_path_factory.mktemp("ridge")
    z = np.arange(161.0) - 80.0
    line = np.where(np.abs(z) < 30.0, 3.0 * np.cos(z * np.pi / 60.0) ** 2, 0.0)
    np.save(folder / "ridge.npy", np.repeat(line[:, None], 161, 1).astype(np.float32))
    (folder / "ridge.yaml").write_text(RIDGE, "utf-8")
    prairie = Prairie.load(folder / "ridge.yaml", ctx=ctx)
    eye = float(prairie.height_at([[0.6, AWAY]])[0]) + 1.7
    view = float(np.degrees(2 * np.arctan(np.tan(np.radians(21.0)) / 4)))
    seen = Camera((0.6, eye, AWAY), 0.0, np.radians(1.4), np.radians(view))
    room.shot(prairie, seen)
    alive, pictures = prairie.viewers["main"].patches.alive.astype(np.float32), []
    for part in (*WAY, None):
        weight = np.stack([0 * alive, (part or 0.0) * alive, (1.0 - (part or 0.0)) * alive]).astype(np.float32)
        shows = appearance(weight, np.ones_like(alive), transitions=prairie.site.transitions)
        pictures.append(drawn(room, prairie, seen, shows, bare=part is None))
    prairie.release()
    return pictures


def drawn(room: Room, prairie: Prairie, camera: Camera, shows: Appearance, *, bare: bool) -> Doubles:
    """The prairie with all of it as it shows on the way."""
    painter, outlook = prairie.painter, prairie.viewers["main"]
    assert painter is not None
    strips = prairie.site.representations[1]
    outlook.appearance = shows
    outlook.shown["strips"] = strips.show(outlook, shows.cover[1])
    strips.plant(outlook)
    painter.write(outlook, [])
    painter.carpet.lay(outlook, None if bare else shows.cover[2])
    room.target.use()
    room.target.clear(depth=1.0)
    painter.draw(view_of(*room.matrices(camera)), blades=[] if bare else None)
    return room.read()


def covered(story: list[Doubles]) -> list[Doubles]:
    """How much of the sky above the crest each row hides, from the top, shape (rows,)."""
    bare = story[-1]
    crest = int(np.argmax((bare[..., 1] > bare[..., 2]).mean(axis=1) > 0.5))
    found = []
    for picture in story[:-1]:
        window = picture[crest - 30 : crest + 2].mean(axis=1)
        sky, grass = picture[crest - 36 : crest - 30].mean(axis=(0, 1)), window[-2:].mean(axis=0)
        found.append(np.clip((window - sky) @ (grass - sky) / ((grass - sky) @ (grass - sky)), 0.0, 1.0))
    return found


def test_x5_the_outline_of_a_crest_keeps_its_height_through_the_change(story: list[Doubles]) -> None:
    heights = np.array([rows.sum() for rows in covered(story)])
    assert heights.min() > 8.0
    assert np.abs(heights - heights[-1]).max() < 2.0


def test_x5_what_stands_before_the_sky_grows_and_never_fades(story: list[Doubles]) -> None:
    for rows in covered(story):
        solid = rows[-4:]
        assert solid.min() > 0.85
