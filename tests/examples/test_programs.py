"""Example programs: each runs with a display and without, and there is grass in its picture."""

from collections.abc import Callable
from pathlib import Path

import pytest

LONG = {"day", "farm", "lake", "night_drive", "planet", "riding", "split_screen", "village"}
"""Examples that take 2 to 12 s; the other ones draw in all the same ways."""

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*.py"))
Python = Callable[..., str]

LOOK = """
import atexit

import numpy as np
import pyglet

from tallgrass.testing import fixed_clock

pyglet.options.audio = ("silent",)
fixed = fixed_clock()
clock = fixed.__enter__()
flip, begin, seen = pyglet.window.Window.flip, pyglet.window.Window.__init__, []


def small(window, width, height, **more):
    begin(window, width // 4, height // 4, **more)


def look(window):
    shot = pyglet.image.get_buffer_manager().get_color_buffer().get_image_data()
    picture = np.frombuffer(shot.get_data("RGBA", 4 * shot.width), np.uint8).reshape(-1, 4)  # pyglet is slow to convert
    seen.append(len(np.unique(picture[: len(picture) // 3, :3].astype(int) @ (65536, 256, 1))))
    flip(window)


def step():
    clock.tick()
    loop.has_exit = len(seen) == 2
    return 0.0


pyglet.window.Window.flip, pyglet.window.Window.__init__ = look, small
pyglet.window.Window.set_exclusive_mouse = lambda *_: None  # nobody moves the mouse
loop = pyglet.app.event_loop
loop.clock, loop.idle = pyglet.clock.get_default(), step
atexit.register(lambda: print(*seen))
"""
"""Code that plays two frames of a program, prints the number of colours in the lower third of each, and makes pictures
small."""


@pytest.mark.window
@pytest.mark.gl
@pytest.mark.parametrize(
    ("program", "headless"),
    [
        *(
            pytest.param(program, False, marks=pytest.mark.slow if program.stem in LONG else (), id=program.stem)
            for program in EXAMPLES
        ),
        pytest.param(EXAMPLES[0], True, id="headless"),
    ],
)
def test_d6_the_example_runs_and_draws_grass(
    program: Path,
    headless: bool,  # noqa: FBT001
    python: Python,
    little_grass: str,
    display: str,
    tmp_path: Path,
) -> None:
    place = {"PYGLET_HEADLESS": "1", "DISPLAY": ""} if headless else {"DISPLAY": display}
    told = python(tmp_path, str(program), place=place, before=little_grass + LOOK)
    colors = [int(number) for number in told.split()]
    assert len(colors) == 2
    assert min(colors) > 250, "the lower third of the picture has hardly any colours"


def test_d6_no_example_is_longer_than_a_reader_will_read() -> None:
    assert len(EXAMPLES) >= 11
    lines = {program.stem: len(program.read_text("utf-8").splitlines()) for program in EXAMPLES}
    assert {name: count for name, count in lines.items() if count > 220} == {}
