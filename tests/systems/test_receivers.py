"""Receivers as components: one for each patch and representation, for a game to read and write."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import cast

import esper
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.components.arrays import Floats
from tallgrass.components.patch import Patch
from tallgrass.components.receivers import Receivers
from tallgrass.engine.terrain.record import Terrain
from tallgrass.engine.world import World
from tallgrass.systems.around.outlook import Outlook
from tallgrass.systems.around.receivers import Receiving
from tallgrass.systems.blow import Hear
from tallgrass.systems.gather import Gather
from tallgrass.systems.painter import Painter
from tallgrass.systems.show.blades.shown import BladesShown
from tallgrass.systems.show.strips.shown import StripsShown
from tallgrass.systems.site import Site
from tallgrass.systems.wind.blow import ReceiverArrays, lone_receivers
from tallgrass.systems.wind.breeze import Breeze
from tallgrass.systems.wind.grass import grass_of

Looking = Callable[..., Outlook]
Picture = dict[str, list[Floats]]
System = Callable[[], object]

FLAT = Terrain(np.zeros((81, 81), np.float32), 1.0)
WIDE = (2 * 9 + 1) ** 2
"""Number of patches around a viewer."""


@pytest.fixture
def site(laid: Callable[..., Site]) -> Site:
    return laid(terrain=FLAT)


@pytest.fixture
def looking(site: Site, look: Looking) -> Looking:
    """Look at flat ground."""
    return lambda x, z, **how: look(site, x, z, **how)


@dataclass
class Game:
    """Runs frames at one place, with the message `wind` everywhere, and keeps the messages that are drawn."""

    look: Looking
    wind: list[float] = field(default_factory=lambda: [0.25, 0.0])
    picture: Picture = field(default_factory=dict)

    def frame(self, *, after_wind: System | None = None, yaw: float | None = None) -> Outlook:
        """Run a frame, perhaps with a game's own system after the wind; return the viewer's outlook."""
        outlook = self.look(1.0, 1.0, yaw=yaw, hear=lambda heard, **_: np.full_like(heard.place, self.wind))
        if after_wind is not None:
            after_wind()
        Gather([outlook], lambda: cast(Painter, self)).run()
        outlook.settle()
        return outlook

    def write(self, outlook: Outlook, *_: object) -> int:
        """Keep the messages of all pools by slot, as a painter reads them."""
        self.picture = {
            name: [pictured(receiving) for receiving in kept.receiving] for name, kept in outlook.kept.items()
        }
        return 0


def pictured(receiving: Receiving) -> Floats:
    """Return the messages drawn for a pool, (slots, receivers, 2): a game's replace the wind's."""
    shows = np.zeros((receiving.pool.slots, int(np.prod(receiving.pool.shape)), 2), np.float32)
    shows[receiving.slots] = receiving.messages.heard(receiving.slots).reshape(len(receiving.slots), -1, 2)
    for slot, message in receiving.messages.written():
        shows[slot] = message
    return shows


@pytest.fixture
def game(looking: Looking) -> Game:
    return Game(looking)


def of(world: World, name: str) -> list[tuple[int, Receivers]]:
    """Return the receivers of one representation, each with its entity."""
    return [(entity, receivers) for entity, receivers in world.all(Receivers) if receivers.representation == name]


def shown_of(game: Game, outlook: Outlook, name: str) -> Floats:
    """Return the drawn messages of a representation's first pool, (patches, receivers, 2)."""
    receiving = outlook.kept[name].receiving[0]
    shows: Floats = game.picture[name][0][receiving.slots]
    return shows


def times(game: Game, name: str, message: list[float]) -> int:
    """Return the number of a representation's receivers that are drawn with exactly this message."""
    return sum(int((messages == message).all(axis=-1).sum()) for messages in game.picture[name])


def test_d2_there_is_one_entity_for_each_patch_and_representation_that_is_shown(world: World, looking: Looking) -> None:
    for x, z, yaw in ((1.0, 1.0, None), (4.0, 1.0, None), (4.0, 1.0, 0.3), (-9.0, 6.0, 2.0), (1.0, 1.0, None)):
        outlook = looking(x, z, yaw=yaw)
        near, far = outlook.shows(BladesShown).standing, outlook.shows(StripsShown).rings
        assert sorted(len(receivers.place) for _, receivers in of(world, "blades")) == len(near.rows) * [42]
        expected = len(far[0].rows) * [2 * 3 * 3] + len(far[1].rows) * [2 * 2 * 2]
        assert sorted(len(receivers.place) for _, receivers in of(world, "strips")) == sorted(expected)
        assert len({entity for entity, _ in world.all(Receivers)}) == len(world.all(Receivers))


def test_d2_the_carpets_receivers_are_carried_by_the_entities_of_patches(world: World, looking: Looking) -> None:
    looking(1.0, 1.0)
    outlook = looking(1.0, 1.0)
    found = of(world, "carpet")
    assert sorted(entity for entity, _ in found) == sorted(outlook.patches.entity.tolist())
    assert len(found) == WIDE
    for entity, receivers in found:
        i, j = esper.component_for_entity(entity, Patch).cell
        np.testing.assert_allclose(receivers.place, [[(i + 0.5) * 2.5, (j + 0.5) * 2.5]])
        assert (receivers.patch, receivers.viewer, receivers.message.shape) == (0, "main", (1, 2))


def test_d2_receivers_of_blades_and_strips_say_whose_they_are(world: World, looking: Looking) -> None:
    outlook = looking(1.0, 1.0)
    for name, kinds in (("blades", 30 * [0] + 12 * [1]), ("strips", None)):
        for entity, receivers in of(world, name):
            assert world.find(entity, Patch) is None
            cell = np.array(esper.component_for_entity(receivers.patch, Patch).cell)
            assert np.abs(receivers.place / 2.5 - cell - 0.5).max() < 1.0
            assert receivers.viewer == "main"
            assert len(receivers.kind) == len(receivers.place) == len(receivers.message)
            assert set(receivers.kind.tolist()) == {0, 1}
            assert kinds is None or receivers.kind.tolist() == kinds
    assert {receivers.patch for _, receivers in of(world, "blades")} == set(
        outlook.patches.entity[outlook.shows(BladesShown).standing.rows].tolist()
    )


def test_d2_a_patch_in_a_change_has_receivers_in_both_representations(world: World, looking: Looking) -> None:
    looking(1.0, 1.0)
    settled = len(of(world, "blades") + of(world, "strips"))
    looking(6.1, 1.0, dt=0.0)
    looking(6.1, 1.0, dt=0.1)
    assert len(of(world, "blades") + of(world, "strips")) > settled


def test_d2_what_receivers_hear_is_read_from_their_component(
    world: World, site: Site, looking: Looking, wind: Callable[..., Hear]
) -> None:
    hear = wind(Breeze(), time=1.0)
    outlook = looking(1.0, 1.0, hear=hear)
    found = of(world, "blades") + of(world, "strips")
    assert all(np.linalg.norm(receivers.message, axis=1).mean() > 0.05 for _, receivers in found)
    for _, receivers in found:
        alone = lone_receivers(receivers.place, grass_of(site.growths, receivers.kind))
        np.testing.assert_array_equal(receivers.message, hear(alone, time=0.0))
    near = outlook.kept["blades"].receiving[0]
    where = {tuple(place) for place in near.pool.places(near.slots).reshape(-1, 2).tolist()}
    for _, receivers in of(world, "blades"):
        assert {tuple(place) for place in receivers.place.tolist()} <= where


def test_d2_places_are_copies_and_nothing_but_messages_can_be_set(world: World, looking: Looking) -> None:
    looking(1.0, 1.0)
    _, receivers = of(world, "blades")[0]
    before = receivers.place
    receivers.place[:] = 99.0
    np.testing.assert_array_equal(receivers.place, before)
    for name in ("patch", "representation", "viewer", "place", "kind"):
        with pytest.raises(AttributeError):
            setattr(receivers, name, getattr(receivers, name))
    receivers.message = np.ones_like(receivers.message)
    receivers.message *= 0.5
    np.testing.assert_array_equal(receivers.message, 0.5)


def test_d2_a_game_may_bend_single_receivers_itself(world: World, game: Game) -> None:
    game.frame()
    entity, receivers = of(world, "blades")[0]
    receivers.message[3] = (0.6, -0.2)
    outlook = game.frame()
    picture = shown_of(game, outlook, "blades")
    bent = (picture != game.wind).any(axis=-1)
    assert bent.sum() == 1
    np.testing.assert_allclose(picture[bent], [[0.6, -0.2]], rtol=1e-6)
    assert esper.component_for_entity(entity, Receivers) is receivers


@pytest.mark.parametrize("name", ["blades", "strips", "carpet"])
def test_d2_what_a_game_writes_stands_above_the_wind_in_the_next_frame_and_in_that_alone(
    world: World, game: Game, name: str
) -> None:
    game.frame()
    told = [receivers for _, receivers in of(world, name)[:3]]
    for receivers in told:
        receivers.message[:] = (0.0, -0.5)
    game.wind = [0.375, 0.0]
    game.frame()
    for each in game.picture:
        many = sum(len(receivers.message) for receivers in told) if each == name else 0
        assert times(game, each, [0.0, -0.5]) == many
    for receivers in told:
        np.testing.assert_array_equal(receivers.message, np.tile([0.375, 0.0], (len(receivers.place), 1)))
    game.wind = [0.125, 0.0]
    outlook = game.frame()
    assert (shown_of(game, outlook, name) == game.wind).all()


def test_d2_what_is_written_anew_in_every_frame_stands_in_every_frame(world: World, game: Game) -> None:
    game.frame()
    told = [of(world, name)[0][1] for name in ("blades", "strips", "carpet")]
    for number in range(5):
        game.wind = [0.125 * (number % 3), 0.25]
        for receivers in told:
            receivers.message[0] = (-0.5, 0.0)
        game.frame()
        assert [times(game, name, [-0.5, 0.0]) for name in game.picture] == [1, 1, 1]
        for receivers in told:
            assert (receivers.message == game.wind).all(), "a game reads what the wind says"


def test_n10_what_a_system_after_the_wind_writes_stands_in_that_frame_alone(world: World, game: Game) -> None:
    game.frame()
    read: list[Floats] = []
    receivers = of(world, "blades")[0][1]

    def follow() -> None:
        read.append(receivers.message.copy())
        receivers.message[5] = (0.0, 0.75)

    for number in range(3):
        game.wind = [0.125 * number, 0.0]
        game.frame(after_wind=follow)
        assert (read[-1] == game.wind).all(), "it finds what the wind of this very frame says"
        assert times(game, "blades", [0.0, 0.75]) == 1
    outlook = game.frame()
    assert (shown_of(game, outlook, "blades") == game.wind).all()


def test_d2_a_system_after_the_wind_has_the_last_word_over_what_was_written_before(world: World, game: Game) -> None:
    game.frame()
    receivers = of(world, "blades")[0][1]

    def follow() -> None:
        np.testing.assert_array_equal(receivers.message[2], [0.0, -0.5])
        receivers.message[2] = (0.0, 0.75)

    receivers.message[2:4] = (0.0, -0.5)
    game.frame(after_wind=follow)
    assert [times(game, "blades", told) for told in ([0.0, 0.75], [0.0, -0.5])] == [1, 1]
    assert (shown_of(game, game.frame(), "blades") == game.wind).all()


@pytest.mark.parametrize("late", [False, True], ids=["between frames", "after the wind"])
def test_d2_what_is_no_number_in_any_representation_is_refused_with_one_warning(
    world: World, game: Game, caplog: pytest.LogCaptureFixture, *, late: bool
) -> None:
    game.frame()
    receivers = of(world, "blades")[0][1]

    def spoil() -> None:
        receivers.message[0] = (np.nan, 0.5)
        receivers.message[1] = (np.inf, -np.inf)
        for name in ("strips", "carpet"):
            of(world, name)[0][1].message[:] = np.nan

    if not late:
        spoil()
    outlook = game.frame(after_wind=spoil if late else None)
    (told,) = caplog.messages
    assert told == "messages of receivers must be finite numbers; those that are not were taken for no wind"
    picture = shown_of(game, outlook, "blades")
    assert np.isfinite(picture).all()
    assert [(picture == expected).all(axis=-1).sum() for expected in ([0.0, 0.5], [0.0, 0.0])] == [1, 1]
    game.frame()
    assert len(caplog.messages) == 1


@pytest.mark.parametrize("late", [False, True], ids=["between frames", "after the wind"])
@pytest.mark.parametrize("length", [1.5, 40.0, 1e30])
def test_d2_a_message_that_is_longer_than_1_is_shortened(
    world: World, game: Game, length: float, *, late: bool
) -> None:
    game.frame()
    receivers = of(world, "blades")[0][1]

    def shout() -> None:
        receivers.message[7] = (0.6 * length, -0.8 * length)

    if not late:
        shout()
    picture = shown_of(game, game.frame(after_wind=shout if late else None), "blades")
    bent = picture[(picture != game.wind).any(axis=-1)]
    np.testing.assert_allclose(bent, [[0.6, -0.8]], rtol=1e-6)


def test_slots_that_nobody_asks_for_cost_nothing(world: World, game: Game) -> None:
    outlook = game.frame()
    game.frame(yaw=0.0)
    game.frame()
    for _, receivers in world.all(Receivers):
        assert len(receivers.place) == len(receivers.kind)
    all_messages = [receiving.messages for kept in outlook.kept.values() for receiving in kept.receiving]
    assert not any(messages.busy for messages in all_messages)
    of(world, "blades")[0][1].message[0] = (0.5, 0.5)
    assert [messages.busy for messages in all_messages] == [True, False, False, False]


def test_d2_who_only_reads_messages_changes_no_picture(
    world: World, laid: Callable[..., Site], look: Looking, wind: Callable[..., Hear]
) -> None:
    """Bit for bit, also in a storm with messages of the greatest length."""
    hear = wind(Breeze(strength=1.0, gustiness=1.0, swing=0.5), time=2.0)
    site = laid(terrain=FLAT)
    taken: list[Picture] = []
    for _ in range(2):
        game = Game(lambda x, z, **_: look(site, x, z, hear=hear))
        game.frame()
        taken.append(game.picture)
        for _, receivers in world.all(Receivers):
            assert np.isfinite(receivers.message).all()
    game.frame()
    kept = look(site, 1.0, 1.0, hear=hear).kept.values()
    messages = [receiving.messages for each in kept for receiving in each.receiving]
    assert all(each.busy for each in messages)
    assert not any(list(each.written()) for each in messages)
    longest = np.linalg.norm(taken[0]["blades"][0], axis=-1).max()
    assert longest > 0.999
    for name in taken[0]:
        for one, other in zip(taken[0][name], taken[1][name], strict=True):
            np.testing.assert_array_equal(one.view(np.uint32), other.view(np.uint32))


def test_d2_the_wind_may_be_stepped_again_without_a_picture_and_what_was_read_follows_it(
    world: World, looking: Looking
) -> None:
    said = [0.0, 0.0]

    def hear(heard: ReceiverArrays, /, **_: float) -> Floats:
        return np.full_like(heard.place, said)

    looking(1.0, 1.0, hear=hear)
    told = [of(world, name)[0][1] for name in ("blades", "strips", "carpet")]
    for number in range(4):
        said[0] = 0.125 * number
        looking(1.0, 1.0, hear=hear)
        for receivers in told:
            assert (receivers.message == said).all()


def test_what_was_written_for_a_patch_goes_with_it(world: World, looking: Looking) -> None:
    """Neither the next patch in its slot nor the same patch when it comes back has the message."""

    def calm(heard: ReceiverArrays, /, **_: float) -> Floats:
        return np.zeros_like(heard.place)

    first = set(map(tuple, looking(1.0, 1.0, hear=calm).patches.cell.tolist()))
    for _, receivers in world.all(Receivers):
        receivers.message[:] = (0.0, -0.5)
    outlook = looking(36.0, 1.0, hear=calm)
    told = [(each.messages, each.rows, each.slots) for kept in outlook.kept.values() for each in kept.receiving]
    fresh = np.array([tuple(cell) not in first for cell in outlook.patches.cell.tolist()])
    for messages, rows, slots in told:
        assert fresh[rows].any()
        assert not messages.current(slots[fresh[rows]]).any()
    outlook.settle()
    looking(1.0, 1.0, hear=calm)
    assert not any(messages.current(slots).any() for messages, _, slots in told)


def test_an_entity_lives_as_long_as_its_patch_is_shown(world: World, looking: Looking) -> None:
    def there() -> set[int]:
        return {entity for entity, _ in of(world, "blades") + of(world, "strips")}

    looking(1.0, 1.0)
    first = there()
    looking(1.01, 1.01)
    assert there() == first
    looking(1.01, 1.01, yaw=0.0)
    ahead = there()
    assert ahead < first
    looking(1.01, 1.01)
    again = there()
    assert ahead < again
    assert len(again) == len(first)
    assert not (again - ahead) & first


def test_an_entitys_places_stay_on_one_patch(world: World, looking: Looking) -> None:
    homes: dict[int, NDArray[np.float32]] = {}
    for step in range(10):
        looking(2.0 * step - 9.0, 1.4 * step - 7.0, dt=0.3)
        for entity, receivers in world.all(Receivers):
            middle = receivers.place.mean(axis=0)
            assert np.abs(middle - homes.setdefault(entity, middle)).max() < 1.0
            assert np.ptp(receivers.place, axis=0).max() < 2.5 + 1.5
