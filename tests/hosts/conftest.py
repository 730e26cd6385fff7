"""Fixtures of `./dev hosts`, which runs other people's programs, drivers and packers in processes of their own."""

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from tallgrass.testing import LITTLE

ROOT = Path(__file__).parents[2]
LACKS = 77
"""Exit status of a program that lacks a library."""

Run = Callable[..., str]


@pytest.fixture(scope="session")
def scene(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """File of a little scene with wind."""
    path = tmp_path_factory.mktemp("scene") / "scene.yaml"
    path.write_text(LITTLE + "wind: [{ kind: breeze, strength: 0.4 }]\n", "utf-8")
    return path


@pytest.fixture(scope="session")
def hosts_python() -> Path:
    """Path of the Python that has other people's libraries: of `.venv-hosts` if there is one, else of this process."""
    found = ROOT / ".venv-hosts" / "bin" / "python"
    return found if found.exists() else Path(sys.executable)


@pytest.fixture(scope="session")
def next_python() -> Path:
    """Path of the Python that has pre-releases of pyglet and Arcade, of `.venv-next`."""
    found = ROOT / ".venv-next" / "bin" / "python"
    if not found.exists():
        pytest.skip("no .venv-next: ./dev hosts makes it")
    return found


@pytest.fixture(scope="session")
def run() -> Run:
    """Return the function that runs a command and returns its output; it skips the test where a library is missing."""

    def command(*words: str | Path, cwd: Path | None = None, **place: str) -> str:
        done = subprocess.run(
            words, cwd=cwd, env=os.environ | place, capture_output=True, text=True, check=False, timeout=600
        )
        if done.returncode == LACKS:
            pytest.skip(f"{done.stderr.strip().splitlines()[-1]}: ./dev hosts installs it")
        assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-4000:]
        return done.stdout

    return command
