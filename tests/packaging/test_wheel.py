"""What is built is what works: the tests pass against the wheel, where no checkout is in reach."""

import os
import re
import shutil
import subprocess
import sys
import sysconfig
import venv
from pathlib import Path
from zipfile import ZipFile

import pytest

pytestmark = pytest.mark.packaging

ROOT = Path(__file__).parents[2]
SOURCES = ("app", "components", "engine", "scenes", "systems", "testing")
# What an installed package could lack: entry points, scenes, and the kit that others' tests are made of.
INSTALLED = ("conftest.py", "engine/test_plugins.py", "scenes/test_bundled.py", "testing/test_kit.py")
QUICK = "not gl and not window"
PLACE = """
from importlib.util import find_spec
from pathlib import Path

import tallgrass


def test_the_wheel_is_what_is_tested() -> None:
    assert Path(tallgrass.__file__).is_relative_to({site!r})
    assert find_spec("tallgrass.tests") is None
"""


def run(*command: str | Path, cwd: Path) -> str:
    outside = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "PYTEST"))}
    done = subprocess.run(command, cwd=cwd, env=outside, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel, built from the source distribution of a copy: building in place leaves files that get shipped."""
    copy = tmp_path_factory.mktemp("source") / "tallgrass"
    shutil.copytree(
        ROOT, copy, ignore=shutil.ignore_patterns(".*", "__pycache__", "*.egg-info", "build", "dist", "out")
    )
    out = copy.parent / "dist"
    run(sys.executable, "-m", "build", "--no-isolation", "--outdir", out, copy, cwd=copy.parent)
    assert [file.suffix for file in sorted(out.iterdir())] == [".whl", ".gz"]
    return next(out.glob("*.whl"))


@pytest.fixture(scope="module")
def site(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The site folder of an environment that has the wheel, and this one's packages except the editable project."""
    home = tmp_path_factory.mktemp("installed")
    venv.create(home, with_pip=False)
    place = Path(sysconfig.get_path("purelib", "venv", {"base": str(home), "platbase": str(home)}))
    place.joinpath("dependencies.pth").write_text(f"{sysconfig.get_path('purelib')}\n", "utf-8")
    pip = (sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-index")
    run(*pip, "--disable-pip-version-check", "--target", place, wheel, cwd=home)
    return place


def test_the_wheel_holds_every_source_and_nothing_else(wheel: Path) -> None:
    with ZipFile(wheel) as archive:
        shipped = {name for name in archive.namelist() if ".dist-info/" not in name}
    sources = {file for folder in SOURCES for file in (ROOT / folder).rglob("*") if file.is_file()}
    wanted = {f"tallgrass/{file.relative_to(ROOT)}" for file in sources if "__pycache__" not in file.parts}
    assert shipped == wanted | {f"tallgrass/{name}" for name in ("__init__.py", "__main__.py", "py.typed")}


def test_the_tests_pass_against_the_wheel_outside_the_checkout(site: Path, tmp_path: Path) -> None:
    tests = tmp_path / "tests"
    for name in INSTALLED:
        (tests / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / "tests" / name, tests / name)
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    tests.joinpath("test_place.py").write_text(PLACE.format(site=str(site)), "utf-8")
    python = site.parents[2] / "bin" / "python"
    told = run(python, "-P", "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", "-m", QUICK, tests, cwd=tmp_path)
    assert " passed" in told.splitlines()[-1]


def test_d6_the_type_checker_passes_on_the_examples_and_the_tutorial_against_the_wheel(
    site: Path, tmp_path: Path
) -> None:
    """As people have it who write a game: with strict rules, without our configuration and without plugins."""
    python = site.parents[2] / "bin" / "python"
    programs = sorted((ROOT / "examples").rglob("*.py"))
    assert len(programs) >= 5
    names = [path.parent.name + ".py" if path.stem == "__init__" else path.name for path in programs]
    copies = [shutil.copy(path, tmp_path / name) for path, name in zip(programs, names, strict=True)]
    tutorial = "".join((ROOT / "docs" / page).read_text("utf-8") for page in ("first-wind.md", "wind-plugin.md"))
    for name, text in re.findall(
        r"^`(?:[\w-]+/)*(\w+\.py)`:\n\n```python\n(.*?)^```$", tutorial, re.MULTILINE | re.DOTALL
    ):
        (tmp_path / name).write_text(text, "utf-8")
        copies.append(tmp_path / name)
    assert {"ripple.py", "test_ripple.py", "game.py", "rotor.py"} <= {Path(copy).name for copy in copies}
    options = (
        "--strict",
        "--config-file",
        os.devnull,
        "--cache-dir",
        tmp_path / "cache",
        "--python-executable",
        python,
    )
    told = run(sys.executable, "-m", "mypy", *options, *copies, cwd=tmp_path)
    assert f"no issues found in {len(copies)} source files" in told
