"""Keys of the file cache follow the code that makes what is kept."""

from pathlib import Path

import pytest

from tallgrass.engine import kept
from tallgrass.engine.kept import code_hash
from tallgrass.systems.light import repeating
from tallgrass.systems.stock import cache
from tallgrass.systems.trees import kept as of_trees

ROOT = Path(__file__).parents[2]


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(kept, "files", lambda _: tmp_path)
    for name in ("grow/bend.py", "grow/notes.txt", "show/grow.py", "lib/light.glsl"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text("1")
    return tmp_path


def hashed(*paths: str) -> str:
    code_hash.cache_clear()
    return code_hash(*paths)


@pytest.mark.parametrize("name", ["grow/bend.py", "show/grow.py", "lib/light.glsl"])
def test_a_key_changes_with_each_source_at_its_paths(package: Path, name: str) -> None:
    paths = "grow", "show/grow.py", "lib"
    before = hashed(*paths)
    (package / name).write_text("2")
    assert hashed(*paths) != before


def test_a_key_does_not_change_with_other_files(package: Path) -> None:
    before = hashed("grow")
    for name in ("grow/notes.txt", "show/grow.py"):
        (package / name).write_text("2")
    assert hashed("grow") == before


def test_a_game_without_sources_has_keys_that_change_with_the_version(
    package: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (package / "grow/bend.py").unlink()
    before = hashed("grow", "nowhere.py")
    monkeypatch.setattr(kept, "version", lambda _: "99.0")
    assert hashed("grow", "nowhere.py") != before


@pytest.mark.parametrize("code", [cache.CODE, of_trees.CODE, repeating.CODE])
def test_sources_that_keys_follow_exist(code: tuple[str, ...]) -> None:
    assert any((ROOT / path).exists() for path in code)
    assert {path for path in code if not (ROOT / path).exists()} <= {"systems/show/blades/grow.py"}
