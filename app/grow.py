"""`tallgrass grow`: growing the grass of scenes beforehand, so that they open at once."""

from collections.abc import Iterator
from pathlib import Path

from ..engine.declared.grass import GrassKind
from ..engine.declared.quality import Quality
from ..engine.scene import read_scene
from ..systems.stock.cache import cache_folder, growth_key, is_kept, keep, packed_growth
from .studio.errors import MachineError
from .studio.progress import counted

Seed = tuple[GrassKind, Quality, int]
"""What a growth comes from: a kind, a quality, and a seed."""


def grow(scenes: list[str], *, preset: str | None, on: str | None = None) -> None:
    """Grow what no scene's kinds have been grown for yet into the cache, and print what each scene has.

    With `on`, workers grow it. Raises `SceneError` where a scene is wrong, MachineError where nothing can be kept.
    """
    folder = cache_folder()
    if folder is None:
        raise MachineError("there is no folder to keep it in; name one: TALLGRASS_CACHE")
    wanted = {scene: _seeds(scene, preset) for scene in scenes}
    new: dict[str, Seed] = {}
    for key, seed in (pair for each in wanted.values() for pair in each.items()):
        kind, quality, number = seed
        if key not in new and not is_kept(kind, quality, seed=number, folder=folder):
            new[key] = seed
    for key, data in zip(new, counted(_grown(list(new.values()), on), total=len(new), doing="growing"), strict=True):
        _keep(data, key, folder)
    for scene, seeds in wanted.items():
        print(f"{scene}: kinds {len(seeds)}, grown now {len(seeds.keys() & new.keys())}")


def _seeds(scene: str, preset: str | None) -> dict[str, Seed]:
    """Return what a scene's kinds grow from, by the names that the cache has for it."""
    read = read_scene(scene).scene
    quality = read.numbers(preset)
    seeds = [(kind, quality, read.seed + number) for number, kind in enumerate(read.grass.values())]
    return {growth_key(kind, quality, seed=number): (kind, quality, number) for kind, quality, number in seeds}


def _grown(seeds: list[Seed], on: str | None) -> Iterator[bytes]:
    if on is None or not seeds:
        yield from (packed_growth(kind, quality, seed=number) for kind, quality, number in seeds)
        return
    from .farm.growth import grown_on

    yield from grown_on(on, seeds)


def _keep(data: bytes, key: str, folder: Path) -> None:
    try:
        keep(data, key, folder)
    except OSError as error:
        raise MachineError(f"{folder}: {error.strerror}; name another folder: TALLGRASS_CACHE") from None
