"""The file cache between runs, in one folder: files are written atomically, and the program works without them."""

import json
import logging
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import cache
from hashlib import blake2b
from importlib.metadata import PackageNotFoundError, version
from importlib.resources import files
from importlib.resources.abc import Traversable
from itertools import accumulate
from operator import itemgetter
from pathlib import Path
from secrets import token_hex

import numpy as np

log = logging.getLogger("tallgrass")

MEGABYTE = 1 << 20

DIGEST = 32
"""Length of a checksum [bytes]."""

CODE = ".py", ".glsl", ".vert", ".frag"
"""Suffixes of source files."""


def cache_folder() -> Path | None:
    """Return the cache folder: TALLGRASS_CACHE, or tallgrass in XDG_CACHE_HOME or ~/.cache; None if there is none."""
    if chosen := os.environ.get("TALLGRASS_CACHE"):
        return Path(chosen)
    base = Path(os.environ.get("XDG_CACHE_HOME", ""))
    if base.is_absolute():
        return base / "tallgrass"
    try:
        return Path.home() / ".cache" / "tallgrass"
    except RuntimeError:
        return None


@cache
def tell_nothing_is_kept(folder: str, reason: str, /) -> None:
    """Log that nothing can be cached, once for each folder and reason."""
    log.warning(
        "nothing can be cached in %s (%s), so plants and clouds are computed each time; TALLGRASS_CACHE names another",
        folder, reason,
    )  # fmt: skip


@cache
def code_hash(*paths: str) -> str:
    """Return a hexadecimal hash of the sources at paths in this package, files or folders, for the key of a cache.

    So nothing is used that other code has made. The versions of this package and of numpy count, too: a game that was
    compiled has no sources.
    """
    digest = blake2b(np.__version__.encode(), digest_size=DIGEST // 2)
    with suppress(PackageNotFoundError):
        digest.update(version("tallgrass").encode())
    for path in paths:
        for name, source in _sources(path, files("tallgrass").joinpath(path)):
            digest.update(name.encode() + b"\0" + source.read_bytes())
    return digest.hexdigest()


def _sources(path: str, entry: Traversable) -> Iterator[tuple[str, Traversable]]:
    """Yield the path and file of each source file at a path, in order; nothing where there is none."""
    if entry.is_dir():
        for inner in sorted(entry.iterdir(), key=lambda each: each.name):
            yield from _sources(f"{path}/{inner.name}", inner)
    elif entry.is_file() and path.endswith(CODE):
        yield path, entry


def key_of(depends: object, /) -> str:
    """Return the key of a cache, in hexadecimal: a hash of the plain values that what is cached depends on."""
    return blake2b(json.dumps(depends, sort_keys=True).encode(), digest_size=20).hexdigest()


def kept(key: str, suffix: str, /) -> memoryview | None:
    """Return the bytes cached under a key; None where there are none, or their checksum with the key is wrong."""
    folder = cache_folder()
    if folder is None:
        return None
    path = folder / (key + suffix)
    with suppress(OSError):
        data = path.read_bytes()
        content = memoryview(data)[DIGEST:]
        if data[:DIGEST] == _checksum(content, key):
            with suppress(OSError):
                os.utime(path)  # it was used
            return content
    return None


def keep(key: str, suffix: str, data: bytes, /, *, room: int) -> None:
    """Cache bytes for `kept`, and make room for them; a failure is logged once.

    The files of this suffix that were not used for longest are removed, until all together fit into `room` [bytes].
    """
    folder = cache_folder()
    if folder is None:
        tell_nothing_is_kept("the home folder", "there is none")
        return
    try:
        keep_in(folder, key, suffix, data, room=room)
    except OSError as error:
        tell_nothing_is_kept(str(folder), error.strerror or "it cannot be written to")


def keep_in(folder: Path, key: str, suffix: str, data: bytes, /, *, room: int | None) -> None:
    """Do what `keep` does in a folder, without a bound where `room` is None; raises OSError if it cannot be written."""
    folder.mkdir(parents=True, exist_ok=True)
    with replacing(folder / (key + suffix)) as part:
        part.write_bytes(_checksum(data, key) + data)
    if room is not None:
        _make_room(folder, suffix, room)


def _checksum(data: bytes | memoryview, key: str) -> bytes:
    """Return a checksum over some bytes and their key."""
    return blake2b(data, digest_size=DIGEST, key=key.encode()).digest()


@contextmanager
def replacing(path: Path, /) -> Iterator[Path]:
    """Yield a file to write, which takes the place of `path` once it is whole: no reader ever finds half of it."""
    part = path.with_name(f".{token_hex(DIGEST // 2)}.part")  # tempfile's would be its owner's alone
    try:
        yield part
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)


def _make_room(folder: Path, suffix: str, room: int) -> None:
    """Remove the least recently used files of a suffix that do not fit into `room` [bytes]; the last one always stays.

    Other programs and threads may do so at the same time: a file that is gone, or in use, is no error.
    """
    found = [(path, *_used(path)) for path in folder.glob("*" + suffix)]
    found.sort(key=itemgetter(1), reverse=True)
    sizes = accumulate(size for _, _, size in found)
    for (path, _, _), taken in [*zip(found, sizes, strict=True)][1:]:
        if taken > room:
            with suppress(OSError):
                path.unlink()


def _used(path: Path) -> tuple[float, int]:
    """Return when a file was last used [s], and its size [bytes]."""
    try:
        found = path.stat()
    except OSError:
        return 0.0, 0
    return found.st_mtime, found.st_size
