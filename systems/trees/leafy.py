"""Which twigs are drawn leaf by leaf."""

import numpy as np
from numpy.typing import NDArray

from ...components.viewer import Viewer
from ..space.frustum import beyond
from .card import drawn_of
from .model import Model
from .standing import LEAFY, SHOWN
from .wood import SWAYS


def leafy(model: Model, told: np.void, viewer: Viewer, within: float) -> NDArray[np.void]:
    """Return the twigs of a tree, a record of `SHOWN`, that are so near [m], and in the picture, the nearest first.

    They are records of `LEAFY`.
    """
    (cosine, sine), scale = told["turn"].tolist(), float(told["scale"])
    x, y, z = model.twigs["foot"].astype(np.float64).T
    foot = scale * np.stack([cosine * x - sine * z, y, sine * x + cosine * z], axis=1) + told["root"]
    off = np.linalg.norm(foot - viewer.eye, axis=1)
    near = np.argsort(off)[: int((off < within).sum())]
    near = near[near < drawn_of(len(model.twigs), float(told["keep"] * (1.0 - told["gone"]) * told["foliage"]))]
    reach = scale * (2.0 * model.habit.twigs.length + SWAYS * model.height)
    return leaf_by_leaf(told, near[beyond(foot[near], viewer.sides) <= reach])


def leaf_by_leaf(trees: NDArray[np.void] | np.void, twigs: NDArray[np.intp] | int) -> NDArray[np.void]:
    """Return twigs of trees, by their numbers, as records of `LEAFY`."""
    rows = np.zeros(np.broadcast_shapes(np.shape(trees), np.shape(twigs)), LEAFY)
    for name in SHOWN.names or ():
        rows[name] = trees[name]
    rows["first"] = twigs
    return rows
