"""Everything recorded as public still exists, with the same interface."""

import json
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]
TELL = """
import json
from docs.making import public
before, now = public.recorded(), public.public()
print(json.dumps([public.broken(before, now), sorted(set(now) - set(before)), now]))
"""


@pytest.fixture(scope="module")
def told() -> Any:
    """Broken names, new names, and all public names of this version."""
    done = subprocess.run([sys.executable, "-c", TELL], cwd=ROOT, capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


@pytest.fixture
def broken(monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.syspath_prepend(str(ROOT))
    return import_module("docs.making.public").broken


def test_nothing_public_is_gone_or_changed(told: Any) -> None:
    gone, new, _ = told
    sys.stdout.write("".join(f"to be recorded: {name}\n" for name in new))
    assert not gone, "\n".join([*gone, "If it has to be, `python -m docs.making.public` records what is public anew."])


def test_all_that_other_programs_write_against_is_recorded(told: Any) -> None:
    now = told[2]
    for name in (
        "face: Prairie.draw(view)", "face: Presser(radius)", "face: Lod.hold", "testing: check_wind(primitive)",
        "scene: grass: NAME.height", "scene: wind: gust.every", "scene: quality.blades", "commands: bench frame --json",
        "commands: shot SCENE", "json of bench: frame_ms", "json of film: pictures", "entry points: tallgrass.wind",
        "environment: TALLGRASS_CACHE",
    ):  # fmt: skip
        assert name in now, name
    assert now["scene: grass: NAME.withered"] == "default 0.0 maximum 0.6 minimum 0.0 type 'number'"
    assert "word" in now["scene: mixing = weight"]


def test_what_is_gone_renamed_or_has_to_be_given_is_told_and_what_is_added_is_not(broken: Any) -> None:
    before = {"face: Gust": "class", "face: Gust(speed)": "keyword-only, 8.0 unless told"}
    assert broken(before, before | {"face: Gale": "class", "face: Gale(speed)": "keyword-only, required"}) == []
    assert broken(before, before | {"face: Gust(width)": "keyword-only, 40.0 unless told"}) == []
    assert broken(before, {"face: Gust": "class"}) == ["face: Gust(speed) is gone"]
    assert broken(before, before | {"face: Gust(width)": "keyword-only, required"}) == [
        "face: Gust(width) has to be given now"
    ]
    assert broken(before, before | {"face: Gust(speed)": "keyword-only, 9.0 unless told"}) == [
        "face: Gust(speed) was keyword-only, 8.0 unless told, and is keyword-only, 9.0 unless told"
    ]
