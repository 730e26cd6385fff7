"""Kinds of grass and other plants, as a scene declares them."""

from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, ValidationInfo, field_validator, model_validator

from ...components.declaration import Color, Declaration, DeclarationError, Pair, rising
from .array import MapArray, PictureOrArray
from .plant import ON_GRASS, SIZES, USUAL, WITH_EYES, Head, Plant

MOST_KINDS = 16
"""Greatest number of kinds of grass in a scene.

The limit is the number of varyings from the carpet's mesh to its pixels that every OpenGL 3.3 has: 60 components. Each
kind needs one of them, or two where some bear heads, and the lighting all others.
"""

GLSL = {"MOST_KINDS": MOST_KINDS}

Profile = Literal["blade", "rush", "fold"]
"""Cross section of a blade."""

RUSH_TAPERS = 0.35
"""Default of `taper` for rushes."""

_OF_GRASS = {
    "profile": "grass alone has a profile: other plants have organs",
    "withered": "grass alone withers: other plants have organs",
    "blades": "a {plant} has plants in place of blades",
}
"""Keys for grass alone, and the message for other plants."""

_NONE = {"profile": "blade", "withered": 0.0}
"""Values of such keys that any plant may have; for the other keys it is None."""


class Place(Declaration):
    """The density map of a kind: one channel of a map laid over the whole terrain."""

    map: PictureOrArray
    """Picture file, relative to the scene file: in a channel 0 is no grass, its largest number is full density."""

    channel: Literal["red", "green", "blue", "alpha"] = "red"
    """Channel of the map that holds this kind's density."""


NOWHERE = Place(map=MapArray(np.zeros((1, 1), np.uint8)))
"""Map of a kind that grows nowhere, as `place: none` declares it."""


def _or_none(schema: dict[str, Any]) -> None:
    schema["anyOf"].insert(1, {"const": "none"})


class GrassKind(Declaration):
    """A kind of grass, or of another plant: postures and patch models are grown from it (paper, sections 2.1, 3.2).

    The defaults are those of grass. Other plants have their own, so that `plant: flower` says enough.
    """

    plant: Plant = "grass"
    """Kind of plant: blades of grass; flowers on stems; forbs with broad leaves along their stems; low shrubs.

    Flowers, forbs and shrubs are lower than grass, unless `height` says more."""

    height: Annotated[Pair, rising("height must be [shortest, tallest]", 0.02, 5.0)] = Field(default=[0.4, 0.7])
    """Shortest and tallest blade, stem or branch, measured along it [m]."""

    width: float = Field(default=0.02, gt=0.0005, le=0.2)
    """Width of a blade at its root; for other plants, greatest width of a leaf [m]."""

    stiffness: float = Field(default=1.0, gt=0.01, le=100.0)
    """Stiffness of the springs between the links of a blade, 1 is a common meadow grass.

    The same wind bends a stiffer kind less and a softer one more: index 1 lays grass of stiffness 1 flat, softer grass
    lies flat before, and stiffer grass still stands."""

    damping: float = Field(default=1.0, gt=0.01, le=100.0)
    """Damping of a blade's swing, 1 is a common meadow grass."""

    recovery: float = Field(default=20.0, ge=0.1, le=3600.0)
    """Time that grass trodden flat takes to stand again [s]; less trodden grass stands earlier."""

    lean: float = Field(default=0.3, ge=0.0, le=0.9)
    """Largest posture index of blades at rest; each has its own, in its own direction. Old leaves of grass, a quarter
    of them, hang over up to three times as far."""

    clumping: float = Field(default=0.5, ge=0.0, le=1.0)
    """Strength of tufts: blades stand closer together in them, and neighbours within about half a metre are more
    alike in height, lean, facing and so in tint."""

    taper: float = Field(default=0.6, ge=0.2, le=4.0)
    """Fall of the width from root to tip: 1 is a triangle, below 1 keeps it broad for longer."""

    profile: Profile = "blade"
    """Cross section of a blade of grass: flat; a `rush`, a round stem that is as wide from all sides and hardly tapers;
    or a `fold`, two faces with a keel between them, each in its own light."""

    withered: float = Field(default=0.0, ge=0.0, le=0.6)
    """Fraction of blades of grass that are dead: of the colour of tips down to the root, thinner, and bent."""

    understorey: float = Field(default=0.9, ge=0.0, le=1.0)
    """Cover of the ground by low leaves: at 1 and full density, two thirds of it."""

    root: Color = "#4b6128"
    """Colour at the root."""

    tip: Color = "#a8b65a"
    """Colour at the tip."""

    variety: float = Field(default=0.15, ge=0.0, le=0.6)
    """Variation of brightness and hue among blades, as a fraction."""

    translucency: float = Field(default=0.8, ge=0.0, le=1.5)
    """Ratio of the light that its leaves transmit to the light that they reflect: grass glows against the sun."""

    gloss: float = Field(default=0.06, ge=0.0, le=2.0)
    """Strength of its leaves' reflection of the sun: wind runs over glossy grass as bands of light."""

    blades: int | None = Field(default=None, ge=1, le=5000)
    """Number of blades of grass per patch at full density; without it the quality's number."""

    plants: int | None = Field(default=None, ge=1, le=1000)
    """Number of plants other than grass per patch at full density; without it, what suits the plant."""

    leaves: int | None = Field(default=None, ge=0, le=24)
    """Number of leaves of a flower or forb, or of each branch of a shrub; without it, what suits the plant."""

    leaf: Annotated[Pair, rising("leaf must be [shortest, longest]", 0.005, 5.0)] | None = None
    """Shortest and longest of these leaves [m]; without it, what suits the plant's height."""

    head: Head | None = None
    """Head that it bears; without it, flowers bear discs, and other plants nothing."""

    segments: int | None = Field(default=None, ge=1, le=16)
    """Line segments per blade at the finest level, and the most at any other; without it the quality's numbers."""

    place: Place | None = Field(default=None, json_schema_extra=_or_none)
    """Density map of where it grows; without it, everywhere. With `none` it grows nowhere until a game sows it.

    Kinds share the ground, but flowers stand among the others."""

    slope: float | None = Field(default=None, ge=0.0, le=90.0)
    """Steepest slope that it grows on [degrees]; it thins out over the 8 degrees before. Without it, on any."""

    @field_validator("place", mode="before")
    @classmethod
    def _nowhere(cls, value: Any) -> Any:
        """Read `none` as an empty map."""
        return NOWHERE if isinstance(value, str) and value == "none" else value

    @model_validator(mode="before")
    @classmethod
    def _as_its_plant(cls, data: Any) -> Any:
        """Fill in the defaults of the plant."""
        if not isinstance(data, dict):
            return data
        plant, rush = data.get("plant"), {"taper": RUSH_TAPERS} if data.get("profile") == "rush" else {}
        return {**(USUAL.get(plant, {}) if isinstance(plant, str) else {}), **rush, **data}

    @field_validator("profile", "withered", "blades", "plants", "leaves", "leaf")
    @classmethod
    def _suits_its_plant(cls, value: Any, info: ValidationInfo) -> Any:
        """Refuse keys of other plants, each by itself, so that all are reported."""
        plant, key = info.data.get("plant"), str(info.field_name)
        if plant is None or value == _NONE.get(key):
            return value
        if plant == "grass" and key in ("plants", "leaves", "leaf"):
            raise DeclarationError("plants, leaves and leaf are not for grass, which has blades")
        if plant != "grass" and key in _OF_GRASS:
            raise DeclarationError(_OF_GRASS[key].format(plant=plant))
        return value

    @model_validator(mode="after")
    def _bears_its_head(self) -> "GrassKind":
        head = self.head
        if head is None:
            return self
        if self.plant == "grass" and head.form not in ON_GRASS:
            raise DeclarationError(f"grass bears no {head.form}: its heads are spikes and plumes", "head", "form")
        if head.eye is not None and head.form not in WITH_EYES:
            raise DeclarationError(f"a {head.form} has no eye: discs and bells have one", "head", "eye")
        longest = (head.size or SIZES[head.form])[1]
        if head.form in ON_GRASS and longest > self.height[0]:
            stem = f"the shortest stem, {self.height[0]:g} m: give it a smaller `size`"
            raise DeclarationError(f"a {head.form} of {longest:g} m is longer than {stem}", "head", "size")
        return self
