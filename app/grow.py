"""`tallgrass grow`: growing the grass of scenes beforehand, so that they open at once."""

import sys
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from pathlib import Path

from ..engine.declared.grass import GrassKind
from ..engine.declared.quality import Quality
from ..engine.kept import cache_folder, keep_in
from ..engine.scene import read_scene
from ..systems.site import seed_of
from ..systems.stock.archive import pack
from ..systems.stock.cache import SUFFIX, growth_key, is_kept
from ..systems.stock.models import grow as grow_kind
from .studio.errors import MachineError
from .studio.progress import counted

Seed = tuple[GrassKind, Quality, int]
"""The inputs of a growth: a kind, a quality, and a seed."""


def grow(scenes: list[str], *, preset: str | None, on: str | None = None) -> None:
    """Grow the missing kinds of all scenes into the cache, and print what each scene has.

    With `on`, workers grow them. Raises `SceneError` where a scene is wrong, MachineError where there is no cache.
    """
    folder = cache_folder()
    if folder is None:
        raise MachineError("there is no folder to keep it in; name one: TALLGRASS_CACHE")
    wanted = {scene: _seeds(scene, preset) for scene in scenes}
    new = _grow(wanted.values(), folder, on)
    for scene, seeds in wanted.items():
        print(f"{scene}: kinds {len(seeds)}, grown now {len(seeds.keys() & new)}")


def grow_ahead(scene: str, *, preset: str | None) -> None:
    """Grow the missing kinds of a scene before it is loaded, with a progress bar on a terminal.

    In a pipe, and without a cache, loading the scene grows them.
    """
    folder = cache_folder()
    if folder is not None and sys.stderr.isatty():
        with suppress(MachineError):
            _grow([_seeds(scene, preset)], folder, None)


def _grow(wanted: Iterable[Mapping[str, Seed]], folder: Path, on: str | None) -> set[str]:
    """Grow everything that is not in the cache yet, and return it."""
    new: dict[str, Seed] = {}
    for key, seed in (pair for each in wanted for pair in each.items()):
        kind, quality, number = seed
        if key not in new and not is_kept(kind, quality, seed=number):
            new[key] = seed
    for key, data in zip(new, counted(_grown(list(new.values()), on), total=len(new), doing="growing"), strict=True):
        _keep(data, key, folder)
    return set(new)


def _seeds(scene: str, preset: str | None) -> dict[str, Seed]:
    """Return the inputs of the growths of a scene's kinds, by their keys in the cache."""
    read = read_scene(scene).scene
    quality = read.numbers(preset)
    seeds = [(kind, quality, seed_of(read, name)) for name, kind in read.grass.items()]
    return {growth_key(kind, quality, seed=number): (kind, quality, number) for kind, quality, number in seeds}


def _grown(seeds: list[Seed], on: str | None) -> Iterator[bytes]:
    if on is None or not seeds:
        yield from (pack(grow_kind(kind, quality, seed=number)) for kind, quality, number in seeds)
        return
    from .farm.hire import hired

    with hired(on, most=len(seeds)) as hands:
        keys = [growth_key(kind, quality, seed=number) for kind, quality, number in seeds]
        yield from hands.in_order(grown, ((*each, key) for each, key in zip(seeds, keys, strict=True)))


def grown(kind: GrassKind, quality: Quality, seed: int, key: str, /) -> bytes:
    """Grow a kind in a worker; raises MachineError where the worker's code differs from the caller's."""
    if growth_key(kind, quality, seed=seed) != key:
        raise MachineError("--on: a worker grows grass by other code than this machine; install the same there")
    return pack(grow_kind(kind, quality, seed=seed))


def _keep(data: bytes, key: str, folder: Path) -> None:
    try:
        keep_in(folder, key, SUFFIX, data, room=None)  # all that was asked for stays, however much it is
    except OSError as error:
        raise MachineError(f"{folder}: {error.strerror}; name another folder: TALLGRASS_CACHE") from None
