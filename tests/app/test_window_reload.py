"""Reading a scene again during a walk (N7)."""

from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from .walking import press, seen, strike, winds

if TYPE_CHECKING:
    from tallgrass.app.window import Walk

pytestmark = [pytest.mark.window, pytest.mark.gl]


def test_n7_the_saucer_flies_on_over_a_scene_that_is_read_again(walk: "Walk", scene: Path) -> None:
    press(walk, "G")
    strike(walk, "2")
    walk.frame(0.1)
    assert walk.flight is not None
    place = walk.flight.saucer.place
    scene.write_text(scene.read_text().replace("seed: 5", "seed: 6"))
    press(walk, "F5")
    assert walk.flight.saucer.place == pytest.approx(place, abs=0.05), "other blades have grown, about as high"
    assert winds(walk) == {"breeze", "blast", "whirlwind"}
    press(walk, "W")
    walk.frame(0.1)
    walk.frame(0.1)
    assert walk.flight.saucer.place[2] < place[2]


def test_n7_reading_the_scene_again_keeps_time_and_place(walk: "Walk", scene: Path) -> None:
    for _ in range(5):
        walk.frame(0.1)
    seen(walk)
    time, place, patches = walk.prairie.time, walk.walker, walk.prairie.viewers["main"].patches
    scene.write_text(scene.read_text().replace("strength: 0.5", "strength: 0.2"))
    press(walk, "F5")
    assert walk.prairie.viewers["main"].patches is patches
    scene.write_text(scene.read_text().replace("seed: 5", "seed: 6"))
    press(walk, "F5")
    assert walk.prairie.scene.seed == 6
    assert walk.prairie.time == pytest.approx(time)
    assert walk.walker.position == pytest.approx(place.position)
    walk.frame(1 / 60)


def test_n7_a_scene_is_read_again_by_itself_within_a_second(walk: "Walk", scene: Path) -> None:
    scene.write_text(scene.read_text().replace("strength: 0.5", "strength: 0.25"))
    for _ in range(10):
        walk.frame(0.1)
    (breeze,) = walk.prairie.scene.wind
    assert breeze.model_dump()["strength"] == 0.25


def test_n7_winds_that_were_set_off_blow_on_through_a_reading(walk: "Walk", scene: Path) -> None:
    strike(walk, "1")
    strike(walk, "2")
    scene.write_text(scene.read_text().replace("strength: 0.5", "strength: 0.25"))
    press(walk, "F5")
    assert winds(walk) == {"breeze", "gust", "whirlwind"}
    for _ in range(200):
        walk.step(0.1)
    assert winds(walk) == {"breeze"}


def test_n7_a_broken_scene_is_told_until_it_is_right_and_the_old_one_goes_on(walk: "Walk", scene: Path) -> None:
    right, old = scene.read_text(), walk.prairie.scene
    scene.write_text(right.replace("eye: 1.7", "eye: low"))
    for _ in range(120):
        walk.step(0.1)
    assert walk.prairie.scene is old
    assert walk.prairie.time > 11.0
    told = seen(walk)
    walk.tell([])
    assert (told != seen(walk)).any(axis=2).mean() > 0.1
    scene.write_text(right.replace("eye: 1.7", "eye: 1.8"))
    for _ in range(10):
        walk.step(0.1)
    assert walk.prairie.scene.camera.eye == 1.8
    for _ in range(100):
        walk.step(0.1)
    silent = seen(walk)
    walk.tell([])
    assert (silent == seen(walk)).all()


def test_n7_of_many_problems_some_are_shown(walk: "Walk", scene: Path) -> None:
    shown: list[list[str]] = []
    walk.tell = lambda lines, **_: shown.append(lines)  # type: ignore[method-assign]
    scene.write_text(scene.read_text() + "".join(f"key{k}: 1\n" for k in range(9)))
    press(walk, "F5")
    (lines,) = shown
    assert [line for line in lines if "unknown key" in line] == [line for line in lines[::3] if ":" in line][:4]
    assert lines[-1] == "and 5 more problems"
