"""The history of drafts: undo and redo."""

from tallgrass.app.edit.history import MOST_STEPS, Draft, History


def history(*seeds: int, subject: object = None) -> History:
    made = History(Draft({"seed": 0}))
    for seed in seeds:
        made.change(Draft({"seed": seed}), subject=subject)
    return made


def seed(made: History) -> int:
    return int(made.now.values["seed"])


def test_changes_of_one_subject_in_a_row_are_one_step_until_rest() -> None:
    made = history(1, 2, 3, subject="slider")
    made.change(Draft({"seed": 4}), subject="other")
    assert made.undo()
    assert seed(made) == 3
    made.undo()
    assert seed(made) == 0
    assert not made.undo()
    made = history(1, subject="slider")
    made.rest()
    made.change(Draft({"seed": 2}), subject="slider")
    made.undo()
    assert seed(made) == 1


def test_a_change_after_an_undo_lets_go_of_what_was_undone() -> None:
    made = history(1, 2, subject=None)
    made.undo()
    made.change(Draft({"seed": 5}), subject=None)
    assert not made.redo()
    made.undo()
    assert seed(made) == 1
    assert made.redo()
    assert seed(made) == 5


def test_what_was_undone_and_done_again_does_not_join_with_what_comes_next() -> None:
    made = history(1, subject="slider")
    made.undo()
    made.redo()
    made.change(Draft({"seed": 2}), subject="slider")
    made.undo()
    assert seed(made) == 1


def test_the_state_that_was_saved_is_known_when_one_comes_back_to_it() -> None:
    made = history(1, 2)
    made.undo()
    made.save()
    made.undo()
    assert not made.is_saved
    made.redo()
    assert made.is_saved


def test_only_so_many_steps_are_kept() -> None:
    made = history(*range(1, MOST_STEPS + 50))
    while made.undo():
        pass
    assert seed(made) == 49
