"""A pyglet game with a prairie in it, on a display and without one, on the oldest OpenGL and a newer one (D6).

Each run is a process of its own, `host_program`; here is one test for each of its checks.
`TALLGRASS_ROUNDS` is the number of times that it loads and releases a prairie.
"""

import json
import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from tallgrass.testing import LITTLE

SCENE = LITTLE + "wind: [{ kind: breeze, strength: 0.4 }]\n"
PROGRAM = Path(__file__).with_name("host_program")
CHECKS = [
    check
    for file in PROGRAM.glob("*.py")
    for check in re.findall(r"^def check_(\w+)", file.read_text("utf-8"), re.MULTILINE)
]
ROUNDS = os.environ.get("TALLGRASS_ROUNDS", "3")
pytestmark = [pytest.mark.window, pytest.mark.gl]


@pytest.mark.parametrize(
    ("headless", "version"),
    [
        pytest.param(False, "3.3", id="display-3.3"),
        pytest.param(True, "4.1", id="headless-4.1", marks=pytest.mark.slow),
    ],
)
def test_d6_a_game_and_its_prairie_leave_each_other_alone(
    headless: bool,  # noqa: FBT001
    version: str,
    python: Callable[..., str],
    display: str,
    tmp_path: Path,
) -> None:
    (tmp_path / "scene.yaml").write_text(SCENE, "utf-8")
    shading = {"3.3": "330", "4.1": "410"}[version]
    place = {"MESA_GL_VERSION_OVERRIDE": f"{version}FC", "MESA_GLSL_VERSION_OVERRIDE": shading}
    place |= {"PYGLET_HEADLESS": "1", "DISPLAY": ""} if headless else {"PYGLET_HEADLESS": "", "DISPLAY": display}
    program = tmp_path / "program.py"
    program.write_text(f"import runpy; runpy.run_module({PROGRAM.name!r}, run_name='__main__')\n", "utf-8")
    before = f"sys.path.insert(0, {str(PROGRAM.parent)!r})"
    told = python(tmp_path, str(program), str(tmp_path / "scene.yaml"), ROUNDS, place=place, before=before)
    said = json.loads(told.splitlines()[-1])
    assert said.pop("version") == version
    assert said.keys() == set(CHECKS)
    assert {name: found for name, found in said.items() if found} == {}


ALONE = """
import sys
from pathlib import Path
import pyglet
from tallgrass import Prairie
from tallgrass.engine.camera import camera_at, projection_matrix, view_matrix

pyglet.options.shadow_window = len(sys.argv) > 2
prairie = Prairie.load(sys.argv[1], live=False, lod="strips")
camera = camera_at(prairie.scene.camera, None, prairie.height_at)


def draw():
    try:
        prairie.draw(view_matrix(camera), projection_matrix(camera.view, 1.5))
    except RuntimeError as error:
        print(error)
    else:
        picture = pyglet.image.get_buffer_manager().get_color_buffer().get_image_data().get_data("RGB")
        print(len(set(picture)), hash(bytes(picture)))


draw()
for _ in range(2):
    window = pyglet.window.Window(150, 100)
    window.clear()
    draw()
    window.close()
    draw()
prairie.release()
"""


@pytest.mark.parametrize("hidden", [[], ["hidden"]], ids=["without", "with"])
def test_d6_with_pyglets_hidden_window_and_without_windows_may_come_and_go(tmp_path: Path, hidden: list[str]) -> None:
    (tmp_path / "scene.yaml").write_text(SCENE, "utf-8")
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", ALONE, tmp_path / "scene.yaml", *hidden],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    before, first, closed, second, again = done.stdout.splitlines()
    assert re.match(r"there is no GL context \(.*\): create the window before the prairie is first drawn", before)
    assert closed == again == "there is no window any more: create another one before the prairie is drawn again"
    assert first == second
    assert int(first.split()[0]) > 100
