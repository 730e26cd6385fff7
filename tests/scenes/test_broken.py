"""Scenes with problems: the last lines of each file are the messages that `check` must print, with their places."""

import re
from pathlib import Path

import pytest

from tallgrass.app.check import check

BROKEN = sorted((Path(__file__).parent / "broken").glob("*.yaml"))
EXPECT = re.compile(r"^# expect (\d+:\d+) (.+)$", re.MULTILINE)


def test_there_are_broken_scenes_to_try() -> None:
    assert len(BROKEN) >= 50
    assert all(EXPECT.search(path.read_text("utf-8")) for path in BROKEN)


@pytest.mark.parametrize("path", BROKEN, ids=[path.stem for path in BROKEN])
def test_d4_check_tells_every_problem_of_a_scene_at_its_place(path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = path.read_text("utf-8")
    expected = EXPECT.findall(text)

    status = check([str(path)])

    printed, errors = capsys.readouterr()
    told = [line for line in printed.splitlines() if line.startswith(f"{path}:")]
    assert status == 2
    assert not errors
    assert len(told) == len(expected), printed
    for line, (place, words) in zip(told, expected, strict=True):
        assert line.startswith(f"{path}:{place}: ")
        assert words in line


@pytest.mark.parametrize("path", BROKEN, ids=[path.stem for path in BROKEN])
def test_a_problem_is_shown_with_its_line_and_a_caret(path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    source = path.read_text("utf-8").splitlines()
    check([str(path)])
    printed = capsys.readouterr().out.splitlines()
    heads = [i for i, line in enumerate(printed) if line.startswith(f"{path}:")]
    for i in heads:
        _, row, column, _ = printed[i].split(":", 3)
        assert printed[i + 1].strip() in source[int(row) - 1]
        assert printed[i + 2].strip() == "^"
        under = printed[i + 2].index("^")
        assert printed[i + 1][under : under + 1] == source[int(row) - 1][int(column) - 1 : int(column)]
