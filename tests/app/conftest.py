"""Fixtures of tests of the commands: a small scene, the command as people run it, and a walk."""

import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tallgrass.app.studio.take import Take
from tallgrass.engine.declared.quality import PRESETS, BladeRing, Quality, StripRing
from tallgrass.systems.prairie import Prairie

from .walking import SIZE

if TYPE_CHECKING:
    from tallgrass.app.window import Walk

SCENE = """\
tallgrass: 2
seed: 5
terrain: { noise: rolling, size: [60, 60], scale: 3 }
grass:
  green: { height: [0.3, 0.5] }
wind:
  - { kind: breeze, strength: 0.5 }
camera:
  position: [0, 20]
  eye: 1.7
  pitch: -25
  path:
    - { at: 0, position: [0, 20], pitch: -25 }
    - { at: 1.5, position: [2, 10], pitch: -25, yaw: 30 }
quality:
  patch: 2.5
  blades: 40
  models: 1
  blade_rings: [{ to: 1, segments: 2 }]
  strip_rings: [{ to: 3, strips: 2, columns: 1, sections: 1, texel: 0.02 }]
  carpet_to: 10
  carpet: 16
"""

Tallgrass = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    """File of a small scene that grows in a moment."""
    path = tmp_path / "little.yaml"
    path.write_text(SCENE)
    return path


@pytest.fixture
def tallgrass(tmp_path: Path) -> Tallgrass:
    """Return the function that runs the command in a folder and a process of its own: it takes the GL context."""

    def run(*arguments: object) -> subprocess.CompletedProcess[str]:
        words = [sys.executable, "-W", "error", "-m", "tallgrass.app.cli", *map(str, arguments)]
        return subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, timeout=120, check=False)

    return run


@pytest.fixture
def _coarse(monkeypatch: pytest.MonkeyPatch) -> None:
    """Make all presets grow in a moment; those with `high` in their names have twice the blades."""
    rings = [StripRing(to=5, strips=2, columns=1, sections=1, texel=0.03)]
    blades = [BladeRing(to=2, segments=2)]
    for name in PRESETS:
        count = 60 if "high" in name else 30
        coarse = Quality(blades=count, models=1, blade_rings=blades, strip_rings=rings, carpet_to=12, carpet=8)
        monkeypatch.setitem(PRESETS, name, coarse)


@pytest.fixture
def walk(scene: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator["Walk"]:
    """Walk through the small scene, drawn once; pyglet checks every GL call."""
    monkeypatch.setenv("PYGLET_DEBUG_GL", "1")
    monkeypatch.chdir(scene.parent)
    from tallgrass.app.display import need_display  # noqa: PLC0415 - there has to be a display first

    need_display()
    from tallgrass.app.window import Walk, open_window  # noqa: PLC0415

    started = Walk(open_window(SIZE), Prairie.load(scene), Take(str(scene), SIZE))
    started.frame(1 / 60)
    yield started
    if not started.closed:
        assert started.ctx.error == "GL_NO_ERROR"
    started.close()
