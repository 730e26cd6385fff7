"""A site: a scene with its ground loaded, its kinds grown and its representations in stock."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import starmap

import numpy as np

from ..components.viewer import Viewer
from ..engine.declared.grass import GrassKind
from ..engine.declared.quality import Quality
from ..engine.declared.scene import Scene
from ..engine.scene import LoadedScene, load_maps
from ..engine.world import World
from .around.outlook import Outlook
from .around.patches import PatchTable
from .around.transitions import SEAMLESS, Transitions
from .entities import components
from .grow.record import NOTHING, Growth, forms_of
from .land.part import posture_table
from .land.record import figures_on
from .lod import reach_of
from .room import keep_on, keep_room
from .show.registry import NAMES, REPRESENTATIONS
from .show.representation import Representation
from .space.canopy import canopy_height
from .space.ground import Ground
from .space.grown import Grown
from .stock.cache import cached_growth, growth_key

LAYERS = 2048
"""Number of texture layers that graphics cards allow; the pictures of all kinds' patch models share them."""


@dataclass(frozen=True, slots=True, weakref_slot=True, eq=False, repr=False)
class Site(Grown):
    """A scene with its ground, its grown kinds, and its representations in stock."""

    representations: tuple[Representation, ...]
    reach: tuple[int, ...]
    """Largest discrete distance of each representation."""

    sway: float
    """Distance that leaning and bent grass may reach beyond its patch [m]."""

    transitions: Transitions = SEAMLESS

    crowns: tuple[tuple[float, ...], tuple[float, ...]] = ((), ())
    """Height of each kind's canopy as it has grown, and as its coming growth will have it [m]."""

    def come(self, came: tuple[float, ...], /) -> "Site":
        """Return the site where a fraction `came` of each kind's plants is replaced; empty if no kind is changing."""
        before, after = self.crowns
        parts = came or (0.0,) * len(before)
        canopy = tuple(old + part * (new - old) for old, new, part in zip(before, after, parts, strict=True))
        return replace(self, came=came, canopy=canopy)

    @property
    def finest(self) -> int:
        """Line segments per blade at the finest level, of kinds that do not declare their own."""
        return max(ring.segments for ring in self.quality.blade_rings)

    @property
    def margin(self) -> float:
        """Distance that receivers may stand outside of their patch [m]."""
        return max(each.margin() for each in self.representations)

    @property
    def blades(self) -> int:
        """Number of blades on the whole terrain, estimated from the kinds' mean densities."""
        width, depth = self.ground.terrain.size
        patches = width * depth / self.quality.patch**2
        counts = [len(growth.models[0].blades.height) for growth in self.growths]
        return round(patches * float(np.dot(counts, self.ground.density.maps.mean(axis=(1, 2)))))


def lay_out(
    scene: Scene,
    quality: Quality,
    ground: Ground,
    growths: list[Growth],
    /,
    *,
    lod: str = "auto",
    transitions: Transitions,
    stocked: Sequence[Representation] | None = None,
    coming: Mapping[int, Growth] = NOTHING,
) -> Site:
    """Return the site of a scene whose kinds have grown. `lod` is a representation that replaces all others, or `auto`.

    `stocked` are representations of the same growths on another ground, to be reused. `coming` are the growths that
    replace those of some kinds, by the kinds' numbers.
    """
    made = (
        tuple(each.stocked(growths, quality, ground, coming) for each in REPRESENTATIONS)
        if stocked is None
        else tuple(each.on(ground) for each in stocked)
    )
    limits = tuple(each.reach(quality) for each in REPRESENTATIONS)
    own = tuple(map(canopy_height, growths))
    forms = [(list(scene.grass.values())[form.kind], form.growth) for form in forms_of(growths, coming)]
    return Site(
        scene=scene,
        quality=quality,
        ground=ground,
        growths=growths,
        representations=made,
        reach=reach_of(limits, None if lod == "auto" else NAMES.index(lod)),
        sway=max(starmap(farthest_reach, forms)),
        canopy=own,
        tallest=1.05 * max(tallest_tip(growth) for _, growth in forms),
        transitions=transitions,
        coming=coming,
        crowns=(own, tuple(canopy_height(coming.get(kind, growth)) for kind, growth in enumerate(growths))),
    )


def numbers_of(scene: Scene, preset: str | None, /) -> Quality:
    """Return the numbers of a scene's quality, or of `preset`.

    Kinds have fewer patch models if otherwise the pictures of all would not fit into a texture.
    """
    quality = scene.numbers(preset)
    layers = len(scene.grass) * max(each.layers(quality) for each in REPRESENTATIONS)  # for a model of each kind
    models = max(min(quality.models, LAYERS // layers), 1)
    return quality if models == quality.models else quality.model_copy(update={"models": models})


def found_site(
    loaded: LoadedScene, /, *, preset: str | None = None, lod: str = "auto", transitions: Transitions = SEAMLESS
) -> Site:
    """Load the maps and grow the kinds of a scene that was read; return its site. Raises SceneError for bad maps."""
    scene = loaded.scene
    quality = numbers_of(scene, preset)
    terrain, density = load_maps(loaded)
    growths = _growths(scene, quality, {})
    return lay_out(scene, quality, Ground(terrain, density, quality.patch), growths, lod=lod, transitions=transitions)


@np.errstate(under="ignore")  # games call it, on any thread
def found_again(site: Site, before: LoadedScene, loaded: LoadedScene, /, *, preset: str | None, lod: str) -> Site:
    """Return the site of a scene that was read again; `site`, that of the scene `before`, is not changed.

    Ground, growths and representations are the same objects if nothing that they are made from has changed. Raises
    SceneError for bad maps.
    """
    scene, quality = loaded.scene, numbers_of(loaded.scene, preset)
    old = site.ground
    terrain, density = load_maps(loaded, before=(before, (old.terrain, old.density)))
    growths = _growths(scene, quality, dict(zip(_keys(site.scene, site.quality), site.growths, strict=True)))
    same_grass = quality == site.quality and growths == site.growths and not site.coming
    same_ground = terrain is old.terrain and density is old.density and quality.patch == old.patch
    if same_grass and same_ground and scene.seed == site.scene.seed:
        return replace(site, scene=scene)
    ground = old if same_ground else Ground(terrain, density, quality.patch)
    stocked = site.representations if same_grass else None
    return lay_out(scene, quality, ground, growths, lod=lod, transitions=site.transitions, stocked=stocked)


def must_grow(site: Site, name: str, kind: GrassKind, /) -> bool:
    """Return whether a kind needs another growth than the one that the site has under its name."""
    return _key(site, name, kind) != _key(site, name, site.scene.grass[name])


def ripened(
    site: Site,
    known: tuple[Mapping[str, GrassKind], Mapping[str, GrassKind]],
    stands: Mapping[str, GrassKind],
    comes: Mapping[str, GrassKind],
    /,
) -> Site:
    """Return a site on which the kinds `stands` have grown, and some are to change to those of `comes`.

    `known` are the kinds that have grown on the present site, and those that they are to change to: their growths
    are reused. Growing takes a while, so it may be called on another thread.
    """
    numbers = {name: number for number, name in enumerate(site.scene.grass)}
    own = dict(enumerate(site.growths)), site.coming
    grown = {
        _key(site, name, kind): growths[numbers[name]]
        for kinds, growths in zip(known, own, strict=True)
        for name, kind in kinds.items()
    }

    def growth_of(name: str, kind: GrassKind) -> Growth:
        found = grown.get(_key(site, name, kind))
        return found or cached_growth(kind, site.quality, seed=seed_of(site.scene, name))

    scene = site.scene.model_copy(update={"grass": {name: stands[name] for name in numbers}})
    growths = [growth_of(name, stands[name]) for name in numbers]
    coming = {numbers[name]: growth_of(name, kind) for name, kind in comes.items()}
    same = growths == site.growths and coming == dict(site.coming)
    if same:
        return replace(site, scene=scene, growths=growths)
    made = lay_out(scene, site.quality, site.ground, growths, transitions=site.transitions, coming=coming)
    for each in made.representations:
        each.prepare()
    figures_on(made.come((1.0,) * len(growths)))  # computed here as they are cached, like the tables
    for growth in (*growths, *coming.values()):
        posture_table(growth)
    return replace(made, reach=site.reach)


def is_grown(site: Site, scene: Scene, /, *, preset: str | None) -> bool:
    """Return whether a site has the ground and all growths of a scene, so that a reload takes no time."""
    quality, old = numbers_of(scene, preset), site.scene
    same = scene.terrain == old.terrain and scene.seed == old.seed and quality == site.quality
    return same and _keys(scene, quality) == _keys(old, site.quality)


def seed_of(scene: Scene, name: str, /) -> int:
    """Return the seed from which a scene's kind of a name grows."""
    return scene.seed + list(scene.grass).index(name)


def _growths(scene: Scene, quality: Quality, known: Mapping[str, Growth]) -> list[Growth]:
    """Return the growths of a scene's kinds; those that are `known` by their keys are neither read nor grown again."""
    return [
        known.get(key) or cached_growth(kind, quality, seed=seed_of(scene, name))
        for key, (name, kind) in zip(_keys(scene, quality), scene.grass.items(), strict=True)
    ]


def _keys(scene: Scene, quality: Quality) -> list[str]:
    return [growth_key(kind, quality, seed=seed_of(scene, name)) for name, kind in scene.grass.items()]


def _key(site: Site, name: str, kind: GrassKind) -> str:
    """Return the key of the growth that a kind would have on a site under a name."""
    return growth_key(kind, site.quality, seed=seed_of(site.scene, name))


def farthest_reach(kind: GrassKind, growth: Growth) -> float:
    """Return the largest horizontal distance of the tip of a kind's tallest blade from its root [m]."""
    return max(kind.height[1], tallest_tip(growth)) * float(np.abs(growth.postures.shape[..., 0]).max())


def tallest_tip(growth: Growth) -> float:
    """Return the height of a kind's highest tip if all blades stood upright [m]."""
    return max(float((model.blades.height + model.blades.stem).max()) for model in growth.models)


def outlook_on(site: Site, viewer: Viewer, entity: int, /) -> Outlook:
    """Return the empty outlook of a viewer on a site; `entity` is the viewer's."""
    outlook = Outlook(viewer, entity, PatchTable.allocate(2 * site.reach[-1] + 1, NAMES, viewer=viewer.name))
    outlook.heights, outlook.sown = site.ground.terrain.changes.count, site.ground.density.sown.count
    keep_room(outlook, site.representations, site.reach)
    return outlook


def same_settings(site: Site, before: Site, /) -> bool:
    """Return whether grass on two sites is kept and drawn alike, except for the growths of its kinds."""
    same = site.quality == before.quality and site.reach == before.reach and site.scene.seed == before.scene.seed
    return same and len(site.growths) == len(before.growths)


def settle_on(outlook: Outlook, site: Site, before: Site, world: World, /) -> None:
    """Continue a viewer's outlook on another site; keep what has not changed."""
    if site.representations is before.representations:
        return
    if site.ground is before.ground and same_settings(site, before):
        keep_on(outlook, site.representations, before.representations)
        return
    for kept in outlook.kept.values():
        kept.release(world)
    patches = outlook.patches
    same_ground = site.ground.terrain is before.ground.terrain and site.scene.seed == before.scene.seed
    if not (same_ground and site.quality == before.quality):
        for entity in patches.entity[patches.entity != 0].tolist():
            world.delete(entity)
        outlook.patches = PatchTable.allocate(2 * site.reach[-1] + 1, NAMES, viewer=outlook.viewer.name)
        outlook.heights = site.ground.terrain.changes.count
    outlook.sown = site.ground.density.sown.count
    keep_room(outlook, site.representations, site.reach)
    entities = outlook.patches.entity
    rows = [row for row in np.flatnonzero(entities).tolist() if world.has(int(entities[row]))]  # a game deletes some
    for row, parts in zip(rows, components(outlook, rows), strict=True):
        for part in parts:
            world.add(int(entities[row]), part)
