"""The built wheel works: tests pass against it, without the checkout."""

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
    """Path of the wheel, built from a copy's source distribution: building in place leaves files that get shipped."""
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
    """Site folder of an environment that has the wheel, and this one's packages except the editable project."""
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


@pytest.mark.slow
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


@pytest.mark.slow
def test_d6_the_type_checker_passes_on_the_examples_and_the_tutorial_against_the_wheel(
    site: Path, tmp_path: Path
) -> None:
    """As in a game's project: with strict rules, without this project's configuration and plugins."""
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
    for what, name in (("game", "my-walk"), ("wind", "my-gale")):
        run(sys.executable, "-m", "tallgrass", "new", what, name, cwd=tmp_path)
        assert "no issues found" in run(sys.executable, "-m", "mypy", *options, name, cwd=tmp_path)


OBEYING = """
import ctypes, os, sys
for power in (1, 2, 3):  # what lets root write where nobody may: CAP_DAC_OVERRIDE, CAP_DAC_READ_SEARCH, CAP_FOWNER
    ctypes.CDLL(None).prctl(24, power, 0, 0, 0)  # PR_CAPBSET_DROP
os.execv(sys.executable, [sys.executable, *sys.argv[1:]])
"""
LOCKED = """
from pathlib import Path
import yaml
import tallgrass
from tallgrass import Gust, Prairie
from tallgrass.testing import LITTLE, headless_context, stage
try:
    Path(tallgrass.__file__).with_name("note").touch()
except OSError:
    print("locked")
with headless_context() as ctx, stage(ctx, (64, 36)) as made:
    prairie = Prairie.load(yaml.safe_load(LITTLE), ctx=ctx, lod="carpet", live=False)
    prairie.add(Gust(start=0.0))
    prairie.advance(2.0)
    print(made.shot(prairie).std() > 1.0, len(Prairie.load("plain", preset="low").scene.grass))
"""


@pytest.mark.slow
@pytest.mark.gl
@pytest.mark.skipif(sys.platform != "linux", reason="root obeys nobody elsewhere")
def test_d6_where_nothing_can_be_written_and_nobody_has_a_home_one_line_says_so_and_all_works(
    wheel: Path, tmp_path: Path
) -> None:
    place, cache = tmp_path / "place", tmp_path / "cache"
    pip = (sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-index", "--no-compile")
    run(*pip, "--disable-pip-version-check", "--target", place, wheel, cwd=tmp_path)
    cache.mkdir()
    before = sorted(place.rglob("*"))
    for path in (*before, place, cache):
        path.chmod(path.stat().st_mode & ~0o222)
    environment = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "TALLGRASS"))}
    environment.pop("HOME", None)
    environment |= {"PYTHONPATH": str(place), "XDG_CACHE_HOME": str(cache), "MESA_SHADER_CACHE_DISABLE": "true"}
    done = subprocess.run(
        [sys.executable, "-c", OBEYING, "-c", LOCKED], env=environment, cwd=tmp_path, capture_output=True, text=True,
        check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["locked", "True", "1"]
    assert len(done.stderr.splitlines()) == 1
    assert str(cache) in done.stderr
    assert sorted(place.rglob("*")) == before
