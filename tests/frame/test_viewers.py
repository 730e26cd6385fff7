"""Several viewers in a frame: each has its own picture, and shared things are made once (N11)."""

from collections import Counter
from collections.abc import Callable
from typing import Any

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.engine.camera import Camera
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.show.blades import painter as blades
from tallgrass.systems.show.blades.painter import BladesPainter
from tallgrass.systems.show.carpet import painter as carpet
from tallgrass.systems.show.strips import painter as strips

Picture = NDArray[np.float64]
Stage = Any
Load = Callable[..., Prairie]
Aim = Callable[..., Camera]

MADE = (
    (blades, "gather_blades"),
    (strips, "polygon_strips"),
    (carpet, "which_seen"),
    (carpet, "tiles_around"),
    (carpet, "find_edges"),
)
"""Functions that take long, and whose results stay while a viewer stands still."""


def seen(stage: Stage, prairie: Prairie, aim: Camera, viewer: str) -> Picture:
    stage.begin()
    prairie.draw(*stage.matrices(aim), viewer=viewer)
    return np.asarray(stage.read())


def test_n11_viewers_in_turn_have_made_what_they_see_once_and_see_what_they_would_alone(
    stage: Stage, load: Load, camera: Aim, monkeypatch: pytest.MonkeyPatch
) -> None:
    prairie, made = load(), Counter[str]()

    def counted(name: str, make: Callable[..., object]) -> Callable[..., object]:
        def call(*args: object, **options: object) -> object:
            made[name] += 1
            return make(*args, **options)

        return call

    for module, name in MADE:
        monkeypatch.setattr(module, name, counted(name, getattr(module, name)))
    aims = {"left": camera(0.3, 1.7, 12.0, pitch=-8), "right": camera(3.3, 2.5, 9.0, yaw=40, pitch=-12)}
    alone = {viewer: [seen(stage, prairie, aim, viewer) for _ in range(3)][-1] for viewer, aim in aims.items()}
    assert set(made) == {name for _, name in MADE}
    made.clear()
    for _ in range(3):
        for viewer, aim in aims.items():
            np.testing.assert_array_equal(seen(stage, prairie, aim, viewer), alone[viewer])
    assert not made
    seen(stage, prairie, camera(0.3, 1.7, 11.0, pitch=-8), "left")
    assert made["gather_blades"] > 0


def test_n11_who_draws_what_is_there_already_tells_shaders_nothing_again(
    stage: Stage, load: Load, camera: Aim, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Setting uniforms one by one is expensive; values of a viewer are in the frame block."""
    prairie, told = load(), Counter[str]()
    aims = {"left": camera(0.3, 1.7, 12.0, pitch=-8), "right": camera(7.3, 2.5, 9.0, yaw=40, pitch=-12)}
    for _ in range(3):
        for viewer, aim in aims.items():
            seen(stage, prairie, aim, viewer)
    plain = moderngl.Program.__setitem__

    def noted(program: moderngl.Program, name: str, value: object) -> None:
        told[name] += 1
        plain(program, name, value)

    monkeypatch.setattr(moderngl.Program, "__setitem__", noted)
    for viewer, aim in aims.items():
        seen(stage, prairie, aim, viewer)
    assert told.total() <= 24
    assert not {"outline", "raised", "window"} & set(told)
    told.clear()
    seen(stage, prairie, aims["right"], "right")
    assert told.total() <= 6  # a program that draws several rings, or two parts, is told which


def test_n11_what_was_sent_for_a_viewer_who_stands_stays_while_others_look(
    stage: Stage, load: Load, camera: Aim, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two viewers in turn upload the same as one that looks as often: the frame block, and winds."""
    prairie, sent = load(), Counter[str]()
    aims = {"left": camera(0.3, 1.7, 12.0, pitch=-8), "right": camera(7.3, 2.5, 9.0, yaw=40, pitch=-12)}

    def look(*viewers: str) -> Counter[str]:
        sent.clear()
        for viewer in viewers:
            prairie.advance(1 / 60)
            seen(stage, prairie, aims[viewer], viewer)
        return Counter(sent)

    for _ in range(10):  # until all that came with them is over
        prairie.advance(0.3)
        look(*aims)
    for kind in (moderngl.Buffer, moderngl.Texture):

        def noted(thing: Any, data: Any, *given: Any, plain: Any = kind.write, **named: Any) -> None:
            sent[type(thing).__name__] += memoryview(data).nbytes
            plain(thing, data, *given, **named)

        monkeypatch.setattr(kind, "write", noted)
    look("left")
    alone = look("left", "left")
    look("right")
    assert look("left", "right", "left", "right") == look("right", "left", "right", "left") == alone + alone


def test_n11_what_was_sent_for_a_viewer_goes_with_it(stage: Stage, load: Load, camera: Aim) -> None:
    prairie = load()
    aims = {"main": camera(0.3, 1.7, 12.0, pitch=-8), "mirror": camera(7.3, 2.5, 9.0, yaw=40, pitch=-12)}
    for viewer, aim in aims.items():
        seen(stage, prairie, aim, viewer)
    assert prairie.painter is not None
    painter = prairie.painter.painters["blades"]
    assert isinstance(painter, BladesPainter)
    assert len(list(painter.shelves)) == 2
    prairie.viewers.forget("mirror")
    for _ in range(2):
        seen(stage, prairie, aims["main"], "main")
    assert list(painter.shelves) == [painter.shelves.now]
