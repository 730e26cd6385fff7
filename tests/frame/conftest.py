"""Fixtures of tests of whole frames: a stage for small pictures, and prairies that are grown once."""

from collections.abc import Callable, Iterator
from pathlib import Path

import moderngl
import numpy as np
import pytest

from tallgrass import testing
from tallgrass.components.arrays import Floats
from tallgrass.engine.camera import Camera
from tallgrass.engine.gl import homes
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.trees import kind
from tallgrass.testing import LITTLE, Stage, looking

BLOWN = LITTLE + "wind: [{ kind: breeze, strength: 0.4 }]\n"

Load = Callable[..., Prairie]


@pytest.fixture(scope="module")
def stage(ctx: moderngl.Context) -> Iterator[Stage]:
    """A stage of 160 by 90 pixels."""
    with testing.stage(ctx) as made:
        yield made


@pytest.fixture(scope="module")
def prairies(request: pytest.FixtureRequest, ctx: moderngl.Context) -> Iterator[dict[str, Prairie]]:
    """Prairies of the module's `SCENE`, by the one representation that each shows."""
    scene = request.module.SCENE
    made = {lod: Prairie.load(scene, ctx=ctx, lod=lod, live=False) for lod in ("blades", "strips", "carpet")}
    yield made
    for prairie in made.values():
        prairie.release()


@pytest.fixture(scope="module")
def _loaded() -> Iterator[list[Prairie]]:
    """Prairies that are loaded and not released yet."""
    loaded: list[Prairie] = []
    yield loaded
    for prairie in loaded:
        prairie.release()
    assert not homes._pending, "what waits for its context keeps hundreds of megabytes"  # noqa: SLF001


@pytest.fixture(scope="module")
def load(ctx: moderngl.Context, _loaded: list[Prairie], tmp_path_factory: pytest.TempPathFactory) -> Load:
    """Return the function that loads a scene from its text, or a bundled one by its name.

    A prairie that a test loads is released after the test; one that a fixture of its module loads, after the module.
    """

    def scene(text: str = BLOWN, **options: object) -> Prairie:
        path: str | Path = text
        if "\n" in text:
            path = tmp_path_factory.mktemp("scene") / "scene.yaml"
            Path(path).write_text(text, "utf-8")
        _loaded.append(Prairie.load(path, ctx=ctx, **options))  # type: ignore[arg-type]
        return _loaded[-1]

    return scene


@pytest.fixture(autouse=True)
def _what_a_test_loads_is_released(request: pytest.FixtureRequest) -> Iterator[None]:
    """Release the test's prairies: each that was drawn holds 80 to 180 MB of programs in a software rasteriser."""
    if "load" not in request.fixturenames:
        yield
        return
    loaded: list[Prairie] = request.getfixturevalue("_loaded")
    before = len(loaded)
    yield
    for prairie in loaded[before:]:
        prairie.release()
    del loaded[before:]


@pytest.fixture
def pictured(monkeypatch: pytest.MonkeyPatch) -> Callable[[int], None]:
    """Return the function that gives all texels of trees' pictures one value: drawing them takes longer than tests."""

    def all_of(value: int) -> None:
        def even(_: object, columns: int, rows: int, wide: int, tall: int, _draw: object) -> Floats:
            return np.full((2, rows * tall, columns * wide, 4), value, np.float32)

        monkeypatch.setattr(kind, "pictures", even)
        monkeypatch.setattr(kind, "kept_pictures", lambda _: None)
        monkeypatch.setattr(kind, "keep_pictures", lambda *_: None)

    return all_of


@pytest.fixture
def unpictured(pictured: Callable[[int], None]) -> None:
    """Make pictures of trees all white, for tests that do not see them."""
    pictured(255)


@pytest.fixture(scope="session")
def camera() -> Callable[..., Camera]:
    """Return the function that makes a camera: `camera(x, y, z, yaw=, pitch=, view=)`."""
    return looking
