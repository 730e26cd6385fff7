"""The benchmarks: what other people's scripts read, and what the project promises by them."""

import json
import sys

import pytest

from tallgrass.app.cli import run

COMMON = {"machine", "scene", "preset", "size", "frames"}
FRAME = COMMON | {
    "frame_ms", "draw_ms", "systems_ms", "systems_total_ms", "blades", "receivers", "draw_calls", "all_3d_ms",
    "ratio_to_all_3d", "floor_ms", "precompute_mb", "first_frame_ms", "rivals",
}  # fmt: skip
PICTURE = COMMON | {"flip", "score", "bands"}
pytestmark = pytest.mark.gl


@pytest.mark.usefixtures("ctx")
def test_n6_the_frame_benchmark_tells_every_key_of_the_contract(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["bench", "frame", "plain", "--preset", "low", "--size", "160x90", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told.keys() >= FRAME
    assert told["machine"].keys() == {"renderer", "gl", "cpu", "cores", "python", "version"}
    assert told["frame_ms"].keys() == {"p50", "p95", "p99"}
    assert told["first_frame_ms"]["cold"] > told["first_frame_ms"]["cached"] > 0.0
    assert told["blades"]["field"] == 40 * 40 * 160
    assert told["blades"]["field"] > told["blades"]["considered"] > told["blades"]["submitted"] > 0
    assert told["systems_total_ms"] >= max(told["systems_ms"].values())
    assert told["ratio_to_all_3d"] == pytest.approx(told["all_3d_ms"] / told["frame_ms"]["p50"], rel=0.01)
    assert told["all_3d_ms"] > told["floor_ms"]


@pytest.mark.usefixtures("ctx")
@pytest.mark.parametrize("scene", ["plain", "meadow", "hills"])
def test_g1_every_representation_is_as_bright_as_its_blades(scene: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["bench", "picture", scene, "--preset", "high", "--size", "480x270", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told.keys() >= PICTURE
    assert told["flip"]["lod"] < min(told["flip"]["all_3d"], told["flip"]["other_seed"])
    assert told["score"] < 0.0
    assert {band["representation"] for band in told["bands"]} == {"blades", "strips", "carpet"}
    for band in told["bands"]:
        assert band["luminance_ratio"] == pytest.approx(1.0, abs=0.07), band
        assert band["hue_degrees"] < 5.0, band


def test_without_the_evaluator_the_picture_benchmark_says_what_installs_it(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "flip_evaluator", None)
    assert run(["bench", "picture", "plain"]) == 1
    said = "pictures are compared by flip-evaluator: pip install 'tallgrass[bench]'"
    assert capsys.readouterr().err.strip() == said
