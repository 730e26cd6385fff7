"""Rows of trees: only those of changed entities are made anew (D2, F4)."""

import numpy as np

from tallgrass import Pose, Tree
from tallgrass.systems.trees.forest import Rows
from tallgrass.systems.trees.standing import STANDING
from tallgrass.systems.trees.tree_rows import Posed, TreeRows

ASH = Tree("ash", height=9.0)


def made(added: Posed) -> Rows:
    rows = np.zeros(len(added), STANDING)
    rows["root"][:, 0] = [pose.x for _, _, pose in added]
    return rows


def update(rows: TreeRows, trees: dict[int, tuple[Tree, Pose]]) -> tuple[list[int], list[float]]:
    """Update rows; return the entities that were made anew, and the x of those that are gone."""
    seen = [(entity, tree) for entity, (tree, _) in trees.items()], [pose for _, pose in trees.values()]
    other, kept = rows.changed(*seen)
    found = [(entity, tree, pose) for entity, tree, pose in other if pose is not None]
    gone = rows.rows["root"][rows.gone(kept, {entity for entity, *_ in found}), 0].tolist()
    rows.take(kept, found, made)
    return [entity for entity, *_ in found], gone


def test_rows_are_kept_until_their_tree_or_pose_is_another_object() -> None:
    rows = TreeRows()
    trees = {entity: (Tree("ash", height=float(entity)), Pose(float(entity), 0.0)) for entity in (4, 9, 2, 7)}
    assert update(rows, trees) == ([4, 9, 2, 7], [])
    assert rows.entities.tolist() == [2, 4, 7, 9]
    assert update(rows, trees) == ([], [])
    trees[4] = trees[4][0], Pose(40.0, 0.0)
    trees[9] = ASH, trees[9][1]
    del trees[2]
    trees[1] = ASH, Pose(1.0, 0.0)
    anew, gone = update(rows, trees)
    assert (sorted(anew), gone) == ([1, 4, 9], [2.0])
    assert rows.entities.tolist() == [1, 4, 7, 9]
    assert rows.rows["root"][:, 0].tolist() == [1.0, 40.0, 7.0, 9.0]
    rows.make_all_anew()
    assert sorted(update(rows, trees)[0]) == [1, 4, 7, 9]
    rows.forget()
    assert update(rows, trees) == ([*trees], [])
