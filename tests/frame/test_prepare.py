"""`prepare`: after it, no frame makes anything in GL."""

import ctypes
import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import esper
import moderngl
import numpy as np
import pytest

from tallgrass import (
    Blast,
    Breeze,
    Footprint,
    Gust,
    Lamp,
    Pose,
    Presser,
    Shade,
    ShadowMap,
    Turbulence,
    Whirlwind,
    WindPrimitive,
)
from tallgrass.engine.camera import Camera, View
from tallgrass.engine.gl.functions import ENUMS, functions_of
from tallgrass.engine.plugins import wind_kinds
from tallgrass.systems.prairie import Prairie
from tallgrass.testing import LITTLE

Stage = Any
Load = Callable[..., Prairie]
Aim = Callable[..., Camera]

SAMPLERS = {0x8B5E: "TEXTURE_BINDING_2D", 0x8DC1: "TEXTURE_BINDING_2D_ARRAY", 0x8B5F: "TEXTURE_BINDING_3D"}
"""Textures' bindings by the types of GLSL's samplers."""

MADE = "program", "buffer", "texture", "texture_array", "depth_texture"

FRONT = """
import numpy as np
from tallgrass import WindPrimitive

class Front(WindPrimitive):
    kind: str = "front"
    twin = "front.glsl"
    power: float = 0.5

    def mask(self, place, /, *, time):
        return np.ones(len(place), np.float32)

    def action(self, place, /, *, time, seed, grass):
        return np.full_like(place, [0.0, self.power])

class Untold(WindPrimitive):
    kind: str = "untold"

    def mask(self, place, /, *, time):
        return np.ones(len(place), np.float32)

    def action(self, place, /, *, time, seed, grass):
        return np.full_like(place, [0.1, 0.0])
"""

TWIN = """
float mask(vec2 place, Front front) { return 1.0; }
vec2 action(vec2 place, Front front) { return vec2(0.0, front.power); }
"""


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Names of the calls that make GL objects, in their order."""
    found: list[str] = []

    def noting(name: str, plain: Callable[..., Any]) -> Callable[..., Any]:
        def noted(ctx: moderngl.Context, *given: Any, **named: Any) -> Any:
            found.append(name)
            return plain(ctx, *given, **named)

        return noted

    for name in MADE:
        monkeypatch.setattr(moderngl.Context, name, noting(name, getattr(moderngl.Context, name)))
    return found


@pytest.fixture
def plugin(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[list[WindPrimitive]]:
    """Winds of a game's own kinds, with a twin and without one."""
    (tmp_path / "prepared_front.py").write_text(FRONT, "utf-8")
    (tmp_path / "front.glsl").write_text(TWIN, "utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    import prepared_front  # type: ignore[import-not-found]  # noqa: PLC0415

    monkeypatch.setitem(wind_kinds()._classes, "front", prepared_front.Front)  # noqa: SLF001
    monkeypatch.setitem(wind_kinds()._classes, "untold", prepared_front.Untold)  # noqa: SLF001
    yield [prepared_front.Front(), prepared_front.Untold()]
    del sys.modules["prepared_front"]


@pytest.mark.slow
def test_nothing_is_made_on_a_frame_after_a_game_has_prepared(
    stage: Stage, load: Load, camera: Aim, made: list[str], plugin: list[WindPrimitive]
) -> None:
    prairie, shadows = load(LITTLE), stage.ctx.depth_texture((8, 8))
    stage.begin()
    prairie.prepare()
    near, far = camera(0.0, 2.0, 20.0, pitch=-10), camera(0.0, 2.0, 20.0, pitch=-4, view=6.0)

    def frames(aim: Camera) -> list[str]:
        made.clear()
        for _ in range(3):
            prairie.advance(0.4)
            stage.shot(prairie, aim)
            prairie.draw(*stage.matrices(aim), parts=("grass",), depth="all")
        return list(made)

    def add(*winds: WindPrimitive) -> Callable[[], object]:
        return lambda: [prairie.add(wind) for wind in winds]

    acts: dict[str, Callable[[], object]] = {
        "first frame": lambda: None,
        "gust": add(Gust(position=[0, 0])),
        "blast": lambda: prairie.add(Blast(), pose=Pose(0, 5)),
        "whirlwind": add(Whirlwind(position=[5, 0])),
        "turbulence": add(Turbulence()),
        "a plugin's with a twin": add(plugin[0]),
        "a plugin's without one": add(plugin[1]),
        "in another order": add(Gust(priority=50), Breeze(priority=45), Gust(priority=40), Blast(priority=0)),
        "presser": lambda: esper.create_entity(Presser(radius=0.4), Pose(0, 10)),
        "shade": lambda: esper.create_entity(Shade((0.0, 5.0, 8.0), 1.0)),
        "saucer": lambda: prairie.add(Blast(body="saucer"), pose=Pose(0, 5)),
        "cut": lambda: prairie.cut(Footprint(radius=1.0), 0.05, pose=Pose(0, 8)),
        "lamp": lambda: esper.create_entity(Lamp(), Pose(1.0, 8.0, y=3.0)),
        "shadow map": lambda: prairie.shadows([ShadowMap(shadows, np.diag([0.02, 0.02, 0.02, 1.0]))]),
        "light": lambda: prairie.shine(hour=19.0, clouds=0.5),
    }
    try:
        for name, act in acts.items():
            act()
            assert frames(near) == [], name
        assert frames(far) == [], "a lens that zooms"
    finally:
        for entity in [entity for kind in (Presser, Shade, Lamp) for entity, _ in esper.get_component(kind)]:
            esper.delete_entity(entity, immediate=True)


@pytest.mark.slow
def test_what_was_prepared_draws_what_is_drawn_without(stage: Stage, load: Load, camera: Aim) -> None:
    plain, ready, aim = load(), load(), camera(0.0, 2.0, 20.0, pitch=-10)
    ready.prepare()
    stroke = Footprint(radius=3.0), 0.05
    acts: list[Callable[[Prairie], object]] = [
        lambda _: None,
        lambda prairie: prairie.add(Gust(position=[0, 0])),
        lambda prairie: prairie.cut(*stroke),
    ]
    for act in acts:
        pictures = []
        for prairie in (plain, ready):
            act(prairie)
            pictures.append(stage.shot(prairie, aim))
            prairie.advance(0.5)
        np.testing.assert_allclose(pictures[1], pictures[0], atol=1.0)


@pytest.mark.slow
def test_it_may_come_before_the_first_frame_between_frames_and_twice(
    stage: Stage, load: Load, camera: Aim, made: list[str]
) -> None:
    prairie, aim = load(), camera(0.0, 2.0, 20.0, pitch=-10)
    told: list[tuple[int, int]] = []
    before = stage.shot(prairie, aim)
    for done, of in prairie.preparing():
        told.append((done, of))
        if done == of // 2:
            np.testing.assert_allclose(stage.shot(prairie, aim), before, atol=1.0)
    assert [done for done, _ in told[:-1]] == list(range(len(told) - 1))
    assert told[-1][0] == told[-1][1] == told[0][1] > 8
    np.testing.assert_allclose(stage.shot(prairie, aim), before, atol=1.0)
    again: list[tuple[int, int]] = []
    prairie.prepare(on_progress=lambda done, of: again.append((done, of)))
    assert again[-1][0] == again[-1][1]
    made.clear()
    prairie.add(Gust(position=[0, 0]))
    stage.shot(prairie, aim)
    assert made == []


@pytest.mark.usefixtures("undrawn")
def test_large_programs_are_made_one_a_step_for_a_loading_screen_to_go_on_between(load: Load, made: list[str]) -> None:
    steps = []
    made.clear()
    for _ in load(LITTLE).preparing():
        steps.append(made.count("program"))
        made.clear()
    assert sum(steps) > 50
    assert steps.count(1) >= 20
    assert max(steps) <= 12


@pytest.mark.usefixtures("undrawn")
def test_a_loading_screen_waits_while_its_window_is_minimised(stage: Stage, load: Load, made: list[str]) -> None:
    stage.begin()
    left = load(LITTLE).preparing()
    before = [next(left) for _ in range(15)]
    made.clear()
    stage.target.viewport = (0, 0, 0, 0)
    assert [next(left) for _ in range(3)] == before[-1:] * 3
    assert made == []
    stage.target.viewport = (0, 0, *stage.size)
    assert next(left)[0] == before[-1][0] + 1


@pytest.mark.usefixtures("undrawn")
def test_a_scene_read_again_is_as_ready_as_before(stage: Stage, load: Load, camera: Aim, made: list[str]) -> None:
    prairie, aim = load(LITTLE), camera(0.0, 2.0, 20.0, pitch=-10)
    prairie.prepare()
    prairie.loaded.file.write_text(LITTLE.replace("seed: 5", "seed: 6"), "utf-8")
    prairie.reload()
    stage.shot(prairie, aim)
    made.clear()
    prairie.add(Whirlwind())
    prairie.cut(Footprint(radius=1.0), 0.05)
    stage.shot(prairie, aim)
    assert made == []


@pytest.mark.usefixtures("undrawn")
@pytest.mark.parametrize("steps", [0, 12, 30])
def test_a_scene_read_again_with_another_kind_of_grass_is_prepared_before_it_is_drawn(
    stage: Stage, load: Load, camera: Aim, made: list[str], steps: int
) -> None:
    prairie, aim = load(LITTLE), camera(0.0, 2.0, 20.0, pitch=-10)
    stage.shot(prairie, aim)
    left = prairie.preparing()
    for _ in range(steps):
        next(left)
    prairie.loaded.file.write_text(LITTLE.replace("  short:", "  third: {}\n  short:"), "utf-8")
    prairie.reload()
    if steps:
        stage.shot(prairie, aim)  # amid the steps of a loading screen
    *_, (done, of) = left
    assert done == of
    made.clear()
    stage.shot(prairie, aim)
    assert made == []


def test_a_prairie_is_loaded_on_another_thread_while_one_is_drawn(stage: Stage, load: Load, camera: Aim) -> None:
    shown, aim = load(), camera(0.0, 2.0, 20.0, pitch=-10)
    found: list[Prairie] = []
    loading = threading.Thread(target=lambda: found.append(load(LITTLE.replace("seed: 5", "seed: 77"))))
    loading.start()
    frames = 0
    while loading.is_alive() or not frames:
        shown.advance(0.02)
        stage.shot(shown, aim)
        frames += 1
    loading.join()
    assert len(found) == 1
    expected = load(LITTLE.replace("seed: 5", "seed: 77"))
    np.testing.assert_array_equal(stage.shot(found[0], aim), stage.shot(expected, aim))


def test_a_prairie_that_was_released_is_not_prepared(load: Load) -> None:
    prairie = load(LITTLE)
    prairie.release()
    with pytest.raises(RuntimeError, match="this prairie has been released"):
        prairie.prepare()


@pytest.mark.parametrize("was_drawn", [pytest.param(True, marks=pytest.mark.slow), False])
def test_a_frame_is_rehearsed_with_all_that_may_come_and_no_pixel_changes(
    stage: Stage, load: Load, camera: Aim, monkeypatch: pytest.MonkeyPatch, *, was_drawn: bool
) -> None:
    prairie, aim = load(LITTLE), camera(0.0, 2.0, 20.0, pitch=-10)
    if was_drawn:
        stage.shot(prairie, aim)
    rendered: set[tuple[int, ...]] = set()
    render = moderngl.VertexArray.render

    def noted(array: moderngl.VertexArray, *given: Any, **named: Any) -> None:
        rendered.add(_compiled_for(array.program))
        render(array, *given, **named)

    monkeypatch.setattr(moderngl.VertexArray, "render", noted)
    stage.begin()
    empty = stage.read()
    prairie.prepare()
    np.testing.assert_array_equal(stage.read(), empty)
    rendered_before = set(rendered)
    assert prairie.painter is not None
    assert list(prairie.viewers.values()) == list(prairie.viewers)
    before = stage.shot(prairie, aim)
    prairie.cut(Footprint(radius=4.0), 0.05, pose=Pose(0, 10))
    prairie.add(Blast(body="saucer"), pose=Pose(0, 5))
    changed = stage.shot(prairie, aim)
    assert (changed != before).any()
    prairie.draw(*stage.matrices(aim), depth="all")
    prairie.draw_depth(*stage.matrices(aim))
    stage.begin()
    with prairie._screen.opened(prairie.site) as painter:  # noqa: SLF001
        assert painter is not None
        painter.draw(View(*stage.matrices(aim)), scale=0.5)
    assert (stage.read() != empty).any()
    assert rendered <= rendered_before


def _compiled_for(program: moderngl.Program) -> tuple[int, ...]:
    """Return what drivers compile a program for: its number, the depth test, and whether its samplers have textures."""
    gl, found = functions_of(program.ctx), ctypes.c_int()

    def asked(name: str) -> int:
        gl.glGetIntegerv(ENUMS[name], ctypes.addressof(found))
        return found.value

    before, bound = asked("ACTIVE_TEXTURE"), []
    for uniform in (program[name] for name in program):
        kind = SAMPLERS.get(getattr(uniform, "gl_type", 0))
        if isinstance(uniform, moderngl.Uniform) and kind is not None and uniform.array_length == 1:
            gl.glActiveTexture(ENUMS["TEXTURE0"] + uniform.value)
            bound.append(bool(asked(kind)))
    gl.glActiveTexture(before)
    return program.glo, asked("DEPTH_FUNC"), asked("DEPTH_WRITEMASK"), *bound
