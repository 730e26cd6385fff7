"""What there is on a site at one time, and what a prairie tells of it to those who ask."""

import logging
from collections.abc import Callable
from functools import partial
from typing import NoReturn

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..components.arrays import Floats
from ..components.grass_at import GrassAt
from ..components.sun import Sun
from ..engine.declared.light import Light
from ..engine.declared.scene import Scene
from ..engine.handed import as_rays, must_be_step, must_be_time, must_be_viewer
from ..engine.terrain.pick import pick
from ..engine.terrain.sample import density_at, height_at, natural_at, normal_at
from ..engine.underflow import Underflowing
from ..engine.world import World
from .around.clearing import Clearings
from .around.outlook import Outlooks
from .entities import PatchEntities
from .features import begun, one
from .frame.feature import Start
from .grow.record import Postures
from .light.feature import Lighting
from .mow.feature import Mowing
from .mow.mown import Mown
from .pressers import Pressers
from .site import Site
from .space.ground import PRESENT
from .space.window import as_places, cell_of
from .trees.feature import Trees
from .wind.blow import ReceiverArrays
from .wind.quarantine import Quarantine
from .winds import Winds

log = logging.getLogger("tallgrass")

Felt = Callable[[Floats, int], Floats]
"""Gives the messages (n, 2) that grass of a kind, by its number, feels now at ground positions (n, 2) [m]."""


class Answering(Underflowing):
    """What stands, blows and walks on a site at one time, and answers what is asked of it."""

    viewers: Outlooks
    """What is kept for each viewer, by its name."""

    _released = False

    def __init__(self, site: Site, world: World, *, live: bool) -> None:
        self.site: Site = site
        self.world = world
        self.viewers, self.clearings = Outlooks(world), Clearings()
        self.features = begun(Start(world, site, Quarantine(live=live), live))
        self.winds, self.pressers = one(Winds, self.features), one(Pressers, self.features)
        self._mown, self._shining = one(Mowing, self.features).mown, one(Lighting, self.features).shining
        self._clock, self._missed = 0.0, set[str]()
        # Systems keep these two, and must not keep the prairie by them
        self._entities = partial(_entities_on, world, self.clearings, self.viewers)
        self._felt = partial(_felt_of, self.winds, self.pressers)

    @property
    def scene(self) -> Scene:
        """The scene, as its file or a program declares it."""
        return self.site.scene

    @property
    def wind_failures(self) -> dict[str, str]:
        """One sentence for each wind that is left out now, by its name, as `systems.failures` has them of systems."""
        return {source.name: why for source, why in self.winds.quarantine.reasons.items()}

    @property
    def time(self) -> float:
        """The scene's time [s], to the nearest microsecond: however it was cut into steps, it is the same instant.

        You may set it: then all that the scene declares is as at that time. If you go back, what your own pressers have
        trodden is forgotten; what is cut stays cut. Raises ValueError and TypeError for anything but a time.
        """
        return round(self._clock, 6)

    @time.setter
    def time(self, time: float) -> None:
        self._must_be_there("set its time")
        must_be_time(time, "a prairie's time is set", "to")
        if time < self._clock:
            self.pressers.go_back()
        self._clock = float(time)
        self.winds.pass_to(self.time)
        self.viewers.begin_anew()

    def advance(self, dt: float) -> None:
        """Move time on by `dt` [s]: ValueError below 0 and beyond 1e9 s in all, TypeError for anything but a number."""
        self._must_be_there("move its time on")
        must_be_step(dt)
        later = self._clock + float(dt)  # in single precision, time would soon stand still
        must_be_time(later, "a prairie advances", "to")
        self._clock = later
        self.winds.pass_to(self.time)

    @property
    def light(self) -> Light:
        """The light that is asked for now: what the scene declares, until `shine` changes it; hours pass in it.

        Where there is an hour, azimuth and elevation are those that follow from it; at night the elevation is below 0.
        """
        return self._shining.told_at(self.time)

    @property
    def sun(self) -> Sun:
        """Sun and sky as they shine now: direction and linear radiance, for what a game lights itself.

        A sun that is on its way to where `light` has it stands as in the last frame. Clouds and shadows are not in it.
        """
        return self._shining.sun_at(self.time)

    def height_at(self, xz: ArrayLike) -> Floats:
        """Return the height of the ground [m], shape (n,), at ground positions (x, z) [m], shape (n, 2)."""
        self._must_be_there("ask about it")
        return height_at(self.site.ground.terrain, as_places(xz))

    def normal_at(self, xz: ArrayLike) -> Floats:
        """Return the ground's normals, unit vectors (x, y, z) of shape (n, 3), at ground positions as `height_at`."""
        self._must_be_there("ask about it")
        return normal_at(self.site.ground.terrain, as_places(xz))

    def pick(self, origin: ArrayLike, direction: ArrayLike) -> Floats:
        """Return where rays first meet the ground (x, y, z) [m], shape (n, 3), and NaN where they never do.

        They begin at `origin` [m] and go along `direction`, both of shape (n, 3), or (3,) for one; one origin may serve
        many directions. One that begins below the ground meets it there. Raises ValueError for anything but rays.
        """
        self._must_be_there("ask about it")
        return pick(self.site.ground.terrain, *as_rays(origin, direction))

    def grass_at(self, xz: ArrayLike) -> GrassAt:
        """Return what grows at ground positions (x, z) [m], shape (n, 2), and how high it stands there now."""
        self._must_be_there("ask about it")
        felt = partial(self._felt_at, time=self.time)
        one(Trees, self.features).note(self.time)
        return grass_at(self.site, self.clearings, self._mown, felt, as_places(xz))

    def wind_at(self, xz: ArrayLike, time: float | None = None, *, kind: str | None = None) -> Floats:
        """Return what grass at ground positions (x, z) [m], shape (n, 2), feels at `time` [s], or now.

        Messages of shape (n, 2): vectors along the bending direction whose norm is the posture index, in [0, 1], of
        grass of stiffness 1. They are those of grass of a `kind`, or else of the kind that grows most densely at each
        place. Raises ValueError for an unknown kind and a time that is negative or not finite, TypeError for no time.
        """
        self._must_be_there("ask about it")
        number, then = self.scene.number_of(kind), self.time if time is None else time
        must_be_time(then)
        return self.winds.at(as_places(xz), time=float(then), kind=number)

    def bent_at(self, xz: ArrayLike, *, kind: str | None = None) -> Floats:
        """Return what grass at ground positions (x, z) [m], shape (n, 2), feels now of winds and of pressers.

        Messages of shape (n, 2), of grass of a `kind` or of the densest, as those of `wind_at`: where nobody walks or
        has walked, they are the same. Every presser has come to where its `Pose` is now. Whether grass is cut, cleared
        or grows there at all makes no difference: `grass_at` tells. Raises ValueError for an unknown kind.
        """
        self._must_be_there("ask about it")
        return self._felt_at(as_places(xz), self.scene.number_of(kind), time=self.time)

    def patch_at(self, xz: ArrayLike, *, viewer: str = "main") -> NDArray[np.int64]:
        """Return the entity of the patch at each ground position (x, z) [m], shape (n, 2), as a viewer has it: (n,).

        It has `Patch` and `Lod`. 0 stands for places off the terrain or too far away from the viewer to be kept, and
        for all before it has looked once. Raises ValueError for places that are no pairs, TypeError for a viewer that
        is no name.
        """
        self._must_be_there("ask about it")
        must_be_viewer(viewer)
        cells = cell_of(as_places(xz), patch=self.site.ground.patch)
        if viewer not in self.viewers:
            self._miss(viewer)
            return np.zeros(len(cells), np.int64)
        return self._entities(self.site).at(self.viewers[viewer], cells)

    def _miss(self, viewer: str) -> None:
        """Say once of a viewer that it has never looked, where another has."""
        others = self.viewers.values()
        if others and viewer not in self._missed:
            self._missed.add(viewer)
            known = others[0].viewer.name
            log.warning("patch_at finds nothing: viewer '%s' was never drawn, but '%s' was", viewer, known)

    def __reduce_ex__(self, protocol: object) -> NoReturn:
        """Say what to keep in its place, as no prairie can be pickled or copied."""
        raise TypeError("a prairie cannot be pickled or copied: keep state(), and restore it in another of the scene")

    def _must_be_there(self, purpose: str) -> None:
        if self._released:
            raise RuntimeError(f"this prairie has been released: load it again to {purpose}")

    def _felt_at(self, place: Floats, kind: int | None, /, *, time: float) -> Floats:
        """Return what grass of a kind, or of the densest, feels at places (n, 2) [m] once all have come, (n, 2)."""
        self.pressers.note(time)
        return self._felt(self.winds.standing(place, kind=kind), time=time)


def _entities_on(world: World, clearings: Clearings, viewers: Outlooks, site: Site, /) -> PatchEntities:
    """Return what keeps the entities of patches on a site."""
    return PatchEntities(world, clearings, site.representations, viewers.values)


def _felt_of(winds: Winds, pressers: Pressers, receivers: ReceiverArrays, /, *, time: float) -> Floats:
    """Return what receivers feel at `time` [s] of the winds and of those who walk there, shape (n, 2)."""
    return pressers.over(winds.heard(receivers, time=time), receivers)


def grass_at(site: Site, clearings: Clearings, mown: Mown, felt: Felt, place: Floats, /) -> GrassAt:
    """Return what grows at ground positions (n, 2) [m].

    It stands as high as nine of ten plants of its kind do at most, or as it is cut, and lower as its blades are bent.
    Where kinds grow together the tallest counts.
    """
    density = density_at(site.ground.density, place)
    grows = density >= PRESENT
    kind = np.where(grows.any(axis=0), density.argmax(axis=0), -1)
    taken = ~clearings.spare(cell_of(place, patch=site.ground.patch))
    left, height = mown.at(place), np.zeros(len(place), np.float32)
    for number, growth in enumerate(site.growths):
        here = np.flatnonzero(grows[number] & ~taken)
        if len(here):
            up = upright(growth.postures, np.hypot(*felt(place[here], number).T))
            height[here] = np.maximum(height[here], np.minimum(site.canopy[number], left[here]) * up)
    bare = np.flatnonzero(~grows.any(axis=0))
    taken[bare] |= (natural_at(site.ground.density, place[bare]) >= PRESENT).any(axis=0)
    names = [*site.scene.grass, ""]
    return GrassAt(kind, tuple(names[number] for number in kind), np.ascontiguousarray(density.T), height, taken)


def upright(postures: Postures, message: Floats, /) -> Floats:
    """Return how high blades stand that feel messages of these lengths (n,), of their height in calm air, (n,)."""
    highest = postures.shape[0, :, :, 1].max(axis=1)
    calm = np.interp(0.0, postures.index, highest)
    return np.asarray(
        np.interp(postures.bent_by(message.astype(np.float64)), postures.index, highest / calm), np.float32
    )
