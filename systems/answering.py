"""The state of a site at one time, and the questions about it that a prairie answers."""

import logging
from collections.abc import Callable
from functools import partial
from typing import NoReturn

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..components.arrays import Floats
from ..components.grass_at import GrassAt
from ..components.patch import Clearings
from ..components.sun import Sun
from ..engine.declared.light import Light
from ..engine.declared.scene import Scene
from ..engine.fixed import Fixed
from ..engine.handed import as_rays, must_be_seconds, must_be_viewer, to_microseconds
from ..engine.terrain.pick import pick
from ..engine.terrain.sample import density_at, height_at, natural_at, normal_at
from ..engine.underflow import Underflowing
from ..engine.world import World
from .around.outlook import Outlooks
from .entities import PatchEntities
from .features import FEATURES, feature_of
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

MessagesAt = Callable[[Floats, int], Floats]
"""Returns the present messages (n, 2) at ground positions (n, 2) [m] to grass of the kind with a number."""


class Answering(Underflowing, Fixed):
    """A site with its winds, pressers and clearings at one time, which answers questions about them."""

    viewers: Outlooks
    """Outlook of each viewer, by the viewer's name."""

    _released = False

    def __init__(self, site: Site, world: World, *, live: bool) -> None:
        self.site: Site = site
        self.world = world
        self.viewers, self.clearings = Outlooks(world), Clearings()
        start = Start(world, site, Quarantine(live=live, come_back=world.come_back), live)
        self.features = [feature(start) for feature in FEATURES]
        self.winds, self.pressers = feature_of(Winds, self.features), feature_of(Pressers, self.features)
        self._mown, self._shining = feature_of(Mowing, self.features).mown, feature_of(Lighting, self.features).shining
        self._clock, self._never_drawn = 0.0, set[str]()
        self._entities = PatchEntities(world, self.clearings, self.viewers.values)
        # Systems hold this: as a bound method it would keep the prairie alive
        self._messages_to = partial(_messages_to, self.winds, self.pressers)

    @property
    def scene(self) -> Scene:
        """The scene, as its file or a program declares it."""
        return self.site.scene

    @property
    def wind_failures(self) -> dict[str, str]:
        """Reason for each wind that is left out now, one sentence, by the wind's name, like `systems.failures`."""
        return {source.name: why for source, why in self.winds.quarantine.reasons.items()}

    @property
    def time(self) -> float:
        """Time of the scene [s], to the nearest microsecond: it does not depend on the steps of `advance`.

        You may set it: everything that the scene declares is then as at that time. If you go back, the trails of your
        own pressers are forgotten; cut grass stays cut. Raises ValueError and TypeError for anything but a time.
        """
        return to_microseconds(self._clock)

    @time.setter
    def time(self, time: float) -> None:
        self._must_be_there("set its time")
        must_be_seconds(time, "a prairie's time is set", "to")
        if time < self._clock:
            self.pressers.go_back()
        self._clock = float(time)
        self.winds.set_clock(self.time)
        self.viewers.begin_anew()

    def advance(self, dt: float) -> None:
        """Advance time by `dt` [s].

        Raises ValueError for a `dt` below 0 and a time beyond 1e9 s, TypeError for anything but a number.
        """
        self._must_be_there("move its time on")
        must_be_seconds(dt, "a prairie advances", "by")
        later = self._clock + float(dt)  # float32 would soon round short steps to nothing
        must_be_seconds(later, "a prairie advances", "to")
        self._clock = later
        self.winds.set_clock(self.time)

    @property
    def light(self) -> Light:
        """Light that is asked for now: what the scene declares, as `shine` has changed it. Its hour moves with time.

        If it has an hour, azimuth and elevation follow from that; at night the elevation is negative.
        """
        return self._shining.resolved_at(self.time)

    @property
    def sun(self) -> Sun:
        """Direction and linear radiance of sun and sky as they shine now, to light a game's own objects with.

        After `shine` it approaches `light` from frame to frame, and is that of the last one. Clouds and shadows are not
        included.
        """
        return self._shining.sun_at(self.time)

    def height_at(self, xz: ArrayLike) -> Floats:
        """Return the height of the ground [m], shape (n,), at ground positions (x, z) [m], shape (n, 2)."""
        self._must_be_there("ask about it")
        return height_at(self.site.ground.terrain, as_places(xz))

    def normal_at(self, xz: ArrayLike) -> Floats:
        """Return the ground's unit normals (x, y, z), shape (n, 3), at ground positions (x, z) [m], shape (n, 2)."""
        self._must_be_there("ask about it")
        return normal_at(self.site.ground.terrain, as_places(xz))

    def pick(self, origin: ArrayLike, direction: ArrayLike) -> Floats:
        """Return the points (x, y, z) [m] where rays first meet the ground, shape (n, 3); NaN for rays that miss it.

        Rays start at `origin` [m] and go along `direction`. Both have shape (n, 3), or (3,) for one ray; one origin may
        serve many directions. A ray that starts below the ground meets it at its origin. Raises ValueError for anything
        but rays.
        """
        self._must_be_there("ask about it")
        return pick(self.site.ground.terrain, *as_rays(origin, direction))

    def grass_at(self, xz: ArrayLike) -> GrassAt:
        """Return the kind, densities and present height of the grass at ground positions (x, z) [m], shape (n, 2)."""
        self._must_be_there("ask about it")
        messages_at = partial(self._messages_at, time=self.time)
        feature_of(Trees, self.features).note(self.time)
        return grass_at(self.site, self.clearings, self._mown, messages_at, as_places(xz))

    def wind_at(self, xz: ArrayLike, time: float | None = None, *, kind: str | None = None) -> Floats:
        """Return the messages (n, 2) of all winds at ground positions (x, z) [m], shape (n, 2), at `time` [s], or now.

        A message is a vector in the direction of bending; its length is the posture index, in [0, 1], of grass of
        stiffness 1. The receiver is grass of a `kind`, by default the densest at each position. Raises ValueError for
        an unknown kind and a time that is negative or not finite, TypeError for anything but a time.
        """
        self._must_be_there("ask about it")
        number, then = self.scene.number_of(kind), self.time if time is None else time
        must_be_seconds(then, "a wind is asked for", "at")
        return self.winds.messages_at(as_places(xz), time=float(then), kind=number)

    def bent_at(self, xz: ArrayLike, *, kind: str | None = None) -> Floats:
        """Return the messages (n, 2) of winds and pressers at ground positions (x, z) [m], shape (n, 2), now.

        They are messages as `wind_at` returns them, to grass of a `kind` or of the densest, and the same where nothing
        is trodden. Each presser presses at its present `Pose`. Cut grass and bare ground have messages too: `grass_at`
        tells whether grass grows. Raises ValueError for an unknown kind.
        """
        self._must_be_there("ask about it")
        return self._messages_at(as_places(xz), self.scene.number_of(kind), time=self.time)

    def patch_at(self, xz: ArrayLike, *, viewer: str = "main") -> NDArray[np.int64]:
        """Return the entity (n,) of the patch at each ground position (x, z) [m], shape (n, 2), around a viewer.

        It has the components `Patch` and `Lod`. It is 0 off the terrain, too far from the viewer for a patch to be
        kept, and everywhere before the viewer has looked once. Raises ValueError for positions that are no pairs,
        TypeError for a viewer that is no name.
        """
        self._must_be_there("ask about it")
        must_be_viewer(viewer)
        cells = cell_of(as_places(xz), patch=self.site.ground.patch)
        if viewer not in self.viewers:
            self._warn_of(viewer)
            return np.zeros(len(cells), np.int64)
        return self._entities.at(self.viewers[viewer], cells)

    def _warn_of(self, viewer: str) -> None:
        """Log once that a viewer was never drawn while another was."""
        others = self.viewers.values()
        if others and viewer not in self._never_drawn:
            self._never_drawn.add(viewer)
            known = others[0].viewer.name
            log.warning("patch_at finds nothing: viewer '%s' was never drawn, but '%s' was", viewer, known)

    def __reduce_ex__(self, protocol: object) -> NoReturn:
        """Refuse to be pickled or copied: raise TypeError."""
        raise TypeError("a prairie cannot be pickled or copied: keep state(), and restore it in another of the scene")

    def _must_be_there(self, purpose: str) -> None:
        """Raise RuntimeError after `release`; its message ends with the `purpose`, a verb and its object."""
        if self._released:
            raise RuntimeError(f"this prairie has been released: load it again to {purpose}")

    def _messages_at(self, place: Floats, kind: int | None, /, *, time: float) -> Floats:
        """Return the messages (n, 2) at places (n, 2) [m] to a kind, or the densest, after all pressers have moved."""
        self.pressers.note(time)
        return self._messages_to(self.winds.receivers_at(place, kind=kind), time=time)


def _messages_to(winds: Winds, pressers: Pressers, receivers: ReceiverArrays, /, *, time: float) -> Floats:
    """Return the messages (n, 2) of winds and pressers to receivers at `time` [s]."""
    return pressers.over(winds.messages_to(receivers, time=time), receivers)


def grass_at(site: Site, clearings: Clearings, mown: Mown, messages_at: MessagesAt, place: Floats, /) -> GrassAt:
    """Return the grass at ground positions (n, 2) [m].

    Its height is that of the canopy, which nine of ten plants stay below, or the height to which it is cut, times the
    fraction that bending leaves. Where kinds grow together, the tallest counts.
    """
    density = density_at(site.ground.density, place)
    grows = density >= PRESENT
    kind = np.where(grows.any(axis=0), density.argmax(axis=0), -1)
    taken = ~clearings.spare(cell_of(place, patch=site.ground.patch))
    left, height = mown.at(place), np.zeros(len(place), np.float32)
    for number, growth in enumerate(site.growths):
        here = np.flatnonzero(grows[number] & ~taken)
        if len(here):
            fraction = bent_height(growth.postures, np.hypot(*messages_at(place[here], number).T))
            height[here] = np.maximum(height[here], np.minimum(site.canopy[number], left[here]) * fraction)
    bare = np.flatnonzero(~grows.any(axis=0))
    taken[bare] |= (natural_at(site.ground.density, place[bare]) >= PRESENT).any(axis=0)
    names = [*site.scene.grass, ""]
    return GrassAt(kind, tuple(names[number] for number in kind), np.ascontiguousarray(density.T), height, taken)


def bent_height(postures: Postures, message: Floats, /) -> Floats:
    """Return the height of blades bent by messages of lengths (n,), as a fraction of their height in calm air, (n,)."""
    highest = postures.shape[0, :, :, 1].max(axis=1)
    calm = np.interp(0.0, postures.index, highest)
    return np.asarray(
        np.interp(postures.bent_by(message.astype(np.float64)), postures.index, highest / calm), np.float32
    )
