"""Twigs that are drawn: leaf by leaf, or in blocks on their cards."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...components.arrays import Doubles, Indices, Mask
from ..space.frustum import outside_planes
from .bounds import Balls, inside_picture
from .habit import NEEDLES
from .look import Look, Slack
from .model import Model
from .twig import BLOCK, RANKS

GROUPED_FROM = 2 / 3
"""Share of a tree's twigs from which on its blocks are of neighbours: from near to far they hide one another, and those
outside the picture are left out. Below it, they are of the first twigs that are drawn."""


NONE = -1e9
"""Radius of a block that there is not: no picture has it [m]."""


class Blocks(NamedTuple):
    """Blocks of neighbouring twigs of all models."""

    middle: Doubles
    """Of their bounding spheres, (models, 3, most blocks) [m]."""

    radius: Doubles
    """(models, most blocks) [m]; `NONE` where a model has no more."""

    twigs: Indices
    """Number of each model's twigs, (models,)."""

    first_near: Indices
    """1 where near blocks of a model are drawn first, so that they hide farther ones; -1 where far ones are, as most
    of what is seen of needles is blended, (models,)."""


class InSight(NamedTuple):
    """Blocks of neighbouring twigs of trees, as they are seen."""

    shown: Mask
    """Whether they may be in the picture, (n, most blocks)."""

    away: Doubles
    """Square of their middles' distance from the eye [m²], (n, most blocks)."""

    radius: Doubles
    """Of their bounding spheres, (n, most blocks) [m]."""


def blocks_of_models(models: Sequence[Model], /) -> Blocks:
    """Return the blocks of models."""
    most = max((len(model.blocks.radius) for model in models), default=0)
    middle, radius = np.zeros((len(models), 3, most)), np.full((len(models), most), NONE)
    for number, model in enumerate(models):
        count = len(model.blocks.radius)
        middle[number, :, :count], radius[number, :count] = model.blocks.middle.T, model.blocks.radius
    twigs = np.array([len(model.twigs) for model in models], np.intp)
    first_near = np.array([-1 if model.habit.leaf.form == NEEDLES else 1 for model in models], np.intp)
    return Blocks(middle, radius, twigs, first_near)


def blocks_in_sight(
    blocks: Blocks, model: Indices, matrix: Doubles, look: Look, slack: Slack, /
) -> InSight:  # fmt: skip
    """Return all blocks of trees of models (n,), which `matrices_of` places (n, 4, 4) in the world."""
    middle, scale = blocks.middle[model], matrix[:, 1, 1, None]
    radius, from_eye = scale * blocks.radius[model], matrix[:, :3, 3] - look.eye
    along = (from_eye[:, None] @ matrix[:, :3, :3] @ middle)[:, 0]
    away = scale**2 * (middle**2).sum(axis=1) + 2.0 * along + (from_eye**2).sum(axis=1)[:, None]
    away = np.maximum(away, 0.0)
    inside = inside_picture(middle, look.sides @ matrix)
    return InSight(inside >= -radius - slack.beside(np.sqrt(away) + radius), away, radius)


def blocks_shown(blocks: Blocks, model: Indices, share: Doubles, sight: InSight, /) -> tuple[Indices, Doubles]:
    """Return the blocks of twigs that are drawn on cards: each one's tree, and `first` of its instance, by tree.

    `model` is that of each tree (n,), and `share` that of its twigs which is seen.
    """
    sampled = np.flatnonzero((share > 0.0) & (share < GROUPED_FROM))
    grouped = share >= GROUPED_FROM
    count = -(-twigs_drawn(blocks.twigs[model[sampled]], share[sampled]) // BLOCK)
    number = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
    whose, block = np.nonzero(sight.shown & grouped[:, None])
    order = np.lexsort((sight.away[whose, block] * blocks.first_near[model[whose]], whose))
    tree = np.concatenate([np.repeat(sampled, count), whose[order]])
    first = np.concatenate([BLOCK * number, -1 - BLOCK * block[order]]).astype(np.float64)
    order = np.argsort(tree, kind="stable")
    return tree[order], first[order]


def balls_shown(blocks: Blocks, model: Indices, matrix: Doubles, first: Doubles, /) -> Balls:
    """Return the bounding spheres in the world of what `blocks_shown` returns, blocks of trees of models (n,).

    Those that are not of neighbours have an infinite radius.
    """
    block = np.maximum(-1.0 - first, 0.0).astype(np.intp) // BLOCK
    middle, scale = blocks.middle[model, :, block], matrix[:, 1, 1]
    place = (matrix[:, :3, :3] @ middle[:, :, None])[:, :, 0] + matrix[:, :3, 3]
    return Balls(place, np.where(first < 0.0, scale * blocks.radius[model, block], np.inf))


def blocks_within(sight: InSight, within: Doubles, /) -> Mask:
    """Return which blocks may have a twig in the picture within a distance of the eye (n,) [m]: (n, most blocks)."""
    return np.asarray(sight.shown & (sight.away < (within[:, None] + sight.radius) ** 2))


def twigs_drawn(twigs: Indices, share: Doubles, /) -> Indices:
    """Return the number of each tree's twigs that are drawn where a share of them is seen, (n,)."""
    dwindling = 0.5 / RANKS  # as in `twig_size` of twig.glsl
    return np.minimum((twigs * (share + dwindling)).astype(np.intp) + 1, twigs)


def near_twigs(
    model: Model, blocks: Indices, share: float, matrix: Doubles, look: Look, slack: Slack, within: float
) -> Indices:  # fmt: skip
    """Return the numbers of the twigs in a tree's blocks within a distance of the eye [m] and in the picture.

    The nearest is the first. `share` is that of its twigs which is seen, and `matrix` places its model in the world.
    """
    places = (BLOCK * blocks[:, None] + np.arange(BLOCK)).reshape(-1)
    twig = model.twigs["grouped"][places[places < len(model.twigs)]].astype(np.intp)
    twig = twig[twig < twigs_drawn(np.array(len(model.twigs)), np.array(share))]
    place, radius = model.balls.middle[twig] @ matrix[:3, :3].T + matrix[:3, 3], matrix[1, 1] * model.balls.radius[twig]
    distance = np.linalg.norm(place - look.eye, axis=1)
    is_seen = outside_planes(place, look.sides) <= radius + slack.beside(distance + radius)
    near = np.flatnonzero(is_seen & (distance < within))
    return np.asarray(twig[near[np.argsort(distance[near])]])
