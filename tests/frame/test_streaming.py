"""Pictures of ground that streams from a function of places (N5, N11, T1)."""

from collections.abc import Iterator
from threading import Event
from time import sleep
from typing import Any

import moderngl
import numpy as np
import pytest

from tallgrass import Footprint, Pose, Road
from tallgrass.engine.camera import Camera
from tallgrass.engine.terrain import stream
from tallgrass.systems import streaming
from tallgrass.systems.features import feature_of
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.reference import patch_distances
from tallgrass.systems.trees.feature import Trees
from tallgrass.testing import looking, private_world

Stage = Any

AWAY = 3000.0, -2500.0
SOON_GROWN = {
    "blades": 160,
    "models": 1,
    "blade_rings": [{"to": 1, "segments": 3}, {"to": 8, "segments": 3}],
    "strip_rings": [{"to": 12, "strips": 2, "columns": 1, "sections": 1, "texel": 0.03}],
    "carpet_to": 24,
    "carpet": 32,
}
ROAD = Road([(AWAY[0] + 5.0, AWAY[1] - 30.0), (AWAY[0] + 5.0, AWAY[1] + 10.0)], width=3.0)


def dunes(x: Any, z: Any) -> Any:
    return 9.0 * np.sin(x / 230.0) * np.cos(z / 310.0) + 1.5 * np.sin(x / 37.0) * np.sin(z / 41.0)


@pytest.fixture
def prairies(ctx: moderngl.Context) -> Iterator[Any]:
    """Return the function that loads the scene around a place."""
    loaded = list[Prairie]()

    def load(
        about: tuple[float, float] = (0.0, 0.0),
        window: float = 512.0,
        trees: Any = None,
        grass: Any = None,
        **options: Any,
    ) -> Prairie:
        scene = {
            "tallgrass": 2,
            "terrain": {"heights": dunes, "window": window, "cell": 2.0},
            "grass": grass or {"tall": {"height": [0.4, 0.8]}, "short": {"height": [0.2, 0.3], "slope": 20}},
            "quality": SOON_GROWN,
            "camera": {"position": [*about]},
            "trees": trees or {},
        }
        loaded.append(Prairie.load(scene, ctx=ctx, **options))
        return loaded[-1]

    yield load
    for each in loaded:
        each.release()


def at(prairie: Prairie, place: tuple[float, float], *, pitch: float = -10.0, yaw: float = 0.0) -> Camera:
    height = float(prairie.height_at([place])[0])
    return looking(place[0], height + 2.5, place[1], yaw=yaw, pitch=pitch)


def test_n5_a_place_looks_alike_for_who_comes_there_and_who_begins_there(stage: Stage, prairies: Any) -> None:
    gone, there = prairies(live=False), prairies(AWAY, live=False)
    stage.shot(gone, at(gone, (0.0, 0.0)))
    np.testing.assert_array_equal(stage.shot(gone, at(gone, AWAY)), stage.shot(there, at(there, AWAY)))
    view, projection = stage.matrices(at(gone, AWAY))
    apart, same = (patch_distances(each, view, projection, stage.size) for each in (gone, there))
    assert (apart >= 0).mean() > 0.3  # measures find patches where the walker is, too
    np.testing.assert_array_equal(apart, same)


def test_f4_a_pit_dug_where_one_has_walked_to_looks_as_it_does_for_who_begins_there(
    stage: Stage, prairies: Any
) -> None:
    gone, there = prairies(live=False), prairies(AWAY, live=False)
    stage.shot(gone, at(gone, (0.0, 0.0)))
    camera, seen = at(there, AWAY), list[Any]()
    for each in (gone, there):
        stage.shot(each, camera)
        each.set_heights((AWAY[0] - 6.0, AWAY[1] - 30.0), np.full((5, 5), each.height_at([AWAY])[0] - 12.0))
        each.viewers.forget("main")
        seen.append(stage.shot(each, camera))
    np.testing.assert_array_equal(*seen)


@pytest.mark.slow
def test_d6_what_a_game_has_done_is_there_when_one_comes_back_and_in_states(stage: Stage, prairies: Any) -> None:
    played, untouched = prairies(AWAY, live=False), prairies(AWAY, live=False)
    camera = at(played, AWAY)
    before = stage.shot(untouched, camera)
    played.clear(ROAD)
    played.cut(Footprint(radius=4.0), 0.1, pose=Pose(AWAY[0] - 6.0, AWAY[1] - 12.0))
    played.set_heights((AWAY[0], AWAY[1] - 40.0), np.full((4, 4), played.height_at([AWAY])[0] + 3.0))
    changed = stage.shot(played, camera)
    assert np.abs(changed - before).mean() > 2.0
    for place in ((0.0, 0.0), (AWAY[0], 4000.0)):
        stage.shot(played, at(played, place))
    played.viewers.forget("main")  # who stays remembers how finely patches were shown
    np.testing.assert_array_equal(stage.shot(played, camera), changed)
    stage.shot(played, at(played, (0.0, 0.0)))
    other = prairies((500.0, 700.0), live=False)
    other.restore(played.state())
    np.testing.assert_array_equal(stage.shot(other, camera), changed)
    assert other.grass_at([(AWAY[0] + 5.0, AWAY[1])]).cleared[0]


@pytest.mark.slow
def test_n11_no_frame_waits_while_ground_ahead_is_made_and_shadows_follow_it(
    stage: Stage, prairies: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    walker, goal, may_come = prairies(window=1024.0), (112.0, 0.0), Event()
    stage.shot(walker, at(walker, (0.0, 0.0), pitch=-25))
    make = stream.window_of

    def slowly(*asked: Any) -> Any:
        assert may_come.wait(60.0)
        return make(*asked)

    monkeypatch.setattr(streaming, "window_of", slowly)
    first = walker.site.ground.terrain.first
    stage.shot(walker, at(walker, goal, pitch=-25))
    before = stage.shot(walker, at(walker, goal, pitch=-25))
    assert walker.site.ground.terrain.first == first
    may_come.set()
    seen = list[Any]()
    while len(seen) < 90 or (walker.painter.record["lie_origin"] != (-384.0, -512.0)).any():
        assert len(seen) < 3000, "it never comes"
        sleep(0.002)
        seen.append(stage.shot(walker, at(walker, goal, pitch=-25)))
    np.testing.assert_allclose(walker.painter.record["terrain_origin"], walker.painter.record["lie_origin"])
    assert max(float(np.abs(each - before).mean()) for each in seen) < 0.5
    assert walker.site.ground.terrain.changes.leaps == 0


def test_t1_who_jumps_far_sees_the_ground_there_at_once(stage: Stage, prairies: Any) -> None:
    jumped, there = prairies(), prairies(AWAY)
    stage.shot(jumped, at(jumped, (0.0, 0.0)))
    np.testing.assert_allclose(stage.shot(jumped, at(jumped, AWAY)), stage.shot(there, at(there, AWAY)), atol=2.0)
    assert jumped.site.ground.terrain.changes.leaps == 1


@pytest.mark.slow
def test_n5_a_forest_is_the_same_for_who_comes_there_and_who_begins_there(stage: Stage, prairies: Any) -> None:
    seen = []
    for way in ([(0.0, 0.0), AWAY], [AWAY]):
        with private_world():
            walker = prairies(way[0], live=False, trees={"oak": {"habit": "oak", "density": 3.0}})
            for place in way:
                stage.shot(walker, at(walker, place, pitch=-80))  # of grass alone: its trees are asked for, not drawn
            seen.append(np.sort(feature_of(Trees, walker.features).standing.rows, order="root"))
    root = seen[0]["root"]
    assert len(root) > 200
    assert np.abs(root[:, 1] - dunes(root[:, 0], root[:, 2])).max() < 0.01
    assert np.array_equal(root, seen[1]["root"])


def test_a_kind_that_grows_nowhere_grows_where_it_is_sown_however_far_off(stage: Stage, prairies: Any) -> None:
    played = prairies(AWAY, grass={"bare": {"place": "none", "height": [0.2, 0.3]}, "crop": {"place": "none"}})
    aim = at(played, AWAY, pitch=-60.0)
    bare = stage.shot(played, aim)
    assert played.grass_at([AWAY]).density.tolist() == [[0.0, 0.0]]
    played.sow("crop", Footprint(radius=15.0), 1.0, pose=Pose(*AWAY))
    assert played.grass_at([AWAY, (AWAY[0] + 40.0, AWAY[1])]).name == ("crop", "")
    assert np.abs(stage.shot(played, aim) - bare).mean() > 10.0


def test_d6_what_needs_an_edge_is_refused_in_a_sentence() -> None:
    ground: dict[str, Any] = {"heights": dunes, "window": 1024.0}
    scene: dict[str, Any] = {"tallgrass": 2, "terrain": ground, "grass": {"tall": {}}}
    density = np.ones((4, 4), np.float32)
    for more, why in (
        ({"terrain": {**ground, "size": [500, 500]}}, "terrain.size: ground with a window has no edge"),
        ({"terrain": {**ground, "beyond": "mirror"}}, "terrain.beyond: ground with a window has no edge that could be"),
        ({"terrain": {"noise": "hills", "window": 1024.0}}, "terrain.window: it is for heights that are a function"),
        ({"terrain": {**ground, "cell": 0.05}}, "terrain.heights: a window of 1024 m has more than 4096 cells"),
        ({"grass": {"tall": {"place": {"map": density}}}}, "grass.tall.place: a map has no place on ground without"),
    ):
        with pytest.raises(Exception, match=why.replace(".", r"\.")):
            Prairie.load(scene | more)
