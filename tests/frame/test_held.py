"""Holding: a frame drawn without its changes of representation."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from tallgrass.app.bench.steps import CHANGING, held
from tallgrass.engine.camera import Camera
from tallgrass.systems.prairie import Prairie

Stage = Any
Load = Callable[..., Prairie]
Aim = Callable[..., Camera]


def shot_held(stage: Stage, prairie: Prairie, camera: Camera) -> Any:
    with held(prairie):
        return stage.shot(prairie, camera)


def test_n3_where_nothing_changes_a_held_frame_is_the_frame_itself(stage: Stage, load: Load, camera: Aim) -> None:
    prairie, here = load(), camera(0.6, 3.0, 18.7, pitch=-10)
    stage.shot(prairie, here)
    prairie.advance(0.3)
    np.testing.assert_array_equal(shot_held(stage, prairie, here), stage.shot(prairie, here))


def test_n3_held_no_patch_changes_over_a_border_and_then_each_does(stage: Stage, load: Load, camera: Aim) -> None:
    prairie, there, here = load(), camera(0.6, 3.0, 20.01, pitch=-10), camera(0.6, 3.0, 19.99, pitch=-10)
    stage.shot(prairie, there)
    patches = prairie.viewers["main"].patches
    arrays = (
        patches.cell, patches.representation, patches.progress, patches.visible, patches.was_visible, patches.sublevel,
    )  # fmt: skip
    before = [array.copy() for array in arrays]
    as_before = shot_held(stage, prairie, here)
    for array, old in zip(arrays, before, strict=True):
        np.testing.assert_array_equal(array, old)
    stage.shot(prairie, here)
    assert prairie.statistics.transitions > 5
    prairie.advance(5.0)
    stage.shot(prairie, here)
    prairie.advance(0.0)
    assert np.abs(stage.shot(prairie, here) - as_before).max() > 10.0


def test_n3_afterwards_a_held_frame_never_was(stage: Stage, load: Load, camera: Aim) -> None:
    one, other = load(), load()
    for step in range(8):
        here = camera(0.6, 3.0, 20.1 - 0.05 * step, pitch=-10)
        if step % 3 == 1:
            shot_held(stage, one, here)
        np.testing.assert_array_equal(stage.shot(one, here), stage.shot(other, here))
        for prairie in (one, other):
            prairie.advance(0.1)
    ours, theirs = (prairie.viewers["main"].patches.progress for prairie in (one, other))
    assert (ours < 1.0).any()
    np.testing.assert_array_equal(ours, theirs)


def test_n3_a_held_frame_feels_the_wind_of_its_own_instant(stage: Stage, load: Load, camera: Aim) -> None:
    prairie, here = load(), camera(0.6, 3.0, 18.7, pitch=-10)
    before = stage.shot(prairie, here)
    prairie.advance(0.7)
    assert np.abs(shot_held(stage, prairie, here) - before)[30:].mean() > 0.5


def test_what_a_game_has_left_out_stays_out_after_holding(stage: Stage, load: Load, camera: Aim) -> None:
    prairie = load()
    stage.shot(prairie, camera(0.6, 3.0, 18.7, pitch=-10))
    prairie.systems.disable("lod")
    with held(prairie):
        assert not any(prairie.systems[name].enabled for name in CHANGING)
    assert [name for name in CHANGING if not prairie.systems[name].enabled] == ["lod"]


def test_before_the_first_frame_there_is_nothing_to_hold(load: Load) -> None:
    with pytest.raises(KeyError, match="no viewer 'main'"), held(load()):
        pass
