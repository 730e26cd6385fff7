"""The cache of growths on disk, under a hash of everything that a growth depends on."""

import json
from dataclasses import asdict
from hashlib import blake2b

from ...engine.declared.grass import GrassKind
from ...engine.declared.quality import Quality
from ...engine.kept import code_hash, keep, kept
from ..grow.layout import layout_of
from ..grow.record import Growth
from ..show.registry import REPRESENTATIONS
from .archive import pack, unpack
from .models import blade_count, grow

CODE = "systems/grow", "systems/stock", *(f"systems/show/{each.name}/grow.py" for each in REPRESENTATIONS)
"""Sources that grow grass; a representation without pictures of its own has no `grow.py`."""

SUFFIX = ".growth"

MOST = 48
"""Number of growths kept in a folder."""


def cached_growth(kind: GrassKind, quality: Quality, /, *, seed: int) -> Growth:
    """Return what `grow` returns, from the disk if it was grown before.

    A file that is damaged or foreign is replaced by a new growth. If the cache folder cannot be read or written, each
    growth is grown anew.
    """
    key = growth_key(kind, quality, seed=seed)
    growth = _kept(kind, quality, key)
    if growth is None:
        growth = grow(kind, quality, seed=seed)
        keep(key, SUFFIX, pack(growth), most=MOST)
    return growth


def is_kept(kind: GrassKind, quality: Quality, /, *, seed: int) -> bool:
    """Return whether `cached_growth` would find a growth; if so, mark it as used."""
    return _kept(kind, quality, growth_key(kind, quality, seed=seed)) is not None


def _kept(kind: GrassKind, quality: Quality, key: str) -> Growth | None:
    data = kept(key, SUFFIX)
    return None if data is None else unpack(data, quality=quality, blades=blade_count(kind, quality))


def growth_key(kind: GrassKind, quality: Quality, /, *, seed: int) -> str:
    """Return a hexadecimal hash of all that the result of `grow` depends on: not of colours or places."""
    depends = {
        "code": code_hash(*CODE),
        "seed": seed,
        "kind": _grown_by(kind),
        "layout": asdict(layout_of(kind, quality)),
        "quality": quality.model_dump(include={"patch", "models"}, mode="json"),
        "pictures": {each.name: each.depends(kind, quality) for each in REPRESENTATIONS},
    }
    return blake2b(json.dumps(depends, sort_keys=True).encode(), digest_size=20).hexdigest()


def _grown_by(kind: GrassKind) -> dict[str, object]:
    """Return the values of a kind that growing depends on; of an eye, only whether there is one."""
    keys = {
        "plant", "height", "width", "stiffness", "damping", "lean", "taper", "profile", "clumping", "withered", "leaf",
        "head",
    }  # fmt: skip
    kept: dict[str, object] = kind.model_dump(include=keys, mode="json")
    if kind.head is not None:
        kept["head"] = kind.head.model_dump(exclude={"eye"}, mode="json") | {"eye": kind.head.eye is not None}
    return kept
