"""The changes that a game makes to a prairie: of winds, grass, ground and light."""

from collections.abc import Iterable, Sequence
from reprlib import repr as shortened

import numpy as np
from numpy.typing import ArrayLike

from ..components.footprint import Footprint, Road
from ..components.pose import HERE, Pose
from ..components.shadow_map import ShadowMap
from ..components.wind import WindPrimitive
from ..engine.camera import as_origin
from ..engine.scene.validate import changed
from ..engine.terrain.change import set_heights
from .answering import Answering
from .features import feature_of
from .land.earth import Earth
from .light.given import GivenHaze, Haze
from .mow.sown import clear, sow
from .seasons import Seasons
from .shadows.feature import Shadows


class Tending(Answering):
    """A site whose winds, grass, ground and light can be changed until it is released."""

    _origin = 0.0, 0.0, 0.0
    _seasons: Seasons

    @property
    def origin(self) -> tuple[float, float, float]:
        """Position (x, y, z) [m] of the scene's origin in the world of `draw`'s matrices.

        Set it when your own origin moves. Far from your origin, pass float64 matrices: float32 loses precision. All
        positions that you pass and get elsewhere stay relative to the scene's origin. Setting it raises ValueError for
        anything but three finite numbers up to 1e9 m.
        """
        return self._origin

    @origin.setter
    def origin(self, place: Sequence[float]) -> None:
        self._must_be_there("set its origin")
        self._origin = as_origin(place)

    def add(self, primitive: WindPrimitive, *, pose: Pose | None = None, name: str | None = None) -> int:
        """Add a wind and return its entity, the handle for `move` and `remove`.

        With a `pose` the wind stays there until you `move` it, whatever its own position is. Winds of one `name` share
        their random numbers; the default name is the wind's kind. Raises TypeError for anything but a wind, such as its
        name or class, and RuntimeError after `release`.
        """
        self._must_be_there("add a wind")
        return self.winds.add(primitive, name, pose)

    def move(self, handle: int, pose: Pose) -> None:
        """Move a wind to a pose, by the handle that `add` returned.

        Raises TypeError for anything but a handle and a `Pose`, ValueError for a pose that is not finite and for a wind
        that was removed or whose entity was deleted.
        """
        self._must_be_there("move a wind")
        self.winds.move(handle, pose)

    def remove(self, handle: int) -> None:
        """Remove a wind, by the handle that `add` returned; its entity may have been deleted already.

        Raises TypeError for anything but a handle, ValueError for a wind that has been removed before.
        """
        self.winds.remove(handle)

    def cut(self, footprint: Footprint | Road, height: float, *, pose: Pose = HERE) -> None:
        """Cut the grass under a footprint or a road to `height` [m], until `grow` raises it again.

        Blades end at that height in calm air; shorter ones stay as they are. The footprint lies at `pose`, by default
        the scene's origin. Heights are stored in cells of 0.2 m; a cell is cut if its middle is under the footprint.
        Raises TypeError for anything but a footprint, a height and a pose; ValueError for a negative height and a pose
        that is not finite; RuntimeError after `release`.
        """
        self._must_be_there("cut its grass")
        self._mown.cut(footprint, height, pose)

    def grow(self, footprint: Footprint | Road, height: float = np.inf, *, pose: Pose = HERE) -> None:
        """Raise cut grass under a footprint or a road to `height` [m] again; by default to its full height.

        Higher grass stays as it is. Raises the errors of `cut`.
        """
        self._must_be_there("grow its grass")
        self._mown.grow(footprint, height, pose)

    def sow(
        self, kind: str, footprint: Footprint | Road, density: float, *, soft: float = 0.0, pose: Pose = HERE
    ) -> None:
        """Set the density of a kind under a footprint or a road, in [0, 1]; it grows at once, in every representation.

        The densities of all kinds but flowers add up to 1 at most: where they would exceed it, other kinds thin out.
        Outside the footprint the kind thins out over `soft` [m]. Densities are stored in cells of 0.2 m. Raises
        ValueError for an unknown kind, and for a density or width out of range; TypeError for anything but a footprint
        and a pose; RuntimeError after `release`.
        """
        self._must_be_there("sow on it")
        among = [each.plant == "flower" for each in self.scene.grass.values()]
        number = self.scene.number_of(kind)
        if number is None:
            raise TypeError(f"sow takes the name of a kind of grass, not {shortened(kind)}")
        sow(self.site.ground.density, number, among, footprint, density, pose, soft=soft)

    def clear(self, footprint: Footprint | Road, *, soft: float = 0.0, pose: Pose = HERE) -> None:
        """Remove all grass under a footprint or a road, such as a house's floor, until you `sow` there again.

        Outside the footprint grass thins out over `soft` [m]. Raises the errors of `sow`.
        """
        self._must_be_there("clear it")
        clear(self.site.ground.density, footprint, pose, soft=soft)

    def set_heights(self, corner: ArrayLike, heights: ArrayLike) -> None:
        """Set the ground's heights [m] in a rectangle, for a crater, a dike or a field.

        `corner` (x, z) [m] is the place of the first sample. `heights` (rows, columns) are samples at the terrain's own
        cell size, `site.ground.terrain.cell`, with row 0 at the far edge (-z). NaN makes a hole, like a scene's
        `holes`, until a height is set there. Everything follows at once; only long shadows may take some sixty frames.
        Raises ValueError for anything but heights, for a corner between samples, and for heights beyond the terrain;
        RuntimeError after `release`.
        """
        self._must_be_there("change its ground")
        set_heights(self.site.ground.terrain, corner, heights)

    def shine(self, *, at_once: bool = False, **changes: object) -> None:
        """Change keys of the scene's `light:` from the next frame on: `shine(hour=17.5, clouds=0.4)`.

        The other keys stay. You may call it in every frame. Clouds, haze and colours change at once. If the sun moves,
        then sun, sky, exposure and the terrain's shadows follow together, within some sixty frames. With `at_once` the
        next frame waits for all of it, for a cut in a film or a night that the player sleeps through. Raises ValueError
        for an unknown key and a bad value, RuntimeError after `release`.
        """
        self._must_be_there("change its light")
        light = changed(self._shining.at(self.time), changes, name="light")
        if at_once:
            self._shining.resume(light, since=self.time, time=self.time)
        else:
            self._shining.ask(light, time=self.time)

    def change_kind(self, name: str, *, over: float = 0.0, **keys: object) -> None:
        """Change keys of a kind in the scene's `grass:`: `change_kind("lawn", gloss=0.2)`.

        The change takes `over` seconds of the prairie's time, and no frame waits for it. Colours, `variety`,
        `translucency`, `gloss` and `understorey` are interpolated; what must grow anew comes in plant by plant. The
        keys of a `head` that you leave out stay. Raises ValueError for an unknown kind and a bad time, SceneError with
        a sentence for each key that is unknown or out of range, TypeError for anything but a name, RuntimeError after
        `release`.
        """
        self._must_be_there("change a kind")
        if name in self.scene.trees and name not in self.scene.grass:
            raise ValueError(
                f"'{name}' are trees: give each another Tree, or reload the scene with another leaf or bark"
            )
        if self.scene.number_of(name) is None:
            raise TypeError(f"change_kind takes the name of a kind of grass, not {shortened(name)}")
        self._seasons.change(name, keys, over=over, time=self.time)

    def ground_texture(self, texture: object, *, side: float | None = None, linear: bool = False) -> None:
        """Draw the ground with a texture of your own from the next frame on, between plants and where none grow.

        `texture` is a 2D texture of moderngl or pyglet, or its GL name, and is read with its own filters and wrapping:
        give it mip-maps, and let it repeat. It covers the terrain once, its first row at the far edge (-z), or repeats
        every `side` metres. Its texels are sRGB colours, or `linear` ones. None restores the scene's own ground. Raises
        TypeError for anything but such a texture, ValueError for a side that is not above 0, RuntimeError after
        `release`.
        """
        self._must_be_there("change its ground")
        feature_of(Earth, self.features).hand_in(texture, side, linear=linear)

    def shadows(self, maps: Iterable[ShadowMap]) -> None:
        """Shade ground and grass with your own shadow maps from the next frame on, in place of the maps before.

        Give up to four, the finest first: each place is shaded by the first map that contains it. They stay until you
        give others, so you may draw into their textures in every frame; an empty list removes them. Raises TypeError
        for anything but shadow maps, ValueError for more than four, RuntimeError after `release`.
        """
        self._must_be_there("hand in shadow maps")
        feature_of(Shadows, self.features).hand_in(maps, self._origin)

    @property
    def haze(self) -> Haze | None:
        """Colour that distant ground and grass fade to, for a sky of your own; None for that of the scene's horizon.

        It is a colour as the picture shows it, (red, green, blue) or "#a0b0c0". Or it is a function from unit vectors
        (x, 0, z), shape (n, 3), to the colours of your sky in these directions, (n, 3). The function is called when
        you set it. A `linear` prairie takes radiance. The distance of the haze stays the scene's `light.haze`.
        Setting it raises ValueError for anything but colours.
        """
        return feature_of(GivenHaze, self.features).haze

    @haze.setter
    def haze(self, haze: Haze | None) -> None:
        self._must_be_there("set its haze")
        feature_of(GivenHaze, self.features).give(haze)
