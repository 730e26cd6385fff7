"""Holding: a frame drawn without its changes of representation."""

from collections.abc import Callable
from typing import Any

import numpy as np

from tallgrass.engine.camera import Camera
from tallgrass.systems.prairie import Prairie

Stage = Any
Load = Callable[..., Prairie]
Aim = Callable[..., Camera]


def held(stage: Stage, prairie: Prairie, camera: Camera) -> Any:
    stage.target.use()
    stage.target.clear(depth=1.0)
    prairie.draw(*stage.matrices(camera), held=True)
    return stage.read()


def test_n3_where_nothing_changes_a_held_frame_is_the_frame_itself(stage: Stage, load: Load, camera: Aim) -> None:
    prairie, here = load(), camera(0.6, 3.0, 18.7, pitch=-10)
    stage.shot(prairie, here)
    prairie.advance(0.3)
    np.testing.assert_array_equal(held(stage, prairie, here), stage.shot(prairie, here))


def test_n3_held_no_patch_changes_over_a_border_and_then_each_does(stage: Stage, load: Load, camera: Aim) -> None:
    prairie, there, here = load(), camera(0.6, 3.0, 20.01, pitch=-10), camera(0.6, 3.0, 19.99, pitch=-10)
    stage.shot(prairie, there)
    table = prairie.field.table
    before = [array.copy() for array in (table.cell, table.representation, table.progress, table.visible)]
    as_before = held(stage, prairie, here)
    for array, old in zip((table.cell, table.representation, table.progress, table.visible), before, strict=True):
        np.testing.assert_array_equal(array, old)
    stage.shot(prairie, here)
    assert prairie.statistics.transitions > 5
    prairie.advance(5.0)
    stage.shot(prairie, here)
    prairie.advance(0.0)
    assert np.abs(stage.shot(prairie, here) - as_before).max() > 10.0


def test_the_first_frame_has_nothing_to_hold_and_is_drawn_as_it_is(stage: Stage, load: Load, camera: Aim) -> None:
    here = camera(0.6, 3.0, 18.7, pitch=-10)
    np.testing.assert_array_equal(held(stage, load(), here), stage.shot(load(), here))
