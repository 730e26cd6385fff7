"""Everything here runs in processes of its own, by `./dev hosts`: other people's programs, drivers and packers."""

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from tallgrass.testing import LITTLE

ROOT = Path(__file__).parents[2]
LACKS = 77
"""How a program ends that lacks a library."""

Run = Callable[..., str]


@pytest.fixture(scope="session")
def scene(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A little scene in the wind."""
    path = tmp_path_factory.mktemp("scene") / "scene.yaml"
    path.write_text(LITTLE + "wind: [{ kind: breeze, strength: 0.4 }]\n", "utf-8")
    return path


@pytest.fixture(scope="session")
def hosts_python() -> Path:
    """The Python that has other people's libraries: that of `.venv-hosts`, where there is one, or else this one."""
    found = ROOT / ".venv-hosts" / "bin" / "python"
    return found if found.exists() else Path(sys.executable)


@pytest.fixture(scope="session")
def next_python() -> Path:
    """The Python that has pre-releases of pyglet and Arcade: that of `.venv-next`."""
    found = ROOT / ".venv-next" / "bin" / "python"
    if not found.exists():
        pytest.skip("no .venv-next: ./dev hosts makes it")
    return found


@pytest.fixture(scope="session")
def run() -> Run:
    """Run a command and return what it prints; a test is skipped in one line where a library is not there."""

    def command(*words: str | Path, cwd: Path | None = None, **place: str) -> str:
        done = subprocess.run(
            words, cwd=cwd, env=os.environ | place, capture_output=True, text=True, check=False, timeout=600
        )
        if done.returncode == LACKS:
            pytest.skip(f"{done.stderr.strip().splitlines()[-1]}: ./dev hosts installs it")
        assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-4000:]
        return done.stdout

    return command
