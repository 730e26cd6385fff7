"""The terrain, as a scene declares it."""

from typing import Literal

from pydantic import Field, field_validator, model_validator

from ...components.declaration import Declaration, DeclarationError, Pair
from .array import HeightFunction, HeightsSource, PictureOrArray


class TerrainSource(Declaration):
    """An elevation map from a file, or one made from a named noise (paper, section 2.2).

    It is centred on the origin; row 0 of the map is the far edge (-z), column 0 the left edge (-x).
    """

    heights: HeightsSource | None = None
    """Elevation map file, relative to the scene file: 16-bit grey .png, .r16 or .raw, .npy, or .tif (GeoTIFF too).

    A smooth surface divides cells longer than 2.5 m. A map wider than 10240 m is cut to its middle. `seed` and
    `feature`, which are for noise, have no effect on it. A program may hand in an array. Or it hands in a function
    `heights(x, z)`, which takes places [m] in two arrays of one shape, and returns their heights [m]."""

    holes: PictureOrArray | None = None
    """Picture or array over the whole terrain: where its first channel is above half there is no ground and no grass.

    It is for mouths of caves, cellars and wells. NaN in `heights` (.npy or an array) is a hole as well. Heights go on
    smoothly across holes."""

    noise: Literal["flat", "rolling", "hills", "ridges"] | None = None
    """A landscape made from noise instead of a file; without either, the ground is flat."""

    seed: int = Field(default=0, ge=0, le=2**31 - 1)
    """Seed of the noise."""

    size: Pair | None = None
    """Width (x) and depth (z) [m]: of a noise landscape, by default 200 by 200; or of the middle of a file, by default
    all of it."""

    window: float | None = Field(default=None, ge=512.0, le=8192.0)
    """For a function in `heights`: width of the ground around the viewer for which it is called [m]. As the viewer goes
    on, it is called for more, up to 16384 m from the origin. Without a window, it is called for all of the `size`
    while loading."""

    feature: float | None = Field(default=None, ge=2.0, le=5000.0)
    """Distance between neighbouring hills of a noise landscape [m]; without it 60 for rolling, 90 for hills, 160 for
    ridges."""

    cell: float = Field(default=1.0, ge=0.05, le=1000.0)
    """Metres per cell; without it, a GeoTIFF's own."""

    scale: float | None = Field(default=None, ge=-100000.0, le=100000.0)
    """Vertical scale [m]. For a map of unsigned integers it is the height of their whole range, 100 without it. For
    floats and signed integers, which are metres, it is a factor, 1 without it. For noise it is the height between
    the lowest and the highest ground; without it 7 for rolling, 14 for hills, 30 for ridges."""

    offset: float = Field(default=0.0, ge=-20000.0, le=20000.0)
    """Height added to every cell [m]."""

    columns: int | None = Field(default=None, ge=2, le=8193)
    """Columns of a headless .r16 or .raw file; without it the map is square."""

    byte_order: Literal["little", "big"] = "little"
    """Byte order of a headless .r16 or .raw file."""

    flip: bool = False
    """Whether the file's first row is the near edge (+z) instead of the far one."""

    beyond: Literal["level", "mirror"] = "level"
    """Ground beyond the terrain: as high as its edge, for 600 m; or a mirror image of it, for 4000 m, the last half of
    which fades into the haze."""

    @field_validator("size")
    @classmethod
    def _sides(cls, size: list[float] | None) -> list[float] | None:
        if size is not None and not all(5.0 <= side <= 10240.0 for side in size):
            raise DeclarationError("size must be [width, depth] in metres, between 5 and 10240")
        return size

    @model_validator(mode="after")
    def _one_source(self) -> "TerrainSource":
        if self.heights is not None and self.noise is not None:
            raise DeclarationError("give either heights (a file) or noise, not both", "noise")
        if isinstance(self.heights, HeightFunction) and self.flip:
            raise DeclarationError("a function says itself where the far edge is", "flip")
        if self.window is not None:
            self._must_stream()
        finest = max(self.size or [200.0]) / 1024
        if self.feature is not None and self.heights is None and self.feature < finest:
            raise DeclarationError(f"feature must be at least {finest:.3g} m on ground this wide", "feature")
        return self

    def _must_stream(self) -> None:
        if not isinstance(self.heights, HeightFunction):
            raise DeclarationError("it is for heights that are a function of places", "window")
        for name in ("size", "holes"):
            if getattr(self, name) is not None:
                raise DeclarationError("ground with a window has no edge that this could lie within", name)
        if self.beyond == "mirror":
            raise DeclarationError("ground with a window has no edge that could be a mirror", "beyond")
