"""Benchmarks: the figures that scripts read, and the limits that the project promises."""

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any
from unittest.mock import Mock

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from tallgrass.app.bench import machine, picture, processor, stroll
from tallgrass.app.bench.flip import MOMENT
from tallgrass.app.bench.rivals import Rivals
from tallgrass.app.bench.scale import stretched
from tallgrass.app.bench.still import Still
from tallgrass.app.bench.walk import walked_frames
from tallgrass.app.cli import run
from tallgrass.app.studio import timing
from tallgrass.app.studio.studio import Studio
from tallgrass.app.studio.take import Take
from tallgrass.app.studio.timing import card_timer
from tallgrass.engine.camera import Camera, projection_matrix, view_matrix, view_of
from tallgrass.engine.gl import rasteriser
from tallgrass.engine.scene import read_scene
from tallgrass.systems.reference import draw_truth, patch_distances
from tallgrass.systems.space.frustum import outside_planes, picture_sides

COMMON = {"machine", "scene", "preset", "size", "frames"}
FRAME = COMMON | {
    "frame_ms", "draw_ms", "systems_ms", "systems_total_ms", "blades", "receivers", "draw_calls", "all_3d_ms",
    "ratio_to_all_3d", "floor_ms", "precompute_mb", "first_frame_ms", "rivals", "cpu_ms", "cpu_by_system_ms", "gpu_ms",
    "seen_3d_ms", "ratio_to_seen_3d", "yardstick_ms", "cpu_over_yardstick", "animation_ms", "animation_part",
}  # fmt: skip
NARROW = (160, 216)
"""Size of a picture that shows the same distances as a wide one, with less than half of its blades [pixels]."""

PICTURE = COMMON | {"flip", "score", "score_msaa", "contrast", "bands"}
pytestmark = pytest.mark.gl


@pytest.fixture
def few_frames(monkeypatch: pytest.MonkeyPatch) -> None:
    """Make the frame benchmark draw a few frames, and the walk even fewer."""
    for name, value in (("FRAMES", 6), ("EVERY", 3), ("TURN", 3)):
        monkeypatch.setattr(f"tallgrass.app.bench.frame.{name}", value)
    monkeypatch.setattr(stroll, "RATE", 10)


def ratio(of_told: float) -> Any:
    """Return about a ratio of two reported times: they are rounded to microseconds, their ratio to hundredths."""
    return pytest.approx(of_told, rel=0.001, abs=0.005)


def _draws_nothing() -> bool:
    program = "from tallgrass.app.bench.processor import draws_nothing; print(draws_nothing())"
    child = subprocess.run(
        [sys.executable, "-c", program], env=os.environ | processor.NOOP, capture_output=True, text=True, check=False
    )
    return child.stdout.strip() == "True"


def _tells_of_the_cpu_alone(told: dict[str, Any]) -> None:
    assert told["cpu_ms"].keys() == {"p50", "p95"}
    assert 0.0 < told["cpu_ms"]["p50"] <= told["cpu_ms"]["p95"]
    assert told["cpu_by_system_ms"].keys() == told["systems_ms"].keys()
    assert max(told["cpu_by_system_ms"].values()) < told["cpu_ms"]["p50"]
    assert told["cpu_over_yardstick"] > 0.0


def _compares_rivals(told: dict[str, Any]) -> None:
    """Rivals are drawn from the same camera, and their pictures compared at the same time."""
    assert told["rivals"][0]["name"] == "by hand"
    for row in told["rivals"]:
        assert row.keys() == {"name", "frame_ms", "ratio", "flip"}
        assert row["ratio"] == ratio(row["frame_ms"] / told["frame_ms"]["p50"])
        assert 0.0 < row["flip"] < 0.3


@pytest.mark.slow
@pytest.mark.usefixtures("ctx", "few_frames")
def test_n6_the_frame_benchmark_tells_every_key_of_the_contract_and_what_the_cpu_and_rivals_take(
    scene: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["bench", "frame", str(scene), "--size", "160x90", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told.keys() >= FRAME
    assert told["machine"].keys() == {"renderer", "gl", "cpu", "cores", "python", "version"}
    assert told["frame_ms"].keys() == {"p50", "p95", "p99"}
    assert told["first_frame_ms"]["cold"] > told["first_frame_ms"]["cached"] > 0.0
    assert told["blades"]["field"] == 24 * 24 * 40
    assert told["blades"]["field"] > told["blades"]["considered"] > told["blades"]["submitted"] > 0
    assert told["systems_total_ms"] >= max(told["systems_ms"].values())
    assert told["ratio_to_all_3d"] == ratio(told["all_3d_ms"] / told["frame_ms"]["p50"])
    assert told["systems_ms"]["press"] + told["systems_ms"]["wind"] < told["animation_ms"] < told["frame_ms"]["p50"]
    assert told["all_3d_ms"] > told["floor_ms"]
    assert told["seen_3d_ms"] > told["floor_ms"]
    assert told["ratio_to_seen_3d"] == ratio(told["seen_3d_ms"] / told["frame_ms"]["p50"])
    assert told["yardstick_ms"] > 0.0
    if _draws_nothing():
        _tells_of_the_cpu_alone(told)
    _compares_rivals(told)


@pytest.mark.slow
@pytest.mark.usefixtures("ctx", "few_frames")
def test_where_the_driver_always_draws_none_is_told_of_the_cpu_alone_and_without_the_evaluator_none_of_flip(
    scene: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "flip_evaluator", None)
    monkeypatch.setattr(processor, "NOOP", {"GALLIUM_NOOP": "0"})
    assert run(["bench", "frame", str(scene), "--size", "96x54", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert [told[key] for key in told if key.startswith("cpu_")] == [None] * 3
    assert told["yardstick_ms"] > 0.0
    assert [row["flip"] for row in told["rivals"]] == [None] * len(told["rivals"])
    assert told["rivals"]


def test_a_child_that_fails_tells_nothing(scene: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert processor.on_processor(walked_frames, Take(str(scene), (96, 54), "none such")) is None
    capfd.readouterr()


@pytest.mark.parametrize(
    "renderer",
    [
        "llvmpipe (LLVM 15.0.6, 256 bits)",
        "softpipe",
        "NOOP",
        "virgl (LLVMPIPE (LLVM 15.0.6, 256 bits))",
        "Apple Software Renderer",
    ],
)
def test_a_software_rasteriser_has_no_card_to_time(renderer: str, monkeypatch: pytest.MonkeyPatch) -> None:
    ctx = Mock()
    monkeypatch.setattr(timing, "draws_in_software", lambda _: rasteriser.is_software(renderer))
    assert card_timer(ctx) is None
    ctx.query.assert_not_called()


def test_a_graphics_card_is_timed_by_its_own_clock(
    ctx: moderngl.Context, scene: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(rasteriser, "SOFTWARE", ("none such",))
    monkeypatch.setattr("tallgrass.app.bench.still.WARM_UP", 1)
    with Studio(Take(str(scene), (96, 54))) as studio:
        still, timer = Still(studio), card_timer(ctx)
        assert timer is not None
        assert still.step(timer) > 0.0
        assert timer.elapsed > 0


@pytest.mark.slow
@pytest.mark.usefixtures("few_frames")
def test_a_rival_is_drawn_with_grass_that_sways(ctx: moderngl.Context, scene: Path) -> None:
    with Studio(Take(str(scene), (192, 108))) as studio:
        still = Still(studio)
        rivals = Rivals(still)
        pictures = []
        for dt in (0.0, 0.0, 0.4):
            studio.prairie.advance(dt)
            rivals.measure()
            pictures.append(studio.read().astype(int))
        bare = _bare_ground(still)
        rivals.release()
    assert np.array_equal(pictures[0], pictures[1])
    assert (pictures[1] != pictures[2]).any(axis=-1).mean() > 0.05
    assert (pictures[0] != bare).any(axis=-1).mean() > 0.05
    assert ctx.error == "GL_NO_ERROR"


def _bare_ground(still: Still) -> NDArray[np.int64]:
    painter = still.studio.prairie.painter
    assert painter is not None
    still.studio.begin()
    painter.draw(still.view, blades=[])
    return still.studio.read().astype(np.int64)


def test_the_frustum_holds_what_a_picture_shows_and_nothing_behind_or_far_aside() -> None:
    camera = Camera((0.0, 1.0, 0.0), 0.0, 0.0, 1.0)
    view = view_of(view_matrix(camera), projection_matrix(camera.view, 1.0))
    middle = np.array([[0, 1, -5], [0, 1, 5], [9, 1, -5], [3.5, 1, -5], [0, 9, -5]], np.float32)
    radius = np.full(5, 1.0, np.float32)
    assert (outside_planes(middle, picture_sides(view, ends=True)) <= radius).tolist() == [
        True,
        False,
        False,
        True,
        False,
    ]


def test_the_yardstick_is_the_least_of_its_timings(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = iter([0.0, 3.0, 3.0, 4.0, 4.0, 9.0])
    monkeypatch.setattr(machine, "TIMINGS", 3)
    monkeypatch.setattr(machine, "perf_counter", lambda: next(clock))
    assert machine.yardstick_ms() == 1000.0


@pytest.mark.slow
@pytest.mark.usefixtures("ctx")
def test_g1_the_plain_is_truer_than_every_blade_alone_and_its_representations_as_bright(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert run(["bench", "picture", "plain", "--preset", "medium", "--size", f"{NARROW[0]}x{NARROW[1]}", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told.keys() >= PICTURE
    assert told["flip"]["lod"] < min(told["flip"]["all_3d"], told["flip"]["other_seed"])
    assert told["score"] < 0.0
    assert told["flip"]["msaa"] < told["flip"]["all_3d"]
    lod, msaa, other = (told["flip"][name] for name in ("lod", "msaa", "other_seed"))
    assert told["score_msaa"] == pytest.approx((lod - msaa) / abs(other - msaa), rel=0.02)
    assert 0.1 < told["contrast"] < 1.1
    _are_as_bright_as_blades(told["bands"])


@pytest.mark.slow
@pytest.mark.usefixtures("ctx")
def test_g1_in_the_meadow_every_representation_is_as_bright_as_its_blades() -> None:
    with Studio(Take("meadow", NARROW, "high")) as studio:
        prairie = studio.prairie
        prairie.advance(MOMENT)
        matrices = studio.matrices(studio.camera(None))
        studio.begin()
        prairie.draw(*matrices)
        seen = studio.read()
        true = draw_truth(prairie, *matrices, NARROW, samples=4).picture
        distance = patch_distances(prairie, *matrices, NARROW)
        _are_as_bright_as_blades(picture.bands(seen, true, distance, prairie.site.quality))


def _are_as_bright_as_blades(bands: list[dict[str, Any]]) -> None:
    assert {band["representation"] for band in bands} == {"blades", "strips", "carpet"}
    for band in bands:
        assert band["luminance_ratio"] == pytest.approx(1.0, abs=0.075), band
        assert band["hue_degrees"] < 5.0, band


@pytest.mark.usefixtures("ctx")
def test_of_a_folder_every_scene_has_a_row_and_a_picture_beside_its_reference(
    scene: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("flip_evaluator")
    folder, pictures = scene.parent, scene.parent / "pictures"
    (folder / "again.yaml").write_text(scene.read_text())
    command = ["bench", "picture", str(folder), "--size", "48x27"]
    assert run([*command, "--json", "-o", str(pictures)]) == 0
    told = json.loads(capsys.readouterr().out)
    assert [row["camera"] for row in told["rows"]] == ["again", "little"]
    assert told["rows"][0] | {"camera": "little"} == told["rows"][1]
    assert np.asarray(Image.open(pictures / "little.png")).shape == (27, 2 * 48, 3)
    (folder / "again.yaml").unlink()
    assert run(command) == 0
    head, line = (text.split() for text in capsys.readouterr().out.splitlines())
    assert dict(zip(head, line, strict=True))["flip"] == str(told["rows"][1]["flip"])
    assert run(["bench", "picture", str(pictures)]) == 2
    assert capsys.readouterr().err == f"{pictures}: there is no scene in this folder\n"


def test_without_the_evaluator_the_picture_benchmark_says_what_installs_it(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "flip_evaluator", None)
    assert run(["bench", "picture", "plain"]) == 1
    said = "pictures are compared by flip-evaluator: pip install 'tallgrass[bench]'"
    assert capsys.readouterr().err.strip() == said


@pytest.mark.slow
@pytest.mark.usefixtures("ctx")
def test_r2_n6_the_walk_benchmark_tells_every_key_of_the_contract(
    scene: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """If the driver always draws, the CPU's own figures are None."""
    monkeypatch.setattr(stroll, "RATE", 10)
    monkeypatch.setattr(processor, "NOOP", {"GALLIUM_NOOP": "0"})
    assert run(["bench", "walk", str(scene), "--size", "96x54", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told.keys() == COMMON | {
        "frame_ms", "p99_over_p50", "transitions", "rss_mb", "cpu_ms", "yardstick_ms",
    }  # fmt: skip
    assert told["frames"] % 14 == 0
    times = told["frame_ms"]
    assert 0.0 < times["p50"] <= times["p95"] <= times["p99"] <= times["max"]
    assert told["p99_over_p50"] == ratio(times["p99"] / times["p50"])
    assert told["transitions"] > 10
    assert told["cpu_ms"] is None
    assert told["rss_mb"]["end"] > 50.0


@pytest.mark.slow
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
