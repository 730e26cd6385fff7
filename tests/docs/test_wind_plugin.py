"""The tutorial on wind plugins, followed in an environment of its own, ends in a plugin that works.

It is followed to the letter, except that the grass of its picture is coarser.
"""

import os
import re
import subprocess
import sys
import sysconfig
import venv
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from tallgrass.components.wind import INTERFACE, WindPrimitive
from tallgrass.engine.installed import OURS
from tallgrass.engine.plugins import wind_kinds
from tallgrass.engine.schedule import PATIENCE, WINDOW
from tallgrass.systems.wind.quarantine import STALLED
from tallgrass.testing.winds import MOST_COST

pytestmark = pytest.mark.packaging

DOCS = Path(__file__).parents[2] / "docs"
TEXT, RULES = ((DOCS / page).read_text("utf-8") for page in ("first-wind.md", "wind-plugin.md"))
BLOCK = re.compile(r"(?:^`(?P<file>[^`\n]+)`:\n\n)?^```(?P<language>\w+)\n(?P<text>.*?)^```$", re.MULTILINE | re.DOTALL)
PROGRAMS = {
    "pip": '-m pip "$@" --quiet --no-deps --no-index --no-build-isolation --disable-pip-version-check',
    "pytest": '-m pytest -p no:cacheprovider "$@"',
    "tallgrass": '-m tallgrass.app.cli "$@"',
}


@pytest.fixture(scope="module")
def programs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder of programs of an environment that has this one's packages, and may get more of its own."""
    home = tmp_path_factory.mktemp("environment")
    venv.create(home, with_pip=False)
    place = Path(sysconfig.get_path("purelib", "venv", {"base": str(home), "platbase": str(home)}))
    place.joinpath("all.pth").write_text(f"import site; site.addsitedir({sysconfig.get_path('purelib')!r})\n", "utf-8")
    for name, arguments in PROGRAMS.items():
        program = home / "bin" / name
        program.write_text(f'#!/bin/sh\nexec "{home}/bin/python" {arguments}\n', "utf-8")
        program.chmod(0o755)
    return home / "bin"


def run(lines: str, programs: Path, folder: Path) -> str:
    """Run lines of a shell in a folder, and return what they print."""
    place = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "PYTEST"))}
    place |= {"PATH": f"{programs}:{place['PATH']}"}
    done = subprocess.run(
        ["/bin/sh", "-e", "-c", lines], cwd=folder, env=place, capture_output=True, text=True, timeout=300, check=False
    )
    assert done.returncode == 0, f"{lines}\n{done.stdout}{done.stderr}"
    return done.stdout


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="the tutorial is written for a POSIX shell")
@pytest.mark.usefixtures("ctx")
def test_d5_following_the_tutorial_alone_ends_in_a_plugin_that_works(programs: Path, tmp_path: Path) -> None:
    blocks = list(BLOCK.finditer(TEXT))
    for number, block in enumerate(blocks):
        if block["file"]:
            (tmp_path / block["file"]).write_text(block["text"], "utf-8")
        if block["language"] == "sh":
            told = run(block["text"].replace("--size", "--preset low --size"), programs, tmp_path)
            after = blocks[number + 1] if number + 1 < len(blocks) else block
            if after["language"] == "text":
                assert after["text"].strip() in told
    with Image.open(tmp_path / "ripple.png") as picture:
        assert picture.size == (640, 360)
        assert np.asarray(picture.convert("RGB")).std() > 5.0


def test_every_block_of_the_tutorial_is_a_file_or_is_run() -> None:
    blocks = list(BLOCK.finditer(TEXT))
    assert len(blocks) == TEXT.count("\n```") // 2
    for block in blocks:
        assert block["file"] or block["language"] in {"sh", "text"}
    assert {"sh", "text", "toml", "python", "yaml"} == {block["language"] for block in blocks}


def test_the_plugin_is_as_short_as_it_is_said_to_be() -> None:
    files = {block["file"]: block["text"].splitlines() for block in BLOCK.finditer(TEXT) if block["file"]}
    assert len(files["tallgrass-ripple/ripple.py"]) <= 40
    assert len(files["tallgrass-ripple/pyproject.toml"]) == 6


def test_the_page_tells_of_every_method_and_field_of_a_wind_and_of_no_other_number() -> None:
    own = {name: value for name, value in vars(WindPrimitive).items() if not name.startswith(("_", "model_"))}
    methods = {name for name, value in own.items() if callable(value)}
    told = set(re.findall(r"`(\w+)(?:\([^`]*\))?`", RULES))
    assert methods | set(WindPrimitive.model_fields) <= told
    assert f"`interface = {INTERFACE}`" in RULES
    assert f"10,000 must take less than {1000 * MOST_COST:g} ms" in " ".join(RULES.split())
    assert (PATIENCE, WINDOW, STALLED) == (3, 16, 3.0), "the page tells of these in words"


def test_the_priorities_on_the_page_are_those_of_the_winds_that_come_along() -> None:
    kinds = [row.name for row in wind_kinds().provided() if row.distribution == OURS]
    told = re.findall(r"^\| `(\w+)` \| (\d+) \|$", RULES, re.MULTILINE)
    assert {kind: int(priority) for kind, priority in told} == {
        kind: wind_kinds().find(kind).model_fields["priority"].default for kind in kinds
    }
