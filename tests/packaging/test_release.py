"""A release is one command: it moves the changelog's section, sets the version, and builds the distributions."""

import re
import sys
from datetime import date
from importlib import import_module
from pathlib import Path
from typing import Any
from zipfile import ZipFile

import pytest

pytestmark = pytest.mark.packaging

ROOT = Path(__file__).parents[2]
DAY = date(2031, 5, 9)
CHANGELOG = "# Changelog\n\n## [Unreleased]\n\n### Added\n- Rain.\n\n## [1.1.0] - 2030-01-02\n\n- Wind.\n"
INIT = '"""Words."""\n\n__version__ = "1.1.0"\n'


@pytest.fixture
def making(monkeypatch: pytest.MonkeyPatch) -> Any:
    """The module that makes releases."""
    monkeypatch.syspath_prepend(str(ROOT))
    return import_module("docs.making.release")


def test_the_changes_get_the_version_and_the_day_and_the_next_ones_a_place(making: Any) -> None:
    made = making.changed("1.2.0", DAY, {"CHANGELOG.md": CHANGELOG, "__init__.py": INIT})
    assert made["__init__.py"] == INIT.replace("1.1.0", "1.2.0")
    assert made["CHANGELOG.md"].startswith(
        "# Changelog\n\n## [Unreleased]\n\n## [1.2.0] - 2031-05-09\n\n### Added\n- Rain."
    )
    assert made["CHANGELOG.md"].endswith(CHANGELOG.partition("- Rain.")[2])


@pytest.mark.parametrize(
    ("version", "changelog", "reason"),
    [
        ("1.0.9", CHANGELOG, "older than 1.1.0"),
        ("1.2", CHANGELOG, "not X.Y.Z"),
        ("next", CHANGELOG, "no version"),
        ("1.1.0", CHANGELOG, "has 1.1.0 already"),
        ("1.2.0", CHANGELOG.replace("### Added\n- Rain.\n\n", ""), "nothing under"),
    ],
)
def test_what_cannot_be_released_is_told(making: Any, version: str, changelog: str, reason: str) -> None:
    with pytest.raises(making.ReleaseError, match=reason):
        making.changed(version, DAY, {"CHANGELOG.md": changelog, "__init__.py": INIT})


def test_what_is_not_committed_or_keeps_no_word_stops_it(making: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(making, "_ran", lambda *_: " M README.md\n")
    with pytest.raises(making.ReleaseError, match=r"commit first:\n M README.md"):
        making.must_be_clean()
    monkeypatch.setattr(making, "recorded", lambda: {"face: Prairie.mow": "method"})
    monkeypatch.setattr(making, "public", dict)
    with pytest.raises(making.ReleaseError, match=r"face: Prairie\.mow is gone"):
        making.must_keep_its_word()


@pytest.mark.slow
@pytest.mark.skipif(not (ROOT / ".git").exists(), reason="a release is made in a checkout")
def test_a_dry_run_builds_what_an_index_takes_and_changes_nothing(
    making: Any, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    told: list[tuple[str, str]] = []
    before = [(ROOT / name).read_bytes() for name in ("CHANGELOG.md", "__init__.py")]
    build = making.build

    def look(copy: Path, changes: dict[str, str]) -> list[Path]:
        built: list[Path] = build(copy, changes)
        with ZipFile(next(file for file in built if file.suffix == ".whl")) as wheel:
            (metadata,) = (name for name in wheel.namelist() if name.endswith("/METADATA"))
            told.extend(re.findall(r"^(Version|Provides-Extra): (.+)$", wheel.read(metadata).decode(), re.MULTILINE))
        return built

    monkeypatch.setattr(making, "build", look)
    making.release("987.6.5", dry_run=True, checks=())
    assert ("Version", "987.6.5") in told
    assert ("Provides-Extra", "all") in told
    assert capsys.readouterr().out == (
        "tallgrass-987.6.5-py3-none-any.whl, tallgrass-987.6.5.tar.gz can be built; nothing has changed.\n"
    )
    assert [(ROOT / name).read_bytes() for name in ("CHANGELOG.md", "__init__.py")] == before


def test_what_takes_long_is_run_as_well(making: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    ran: list[tuple[str, ...]] = []
    monkeypatch.setattr(making.subprocess, "run", lambda command, **_: ran.append(tuple(command[1:])))
    making.must_pass()
    assert ran == [("lint",), ("types",), ("test",), ("test", "-m", "slow")]


def test_how_it_is_called_is_told(making: Any, capsys: pytest.CaptureFixture[str]) -> None:
    assert making.main(["--dry-run"]) == 2
    assert capsys.readouterr().err == "./dev release X.Y.Z [--dry-run]\n"
    assert making.main(["0.0.1", "--dry-run"]) == 1
    assert "older than" in capsys.readouterr().err
    assert sys.modules["docs.making.release"] is making
