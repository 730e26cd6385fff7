"""Watching files."""

import os
from pathlib import Path

import pytest

from tallgrass.app.watch import Watch


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "a.yaml"
    path.write_text("one")
    return path


def test_a_change_is_told_once(file: Path) -> None:
    watch = Watch([file])
    assert not watch.changed()
    file.write_text("another")
    assert watch.changed()
    assert not watch.changed()
    os.utime(file, ns=(1, 1))
    assert watch.changed()


def test_a_file_that_is_being_replaced_has_changed_when_it_is_back(file: Path) -> None:
    watch = Watch([file])
    file.unlink()
    assert not watch.changed()
    file.write_text("three")
    assert watch.changed()


def test_a_change_between_a_look_and_turning_to_other_files_is_not_lost(file: Path) -> None:
    watch, other = Watch([file]), file.with_name("b.png")
    file.write_text("changed")
    watch.turn_to([file, other])
    assert watch.changed()
    other.write_text("new")
    assert watch.changed()
    assert not watch.changed()
