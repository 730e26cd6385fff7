"""Nothing that is filmed depends on how busy the machine is."""

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

pytestmark = pytest.mark.gl

Film = Callable[..., tuple[list[bytes], list[str]]]

PROGRAM = """
import sys
from time import thread_time

import numpy as np

from tallgrass import WindPrimitive, wind
from tallgrass.app.cli import run

SECONDS = float(sys.argv[1])


@wind("ponderous")
class Ponderous(WindPrimitive):
    kind: str = "ponderous"

    def mask(self, place, /, *, time):
        return np.clip(1.0 - 0.05 * np.abs(place[:, 0] - time), 0.0, 1.0)

    def action(self, place, /, *, time, seed, grass):
        end = thread_time() + SECONDS
        while thread_time() < end:
            pass
        return np.full_like(place, [0.4, 0.2])


sys.exit(run(sys.argv[2:]))
"""
"""The command, and a game's own wind that keeps the processor busy for some seconds in every call."""


WINDS = """\
  - { kind: gust, position: [-20, 0], every: [1, 2] }
  - { kind: ponderous, weight: 0.5 }
mixing: weight
"""


@contextmanager
def every_core_busy() -> Iterator[None]:
    """Keep every core busy."""
    words = [sys.executable, "-c", "while True: pass"]
    busy = [subprocess.Popen(words) for _ in range(os.cpu_count() or 1)]
    try:
        yield
    finally:
        for one in busy:
            one.kill()
            one.wait()


@pytest.fixture
def film(scene: Path, python: Callable[..., str]) -> Film:
    """Return the function that makes a film in a process of its own, with bundled winds and the ponderous one.

    `film(folder, seconds=)` returns its pictures, and the messages about its winds.
    """
    scene.write_text(scene.read_text().replace("\ncamera:", f"\n{WINDS}camera:"))
    scene.with_name("program.py").write_text(PROGRAM)

    def made(folder: str, *, seconds: float) -> tuple[list[bytes], list[str]]:
        options = ["--frames", "1:4", "--fps", "4", "--size", "160x90"]
        said = python(
            scene.parent, "program.py", str(seconds), "film", scene.name, "-o", f"{folder}/", *options, place={}
        )
        return [path.read_bytes() for path in sorted((scene.parent / folder).iterdir())], said.splitlines()

    return made


@pytest.mark.slow
def test_n5_a_film_on_a_busy_machine_and_with_a_slow_wind_is_the_film_and_a_line_tells_of_the_wind(film: Film) -> None:
    alone, nothing = film("alone", seconds=0.0)
    assert len(set(alone)) == 3
    assert nothing == []
    with every_core_busy():
        assert film("busy", seconds=0.06)[0] == alone
    slow, (told,) = film("slow", seconds=0.12)
    assert slow == alone
    assert told.startswith("wind[2] ponderous of __main__.Ponderous: action takes too long: 1")
    assert told.endswith(" ms of processor time")
