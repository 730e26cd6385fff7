"""The cache of growths on disk, under a hash of everything that a growth depends on."""

from dataclasses import asdict

from ...engine.declared.grass import GrassKind
from ...engine.declared.quality import Quality
from ...engine.kept import MEGABYTE, code_hash, keep, kept, key_of
from ..grow.layout import layout_of
from ..grow.record import Growth
from ..show.registry import REPRESENTATIONS
from .archive import pack, unpack
from .models import grow

CODE = "systems/grow", "systems/stock", *(f"systems/show/{each.name}/grow.py" for each in REPRESENTATIONS)
"""Sources that grow grass; a representation without pictures of its own has no `grow.py`."""

SUFFIX = ".growth"

ROOM = 1024 * MEGABYTE
"""Room for growths in a folder [bytes]: at `high`, some 48."""


def cached_growth(kind: GrassKind, quality: Quality, /, *, seed: int) -> Growth:
    """Return what `grow` returns, from the disk if it was grown before.

    A file that is damaged or foreign is replaced by a new growth. If the cache folder cannot be read or written, each
    growth is grown anew.
    """
    key = growth_key(kind, quality, seed=seed)
    data = kept(key, SUFFIX)
    if data is not None:
        return unpack(data)
    growth = grow(kind, quality, seed=seed)
    keep(key, SUFFIX, pack(growth), room=ROOM)
    return growth


def is_kept(kind: GrassKind, quality: Quality, /, *, seed: int) -> bool:
    """Return whether `cached_growth` would find a growth; if so, mark it as used."""
    return kept(growth_key(kind, quality, seed=seed), SUFFIX) is not None


def growth_key(kind: GrassKind, quality: Quality, /, *, seed: int) -> str:
    """Return a hexadecimal hash of all that the result of `grow` depends on: not of colours or places."""
    return key_of(
        {
            "code": code_hash(*CODE),
            "seed": seed,
            "kind": _grown_by(kind),
            "layout": asdict(layout_of(kind, quality)),
            "quality": quality.model_dump(include={"patch", "models"}, mode="json"),
            "pictures": {each.name: each.depends(kind, quality) for each in REPRESENTATIONS},
        }
    )


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
