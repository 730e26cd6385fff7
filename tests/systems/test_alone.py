"""Every system can be made from its inputs alone, and tested by one step in a private world (D3, D6)."""

import esper
import numpy as np

from tallgrass.components.patch import Clearings, Lod, Patch
from tallgrass.components.receivers import Receivers
from tallgrass.components.viewer import Viewer
from tallgrass.components.wind import WindSource
from tallgrass.engine.schedule import Phase
from tallgrass.engine.world import World
from tallgrass.systems.around.outlook import Outlook
from tallgrass.systems.blow import Blow, Blown, hearing
from tallgrass.systems.cull import Cull
from tallgrass.systems.entities import PatchEntities
from tallgrass.systems.gather import Gather
from tallgrass.systems.lod import ChooseLevels
from tallgrass.systems.plant import Plant
from tallgrass.systems.see import See
from tallgrass.systems.show.blades.pool import BladesKept
from tallgrass.systems.show.blades.shown import BladesShown
from tallgrass.systems.space.window import window_rows
from tallgrass.systems.tile import Tile
from tallgrass.systems.transition import Transition
from tallgrass.systems.wind.blow import ReceiverArrays, blowing
from tallgrass.systems.wind.breeze import Breeze
from tallgrass.systems.wind.quarantine import Quarantine
from tallgrass.testing import little_site, look, looking, systems_on, viewer_on

SITE = little_site()
PATCH = SITE.ground.patch


def test_tile_lays_patches_around_the_viewer_and_makes_them_entities(world: World) -> None:
    outlook = viewer_on(SITE, world, looking(6.0, 2.0, -4.0))
    entities = PatchEntities(world, Clearings())
    Tile([outlook], entities, SITE.representations, SITE.ground, seed=5, models=2).run()
    assert tuple(outlook.viewer.centre) == (2, -2)
    assert outlook.patches.distance.max() == 12
    near = [esper.component_for_entity(entity, Patch).cell for entity, lod in world.all(Lod) if lod.distance <= 1]
    assert sorted(near) == [(i, j) for i in (1, 2, 3) for j in (-3, -2, -1)]


def test_cull_keeps_the_patches_in_the_view_cone(world: World) -> None:
    outlook = viewer_on(SITE, world, looking(0.0, 2.0, 0.0, yaw=0.0, view=40.0))
    entities = PatchEntities(world, Clearings())
    Tile([outlook], entities, SITE.representations, SITE.ground, seed=5, models=2).run()
    Cull([outlook], PATCH, sway=0.5).run()
    ahead, behind = window_rows(np.array([[0, -4], [0, 3]], np.int32), side=outlook.patches.side)
    assert outlook.patches.visible[[ahead, behind]].tolist() == [True, False]


def test_lod_wants_the_representation_of_each_distance(world: World) -> None:
    outlook = viewer_on(SITE, world)
    outlook.patches.away[:4] = (0, 2, 3, 9)
    ChooseLevels([outlook], SITE.reach).run()
    names = outlook.patches.names
    assert [names[level] for level in outlook.patches.wanted[:4]] == ["blades", "blades", "strips", "carpet"]


def test_transition_carries_a_patch_that_is_seen_by_and_by_and_others_at_once(world: World) -> None:
    outlook = viewer_on(SITE, world)
    patches, outlook.viewer.jumped, outlook.viewer.dt = outlook.patches, False, 0.12
    patches.alive[:2], patches.representation[:2], patches.wanted[:2] = True, 0, 1
    patches.visible[0] = patches.was_visible[0] = True
    Transition([outlook], SITE.representations, PATCH).run()
    assert patches.representation[:2].tolist() == [1, 1]
    assert patches.progress[:2].tolist() == [0.0, 1.0]
    assert outlook.changing == 1


def test_see_shows_each_patch_in_its_representation(world: World) -> None:
    outlook = viewer_on(SITE, world)
    systems_on(SITE, [outlook], world).run(last=Phase.SEE)
    See([outlook], SITE.representations, PATCH).run()
    rows = outlook.shows(BladesShown).standing.rows
    assert (outlook.appearance.cover[0, rows] > 0.0).all()
    assert (outlook.patches.distance[rows] <= 2).all()


def test_plant_stands_blades_where_their_patch_is_and_makes_their_receivers_entities(world: World) -> None:
    outlook = viewer_on(SITE, world)
    systems_on(SITE, [outlook], world).run(last=Phase.SEE)
    Plant([outlook], SITE.representations, world).run()
    shown, pool = outlook.shows(BladesShown).standing, outlook.keeps(BladesKept).pool
    away = pool.places(shown.slots) - outlook.patches.middle[shown.rows][:, None]
    assert np.abs(away).max() <= PATCH / 2 + 1e-4
    blades = [receivers for _, receivers in world.all(Receivers) if receivers.representation == "blades"]
    assert len(blades) == len(shown.rows)


def test_wind_tells_which_winds_act_and_what_receivers_hear_that_a_game_asks_for(world: World) -> None:
    def eastwards(receivers: ReceiverArrays, /, *, time: float) -> np.ndarray[tuple[int, ...], np.dtype[np.float32]]:
        return np.tile(np.array([0.5 + time, 0.0], np.float32), (len(receivers.place), 1))

    outlook = viewer_on(SITE, world)
    look(outlook, SITE, time=0.25)
    systems = systems_on(SITE, [outlook], world)
    systems.run(last=Phase.SEE)
    systems.step("plant")
    asked = [receiving.messages.ask(int(receiving.slots[0])) for receiving in hearing(outlook)]
    source = WindSource(Breeze(), "breeze")
    now = blowing([source], Quarantine(), time=0.25, seed=1)
    Blow([outlook], lambda time: now if time == 0.25 else [], eastwards, SITE.growths).run()
    blown = outlook.noted(Blown, Blown())
    assert (list(blown.winds), blown.time) == (now, 0.25)
    for message, receiving in zip(asked, hearing(outlook), strict=True):
        assert (message == (0.75, 0.0)).all()
        assert (receiving.messages.heard(receiving.slots) == (0.75, 0.0)).all()
    assert blown.heard > 1000


def test_gather_sends_what_is_shown_to_the_painter(world: World) -> None:
    class Painter:
        def write(self, outlook: Outlook) -> None:
            sent.append(outlook)

    sent: list[Outlook] = []
    viewers = [viewer_on(SITE, world)]
    Gather(viewers, Painter).run()  # type: ignore[arg-type]
    assert sent == viewers


def test_a_viewer_is_an_entity_that_says_where_it_looks_from(world: World) -> None:
    viewer_on(SITE, world, looking(1.0, 2.0, 3.0), name="left")
    ((_, viewer),) = world.all(Viewer)
    assert (viewer.name, viewer.eye) == ("left", (1.0, 2.0, 3.0))
