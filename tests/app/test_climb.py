"""The climb of `bench pop`: from eye height up, then a look straight down."""

import json
import math
from itertools import pairwise
from pathlib import Path

import pytest

from tallgrass.app.bench import pop, stroll
from tallgrass.app.bench.stroll import TOP, climb, moments
from tallgrass.app.cli import run
from tallgrass.app.studio.walker import EYE, FLY
from tallgrass.engine.camera import Camera
from tallgrass.systems.prairie import Prairie


def test_n2_a_climb_goes_up_without_a_break_and_ends_with_a_look_straight_down(scene: Path) -> None:
    prairie = Prairie.load(scene)
    flown: list[Camera] = []
    for leg in climb(prairie):
        cameras = [moment.camera for moment in moments(prairie, leg)]
        if flown:
            assert cameras[0].position == pytest.approx(flown[-1].position, abs=1e-6)
            assert cameras[0].pitch == pytest.approx(flown[-1].pitch)
        flown += cameras
    ground = float(prairie.height_at([flown[0].position[::2]])[0])
    assert flown[0].position[1] - ground == pytest.approx(EYE)
    assert flown[-1].position[1] - ground == pytest.approx(TOP)
    assert flown[0].pitch == pytest.approx(math.radians(-5.0))
    assert flown[-1].pitch == pytest.approx(math.radians(-90.0))
    for one, other in pairwise(flown):
        assert -1e-6 <= other.position[1] - one.position[1] <= FLY / stroll.RATE + 1e-6
        assert one.position[::2] == other.position[::2]
    prairie.release()


@pytest.mark.slow
@pytest.mark.gl
@pytest.mark.usefixtures("ctx")
def test_n2_changes_on_a_climb_are_judged_all_along_it(
    scene: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("flip_evaluator")
    monkeypatch.setattr(stroll, "RATE", 6)
    monkeypatch.setattr(pop, "MOST_PROCESSES", 1)
    monkeypatch.setattr(pop, "climb", lambda prairie: [climb(prairie)[number] for number in (0, -1)])
    assert run(["bench", "pop", str(scene), "--climb", "--size", "64x64", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["frames"] == 2 * 8
    assert {row["leg"] for row in told["worst"]} <= {"up-2", "tilt-69"}
    assert told["changing"]["max"] > 0
    assert told["hard_switch_ratio"] > 0.0
