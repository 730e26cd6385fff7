"""Crests against the sky while strips and carpet replace one another, compared with the reference (X5, G4)."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import moderngl
import numpy as np
import pytest

from tallgrass import testing
from tallgrass.app.bench.flip import MOMENT
from tallgrass.components.arrays import Doubles
from tallgrass.engine.camera import Camera, camera_at, view_of
from tallgrass.systems.around.appearance import Appearance, appearance
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.reference import carpet_painter, draw_truth
from tallgrass.testing import Stage as Room

Load = Callable[..., Prairie]
Aim = Callable[..., Camera]

RIDGE = """\
tallgrass: 2
terrain: { heights: ridge.npy, cell: 1.0, scale: 1.0 }
grass:
  bunch: { height: [0.45, 0.85], width: 0.018, lean: 0.35, blades: 400, root: "#4a5f2b", tip: "#bcc26c" }
"""
QUALITY = """\
quality:
  models: 2
  blade_rings: [{ to: 2, segments: 3 }]
  strip_rings: [{ to: 7, strips: 4, texel: 0.012 }, { to: 20, strips: 2, columns: 1, sections: 1, texel: 0.016 }]
  carpet_to: 24
  carpet: 64
"""
AWAY = 50.0
"""Distance at which strips give way to the carpet [m]."""

WAY = np.linspace(0.0, 1.0, 11)


@pytest.fixture(scope="module")
def room(ctx: moderngl.Context) -> Any:
    """A stage with the scale of the middle of a picture of 1280 by 720 pixels."""
    made = Room(ctx, (320, 180))
    yield made
    made.release()


@dataclass(frozen=True)
class Story:
    """Pictures of a crest some 50 m away that changes from carpet to strips."""

    whole: list[Doubles]
    strips: list[Doubles]
    """Pictures without the carpet."""
    bare: Doubles
    """Picture of the ground alone."""


@pytest.fixture(scope="module")
def story(room: Room, ctx: moderngl.Context, tmp_path_factory: pytest.TempPathFactory) -> Story:
    folder: Path = tmp_path_factory.mktemp("ridge")
    z = np.arange(161.0) - 80.0
    line = np.where(np.abs(z) < 30.0, 3.0 * np.cos(z * np.pi / 60.0) ** 2, 0.0)
    np.save(folder / "ridge.npy", np.repeat(line[:, None], 161, 1).astype(np.float32))
    (folder / "ridge.yaml").write_text(RIDGE + QUALITY, "utf-8")
    prairie = Prairie.load(folder / "ridge.yaml", ctx=ctx)
    eye = float(prairie.height_at([[0.6, AWAY]])[0]) + 1.7
    view = float(np.degrees(2 * np.arctan(np.tan(np.radians(21.0)) / 4)))
    seen = Camera((0.6, eye, AWAY), 0.0, np.radians(1.4), np.radians(view))
    room.shot(prairie, seen)
    alive = prairie.viewers["main"].patches.alive.astype(np.float32)
    ways = [
        appearance(
            np.stack([0 * alive, part * alive, (1.0 - part) * alive]).astype(np.float32),
            np.ones_like(alive),
            transitions=prairie.site.transitions,
        )
        for part in WAY
    ]
    told = Story(
        whole=[drawn(room, prairie, seen, shows) for shows in ways],
        strips=[drawn(room, prairie, seen, shows, carpet=False) for shows in ways],
        bare=drawn(room, prairie, seen, ways[0], carpet=False, strips=False),
    )
    prairie.release()
    return told


def drawn(
    room: Room, prairie: Prairie, camera: Camera, shows: Appearance, *, carpet: bool = True, strips: bool = True
) -> Doubles:
    """Draw the prairie with an appearance of all its patches, and return the picture."""
    painter, outlook = prairie.painter, prairie.viewers["main"]
    assert painter is not None
    standing = prairie.site.representations[1]
    outlook.appearance = shows
    outlook.shown["strips"] = standing.show(outlook, shows.cover[1])
    standing.plant(outlook)
    painter.write(outlook)
    carpet_painter(painter).lay(outlook, shows.cover[2] if carpet else None)
    room.target.use()
    room.target.clear(depth=1.0)
    painter.draw(view_of(*room.matrices(camera)), blades=None if strips else [])
    return room.read()


def covered(pictures: list[Doubles], bare: Doubles) -> list[Doubles]:
    """Return the hidden fraction of the sky above the crest by row, from the top, shape (rows,)."""
    crest = int(np.argmax((bare[..., 1] > bare[..., 2]).mean(axis=1) > 0.5))
    found = []
    for picture in pictures:
        window = picture[crest - 30 : crest + 2].mean(axis=1)
        sky, grass = picture[crest - 36 : crest - 30].mean(axis=(0, 1)), window[-2:].mean(axis=0)
        found.append(np.clip((window - sky) @ (grass - sky) / ((grass - sky) @ (grass - sky)), 0.0, 1.0))
    return found


def test_x5_the_outline_of_a_crest_keeps_its_height_through_the_change(story: Story) -> None:
    heights = np.array([rows.sum() for rows in covered(story.whole, story.bare)])
    assert heights.min() > 8.0
    assert np.abs(heights - heights[-1]).max() < 2.0


def test_x5_what_stands_before_the_sky_never_fades(story: Story) -> None:
    for rows in covered(story.whole, story.bare):
        solid = rows[-4:]
        assert solid.min() > 0.85


def test_x5_strips_grow_out_of_the_ground(story: Story) -> None:
    heights = np.array([rows[:-2].sum() for rows in covered(story.strips, story.bare)])
    heights /= heights[-1]
    assert heights[0] < 0.02
    assert (np.diff(heights) >= 0.0).all()
    assert 0.09 < heights[2] < 0.5 < heights[4] < 0.9


SCENES = Path(__file__).parents[2] / "scenes"
HIGHER = 28.3
"""How far above where they are looked at grass behind a crest is seen [m]."""

BESIDE = 25.6
"""How far to the right of where the bundled hills are looked at their far hillside falls off [degrees]."""


@pytest.fixture(scope="module")
def hills(ctx: moderngl.Context, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Prairie]:
    scene: Path = tmp_path_factory.mktemp("hills") / "hills.yaml"
    scene.write_text((SCENES / "hills.yaml").read_text("utf-8").replace("quality: high", QUALITY), "utf-8")
    prairie = Prairie.load(scene, ctx=ctx, live=False)
    prairie.advance(MOMENT)
    yield prairie
    prairie.release()


@pytest.fixture(scope="module")
def hillside(ctx: moderngl.Context, hills: Prairie) -> Iterator[tuple[Doubles, Doubles]]:
    """Pictures of a hillside against the sky where strips give way to the carpet: as drawn, and with every blade."""
    with testing.stage(ctx, (160, 450)) as stage:
        camera = camera_at(hills.scene.camera, None, hills.height_at)
        view, projection = stage.matrices(replace(camera, yaw=camera.yaw + np.radians(BESIDE)))
        stage.begin()
        hills.draw(view, projection)
        seen = stage.read()
        yield seen, draw_truth(hills, view, projection, (160, 450), samples=4).picture.astype(np.float64)


def hidden(picture: Doubles) -> Doubles:
    """Return the number of sky pixels that grass hides in each column, shape (columns,)."""
    green, blue = picture[..., 1], picture[..., 2]
    return np.asarray(np.clip((green - blue + 30.0) / 60.0, 0.0, 1.0).sum(axis=0))


def roughness(line: Doubles) -> float:
    """Return the root mean square difference of a line from its running mean over 15 columns."""
    smooth = np.convolve(np.pad(line, 7, mode="edge"), np.ones(15) / 15, "valid")
    return float((line - smooth).std())


def test_x5_an_outline_is_as_high_as_that_of_every_blade(hillside: tuple[Doubles, Doubles]) -> None:
    seen, truth = (hidden(picture) for picture in hillside)
    assert abs((seen - truth).mean()) < 0.5


def test_x5_an_outline_is_as_rough_as_that_of_every_blade(hillside: tuple[Doubles, Doubles]) -> None:
    seen, truth = (roughness(hidden(picture)) for picture in hillside)
    assert 0.75 < seen / truth < 1.25


def test_g5_no_line_shows_where_strips_give_way_to_the_carpet_on_a_hillside(hillside: tuple[Doubles, Doubles]) -> None:
    below = [picture[190:260, 40:80].mean(axis=(1, 2)).reshape(-1, 5).mean(axis=1) for picture in hillside]
    assert np.abs(below[0] / below[1] - 1.0).max() < 0.06


def test_x5_no_dark_dashes_lie_along_a_crest_before_the_same_tile(ctx: moderngl.Context, hills: Prairie) -> None:
    """The camera looks to +x, where a tile's nearer triangles would be drawn first."""
    at = camera_at(hills.scene.camera, None, hills.height_at).position
    with testing.stage(ctx, (160, 40)) as stage:
        seen = stage.shot(hills, Camera((at[0], at[1] + HIGHER, at[2]), *np.radians([105.0, -8.5, 2.96]).tolist()))
    rows = seen[..., 1].reshape(40, 16, 10).mean(axis=2)
    assert (rows[2:-2] / np.minimum(rows[:-4], rows[4:])).min() > 0.88


def partly_covered(picture: Doubles) -> float:
    """Return the fraction of columns with a pixel between sky and grass that shows both."""
    grass = picture[..., 1] - picture[..., 2]
    top = (grass > -5.0).argmax(axis=0)
    rows = np.take_along_axis(grass, top + np.arange(-6, 6)[:, None], axis=0)
    sky, below = rows[:3].mean(axis=0), rows[8:].mean(axis=0)
    part = (rows[3:9] - sky) / (below - sky)
    return float(((part > 0.2) & (part < 0.8)).any(axis=0).mean())


@pytest.mark.parametrize(("preset", "least"), [(None, 0.5), ("low", 0.3)])
def test_g4_an_outline_far_off_is_soft(ctx: moderngl.Context, hills: Prairie, preset: str | None, least: float) -> None:
    """Hills some 300 m away, where all grass is as high as a pixel: the layer under the carpet stands out nowhere."""
    seen = hills if preset is None else Prairie.load(SCENES / "hills.yaml", ctx=ctx, preset=preset, live=False)
    at = camera_at(hills.scene.camera, None, hills.height_at).position
    with testing.stage(ctx, (280, 60)) as stage:
        picture = stage.shot(seen, Camera(at, *np.radians([-67.2, 1.2, 5.27]).tolist()))
    if preset is not None:
        seen.release()
    assert partly_covered(picture) > least


def test_x5_no_light_line_parts_strips_from_the_crest_they_stand_behind(ctx: moderngl.Context) -> None:
    """At preset low, strips that give way to the carpet stand out against the dusk."""
    size = (200, 540)
    with testing.stage(ctx, size) as stage:
        prairie = Prairie.load(SCENES.parent / "tests" / "cameras" / "dusk.yaml", ctx=ctx, preset="low", live=False)
        prairie.advance(MOMENT)
        camera = camera_at(prairie.scene.camera, None, prairie.height_at)
        aside = np.arctan(300.0 / 270.0 * np.tan(camera.view / 2.0))
        view, projection = stage.matrices(replace(camera, yaw=camera.yaw + aside))
        stage.begin()
        prairie.draw(view, projection)
        lighter = stage.read() - draw_truth(prairie, view, projection, size, samples=3).picture
        prairie.release()
    lightest = lighter[60:200].reshape(140, 20, 10, 3).mean(axis=(2, 3)).max(axis=0)
    assert lightest.mean() < 30.0


def test_g4_no_bright_line_lies_along_a_flat_crest_of_sparse_grass(ctx: moderngl.Context, load: Load) -> None:
    sparse = """\
tallgrass: 2
seed: 3
terrain: { noise: rolling, size: [300, 300] }
grass: { prairie: { height: [0.4, 0.7], width: 0.014, blades: 40 } }
wind: [{ kind: breeze, direction: 70, strength: 0.3 }]
light: { ground: "#d9c48f" }
camera: { position: [0, 60], eye: 2.0, pitch: -3, view: 30 }
quality: high
"""
    room = Room(ctx, (960, 540))
    prairie = load(sparse, lod="carpet")
    seen = room.shot(prairie, camera_at(prairie.scene.camera, None, prairie.height_at))[255:295, 90:180, 1]
    room.release()
    lines = seen.mean(axis=1)
    assert lines.max() - np.median(lines) < 17.0
