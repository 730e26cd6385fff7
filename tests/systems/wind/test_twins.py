"""Twins of the bundled winds: the graphics card computes the same as numpy, at any place and time (N1, N4)."""

from collections.abc import Iterator

import moderngl
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tallgrass.components.arrays import Floats
from tallgrass.components.pose import Pose
from tallgrass.components.wind import Extent, Grass, Mixing, WindPrimitive, WindSource
from tallgrass.engine.gl import shaders
from tallgrass.engine.gl.stream import release_all
from tallgrass.engine.scene import read_scene
from tallgrass.systems.grow.record import Response
from tallgrass.systems.wind.blast import Blast, Shape
from tallgrass.systems.wind.blow import Blowing, blowing, hear, lone_receivers
from tallgrass.systems.wind.breeze import Breeze
from tallgrass.systems.wind.gust import Gust
from tallgrass.systems.wind.quarantine import Quarantine
from tallgrass.systems.wind.turbulence import Turbulence
from tallgrass.systems.wind.whirlwind import Whirlwind
from tallgrass.testing.twins import CLOSE_TWIN, CardEar

CALM = Breeze(strength=0.3, gustiness=0.0, swing=0.0, direction=0.0)
ROUNDED = 1.75
"""Factor on tolerances for a card's own sines and filters; NVIDIA's need 1.52."""

LATE = st.floats(0.0, 36000.0)
INDEX = st.floats(0.0, 1.0)
SOFT = st.floats(0.05, 20.0)
COAST = st.lists(st.floats(1.0, 6.0), min_size=3, max_size=12)
PATH = [{"at": 0.0, "position": [-20.0, 4.0]}, {"at": 30000.0, "position": [20.0, -9.0]}]
WINDS: dict[str, st.SearchStrategy[WindPrimitive]] = {
    "breeze": st.builds(
        Breeze, direction=st.floats(-360.0, 360.0), strength=INDEX, gustiness=INDEX, speed=st.floats(0.0, 40.0)
    ),
    "gust": st.builds(
        Gust,
        direction=st.floats(-360.0, 360.0),
        width=st.floats(1.0, 200.0),
        speed=st.floats(0.5, 60.0),
        reach=st.just(100000.0),
        strength=INDEX,
        hold=st.floats(0.0, 4.0),
        tail=st.floats(0.5, 6.0),
        ragged=st.floats(0.0, 9.0),
        soft=SOFT,
    ),
    "whirlwind": st.builds(
        Whirlwind,
        radius=st.floats(0.5, 40.0),
        strength=INDEX,
        spin=st.sampled_from(["left", "right"]),
        turning=st.floats(0.0, 10.0),
        soft=SOFT,
        path=st.just(Whirlwind.model_validate({"path": PATH}).path),
    ),
    "blast": st.builds(
        Blast,
        outline=st.one_of(
            st.builds(Shape, disc=st.floats(0.1, 30.0)),
            st.builds(Shape, ellipse=st.tuples(st.floats(0.1, 9.0), st.floats(0.1, 9.0)).map(list)),
            COAST.map(lambda far: Shape(polygon=star(far))),
        ),
        strength=INDEX,
        soft=SOFT,
        yaw=st.floats(-360.0, 360.0),
    ),
    "turbulence": st.builds(
        Turbulence,
        direction=st.floats(-360.0, 360.0),
        strength=INDEX,
        intensity=INDEX,
        scale=st.floats(2.0, 1000.0),
        speed=st.floats(0.0, 40.0),
    ),
}


def star(far: list[float]) -> list[list[float]]:
    """Return the corners of a polygon around the middle, which need not be convex."""
    turn = np.linspace(0.0, 2.0 * np.pi, len(far), endpoint=False)
    corners: list[list[float]] = np.stack([far * np.cos(turn), far * np.sin(turn)], axis=1).tolist()
    return corners


@pytest.fixture(scope="module")
def grass(responses: list[Response]) -> Grass:
    rise, fall = (np.stack([getattr(each, name) for each in responses]) for name in ("rise", "fall"))
    return Grass(np.zeros(0, np.intp), np.array([each.step for each in responses], np.float32), rise, fall)


@pytest.fixture(scope="module")
def ear(ctx: moderngl.Context, grass: Grass) -> Iterator[CardEar]:
    made = CardEar(ctx, grass)
    yield made
    assert not made.card.reasons
    made.release()


def mixed(place: Floats, grass: Grass) -> Grass:
    """Return grass of both kinds, in turn."""
    return Grass(np.arange(len(place)) % 2, grass.step, grass.rise, grass.fall)


def both(
    ear: CardEar, grass: Grass, now: list[Blowing], place: Floats, *, time: float, mixing: Mixing
) -> tuple[Floats, Floats]:
    """Return the messages computed by the card, and by numpy."""
    receivers, quarantine = lone_receivers(place, mixed(place, grass)), Quarantine()
    found = ear.hear(now, receivers, quarantine, time=time, seed=7, mixing=mixing)
    return found, hear(now, receivers, quarantine, time=time, seed=7, mixing=mixing)


def at_once(*winds: WindPrimitive, time: float) -> list[Blowing]:
    return blowing([WindSource(wind, wind.kind) for wind in winds], Quarantine(), time=time, seed=7)


def around(pose: Pose, extent: Extent | None, count: int) -> Floats:
    """Return random ground positions in a wind's extent and a little beyond it."""
    box = (-60.0, 60.0, -60.0, 60.0) if extent is None else (extent.left, extent.right, extent.ahead, extent.behind)
    low, high = np.array([box[0], box[2]]) - 0.5, np.array([box[1], box[3]]) + 0.5
    own = np.random.default_rng(3).uniform(low, high, (count, 2)).astype(np.float32)
    return pose.outside(own) + np.array([pose.x, pose.z], np.float32)


@pytest.mark.parametrize("mixing", ["priority", "weight"])
def test_n4_storm_is_heard_on_the_card_as_it_is_by_numpy(ear: CardEar, grass: Grass, mixing: Mixing) -> None:
    scene = read_scene("storm").scene
    sources = [WindSource(wind, f"wind[{number}] {wind.kind}") for number, wind in enumerate(scene.wind)]
    place = np.random.default_rng(1).uniform(-50.0, 50.0, (4000, 2)).astype(np.float32)
    met: set[str] = set()
    for time in np.linspace(0.1, 19.9, 20).tolist():
        now = blowing(sources, Quarantine(), time=time, seed=scene.seed)
        found, due = both(ear, grass, now, place, time=time, mixing=mixing)
        assert np.abs(found - due).max() <= CLOSE_TWIN, time
        assert np.linalg.norm(due, axis=1).max() > 0.5
        met |= {wind.primitive.kind for wind in now}
    assert met == {"breeze", "gust", "whirlwind", "blast"}


@pytest.mark.parametrize("kind", WINDS)
@settings(max_examples=25)
@given(data=st.data(), time=LATE)
def test_n4_a_wind_of_any_values_is_heard_alike_at_any_time(
    ear: CardEar, grass: Grass, kind: str, data: st.DataObject, time: float
) -> None:
    wind = data.draw(WINDS[kind])
    if isinstance(wind, Gust):
        wind = wind.model_copy(update={"start": max(0.0, time - 0.4 * wind.life)})
    now = at_once(wind, time=time)
    assert len(now) == 1
    place = around(now[0].pose, now[0].extent, 600)
    found, due = both(ear, grass, now, place, time=time, mixing="weight")
    assert np.abs(found - due).max() <= ROUNDED * CLOSE_TWIN


@pytest.mark.parametrize(
    "wind",
    [
        Blast(outline=Shape(polygon=[[-4.0, 3.0], [0.0, -5.0], [4.0, 3.0], [0.0, 0.0]]), soft=0.0, yaw=33.0),
        Blast(outline=Shape(ellipse=[3.6, 4.6]), position=[7.0, -3.0]),
        Whirlwind(radius=6.0, soft=0.0),
        Gust(position=[-20.0, 3.0], direction=40.0, soft=0.0, width=10.0),
    ],
)
def test_n4_masks_end_at_the_same_places(ear: CardEar, grass: Grass, wind: WindPrimitive) -> None:
    """Pairs of places 0.1 mm apart across every rim, where a wind of higher claim cancels a steady breeze."""
    now = at_once(wind, CALM, time=4.0)
    turn = np.linspace(0.0, 2.0 * np.pi, 90)
    rays = np.stack([np.cos(turn), np.sin(turn)], axis=1)[:, None] * np.linspace(0.0, 12.0, 12001)[:, None]
    steps, own = rays.reshape(-1, 2).astype(np.float32), now[0].pose
    held = wind.mask(steps, time=4.0).reshape(90, -1) > 0.0
    ray, edge = np.nonzero(held[:, 1:] != held[:, :-1])
    assert len(ray) >= 40
    fine = rays[ray, edge][:, None] + (rays[ray, edge + 1] - rays[ray, edge])[:, None] * np.linspace(-1, 2, 31)[:, None]
    place = own.outside(fine.reshape(-1, 2).astype(np.float32)) + np.array([own.x, own.z], np.float32)
    found, due = both(ear, grass, now, place, time=4.0, mixing="priority")
    differ = (np.abs(found - due).max(axis=1) > CLOSE_TWIN).reshape(len(ray), -1)
    assert differ.sum(axis=1).max() <= 1, "no farther than a rounding apart"
    assert differ.sum() <= ROUNDED * 0.1 * len(ray)


@given(st.floats(0.0, 1.0), st.floats(0.0, 1.0), st.sampled_from(["priority", "weight"]))
@settings(max_examples=20)
def test_f7_equal_priorities_and_winds_that_set_in_are_mixed_alike(
    ear: CardEar, grass: Grass, one: float, other: float, mixing: Mixing
) -> None:
    winds = [
        Whirlwind(weight=one, start=1.0, ease=2.0, priority=5),
        Blast(weight=other, priority=5, position=[3.0, 0.0]),
        Gust(weight=0.7, position=[-20.0, 0.0], start=1.0),
        Breeze(weight=0.9),
    ]
    place = np.random.default_rng(2).uniform(-9.0, 9.0, (900, 2)).astype(np.float32)
    found, due = both(ear, grass, at_once(*winds, time=2.1), place, time=2.1, mixing=mixing)
    assert np.abs(found - due).max() <= CLOSE_TWIN


def test_w10_still_receivers_take_no_part_in_the_small_oscillations(ear: CardEar, grass: Grass) -> None:
    place = np.random.default_rng(4).uniform(-9.0, 9.0, (200, 2)).astype(np.float32)
    alone = lone_receivers(place, mixed(place, grass))
    receivers = type(alone)(place, alone.grass, alone.patch, place, 0.0, still=120)
    now = at_once(Breeze(swing=0.5), time=3.0)
    found = ear.hear(now, receivers, Quarantine(), time=3.0, seed=7, mixing="priority")
    np.testing.assert_allclose(found, hear(now, receivers, Quarantine(), time=3.0, seed=7), rtol=0.0, atol=CLOSE_TWIN)
    moving, _ = both(ear, grass, now, place, time=3.0, mixing="priority")
    assert (found == moving).all(axis=1).tolist() == [True] * 80 + [False] * 120


def test_where_nothing_blows_grass_is_at_rest(ear: CardEar, grass: Grass) -> None:
    place = np.random.default_rng(4).uniform(-9.0, 9.0, (50, 2)).astype(np.float32)
    found, _ = both(ear, grass, [], place, time=3.0, mixing="weight")
    assert not found.any()


def test_a_fragment_shader_hears_the_same(
    ctx: moderngl.Context, ear: CardEar, grass: Grass, monkeypatch: pytest.MonkeyPatch
) -> None:
    sources = {
        "all.vert": "void main() {\n"
        "    gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0);\n}",
        "heard.frag": '#include "systems/wind/hear.glsl"\nout vec2 message;\nvoid main() {\n'
        "    int number = int(gl_FragCoord.y) * 40 + int(gl_FragCoord.x);\n"
        "    message = hear(gl_FragCoord.xy - 20.0, number % 2, false, number);\n}",
    }
    read = vars(shaders)["_read"]
    monkeypatch.setattr(
        shaders, "_read", lambda name: tuple(sources[name].splitlines()) if name in sources else read(name)
    )
    x, z = np.meshgrid(np.arange(40) - 19.5, np.arange(40) - 19.5)
    place = np.stack([x, z], axis=-1).reshape(-1, 2).astype(np.float32)
    now = at_once(Breeze(), Gust(position=[-20.0, 0.0]), Blast(), time=2.0)
    _, due = both(ear, grass, now, place, time=2.0, mixing="weight")
    made = ear.card.program("all.vert", "heard.frag")
    ear.card.use()
    texture = ctx.texture((40, 40), 2, dtype="f4")
    target, array = ctx.framebuffer([texture]), ctx.vertex_array(made, [])
    target.use()
    array.render(moderngl.TRIANGLES, vertices=3)
    found = np.frombuffer(texture.read(), np.float32).reshape(-1, 2)
    np.testing.assert_allclose(found, due, rtol=0.0, atol=CLOSE_TWIN)
    release_all(array, target, texture)
