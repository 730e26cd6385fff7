"""Defects planted into transitions, each of which `bench pop` must find (N2, N3)."""

import json
import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tallgrass.app.bench import pop, stroll
from tallgrass.app.bench.steps import Record
from tallgrass.app.bench.stroll import legs
from tallgrass.app.cli import run
from tallgrass.app.studio.studio import Studio
from tallgrass.components.arrays import Floats
from tallgrass.engine.gl import shaders
from tallgrass.systems.around.appearance import Appearance, appearance
from tallgrass.systems.around.patches import PatchTable
from tallgrass.systems.show.blades import painter as blades
from tallgrass.systems.show.strips import gather as strips
from tallgrass.systems.transition import weights

pytestmark = [pytest.mark.gl, pytest.mark.usefixtures("ctx")]

SCENE = """\
tallgrass: 2
terrain: { noise: flat, size: [60, 60] }
grass:
  tall: { height: [0.4, 0.6], width: 0.02, lean: 0.2, variety: 0.1, clumping: 0.0, gloss: 0.0 }
camera: { position: [0, 20], view: 65 }
quality:
  blades: 200
  models: 2
  blade_rings: [{ to: 2, segments: 2 }]
  strip_rings: [{ to: 10, strips: 4, columns: 2, sections: 2, texel: 0.01 }]
  carpet_to: 12
  carpet: 64
"""
Told = dict[str, Any]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("planted")


@pytest.fixture
def measure(folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Callable[[], Told]:
    """Measure a walk of one leg with the planted defect, in few frames, without the walk of hard switches."""
    walks = pop._walks  # noqa: SLF001

    def once(studio: Studio, walk: list[stroll.Leg], left_out: dict[str, Any], **how: Any) -> dict[str, Record]:
        (record,) = walks(studio, walk, {pop.WHOLE: left_out[pop.WHOLE]}, **how).values()
        return dict.fromkeys(left_out, record)

    monkeypatch.setattr(pop, "_walks", once)
    monkeypatch.setattr(stroll, "RATE", 20)
    monkeypatch.setattr(stroll, "PITCH", math.radians(-20.0))
    monkeypatch.setattr(pop, "MOST_PROCESSES", 1)
    monkeypatch.setattr(pop, "legs", lambda prairie: legs(prairie)[:1])
    path = folder / "scene.yaml"
    path.write_text(SCENE)

    def told() -> Told:
        assert run(["bench", "pop", str(path), "--size", "320x180", "--json"]) == 0
        return dict(json.loads(capsys.readouterr().out))

    return told


_SOUND: list[Told] = []


@pytest.fixture
def sound(measure: Callable[[], Told]) -> Told:
    """Result of the benchmark without a planted defect."""
    if not _SOUND:
        _SOUND.append(measure())
    return _SOUND[0]


@pytest.mark.slow
def test_n3_whole_changes_are_judged_in_every_frame(sound: Told) -> None:
    assert sound["judged"] == sound["frames"] == 28
    assert {row["change"] for row in sound["changes"]} >= {"carpet to strips", "strips to blades"}
    assert not {"flicker", "ghosting"} & set(sound["over"])
    assert sound["drift"]["mean"] < 0.08


@pytest.mark.slow
def test_n3_strips_that_are_too_bright_are_named_as_drift(
    sound: Told, measure: Callable[[], Told], monkeypatch: pytest.MonkeyPatch
) -> None:
    real = shaders.compose

    def brightened(name: str, *how: Any) -> tuple[str, list[shaders.Line]]:
        source, lines = real(name, *how)
        if name == "systems/show/strips/strips.frag":
            source = source.rstrip().removesuffix("}") + "    pixel.rgb *= 1.0 + 0.3 * root_pigment.a;\n}\n"
        return source, lines

    monkeypatch.setattr(shaders, "compose", brightened)
    told = measure()
    assert "drift" in told["over"]
    assert told["drift"]["mean"] > 2.0 * sound["drift"]["mean"]
    rows = {row["change"]: row for row in told["changes"]}
    assert rows["strips to blades"]["mean_drift"] == told["drift"]["mean"]


@pytest.mark.slow
def test_n3_a_jump_at_the_end_of_a_change_is_named_as_flicker(
    sound: Told, measure: Callable[[], Told], monkeypatch: pytest.MonkeyPatch
) -> None:
    real = weights

    def waited(patches: PatchTable, rows: Any) -> Floats:
        progress = np.where(patches.progress < 0.98, np.float32(0.02) * patches.progress, np.float32(1.0))
        return real(replace(patches, progress=progress), rows)

    monkeypatch.setattr("tallgrass.systems.see.weights", waited)
    told = measure()
    assert "flicker" in told["over"]
    assert told["flicker"]["ratio"] > 1.1 * sound["flicker"]["ratio"]
    end = (stroll.LEAD + 0.98 * 1.2) * stroll.RATE
    assert abs(told["worst"][0]["frame"] - end) <= 2


@pytest.mark.slow
def test_n3_two_representations_half_transparent_are_named_as_ghosting(
    sound: Told, measure: Callable[[], Told], monkeypatch: pytest.MonkeyPatch
) -> None:
    real = appearance

    def half(handed: Floats, *, fade: bool) -> tuple[Floats, Floats]:
        del fade
        both = (handed > 0.0) & (handed < 1.0)
        return np.where(both, np.float32(0.5), 1 - handed), np.where(both, np.float32(0.5), handed)

    def doubled(weight: Floats, kept: Floats, **options: Any) -> Appearance:
        made = real(weight, kept, **options)
        both = (weight[0] > 0.0) & (weight[1] > 0.0)
        still = np.where(both, np.float32(1e-4), made.morph)
        return replace(made, morph=still, handed=np.where(both, np.float32(0.5), made.handed))

    monkeypatch.setattr("tallgrass.systems.see.appearance", doubled)
    monkeypatch.setattr(blades, "handed_over", half)
    monkeypatch.setattr(strips, "handed_over", half)
    told = measure()
    assert "ghosting" in told["over"]
    assert told["ghosting"]["max"] > 2.0 * sound["ghosting"]["max"]
    assert told["ghosting"]["where"] == {"leg": "ahead", "change": "strips to blades"}
