"""A prairie in a program with several GL contexts, and in those that will not do (D6).

The program is a process of its own, `contexts_program.py`, whose checks stand here one by one.
"""

import json
import re
from collections.abc import Callable
from pathlib import Path

import moderngl
import pytest

from tallgrass.testing import LITTLE

PROGRAM = Path(__file__).with_name("contexts_program.py")
CHECKS = re.findall(r"^def check_(\w+)", PROGRAM.read_text("utf-8"), re.MULTILINE)
LACKING = "-GL_ARB_ES2_compatibility"
"""What drivers of 3.3 to 4.0 may lack: who asks for its limits there leaves an error, which pyglet raises later."""

Said = dict[str, str]


@pytest.fixture(scope="module")
def said(ctx: moderngl.Context, tmp_path_factory: pytest.TempPathFactory, python: Callable[..., str]) -> Said:
    """Faults that the program reports, by check; skipped without GL."""
    assert ctx.version_code >= 330
    scene = tmp_path_factory.mktemp("scene") / "scene.yaml"
    scene.write_text(LITTLE + "wind: [{ kind: breeze, strength: 0.4 }]\n", "utf-8")
    told = python(scene.parent, str(PROGRAM), str(scene), place={"MESA_EXTENSION_OVERRIDE": LACKING})
    found: Said = json.loads(told.splitlines()[-1])
    return found


@pytest.mark.parametrize("name", CHECKS)
def test_d6_a_prairie_is_drawn_the_same_in_every_context(said: Said, name: str) -> None:
    assert said[name] == ""
