"""Files that are kept from one run to the next, in one folder: none is ever found in halves, and none is needed."""

import logging
import os
import tempfile
from contextlib import suppress
from functools import cache
from hashlib import blake2b
from pathlib import Path

log = logging.getLogger("tallgrass")

DIGEST = 32
"""Bytes of a checksum."""


def cache_folder() -> Path | None:
    """Return where growth is kept: TALLGRASS_CACHE, or tallgrass in XDG_CACHE_HOME or ~/.cache; None if nowhere."""
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
    """Say once that nothing is kept."""
    log.warning(
        "what has been grown cannot be kept in %s (%s), so it is grown each time: TALLGRASS_CACHE may name a folder",
        folder, reason,
    )  # fmt: skip


def checksum(data: bytes | memoryview, key: str, /) -> bytes:
    """Return a checksum over some bytes and the name that they are kept under."""
    return blake2b(data, digest_size=DIGEST, key=key.encode()).digest()


def kept(name: str, key: str, /) -> memoryview | None:
    """Return the bytes that were kept under a name; None where none are, or where they are not those of its key."""
    folder = cache_folder()
    if folder is None:
        return None
    with suppress(OSError):
        data = (folder / name).read_bytes()
        told = memoryview(data)[DIGEST:]
        if data[:DIGEST] == checksum(told, key):
            mark_used(folder / name)
            return told
    return None


def keep(name: str, key: str, data: bytes, /, *, most: int) -> None:
    """Keep what `kept` returns, and so many files of its suffix; where nothing can be written, that is said once."""
    folder = cache_folder()
    if folder is None:
        tell_nothing_is_kept("a cache folder", "there is no home folder")
        return
    try:
        write_whole(folder / name, checksum(data, key) + data)
        forget_oldest(folder, Path(name).suffix, most)
    except OSError as error:
        tell_nothing_is_kept(str(folder), error.strerror or "it cannot be written to")


def mark_used(path: Path, /) -> None:
    """Let a file be one that was used just now."""
    with suppress(OSError):
        os.utime(path)


def write_whole(path: Path, data: bytes, /) -> None:
    """Write a file in one step: no reader ever finds half of it. Raises OSError where that cannot be."""
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(dir=path.parent, suffix=".part")
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(data)
        Path(name).replace(path)
    except OSError:
        Path(name).unlink(missing_ok=True)
        raise


def forget_oldest(folder: Path, suffix: str, most: int, /) -> None:
    """Remove what has not been used for longest, so that the folder does not grow for ever.

    Other programs and threads may do so just now: what is gone, or in use, is no error.
    """
    for path in sorted(folder.glob("*" + suffix), key=_used)[:-most]:
        with suppress(OSError):
            path.unlink()


def _used(path: Path) -> float:
    try:
        return path.stat().st_mtime
    except OSError:
        return 0.0
