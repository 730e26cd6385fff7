"""`bench pop`: its figures, and that it finds a pop (N3)."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from tallgrass.app.bench import pop, stroll
from tallgrass.app.bench import truth as truth_of_walk
from tallgrass.app.bench.flicker import TILE
from tallgrass.app.bench.pop import HARD
from tallgrass.app.bench.steps import Record, merged, walked
from tallgrass.app.bench.stroll import legs, moments
from tallgrass.app.bench.truth import Truth
from tallgrass.app.bench.verdict import Step
from tallgrass.app.cli import run
from tallgrass.app.studio.studio import Studio
from tallgrass.app.studio.take import Take
from tallgrass.components.arrays import Point
from tallgrass.systems.around.transitions import SEAMLESS
from tallgrass.systems.reference import Truth as Drawn
from tallgrass.systems.reference import draw_truth

pytestmark = [pytest.mark.gl, pytest.mark.usefixtures("ctx")]

POP = {
    "machine", "scene", "preset", "size", "frames", "judged", "error", "flicker", "hard_switch_ratio", "drift",
    "ghosting", "over", "changing", "changes", "worst",
}  # fmt: skip

SCENE = """\
tallgrass: 2
seed: 2
terrain: { noise: flat, size: [60, 60] }
grass:
  tall: { height: [0.5, 0.9], width: 0.03, root: "#5a5a2c", tip: "#dcc98f" }
wind: [{ kind: breeze, strength: 0.2 }]
camera: { position: [0, 20], yaw: 20, view: 35 }
quality:
  blades: 60
  models: 2
  blade_rings: [{ to: 1, segments: 2 }]
  strip_rings: [{ to: 6, strips: 3, columns: 2, sections: 2, texel: 0.02 }]
  carpet_to: 10
  carpet: 32
"""


@pytest.fixture
def scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Make the benchmark walk one leg of a small scene, in few frames."""
    monkeypatch.setattr(stroll, "RATE", 30)
    monkeypatch.setattr(stroll, "SECONDS", 0.3)
    monkeypatch.setattr(pop, "MOST_PROCESSES", 1)
    monkeypatch.setattr(pop, "legs", lambda prairie: legs(prairie)[:1])
    path = tmp_path / "scene.yaml"
    path.write_text(SCENE)
    return path


def unwatched(steps: Iterator[Step], **_: int) -> Iterator[Step]:
    return steps


def told(record: Record) -> list[tuple[str, int, tuple[int, int], float]]:
    return [(each.step.moment.leg.name, each.step.moment.number, each.corner, each.ratio) for each in record.worst]


@pytest.mark.slow
def test_n3_the_pop_benchmark_tells_every_key_and_sees_a_pop(scene: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = scene.parent / "worst"
    assert run(["bench", "pop", str(scene), "--size", "192x108", "--parts", "--json", "-o", str(folder)]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told.keys() == POP | {"contributions"}
    assert told["frames"] == 9
    assert told["error"].keys() == {"p50", "max"}
    assert 0.0 < told["error"]["p50"] <= told["error"]["max"] < 1.0
    flicker = told["flicker"]
    assert flicker.keys() == {"steady", "transition_max", "ratio"}
    assert flicker["ratio"] == pytest.approx(flicker["transition_max"] / flicker["steady"], rel=0.01)
    assert told["hard_switch_ratio"] > flicker["ratio"]
    assert told["drift"].keys() == {"max", "mean", "where"}
    assert told["ghosting"].keys() == {"max", "where"}
    for row in told["changes"]:
        assert row.keys() == {"change", "patches", "drift", "mean_drift", "ghosting"}
    assert told["changing"]["max"] > told["changing"]["mean"] > 0.0
    assert [row["ratio"] for row in told["worst"]] == sorted((row["ratio"] for row in told["worst"]), reverse=True)
    names = [f"{rank}-{row['leg']}-{row['frame']:03}.png" for rank, row in enumerate(told["worst"], 1)]
    assert sorted(path.name for path in folder.iterdir()) == names
    assert np.asarray(Image.open(folder / names[0])).shape == (108, 2 * 192, 3)
    rows = {row["without"]: row for row in told["contributions"]}
    assert rows.keys() == {"nothing", "morph", "fade", "growth", "hysteresis", "morph, fade, growth"}
    assert rows["nothing"]["ratio"] == flicker["ratio"]
    assert rows["morph, fade, growth"]["ratio"] == told["hard_switch_ratio"]
    assert rows["hysteresis"]["changing"] >= rows["nothing"]["changing"] == told["changing"]["mean"]


def test_n3_hard_switches_show_where_they_happen(scene: Path) -> None:
    with Studio(Take(str(scene), (128, 72))) as studio:
        walk = legs(studio.prairie)[:1]
        once = walked(studio, walk, SEAMLESS, watch=unwatched)
        hard = walked(studio, walk, HARD, watch=unwatched)
    assert len(once.changing) == 9
    worst = hard.worst[0]
    border = round(stroll.LEAD * stroll.RATE)
    assert abs(worst.step.moment.number - border) <= 1
    assert worst.step.changing > 5
    assert worst.jump > 2.5 * once.worst[0].jump
    assert worst.ratio - 1.0 > 3.0 * (once.worst[0].ratio - 1.0)
    assert once.worst[0].ratio < worst.ratio


@pytest.mark.slow
def test_n3_legs_that_are_walked_alone_are_those_of_the_whole_walk(scene: Path) -> None:
    with Studio(Take(str(scene), (128, 72))) as studio:
        walk = legs(studio.prairie)[:2]
        whole = walked(studio, walk, SEAMLESS, watch=unwatched)
        alone = [walked(studio, walk, SEAMLESS, watch=unwatched, only=number) for number in range(2)]
    parts = merged(alone)
    assert told(parts) == told(whole)
    assert (parts.changing, parts.judged) == (whole.changing, whole.judged)
    assert len({each.worst[0].ratio for each in alone}) == 2
    assert len(parts.stills) == len(whole.stills)
    for ours, theirs in zip(parts.stills, whole.stills, strict=True):
        np.testing.assert_array_equal(ours, theirs)
    assert [change.name for change in parts.changes] == [change.name for change in whole.changes]
    for one, other in zip(parts.changes, whole.changes, strict=True):
        np.testing.assert_array_equal(one.bright, other.bright)
        np.testing.assert_array_equal(one.ghosted, other.ghosted)


def test_n3_frames_that_are_not_held_against_the_reference_show_less_than_those_that_are_told_of(scene: Path) -> None:
    with Studio(Take(str(scene), (192, 108))) as studio:
        hard = walked(studio, legs(studio.prairie)[:1], HARD, watch=unwatched, kept=1)
    assert len(hard.worst) <= hard.judged < len(hard.changing)


def test_n3_a_tile_of_the_reference_is_cut_from_it_and_its_trees_are_chosen_once_for_the_leg(
    scene: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen_at = list[tuple[Point, ...]]()

    def drawn(*given: Any, **keys: Any) -> Drawn:
        seen_at.append(keys["seen_at"])
        return draw_truth(*given, **keys)

    monkeypatch.setattr(truth_of_walk, "draw_truth", drawn)
    with Studio(Take(str(scene), (192, 108))) as studio:
        walk = legs(studio.prairie)[:1]
        first, then = list(moments(studio.prairie, walk[0]))[2:4]
        with Truth(studio, walk) as truth:
            near, tile = truth.near(first), truth.tile(first, (89, 49))
            later = truth.tile(then, (89, 49))
    cut = near[48 : 50 + TILE, 88 : 90 + TILE]
    assert tile.shape == cut.shape
    assert np.abs(tile.astype(int) - cut).mean() < 0.1
    assert np.abs(later.astype(int) - cut).mean() > 1.0
    assert len(set(seen_at)) == 1
    assert {first.camera.position, then.camera.position} < set(seen_at[0])


def test_n3_a_picture_too_small_to_compare_is_refused_in_a_line(
    scene: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["bench", "pop", str(scene), "--size", "320x30"]) == 2
    assert capsys.readouterr().err == "--size: 320x30: here each side must be at least 38 pixels\n"
