"""The window to walk in, on a display of its own.

Modules that open windows are imported inside the tests, after the display is set.
"""

# ruff: noqa: PLC0415

import subprocess
from collections.abc import Callable
from math import radians
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from tallgrass.app.studio.take import Take
from tallgrass.systems.bodies.feature import BodiesPart
from tallgrass.systems.prairie import Prairie

from .walking import SIZE, click, let_go, press, seen, strike, winds

if TYPE_CHECKING:
    from tallgrass.app.window import Walk

Tallgrass = Callable[..., subprocess.CompletedProcess[str]]
pytestmark = [pytest.mark.window, pytest.mark.gl]


def test_r4_keys_walk_over_the_ground_and_the_picture_changes(walk: "Walk") -> None:
    before, start = seen(walk), walk.walker.position
    press(walk, "W", "LSHIFT")
    for _ in range(30):
        walk.frame(1 / 30)
    let_go(walk, "W")
    x, y, z = walk.walker.position
    assert z < start[2] - 3.0
    assert y == pytest.approx(float(walk.prairie.height_at([[x, z]])[0]) + 1.7, abs=1e-4)
    assert np.abs(seen(walk).astype(float) - before).mean() > 1.0
    for _ in range(60):
        walk.frame(1 / 30)
    assert abs(walk.walker.velocity[2]) < 0.01


def test_the_window_shows_what_is_drawn_headless(walk: "Walk", tallgrass: Tallgrass, scene: Path) -> None:
    press(walk, "F12")
    name = "tallgrass-little-001.png"
    with Image.open(scene.parent / name) as image:
        picture, story = np.asarray(image), dict(image.info)
    walk.tell([])
    # Windows and framebuffers may round a few pixels differently, each time that something is blended over them.
    apart = np.abs(seen(walk) - picture.astype(float))
    assert apart.max() <= 6.0
    assert (apart > 2.0).mean() < 0.0001
    assert (apart > 0.0).mean() < 0.002
    options = ("--time", story["time"], "--camera", story["camera"], "--size", "160x90")
    assert tallgrass("shot", scene, "-o", "a.png", *options).returncode == 0
    with Image.open(scene.parent / "a.png") as image:
        assert np.abs(np.asarray(image).astype(float) - picture).mean() < 1.0


def test_space_stops_the_wind_and_starts_it_again(walk: "Walk") -> None:
    press(walk, "SPACE")
    time = walk.prairie.time
    walk.frame(0.05)
    assert walk.prairie.time == time
    press(walk, "SPACE")
    walk.frame(0.05)
    assert walk.prairie.time == pytest.approx(time + 0.05)


def test_a_long_hold_up_is_no_leap_in_time(walk: "Walk") -> None:
    time = walk.prairie.time
    walk.frame(30.0)
    assert walk.prairie.time - time <= 0.1 + 1e-9


def test_the_mouse_turns_the_look_only_once_it_is_caught(walk: "Walk") -> None:
    def move() -> None:
        walk.window.dispatch_event("on_mouse_motion", 5, 5, 100, -20)
        walk.window.dispatch_events()

    yaw, pitch = walk.walker.yaw, walk.walker.pitch
    move()
    assert (walk.walker.yaw, walk.walker.pitch) == (yaw, pitch)
    click(walk)
    move()
    assert walk.walker.yaw - yaw == pytest.approx(0.22)
    assert walk.walker.pitch - pitch == pytest.approx(-0.044)


def test_the_first_escape_lets_the_mouse_go_and_the_second_closes(walk: "Walk") -> None:
    click(walk)
    press(walk, "ESCAPE")
    walk.frame(1 / 60)
    assert (walk.captured, walk.closed) == (False, False)
    press(walk, "ESCAPE")
    walk.frame(1 / 60)
    assert walk.closed
    assert walk.prairie.painter is None


def test_help_and_statistics_are_shown_and_hidden(walk: "Walk") -> None:
    walk.tell([])
    plain = seen(walk)
    for name in ("F1", "F3"):
        press(walk, name)
        covered = (seen(walk) != plain).any(axis=2).mean()
        assert covered > 0.1
        press(walk, name)
        np.testing.assert_array_equal(seen(walk), plain)


def test_n8_f2_shows_how_it_works_part_by_part_and_in_the_end_the_prairie_alone(walk: "Walk") -> None:
    def shown() -> NDArray[np.uint8]:
        walk.tell([])
        return seen(walk)

    plain = shown()
    before: list[NDArray[np.uint8]] = []
    for parts in ({"masks", "arrows"}, {"levels", "weights"}, {"map"}, {"masks", "arrows", "levels", "weights", "map"}):
        press(walk, "F2")
        assert walk.overlay.layers == parts
        picture = shown()
        assert (picture != plain).any(axis=2).mean() > 0.02
        assert not any(np.array_equal(picture, other) for other in before)
        before.append(picture)
    press(walk, "F2")
    assert walk.overlay.layers == set()
    np.testing.assert_array_equal(shown(), plain)


def test_n8_the_overlay_goes_on_over_a_scene_that_is_read_again(walk: "Walk") -> None:
    press(walk, "F2", "F2", "F5")
    walk.tell([])
    picture = seen(walk)
    press(walk, *["F2"] * 3)
    walk.tell([])
    assert (seen(walk) != picture).any(axis=2).mean() > 0.1


def test_n8_saved_pictures_are_numbered_and_without_the_overlay(walk: "Walk", scene: Path) -> None:
    press(walk, "F12", "F2", "F12")
    saved = sorted(scene.parent.glob("*.png"))
    assert [path.name for path in saved] == ["tallgrass-little-001.png", "tallgrass-little-002.png"]
    first, second = (np.asarray(Image.open(path)) for path in saved)
    np.testing.assert_array_equal(first, second)


def test_f_takes_off_and_lands(walk: "Walk") -> None:
    press(walk, "F", "E")
    for _ in range(20):
        walk.frame(1 / 30)
    let_go(walk, "E")
    x, y, z = walk.walker.position
    ground = float(walk.prairie.height_at([[x, z]])[0])
    assert y > ground + 3.0
    press(walk, "F")
    for _ in range(60):
        walk.frame(1 / 30)
    assert walk.walker.position[1] == pytest.approx(ground + 1.7, abs=0.05)


def test_r4_g_boards_a_saucer_that_keys_fly_and_leaves_it(walk: "Walk") -> None:
    before, plain, walker = winds(walk), seen(walk), walk.walker
    press(walk, "G")
    assert walk.flight is not None
    assert (seen(walk) != plain).any(axis=2).mean() > 0.03, "it is seen ahead"
    start = walk.flight.saucer.place
    press(walk, "W", "D")
    for _ in range(45):
        walk.frame(1 / 30)
    let_go(walk, "W")
    let_go(walk, "D")
    saucer = walk.flight.saucer
    assert saucer.place[2] < start[2] - 2.0
    assert saucer.yaw > 0.5
    assert winds(walk) == before | {"blast"}
    assert walk.walker == walker, "who flies does not walk"
    press(walk, "G")
    assert winds(walk) == before
    x, y, z = walk.walker.position
    assert (x, z) == pytest.approx((saucer.place[0], saucer.place[2]))
    assert y == pytest.approx(float(walk.prairie.height_at([[x, z]])[0]) + 1.7, abs=1e-4)
    seen(walk)
    painter = walk.prairie.painter
    assert painter is not None
    bodies = painter.part(BodiesPart).painter
    assert bodies is not None
    assert bodies.stream.count == 0


def test_r4_grass_under_the_saucer_is_pressed_outwards_wherever_it_flies(walk: "Walk") -> None:
    press(walk, "G", "W")
    for _ in range(30):
        walk.frame(1 / 30)
    assert walk.flight is not None
    around = np.array([[1.5, 0.0], [-1.5, 0.0], [0.0, 1.5], [0.0, -1.5]])
    from tallgrass.app.saucer import jet

    foot = jet(walk.flight.saucer, walk.ground)
    felt = walk.prairie.wind_at(around + np.array([foot.x, foot.z]))
    assert (np.einsum("ij,ij->i", felt, around / 1.5) > 0.3).all()
    assert foot.z > walk.flight.saucer.place[2], "its jet pushes it ahead"


def test_the_mouse_looks_around_the_saucer(walk: "Walk") -> None:
    press(walk, "G")
    click(walk)
    before = walk.camera
    walk.window.dispatch_event("on_mouse_motion", 5, 5, 200, 0)
    walk.window.dispatch_events()
    assert walk.camera.yaw - before.yaw == pytest.approx(0.44)
    assert walk.camera.position != before.position


@pytest.mark.parametrize(("digit", "kind"), [("1", "gust"), ("2", "whirlwind"), ("3", "blast")])
def test_n8_digits_set_off_winds_that_end_by_themselves(walk: "Walk", digit: str, kind: str) -> None:
    before = winds(walk)
    walk.prairie.advance(1.0)
    strike(walk, digit)
    walk.frame(0.05)
    assert (winds(walk), len(walk.weather)) == (before | {kind}, 1)
    walk.prairie.advance(60.0)
    walk.frame(0.05)
    assert (winds(walk), len(walk.weather)) == (before, 0)


def test_another_window_in_front_lets_go_of_keys_and_mouse(walk: "Walk") -> None:
    click(walk)
    press(walk, "W")
    walk.window.dispatch_event("on_deactivate")
    walk.window.dispatch_events()
    before = walk.walker.position
    walk.frame(0.1)
    assert walk.walker.position == before
    assert not walk.captured


def test_a_resized_window_is_filled(walk: "Walk") -> None:
    walk.window.set_size(240, 80)
    for _ in range(3):
        walk.window.dispatch_events()
        walk.frame(1 / 60)
    picture = seen(walk)
    assert picture.shape == (80, 240, 3)
    assert picture[:, 200:].std() > 2.0
    assert walk.camera.view == pytest.approx(radians(40.0))


def test_where_a_window_has_more_pixels_than_points_all_of_them_are_drawn(
    walk: "Walk", monkeypatch: pytest.MonkeyPatch
) -> None:
    """On a screen of high density, a window's size is in points and differs from its pixels."""
    press(walk, "F12")
    monkeypatch.setattr(type(walk.window), "get_size", lambda _: (SIZE[0] // 2, SIZE[1] // 2))
    monkeypatch.setattr(type(walk.window), "get_framebuffer_size", lambda _: SIZE)
    press(walk, "F12")
    assert seen(walk)[SIZE[1] // 3 : SIZE[1] // 2, SIZE[0] // 2 :].std() > 2.0
    first, other = (np.asarray(Image.open(path)) for path in sorted(Path.cwd().glob("*.png"))[-2:])
    np.testing.assert_array_equal(first, other)


def test_a_window_over_the_whole_screen_is_filled_and_may_be_left(scene: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from tallgrass.app.display import need_display

    monkeypatch.chdir(scene.parent)
    need_display()
    from tallgrass.app.window import Walk, open_window

    window = open_window(SIZE, fullscreen=True)
    walk = Walk(window, Prairie.load(scene), Take(str(scene), window.get_size()))
    try:
        assert window.get_size() == (window.screen.width, window.screen.height)
        for _ in range(2):
            walk.window.dispatch_events()
            walk.frame(1 / 60)
        width = seen(walk).shape[1]
        assert seen(walk)[:, width - width // 8 :].std() > 2.0
        window.set_fullscreen(False, width=SIZE[0], height=SIZE[1])
        for _ in range(3):
            walk.window.dispatch_events()
            walk.frame(1 / 60)
        assert seen(walk).shape[1] < width
    finally:
        walk.close()


def test_walk_opens_a_window_and_closes_by_itself(tallgrass: Tallgrass, scene: Path) -> None:
    done = tallgrass("walk", scene, "--size", "160x90", "--preset", "low", "--seconds", 0.5)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
