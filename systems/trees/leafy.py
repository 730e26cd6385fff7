"""Which twigs are drawn leaf by leaf."""

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles
from ..space.frustum import beyond
from .card import drawn_of
from .model import Model
from .standing import LEAFY, SHOWN
from .wood import SWAYS


def leafy(model: Model, told: np.void, eye: Doubles, sides: Doubles, within: float) -> NDArray[np.intp]:
    """Return which twigs of a tree, a record of `SHOWN`, are so near an eye [m], and in the picture, nearest first.

    `sides` are those of the picture, as `Viewer` has them.
    """
    (cosine, sine), scale = told["turn"].tolist(), float(told["scale"])
    x, y, z = model.twigs["foot"].astype(np.float64).T
    foot = scale * np.stack([cosine * x - sine * z, y, sine * x + cosine * z], axis=1) + told["root"]
    off = np.linalg.norm(foot - eye, axis=1)
    near = np.argsort(off)[: int((off < within).sum())]
    near = near[near < drawn_of(len(model.twigs), float(told["keep"] * (1.0 - told["gone"]) * told["foliage"]))]
    reach = scale * (2.0 * model.habit.twigs.length + SWAYS * model.height)
    return np.asarray(near[beyond(foot[near], sides) <= reach])


def leaf_by_leaf(trees: NDArray[np.void], twigs: NDArray[np.intp]) -> NDArray[np.void]:
    """Return twigs, by their numbers (n,), of trees (n,), records of `SHOWN`, as records of `LEAFY`."""
    rows = np.zeros(len(trees), LEAFY)
    for name in SHOWN.names or ():
        rows[name] = trees[name]
    rows["first"] = twigs
    return rows
