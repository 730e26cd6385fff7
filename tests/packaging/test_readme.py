"""What the README shows works as it stands there."""

import re
import subprocess
import sys
from pathlib import Path

import pytest
import typer

import tallgrass
from tallgrass.app.cli import app
from tallgrass.engine.scene import parse_scene

pytestmark = pytest.mark.packaging

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text("utf-8")


def block(language: str) -> str:
    (found,) = re.findall(rf"^```{language}\n(.*?)^```$", README, re.MULTILINE | re.DOTALL)
    return str(found)


def test_the_scene_is_valid_and_says_what_it_seems_to() -> None:
    scene = parse_scene(block("yaml"))
    assert scene.grass["feather"].height == [0.6, 1.0]
    assert [wind.kind for wind in scene.wind] == ["breeze"]


def test_the_program_uses_only_what_the_face_offers() -> None:
    program = block("python")
    compile(program, "README.md", "exec")
    (imported,) = re.findall(r"^from tallgrass import (\w+)$", program, re.MULTILINE)
    face = getattr(tallgrass, imported)
    used = set(re.findall(r"prairie\.(\w+)", README)) | set(re.findall(r"Prairie\.(\w+)", program))
    assert {name for name in used if not hasattr(face, name)} == set()


@pytest.mark.window
def test_the_program_runs_and_draws_grass(tmp_path: Path) -> None:
    seen = """
def look(dt):
    picture = pyglet.image.get_buffer_manager().get_color_buffer().get_image_data().get_data("RGB", 3 * window.width)
    print(len(set(zip(*[iter(picture[: len(picture) // 3])] * 3))))
    pyglet.app.exit()

pyglet.clock.schedule_once(look, 0.5)
"""
    program = block("python").replace("1280, 720", "320, 180").replace("pyglet.app.run()", f"{seen}\npyglet.app.run()")
    (tmp_path / "game.py").write_text(program, "utf-8")
    done = subprocess.run([sys.executable, "game.py"], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert int(done.stdout) > 1000, "the lower third of the picture has hardly any colours"


def test_every_command_is_in_the_table() -> None:
    told = set(re.findall(r"^\| `tallgrass (\w+)", README, re.MULTILINE))
    assert told == set(typer.main.get_command(app).commands)  # type: ignore[attr-defined]


def test_every_file_that_is_linked_exists() -> None:
    for page in ("README.md", "CONVENTIONS.md", "CHANGELOG.md"):
        for target in re.findall(r"\]\(([^)#]+)\)", (ROOT / page).read_text("utf-8")):
            assert target.startswith("https://") or (ROOT / target).is_file(), f"{page} links to {target}"
