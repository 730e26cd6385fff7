"""Rows of plants while they grow: stems, the organs on them, and their order in a patch model."""

from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...components.arrays import Doubles, Indices
from .record import Blades

GOLDEN = np.pi * (3.0 - np.sqrt(5.0))
"""The angle from one leaf or floret to the next round a stem [rad]."""

_MOST_SPREAD = 0.98

INTEGERS = "variant", "organ"
"""Columns of `Rows` that hold integers."""


@dataclass(frozen=True, slots=True, eq=False)
class Stems:
    """Stems of leaves and heads."""

    plant: Indices
    """Plant of each stem, shape (m,)."""

    branch: Indices
    """Number of the stem on its plant, shape (m,)."""

    height: Doubles
    """Length [m], shape (m,)."""

    rest: Doubles
    """Lean at rest, in the form of `Blades.rest`, shape (m, 2)."""

    def take(self, rows: Indices, /) -> "Stems":
        """Return the stems of some rows (k,)."""
        return Stems(self.plant[rows], self.branch[rows], self.height[rows], self.rest[rows])


@dataclass(frozen=True, slots=True, eq=False)
class Rows:
    """Rows of `Blades` with plant and branch in place of root and rank, shape (k,) or (k, 2) each."""

    plant: Indices
    branch: Indices
    height: NDArray[np.floating]
    width: NDArray[np.floating]
    facing: NDArray[np.floating]
    rest: NDArray[np.floating]
    variant: NDArray[np.int32]
    organ: NDArray[np.int32]
    stem: NDArray[np.floating]
    part: NDArray[np.floating]
    stem_rest: NDArray[np.floating]


def stand_organs(
    stems: Stems,
    organ: ArrayLike,
    /,
    *,
    part: ArrayLike,
    height: ArrayLike,
    width: ArrayLike,
    toward: ArrayLike,
    spread: ArrayLike,
    tilt: Doubles | None = None,
    variant: NDArray[np.int32] | None = None,
) -> Rows:
    """Return the organs of stems; the shape of `height`, to which the others are broadcast, is (m, organs of a stem).

    They stand at the place `part` along their stem, lean `toward` an azimuth [rad] at the posture index `spread`, and
    face that azimuth. The `tilt` of a stem, shape (m, 2), is added to the lean of all its organs.
    """
    height = np.asarray(height, np.float64)
    shape = height.shape
    toward, spread = np.broadcast_to(toward, shape), np.broadcast_to(spread, shape)
    rest = spread[..., None] * np.stack([np.cos(toward), np.sin(toward)], axis=-1)
    if tilt is not None:
        rest = rest + tilt[:, None]
        rest = rest * np.minimum(1.0, _MOST_SPREAD / np.maximum(np.linalg.norm(rest, axis=-1, keepdims=True), 1e-9))
    count = shape[1]
    return Rows(
        plant=np.repeat(stems.plant, count),
        branch=np.repeat(stems.branch, count),
        height=height.reshape(-1),
        width=np.broadcast_to(width, shape).reshape(-1),
        facing=toward.reshape(-1),
        rest=rest.reshape(-1, 2),
        variant=np.zeros(height.size, np.int32) if variant is None else variant.reshape(-1),
        organ=np.broadcast_to(np.asarray(organ, np.int32), shape).reshape(-1),
        stem=np.repeat(stems.height, count),
        part=np.broadcast_to(part, shape).reshape(-1),
        stem_rest=np.repeat(stems.rest, count, axis=0),
    )


def to_blades(stand: Blades, /, *parts: Rows) -> Blades:
    """Return rows as blades, plant after plant; each has the root and the rank of its plant's blade in `stand`.

    The rows of a plant are drawn in this order, as all are as far away as its root. So they come branch after branch:
    if all heads came last, they would cover the leaves of branches in front of them.
    """
    columns = {column.name: np.concatenate([getattr(rows, column.name) for rows in parts]) for column in fields(Rows)}
    order = np.lexsort((columns.pop("branch"), columns["plant"]))
    plant = columns.pop("plant")[order]
    ordered: dict[str, Any] = {
        name: values[order].astype(np.int32 if name in INTEGERS else np.float32) for name, values in columns.items()
    }
    facing = ordered.pop("facing").astype(np.float64)
    ordered["facing"] = ((facing + np.pi) % (2.0 * np.pi) - np.pi).astype(np.float32)
    return Blades(root=stand.root[plant], rank=stand.rank[plant], **ordered)
