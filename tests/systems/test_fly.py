"""A saucer's hovering, its lean and the foot of its jet, on arrays alone."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tallgrass.components.arrays import Floats
from tallgrass.components.body import Body
from tallgrass.components.pose import Pose
from tallgrass.components.wind import WindSource
from tallgrass.engine.declared.way import Waypoint
from tallgrass.engine.world import World
from tallgrass.systems.bodies.draw import axes
from tallgrass.systems.bodies.fly import DRAG, GRAVITY, HOVER, LOWEST, STEEPEST, carried, flying, foot, lean, level
from tallgrass.systems.wind.blast import Blast
from tallgrass.systems.wind.quarantine import Quarantine

angles = st.floats(-math.pi, math.pi)
tilts = st.floats(-0.5, 0.5)
pushes = st.tuples(st.floats(-40.0, 40.0), st.floats(-40.0, 40.0))


def flat(xz: Floats) -> Floats:
    return np.full(len(xz), 3.0, np.float32)


def bumps(xz: Floats) -> Floats:
    return np.asarray(1.5 * np.sin(1.1 * xz[:, 0]) * np.cos(0.9 * xz[:, 1]), np.float32)


@given(velocity=pushes, gain=pushes, yaw=angles)
def test_r4_a_saucer_leans_the_way_it_is_pushed_and_never_too_far(
    velocity: tuple[float, float], gain: tuple[float, float], yaw: float
) -> None:
    nose, bank = lean(velocity, gain, yaw)
    up = axes(Body((0.0, 0.0, 0.0), yaw, nose, bank))[1]
    push = np.array(gain) + DRAG * np.array(velocity)
    assert math.acos(min(1.0, up[1])) < STEEPEST + 1e-9
    assert abs(up[0] * push[1] - up[2] * push[0]) < 1e-9 * (1.0 + np.abs(push).max())
    assert up[0] * push[0] + up[2] * push[1] >= 0.0


def test_r4_a_gentle_push_tilts_as_gravity_asks() -> None:
    assert lean((0.0, 0.0), (0.0, -0.1), 0.0) == pytest.approx((-0.1 / GRAVITY, 0.0), abs=1e-5)
    assert lean((0.0, 0.0), (0.1, 0.0), 0.0) == pytest.approx((0.0, 0.1 / GRAVITY), abs=1e-5)
    assert lean((0.0, 0.0), (0.0, 0.0), 1.0) == (0.0, 0.0)


@given(yaw=angles, nose=tilts, bank=tilts, height=st.floats(0.5, 5.0))
def test_r4_the_jet_leaves_a_saucer_along_its_own_axis(yaw: float, nose: float, bank: float, height: float) -> None:
    body = Body((7.0, 3.0 + height, -2.0), yaw, nose, bank)
    up = axes(body)[1]
    there = foot(body, flat)
    assert (there.x, there.z) == pytest.approx((7.0 - up[0] / up[1] * height, -2.0 - up[2] / up[1] * height), abs=1e-4)
    assert there.yaw == yaw


@given(yaw=angles, nose=tilts, bank=tilts)
def test_a_bodys_axes_are_right_handed_and_turn_as_their_angles_say(yaw: float, nose: float, bank: float) -> None:
    turned = np.array(axes(Body((0.0, 0.0, 0.0), yaw, nose, bank)))
    np.testing.assert_allclose(turned @ turned.T, np.eye(3), atol=1e-12)
    np.testing.assert_allclose(np.cross(turned[0], turned[1]), turned[2], atol=1e-12)
    level_ahead = np.array([math.sin(yaw), 0.0, -math.cos(yaw)])
    assert -turned[2] @ level_ahead == pytest.approx(math.cos(nose))
    assert -turned[2][1] == pytest.approx(math.sin(nose)), "a raised nose is up"
    assert turned[0][1] == pytest.approx(-math.sin(bank) * math.cos(nose)), "banked right, the right side is down"


@given(st.floats(-50.0, 50.0), st.floats(-50.0, 50.0))
def test_r4_a_saucer_keeps_its_height_and_glides_over_bumps(x: float, z: float) -> None:
    assert level(x, z, flat) == pytest.approx(3.0 + HOVER)
    under = np.array([[x, z]], np.float32)
    assert level(x, z, bumps) >= float(bumps(under)[0]) + LOWEST - 1e-5
    along = np.linspace(0.0, 6.0, 61)
    heights = [level(x + way, z, bumps) for way in along]
    ground = bumps(np.column_stack([x + along, np.full(61, z)]).astype(np.float32))
    assert np.ptp(heights) <= 0.8 * np.ptp(ground) + 0.6


def circle(time: float) -> Pose:
    """Return the place on a circle of ten metres about the origin, clockwise from above, once in ten seconds."""
    angle = math.tau * time / 10.0
    return Pose(10.0 * math.sin(angle), -10.0 * math.cos(angle), angle + math.pi / 2)


def test_r4_along_a_path_a_saucer_banks_into_the_turn() -> None:
    for time in (0.0, 3.3, 8.1):
        body = carried(circle, time, flat)
        assert body.bank == pytest.approx(STEEPEST * math.tanh(math.atan2(3.95, GRAVITY) / STEEPEST), abs=0.03)
        assert -0.15 < body.nose < 0.0, "the air holds it back"
        assert body.place == pytest.approx((circle(time).x, 3.0 + HOVER, circle(time).z))
        assert body.yaw == circle(time).yaw


def test_r4_at_rest_it_hangs_level_and_speeding_up_it_lowers_its_nose() -> None:
    still = carried(lambda _: Pose(1.0, 2.0, 0.7), 5.0, flat, height=4.0)
    assert still == Body((1.0, 7.0, 2.0), 0.7)
    faster = carried(lambda time: Pose(0.0, -1.5 * time * time, 0.0), 1.0, flat)
    assert faster.nose < -0.2
    assert faster.bank == pytest.approx(0.0, abs=1e-9)


def test_r4_a_path_with_corners_makes_no_jump_in_how_it_leans() -> None:
    def zigzag(time: float) -> Pose:
        return Pose(abs(time - 2.0) * 3.0, 0.0, 0.0)

    banks = np.array([carried(zigzag, time, flat).bank for time in np.linspace(1.0, 3.0, 1601)])
    assert np.abs(np.diff(banks)).max() < 0.01
    assert banks.max() > 0.3


def test_r4_what_entities_have_flies_and_what_blasts_declare(world: World) -> None:
    own = Body((1.0, 9.0, 2.0), 0.3)
    world.create(own)
    posed = world.create(WindSource(Blast(body="saucer", height=3.0), "posed"), Pose(5.0, -4.0, 1.0))
    path = [Waypoint(at=0, position=[0, 0]), Waypoint(at=10, position=[0, -50])]
    world.create(WindSource(Blast(body="saucer", path=path, start=1.0, stop=9.0), "scripted"))
    world.create(WindSource(Blast(), "bare"))
    assert flying(world, flat, Quarantine(), time=0.5) == [own, Body((5.0, 6.0, -4.0), 1.0)]
    bodies = flying(world, flat, Quarantine(), time=5.0)
    assert bodies[:2] == [own, Body((5.0, 6.0, -4.0), 1.0)]
    assert bodies[2].place == pytest.approx((0.0, 3.0 + HOVER, -25.0))
    assert bodies[2].nose < 0.0
    world.add(posed, own)
    assert flying(world, flat, Quarantine(), time=9.0) == [own, own]


def test_r4_a_blast_that_cannot_say_where_it_is_neither_blows_nor_flies(world: World) -> None:
    class Adrift(Blast):
        def pose(self, *, time: float) -> Pose:
            raise LookupError(f"nowhere at {time} s")

    source = WindSource(Adrift(body="saucer"), "adrift")
    world.create(source)
    quarantine = Quarantine()
    assert flying(world, flat, quarantine, time=1.0) == []
    assert quarantine.reasons == {source: "adrift: pose raised LookupError: nowhere at 0.7 s"}
