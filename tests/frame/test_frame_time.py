"""Holding a frame time, in whole frames (N11)."""

import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass import testing
from tallgrass.engine.camera import camera_at
from tallgrass.engine.declared.quality import PRESETS
from tallgrass.engine.gl.functions import Functions
from tallgrass.engine.gl.stream import release_all
from tallgrass.systems import govern
from tallgrass.systems.govern import Fineness
from tallgrass.systems.prairie import Prairie
from tallgrass.testing import LITTLE

Stage = Any
Load = Callable[..., Prairie]
Draw = Callable[[Stage, Prairie], None]
At = Callable[[float, float], None]

NOTHING_KEEPS_IT = 1e-6
"""Frame time that no frame can keep [s]."""

VERTEX = """#version 330
uniform mat4 clip;
uniform vec3 foot;
void main() {
    vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1));
    gl_Position = clip * vec4(foot + vec3(corner * vec2(0.5, 3.0) - vec2(0.25, 0.5), 0.0), 1.0);
}"""
FRAGMENT = """#version 330
out vec4 pixel;
void main() { pixel = vec4(1.0, 0.0, 1.0, 1.0); }"""


@pytest.fixture
def at(monkeypatch: pytest.MonkeyPatch) -> At:
    """Draw all pictures with these fractions of pixels and distances."""

    def fix(scale: float, part: float) -> None:
        monkeypatch.setattr(govern, "RUNGS", (Fineness(scale, part),))

    return fix


@pytest.fixture
def post(ctx: moderngl.Context) -> Iterator[Draw]:
    """Draw a post of the host's own that stands in the grass, 5 m before the scene's camera."""
    program = ctx.program(vertex_shader=VERTEX, fragment_shader=FRAGMENT)
    array = ctx.vertex_array(program, [])

    def draw(stage: Stage, prairie: Prairie) -> None:
        seen = camera_at(prairie.scene.camera, None, prairie.height_at)
        view, projection = stage.matrices(seen)
        program["clip"].write((projection @ view).T.astype("f4").tobytes())  # type: ignore[union-attr]
        program["foot"] = (0.0, float(prairie.height_at([(0.0, 15.0)])[0]), 15.0)
        ctx.enable_only(moderngl.DEPTH_TEST)
        array.render(moderngl.TRIANGLE_STRIP, 4)
        ctx.enable_only(moderngl.NOTHING)

    yield draw
    release_all(array, program)


def shown(stage: Stage, prairie: Prairie, post: Draw | None = None) -> tuple[NDArray[np.float64], NDArray[np.float32]]:
    """Return the picture of the scene's camera, and its depth; with a post that the host drew before."""
    seen = camera_at(prairie.scene.camera, None, prairie.height_at)
    stage.begin()
    if post is not None:
        post(stage, prairie)
    prairie.draw(*stage.matrices(seen))
    return stage.read(), stage.depth()


def test_n11_a_time_that_nothing_keeps_leaves_out_what_can_be_and_the_prairie_can_still_be_told(
    stage: Stage, load: Load
) -> None:
    prairie = load(hold=NOTHING_KEEPS_IT)
    whole = shown(stage, prairie)[0]
    for _ in range(2000):
        shown(stage, prairie)
        if prairie.statistics.fineness.scale < 1.0:
            break
    held = shown(stage, prairie)[0]
    assert prairie.statistics.fineness == govern.RUNGS[-1]
    assert 0.5 < np.abs(held - whole).mean() < 20.0
    assert np.abs(held.mean(axis=(0, 1)) - whole.mean(axis=(0, 1))).max() < 6.0


@pytest.mark.parametrize("scale", [0.75, 0.5, 0.36])
def test_n11_with_fewer_pixels_colours_and_depth_are_the_same_but_for_their_detail(
    stage: Stage, load: Load, at: At, scale: float
) -> None:
    prairie = load()
    whole, deep = shown(stage, prairie)
    at(scale, 1.0)
    held, depth = shown(stage, prairie)
    assert np.abs(held - whole).mean() < 12.0
    assert np.abs(held.mean(axis=1) - whole.mean(axis=1)).mean() < 3.0  # row by row, from sky to ground
    assert np.median(np.abs(depth - deep)) < 1e-3
    assert ((depth < 1.0) == (deep < 1.0)).mean() > 0.97


@pytest.mark.slow
def test_minimal_draws_a_quarter_of_the_pixels(
    stage: Stage, load: Load, at: At, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(PRESETS, "low", PRESETS["minimal"].model_copy(update={"pixels": 1.0}))
    at(PRESETS["minimal"].pixels, 1.0)
    held = shown(stage, load(preset="low"))[0]
    at(1.0, 1.0)
    whole, minimal = (shown(stage, load(preset=name))[0] for name in ("low", "minimal"))
    np.testing.assert_array_equal(minimal, held)
    assert np.abs(minimal - whole).max() > 0.0
    assert PRESETS["minimal"].pixels ** 2 == pytest.approx(0.25, abs=0.02)


@pytest.mark.parametrize("scale", [0.75, 0.5, 0.36])
def test_n11_what_the_host_drew_before_stands_in_the_grass_as_sharp_as_ever(
    stage: Stage, load: Load, at: At, post: Draw, scale: float
) -> None:
    prairie = load()
    alone, _ = shown(stage, prairie)
    whole, deep = shown(stage, prairie, post)
    at(scale, 1.0)
    held, depth = shown(stage, prairie, post)
    bare = (whole == (255, 0, 255)).all(axis=-1)
    hidden = ~bare & (np.abs(whole - alone).max(axis=-1) > 0)
    assert bare.sum() > 300, "it rises above the grass"
    assert hidden.sum() > 15, "and there is grass before its foot"
    above = bare & np.roll(bare, -9, axis=0)  # of any tip that a larger pixel might show
    assert np.abs(held[above] - (255.0, 0.0, 255.0)).max() <= 12.0  # a faint tip that the smaller picture has there
    assert np.abs(held[hidden] - whole[hidden]).mean() < 40.0
    np.testing.assert_allclose(depth[above], deep[above], atol=1e-6)


def test_n11_without_a_time_to_hold_nothing_is_timed_copied_or_waited_for(
    stage: Stage, load: Load, monkeypatch: pytest.MonkeyPatch
) -> None:
    called: list[str] = []
    prairie = load()
    whole = shown(stage, prairie)[0]
    painter = prairie.painter
    assert painter is not None
    for name in ("glCopyTexSubImage2D", "glGenQueries", "glQueryCounter", "glGetQueryObjectiv"):
        monkeypatch.setattr(painter.smaller._gl, name, lambda *_, name=name: called.append(name))  # noqa: SLF001
    monkeypatch.setattr(type(painter.stopwatch), "timing", lambda *_: called.append("timing"))
    np.testing.assert_array_equal(shown(stage, prairie)[0], whole)
    assert called == []
    assert isinstance(painter.smaller._gl, Functions)  # noqa: SLF001


def test_n11_a_system_may_set_the_time_to_hold_in_the_middle_of_a_frame(stage: Stage, load: Load) -> None:
    prairie = load()

    def settings() -> None:
        prairie.governor.hold = 1.0

    prairie.systems.add("input", "settings", settings)
    shown(stage, prairie)
    assert prairie.governor.hold == 1.0
    shown(stage, prairie)


@pytest.mark.slow
def test_n11_representations_are_drawn_in_little_by_little_and_come_back(stage: Stage, load: Load, at: At) -> None:
    prairie = load()

    def standing() -> int:
        for _ in range(30):
            prairie.advance(0.2)
            shown(stage, prairie)
        return prairie.statistics.patches["blades"] + prairie.statistics.patches["strips"]

    before = standing()
    at(1.0, 0.5)
    prairie.advance(1 / 60)
    shown(stage, prairie)
    assert 0.9 < prairie.viewers["main"].lens.range < 1.0
    assert standing() < 0.6 * before
    at(1.0, 1.0)
    assert standing() == before


def test_n11_where_representations_have_been_drawn_in_the_carpet_lies(
    ctx: moderngl.Context, load: Load, at: At
) -> None:
    at(1.0, 0.5)
    with testing.stage(ctx, (320, 180)) as wide:
        _, deep = shown(wide, load("plain", preset="low"))
    land = deep < 1.0
    assert land.any()
    assert not (np.maximum.accumulate(land, axis=0) & ~land).any(), "the sky shows through the land"


RUN = """
import runpy
from tallgrass.systems import holding
holding.AHEAD = False
from tallgrass.systems import govern
govern.RUNGS = (govern.Fineness(0.5),)
from host_program import windows
for name in ("rounds", "two_windows", "window_made_again"):
    delattr(windows, f"check_{name}")
runpy.run_module("host_program", run_name="__main__")
"""


@pytest.mark.slow
@pytest.mark.window
@pytest.mark.gl
def test_n11_a_game_and_a_prairie_with_fewer_pixels_leave_each_other_alone(tmp_path: Path) -> None:
    (tmp_path / "scene.yaml").write_text(LITTLE + "wind: [{ kind: breeze, strength: 0.4 }]\n", "utf-8")
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", RUN, tmp_path / "scene.yaml", "1"],
        cwd=Path(__file__).parent, env={**os.environ, "PYGLET_HEADLESS": ""},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    said = json.loads(done.stdout)
    del said["version"]
    assert {name: found for name, found in said.items() if found} == {}
