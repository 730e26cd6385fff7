"""The README's programs, scene and commands work."""

import re
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import typer

import tallgrass
from tallgrass.app.cli import app
from tallgrass.engine.declared.grass import GrassKind
from tallgrass.engine.declared.quality import PRESETS
from tallgrass.engine.scene import parse_scene
from tallgrass.systems.stock import models
from tallgrass.testing import Phase, looking, private_world, receivers_of, step, watch

pytestmark = pytest.mark.packaging

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text("utf-8")


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```$", README, re.MULTILINE | re.DOTALL)


GAME, WINDS, SYSTEM = blocks("python")
(SCENE,) = blocks("yaml")


def test_the_scene_is_valid_and_says_what_it_seems_to() -> None:
    scene = parse_scene(SCENE)
    assert scene.grass["feather"].height == [0.6, 1.0]
    assert [wind.kind for wind in scene.wind] == ["breeze", "gust"]


def test_the_programs_use_only_what_the_face_offers() -> None:
    for program in (GAME, WINDS, SYSTEM):
        compile(program, "README.md", "exec")
        (imported,) = re.findall(r"^from tallgrass import (.+)$", program, re.MULTILINE)
        assert set(imported.split(", ")) <= set(tallgrass.__all__)
    used = re.findall(r"[pP]rairie\.(\w+)", README)
    kinds = tallgrass.Prairie.__mro__
    face = {*dir(tallgrass.Prairie), *(name for kind in kinds for name in getattr(kind, "__annotations__", ()))}
    assert set(used) - face == set()


@pytest.fixture(autouse=True)
def _little_grass(monkeypatch: pytest.MonkeyPatch) -> None:
    """Make all presets grow in a moment, and all grass bend alike."""
    little = PRESETS["low"].model_copy(update={"blades": 40, "models": 1, "carpet": 16})
    mechanics, postures = models.mechanics_of(GrassKind()), models._postures  # noqa: SLF001
    monkeypatch.setattr(models, "mechanics_of", lambda _: mechanics)
    monkeypatch.setattr(models, "_postures", lambda *_: postures(mechanics, 0))
    for preset in PRESETS:
        monkeypatch.setitem(PRESETS, preset, little)


def test_the_winds_that_a_game_sets_off_are_felt() -> None:
    told: dict[str, Any] = {}
    exec(WINDS, told)  # noqa: S102 - it is our own page
    prairie = told["prairie"]
    under, front = [(2.0, 11.0)], [(-26.0, 0.0)]
    blown = prairie.wind_at(under, 1.0)
    prairie.remove(told["blast"])
    assert abs(blown - prairie.wind_at(under, 1.0)).max() > 0.05
    assert abs(prairie.wind_at(front, 1.0)).max() > abs(prairie.wind_at(front, 30.0)).max() + 0.1
    prairie.release()


def test_n10_the_system_that_a_game_adds_bends_the_grass() -> None:
    told: dict[str, Any] = {}
    with private_world():
        exec(SYSTEM, told)  # noqa: S102 - it is our own page
        prairie = told["prairie"]
        eye = float(prairie.height_at([(0, 30)])[0]) + 1.7
        for _ in range(3):  # a few entities are made in each frame
            watch(prairie, looking(0.0, eye, 30.0))
            step(prairie, Phase.BLOW)
        under = receivers_of(prairie).near(0.0, 26.0, within=0.9)
        assert len(under) > 10
        assert np.allclose(under.message, (0.9, 0.0))
        prairie.release()


@pytest.mark.window
def test_the_program_runs_and_draws_grass(
    tmp_path: Path, python: Callable[..., str], little_grass: str, display: str
) -> None:
    seen = """
def look(dt):
    picture = pyglet.image.get_buffer_manager().get_color_buffer().get_image_data().get_data("RGB", 3 * window.width)
    print(len(set(zip(*[iter(picture[: len(picture) // 3])] * 3))))
    pyglet.app.exit()

pyglet.clock.schedule_once(look, 0.5)
"""
    program = GAME.replace("1280, 720", "320, 180").replace("pyglet.app.run()", f"{seen}\npyglet.app.run()")
    (tmp_path / "game.py").write_text(program, "utf-8")
    told = python(tmp_path, "game.py", place={"DISPLAY": display}, before=little_grass)
    assert int(told) > 1000, "the lower third of the picture has hardly any colours"


def test_every_command_is_in_the_table() -> None:
    told = set(re.findall(r"^\| `tallgrass (\w+)", README, re.MULTILINE))
    assert told == set(typer.main.get_command(app).commands)  # type: ignore[attr-defined]


def test_what_an_index_shows_links_to_no_file_and_has_the_program_of_the_readme() -> None:
    shown = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["readme"]
    text = (ROOT / shown).read_text("utf-8")
    targets = re.findall(r"\]\(([^)]+)\)", text)
    assert [target for target in targets if not target.startswith("https://")] == []
    (program,) = re.findall(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    assert program in README
    assert set(re.findall(r"^tallgrass (\w+)", text, re.MULTILINE)) <= set(typer.main.get_command(app).commands)  # type: ignore[attr-defined]


def test_every_file_that_is_linked_exists() -> None:
    for page in ("README.md", "CONVENTIONS.md", "CHANGELOG.md"):
        for target in re.findall(r"\]\(([^)#]+)\)", (ROOT / page).read_text("utf-8")):
            assert target.startswith("https://") or (ROOT / target).is_file(), f"{page} links to {target}"
