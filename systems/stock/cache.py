"""The cache of growths on disk, under a hash of everything that a growth depends on."""

import json
from contextlib import suppress
from dataclasses import asdict
from hashlib import blake2b
from pathlib import Path

from ...engine.declared.grass import GrassKind
from ...engine.declared.quality import Quality
from ...engine.kept import cache_folder, code_hash, forget_oldest, mark_used, tell_nothing_is_kept, write_whole
from ..grow.layout import layout_of
from ..grow.record import Growth
from ..show.registry import REPRESENTATIONS
from .archive import pack, unpack
from .models import blade_count, grow

CODE = "systems/grow", "systems/stock", *(f"systems/show/{each.name}/grow.py" for each in REPRESENTATIONS)
"""Sources that grow grass; a representation without pictures of its own has no `grow.py`."""

_SUFFIX = ".growth"
_MOST = 48
"""Number of growths kept in a folder."""


def cached_growth(kind: GrassKind, quality: Quality, /, *, seed: int, folder: Path | None = None) -> Growth:
    """Return what `grow` returns, from the disk if it was grown before.

    `folder` is `cache_folder()` by default. A file that is damaged or foreign is replaced by a new growth. If the
    folder cannot be read or written, each growth is grown anew.
    """
    folder = cache_folder() if folder is None else folder
    if folder is None:
        tell_nothing_is_kept("the home folder", "there is none")
        return grow(kind, quality, seed=seed)
    key = growth_key(kind, quality, seed=seed)
    growth = _kept(kind, quality, key, folder)
    if growth is None:
        growth = grow(kind, quality, seed=seed)
        try:
            keep(pack(growth, key=key), key, folder)
        except OSError as error:
            tell_nothing_is_kept(str(folder), error.strerror or "it cannot be written to")
    return growth


def is_kept(kind: GrassKind, quality: Quality, /, *, seed: int, folder: Path) -> bool:
    """Return whether `cached_growth` would find a growth in a folder; if so, mark it as used."""
    return _kept(kind, quality, growth_key(kind, quality, seed=seed), folder) is not None


def packed_growth(kind: GrassKind, quality: Quality, /, *, seed: int) -> bytes:
    """Return what `grow` returns as bytes, as the cache keeps it; they are the same on all machines."""
    return pack(grow(kind, quality, seed=seed), key=growth_key(kind, quality, seed=seed))


def keep(data: bytes, key: str, folder: Path, /) -> None:
    """Write a packed growth into a folder for `cached_growth`; raises OSError if the folder cannot be written."""
    write_whole(folder / (key + _SUFFIX), data)
    forget_oldest(folder, _SUFFIX, _MOST)


def _kept(kind: GrassKind, quality: Quality, key: str, folder: Path) -> Growth | None:
    path = folder / (key + _SUFFIX)
    with suppress(OSError):
        growth = unpack(path.read_bytes(), key=key, quality=quality, blades=blade_count(kind, quality))
        if growth is not None:
            mark_used(path)
            return growth
    return None


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
