"""What the tests of whole frames share: a stage to draw small pictures on, and prairies that are grown once."""

from collections.abc import Callable, Iterator
from pathlib import Path

import moderngl
import pytest

from tallgrass import testing
from tallgrass.engine.camera import Camera
from tallgrass.engine.gl import homes
from tallgrass.systems.prairie import Prairie
from tallgrass.testing import LITTLE, Stage, looking

BLOWN = LITTLE + "wind: [{ kind: breeze, strength: 0.4 }]\n"

Load = Callable[..., Prairie]


@pytest.fixture(scope="module")
def stage(ctx: moderngl.Context) -> Iterator[Stage]:
    """A stage of 160 by 90 pixels."""
    with testing.stage(ctx) as made:
        yield made


@pytest.fixture(scope="module")
def load(ctx: moderngl.Context, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Load]:
    """Load a scene from its text, or a bundled one by its name; all are released in the end."""
    loaded: list[Prairie] = []

    def scene(text: str = BLOWN, **options: object) -> Prairie:
        path: str | Path = text
        if "\n" in text:
            path = tmp_path_factory.mktemp("scene") / "scene.yaml"
            Path(path).write_text(text, "utf-8")
        loaded.append(Prairie.load(path, ctx=ctx, **options))  # type: ignore[arg-type]
        return loaded[-1]

    yield scene
    for prairie in loaded:
        prairie.release()
    assert not homes._left, "what is released in no context, or in another one, keeps hundreds of megabytes"  # noqa: SLF001


@pytest.fixture(scope="session")
def camera() -> Callable[..., Camera]:
    """Make a camera: `camera(x, y, z, yaw=, pitch=, view=)`."""
    return looking
