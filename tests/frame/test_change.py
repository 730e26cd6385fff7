"""Changes of representation in pictures (X1, X4, X5)."""

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.app.bench.steps import DECIDING, held
from tallgrass.engine.camera import Camera
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.transition import FADE

Stage = Any
Load = Callable[..., Prairie]
Aim = Callable[..., Camera]

STILL = """\
tallgrass: 2
terrain: { noise: flat, size: [60, 60] }
grass:
  tall: { height: [0.5, 0.9], width: 0.02, root: "#5a5a2c", tip: "#dcc98f" }
quality:
  blades: 120
  models: 2
  blade_rings: [{ to: 1, segments: 3 }, { to: 2, segments: 2 }]
  strip_rings: [{ to: 5, strips: 4, columns: 2, sections: 2, texel: 0.02 }]
  carpet_to: 12
  carpet: 32
"""
STEP = 0.05
BEFORE, BEHIND = 20.0005, 19.9995
"""z on either side of a border between patches at z = 20 m, beyond the tolerance of the edge itself [m]."""


@pytest.fixture(scope="module")
def prairie(load: Load) -> Prairie:
    """A prairie without wind, so that only levels of detail change the picture."""
    return load(STILL)


def settled(stage: Stage, prairie: Prairie, aim: Camera) -> NDArray[np.float64]:
    """Return the picture after all transitions have ended."""
    stage.shot(prairie, aim)
    for _ in range(2):  # a sub-level's change may have to end before that of the representation begins
        prairie.advance(FADE)
        picture = stage.shot(prairie, aim)
    assert (prairie.viewers["main"].patches.progress == 1.0).all()
    return np.asarray(picture)


def test_x4_over_a_border_the_picture_changes_by_and_by(stage: Stage, prairie: Prairie, camera: Aim) -> None:
    there, here = camera(0.6, 1.7, BEFORE, pitch=-10), camera(0.6, 1.7, BEHIND, pitch=-10)
    step = BEHIND - BEFORE
    before = settled(stage, prairie, camera(0.6, 1.7, BEFORE + 1.0, pitch=-10))
    walked = float(np.abs(stage.shot(prairie, camera(0.6, 1.7, BEFORE + 1.0 + step, pitch=-10)) - before).mean())
    story = [settled(stage, prairie, there), stage.shot(prairie, here)]
    in_transition = int((prairie.viewers["main"].patches.progress < 1.0).sum())
    for _ in range(24):
        prairie.advance(STEP)
        story.append(stage.shot(prairie, here))
    assert in_transition > 5
    whole = float(np.abs(story[-1] - story[0]).mean())
    changes = [float(np.abs(after - before).mean()) for before, after in pairwise(story)]
    assert whole > 0.1
    assert changes[0] < min(0.2 * whole, 1.2 * walked), "as a step within a patch changes it"
    steps = round(FADE / STEP)
    going = changes[1 : steps + 1]
    assert min(going) > 0.0
    assert max(going) < 0.2 * whole
    assert max(going) < 1.6 * float(np.mean(going)), "no frame changes much more than the others"
    assert sum(changes[steps + 2 :]) == 0.0


def test_x1_stepping_back_over_the_border_at_once_starts_nothing(stage: Stage, prairie: Prairie, camera: Aim) -> None:
    there, here = camera(0.6, 1.7, BEFORE, pitch=-10), camera(0.6, 1.7, BEHIND, pitch=-10)
    settled(stage, prairie, there)
    settled(stage, prairie, here)
    settled(stage, prairie, there)
    for _ in range(6):
        for aim in (here, there):
            prairie.advance(STEP)
            stage.shot(prairie, aim)
            assert (prairie.viewers["main"].patches.progress == 1.0).all()


def test_x1_what_comes_into_view_is_there_at_once(stage: Stage, prairie: Prairie, camera: Aim) -> None:
    """The viewer turns round and crosses a border in one frame, so that some patches in view change representation."""
    ahead, behind = camera(0.6, 1.7, 2.4995, pitch=-10), camera(0.6, 1.7, 2.5005, pitch=-10, yaw=180)
    settled(stage, prairie, ahead)
    patches = prairie.viewers["main"].patches
    before, fine = patches.representation.copy(), patches.sublevel.copy()
    prairie.advance(STEP)
    turned = stage.shot(prairie, behind)
    assert (patches.visible & (patches.representation != before)).sum() > 3
    assert (patches.visible & (patches.sublevel != fine).any(axis=0)).sum() > 3
    assert (patches.progress == 1.0).all()
    assert (patches.sublevel_progress == 1.0).all()
    np.testing.assert_array_equal(settled(stage, prairie, behind), turned)


def test_x4_no_ground_flashes_through_a_change(stage: Stage, prairie: Prairie, camera: Aim) -> None:
    there, here = camera(0.6, 1.7, BEFORE, pitch=-10), camera(0.6, 1.7, BEHIND, pitch=-10)
    means = [float(settled(stage, prairie, there)[45:].mean()), float(stage.shot(prairie, here)[45:].mean())]
    for _ in range(20):
        prairie.advance(STEP)
        means.append(float(stage.shot(prairie, here)[45:].mean()))
    low, high = sorted((means[0], means[-1]))
    assert min(means) > 0.99 * low
    assert max(means) < 1.03 * high


def test_x1_a_viewer_who_leaps_far_finds_everything_settled(stage: Stage, prairie: Prairie, camera: Aim) -> None:
    settled(stage, prairie, camera(0.6, 1.7, 25.0, pitch=-10))
    prairie.advance(STEP)
    leapt = stage.shot(prairie, camera(-20.0, 1.7, -9.0, pitch=-10, yaw=150))
    prairie.advance(2 * FADE)
    np.testing.assert_array_equal(stage.shot(prairie, camera(-20.0, 1.7, -9.0, pitch=-10, yaw=150)), leapt)


def test_f1_between_sub_levels_of_strips_each_blade_goes_over_within_several_frames(
    stage: Stage, load: Load, camera: Aim
) -> None:
    coarser = "{ to: 9, strips: 2, columns: 1, sections: 2, texel: 0.08 }]"
    prairie = load(STILL.replace("texel: 0.02 }]", f"texel: 0.08 }}, {coarser}"))
    here = camera(0.6, 1.7, 20.0, pitch=-8)
    settled(stage, prairie, here)
    patches, strips = prairie.viewers["main"].patches, 1
    near = (patches.representation == strips) & patches.visible & (patches.sublevel[strips] < 2)
    assert near.sum() > 5
    patches.sublevel_before[strips, near] = patches.sublevel[strips, near] + 2

    def along(progress: float) -> NDArray[np.float64]:
        patches.sublevel_progress[strips, near] = progress
        with held(prairie, systems=DECIDING):
            return np.asarray(stage.shot(prairie, here))

    whole = np.abs(along(1.0) - along(0.0))
    frames = [along(0.4 + frame / (30.0 * FADE)) for frame in range(8)]
    most = np.max([np.abs(after - before) for before, after in pairwise(frames)], axis=0)
    going = (whole > 20.0) & (np.abs(frames[-1] - frames[0]) > 0.5 * whole)
    assert going.sum() > 50
    assert np.median(most[going] / whole[going]) < 0.27


IDLING = {"paused": 0.0, "in slow motion": 1.0 / 600.0}
WAYS: dict[str, Callable[[Aim, float], Camera]] = {
    "a lens zooms in": lambda camera, part: camera(0.6, 1.7, 20.0, pitch=-6, view=60.0 - 45.0 * part),
    "a lens zooms out": lambda camera, part: camera(0.6, 1.7, 20.0, pitch=-6, view=15.0 + 45.0 * part),
    "the eye rises": lambda camera, part: camera(0.6, 1.7 + 14.0 * part, 20.0, pitch=-10 - 20 * part),
    "the eye goes over a border": lambda camera, part: camera(0.6, 1.7, BEHIND + 4.0 * (1.0 - part), pitch=-10),
    "the eye leaps": lambda camera, part: camera(0.6, 1.7, BEHIND - 4.0 * (part == 1.0), pitch=-10),
}


@pytest.mark.parametrize(
    ("way", "time"),
    [(way, "in slow motion" if "zooms" in way else "paused") for way in WAYS],
)
def test_x2_where_time_idles_every_change_is_over_within_sixty_frames(
    stage: Stage, prairie: Prairie, camera: Aim, way: str, time: str
) -> None:
    along, changed = WAYS[way], 0
    prairie.viewers.forget("main")
    settled(stage, prairie, along(camera, 0.0))
    patches = prairie.viewers["main"].patches
    for frame in range(30 + 60):
        prairie.advance(IDLING[time])
        seen = stage.matrices(along(camera, min(1.0, frame / 29)))
        prairie.follow(*seen)
        changed += int(((patches.progress < 1.0) | (patches.sublevel_progress < 1.0).any(axis=0)).sum())
    assert changed > 20
    assert (patches.progress[patches.visible] == 1.0).all()
    assert (patches.sublevel_progress[:, patches.visible] == 1.0).all()
    here = along(camera, 1.0)
    seen = stage.shot(prairie, here)
    np.testing.assert_array_equal(seen, settled(stage, prairie, here))


def test_x4_in_a_pause_no_frame_changes_much_more_than_the_others(stage: Stage, prairie: Prairie, camera: Aim) -> None:
    there, here = camera(0.6, 1.7, BEFORE, pitch=-10), camera(0.6, 1.7, BEHIND, pitch=-10)
    prairie.viewers.forget("main")
    settled(stage, prairie, there)
    for _ in range(30):
        prairie.follow(*stage.matrices(there))
    story = [stage.shot(prairie, here) for _ in range(40)]
    changes = [float(np.abs(after - before).mean()) for before, after in pairwise(story)]
    going = [change for change in changes if change > 0.0]
    assert len(going) > 15
    assert max(going) < 1.6 * float(np.mean(going))
    assert changes[-1] == 0.0


def test_x2_of_two_viewers_one_whose_time_goes_on_is_not_hurried_by_one_who_is_drawn_again_and_again(
    stage: Stage, prairie: Prairie, camera: Aim
) -> None:
    there, here = camera(0.6, 1.7, BEFORE, pitch=-10), camera(0.6, 1.7, BEHIND, pitch=-10)
    prairie.viewers.forget("main")
    settled(stage, prairie, there)
    for frame in range(13):
        prairie.advance(STEP)
        prairie.follow(*stage.matrices(here))
        for _ in range(20):
            prairie.follow(*stage.matrices(there), viewer="another")
        patches = prairie.viewers["main"].patches
        assert np.unique(patches.progress).tolist() == pytest.approx([frame * STEP / FADE, 1.0])
    assert prairie.viewers["another"].viewer.idles
    assert not prairie.viewers["main"].viewer.idles
