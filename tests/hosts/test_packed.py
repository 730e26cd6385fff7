"""A game packed by PyInstaller has its scenes, its winds, and those of plugins (D5, D6)."""

import os
import re
import shutil
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

pytestmark = pytest.mark.hosts

ROOT = Path(__file__).parents[2]
GAME = """
from tallgrass import Gust, Prairie
from tallgrass.engine.plugins import wind_kinds
from tallgrass.testing import headless_context, stage
with headless_context() as ctx, stage(ctx, (160, 90)) as made:
    prairie = Prairie.load("plain", preset="low", ctx=ctx)
    prairie.add(Gust(start=0.0))
    prairie.add(wind_kinds().find("draught")())
    prairie.advance(2.0)
    print(made.shot(prairie).mean().round(3), prairie.wind_at([(0, 0)]).round(4).tolist(), wind_kinds().names())
"""
DRAUGHT = """
from pathlib import Path
from typing import Literal
from tallgrass import Breeze
class Draught(Breeze):
    kind: Literal["draught"] = "draught"
    strength: float = float(Path(__file__).with_name("strength.txt").read_text("utf-8"))
"""
METADATA = "Metadata-Version: 2.1\nName: tallgrass-draught\nVersion: 0.1\n"


def test_d6_a_packed_game_prints_what_python_prints(
    run: Callable[..., str], hosts_python: Path, tmp_path: Path
) -> None:
    copy, site = tmp_path / "sources", tmp_path / "site"
    ignored = shutil.ignore_patterns(".*", "__pycache__", "*.egg-info", "build", "dist", "out")
    shutil.copytree(ROOT, copy, ignore=ignored)
    pip = (sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-build-isolation", "--no-index")
    run(*pip, "--disable-pip-version-check", "--target", site, copy)
    (site / "tallgrass_draught").mkdir()
    (site / "tallgrass_draught" / "__init__.py").write_text(DRAUGHT, "utf-8")
    (site / "tallgrass_draught" / "strength.txt").write_text("0.3", "utf-8")
    info = site / "tallgrass_draught-0.1.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(METADATA, "utf-8")
    (info / "entry_points.txt").write_text("[tallgrass.wind]\ndraught = tallgrass_draught:Draught\n", "utf-8")
    (tmp_path / "game.py").write_text(GAME, "utf-8")
    run(hosts_python, "-c", "import sys, importlib.util as u; sys.exit(0 if u.find_spec('PyInstaller') else "
        "print('No module named PyInstaller', file=sys.stderr) or 77)")  # fmt: skip
    place = {"PYTHONPATH": str(site), "TALLGRASS_CACHE": str(tmp_path / "cache")}
    expected = run(hosts_python, "game.py", cwd=tmp_path, **place)
    run(hosts_python, "-m", "PyInstaller", "--noconfirm", "--onedir", "game.py", cwd=tmp_path, **place)
    found = run(tmp_path / "dist" / "game" / "game", cwd=tmp_path, TALLGRASS_CACHE=os.devnull)
    assert re.search(r"'draught'.*'gust'", expected)
    assert found == expected
