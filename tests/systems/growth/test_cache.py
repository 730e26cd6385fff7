"""Growth kept on disk."""

import os
from pathlib import Path
from typing import Any, Never

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tallgrass.engine.declared.grass import GrassKind, Place
from tallgrass.engine.declared.quality import BladeRing, Quality, StripRing
from tallgrass.engine.kept import DIGEST, cache_folder, keep, kept
from tallgrass.systems.grow.record import Growth
from tallgrass.systems.show.strips.grow import strips_of
from tallgrass.systems.stock import cache
from tallgrass.systems.stock.archive import pack, unpack
from tallgrass.systems.stock.cache import SUFFIX, cached_growth, growth_key
from tallgrass.systems.stock.models import grow

KIND = GrassKind(width=0.03)
SMALL = Quality(
    patch=1.0,
    blades=12,
    models=1,
    blade_rings=[BladeRing(to=1, segments=4)],
    strip_rings=[StripRing(to=3, strips=2, texel=0.04)],
    carpet_to=9,
    carpet=8,
)
GROWN = grow(KIND, SMALL, seed=5)
PACKED = pack(GROWN)


@pytest.fixture
def grows(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """List that gets an entry for each growth."""
    calls = []

    def count(kind: GrassKind, quality: Quality, /, *, seed: int) -> Growth:
        calls.append((kind, quality, seed))
        return GROWN

    monkeypatch.setattr(cache, "grow", count)
    return calls


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TALLGRASS_CACHE", str(tmp_path))


def believed(data: bytes, *, key: str = "key") -> Growth | None:
    """Return the growth in a file of the cache that has these bytes, as `cached_growth` reads it."""
    folder = cache_folder()
    assert folder is not None
    (folder / (key + SUFFIX)).write_bytes(data)
    found = kept(key, SUFFIX)
    return None if found is None else unpack(found)


def filed(key: str = "key") -> bytes:
    """Return the bytes of the file in which the cache keeps `GROWN` under a key."""
    keep(key, SUFFIX, PACKED, room=1)
    folder = cache_folder()
    assert folder is not None
    return (folder / (key + SUFFIX)).read_bytes()


def stored(folder: Path) -> list[Path]:
    return [path for path in folder.iterdir() if path.is_file()]


def same(one: Growth, two: Growth) -> bool:
    return pack(one) == pack(two)


def test_what_was_grown_once_is_read_the_next_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, grows: list[Any]
) -> None:
    monkeypatch.setenv("TALLGRASS_CACHE", str(tmp_path / "new" / "folder"))
    first, second = (cached_growth(KIND, SMALL, seed=5) for _ in range(2))
    assert len(grows) == 1
    assert first is GROWN
    assert same(second, GROWN)
    assert strips_of(second.models[0])[0].height == strips_of(GROWN.models[0])[0].height
    assert [path.suffix for path in stored(tmp_path / "new" / "folder")] == [".growth"]


@pytest.mark.parametrize(
    "change",
    [
        {"height": [0.4, 0.71]},
        {"width": 0.031},
        {"stiffness": 1.1},
        {"damping": 1.1},
        {"lean": 0.31},
        {"taper": 1.1},
        {"profile": "fold"},
        {"withered": 0.1},
        {"blades": 13},
    ],
)
def test_another_kind_is_grown_anew(change: dict[str, Any]) -> None:
    other = KIND.model_copy(update=change)
    assert growth_key(other, SMALL, seed=5) != growth_key(KIND, SMALL, seed=5)


@pytest.mark.parametrize(
    "change",
    [
        {"patch": 1.5},
        {"blades": 13},
        {"models": 2},
        {"carpet": 16},
        {"strip_rings": [StripRing(to=3, strips=3, texel=0.04)]},
        {"strip_rings": [StripRing(to=3, strips=2, texel=0.05)]},
    ],
)
def test_another_quality_is_grown_anew(change: dict[str, Any]) -> None:
    other = SMALL.model_copy(update=change)
    assert growth_key(KIND, other, seed=5) != growth_key(KIND, SMALL, seed=5)


def test_another_seed_or_other_code_is_grown_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    keys = {growth_key(KIND, SMALL, seed=seed) for seed in (5, 6)}
    monkeypatch.setattr(cache, "code_hash", lambda *_: "other")
    keys.add(growth_key(KIND, SMALL, seed=5))
    assert len(keys) == 3


def test_colours_places_and_ranges_need_no_growing() -> None:
    kind = KIND.model_copy(update={"root": "#000000", "variety": 0.5, "segments": 3, "place": Place(map="a.png")})
    quality = SMALL.model_copy(update={"carpet_to": 30, "blade_rings": [BladeRing(to=2, segments=7)]})
    assert growth_key(kind, quality, seed=5) == growth_key(KIND, SMALL, seed=5)


@settings(max_examples=60, deadline=None)
@given(st.integers(0, DIGEST + len(PACKED) - 1), st.integers(1, 255))
def test_a_file_with_any_byte_changed_is_never_believed(place: int, change: int) -> None:
    data = bytearray(filed())
    data[place] ^= change
    assert believed(bytes(data)) is None


@settings(max_examples=60, deadline=None)
@given(st.one_of(st.binary(max_size=400), st.integers(0, DIGEST + len(PACKED) - 1)))
def test_a_file_that_is_cut_off_or_not_ours_is_never_believed(data: bytes | int) -> None:
    assert believed(filed()[:data] if isinstance(data, int) else data) is None


def test_a_file_under_another_name_is_never_believed() -> None:
    assert believed(filed()) is not None
    assert believed(filed(), key="other") is None


@settings(max_examples=10, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(junk=st.binary(max_size=64))
def test_a_broken_file_is_grown_again_and_replaced(tmp_path: Path, grows: list[Any], junk: bytes) -> None:
    cached_growth(KIND, SMALL, seed=5)
    (path,) = stored(tmp_path)
    path.write_bytes(junk)
    before = len(grows)
    cached_growth(KIND, SMALL, seed=5)
    cached_growth(KIND, SMALL, seed=5)
    assert len(grows) == before + 1


def test_a_folder_that_is_a_file_is_no_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, grows: list[Any]) -> None:
    (tmp_path / "file").write_text("in the way")
    monkeypatch.setenv("TALLGRASS_CACHE", str(tmp_path / "file"))
    for _ in range(2):
        assert cached_growth(KIND, SMALL, seed=5) is GROWN
    assert len(grows) == 2


@pytest.mark.usefixtures("grows")
def test_a_place_where_nothing_can_be_written_is_told_once_and_no_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def refuse(*_args: Any, **_options: Any) -> Never:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "write_bytes", refuse)
    for _ in range(2):
        assert cached_growth(KIND, SMALL, seed=5) is GROWN
    assert stored(tmp_path) == []
    (told,) = caplog.messages
    assert told.startswith(f"nothing can be cached in {tmp_path} (Permission denied), so plants and clouds")


@pytest.mark.usefixtures("grows")
@pytest.mark.skipif(os.name != "posix", reason="files have no modes")
def test_a_cache_that_one_user_ships_can_be_read_by_another(tmp_path: Path) -> None:
    cached_growth(KIND, SMALL, seed=5)
    (found,) = stored(tmp_path)
    (own := tmp_path / "own").touch()
    assert found.stat().st_mode == own.stat().st_mode


@pytest.mark.usefixtures("grows")
def test_a_full_disk_leaves_nothing_behind(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(_self: Any, _target: Any) -> Never:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "replace", refuse)
    assert cached_growth(KIND, SMALL, seed=5) is GROWN
    assert stored(tmp_path) == []


@pytest.mark.usefixtures("grows")
def test_what_was_not_used_for_longest_is_forgotten(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr("tallgrass.systems.stock.cache.ROOM", 47 * 1000 + DIGEST + len(PACKED))
    for number in range(60):
        (tmp_path / f"{number}.growth").write_bytes(b"x" * 1000)
        os.utime(tmp_path / f"{number}.growth", (number, number))
    (tmp_path / "mine.txt").write_text("not ours")
    (tmp_path / "gone.growth").symlink_to(tmp_path / "another program was first")
    cached_growth(KIND, SMALL, seed=5)
    assert not caplog.messages
    names = {path.name for path in stored(tmp_path)}
    assert len(names) == 49
    assert {"mine.txt", "59.growth"} < names
    assert "5.growth" not in names


def test_the_folder_is_where_people_say_it_is(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.delenv("TALLGRASS_CACHE", raising=False)
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    assert cache_folder() == tmp_path / "home" / ".cache" / "tallgrass"
    monkeypatch.setenv("XDG_CACHE_HOME", "relative")
    assert cache_folder() == tmp_path / "home" / ".cache" / "tallgrass"
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "xdg"))
    assert cache_folder() == tmp_path / "xdg" / "tallgrass"
    monkeypatch.setenv("TALLGRASS_CACHE", str(tmp_path / "own"))
    assert cache_folder() == tmp_path / "own"


@pytest.mark.usefixtures("grows")
def test_without_a_home_there_is_no_cache_and_no_error(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def nowhere() -> Never:
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.delenv("TALLGRASS_CACHE", raising=False)
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.setattr(Path, "home", nowhere)
    assert cache_folder() is None
    assert cached_growth(KIND, SMALL, seed=5) is GROWN
    assert [told.partition(")")[0] for told in caplog.messages] == [
        "nothing can be cached in the home folder (there is none"
    ]
