"""What the tests of whole frames share: a stage to draw small pictures on, and prairies that are grown once."""

from collections.abc import Callable, Iterator
from pathlib import Path

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass import testing
from tallgrass.engine.camera import Camera
from tallgrass.systems.around.receivers import Receiving
from tallgrass.systems.prairie import Prairie
from tallgrass.testing import LITTLE, Stage, looking

BLOWN = LITTLE + "wind: [{ kind: breeze, strength: 0.4 }]\n"

Load = Callable[..., Prairie]
OnCard = list[tuple[Receiving, NDArray[np.float32]]]


@pytest.fixture(scope="module")
def stage(ctx: moderngl.Context) -> Iterator[Stage]:
    """A stage of 160 by 90 pixels."""
    with testing.stage(ctx) as made:
        yield made


@pytest.fixture(scope="module")
def load(ctx: moderngl.Context, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Load]:
    """Load a scene from its text, or a bundled one by its name; all are released in the end."""
    loaded: list[Prairie] = []

    def scene(text: str = BLOWN, **options: str) -> Prairie:
        path: str | Path = text
        if "\n" in text:
            path = tmp_path_factory.mktemp("scene") / "scene.yaml"
            Path(path).write_text(text, "utf-8")
        loaded.append(Prairie.load(path, ctx=ctx, **options))  # type: ignore[arg-type]
        return loaded[-1]

    yield scene
    for prairie in loaded:
        prairie.release()


@pytest.fixture(scope="session")
def on_card() -> Callable[[Prairie], OnCard]:
    """Read what the graphics card told receivers of blades and strips in the last frame, by their pools.

    Of each receiver of the patches shown: message, height of the ground, density of its kind, shape (m, n, 4).
    """

    def read(prairie: Prairie) -> OnCard:
        painter, outlook = prairie.painter, prairie.viewers["main"]
        assert painter is not None
        counts = {name: each.receivers(outlook) for name, each in painter.painters.items()}
        numbers = iter(painter.received.lay([count for each in counts.values() for count in each]))
        texels = np.frombuffer(painter.received.texture.read(), np.float32).reshape(-1, 4)
        found: OnCard = []
        for name, each in counts.items():
            for receiving, count, first in zip(outlook.kept[name].receiving, each, numbers, strict=False):
                if not receiving.still:
                    shape = len(receiving.slots), int(np.prod(receiving.pool.shape)), 4
                    found.append((receiving, texels[first : first + count].reshape(shape)))
        return found

    return read


@pytest.fixture(scope="session")
def camera() -> Callable[..., Camera]:
    """Make a camera: `camera(x, y, z, yaw=, pitch=, view=)`."""
    return looking
