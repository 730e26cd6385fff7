"""The panel, opened by `tallgrass walk --edit`."""

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

pytest.importorskip("imgui_bundle", reason="the panel is drawn by imgui-bundle, of the extra 'edit'")


@pytest.mark.window
def test_walk_edit_opens_a_window_with_a_panel_closes_by_itself_and_writes_nothing(
    tallgrass: Callable[..., subprocess.CompletedProcess[str]], scene: Path
) -> None:
    before = scene.read_text()
    done = tallgrass("walk", scene, "--edit", "--size", "400x300", "--seconds", 0.5)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert scene.read_text() == before
