"""The command line: what it says, and how it ends."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tallgrass import __version__
from tallgrass.app import doctor as doctor_module
from tallgrass.app.cli import run

COMMANDS = (
    ["walk"],
    ["shot"],
    ["film"],
    ["check"],
    ["doctor"],
    ["bench"],
    ["bench", "all"],
    ["bench", "frame"],
    ["bench", "picture"],
    ["bench", "pop"],
    ["bench", "scale"],
    ["bench", "walk"],
)


@pytest.mark.parametrize("words", [[], *COMMANDS], ids=" ".join)
def test_every_command_answers_help(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert run([*words, "--help"]) == 0
    out, err = capsys.readouterr()
    assert " ".join(["Usage: tallgrass", *words]) in " ".join(out.split())
    assert err == ""


def test_python_runs_the_package_like_the_command(tmp_path: Path) -> None:
    for words, status, told in (["--version"], 0, f"tallgrass {__version__}\n"), (["mow"], 2, ""):
        command = [sys.executable, "-W", "error", "-m", "tallgrass", *words]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False)
        assert (done.returncode, done.stdout) == (status, told)
        assert done.stderr.count("\n") == (status > 0)


def test_without_what_commands_are_made_with_it_is_said_what_installs_it(tmp_path: Path) -> None:
    words = "import sys; sys.modules['typer'] = None; from tallgrass.app.entry import main; main()"
    done = subprocess.run([sys.executable, "-c", words], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr == "commands are made with typer and rich: pip install 'tallgrass[commands]'\n"


def test_without_what_draws_the_panel_it_is_said_what_installs_it(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "imgui_bundle", None)
    assert run(["walk", "plain", "--edit"]) == 1
    assert capsys.readouterr().err == "the panel of --edit is drawn by imgui-bundle: pip install 'tallgrass[edit]'\n"


def test_the_version_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["--version"]) == 0
    assert capsys.readouterr().out == f"tallgrass {__version__}\n"


@pytest.mark.parametrize(
    ("words", "says"),
    [
        ("shot", "'-o' / '--output'"),
        ("shot -o a.png --size 0x0", "--size: '0x0': each side must be from 1 to 16384 pixels"),
        ("shot -o a.png --size abc", "--size: 'abc' is not a size like 1280x720"),
        ("shot -o a.png --size 20000x10", "--size: '20000x10': each side must be"),
        ("shot -o a.png --reference --size 8000x10", "--size: 8000x10: with --reference"),
        ("shot -o a.png --camera 1,2,3", "--camera: '1,2,3' is not five numbers"),
        ("shot -o a.png --camera -1,x,3,4,5", "--camera: 'x' is not a number"),
        ("shot -o a.png --time -1", "'--time': it has to be greater than or equal to 0"),
        ("shot -o a.png --time nan", "'--time'"),
        ("shot -o a.png --time inf", "'--time'"),
        ("shot -o a.png --time soon", "'--time'"),
        ("shot -o a.png --preset best", "'best' is not one of 'minimal', 'low', 'medium', 'high'"),
        ("shot -o a.png --lod grass", "'grass' is not one of 'auto', 'blades'"),
        ("shot -o a.png --overlay mask", "--overlay: 'mask' is no part of the overlay; there are masks, arrows,"),
        ("shot -o a.png --overlay all --reference", "--overlay: a reference has no levels of detail"),
        ("film -o a.webp --overlay masks,,map", "--overlay: '' is no part"),
        ("walk --overlay everything", "--overlay: 'everything' is no part"),
        ("shot -o a.bmp", "-o: a.bmp: a picture ends in .png"),
        ("shot -o noext", "-o: noext: a picture ends in .png"),
        ("film -o noext", "-o: noext: a film ends in .webp, .gif or .mp4, or is a folder, which ends in /"),
        ("shot a b -o a.png", "unexpected extra argument"),
        ("film -o a.avi", "-o: a.avi: a film ends in"),
        ("film -o a.webp --fps 0", "'--fps'"),
        ("film -o a.webp --seconds -3", "'--seconds'"),
        ("film -o a.gif --fps 90", "--fps: 90: a .gif"),
        ("walk --size tall", "--size: 'tall' is not a size"),
        ("bench frame --size 0x1", "--size: '0x1'"),
        ("bench nothing", "No such command 'nothing'"),
        ("mow", "No such command 'mow'"),
        ("check", "SCENE"),
        ("shot -o a.png --fast", "No such option: --fast"),
    ],
)
def test_bad_input_is_told_in_one_line_and_exits_with_2(
    words: str, says: str, capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run(words.split()) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert says in err
    assert err.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_no_command_shows_the_help_and_exits_with_2(capsys: pytest.CaptureFixture[str]) -> None:
    assert run([]) == 2
    out, err = capsys.readouterr()
    assert "Usage: tallgrass" in out
    assert err == ""


@pytest.mark.parametrize("command", [["shot", "-o", "a.png"], ["film", "-o", "a.webp"]], ids=lambda words: words[0])
def test_every_problem_of_a_scene_is_one_line_with_its_place(
    command: list[str], scene: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(scene.parent)
    scene.write_text(scene.read_text().replace("eye: 1.7", "eye: low").replace("scale: 3", "scales: 3"))
    assert run([command[0], "little.yaml", *command[1:]]) == 2
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 2
    assert lines[0].startswith("little.yaml:3:")
    assert lines[1].startswith("little.yaml:10:")
    assert [file.name for file in scene.parent.iterdir()] == ["little.yaml"]


def test_a_scene_that_is_not_there_is_told_in_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["shot", "nowhere", "-o", "a.png"]) == 2
    err = capsys.readouterr().err
    assert "nowhere" in err
    assert err.count("\n") == 1


def test_a_failure_of_our_own_is_one_sentence_and_exits_with_1(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken() -> int:
        raise RuntimeError("the lamp went out\nand more")

    monkeypatch.setattr(doctor_module, "doctor", broken)
    assert run(["doctor"]) == 1
    err = capsys.readouterr().err
    assert err == "tallgrass failed: RuntimeError: the lamp went out (tallgrass doctor may know why)\n"
    monkeypatch.setenv("TALLGRASS_TRACEBACK", "1")
    with pytest.raises(RuntimeError, match="the lamp"):
        run(["doctor"])


def test_stopping_a_command_is_told_without_a_traceback(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def stopped() -> int:
        raise KeyboardInterrupt

    monkeypatch.setattr(doctor_module, "doctor", stopped)
    assert run(["doctor"]) == 130
    assert "Traceback" not in capsys.readouterr().err


def test_a_commands_own_status_is_the_status(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(doctor_module, "doctor", lambda: 3)
    assert run(["doctor"]) == 3


def test_help_loads_neither_windows_nor_pictures() -> None:
    code = "import sys, tallgrass.app.cli as cli; cli.run(['--help']); print({'pyglet', 'PIL'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=True)
    assert done.stdout.splitlines()[-1] == "set()"


@pytest.mark.skipif(sys.platform != "linux", reason="only there can a display be taken away")
def test_without_a_display_walk_says_what_needs_none(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    words = [sys.executable, "-m", "tallgrass.app.cli", "walk"]
    done = subprocess.run(words, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 1
    told = "no window can be opened here (there is no display); tallgrass shot and tallgrass film need none\n"
    assert done.stderr == told


@pytest.mark.parametrize(
    ("words", "offered"),
    [
        ("tallgrass sh", ["shot"]),
        ("tallgrass film --preset paper-", ["paper-low", "paper-medium", "paper-high"]),
        ("tallgrass check w", ["whirlwind"]),
    ],
)
def test_a_shell_completes_commands_values_and_bundled_scenes(words: str, offered: list[str]) -> None:
    asked = {"_TALLGRASS_COMPLETE": "complete_bash", "COMP_WORDS": words, "COMP_CWORD": str(words.count(" "))}
    command = [sys.executable, "-m", "tallgrass.app.cli"]
    done = subprocess.run(command, env=os.environ | asked, capture_output=True, text=True, timeout=60, check=False)
    assert (done.stdout.split(), done.stderr) == (offered, "")


@pytest.mark.parametrize(
    "shell", ["bash", pytest.param("zsh", marks=pytest.mark.slow), pytest.param("fish", marks=pytest.mark.slow)]
)
def test_the_script_that_completes_is_shown_for_a_shell(shell: str) -> None:
    told = {"_TYPER_COMPLETE_TEST_DISABLE_SHELL_DETECTION": "1"}  # tests may run in no shell at all
    command = [sys.executable, "-m", "tallgrass.app.cli", "--show-completion", shell]
    done = subprocess.run(command, env=os.environ | told, capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    assert f"complete_{shell}" in done.stdout
