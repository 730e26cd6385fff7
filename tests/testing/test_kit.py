"""The kit for tests of a game's own systems: worlds, clocks, contexts, little prairies, steps, receivers (D6)."""

import subprocess
import sys
from collections.abc import Iterator

import esper
import moderngl
import numpy as np
import pyglet
import pytest

from tallgrass import Breeze, Gust, Prairie, SceneError
from tallgrass.testing import (
    FixedClock,
    Heard,
    NoContextError,
    Phase,
    Stage,
    fixed_clock,
    headless_context,
    little_prairie,
    little_site,
    look,
    looking,
    private_world,
    receivers_of,
    step,
    systems_on,
    viewer_on,
    watch,
)


def test_a_private_world_is_empty_and_the_hosts_is_back_after_it() -> None:
    with private_world():
        host, theirs = esper.current_world, esper.create_entity("theirs")
        with private_world() as inner:
            assert list(esper.get_entities()) == []
            inner.create("ours")
            esper.create_entity("another")
            name = esper.current_world
        assert (esper.current_world, list(esper.get_entities())) == (host, [theirs])
        assert name not in esper.list_worlds()


def test_a_private_world_is_left_by_an_error_too_and_wherever_the_body_went() -> None:
    host, worlds = esper.current_world, set(esper.list_worlds())

    def stray() -> None:
        with private_world() as made:
            esper.switch_world(host)
            esper.delete_world(made.name)
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        stray()
    assert (esper.current_world, set(esper.list_worlds())) == (host, worlds)


def test_a_fixed_clock_gives_the_same_instants_in_every_run() -> None:
    clock = FixedClock(1 / 60)
    assert [clock(), clock(), clock.time] == [0.0, 0.0, 0.0]
    with fixed_clock(1 / 60) as clock:
        assert clock.tick(60) == 1.0
        assert clock.tick() == round(61 / 60, 6)


def test_what_a_game_schedules_by_pyglet_runs_when_the_fixed_clock_ticks() -> None:
    host, told = pyglet.clock.get_default(), list[float]()
    with fixed_clock(0.25) as clock:
        pyglet.clock.schedule(told.append)
        pyglet.clock.schedule_interval(lambda _: told.append(9.0), 1.0)
        clock.tick(4)
        assert told == pytest.approx([0.25, 0.25, 0.25, 0.25, 9.0])
    assert pyglet.clock.get_default() is host
    pyglet.clock.tick(poll=True)
    assert len(told) == 5


@pytest.mark.parametrize("wrong", [0.0, -1.0, float("nan"), float("inf")])
def test_a_clock_without_steps_is_refused(wrong: float) -> None:
    with pytest.raises(ValueError, match="a clock's step is above 0 s"):
        FixedClock(wrong)
    with pytest.raises(ValueError, match="time does not run back by 2 steps"):
        FixedClock().tick(-2)


def test_without_any_gl_a_headless_context_says_what_to_install_in_one_sentence(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def create_context(**_: object) -> moderngl.Context:
        raise OSError("libEGL.so not loaded")

    monkeypatch.setattr(moderngl, "create_context", create_context)
    with pytest.raises(
        NoContextError, match=r"^no OpenGL 3\.3 .*libEGL.so.*\(tallgrass doctor says what to install\)$"
    ):
        headless_context().__enter__()


@pytest.mark.usefixtures("ctx")
def test_a_headless_context_can_be_drawn_in_at_once() -> None:
    program = """
from tallgrass.testing import headless_context, little_prairie, private_world, stage
with headless_context() as ctx:
    ctx.fbo.clear(1.0)
    with private_world(), stage(ctx, (64, 36)) as made, little_prairie(ctx=ctx) as prairie:
        print(made.shot(prairie).std() > 10.0, ctx.error)
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert (done.stdout, done.stderr) == ("True GL_NO_ERROR\n", "")


@pytest.fixture
def prairie() -> Iterator[Prairie]:
    with private_world(), little_prairie(Breeze(direction=90.0, strength=0.5, swing=0.0)) as made:
        yield made


def test_a_little_prairie_needs_no_gl_and_leaves_nothing_behind() -> None:
    with private_world():
        with little_prairie() as prairie:
            watch(prairie)
            assert esper.get_entities()
            assert not prairie.wind_at([(0.0, 0.0)]).any()
        assert list(esper.get_entities()) == []


def test_a_little_prairie_grows_other_scenes_and_refuses_bad_ones() -> None:
    with private_world():
        with little_prairie(scene="tallgrass: 2\ngrass: { lawn: { height: [0.1, 0.2] } }\nquality: low\n") as lawn:
            assert list(lawn.scene.grass) == ["lawn"]
        with pytest.raises(SceneError, match="<scene>:2"), little_prairie(scene="tallgrass: 2\nmeadow: 2\n"):
            pass


def test_receivers_of_all_kinds_and_representations_have_heard_the_wind(prairie: Prairie) -> None:
    watch(prairie)
    assert len(receivers_of(prairie)) == 0, "nothing has been planted yet"
    prairie.advance(30.0)
    step(prairie, Phase.BLOW)
    heard = receivers_of(prairie)
    assert {*zip(heard.kind.tolist(), heard.representation.tolist(), strict=True)} == {
        (kind, name) for kind in ("tall", "short") for name in ("blades", "strips")
    }
    assert heard.place.shape == heard.message.shape == (len(heard), 2)
    assert len(heard) == len(heard.only(representation="blades")) + len(heard.only(representation="strips"))
    for kind in ("tall", "short"):
        some = heard.only(kind=kind, representation="strips")
        np.testing.assert_allclose(some.message, prairie.wind_at(some.place, kind=kind), atol=0.1)
    assert heard.index.min() > 0.2
    assert heard.message[:, 0].min() > 0.2, "the breeze blows to the right"
    np.testing.assert_allclose(heard.index, np.linalg.norm(heard.message, axis=1), rtol=1e-6)


def test_receivers_can_be_asked_for_near_a_place() -> None:
    heard = Heard(
        np.array([[0, 0], [3, 4], [0, -6]], np.float32),
        np.zeros((3, 2), np.float32),
        np.array(["a", "b", "a"]),
        np.array(["blades"] * 3),
        ("a", "b"),
        ("blades", "strips"),
    )
    assert heard.near(0.0, 0.0, within=5.0).place.tolist() == [[0, 0], [3, 4]]
    assert heard.near(0.0, -6.0, within=0.5).only(kind="b").place.tolist() == []


def test_receivers_of_an_unknown_name_are_refused_in_a_sentence(prairie: Prairie) -> None:
    watch(prairie)
    heard = receivers_of(prairie)
    with pytest.raises(ValueError, match=r"^unknown grass 'zzz'; there are tall, short$"):
        heard.only(kind="zzz")
    with pytest.raises(ValueError, match=r"^unknown representation 'carpet'; there are blades, strips$"):
        heard.only(kind="tall", representation="carpet")


def test_what_is_no_camera_and_no_size_is_refused_in_a_sentence(prairie: Prairie) -> None:
    with pytest.raises(TypeError, match=r"^a camera is made by looking\(x, y, z\), unlike 5$"):
        watch(prairie, 5)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"^a stage has 1 by 1 pixels at least, not 0 by 90$"):
        Stage(None, (0, 90))  # type: ignore[arg-type]


def test_n10_one_system_runs_and_no_other(prairie: Prairie) -> None:
    watch(prairie)
    step(prairie, "plant")
    assert not receivers_of(prairie).message.any()
    step(prairie, "wind")
    assert receivers_of(prairie).index.all()
    outlook = prairie.viewers["main"]
    before = outlook.patches.cell.copy()
    x, y, z = outlook.viewer.eye
    outlook.viewer.eye = (x + 3.0 * prairie.site.ground.patch, y, z)
    step(prairie, "wind")
    np.testing.assert_array_equal(outlook.patches.cell, before)
    step(prairie, Phase.TILE)
    assert (outlook.patches.cell != before).any()


def test_a_step_without_what_comes_before_it_is_refused_in_one_sentence(prairie: Prairie) -> None:
    built_in = "press, tile, cull, lod, transition, see, plant, wind, gather, draw"
    with pytest.raises(KeyError, match=f"no system 'moths'; there are {built_in}"):
        step(prairie, "moths")
    with pytest.raises(KeyError, match=r"no system 'winds', did you mean 'wind'\?"):
        step(prairie, "winds")
    with pytest.raises(RuntimeError, match=r"'wind' needs a viewer: call watch\(prairie\) first"):
        step(prairie, "wind")
    watch(prairie)
    with pytest.raises(RuntimeError, match="'DRAW' needs a graphics context: draw the prairie first"):
        step(prairie, Phase.DRAW)


def test_a_system_that_is_stepped_knows_what_time_it_is(prairie: Prairie) -> None:
    watch(prairie)
    told = list[float]()
    prairie.systems.add("blow", "clock", lambda: told.append(prairie.viewers["main"].viewer.time))
    step(prairie, "clock")
    prairie.advance(4.0)
    step(prairie, "clock")
    assert told == [0.0, 4.0]


def test_a_site_and_its_viewers_are_enough_for_the_systems_to_run_without_a_prairie() -> None:
    site = little_site()
    assert little_site() is site, "it is grown once"
    with private_world() as world:
        here, there = viewer_on(site, world), viewer_on(site, world, looking(0.0, 2.0, -20.0), name="there")
        systems = systems_on(site, [here, there], world)
        systems.step("tile")
        assert here.patches.alive.any()
        assert not here.patches.visible.any(), "no other system has run"
        systems.run(last=Phase.BLOW)
        assert here.patches.visible.any()
        (carpet,) = here.kept["carpet"].receiving
        assert not carpet.messages.current(carpet.slots).any(), "there is no wind"
        centre = here.viewer.centre.copy()
        assert (centre != there.viewer.centre).any()
        look(here, site, looking(0.0, 2.0, -20.0), time=0.5)
        assert (here.viewer.time, here.viewer.jumped) == (0.5, True)
        systems.step("tile")
        np.testing.assert_array_equal(here.viewer.centre, there.viewer.centre)


def test_a_gust_is_felt_where_it_is(ctx: moderngl.Context) -> None:
    gust = Gust(position=[0.0, 10.0], direction=90.0, speed=4.0, width=8.0)
    with private_world(), little_prairie(gust, ctx=ctx) as prairie:
        prairie.advance(1.0)
        made = Stage(ctx, (64, 36))
        made.shot(prairie)
        made.release()
        heard = receivers_of(prairie)
        assert heard.index.max() > 0.3
        assert (heard.index == 0.0).any()


def test_the_kit_needs_no_test_runner_and_a_winds_own_test_no_window_library() -> None:
    program = "import sys, tallgrass.testing; print({'pytest', 'pyglet'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout == "set()\n"
