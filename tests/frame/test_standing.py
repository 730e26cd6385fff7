"""Frames in which only the time has changed cost the processor little, by number of calls (N11)."""

import sys
from collections.abc import Callable, Iterator
from typing import Any

import esper
import pytest

from tallgrass.components.patch import Patch
from tallgrass.engine.camera import Camera
from tallgrass.systems.around.outlook import Outlook
from tallgrass.systems.plant import Plant
from tallgrass.systems.prairie import Prairie
from tallgrass.testing import Phase, looking, step, watch

Stage = Any
Load = Callable[..., Prairie]
Aim = Callable[..., Camera]

GRASS = """\
tallgrass: 2
terrain: { noise: rolling, size: [120, 120] }
grass:
  tall: { height: [0.5, 0.9], width: 0.02, root: "#5a5a2c", tip: "#dcc98f" }
quality:
  blades: 20
  models: 2
  blade_rings: [{ to: 1, segments: 3 }]
  strip_rings: [{ to: 3, strips: 2, columns: 1, sections: 2, texel: 0.08 }]
  carpet_to: 20
  carpet: 16
"""
CALM = GRASS + "wind: [{ kind: breeze }]\n"
STORM = GRASS + (
    "wind: [{ kind: breeze }, { kind: gust, every: [1, 2] }, { kind: whirlwind, position: [3, -9] },\n"
    "  { kind: blast, body: saucer, path: [{ at: 0, position: [0, -9] }, { at: 60, position: [9, -20] }] }]\n"
)

FEWER = CALM.replace("carpet: 16", "carpet: 16\n  pixels: 0.5")
"""The scene with fewer pixels, which are enlarged."""

FRAMES = 40
"""Number of frames after which all transitions of a new viewer are over."""

CALLS = 1720, 2455, 2015
"""What a frame may call in calm air, in a storm and with fewer pixels, in Python and from there in C: they were 1690,
2424 and 1985."""


LAST = 5
"""Of which so many are counted, and the least counts: in any one, Python may tidy up after others."""


@pytest.fixture(autouse=True)
def _alone() -> Iterator[None]:
    """Entities of other tests' prairies would take a call each, to ask whether they are this one's."""
    before = esper.current_world
    esper.switch_world("standing")
    yield
    esper.switch_world(before)
    esper.delete_world("standing")


def calls(stage: Stage, prairie: Prairie, camera: Camera) -> int:
    """Return the number of calls in a frame after all transitions of a new viewer."""
    counts: list[int] = []

    def noted(_frame: object, event: str, _argument: object) -> None:
        counts[-1] += event in ("call", "c_call")

    for frame in range(FRAMES):
        prairie.advance(1 / 60)
        stage.begin()
        matrices = stage.matrices(camera)
        counts.append(0)
        sys.setprofile(noted if frame >= FRAMES - LAST else None)
        prairie.draw(*matrices)
        sys.setprofile(None)
    return min(counts[-LAST:])


def test_n2_a_frame_of_a_viewer_who_stands_calls_little(stage: Stage, load: Load, camera: Aim) -> None:
    here = camera(0.0, 4.0, 20.0, pitch=-10)
    found = [calls(stage, load(scene), here) for scene in (CALM, STORM, FEWER)]
    assert all(many < most for many, most in zip(found, CALLS, strict=True)), found


def test_r3_for_a_viewer_who_stands_nothing_is_planted_until_an_entity_goes(load: Load, monkeypatch: Any) -> None:
    prairie, planted = load(CALM), list[float]()
    run = Plant._run  # noqa: SLF001

    def noted(system: Plant, outlook: Outlook) -> None:
        planted.append(prairie.time)
        run(system, outlook)

    monkeypatch.setattr(Plant, "_run", noted)

    def stand() -> int:
        for _ in range(FRAMES):
            prairie.advance(1 / 60)
            watch(prairie, looking(0.0, 4.0, 20.0, pitch=-10))
            step(prairie, Phase.BLOW)
        return len(planted)

    came = stand()
    assert stand() == came > 1
    entity, _ = prairie.world.all(Patch)[0]
    esper.delete_entity(entity, immediate=True)
    assert came < stand() < came + FRAMES
