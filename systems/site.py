"""A site: what a scene has become before anybody looks at it."""

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
"""Layers of a texture that there is room for on graphics cards: the pictures of all kinds' patch models share them."""


@dataclass(frozen=True, slots=True, weakref_slot=True, eq=False)
class Site(Grown):
    """A scene with its ground, its grown kinds, and its representations in stock."""

    representations: tuple[Representation, ...]
    reach: tuple[int, ...]
    """Largest discrete distance of each representation."""

    sway: float
    """How far grass may reach beyond its patch, leaning and blown [m]."""

    transitions: Transitions = SEAMLESS

    crowns: tuple[tuple[float, ...], tuple[float, ...]] = ((), ())
    """Height of each kind's canopy as it has grown, and as it is to be [m]."""

    def come(self, came: tuple[float, ...], /) -> "Site":
        """Return the site where `came` of each kind have become what they are to be; empty where none is to."""
        own, after = self.crowns
        parts = came or (0.0,) * len(own)
        canopy = tuple(one + part * (other - one) for one, other, part in zip(own, after, parts, strict=True))
        return replace(self, came=came, canopy=canopy)

    @property
    def finest(self) -> int:
        """Line segments per blade at the finest level, of kinds that do not say."""
        return max(ring.segments for ring in self.quality.blade_rings)

    @property
    def margin(self) -> float:
        """How far receivers may stand outside of their patch [m]."""
        return max(each.margin() for each in self.representations)

    @property
    def choosy(self) -> tuple[Representation, ...]:
        """The representations that may pass patches on to coarser ones: none where one stands for finer ones."""
        return self.representations if self.reach[0] >= 0 else ()

    @property
    def blades(self) -> int:
        """Blades that grow on the whole terrain, from the kinds' mean densities."""
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
    transitions: Transitions = SEAMLESS,
    stocked: Sequence[Representation] | None = None,
    coming: Mapping[int, Growth] = NOTHING,
) -> Site:
    """Return the site of a scene whose kinds have grown. `lod` is a representation to stand for all, or `auto`.

    `stocked` are the representations of the same growths, on another ground. `coming` gives what some kinds are to
    become, by their numbers.
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


def numbers_of(scene: Scene, preset: str | None = None, /) -> Quality:
    """Return the numbers of a scene's quality, or of `preset`.

    Where kinds are so many that there would be no room for all pictures, patch models are fewer.
    """
    quality = scene.numbers(preset)
    each = len(scene.grass) * max(one.layers(quality) for one in REPRESENTATIONS)
    models = max(min(quality.models, LAYERS // each), 1)
    return quality if models == quality.models else quality.model_copy(update={"models": models})


def found_site(
    loaded: LoadedScene, /, *, preset: str | None = None, lod: str = "auto", transitions: Transitions = SEAMLESS
) -> Site:
    """Return the site of a scene that was read: its maps loaded, its kinds grown. Raises SceneError for bad maps."""
    scene = loaded.scene
    quality = numbers_of(scene, preset)
    terrain, density = load_maps(loaded)
    growths = [
        cached_growth(kind, quality, seed=scene.seed + number) for number, kind in enumerate(scene.grass.values())
    ]
    return lay_out(scene, quality, Ground(terrain, density, quality.patch), growths, lod=lod, transitions=transitions)


@np.errstate(under="ignore")  # a game calls it, on any thread
def found_again(site: Site, before: LoadedScene, loaded: LoadedScene, /, *, preset: str | None, lod: str) -> Site:
    """Return the site of a scene that was read again; `site` is that of the scene `before`, and stays as it is.

    Ground, growths and representations are the same objects where nothing that they come from has changed. Raises
    SceneError where a map cannot be used.
    """
    scene, quality = loaded.scene, numbers_of(loaded.scene, preset)
    old = site.ground
    terrain, density = load_maps(loaded, before=(before, (old.terrain, old.density)))
    growths = _grown(site, scene, quality)
    same_grass = quality == site.quality and len(growths) == len(site.growths)
    same_grass = same_grass and all(one is other for one, other in zip(growths, site.growths, strict=True))
    same_ground = terrain is old.terrain and density is old.density and quality.patch == old.patch
    same_grass = same_grass and not site.coming
    if same_grass and same_ground and scene.seed == site.scene.seed:
        return replace(site, scene=scene)
    ground = old if same_ground else Ground(terrain, density, quality.patch)
    stocked = site.representations if same_grass else None
    return lay_out(scene, quality, ground, growths, lod=lod, transitions=site.transitions, stocked=stocked)


def is_other(site: Site, name: str, kind: GrassKind, /) -> bool:
    """Return whether something else must be grown for a kind of this name than what stands of it."""
    seed = site.scene.seed + list(site.scene.grass).index(name)
    return growth_key(kind, site.quality, seed=seed) != growth_key(site.scene.grass[name], site.quality, seed=seed)


def ripened(
    site: Site,
    known: tuple[Mapping[str, GrassKind], Mapping[str, GrassKind]],
    stands: Mapping[str, GrassKind],
    comes: Mapping[str, GrassKind],
    /,
) -> Site:
    """Return a site on which other kinds stand, and some come to be what `comes` says of them.

    `known` are the kinds that have grown on the site, and those that are to come there. As grass takes its time to
    grow, it may be called on another thread.
    """
    numbers = {name: number for number, name in enumerate(site.scene.grass)}
    grown = dict[str, Growth]()
    for kinds, own in zip(known, (dict(enumerate(site.growths)), site.coming), strict=True):
        for name, kind in kinds.items():
            seed = site.scene.seed + numbers[name]
            grown[growth_key(kind, site.quality, seed=seed)] = own[numbers[name]]

    def growth_of(name: str, kind: GrassKind) -> Growth:
        seed = site.scene.seed + numbers[name]
        key = growth_key(kind, site.quality, seed=seed)
        return grown.get(key) or cached_growth(kind, site.quality, seed=seed)

    scene = site.scene.model_copy(update={"grass": {name: stands[name] for name in numbers}})
    growths = [growth_of(name, stands[name]) for name in numbers]
    coming = {numbers[name]: growth_of(name, kind) for name, kind in comes.items()}
    same = growths == site.growths and coming == dict(site.coming)
    if same:
        return replace(site, scene=scene, growths=growths)
    made = lay_out(scene, site.quality, site.ground, growths, transitions=site.transitions, coming=coming)
    for each in made.representations:
        each.prepare()
    figures_on(made.come((1.0,) * len(growths)))  # they are remembered, as tables are
    for growth in (*growths, *coming.values()):
        posture_table(growth)
    return replace(made, reach=site.reach)


def is_grown(site: Site, scene: Scene, /, *, preset: str | None) -> bool:
    """Return whether a site has the ground of a scene, and has grown all of its kinds: it follows at once then."""
    quality, old = numbers_of(scene, preset), site.scene
    same = scene.terrain == old.terrain and scene.seed == old.seed and quality == site.quality
    return same and _keys(scene, quality) == _keys(old, site.quality)


def _grown(site: Site, scene: Scene, quality: Quality) -> list[Growth]:
    """Return what grows of a scene's kinds; what the site has of it is not read or grown again."""
    known = dict(zip(_keys(site.scene, site.quality), site.growths, strict=True))
    growths = []
    for number, (key, kind) in enumerate(zip(_keys(scene, quality), scene.grass.values(), strict=True)):
        growths.append(known.get(key) or cached_growth(kind, quality, seed=scene.seed + number))
    return growths


def _keys(scene: Scene, quality: Quality) -> list[str]:
    return [growth_key(kind, quality, seed=scene.seed + number) for number, kind in enumerate(scene.grass.values())]


def farthest_reach(kind: GrassKind, growth: Growth) -> float:
    """Return how far the tip of a kind's tallest blade can come to be from its root, along the ground [m]."""
    return max(kind.height[1], tallest_tip(growth)) * float(np.abs(growth.postures.shape[..., 0]).max())


def tallest_tip(growth: Growth) -> float:
    """Return how high a kind's highest tip would be if its blade stood upright [m]."""
    return max(float((model.blades.height + model.blades.stem).max()) for model in growth.models)


def outlook_on(site: Site, viewer: Viewer, entity: int, /) -> Outlook:
    """Return the empty outlook of a viewer on a site; `entity` is the viewer's."""
    outlook = Outlook(viewer, entity, PatchTable.allocate(2 * site.reach[-1] + 1, NAMES, viewer=viewer.name))
    outlook.heights, outlook.sown = site.ground.terrain.changes.count, site.ground.density.sown.count
    keep_room(outlook, site.representations, site.reach)
    return outlook


def settle_on(outlook: Outlook, site: Site, before: Site, world: World, /) -> None:
    """Let a viewer go on with another site, that of a scene read again; what has not changed stays."""
    if site.representations is before.representations:
        return
    same = site.scene.seed == before.scene.seed and site.quality == before.quality and site.reach == before.reach
    if site.ground is before.ground and same:
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
    rows = np.flatnonzero(outlook.patches.entity).tolist()
    for row, parts in zip(rows, components(outlook, site.representations, rows), strict=True):
        for part in parts:
            world.add(int(outlook.patches.entity[row]), part)
