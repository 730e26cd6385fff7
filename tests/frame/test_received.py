"""Messages that the graphics card computes for receivers equal numpy's (W1, N1, N4, T1, D2)."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import moderngl
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from tallgrass.components.arrays import Floats
from tallgrass.components.receivers import Receivers
from tallgrass.components.wind import WindPrimitive
from tallgrass.engine.camera import Camera, camera_at
from tallgrass.engine.terrain.sample import density_at, height_at
from tallgrass.systems.around.receivers import Receiving
from tallgrass.systems.grow.bend import bending
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.receive.received import ROW, Received
from tallgrass.systems.reference import carpet_painter
from tallgrass.systems.show.blades.draw import RIBBON
from tallgrass.systems.show.blades.painter import BladesPainter
from tallgrass.systems.show.blades.plant import standing_blades
from tallgrass.systems.show.blades.representation import BladeRepresentation
from tallgrass.systems.show.blades.shown import BladesShown
from tallgrass.systems.wind.blast import Blast, Shape
from tallgrass.systems.wind.breeze import Breeze
from tallgrass.systems.wind.turbulence import Turbulence
from tallgrass.systems.wind.whirlwind import Whirlwind
from tallgrass.testing import LITTLE

Stage = Any
Load = Callable[..., Prairie]
Aim = Callable[..., Camera]
OnCard = Callable[[Prairie], list[tuple[Receiving, Floats]]]

CLOSE = 1e-3
"""Tolerance between messages of the graphics card and of numpy, and between heights [m]."""

MAPPED = """\
tallgrass: 2
seed: 5
terrain: { noise: ridges, seed: 2, size: [60, 60], feature: 20, scale: 9 }
grass:
  tall: { height: [0.5, 0.9], width: 0.02, lean: 0.4, place: { map: map.png } }
  short: { height: [0.2, 0.4], width: 0.02, stiffness: 2, place: { map: map.png, channel: green } }
wind:
  - { kind: breeze, strength: 0.5, gustiness: 0.8 }
  - { kind: gust, position: [-20, 0], speed: 9, reach: 60, width: 30, every: [1, 2], wander: 10, weight: 0.7 }
  - { kind: gust, position: [0, -20], direction: 160, speed: 7, reach: 60, width: 40, every: [1, 3], weight: 0.6 }
  - { kind: whirlwind, position: [6, 14], radius: 6 }
  - { kind: blast, position: [-4, 12], outline: { ellipse: [3, 4] }, start: 1, ease: 2 }
mixing: MIXING
camera: { position: [0, 20], eye: 1.7, pitch: -12, view: 45 }
quality:
  blades: 60
  models: 2
  blade_rings: [{ to: 1, segments: 3 }, { to: 2, segments: 2 }]
  strip_rings:
    - { to: 5, strips: 4, columns: 2, sections: 2, texel: 0.02 }
    - { to: 8, strips: 2, columns: 1, sections: 1, texel: 0.03 }
  carpet_to: 12
  carpet: 32
"""


class Untwinned(Whirlwind):
    """A whirlwind without a twin, as of a plugin."""

    twin = None


def told_alike(prairie: Prairie, on_card: OnCard) -> dict[str, float]:
    """Compare the card's messages with numpy's for all receivers; return the largest index by representation."""
    ground, longest = prairie.site.ground, dict[str, float]()
    for receiving, texels in on_card(prairie):
        slots, told = receiving.slots, texels.reshape(-1, 4)
        place, kind = receiving.pool.places(slots).reshape(-1, 2), receiving.pool.kind(slots)
        heard = receiving.messages.heard(slots)
        np.testing.assert_allclose(told[:, :2], heard, atol=CLOSE, rtol=0.0)
        np.testing.assert_allclose(told[:, 2], height_at(ground.terrain, place), atol=CLOSE, rtol=0.0)
        dense = density_at(ground.density, place)[kind, np.arange(len(kind))]
        np.testing.assert_allclose(told[:, 3], dense, atol=1.5 / 255, rtol=0.0)
        name, index = receiving.representation, np.linalg.norm(heard, axis=1).max(initial=0.0)
        longest[name] = max(longest.get(name, 0.0), float(index))
    (carpet,), air = prairie.viewers["main"].kept["carpet"].receiving, on_carpet(prairie)
    heard = carpet.messages.heard(carpet.slots)
    np.testing.assert_allclose(air[carpet.slots], heard, atol=CLOSE, rtol=0.0)
    return {**longest, "carpet": float(np.linalg.norm(heard, axis=1).max())}


def on_carpet(prairie: Prairie) -> Floats:
    """Return the card's message in the middle of each patch, by row, shape (rows, 2)."""
    assert prairie.painter is not None
    return np.frombuffer(carpet_painter(prairie.painter).air.texture.read(), np.float32).reshape(-1, 2)


def mean_beyond(prairie: Prairie) -> Floats:
    """Return the mean message beyond all windows of the carpet, shape (2,): the texture's last row begins so."""
    assert prairie.painter is not None
    far = carpet_painter(prairie.painter).air.far
    rows = np.frombuffer(far.read(), np.float32)
    return rows.reshape(far.height, -1)[-1, :2]


@pytest.fixture(scope="module", params=["priority", "weight"])
def mapped(
    request: pytest.FixtureRequest, ctx: moderngl.Context, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Prairie]:
    """Prairie of two kinds with density maps on steep ground, in five winds, for either mixing."""
    folder: Path = tmp_path_factory.mktemp("mapped")
    picture = np.random.default_rng(1).integers(0, 256, (12, 12, 3), np.uint8)
    Image.fromarray(picture).resize((64, 64), Image.Resampling.BICUBIC).save(folder / "map.png")
    (folder / "scene.yaml").write_text(MAPPED.replace("MIXING", request.param), "utf-8")
    prairie = Prairie.load(folder / "scene.yaml", ctx=ctx)
    yield prairie
    prairie.release()


def walk(stage: Stage, prairie: Prairie, on_card: OnCard, *, instants: int, step: float) -> None:
    """Compare at some times of a walk along the scene's own path, turning all the time."""
    longest: dict[str, list[float]] = {"blades": [], "strips": [], "carpet": []}
    for number in range(instants):
        camera = camera_at(prairie.scene.camera, prairie.time, prairie.height_at)
        stage.shot(prairie, replace(camera, yaw=camera.yaw + 0.3 * number))
        for name, index in told_alike(prairie, on_card).items():
            longest[name].append(index)
        prairie.advance(step)
    for each in longest.values():
        assert np.mean(each) > 0.2, "there is something to compare"
    assert not prairie.winds.quarantine.reasons


def test_n1_in_a_storm_the_card_tells_every_receiver_what_numpy_does(stage: Stage, load: Load, on_card: OnCard) -> None:
    walk(stage, load("storm", preset="low"), on_card, instants=5, step=4.0)


def test_n1_on_steep_ground_with_density_maps_the_card_tells_what_numpy_does_in_both_mixings(
    stage: Stage, mapped: Prairie, on_card: OnCard
) -> None:
    walk(stage, mapped, on_card, instants=6, step=1.4)


@pytest.mark.parametrize("kind", [Whirlwind, Untwinned], ids=["with a twin", "without"])
def test_d5_a_wind_is_told_alike_with_and_without_a_twin(
    stage: Stage, mapped: Prairie, on_card: OnCard, kind: type[Whirlwind], caplog: pytest.LogCaptureFixture
) -> None:
    handle = mapped.add(kind(position=[-2.0, 15.0], radius=9.0, priority=25))
    felt = []
    for number in range(4):
        camera = camera_at(mapped.scene.camera, mapped.time, mapped.height_at)
        stage.shot(mapped, replace(camera, yaw=camera.yaw + 0.4 * number))
        felt.append(told_alike(mapped, on_card)["blades"])
        mapped.advance(0.3)
    mapped.remove(handle)
    assert min(felt) > 0.3
    assert caplog.messages == []


class UntwinnedBreeze(Breeze):
    """A breeze that numpy alone computes."""

    twin = None


def test_d5_grass_out_of_view_and_all_that_lies_farther_off_is_told_alike_with_and_without_a_twin(
    stage: Stage, load: Load
) -> None:
    felt = []
    for kind in (Breeze, UntwinnedBreeze):
        prairie = load(LITTLE)
        prairie.add(kind(strength=0.5, priority=9))
        prairie.advance(1.0)
        stage.shot(prairie)
        assert prairie.painter is not None
        felt += [on_carpet(prairie), mean_beyond(prairie)]
    assert np.linalg.norm(felt[1]) > 0.3
    np.testing.assert_allclose(felt[2], felt[0], atol=1e-4)
    np.testing.assert_allclose(felt[3], felt[1], atol=1e-4)


def test_n4_the_wind_as_it_is_asked_read_by_a_game_and_told_on_the_card_is_the_same(
    stage: Stage, mapped: Prairie, on_card: OnCard
) -> None:
    mapped.advance(0.4)
    stage.shot(mapped)
    told_by_card: dict[tuple[float, ...], Floats] = {}
    for receiving, texels in on_card(mapped):
        place, kind = receiving.pool.places(receiving.slots).reshape(-1, 2), receiving.pool.kind(receiving.slots)
        keys = map(tuple, np.column_stack([place, kind]).tolist())
        told_by_card |= zip(keys, texels.reshape(-1, 4)[:, :2], strict=True)
    compared, names = 0, list(mapped.scene.grass)
    told = [each for _, each in mapped.world.all(Receivers) if each.representation != "carpet"]
    for receivers in told[:: len(told) // 30]:
        place, message, kind = receivers.place, receivers.message, receivers.kind
        for number in set(kind.tolist()):
            asked = mapped.wind_at(place[kind == number], kind=names[number])
            np.testing.assert_allclose(message[kind == number], asked, rtol=0.0, atol=1e-6)
        for key, own in zip(map(tuple, np.column_stack([place, kind]).tolist()), message, strict=True):
            np.testing.assert_allclose(told_by_card[key], own, atol=CLOSE)
            compared += 1
    assert compared > 1000


@pytest.mark.parametrize("name", ["blades", "strips", "carpet"])
def test_d2_what_a_game_writes_reaches_the_card_for_those_receivers_and_that_frame_alone(
    stage: Stage, mapped: Prairie, camera: Aim, on_card: OnCard, name: str
) -> None:
    # Seen from higher up there would be no strips, which would show as rows; and from higher still no blades.
    aims = {"blades": (0.3, 9.0, 6.0, -55.0), "strips": (0.3, 6.0, 16.0, -15.0), "carpet": (0.3, 22.0, 6.0, -55.0)}
    *eye, pitch = aims[name]
    aim = camera(*eye, pitch=pitch)

    def frame() -> tuple[Any, list[Floats], Floats]:
        picture = stage.shot(mapped, aim)
        return picture, [texels.copy() for _, texels in on_card(mapped)], on_carpet(mapped).copy()

    for _ in range(3):  # so that all have entities
        frame()
    picture, pools, air = frame()
    receiving = mapped.viewers["main"].kept[name].receiving[0]
    middle = mapped.viewers["main"].patches.middle[receiving.rows]
    seen = stage.project(aim, np.column_stack([middle[:, 0], mapped.height_at(middle), middle[:, 1]]))
    nearest = int(np.abs(seen - np.array(stage.size) / 2).max(axis=1).argmin())
    place = receiving.pool.places(receiving.slots[nearest, None]).reshape(-1, 2)
    carried = [each for _, each in mapped.world.all(Receivers) if each.representation == name]
    receivers = next(each for each in carried if np.array_equal(each.place, place))
    receivers.message[:] = (0.0, -0.75)
    written, told, above = frame()
    if name == "carpet":
        air[receiving.slots[nearest]] = (0.0, -0.75)
    else:
        index = ["blades", "strips"].index(name)
        pools[index][nearest, :, :2] = (0.0, -0.75)
        np.testing.assert_allclose(told[index][nearest, :, 2], pools[index][nearest, :, 2], atol=CLOSE)
        np.testing.assert_allclose(told[index][nearest, :, 3], pools[index][nearest, :, 3], atol=1.5 / 255)
        pools[index][nearest, :, 2:] = told[index][nearest, :, 2:]
    for one, other in zip((*told, above), (*pools, air), strict=True):
        np.testing.assert_array_equal(one, other)
    again, after, _ = frame()
    told_alike(mapped, on_card)
    np.testing.assert_array_equal(again, picture)
    if name != "carpet":
        assert (written != picture).any()
        assert (after[index][nearest] != told[index][nearest]).any()


def test_f6_far_off_the_carpet_is_told_the_mean_of_patches_nearer_by(stage: Stage, mapped: Prairie) -> None:
    stage.shot(mapped)
    assert mapped.painter is not None
    air = on_carpet(mapped)
    side = int(len(air) ** 0.5)
    some = np.arange(12) * side // 12
    mean = mean_beyond(mapped)
    np.testing.assert_allclose(mean, air.reshape(side, side, 2)[np.ix_(some, some)].mean(axis=(0, 1)), atol=1e-5)
    assert np.linalg.norm(mean) > 0.05


def test_w1_each_blade_is_drawn_where_it_stands_with_its_own_message(
    stage: Stage, mapped: Prairie, on_card: OnCard
) -> None:
    stage.shot(mapped)
    assert mapped.painter is not None
    painter, near = mapped.painter.painters["blades"], mapped.site.representations[0]
    assert isinstance(painter, BladesPainter)
    assert isinstance(near, BladeRepresentation)
    outlook = mapped.viewers["main"]
    patches, shown = outlook.patches, outlook.shows(BladesShown).standing
    rows = patches.cell[shown.rows], patches.model[shown.rows], patches.turn[shown.rows]
    standing, _ = standing_blades(near.stock, *rows, mapped.site.ground)
    heard = on_card(mapped)[0][0].messages.heard(shown.slots).reshape(*standing.shape, 2)
    numbers, first = np.frombuffer(painter.shelves.now.numbers.buffer.read(), np.uint32), painter.morph.stream.count
    for ribbons in painter.groups:
        count = ribbons.stream.count
        made = np.frombuffer(ribbons.stream.buffer.read(), RIBBON)[:count]
        at = np.divmod(numbers[first : first + count].astype(np.int64), standing.shape[1])
        blade, message = standing[at], heard[at]
        np.testing.assert_allclose(made["foot"], np.column_stack([blade["root"], blade["height"]]), atol=CLOSE)
        of_kind = [bending(growth.postures, message) for growth in mapped.site.growths]
        bent = np.where(blade["kind"][:, None] == 0.0, *of_kind)
        lie = bent + blade["rest"] * (1.0 - np.minimum(np.linalg.norm(bent, axis=1, keepdims=True), 1.0))
        np.testing.assert_allclose(made["lean_across"][:, :2], lie, atol=CLOSE)
        np.testing.assert_array_equal(made["level_kind"][:, 2], blade["kind"])
        assert count > 100
        first += count


MANY = (
    LITTLE.replace("blades: 60", "blades: 2500").replace("models: 2", "models: 1").replace("to: 1, seg", "to: 2, seg")
    .replace("to: 2, segments: 2", "to: 3, segments: 2")
)  # fmt: skip


@pytest.mark.slow
def test_w1_more_receivers_than_there_was_room_for_are_all_told(
    stage: Stage, load: Load, camera: Aim, on_card: OnCard
) -> None:
    prairie = load(MANY)
    winds: list[WindPrimitive] = [
        Breeze(strength=0.4),
        Untwinned(position=[0.0, 0.0], radius=12.0),
        Blast(position=[3.0, 3.0], outline=Shape(disc=3.0)),
    ]
    for wind in winds:
        prairie.add(wind)
    stage.shot(prairie, camera(0.3, 9.0, 0.4, pitch=-89))
    assert prairie.painter is not None
    assert prairie.painter.received.texture.height > 64
    assert sum(texels.shape[0] * texels.shape[1] for _, texels in on_card(prairie)) > 64 * ROW
    assert told_alike(prairie, on_card)["blades"] > 0.3


def test_f8_every_representation_feels_turbulence_alike_even_after_hours(
    stage: Stage, load: Load, camera: Aim, on_card: OnCard
) -> None:
    prairie = load(LITTLE)
    prairie.add(Turbulence(strength=0.5, scale=6.0, speed=11.0))
    prairie.advance(20_000.0)
    for _ in range(3):
        prairie.advance(0.4)
        stage.shot(prairie, camera(0.3, 9.0, 1.7))
        assert min(told_alike(prairie, on_card).values()) > 0.2


@given(st.lists(st.integers(0, 3 * ROW), max_size=8))
def test_pools_never_overlap_and_each_starts_a_row(ctx: moderngl.Context, counts: list[int]) -> None:
    received = Received(ctx)
    first = received.allocate(counts)
    assert len(first) == len(counts)
    assert all(number % ROW == 0 for number in first)
    end = 0
    for start, count in zip(first, counts, strict=True):
        assert end <= start < end + ROW
        end = start + count
    assert end <= ROW * received.texture.height
    received.release()


def test_the_texture_grows_where_receivers_are_many_and_holds_the_last_of_them(ctx: moderngl.Context) -> None:
    received = Received(ctx)
    counts = [40_000, 1, 90_000]
    *_, last = received.allocate(counts)
    assert received.texture.height * ROW >= last + counts[-1] > 64 * ROW
    texels = np.arange(4 * 2500, dtype=np.float32).reshape(-1, 4)
    received.write(last + 1000, texels)
    found = np.frombuffer(received.texture.read(), np.float32).reshape(-1, 4)
    np.testing.assert_array_equal(found[last + 1000 :][: len(texels)], texels)
    height = received.texture.height
    assert received.allocate([10])[0] == 0
    assert received.texture.height == height, "it never shrinks"
    received.release()
