"""Systems of installed packages, against distributions as pip leaves them on disk."""

import logging
import subprocess
import sys
from collections.abc import Iterator
from importlib.metadata import EntryPoint, distributions
from pathlib import Path
from types import SimpleNamespace

import pytest

from tallgrass.engine.installed import Provided
from tallgrass.engine.plugged import SYSTEMS, SystemPlugins, system_plugins
from tallgrass.engine.plugins import wind_kinds
from tallgrass.engine.schedule import Schedule

BALL = """
def bring(prairie):
    prairie.systems.add("blow", "ball", roll)

def roll():
    pass

def leaving(prairie):
    raise SystemExit

def broken(prairie):
    prairie.systems.add("blow", "half", roll)
    raise ValueError("no ball here")
"""


@pytest.fixture(autouse=True)
def _plugins_of_this_test(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    for module in ("toys_ball", "toys_faulty", "toys_leaving"):
        monkeypatch.delitem(sys.modules, module, raising=False)
    for cached in (wind_kinds, system_plugins):
        cached.cache_clear()
    yield
    for cached in (wind_kinds, system_plugins):
        cached.cache_clear()


def install(folder: Path, name: str, systems: dict[str, str]) -> list[EntryPoint]:
    """Install a distribution into a folder, as pip would leave it there, and return its entry points."""
    info = folder / name / f"{name.replace('-', '_')}-0.3.1.dist-info"
    info.mkdir(parents=True)
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 0.3.1\n")
    lines = [f"[{SYSTEMS}]", *(f"{system} = {value}" for system, value in systems.items())]
    (info / "entry_points.txt").write_text("\n".join(lines) + "\n")
    (info.parent / "toys_ball.py").write_text(BALL)
    (info.parent / "toys_faulty.py").write_text("1 / 0")
    (info.parent / "toys_leaving.py").write_text("raise SystemExit(7)")
    return [entry for found in distributions(path=[str(info.parent)]) for entry in found.entry_points]


def prairie() -> SimpleNamespace:
    """A prairie as a package's system sees it."""
    return SimpleNamespace(systems=Schedule())


@pytest.fixture
def toys(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[EntryPoint]:
    """Systems of a distribution: `ball` is right, all others are wrong."""
    systems = {
        "ball": "toys_ball:bring",
        "broken": "toys_ball:broken",
        "faulty": "toys_faulty:bring",
        "gone": "toys_gone:bring",
        "leaving": "toys_leaving:bring",
        "left": "toys_ball:leaving",
        "text": "toys_ball:__name__",
    }
    monkeypatch.syspath_prepend(str(tmp_path / "tallgrass-toys"))
    return install(tmp_path, "tallgrass-toys", systems)


def test_an_installed_system_is_imported_when_a_prairie_is_made_and_not_before(toys: list[EntryPoint]) -> None:
    plugins = SystemPlugins(toys)
    assert Provided("ball", "tallgrass-toys", "0.3.1", "ready") in plugins.provided()
    assert "toys_ball" not in sys.modules
    made = prairie()
    plugins.bring(made)
    assert made.systems["ball"].origin == "toys_ball.roll"


def test_each_broken_one_is_one_warning_with_its_distribution_however_many_prairies_there_are(
    toys: list[EntryPoint], caplog: pytest.LogCaptureFixture
) -> None:
    plugins = SystemPlugins(toys)
    for _ in range(2):
        made = prairie()
        plugins.bring(made)
        assert "ball" in made.systems
    of = "of tallgrass-toys 0.3.1"
    assert caplog.record_tuples == [
        ("tallgrass", logging.WARNING, f"system {why}; it is left out")
        for why in (
            f"'broken' {of} cannot be added: ValueError: no ball here",
            f"'faulty' {of} cannot be loaded: ZeroDivisionError: division by zero",
            f"'gone' {of} cannot be loaded: ModuleNotFoundError: No module named 'toys_gone'",
            f"'leaving' {of} cannot be loaded: SystemExit: 7",
            f"'left' {of} cannot be added: SystemExit",
            f"'text' {of} must be a function that takes the prairie",
        )
    ]


def test_a_package_that_leaves_a_change_behind_is_named_once(
    toys: list[EntryPoint], caplog: pytest.LogCaptureFixture
) -> None:
    plugins = SystemPlugins([entry for entry in toys if entry.name == "ball"])
    for _ in range(2):
        made = prairie()
        plugins.bring(made, lambda: "left esper world 'there' current in place of 'here'")
        assert "ball" in made.systems
    (told,) = caplog.messages
    place = "left esper world 'there' current in place of 'here'; the prairie's own is current again"
    assert told == f"system 'ball' of tallgrass-toys 0.3.1 {place}"


@pytest.mark.usefixtures("toys")
def test_of_two_packages_with_one_system_neither_is_used_until_one_is_chosen(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    ball = {"ball": "toys_ball:bring"}
    twice = [*install(tmp_path, "a-toys", ball), *install(tmp_path, "b-toys", ball)]
    made = prairie()
    SystemPlugins(twice).bring(made)
    assert len(made.systems) == 0
    (told,) = caplog.messages
    choice = "uninstall all but one of them, or name it in TALLGRASS_PLUGINS; none is used"
    assert told == f"system 'ball' is claimed by a-toys 0.3.1 and b-toys 0.3.1; {choice}"
    chosen = SystemPlugins(twice, chosen=["B_toys"])
    chosen.bring(made)
    assert "ball" in made.systems
    assert [(row.distribution, row.status) for row in chosen.provided()] == [
        ("a-toys", "left out"),
        ("b-toys", "ready"),
    ]


@pytest.mark.usefixtures("toys")
@pytest.mark.parametrize(
    ("value", "brought"), [(None, True), ("", False), (" ball ,", True), ("tallgrass-toys", True), ("breeze", False)]
)
def test_the_environment_chooses_among_installed_systems(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture, value: str | None, *, brought: bool
) -> None:
    if value is None:
        monkeypatch.delenv("TALLGRASS_PLUGINS", raising=False)
    else:
        monkeypatch.setenv("TALLGRASS_PLUGINS", value)
    made = prairie()
    system_plugins().bring(made)
    assert ("ball" in made.systems) == brought
    wind_kinds()
    assert not [told for told in caplog.messages if "TALLGRASS_PLUGINS names" in told], "a system is no unknown kind"


def test_listing_systems_imports_nothing_that_draws_or_grows() -> None:
    code = (
        "import sys; from tallgrass.engine.plugged import system_plugins; system_plugins().provided(); "
        "assert not {'numpy', 'pydantic', 'pyglet'} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
