"""A prairie in programs without pyglet: with moderngl alone, and with plain GL (D6).

Each is a process of its own, `moderngl_program.py`, whose checks stand here one by one.
"""

import json
import re
import subprocess
import sys
from pathlib import Path

import moderngl
import pytest

from tallgrass.testing import LITTLE

PROGRAM = Path(__file__).with_name("moderngl_program.py")
CHECKS = re.findall(r"^def check_(\w+)", PROGRAM.read_text("utf-8"), re.MULTILINE)

Said = dict[str, str]


def said_by(program: str, scene: Path) -> Said:
    """Return the faults that the program reports, by check."""
    scene.write_text(LITTLE + "wind: [{ kind: breeze, strength: 0.4 }]\nlight: { clouds: 0.4 }\n", "utf-8")
    done = subprocess.run(
        [sys.executable, "-W", "error", PROGRAM, scene, program], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    found: Said = json.loads(done.stdout)
    return found


@pytest.fixture(scope="module")
def said(ctx: moderngl.Context, tmp_path_factory: pytest.TempPathFactory) -> Said:
    """Faults that the program with moderngl reports, by check; skipped without GL."""
    assert ctx.version_code >= 330
    return said_by("moderngl", tmp_path_factory.mktemp("scene") / "scene.yaml")


@pytest.mark.parametrize("name", [*CHECKS, "pyglet"])
def test_d6_a_program_without_pyglet_and_its_prairie_leave_each_other_alone(said: Said, name: str) -> None:
    assert said[name] == ""


def test_d6_a_program_without_moderngl_finds_its_state_as_it_was_from_the_first_frame_on(
    ctx: moderngl.Context, tmp_path: Path
) -> None:
    assert ctx.version_code >= 330
    assert said_by("bare", tmp_path / "scene.yaml") == {"bare": "", "pyglet": ""}
