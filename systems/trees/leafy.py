"""Twigs that are drawn: leaf by leaf, or in blocks on their cards."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Indices
from ..space.frustum import outside_planes
from .bounds import places_of
from .model import Model
from .twig import BLOCK, RANKS

GROUPED_FROM = 2 / 3
"""Share of a tree's twigs from which on its blocks are of neighbours: from near to far they hide one another, and those
outside the picture are left out. Below it, they are of the first twigs that are drawn."""


class Blocks(NamedTuple):
    """Blocks of neighbouring twigs of all models."""

    middle: Doubles
    """Of their bounding spheres, (models, most blocks, 3) [m]."""

    radius: Doubles
    """(models, most blocks) [m]; below 0 where a model has no more."""

    twigs: Indices
    """Number of each model's twigs, (models,)."""


def blocks_of_models(models: Sequence[Model], /) -> Blocks:
    """Return the blocks of models."""
    most = max((len(model.blocks.radius) for model in models), default=0)
    middle, radius = np.zeros((len(models), most, 3)), np.full((len(models), most), -np.inf)
    for number, model in enumerate(models):
        count = len(model.blocks.radius)
        middle[number, :count], radius[number, :count] = model.blocks
    return Blocks(middle, radius, np.array([len(model.twigs) for model in models], np.intp))


def blocks_shown(
    blocks: Blocks, model: Indices, instances: NDArray[np.void], eye: Doubles, sides: Doubles, /
) -> tuple[Indices, Doubles]:
    """Return the blocks of twigs that are drawn on cards: each one's tree, and `first` of its instance, by tree.

    `model` is that of each tree (n,), and `instances` are records of `INSTANCE`; `sides` are planes of the frustum.
    """
    share = instances["twig_share"] * (1.0 - instances["far_fade"]) * instances["foliage"]
    sampled = np.flatnonzero((share > 0.0) & (share < GROUPED_FROM))
    grouped = np.flatnonzero(share >= GROUPED_FROM)
    count = -(-twigs_drawn(blocks.twigs[model[sampled]], share[sampled]) // BLOCK)
    number = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
    whose, block = _neighbours_shown(blocks, model[grouped], instances[grouped], eye, sides)
    tree = np.concatenate([np.repeat(sampled, count), grouped[whose]])
    first = np.concatenate([BLOCK * number, -1 - BLOCK * block]).astype(np.float64)
    order = np.argsort(tree, kind="stable")
    return tree[order], first[order]


def _neighbours_shown(
    blocks: Blocks, model: Indices, instances: NDArray[np.void], eye: Doubles, sides: Doubles
) -> tuple[Indices, Indices]:
    """Return the blocks of neighbours in the picture: each one's tree and its own number, from near to far."""
    place, scale = places_of(blocks.middle[model], instances)
    outside = outside_planes(place.reshape(-1, 3), sides).reshape(place.shape[:2])
    tree, block = np.nonzero(outside <= scale[:, None] * blocks.radius[model])
    away = place[tree, block] - eye
    order = np.lexsort((np.einsum("ij,ij->i", away, away), tree))
    return tree[order], block[order]


def twigs_drawn(twigs: Indices, share: Doubles, /) -> Indices:
    """Return the number of each tree's twigs that are drawn where a share of them is seen, (n,)."""
    dwindling = 0.5 / RANKS  # as in `twig_size` of twig.glsl
    return np.minimum((twigs * (share + dwindling)).astype(np.intp) + 1, twigs)


def near_twigs(model: Model, instance: np.void, eye: Doubles, sides: Doubles, within: float) -> Indices:
    """Return the numbers of a tree's twigs within a distance of the eye [m] and in the picture, nearest first.

    `instance` is the tree's record of `INSTANCE`, and `sides` the picture's, as `Viewer` has them.
    """
    (cosine, sine), scale = instance["turn"].tolist(), float(instance["scale"])
    root = instance["root"].astype(np.float64)
    to_model = np.array([[cosine, 0.0, -sine], [0.0, 1.0, 0.0], [sine, 0.0, cosine]])
    share = float(instance["twig_share"] * (1.0 - instance["far_fade"]) * instance["foliage"])
    middle, radius = (each[: twigs_drawn(np.array(len(model.twigs)), np.array(share))] for each in model.balls)
    away = middle - (eye - root) @ to_model / scale
    squared = np.einsum("ij,ij->i", away, away)
    near = np.flatnonzero(squared < (within / scale) ** 2)
    planes = np.column_stack([sides[:, :3] @ to_model, (sides[:, :3] @ root + sides[:, 3]) / scale])
    near = near[outside_planes(middle[near], planes) <= radius[near]]
    return np.asarray(near[np.argsort(squared[near])])
