"""Other drivers draw the same pictures (D6)."""

import sys
from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

pytestmark = pytest.mark.hosts

MISSING = ("ARB_ES2_compatibility", "ARB_clip_control", "ARB_buffer_storage", "ARB_viewport_array")
"""Some of what macOS lacks."""

SHOT = """
import sys
import numpy as np
from tallgrass import Prairie
from tallgrass.testing import NoContextError, headless_context, stage
try:
    with headless_context() as ctx, stage(ctx, (240, 135)) as made:
        np.save(sys.argv[2], made.shot(Prairie.load(sys.argv[1], preset="high", ctx=ctx)))
        error = ctx.error
        print(ctx.info["GL_RENDERER"], error)
except NoContextError as error:
    sys.exit(print(error, file=sys.stderr) or 77)
"""


@pytest.fixture(scope="module")
def shot(run: Callable[..., str], tmp_path_factory: pytest.TempPathFactory) -> Callable[..., NDArray[np.float64]]:
    """Draw the meadow in a process of its own, with a driver; its pictures need more layers than OpenGL promises."""
    folder = tmp_path_factory.mktemp("drivers")

    def draw(renderer: str, **place: str) -> NDArray[np.float64]:
        told = run(sys.executable, "-c", SHOT, "meadow", folder / "shot.npy", **place).splitlines()[-1]
        assert told.startswith(renderer)
        assert told.endswith("GL_NO_ERROR")
        return np.asarray(np.load(folder / "shot.npy"))

    return draw


@pytest.fixture(scope="module")
def expected(shot: Callable[..., NDArray[np.float64]]) -> NDArray[np.float64]:
    """The picture of llvmpipe."""
    return shot("llvmpipe", LIBGL_ALWAYS_SOFTWARE="1")


def test_zink_over_lavapipe_draws_the_same(
    shot: Callable[..., NDArray[np.float64]], expected: NDArray[np.float64]
) -> None:
    found = shot("zink", LIBGL_ALWAYS_SOFTWARE="1", MESA_LOADER_DRIVER_OVERRIDE="zink", XDG_RUNTIME_DIR="/tmp")  # noqa: S108
    assert np.abs(found - expected).max() <= 1.0


def test_softpipe_which_has_no_more_layers_than_it_must_draws_nearly_the_same(
    shot: Callable[..., NDArray[np.float64]], expected: NDArray[np.float64]
) -> None:
    found = shot("softpipe", LIBGL_ALWAYS_SOFTWARE="1", GALLIUM_DRIVER="softpipe")
    assert (np.abs(found - expected).max(axis=-1) > 8.0).mean() < 0.003


@pytest.mark.parametrize("version", ["3.3", "4.1"])
def test_older_versions_without_what_macos_lacks_draw_the_same(
    shot: Callable[..., NDArray[np.float64]], expected: NDArray[np.float64], version: str
) -> None:
    lacks = " ".join(f"-GL_{name}" for name in MISSING)
    shading = {"3.3": "330", "4.1": "410"}[version]
    found = shot(
        "llvmpipe", LIBGL_ALWAYS_SOFTWARE="1", MESA_EXTENSION_OVERRIDE=lacks, MESA_GL_VERSION_OVERRIDE=f"{version}FC",
        MESA_GLSL_VERSION_OVERRIDE=shading,
    )  # fmt: skip
    np.testing.assert_array_equal(found, expected)
