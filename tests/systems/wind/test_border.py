"""One wind for blades, strips and `wind_at` (W1, W5, N1, N4)."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.components.arrays import Floats
from tallgrass.components.wind import Mixing, WindPrimitive
from tallgrass.engine.terrain.record import Terrain
from tallgrass.engine.world import World
from tallgrass.systems.around.outlook import Outlook
from tallgrass.systems.around.receivers import Receiving
from tallgrass.systems.blow import Blow, Blown, Hear, receivers_shown
from tallgrass.systems.frame.feature import Start
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.show.blades.pool import BladesKept
from tallgrass.systems.show.strips.pool import StripsKept
from tallgrass.systems.site import Site
from tallgrass.systems.wind.blast import Blast, Shape
from tallgrass.systems.wind.blow import ReceiverArrays
from tallgrass.systems.wind.breeze import Breeze
from tallgrass.systems.wind.gust import Gust
from tallgrass.systems.wind.quarantine import Quarantine
from tallgrass.systems.wind.whirlwind import Whirlwind
from tallgrass.systems.winds import Winds

Laid = Callable[..., Site]
Look = Callable[..., Outlook]

FLAT = Terrain(np.zeros((81, 81), np.float32), 1.0)
SIDE = 2.5
BORDER = 7.5
"""Blades stand up to this x [m] for a viewer at (1, 1), strips beyond."""

WINDS: list[WindPrimitive] = [
    Breeze(strength=0.4),
    Gust(position=[-10.0, 1.0], direction=90.0, speed=8.0, width=9.0),
    Whirlwind(position=[7.8, 1.0], radius=3.0),
    Blast(position=[7.3, 1.6], outline=Shape(ellipse=[2.0, 3.0]), yaw=40.0),
]
CASES = [*([wind] for wind in WINDS), WINDS]
cases = pytest.mark.parametrize("winds", CASES, ids=[*(wind.kind for wind in WINDS), "all"])
mixings = pytest.mark.parametrize("mixing", ["priority", "weight"])
Seen = tuple[Site, Outlook]


@pytest.fixture
def flat(laid: Laid, look: Look) -> Seen:
    """Return a site with a border of representations at x = 7.5 m, and its outlook."""
    site = laid(terrain=FLAT)
    return site, look(site, 1.0, 1.0)


def pooled(outlook: Outlook) -> list[Receiving]:
    """Return the receiving slots of blades and of each ring of strips."""
    return [*outlook.kept["blades"].receiving, *outlook.kept["strips"].receiving]


def blow(flat: Seen, hear: Hear) -> None:
    """Let all receivers in view hear winds."""
    site, outlook = flat
    Blow([outlook], lambda _: (), hear, site.growths).run()


def at_time(winds: Winds, time: float) -> Hear:
    """Let receivers hear winds at one time."""

    def hear(heard: ReceiverArrays, /, **_: float) -> Floats:
        return winds.messages_to(heard, time=time)

    return hear


def blown(world: World, flat: Seen, winds: list[WindPrimitive], mixing: Mixing, time: float = 2.6) -> Winds:
    site, _ = flat
    site = replace(site, scene=site.scene.model_copy(update={"mixing": mixing}))
    made = Winds(Start(world, site, Quarantine(), live=False))
    for wind in winds:
        made.add(wind, wind.kind)
    blow(flat, at_time(made, time))
    assert not made.quarantine.reasons
    return made


def slots_at_the_border(flat: Seen) -> tuple[int, int]:
    """Return the slots of two patches that meet at the border: one of blades, one of strips."""
    patches = flat[1].patches

    def slot(receiving: Receiving, cell: tuple[int, int]) -> int:
        (found,) = np.flatnonzero((patches.cell[receiving.rows] == cell).all(axis=1))
        return int(receiving.slots[found])

    for cell, name in (((2, 0), "blades"), ((3, 0), "strips")):
        (number,) = patches.representation[(patches.cell == cell).all(axis=1)]
        assert patches.names[number] == name
    near, far, *_ = pooled(flat[1])
    return slot(near, (2, 0)), slot(far, (3, 0))


def put_together(flat: Seen) -> list[tuple[int, NDArray[np.intp]]]:
    """Put blades where strip edges are, on both sides of the border; return the blades' rows by kind."""
    site, outlook = flat
    blades, strips = outlook.keeps(BladesKept).pool, outlook.keeps(StripsKept).pools[0]
    at_blade, at_edge = slots_at_the_border(flat)
    kind = blades.kind(np.array([at_blade]))
    strips.stamp[at_edge, 2] = 0  # as if they ran across the border
    told = []
    for number in range(len(site.growths)):
        edges = strips.places(np.array([at_edge]))[0, number].reshape(-1, 2)
        assert edges[:, 0].min() < BORDER < edges[:, 0].max()
        rows = np.flatnonzero(kind == number)[: len(edges)]
        assert len(rows) == len(edges) >= 9
        blades.x[at_blade, rows], blades.z[at_blade, rows] = edges.T
        told.append((number, rows))
    return told


@mixings
@cases
def test_w5_a_wind_across_a_border_of_representations_bends_both_sides_alike(
    world: World, flat: Seen, winds: list[WindPrimitive], mixing: Mixing
) -> None:
    pairs = put_together(flat)
    slots = slots_at_the_border(flat)
    blown(world, flat, winds, mixing)
    blades, strips = (
        receiving.messages.heard(np.array([slot])) for receiving, slot in zip(pooled(flat[1])[:2], slots, strict=True)
    )
    for number, rows in pairs:
        blade, edge = blades[rows], strips.reshape(len(pairs), -1, 2)[number]
        index, other = np.linalg.norm(blade, axis=1), np.linalg.norm(edge, axis=1)
        assert index.max() > 0.1
        np.testing.assert_allclose(index, other, atol=1e-5)
        swayed = index > 0.0
        np.testing.assert_allclose(
            blade[swayed] / index[swayed, None], edge[swayed] / other[swayed, None], atol=1e-5, rtol=0.0
        )


@mixings
@cases
def test_n4_what_is_asked_of_the_wind_is_what_receivers_of_that_kind_hold(
    world: World, flat: Seen, winds: list[WindPrimitive], mixing: Mixing
) -> None:
    site, outlook = flat
    asked = [(receiving, receiving.messages.ask(int(receiving.slots[0]))) for receiving in pooled(outlook)]
    made = blown(world, flat, winds, mixing)
    for receiving, first in asked:
        pool, slots = receiving.pool, receiving.slots
        kind, place, message = pool.kind(slots), pool.places(slots).reshape(-1, 2), receiving.messages.heard(slots)
        for number in range(len(site.growths)):
            felt = made.messages_at(place[kind == number], time=2.6, kind=number)
            np.testing.assert_array_equal(felt.view(np.uint32), message[kind == number].view(np.uint32))
        np.testing.assert_array_equal(first, message[: len(first)])


def test_w5_every_receiver_is_as_near_its_patchs_middle_as_is_counted_on(flat: Seen) -> None:
    site, outlook = flat
    heard = receivers_shown(outlook, site.growths, patch=SIDE, margin=site.margin)
    away = np.linalg.norm(heard.place - heard.middle[heard.patch], axis=1)
    assert away.max() <= heard.radius
    assert away.max() > 0.5 * heard.radius
    assert heard.place.dtype == heard.middle.dtype == np.float32
    assert heard.still == 19**2, "the carpet hears too"


def test_n4_a_carpet_hears_what_is_asked_for_in_its_patchs_middle_less_the_small_oscillations(
    world: World, laid: Laid, look: Look
) -> None:
    dense = np.array([[[1.0, 0.1]] * 2, [[0.1, 1.0]] * 2], np.float32)
    site = laid(terrain=FLAT, dense=dense)
    outlook = look(site, 1.0, 1.0)
    rows = np.flatnonzero(outlook.patches.alive & outlook.patches.visible)
    made = Winds(Start(world, site, Quarantine(), live=False))
    gust = Gust(position=[-30.0, 0.0], direction=90.0, speed=8.0, width=80.0, tail=6.0)
    moving = made.add(gust, "gust")
    blow((site, outlook), at_time(made, 5.0))
    world.delete(moving)
    made.add(gust.model_copy(update={"swing": 0.0}), "gust")
    middle = ((outlook.patches.cell[rows] + 0.5) * SIDE).astype(np.float32)
    heard = outlook.kept["carpet"].receiving[0].messages.heard(rows)
    np.testing.assert_array_equal(heard, made.messages_at(middle, time=5.0))
    west = middle[:, 0] < 0.0
    for kind, side in ((0, west), (1, ~west)):
        assert np.linalg.norm(heard[side], axis=1).max() > 0.3
        np.testing.assert_array_equal(heard[side], made.messages_at(middle[side], time=5.0, kind=kind))
    assert outlook.noted(Blown, Blown()).heard == sum(len(each.pool.kind(each.slots)) for each in pooled(outlook))


SCENE = """\
tallgrass: 2
terrain: { size: [60, 60] }
grass: { soft: { stiffness: 0.4, height: [0.8, 0.9] }, stiff: { stiffness: 4 } }
wind:
  - { kind: gust, position: [-20, 0], width: 60, speed: 8, swing: 0 }
quality:
  blades: 20
  models: 1
  blade_rings: [{ to: 1, segments: 2 }]
  strip_rings: [{ to: 3, strips: 2, columns: 1, sections: 1, texel: 0.1 }]
  carpet_to: 5
  carpet: 8
"""


@pytest.fixture
def prairie(world: World, tmp_path: Path) -> Iterator[Prairie]:
    """Prairie of two kinds, in a world of its own."""
    path = tmp_path / "two.yaml"
    path.write_text(SCENE, "utf-8")
    made = Prairie.load(path)
    assert made.world is not world
    yield made
    made.release()


def test_w12_n4_the_wind_is_asked_for_a_kind_of_grass(prairie: Prairie) -> None:
    place = np.stack([np.linspace(-18.0, -2.0, 40), np.zeros(40)], axis=1)
    soft, stiff = (prairie.wind_at(place, 2.5, kind=kind) for kind in ("soft", "stiff"))
    assert np.abs(soft - stiff).max() > 0.2
    np.testing.assert_array_equal(prairie.wind_at(place, 2.5), soft)
    with pytest.raises(ValueError, match=r"^unknown grass 'sotf'; there are soft, stiff$"):
        prairie.wind_at(place, 2.5, kind="sotf")
