"""How a problem looks when it is printed."""

import pickle

import pytest

from tallgrass.engine.scene.problem import MOST_PROBLEMS, Problem, SceneError


def test_a_problem_is_its_place_its_line_and_a_caret() -> None:
    assert str(Problem("a.yaml", 3, 5, "what is wrong", "    hight: 2")) == (
        "a.yaml:3:5: what is wrong\n"
        "        hight: 2\n"
        "        ^"
    )  # fmt: skip


def test_a_tab_in_the_line_keeps_the_caret_under_its_place() -> None:
    assert str(Problem("a.yaml", 1, 4, "x", "a:\tb")).endswith("\n    a:\tb\n      \t^")


def test_of_an_endless_line_only_the_surroundings_are_shown() -> None:
    _, line, caret = str(Problem("a.yaml", 1, 50_001, "x", "a" * 50_000 + "!" + "a" * 50_000)).splitlines()
    assert len(line) < 130
    assert line[caret.index("^")] == "!"


def test_a_problem_without_a_line_is_one_line() -> None:
    assert str(Problem("f", 1, 1, "the file is UTF-16")) == "f:1:1: the file is UTF-16"


def test_a_problem_without_a_file_is_its_sentence() -> None:
    assert str(Problem("", 1, 1, "no scene file 'medow'")) == "no scene file 'medow'"


def test_an_error_tells_its_problems_in_the_order_of_the_file() -> None:
    error = SceneError([Problem("f", 3, 1, "c"), Problem("f", 1, 9, "b"), Problem("f", 1, 2, "a")])
    assert str(error).splitlines() == ["f:1:2: a", "f:1:9: b", "f:3:1: c"]


@pytest.mark.parametrize("count", [1, MOST_PROBLEMS + 5])
def test_an_error_goes_from_one_process_to_another_as_it_is(count: int) -> None:
    error = SceneError([Problem("f", line, 1, "what is wrong") for line in range(count)])
    again = pickle.loads(pickle.dumps(error))  # noqa: S301
    assert (str(again), again.problems) == (str(error), error.problems)
