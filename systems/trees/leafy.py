"""Twigs that are drawn leaf by leaf."""

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles
from ..space.frustum import outside_planes
from .model import Model
from .standing import INSTANCE, TWIG_INSTANCE
from .stream import twigs_drawn


def near_twigs(model: Model, instance: np.void, eye: Doubles, sides: Doubles, within: float) -> NDArray[np.intp]:
    """Return the numbers of a tree's twigs within a distance of the eye [m] and in the picture, nearest first.

    `instance` is the tree's record of `INSTANCE`, and `sides` the picture's, as `Viewer` has them.
    """
    (cosine, sine), scale = instance["turn"].tolist(), float(instance["scale"])
    x, y, z = model.balls.middle.T
    middle = scale * np.stack([cosine * x - sine * z, y, sine * x + cosine * z], axis=1) + instance["root"]
    distance = np.linalg.norm(middle - eye, axis=1)
    near = np.argsort(distance)[: int((distance < within).sum())]
    near = near[
        near
        < twigs_drawn(
            len(model.twigs), float(instance["twig_share"] * (1.0 - instance["far_fade"]) * instance["foliage"])
        )
    ]
    return np.asarray(near[outside_planes(middle[near], sides) <= scale * model.balls.radius[near]])


def twig_instances(trees: NDArray[np.void], twigs: NDArray[np.intp]) -> NDArray[np.void]:
    """Return records of `TWIG_INSTANCE`: `trees` (n,) are each twig's tree, and `twigs` (n,) their numbers."""
    rows = np.zeros(len(trees), TWIG_INSTANCE)
    for name in INSTANCE.names or ():
        rows[name] = trees[name]
    rows["first"] = twigs
    return rows
