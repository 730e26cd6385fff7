"""Values that a game writes on entities show in the same frame, in every representation (D2, D6)."""

import logging
from collections.abc import Callable, Iterator
from itertools import pairwise
from pathlib import Path

import esper
import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

import tallgrass
from tallgrass import Lod, Patch, Receivers
from tallgrass.components.viewer import Viewer
from tallgrass.engine.camera import Camera
from tallgrass.systems.prairie import Prairie
from tallgrass.testing import LITTLE, Stage, little_prairie, looking, private_world, stage

FLAT = (
    LITTLE.replace("noise: rolling, seed: 2, size: [60, 60], feature: 30, scale: 4", "noise: flat, size: [60, 60]")
    .replace("blades: 60", "blades: 300")
    .replace("carpet_to: 12", "carpet_to: 20")
)
BREEZE = FLAT + "wind: [{ kind: breeze, strength: 0.3 }]\n"
ABOVE = looking(0.6, 4.2, 22.0, pitch=-30.0, view=55.0)
PATCH = 2.5
PLACES = {"blades": (0.6, 17.8), "strips": (0.6, 11.0), "carpet": (0.6, -1.5)}
"""Place in each representation that ABOVE shows."""

FEWEST = {"blades": 300, "strips": 100, "carpet": 30}
"""Least number of pixels there that change with the patch."""

SPLINES = 1.5 * PATCH
"""How far beyond its patch a message still counts a little: the carpet reads splines through four of them [m]."""

Picture = NDArray[np.float64]


@pytest.fixture(scope="module")
def easel(ctx: moderngl.Context) -> Iterator[Stage]:
    with stage(ctx, (240, 160)) as made:
        yield made


@pytest.fixture
def prairie(ctx: moderngl.Context) -> Iterator[Prairie]:
    with private_world(), little_prairie(scene=BREEZE, ctx=ctx) as made:
        yield made


def settled(prairie: Prairie, easel: Stage, camera: Camera = ABOVE, seconds: float = 2.0) -> Picture:
    """Return the picture after all transitions, when every patch has its entity; time advances meanwhile."""
    for _ in range(4):
        prairie.advance(seconds / 4)
        easel.shot(prairie, camera)
    return easel.shot(prairie, camera)


def patch_of(prairie: Prairie, place: tuple[float, float]) -> int:
    (entity,) = prairie.patch_at([place]).tolist()
    assert entity
    return int(entity)


def on_patch(easel: Stage, place: tuple[float, float], beyond: float) -> NDArray[np.bool_]:
    """Return the mask of pixels that may show grass of the patch at a place, or within a distance of it [m]."""
    low = np.floor(np.array(place) / PATCH) * PATCH - beyond
    shown = np.zeros(easel.size[::-1], np.bool_)
    for level in np.linspace(0.0, 0.95, 12):
        ground = easel.ground(ABOVE, float(level))
        shown |= ((ground >= low) & (ground <= low + PATCH + 2.0 * beyond)).all(axis=2)
    return shown


def apart(one: Picture, other: Picture) -> Picture:
    return np.asarray(np.abs(one - other).max(axis=2))


class Flatten(esper.Processor):
    """A game's own processor that bends the grass of one patch, as a thing lying there would."""

    def __init__(self, patch: int) -> None:
        self.patch = patch

    def process(self) -> None:
        for entity, receivers in esper.get_component(Receivers):
            if self.patch in {entity, receivers.patch}:
                receivers.message = (0.2, -0.85)
                with pytest.raises(ValueError, match=r"^the messages of \d+ receivers .* an array of shape \(1, 3\)$"):
                    receivers.message = np.ones((1, 3))


@pytest.mark.parametrize("name", PLACES)
def test_d2_a_processor_flattens_one_patch_through_its_receivers_and_no_other_changes(
    prairie: Prairie, easel: Stage, name: str
) -> None:
    before, patch = settled(prairie, easel), patch_of(prairie, PLACES[name])
    assert esper.component_for_entity(patch, Lod).representation == name
    esper.add_processor(Flatten(patch))
    for _ in range(3):  # the very same values every frame
        esper.process()
        flat = easel.shot(prairie, ABOVE)
    changed = apart(before, flat)
    around = on_patch(easel, PLACES[name], beyond=0.8 if name == "blades" else SPLINES)
    assert (changed > 2.0).sum() > FEWEST[name]
    assert changed[around].sum() > 0.99 * changed.sum()
    assert changed[~around].max() <= 15.0
    esper.remove_processor(Flatten)
    np.testing.assert_array_equal(easel.shot(prairie, ABOVE), before)


@pytest.mark.slow
def test_d2_a_patch_held_as_strips_beside_blades_goes_there_and_back_without_a_pop(
    prairie: Prairie, easel: Stage
) -> None:
    before = settled(prairie, easel)
    lod = esper.component_for_entity(patch_of(prairie, PLACES["blades"]), Lod)
    around = on_patch(easel, PLACES["blades"], beyond=0.8)
    lod.hold = "strips"
    pictures = [before]
    for _ in range(45):
        # Time stands still for the wind: what changes is the representation alone.
        prairie.viewers["main"].drawn_at = prairie.time - 1 / 30
        pictures.append(easel.shot(prairie, ABOVE))
    assert (lod.representation, lod.progress) == ("strips", 1.0)
    whole = apart(pictures[0], pictures[-1])
    assert (whole > 8.0).sum() > FEWEST["blades"]
    assert whole[~around].max() <= 15.0
    steps = [apart(one, other)[around].mean() for one, other in pairwise(pictures)]
    assert max(steps) < 0.3 * whole[around].mean()
    lod.hold = None
    for _ in range(15):
        prairie.viewers["main"].drawn_at = prairie.time - 1 / 10
        after = easel.shot(prairie, ABOVE)
    assert lod.representation == "blades"
    np.testing.assert_array_equal(after, before)


@pytest.mark.parametrize(("name", "how"), [("blades", "written"), ("strips", "deleted"), ("carpet", "put off")])
def test_d2_a_patch_taken_away_leaves_ground_and_comes_back(
    prairie: Prairie, easel: Stage, name: str, how: str
) -> None:
    before, entity = settled(prairie, easel), patch_of(prairie, PLACES[name])
    if how == "written":
        esper.component_for_entity(entity, Patch).grows = False
    else:
        esper.delete_entity(entity, immediate=how == "deleted")  # otherwise esper puts it off
    bare = easel.shot(prairie, ABOVE)
    around = on_patch(easel, PLACES[name], beyond=0.8 if name == "blades" else SPLINES)
    changed = apart(before, bare)
    assert (changed > 8.0).sum() > FEWEST[name] / 2
    assert changed[~around].max() <= 15.0
    (x, z), mid = PLACES[name], (PATCH / 2,) * 2
    middle = np.floor(np.array([x, z]) / PATCH) * PATCH + mid
    column, row = easel.project(ABOVE, np.array([[middle[0], 0.0, middle[1]]]))[0].astype(int)
    soil = bare[row : row + 1, column - 2 : column + 3]
    hue = soil / soil.sum(axis=-1, keepdims=True)  # litter is brighter and darker, of one hue
    assert hue.std(axis=(0, 1)).max() < 0.004, "nothing but ground is there"
    again = patch_of(prairie, PLACES[name])
    assert (again == entity) == (how == "written")
    esper.component_for_entity(again, Patch).grows = True
    np.testing.assert_array_equal(easel.shot(prairie, ABOVE), before)


def test_n10_the_system_lod_may_be_a_games_own(prairie: Prairie, easel: Stage) -> None:
    before = settled(prairie, easel)

    def stripes() -> None:
        for _, (patch, lod) in esper.get_components(Patch, Lod):
            lod.wanted = "strips" if patch.cell[0] % 2 == 0 and lod.distance < 8 else "carpet"

    prairie.systems.replace("lod", stripes)
    after = settled(prairie, easel)
    assert apart(before, after).mean() > 1.0
    assert set(prairie.statistics.patches) == {"blades", "strips", "carpet"}
    assert prairie.statistics.patches["blades"] == 0
    kinds = {(patch.cell[0] % 2, lod.representation) for _, (patch, lod) in esper.get_components(Patch, Lod)}
    assert kinds >= {(0, "strips"), (0, "carpet"), (1, "carpet")}
    assert (1, "strips") not in kinds


@pytest.mark.parametrize("name", ["tile", "lod", "see", "plant"])
def test_d3_any_system_may_be_left_out_before_the_first_frame_and_after_another_reading(
    ctx: moderngl.Context, easel: Stage, tmp_path: Path, name: str
) -> None:
    path = tmp_path / "scene.yaml"
    path.write_text(BREEZE, "utf-8")
    with private_world():
        prairie = Prairie.load(path, ctx=ctx)
        prairie.systems.replace(name, lambda: None)
        assert np.ptp(easel.shot(prairie, ABOVE)) > 50.0, "there is no land"
        path.write_text(BREEZE.replace("blades: 300", "blades: 200"), "utf-8")
        prairie.reload()
        easel.shot(prairie, ABOVE)
        assert prairie.systems.failures == {}
        prairie.release()


def test_d3_drawing_is_a_system_that_a_game_may_order_its_own_around_and_leave_out(
    prairie: Prairie, easel: Stage
) -> None:
    whole, seen = settled(prairie, easel), list[int]()

    def look() -> None:
        seen.append(len(np.unique(easel.read().reshape(-1, 3), axis=0)))

    prairie.systems.add("draw", "before", look, before="draw")
    prairie.systems.add("draw", "after", look, after="draw")
    np.testing.assert_array_equal(easel.shot(prairie, ABOVE), whole)
    assert seen[0] == 1
    assert seen[1] > 50
    prairie.systems.disable("draw")
    assert len(np.unique(easel.shot(prairie, ABOVE).reshape(-1, 3), axis=0)) == 1
    prairie.systems.enable("draw")
    for name in ("before", "after"):
        prairie.systems.remove(name)
    np.testing.assert_array_equal(easel.shot(prairie, ABOVE), whole)


def test_n10_a_system_between_wind_and_drawing_is_seen(prairie: Prairie, easel: Stage) -> None:
    before = settled(prairie, easel)

    def comb() -> None:
        for _, receivers in esper.get_component(Receivers):
            receivers.message[:, 0] = 0.3
            receivers.message *= (2.0, 1.0)

    prairie.systems.add("blow", "comb", comb, after="wind")
    assert [system.name for system in prairie.systems][-3:] == ["comb", "gather", "draw"]
    combed = easel.shot(prairie, ABOVE)
    assert apart(before, combed).mean() > 1.0
    prairie.systems.disable("comb")
    np.testing.assert_array_equal(easel.shot(prairie, ABOVE), before)


def test_d6_a_system_that_raises_is_named_once_and_the_picture_is_that_without_it(
    prairie: Prairie, easel: Stage, caplog: pytest.LogCaptureFixture
) -> None:
    before = settled(prairie, easel)
    prairie.systems.add("see", "broken", lambda: 1 // 0, before="see")
    with caplog.at_level(logging.WARNING, "tallgrass"):
        pictures = [easel.shot(prairie, ABOVE) for _ in range(3)]
    for picture in pictures:
        np.testing.assert_array_equal(picture, before)
    assert [record.message for record in caplog.records if "broken" in record.message] == [
        record.message for record in caplog.records
    ]
    assert len(caplog.records) == 1
    assert "ZeroDivisionError" in caplog.records[0].message


def walked(prairie: Prairie, easel: Stage, cameras: dict[str, Callable[[float], Camera]]) -> dict[str, list[Picture]]:
    """Return the pictures of walking viewers, drawn one after another in every frame."""
    pictures: dict[str, list[Picture]] = {name: [] for name in cameras}
    for frame in range(6):
        prairie.advance(0.2)
        for name, camera in cameras.items():
            easel.begin()
            prairie.draw(*easel.matrices(camera(0.2 * frame)), viewer=name)
            pictures[name].append(easel.read())
    return pictures


def test_two_viewers_in_a_frame_see_what_each_would_see_alone(ctx: moderngl.Context, easel: Stage) -> None:
    cameras: dict[str, Callable[[float], Camera]] = {
        "left": lambda time: looking(0.6, 1.7, 22.0 - 3.0 * time, pitch=-8.0, view=55.0),
        "right": lambda time: looking(-14.0 + 2.0 * time, 4.0, -12.0, yaw=100.0, pitch=-15.0, view=45.0),
    }
    with private_world(), little_prairie(scene=BREEZE, ctx=ctx) as both:
        together = walked(both, easel, cameras)
        assert {viewer.name for _, viewer in esper.get_component(Viewer)} == {"left", "right"}
    for name, camera in cameras.items():
        with private_world(), little_prairie(scene=BREEZE, ctx=ctx) as alone:
            for one, other in zip(together[name], walked(alone, easel, {name: camera})[name], strict=True):
                np.testing.assert_array_equal(one, other)


def test_a_patch_taken_away_is_gone_for_every_viewer(prairie: Prairie, easel: Stage) -> None:
    settled(prairie, easel)
    easel.begin()
    prairie.draw(*easel.matrices(ABOVE), viewer="other")
    grown = easel.read()
    (entity,) = prairie.patch_at([PLACES["strips"]], viewer="other").tolist()
    esper.delete_entity(entity, immediate=True)
    bare = easel.shot(prairie, ABOVE)  # the viewer who looks first has another entity there
    easel.begin()
    prairie.draw(*easel.matrices(ABOVE), viewer="other")
    np.testing.assert_array_equal(easel.read(), bare)
    assert apart(grown, bare).max() > 8.0


def test_a_viewer_whose_entity_is_deleted_begins_anew(prairie: Prairie, easel: Stage) -> None:
    before = settled(prairie, easel)
    ((entity, viewer),) = esper.get_component(Viewer)
    patches = len(esper.get_component(Patch))
    assert patches > 300
    esper.delete_entity(entity, immediate=True)
    np.testing.assert_array_equal(easel.shot(prairie, ABOVE), before)
    ((again, other),) = esper.get_component(Viewer)
    assert other is not viewer
    assert again != entity
    assert len(esper.get_component(Patch)) <= 200


def test_the_face_has_what_a_game_writes() -> None:
    assert {"Patch", "Lod", "Receivers", "Phase", "Viewer"} <= set(tallgrass.__all__)


def test_what_is_printed_of_an_entity_is_what_it_holds(prairie: Prairie, easel: Stage) -> None:
    settled(prairie, easel)
    entity = patch_of(prairie, PLACES["strips"])
    lod = esper.component_for_entity(entity, Lod)
    lod.hold = "carpet"
    assert repr(lod).startswith("Lod(viewer='main', distance=4, visible=True, representation='strips', ")
    assert repr(lod).endswith(" hold='carpet')")
    patch = esper.component_for_entity(entity, Patch)
    assert repr(patch).startswith(f"Patch(cell={patch.cell}, model=")
    assert repr(patch).endswith(" grows=True)")
    said = {repr(receivers) for _, receivers in esper.get_component(Receivers)}
    assert f"Receivers(patch={entity}, representation='strips', viewer='main')" in said
