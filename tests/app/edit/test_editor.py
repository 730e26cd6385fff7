"""The editor: what it changes, refuses, undoes and saves, without a window."""

from collections.abc import Iterator
from contextlib import AbstractContextManager
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from tallgrass.app.edit import pen
from tallgrass.app.edit.brush import Brush
from tallgrass.app.edit.editor import Editor
from tallgrass.app.edit.pen import Pen
from tallgrass.app.edit.values import NOTHING, with_value
from tallgrass.engine.kept import replacing
from tallgrass.engine.scene import read_scene
from tallgrass.systems.prairie import Prairie

SCENE = """\
# A little prairie.
tallgrass: 2
terrain: { size: [40, 40] } # flat

grass:
  low: # short
    height: [0.2, 0.3]
  high: { height: [0.4, 0.6], place: { map: high.png, channel: green } }
wind:
  - { kind: breeze, strength: 0.5 } # always
  - kind: whirlwind
    position: [4, -2]
    radius: 3
  - { kind: gust, every: [5, 9] }
light: { elevation: 30 }
quality:
  blades: 20
  models: 1
  blade_rings: [{ to: 1, segments: 2 }]
  strip_rings: [{ to: 3, strips: 2, columns: 1, sections: 1, texel: 0.02 }]
  carpet_to: 10
  carpet: 16
"""


@pytest.fixture
def path(tmp_path: Path) -> Path:
    Image.fromarray(np.full((8, 8, 3), 51, np.uint8)).save(tmp_path / "high.png")
    scene = tmp_path / "little.yaml"
    scene.write_text(SCENE)
    return scene


@pytest.fixture
def editor(path: Path) -> Iterator[Editor]:
    made = Editor(Prairie.load(path))
    yield made
    made.close()
    made.prairie.release()


def lines_changed(path: Path) -> list[tuple[str, str]]:
    now = path.read_text().splitlines()
    return [(a, b) for a, b in zip(SCENE.splitlines(), now, strict=True) if a != b]


def test_light_and_wind_change_at_once_and_nothing_else_is_made_anew(editor: Editor) -> None:
    ground, grown = editor.prairie.site.ground, editor.prairie.site.representations
    assert editor.set(("light", "elevation"), 50.0)
    assert editor.set(("wind", 0, "strength"), 0.25)
    assert editor.prairie.scene.light.elevation == 50.0
    assert editor.prairie.winds.sources()[0].primitive.model_dump()["strength"] == 0.25
    assert editor.prairie.site.ground is ground
    assert editor.prairie.site.representations is grown
    assert not editor.remaking.is_growing


def test_grass_grows_behind_the_frame_and_light_does_not_wait_for_it(editor: Editor) -> None:
    before = editor.prairie.site.growths
    editor.set(("grass", "low", "height", 1), 0.35)
    assert editor.remaking.is_growing
    assert editor.scene.grass["low"].height == [0.2, 0.35]
    editor.set(("light", "elevation"), 60.0)
    assert editor.prairie.scene.light.elevation == 60.0
    assert editor.prairie.site.growths == before
    editor.remaking.wait()
    assert editor.prairie.scene == editor.scene
    assert editor.prairie.site.growths[0] is not before[0]
    assert editor.prairie.site.growths[1] is before[1]


def test_of_many_changes_while_grass_grows_the_last_one_is_what_comes(editor: Editor) -> None:
    for height in (0.31, 0.32, 0.33, 0.34):
        editor.set(("grass", "low", "height", 1), height, subject="height")
    editor.remaking.wait()
    assert editor.prairie.scene.grass["low"].height[1] == 0.34
    editor.undo()
    editor.remaking.wait()
    assert editor.prairie.scene.grass["low"].height[1] == 0.3


@pytest.mark.parametrize(
    ("way", "value", "reason"),
    [
        (("light", "elevation"), 100.0, "elevation must be between 0 and 90 degrees, found 100"),
        (("grass", "low", "height", 0), 0.5, "height must be [shortest, tallest], rising, between 0.02 and 5 m"),
        (("wind", 1, "kind"), "wirlwind", "did you mean 'whirlwind'?"),
        (("grass", "low", "tip"), "greenish", "tip must be a colour such as '#2f4019'"),
        (("seed",), 1.5, "seed must be a whole number"),
        (("grass", "high", "place", "map"), "hihg.png", "no file 'hihg.png'"),
        (("grass", "high", "place"), {"map": "little.yaml"}, "little.yaml"),
        (("camera",), {"position": [50.0, 0.0]}, "position is off the terrain"),
        (("wind", 9, "strength"), 0.5, "no such place"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused_with_its_reason_and_changes_nothing(
    editor: Editor, way: tuple[str | int, ...], value: object, reason: str
) -> None:
    draft, scene = editor.history.now, editor.prairie.scene
    assert not editor.set(way, value)
    assert editor.refusal is not None
    assert reason in editor.refusal.reasons[0]
    assert editor.refusal.way == way
    assert editor.history.now is draft
    assert editor.prairie.scene is scene
    assert editor.set(("light", "elevation"), 31.0)
    assert editor.refusal is None


def test_what_only_shows_when_it_is_made_is_never_saved_and_taken_back_with_its_reason(
    editor: Editor, path: Path
) -> None:
    editor.set(("camera",), {"position": [15.0, 0.0]})
    assert editor.set(("terrain", "size"), [20.0, 20.0])
    assert editor.save() == ""
    assert path.read_text() == SCENE
    while editor.remaking.is_growing:
        editor.step()
    assert editor.refusal is not None
    assert "position is off the terrain" in editor.refusal.reasons[0]
    assert editor.scene.terrain.size == [40.0, 40.0]
    assert editor.scene.camera.position == [15.0, 0.0]


def test_undo_and_redo_go_through_every_step_and_a_drag_is_one(editor: Editor) -> None:
    first = editor.scene
    anchor = next(each for number, each in editor.anchors() if number == 1)
    for step in range(5):
        editor.drag([anchor], (step, 0.5 * step))
    editor.rest()
    editor.set(("light", "hour"), 8.0)
    editor.set(("wind", 0), NOTHING)
    assert [wind.kind for wind in editor.prairie.scene.wind] == ["whirlwind", "gust"]
    last = editor.scene
    editor.undo()
    editor.undo()
    assert editor.scene.light == first.light
    assert editor.scene.wind[1].model_dump()["position"] == [8.0, 0.0]
    editor.undo()
    assert editor.scene == first == editor.prairie.scene
    assert editor.history.is_saved
    for _ in range(3):
        editor.redo()
    assert editor.scene == last == editor.prairie.scene


def test_saving_changes_those_lines_alone_whose_keys_have_changed(editor: Editor, path: Path) -> None:
    editor.set(("light", "elevation"), 45.0)
    editor.set(("wind", 0, "strength"), 0.4)
    editor.set(("wind", 1, "position", 0), 5.5)
    assert editor.save() == "little.yaml is written"
    assert lines_changed(path) == [
        ("  - { kind: breeze, strength: 0.5 } # always", "  - { kind: breeze, strength: 0.4 } # always"),
        ("    position: [4, -2]", "    position: [5.5, -2]"),
        ("light: { elevation: 30 }", "light: { elevation: 45 }"),
    ]
    assert read_scene(path).scene == editor.scene
    assert editor.save() == "nothing has changed"
    editor.undo()
    assert not editor.history.is_saved
    editor.save()
    assert lines_changed(path)[1:] == [("light: { elevation: 30 }", "light: { elevation: 45 }")]


def test_a_stroke_is_seen_at_once_and_saved_into_the_map_that_the_scene_names(editor: Editor, path: Path) -> None:
    before = editor.prairie.site.ground.density.maps
    brush = Brush("high", radius=6.0)
    editor.paint([(-10.0, -10.0)], brush)
    editor.paint([(-10.0, -10.0), (0.0, -10.0)], brush)
    editor.rest()
    after = editor.prairie.site.ground.density.maps
    assert after[1].max() > 0.5
    assert after[1, 6:].max() == pytest.approx(0.2, abs=0.01), "far from the stroke all is as it was"
    assert not editor.remaking.is_growing
    assert editor.save() == "high.png is written"
    with Image.open(path.parent / "high.png") as image:
        painted = np.asarray(image)
    assert (painted[..., 0] == 51).all()
    assert painted[1:3, 2:4, 1].min() > 120
    assert path.read_text() == SCENE
    editor.undo()
    np.testing.assert_array_equal(editor.prairie.site.ground.density.maps, before)
    editor.save()
    with Image.open(path.parent / "high.png") as image:
        assert (np.asarray(image) == 51).all()


def test_the_first_stroke_of_a_kind_without_a_map_makes_one_that_says_what_was_true(editor: Editor, path: Path) -> None:
    brush = Brush("low", radius=5.0).erasing()
    editor.paint([(10.0, 10.0)], brush)
    place = editor.scene.grass["low"].place
    assert place is not None
    assert (place.map, place.channel) == ("little-low.png", "red")
    low = editor.prairie.site.ground.density.maps[0]
    assert low[: len(low) // 2].min() == pytest.approx(0.8, abs=0.01)
    assert low.min() < 0.5
    assert not (path.parent / "little-low.png").exists()
    assert editor.save() == "little.yaml and little-low.png are written"
    assert path.read_text() == SCENE.replace(
        "    height: [0.2, 0.3]\n", "    height: [0.2, 0.3]\n    place: { map: little-low.png, channel: red }\n"
    )
    again = Prairie.load(path)
    np.testing.assert_allclose(again.site.ground.density.maps, editor.prairie.site.ground.density.maps)
    again.release()
    editor.undo()
    assert editor.scene.grass["low"].place is None


def test_where_one_kind_is_painted_the_others_with_maps_make_room(editor: Editor) -> None:
    editor.set(("grass", "low", "place"), {"map": "high.png", "channel": "red"})
    brush = Brush("low", radius=8.0, pressure=1.0)
    editor.paint([(-10.0, 0.0), (-6.0, 0.0)], brush)
    low, high = editor.prairie.site.ground.density.maps
    assert (low - high).max() > 0.8
    assert high.max() == pytest.approx(0.2, abs=0.01)
    editor.rest()
    brush = replace(brush, alone=False, kind="high")
    editor.paint([(10.0, 0.0), (6.0, 0.0)], brush)
    low, high = editor.prairie.site.ground.density.maps
    right = slice(len(low) // 2, None)
    assert high[:, right].max() > 0.7
    assert low[:, right].max() == pytest.approx(0.2, abs=0.01)


def test_a_file_that_somebody_else_has_changed_is_not_written_over(editor: Editor, path: Path) -> None:
    editor.set(("light", "elevation"), 45.0)
    path.write_text(SCENE.replace("radius: 3", "radius: 2"))
    assert editor.save() == ""
    assert editor.refusal is not None
    assert "changed by somebody else" in editor.refusal.reasons[0]
    editor.read_again()
    assert editor.prairie.scene.light.elevation == 30.0
    assert editor.prairie.scene.wind[1].model_dump()["radius"] == 2
    assert editor.history.is_saved


def test_a_map_that_somebody_else_has_changed_or_made_is_not_written_over(editor: Editor, path: Path) -> None:
    for kind, name in (("high", "high.png"), ("low", "little-low.png")):
        brush = Brush(kind, radius=8.0)
        editor.paint([(-10.0, 0.0)], brush)
        editor.remaking.wait()
        theirs = Image.new("RGB", (8, 8), "#102030")
        theirs.save(path.with_name(name))
        assert editor.save() == ""
        assert editor.refusal is not None
        assert f"{name} has been changed by somebody else" in editor.refusal.reasons[0]
        assert Image.open(path.with_name(name)).getpixel((0, 0)) == (16, 32, 48)
        editor.read_again()
        path.with_name("little-low.png").unlink(missing_ok=True)


def test_a_file_behind_a_link_is_written_there_and_may_be_read_by_the_same(path: Path) -> None:
    real = path.with_name("real.yaml")
    path.rename(real).chmod(0o640)
    path.symlink_to(real)
    editor = Editor(Prairie.load(path))
    editor.set(("light", "elevation"), 45.0)
    assert editor.save() == "little.yaml is written"
    assert path.is_symlink()
    assert "elevation: 45" in real.read_text()
    assert real.stat().st_mode & 0o777 == 0o640
    editor.close()
    editor.prairie.release()


def test_a_bundled_scene_stays_and_a_copy_with_its_maps_is_written_here(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    loaded = read_scene("meadow")
    bundled, values = loaded.file.read_text(), loaded.document.root.data
    changed = with_value(values, ("light", "elevation"), 45.0)
    writer = Pen(loaded)
    assert writer.write(changed, {}) == ["meadow.yaml"]
    assert writer.path == tmp_path / "meadow.yaml"
    assert writer.path.read_text() == bundled.replace("elevation: 30", "elevation: 45")
    assert read_scene(writer.path).scene.light.elevation == 45.0
    assert loaded.file.read_text() == bundled
    assert writer.write(values, {}) == ["meadow.yaml"]
    with pytest.raises(ValueError, match=r"meadow\.yaml is in this folder already"):
        Pen(loaded).write(changed, {})
    writer.path.unlink()
    (tmp_path / next(name for name in loaded.files if name.endswith(".png"))).write_bytes(b"another picture")
    with pytest.raises(ValueError, match=r"another .* is in this folder already"):
        Pen(loaded).write(changed, {})


@pytest.mark.parametrize("name", ["little.yaml", "high.png"])
def test_a_file_that_nobody_may_write_stays_and_the_others_with_it(editor: Editor, path: Path, name: str) -> None:
    editor.set(("light", "elevation"), 45.0)
    editor.paint([(-10.0, -10.0)], Brush("high"))
    map_before = path.with_name("high.png").read_bytes()
    path.with_name(name).chmod(0o444)
    assert editor.save() == ""
    assert editor.refusal is not None
    assert editor.refusal.reasons == (f"{name} is read-only: allow writing it, and save again",)
    assert (path.read_text(), path.with_name("high.png").read_bytes()) == (SCENE, map_before)
    path.with_name(name).chmod(0o644)
    assert editor.save() == "little.yaml and high.png are written"


def test_a_scene_whose_file_is_gone_is_written_again(editor: Editor, path: Path) -> None:
    editor.set(("light", "elevation"), 45.0)
    path.unlink()
    assert editor.save() == "little.yaml is written"
    assert read_scene(path).scene == editor.scene
    path.unlink()
    assert editor.save() == "little.yaml is written"


def test_maps_that_were_written_before_the_scene_could_not_be_are_known_the_next_time(
    editor: Editor, path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    editor.set(("light", "elevation"), 45.0)
    editor.paint([(-10.0, -10.0)], Brush("high"))

    def full(file: Path) -> AbstractContextManager[Path]:
        if file.suffix == ".yaml":
            raise OSError(28, "No space left on device", ".3f2a.part")
        return replacing(file)

    monkeypatch.setattr(pen, "replacing", full)
    assert editor.save() == ""
    assert editor.refusal is not None
    assert editor.refusal.reasons == (f"{path.parent} cannot be written to: No space left on device",)
    monkeypatch.undo()
    assert editor.save() == "little.yaml is written"


def test_what_fails_while_it_grows_is_taken_back_and_told(editor: Editor, monkeypatch: pytest.MonkeyPatch) -> None:
    editor.set(("light", "elevation"), 45.0)
    editor.rest()

    def grow(*_: object, **__: object) -> None:
        raise MemoryError("no room")

    monkeypatch.setattr("tallgrass.systems.site.cached_growth", grow)
    assert editor.set(("grass", "low", "height", 1), 0.37)
    while editor.remaking.is_growing:
        editor.step()
    assert editor.refusal is not None
    assert editor.refusal.reasons == ("it cannot grow: MemoryError: no room",)
    assert (editor.scene.grass["low"].height[1], editor.scene.light.elevation) == (0.3, 45.0)


def test_a_brush_for_a_kind_that_is_gone_does_nothing(editor: Editor) -> None:
    draft = editor.history.now
    brush = replace(Brush("high"), kind="other")
    editor.paint([(0.0, 0.0)], brush)
    assert editor.history.now is draft
