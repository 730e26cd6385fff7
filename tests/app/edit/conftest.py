"""Fixtures of tests of the panel: a walk with one."""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tallgrass.app.studio.take import Take
from tallgrass.systems.prairie import Prairie

from .driving import SCENE, SIZE, frames

if TYPE_CHECKING:
    from tallgrass.app.edit.window import EditWalk


@pytest.fixture
def walk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator["EditWalk"]:
    """A walk with a panel through a lawn, drawn twice; pyglet checks every GL call."""
    monkeypatch.setenv("PYGLET_DEBUG_GL", "1")
    monkeypatch.chdir(tmp_path)
    from tallgrass.app.display import need_display  # noqa: PLC0415 - there has to be a display first

    need_display()
    from tallgrass.app.edit.window import EditWalk  # noqa: PLC0415
    from tallgrass.app.window import open_window  # noqa: PLC0415

    path = tmp_path / "lawn.yaml"
    path.write_text(SCENE)
    started = EditWalk(open_window(SIZE), Prairie.load(path), Take(str(path), SIZE))
    started.prairie.governor.hold = None
    frames(started, 2)
    yield started
    if not started.closed:
        assert started.ctx.error == "GL_NO_ERROR"
    started.close()
