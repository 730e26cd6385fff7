"""Bare ground shows its soil, however far off (T1, G4)."""

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import moderngl
import numpy as np
import pytest
from PIL import Image

from tallgrass.engine.camera import Camera
from tallgrass.engine.gl import rasteriser
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.reference import draw_truth
from tallgrass.testing import LITTLE, Stage

Load = Callable[..., Prairie]
Aim = Callable[..., Camera]

SOIL = """\
tallgrass: 2
terrain: { size: [200, 200] }
grass:
  turf: { blades: 60, place: { map: none.png } }
light: { ground: "#d9c48f" }
"""


@pytest.fixture(scope="module")
def small(ctx: moderngl.Context) -> Iterator[Stage]:
    """A small stage, wide enough for the far ground."""
    made = Stage(ctx, (240, 135))
    yield made
    made.release()


@pytest.fixture
def bare(ctx: moderngl.Context, tmp_path: Path) -> Iterator[Load]:
    """Return the function that loads `SOIL`, on which nothing grows; it releases all prairies in the end."""
    Image.fromarray(np.zeros((8, 8), np.uint8)).save(tmp_path / "none.png")
    (tmp_path / "bare.yaml").write_text(SOIL, "utf-8")
    with ExitStack() as stack:

        def scene(**options: str) -> Prairie:
            prairie = Prairie.load(tmp_path / "bare.yaml", ctx=ctx, **options)  # type: ignore[arg-type]
            stack.callback(prairie.release)
            return prairie

        yield scene


@pytest.mark.parametrize(
    ("preset", "is_card"),
    [
        ("low", False),
        pytest.param("high", False, marks=pytest.mark.slow),
        pytest.param("low", True, marks=pytest.mark.slow),
    ],
)
def test_t1_bare_ground_far_off_is_as_bright_as_in_the_reference(
    small: Stage, bare: Load, camera: Aim, monkeypatch: pytest.MonkeyPatch, preset: str, *, is_card: bool
) -> None:
    """Cards read litter with an anisotropic sampler; so does this test, slowly, on a software rasteriser."""
    monkeypatch.setattr(rasteriser, "draws_in_software", lambda _: not is_card)
    assert (rasteriser.anisotropy(small.ctx) > 1.0) == is_card
    prairie, seen = bare(preset=preset), camera(0, 8, 90, pitch=-5)
    drawn = small.shot(prairie, seen)
    small.begin()
    truth = draw_truth(prairie, *small.matrices(seen), small.size, samples=2).picture.astype(np.float64)
    error = drawn - truth
    assert np.abs(error)[62:].mean(axis=1).max() <= 10.0  # below the terrain's edge
    # A software rasteriser's anisotropic filter goes by differences of coordinates, which jump between two squares.
    assert np.quantile(np.abs(error)[66:90], 0.999 if is_card else 1.0) <= 10.0
    # Nearer by, single straws of litter can be told, which the carpet shows by their mean alone.
    assert np.abs(error[66:132].reshape(11, 6, 40, 6, 3).mean(axis=(1, 3))).max() <= 5.0


@pytest.mark.parametrize("lod", ["auto", "carpet"])
def test_a_prairie_where_no_wind_blows_is_drawn(load: Load, small: Stage, camera: Aim, lod: str) -> None:
    picture = small.shot(load(LITTLE, lod=lod), camera(0.0, 3.0, 20.0, pitch=-15))
    below = picture[len(picture) // 2 :].mean(axis=(0, 1))
    assert below[1] > below[2] + 20.0, "grass is greener than it is blue"
