"""The panel over a walk, driven by mouse and key events.

Modules that open windows are imported inside the tests, after the display is set.
"""

# ruff: noqa: PLC0415

import difflib
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

from tallgrass.engine.scene import read_scene

from .driving import LEFT, SCENE, SIZE, button, drag, field, frames, on_ground, opened, seen, shown, strike, tell

if TYPE_CHECKING:
    from tallgrass.app.edit.window import EditWalk

pytest.importorskip("imgui_bundle", reason="the panel is drawn by imgui-bundle, of the extra 'edit'")
pytestmark = [pytest.mark.window, pytest.mark.gl]


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


def test_the_panel_stays_at_the_right_edge_of_a_window_of_another_size(walk: "EditWalk") -> None:
    walk.window.set_size(SIZE[0] + 500, SIZE[1])
    frames(walk, 2)
    assert walk.panel.buttons["save"][0] > SIZE[0]


def test_a_window_without_pixels_is_walked_in_and_edited_all_the_same(
    walk: "EditWalk", monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(walk.window, "get_size", lambda: (0, 0))
    monkeypatch.setattr(walk.window, "get_framebuffer_size", lambda: (0, 0))
    drag(walk, (0.0, 0.0), (1.0, 1.0))
    strike(walk, "F12")
    monkeypatch.undo()
    assert not [*Path().glob("*.png")]
    frames(walk, 2)
    assert walk.panel.buttons["save"][0] > 0


def test_a_slider_is_let_go_when_another_window_takes_over(walk: "EditWalk") -> None:
    opened(walk, ("light",))
    x, y = field(walk, ("light", "elevation"), 0.4)
    tell(walk, "on_mouse_motion", x, y, 0, 0)
    frames(walk)
    tell(walk, "on_mouse_press", x, y, LEFT, 0)
    frames(walk)
    tell(walk, "on_deactivate")
    before = walk.editor.scene.light.elevation
    tell(walk, "on_mouse_motion", x + 60, y, 60, 0)
    frames(walk, 2)
    assert walk.editor.scene.light.elevation == before


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


def test_what_is_unsaved_stays_in_a_copy_when_the_editor_ends_abnormally_and_the_next_walk_names_it(
    walk: "EditWalk", monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    from tallgrass.app.edit.brush import Brush
    from tallgrass.app.edit.rescue import rescued

    def ends(**_: object) -> None:
        raise KeyboardInterrupt

    walk.editor.set(("light", "elevation"), 50.0)
    walk.editor.paint([(0.0, 0.0)], Brush("green", radius=4.0, pressure=1.0, density=0.0))
    monkeypatch.setattr("pyglet.app.run", ends)
    with pytest.raises(KeyboardInterrupt):
        walk.run()
    assert rescued(Path("lawn.yaml"), Path()) == ["lawn-rescued.yaml"]
    assert "what was not saved is in" in caplog.text
    again = read_scene("lawn-rescued.yaml")
    assert again.scene.light.elevation == 50.0
    assert again.scene.grass["green"].place is not None
    assert Path("lawn.yaml").read_text() == SCENE


def test_a_copy_of_what_is_unsaved_goes_once_it_is_saved_or_given_up(walk: "EditWalk") -> None:
    from tallgrass.app.edit.rescue import INTERVAL

    copy = Path("lawn-rescued.yaml")
    for give_up in (False, True):
        walk.editor.set(("light", "elevation"), 50.0 + give_up)
        frames(walk, 1, dt=INTERVAL)
        assert "elevation: 5" in copy.read_text()
        if give_up:
            strike(walk, "ESCAPE")
            strike(walk, "ESCAPE")
        else:
            walk.save()
            frames(walk, 1, dt=INTERVAL)
        assert not copy.exists()
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


def test_n13_a_tab_has_a_bar_for_every_system_of_the_frame(walk: "EditWalk", monkeypatch: pytest.MonkeyPatch) -> None:
    from imgui_bundle import imgui

    told: list[str] = []
    monkeypatch.setattr(imgui, "set_item_tooltip", told.append)
    drag(walk, button(walk, "frame"))
    told.clear()
    frames(walk)
    bars = [line.partition(",")[0] for line in told]
    assert bars == [*(system.name for system in walk.prairie.systems if system.name != "draw"), "drawing"]
