"""The command that checks scene files."""

import signal
import sys
from io import BytesIO, TextIOWrapper
from pathlib import Path

import pytest

from tallgrass.app.check import check
from tallgrass.app.cli import main
from tallgrass.engine.scene import bundled_scenes

GOOD = "tallgrass: 2\ngrass: { lawn: {} }\n"


def test_what_is_right_is_called_ok_and_ends_with_0(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "lawn.yaml"
    path.write_text(GOOD)
    assert check([str(path), "plain"]) == 0
    assert capsys.readouterr().out == f"{path}: ok\nplain: ok\n"


def test_one_bad_scene_among_good_ones_ends_with_2(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    bad, good = tmp_path / "bad.yaml", tmp_path / "good.yaml"
    bad.write_text(GOOD + "sed: 3\n")
    good.write_text(GOOD)
    assert check([str(bad), str(good)]) == 2
    assert capsys.readouterr().out.splitlines() == [
        f"{bad}:3:1: unknown key 'sed', did you mean 'seed'?",
        "    sed: 3",
        "    ^",
        f"{good}: ok",
    ]


def test_a_name_that_cannot_be_printed_stops_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    good, bad = tmp_path / "a\udcff\n.yaml", tmp_path / "b\udcff\n.yaml"
    good.write_text(GOOD)
    assert check([str(good), str(bad)]) == 2
    ok, *problem = capsys.readouterr().out.splitlines()
    assert ok == f"{tmp_path}/a\ufffd\ufffd.yaml: ok"
    assert len(problem) == 1


@pytest.mark.parametrize(
    ("scene", "told"),
    [
        ("medow", "no scene file 'medow', did you mean 'meadow'? bundled: {bundled}"),
        ("MEADOW", "no scene file 'MEADOW', did you mean 'meadow'? bundled: {bundled}"),
        ("zzz", "no scene file 'zzz'; bundled: {bundled}"),
        ("{folder}/grove.yaml", "no scene file '{folder}/grove.yaml'; 'grove' alone is a bundled scene"),
        ("{folder}/medow.yaml", "no scene file '{folder}/medow.yaml', did you mean 'meadow.yaml'?"),
        ("{folder}", "'{folder}' is a folder, not a scene file"),
        ("hollow", "'hollow' is a folder, not a scene file"),
        ("/dev/null", "'/dev/null' is a device, a pipe or a socket, not a scene file"),
        ("{folder}/latin.yaml", "{folder}/latin.yaml:1:1: byte 0xe9 is not UTF-8; save the file as UTF-8"),
        ("{folder}/" + "a" * 300 + ".yaml", "no scene file"),
    ],
)
def test_what_is_no_scene_file_is_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, scene: str, told: str
) -> None:
    (tmp_path / "meadow.yaml").write_text(GOOD)
    monkeypatch.chdir(tmp_path)
    Path("hollow").mkdir()
    (tmp_path / "latin.yaml").write_bytes(b"\xe9")
    scene = scene.format(folder=tmp_path)
    assert check([scene]) == 2
    (line,) = capsys.readouterr().out.splitlines()
    told = told.format(folder=tmp_path, bundled=", ".join(bundled_scenes()))
    assert line.startswith(told)


def test_an_empty_name_is_told_as_such(capsys: pytest.CaptureFixture[str]) -> None:
    assert check([""]) == 2
    assert capsys.readouterr().out == "this is an empty text, and no scene file's name\n"


@pytest.mark.parametrize("encoding", ["ascii", "cp1252"])
def test_what_the_terminal_cannot_show_is_told_all_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, encoding: str
) -> None:
    path, said = tmp_path / "\u8349.yaml", TextIOWrapper(BytesIO(), encoding)
    path.write_text(GOOD + "sed: 3\n", "utf-8")
    monkeypatch.setattr(sys, "stdout", said)
    monkeypatch.setattr(sys, "argv", ["tallgrass", "check", str(path)])
    monkeypatch.setattr(signal, "signal", lambda *_: None)
    with pytest.raises(SystemExit) as ended:
        main()
    said.seek(0)
    assert ended.value.code == 2
    assert said.read().startswith(f"{tmp_path}/\\u8349.yaml:3:1: unknown key 'sed'")
