"""The panel over a walk, driven by mouse and key events.

Modules that open windows are imported inside the tests, after the display is set.
"""

# ruff: noqa: PLC0415

import difflib
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from numpy.typing import NDArray
from pydantic import BaseModel, Field

from tallgrass.app.edit.fields import keys_of
from tallgrass.app.edit.pick import Sight
from tallgrass.app.edit.values import Way
from tallgrass.app.studio.take import Take
from tallgrass.components.arrays import Floats
from tallgrass.components.wind import Extent, Grass
from tallgrass.engine.camera import View
from tallgrass.engine.plugins import WindKinds, wind_kinds
from tallgrass.engine.scene import bundled_scenes, read_scene
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.wind.placed import PlacedWind

if TYPE_CHECKING:
    from tallgrass.app.edit.window import EditWalk

pytest.importorskip("imgui_bundle", reason="the panel is drawn by imgui-bundle, of the extra 'edit'")
pytestmark = [pytest.mark.window, pytest.mark.gl]
SIZE = (720, 480)
LEFT = 1

SCENE = """\
# A lawn with a whirlwind.
tallgrass: 2
seed: 5
terrain: { size: [60, 60] } # flat
grass:
  green: # short
    height: [0.3, 0.5]
    root: "#204010"
    tip: "#40a020"
wind:
  - kind: whirlwind # it stays
    position: [-2, 10]
    radius: 3
camera: { position: [5, 20], pitch: -25 }
light: { elevation: 40 } # high
quality:
  blades: 40
  models: 1
  blade_rings: [{ to: 1, segments: 2 }]
  strip_rings: [{ to: 3, strips: 2, columns: 1, sections: 1, texel: 0.02 }]
  carpet_to: 10
  carpet: 16
"""


@pytest.fixture
def walk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator["EditWalk"]:
    """A walk with a panel through a lawn, drawn twice; pyglet checks every GL call."""
    monkeypatch.setenv("PYGLET_DEBUG_GL", "1")
    monkeypatch.chdir(tmp_path)
    from tallgrass.app.display import need_display

    need_display()
    from tallgrass.app.edit.window import EditWalk
    from tallgrass.app.window import open_window

    path = tmp_path / "lawn.yaml"
    path.write_text(SCENE)
    started = EditWalk(open_window(SIZE), Prairie.load(path), Take(str(path), SIZE))
    started.prairie.governor.hold = None
    frames(started, 2)
    yield started
    if not started.closed:
        assert started.ctx.error == "GL_NO_ERROR"
    started.close()


def frames(walk: "EditWalk", count: int = 1, dt: float = 1 / 30) -> None:
    for _ in range(count):
        walk.frame(dt)
        if not walk.closed:
            walk.window.dispatch_events()


def tell(walk: "EditWalk", event: str, *arguments: object) -> None:
    walk.window.dispatch_event(event, *arguments)
    walk.window.dispatch_events()


def strike(walk: "EditWalk", name: str, *, ctrl: bool = False) -> None:
    from pyglet.window import key

    modifiers = key.MOD_CTRL if ctrl else 0
    tell(walk, "on_key_press", getattr(key, name), modifiers)
    tell(walk, "on_key_release", getattr(key, name), 0)
    frames(walk)


def drag(walk: "EditWalk", *places: tuple[float, float], modifiers: int = 0) -> None:
    """Press the left button at the first place [pixels from the lower left], pull it along the others, let go."""
    x, y = places[0]
    tell(walk, "on_mouse_motion", x, y, 0, 0)
    frames(walk)
    tell(walk, "on_mouse_press", x, y, LEFT, modifiers)
    frames(walk)
    for new_x, new_y in places[1:]:
        tell(walk, "on_mouse_drag", new_x, new_y, new_x - x, new_y - y, LEFT, modifiers)
        x, y = new_x, new_y
        frames(walk)
    tell(walk, "on_mouse_release", x, y, LEFT, modifiers)
    frames(walk)


def field(walk: "EditWalk", way: Way, part: float = 0.5) -> tuple[float, float]:
    """Return a place in the field of a key, at a fraction of its width [pixels from the window's lower left]."""
    left, top, right, bottom = walk.panel.tree.boxes[way]
    return left + part * (right - left), SIZE[1] - (top + bottom) / 2


def opened(walk: "EditWalk", *ways: Way) -> None:
    for way in ways:
        walk.panel.tree.open(way)
    frames(walk, 2)


def button(walk: "EditWalk", name: str) -> tuple[float, float]:
    left, top, right, bottom = walk.panel.buttons[name]
    return (left + right) / 2, SIZE[1] - (top + bottom) / 2


def on_ground(walk: "EditWalk", x: float, z: float) -> tuple[float, float]:
    """Return the pixel of a place on the ground, from the lower left."""
    sight = Sight(SIZE, View(*walk.matrices(SIZE)), walk.prairie.site.ground.terrain)
    ((right, up),) = sight.pixels_on_ground([(x, z)]).tolist()
    return right, up


def seen(walk: "EditWalk") -> NDArray[np.float64]:
    """Draw the prairie without panel and notes, and return the window's picture."""
    walk.window.switch_to()
    walk.window.clear()
    walk.prairie.draw(*walk.matrices(SIZE))
    return shown()


def shown() -> NDArray[np.float64]:
    """Return the current window's picture (height, width, 3)."""
    from pyglet.image import get_buffer_manager

    buffers: Any = get_buffer_manager()
    image = buffers.get_color_buffer().get_image_data()
    picture = np.frombuffer(image.get_data("RGBA"), np.uint8).reshape(image.height, image.width, 4)
    return picture[::-1, :, :3].astype(np.float64)


def test_n13_a_slider_changes_the_picture_while_the_wind_blows_on(walk: "EditWalk") -> None:
    opened(walk, ("light",))
    time, before = walk.prairie.time, seen(walk)
    receivers = walk.prairie.viewers["main"].patches
    drag(walk, field(walk, ("light", "elevation"), 0.45), field(walk, ("light", "elevation"), 0.1))
    assert walk.prairie.scene.light.elevation == pytest.approx(9.0, abs=5.0)
    assert walk.prairie.time > time
    assert walk.prairie.viewers["main"].patches is receivers
    assert np.abs(seen(walk) - before).mean() > 5.0
    strike(walk, "Z", ctrl=True)
    assert walk.prairie.scene.light.elevation == 40.0
    assert np.abs(seen(walk) - before).mean() < 2.0
    strike(walk, "Y", ctrl=True)
    assert walk.prairie.scene.light.elevation == pytest.approx(9.0, abs=5.0)


def test_n13_a_wind_is_picked_pulled_and_turned_on_the_ground(walk: "EditWalk") -> None:
    x, y = on_ground(walk, -2.0, 10.0)
    drag(walk, (x, y), (x + 20, y), on_ground(walk, 0.0, 10.0))
    (wind,) = walk.prairie.scene.wind
    pulled = wind.model_dump()["position"]
    assert walk.editor.picked == 0
    assert pulled == pytest.approx([0.0, 10.0], abs=0.2)
    assert walk.prairie.wind_at([[-4.0, 10.0], [1.0, 10.0]]).any(axis=1).tolist() == [False, True]
    drag(walk, on_ground(walk, 1.5, 11.0), on_ground(walk, 0.5, 13.0))
    assert walk.prairie.scene.wind[0].model_dump()["position"] == pytest.approx([-1.0, 12.0], abs=0.2)
    from tallgrass.app.edit.grips import grips_of

    (knob,) = [grip for grip in grips_of(walk.editor) if grip.kind == "turn"]
    drag(walk, on_ground(walk, *knob.place), on_ground(walk, 3.0, 12.0))
    assert walk.prairie.scene.wind[0].model_dump()["yaw"] == pytest.approx(90.0, abs=3.0)
    for _ in range(3):
        strike(walk, "Z", ctrl=True)
    assert walk.prairie.scene.wind == read_scene("lawn.yaml").scene.wind
    assert walk.editor.history.is_saved


def test_n13_a_stroke_of_the_brush_is_seen_at_once_and_undone(walk: "EditWalk") -> None:
    from pyglet.window import key

    from tallgrass.app.edit.brush import Brush

    strike(walk, "SPACE")
    before = seen(walk)
    walk.editor.brush = Brush("green", radius=4.0, pressure=1.0)
    drag(walk, on_ground(walk, -2.0, 13.0), on_ground(walk, 4.0, 13.0), modifiers=key.MOD_SHIFT)
    maps = walk.prairie.site.ground.density.maps
    assert maps.min() < 0.1
    assert maps.max() == 1.0
    assert (np.abs(seen(walk) - before).max(axis=2) > 10.0).mean() > 0.05
    strike(walk, "Z", ctrl=True)
    assert (walk.prairie.site.ground.density.maps == 1.0).all()
    assert (np.abs(seen(walk) - before).max(axis=2) > 10.0).mean() < 0.005


def test_n13_what_cannot_be_is_refused_where_it_was_entered_and_says_why(walk: "EditWalk") -> None:
    opened(walk, ("light",))
    from pyglet.window import key

    tell(walk, "on_key_press", key.LCTRL, 0)
    drag(walk, field(walk, ("light", "elevation")), modifiers=key.MOD_CTRL)
    tell(walk, "on_key_release", key.LCTRL, key.MOD_CTRL)
    tell(walk, "on_text", "120")
    frames(walk)
    strike(walk, "RETURN")
    frames(walk)
    assert walk.editor.refusal is not None
    assert walk.editor.refusal.way == ("light", "elevation")
    assert walk.editor.refusal.reasons == ("elevation must be between 0 and 90 degrees, found 120",)
    assert walk.prairie.scene.light.elevation == 40.0
    assert walk.editor.history.is_saved
    opened(walk, ("grass", "green"))
    drag(walk, field(walk, ("grass", "green", "height"), 0.5), field(walk, ("grass", "green", "height"), -2.5))
    assert walk.editor.refusal is not None
    assert "rising" in walk.editor.refusal.reasons[0]


def test_n13_saving_writes_the_changed_keys_and_no_other_line(walk: "EditWalk", tmp_path: Path) -> None:
    opened(walk, ("light",))
    drag(walk, field(walk, ("light", "elevation"), 0.45), field(walk, ("light", "elevation"), 0.8))
    drag(walk, on_ground(walk, -2.0, 10.0), on_ground(walk, 0.0, 10.0))
    strike(walk, "S", ctrl=True)
    assert walk.editor.history.is_saved
    text = (tmp_path / "lawn.yaml").read_text()
    changed = [line for line in difflib.ndiff(SCENE.splitlines(), text.splitlines()) if line[0] in "-+"]
    assert [line.split(":")[0] for line in changed] == [
        "-     position", "+     position", "- light", "+ light",
    ]  # fmt: skip
    assert changed[3].endswith("} # high")
    assert read_scene(tmp_path / "lawn.yaml").scene == walk.prairie.scene
    site = walk.prairie.site
    frames(walk, 3, dt=0.3)
    assert walk.prairie.site is site, "what was saved here is not read again"


def test_the_panel_leaves_the_prairie_as_it_is_drawn_without_one(walk: "EditWalk") -> None:
    strike(walk, "SPACE")
    opened(walk, ("light",), ("wind", 0))
    alone = seen(walk)
    walk.on_draw()
    assert (seen(walk) == alone).all()
    assert walk.ctx.error == "GL_NO_ERROR"


def test_the_panel_is_whole_in_a_window_that_was_made_taller(walk: "EditWalk") -> None:
    walk.on_draw()
    bar = shown()[12:24, 370:700]
    walk.window.set_size(SIZE[0], SIZE[1] + 200)
    frames(walk, 2)
    walk.on_draw()
    np.testing.assert_array_equal(shown()[12:24, 370:700], bar)


def test_n7_who_walks_stands_on_a_terrain_that_was_changed(walk: "EditWalk") -> None:
    walk.editor.set(("terrain",), {"noise": "hills", "size": [60.0, 60.0], "scale": 40.0})
    walk.editor.remaking.wait()
    walk.settle()
    settled = walk.walker.position
    walk.editor.undo()
    while walk.editor.remaking.is_growing:
        frames(walk)
    assert settled[1] != pytest.approx(1.7, abs=0.1)
    assert walk.walker.position[1] == pytest.approx(1.7, abs=0.01)


def test_keys_that_are_typed_into_a_field_do_not_walk(walk: "EditWalk") -> None:
    opened(walk, ("light",))
    from pyglet.window import key

    drag(walk, field(walk, ("light", "sun"), 0.1))
    drag(walk, field(walk, ("light", "elevation")), modifiers=key.MOD_CTRL)
    place = walk.walker.position
    tell(walk, "on_key_press", key.W, 0)
    frames(walk, 5)
    assert walk.walker.position == place
    strike(walk, "ESCAPE")
    assert not walk.leaving


def test_what_is_unsaved_is_left_only_when_asked_twice_and_warned_of_again_after_each_change(walk: "EditWalk") -> None:
    walk.editor.set(("light", "elevation"), 50.0)
    strike(walk, "ESCAPE")
    walk.editor.set(("light", "elevation"), 60.0)
    strike(walk, "ESCAPE")
    assert not walk.closed
    walk.panel.save()  # as its button does
    walk.editor.set(("light", "elevation"), 70.0)
    strike(walk, "ESCAPE")
    assert not walk.closed
    strike(walk, "ESCAPE")
    assert walk.closed


def test_a_file_that_changes_meanwhile_is_read_again_unless_something_is_unsaved(
    walk: "EditWalk", tmp_path: Path
) -> None:
    (tmp_path / "lawn.yaml").write_text(SCENE.replace("radius: 3", "radius: 2"))
    frames(walk, 3, dt=0.3)
    assert walk.prairie.scene.wind[0].model_dump()["radius"] == 2
    walk.editor.set(("light", "elevation"), 50.0)
    (tmp_path / "lawn.yaml").write_text(SCENE.replace("radius: 3", "radius: 1"))
    frames(walk, 3, dt=0.3)
    assert walk.prairie.scene.light.elevation == 50.0
    strike(walk, "F5")
    assert walk.prairie.scene.light.elevation == 40.0
    assert walk.prairie.scene.wind[0].model_dump()["radius"] == 1


def test_n13_every_key_of_a_scene_has_its_field(walk: "EditWalk", tmp_path: Path) -> None:
    walk.window.set_size(720, 1000)
    text = bundled_scenes()["storm"].read_text().replace("quality: high", SCENE[SCENE.index("quality:") :])
    (tmp_path / "lawn.yaml").write_text(text.replace("[200, 200]", "[100, 100]"))
    walk.editor.read_again()
    parts = dict(parts_of(walk.editor.scene))
    assert len(parts) > 30
    opened(walk, *filter(None, parts))
    shown = set(walk.panel.tree.boxes)
    for way, part in parts.items():
        for key in keys_of(type(part)) if isinstance(part, BaseModel) else ():
            if key.form != "fixed":
                assert {(*way, key.name), (*way, key.name, "there")} & shown, (*way, key.name)


def parts_of(value: Any, way: Way = ()) -> Iterator[tuple[Way, Any]]:
    """Yield each part of a scene that can be opened in the panel, models and lists of models, with its way."""
    if isinstance(value, BaseModel):
        inner: list[tuple[str | int, Any]] = [(key.name, getattr(value, key.name)) for key in keys_of(type(value))]
    elif isinstance(value, dict):
        inner = list(value.items())
    elif isinstance(value, list) and value and isinstance(value[0], BaseModel):
        inner = list(enumerate(value))
    else:
        return
    yield way, value
    for step, each in inner:
        yield from parts_of(each, (*way, step))


class Draught(PlacedWind):
    """A plugin's wind."""

    kind: str = "draught"
    """A draught."""

    chill: float = Field(default=2.0, ge=0.0, le=8.0)
    """How cold it is [degrees]."""

    def extent(self, *, time: float) -> Extent:
        return Extent(-2.0, 2.0, -2.0, 2.0)

    def mask(self, place: Floats, /, *, time: float) -> Floats:
        return np.ones(len(place), np.float32)

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Floats:
        return np.full((len(place), 2), 0.2, np.float32)


def test_n13_a_strangers_wind_is_added_where_one_looks_and_has_its_fields(
    walk: "EditWalk", own_kinds: WindKinds, tmp_path: Path
) -> None:
    own_kinds.add("draught", Draught)
    assert walk.editor.add_wind_of("draught")
    frames(walk, 3)
    wind = walk.prairie.scene.wind[1]
    assert isinstance(wind, Draught)
    assert walk.editor.picked_wind is wind
    assert wind.position == pytest.approx(walk.editor.spot, abs=0.01)
    drag(walk, field(walk, ("wind", 1, "chill"), 0.25), field(walk, ("wind", 1, "chill"), 0.75))
    assert walk.prairie.scene.wind[1].model_dump()["chill"] == pytest.approx(6.0, abs=0.5)
    strike(walk, "S", ctrl=True)
    added = [line for line in (tmp_path / "lawn.yaml").read_text().splitlines() if line not in SCENE.splitlines()]
    (line,) = added
    assert line.startswith("  - { kind: draught, position: [")


@pytest.fixture
def own_kinds() -> Iterator[WindKinds]:
    wind_kinds.cache_clear()
    yield wind_kinds()
    wind_kinds.cache_clear()


def test_n13_a_tab_has_a_bar_for_every_system_of_the_frame(walk: "EditWalk", monkeypatch: pytest.MonkeyPatch) -> None:
    from imgui_bundle import imgui

    told: list[str] = []
    monkeypatch.setattr(imgui, "set_item_tooltip", told.append)
    drag(walk, button(walk, "frame"))
    told.clear()
    frames(walk)
    bars = [line.partition(",")[0] for line in told]
    assert bars == [*(system.name for system in walk.prairie.systems if system.name != "draw"), "drawing"]
