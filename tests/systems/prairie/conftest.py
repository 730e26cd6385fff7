"""Fixtures of a small prairie that must not touch GL."""

from collections.abc import Callable, Iterator
from pathlib import Path

import esper
import moderngl
import pytest

from tallgrass.engine.world import World
from tallgrass.systems.prairie import Prairie

Load = Callable[..., Prairie]

SCENE = """\
tallgrass: 2
seed: 5
terrain: { noise: rolling, seed: 2, size: [60, 60], feature: 30, scale: 4 }
grass: { green: { height: [0.3, 0.5] } }
wind:
  - { kind: breeze, strength: 0.4 }
  - { kind: breeze, strength: 0.8, start: 5, stop: 6, priority: 1 }
quality:
  blades: 20
  models: 1
  blade_rings: [{ to: 1, segments: 2 }]
  strip_rings: [{ to: 3, strips: 2, columns: 1, sections: 1, texel: 0.1 }]
  carpet_to: 5
  carpet: 8
"""


@pytest.fixture
def load(world: World, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Load]:
    """Return the function that loads the scene in a world of its own; touching GL fails."""

    def no_gl(*_: object, **__: object) -> None:
        raise AssertionError("GL was touched")

    monkeypatch.setattr(moderngl, "get_context", no_gl)
    monkeypatch.setattr(moderngl, "create_context", no_gl)
    path = tmp_path / "scene.yaml"
    path.write_text(SCENE, "utf-8")
    assert world.name == esper.current_world
    loaded: list[Prairie] = []

    def scene(file: str | Path = path, **options: str) -> Prairie:
        loaded.append(Prairie.load(file, **options))  # type: ignore[arg-type]
        return loaded[-1]

    yield scene
    for prairie in loaded:
        prairie.release()


@pytest.fixture
def prairie(load: Load) -> Prairie:
    return load()
