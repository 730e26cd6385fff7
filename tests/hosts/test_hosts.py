"""A prairie in the windows of other libraries: their own drawing stays the same, byte for byte (D6)."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest

pytestmark = [pytest.mark.hosts, pytest.mark.window]


@pytest.mark.parametrize("library", ["arcade", "moderngl-window", "pygame-ce", "glfw", "PySide6", "pyglet"])
def test_d6_what_others_draw_stays_as_it_is(
    run: Callable[..., str], hosts_python: Path, scene: Path, library: str
) -> None:
    program = Path(__file__).with_name("host_programs.py")
    said = run(hosts_python, program, library, scene, QT_QPA_PLATFORM="offscreen", LIBGL_ALWAYS_SOFTWARE="1")
    assert json.loads(said.splitlines()[-1]) == ""


@pytest.mark.parametrize("library", ["arcade", "pyglet"])
def test_d6_pyglet_3_and_arcade_4_draw_it_before_they_are_released(
    run: Callable[..., str], next_python: Path, scene: Path, library: str
) -> None:
    program = Path(__file__).with_name("host_programs.py")
    said = run(next_python, program, library, scene, LIBGL_ALWAYS_SOFTWARE="1")
    assert json.loads(said.splitlines()[-1]) == ""
