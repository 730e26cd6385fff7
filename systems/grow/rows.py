"""The rows of plants while they are grown: stems, what stands on them, and how they come together."""

from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...components.arrays import Doubles
from .record import Blades

Numbers = NDArray[np.intp]

GOLDEN = np.pi * (3.0 - np.sqrt(5.0))
"""The angle from one leaf or floret to the next round a stem [rad]."""

_MOST_SPREAD = 0.98

WHOLE = "variant", "organ"
"""What of rows is whole numbers."""


@dataclass(frozen=True, slots=True, eq=False)
class Stems:
    """Stems that leaves and heads stand on."""

    plant: Numbers
    """The plant of each, shape (m,)."""

    branch: Numbers
    """Its number on its plant, shape (m,)."""

    height: Doubles
    """Length [m], shape (m,)."""

    rest: Doubles
    """Lean, as `Blades.rest`, shape (m, 2)."""

    def of(self, rows: Numbers, /) -> "Stems":
        """Return some of them, (k,)."""
        return Stems(self.plant[rows], self.branch[rows], self.height[rows], self.rest[rows])


@dataclass(frozen=True, slots=True, eq=False)
class Rows:
    """Rows of `Blades`, with the plant that each belongs to in place of root and rank, (k,) or (k, 2) each."""

    plant: Numbers
    branch: Numbers
    height: NDArray[np.floating]
    width: NDArray[np.floating]
    facing: NDArray[np.floating]
    rest: NDArray[np.floating]
    variant: NDArray[np.int32]
    organ: NDArray[np.int32]
    stem: NDArray[np.floating]
    part: NDArray[np.floating]
    stem_rest: NDArray[np.floating]


def stood(
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
    """Return organs on stems, of which `height` has as many as each bears: shape (m, each), as all are or become.

    They stand at `part` of their stem, and reach out `toward` an azimuth [rad] at the posture index `spread`; what all
    of a stem lean together is its `tilt`, shape (m, 2). They face to where they reach.
    """
    height = np.asarray(height, np.float64)
    shape = height.shape
    toward, spread = np.broadcast_to(toward, shape), np.broadcast_to(spread, shape)
    rest = spread[..., None] * np.stack([np.cos(toward), np.sin(toward)], axis=-1)
    if tilt is not None:
        rest = rest + tilt[:, None]
        rest = rest * np.minimum(1.0, _MOST_SPREAD / np.maximum(np.linalg.norm(rest, axis=-1, keepdims=True), 1e-9))
    each = shape[1]
    return Rows(
        plant=np.repeat(stems.plant, each),
        branch=np.repeat(stems.branch, each),
        height=height.reshape(-1),
        width=np.broadcast_to(width, shape).reshape(-1),
        facing=toward.reshape(-1),
        rest=rest.reshape(-1, 2),
        variant=np.zeros(height.size, np.int32) if variant is None else variant.reshape(-1),
        organ=np.broadcast_to(np.asarray(organ, np.int32), shape).reshape(-1),
        stem=np.repeat(stems.height, each),
        part=np.broadcast_to(part, shape).reshape(-1),
        stem_rest=np.repeat(stems.rest, each, axis=0),
    )


def together(stand: Blades, /, *parts: Rows) -> Blades:
    """Return rows as blades, plant after plant: each has the root and the rank of its plant's blade in `stand`.

    In this order they are drawn, as all rows of a plant are as far away as its root. So they come branch after branch:
    were all heads the last, they would cover the leaves of branches that stand before them.
    """
    whole = {each.name: np.concatenate([getattr(rows, each.name) for rows in parts]) for each in fields(Rows)}
    order = np.lexsort((whole.pop("branch"), whole["plant"]))
    plant = whole.pop("plant")[order]
    kept: dict[str, Any] = {
        name: values[order].astype(np.int32 if name in WHOLE else np.float32) for name, values in whole.items()
    }
    facing = kept.pop("facing").astype(np.float64)
    kept["facing"] = ((facing + np.pi) % (2.0 * np.pi) - np.pi).astype(np.float32)
    return Blades(root=stand.root[plant], rank=stand.rank[plant], **kept)
