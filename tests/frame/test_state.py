"""Pictures after setting the time, and after restoring a state, equal those of a prairie that ran there (F4, N5)."""

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import esper
import numpy as np
import pytest

from tallgrass.components.footprint import Footprint
from tallgrass.components.pose import Pose
from tallgrass.components.presser import Presser
from tallgrass.engine.camera import Camera
from tallgrass.systems.light.sky import PIECES
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.wind.gust import Gust
from tallgrass.testing import LITTLE

Stage = Any
Load = Callable[..., Prairie]
Aim = Callable[..., Camera]

SCENE = (
    LITTLE
    + """\
wind: [{ kind: breeze, strength: 0.4 }, { kind: gust, position: [-20, 0], every: [1, 2], speed: 9 }]
pressers: [{ path: [{ at: 0, position: [-8, 6] }, { at: 9, position: [8, 6] }] }]
light: { elevation: 30, clouds: 0.4 }
"""
)


def test_n5_a_time_that_is_set_shows_what_one_shows_who_came_there(stage: Stage, load: Load, camera: Aim) -> None:
    aim, pictures = camera(0.0, 4.0, 18.0, pitch=-18), []
    for before in ([], [0.5, 4.0], [11.0]):
        prairie = load(SCENE)
        for time in before:
            prairie.time = time
            stage.shot(prairie, aim)
        prairie.time = 6.0
        pictures.append(stage.shot(prairie, aim))
        if before:
            prairie.time = 0.0
            assert np.abs(stage.shot(prairie, aim) - pictures[-1]).max() > 20.0
        prairie.release()
    np.testing.assert_array_equal(pictures[1], pictures[0])
    np.testing.assert_array_equal(pictures[2], pictures[0])


def test_n5_a_restored_prairie_shows_the_same_picture_to_the_bit(stage: Stage, load: Load, camera: Aim) -> None:
    aim, played = camera(0.0, 4.0, 18.0, pitch=-18), load(SCENE, live=False)
    walker = esper.create_entity(Presser(radius=0.8), Pose(-4.0, 10.0))
    for number in range(20):
        played.advance(0.1)
        esper.add_component(walker, Pose(-4.0 + 0.3 * number, 10.0))
        played.bent_at([(0.0, 0.0)])
    before = stage.shot(played, aim)
    played.add(Gust(position=[-8.0, 8.0], start=1.0), name="mine")
    played.cut(Footprint(radius=3.0), 0.1, pose=Pose(3.0, 3.0))
    played.shine(elevation=20.0)
    state = played.state()
    due = stage.shot(played, aim)
    played.release()
    esper.delete_entity(walker, immediate=True)
    other = load(SCENE, live=False)
    again = other.restore(state)
    shown = stage.shot(other, aim)
    np.testing.assert_array_equal(shown, due)
    assert np.abs(due - before).max() > 40.0
    other.release()
    esper.delete_entity(again[walker], immediate=True)  # a game's own: it would tread the grass of every later test


def test_n5_a_state_from_before_most_of_it_was_mown_shows_the_same_in_the_prairie_that_went_on(
    stage: Stage, load: Load, camera: Aim
) -> None:
    aim, played = camera(0.0, 4.0, 18.0, pitch=-18), load(SCENE, live=False)
    states, pictures = [played.state()], [stage.shot(played, aim)]
    for x in (-4.0, 4.0):
        played.cut(Footprint(radius=3.0), 0.1, pose=Pose(x, 4.0))
        states.append(played.state())
        pictures.append(stage.shot(played, aim))
    assert min(np.abs(after - before).max() for before, after in pairwise(pictures)) > 20.0
    for state, due in zip(states[1::-1], pictures[1::-1], strict=True):
        played.restore(state)
        played.viewers.forget("main")
        np.testing.assert_array_equal(stage.shot(played, aim), due)
    played.clear(Footprint(radius=4.0), pose=Pose(0.0, 4.0))
    assert np.abs(stage.shot(played, aim) - pictures[0]).max() > 40.0


DAY = LITTLE + "light: { hour: 12, hours_per_minute: 2 }\n"


@pytest.mark.parametrize("frames", [3, pytest.param(PIECES + 8, marks=pytest.mark.slow)])
def test_n5_a_light_that_was_on_its_way_goes_on_from_there(stage: Stage, load: Load, camera: Aim, frames: int) -> None:
    aim, played = camera(0.0, 4.0, 18.0, pitch=-18), load(DAY, lod="carpet")
    noon = stage.shot(played, aim)
    played.shine(hour=20.3)
    for _ in range(frames):
        played.advance(0.02)
        stage.shot(played, aim)
    other = load(DAY, lod="carpet")
    other.restore(played.state())
    for _ in range(PIECES + 2):
        due = stage.shot(played, aim)
        np.testing.assert_array_equal(stage.shot(other, aim), due)
        for prairie in (played, other):
            prairie.advance(0.02)
    assert np.abs(due - noon).max() > 10.0
    for prairie in (played, other):
        prairie.release()
