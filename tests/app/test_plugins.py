"""The commands `plugins list`, `check` and `new`."""

import json
import os
import subprocess
import sys
from collections.abc import Callable
from importlib.metadata import EntryPoint
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pytest
import pytest.__main__

from tallgrass.app.cli import run
from tallgrass.app.plugins import check_plugin, list_plugins
from tallgrass.app.scaffold import new_game, new_wind, scaffold, scaffold_game
from tallgrass.app.studio.errors import InputError
from tallgrass.components.arrays import Floats
from tallgrass.components.wind import Grass, WindPrimitive
from tallgrass.engine.plugged import SYSTEMS, SystemPlugins
from tallgrass.engine.plugins import GROUP, WindKinds, wind_kinds

Python = Callable[..., str]

PYTEST = pytest.__main__.__file__, "-q", "-p", "no:cacheprovider"


class Loud(WindPrimitive):
    """A wind that is too strong, and whose `kind` differs from its entry point's name."""

    kind: str = "noisy"
    """A loud wind."""

    def mask(self, place: Floats, /, *, time: float) -> Any:
        return np.ones(len(place))

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Any:
        return np.full_like(place, [3.0, 0.0])


@pytest.fixture
def kinds() -> Any:
    wind_kinds.cache_clear()
    yield wind_kinds()
    wind_kinds.cache_clear()


def test_every_kind_is_listed_with_who_brings_it(kinds: WindKinds, capsys: pytest.CaptureFixture[str]) -> None:
    kinds.add("loud", Loud)
    list_plugins()
    head, *rows = (line.split() for line in capsys.readouterr().out.splitlines())
    assert head == ["kind", "distribution", "version", "status"]
    assert ["loud", f"{__name__}.Loud", "ready"] in rows
    assert [row[0] for row in rows] == sorted(row[0] for row in rows)
    assert {"breeze", "gust", "whirlwind", "blast"} <= {row[0] for row in rows if row[1] == "tallgrass"}


def test_programs_are_told_the_same_in_json(kinds: WindKinds, capsys: pytest.CaptureFixture[str]) -> None:
    list_plugins(json=True)
    rows = json.loads(capsys.readouterr().out)
    assert [row["kind"] for row in rows] == kinds.names()
    assert all(row.keys() == {"kind", "distribution", "version", "status"} for row in rows)


@pytest.mark.usefixtures("kinds")
def test_installed_systems_are_listed_in_a_table_of_their_own_after_the_winds(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("tallgrass.app.plugins.system_plugins", lambda: SystemPlugins([]))
    list_plugins()
    alone = capsys.readouterr().out
    balls = SystemPlugins([EntryPoint("ball", "game:bring", SYSTEMS)])
    monkeypatch.setattr("tallgrass.app.plugins.system_plugins", lambda: balls)
    list_plugins()
    winds, systems = capsys.readouterr().out.split("\n\n")
    assert f"{winds}\n" == alone
    assert [line.split() for line in systems.splitlines()] == [
        ["system", "distribution", "version", "status"],
        ["ball", "the", "entry", "point", "game:bring", "ready"],
    ]
    list_plugins(json=True)
    last = {"system": "ball", "distribution": "the entry point game:bring", "version": "", "status": "ready"}
    assert json.loads(capsys.readouterr().out)[-1] == last


@pytest.mark.usefixtures("kinds")
def test_whoever_asks_for_the_check_of_a_system_is_told_that_it_is_one(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    balls = SystemPlugins([EntryPoint("ball", "game:bring", SYSTEMS)])
    monkeypatch.setattr("tallgrass.app.plugins.system_plugins", lambda: balls)
    assert (check_plugin("ball"), check_plugin("bal")) == (2, 2)
    told, unknown = capsys.readouterr().out.splitlines()
    assert told.startswith("'ball' is a system of ")
    assert unknown.startswith("unknown kind 'bal'")


@pytest.fixture
def rude(tmp_path: Path) -> Path:
    """A folder with a distribution that claims a built-in kind, and ends Python where its own is imported."""
    info = tmp_path / "site" / "tallgrass_rude-0.3.1.dist-info"
    info.mkdir(parents=True)
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: tallgrass-rude\nVersion: 0.3.1\n")
    kinds, systems = ["gust = rude:Gust", "rude = rude:Rude"], ["rude = rude:bring"]
    (info / "entry_points.txt").write_text("\n".join([f"[{GROUP}]", *kinds, f"[{SYSTEMS}]", *systems]))
    (info.parent / "rude.py").write_text("import sys; sys.exit(7)")
    return info.parent


def test_a_plugin_that_ends_python_and_takes_a_built_in_name_ends_no_command(
    tallgrass: Any, rude: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PYTHONPATH", str(rude), prepend=os.pathsep)
    for kind in ("rude", "gust"):
        (tmp_path / f"{kind}.yaml").write_text(f"tallgrass: 2\ngrass: {{ lawn: {{}} }}\nwind: [{{ kind: {kind} }}]\n")
    choice = "uninstall tallgrass-rude, or leave it out by TALLGRASS_PLUGINS, which names what to use"
    taken = f"kind 'gust' is built in, and the one of tallgrass-rude 0.3.1 is not used; {choice}"
    left = "kind 'rude' of tallgrass-rude 0.3.1 cannot be loaded: SystemExit: 7"
    checked = tallgrass("check", "gust.yaml", "rude.yaml", "gust.yaml")
    assert (checked.returncode, checked.stderr) == (2, f"{taken}\n")
    first, problem, *_, last = checked.stdout.splitlines()
    assert (first, problem, last) == ("gust.yaml: ok", f"rude.yaml:3:16: {left}", "gust.yaml: ok")
    described = tallgrass("schema")
    assert (described.returncode, described.stderr) == (0, f"{taken}\n{left}; it is left out\n")
    listed = [line.split() for line in tallgrass("plugins", "list").stdout.splitlines()]
    assert ["gust", "tallgrass-rude", "0.3.1", "name", "taken"] in listed
    loading = f"from tallgrass import Prairie; print(Prairie.load({str(tmp_path / 'gust.yaml')!r}, preset='low').time)"
    loaded = subprocess.run([sys.executable, "-c", loading], capture_output=True, text=True, check=False)
    assert (loaded.returncode, loaded.stdout) == (0, "0.0\n")
    assert "system 'rude' of tallgrass-rude 0.3.1 cannot be loaded: SystemExit: 7; it is left out" in loaded.stderr


@pytest.mark.usefixtures("kinds")
def test_a_kind_that_keeps_to_the_rules_is_ok(capsys: pytest.CaptureFixture[str]) -> None:
    assert check_plugin("whirlwind") == 0
    assert capsys.readouterr().out == "whirlwind: ok\n"


def test_every_problem_of_a_kind_is_one_line(kinds: WindKinds, capsys: pytest.CaptureFixture[str]) -> None:
    kinds.add("loud", Loud)
    assert check_plugin("loud") == 2
    assert capsys.readouterr().out.splitlines() == [
        "loud: action returned a posture index of 3, which is over 1 (at 0 s)",
        "loud: the field 'kind' defaults to 'noisy', but the entry point is called 'loud'",
    ]


def test_a_twin_that_is_not_there_is_a_problem(kinds: WindKinds, capsys: pytest.CaptureFixture[str]) -> None:
    class Twinned(Loud):
        """A wind to the right, whose twin's text the test gives."""

        twin: ClassVar[str | None] = "nowhere.glsl"
        kind: str = "twinned"
        """A wind to the right."""

        def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Any:
            return np.full_like(place, [0.3, 0.0])

    kinds.add("twinned", Twinned)
    assert check_plugin("twinned") == 2
    why = f"there is no file 'nowhere.glsl' beside its module {__name__}"
    assert capsys.readouterr().out == f"twinned: its twin cannot be used: {why}\n"


@pytest.mark.usefixtures("kinds")
def test_a_kind_that_is_not_there_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    assert check_plugin("gst") == 2
    assert capsys.readouterr().out.startswith("unknown kind 'gst', did you mean 'gust'?")


@pytest.mark.parametrize("kind", ["dust-devil", pytest.param("placed-wind", marks=pytest.mark.slow), "none"])
def test_a_new_plugin_passes_the_check_and_its_own_test(tmp_path: Path, kind: str, python: Python) -> None:
    folder = tmp_path / kind
    files = scaffold(kind, folder)
    assert len(files) == 3
    (module,) = folder.glob("*.py")
    assert len(module.read_text("utf-8").splitlines()) <= 40
    here = f"import sys; sys.path.insert(0, {str(folder)!r})"
    assert "1 passed" in python(folder, *PYTEST, "-c", "pyproject.toml", ".", place={}, before=here)


def test_a_new_game_passes_its_own_tests(tmp_path: Path, python: Python, little_grass: str) -> None:
    scaffold_game("my-walk", tmp_path / "my-walk")
    assert "passed" in python(tmp_path / "my-walk", *PYTEST, "tests", place={}, before=little_grass)


@pytest.mark.slow
@pytest.mark.window
def test_a_new_game_draws_in_its_window(tmp_path: Path, display: str, python: Python, little_grass: str) -> None:
    """It is closed after three frames; tests of the manual's pages run games by pyglet's loop."""
    scaffold_game("my-walk", tmp_path / "my-walk")
    python(tmp_path / "my-walk", "game.py", "--frames", "3", place={"DISPLAY": display}, before=little_grass)


def test_what_is_begun_is_clean_by_the_houses_own_rules(tmp_path: Path) -> None:
    files = scaffold("eddy", tmp_path / "examples" / "eddy") + scaffold_game("walk", tmp_path / "examples" / "walk")
    rules = ["--config", str(Path(__file__).parents[2] / "pyproject.toml"), "--ignore", "INP001,ARG002,E402,I001"]
    modules = [str(file) for file in files if file.suffix == ".py"]
    for command in (["check", *rules], ["format", "--check", *rules[:2]]):
        done = subprocess.run(
            [sys.executable, "-m", "ruff", *command, *modules],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, done.stdout + done.stderr


def test_what_comes_next_is_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    new_wind("eddy", None)
    new_wind("eddy", "my winds")
    told = capsys.readouterr().out.splitlines()
    assert told[:3] == ["eddy/pyproject.toml", "eddy/tallgrass_eddy.py", "eddy/tests/test_eddy.py"]
    assert told[3] == "next: pip install -e eddy && tallgrass plugins check eddy"
    new_game("my-walk", None)
    assert capsys.readouterr().out.splitlines()[-1] == "next: python my-walk/game.py"
    assert told[7] == "next: pip install -e 'my winds' && tallgrass plugins check eddy"


@pytest.mark.parametrize(
    "kind", ["", "Eddy", "two words", "../up", "1st", "a--b", "end-", "-x", "a" * 61, "é", "a/b", "os.path"]
)
def test_a_name_that_cannot_be_one_is_refused(tmp_path: Path, kind: str) -> None:
    for begin in (scaffold, scaffold_game):
        with pytest.raises(InputError, match="lower-case letters and digits, a letter first"):
            begin(kind, tmp_path / "new")
    assert not (tmp_path / "new").exists()


def test_a_kind_that_is_installed_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="kind 'gust' already comes with tallgrass "):
        scaffold("gust", tmp_path / "new")


def test_nothing_is_overwritten(tmp_path: Path) -> None:
    full, file = tmp_path / "full", tmp_path / "file"
    full.mkdir()
    (full / "mine.py").write_text("mine", "utf-8")
    file.write_text("mine", "utf-8")
    for place in (full, file):
        with pytest.raises(InputError, match="is there already"):
            scaffold("eddy", place)
    with pytest.raises(InputError, match="cannot be written"):
        scaffold("eddy", file / "below")
    assert [path.read_text("utf-8") for path in (full / "mine.py", file)] == ["mine", "mine"]


@pytest.mark.usefixtures("kinds")
def test_the_command_ends_as_all_others_do(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run(["plugins", "new", "breeze"]) == 2
    capsys.readouterr()
    assert run(["plugins", "new", "Breeze"]) == 2
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert run(["plugins", "new", "eddy", "-o", "new/eddy"]) == 0
    assert run(["new", "wind", "eddy", "-o", "again/eddy"]) == 0
    assert run(["new", "game", "Walk"]) == 2
    assert run(["plugins", "check", "eddy"]) == 2
    assert run(["plugins", "list"]) == 0
