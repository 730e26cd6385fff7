"""The example plugin, installed by pip or added by decorator, is a kind of wind in scene files."""

import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

pytestmark = pytest.mark.packaging

EXAMPLE = Path(__file__).parents[2] / "examples" / "vortex-street"

FELT = """
import sys
import numpy as np
from tallgrass import Prairie

prairie = Prairie.load(sys.argv[1])
street = prairie.scene.wind[1]
assert type(street).__module__ == "vortex_street", type(street)
x, z = np.meshgrid(np.linspace(-12, 14, 60), np.linspace(-1, 9, 30))
felt = prairie.wind_at(np.stack([x, z], -1).reshape(-1, 2), 9.0)
assert not prairie.winds.quarantine.reasons
print(*(int(count) for count in ((felt[:, 0] > 0.5).sum(), (felt[:, 0] < -0.3).sum(), (abs(felt[:, 1]) > 0.3).sum())))
"""
DECORATED = f"""
import tallgrass, vortex_street

tallgrass.wind("vortex-street")(vortex_street.VortexStreet)
{FELT}
"""

Run = Callable[..., str]


@pytest.fixture
def run(tmp_path: Path) -> Run:
    """Run a program of Python in a process of its own, which also looks for modules in one more folder."""

    def at(path: Path, *arguments: object) -> str:
        place = os.environ | {"PYTHONPATH": str(path)}
        command = [sys.executable, "-P", *map(str, arguments)]
        done = subprocess.run(command, cwd=tmp_path, env=place, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    return at


@pytest.fixture
def site(tmp_path: Path, run: Run) -> Path:
    """Folder in which the example is installed; it is built from a copy, which leaves no files in the checkout."""
    source = shutil.copytree(EXAMPLE, tmp_path / "source", ignore=shutil.ignore_patterns("__pycache__", "build", ".*"))
    place = tmp_path / "site"
    pip = ("-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-deps", "--no-index")
    run(tmp_path, *pip, "--no-build-isolation", "--target", place, source)
    return place


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    """Path of the example's scene, with grass that grows in a moment."""
    path = tmp_path / "scene.yaml"
    path.write_text((EXAMPLE / "scene.yaml").read_text("utf-8").replace("quality: ultra", "quality: low"), "utf-8")
    return path


@pytest.mark.slow
def test_d5_the_installed_example_is_a_kind_of_scene_files(run: Run, site: Path, scene: Path) -> None:
    assert "vortex-street  tallgrass-vortex-street  0.1.0    ready" in run(
        site, "-m", "tallgrass.app.cli", "plugins", "list"
    )
    assert run(site, "-m", "tallgrass.app.cli", "plugins", "check", "vortex-street") == "vortex-street: ok\n"
    ahead, back, aside = map(int, run(site, "-c", FELT, scene).split())
    assert min(ahead, back, aside) > 30, "whirls blow every way"


def test_d5_the_same_class_works_by_decorator(run: Run, scene: Path) -> None:
    assert len(run(EXAMPLE, "-c", DECORATED, scene).split()) == 3


@pytest.mark.slow
def test_the_examples_own_tests_pass(run: Run, site: Path) -> None:
    told = run(site, "-m", "pytest", "-q", "-p", "no:cacheprovider", EXAMPLE / "tests")
    assert "4 passed" in told


def test_an_example_is_as_short_as_a_plugin_may_be() -> None:
    (module,) = EXAMPLE.glob("vortex_street/*.py")
    assert len(module.read_text("utf-8").splitlines()) <= 49, "40 without its phases and what its twin reads"
