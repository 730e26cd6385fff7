"""What trees make in GL and draw for later: all before a frame needs it, and once on a machine (F3, N11)."""

from pathlib import Path
from typing import Any

import esper
import moderngl
import numpy as np
import pytest

from tallgrass import Patch, Pose, Presser, Tree
from tallgrass.components.arrays import Floats
from tallgrass.systems.features import feature_of
from tallgrass.systems.trees import bake, kind, stream
from tallgrass.systems.trees.draw import TreePart
from tallgrass.systems.trees.feature import Trees
from tallgrass.testing import Stage, little_prairie, looking, private_world
from tallgrass.testing.little import SPARSE

SCENE = (
    SPARSE
    + """\
terrain: { noise: flat, size: [80, 80] }
grass: { turf: { height: [0.2, 0.3], width: 0.02, blades: 60 } }
trees: { ash: { habit: birch, height: [9, 9] } }
"""
)
AHEAD = looking(0.0, 1.7, 12.0, pitch=14.0, view=57.0)


@pytest.fixture(scope="module")
def stage(ctx: moderngl.Context) -> Stage:
    return Stage(ctx, (160, 120))


def test_streams_that_are_rehearsed_have_wood_only_where_it_is_drawn(ctx: moderngl.Context, stage: Stage) -> None:
    with private_world(), little_prairie(scene=SCENE, ctx=ctx) as own:
        esper.create_entity(Tree("ash", height=9.0), Pose(0.0, 0.0))
        stage.shot(own, AHEAD)
        assert own.painter is not None
        for _, model in vars(own.painter.part(TreePart))["_models"]:
            model.rehearse()
            assert set(model.wood) == set(model.wood_class) == set(stream.WOODS)


@pytest.mark.slow
def test_nothing_is_made_on_a_frame_once_a_game_has_prepared(ctx: moderngl.Context, stage: Stage) -> None:
    with private_world(), little_prairie(scene=SCENE, ctx=ctx) as prepared:
        stage.begin()
        prepared.prepare()
        assert prepared.painter is not None
        programs = vars(prepared.painter.part(TreePart))["_programs"]
        made = dict(vars(programs)["_programs"])
        esper.create_entity(Tree("ash", height=9.0), Pose(0.0, 0.0))
        esper.create_entity(Tree("ash", height=9.0), Pose(2.0, 10.0))
        stage.shot(prepared, AHEAD)
        assert vars(prepared.painter.part(TreePart))["_programs"] is programs
        assert vars(programs)["_programs"] == made


def test_a_later_run_draws_no_pictures_and_looks_the_same_to_the_bit(
    ctx: moderngl.Context, stage: Stage, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TALLGRASS_CACHE", str(tmp_path))
    made, seen = [0], []
    pictures = bake.pictures

    def counted(*told: Any) -> Floats:
        made[0] += 1
        return pictures(*told)

    monkeypatch.setattr(kind, "pictures", counted)
    for _ in range(2):
        with private_world(), little_prairie(scene=SCENE, ctx=ctx) as run:
            esper.create_entity(Tree("ash", height=9.0), Pose(-3.0, 0.0))
            esper.create_entity(Tree("ash", height=9.0), Pose(0.0, -90.0))
            seen.append(stage.shot(run, AHEAD))
    assert made == [5]  # of a twig with ever more leaves, and of two models
    assert np.array_equal(seen[0], seen[1])


def test_trees_stay_as_they_are_while_other_things_move_and_patches_come_and_go(
    ctx: moderngl.Context, stage: Stage
) -> None:
    with private_world(), little_prairie(scene=SCENE, ctx=ctx) as own:
        tree = esper.create_entity(Tree("ash", height=9.0), Pose(0.0, 0.0))
        feet = esper.create_entity(Presser(radius=0.4), Pose(2.0, 8.0))
        trees = feature_of(Trees, own.features)
        stood, entities = list[Any](), set[int]()
        for step in range(4):
            esper.add_component(feet, Pose(2.0, 8.0 + step))
            stage.shot(own, looking(0.0, 1.7, 12.0 + 4.0 * step, pitch=14.0, view=57.0, yaw=90.0 * step))
            stood.append(trees.standing.rows)
            entities |= {entity for entity, _ in esper.get_component(Patch)}
        assert len(entities) > len(esper.get_component(Patch)), "no patch has come or gone"
        assert all(rows is stood[0] for rows in stood)
        esper.add_component(tree, Pose(3.0, 0.0))
        stage.shot(own, AHEAD)
        assert trees.standing.rows["root"][0, 0] == 3.0
        esper.delete_entity(tree, immediate=True)
        stage.shot(own, AHEAD)
        assert not len(trees.standing.rows)
