"""Reading a scene again while it lives: what did not change stays as it is (N7)."""

from dataclasses import replace

from ..engine.declared.quality import Quality
from ..engine.declared.scene import Scene
from ..engine.scene import LoadedScene, load_maps
from .field import Field, lay_out
from .grow.record import Growth
from .stock.cache import cached_growth, growth_key


def laid_again(field: Field, before: LoadedScene, loaded: LoadedScene, /, *, preset: str | None, lod: str) -> Field:
    """Return the field of a scene that was read again; `field` is that of the scene `before`, and stays as it is.

    Terrain, density, growths, patch models, pools and the patch table are the same objects where nothing that they
    come from has changed. Raises SceneError where a map cannot be used.
    """
    scene, quality = loaded.scene, loaded.scene.numbers(preset)
    terrain, density = load_maps(loaded, before=(before, (field.terrain, field.density)))
    growths = _grown(field, scene, quality)
    same_grass = same_growths(field, quality, growths)
    same_ground = terrain is field.terrain and scene.seed == field.scene.seed
    if same_grass and same_ground and density is field.density:
        return replace(field, scene=scene)
    laid = lay_out(
        scene, quality, terrain, density, growths, lod=lod, transitions=field.transitions,
        stock=field.stock if same_grass else None,
    )  # fmt: skip
    table = field.table if same_ground and quality == field.quality else laid.table
    return replace(laid, table=table, sight=field.sight)


def same_growths(field: Field, quality: Quality, growths: list[Growth]) -> bool:
    """Return whether a field's grass is just this."""
    same = len(growths) == len(field.growths) and all(map(_is, growths, field.growths))
    return same and quality == field.quality


def _is(one: object, other: object) -> bool:
    return one is other


def _grown(field: Field, scene: Scene, quality: Quality) -> list[Growth]:
    """Return what grows of a scene's kinds; what the field has of it is not read or grown again."""
    known = dict(zip(_keys(field.scene, field.quality), field.growths, strict=True))
    growths = []
    for number, (key, kind) in enumerate(zip(_keys(scene, quality), scene.grass.values(), strict=True)):
        growths.append(known.get(key) or cached_growth(kind, quality, seed=scene.seed + number))
    return growths


def _keys(scene: Scene, quality: Quality) -> list[str]:
    return [growth_key(kind, quality, seed=scene.seed + number) for number, kind in enumerate(scene.grass.values())]
