"""Culling: which patches the view cone may hold (paper, section 2.2, figure 5)."""

from math import atan, pi, tan

import numpy as np
from numpy.typing import NDArray

from ..components.camera import Camera, View

Floats = NDArray[np.float32]


def view_cone(camera: Camera, /, *, aspect: float) -> tuple[float, float]:
    """Return the azimuths (middle, half width) [rad] of everything the camera sees, as if from above.

    A camera that looks steeply up or down sees all round; then the half width is pi.
    """
    tall = tan(camera.view / 2)
    wide = tall * aspect
    steepest = abs(camera.pitch) + camera.view / 2
    if steepest >= pi / 2 - 0.05:
        return camera.yaw, pi
    nearest = np.cos(camera.pitch) - tall * abs(np.sin(camera.pitch))
    return camera.yaw, min(pi, float(atan(wide / max(nearest, 1e-6))))


def inside_cone(
    place: Floats, /, *, apex: tuple[float, float], cone: tuple[float, float], radius: float
) -> NDArray[np.bool_]:
    """Return whether discs of `radius` [m] around ground positions (n, 2) touch the view cone, shape (n,)."""
    middle, half = cone
    away = place - np.asarray(apex, np.float32)
    if half >= pi:
        return np.ones(len(away), np.bool_)
    sine, cosine = np.float32(np.sin(middle)), np.float32(np.cos(middle))
    ahead, aside = np.array([sine, -cosine]), np.array([cosine, sine])
    along, across = away @ ahead, np.abs(away @ aside)
    outside = across * np.float32(np.cos(half)) - along * np.float32(np.sin(half))
    near = np.einsum("ij,ij->i", away, away) <= radius * radius
    return np.asarray(near | (outside <= radius))


def discrete_distance(cell: NDArray[np.int32], centre: NDArray[np.int32], /) -> NDArray[np.int32]:
    """Return the patches' distance (paper, section 2.2): 0 for the viewer's, 1 for its eight neighbours, ..."""
    apart: NDArray[np.int32] = np.abs(cell - centre).max(axis=-1)
    return apart


def far_to_near(cell: NDArray[np.int32], centre: NDArray[np.int32], /) -> NDArray[np.int64]:
    """Return the order that walks cells (n, 2) back to front from anywhere in `centre`, shape (n,).

    A ray leaves square rings from the inside out, and within a ring it moves away from the axis; so rings from the
    outside in, and each from its corners to its axes, never draw a patch over one before it (paper, section 2.2).
    """
    apart = np.abs(cell - centre)
    order: NDArray[np.int64] = np.lexsort((-apart.min(axis=-1), -apart.max(axis=-1)))
    return order


def camera_of(view: View, /) -> tuple[Camera, float]:
    """Return the camera that two matrices were made of, and the image's width over its height."""
    turn, shift = view.view[:3, :3].astype(np.float64), view.view[:3, 3].astype(np.float64)
    x, y, z = (-(turn.T @ shift)).tolist()
    ahead = -turn[2]
    yaw, pitch = float(np.arctan2(ahead[0], -ahead[2])), float(np.arcsin(np.clip(ahead[1], -1.0, 1.0)))
    tall = float(view.projection[1, 1])
    return Camera((x, y, z), yaw, pitch, 2.0 * atan(1.0 / tall)), tall / float(view.projection[0, 0])
