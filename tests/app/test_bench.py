"""The benchmarks: what other people's scripts read, and what the project promises by them."""

import json
import sys
from pathlib import Path

import numpy as np
import pytest

from tallgrass.app.bench import stroll
from tallgrass.app.bench.scale import stretched
from tallgrass.app.cli import run
from tallgrass.engine.scene import read_scene

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
    assert run(["bench", "picture", scene, "--preset", "high", "--size", "384x216", "--json"]) == 0
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


@pytest.mark.usefixtures("ctx")
def test_r2_the_walk_benchmark_tells_every_key_of_the_contract(
    scene: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(stroll, "RATE", 10)
    assert run(["bench", "walk", str(scene), "--size", "96x54", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told.keys() == COMMON | {"frame_ms", "p99_over_p50", "busy_over_p50", "transitions", "rss_mb"}
    assert told["frames"] % 14 == 0
    times = told["frame_ms"]
    assert 0.0 < times["p50"] <= times["p95"] <= times["p99"] <= times["max"]
    assert told["p99_over_p50"] == pytest.approx(times["p99"] / times["p50"], rel=0.01)
    assert told["transitions"] > 10
    assert told["rss_mb"]["end"] > 50.0


def test_n6_the_scale_benchmark_has_a_row_for_each_terrain(
    scene: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tallgrass.app.bench.scale.SIDES", (100.0, 300.0))
    assert run(["bench", "scale", str(scene), "--size", "96x54", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told.keys() == COMMON | {"rows"}
    assert [row["terrain_m"] for row in told["rows"]] == [100.0, 300.0]
    for row in told["rows"]:
        assert row.keys() == {"terrain_m", "frame_ms", "rss_mb", "first_frame_ms"}
        assert row["first_frame_ms"] > row["frame_ms"] > 0.0
        assert row["rss_mb"] > 50.0


def test_a_stretched_scene_keeps_its_camera_on_it(scene: Path) -> None:
    small = stretched(read_scene(scene), 20.0)
    assert small.scene.terrain.size == [20.0, 20.0]
    assert small.scene.camera.position == [0.0, 9.5]
    assert small.scene.camera.path == []
    assert stretched(read_scene(scene), 900.0).scene.camera.position == [0.0, 20.0]


def test_a_terrain_from_a_file_cannot_be_made_larger_and_that_is_told_in_a_line(
    scene: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    np.save(scene.parent / "hills.npy", np.zeros((70, 70), np.float32))
    scene.write_text(scene.read_text().replace("noise: rolling, size: [60, 60], scale: 3", "heights: hills.npy"))
    assert run(["bench", "scale", str(scene)]) == 2
    assert capsys.readouterr().err == f"{scene}: its terrain comes from a file; only one from noise can be stretched\n"
