"""Pictures of trees are drawn once, and kept on disk for later runs (F3, D6)."""

from pathlib import Path

import numpy as np
import pytest

from tallgrass.engine.kept import tell_nothing_is_kept
from tallgrass.systems.trees import kept
from tallgrass.systems.trees.kept import SUFFIX, Picture, keep_pictures, kept_pictures, kind_key

KEY = kind_key("oak", 3, "a card")


def pictures() -> list[Picture]:
    draw = np.random.default_rng(3)
    sides = [(4, 64), (1, 48), (1, 24)]
    return [[draw.integers(1, 255, (n, side >> k, side >> k, 4), np.uint8) for k in range(3)] for n, side in sides]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("TALLGRASS_CACHE", str(tmp_path))
    return tmp_path


def test_they_come_back_as_they_were_kept_and_for_nothing_else(folder: Path) -> None:
    made = pictures()
    keep_pictures(KEY, made)
    found = kept_pictures(KEY)
    assert found is not None
    for one, other in zip(found, made, strict=True):
        assert all(np.array_equal(*each) for each in zip(one, other, strict=True))
    others = kind_key("oak", 4, "a card"), kind_key("birch", 3, "a card"), kind_key("oak", 3, "another")
    assert len({KEY, *others}) == 4
    assert all(kept_pictures(key) is None for key in others)
    assert len(list(folder.iterdir())) == 1


def test_a_file_that_is_broken_counts_as_none(folder: Path) -> None:
    keep_pictures(KEY, pictures())
    path = folder / (KEY + SUFFIX)
    whole = path.read_bytes()
    for broken in (whole[:-1], b"", whole[:40] + bytes([whole[40] ^ 1]) + whole[41:]):
        path.write_bytes(broken)
        assert kept_pictures(KEY) is None


@pytest.mark.parametrize("picture", [0, 1])
def test_pictures_that_a_driver_has_left_empty_are_not_kept(folder: Path, picture: int) -> None:
    made = pictures()
    made[picture][0][-2:, ..., 3] = 0
    keep_pictures(KEY, made)
    assert not list(folder.iterdir())


def test_where_nothing_can_be_written_that_is_said_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    (tmp_path / "file").write_text("no folder")
    monkeypatch.setenv("TALLGRASS_CACHE", str(tmp_path / "file"))
    tell_nothing_is_kept.cache_clear()
    for _ in range(2):
        keep_pictures(KEY, pictures())
        assert kept_pictures(KEY) is None
    assert len(caplog.records) == 1
    assert "TALLGRASS_CACHE" in caplog.text


def test_no_more_files_are_kept_than_there_is_room_for(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for seed in range(40):
        keep_pictures(kind_key("oak", seed, "a card"), pictures()[:1])
    files = list(folder.glob("*" + SUFFIX))
    assert len(files) == 40, "a game with many kinds of trees would draw them anew at each start"
    monkeypatch.setattr(kept, "ROOM", 2.5 * files[0].stat().st_size)
    keep_pictures(kind_key("oak", 40, "a card"), pictures()[:1])
    assert len(list(folder.glob("*" + SUFFIX))) == 2
