"""The blast of air under a flying body: grass within any outline is pressed outwards (paper, section 3.3)."""

from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path
from typing import ClassVar, Literal, Self
from warnings import catch_warnings

import numpy as np
from PIL import Image, UnidentifiedImageError
from pydantic import Field, PrivateAttr, ValidationInfo, model_validator

from ...components.arrays import Floats
from ...components.body import Hover, Model
from ...components.declaration import Declaration, DeclarationError, Pair
from ...components.wind import Extent, Grass, TwinValues
from ...components.words import Plain, no_file
from ...engine.memo import by_identity
from .outline import FINE, Outline, outline_of_picture, outline_of_polygon, polygon_of_ellipse
from .placed import PlacedWind
from .shape import smooth

BEAT, PULSE, AT_ONCE = 2.2, 0.14, 1.5
"""Frequency of the rings that run outwards through a blast [1/s]; their amplitude, of its index; their number."""

SOFT_RIM = 0.45
"""Width of the rim over which a blast grows to its strength, as a part of the way from the outline inwards."""


class Shape(Declaration, metaclass=Plain):
    """The outline of a blast on the ground, in its own frame: x to the right, -z ahead. One of these."""

    disc: float | None = Field(default=None, gt=0.05, le=1000.0)
    """Radius of a disc [m]."""

    ellipse: Pair | None = None
    """Half axes of an ellipse, across and along its heading [m]."""

    polygon: list[Pair] | None = Field(default=None, min_length=3, max_length=500)
    """Corners (x, z) of any polygon [m]."""

    image: str | None = Field(default=None, min_length=1)
    """Picture file, relative to the scene file, whose bright or opaque part is the shape; its top lies ahead."""

    width: float = Field(default=6.0, gt=0.05, le=1000.0)
    """Width of the picture on the ground [m]."""

    _loaded: Outline | None = PrivateAttr(None)

    @model_validator(mode="after")
    def _one_shape(self, info: ValidationInfo) -> Self:
        given = [name for name in ("disc", "ellipse", "polygon", "image") if getattr(self, name) is not None]
        if len(given) != 1:
            found = " and ".join(given) or "none of them"
            raise DeclarationError(f"an outline is one of disc, ellipse, polygon and image, found {found}")
        if self.ellipse is not None and not all(0.05 < axis <= 1000.0 for axis in self.ellipse):
            raise DeclarationError("each half axis must be between 0.05 and 1000 m", "ellipse")
        if self.polygon is not None:
            spread = np.ptp(np.array(self.polygon), axis=0)
            if not (spread.min() > 0.05 and spread.max() <= 2000.0):
                raise DeclarationError("a polygon must be from 0.05 to 2000 m wide and deep", "polygon")
            if self.outline().deepest <= 0.0:
                raise DeclarationError("a polygon must hold some ground; this one is too thin", "polygon")
        if self.image is not None and (info.context is None or "folder" in info.context):
            self._loaded = _pictured(self.image, (info.context or {}).get("folder") or Path(), self.width)
        return self

    def outline(self) -> Outline:
        """Return the sampled outline. Raises DeclarationError where the picture cannot be read."""
        if self.image is not None:
            return self._loaded or _pictured(self.image, Path(), self.width)
        return _drawn(self)


class Blast(PlacedWind):
    """A blow of air from above that presses grass outwards, as under a helicopter."""

    twin: ClassVar[str | None] = "blast.glsl"
    color: ClassVar[tuple[float, float, float] | None] = (1.00, 0.42, 0.22)

    kind: Literal["blast"] = "blast"
    """A blast of air."""

    priority: int = Field(default=30, ge=-1000, le=1000)
    """The highest priority at a place cancels the others; a blast's goes over a whirlwind's."""

    outline: Shape = Shape(disc=4.0)
    """Where it acts."""

    strength: float = Field(default=0.8, ge=0.0, le=1.0)
    """Largest posture index in it."""

    soft: float = Field(default=1.5, ge=0.0, le=1000.0)
    """Distance from its outline over which it sets in, unless winds meet by priority [m]."""

    swing: float = Field(default=0.18, ge=0.0, le=0.5)
    """Largest posture index of a blade's own small oscillations in it, of random direction."""

    body: Model | None = None
    """Body that is drawn flying over it, if any."""

    height: float = Field(default=2.0, ge=0.5, le=100.0)
    """Height of the body above the grass [m]."""

    def hover(self) -> Hover | None:
        """Return the body that flies over it."""
        return _hover(self.body, self.height) if self.body else None

    def extent(self, *, time: float) -> Extent:
        """Return the rectangle around its outline."""
        return Extent(*self.outline.outline().bounds)

    def mask(self, place: Floats, /, *, time: float) -> Floats:
        """Return 1 deep inside the outline, falling to 0 on it over `soft` [m]."""
        outline = self.outline.outline()
        depth, _ = outline.at(place)
        return smooth(depth / np.float32(self._width(outline)))

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Floats:
        """Return its messages: at right angles to the outline, strongest half way out, with rings that run outwards."""
        outline = self.outline.outline()
        depth, outward = outline.at(place)
        out = np.float32(1.0) - np.clip(depth / np.float32(outline.deepest), 0.0, 1.0)
        turn = np.float32(np.mod(BEAT * time, 1.0))
        pulse = np.sin(np.float32(2.0 * np.pi) * (np.float32(AT_ONCE) * out - turn))
        index = np.float32(self.strength / (1.0 + PULSE)) * (1 + np.float32(PULSE) * pulse)
        index *= smooth((1 - out) / np.float32(SOFT_RIM))
        return np.asarray(outward * index[:, None], np.float32)

    def twin_values(self, *, time: float, seed: int) -> TwinValues:
        """Return the samples' grid [m], the rim's width [m], the mean index, and the rings' phase [turns]."""
        outline = self.outline.outline()
        rows, columns = outline.field.shape[:2]
        record: dict[str, float | Sequence[float]] = {
            "corner": outline.corner,
            "last": (columns - 1.001, rows - 1.001),
            "stride": outline.step,
            "side": self._width(outline),
            "deepest": outline.deepest,
            "mean": self.strength / (1.0 + PULSE),
            "turn": BEAT * time % 1.0,
        }
        return TwinValues(record, (outline.field,))

    def _width(self, outline: Outline) -> float:
        """Return the width of its mask's rim [m]."""
        return max(min(self.soft, outline.deepest), 1e-6)


@by_identity(most=256)
def _drawn(shape: Shape) -> Outline:
    """Return the outline of a shape that is no picture."""
    if shape.polygon is not None:
        return outline_of_polygon(tuple((x, z) for x, z in shape.polygon))
    across, along = shape.ellipse or (shape.disc or 1.0, shape.disc or 1.0)
    return outline_of_polygon(polygon_of_ellipse(across, along))


@lru_cache(maxsize=256)
def _hover(model: Model, height: float) -> Hover:
    return Hover(model, height)


def _pictured(name: str, folder: Path, width: float) -> Outline:
    """Return the outline of a picture file; raises DeclarationError where it cannot be read."""
    path = folder / name
    try:
        return _picture(str(path), path.stat().st_mtime_ns, width)
    except FileNotFoundError as error:
        raise DeclarationError(no_file(name), "image") from error
    except UnidentifiedImageError as error:
        raise DeclarationError(f"'{name}' is no picture", "image") from error
    except (OSError, ValueError, Image.DecompressionBombError) as error:
        why = (isinstance(error, OSError) and error.strerror) or error
        raise DeclarationError(f"the picture '{name}' cannot be used: {why}", "image") from error


@lru_cache(maxsize=64)
def _picture(path: str, _changed: int, width: float) -> Outline:
    # Pillow warns of a damaged file before it raises, and the exception becomes a problem of the scene.
    with catch_warnings(action="ignore", category=UserWarning), Image.open(path) as opened:
        opened.thumbnail((FINE, FINE))
        bands = opened.convert("LA")
    grey, alpha = np.asarray(bands, np.float32).transpose(2, 0, 1)
    bright = grey if (alpha == 255.0).all() else alpha
    holds = bright > 127.0
    if not holds.any() or holds.all():
        raise ValueError("it must have bright (or opaque) and dark (or clear) parts, split at half brightness")
    return outline_of_picture(holds, width=width)
