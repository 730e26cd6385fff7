"""Growing a kind of grass: postures, response, and patch models with all their pictures (paper, sections 2.2, 3.2)."""

from dataclasses import fields, is_dataclass, replace
from functools import lru_cache

import numpy as np

from ...components.arrays import Floats
from ...engine.declared.grass import GrassKind
from ...engine.declared.quality import Quality
from ...engine.executor import DaemonExecutor
from ..grow.bend import spine
from ..grow.layout import layout_of
from ..grow.plants import grow_patch
from ..grow.postures import grow_give, grow_postures
from ..grow.record import Blades, Growth, PatchModel, Postures, Response
from ..grow.response import grow_response
from ..show.registry import REPRESENTATIONS
from ..show.representation import Seedling

VARIANTS = 6
"""Number of variants of a blade's shape at each posture index."""

ROWS = 129
"""Number of posture indices in the table of postures."""

_MIPMAPS = 4.0 / 3.0
"""Size of a texture with its mip levels, over that of the finest level."""

_REMEMBERED = 64
"""Number of remembered simulations. Where only the quality, density or form of grass changes, it bends as before."""

_THREADS = 2
"""Number of threads that draw patch models: more would wait for Python, not for a processor."""


def grow(kind: GrassKind, quality: Quality, /, *, seed: int) -> Growth:
    """Return all that is precomputed for a kind of grass at a quality; the same seed gives the same result.

    The textures of all patch models have the same size, height and margin, so that they can be layers of one texture.
    They are drawn on several threads: each depends on its own patch model alone.
    """
    mechanics = mechanics_of(kind)
    give, response = _give_and_response(mechanics)
    postures = replace(_postures(mechanics, seed), give=give)
    layout = layout_of(kind, quality)
    patches = [
        grow_patch(kind, layout, patch=quality.patch, variants=VARIANTS, seed=_mixed(seed, number))
        for number in range(quality.models)
    ]
    height, margin = _extent(patches, postures, quality.patch)
    models = _models([Seedling(blades, postures, kind, quality, height, margin) for blades in patches])
    return Growth(postures=postures, response=response, models=models)


def precompute_bytes(growth: Growth, /) -> int:
    """Return the memory that a kind's growth takes [bytes], textures with their mip levels."""
    seen: dict[int, int] = {}
    _gather(growth, seen)
    return sum(seen.values())


def mechanics_of(kind: GrassKind, /) -> str:
    """Return the values of a kind that its simulation depends on, as JSON."""
    return kind.model_dump_json(include={"height", "width", "taper", "stiffness", "damping"})


@lru_cache(maxsize=_REMEMBERED)
def _give_and_response(mechanics: str, /) -> tuple[Floats, Response]:
    """Return the give and the response of grass with these values."""
    kind = GrassKind.model_validate_json(mechanics)
    return grow_give(kind), grow_response(kind)


@lru_cache(maxsize=_REMEMBERED)
def _postures(mechanics: str, seed: int, /) -> Postures:
    """Return the postures of grass with these values."""
    return grow_postures(GrassKind.model_validate_json(mechanics), variants=VARIANTS, rows=ROWS, seed=seed)


def _models(seedlings: list[Seedling], /) -> tuple[PatchModel, ...]:
    """Return patch models, drawn on several threads: numpy releases Python's lock while it computes large arrays."""
    drawn = [each for each in REPRESENTATIONS if each.record is not None]
    threads = DaemonExecutor(_THREADS)
    try:
        pieces = {
            (number, each.name): threads.submit(each.grow, seedling)
            for number, seedling in enumerate(seedlings)
            for each in drawn
        }
        return tuple(
            PatchModel(seedling.blades, {each.name: pieces[number, each.name].result() for each in drawn})
            for number, seedling in enumerate(seedlings)
        )
    finally:
        threads.release()  # after an interrupt nothing more is drawn


def _extent(patches: list[Blades], postures: Postures, patch: float, /) -> tuple[float, float]:
    """Return the height of the highest tip and the overhang of blades at the patch's edge, to the centimetre [m]."""
    points = postures.shape.shape[2]
    places = np.concatenate([spine(blades, postures, (0.0, 0.0), points=points).reshape(-1, 3) for blades in patches])
    beyond = max(-float(places[:, ::2].min()), float(places[:, ::2].max()) - patch)
    half = 0.5 * max(float(blades.width.max()) for blades in patches)
    return _centimetres(float(places[:, 1].max())), _centimetres(beyond + half)


def _centimetres(length: float, /) -> float:
    return float(np.ceil(max(length, 0.0) * 100.0 + 0.01) / 100.0)


def _mixed(seed: int, number: int, /) -> int:
    """Return the seed of the patch model of this number."""
    return int(np.random.SeedSequence([seed, number]).generate_state(1, np.uint64)[0])


def _gather(record: object, seen: dict[int, int], /) -> None:
    """Add the size of every array in a record to `seen`, by the array's identity, so that each counts once."""
    if isinstance(record, np.ndarray):
        seen[id(record)] = int(record.nbytes * (_MIPMAPS if record.dtype == np.uint8 else 1.0))
    elif isinstance(record, dict):
        for part in record.values():
            _gather(part, seen)
    elif isinstance(record, tuple):
        for part in record:
            _gather(part, seen)
    elif is_dataclass(record):
        for field in fields(record):
            _gather(getattr(record, field.name), seen)
