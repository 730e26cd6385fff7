"""Editing a scene while it runs (N7): changed things are made again, all others go on unchanged."""

import gc
import hashlib
import resource
from collections.abc import Callable, Iterator
from pathlib import Path
from time import thread_time
from typing import Any

import moderngl
import numpy as np
import pytest
from PIL import Image

from tallgrass.components.pose import Pose
from tallgrass.components.wind import WindSource
from tallgrass.engine.camera import Camera
from tallgrass.engine.scene import SceneError
from tallgrass.systems.land.part import LandPart
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.reference import carpet_painter
from tallgrass.systems.show.strips.painter import StripsPainter
from tallgrass.systems.wind.gust import Gust

Stage = Any
Aim = Callable[..., Camera]
Told = Callable[[Prairie], str]

TEXT = """\
tallgrass: 2
seed: 5
terrain: { noise: rolling, seed: 2, size: [60, 60], feature: 30, scale: 4 }
grass:
  tall: { height: [0.5, 0.9], width: 0.02, root: "#5a5a2c", tip: "#dcc98f" }
  short: { height: [0.2, 0.4], width: 0.02, tip: "#8fae4a", stiffness: 2, place: { map: map.png } }
wind:
  - { kind: breeze, strength: 0.4 }
  - { kind: gust, position: [-20, 0], speed: 9, reach: 60, width: 50, every: [1, 2], wander: 10 }
  - { kind: blast, body: saucer, position: [4, 2], outline: { image: map.png } }
camera: { position: [0, 20], eye: 1.7, pitch: -12, view: 45 }
light: { azimuth: 60, elevation: 30 }
quality:
  blades: 60
  models: 2
  blade_rings: [{ to: 1, segments: 3 }, { to: 2, segments: 2 }]
  strip_rings:
    - { to: 5, strips: 4, columns: 2, sections: 2, texel: 0.02 }
    - { to: 8, strips: 2, columns: 1, sections: 1, texel: 0.03 }
  carpet_to: 12
  carpet: 32
"""
GL = (moderngl.Buffer, moderngl.Texture, moderngl.TextureArray, moderngl.Program, moderngl.VertexArray)


class Edited:
    """A scene file that is edited while its prairie runs."""

    def __init__(self, path: Path, ctx: moderngl.Context) -> None:
        self.path = path
        self.write(TEXT)
        picture = np.zeros((32, 32), np.uint8)
        picture[8:24, 8:24] = 255
        Image.fromarray(picture).save(path.parent / "map.png")
        self.prairie = Prairie.load(path, ctx=ctx)

    def write(self, text: str) -> None:
        self.path.write_text(text, "utf-8")

    def edit(self, *changes: tuple[str, str]) -> None:
        """Change the original file, and read it again."""
        text = TEXT
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        self.write(text)
        self.prairie.reload()


@pytest.fixture
def edited(ctx: moderngl.Context, tmp_path: Path) -> Iterator[Edited]:
    made = Edited(tmp_path / "scene.yaml", ctx)
    yield made
    made.prairie.release()


@pytest.fixture
def untouched(ctx: moderngl.Context, tmp_path: Path) -> Iterator[Prairie]:
    folder = tmp_path / "untouched"
    folder.mkdir()
    made = Edited(folder / "scene.yaml", ctx)
    yield made.prairie
    made.prairie.release()


@pytest.fixture
def receivers(on_card: Callable[[Prairie], Any]) -> Told:
    """Return a hash of all messages to receivers, of numpy and of the graphics card."""

    def digest(prairie: Prairie) -> str:
        told, patches = hashlib.blake2b(digest_size=8), prairie.viewers["main"].patches
        for receiving, texels in on_card(prairie):
            slots = receiving.slots
            told.update(slots.tobytes() + receiving.pool.places(slots).tobytes() + texels.tobytes())
            told.update(receiving.messages.heard(slots).tobytes())
        told.update(patches.representation.tobytes() + patches.progress.tobytes())
        assert prairie.painter is not None
        told.update(carpet_painter(prairie.painter).air.texture.read())
        return told.hexdigest()

    return digest


def in_gl() -> dict[int, str]:
    """Return the living GL objects: their classes by address."""
    alive = (thing for thing in gc.get_objects() if isinstance(thing, GL))
    return {id(thing): type(thing).__name__ for thing in alive if type(thing.mglo).__name__ != "InvalidObject"}


def walked(camera: Aim, step: int) -> Camera:
    return camera(0.1 * step, 7.0, 20.0 - 0.15 * step, pitch=-18, yaw=0.6 * step)


NOTHING: dict[str, list[tuple[str, str]]] = {
    "the light": [("elevation: 30", "elevation: 60")],
    "a colour": [("#8fae4a", "#ffffff")],
    "what is left to its default": [("blades: 60", "blades: 60\n  patch: 2.5")],
}


def test_n7_what_grass_feels_goes_on_bit_for_bit_where_nothing_of_it_changed(
    edited: Edited, untouched: Prairie, stage: Stage, camera: Aim, receivers: Told
) -> None:
    for step in range(8):
        name = [None, *NOTHING][step // 2]
        if name and step % 2 == 0:
            edited.edit(*NOTHING[name])
        for prairie in (edited.prairie, untouched):
            stage.shot(prairie, walked(camera, 2 * step))
            prairie.advance(1 / 6)
        assert receivers(edited.prairie) == receivers(untouched), name
    assert edited.prairie.time == untouched.time


def test_n7_what_did_not_change_stays_in_gl(edited: Edited, stage: Stage, camera: Aim) -> None:
    prairie = edited.prairie
    stage.shot(prairie, walked(camera, 0))
    painter = prairie.painter
    assert painter is not None
    land = painter.part(LandPart)
    textures, painters, before = dict(land.textures), dict(painter.painters), prairie.site
    outlook = prairie.viewers["main"]
    patches, kept = outlook.patches, dict(outlook.kept)
    edited.edit(("strength: 0.4", "strength: 0.2"), ("#dcc98f", "#ffffff"))
    stage.shot(prairie, walked(camera, 0))
    assert land.textures == textures
    assert painter.painters == painters
    assert prairie.viewers["main"] is outlook
    assert outlook.patches is patches
    assert outlook.kept == kept
    edited.edit(("rolling, seed: 2", "rolling, seed: 3"))
    stage.shot(prairie, walked(camera, 0))
    assert {name for name, texture in land.textures.items() if texture is textures[name]} == {"density", "postures"}
    assert painter.painters == painters
    edited.edit(("height: [0.5, 0.9]", "height: [0.4, 0.9]"), ("rolling, seed: 2", "rolling, seed: 3"))
    assert prairie.site.growths[0] is not before.growths[0]
    assert prairie.site.growths[1] is before.growths[1]
    strips = painters["strips"]
    assert isinstance(strips, StripsPainter)
    pictures = strips.uploaded.extents
    stage.shot(prairie, walked(camera, 0))
    assert painter.painters == painters, "their programs draw other grass too"
    assert strips.uploaded.extents is not pictures


EDITS: dict[str, list[tuple[str, str]]] = {
    "the light": NOTHING["the light"],
    "a colour": NOTHING["a colour"],
    "the terrain": [("scale: 4", "scale: 2")],
    "where grass grows": [(", place: { map: map.png }", "")],
    "how grass grows": [("stiffness: 2", "stiffness: 1")],
    "another kind": [(", place: { map: map.png }", ""), ("wind:\n", "  third: { height: [0.1, 0.2] }\nwind:\n")],
    "the quality": [("to: 8, strips: 2", "to: 9, strips: 1"), ("carpet_to: 12", "carpet_to: 14")],
    "the seed": [("seed: 5", "seed: 6")],
    "a wind": [("strength: 0.4", "strength: 0.9")],
    "how winds meet": [("camera:", "mixing: priority\ncamera:")],
}
HELD_BESIDE = {"a colour", "the seed"}
"""Changes that other tests here cover, too."""


@pytest.mark.parametrize(
    "changes",
    [pytest.param(EDITS[name], id=name, marks=[pytest.mark.slow] * (name in HELD_BESIDE)) for name in EDITS],
)
def test_n7_a_scene_that_is_read_again_looks_like_one_that_is_loaded(
    edited: Edited, ctx: moderngl.Context, stage: Stage, camera: Aim, changes: list[tuple[str, str]]
) -> None:
    aim = camera(0.3, 6.5, 14.0, pitch=-18)
    prairie = edited.prairie
    prairie.advance(1.25)
    before = stage.shot(prairie, aim)
    edited.edit(*changes)
    stage.shot(prairie, camera(-20, 2.2, -20, yaw=180))
    after = stage.shot(prairie, aim)
    assert (after != before).any()
    fresh = Prairie.load(edited.path, ctx=ctx)
    fresh.advance(1.25)
    np.testing.assert_array_equal(after, stage.shot(fresh, aim))
    fresh.release()


def test_n7_a_map_that_is_painted_over_is_read_again(edited: Edited, stage: Stage, camera: Aim) -> None:
    prairie, aim = edited.prairie, camera(0.3, 6.5, 14.0, pitch=-18)
    before, terrain = stage.shot(prairie, aim), prairie.site.ground.terrain
    Image.new("L", (33, 33), 255).save(edited.path.parent / "map.png")
    with pytest.raises(SceneError, match="bright"):
        prairie.reload()
    picture = np.full((33, 33), 255, np.uint8)
    picture[0] = 0
    Image.fromarray(picture).save(edited.path.parent / "map.png")
    prairie.reload()
    assert prairie.site.ground.terrain is terrain
    assert (stage.shot(prairie, aim) != before).any()


def test_n7_winds_that_did_not_change_keep_their_name_wherever_they_stand(edited: Edited) -> None:
    place = np.array([[0, 0], [6, 2], [-9, 4]], np.float32)
    prairie = edited.prairie

    def names() -> list[str]:
        return sorted(source.name for source in prairie.winds.sources())

    before, felt = names(), prairie.wind_at(place, 7.5)
    edited.edit(("wind:\n", "wind:\n  - { kind: gust, start: 100 }\n  - { kind: breeze, start: 100 }\n"))
    np.testing.assert_array_equal(prairie.wind_at(place, 7.5), felt)
    assert set(names()) > set(before)
    assert len(set(names())) == 5
    edited.edit(("speed: 9", "speed: 8"))
    assert names() == before
    edited.edit(("  - { kind: breeze, strength: 0.4 }\n", ""))
    assert names() == before[1:]
    edited.edit()
    assert names() == before
    np.testing.assert_array_equal(prairie.wind_at(place, 7.5), felt)


def test_n7_winds_that_did_not_change_stay_the_entities_that_a_game_knows(edited: Edited) -> None:
    prairie = edited.prairie

    def entities() -> dict[str, int]:
        return {source.name: entity for entity, source in prairie.world.all(WindSource)}

    before = entities()
    edited.edit(("speed: 9", "speed: 8"), ("seed: 5", "seed: 6"))
    assert entities() == before
    edited.edit(("  - { kind: breeze, strength: 0.4 }\n", ""))
    assert len(entities()) == len(before) - 1
    assert entities().items() < before.items()


def test_n7_winds_that_a_game_added_blow_on(edited: Edited) -> None:
    prairie = edited.prairie
    handle = prairie.add(Gust(), pose=Pose(3.0, 4.0))
    for changes in ([("strength: 0.4", "strength: 0.2")], [("seed: 5", "seed: 6")]):
        edited.edit(*changes)
        assert any(source.name == "gust" for source in prairie.winds.sources())
    prairie.move(handle, Pose(1.0, 1.0))
    prairie.remove(handle)
    assert len(prairie.winds.sources()) == 3


def test_n7_a_scene_that_is_wrong_changes_nothing(
    edited: Edited, untouched: Prairie, stage: Stage, camera: Aim, receivers: Told
) -> None:
    for wrong in ("strength: strong", "strength: 0.4, strength: 0.5", "strenght: 0.4", "strength: [0.4"):
        with pytest.raises(SceneError, match=r"scene\.yaml:8:"):
            edited.edit(("strength: 0.4", wrong))
    with pytest.raises(SceneError, match="off the terrain"):
        edited.edit(("position: [0, 20]", "position: [0, 90]"))
    with pytest.raises(SceneError, match="no scene file"):
        edited.prairie.reload(edited.path.parent / "gone.yaml")
    for prairie in (edited.prairie, untouched):
        stage.shot(prairie, walked(camera, 0))
    assert receivers(edited.prairie) == receivers(untouched)


def test_n7_entities_come_and_go_with_what_is_made_anew(edited: Edited, stage: Stage, camera: Aim) -> None:
    prairie, counts = edited.prairie, []
    for name in ("the seed", "the quality"):
        edited.edit(*EDITS[name])
        edited.edit()
        for _ in range(6):  # they are made by and by
            stage.shot(prairie, camera(0.3, 6.5, 14.0, pitch=-18))
        counts.append(len(prairie.world))
    assert counts[0] > 500
    assert len(set(counts)) == 1


def lasting(prairie: Prairie) -> list[object]:
    """Return the objects that take long to make, and the viewer's outlook."""
    painter, outlook = prairie.painter, prairie.viewers["main"]
    assert painter is not None
    grown = [*prairie.site.growths, prairie.site.ground.terrain]
    drawn = [*painter.part(LandPart).textures.values(), *painter.painters.values()]
    return [*grown, *drawn, outlook, outlook.patches, *outlook.kept.values()]


@pytest.mark.slow
def test_n7_thirty_edits_make_nothing_anew_that_takes_a_frame_and_cost_no_memory(
    edited: Edited, untouched: Prairie, stage: Stage, camera: Aim
) -> None:
    prairie, refused = edited.prairie, 0
    wrong = [[("seed: 5", "sed: 5")], [("{ kind", "{ kin")], [("strength: 0.4", "strength: [")]]
    cheap = [*NOTHING.values(), *wrong, EDITS["a wind"], EDITS["how winds meet"]]
    every = [*cheap, *EDITS.values()]
    for number, changes in enumerate(every):  # what is grown once is not what is measured
        try:
            edited.edit(*changes)
        except SceneError:
            refused += 1
        stage.shot(prairie, walked(camera, number))
    things, memory, spent = 0, 0, list[tuple[float, float]]()
    for number in range(-30, 30):  # on the first way all programs are made that are drawn with on the second
        if number == 0:
            edited.edit()
            stage.shot(prairie, walked(camera, 0))
            things, memory, spent = len(in_gl()), resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, []
        if number % 3 == 2:  # what these need to be made anew is theirs
            edited.edit(*[*EDITS.values()][number % 30 // 3])
            stage.shot(prairie, walked(camera, number % 30))
            edited.edit()
        stage.shot(prairie, walked(camera, number % 30))
        before, start = lasting(prairie), thread_time()
        stage.shot(prairie, walked(camera, number % 30))
        middle = thread_time()
        try:
            edited.edit(*cheap[number % len(cheap)])
        except SceneError:
            refused += 1
        stage.shot(prairie, walked(camera, number % 30))
        spent.append((middle - start, thread_time() - middle))
        assert all(old is new for old, new in zip(before, lasting(prairie), strict=True)), cheap[number % len(cheap)]
    edited.edit()
    stage.shot(prairie, walked(camera, 0))
    without, with_edit = np.median(spent, axis=0)
    assert with_edit < 2.5 * without, "reading the scene again takes as long as drawing it"
    asked = [*every, *(cheap[number % len(cheap)] for number in range(-30, 30))]
    assert refused == sum(each in wrong for each in asked)
    assert len(in_gl()) == things
    assert (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - memory) / 1024 < 15
    np.testing.assert_array_equal(prairie.wind_at([[0, 0], [6, 2]], 3.0), untouched.wind_at([[0, 0], [6, 2]], 3.0))
