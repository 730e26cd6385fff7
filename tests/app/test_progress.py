"""Progress: bars on a terminal, and silence in a pipe."""

import io
from collections.abc import Iterator

import pytest
from rich.console import Console
from rich.progress import Progress

from tallgrass.app.studio import progress
from tallgrass.app.studio.progress import busy, counted, course


@pytest.fixture
def terminal(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[Progress]]:
    """Output of a pretended terminal."""
    shown: list[Progress] = []
    console = Console(file=io.StringIO(), force_terminal=True)
    monkeypatch.setattr(progress, "Console", lambda **_: console)
    made = progress.display

    def display() -> Progress:
        shown.append(made())
        return shown[-1]

    monkeypatch.setattr(progress, "display", display)
    yield shown
    assert not any(each.tasks for each in shown), "every bar has been taken away"


def bars(shown: list[Progress]) -> dict[str, float]:
    """Return the percentage of each bar of the only display."""
    (display,) = shown
    return {task.description: round(task.percentage, 1) for task in display.tasks}


def test_a_bar_counts_what_is_yielded_and_goes(terminal: list[Progress]) -> None:
    seen = [(item, bars(terminal)) for item in counted("abcd", total=4, doing="letters")]
    assert seen == [(letter, {"letters": 25.0 * number}) for number, letter in enumerate("abcd")]


def test_a_course_moves_on_with_what_is_counted_in_its_parts(terminal: list[Progress]) -> None:
    seen = []
    with course("all", {"short": 1.0, "long": 3.0}) as way:
        with way.part("short"):
            seen.append(bars(terminal))
        with way.part("long"):
            seen += [bars(terminal) for _ in counted(range(2), total=2, doing="steps")]
            with busy("nobody knows"):
                seen.append(bars(terminal))
    assert seen == [
        {"all: short": 0.0},
        {"all: long": 25.0, "steps": 0.0},
        {"all: long": 62.5, "steps": 50.0},
        {"all: long": 100.0, "nobody knows": 0.0},
    ]


def test_courses_nest_and_no_bar_goes_back(terminal: list[Progress]) -> None:
    seen = []
    with course("outer", {"one": 1.0, "two": 1.0}) as outer, outer.part("one"):
        for _ in range(2):
            with course("inner", {"a": 1.0, "b": 1.0}) as inner:
                with inner.part("a"):
                    pass
                seen.append(bars(terminal)["outer: one"])
    assert seen == [25.0, 25.0]


def test_in_a_pipe_nothing_is_said(capsys: pytest.CaptureFixture[str]) -> None:
    with course("all", {"part": 1.0}) as way, way.part("part"), busy("busy"):
        assert list(counted(range(3), total=3, doing="counting")) == [0, 1, 2]
    assert capsys.readouterr() == ("", "")
