"""`bench all`: one file of results, and a page that compares two of them."""

import base64
import io
import json
import re
import sys
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

from tallgrass.app.bench import frame, pop, scale, still, stroll, whole
from tallgrass.app.bench import page as whole_page
from tallgrass.app.bench.page import figures, page
from tallgrass.app.bench.plots import PLOTS
from tallgrass.app.cli import run

PARTS = {"frame", "walk", "scale", "picture", "pop"}
PICTURE = re.compile(r'<img src="data:image/png;base64,([^"]+)"')


@pytest.fixture
def short(monkeypatch: pytest.MonkeyPatch) -> None:
    """Make every benchmark draw a few frames only."""
    for module, name, value in (
        (stroll, "RATE", 10), (stroll, "SECONDS", 0.5), (frame, "FRAMES", 4), (frame, "EVERY", 2), (frame, "TURN", 2),
        (still, "WARM_UP", 2), (scale, "SIDES", (100.0,)),
    ):  # fmt: skip
        monkeypatch.setattr(module, name, value)
    monkeypatch.setattr(scale, "apart", lambda work, *given: work(*given))  # another process would draw many frames
    monkeypatch.setattr(pop, "MOST_PROCESSES", 1)
    monkeypatch.setattr(pop, "legs", lambda prairie: stroll.legs(prairie)[:1])


def with_new_figures(told: Any, factor: float) -> Any:
    """A result with every measured figure changed."""
    if isinstance(told, dict):
        return {name: with_new_figures(value, factor) for name, value in told.items()}
    if isinstance(told, list):
        return [with_new_figures(value, factor) for value in told]
    return told * factor if isinstance(told, float) else told


@pytest.mark.slow
@pytest.mark.gl
@pytest.mark.usefixtures("ctx", "short")
def test_all_benchmarks_make_one_file_and_one_page_and_a_second_time_they_are_compared(
    scene: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    first, second = scene.parent / "first", scene.parent / "second"
    words = ["bench", "all", str(scene), "--size", "96x54"]
    assert run([*words, "-o", str(first)]) == 0
    out, err = capsys.readouterr()
    assert (out, err) == (f"{first / 'bench.json'}\n{first / 'bench.html'}\n", "")
    told = json.loads((first / "bench.json").read_text())
    assert told.keys() == {"version", "machine", "scene", "preset", "took_s", "limits"} | PARTS
    assert told["took_s"].keys() == PARTS
    assert all(told[part].keys() >= {"machine", "scene", "preset", "size", "frames"} for part in PARTS)

    now = with_new_figures(told, 2.0) | {"version": "9.9.9"}
    monkeypatch.setattr(whole, "all_measured", lambda *_, **__: now)
    assert run([*words, "-o", str(second), "--against", str(first / "bench.json"), "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == json.loads((second / "bench.json").read_text()) == now
    alone, beside = ((folder / "bench.html").read_text() for folder in (first, second))
    for text in (alone, beside):
        pictures = [Image.open(io.BytesIO(base64.b64decode(data))) for data in PICTURE.findall(text)]
        assert len(pictures) == len(PLOTS)
        assert all(picture.width > 1000 for picture in pictures)
        assert not re.search(r'(src|href)="(?!data:)', text), "the page needs no other file"
    before = told["frame"]["frame_ms"]["p50"]
    assert f"<td>frame.frame_ms.p50</td><td>{before:g}</td></tr>" in alone
    assert f"<td>frame.frame_ms.p50</td><td>{before:g}</td><td>{2.0 * before:g}</td><td>2</td></tr>" in beside
    assert "9.9.9" in beside
    assert PICTURE.findall(alone) != PICTURE.findall(beside)

    monkeypatch.setattr(whole_page, "_embedded", lambda _: '<img src="data:image/png;base64,AA=="')
    without = now | {"scale": None}
    assert len(PICTURE.findall(page(without, told))) == len(PLOTS) - 1
    assert len(PICTURE.findall(page(now, told | {"scale": None}))) == len(PLOTS)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (None, "--against: old.json: No such file or directory"),
        ("{", "--against: old.json: this is no bench.json of `tallgrass bench all`"),
        ("[1]", "--against: old.json: this is no bench.json of `tallgrass bench all`"),
        ('{"frame_ms": {}}', "--against: old.json: this is no bench.json of `tallgrass bench all`"),
    ],
)
def test_what_cannot_be_compared_with_is_told_before_anything_is_measured(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], text: str | None, says: str
) -> None:
    monkeypatch.chdir(tmp_path)
    if text is not None:
        Path("old.json").write_text(text)
    assert run(["bench", "all", "plain", "-o", "new", "--against", "old.json"]) == 2
    assert capsys.readouterr().err == says + "\n"
    assert not Path("new").exists()


@pytest.mark.parametrize(
    ("package", "says"), [("matplotlib", "tallgrass[figures]"), ("flip_evaluator", "tallgrass[bench]")]
)
def test_without_what_all_benchmarks_take_it_is_said_what_installs_it(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], package: str, says: str
) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    assert run(["bench", "all", "plain", "-o", "new"]) == 1
    assert f"pip install '{says}'\n" in capsys.readouterr().err


def test_every_number_of_a_result_has_its_name() -> None:
    told = {"a": 1, "b": {"c": 2.5, "d": None, "e": "text", "f": True}, "rows": [{"g": 3}, {"g": 4}]}
    assert dict(figures(told)) == {"a": 1.0, "b.c": 2.5, "rows.0.g": 3.0, "rows.1.g": 4.0}
